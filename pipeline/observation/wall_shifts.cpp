#include "pipeline/observation/wall_shifts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// m: what is shorter is a corner, not a wall: chamfers, steps, spikes.
constexpr double kShortestWall = 0.6;
/// Sines: edges that turn by less (3 degrees) are one wall; the whole of a wall turns by no more than twice that.
constexpr double kStraight = 0.0523, kStraightInAll = 0.1045;
/// Sine and cosine of 20 degrees: walls that meet at less have no corner that their lines would tell.
constexpr double kCornerSine = 0.342, kCornerCosine = 0.940;
/// m, and m: walls so near to one line, with a gap so long at most, are on it.
constexpr double kOffLine = 0.15, kGapOnLine = 8;
/// Of an edge's length, that must be left of it.
constexpr double kLeastLeft = 0.3;

double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }
double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
Point2 minus(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
double size(Point2 v) { return std::sqrt(dot(v, v)); }
double to_millimetres(double v) { return std::round(v * 1000) / 1000 + 0.0; }

/// The walls of one ring, in its order.
void add_walls(std::span<const Point2> ring, std::uint32_t number, std::vector<Wall>& walls) {
  const std::size_t n = ring.size();
  const auto edge = [&](std::size_t i) {
    const Point2 v = minus(ring[(i + 1) % n], ring[i % n]);
    const double length = size(v);
    return length > 0 ? Point2{v.x / length, v.y / length} : Point2{};
  };
  const auto turns = [&](Point2 a, Point2 b, double sine) { return std::fabs(cross(a, b)) > sine || dot(a, b) <= 0; };
  // Begins behind the sharpest corner, which is within no wall.
  std::size_t start = 0;
  double sharpest = 2;
  for (std::size_t i = 0; i < n; ++i)
    if (const double d = dot(edge(i + n - 1), edge(i)); d < sharpest) sharpest = d, start = i;
  for (std::size_t i = 0; i < n;) {
    const Point2 first = edge(start + i);
    std::size_t end = i + 1;
    while (end < n && !turns(edge(start + end - 1), edge(start + end), kStraight) &&
           !turns(first, edge(start + end), kStraightInAll))
      ++end;
    const Point2 from = ring[(start + i) % n], chord = minus(ring[(start + end) % n], from);
    const double length = size(chord);
    if (length >= kShortestWall)
      walls.push_back({number,
                       static_cast<std::uint32_t>((start + i) % n),
                       static_cast<std::uint32_t>(end - i),
                       from,
                       {chord.x / length, chord.y / length},
                       length,
                       0});
    i = end;
  }
}

/// Groups that grow together.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The one with the lower number stays.
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

bool on_one_line(const Wall& a, const Wall& b) {
  if (dot(a.along, b.along) <= 0 || std::fabs(cross(a.along, b.along)) > kStraight) return false;
  const Wall &longer = a.length >= b.length ? a : b, &other = a.length >= b.length ? b : a;
  const Point2 begin = minus(other.from, longer.from), end = minus(other.at(other.length), longer.from);
  if (std::fabs(cross(longer.along, begin)) > kOffLine || std::fabs(cross(longer.along, end)) > kOffLine) return false;
  return dot(longer.along, begin) - longer.length <= kGapOnLine && -dot(longer.along, end) <= kGapOnLine;
}

/// Of a ring's walls, by place in the list: the one that follows.
std::size_t next_in_ring(std::span<const Wall> walls, std::size_t k) {
  if (k + 1 < walls.size() && walls[k + 1].ring == walls[k].ring) return k + 1;
  while (k > 0 && walls[k - 1].ring == walls[k].ring) --k;
  return k;
}

/// Points of the ring from the end of wall a to the beginning of the next one, b: one where they meet.
std::size_t points_between(const Wall& a, const Wall& b, std::size_t ring_size) {
  return (b.first + 2 * ring_size - a.first - a.edges) % ring_size + 1;
}

void group(const Rings& rings, const std::vector<std::vector<char>>& fixed, Walls& out) {
  std::vector<Wall>& walls = out.walls;
  Groups groups(walls.size());
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const std::size_t next = next_in_ring(walls, k);
    const bool corner = dot(walls[k].along, walls[next].along) < kCornerCosine;
    if (!corner) groups.join(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(next));
    for (std::size_t other = k + 1; other < walls.size(); ++other)
      if (on_one_line(walls[k], walls[other]))
        groups.join(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(other));
  }
  std::vector<std::uint32_t> numbers(walls.size(), 0);
  std::vector<Point2> directions;
  for (std::uint32_t k = 0; k < walls.size(); ++k) {
    const std::uint32_t root = groups.find(k);
    if (root == k)
      numbers[k] = static_cast<std::uint32_t>(out.movable.size()), out.movable.push_back(1), out.lengths.push_back(0),
      directions.push_back(walls[k].along);
    walls[k].group = numbers[root];
    out.lengths[walls[k].group] += walls[k].length;
    // Once around a curve there is no direction in which to shift it.
    if (dot(directions[walls[k].group], walls[k].along) < kCornerCosine) out.movable[walls[k].group] = 0;
  }
  if (fixed.empty()) return;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Wall &wall = walls[k], &next = walls[next_in_ring(walls, k)];
    const std::size_t n = rings[wall.ring].size(), behind = points_between(wall, next, n);
    for (std::size_t i = 0; i < wall.edges + behind; ++i) {
      if (!fixed[wall.ring][(wall.first + i) % n]) continue;
      if (i <= wall.edges) out.movable[wall.group] = 0;
      if (i >= wall.edges) out.movable[next.group] = 0;
    }
  }
}

/// Displacements of the points of a ring, by the walls of it.
std::vector<Point2> displacements(std::size_t ring_size, std::span<const Wall> walls, std::span<const double> shifts) {
  std::vector<Point2> by(ring_size);
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Wall &a = walls[k], &b = walls[next_in_ring(walls, k)];
    const Point2 na = a.normal(), nb = b.normal();
    const double sa = shifts[a.group], sb = shifts[b.group];
    for (std::size_t i = 1; i < a.edges; ++i) by[(a.first + i) % ring_size] = {sa * na.x, sa * na.y};
    const std::size_t count = points_between(a, b, ring_size);
    const double corner = cross(na, nb);
    for (std::size_t i = 0; i < count; ++i) {
      Point2& d = by[(a.first + a.edges + i) % ring_size];
      if (std::fabs(corner) >= kCornerSine) {
        d = {(sa * nb.y - sb * na.y) / corner, (sb * na.x - sa * nb.x) / corner};
      } else {
        const double t = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
        d = {sa * na.x * (1 - t) + sb * nb.x * t, sa * na.y * (1 - t) + sb * nb.y * t};
      }
    }
  }
  return by;
}

bool is_clean(const Rings& before, const Rings& after, double farthest) {
  double area_before = 0, area_after = 0;
  for (std::size_t r = 0; r < before.size(); ++r) {
    const std::size_t n = before[r].size();
    for (std::size_t i = 0; i < n; ++i) {
      if (size(minus(after[r][i], before[r][i])) > farthest) return false;
      const Point2 was = minus(before[r][(i + 1) % n], before[r][i]), is = minus(after[r][(i + 1) % n], after[r][i]);
      if (dot(was, is) < kLeastLeft * dot(was, was)) return false;
    }
    area_before += geometry::signed_area(before[r]), area_after += geometry::signed_area(after[r]);
  }
  if (std::fabs(area_after - area_before) > kMostAreaChange * area_before) return false;
  model::Polygon polygon;
  for (const std::vector<Point2>& points : after) {
    const bool outer = geometry::signed_area(points) > 0;
    if (outer && polygon.outer.size() > 0) return false;
    model::Ring& ring = outer ? polygon.outer : polygon.holes.emplace_back();
    for (const Point2 p : points) ring.points.push_back(model::snap(p));
    ring.nodes.assign(points.size(), 0);
  }
  return geometry::strictly_simple(polygon) && geometry::rings_apart(polygon);
}

}  // namespace

Walls find_walls(const Rings& rings, const std::vector<std::vector<char>>& fixed) {
  Walls out;
  for (std::uint32_t r = 0; r < rings.size(); ++r)
    if (rings[r].size() >= 3) add_walls(rings[r], r, out.walls);
  group(rings, fixed, out);
  return out;
}

Rings shifted_outline(const Rings& rings, const Walls& walls, std::span<const double> shifts, double farthest) {
  Rings after = rings;
  for (std::size_t first = 0; first < walls.walls.size();) {
    const std::uint32_t r = walls.walls[first].ring;
    std::size_t end = first;
    while (end < walls.walls.size() && walls.walls[end].ring == r) ++end;
    const std::vector<Point2> by =
        displacements(rings[r].size(), std::span(walls.walls).subspan(first, end - first), shifts);
    for (std::size_t i = 0; i < by.size(); ++i)
      if (by[i] != Point2{})
        after[r][i] = {to_millimetres(rings[r][i].x + by[i].x), to_millimetres(rings[r][i].y + by[i].y)};
    first = end;
  }
  return is_clean(rings, after, farthest) ? after : Rings{};
}

}  // namespace blockrand::observation
