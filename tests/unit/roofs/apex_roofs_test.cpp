#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "pipeline/model/roof_shape.h"
#include "styles/roofs/shape_tables.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::RoofShape;
using namespace roof_checks;

constexpr std::pair<RoofShape, std::size_t> kFacesPerEdge[] = {{RoofShape::pyramidal, 1},
                                                               {RoofShape::cone, 1},
                                                               {RoofShape::dome, 6},
                                                               {RoofShape::onion, 9},
                                                               {RoofShape::spire, 2}};

bool convex(const Polygon& plan) {
  const auto& p = plan.outer.points;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (geometry::orientation(geometry::to_grid(p[i]), geometry::to_grid(p[(i + 1) % p.size()]),
                              geometry::to_grid(p[(i + 2) % p.size()])) < 0)
      return false;
  return plan.holes.empty();
}

TEST(ApexRings, GoFromThePlanToTheApex) {
  for (const auto& [shape, faces] : kFacesPerEdge) {
    const auto rings = apex_rings(shape);
    ASSERT_EQ(rings.size(), faces + 1);
    EXPECT_EQ(rings.front().size, 1);
    EXPECT_EQ(rings.front().height, 0);
    EXPECT_EQ(rings.back().size, 0);
    EXPECT_EQ(rings.back().height, 1);
    for (std::size_t i = 1; i < rings.size(); ++i) EXPECT_LT(rings[i - 1].height, rings[i].height);
  }
  for (std::size_t i = 0; i < model::kRoofShapeCount; ++i) {
    const auto shape = static_cast<RoofShape>(i);
    const bool listed = std::any_of(std::begin(kFacesPerEdge), std::end(kFacesPerEdge),
                                    [&](const auto& entry) { return entry.first == shape; });
    EXPECT_EQ(listed, !apex_rings(shape).empty()) << model::name(shape);
  }
  const auto dome = apex_rings(RoofShape::dome);
  for (std::size_t i = 0; i < dome.size(); ++i) {
    EXPECT_NEAR(dome[i].size, std::cos(static_cast<double>(i) * M_PI / 12), 1e-15);
    EXPECT_NEAR(dome[i].height, std::sin(static_cast<double>(i) * M_PI / 12), 1e-15);
  }
}

TEST(ApexRoof, FacesPerEdge) {
  const auto p = plans();
  for (const char* name : {"rectangle", "trapezoid", "hexagon", "star", "turret of 24 corners", "short edges"})
    for (const auto& [shape, faces] : kFacesPerEdge) {
      const auto roof = apex_roof(p.at(name), {36, 4}, apex_rings(shape));
      ASSERT_TRUE(roof) << name;
      EXPECT_EQ(roof->surfaces.size(), faces * p.at(name).outer.size()) << name << ' ' << model::name(shape);
    }
}

TEST(ApexRoof, LeavesOutRingsFinerThanTheGridCanShow) {
  const auto roof = apex_roof(regular(24, 0.4), {36, 1}, apex_rings(RoofShape::onion));
  ASSERT_TRUE(roof);
  EXPECT_EQ(roof->surfaces.size(), 8u * 24) << "the ring of 0.08, with edges of 8 mm, is missing";
  EXPECT_EQ(validity(regular(24, 0.4), *roof), "none");
  EXPECT_DOUBLE_EQ(highest(*roof), 37);
}

TEST(ApexRoof, RefusesPlansItsApexDoesNotSee) {
  const auto p = plans();
  for (const char* name : {"U", "courtyard"})
    for (const auto& [shape, faces] : kFacesPerEdge)
      EXPECT_FALSE(apex_roof(p.at(name), {36, 4}, apex_rings(shape))) << name;
}

TEST(ApexRoof, EveryPlanClosesAtEveryAngleOrIsRefused) {
  int built = 0;
  for (const auto& [name, plan] : plans())
    for (const double turn : kAngles)
      for (const Point2 place : kPlaces)
        for (const auto& [shape, faces] : kFacesPerEdge) {
          const Polygon p = moved(plan, turn, place);
          const auto roof = apex_roof(p, {36, 4}, apex_rings(shape));
          if (!roof) continue;
          ++built;
          const std::string what = name + ", " + std::string(model::name(shape)) + ", turned " + std::to_string(turn);
          EXPECT_EQ(validity(p, *roof), "none") << what;
          EXPECT_NEAR(covered_area(*roof), geometry::area(p), 1e-6) << what;
          EXPECT_EQ(highest(*roof), 40) << what;
        }
  EXPECT_GT(built, 800);
}

TEST(CrossedRoof, FacesOnConvexPlans) {
  const auto p = plans();
  const auto faces = [&](const char* name, double gable) {
    const auto roof = crossed_roof(p.at(name), {36, 6}, gable);
    EXPECT_TRUE(roof) << name;
    EXPECT_EQ(validity(p.at(name), *roof), "none") << name;
    EXPECT_EQ(roof->wall_tops[0].size(), 3u);
    EXPECT_DOUBLE_EQ(roof->wall_tops[0][1].z, 36 + 6 * gable);
    return roof->surfaces.size();
  };
  EXPECT_EQ(faces("rectangle", 1), 8u);
  EXPECT_EQ(faces("rectangle", 0.5), 4u) << "lozenges are plane";
  EXPECT_EQ(faces("hexagon", 1), 12u);
  EXPECT_EQ(faces("hexagon", 0.5), 12u);
  EXPECT_EQ(faces("trapezoid", 0.5), 8u);
  for (const char* name : {"L", "U", "courtyard", "star", "turret of 24 corners"})
    EXPECT_FALSE(crossed_roof(p.at(name), {36, 6}, 1)) << name;
}

TEST(CrossedRoof, EveryConvexPlanClosesAtEveryAngle) {
  int built = 0;
  for (const auto& [name, plan] : plans())
    for (const double turn : kAngles)
      for (const Point2 place : kPlaces)
        for (const double gable : {0.5, 1.0}) {
          const Polygon p = moved(plan, turn, place);
          const auto roof = crossed_roof(p, {36, 4}, gable);
          if (!roof) {
            EXPECT_FALSE(convex(p) && p.outer.size() <= 12) << name;
            continue;
          }
          ++built;
          EXPECT_EQ(validity(p, *roof), "none") << name << ' ' << turn;
          EXPECT_NEAR(covered_area(*roof), geometry::area(p), 0.05) << name << ' ' << turn;
          EXPECT_EQ(highest(*roof), 40) << name;
        }
  EXPECT_GT(built, 150);
}

TEST(ApexRoof, RandomPlansClose) {
  Random random(21);
  int built = 0, crossed = 0, invalid = 0, rounds = 2000;
  if (const char* text = std::getenv("BLOCKRAND_ROUNDS")) rounds = std::atoi(text);
  for (int round = 0; round < rounds; ++round) {
    // Star-shaped from about the centroid, from nearly round to spiky, from turrets to halls.
    const double size = 0.5 + 15 * random.unit() * random.unit(), rough = random.unit();
    const int n = 3 + static_cast<int>(random.next(random.next(2) == 0 ? 8 : 60));
    const Polygon plan = moved(polygon(noisy_ring(random, n, size * (1 - 0.8 * rough * rough), size)),
                               360 * random.unit(), kPlaces[random.next(3)]);
    if (!geometry::strictly_simple(plan)) continue;
    const RoofMeasures measures{36, 0.3 + 8 * random.unit()};
    const auto judge = [&](const std::optional<Roof>& roof, int& count, std::string_view what) {
      if (!roof) return;
      ++count;
      const std::string found = validity(plan, *roof);
      if (found != "none") {
        ++invalid;
        std::cout << round << ' ' << what << ", " << n << " corners, size " << size << ", height " << measures.height
                  << ": " << found << '\n';
      }
      EXPECT_NEAR(covered_area(*roof), geometry::area(plan), 0.1) << round;
      EXPECT_EQ(highest(*roof), measures.eaves + measures.height) << round;
    };
    for (const auto& [shape, faces] : kFacesPerEdge)
      judge(apex_roof(plan, measures, apex_rings(shape)), built, model::name(shape));
    judge(crossed_roof(plan, measures, 1), crossed, "crosspitched");
    judge(crossed_roof(plan, measures, 0.5), crossed, "helm");
  }
  std::cout << "built " << built << " around an apex, " << crossed << " crossed, invalid " << invalid << '\n';
  EXPECT_GT(built, 3 * rounds);
  EXPECT_GT(crossed, rounds / 10);
  EXPECT_EQ(invalid, 0);
}

TEST(LongAxis, LongerSideOfTheSmallestRectangle) {
  for (const double turn : kAngles) {
    const Point2 axis = geometry::long_axis(moved(plans().at("rectangle"), turn, kPlaces[1]).outer.points);
    const double radians = turn * M_PI / 180;
    EXPECT_NEAR(std::fabs(axis.x * std::cos(radians) + axis.y * std::sin(radians)), 1, 1e-6) << turn;
    EXPECT_NEAR(std::hypot(axis.x, axis.y), 1, 1e-12);
  }
}

TEST(DefaultSlope, LooksAwayFromThePlanAcrossItsLongestEdge) {
  const Point2 down = default_slope(polygon({{0, 0}, {10, 0}, {10, 5}, {-1, 5}}));
  EXPECT_NEAR(down.x, 0, 1e-12);
  EXPECT_NEAR(down.y, 1, 1e-12);
  // The first of equally long edges.
  EXPECT_EQ(default_slope(plans().at("rectangle")), (Point2{0, -1}));
}

}  // namespace
}  // namespace blockrand::roofs
