#include "styles/roofs/gutters.h"

#include <array>
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

/// A pipe in the plane square to its wall: from under the gutter to the wall, down the wall.
std::optional<model::Solid> pipe(Point2 foot, Point2 along, double out_above, double top, double bottom,
                                 const GutterOptions& o) {
  const double half = o.pipe / 2, at_wall = o.pipe_off + half, slant = out_above - at_wall;
  constexpr double kLeastPipe = 0.5;  // m of upright pipe: lower eaves have none
  // A bend of 45 degrees: mitres lie tan(22.5) of half the width off.
  const double mitre = half * 0.41421356237309503;
  const double stub = std::max(o.board - o.below_roof - o.depth, 0.0) + mitre + 0.01, bend = top - stub - std::max(slant, 0.0);
  if (bend - bottom < kLeastPipe) return std::nullopt;
  // (out of the wall, up), counter-clockwise seen along the wall's direction with the wall at the left.
  std::vector<Point2> outline;
  constexpr double kStraight = 0.02;
  if (slant < kStraight) {
    outline = {{out_above - half, bottom}, {out_above + half, bottom}, {out_above + half, top}, {out_above - half, top}};
  } else {
    outline = {{at_wall - half, bottom},
               {at_wall + half, bottom},
               {at_wall + half, bend - mitre},
               {out_above + half, top - stub - mitre},
               {out_above + half, top},
               {out_above - half, top},
               {out_above - half, top - stub + mitre},
               {at_wall - half, bend + mitre}};
  }
  const Point2 outward{along.y, -along.x};
  const auto place = [&](Point2 p, double side) {
    return Point3{foot.x + outward.x * p.x + along.x * side, foot.y + outward.y * p.x + along.y * side, p.y};
  };
  geometry::SolidBuilder builder;
  std::vector<Point3> left, right;
  for (const Point2 p : outline) left.push_back(place(p, -half));
  for (auto p = outline.rbegin(); p != outline.rend(); ++p) right.push_back(place(*p, half));
  model::Face side;
  side.kind = SurfaceKind::wall;
  builder.add_face(left, side);
  builder.add_face(right, side);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2 a = outline[i], b = outline[(i + 1) % outline.size()];
    builder.add_face(std::vector<Point3>{place(a, half), place(b, half), place(b, -half), place(a, -half)}, side);
  }
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

  std::vector<std::array<Point2, 3>> standing;  // of each pipe on the plan: at the wall, between, under the gutter
  const auto is_near_another = [&](const std::array<Point2, 3>& place) {
    constexpr double kBetween = 0.3;  // m
    for (const auto& other : standing)
      for (const Point2 a : place)
        for (const Point2 b : other)
          if (squared_distance(a, b) < kBetween * kBetween) return true;
    return false;
  };
  // The plan of a pipe from the wall to under its gutter meets no overhang but its own, below which it turns.
  const auto is_under_another = [&](const EavesLine& own, Point2 foot, Point2 outward) {
    constexpr double kTouch = 0.003;  // m
    const Point2 side = own.along * (o.pipe / 2), out_there = outward * (own.reach + (o.width + o.pipe) / 2);
    const std::vector<Point2> plan{foot - side, foot + out_there - side, foot + out_there + side, foot + side};
    for (std::size_t i = 0; i < before.strips.size(); ++i)
      if (i != own.strip && !before.strips[i].empty() && convex_overlap(plan, before.strips[i], kTouch)) return true;
    return false;
  };
  const auto try_pipe = [&](const EavesLine& l, bool at_end) {
    const double length = dot(l.to.xy() - l.from.xy(), l.along);
    if (length < o.least_run) return false;
    const Point2 outward{l.along.y, -l.along.x};
    const Point2 end = at_end ? l.to.xy() : l.from.xy();
    const double way = at_end ? -o.from_end - l.reach : o.from_end + l.reach;
    const Point2 foot{end.x - outward.x * l.reach + l.along.x * way, end.y - outward.y * l.reach + l.along.y * way};
    const std::array<Point2, 3> place{foot, foot + outward * (l.reach / 2), foot + outward * (l.reach + o.width / 2)};
    if (is_near_another(place) || is_under_another(l, foot, outward) || !may(foot, l.along, o.pipe / 2)) return false;
    auto solid = pipe(foot, l.along, l.reach + o.width / 2,
                      std::min(l.from.z, l.to.z) - o.below_roof - o.depth, bottom, o);
    if (!solid) return false;
    const auto triangles = geometry::triangulate(*solid);
    if (!triangles || !geometry::check_solid(*solid, *triangles, geometry::kBuilt).valid()) return false;
    out.bodies.push_back({RoofElementKind::downpipe, std::move(*solid), {}});
    standing.push_back(place);
    return true;
  };
  for (std::size_t first = 0; may && first < lines.size();) {
    std::size_t last = first;
    double run = 0;
    while (last + 1 < lines.size() && lines[last].joined_after) ++last;
    for (std::size_t i = first; i <= last; ++i) run += distance(lines[i].from.xy(), lines[i].to.xy());
    bool drained = !lost[last] && try_pipe(lines[last], true);
    if (!drained || run > o.most_to_pipe) drained = (!lost[first] && try_pipe(lines[first], false)) || drained;
    first = last + 1;
  }
  return out;
}

}  // namespace blockrand::roofs
