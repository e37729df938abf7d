#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/citygml/codes.h"
#include "pipeline/outputs/gzip.h"
#include "tests/unit/outputs/closed.h"
#include "tests/unit/outputs/sample_region.h"
#include "tests/validators/citygml_reader.h"

namespace blockrand::outputs {
namespace {

using test::SampleRegion;
using validators::GmlFile;

CityGmlOptions options() {
  CityGmlOptions o;
  o.srs_name = "urn:ogc:def:crs:EPSG::25833";
  o.height_reference = "heights above local ground";
  o.attribution = "\xC2\xA9 OpenStreetMap contributors, ODbL 1.0";
  o.name = "tile 15/17604/12942";
  return o;
}

const validators::GmlBuilding& building(const GmlFile& file, const std::string& id) {
  for (const auto& b : file.buildings)
    if (b.id == id) return b;
  throw std::runtime_error("no building " + id);
}

TEST(CityGml, SolidsComeBackPointForPoint) {
  const SampleRegion zoo = SampleRegion::zoo();
  const GmlFile file = validators::read_citygml_text(write_citygml(zoo.region(), options()));
  EXPECT_EQ(file.srs_name, "urn:ogc:def:crs:EPSG::25833");
  std::size_t found = 0;
  for (const model::Building& b : zoo.region().buildings) {
    if (!b.owned) continue;
    for (const model::BuildingPart& part : b.parts)
      for (const model::Solid* solid : {&part.lod1, &part.lod2}) {
        if (solid->empty()) continue;
        const int lod = solid == &part.lod1 ? 1 : 2;
        const std::string id = part.id == b.id() && b.parts.size() > 1 ? part.id + ".1" : part.id;
        const auto read = std::find_if(file.solids.begin(), file.solids.end(),
                                       [&](const auto& s) { return s.building == id && s.lod == lod; });
        ASSERT_NE(read, file.solids.end()) << id << " lod " << lod;
        ++found;
        ASSERT_EQ(read->polygons.size(), solid->faces.size());
        std::vector<std::vector<model::Point3>> loops;
        for (std::size_t f = 0; f < solid->faces.size(); ++f) {
          const auto wanted = solid->loops_of(solid->faces[f]);
          ASSERT_EQ(read->polygons[f].rings.size(), wanted.size());
          for (std::size_t l = 0; l < wanted.size(); ++l) {
            std::vector<model::Point3> ring = read->polygons[f].rings[l];
            for (model::Point3& p : ring) p = model::snap(p);
            std::vector<model::Point3> expected;
            for (const std::uint32_t v : solid->indices_of(wanted[l])) expected.push_back(solid->vertices[v]);
            EXPECT_EQ(ring, expected);
            loops.push_back(read->polygons[f].rings[l]);
          }
        }
        EXPECT_TRUE(test::closed(loops)) << "as written, without rounding to the grid";
        for (const auto& p : read->polygons) {
          for (const auto& ring : p.rings)
            for (const model::Point3& v : ring) {
              EXPECT_LE(file.lower->x, v.x);
              EXPECT_LE(file.lower->z, v.z);
              EXPECT_GE(file.upper->y, v.y);
              EXPECT_GE(file.upper->z, v.z);
            }
          EXPECT_EQ(p.surface.empty(), lod == 1);
        }
      }
  }
  EXPECT_EQ(found, file.solids.size());
}

TEST(CityGml, BuildingsAndParts) {
  const SampleRegion zoo = SampleRegion::zoo();
  const GmlFile file = validators::read_citygml_text(write_citygml(zoo.region(), options()));
  std::vector<std::string> ids;
  for (const auto& b : file.buildings) ids.push_back((b.part ? "+" : "") + b.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"w-7", "w12", "w30", "+w30.w31", "+w30.w32", "+w30.rest", "w40", "w50",
                                           "+w50.1", "+w50.2", "w60"}));
  EXPECT_EQ(building(file, "w40").footprint.at(0).rings.size(), 2u);
  EXPECT_TRUE(building(file, "w30").footprint.empty());
  EXPECT_EQ(building(file, "w60").footprint.size(), 1u);  // no solid, but a place
}

TEST(CityGml, AttributesSourcesAndTags) {
  const SampleRegion zoo = SampleRegion::zoo();
  CityGmlOptions o = options();
  o.evidence = true;
  const GmlFile file = validators::read_citygml_text(write_citygml(zoo.region(), o));
  const auto& shop = building(file, "w-7");
  EXPECT_EQ(shop.text("name"), "Zum \"Krokodil\" & <S\xC3\xB6hne>");
  EXPECT_EQ(shop.text("osm.note"), "two\nlines\tand a tab");
  EXPECT_EQ(shop.text("use_source"), "implied");
  EXPECT_EQ(shop.text("use_confidence"), "0.5");
  EXPECT_EQ(shop.text("use_evidence"), "the tag amenity=place_of_worship");
  EXPECT_EQ(shop.text("class"), "1080");
  EXPECT_EQ(shop.text("function"), "church");
  EXPECT_EQ(shop.text("roof_shape"), "gabled");
  EXPECT_EQ(shop.text("roof_shape_source"), "");  // from a tag
  EXPECT_EQ(shop.text("roofType"), "1000");
  EXPECT_EQ(shop.text("uri"), "") << "an editor's new object has no page";

  const auto& house = building(file, "w12");
  EXPECT_EQ(house.text("uri"), "https://www.openstreetmap.org/way/12");
  EXPECT_EQ(house.text("yearOfConstruction"), "1904");
  EXPECT_EQ(house.text("measuredHeight"), "9.5");
  EXPECT_EQ(house.text("storeysAboveGround"), "3");
  EXPECT_EQ(house.text("storeyHeightsAboveGround"), "2.8 2.8 2.8");
  EXPECT_EQ(house.text("roof_direction"), "90");
  EXPECT_EQ(house.text("osm.description"), "]]> \xF0\x9F\x8F\xA0 'quoted'");
  EXPECT_EQ(house.text("CountryNameCode"), "DE");
  EXPECT_EQ(house.text("LocalityName"), "Berlin");
  EXPECT_EQ(house.text("ThoroughfareNumber"), "12");
  EXPECT_EQ(house.text("ThoroughfareName"), "Kastanienallee");
  EXPECT_EQ(house.text("PostalCodeNumber"), "10435");
  EXPECT_EQ(house.text("DependentLocalityName"), "Prenzlauer Berg");

  EXPECT_EQ(building(file, "w40").text("yearOfConstruction"), "");  // "about 1900" is no year
  EXPECT_EQ(building(file, "w30.w32").text("fallbacks"), "ROOF_FAILED ROOF_SHAPE_ADAPTED");
  EXPECT_EQ(building(file, "w30.w32").text("osm.building:part"), "tower");
  EXPECT_EQ(building(file, "w30.rest").text("osm.building"), "");  // said once, by the building
  EXPECT_EQ(building(file, "w50.2").text("lod"), "1");
}

TEST(CityGml, HalfStoreysAreGenericAttributes) {
  SampleRegion s;
  model::Building& b = s.add_building(1, {});
  s.add_box(b, b.id(), 0, 0, 10, 8, 0, 6).attributes.storeys.value = 2.5;
  const GmlFile file = validators::read_citygml_text(write_citygml(s.region(), options()));
  EXPECT_EQ(file.buildings[0].text("storeysAboveGround"), "");
  EXPECT_EQ(file.buildings[0].text("storeys"), "2.5");
  EXPECT_EQ(file.buildings[0].text("storey_height"), "2.8");
}

/// The colours of X3DMaterials by the gml:id of their targets, out of the text.
std::map<std::string, model::Colour> colours(const std::string& gml) {
  std::map<std::string, model::Colour> out;
  const auto between = [&](std::size_t from, const std::string& open, const std::string& close) {
    const std::size_t begin = gml.find(open, from) + open.size();
    return gml.substr(begin, gml.find(close, begin) - begin);
  };
  for (std::size_t at = gml.find("<app:X3DMaterial>"); at != std::string::npos;
       at = gml.find("<app:X3DMaterial>", at + 1)) {
    std::istringstream numbers(between(at, "<app:diffuseColor>", "</app:diffuseColor>"));
    double channel[3];
    numbers >> channel[0] >> channel[1] >> channel[2];
    const auto byte = [&](int i) { return static_cast<std::uint8_t>(channel[i] * 255 + 0.5); };
    const std::size_t end = gml.find("</app:X3DMaterial>", at);
    for (std::size_t t = gml.find("<app:target>", at); t < end; t = gml.find("<app:target>", t + 1)) {
      const std::string id = between(t, "<app:target>#", "</app:target>");
      EXPECT_TRUE(out.emplace(id, model::Colour{byte(0), byte(1), byte(2)}).second) << id << " has two materials";
      EXPECT_NE(gml.find("<Polygon gml:id=\"" + id + "\">"), std::string::npos) << id;
    }
  }
  return out;
}

TEST(CityGml, EveryFaceOfTheHighestSolidHasItsColour) {
  const SampleRegion zoo = SampleRegion::zoo();
  const std::string text = write_citygml(zoo.region(), options());
  std::map<std::string, model::Colour> left = colours(text);
  for (const model::Building& b : zoo.region().buildings) {
    if (!b.owned) continue;
    for (const model::BuildingPart& part : b.parts) {
      std::string id = part.id == b.id() && b.parts.size() > 1 ? part.id + ".1" : part.id;
      if (part.lod2.empty()) id += "_lod1";
      const model::Solid& solid = part.lod2.empty() ? part.lod1 : part.lod2;
      for (std::size_t f = 0; f < solid.faces.size(); ++f) {
        const auto found = left.find(id + "_p" + std::to_string(f));
        ASSERT_NE(found, left.end()) << id << " face " << f;
        EXPECT_EQ(found->second, solid.faces[f].colour);
        left.erase(found);
      }
    }
  }
  EXPECT_TRUE(left.empty()) << left.begin()->first;
  EXPECT_NE(text.find("<app:theme>visual</app:theme>"), std::string::npos);
}

TEST(CityGml, BuildingsWithoutPartsAreNotInTheModel) {
  SampleRegion s;
  s.add_building(1, {{"building", "yes"}});
  model::Building& b = s.add_building(2, {});
  s.add_box(b, b.id(), 0, 0, 10, 8, 0, 6);
  s.region().buildings.front().outline.push_back(s.region().buildings.back().parts.front().plan);
  EXPECT_EQ(validators::read_citygml_text(write_citygml(s.region(), options())).buildings.size(), 1u);
}

TEST(CityGml, OnlyTheLevelsAskedFor) {
  CityGmlOptions o = options();
  o.lod = 0;
  GmlFile file = validators::read_citygml_text(write_citygml(SampleRegion::zoo().region(), o));
  EXPECT_TRUE(file.solids.empty());
  EXPECT_EQ(building(file, "w12").footprint.size(), 1u);
  o.lod = 1;
  file = validators::read_citygml_text(write_citygml(SampleRegion::zoo().region(), o));
  EXPECT_FALSE(file.solids.empty());
  for (const auto& s : file.solids) EXPECT_EQ(s.lod, 1);
}

TEST(CityGml, TheSameBytesTwiceAndCompressed) {
  const std::string a = write_citygml(SampleRegion::zoo().region(), options());
  EXPECT_EQ(a, write_citygml(SampleRegion::zoo().region(), options()));
  const std::string packed = gzip(a);
  EXPECT_EQ(packed, gzip(a));
  EXPECT_LT(packed.size() * 5, a.size());
  EXPECT_EQ(packed.substr(0, 10), std::string("\x1F\x8B\x08\x00\x00\x00\x00\x00\x00\xFF", 10));
  const auto path = std::filesystem::temp_directory_path() / "blockrand_citygml_test.gml.gz";
  std::ofstream(path, std::ios::binary) << packed;
  EXPECT_EQ(validators::read_citygml(path.string()).buildings.size(), 11u);
  std::filesystem::remove(path);
}

TEST(CityGml, ErrorsOfTheSinkComeThrough) {
  const auto full = [](std::string_view) { throw std::runtime_error("disk full"); };
  EXPECT_THROW(write_citygml(SampleRegion::settlement(200, true).region(), options(), full), std::runtime_error);
}

TEST(CityGml, EmptyRegion) {
  const GmlFile file = validators::read_citygml_text(write_citygml(SampleRegion().region(), options()));
  EXPECT_TRUE(file.buildings.empty());
  EXPECT_FALSE(file.lower.has_value());
}

TEST(CityGml, ForbiddenCharactersCannotBreakAFile) {
  SampleRegion s;
  model::Building& b = s.add_building(1, {{std::string("k\0\x01\xFFy", 5), std::string("v\0\x02\xC3", 4)}});
  s.add_box(b, b.id(), 0, 0, 10, 8, 0, 6);
  EXPECT_EQ(validators::read_citygml_text(write_citygml(s.region(), options())).buildings.size(), 1u);
}

TEST(Codes, UsesAreSortedForTheSearch) {
  EXPECT_EQ(class_code("allotment_house"), "1050");
  EXPECT_EQ(class_code("warehouse"), "1150");
  EXPECT_EQ(class_code("supermarket"), "1030");
  EXPECT_EQ(class_code("sty"), "1090");
  EXPECT_EQ(class_code("farm"), "1000");
  EXPECT_EQ(class_code("yes"), "");
  EXPECT_EQ(roof_type_code(model::RoofShape::gabled), "1030");
  EXPECT_EQ(roof_type_code(model::RoofShape::other), "");
}

TEST(CityGml, ValidatesAgainstTheSchema) {
  const std::filesystem::path schemas = std::filesystem::path(BLOCKRAND_SHARED_DIR) / "schemas";
  if (!std::filesystem::exists(schemas / "citygml2.xsd")) GTEST_SKIP() << "no CityGML schemas in " << schemas;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "blockrand_citygml_schema";
  std::filesystem::create_directories(folder);
  int number = 0;
  std::string files;
  for (const SampleRegion& sample : {SampleRegion::zoo(), SampleRegion(), SampleRegion::settlement(3, true)})
    for (int lod = 0; lod <= 2; ++lod) {
      CityGmlOptions o = options();
      o.lod = lod;
      o.evidence = lod == 2;
      const auto path = folder / (std::to_string(number++) + ".gml");
      std::ofstream(path, std::ios::binary) << write_citygml(sample.region(), o);
      files += " " + path.string();
    }
  const std::string command = "XML_CATALOG_FILES=" + (schemas / "catalog.xml").string() +
                              " xmllint --nonet --noout --schema " + (schemas / "citygml2.xsd").string() + files +
                              " > " + (folder / "log").string() + " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream log(folder / "log");
  EXPECT_EQ(status, 0) << log.rdbuf();
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace blockrand::outputs
