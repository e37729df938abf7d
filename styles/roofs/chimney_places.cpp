// Where chimneys stand: along ridges, party walls, level surfaces and slopes.
#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "styles/roofs/chimneys.h"
#include "styles/roofs/element_layout.h"
#include "styles/roofs/roof_slopes.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;

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
  const Point3 n = corner_plane(surface.loops[0]).normal;
  return n.z > 0 ? (n.x * -along.y + n.y * along.x) / n.z : 0;
}

}  // namespace

std::vector<ChimneyPlace> ridge_places(const Roof& roof, const ChimneyParameters& parameters) {
  std::vector<ChimneyPlace> out;
  for (const RoofSlope& plane : roof_slopes(roof))
    for (const SlopeBorder& border : plane.borders) {
      if (border.kind != BorderKind::top || border.neighbour < static_cast<std::int32_t>(plane.surface)) continue;
      const Roof::Surface& other = roof.surfaces[static_cast<std::size_t>(border.neighbour)];
      const double length = std::hypot(border.end.x - border.start.x, border.end.y - border.start.y);
      if (other.upright || other.element != -1 || length <= 0) continue;
      const Point2 back{(border.start.x - border.end.x) / length, (border.start.y - border.end.y) / length};
      if (fall_left(other, back) > kLevelRise) along_line(border.start.xy(), border.end.xy(), parameters, out);
    }
  return out;
}

std::vector<ChimneyPlace> party_wall_places(const model::Polygon& plan, std::span<const model::RoofEdge> edges,
                                            const Roof& roof, const ChimneyParameters& parameters) {
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
    if (surface.upright || surface.element != -1 || surface.loops.empty() || !lies_level(surface)) continue;
    std::vector<Point2> outline;
    for (const Point3& p : surface.loops[0]) outline.push_back(p.xy());
    const Point2 axis = geometry::long_axis(outline), square{-axis.y, axis.x}, middle = outline[0];
    const auto across = geometry::extent_along(outline, square);
    // The middle line and, where wings leave it, lines beside it.
    for (const double share : {0.5, 0.25, 0.75, 0.1, 0.9}) {
      const double off =
          across.minimum + share * (across.maximum - across.minimum) - (middle.x * square.x + middle.y * square.y);
      along_surface(surface, {middle.x + off * square.x, middle.y + off * square.y}, axis, parameters, out);
    }
  }
  return out;
}

namespace {

/// High up the slopes, along their eaves, those that reach highest first: where neither ridge nor wall takes a stack.
std::vector<ChimneyPlace> slope_places(const Roof& roof, const ChimneyParameters& parameters) {
  std::vector<RoofSlope> planes = roof_slopes(roof);
  const auto top = [](const RoofSlope& plane) { return plane.in_space({0, plane.up_extent().maximum}).z; };
  std::stable_sort(planes.begin(), planes.end(),
                   [&](const RoofSlope& a, const RoofSlope& b) { return top(a) > top(b); });
  std::vector<ChimneyPlace> out;
  for (const RoofSlope& plane : planes) {
    // On the lower slope of a mansard a stack would stand high in the air.
    if (ridge_above(roof, plane.surface) > top(plane) + kLevelLine) continue;
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
                                              const ChimneyMaterials& materials) {
  std::vector<ChimneyPlace> wanted = party_wall_places(plan, edges, roof, parameters);
  for (const auto& more :
       {ridge_places(roof, parameters), flat_places(roof, parameters), slope_places(roof, parameters)})
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
      auto built = chimney(roof, moved, parameters, materials);
      if (!built) continue;
      out.push_back(std::move(*built));
      taken.push_back(moved.middle);
      break;
    }
  return out;
}

}  // namespace blockrand::roofs
