// Rows and blocks of houses, each footprint mapped with errors of its own: what of the truth comes back?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "pipeline/footprints/repair/repair_terrace_row.h"
#include "tests/unit/footprints/repair/noise_scene.h"

namespace blockrand::repair::test {
namespace {

constexpr int kBlocks = 240;

struct Bar {
  double radius;  ///< m, of the disc
  double walls;   ///< share of walls that must come back
};

Score experiment(double radius, bool square, bool cut) {
  const Footprints truth = true_houses(7, kBlocks), noisy = with_noise(truth, radius, 11);
  RepairOptions options;
  options.square = square;
  TerraceRow row = row_of(noisy);
  model::Report report;
  const auto start = std::chrono::steady_clock::now();
  if (cut) {
    for (const auto& members : rows_of(noisy, 3)) {
      TerraceRow piece;
      for (const std::size_t i : members) piece.buildings.push_back(row.buildings[i]);
      repair_terrace_row(piece, options, report);
      for (std::size_t k = 0; k < members.size(); ++k) row.buildings[members[k]] = piece.buildings[k];
    }
  } else {
    repair_terrace_row(row, options, report);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Score s = score(truth, noisy, row);
  int conflicts = 0, bounded = 0;
  for (const auto& r : report.rows) {
    conflicts += r.code == model::IssueCode::shared_wall_conflict;
    bounded += r.code == model::IssueCode::repair_bounded;
  }
  std::printf("noise %.1f m%s%s, %zu houses: %s; conflicts %d, bounded %d; %.0f houses/s\n", radius,
              square ? ", squared" : "", cut ? ", row by row" : "", truth.size(), s.text().c_str(), conflicts, bounded,
              static_cast<double>(truth.size()) / seconds);
  return s;
}

class Noise : public testing::TestWithParam<Bar> {};

TEST_P(Noise, WallsComeBackAndAlleysStayOpen) {
  for (const bool cut : {false, true}) {
    const Score s = experiment(GetParam().radius, false, cut);
    ASSERT_GT(s.walls, 500);
    ASSERT_GT(s.alleys, 100);
    EXPECT_GE(s.walls_recovered, GetParam().walls * s.walls);
    EXPECT_EQ(s.alleys_closed, 0);
    EXPECT_EQ(s.invalid, 0);
    EXPECT_LE(s.largest_shift, 0.5 + 0.001);
  }
}

TEST_P(Noise, RightAnglesComeBackAndObliqueOnesStay) {
  const Score s = experiment(GetParam().radius, true, true);
  ASSERT_GT(s.right, 1000);
  ASSERT_GT(s.oblique, 100);
  EXPECT_GE(s.walls_recovered, GetParam().walls * s.walls);
  EXPECT_EQ(s.alleys_closed, 0);
  EXPECT_EQ(s.invalid, 0);
  EXPECT_LE(s.largest_shift, 0.5 + 0.001);
  EXPECT_GE(s.right_restored, 0.95 * s.right);
  EXPECT_LE(s.oblique_squared, 0.005 * s.oblique);
  EXPECT_LT(s.error_after, s.error_before);
}

INSTANTIATE_TEST_SUITE_P(ByRadius, Noise, testing::Values(Bar{0.1, 0.995}, Bar{0.2, 0.97}, Bar{0.3, 0.85}));

TEST(NoNoise, NothingMoves) {
  for (const bool square : {false, true}) {
    const Score s = experiment(0, square, true);
    EXPECT_LE(s.largest_shift, 0.0015);
    EXPECT_EQ(s.walls_recovered, s.walls);
    EXPECT_EQ(s.alleys_closed, 0);
    EXPECT_EQ(s.invalid, 0);
  }
}

}  // namespace
}  // namespace blockrand::repair::test
