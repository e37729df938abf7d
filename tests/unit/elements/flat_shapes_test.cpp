#include "styles/elements/flat_shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "pipeline/model/vector.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using Loops = std::vector<std::vector<std::uint32_t>>;

struct Plate {
  std::vector<Point2> points;
  Loops loops;
  void add(const Outline& outline, bool hole) {
    std::vector<std::uint32_t> loop;
    for (const Point2 p : outline) {
      loop.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(p);
    }
    if (hole) std::reverse(loop.begin(), loop.end());
    loops.push_back(loop);
  }
};

Outline rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

/// A frame with two lights below and one above.
Plate window(double width, double height, double bar) {
  Plate out;
  const double middle = width / 2, transom = 0.7 * height;
  out.add(rectangle(0, 0, width, height), false);
  out.add(rectangle(bar, bar, middle - bar / 2, transom), true);
  out.add(rectangle(middle + bar / 2, bar, width - bar, transom), true);
  out.add(rectangle(bar, transom + bar, width - bar, height - bar), true);
  return out;
}

/// Under a segmental head of that rise.
Plate arched(double width, double height, double rise, double bar) {
  constexpr int kSteps = 8;
  const auto under = [&](double x0, double y0, double x1, double y1, double up) {
    Outline out{{x0, y0}, {x1, y0}};
    for (int i = 0; i <= kSteps; ++i) {
      const double t = std::numbers::pi * i / kSteps, half = (x1 - x0) / 2;
      out.push_back({(x0 + x1) / 2 + half * std::cos(t), y1 + up * std::sin(t)});
    }
    return out;
  };
  Plate out;
  out.add(under(0, 0, width, height, rise), false);
  out.add(under(bar, bar, width - bar, height - bar, rise), true);
  return out;
}

double area_of(const std::vector<Point2>& points, const std::vector<std::uint32_t>& loop) {
  Outline outline;
  for (const std::uint32_t i : loop) outline.push_back(points[i]);
  return signed_area(outline);
}

/// The faces are convex and have the area of the plate.
void expect_cover(const Plate& plate) {
  const auto faces = convex_faces(plate.points, plate.loops);
  ASSERT_TRUE(faces);
  double sum = 0, whole = 0;
  for (const auto& face : *faces) {
    const std::size_t n = face.size();
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_GT(cross(plate.points[face[i]], plate.points[face[(i + 1) % n]], plate.points[face[(i + 2) % n]]), 0);
    sum += area_of(plate.points, face);
  }
  for (const auto& loop : plate.loops) whole += area_of(plate.points, loop);
  EXPECT_NEAR(sum, whole, 1e-9);
}

TEST(ConvexFaces, FramesOfOneLayoutAreCutAlike) {
  const Plate wide = window(2.4, 1.1, 0.06), high = window(0.8, 2.3, 0.09);
  ASSERT_EQ(wide.loops, high.loops);
  EXPECT_EQ(convex_faces(wide.points, wide.loops), convex_faces(high.points, high.loops));
  expect_cover(wide);
  expect_cover(high);
}

TEST(ConvexFaces, AnyPlateIsCovered) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(i);
    expect_cover(window(between(0.5, 4), between(0.8, 4), between(0.02, 0.1)));
    const double width = between(0.5, 3);
    expect_cover(arched(width, between(0.8, 3), between(0.01, width / 2), between(0.02, 0.1)));
    // A slanted outline, of which the counted corners need not be a polygon that is cut in the same way.
    Plate slanted;
    Outline star;
    for (int k = 0; k < 11; ++k) {
      const double r = between(0.5, 2), t = 2 * std::numbers::pi * k / 11;
      star.push_back({r * std::cos(t), r * std::sin(t)});
    }
    slanted.add(star, false);
    slanted.add(rectangle(-0.2, -0.15, 0.1, 0.2), true);
    expect_cover(slanted);
  }
}

TEST(ConvexFaces, HolesThatMeetAreRefused) {
  Plate crossing;
  crossing.add(rectangle(0, 0, 2, 2), false);
  crossing.add(rectangle(0.5, 0.5, 1.2, 1.2), true);
  crossing.add(rectangle(1, 1, 1.5, 1.5), true);
  EXPECT_FALSE(convex_faces(crossing.points, crossing.loops));
}

}  // namespace
}  // namespace blockrand::elements
