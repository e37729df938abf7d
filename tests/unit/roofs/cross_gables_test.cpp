#include "styles/roofs/cross_gables.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/roofs/element_houses.h"
#include "tests/unit/roofs/placed_dormer.h"

namespace blockrand::roofs {
namespace {

using model::RoofElementKind;
using model::RoofShape;
using namespace roof_checks;

CrossGableParameters gable(DormerKind kind = DormerKind::gabled, double wall = 1) {
  CrossGableParameters p;
  p.kind = kind;
  p.wall_height = wall;
  if (kind == DormerKind::shed) p.roof_pitch = 10;
  return p;
}

/// Points of a wall top as (x, z) from the eaves' end back to its start.
std::vector<Point2> wall_top(const Roof& roof, std::size_t edge) {
  std::vector<Point2> out;
  for (const Point3& p : roof.wall_tops[edge]) out.push_back({p.x, p.z - kEaves});
  return out;
}

void expect_near(const std::vector<Point2>& found, const std::vector<Point2>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].x, wanted[i].x, 0.001) << i;
    EXPECT_NEAR(found[i].y, wanted[i].y, 0.001) << i;
  }
}

TEST(CrossGable, CutsWallEavesAndSlopeInOneOperation) {
  GabledHouse house(1);
  ASSERT_TRUE(add_cross_gable(house.roof, house.south(), gable(), {10, 0}));
  EXPECT_EQ(validity(house.plan, house.roof), "none");
  EXPECT_EQ(house.roof.elements, std::vector<RoofElementKind>{RoofElementKind::cross_gable});
  // The wall goes up and down again; other walls stay.
  expect_near(wall_top(house.roof, 0), {{20, 0}, {11.3, 0}, {11.3, 1}, {10, 2.3}, {8.7, 1}, {8.7, 0}, {0, 0}});
  EXPECT_EQ(house.roof.wall_tops[2].size(), 2u);
  // Flush: every point of the wall lies in the façade.
  for (const Point3& p : house.roof.wall_tops[0]) EXPECT_NEAR(p.y, 0, 0.001);
  // Nothing of the slope is left below the gable: its loop goes up the valleys.
  const auto& slope = house.roof.surfaces[house.south()].loops;
  ASSERT_EQ(slope.size(), 1u);
  EXPECT_EQ(slope[0].size(), 9u);  // four corners, two feet, two ends of the cheeks, the ridge's end
  for (const Point3& p : slope[0]) EXPECT_TRUE(std::fabs(p.x - 10) > 1.29 || p.y > 1);
  EXPECT_NEAR(covered_area(house.roof), 200, 0.005);
  const ElementMeasures m = measures_of(house.roof, 0);
  EXPECT_EQ(m.upright, 2);  // cheeks; the front belongs to the wall
  EXPECT_EQ(m.sloped, 2);
  EXPECT_NEAR(m.upright_area, 1.0, 0.005);
  EXPECT_NEAR(m.plan_area, 2.6 * 1 + 2.6 * 1.3 / 2, 0.005);
  EXPECT_NEAR(m.highest, kEaves + 2.3, 0.001);
}

TEST(CrossGable, WithoutCheeksItsSlopesStartAtTheEaves) {
  GabledHouse house(1);
  ASSERT_TRUE(add_cross_gable(house.roof, house.south(), gable(DormerKind::gabled, 0), {10, 0}));
  EXPECT_EQ(validity(house.plan, house.roof), "none");
  expect_near(wall_top(house.roof, 0), {{20, 0}, {11.3, 0}, {10, 1.3}, {8.7, 0}, {0, 0}});
  const ElementMeasures m = measures_of(house.roof, 0);
  EXPECT_EQ(m.upright, 0);
  EXPECT_EQ(m.sloped, 2);
}

TEST(CrossGable, AddsItsVolume) {
  for (const double degrees : {35.0, 45.0, 60.0}) {
    const double rise = std::tan(degrees * M_PI / 180);
    const double w = 2.6, wall = 1, ridge = 1.3, arc = 0.43;
    // Behind each point of the front, z high, lies a triangle of z² / 2 rise.
    std::map<DormerKind, double> expected{
        {DormerKind::gabled, w * (wall * wall + wall * ridge + ridge * ridge / 3) / (2 * rise)},
        {DormerKind::flat, w * wall * wall / (2 * rise)},
        {DormerKind::shed, w * wall * wall / (2 * (rise - std::tan(10 * M_PI / 180)))}};
    const double depth = std::min(w / 2, 0.6 * (wall + ridge) / rise);
    expected[DormerKind::hipped] = expected[DormerKind::gabled] - w / 2 * ridge * depth / 3;
    double barrel = 0;
    const double radius = (w * w / 4 + arc * arc) / (2 * arc), reach = std::asin(w / 2 / radius);
    for (int i = 0; i < 8; ++i) {
      const double a0 = -reach + reach * i / 4, a1 = -reach + reach * (i + 1) / 4;
      const double z0 = wall + arc - radius + radius * std::cos(a0), z1 = wall + arc - radius + radius * std::cos(a1);
      barrel += radius * (std::sin(a1) - std::sin(a0)) * (z0 * z0 + z0 * z1 + z1 * z1) / 3 / (2 * rise);
    }
    expected[DormerKind::segmental] = barrel;
    for (const auto& [kind, volume] : expected) {
      GabledHouse house(rise);
      const double before = volume_under(house.plan, house.roof);
      ASSERT_TRUE(add_cross_gable(house.roof, house.south(), gable(kind), {7, 0})) << degrees;
      EXPECT_EQ(validity(house.plan, house.roof), "none");
      EXPECT_NEAR(volume_under(house.plan, house.roof) - before, volume, 0.02) << degrees;
    }
  }
}

TEST(CrossGable, StandsOnEveryKindOfRoofAnywhere) {
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::hipped, RoofShape::mansard, RoofShape::gambrel,
                                RoofShape::half_hipped, RoofShape::double_saltbox})
    for (const auto& [name, plan] : plans()) {
      if (name != "rectangle" && name != "L" && name != "U" && name != "courtyard") continue;
      for (const Polygon& p : turned_about(plan)) {
        Roof roof = roof_on(p, shape, 5);
        std::size_t built = 0;
        const std::size_t surfaces = roof.surfaces.size();
        for (std::size_t s = 0; s < surfaces; ++s) {
          const auto plane = roof_slope(roof, s);
          if (!plane) continue;
          LayoutRequest wanted_layout;
          wanted_layout.outline = cross_gable_outline(*plane, gable());
          wanted_layout.flush = true;
          wanted_layout.up = 0;
          wanted_layout.count = 1;
          for (const double along : lay_out(*plane, wanted_layout).along)
            built += add_cross_gable(roof, s, gable(), {along, 0});
        }
        EXPECT_GE(built, 2u) << model::name(shape) << " on " << name;
        EXPECT_EQ(validity(p, roof), "none") << model::name(shape) << " on " << name;
        EXPECT_EQ(broken_rules(roof, {}), std::vector<std::string>{}) << model::name(shape) << " on " << name;
      }
    }
}

TEST(CrossGable, KeepsItsDistances) {
  const auto takes = [](double along, double width = 2.6) {
    GabledHouse house(1);
    CrossGableParameters p = gable();
    p.width = width;
    const Roof bare = house.roof;
    const bool taken = add_cross_gable(house.roof, house.south(), p, {along, 0});
    EXPECT_TRUE(taken || same_roof(house.roof, bare));
    return taken;
  };
  EXPECT_TRUE(takes(2.3));  // 1.0 and half of 2.6
  EXPECT_FALSE(takes(2.295));
  EXPECT_TRUE(takes(17.7));
  EXPECT_FALSE(takes(17.705));
  EXPECT_FALSE(takes(0));
  EXPECT_FALSE(takes(-5));
  EXPECT_TRUE(takes(10, 3));
  EXPECT_FALSE(takes(10, 3.01));
  // From each other and from dormers, whichever comes first.
  GabledHouse house(1);
  ASSERT_TRUE(add_cross_gable(house.roof, house.south(), gable(), {5, 0}));
  EXPECT_FALSE(add_cross_gable(house.roof, house.south(), gable(), {9.09, 0}));
  EXPECT_TRUE(add_cross_gable(house.roof, house.south(), gable(), {9.1, 0}));
  DormerParameters dormer;
  dormer.kind = DormerKind::flat;
  // The eaves are in three pieces now; a dormer stands up the slope, where the valley leaves more room than at the
  // foot.
  EXPECT_FALSE(add_dormer(house.roof, house.south(), dormer, {12, 1}));
  EXPECT_TRUE(add_dormer(house.roof, house.south(), dormer, {12.6, 1}));
  EXPECT_FALSE(add_cross_gable(house.roof, house.south(), gable(), {14, 0}));
  EXPECT_TRUE(add_cross_gable(house.roof, house.south(), gable(), {17, 0}));
  EXPECT_EQ(validity(house.plan, house.roof), "none");
  EXPECT_EQ(broken_rules(house.roof, {}), std::vector<std::string>{});
}

TEST(CrossGable, RefusesWhatHasNoEavesOrNoRoom) {
  const Polygon plan = rectangle(20, 10);
  Roof flat = flat_roof(plan, kEaves);
  EXPECT_FALSE(add_cross_gable(flat, 0, gable(), {10, 0}));
  GabledHouse house(1);
  std::vector<model::RoofEdge> edges(4, model::RoofEdge::open);
  edges[0] = model::RoofEdge::party_wall;
  EXPECT_FALSE(add_cross_gable(house.roof, house.south(), gable(), {10, 0}, edges));
  EXPECT_FALSE(add_cross_gable(house.roof, house.south(), gable(DormerKind::eyebrow), {10, 0}));
  EXPECT_FALSE(add_cross_gable(house.roof, house.south(), gable(DormerKind::flat, 0), {10, 0}));
  EXPECT_FALSE(add_cross_gable(house.roof, house.south(), gable(DormerKind::gabled, 0.05), {10, 0}));
  EXPECT_FALSE(add_cross_gable(house.roof, house.south(), gable(DormerKind::gabled, 4), {10, 0}));  // over the ridge
  EXPECT_EQ(house.roof.elements.size(), 0u);
  // The upper slope of a gambrel has no eaves.
  Roof gambrel = roof_on(plan, RoofShape::gambrel, 6);
  int upper = 0;
  for (const RoofSlope& plane : roof_slopes(gambrel)) {
    if (std::any_of(plane.borders.begin(), plane.borders.end(),
                    [](const auto& b) { return b.kind == BorderKind::eaves; }))
      continue;
    ++upper;
    EXPECT_FALSE(add_cross_gable(gambrel, plane.surface, gable(), {10, 0}));
  }
  EXPECT_EQ(upper, 2);
}

TEST(CrossGable, StandsBesideABayInTheEaves) {
  const Polygon bay = polygon({{0, 0}, {8, 0}, {8, -1}, {11, -1}, {11, 0}, {24, 0}, {24, 10}, {0, 10}});
  for (const Polygon& plan : turned_about(bay))
    for (const RoofShape shape : {RoofShape::gabled, RoofShape::hipped}) {
      Roof roof = roof_on(plan, shape, 5);
      Fitting with;
      const Fitted fitted = fit_out(plan, {}, roof, with);
      EXPECT_EQ(validity(plan, fitted.roof), "none");
      EXPECT_EQ(broken_rules(fitted.roof, fitted.installations), std::vector<std::string>{});
      EXPECT_GE(fitted.built.at(RoofElementKind::cross_gable), 2);
    }
}

}  // namespace
}  // namespace blockrand::roofs
