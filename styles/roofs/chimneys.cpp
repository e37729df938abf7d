#include "styles/roofs/chimneys.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon.h"
#include "pipeline/geometry/solid_builder.h"
#include "styles/roofs/roof_planes.h"
#include "styles/roofs/standing_shapes.h"

namespace blockrand::roofs {

using geometry::Grid2;
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
  LoopPlane plane;
  double highest = 0;
  bool level = false;
  double at(Point2 p) const {
    const Point3 &n = plane.normal, &m = plane.mean;
    return m.z - (n.x * (p.x - m.x) + n.y * (p.y - m.y)) / n.z;
  }
};

Height height_of(const Roof::Surface& surface) {
  Height out{plane_of(surface.loops[0]), -1e300, false};
  for (const Point3& p : surface.loops[0]) out.highest = std::max(out.highest, p.z);
  out.level = std::hypot(out.plane.normal.x, out.plane.normal.y) < kLevelRise * out.plane.normal.z;
  return out;
}

/// Height of the ridge above a surface: the highest point of it and of what goes on rising over its upper border (the upper
/// slope of a mansard).
double ridge_above(const Roof& roof, std::size_t surface) {
  const RoofBorders borders(roof, {});
  double highest = height_of(roof.surfaces[surface]).highest;
  for (bool higher = true; higher;) {
    higher = false;
    const auto plane = borders.plane(surface);
    if (!plane) break;
    for (const PlaneBorder& border : plane->borders) {
      if (border.kind != BorderKind::top || border.neighbour < 0) continue;
      const auto above = static_cast<std::size_t>(border.neighbour);
      if (roof.surfaces[above].upright || roof.surfaces[above].element != -1) continue;
      const double z = height_of(roof.surfaces[above]).highest;
      if (z <= highest + kLevelLine) continue;
      highest = z;
      surface = above;
      higher = true;
      break;
    }
  }
  return highest;
}

/// A border that crosses a stack: the surface left of it, and where.
struct Crossing {
  std::size_t surface = 0;
  Point3 start, end;
};

}  // namespace

int chimney_count(double frontage, const ChimneyParameters& parameters) {
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
                                               const ChimneyLooks& looks) {
  if (!(p.width >= 2 * kLeastPart && p.length >= 2 * kLeastPart)) return std::nullopt;
  const Outline stack = chimney_outline(place, p), inner = grown(place, p, -kOverWall), around = grown(place, p, p.clearance);
  std::vector<Crossing> crossings;
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s) {
    const Roof::Surface& surface = roof.surfaces[s];
    const bool foreign = surface.upright || surface.element != -1;
    for (const auto& loop : surface.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point3 &a = loop[i], &b = loop[(i + 1) % loop.size()];
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
    level = level && piece.height.level;
  }
  top += level ? p.above_flat : p.above_ridge;
  // The height of the underside: of the lower piece where both planes end, so that it hangs over neither.
  const auto under = [&](Point2 q) {
    double z = 1e300;
    for (const Piece& piece : pieces)
      if (std::find(piece.outline.begin(), piece.outline.end(), q) != piece.outline.end())
        z = std::min(z, piece.height.at(q));
    return Point3{q.x, q.y, z - p.sunk};
  };
  double highest = -1e300;
  for (const Point2 q : ring) highest = std::max(highest, under(q).z + p.sunk);
  if (top - highest > p.tallest) return std::nullopt;
  const auto upper = [&](Point2 q) { return Point3{q.x, q.y, top}; };

  model::Face side = looks.stack, cover = looks.top, below = looks.stack;
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
  return model::RoofInstallation{model::RoofElementKind::chimney, builder.take()};
}

namespace {

/// Middles of equal fields of a line.
void along_line(Point2 from, Point2 to, const ChimneyParameters& p, std::vector<ChimneyPlace>& out) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (length < p.length + 2 * kLeastPart) return;
  const Point2 along{(to.x - from.x) / length, (to.y - from.y) / length};
  const int n = std::max(1, static_cast<int>(std::lround(length / p.step)));
  for (int i = 0; i < n; ++i) {
    const double s = length * (i + 0.5) / n;
    out.push_back({{from.x + s * along.x, from.y + s * along.y}, along});
  }
}

/// Fall of a surface towards its left side of a directed line; positive where it falls.
double fall_left(const Roof::Surface& surface, Point2 along) {
  const Point3 n = plane_of(surface.loops[0]).normal;
  return n.z > 0 ? (n.x * -along.y + n.y * along.x) / n.z : 0;
}

}  // namespace

std::vector<ChimneyPlace> ridge_places(const Roof& roof, const ChimneyParameters& parameters) {
  std::vector<ChimneyPlace> out;
  for (const RoofPlane& plane : roof_planes(roof))
    for (const PlaneBorder& border : plane.borders) {
      if (border.kind != BorderKind::top || border.neighbour < static_cast<std::int32_t>(plane.surface)) continue;
      const Roof::Surface& other = roof.surfaces[static_cast<std::size_t>(border.neighbour)];
      const double length = std::hypot(border.end.x - border.start.x, border.end.y - border.start.y);
      if (other.upright || other.element != -1 || length <= 0) continue;
      const Point2 back{(border.start.x - border.end.x) / length, (border.start.y - border.end.y) / length};
      if (fall_left(other, back) > kLevelRise) along_line(border.start.xy(), border.end.xy(), parameters, out);
    }
  return out;
}

std::vector<ChimneyPlace> party_wall_places(const model::Polygon& plan, std::span<const model::RoofEdge> edges, const Roof& roof,
                                            const ChimneyParameters& parameters) {
  /// A place and how many steps it lies from the highest one of its wall.
  struct Ranked {
    int rank;
    ChimneyPlace place;
  };
  std::vector<Ranked> ranked;
  std::size_t edge = 0;
  const auto place_on = [&](Point2 a, Point2 b, const std::vector<Point3>& top) {
    const double length = std::hypot(b.x - a.x, b.y - a.y), margin = parameters.length / 2 + kLeastPart;
    if (length < 2 * margin) return;
    const Point2 along{(b.x - a.x) / length, (b.y - a.y) / length};
    const double in = parameters.inset + parameters.width / 2;
    const auto way = [&](const Point3& p) { return (p.x - a.x) * along.x + (p.y - a.y) * along.y; };
    const auto add = [&](int rank, double s) {
      if (s >= margin && s <= length - margin)
        ranked.push_back({rank, {{a.x + s * along.x - in * along.y, a.y + s * along.y + in * along.x}, along}});
    };
    double high = -1e300, low = 1e300;
    for (const Point3& p : top) {
      high = std::max(high, p.z);
      low = std::min(low, p.z);
    }
    if (high - low < kLevelLine) {
      const int n = std::max(1, static_cast<int>(std::lround(length / parameters.step)));
      for (int i = 0; i < n; ++i) add(0, length * (i + 0.5) / n);
      return;
    }
    // The middle of what is highest: a ridge's point, or a deck.
    double from = length, to = 0;
    for (const Point3& p : top)
      if (p.z > high - kLevelLine) {
        from = std::min(from, way(p));
        to = std::max(to, way(p));
      }
    const double best = std::clamp((from + to) / 2, margin, length - margin);
    add(0, best);
    for (int k = 1; k * parameters.step < length; ++k)
      for (const int sign : {-1, 1}) add(k, best + sign * k * parameters.step);
  };
  const auto walls = [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i, ++edge)
      if (edge < edges.size() && edge < roof.wall_tops.size() && edges[edge] == model::RoofEdge::party_wall)
        place_on(ring.points[i], ring.points[(i + 1) % ring.size()], roof.wall_tops[edge]);
  };
  walls(plan.outer);
  for (const model::Ring& hole : plan.holes) walls(hole);
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
  std::vector<ChimneyPlace> out;
  for (const Ranked& r : ranked) out.push_back(r.place);
  return out;
}

namespace {

/// Places along the stretches of a line that lie over a surface: the line through `through` along `axis`.
void along_surface(const Roof::Surface& surface, Point2 through, Point2 axis, const ChimneyParameters& parameters,
                   std::vector<ChimneyPlace>& out) {
  const auto off = [&](const Point3& p) { return (p.y - through.y) * axis.x - (p.x - through.x) * axis.y; };
  const auto way = [&](const Point3& p) { return (p.x - through.x) * axis.x + (p.y - through.y) * axis.y; };
  std::vector<double> cuts;
  for (const auto& loop : surface.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 &a = loop[i], &b = loop[(i + 1) % loop.size()];
      if ((off(a) < 0) == (off(b) < 0)) continue;
      cuts.push_back(way(a) + off(a) / (off(a) - off(b)) * (way(b) - way(a)));
    }
  std::sort(cuts.begin(), cuts.end());
  const auto at = [&](double s) { return Point2{through.x + s * axis.x, through.y + s * axis.y}; };
  for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) along_line(at(cuts[i]), at(cuts[i + 1]), parameters, out);
}

}  // namespace

std::vector<ChimneyPlace> flat_places(const Roof& roof, const ChimneyParameters& parameters) {
  std::vector<ChimneyPlace> out;
  for (const Roof::Surface& surface : roof.surfaces) {
    if (surface.upright || surface.element != -1 || surface.loops.empty() || !height_of(surface).level) continue;
    const Outline outline = flat(surface.loops[0]);
    const Point2 axis = geometry::long_axis(outline), square{-axis.y, axis.x}, middle = outline[0];
    const auto across = geometry::extent_along(outline, square);
    // The middle line and, where wings leave it, lines beside it.
    for (const double share : {0.5, 0.25, 0.75, 0.1, 0.9}) {
      const double off = across.minimum + share * (across.maximum - across.minimum) - (middle.x * square.x + middle.y * square.y);
      along_surface(surface, {middle.x + off * square.x, middle.y + off * square.y}, axis, parameters, out);
    }
  }
  return out;
}

namespace {

/// High up the slopes, along their eaves, those that reach highest first: where neither ridge nor wall takes a stack.
std::vector<ChimneyPlace> slope_places(const Roof& roof, const ChimneyParameters& parameters) {
  std::vector<RoofPlane> planes = roof_planes(roof);
  const auto top = [](const RoofPlane& plane) { return plane.in_space({0, plane.up_extent().maximum}).z; };
  std::stable_sort(planes.begin(), planes.end(), [&](const RoofPlane& a, const RoofPlane& b) { return top(a) > top(b); });
  std::vector<ChimneyPlace> out;
  for (const RoofPlane& plane : planes) {
    const auto up = plane.up_extent();
    for (const double share : {0.85, 0.75, 0.6, 0.4}) {
      const double height = up.minimum + share * (up.maximum - up.minimum);
      along_surface(roof.surfaces[plane.surface], plane.in_space({0, height}).xy(), plane.along_axis, parameters, out);
    }
  }
  return out;
}

}  // namespace

std::vector<model::RoofInstallation> chimneys(const model::Polygon& plan, std::span<const model::RoofEdge> edges,
                                              const Roof& roof, double frontage, const ChimneyParameters& parameters,
                                              const ChimneyLooks& looks) {
  std::vector<ChimneyPlace> wanted = party_wall_places(plan, edges, roof, parameters);
  for (const auto& more : {ridge_places(roof, parameters), flat_places(roof, parameters), slope_places(roof, parameters)})
    wanted.insert(wanted.end(), more.begin(), more.end());
  const auto count = static_cast<std::size_t>(chimney_count(frontage, parameters));
  constexpr int kShifts = 4;  // each way
  std::vector<model::RoofInstallation> out;
  std::vector<Point2> taken;
  for (const ChimneyPlace& place : wanted)
    for (int i = 0; i <= 2 * kShifts && out.size() < count; ++i) {
      const double by = parameters.step / 3 * ((i + 1) / 2) / kShifts * (i % 2 == 0 ? 1 : -1);
      ChimneyPlace moved = place;
      moved.middle = {place.middle.x + by * place.along.x, place.middle.y + by * place.along.y};
      const bool near = std::any_of(taken.begin(), taken.end(), [&](Point2 q) {
        return std::hypot(q.x - moved.middle.x, q.y - moved.middle.y) < parameters.step * 5 / 6;
      });
      if (near) continue;
      auto built = chimney(roof, moved, parameters, looks);
      if (!built) continue;
      out.push_back(std::move(*built));
      taken.push_back(moved.middle);
      break;
    }
  return out;
}

}  // namespace blockrand::roofs
