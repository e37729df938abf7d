#include "pipeline/footprints/move_buildings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace blockrand::footprints {
namespace {

using model::Extract;
using model::FeatureKind;
using model::Location;
using model::ObjectKind;
using model::OsmId;
using model::OsmType;
using model::Point2;

constexpr std::int32_t kX = 110'300'000, kY = 514'700'000;  // 1e-7 degrees
constexpr std::int32_t kMetreEast = 144, kMetreNorth = 90;  // of them in a metre, about

struct Node {
  std::int64_t id;
  double x, y;  // m
};

model::Range rings_of(Extract& e, const std::vector<Node>& nodes) {
  const model::Range ring{static_cast<std::uint32_t>(e.rings.size()), 1};
  e.rings.push_back({{static_cast<std::uint32_t>(e.vertices.size()), static_cast<std::uint32_t>(nodes.size())}, false});
  for (const Node& n : nodes) {
    e.vertices.push_back(
        {kX + static_cast<std::int32_t>(n.x * kMetreEast), kY + static_cast<std::int32_t>(n.y * kMetreNorth)});
    e.vertex_nodes.push_back(n.id);
  }
  return ring;
}

void add_building(Extract& e, std::int64_t way, ObjectKind kind, const std::vector<Node>& nodes) {
  model::MappedBuilding b;
  b.id = {OsmType::way, way};
  b.kind = kind;
  b.rings = rings_of(e, nodes);
  e.buildings.push_back(b);
}

void add_feature(Extract& e, OsmType type, std::int64_t number, FeatureKind kind, const std::vector<Node>& nodes) {
  model::Feature f;
  f.id = {type, number};
  f.kinds = static_cast<std::uint32_t>(kind);
  f.rings = rings_of(e, nodes);
  e.features.push_back(f);
}

class MoveBuildings : public testing::Test {
 protected:
  MoveBuildings() : projection_(georef::open_crs("EPSG:25832", kBox), kBox) {
    add_building(extract_, 1, ObjectKind::building, {{1, 0, 0}, {2, 10, 0}, {3, 10, 8}, {4, 0, 8}});
    add_building(extract_, 2, ObjectKind::building, {{5, 30, 0}, {6, 40, 0}, {7, 40, 8}, {8, 30, 8}});
    add_building(extract_, 3, ObjectKind::building_part, {{1, 0, 0}, {9, 5, 0}, {10, 5, 8}, {4, 0, 8}});
    add_feature(extract_, OsmType::node, 20, FeatureKind::shop, {{20, 4, 4}});
    add_feature(extract_, OsmType::node, 21, FeatureKind::shop, {{21, 20, 4}});
    add_feature(extract_, OsmType::node, 22, FeatureKind::tree, {{22, 5, 5}});
    add_feature(extract_, OsmType::way, 30, FeatureKind::roof_line, {{23, 2, 4}, {24, 8, 4}});
    add_feature(extract_, OsmType::way, 31, FeatureKind::street, {{25, -20, 8}, {4, 0, 8}, {26, -20, 20}});
    model::Report report;
    shards_ = make_shards(extract_, report);
  }

  /// m, from where vertex v was to where it is.
  Point2 shift_of(std::size_t v) const {
    const Point2 a = projection_.forward(extract_.mapped_vertices[v]), b = projection_.forward(extract_.vertices[v]);
    return {b.x - a.x, b.y - a.y};
  }
  void expect_shift(std::size_t v, double x, double y) const {
    EXPECT_NEAR(shift_of(v).x, x, 0.011) << v;
    EXPECT_NEAR(shift_of(v).y, y, 0.011) << v;
  }

  static constexpr georef::GeoBox kBox{11.02, 51.46, 11.04, 51.48};
  Extract extract_;
  std::vector<Shard> shards_;
  georef::Projection projection_;
};

TEST_F(MoveBuildings, AHouseMovesWithItsPartsAndWhatIsMappedOnIt) {
  const MovedBuilding moved{0, {{2, -1}, {}, 0}};
  move_buildings(extract_, shards_, {&moved, 1}, projection_);
  for (const std::size_t v : {0, 1, 2, 3, 8, 9, 10, 11}) expect_shift(v, 2, -1);  // outline and part
  for (const std::size_t v : {4, 5, 6, 7}) expect_shift(v, 0, 0);                 // the other house
  expect_shift(12, 2, -1);                                                        // the shop in it
  expect_shift(13, 0, 0);                                                         // the shop beside it
  expect_shift(14, 0, 0);                                                         // a tree stands in no house
  for (const std::size_t v : {15, 16}) expect_shift(v, 2, -1);                    // the ridge
  expect_shift(17, 0, 0);
  expect_shift(18, 2, -1);  // the street's node at the house's corner
  expect_shift(19, 0, 0);
}

TEST_F(MoveBuildings, TheTileStaysThatOfWhatIsMapped) {
  const Location before = box_centre(extract_, extract_.buildings[0]);
  const MovedBuilding moved{0, {{3, 3}, {}, 0}};
  move_buildings(extract_, shards_, {&moved, 1}, projection_);
  EXPECT_EQ(box_centre(extract_, extract_.buildings[0]), before);
}

TEST(Movement, WhatLiesOnAWallGoesWithIt) {
  Movement wider{{0, 3}, {}, 0};
  wider.reshape.before = {{{0, 0}, {10, 0}, {10, 8}, {0, 8}}};
  wider.reshape.after = {{{0, 3}, {11, 3}, {11, 11}, {0, 11}}};
  const auto expect = [&](Point2 p, double x, double y) {
    EXPECT_NEAR(wider(p).x, x, 1e-12) << p.x << ", " << p.y;
    EXPECT_NEAR(wider(p).y, y, 1e-12) << p.x << ", " << p.y;
  };
  expect({10, 0}, 11, 3);
  expect({10.1, 4}, 11.1, 7);  // an entrance on the wall, mapped a little beside it
  expect({9, 5}, 10, 8);       // a shop behind it
  expect({5, 0}, 5.5, 3);      // a point of the wall that grows
  expect({0, 4}, 0, 7);
  wider.reshape.after[0][3].x += 0.0015;  // rounded: it keeps to the others
  expect({0, 8}, 0, 11);
  wider.reshape = {};
  expect({10, 0}, 10, 3);
}

TEST(Movement, TurnsAboutItsCentreBeforeItShifts) {
  const Movement quarter{{10, 0}, {1, 1}, 90};
  const Point2 p = quarter({2, 1});
  EXPECT_NEAR(p.x, 11, 1e-12);
  EXPECT_NEAR(p.y, 2, 1e-12);
}

}  // namespace
}  // namespace blockrand::footprints
