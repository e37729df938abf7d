// The reader of CityJSON: sound files come back whole, and every planted damage is found.
#include "pipeline/validate/cityjson_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::validate {
namespace {

using nlohmann::json;
using outputs::test::SampleRegion;

outputs::CityJsonOptions options() {
  outputs::CityJsonOptions o;
  o.crs_code = "EPSG:25833";
  o.name = "sample";
  o.data_time = "2020-03-04T05:06:07Z";
  return o;
}

std::string sequence() { return outputs::write_cityjson_sequence(SampleRegion::zoo().region(), options()); }

std::string object() {
  std::string out;
  outputs::SingleCityJson writer(options(), [&](std::string_view bytes) { out += bytes; });
  writer.add(SampleRegion::zoo().region());
  writer.finish();
  return out;
}

std::string listed(const std::vector<Finding>& findings) {
  std::string out;
  for (const Finding& f : findings) out += std::string(info(f.check).text) + " " + f.object + ": " + f.detail + "\n";
  return out;
}

const ReadBody& body(const Contents& c, const std::string& id) {
  for (const ReadBody& b : c.bodies)
    if (b.id == id) return b;
  throw std::runtime_error("no body " + id);
}

TEST(ReadCityJson, SoundFilesComeBackWhole) {
  const SampleRegion zoo = SampleRegion::zoo();
  for (const bool in_sequence : {true, false}) {
    const Contents c = in_sequence ? read_cityjson(sequence(), "cityjson/15_1_2.city.jsonl")
                                   : read_cityjson(object(), "model.city.json");
    EXPECT_TRUE(c.findings.empty()) << listed(c.findings);
    EXPECT_EQ(c.buildings, (std::vector<std::string>{"w-7", "w12", "w30", "w40", "w50", "w60"}));
    std::vector<std::string> ids;
    for (const ReadBody& b : c.bodies) ids.push_back(b.id);
    EXPECT_EQ(ids, (std::vector<std::string>{"w-7", "w12", "w30.w31", "w30.w32", "w30.rest", "w40", "w50.1", "w50.2",
                                             "w60"}));
    EXPECT_EQ(body(c, "w30.rest").building, "w30");
    EXPECT_EQ(body(c, "w60").solids.size(), 0u);
    EXPECT_EQ(body(c, "w60").footprint.size(), 1u);
    EXPECT_EQ(body(c, "w40").footprint.at(0).rings.size(), 2u);

    const ReadBody& house = body(c, "w12");
    EXPECT_EQ(house.attributes.at("height"), "9.5");
    EXPECT_EQ(house.attributes.at("height_source"), "implied");
    EXPECT_EQ(house.attributes.at("height_confidence"), "0.75");
    EXPECT_EQ(house.attributes.at("storeys_confidence"), "0.6");
    EXPECT_EQ(house.attributes.at("roof_colour"), "#a03c28");
    EXPECT_EQ(house.attributes.at("built_roof"), "gabled");
    EXPECT_EQ(house.attributes.at("lod"), "2");

    const model::BuildingPart& part = zoo.region().buildings.at(1).parts.at(0);
    ASSERT_EQ(house.solids.size(), 2u);
    EXPECT_EQ(house.solids[0].lod, 1);
    const ReadSolid& solid = house.solids[1];
    ASSERT_EQ(solid.polygons.size(), part.lod2.faces.size());
    for (std::size_t f = 0; f < solid.polygons.size(); ++f) {
      const model::Face& face = part.lod2.faces[f];
      std::vector<model::Point3> expected;
      for (const std::uint32_t v : part.lod2.indices_of(part.lod2.loops_of(face)[0]))
        expected.push_back(part.lod2.vertices[v]);
      EXPECT_EQ(solid.polygons[f].rings.at(0), expected);
      EXPECT_EQ(solid.polygons[f].colour, model::text(face.colour));
      EXPECT_EQ(solid.polygons[f].kind, face.kind == model::SurfaceKind::wall   ? "wall"
                                        : face.kind == model::SurfaceKind::roof ? "roof"
                                                                                : "ground");
    }
    EXPECT_EQ(house.solids[0].polygons[0].colour, "");
  }
}

TEST(ReadCityJson, EmptyBuildsAreSound) {
  const SampleRegion nothing;
  const Contents c = read_cityjson(outputs::write_cityjson_sequence(nothing.region(), {}), "a.city.jsonl");
  EXPECT_TRUE(c.findings.empty()) << listed(c.findings);
  EXPECT_TRUE(c.buildings.empty());
}

// ---- damages ----

/// The lines of the sample's sequence as JSON: header, w-7, w12, w30, w40, w50, w60.
struct Lines {
  std::vector<json> lines;
  json& header = lines[0];
  json& box = lines[1];
  json& house = lines[2];
  json& church = lines[3];
  json& geometry(std::size_t i) { return house["CityObjects"]["w12"]["geometry"][i]; }
  json& attributes() { return house["CityObjects"]["w12"]["attributes"]; }

  Lines() : lines(parsed()) {}
  static std::vector<json> parsed() {
    std::vector<json> out;
    std::istringstream stream(sequence());
    for (std::string line; std::getline(stream, line);) out.push_back(json::parse(line));
    return out;
  }
  std::string text() const {
    std::string out;
    for (const json& line : lines) out += line.dump() + "\n";
    return out;
  }
};

struct Damage {
  const char* expected;  ///< part of a finding's text, "CODE object: detail"
  std::function<void(Lines&)> plant;
};

const std::vector<Damage>& damages() {
  static const std::vector<Damage> list = {
      {"the type is not CityJSON", [](Lines& l) { l.header["type"] = "FeatureCollection"; }},
      {"the version is not", [](Lines& l) { l.header["version"] = "1.1"; }},
      {"the version is not", [](Lines& l) { l.header["version"] = 2.0; }},
      {"no CityObjects", [](Lines& l) { l.header.erase("CityObjects"); }},
      {"no vertices", [](Lines& l) { l.header.erase("vertices"); }},
      {"no transform", [](Lines& l) { l.header.erase("transform"); }},
      {"no transform", [](Lines& l) { l.header["transform"]["scale"].erase(2); }},
      {"a scale of 0", [](Lines& l) { l.header["transform"]["scale"][0] = 0; }},
      {"OFF_GRID", [](Lines& l) { l.header["transform"]["scale"][0] = 0.001; }},
      {"OFF_GRID", [](Lines& l) { l.header["transform"]["translate"][1] = 5819000.0001; }},
      {"the first line's CityObjects are not empty", [](Lines& l) { l.header["CityObjects"]["x"] = json::object(); }},
      {"referenceSystem", [](Lines& l) { l.header["metadata"]["referenceSystem"] = "urn:ogc:def:crs:EPSG::25833"; }},
      {"referenceSystem",
       [](Lines& l) { l.header["metadata"]["referenceSystem"] = "https://www.opengis.net/def/crs/EPSG/0/"; }},
      {"referenceDate", [](Lines& l) { l.header["metadata"]["referenceDate"] = "2020-13-01"; }},
      {"outside of geographicalExtent", [](Lines& l) { l.header["metadata"]["geographicalExtent"][5] = 50; }},
      {"inside out", [](Lines& l) { l.header["metadata"]["geographicalExtent"][3] = 0; }},
      {"unknown member colour", [](Lines& l) { l.header["metadata"]["colour"] = "red"; }},
      {"the type is not CityJSONFeature", [](Lines& l) { l.house["type"] = "CityJSON"; }},
      {"the id of the feature is none", [](Lines& l) { l.house["id"] = "w13"; }},
      {"the feature's object is a part of another", [](Lines& l) { l.church["id"] = "w30.w31"; }},
      {"a second first-level object", [](Lines& l) { l.house["CityObjects"]["w99"] = l.house["CityObjects"]["w12"]; }},
      {"a feature with the member transform", [](Lines& l) { l.house["transform"] = l.header["transform"]; }},
      {"CITYJSON_RULE w12: its id is given twice", [](Lines& l) { l.lines.push_back(l.house); }},
      {"of the unknown type", [](Lines& l) { l.house["CityObjects"]["w12"]["type"] = "House"; }},
      {"BuildingPart without parents", [](Lines& l) { l.church["CityObjects"]["w30.w31"].erase("parents"); }},
      {"Building with parents", [](Lines& l) { l.house["CityObjects"]["w12"]["parents"] = {"w30"}; }},
      {"does not name it as a child", [](Lines& l) { l.church["CityObjects"]["w30"]["children"].erase(1); }},
      {"does not name it as a parent", [](Lines& l) { l.church["CityObjects"]["w30.w32"]["parents"][0] = "w31"; }},
      {"its child w30.w31 is not in the file", [](Lines& l) { l.church["CityObjects"].erase("w30.w31"); }},
      {"its parent w31 is not in the file", [](Lines& l) { l.church["CityObjects"]["w30.w32"]["parents"][0] = "w31"; }},
      {"twice in its children", [](Lines& l) { l.church["CityObjects"]["w30"]["children"].push_back("w30.w31"); }},
      {"its geometry is no array", [](Lines& l) { l.house["CityObjects"]["w12"]["geometry"] = json::object(); }},
      {"its address is no array", [](Lines& l) { l.house["CityObjects"]["w12"]["address"] = json::object(); }},
      {"has geometry beside its parts",
       [](Lines& l) {
         l.church["CityObjects"]["w30"]["geometry"] = {l.church["CityObjects"]["w30.w31"]["geometry"][0]};
       }},
      {"vertices are not three integers", [](Lines& l) { l.house["vertices"][3][1] = 1.5; }},
      {"vertices are not three integers", [](Lines& l) { l.house["vertices"][3].push_back(0); }},
      {"vertices stand twice", [](Lines& l) { l.house["vertices"][3] = l.house["vertices"][2]; }},
      {"1 vertices are used by nothing",
       [](Lines& l) {
         l.house["vertices"].push_back({1, 2, 3});
       }},
      {"has the vertex index 99 of", [](Lines& l) { l.geometry(2)["boundaries"][0][1][0][0] = 99; }},
      {"has the vertex index -1 of", [](Lines& l) { l.geometry(2)["boundaries"][0][1][0][0] = -1; }},
      {"has the vertex index 1.5 of", [](Lines& l) { l.geometry(2)["boundaries"][0][1][0][0] = 1.5; }},
      {"boundaries of the wrong depth", [](Lines& l) { l.geometry(2)["boundaries"] = l.geometry(2)["boundaries"][0]; }},
      {"boundaries of the wrong depth", [](Lines& l) { l.geometry(0)["boundaries"] = {l.geometry(0)["boundaries"]}; }},
      {"has a Solid of LoD 0", [](Lines& l) { l.geometry(2)["lod"] = "0"; }},
      {"has a MultiSurface of LoD 1", [](Lines& l) { l.geometry(0)["lod"] = "1"; }},
      {"solids out of the order of their LoD, or one twice", [](Lines& l) { l.geometry(0)["lod"] = "2"; }},
      {"whose lod is no text", [](Lines& l) { l.geometry(2)["lod"] = 2; }},
      {"has no geometry of LoD 0", [](Lines& l) { l.house["CityObjects"]["w12"]["geometry"].erase(0); }},
      {"out of the order of their LoD", [](Lines& l) { l.geometry(1)["lod"] = "2"; }},
      {"has a geometry of the type \"MultiPoint\"", [](Lines& l) { l.geometry(2)["type"] = "MultiPoint"; }},
      {"has a geometry without boundaries", [](Lines& l) { l.geometry(2).erase("boundaries"); }},
      {"unknown member colour", [](Lines& l) { l.geometry(2)["colour"] = "red"; }},
      {"last vertex repeats the first",
       [](Lines& l) {
         json& ring = l.geometry(2)["boundaries"][0][1][0];
         ring.push_back(ring[0]);
       }},
      {"has a ring: 101 too few points",
       [](Lines& l) {
         l.geometry(2)["boundaries"][0][1][0] = {0, 1};
       }},
      {"has a ring: 102 consecutive points the same",
       [](Lines& l) {
         json& ring = l.geometry(2)["boundaries"][0][1][0];
         ring.insert(ring.begin() + 1, ring[0]);
       }},
      {"a surface without rings", [](Lines& l) { l.geometry(2)["boundaries"][0][1] = json::array(); }},
      {"has 2 faces",
       [](Lines& l) {
         json& shell = l.geometry(1)["boundaries"][0];
         shell.erase(shell.begin() + 2, shell.end());
       }},
      {"has semantics of 6 values beside 7", [](Lines& l) { l.geometry(2)["semantics"]["values"][0].erase(0); }},
      {"has the semantic index 7 of 3", [](Lines& l) { l.geometry(2)["semantics"]["values"][0][0] = 7; }},
      {"has semantics without surfaces or values", [](Lines& l) { l.geometry(2)["semantics"].erase("values"); }},
      {"a surface of the type \"Wall\"", [](Lines& l) { l.geometry(2)["semantics"]["surfaces"][1]["type"] = "Wall"; }},
      {"has a material of 6 values beside 7",
       [](Lines& l) { l.geometry(2)["material"]["visual"]["values"][0].erase(0); }},
      {"has the material index 9 of 3", [](Lines& l) { l.geometry(2)["material"]["visual"]["values"][0][0] = 9; }},
      {"has the material index", [](Lines& l) { l.house.erase("appearance"); }},
      {"has the theme visual without values", [](Lines& l) { l.geometry(2)["material"]["visual"] = json::object(); }},
      {"a material without a name", [](Lines& l) { l.house["appearance"]["materials"][0].erase("name"); }},
      {"diffuseColor is not", [](Lines& l) { l.house["appearance"]["materials"][0]["diffuseColor"][0] = 222; }},
      {"shininess is no number", [](Lines& l) { l.house["appearance"]["materials"][0]["shininess"] = 5; }},
      {"a material with the unknown member", [](Lines& l) { l.house["appearance"]["materials"][0]["roughness"] = 1; }},
      {"SOURCE_WRONG w12: height from \"guess\"", [](Lines& l) { l.attributes()["height_source"] = "guess"; }},
      {"SOURCE_WRONG w12: height without source", [](Lines& l) { l.attributes().erase("height_source"); }},
      {"SOURCE_WRONG w12: confidence of height is 1.5", [](Lines& l) { l.attributes()["height_confidence"] = 1.5; }},
      {"measuredHeight is 9.5, but height is 12", [](Lines& l) { l.attributes()["height"] = 12; }},
      {"function is apartments, but use is shed", [](Lines& l) { l.attributes()["use"] = "shed"; }},
      {"its external reference leads to",
       [](Lines& l) { l.attributes()["externalReference"] = "https://www.openstreetmap.org/way/13"; }},
      {"has neither parts nor an attribute lod", [](Lines& l) { l.attributes().erase("lod"); }},
      {"has no attributes", [](Lines& l) { l.house["CityObjects"]["w12"].erase("attributes"); }},
  };
  return list;
}

TEST(ReadCityJson, FindsEveryPlantedDamage) {
  ASSERT_TRUE(read_cityjson(Lines().text(), "a.city.jsonl").findings.empty());
  for (std::size_t i = 0; i < damages().size(); ++i) {
    Lines lines;
    damages()[i].plant(lines);
    const Contents c = read_cityjson(lines.text(), "a.city.jsonl");
    EXPECT_NE(listed(c.findings).find(damages()[i].expected), std::string::npos)
        << "damage " << i << ": " << damages()[i].expected << "\nfound:\n"
        << listed(c.findings);
  }
}

void expect_finding(const std::string& text, const std::string& file, const std::string& expected) {
  const std::string found = listed(read_cityjson(text, file).findings);
  EXPECT_NE(found.find(expected), std::string::npos) << "expected: " << expected << "\nfound:\n" << found;
}

TEST(ReadCityJson, FindsDamageOfTheText) {
  const std::string text = sequence();
  expect_finding(text.substr(0, text.size() - 1), "a.city.jsonl", "the last line has no end");
  expect_finding(text.substr(0, text.size() - 20), "a.city.jsonl", "FILE_UNREADABLE");
  expect_finding(text.substr(text.find('\n') + 1), "a.city.jsonl", "the type is not CityJSON");
  expect_finding(text + "\n", "a.city.jsonl", "is empty");
  expect_finding("", "a.city.jsonl", "the last line has no end");
  expect_finding("[]\n", "a.city.jsonl", "is no JSON object");
  expect_finding("\xFF\n", "a.city.jsonl", "FILE_UNREADABLE");
  expect_finding("", "a.city.json", "FILE_UNREADABLE");
  expect_finding("[1]", "a.city.json", "is no JSON object");

  std::string doubled = text;
  doubled.replace(doubled.find("\"w30.w32\":{"), 11, "\"w30.w31\":{");
  expect_finding(doubled, "a.city.jsonl", "\"w30.w31\" stands twice in an object");
  expect_finding(doubled, "a.city.jsonl", "its id is given twice");

  std::string whole = object();
  whole.replace(whole.find("\"w12\":{"), 7, "\"w40\":{");
  expect_finding(whole, "a.city.json", "\"w40\" stands twice in an object");
}

TEST(ReadCityJson, ReportsAreBounded) {
  Lines lines;
  for (int i = 0; i < 5000; ++i) lines.house["CityObjects"]["x" + std::to_string(i)] = nullptr;
  EXPECT_LE(read_cityjson(lines.text(), "a.city.jsonl").findings.size(), 1000u);
}

}  // namespace
}  // namespace blockrand::validate
