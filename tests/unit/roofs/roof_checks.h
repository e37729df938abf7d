// Plans, from plain to nasty, and what every roof on them must keep.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/masses/envelope.h"
#include "styles/roofs/roof.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::roof_checks {

using model::Point2;
using model::Point3;
using model::Polygon;
using testing_shapes::polygon;
using testing_shapes::Random;
using testing_shapes::ring;

/// What the checker says of the solid from z = 30 to the roof; "none" for valid ones.
inline std::string validity(const Polygon& plan, const roofs::Roof& roof) {
  const model::Solid solid = masses::envelope(plan, 30, roof, {});
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return "a face is no simple polygon";
  return geometry::check_solid(solid, *triangles).text();
}

/// Plan area under the roof's surfaces: must be the plan's own.
inline double covered_area(const roofs::Roof& roof) {
  double sum = 0;
  for (const auto& surface : roof.surfaces)
    for (const auto& loop : surface.loops) {
      std::vector<Point2> flat;
      for (const Point3& p : loop) flat.push_back(p.xy());
      sum += geometry::signed_area(flat);
    }
  return sum;
}

inline double highest(const roofs::Roof& roof) {
  double z = -1e9;
  for (const auto& surface : roof.surfaces)
    for (const auto& loop : surface.loops)
      for (const Point3& p : loop) z = std::max(z, p.z);
  return z;
}

/// Roof planes (first) and upright pieces (second).
inline std::pair<std::size_t, std::size_t> face_counts(const roofs::Roof& roof) {
  std::size_t upright = 0;
  for (const auto& surface : roof.surfaces) upright += surface.upright;
  return {roof.surfaces.size() - upright, upright};
}

/// Turned about the origin by an angle in degrees, moved, and rounded to the grid.
inline Polygon moved(const Polygon& plan, double degrees, Point2 by) {
  const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
  const auto move = [&](model::Ring r) {
    for (Point2& p : r.points) p = model::snap(Point2{by.x + c * p.x - s * p.y, by.y + s * p.x + c * p.y});
    return r;
  };
  Polygon out{move(plan.outer), {}};
  for (const auto& hole : plan.holes) out.holes.push_back(move(hole));
  return out;
}

inline Polygon regular(int n, double radius) {
  std::vector<Point2> points;
  for (int i = 0; i < n; ++i)
    points.push_back(model::snap(Point2{radius * std::cos(2 * M_PI * i / n), radius * std::sin(2 * M_PI * i / n)}));
  return polygon(std::move(points));
}

inline std::map<std::string, Polygon> plans() {
  std::map<std::string, Polygon> out{
      {"rectangle", polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}})},
      {"L", polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}})},
      {"U", polygon({{0, 0}, {30, 0}, {30, 20}, {22, 20}, {22, 8}, {8, 8}, {8, 20}, {0, 20}})},
      {"T", polygon({{0, 0}, {30, 0}, {30, 8}, {19, 8}, {19, 20}, {11, 20}, {11, 8}, {0, 8}})},
      {"trapezoid", polygon({{0, 0}, {20, 0}, {16, 9}, {3, 9}})},
      {"hexagon", regular(6, 10)},
      {"thin strip", polygon({{0, 0}, {30, 0}, {30, 1.2}, {0, 1.2}})},
      {"step of 5 cm", polygon({{0, 0}, {10, 0}, {10, 0.05}, {20, 0.05}, {20, 10}, {0, 10}})},
      {"circle of 100 corners", regular(100, 9)},
      {"turret of 24 corners", regular(24, 2)},
      {"edges along the middle line",
       polygon({{0, 0}, {6, 0}, {6, 5}, {9, 5}, {9, 0}, {20, 0}, {20, 5}, {15, 5}, {15, 10}, {3, 10}, {3, 5}, {0, 5}})},
      {"notches that touch the middle line",
       polygon({{0, 0}, {4, 0}, {6, 5}, {8, 0}, {20, 0}, {20, 10}, {16, 10}, {14, 5}, {12, 10}, {0, 10}})},
      {"short edges", polygon({{0, 0}, {12, 0}, {12.3, 0.3}, {12.3, 9}, {12, 9.3}, {0, 9.3}, {-0.3, 9}, {-0.3, 0.3}})},
      {"star", polygon({{10, 0}, {3, 2}, {0, 10}, {-3, 2}, {-10, 0}, {-3, -2}, {0, -10}, {3, -2}})},
  };
  Polygon court = polygon({{0, 0}, {40, 0}, {40, 30}, {0, 30}});
  court.holes.push_back(ring({{11, 11}, {11, 19}, {29, 19}, {29, 11}}));
  out.emplace("courtyard", court);
  Polygon diamond = polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}});
  diamond.holes.push_back(ring({{10, 4}, {7, 7}, {10, 10}, {13, 7}}));
  diamond.holes.push_back(ring({{10, 13}, {8, 16}, {10, 17}, {12, 16}}));
  out.emplace("court with its corner on the middle line", diamond);
  return out;
}

/// Where plans are moved to: the origin, and two places as far as UTM coordinates lie.
inline constexpr Point2 kPlaces[] = {{0, 0}, {395000.123, 5818000.456}, {391000.5, 5819000.25}};
inline constexpr double kAngles[] = {0, 7, 33, 45, 90, 133.7};

/// A star-shaped ring with noisy radii, concave and oblique.
inline std::vector<Point2> noisy_ring(Random& random, int corners, double least, double most) {
  std::vector<Point2> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * (i + 0.6 * random.unit()) / corners,
                 radius = least + (most - least) * random.unit();
    points.push_back(model::snap(Point2{radius * std::cos(angle), radius * std::sin(angle)}));
  }
  return points;
}

/// Skylines on both sides of a band with heights of whole metres, and square courts: many corners and edges lie exactly
/// on lines at simple shares of the width.
inline Polygon skyline(Random& random) {
  const int columns = 2 + static_cast<int>(random.next(6));
  std::vector<Point2> below, above;
  double x = 0;
  Polygon out;
  for (int i = 0; i < columns; ++i) {
    const double next = x + 4 + static_cast<double>(random.next(4));
    const double low = -6 + static_cast<double>(random.next(4)), high = 6 - static_cast<double>(random.next(4));
    below.insert(below.end(), {{x, low}, {next, low}});
    above.insert(above.end(), {{x, high}, {next, high}});
    if (random.next(3) == 0) {
      const double middle = (x + next) / 2, y = static_cast<double>(random.next(3)) - 1;
      if (random.next(2) == 0)
        out.holes.push_back(ring({{middle - 1, y - 1}, {middle - 1, y + 1}, {middle + 1, y + 1}, {middle + 1, y - 1}}));
      else
        out.holes.push_back(ring({{middle - 1, y}, {middle, y + 1}, {middle + 1, y}, {middle, y - 1}}));
    }
    x = next;
  }
  std::vector<Point2> points;
  const auto add = [&](Point2 p) {
    if (points.empty() || points.back() != p) points.push_back(p);
  };
  for (const Point2 p : below) add(p);
  for (auto p = above.rbegin(); p != above.rend(); ++p) add(*p);
  out.outer = ring(std::move(points));
  geometry::remove_collinear(out.outer, 1e-6);
  return out;
}

/// A strictly simple plan of random kind, angle and place, up to two courts in it.
inline Polygon random_plan(Random& random) {
  for (;;) {
    Polygon plan;
    switch (random.next(3)) {
      case 0:
        plan = skyline(random);
        break;
      case 1: {
        plan = polygon(noisy_ring(random, 4 + static_cast<int>(random.next(30)), 6, 20));
        if (random.next(2) == 0) {
          auto court = noisy_ring(random, 3 + static_cast<int>(random.next(6)), 0.5, 2.4);
          std::reverse(court.begin(), court.end());
          for (Point2& p : court) p.x += 2.5;
          plan.holes.push_back(ring(court));
          for (Point2& p : court) p.x -= 5;
          plan.holes.push_back(ring(court));
        }
        break;
      }
      default:
        plan = polygon(noisy_ring(random, 3 + static_cast<int>(random.next(60)), 2, 3 + 20 * random.unit()));
    }
    const double angle = random.next(3) == 0 ? 90.0 * static_cast<double>(random.next(4)) : 360 * random.unit();
    plan = moved(plan, angle, kPlaces[random.next(3)]);
    // Walls nearer than 2 cm are repair's business, not a roof's.
    if (!geometry::strictly_simple(plan)) continue;
    const auto& p = plan.outer.points;
    bool narrow = false;
    for (std::size_t i = 0; i < p.size() && !narrow; ++i)
      for (std::size_t k = 0; k < p.size(); ++k)
        if (k != i && k != (i + 1) % p.size())
          narrow = narrow || geometry::distance_to_segment(p[k], p[i], p[(i + 1) % p.size()]) < 0.02;
    if (!narrow) return plan;
  }
}

}  // namespace blockrand::roof_checks
