#include "styles/roofs/firewalls.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "styles/roofs/cut_cells.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roofs {

using model::Point2;
using model::RoofElementKind;
using model::SurfaceKind;

namespace {

/// A line of heights along an edge; of two points at one place the later one counts beyond it.
using HeightLine = std::vector<NeighbourTop>;

double height_at(const HeightLine& line, double along) {
  if (along <= line.front().along) return line.front().height;
  for (std::size_t i = 1; i < line.size(); ++i)
    if (along <= line[i].along && line[i].along > line[i - 1].along) {
      const double share = (along - line[i - 1].along) / (line[i].along - line[i - 1].along);
      return line[i - 1].height + share * (line[i].height - line[i - 1].height);
    }
  return line.back().height;
}

struct HigherInterval {
  std::uint32_t edge = 0;
  double start = 0, end = 0;  ///< m along the edge
};

/// Where the neighbour is lower.
std::vector<HigherInterval> open_intervals(std::uint32_t edge, const HeightLine& own, const HeightLine& neighbour,
                                           double length, const FirewallOptions& options) {
  if (neighbour.empty()) return {{edge, 0, length}};
  std::vector<double> places{0, length};
  for (const auto* line : {&own, &neighbour})
    for (const NeighbourTop& p : *line)
      if (p.along > 0 && p.along < length) places.push_back(p.along);
  std::sort(places.begin(), places.end());
  constexpr double kSamePlace = 1e-6;  // m
  const auto over = [&](double s) { return height_at(own, s) - options.lower_by - height_at(neighbour, s); };
  std::vector<HigherInterval> out;
  const auto add = [&](double from, double to) {
    if (to - from < kSamePlace) return;
    if (!out.empty() && from - out.back().end < kSamePlace)
      out.back().end = to;
    else
      out.push_back({edge, from, to});
  };
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double a = places[i - 1], b = places[i];
    if (b - a < kSamePlace) continue;
    // Just inside, since heights may step at the places.
    const double inset = std::min(kSamePlace, (b - a) / 4), at_a = over(a + inset), at_b = over(b - inset);
    if (at_a <= 0 && at_b <= 0) continue;
    const double crossing = at_a * at_b < 0 ? a + (b - a) * at_a / (at_a - at_b) : 0;
    add(at_a > 0 ? a : crossing, at_b > 0 ? b : crossing);
  }
  std::erase_if(out, [&](const HigherInterval& s) { return s.end - s.start < options.least_length; });
  return out;
}

}  // namespace

BuiltFirewalls firewalls(const model::Polygon& plan, const Roof& roof, std::span<const FirewallSide> sides,
                         std::span<const std::vector<Point2>> keep_clear, const FirewallOptions& options) {
  const auto edges = plan_edges(plan);
  std::vector<HeightLine> own(edges.size());
  std::vector<std::vector<std::pair<double, Point2>>> tops(edges.size());
  for (const TopSegment& s : top_segments(plan, roof)) {
    const PlanEdge& e = edges[s.edge];
    for (const model::Point3& p : {s.from, s.to}) {
      own[s.edge].push_back({(p.x - e.from.x) * e.along.x + (p.y - e.from.y) * e.along.y, p.z});
      tops[s.edge].push_back({own[s.edge].back().along, p.xy()});
    }
  }
  std::vector<HigherInterval> stretches;
  for (std::uint32_t i = 0; i < edges.size() && i < sides.size(); ++i)
    if (sides[i].party_wall && !own[i].empty())
      for (const HigherInterval& s : open_intervals(i, own[i], sides[i].neighbour, edges[i].length, options))
        stretches.push_back(s);

  BuiltFirewalls out;
  std::set<std::uint32_t> asked, built;
  std::vector<std::vector<Point2>> strips;
  for (const HigherInterval& s : stretches) {
    asked.insert(s.edge);
    const PlanEdge& e = edges[s.edge];
    const Point2 in = e.inward();
    const auto at = [&](double along, double deep) {
      return model::snap(
          Point2{e.from.x + e.along.x * along + in.x * deep, e.from.y + e.along.y * along + in.y * deep});
    };
    // At inner corners both walls go on to where their inner faces meet.
    const auto reaches = [&](std::uint32_t edge, bool its_end) {
      return std::any_of(stretches.begin(), stretches.end(), [&](const HigherInterval& o) {
        return o.edge == edge && (its_end ? o.end > edges[edge].length - 1e-6 : o.start < 1e-6);
      });
    };
    const auto beyond = [&](Point2 along, Point2 other) {
      const double turn = along.x * other.y - along.y * other.x, way = along.x * other.x + along.y * other.y;
      constexpr double kSharpest = 1.6;  // m beyond the corner, per metre of thickness: 58 degrees of half a bend
      return turn < 0 ? options.thickness * std::min(kSharpest, -turn / std::max(1e-6, 1 + way)) : 0.0;
    };
    double start = s.start, end = s.end;
    if (s.start < 1e-6 && reaches(e.before, true)) start -= beyond(edges[e.before].along, e.along);
    if (s.end > e.length - 1e-6 && reaches(e.after, false)) end += beyond(e.along, edges[e.after].along);
    const Point2 first = s.start < 1e-6 ? e.from : at(s.start, 0), last = s.end > e.length - 1e-6 ? e.to : at(s.end, 0);
    out.places.push_back({first, last, at(end, options.thickness), at(start, options.thickness)});
    // Points of the wall's upper end lie off the edge's line by their rounding; the strip keeps to them.
    std::vector<Point2> region{first};
    constexpr double kApart = 0.003;  // m
    double before = s.start;
    for (const auto& [along, p] : tops[s.edge])
      if (along > before + kApart && along < s.end - kApart) {
        region.push_back(p);
        before = along;
      }
    region.insert(region.end(), out.places.back().begin() + 1, out.places.back().end());
    strips.push_back(std::move(region));
  }
  out.elements.asked = static_cast<int>(asked.size());
  if (stretches.empty()) return out;
  std::vector<PlanCell> cells;
  std::vector<std::uint32_t> edge_of;
  std::vector<RoofPlane> planes;
  for (const auto& surface : roof.surfaces) planes.push_back(surface.upright ? RoofPlane{} : plane_of(surface));
  // What lies in something else's place belongs to that: the first region that holds a piece counts.
  std::vector<std::vector<Point2>> regions(keep_clear.begin(), keep_clear.end());
  regions.insert(regions.end(), strips.begin(), strips.end());
  for (const RoofPiece& piece : pieces_under(roof, regions)) {
    if (piece.region < keep_clear.size()) continue;
    const RoofPlane& plane = planes[static_cast<std::size_t>(piece.surface)];
    PlanCell cell;
    const auto add = [&](const model::Ring& ring) {
      cell.loops.emplace_back();
      for (const Point2 p : ring.points) {
        const double z = plane.height_at(p);
        cell.loops.back().push_back({p, z, z + options.height, false});
      }
    };
    add(piece.plan.outer);
    for (const auto& hole : piece.plan.holes) add(hole);
    cells.push_back(std::move(cell));
    edge_of.push_back(stretches[piece.region - keep_clear.size()].edge);
  }
  CellBodies made = bodies_of_cells(cells, {SurfaceKind::roof, SurfaceKind::wall, SurfaceKind::closure});
  for (model::Solid& solid : made.solids)
    out.elements.bodies.push_back({RoofElementKind::firewall, std::move(solid), {}});
  for (std::uint32_t c = 0; c < cells.size(); ++c)
    if (!std::binary_search(made.lost.begin(), made.lost.end(), c)) built.insert(edge_of[c]);
  for (const std::uint32_t edge : asked) out.elements.refused += !built.contains(edge);
  return out;
}

}  // namespace blockrand::roofs
