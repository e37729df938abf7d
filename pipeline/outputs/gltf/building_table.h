// What a GLB tells about each building part.
#pragma once

#include "pipeline/model/region.h"
#include "pipeline/outputs/gltf/attribute_profile.h"
#include "pipeline/outputs/gltf/property_table.h"

namespace blockrand::outputs {

inline constexpr const char* kBuildingClass = "building_part";

/// The table that a profile asks for: people_table(), or with all attributes the following.
///
/// One row per part of every owned building, in the order of the region: ids, name, address, every attribute with its
/// source and confidence, what stands in the end, and the OSM tags. Parts without a solid have a row too.
///
/// `tags` holds the tags of the object that the part was made from; where parts are mapped objects of their own, the
/// building's tags stand once, in `building_tags` of its first part.
/// \param evidence  also the column `evidence`: a JSON object from attribute to the sentence that says why
PropertyTable building_table(const model::Region& region, AttributeProfile profile, bool evidence);

/// The "enums" of the schema: Source, RoofShape, RoofOrientation, OsmType.
nlohmann::json building_enums();

}  // namespace blockrand::outputs
