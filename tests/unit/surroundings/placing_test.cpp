#include "pipeline/surroundings/placing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace blockrand::surroundings {
namespace {

using model::Point2;

const Catalogue& catalogue() {
  static const Catalogue read(std::string(BLOCKRAND_SOURCE_DIR) + "/configs/surroundings.toml");
  return read;
}

std::string_view untagged(std::string_view) { return {}; }

constexpr model::OsmId kRow{model::OsmType::way, 17};

TEST(RowOfTrees, StandsAtEqualDistancesFromEndToEnd) {
  const std::vector<Point2> line{{0, 0}, {30, 0}, {30, 34}};
  const auto trees = row_of_trees(catalogue(), kRow, line, untagged, 1);
  ASSERT_EQ(trees.size(), 9u);  // 64 m, 8 gaps
  EXPECT_EQ(trees.front().place, line.front());
  EXPECT_EQ(trees.back().place, line.back());
  for (std::size_t i = 1; i < trees.size(); ++i) {
    const Point2 a = trees[i - 1].place, b = trees[i].place;
    EXPECT_NEAR(std::fabs(a.x - b.x) + std::fabs(a.y - b.y), 8, 0.01);  // along the line
    EXPECT_EQ(trees[i].object.shape, trees[0].object.shape) << "a row is of one kind";
  }
}

TEST(RowOfTrees, OfAShortLineHasBothEnds) {
  EXPECT_EQ(row_of_trees(catalogue(), kRow, std::vector<Point2>{{0, 0}, {2, 0}}, untagged, 1).size(), 2u);
  EXPECT_TRUE(row_of_trees(catalogue(), kRow, std::vector<Point2>{{0, 0}, {0, 0}}, untagged, 1).empty());
}

SquareSurface wood(double x0, double x1) {
  SquareSurface out;
  out.plan.emplace_back();
  out.plan[0].outer.points = {{x0, 0}, {x1, 0}, {x1, 125}, {x0, 125}};
  out.borders = {{{{x0, 0}, {x0, 125}}}, {{{x1, 0}, {x1, 125}}}};  // it goes on in the north and the south
  return out;
}

GroundClaims claims_of_a_wood(float density) {
  GroundClaims claims;
  GroundLabel label;
  label.ground = model::GroundClass::wood, label.object = {model::OsmType::way, 4}, label.trees_per_hectare = density;
  claims.labels.push_back(label);
  return claims;
}

std::vector<PlannedObject> scattered(const std::vector<SquareSurface>& surfaces, const std::vector<Point2>& mapped,
                                     float density = 100) {
  return scattered_trees(
      catalogue(), surfaces, claims_of_a_wood(density), mapped, [](model::OsmId) { return TagOf(untagged); }, 1);
}

TEST(ScatteredTrees, AreAsManyAsAskedAndKeepOffTheBorder) {
  const auto trees = scattered({wood(0, 125)}, {});
  EXPECT_NEAR(static_cast<double>(trees.size()), 156, 25);
  for (const PlannedObject& tree : trees) {
    EXPECT_GE(tree.place.x, kBorderDistance - 0.001);
    EXPECT_LE(tree.place.x, 125 - kBorderDistance + 0.001);
  }
}

TEST(ScatteredTrees, StandWhereTheyStandHoweverTheWoodIsCut) {
  SquareSurface west = wood(0, 60);
  west.borders.pop_back();  // the wood goes on in the east
  const auto whole = scattered({wood(0, 125)}, {}), half = scattered({west}, {});
  std::size_t known = 0;
  for (const PlannedObject& tree : half)
    for (const PlannedObject& other : whole) known += tree.place == other.place;
  EXPECT_GT(half.size(), 40u);
  EXPECT_EQ(known, half.size());
}

TEST(ScatteredTrees, StandOnTerrainAsTheyDoOnLevelGround) {
  SquareSurface cut = wood(0, 125);
  cut.plan.clear();
  for (int x = 0; x < 125; x += 5)  // as triangles of a terrain cut it
    cut.plan.emplace_back().outer.points = {
        {static_cast<double>(x), 0}, {x + 5.0, 0}, {x + 5.0, 125}, {static_cast<double>(x), 125}};
  EXPECT_EQ(scattered({cut}, {}).size(), scattered({wood(0, 125)}, {}).size());
}

TEST(ScatteredTrees, KeepOffMappedOnes) {
  const std::vector<Point2> mapped{{60, 60}, {30, 100}};
  for (const PlannedObject& tree : scattered({wood(0, 125)}, mapped, 1000))
    for (const Point2 m : mapped) EXPECT_GE(std::hypot(tree.place.x - m.x, tree.place.y - m.y), 4.99);
}

TEST(ObjectAt, IsTheSameForTheSameObject) {
  const auto first = object_at(catalogue(), "tree", {model::OsmType::node, 5}, {1, 2}, untagged, 1);
  const auto again = object_at(catalogue(), "tree", {model::OsmType::node, 5}, {1, 2}, untagged, 1);
  ASSERT_TRUE(first && again);
  EXPECT_EQ(first->object.shape, again->object.shape);
  EXPECT_EQ(first->object.height, again->object.height);
  EXPECT_FALSE(object_at(catalogue(), "no such kind", {model::OsmType::node, 5}, {1, 2}, untagged, 1));
}

}  // namespace
}  // namespace blockrand::surroundings
