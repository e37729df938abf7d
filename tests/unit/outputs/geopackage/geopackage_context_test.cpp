// What repair and context found, as the GeoPackage tells it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "pipeline/model/wall_segment_colours.h"
#include "pipeline/outputs/geopackage/columns.h"
#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "pipeline/outputs/geopackage/qgis_styles.h"
#include "pipeline/outputs/wall_segment_ids.h"
#include "tests/unit/outputs/row_sample.h"

namespace blockrand::outputs {
namespace {

using test::row_sample;
using test::SampleRegion;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "blockrand-gpkg-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

model::Polygon rectangle(double x, double y, double width, double depth) {
  model::Polygon p;
  p.outer.points = {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}};
  p.outer.nodes.assign(4, 0);
  return p;
}

BlockRow a_block() {
  BlockRow b;
  b.id = "w900.n5.l";
  b.polygon = rectangle(test::kRowX - 10, test::kRowY, 70, 60);
  b.area = 4200;
  b.kind = "ordinary";
  b.buildings = 4;
  b.built_share = 0.17571428;
  b.closure = 0.75;
  b.front_length = 45;
  b.courtyard_area = 500;
  b.courtyards = 1;
  b.streets = {"Kastanienallee", "w901"};
  return b;
}
CourtyardRow a_courtyard() {
  return {"w1.y7_8", "w900.n5.l", rectangle(test::kRowX, test::kRowY + 22, 25, 20),    500,
          true,      0,           {{model::OsmType::way, 1}, {model::OsmType::way, 2}}};
}
CellRow a_cell() {
  CellRow c;
  c.id = "c1564_23276";
  c.corner = {391000, 5819000};
  c.buildings = 4;
  c.covered_share = 0.97123;
  c.density = 0.64;
  c.built_share = 0.0118;
  c.tagged_share = 0.25;
  c.storeys_mean = 5;
  c.footprint_quartile = 108;
  c.footprint_median = 190.5;
  c.footprint_upper_quartile = 210;
  return c;
}

void write(const std::string& path, const model::Region& region) {
  GeoPackageWriter writer(path, {"EPSG:25833", "2024-05-01T12:34:56Z", "", ""});
  writer.add_block(a_block());
  writer.add(geopackage_rows(region, 2));
  writer.add_courtyard(a_courtyard());
  writer.add_cell(a_cell());
  writer.close();
}

std::vector<std::vector<std::string>> query(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  std::vector<std::vector<std::string>> rows;
  while (sqlite3_step(statement) == SQLITE_ROW) {
    std::vector<std::string>& row = rows.emplace_back();
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      const auto* text = static_cast<const char*>(sqlite3_column_blob(statement, i));
      row.push_back(sqlite3_column_type(statement, i) == SQLITE_NULL
                        ? "NULL"
                        : std::string(text ? text : "", static_cast<std::size_t>(sqlite3_column_bytes(statement, i))));
    }
  }
  sqlite3_finalize(statement);
  sqlite3_close(db);
  return rows;
}

/// The row of houses in a file, made once.
class ContextLayers : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new Folder;
    path = *folder / "row.gpkg";
    write(path, row_sample().region());
  }
  static void TearDownTestSuite() { delete folder; }
  static inline Folder* folder = nullptr;
  static inline std::string path;
};

TEST_F(ContextLayers, EdgesAreNamedByTheirNodes) {
  EXPECT_THAT(
      query(path, "SELECT id, building, kind, length, orientation, front FROM facade_edges WHERE building = 'w2'"),
      ElementsAre(ElementsAre("w2.e20_21", "w2", "street", "7.0", "180.0", "1"),
                  ElementsAre("w2.e20_21.1", "w2", "passage", "3.3", "180.0", "0"),
                  ElementsAre("w2.e20_21.2", "w2", "street", "7.7", "180.0", "1"),
                  ElementsAre("w2.e21_22", "w2", "party_wall", "14.0", "90.0", "0"),
                  ElementsAre("w2.e22_23", "w2", "courtyard", "18.0", "0.0", "0"),
                  ElementsAre("w2.e23_20", "w2", "party_wall", "14.0", "270.0", "0")));
  EXPECT_THAT(query(path, "SELECT count(*), count(DISTINCT id) FROM facade_edges"),
              ElementsAre(ElementsAre("18", "18")));
}

TEST_F(ContextLayers, EdgesSayWhatTheyFace) {
  EXPECT_THAT(
      query(path,
            "SELECT street, street_name, street_class, street_distance, street_angle, visibility, corner_start, "
            "corner_end, chamfer, entrances, neighbour, from_node, to_node FROM facade_edges WHERE id = 'w1.e10_11'"),
      ElementsAre(ElementsAre("w900", "Kastanienallee", "residential", "11.5", "0.2", "1.0", "1", "0", "0", "1", "NULL",
                              "10", "11")));
  EXPECT_THAT(query(path,
                    "SELECT neighbour, covered_height, street, street_distance, arc_radius, confidence "
                    "FROM facade_edges WHERE id = 'w1.e11_12'"),
              ElementsAre(ElementsAre("w2", "16.5", "NULL", "NULL", "NULL", "0.9")));
  EXPECT_THAT(query(path, "SELECT arc_radius, arc_bulge FROM facade_edges WHERE id = 'w4.e42_43'"),
              ElementsAre(ElementsAre("6.25", "outward")));
}

TEST_F(ContextLayers, EdgesHaveTheirEntrancesAddressesAndTrees) {
  const std::string columns = "SELECT entrances, house_numbers, points, trees FROM facade_edges WHERE id = ";
  EXPECT_THAT(query(path, columns + "'w1.e10_11'"), ElementsAre(ElementsAre("1", "7; 7a", "n71 n72 n73", "0")));
  EXPECT_THAT(query(path, columns + "'w3.e30_31'"), ElementsAre(ElementsAre("0", "NULL", "NULL", "2")));
}

TEST_F(ContextLayers, EdgesAreLinesAlongTheOutline) {
  const std::string blob = query(path, "SELECT geom FROM facade_edges WHERE id = 'w2.e20_21.1'").at(0).at(0);
  // Header with envelope, byte order, type, number of points, two points.
  ASSERT_EQ(blob.size(), 8u + 32 + 1 + 4 + 4 + 2 * 16);
  double line[4];
  std::memcpy(line, blob.data() + 49, sizeof line);
  EXPECT_THAT(line, ElementsAre(391019.0, 5819008.0, model::snap(391022.3), 5819008.0));
}

TEST_F(ContextLayers, BuildingsSayHowTheyStandAndWhatWasMended) {
  EXPECT_THAT(query(path,
                    "SELECT position, front_orientation, depth, width, setback, party_wall_length, block, courtyards "
                    "FROM buildings ORDER BY id"),
              ElementsAre(ElementsAre("corner_house", "180.0", "14.0", "12.0", "NULL", "14.0", "w900.n5.l", "w1.y7_8"),
                          ElementsAre("mid_row", "180.0", "14.0", "18.0", "0.4", "28.0", "w900.n5.l", "w1.y7_8"),
                          ElementsAre("end_of_row", "180.0", "14.0", "15.0", "NULL", "14.0", "w900.n5.l", "w1.y7_8"),
                          ElementsAre("rear_building", "NULL", "9.0", "12.0", "NULL", "0.0", "w900.n5.l", "w1.y7_8")));
  EXPECT_THAT(query(path,
                    "SELECT moved, mean_shift, max_shift, mapped_area, shared_walls, gaps_closed, overlaps_resolved, "
                    "overlap_left, squared_direction FROM buildings WHERE id IN ('w1', 'w2') ORDER BY id"),
              ElementsAre(ElementsAre("0", "0.0", "0.0", "168.0", "0", "0", "0", "0.0", "NULL"),
                          ElementsAre("3", "0.082", "0.31", "251.4", "2", "1", "0", "0.0", "90.0")));
}

TEST_F(ContextLayers, BlocksCourtyardsAndCellsHaveTheirFigures) {
  EXPECT_THAT(query(path,
                    "SELECT id, kind, area, cut_by_extract_edge, too_large, buildings, built_share, tagged_share, "
                    "floor_area_ratio, closure, front_length, courtyard_area, courtyards, streets FROM blocks"),
              ElementsAre(ElementsAre("w900.n5.l", "ordinary", "4200.0", "0", "0", "4", "0.1757", "NULL", "NULL",
                                      "0.75", "45.0", "500.0", "1", "Kastanienallee; w901")));
  EXPECT_THAT(query(path, "SELECT id, block, area, closed, opening, buildings, building_ids FROM courtyards"),
              ElementsAre(ElementsAre("w1.y7_8", "w900.n5.l", "500.0", "1", "0.0", "2", "w1 w2")));
  EXPECT_THAT(query(path,
                    "SELECT id, size, buildings, covered_share, density, built_share, tagged_share, storeys_mean, "
                    "storeys_spread, "
                    "year_mean, footprint_median FROM cells"),
              ElementsAre(ElementsAre("c1564_23276", "250.0", "4", "0.9712", "0.64", "0.0118", "0.25", "5.0", "NULL",
                                      "NULL", "190.5")));
  EXPECT_THAT(query(path, "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'cells'"),
              ElementsAre(ElementsAre("391000.0", "5819000.0", "391250.0", "5819250.0")));
}

TEST_F(ContextLayers, TheSameCallsGiveTheSameBytes) {
  write(*folder / "again.gpkg", row_sample().region());
  const auto bytes = [](const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_TRUE(bytes(path) == bytes(*folder / "again.gpkg"));
}

TEST(ContextColumns, LengthsAndAreasSayTheirUnit) {
  for (const auto& columns : {wall_segment_columns(), block_columns(), courtyard_columns(), cell_columns(),
                              situation_columns(), repair_columns()})
    for (const Column& c : columns) {
      EXPECT_FALSE(c.description.empty()) << c.name;
      const bool measure = c.kind == ColumnKind::real && (c.name.ends_with("length") || c.name.ends_with("area") ||
                                                          c.name.ends_with("shift") || c.name.ends_with("distance"));
      if (measure) {
        EXPECT_THAT(c.unit, testing::AnyOf("m", "m\u00b2")) << c.name;
      }
    }
}

TEST(ContextStyles, EdgesHaveTheColoursOfThePlan) {
  for (const QgisStyle& style : qgis_styles()) {
    if (style.layer != "facade_edges") continue;
    EXPECT_THAT(style.qml, HasSubstr("<layerGeometryType>1</layerGeometryType>"));
    EXPECT_THAT(style.qml, HasSubstr("class=\"SimpleLine\""));
    for (int k = 1; k < model::kWallSegmentKindCount; ++k) {
      const auto kind = static_cast<model::WallSegmentKind>(k);
      const model::Colour c = model::colour_of(kind);
      EXPECT_THAT(style.qml, HasSubstr("value=\"" + std::string(model::name(kind)) + "\""));
      EXPECT_THAT(style.qml, HasSubstr("name=\"line_color\" value=\"" + std::to_string(c.r) + ',' +
                                       std::to_string(c.g) + ',' + std::to_string(c.b) + ",255\""));
    }
    return;
  }
  FAIL() << "no style of facade_edges";
}

TEST(ContextRows, WithoutContextEverythingIsEmpty) {
  SampleRegion sample;
  model::Building& b = sample.add_building(5, {});
  sample.add_box(b, "w5", 391000, 5819000, 8, 8, 30, 9);
  b.outline = {b.parts[0].plan};
  b.edges.assign(4, {});  // as repair leaves them: no kind, no place
  const Folder folder;
  GeoPackageWriter writer(folder / "a.gpkg", {"EPSG:25833", "", "", ""});
  writer.add(geopackage_rows(sample.region(), 2));
  writer.close();
  EXPECT_THAT(
      query(folder / "a.gpkg", "SELECT position, depth, party_wall_length, block, moved, max_shift FROM buildings"),
      ElementsAre(ElementsAre("unknown", "NULL", "NULL", "NULL", "NULL", "NULL")));
  for (const std::string layer : {"facade_edges", "blocks", "courtyards", "cells"})
    EXPECT_THAT(query(folder / "a.gpkg", "SELECT * FROM " + layer), IsEmpty());
}

// ---- where wall segments lie
// -----------------------------------------------------------------------------------------------

TEST(WallSegmentIds, PointsThatRepairMadeAreNamedByTheirPlace) {
  SampleRegion sample = row_sample();
  model::Building& b = sample.region().buildings.at(2);
  b.outline[0].outer.nodes[1] = 0;
  b.edges[0].to_node = b.edges[1].from_node = 0;
  const auto found = wall_segments(b);
  EXPECT_EQ(found.at(0).id, "w3.e30_p400430080x5958664192");
  EXPECT_EQ(found.at(1).id, "w3.ep400430080x5958664192_32");
}

TEST(WallSegmentIds, TwoEdgesBetweenTheSameNodesHaveDifferentIds) {
  SampleRegion sample = row_sample();
  model::Building& b = sample.region().buildings.at(3);
  b.outline.push_back(b.outline[0]);
  for (model::Point2& p : b.outline[1].outer.points) p.x += 100;
  const std::size_t n = b.edges.size();
  for (std::size_t i = 0; i < n; ++i) {
    b.edges.push_back(b.edges[i]);
    b.edges.back().polygon = 1;
  }
  const auto found = wall_segments(b);
  ASSERT_EQ(found.size(), 8u);
  EXPECT_EQ(found[0].id, "w4.e40_41");
  EXPECT_EQ(found[4].id, "w4.e40_41~2");
  EXPECT_EQ(found[4].from.x, found[0].from.x + 100);
}

TEST(WallSegmentIds, NeighboursMeetOnTheGridAndWholeEdgesEndAtCorners) {
  SampleRegion sample = row_sample();
  model::Building& b = sample.region().buildings.at(1);
  b.outline[0].outer.points[1] = model::snap(model::Point2{test::kRowX + 29.9, test::kRowY + 9.7});
  const model::Point2 p = b.outline[0].outer.points[0], q = b.outline[0].outer.points[1];
  b.edges[2].end = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y)) + 1e-7;  // rounding of a sum
  const auto found = wall_segments(b);
  EXPECT_EQ(found.at(0).from, p);
  EXPECT_EQ(found.at(0).to, found.at(1).from);
  EXPECT_EQ(found.at(1).to, found.at(2).from);
  EXPECT_EQ(found.at(2).to, q);
  for (const IdentifiedWallSegment& s : found) EXPECT_EQ(s.to, model::snap(s.to));
}

TEST(WallSegmentIds, WhatHasNoPlaceIsLeftOut) {
  SampleRegion sample = row_sample();
  model::Building& b = sample.region().buildings.at(3);
  b.edges[0].polygon = 7;
  b.edges[1].ring = 1;
  b.edges[2].edge = 4;
  b.edges[3].end = 0.0003;
  EXPECT_THAT(wall_segments(b), IsEmpty());
}

TEST(WallSegmentIds, WallsLookAwayFromTheBuilding) {
  EXPECT_EQ(outward({0, 0}, {1, 0}), 180);
  EXPECT_EQ(outward({0, 0}, {0, 1}), 90);
  EXPECT_EQ(outward({1, 0}, {0, 0}), 0);
  EXPECT_EQ(outward({0, 1}, {0, 0}), 270);
  EXPECT_NEAR(outward({0, 0}, {1, -1}), 225, 1e-12);
  EXPECT_EQ(compass(225), "SW");
  EXPECT_EQ(compass(359), "N");
  EXPECT_EQ(compass(22.4), "N");
  EXPECT_EQ(compass(22.6), "NE");
}

}  // namespace
}  // namespace blockrand::outputs
