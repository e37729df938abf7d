#include "styles/roofs/chimneys.h"

#include <gtest/gtest.h>

#include "tests/unit/roofs/element_houses.h"
#include "tests/unit/roofs/placed_dormer.h"

namespace blockrand::roofs {
namespace {

using model::RoofEdge;
using model::RoofElementKind;
using model::RoofInstallation;
using model::RoofShape;
using model::SurfaceKind;
using namespace roof_checks;

double volume_of(const RoofInstallation& stack) {
  return geometry::volume(stack.solid, geometry::triangulate(stack.solid).value());
}

double top_of(const RoofInstallation& stack) {
  double z = -1e9;
  for (const Point3& p : stack.solid.vertices) z = std::max(z, p.z);
  return z;
}

Point2 middle_of(const RoofInstallation& stack) {
  Point2 sum;
  int n = 0;
  for (const Point3& p : stack.solid.vertices)
    if (p.z == top_of(stack)) {
      sum = {sum.x + p.x, sum.y + p.y};
      ++n;
    }
  return {sum.x / n, sum.y / n};
}

std::map<SurfaceKind, int> kinds(const RoofInstallation& stack) {
  std::map<SurfaceKind, int> out;
  for (const model::Face& face : stack.solid.faces) ++out[face.kind];
  return out;
}

using Kinds = std::map<SurfaceKind, int>;

/// m, upwards on slopes of 45 degrees.
const double kGap = 0.003 * std::sqrt(2.0);

TEST(Chimney, RidesOnARidge) {
  const GabledHouse house(1);
  const auto stack = chimney(house.roof, {{10, 5}, {1, 0}});
  ASSERT_TRUE(stack);
  EXPECT_EQ(stack->kind, RoofElementKind::chimney);
  EXPECT_EQ(installations_validity({*stack}), "none");
  EXPECT_EQ(kinds(*stack), (Kinds{{SurfaceKind::closure, 2}, {SurfaceKind::wall, 4}, {SurfaceKind::roof, 1}}));
  EXPECT_NEAR(top_of(*stack), kEaves + 5 + 0.75, 0.001);
  // Below the ridge hangs a wedge of 0.58 x 0.29 / 2; all of it stands 3 mm over the slopes, square to them.
  EXPECT_NEAR(volume_of(*stack), 1.2 * (0.58 * (0.75 - kGap) + 0.58 * 0.29 / 2), 0.002);
  EXPECT_EQ(broken_rules(house.roof, {*stack}), std::vector<std::string>{});
}

TEST(Chimney, StandsAcrossARidgeAndInASlope) {
  const GabledHouse house(1);
  const auto across = chimney(house.roof, {{10, 5}, {0, 1}});
  ASSERT_TRUE(across);
  EXPECT_EQ(installations_validity({*across}), "none");
  EXPECT_NEAR(volume_of(*across), 0.58 * (1.2 * (0.75 - kGap) + 1.2 * 0.6 / 2), 0.002);
  const auto inside = chimney(house.roof, {{10, 4}, {1, 0}});
  ASSERT_TRUE(inside);
  EXPECT_EQ(installations_validity({*inside}), "none");
  EXPECT_EQ(kinds(*inside), (Kinds{{SurfaceKind::closure, 1}, {SurfaceKind::wall, 4}, {SurfaceKind::roof, 1}}));
  EXPECT_NEAR(top_of(*inside), kEaves + 5.75, 0.001);  // above the ridge, wherever it stands
  EXPECT_NEAR(volume_of(*inside), 1.2 * 0.58 * (1 + 0.75 - kGap), 0.002);
  // Oblique, over the ridge.
  const auto oblique = chimney(house.roof, {{10, 5}, {0.8, 0.6}});
  ASSERT_TRUE(oblique);
  EXPECT_EQ(installations_validity({*oblique}), "none");
  EXPECT_EQ(broken_rules(house.roof, {*across, *inside, *oblique}), std::vector<std::string>{});
}

TEST(Chimney, StandsOnFlatRoofs) {
  const Polygon plan = rectangle(20, 10);
  const Roof roof = flat_roof(plan, kEaves);
  const auto stack = chimney(roof, {{10, 5}, {1, 0}});
  ASSERT_TRUE(stack);
  EXPECT_NEAR(top_of(*stack), kEaves + 1, 0.001);
  EXPECT_NEAR(volume_of(*stack), 1.2 * 0.58 * 0.997, 0.001);
  EXPECT_EQ(installations_validity({*stack}), "none");
}

TEST(Chimney, RefusesWhatItCannotStandOn) {
  GabledHouse house(1);
  EXPECT_FALSE(chimney(house.roof, {{0.3, 5}, {1, 0}}));    // over the gable
  EXPECT_FALSE(chimney(house.roof, {{50, 5}, {1, 0}}));     // beside the house
  EXPECT_FALSE(chimney(house.roof, {{10, 5.28}, {1, 0}}));  // the ridge would leave a strip of 1 cm
  EXPECT_FALSE(chimney(house.roof, {{10, 1}, {1, 0}}));     // 4 m below the ridge: higher than 3 m
  ChimneyParameters thin;
  thin.width = 0.1;
  EXPECT_FALSE(chimney(house.roof, {{10, 5}, {1, 0}}, thin));
  // The corner of a hip, where three surfaces meet.
  const Roof hipped = roof_on(rectangle(20, 10), RoofShape::hipped, 5);
  EXPECT_FALSE(chimney(hipped, {{5, 5}, {1, 0}}));
  EXPECT_TRUE(chimney(hipped, {{10, 5}, {1, 0}}));
  EXPECT_TRUE(chimney(hipped, {{4.2, 4.2}, {1, 0}}));  // over one hip
  // On and near a dormer.
  ASSERT_TRUE(add_dormer(house.roof, house.south(), {}, {10, 3}));
  EXPECT_FALSE(chimney(house.roof, {{10, 2.5}, {1, 0}}));
  EXPECT_FALSE(chimney(house.roof, {{11.5, 3}, {1, 0}}));  // 25 cm beside its cheek
  EXPECT_TRUE(chimney(house.roof, {{11.7, 3}, {1, 0}}));
}

TEST(Chimney, EndsAboveTheRidgeOfAMansard) {
  const Polygon plan = rectangle(20, 10);
  const Roof roof = roof_on(plan, RoofShape::mansard, 4);
  int in_lower = 0;
  for (const RoofSlope& plane : roof_slopes(roof)) {
    const Point3 p = plane.in_space({(plane.along_extent().minimum + plane.along_extent().maximum) / 2,
                                     plane.up_extent().maximum - 0.8 * plane.slope_length / plane.rise});
    const auto stack = chimney(roof, {p.xy(), plane.along_axis});
    if (!stack) continue;
    in_lower += p.z < kEaves + 2.6;
    EXPECT_NEAR(top_of(*stack), kEaves + 4.75, 0.002);
    EXPECT_EQ(installations_validity({*stack}), "none");
  }
  EXPECT_GT(in_lower, 0);
}

TEST(ChimneyCount, IsOneForEachSixMetresOfFrontage) {
  EXPECT_EQ(chimney_count(2), 1);
  EXPECT_EQ(chimney_count(6), 1);
  EXPECT_EQ(chimney_count(8.9), 1);
  EXPECT_EQ(chimney_count(9.1), 2);
  EXPECT_EQ(chimney_count(18), 3);
  EXPECT_EQ(chimney_count(0), 1);
  ChimneyParameters none;
  none.frontage = 0;
  EXPECT_EQ(chimney_count(0, none), 1);
  EXPECT_EQ(chimney_count(18, none), 1);
}

TEST(ChimneyPlaces, AreEverySixMetresOfRidge) {
  const GabledHouse house(1);
  const auto places = ridge_places(house.roof);
  ASSERT_EQ(places.size(), 3u);  // 20 / 6, rounded
  for (const ChimneyPlace& place : places) EXPECT_NEAR(place.middle.y, 5, 1e-3);
  EXPECT_NEAR(std::fabs(places[1].middle.x - places[0].middle.x), 20.0 / 3, 1e-3);
  // The breaks of a gambrel are no ridges, the deck of a saltbox has none.
  EXPECT_EQ(ridge_places(roof_on(house.plan, RoofShape::gambrel, 5)).size(), 3u);
  EXPECT_EQ(ridge_places(roof_on(house.plan, RoofShape::double_saltbox, 3)).size(), 0u);
  EXPECT_EQ(flat_places(roof_on(house.plan, RoofShape::double_saltbox, 3)).size() % 5, 0u);
  EXPECT_EQ(ridge_places(roof_on(plans().at("L"), RoofShape::hipped, 3)).size(), 4u);  // ridges of 12 and 10 m
  EXPECT_TRUE(ridge_places(flat_roof(house.plan, kEaves)).empty());
}

TEST(ChimneyPlaces, OnPartyWallsStartAtTheRidge) {
  const GabledHouse house(1);
  const std::vector<RoofEdge> edges{RoofEdge::street, RoofEdge::party_wall, RoofEdge::courtyard, RoofEdge::party_wall};
  const auto places = party_wall_places(house.plan, edges, house.roof);
  ASSERT_EQ(places.size(), 2u);  // 5 m to each side there is no room for the next
  for (const ChimneyPlace& place : places) {
    EXPECT_NEAR(place.middle.y, 5, 1e-3);
    EXPECT_NEAR(std::min(place.middle.x, 20 - place.middle.x), 0.05 + 0.29, 1e-6);
  }
  // On level walls: equal fields.
  const Roof flat = flat_roof(house.plan, kEaves);
  const auto level = party_wall_places(house.plan, edges, flat);
  ASSERT_EQ(level.size(), 4u);  // 10 / 6, rounded: two for each wall
  EXPECT_TRUE(party_wall_places(house.plan, {}, house.roof).empty());
}

TEST(Chimneys, StandInRowsWithinTheirOwnHouse) {
  const std::vector<RoofEdge> edges{RoofEdge::street, RoofEdge::party_wall, RoofEdge::courtyard, RoofEdge::party_wall};
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::gambrel, RoofShape::flat, RoofShape::double_saltbox})
    for (const Polygon& plan : turned_about(rectangle(11, 12))) {
      RoofRequest request;
      request.shape = shape;
      request.measures = {kEaves, shape == RoofShape::flat ? 0.0 : 5.0};
      // The ridge runs from party wall to party wall.
      const Point2 side{plan.outer.points[2].x - plan.outer.points[1].x,
                        plan.outer.points[2].y - plan.outer.points[1].y};
      request.down = Point2{side.x / 12, side.y / 12};
      const Roof roof = build_roof(plan, request).value().roof;
      const auto stacks = chimneys(plan, edges, roof, 11);
      ASSERT_EQ(stacks.size(), 2u) << model::name(shape);
      EXPECT_EQ(installations_validity(stacks), "none") << model::name(shape);
      EXPECT_EQ(broken_rules(roof, stacks), std::vector<std::string>{}) << model::name(shape);
      for (const RoofInstallation& stack : stacks) {
        for (const Point3& p : stack.solid.vertices) EXPECT_TRUE(geometry::contains(plan, p.xy()));
        double nearest = 1e9;
        for (const std::size_t e : {1u, 3u})
          nearest = std::min(nearest, geometry::distance_to_segment(middle_of(stack), plan.outer.points[e],
                                                                    plan.outer.points[(e + 1) % 4]));
        EXPECT_NEAR(nearest, 0.34, 0.003);
      }
    }
}

TEST(Chimneys, StandOnEveryKindOfRoof) {
  for (const RoofShape shape :
       {RoofShape::gabled, RoofShape::hipped, RoofShape::mansard, RoofShape::gambrel, RoofShape::half_hipped,
        RoofShape::double_saltbox, RoofShape::flat, RoofShape::pyramidal, RoofShape::skillion})
    for (const auto& [name, plan] : plans()) {
      if (name != "rectangle" && name != "L" && name != "U" && name != "courtyard" && name != "trapezoid") continue;
      const Roof roof = roof_on(plan, shape, 3);
      const auto stacks = chimneys(plan, {}, roof, 12);
      EXPECT_EQ(stacks.size(), 2u) << model::name(shape) << " on " << name;
      EXPECT_EQ(installations_validity(stacks), "none");
      EXPECT_EQ(broken_rules(roof, stacks), std::vector<std::string>{});
      for (std::size_t i = 0; i + 1 < stacks.size(); ++i) {
        const Point2 a = middle_of(stacks[i]), b = middle_of(stacks[i + 1]);
        EXPECT_GE(std::hypot(a.x - b.x, a.y - b.y), 4.99);
      }
    }
}

}  // namespace
}  // namespace blockrand::roofs
