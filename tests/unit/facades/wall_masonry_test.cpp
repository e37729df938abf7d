#include "pipeline/facades/wall_masonry.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace blockrand::facades {
namespace {

using masonry::Bond;
using Values = std::vector<std::pair<std::string, grammar::Value>>;

WallFrame wall_of(double length, double height) {
  WallFrame wall;
  wall.along = {1, 0};
  wall.length = length, wall.height = height;
  wall.loops = {{{0, 0}, {length, 0}, {length, height}, {0, height}}};
  return wall;
}

const MasonryLook kLook{{1, {165, 87, 63}}, {2, {200, 190, 180}}, {1, {140, 70, 50}}};

TEST(MasonryOrders, NoneAreGivenUnlessTheyAreAskedFor) {
  std::vector<std::string> complaints;
  EXPECT_FALSE(read_masonry_orders(Values{}, complaints));
  EXPECT_FALSE(read_masonry_orders(Values{{"masonry_bond", "english"}}, complaints));
  EXPECT_FALSE(read_masonry_orders(Values{{"masonry", "none"}}, complaints));
  EXPECT_TRUE(complaints.empty());
}

TEST(MasonryOrders, TheFirstOfANameCounts) {
  std::vector<std::string> complaints;
  const auto orders = read_masonry_orders(Values{{"masonry", "fitted"},
                                                 {"masonry_bond", "flemish"},
                                                 {"masonry_bond", "ashlar"},
                                                 {"masonry_joint", 0.014},
                                                 {"masonry_relief", "0.012"},
                                                 {"masonry_colour", "#a0b0c0"}},
                                          complaints);
  ASSERT_TRUE(orders);
  EXPECT_EQ(orders->bond, Bond::flemish);
  EXPECT_EQ(orders->joint, 0.014);
  EXPECT_EQ(orders->relief, 0.012);
  EXPECT_EQ(orders->colour->g, 0xb0);
  EXPECT_TRUE(complaints.empty());
}

TEST(MasonryOrders, UnknownWordsAndNumbersOutOfRangeAreTold) {
  std::vector<std::string> complaints;
  const auto orders = read_masonry_orders(Values{{"masonry", "fitted"},
                                                 {"masonry_bond", "monk"},
                                                 {"masonry_joint", "wide"},
                                                 {"masonry_height", "9"},
                                                 {"masonry_colour", "red"}},
                                          complaints);
  ASSERT_TRUE(orders);
  EXPECT_FALSE(orders->bond || orders->joint || orders->height || orders->colour);
  ASSERT_EQ(complaints.size(), 4u);
  EXPECT_NE(complaints[0].find("cyclopean"), std::string::npos) << complaints[0];  // what is known
  complaints.clear();
  EXPECT_FALSE(read_masonry_orders(Values{{"masonry", "fited"}}, complaints));
  EXPECT_EQ(complaints.size(), 1u);
}

TEST(MasonryOrders, FormatsGiveSizesAndStonesThatCannotBeLaidAreTold) {
  std::vector<std::string> complaints;
  MasonryOrders orders;
  orders.format = "reich";
  EXPECT_EQ(masonry_of(orders, Bond::english, complaints).length, 0.25);
  orders.length = 0.1, orders.joint = 0.05;
  EXPECT_EQ(masonry_of(orders, Bond::english, complaints).length, 0.25);
  EXPECT_EQ(complaints.size(), 1u);
}

TEST(MasonryOrders, EveryParameterIsKnownByName) {
  for (const std::string_view name : masonry_parameters()) EXPECT_TRUE(is_masonry_parameter(name));
  EXPECT_FALSE(is_masonry_parameter("masonry_bonds"));
}

TEST(WallMasonry, BodiesStandBeforeTheWallAndMortarLiesUnderThem) {
  const std::vector<std::vector<model::Point2>> openings{{{1, 1}, {2, 1}, {2, 2}, {1, 2}}};
  const MasonryRun run{0, 0, 5, 0, 90, 0, 7};
  const WallMasonry made =
      wall_masonry(run, wall_of(5, 3), masonry::usual_masonry(Bond::english), 100000, kLook, openings, {});
  ASSERT_EQ(made.bodies.size(), 5u);  // mortar, three shades, dressings
  EXPECT_EQ(made.bodies[0].element.name, "mortar");
  EXPECT_EQ(made.bodies[0].look, kLook.mortar);
  EXPECT_TRUE(made.told.empty());
  for (const MasonryBody& body : made.bodies) {
    EXPECT_EQ(body.element.kind, kMasonry);
    EXPECT_TRUE(body.element.opening.outline.empty());
    for (const model::Point3& v : body.element.mesh.vertices) {
      EXPECT_GE(v.z, 0.005);
      EXPECT_LE(v.z, 0.03);
      EXPECT_GE(v.x, -0.03);
      EXPECT_LE(v.x, 5.001);
    }
  }
}

TEST(WallMasonry, FallBacksAreTold) {
  const MasonryRun run{0, 0, 5, 0, 0, 0, 7};
  const WallFrame wall = wall_of(5, 3);
  const masonry::Masonry bricks = masonry::usual_masonry(Bond::stretcher);
  const auto told = [&](std::size_t most) { return wall_masonry(run, wall, bricks, most, kLook, {}, {}); };
  EXPECT_TRUE(told(100000).told.empty());
  ASSERT_EQ(told(3000).told.size(), 1u);
  EXPECT_NE(told(3000).told[0].find("no sides"), std::string::npos);
  ASSERT_EQ(told(100).told.size(), 1u);
  EXPECT_NE(told(100).told[0].find("left bare"), std::string::npos);
  EXPECT_TRUE(told(100).bodies.empty());
}

}  // namespace
}  // namespace blockrand::facades
