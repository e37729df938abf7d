// What is told of an area: of its own tiles, put together in one order, whoever recorded them.
#include "pipeline/run/area_record.h"

#include <gtest/gtest.h>

#include <random>

#include "pipeline/georef/crs.h"
#include "pipeline/georef/tiles.h"

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
  TileReach reach{cells.runs(), cells.runs(), cells.runs()};
  reach.near.box = reach.far.box = tile;
  reach.far.box.maximum.x += 700;
  const geometry::PlanBox needed = needed_around(reach, 0);
  EXPECT_EQ(needed.minimum.x, tile.minimum.x - kNetworkReach);
  EXPECT_EQ(needed.maximum.x, tile.maximum.x + kNetworkReach);
  EXPECT_EQ(needed_around(reach, 2000).maximum.y, tile.maximum.y + 2000);
  const std::array<double, 4> window = window_around(needed, projection);
  EXPECT_TRUE(holds(within_window(window, projection), needed));
  // A window is not much larger than what it is for, and one of a box does not hold more than the box.
  geometry::PlanBox more = needed;
  more.maximum.x += 200;
  EXPECT_FALSE(holds(within_window(window, projection), more));
}

}  // namespace
}  // namespace blockrand::run
