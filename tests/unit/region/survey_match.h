// Buildings as mapped against the ground surfaces of surveyed models: which stand for each other, how well they agree.
// GEOS alone measures, on the coordinates as they are: a judge that shares nothing with repair.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/region/footprints.h"

namespace blockrand::region::test {

/// An area in plan, held by GEOS. Square metres, metres.
class PlanShape {
 public:
  PlanShape() = default;
  /// The union of the polygons.
  explicit PlanShape(const std::vector<model::Polygon>& polygons);
  bool empty() const { return area_ <= 0; }
  double area() const { return area_; }
  model::Point2 centroid() const;
  double common_area(const PlanShape& other) const;
  /// Area in common over area together; 0 where one is empty.
  double intersection_over_union(const PlanShape& other) const;
  /// The largest distance of a vertex of one outline from the other outline, both ways; 0 where one is empty.
  double outline_distance(const PlanShape& other) const;
  PlanShape moved(model::Point2 by) const;
  /// intersection_over_union at the best place that this shape can be moved to (to 1 cm, found by descent from where it
  /// is): how well the forms agree, wherever they lie.
  double best_intersection_over_union(const PlanShape& other) const;
  PlanShape united(const PlanShape& other) const;

 private:
  std::shared_ptr<void> shape_;
  double area_ = 0;
};

/// The ground of a building in a surveyed model.
struct SurveyedBuilding {
  std::string id;
  PlanShape ground;
  PlanBox box;
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
std::vector<SurveyMatch> match_survey(const FootprintStore& mapped, const std::vector<SurveyedBuilding>& survey);

/// The outlines of some buildings together.
PlanShape shape_of(const FootprintStore& store, const std::vector<std::uint32_t>& buildings);

}  // namespace blockrand::region::test
