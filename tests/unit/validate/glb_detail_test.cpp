// GLBs with placed elements read back: what is sound has no findings, and damage has one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/validate/glb.h"
#include "pipeline/validate/placed_elements.h"
#include "tests/unit/outputs/facade_region.h"

namespace blockrand::validate {
namespace {

using nlohmann::json;
using outputs::Compression;
using outputs::Instancing;

/// A frame that stands on the Earth: its matrix is that of its origin.
outputs::GlbOptions options(Instancing how, Compression compression = Compression::none) {
  outputs::GlbOptions o;
  o.lod = 3;
  o.instancing = how;
  o.compression = compression;
  o.crs = "EPSG:25833";
  o.height_reference = "heights above local ground";
  o.frame.longitude = 13.4;
  o.frame.latitude = 52.5;
  o.frame.height = 35;
  o.frame.enu_to_ecef = east_north_up({13.4 * kRadians, 52.5 * kRadians, 35});
  o.frame.to_enu = [](std::span<const model::Point3> in, std::span<model::Point3> out) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double x = in[i].x - 391040.7, y = in[i].y - 5819030.2;
      out[i] = {0.99978 * x - 0.02094 * y, 0.02094 * x + 0.99978 * y, in[i].z};
    }
  };
  return o;
}

struct Read {
  Glb glb;
  std::vector<Finding> findings;
  bool found(Check check, const std::string& word) const {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const Finding& f) { return f.check == check && f.detail.find(word) != std::string::npos; });
  }
  std::string text() const {
    std::string out;
    for (const Finding& f : findings) out += std::string(info(f.check).text) + " " + f.object + " " + f.detail + "\n";
    return out;
  }
};

Read read(const std::string& bytes, bool elements_apart = true) {
  Read out;
  out.glb = read_glb(bytes, "a.glb");
  out.findings = out.glb.contents.findings;
  if (elements_apart && out.glb.readable) check_openings(out.glb, "a.glb", out.findings);
  return out;
}

/// The file with its document and bytes changed.
std::string changed(const std::string& bytes, const std::function<void(json&, std::string&)>& change) {
  std::uint32_t length = 0;
  std::memcpy(&length, &bytes[12], 4);
  json document = json::parse(bytes.substr(20, length));
  std::string binary = bytes.substr(28 + length);
  change(document, binary);
  std::string text = document.dump();
  while (text.size() % 4 != 0) text += ' ';
  const auto word = [](std::size_t value) {
    const auto v = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&v), 4);
  };
  return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
         word(binary.size()) + std::string("BIN\0", 4) + binary;
}

std::size_t wanted_places(const model::Region& region) {
  std::size_t n = 0;
  for (const auto& b : region.buildings)
    for (const auto& part : b.parts) n += part.lod3.placements.size();
  return n;
}

json& instancing_of(json& document, std::size_t number = 0) {
  for (json& node : document["nodes"])
    if (node.contains("extensions") && number-- == 0) return node["extensions"];
  throw std::runtime_error("no instances");
}

/// Where the values of an accessor begin.
std::size_t place_of(const json& document, const json& accessor) {
  const json& a = document["accessors"][accessor.get<std::size_t>()];
  return document["bufferViews"][a["bufferView"].get<std::size_t>()].value("byteOffset", std::size_t{0}) +
         a.value("byteOffset", std::size_t{0});
}

class GlbDetail : public testing::Test {
 protected:
  const outputs::test::SampleRegion sample_ = outputs::test::facade_region();
  const std::string ext_ = outputs::write_glb(sample_.region(), options(Instancing::ext)).bytes;

  void finds(const std::function<void(json&, std::string&)>& change, Check check, const std::string& word) {
    const Read damaged = read(changed(ext_, change));
    EXPECT_TRUE(damaged.found(check, word)) << damaged.text();
  }
};

outputs::GlbOptions object_options(Instancing how) {
  outputs::GlbOptions o = options(how);
  o.objects = outputs::Objects::building;
  return o;
}

TEST_F(GlbDetail, ObjectsOfHousesAreSoundAndShowTheSame) {
  const std::vector<DrawnArea> wanted = drawn_areas(read(ext_).glb);
  ASSERT_GT(wanted.at(0).all, 500);
  for (const Instancing how : {Instancing::ext, Instancing::baked, Instancing::nodes}) {
    const outputs::Glb written = outputs::write_glb(sample_.region(), object_options(how));
    EXPECT_EQ(written.bytes.find("extensionsRequired"), std::string::npos) << "every reader takes it";
    EXPECT_EQ(written.bytes.find("KHR_mesh_quantization"), std::string::npos);
    const Read r = read(written.bytes, how == Instancing::nodes);
    EXPECT_EQ(r.text(), "");
    EXPECT_TRUE(r.glb.objects);
    EXPECT_EQ(r.glb.places.size(), how == Instancing::nodes ? wanted_places(sample_.region()) : 0);
    std::size_t triangles = 0;
    for (const auto& body : r.glb.triangles) triangles += body.size();
    for (const GlbPlace& place : r.glb.places) triangles += r.glb.elements[place.element].triangles.size();
    EXPECT_EQ(triangles, written.triangles);
    EXPECT_EQ(written.buildings, sample_.region().buildings.size());
    const std::vector<DrawnArea> drawn = drawn_areas(r.glb);
    ASSERT_EQ(drawn.size(), wanted.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) EXPECT_NEAR(drawn[i].all, wanted[i].all, 1e-3 * wanted[i].all) << i;
    for (const model::Point3& p : r.glb.vertices) {
      EXPECT_GT(p.x, written.min.x - 0.002);
      EXPECT_LT(p.x, written.max.x + 0.002);
    }
  }
}

TEST_F(GlbDetail, DamagedObjectsAreFound) {
  const std::string objects = outputs::write_glb(sample_.region(), object_options(Instancing::ext)).bytes;
  const auto found = [&](const std::function<void(json & house, json & part, json & document)>& change, Check check,
                         const std::string& word) {
    const Read damaged =
        read(changed(objects,
                     [&](json& document, std::string&) {
                       json& house = document["nodes"][document["scenes"][0]["nodes"][0].get<std::size_t>()];
                       change(house, document["nodes"][house["children"][0].get<std::size_t>()], document);
                     }),
             false);
    EXPECT_TRUE(damaged.found(check, word)) << word << ": " << damaged.text();
  };
  found([](json& house, json&, json&) { house["extras"]["id"] = "w999"; }, Check::metadata_rule, "w999");
  found([](json& house, json&, json&) { house.erase("name"); }, Check::glb_rule, "no name");
  found([](json&, json& part, json&) { part["extras"]["id"] = "w999"; }, Check::metadata_rule, "its part is w999");
  found([](json&, json& part, json&) { part["extras"]["feature"] = 1; }, Check::metadata_rule, "row 1");
  found([](json&, json& part, json&) { part["extras"]["feature"] = 99; }, Check::metadata_rule, "feature id 99");
  found([](json&, json& part, json&) { part.erase("name"); }, Check::glb_rule, "no name");
  found(
      [](json& house, json& part, json& document) {
        const json copy = part;  // a new node moves the others
        house["children"].push_back(document["nodes"].size());
        document["nodes"].push_back(copy);
      },
      Check::glb_rule, "a second object of the part");
  found(
      [](json& house, json&, json& document) {
        json second = house;
        second.erase("children");
        document["nodes"].push_back(second);
        document["scenes"][0]["nodes"].push_back(document["nodes"].size() - 1);
      },
      Check::glb_rule, "a second object of the building");
  found([](json& house, json&, json&) { house["translation"] = {1e9, 0, 0}; }, Check::glb_rule, "lies nowhere");
}

TEST_F(GlbDetail, WhatIsWrittenIsSound) {
  for (const Instancing how : {Instancing::ext, Instancing::nodes})
    for (const Compression compression : {Compression::none, Compression::meshopt}) {
      const outputs::Glb written = outputs::write_glb(sample_.region(), options(how, compression));
      const Read r = read(written.bytes);
      EXPECT_EQ(r.text(), "");
      EXPECT_GE(r.glb.places.size(), wanted_places(sample_.region())) << "pieces are more";
      EXPECT_TRUE(how == Instancing::ext || r.glb.places.size() == wanted_places(sample_.region()));
      EXPECT_EQ(r.glb.pieces, how == Instancing::ext);
      std::size_t triangles = 0;
      for (const auto* list : {&r.glb.triangles, &r.glb.element_triangles})
        for (const auto& body : *list) triangles += body.size();
      for (const GlbPlace& place : r.glb.places) triangles += r.glb.elements[place.element].triangles.size();
      EXPECT_EQ(triangles, written.triangles);
      for (const model::Point3& p : place_corners(r.glb)) {
        EXPECT_GT(p.x, written.min.x - 0.002);
        EXPECT_LT(p.x, written.max.x + 0.002);
        EXPECT_GT(p.y, written.min.y - 0.002);
        EXPECT_LT(p.y, written.max.y + 0.002);
        EXPECT_GT(p.z, written.min.z - 0.002);
        EXPECT_LT(p.z, written.max.z + 0.002);
      }
    }
  const Glb baked = read_glb(outputs::write_glb(sample_.region(), options(Instancing::baked)).bytes, "a.glb");
  EXPECT_TRUE(baked.contents.findings.empty());
  EXPECT_TRUE(baked.places.empty());
}

TEST_F(GlbDetail, CompressedBytesAreReadAsTheyWere) {
  const Glb plain = read_glb(ext_, "a.glb"),
            packed = read_glb(
                outputs::write_glb(sample_.region(), options(Instancing::ext, Compression::meshopt)).bytes, "b.glb");
  ASSERT_EQ(plain.triangles.size(), packed.triangles.size());
  for (std::size_t i = 0; i < plain.triangles.size(); ++i) {
    ASSERT_EQ(plain.triangles[i].size(), packed.triangles[i].size());
    for (std::size_t t = 0; t < plain.triangles[i].size(); ++t) {
      auto a = plain.triangles[i][t].corners, b = packed.triangles[i][t].corners;
      std::rotate(a.begin(), std::min_element(a.begin(), a.end()), a.end());
      std::rotate(b.begin(), std::min_element(b.begin(), b.end()), b.end());
      ASSERT_EQ(a, b);
    }
  }
  ASSERT_EQ(plain.places.size(), packed.places.size());
  for (std::size_t i = 0; i < plain.places.size(); ++i) {
    EXPECT_EQ(plain.places[i].matrix, packed.places[i].matrix);
    EXPECT_EQ(plain.places[i].row, packed.places[i].row);
  }
}

TEST_F(GlbDetail, ElementsThatAreNotThereLeaveHoles) {
  finds(
      [](json& j, std::string&) {
        for (json& node : j["nodes"])
          if (node.contains("children")) node["children"].erase(0);
      },
      Check::glb_rule, "is open at");
}

TEST_F(GlbDetail, AnElementThatStandsElsewhereLeavesAHole) {
  finds(
      [](json& j, std::string& b) {
        const float far = 0;
        std::memcpy(&b[place_of(j, instancing_of(j)["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"])], &far, 4);
      },
      Check::glb_rule, "is open at");
}

TEST_F(GlbDetail, ElementsWithoutAShapeLeaveTheirOpeningsClosed) {
  for (const bool endless : {false, true}) {
    outputs::test::SampleRegion s = outputs::test::facade_region();
    auto hole = std::make_shared<model::Element>(*s.region().elements[0].element);
    if (endless)
      for (model::Point3& p : hole->mesh.vertices) p.x = std::numeric_limits<double>::infinity();
    else
      hole->mesh = {};
    s.region().elements[0].element = hole;
    for (const Instancing how : {Instancing::ext, Instancing::nodes})
      EXPECT_EQ(read(outputs::write_glb(s.region(), options(how)).bytes).text(), "");
  }
}

TEST_F(GlbDetail, ElementsAreComparedByPlaceTurnAndColour) {
  // The file's own places stand for another format's.
  const Glb glb = read_glb(ext_, "a.glb");
  Contents contents;
  for (std::size_t row = 0; row < glb.contents.bodies.size(); ++row) {
    ReadBody body;
    body.id = glb.contents.bodies[row].id;
    for (const GlbPlace& place : glb.places) {
      if (place.row != row) continue;
      const double length = std::hypot(place.matrix[0], place.matrix[2]);
      body.detail.placements.push_back(
          {place.element, placed(place, {0, 0, 0}), {place.matrix[0] / length, -place.matrix[2] / length}});
    }
    contents.bodies.push_back(std::move(body));
  }
  for (std::size_t e = 0; e < glb.elements.size(); ++e) {
    ReadElement& element = contents.elements[e];
    std::set<std::string> colours;
    for (const GlbTriangle& t : glb.elements[e].triangles) {
      char text[8];
      std::snprintf(text, sizeof(text), "#%02x%02x%02x", t.colour[0], t.colour[1], t.colour[2]);
      colours.insert(text);
    }
    element.colours.assign(colours.begin(), colours.end());
  }
  const std::string name = "a.gml";
  const auto compared = [&](const Contents& other) {
    Read out;
    compare_places(
        {other, name}, glb, "a.glb",
        [](std::span<const model::Point3> in, std::span<model::Point3> to) {
          std::copy(in.begin(), in.end(), to.begin());
        },
        0.01, out.findings);
    return out;
  };
  EXPECT_EQ(compared(contents).text(), "");
  Contents turned = contents;
  model::Point2& along = turned.bodies[0].detail.placements[0].along;
  along = {-along.x, -along.y};
  EXPECT_TRUE(compared(turned).found(Check::geometry_differs, "turned otherwise")) << compared(turned).text();
  Contents other = contents;
  for (auto& [number, element] : other.elements) element.colours = {"#123456"};
  EXPECT_TRUE(compared(other).found(Check::colour_differs, "which it has not")) << compared(other).text();
}

TEST_F(GlbDetail, PiecesFillTheElementsOfAnotherFormat) {
  // What nodes show as a whole stands for another format's elements.
  const Glb whole = read_glb(outputs::write_glb(sample_.region(), options(Instancing::nodes)).bytes, "b.glb"),
            pieces = read_glb(ext_, "a.glb");
  Contents contents;
  for (std::size_t row = 0; row < whole.contents.bodies.size(); ++row) {
    ReadBody& body = contents.bodies.emplace_back();
    body.id = whole.contents.bodies[row].id;
    for (const GlbPlace& place : whole.places)
      if (place.row == row) {
        const double length = std::hypot(place.matrix[0], place.matrix[2]);
        body.detail.placements.push_back(
            {place.element, placed(place, {0, 0, 0}), {place.matrix[0] / length, -place.matrix[2] / length}});
      }
  }
  for (std::size_t e = 0; e < whole.elements.size(); ++e) {
    const GlbElement& from = whole.elements[e];
    ReadElement& to = contents.elements[e];
    constexpr double kStep = 1.0 / 4096;
    to.min = {from.min.x * kStep, -from.max.z * kStep, from.min.y * kStep};
    to.max = {from.max.x * kStep, -from.min.z * kStep, from.max.y * kStep};
    std::set<std::string> colours;
    for (const GlbTriangle& t : from.triangles) {
      char text[8];
      std::snprintf(text, sizeof(text), "#%02x%02x%02x", t.colour[0], t.colour[1], t.colour[2]);
      colours.insert(text);
    }
    to.colours.assign(colours.begin(), colours.end());
  }
  const auto compared = [&](const Contents& other) {
    Read out;
    compare_pieces(
        {other, "a.gml"}, pieces, "a.glb",
        [](std::span<const model::Point3> in, std::span<model::Point3> to) {
          std::copy(in.begin(), in.end(), to.begin());
        },
        0.01, out.findings);
    return out;
  };
  EXPECT_EQ(compared(contents).text(), "");
  Contents moved = contents;
  moved.bodies[0].detail.placements[0].origin.z += 0.1;
  EXPECT_TRUE(compared(moved).found(Check::geometry_differs, "are not there")) << compared(moved).text();
  Contents fewer = contents;
  fewer.bodies[0].detail.placements.clear();
  EXPECT_TRUE(compared(fewer).found(Check::geometry_differs, "has none")) << compared(fewer).text();
  Contents wider = contents;
  for (auto& [number, element] : wider.elements) element.max.x += 0.1;
  EXPECT_TRUE(compared(wider).found(Check::geometry_differs, "are not there")) << compared(wider).text();
  Contents other = contents;
  for (auto& [number, element] : other.elements) element.colours = {"#123456"};
  EXPECT_TRUE(compared(other).found(Check::colour_differs, "which none has")) << compared(other).text();
}

TEST_F(GlbDetail, WrongFeatureIds) {
  finds(
      [](json& j, std::string& b) {
        const std::uint16_t far = 60000;
        std::memcpy(&b[place_of(j, instancing_of(j)["EXT_mesh_gpu_instancing"]["attributes"]["_FEATURE_ID_0"])], &far,
                    2);
      },
      Check::metadata_rule, "60000");
  finds(
      [](json& j, std::string&) {
        json& id = instancing_of(j)["EXT_instance_features"]["featureIds"][0];
        id["featureCount"] = id["featureCount"].get<int>() + 1;
      },
      Check::metadata_rule, "featureCount");
  finds([](json& j, std::string&) { instancing_of(j).erase("EXT_instance_features"); }, Check::metadata_rule,
        "EXT_instance_features");
}

TEST_F(GlbDetail, WrongCounts) {
  finds(
      [](json& j, std::string&) {
        json& a =
            j["accessors"][instancing_of(j)["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"].get<std::size_t>()];
        a["count"] = a["count"].get<int>() - 1;
      },
      Check::glb_rule, "values of another attribute");
  finds(
      [](json& j, std::string&) {
        json& a =
            j["accessors"][instancing_of(j)["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"].get<std::size_t>()];
        a["count"] = 1000000;
      },
      Check::glb_rule, "leaves its buffer view");
}

TEST_F(GlbDetail, ATurnThatIsNone) {
  finds(
      [](json& j, std::string& b) {
        const std::int16_t half = 20000;
        const std::size_t at = place_of(j, instancing_of(j)["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"]);
        for (const std::size_t k : {2u, 6u}) std::memcpy(&b[at + k], &half, 2);
      },
      Check::glb_rule, "no unit quaternion");
}

TEST_F(GlbDetail, BrokenCompressedStreams) {
  const std::string packed = outputs::write_glb(sample_.region(), options(Instancing::ext, Compression::meshopt)).bytes;
  const auto view_of = [](json& j) -> json& {
    for (json& view : j["bufferViews"])
      if (view.contains("extensions")) return view["extensions"]["EXT_meshopt_compression"];
    throw std::runtime_error("nothing is compressed");
  };
  const auto check = [&](const std::function<void(json&, std::string&)>& change, const std::string& word) {
    const Read r = read(changed(packed, change));
    EXPECT_TRUE(r.found(Check::glb_rule, word)) << r.text();
  };
  check([&](json& j, std::string& b) { b[view_of(j).value("byteOffset", std::size_t{0})] = 0; },
        "cannot be decompressed");
  check([&](json& j, std::string&) { view_of(j)["byteLength"] = view_of(j)["byteLength"].get<int>() - 4; },
        "cannot be decompressed");
  check([&](json& j, std::string&) { view_of(j)["count"] = 1u << 30; }, "more elements than its bytes can hold");
  check([&](json& j, std::string&) { view_of(j)["mode"] = "INDICES"; }, "mode");
  check([&](json& j, std::string&) { j["buffers"].erase(1); }, "leaves the buffer");
}

}  // namespace
}  // namespace blockrand::validate
