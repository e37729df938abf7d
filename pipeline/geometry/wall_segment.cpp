#include "pipeline/geometry/wall_segment.h"

#include <cmath>

namespace blockrand::geometry {

using model::Point2;

std::optional<WallSegmentEnds> ends_of(const model::Building& building, const model::WallSegment& edge) {
  if (edge.polygon >= building.outline.size() || !(edge.start < edge.end)) return std::nullopt;
  const model::Polygon& polygon = building.outline[edge.polygon];
  if (edge.ring > polygon.holes.size()) return std::nullopt;
  const model::Ring& ring = edge.ring == 0 ? polygon.outer : polygon.holes[edge.ring - 1];
  if (edge.edge >= ring.size()) return std::nullopt;
  const Point2 a = ring.points[edge.edge], b = ring.points[(edge.edge + 1) % ring.size()];
  const double dx = b.x - a.x, dy = b.y - a.y, whole = std::sqrt(dx * dx + dy * dy);
  constexpr double kHalfStep = 0.5 / model::kGridStepsPerMetre;
  const auto at = [&](double metres) {
    if (metres <= kHalfStep) return a;
    if (metres >= whole - kHalfStep) return b;
    return model::snap(Point2{a.x + dx * (metres / whole), a.y + dy * (metres / whole)});
  };
  const WallSegmentEnds ends{at(edge.start), at(edge.end), a, b};
  if (ends.from == ends.to) return std::nullopt;
  return ends;
}

}  // namespace blockrand::geometry
