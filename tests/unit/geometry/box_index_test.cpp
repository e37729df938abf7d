#include "pipeline/geometry/box_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace blockrand::geometry {
namespace {

using ::testing::ElementsAre;

/// Boxes from nothing to a tenth of the ground, points among them, one over all of it, and an empty one.
std::vector<PlanBox> scattered() {
  std::uint32_t dice = 7;
  const auto roll = [&](double most) { return most * ((dice = dice * 1664525u + 1013904223u) >> 8) / 16777216.0; };
  std::vector<PlanBox> out{{{-9000, -9000}, {9000, 9000}}, {}};
  for (int i = 0; i < 300; ++i) {
    const model::Point2 low{roll(1000) - 500, roll(1000) - 500};
    const double size = i % 3 == 0 ? 0 : roll(i % 7 == 0 ? 100 : 20);
    out.push_back({low, {low.x + size, low.y + size}});
  }
  return out;
}

TEST(BoxIndex, FindsWhatAskingEveryBoxFinds) {
  const std::vector<PlanBox> boxes = scattered();
  const BoxIndex index(boxes);
  for (const double distance : {0.0, 1.0, 80.0, 3000.0}) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
      std::vector<std::uint32_t> near;
      for (std::uint32_t b = 0; b < boxes.size(); ++b)
        if (boxes[b].near(boxes[a], distance)) near.push_back(b);
      ASSERT_EQ(index.near(boxes[a], distance), near) << distance << " " << a;
      for (const std::uint32_t b : near)
        if (a < b) pairs.emplace_back(a, b);
    }
    ASSERT_EQ(index.pairs(distance), pairs) << distance;
  }
}

// A sum and a difference of large coordinates round differently: the tree must not lose a box at exactly the distance.
TEST(BoxIndex, FindsWhatLiesExactlyAtTheDistance) {
  for (int i = 0; i < 1000; ++i) {
    const double x = 5e6 + i * 0.1, distance = 0.1 + i * 1e-3;
    const BoxIndex index(std::vector<PlanBox>{{{x, x}, {x, x}}});
    const PlanBox beside{{x + distance, x}, {x + distance, x}};
    EXPECT_EQ(index.near(beside, distance).size(), index.box(0).near(beside, distance) ? 1u : 0u) << i;
  }
}

TEST(BoxIndex, TouchingBoxesAreNearAndEmptyOnesNever) {
  const BoxIndex index({{{0, 0}, {64, 64}}, {}, {{64, 64}, {70, 70}}, {{65, 0}, {70, 5}}});
  EXPECT_THAT(index.near({{64, 64}, {64, 64}}, 0), ElementsAre(0u, 2u));
  EXPECT_THAT(index.pairs(1), ElementsAre(std::pair(0u, 2u), std::pair(0u, 3u)));
  EXPECT_TRUE(index.near({}, 10).empty());
  EXPECT_TRUE(BoxIndex().near({{0, 0}, {1, 1}}, 10).empty());
}

}  // namespace
}  // namespace blockrand::geometry
