// How much GLBs tell of a building.
#pragma once

#include <cstdint>

namespace blockrand::outputs {

/// Which columns the property table of a GLB has.
enum class AttributeProfile : std::uint8_t {
  people,  ///< what people look for, rounded, in the order in which they read it; sources grouped behind (people_table.h)
  all,     ///< every attribute with its source and confidence, in the order of the alphabet, and the OSM tags
};

}  // namespace blockrand::outputs
