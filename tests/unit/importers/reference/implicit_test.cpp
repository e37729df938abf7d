// Implicit geometry of CityGML: a template, a matrix, a point; wherever in the file the template stands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/importers/reference/level_of_detail.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using model::Point3;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

const std::string kGround = "390000 5820000 30 390000 5820008 30 390010 5820008 30 390010 5820000 30";
const std::string kTurn = "0 -1 0 0 1 0 0 0 0 0 2 0.5 0 0 0 1";  // a quarter turn to the left, twice as high, lifted

std::string use(std::string_view geometry, std::string_view point = "390000 5820000 30",
                std::string_view matrix = kTurn) {
  std::string out = "<bldg:lod3ImplicitRepresentation><ImplicitGeometry><mimeType>text/xml</mimeType>";
  if (!matrix.empty()) out += "<transformationMatrix>" + std::string(matrix) + "</transformationMatrix>";
  out += geometry;
  if (!point.empty())
    out += "<referencePoint><gml:Point><gml:pos>" + std::string(point) + "</gml:pos></gml:Point></referencePoint>";
  return out + "</ImplicitGeometry></bldg:lod3ImplicitRepresentation>";
}

std::string drawn(std::string_view id) {
  return "<relativeGMLGeometry><gml:MultiSurface gml:id=\"" + std::string(id) + "\"><gml:surfaceMember>" +
         polygon("0 0 0 2 0 0 2 0 1", "p_" + std::string(id)) +
         "</gml:surfaceMember></gml:MultiSurface></relativeGMLGeometry>";
}

std::string linked(std::string_view id) { return "<relativeGMLGeometry xlink:href=\"#" + std::string(id) + "\"/>"; }

std::string chimney(std::string_view representation) {
  return "<bldg:outerBuildingInstallation><bldg:BuildingInstallation>" + std::string(representation) +
         "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>";
}

const std::string kSurface = surface("GroundSurface", polygon(kGround));

/// Points of the only face of a geometry.
std::vector<Point3> points(const ReferenceModel& m, const std::vector<Geometry>& geometries) {
  if (geometries.size() != 1 || geometries[0].faces.size() != 1) return {};
  return m.polygons[geometries[0].faces[0].polygon].outer;
}

TEST(ImplicitGeometry, IsTurnedThenPlaced) {
  const auto m = read(document(building("b", chimney(use(drawn("t"))) + kSurface)));
  ASSERT_THAT(m.buildings[0].surfaces, SizeIs(2));
  const Surface& s = m.buildings[0].surfaces[0];
  EXPECT_EQ(s.surface_class, SurfaceClass::installation);
  ASSERT_THAT(s.geometries, SizeIs(1));
  EXPECT_EQ(s.geometries[0].lod, 3);
  EXPECT_THAT(points(m, s.geometries),
              ElementsAre(Point3{390000, 5820000, 30.5}, Point3{390000, 5820002, 30.5}, Point3{390000, 5820002, 32.5}));
  EXPECT_EQ(m.buildings[0].implicit_geometries, 0u);
  EXPECT_EQ(m.breaches(), 0u);
  EXPECT_THAT(m.polygons, SizeIs(2)) << "the template itself lies nowhere";
}

TEST(ImplicitGeometry, MirroredIsNotInsideOut) {
  const std::string mirror = "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", half_turn = "-1 0 0 0 0 -1 0 0 0 0 1 0 0 0 0 1";
  const auto reversed = [](const std::string& matrix) {
    const auto m = read(document(building("b", chimney(use(drawn("t"), "390000 5820000 30", matrix)) + kSurface)));
    return m.buildings.at(0).surfaces.at(0).geometries.at(0).faces.at(0).reversed;
  };
  EXPECT_TRUE(reversed(mirror));
  EXPECT_FALSE(reversed(half_turn));
  EXPECT_FALSE(reversed(""));
}

TEST(ImplicitGeometry, WithoutMatrixIsOnlyMoved) {
  const auto m = read(document(building("b", chimney(use(drawn("t"), "390000 5820000 30", "")) + kSurface)));
  EXPECT_THAT(points(m, m.buildings[0].surfaces[0].geometries),
              ElementsAre(Point3{390000, 5820000, 30}, Point3{390002, 5820000, 30}, Point3{390002, 5820000, 31}));
}

TEST(ImplicitGeometry, LinksToTheTemplateOfAnotherBuildingBeforeOrBehindIt) {
  const auto m = read(document(building("a", chimney(use(linked("t"), "390005 5820000 30")) + kSurface) +
                               building("b", chimney(use(drawn("t"))) + kSurface) +
                               building("c", chimney(use(linked("t"), "390007 5820000 30")) + kSurface)));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto ring = points(m, m.buildings[i].surfaces[0].geometries);
    ASSERT_THAT(ring, SizeIs(3)) << i;
    EXPECT_EQ(ring[0].x, 390000 + (i == 0 ? 5 : i == 1 ? 0 : 7));
  }
  EXPECT_EQ(m.count(NoteKind::unresolved_link), 0u);
}

TEST(ImplicitGeometry, LinksToTheTemplateOfAnObjectThatIsNotRead) {
  const std::string lamp =
      "<cityObjectMember><CityFurniture xmlns=\"http://www.opengis.net/citygml/cityfurniture/2.0\"><lod1Geometry>" +
      polygon("7 7 7 8 7 7 8 8 7") + "</lod1Geometry>" + use(drawn("lamp")) + "</CityFurniture></cityObjectMember>";
  const auto m = read(document(lamp + building("b", chimney(use(linked("lamp"))) + kSurface)));
  EXPECT_THAT(points(m, m.buildings[0].surfaces[0].geometries), SizeIs(3));
  EXPECT_THAT(m.polygons, SizeIs(2)) << "nothing else of the lamp";
  EXPECT_THAT(m.buildings, SizeIs(1));
}

TEST(ImplicitGeometry, OfAWindow) {
  const auto m =
      read(document(building("b", "<bldg:boundedBy><bldg:WallSurface><bldg:opening><bldg:Window>" + use(drawn("t")) +
                                      "</bldg:Window></bldg:opening></bldg:WallSurface></bldg:boundedBy>" + kSurface)));
  ASSERT_THAT(m.buildings[0].surfaces[0].openings, SizeIs(1));
  EXPECT_THAT(points(m, m.buildings[0].surfaces[0].openings[0].geometries), SizeIs(3));
  EXPECT_EQ(lod_of(m.buildings[0]), 3);
}

TEST(ImplicitGeometry, OfFurnitureIsLeftOutButItsTemplateIsKnown) {
  const auto m = read(document(building(
      "b", chimney(use(linked("t"))) +
               "<bldg:interiorRoom><bldg:Room><bldg:interiorFurniture><bldg:BuildingFurniture>" + use(drawn("t")) +
               "</bldg:BuildingFurniture></bldg:interiorFurniture></bldg:Room></bldg:interiorRoom>" + kSurface)));
  EXPECT_THAT(points(m, m.buildings[0].surfaces[0].geometries), SizeIs(3));
  for (const Surface& s : m.buildings[0].surfaces) {
    EXPECT_TRUE(s.surface_class != SurfaceClass::furniture || s.geometries.empty());
  }
  EXPECT_EQ(m.buildings[0].implicit_geometries, 0u);
}

TEST(ImplicitGeometry, ThatCannotBeReadIsCounted) {
  const std::string other_file = "<libraryObject>door.vrml</libraryObject>";
  const auto m = read(document(building(
      "b", chimney(use(other_file)) + chimney(use(linked("nothing"))) + chimney(use(drawn("t1"), "")) +
               chimney(use(drawn("t2"), "1 2 3", "1 0 0 0")) + chimney(use(drawn("t3"), "x y z")) + kSurface)));
  EXPECT_EQ(m.buildings[0].implicit_geometries, 5u);
  EXPECT_EQ(m.count(NoteKind::not_read), 2u);
  EXPECT_EQ(m.count(NoteKind::unresolved_link), 1u);
  EXPECT_EQ(m.count(NoteKind::bad_value), 3u);
  EXPECT_THAT(m.polygons, SizeIs(1));
  EXPECT_THAT(m.notes[0].examples[0], HasSubstr("door.vrml"));
}

TEST(ImplicitGeometry, InACircleIsNoted) {
  const std::string circle =
      "<relativeGMLGeometry><gml:MultiSurface gml:id=\"t\"><gml:surfaceMember xlink:href=\"#t\"/></gml:MultiSurface>"
      "</relativeGMLGeometry>";
  const auto m = read(document(building("b", chimney(use(circle)) + kSurface)));
  EXPECT_EQ(m.buildings[0].implicit_geometries, 1u);
  EXPECT_GT(m.count(NoteKind::unresolved_link), 0u);
}

TEST(ImplicitGeometry, CutOffLeavesNothingBehind) {
  const std::string whole = document(building("a", kSurface) + building("b", chimney(use(drawn("t"))) + kSurface));
  const auto m = read(whole.substr(0, whole.find("gml:surfaceMember></gml:MultiSurface></relative")));
  EXPECT_THAT(m.buildings, SizeIs(1));
  for (const Polygon3& p : m.polygons)
    for (const Point3& q : p.outer) EXPECT_GT(q.x, 1000);
}

}  // namespace
}  // namespace blockrand::importers::reference::test
