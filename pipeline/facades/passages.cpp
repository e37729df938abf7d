#include "pipeline/facades/passages.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blockrand::facades {
namespace {

using model::EdgeKind;
using model::Point2;

/// Fronts that take a mouth in; the more important first.
int rank(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::street:
      return 3;
    case EdgeKind::courtyard:
      return 2;
    case EdgeKind::side:
      return 1;
    case EdgeKind::unknown:
    case EdgeKind::party_wall:
    case EdgeKind::passage:
      break;
  }
  return 0;
}

bool beside(const FacadeStretch& left, const FacadeStretch& right) {
  return left.wall == right.wall && right.from - left.to < kShortestStretch;
}

void append(FacadeStretch& to, const FacadeStretch& more) {
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

Point2 middle(const WallFrame& wall, const PassageMouth& mouth) {
  return wall.at({(mouth.left + mouth.right) / 2, 0}).xy();
}

/// m between the middles of two mouths; negative when one does not lie behind the other.
double distance_through(std::span<const WallFrame> walls, const PassageMouth& a, const PassageMouth& b) {
  const Point2 p = middle(walls[a.wall], a), q = middle(walls[b.wall], b);
  const Point2 out_a = walls[a.wall].outward(), out_b = walls[b.wall].outward(), d{q.x - p.x, q.y - p.y};
  const double length = std::sqrt(d.x * d.x + d.y * d.y);
  if (!(-(d.x * out_a.x + d.y * out_a.y) > kStraightThrough * length) ||
      !(d.x * out_b.x + d.y * out_b.y > kStraightThrough * length))
    return -1;
  return length;
}

void pair_up(std::span<const WallFrame> walls, std::vector<PassageMouth>& mouths) {
  struct Pair {
    double distance;
    std::uint32_t a, b;
  };
  std::vector<Pair> pairs;
  for (std::uint32_t a = 0; a < mouths.size(); ++a)
    for (std::uint32_t b = a + 1; b < mouths.size(); ++b) {
      if (mouths[a].wall == mouths[b].wall) continue;
      const double d = distance_through(walls, mouths[a], mouths[b]);
      if (d >= 0) pairs.push_back({d, a, b});
    }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
    return std::pair(x.distance, std::pair(x.a, x.b)) < std::pair(y.distance, std::pair(y.a, y.b));
  });
  for (const Pair& pair : pairs) {
    PassageMouth &a = mouths[pair.a], &b = mouths[pair.b];
    if (a.other != model::kNoOpening || b.other != model::kNoOpening) continue;
    // One level from end to end.
    const double low = std::max(walls[a.wall].base + a.low, walls[b.wall].base + b.low);
    const double high = std::min(walls[a.wall].base + a.high, walls[b.wall].base + b.high);
    if (!(high - low >= kLeastHeadroom)) continue;
    a.other = pair.b;
    b.other = pair.a;
    a.state = b.state = MouthState::open;
    for (PassageMouth* m : {&a, &b}) {
      m->low = low - walls[m->wall].base;
      m->high = high - walls[m->wall].base;
    }
  }
}

}  // namespace

std::vector<PassageMouth> take_mouths(const model::BuildingPart& part, std::span<const WallFrame> walls,
                                      std::vector<FacadeStretch>& stretches) {
  std::vector<PassageMouth> mouths;
  std::vector<FacadeStretch> out;
  const double ground = part.attributes.ground_height.value;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    FacadeStretch& mine = stretches[i];
    if (mine.kind != EdgeKind::passage) {
      // What was a mouth's neighbour on both sides goes on.
      if (!out.empty() && beside(out.back(), mine) && i > 0 && stretches[i - 1].kind == EdgeKind::passage &&
          out.back().kind == mine.kind && rank(mine.kind) > 0)
        append(out.back(), mine);
      else
        out.push_back(mine);
      continue;
    }
    const WallFrame& wall = walls[mine.wall];
    const bool has_left = !out.empty() && beside(out.back(), mine);
    const bool has_right = i + 1 < stretches.size() && beside(mine, stretches[i + 1]);
    const EdgeKind left = has_left ? out.back().kind : EdgeKind::unknown,
                   right = has_right ? stretches[i + 1].kind : EdgeKind::unknown;
    const EdgeKind front = rank(left) >= rank(right) ? left : right;
    PassageMouth mouth;
    mouth.wall = mine.wall;
    mouth.left = std::max(mine.from, kMouthJamb);
    mouth.right = std::min(mine.to, wall.length - kMouthJamb);
    mouth.low = std::max(0.0, ground - wall.base) + kMouthThreshold;
    mouth.high = std::max(0.0, ground - wall.base) + height_of(part, mouth.right - mouth.left);
    mouth.front = rank(front) > 0 ? front : EdgeKind::passage;
    const bool raised = wall.base > ground + kLintel;
    if (!raised && mouth.high - mouth.low >= kLeastHeadroom && mouth.right > mouth.left) mouths.push_back(mouth);
    if (rank(front) == 0) {
      out.push_back(mine);
    } else if (rank(left) >= rank(right)) {
      append(out.back(), mine);
    } else {
      // The right neighbour begins here.
      FacadeStretch& next = stretches[i + 1];
      next.from = mine.from;
      next.starts_wall = mine.starts_wall;
      next.edges.insert(next.edges.begin(), mine.edges.begin(), mine.edges.end());
    }
  }
  stretches = std::move(out);
  pair_up(walls, mouths);
  return mouths;
}

}  // namespace blockrand::facades
