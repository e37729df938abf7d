#include "pipeline/context/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace blockrand::context {
namespace {

using model::Point2;

CellBuilding house(Point2 place, double area, std::optional<double> storeys = {}, std::optional<int> year = {}) {
  CellBuilding b;
  b.place = place;
  b.area = area;
  b.storeys = storeys;
  b.year = year;
  return b;
}

TEST(Cells, LieOnTheGridOfTheCrs) {
  EXPECT_EQ(cell_of({0, 0}), (CellIndex{0, 0}));
  EXPECT_EQ(cell_of({249.999, 250}), (CellIndex{0, 1})) << "a cell owns its southern edge";
  EXPECT_EQ(cell_of({-0.001, -250}), (CellIndex{-1, -1}));
  EXPECT_EQ(cell_of({391010, 5820130}).id(), "c1564_23280");
  EXPECT_EQ(cell_of({391010, 5820130}).corner(), (Point2{391000, 5820000}));
}

TEST(Cells, PlaceOfABuildingDoesNotDependOnItsRing) {
  model::Polygon p;
  p.outer.points = {{390999.7, 5819990}, {391010.3, 5819991}, {391008.1, 5820009.2}, {390991.4, 5820010.9}};
  const Point2 place = cell_place(p);
  for (int turn = 0; turn < 4; ++turn) {
    std::rotate(p.outer.points.begin(), p.outer.points.begin() + 1, p.outer.points.end());
    EXPECT_EQ(cell_place(p), place);
    std::reverse(p.outer.points.begin(), p.outer.points.end());
    EXPECT_EQ(cell_place(p), place);
  }
}

TEST(Cells, FiguresOfAFewHouses) {
  std::vector<CellBuilding> houses{house({10, 10}, 200, 4, 1890), house({20, 10}, 200, 6, 1910), house({30, 10}, 100),
                                   house({300, 10}, 50)};
  houses[0].wall_length = houses[1].wall_length = 60;
  houses[0].party_wall_length = houses[1].party_wall_length = 15;
  const Cells cells = cells_of(houses);
  ASSERT_EQ(cells.size(), 2u);
  const CellFigures f = figures_of(cells.begin()->second);
  EXPECT_EQ(f.buildings, 3);
  EXPECT_DOUBLE_EQ(*f.density, 3 / 6.25);
  EXPECT_DOUBLE_EQ(*f.built_share, 500.0 / 62500);
  EXPECT_DOUBLE_EQ(f.tagged_share, 2.0 / 3);
  EXPECT_DOUBLE_EQ(*f.storeys_mean, 5);
  EXPECT_DOUBLE_EQ(*f.storeys_spread, 1);
  EXPECT_DOUBLE_EQ(*f.floor_area_ratio, 5 * 500.0 / 62500) << "as if the untagged had the mean of the tagged";
  EXPECT_DOUBLE_EQ(*f.party_wall_share, 0.25);
  EXPECT_DOUBLE_EQ(*f.year_mean, 1900);
  EXPECT_DOUBLE_EQ(*f.year_spread, 10);
  const CellFigures other = figures_of(cells.rbegin()->second);
  EXPECT_FALSE(other.storeys_mean || other.floor_area_ratio || other.year_mean || other.party_wall_share)
      << "nobody told";
}

TEST(Cells, QuantilesFromBins) {
  std::vector<CellBuilding> houses;
  for (int i = 0; i < 100; ++i) houses.push_back(house({1, 1}, 100 + 0.25 * i));  // all in the bin from 100 to 125
  const CellFigures f = figures_of(cells_of(houses).begin()->second);
  EXPECT_DOUBLE_EQ(*f.footprint_quartile, 106.25);
  EXPECT_DOUBLE_EQ(*f.footprint_median, 112.5);
  EXPECT_DOUBLE_EQ(*f.footprint_upper_quartile, 118.75);
  const CellFigures hall = figures_of(cells_of(std::vector{house({1, 1}, 50000)}).begin()->second);
  EXPECT_DOUBLE_EQ(*hall.footprint_median, 10000) << "the last bin has no upper bound";
}

TEST(Cells, KnowHowMuchOfThemTheDataCovers) {
  const CellIndex cell{0, 0};
  const std::vector<Point2> all{{-10, -10}, {300, -10}, {300, 300}, {-10, 300}};
  EXPECT_DOUBLE_EQ(covered_share(cell, all), 1);
  EXPECT_DOUBLE_EQ(covered_share(cell, std::vector<Point2>{{0, 0}, {250, 0}, {0, 250}}), 0.5);
  EXPECT_DOUBLE_EQ(covered_share(cell, std::vector<Point2>{{-100, -100}, {100, -100}, {100, 400}, {-100, 400}}), 0.4);
  EXPECT_DOUBLE_EQ(covered_share(cell, std::vector<Point2>{{50, 50}, {150, 50}, {150, 150}, {50, 150}}), 0.16)
      << "within";
  EXPECT_DOUBLE_EQ(covered_share({1, 1}, std::vector<Point2>{{0, 0}, {250, 0}, {0, 250}}), 0);
  EXPECT_DOUBLE_EQ(covered_share(cell, {}), 0);
}

TEST(Cells, GiveNoRatiosOfTheirAreaWhereTheDataEnds) {
  const std::vector<CellBuilding> houses{house({10, 10}, 200, 4, 1890)};
  const CellSums sums = cells_of(houses).begin()->second;
  const CellFigures whole = figures_of(sums, 0.95), cut = figures_of(sums, 0.94);
  EXPECT_TRUE(whole.density && whole.built_share && whole.floor_area_ratio);
  EXPECT_FALSE(cut.density || cut.built_share || cut.floor_area_ratio);
  EXPECT_EQ(cut.storeys_mean, whole.storeys_mean) << "the houses that are there tell the same";
  EXPECT_EQ(cut.covered_share, 0.94);
}

TEST(Cells, OrderOfBuildingsDoesNotMatter) {
  std::mt19937 random(3);
  const auto draw = [&](double to) { return to * (random() / 4294967296.0); };
  std::vector<CellBuilding> houses;
  for (int i = 0; i < 500; ++i) {
    CellBuilding b = house({391000 + draw(900), 5820000 + draw(900)}, draw(700) + 0.1);
    b.wall_length = draw(100) + 1;
    b.party_wall_length = b.wall_length * draw(1);
    if (random() % 2) b.storeys = 0.5 * static_cast<double>(random() % 15);
    if (random() % 3 == 0) b.year = 1700 + static_cast<int>(random() % 320);
    houses.push_back(b);
  }
  const Cells whole = cells_of(houses);
  std::shuffle(houses.begin(), houses.end(), random);
  EXPECT_EQ(cells_of(houses), whole);
  EXPECT_EQ(whole.size(), 16u);
}

}  // namespace
}  // namespace blockrand::context
