#include "tests/unit/geometry/random_plans.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::testing_shapes {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

Ring star(Random& random, Point2 centre, double least, double most, std::size_t corners) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < corners; ++i) angles.push_back(2 * M_PI * random.unit());
  std::sort(angles.begin(), angles.end());
  std::vector<Point2> points;
  for (const double a : angles) {
    const double r = least + (most - least) * random.unit();
    points.push_back(model::snap(Point2{centre.x + r * std::cos(a), centre.y + r * std::sin(a)}));
  }
  Ring out = ring(std::move(points));
  if (geometry::signed_area(out.points) < 0) std::reverse(out.points.begin(), out.points.end());  // all on one side
  return out;
}

void reverse(Ring& r) { std::reverse(r.points.begin(), r.points.end()); }

std::optional<Polygon> star_plan(Random& random) {
  Polygon out{star(random, {0, 0}, 3, 25, 3 + random.next(28)), {}};
  if (random.next(3) == 0)
    for (std::uint64_t h = 0; h <= random.next(3); ++h) {
      const double angle = 2 * M_PI * random.unit(), away = 12 * random.unit();
      Ring hole = star(random, {away * std::cos(angle), away * std::sin(angle)}, 0.5, 4, 3 + random.next(8));
      reverse(hole);
      Polygon with = out;
      with.holes.push_back(hole);
      if (geometry::strictly_simple(with)) out = with;
    }
  return out;
}

bool cross(Point2 a, Point2 b, Point2 c, Point2 d) {
  const auto side = [](Point2 p, Point2 q, Point2 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); };
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

std::optional<Polygon> tangle_plan(Random& random) {
  std::vector<Point2> p;
  const std::size_t n = 4 + random.next(20);
  for (std::size_t i = 0; i < n; ++i) p.push_back(model::snap(Point2{40 * random.unit(), 40 * random.unit()}));
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i + 2 < n && !again; ++i)
      for (std::size_t j = i + 2; j < n && !again; ++j) {
        if (i == 0 && j + 1 == n) continue;
        if (!cross(p[i], p[i + 1], p[j], p[(j + 1) % n])) continue;
        std::reverse(p.begin() + static_cast<std::ptrdiff_t>(i) + 1, p.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        again = true;
      }
  }
  Polygon out{ring(std::move(p)), {}};
  if (geometry::signed_area(out.outer.points) < 0) reverse(out.outer);
  return out;
}

/// Boundary rings of a set of cells; cells that touch in a corner alone make no plan.
std::optional<Polygon> grid_plan(Random& random, bool turned_too) {
  const int w = 2 + static_cast<int>(random.next(5)), h = 2 + static_cast<int>(random.next(5));
  std::vector<double> xs{0}, ys{0};
  const double unit = 1 + static_cast<double>(random.next(4));
  for (int i = 0; i < w; ++i) xs.push_back(xs.back() + unit * static_cast<double>(1 + random.next(3)));
  for (int i = 0; i < h; ++i) ys.push_back(ys.back() + unit * static_cast<double>(1 + random.next(3)));
  std::vector<char> cell(static_cast<std::size_t>(w * h));
  for (auto& c : cell) c = random.next(10) < 7;
  const auto in = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < w && y < h && cell[static_cast<std::size_t>(y * w + x)];
  };
  std::map<std::pair<int, int>, std::pair<int, int>> next;  // along the boundary, inside on the left
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (!in(x, y)) continue;
      const auto add = [&](int ax, int ay, int bx, int by) {
        return next.emplace(std::pair(ax, ay), std::pair(bx, by)).second;
      };
      if (!in(x, y - 1) && !add(x, y, x + 1, y)) return std::nullopt;
      if (!in(x + 1, y) && !add(x + 1, y, x + 1, y + 1)) return std::nullopt;
      if (!in(x, y + 1) && !add(x + 1, y + 1, x, y + 1)) return std::nullopt;
      if (!in(x - 1, y) && !add(x, y + 1, x, y)) return std::nullopt;
    }
  const double angle = 2 * M_PI * random.unit(), c = turned_too ? std::cos(angle) : 1,
               s = turned_too ? std::sin(angle) : 0;
  std::vector<Ring> rings;
  while (!next.empty()) {
    std::vector<Point2> points;
    for (auto at = next.begin()->first; next.contains(at);) {
      const auto to = next[at];
      next.erase(at);
      const double x = xs[static_cast<std::size_t>(at.first)], y = ys[static_cast<std::size_t>(at.second)];
      points.push_back(model::snap(Point2{c * x - s * y, s * x + c * y}));
      at = to;
    }
    rings.push_back(ring(std::move(points)));
  }
  Polygon best;
  double largest = 0;
  for (const Ring& r : rings) {
    const double area = geometry::signed_area(r.points);
    if (area > largest) {
      largest = area;
      best.outer = r;
    }
  }
  for (const Ring& r : rings) {
    if (geometry::signed_area(r.points) > 0) continue;
    Polygon with = best;
    with.holes.push_back(r);
    if (geometry::strictly_simple(with) && with.holes.size() <= 3) best = with;
  }
  // Corners between two cells bend nothing.
  geometry::remove_collinear(best.outer, 0.01);
  for (Ring& r : best.holes) geometry::remove_collinear(r, 0.01);
  return best;
}

}  // namespace

Polygon random_plan(std::uint64_t seed, std::uint64_t number) {
  for (std::uint64_t again = 0;; ++again) {
    Random random(seed * 1000003 + number * 64 + again);
    const auto plan = number % 4 == 0   ? star_plan(random)
                      : number % 4 == 1 ? tangle_plan(random)
                                        : grid_plan(random, number % 4 == 3);
    if (plan && plan->outer.size() >= 3 && geometry::strictly_simple(*plan)) return *plan;
  }
}

}  // namespace blockrand::testing_shapes
