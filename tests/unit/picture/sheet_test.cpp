#include "pipeline/picture/sheet.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace blockrand::picture {
namespace {

constexpr model::Colour kMap{0, 120, 0}, kPaper{255, 255, 255};

Image map_of(int width, int height) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), {kMap.r, kMap.g, kMap.b});
  return image;
}

SheetText words() {
  return {
      .title = "A quarter",
      .below_title = {"12 buildings; data of 2024-02-03"},
      .legend = {{{200, 30, 20}, "Wall: to a street", LegendSign::line}, {{10, 20, 230}, "Water", LegendSign::area}},
      .metres_per_pixel = 0.5,
      .north = "Grid north is up",
      .attribution = "© OpenStreetMap contributors, ODbL 1.0",
      .generator = "Blockrand"};
}

int count(const Image& image, model::Colour c) {
  int n = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    n += image.rgb[i] == c.r && image.rgb[i + 1] == c.g && image.rgb[i + 2] == c.b;
  return n;
}

TEST(Sheet, HoldsTheMapUnchangedAndWordsAroundIt) {
  const Image map = map_of(1500, 700), out = sheet(map, words(), kPaper);
  if (const char* path = std::getenv("BLOCKRAND_SHEET")) std::ofstream(path, std::ios::binary) << png(out);
  EXPECT_GT(out.width, 1500);
  EXPECT_LT(out.width, 1600);
  EXPECT_GT(out.height, 900);
  EXPECT_EQ(out.rgb.size(), static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 3);
  EXPECT_NEAR(count(out, kMap), 1500 * 700, 6000) << "but for what the frame covers";
  EXPECT_GT(count(out, {200, 30, 20}), 100) << "the legend's line";
  EXPECT_GT(count(out, {10, 20, 230}), 300) << "the legend's area";
}

TEST(Sheet, SmallMapsStandInTheMiddleOfOneThatWordsFitOn) {
  const Image out = sheet(map_of(200, 150), words(), kPaper);
  EXPECT_EQ(out.width, kLeastSheet);
  const auto row_has_map = [&](int x) {
    for (int y = 0; y < out.height; ++y)
      if (out.pixel(x, y)[1] == kMap.g && out.pixel(x, y)[0] == kMap.r) return true;
    return false;
  };
  EXPECT_TRUE(row_has_map(kLeastSheet / 2));
  EXPECT_FALSE(row_has_map(kLeastSheet / 2 - 110));
  EXPECT_FALSE(row_has_map(kLeastSheet / 2 + 110));
}

TEST(Sheet, LongWordsNeitherCrashNorWidenIt) {
  SheetText text = words();
  const Image plain = sheet(map_of(1300, 300), text, kPaper);
  text.title = std::string(400, 'W') + " Приморский район";
  for (int i = 0; i < 80; ++i) text.attribution += " and the survey of the town,";
  text.legend.assign(40, {{1, 2, 3}, "A colour that stands for something", LegendSign::area});
  const Image out = sheet(map_of(1300, 300), text, kPaper);
  EXPECT_EQ(out.width, plain.width);
  EXPECT_GT(out.height, plain.height + 100) << "every word of the attribution is there";
  for (int y = 0; y < out.height; ++y) {
    ASSERT_EQ(*out.pixel(2, y), 255) << "the margin stays empty";
    ASSERT_EQ(*out.pixel(out.width - 3, y), 255);
  }
}

TEST(Sheet, IsTheSameInBands) {
  const Image map = map_of(1500, 700), whole = sheet(map, words(), kPaper);
  const SheetText text = words();
  const Sheet layout(map.width, map.height, text);
  ASSERT_EQ(layout.width(), whole.width);
  ASSERT_EQ(layout.height(), whole.height);
  for (int first = 0; first < whole.height; first += 90) {
    const int rows = std::min(90, whole.height - first);
    Image band = blank(whole.width, rows, kPaper);
    put(band, map, layout.map_left(), layout.map_top() - first);
    layout.draw(band, first);
    ASSERT_EQ(band.height, rows);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < whole.width; ++x)
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(band.pixel(x, y)[c], whole.pixel(x, first + y)[c], 2) << x << ' ' << first + y;
  }
}

TEST(Sheet, WithoutWordsIsAFrame) {
  const Image out = sheet(map_of(1300, 300), {}, kPaper);
  EXPECT_LT(out.height, 500);
  EXPECT_EQ(out, sheet(map_of(1300, 300), {}, kPaper));
}

}  // namespace
}  // namespace blockrand::picture
