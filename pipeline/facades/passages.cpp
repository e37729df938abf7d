#include "pipeline/facades/passages.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blockrand::facades {
namespace {

using model::Point2;
using model::WallSegmentKind;

/// Fronts that take a portal in; the more important first.
int rank(WallSegmentKind kind) {
  switch (kind) {
    case WallSegmentKind::street:
      return 3;
    case WallSegmentKind::courtyard:
      return 2;
    case WallSegmentKind::side:
      return 1;
    case WallSegmentKind::unknown:
    case WallSegmentKind::party_wall:
    case WallSegmentKind::passage:
      break;
  }
  return 0;
}

bool beside(const FacadeSegment& left, const FacadeSegment& right) {
  return left.wall == right.wall && right.from - left.to < kShortestFacadeSegment;
}

void append(FacadeSegment& to, const FacadeSegment& more) {
  to.to = more.to;
  to.ends_wall = more.ends_wall;
  for (const std::uint32_t e : more.edges)
    if (to.edges.empty() || to.edges.back() != e) to.edges.push_back(e);
}

double height_of(const model::BuildingPart& part, double width) {
  const double storey = part.attributes.storey_height.value;
  const double wished = width >= kCartWidth ? std::clamp(storey - 0.6, 2.8, 3.6) : 2.5;
  return std::min(wished, part.attributes.plinth_height.value + storey - kLintel);
}

Point2 middle(const WallFrame& wall, const PassagePortal& portal) {
  return wall.at({(portal.left + portal.right) / 2, 0}).xy();
}

/// m between the middles of two portals; negative when one does not lie behind the other.
double distance_through(std::span<const WallFrame> walls, const PassagePortal& a, const PassagePortal& b) {
  const Point2 p = middle(walls[a.wall], a), q = middle(walls[b.wall], b);
  const Point2 out_a = walls[a.wall].outward(), out_b = walls[b.wall].outward(), d{q.x - p.x, q.y - p.y};
  const double length = std::sqrt(d.x * d.x + d.y * d.y);
  if (!(-(d.x * out_a.x + d.y * out_a.y) > kStraightThrough * length) ||
      !(d.x * out_b.x + d.y * out_b.y > kStraightThrough * length))
    return -1;
  return length;
}

void pair_up(std::span<const WallFrame> walls, std::vector<PassagePortal>& portals) {
  struct Pair {
    double distance;
    std::uint32_t a, b;
  };
  std::vector<Pair> pairs;
  for (std::uint32_t a = 0; a < portals.size(); ++a)
    for (std::uint32_t b = a + 1; b < portals.size(); ++b) {
      if (portals[a].wall == portals[b].wall) continue;
      const double d = distance_through(walls, portals[a], portals[b]);
      if (d >= 0) pairs.push_back({d, a, b});
    }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
    return std::pair(x.distance, std::pair(x.a, x.b)) < std::pair(y.distance, std::pair(y.a, y.b));
  });
  for (const Pair& pair : pairs) {
    PassagePortal &a = portals[pair.a], &b = portals[pair.b];
    if (a.other != model::kNoOpening || b.other != model::kNoOpening) continue;
    // One level from end to end.
    const double low = std::max(walls[a.wall].base + a.low, walls[b.wall].base + b.low);
    const double high = std::min(walls[a.wall].base + a.high, walls[b.wall].base + b.high);
    if (!(high - low >= kLeastHeadroom)) continue;
    a.other = pair.b;
    b.other = pair.a;
    a.state = b.state = PortalState::open;
    for (PassagePortal* m : {&a, &b}) {
      m->low = low - walls[m->wall].base;
      m->high = high - walls[m->wall].base;
    }
  }
}

}  // namespace

std::vector<PassagePortal> take_portals(const model::BuildingPart& part, std::span<const WallFrame> walls,
                                        std::vector<FacadeSegment>& segments) {
  std::vector<PassagePortal> portals;
  std::vector<FacadeSegment> out;
  const double ground = part.attributes.ground_height.value;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    FacadeSegment& mine = segments[i];
    if (mine.kind != WallSegmentKind::passage) {
      // What was a portal's neighbour on both sides goes on.
      if (!out.empty() && beside(out.back(), mine) && i > 0 && segments[i - 1].kind == WallSegmentKind::passage &&
          out.back().kind == mine.kind && rank(mine.kind) > 0)
        append(out.back(), mine);
      else
        out.push_back(mine);
      continue;
    }
    const WallFrame& wall = walls[mine.wall];
    const bool has_left = !out.empty() && beside(out.back(), mine);
    const bool has_right = i + 1 < segments.size() && beside(mine, segments[i + 1]);
    const WallSegmentKind left = has_left ? out.back().kind : WallSegmentKind::unknown,
                          right = has_right ? segments[i + 1].kind : WallSegmentKind::unknown;
    const WallSegmentKind front = rank(left) >= rank(right) ? left : right;
    PassagePortal portal;
    portal.wall = mine.wall;
    portal.left = std::max(mine.from, kPortalJamb);
    portal.right = std::min(mine.to, wall.length - kPortalJamb);
    portal.low = std::max(0.0, ground - wall.base) + kPortalThreshold;
    portal.high = std::max(0.0, ground - wall.base) + height_of(part, portal.right - portal.left);
    portal.front = rank(front) > 0 ? front : WallSegmentKind::passage;
    const bool raised = wall.base > ground + kLintel;
    if (!raised && portal.high - portal.low >= kLeastHeadroom && portal.right > portal.left) portals.push_back(portal);
    if (rank(front) == 0) {
      out.push_back(mine);
    } else if (rank(left) >= rank(right)) {
      append(out.back(), mine);
    } else {
      // The right neighbour begins here.
      FacadeSegment& next = segments[i + 1];
      next.from = mine.from;
      next.starts_wall = mine.starts_wall;
      next.edges.insert(next.edges.begin(), mine.edges.begin(), mine.edges.end());
    }
  }
  segments = std::move(out);
  pair_up(walls, portals);
  return portals;
}

}  // namespace blockrand::facades
