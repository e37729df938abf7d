#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "pipeline/model/roof_shape.h"
#include "styles/roofs/shape_tables.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::RoofShape;
using namespace roof_checks;

constexpr RoofShape kShapes[] = {RoofShape::skillion, RoofShape::butterfly, RoofShape::gabled_height_moved,
                                 RoofShape::sawtooth};

double width_along(const Polygon& plan, Point2 up) {
  const auto extent = geometry::extent_along(plan.outer.points, up);
  return extent.maximum - extent.minimum;
}

std::optional<Roof> built(const Polygon& plan, RoofShape shape, Point2 up, RoofMeasures measures = {36, 4}) {
  return profile_roof(plan, measures, up, profile_points(shape, width_along(plan, up)));
}

TEST(ProfilePoints, AreThoseOfTheDocumentation) {
  EXPECT_EQ(profile_points(RoofShape::sawtooth, 3).size(), 4u) << "at least two teeth";
  EXPECT_EQ(profile_points(RoofShape::sawtooth, 22).size(), 8u);
  EXPECT_EQ(profile_points(RoofShape::sawtooth, 23).size(), 10u);
  EXPECT_TRUE(profile_points(RoofShape::hipped, 20).empty());
  for (const RoofShape shape : kShapes) {
    const auto points = profile_points(shape, 17);
    EXPECT_EQ(points.front().at, 0);
    EXPECT_EQ(points.back().at, 1);
    for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LE(points[i - 1].at, points[i].at);
  }
}

TEST(ProfileRoof, FacesOnARectangle) {
  const Polygon rectangle = plans().at("rectangle");  // 20 m by 10 m
  const Point2 east{1, 0};
  using Counts = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(face_counts(*built(rectangle, RoofShape::skillion, east)), Counts(1, 0));
  EXPECT_EQ(face_counts(*built(rectangle, RoofShape::butterfly, east)), Counts(2, 0));
  EXPECT_EQ(face_counts(*built(rectangle, RoofShape::gabled_height_moved, east)), Counts(2, 1));
  EXPECT_EQ(face_counts(*built(rectangle, RoofShape::sawtooth, east)), Counts(4, 3));
}

TEST(ProfileRoof, SawtoothStandsUprightTowardsTheLowerSide) {
  const Polygon rectangle = plans().at("rectangle");
  const auto roof = built(rectangle, RoofShape::sawtooth, {0, 1});  // two teeth of 5 m
  ASSERT_TRUE(roof);
  const auto upright =
      std::find_if(roof->surfaces.begin(), roof->surfaces.end(), [](const auto& s) { return s.upright; });
  ASSERT_NE(upright, roof->surfaces.end());
  // From outside, that is from the north, the west is on the right.
  EXPECT_EQ(upright->loops[0], (std::vector<Point3>{{20, 5, 36}, {0, 5, 36}, {0, 5, 40}, {20, 5, 40}}));
  EXPECT_EQ(roof->wall_tops[0], (std::vector<Point3>{{20, 0, 36}, {0, 0, 36}}));
  EXPECT_EQ(roof->wall_tops[1], (std::vector<Point3>{{20, 10, 40}, {20, 5, 36}, {20, 5, 40}, {20, 0, 36}}));
}

TEST(ProfileRoof, StepAtAReflexCornerSharesItsFootWithTheHigherWall) {
  // The step of gabled_height_moved meets the inner corner of an L: the upright piece stands on one wall's edge.
  const Polygon plan = polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 16}, {0, 16}});
  const auto roof = built(plan, RoofShape::gabled_height_moved, {0, 1}, {36, 5});
  ASSERT_TRUE(roof);
  EXPECT_EQ(face_counts(*roof), (std::pair<std::size_t, std::size_t>(2, 1)));
  EXPECT_EQ(validity(plan, *roof), "none");
  EXPECT_EQ(roof->wall_tops[2], (std::vector<Point3>{{8, 8, 39.5}, {20, 8, 39.5}}));
  EXPECT_EQ(roof->wall_tops[3], (std::vector<Point3>{{8, 16, 37.5}, {8, 8, 41}, {8, 8, 39.5}}));
}

TEST(ProfileRoof, RefusesPlansTooNarrowForItsLines) {
  const Polygon narrow = polygon({{0, 0}, {5, 0}, {5, 0.19}, {0, 0.19}});
  EXPECT_TRUE(built(narrow, RoofShape::skillion, {0, 1}));
  EXPECT_FALSE(built(narrow, RoofShape::sawtooth, {0, 1}));
  EXPECT_FALSE(built(plans().at("rectangle"), RoofShape::butterfly, {0, 1}, {36, 0}));
}

TEST(ProfileRoof, EveryPlanClosesAtEveryAngle) {
  int folds = 0, all = 0;
  for (const auto& [name, plan] : plans())
    for (const double turn : kAngles)
      for (const Point2 place : kPlaces)
        for (const double direction : {turn, turn + 90, turn + 180, turn + 270, turn + 20, 0.0, 312.5})
          for (const RoofShape shape : kShapes) {
            const Polygon p = moved(plan, turn, place);
            const double radians = direction * M_PI / 180;
            const auto roof = built(p, shape, {std::cos(radians), std::sin(radians)});
            const std::string what = name + ", " + std::string(model::name(shape)) + ", turned " +
                                     std::to_string(turn) + ", up " + std::to_string(direction);
            ASSERT_TRUE(roof) << what;
            // A line that meets a circle of 100 corners next to one of them leaves a triangle that rounding turns.
            const std::string said = validity(p, *roof);
            ++all;
            if (said.starts_with("204") && name == "circle of 100 corners")
              ++folds;
            else
              EXPECT_EQ(said, "none") << what;
            EXPECT_NEAR(covered_area(*roof), geometry::area(p), 0.1) << what;
            EXPECT_NEAR(highest(*roof), 40, 1e-9) << what;
          }
  EXPECT_LE(folds, all / 1000);
}

TEST(ProfileRoof, RandomPlansClose) {
  Random random(20);
  int none = 0, invalid = 0, rounds = 2000;
  if (const char* text = std::getenv("BLOCKRAND_ROUNDS")) rounds = std::atoi(text);
  for (int round = 0; round < rounds; ++round) {
    const Polygon plan = random_plan(random);
    const double height = 0.5 + 6 * random.unit(), radians = 2 * M_PI * random.unit();
    // Half of them along an edge, where edges and corners come to lie on lines.
    Point2 up{std::cos(radians), std::sin(radians)};
    if (random.next(2) == 0) {
      const Point2 a = plan.outer.points[0], b = plan.outer.points[1];
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      up = {(b.x - a.x) / length, (b.y - a.y) / length};
    }
    if (random.next(2) == 0) up = {-up.y, up.x};
    for (const RoofShape shape : kShapes) {
      const auto roof = built(plan, shape, up, {36, height});
      if (!roof) {
        ++none;
        continue;
      }
      const std::string found = validity(plan, *roof);
      if (found != "none") {
        ++invalid;
        std::cout << round << ' ' << model::name(shape) << ": " << found << '\n';
      }
      EXPECT_NEAR(covered_area(*roof), geometry::area(plan), 0.2) << round;
      EXPECT_NEAR(highest(*roof), 36 + height, 1e-9) << round;
    }
  }
  std::cout << "refused " << none << ", invalid " << invalid << " of " << 4 * rounds << '\n';
  EXPECT_EQ(invalid, 0);
  EXPECT_LT(none, 4 * rounds / 1000);
}

}  // namespace
}  // namespace blockrand::roofs
