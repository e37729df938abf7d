// What stands in a CityGML file of each version arrives, whatever prefixes and forms it was written in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/importers/reference/level_of_detail.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using model::Point3;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

const std::string kGround = "390000 5820000 30 390000 5820008 30 390010 5820008 30 390010 5820000 30";
const std::string kRoof = "390000 5820000 36 390010 5820000 36 390010 5820008 36 390000 5820008 36";

TEST(CityGml, AttributesOfABuilding) {
  const auto m = read(document(building("b1", R"(
    <gml:name>Town hall</gml:name><gml:name> Rathaus </gml:name>
    <externalReference><informationSystem>x</informationSystem><externalObject><name>not mine</name></externalObject></externalReference>
    <gen:stringAttribute name="owner"><gen:value>city &amp; state</gen:value></gen:stringAttribute>
    <gen:doubleAttribute name="volume"><gen:value>12.5</gen:value></gen:doubleAttribute>
    <gen:genericAttributeSet name="energy"><gen:intAttribute name="class"><gen:value>3</gen:value></gen:intAttribute></gen:genericAttributeSet>
    <bldg:class>1000</bldg:class><bldg:function>1120</bldg:function><bldg:function>1123</bldg:function><bldg:usage>9</bldg:usage>
    <bldg:yearOfConstruction>1898</bldg:yearOfConstruction><bldg:yearOfDemolition>1945</bldg:yearOfDemolition>
    <bldg:roofType>1030</bldg:roofType><bldg:measuredHeight uom="urn:ogc:def:uom:UCUM::m">16.4</bldg:measuredHeight>
    <bldg:storeysAboveGround>4</bldg:storeysAboveGround><bldg:storeysBelowGround>1</bldg:storeysBelowGround>)" +
                                                  surface("GroundSurface", polygon(kGround)))));
  ASSERT_THAT(m.buildings, SizeIs(1));
  const Building& b = m.buildings[0];
  EXPECT_EQ(m.version, "2.0");
  EXPECT_EQ(b.id, "b1");
  EXPECT_THAT(b.names, ElementsAre("Town hall", "Rathaus"));
  EXPECT_THAT(b.attributes,
              ElementsAre(Pair("owner", "city & state"), Pair("volume", "12.5"), Pair("energy/class", "3")));
  EXPECT_EQ(b.class_code, "1000");
  EXPECT_THAT(b.functions, ElementsAre("1120", "1123"));
  EXPECT_THAT(b.usages, ElementsAre("9"));
  EXPECT_EQ(b.year_of_construction, 1898);
  EXPECT_EQ(b.year_of_demolition, 1945);
  EXPECT_EQ(b.roof_type, "1030");
  EXPECT_EQ(b.measured_height, 16.4);
  EXPECT_EQ(b.storeys_above_ground, 4);
  EXPECT_EQ(b.storeys_below_ground, 1);
  EXPECT_THAT(m.notes, IsEmpty());
}

TEST(CityGml, PartsFollowTheirBuilding) {
  const std::string part = R"(<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id="p)";
  const auto m = read(
      document(building("b1", "<bldg:roofType>1000</bldg:roofType>" + part + "1\"><bldg:roofType>1030</bldg:roofType>" +
                                  surface("GroundSurface", polygon(kGround)) +
                                  "</bldg:BuildingPart></bldg:consistsOfBuildingPart>" + part +
                                  "2\"><bldg:storeysAboveGround>2</bldg:storeysAboveGround></bldg:BuildingPart>"
                                  "</bldg:consistsOfBuildingPart><bldg:measuredHeight>9</bldg:measuredHeight>") +
               building("b2", surface("RoofSurface", polygon(kRoof)))));
  ASSERT_THAT(m.buildings, SizeIs(4));
  EXPECT_EQ(m.buildings[0].parent, -1);
  EXPECT_EQ(m.buildings[1].id, "p1");
  EXPECT_EQ(m.buildings[1].parent, 0);
  EXPECT_EQ(m.buildings[2].parent, 0);
  EXPECT_EQ(m.buildings[3].id, "b2");
  EXPECT_EQ(m.buildings[3].parent, -1);
  EXPECT_EQ(m.buildings[0].roof_type, "1000");
  EXPECT_EQ(m.buildings[0].measured_height, 9);
  EXPECT_EQ(m.buildings[1].roof_type, "1030");
  EXPECT_THAT(m.buildings[1].surfaces, SizeIs(1));
  EXPECT_EQ(lod_of(m.buildings[1]), 2);
  EXPECT_EQ(lod_of(m.buildings[0]), -1);
}

TEST(CityGml, SurfacesWithHolesAndOpenings) {
  const auto m = read(
      document(building("b", R"(<bldg:boundedBy><bldg:WallSurface gml:id="w"><bldg:lod3MultiSurface><gml:MultiSurface>
    <gml:surfaceMember>)" + polygon("0 0 0 9 0 0 9 0 9 0 0 9", "face", "2 0 2 2 0 4 4 0 4 4 0 2") +
                                 R"(</gml:surfaceMember>
    </gml:MultiSurface></bldg:lod3MultiSurface><bldg:opening><bldg:Window gml:id="win"><bldg:lod3MultiSurface><gml:MultiSurface>
    <gml:surfaceMember>)" + polygon("2 0 2 4 0 2 4 0 4 2 0 4") +
                                 R"(</gml:surfaceMember></gml:MultiSurface></bldg:lod3MultiSurface>
    </bldg:Window></bldg:opening><bldg:opening><bldg:Door/></bldg:opening></bldg:WallSurface></bldg:boundedBy>)" +
                                 surface("OuterCeilingSurface", polygon(kRoof)))));
  ASSERT_THAT(m.buildings[0].surfaces, SizeIs(2));
  const Surface& wall = m.buildings[0].surfaces[0];
  EXPECT_EQ(wall.surface_class, SurfaceClass::wall);
  EXPECT_EQ(wall.id, "w");
  ASSERT_THAT(wall.geometries, SizeIs(1));
  EXPECT_EQ(wall.geometries[0].lod, 3);
  ASSERT_THAT(wall.geometries[0].faces, SizeIs(1));
  const Polygon3& face = m.polygons[wall.geometries[0].faces[0].polygon];
  EXPECT_EQ(face.id, "face");
  EXPECT_THAT(face.outer, ElementsAre(Point3{0, 0, 0}, Point3{9, 0, 0}, Point3{9, 0, 9}, Point3{0, 0, 9}));
  EXPECT_THAT(face.holes, ElementsAre(ElementsAre(Point3{2, 0, 2}, Point3{2, 0, 4}, Point3{4, 0, 4}, Point3{4, 0, 2})));
  ASSERT_THAT(wall.openings, SizeIs(2));
  EXPECT_FALSE(wall.openings[0].door);
  EXPECT_EQ(wall.openings[0].id, "win");
  ASSERT_THAT(wall.openings[0].geometries, SizeIs(1));
  EXPECT_EQ(m.polygons[wall.openings[0].geometries[0].faces[0].polygon].outer[1], (Point3{4, 0, 2}));
  EXPECT_TRUE(wall.openings[1].door);
  EXPECT_THAT(wall.openings[1].geometries, IsEmpty());
  EXPECT_EQ(m.buildings[0].surfaces[1].surface_class, SurfaceClass::outer_ceiling);
  EXPECT_EQ(lod_of(m.buildings[0]), 3);
}

TEST(CityGml, InstallationsAndRoomsAreKeptApart) {
  const std::string geometry = "<bldg:lod4Geometry><gml:MultiGeometry><gml:geometryMember>" + polygon(kRoof) +
                               "</gml:geometryMember></gml:MultiGeometry></bldg:lod4Geometry>";
  const auto m = read(document(
      building("b", "<bldg:outerBuildingInstallation><bldg:BuildingInstallation>" + geometry +
                        surface("WallSurface", polygon(kRoof)) +
                        "</bldg:BuildingInstallation></bldg:outerBuildingInstallation><bldg:interiorRoom><bldg:Room>" +
                        surface("FloorSurface", polygon(kRoof)) + surface("ClosureSurface", polygon(kRoof)) +
                        "</bldg:Room></bldg:interiorRoom>" + surface("WallSurface", polygon(kRoof)))));
  std::vector<std::string> found;
  for (const Surface& s : m.buildings[0].surfaces)
    found.push_back(std::string(name_of(s.surface_class)) + (s.interior ? " interior" : "") +
                    (s.of_installation ? " of installation" : "") + " " + std::to_string(s.geometries.size()));
  EXPECT_THAT(found, ElementsAre("installation 1", "wall of installation 1", "room interior 0", "floor interior 1",
                                 "closure interior 1", "wall 1"));
}

TEST(CityGml, Version10WithOtherPrefixesAndSinglePositions) {
  const auto m = read(R"(<?xml version="1.0" encoding="ISO-8859-1"?>
<c:CityModel xmlns:c="http://www.opengis.net/citygml/1.0" xmlns:haus="http://www.opengis.net/citygml/building/1.0" xmlns:g="http://www.opengis.net/gml">
<c:cityObjectMember><haus:Building g:id="b"><g:name>)"
                      "Stra\xdf"
                      R"(e</g:name><haus:lod1MultiSurface><g:MultiSurface srsName="urn:ogc:def:crs:EPSG::25832">
<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:pos>500000 5500000 1</g:pos><g:pos>500010 5500000 1</g:pos>
<g:pos>500010 5500010 1</g:pos><g:pos>500000 5500000 1</g:pos></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>
</g:MultiSurface></haus:lod1MultiSurface></haus:Building></c:cityObjectMember></c:CityModel>)");
  EXPECT_EQ(m.version, "1.0");
  EXPECT_EQ(m.crs.horizontal, "EPSG:25832");
  ASSERT_THAT(m.buildings, SizeIs(1));
  EXPECT_THAT(m.buildings[0].names, ElementsAre("Straße"));
  ASSERT_THAT(m.polygons, SizeIs(1));
  EXPECT_THAT(m.polygons[0].outer,
              ElementsAre(Point3{500000, 5500000, 1}, Point3{500010, 5500000, 1}, Point3{500010, 5500010, 1}));
  EXPECT_EQ(m.buildings[0].geometries[0].lod, 1);
  EXPECT_THAT(m.notes, IsEmpty());
}

TEST(CityGml, Version04InOneNamespaceWithOldCoordinates) {
  const auto m = read(R"(<CityModel xmlns="http://www.citygml.org/citygml/1/0/0" xmlns:gml="http://www.opengis.net/gml">
<cityObjectMember><Building gml:id="b"><yearOfConstruction>1998+01:00</yearOfConstruction><measuredHeight uom="m">7</measuredHeight>
<boundedBy><GroundSurface><lod2MultiSurface><gml:MultiSurface srsName="EPSG:3068"><gml:surfaceMember><TexturedSurface orientation="-">
<gml:baseSurface><gml:Polygon><gml:exterior><gml:LinearRing><gml:coordinates>23000,21000,5 23010,21000,5 23010,21010,5 23000,21000,5</gml:coordinates>
</gml:LinearRing></gml:exterior></gml:Polygon></gml:baseSurface><appearance><Material><shininess>0.5</shininess></Material></appearance>
</TexturedSurface></gml:surfaceMember></gml:MultiSurface></lod2MultiSurface></GroundSurface></boundedBy></Building></cityObjectMember></CityModel>)");
  EXPECT_EQ(m.version, "0.4");
  ASSERT_THAT(m.buildings, SizeIs(1));
  EXPECT_EQ(m.buildings[0].year_of_construction, 1998);
  EXPECT_EQ(m.buildings[0].measured_height, 7);
  ASSERT_THAT(m.buildings[0].surfaces, SizeIs(1));
  const auto& faces = m.buildings[0].surfaces[0].geometries[0].faces;
  EXPECT_THAT(faces, ElementsAre(Face{0, true}));
  EXPECT_THAT(m.polygons[0].outer,
              ElementsAre(Point3{23000, 21000, 5}, Point3{23010, 21000, 5}, Point3{23010, 21010, 5}));
}

TEST(CityGml, FootprintsOfLevel0InTwoDimensions) {
  const auto m = read(
      document(building("b", R"(<bldg:lod0FootPrint><gml:MultiSurface srsDimension="2"><gml:surfaceMember><gml:Polygon>
    <gml:exterior><gml:LinearRing><gml:posList>390000 5820000 390010 5820000 390010 5820008 390000 5820000</gml:posList></gml:LinearRing></gml:exterior>
    </gml:Polygon></gml:surfaceMember></gml:MultiSurface></bldg:lod0FootPrint><bldg:lod0RoofEdge><gml:MultiSurface><gml:surfaceMember>)" +
                                 polygon(kRoof) + "</gml:surfaceMember></gml:MultiSurface></bldg:lod0RoofEdge>")));
  ASSERT_THAT(m.buildings[0].geometries, SizeIs(2));
  EXPECT_EQ(m.buildings[0].geometries[0].kind, GeometryKind::footprint);
  EXPECT_EQ(m.buildings[0].geometries[1].kind, GeometryKind::roof_edge);
  EXPECT_THAT(m.polygons[0].outer,
              ElementsAre(Point3{390000, 5820000, 0}, Point3{390010, 5820000, 0}, Point3{390010, 5820008, 0}));
  EXPECT_EQ(m.count(NoteKind::two_dimensional), 1u);
  EXPECT_EQ(lod_of(m.buildings[0]), 0);
}

TEST(CityGml, SolidsWithVoidsAndSeveralSolids) {
  const auto shell = [](const std::string& id) {
    return "<gml:CompositeSurface><gml:surfaceMember>" + polygon(kGround, id) +
           "</gml:surfaceMember></gml:CompositeSurface>";
  };
  const auto m = read(document(building(
      "b", "<bldg:lod2Solid><gml:CompositeSolid><gml:solidMember><gml:Solid gml:id=\"s1\"><gml:exterior>" + shell("a") +
               "</gml:exterior><gml:interior>" + shell("c") + "</gml:interior><gml:interior>" + shell("d") +
               "</gml:interior></gml:Solid></gml:solidMember><gml:solidMember><gml:Solid gml:id=\"s2\"><gml:exterior>" +
               shell("e") + "</gml:exterior></gml:Solid></gml:solidMember></gml:CompositeSolid></bldg:lod2Solid>")));
  const auto& geometries = m.buildings[0].geometries;
  ASSERT_THAT(geometries, SizeIs(2));
  EXPECT_EQ(geometries[0].kind, GeometryKind::solid);
  EXPECT_EQ(geometries[0].id, "s1");
  EXPECT_THAT(geometries[0].faces, SizeIs(3));
  EXPECT_EQ(geometries[0].outer_faces, 1u);
  EXPECT_EQ(geometries[1].id, "s2");
  EXPECT_THAT(geometries[1].faces, SizeIs(1));
  EXPECT_EQ(geometries[1].outer_faces, 1u);
}

TEST(CityGml, LinksAreFollowedForwardsAndBackwards) {
  // The solid uses the ground before it is defined, the wall turned round, and a whole composite by its name.
  const auto m = read(document(building(
      "b",
      R"(<bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface><gml:surfaceMember xlink:href="#ground"/>
      <gml:surfaceMember><gml:OrientableSurface orientation="-"><gml:baseSurface xlink:href="#wall"/></gml:OrientableSurface></gml:surfaceMember>
      <gml:surfaceMember xlink:href="#roofs"/></gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>)" +
          surface("GroundSurface", polygon(kGround, "ground")) + surface("WallSurface", polygon(kRoof, "wall")) +
          R"(<bldg:boundedBy><bldg:RoofSurface><bldg:lod2MultiSurface><gml:MultiSurface gml:id="roofs"><gml:surfaceMember>)" +
          polygon(kRoof) + "</gml:surfaceMember><gml:surfaceMember>" + polygon(kRoof) +
          "</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:RoofSurface></bldg:boundedBy>")));
  EXPECT_THAT(m.polygons, SizeIs(4));
  ASSERT_THAT(m.buildings[0].geometries, SizeIs(1));
  EXPECT_THAT(m.buildings[0].geometries[0].faces,
              ElementsAre(Face{0, false}, Face{1, true}, Face{2, false}, Face{3, false}));
  EXPECT_EQ(m.breaches(), 0u);
}

TEST(CityGml, AmpersandsInAttributesAreThemselves) {
  const auto m = read(
      document(building("a&amp;b &lt;&#38;&amp;#38;",
                        R"(<gen:stringAttribute name="this &amp; that"><gen:value>x</gen:value></gen:stringAttribute>
        <bldg:lod1MultiSurface><gml:MultiSurface><gml:surfaceMember xlink:href="#p&amp;q"/></gml:MultiSurface></bldg:lod1MultiSurface>)" +
                            surface("GroundSurface", polygon(kGround, "p&amp;q")))));
  ASSERT_THAT(m.buildings, SizeIs(1));
  EXPECT_EQ(m.buildings[0].id, "a&b <&&#38;");
  EXPECT_THAT(m.buildings[0].attributes, ElementsAre(Pair("this & that", "x")));
  EXPECT_EQ(m.count(NoteKind::unresolved_link), 0u);
  ASSERT_THAT(m.polygons, SizeIs(1));
  EXPECT_EQ(m.polygons[0].id, "p&q");
}

TEST(CityGml, TurnedTwiceIsNotTurned) {
  const auto m = read(document(building(
      "b",
      R"(<bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:OrientableSurface gml:id="turned" orientation="-"><gml:baseSurface>)" +
          polygon(kRoof, "p") + R"(</gml:baseSurface></gml:OrientableSurface></gml:surfaceMember>
      <gml:surfaceMember xlink:href="#turned"/><gml:surfaceMember xlink:href="#p"/><gml:surfaceMember>
      <gml:OrientableSurface orientation="-"><gml:baseSurface xlink:href="#turned"/></gml:OrientableSurface></gml:surfaceMember>
      </gml:MultiSurface></bldg:lod2MultiSurface>)")));
  EXPECT_THAT(m.buildings[0].geometries[0].faces,
              ElementsAre(Face{0, true}, Face{0, true}, Face{0, false}, Face{0, false}));
}

TEST(CityGml, TemplatesInOtherFilesAndCurvesAreReportedAsNotRead) {
  const auto m = read(document(building(
      "b",
      "<bldg:lod2MultiCurve><gml:MultiCurve><gml:curveMember><gml:LineString><gml:posList>0 0 0 1 1 1</gml:posList>"
      "</gml:LineString></gml:curveMember></gml:MultiCurve></bldg:lod2MultiCurve>"
      "<bldg:outerBuildingInstallation><bldg:BuildingInstallation><bldg:lod3ImplicitRepresentation><ImplicitGeometry>"
      "<libraryObject>chimney.wrl</libraryObject></ImplicitGeometry></bldg:lod3ImplicitRepresentation>"
      "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>" +
          surface("GroundSurface", polygon(kGround)))));
  EXPECT_EQ(m.buildings[0].implicit_geometries, 1u);
  EXPECT_EQ(m.count(NoteKind::not_read), 2u);
  EXPECT_EQ(m.breaches(), 0u);
  EXPECT_THAT(m.polygons, SizeIs(1));
}

TEST(CityGml, OtherCityObjectsAreCountedOnly) {
  const auto m = read(document(
      "<cityObjectMember><Road xmlns=\"http://www.opengis.net/citygml/transportation/2.0\"><lod2MultiSurface>" +
      polygon(kGround) + "</lod2MultiSurface></Road></cityObjectMember>" +
      building("b", surface("GroundSurface", polygon(kGround))) +
      "<app:appearanceMember><app:Appearance><app:name>x</app:name></app:Appearance></app:appearanceMember>"));
  EXPECT_THAT(m.other_objects, ElementsAre(Pair("Road", 1u)));
  EXPECT_THAT(m.buildings, SizeIs(1));
  EXPECT_THAT(m.polygons, SizeIs(1));
}

TEST(CityGml, GzippedFilesAreReadByContent) {
  const TempFolder folder;
  const std::string xml = document(building("b", surface("GroundSurface", polygon(kGround))));
  EXPECT_THAT(read_citygml(folder.write_gzipped("a.gml.gz", xml)).buildings, SizeIs(1));
  EXPECT_THAT(read_citygml(folder.write_gzipped("a.xml", xml)).buildings, SizeIs(1));
  EXPECT_THAT(read_citygml(folder.write("b.gml.gz", xml)).buildings, SizeIs(1));
}

}  // namespace
}  // namespace blockrand::importers::reference::test
