// What is told of an area: of its own tiles, put together in one order, whoever recorded them.
#include "pipeline/run/area_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pipeline/georef/crs.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/run/area_changes.h"

namespace blockrand::run {
namespace {

constexpr model::TileId kWest{15, 35207, 25941}, kEast{15, 35208, 25941};

model::OsmId way(std::int64_t number) { return {model::OsmType::way, number}; }

model::Polygon square(double x, double y, double side) {
  model::Polygon p;
  p.outer.points = {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
  return p;
}

/// A tile with one house, in a block that both tiles know.
TileRecord record_of(std::int64_t id, double x) {
  TileRecord tile;
  tile.is_tile = true;
  tile.objects.push_back(
      {way(id), {}, {}, {}, {}, model::Location{1, 2}, static_cast<std::uint32_t>(id), false, false});
  RecordedBuilding b;
  b.outline = 0;
  b.footprint.id = way(id);
  b.footprint.record.vertices = 4;
  b.footprint.box = geometry::box_of(square(x, 0, 10).outer.points);
  b.polygons = {square(x, 0, 10)};
  tile.buildings.push_back(b);
  tile.terrace_rows = 1;
  RecordedBlock block;
  block.block.id = "w9.n1.l";
  block.block.polygon = square(-50, -50, 200);
  block.block.borders = {{0, 100}};
  block.lines = {way(9)};
  block.buildings = {way(1), way(2), way(77)};  // the last lies in another area
  tile.blocks = {block};
  context::NetworkLine line;
  line.id = way(9), line.points = {{-50, -50}, {150, -50}};
  tile.lines = {line};
  tile.rows = {{way(id), model::IssueCode::squared, ""}};
  tile.data_sha256 = std::to_string(id);
  return tile;
}

TEST(AreaRecord, TilesAreToldTogether) {
  const AreaRecord record{{kWest, record_of(2, 0)}, {kEast, record_of(1, 30)}};
  const AreaAsTold told = told_area(record, {});
  ASSERT_EQ(told.extract.buildings.size(), 2u);
  EXPECT_EQ(told.extract.buildings[0].id, way(1));
  ASSERT_EQ(told.shards.size(), 2u);
  EXPECT_EQ(told.shards[0].tile, kWest);
  EXPECT_EQ(told.shards[0].seeds[0].outline, 1u);
  EXPECT_EQ(told.rows.size(), 2u);
  EXPECT_EQ(told.data_time, "1970-01-01T00:00:02Z");
  ASSERT_EQ(told.context.blocks.size(), 1u);
  ASSERT_EQ(told.context.lines.size(), 1u);
  ASSERT_EQ(told.repaired.footprints.size(), 3u);
  EXPECT_EQ(told.context.figures[0].buildings, (std::vector<std::uint32_t>{1, 0, 2}));
  EXPECT_EQ(told.repaired.footprints[2].id, way(77));
  EXPECT_TRUE(told.repaired.footprints[2].box.empty());
  EXPECT_EQ(told.repaired.totals.outlines, 2u);
  EXPECT_EQ(told.repaired.totals.vertices, 8u);
  EXPECT_EQ(told.repaired.totals.rows, 2u);
  // What is kept of it says the same.
  const AreaAsTold kept = told_area(base::unpacked<AreaRecord>(base::packed(record)), {});
  EXPECT_EQ(kept.data_sha256, told.data_sha256);
  EXPECT_EQ(kept.repaired.footprints[0].box.maximum.x, 10);
  AreaRecord other = record;
  other[kEast].data_sha256 = "another";
  EXPECT_NE(told_area(other, {}).data_sha256, told.data_sha256);
}

TEST(PlanCells, GrowAsTheirSquaresDo) {
  // Against each square by itself.
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    const CellRange extent{-20, -10, 30, 25};
    PlanCells cells(extent);
    std::vector<geometry::PlanBox> boxes;
    for (unsigned i = 0; i < 1 + random() % 6; ++i) {
      geometry::PlanBox& box = boxes.emplace_back();
      box.include(
          model::Point2{static_cast<double>(random() % 2000) - 800, static_cast<double>(random() % 1200) - 300});
      box.include(model::Point2{box.minimum.x + static_cast<double>(random() % 300),
                                box.minimum.y + static_cast<double>(random() % 300)});
      cells.include(box);
    }
    const double distance = static_cast<double>(random() % 400);
    cells.grow(distance);
    const CellRuns runs = cells.runs();
    for (int probe = 0; probe < 200; ++probe) {
      geometry::PlanBox point;
      point.include(
          model::Point2{static_cast<double>(random() % 2400) - 950, static_cast<double>(random() % 1700) - 450});
      const bool reached = std::ranges::any_of(boxes, [&](const auto& box) { return box.near(point, distance); });
      // No place within the distance is missed, and none is further than two squares beyond it.
      EXPECT_TRUE(!reached || runs.near(point, 0));
      EXPECT_TRUE(!runs.near(point, 0) || std::ranges::any_of(boxes, [&](const auto& box) {
        return box.near(point, distance + 2 * kReachCell);
      }));
      EXPECT_EQ(runs.near(point, 0), cells.meets(cells_of(point)));
    }
    for (const geometry::PlanBox& box : boxes) EXPECT_TRUE(holds(runs.box, box));
  }
}

TEST(AreaReach, WindowsHoldWhatIsNeeded) {
  const georef::GeoBox bounds = georef::bounds(kWest);
  const georef::Crs crs = georef::open_crs("EPSG:25833", bounds);
  const georef::Projection projection(crs, bounds);
  const geometry::PlanBox tile = projected_box({bounds.west, bounds.south, bounds.east, bounds.north}, projection);
  PlanCells cells(cells_of(tile));
  cells.include(tile);
  TileReach reach{cells.runs(), tile, cells.runs(), cells.runs(), {}};
  reach.near.box = reach.far.box = tile;
  reach.far.box.maximum.x += 700;
  EXPECT_LT(needed_around(reach, 0, false).maximum.y, tile.maximum.y + 300) << "nothing changed that makes blocks";
  const geometry::PlanBox needed = needed_around(reach, 0, true);
  EXPECT_EQ(needed.minimum.x, tile.minimum.x - kNetworkReach);
  EXPECT_EQ(needed.maximum.x, tile.maximum.x + kNetworkReach);
  EXPECT_EQ(needed_around(reach, 2000, true).maximum.y, tile.maximum.y + 1700)
      << "beyond its buildings, which lie within";
  const std::array<double, 4> window = window_around(needed, projection);
  EXPECT_TRUE(holds(within_window(window, projection), needed));
  // A window is not much larger than what it is for, and one of a box does not hold more than the box.
  geometry::PlanBox more = needed;
  more.maximum.x += 200;
  EXPECT_FALSE(holds(within_window(window, projection), more));
}

/// A tile that hears of so many metres around itself.
TileReach reach_of(const model::TileId& tile, double metres, const georef::Projection& projection) {
  const georef::GeoBox b = georef::bounds(tile);
  geometry::PlanBox box = projected_box({b.west, b.south, b.east, b.north}, projection);
  box.minimum = {box.minimum.x - metres, box.minimum.y - metres};
  box.maximum = {box.maximum.x + metres, box.maximum.y + metres};
  PlanCells cells(cells_of(box));
  cells.include(box);
  return {cells.runs(), box, cells.runs(), cells.runs(), {}};
}

importers::osm::ChangedObject changed_at(const model::TileId& tile) {
  const georef::GeoBox b = georef::bounds(tile);
  const double lon = (b.west + b.east) / 2, lat = (b.south + b.north) / 2;
  importers::osm::ChangedObject change;
  change.box = {lon, lat, lon + 1e-4, lat + 1e-4};
  change.building = true;
  return change;
}

TEST(AreaChanges, PlacesFarFromEachOtherAreReadAlone) {
  const model::TileId area_tile{11, kWest.x >> 4, kWest.y >> 4};
  const georef::GeoBox bounds = georef::bounds(area_tile);
  const georef::Crs crs = georef::open_crs("EPSG:25833", bounds);
  const georef::Projection projection(crs, bounds);
  TileChoice area;
  area.id = area_tile;
  const georef::GeoBox halo = georef::with_halo(area_tile, kHalo);
  area.window = {halo.west, halo.south, halo.east, halo.north};
  const std::uint32_t x = area_tile.x << 4, y = area_tile.y << 4;
  const model::TileId low{15, x + 1, y + 1}, beside{15, x + 2, y + 1}, high{15, x + 14, y + 14},
      between{15, x + 7, y + 7};
  AreaReach reaches;
  for (const model::TileId& t : {low, beside, high, between}) reaches[t] = reach_of(t, 100, projection);
  const auto held = [&](const AreaChanges& c, const model::TileId& tile) {
    const geometry::PlanBox needed = needed_around(reaches[tile], 0, c.other_network.contains(tile));
    return std::ranges::count_if(c.parts,
                                 [&](const auto& part) { return holds(within_window(part, projection), needed); });
  };

  std::vector<importers::osm::ChangedObject> changes = {changed_at(low), changed_at(high)};
  AreaChanges found = concerned_tiles(area, reaches, changes, {}, false, projection);
  EXPECT_EQ(found.why_whole, "");
  EXPECT_TRUE(found.tiles.contains(low) && found.tiles.contains(high) && !found.tiles.contains(between));
  ASSERT_EQ(found.parts.size(), 2u);
  for (const model::TileId& t : {low, high}) EXPECT_EQ(held(found, t), 1);
  EXPECT_EQ(held(found, between), 0);
  EXPECT_EQ(found.window[0], std::min(found.parts[0][0], found.parts[1][0]));
  EXPECT_EQ(found.window[3], std::max(found.parts[0][3], found.parts[1][3]));

  changes[1] = changed_at(beside);
  found = concerned_tiles(area, reaches, changes, {}, false, projection);
  EXPECT_EQ(found.parts.size(), 1u);
  for (const model::TileId& t : {low, beside}) EXPECT_EQ(held(found, t), 1);

  // Of streets more is read: blocks reach further than before.
  EXPECT_TRUE(found.other_network.empty());
  const double narrow = found.parts[0][2] - found.parts[0][0];
  changes[0].network = true;
  found = concerned_tiles(area, reaches, changes, {}, false, projection);
  EXPECT_TRUE(found.other_network.contains(low));
  EXPECT_GT(found.parts[0][2] - found.parts[0][0], narrow);

  // All over the place: nothing is saved.
  changes.clear();
  for (std::uint32_t k = 0; k < 16; k += 3)
    for (std::uint32_t j = 0; j < 16; j += 3) {
      const model::TileId t{15, x + k, y + j};
      reaches[t] = reach_of(t, 2500, projection);
      changes.push_back(changed_at(t));
    }
  EXPECT_EQ(concerned_tiles(area, reaches, changes, {}, false, projection).why_whole, "most of it is concerned");
}

TEST(AreaChanges, WhatStandsAroundHousesIsHeardOfNearBy) {
  const model::TileId area_tile{12, kWest.x >> 3, kWest.y >> 3};
  const georef::GeoBox bounds = georef::bounds(area_tile);
  const georef::Crs crs = georef::open_crs("EPSG:25833", bounds);
  const georef::Projection projection(crs, bounds);
  TileChoice area;
  area.id = area_tile;
  const georef::GeoBox halo = georef::with_halo(area_tile, kHalo);
  area.window = {halo.west, halo.south, halo.east, halo.north};
  const std::uint32_t x = area_tile.x << 3, y = area_tile.y << 3;
  const model::TileId own{15, x + 2, y + 2}, beside{15, x + 3, y + 2}, far{15, x + 5, y + 2};
  AreaReach reaches;
  for (const model::TileId& t : {own, beside, far}) {
    reaches[t] = reach_of(t, 2500, projection);
    reaches[t].around = reach_of(t, 60, projection).near;
  }
  std::vector<importers::osm::ChangedObject> changes = {changed_at(own)};
  changes[0].building = false, changes[0].is_surrounding = true;
  const AreaChanges lamp = concerned_tiles(area, reaches, changes, {}, true, projection);
  EXPECT_EQ(lamp.why_whole, "");
  EXPECT_EQ(lamp.tiles, (std::set<model::TileId>{own}));
  // What houses hear of is heard of as far as ever.
  changes[0].is_surrounding = false;
  EXPECT_TRUE(concerned_tiles(area, reaches, changes, {}, true, projection).tiles.contains(far));
  changes[0].is_surrounding = true;
  // The sea, and what is very wide, reach farther than tiles tell; to houses alone they are any water.
  changes[0].coast = true;
  EXPECT_EQ(concerned_tiles(area, reaches, changes, {}, true, projection).why_whole.substr(0, 9), "the coast");
  EXPECT_EQ(concerned_tiles(area, reaches, changes, {}, false, projection).why_whole, "");
  changes[0].coast = false;
  changes[0].box[2] = changes[0].box[0] + 1.5;
  changes[0].is_surrounding = false, changes[0].kinds = static_cast<std::uint32_t>(model::FeatureKind::boundary);
  EXPECT_EQ(concerned_tiles(area, reaches, changes, {}, true, projection).why_whole.find("spans"), std::string::npos);
  changes[0].kinds = static_cast<std::uint32_t>(model::FeatureKind::land_use);
  EXPECT_NE(concerned_tiles(area, reaches, changes, {}, true, projection).why_whole, "");
}

}  // namespace
}  // namespace blockrand::run
