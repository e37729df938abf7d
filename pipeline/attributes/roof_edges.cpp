#include "pipeline/attributes/roof_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "pipeline/attributes/roof_plan_corners.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

namespace blockrand::attributes {

using model::Point2;
using model::Polygon;
using model::Ring;
using model::RoofEdge;
using model::WallSegmentKind;

namespace {

constexpr double kPartyShare = 0.5;  ///< of an edge: neighbours that stand at less of it stand beside it
constexpr double kRearShare = 0.75;  ///< the same of edges that look away from the street (roofs::party_share_of)
constexpr double kLooksAway = -0.68199836006249850;  ///< cosine of 133 degrees

RoofEdge kind_of(const model::WallSegment& e) {
  switch (e.kind) {
    case WallSegmentKind::street:
    case WallSegmentKind::passage:
      return RoofEdge::street;  // gateways open from streets, mostly
    case WallSegmentKind::courtyard:
      return RoofEdge::courtyard;
    case WallSegmentKind::party_wall:
      return e.outbuilding ? RoofEdge::open : RoofEdge::party_wall;
    case WallSegmentKind::unknown:
    case WallSegmentKind::side:
      break;
  }
  return RoofEdge::open;
}

/// m of the wall segment from a to b that lie on the edge from p to q and run its way.
double common_length(Point2 a, Point2 b, Point2 p, Point2 q) {
  const double length = distance(q, p);
  const Point2 u{(q.x - p.x) / length, (q.y - p.y) / length};
  const auto off = [&](Point2 r) { return std::fabs((r.x - p.x) * u.y - (r.y - p.y) * u.x); };
  const auto way = [&](Point2 r) { return (r.x - p.x) * u.x + (r.y - p.y) * u.y; };
  const double from = std::max(way(a), 0.0), to = std::min(way(b), length);
  if (to <= from) return 0;
  // Where the two run side by side, not at the wall segment's far ends, which may lie on another edge.
  const double whole = way(b) - way(a);
  const auto at = [&](double w) {
    const double t = (w - way(a)) / whole;
    return Point2{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
  };
  return std::max(off(at(from)), off(at(to))) <= kSameWall ? to - from : 0;
}

std::vector<RoofEdge> edges_on(const OutlineSegments& segments, const Polygon& plan) {
  std::vector<RoofEdge> out;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      out.push_back(segments.kind(ring.points[i], ring.points[(i + 1) % ring.size()]));
  };
  add(plan.outer);
  for (const Ring& hole : plan.holes) add(hole);
  return out;
}

}  // namespace

OutlineSegments::OutlineSegments(const model::Building& building) {
  segments_.reserve(building.edges.size());
  std::tuple<long long, Point2> longest;
  for (const model::WallSegment& e : building.edges) {
    if (e.polygon >= building.outline.size()) continue;
    const Polygon& outline = building.outline[e.polygon];
    if (e.ring > outline.holes.size()) continue;
    const Ring& ring = e.ring == 0 ? outline.outer : outline.holes[e.ring - 1];
    if (e.edge >= ring.size()) continue;
    const Point2 p = ring.points[e.edge], q = ring.points[(e.edge + 1) % ring.size()];
    const double length = distance(q, p);
    if (length <= 0) continue;
    const auto at = [&](double s) { return Point2{p.x + (q.x - p.x) * s / length, p.y + (q.y - p.y) * s / length}; };
    segments_.push_back({at(e.start), at(e.end), kind_of(e), e.covered_height});
    // The longest front; of equal ones the one with the least corner.
    const OutlineSegment& last = segments_.back();
    const std::tuple key(std::llround((e.end - e.start) * 100), Point2{-last.a.x, -last.a.y});
    if (last.kind != RoofEdge::street || (street_ && key <= longest)) continue;
    longest = key;
    street_ = Point2{(q.y - p.y) / length, -(q.x - p.x) / length};
  }
}

RoofEdge OutlineSegments::kind(Point2 p, Point2 q) const {
  std::array<double, 4> length{};
  const double low_x = std::min(p.x, q.x) - kSameWall, high_x = std::max(p.x, q.x) + kSameWall;
  const double low_y = std::min(p.y, q.y) - kSameWall, high_y = std::max(p.y, q.y) + kSameWall;
  for (const OutlineSegment& s : segments_) {
    if (std::max(s.a.x, s.b.x) < low_x || std::min(s.a.x, s.b.x) > high_x || std::max(s.a.y, s.b.y) < low_y ||
        std::min(s.a.y, s.b.y) > high_y)
      continue;
    length[static_cast<std::size_t>(s.kind)] += common_length(s.a, s.b, p, q);
  }
  const double whole = distance(q, p);
  const double share =
      street_ && (q.y - p.y) * street_->x - (q.x - p.x) * street_->y < kLooksAway * whole ? kRearShare : kPartyShare;
  if (length[static_cast<std::size_t>(RoofEdge::party_wall)] >= share * whole) return RoofEdge::party_wall;
  std::size_t most = 0;
  for (const RoofEdge k : {RoofEdge::street, RoofEdge::courtyard})
    if (length[static_cast<std::size_t>(k)] > length[most]) most = static_cast<std::size_t>(k);
  return static_cast<RoofEdge>(most);
}

double OutlineSegments::covered(Point2 p, Point2 q) const {
  constexpr double kLeast = 0.3;  // m: shorter stretches stand for nothing
  std::optional<double> least;
  for (const OutlineSegment& s : segments_)
    if (s.kind == RoofEdge::party_wall && common_length(s.a, s.b, p, q) > kLeast)
      least = std::min(least.value_or(1e300), static_cast<double>(s.covered));
  return least.value_or(0);
}

std::vector<RoofEdge> roof_edges(const model::Building& building, const Polygon& plan) {
  return building.edges.empty() ? std::vector<RoofEdge>{} : edges_on(OutlineSegments(building), plan);
}

std::optional<Polygon> simpler_plan(const Polygon& plan, double tolerance) {
  Polygon out = plan;
  geometry::remove_collinear(out.outer, tolerance);
  for (Ring& hole : out.holes) geometry::remove_collinear(hole, tolerance);
  if (!geometry::strictly_simple(out) || !geometry::rings_apart(out)) return std::nullopt;
  return out;
}

void prepare_roof_plans(model::Building& building, double tolerance) {
  const OutlineSegments segments(building);
  for (model::BuildingPart& part : building.parts)
    if (part.plan.outer.size() >= 3) part.roof_plan = simpler_plan(part.plan, tolerance).value_or(part.plan);
  keep_corners_out(building.parts, tolerance);
  for (model::BuildingPart& part : building.parts)
    if (part.plan.outer.size() >= 3)
      part.roof_edges = building.edges.empty() ? std::vector<RoofEdge>{} : edges_on(segments, part.roof_plan);
}

}  // namespace blockrand::attributes
