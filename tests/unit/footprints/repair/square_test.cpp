#include "pipeline/footprints/repair/square.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/unit/footprints/repair/square_town.h"

namespace blockrand::repair {
namespace {

using model::Point2;
using namespace test;

Town::Score houses(double noise, int count, double degrees_of_all = -1) {
  Town::Score total;
  for (int i = 0; i < count; ++i) {
    Town town(static_cast<unsigned>(i + 1));
    add_house(town, {0, 0}, i % 5);
    town.disturb(noise, degrees_of_all >= 0 ? degrees_of_all : between(town.random(), 0, 90));
    town.square();
    total += town.score();
  }
  return total;
}
Town::Score rows(double noise, int count) {
  Town::Score total;
  for (int i = 0; i < count; ++i) {
    Town town(static_cast<unsigned>(i + 1));
    add_row(town, {100, 50}, 3 + i % 12);
    town.disturb(noise, between(town.random(), 0, 90));
    town.square();
    total += town.score();
  }
  return total;
}
void print(const char* what, double noise, const Town::Score& s) {
  std::printf(
      "%s noise %.2f: right %.2f %% of %d, obliques squared %.2f %% of %d, error %.4f -> %.4f, max shift %.3f\n", what,
      noise, 100.0 * s.restored / std::max(1, s.right), s.right, 100.0 * s.squared / std::max(1, s.obliques),
      s.obliques, s.error_before / s.corners, s.error / s.corners, s.shift);
}

TEST(SquareRow, RestoresFreeStandingHouses) {
  for (const double noise : {0.0, 0.02, 0.05, 0.1, 0.2, 0.3}) {
    const Town::Score s = houses(noise, 1000);
    print("houses", noise, s);
    EXPECT_GE(s.restored, 0.96 * s.right) << noise;
    EXPECT_LE(s.squared, 0.005 * s.obliques) << noise;
    EXPECT_LE(s.shift, 0.5) << noise;
    if (noise > 0) {
      EXPECT_LE(s.error, 0.8 * s.error_before) << noise;
    } else {
      EXPECT_LE(s.shift, 0.001);
    }
  }
}

TEST(SquareRow, RestoresRows) {
  for (const double noise : {0.0, 0.02, 0.05, 0.1, 0.2, 0.3}) {
    const Town::Score s = rows(noise, 150);
    print("rows", noise, s);
    EXPECT_GE(s.restored, 0.97 * s.right) << noise;
    EXPECT_LE(s.squared, 0.005 * s.obliques) << noise;
    EXPECT_LE(s.shift, 0.5) << noise;
    if (noise > 0) {
      EXPECT_LE(s.error, 0.65 * s.error_before) << noise;
    } else {
      EXPECT_LE(s.shift, 0.001);
    }
  }
}

TEST(SquareRow, BentRowsStayBent) {
  // From 5 cm of noise on, a bend of 1 to 3 degrees per house can no longer be told from noise.
  for (const double noise : {0.0, 0.01, 0.03, 0.1, 0.3}) {
    Town::Score total;
    for (int i = 0; i < 100; ++i) {
      Town town(static_cast<unsigned>(i + 1));
      add_bent_row(town, 4 + i % 8);
      town.disturb(noise, between(town.random(), 0, 90));
      town.square();
      total += town.score();
    }
    print("bent rows", noise, total);
    EXPECT_LE(total.shift, 0.5);
    if (noise == 0) {
      EXPECT_LE(total.shift, 0.001);
    } else if (noise == 0.01) {
      EXPECT_LE(total.error, total.error_before);
    }
  }
}

/// One building of these points, disturbed and squared.
Town one(const std::vector<Point2>& points, double noise, unsigned seed, double degrees = 0) {
  Town town(seed);
  town.add(std::vector<Town::Point>(points.begin(), points.end()));
  town.disturb(noise, degrees);
  town.square();
  return town;
}
/// Largest distance of a corner from the truth.
double worst_error(const Town& town) {
  double most = 0;
  for (std::size_t i = 0; i < town.truth.size(); ++i) most = std::max(most, distance(town.position(i), town.truth[i]));
  return most;
}
double angle_off_right(const Town& town, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return Town::off_right(town.position(a), town.position(b), town.position(c));
}

TEST(SquareRow, MakesAnAlmostRightHouseRight) {
  Town town;
  town.add({{0, 0}, {10, 0}, {10, 8}, {0, 8}});
  town.disturb(0);
  town.graph.corners[2].start = town.graph.corners[2].position = town.graph.corners[2].said[0] = {10.1, 7.95};
  town.square();
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_LE(angle_off_right(town, i, (i + 1) % 4, (i + 2) % 4), 0.02);
  EXPECT_LE(town.max_shift(), 0.1);
  EXPECT_NEAR(std::fabs(std::remainder(town.direction[0], 90)), 0, 0.5);
}

TEST(SquareRow, TellsTheBearingOfTheMainWalls) {
  // Longer walls run 20 degrees counter-clockwise from east: 70 degrees clockwise from north.
  const Town town = one({{0, 0}, {20, 0}, {20, 8}, {0, 8}}, 0, 1, 20);
  EXPECT_NEAR(town.direction[0], 70, 0.01);
  // Nothing square about a triangle.
  EXPECT_EQ(one({{0, 0}, {20, 0}, {7, 11}}, 0, 1).direction[0], -1);
}

TEST(SquareRow, LeavesObliqueWallsOblique) {
  // Walls 6 degrees off (8 m), and 30 degrees off.
  for (const double degrees : {6.0, 30.0}) {
    int squared = 0;
    const double rise = 8 * std::tan(degrees * kPi / 180);
    for (unsigned seed = 0; seed < 100; ++seed) {
      const Town town = one({{0, 0}, {20 + rise, 0}, {20, 8}, {0, 8}}, 0.2, seed, 13.0 * seed);
      squared += angle_off_right(town, 0, 1, 2) <= 0.1 || angle_off_right(town, 1, 2, 3) <= 0.1;
    }
    EXPECT_EQ(squared, 0) << degrees;
  }
}

TEST(SquareRow, LeavesBaysChamfersAndPolygonsAsTheyAre) {
  const std::vector<std::vector<Point2>> plans = {
      {{0, 0}, {8, 0}, {8.6, -1}, {10.4, -1}, {11, 0}, {20, 0}, {20, 11}, {0, 11}},  // a bay, cheeks 31 degrees off
      {{0, 0}, {17, 0}, {20, 3}, {20, 12}, {0, 12}},                                 // a chamfer of 45 degrees
      {{0, 0}, {18.8, 0}, {20, 1.2}, {20, 12}, {0, 12}},                             // a small one
      {{3, 0}, {6, 0}, {9, 3}, {9, 6}, {6, 9}, {3, 9}, {0, 6}, {0, 3}},              // an octagon, not quite regular
  };
  for (std::size_t k = 0; k < plans.size(); ++k) {
    double error = 0;
    for (unsigned seed = 0; seed < 50; ++seed)
      error = std::max(error, worst_error(one(plans[k], 0.05, seed, 7.0 * seed)));
    EXPECT_LE(error, 0.12) << k;  // a cheek or chamfer made right would move by half a metre
    EXPECT_LE(worst_error(one(plans[k], 0, 1, 23)), 0.001) << k;
  }
}

TEST(SquareRow, LeavesRoundTowersAndRoundedCornersRound) {
  std::vector<Point2> tower, corner{{0, 0}};
  for (int i = 0; i < 16; ++i) tower.push_back({5 * std::cos(i * kPi / 8), 5 * std::sin(i * kPi / 8)});
  for (int i = 0; i <= 6; ++i)
    corner.push_back({16 + 4 * std::cos((i - 6) * kPi / 12), 4 + 4 * std::sin((i - 6) * kPi / 12)});
  corner.push_back({20, 15}), corner.push_back({0, 15});
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Town round = one(tower, 0.02, seed);
    EXPECT_LE(round.max_shift(), 0.001);
    EXPECT_EQ(round.direction[0], -1);
    const Town house = one(corner, 0.02, seed, 11.0 * seed);
    EXPECT_LE(worst_error(house), 0.05);
    EXPECT_LE(angle_off_right(house, 9, 0, 1), 0.1);  // its other corners are right
  }
}

TEST(SquareRow, AWingAtAnAngleHasAFrameOfItsOwn) {
  // A wing turned by 25 degrees on a house's end: both come back right within themselves.
  const auto wing = [](double x, double y) {
    const Point2 p = turned({x, y}, 25);
    return Point2{p.x + 20, p.y};
  };
  const std::vector<Point2> plan = {{0, 0}, {20, 0}, wing(14, 0), wing(14, 9), wing(4, 9), {16, 10}, {0, 10}};
  int right = 0, all = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Town town = one(plan, 0.1, seed, 9.0 * seed);
    all += 4;
    right += angle_off_right(town, 6, 0, 1) <= 0.1;
    right += angle_off_right(town, 5, 6, 0) <= 0.1;
    right += angle_off_right(town, 1, 2, 3) <= 0.1;
    right += angle_off_right(town, 2, 3, 4) <= 0.1;
  }
  EXPECT_GE(right, 0.9 * all);
}

TEST(SquareRow, WallsOfObliqueLotsBecomeParallel) {
  // Party walls at 75 degrees to the street: no house's frame has them, but the row does.
  Town town;
  for (int i = 0; i < 8; ++i) town.add({{i * 10.0, 0}, {i * 10.0 + 10, 0}, {i * 10.0 + 13, 11}, {i * 10.0 + 3, 11}});
  town.disturb(0.1, 31);
  town.square();
  // The end walls, which only one house tells of, may be too far off.
  std::vector<double> slopes;
  for (const TerraceRing& ring : town.graph.rings) {
    const Point2 a = town.position(ring.corners[0]), b = town.position(ring.corners[3]);
    slopes.push_back(std::atan2(b.y - a.y, b.x - a.x) * 180 / kPi);
  }
  std::sort(slopes.begin(), slopes.end());
  const double middle = slopes[4];
  EXPECT_GE(std::count_if(slopes.begin(), slopes.end(), [&](double s) { return std::fabs(s - middle) <= 0.03; }), 6);
  EXPECT_NEAR(middle, 31 + std::atan2(11, 3) * 180 / kPi, 0.2);
}

TEST(SquareRow, PiecesOfAWallStayInLine) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Town town(seed);
    add_row(town, {0, 0}, 9);
    town.disturb(0.2, 5.0 * seed);
    town.square();
    for (const TerraceRing& ring : town.graph.rings) {
      const std::size_t n = ring.corners.size();
      for (std::size_t i = 0; i < n; ++i) {
        if (ring.wall[i] != ring.wall[(i + n - 1) % n]) continue;
        const Point2 a = town.position(ring.corners[(i + n - 1) % n]), b = town.position(ring.corners[i]),
                     c = town.position(ring.corners[(i + 1) % n]);
        const double off = ((c.x - a.x) * (b.y - a.y) - (c.y - a.y) * (b.x - a.x)) / distance(a, c);
        EXPECT_LE(std::fabs(off), 0.0015);  // rounding to the grid
      }
    }
  }
}

TEST(SquareRow, FixedCornersStay) {
  Town town(3);
  add_row(town, {0, 0}, 8);
  town.disturb(0.2, 17);
  for (std::size_t i = 0; i < town.graph.corners.size(); i += 5) town.graph.corners[i].fixed = true;
  std::vector<double> direction;
  square_terrace_row(town.graph, town.row, {}, direction);
  int moved = 0;
  for (const Corner& c : town.graph.corners) {
    if (c.fixed) {
      EXPECT_EQ(c.position, c.start);
    } else {
      moved += distance(c.position, c.start) > 0.001;
    }
  }
  EXPECT_GT(moved, 5);
}

TEST(SquareRow, NeverMovesFartherThanTheBound) {
  for (const double noise : {0.3, 0.6}) {
    for (unsigned seed = 1; seed <= 100; ++seed) {
      Town town(seed);
      add_row(town, {0, 0}, 7);
      town.disturb(noise, 3.0 * seed);
      RepairOptions options;
      options.max_shift = 0.25;
      std::vector<double> direction;
      square_terrace_row(town.graph, town.row, options, direction);
      for (const Corner& c : town.graph.corners) {
        if (c.said.empty()) {
          EXPECT_LE(distance(c.position, c.start), 0.25);
        }
        // Sharing may have moved a corner farther already.
        for (const Point2 p : c.said) EXPECT_LE(distance(c.position, p), std::max(0.25, distance(c.start, p) + 1e-6));
      }
    }
  }
}

TEST(SquareRow, TurnsWithTheRow) {
  Town still(9), turning(9);
  for (Town* town : {&still, &turning}) {
    add_row(*town, {0, 0}, 10);
    town->disturb(0.2, 4);
  }
  for (Corner& c : turning.graph.corners) {
    c.start = c.position = turned(c.start, 37);
    for (Point2& p : c.said) p = turned(p, 37);
  }
  still.square();
  turning.square();
  for (std::size_t i = 0; i < still.graph.corners.size(); ++i)
    EXPECT_LE(distance(turned(still.position(i), 37), turning.position(i)), 0.002);
}

TEST(SquareRow, DependsNeitherOnTheOrderNorOnWhereRingsStart) {
  Town town(5);
  add_row(town, {0, 0}, 9);
  town.disturb(0.2, 40);
  // Corners, buildings and rings in another order.
  TerraceGraph other;
  TerraceRow row;
  const auto corners = static_cast<std::uint32_t>(town.graph.corners.size());
  const auto place = [&](std::uint32_t c) { return (c * 7 + 3) % corners; };
  ASSERT_NE(corners % 7, 0u);
  other.corners.resize(corners);
  for (std::uint32_t c = 0; c < corners; ++c) {
    other.corners[place(c)] = town.graph.corners[c];
    std::reverse(other.corners[place(c)].said.begin(), other.corners[place(c)].said.end());
  }
  for (std::size_t r = town.graph.rings.size(); r-- > 0;) {
    TerraceRing ring = town.graph.rings[r];
    ring.building = static_cast<std::uint32_t>(row.buildings.size());
    row.buildings.push_back(town.row.buildings[r]);
    for (std::uint32_t& c : ring.corners) c = place(c);
    std::rotate(ring.corners.begin(), ring.corners.begin() + 2, ring.corners.end());
    std::rotate(ring.wall.begin(), ring.wall.begin() + 2, ring.wall.end());
    other.rings.push_back(ring);
  }
  std::vector<double> direction;
  square_terrace_row(other, row, {}, direction);
  town.square();
  for (std::uint32_t c = 0; c < corners; ++c)
    EXPECT_EQ(model::snap(other.corners[place(c)].position), town.position(c));
  for (std::size_t b = 0; b < direction.size(); ++b)
    EXPECT_NEAR(direction[direction.size() - 1 - b], town.direction[b], 1e-9);
}

TEST(SquareRow, RowsThatHaveNothingInCommonDoNotKnowOfEachOther) {
  Town both(4), alone(4);
  for (Town* town : {&both, &alone}) {
    add_row(*town, {0, 0}, 6);
    if (town == &both) add_house(*town, {500, 0}, 3);
  }
  alone.disturb(0.2, 10);
  both.disturb(0.2, 10);
  for (std::size_t i = 0; i < alone.graph.corners.size(); ++i) both.graph.corners[i] = alone.graph.corners[i];
  alone.square();
  both.square();
  for (std::size_t i = 0; i < alone.graph.corners.size(); ++i) EXPECT_EQ(both.position(i), alone.position(i));
}

}  // namespace
}  // namespace blockrand::repair
