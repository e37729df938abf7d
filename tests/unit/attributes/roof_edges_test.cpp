#include "pipeline/attributes/roof_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/attributes/roof_plan_corners.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/grid_side.h"
#include "pipeline/geometry/valid_polygon.h"
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

TEST(GridPoints, OnTheLeftAreNearAndNeverOnTheRight) {
  testing_shapes::Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const model::Point2 a = model::snap(Point2{40 * random.unit(), 40 * random.unit()}),
                        b = model::snap(Point2{40 * random.unit(), 40 * random.unit()});
    if (a == b) continue;
    const double t = random.unit();
    const Point2 on{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    const Point2 p = geometry::grid_point_on_left(on, a, b);
    EXPECT_GE(geometry::orientation(geometry::to_grid(a), geometry::to_grid(b), geometry::to_grid(p)), 0);
    EXPECT_LE(std::hypot(p.x - on.x, p.y - on.y), 1.5 / model::kGridStepsPerMetre);
  }
}

/// Corners of each plan that lie strictly inside a wall of another, no farther than 3 cm from it.
int corners_inside(const std::vector<model::BuildingPart>& parts) {
  int n = 0;
  for (const auto& mine : parts)
    for (const auto& other : parts) {
      if (&mine == &other) continue;
      for (const Point2 p : mine.roof_plan.outer.points)
        for (std::size_t i = 0; i < other.roof_plan.outer.size(); ++i) {
          const Point2 a = other.roof_plan.outer.points[i],
                       b = other.roof_plan.outer.points[(i + 1) % other.roof_plan.outer.size()];
          const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
          const double along = ((p.x - a.x) * dx + (p.y - a.y) * dy) / length,
                       inside = (dx * (p.y - a.y) - dy * (p.x - a.x)) / length;
          n += inside > 0 && inside < 0.03 && along > 0 && along < length;
        }
    }
  return n;
}

TEST(RoofPlanCorners, StayOutOfOtherParts) {
  testing_shapes::Random random(3);
  int before = 0;
  for (int turn = 0; turn < 50; ++turn) {
    SCOPED_TRACE(turn);
    const double angle = 0.12 * turn, c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](std::vector<Point2> points) {
      for (Point2& p : points) p = model::snap(Point2{c * p.x - s * p.y, s * p.x + c * p.y});
      return model::Polygon{ring(std::move(points)), {}};
    };
    const auto off = [&] { return 0.018 * (random.unit() - 0.5); };  // what straightening a wall leaves
    // A house, two wings against its front, which share a wall, and one against the side of a wing.
    const double x = off();
    std::vector<model::BuildingPart> parts(4);
    parts[0].roof_plan = turned({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
    parts[1].roof_plan = turned({{2, -6}, {9, -6}, {9, x}, {2, off()}});
    parts[2].roof_plan = turned({{9, -6}, {15, -6}, {15, off()}, {9, x}});
    parts[3].roof_plan = turned({{15 + off(), -5}, {18, -5}, {18, -3}, {15 + off(), -3}});
    for (model::BuildingPart& p : parts) p.plan = p.roof_plan;
    before += corners_inside(parts);
    const std::vector<model::BuildingPart> old = parts;
    keep_corners_out(parts, 0.01);
    EXPECT_EQ(corners_inside(parts), 0);
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_LE(std::hypot(parts[i].roof_plan.outer.points[k].x - old[i].roof_plan.outer.points[k].x,
                             parts[i].roof_plan.outer.points[k].y - old[i].roof_plan.outer.points[k].y),
                  0.02);
    EXPECT_EQ(parts[1].roof_plan.outer.points[2], parts[2].roof_plan.outer.points[3])
        << "a common corner moves in both";
  }
  EXPECT_GT(before, 50);
}

TEST(RoofPlanCorners, ATowerInACourtIsNotInsideTheWallBehindTheCourt) {
  // Between the court's corner and the front there is a wall of 2.1 cm, as repair leaves it: less than corners may move.
  for (int turn = 0; turn < 50; ++turn) {
    SCOPED_TRACE(turn);
    const double angle = 0.12 * turn + 0.01, c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](std::vector<Point2> points) {
      for (Point2& p : points) p = model::snap(Point2{c * p.x - s * p.y, s * p.x + c * p.y});
      return ring(std::move(points));
    };
    std::vector<model::BuildingPart> parts(2);
    const std::vector<Point2> tower{{6, 9}, {10.03, 0.021}, {10.06, 0.021}, {14, 9}};
    parts[0].plan.outer = turned({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
    parts[0].plan.holes = {turned({tower.rbegin(), tower.rend()})};
    parts[1].plan.outer = turned(tower);
    for (model::BuildingPart& part : parts) part.roof_plan = part.plan;
    const std::vector<model::BuildingPart> before = parts;
    keep_corners_out(parts, 0.01);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(parts[i].roof_plan.outer.points, before[i].roof_plan.outer.points);
      EXPECT_EQ(parts[i].roof_plan.holes.size(), before[i].roof_plan.holes.size());
    }
    EXPECT_EQ(parts[0].roof_plan.holes[0].points, before[0].roof_plan.holes[0].points);
  }
}

TEST(RoofPlanCorners, APartAboveIsNotInTheWay) {
  // A house with a column in front, and a storey above the column whose wall is the house's wall: straightened, it
  // passes in front of the column's corners. They leave the house, though that leads under the storey.
  for (int turn = 0; turn < 50; ++turn) {
    SCOPED_TRACE(turn);
    const double angle = 0.12 * turn + 0.01, c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](std::vector<Point2> points) {
      for (Point2& p : points) p = model::snap(Point2{c * p.x - s * p.y, s * p.x + c * p.y});
      return model::Polygon{ring(std::move(points)), {}};
    };
    std::vector<model::BuildingPart> parts(3);
    parts[0].plan = parts[0].roof_plan = turned({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
    parts[1].plan = parts[1].roof_plan = turned({{8, -1}, {9, -1}, {9, 0.006}, {8, 0.004}});
    parts[2].plan = parts[2].roof_plan = turned({{0, -10}, {20, -10}, {20, 0}, {0, 0}});
    const model::Polygon house = parts[0].roof_plan;
    keep_corners_out(parts, 0.01);
    EXPECT_EQ(geometry::common_area(std::span(&parts[0].roof_plan, 1), std::span(&parts[1].roof_plan, 1)), 0);
    EXPECT_EQ(parts[0].roof_plan.outer.points, house.outer.points);
  }
}

}  // namespace
}  // namespace blockrand::attributes
