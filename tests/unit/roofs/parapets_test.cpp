#include "styles/roofs/parapets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "styles/roofs/firewalls.h"
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
using testing_shapes::ring;

constexpr double kTop = 12;  // m
const Polygon kRectangle = polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});

std::string fault_on(const Polygon& plan, const Roof& roof, const BuiltElements& built) {
  return fault(masses::envelope(plan, 0, roof, {}), built.bodies);
}

double volume(const BuiltElements& built) {
  double sum = 0;
  for (const auto& body : built.bodies) sum += roof_checks::volume(body.solid);
  return sum;
}

Roof gable_roof(const Polygon& plan, double eaves = 10, double height = 5) {
  RoofRequest request;
  request.shape = RoofShape::gabled;
  request.measures = {eaves, height};
  return build_roof(plan, request)->roof;
}

// ---- parapets

TEST(Parapets, OneRingWithAHoleOnARectangle) {
  const Roof roof = flat_roof(kRectangle, kTop);
  const auto built = parapets(kRectangle, roof, {}, {}, {}, {.height = 0.6, .width = 0.25});
  ASSERT_EQ(built.bodies.size(), 1u);
  EXPECT_EQ(built.asked, 4);
  EXPECT_EQ(fault_on(kRectangle, roof, built), "");
  const model::Solid& wall = built.bodies[0].solid;
  EXPECT_EQ(built.bodies[0].kind, RoofElementKind::parapet);
  EXPECT_EQ(wall.faces.size(), 10u);  // top and underside as one face each, with a hole; four sides out, four in
  const double ring_area = 200 - 19.5 * 9.5;
  EXPECT_NEAR(volume(built), ring_area * 0.6, 0.02);
  EXPECT_NEAR(area(wall, SurfaceKind::roof), ring_area, 0.02);
  EXPECT_NEAR(area(wall, SurfaceKind::closure), ring_area, 0.02);
  EXPECT_NEAR(area(wall, SurfaceKind::wall), (60 + 58) * 0.6, 0.1);
}

TEST(Parapets, LeavePartyWallsOpen) {
  const Roof roof = flat_roof(kRectangle, kTop);
  const std::vector<RoofEdge> edges{RoofEdge::street, RoofEdge::party_wall, RoofEdge::courtyard, RoofEdge::party_wall};
  const auto open = parapets(kRectangle, roof, edges, {}, {}, {.height = 0.5, .width = 0.25});
  EXPECT_EQ(open.bodies.size(), 2u);
  EXPECT_EQ(open.asked, 2);
  EXPECT_NEAR(volume(open), 2 * 20 * 0.25 * 0.5, 0.02);
  EXPECT_EQ(fault_on(kRectangle, roof, open), "");
  const auto lower =
      parapets(kRectangle, roof, edges, {}, {}, {.height = 0.5, .width = 0.25, .party_wall_height = 0.3});
  ASSERT_EQ(lower.bodies.size(), 1u);
  EXPECT_EQ(fault_on(kRectangle, roof, lower), "");
  // Mitred, so that each wall has half of both corners' squares.
  EXPECT_NEAR(volume(lower), 2 * (20 - 0.25) * 0.25 * 0.5 + 2 * (10 - 0.25) * 0.25 * 0.3, 0.02);
}

TEST(Parapets, BareEdgesHaveNone) {
  const Roof roof = flat_roof(kRectangle, kTop);
  const auto built = parapets(kRectangle, roof, {}, {true, false, false, false}, {});
  ASSERT_EQ(built.bodies.size(), 1u);
  EXPECT_EQ(built.asked, 3);
  EXPECT_EQ(fault_on(kRectangle, roof, built), "");
}

TEST(Parapets, CourtsHaveTheirOwnRing) {
  Polygon plan = polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}});
  plan.holes.push_back(ring({{8, 8}, {8, 12}, {12, 12}, {12, 8}}));
  const Roof roof = flat_roof(plan, kTop);
  const auto built = parapets(plan, roof, {}, {}, {}, {.height = 0.5, .width = 0.25});
  EXPECT_EQ(built.bodies.size(), 2u);
  EXPECT_EQ(fault_on(plan, roof, built), "");
  EXPECT_NEAR(volume(built), (400 - 19.5 * 19.5 + 4.5 * 4.5 - 16) * 0.5, 0.03);
}

TEST(Parapets, NarrowPartsAreFilled) {
  // A tongue of 0.4 m, narrower than two walls.
  const Polygon plan = polygon({{0, 0}, {10, 0}, {10, 4}, {16, 4}, {16, 4.4}, {10, 4.4}, {10, 8}, {0, 8}});
  const Roof roof = flat_roof(plan, kTop);
  const auto built = parapets(plan, roof, {}, {}, {}, {.height = 0.5, .width = 0.3});
  EXPECT_EQ(built.refused, 0);
  EXPECT_EQ(fault_on(plan, roof, built), "");
  EXPECT_NEAR(volume(built), (80 - 9.4 * 7.4 + 6 * 0.4) * 0.5, 0.06);
}

TEST(Parapets, AreSolidOnPlansNarrowerThanTwoWalls) {
  const Polygon plan = polygon({{0, 0}, {10, 0}, {10, 0.5}, {0, 0.5}});
  const Roof roof = flat_roof(plan, kTop);
  const auto built = parapets(plan, roof, {}, {}, {}, {.height = 0.5, .width = 0.3});
  ASSERT_EQ(built.bodies.size(), 1u);
  EXPECT_NEAR(volume(built), 10 * 0.5 * 0.5, 0.01);
}

TEST(Parapets, EndWhereTheNeighbourBeginsOnAStraightWall) {
  const Polygon plan = polygon({{0, 0}, {8, 0}, {20, 0}, {20, 10}, {0, 10}});
  const std::vector<RoofEdge> edges{RoofEdge::open, RoofEdge::party_wall, RoofEdge::open, RoofEdge::open,
                                    RoofEdge::open};
  const Roof roof = flat_roof(plan, kTop);
  const auto built = parapets(plan, roof, edges, {}, {}, {.height = 0.5, .width = 0.25});
  EXPECT_EQ(fault_on(plan, roof, built), "");
  for (const auto& body : built.bodies)
    for (const Point3& p : body.solid.vertices)
      if (p.y < 0.2) {
        EXPECT_TRUE(p.x <= 8.001 || p.x >= 19.7) << p.x;
      }
  EXPECT_NEAR(volume(built), (8 + 20 + 10 + 10 - 0.25 * 3) * 0.25 * 0.5, 0.03);
}

TEST(Parapets, StandOnTheBordersOfADeckAlone) {
  RoofRequest request;
  request.shape = RoofShape::double_saltbox;
  request.measures = {10, 3};
  const Roof roof = build_roof(kRectangle, request)->roof;
  EXPECT_EQ(parapets(kRectangle, roof, {}, {}, {}).asked, 0);  // it ends in gables
  const auto built = parapets(kRectangle, roof, {}, {}, {}, {.on_gables = true});
  EXPECT_EQ(built.asked, 2);  // where the deck ends at both gables
  EXPECT_EQ(built.bodies.size(), 2u);
  EXPECT_EQ(fault_on(kRectangle, roof, built), "");
  const auto around = parapets(kRectangle, roof, {}, {}, {}, {.on_gables = true, .around_decks = true});
  EXPECT_EQ(around.bodies.size(), 1u);
  EXPECT_EQ(fault_on(kRectangle, roof, around), "");
}

TEST(Parapets, NoneOnSlopes) { EXPECT_TRUE(parapets(kRectangle, gable_roof(kRectangle), {}, {}, {}).bodies.empty()); }

TEST(Parapets, AreValidOnRandomPlans) {
  Random random(61);
  int asked = 0, refused = 0;
  for (int i = 0; i < 400; ++i) {
    const Polygon plan = roof_checks::random_plan(random);
    const Roof roof = flat_roof(plan, kTop);
    std::size_t count = plan.outer.size();
    for (const auto& hole : plan.holes) count += hole.size();
    std::vector<RoofEdge> edges(count, RoofEdge::open);
    for (RoofEdge& e : edges)
      if (random.next(4) == 0) e = RoofEdge::party_wall;
    for (const double party : {0.0, 0.3}) {
      const auto built = parapets(plan, roof, edges, {}, {}, {.party_wall_height = party});
      ASSERT_EQ(fault_on(plan, roof, built), "") << "plan " << i;
      asked += built.asked;
      refused += built.refused;
    }
  }
  std::printf("parapets on random plans: %d edges, %d refused\n", asked, refused);
  EXPECT_LE(refused, asked / 50);
}

TEST(Parapets, RingOfSixHundredCorners) {
  const Polygon plan = roof_checks::regular(600, 40);
  const Roof roof = flat_roof(plan, kTop);
  const auto built = parapets(plan, roof, {}, {}, {});
  ASSERT_EQ(built.bodies.size(), 1u);
  EXPECT_EQ(built.refused, 0);
  EXPECT_NEAR(volume(built), 3.14159 * (40 * 40 - 39.7 * 39.7) * 0.5, 0.5);
}

// ---- firewalls

std::vector<FirewallSide> sides(std::size_t count, std::initializer_list<std::size_t> party) {
  std::vector<FirewallSide> out(count);
  for (const std::size_t i : party) out[i].party_wall = true;
  return out;
}

TEST(Firewalls, FollowTheGable) {
  const Roof roof = gable_roof(kRectangle);
  const auto built = firewalls(kRectangle, roof, sides(4, {1, 3}), {});
  EXPECT_EQ(built.elements.bodies.size(), 2u);
  EXPECT_EQ(built.elements.asked, 2);
  EXPECT_EQ(fault_on(kRectangle, roof, built.elements), "");
  EXPECT_NEAR(volume(built.elements), 2 * 10 * 0.25 * 0.30, 0.01);
  double highest = 0;
  for (const auto& body : built.elements.bodies)
    for (const Point3& p : body.solid.vertices) {
      highest = std::max(highest, p.z);
      EXPECT_TRUE(p.x <= 0.251 || p.x >= 19.749);
      EXPECT_TRUE(p.x >= -0.001 && p.x <= 20.001);
    }
  EXPECT_NEAR(highest, 15.3, 0.002);
}

TEST(Firewalls, NoneWhereTheNeighbourIsAsHigh) {
  const Roof roof = gable_roof(kRectangle);
  auto both = sides(4, {1});
  both[1].neighbour = {{0, 10}, {5, 15}, {10, 10}};
  EXPECT_EQ(firewalls(kRectangle, roof, both, {}).elements.asked, 0);
  both[1].neighbour = {{0, 20}};
  EXPECT_EQ(firewalls(kRectangle, roof, both, {}).elements.asked, 0);
}

TEST(Firewalls, StandOnTheStretchesThatAreHigher) {
  // A flat neighbour at 12.45: our gable rises above it from 2.5 m to 7.5 m along the wall.
  const Roof roof = gable_roof(kRectangle);
  auto one = sides(4, {1});
  one[1].neighbour = {{0, 12.45}};
  const auto built = firewalls(kRectangle, roof, one, {});
  ASSERT_EQ(built.elements.bodies.size(), 1u);
  EXPECT_EQ(fault_on(kRectangle, roof, built.elements), "");
  double least = 1e9, most = -1e9;
  for (const Point3& p : built.elements.bodies[0].solid.vertices) {
    least = std::min(least, p.y);
    most = std::max(most, p.y);
  }
  EXPECT_NEAR(least, 2.5, 0.01);
  EXPECT_NEAR(most, 7.5, 0.01);
}

TEST(Firewalls, CornersAreOneBody) {
  const Roof roof = flat_roof(kRectangle, kTop);
  const auto built = firewalls(kRectangle, roof, sides(4, {0, 1}), {});
  ASSERT_EQ(built.elements.bodies.size(), 1u);
  EXPECT_NEAR(volume(built.elements), (20 + 10 - 0.25) * 0.25 * 0.3, 0.01);
  const Polygon l = polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}});
  const Roof flat = flat_roof(l, kTop);
  const auto inner = firewalls(l, flat, sides(6, {2, 3}), {});  // the inner corner
  ASSERT_EQ(inner.elements.bodies.size(), 1u);
  EXPECT_EQ(fault_on(l, flat, inner.elements), "");
  EXPECT_NEAR(volume(inner.elements), (12 + 10 + 0.25) * 0.25 * 0.3, 0.01);
}

class FirewallsAndParapets : public testing::TestWithParam<RoofShape> {};

TEST_P(FirewallsAndParapets, AreValidAndTouchOnly) {
  int asked = 0, refused = 0;
  Random random(7);
  for (const auto& [name, plan] : roof_checks::plans())
    for (const double angle : {0.0, 33.0}) {
      const Polygon place = roof_checks::moved(plan, angle, angle == 0 ? Point2{} : Point2{395000.123, 5818000.456});
      RoofRequest request;
      request.shape = GetParam();
      request.measures = {10, 4};
      const auto built = build_roof(place, request);
      ASSERT_TRUE(built) << name;
      const model::Solid house = masses::envelope(place, 0, built->roof, {});
      if (roof_checks::validity(house) != "none") continue;
      const std::size_t count = built->roof.wall_tops.size();
      std::vector<FirewallSide> party(count);
      std::vector<RoofEdge> edges(count);
      for (std::size_t i = 0; i < count; ++i)
        if (random.next(3) == 0) {
          party[i].party_wall = true;
          edges[i] = RoofEdge::party_wall;
          if (random.next(2) == 0) party[i].neighbour = {{0, 9 + 6 * random.unit()}, {8, 9 + 6 * random.unit()}};
        }
      const auto walls = firewalls(place, built->roof, party, {});
      const auto around = parapets(place, built->roof, edges, {}, {});
      EXPECT_EQ(fault(house, walls.elements.bodies), "") << name << " at " << angle;
      EXPECT_EQ(fault(house, around.bodies), "") << name << " at " << angle;
      asked += walls.elements.asked;
      refused += walls.elements.refused;
    }
  std::printf("%s: firewalls %d, %d refused\n", std::string(model::name(GetParam())).c_str(), asked, refused);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FirewallsAndParapets,
                         testing::Values(RoofShape::flat, RoofShape::gabled, RoofShape::hipped, RoofShape::mansard,
                                         RoofShape::gambrel, RoofShape::half_hipped, RoofShape::skillion,
                                         RoofShape::double_saltbox, RoofShape::round, RoofShape::gabled_height_moved,
                                         RoofShape::sawtooth),
                         [](const auto& info) {
                           std::string name(model::name(info.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace blockrand::roofs
