#include "pipeline/picture/lettering.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "pipeline/base/sha256.h"

namespace blockrand::picture {
namespace {

constexpr model::Colour kBlack{0, 0, 0};

Image paper(int width, int height) {
  Image image{width, height, {}};
  image.rgb.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3, 255);
  return image;
}

/// First and last column and row with ink, exclusive.
struct Inked {
  int left = 1 << 20, top = 1 << 20, right = 0, bottom = 0;
};
Inked inked(const Image& image) {
  Inked out;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (*image.pixel(x, y) < 255) {
        out.left = std::min(out.left, x), out.right = std::max(out.right, x + 1);
        out.top = std::min(out.top, y), out.bottom = std::max(out.bottom, y + 1);
      }
  return out;
}

/// The picture of a text at 40 px.
Image written(std::string_view text) {
  Image image = paper(300, 60);
  Lettering().write(image, {10, 45}, text, {.size = 40, .colour = kBlack});
  return image;
}

TEST(Lettering, WidthsAreThoseOfTheFont) {
  const Lettering letters;
  // Advance widths of DejaVu Sans Condensed in 2048ths: H 1386, o 1127, u 1168, s 960, e 1134.
  EXPECT_DOUBLE_EQ(letters.width("H", 2048), 1386);
  EXPECT_DOUBLE_EQ(letters.width("Houses", 2048), 1386 + 1127 + 1168 + 960 + 1134 + 960);
  EXPECT_DOUBLE_EQ(letters.width("Houses", 20), 20 * letters.width("Houses", 1));
  EXPECT_EQ(letters.width("", 20), 0);
}

TEST(Lettering, PairsAreKerned) {
  const Lettering letters;
  EXPECT_LT(letters.width("AV", 100), letters.width("A", 100) + letters.width("V", 100));
  EXPECT_LT(letters.width("To", 100), letters.width("T", 100) + letters.width("o", 100));
}

TEST(Lettering, CapitalsStandOnTheirLineAndAreAsHighAsSaid) {
  Image image = paper(120, 120);
  Lettering().write(image, {10, 100}, "H", {.size = 100, .colour = kBlack});
  const Inked ink = inked(image);
  EXPECT_EQ(ink.bottom, 100);
  EXPECT_NEAR(100 - ink.top, 100 * kCapitals, 1);
  EXPECT_GT(ink.left, 10);
  EXPECT_LT(ink.right, 10 + Lettering().width("H", 100));
}

TEST(Lettering, TurnedTextRunsAlongItsDirection) {
  Image image = paper(120, 200);
  Lettering().write(image, {60, 190}, "Upright", {.size = 40, .colour = kBlack}, {0, -1});
  const Inked ink = inked(image);
  EXPECT_NEAR(ink.bottom - ink.top, Lettering().width("Upright", 40), 6);
  EXPECT_NEAR(60 - ink.left, 40 * kCapitals, 2) << "from below upwards: letters stand to the left of their line";
}

TEST(Lettering, TheSameWordsGiveTheSameBytes) {
  // With FreeType 2.12.1 (Debian 12), on every x86-64.
  Image image = paper(260, 90);
  const Lettering letters;
  letters.write(image, {8, 30}, "Şehzadebaşı AV", {.size = 24, .colour = {20, 60, 120}});
  letters.write(image, {8, 80}, "Невский 12½",
                {.size = 20, .colour = kBlack, .halo = 2.5, .halo_colour = {255, 230, 120}}, {0.96, -0.28});
  if (const char* path = std::getenv("BLOCKRAND_LETTERING")) std::ofstream(path, std::ios::binary) << png(image);
  const std::string bytes(image.rgb.begin(), image.rgb.end());
  EXPECT_EQ(base::sha256_of(bytes), "147c58a0fc7e7cf4dbd39c3977c3c41c6f8a078afeca40c79d0077ddd2c5d03f");
}

TEST(Lettering, NamesOfManyCountriesAreNoBoxes) {
  const Lettering letters;
  for (const char* name :
       {"Невский проспект", "Şehzadebaşı Caddesi İğdır", "Friedrichstraße", "Náměstí Míru, Žižkov",
        "Łódź, ulica Święty Krzyż", "Calea Victoriei, Piaţa Ştefan cel Mare", "Ermoú Ερμού",
        "Avenida Almirante Reis, São João", "ț ș Ț Ș", "Київ, вулиця Хрещатик, Ґ ї є", "© ° ½ ² – … „“"})
    EXPECT_TRUE(letters.can_write(name)) << name;
  const Image box = written("\u4e2d");
  for (const char* letter : {"Н", "е", "в", "с", "к", "и", "й", "Ş", "ş", "ı", "İ", "ğ"})
    EXPECT_NE(written(letter), box) << letter;
}

TEST(Lettering, WhatTheFontLacksIsABox) {
  EXPECT_FALSE(Lettering().can_write("\u4e2d"));
  EXPECT_EQ(written("\u4e2d"), written("\u6587")) << "each missing letter is the same box";
  EXPECT_NE(written("\u4e2d"), written(""));
  EXPECT_NE(written("\u0627\u0644\u0639\u0631\u0628"), written("")) << "Arabic is set letter by letter";
}

TEST(Lettering, BrokenUtf8IsShownAsSuch) {
  const Image replaced = written("a\ufffdb");
  for (const char* broken : {"a\xff"
                             "b",
                             "a\x80"
                             "b",
                             "a\xc3"
                             "b",
                             "a\xe2"
                             "b"})
    EXPECT_EQ(written(broken), replaced);
  EXPECT_EQ(written("a\xc0\xaf"), written("a\ufffd\ufffd")) << "longer than it need be";
  EXPECT_EQ(written("a\xed\xa0\x80"), written("a\ufffd\ufffd\ufffd")) << "half of a pair";
  EXPECT_EQ(written("a\xf0\x9f\x98"), written("a\ufffd\ufffd\ufffd")) << "cut off";
  EXPECT_EQ(written(std::string_view("a\0b", 3)), written("a b"));
  EXPECT_EQ(written("a\u200fb\u200d\ufeff"), written("ab")) << "marks of direction show nothing";
}

TEST(Lettering, WhatLeavesThePictureIsCutOff) {
  Image image = paper(30, 20), small = paper(1, 1);
  const Lettering letters;
  const std::string longer(5000, 'W');
  letters.write(image, {-400, 15}, longer, {.size = 14, .halo = 3});
  letters.write(image, {1e7, -1e7}, "far", {.size = 14});
  letters.write(image, {10, 10}, "huge", {.size = 40000});
  letters.write(image, {10, 10}, "none", {.size = 0});
  letters.write(small, {0, 1}, "small", {.size = 12});
  EXPECT_EQ(image.rgb.size(), 30u * 20 * 3);
}

TEST(Lettering, TextIsCutWithAnEllipsis) {
  const Lettering letters;
  const std::string name = "Große Straße des Überflusses";
  EXPECT_EQ(letters.fitted(name, 20, 1000), name);
  for (double width = 0; width < letters.width(name, 20); width += 3) {
    const std::string text = letters.fitted(name, 20, width);
    EXPECT_TRUE(text.ends_with("…"));
    EXPECT_TRUE(letters.can_write(text)) << "no letter is cut in two: " << text;
    if (text != "…") {
      EXPECT_LE(letters.width(text, 20), width);
    }
  }
}

TEST(Lettering, LinesBreakAtSpaces) {
  const Lettering letters;
  const double width = letters.width("one two", 20);
  EXPECT_EQ(letters.lines("one two three", 20, width), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(letters.lines("  immeasurable  x ", 20, width), (std::vector<std::string>{"immeasurable", "x"}));
  EXPECT_TRUE(letters.lines("", 20, width).empty());
}

TEST(Sign, StandsInTheLowerRightCorner) {
  Image image = paper(600, 300);
  image.rgb.assign(image.rgb.size(), 100);
  const auto box = sign(image, "© OpenStreetMap contributors, ODbL 1.0");
  EXPECT_EQ(box[2].x, 600);
  EXPECT_EQ(box[2].y, 300);
  EXPECT_GT(box[0].x, 300);
  EXPECT_GT(box[0].y, 280);
  int dark = 0;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 600; ++x)
      if (x < box[0].x || y < box[0].y) {
        ASSERT_EQ(*image.pixel(x, y), 100) << "nothing else changes";
      } else {
        dark += *image.pixel(x, y) < 150;
      }
  EXPECT_GT(dark, 100);
}

TEST(Sign, SmallPicturesTakeSeveralLinesAndTinyOnesNone) {
  Image narrow = paper(130, 200), tiny = paper(30, 200);
  const auto box = sign(narrow, "© OpenStreetMap contributors, ODbL 1.0; aerial image The Survey, 2023, CC BY 4.0");
  EXPECT_LT(box[0].y, 165) << "three lines at least";
  EXPECT_EQ(inked(narrow).right <= 130, true);
  sign(tiny, "© OpenStreetMap contributors");
  EXPECT_EQ(tiny, paper(30, 200));
}

}  // namespace
}  // namespace blockrand::picture
