#include "styles/roofs/element_layout.h"

#include <gtest/gtest.h>

#include "tests/unit/roofs/element_houses.h"

namespace blockrand::roofs {
namespace {

using model::RoofShape;
using namespace roof_checks;

std::vector<Point2> box(double width, double height) {
  return {{-width / 2, 0}, {width / 2, 0}, {width / 2, height}, {-width / 2, height}};
}

LayoutRequest layout_request_of(double width, double height = 1) {
  LayoutRequest wanted_layout;
  wanted_layout.outline = box(width, height);
  return wanted_layout;
}

std::vector<double> rounded(std::vector<double> values) {
  for (double& v : values) v = std::round(v * 1e3) / 1e3;
  return values;
}

using Places = std::vector<double>;

/// The most elements of width `width` on a slope of length `length`: floor((L - 2 * 1.0 + 1.5) / (d + 1.5)), at least 0
/// (docs/sources.md, Holtmeier 5.3).
int most_elements(double length, double width) {
  constexpr double kRounding = 1e-6;
  return std::max(0, static_cast<int>(std::floor((length - 2 * 1.0 + 1.5) / (width + 1.5) + kRounding)));
}

TEST(Layout, TakesAsManyAsTheFormulaOnRectangles) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const double width = model::snap(0.6 + 2.4 * random.unit()), length = model::snap(2 + 30 * random.unit());
    const GabledHouse house(1, length);
    if (house.south() == SIZE_MAX) continue;
    const RoofSlope plane = house.plane();
    // On short houses the ridge runs the other way.
    const auto along = plane.along_extent();
    if (std::fabs(along.maximum - along.minimum - length) > 0.01 || plane.loops[0].size() != 4) continue;
    const Layout layout = lay_out(plane, layout_request_of(width));
    EXPECT_EQ(static_cast<int>(layout.along.size()), most_elements(length, width)) << length << " " << width;
    EXPECT_EQ(layout.did_not_fit, 0);
  }
}

TEST(Layout, TakesWhatFitsToTheMillimetre) {
  for (const int n : {1, 2, 3, 7}) {
    const double length = 2 + n * 1.25 + (n - 1) * 1.5;  // on the grid
    if (length < 11) continue;
    const GabledHouse house(1, length);
    const Layout layout = lay_out(house.plane(), layout_request_of(1.25));
    ASSERT_EQ(static_cast<int>(layout.along.size()), n);
    for (int i = 0; i < n; ++i) EXPECT_NEAR(layout.along[static_cast<std::size_t>(i)], 1.625 + 2.75 * i, 1e-4);
    for (const double x : layout.along) {
      auto outline = box(1.25, 1);
      for (Point2& p : outline) p = {p.x + x, p.y + 1};
      EXPECT_TRUE(fits(house.plane(), outline, {}));
    }
  }
}

TEST(Layout, SpreadsTheWantedInEqualFields) {
  const GabledHouse house(1);
  LayoutRequest wanted_layout = layout_request_of(1.3);
  wanted_layout.count = 4;
  EXPECT_EQ(rounded(lay_out(house.plane(), wanted_layout).along), (Places{2.5, 7.5, 12.5, 17.5}));
  wanted_layout.count = 1;
  EXPECT_EQ(rounded(lay_out(house.plane(), wanted_layout).along), (Places{10}));
  wanted_layout.count = 0;
  EXPECT_TRUE(lay_out(house.plane(), wanted_layout).along.empty());
  wanted_layout.count = 9;
  const Layout layout = lay_out(house.plane(), wanted_layout);
  EXPECT_EQ(layout.along.size(), 6u);  // (20 - 2 + 1.5) / 2.8 = 6.96
  EXPECT_EQ(layout.did_not_fit, 3);
  EXPECT_NEAR(layout.along.front(), 20.0 / 12, 1e-6);
}

TEST(Layout, StandsOnWindowAxes) {
  const GabledHouse house(1);
  LayoutRequest wanted_layout = layout_request_of(1.3);
  wanted_layout.axes = {2, 5, 8, 11, 14, 17};  // 3 m apart: each takes one
  EXPECT_EQ(lay_out(house.plane(), wanted_layout).along, wanted_layout.axes);
  wanted_layout.axes = {2, 4, 6, 8, 10, 12, 14, 16, 18};  // 2 m apart: every second one
  const Layout layout = lay_out(house.plane(), wanted_layout);
  EXPECT_EQ(layout.along, (Places{2, 6, 10, 14, 18}));
  EXPECT_EQ(layout.did_not_fit, 4);
  wanted_layout.count = 2;
  EXPECT_EQ(lay_out(house.plane(), wanted_layout).along.size(), 2u);
  wanted_layout.count.reset();
  wanted_layout.axes = {0.5, 10, 19.9};  // the outer ones are nearer than 1 m to the verges
  EXPECT_EQ(lay_out(house.plane(), wanted_layout).along, (Places{10}));
  EXPECT_EQ(lay_out(house.plane(), wanted_layout).did_not_fit, 2);
  wanted_layout.axes = {18, 2, 10};  // in any order
  EXPECT_EQ(lay_out(house.plane(), wanted_layout).along, (Places{2, 10, 18}));
}

TEST(Layout, StandsEveryStepAboutTheMiddle) {
  const GabledHouse house(1);
  LayoutRequest wanted_layout = layout_request_of(1.3);
  wanted_layout.step = 4.8;
  EXPECT_EQ(rounded(lay_out(house.plane(), wanted_layout).along), (Places{2.8, 7.6, 12.4, 17.2}));
  wanted_layout.step = 30;
  EXPECT_EQ(rounded(lay_out(house.plane(), wanted_layout).along), (Places{10}));
}

TEST(Layout, GoesRoundWhatStandsThere) {
  GabledHouse house(1);
  RoofSlope plane = house.plane();
  plane.occupied.push_back({{{9, 1}, {11, 1}, {11, 3}, {9, 3}}, 1.5});
  const Layout layout = lay_out(plane, layout_request_of(1.3));
  // 9 m less 1 and 1.5 to each side: (9 - 2.5 + 1.5) / 2.8 = 2.86.
  ASSERT_EQ(layout.along.size(), 4u);
  EXPECT_LE(layout.along[1], 9 - 1.5 - 0.65 + 1e-4);
  EXPECT_GE(layout.along[2], 11 + 1.5 + 0.65 - 1e-4);
  EXPECT_EQ(free_intervals(plane, layout_request_of(1.3)).size(), 2u);
  // What stands higher up the slope than that is not in the way.
  plane.occupied[0].outline = {{9, 4}, {11, 4}, {11, 5}, {9, 5}};
  EXPECT_EQ(lay_out(plane, layout_request_of(1.3)).along.size(), 6u);
}

TEST(Layout, KeepsOffHipsAndNarrowsWithThem) {
  const Polygon plan = rectangle(20, 10);
  const Roof hipped = roof_on(plan, RoofShape::hipped, 5);
  const auto plane = roof_slope(hipped, 0).value();
  for (const double up : {1.0, 3.0, 5.0}) {
    LayoutRequest wanted_layout = layout_request_of(0.8);
    wanted_layout.up = up;
    const auto free = free_intervals(plane, wanted_layout);
    if (plane.loops[0].size() == 3 && up > 3) {
      EXPECT_TRUE(free.empty());
      continue;
    }
    ASSERT_EQ(free.size(), 1u);
    // A hip of a 45 degree roof runs one metre along for each sqrt(2) up the slope: 35.26 degrees from the fall line.
    // The box's upper corner keeps 0.75 m from it.
    const double hip = (up + 1) / std::sqrt(2.0), off = 0.75 * std::sqrt(1.5);
    EXPECT_NEAR(free[0].first, hip + off + 0.4, 2e-3);
  }
}

TEST(Layout, PlacesNothingWhereNothingFits) {
  const GabledHouse low(0.1);  // 5 m of slope: 1 m to the eaves, 0.3 to the ridge
  EXPECT_TRUE(lay_out(low.plane(), layout_request_of(1.3, 4)).along.empty());
  EXPECT_EQ(lay_out(low.plane(), layout_request_of(1.3, 3.7)).along.size(), 6u);
  LayoutRequest wanted_layout = layout_request_of(1.3);
  wanted_layout.up = 0.5;
  EXPECT_TRUE(lay_out(low.plane(), wanted_layout).along.empty());
  wanted_layout.outline.clear();
  EXPECT_TRUE(lay_out(low.plane(), wanted_layout).along.empty());
}

TEST(TakesElements, FromFifteenToEightyDegrees) {
  const auto takes = [](double degrees) {
    const double rise = std::tan(degrees * M_PI / 180);
    return takes_elements(GabledHouse(rise).plane());
  };
  EXPECT_FALSE(takes(14.5));
  EXPECT_TRUE(takes(15.5));
  EXPECT_TRUE(takes(79.5));
  EXPECT_FALSE(takes(80.5));
}

}  // namespace
}  // namespace blockrand::roofs
