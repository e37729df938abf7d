#include "styles/roofs/chimneys.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/solid_builder.h"
#include "styles/roofs/element_layout.h"
#include "styles/roofs/roof_slopes.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;

namespace {

/// m. A stack on a wall's line may stand over it by this: corners are rounded.
constexpr double kOverWall = 0.002;

using Outline = std::vector<Point2>;

Outline flat(const std::vector<Point3>& loop) {
  Outline out;
  for (const Point3& p : loop) out.push_back(p.xy());
  return out;
}

bool over(const Roof::Surface& surface, Point2 p) {
  bool in = !surface.loops.empty() && geometry::contains(flat(surface.loops[0]), p);
  for (std::size_t i = 1; i < surface.loops.size(); ++i) in = in && !geometry::contains(flat(surface.loops[i]), p);
  return in;
}

/// What of the segment ab lies in a convex outline, as shares of its way; empty where nothing does.
std::optional<std::pair<double, double>> within(const Outline& outline, Point2 a, Point2 b) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2 p = outline[i], q = outline[(i + 1) % outline.size()];
    const auto left = [&](Point2 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); };
    const double at_a = left(a), at_b = left(b);
    if (at_a < 0 && at_b < 0) return std::nullopt;
    if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
  }
  if (from >= to) return std::nullopt;
  return std::pair(from, to);
}

Outline grown(ChimneyPlace place, const ChimneyParameters& parameters, double by) {
  ChimneyParameters p = parameters;
  p.width += 2 * by;
  p.length += 2 * by;
  return chimney_outline(place, p);
}

/// A surface as height over the plan.
struct Height {
  CornerPlane plane;
  double at(Point2 p) const {
    const Point3 &n = plane.normal, &m = plane.mean;
    return m.z - (n.x * (p.x - m.x) + n.y * (p.y - m.y)) / n.z;
  }
};

Height height_of(const Roof::Surface& surface) { return {corner_plane(surface.loops[0])}; }

/// A border that crosses a stack: the surface left of it, and where.
struct Crossing {
  std::size_t surface = 0;
  Point3 start, end;
};

}  // namespace

int chimney_count(double frontage, const ChimneyParameters& parameters) {
  if (!(frontage > 0) || !(parameters.frontage > 0)) return 1;
  return std::max(1, static_cast<int>(std::lround(frontage / parameters.frontage)));
}

Outline chimney_outline(ChimneyPlace place, const ChimneyParameters& parameters) {
  const double l = parameters.length / 2, w = parameters.width / 2;
  const Point2 m = place.middle, a = place.along;
  Outline out;
  for (const auto& [s, t] : {std::pair(-l, -w), {l, -w}, {l, w}, {-l, w}})
    out.push_back({m.x + s * a.x - t * a.y, m.y + s * a.y + t * a.x});
  return out;
}

std::optional<model::RoofInstallation> chimney(const Roof& roof, ChimneyPlace place, const ChimneyParameters& p,
                                               const ChimneyMaterials& materials) {
  if (!(p.width >= 2 * kLeastPart && p.length >= 2 * kLeastPart)) return std::nullopt;
  const Outline stack = chimney_outline(place, p), inner = grown(place, p, -kOverWall),
                around = grown(place, p, p.clearance);
  // Most of a large roof's edges lie far away; the margin is more than within() rounds.
  const double reach = p.length + p.width + 2 * std::max(0.0, p.clearance) + 1;
  const Point2 m = place.middle;
  const auto beside = [&](const Point3& a, const Point3& b) {
    return std::max(a.x, b.x) < m.x - reach || std::min(a.x, b.x) > m.x + reach || std::max(a.y, b.y) < m.y - reach ||
           std::min(a.y, b.y) > m.y + reach;
  };
  std::vector<Crossing> crossings;
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s) {
    const Roof::Surface& surface = roof.surfaces[s];
    const bool foreign = surface.upright || surface.element != -1;
    for (const auto& loop : surface.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point3 &a = loop[i], &b = loop[(i + 1) % loop.size()];
        if (beside(a, b)) continue;
        if (surface.element != -1 && within(around, a.xy(), b.xy())) return std::nullopt;
        if (!within(inner, a.xy(), b.xy())) continue;
        if (foreign) return std::nullopt;
        crossings.push_back({s, a, b});
      }
    if (surface.element != -1 && !surface.upright && over(surface, place.middle)) return std::nullopt;
  }

  // The pieces of its plan, each over one surface.
  struct Piece {
    std::size_t surface;
    Height height;
    Outline outline;
  };
  std::vector<Piece> pieces;
  Outline ring = stack;  // with the points where the line between two surfaces leaves it
  if (crossings.empty()) {
    for (std::size_t s = 0; s < roof.surfaces.size(); ++s)
      if (const Roof::Surface& surface = roof.surfaces[s];
          !surface.upright && surface.element == -1 && over(surface, place.middle))
        pieces.push_back({s, height_of(surface), stack});
    if (pieces.size() != 1) return std::nullopt;  // none, or one over the other: an onion's bulge
  } else {
    if (crossings.size() != 2 || geometry::to_grid(crossings[0].start) != geometry::to_grid(crossings[1].end) ||
        geometry::to_grid(crossings[0].end) != geometry::to_grid(crossings[1].start))
      return std::nullopt;
    const Point2 a = crossings[0].start.xy(), b = crossings[0].end.xy();
    const auto left = [&](Point2 q) {
      return ((b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x)) / std::hypot(b.x - a.x, b.y - a.y);
    };
    const auto inside = within(stack, a, b);
    if (!inside || inside->first <= 0 || inside->second >= 1) return std::nullopt;  // a surface ends below the stack
    ring.clear();
    for (const Crossing& crossing : crossings)
      pieces.push_back({crossing.surface, height_of(roof.surfaces[crossing.surface]), {}});
    for (std::size_t i = 0; i < 4; ++i) {
      const Point2 q = stack[i], r = stack[(i + 1) % 4];
      const double here = left(q), there = left(r);
      if (std::fabs(here) < kLeastPart) return std::nullopt;
      ring.push_back(q);
      pieces[here > 0 ? 0 : 1].outline.push_back(q);
      if ((here > 0) == (there > 0)) continue;
      const double share = here / (here - there);
      const Point2 cut{q.x + share * (r.x - q.x), q.y + share * (r.y - q.y)};
      ring.push_back(cut);
      for (Piece& piece : pieces) piece.outline.push_back(cut);
    }
  }

  double top = -1e300;
  bool level = true;
  for (const Piece& piece : pieces) {
    if (!(piece.height.plane.normal.z > 0.01)) return std::nullopt;
    top = std::max(top, ridge_above(roof, piece.surface));
    level = level && lies_level(roof.surfaces[piece.surface]);
  }
  top += level ? p.above_flat : p.above_ridge;
  // The height of the underside: of the higher piece where both planes end, so that it cuts into neither.
  const auto under = [&](Point2 q) {
    double z = -1e300;
    for (const Piece& piece : pieces)
      if (std::find(piece.outline.begin(), piece.outline.end(), q) != piece.outline.end())
        z = std::max(z, piece.height.at(q) + p.gap / piece.height.plane.normal.z);
    return Point3{q.x, q.y, z};
  };
  double highest = -1e300;
  for (const Point2 q : ring) highest = std::max(highest, under(q).z);
  if (top - highest > p.tallest) return std::nullopt;
  const auto upper = [&](Point2 q) { return Point3{q.x, q.y, top}; };

  model::Face side = materials.stack, cover = materials.top, below = materials.stack;
  side.kind = model::SurfaceKind::wall;
  cover.kind = model::SurfaceKind::roof;
  below.kind = model::SurfaceKind::closure;
  side.edge = cover.edge = below.edge = -1;
  geometry::SolidBuilder builder;
  for (const Piece& piece : pieces) {
    std::vector<Point3> loop;
    for (auto q = piece.outline.rbegin(); q != piece.outline.rend(); ++q) loop.push_back(under(*q));
    builder.add_face(loop, below);
  }
  std::vector<Point3> cap;
  for (const Point2 q : stack) cap.push_back(upper(q));
  builder.add_face(cap, cover);
  for (std::size_t i = 0; i < 4; ++i) {
    const Point2 q = stack[i], r = stack[(i + 1) % 4];
    std::vector<Point3> loop{under(q)};
    const auto at = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), q) - ring.begin());
    if (const Point2 next = ring[(at + 1) % ring.size()]; next != r) loop.push_back(under(next));
    loop.insert(loop.end(), {under(r), upper(r), upper(q)});
    builder.add_face(loop, side);
  }
  return model::RoofInstallation{model::RoofElementKind::chimney, builder.take(), {}};
}

}  // namespace blockrand::roofs
