#include "styles/roofs/roof_windows.h"

#include <gtest/gtest.h>

#include "tests/unit/roofs/element_houses.h"

namespace blockrand::roofs {
namespace {

using model::RoofElementKind;
using model::RoofShape;
using namespace roof_checks;

double volume_of(const model::Solid& solid) { return geometry::volume(solid, geometry::triangulate(solid).value()); }

TEST(RoofWindow, IsAFrameWithAPaneSetIntoIt) {
  for (const double degrees : {16.0, 38.0, 45.0, 70.0, 79.0}) {
    const GabledHouse house(std::tan(degrees * M_PI / 180));
    const auto window = roof_window(house.plane(), {}, {10, 1});
    ASSERT_TRUE(window) << degrees;
    EXPECT_EQ(window->kind, RoofElementKind::roof_window);
    EXPECT_EQ(installations_validity({*window}), "none") << degrees;
    EXPECT_EQ(window->solid.faces.size(), 11u);
    // 0.78 x 1.18 x 0.057, less a pane of 0.62 x 1.02 that lies 0.02 deep.
    EXPECT_NEAR(volume_of(window->solid), 0.78 * 1.18 * 0.057 - 0.62 * 1.02 * 0.02, 0.0015) << degrees;
    EXPECT_EQ(broken_rules(house.roof, {*window}), std::vector<std::string>{});
    // Its underside lies 3 mm over the slope, its lower edge 1 m from the eaves.
    const RoofSlope plane = house.plane();
    const auto& under = window->solid.faces.front();
    ASSERT_EQ(under.kind, model::SurfaceKind::closure);
    double lowest = 1e9;
    for (const std::uint32_t v : window->solid.indices_of(window->solid.loops_of(under)[0])) {
      const Point3 p = window->solid.vertices[v];
      EXPECT_NEAR((p.z - plane.height_at(p.xy())) / plane.slope_length, 0.003, 0.0015);
      lowest = std::min(lowest, plane.in_plane(p).y);
    }
    // 3 mm square to the slope are so many in plan.
    EXPECT_NEAR(lowest, 1, 0.004 * plane.slope_length);
  }
}

TEST(RoofWindow, IsValidOnEverySlopeAndPlace) {
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::hipped, RoofShape::mansard, RoofShape::gambrel,
                                RoofShape::half_hipped, RoofShape::double_saltbox})
    for (const Polygon& plan : turned_about(plans().at("L"))) {
      Fitting with;
      with.cross_gables = with.dormers = with.chimneys = false;
      const Fitted fitted = fit_out(plan, {}, roof_on(plan, shape, 5), with);
      EXPECT_GT(fitted.installations.size(), 8u);
      EXPECT_EQ(installations_validity(fitted.installations), "none");
      EXPECT_EQ(broken_rules(fitted.roof, fitted.installations), std::vector<std::string>{});
    }
}

TEST(RoofWindow, KeepsItsDistances) {
  const GabledHouse house(1);
  RoofSlope plane = house.plane();
  EXPECT_TRUE(roof_window(plane, {}, {1.39, 1}));
  EXPECT_FALSE(roof_window(plane, {}, {1.385, 1}));
  EXPECT_FALSE(roof_window(plane, {}, {10, 0.995}));
  const double top = 5 * std::sqrt(2.0) - 0.3 - 1.18;
  EXPECT_TRUE(roof_window(plane, {}, {10, top - 0.001}));
  EXPECT_FALSE(roof_window(plane, {}, {10, top + 0.005}));
  plane.occupied.push_back({{{9, 1}, {11, 1}, {11, 2}, {9, 2}}, 1.5});
  EXPECT_FALSE(roof_window(plane, {}, {10, 3.4}));
  EXPECT_TRUE(roof_window(plane, {}, {10, 3.5}));
  EXPECT_TRUE(roof_window(plane, {}, {12.89, 1}));
  EXPECT_FALSE(roof_window(plane, {}, {12.88, 1}));
}

TEST(RoofWindow, RefusesWhatMakesNoBody) {
  const GabledHouse house(1);
  const auto takes = [&](auto change) {
    RoofWindowParameters p;
    change(p);
    return roof_window(house.plane(), p, {10, 1}).has_value();
  };
  EXPECT_TRUE(takes([](auto& p) { p.width = 1.34; }));
  EXPECT_FALSE(takes([](auto& p) { p.width = 0.1; }));
  EXPECT_FALSE(takes([](auto& p) { p.height = -1; }));
  EXPECT_FALSE(takes([](auto& p) { p.frame = 0.4; }));    // no pane is left
  EXPECT_FALSE(takes([](auto& p) { p.reveal = 0.06; }));  // the pane lies in the roof
  EXPECT_FALSE(takes([](auto& p) { p.raised = 0; }));
  EXPECT_FALSE(roof_window(GabledHouse(0.1).plane(), {}, {10, 1}));
}

}  // namespace
}  // namespace blockrand::roofs
