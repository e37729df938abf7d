// Surveyed and hand-built roofs, each with the ground it stands on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/unit/run/survey_match.h"
#include "tests/unit/run/surveyed_surfaces.h"

namespace blockrand::run::test {

struct SurveyedRoof {
  std::string id;
  std::string roof_type;  ///< code as it stands (ALKIS, or SIG3D 10x0); of the building or of all of its parts alike
  std::vector<model::Polygon> plan;  ///< its ground
  double ground = 0;                 ///< z of the lowest ground, m
  RoofSurfaces roof;  ///< of the highest level of detail; without dormers and chimneys that are installations
  PlanShape shape;
  geometry::PlanBox box;
};

/// All buildings of the CityGML files below `folder` that have a ground and a roof, in the order of the files' names,
/// in a projected CRS. Of buildings that stand on the same ground (tiles of different years) the first one.
std::vector<SurveyedRoof> read_roof_survey(const std::filesystem::path& folder, const std::string& crs);

/// The buildings and parts of a CityJSON 1.0 file with LoD2 solids, each alone, in the file's CRS.
std::vector<SurveyedRoof> read_cityjson_roofs(const std::filesystem::path& file);

}  // namespace blockrand::run::test
