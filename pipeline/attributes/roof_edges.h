// What context knows of a building's outline, for the roofs of its bodies.
#pragma once

#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/model/polygon.h"
#include "styles/roofs/roof.h"

namespace blockrand::attributes {

/// What each edge of a plan is to the roof above it, ring by ring, from the wall segments of the building's outline that
/// lie on it: a party wall where at least half of it (three quarters where it looks away from the street) has a
/// neighbour that is no outbuilding, else what most of it faces. Empty when the building's edges have no labels; open
/// where no wall segment lies (walls between two parts of a building).
std::vector<model::RoofEdge> roof_edges(const model::Building& building, const model::Polygon& plan);

/// The labelled wall segments of a building's outline, for asking about single walls.
class OutlineSegments {
 public:
  explicit OutlineSegments(const model::Building& building);
  bool empty() const { return segments_.empty(); }
  /// What the wall from p to q is, by the rules of roof_edges().
  model::RoofEdge kind(model::Point2 p, model::Point2 q) const;
  /// m above the building's ground up to which neighbours cover the party wall from p to q: the least along it.
  double covered(model::Point2 p, model::Point2 q) const;

 private:
  struct OutlineSegment {
    model::Point2 a, b;
    model::RoofEdge kind = model::RoofEdge::open;
    float covered = 0;  ///< m
  };
  std::vector<OutlineSegment> segments_;
  std::optional<model::Point2> street_;  ///< which way the longest street front looks
};

/// Fills roof_plan and roof_edges of all parts: plans without points that bend no wall, whose corners stay out of each
/// other (keep_corners_out). \param tolerance  m, GenerateOptions::collinear_tolerance
void prepare_roof_plans(model::Building& building, double tolerance);

/// The plan without points that bend no wall; none when that is no simple polygon any more.
std::optional<model::Polygon> simpler_plan(const model::Polygon& plan, double tolerance);

/// m. Wall segments of an outline belong to an edge of a part that lies so near: repair moves both together.
inline constexpr double kSameWall = 0.1;

}  // namespace blockrand::attributes
