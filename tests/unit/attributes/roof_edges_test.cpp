#include "pipeline/attributes/roof_edges.h"

#include <gtest/gtest.h>

#include "pipeline/masses/roofscape.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::attributes {
namespace {

using model::Point2;
using model::RoofEdge;
using model::WallSegmentKind;
using testing_shapes::ring;

/// A house 6 m wide and 10 m deep: south, east, north, west.
const model::Polygon kHouse{ring({{0, 0}, {6, 0}, {6, 10}, {0, 10}}), {}};

model::Building building(
    const std::vector<std::tuple<std::uint32_t, WallSegmentKind, double, double, bool>>& segments) {
  model::Building b;
  b.outline = {kHouse};
  for (const auto& [edge, kind, start, end, outbuilding] : segments) {
    model::WallSegment e;
    e.edge = edge;
    e.kind = kind;
    e.start = start;
    e.end = end;
    e.outbuilding = outbuilding;
    b.edges.push_back(e);
  }
  return b;
}

TEST(RoofEdges, AreWhatMostOfTheirStretchesAre) {
  const auto b = building({{0, WallSegmentKind::street, 0, 4, false},
                           {0, WallSegmentKind::passage, 4, 6, false},
                           {1, WallSegmentKind::party_wall, 0, 5, false},
                           {1, WallSegmentKind::side, 5, 10, false},
                           {2, WallSegmentKind::courtyard, 0, 4, false},
                           {2, WallSegmentKind::party_wall, 4, 6, false},
                           {3, WallSegmentKind::party_wall, 0, 4.9, false},
                           {3, WallSegmentKind::side, 4.9, 10, false}});
  EXPECT_EQ(roof_edges(b, kHouse),
            (std::vector<RoofEdge>{RoofEdge::street, RoofEdge::party_wall, RoofEdge::courtyard, RoofEdge::open}));
  EXPECT_TRUE(roof_edges(model::Building{}, kHouse).empty());
}

TEST(RoofEdges, RearsTakeMoreOfANeighbour) {
  // A wing stands against 55 % of the rear: eaves run on above it; against 80 %, the wall is its own.
  for (const double covered : {3.3, 4.8}) {
    const auto b = building({{0, WallSegmentKind::street, 0, 6, false},
                             {2, WallSegmentKind::party_wall, 0, covered, false},
                             {2, WallSegmentKind::courtyard, covered, 6, false}});
    EXPECT_EQ(roof_edges(b, kHouse)[2], covered < 4 ? RoofEdge::courtyard : RoofEdge::party_wall);
  }
}

TEST(RoofEdges, OutbuildingsAreNoNeighbours) {
  const auto b = building({{0, WallSegmentKind::street, 0, 6, false}, {1, WallSegmentKind::party_wall, 0, 10, true}});
  EXPECT_EQ(roof_edges(b, kHouse)[1], RoofEdge::open);
}

TEST(RoofEdges, OfAPartAreThoseOfTheOutlineItStandsAt) {
  const auto b = building({{0, WallSegmentKind::street, 0, 6, false},
                           {1, WallSegmentKind::party_wall, 0, 10, false},
                           {3, WallSegmentKind::party_wall, 0, 10, false}});
  // The western half, 4 cm off: repair moves parts and outline together, but not to the millimetre.
  const model::Polygon half{ring({{0.04, 0}, {3, 0}, {3, 10}, {0.04, 10}}), {}};
  EXPECT_EQ(roof_edges(b, half),
            (std::vector<RoofEdge>{RoofEdge::street, RoofEdge::open, RoofEdge::open, RoofEdge::party_wall}));
  // Inside, no wall segment lies on it.
  const model::Polygon inside{ring({{2, 2}, {4, 2}, {4, 8}, {2, 8}}), {}};
  EXPECT_EQ(roof_edges(b, inside), std::vector<RoofEdge>(4, RoofEdge::open));
}

TEST(RoofPlans, LosePointsThatBendNoWall) {
  auto b = building({{0, WallSegmentKind::street, 0, 6, false}});
  b.parts.emplace_back();
  b.parts[0].plan = {ring({{0, 0}, {3, 0.005}, {6, 0}, {6, 10}, {0, 10}}), {}};
  prepare_roof_plans(b, 0.01);
  EXPECT_EQ(b.parts[0].roof_plan.outer.points, kHouse.outer.points);
  ASSERT_EQ(b.parts[0].roof_edges.size(), 4u);
  EXPECT_EQ(b.parts[0].roof_edges[0], RoofEdge::street);
}

masses::SlopeEnd end_at(std::int64_t x, double z, Point2 wall, Point2 eaves, double pitch, double usual) {
  masses::SlopeEnd e;
  e.x = x;
  e.z = z;
  e.wall = wall;
  e.eaves = eaves;
  e.pitch = pitch;
  e.usual = usual;
  e.count = 2;
  e.profile = {{{0, 0}, {6, 6 * pitch}}};
  return e;
}

TEST(Roofscape, SlopesMeetWhenTheyAreOnePlane) {
  const auto met = [](const masses::SlopeEnd& a, const masses::SlopeEnd& b) {
    std::vector<masses::SlopeEnd> ends{a, b};
    masses::Roofscape sums;
    masses::settle_slope_ends(ends, sums);
    return std::tuple(sums.meetings, sums.apart, ends.size());
  };
  using Result = std::tuple<std::uint64_t, std::uint64_t, std::size_t>;
  const masses::SlopeEnd left = end_at(7, 12, {0, 1}, {-1, 0}, 0.8, 38);
  EXPECT_EQ(met(left, end_at(7, 12, {0, 1}, {1, 0}, 0.8, 38)), Result(1, 0, 0));
  EXPECT_EQ(met(left, end_at(7, 12, {0, 1}, {1, 0}, 0.79, 38)), Result(1, 1, 0)) << "asked alike, built 6 cm apart";
  EXPECT_EQ(met(left, end_at(7, 12, {0, 1}, {1, 0}, 0.6, 0)), Result(0, 0, 2)) << "another pitch, as mapped";
  EXPECT_EQ(met(left, end_at(7, 12.5, {0, 1}, {1, 0}, 0.8, 38)), Result(0, 0, 2)) << "other eaves";
  EXPECT_EQ(met(left, end_at(7, 12, {0, 1}, {0.8, 0.6}, 0.8, 38)), Result(0, 0, 2)) << "the row bends";
  EXPECT_EQ(met(left, end_at(8, 12, {0, 1}, {1, 0}, 0.8, 38)), Result(0, 0, 2)) << "another corner: both wait";
}

}  // namespace
}  // namespace blockrand::attributes
