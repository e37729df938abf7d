#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/outputs/gltf/linear_light.h"
#include "tests/unit/outputs/closed.h"
#include "tests/unit/outputs/sample_region.h"
#include "tests/validators/glb_reader.h"

namespace blockrand::outputs {
namespace {

using test::SampleRegion;
using validators::GlbFile;

GlbOptions options() {
  GlbOptions o;
  o.crs = "EPSG:25833";
  o.height_reference = "heights above local ground";
  o.generator = "blockrand test";
  o.attribution = "\xC2\xA9 OpenStreetMap contributors, ODbL 1.0";
  o.frame.longitude = 13.4;
  o.frame.latitude = 52.5;
  o.frame.to_enu = [](std::span<const model::Point3> in, std::span<model::Point3> out) {
    // Turned by 1.2 degrees, as by the convergence of the meridians: nothing stays on a grid.
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double x = in[i].x - 391040.7, y = in[i].y - 5819030.2;
      out[i] = {0.99978 * x - 0.02094 * y, 0.02094 * x + 0.99978 * y, in[i].z};
    }
  };
  return o;
}

nlohmann::json document(const std::string& bytes) {
  std::uint32_t length = 0;
  std::memcpy(&length, &bytes[12], 4);
  return nlohmann::json::parse(bytes.substr(20, length));
}

std::vector<std::vector<model::Point3>> triangles(const validators::GlbFeature& feature) {
  std::vector<std::vector<model::Point3>> out;
  for (const auto& t : feature.triangles) out.emplace_back(t.corners.begin(), t.corners.end());
  return out;
}

const validators::GlbFeature& feature(const GlbFile& file, const std::string& id) {
  for (const auto& f : file.features)
    if (f.id == id) return f;
  throw std::runtime_error("no feature " + id);
}

TEST(Glb, EverySolidClosesAgain) {
  const SampleRegion zoo = SampleRegion::zoo();
  const Glb glb = write_glb(zoo.region(), options());
  const GlbFile file = validators::read_glb_bytes(glb.bytes);
  ASSERT_EQ(file.features.size(), 9u);
  EXPECT_EQ(glb.rows, 9u);
  std::size_t count = 0;
  for (const auto& f : file.features) {
    count += f.triangles.size();
    if (f.id == "w60") {
      EXPECT_TRUE(f.triangles.empty());
      continue;
    }
    EXPECT_TRUE(test::closed(triangles(f))) << f.id;
    EXPECT_GT(test::six_volumes(triangles(f)), 0) << f.id;
  }
  EXPECT_EQ(count, glb.triangles);
  EXPECT_NEAR(test::six_volumes(triangles(feature(file, "w40"))) / 6, (40.0 * 40 - 20 * 20) * 22 * 0.99978 * 0.99978,
              30);
}

TEST(Glb, PositionsCountInSteps) {
  SampleRegion s;
  model::Building& b = s.add_building(1, {{"building", "house"}});
  s.add_gable(b, b.id(), 391000, 5819000, 12.3, 9.7, 34.25, 40.5, 44.125);
  GlbOptions o = options();
  const Glb glb = write_glb(s.region(), o);
  const nlohmann::json json = document(glb.bytes);
  constexpr double step = 1.0 / 2048;
  EXPECT_FALSE(json["nodes"][0].contains("scale"));
  const GlbFile file = validators::read_glb_bytes(glb.bytes);
  EXPECT_TRUE(test::closed(triangles(file.features.at(0))));
  // Each corner lies within half a step of one that the frame gives.
  std::vector<model::Point3> expected(b.parts[0].lod2.vertices.size());
  o.frame.to_enu(b.parts[0].lod2.vertices, expected);
  for (const auto& t : file.features[0].triangles)
    for (const model::Point3& p : t.corners) {
      for (const double v : {p.x, p.y, p.z}) EXPECT_EQ(v / step, std::nearbyint(v / step));
      double best = 1;
      for (const model::Point3& e : expected)
        best = std::min(best, std::max({std::abs(e.x - p.x), std::abs(e.y - p.y), std::abs(e.z - p.z)}));
      EXPECT_LE(best, step / 2 + 1e-9);
    }
}

/// Beyond 2 km steps would no longer fit into what compression keeps of a float.
TEST(Glb, WideMeshesKeepFloats) {
  SampleRegion s;
  for (const double x : {391000.0, 391000.0 + 5000}) {
    model::Building& b = s.add_building(static_cast<std::int64_t>(x), {{"building", "house"}});
    s.add_gable(b, b.id(), x, 5819000, 12.3, 9.7, 34.25, 40.5, 44.125);
  }
  for (const Compression compression : {Compression::none, Compression::meshopt}) {
    GlbOptions o = options();
    o.compression = compression;
    const nlohmann::json json = document(write_glb(s.region(), o).bytes);
    for (const auto& p : json["meshes"][0]["primitives"]) {
      const auto& a = json["accessors"][p["attributes"]["POSITION"].get<std::size_t>()];
      EXPECT_EQ(a["componentType"], 5126);
      EXPECT_GT(a["max"][0].get<double>() - a["min"][0].get<double>(), 4000);
      for (const auto& view : json["bufferViews"]) EXPECT_EQ(view.dump().find("EXPONENTIAL"), std::string::npos);
    }
  }
}

/// Rounding may take the area of a sliver away or turn it over; without it the shell would be open, with it folded.
TEST(Glb, SliversKeepFloats) {
  int kept = 0;
  constexpr int kPlaces = 20;
  for (int place = 0; place < kPlaces; ++place) {
    SampleRegion s;
    model::Building& b = s.add_building(1, {{"building", "house"}});
    constexpr double step = 1.0 / 1024;  // 0.04 mm wide, ten metres long
    const double x = 391000 + 7 * place * step, y = 5819000 + 13 * place * step;
    model::Polygon plan;
    plan.outer.points = {{x, y}, {x + 5070 * step, y + 3 * step}, {x + 10003 * step, y + 6 * step}};
    s.add_prism(b, b.id(), plan, 34, 9);
    const Glb glb = write_glb(s.region(), options());
    const GlbFile file = validators::read_glb_bytes(glb.bytes);
    ASSERT_EQ(file.features.at(0).triangles.size(), 8u);
    EXPECT_TRUE(test::closed(triangles(file.features[0])));
    for (const auto& t : file.features[0].triangles) {
      const model::Point3 &p = t.corners[0], &q = t.corners[1], &r = t.corners[2];
      if (p.z != q.z || q.z != r.z) continue;
      EXPECT_EQ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) > 0, p.z > 40) << "a cap looks inwards";
    }
    GlbOptions packed = options();
    packed.compression = Compression::meshopt;
    const std::string views = document(write_glb(s.region(), packed).bytes)["bufferViews"].dump();
    kept += views.find("EXPONENTIAL") == std::string::npos;
  }
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, kPlaces);
}

/// All classes of material are one material: vertices have the colour, a picture metallic and roughness factors.
TEST(Glb, OneMaterialShowsAll) {
  const SampleRegion many = SampleRegion::settlement(400, false);
  const std::string bytes = write_glb(many.region(), options()).bytes;
  const nlohmann::json json = document(bytes);
  ASSERT_EQ(json["materials"].size(), 1u);
  const auto& look = json["materials"][0];
  EXPECT_FALSE(look["pbrMetallicRoughness"].contains("baseColorFactor"));
  EXPECT_EQ(look["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"], 0);
  ASSERT_EQ(look["extras"]["classes"].size(), many.region().materials.size());
  for (std::size_t i = 0; i < many.region().materials.size(); ++i)
    EXPECT_EQ(look["extras"]["classes"][i], many.region().materials[i].name);
  EXPECT_EQ(json["samplers"][0]["magFilter"], 9728) << "pixels are not mixed";
  const auto& view = json["bufferViews"][json["images"][0]["bufferView"].get<std::size_t>()];
  std::uint32_t length = 0;
  std::memcpy(&length, &bytes[12], 4);
  const std::string png = bytes.substr(28 + length + view.value("byteOffset", std::size_t{0}), view["byteLength"]);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
  std::size_t vertices = 0;
  for (const auto& p : json["meshes"][0]["primitives"]) {
    EXPECT_TRUE(p["attributes"].contains("COLOR_0") && p["attributes"].contains("TEXCOORD_0"));
    vertices += json["accessors"][p["attributes"]["POSITION"].get<std::size_t>()]["count"].get<std::size_t>();
  }
  EXPECT_LE(json["meshes"][0]["primitives"].size(), vertices / 65535 + 1) << "a draw for every full index";
}

TEST(Glb, NormalsAndColoursBelongToTheFaces) {
  const SampleRegion zoo = SampleRegion::zoo();
  const GlbFile file = validators::read_glb_bytes(write_glb(zoo.region(), options()).bytes);
  std::set<std::string> materials;
  for (const auto& f : file.features)
    for (const auto& t : f.triangles) {
      materials.insert(t.material);
      const auto &a = t.corners[0], &b = t.corners[1], &c = t.corners[2];
      const double x = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
      const double y = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
      const double z = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      const double length = std::sqrt(x * x + y * y + z * z);
      EXPECT_GT((x * t.normal[0] + y * t.normal[1] + z * t.normal[2]) / length, 0.99) << f.id;
      if (t.material == "roof_tiles") {
        EXPECT_NEAR(t.colour[0] * 65535, kLinearLight[160], 0.33);  // materials have five decimals
        EXPECT_NEAR(t.colour[2] * 65535, kLinearLight[40], 0.33);
      }
    }
  EXPECT_EQ(materials, (std::set<std::string>{"plaster", "roof_tiles"}));
}

TEST(Glb, TellsWhatIsKnownAboutEachPart) {
  const SampleRegion zoo = SampleRegion::zoo();
  GlbOptions o = options();
  o.evidence = true;
  const GlbFile file = validators::read_glb_bytes(write_glb(zoo.region(), o).bytes);
  EXPECT_EQ(file.crs, "EPSG:25833");
  EXPECT_EQ(file.longitude, 13.4);
  EXPECT_EQ(file.copyright, o.attribution);

  const auto& shop = feature(file, "w-7");
  EXPECT_EQ(shop.numbers.at("osm_id"), -7);
  EXPECT_EQ(shop.texts.at("osm_type"), "way");
  EXPECT_EQ(shop.texts.at("name"), "Zum \"Krokodil\" & <S\xC3\xB6hne>");
  EXPECT_EQ(nlohmann::json::parse(shop.texts.at("tags"))["note"], "two\nlines\tand a tab");
  EXPECT_EQ(nlohmann::json::parse(shop.texts.at("evidence"))["use"], "the tag amenity=place_of_worship");
  EXPECT_EQ(shop.texts.at("use"), "church");
  EXPECT_EQ(shop.texts.at("use_source"), "implied");
  EXPECT_NEAR(shop.numbers.at("use_confidence"), 0.5, 1.0 / 255);
  EXPECT_EQ(shop.numbers.count("roof_direction"), 0u);
  EXPECT_EQ(shop.texts.count("roof_direction_source"), 0u);
  EXPECT_EQ(shop.texts.at("built_roof"), "flat");
  EXPECT_EQ(shop.texts.at("roof_shape"), "gabled");
  EXPECT_EQ(shop.texts.at("wall_colour"), "#decdaa");
  EXPECT_EQ(shop.texts.count("address"), 0u);

  const auto& house = feature(file, "w12");
  EXPECT_EQ(house.texts.at("address"), "Kastanienallee 12, 10435 Berlin");
  EXPECT_EQ(house.numbers.at("roof_direction"), 90);
  EXPECT_EQ(house.texts.at("roof_direction_source"), "tag");
  EXPECT_EQ(house.numbers.at("height"), 9.5);
  EXPECT_EQ(house.numbers.at("lod"), 2);
  EXPECT_EQ(nlohmann::json::parse(house.texts.at("tags"))["description"], "]]> \xF0\x9F\x8F\xA0 'quoted'");

  const auto& nave = feature(file, "w30.w31");
  EXPECT_EQ(nave.texts.at("building"), "w30");
  EXPECT_EQ(nave.numbers.at("osm_id"), 31);
  EXPECT_EQ(nave.texts.at("name"), "St. Marien");
  EXPECT_EQ(nlohmann::json::parse(nave.texts.at("building_tags"))["building"], "cathedral");
  const auto& tower = feature(file, "w30.w32");
  EXPECT_EQ(tower.texts.at("fallbacks"), "ROOF_FAILED ROOF_SHAPE_ADAPTED");
  EXPECT_EQ(tower.texts.count("building_tags"), 0u);
  EXPECT_EQ(feature(file, "w60").numbers.at("lod"), 0);
}

TEST(Glb, TellsPeopleWhatTheyLookFor) {
  SampleRegion zoo = SampleRegion::zoo();
  for (model::Building& b : zoo.region().buildings)
    for (model::BuildingPart& p : b.parts)
      if (p.id == "w12") {
        p.attributes.height.value = 9.46875;
        p.attributes.roof_pitch.value = 37.62;
        p.attributes.storeys.value = 2.5;
        p.attributes.style = {"modern", model::Source::neighbours, 0.8149f};
      }
  GlbOptions o = options();
  o.profile = AttributeProfile::people;
  const std::string bytes = write_glb(zoo.region(), o).bytes;
  const GlbFile file = validators::read_glb_bytes(bytes);
  const auto& house = feature(file, "w12");
  EXPECT_EQ(house.texts.at("address"), "Kastanienallee 12, 10435 Berlin");
  EXPECT_EQ(house.numbers.at("height"), 9.5);
  EXPECT_EQ(house.numbers.at("roof_pitch"), 38);
  EXPECT_EQ(house.numbers.at("storeys"), 2.5);
  EXPECT_EQ(house.texts.at("style"), "modern");
  EXPECT_EQ(house.numbers.at("style_confidence"), 0.81);
  EXPECT_EQ(house.texts.at("built_roof"), "gabled");
  EXPECT_THAT(house.texts.at("sources"), testing::HasSubstr("neighbours: storeys, style"));
  for (const char* left_out : {"tags", "roof_shape", "use_source", "evidence", "osm_type"})
    EXPECT_EQ(house.texts.count(left_out), 0u) << left_out;
  for (const char* left_out : {"osm_id", "height_confidence", "ground_height"})
    EXPECT_EQ(house.numbers.count(left_out), 0u) << left_out;
  EXPECT_EQ(feature(file, "w30.w31").texts.at("building"), "w30");
  EXPECT_EQ(feature(file, "w30.w32").texts.at("fallbacks"), "ROOF_FAILED ROOF_SHAPE_ADAPTED");

  // Viewers list the columns in the order of the file.
  std::uint32_t length = 0;
  std::memcpy(&length, &bytes[12], 4);
  const auto json = nlohmann::ordered_json::parse(bytes.substr(20, length));
  const auto& metadata = json.at("extensions").at("EXT_structural_metadata");
  std::vector<std::string> columns;
  for (const auto& [name, column] : metadata.at("propertyTables").at(0).at("properties").items())
    columns.push_back(name);
  EXPECT_EQ(columns.front(), "address");
  EXPECT_EQ(columns.back(), "building");
  const auto place = [&](const char* name) { return std::ranges::find(columns, name) - columns.begin(); };
  for (const auto& [first, second] : {std::pair("name", "use"), std::pair("use", "era"), std::pair("era", "style"),
                                      std::pair("style", "style_confidence"), std::pair("style_confidence", "storeys"),
                                      std::pair("storeys", "height"), std::pair("height", "built_roof"),
                                      std::pair("built_roof", "sources"), std::pair("sources", "id")})
    EXPECT_LT(place(first), place(second)) << first << ' ' << second;
  EXPECT_LT(place("id"), static_cast<std::ptrdiff_t>(columns.size()));

  o.evidence = true;
  const GlbFile told = validators::read_glb_bytes(write_glb(zoo.region(), o).bytes);
  EXPECT_EQ(nlohmann::json::parse(feature(told, "w-7").texts.at("evidence"))["use"],
            "the tag amenity=place_of_worship");
}

TEST(Glb, LowerLevelsOfDetail) {
  const SampleRegion zoo = SampleRegion::zoo();
  GlbOptions o = options();
  o.lod = 1;
  const GlbFile one = validators::read_glb_bytes(write_glb(zoo.region(), o).bytes);
  EXPECT_EQ(feature(one, "w12").triangles.size(), 12u);  // a block instead of the gable house
  // LoD0 shows the footprint as one horizontal face on the ground.
  o.lod = 0;
  const GlbFile ground = validators::read_glb_bytes(write_glb(zoo.region(), o).bytes);
  EXPECT_EQ(ground.features.size(), 9u);
  const auto& house = feature(ground, "w12");
  ASSERT_EQ(house.triangles.size(), 2u);
  for (const auto& triangle : house.triangles)
    for (const auto& corner : triangle.corners) EXPECT_NEAR(corner.z, house.triangles[0].corners[0].z, 1e-3);
}

TEST(Glb, NoDataPropertiesAreLeftOut) {
  SampleRegion s;
  model::Building& b = s.add_building(1, {});
  s.add_box(b, b.id(), 391000, 5819000, 10, 8, 0, 6);
  const nlohmann::json json = document(write_glb(s.region(), options()).bytes);
  const auto& extension = json["extensions"]["EXT_structural_metadata"];
  EXPECT_FALSE(extension["propertyTables"][0]["properties"].contains("roof_direction"));
  EXPECT_TRUE(extension["schema"]["classes"]["building_part"]["properties"].contains("roof_direction"));
  for (const auto& view : json["bufferViews"]) EXPECT_EQ(view.value("byteOffset", 0) % 8, 0);
}

/// Texts that repeat are written once: a column of bytes, and an enumeration of its name.
TEST(Glb, TextsThatRepeatAreEnumerations) {
  const SampleRegion many = SampleRegion::settlement(400, false);
  GlbOptions o = options();
  o.profile = AttributeProfile::people;
  const std::string bytes = write_glb(many.region(), o).bytes;
  const nlohmann::json json = document(bytes);
  const auto& schema = json["extensions"]["EXT_structural_metadata"]["schema"];
  const auto& properties = schema["classes"]["building_part"]["properties"];
  EXPECT_EQ(properties["sources"]["type"], "ENUM");
  EXPECT_EQ(properties["sources"]["enumType"], "sources");
  EXPECT_EQ(properties["id"]["type"], "STRING") << "they are all different";
  std::set<std::string> used;
  for (const auto& [name, property] : properties.items())
    if (property.contains("enumType")) used.insert(property["enumType"]);
  for (const auto& [name, enumeration] : schema["enums"].items()) EXPECT_TRUE(used.contains(name)) << name;
  EXPECT_EQ(schema["enums"].size(), used.size());
  const GlbFile file = validators::read_glb_bytes(bytes);
  for (const auto& f : file.features) EXPECT_THAT(f.texts.at("sources"), testing::HasSubstr(": "));
  EXPECT_EQ(file.features.at(7).texts.count("name"), 0u) << "absent texts stay absent";
}

TEST(Glb, TheSameBytesTwice) {
  const std::string a = write_glb(SampleRegion::zoo().region(), options()).bytes;
  const std::string b = write_glb(SampleRegion::zoo().region(), options()).bytes;
  EXPECT_EQ(a, b);
}

TEST(Glb, ManyVerticesTakeSeveralPrimitives) {
  const SampleRegion many = SampleRegion::settlement(4000, false);
  const Glb glb = write_glb(many.region(), options());
  const nlohmann::json json = document(glb.bytes);
  std::set<int> types;
  for (const auto& p : json["meshes"][0]["primitives"])
    types.insert(json["accessors"][p["indices"].get<std::size_t>()]["componentType"].get<int>());
  EXPECT_EQ(types, std::set<int>{5123});
  for (const auto& p : json["meshes"][0]["primitives"])
    EXPECT_LE(json["accessors"][p["attributes"]["POSITION"].get<std::size_t>()]["count"].get<int>(), 65535);
  const GlbFile file = validators::read_glb_bytes(glb.bytes);
  EXPECT_TRUE(test::closed(triangles(file.features.at(3999))));
}

TEST(Glb, EmptyRegion) {
  const Glb glb = write_glb(SampleRegion().region(), options());
  EXPECT_EQ(glb.rows, 0u);
  EXPECT_EQ(glb.triangles, 0u);
  const nlohmann::json json = document(glb.bytes);
  EXPECT_EQ(json["asset"]["version"], "2.0");
  EXPECT_TRUE(json["asset"]["extras"].contains("georeference"));
  EXPECT_FALSE(json.contains("buffers"));
}

}  // namespace
}  // namespace blockrand::outputs
