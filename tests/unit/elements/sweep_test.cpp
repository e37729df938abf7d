// Sweeps: lengths, volumes, mitres at all kinds of corners, interruptions, ends, brackets.
#include "styles/elements/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/base/random.h"
#include "tests/unit/elements/element_checks.h"
#include "tests/unit/elements/mesh_measures.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using model::Point3;

/// A band 0.1 m out of the wall and 0.2 m high: its volume is length * (0.1 + kApart) * 0.2 where nothing is mitred.
Profile band() { return {{{0, 0}, {0.1, 0}, {0.1, 0.2}, {0, 0.2}}, 0}; }

double volume(const ElementMesh& mesh) {
  double sum = 0;
  for (const auto& body : checks::bodies(mesh)) {
    EXPECT_TRUE(body.closed);
    EXPECT_EQ(checks::solid_defect(mesh, body), "none");
    const double v = checks::volume(mesh, body);
    EXPECT_GT(v, 0);
    sum += v;
  }
  EXPECT_EQ(checks::faces_wrong(mesh), "");
  return sum;
}

/// Area of the strip from kApart inside the wall to 0.1 m outside of it, along a closed chain: by the offset polygons.
constexpr double kWide = 0.1 + kApart;

TEST(Sweep, StraightRunStandsInTheElementFrame) {
  const std::vector<Point2> chain{{-1, 0}, {1, 0}};
  SweepOptions options;
  options.base = 3;
  const auto made = sweep(band(), chain, false, options);
  ASSERT_TRUE(made.has_value());
  EXPECT_NEAR(volume(made->mesh), 2 * kWide * 0.2, 1e-9);
  EXPECT_EQ(made->mesh.faces.size(), 6u);
  EXPECT_DOUBLE_EQ(made->length, 2);
  const Bounds3 box = bounds_of(made->mesh);
  EXPECT_EQ(box.least, (Point3{-1, 3, -kApart}));
  EXPECT_EQ(box.most, (Point3{1, 3.2, 0.1}));
  EXPECT_TRUE(made->unmitred.empty());
}

TEST(Sweep, WallOnTheRightIsTheOtherSide) {
  const std::vector<Point2> chain{{-1, 0}, {1, 0}};
  SweepOptions options;
  options.wall = WallSide::right;
  const auto made = sweep(band(), chain, false, options);
  ASSERT_TRUE(made.has_value());
  EXPECT_NEAR(volume(made->mesh), 2 * kWide * 0.2, 1e-9);
  EXPECT_NEAR(bounds_of(made->mesh).least.z, -0.1, 1e-12);
}

TEST(Sweep, ClosedChainIsOneBodyWithMitres) {
  const std::vector<Point2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const auto made = sweep(band(), square, true);
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(checks::bodies(made->mesh).size(), 1u);
  EXPECT_EQ(made->mesh.faces.size(), 16u);
  EXPECT_NEAR(volume(made->mesh), (4.2 * 4.2 - (4 - 2 * kApart) * (4 - 2 * kApart)) * 0.2, 1e-9);
}

TEST(Sweep, ReEntrantCornersTakeTheMouldingBack) {
  // A court: the wall round an inner yard runs clockwise.
  const std::vector<Point2> court{{0, 0}, {0, 4}, {4, 4}, {4, 0}};
  const auto made = sweep(band(), court, true);
  ASSERT_TRUE(made.has_value());
  const double inner = 4 - 0.2, outer = 4 + 2 * kApart;
  EXPECT_NEAR(volume(made->mesh), (outer * outer - inner * inner) * 0.2, 1e-9);
  // Avant-corps: out by 0.5, along, back.
  const std::vector<Point2> facade{{0, 0}, {3, 0}, {3, -0.5}, {5, -0.5}, {5, 0}, {8, 0}};
  const auto broken = sweep(band(), facade, false);
  ASSERT_TRUE(broken.has_value());
  EXPECT_TRUE(broken->unmitred.empty());
  EXPECT_NEAR(volume(broken->mesh), 9 * kWide * 0.2, 1e-9) << "what convex corners give, re-entrant ones take";
}

TEST(Sweep, MitresFollowTheBisectorAtAnyAngle) {
  for (int degrees = -170; degrees <= 170; degrees += 5) {
    if (degrees == 0) continue;
    const auto turned = base::sin_cos(degrees * base::kRadiansPerDegree);
    const std::vector<Point2> chain{{-6, 0}, {0, 0}, {6 * turned.cos, 6 * turned.sin}};
    const auto made = sweep(band(), chain, false);
    ASSERT_TRUE(made.has_value()) << degrees;
    const double v = volume(made->mesh);
    const double half_tangent = std::tan(std::fabs(degrees) * base::kRadiansPerDegree / 2);
    // The corner's kite: outwards it adds (convex, left turns) or takes (re-entrant), inwards the reverse.
    const double sign = degrees > 0 ? 1 : -1;
    const double mitred = (12 * kWide + sign * half_tangent * (0.1 * 0.1 - kApart * kApart)) * 0.2;
    if (degrees > 0 && 1 / std::cos(degrees * base::kRadiansPerDegree / 2) > 3)
      EXPECT_LT(v, mitred) << degrees << " is cut off";
    else
      EXPECT_NEAR(v, mitred, 1e-9) << degrees;
    const Bounds3 box = bounds_of(made->mesh);
    EXPECT_LT(box.most.x, 6.2) << degrees << ": no spike";
    EXPECT_TRUE(made->unmitred.empty()) << degrees;
  }
}

TEST(Sweep, WallsThatFoldBackEndInsteadOfMeeting) {
  const std::vector<Point2> chain{{0, 0}, {5, 0}, {0, 0.05}};
  const auto made = sweep(band(), chain, false);
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(made->unmitred, std::vector<std::size_t>{1});
  EXPECT_EQ(checks::bodies(made->mesh).size(), 2u);
}

TEST(Sweep, WallsTooShortForTheirMitresSaySo) {
  // A notch 0.15 m wide with a moulding 0.1 m out: its end wall has no room between two re-entrant corners.
  const std::vector<Point2> chain{{0, 0}, {3, 0}, {3, 1}, {3.15, 1}, {3.15, 0}, {6, 0}};
  const auto made = sweep(band(), chain, false);
  ASSERT_TRUE(made.has_value());
  ASSERT_EQ(made->unmitred.size(), 1u);
  EXPECT_TRUE(made->unmitred[0] == 2 || made->unmitred[0] == 3);
  EXPECT_GT(volume(made->mesh), 0);
}

TEST(Sweep, PointsOnStraightWallsAreNoCorners) {
  const std::vector<Point2> chain{{0, 0}, {1, 0}, {1, 0}, {2, 0.0004}, {3, 0}};
  const auto made = sweep(band(), chain, false);
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(made->mesh.faces.size(), 6u);
}

TEST(Sweep, InterruptionsCutRunsAndKeepTheRest) {
  const std::vector<Point2> chain{{0, 0}, {4, 0}, {4, 6}};
  const std::vector<std::pair<double, double>> gaps{{1, 2}, {1.5, 2.5}, {6, 7}, {-3, 0}, {9.9, 99}};
  SweepOptions options;
  options.interruptions = gaps;
  const auto made = sweep(band(), chain, false, options);
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(checks::bodies(made->mesh).size(), 3u);
  EXPECT_NEAR(made->length, 1 + 3.5 + 2.9, 1e-9);
  EXPECT_NEAR(volume(made->mesh), (7.4 * kWide + 0.1 * 0.1 - kApart * kApart) * 0.2, 1e-9);
  const std::vector<std::pair<double, double>> all{{0, 10}};
  options.interruptions = all;
  EXPECT_FALSE(sweep(band(), chain, false, options).has_value());
}

TEST(Sweep, RunsOverTheSeamOfAClosedChainAreOne) {
  const std::vector<Point2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const std::vector<std::pair<double, double>> gaps{{5, 6}};
  SweepOptions options;
  options.interruptions = gaps;
  const auto made = sweep(band(), square, true, options);
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(checks::bodies(made->mesh).size(), 1u);
  EXPECT_NEAR(made->length, 15, 1e-9);
  EXPECT_NEAR(volume(made->mesh), (15 * kWide + 4 * (0.1 * 0.1 - kApart * kApart)) * 0.2, 1e-9);
}

TEST(Sweep, ReturnedEndsDieIntoTheWall) {
  const std::vector<Point2> chain{{-1, 0}, {1, 0}};
  SweepOptions options;
  options.ends = RunEnd::returned;
  const auto made = sweep(band(), chain, false, options);
  ASSERT_TRUE(made.has_value());
  EXPECT_GT(volume(made->mesh), 0);
  const Bounds3 box = bounds_of(made->mesh);
  EXPECT_NEAR(box.least.x, -1.1, 1e-9);
  EXPECT_NEAR(box.most.x, 1.1, 1e-9);
  // Beside an interruption the return stays out of it.
  const std::vector<std::pair<double, double>> gaps{{0.8, 1.2}};
  options.interruptions = gaps;
  const auto interrupted = sweep(band(), chain, false, options);
  ASSERT_TRUE(interrupted.has_value());
  for (const Point3& p : interrupted->mesh.vertices) EXPECT_TRUE(p.x <= -0.2 + 1e-9 || p.x >= 0.2 - 1e-9) << p.x;
}

/// Four runs with mitred ends are the ring that one sweep round the corners makes, outside and in a court.
TEST(Sweep, EndsOnTheBisectorMeetTheNextWall) {
  const std::vector<Point2> side{{-2, 0}, {2, 0}};
  for (const double turn : {90.0, -90.0}) {
    SweepOptions options;
    options.start_turn = options.last_turn = turn;
    options.ends = RunEnd::returned;  // the turns are stronger
    const auto run = sweep(band(), side, false, options);
    ASSERT_TRUE(run.has_value());
    std::vector<Point2> chain{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    if (turn < 0) std::reverse(chain.begin(), chain.end());
    const auto ring = sweep(band(), chain, true);
    ASSERT_TRUE(ring.has_value());
    EXPECT_NEAR(4 * volume(run->mesh), volume(ring->mesh), 1e-9);
    const double reach = turn > 0 ? 0.1 : -0.1;
    for (const Point3& p : run->mesh.vertices)
      if (std::fabs(p.z - 0.1) < 1e-9) {
        EXPECT_NEAR(std::fabs(p.x), 2 + reach, 1e-9);
      }
    // At one end only.
    options.last_turn = 0;
    options.ends = RunEnd::cut;
    const auto one = sweep(band(), side, false, options);
    ASSERT_TRUE(one.has_value());
    EXPECT_NEAR(volume(one->mesh), 0.5 * (volume(run->mesh) + 4 * kWide * 0.2), 1e-9);
    EXPECT_NEAR(bounds_of(one->mesh).most.x, 2, 1e-9);
    EXPECT_NEAR(bounds_of(one->mesh).least.x, turn > 0 ? -2.1 : -2 - kApart, 1e-9);
  }
  // No room between two re-entrant corners: cut square.
  const std::vector<Point2> narrow{{0, 0}, {0.15, 0}};
  SweepOptions options;
  options.start_turn = options.last_turn = -90;
  const auto made = sweep(band(), narrow, false, options);
  ASSERT_TRUE(made.has_value());
  EXPECT_GT(volume(made->mesh), 0);
}

TEST(Sweep, RandomChainsGiveSoundBodies) {
  int sound = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::vector<Point2> chain{{0, 0}};
    double heading = 0;
    const auto draw = [&](const char* what) { return base::random_unit(seed, chain.size(), what); };
    const int corners = 3 + static_cast<int>(draw("corners") * 6);
    for (int k = 0; k < corners; ++k) {
      heading += (draw("turn") - 0.5) * 160;
      const double step = 0.3 + 4 * draw("step");
      const auto d = base::sin_cos(heading * base::kRadiansPerDegree);
      chain.push_back({chain.back().x + step * d.cos, chain.back().y + step * d.sin});
    }
    SweepOptions options;
    options.ends = seed % 2 == 0 ? RunEnd::cut : RunEnd::returned;
    options.wall = seed % 3 == 0 ? WallSide::right : WallSide::left;
    if (seed % 5 == 0) options.start_turn = (draw("start") - 0.5) * 300;
    if (seed % 7 == 0) options.last_turn = (draw("last") - 0.5) * 300;
    const auto made = sweep(band(), chain, false, options);
    ASSERT_TRUE(made.has_value()) << seed;
    ASSERT_EQ(checks::faces_wrong(made->mesh), "") << seed;
    for (const auto& body : checks::bodies(made->mesh)) {
      ASSERT_TRUE(body.closed) << seed;
      ASSERT_GT(checks::volume(made->mesh, body), 0) << seed;
      ++all;
      sound += checks::solid_defect(made->mesh, body) == "none";
    }
  }
  // Chains that cross themselves give bodies that do; the others are sound.
  EXPECT_GE(sound, all * 85 / 100) << all;
}

TEST(Sweep, FarFromTheOriginIsTheSame) {
  // A house in UTM coordinates.
  const double east = 391234.5, north = 5819876.25;
  const std::vector<Point2> house{
      {east, north}, {east + 12.3, north + 4.1}, {east + 9, north + 15}, {east - 3, north + 11}};
  std::vector<Point2> near;
  for (const Point2 p : house) near.push_back({p.x - east, p.y - north});
  const auto far_made = sweep(band(), house, true), near_made = sweep(band(), near, true);
  ASSERT_TRUE(far_made.has_value() && near_made.has_value());
  ASSERT_EQ(far_made->mesh.vertices.size(), near_made->mesh.vertices.size());
  EXPECT_EQ(far_made->mesh.indices, near_made->mesh.indices);
  for (std::size_t i = 0; i < near_made->mesh.vertices.size(); ++i) {
    const Point3 a = far_made->mesh.vertices[i], b = near_made->mesh.vertices[i];
    EXPECT_NEAR(a.x - east, b.x, 1e-7);
    EXPECT_NEAR(a.z + north, b.z, 1e-7);
  }
  const auto bodies = checks::bodies(far_made->mesh);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_TRUE(bodies[0].closed);
}

TEST(Sweep, RefusesWhatIsNoChain) {
  EXPECT_FALSE(sweep(band(), std::vector<Point2>{{0, 0}}, false).has_value());
  EXPECT_FALSE(sweep(band(), std::vector<Point2>{{0, 0}, {0, 0}}, false).has_value());
  EXPECT_FALSE(sweep(band(), std::vector<Point2>{{0, 0}, {1, 0}}, true).has_value());
  EXPECT_FALSE(sweep(Profile{}, std::vector<Point2>{{0, 0}, {1, 0}}, false).has_value());
}

TEST(Consoles, StandEquallySpacedInTheMiddleOfEachWall) {
  // docs/sources.md, Finkenzeller 3.7.4 [R]: floor((L - w) / s) + 1 of them.
  const std::vector<Point2> chain{{0, 0}, {3.2, 0}};
  const auto places = console_places(chain, false, WallSide::left, 0.5, 0.2, 0.3);
  ASSERT_EQ(places.size(), 6u);
  EXPECT_NEAR(places.front().at.x, 0.35, 1e-9);
  EXPECT_NEAR(places.back().at.x, 2.85, 1e-9);
  EXPECT_EQ(places[0].outwards, (Point2{0, -1}));
  EXPECT_EQ(console_places(chain, false, WallSide::right, 0.5, 0.2, 0.3)[0].outwards.y, 1);
  EXPECT_TRUE(console_places(std::vector<Point2>{{0, 0}, {0.1, 0}}, false, WallSide::left, 0.5, 0.2, 0.3).empty());
  // Re-entrant corners take 0.3 m of both walls.
  const std::vector<Point2> corner{{0, 0}, {2, 0}, {2, -2}};
  for (const ConsolePlace& p : console_places(corner, false, WallSide::left, 0.4, 0.2, 0.3)) {
    EXPECT_TRUE(p.outwards.y < 0 ? p.at.x <= 1.6 : p.at.y <= -0.4) << p.at.x << " " << p.at.y;
  }
}

TEST(Consoles, AreClosedBodiesUnderTheMoulding) {
  const std::vector<Point2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  SweepOptions options;
  options.consoles = {1.0, 0.16, 0.25, 0.08, 0.05};
  const auto made = sweep(band(), square, true, options);
  ASSERT_TRUE(made.has_value());
  const auto bodies = checks::bodies(made->mesh);
  EXPECT_EQ(bodies.size(), 1u + 4 * 4);
  EXPECT_GT(volume(made->mesh), 0);
  EXPECT_NEAR(bounds_of(made->mesh).least.y, -0.2, 1e-9);
  EXPECT_NEAR(bounds_of(made->mesh).least.x, -0.1, 1e-9) << "brackets on all four sides stay within the moulding";
}

}  // namespace
}  // namespace blockrand::elements
