// Files that break the rules: read as far as it makes sense, and the breach counted; refused only when nothing is left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string kGround = "390000 5820000 30 390000 5820008 30 390010 5820008 30 390010 5820000 30";

std::string house(const std::string& id) { return building(id, surface("GroundSurface", polygon(kGround))); }

std::vector<std::string> ids(const ReferenceModel& m) {
  std::vector<std::string> out;
  for (const Building& b : m.buildings) out.push_back(b.id);
  return out;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

const Note& note(const ReferenceModel& m, NoteKind kind) {
  for (const Note& n : m.notes)
    if (n.kind == kind) return n;
  ADD_FAILURE() << "no note " << name_of(kind);
  static const Note none;
  return none;
}

TEST(DamagedCityGml, IdsThatAreNoNamesOrMissingOrGivenTwice) {
  const auto m = read(document(house("4018_1") + house("4018_1") + house("")));
  EXPECT_THAT(ids(m), ElementsAre("4018_1", "4018_1", ""));
  EXPECT_EQ(m.count(NoteKind::bad_id), 2u);
  EXPECT_EQ(m.count(NoteKind::duplicate_id), 1u);
  EXPECT_EQ(m.count(NoteKind::missing_id), 1u);
  EXPECT_EQ(m.breaches(), 4u);
  EXPECT_THAT(note(m, NoteKind::bad_id).examples[0], AllOf(HasSubstr("line 8"), HasSubstr("4018_1")));
}

TEST(DamagedCityGml, OnlyTheFirstExamplesAreKept) {
  std::string members;
  for (int i = 0; i < 50; ++i) members += house("7" + std::to_string(i));
  const auto m = read(document(members));
  EXPECT_EQ(m.count(NoteKind::bad_id), 50u);
  EXPECT_THAT(note(m, NoteKind::bad_id).examples, SizeIs(5));
}

TEST(DamagedCityGml, PrefixesThatAreNotDeclared) {
  std::string xml = document(house("b"));
  for (const char* declaration :
       {R"(xmlns:bldg="http://www.opengis.net/citygml/building/2.0")", R"(xmlns:gml="http://www.opengis.net/gml")"})
    xml = replaced(xml, declaration, "");
  const auto m = read(xml);
  EXPECT_THAT(ids(m), ElementsAre("b"));
  EXPECT_THAT(m.polygons, SizeIs(1));
  EXPECT_GT(m.count(NoteKind::malformed_xml), 0u);
}

TEST(DamagedCityGml, RingsThatAreOpenShortOrNoNumbers) {
  const auto ring = [](const std::string& list) {
    return surface("WallSurface", "<gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>" + list +
                                      "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>");
  };
  const auto m = read(document(
      building("b", ring("0 0 0 1 0 0 1 0 1") + ring("0 0 0 1 0 0 0 0 0") + ring("0 0 0 1 0 zero 1 1 1 0 0 0") +
                        ring("0 0 0 1 0 0 1") + ring("0 0 0 1e300 0 0 1 1 1 0 0 0") +
                        ring("nan 0 0 1 0 0 1 1 1 nan 0 0") + ring("") + ring("0 0 0 0 1 0 0 1 1 0 0 0"))));
  EXPECT_EQ(m.count(NoteKind::open_ring), 1u);
  EXPECT_EQ(m.count(NoteKind::short_ring), 2u);  // the second, and the one without any point
  EXPECT_EQ(m.count(NoteKind::bad_coordinates), 4u);
  EXPECT_THAT(m.polygons, SizeIs(2));
  EXPECT_THAT(m.buildings[0].surfaces, SizeIs(8));
}

TEST(DamagedCityGml, ABadHoleDoesNotCostThePolygon) {
  const auto m =
      read(document(building("b", surface("WallSurface", polygon("0 0 0 9 0 0 9 0 9", "", "1 0 1 x 0 2 2 0 1")))));
  ASSERT_THAT(m.polygons, SizeIs(1));
  EXPECT_THAT(m.polygons[0].holes, IsEmpty());
  EXPECT_EQ(m.count(NoteKind::bad_coordinates), 1u);
}

TEST(DamagedCityGml, LinksToNowhereToOtherFilesAndInCircles) {
  const auto m = read(document(building("b", R"(<bldg:lod2MultiSurface><gml:MultiSurface gml:id="self">
      <gml:surfaceMember xlink:href="#nobody"/><gml:surfaceMember xlink:href="other.gml#p"/><gml:surfaceMember xlink:href="#self"/>
      <gml:surfaceMember>)" + polygon(kGround) + "</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface>")));
  EXPECT_GE(m.count(NoteKind::unresolved_link), 3u);
  EXPECT_THAT(m.polygons, SizeIs(1));
  EXPECT_FALSE(m.buildings[0].geometries.empty());
}

TEST(DamagedCityGml, LinksThatDoubleThirtyTimesEnd) {
  // Each level names the one before twice: 2^30 faces if all were made.
  std::string levels;
  for (int i = 30; i > 0; --i) {
    const std::string link = "<gml:surfaceMember xlink:href=\"#l" + std::to_string(i - 1) + "\"/>";
    levels += "<bldg:lod2MultiSurface><gml:MultiSurface gml:id=\"l" + std::to_string(i) + "\">" + link + link +
              "</gml:MultiSurface></bldg:lod2MultiSurface>";
  }
  levels += "<bldg:lod2MultiSurface><gml:MultiSurface gml:id=\"l0\"></gml:MultiSurface></bldg:lod2MultiSurface>";
  const auto m = read(document(building("b", levels)));
  EXPECT_THAT(m.buildings, SizeIs(1));
  EXPECT_THAT(m.buildings[0].geometries, IsEmpty());
  EXPECT_THAT(note(m, NoteKind::unresolved_link).examples, ElementsAre(HasSubstr("without end")));
}

TEST(DamagedCityGml, ChainsOfLinksAreFollowedToTheirEnd) {
  constexpr int kLinks = 200'000;  // more than a stack of calls holds
  std::string chain;
  for (int i = 0; i < kLinks; ++i)
    chain += "<gml:surfaceMember><gml:CompositeSurface gml:id=\"c" + std::to_string(i) +
             "\"><gml:surfaceMember xlink:href=\"#c" + std::to_string(i + 1) +
             "\"/></gml:CompositeSurface></gml:surfaceMember>";
  const std::string last = "<gml:surfaceMember><gml:CompositeSurface gml:id=\"c" + std::to_string(kLinks) +
                           "\"><gml:surfaceMember>" + polygon(kGround) +
                           "</gml:surfaceMember></gml:CompositeSurface></gml:surfaceMember>";
  const auto m = read(document(
      building("b",
               "<bldg:lod1MultiSurface><gml:MultiSurface><gml:surfaceMember xlink:href=\"#c0\"/></gml:MultiSurface>"
               "</bldg:lod1MultiSurface><bldg:lod2MultiSurface><gml:MultiSurface>" +
                   chain + last + "</gml:MultiSurface></bldg:lod2MultiSurface>")));
  ASSERT_THAT(m.buildings, SizeIs(1));
  ASSERT_FALSE(m.buildings[0].geometries.empty());
  EXPECT_EQ(m.buildings[0].geometries[0].lod, 1);
  EXPECT_THAT(m.buildings[0].geometries[0].faces, SizeIs(1));
}

TEST(DamagedCityGml, ValuesThatAreNone) {
  const auto m = read(
      document(building("b",
                        "<bldg:yearOfConstruction>unknown</bldg:yearOfConstruction><bldg:roofType/"
                        "><bldg:measuredHeight>high</bldg:measuredHeight>"
                        "<bldg:storeysAboveGround>-3</bldg:storeysAboveGround><bldg:storeysBelowGround>1.5</"
                        "bldg:storeysBelowGround>") +
               building("c",
                        "<bldg:measuredHeight "
                        "uom=\"furlong\">1</bldg:measuredHeight><bldg:storeysAboveGround>4.0</bldg:storeysAboveGround>"
                        "<bldg:yearOfConstruction>1950-01-01</bldg:yearOfConstruction>") +
               building("d", "<bldg:measuredHeight uom=\"ft\">10</bldg:measuredHeight>")));
  const Building& b = m.buildings[0];
  EXPECT_FALSE(b.year_of_construction || b.measured_height || b.storeys_above_ground || b.storeys_below_ground);
  EXPECT_EQ(b.roof_type, "");
  EXPECT_FALSE(m.buildings[1].measured_height.has_value());
  EXPECT_EQ(m.buildings[1].storeys_above_ground, 4);
  EXPECT_EQ(m.buildings[1].year_of_construction, 1950);
  EXPECT_DOUBLE_EQ(m.buildings[2].measured_height.value_or(0), 3.048);
  EXPECT_EQ(m.count(NoteKind::bad_value), 5u);
}

TEST(DamagedCityGml, ForeignElementsOfABuildingAreLeftOut) {
  const auto m =
      read(document(building("b", "<zone xmlns=\"http://example.org/ade\"><bldg:lod2MultiSurface>" + polygon(kGround) +
                                      "</bldg:lod2MultiSurface></zone>" + surface("GroundSurface", polygon(kGround)))));
  EXPECT_THAT(m.polygons, SizeIs(1));
  EXPECT_EQ(m.count(NoteKind::unknown_element), 1u);
}

TEST(DamagedCityGml, PolygonsOutsideOfTheEnvelope) {
  std::string xml = document(house("b"));
  const auto with_corners = [&](const std::string& low, const std::string& high) {
    return replaced(
        xml, "</gml:Envelope>",
        "<gml:lowerCorner>" + low + "</gml:lowerCorner><gml:upperCorner>" + high + "</gml:upperCorner></gml:Envelope>");
  };
  EXPECT_EQ(read(with_corners("390000 5820000 30", "390010 5820008 30")).breaches(), 0u);
  EXPECT_EQ(read(with_corners("390001 5820000 30", "390010 5820008 30")).count(NoteKind::outside_envelope), 1u);
  const auto swapped = read(with_corners("5820000 390000 30", "5820008 390010 30"));
  EXPECT_THAT(note(swapped, NoteKind::crs).examples, ElementsAre(HasSubstr("envelope")));
}

TEST(DamagedCityGml, FilesThatEndTooEarlyKeepWholeBuildings) {
  const std::string xml = document(house("a") + house("b") + house("c"));
  const std::size_t third = xml.find("gml:id=\"c\"");
  std::size_t cut_in_third = 0;
  for (std::size_t length = third; length < xml.size() - 40; length += 17) {
    const auto m = read(xml.substr(0, length));
    const bool whole = xml.substr(0, length).find("</bldg:Building>", third) != std::string::npos;
    EXPECT_THAT(ids(m), whole ? testing::Matcher<std::vector<std::string>>(ElementsAre("a", "b", "c"))
                              : testing::Matcher<std::vector<std::string>>(ElementsAre("a", "b")))
        << length;
    EXPECT_GT(m.count(NoteKind::malformed_xml), 0u) << length;
    cut_in_third += m.count(NoteKind::incomplete_building);
  }
  EXPECT_GT(cut_in_third, 10u);
}

TEST(DamagedCityGml, ABuildingThatIsCutOffTakesItsPartsAlong) {
  const std::string xml = document(
      house("a") + building("b", "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"p\">" +
                                     surface("GroundSurface", polygon(kGround)) +
                                     "</bldg:BuildingPart></bldg:consistsOfBuildingPart><gml:name>x</gml:name>"));
  EXPECT_THAT(ids(read(xml)), ElementsAre("a", "b", "p"));
  EXPECT_THAT(ids(read(xml.substr(0, xml.find("<gml:name>")))), ElementsAre("a"));
}

TEST(DamagedCityGml, MissingEndTagsCostOneBuildingAtMost) {
  const std::string address = "<bldg:address><Address><x>1</x></Address></bldg:address>";
  const std::string b = building("b", address + surface("GroundSurface", polygon(kGround)));
  for (const std::string lost : {"</gml:exterior>", "</gml:posList>", "</gml:Polygon>", "</bldg:GroundSurface>",
                                 "</Address>", "</bldg:Building>"}) {
    SCOPED_TRACE(lost);
    const auto m = read(document(house("a") + replaced(b, lost, "") + house("c") + house("d")));
    EXPECT_THAT(ids(m), ElementsAre("a", "b", "c", "d"));  // the member's end tag ends the building
    EXPECT_GT(m.count(NoteKind::malformed_xml), 0u);
    EXPECT_THAT(m.buildings.back().surfaces, SizeIs(1));
    const auto two = read(
        document(house("a") + replaced(replaced(b, lost, ""), "</cityObjectMember>", "") + house("c") + house("d")));
    EXPECT_THAT(ids(two), ElementsAre("a", "c", "d"));
    EXPECT_EQ(two.count(NoteKind::incomplete_building), 1u);
    EXPECT_THAT(two.buildings.back().surfaces, SizeIs(1));
  }
}

TEST(DamagedCityGml, CutArchivesKeepWholeBuildings) {
  const TempFolder folder;
  std::string members;
  for (int i = 0; i < 3000; ++i) members += house("b" + std::to_string(i * 7919 % 3000));
  const std::string path = folder.write_gzipped("a.gml.gz", document(members));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
  const auto m = read_citygml(path);
  EXPECT_GT(m.buildings.size(), 500u);
  EXPECT_LT(m.buildings.size(), 3000u);
  EXPECT_GT(m.count(NoteKind::malformed_xml), 0u);
}

TEST(DamagedCityGml, IllegalBytesAndStrayTagsAreNotTheEnd) {
  const std::string xml = document(building("a", "<gml:name>NAME</gml:name>") + house("b") + house("c"));
  const auto bytes = read(replaced(xml, "NAME",
                                   "Stra\xdf"
                                   "e \x02"));
  EXPECT_THAT(ids(bytes), ElementsAre("a", "b", "c"));
  EXPECT_GT(bytes.count(NoteKind::malformed_xml), 0u);
  const auto entity = read(replaced(xml, "NAME", "&nbsp;x"));
  EXPECT_THAT(ids(entity), ElementsAre("a", "b", "c"));
  EXPECT_GT(entity.count(NoteKind::malformed_xml), 0u);
  const auto stray = read(replaced(xml, "<gml:name>NAME</gml:name>", "<gml:name>NAME</gml:nam>"));
  EXPECT_GE(stray.buildings.size(), 2u);
  EXPECT_GT(stray.count(NoteKind::malformed_xml), 0u);
}

TEST(RefusedCityGml, SaysFilePlaceAndRemedy) {
  const TempFolder folder;
  EXPECT_THAT(refusal(folder.path() + "/missing.gml"), AllOf(HasSubstr("missing.gml"), HasSubstr("no such file")));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a directory"));
  EXPECT_THAT(refusal(folder.write("empty.gml", "")), HasSubstr("is empty"));
  EXPECT_THAT(refusal(folder.write("text.gml", "no XML at all")),
              AllOf(HasSubstr("text.gml:line 1"), HasSubstr("no XML")));
  EXPECT_THAT(refusal(folder.write("binary.gml", std::string("\x1f\x8b\x08\x00garbage", 11))), HasSubstr("no XML"));
  EXPECT_THAT(refusal(folder.write("map.gml", "<osm version=\"0.6\"/>")),
              AllOf(HasSubstr("no CityGML"), HasSubstr("<osm>")));
  EXPECT_THAT(refusal(folder.write("new.gml", R"(<CityModel xmlns="http://www.opengis.net/citygml/3.0"/>)")),
              HasSubstr("CityGML 3.0"));
  EXPECT_THAT(refusal(folder.write("cut.gml", document(house("b")).substr(0, 900))),
              AllOf(HasSubstr("no building"), HasSubstr("damaged")));
  EXPECT_THAT(
      refusal(folder.write("dtd.gml", "<!DOCTYPE CityModel [<!ENTITY a \"b\">]>" + document(house("b")).substr(39))),
      HasSubstr("document type definition"));
}

TEST(RefusedCityGml, NotWithoutBuildings) {
  const auto m = read(document("", ""));
  EXPECT_THAT(m.buildings, IsEmpty());
  EXPECT_EQ(m.breaches(), 0u);
}

TEST(RefusedCityGml, WithoutACoordinateReferenceSystem) {
  const TempFolder folder;
  const std::string none = folder.write("none.gml", document(house("b"), "")),
                    unknown = folder.write("unknown.gml", document(house("b"), "my own grid"));
  EXPECT_THAT(refusal(none), AllOf(HasSubstr("none.gml"), HasSubstr("no srsName"), HasSubstr("--reference-crs")));
  EXPECT_THAT(refusal(unknown), AllOf(HasSubstr("my own grid"), HasSubstr("--reference-crs")));
  ReadOptions options;
  options.reference_crs = "EPSG:25833";
  for (const std::string& path : {none, unknown}) {
    const auto m = read_citygml(path, options);
    EXPECT_EQ(m.crs.horizontal, "EPSG:25833");
    EXPECT_TRUE(m.crs.from_options);
  }
  options.reference_crs = "EPSG:999999";
  EXPECT_THAT(refusal(none, options), AllOf(HasSubstr("--reference-crs"), HasSubstr("EPSG:999999")));
}

}  // namespace
}  // namespace blockrand::importers::reference::test
