#include "pipeline/geometry/plane_partition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "pipeline/geometry/line_area.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::geometry {
namespace {

using model::Point2;

/// Somewhere in UTM zone 33: tests run on coordinates of the usual size.
constexpr Point2 kPlace{391000, 5820000};
constexpr double kSide = 100;

PlanBox square_at(int column) {
  PlanBox box;
  box.minimum = {kPlace.x + column * kSide, kPlace.y};
  box.maximum = {kPlace.x + (column + 1) * kSide, kPlace.y + kSide};
  return box;
}

AreaClaim claim(std::uint32_t label, std::vector<std::vector<Point2>> rings) {
  AreaClaim out;
  out.label = label;
  for (auto& ring : rings)
    for (Point2& p : ring) {
      p = model::snap(Point2{p.x + kPlace.x, p.y + kPlace.y});
      out.box.include(p);
    }
  out.rings = std::move(rings);
  return out;
}

AreaClaim rectangle(std::uint32_t label, double x0, double y0, double x1, double y1) {
  return claim(label, {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}});
}

double area_of(const std::vector<PartitionPiece>& pieces, std::uint32_t label) {
  double sum = 0;
  for (const PartitionPiece& p : pieces)
    if (p.label == label) sum += area(p.polygon);
  return sum;
}

/// Streets, houses and lawns as they come: strips along lines, scribbles, rectangles.
std::vector<AreaClaim> random_claims(std::mt19937& random, double width) {
  std::uniform_real_distribution<double> x(-40, width + 40), y(-40, kSide + 40), size(0.5, 30), unit(0, 1);
  std::vector<AreaClaim> out;
  for (std::uint32_t label = 0; label < 14; ++label) {
    const Point2 a{x(random), y(random)};
    if (label % 3 == 0) {
      const Point2 b{x(random), y(random)}, c{x(random), y(random)};
      std::vector<Point2> line;
      for (const Point2 p : {a, b, c}) line.push_back(model::snap(Point2{p.x + kPlace.x, p.y + kPlace.y}));
      for (const model::Polygon& p :
           line_area(line, 1 + 5 * unit(random), 1 + 5 * unit(random), LineEnd::round, LineEnd::flat)) {
        AreaClaim strip;
        strip.label = label;
        strip.rings.push_back(p.outer.points);
        for (const model::Ring& hole : p.holes) strip.rings.push_back(hole.points);
        strip.box = box_of(p.outer.points);
        out.push_back(std::move(strip));
      }
    } else if (label % 3 == 1) {
      out.push_back(rectangle(label, a.x, a.y, a.x + size(random), a.y + size(random)));
    } else {
      std::vector<Point2> ring;
      for (int i = 0; i < 7; ++i) ring.push_back({a.x + size(random), a.y + size(random)});
      out.push_back(claim(label, {ring}));
    }
  }
  return out;
}

std::set<Point2> border_points(const std::vector<PartitionPiece>& pieces, double x) {
  std::set<Point2> out;
  for (const PartitionPiece& piece : pieces) {
    const auto add = [&](const model::Ring& ring) {
      for (const Point2 p : ring.points)
        if (p.x == x) out.insert(p);
    };
    add(piece.polygon.outer);
    for (const model::Ring& hole : piece.polygon.holes) add(hole);
  }
  return out;
}

TEST(PlanePartition, TheStrongerHasTheGroundThatTwoClaim) {
  const std::vector<AreaClaim> claims = {rectangle(7, 10, 10, 30, 30), rectangle(3, 20, 20, 50, 40)};
  const auto pieces = partition_of(square_at(0), claims);
  EXPECT_DOUBLE_EQ(area_of(pieces, 7), 400);
  EXPECT_DOUBLE_EQ(area_of(pieces, 3), 30 * 20 - 100);
  EXPECT_DOUBLE_EQ(area_of(pieces, kNoLabel), kSide * kSide - 400 - 500);
}

TEST(PlanePartition, AreasOfOneLabelAreOnePiece) {
  const std::vector<AreaClaim> claims = {rectangle(1, 0, 40, 100, 50), rectangle(1, 40, 0, 50, 100)};
  const auto pieces = partition_of(square_at(0), claims);
  EXPECT_EQ(std::ranges::count(pieces, 1u, &PartitionPiece::label), 1);
  EXPECT_DOUBLE_EQ(area_of(pieces, 1), 1900);
  EXPECT_EQ(std::ranges::count(pieces, kNoLabel, &PartitionPiece::label), 4);
}

TEST(PlanePartition, PointsOnStraightBordersAreLeftOut) {
  // The weaker one ends below the stronger: its corners there are seen by nobody.
  const std::vector<AreaClaim> claims = {rectangle(1, 20, 20, 60, 40), rectangle(2, 30, 25, 50, 35)};
  const auto pieces = partition_of(square_at(0), claims);
  ASSERT_EQ(pieces.size(), 2u);
  for (const PartitionPiece& piece : pieces) EXPECT_EQ(piece.polygon.outer.size(), 4u);
}

TEST(PlanePartition, TellsWhatLiesBeyondEachEdge) {
  const std::vector<AreaClaim> claims = {rectangle(1, 20, 20, 60, 40), rectangle(2, -50, 20, 20, 40)};
  const auto pieces = partition_of(square_at(0), claims);
  const auto first = std::ranges::find(pieces, 1u, &PartitionPiece::label);
  ASSERT_NE(first, pieces.end());
  EXPECT_EQ(std::ranges::count(first->beyond, 2u), 1);
  EXPECT_EQ(std::ranges::count(first->beyond, kNoLabel), 3);
  // Beyond the square it is the same area.
  const auto second = std::ranges::find(pieces, 2u, &PartitionPiece::label);
  ASSERT_NE(second, pieces.end());
  EXPECT_EQ(std::ranges::count(second->beyond, 2u), 1);
}

TEST(PlanePartition, WhatCoversTheSquareHasNoEdgeInIt) {
  const std::vector<AreaClaim> claims = {rectangle(5, 40, 40, 60, 60), rectangle(4, -500, -500, 500, 500),
                                         rectangle(3, 10, 10, 20, 20)};
  const auto pieces = partition_of(square_at(0), claims);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_DOUBLE_EQ(area_of(pieces, 4), kSide * kSide - 400);
}

AreaClaim coast(std::vector<std::vector<Point2>> lines) {
  AreaClaim out = claim(9, std::move(lines));
  out.right_of_lines = true;
  return out;
}

TEST(PlanePartition, TheSeaLiesOnTheRightOfACoast) {
  // Eastwards, with a spit to the south and back: land in the north.
  const std::vector<AreaClaim> claims = {rectangle(1, 10, 30, 20, 70),
                                         coast({{{-300, 50}, {40, 50}, {40, 20}, {60, 20}, {60, 50}, {300, 50}}})};
  const auto pieces = partition_of(square_at(0), claims);
  EXPECT_DOUBLE_EQ(area_of(pieces, 9), 50 * 100 - 20 * 30 - 10 * 20);
  EXPECT_DOUBLE_EQ(area_of(pieces, 1), 400);
  EXPECT_DOUBLE_EQ(area_of(pieces, kNoLabel), 50 * 100 + 20 * 30 - 10 * 20);
}

TEST(PlanePartition, ASquareWithoutCoastLiesOnTheSideOfTheNearest) {
  const double far = kSide + kCoastReach;
  const auto whole = [&](const AreaClaim& sea) { return area_of(partition_of(square_at(0), std::vector{sea}), 9); };
  EXPECT_EQ(whole(coast({{{-300, 500}, {300, 500}}})), kSide * kSide);  // the coast runs in the north, land behind it
  EXPECT_EQ(whole(coast({{{300, 500}, {-300, 500}}})), 0);              // the other way
  EXPECT_EQ(whole(coast({{{-300, far}, {300, far}}})), 0);              // too far to tell
  // Two coasts: the nearer one tells. An island in the sea, whose corner is the nearest point.
  EXPECT_EQ(whole(coast({{{300, 500}, {-300, 500}}, {{-300, -20}, {300, -20}}})), 0);
  EXPECT_EQ(whole(coast({{{200, 200}, {300, 200}, {300, 300}, {200, 300}, {200, 200}}})), kSide * kSide);
  EXPECT_EQ(whole(coast({{{200, 200}, {200, 300}, {300, 300}, {300, 200}, {200, 200}}})),
            0);  // a lake, mapped as a coast
}

TEST(PlanePartition, LinesOfATerrainCutPieces) {
  const PlanBox box = square_at(0);
  const DividingLine line{0, {{box.minimum.x + 50, box.minimum.y}, {box.minimum.x + 50, box.maximum.y}}, {}};
  const auto pieces = partition_of(box, std::vector{rectangle(1, 20, 20, 80, 40)}, std::vector{line});
  EXPECT_EQ(std::ranges::count(pieces, 1u, &PartitionPiece::label), 2);
  EXPECT_DOUBLE_EQ(area_of(pieces, 1), 1200);
}

TEST(PlanePartition, RandomClaimsCoverTheSquareAndDoNotOverlap) {
  std::mt19937 random(5);
  for (int round = 0; round < 40; ++round) {
    const auto claims = random_claims(random, kSide);
    const auto pieces = partition_of(square_at(0), claims);
    double sum = 0;
    std::vector<std::vector<model::Polygon>> polygons;
    for (const PartitionPiece& piece : pieces) {
      sum += area(piece.polygon);
      polygons.push_back({piece.polygon});
      std::size_t corners = piece.polygon.outer.size();
      for (const model::Ring& hole : piece.polygon.holes) corners += hole.size();
      EXPECT_EQ(piece.beyond.size(), corners);
    }
    EXPECT_NEAR(sum, kSide * kSide, 1e-6) << round;
    // GEOS is the judge: 1 cm².
    for (std::size_t i = 0; i < polygons.size(); ++i)
      for (std::size_t k = i + 1; k < polygons.size(); ++k)
        EXPECT_LT(common_area(polygons[i], polygons[k]), 1e-4) << round << ' ' << i << ' ' << k;
  }
}

TEST(PlanePartition, NeighbouringSquaresMeetPointForPoint) {
  std::mt19937 random(11);
  for (int round = 0; round < 60; ++round) {
    const auto claims = random_claims(random, 2 * kSide);
    const double x = square_at(1).minimum.x;
    EXPECT_EQ(border_points(partition_of(square_at(0), claims), x),
              border_points(partition_of(square_at(1), claims), x))
        << round;
  }
}

TEST(PlanePartition, EveryPieceHasTriangles) {
  std::mt19937 random(23);
  for (int round = 0; round < 40; ++round)
    for (const PartitionPiece& piece : partition_of(square_at(0), random_claims(random, kSide))) {
      std::vector<Grid2> points;
      std::vector<std::vector<std::uint32_t>> loops;
      const auto add = [&](const model::Ring& ring) {
        loops.emplace_back();
        for (const Point2 p : ring.points) {
          const Grid2 at = to_grid(p);
          const auto known = std::ranges::find(points, at);  // rings that touch share the point
          loops.back().push_back(static_cast<std::uint32_t>(known - points.begin()));
          if (known == points.end()) points.push_back(at);
        }
      };
      add(piece.polygon.outer);
      for (const model::Ring& hole : piece.polygon.holes) add(hole);
      const auto triangles = triangulate_touching(points, loops);
      ASSERT_TRUE(triangles);
      double twice = 0;
      for (const Triangle& t : *triangles) {
        const Grid2 u = points[t[1]] - points[t[0]], v = points[t[2]] - points[t[0]];
        twice +=
            static_cast<double>(u.x) * static_cast<double>(v.y) - static_cast<double>(u.y) * static_cast<double>(v.x);
      }
      EXPECT_NEAR(twice / 2 / 1024 / 1024, area(piece.polygon), 1e-6);
    }
}

TEST(LineArea, IsAsWideAsAsked) {
  std::vector<Point2> line;
  for (const Point2 p : {Point2{0, 0}, Point2{50, 0}}) line.push_back({p.x + kPlace.x, p.y + kPlace.y});
  const auto both = line_area(line, 3, 3, LineEnd::flat, LineEnd::flat);
  ASSERT_EQ(both.size(), 1u);
  EXPECT_NEAR(area(both[0]), 300, 0.1);
  double right = 0;
  for (const model::Polygon& p : line_area(line, 0, 2, LineEnd::flat, LineEnd::flat)) {
    right += area(p);
    for (const Point2 q : p.outer.points) EXPECT_LE(q.y, kPlace.y + 0.001);  // east is ahead: the right side lies south
  }
  EXPECT_NEAR(right, 100, 0.1);
}

TEST(LineArea, ARingOfAStreetHasAHole) {
  std::vector<Point2> line;
  for (const Point2 p : {Point2{0, 0}, Point2{40, 0}, Point2{40, 40}, Point2{0, 40}, Point2{0, 0}})
    line.push_back({p.x + kPlace.x, p.y + kPlace.y});
  const auto areas = line_area(line, 2, 2, LineEnd::round, LineEnd::round);
  double sum = 0;
  for (const model::Polygon& p : areas) sum += area(p);
  EXPECT_NEAR(sum, 44 * 44 - 36 * 36, 8);
}

TEST(LineArea, ALineWithoutLengthHasNone) {
  EXPECT_TRUE(line_area(std::vector<Point2>{kPlace, kPlace}, 2, 2, LineEnd::round, LineEnd::round).empty());
  EXPECT_TRUE(line_area(std::vector<Point2>{kPlace}, 2, 2, LineEnd::round, LineEnd::round).empty());
}

}  // namespace
}  // namespace blockrand::geometry
