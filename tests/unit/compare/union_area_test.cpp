#include "pipeline/compare/union_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace blockrand::compare {
namespace {

FlatPolygon box(double left, double bottom, double right, double top) {
  return {{{left, bottom}, {right, bottom}, {right, top}, {left, top}}};
}
double area(const std::vector<FlatPolygon>& polygons) { return union_area(polygons); }

TEST(UnionArea, OfNothing) {
  EXPECT_EQ(area({}), 0);
  EXPECT_EQ(area({{}}), 0);
  EXPECT_EQ(area({{{{0, 0}, {1, 1}}}}), 0);
  EXPECT_EQ(area({box(1, 0, 1, 5)}), 0);
}

TEST(UnionArea, OfBoxesThatTouchOverlapAndRepeat) {
  EXPECT_DOUBLE_EQ(area({box(0, 0, 2, 1)}), 2);
  EXPECT_DOUBLE_EQ(area({box(0, 0, 2, 1), box(0, 0, 2, 1)}), 2);
  EXPECT_DOUBLE_EQ(area({box(0, 0, 2, 1), box(2, 0, 3, 1)}), 3);
  EXPECT_DOUBLE_EQ(area({box(0, 0, 2, 2), box(1, 1, 3, 3)}), 7);
  EXPECT_DOUBLE_EQ(area({box(0, 0, 9, 9), box(1, 1, 3, 3)}), 81);
}

TEST(UnionArea, OfHolesWhateverTheirOrientation) {
  FlatPolygon holed = box(0, 0, 4, 4);
  holed.push_back({{1, 1}, {2, 1}, {2, 2}, {1, 2}});
  EXPECT_DOUBLE_EQ(area({holed}), 15);
  holed[1] = {{1, 1}, {1, 2}, {2, 2}, {2, 1}};
  EXPECT_DOUBLE_EQ(area({holed}), 15);
  EXPECT_DOUBLE_EQ(area({holed, box(1, 1, 2, 1.5)}), 15.5);
}

TEST(UnionArea, OfPolygonsThatCross) {
  // Two bars at right angles, turned by 30 degrees: 10 + 10 - 1.
  const double c = std::sqrt(0.75), s = 0.5;
  const auto turned = [&](FlatPolygon polygon) {
    for (auto& ring : polygon)
      for (auto& p : ring) p = {c * p.x - s * p.y, s * p.x + c * p.y};
    return polygon;
  };
  EXPECT_NEAR(area({turned(box(-5, -0.5, 5, 0.5)), turned(box(-0.5, -5, 0.5, 5))}), 19, 1e-12);
}

TEST(UnionArea, WithinAWindow) {
  EXPECT_DOUBLE_EQ(union_area(std::vector<FlatPolygon>{box(0, 0, 4, 4), box(3, 3, 6, 6)}, Box{2, 5, 2, 5}), 4 + 4 - 1);
  EXPECT_EQ(union_area(std::vector<FlatPolygon>{box(0, 0, 4, 4)}, Box{5, 6, 0, 1}), 0);
}

TEST(UnionArea, AgreesWithCountingOnRandomTriangles) {
  // Inclusion and exclusion by halves of a plane: a fine grid of points, 1.5 % of the area.
  std::mt19937 random(42);
  std::uniform_real_distribution<double> at(0, 10);
  for (int run = 0; run < 20; ++run) {
    std::vector<FlatPolygon> triangles;
    for (int i = 0; i < 12; ++i)
      triangles.push_back({{{at(random), at(random)}, {at(random), at(random)}, {at(random), at(random)}}});
    const auto inside = [](const FlatPolygon& t, double x, double y) {
      int sides = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& a = t[0][i];
        const auto& b = t[0][(i + 1) % 3];
        sides += (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) > 0 ? 1 : -1;
      }
      return std::abs(sides) == 3;
    };
    std::size_t hits = 0;
    constexpr int kSteps = 300;
    for (int i = 0; i < kSteps; ++i) {
      for (int k = 0; k < kSteps; ++k) {
        bool in = false;
        for (const auto& t : triangles) in = in || inside(t, 10.0 * (i + 0.5) / kSteps, 10.0 * (k + 0.5) / kSteps);
        hits += in;
      }
    }
    const double counted = 100.0 * static_cast<double>(hits) / (kSteps * kSteps);
    EXPECT_NEAR(union_area(triangles), counted, 0.015 * counted);
  }
}

TEST(UnionArea, DoesNotDependOnHowPolygonsAreCut) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> at(0, 10);
  for (int run = 0; run < 50; ++run) {
    const std::vector<model::Point2> t{{at(random), at(random)}, {at(random), at(random)}, {at(random), at(random)}};
    const double whole = area({{t}});
    const double cross = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
    EXPECT_NEAR(whole, std::fabs(cross) / 2, 1e-11);
    const model::Point2 m{(t[0].x + 2 * t[1].x) / 3, (t[0].y + 2 * t[1].y) / 3};
    EXPECT_NEAR(area({{{t[0], m, t[2]}}, {{m, t[1], t[2]}}}), whole, 1e-10);
    EXPECT_NEAR(area({{{t[2], m, t[0]}}, {{m, t[1], t[2]}}, {t}}), whole, 1e-9);
  }
}

}  // namespace
}  // namespace blockrand::compare
