#include "pipeline/context/block_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {
namespace {

using model::OsmType;
using model::Point2;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr Point2 kPlace{391000, 5820000};

NetworkLine street(std::int64_t way, std::vector<Point2> points) {
  NetworkLine line;
  line.id = {OsmType::way, way};
  line.kind = LineClass::residential;
  for (const Point2 p : points) {
    line.points.push_back({kPlace.x + p.x, kPlace.y + p.y});
    line.nodes.push_back(static_cast<std::int64_t>(p.x) * 10000 + static_cast<std::int64_t>(p.y) + 1);
  }
  return line;
}

/// A block of 120 by 100 m, and one of the same size east of it.
std::vector<NetworkLine> two_blocks() {
  return {street(1, {{0, 0}, {120, 0}, {240, 0}, {240, 100}, {120, 100}, {0, 100}, {0, 0}}),
          street(2, {{120, 0}, {120, 100}})};
}

Footprint house(std::int64_t id, double x, double y, double width, double height, std::optional<double> storeys = {}) {
  Footprint f;
  f.id = {OsmType::way, id};
  for (const Point2 p : {Point2{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}})
    f.polygon.outer.points.push_back({kPlace.x + p.x, kPlace.y + p.y});
  f.polygon.outer.nodes.assign(4, 0);
  f.storeys = storeys;
  return f;
}

/// Wings along all four streets, 10 m behind their centre lines, 12 m deep.
std::vector<Footprint> perimeter_block() {
  return {house(11, 10, 10, 100, 12, 4), house(12, 98, 22, 12, 56, 5), house(13, 10, 78, 100, 12, 4),
          house(14, 10, 22, 12, 56)};
}

BlockFigures first_block(const std::vector<Footprint>& houses) {
  const auto lines = two_blocks();
  return measure_blocks(find_blocks(lines, {}), houses, lines)[0];
}

TEST(BlockFigures, OfAPerimeterBlock) {
  const BlockFigures f = first_block(perimeter_block());
  EXPECT_THAT(f.buildings, ElementsAre(0, 1, 2, 3));
  EXPECT_DOUBLE_EQ(f.built_area, 2 * 1200 + 2 * 672);
  EXPECT_DOUBLE_EQ(*f.built_share, 3744.0 / 12000);
  EXPECT_DOUBLE_EQ(*f.tagged_share, 3072.0 / 3744);
  EXPECT_DOUBLE_EQ(f.floor_area, 2400 * 4 + 672 * 5);
  EXPECT_DOUBLE_EQ(*f.floor_area_ratio, 3744.0 / 12000 * (2400 * 4 + 672 * 5) / 3072);
  EXPECT_DOUBLE_EQ(*f.closure, 1) << "corners are not gaps";
  EXPECT_NEAR(f.front_length, 2 * (100 + 80), 8) << "along the building lines";
  ASSERT_EQ(f.courtyards.size(), 1u);
  EXPECT_TRUE(f.courtyards[0].closed);
  EXPECT_DOUBLE_EQ(f.courtyard_area, 76 * 56);
}

TEST(BlockFigures, ClosureFallsWithGapsAndHousesBehindDoNotFillThem) {
  auto houses = perimeter_block();
  houses.erase(houses.begin() + 2);  // the north
  // The ends of the wings, 22 m from the street, are all that stands there: 24 of 100 m.
  EXPECT_NEAR(*first_block(houses).closure, (100 + 2 * 68 + 24) / (100 + 2 * 68 + 100.0), 0.01);
  houses = perimeter_block();
  houses[0] = house(11, 10, 10, 60, 12, 4);
  // The front has a gap of 40 m in the south, and of 12 m in the east, where the southern wing was.
  EXPECT_NEAR(*first_block(houses).closure, 1 - 52.0 / 360, 0.01);
  houses.push_back(house(20, 70, 22, 28, 10));
  EXPECT_NEAR(*first_block(houses).closure, 1 - 52.0 / 360, 0.01) << "12 m behind the front";
  houses.back() = house(20, 70, 14, 28, 10);
  EXPECT_NEAR(*first_block(houses).closure, 1 - 24.0 / 360, 0.01) << "4 m behind the front: a front garden";
}

TEST(BlockFigures, OnlyStreetsHaveAFront) {
  for (const LineClass water : {LineClass::waterway, LineClass::shore, LineClass::railway, LineClass::coastline}) {
    // South, east and north are streets with houses; in the west nothing stands for 70 m.
    std::vector<NetworkLine> lines{street(1, {{0, 0}, {120, 0}, {120, 100}, {0, 100}}), street(2, {{0, 100}, {0, 0}})};
    auto houses = perimeter_block();
    houses.pop_back();
    houses[0] = house(11, 20, 10, 90, 12, 4);
    houses[2] = house(13, 20, 78, 90, 12, 4);
    ASSERT_LT(*measure_blocks(find_blocks(lines, {}), houses, lines)[0].closure, 0.9) << "an open street";
    lines[1].kind = water;
    const BlockFigures f = measure_blocks(find_blocks(lines, {}), houses, lines)[0];
    EXPECT_DOUBLE_EQ(*f.closure, 1);
    EXPECT_NEAR(f.front_length, 90 + 80 + 90, 8);
    lines[0].kind = water;
    EXPECT_FALSE(measure_blocks(find_blocks(lines, {}), houses, lines)[0].closure) << "no street, no front";
  }
}

TEST(BlockFigures, AStraightSideOfRiverAndStreetHasItsFrontAtTheStreet) {
  std::vector<NetworkLine> lines{street(1, {{60, 0}, {120, 0}, {120, 100}, {0, 100}, {0, 0}}),
                                 street(2, {{0, 0}, {60, 0}})};
  lines[1].kind = LineClass::waterway;
  // At the river houses stand 2 m from its line, at the street 12 m: the line of the street's front is its own.
  const std::vector<Footprint> houses{house(11, 0, 2, 60, 12), house(12, 60, 12, 50, 12)};
  const BlockFigures f = measure_blocks(find_blocks(lines, {}), houses, lines)[0];
  // South 50 m, up to the building line in the east; 12 m of the east and 2 m of the west.
  EXPECT_NEAR(*f.closure * f.front_length, 50 + 12 + 2, 3);
}

TEST(BlockFigures, SquaresHaveAFront) {
  std::vector<NetworkLine> lines{street(1, {{0, 0}, {120, 0}, {120, 100}, {0, 100}}), street(2, {{0, 100}, {0, 0}})};
  lines[1] = street(2, {{0, 0}, {0, 100}, {-60, 100}, {-60, 0}, {0, 0}});
  lines[1].kind = LineClass::pedestrian;
  lines[1].area = true;
  const auto blocks = find_blocks(lines, {});
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (blocks[b].kind == BlockKind::ordinary) {
      EXPECT_NEAR(measure_blocks(blocks, perimeter_block(), lines)[b].front_length, 2 * (100 + 80), 8);
    }
}

TEST(BlockFigures, RowsAcrossTheStreetLeaveItOpen) {
  std::vector<Footprint> rows;
  for (int i = 0; i < 4; ++i) rows.push_back(house(30 + i, 15 + i * 27.0, 15, 9, 70));
  const double closure = *first_block(rows).closure;
  EXPECT_GT(closure, 0.3);
  EXPECT_LT(closure, 0.7);
}

TEST(BlockFigures, NothingBuiltIsOpenAndHasNoStoreys) {
  const BlockFigures f = first_block({});
  EXPECT_EQ(*f.built_share, 0);
  EXPECT_EQ(*f.closure, 0);
  EXPECT_FALSE(f.tagged_share || f.floor_area_ratio);
  EXPECT_THAT(f.courtyards, IsEmpty());
}

TEST(BlockFigures, AHouseAcrossAStreetBelongsWhereMostOfItIs) {
  const auto lines = two_blocks();
  const auto figures = measure_blocks(find_blocks(lines, {}),
                                      std::vector{house(1, 105, 40, 20, 10, 3), house(2, 300, 0, 10, 10)}, lines);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_THAT(figures[0].buildings, ElementsAre(0));
  EXPECT_THAT(figures[1].buildings, IsEmpty()) << "and the one beyond all blocks to none";
  EXPECT_NEAR(figures[0].built_area, 150, 1e-6);
  EXPECT_NEAR(figures[1].built_area, 50, 1e-6) << "each block counts what stands in it";
}

TEST(BlockFigures, AHouseOfTwoPolygonsBelongsToOneBlock) {
  const auto lines = two_blocks();
  const auto blocks = find_blocks(lines, {});
  // Of 300 m2 two thirds in the west; in the next, half in each: none holds more than half.
  auto figures = measure_blocks(blocks, std::vector{house(1, 40, 40, 20, 10), house(1, 140, 40, 10, 10)}, lines);
  EXPECT_THAT(figures[0].buildings, ElementsAre(0, 1));
  EXPECT_THAT(figures[1].buildings, IsEmpty());
  EXPECT_NEAR(figures[0].built_area, 200, 1e-6);
  EXPECT_NEAR(figures[1].built_area, 100, 1e-6) << "each block counts what stands in it";
  figures = measure_blocks(blocks, std::vector{house(1, 40, 40, 10, 10), house(1, 140, 40, 10, 10)}, lines);
  EXPECT_THAT(figures[0].buildings, IsEmpty());
  EXPECT_THAT(figures[1].buildings, IsEmpty());
}

TEST(BlockFigures, ACourtyardBelongsWhereItsWallsStand) {
  // The ring stands in the east, most of its building in the west.
  Footprint ring = house(1, 140, 30, 40, 40);
  ring.polygon.holes.push_back(house(9, 150, 40, 10, 10).polygon.outer);
  std::reverse(ring.polygon.holes[0].points.begin(), ring.polygon.holes[0].points.end());
  const auto lines = two_blocks();
  const auto figures = measure_blocks(find_blocks(lines, {}), std::vector{house(1, 20, 15, 60, 70), ring}, lines);
  EXPECT_THAT(figures[0].buildings, ElementsAre(0, 1));
  EXPECT_THAT(figures[0].courtyards, IsEmpty());
  EXPECT_EQ(figures[1].courtyards.size(), 1u);
}

TEST(BlockFigures, WallsOnTheOutlineAreTheFront) {
  // The outline of a square runs along the wall.
  const auto lines = std::vector{street(1, {{0, 0}, {60, 0}, {60, 60}, {0, 60}, {0, 0}})};
  const auto f = measure_blocks(find_blocks(lines, {}), std::vector{house(1, 0, 0, 60, 60)}, lines)[0];
  EXPECT_EQ(*f.closure, 1);
  EXPECT_EQ(*f.built_share, 1);
}

TEST(BlockFigures, BlocksWithoutRatiosHaveNone) {
  const auto lines = two_blocks();
  auto blocks = find_blocks(lines, {}, {.max_extent = 119});
  const auto f = measure_blocks(blocks, perimeter_block(), lines)[0];
  EXPECT_FALSE(f.built_share || f.closure || f.floor_area_ratio || f.tagged_share);
  EXPECT_EQ(f.buildings.size(), 4u);
}

TEST(BlockFigures, OrderOfFootprintsAndOtherBlocksDoNotMatter) {
  std::mt19937 random(2);
  const auto draw = [&](double from, double to) { return model::snap(from + (to - from) * (random() / 4294967296.0)); };
  std::vector<Footprint> houses;
  for (int x = 0; x < 11; ++x)
    for (int y = 0; y < 5; ++y)
      houses.push_back(
          house(x * 10 + y, 5 + x * 20 + draw(0, 5), 5 + y * 19 + draw(0, 5), draw(6, 15), draw(6, 14), draw(1, 6)));
  const auto lines = two_blocks();
  const auto blocks = find_blocks(lines, {});
  const auto figures = measure_blocks(blocks, houses, lines);
  std::shuffle(houses.begin(), houses.end(), random);
  const auto again = measure_blocks(blocks, houses, lines);
  const auto alone = measure_blocks(std::span(blocks).subspan(1, 1), houses, lines);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_GT(figures[b].buildings.size(), 20u);
    EXPECT_EQ(figures[b].built_area, again[b].built_area) << "to the last bit";
    EXPECT_EQ(figures[b].floor_area_ratio, again[b].floor_area_ratio);
    EXPECT_EQ(figures[b].closure, again[b].closure);
    EXPECT_EQ(figures[b].courtyard_area, again[b].courtyard_area);
  }
  EXPECT_EQ(figures[1].built_area, alone[0].built_area);
  EXPECT_EQ(figures[1].closure, alone[0].closure);
}

}  // namespace
}  // namespace blockrand::context
