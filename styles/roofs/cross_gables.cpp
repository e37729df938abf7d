#include "styles/roofs/cross_gables.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/grid.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;

namespace {

std::optional<DormerBody> shape_on(const RoofSlope& plane, const CrossGableParameters& p) {
  if (!takes_elements(plane) || p.width > kWidestElement || p.kind == DormerKind::eyebrow) return std::nullopt;
  return dormer_body({p.kind, p.width, p.wall_height, p.rise, p.roof_pitch, p.chords}, plane.rise);
}

bool same(const Point3& a, const Point3& b) { return geometry::to_grid(a) == geometry::to_grid(b); }

/// Index i in a loop or line of points with points[i] = a and the next = b; -1 when there is none.
std::ptrdiff_t place_of(const std::vector<Point3>& points, const Point3& a, const Point3& b, bool closed) {
  for (std::size_t i = 0; i + (closed ? 0 : 1) < points.size(); ++i)
    if (same(points[i], a) && same(points[(i + 1) % points.size()], b)) return static_cast<std::ptrdiff_t>(i);
  return -1;
}

}  // namespace

std::vector<Point2> cross_gable_outline(const RoofSlope& plane, const CrossGableParameters& parameters) {
  const auto shape = shape_on(plane, parameters);
  return shape ? hull(outline_in_plane(*shape, plane)) : std::vector<Point2>{};
}

bool add_cross_gable(Roof& roof, std::size_t surface, const CrossGableParameters& parameters, Point2 place,
                     std::span<const model::RoofEdge> edges, const ElementDistances& distances) {
  const auto plane = roof_slope(roof, surface, edges);
  if (!plane) return false;
  const auto shape = shape_on(*plane, parameters);
  if (!shape) return false;
  auto outline = hull(outline_in_plane(*shape, *plane));
  for (Point2& p : outline) p = {p.x + place.x, p.y + place.y};
  if (!fits(*plane, outline, distances, true)) return false;
  const auto eaves = std::find_if(plane->borders.begin(), plane->borders.end(), [&](const SlopeBorder& border) {
    return is_level_eaves(*plane, border, place.y) && plane->in_plane(border.start).x < place.x &&
           place.x < plane->in_plane(border.end).x;
  });
  if (eaves == plane->borders.end()) return false;
  const SlopeBorder& border = *eaves;

  auto& loops = roof.surfaces[surface].loops;
  const auto& wall = roof.wall_tops[static_cast<std::size_t>(border.edge)];
  const std::ptrdiff_t in_wall = place_of(wall, border.end, border.start, false);
  std::ptrdiff_t in_loop = -1;
  std::size_t loop = 0;
  for (; loop < loops.size() && in_loop < 0; ++loop) in_loop = place_of(loops[loop], border.start, border.end, true);
  if (in_wall < 0 || in_loop < 0) return false;
  --loop;

  // The eaves' own direction and height carry the front; its roof runs back at right angles to it.
  const double from = plane->in_plane(border.start).x, length = plane->in_plane(border.end).x - from;
  const double share = (place.x - from) / length;
  const double run = std::hypot(border.end.x - border.start.x, border.end.y - border.start.y);
  const Point2 right{(border.end.x - border.start.x) / run, (border.end.y - border.start.y) / run};
  const auto built = [&](const Point3& p) {
    const double s = share + p.x / length;
    const double z = border.start.z + s * (border.end.z - border.start.z);
    return model::snap(Point3{border.start.x + s * (border.end.x - border.start.x) - p.y * right.y,
                              border.start.y + s * (border.end.y - border.start.y) + p.y * right.x, z + p.z});
  };
  const auto built_loop = [&](const std::vector<Point3>& points) {
    std::vector<Point3> out;
    for (const Point3& p : points) out.push_back(built(p));
    return out;
  };
  const auto element = static_cast<std::int32_t>(roof.elements.size());
  roof.elements.push_back(model::RoofElementKind::cross_gable);

  const std::vector<Point3> valley = built_loop(shape->outline);
  auto& slope = loops[loop];
  slope.insert(slope.begin() + in_loop + 1, valley.begin(), valley.end());

  std::vector<Point3> top{shape->outline.back()};
  for (const Point3& p : shape->head)
    if (p != top.back()) top.push_back(p);
  if (top.back() != shape->outline.front()) top.push_back(shape->outline.front());
  const std::vector<Point3> front = built_loop(top);
  auto& wall_top = roof.wall_tops[static_cast<std::size_t>(border.edge)];
  wall_top.insert(wall_top.begin() + in_wall + 1, front.begin(), front.end());

  for (const DormerBody::Face& face : shape->faces)
    roof.surfaces.push_back({-1, {built_loop(face.loop)}, face.upright, element});
  return true;
}

}  // namespace blockrand::roofs
