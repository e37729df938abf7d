// What a build knows of its extract as a whole, small and made once: so that a part of it can be built alone, with only
// the data around it, and comes out the same (ARCHITECTURE.md, law 4).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/attributes/area_set.h"
#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"
#include "pipeline/run/build.h"

namespace blockrand::run {

struct RegionFacts {
  std::string crs;                            ///< "EPSG:25833"
  georef::GeoBox box;                         ///< of the buildings, degrees
  georef::LonLat centre;                      ///< degrees
  std::vector<model::Point2> coverage;        ///< m, build CRS: where the data is (context::coverage_of)
  std::vector<attributes::PinnedArea> areas;  ///< large ones that district rules ask for (DistrictAssigner::to_pin)
  std::string imagery_sha256;                 ///< of the imagery.json beside the build.json; empty: there is none
};

/// Reads the facts that an earlier build wrote into its build.json.
/// \throws base::InputError  `path` is no build.json, is damaged, or comes from a version that wrote no facts
/// \throws base::UsageError  that build had other options than this one, so that a tile would not fit into it
///                           (first_difference; an option that its record lacks had its default)
RegionFacts read_region_facts(const std::string& path, const BuildOptions& options);

}  // namespace blockrand::run
