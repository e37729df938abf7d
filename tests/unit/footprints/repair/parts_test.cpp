#include "pipeline/footprints/repair/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/footprints/repair/parts_bodies.h"
#include "pipeline/footprints/repair/parts_follow.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/footprints/repair/parts_scene.h"
#include "tests/unit/geometry/find_slivers.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::repair {
namespace {

using test::Building;
using test::BuildingPart;
using test::Ids;
using test::IssueCode;
using test::Point2;
using test::Polygon;
using test::polygon;
using test::Random;
using test::Ring;
using test::ring;
using test::Scene;
using test::Tags;

// ---- slivers --------------------------------------------------------------------------------------------------------

TEST(PartsSlivers, NeitherRestsNorPartsThatYieldKeepThem) {
  // A wing and a tower in a house, at many angles: their fronts are the house's but for rounding.
  for (int turn = 1; turn <= 20; ++turn) {
    SCOPED_TRACE(turn);
    const double slope = 0.004 * turn * turn, scale = 1 / std::sqrt(1 + slope * slope);
    const auto box = [&](double x0, double x1, double y1) {
      std::vector<Point2> out;
      for (const Point2 p : {Point2{x0, 0}, Point2{x1, 0}, Point2{x1, y1}, Point2{x0, y1}})
        out.push_back(model::snap(Point2{(p.x - slope * p.y) * scale, (slope * p.x + p.y) * scale}));
      return out;
    };
    Scene s(box(0, 40, 12));
    s.part(2, box(7.3, 21.1, 12)).part(3, box(17.7, 23.9, 9)).fit();
    EXPECT_NEAR(s.area("w1.w2"), 13.8 * 12 - 3.4 * 9, 0.1);
    EXPECT_GE(s.ids().size(), 3u);
    for (const BuildingPart& p : s.building.parts)
      for (const geometry::Sliver& sliver : geometry::find_slivers(p.plan.outer, 0.02))
        ADD_FAILURE() << p.id << (sliver.outward ? " needle " : " crack ") << sliver.length << " m";
  }
}

// ---- parts follow their outline -------------------------------------------------------------------------------------

TEST(PartsFollow, WhereTheOutlineDidNotMoveNothingMoves) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {8, 0.3125}, {8, 10}, {0, 10}}).part(3, {{12, 0}, {20, 0}, {20, 10}, {12.5, 10}}).fit();
  EXPECT_EQ(s.plan("w1.w2").outer.points, (std::vector<Point2>{{0, 0}, {8, 0.3125}, {8, 10}, {0, 10}}));
  EXPECT_EQ(s.plan("w1.w3").outer.points, (std::vector<Point2>{{12, 0}, {20, 0}, {20, 10}, {12.5, 10}}));
}

TEST(PartsFollow, CornersGoWithCornersWallsWithWallsAndTheInsideBetween) {
  // The right wall moves out by 0.5 m at its foot, 0.25 m at its top; the middle of the long walls by half of that.
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  const Tags low{10.0f, {}, {}, {}}, high{20.0f, 10.0f, {}, {}};
  s.part(2, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, low).part(3, {{10, 0}, {20, 0}, {20, 10}, {10, 10}}, low);
  s.part(4, {{14, 4}, {16, 4}, {16, 6}, {14, 6}}, high);
  s.moved_to({{0, 0}, {20.5, 0}, {20.25, 10}, {0, 10}}).fit();
  EXPECT_TRUE(s.has_point("w1.w3", {20.5, 0}));
  EXPECT_TRUE(s.has_point("w1.w3", {20.25, 10}));
  EXPECT_TRUE(s.has_point("w1.w2", {0, 0}));
  EXPECT_TRUE(s.has_point("w1.w2", {10.25, 0}));
  EXPECT_TRUE(s.has_point("w1.w3", {10.25, 0})) << "a common corner stays common";
  EXPECT_TRUE(s.has_point("w1.w2", {10.125, 10}));
  EXPECT_TRUE(s.has_point("w1.w3", {10.125, 10}));
  const Point2 inside = s.plan("w1.w4").outer.points[0];
  EXPECT_GT(inside.x, 14.05);
  EXPECT_LT(inside.x, 14.5);
  EXPECT_NEAR(s.area("w1.w2") + s.area("w1.w3"), geometry::area(s.building.outline[0]), 0.02);
}

TEST(PartsFollow, PointsOfANeighbourInAWallAreNoCornersToGoTo) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.moved_to({{0, 0}, {19.75, 0.125}, {20.25, 0.125}, {20.25, 5}, {20.25, 10}, {0, 10}}).fit();
  EXPECT_TRUE(s.has_point("w1.w2", {20.25, 0.125}) || s.has_point("w1.w2", {19.75, 0.125}));
  EXPECT_TRUE(s.has_point("w1.w2", {20.25, 10}));
  EXPECT_LT(std::fabs(s.area("w1.w2") - geometry::area(s.building.outline[0])), 1.5);
}

TEST(PartsFollow, PointsNearAWallMoveAsTheWallAndKeepTheirDistance) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0.25}, {20, 0.25}, {20, 10}, {0, 10}}).moved_to({{0, 0.375}, {20, 0.375}, {20, 10}, {0, 10}}).fit();
  for (const Point2 p : s.plan("w1.w2").outer.points)
    if (p.y < 5) {
      EXPECT_NEAR(p.y, 0.625, 0.02);
    }
}

TEST(PartsFollow, OneMapForAllPoints) {
  // Equal points go to equal points, near ones to near ones, whatever ring they are in and wherever rings start.
  const std::vector<Polygon> before{polygon({{0, 0}, {12, 0}, {12, 5}, {20, 5}, {20, 15}, {0, 15}})};
  std::vector<Polygon> after{polygon({{0.1, 0.2}, {12.3, 0}, {12.1, 5.2}, {20.4, 5}, {20, 15.3}, {-0.2, 15}})};
  for (Point2& p : after[0].outer.points) p = model::snap(p);
  auto turned = before;
  std::rotate(turned[0].outer.points.begin(), turned[0].outer.points.begin() + 2, turned[0].outer.points.end());
  auto turned_after = after;
  std::rotate(turned_after[0].outer.points.begin(), turned_after[0].outer.points.begin() + 4,
              turned_after[0].outer.points.end());
  const MovedWalls walls(before, after, {}), same(turned, turned_after, {});
  for (std::size_t i = 0; i < before[0].outer.size(); ++i)
    EXPECT_EQ(walls(before[0].outer.points[i]), after[0].outer.points[i]);
  Random random(5);
  for (int round = 0; round < 500; ++round) {
    const Point2 p = model::snap(Point2{24 * random.unit() - 2, 18 * random.unit() - 2}), q = walls(p);
    EXPECT_LE(std::fabs(q.x - p.x), 0.51);
    EXPECT_LE(std::fabs(q.y - p.y), 0.51);
    const Point2 r = same(p);
    EXPECT_NEAR(q.x, r.x, 0.0011);
    EXPECT_NEAR(q.y, r.y, 0.0011);
  }
}

TEST(PartsFollow, WhatTheOutlineGaveAwayThePartsGiveToo) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}).part(3, {{10, 0}, {20, 0}, {20, 10}, {10, 10}});
  s.moved_to({{0, 0}, {17, 0}, {17, 10}, {0, 10}}).fit();
  EXPECT_NEAR(s.area("w1.w3"), 70, 0.01);
  EXPECT_NEAR(s.area("w1.w2"), 100, 0.01);
  EXPECT_EQ(s.ids(), (Ids{"w1.w2", "w1.w3"}));
}

TEST(PartsFollow, APartDoesNotVanishWithWhatTheOutlineGaveAway) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {18, 0}, {18, 10}, {0, 10}}).part(3, {{18, 0}, {20, 0}, {20, 10}, {18, 10}});
  s.moved_to({{0, 0}, {17, 0}, {17, 10}, {0, 10}}).fit();
  EXPECT_EQ(s.ids(), (Ids{"w1.w2", "w1.w3"}));
  EXPECT_NE(s.detail(IssueCode::overlap_kept), "-");
}

// ---- walls between parts --------------------------------------------------------------------------------------------

TEST(PartsShare, AGapBetweenPartsIsClosed) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {9.875, 0}, {9.875, 10}, {0, 10}}).part(3, {{10.125, 0}, {20, 0}, {20, 10}, {10.125, 10}}).fit();
  for (const Point2 p : {Point2{10, 0}, Point2{10, 10}}) {
    EXPECT_TRUE(s.has_point("w1.w2", p));
    EXPECT_TRUE(s.has_point("w1.w3", p));
  }
  EXPECT_EQ(s.detail(IssueCode::shared_wall_made), "w1 2 corners of its parts");
}

TEST(PartsShare, AWallEndingInAnotherGetsACorner) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {10, 0}, {10, 10}, {0, 10}})
      .part(3, {{10.125, 0}, {20, 0}, {20, 5}, {10.125, 5}})
      .part(4, {{10, 5}, {20, 5}, {20, 10}, {10, 10}})
      .fit();
  const Point2 middle = s.point_near("w1.w2", {10, 5});
  EXPECT_NEAR(middle.x, 10.0625, 0.07);
  EXPECT_TRUE(s.has_point("w1.w3", middle));
  EXPECT_TRUE(s.has_point("w1.w4", middle));
  EXPECT_TRUE(s.has_point("w1.w3", s.point_near("w1.w2", {10, 0})));
}

TEST(PartsShare, ASetbackOfAnUpperStoreyIsNoGap) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {12.0f, {}, {}, {}})
      .part(3, {{0.25, 0.25}, {19.75, 0.25}, {19.75, 9.75}, {0.25, 9.75}}, {15.0f, 12.0f, {}, {}})
      .fit();
  EXPECT_NEAR(s.area("w1.w3"), 19.5 * 9.5, 1e-9);
  EXPECT_NEAR(s.area("w1.w2"), 200, 1e-9);
}

TEST(PartsShare, NoCourtTurnsInsideOut) {
  // A shaft narrower than corners may move, with the walls of other parts on either side: drawn to them it would change sides.
  Random random(8);
  for (int round = 0; round < 3000; ++round) {
    const double x = 8 + 2 * random.unit(), width = 0.06 + 0.5 * random.unit(), low = 2 + random.unit(),
                 high = low + 1 + 5 * random.unit(), left = x + 0.8 * (random.unit() - 0.5),
                 right = x + 0.8 * (random.unit() - 0.5);
    const auto on = [](std::vector<Point2> points) {
      for (Point2& p : points) p = model::snap(p);
      return points;
    };
    Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
    s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {12.0f, {}, {}, {}});
    s.building.parts.back().rings.rings.push_back(ring(on({{x, low}, {x, high}, {x + width, high}, {x + width, low}})));
    s.building.parts.back().rings.inner.push_back(true);
    s.part(3, on({{left, low}, {19, low}, {19, high}, {left, high}}), {15.0f, 12.0f, {}, {}});
    s.part(4, on({{1, low}, {right, low}, {right, high}, {1, high}}), {18.0f, 15.0f, {}, {}});
    s.moved_to({{0.25, 0}, {20, 0.25}, {20, 10}, {0, 9.75}}).fit();
  }
}

TEST(PartsShare, SmallPartsDoNotCollapse) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 9}, {0, 9}}).part(3, {{5, 9.1}, {5.3, 9.1}, {5.3, 9.4}, {5, 9.4}}).fit();
  EXPECT_NEAR(s.area("w1.w3"), 0.09, 0.04);
}

TEST(PartsShare, CanBeSwitchedOff) {
  RepairOptions options;
  options.share_walls = false;
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {9.875, 0}, {9.875, 10}, {0, 10}})
      .part(3, {{10.125, 0}, {20, 0}, {20, 10}, {10.125, 10}})
      .fit(options);
  EXPECT_TRUE(s.has_point("w1.w2", {9.875, 0}));
}

// ---- overlaps -------------------------------------------------------------------------------------------------------

TEST(PartsOverlap, TheSmallerPartKeepsTheCommonArea) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}).part(3, {{2, 2}, {8, 2}, {8, 8}, {2, 8}}, {30.0f, {}, {}, {}}).fit();
  EXPECT_NEAR(s.area("w1.w2"), 164, 1e-9);
  EXPECT_NEAR(s.area("w1.w3"), 36, 1e-9);
  EXPECT_EQ(s.plan("w1.w2").holes.size(), 1u);
  EXPECT_EQ(s.detail(IssueCode::parts_overlap), "w2 36.00 m2 given to w3");
}

TEST(PartsOverlap, OfEqualPartsTheLowerIdKeepsIt) {
  for (const bool swapped : {false, true}) {
    Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
    s.part(swapped ? 3 : 2, {{0, 0}, {12, 0}, {12, 10}, {0, 10}})
        .part(swapped ? 2 : 3, {{8, 0}, {20, 0}, {20, 10}, {8, 10}})
        .fit();
    EXPECT_NEAR(s.area("w1.w2"), 120, 1e-9);
    EXPECT_NEAR(s.area("w1.w3"), 80, 1e-9);
  }
}

TEST(PartsOverlap, AtOtherHeightsPartsOverlapFreely) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {10.0f, {}, {}, {}})
      .part(3, {{2, 2}, {8, 2}, {8, 8}, {2, 8}}, {30.0f, 10.0f, {}, {}})
      .fit();
  EXPECT_NEAR(s.common("w1.w2", "w1.w3"), 36, 1e-9);
  EXPECT_EQ(s.detail(IssueCode::parts_overlap), "-");
}

TEST(PartsOverlap, OfAPartDrawnTwiceOneStandsForTheOther) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}).part(3, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}).fit();
  EXPECT_EQ(s.ids(), (Ids{"w1.w2"}));
  ASSERT_EQ(s.settled.size(), 1u);
  EXPECT_EQ(s.settled[0].mapped_index, 3u);
  EXPECT_EQ(s.settled[0].state, model::ObjectState::represented);
  EXPECT_EQ(s.settled[0].related, (model::OsmId{model::OsmType::way, 2}));
  EXPECT_EQ(s.detail(IssueCode::parts_overlap), "w3 200.00 m2 with w2, which stands for it");
}

TEST(PartsOverlap, ASlabYieldsToATowerThroughIt) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {9.0f, {}, {}, {}});
  s.building.parts.back().canopy = true;
  s.part(3, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {15.0f, {}, {}, {}}).fit();
  EXPECT_NEAR(s.area("w1.w2"), 100, 0.01);
  EXPECT_NEAR(s.area("w1.w3"), 100, 1e-9);
  EXPECT_EQ(s.common("w1.w2", "w1.w3"), 0);
}

TEST(PartsOverlap, ARoofOverAPartStaysOverIt) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {9.0f, {}, {}, {}});
  s.building.parts.back().canopy = true;
  s.part(3, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {8.0f, {}, {}, {}}).fit();
  EXPECT_NEAR(s.common("w1.w2", "w1.w3"), 100, 0.01);
}

TEST(PartsOverlap, AHigherPartOverOthersStays) {
  // A tower drawn over two parts that fill its plan: its upper half is nobody else's.
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {10.0f, {}, {}, {}})
      .part(3, {{10, 0}, {20, 0}, {20, 10}, {10, 10}}, {10.0f, {}, {}, {}})
      .part(4, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {30.0f, {}, {}, {}})
      .fit();
  EXPECT_EQ(s.ids(), (Ids{"w1.w2", "w1.w3", "w1.w4"}));
  EXPECT_TRUE(s.settled.empty());
  EXPECT_EQ(s.detail(IssueCode::parts_overlap), "w4 200.00 m2 with others; stays, it is higher");
}

TEST(PartsOverlap, APartCutInTwoIsTwoPieces) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}).part(3, {{8, 0}, {12, 0}, {12, 10}, {8, 10}}).fit();
  EXPECT_EQ(s.ids(), (Ids{"w1.w2.1", "w1.w2.2", "w1.w3"}));
}

TEST(Heights, SpansAndMargins) {
  const auto span = [](Tags part, Tags building = {}, bool canopy = false) {
    const auto mapped = [](Tags t) {
      model::MappedAttributes a;
      a.height = t.height;
      a.min_height = t.min_height;
      a.storeys = t.storeys;
      a.min_storey = t.min_storey;
      return a;
    };
    return height_span(mapped(part), canopy, mapped(building));
  };
  EXPECT_FALSE(heights_meet(span({10, {}, {}, {}}), span({20, 10, {}, {}})));
  EXPECT_FALSE(heights_meet(span({10.05f, {}, {}, {}}), span({20, 10, {}, {}}))) << "within the margin";
  EXPECT_TRUE(heights_meet(span({11, {}, {}, {}}), span({20, 10, {}, {}})));
  EXPECT_FALSE(heights_meet(span({{}, {}, 4, {}}), span({{}, {}, 8, 4}))) << "storeys with storeys";
  EXPECT_TRUE(heights_meet(span({{}, {}, 5, {}}), span({{}, {}, 8, 4})));
  EXPECT_FALSE(heights_meet(span({13, {}, {}, {}}), span({{}, {}, 8, 4}))) << "13 m may well be four storeys";
  EXPECT_TRUE(heights_meet(span({15, {}, {}, {}}), span({{}, {}, 8, 4})));
  EXPECT_TRUE(heights_meet(span({}), span({20, 10, {}, {}}))) << "an unknown top is the building's, which is unknown";
  EXPECT_FALSE(heights_meet(span({}, {9, {}, {}, {}}), span({20, 10, {}, {}}, {9, {}, {}, {}})));
  EXPECT_TRUE(heights_meet(span({5, 8, {}, {}}), span({}))) << "a top below the underside says nothing";
  EXPECT_FALSE(heights_meet(span({6, {}, {}, {}}, {}, true), span({20, {}, {}, {}}))) << "a slab at an unknown height";
  EXPECT_TRUE(heights_meet(span({6, 5, {}, {}}, {}, true), span({20, {}, {}, {}})));
}

// ---- outline and parts ----------------------------------------------------------------------------------------------

TEST(PartsOutside, WhatSticksOutStaysAndIsReported) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {10.0f, {}, {}, {}})
      .part(3, {{18, 0}, {23, 0}, {23, 10}, {18, 10}}, {20.0f, 10.0f, {}, {}})
      .fit();
  EXPECT_NEAR(s.area("w1.w3"), 50, 1e-9);
  EXPECT_EQ(s.detail(IssueCode::parts_outside), "w3 30.00 m2");
}

TEST(PartsOutside, TwoDrawingsOfOneWallAreNoReport) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, -0.05}, {20, -0.05}, {20, 10}, {0, 10}}).fit();
  EXPECT_EQ(s.detail(IssueCode::parts_outside), "-");
}

TEST(OutlineMade, PartsAloneGetTheirUnion) {
  Scene s({});
  s.building.mapped_index = 2;
  s.part(2, {{0, 0}, {8, 0}, {8, 10}, {0, 10}}).part(3, {{8, 0}, {20, 0}, {20, 10}, {8, 10}});
  const auto made = outline_of_parts(s.building, {}, {});
  s.fit();
  ASSERT_EQ(s.building.outline.size(), 1u);
  EXPECT_NEAR(geometry::area(s.building.outline[0]), 200, 1e-9);
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0].outer.points, s.building.outline[0].outer.points);
  EXPECT_EQ(s.detail(IssueCode::outline_made), "w1 2 parts");
  EXPECT_EQ(s.ids(), (Ids{"w1.w2", "w1.w3"}));
}

TEST(OutlineMade, ABrokenOutlineIsReplaced) {
  Scene s({});
  s.building.failure = IssueCode::zero_area;
  s.part(2, {{0, 0}, {8, 0}, {8, 10}, {0, 10}}).fit();
  EXPECT_EQ(s.building.failure, IssueCode::none);
  EXPECT_EQ(s.building.outline.size(), 1u);
}

TEST(OutlineMade, EveryBrokenPartHasOneState) {
  // w2 gave the building its index; it is not counted a second time as a failed part.
  Scene s({});
  s.building.mapped_index = 2;
  s.part(2, {{0, 0}, {8, 0}}).part(3, {{8, 0}, {20, 0}}).fit();
  EXPECT_TRUE(s.building.parts.empty());
  EXPECT_EQ(s.building.failure, IssueCode::too_few_points);
  ASSERT_EQ(s.failures.size(), 1u);
  EXPECT_EQ(s.failures[0].mapped_index, 3u);
}

TEST(OutlineAndRest, TheRestKeepsNodesOfOutlineAndParts) {
  Scene s({{0, 0}, {30, 0}, {30, 12}, {0, 12}});
  s.before[0].outer.nodes = s.building.outline[0].outer.nodes = {1, 2, 3, 4};
  s.part(2, {{10, 3}, {16, 3}, {16, 9}, {10, 9}});
  s.building.parts[0].rings.rings[0].nodes = {5, 6, 7, 8};
  s.fit();
  const Polygon& rest = s.plan("w1.rest");
  ASSERT_EQ(rest.holes.size(), 1u);
  EXPECT_EQ(std::count(rest.outer.nodes.begin(), rest.outer.nodes.end(), 0), 0);
  EXPECT_EQ(std::count(rest.holes[0].nodes.begin(), rest.holes[0].nodes.end(), 0), 0);
}

// ---- properties -----------------------------------------------------------------------------------------------------

TEST(Parts, NoisyPlansBecomePartitions) {
  // Houses cut into four parts around a point, every part's own copy of a corner off by up to 15 cm, and the outline
  // moved by up to 30 cm: valid, all there, hardly any overlap or gap, and the same for every order and start of rings.
  Random random(21);
  double free_before = 0, free_after = 0;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const double w = 12 + 10 * random.unit(), d = 10 + 8 * random.unit(), x = w * (0.35 + 0.3 * random.unit()),
                 y = d * (0.35 + 0.3 * random.unit());
    const auto noisy = [&](std::vector<Point2> points, double size) {
      for (Point2& p : points)
        p = model::snap(Point2{p.x + size * (2 * random.unit() - 1), p.y + size * (2 * random.unit() - 1)});
      return points;
    };
    Scene s(noisy({{0, 0}, {w, 0}, {w, d}, {0, d}}, 0));
    std::vector<std::vector<Point2>> rings;
    for (const auto& points : std::vector<std::vector<Point2>>{{{0, 0}, {x, 0}, {x, y}, {0, y}},
                                                               {{x, 0}, {w, 0}, {w, y}, {x, y}},
                                                               {{x, y}, {w, y}, {w, d}, {x, d}},
                                                               {{0, y}, {x, y}, {x, d}, {0, d}}})
      rings.push_back(noisy(points, 0.1));
    for (std::size_t i = 0; i < 4; ++i) s.part(static_cast<std::int64_t>(i) + 2, rings[i]);
    const auto moved = noisy({{0, 0}, {w, 0}, {w, d}, {0, d}}, 0.2);
    s.moved_to(moved);
    Scene other = s;
    for (auto& p : other.building.parts)
      std::rotate(p.rings.rings[0].points.begin(),
                  p.rings.rings[0].points.begin() + static_cast<std::ptrdiff_t>(random.next(4)),
                  p.rings.rings[0].points.end());
    std::vector<Polygon> raw;
    for (const auto& r : rings) raw.push_back(polygon(r));
    s.fit();
    other.fit();
    EXPECT_EQ(s.ids(), (Ids{"w1.w2", "w1.w3", "w1.w4", "w1.w5"}));
    ASSERT_EQ(s.building.parts.size(), other.building.parts.size());
    double total = 0;
    std::vector<Polygon> plans;
    for (std::size_t i = 0; i < s.building.parts.size(); ++i) {
      plans.push_back(s.building.parts[i].plan);
      total += geometry::area(plans.back());
      Ring a = plans.back().outer, b = other.building.parts[i].plan.outer;
      EXPECT_EQ(a.points, b.points);
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_LT(geometry::common_area(std::vector{plans[i]}, std::vector{plans[j]}), 0.1);
    }
    const auto area_of = [](const std::vector<Polygon>& polygons) {
      double sum = 0;
      for (const auto& p : polygons) sum += geometry::area(p);
      return sum;
    };
    free_before += area_of(geometry::difference(s.before, raw, 0.0001, 0.03).polygons);
    free_after += area_of(geometry::difference(s.building.outline, plans, 0.0001, 0.03).polygons);
    EXPECT_NEAR(total, geometry::area(s.building.outline[0]), 0.05 * w * d);
  }
  EXPECT_LT(free_after, 0.7 * free_before);
}

}  // namespace
}  // namespace blockrand::repair
