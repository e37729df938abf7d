// The GeoPackage is read back with SQLite, which shares nothing with GDAL's driver but the file.
#include <cpl_conv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "pipeline/base/error.h"
#include "pipeline/layer_file/well_known_binary.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/outputs/geopackage/columns.h"
#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "pipeline/outputs/geopackage/qgis_styles.h"
#include "tests/unit/outputs/row_sample.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs {
namespace {

using test::SampleRegion;
using testing::ElementsAre;
using testing::HasSubstr;

namespace fs = std::filesystem;

const GeoPackageOptions kOptions{"EPSG:25833", "2024-05-01T12:34:56Z", "heights above local ground", "a test"};

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "blockrand-gpkg-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename());
    return names;
  }

 private:
  fs::path path_;
};

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Rows of a query; NULL reads "NULL".
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

std::vector<std::string> column(const std::string& path, const std::string& sql) {
  std::vector<std::string> out;
  for (auto& row : query(path, sql)) out.push_back(std::move(row.at(0)));
  return out;
}

GeoPackageReported reported_node() {
  return {{model::OsmType::node, 5},
          model::ObjectKind::building,
          model::ObjectState::reported,
          model::IssueCode::node_only,
          "building=yes",
          std::nullopt,
          model::Point2{391000.5, 5819000.25}};
}
GeoPackageReported duplicate_way() {
  return {{model::OsmType::way, 15},
          model::ObjectKind::building_part,
          model::ObjectState::duplicate,
          {},
          "",
          model::OsmId{model::OsmType::way, 12},
          std::nullopt};
}
GeoPackageTile a_tile() {
  return {{15, 17600, 12900},
          "tiles/15/17600/12900.glb",
          6,
          9,
          4321,
          {{391000, 5819000}, {391600, 5819000}, {391600, 5819400}, {391000, 5819400}}};
}

void write_zoo(const std::string& path) {
  const SampleRegion zoo = SampleRegion::zoo();
  GeoPackageWriter writer(path, kOptions);
  writer.add(geopackage_rows(zoo.region(), 2));
  writer.add_reported(reported_node());
  writer.add_reported(duplicate_way());
  writer.add_tile(a_tile());
  writer.close();
}

/// The zoo in a file, made once.
class GeoPackage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new Folder;
    path = *folder / "zoo.gpkg";
    write_zoo(path);
  }
  static void TearDownTestSuite() { delete folder; }
  static inline Folder* folder = nullptr;
  static inline std::string path;
};

TEST(WellKnownBinary, RingsRunAsTheStandardWantsHoweverTheyCome) {
  const std::vector<model::Point2> outer{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, court{{3, 3}, {3, 6}, {6, 6}, {6, 3}};
  const auto turned = [](std::vector<model::Point2> points) {
    std::reverse(points.begin() + 1, points.end());
    return points;
  };
  const auto bytes = [](const std::vector<model::Point2>& outer_ring, const std::vector<model::Point2>& hole) {
    std::string out;
    layer_file::append_polygon(out, {{outer_ring, {}}, {{hole, {}}}});
    return out;
  };
  const std::string right = bytes(outer, court);
  ASSERT_EQ(right.size(), 9 + 2 * (4 + 5 * 16u));
  double second[2];
  std::memcpy(second, right.data() + 9 + 4 + 16, sizeof second);
  EXPECT_EQ(second[0], 9) << "counter-clockwise";
  std::memcpy(second, right.data() + 9 + 4 + 5 * 16 + 4 + 16, sizeof second);
  EXPECT_EQ(second[1], 6) << "clockwise";
  EXPECT_EQ(bytes(turned(outer), court), right);
  EXPECT_EQ(bytes(outer, turned(court)), right);
  EXPECT_EQ(bytes(turned(outer), turned(court)), right);
}

TEST_F(GeoPackage, HoldsEveryOwnedBuildingAndBodyOnce) {
  EXPECT_THAT(column(path, "SELECT id FROM buildings"), ElementsAre("w-7", "w12", "w30", "w40", "w50", "w60"));
  EXPECT_THAT(column(path, "SELECT id FROM parts"),
              ElementsAre("w-7", "w12", "w30.w31", "w30.w32", "w30.rest", "w40", "w50.1", "w50.2", "w60"));
  EXPECT_THAT(column(path, "SELECT DISTINCT p.building FROM parts p JOIN buildings b ON b.id = p.building").size(), 6);
}

TEST_F(GeoPackage, EachAttributeHasValueSourceAndConfidence) {
  std::set<std::string> columns;
  for (const auto& c : column(path, "SELECT name FROM pragma_table_info('parts')")) columns.insert(c);
  int attributes = 0;
  model::Attributes all;
  const auto three = [&](const std::string& x) {
    ++attributes;
    EXPECT_TRUE(columns.contains(x) && columns.contains(x + "_source") && columns.contains(x + "_confidence")) << x;
  };
  model::for_each_attribute(
      all, [&](const char* x, auto, const auto&) { three(x); }, [&](const char* x, auto) { three(x); });
  EXPECT_EQ(attributes, 25);
  EXPECT_THAT(query(path,
                    "SELECT storeys, storeys_source, storeys_confidence, roof_shape, wall_colour, typeof(storeys),"
                    "roof_direction, roof_direction_source FROM parts WHERE id = 'w12'"),
              ElementsAre(ElementsAre("3.0", "neighbours", "0.6", "gabled", "#decdaa", "real", "90.0", "tag")));
  EXPECT_THAT(
      query(path,
            "SELECT roof_direction, roof_direction_source, roof_direction_confidence FROM parts WHERE id = 'w40'"),
      ElementsAre(ElementsAre("NULL", "NULL", "NULL")));
}

TEST(GeoPackageRows, ProbabilitiesOfTheStyleStandWhereThereAreSome) {
  SampleRegion sample;
  sample.region().buildings.reserve(2);
  model::Building& classified = sample.add_building(5, {});
  sample.add_box(classified, "w5", 391000, 5819000, 8, 8, 30, 9);
  classified.style.style = {0.1f, 0.2f, 0.66666f, 0.03334f};
  classified.style.morphology = {0.1f, 0.1f, 0.6f, 0.1f, 0.1f};
  model::Building& unknown = sample.add_building(6, {});
  sample.add_box(unknown, "w6", 391020, 5819000, 8, 8, 30, 9);
  const Folder folder;
  GeoPackageWriter writer(folder / "a.gpkg", kOptions);
  writer.add(geopackage_rows(sample.region(), 2));
  writer.close();
  const std::string columns =
      "SELECT style_p, p_gruenderzeit, p_tenement, p_modern, p_other, morphology FROM buildings WHERE id = ";
  EXPECT_THAT(query(folder / "a.gpkg", columns + "'w5'"),
              ElementsAre(ElementsAre("0.6667", "0.1", "0.2", "0.6667", "0.0333", "slab")));
  EXPECT_THAT(query(folder / "a.gpkg", columns + "'w6'"),
              ElementsAre(ElementsAre("NULL", "NULL", "NULL", "NULL", "NULL", "NULL")));
  EXPECT_EQ(column(folder / "a.gpkg", "SELECT type FROM pragma_table_info('buildings') WHERE name = 'style_p'").at(0),
            "REAL");
}

TEST_F(GeoPackage, BuildingsSayWhatStands) {
  EXPECT_THAT(
      query(path,
            "SELECT state, lod, parts, built_roof, footprint_area, volume, fallbacks FROM buildings WHERE id = 'w30'"),
      // Nave 30 x 14 with a gable from 50 to 58, tower 8 x 8 x 40, rest 5 x 5 x 4; the rest is the outline's own.
      ElementsAre(ElementsAre("modelled", "2", "3", "gabled", "509.0", "10955.0", "ROOF_FAILED ROOF_SHAPE_ADAPTED")));
  EXPECT_THAT(query(path, "SELECT lod, fallbacks FROM buildings WHERE id = 'w50'"),
              ElementsAre(ElementsAre("1", "LOD1_ONLY")));
  EXPECT_THAT(query(path, "SELECT state, lod FROM buildings WHERE id = 'w60'"),
              ElementsAre(ElementsAre("reported", "-1")))
      << "asked for LoD2, and no solid stands";
}

TEST(GeoPackageRows, ABuildingOfMappedPartsAloneIsRepresented) {
  SampleRegion sample;
  model::Building& b = sample.add_building(5, {{"building", "yes"}});
  sample.add_box(b, "w5.w6", 391000, 5819000, 8, 8, 30, 9).osm = {model::OsmType::way, 6};
  const GeoPackageRows rows = geopackage_rows(sample.region(), 2);
  ASSERT_EQ(rows.buildings.rows(), 1u);
  const auto columns = building_columns();
  const auto state = std::find_if(columns.begin(), columns.end(), [](const Column& c) { return c.name == "state"; });
  const Cell& cell = rows.buildings.cells.at(static_cast<std::size_t>(state - columns.begin()));
  EXPECT_STREQ(rows.buildings.texts.c_str() + cell.text, "represented");
}

TEST(GeoPackageRows, AFootprintOnlyBuildIsModelledAtLod0) {
  SampleRegion sample;
  model::Building& b = sample.add_building(5, {});
  sample.add_box(b, "w5", 391000, 5819000, 8, 8, 30, 9).lod = 0;
  const Folder folder;
  GeoPackageWriter writer(folder / "a.gpkg", kOptions);
  writer.add(geopackage_rows(sample.region(), 0));
  writer.close();
  EXPECT_THAT(query(folder / "a.gpkg", "SELECT state, lod FROM buildings"), ElementsAre(ElementsAre("modelled", "0")));
}

TEST_F(GeoPackage, TextsComeBackAsMapped) {
  EXPECT_THAT(column(path, "SELECT name FROM buildings WHERE id = 'w-7'"), ElementsAre("Zum \"Krokodil\" & <Söhne>"));
  EXPECT_THAT(column(path, "SELECT json_extract(tags, '$.description') FROM buildings WHERE id = 'w12'"),
              ElementsAre("]]> \xF0\x9F\x8F\xA0 'quoted'"));
  EXPECT_THAT(query(path, "SELECT address, postcode, street, house_number FROM buildings WHERE id = 'w12'"),
              ElementsAre(ElementsAre("Kastanienallee 12, 10435 Berlin", "10435", "Kastanienallee", "12")));
  EXPECT_THAT(column(path, "SELECT json_extract(tags, '$.\"building:part\"') FROM parts WHERE id = 'w30.w32'"),
              ElementsAre("tower"));
  EXPECT_THAT(column(path, "SELECT tags FROM parts WHERE id = 'w12'"), ElementsAre("NULL"))
      << "they stand with the building";
}

TEST_F(GeoPackage, GeometriesAreTheFootprints) {
  const auto blob = column(path, "SELECT geom FROM parts WHERE id = 'w40'").at(0);
  ASSERT_EQ(blob.substr(0, 4), std::string("GP\0\x03", 4));
  std::int32_t srs = 0;
  std::memcpy(&srs, blob.data() + 4, 4);
  EXPECT_EQ(srs, 25833);
  // Header with envelope, then: byte order, type, 2 rings, 5 points of 16 bytes, 5 points.
  EXPECT_EQ(blob.size(), 8u + 32 + 1 + 4 + 4 + 2 * (4 + 5 * 16));
  double first[2];
  std::memcpy(first, blob.data() + 8 + 32 + 1 + 4 + 4 + 4, 16);
  EXPECT_EQ(first[0], 391000.0);
  EXPECT_EQ(first[1], 5819040.0);
  EXPECT_THAT(
      query(path, "SELECT min_x, min_y, max_x, max_y, srs_id FROM gpkg_contents WHERE table_name = 'buildings'"),
      ElementsAre(ElementsAre("391000.0", "5819000.0", "391090.0", "5819080.0", "25833")));
}

TEST_F(GeoPackage, ObjectsNotModelledHaveTheirReasons) {
  EXPECT_THAT(
      query(path, "SELECT id, kind, state, code, meaning, detail, related, geom IS NULL FROM reported"),
      ElementsAre(ElementsAre("n5", "building", "reported", "NODE_ONLY",
                              std::string(info(model::IssueCode::node_only).meaning), "building=yes", "NULL", "0"),
                  ElementsAre("w15", "building_part", "duplicate", "NULL", "NULL", "NULL", "w12", "1")));
}

TEST_F(GeoPackage, TilesHaveTheirFiles) {
  EXPECT_THAT(
      query(path, "SELECT id, level, x, y, uri, buildings, parts, bytes FROM tiles"),
      ElementsAre(ElementsAre("15/17600/12900", "15", "17600", "12900", "tiles/15/17600/12900.glb", "6", "9", "4321")));
}

TEST_F(GeoPackage, IsAGeoPackage) {
  EXPECT_THAT(column(path, "PRAGMA application_id"), ElementsAre("1196444487"));  // "GPKG"
  EXPECT_THAT(column(path, "PRAGMA user_version"), ElementsAre("10300"));
  EXPECT_THAT(column(path, "PRAGMA integrity_check"), ElementsAre("ok"));
  EXPECT_THAT(column(path, "PRAGMA foreign_key_check"), ElementsAre());
  EXPECT_THAT(column(path, "PRAGMA journal_mode"), ElementsAre("delete"));
  for (const std::string layer :
       {"buildings", "parts", "facade_edges", "blocks", "courtyards", "cells", "reported", "tiles", "surfaces"}) {
    EXPECT_EQ(column(path, "SELECT count(*) FROM rtree_" + layer + "_geom"),
              column(path, "SELECT count(*) FROM " + layer + " WHERE geom IS NOT NULL"));
    EXPECT_EQ(column(path, "SELECT feature_count FROM gpkg_ogr_contents WHERE table_name = '" + layer + "'"),
              column(path, "SELECT count(*) FROM " + layer));
    EXPECT_EQ(
        column(path, "SELECT count(*) FROM gpkg_data_columns WHERE description != '' AND table_name = '" + layer + "'"),
        column(path, "SELECT count(*) - 2 FROM pragma_table_info('" + layer + "')"))
        << "every column but fid and geom says what it means";
  }
  EXPECT_THAT(query(path,
                    "SELECT title, description FROM gpkg_data_columns WHERE table_name = 'parts' AND column_name = "
                    "'roof_height'"),
              ElementsAre(ElementsAre("roof_height [m]", "From the eaves to the top of the roof. Unit: m")));
  EXPECT_THAT(folder->files(), ElementsAre("zoo.gpkg"));
}

TEST_F(GeoPackage, TheTimeIsThatOfTheData) {
  EXPECT_THAT(column(path, "SELECT DISTINCT last_change FROM gpkg_contents"), ElementsAre("2024-05-01T12:34:56.000Z"));
  EXPECT_THAT(column(path, "SELECT DISTINCT update_time FROM layer_styles"), ElementsAre("2024-05-01T12:34:56.000Z"));
}

TEST_F(GeoPackage, EveryLayerHasOneDefaultStyle) {
  EXPECT_THAT(query(path,
                    "SELECT f_table_name, count(*) FROM layer_styles WHERE useAsDefault AND f_table_schema = '' "
                    "AND f_geometry_column = 'geom' GROUP BY 1 ORDER BY 1"),
              ElementsAre(ElementsAre("blocks", "1"), ElementsAre("buildings", "1"), ElementsAre("cells", "1"),
                          ElementsAre("courtyards", "1"), ElementsAre("facade_edges", "1"), ElementsAre("parts", "1"),
                          ElementsAre("reported", "1"), ElementsAre("surfaces", "1"), ElementsAre("tiles", "1")));
  EXPECT_EQ(column(path, "SELECT styleQML FROM layer_styles ORDER BY id").size(), qgis_styles().size());
}

// ---- the same bytes
// -----------------------------------------------------------------------------------------------------

TEST(GeoPackageBytes, DoNotDependOnThreadsClockOrSettings) {
  const Folder folder;
  std::vector<SampleRegion> tiles;
  for (int i = 0; i < 6; ++i) tiles.push_back(SampleRegion::settlement(300, true));
  const auto write = [&](const std::string& name, bool threads) {
    std::vector<GeoPackageRows> rows(tiles.size());
    if (threads) {
      std::vector<std::jthread> workers;
      for (std::size_t i = 0; i < tiles.size(); ++i)
        workers.emplace_back([&, i] { rows[i] = geopackage_rows(tiles[i].region(), 2); });
    } else {
      for (std::size_t i = 0; i < tiles.size(); ++i) rows[i] = geopackage_rows(tiles[i].region(), 2);
    }
    GeoPackageWriter writer(folder / name, kOptions);
    for (const GeoPackageRows& r : rows) {
      if (threads)
        std::jthread([&] { writer.add(r); }).join();
      else
        writer.add(r);
    }
    writer.add_reported(reported_node());
    writer.add_tile(a_tile());
    writer.close();
    return bytes_of(folder / name);
  };
  const std::string one = write("one.gpkg", false);
  ASSERT_GT(one.size(), 1'000'000u);
  // What the user's environment may say to GDAL.
  CPLSetConfigOption("OGR_CURRENT_DATE", "2031-01-01T00:00:00.000Z");
  CPLSetConfigOption("OGR_SQLITE_JOURNAL", "WAL");
  const std::string two = write("two.gpkg", true);
  EXPECT_STREQ(CPLGetConfigOption("OGR_CURRENT_DATE", ""), "2031-01-01T00:00:00.000Z") << "others' settings stay";
  CPLSetConfigOption("OGR_CURRENT_DATE", nullptr);
  CPLSetConfigOption("OGR_SQLITE_JOURNAL", nullptr);
  EXPECT_TRUE(one == two);
  EXPECT_EQ(CPLGetConfigOption("OGR_SQLITE_SYNCHRONOUS", nullptr), nullptr) << "no setting of ours stays";
  EXPECT_THAT(folder.files(), testing::UnorderedElementsAre("one.gpkg", "two.gpkg"));
}

TEST(GeoPackageBytes, AnEmptyBuildIsAFileWithEmptyLayers) {
  const Folder folder;
  GeoPackageWriter writer(folder / "empty.gpkg", {"EPSG:32633", "", "", ""});
  writer.close();
  EXPECT_THAT(column(folder / "empty.gpkg", "SELECT count(*) FROM buildings"), ElementsAre("0"));
  EXPECT_THAT(column(folder / "empty.gpkg", "SELECT DISTINCT last_change FROM gpkg_contents"),
              ElementsAre("1970-01-01T00:00:00.000Z"));
}

// ---- when it cannot be written
// ------------------------------------------------------------------------------------------

template <class F>
std::string output_error(const F& f) {
  try {
    f();
  } catch (const base::OutputError& error) {
    return error.what();
  }
  return "no OutputError";
}

TEST(GeoPackageErrors, NameThePlaceAndARemedy) {
  const Folder folder;
  const std::string path = folder / "no/such/folder.gpkg";
  testing::internal::CaptureStderr();
  const std::string said = output_error([&] { GeoPackageWriter(path, kOptions); });
  EXPECT_THAT(said, HasSubstr(path));
  EXPECT_THAT(said, HasSubstr("choose an output folder"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "GDAL keeps quiet";
  EXPECT_THAT(output_error([&] {
                GeoPackageWriter(folder / "a.gpkg", {"EPSG:999999", "", "", ""});
              }),
              HasSubstr("a.gpkg"));
  EXPECT_THAT(folder.files(), ElementsAre()) << "nothing half-written stays";
}

TEST(GeoPackageErrors, ALimitOnFilesIsAnOutputError) {
  const Folder folder;
  const SampleRegion sample = SampleRegion::settlement(1000, true);
  const GeoPackageRows rows = geopackage_rows(sample.region(), 2);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  auto* const handler = signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 600'000;
  setrlimit(RLIMIT_FSIZE, &small);
  testing::internal::CaptureStderr();
  const std::string said = output_error([&] {
    GeoPackageWriter writer(folder / "a.gpkg", kOptions);
    for (int i = 0; i < 60; ++i) writer.add(rows);
    writer.close();
  });
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  EXPECT_THAT(said, HasSubstr(folder / "a.gpkg"));
  EXPECT_THAT(said, HasSubstr("larger than the limit allows: raise it"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(folder.files(), ElementsAre());
}

TEST(GeoPackageErrors, AWriterThatWasNotClosedLeavesNothing) {
  const Folder folder;
  {
    const SampleRegion zoo = SampleRegion::zoo();
    GeoPackageWriter writer(folder / "a.gpkg", kOptions);
    writer.add(geopackage_rows(zoo.region(), 2));
  }
  EXPECT_THAT(folder.files(), ElementsAre());
}

// ---- styles
// -------------------------------------------------------------------------------------------------------------

/// Values of an XPath over a style.
std::vector<std::string> xpath(const std::string& xml, const char* path) {
  std::vector<std::string> out;
  xmlDoc* doc =
      xmlReadMemory(xml.data(), static_cast<int>(xml.size()), "style", nullptr, XML_PARSE_NONET | XML_PARSE_NOERROR);
  if (doc == nullptr) {
    ADD_FAILURE() << "not well-formed: " << xml.substr(0, 200);
    return out;
  }
  xmlXPathContext* context = xmlXPathNewContext(doc);
  xmlXPathObject* found = xmlXPathEvalExpression(reinterpret_cast<const xmlChar*>(path), context);
  for (int i = 0; found->nodesetval && i < found->nodesetval->nodeNr; ++i) {
    xmlChar* text = xmlNodeGetContent(found->nodesetval->nodeTab[i]);
    out.emplace_back(reinterpret_cast<const char*>(text));
    xmlFree(text);
  }
  xmlXPathFreeObject(found);
  xmlXPathFreeContext(context);
  xmlFreeDoc(doc);
  return out;
}

TEST(QgisStyles, EveryClassHasASymbol) {
  for (const QgisStyle& style : qgis_styles()) {
    SCOPED_TRACE(style.layer + ": " + style.name);
    EXPECT_LE(style.name.size(), 30u) << "as wide as the column";
    const auto symbols = xpath(style.qml, "/qgis/renderer-v2/symbols/symbol/@name");
    auto used =
        xpath(style.qml, "/qgis/renderer-v2/categories/category/@symbol | /qgis/renderer-v2/ranges/range/@symbol");
    if (used.empty()) used = {"0"};  // a single symbol
    EXPECT_EQ(symbols, used);
    const auto colours = xpath(style.qml, "//symbol/layer/Option/Option[@name='color' or @name='line_color']/@value");
    EXPECT_EQ(colours.size(), symbols.size());
    EXPECT_EQ(std::set<std::string>(colours.begin(), colours.end()).size(), colours.size()) << "two classes look alike";
    const char* const geometry = style.layer == "reported" ? "0" : style.layer == "facade_edges" ? "1" : "2";
    EXPECT_THAT(xpath(style.qml, "/qgis/layerGeometryType"), ElementsAre(geometry));
  }
}

TEST(QgisStyles, KnowEveryValue) {
  std::map<std::string, std::set<std::string>> values;
  for (const QgisStyle& style : qgis_styles())
    for (const auto& v : xpath(style.qml, "//category/@value")) values[style.layer + "/" + style.name].insert(v);
  for (const std::string_view shape : model::kRoofShapeNames)
    EXPECT_TRUE(values["buildings/Roofs"].contains(std::string(shape)) &&
                values["parts/Roofs"].contains(std::string(shape)))
        << shape;
  for (int i = 0; i < model::kSourceCount; ++i)
    EXPECT_TRUE(values["buildings/Source of the storeys"].contains(std::string(name(static_cast<model::Source>(i)))));
  for (int i = 1; i < model::kBuildingPositionCount; ++i)
    EXPECT_TRUE(values["buildings/Position"].contains(std::string(name(static_cast<model::BuildingPosition>(i)))));
  for (const model::IssueInfo& about : model::kIssueInfo)
    EXPECT_EQ(values["reported/Reasons"].contains(std::string(about.text)),
              about.issue_class == model::IssueClass::reported)
        << about.text;
}

TEST(QgisStyles, AttributesAreColumns) {
  std::map<std::string, std::set<std::string>> columns;
  for (const Column& c : building_columns()) columns["buildings"].insert(c.name);
  for (const Column& c : part_columns()) columns["parts"].insert(c.name);
  for (const Column& c : wall_segment_columns()) columns["facade_edges"].insert(c.name);
  for (const Column& c : block_columns()) columns["blocks"].insert(c.name);
  for (const Column& c : courtyard_columns()) columns["courtyards"].insert(c.name);
  for (const Column& c : cell_columns()) columns["cells"].insert(c.name);
  for (const Column& c : surface_columns()) columns["surfaces"].insert(c.name);
  for (const QgisStyle& style : qgis_styles()) {
    if (style.layer == "reported") continue;  // an expression of two columns
    for (std::string attribute : xpath(style.qml, "/qgis/renderer-v2/@attr")) {
      if (attribute.starts_with("coalesce(\"")) attribute = attribute.substr(10, attribute.find('"', 10) - 10);
      EXPECT_TRUE(columns[style.layer].contains(attribute)) << style.layer << ' ' << attribute;
    }
  }
}

}  // namespace
}  // namespace blockrand::outputs
