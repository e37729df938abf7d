#include "styles/roofs/gutters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/solid_builder.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roofs {
namespace {

using model::Point2;
using model::Point3;
using model::RoofElementKind;
using model::SurfaceKind;

PlanCell cell_of(const EavesLine& l, const GutterOptions& o) {
  // As much of a half-round one as two faces show: water, and a side that falls from the rim to the board.
  const double a = l.from.z - o.below_roof, b = l.to.z - o.below_roof;
  return {{{{l.from.xy(), a - o.depth, a, false},
            {l.out_from, a, a, false},
            {l.out_to, b, b, false},
            {l.to.xy(), b - o.depth, b, true}}}};
}

/// A pipe upright before its wall, from z = `bottom` to `top`.
std::optional<model::Solid> pipe(Point2 foot, Point2 along, double top, double bottom, const GutterOptions& o) {
  constexpr double kLeastPipe = 0.5;  // m: lower eaves have none
  if (top - bottom < kLeastPipe) return std::nullopt;
  const Point2 outward{along.y, -along.x}, side = along * (o.pipe / 2), near = foot + outward * o.pipe_off,
                                           far = near + outward * o.pipe;
  const Point2 plan[] = {near - side, near + side, far + side, far - side};
  const auto at = [&](std::size_t i, double z) { return Point3{plan[i % 4].x, plan[i % 4].y, z}; };
  model::Face looks;
  looks.kind = SurfaceKind::wall;
  geometry::SolidBuilder builder;
  builder.add_face(std::vector<Point3>{at(0, bottom), at(1, bottom), at(2, bottom), at(3, bottom)}, looks);
  builder.add_face(std::vector<Point3>{at(3, top), at(2, top), at(1, top), at(0, top)}, looks);
  for (std::size_t i = 0; i < 4; ++i)
    builder.add_face(std::vector<Point3>{at(i, bottom), at(i, top), at(i + 1, top), at(i + 1, bottom)}, looks);
  return builder.take();
}

}  // namespace

BuiltElements gutters(const BuiltOverhangs& before, double bottom, const MayComeDown& may, const GutterOptions& o) {
  const std::vector<EavesLine>& lines = before.eaves;
  BuiltElements out;
  out.asked = static_cast<int>(lines.size());
  std::vector<PlanCell> cells;
  for (const EavesLine& line : lines) cells.push_back(cell_of(line, o));
  CellBodies made = bodies_of_cells(cells, {SurfaceKind::roof, SurfaceKind::wall, SurfaceKind::outer_ceiling});
  for (model::Solid& solid : made.solids) out.bodies.push_back({RoofElementKind::gutter, std::move(solid), {}});
  out.refused = static_cast<int>(made.lost.size());
  std::vector<bool> lost(lines.size(), false);
  for (const std::uint32_t i : made.lost) lost[i] = true;

  std::vector<Point2> standing;  // feet of pipes
  const auto is_near_another = [&](Point2 foot) {
    constexpr double kBetween = 0.5;  // m
    return std::ranges::any_of(standing, [&](Point2 p) { return squared_distance(p, foot) < kBetween * kBetween; });
  };
  // Under its own overhang it may stand, under no other, and in no wall.
  const auto is_in_the_way = [&](const EavesLine& own, Point2 foot, Point2 outward) {
    constexpr double kTouch = 0.003;  // m
    const Point2 side = own.along * (o.pipe / 2), out_there = outward * (o.pipe_off + o.pipe);
    const std::vector<Point2> plan{foot - side, foot + out_there - side, foot + out_there + side, foot + side};
    for (std::size_t i = 0; i < before.strips.size(); ++i)
      if (i != own.strip && !before.strips[i].empty() && convex_overlap(plan, before.strips[i], kTouch)) return true;
    const Point2 off = outward * o.pipe_off;
    const std::vector<Point2> itself{plan[0] + off, plan[1], plan[2], plan[3] + off};
    for (const auto& [from, to] : before.walls)
      if (segment_enters(itself, from, to, kTouch)) return true;
    return false;
  };
  const auto try_pipe = [&](const EavesLine& l, bool at_end) {
    const double length = dot(l.to.xy() - l.from.xy(), l.along);
    if (length < o.least_run) return false;
    const Point2 outward{l.along.y, -l.along.x};
    // Near the end of the wall; in an inner corner clear of the other wall's overhang.
    const Point2 inwards = at_end ? -l.along : l.along;
    Point2 foot = (at_end ? l.wall_to : l.wall_from) + inwards * o.from_end;
    if (is_in_the_way(l, foot, outward)) foot = foot + inwards * (2 * (l.reach + o.width));
    if (dot(foot - l.wall_from, l.along) < o.pipe || dot(l.wall_to - foot, l.along) < o.pipe) return false;
    if (is_near_another(foot) || is_in_the_way(l, foot, outward) || !may(foot, l.along, o.pipe / 2)) return false;
    // Up to the soffit, which rises towards the wall.
    const double soffit =
        std::min(l.from.z, l.to.z) - o.board + std::max(l.reach - o.pipe_off - o.pipe, 0.0) * l.steepness;
    constexpr double kUnderSoffit = 0.01;  // m
    auto solid = pipe(foot, l.along, soffit - kUnderSoffit, bottom, o);
    if (!solid) return false;
    const auto triangles = geometry::triangulate(*solid);
    if (!triangles || !geometry::check_solid(*solid, *triangles, geometry::kBuilt).valid()) return false;
    out.bodies.push_back({RoofElementKind::downpipe, std::move(*solid), {}});
    standing.push_back(foot);
    return true;
  };
  for (std::size_t first = 0; may && first < lines.size();) {
    std::size_t last = first;
    while (last + 1 < lines.size() && lines[last].joined_after) ++last;
    // A pipe wherever so much gutter has come together, at the ends of walls; else wherever there is room for one.
    bool drained = false;
    double run = 0;
    for (std::size_t i = first; i <= last; ++i) {
      run += distance(lines[i].from.xy(), lines[i].to.xy());
      if (lost[i] || (i < last && run < o.most_to_pipe) || !try_pipe(lines[i], true)) continue;
      drained = true;
      run = 0;
    }
    for (std::size_t i = first; i <= last; ++i) {
      const bool long_one = distance(lines[i].from.xy(), lines[i].to.xy()) > o.most_to_pipe;
      if (!lost[i] && (!drained || long_one)) drained = try_pipe(lines[i], false) || drained;
    }
    first = last + 1;
  }
  return out;
}

}  // namespace blockrand::roofs
