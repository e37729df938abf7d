// Rings and polygons of a footprint.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::model {

/// Outer rings run counter-clockwise, holes clockwise; the last point is not repeated.
/// `nodes[i]` is the OSM node behind `points[i]`, or 0 where a repair made the point (entrances, exact sharing and
/// stable edge ids hang on it). Both vectors have the same length.
struct Ring {
  std::vector<Point2> points;
  std::vector<std::int64_t> nodes;
  std::size_t size() const { return points.size(); }
};

/// After `repair` no ring touches itself or another ring.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

}  // namespace blockrand::model
