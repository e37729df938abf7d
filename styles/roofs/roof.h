// Roofs on plans: from a shape and its measures to the surfaces above the eaves.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/model/roof_shape.h"

namespace blockrand::roofs {

/// A roof as surfaces over a plan. Edges are numbered ring by ring, outer ring first; edge i starts at corner i.
struct Roof {
  struct Surface {
    std::int32_t edge = -1;                         ///< the plan edge it rises from; -1 when none
    std::vector<std::vector<model::Point3>> loops;  ///< counter-clockwise from above; holes follow
  };
  std::vector<Surface> surfaces;
  /// For each plan edge the upper end of its wall, from the edge's end back to its start: two points at eaves height
  /// for most, three for a gable.
  std::vector<std::vector<model::Point3>> wall_tops;
};

/// Measures of a roof. Heights in metres.
struct RoofMeasures {
  double eaves = 0;   ///< z of the lowest eaves
  double height = 0;  ///< eaves to the highest point
};

/// One horizontal surface.
Roof flat_roof(const model::Polygon& plan, double z);

/// One inclined plane; `down` is the unit vector down the slope. Works on every plan.
std::optional<Roof> skillion_roof(const model::Polygon& plan, RoofMeasures measures, model::Point2 down);

/// Triangles from every edge to an apex over the centroid. Empty for plans with holes and where the centroid does not
/// see every edge from inside.
std::optional<Roof> pyramidal_roof(const model::Polygon& plan, RoofMeasures measures);

/// Equal pitches over all edges by the straight skeleton; on any polygon with holes.
std::optional<Roof> hipped_roof(const model::Polygon& plan, RoofMeasures measures);

/// As hipped, but every end of a wing is closed by a vertical gable: a skeleton triangle whose ridge can be led on to
/// its edge (references/feasibility.md, section 2). `gables` tells how many there are; a ring has none and needs none.
struct GabledRoof {
  Roof roof;
  int gables = 0;
};
std::optional<GabledRoof> gabled_roof(const model::Polygon& plan, RoofMeasures measures);

/// Two equal pitches on a convex plan of four corners. The ridge runs as evenly as it can between the eaves edges
/// `eaves_edge` and the opposite one. Empty when the ridge leaves the plan.
std::optional<Roof> gabled_quadrilateral(const model::Polygon& plan, RoofMeasures measures, int eaves_edge);

/// Unit vector of a compass direction in degrees (0 north, 90 east).
model::Point2 compass_vector(double degrees);

/// A direction down the slope for a lean-to roof that has none tagged: across the longest edge, outwards.
model::Point2 default_slope(const model::Polygon& plan);

}  // namespace blockrand::roofs
