#include "styles/roofs/dormers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/roofs/element_houses.h"
#include "tests/unit/roofs/placed_dormer.h"

namespace blockrand::roofs {
namespace {

using model::RoofElementKind;
using model::RoofShape;
using namespace roof_checks;

constexpr RoofShape kSlopedShapes[] = {RoofShape::gabled,  RoofShape::hipped,      RoofShape::mansard,
                                       RoofShape::gambrel, RoofShape::half_hipped, RoofShape::double_saltbox};
constexpr double kRadians = M_PI / 180;

/// Height of a dormer's front over its middle, as its kind defines it, at the ends of the chords.
std::vector<Point2> front_of(const DormerParameters& p) {
  const double half = p.width / 2, ridge = half * std::tan(p.roof_pitch * kRadians);
  std::vector<Point2> out;
  switch (p.kind) {
    case DormerKind::gabled:
    case DormerKind::hipped:
      return {{-half, p.wall_height}, {0, p.wall_height + ridge}, {half, p.wall_height}};
    case DormerKind::segmental: {
      const double radius = half * half / (2 * p.rise) + p.rise / 2, reach = std::asin(half / radius);
      for (int i = 0; i <= p.chords; ++i) {
        const double angle = -reach + 2 * reach * i / p.chords;
        out.push_back({radius * std::sin(angle), p.wall_height + p.rise - radius + radius * std::cos(angle)});
      }
      return out;
    }
    case DormerKind::eyebrow:
      for (int i = 0; i <= p.chords; ++i) {
        const double x = -half + p.width * i / p.chords;
        out.push_back({x, p.wall_height / 2 * (1 + std::cos(2 * M_PI * x / p.width))});
      }
      return out;
    case DormerKind::shed:
    case DormerKind::flat:
    default:
      return {{-half, p.wall_height}, {half, p.wall_height}};
  }
}

/// What a dormer adds to a house: behind each point of the front, z high, lies a triangle of z² / 2 (slope - roof).
double volume_of(const DormerParameters& p, double rise) {
  const bool falls = p.kind == DormerKind::shed || p.kind == DormerKind::eyebrow;
  const double back = falls ? std::tan(p.roof_pitch * kRadians) : 0;
  const auto front = front_of(p);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    const double a = front[i].y, b = front[i + 1].y;
    sum += (front[i + 1].x - front[i].x) * (a * a + a * b + b * b) / 3 / (2 * (rise - back));
  }
  if (p.kind == DormerKind::hipped) {
    const double half = p.width / 2, ridge = half * std::tan(p.roof_pitch * kRadians);
    const double depth = std::min(half, 0.6 * (p.wall_height + ridge) / rise);
    sum -= half * ridge * depth / 3;
  }
  return sum;
}

class Dormer : public testing::TestWithParam<DormerKind> {};

TEST_P(Dormer, IsAsWorkedOutByHand) {
  for (const double degrees : {38.0, 45.0, 60.0, 74.0}) {
    const double rise = std::tan(degrees * kRadians);
    GabledHouse house(rise);
    const double before = volume_under(house.plan, house.roof), plan_area = covered_area(house.roof);
    const DormerParameters p = usual_dormer(GetParam());
    ASSERT_TRUE(add_dormer(house.roof, house.south(), p, {10, 1})) << degrees;
    EXPECT_EQ(validity(house.plan, house.roof), "none");
    EXPECT_EQ(house.roof.elements, std::vector<RoofElementKind>{RoofElementKind::dormer});
    // Corners half a millimetre off the slope bend all of its 100 m².
    EXPECT_NEAR(volume_under(house.plan, house.roof) - before, volume_of(p, rise), 0.04) << degrees;
    EXPECT_NEAR(covered_area(house.roof), plan_area, 0.005);

    const ElementMeasures m = measures_of(house.roof, 0);
    const bool cheeks = p.kind != DormerKind::eyebrow;
    const int roofs = p.kind == DormerKind::gabled                                       ? 2
                      : p.kind == DormerKind::hipped                                     ? 3
                      : p.kind == DormerKind::segmental || p.kind == DormerKind::eyebrow ? p.chords
                                                                                         : 1;
    EXPECT_EQ(m.upright, cheeks ? 3 : 1);
    EXPECT_EQ(m.sloped, roofs);
    // The front, and two cheeks that the slope (and a shed's roof) cut.
    double upright = 0, top = 0;
    auto front = front_of(p);
    if (p.kind == DormerKind::hipped) {
      top = front[1].y;
      front.erase(front.begin() + 1);
    }
    for (std::size_t i = 0; i + 1 < front.size(); ++i) {
      upright += (front[i + 1].x - front[i].x) * (front[i].y + front[i + 1].y) / 2;
      top = std::max({top, front[i].y, front[i + 1].y});
    }
    const double back =
        p.kind == DormerKind::shed || p.kind == DormerKind::eyebrow ? std::tan(p.roof_pitch * kRadians) : 0;
    if (cheeks) upright += p.wall_height * p.wall_height / (rise - back);
    EXPECT_NEAR(m.upright_area, upright, 0.01) << degrees;
    top += back * top / (rise - back);
    const double foot = kEaves + rise / std::sqrt(1 + rise * rise);  // 1 m up the slope
    EXPECT_NEAR(m.highest, foot + top, 0.003) << degrees;
  }
}

TEST_P(Dormer, StandsOnEveryKindOfSlope) {
  int built = 0;
  for (const RoofShape shape : kSlopedShapes)
    for (const auto& [name, plan] : plans()) {
      if (name != "rectangle" && name != "L" && name != "U" && name != "courtyard" && name != "trapezoid") continue;
      for (const Polygon& p : {plan, moved(plan, 33, kPlaces[1]), moved(plan, 133.7, kPlaces[2])}) {
        const Roof bare = roof_on(p, shape, 5);
        Fitting with;
        with.dormer = usual_dormer(GetParam());
        with.cross_gables = with.roof_windows = with.chimneys = false;
        const Fitted fitted = fit_out(p, {}, bare, with);
        EXPECT_EQ(validity(p, fitted.roof), "none") << model::name(shape) << " on " << name;
        EXPECT_EQ(broken_rules(fitted.roof, {}), std::vector<std::string>{}) << model::name(shape) << " on " << name;
        EXPECT_GT(fitted.roof.elements.size(), 0u) << model::name(shape) << " on " << name;
        built += static_cast<int>(fitted.roof.elements.size());
      }
    }
  EXPECT_GT(built, 500);
}

TEST_P(Dormer, RefusesLevelAndFlatAndOverSteepRoofs) {
  const Polygon plan = rectangle(20, 10);
  Roof flat = flat_roof(plan, kEaves);
  const Roof before = flat;
  EXPECT_FALSE(add_dormer(flat, 0, usual_dormer(GetParam()), {10, 1}));
  EXPECT_TRUE(same_roof(flat, before));
  for (const double degrees : {10.0, 14.5, 81.0}) {
    GabledHouse house(std::tan(degrees * kRadians));
    const Roof bare = house.roof;
    DormerParameters small = usual_dormer(GetParam());
    small.wall_height = 0.3;
    EXPECT_FALSE(add_dormer(house.roof, house.south(), small, {10, 1})) << degrees;
    EXPECT_TRUE(same_roof(house.roof, bare));
  }
  GabledHouse low(0.1);  // half a metre of roof
  EXPECT_FALSE(add_dormer(low.roof, low.south(), usual_dormer(GetParam()), {10, 1}));
}

std::string kind_name(const testing::TestParamInfo<DormerKind>& tested) {
  constexpr const char* kNames[] = {"gabled", "hipped", "shed", "flat", "segmental", "eyebrow"};
  return kNames[static_cast<int>(tested.param)];
}

INSTANTIATE_TEST_SUITE_P(Kinds, Dormer, testing::ValuesIn(kDormerKinds), kind_name);

/// A flat dormer on a slope of 45 degrees 1.3 m wide, `wall` high: its roof is `wall` deep, wall * sqrt(2) up the
/// slope.
DormerParameters flat_dormer(double wall = 1.3) {
  DormerParameters p;
  p.kind = DormerKind::flat;
  p.wall_height = wall;
  return p;
}

TEST(DormerDistances, HoldToTheMillimetre) {
  constexpr double kOver = 0.005;  // beyond what is forgiven
  const auto takes = [](Point2 place, double wall = 1.3) {
    GabledHouse house(1);
    return add_dormer(house.roof, house.south(), flat_dormer(wall), place);
  };
  EXPECT_TRUE(takes({10, 1}));
  EXPECT_FALSE(takes({10, 1 - kOver}));  // eaves
  EXPECT_TRUE(takes({1.65, 1}));         // verge: 1 + 0.65
  EXPECT_FALSE(takes({1.65 - kOver, 1}));
  EXPECT_TRUE(takes({18.35, 1}));
  EXPECT_FALSE(takes({18.35 + kOver, 1}));
  const double slope = 5 * std::sqrt(2.0), deepest = (slope - 1 - kTopDistance) / std::sqrt(2.0);
  EXPECT_TRUE(takes({10, 1}, deepest));  // ridge
  EXPECT_FALSE(takes({10, 1}, deepest + kOver));
  EXPECT_FALSE(takes({-3, 1}));  // beside the roof
  EXPECT_FALSE(takes({10, 30}));
}

TEST(DormerDistances, BetweenTwoAndOverAHip) {
  GabledHouse house(1);
  ASSERT_TRUE(add_dormer(house.roof, house.south(), flat_dormer(), {5, 1}));
  const Roof one = house.roof;
  EXPECT_FALSE(add_dormer(house.roof, house.south(), flat_dormer(), {7.79, 1}));  // 1.3 + 1.49
  EXPECT_FALSE(add_dormer(house.roof, house.south(), flat_dormer(), {5, 1}));     // on the same place
  EXPECT_TRUE(same_roof(house.roof, one));
  EXPECT_TRUE(add_dormer(house.roof, house.south(), flat_dormer(), {7.8, 1}));
  EXPECT_EQ(house.roof.elements.size(), 2u);
  EXPECT_EQ(validity(house.plan, house.roof), "none");
  // Other rules than Holtmeier's: Westensee's code wants 1.60 m to the gable and takes 0.60 to the eaves
  // (docs/style_measures.md S28).
  ElementDistances westensee;
  westensee.side = 1.6;
  westensee.eaves = 0.6;
  GabledHouse other(1);
  EXPECT_FALSE(add_dormer(other.roof, other.south(), flat_dormer(), {1.65, 1}, {}, westensee));
  EXPECT_TRUE(add_dormer(other.roof, other.south(), flat_dormer(), {2.25, 0.6}, {}, westensee));
}

TEST(DormerDistances, FromPartyWallsOfARow) {
  // Eaves at a party wall (a lean-to against it) are an outer side; a gable is one in any case.
  GabledHouse house(1);
  const std::vector<model::RoofEdge> edges{model::RoofEdge::street, model::RoofEdge::party_wall,
                                           model::RoofEdge::courtyard, model::RoofEdge::party_wall};
  EXPECT_FALSE(add_dormer(house.roof, house.south(), flat_dormer(), {1.6, 1}, edges));
  EXPECT_TRUE(add_dormer(house.roof, house.south(), flat_dormer(), {1.65, 1}, edges));
}

TEST(DormerParametersTest, RefusesWhatMakesNoBody) {
  const auto takes = [](const DormerParameters& p, double rise = 1) {
    GabledHouse house(rise);
    const Roof bare = house.roof;
    const bool taken = add_dormer(house.roof, house.south(), p, {10, 1});
    EXPECT_TRUE(taken || same_roof(house.roof, bare));
    EXPECT_TRUE(!taken || validity(house.plan, house.roof) == "none");
    return taken;
  };
  const auto with = [](DormerKind kind, auto change) {
    DormerParameters p = usual_dormer(kind);
    change(p);
    return p;
  };
  EXPECT_TRUE(takes(with(DormerKind::flat, [](auto& p) { p.width = 3.0; })));
  EXPECT_FALSE(takes(with(DormerKind::flat, [](auto& p) { p.width = 3.01; })));
  EXPECT_FALSE(takes(with(DormerKind::flat, [](auto& p) { p.width = -1; })));
  EXPECT_FALSE(takes(with(DormerKind::flat, [](auto& p) { p.wall_height = 0; })));
  EXPECT_FALSE(takes(with(DormerKind::gabled, [](auto& p) { p.wall_height = -0.5; })));
  EXPECT_FALSE(takes(with(DormerKind::gabled, [](auto& p) { p.roof_pitch = 0; })));
  EXPECT_FALSE(takes(with(DormerKind::gabled, [](auto& p) { p.roof_pitch = 90; })));
  EXPECT_FALSE(takes(with(DormerKind::shed, [](auto& p) { p.roof_pitch = 44; })));  // as steep as the slope
  EXPECT_TRUE(takes(with(DormerKind::shed, [](auto& p) { p.roof_pitch = 20; })));
  EXPECT_FALSE(takes(with(DormerKind::segmental, [](auto& p) { p.rise = 0.7; })));  // more than half a circle
  EXPECT_TRUE(takes(with(DormerKind::segmental, [](auto& p) { p.rise = 0.65; })));  // half a circle
  EXPECT_FALSE(takes(with(DormerKind::segmental, [](auto& p) { p.chords = 1; })));
  EXPECT_FALSE(takes(with(DormerKind::eyebrow, [](auto& p) { p.chords = 3; })));
  EXPECT_TRUE(takes(with(DormerKind::eyebrow, [](auto& p) { p.chords = 16; })));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(takes(with(DormerKind::gabled, [&](auto& p) { p.width = nan; })));
  EXPECT_FALSE(takes(with(DormerKind::gabled, [&](auto& p) { p.wall_height = nan; })));
  EXPECT_FALSE(takes(with(DormerKind::gabled, [&](auto& p) { p.roof_pitch = nan; })));
  GabledHouse house(1);
  EXPECT_FALSE(add_dormer(house.roof, 99, {}, {10, 1}));
  EXPECT_FALSE(add_dormer(house.roof, house.south(), {}, {nan, 1}));
  EXPECT_FALSE(add_dormer(house.roof, house.south(), {}, {10, nan}));
}

TEST(DormerGeometry, IsTheSameOnEveryPlaceOfTheGrid) {
  for (const DormerKind kind : kDormerKinds)
    for (const Polygon& plan : turned_about(rectangle(20, 10))) {
      Roof roof = roof_on(plan, RoofShape::gabled, 5);
      const double before = volume_under(plan, roof);
      DormerParameters p = usual_dormer(kind);
      p.width = std::min(p.width, 2.3);
      for (std::size_t s = 0; s < 2; ++s) {
        LayoutRequest wanted_layout;
        wanted_layout.outline = dormer_outline(roof_slope(roof, s).value(), p);
        for (const double along : lay_out(roof_slope(roof, s).value(), wanted_layout).along)
          EXPECT_TRUE(add_dormer(roof, s, p, {along, wanted_layout.up}));
      }
      const std::size_t count = kind == DormerKind::eyebrow ? 10 : 12;  // (20 - 2 + 1.5) / (2.3 + 1.5) = 5.13
      EXPECT_EQ(roof.elements.size(), count);
      EXPECT_EQ(validity(plan, roof), "none");
      EXPECT_NEAR(volume_under(plan, roof) - before, static_cast<double>(count) * volume_of(p, 1), 0.1);
    }
}

}  // namespace
}  // namespace blockrand::roofs
