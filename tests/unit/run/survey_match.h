// Buildings as mapped against the ground surfaces of surveyed models: which stand for each other, how well they agree.
// GEOS alone measures, on the coordinates as they are: a judge that shares nothing with repair.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/plan_shape.h"
#include "pipeline/model/polygon.h"

namespace blockrand::run::test {

using geometry::PlanShape;

/// Area in common over area together; 0 where one is empty.
inline double intersection_over_union(const PlanShape& a, const PlanShape& b) {
  if (a.empty() || b.empty()) return 0;
  const double common = a.common_area(b);
  return common / (a.area() + b.area() - common);
}

/// The ground of a building in a surveyed model.
struct SurveyedBuilding {
  std::string id;
  PlanShape ground;
  geometry::PlanBox box;
};

/// All buildings of the CityGML files below `folder`, in the order of the files' names, in a projected CRS. What is
/// mostly (50 % of the smaller) the ground of one before it is left out: tiles of different years overlap.
std::vector<SurveyedBuilding> read_survey(const std::filesystem::path& folder, const std::string& crs);

/// Buildings and surveyed buildings that stand for each other.
struct SurveyMatch {
  std::vector<std::uint32_t> buildings;  ///< numbers in the store, ascending
  std::vector<std::size_t> surveyed;     ///< ascending
  PlanShape ground;                      ///< of the surveyed ones together
};

/// Matches by area, as comparisons of OSM with surveys do (Hecht, Kunze and Hahmann 2013; Fan, Zipf, Fu and Neis 2014):
/// a building and a surveyed one are linked when they have more than half of the smaller one in common; what is linked,
/// directly or through others, is one match (1:1, 1:n, n:1, n:m); a match counts when both sides, each united, have
/// more than half of their area in common. Anything else is another building than the survey saw, not one drawn badly.
std::vector<SurveyMatch> match_survey(const footprints::FootprintStore& mapped,
                                      const std::vector<SurveyedBuilding>& survey);

/// The outlines of some buildings together.
PlanShape shape_of(const footprints::FootprintStore& store, const std::vector<std::uint32_t>& buildings);

}  // namespace blockrand::run::test
