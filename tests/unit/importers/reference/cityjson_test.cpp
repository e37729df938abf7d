// CityJSON: every construct in a small file, and what is left of broken ones.
#include "importers/reference/cityjson.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importers/reference/footprints.h"
#include "tests/unit/importers/reference/level_of_detail.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using model::Point3;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

const std::string kCrs = R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"})";
const std::string kTransform = R"("transform":{"scale":[0.001,0.001,0.001],"translate":[84600,447800,0]})";
/// A box of 10 m x 8 m x 3 m: 0 to 3 below, 4 to 7 above, counter-clockwise from the south-west.
const std::string kVertices =
    "[[0,0,0],[10000,0,0],[10000,8000,0],[0,8000,0],[0,0,3000],[10000,0,3000],[10000,8000,3000],[0,8000,3000]]";
const std::string kShell = "[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";

std::string cityjson(const std::string& objects, const std::string& more = "", const std::string& version = "2.0",
                     const std::string& vertices = kVertices) {
  return R"({"type":"CityJSON","version":")" + version + R"(",)" + kTransform + "," + kCrs + more +
         R"(,"CityObjects":{)" + objects + R"(},"vertices":)" + vertices + "}";
}

std::string object(const std::string& id, const std::string& type, const std::string& geometry,
                   const std::string& more = "") {
  return "\"" + id + R"(":{"type":")" + type + R"(","geometry":[)" + geometry + "]" + more + "}";
}

std::string solid(const std::string& more = "", const std::string& lod = "\"2\"") {
  return R"({"type":"Solid","lod":)" + lod + R"(,"boundaries":[)" + kShell + "]" + more + "}";
}

ReferenceModel read_json(const std::string& text, const ReadOptions& options = {}) {
  const TempFolder folder;
  return read_cityjson(folder.write("m.city.json", text), options);
}

std::string refused(const std::string& text, const ReadOptions& options = {}) {
  try {
    read_json(text, options);
    return "read";
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(CityJson, ASolidWithSemanticsAndOpenings) {
  const auto m = read_json(cityjson(object(
      "b", "Building",
      solid(
          R"(,"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface","id":"r"},{"type":"WallSurface","children":[3]},
             {"type":"Window","parent":2},{"type":"Door"},{"type":"+Balcony"}],"values":[[0,1,2,3,4,null]]})"))));
  ASSERT_THAT(m.buildings, SizeIs(1));
  const Building& b = m.buildings[0];
  EXPECT_EQ(m.format, "CityJSON 2.0");
  EXPECT_GT(m.bytes, 100u);
  ASSERT_THAT(b.geometries, SizeIs(1));
  EXPECT_EQ(b.geometries[0].kind, GeometryKind::solid);
  EXPECT_EQ(b.geometries[0].lod, 2);
  EXPECT_EQ(b.geometries[0].outer_faces, 6u);
  EXPECT_THAT(m.polygons[0].outer, ElementsAre(Point3{84600, 447800, 0}, Point3{84600, 447808, 0},
                                               Point3{84610, 447808, 0}, Point3{84610, 447800, 0}));
  ASSERT_THAT(b.surfaces, SizeIs(4));
  EXPECT_EQ(b.surfaces[0].surface_class, SurfaceClass::ground);
  EXPECT_EQ(b.surfaces[1].surface_class, SurfaceClass::roof);
  EXPECT_EQ(b.surfaces[1].id, "r");
  EXPECT_EQ(b.surfaces[2].surface_class, SurfaceClass::wall);
  ASSERT_THAT(b.surfaces[2].openings, SizeIs(1));
  EXPECT_FALSE(b.surfaces[2].openings[0].door);
  EXPECT_EQ(b.surfaces[2].openings[0].geometries[0].faces[0].polygon, 3u);
  // A door without a wall gets one.
  EXPECT_EQ(b.surfaces[3].surface_class, SurfaceClass::wall);
  EXPECT_THAT(b.surfaces[3].geometries, IsEmpty());
  ASSERT_THAT(b.surfaces[3].openings, SizeIs(1));
  EXPECT_TRUE(b.surfaces[3].openings[0].door);
  EXPECT_EQ(m.breaches(), 0u);
  const auto footprints = ground_footprints(m);
  ASSERT_THAT(footprints, SizeIs(1));
  EXPECT_NEAR(footprints[0].area, 80, 1e-6);
}

TEST(CityJson, AVoidAndAHole) {
  const auto m = read_json(
      cityjson(object("b", "Building",
                      R"({"type":"Solid","lod":"1","boundaries":[)" + kShell + R"(,[[[0,1,2],[4,5,6]],[[2,3,0]]]]})")));
  const Geometry& g = m.buildings[0].geometries[0];
  EXPECT_EQ(g.outer_faces, 6u);
  EXPECT_THAT(g.faces, SizeIs(8));
  EXPECT_THAT(m.polygons[6].holes, SizeIs(1));
}

TEST(CityJson, ManySolidsAndSurfaces) {
  const auto m = read_json(cityjson(
      object(
          "m", "Building",
          R"({"type":"MultiSolid","lod":2,"boundaries":[[)" + kShell + "],[" + kShell +
              R"(]],"semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[[[null,0,null,null,null,null]],null]}})") +
      "," +
      object("s", "Building",
             R"({"type":"MultiSurface","lod":2.2,"boundaries":[[[0,3,2,1]],[[4,5,6,7]]],
                "semantics":{"surfaces":[{"type":"GroundSurface"}],"values":[0,null]}})")));
  ASSERT_THAT(m.buildings, SizeIs(2));
  EXPECT_THAT(m.buildings[0].geometries, SizeIs(2));
  ASSERT_THAT(m.buildings[0].surfaces, SizeIs(1));
  EXPECT_THAT(m.buildings[0].surfaces[0].geometries[0].faces, SizeIs(1));
  // What has a class stands at its surface, the rest at the building.
  ASSERT_THAT(m.buildings[1].geometries, SizeIs(1));
  EXPECT_THAT(m.buildings[1].geometries[0].faces, SizeIs(1));
  EXPECT_THAT(m.buildings[1].surfaces, SizeIs(1));
}

TEST(CityJson, TheFinestOfALevelIsRead) {
  const auto m = read_json(cityjson(
      object("b", "Building", solid("", "\"1.2\"") + "," + solid("", "\"1.3\"") + "," + solid("", "\"2.2\"") + R"(,
        {"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]},
        {"type":"MultiSurface","lod":"0.3","boundaries":[[[4,5,6,7]]],"semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0]}})")));
  std::vector<int> lods;
  for (const Geometry& g : m.buildings[0].geometries) lods.push_back(g.lod);
  EXPECT_THAT(lods, ElementsAre(1, 2, 0, 0));
  EXPECT_EQ(m.buildings[0].geometries[2].kind, GeometryKind::footprint);
  EXPECT_EQ(m.buildings[0].geometries[3].kind, GeometryKind::roof_edge);
  EXPECT_EQ(m.count(NoteKind::not_read), 1u);
  EXPECT_EQ(m.breaches(), 0u);
}

TEST(CityJson, PartsFollowTheirBuildingInWhateverOrderTheyStand) {
  const auto m = read_json(cityjson(object("b.2.1", "BuildingPart", solid(), R"(,"parents":["b.2"])") + "," +
                                    object("b.1", "BuildingPart", solid(), R"(,"parents":["b"])") + "," +
                                    object("z", "Building", solid()) + "," + object("b.2", "BuildingPart", solid()) +
                                    "," + object("b", "Building", "", R"(,"children":["b.1","b.2"])")));
  std::vector<std::pair<std::string, int>> got;
  for (const Building& b : m.buildings) got.emplace_back(b.id, b.parent);
  EXPECT_THAT(got, ElementsAre(Pair("z", -1), Pair("b", -1), Pair("b.1", 1), Pair("b.2", 1), Pair("b.2.1", 3)));
  EXPECT_EQ(m.breaches(), 0u);
}

TEST(CityJson, WhatBelongsToABuilding) {
  const auto m = read_json(cityjson(
      object("b", "Building", solid()) + "," +
      object("chimney", "BuildingInstallation",
             solid(R"(,"semantics":{"surfaces":[{"type":"WallSurface"}],"values":[[0,0,0,0,0,0]]})"),
             R"(,"parents":["b"])") +
      "," + object("room", "BuildingRoom", solid(), R"(,"parents":["storey"])") + "," +
      object("storey", "BuildingStorey", "", R"(,"parents":["b"])") + "," +
      object("chair", "BuildingFurniture", solid(), R"(,"parents":["room"])") + "," + object("shed", "+Shed", solid()) +
      "," + object("lone", "BuildingInstallation", solid()) + "," + object("road", "Road", "")));
  ASSERT_THAT(m.buildings, SizeIs(1));
  const auto& surfaces = m.buildings[0].surfaces;
  ASSERT_THAT(surfaces, SizeIs(4));
  EXPECT_EQ(surfaces[0].surface_class, SurfaceClass::installation);
  EXPECT_EQ(surfaces[0].id, "chimney");
  EXPECT_FALSE(surfaces[0].interior);
  EXPECT_TRUE(surfaces[1].of_installation);
  EXPECT_EQ(surfaces[2].surface_class, SurfaceClass::room);
  EXPECT_TRUE(surfaces[2].interior);
  EXPECT_THAT(m.other_objects, ElementsAre(Pair("BuildingFurniture", 1u), Pair("+Shed", 1u), Pair("Road", 1u)));
  EXPECT_EQ(m.count(NoteKind::bad_hierarchy), 1u);
  EXPECT_EQ(m.breaches(), 1u);
}

TEST(CityJson, Attributes) {
  const auto m = read_json(cityjson(object(
      "b", "Building", solid(),
      R"(,"attributes":{"measuredHeight":12.5,"storeysAboveGround":4,"storeysBelowGround":"1","yearOfConstruction":"1898",
         "yearOfDemolition":-1.5,"roofType":1030,"function":["a","b"],"usage":"u","class":"c","name":"Rathaus",
         "nothing":null,"heated":true,"area":80,"owner":{"name":"Stadt","since":1990},"list":[1,"x"]})")));
  const Building& b = m.buildings[0];
  EXPECT_EQ(b.measured_height, 12.5);
  EXPECT_EQ(b.storeys_above_ground, 4);
  EXPECT_EQ(b.storeys_below_ground, 1);
  EXPECT_EQ(b.year_of_construction, 1898);
  EXPECT_FALSE(b.year_of_demolition);
  EXPECT_EQ(b.roof_type, "1030");
  EXPECT_THAT(b.functions, ElementsAre("a", "b"));
  EXPECT_THAT(b.usages, ElementsAre("u"));
  EXPECT_EQ(b.class_code, "c");
  EXPECT_THAT(b.names, ElementsAre("Rathaus"));
  EXPECT_THAT(b.attributes,
              testing::UnorderedElementsAre(Pair("heated", "true"), Pair("area", "80"), Pair("owner/name", "Stadt"),
                                            Pair("owner/since", "1990"), Pair("list", "1"), Pair("list", "x")));
  EXPECT_EQ(m.count(NoteKind::bad_value), 1u);
}

TEST(CityJson, TemplatesArePlaced) {
  const std::string templates =
      R"(,"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]],
          "semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0]}}],"vertices-templates":[[0,0,0],[2,0,0],[2,0,1]]})";
  const std::string at = R"({"type":"GeometryInstance","template":0,"boundaries":[1],"transformationMatrix":)";
  const auto m = read_json(cityjson(
      object("b", "Building", solid() + "," + at + "[0,-1,0,0, 1,0,0,0, 0,0,2,0.5, 0,0,0,1]}") + "," +
          object("c", "BuildingInstallation", at + "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}", R"(,"parents":["b"])") +
          "," +
          object(
              "d", "Building",
              at + "[1,0,0]}," +
                  R"({"type":"GeometryInstance","template":7,"boundaries":[1]},{"type":"GeometryInstance","template":0,"boundaries":[99]})"),
      templates));
  const Building& b = m.buildings[0];
  ASSERT_THAT(b.surfaces, SizeIs(3));
  EXPECT_EQ(b.surfaces[0].surface_class, SurfaceClass::roof);
  EXPECT_EQ(lod_of(b), 3);
  EXPECT_THAT(m.polygons[b.surfaces[0].geometries[0].faces[0].polygon].outer,
              ElementsAre(Point3{84610, 447800, 0.5}, Point3{84610, 447802, 0.5}, Point3{84610, 447802, 2.5}));
  EXPECT_EQ(b.surfaces[1].surface_class, SurfaceClass::installation);
  EXPECT_THAT(b.surfaces[1].geometries, SizeIs(1));
  EXPECT_EQ(m.buildings[1].implicit_geometries, 3u);
  EXPECT_EQ(m.count(NoteKind::bad_index), 2u);
}

TEST(CityJson, MirroredTemplatesAreNotInsideOut) {
  const std::string templates =
      R"(,"geometry-templates":{"templates":[{"type":"Solid","lod":"2","boundaries":[)" + kShell +
      R"(]}],"vertices-templates":[[0,0,0],[10,0,0],[10,8,0],[0,8,0],[0,0,3],[10,0,3],[10,8,3],[0,8,3]]})";
  const std::string at =
      R"({"type":"GeometryInstance","template":0,"boundaries":[0],"lod":"2","transformationMatrix":)";
  const auto m =
      read_json(cityjson(object("mirrored", "Building", at + "[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}") + "," +
                             object("turned", "Building", at + "[-1,0,0,0, 0,-1,0,0, 0,0,1,0, 0,0,0,1]}"),
                         templates));
  ASSERT_THAT(m.buildings, SizeIs(2));
  for (std::size_t b = 0; b < 2; ++b) {
    ASSERT_THAT(m.buildings[b].geometries, SizeIs(1));
    ASSERT_THAT(m.buildings[b].geometries[0].faces, SizeIs(6));
    for (const Face& face : m.buildings[b].geometries[0].faces) EXPECT_EQ(face.reversed, b == 0);
  }
}

TEST(CityJson, EveryFormOfCrsAndWhatTheHeightsAre) {
  const auto with = [](const std::string& metadata, const ReadOptions& options = {}) {
    return read_json(R"({"type":"CityJSON","version":"1.1",)" + kTransform + metadata + R"(,"CityObjects":{)" +
                         object("b", "Building", solid()) + R"(},"vertices":)" + kVertices + "}",
                     options);
  };
  for (const char* metadata :
       {R"(,"metadata":{"referenceSystem":"urn:ogc:def:crs:EPSG::7415"})",
        R"(,"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"})",
        R"(,"metadata":{"crs":{"epsg":7415}})", R"(,"+metadata":{"referenceSystem":"urn:ogc:def:crs:EPSG::7415"})",
        R"(,"metadata":{"title":"x"},"+metadata-extended":{"referenceSystem":"EPSG:7415"})"}) {
    SCOPED_TRACE(metadata);
    const auto m = with(metadata);
    EXPECT_EQ(m.crs.horizontal, "EPSG:28992");
    EXPECT_EQ(m.crs.vertical, "EPSG:5709");
    EXPECT_EQ(m.crs.height_reference, HeightReference::vertical_crs);
  }
  ReadOptions options;
  options.reference_crs = "EPSG:28992";
  EXPECT_EQ(with("", options).crs.height_reference, HeightReference::unknown);
  const std::string words = R"(,"metadata":{"referenceSystem":"urn:ogc:def:crs:EPSG::28992","title":"T; heights: )";
  EXPECT_EQ(with(words + R"(heights above local ground; data: x"})").crs.height_reference,
            HeightReference::above_local_ground);
  EXPECT_EQ(with(words + R"(heights above sea level, one ground height for all"})").crs.height_reference,
            HeightReference::above_local_ground);
  EXPECT_EQ(with(words + R"(heights of the terrain raster, above the ellipsoid"})").crs.height_reference,
            HeightReference::ellipsoidal);
  EXPECT_EQ(with(words + R"(heights of the terrain raster, above sea level"})").crs.height_reference,
            HeightReference::sea_level);
  const auto dhhn = with(words + R"j(heights of the terrain raster, above DHHN2016 height (EPSG:7837)"})j");
  EXPECT_EQ(dhhn.crs.height_reference, HeightReference::vertical_crs);
  EXPECT_EQ(dhhn.crs.vertical, "EPSG:7837");
  EXPECT_EQ(dhhn.crs.height_words, "heights of the terrain raster, above DHHN2016 height (EPSG:7837)");
  EXPECT_THAT(refused(R"({"type":"CityJSON","version":"2.0",)" + kTransform + R"(,"CityObjects":{)" +
                      object("b", "Building", solid()) + R"(},"vertices":)" + kVertices + "}"),
              AllOf(HasSubstr("m.city.json"), HasSubstr("--reference-crs")));
}

TEST(CityJson, SequencesLineByLine) {
  const std::string header =
      R"({"type":"CityJSON","version":"2.0",)" + kTransform + "," + kCrs + R"(,"CityObjects":{},"vertices":[]})";
  const auto feature = [](const std::string& id) {
    return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{)" + object(id, "Building", solid()) +
           R"(},"vertices":)" + kVertices + "}";
  };
  const std::string text = header + "\n" + feature("a") + "\r\n\n{broken\n" + feature("b") + "\n[1]\n" + feature("a");
  const auto check = [](const ReferenceModel& m) {
    ASSERT_THAT(m.buildings, SizeIs(3));
    EXPECT_EQ(m.format, "CityJSON sequence 2.0");
    EXPECT_EQ(m.buildings[0].line, 2);
    EXPECT_EQ(m.buildings[1].line, 5);
    EXPECT_EQ(m.polygons[17].outer.size(), 4u);
    EXPECT_EQ(m.count(NoteKind::malformed_json), 2u);
    EXPECT_EQ(m.count(NoteKind::duplicate_id), 1u);
    for (const Note& n : m.notes) EXPECT_THAT(n.examples[0], HasSubstr("line "));
  };
  check(read_json(text));
  const TempFolder folder;
  check(read_cityjson(folder.write_gzipped("s.city.jsonl", text)));
  EXPECT_THAT(refused(feature("a") + "\n" + feature("b")), HasSubstr("CityJSON object is missing"));
  EXPECT_THAT(read_json(header).buildings, IsEmpty());
}

TEST(CityJson, DocumentsOverManyLinesAndGzippedOnes) {
  std::string text = cityjson(object("b", "Building", solid()));
  for (std::size_t at = 0; (at = text.find(',', at)) != std::string::npos; at += 2) text.insert(at + 1, "\n");
  EXPECT_THAT(read_json("\xEF\xBB\xBF" + text).buildings, SizeIs(1));
  const TempFolder folder;
  EXPECT_THAT(read_cityjson(folder.write_gzipped("m.json.gz", text)).buildings, SizeIs(1));
}

TEST(DamagedCityJson, IsRefusedWithFileAndReason) {
  const std::string good = cityjson(object("b", "Building", solid()));
  EXPECT_THAT(refused(good.substr(0, good.size() / 2)), AllOf(HasSubstr("m.city.json"), HasSubstr("line 1, column")));
  EXPECT_THAT(refused("{}"), HasSubstr("no CityJSON"));
  EXPECT_THAT(refused("   \n  "), HasSubstr("blank"));
  EXPECT_THAT(refused("[1,2]"), HasSubstr("no CityJSON"));
  EXPECT_THAT(refused(R"({"type":"CityJSON","version":"0.8"})"), AllOf(HasSubstr("0.8"), HasSubstr("cjio")));
  EXPECT_THAT(refused(R"({"type":"CityJSON"})"), HasSubstr("no version"));
  for (const char* transform :
       {"1", "{}", R"({"scale":[1,1],"translate":[0,0,0]})", R"({"scale":[0,1,1],"translate":[0,0,0]})",
        R"({"scale":["a",1,1],"translate":[0,0,0]})"})
    EXPECT_THAT(refused(R"({"type":"CityJSON","version":"2.0","transform":)" + std::string(transform) + "}"),
                HasSubstr("transform"))
        << transform;
  EXPECT_THAT(refused(cityjson(object("b", "Building", solid()), "", "2.0", "[[1e999,0,0]]")), HasSubstr("number"));
  EXPECT_THAT(refused(cityjson(object("b", "Building", solid()), "", "2.0", "[[NaN,0,0]]")), HasSubstr("no JSON"));
  const TempFolder folder;
  const std::string path = folder.write_gzipped("m.json.gz", good + std::string(100000, ' ') + good);
  std::string bytes = all_text(path);
  EXPECT_THROW(read_cityjson(folder.write("cut.json.gz", bytes.substr(0, bytes.size() / 3))), std::exception);
}

TEST(DamagedCityJson, LeavesOutWhatIsBroken) {
  const auto m = read_json(cityjson(
      object(
          "far", "Building",
          R"({"type":"Solid","lod":"2","boundaries":[[[[0,1,99]],[[0,1,2]],[[0,-1,2]],[[0,1.5,2]],[[0,1]],[[0,1,1e300]]]]})") +
      "," +
      object(
          "odd", "Building",
          R"({"type":"Solid","lod":"9","boundaries":[7,[[[0,1,2]]]]},{"type":"Blob","lod":"1"},{"type":"Solid","lod":"2"},5,
             {"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]],"semantics":{"surfaces":[{"type":"Window","parent":0}],"values":[5]}},
             {"type":"MultiPoint","lod":"1","boundaries":[0]})") +
      "," + object("one", "BuildingPart", solid(), R"(,"parents":["two"])") + "," +
      object("two", "BuildingPart", solid(), R"(,"parents":["one"])") + "," +
      object("self", "BuildingPart", solid(), R"(,"parents":["self"])") + "," +
      object("orphan", "BuildingPart", solid(), R"(,"parents":["nobody"])") + R"(,"none":{},"number":3)"));
  ASSERT_THAT(m.buildings, SizeIs(6));
  EXPECT_THAT(m.buildings[0].geometries[0].faces, SizeIs(1));
  EXPECT_EQ(m.count(NoteKind::bad_index), 5u);
  EXPECT_EQ(m.count(NoteKind::short_ring), 1u);
  EXPECT_EQ(m.count(NoteKind::bad_hierarchy), 3u);
  EXPECT_GT(m.count(NoteKind::malformed_json), 3u);
  EXPECT_EQ(m.count(NoteKind::not_read), 1u);
  for (const Building& b : m.buildings) EXPECT_LT(b.parent, static_cast<int>(m.buildings.size()));
}

TEST(DamagedCityJson, BadVerticesTakeTheirRingsWithThem) {
  const auto m = read_json(cityjson(
      object("b", "Building", solid()), "", "2.0",
      R"([[0,0,0],[10000,0,0],[10000,8000,0],[0,8000],["x",0,3000],[1e15,0,0],[10000,8000,3000],[0,8000,3000]])"));
  EXPECT_EQ(m.count(NoteKind::bad_coordinates), 3u);
  EXPECT_THAT(m.buildings[0].geometries, IsEmpty());
}

TEST(DamagedCityJson, DeepNestingIsRefusedAndLongChainsDoNotOverflow) {
  const auto nested = [](std::size_t deep) {
    const std::string nest = std::string(deep, '[') + std::string(deep, ']');
    return cityjson(object("b", "Building", solid() + "," + nest, R"(,"attributes":{"a":)" + nest + "}") + "," +
                    object("c", "Building", R"({"type":"Solid","lod":"2","boundaries":)" + nest + "}"));
  };
  EXPECT_THAT(read_json(nested(500)).buildings, SizeIs(2));
  EXPECT_THAT(refused(nested(513)), AllOf(HasSubstr("m.city.json"), HasSubstr("deeper than 512 levels")));
  EXPECT_THAT(refused(R"({"type":"CityJSON","a":)" + std::string(5'000'000, '[')), HasSubstr("deeper than 512 levels"));
  std::string chain = object("p0", "Building", solid());
  for (int i = 1; i < 20000; ++i)
    chain +=
        "," + object("p" + std::to_string(i), "BuildingPart", "", R"(,"parents":["p)" + std::to_string(i - 1) + "\"]");
  EXPECT_THAT(read_json(cityjson(chain)).buildings, SizeIs(20000));
}

}  // namespace
}  // namespace blockrand::importers::reference::test
