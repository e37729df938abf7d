// A sound GeoPackage has no findings, and each planted damage has its own.
#include "pipeline/validate/geopackage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "pipeline/validate/geopackage_blob.h"
#include "tests/unit/outputs/row_sample.h"
#include "tests/unit/outputs/sample_region.h"
#include "tests/unit/outputs/surroundings_sample.h"

namespace blockrand::validate {
namespace {

namespace fs = std::filesystem;
using outputs::test::SampleRegion;
using testing::ElementsAre;
using testing::IsEmpty;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "blockrand-readgpkg-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

/// What the stages before the export see to: every attribute is there, plans lie on the grid.
void complete(model::Region& region) {
  for (model::Building& b : region.buildings) {
    b.attributes = b.parts.front().attributes;
    for (model::BuildingPart& part : b.parts)
      for (model::Point2& p : part.plan.outer.points) p = model::snap(p);
  }
}

/// Two tiles: the zoo and a few houses. \param surroundings  with layers of what stands around
void write_sound(const std::string& path, bool surroundings = false) {
  SampleRegion zoo = SampleRegion::zoo(), houses = SampleRegion::settlement(40, true);
  houses.region().tile.x += 1;
  outputs::GeoPackageWriter writer(path, {"EPSG:25833", "2024-05-01T00:00:00Z", "", "", false, surroundings});
  writer.add(outputs::surrounding_rows(outputs::test::sample_surroundings(), outputs::test::sample_catalogue()));
  for (SampleRegion* sample : {&zoo, &houses}) {
    complete(sample->region());
    const outputs::GeoPackageRows rows = outputs::geopackage_rows(sample->region(), 2);
    writer.add(rows);
    const double x = 391000 + (sample == &zoo ? 0 : 1000);
    writer.add_tile({sample->region().tile,
                     "tiles/a.glb",
                     rows.buildings.rows(),
                     rows.parts.rows(),
                     100,
                     {{x, 5819000}, {x + 600, 5819000}, {x + 600, 5819400}, {x, 5819400}}});
  }
  writer.add_reported({{model::OsmType::node, 5},
                       model::ObjectKind::building,
                       model::ObjectState::reported,
                       model::IssueCode::node_only,
                       "",
                       std::nullopt,
                       model::Point2{391000, 5819000}});
  writer.add_reported({{model::OsmType::way, 15},
                       model::ObjectKind::building_part,
                       model::ObjectState::duplicate,
                       {},
                       "",
                       model::OsmId{model::OsmType::way, 12},
                       std::nullopt});
  writer.close();
}

/// Every finding as "CODE object: detail".
std::vector<std::string> findings(const std::string& path) {
  FindingLog log;
  GeoPackageReader reader(path, "buildings.gpkg");
  if (reader.check(log))
    for (const std::string& tile : reader.tiles()) log.add(std::move(reader.rows(tile).contents.findings));
  std::vector<std::string> out;
  for (const Finding& f : log.kept()) {
    EXPECT_EQ(f.file, "buildings.gpkg");
    out.push_back(std::string(info(f.check).text) + " " + f.object + ": " + f.detail);
  }
  return out;
}

/// Sound file, made once.
const std::string& sound() {
  static const Folder folder;
  static const std::string path = [] {
    write_sound(folder / "sound.gpkg");
    return folder / "sound.gpkg";
  }();
  return path;
}

TEST(ReadGeoPackage, FindsNothingInASoundFile) { EXPECT_THAT(findings(sound()), IsEmpty()); }

TEST(ReadGeoPackage, ReadsWhatWasWritten) {
  GeoPackageReader reader(sound(), "buildings.gpkg");
  EXPECT_EQ(reader.srs_id(), 25833);
  EXPECT_THAT(reader.tiles(), ElementsAre("15/17600/12900", "15/17601/12900"));
  const GeoPackageTileRows rows = reader.rows("15/17600/12900");
  EXPECT_THAT(rows.contents.buildings, ElementsAre("w-7", "w12", "w30", "w40", "w50", "w60"));
  ASSERT_EQ(rows.contents.bodies.size(), 9u);
  const ReadBody& body = rows.contents.bodies[1];
  EXPECT_EQ(body.id, "w12");
  EXPECT_EQ(body.building, "w12");
  EXPECT_EQ(body.attributes.at("storeys"), "3");
  EXPECT_EQ(body.attributes.at("storeys_source"), "neighbours");
  EXPECT_EQ(body.attributes.at("storeys_confidence"), "0.6");
  EXPECT_EQ(body.attributes.at("roof_direction"), "90");
  EXPECT_EQ(body.attributes.at("built_roof"), "gabled");
  EXPECT_EQ(body.attributes.at("lod"), "2");
  EXPECT_EQ(body.attributes.at("wall_colour"), "#decdaa");
  EXPECT_EQ(rows.contents.bodies[0].attributes.count("roof_direction"), 0u);
  ASSERT_EQ(body.footprint.size(), 1u);
  ASSERT_EQ(body.footprint[0].rings.size(), 1u);
  EXPECT_EQ(body.footprint[0].rings[0].size(), 4u);
  EXPECT_EQ(body.footprint[0].rings[0][0].x, 391020.123046875);
  EXPECT_EQ(rows.contents.bodies[5].footprint.at(0).rings.size(), 2u) << "a courtyard";
  EXPECT_EQ(rows.buildings.at(2).footprint.size(), 3u);
  EXPECT_EQ(rows.buildings.at(5).state, "reported");
  EXPECT_THAT(reader.rows("15/0/0").contents.buildings, IsEmpty());
  const auto reported = reader.reported();
  ASSERT_EQ(reported.size(), 2u);
  EXPECT_EQ(reported[0].code, "NODE_ONLY");
  ASSERT_TRUE(reported[0].place);
  EXPECT_EQ(*reported[0].place, (model::Point2{391000, 5819000}));
  EXPECT_EQ(reported[1].related, "w12");
  EXPECT_FALSE(reported[1].place);
  const auto tiles = reader.tile_rows();
  ASSERT_EQ(tiles.size(), 2u);
  EXPECT_EQ(tiles[1].buildings, 40);
  EXPECT_FALSE(fs::exists(sound() + "-journal"));
}

// ---- planted damage
// -----------------------------------------------------------------------------------------------------

struct Damage {
  std::string name, sql;
  std::string finding;  ///< that some finding must contain
};

void change(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  // GDAL's triggers call functions that only GDAL has.
  sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  char* error = nullptr;
  ASSERT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &error), SQLITE_OK) << error;
  sqlite3_close(db);
}

TEST(ReadGeoPackage, LayersOfSurroundingsAreJudgedToo) {
  const Folder folder;
  const std::string path = folder / "around.gpkg";
  write_sound(path, true);
  EXPECT_THAT(findings(path), IsEmpty());
  change(path, "PRAGMA foreign_keys=OFF; DELETE FROM gpkg_contents WHERE table_name = 'surrounding_objects'");
  EXPECT_THAT(findings(path), testing::Contains(testing::HasSubstr("surrounding_objects")));
}

/// SQL that replaces bytes of a geometry; `at` counts from 0.
std::string bytes_of_geometry(const std::string& table, const std::string& id, int at, const std::string& hex) {
  const auto n = hex.size() / 2;
  return "UPDATE " + table + " SET geom = CAST(substr(geom, 1, " + std::to_string(at) + ") || x'" + hex +
         "' || substr(geom, " + std::to_string(static_cast<std::size_t>(at) + n + 1) + ") AS BLOB) WHERE id = '" + id +
         "'";
}

class Planted : public testing::TestWithParam<Damage> {};

TEST_P(Planted, IsFound) {
  const Folder folder;
  const std::string path = folder / "damaged.gpkg";
  fs::copy_file(sound(), path);
  change(path, GetParam().sql);
  const auto found = findings(path);
  EXPECT_THAT(found, testing::Contains(testing::HasSubstr(GetParam().finding)));
}

// A geometry: 8 bytes of header, 32 of envelope, then byte order, type (4), rings (4), points (4), coordinates.
constexpr int kWkb = 40, kFirstPoint = kWkb + 13;

INSTANTIATE_TEST_SUITE_P(
    All, Planted,
    testing::Values(
        Damage{"application", "PRAGMA application_id = 7", "GEOPACKAGE_RULE : application_id is 7"},
        Damage{"version", "PRAGMA user_version = 3", "user_version 3"},
        Damage{"table", "DROP TABLE gpkg_extensions", "GEOPACKAGE_RULE gpkg_extensions: the table is missing"},
        Damage{"layer", "DROP TABLE reported", "GEOPACKAGE_RULE reported: the table is missing"},
        Damage{"column", "ALTER TABLE parts DROP COLUMN height_confidence", "the column height_confidence is missing"},
        Damage{"unregistered", "PRAGMA foreign_keys=OFF; DELETE FROM gpkg_contents WHERE table_name = 'tiles'",
               "tiles: 0 rows of gpkg_contents"},
        Damage{"extent", "UPDATE gpkg_contents SET max_x = max_x - 5 WHERE table_name = 'buildings'",
               "buildings: the extent in gpkg_contents does not hold the layer"},
        Damage{"kind_of_layer", "UPDATE gpkg_contents SET data_type = 'attributes' WHERE table_name = 'parts'",
               "parts: gpkg_contents calls it attributes"},
        Damage{"time", "UPDATE gpkg_contents SET last_change = 'yesterday'", "last_change \"yesterday\" is no time"},
        Damage{"geometry_columns",
               "UPDATE gpkg_geometry_columns SET geometry_type_name = 'POINT' WHERE table_name = 'parts'",
               "parts: gpkg_geometry_columns registers geom POINT"},
        Damage{"reference_system", "UPDATE gpkg_spatial_ref_sys SET organization = 'NONE' WHERE srs_id = 25833",
               "its reference system 25833 is not one of EPSG's"},
        Damage{"magic", bytes_of_geometry("parts", "w12", 0, "5858"),
               "GEOPACKAGE_RULE w12: geometry: does not begin with"},
        Damage{"srs_of_geometry", bytes_of_geometry("parts", "w12", 4, "E6100000"),
               "w12: geometry: its reference system is 4326"},
        Damage{"envelope", bytes_of_geometry("buildings", "w12", 8, "0000000000000000"),
               "w12: geometry: the envelope in the header is not that of the geometry"},
        Damage{"type", bytes_of_geometry("parts", "w12", kWkb + 1, "06000000"),
               "w12: geometry: geometry type 6 where 3 belongs"},
        Damage{"open_ring", bytes_of_geometry("parts", "w12", kFirstPoint, "0000000000E01741"),
               "w12: geometry: a ring that is not closed"},
        Damage{"not_a_number", bytes_of_geometry("parts", "w12", kFirstPoint + 16, "000000000000F87F"),
               "w12: geometry: a coordinate that is no number"},
        Damage{"cut_short", "UPDATE parts SET geom = substr(geom, 1, length(geom) - 3) WHERE id = 'w12'",
               "w12: geometry: the geometry is cut short"},
        Damage{"bytes_behind", "UPDATE parts SET geom = CAST(geom || x'00' AS BLOB) WHERE id = 'w12'",
               "w12: geometry: 1 bytes behind"},
        Damage{"off_grid", bytes_of_geometry("parts", "w12", kFirstPoint + 16, "01"), "OFF_GRID w12"},
        Damage{"no_geometry", "UPDATE parts SET geom = NULL WHERE id = 'w12'", "w12: no geometry in the layer parts"},
        Damage{"point", bytes_of_geometry("reported", "n5", 4, "00000000"),
               "n5: layer reported, geometry: its reference system is 0"},
        Damage{"index_entry_lost", "DELETE FROM rtree_parts_geom WHERE id = 3",
               "parts: the spatial index has 48 entries for 49 geometries"},
        Damage{"index_box_moved", "UPDATE rtree_parts_geom SET maxx = maxx + 50 WHERE id = 2",
               "w12: layer parts: the spatial index has no or a wrong box"},
        Damage{"index_missing", "DROP TABLE rtree_tiles_geom", "tiles: the spatial index rtree_tiles_geom is missing"},
        Damage{"index_unregistered", "DELETE FROM gpkg_extensions WHERE table_name = 'parts'",
               "parts: gpkg_extensions does not register"},
        Damage{"feature_count", "UPDATE gpkg_ogr_contents SET feature_count = 7 WHERE table_name = 'parts'",
               "gpkg_ogr_contents says 7 rows, it has 49"},
        Damage{"surface_of_nobody", "UPDATE surfaces SET body = 'w999' WHERE body = 'w12'",
               "no body of the layer parts"},
        Damage{"surface_lost", "DELETE FROM surfaces WHERE id = 'w12/1'",
               "w12: layer surfaces: its faces are not closed"},
        Damage{"surfaces_lost", "DELETE FROM surfaces WHERE body = 'w12'", "w12: the layer surfaces does not have it"},
        Damage{"surface_class", "UPDATE surfaces SET class = 'attic' WHERE id = 'w12/0'",
               "w12/0: layer surfaces: class \"attic\" is unknown"},
        Damage{"surface_colour", "UPDATE surfaces SET colour = 'red' WHERE id = 'w12/0'",
               "w12/0: layer surfaces: colour \"red\" is none"},
        Damage{"surface_count", "UPDATE surfaces SET faces = faces + 1 WHERE id = 'w12/0'",
               "w12/0: layer surfaces: says"},
        Damage{"surface_moved", bytes_of_geometry("surfaces", "w12/0", 56 + 18 + 16, "0000000000005940"),
               "w12: layer surfaces: its faces are not closed"},
        Damage{"no_styles", "DROP TABLE layer_styles", "layer_styles: the table is missing"},
        Damage{"style_not_xml", "UPDATE layer_styles SET styleQML = replace(styleQML, '</qgis>', '') WHERE id = 2",
               "style \"Roofs\" of buildings is no well-formed XML"},
        Damage{"two_defaults", "UPDATE layer_styles SET useAsDefault = 1", "buildings: 7 styles are its default"},
        Damage{"style_of_nothing", "UPDATE layer_styles SET f_geometry_column = 'shape' WHERE id = 1",
               "QGIS does not find the layer"},
        Damage{
            "described_column",
            "UPDATE gpkg_data_columns SET column_name = 'hight' WHERE column_name = 'height' AND table_name = 'parts'",
            "parts: gpkg_data_columns describes hight"},
        Damage{"source", "UPDATE parts SET height_source = 'rumour' WHERE id = 'w12'",
               "SOURCE_WRONG w12: height: source \"rumour\" is unknown"},
        Damage{"no_source", "UPDATE buildings SET use_source = NULL WHERE id = 'w12'",
               "SOURCE_WRONG w12: use: source \"\""},
        Damage{"confidence", "UPDATE parts SET height_confidence = 1.5 WHERE id = 'w12'",
               "SOURCE_WRONG w12: height: confidence \"1.5\""},
        Damage{"source_of_nothing", "UPDATE parts SET roof_direction_source = 'tag' WHERE id = 'w40'",
               "SOURCE_WRONG w40: roof_direction"},
        Damage{"value", "UPDATE parts SET storeys = 'many' WHERE id = 'w12'", "w12: storeys is no number but \"many\""},
        Damage{"colour", "UPDATE parts SET roof_colour = 'red' WHERE id = 'w12'", "w12: roof_colour cannot be \"red\""},
        Damage{"roof", "UPDATE buildings SET built_roof = 'thatch' WHERE id = 'w12'",
               "w12: built_roof \"thatch\" is unknown"},
        Damage{"lod", "UPDATE parts SET lod = 4 WHERE id = 'w12'", "w12: lod \"4\""},
        Damage{"area", "UPDATE parts SET footprint_area = footprint_area + 1 WHERE id = 'w12'",
               "w12: footprint_area is"},
        Damage{"fallback", "UPDATE parts SET fallbacks = 'ROOF_FAILED OOPS' WHERE id = 'w30.w32'",
               "w30.w32: fallbacks \"ROOF_FAILED OOPS\" are no codes"},
        Damage{"tags", "UPDATE buildings SET tags = '{\"a\":1}' WHERE id = 'w12'",
               "w12: tags are no JSON object of texts"},
        Damage{"id", "UPDATE buildings SET osm_number = 13 WHERE id = 'w12'", "w12: the id does not fit"},
        Damage{"state", "UPDATE buildings SET state = 'fine' WHERE id = 'w12'", "w12: state \"fine\" is unknown"},
        Damage{"body_lost", "DELETE FROM parts WHERE id = 'w30.w32'", "w30: says 3 parts, its tile holds 2 rows"},
        Damage{"building_lost", "DELETE FROM buildings WHERE id = 'w30'",
               "w30: 3 rows of the layer parts belong to it"},
        Damage{"body_of_another", "UPDATE parts SET building = 'w12' WHERE id = 'w30.w32'",
               "w30.w32: the id does not begin with"},
        Damage{"doubled", "UPDATE parts SET id = 'w30.w31' WHERE id = 'w30.w32'", "OBJECT_DOUBLED w30.w31"},
        Damage{"moved_to_a_tile", "UPDATE buildings SET tile = '15/1/1' WHERE id = 'w12'",
               "COUNTS_DIFFER 15/1/1: the layer tiles lacks it"},
        Damage{"count_of_a_tile", "UPDATE tiles SET buildings = 3",
               "COUNTS_DIFFER 15/17601/12900: the layer tiles says 3 buildings"},
        Damage{"code", "UPDATE reported SET code = 'WHY' WHERE id = 'n5'", "n5: code \"WHY\" is unknown"},
        Damage{"nobody_stands_for_it", "UPDATE reported SET related = NULL WHERE id = 'w15'",
               "w15: state duplicate without the object"}),
    [](const auto& param) { return param.param.name; });

TEST(PlantedBytes, ADamagedPageIsFound) {
  const Folder folder;
  const std::string path = folder / "damaged.gpkg";
  fs::copy_file(sound(), path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(fs::file_size(path) / 4096 / 2 * 4096));
    file.write("damaged!damaged!", 16);
  }
  EXPECT_THAT(findings(path), testing::Contains(testing::HasSubstr("FILE_UNREADABLE : SQLite")));
}

TEST(PlantedBytes, ATruncatedFileIsFound) {
  const Folder folder;
  const std::string path = folder / "damaged.gpkg";
  fs::copy_file(sound(), path);
  fs::resize_file(path, fs::file_size(path) * 2 / 3);
  EXPECT_THAT(findings(path), testing::Contains(testing::HasSubstr("FILE_UNREADABLE : SQLite")));
}

TEST(PlantedBytes, NoFileAndAnotherFileAreFound) {
  const Folder folder;
  EXPECT_THAT(findings(folder / "absent.gpkg"), ElementsAre(testing::HasSubstr("FILE_UNREADABLE")));
  std::ofstream(folder / "text.gpkg") << "This is no database at all, but it is long enough to be looked at as one.";
  EXPECT_THAT(findings(folder / "text.gpkg"), ElementsAre(testing::HasSubstr("FILE_UNREADABLE")));
  std::ofstream(folder / "empty.gpkg").flush();
  EXPECT_THAT(findings(folder / "empty.gpkg"), testing::Contains(testing::HasSubstr("the table is missing")));
}

TEST(PlantedBytes, AJournalBesideTheFileIsFound) {
  const Folder folder;
  const std::string path = folder / "a.gpkg";
  fs::copy_file(sound(), path);
  // A program that only looks leaves an empty one.
  std::ofstream(path + "-wal") << "";
  EXPECT_THAT(findings(path), IsEmpty());
  std::ofstream(path + "-wal") << "x";
  EXPECT_THAT(findings(path),
              ElementsAre(testing::StartsWith("GEOPACKAGE_RULE : a wal file lies beside it that was not played back")));
}

TEST(PlantedBytes, NoSingleByteEndsTheProgram) {
  const Folder folder;
  const std::string path = folder / "damaged.gpkg";
  const auto size = fs::file_size(sound());
  std::uint64_t state = 7;
  int noticed = 0;
  constexpr int kTries = 60;
  for (int i = 0; i < kTries; ++i) {
    fs::copy_file(sound(), path, fs::copy_options::overwrite_existing);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    for (int j = 0; j < 20; ++j) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      file.seekp(static_cast<std::streamoff>((state >> 20) % size));
      file.put(static_cast<char>(state >> 50));
    }
    file.close();
    noticed += !findings(path).empty();
  }
  EXPECT_GT(noticed, kTries * 3 / 4) << "twenty bytes in a file rarely go unseen";
}

}  // namespace
}  // namespace blockrand::validate
