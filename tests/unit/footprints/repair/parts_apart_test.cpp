// Parts of one building share no ground: walls drawn twice, towers at walls, strips between them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/footprints/repair/parts_scene.h"

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

/// Edges of both that run the same line in opposite directions.
int common_walls(const Polygon& a, const Polygon& b) {
  int n = 0;
  for (std::size_t i = 0; i < a.outer.size(); ++i)
    for (std::size_t k = 0; k < b.outer.size(); ++k)
      n += a.outer.points[i] == b.outer.points[(k + 1) % b.outer.size()] &&
           a.outer.points[(i + 1) % a.outer.size()] == b.outer.points[k];
  return n;
}

TEST(PartsApart, WallsInPartDrawnOverEachOtherBecomeOne) {
  // Overlaps below half a square metre, at many angles: corners of one part on walls of another, a hair inside.
  for (int turn = 1; turn <= 12; ++turn) {
    SCOPED_TRACE(turn);
    const double slope = 0.013 * turn * turn, scale = 1 / std::sqrt(1 + slope * slope);
    const auto box = [&](double x0, double y0, double x1, double y1) {
      std::vector<Point2> out;
      for (const Point2 p : {Point2{x0, y0}, Point2{x1, y0}, Point2{x1, y1}, Point2{x0, y1}})
        out.push_back(model::snap(Point2{(p.x - slope * p.y) * scale, (slope * p.x + p.y) * scale}));
      return out;
    };
    Scene s(box(0, 0, 30, 12));
    RepairOptions options;
    options.share_walls = false;
    s.part(2, box(0, 0, 10.004, 12)).part(3, box(10, 0, 20, 5)).part(4, box(10.002, 5, 20.003, 12.0)).fit(options);
    const std::vector<std::string> ids = s.ids();
    for (std::size_t a = 0; a < ids.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) EXPECT_EQ(s.common(ids[a], ids[b]), 0) << ids[a] << " and " << ids[b];
    EXPECT_GE(common_walls(s.plan("w1.w2"), s.plan("w1.w3")), 1);
    EXPECT_GE(common_walls(s.plan("w1.w2"), s.plan("w1.w4")), 1);
    EXPECT_NEAR(s.area("w1.w2") + s.area("w1.w3") + s.area("w1.w4"), 240, 0.1);
  }
}

/// No two plans have ground in common, and none almost touches itself.
void expect_apart(const Scene& s) {
  for (std::size_t a = 0; a < s.building.parts.size(); ++a) {
    EXPECT_TRUE(geometry::rings_apart(s.building.parts[a].plan)) << s.building.parts[a].id;
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_EQ(s.common(s.building.parts[a].id, s.building.parts[b].id), 0)
          << s.building.parts[a].id << " and " << s.building.parts[b].id;
  }
}

TEST(PartsApart, ATowerWhoseCornerReachesTheWallAroundIt) {
  // Berlin 2014, w233890595 in metres from (399540, 5825310): a corner of the tower 601 goes to the common wall of 597 and
  // 600, so that what is left of 600 would touch itself there.
  const std::vector<Point2>
      block = {{-0.2227, 22.6826}, {10.8916, 29.6865}, {15.4912, 33.1084}, {23.2314, 22.7568}, {18.7695, 19.4326}},
      inner = {{16.3809, 22.6191}, {13.7666, 25.0547}, {10.8857, 23.4551}, {8.2676, 21.4062}, {6.2832, 18.8770}},
      bow = {{20.1904, 15.9980}, {20.5371, 11.0957}, {19.3984, 6.1338}, {17.2588, 2.3164}, {14.2227, -0.5811},
             {9.8271, -2.9834},  {6.1045, 1.2666},   {4.0322, 6.3379},  {3.6973, 11.4863}, {4.8584, 15.8574}},
      tower = {{8.7422, 13.1514},  {9.3076, 18.2695},  {10.2500, 18.2500}, {10.5498, 21.9385},
               {17.0029, 21.2158}, {16.3633, 13.8740}, {13.6719, 14.1963}, {13.4775, 12.6758}};
  const auto together = [](std::initializer_list<std::vector<Point2>> pieces) {
    std::vector<Point2> out;
    for (const auto& piece : pieces)
      for (const Point2 p : piece) out.push_back(model::snap(p));
    return out;
  };
  Scene s(together({block, bow}));
  s.part(597, together({{bow.back()}, block, inner}), {{}, {}, 11.0f, 3.0f})
      .part(600, together({{block.back()}, bow, {inner.rbegin(), inner.rend()}}), {{}, {}, 14.0f, {}})
      .part(601, together({tower}), {{}, {}, 15.0f, {}})
      .fit();
  EXPECT_EQ(s.ids(), (Ids{"w1.w597", "w1.w600", "w1.w601"}));
  expect_apart(s);
}

TEST(PartsApart, TowersAtTheWallOfACourtHouse) {
  // A tower in a house, its corner on the house's wall, just inside or just outside of it, with a part on the other side of
  // the wall: at any angle nothing overlaps, and each keeps its ground.
  Random random(5);
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE(round);
    const double angle = 2 * std::acos(-1) * random.unit(), c = std::cos(angle), sn = std::sin(angle);
    const auto turned = [&](std::vector<Point2> points) {
      for (Point2& p : points) p = model::snap(Point2{c * p.x - sn * p.y, sn * p.x + c * p.y});
      return points;
    };
    const double off = round % 8 < 2 ? 0 : 0.5 * random.unit() - 0.1, size = 2 + 3 * random.unit(),
                 spread = 0.3 + 0.5 * random.unit(), at = 6 + 8 * random.unit();
    const auto tower =
        turned({{at, 12 - off}, {at - spread * size, 12 - off - size}, {at + spread * size, 12 - off - size}});
    Scene s(turned({{0, 0}, {20, 0}, {20, 18}, {0, 18}}));
    s.part(2, turned({{0, 0}, {20, 0}, {20, 12}, {0, 12}}));
    if (round % 2 == 1) {
      // The tower's ground is a court of the house.
      s.building.parts.back().rings.rings.push_back(ring(tower));
      s.building.parts.back().rings.inner.push_back(true);
    }
    s.part(3, turned({{0, 12}, {20, 12}, {20, 18}, {0, 18}})).part(4, tower).fit();
    expect_apart(s);
    double sum = 0;
    for (const BuildingPart& part : s.building.parts) sum += geometry::area(part.plan);
    EXPECT_NEAR(sum, 360, 0.5);
  }
}

TEST(PartsApart, ATowerWhoseWallIsAlmostTheOutlines) {
  // Berlin 2014, r29971 in metres from (396300, 5818400): of 13 storeys, its towers of 14. One corner of the tower 687 is
  // the outline's, the other lies 3 cm inside of it.
  Scene s({{59.6025, 32.1924},
           {63.3438, 34.8965},
           {67.6611, 38.0654},
           {70.0820, 39.8506},
           {76.7861, 44.7715},
           {97.0107, 56.8203},
           {98.9346, 57.9561},
           {102.2754, 59.5430},
           {106.9766, 61.7930},
           {110.0811, 63.2949},
           {112.4902, 80.5918},
           {87.1162, 67.7090},
           {63.6182, 53.0059},
           {38.8818, 33.5781},
           {52.9209, 27.2500}});
  s.part(685, {{97.6523, 68.6094}, {102.2744, 59.5400}, {110.0811, 63.2949}, {105.3877, 72.5293}}, {{}, {}, 14.0f, {}})
      .part(687, {{57.1836, 43.5254}, {63.3604, 34.9326}, {70.0820, 39.8506}, {63.9893, 48.3691}}, {{}, {}, 14.0f, {}})
      .fit();
  EXPECT_EQ(s.ids(), (Ids{"w1.w685", "w1.w687", "w1.rest"}));
  expect_apart(s);
  // Nothing is opened or bent for it: the towers keep their corners, the rest has no staircase.
  for (const BuildingPart& part : s.building.parts) EXPECT_LE(part.plan.outer.size(), part.rest ? 20u : 6u) << part.id;
}

TEST(PartsApart, TowersWhoseWallsAreAlmostTheOutlines) {
  // One corner on the outline or beyond, the other a little off it; the outline has a corner between the two.
  Random random(7);
  for (int round = 0; round < 3000; ++round) {
    SCOPED_TRACE(round);
    const double angle = 2 * std::acos(-1) * random.unit(), c = std::cos(angle), sn = std::sin(angle);
    const auto turned = [&](std::vector<Point2> points) {
      for (Point2& p : points) p = model::snap(Point2{c * p.x - sn * p.y, sn * p.x + c * p.y});
      return points;
    };
    const double at = 4 + 8 * random.unit(), wide = 4 + 6 * random.unit(), bend = 0.1 * random.unit() - 0.05,
                 off = 0.1 * random.unit() - 0.02, start = round % 3 == 0 ? 0 : 0.04 * random.unit() - 0.02;
    Scene s(
        turned({{0, 0}, {at, 0}, {at + wide * random.unit(), bend}, {at + wide, off / 4}, {30, 0}, {30, 15}, {0, 15}}));
    s.part(2, turned({{at, start}, {at + wide, off}, {at + wide, 6}, {at, 6}})).fit();
    EXPECT_EQ(s.ids(), (Ids{"w1.w2", "w1.rest"}));
    expect_apart(s);
    double sum = 0;
    for (const BuildingPart& part : s.building.parts) sum += geometry::area(part.plan);
    EXPECT_NEAR(sum, geometry::area(s.building.outline[0]), 1.2);
  }
}

TEST(PartsApart, PartsOneAboveTheOtherStayAsTheyAre) {
  Scene s({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  s.part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {10.0f, {}, {}, {}})
      .part(3, {{0.003, 2}, {8, 2}, {8, 8}, {0.003, 8}}, {30.0f, 10.0f, {}, {}})
      .fit();
  EXPECT_NEAR(s.common("w1.w2", "w1.w3"), s.area("w1.w3"), 1e-9);
}

TEST(PartsApart, OfASmallThingSmallPiecesStay) {
  // A cross on a spire: the post divides the crossbar into pieces of which none would be worth a part of a house.
  Scene s({{0, 0}, {8, 0}, {8, 8}, {0, 8}});
  s.part(2, {{3.8, 3.8}, {4.2, 3.8}, {4.2, 4.2}, {3.8, 4.2}}, {41.0f, 37.0f, {}, {}})
      .part(3, {{3, 3.9}, {5, 3.9}, {5, 4.1}, {3, 4.1}}, {40.2f, 39.8f, {}, {}})
      .fit();
  EXPECT_EQ(s.common("w1.w2", "w1.w3.1") + s.common("w1.w2", "w1.w3.2"), 0);
  EXPECT_NEAR(s.area("w1.w2"), 0.16, 0.01);
  EXPECT_NEAR(s.area("w1.w3.1") + s.area("w1.w3.2"), 0.32, 0.02);
}

}  // namespace
}  // namespace blockrand::repair
