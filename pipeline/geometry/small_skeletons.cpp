// Straight skeletons of convex triangles and quadrilaterals, without CGAL.
#include <array>
#include <cmath>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/straight_skeleton.h"

namespace blockrand::geometry {

namespace {

using model::Point2;

/// A line with its unit normal to the inside: nx x + ny y - d is the distance of (x, y) from it.
struct InwardLine {
  double nx = 0, ny = 0, d = 0;
};

/// The point at equal distance from three lines, and that distance. Empty when there is none.
std::optional<SkeletonNode> equidistant(const InwardLine& a, const InwardLine& b, const InwardLine& c) {
  // n_i . p - t = d_i for three lines; the differences to the first leave two equations for p.
  const double m11 = b.nx - a.nx, m12 = b.ny - a.ny, r1 = b.d - a.d;
  const double m21 = c.nx - a.nx, m22 = c.ny - a.ny, r2 = c.d - a.d;
  const double determinant = m11 * m22 - m12 * m21;
  if (determinant == 0) return std::nullopt;
  const double x = (r1 * m22 - m12 * r2) / determinant, y = (m11 * r2 - r1 * m21) / determinant;
  return SkeletonNode{{x, y}, a.nx * x + a.ny * y - a.d, false};
}

}  // namespace

std::optional<StraightSkeleton> straight_skeleton_closed_form(const model::Polygon& polygon) {
  const std::size_t n = polygon.outer.size();
  if (!polygon.holes.empty() || n < 3 || n > 4) return std::nullopt;
  const auto& points = polygon.outer.points;
  const Point2 origin = points[0];
  for (std::size_t i = 0; i < n; ++i)
    if (orientation(to_grid(points[i]), to_grid(points[(i + 1) % n]), to_grid(points[(i + 2) % n])) <= 0)
      return std::nullopt;
  StraightSkeleton out;
  std::array<InwardLine, 4> line;
  for (std::size_t i = 0; i < n; ++i) {
    out.nodes.push_back({points[i], 0, true});
    const double ax = points[i].x - origin.x, ay = points[i].y - origin.y;
    const double dx = points[(i + 1) % n].x - points[i].x, dy = points[(i + 1) % n].y - points[i].y;
    const double length = std::sqrt(dx * dx + dy * dy);
    line[i] = {-dy / length, dx / length, 0};
    line[i].d = line[i].nx * ax + line[i].ny * ay;
  }
  const auto add = [&](SkeletonNode node) {
    node.point = {node.point.x + origin.x, node.point.y + origin.y};
    out.nodes.push_back(node);
    return static_cast<std::uint32_t>(out.nodes.size() - 1);
  };
  if (n == 3) {
    const auto centre = equidistant(line[0], line[1], line[2]);
    if (!centre || centre->time <= 0) return std::nullopt;
    const std::uint32_t c = add(*centre);
    for (std::uint32_t i = 0; i < 3; ++i) out.faces.push_back({i, {i, (i + 1) % 3, c}});
    return out;
  }
  // The edge that vanishes first.
  std::optional<SkeletonNode> first;
  std::uint32_t vanishing = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto node = equidistant(line[(i + 3) % 4], line[i], line[(i + 1) % 4]);
    if (node && node->time > 0 && (!first || node->time < first->time)) {
      first = node;
      vanishing = i;
    }
  }
  if (!first) return std::nullopt;
  const std::uint32_t i = vanishing, j = (i + 1) % 4, k = (i + 2) % 4, l = (i + 3) % 4;
  const auto second = equidistant(line[l], line[j], line[k]);
  if (!second || second->time < first->time * (1 - 1e-9)) return std::nullopt;
  const std::uint32_t p = add(*first), q = add(*second);
  out.faces.resize(4);
  out.faces[i] = {i, {i, j, p}};
  out.faces[j] = {j, {j, k, q, p}};
  out.faces[k] = {k, {k, l, q}};
  out.faces[l] = {l, {l, i, p, q}};
  return out;
}

std::optional<StraightSkeleton> straight_skeleton(const model::Polygon& polygon) {
  if (auto small = straight_skeleton_closed_form(polygon)) return small;
  return straight_skeleton_by_cgal(polygon);
}

}  // namespace blockrand::geometry
