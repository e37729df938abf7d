// The extremes along a line in a cell against dense sampling.
#include "importers/elevation/bilinear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace blockrand::importers::elevation {
namespace {

/// As the header defines it, written the plain way.
std::optional<double> height(const Cell& cell, double u, double v) {
  double sum = 0, weights = 0;
  for (const auto& [z, w] : {std::pair{cell.z00, (1 - u) * (1 - v)}, std::pair{cell.z10, u * (1 - v)},
                             std::pair{cell.z01, (1 - u) * v}, std::pair{cell.z11, u * v}}) {
    if (std::isnan(z)) continue;
    sum += w * z, weights += w;
  }
  if (weights < 1e-6) return std::nullopt;
  return sum / weights;
}

Extremes along(const Cell& cell, CellPoint a, CellPoint b) {
  Extremes extremes;
  widen(extremes, cell, a, b);
  return extremes;
}

TEST(Bilinear, FindsTheMiddleOfASaddle) {
  const Cell saddle{0, 8, 8, 0};
  // u = v: 16 u (1 - u), highest in the middle, where neither end nor corner is.
  const Extremes up = along(saddle, {0.1, 0.1}, {0.9, 0.9});
  EXPECT_DOUBLE_EQ(up.highest, 4.0);
  EXPECT_NEAR(up.lowest, 16 * 0.1 * 0.9, 1e-12);
  // The other diagonal: 8 - 16 u (1 - u), lowest there.
  const Extremes down = along(saddle, {0.1, 0.9}, {0.9, 0.1});
  EXPECT_DOUBLE_EQ(down.lowest, 4.0);
  EXPECT_NEAR(down.highest, 8 - 16 * 0.1 * 0.9, 1e-12);
}

TEST(Bilinear, IsExactOnFlatGround) {
  const double odd = 101.3;  // no binary fraction
  const Extremes e = along({odd, odd, NAN, odd}, {0.123, 0.7}, {0.9, 0.31});
  EXPECT_EQ(e.lowest, odd);
  EXPECT_EQ(e.highest, odd);
}

TEST(Bilinear, KnowsNothingWithoutACorner) {
  EXPECT_FALSE(along({NAN, NAN, NAN, NAN}, {0, 0}, {1, 1}).known());
  // Along the side whose two corners are missing the others have no weight.
  EXPECT_FALSE(along({5, 6, NAN, NAN}, {0, 1}, {1, 1}).known());
  EXPECT_TRUE(along({5, 6, NAN, NAN}, {0, 0.5}, {1, 0.5}).known());
}

/// Missing corners make it a quotient of quadratics; the sampled extremes lie within, and come near.
TEST(Bilinear, BoundsWhatDenseSamplingFinds) {
  std::mt19937 random(7);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  constexpr int kSamples = 400;
  for (int i = 0; i < 20000; ++i) {
    Cell cell{between(-9, 9), between(-9, 9), between(-9, 9), between(-9, 9)};
    if (i % 3 == 1) cell.z11 = NAN;
    if (i % 3 == 2) (i % 2 == 0 ? cell.z01 : cell.z10) = NAN;
    if (i % 7 == 0) cell.z00 = NAN;
    const CellPoint a{between(0, 1), between(0, 1)}, b{between(0, 1), between(0, 1)};
    const Extremes found = along(cell, a, b);
    ASSERT_TRUE(found.known());
    Extremes sampled;
    for (int k = 0; k <= kSamples; ++k) {
      const double t = k / static_cast<double>(kSamples);
      if (const auto z = height(cell, a.u + t * (b.u - a.u), a.v + t * (b.v - a.v))) sampled.add(*z);
    }
    ASSERT_LE(found.lowest, sampled.lowest + 1e-9) << i;
    ASSERT_GE(found.highest, sampled.highest - 1e-9) << i;
    ASSERT_GE(found.lowest, sampled.lowest - 0.2) << i;
    ASSERT_LE(found.highest, sampled.highest + 0.2) << i;
  }
}

}  // namespace
}  // namespace blockrand::importers::elevation
