#include "pipeline/context/edge_samples.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon.h"

namespace blockrand::context {

namespace {

using model::EdgeKind;
using model::Point2;

/// m. Rays begin this far before the wall: clear of its own rounding.
constexpr double kBefore = 0.02;
/// m. Yards and squares are asked this far before the wall: their outlines are as wrong as the walls'.
constexpr double kAsk = 0.45;
/// Rays of the fan that look straight ahead: up to 40 degrees to either side.
constexpr int kAhead = 3;

std::array<double, kFanRays> weights_ahead(Point2 outward, const std::array<Point2, kFanRays>& fan) {
  std::array<double, kFanRays> out{};
  double sum = 0;
  for (int i = kFanRays / 2 - kAhead; i <= kFanRays / 2 + kAhead; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out[k] = fan[k].x * outward.x + fan[k].y * outward.y;
    sum += out[k];
  }
  for (double& w : out) w /= sum;
  return out;
}

}  // namespace

BuildingView view_of(const model::Building& building, const SurroundingsIndex& index) {
  const SurroundingsIndex::Box box = box_of(building, 2 * kAsk);
  return {&index, index.yards_near(box), index.squares_near(box)};
}

EdgeSample look_out(const OutlineEdge& edge, double at, const BuildingView& view, const EdgeOptions& options) {
  const SurroundingsIndex& index = *view.index;
  EdgeSample out;
  out.at = at;
  const Point2 wall = edge.at(at);
  const Point2 eye{wall.x + edge.outward.x * kBefore, wall.y + edge.outward.y * kBefore};
  const Point2 front{wall.x + edge.outward.x * kAsk, wall.y + edge.outward.y * kAsk};
  const std::array<Point2, kFanRays> fan = fan_around(edge.outward);
  const std::array<double, kFanRays> ahead = weights_ahead(edge.outward, fan);
  for (std::size_t i = 0; i < kFanRays; ++i) {
    const Sight& sight = out.fan[i] = index.scene().look(eye, fan[i], options.view);
    if (sight.street <= options.street_view) out.ahead += ahead[i];
    if (sight.street <= options.view)
      out.street_share += 1.0 / kFanRays;
    else if (sight.wall <= options.view)
      out.enclosed += 1.0 / kFanRays;
  }
  const Sight& straight = out.fan[kFanRays / 2];
  if (straight.from_inside) out.inside = straight.footprint;
  for (const std::uint32_t s : view.squares)
    if (out.square == kNothing && index.contains(index.squares()[s], front)) out.square = s;
  for (const std::uint32_t y : view.yards)
    if (out.yard == kNothing && geometry::contains(index.courtyard(index.yards()[y]).polygon, front)) out.yard = y;

  if (out.inside != kNothing)
    out.kind = EdgeKind::party_wall;
  else if (out.square != kNothing || out.ahead >= 0.5)
    out.kind = EdgeKind::street;
  else if (out.yard != kNothing || out.enclosed >= 0.6)
    out.kind = EdgeKind::courtyard;
  else
    out.kind = EdgeKind::side;
  out.certainty = 1;
  return out;
}

}  // namespace blockrand::context
