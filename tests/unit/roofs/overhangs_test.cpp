#include "styles/roofs/overhangs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "styles/roofs/caps.h"
#include "tests/unit/roofs/element_checks.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofEdge;
using model::RoofElementKind;
using model::RoofShape;
using model::SurfaceKind;
using roof_checks::area;
using roof_checks::fault;
using testing_shapes::polygon;
using testing_shapes::Random;

constexpr double kEaves = 10;  // m

Roof roof_on(const Polygon& plan, RoofShape shape, double height = 4) {
  RoofRequest request;
  request.shape = shape;
  request.measures = {kEaves, height};
  return build_roof(plan, request)->roof;
}

const Polygon kRectangle = polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});

double volume(const BuiltElements& built, RoofElementKind kind) {
  double sum = 0;
  for (const auto& body : built.bodies)
    if (body.kind == kind) sum += roof_checks::volume(body.solid);
  return sum;
}

int count(const BuiltElements& built, RoofElementKind kind) {
  int n = 0;
  for (const auto& body : built.bodies) n += body.kind == kind;
  return n;
}

TEST(Overhangs, HipRoofHasOneRingOfEaves) {
  const Roof roof = roof_on(kRectangle, RoofShape::hipped, 5);  // 45 degrees
  const auto built = overhangs(kRectangle, roof, {}, {.eaves = 0.5, .thickness = 0.2, .most_drop = 1});
  ASSERT_EQ(built.elements.bodies.size(), 1u);
  EXPECT_EQ(built.elements.asked, 4);
  EXPECT_EQ(built.elements.refused + built.elements.shortened, 0);
  const model::Solid& ring = built.elements.bodies[0].solid;
  EXPECT_EQ(fault(masses::envelope(kRectangle, 0, roof, {}), built.elements.bodies), "");
  EXPECT_EQ(ring.faces.size(), 16u);  // upper, lower, outer and wall side of four edges
  const double plan_area = 21 * 11 - 20 * 10;
  EXPECT_NEAR(roof_checks::volume(ring), plan_area * 0.2, 0.01);
  EXPECT_NEAR(area(ring, SurfaceKind::roof), plan_area * std::sqrt(2), 0.02);
  EXPECT_NEAR(area(ring, SurfaceKind::outer_ceiling), plan_area * std::sqrt(2), 0.02);
  EXPECT_NEAR(area(ring, SurfaceKind::wall), 2 * (21 + 11) * 0.2, 0.03);
  EXPECT_NEAR(area(ring, SurfaceKind::closure), 2 * (20 + 10) * 0.2, 0.03);
  double lowest = 1e9, highest = -1e9;
  for (const Point3& p : ring.vertices) {
    lowest = std::min(lowest, p.z);
    highest = std::max(highest, p.z);
  }
  EXPECT_NEAR(lowest, kEaves - 0.5 - 0.2, 0.002);
  EXPECT_NEAR(highest, kEaves, 0.002);
  EXPECT_EQ(built.corners.size(), 4u);
}

TEST(Overhangs, GableHasVergesUpToTheRidge) {
  const Roof roof = roof_on(kRectangle, RoofShape::gabled, 5);
  const auto built = overhangs(kRectangle, roof, {}, {.eaves = 0.4, .verge = 0.25, .thickness = 0.2, .most_drop = 1});
  EXPECT_EQ(fault(masses::envelope(kRectangle, 0, roof, {}), built.elements.bodies), "");
  EXPECT_EQ(count(built.elements, RoofElementKind::eaves), 2);
  EXPECT_EQ(count(built.elements, RoofElementKind::verge), 2);
  // All of the offset's area is covered once: 20.5 by 10.8 without 20 by 10.
  EXPECT_NEAR(volume(built.elements, RoofElementKind::eaves) + volume(built.elements, RoofElementKind::verge),
              (20.5 * 10.8 - 200) * 0.2, 0.01);
  for (const auto& body : built.elements.bodies)
    if (body.kind == RoofElementKind::verge) {
      double highest = 0;
      for (const Point3& p : body.solid.vertices) highest = std::max(highest, p.z);
      EXPECT_NEAR(highest, kEaves + 5, 0.002);
    }
}

TEST(Overhangs, VergeRunsThroughWhereADeckEndsInAGable) {
  const Roof roof = roof_on(kRectangle, RoofShape::double_saltbox, 3);
  const auto built = overhangs(kRectangle, roof, {}, {.verge = 0.25, .most_drop = 1});
  EXPECT_EQ(fault(masses::envelope(kRectangle, 0, roof, {}), built.elements.bodies), "");
  EXPECT_EQ(count(built.elements, RoofElementKind::verge), 2);  // slope, deck and slope are one body
  for (const auto& body : built.elements.bodies)
    for (const Point3& p : body.solid.vertices) EXPECT_GE(p.x, -0.251);
}

TEST(Overhangs, EndsAtPartyWalls) {
  const Roof roof = roof_on(kRectangle, RoofShape::gabled, 4);
  std::vector<OverhangRoom> rooms(4);
  rooms[1].edge = rooms[3].edge = RoofEdge::party_wall;
  const auto built = overhangs(kRectangle, roof, rooms);
  EXPECT_EQ(built.elements.asked, 2);
  EXPECT_EQ(built.elements.bodies.size(), 2u);
  for (const auto& body : built.elements.bodies)
    for (const Point3& p : body.solid.vertices) {
      EXPECT_GE(p.x, 0);
      EXPECT_LE(p.x, 20);
    }
}

TEST(Overhangs, EndsBeforeAnObliquePartyWallsLine) {
  // The party wall leans over the front at (20, 0): an end square to the front would cross its line.
  const Polygon plan = polygon({{0, 0}, {20, 0}, {23, 10}, {0, 10}});
  const Roof roof = roof_on(plan, RoofShape::gabled, 4);
  std::vector<OverhangRoom> rooms(4);
  rooms[1].edge = RoofEdge::party_wall;
  for (const auto& body : overhangs(plan, roof, rooms).elements.bodies)
    for (const Point3& p : body.solid.vertices) {
      const double left = 3 * p.y - 10 * (p.x - 20);  // of the wall's line, times its length
      EXPECT_GT(left, -0.03) << p.x << ' ' << p.y;
      if (p.y < 5) {
        EXPECT_LE(p.x, 20.001);
      }
    }
}

TEST(Overhangs, EdgesOnOneLineHaveOneBoardAndOneFace) {
  const Polygon plan = polygon({{0, 0}, {7, 0}, {13, 0}, {20, 0}, {20, 10}, {0, 10}});
  const Roof roof = roof_on(plan, RoofShape::hipped, 5);
  const auto built = overhangs(plan, roof, {});
  ASSERT_EQ(built.elements.bodies.size(), 1u);
  EXPECT_EQ(built.elements.asked, 6);
  EXPECT_EQ(built.elements.bodies[0].solid.faces.size(), 16u);
  EXPECT_EQ(fault(masses::envelope(plan, 0, roof, {}), built.elements.bodies), "");
}

TEST(Overhangs, RoundingMakesNoSteps) {
  for (const double angle : roof_checks::kAngles) {
    const Polygon plan = roof_checks::moved(kRectangle, angle, roof_checks::kPlaces[1]);
    const Roof roof = roof_on(plan, RoofShape::hipped, 6.7);
    const auto built = overhangs(plan, roof, {});
    ASSERT_EQ(built.elements.bodies.size(), 1u) << angle;
    EXPECT_EQ(built.elements.bodies[0].solid.faces.size(), 16u) << angle;
  }
}

TEST(Overhangs, RoomBeforeTheWallIsKept) {
  const Roof roof = roof_on(kRectangle, RoofShape::hipped);
  std::vector<OverhangRoom> rooms(4);
  rooms[0].room = 0.15;
  rooms[2].room = 0;
  const auto built = overhangs(kRectangle, roof, rooms);
  EXPECT_EQ(built.elements.asked, 3);
  EXPECT_EQ(built.elements.shortened, 1);
  double low = 0, high = 0;
  for (const auto& body : built.elements.bodies)
    for (const Point3& p : body.solid.vertices) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
  EXPECT_NEAR(low, -0.15, 0.001);
  EXPECT_LE(high, 10.001);
}

TEST(Overhangs, SharpCornersAreCutSquare) {
  // 14 degrees at the origin: the mitre would reach 3.3 m beyond it.
  const Polygon plan = polygon({{0, 0}, {20, 0}, {20, 5}});
  const Roof roof = roof_on(plan, RoofShape::hipped, 1);
  const auto built = overhangs(plan, roof, {});
  EXPECT_EQ(fault(masses::envelope(plan, 0, roof, {}), built.elements.bodies), "");
  for (const auto& body : built.elements.bodies)
    for (const Point3& p : body.solid.vertices) EXPECT_GE(p.x, -0.41);
}

TEST(Overhangs, NarrowCourtsGetLess) {
  Polygon plan = polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}});
  plan.holes.push_back(testing_shapes::ring({{9.7, 6}, {9.7, 14}, {10.3, 14}, {10.3, 6}}));
  const Roof roof = roof_on(plan, RoofShape::hipped, 3);
  const auto built = overhangs(plan, roof, {});
  EXPECT_EQ(fault(masses::envelope(plan, 0, roof, {}), built.elements.bodies), "");
  EXPECT_EQ(built.elements.asked, 8);
  EXPECT_GE(built.elements.shortened, 2);
}

TEST(Overhangs, DoNotReachTheOtherSideOfASlot) {
  // A slot of 0.25 m between two arms; the far arm's wall is bare.
  const Polygon plan = polygon({{0, 0}, {12.25, 0}, {12.25, 12}, {6.25, 12}, {6.25, 5}, {6, 5}, {6, 12}, {0, 12}});
  const Roof roof = roof_on(plan, RoofShape::hipped, 3);
  std::vector<OverhangRoom> rooms(8);
  rooms[3].room = rooms[4].room = 0;
  const auto built = overhangs(plan, roof, rooms);
  EXPECT_EQ(fault(masses::envelope(plan, 0, roof, {}), built.elements.bodies), "");
  EXPECT_GE(built.elements.shortened, 1);
  EXPECT_EQ(built.elements.refused, 0);
  for (const auto& body : built.elements.bodies)
    for (const Point3& p : body.solid.vertices)
      if (p.y < 11.9 && p.y > 5.1) {
        EXPECT_FALSE(p.x > 6.21 && p.x < 12.2) << p.x;
      }
}

TEST(Overhangs, SteepSlopesComeDownNoFartherThanTold) {
  const Roof roof = roof_on(kRectangle, RoofShape::mansard, 6);
  const auto built = overhangs(kRectangle, roof, {}, {.most_drop = 0.3});
  ASSERT_FALSE(built.elements.bodies.empty());
  for (const auto& body : built.elements.bodies)
    for (const Point3& p : body.solid.vertices) EXPECT_GE(p.z, kEaves - 0.3 - 0.18 - 0.003);
}

TEST(Caps, OneRidgeOnAGable) {
  const Roof roof = roof_on(kRectangle, RoofShape::gabled, 5);
  const auto built = ridge_and_hip_caps(roof, {}, {}, {.profile = CapProfile::triangular, .width = 0.3, .height = 0.1});
  ASSERT_EQ(built.bodies.size(), 1u);
  EXPECT_EQ(built.bodies[0].kind, RoofElementKind::ridge_cap);
  EXPECT_EQ(fault(masses::envelope(kRectangle, 0, roof, {}), built.bodies), "");
  EXPECT_NEAR(roof_checks::volume(built.bodies[0].solid), 20 * 0.3 * 0.1 / 2, 0.005);
}

TEST(Caps, HipRoofHasARidgeAndFourHips) {
  const Roof roof = roof_on(kRectangle, RoofShape::hipped, 5);
  const auto eaves = overhangs(kRectangle, roof, {});
  const auto built = ridge_and_hip_caps(roof, eaves.corners, {});
  EXPECT_EQ(count(built, RoofElementKind::ridge_cap), 1);
  EXPECT_EQ(count(built, RoofElementKind::hip_cap), 4);
  auto all = eaves.elements.bodies;
  all.insert(all.end(), built.bodies.begin(), built.bodies.end());
  EXPECT_EQ(fault(masses::envelope(kRectangle, 0, roof, {}), all), "");
  // The hips go on to the corners of the eaves, 0.4 m out.
  double least = 0;
  for (const auto& body : built.bodies)
    for (const Point3& p : body.solid.vertices) least = std::min(least, p.x);
  EXPECT_NEAR(least, -0.4, 0.002);
}

TEST(Caps, NoneOnFlatAndLeanToRoofs) {
  EXPECT_EQ(ridge_and_hip_caps(roof_on(kRectangle, RoofShape::flat), {}, {}).asked, 0);
  EXPECT_EQ(ridge_and_hip_caps(roof_on(kRectangle, RoofShape::skillion), {}, {}).asked, 0);
}

TEST(Caps, BreakOfAMansardIsNoHip) {
  const auto built = ridge_and_hip_caps(roof_on(kRectangle, RoofShape::gambrel), {}, {});
  EXPECT_EQ(built.asked, 1);
  EXPECT_EQ(built.bodies.size(), 1u);
}

TEST(Caps, EndBeforeWhatStandsThere) {
  const Roof roof = roof_on(kRectangle, RoofShape::gabled, 5);
  const std::vector<std::vector<Point2>> walls{{{19.7, 0}, {20, 0}, {20, 10}, {19.7, 10}}};
  const auto built = ridge_and_hip_caps(roof, {}, walls);
  ASSERT_EQ(built.bodies.size(), 1u);
  EXPECT_EQ(built.shortened, 1);
  for (const Point3& p : built.bodies[0].solid.vertices) EXPECT_LE(p.x, 19.701);
}

class OverhangsAndCaps : public testing::TestWithParam<RoofShape> {};

TEST_P(OverhangsAndCaps, AreValidAndTouchOnly) {
  int asked = 0, refused = 0, caps_asked = 0, caps_refused = 0;
  for (const auto& [name, plan] : roof_checks::plans())
    for (const double angle : {0.0, 33.0}) {
      const Polygon place = roof_checks::moved(plan, angle, angle == 0 ? Point2{} : Point2{395000.123, 5818000.456});
      RoofRequest request;
      request.shape = GetParam();
      request.measures = {kEaves, 4};
      const auto built = build_roof(place, request);
      ASSERT_TRUE(built) << name;
      const model::Solid house = masses::envelope(place, 0, built->roof, {});
      if (roof_checks::validity(house) != "none") continue;
      const auto eaves = overhangs(place, built->roof, {});
      const auto caps = ridge_and_hip_caps(built->roof, eaves.corners, {});
      auto all = eaves.elements.bodies;
      all.insert(all.end(), caps.bodies.begin(), caps.bodies.end());
      EXPECT_EQ(fault(house, all), "") << name << " at " << angle;
      asked += eaves.elements.asked;
      refused += eaves.elements.refused;
      caps_asked += caps.asked;
      caps_refused += caps.refused;
    }
  std::printf("%s: overhangs %d, %d refused; caps %d, %d refused\n", std::string(model::name(GetParam())).c_str(),
              asked, refused, caps_asked, caps_refused);
}

INSTANTIATE_TEST_SUITE_P(Shapes, OverhangsAndCaps,
                         testing::Values(RoofShape::flat, RoofShape::gabled, RoofShape::hipped, RoofShape::mansard,
                                         RoofShape::gambrel, RoofShape::half_hipped, RoofShape::skillion,
                                         RoofShape::double_saltbox, RoofShape::round, RoofShape::pyramidal,
                                         RoofShape::butterfly, RoofShape::crosspitched),
                         [](const auto& info) {
                           std::string name(model::name(info.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace blockrand::roofs
