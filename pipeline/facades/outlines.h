// Tests of flat outlines that cutting openings needs: nearness, simplicity, boxes.
#pragma once

#include <span>

#include "pipeline/model/point.h"

namespace blockrand::facades {

/// An upright rectangle of the plane.
struct Box2 {
  double left = 0, right = 0, low = 0, high = 0;
  bool apart(const Box2& b, double distance) const {
    return right + distance < b.left || b.right + distance < left || high + distance < b.low || b.high + distance < low;
  }
};
/// \param ring  one point or more
Box2 box_of(std::span<const model::Point2> ring);

/// True when the closed segments have a point in common.
bool segments_meet(model::Point2 a, model::Point2 b, model::Point2 c, model::Point2 d);

/// True when a point of one ring's border lies nearer than `distance` to the other's.
/// \param around_a  box_of(a): edges of b far from it cost little
bool rings_nearer_than(double distance, std::span<const model::Point2> a, const Box2& around_a,
                       std::span<const model::Point2> b);

/// Inside by the rule of even and odd; for points that are known to lie off the border.
bool surely_inside(std::span<const model::Point2> ring, model::Point2 p);

/// True when no two edges meet but neighbours in their common corner, and every corner lies at least `feature` from
/// every edge that does not end there: rounding by less than half of that leaves the ring simple.
bool is_simple_by(double feature, std::span<const model::Point2> ring);

}  // namespace blockrand::facades
