// What outputs tell of a building's style beside its value.
#pragma once

#include <algorithm>
#include <cstdint>

#include "pipeline/model/building.h"

namespace blockrand::outputs {

/// Whether classification looked at the building: then its probabilities sum to 1.
inline bool is_classified(const model::BuildingStyle& style) {
  return std::any_of(style.style.begin(), style.style.end(), [](float p) { return p > 0; });
}

/// What an answer rests on.
enum class StyleBasis : std::uint8_t {
  tags,      ///< what a user or a mapper said of the building itself
  evidence,  ///< what was measured of it and what stands around it
  rule,      ///< a stated rule for what is no house
};
inline constexpr int kStyleBasisCount = 3;

constexpr StyleBasis basis_of(model::Source source, bool non_house) {
  if (source == model::Source::override_) return StyleBasis::tags;
  if (non_house) return StyleBasis::rule;
  return source <= model::Source::implied ? StyleBasis::tags : StyleBasis::evidence;
}

}  // namespace blockrand::outputs
