// Regions, rectangles, colours and what the map covers, in pictures that the tests paint.
#include "pipeline/observation/unmapped.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/observation/image_regions.h"
#include "pipeline/observation/plan_rectangle.h"
#include "pipeline/observation/roof_colours.h"

namespace blockrand::observation {
namespace {

using model::Point2;

/// A picture of 60 m, its middle at (0, 0), in pixels of half a metre.
struct Picture {
  Patch patch;
  explicit Picture(int grey, int noise = 4) {
    patch.west = -30, patch.north = 30, patch.size = 0.5, patch.width = patch.height = 120;
    std::mt19937 random(3);
    for (int i = 0; i < 120 * 120; ++i) {
      const auto v =
          static_cast<std::uint8_t>(grey + static_cast<int>(random() % static_cast<unsigned>(2 * noise + 1)) - noise);
      patch.red.push_back(v), patch.green.push_back(v), patch.blue.push_back(v), patch.valid.push_back(1);
    }
  }
  /// Paints what lies within a rectangle about `c`, turned by an angle.
  Picture& house(Point2 c, double half_long, double half_short, double angle, std::array<int, 3> colour) {
    for (int r = 0; r < 120; ++r)
      for (int k = 0; k < 120; ++k) {
        const double x = -30 + (k + 0.5) * 0.5 - c.x, y = 30 - (r + 0.5) * 0.5 - c.y;
        const double s = x * std::cos(angle) + y * std::sin(angle), t = y * std::cos(angle) - x * std::sin(angle);
        if (std::fabs(s) > half_long || std::fabs(t) > half_short) continue;
        const auto i = static_cast<std::size_t>(120 * r + k);
        patch.red[i] = static_cast<std::uint8_t>(colour[0]), patch.green[i] = static_cast<std::uint8_t>(colour[1]),
        patch.blue[i] = static_cast<std::uint8_t>(colour[2]);
      }
    return *this;
  }
  std::vector<std::uint8_t> open() const { return std::vector<std::uint8_t>(patch.valid.size(), 1); }
};

TEST(ImageRegions, TwoSlopesAndTheGroundAreThree) {
  Picture p(100);
  p.house({0, 2}, 6, 2, 0, {190, 110, 80}).house({0, -2}, 6, 2, 0, {140, 80, 60});
  const ImageRegions regions = grow_regions(p.patch, p.open(), 12);
  ASSERT_EQ(regions.regions.size(), 3U);
  EXPECT_EQ(regions.regions[1].count, 24U * 8U);
  EXPECT_NEAR(regions.regions[1].red, 190, 3);
  EXPECT_EQ(regions.pixels.size(), p.patch.valid.size());
  ASSERT_EQ(regions.borders.size(), 3U);
  EXPECT_EQ(regions.borders[2].length, 24U) << "the ridge";
}

TEST(ImageRegions, WhatIsClosedHasNone) {
  const Picture p(100);
  EXPECT_TRUE(grow_regions(p.patch, std::vector<std::uint8_t>(p.patch.valid.size(), 0), 12).regions.empty());
  std::vector<std::uint8_t> few(p.patch.valid.size(), 0);
  few[0] = few[1] = few[2] = 1;
  EXPECT_TRUE(grow_regions(p.patch, few, 12).regions.empty()) << "less than the least, without a neighbour";
  EXPECT_EQ(grow_regions(p.patch, few, 3).regions.size(), 1U);
}

TEST(ImageRegions, NoNeighbourAcrossTheEdgeOfThePicture) {
  const Picture p(100);
  std::vector<std::uint8_t> open(p.patch.valid.size(), 0);
  for (std::size_t r = 0; r < 120; ++r)
    for (const std::size_t c : {std::size_t{0}, std::size_t{119}}) open[120 * r + c] = 1;
  EXPECT_EQ(grow_regions(p.patch, open, 12).regions.size(), 2U);
}

std::vector<std::uint32_t> pixels_in(const Patch& patch, double half_long, double half_short, double angle) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < patch.valid.size(); ++i) {
    const double x = patch.west + (i % 120 + 0.5) * 0.5, y = patch.north - (i / 120 + 0.5) * 0.5;
    const double s = x * std::cos(angle) + y * std::sin(angle), t = y * std::cos(angle) - x * std::sin(angle);
    if (std::fabs(s) <= half_long && std::fabs(t) <= half_short) out.push_back(i);
  }
  return out;
}

TEST(PlanRectangle, IsThatOfTheRegion) {
  const Picture p(100);
  for (const double angle : {0.0, 0.4, 1.2, 2.8}) {
    const auto found = rectangle_of(p.patch, pixels_in(p.patch, 8, 4, angle));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->rectangle.half_long, 8, 0.5);
    EXPECT_NEAR(found->rectangle.half_short, 4, 0.5);
    EXPECT_NEAR(std::fabs(found->rectangle.along.x * std::cos(angle) + found->rectangle.along.y * std::sin(angle)), 1,
                0.01);
    EXPECT_GT(found->filled, 0.85);
  }
}

TEST(PlanRectangle, SpursAreLeftOutAndCost) {
  const Picture p(100);
  std::vector<std::uint32_t> pixels = pixels_in(p.patch, 8, 4, 0);
  for (const std::uint32_t i : pixels_in(p.patch, 24, 0.4, 0)) pixels.push_back(i);
  std::sort(pixels.begin(), pixels.end());
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  const auto found = rectangle_of(p.patch, pixels);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rectangle.half_long, 8, 0.6);
  EXPECT_LT(found->filled, 0.95);
}

TEST(PlanRectangle, ALineAndAPointAreNone) {
  const Picture p(100);
  EXPECT_FALSE(rectangle_of(p.patch, std::vector<std::uint32_t>{}));
  EXPECT_FALSE(rectangle_of(p.patch, std::vector<std::uint32_t>{5}));
  EXPECT_FALSE(rectangle_of(p.patch, std::vector<std::uint32_t>{5, 6, 7, 8, 9, 10}));
}

TEST(PlanRectangle, ItsSidesGoToTheEdges) {
  Picture p(100);
  p.house({1, 0.5}, 8, 5, 0.3, {190, 110, 80});
  const PlanRectangle guess{{0.4, 0.8}, {std::cos(0.37), std::sin(0.37)}, 7.2, 4.4};
  const auto found = fit_to_edges(guess, p.patch, 12);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rectangle.half_long, 8, 0.4);
  EXPECT_NEAR(found->rectangle.half_short, 5, 0.4);
  EXPECT_NEAR(found->rectangle.centre.x, 1, 0.4);
  EXPECT_GT(found->score, 0.7);
  EXPECT_LT(found->around, found->score);
  const auto nothing = fit_to_edges({{-18, -18}, {1, 0}, 5, 4}, p.patch, 12);
  ASSERT_TRUE(nothing);
  EXPECT_LT(nothing->score, 0.5) << "a lawn";
  EXPECT_FALSE(fit_to_edges({{-29, 0}, {1, 0}, 5, 4}, p.patch, 12)) << "the image ends";
}

TEST(RoofColours, TellRoofsFromTheGround) {
  Picture p(100);
  p.house({0, 0}, 20, 20, 0, {190, 110, 80});
  std::vector<std::uint8_t> kinds(p.patch.valid.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) kinds[i] = p.patch.red[i] > 150 ? 1 : 2;
  RoofColours colours;
  EXPECT_EQ(colours.likeness(190, 110, 80), 0.0F) << "nothing learnt";
  colours.learn(p.patch, kinds);
  colours.settle();
  EXPECT_GT(colours.likeness(190, 110, 80), 1.5F);
  EXPECT_LT(colours.likeness(100, 100, 100), -1.5F);
  EXPECT_EQ(colours.likeness(20, 20, 250), 0.0F) << "seen nowhere";
}

TEST(RoofColours, AFewPixelsTeachNothing) {
  const Picture p(100);
  RoofColours colours;
  std::vector<std::uint8_t> kinds(p.patch.valid.size(), 0);
  kinds[0] = 1, kinds[1] = 2;
  colours.learn(p.patch, kinds);
  colours.settle();
  EXPECT_EQ(colours.likeness(100, 100, 100), 0.0F);
}

UnmappedBuilding candidate(double x, double side, double probability) {
  UnmappedBuilding u;
  u.id = "u" + std::to_string(static_cast<int>(x)) + "_" + std::to_string(static_cast<int>(side));
  u.outline = {{x, 0}, {x + side, 0}, {x + side, side}, {x, side}};
  u.area = side * side, u.probability = probability;
  return u;
}

TEST(Unmapped, OfTwoOnOnePlaceTheLikelierStays) {
  const auto kept = without_overlaps({candidate(0, 8, 0.5), candidate(2, 8, 0.7), candidate(30, 8, 0.6)});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].probability, 0.7);
  EXPECT_EQ(kept[1].probability, 0.6);
}

TEST(Unmapped, OfTwoThatAreLikelyTheLargerStays) {
  const auto kept = without_overlaps({candidate(0, 8, 0.99), candidate(0, 12, 0.9)});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].area, 144);
}

TEST(Unmapped, NeighboursStayAndTheirOrderDoesNotMatter) {
  const auto a = without_overlaps(
                 {candidate(0, 8, 0.9), candidate(8, 8, 0.9), candidate(199, 8, 0.8), candidate(201, 8, 0.81)}),
             b = without_overlaps(
                 {candidate(201, 8, 0.81), candidate(199, 8, 0.8), candidate(8, 8, 0.9), candidate(0, 8, 0.9)});
  ASSERT_EQ(a.size(), 3U) << "across the squares in which neighbours are looked for";
  ASSERT_EQ(b.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(a[i].id, b[i].id);
  EXPECT_TRUE(without_overlaps({}).empty());
}

UnmappedEvidence house() {
  return {.score = 0.8,
          .around = 0.5,
          .filled = 0.9,
          .elongation = 1.4,
          .area = 120,
          .likeness = 1.2,
          .green_around = 0.4,
          .mapped_around = 0.1,
          .shadow = 0.2,
          .brightness = 0.9};
}

TEST(Unmapped, AHouseIsLikelyALawnAndAYardAreNot) {
  EXPECT_GT(unmapped_probability(house()), kTellUnmapped);
  UnmappedEvidence lawn = house();
  lawn.likeness = -2, lawn.score = 0.4, lawn.shadow = 0, lawn.green_around = 0.9;
  EXPECT_LT(unmapped_probability(lawn), 0.05);
  UnmappedEvidence yard = house();
  yard.likeness = -0.2, yard.shadow = -0.05, yard.filled = 0.7;
  EXPECT_LT(unmapped_probability(yard), 0.5);
  UnmappedEvidence sunless = house();
  sunless.shadow = 0;
  EXPECT_LT(unmapped_probability(sunless), unmapped_probability(house()));
}

TEST(FillRings, AreByPixelCentresAndEvenOdd) {
  const Picture p(100);
  const std::vector<Point2> outer{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, hole{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
  std::vector<std::uint8_t> filled(p.patch.valid.size(), 0);
  const std::vector<std::span<const Point2>> rings{outer, hole};
  fill_rings(p.patch, rings, {3, 0}, filled);
  EXPECT_EQ(std::count(filled.begin(), filled.end(), 1), 20 * 20 - 8 * 8);
  EXPECT_TRUE(filled[static_cast<std::size_t>(120 * 60 + 74)]) << "moved";
  fill_rings(p.patch, {}, {}, filled);
  const std::vector<Point2> far{{500, 500}, {510, 500}, {510, 510}};
  const std::vector<std::span<const Point2>> beyond{far};
  fill_rings(p.patch, beyond, {}, filled);
  EXPECT_EQ(std::count(filled.begin(), filled.end(), 1), 20 * 20 - 8 * 8) << "nothing beyond the picture";
}

}  // namespace
}  // namespace blockrand::observation
