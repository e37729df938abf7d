// Words for colours, drawn roofs and walls: what the model shows of them.
#include "pipeline/attributes/pigments.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "importers/osm/tag_values.h"
#include "pipeline/attributes/defaults.h"
#include "styles/classify/catalogue.h"

namespace blockrand::attributes {
namespace {

using model::Colour;

const Defaults& shipped() {
  static const Defaults defaults = read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  return defaults;
}

int span(Colour c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); }

TEST(Pigments, EachWordIsTheOneThatTagsHave) {
  ASSERT_GE(shipped().pigments.by_screen_colour.size(), 20u);
  for (const auto& [screen, pigment] : shipped().pigments.by_screen_colour) {
    EXPECT_TRUE(importers::osm::is_colour_word(pigment.name)) << pigment.name;
    EXPECT_EQ(importers::osm::parse_colour(pigment.name), screen) << pigment.name;
  }
}

TEST(Pigments, NoWordIsTheScreensOwnOnAnyMaterial) {
  // Of all that CSS names, nothing shows brighter than a glazed brick: walls are no lamps.
  for (const char* word :
       {"red", "lime", "blue", "magenta", "cyan", "yellow", "orange", "crimson", "gold", "springgreen"}) {
    const Colour screen = *importers::osm::parse_colour(word);
    for (const Material& m : shipped().materials) {
      const auto index = static_cast<std::uint8_t>(shipped().material(m.material_class.name));
      const Colour shown = shipped().pigments.on_material(screen, index);
      EXPECT_LT(span(shown), 170) << word << " on " << m.material_class.name;
      EXPECT_NE(shown, screen) << word << " on " << m.material_class.name;
    }
  }
  // Red means another red on each.
  const auto on = [&](const char* material) {
    return shipped().pigments.on_material({255, 0, 0}, static_cast<std::uint8_t>(shipped().material(material)));
  };
  EXPECT_NE(on("plaster"), on("brick"));
  EXPECT_NE(on("brick"), on("metal"));
}

TEST(Pigments, RoofsOfAllPalettesAreWeatheredIntoANarrowRange) {
  const auto& roofs = shipped().pigments.drawn_roofs;
  ASSERT_TRUE(roofs);
  const classify::Catalogue catalogue = classify::read_catalogue(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  int widest = 0, fresh = 0;
  for (const classify::Style& style : catalogue.styles())
    for (const Colour& drawn : style.roof_colours)
      for (std::uint64_t bits = 0; bits < 24; ++bits) {
        widest = std::max(widest, span(shipped().pigments.weathered(drawn, bits)));
        fresh = std::max(fresh, span(drawn));
      }
  EXPECT_GT(fresh, 110);
  EXPECT_LT(widest, 100);
}

TEST(Pigments, WithoutATableColoursAreAsMappedAndDrawn) {
  base::TomlTable empty = base::TomlTable::parse("", "materials.toml");
  const Pigments none = read_pigments(empty, [](std::string_view) { return -1; });
  EXPECT_EQ(none.on_material({255, 0, 0}, 3), (Colour{255, 0, 0}));
  EXPECT_EQ(none.muted({255, 0, 0}, 3), (Colour{255, 0, 0}));
  EXPECT_EQ(none.weathered({156, 50, 46}, 7), (Colour{156, 50, 46}));
  EXPECT_FALSE(none.drawn_roofs);
}

TEST(Pigments, SaturationIsCappedAtHueAndValue) {
  EXPECT_EQ(less_saturated({200, 100, 50}, 1), (Colour{200, 100, 50}));
  const Colour half = less_saturated({200, 0, 0}, 0.5);
  EXPECT_EQ(half, (Colour{200, 100, 100}));
  EXPECT_EQ(less_saturated({0, 0, 0}, 0.1), (Colour{0, 0, 0}));
}

TEST(Pigments, TellsWhatIsWrongWithItsPlace) {
  const auto message = [](const std::string& text) {
    base::TomlTable table = base::TomlTable::parse(text, "m.toml");
    try {
      read_pigments(table, [](std::string_view name) { return name == "brick" ? 0 : -1; });
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string("nothing");
  };
  EXPECT_NE(message("[pigment.red]\nscreen = \"red\"\nelsewhere = \"#aa0000\"").find("m.toml:2"), std::string::npos);
  EXPECT_NE(message("[pigment.red]\nscreen = \"#ff0000\"").find("elsewhere"), std::string::npos);
  EXPECT_NE(
      message("[pigment.red]\nscreen = \"#ff0000\"\nelsewhere = \"#aa0000\"\n[pigment.red.on]\nbrik = \"#aa0000\"")
          .find("brik"),
      std::string::npos);
  EXPECT_NE(
      message("[drawn_roofs]\nleast_weathered = 0.5\nmost_weathered = 0.2\ndirt = \"#777777\"").find("least_weathered"),
      std::string::npos);
}

}  // namespace
}  // namespace blockrand::attributes
