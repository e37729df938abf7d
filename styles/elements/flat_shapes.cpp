// Clipping, insets and convex pieces of small polygons.
#include "styles/elements/flat_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"

namespace blockrand::elements {
namespace {

using model::Point2;

/// Points that follow one another too closely become one.
Outline without_repetitions(const Outline& polygon) {
  Outline out;
  for (const Point2 p : polygon)
    if (out.empty() || distance(out.back(), p) > kSamePoint) out.push_back(p);
  while (out.size() > 1 && distance(out.back(), out.front()) <= kSamePoint) out.pop_back();
  if (out.size() < 3) out.clear();
  return out;
}

bool segments_meet(Point2 a, Point2 b, Point2 c, Point2 d) {
  const auto side = [](Point2 o, Point2 p, Point2 q) {
    const double v = cross(o, p, q);
    return v > 1e-12 ? 1 : v < -1e-12 ? -1 : 0;
  };
  const auto within = [](Point2 p, Point2 q, Point2 x) {
    return std::min(p.x, q.x) - 1e-9 <= x.x && x.x <= std::max(p.x, q.x) + 1e-9 && std::min(p.y, q.y) - 1e-9 <= x.y &&
           x.y <= std::max(p.y, q.y) + 1e-9;
  };
  const int s1 = side(a, b, c), s2 = side(a, b, d), s3 = side(c, d, a), s4 = side(c, d, b);
  if (s1 * s2 < 0 && s3 * s4 < 0) return true;
  return (s1 == 0 && within(a, b, c)) || (s2 == 0 && within(a, b, d)) || (s3 == 0 && within(c, d, a)) ||
         (s4 == 0 && within(c, d, b));
}

/// Steps of the integer grid that the triangulation works on: a thousandth of a millimetre, so that shapes stay what
/// they are; coordinates up to 2 km fit its 31 bits.
constexpr double kFineSteps = 1048576.0;

/// Sine of the turn from which a corner is one.
constexpr double kStraight = 1e-6;

/// True for polygons that turn left at every corner and go round once.
bool is_convex(std::span<const Point2> points, const std::vector<std::uint32_t>& loop) {
  const std::size_t n = loop.size();
  if (n < 3) return false;
  double turned = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = points[loop[i]], b = points[loop[(i + 1) % n]], c = points[loop[(i + 2) % n]];
    const double scale = distance(a, b) * distance(b, c);
    if (!(cross(a, b, c) > kStraight * scale)) return false;
    // Directions that turn from below to above the x axis: once a round.
    turned += (b.y - a.y < 0 || (b.y == a.y && b.x < a.x)) && !(c.y - b.y < 0 || (c.y == b.y && c.x < b.x));
  }
  return turned == 1;
}

using Loops = std::span<const std::vector<std::uint32_t>>;
using Faces = std::vector<std::vector<std::uint32_t>>;

/// Steps of kFineSteps within which two coordinates are one: what rounding leaves, 4 thousandths of a millimetre.
constexpr std::int64_t kSameSteps = 4;
/// Between two ranks, so that the triangulation has whole numbers to compare.
constexpr std::int64_t kRankSteps = 1024;
/// Loops with more corners, and with edges that are not parallel to an axis, are cut as they are: every two edges would be compared.
constexpr std::size_t kMostCorners = 96;

/// The corners of the loops where their coordinates are counted instead of measured: equal layouts of other sizes become equal.
std::vector<geometry::Grid2> ranked(std::span<const geometry::Grid2> grid, Loops loops) {
  std::vector<geometry::Grid2> out(grid.begin(), grid.end());
  std::vector<std::pair<std::int64_t, std::uint32_t>> order;
  for (std::int64_t geometry::Grid2::*axis : {&geometry::Grid2::x, &geometry::Grid2::y}) {
    order.clear();
    for (const std::vector<std::uint32_t>& loop : loops)
      for (const std::uint32_t i : loop) order.emplace_back(grid[i].*axis, i);
    std::sort(order.begin(), order.end());
    std::int64_t rank = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k > 0 && order[k].first - order[k - 1].first > kSameSteps) rank += kRankSteps;
      out[order[k].second].*axis = rank;
    }
  }
  return out;
}

/// No two edges of the loops meet but at the corner that they share. Edges along the axes need not be asked: ranks keep their order.
bool keeps_apart(std::span<const geometry::Grid2> ranks, std::span<const Point2> points, Loops loops) {
  struct Edge {
    std::uint32_t from, to;
    bool along_axis;
  };
  std::vector<Edge> edges;
  bool all_along = true;
  for (const std::vector<std::uint32_t>& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::uint32_t a = loop[k], b = loop[(k + 1) % loop.size()];
      edges.push_back({a, b, ranks[a].x == ranks[b].x || ranks[a].y == ranks[b].y});
      all_along = all_along && edges.back().along_axis;
    }
  if (all_along) return true;
  if (edges.size() > kMostCorners) return false;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = i + 1; k < edges.size(); ++k) {
      const Edge &a = edges[i], &b = edges[k];
      if ((a.along_axis && b.along_axis) || a.from == b.to || a.to == b.from) continue;
      if (segments_meet(points[a.from], points[a.to], points[b.from], points[b.to])) return false;
    }
  return true;
}

/// Triangles of the loops, put together to convex faces.
std::optional<Faces> merged_faces(std::span<const Point2> points, std::span<const geometry::Grid2> grid, Loops loops) {
  const auto turns_left = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const double scale = distance(points[a], points[b]) * distance(points[b], points[c]);
    return cross(points[a], points[b], points[c]) > kStraight * scale;
  };
  const auto triangles = geometry::triangulate(grid, loops);
  if (!triangles) return std::nullopt;

  // Two faces become one wherever their common edge can go and both of its ends stay strictly convex.
  Faces faces;
  struct Side {
    std::uint32_t from, to, face;
  };
  std::vector<Side> sides;
  for (std::uint32_t f = 0; f < triangles->size(); ++f) {
    const auto& t = (*triangles)[f];
    faces.push_back({t[0], t[1], t[2]});
    for (std::size_t k = 0; k < 3; ++k) sides.push_back({t[k], t[(k + 1) % 3], f});
  }
  std::vector<std::uint32_t> merged_into(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) merged_into[f] = f;
  const auto now = [&](std::uint32_t f) {
    while (merged_into[f] != f) f = merged_into[f] = merged_into[merged_into[f]];
    return f;
  };
  std::vector<Side> ordered = sides;
  std::sort(ordered.begin(), ordered.end(),
            [](const Side& a, const Side& b) { return std::pair(a.from, a.to) < std::pair(b.from, b.to); });
  for (const Side& s : sides) {
    if (s.from > s.to) continue;
    const auto other = std::lower_bound(ordered.begin(), ordered.end(), s, [](const Side& a, const Side& b) {
      return std::pair(a.from, a.to) < std::pair(b.to, b.from);
    });
    if (other == ordered.end() || other->from != s.to || other->to != s.from) continue;
    const std::uint32_t one = now(s.face), two = now(other->face);
    if (one == two) continue;
    const auto &f = faces[one], &g = faces[two];
    // f from `to` round to `from`, then g's corners between them.
    const auto at = static_cast<std::size_t>(std::find(f.begin(), f.end(), s.to) - f.begin());
    const auto in = static_cast<std::size_t>(std::find(g.begin(), g.end(), s.from) - g.begin());
    std::vector<std::uint32_t> both;
    both.reserve(f.size() + g.size() - 2);
    for (std::size_t k = 0; k < f.size(); ++k) both.push_back(f[(at + k) % f.size()]);
    for (std::size_t k = 1; k + 1 < g.size(); ++k) both.push_back(g[(in + k) % g.size()]);
    const std::size_t n = both.size(), end = f.size() - 1;
    if (!turns_left(both[n - 1], both[0], both[1])) continue;
    if (!turns_left(both[end - 1], both[end], both[(end + 1) % n])) continue;
    faces[one] = std::move(both);
    faces[two].clear();
    merged_into[two] = one;
  }
  std::erase_if(faces, [](const auto& f) { return f.empty(); });
  return faces;
}

}  // namespace

double signed_area(std::span<const Point2> polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) twice += cross(polygon[0], polygon[i], polygon[i + 1]);
  return twice / 2;
}

Bounds2 bounds_of(std::span<const Point2> polygon) {
  if (polygon.empty()) return {};
  Bounds2 b{polygon[0], polygon[0]};
  for (const Point2 p : polygon) {
    b.least = {std::min(b.least.x, p.x), std::min(b.least.y, p.y)};
    b.most = {std::max(b.most.x, p.x), std::max(b.most.y, p.y)};
  }
  return b;
}

bool is_simple(std::span<const Point2> polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = polygon[i], b = polygon[(i + 1) % n], c = polygon[(i + 2) % n];
    if (distance(a, b) < 1e-9) return false;
    // A spike: the next edge runs back along this one.
    if (std::fabs(cross(a, b, c)) < 1e-12 && (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) < 0) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      if (segments_meet(a, b, polygon[j], polygon[(j + 1) % n])) return false;
    }
  }
  return true;
}

Outline clipped(const Outline& convex, Point2 normal, double limit) {
  Outline out;
  const std::size_t n = convex.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = convex[i], b = convex[(i + 1) % n];
    const double da = a.x * normal.x + a.y * normal.y - limit, db = b.x * normal.x + b.y * normal.y - limit;
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      const double t = da / (da - db);
      out.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    }
  }
  out = without_repetitions(out);
  return signed_area(out) > kSamePoint * kSamePoint ? out : Outline{};
}

Outline between_x(const Outline& convex, double from, double to) {
  return clipped(clipped(convex, {1, 0}, to), {-1, 0}, -from);
}
Outline between_y(const Outline& convex, double from, double to) {
  return clipped(clipped(convex, {0, 1}, to), {0, -1}, -from);
}

Outline inset(const Outline& convex, double by) {
  Outline out = convex;
  for (std::size_t i = 0; i < convex.size() && !out.empty(); ++i) {
    const Point2 a = convex[i], b = convex[(i + 1) % convex.size()];
    const double length = distance(a, b);
    if (length < 1e-9) continue;
    const Point2 outward{(b.y - a.y) / length, -(b.x - a.x) / length};
    out = clipped(out, outward, outward.x * a.x + outward.y * a.y - by);
  }
  return out;
}

std::optional<std::vector<std::vector<std::uint32_t>>> convex_faces(std::span<const Point2> points,
                                                                    std::span<const std::vector<std::uint32_t>> loops) {
  if (loops.size() == 1 && is_convex(points, loops[0])) return Faces{loops[0]};
  std::vector<geometry::Grid2> grid;
  grid.reserve(points.size());
  for (const Point2 p : points)
    grid.push_back({geometry::to_steps(p.x * kFineSteps), geometry::to_steps(p.y * kFineSteps)});
  // Frames of one layout are cut alike whatever their size, so that a GLB needs one shape for them. Where all faces turn left and the
  // edges keep apart, the faces cover the polygon once: their border does.
  const std::vector<geometry::Grid2> ranks = ranked(grid, loops);
  std::vector<Point2> counted;
  counted.reserve(points.size());
  for (const geometry::Grid2& r : ranks) counted.push_back({static_cast<double>(r.x), static_cast<double>(r.y)});
  if (std::optional<Faces> faces = merged_faces(counted, ranks, loops);
      faces && std::ranges::all_of(*faces, [&](const auto& face) { return is_convex(points, face); }) &&
      keeps_apart(ranks, points, loops))
    return faces;
  return merged_faces(points, grid, loops);
}

}  // namespace blockrand::elements
