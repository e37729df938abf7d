// Scores of outlines on patches whose edges are known.
#include "pipeline/observation/outline_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace blockrand::observation {
namespace {

using model::Point2;

constexpr double kSize = 0.2;

/// 40 x 40 m about (0, 0): a bright rectangle of 12 x 8 m about `middle` on a dark ground.
Patch rectangle(Point2 middle) {
  Patch p;
  p.size = kSize, p.width = p.height = 200;
  p.west = -20, p.north = 20;
  for (int r = 0; r < p.height; ++r)
    for (int c = 0; c < p.width; ++c) {
      const double x = p.west + (c + 0.5) * kSize, y = p.north - (r + 0.5) * kSize;
      const bool in = std::fabs(x - middle.x) < 6 && std::fabs(y - middle.y) < 4;
      p.red.push_back(in ? 180 : 80), p.green.push_back(in ? 120 : 90), p.blue.push_back(in ? 100 : 70);
      p.valid.push_back(1);
    }
  return p;
}

std::vector<WallPiece> outline() {
  const std::vector<Point2> ring{{-6, -4}, {6, -4}, {6, 4}, {-6, 4}};
  std::vector<WallPiece> pieces;
  add_pieces(ring, std::vector<double>(4, 1.0), pieces);
  return pieces;
}

Point2 best(const ScoreMap& map) {
  int bi = 0, bj = 0;
  for (int j = -map.grid.half; j <= map.grid.half; ++j)
    for (int i = -map.grid.half; i <= map.grid.half; ++i)
      if (map.at(i, j) > map.at(bi, bj)) bi = i, bj = j;
  return {bi * map.grid.step, bj * map.grid.step};
}

TEST(OutlineScore, PiecesCutTheWallsAndKeepTheirLength) {
  const auto pieces = outline();
  double length = 0;
  for (const WallPiece& p : pieces) {
    EXPECT_LE(p.length, kPieceLength);
    EXPECT_NEAR(std::hypot(p.along.x, p.along.y), 1, 1e-12);
    length += p.length;
  }
  EXPECT_NEAR(length, 40, 1e-9);
  std::vector<WallPiece> none;
  add_pieces(std::vector<Point2>{{0, 0}, {0.2, 0}, {0.2, 0.2}}, std::vector<double>(3, 1.0), none);
  EXPECT_TRUE(none.empty());
}

TEST(OutlineScore, TheBestDisplacementIsWhereTheImageShowsTheOutline) {
  for (const Point2 middle : {Point2{0, 0}, Point2{1.5, -2}, Point2{-3, 0.5}}) {
    const ScoreMap map = score_outline(outline(), rectangle(middle), {0.25, 16}, {}, {}, 12);
    EXPECT_NEAR(best(map).x, middle.x, 0.26);
    EXPECT_NEAR(best(map).y, middle.y, 0.26);
    EXPECT_GT(map.at(middle.x, middle.y), 0.8);
    EXPECT_LT(map.at(-middle.x + 2, -middle.y + 2), 0.5);
    EXPECT_NEAR(map.weight, 40, 1e-9);
    EXPECT_EQ(map.missing, 0);
  }
}

TEST(OutlineScore, ATurnIsUndone) {
  auto pieces = outline();
  const base::SinCos by = base::sin_cos(8 * base::kRadiansPerDegree);
  for (WallPiece& p : pieces) {
    p.middle = {p.middle.x * by.cos - p.middle.y * by.sin, p.middle.x * by.sin + p.middle.y * by.cos};
    p.along = {p.along.x * by.cos - p.along.y * by.sin, p.along.x * by.sin + p.along.y * by.cos};
  }
  const Patch patch = rectangle({});
  const double as_is = score_outline(pieces, patch, {0.25, 4}, {}, {}, 12).at(0, 0);
  const double back = score_outline(pieces, patch, {0.25, 4}, {}, {-by.sin, by.cos}, 12).at(0, 0);
  EXPECT_GT(back, as_is + 0.1);
}

TEST(OutlineScore, WallsBeyondTheImageAreMissing) {
  Patch patch = rectangle({});
  for (int r = 0; r < patch.height; ++r)  // the eastern half shows nothing
    for (int c = 100; c < patch.width; ++c) patch.valid[static_cast<std::size_t>(r * patch.width + c)] = 0;
  const ScoreMap map = score_outline(outline(), patch, {0.25, 8}, {}, {}, 12);
  EXPECT_NEAR(map.weight + map.missing, 40, 1e-9);
  EXPECT_GT(map.missing, 15);
  EXPECT_GT(map.weight, 10);
  EXPECT_GT(map.at(0, 0), map.at(4, 0));
}

TEST(OutlineScore, SharedWallsCountForLess) {
  auto pieces = outline();
  for (WallPiece& p : pieces) p.weight = 0.25;
  EXPECT_NEAR(score_outline(pieces, rectangle({}), {0.25, 4}, {}, {}, 12).weight, 10, 1e-9);
  EXPECT_EQ(score_outline({}, rectangle({}), {0.25, 4}, {}, {}, 12).weight, 0);
}

}  // namespace
}  // namespace blockrand::observation
