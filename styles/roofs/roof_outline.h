// A roof's outline, piece by piece: where walls end and which surface begins there.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/polygon.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// A surface as a plane over the plan.
struct RoofPlane {
  model::Point3 point;     ///< m, of the plane
  model::Point2 gradient;  ///< rise over run along x and y
  double height_at(model::Point2 p) const {
    return point.z + gradient.x * (p.x - point.x) + gradient.y * (p.y - point.y);
  }
};
RoofPlane plane_of(const Roof::Surface& surface);

/// A straight piece of the upper end of a wall, along its plan edge.
struct TopSegment {
  std::uint32_t edge = 0;  ///< plan edge, ring by ring
  std::uint32_t ring = 0;  ///< 0: the outer one
  model::Point3 from, to;  ///< m, in the edge's direction; differ in plan
  std::int32_t surface =
      -1;                  ///< of Roof::surfaces, that begins here; -1 for none: the wall stands higher than the roof
  model::Point2 gradient;  ///< of that surface, rise over run
  model::Point2 along;     ///< unit vector, from -> to
  model::Point2 outward() const { return {along.y, -along.x}; }
  double length() const;  ///< m, in plan
};

/// All of them, ring by ring, in order. Pieces of no length in plan are left out: so a segment may begin higher or
/// lower than the one before it ends.
std::vector<TopSegment> top_segments(const model::Polygon& plan, const Roof& roof);

/// Shape of a plan edge: how it looks to elements that stand on it.
struct PlanEdge {
  model::Point2 from, to;  ///< m
  std::uint32_t ring = 0;
  std::uint32_t before = 0, after = 0;  ///< neighbours in the ring
  model::Point2 along;                  ///< unit vector
  double length = 0;                    ///< m
  model::Point2 inward() const { return {-along.y, along.x}; }
};
std::vector<PlanEdge> plan_edges(const model::Polygon& plan);

/// Do two convex polygons (counter-clockwise) have more in common than a strip of `depth` metres along their borders?
bool convex_overlap(const std::vector<model::Point2>& a, const std::vector<model::Point2>& b, double depth);

/// Does the segment pq come deeper than `depth` metres into a convex polygon (counter-clockwise)?
bool segment_enters(const std::vector<model::Point2>& convex, model::Point2 p, model::Point2 q, double depth);

/// Is the area under a surface level, to the tangent of two degrees?
bool is_level(const Roof::Surface& surface);

}  // namespace blockrand::roofs
