#include "styles/roofs/roof_slopes.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/grid.h"

namespace blockrand::roofs {

using geometry::Grid3;
using model::Point2;
using model::Point3;

namespace {

bool level(const Point3& a, const Point3& b) { return std::fabs(a.z - b.z) < kLevelLine; }

double highest_of(const Roof::Surface& surface) {
  double z = -1e300;
  for (const Point3& p : surface.loops[0]) z = std::max(z, p.z);
  return z;
}

}  // namespace

CornerPlane corner_plane(std::span<const Point3> loop) {
  CornerPlane out;
  if (loop.empty()) return out;
  const Point3 o = loop[0];
  Point3 n, sum;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point3 &p = loop[i], &q = loop[(i + 1) % loop.size()];
    const Point3 a{p.x - o.x, p.y - o.y, p.z - o.z}, b{q.x - o.x, q.y - o.y, q.z - o.z};
    n.x += a.y * b.z - a.z * b.y;
    n.y += a.z * b.x - a.x * b.z;
    n.z += a.x * b.y - a.y * b.x;
    sum.x += a.x;
    sum.y += a.y;
    sum.z += a.z;
  }
  const double size = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z), count = static_cast<double>(loop.size());
  if (size > 0) out.normal = {n.x / size, n.y / size, n.z / size};
  out.mean = {o.x + sum.x / count, o.y + sum.y / count, o.z + sum.z / count};
  return out;
}

Point2 RoofSlope::in_plane(Point2 p) const {
  const double x = p.x - origin.x, y = p.y - origin.y;
  return {x * along_axis.x + y * along_axis.y, (x * up_axis.x + y * up_axis.y) * slope_length};
}

Point3 RoofSlope::in_space(Point2 p, double above) const {
  const double run = p.y / slope_length;
  return {origin.x + p.x * along_axis.x + run * up_axis.x, origin.y + p.x * along_axis.y + run * up_axis.y,
          origin.z + run * rise + above};
}

double RoofSlope::height_at(Point2 plan) const { return origin.z + in_plane(plan).y / slope_length * rise; }

geometry::Extent RoofSlope::along_extent() const { return geometry::extent_along(loops[0], {1, 0}); }
geometry::Extent RoofSlope::up_extent() const { return geometry::extent_along(loops[0], {0, 1}); }

RoofBorders::RoofBorders(const Roof& roof, std::span<const model::RoofEdge> edges)
    : roof_(&roof), edges_(edges.begin(), edges.end()) {
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s) {
    const Roof::Surface& surface = roof.surfaces[s];
    if (!surface.upright && surface.element == -1 && !surface.loops.empty())
      overhangs_ = overhangs_ || corner_plane(surface.loops[0]).normal.z < 0;
    for (const auto& loop : surface.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        sides_.push_back({geometry::to_grid(loop[i]), geometry::to_grid(loop[(i + 1) % loop.size()]),
                          static_cast<std::int32_t>(s), -1});
  }
  for (std::size_t e = 0; e < roof.wall_tops.size(); ++e) {
    const auto& top = roof.wall_tops[e];
    for (std::size_t i = 0; i + 1 < top.size(); ++i)
      sides_.push_back({geometry::to_grid(top[i]), geometry::to_grid(top[i + 1]), -1, static_cast<std::int32_t>(e)});
  }
  std::sort(sides_.begin(), sides_.end());
}

std::optional<RoofSlope> RoofBorders::slope(std::size_t surface) const {
  if (overhangs_ || surface >= roof_->surfaces.size()) return std::nullopt;
  const Roof::Surface& of = roof_->surfaces[surface];
  if (of.upright || of.element != -1 || of.loops.empty() || of.loops[0].size() < 3) return std::nullopt;
  const CornerPlane flat = corner_plane(of.loops[0]);
  const double across = std::hypot(flat.normal.x, flat.normal.y);
  if (flat.normal.z <= 0 || across < kLevelRise * flat.normal.z) return std::nullopt;
  for (const auto& loop : of.loops)
    for (const Point3& p : loop)
      if (std::fabs((p.x - flat.mean.x) * flat.normal.x + (p.y - flat.mean.y) * flat.normal.y +
                    (p.z - flat.mean.z) * flat.normal.z) > kEvenSurface)
        return std::nullopt;

  RoofSlope out;
  out.surface = surface;
  out.up_axis = {-flat.normal.x / across, -flat.normal.y / across};
  out.along_axis = {out.up_axis.y, -out.up_axis.x};
  out.rise = across / flat.normal.z;
  out.slope_length = std::sqrt(1 + out.rise * out.rise);
  out.origin = flat.mean;

  for (const auto& loop : of.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      SlopeBorder border;
      border.start = loop[i];
      border.end = loop[(i + 1) % loop.size()];
      const Grid3 start = geometry::to_grid(border.start), end = geometry::to_grid(border.end);
      if (start == end) continue;
      const auto found = std::lower_bound(sides_.begin(), sides_.end(), Side{end, start, INT32_MIN, INT32_MIN});
      if (found != sides_.end() && found->start == end && found->end == start) {
        border.edge = found->edge;
        border.neighbour = found->surface;
      }
      const bool is_level = level(border.start, border.end);
      const double way =
          (border.end.x - border.start.x) * out.along_axis.x + (border.end.y - border.start.y) * out.along_axis.y;
      const bool party = border.edge >= 0 && static_cast<std::size_t>(border.edge) < edges_.size() &&
                         edges_[static_cast<std::size_t>(border.edge)] == model::RoofEdge::party_wall;
      if (border.neighbour >= 0 && roof_->surfaces[static_cast<std::size_t>(border.neighbour)].element != -1)
        border.kind = BorderKind::element;
      else if (border.neighbour < 0)
        border.kind = party || !is_level ? BorderKind::side : way > 0 ? BorderKind::eaves : BorderKind::top;
      else
        border.kind = is_level && way < 0 ? BorderKind::top : BorderKind::fold;
      out.borders.push_back(border);
    }
  // Level eaves that lie in one line belong together, also where bays and cross gables part them.
  double left = 1e300, lowest = 1e300, base = 0, widest = 0;
  for (const Point3& p : of.loops[0]) {
    left = std::min(left, out.in_plane(p).x);
    lowest = std::min(lowest, out.in_plane(p).y);
  }
  for (const SlopeBorder& border : out.borders) {
    if (border.kind != BorderKind::eaves) continue;
    const double height = out.in_plane(border.start).y;
    double from = 1e300, to = -1e300;
    for (const SlopeBorder& other : out.borders) {
      if (other.kind != BorderKind::eaves || std::fabs(out.in_plane(other.start).y - height) > kLevelLine) continue;
      from = std::min(from, out.in_plane(other.start).x);
      to = std::max(to, out.in_plane(other.end).x);
    }
    if (to - from <= widest + kLevelLine) continue;
    widest = to - from;
    base = height;
  }
  out.origin = out.in_space({left, widest > 0 ? base : lowest});
  for (const auto& loop : of.loops) {
    out.loops.emplace_back();
    for (const Point3& p : loop) out.loops.back().push_back(out.in_plane(p));
  }
  return out;
}

std::optional<RoofSlope> roof_slope(const Roof& roof, std::size_t surface, std::span<const model::RoofEdge> edges) {
  return RoofBorders(roof, edges).slope(surface);
}

std::vector<RoofSlope> roof_slopes(const Roof& roof, std::span<const model::RoofEdge> edges) {
  const RoofBorders borders(roof, edges);
  std::vector<RoofSlope> out;
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s)
    if (auto plane = borders.slope(s)) out.push_back(std::move(*plane));
  return out;
}

double ridge_above(const Roof& roof, std::size_t surface) {
  const RoofBorders borders(roof, {});
  double highest = highest_of(roof.surfaces[surface]);
  for (bool higher = true; higher;) {
    higher = false;
    const auto plane = borders.slope(surface);
    if (!plane) break;
    for (const SlopeBorder& border : plane->borders) {
      if (border.kind != BorderKind::top || border.neighbour < 0) continue;
      const auto above = static_cast<std::size_t>(border.neighbour);
      if (roof.surfaces[above].upright || roof.surfaces[above].element != -1) continue;
      const double z = highest_of(roof.surfaces[above]);
      if (z <= highest + kLevelLine) continue;
      highest = z;
      surface = above;
      higher = true;
      break;
    }
  }
  return highest;
}

bool lies_level(const Roof::Surface& surface) {
  const Point3 n = corner_plane(surface.loops[0]).normal;
  return std::hypot(n.x, n.y) < kLevelRise * n.z;
}

void occupy(RoofSlope& plane, std::span<const Point2> plan_outline, double distance) {
  OccupiedPlace place;
  place.distance = distance;
  for (const Point2 p : plan_outline) place.outline.push_back(plane.in_plane(p));
  plane.occupied.push_back(std::move(place));
}

}  // namespace blockrand::roofs
