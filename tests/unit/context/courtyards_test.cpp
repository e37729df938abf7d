#include "pipeline/context/courtyards.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {
namespace {

using model::Point2;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr Point2 kPlace{391000, 5820000};

Footprint house(std::int64_t id, std::vector<Point2> outer, std::vector<Point2> hole = {}) {
  Footprint f;
  f.id = {model::OsmType::way, id};
  const auto put = [](const std::vector<Point2>& points) {
    model::Ring ring;
    for (const Point2 p : points) ring.points.push_back(model::snap(Point2{kPlace.x + p.x, kPlace.y + p.y}));
    ring.nodes.assign(points.size(), 0);
    return ring;
  };
  f.polygon.outer = put(outer);
  if (!hole.empty()) f.polygon.holes.push_back(put(hole));
  return f;
}

std::vector<Point2> box(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

/// Four wings around a yard of 30 by 20 m; the eastern one begins `gap` metres behind the southern.
std::vector<Footprint> four_wings(double gap) {
  return {house(1, box(0, 0, 50, 10)), house(2, box(40, 10 + gap, 10, 20 - gap)), house(3, box(0, 30, 50, 10)),
          house(4, box(0, 10, 10, 20))};
}

TEST(Courtyards, ClosedBetweenFourWings) {
  const auto yards = find_courtyards(four_wings(0));
  ASSERT_THAT(yards, SizeIs(1));
  EXPECT_TRUE(yards[0].closed);
  EXPECT_DOUBLE_EQ(yards[0].area, 600);
  EXPECT_EQ(yards[0].opening, 0);
  EXPECT_THAT(yards[0].buildings, ElementsAre(0, 1, 2, 3));
}

TEST(Courtyards, OpenThroughAGapAndNoneBehindAWideOne) {
  const auto yards = find_courtyards(four_wings(4));
  ASSERT_THAT(yards, SizeIs(1));
  EXPECT_FALSE(yards[0].closed);
  EXPECT_NEAR(yards[0].opening, 4, 0.01);
  EXPECT_NEAR(yards[0].area, 640, 0.1) << "with the gap, up to the outer corners";
  EXPECT_THAT(find_courtyards(four_wings(9.5)), IsEmpty());
  EXPECT_THAT(find_courtyards(four_wings(9.5), {}, {.max_opening = 10}), SizeIs(1));
}

TEST(Courtyards, OfOneBuildingByAHoleOrBetweenItsWings) {
  const auto ring = find_courtyards(std::vector{house(1, box(0, 0, 40, 40), box(10, 10, 20, 20))});
  ASSERT_THAT(ring, SizeIs(1));
  EXPECT_TRUE(ring[0].closed);
  EXPECT_DOUBLE_EQ(ring[0].area, 400);
  const auto u = find_courtyards(
      std::vector{house(1, {{0, 0}, {28, 0}, {28, 30}, {18, 30}, {18, 10}, {10, 10}, {10, 30}, {0, 30}})});
  ASSERT_THAT(u, SizeIs(1)) << "8 m wide, 20 m deep";
  EXPECT_FALSE(u[0].closed);
  EXPECT_DOUBLE_EQ(u[0].area, 160);
  EXPECT_DOUBLE_EQ(u[0].opening, 8);
  EXPECT_THAT(find_courtyards(
                  std::vector{house(1, {{0, 0}, {28, 0}, {28, 14}, {18, 14}, {18, 10}, {10, 10}, {10, 14}, {0, 14}})}),
              IsEmpty())
      << "a recess of the facade, 4 m deep";
}

TEST(Courtyards, AHouseThatStandsFreeInTheYardIsAHole) {
  auto houses = four_wings(0);
  houses.push_back(house(5, box(22, 18, 6, 5)));
  const auto yards = find_courtyards(houses);
  ASSERT_THAT(yards, SizeIs(1)) << "lines between the house and the wings do not divide the yard";
  EXPECT_TRUE(yards[0].closed);
  EXPECT_DOUBLE_EQ(yards[0].area, 570);
  EXPECT_THAT(yards[0].polygon.holes, SizeIs(1));
  EXPECT_THAT(yards[0].buildings, ElementsAre(0, 1, 2, 3, 4));
}

TEST(Courtyards, AlleysAndGapsBetweenWallsAreNone) {
  EXPECT_THAT(find_courtyards(
                  std::vector{house(1, box(0, 0, 10, 12)), house(2, box(12, 0, 10, 12)), house(3, box(27, 0, 10, 12))}),
              IsEmpty());
  // Walls that miss each other by 5 cm enclose a sliver.
  EXPECT_THAT(find_courtyards(std::vector{house(1, {{0, 0}, {10, 0}, {10, 20}, {0, 20}}),
                                          house(2, {{10, 0}, {20, 0}, {20, 20}, {10, 20}, {10.05, 10}})}),
              IsEmpty());
  EXPECT_THAT(find_courtyards({}), IsEmpty());
}

TEST(Courtyards, WhereAStreetLeadsInItIsStreetSpace) {
  const std::vector<Polyline> street{{{kPlace.x + 60, kPlace.y + 12}, {kPlace.x + 30, kPlace.y + 12}}};
  EXPECT_THAT(find_courtyards(four_wings(4), street), IsEmpty());
  EXPECT_THAT(find_courtyards(four_wings(0), street), SizeIs(1)) << "a closed yard stays one";
}

TEST(Courtyards, OrderAndRingsOfTheBuildingsDoNotMatter) {
  std::mt19937 random(9);
  std::vector<Footprint> houses;
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 12; ++y)
      if (random() % 4)
        houses.push_back(house(x * 100 + y, box(x * 10, y * 10, random() % 3 ? 10 : 7, random() % 3 ? 10 : 5)));
  const auto yards = find_courtyards(houses);
  ASSERT_GT(yards.size(), 5u);
  auto other = houses;
  std::shuffle(other.begin(), other.end(), random);
  for (Footprint& f : other) {
    std::rotate(f.polygon.outer.points.begin(), f.polygon.outer.points.begin() + random() % 4,
                f.polygon.outer.points.end());
    if (random() % 2) std::reverse(f.polygon.outer.points.begin(), f.polygon.outer.points.end());
  }
  const auto again = find_courtyards(other);
  ASSERT_EQ(again.size(), yards.size());
  for (std::size_t i = 0; i < yards.size(); ++i) {
    EXPECT_EQ(again[i].polygon.outer.points, yards[i].polygon.outer.points);
    EXPECT_EQ(again[i].closed, yards[i].closed);
    EXPECT_EQ(again[i].opening, yards[i].opening);
    std::vector<std::int64_t> a, b;
    for (const auto k : yards[i].buildings) a.push_back(houses[k].id.number);
    for (const auto k : again[i].buildings) b.push_back(other[k].id.number);
    std::sort(b.begin(), b.end());
    std::sort(a.begin(), a.end());
    EXPECT_EQ(a, b);
  }
}

TEST(Courtyards, AreCoveredByNoBuilding) {
  std::mt19937 random(4);
  std::vector<Footprint> houses;
  double built = 0;
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y)
      if (random() % 3) {
        houses.push_back(house(x * 100 + y, box(x * 10, y * 10, 10, 10)));
        built += 100;
      }
  houses.push_back(house(5000, box(-10, -10, 120, 120), box(0, 0, 100, 100)));
  double open = 0;
  for (const Courtyard& yard : find_courtyards(houses)) {
    EXPECT_TRUE(yard.closed);
    open += yard.area;
  }
  EXPECT_DOUBLE_EQ(open + built, 10000) << "what is not built inside the ring is courtyard";
}

}  // namespace
}  // namespace blockrand::context
