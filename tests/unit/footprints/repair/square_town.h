// Houses and rows as graphs, disturbed and squared, and how much of the truth comes back.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

#include "pipeline/footprints/repair/square.h"

namespace blockrand::repair::test {

using model::Point2;

inline constexpr double kPi = 3.14159265358979323846;

inline double distance(Point2 a, Point2 b) { return std::hypot(a.x - b.x, a.y - b.y); }
inline Point2 turned(Point2 p, double degrees) {
  const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

/// Footprints as they are in truth, from lists of points; points that several have are one corner. Every footprint's
/// copy can be disturbed.
class Town {
 public:
  explicit Town(unsigned seed = 1) : random_(seed) {}

  /// Points of walls' ends; of others on a wall as well (marked true), which have no corner of their own.
  struct Point {
    Point2 p;
    bool on_wall = false;
    Point(Point2 q, bool on = false) : p(q), on_wall(on) {}
    Point(double x, double y, bool on = false) : p{x, y}, on_wall(on) {}
  };
  void add(const std::vector<Point>& ring) {
    TerraceRing r;
    r.building = static_cast<std::uint32_t>(row.buildings.size());
    row.buildings.emplace_back();
    row.buildings.back().id = {model::OsmType::way, static_cast<std::int64_t>(row.buildings.size())};
    std::uint32_t wall = 0;
    for (const Point& p : ring) {
      const auto [it, fresh] = index_.try_emplace({p.p.x, p.p.y}, static_cast<std::uint32_t>(graph.corners.size()));
      if (fresh) {
        graph.corners.emplace_back();
        truth.push_back(p.p);
      }
      Corner& c = graph.corners[it->second];
      if (!p.on_wall) c.said.push_back(p.p), ++wall;
      r.corners.push_back(it->second);
      r.wall.push_back(wall % 1000);
    }
    graph.rings.push_back(r);
  }

  /// Each copy anywhere in a disc of `radius`, everything turned by `degrees` about the origin afterwards.
  void disturb(double radius, double degrees = 0) {
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::size_t i = 0; i < graph.corners.size(); ++i) {
      Corner& c = graph.corners[i];
      Point2 mean;
      for (Point2& p : c.said) {
        const double r = radius * std::sqrt(unit(random_)), a = 2 * kPi * unit(random_);
        p = turned({truth[i].x + r * std::cos(a), truth[i].y + r * std::sin(a)}, degrees);
        mean.x += p.x, mean.y += p.y;
      }
      const double n = static_cast<double>(c.said.size());
      c.start = c.said.empty() ? turned(truth[i], degrees) : Point2{mean.x / n, mean.y / n};
      truth[i] = turned(truth[i], degrees);
    }
    // A corner on a neighbour's wall lies on it.
    for (const TerraceRing& ring : graph.rings)
      for (std::size_t i = 0; i < ring.corners.size(); ++i) {
        const std::size_t n = ring.corners.size();
        if (ring.wall[(i + n - 1) % n] != ring.wall[i]) continue;
        std::size_t a = (i + n - 1) % n, b = (i + 1) % n;
        while (ring.wall[(a + n - 1) % n] == ring.wall[i]) a = (a + n - 1) % n;
        while (ring.wall[b] == ring.wall[i]) b = (b + 1) % n;
        const Point2 p = graph.corners[ring.corners[a]].start, q = graph.corners[ring.corners[b]].start;
        Point2& s = graph.corners[ring.corners[i]].start;
        const double t = ((s.x - p.x) * (q.x - p.x) + (s.y - p.y) * (q.y - p.y)) / std::pow(distance(p, q), 2);
        s = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
      }
    for (Corner& c : graph.corners) c.position = c.start;
  }

  void square() {
    square_terrace_row(graph, row, {}, direction);
    for (Corner& c : graph.corners) c.position = model::snap(c.position);
  }

  /// Corners of walls of a ring: (before, corner, after) with the walls' far ends.
  void for_each_angle(const std::function<void(std::uint32_t, std::uint32_t, std::uint32_t)>& visit) const {
    for (const TerraceRing& ring : graph.rings) {
      std::vector<std::uint32_t> ends;
      for (std::size_t i = 0; i < ring.corners.size(); ++i)
        if (ring.wall[i] != ring.wall[(i + ring.corners.size() - 1) % ring.corners.size()])
          ends.push_back(ring.corners[i]);
      for (std::size_t i = 0; i < ends.size(); ++i)
        visit(ends[(i + ends.size() - 1) % ends.size()], ends[i], ends[(i + 1) % ends.size()]);
    }
  }
  /// Degrees from a right angle, [0, 90].
  static double off_right(Point2 a, Point2 b, Point2 c) {
    const double ux = a.x - b.x, uy = a.y - b.y, vx = c.x - b.x, vy = c.y - b.y;
    return std::fabs(std::atan2(ux * vx + uy * vy, std::fabs(ux * vy - uy * vx))) * 180 / kPi;
  }
  Point2 position(std::uint32_t c) const { return graph.corners[c].position; }

  double max_shift() const {
    double most = 0;
    for (const Corner& c : graph.corners) {
      if (c.said.empty()) most = std::max(most, distance(c.position, c.start));
      for (const Point2 p : c.said) most = std::max(most, distance(c.position, p));
    }
    return most;
  }

  struct Score {
    int right = 0, restored = 0, obliques = 0, squared = 0;
    double error_before = 0, error = 0, shift = 0;
    int corners = 0;
    void operator+=(const Score& o) {
      right += o.right, restored += o.restored, obliques += o.obliques, squared += o.squared;
      error_before += o.error_before, error += o.error, corners += o.corners;
      shift = std::max(shift, o.shift);
    }
  };
  Score score() const {
    Score s;
    for_each_angle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      const double legs = std::min(distance(truth[a], truth[b]), distance(truth[b], truth[c]));
      const double off = off_right(truth[a], truth[b], truth[c]);
      const double now = off_right(position(a), position(b), position(c));
      if (off < 1e-6 && legs >= 1) ++s.right, s.restored += now <= 0.1;
      if (off > 5 && legs >= 8) ++s.obliques, s.squared += now <= 0.1;
    });
    for (std::size_t i = 0; i < truth.size(); ++i) {
      for (const Point2 p : graph.corners[i].said) s.error_before += distance(p, truth[i]), ++s.corners;
      s.error += static_cast<double>(graph.corners[i].said.size()) * distance(graph.corners[i].position, truth[i]);
    }
    s.shift = max_shift();
    return s;
  }

  TerraceRow row;
  TerraceGraph graph;
  std::vector<Point2> truth;
  std::vector<double> direction;
  std::mt19937& random() { return random_; }

 private:
  std::mt19937 random_;
  std::map<std::pair<double, double>, std::uint32_t> index_;
};

inline double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A free-standing house: rectangle, L, T, U, or one with an oblique wall.
inline void add_house(Town& town, Point2 at, int kind) {
  auto& random = town.random();
  const double w = between(random, 8, 20), d = between(random, 8, 14), a = between(random, 3, 6),
               b = between(random, 3, 6);
  std::vector<Town::Point> ring;
  switch (kind) {
    case 0:
      ring = {{0, 0}, {w, 0}, {w, d}, {0, d}};
      break;
    case 1:
      ring = {{0, 0}, {w, 0}, {w, d}, {w - a, d}, {w - a, d - b}, {0, d - b}};
      break;
    case 2:
      ring = {{0, 0}, {w, 0}, {w, d}, {w - 2, d}, {w - 2, d + b}, {2, d + b}, {2, d}, {0, d}};
      break;
    case 3:
      ring = {{0, 0}, {w + 8, 0}, {w + 8, d}, {w + 8 - a, d}, {w + 8 - a, d - b}, {b, d - b}, {b, d}, {0, d}};
      break;
    default: {  // one wall oblique by 5 to 35 degrees, at least 8 m long
      const double rise = (d + 4) * std::tan(between(random, 5.2, 35) * kPi / 180);
      ring = {{0, 0}, {w + rise + 8, 0}, {w + 8, d + 4}, {0, d + 4}};
    }
  }
  for (Town::Point& p : ring) p.p.x += at.x, p.p.y += at.y;
  town.add(ring);
}

/// Houses wall to wall along a street: common corners at the front, corners on a neighbour's wall at the back. Every
/// fifth house has an oblique rear wall.
inline void add_row(Town& town, Point2 at, int count) {
  auto& random = town.random();
  std::vector<double> x{at.x}, depth;
  std::vector<double> rise;
  for (int i = 0; i < count; ++i) {
    x.push_back(x.back() + between(random, 9, 16));
    depth.push_back(std::round(between(random, 9, 15)));
    rise.push_back(i % 5 == 3 ? (x[i + 1] - x[i]) * std::tan(between(random, 6, 30) * kPi / 180) : 0);
  }
  for (int i = 0; i < count; ++i) {
    const double left = at.y + depth[i], right = left + rise[i];
    std::vector<Town::Point> ring{{x[i], at.y}, {x[i + 1], at.y}};
    if (i + 1 < count && at.y + depth[i + 1] < right) ring.emplace_back(x[i + 1], at.y + depth[i + 1], true);
    ring.emplace_back(x[i + 1], right);
    ring.emplace_back(x[i], left);
    if (i > 0 && at.y + depth[i - 1] + rise[i - 1] < left)
      ring.emplace_back(x[i], at.y + depth[i - 1] + rise[i - 1], true);
    town.add(ring);
  }
}

/// A row along a street that turns by 1 to 3 degrees per house; party walls halve the angle between the fronts.
inline void add_bent_row(Town& town, int count) {
  auto& random = town.random();
  const double depth = between(random, 9, 13);
  std::vector<double> angle;
  std::vector<Point2> front{{0, 0}}, rear;
  for (int i = 0; i < count; ++i) {
    angle.push_back(i == 0 ? 0 : angle.back() + between(random, 1, 3));
    const Point2 step = turned({between(random, 6, 13), 0}, angle.back());
    front.push_back({front.back().x + step.x, front.back().y + step.y});
  }
  for (int i = 0; i <= count; ++i) {
    const double before = angle[std::max(0, i - 1)], after = angle[std::min(i, count - 1)];
    const Point2 across = turned({0, depth / std::cos((after - before) / 2 * kPi / 180)}, (before + after) / 2);
    rear.push_back({front[i].x + across.x, front[i].y + across.y});
  }
  for (int i = 0; i < count; ++i) town.add({{front[i]}, {front[i + 1]}, {rear[i + 1]}, {rear[i]}});
}

}  // namespace blockrand::repair::test
