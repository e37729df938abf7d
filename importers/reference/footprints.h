// Where reference buildings stand: their ground surfaces as plane polygons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "importers/reference/reference_model.h"
#include "pipeline/model/polygon.h"

namespace blockrand::importers::reference {

/// Which polygons of a model became a footprint, best first.
enum class FootprintSource : std::uint8_t {
  ground_surface,     ///< GroundSurface
  footprint,          ///< lod0FootPrint
  lowest_horizontal,  ///< the lowest horizontal polygons of the geometry with the highest level of detail
  roof_edge,          ///< lod0RoofEdge
  plan,               ///< everything seen from above: no polygon said what is ground
  none,               ///< no polygon with an area in plan
};
std::string_view name_of(FootprintSource source);

struct FootprintOptions {
  double min_area = 0.01;   ///< m². Smaller pieces and holes are what rounding leaves between polygons that meet.
  double clearance = 0.02;  ///< m. Touching rings are moved apart by so much (geometry::make_valid).
};

/// A building (with all its parts) in plan.
struct Footprint2D {
  std::size_t building = 0;  ///< index into ReferenceModel::buildings, a Building and no part
  std::vector<model::Polygon>
      polygons;              ///< strictly simple, apart, largest first; in the model's CRS on the 1/1024 m grid
  double area = 0;           ///< m² in the CRS
  double ground_height = 0;  ///< m: lowest z of the polygons it was made of; 0 where source is none
  FootprintSource source = FootprintSource::none;  ///< the weakest one of the building and its parts
};

/// One footprint for each Building, in their order: the union of its own and its parts' ground polygons, of each from
/// the best source that it has. Ground surfaces of the highest level of detail that has some count; those of interiors
/// and installations never do.
/// \throws base::UsageError  when the model's CRS is geographic or not in metres: transform_to first
std::vector<Footprint2D> ground_footprints(const ReferenceModel& model, const FootprintOptions& options = {});

}  // namespace blockrand::importers::reference
