// Ground surfaces as plane polygons, from the best source that a building has.
#include "importers/reference/footprints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/base/error.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using testing::SizeIs;

constexpr double kEast = 390000, kNorth = 5820000;

/// A rectangle in the plane at height z, clockwise from above where it looks down.
std::string flat(double x0, double y0, double x1, double y1, double z, bool up = false) {
  const auto at = [&](double x, double y) {
    return std::to_string(kEast + x) + " " + std::to_string(kNorth + y) + " " + std::to_string(z);
  };
  return up ? at(x0, y0) + " " + at(x1, y0) + " " + at(x1, y1) + " " + at(x0, y1)
            : at(x0, y0) + " " + at(x0, y1) + " " + at(x1, y1) + " " + at(x1, y0);
}

/// A wall from (x0, y0) to (x1, y1).
std::string upright(double x0, double y0, double x1, double y1, double z0, double z1) {
  const auto at = [&](double x, double y, double z) {
    return std::to_string(kEast + x) + " " + std::to_string(kNorth + y) + " " + std::to_string(z);
  };
  return at(x0, y0, z0) + " " + at(x1, y1, z0) + " " + at(x1, y1, z1) + " " + at(x0, y0, z1);
}

std::string own(const std::string& property, const std::string& faces) {
  return "<bldg:" + property + "><gml:MultiSurface><gml:surfaceMember>" + faces +
         "</gml:surfaceMember></gml:MultiSurface></bldg:" + property + ">";
}

/// Faces of a box from z0 to z1.
std::string box(double x0, double y0, double x1, double y1, double z0, double z1, bool with_floor = true) {
  return (with_floor ? polygon(flat(x0, y0, x1, y1, z0)) : "") + polygon(flat(x0, y0, x1, y1, z1, true)) +
         polygon(upright(x0, y0, x1, y0, z0, z1)) + polygon(upright(x1, y0, x1, y1, z0, z1)) +
         polygon(upright(x1, y1, x0, y1, z0, z1)) + polygon(upright(x0, y1, x0, y0, z0, z1));
}

Footprint2D only(const std::string& inside) {
  const auto footprints = ground_footprints(read(document(building("b", inside))));
  EXPECT_THAT(footprints, SizeIs(1));
  return footprints.at(0);
}

TEST(Footprints, GroundSurfacesThatMeetBecomeOne) {
  const auto f = only(surface("GroundSurface", polygon(flat(0, 0, 10, 8, 30)) + polygon(flat(10, 0, 15, 8, 30.5))) +
                      surface("RoofSurface", polygon(flat(-1, -1, 16, 9, 36, true))));
  EXPECT_EQ(f.source, FootprintSource::ground_surface);
  ASSERT_THAT(f.polygons, SizeIs(1));
  EXPECT_DOUBLE_EQ(f.area, 120);
  EXPECT_EQ(f.ground_height, 30);
  EXPECT_TRUE(geometry::strictly_simple(f.polygons[0]));
  EXPECT_GT(geometry::signed_area(f.polygons[0].outer.points), 0);
}

TEST(Footprints, CourtyardsStayOpen) {
  const auto f = only(surface("GroundSurface", polygon(flat(0, 0, 30, 30, 30), "", flat(10, 10, 20, 20, 30, true))));
  ASSERT_THAT(f.polygons, SizeIs(1));
  ASSERT_THAT(f.polygons[0].holes, SizeIs(1));
  EXPECT_DOUBLE_EQ(f.area, 800);
}

TEST(Footprints, SlitsOfAMillimetreBetweenPiecesClose) {
  // Pieces whose common wall was computed twice.
  const auto f = only(surface("GroundSurface", polygon(flat(0, 0, 10, 8, 30)) + polygon(flat(9.9996, 2, 15, 6, 30)) +
                                                   polygon(flat(4, 7.99999, 6, 12, 30))));
  EXPECT_THAT(f.polygons, SizeIs(1));
  EXPECT_NEAR(f.area, 80 + 20 + 8, 0.05);
  EXPECT_TRUE(f.polygons[0].holes.empty());
}

TEST(Footprints, TheHighestLevelOfGroundCounts) {
  std::string two = surface("GroundSurface", polygon(flat(0, 0, 10, 10, 30)));
  std::string three = surface("GroundSurface", polygon(flat(0, 0, 10, 8, 30)));
  for (std::size_t at = 0; (at = three.find("lod2", at)) != std::string::npos;) three[at + 3] = '3';
  EXPECT_DOUBLE_EQ(only(two + three).area, 80);
  EXPECT_DOUBLE_EQ(only(three + two).area, 80);
}

TEST(Footprints, PartsAreUnitedWithTheirBuilding) {
  const auto part = [](const std::string& id, const std::string& inside) {
    return "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"" + id + "\">" + inside +
           "</bldg:BuildingPart></bldg:consistsOfBuildingPart>";
  };
  const auto m = read(document(building("a", part("p", surface("GroundSurface", polygon(flat(0, 0, 10, 10, 30)))) +
                                                 part("q", own("lod2MultiSurface", box(10, 0, 20, 10, 29, 40)))) +
                               building("b", surface("GroundSurface", polygon(flat(50, 0, 60, 10, 31))))));
  const auto footprints = ground_footprints(m);
  ASSERT_THAT(footprints, SizeIs(2));
  EXPECT_EQ(footprints[0].building, 0u);
  EXPECT_DOUBLE_EQ(footprints[0].area, 200);
  EXPECT_THAT(footprints[0].polygons, SizeIs(1));
  EXPECT_EQ(footprints[0].source, FootprintSource::lowest_horizontal);  // the weaker of the two
  EXPECT_EQ(footprints[0].ground_height, 29);
  EXPECT_EQ(m.buildings[footprints[1].building].id, "b");
  EXPECT_DOUBLE_EQ(footprints[1].area, 100);
}

TEST(Footprints, WithoutSemanticsTheLowestFloorCounts) {
  // A tower on a plinth with a passage: its ceiling at 34 m is no ground, the step of 0.3 m is.
  const auto f = only(
      own("lod2MultiSurface", box(0, 0, 10, 10, 30, 50) + box(10, 0, 20, 10, 30.3, 40) + box(20, 0, 25, 10, 34, 40)));
  EXPECT_EQ(f.source, FootprintSource::lowest_horizontal);
  EXPECT_DOUBLE_EQ(f.area, 200);
}

TEST(Footprints, FootprintsAndRoofEdgesOfLevel0) {
  const std::string footprint = own("lod0FootPrint", polygon(flat(0, 0, 10, 8, 30))),
                    edge = own("lod0RoofEdge", polygon(flat(-1, -1, 11, 9, 36)));
  EXPECT_EQ(only(edge + footprint).source, FootprintSource::footprint);
  EXPECT_DOUBLE_EQ(only(edge + footprint).area, 80);
  EXPECT_EQ(only(edge).source, FootprintSource::roof_edge);
  EXPECT_DOUBLE_EQ(only(edge).area, 120);
  EXPECT_EQ(only(edge + own("lod1MultiSurface", box(0, 0, 9, 8, 30, 36))).source, FootprintSource::lowest_horizontal);
}

TEST(Footprints, WithoutAFloorThePlanCounts) {
  const auto f = only(own("lod2MultiSurface", box(0, 0, 10, 10, 30, 36, false)));
  EXPECT_EQ(f.source, FootprintSource::plan);
  EXPECT_DOUBLE_EQ(f.area, 100);
}

TEST(Footprints, InteriorsAndInstallationsDoNotCount) {
  const std::string inside =
      "<bldg:interiorRoom><bldg:Room>" + surface("GroundSurface", polygon(flat(0, 0, 90, 90, 20))) +
      "</bldg:Room></bldg:interiorRoom><bldg:outerBuildingInstallation><bldg:BuildingInstallation>" +
      own("lod2Geometry", polygon(flat(0, 0, 50, 50, 10))) +
      "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>";
  EXPECT_DOUBLE_EQ(only(inside + surface("GroundSurface", polygon(flat(0, 0, 10, 8, 30)))).area, 80);
  EXPECT_EQ(only(inside).source, FootprintSource::none);
  EXPECT_TRUE(only(inside).polygons.empty());
}

TEST(Footprints, RingsThatCrossThemselvesAreMended) {
  const auto at = [](double x, double y) {
    return std::to_string(kEast + x) + " " + std::to_string(kNorth + y) + " 30";
  };
  const auto f =
      only(surface("GroundSurface", polygon(at(0, 0) + " " + at(10, 10) + " " + at(10, 0) + " " + at(0, 10))));
  EXPECT_NEAR(f.area, 50, 0.1);
  for (const auto& p : f.polygons) EXPECT_TRUE(geometry::strictly_simple(p));
}

TEST(Footprints, DoNotDependOnTheOrderOfPolygons) {
  std::vector<std::string> pieces;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 4; ++j)
      if ((i * 7 + j * 3) % 5 != 0) pieces.push_back(polygon(flat(i * 3.3, j * 2.7, i * 3.3 + 3.3, j * 2.7 + 2.7, 30)));
  const auto united = [&] {
    std::string all;
    for (const auto& p : pieces) all += p;
    return only(surface("GroundSurface", all));
  };
  const auto first = united();
  std::reverse(pieces.begin(), pieces.end());
  const auto second = united();
  EXPECT_NEAR(first.area, second.area, 1e-9);
  EXPECT_EQ(first.polygons.size(), second.polygons.size());
  EXPECT_GT(first.area, 100);
}

TEST(Footprints, NeedMetres) {
  const auto m =
      read(document(building("b", surface("GroundSurface", polygon("48.75 11.5 30 48.76 11.5 30 48.76 11.6 30"))),
                    "urn:ogc:def:crs:EPSG::4326"));
  EXPECT_THROW(ground_footprints(m), base::UsageError);
}

TEST(Unite, OverlapsTouchesAndHoles) {
  const auto square = [](double x, double y, double size) {
    model::Polygon p;
    p.outer.points = {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
    p.outer.nodes.assign(4, 0);
    return p;
  };
  EXPECT_TRUE(geometry::unite({}, 0.01, 0.02).polygons.empty());
  const std::vector<model::Polygon> overlapping{square(0, 0, 10), square(5, 5, 10), square(100, 0, 3)};
  const auto united = geometry::unite(overlapping, 0.01, 0.02);
  ASSERT_THAT(united.polygons, SizeIs(2));
  EXPECT_DOUBLE_EQ(geometry::area(united.polygons[0]), 175);
  EXPECT_DOUBLE_EQ(geometry::area(united.polygons[1]), 9);
  const std::vector<model::Polygon> corner{square(0, 0, 10), square(10, 10, 10)};  // one point in common
  const auto touching = geometry::unite(corner, 0.01, 0.02);
  double area = 0;
  for (const auto& p : touching.polygons) {
    EXPECT_TRUE(geometry::strictly_simple(p));
    area += geometry::area(p);
  }
  EXPECT_NEAR(area, 200, 0.01);
  EXPECT_DOUBLE_EQ(geometry::unite(overlapping, 10, 0.02).dropped_area, 9);
}

}  // namespace
}  // namespace blockrand::importers::reference::test
