#include "pipeline/context/wall_segments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>

#include "tests/unit/context/small_town.h"

namespace blockrand::context {
namespace {

using model::Point2;
using model::WallSegment;
using model::WallSegmentKind;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

double length_of(const model::Building& b, WallSegmentKind kind) {
  double sum = 0;
  for (const WallSegment& f : b.edges)
    if (f.kind == kind) sum += f.length();
  return sum;
}

/// Every edge of the outline is covered once, without gaps.
void expect_complete(const model::Building& b) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, double> reached;
  double sum = 0;
  for (const WallSegment& f : b.edges) {
    double& at = reached[{f.polygon, f.ring, f.edge}];
    EXPECT_EQ(at, f.start);
    EXPECT_GT(f.end, f.start);
    at = f.end;
    sum += f.length();
    EXPECT_NE(f.kind, WallSegmentKind::unknown);
    EXPECT_GT(f.confidence, 0.5F);
    EXPECT_LE(f.confidence, 1.0F);
  }
  double perimeter = 0;
  const auto add = [&](const model::Ring& r) {
    for (std::size_t i = 0; i < r.size(); ++i)
      perimeter +=
          std::hypot(r.points[(i + 1) % r.size()].x - r.points[i].x, r.points[(i + 1) % r.size()].y - r.points[i].y);
  };
  for (const model::Polygon& p : b.outline) {
    add(p.outer);
    for (const model::Ring& h : p.holes) add(h);
  }
  EXPECT_NEAR(sum, perimeter, 1e-6);
}

TEST(WallSegments, HouseOfARowHasStreetCourtyardAndTwoNeighbours) {
  SmallTown t = perimeter_block();
  t.label();
  for (const model::Building& b : t.buildings) expect_complete(b);
  const model::Building& house = t[12];
  ASSERT_EQ(house.edges.size(), 4u);
  EXPECT_EQ(t.kind(12, 44, 10), WallSegmentKind::street);
  EXPECT_EQ(t.kind(12, 44, 22), WallSegmentKind::courtyard);
  EXPECT_EQ(t.edge(12, 38, 16).neighbour.number, 11);
  EXPECT_EQ(t.edge(12, 50, 16).neighbour.number, 13);
  const WallSegment& front = t.edge(12, 44, 10);
  EXPECT_EQ(front.street.number, 901);
  EXPECT_EQ(front.street_name, "South Street");
  EXPECT_EQ(front.street_class, "residential");
  EXPECT_NEAR(front.street_distance, 10, 0.01);
  EXPECT_NEAR(front.street_angle, 0, 0.01);
  EXPECT_GT(front.visibility, 0.95F);
  EXPECT_EQ(t.edge(12, 44, 22).visibility, 0.0F);
}

TEST(WallSegments, PartyWallEndsWhereTheNeighbourEnds) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 10, 12, 26);
  t.box(2, 12.2, 10.1, 24, 20);  // 0.2 m off, and 6 m shallower
  t.label();
  EXPECT_EQ(t.edge(1, 12, 12).neighbour.number, 2);
  EXPECT_NEAR(length_of(t[1], WallSegmentKind::party_wall), 10, 0.01) << "0.1 m at the front is no piece of its own";
  EXPECT_EQ(t.kind(1, 12, 24), WallSegmentKind::side);
  EXPECT_NEAR(length_of(t[2], WallSegmentKind::party_wall), 9.9, 0.01);
}

TEST(WallSegments, AlleyOfLessThanAMetreIsNoPartyWall) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 10, 12, 22);
  t.box(2, 12.6, 10, 24, 22);
  t.label();
  EXPECT_EQ(t.kind(1, 12, 16), WallSegmentKind::side);
  EXPECT_EQ(t.kind(2, 12.6, 16), WallSegmentKind::side);
}

TEST(WallSegments, OverlapIsAPartyWallOfTheOneThatSticksIn) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 10, 14, 22);
  t.box(2, 12, 10, 24, 22);
  t.label();
  EXPECT_EQ(t.kind(1, 14, 16), WallSegmentKind::party_wall);
  EXPECT_EQ(t.edge(1, 14, 16).neighbour.number, 2);
}

TEST(WallSegments, CornerHouseFacesBothStreetsAndHasItsCornerFlagged) {
  SmallTown t = perimeter_block();
  t.label();
  const WallSegment &south = t.edge(1, 18, 10), &west = t.edge(1, 10, 18);
  EXPECT_EQ(south.street_name, "South Street");
  EXPECT_EQ(west.street_name, "West Street");
  EXPECT_TRUE(west.corner_end);  // counter-clockwise: west front runs south to the corner
  EXPECT_TRUE(south.corner_start);
  EXPECT_FALSE(south.corner_end);
  EXPECT_FALSE(west.corner_start);
  for (const WallSegment& f : t[12].edges) EXPECT_FALSE(f.corner_start || f.corner_end || f.chamfer);
}

TEST(WallSegments, ChamferCutsOffTheStreetCorner) {
  SmallTown t = perimeter_block();
  for (std::size_t i = 0; i < t.buildings.size(); ++i)
    if (t.buildings[i].osm.number == 1) {
      t.buildings.erase(t.buildings.begin() + static_cast<std::ptrdiff_t>(i));
      t.footprints.erase(t.footprints.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
  t.house(1, {{14, 10}, {26, 10}, {26, 22}, {22, 22}, {22, 26}, {10, 26}, {10, 14}});
  t.label();
  const WallSegment& chamfer = t.edge(1, 12, 12);
  EXPECT_EQ(chamfer.kind, WallSegmentKind::street);
  EXPECT_TRUE(chamfer.chamfer);
  EXPECT_TRUE(t.edge(1, 20, 10).corner_start);
  EXPECT_TRUE(t.edge(1, 10, 20).corner_end);
  EXPECT_FALSE(t.edge(1, 20, 10).chamfer);
}

TEST(WallSegments, VillaHasAFrontAndThreeSides) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 15, 12, 25);
  t.box(2, 40, 15, 52, 25);
  t.label();
  EXPECT_EQ(t.kind(1, 6, 15), WallSegmentKind::street);
  EXPECT_EQ(t.kind(1, 0, 20), WallSegmentKind::side);
  EXPECT_EQ(t.kind(1, 12, 20), WallSegmentKind::side);
  EXPECT_EQ(t.kind(1, 6, 25), WallSegmentKind::side);
  // The gable looks out on the street aslant: it has one, but no front.
  EXPECT_EQ(t.edge(1, 12, 20).street.number, 901);
  EXPECT_NEAR(t.edge(1, 12, 20).street_angle, 90, 0.01);
  EXPECT_LT(t.edge(1, 12, 20).visibility, 0.5F);
}

TEST(WallSegments, RearBuildingSeesOnlyTheCourtyard) {
  SmallTown t = perimeter_block();
  t.box(51, 38, 36, 62, 46);
  t.label();
  EXPECT_EQ(length_of(t[51], WallSegmentKind::courtyard), 68);
}

TEST(WallSegments, MouthOfAPassageIsCutOutOfTheFront) {
  SmallTown t = perimeter_block();
  t.passage(801, {{44, 10}, {44, 22}}, kServicePassageWidth);
  t.label();
  EXPECT_NEAR(length_of(t[12], WallSegmentKind::passage), 7, 0.01);
  EXPECT_EQ(t.kind(12, 44, 10), WallSegmentKind::passage);
  EXPECT_EQ(t.kind(12, 44, 22), WallSegmentKind::passage);
  EXPECT_EQ(t.kind(12, 40, 10), WallSegmentKind::street);
  EXPECT_EQ(t.kind(12, 40, 22), WallSegmentKind::courtyard);
  EXPECT_EQ(t.edge(12, 44, 10).street.number, 901);
  std::vector<double> cuts;
  for (const WallSegment& f : t[12].edges)
    if (f.edge == 0) cuts.push_back(f.end);
  EXPECT_THAT(cuts, ElementsAre(DoubleNear(4.25, 0.01), DoubleNear(7.75, 0.01), DoubleNear(12, 0.01)));
}

TEST(WallSegments, PassageAlongAPartyWallLeavesItOne) {
  SmallTown t = perimeter_block();
  t.passage(801, {{50, 10}, {50, 22}}, kFootPassageWidth);
  t.label();
  EXPECT_EQ(t.kind(12, 50, 16), WallSegmentKind::party_wall);
  EXPECT_NEAR(t.edge(12, 50, 10.0).length(), 1.25, 0.01);
  EXPECT_EQ(t.kind(12, 49.5, 10), WallSegmentKind::passage);
  EXPECT_EQ(t.kind(13, 50.5, 10), WallSegmentKind::passage);
}

TEST(WallSegments, ArcadeIsOpenToTheCornerOfItsFront) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 8, 30, 22);
  t.passage(801, {{-5, 10.5}, {35, 10.5}}, 2);
  t.label();
  EXPECT_EQ(t.kind(1, 0, 8.5), WallSegmentKind::passage);
  EXPECT_EQ(t.kind(1, 30, 8.5), WallSegmentKind::passage);
  EXPECT_EQ(t.kind(1, 0, 13), WallSegmentKind::side);
  EXPECT_EQ(t.kind(1, 15, 8), WallSegmentKind::street);
}

TEST(WallSegments, WallsOfALightWellFaceACourtyard) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.house(1, {{0, 10}, {20, 10}, {20, 30}, {0, 30}}, {{{8, 18}, {12, 18}, {12, 22}, {8, 22}}});
  t.label();
  EXPECT_EQ(t.kind(1, 10, 18), WallSegmentKind::courtyard);
  EXPECT_EQ(t.kind(1, 12, 20), WallSegmentKind::courtyard);
  EXPECT_EQ(length_of(t[1], WallSegmentKind::courtyard), 16);
}

TEST(WallSegments, NobodyIsItsOwnNeighbour) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  // Rays begin 0.02 m before a wall: in this recess, within the building.
  t.house(1, {{0, 10}, {20, 10}, {20, 30}, {10.005, 30}, {10.005, 20}, {9.995, 20}, {9.995, 30}, {0, 30}});
  t.label();
  expect_complete(t[1]);
  EXPECT_EQ(length_of(t[1], WallSegmentKind::party_wall), 0);
}

TEST(WallSegments, CourtOfAUIsACourtyardAndAnLHasNone) {
  SmallTown u;
  u.street(901, {{-80, 0}, {120, 0}}, "Street");
  u.house(1, {{0, 10}, {40, 10}, {40, 50}, {28, 50}, {28, 22}, {12, 22}, {12, 50}, {0, 50}});
  u.box(2, -5, 60, 45, 70);  // closes the view out of the court but for two gaps
  u.label();
  EXPECT_EQ(u.kind(1, 20, 22), WallSegmentKind::courtyard);
  EXPECT_EQ(u.kind(1, 12, 30), WallSegmentKind::courtyard);
  EXPECT_EQ(u.kind(1, 28, 30), WallSegmentKind::courtyard);
  EXPECT_EQ(u.kind(1, 0, 30), WallSegmentKind::side);
  EXPECT_EQ(u.kind(1, 20, 10), WallSegmentKind::street);

  SmallTown l;
  l.street(901, {{-80, 0}, {120, 0}}, "Street");
  l.house(1, {{0, 10}, {40, 10}, {40, 22}, {12, 22}, {12, 60}, {0, 60}});
  l.label();
  EXPECT_EQ(l.kind(1, 35, 22), WallSegmentKind::side);
  EXPECT_EQ(l.kind(1, 12, 55), WallSegmentKind::side);
}

TEST(WallSegments, SquareInFrontIsStreetSpace) {
  SmallTown t;
  t.street(901, {{0, 0}, {60, 0}, {60, 60}, {0, 60}, {0, 0}}, "Market", LineClass::pedestrian).area = true;
  t.box(1, 20, 60, 32, 72);  // its front lies on the outline of the square
  t.box(2, 62, 20, 74, 32);  // 2 m beside it
  t.label();
  EXPECT_EQ(t.kind(1, 26, 60), WallSegmentKind::street);
  EXPECT_EQ(t.edge(1, 26, 60).street_name, "Market");
  EXPECT_EQ(t.edge(1, 26, 60).street_class, "pedestrian");
  EXPECT_EQ(t.kind(2, 62, 26), WallSegmentKind::street);
  EXPECT_EQ(t.kind(1, 26, 72), WallSegmentKind::side);
}

TEST(WallSegments, WallThatClosesADeadEndFacesTheStreet) {
  SmallTown t;
  t.street(901, {{0, -100}, {0, 0}}, "Close");
  t.box(1, -10, 12, 10, 24);
  t.label();
  EXPECT_EQ(t.kind(1, 0, 12), WallSegmentKind::street);
  EXPECT_EQ(t.edge(1, 0, 12).street_name, "Close");
  EXPECT_EQ(t.kind(1, 0, 24), WallSegmentKind::side);

  t.street(902, {{0, 0}, {0, 8}}, "Close");  // goes on towards the wall: still street space
  t.label();
  EXPECT_EQ(t.kind(1, 0, 12), WallSegmentKind::street);
}

TEST(WallSegments, CanopyIsNoNeighbourButHasOne) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 10, 20, 22);
  t.house(2, {{0, 22}, {20, 22}, {20, 28}, {0, 28}}, {}, true);
  t.house(3, {{0, 4}, {20, 4}, {20, 10}, {0, 10}}, {}, true);
  t.label();
  EXPECT_EQ(t.kind(1, 10, 22), WallSegmentKind::side);
  EXPECT_EQ(t.kind(1, 10, 10), WallSegmentKind::street) << "streets are seen past canopies";
  EXPECT_EQ(t.kind(2, 10, 22), WallSegmentKind::party_wall);
  EXPECT_EQ(t.edge(2, 10, 22).neighbour.number, 1);
}

TEST(WallSegments, StreetIsSeenThroughARowOfTrees) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 14, 20, 26);
  for (int i = 0; i < 10; ++i) t.point(700 + i, SitePointKind::tree, 1 + 2 * i, 9);
  t.label();
  EXPECT_EQ(t.kind(1, 10, 14), WallSegmentKind::street);
  EXPECT_GT(t.edge(1, 10, 14).visibility, 0.95F);
}

TEST(WallSegments, StreetBehindAHouseIsNotFaced) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.box(1, 0, 30, 12, 40);
  t.box(2, -20, 8, 32, 18);
  t.label();
  EXPECT_NE(t.kind(1, 6, 30), WallSegmentKind::street);
  EXPECT_EQ(t.kind(2, 6, 8), WallSegmentKind::street);
}

TEST(WallSegments, RearTowardsAFartherStreetIsAGarden) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Near");
  t.street(902, {{-80, 44}, {80, 44}}, "Far");
  t.box(1, 0, 8, 12, 20);
  t.label();
  EXPECT_EQ(t.kind(1, 6, 8), WallSegmentKind::street);
  EXPECT_EQ(t.kind(1, 6, 20), WallSegmentKind::side);
  EXPECT_EQ(t.edge(1, 6, 20).street_name, "Far");
}

TEST(WallSegments, ShortStepOfAStreetFrontGoesWithIt) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.house(1, {{0, 10}, {10, 10}, {10, 12}, {20, 12}, {20, 24}, {0, 24}});
  t.house(2, {{40, 10}, {50, 10}, {50, 18}, {60, 18}, {60, 30}, {40, 30}});
  t.label();
  EXPECT_EQ(t.kind(1, 10, 11), WallSegmentKind::street);
  EXPECT_EQ(t.kind(2, 50, 14), WallSegmentKind::side) << "a flank of 8 m is no step";
}

TEST(WallSegments, SteepWallIsAFlankOfTheStreetItSees) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  // A gable 60 degrees to the street, 15 m before it.
  t.house(1, {{0, 12}, {6, 22.392}, {-6, 40}, {-30, 40}, {-30, 12}});
  t.label();
  EXPECT_EQ(t.kind(1, 3, 17.2), WallSegmentKind::side);
  EXPECT_EQ(t.kind(1, -15, 12), WallSegmentKind::street);
}

TEST(WallSegments, ShortPiecesAreNotMade) {
  SmallTown t = perimeter_block();
  t.passage(801, {{26.2, 10}, {26.2, 22}}, kServicePassageWidth);
  t.label();
  for (const model::Building& b : t.buildings)
    for (const WallSegment& f : b.edges) EXPECT_GE(f.length(), WallSegmentOptions{}.min_wall_segment);
}

TEST(WallSegments, EntrancesAndTreesGoToTheNearestWall) {
  SmallTown t = perimeter_block();
  t.point(700, SitePointKind::entrance, 44, 10);
  t.point(701, SitePointKind::entrance, 38, 10);  // between two houses: that of the least id
  t.point(702, SitePointKind::entrance, 44, 21.5);
  t.point(703, SitePointKind::entrance, 44, 16);  // in the middle of the house: nobody's
  t.point(704, SitePointKind::tree, 40, 6);
  t.point(705, SitePointKind::tree, 44, 26);
  t.point(706, SitePointKind::tree, 44, 16);  // within the house
  t.label();
  EXPECT_EQ(t.edge(12, 44, 10).entrances, 1);
  EXPECT_EQ(t.edge(11, 30, 10).entrances, 1);
  EXPECT_EQ(t.edge(12, 44, 22).entrances, 1);
  const model::Building& house = t[12];
  ASSERT_EQ(house.trees.size(), 2u);
  EXPECT_EQ(house.trees[0].id.number, 704);
  EXPECT_EQ(house.edges[house.trees[0].edge].kind, WallSegmentKind::street);
  EXPECT_NEAR(house.trees[0].distance, 4, 0.01);
  EXPECT_EQ(house.trees[1].id.number, 705);
  EXPECT_EQ(house.edges[house.trees[1].edge].kind, WallSegmentKind::courtyard);
}

/// "w12 street South Street" for every stretch that has the point, whichever building's it is.
std::vector<std::string> holders(const SmallTown& t, std::int64_t point) {
  std::vector<std::string> out;
  for (const model::Building& b : t.buildings)
    for (const WallSegment& f : b.edges)
      for (const model::WallPoint& p : f.points)
        if (p.id.number == point) out.push_back(b.id() + " " + std::string(model::name(f.kind)) + " " + f.street_name);
  return out;
}

/// Shops are mapped in the middle of their rooms: they open to the street of their house, or of their address.
TEST(WallPoints, ShopsGoToTheWallAtTheirStreet) {
  SmallTown t = perimeter_block();
  t.point(700, SitePointKind::shop, 44, 19, "", "", "shop");                    // nearer to the yard
  t.point(701, SitePointKind::shop, 44, 21.5, "", "", "craft");                 // at the wall to the yard
  t.point(702, SitePointKind::address, 44, 15, "South Street", "5", "office");  // with an address
  t.point(703, SitePointKind::shop, 44, 8, "", "", "shop");                     // on the pavement: nobody's
  t.point(704, SitePointKind::shop, 16, 13, "West Street", "", "gastronomy");
  t.label();
  EXPECT_THAT(holders(t, 700), ElementsAre("w12 street South Street"));
  EXPECT_THAT(holders(t, 701), ElementsAre("w12 courtyard "));
  EXPECT_THAT(holders(t, 702), ElementsAre("w12 street South Street"));
  EXPECT_THAT(holders(t, 703), IsEmpty());
  EXPECT_THAT(holders(t, 704), ElementsAre("w1 street West Street"));
  const std::vector<model::WallPoint>& points = t.edge(12, 44, 10).points;
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].use, "shop");
  EXPECT_EQ(points[1].use, "office");
  EXPECT_EQ(t.edge(12, 44, 10).entrances, 0);
}

TEST(WallPoints, AddressesInAHouseGoToTheWallAtTheirStreet) {
  SmallTown t = perimeter_block();
  t.point(700, SitePointKind::address, 44, 16, "South Street", "5");     // in the middle
  t.point(701, SitePointKind::address, 44, 18, "", "5a");                // no street told, nearer to the yard
  t.point(702, SitePointKind::address, 44, 21.5, "South Street", "5b");  // at the wall to the yard
  t.point(703, SitePointKind::address, 44, 9.4, "South Street", "7");    // before the wall
  t.point(704, SitePointKind::address, 44, 8, "South Street", "9");      // on the pavement: nobody's
  t.point(705, SitePointKind::address, 16, 13, "West Street", "1");  // in a corner house, nearer to the other street
  t.point(706, SitePointKind::address, 16, 14, "South Street", "3");
  t.point(707, SitePointKind::address, 44, 15, "South Street", "");  // no number: no address of a door
  t.label();
  EXPECT_THAT(holders(t, 700), ElementsAre("w12 street South Street"));
  EXPECT_THAT(holders(t, 701), ElementsAre("w12 street South Street"));
  EXPECT_THAT(holders(t, 702), ElementsAre("w12 courtyard "));
  EXPECT_THAT(holders(t, 703), ElementsAre("w12 street South Street"));
  EXPECT_THAT(holders(t, 704), IsEmpty());
  EXPECT_THAT(holders(t, 705), ElementsAre("w1 street West Street"));
  EXPECT_THAT(holders(t, 706), ElementsAre("w1 street South Street"));
  EXPECT_THAT(holders(t, 707), IsEmpty());
  const std::vector<model::WallPoint>& points = t.edge(12, 44, 10).points;
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].house_number, "5");
  EXPECT_EQ(points[0].place, t.at(44, 16));
  EXPECT_FALSE(points[0].entrance);
  EXPECT_EQ(t.edge(12, 44, 10).entrances, 0) << "an address alone is no entrance";
}

TEST(WallPoints, ACornerGoesToTheWallAtTheStreetOfTheAddress) {
  for (const char* street : {"West Street", "South Street"}) {
    SmallTown t = perimeter_block();
    t.point(700, SitePointKind::entrance, 10, 10, street, "1");
    t.label();
    EXPECT_THAT(holders(t, 700), ElementsAre("w1 street " + std::string(street)));
  }
}

TEST(WallPoints, AHouseWithoutAFrontHasItsAddressAtItsNearestWall) {
  SmallTown t = perimeter_block();
  t.box(51, 40, 40, 60, 50);
  t.point(700, SitePointKind::address, 50, 47, "South Street", "5");
  t.label();
  EXPECT_THAT(holders(t, 700), ElementsAre("w51 courtyard "));
  EXPECT_EQ(t.edge(51, 50, 50).points.size(), 1u);
}

TEST(WallPoints, ANodeOfTwoHousesIsThatOfTheAddress) {
  for (const bool twelve : {false, true}) {
    SmallTown t = perimeter_block();
    t.point(700, SitePointKind::entrance, 38, 10, "South Street", "5");
    t.address(11, "South Street", twelve ? "3" : "5");
    t.address(12, "South Street", twelve ? "5;7" : "7");
    t.label();
    EXPECT_THAT(holders(t, 700), ElementsAre(twelve ? "w12 street South Street" : "w11 street South Street"));
    EXPECT_EQ(t.edge(11, 30, 10).entrances + t.edge(12, 44, 10).entrances, 1);
  }
}

TEST(WallPoints, ANodeOfAnOutlineIsThatBuildingsWhereverRepairMovedTheWall) {
  SmallTown t = perimeter_block();
  const std::int64_t node = t[12].outline[0].outer.nodes[1];  // (50, 10), of w12 and w13
  for (model::Building& b : t.buildings)
    if (b.osm.number != 12)
      for (std::int64_t& n : b.outline[0].outer.nodes) n = n == node ? 0 : n;
  for (Footprint& f : t.footprints)
    if (f.id.number != 12)
      for (std::int64_t& n : f.polygon.outer.nodes) n = n == node ? 0 : n;
  t.point(node, SitePointKind::entrance, 50.5, 10.3);  // within w13
  t.label();
  EXPECT_THAT(holders(t, node), ElementsAre("w12 street South Street"));
}

TEST(WallPoints, AHouseWhoseWallsAreAllTakenThereLeavesTheNodeToItsNeighbour) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.house(5, {{0, 10}, {4, 22}, {-4, 22}});  // a wedge between both: its tip alone reaches the front
  t.house(11, {{-12, 10}, {0, 10}, {-4, 22}, {-12, 22}});
  t.house(12, {{0, 10}, {12, 10}, {12, 22}, {4, 22}});
  t.point(700, SitePointKind::entrance, 0, 10);
  t.label();
  EXPECT_THAT(holders(t, 700), ElementsAre("w11 street Street"));
}

TEST(WallPoints, StandInOneWallOfOneHouseInAnyOrder) {
  std::mt19937 random(5);
  const auto draw = [&](double from, double to) { return from + (to - from) * (random() / 4294967296.0); };
  SmallTown t = perimeter_block();
  t.house(61, {{8, 8}, {30, 8}, {30, 30}, {8, 30}}, {}, true);  // a canopy over a corner
  t.box(62, 40, 12, 44, 16);                                    // stands in another house
  for (int i = 0; i < 600; ++i)
    t.point(1000 + i, i % 2 ? SitePointKind::entrance : SitePointKind::address, draw(5, 95), draw(5, 28),
            "South Street", std::to_string(i));
  SmallTown other = t;
  std::shuffle(other.points.begin(), other.points.end(), random);
  std::shuffle(other.buildings.begin(), other.buildings.end(), random);
  t.label();
  other.label();
  int held = 0;
  for (int i = 0; i < 600; ++i) {
    EXPECT_LE(holders(t, 1000 + i).size(), 1u) << i;
    EXPECT_EQ(holders(t, 1000 + i), holders(other, 1000 + i)) << i;
    held += !holders(t, 1000 + i).empty();
  }
  EXPECT_GT(held, 200);
  for (const model::Building& b : t.buildings)
    for (const WallSegment& f : b.edges)
      EXPECT_EQ(f.entrances, std::count_if(f.points.begin(), f.points.end(), [](const auto& p) { return p.entrance; }));
}

TEST(WallSegments, EdgesOfACurveKnowTheirArc) {
  SmallTown t;
  t.street(901, {{-80, 0}, {80, 0}}, "Street");
  t.house(1, {{0, 10}, {20, 10}, {22, 11}, {23, 13}, {23, 24}, {0, 24}});
  model::Arc arc;
  arc.first = 1;
  arc.count = 2;
  t.buildings[0].arcs.push_back(arc);
  t.label();
  for (const WallSegment& f : t[1].edges) EXPECT_EQ(f.arc, f.edge == 1 || f.edge == 2 ? 0 : -1);
}

// ---- what must not matter -------------------------------------------------------------------------------------------

/// Length by kind and position, in the order of buildings.
std::map<std::int64_t, std::array<double, model::kWallSegmentKindCount>> lengths(const SmallTown& t) {
  std::map<std::int64_t, std::array<double, model::kWallSegmentKindCount>> out;
  for (const model::Building& b : t.buildings)
    for (const WallSegment& f : b.edges) out[b.osm.number][static_cast<std::size_t>(f.kind)] += f.length();
  return out;
}

SmallTown mixed_town(double degrees = 0) {
  SmallTown t = perimeter_block(degrees);
  t.box(51, 38, 36, 62, 46);
  t.box(52, 22, 50, 34, 58);
  t.passage(801, {{44, 10}, {44, 22}}, kServicePassageWidth);
  t.box(61, 20, -32, 32, -20);
  t.box(62, 32.2, -32, 44, -20);
  t.house(63, {{60, -14}, {80, -14}, {80, -30}, {70, -30}, {70, -24}, {60, -24}});
  t.point(701, SitePointKind::entrance, 30, 10);
  return t;
}

void expect_same(const SmallTown& a, const SmallTown& b, double tolerance) {
  const auto la = lengths(a), lb = lengths(b);
  ASSERT_EQ(la.size(), lb.size());
  for (const auto& [id, kinds] : la)
    for (std::size_t k = 0; k < kinds.size(); ++k)
      EXPECT_NEAR(kinds[k], lb.at(id)[k], tolerance)
          << "w" << id << " " << model::name(static_cast<WallSegmentKind>(k));
  for (const model::Building& building : a.buildings) {
    const model::BuildingSituation &s = building.situation, &o = b[building.osm.number].situation;
    EXPECT_EQ(s.position, o.position) << building.id();
    EXPECT_EQ(s.fronts.size(), o.fronts.size()) << building.id();
    EXPECT_NEAR(s.depth.value_or(-1), o.depth.value_or(-1), tolerance);
    EXPECT_NEAR(s.width.value_or(-1), o.width.value_or(-1), tolerance);
    EXPECT_NEAR(s.setback.value_or(-1), o.setback.value_or(-1), tolerance);
  }
}

TEST(WallSegments, DoNotDependOnTheOrderOfTheSurroundings) {
  SmallTown a = mixed_town(), b = mixed_town();
  std::reverse(b.buildings.begin(), b.buildings.end());
  std::reverse(b.lines.begin(), b.lines.end());
  std::reverse(b.points.begin(), b.points.end());
  a.label();
  b.label();
  expect_same(a, b, 0);
  for (const model::Building& x : a.buildings) {
    const model::Building& y = b[x.osm.number];
    ASSERT_EQ(x.edges.size(), y.edges.size());
    for (std::size_t i = 0; i < x.edges.size(); ++i) {
      EXPECT_EQ(x.edges[i].start, y.edges[i].start);
      EXPECT_EQ(x.edges[i].street, y.edges[i].street);
      EXPECT_EQ(x.edges[i].visibility, y.edges[i].visibility);
      EXPECT_EQ(x.edges[i].confidence, y.edges[i].confidence);
    }
  }
}

TEST(WallSegments, DoNotDependOnWhereARingStarts) {
  SmallTown a = mixed_town(), b = mixed_town();
  for (std::size_t i = 0; i < b.buildings.size(); ++i)
    for (model::Polygon* p : {&b.buildings[i].outline[0], &b.footprints[i].polygon}) {
      std::rotate(p->outer.points.begin(), p->outer.points.begin() + 2, p->outer.points.end());
      std::rotate(p->outer.nodes.begin(), p->outer.nodes.begin() + 2, p->outer.nodes.end());
    }
  a.label();
  b.label();
  expect_same(a, b, 1e-9);
}

TEST(WallSegments, DoNotDependOnTheDirectionOfNorth) {
  SmallTown a = mixed_town(), b = mixed_town(37);
  a.label();
  b.label();
  expect_same(a, b, 0.3);
  EXPECT_NEAR(*a[12].situation.orientation, 180, 0.1);
  EXPECT_NEAR(*b[12].situation.orientation, 180 - 37, 0.1);
}

TEST(WallSegments, NothingBeyondTheReachMatters) {
  SmallTown a = mixed_town(), b = mixed_town();
  const double far = 110 + kWallSegmentReach;
  b.box(1001, far, 0, far + 30, 40);
  b.box(1002, 40, -60 - kWallSegmentReach, 60, -40 - kWallSegmentReach);
  b.street(991, {{far, -200}, {far, 200}}, "Far Street");
  b.point(1003, SitePointKind::tree, far, 0);
  a.label();
  b.label();
  for (const model::Building& x : a.buildings) {
    const model::Building& y = b[x.osm.number];
    ASSERT_EQ(x.edges.size(), y.edges.size());
    for (std::size_t i = 0; i < x.edges.size(); ++i) {
      EXPECT_EQ(x.edges[i].kind, y.edges[i].kind);
      EXPECT_EQ(x.edges[i].end, y.edges[i].end);
      EXPECT_EQ(x.edges[i].visibility, y.edges[i].visibility);
    }
    EXPECT_EQ(x.situation.position, y.situation.position);
  }
}

// ---- points and passages of an extract ------------------------------------------------------------------------------

struct TagList {
  std::vector<std::pair<std::string, std::string>> tags;
};

void add_feature(model::Extract& e, model::OsmId id, std::uint32_t kinds, const TagList& tags,
                 const std::vector<model::Location>& places) {
  model::Feature f;
  f.id = id;
  f.kinds = kinds;
  f.tags = {static_cast<std::uint32_t>(e.tags.size()), static_cast<std::uint32_t>(tags.tags.size())};
  for (const auto& [key, value] : tags.tags) e.tags.push_back({e.strings.intern(key), e.strings.intern(value)});
  f.rings = {static_cast<std::uint32_t>(e.rings.size()), 1};
  e.rings.push_back(
      {{static_cast<std::uint32_t>(e.vertices.size()), static_cast<std::uint32_t>(places.size())}, false});
  for (const model::Location p : places) {
    e.vertices.push_back(p);
    e.vertex_nodes.push_back(p.lon);
  }
  e.features.push_back(f);
}

Point2 plain(model::Location l) { return {l.lon * 1.0, l.lat * 1.0}; }

constexpr std::uint32_t bit(model::FeatureKind k) { return static_cast<std::uint32_t>(k); }

TEST(PassageWays, TakeTheirWidthFromTheTagElseFromTheKindOfWay) {
  using enum model::FeatureKind;
  model::Extract e;
  const auto way = [&](std::int64_t id, const TagList& tags) {
    add_feature(e, {model::OsmType::way, id}, bit(street) | bit(passage), tags, {{0, 0}, {10, 0}});
  };
  way(1, {{{"highway", "service"}, {"tunnel", "building_passage"}}});
  way(2, {{{"highway", "footway"}, {"tunnel", "building_passage"}}});
  way(3, {{{"highway", "residential"}, {"tunnel", "building_passage"}}});
  way(4, {{{"highway", "footway"}, {"tunnel", "building_passage"}, {"width", "4.2 m"}}});
  way(5, {{{"highway", "footway"}, {"tunnel", "building_passage"}, {"width", "wide"}}});
  way(6, {{{"highway", "service"}, {"covered", "yes"}}});
  add_feature(e, {model::OsmType::way, 7}, bit(street), {{{"highway", "service"}}}, {{0, 0}, {10, 0}});
  const std::vector<PassageWay> found = passage_ways(e, plain);
  std::vector<double> widths;
  for (const PassageWay& p : found) widths.push_back(p.width);
  EXPECT_THAT(widths, ElementsAre(3.5, 2.5, 5.5, 4.2, 2.5, 3.5));
  EXPECT_FALSE(found[0].covered_only);
  EXPECT_TRUE(found[5].covered_only);
  EXPECT_THAT(found[0].nodes, ElementsAre(0, 10));
}

TEST(SitePoints, AreEntrancesAddressesAndTrees) {
  using enum model::FeatureKind;
  model::Extract e;
  add_feature(e, {model::OsmType::node, 1}, bit(entrance) | bit(address),
              {{{"entrance", "main"}, {"addr:street", "Long Street"}, {"addr:housenumber", "3a"}}}, {{5, 6}});
  add_feature(e, {model::OsmType::node, 2}, bit(address), {{{"addr:street", "Short Street"}}}, {{7, 8}});
  add_feature(e, {model::OsmType::node, 3}, bit(tree), {{{"natural", "tree"}}}, {{9, 9}});
  add_feature(e, {model::OsmType::node, 4}, bit(shop), {{{"shop", "bakery"}}}, {{9, 9}});
  add_feature(e, {model::OsmType::way, 5}, bit(tree), {{{"natural", "tree_row"}}}, {{9, 9}, {10, 10}});
  const std::vector<SitePoint> found = site_points(e, plain);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].kind, SitePointKind::entrance);
  EXPECT_EQ(found[0].street, "Long Street");
  EXPECT_EQ(found[0].house_number, "3a");
  EXPECT_EQ(found[0].place, (Point2{5, 6}));
  EXPECT_EQ(found[1].kind, SitePointKind::address);
  EXPECT_EQ(found[2].kind, SitePointKind::tree);
  const std::vector<SitePoint> used = site_points(
      e, plain, [](const auto& tag) { return tag("shop").empty() ? std::string_view() : std::string_view("shop"); });
  ASSERT_EQ(used.size(), 4u);
  EXPECT_EQ(used[0].use, "");
  EXPECT_EQ(used[3].kind, SitePointKind::shop);
  EXPECT_EQ(used[3].use, "shop");
}

}  // namespace
}  // namespace blockrand::context
