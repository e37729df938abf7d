// glTF and 3D Tiles: every construct in a small file, and what is left of broken ones.
#include "importers/reference/gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "importers/reference/footprints.h"
#include "pipeline/georef/frames.h"
#include "pipeline/georef/transform.h"
#include "tests/unit/importers/reference/gltf_support.h"
#include "tests/unit/importers/reference/level_of_detail.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using Json = nlohmann::json;
using model::Point3;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;
namespace fs = std::filesystem;

constexpr double kLon = 13.4, kLat = 52.5;

/// In EPSG:25833, of metres east, north and up of the place.
Point3 at(double east, double north, double up, double lon = kLon, double lat = kLat) {
  const georef::EnuFrame frame({lon, lat, 0});
  const georef::Geodetic g = georef::from_ecef(frame.to_ecef({east, north, up}));
  const model::Point2 p = georef::Transform("EPSG:4326", "EPSG:25833").forward({g.lon, g.lat});
  return {p.x, p.y, g.height};
}

testing::AssertionResult near(const Point3& a, const Point3& b) {
  const double d = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
  if (d < 1e-4) return testing::AssertionSuccess();
  return testing::AssertionFailure() << a.x << " " << a.y << " " << a.z << " is " << d << " m from " << b.x << " "
                                     << b.y << " " << b.z;
}

ReferenceModel read_bytes(const std::string& bytes, const ReadOptions& options = {}) {
  const TempFolder folder;
  return read_gltf(folder.write("m.glb", bytes), options);
}

std::string refused(const std::string& bytes, const ReadOptions& options = {}) {
  try {
    read_bytes(bytes, options);
    return "read";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// The corner of all triangles that lies furthest south-west below, and north-east above.
std::pair<Point3, Point3> corners(const ReferenceModel& m, const Building& b) {
  Point3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Geometry& g : b.geometries)
    for (const Face& f : g.faces)
      for (const Point3& p : m.polygons[f.polygon].outer) {
        if (p.x + p.y + p.z < low.x + low.y + low.z) low = p;
        if (p.x + p.y + p.z > high.x + high.y + high.z) high = p;
      }
  return {low, high};
}

/// m³ of what the triangles enclose; negative where they are inside out.
double volume(const ReferenceModel& m, const Building& b) {
  double sum = 0;
  for (const Geometry& g : b.geometries)
    for (const Face& f : g.faces) {
      const auto& r = m.polygons[f.polygon].outer;
      const Point3 o = m.polygons[b.geometries[0].faces[0].polygon].outer[0];
      const auto d = [&](std::size_t i) { return Point3{r[i].x - o.x, r[i].y - o.y, r[i].z - o.z}; };
      const Point3 p = d(0), q = d(1), s = d(2);
      sum += p.x * (q.y * s.z - q.z * s.y) - p.y * (q.x * s.z - q.z * s.x) + p.z * (q.x * s.y - q.y * s.x);
    }
  return sum / 6;
}

TEST(Gltf, ACubeWhereItsOriginSaysIt) {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}, {"name", "town hall"}, {"translation", {5, 1, -20}}});
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  ASSERT_THAT(m.buildings, SizeIs(1));
  EXPECT_EQ(m.buildings[0].id, "town hall");
  EXPECT_EQ(m.format, "glTF 2.0");
  EXPECT_EQ(m.crs.horizontal, "EPSG:25833");
  EXPECT_EQ(m.crs.height_reference, HeightReference::above_local_ground);
  EXPECT_THAT(m.polygons, SizeIs(12));
  const auto [low, high] = corners(m, m.buildings[0]);
  EXPECT_TRUE(near(low, at(5, 20, 1)));
  EXPECT_TRUE(near(high, at(15, 30, 11)));
  EXPECT_NEAR(volume(m, m.buildings[0]), 1000, 1.5);  // UTM's scale is not 1
  EXPECT_NEAR(ground_footprints(m)[0].area, 100, 0.1);
  EXPECT_EQ(m.breaches(), 0u);
}

TEST(Gltf, PlacedByTheCallerOrNotAtAll) {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}});
  EXPECT_THAT(refused(maker.glb()),
              AllOf(HasSubstr("m.glb"), HasSubstr("where on the Earth"), HasSubstr("--reference-origin")));
  ReadOptions options;
  options.gltf_origin = georef::Geodetic{kLon, kLat, 40};
  const auto m = read_bytes(maker.glb(), options);
  EXPECT_EQ(m.crs.horizontal, "EPSG:25833") << "chosen from the place";
  EXPECT_EQ(m.crs.height_reference, HeightReference::ellipsoidal);
  EXPECT_TRUE(near(corners(m, m.buildings[0]).first, at(0, 0, 40)));
  options.reference_crs = "EPSG:32632";
  EXPECT_EQ(read_bytes(maker.glb(), options).crs.horizontal, "EPSG:32632");
  options.reference_crs = "EPSG:4326";
  EXPECT_THAT(refused(maker.glb(), options), HasSubstr("EPSG:4326"));
  options.gltf_origin = georef::Geodetic{NAN, 0, 0};
  EXPECT_THAT(refused(maker.glb(), options), HasSubstr("origin"));
}

TEST(Gltf, MatrixOfTheGeoreferenceWins) {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}});
  maker.place(0, 0);
  maker.json["asset"]["extras"]["georeference"]["local_to_ecef"] = georef::EnuFrame({kLon, kLat, 0}).local_to_ecef();
  const auto m = read_bytes(maker.glb());
  EXPECT_TRUE(near(corners(m, m.buildings[0]).first, at(0, 0, 0)));
}

TEST(Gltf, TextWithDataUriOrBufferBesideIt) {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}});
  maker.place(kLon, kLat);
  const TempFolder folder;
  EXPECT_THAT(read_gltf(folder.write("a.gltf", maker.gltf())).polygons, SizeIs(12));
  folder.write("b u.bin", maker.binary);
  const std::string path = folder.write("b.gltf", maker.gltf("b%20u.bin"));
  const auto m = read_gltf(path);
  EXPECT_THAT(m.polygons, SizeIs(12));
  EXPECT_EQ(m.bytes, fs::file_size(path) + maker.binary.size());
  EXPECT_THAT(read_gltf(folder.write_gzipped("c.glb.gz", maker.glb())).polygons, SizeIs(12));
  const auto message = [&](const std::string& uri) {
    try {
      read_gltf(folder.write("d.gltf", maker.gltf(uri)));
      return std::string("read");
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(message("missing.bin"), HasSubstr("missing.bin"));
  EXPECT_THAT(message("https://example.org/b.bin"), HasSubstr("network"));
  EXPECT_THAT(message("data:;base64,***"), HasSubstr("base64"));
}

TEST(Gltf, NodesTurnScaleMirrorAndHoldEachOther) {
  GltfMaker maker;
  const int cube = maker.cube(1);
  const double half = std::sqrt(0.5);
  // A quarter turn to the left around the vertical, twice as large, then 100 m east.
  maker.node(
      {{"children", {1, 2}}, {"translation", {100, 0, 0}}, {"rotation", {0, half, 0, half}}, {"scale", {2, 2, 2}}});
  maker.node({{"mesh", cube}, {"name", "turned"}});
  maker.node({{"mesh", cube}, {"name", "mirrored"}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  ASSERT_THAT(m.buildings, SizeIs(2));
  EXPECT_NEAR(volume(m, m.buildings[0]), 8, 0.05);
  EXPECT_NEAR(volume(m, m.buildings[1]), 8, 0.05) << "not inside out";
  EXPECT_TRUE(near(corners(m, m.buildings[0]).second, at(100, 2, 2)));
  EXPECT_TRUE(near(corners(m, m.buildings[1]).first, at(98, -2, 0)));
}

TEST(Gltf, ANodesMatrixMayBeRoundedButMustBeOne) {
  GltfMaker maker;
  const int cube = maker.cube(1);
  maker.json["scenes"][0]["nodes"] = {0, 1, 3};
  maker.node({{"mesh", cube}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 1e-7, 0, 0, 1, 0, 50, 0, 0, 0.99999994}}});
  maker.node({{"mesh", cube},
              {"name", "projected"},
              {"children", {2}},
              {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  maker.node({{"mesh", cube}, {"name", "hangs on it"}});
  maker.node({{"mesh", cube}, {"name", "flat"}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}}});
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  ASSERT_THAT(m.buildings, SizeIs(1));
  EXPECT_TRUE(near(corners(m, m.buildings[0]).first, at(50, 0, 0)));
  EXPECT_EQ(m.count(NoteKind::bad_value), 2u);
}

TEST(Gltf, OneNodeIsOneBuilding) {
  GltfMaker maker;
  const int cube = maker.cube(1);
  maker.json["meshes"][0]["name"] = "house type A";
  maker.json.erase("scenes");
  maker.json.erase("scene");
  maker.node({{"mesh", cube}, {"name", "one"}, {"children", {1}}});
  maker.node({{"mesh", cube}});
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  ASSERT_THAT(m.buildings, SizeIs(2));
  EXPECT_EQ(m.buildings[0].id, "one");
  EXPECT_EQ(m.buildings[1].id, "house type A");
}

TEST(Gltf, BatchIdsAndBareFeatureIds) {
  for (const char* attribute : {"_BATCHID", "_FEATURE_ID_0"}) {
    GltfMaker maker;
    const std::vector<float> ids{0, 0, 0, 0, 7, 7, 7, 7};
    maker.node({{"mesh", maker.cube(1, {{attribute, maker.accessor(ids, "SCALAR", 5126)}})}});
    maker.place(kLon, kLat);
    const auto m = read_bytes(maker.glb());
    ASSERT_THAT(m.buildings, SizeIs(2)) << attribute;
    EXPECT_EQ(m.buildings[0].id, "0");
    EXPECT_EQ(m.buildings[1].id, "7");
  }
}

Json feature_ids(int attribute = 0, int table = 0) {
  return {{"featureIds", {{{"attribute", attribute}, {"propertyTable", table}, {"featureCount", 2}}}}};
}

/// Two cubes in one mesh, with the rows 0 and 1 of a table.
GltfMaker two_cubes() {
  GltfMaker maker;
  const std::vector<std::uint16_t> first(8, 0), second(8, 1);
  const int a = maker.cube(10, {{"_FEATURE_ID_0", maker.accessor(first, "SCALAR", 5123)}});
  const int b = maker.cube(20, {{"_FEATURE_ID_0", maker.accessor(second, "SCALAR", 5123)}});
  maker.json["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"] = feature_ids();
  maker.json["meshes"][0]["primitives"].push_back(maker.json["meshes"][static_cast<std::size_t>(b)]["primitives"][0]);
  maker.json["meshes"][0]["primitives"][1]["extensions"]["EXT_mesh_features"] = feature_ids();
  maker.node({{"mesh", a}});
  maker.place(kLon, kLat);
  return maker;
}

void set_table(GltfMaker& maker, Json class_properties, Json values, int count) {
  maker.json["extensions"]["EXT_structural_metadata"] = {
      {"schema", {{"classes", {{"thing", {{"properties", std::move(class_properties)}}}}}}},
      {"propertyTables", {{{"class", "thing"}, {"count", count}, {"properties", std::move(values)}}}}};
}

const Json kText = {{"type", "STRING"}, {"noData", ""}};

TEST(Gltf, PropertyTablesNameBuildings) {
  GltfMaker maker = two_cubes();
  const std::vector<double> heights{12.5, -1, 3};
  const std::vector<std::int8_t> lods{1, 3, 0};
  const std::vector<std::uint8_t> truths{0b101}, sure{255, 51, 0}, kinds{1, 0, 9};
  const std::vector<std::int64_t> numbers{9007199254740993, -5, 0};
  set_table(maker,
            {{"gml_id", {{"type", "STRING"}}},
             {"height", {{"type", "SCALAR"}, {"componentType", "FLOAT64"}, {"noData", -1}}},
             {"lod", {{"type", "SCALAR"}, {"componentType", "INT8"}}},
             {"heated", {{"type", "BOOLEAN"}}},
             {"sure", {{"type", "SCALAR"}, {"componentType", "UINT8"}, {"normalized", true}}},
             {"kind", {{"type", "ENUM"}, {"enumType", "Kind"}}},
             {"number", {{"type", "SCALAR"}, {"componentType", "INT64"}}},
             {"point", {{"type", "VEC3"}, {"componentType", "FLOAT32"}}},
             {"name", kText}},
            {{"gml_id", maker.texts({"A", "B", "C"})},
             {"height", {{"values", maker.view(heights.data(), 24)}}},
             {"lod", {{"values", maker.view(lods.data(), 3)}}},
             {"heated", {{"values", maker.view(truths.data(), 1)}}},
             {"sure", {{"values", maker.view(sure.data(), 3)}}},
             {"kind", {{"values", maker.view(kinds.data(), 3)}}},
             {"number", {{"values", maker.view(numbers.data(), 24)}}},
             {"point", {{"values", 0}}},
             {"name", maker.texts({"Rathaus", "", ""})}},
            3);
  maker.json["extensions"]["EXT_structural_metadata"]["schema"]["enums"]["Kind"] = {
      {"valueType", "UINT8"}, {"values", {{{"name", "house"}, {"value", 0}}, {{"name", "church"}, {"value", 1}}}}};
  const auto m = read_bytes(maker.glb());
  ASSERT_THAT(m.buildings, SizeIs(3)) << "every row is a building";
  const Building& a = m.buildings[0];
  EXPECT_EQ(a.id, "A");
  EXPECT_EQ(a.measured_height, 12.5);
  EXPECT_THAT(a.names, ElementsAre("Rathaus"));
  EXPECT_THAT(a.attributes, ElementsAre(Pair("gml_id", "A"), Pair("heated", "true"), Pair("height", "12.5"),
                                        Pair("kind", "church"), Pair("lod", "1"), Pair("name", "Rathaus"),
                                        Pair("number", "9007199254740993"), Pair("sure", "1")));
  EXPECT_EQ(lod_of(a), 1);
  EXPECT_EQ(lod_of(m.buildings[1]), 3);
  EXPECT_FALSE(m.buildings[1].measured_height);
  EXPECT_NEAR(volume(m, m.buildings[1]), 8000, 12);
  EXPECT_THAT(m.buildings[2].geometries, IsEmpty());
  EXPECT_EQ(m.count(NoteKind::not_read), 1u) << "the vector";
  EXPECT_EQ(m.breaches(), 0u);
}

TEST(Gltf, RowsOfPartsAreReadAsBlockrandWritesThem) {
  GltfMaker maker = two_cubes();
  set_table(maker, {{"id", {{"type", "STRING"}}}, {"building", {{"type", "STRING"}}}},
            {{"id", maker.texts({"w1", "w1.w2", "w9"})}, {"building", maker.texts({"w1", "w1", "w9"})}}, 3);
  const auto m = read_bytes(maker.glb());
  std::vector<std::pair<std::string, int>> got;
  for (const Building& b : m.buildings) got.emplace_back(b.id, b.parent);
  EXPECT_THAT(got, ElementsAre(Pair("w1", -1), Pair("w1.1", 0), Pair("w1.w2", 0), Pair("w9", -1)));
  EXPECT_THAT(m.buildings[0].geometries, IsEmpty());
  EXPECT_NEAR(volume(m, m.buildings[1]), 1000, 1.5);
  EXPECT_NEAR(volume(m, m.buildings[2]), 8000, 12);
}

TEST(Gltf, InstancesWithFeatures) {
  GltfMaker maker;
  const std::vector<float> places{0, 0, 0, 50, 0, 0, 100, 0, 0};
  const std::vector<float> ids{4, 4, 2};
  const Json attributes = {{"TRANSLATION", maker.accessor(places, "VEC3", 5126)},
                           {"_FEATURE_ID_0", maker.accessor(ids, "SCALAR", 5126)}};
  const int cube = maker.cube(2);
  maker.node({{"mesh", cube},
              {"extensions",
               {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}},
                {"EXT_instance_features", {{"featureIds", {{{"attribute", 0}, {"featureCount", 2}}}}}}}}});
  maker.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  ASSERT_THAT(m.buildings, SizeIs(2));
  EXPECT_EQ(m.buildings[0].id, "4");
  EXPECT_NEAR(volume(m, m.buildings[0]), 16, 0.1);
  EXPECT_TRUE(near(corners(m, m.buildings[1]).first, at(100, 0, 0)));
  EXPECT_EQ(m.count(NoteKind::not_read), 0u);
}

TEST(Gltf, QuantisedSparseAndStripped) {
  GltfMaker maker;
  // A square of 10 m as a strip: shorts in a grid that the node scales, the last corner put right by a sparse value.
  const std::vector<std::uint16_t> grid{0, 0, 0, 65535, 0, 0, 0, 0, 0, 0, 0, 0};
  const int positions = maker.accessor(grid, "VEC3", 5123, true);
  const std::vector<std::uint8_t> places{2, 3};
  const std::vector<std::uint16_t> values{0, 65535, 0, 65535, 65535, 0};
  maker.json["accessors"][static_cast<std::size_t>(positions)]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", maker.view(places.data(), 2)}, {"componentType", 5121}}},
      {"values", {{"bufferView", maker.view(values.data(), 12)}}}};
  maker.node({{"mesh", maker.mesh({{"POSITION", positions}}, -1, 5)}, {"scale", {10, 10, 10}}});
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  ASSERT_THAT(m.polygons, SizeIs(2));
  EXPECT_TRUE(near(corners(m, m.buildings[0]).second, at(10, 0, 10)));
  // Both triangles look the same way.
  for (const Polygon3& p : m.polygons) {
    const double ax = p.outer[1].x - p.outer[0].x, az = p.outer[1].z - p.outer[0].z;
    const double bx = p.outer[2].x - p.outer[0].x, bz = p.outer[2].z - p.outer[0].z;
    EXPECT_GT(ax * bz - az * bx, 0);
  }
}

TEST(Gltf, PointsAndLinesAreNoted) {
  GltfMaker maker;
  const std::vector<float> p{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const int positions = maker.accessor(p, "VEC3", 5126);
  maker.node({{"mesh", maker.mesh({{"POSITION", positions}}, -1, 1)}, {"children", {1}}});
  maker.node({{"mesh", maker.mesh({{"POSITION", positions}}, -1, 6)}});
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  EXPECT_EQ(m.count(NoteKind::not_read), 1u);
  EXPECT_THAT(m.polygons, SizeIs(2)) << "of the fan";
}

/// The same file with every buffer view packed by meshopt: lists of indices as triangles, all else as attributes.
GltfMaker packed(const GltfMaker& plain) {
  GltfMaker out = plain;
  std::string binary;
  std::size_t unpacked = 0;
  for (std::size_t i = 0; i < plain.json["bufferViews"].size(); ++i) {
    const Json& view = plain.json["bufferViews"][i];
    const std::string bytes = plain.binary.substr(view.value("byteOffset", 0u), view["byteLength"].get<std::size_t>());
    const Json* accessor = nullptr;
    for (const Json& a : plain.json["accessors"])
      if (a["bufferView"] == i) accessor = &a;
    if (!accessor) throw std::logic_error("a view of no accessor");
    const bool indices = (*accessor)["type"] == "SCALAR" && (*accessor)["componentType"] != 5126;
    const std::size_t count = (*accessor)["count"].get<std::size_t>(), stride = bytes.size() / count;
    std::vector<unsigned char> coded;
    if (indices) {
      std::vector<unsigned int> numbers;
      for (std::size_t k = 0; k < count; ++k) {
        unsigned int n = 0;
        std::memcpy(&n, bytes.data() + k * stride, stride);
        numbers.push_back(n);
      }
      coded.resize(meshopt_encodeIndexBufferBound(count, 65536));
      coded.resize(meshopt_encodeIndexBuffer(coded.data(), coded.size(), numbers.data(), count));
    } else {
      coded.resize(meshopt_encodeVertexBufferBound(count, stride));
      coded.resize(meshopt_encodeVertexBuffer(coded.data(), coded.size(), bytes.data(), count, stride));
    }
    out.json["bufferViews"][i]["buffer"] = 1;
    out.json["bufferViews"][i]["byteOffset"] = unpacked;
    out.json["bufferViews"][i]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0},    {"byteOffset", binary.size()}, {"byteLength", coded.size()},
        {"count", count}, {"byteStride", stride},        {"mode", indices ? "TRIANGLES" : "ATTRIBUTES"}};
    binary.append(coded.begin(), coded.end());
    unpacked += (bytes.size() + 7) / 8 * 8;
  }
  out.binary = binary;
  out.json["buffers"][1] = {{"byteLength", unpacked},
                            {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
  out.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  return out;
}

TEST(Gltf, WhatMeshoptPackedIsUnpacked) {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}, {"name", "town hall"}});
  maker.place(kLon, kLat);
  const ReferenceModel plain = read_bytes(maker.glb()), unpacked = read_bytes(packed(maker).glb());
  ASSERT_THAT(unpacked.polygons, SizeIs(12));
  EXPECT_EQ(unpacked.breaches(), 0u);
  const auto expected = corners(plain, plain.buildings[0]), found = corners(unpacked, unpacked.buildings[0]);
  EXPECT_TRUE(near(found.first, expected.first));
  EXPECT_TRUE(near(found.second, expected.second));
  EXPECT_NEAR(volume(unpacked, unpacked.buildings[0]), volume(plain, plain.buildings[0]), 1e-6);

  const auto damaged = [&](const std::function<void(Json&)>& damage) {
    GltfMaker broken = packed(maker);
    damage(broken.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]);
    return refused(broken.glb());
  };
  for (const std::string& said :
       {damaged([](Json& p) { p["count"] = 1e12; }), damaged([](Json& p) { p["byteOffset"] = 1e12; }),
        damaged([](Json& p) { p["byteLength"] = 3; }), damaged([](Json& p) { p["mode"] = "OTHER"; }),
        damaged([](Json& p) { p["filter"] = "OTHER"; }), damaged([](Json& p) { p.erase("byteStride"); })})
    EXPECT_THAT(said, AllOf(HasSubstr("bufferView 0"), HasSubstr("Decompress")));
}

TEST(DamagedGltf, IsRefusedWithFileReasonAndRemedy) {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}});
  maker.place(kLon, kLat);
  const std::string good = maker.glb();
  EXPECT_THAT(refused(good.substr(0, 10)), AllOf(HasSubstr("m.glb"), HasSubstr("header")));
  EXPECT_THAT(refused(good.substr(0, good.size() / 2)), HasSubstr("cut off"));
  std::string long_chunk = good;
  long_chunk[15] = '\x7f';
  EXPECT_THAT(refused(long_chunk), HasSubstr("beyond its end"));
  std::string version = good;
  version[4] = 1;
  EXPECT_THAT(refused(version), HasSubstr("version 1"));
  EXPECT_THAT(refused(glb_of("{\"asset\":", "")), HasSubstr("no JSON"));
  EXPECT_THAT(refused(glb_of("{}", "")), HasSubstr("asset.version"));
  EXPECT_THAT(refused(R"({"asset":{"version":"1.0"}})"), HasSubstr("glTF 1.0"));
  EXPECT_THAT(refused("b3dm and so on"), AllOf(HasSubstr("b3dm"), HasSubstr("upgrade")));
  GltfMaker compressed = maker;
  compressed.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(refused(compressed.glb()), AllOf(HasSubstr("KHR_draco_mesh_compression"), HasSubstr("Decompress")));
  GltfMaker draco = maker;
  draco.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  draco.json["accessors"][0].erase("bufferView");
  EXPECT_THAT(refused(draco.glb()), HasSubstr("Draco"));
}

TEST(DamagedGltf, LeavesOutWhatIsBroken) {
  const auto with = [](const std::function<void(Json&)>& damage) {
    GltfMaker maker = two_cubes();
    set_table(maker, {{"id", {{"type", "STRING"}}}}, {{"id", maker.texts({"A", "B"})}}, 2);
    damage(maker.json);
    return read_bytes(maker.glb());
  };
  EXPECT_EQ(with([](Json& j) { j["accessors"][1]["count"] = 1e15; }).count(NoteKind::bad_index), 1u);
  EXPECT_EQ(with([](Json& j) { j["accessors"][1]["bufferView"] = 99; }).count(NoteKind::bad_index), 2u);
  EXPECT_EQ(with([](Json& j) { j["accessors"][1]["byteOffset"] = 1e12; }).count(NoteKind::bad_index), 1u);
  EXPECT_GT(with([](Json& j) {
              j["accessors"][1].erase("bufferView");
              j["accessors"][1]["count"] = 1e12;
            }).count(NoteKind::bad_index),
            0u);
  EXPECT_GT(with([](Json& j) { j["bufferViews"][1]["byteLength"] = 1e12; }).count(NoteKind::bad_index), 0u);
  EXPECT_GT(with([](Json& j) { j["bufferViews"][1]["byteStride"] = 9e15; }).count(NoteKind::bad_index), 0u);
  EXPECT_GT(
      with([](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = -1; }).count(NoteKind::bad_index),
      0u);
  EXPECT_GT(with([](Json& j) { j["nodes"][0]["mesh"] = 77; }).count(NoteKind::bad_index), 0u);
  EXPECT_GT(with([](Json& j) { j["nodes"][0]["children"] = {0}; }).count(NoteKind::bad_hierarchy), 0u);
  EXPECT_GT(with([](Json& j) { j["nodes"][0]["children"] = {5}; }).count(NoteKind::bad_index), 0u);
  EXPECT_GT(with([](Json& j) { j["nodes"][0]["matrix"] = {1, 2, 3}; }).count(NoteKind::bad_value), 0u);
  const auto tables = [](Json& j) -> Json& { return j["extensions"]["EXT_structural_metadata"]["propertyTables"][0]; };
  EXPECT_GT(with([&](Json& j) { tables(j)["count"] = 1e15; }).count(NoteKind::bad_index), 0u);
  EXPECT_GT(with([&](Json& j) { tables(j)["count"] = 1; }).count(NoteKind::bad_index), 0u) << "feature 1 has no row";
  EXPECT_GT(with([&](Json& j) { tables(j)["properties"]["id"]["stringOffsets"] = 0; }).breaches(), 0u);
  EXPECT_GT(with([](Json& j) {
              j["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"]["featureIds"][0]["propertyTable"] = 8;
            }).count(NoteKind::bad_index),
            0u);
  // The cube that is sound is read in every case.
  EXPECT_GE(with([](Json& j) { j["accessors"][1]["count"] = 1e15; }).polygons.size(), 12u);
}

TEST(DamagedGltf, NumbersThatAreNoneAndIndicesThatLeadNowhere) {
  GltfMaker maker;
  const std::vector<float> p{0, 0, 0, 1, 0, 0, 1, 1, 0, NAN, 0, 0, 3e38F, 0, 0};
  const std::vector<std::uint16_t> triangles{0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 999};
  maker.node({{"mesh", maker.mesh({{"POSITION", maker.accessor(p, "VEC3", 5126)}},
                                  maker.accessor(triangles, "SCALAR", 5123))}});
  maker.place(kLon, kLat);
  const auto m = read_bytes(maker.glb());
  EXPECT_THAT(m.polygons, SizeIs(1));
  EXPECT_EQ(m.count(NoteKind::bad_coordinates), 2u);
  EXPECT_EQ(m.count(NoteKind::bad_index), 1u);
  ASSERT_THAT(m.buildings[0].geometries, SizeIs(1));
  EXPECT_EQ(m.buildings[0].geometries[0].outer_faces, 1u);
}

TEST(DamagedGltf, InstancesThatMultiplyAreRefused) {
  const auto read_with = [](std::size_t triangles, std::size_t instances) {
    GltfMaker maker;
    std::vector<std::uint16_t> corners;
    for (std::size_t i = 0; i < triangles; ++i) corners.insert(corners.end(), {0, 1, 2});
    const std::vector<float> points{0, 0, 0, 1, 0, 0, 1, 1, 0};
    const int position = maker.accessor(points, "VEC3", 5126), indices = maker.accessor(corners, "SCALAR", 5123);
    maker.json["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", instances}});
    const Json attributes = {{"TRANSLATION", maker.json["accessors"].size() - 1}};
    maker.node({{"mesh", maker.mesh({{"POSITION", position}}, indices)},
                {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    maker.place(kLon, kLat);
    return refused(maker.glb());
  };
  EXPECT_EQ(read_with(10, 20), "read");
  EXPECT_THAT(read_with(1001, 10'000), AllOf(HasSubstr("m.glb"), HasSubstr("more than 10000000 triangles")));
  EXPECT_THAT(read_with(1, 1'000'001), AllOf(HasSubstr("m.glb"), HasSubstr("more than 1000000 instances")));
}

TEST(DamagedGltf, DeepNestingDoesNotOverflow) {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}});
  maker.place(kLon, kLat);
  std::string json = maker.gltf();
  json.insert(1, "\"extras\":" + std::string(300000, '[') + std::string(300000, ']') + ",");
  EXPECT_THAT(refused(json), AllOf(HasSubstr("m.glb"), HasSubstr("deeper than 512 levels")));
  GltfMaker chain;
  const int cube = chain.cube(10);
  for (int i = 0; i < 50000; ++i) chain.node({{"children", {i + 1}}});
  chain.node({{"mesh", cube}});
  chain.place(kLon, kLat);
  EXPECT_THAT(read_bytes(chain.glb()).polygons, SizeIs(12));
}

/// A tile of a cube 10 m wide at the place, `east` m off it.
Json tile(const std::string& uri, double east = 0) {
  return {{"geometricError", 0},
          {"boundingVolume", {{"box", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}}},
          {"transform", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, east, 0, 0, 1}},
          {"content", {{"uri", uri}}}};
}

class Tiles : public testing::Test {
 protected:
  Tiles() {
    GltfMaker maker;
    maker.node({{"mesh", maker.cube(10)}, {"name", "house"}});
    folder_.write("house.glb", maker.glb());
  }
  std::string write(const std::string& name, const Json& root, bool placed = true) {
    Json json = {{"asset", {{"version", "1.1"}}}, {"geometricError", 100}, {"root", root}};
    if (placed) json["root"]["transform"] = georef::EnuFrame({kLon, kLat, 0}).local_to_ecef();
    return folder_.write(name, json.dump());
  }
  std::string refusal_of(const std::string& path) {
    try {
      read_gltf(path);
      return "read";
    } catch (const std::exception& error) {
      return error.what();
    }
  }
  TempFolder folder_;
};

TEST_F(Tiles, TransformsAreNestedAndTilesetsToo) {
  write("inner.json", {{"refine", "ADD"}, {"children", {tile("house.glb", 30)}}}, false);
  Json outer = tile("inner.json", 100);
  const auto m = read_gltf(write("tileset.json", {{"refine", "ADD"}, {"children", {tile("house.glb"), outer}}}));
  EXPECT_EQ(m.format, "3D Tiles 1.1");
  EXPECT_EQ(m.crs.horizontal, "EPSG:25833");
  EXPECT_EQ(m.crs.height_reference, HeightReference::ellipsoidal);
  ASSERT_THAT(m.buildings, SizeIs(2));
  EXPECT_TRUE(near(corners(m, m.buildings[0]).first, at(0, 0, 0)));
  EXPECT_TRUE(near(corners(m, m.buildings[1]).first, at(130, 0, 0)));
  EXPECT_GT(m.bytes, 2 * fs::file_size(folder_.path() + "/house.glb"));
}

TEST_F(Tiles, WhatIsReplacedDoesNotCount) {
  Json coarse = tile("house.glb", 50);
  coarse["refine"] = "REPLACE";
  coarse["children"] = {tile("house.glb", 60), tile("house.glb", 70)};
  EXPECT_THAT(read_gltf(write("tileset.json", {{"refine", "ADD"}, {"children", {coarse}}})).buildings, SizeIs(2));
  coarse["refine"] = "ADD";
  EXPECT_THAT(read_gltf(write("tileset.json", {{"refine", "REPLACE"}, {"children", {coarse}}})).buildings, SizeIs(3));
  Json many = tile("house.glb");
  many.erase("content");
  many["contents"] = {{{"uri", "house.glb"}}, {{"uri", "house.glb?v=1"}}};
  EXPECT_THAT(read_gltf(write("tileset.json", {{"refine", "ADD"}, {"children", {many}}})).buildings, SizeIs(2));
}

TEST_F(Tiles, WhatIsNotReadIsNotedOrRefused) {
  folder_.write("old.b3dm", "b3dm....");
  write("self.json", {{"refine", "ADD"}, {"children", {tile("self.json")}}}, false);
  folder_.write("broken.json", "{\"asset\":");
  const auto m =
      read_gltf(write("tileset.json", {{"refine", "ADD"},
                                       {"children",
                                        {tile("house.glb"), tile("old.b3dm"), tile("missing.glb"),
                                         tile("https://example.org/a.glb"), tile("self.json"), tile("broken.json")}}}));
  EXPECT_THAT(m.buildings, SizeIs(1));
  EXPECT_EQ(m.count(NoteKind::not_read), 1u);
  EXPECT_EQ(m.count(NoteKind::unresolved_link), 3u);
  EXPECT_EQ(m.count(NoteKind::malformed_json), 1u);
  EXPECT_THAT(refusal_of(write("b.json", {{"refine", "ADD"}, {"children", {tile("old.b3dm")}}})),
              AllOf(HasSubstr("b.json"), HasSubstr("b3dm"), HasSubstr("upgrade")));
  EXPECT_THAT(refusal_of(write("m.json", {{"refine", "ADD"}, {"children", {tile("missing.glb")}}})),
              AllOf(HasSubstr("m.json"), HasSubstr("none of its contents")));
  Json implicit = tile("{level}/{x}/{y}.glb");
  implicit["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"}};
  EXPECT_THAT(refusal_of(write("i.json", implicit)), HasSubstr("implicit"));
  EXPECT_THAT(refusal_of(write("n.json", {{"refine", "ADD"}, {"children", {tile("house.glb")}}}, false)),
              HasSubstr("where on the Earth"));
  EXPECT_THAT(refusal_of(folder_.write("r.json", R"({"asset":{"version":"1.1"},"root":3})")), HasSubstr("no root"));
}

TEST_F(Tiles, ThatNameTheNextTwiceAreRefused) {
  constexpr int kLevels = 30;  // 2^30 walks if all were made
  for (int i = 0; i < kLevels; ++i) {
    const Json next = tile(i + 1 < kLevels ? "t" + std::to_string(i + 1) + ".json" : "house.glb");
    write("t" + std::to_string(i) + ".json", {{"refine", "ADD"}, {"children", {next, next}}}, i == 0);
  }
  EXPECT_THAT(refusal_of(folder_.path() + "/t0.json"),
              AllOf(HasSubstr("t0.json"), HasSubstr("more than 10000 tilesets"), HasSubstr("again and again")));
  Json many = tile("house.glb");
  many["contents"] = Json(std::vector<Json>(100'001, Json{{"uri", "missing.glb"}}));
  EXPECT_THAT(refusal_of(write("many.json", many)),
              AllOf(HasSubstr("many.json"), HasSubstr("more than 100000 contents")));
}

TEST_F(Tiles, AFeatureThatIsCutByTilesIsOneBuilding) {
  GltfMaker maker = two_cubes();
  set_table(maker, {{"id", {{"type", "STRING"}}}}, {{"id", maker.texts({"A", "B"})}}, 2);
  folder_.write("two.glb", maker.glb());
  const auto m =
      read_gltf(write("tileset.json", {{"refine", "ADD"}, {"children", {tile("two.glb"), tile("two.glb", 50)}}}));
  ASSERT_THAT(m.buildings, SizeIs(2));
  EXPECT_THAT(m.buildings[0].geometries[0].faces, SizeIs(24));
}

}  // namespace
}  // namespace blockrand::importers::reference::test
