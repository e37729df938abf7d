#include "pipeline/footprints/repair/wall_lines.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace blockrand::repair {

namespace {

using model::Point2;

/// Weight of an end that must not move, against corners that one footprint said each.
constexpr double kFixedWeight = 1e6;
/// Added to the diagonal where the pulls of several walls on a corner are put together: walls that run almost alike give
/// their mean, walls across each other the sum. Relative to one wall.
constexpr double kRidge = 1e-3;

/// A wall with corners between its ends.
struct Wall {
  std::uint32_t from, to;
  std::span<const std::uint32_t> between;
};

std::vector<Wall> walls_with_feet(const TerraceGraph& graph) {
  std::vector<Wall> out;
  for (const TerraceRing& ring : graph.rings) {
    const std::size_t n = ring.corners.size();
    for (std::size_t i = 0; i < n;) {
      std::size_t end = i + 1;
      while (end < n && ring.wall[end] == ring.wall[i]) ++end;
      if (end > i + 1)
        out.push_back({ring.corners[i], ring.corners[end % n], std::span(ring.corners).subspan(i + 1, end - i - 1)});
      i = end;
    }
  }
  return out;
}

bool within(const Corner& corner, Point2 p, double bound) {
  return std::all_of(corner.said.begin(), corner.said.end(),
                     [&](Point2 s) { return (p.x - s.x) * (p.x - s.x) + (p.y - s.y) * (p.y - s.y) <= bound * bound; });
}

/// Where walls pull a corner: the point that satisfies all `normal . shift = distance` best.
struct Pull {
  double xx = kRidge, xy = 0, yy = kRidge, x = 0, y = 0;
  bool any = false;
  void add(Point2 normal, double distance) {
    xx += normal.x * normal.x;
    xy += normal.x * normal.y;
    yy += normal.y * normal.y;
    x += normal.x * distance;
    y += normal.y * distance;
    any = true;
  }
  Point2 shift() const {
    const double d = xx * yy - xy * xy;
    return {(x * yy - y * xy) / d, (y * xx - x * xy) / d};
  }
};

void fit_ends(const std::vector<Wall>& walls, TerraceGraph& graph, double bound) {
  std::vector<Pull> pulls(graph.corners.size());
  for (const Wall& w : walls) {
    const Corner &a = graph.corners[w.from], &b = graph.corners[w.to];
    const double dx = b.start.x - a.start.x, dy = b.start.y - a.start.y, length = std::sqrt(dx * dx + dy * dy);
    if (length <= 0) continue;
    const Point2 normal{-dy / length, dx / length};
    // Normal equations of the ends' shifts along the normal.
    double aa = a.fixed ? kFixedWeight : static_cast<double>(std::max<std::size_t>(1, a.said.size()));
    double bb = b.fixed ? kFixedWeight : static_cast<double>(std::max<std::size_t>(1, b.said.size()));
    double ab = 0, ra = 0, rb = 0;
    for (const std::uint32_t c : w.between) {
      const Corner& corner = graph.corners[c];
      const double px = corner.start.x - a.start.x, py = corner.start.y - a.start.y;
      const double t = std::clamp((px * dx + py * dy) / (length * length), 0.0, 1.0),
                   off = px * normal.x + py * normal.y;
      const double weight =
          corner.fixed ? kFixedWeight : static_cast<double>(std::max<std::size_t>(1, corner.said.size()));
      aa += weight * (1 - t) * (1 - t);
      ab += weight * (1 - t) * t;
      bb += weight * t * t;
      ra += weight * (1 - t) * off;
      rb += weight * t * off;
    }
    const double d = aa * bb - ab * ab;
    if (!a.fixed) pulls[w.from].add(normal, (ra * bb - rb * ab) / d);
    if (!b.fixed) pulls[w.to].add(normal, (rb * aa - ra * ab) / d);
  }
  for (std::size_t c = 0; c < pulls.size(); ++c) {
    if (!pulls[c].any) continue;
    const Point2 shift = pulls[c].shift();
    Corner& corner = graph.corners[c];
    const Point2 goal{corner.start.x + shift.x, corner.start.y + shift.y};
    if (within(corner, goal, bound)) corner.start = goal;
  }
}

}  // namespace

void straighten_walls(TerraceGraph& graph, double bound) {
  const std::vector<Wall> walls = walls_with_feet(graph);
  if (walls.empty()) return;
  fit_ends(walls, graph, bound);

  // A corner goes to its wall when the wall's ends are where they stay. Walls that hang on each other in a circle keep
  // their bends.
  std::vector<int> waits(graph.corners.size(), 0);
  for (const Wall& w : walls)
    for (const std::uint32_t c : w.between) ++waits[c];
  std::vector<const Wall*> left;
  for (const Wall& w : walls) left.push_back(&w);
  for (bool progress = true; progress && !left.empty();) {
    std::vector<const Wall*> ready, later;
    for (const Wall* w : left) (waits[w->from] == 0 && waits[w->to] == 0 ? ready : later).push_back(w);
    progress = !ready.empty();
    for (const Wall* w : ready) {
      const Point2 a = graph.corners[w->from].start, b = graph.corners[w->to].start;
      const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
      for (const std::uint32_t c : w->between) {
        Corner& corner = graph.corners[c];
        --waits[c];
        if (corner.fixed || length2 <= 0) continue;
        const double t = ((corner.start.x - a.x) * dx + (corner.start.y - a.y) * dy) / length2;
        const Point2 foot{a.x + t * dx, a.y + t * dy};
        if (t > 0 && t < 1 && within(corner, foot, bound)) corner.start = foot;
      }
    }
    left = std::move(later);
  }
}

}  // namespace blockrand::repair
