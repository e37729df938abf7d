#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/outputs/cityjson/vertex_table.h"
#include "pipeline/outputs/material_classes.h"
#include "tests/unit/outputs/closed.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs {
namespace {

using nlohmann::json;
using test::SampleRegion;

CityJsonOptions options() {
  CityJsonOptions o;
  o.crs_code = "EPSG:25833";
  o.height_reference = "heights above local ground";
  o.attribution = "\xC2\xA9 OpenStreetMap contributors, ODbL 1.0";
  o.name = "Blockrand 15/17600/12900";
  o.data_time = "2020-03-04T05:06:07Z";
  return o;
}

std::vector<json> lines(const std::string& text) {
  std::vector<json> out;
  EXPECT_EQ(text.back(), '\n');
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(json::parse(line));
  return out;
}

std::string single(const std::vector<const model::Region*>& regions, const CityJsonOptions& o) {
  std::string out;
  SingleCityJson writer(o, [&](std::string_view bytes) { out += bytes; });
  for (const model::Region* region : regions) writer.add(*region);
  writer.finish();
  return out;
}

/// The city objects of a sequence with the JSON object whose vertices they use.
std::map<std::string, std::pair<json, json>> objects(const std::vector<json>& sequence) {
  std::map<std::string, std::pair<json, json>> out;
  for (const json& line : sequence)
    for (const auto& [id, object] : line.at("CityObjects").items()) out[id] = {object, line};
  return out;
}

model::Point3 point(const json& vertex, const json& transform) {
  const auto axis = [&](std::size_t i) {
    EXPECT_TRUE(vertex.at(i).is_number_integer());
    return vertex.at(i).get<double>() * transform.at("scale").at(i).get<double>() +
           transform.at("translate").at(i).get<double>();
  };
  return {axis(0), axis(1), axis(2)};
}

const json& geometry(const json& object, const std::string& lod) {
  for (const json& g : object.at("geometry"))
    if (g.at("lod") == lod) return g;
  throw std::runtime_error("no geometry of lod " + lod);
}

TEST(CityJson, SolidsComeBackExactly) {
  const SampleRegion zoo = SampleRegion::zoo();
  const std::vector<json> sequence = lines(write_cityjson_sequence(zoo.region(), options()));
  const json transform = sequence.at(0).at("transform");
  const auto found = objects(sequence);
  const json whole = json::parse(single({&zoo.region()}, options()));
  int solids = 0;
  for (const model::Building& b : zoo.region().buildings) {
    if (!b.owned) continue;
    for (const model::BuildingPart& part : b.parts) {
      const std::string id = part.id == b.id() && b.parts.size() > 1 ? part.id + ".1" : part.id;
      for (const model::Solid* solid : {&part.lod1, &part.lod2}) {
        if (solid->empty()) continue;
        ++solids;
        const std::string lod = solid == &part.lod1 ? "1" : "2";
        const json& g = geometry(found.at(id).first, lod);
        EXPECT_EQ(g.at("type"), "Solid");
        const json& g_whole = geometry(whole.at("CityObjects").at(id), lod);
        ASSERT_EQ(g.at("boundaries").size(), 1u);
        const json& shell = g.at("boundaries").at(0);
        ASSERT_EQ(shell.size(), solid->faces.size());
        std::vector<std::vector<model::Point3>> loops;
        for (std::size_t f = 0; f < shell.size(); ++f) {
          const auto wanted = solid->loops_of(solid->faces[f]);
          ASSERT_EQ(shell[f].size(), wanted.size());
          for (std::size_t l = 0; l < wanted.size(); ++l) {
            std::vector<model::Point3> ring, ring_whole, expected;
            for (const json& i : shell[f][l])
              ring.push_back(point(found.at(id).second.at("vertices").at(i.get<std::size_t>()), transform));
            for (const json& i : g_whole.at("boundaries")[0][f][l])
              ring_whole.push_back(point(whole.at("vertices").at(i.get<std::size_t>()), whole.at("transform")));
            for (const std::uint32_t v : solid->indices_of(wanted[l])) expected.push_back(solid->vertices[v]);
            EXPECT_EQ(ring, expected);
            EXPECT_EQ(ring_whole, expected);
            loops.push_back(ring);
          }
        }
        EXPECT_TRUE(test::closed(loops));
        EXPECT_EQ(g.contains("semantics"), lod == "2");
        if (lod == "2") {
          const json& semantics = g.at("semantics");
          for (std::size_t f = 0; f < shell.size(); ++f) {
            const std::size_t index = semantics.at("values").at(0).at(f).get<std::size_t>();
            const std::string name = semantics.at("surfaces").at(index).at("type").get<std::string>();
            const std::string expected = solid->faces[f].kind == model::SurfaceKind::wall   ? "WallSurface"
                                         : solid->faces[f].kind == model::SurfaceKind::roof ? "RoofSurface"
                                                                                            : "GroundSurface";
            EXPECT_EQ(name, expected);
          }
        }
      }
    }
  }
  EXPECT_EQ(solids, 15);
}

TEST(CityJson, ColoursComeBackAndEqualThoseOfCityGml) {
  const SampleRegion zoo = SampleRegion::zoo();
  const auto found = objects(lines(write_cityjson_sequence(zoo.region(), options())));
  const json whole = json::parse(single({&zoo.region()}, options()));
  const std::string gml = write_citygml(zoo.region(), {});
  for (const model::Building& b : zoo.region().buildings) {
    if (!b.owned) continue;
    for (const model::BuildingPart& part : b.parts) {
      const std::string id = part.id == b.id() && b.parts.size() > 1 ? part.id + ".1" : part.id;
      const model::Solid& solid = part.lod2.empty() ? part.lod1 : part.lod2;
      if (solid.empty()) continue;
      const std::string lod = part.lod2.empty() ? "1" : "2";
      EXPECT_EQ(geometry(found.at(id).first, "1").contains("material"), lod == "1");
      for (std::size_t f = 0; f < solid.faces.size(); ++f)
        for (const bool in_whole : {false, true}) {
          const json& object = in_whole ? whole.at("CityObjects").at(id) : found.at(id).first;
          const json& appearance = (in_whole ? whole : found.at(id).second).at("appearance");
          EXPECT_EQ(appearance.at("default-theme-material"), "visual");
          const json& value = geometry(object, lod).at("material").at("visual").at("values").at(0).at(f);
          const json& material = appearance.at("materials").at(value.get<std::size_t>());
          const model::Face& face = solid.faces[f];
          EXPECT_EQ(material.at("name"), zoo.region().materials[face.material].name + " " + model::text(face.colour));
          const std::uint8_t channels[3] = {face.colour.r, face.colour.g, face.colour.b};
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(static_cast<int>(material.at("diffuseColor").at(c).get<double>() * 255 + 0.5), channels[c]);
        }
    }
  }
  EXPECT_NE(gml.find("<gml:name>plaster #decdaa</gml:name><app:diffuseColor>0.8706 0.8039 0.6667</app:diffuseColor>"),
            std::string::npos);
  EXPECT_NE(write_cityjson_sequence(zoo.region(), options())
                .find("{\"name\":\"plaster #decdaa\",\"diffuseColor\":[0.8706,0.8039,0.6667]"),
            std::string::npos);
}

TEST(CityJson, FeaturesAndParts) {
  const SampleRegion zoo = SampleRegion::zoo();
  const std::vector<json> sequence = lines(write_cityjson_sequence(zoo.region(), options()));
  std::vector<std::string> ids;
  for (const json& line : sequence) {
    if (line.at("type") == "CityJSON") continue;
    ids.push_back(line.at("id").get<std::string>());
    EXPECT_EQ(line.at("CityObjects").at(ids.back()).at("type"), "Building");
    const json vertices = line.at("vertices");
    std::set<json> distinct(vertices.begin(), vertices.end());
    EXPECT_EQ(distinct.size(), vertices.size());
  }
  EXPECT_EQ(ids, (std::vector<std::string>{"w-7", "w12", "w30", "w40", "w50", "w60"}));
  const auto found = objects(sequence);
  EXPECT_EQ(found.size(), 11u);
  EXPECT_EQ(found.at("w30").first.at("children"), json({"w30.w31", "w30.w32", "w30.rest"}));
  EXPECT_FALSE(found.at("w30").first.contains("geometry"));
  EXPECT_EQ(found.at("w50").first.at("children"), json({"w50.1", "w50.2"}));
  EXPECT_EQ(found.at("w50.1").first.at("parents"), json({"w50"}));
  EXPECT_EQ(found.at("w50.1").first.at("type"), "BuildingPart");
  EXPECT_FALSE(found.at("w12").first.contains("children"));
  EXPECT_EQ(geometry(found.at("w40").first, "0").at("boundaries").at(0).size(), 2u);  // a courtyard
  EXPECT_EQ(found.at("w60").first.at("geometry").size(), 1u);                         // no solid, but a place
  EXPECT_FALSE(found.at("w60").second.contains("appearance"));
  const json whole = json::parse(single({&zoo.region()}, options()));
  EXPECT_EQ(whole.at("CityObjects").size(), 11u);
}

TEST(CityJson, AttributesSourcesTagsAndAddress) {
  const SampleRegion zoo = SampleRegion::zoo();
  CityJsonOptions o = options();
  o.evidence = true;
  const auto found = objects(lines(write_cityjson_sequence(zoo.region(), o)));
  const json shop = found.at("w-7").first.at("attributes");
  EXPECT_EQ(shop.at("name"), "Zum \"Krokodil\" & <S\xC3\xB6hne>");
  EXPECT_EQ(shop.at("osm.note"), "two\nlines\tand a tab");
  EXPECT_EQ(shop.at("use"), "church");
  EXPECT_EQ(shop.at("use_source"), "implied");
  EXPECT_EQ(shop.at("use_confidence"), 0.5);
  EXPECT_EQ(shop.at("use_evidence"), "the tag amenity=place_of_worship");
  EXPECT_EQ(shop.at("class"), "1080");
  EXPECT_EQ(shop.at("function"), "church");
  EXPECT_EQ(shop.at("roof_shape"), "gabled");
  EXPECT_EQ(shop.at("roof_shape_source"), "tag");
  EXPECT_EQ(shop.at("roof_shape_confidence"), 1);
  EXPECT_EQ(shop.at("wall_colour"), "#decdaa");
  EXPECT_EQ(shop.at("built_roof"), "flat");
  EXPECT_EQ(shop.at("lod"), 2);
  EXPECT_FALSE(shop.contains("externalReference")) << "an editor's new object has no page";
  const json house = found.at("w12").first.at("attributes");
  EXPECT_EQ(house.at("yearOfConstruction"), 1904);
  EXPECT_EQ(house.at("measuredHeight"), 9.5);
  EXPECT_EQ(house.at("height"), 9.5);
  EXPECT_EQ(house.at("height_confidence"), 0.75);
  EXPECT_EQ(house.at("storeysAboveGround"), 3);
  EXPECT_EQ(house.at("storeyHeightsAboveGround"), json({2.8, 2.8, 2.8}));
  EXPECT_EQ(house.at("roof_direction"), 90);
  EXPECT_EQ(house.at("osm.description"), "]]> \xF0\x9F\x8F\xA0 'quoted'");
  EXPECT_EQ(found.at("w12").first.at("address"), json::array({{{"Country", "DE"},
                                                               {"Locality", "Berlin"},
                                                               {"DependentLocality", "Prenzlauer Berg"},
                                                               {"Postcode", "10435"},
                                                               {"ThoroughfareName", "Kastanienallee"},
                                                               {"ThoroughfareNumber", "12"}}}));
  EXPECT_FALSE(found.at("w40").first.at("attributes").contains("yearOfConstruction"));  // "about 1900" is no year
  EXPECT_EQ(found.at("w30.w32").first.at("attributes").at("fallbacks"), "ROOF_FAILED ROOF_SHAPE_ADAPTED");
  EXPECT_EQ(found.at("w30.w32").first.at("attributes").at("osm.building:part"), "tower");
  EXPECT_FALSE(found.at("w30.rest").first.at("attributes").contains("osm.building"));  // said once, by the building
  EXPECT_EQ(found.at("w30").first.at("attributes").at("osm.building"), "cathedral");
}

TEST(CityJson, Metadata) {
  const SampleRegion zoo = SampleRegion::zoo();
  CityJsonOptions o = options();
  o.vertical_crs = "EPSG:7837";
  const json header = lines(write_cityjson_sequence(zoo.region(), o)).at(0);
  const json whole = json::parse(single({&zoo.region()}, o));
  for (const json* file : {&header, &whole}) {
    EXPECT_EQ(file->at("type"), "CityJSON");
    EXPECT_EQ(file->at("version"), "2.0");
    EXPECT_EQ(file->at("transform").at("scale"), json({1.0 / 1024, 1.0 / 1024, 1.0 / 1024}));
    const json metadata = file->at("metadata");
    EXPECT_EQ(metadata.at("referenceSystem"), "https://www.opengis.net/def/crs/EPSG/0/25833");
    EXPECT_EQ(metadata.at("referenceDate"), "2020-03-04");
    EXPECT_EQ(metadata.at("title"),
              "Blockrand 15/17600/12900; heights: heights above local ground; vertical CRS: EPSG:7837; data: \xC2\xA9 "
              "OpenStreetMap contributors, ODbL 1.0");
    // The zoo: from the shop at 391000 5819000 to the cathedral's tower.
    EXPECT_EQ(metadata.at("geographicalExtent"), json({391000, 5819000, 34.25, 391090, 5819080, 74.25}));
  }
  EXPECT_TRUE(header.at("CityObjects").empty());
  EXPECT_TRUE(header.at("vertices").empty());
}

TEST(CityJson, OnlyTheLevelsAskedFor) {
  CityJsonOptions o = options();
  o.lod = 0;
  auto found = objects(lines(write_cityjson_sequence(SampleRegion::zoo().region(), o)));
  EXPECT_EQ(found.at("w12").first.at("geometry").size(), 1u);
  EXPECT_FALSE(found.at("w12").second.contains("appearance"));
  o.lod = 1;
  found = objects(lines(write_cityjson_sequence(SampleRegion::zoo().region(), o)));
  EXPECT_EQ(found.at("w12").first.at("geometry").size(), 2u);
  EXPECT_TRUE(geometry(found.at("w12").first, "1").contains("material"));  // the highest level has the colours
}

TEST(CityJson, BuildingsWithoutPartsAreNotInTheModel) {
  SampleRegion s;
  s.add_building(1, {{"building", "yes"}});
  model::Building& b = s.add_building(2, {});
  s.add_box(b, b.id(), 0, 0, 10, 8, 0, 6);
  EXPECT_EQ(lines(write_cityjson_sequence(s.region(), options())).size(), 2u);
  EXPECT_EQ(json::parse(single({&s.region()}, options())).at("CityObjects").size(), 1u);
}

TEST(CityJson, SeveralRegionsShareVerticesAndMaterials) {
  SampleRegion a, b;
  a.add_box(a.add_building(1, {}), "w1", 0, 0, 10, 8, 34.25, 6);
  b.add_box(b.add_building(2, {}), "w2", 10, 0, 10, 8, 34.25, 6);  // wall to wall
  b.region().materials = {{"metal", 0.4f, 1.0f}, {"plaster", 0.9f, 0.0f}};
  const SampleRegion nothing;
  const json whole = json::parse(single({&nothing.region(), &a.region(), &b.region()}, options()));
  EXPECT_EQ(whole.at("CityObjects").size(), 2u);
  EXPECT_EQ(whole.at("vertices").size(), 12u);
  std::set<std::string> names;
  for (const json& m : whole.at("appearance").at("materials")) names.insert(m.at("name").get<std::string>());
  EXPECT_TRUE(names.contains("plaster #decdaa"));
  EXPECT_TRUE(names.contains("metal #decdaa"));
}

TEST(CityJson, EmptyFilesAreValid) {
  const std::vector<json> sequence = lines(write_cityjson_sequence(SampleRegion().region(), options()));
  ASSERT_EQ(sequence.size(), 1u);
  EXPECT_FALSE(sequence[0].at("metadata").contains("geographicalExtent"));
  const json whole = json::parse(single({}, {}));
  EXPECT_TRUE(whole.at("CityObjects").empty());
  EXPECT_TRUE(whole.at("vertices").empty());
  EXPECT_TRUE(whole.at("metadata").empty());
}

TEST(CityJson, TheSameBytesTwice) {
  EXPECT_EQ(write_cityjson_sequence(SampleRegion::zoo().region(), options()),
            write_cityjson_sequence(SampleRegion::zoo().region(), options()));
  const SampleRegion zoo = SampleRegion::zoo();
  EXPECT_EQ(single({&zoo.region()}, options()), single({&zoo.region()}, options()));
}

TEST(CityJson, ErrorsOfTheSinkComeThrough) {
  const auto full = [](std::string_view) { throw std::runtime_error("disk full"); };
  const SampleRegion sample = SampleRegion::settlement(200, true);
  EXPECT_THROW(write_cityjson_sequence(sample.region(), options(), full), std::runtime_error);
  SingleCityJson writer(options(), full);
  EXPECT_THROW(
      {
        writer.add(sample.region());
        writer.finish();
      },
      std::runtime_error);
}

TEST(CityJson, ForbiddenCharactersCannotBreakAFile) {
  SampleRegion s;
  model::Building& b = s.add_building(1, {{std::string("k\0\x01\xFFy\"\\", 7), std::string("v\0\x02\xC3", 4)}});
  s.add_box(b, b.id(), 0, 0, 10, 8, 0, 6);
  EXPECT_EQ(lines(write_cityjson_sequence(s.region(), options())).size(), 2u);
}

TEST(VertexTable, NumbersPointsFarAndManyOfThem) {
  VertexTable table;
  const GridPoint far{-(1LL << 46), (1LL << 46) - 1, -(1LL << 31)};
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(table.number({1, -2, 3}), 0u);
    EXPECT_EQ(table.number(far), 1u);
    EXPECT_EQ(table.number({1, -2, 3}), 0u);
    EXPECT_EQ(table[1], far);
    for (std::int64_t i = 0; i < 20000; ++i) ASSERT_EQ(table.number({i * 1024, -i, i * i % 7}), i + 2);
    for (std::int64_t i = 0; i < 20000; ++i) ASSERT_EQ(table.number({i * 1024, -i, i * i % 7}), i + 2);
    EXPECT_EQ(table[20001], (GridPoint{19999 * 1024, -19999, 19999LL * 19999 % 7}));
    table.clear();
    EXPECT_EQ(table.size(), 0u);
  }
}

TEST(Materials, EveryByteComesBackFromItsDigits) {
  for (int byte = 0; byte < 256; ++byte) {
    const auto c = static_cast<std::uint8_t>(byte);
    std::string text;
    append_ten_thousandths(text, x3d_material({"plaster", 0.9f, 0.0f}, {c, c, c}).diffuse[0]);
    EXPECT_EQ(static_cast<int>(std::stod(text) * 255 + 0.5), byte) << text;
  }
}

TEST(Materials, RoughnessBecomesShininess) {
  const auto shininess = [](float roughness) { return x3d_material({"m", roughness, 0}, {}).shininess; };
  EXPECT_EQ(shininess(1.0f), 0);
  EXPECT_EQ(shininess(0.9f), 82);  // (2 / 0.6561 - 2) / 128 = 0.00819
  EXPECT_GT(shininess(0.4f), shininess(0.9f));
  EXPECT_EQ(shininess(0.0f), 10000);
  EXPECT_EQ(x3d_material({"m", 0.5f, 0.0f}, {255, 0, 0}).specular, (std::array<int, 3>{400, 400, 400}));
  EXPECT_EQ(x3d_material({"m", 0.5f, 1.0f}, {255, 0, 0}).specular, (std::array<int, 3>{10000, 0, 0}));
}

TEST(Materials, NumbersInOrderOfFirstAppearance) {
  MaterialNumbers numbers;
  for (int round = 0; round < 2; ++round) {
    for (std::uint32_t k = 0; k < 100; ++k) EXPECT_EQ(numbers.number(1000 - k), k);
    for (std::uint32_t k = 0; k < 100; ++k) EXPECT_EQ(numbers.number(1000 - k), k);
    EXPECT_EQ(numbers.keys().size(), 100u);
    numbers.clear();
  }
}

}  // namespace
}  // namespace blockrand::outputs
