#include "pipeline/settings/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "pipeline/settings/reference.h"
#include "tests/unit/settings/another_value.h"

namespace blockrand::settings {
namespace {

using testing::HasSubstr;

const Option& option(std::string_view name) {
  for (const Option& o : options())
    if (o.name == name) return o;
  throw std::logic_error("no option " + std::string(name));
}

std::string error_of(std::string_view name, const std::string& text) {
  Settings s;
  try {
    option(name).set(s, text);
  } catch (const ValueError& error) {
    return std::string(error.what()) + ". " + error.remedy;
  }
  return "no error";
}

TEST(Options, EveryOneHasNameMeaningAndBothWays) {
  std::set<std::string> names, keys;
  for (const Option& o : options()) {
    EXPECT_TRUE(names.insert(std::string(o.name)).second) << o.name;
    if (!o.letter.empty()) {
      EXPECT_TRUE(names.insert(std::string(o.letter)).second) << o.name;
    }
    if (!o.key.empty()) {
      EXPECT_TRUE(keys.insert(std::string(o.section.name) + "." + std::string(o.key)).second);
    }
    EXPECT_FALSE(o.help.empty()) << o.name;
    EXPECT_EQ(o.help.find('\n'), std::string_view::npos) << o.name;
    EXPECT_EQ(o.help.find('|'), std::string_view::npos) << o.name << " would break the reference's table";
    EXPECT_TRUE(o.set && o.show) << o.name;
    EXPECT_EQ(on_by_default(o), !o.without.empty()) << o.name << ": --no-… must say what is left out, and only it";
    EXPECT_EQ(shown_help(o).find('|'), std::string_view::npos) << o.name;
    for (const std::string& choice : o.choices) {
      Settings s;
      EXPECT_NO_THROW(o.set(s, choice)) << o.name;
    }
    EXPECT_EQ(o.argument.empty(), o.type == OptionType::flag) << o.name;
    if (o.type == OptionType::integer || o.type == OptionType::number) {
      EXPECT_LT(o.minimum, o.maximum) << o.name;
    }
  }
}

TEST(Options, EveryDefaultIsAValidValueThatSetsItself) {
  for (const Option& o : options()) {
    const Settings fresh;
    Settings s;
    const std::string value = o.show(fresh);
    if (!value.empty()) {
      EXPECT_NO_THROW(o.set(s, value)) << o.name;
    }
    EXPECT_EQ(o.show(s), value) << o.name;
  }
}

TEST(Options, EveryOneSetsAFieldOfItsOwn) {
  // A copied line of the table that sets its neighbour's field shows here.
  for (const Option& o : options()) {
    Settings s;
    const std::string value = another_value(o, s);
    o.set(s, value);
    EXPECT_EQ(o.show(s), value) << o.name;
    const Settings fresh;
    for (const Option& other : options())
      if (&other != &o) {
        EXPECT_EQ(other.show(s), other.show(fresh)) << o.name << " also sets " << other.name;
      }
  }
}

TEST(Options, NumbersAreCheckedForRangeAndForm) {
  EXPECT_THAT(error_of("jobs", "1025"), HasSubstr("out of range. Write a whole number from 0 to 1024."));
  EXPECT_THAT(error_of("jobs", "-1"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("jobs", "two"), HasSubstr("'two' is not a number"));
  EXPECT_THAT(error_of("jobs", "1.5"), HasSubstr("not a whole number"));
  EXPECT_THAT(error_of("jobs", "1e2"), HasSubstr("not a whole number"));
  EXPECT_THAT(error_of("jobs", ""), HasSubstr("not a number"));
  EXPECT_THAT(error_of("lod", "4"), HasSubstr("from 0 to 3"));
  EXPECT_THAT(error_of("ground-height", "nan"), HasSubstr("not a number"));
  EXPECT_THAT(error_of("ground-height", "12m"), HasSubstr("not a number"));
  EXPECT_THAT(error_of("seed", "-3"), HasSubstr("at least 0"));
  EXPECT_THAT(error_of("seed", "99999999999999999999"), HasSubstr("out of range"));
  Settings s;
  option("seed").set(s, "9007199254740993");
  EXPECT_EQ(s.build.seed, 9007199254740993u) << "above 2^53 no double may come between";
}

TEST(Options, BoxesMustBeSane) {
  EXPECT_EQ(error_of("bbox", "12.36, 51.33, 12.40, 51.35"), "no error");
  EXPECT_THAT(error_of("bbox", "1,2,3"), HasSubstr("does not have four numbers"));
  EXPECT_THAT(error_of("bbox", "1,2,3,x"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(error_of("bbox", "1,2,3,inf"), HasSubstr("not a number"));
  EXPECT_THAT(error_of("bbox", "1,5,3,4"), HasSubstr("south is not below north"));
  EXPECT_THAT(error_of("bbox", "3,4,1,5"), HasSubstr("west is not left of east"));
  EXPECT_THAT(error_of("bbox", "1,4,1,5"), HasSubstr("west is not left of east"));
  EXPECT_THAT(error_of("bbox", "-181,4,1,5"), HasSubstr("longitude"));
  EXPECT_THAT(error_of("bbox", "10,50,11,91"), HasSubstr("Longitude comes first"));
}

TEST(Options, FormatsAreAListWithAliases) {
  for (const std::string text : {"gltf", "tileset", "3dtiles", "gltf, tileset"}) {
    Settings s;
    option("formats").set(s, text);
    EXPECT_TRUE(s.build.outputs.writes("gltf") && !s.build.outputs.writes("citygml")) << text;
  }
  Settings s;
  option("formats").set(s, "citygml,gltf");
  EXPECT_TRUE(s.build.outputs.writes("gltf") && s.build.outputs.writes("citygml"));
  EXPECT_THAT(error_of("formats", "cityglm"), HasSubstr("Did you mean citygml?"));
  EXPECT_THAT(error_of("formats", ""), HasSubstr("Known: gltf, citygml"));
  EXPECT_THAT(error_of("formats", "gltf,"), HasSubstr("'' is unknown"));
}

TEST(Options, FlagsAreShownByTheNameThatChangesSomething) {
  EXPECT_EQ(shown_name(option("gzip")), "--gzip");
  EXPECT_EQ(shown_name(option("report")), "--no-report");
  EXPECT_EQ(shown_name(option("INPUT")), "INPUT");
  EXPECT_THAT(std::string(shown_help(option("report"))), HasSubstr("no report.html"));
  EXPECT_EQ(default_text(option("report")), "");
  EXPECT_EQ(default_text(option("lod")), "3");
}

TEST(Options, CoordinateSystemsAreEpsgCodes) {
  for (const std::string text : {"EPSG:25833", "epsg:25833", "25833"}) {
    Settings s;
    option("crs").set(s, text);
    EXPECT_EQ(s.build.crs, "EPSG:25833");
  }
  EXPECT_THAT(error_of("crs", "UTM33"), HasSubstr("not an EPSG code"));
  EXPECT_THAT(error_of("crs", "EPSG:"), HasSubstr("not an EPSG code"));
}

TEST(Reference, DocsOptionsMdIsCurrent) {
  std::ifstream file(BLOCKRAND_SOURCE_DIR "/docs/options.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, options_markdown()) << "run: blockrand help options --markdown > docs/options.md";
}

}  // namespace
}  // namespace blockrand::settings
