// Each planted damage of facade_edges, blocks, courtyards, cells and the new columns of buildings is found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>

#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "pipeline/validate/geopackage.h"
#include "tests/unit/outputs/row_sample.h"

namespace blockrand::validate {
namespace {

namespace fs = std::filesystem;
using outputs::test::kRowX;
using outputs::test::kRowY;
using outputs::test::row_sample;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "blockrand-context-XXXXXX").string();
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

void write_sound(const std::string& path) {
  auto sample = row_sample();
  model::BuildingStyle& style = sample.region().buildings.at(1).style;  // w2, the others were not classified
  style.style = {0.8f, 0.1f, 0.05f, 0.05f};
  style.morphology = {1, 0, 0, 0, 0};
  outputs::GeoPackageWriter writer(path, {"EPSG:25833", "2024-05-01T00:00:00Z", "", ""});
  const outputs::GeoPackageRows rows = outputs::geopackage_rows(sample.region(), 2);
  writer.add(rows);
  outputs::BlockRow block;
  block.id = "w900.n5.l";
  block.polygon = rectangle(kRowX - 10, kRowY, 70, 60);
  block.area = 4200;
  block.kind = "ordinary";
  block.buildings = 4;
  block.built_share = 0.18;
  block.closure = 0.7;
  block.front_length = 45;
  block.courtyard_area = 500;
  block.courtyards = 1;
  writer.add_block(block);
  writer.add_courtyard({"w1.y7_8",
                        block.id,
                        rectangle(kRowX, kRowY + 22, 25, 20),
                        500,
                        false,
                        3.5,
                        {{model::OsmType::way, 1}, {model::OsmType::way, 2}}});
  outputs::CellRow cell;
  cell.id = "c1564_23276";
  cell.corner = {391000, 5819000};
  cell.buildings = 4;
  cell.tagged_share = 0.25;
  cell.footprint_quartile = 108;
  cell.footprint_median = 190;
  cell.footprint_upper_quartile = 210;
  writer.add_cell(cell);
  writer.add_tile({sample.region().tile,
                   "tiles/a.glb",
                   rows.buildings.rows(),
                   rows.parts.rows(),
                   100,
                   {{kRowX, kRowY}, {kRowX + 600, kRowY}, {kRowX + 600, kRowY + 400}, {kRowX, kRowY + 400}}});
  writer.close();
}

std::vector<std::string> findings(const std::string& path) {
  FindingLog log;
  GeoPackageReader reader(path, "buildings.gpkg");
  if (reader.check(log))
    for (const std::string& tile : reader.tiles()) log.add(std::move(reader.rows(tile).contents.findings));
  std::vector<std::string> out;
  for (const Finding& f : log.kept()) out.push_back(std::string(info(f.check).text) + " " + f.object + ": " + f.detail);
  return out;
}

const std::string& sound() {
  static const Folder folder;
  static const std::string path = [] {
    write_sound(folder / "sound.gpkg");
    return folder / "sound.gpkg";
  }();
  return path;
}

TEST(ReadContextLayers, FindsNothingInASoundFile) { EXPECT_THAT(findings(sound()), IsEmpty()); }

struct Damage {
  std::string name, sql, finding;
};
class PlantedInContext : public testing::TestWithParam<Damage> {};

TEST_P(PlantedInContext, IsFound) {
  const Folder folder;
  const std::string path = folder / "damaged.gpkg";
  fs::copy_file(sound(), path);
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  char* error = nullptr;
  ASSERT_EQ(sqlite3_exec(db, GetParam().sql.c_str(), nullptr, nullptr, &error), SQLITE_OK) << error;
  ASSERT_GT(sqlite3_total_changes(db) + (GetParam().sql.starts_with("UPDATE") ? 0 : 1), 0) << "changes nothing";
  sqlite3_close(db);
  EXPECT_THAT(findings(path), Contains(HasSubstr(GetParam().finding)));
}

/// The bytes of `from`'s line behind the header of `to`: another place, everything else as it was.
std::string line_of(const std::string& from, const std::string& to) {
  return "UPDATE facade_edges SET geom = (SELECT geom FROM facade_edges WHERE id = '" + from + "') WHERE id = '" + to +
         "'";
}
std::string edges(const std::string& change, const std::string& id = "w2.e20_21") {
  return "UPDATE facade_edges SET " + change + " WHERE id = '" + id + "'";
}

INSTANTIATE_TEST_SUITE_P(
    All, PlantedInContext,
    testing::Values(
        Damage{"layer_lost", "DROP TABLE facade_edges", "facade_edges: the table is missing"},
        Damage{"column_lost", "ALTER TABLE blocks DROP COLUMN closure", "blocks: the column closure is missing"},
        Damage{"building_column_lost", "ALTER TABLE buildings DROP COLUMN max_shift",
               "the column max_shift is missing"},
        Damage{"style_column_lost", "ALTER TABLE buildings DROP COLUMN p_other", "the column p_other is missing"},
        Damage{"style_p", "UPDATE buildings SET style_p = 0.9 WHERE id = 'w2'",
               "w2: layer buildings: style_p is 0.9, the likeliest class has 0.8"},
        Damage{"style_probability", "UPDATE buildings SET p_modern = 1.5 WHERE id = 'w2'",
               "p_modern \"1.5\" is no number from 0 to 1"},
        Damage{"style_sum", "UPDATE buildings SET p_modern = 0.25 WHERE id = 'w2'",
               "the probabilities of its style sum to 1.2000"},
        Damage{"style_half", "UPDATE buildings SET p_modern = NULL WHERE id = 'w2'",
               "some probabilities of its style are missing"},
        Damage{"style_alone", "UPDATE buildings SET style_p = 0.5 WHERE id = 'w1'",
               "w1: layer buildings: some probabilities"},
        Damage{"morphology", "UPDATE buildings SET morphology = 'garden' WHERE id = 'w2'",
               "morphology \"garden\" is unknown"},
        Damage{"kind", edges("kind = 'garden'"), "w2.e20_21: layer facade_edges: kind \"garden\" is unknown"},
        Damage{"confidence", edges("confidence = 1.5"), "confidence \"1.5\" is no number from 0 to 1"},
        Damage{"no_confidence", edges("confidence = NULL"), "confidence \"\" is no number"},
        Damage{"visibility", edges("visibility = -0.5"), "visibility \"-0.5\""},
        Damage{"angle", edges("street_angle = 120.0"), "street_angle \"120.0\""},
        Damage{"flag", edges("chamfer = 2"), "chamfer \"2\" is neither 0 nor 1"},
        Damage{"length", edges("length = 7.2"), "length is 7.2, its line has 7.000"},
        Damage{"orientation", edges("orientation = 170.0"), "orientation is 170.0, its line looks to 180.0"},
        Damage{"id", edges("id = 'w3.e20_21'"), "w3.e20_21: layer facade_edges: the id does not begin with"},
        Damage{"doubled", edges("id = 'w2.e20_21'", "w2.e20_21.1"), "OBJECT_DOUBLED w2.e20_21"},
        Damage{"building_of_none", "UPDATE facade_edges SET building = 'w99' WHERE building = 'w2'",
               "w99: rows of facade_edges belong to it, and the layer buildings has it not"},
        Damage{"apart", edges("building = 'w4', id = 'w4.e20_21'"),
               "w4: its rows of facade_edges do not stand together"},
        Damage{"edge_lost", "DELETE FROM facade_edges WHERE id = 'w2.e22_23'",
               "w2: its rows of facade_edges are 46.000 m long together, its outline 64.000 m"},
        Damage{"edge_elsewhere", line_of("w3.e32_33", "w2.e22_23"),
               "w2.e22_23: layer facade_edges: the stretch is no piece"},
        // The first point is the western end: the envelope moves with it.
        Damage{"edge_off_grid",
               edges("geom = CAST(substr(geom, 1, 8) || x'01' || substr(geom, 10, 40) || x'01' || "
                     "substr(geom, 51) AS BLOB)"),
               "OFF_GRID w2.e20_21"},
        Damage{"edge_cut_short", edges("geom = substr(geom, 1, length(geom) - 2)"),
               "w2.e20_21: layer facade_edges, geometry: the geometry is cut short"},
        Damage{"neighbour_of_a_street", edges("neighbour = 'w3'"), "a neighbour behind a wall of kind street"},
        Damage{"own_neighbour", edges("neighbour = 'w2'", "w2.e21_22"), "w2.e21_22: layer facade_edges: it is its own"},
        Damage{"neighbour_no_id", edges("neighbour = 'next'", "w2.e21_22"), "neighbour \"next\" is no id"},
        Damage{"distance_to_none", edges("street = NULL"), "a street without distance, or a distance to none"},
        Damage{"points_no_list", edges("points = 'n1,n2'"), "points \"n1,n2\" is no list of nodes"},
        Damage{"points_of_ways", edges("points = 'w1'"), "points \"w1\" is no list of nodes"},
        Damage{"point_of_two", edges("points = 'n72'"),
               "w2.e20_21: layer facade_edges: its point n72 stands at another"},
        Damage{"entrances", edges("entrances = 4", "w1.e10_11"), "4 entrances among 3 points"},
        Damage{"number_of_none", edges("house_numbers = '5'"), "house numbers without a point that has them"},
        Damage{"trees", edges("trees = -1"), "trees \"-1\" is no count"},
        Damage{"bulge", edges("arc_bulge = NULL", "w4.e42_43"), "a curve without radius or bulge"},
        Damage{"index", "DELETE FROM rtree_facade_edges_geom WHERE id = 3",
               "facade_edges: the spatial index has 17 entries for 18 geometries"},
        Damage{"position", "UPDATE buildings SET position = 'lost' WHERE id = 'w1'",
               "w1: layer buildings: position \"lost\""},
        Damage{"block_of_none", "UPDATE buildings SET block = 'w1.n1.r' WHERE id = 'w1'",
               "its block w1.n1.r is not in the layer blocks"},
        Damage{"courtyard_of_none", "UPDATE buildings SET courtyards = 'w1.y7_8 w1.y0_0' WHERE id = 'w1'",
               "its courtyard w1.y0_0 is not in the layer courtyards"},
        Damage{"shifts", "UPDATE buildings SET mean_shift = 0.4 WHERE id = 'w2'",
               "mean_shift 0.4 is more than max_shift 0.31"},
        Damage{"gaps", "UPDATE buildings SET gaps_closed = 5 WHERE id = 'w2'", "5 gaps closed, but 2 shared walls"},
        Damage{"depth", "UPDATE buildings SET depth = -2.0 WHERE id = 'w2'", "depth \"-2.0\" is no number"},
        Damage{"block_kind", "UPDATE blocks SET kind = 'park'", "kind \"park\" is unknown"},
        Damage{"block_area", "UPDATE blocks SET area = area + 1", "area is 4201.0, its polygon has 4200.000"},
        Damage{"block_share", "UPDATE blocks SET built_share = 1.3", "built_share \"1.3\""},
        Damage{"block_cut", "UPDATE blocks SET cut_by_extract_edge = 1", "built_share of a block that gives no ratios"},
        Damage{"block_doubled",
               "UPDATE blocks SET fid = 7; INSERT INTO blocks SELECT 8 AS fid, geom, id, kind, area, "
               "cut_by_extract_edge, too_large, buildings, built_share, tagged_share, floor_area_ratio, "
               "closure, front_length, courtyard_area, courtyards, streets FROM blocks",
               "OBJECT_DOUBLED w900.n5.l"},
        Damage{"courtyard_closed", "UPDATE courtyards SET closed = 1",
               "w1.y7_8: layer courtyards: closed, with an opening"},
        Damage{"courtyard_buildings", "UPDATE courtyards SET buildings = 3", "3 buildings around it, 2 ids"},
        Damage{"courtyard_block", "UPDATE courtyards SET block = 'w7.n7.l'", "its block w7.n7.l is not in the layer"},
        Damage{"courtyard_area", "UPDATE courtyards SET area = 400.0", "area is 400.0, its polygon has 500.000"},
        Damage{"cell_id", "UPDATE cells SET id = 'c1565_23276'", "the id does not fit its place, which is c1564_23276"},
        Damage{"cell_size", "UPDATE cells SET size = 200.0", "it is no square of 200.0 m on the grid"},
        Damage{"cell_quartiles", "UPDATE cells SET footprint_median = 300.0",
               "its quartiles of footprints are not in order"},
        Damage{"cell_share", "UPDATE cells SET tagged_share = 1.2", "tagged_share \"1.2\""},
        Damage{"cell_covered", "UPDATE cells SET covered_share = 1.5", "covered_share \"1.5\""},
        Damage{"cell_cut", "UPDATE cells SET covered_share = 0.5, built_share = 0.2",
               "built_share of a cell that the data"},
        Damage{"cell_empty", "UPDATE cells SET buildings = 0", "a cell without buildings"}),
    [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace blockrand::validate
