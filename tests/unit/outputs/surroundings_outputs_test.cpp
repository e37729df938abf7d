// What CityGML, CityJSON and the GeoPackage say of the surroundings of a tile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <libxml/tree.h>
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "pipeline/base/pack.h"
#include "pipeline/outputs/citygml/surroundings_gml.h"
#include "pipeline/outputs/cityjson/surroundings_cityjson.h"
#include "pipeline/outputs/geopackage/dissolved_faces.h"
#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "pipeline/outputs/surrounding_objects.h"
#include "tests/unit/outputs/citygml_support.h"
#include "tests/unit/outputs/surroundings_sample.h"

namespace blockrand::outputs {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr model::TileId kTile{15, 17600, 12900};

CityGmlOptions gml_options() {
  CityGmlOptions o;
  o.srs_name = "urn:ogc:def:crs:EPSG::25833";
  o.height_reference = "heights above <local> ground";
  o.attribution = "\xC2\xA9 OpenStreetMap contributors, ODbL 1.0";
  o.name = "Blockrand 15/17600/12900";
  return o;
}

CityJsonOptions json_options() {
  CityJsonOptions o;
  o.crs_code = "EPSG:25833";
  o.height_reference = "heights above local ground";
  o.attribution = "\xC2\xA9 OpenStreetMap contributors, ODbL 1.0";
  o.name = "Blockrand 15/17600/12900";
  o.generator = "Blockrand 0";
  return o;
}

std::string gml() {
  return write_surroundings_gml(test::sample_surroundings(), test::sample_catalogue(), kTile, gml_options());
}

std::vector<json> sequence() {
  std::istringstream text(
      write_surroundings_cityjson(test::sample_surroundings(), test::sample_catalogue(), kTile, json_options()));
  std::vector<json> out;
  for (std::string line; std::getline(text, line);) out.push_back(json::parse(line));
  return out;
}

/// What a document has as ids, and what its references name.
struct Names {
  std::multiset<std::string> ids;
  std::set<std::string> named;
};

Names names_of(const std::string& text) {
  Names out;
  xmlDoc* doc = xmlReadMemory(text.data(), static_cast<int>(text.size()), "a.gml", nullptr, XML_PARSE_NONET);
  EXPECT_NE(doc, nullptr);
  const auto string = [](xmlChar* value) {
    const std::string out = value ? reinterpret_cast<const char*>(value) : "";
    xmlFree(value);
    return out;
  };
  const std::function<void(xmlNode*)> look = [&](xmlNode* node) {
    for (; node; node = node->next) {
      if (node->type != XML_ELEMENT_NODE) continue;
      for (xmlAttr* a = node->properties; a; a = a->next) {
        const std::string name = reinterpret_cast<const char*>(a->name),
                          value = string(xmlNodeListGetString(doc, a->children, 1));
        if (name == "id") out.ids.insert(value);
        if (name == "href") out.named.insert(value);
      }
      if (std::string(reinterpret_cast<const char*>(node->name)) == "target")
        out.named.insert(string(xmlNodeGetContent(node)));
      look(node->children);
    }
  };
  look(xmlDocGetRootElement(doc));
  xmlFreeDoc(doc);
  return out;
}

/// Points of all rings of a CityGML file, as texts.
std::set<std::string> gml_points(const std::string& text) {
  std::set<std::string> out;
  const std::string begin = "<posList>", implicit = "relativeGMLGeometry>";
  std::string plain = text;
  for (std::size_t at = plain.find("<core:" + implicit); at != std::string::npos; at = plain.find("<core:" + implicit))
    plain.erase(at, plain.find("</core:" + implicit) - at + 1);
  for (std::size_t at = plain.find(begin); at != std::string::npos; at = plain.find(begin, at + 1)) {
    std::istringstream list(plain.substr(at + begin.size(), plain.find('<', at + 1) - at - begin.size()));
    for (double x, y, z; list >> x >> y >> z;) {
      std::ostringstream point;
      point.precision(12);
      point << model::snap(x) << ' ' << model::snap(y) << ' ' << model::snap(z);
      out.insert(point.str());
    }
  }
  return out;
}

TEST(SurroundingsGml, ValidatesAgainstTheSchema) {
  if (!std::filesystem::exists(test::citygml_schemas() / "citygml2.xsd"))
    GTEST_SKIP() << "no CityGML schemas in " << test::citygml_schemas();
  EXPECT_EQ(test::schema_complaints(gml(), "blockrand_surroundings_schema"), "");
  // Every ground and every body alone.
  model::Surroundings all;
  for (std::size_t g = 0; g < model::kGroundClassCount; ++g) {
    const double x = static_cast<double>(g) * 2;
    model::GroundSurface s{
        static_cast<model::GroundClass>(g), {model::OsmType::way, static_cast<std::int64_t>(g)}, 0, 0, {}, {}};
    s.faces = {test::rectangle(x, 0, x + 1, 1)};
    s.edges = {{{test::at(x, 0), test::at(x, 0, -1), test::at(x, 1, -1)}, {}}};
    all.surfaces.push_back(s);
  }
  for (std::size_t b = 0; b < model::kBodyClassCount; ++b)
    for (const bool closed : {true, false})
      all.bodies.push_back({static_cast<model::BodyClass>(b),
                            {model::OsmType::way, static_cast<std::int64_t>(100 + 2 * b + closed)},
                            3,
                            closed,
                            test::cuboid(0, 50, 1, 51, 1)});
  const std::string text = write_surroundings_gml(all, test::sample_catalogue(), kTile, gml_options());
  EXPECT_EQ(test::times(text, "<core:cityObjectMember>"), model::kGroundClassCount + 2 * model::kBodyClassCount);
  EXPECT_EQ(test::schema_complaints(text, "blockrand_surroundings_schema"), "");
}

TEST(SurroundingsGml, IdsAreUniqueAndReferencesResolve) {
  const Names names = names_of(gml());
  EXPECT_THAT(names.ids, Not(IsEmpty()));
  EXPECT_EQ(std::set<std::string>(names.ids.begin(), names.ids.end()).size(), names.ids.size());
  EXPECT_THAT(names.named, Contains(HasSubstr("#s")));
  for (const std::string& name : names.named) {
    EXPECT_EQ(name.front(), '#') << name;
    EXPECT_EQ(names.ids.count(name.substr(1)), 1u) << name;
  }
}

TEST(SurroundingsGml, PiecesOfOneObjectAreOne) {
  const std::string text = gml();
  EXPECT_EQ(test::times(text, "<tran:Road "), 1u);
  EXPECT_THAT(text, HasSubstr("<core:uri>https://www.openstreetmap.org/way/10</core:uri>"));
  // Carriageway, pavement and marking; the kerbs.
  EXPECT_EQ(test::times(text, "<tran:TrafficArea gml:id=\"w10_"), 3u);
  EXPECT_EQ(test::times(text, "<tran:AuxiliaryTrafficArea gml:id=\"w10_"), 1u);
  EXPECT_THAT(text, HasSubstr("<tran:class>carriageway</tran:class>"));
  EXPECT_THAT(text, HasSubstr("<tran:function>carriageway</tran:function>\n<tran:usage>car</tran:usage>\n"
                              "<tran:surfaceMaterial>asphalt</tran:surfaceMaterial>"));
  EXPECT_THAT(text, HasSubstr("<tran:function>kerb</tran:function>"));
  EXPECT_THAT(text, HasSubstr("<gen:doubleAttribute name=\"offset\"><gen:value>-0.125</gen:value>"));
  // Bed and rails.
  EXPECT_EQ(test::times(text, "<tran:Railway "), 1u);
  EXPECT_THAT(text, HasSubstr("<tran:function>rail</tran:function>"));
  // A bridge of two materials, one of one.
  EXPECT_EQ(test::times(text, "<brid:Bridge "), 2u);
  EXPECT_EQ(test::times(text, "<brid:lod3MultiSurface>"), 1u);
  EXPECT_EQ(test::times(text, "<brid:lod3Solid>"), 1u);
  // What nothing is mapped for stays in its squares and has no reference.
  EXPECT_EQ(test::times(text, "<luse:LandUse gml:id=\"unmapped_"), 2u);
  // What has no area on the grid is left out.
  EXPECT_THAT(text, Not(HasSubstr("w61")));
}

TEST(SurroundingsGml, WaterIsOfPiecesThatHangTogether) {
  const std::string text = gml();
  EXPECT_EQ(test::times(text, "<wtr:WaterBody "), 1u);
  EXPECT_EQ(test::times(text, "<wtr:lod1MultiSurface>"), 1u);
  EXPECT_EQ(test::times(text, "<wtr:WaterSurface "), 2u);
  EXPECT_EQ(test::times(text, "<surfaceMember xlink:href=\"#w30_"), 3u);
}

TEST(SurroundingsGml, HolesAndHeightsComeBack) {
  const std::string text = gml();
  EXPECT_THAT(text, HasSubstr("<interior><LinearRing><posList>391010 5819009 35 391014 5819009 35 391014 5819005 35 "
                              "391010 5819005 35 391010 5819009 35</posList>"));
  EXPECT_THAT(text, HasSubstr("391000 5819000 34.875 391006 5819000 34.875"));
}

TEST(SurroundingsGml, EqualShapesStandOnce) {
  const std::string text = gml();
  EXPECT_EQ(test::times(text, "<veg:SolitaryVegetationObject "), 2u);
  EXPECT_EQ(test::times(text, "<core:relativeGMLGeometry>"), 2u) << "the tree and the lamp";
  EXPECT_EQ(test::times(text, "<core:relativeGMLGeometry xlink:href="), 1u);
  EXPECT_THAT(text,
              HasSubstr("<core:transformationMatrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</core:transformationMatrix>"));
  EXPECT_THAT(
      text,
      HasSubstr("<core:transformationMatrix>0 -0.5 0 0 0.5 0 0 0 0 0 1.25 0 0 0 0 1</core:transformationMatrix>"));
  EXPECT_THAT(text, HasSubstr("<core:referencePoint><Point><pos>391012 5819015 35.0625</pos>"));
  EXPECT_THAT(text,
              HasSubstr("<veg:height uom=\"m\">12.5</veg:height>\n<veg:crownDiameter uom=\"m\">3</veg:crownDiameter>"));
  EXPECT_EQ(test::times(text, "<frn:lod3ImplicitRepresentation>"), 1u);
  // A shape without a face is told without geometry.
  EXPECT_THAT(text, HasSubstr("<gen:class>mast</gen:class>"));
  EXPECT_EQ(test::times(text, "<gen:lod3ImplicitRepresentation>"), 0u);
  // Of the trunk the triangle without area is left out; bark and leaves look different.
  EXPECT_THAT(text, HasSubstr("<gml:name>leaves &amp; &lt;bark&gt; #50783c</gml:name>"));
}

TEST(SurroundingsGml, SaysWhatTheBuildingsSay) {
  const std::string text = gml();
  EXPECT_THAT(text,
              HasSubstr("<description>CRS: urn:ogc:def:crs:EPSG::25833; heights: heights above &lt;local&gt; ground; "
                        "data: \xC2\xA9 OpenStreetMap contributors, ODbL 1.0</description>"));
  EXPECT_THAT(text, HasSubstr("<gml:name>Blockrand 15/17600/12900</gml:name>"));
  EXPECT_THAT(text, HasSubstr("<Envelope srsName=\"urn:ogc:def:crs:EPSG::25833\" srsDimension=\"3\">"
                              "<lowerCorner>391000 5819000 34.875</lowerCorner>"
                              "<upperCorner>391032 5819034 47.5625</upperCorner>"));
}

TEST(SurroundingsGml, DoesNotDependOnPieces) {
  std::string pieces;
  write_surroundings_gml(test::sample_surroundings(), test::sample_catalogue(), kTile, gml_options(),
                         [&](std::string_view bytes) { pieces += bytes; });
  EXPECT_EQ(pieces, gml());
}

TEST(SurroundingsCityJson, HasTheTypesOfCityGml) {
  const std::vector<json> lines = sequence();
  EXPECT_EQ(lines.at(0).at("type"), "CityJSON");
  EXPECT_EQ(lines.at(0).at("version"), "2.0");
  EXPECT_THAT(lines.at(0).at("CityObjects"), IsEmpty());
  EXPECT_EQ(lines.at(0).at("metadata").at("referenceSystem"), "https://www.opengis.net/def/crs/EPSG/0/25833");
  std::map<std::string, int> types;
  std::set<std::string> ids;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].at("type"), "CityJSONFeature");
    const json& objects = lines[i].at("CityObjects");
    ASSERT_THAT(objects, SizeIs(1));
    EXPECT_EQ(objects.begin().key(), lines[i].at("id"));
    EXPECT_TRUE(ids.insert(objects.begin().key()).second) << objects.begin().key();
    ++types[objects.begin().value().at("type")];
  }
  EXPECT_EQ(types, (std::map<std::string, int>{{"Road", 1},
                                               {"LandUse", 3},
                                               {"WaterBody", 1},
                                               {"Railway", 1},
                                               {"PlantCover", 2},
                                               {"Bridge", 2},
                                               {"OtherConstruction", 1},
                                               {"SolitaryVegetationObject", 2},
                                               {"CityFurniture", 4}}));
  const std::multiset<std::string> in_gml = names_of(gml()).ids;
  for (const std::string& id : ids) EXPECT_EQ(in_gml.count(id), 1u) << id;
}

TEST(SurroundingsCityJson, HasTheCoordinatesOfCityGml) {
  const std::vector<json> lines = sequence();
  const json& transform = lines.at(0).at("transform");
  std::set<std::string> points;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const json& feature = lines[i];
    std::set<std::size_t> used;
    const std::function<void(const json&)> look = [&](const json& list) {
      for (const json& item : list)
        if (item.is_array())
          look(item);
        else
          used.insert(item.get<std::size_t>());
    };
    const json& geometries = feature.at("CityObjects").begin().value().at("geometry");
    for (const json& g : geometries) look(g.at("boundaries"));
    EXPECT_EQ(used.size(), feature.at("vertices").size()) << feature.at("id");
    if (geometries.empty() || geometries.at(0).at("type") == "GeometryInstance") continue;
    for (const json& v : feature.at("vertices")) {
      std::ostringstream point;
      point.precision(12);
      for (std::size_t a = 0; a < 3; ++a)
        point << (a ? " " : "")
              << v.at(a).get<double>() * transform.at("scale").at(a).get<double>() +
                     transform.at("translate").at(a).get<double>();
      points.insert(point.str());
    }
  }
  EXPECT_EQ(points, gml_points(gml()));
}

TEST(SurroundingsCityJson, SurfacesHaveMeaningAndMaterial) {
  const std::vector<json> lines = sequence();
  const auto of = [&](const std::string& type) {
    for (std::size_t i = 1; i < lines.size(); ++i)
      if (lines[i].at("CityObjects").begin().value().at("type") == type) return lines[i];
    return json();
  };
  const json road = of("Road"), geometry = road.at("CityObjects").begin().value().at("geometry").at(0);
  EXPECT_EQ(road.at("CityObjects").begin().value().at("attributes").at("externalReference"),
            "https://www.openstreetmap.org/way/10");
  EXPECT_EQ(road.at("CityObjects").begin().value().at("attributes").at("surfaceMaterial"), json({"asphalt"}));
  EXPECT_EQ(geometry.at("type"), "MultiSurface");
  EXPECT_EQ(geometry.at("lod"), "2");
  std::vector<std::string> kinds;
  for (const json& s : geometry.at("semantics").at("surfaces"))
    kinds.push_back(s.at("type").get<std::string>() + " " + s.at("function").get<std::string>());
  EXPECT_THAT(kinds, ElementsAre("TrafficArea carriageway", "TrafficArea pavement", "TransportationMarking marking",
                                 "AuxiliaryTrafficArea kerb"));
  EXPECT_EQ(geometry.at("semantics").at("values"), json({0, 0, 1, 1, 2, 3, 3}));
  EXPECT_EQ(geometry.at("boundaries").size(), 7u);
  EXPECT_EQ(geometry.at("material").at("visual").at("values"), json({0, 0, 0, 0, 1, 0, 0}));
  EXPECT_THAT(road.at("appearance").at("materials"), SizeIs(2));

  const json lawn = of("LandUse").at("CityObjects").begin().value();
  EXPECT_THAT(lawn.at("geometry").at(0).at("boundaries").at(0), SizeIs(2)) << "the hole";
  EXPECT_EQ(lawn.at("attributes").at("class"), "grass");
  EXPECT_EQ(lawn.at("attributes").at("material"), "grass");

  const json tree = of("SolitaryVegetationObject").at("CityObjects").begin().value();
  EXPECT_EQ(tree.at("geometry").at(0).at("type"), "GeometryInstance");
  EXPECT_EQ(tree.at("geometry").at(0).at("template"), 0);
  EXPECT_EQ(tree.at("attributes").at("height"), 10);
  const json& templates = lines.at(0).at("geometry-templates");
  ASSERT_THAT(templates.at("templates"), SizeIs(2));
  EXPECT_THAT(templates.at("templates").at(0).at("boundaries"), SizeIs(2));
  EXPECT_EQ(templates.at("templates").at(0).at("material").at("visual").at("values"), json({0, 1}));
  EXPECT_THAT(templates.at("vertices-templates"), SizeIs(9));
}

TEST(SurroundingsCityJson, SolidsAreSolids) {
  std::map<std::string, std::string> types;
  const std::vector<json> lines = sequence();
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const json& object = lines[i].at("CityObjects").begin().value();
    if (!object.at("geometry").empty())
      types[object.at("attributes").at("class").get<std::string>() + " " +
            lines[i].at("id").get<std::string>().substr(0, 3)] = object.at("geometry").at(0).at("type");
  }
  EXPECT_EQ(types.at("wall w40"), "Solid");
  EXPECT_EQ(types.at("hedge w41"), "MultiSolid");
  EXPECT_EQ(types.at("fence w42"), "MultiSurface");
  EXPECT_EQ(types.at("bridge w70"), "MultiSurface");
  EXPECT_EQ(types.at("bridge w71"), "Solid");
}

TEST(SurroundingObjects, IdsAreOfObjectAndTile) {
  const model::Surroundings given = test::sample_surroundings();
  const model::SurroundingCatalogue catalogue = test::sample_catalogue();
  std::set<std::string> ids;
  for (const model::TileId tile : {kTile, model::TileId{15, 17601, 12900}})
    for (const SurroundingObject& o : surrounding_objects(given, catalogue, tile))
      EXPECT_TRUE(ids.insert(o.id).second) << o.id;
  EXPECT_THAT(surrounding_objects({}, catalogue, kTile), IsEmpty());
  // Others do not change the number of an object.
  model::Surroundings more = given;
  more.objects.insert(more.objects.begin(), {1, {model::OsmType::node, 5}, test::at(1, 1), 0, 1, 1});
  std::set<std::string> then;
  for (const SurroundingObject& o : surrounding_objects(more, catalogue, kTile)) then.insert(o.id);
  for (const SurroundingObject& o : surrounding_objects(given, catalogue, kTile))
    EXPECT_EQ(then.count(o.id), 1u) << o.id;
}

// ---- GeoPackage

double area(const std::vector<model::Polygon>& polygons) {
  double sum = 0;
  const auto add = [&](const model::Ring& r) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      const model::Point2 a = r.points[i], b = r.points[(i + 1) % r.size()];
      sum += ((a.x - test::kWest) * (b.y - test::kSouth) - (b.x - test::kWest) * (a.y - test::kSouth)) / 2;
    }
  };
  for (const model::Polygon& p : polygons) {
    add(p.outer);
    for (const model::Ring& hole : p.holes) add(hole);
  }
  return sum;
}

TEST(DissolvedFaces, SharedEdgesGo) {
  const auto strip = dissolved({test::rectangle(0, 0, 1, 1), test::rectangle(1, 0, 2, 1), test::rectangle(2, 0, 3, 1)});
  ASSERT_THAT(strip, SizeIs(1));
  EXPECT_EQ(strip[0].outer.size(), 8u);
  EXPECT_EQ(area(strip), 3);
  EXPECT_THAT(dissolved({}), IsEmpty());
  EXPECT_THAT(dissolved({{{test::at(0, 0), test::at(1, 0), test::at(1, 0, 1)}, {}}}), IsEmpty()) << "upright";
}

TEST(DissolvedFaces, RingsOfFacesAroundACourt) {
  std::vector<model::FlatPolygon> faces;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      if (x != 1 || y != 1) faces.push_back(test::rectangle(x, y, x + 1, y + 1));
  const auto ring = dissolved(faces);
  ASSERT_THAT(ring, SizeIs(1));
  EXPECT_THAT(ring[0].holes, SizeIs(1));
  EXPECT_EQ(area(ring), 8);
  // The order of faces does not count.
  std::reverse(faces.begin(), faces.end());
  EXPECT_EQ(dissolved(faces)[0].outer.points, ring[0].outer.points);
}

TEST(DissolvedFaces, WhatTouchesAtPointsStaysApart) {
  const auto corners = dissolved({test::rectangle(0, 0, 1, 1), test::rectangle(1, 1, 2, 2)});
  ASSERT_THAT(corners, SizeIs(2));
  EXPECT_EQ(corners[0].outer.size(), 4u);
  // Two courts that touch at a corner, and one that touches the outline.
  std::vector<model::FlatPolygon> faces;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      if (!(x == 1 && y == 1) && !(x == 2 && y == 2)) faces.push_back(test::rectangle(x, y, x + 1, y + 1));
  const auto courts = dissolved(faces);
  ASSERT_THAT(courts, SizeIs(1));
  EXPECT_THAT(courts[0].holes, SizeIs(2));
  EXPECT_EQ(area(courts), 14);
  faces.clear();
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      if (!(x == 1 && y == 1) && !(x == 2 && y == 2)) faces.push_back(test::rectangle(x, y, x + 1, y + 1));
  const auto notch = dissolved(faces);
  ASSERT_THAT(notch, SizeIs(1));
  EXPECT_THAT(notch[0].holes, SizeIs(1));
  EXPECT_EQ(area(notch), 7);
}

TEST(SurroundingRows, SayWhatIsThere) {
  const SurroundingRows rows = surrounding_rows(test::sample_surroundings(), test::sample_catalogue());
  EXPECT_EQ(rows.ground.rows(), 10u);
  EXPECT_EQ(rows.bodies.rows(), 9u);
  EXPECT_EQ(rows.objects.rows(), 4u);
  EXPECT_TRUE(surrounding_rows({}, test::sample_catalogue()).empty());
  // They come back from a run that finds the tile unchanged.
  const auto back = base::unpacked<SurroundingRows>(base::packed(rows));
  EXPECT_EQ(base::packed(back), base::packed(rows));
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
      const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, i));
      row.push_back(text ? text : "NULL");
    }
  }
  sqlite3_finalize(statement);
  sqlite3_close(db);
  return rows;
}

TEST(SurroundingLayers, StandInTheFile) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "blockrand_surrounding_layers";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::string with = folder / "with.gpkg", without = folder / "without.gpkg";
  const SurroundingRows rows = surrounding_rows(test::sample_surroundings(), test::sample_catalogue());
  for (const bool there : {true, false}) {
    GeoPackageOptions options{"EPSG:25833", "2024-05-01T12:34:56Z", "heights above local ground", "a test", false,
                              there};
    GeoPackageWriter writer(there ? with : without, options);
    writer.add(rows);
    writer.close();
  }
  const std::string layers =
      "SELECT table_name, geometry_type_name, z FROM gpkg_geometry_columns WHERE table_name LIKE '%ground%' OR "
      "table_name LIKE 'surrounding%' ORDER BY table_name";
  EXPECT_THAT(query(with, layers), ElementsAre(ElementsAre("ground", "MULTIPOLYGON", "0"),
                                               ElementsAre("surrounding_bodies", "MULTIPOLYGON", "1"),
                                               ElementsAre("surrounding_objects", "POINT", "0")));
  EXPECT_THAT(query(without, layers), IsEmpty());
  EXPECT_THAT(query(with,
                    "SELECT osm_id, class, material, offset_m, area_m2 FROM ground WHERE class IN ('grass', 'land') "
                    "ORDER BY fid"),
              ElementsAre(ElementsAre("r20", "grass", "grass", "0.031", "224.0"),
                          ElementsAre("NULL", "land", "grass", "0.0", "40.0"),
                          ElementsAre("NULL", "land", "grass", "0.0", "40.0")));
  EXPECT_THAT(query(with, "SELECT osm_id, class, material FROM surrounding_bodies WHERE fid = 1"),
              ElementsAre(ElementsAre("w40", "wall", "brick")));
  EXPECT_THAT(
      query(with, "SELECT osm_id, kind, shape, height_m, width_m, turn_degrees FROM surrounding_objects WHERE fid < 3"),
      ElementsAre(ElementsAre("w60", "tree", "tree_broadleaved_medium", "10.0", "6.0", "90.0"),
                  ElementsAre("n80", "tree", "tree_broadleaved_medium", "12.5", "3.0", "0.0")));
  EXPECT_THAT(query(with,
                    "SELECT count(*) FROM layer_styles WHERE useAsDefault = 1 AND (f_table_name = 'ground' OR "
                    "f_table_name LIKE 'surrounding%')"),
              ElementsAre(ElementsAre("3")));
  EXPECT_THAT(query(without, "SELECT count(*) FROM layer_styles WHERE f_table_name = 'ground'"),
              ElementsAre(ElementsAre("0")));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace blockrand::outputs
