// Files that no build writes and anybody may send: `validate` says what is wrong and ends. Most were found by tests/fuzz.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "pipeline/validate/citygml_reader.h"
#include "pipeline/validate/cityjson_reader.h"
#include "pipeline/validate/report_check.h"
#include "tests/unit/base/text_file.h"

namespace blockrand::validate {
namespace {

/// Declarations of entities, each ten times the one before: "&j;" stands for 10 GB.
std::string growing_entities() {
  std::string text = "<!ENTITY a \"0123456789\">";
  for (char name = 'b'; name <= 'j'; ++name) {
    text += std::string("<!ENTITY ") + name + " \"";
    for (int i = 0; i < 10; ++i) text += std::string("&") + static_cast<char>(name - 1) + ";";
    text += "\">";
  }
  return text;
}

TEST(HostileFiles, EntitiesOfAReportPageAreNotExpanded) {
  const base::test::TextFile page("report.html",
                                  "<!DOCTYPE html [" + growing_entities() + "]><html id=\"&j;\">&j;</html>");
  FindingLog log;
  check_report_page(std::filesystem::path(page.path()).parent_path().string(), BuildRecord(), nullptr, log);
  ASSERT_EQ(log.count(Check::file_unreadable), 1u);
  EXPECT_EQ(log.kept().front().detail, "declares entities, which no page of Blockrand has");
}

/// A CityModel with one building, in which `inside` stands.
CityGml city_of(const std::string& inside) {
  return read_citygml(
      "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\" xmlns:gml=\"http://www.opengis.net/gml\" "
      "xmlns:bldg=\"http://www.opengis.net/citygml/building/2.0\" "
      "xmlns:xAL=\"urn:oasis:names:tc:ciq:xsdschema:xAL:2.0\"><cityObjectMember><bldg:Building gml:id=\"w1\">" +
          inside + "</bldg:Building></cityObjectMember></CityModel>",
      "f.gml");
}

/// A solid of level 1 in which `inside` stands before its only polygon.
std::string solid_around(const std::string& inside) {
  return "<bldg:lod1Solid><gml:Solid>" + inside +
         "<gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 0 0 1 1 0 0 0 0</gml:posList>"
         "</gml:LinearRing></gml:exterior></gml:Polygon></gml:Solid></bldg:lod1Solid>";
}

TEST(HostileFiles, ElementsOfOtherNamespacesEndNoBuilding) {
  for (const char* stranger : {"<Building xmlns=\"urn:other\"/>", "<xAL:Building/>", "<xAL:BuildingPart/>"}) {
    const CityGml read = city_of(solid_around(stranger));
    ASSERT_TRUE(read.readable);
    ASSERT_EQ(read.contents.bodies.size(), 1u) << stranger;
    ASSERT_EQ(read.contents.bodies[0].solids.size(), 1u) << stranger;
    EXPECT_EQ(read.contents.bodies[0].solids[0].polygons.size(), 1u) << stranger;
  }
}

TEST(HostileFiles, ABuildingInsideOfASolidHasNotThatSolid) {
  const std::string polygon = "<gml:Polygon><gml:exterior/></gml:Polygon>";
  for (const std::string& inside :
       {polygon, std::string("<gml:surfaceMember xmlns:xlink=\"http://www.w3.org/1999/xlink\" xlink:href=\"#p\"/>"),
        std::string("<gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 0 0 1 1 0 0 0 0</gml:posList>"
                    "</gml:LinearRing></gml:exterior></gml:Polygon>")}) {
    const CityGml read = city_of(solid_around("<bldg:Building gml:id=\"w2\">" + inside + "</bldg:Building>"));
    ASSERT_TRUE(read.readable);
    EXPECT_FALSE(read.contents.findings.empty());
    for (const ReadBody& body : read.contents.bodies) EXPECT_TRUE(body.id == "w1" || body.solids.empty());
  }
}

/// A CityJSON object with a building whose geometry and vertices are these.
Contents cityjson_of(const std::string& geometry, const std::string& vertices, const std::string& behind = "") {
  return read_cityjson(
      "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":{\"scale\":[1,1,1],\"translate\":[0,0,0]},"
      "\"CityObjects\":{\"w1\":{\"type\":\"Building\",\"attributes\":{\"lod\":1},\"geometry\":" +
          geometry + "}}" + behind + ",\"vertices\":" + vertices + "}",
      "f.city.json");
}

TEST(HostileFiles, JsonThatIsNestedForeverIsNotCopied) {
  const Contents contents = cityjson_of(std::string(100000, '[') + std::string(100000, ']'), "[]");
  ASSERT_EQ(contents.findings.size(), 1u);
  EXPECT_EQ(contents.findings[0].check, Check::file_unreadable);
  EXPECT_EQ(contents.findings[0].detail, "nested deeper than 256 levels");
}

TEST(HostileFiles, BracketsInTextsNestNothing) {
  const std::string text = "\"\\\"" + std::string(1000, '[') + "\"";
  for (const Finding& f : cityjson_of(text, "[]").findings) EXPECT_NE(f.check, Check::file_unreadable) << f.detail;
}

TEST(HostileFiles, CityObjectsThatAreGivenTwiceAreThoseOfTheSecondTime) {
  const Contents contents = cityjson_of("[]", "[]", ",\"CityObjects\":{}");
  EXPECT_TRUE(contents.bodies.empty());
  ASSERT_FALSE(contents.findings.empty());
  EXPECT_EQ(contents.findings[0].detail, "\"CityObjects\" stands twice in an object");
}

TEST(HostileFiles, VerticesThatAreNoNumbersBecomeNoPoints) {
  for (const char* vertex : {"[\"a\",0,0]", "[0,0]", "[0.5,0,0]"}) {
    const Contents contents =
        cityjson_of("[{\"type\":\"MultiSurface\",\"lod\":\"0\",\"boundaries\":[[[0,1,2]],[[1,2,3]]]}]",
                    std::string("[") + vertex + ",[0,0,0],[9,0,0],[9,9,0]]");
    ASSERT_EQ(contents.bodies.size(), 1u);
    ASSERT_EQ(contents.bodies[0].footprint.size(), 1u) << vertex;
    EXPECT_EQ(contents.bodies[0].footprint[0].rings[0].size(), 3u);
  }
}

}  // namespace
}  // namespace blockrand::validate
