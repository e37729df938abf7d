// Openings are holes with reveals, and what has them stays a valid solid.
#include "pipeline/facades/openings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/facades/opening_proof.h"
#include "pipeline/geometry/cgal_validator.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/masses/envelope.h"
#include "styles/roofs/roof.h"
#include "tests/unit/geometry/random_plans.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::facades {
namespace {

using model::OpeningKind;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::Solid;
using model::SurfaceKind;
using testing_shapes::polygon;
using testing_shapes::Random;
using testing_shapes::random_plan;
using testing_shapes::turned;

constexpr double kBase = 30;

Solid house(const Polygon& plan, model::RoofShape shape = model::RoofShape::flat, double eaves = 12, double roof = 4) {
  roofs::RoofRequest request;
  request.shape = shape;
  request.measures = {kBase + eaves, shape == model::RoofShape::flat ? 0 : roof};
  const auto built = roofs::build_roof(plan, request);
  EXPECT_TRUE(built);
  masses::EnvelopeMaterials looks;
  looks.wall.kind = SurfaceKind::wall;
  looks.roof.kind = SurfaceKind::roof;
  looks.under.kind = SurfaceKind::ground;
  return masses::envelope(plan, kBase, built->roof, looks);
}

std::vector<WallFrame> walls_of(const Solid& solid) {
  std::vector<WallFrame> out;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
    if (auto wall = wall_frame(solid, f)) out.push_back(std::move(*wall));
  return out;
}

std::vector<Point2> rectangle(double u, double v, double width, double height) {
  return {{u, v}, {u + width, v}, {u + width, v + height}, {u, v + height}};
}

/// A window with a segmental head of four pieces.
std::vector<Point2> arched(double u, double v, double width, double height) {
  return {{u, v},
          {u + width, v},
          {u + width, v + height * 0.85},
          {u + width * 0.75, v + height * 0.96},
          {u + width / 2, v + height},
          {u + width / 4, v + height * 0.96},
          {u, v + height * 0.85}};
}

WallOpening window(std::uint32_t wall, std::vector<Point2> outline, double reveal = 0.15) {
  return {wall, OpeningKind::window, std::move(outline), reveal, 0, model::kNoOpening};
}

std::string validity(const Solid& solid) {
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return "a face is no simple polygon";
  return geometry::check_solid(solid, *triangles).text();
}

double volume(const Solid& solid) { return geometry::volume(solid, *geometry::triangulate(solid)); }

std::string cgal_validity(const Solid& solid) {
  std::vector<geometry::PolygonRings> polygons;
  for (const model::Face& face : solid.faces) {
    auto& rings = polygons.emplace_back();
    for (const auto& loop : solid.loops_of(face)) {
      auto& ring = rings.emplace_back();
      for (const std::uint32_t i : solid.indices_of(loop)) ring.push_back(solid.vertices[i]);
    }
  }
  return geometry::validate_solid(polygons);
}

int count(const Solid& solid, SurfaceKind kind) {
  int n = 0;
  for (const model::Face& face : solid.faces) n += face.kind == kind;
  return n;
}

/// Index of the wall that looks south (of a rectangle whose first edge runs east).
std::uint32_t facing(const std::vector<WallFrame>& walls, Point2 direction) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < walls.size(); ++i) {
    const auto towards = [&](const WallFrame& w) { return w.outward().x * direction.x + w.outward().y * direction.y; };
    if (towards(walls[i]) > towards(walls[best])) best = i;
  }
  return best;
}

TEST(WallFrames, SpeakOfTheViewersRight) {
  const Solid solid = house(polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}}));
  const auto walls = walls_of(solid);
  ASSERT_EQ(walls.size(), 4u);
  const WallFrame& south = walls[facing(walls, {0, -1})];
  EXPECT_EQ(south.start, (Point2{0, 0}));
  EXPECT_NEAR(south.along.x, 1, 1e-12);
  EXPECT_EQ(south.base, kBase);
  EXPECT_NEAR(south.length, 20, 1e-9);
  EXPECT_NEAR(south.height, 12, 1e-9);
  const Point3 inside = south.at({5, 2}, 0.5);
  EXPECT_NEAR(inside.x, 5, 1e-9);
  EXPECT_NEAR(inside.y, 0.5, 1e-9);
  EXPECT_NEAR(inside.z, kBase + 2, 1e-9);
  EXPECT_EQ(walls[facing(walls, {0, 1})].start, (Point2{20, 10}));
}

TEST(Openings, ThresholdsDoNotFoldLongWalls) {
  // Doors 3 cm over the ground in a front of 40 m, at many angles: triangles from their sills to the far corner are
  // millimetres high, and rounding turns them.
  int folded = 0;
  for (int turn = 1; turn <= 25; ++turn) {
    SCOPED_TRACE(turn);
    const double angle = 0.11 * turn, c = std::cos(angle), s = std::sin(angle);
    std::vector<Point2> plan{{0, 0}, {40, 0}, {40, 10}, {0, 10}};
    for (Point2& p : plan) p = model::snap(Point2{c * p.x - s * p.y, s * p.x + c * p.y});
    const Solid solid = house(polygon(plan));
    const auto walls = walls_of(solid);
    const std::uint32_t front = facing(walls, {s, -c});
    std::vector<WallOpening> wanted;
    for (double u = 1.5; u < 38; u += 2.6) wanted.push_back(window(front, rectangle(u, 0.03, 1.1, 2.2), 0.2));
    const OpenedSolid opened = cut_openings(solid, walls, wanted);
    EXPECT_EQ(opened.openings.size(), wanted.size());
    EXPECT_EQ(validity(opened.solid), "none");
    EXPECT_EQ(cgal_validity(opened.solid), "");
    folded += !opened.changed_borders.empty();
    EXPECT_TRUE(proved_valid(opened, *geometry::triangulate(opened.solid)));
  }
  EXPECT_GT(folded, 3) << "the walls of this test do not fold without points on their border";
}

TEST(Openings, CornersBehindTheWallComeNowhereBeforeIt) {
  const Solid solid = house(turned(polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}})));
  const auto walls = walls_of(solid);
  for (const CornerRounding rounding : {CornerRounding::nearest, CornerRounding::behind_wall}) {
    std::vector<WallOpening> wanted;
    for (std::uint32_t w = 0; w < walls.size(); ++w)
      for (double u = 1; u + 1.2 < walls[w].length; u += 1.7)
        wanted.push_back(window(w, rectangle(u, 1, 1.1, 1.9), 0.2));
    const OpenedSolid opened = cut_openings(solid, walls, wanted, rounding);
    int before = 0;
    for (const WallFrame& wall : walls) {
      const auto a = geometry::to_grid(wall.start), b = geometry::to_grid(model::snap(wall.at({wall.length, 0})).xy());
      for (const auto& loop : opened.solid.loops_of(opened.solid.faces[wall.face]))
        for (const std::uint32_t i : opened.solid.indices_of(loop))
          before += geometry::orientation(a, b, geometry::to_grid(opened.solid.vertices[i].xy())) < 0;
    }
    EXPECT_EQ(before > 0, rounding == CornerRounding::nearest) << before;
    EXPECT_EQ(validity(opened.solid), "none");
  }
}

TEST(Openings, RowsOfWindowsOnEveryWall) {
  for (const bool turn : {false, true}) {
    const Polygon straight = polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
    const Solid solid = house(turn ? turned(straight) : straight, model::RoofShape::gabled);
    const auto walls = walls_of(solid);
    std::vector<WallOpening> wanted;
    double carved = 0;
    for (std::uint32_t w = 0; w < walls.size(); ++w)
      for (double v = 0.9; v < 10; v += 3)
        for (double u = 1; u + 1.2 < walls[w].length; u += 2.4) {
          wanted.push_back(window(w, rectangle(u, v, 1.1, 1.9), 0.2));
          carved += 1.1 * 1.9 * 0.2;
        }
    const OpenedSolid opened = cut_openings(solid, walls, wanted);
    EXPECT_EQ(opened.openings.size(), wanted.size());
    EXPECT_EQ(validity(opened.solid), "none");
    EXPECT_EQ(cgal_validity(opened.solid), "");
    EXPECT_EQ(count(opened.solid, SurfaceKind::window), static_cast<int>(wanted.size()));
    EXPECT_NEAR(volume(solid) - volume(opened.solid), carved, carved * 0.01);
    for (std::size_t f = 0; f < solid.faces.size(); ++f) EXPECT_EQ(opened.solid.faces[f].edge, solid.faces[f].edge);
    for (const model::Opening& o : opened.openings) {
      EXPECT_EQ(o.reveal_count, 4u);
      EXPECT_EQ(opened.solid.faces[o.polygon].kind, SurfaceKind::window);
      EXPECT_EQ(opened.solid.faces[o.wall].kind, SurfaceKind::wall);
    }
  }
}

TEST(Openings, ArchedAndFlushOnes) {
  const Solid solid = house(turned(polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}})));
  const auto walls = walls_of(solid);
  std::vector<WallOpening> wanted{window(0, arched(2, 1, 1.2, 2)), window(0, arched(5, 1, 1.2, 2), 0)};
  const OpenedSolid opened = cut_openings(solid, walls, wanted);
  ASSERT_EQ(opened.openings.size(), 2u);
  EXPECT_EQ(opened.openings[0].reveal_count, 7u);
  EXPECT_EQ(opened.openings[1].reveal_count, 0u);
  EXPECT_EQ(validity(opened.solid), "none");
  EXPECT_EQ(cgal_validity(opened.solid), "");
}

TEST(Openings, WhatDoesNotFitIsLeftOut) {
  const Solid solid = house(polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}}));
  const auto walls = walls_of(solid);
  const std::uint32_t south = facing(walls, {0, -1}), west = facing(walls, {-1, 0});
  const std::vector<std::pair<WallOpening, OpeningRefusal>> cases{
      {window(south, rectangle(1, 1, 1, 2)), OpeningRefusal::none},
      {window(south, rectangle(1.5, 2, 1, 2)), OpeningRefusal::meets_opening},        // overlaps the first
      {window(south, rectangle(1.2, 1.2, 0.5, 0.5)), OpeningRefusal::meets_opening},  // inside it
      {window(south, rectangle(2.01, 1, 1, 2)), OpeningRefusal::meets_opening},       // a centimetre beside it
      {window(south, rectangle(2.03, 1, 1, 2)), OpeningRefusal::none},
      {window(south, rectangle(19.5, 1, 1, 2)), OpeningRefusal::beyond_wall},
      {window(south, rectangle(10, 11, 1, 2)), OpeningRefusal::beyond_wall},
      {window(south, rectangle(10, 0, 1, 2)), OpeningRefusal::beyond_wall},  // on the ground's edge
      {window(south, rectangle(18.97, 5, 1, 2), 0.1),
       OpeningRefusal::none},  // near the corner, its reveal inside the house
      {window(south, rectangle(10, 5, 0.01, 2)), OpeningRefusal::bad_outline},
      {window(south, {{10, 5}, {11, 5}, {10, 6}, {11, 6}}), OpeningRefusal::bad_outline},  // a bow tie
      {window(south, {{10, 5}, {10, 6}, {11, 6}, {11, 5}}), OpeningRefusal::bad_outline},  // clockwise
      {window(south, {{10, NAN}, {11, 5}, {11, 6}}), OpeningRefusal::bad_outline},
      {window(south, rectangle(10, 5, 1, 2), 9.96), OpeningRefusal::wall_too_thin},  // through the north wall
      {window(west, rectangle(9.9, 1, 0.06, 1), 1.2),
       OpeningRefusal::meets_opening},  // its reveal enters the south wall's first
      {window(9, rectangle(1, 1, 1, 1)), OpeningRefusal::bad_outline},
  };
  std::vector<WallOpening> wanted;
  for (const auto& c : cases) wanted.push_back(c.first);
  wanted[14].outline = rectangle(walls[west].length - 0.2, 1, 0.15, 1);
  wanted[14].reveal = 1.5;
  wanted[0].reveal = 0.3;
  const OpenedSolid opened = cut_openings(solid, walls, wanted);
  for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_EQ(name(opened.refusals[i]), name(cases[i].second)) << i;
  EXPECT_EQ(validity(opened.solid), "none");
  EXPECT_EQ(opened.openings.size(), opened.given.size());
}

TEST(Openings, GableWindowsStayUnderTheSlope) {
  const Solid solid = house(polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}}), model::RoofShape::gabled, 6, 5);
  const auto walls = walls_of(solid);
  const std::uint32_t gable = facing(walls, {1, 0});
  ASSERT_NEAR(walls[gable].height, 11, 0.01);
  const std::vector<WallOpening> wanted{window(gable, rectangle(4.5, 7, 1, 1.5)),
                                        window(gable, rectangle(0.5, 7, 1, 1.5))};
  const OpenedSolid opened = cut_openings(solid, walls, wanted);
  EXPECT_EQ(opened.refusals[0], OpeningRefusal::none);
  EXPECT_EQ(opened.refusals[1], OpeningRefusal::beyond_wall);
  EXPECT_EQ(validity(opened.solid), "none");
}

TEST(Openings, ThinWingsKeepTheirWalls) {
  const Solid solid = house(polygon({{0, 0}, {20, 0}, {20, 0.5}, {0, 0.5}}));
  const auto walls = walls_of(solid);
  const std::uint32_t south = facing(walls, {0, -1}), north = facing(walls, {0, 1});
  const std::vector<WallOpening> wanted{
      window(south, rectangle(5, 1, 1, 2), 0.2), window(north, rectangle(14, 1, 1, 2), 0.2),
      window(north, rectangle(10, 1, 1, 2), 0.48), window(north, rectangle(1, 1, 1, 2), 0.2)};
  const OpenedSolid opened = cut_openings(solid, walls, wanted);
  EXPECT_EQ(opened.refusals[0], OpeningRefusal::none);
  EXPECT_EQ(opened.refusals[1], OpeningRefusal::meets_opening) << "back to back with the first";
  EXPECT_EQ(opened.refusals[2], OpeningRefusal::wall_too_thin);
  EXPECT_EQ(opened.refusals[3], OpeningRefusal::none);
  EXPECT_EQ(validity(opened.solid), "none");
}

TEST(Openings, APassageLeadsThrough) {
  for (const bool turn : {false, true}) {
    // The back is not parallel to the front.
    const Polygon straight = polygon({{0, 0}, {20, 0}, {20, 12}, {0, 10}});
    const Solid solid = house(turn ? turned(straight) : straight);
    const auto walls = walls_of(solid);
    const std::uint32_t front = 0, back = 2;
    std::vector<WallOpening> wanted(2);
    wanted[0] = {front, OpeningKind::passage, rectangle(8, 0.05, 3, 3.4), 0, 0, 1};
    wanted[1] = {back, OpeningKind::passage, rectangle(walls[back].length - 11.2, 0.05, 3, 3.4), 0, 0, 0};
    wanted.push_back(window(front, rectangle(9, 4, 1, 2)));  // above the passage
    wanted.push_back(window(front, rectangle(9, 1, 1, 1)));  // in its portal
    wanted.push_back(
        {1, OpeningKind::door, rectangle(4, 0.05, 1, 2), 12.5, 0, model::kNoOpening});  // from the side into the tunnel
    const OpenedSolid opened = cut_openings(solid, walls, wanted);
    EXPECT_EQ(opened.refusals[0], OpeningRefusal::none);
    EXPECT_EQ(opened.refusals[1], OpeningRefusal::none);
    EXPECT_EQ(opened.refusals[2], OpeningRefusal::none);
    EXPECT_EQ(opened.refusals[3], OpeningRefusal::meets_opening);
    EXPECT_EQ(opened.refusals[4], OpeningRefusal::meets_opening);
    EXPECT_EQ(validity(opened.solid), "none");
    EXPECT_EQ(cgal_validity(opened.solid), "");
    EXPECT_EQ(count(opened.solid, SurfaceKind::outer_floor), 1);
    EXPECT_EQ(count(opened.solid, SurfaceKind::outer_ceiling), 1);
    EXPECT_NEAR(volume(solid) - volume(opened.solid) - 1 * 2 * 0.15, 3 * 3.4 * 10.9, 1.5);
  }
}

TEST(Openings, PassagesThatDoNotFit) {
  const Solid solid = house(polygon({{0, 0}, {30, 0}, {30, 20}, {22, 20}, {22, 8}, {8, 8}, {8, 20}, {0, 20}}));
  const auto walls = walls_of(solid);
  std::vector<WallOpening> wanted(4);
  wanted[0] = {0, OpeningKind::passage, rectangle(2, 0.1, 3, 3), 0, 0,
               1};  // through the left wing's whole length and its back
  wanted[1] = {6, OpeningKind::passage, rectangle(2, 0.1, 3, 3), 0, 0, 0};
  wanted[2] = {0, OpeningKind::passage, rectangle(12, 0.1, 3, 3), 0, 0, 3};  // one storey higher at the other end
  wanted[3] = {4, OpeningKind::passage, rectangle(4, 3.1, 3, 3), 0, 0, 2};
  const OpenedSolid opened = cut_openings(solid, walls, wanted);
  EXPECT_EQ(opened.refusals[0], OpeningRefusal::none) << "long, but free";
  EXPECT_EQ(opened.refusals[2], OpeningRefusal::passage_blocked);
  EXPECT_EQ(opened.refusals[3], OpeningRefusal::passage_blocked);
  EXPECT_EQ(validity(opened.solid), "none");
}

/// The proof refuses what the judge refuses.
TEST(OpeningProof, FailsWhereTheSolidDoes) {
  const Solid solid = house(turned(polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}})));
  const auto walls = walls_of(solid);
  const auto known = *geometry::triangulate(solid);
  const OpenedSolid sound =
      cut_openings(solid, walls, std::vector{window(0, rectangle(4, 1, 1, 2)), window(0, arched(8, 1, 1, 2), 0)});
  ASSERT_EQ(sound.openings.size(), 2u);
  const auto triangles = geometry::triangulate(sound.solid, solid, known);
  ASSERT_TRUE(triangles);
  ASSERT_EQ(geometry::check_solid(sound.solid, *triangles).text(), "none");
  EXPECT_TRUE(proved_valid(sound, *triangles));
  const auto portal = sound.solid.loops_of(sound.solid.faces[walls[0].face])[1];
  const std::uint32_t corner = sound.solid.indices_of(portal)[0];
  const auto with = [&](std::uint32_t vertex, Point2 in_wall, double depth) {
    OpenedSolid out = sound;
    Point3& p = out.solid.vertices[vertex];
    const Point3 zero = walls[0].at({0, 0}), by = walls[0].at(in_wall, depth);
    p = model::snap(Point3{p.x + by.x - zero.x, p.y + by.y - zero.y, p.z + by.z - zero.z});
    EXPECT_NE(geometry::check_solid(out.solid, *triangles).text(), "none");
    return proved_valid(out, *triangles);
  };
  EXPECT_FALSE(with(corner, {0, 0}, 0.02)) << "a corner out of the wall's plane";
  EXPECT_FALSE(with(corner, {-6, 0}, 0)) << "a corner beyond the wall";
  EXPECT_FALSE(with(corner, {6, 0.5}, 0)) << "a corner in another opening";
  // A corner of the wall across comes through the wall with the openings.
  std::uint32_t across = 0;
  for (std::uint32_t v = 0; v < solid.vertices.size(); ++v) {
    const auto depth = [&](std::uint32_t i) {
      const Point2 out = walls[0].outward();
      return -(solid.vertices[i].x * out.x + solid.vertices[i].y * out.y) + solid.vertices[i].z * 1e-3;
    };
    if (depth(v) > depth(across)) across = v;
  }
  EXPECT_FALSE(with(across, {8, -5}, -11));
}

/// The same of solids whose borders got points: front, floor and the walls beside share them.
TEST(OpeningProof, FailsWhereABorderDoes) {
  std::vector<Point2> plan{{0, 0}, {40, 0}, {40, 10}, {0, 10}};
  for (Point2& p : plan) p = model::snap(Point2{0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y});
  OpenedSolid sound;
  for (int turn = 0; sound.changed_borders.empty() && turn < 40; ++turn) {
    for (Point2& p : plan) p = model::snap(Point2{0.99 * p.x - 0.14 * p.y, 0.14 * p.x + 0.99 * p.y});
    const Solid solid = house(polygon(plan));
    const auto walls = walls_of(solid);
    std::vector<WallOpening> wanted;
    for (double u = 1.5; u < 37; u += 2.6) wanted.push_back(window(0, rectangle(u, 0.03, 1.1, 2.2), 0.2));
    sound = cut_openings(solid, walls, wanted);
  }
  ASSERT_GE(sound.changed_borders.size(), 2u);
  const std::uint32_t first = sound.first_border_point;
  ASSERT_LT(first + 2, sound.solid.vertices.size());
  const auto judged = [](const OpenedSolid& out) {
    const auto triangles = geometry::triangulate(out.solid);
    const bool proved = triangles && proved_valid(out, *triangles);
    const bool valid = triangles && geometry::check_solid(out.solid, *triangles, geometry::kBuilt).valid();
    return std::pair(proved, valid);
  };
  EXPECT_EQ(judged(sound), std::pair(true, true));
  const Point3 away = sound.solid.vertices[first + 1], back = sound.solid.vertices[first];
  const auto with = [&](Point3 place) {
    OpenedSolid out = sound;
    out.solid.vertices[first] = model::snap(place);
    return judged(out);
  };
  EXPECT_EQ(with({back.x, back.y, back.z + 1}), std::pair(false, false)) << "a floor that is bent, a wall with a notch";
  EXPECT_EQ(with({back.x + 0.1, back.y + 0.1, back.z}), std::pair(false, false)) << "a wall that is bent";
  EXPECT_EQ(with(away), std::pair(false, false)) << "two points at one place";
  EXPECT_EQ(with(sound.solid.vertices[0]), std::pair(false, false)) << "a point at a corner";
  OpenedSolid folded = sound;
  folded.solid.vertices[first].z -= 8;  // plane, but the floor is not
  EXPECT_EQ(judged(folded), std::pair(false, false));
}

/// What has passages is proved where the solid with these alone was found valid, and is refused as others are.
TEST(OpeningProof, ReliesOnPassagesThatWereChecked) {
  const Solid solid = house(turned(polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}})));
  const auto walls = walls_of(solid);
  const std::vector<WallOpening> passage{{0, OpeningKind::passage, rectangle(8, 0.1, 3, 3), 0, 0, 1},
                                         {2, OpeningKind::passage, rectangle(9, 0.1, 3, 3), 0, 0, 0}};
  const OpenedSolid alone = cut_openings(solid, walls, passage);
  ASSERT_EQ(validity(alone.solid), "none");
  ASSERT_TRUE(alone.changed_borders.empty());
  std::vector<WallOpening> wanted = passage;
  wanted.push_back(window(0, rectangle(4, 1, 1, 2)));
  wanted.push_back(window(2, rectangle(4, 1, 1, 2)));
  const OpenedSolid opened = cut_openings(solid, walls, wanted);
  ASSERT_EQ(opened.openings.size(), 4u);
  const auto triangles = *geometry::triangulate(opened.solid);
  ASSERT_EQ(geometry::check_solid(opened.solid, triangles).text(), "none");
  EXPECT_FALSE(proved_valid(opened, triangles)) << "nothing is known of the passage";
  EXPECT_TRUE(proved_valid(opened, triangles, true));
  // The window's corner in the portal, and out of the wall's plane.
  const auto loops = opened.solid.loops_of(opened.solid.faces[walls[0].face]);
  const std::uint32_t corner = opened.solid.indices_of(loops[2])[0];
  for (const auto& [by, depth] : {std::pair(Point2{5, 0.5}, 0.0), std::pair(Point2{0, 0}, 0.05)}) {
    OpenedSolid broken = opened;
    Point3& p = broken.solid.vertices[corner];
    const Point3 zero = walls[0].at({0, 0}), to = walls[0].at(by, depth);
    p = model::snap(Point3{p.x + to.x - zero.x, p.y + to.y - zero.y, p.z + to.z - zero.z});
    EXPECT_NE(geometry::check_solid(broken.solid, triangles).text(), "none");
    EXPECT_FALSE(proved_valid(broken, triangles, true));
  }
}

/// Random windows on random houses: what is cut is valid, whatever was asked.
TEST(Openings, RandomHousesStayValid) {
  constexpr model::RoofShape kShapes[] = {model::RoofShape::flat, model::RoofShape::gabled, model::RoofShape::hipped,
                                          model::RoofShape::skillion, model::RoofShape::mansard};
  int cut = 0, houses = 0, validated = 0, proved = 0, with_passage = 0, passages_checked = 0, proved_with_passage = 0;
  std::map<OpeningRefusal, int> refused;
  for (std::uint64_t number = 0; number < 800; ++number) {
    const Polygon plan = random_plan(77, number);
    Random random(number);
    roofs::RoofRequest request;
    request.shape = kShapes[number % 5];
    request.measures = {kBase + 9, 3};
    const auto built = roofs::build_roof(plan, request);
    if (!built) continue;
    masses::EnvelopeMaterials looks;
    looks.wall.kind = SurfaceKind::wall;
    looks.roof.kind = SurfaceKind::roof;
    const Solid solid = masses::envelope(plan, kBase, built->roof, looks);
    if (validity(solid) != "none") continue;
    ++houses;
    const auto walls = walls_of(solid);
    std::vector<WallOpening> wanted;
    for (std::uint32_t w = 0; w < walls.size(); ++w)
      for (int i = 0; i < 12; ++i) {
        const double width = 0.04 + 2.5 * random.unit(), height = 0.1 + 2.5 * random.unit();
        const double u = random.unit() * walls[w].length - 0.2, v = random.unit() * walls[w].height - 0.2;
        WallOpening o = window(w, random.next(3) == 0 ? arched(u, v, width, height) : rectangle(u, v, width, height),
                               random.next(4) == 0 ? 0 : random.unit() * random.unit() * 2);
        if (random.next(5) == 0) o.kind = OpeningKind::door;
        wanted.push_back(std::move(o));
        if (random.next(8) == 0 && walls.size() > 2) {  // a passage to any wall
          const auto mine = static_cast<std::uint32_t>(wanted.size());
          const auto to = static_cast<std::uint32_t>(random.next(walls.size()));
          wanted.push_back({w, OpeningKind::passage, rectangle(u, 0.1, width, height), 0, 0, mine + 1});
          wanted.push_back(
              {to, OpeningKind::passage, rectangle(random.unit() * walls[to].length, 0.1, width, height), 0, 0, mine});
        }
      }
    const OpenedSolid opened = cut_openings(solid, walls, wanted);
    ASSERT_EQ(validity(opened.solid), "none") << number;
    const auto triangles = geometry::triangulate(opened.solid, solid, *geometry::triangulate(solid));
    ASSERT_TRUE(triangles) << number;
    ASSERT_EQ(triangles->triangles, geometry::triangulate(opened.solid)->triangles) << number;
    const bool has_passage = std::any_of(opened.openings.begin(), opened.openings.end(),
                                         [](const model::Opening& o) { return o.kind == OpeningKind::passage; });
    with_passage += has_passage;
    proved += proved_valid(opened, *triangles);
    if (has_passage) {
      std::vector<WallOpening> passages;
      for (const std::uint32_t i : opened.given) {
        if (wanted[i].kind != OpeningKind::passage) continue;
        passages.push_back(wanted[i]);  // portals follow each other
        passages.back().through =
            static_cast<std::uint32_t>(passages.size() % 2 == 1 ? passages.size() : passages.size() - 2);
      }
      const OpenedSolid alone = cut_openings(solid, walls, passages);
      const auto its = geometry::triangulate(alone.solid);
      if (alone.changed_borders.empty() && its && geometry::check_solid(alone.solid, *its, geometry::kBuilt).valid()) {
        ++passages_checked;
        proved_with_passage += proved_valid(opened, *triangles, true);
      }
    }
    if (number % 10 == 0) {
      ++validated;
      ASSERT_EQ(cgal_validity(opened.solid), "") << number;
    }
    cut += static_cast<int>(opened.openings.size());
    for (const OpeningRefusal r : opened.refusals) ++refused[r];
  }
  std::printf("%d houses (%d judged twice), %d openings cut", houses, validated, cut);
  for (const auto& [refusal, n] : refused) std::printf(", %s %d", std::string(name(refusal)).c_str(), n);
  std::printf("\n");
  // What is no prism is left to the judge; nearly everything else is proved.
  std::printf("%d proved, %d with passages\n", proved, with_passage);
  EXPECT_GT(proved, (houses - with_passage) * 99 / 100);
  EXPECT_LE(proved, houses - with_passage);
  std::printf("%d of %d with passages that were checked proved\n", proved_with_passage, passages_checked);
  EXPECT_GT(proved_with_passage, passages_checked * 9 / 10);
  EXPECT_GT(passages_checked, with_passage / 2);
  EXPECT_GT(houses, 600);
  EXPECT_GT(cut, 5000);
  for (int r = 0; r < kOpeningRefusalCount; ++r) EXPECT_GT(refused[static_cast<OpeningRefusal>(r)], 0) << r;
}

}  // namespace
}  // namespace blockrand::facades
