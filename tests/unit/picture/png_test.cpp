#include <gtest/gtest.h>

#include <stdexcept>

#include "pipeline/picture/image.h"

namespace blockrand::picture {
namespace {

Image chequered(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int band = 0; band < 3; ++band)
        image.rgb.push_back(static_cast<std::uint8_t>((x * 40 + y * 7 + band * 90) % 256));
  return image;
}

TEST(Png, IsReadAsItWasWritten) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 65}}) {
    const Image image = chequered(width, height);
    EXPECT_EQ(read_png(png(image)), image);
  }
}

TEST(Png, WithAPaletteKeepsItsFewColours) {
  Image image{20, 4, {}};
  for (int i = 0; i < 80; ++i)
    for (const std::uint8_t v : {std::uint8_t(i % 2 ? 250 : 10), std::uint8_t(i % 5 ? 30 : 99), std::uint8_t(77)})
      image.rgb.push_back(v);
  EXPECT_EQ(read_png(palette_png(image, 64)), image);
}

TEST(Png, DamagedIsTold) {
  const std::string whole = png(chequered(30, 30));
  EXPECT_THROW(read_png(""), std::runtime_error);
  EXPECT_THROW(read_png("no picture at all"), std::runtime_error);
  for (const std::size_t length : {std::size_t{9}, std::size_t{30}, whole.size() / 2, whole.size() - 14})
    EXPECT_THROW(read_png(std::string_view(whole).substr(0, length)), std::runtime_error) << length;
  std::string changed = whole;
  changed[whole.size() / 2] = static_cast<char>(changed[whole.size() / 2] ^ 0x55);
  EXPECT_THROW(read_png(changed), std::runtime_error);
}

TEST(Cut, TakesWhatLiesWithin) {
  const Image image = chequered(10, 8);
  const Image piece = cut(image, 8, -2, 5, 4);
  ASSERT_EQ(piece.width, 2);
  ASSERT_EQ(piece.height, 2);
  EXPECT_EQ(*piece.pixel(1, 1), *image.pixel(9, 1));
  EXPECT_EQ(cut(image, 0, 0, 10, 8), image);
}

TEST(Cut, BesideTheImageIsEmpty) {
  EXPECT_TRUE(cut(chequered(10, 8), 10, 0, 5, 5).rgb.empty());
  EXPECT_TRUE(cut(chequered(10, 8), -9, 0, 5, 5).rgb.empty());
  EXPECT_TRUE(cut(chequered(10, 8), 2, 2, 0, 5).rgb.empty());
}

}  // namespace
}  // namespace blockrand::picture
