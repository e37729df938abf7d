// Which buildings are repaired together, and the store they lie in.
#include "pipeline/footprints/terrace_rows.h"

#include <gmock/gmock.h>

namespace blockrand::footprints {
namespace {

using model::Point2;
using model::Polygon;
using ::testing::ElementsAre;

Polygon box(double x, double y, double w, double h) {
  Polygon p;
  p.outer.points = {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
  p.outer.nodes = {1, 2, 3, 4};
  return p;
}

/// Footprints with the ids w1, w2, ... in the order given, stored back to front.
FootprintStore store_of(const std::vector<Polygon>& polygons) {
  FootprintStore store(polygons.size());
  for (std::size_t i = polygons.size(); i-- > 0;) {
    StoredFootprint f;
    f.id = {model::OsmType::way, static_cast<std::int64_t>(i) + 1};
    store.set(static_cast<std::uint32_t>(i), f, std::span(&polygons[i], 1));
  }
  return store;
}

TEST(FootprintStore, GivesBackWhatItGot) {
  Polygon ring = box(0, 0, 30, 30);
  ring.holes.push_back({{{10, 10}, {10, 20}, {20, 20}, {20, 10}}, {5, 6, 7, 8}});
  const FootprintStore store = store_of({box(100, 0, 10, 10), ring});
  const std::vector<Polygon> got = store.polygons(1);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].outer.points, ring.outer.points);
  ASSERT_EQ(got[0].holes.size(), 1u);
  EXPECT_EQ(got[0].holes[0].points, ring.holes[0].points);
  EXPECT_EQ(got[0].holes[0].nodes, ring.holes[0].nodes);
  EXPECT_EQ(store[1].box.maximum, (Point2{30, 30}));
}

TEST(IndexOfFootprints, PairsAreThoseWhoseBoxesAreNear) {
  // Cells are 64 m: neighbours across their lines, and across a corner of four.
  const FootprintStore store = store_of({box(0, 0, 63.8, 63.8), box(64.2, 0, 10, 10), box(64.2, 64.2, 10, 10),
                                         box(0, 64.2, 10, 10), box(-10.3, -10.3, 10, 10), box(40, 66, 5, 5)});
  const BoxIndex index = index_of(store);
  EXPECT_THAT(index.pairs(1), ElementsAre(std::pair(0u, 1u), std::pair(0u, 2u), std::pair(0u, 3u), std::pair(0u, 4u)));
  EXPECT_TRUE(index.pairs(0.1).empty());
  EXPECT_THAT(index.near(store[2].box, 1), ElementsAre(0u, 2u));
}

TEST(Rows, NeighboursAreOneRowAndAlleysPartThem) {
  const FootprintStore store =
      store_of({box(0, 0, 10, 10), box(10.4, 0, 10, 10), box(22, 0, 10, 10), box(25, 3, 2, 2)});
  const std::vector<TerraceRowPlan> rows = find_terrace_rows(store, 1);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_THAT(rows[0].buildings, ElementsAre(0u, 1u));
  EXPECT_THAT(rows[1].buildings, ElementsAre(2u, 3u)) << "a building within another one belongs to its row";
  EXPECT_TRUE(rows[0].beyond.empty());
}

TEST(Rows, NearBoxesAreNotEnough) {
  Polygon ell = box(0, 0, 40, 40);
  ell.outer.points = {{0, 0}, {40, 0}, {40, 10}, {10, 10}, {10, 40}, {0, 40}};
  ell.outer.nodes.assign(6, 0);
  EXPECT_EQ(find_terrace_rows(store_of({ell, box(20, 20, 10, 10)}), 1).size(), 2u);
}

TEST(Rows, ABuildingWithoutOutlineIsInNone) {
  FootprintStore store(2);
  const Polygon p = box(0, 0, 5, 5);
  store.set(0, {}, {});
  store.set(1, {}, std::span(&p, 1));
  ASSERT_EQ(find_terrace_rows(store, 1).size(), 1u);
}

TEST(Rows, LongRowsAreCutAtTheGridAndKnowWhoStandsBeyond) {
  std::vector<Polygon> houses;
  for (int i = 0; i < 150; ++i) houses.push_back(box(10.0 * i, 0, 10, 10));
  const FootprintStore store = store_of(houses);
  const std::vector<TerraceRowPlan> rows = find_terrace_rows(store, 1);
  ASSERT_EQ(rows.size(), 3u) << "1,500 m over cells of 500 m";
  EXPECT_EQ(rows[0].buildings.size(), 50u);
  EXPECT_THAT(rows[0].beyond, ElementsAre(50u));
  EXPECT_THAT(rows[1].beyond, ElementsAre(49u, 100u));
}

TEST(Rows, WhatIsReadOfALongRowIsCutTheSame) {
  std::vector<Polygon> houses;
  for (int i = 0; i < 400; ++i) houses.push_back(box(10.0 * i, 0, 10, 10));
  const auto row_of = [](const FootprintStore& store, model::OsmId id) {
    for (const TerraceRowPlan& row : find_terrace_rows(store, 1)) {
      std::vector<std::int64_t> ids;
      bool here = false;
      for (const std::uint32_t b : row.buildings) {
        ids.push_back(store[b].id.number);
        here = here || store[b].id == id;
      }
      for (const std::uint32_t b : row.beyond) ids.push_back(-store[b].id.number);
      if (here) return ids;
    }
    return std::vector<std::int64_t>{};
  };
  const FootprintStore whole = store_of(houses);
  // Only houses within 1.5 km of house 200.
  FootprintStore part(301);
  for (std::uint32_t i = 50; i <= 350; ++i) {
    StoredFootprint f;
    f.id = {model::OsmType::way, i + 1};
    part.set(i - 50, f, std::span(&houses[i], 1));
  }
  const model::OsmId asked{model::OsmType::way, 201};
  EXPECT_EQ(row_of(whole, asked), row_of(part, asked));
  EXPECT_EQ(row_of(part, asked).size(), 52u);
}

}  // namespace
}  // namespace blockrand::footprints
