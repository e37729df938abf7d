// Rows that are storeys and columns that are axes.
#include "pipeline/compare/opening_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "tests/unit/compare/facade_scene.h"

namespace blockrand::compare::test {
namespace {

Facade with(std::vector<Hole> holes) {
  Facade facade;
  for (const Hole& h : holes) {
    FacadeOpening o;
    o.left = h.left;
    o.right = h.right;
    o.bottom = h.bottom;
    o.top = h.top;
    o.area = (h.right - h.left) * (h.top - h.bottom);
    o.door = h.door;
    facade.openings.push_back(o);
  }
  find_rows_and_columns(facade, {});
  return facade;
}

std::vector<Hole> plus(std::vector<Hole> holes, const std::vector<Hole>& more) {
  holes.insert(holes.end(), more.begin(), more.end());
  return holes;
}

void expect_grid(const Facade& facade, int storeys, int axes) {
  EXPECT_EQ(facade.storeys, storeys);
  EXPECT_EQ(facade.axes, axes);
}

TEST(OpeningGrid, OfNothingAndOfOne) {
  expect_grid(with({}), 0, 0);
  const Facade one = with({{1, 2, 1, 2.5}});
  expect_grid(one, 1, 1);
  EXPECT_FALSE(one.storey_pitch || one.axis_pitch);
  EXPECT_EQ(one.openings[0].row, 0);
  EXPECT_EQ(one.openings[0].column, 0);
}

TEST(OpeningGrid, OfATowerTakesNoTime) {
  const auto start = std::chrono::steady_clock::now();
  expect_grid(with(grid(100, 60)), 60, 100);
  // Some 0.1 s; each opening against each other, row by row, took 20 s.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(OpeningGrid, CountsFromBelowAndLeft) {
  const Facade f = with(grid(5, 4));
  expect_grid(f, 4, 5);
  for (std::size_t i = 0; i < f.openings.size(); ++i) {
    EXPECT_EQ(f.openings[i].row, static_cast<int>(i) / 5);
    EXPECT_EQ(f.openings[i].column, static_cast<int>(i) % 5);
  }
}

TEST(OpeningGrid, TakesMissingWindowsLightly) {
  auto holes = grid(5, 4);
  holes.erase(holes.begin() + 13);
  holes.erase(holes.begin() + 6);
  expect_grid(with(holes), 4, 5);
}

TEST(OpeningGrid, LeavesStairWindowsBetweenStoreysOut) {
  // The stair in the middle: its windows half a storey higher.
  std::vector<Hole> holes;
  for (const Hole& h : grid(5, 4)) holes.push_back(h.left == 6 ? Hole{6, 7.2, h.bottom + 1.5, h.top + 1.5} : h);
  const Facade f = with(holes);
  EXPECT_EQ(f.storeys, 4);
  EXPECT_NEAR(*f.storey_pitch, 3, 1e-9);
  for (const FacadeOpening& o : f.openings) EXPECT_EQ(o.row == -1, o.left == 6) << o.bottom;
}

TEST(OpeningGrid, DoesNotChainAStairThatClimbs) {
  // Windows that rise by a quarter of a storey each would join all storeys to one row.
  auto holes = grid(4, 4);
  for (int i = 0; i < 12; ++i) holes.push_back({12 + 1.5 * i, 13 + 1.5 * i, 1 + 0.75 * i, 2.5 + 0.75 * i});
  EXPECT_EQ(with(holes).storeys, 4);
}

TEST(OpeningGrid, CountsNoCellarAndNoTransoms) {
  auto holes = grid(5, 3);
  for (Hole& h : holes) {
    h.bottom += 1.2;
    h.top += 1.2;
  }
  std::vector<Hole> cellar, transoms;
  for (int c = 0; c < 5; ++c) {
    cellar.push_back({1.1 + 2.5 * c, 2.0 + 2.5 * c, 0.2, 0.7});
    transoms.push_back({1 + 2.5 * c, 2.2 + 2.5 * c, 3.75, 4.2});
  }
  const Facade f = with(plus(plus(holes, cellar), transoms));
  expect_grid(f, 3, 5);
  for (std::size_t i = 0; i < f.openings.size(); ++i) EXPECT_EQ(f.openings[i].row < 0, i >= 15) << i;
  expect_grid(with(cellar), 1, 5);
}

TEST(OpeningGrid, PutsDoorsBesideWindowsIntoTheirRow) {
  const Facade f = with(plus(grid(5, 3), {{13.5, 14.5, 0, 2.1, true}, {16, 16.9, 6.2, 8.5, true}}));
  EXPECT_EQ(f.storeys, 3);
  EXPECT_EQ(f.openings[15].row, 0);
  EXPECT_EQ(f.openings[16].row, 2);
  // A door alone below is a storey of its own, as garages are.
  auto above = grid(3, 2);
  for (Hole& h : above) {
    h.bottom += 3;
    h.top += 3;
  }
  const Facade garage = with(plus(above, {{1, 3.5, 0, 2.2, true}, {4, 6.5, 0, 2.2, true}}));
  EXPECT_EQ(garage.storeys, 3);
  EXPECT_EQ(garage.openings[6].row, 0);
  EXPECT_EQ(with({{1, 3.5, 0, 2.2, true}}).storeys, 1);
}

TEST(OpeningGrid, KeepsSmallWindowsInTheStoreyThatTheyAreIn) {
  const Facade f = with(plus(grid(5, 3), {{13.5, 14, 4.9, 5.5}}));
  EXPECT_EQ(f.storeys, 3);
  EXPECT_EQ(f.openings[15].row, 1);
}

TEST(OpeningGrid, TakesAxesFromTheStoreysAboveShops) {
  std::vector<Hole> holes;
  for (const Hole& h : grid(5, 4))
    if (h.bottom > 2) holes.push_back(h);
  const std::vector<Hole> shop{{0.5, 4, 0.3, 2.9},   {4.3, 5.5, 0, 2.5, true}, {6, 9, 0.3, 2.9},
                               {9.3, 9.9, 0.3, 2.9}, {10, 10.6, 0.3, 2.9},     {10.7, 11.3, 0.3, 2.9},
                               {11.4, 12, 0.3, 2.9}};
  const std::vector<Hole> attic{{2.5, 3.2, 13, 14}, {7.5, 8.2, 13, 14}};
  const Facade f = with(plus(plus(holes, shop), attic));
  expect_grid(f, 5, 5);
  EXPECT_NEAR(*f.axis_pitch, 2.5, 1e-9);
  EXPECT_EQ(f.openings.back().column, -1);
}

TEST(OpeningGrid, OfTwoStoreysBelievesTheFullerOne) {
  expect_grid(with(plus(grid(4, 1), {{4.6, 5.4, 4.5, 5.5}})), 2, 4);
  expect_grid(with(plus(grid(2, 1), {{2.3, 3.1, 4.5, 5.5}})), 2, 2);
  expect_grid(with(plus({{1, 4, 0.5, 2.5}, {5, 8, 0.5, 2.5}},
                        {{1, 2, 4, 5.5}, {3, 4, 4, 5.5}, {5, 6, 4, 5.5}, {7, 8, 4, 5.5}})),
              2, 4);
}

TEST(OpeningGrid, DoesNotDependOnOrderOrSide) {
  auto holes = plus(grid(5, 4), {{13.5, 14.5, 0, 2.1, true}, {3, 3.4, 3.3, 3.9}, {5, 5.9, 0.1, 0.6}});
  const Facade expected = with(holes);
  std::mt19937 random(1);
  for (int run = 0; run < 20; ++run) {
    std::shuffle(holes.begin(), holes.end(), random);
    const Facade f = with(holes);
    expect_grid(f, expected.storeys, expected.axes);
    EXPECT_EQ(f.storey_pitch, expected.storey_pitch);
    auto mirrored = holes;
    for (Hole& h : mirrored) h = {20 - h.right, 20 - h.left, h.bottom, h.top, h.door};
    expect_grid(with(mirrored), expected.storeys, expected.axes);
  }
}

}  // namespace
}  // namespace blockrand::compare::test
