// Where on Earth an extract lies.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/extract.h"

namespace blockrand::footprints {

/// The median place of all buildings, and the box of those within 5 degrees of it: one stray object at 0/0 must not
/// choose the CRS. Longitudes are unwrapped around the first building.
struct Area {
  georef::GeoBox box;
  georef::LonLat centre;
};

/// Empty when no pending building has an outline.
std::optional<Area> area_of(const model::Extract& extract);

/// Of the centres of their boxes. Empty without any.
std::optional<Area> area_of(std::span<const model::Location> centres);

/// Centre of the box of each pending building with an outline, in their order.
std::vector<model::Location> building_centres(const model::Extract& extract);

}  // namespace blockrand::footprints
