#include "pipeline/footprints/repair/parts_follow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

// Pairing two rings costs their product; beyond this (two rings of 2,000 corners) corners go to the nearest one.
constexpr std::size_t kMostPairs = 4'000'000;

/// Place of the point of ab nearest to p, from 0 at a to 1 at b.
double foot(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  return length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0;
}

Point2 between(Point2 a, Point2 b, double t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }

using Partners = std::vector<std::optional<Point2>>;

Partners nearest_corners(const Ring& before, const Ring& after, double reach) {
  Partners out(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    double best = reach * reach;
    for (const Point2 q : after.points)
      if (const double d = squared_distance(before.points[i], q); d <= best) best = d, out[i] = q;
  }
  return out;
}

/// Pairs the corners of two rings in sequence: dynamic programming over both, from the nearest pair on.
Partners pair_corners(const Ring& before, const Ring& after, double reach) {
  const std::size_t n = before.size(), m = after.size();
  if (n * m > kMostPairs) return nearest_corners(before, after, reach);
  const double reach2 = reach * reach, skip = reach2 / 2, infinite = std::numeric_limits<double>::infinity();
  const auto cost = [&](std::size_t i, std::size_t j) {
    const double d = squared_distance(before.points[i], after.points[j]);
    if (d > reach2) return infinite;
    // The same node is the same corner unless another lies much nearer.
    return before.nodes[i] != 0 && before.nodes[i] == after.nodes[j] ? d / 16 : d;
  };
  std::size_t i0 = 0, j0 = 0;
  double least = infinite;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j)
      if (const double c = cost(i, j); c < least) least = c, i0 = i, j0 = j;
  Partners out(n);
  if (least == infinite) return out;
  // total[i][j]: cheapest way to have dealt with the first i corners of `before` and j of `after`, counted from the
  // nearest pair, which is paired.
  std::vector<double> total((n + 1) * (m + 1), infinite);
  std::vector<char> step((n + 1) * (m + 1), 0);
  const auto at = [m](std::size_t i, std::size_t j) { return i * (m + 1) + j; };
  total[at(1, 1)] = 0;
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j) {
      if (i == 1 && j == 1) continue;
      const double pair = cost((i0 + i - 1) % n, (j0 + j - 1) % m) + total[at(i - 1, j - 1)];
      const double left = skip + total[at(i - 1, j)], right = skip + total[at(i, j - 1)];
      const double best = std::min({pair, left, right});
      total[at(i, j)] = best;
      step[at(i, j)] = best == pair ? 'p' : best == left ? 'l' : 'r';
    }
  out[i0] = after.points[j0];
  for (std::size_t i = n, j = m; i > 1 || j > 1;) {
    switch (step[at(i, j)]) {
      case 'p':
        out[(i0 + i - 1) % n] = after.points[(j0 + j - 1) % m];
        --i, --j;
        break;
      case 'l':
        --i;
        break;
      default:
        --j;
    }
  }
  return out;
}

std::vector<const Ring*> rings_of(std::span<const Polygon> polygons) {
  std::vector<const Ring*> out;
  for (const Polygon& p : polygons) {
    out.push_back(&p.outer);
    for (const Ring& hole : p.holes) out.push_back(&hole);
  }
  return out;
}

/// The ring of `after` that most corners of `ring` are near to; of equal ones the first.
const Ring* ring_after(const Ring& ring, const std::vector<const Ring*>& after, double reach) {
  const Ring* best = nullptr;
  std::size_t most = 0;
  for (const Ring* candidate : after) {
    std::size_t votes = 0;
    for (const auto& partner : nearest_corners(ring, *candidate, reach)) votes += partner.has_value();
    if (votes > most) most = votes, best = candidate;
  }
  return best;
}

/// Movement of every corner; where it has no partner that of the wall between those that have.
std::vector<Point2> movements(const Ring& ring, const Partners& partners) {
  const std::size_t n = ring.size();
  std::vector<Point2> out(n);
  std::vector<std::size_t> paired;
  for (std::size_t i = 0; i < n; ++i)
    if (partners[i]) {
      out[i] = {partners[i]->x - ring.points[i].x, partners[i]->y - ring.points[i].y};
      paired.push_back(i);
    }
  if (paired.empty()) return out;
  for (std::size_t k = 0; k < paired.size(); ++k) {
    const std::size_t first = paired[k], last = paired[(k + 1) % paired.size()];
    double length = 0;
    std::size_t i = first;
    do {
      const std::size_t next = (i + 1) % n;
      length += std::sqrt(squared_distance(ring.points[i], ring.points[next]));
      i = next;
    } while (i != last);
    double along = 0;
    for (i = first; (i + 1) % n != last; i = (i + 1) % n) {
      const std::size_t next = (i + 1) % n;
      along += std::sqrt(squared_distance(ring.points[i], ring.points[next]));
      out[next] = between(out[first], out[last], length > 0 ? along / length : 0);
    }
  }
  return out;
}

}  // namespace

MovedWalls::MovedWalls(std::span<const Polygon> before, std::span<const Polygon> after, const RepairOptions& options) {
  const auto rings = rings_of(before), targets = rings_of(after);
  bool same = rings.size() == targets.size();
  for (std::size_t i = 0; i < rings.size() && same; ++i) same = rings[i]->points == targets[i]->points;
  if (same) return;
  // Sharing may move a corner by `snap_reach`, squaring by `max_shift`.
  const double reach = std::max(options.snap_reach, options.max_shift);
  bool moved = false;
  for (const Ring* ring : rings) {
    const Ring* target = ring_after(*ring, targets, reach);
    const Partners partners = target ? pair_corners(*ring, *target, reach) : Partners(ring->size());
    const std::vector<Point2> d = movements(*ring, partners);
    for (std::size_t i = 0; i < ring->size(); ++i) {
      const std::size_t next = (i + 1) % ring->size();
      walls_.push_back({ring->points[i], ring->points[next], d[i], d[next]});
      moved = moved || d[i] != Point2{};
    }
  }
  if (!moved) walls_.clear();
  if (moved)
    for (const Ring* ring : targets)
      for (std::size_t i = 0; i < ring->size(); ++i)
        targets_.push_back({ring->points[i], ring->points[(i + 1) % ring->size()]});
}

Point2 MovedWalls::operator()(Point2 p) const {
  if (walls_.empty()) return p;
  Point2 sum{}, on_wall{};
  double weights = 0, nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls_) {
    if (p == wall.a) return model::snap(Point2{p.x + wall.da.x, p.y + wall.da.y});
    const double t = foot(p, wall.a, wall.b), d2 = squared_distance(p, between(wall.a, wall.b, t));
    const Point2 d = between(wall.da, wall.db, t);
    if (d2 < nearest) nearest = d2, on_wall = d;
    // A tenth of a millimetre stands for nothing, so that weights stay finite.
    const double weight = 1 / ((d2 + 1e-8) * (d2 + 1e-8));
    sum.x += weight * d.x;
    sum.y += weight * d.y;
    weights += weight;
  }
  if (nearest > kOnWall * kOnWall) return model::snap(Point2{p.x + sum.x / weights, p.y + sum.y / weights});
  const Point2 target{p.x + on_wall.x, p.y + on_wall.y};
  if (on_wall == Point2{}) return p;
  double best = 4 * kOnWall * kOnWall;
  Point2 out = target;
  for (const Segment& wall : targets_) {
    const Point2 q = between(wall.a, wall.b, foot(target, wall.a, wall.b));
    if (const double d = squared_distance(target, q); d < best) best = d, out = q;
  }
  return model::snap(out);
}

}  // namespace blockrand::repair
