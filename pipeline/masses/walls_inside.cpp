#include "pipeline/masses/walls_inside.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/grid_side.h"

namespace blockrand::masses {

namespace {

using model::Point2;
using model::Solid;

/// m. Points farther before a wall are no matter of rounding.
constexpr double kRounding = 2 / model::kGridStepsPerMetre;

/// From left to right, seen from outside: the one edge of a wall at the lowest level.
std::optional<std::pair<Point2, Point2>> foot_of(const Solid& solid, std::span<const std::uint32_t> ring, double low) {
  std::optional<std::pair<Point2, Point2>> foot;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto &a = solid.vertices[ring[i]], &b = solid.vertices[ring[(i + 1) % ring.size()]];
    if (a.z != low || b.z != low) continue;
    if (foot) return std::nullopt;
    foot.emplace(a.xy(), b.xy());
  }
  return foot;
}

}  // namespace

bool keep_walls_inside(Solid& solid) {
  double low = std::numeric_limits<double>::infinity();
  for (const auto& p : solid.vertices) low = std::min(low, p.z);
  bool moved = false;
  for (const model::Face& face : solid.faces) {
    if (face.kind != model::SurfaceKind::wall || face.loop_count == 0) continue;
    const auto ring = solid.indices_of(solid.loops_of(face)[0]);
    const auto foot = foot_of(solid, ring, low);
    if (!foot) continue;
    const auto [a, b] = *foot;
    const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    for (const std::uint32_t i : ring) {
      const Point2 p = solid.vertices[i].xy();
      if (geometry::orientation(geometry::to_grid(a), geometry::to_grid(b), geometry::to_grid(p)) >= 0) continue;
      const double before = dy * (p.x - a.x) - dx * (p.y - a.y);
      if (before * before > kRounding * kRounding * length2) continue;
      const Point2 to = geometry::grid_point_on_left(p, a, b);
      solid.vertices[i].x = to.x;
      solid.vertices[i].y = to.y;
      moved = true;
    }
  }
  return moved;
}

}  // namespace blockrand::masses
