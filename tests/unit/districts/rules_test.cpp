// District rules: inheritance, priorities, draws, choice by polygon, and every error at its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "pipeline/base/error.h"
#include "styles/districts/assign.h"
#include "styles/districts/read_rule_set.h"
#include "tests/unit/base/text_file.h"

namespace blockrand::districts {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

void add_rule_set(const std::string& text, const std::string& name, RuleSets& book) {
  read_rule_set(base::test::TextFile(name, text).path(), book);
}

RuleSets book_of(const std::string& text) {
  RuleSets book;
  for (const char* name : {"a", "b", "c"}) book.presets.push_back({name, "one", model::StyleClass::gruenderzeit, {}});
  book.presets[1].style = model::StyleClass::modern;
  book.presets[1].substyles = {"reform_block"};
  book.substyles = {"gz_high", "reform_block"};
  add_rule_set(text, "rules.toml", book);
  return book;
}

std::string error_of(const std::string& text) {
  try {
    book_of(text);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

Subject house(std::int64_t id = 1) {
  Subject s;
  s.id = {model::OsmType::way, id};
  s.use = "apartments";
  s.area = 300;
  s.position = model::BuildingPosition::mid_row;
  return s;
}

std::string preset_of(const RuleSets& book, const Subject& s) {
  const Decision d = decide(book, 0, s, 1);
  EXPECT_EQ(d, assign(book, 0, s, 1).decision);
  return d.preset == Decision::kNone ? "" : book.presets[d.preset].name;
}

TEST(Inheritance, FinerLevelsOverrideAndInheritParameters) {
  const RuleSets book = book_of(R"(
[[rule]]
name = "city"
level = "city"
preset = "a"
parameters = { ornament = 0.1, plinth = 0.5, colour = "grey" }
[[rule]]
name = "district"
level = "district"
parameters = { ornament = 0.2, plinth = 0.6 }
[[rule]]
name = "block"
level = "block"
which.position = "mid_row"
preset = "b"
[[rule]]
name = "building"
which.area = [200, 400]
parameters = { ornament = 0.9 }
)");
  const Assignment a = assign(book, 0, house(), 1);
  EXPECT_EQ(book.presets[a.decision.preset].name, "b");
  ASSERT_EQ(a.parameters.size(), 3u);
  EXPECT_EQ(a.parameters[0].value, "grey");
  EXPECT_EQ(a.parameters[1].value, "0.9");
  EXPECT_EQ(a.parameters[2].value, "0.6");
  EXPECT_EQ(book.sets[0].rules[a.parameters[1].rule].name, "building");
  EXPECT_EQ(a.fired.size(), 4u);
  EXPECT_THAT(a.why, AllOf(HasSubstr("rule 'block'"), HasSubstr("mid row")));
  ASSERT_EQ(a.other_candidates.size(), 1u);
  EXPECT_EQ(a.other_candidates[0].value, "a");
  Subject corner = house();
  corner.position = model::BuildingPosition::corner_house;
  EXPECT_EQ(preset_of(book, corner), "a");
}

TEST(Inheritance, PriorityThenOrderOfTheFileDecideWithinALevel) {
  const std::string text = R"(
[[rule]]
name = "first"
which.use = "apartments"
preset = "a"
[[rule]]
name = "second"
which.use = "apartments"
priority = %
preset = "b"
)";
  const auto with = [&](const char* priority) {
    std::string t = text;
    return book_of(t.replace(t.find('%'), 1, priority));
  };
  EXPECT_EQ(preset_of(with("0"), house()), "a");
  EXPECT_EQ(preset_of(with("1"), house()), "b");
  EXPECT_EQ(preset_of(with("-1"), house()), "a");
}

TEST(Which, FrontIsTheWidthOfTheStreetFront) {
  const RuleSets book = book_of(
      "[[rule]]\nname = \"wide\"\nwhich.front = [10.5, 60]\npreset = \"a\"\n[[rule]]\nname = \"all\"\nlevel = "
      "\"city\"\npreset = \"b\"\n");
  Subject s = house();
  EXPECT_EQ(preset_of(book, s), "b") << "no front is known";
  s.front = 8;
  EXPECT_EQ(preset_of(book, s), "b");
  s.front = 12;
  EXPECT_EQ(preset_of(book, s), "a");
  EXPECT_THAT(assign(book, 0, s, 1).why, HasSubstr("a front of 12.0 m"));
}

TEST(Draw, FollowsTheWeightsAndTheBuildingAlone) {
  const RuleSets book = book_of("[[rule]]\nname = \"r\"\npreset = { a = 0.7, b = 0.3 }\n");
  int a = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string drawn = preset_of(book, house(i + 1));
    a += drawn == "a";
    Subject again = house(i + 1);
    again.area = 10;  // nothing but seed and id enters
    if (i < 50) {
      EXPECT_EQ(preset_of(book, again), drawn);
    }
  }
  EXPECT_NEAR(a / 20000.0, 0.7, 0.015);
}

TEST(Draw, BlockRulesDrawOncePerBlock) {
  const RuleSets book = book_of("[[rule]]\nname = \"r\"\nlevel = \"block\"\npreset = { a = 0.5, b = 0.5 }\n");
  std::set<std::string> over_blocks;
  for (int block = 0; block < 40; ++block) {
    const std::string id = "w" + std::to_string(block) + ".n1.l";
    std::set<std::string> in_block;
    for (int i = 0; i < 10; ++i) {
      Subject s = house(100 * block + i + 1);
      s.block = id;
      in_block.insert(preset_of(book, s));
    }
    EXPECT_EQ(in_block.size(), 1u) << id;
    over_blocks.merge(in_block);
  }
  EXPECT_EQ(over_blocks.size(), 2u);
}

TEST(Predicates, ClassNeedsItsProbabilityAndUnknownIsUniform) {
  const RuleSets book = book_of(R"(
[[rule]]
name = "sure"
which.style = "modern"
which.probability = 0.6
preset = "b"
[[rule]]
name = "any"
level = "city"
preset = "a"
)");
  EXPECT_EQ(preset_of(book, house()), "a");
  model::BuildingStyle style;
  style.style = {0.2f, 0.1f, 0.65f, 0.05f};
  Subject s = house();
  s.style = &style;
  EXPECT_EQ(preset_of(book, s), "b");
  EXPECT_NEAR(decide(book, 0, s, 1).confidence, 0.65 * 0.8, 2e-3);
  style.style = {0.3f, 0.1f, 0.55f, 0.05f};
  EXPECT_EQ(preset_of(book, s), "a");
}

TEST(Predicates, ASubStyleNeedsItsProbabilityAmongThoseOfItsClass) {
  const auto with = [](const char* probability) {
    return book_of(std::string("[[rule]]\nname = \"known\"\nwhich.substyle = \"gz_high\"\n") + probability +
                   "preset = \"b\"\n[[rule]]\nname = \"any\"\nlevel = \"city\"\npreset = \"a\"\n");
  };
  model::BuildingStyle style;
  style.style = {0.8f, 0.1f, 0.05f, 0.05f};
  style.substyle_p = 0.48f;  // 0.6 of its class
  Subject s = house();
  s.style = &style;
  s.substyle = "gz_high";
  EXPECT_EQ(preset_of(with(""), s), "b");
  EXPECT_NEAR(decide(with(""), 0, s, 1).confidence, 0.48 * 0.8, 2e-3) << "class x sub-style in the class x level";
  EXPECT_EQ(preset_of(with("which.probability = 0.7\n"), s), "a");
  style.substyle_p = 0.32f;  // 0.4 of its class: another is likelier than not
  EXPECT_EQ(preset_of(with(""), s), "a");
  EXPECT_EQ(preset_of(with("which.probability = 0.3\n"), s), "b");
  s.overridden_style = "gz_high";
  EXPECT_EQ(preset_of(with("which.probability = 0.9\n"), s), "b") << "what is ordered is certain";
}

TEST(Predicates, AskOnlyWhatARuleNeedsAndAllMustHold) {
  const RuleSets book = book_of(R"(
[[rule]]
name = "r"
where.built_share = [0.4, 1]
where.near = [{ railway = "rail", within = 300 }]
which.storeys = [4, 6]
which.tag = ["heritage", "shop=*"]
which.years = [1870, 1890]
preset = "a"
)");
  model::BuildingStyle style;
  style.years = model::YearRange{1888, 1895};
  Subject s = house();
  s.style = &style;
  s.cell = [](CellStatistic c) { return c == CellStatistic::built_share ? std::optional(0.5) : std::nullopt; };
  s.storeys = [] { return std::optional(5.0); };
  s.tag = [](std::string_view key) -> std::string_view {
    return key == "heritage" ? "4" : key == "shop" ? "bakery" : "";
  };
  bool near = true;
  s.holds = [&](std::uint32_t q) { return q == 0 && near; };
  EXPECT_EQ(preset_of(book, s), "a");
  EXPECT_THAT(assign(book, 0, s, 1).why,
              AllOf(HasSubstr("within 300 m of railway=rail"), HasSubstr("built_share 0.50"), HasSubstr("5 storeys")));
  near = false;
  EXPECT_EQ(preset_of(book, s), "");
  near = true;
  style.years = model::YearRange{1895, 1900};
  EXPECT_EQ(preset_of(book, s), "");
  style.years = model::YearRange{1888, 1895};
  s.storeys = [] { return std::optional<double>(); };
  EXPECT_EQ(preset_of(book, s), "") << "what nobody knows holds in no range";
}

TEST(Tags, OfTheBuildingBeatThoseOfTheAreaAndBothBeatRules) {
  const RuleSets book = book_of("[[rule]]\nname = \"r\"\npreset = \"a\"\n");
  Subject s = house();
  s.area_tag = [](std::string_view key) -> std::optional<Subject::AreaTag> {
    if (key != "blockrand:preset") return std::nullopt;
    return Subject::AreaTag{"b", {model::OsmType::relation, 7}};
  };
  Assignment a = assign(book, 0, s, 1);
  EXPECT_EQ(book.presets[a.decision.preset].name, "b");
  EXPECT_EQ(a.decision.source, model::Source::district);
  EXPECT_THAT(a.why, HasSubstr("r7"));
  s.tag = [](std::string_view key) -> std::string_view { return key == "blockrand:preset" ? "c" : ""; };
  a = assign(book, 0, s, 1);
  EXPECT_EQ(book.presets[a.decision.preset].name, "c");
  EXPECT_EQ(a.decision.source, model::Source::tag);
  ASSERT_EQ(a.other_candidates.size(), 2u);
  EXPECT_EQ(a.other_candidates[0].value, "b");
  EXPECT_EQ(a.other_candidates[1].value, "a");
  s.tag = [](std::string_view key) -> std::string_view { return key == "blockrand:preset" ? "nobody" : ""; };
  a = assign(book, 0, s, 1);
  EXPECT_EQ(book.presets[a.decision.preset].name, "b");
  EXPECT_THAT(a.unreadable, ElementsAre("blockrand:preset=nobody"));
}

TEST(Tags, AStyleReplacesWhatClassificationSays) {
  const RuleSets book = book_of(R"(
[[rule]]
name = "m"
which.style = "modern"
preset = "b"
[[rule]]
name = "s"
priority = 1
which.substyle = "reform_block"
preset = "c"
[[rule]]
name = "any"
level = "city"
preset = "a"
)");
  Subject s = house();
  std::string_view style = "modern";
  s.tag = [&](std::string_view key) -> std::string_view { return key == "blockrand:style" ? style : ""; };
  EXPECT_EQ(preset_of(book, s), "b");
  style = "reform_block";
  EXPECT_EQ(preset_of(book, s), "c");
  style = "rococo";
  EXPECT_EQ(preset_of(book, s), "a");
  EXPECT_THAT(assign(book, 0, s, 1).unreadable, ElementsAre("blockrand:style=rococo"));
  s.overridden_style = "modern";
  EXPECT_EQ(preset_of(book, s), "b") << "an override beats the tag";
}

TEST(Choice, TheSmallestPolygonThatHoldsTheBuildingWins) {
  RuleSets book;
  book.presets.push_back({"a", "one", model::StyleClass::other, {}});
  const std::string rule = "[[rule]]\nname = \"r\"\npreset = \"a\"\n";
  add_rule_set("polygon = [[10, 50], [11, 50], [11, 51], [10, 51]]\n" + rule, "town.toml", book);
  add_rule_set(rule, "anywhere.toml", book);
  add_rule_set("polygon = [[10.4, 50.4], [10.6, 50.4], [10.6, 50.6], [10.4, 50.6]]\n" + rule, "old_town.toml", book);
  const auto at = [&](double lon, double lat) {
    return book.sets[book.choose({static_cast<std::int32_t>(lon * 1e7), static_cast<std::int32_t>(lat * 1e7)})].name;
  };
  EXPECT_EQ(at(10.5, 50.5), "old_town");
  EXPECT_EQ(at(10.4, 50.5), "old_town") << "the boundary belongs to it";
  EXPECT_EQ(at(10.2, 50.2), "town");
  EXPECT_EQ(at(13.4, 52.5), "anywhere");
  RuleSets none;
  EXPECT_EQ(none.choose({0, 0}), RuleSets::kNoSet);
}

TEST(Choice, PolygonsAreExact) {
  const std::vector<model::Location> c = {{0, 0}, {40, 0}, {40, 10}, {10, 10}, {10, 30}, {40, 30}, {40, 40}, {0, 40}};
  EXPECT_TRUE(holds(c, {5, 20}));
  EXPECT_FALSE(holds(c, {20, 20}));
  EXPECT_TRUE(holds(c, {20, 5}));
  EXPECT_TRUE(holds(c, {10, 20}));
  EXPECT_FALSE(holds(c, {-1, 10}));
  EXPECT_FALSE(holds(c, {41, 10}));
}

struct Wrong {
  const char* text;
  std::vector<const char*> words;
};

TEST(Errors, EveryMistakeIsToldAtItsPlace) {
  const std::string rule = "[[rule]]\nname = \"r\"\n";
  const std::vector<Wrong> all = {
      {"[[rule]]\nname = \"r\"\npreset = \"aa\"\n", {"rules.toml:3", "aa", "Did you mean a"}},
      {"[[rule]]\npreset = \"a\"\n", {"rules.toml:1", "name"}},
      {"[[rule]]\nname = \"r\"\n", {"rules.toml:1", "gives nothing"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nlevel = \"distrikt\"\n", {"rules.toml:4", "Did you mean district"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nprioriti = 3\n", {"rules.toml:4", "unknown key", "priority"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.style = \"modren\"\n", {"rules.toml:4", "Did you mean modern"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.era = \"1840-1918\"\n",
       {"rules.toml:4", "Did you mean 1840_1918"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.position = \"midrow\"\n",
       {"rules.toml:4", "Did you mean mid_row"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.position = \"unknown\"\n", {"rules.toml:4", "position"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.use = []\n", {"rules.toml:4", "nothing can satisfy"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.area = [300, 200]\n",
       {"rules.toml:4", "least value is above its most"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.storeys = [300, 400]\n", {"rules.toml:4", "can never hold"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.party_wall_share = [1.5, 2]\n",
       {"rules.toml:4", "can never hold"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.era = \"pre1840\"\nwhich.years = [1900, 1910]\n",
       {"rules.toml:5", "outside of the eras"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.probability = 0.3\n", {"rules.toml:4", "belongs to no style"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.substyle = \"gz_hihg\"\n",
       {"rules.toml:4", "Did you mean gz_high"}},
      {"[[rule]]\nname = \"r\"\npreset = { a = 0.5, b = 0.2 }\n", {"rules.toml:3", "sum to 0.7"}},
      {"[[rule]]\nname = \"r\"\npreset = { a = 1, b = 0 }\n", {"rules.toml:3", "weight 0"}},
      {"[[rule]]\nname = \"r\"\npreset = { a = 1.5, b = -0.5 }\n", {"rules.toml:3", "weight -0.5"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.near = { railway = \"rail\" }\n",
       {"rules.toml:4", "within", "missing"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.near = { railway = \"rail\", within = 5000 }\n",
       {"rules.toml:4", "2000"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.near = { railwy = \"rail\", within = 50 }\n",
       {"rules.toml:4", "Did you mean railway"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.bbox = [1, 2, 3]\n", {"rules.toml:4", "four numbers"}},
      {"polygon = [[10, 50], [11, 50], [11, 51]]\n[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.bbox = [50, 10, 51, "
       "11]\n",
       {"rules.toml:5", "can never hold"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.bbox = [190, 50, 200, 51]\n", {"rules.toml:4", "longitude 190"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.bbox = [10, 50, 11, 95]\n", {"rules.toml:4", "latitude 95"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.bbox = [11, 51, 10, 50]\n", {"rules.toml:4", "is empty"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.tag = \"=foo\"\n", {"rules.toml:4", "names no key"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.tag = \"foo=\"\n", {"rules.toml:4", "names no value"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.place = \"\"\n", {"rules.toml:4", "is empty"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.boundary = \"\"\n", {"rules.toml:4", "is empty"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.near = { railway = \"\", within = 50 }\n",
       {"rules.toml:4", "is empty"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhere.polygon = \"nowhere.geojson\"\n",
       {"rules.toml:4", "not there: ", "/nowhere.geojson"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\nwhich.style = \"tenement\"\nwhich.substyle = \"reform_block\"\n",
       {"rules.toml:5", "another class than tenement"}},
      {"", {"rules.toml:1", "no rule"}},
      {"title = \"x\"\n", {"rules.toml:1", "no rule"}},
      {"polygon = [[10, 50], [11, 50]]\n", {"rules.toml:1", "encloses nothing"}},
      {"polygon = [[10, 50], [11, 50], [11, 95]]\n", {"rules.toml:1", "nowhere"}},
      {"[[rule]]\nname = \"r\"\npreset = \"a\"\n[[rule]]\nname = \"r\"\npreset = \"b\"\nwhich.use = \"yes\"\n",
       {"rules.toml:4", "line 1"}},
      {"[[rule]]\nname = \"all\"\npreset = \"a\"\n[[rule]]\nname = \"dead\"\nlevel = \"city\"\npreset = \"b\"\n",
       {"rules.toml:4", "'dead'", "'all' (line 1"}},
      {"[[rule]]\nname = \"all\"\npriority = 1\nparameters = { x = 1 }\n[[rule]]\nname = \"dead\"\nwhich.use = "
       "\"yes\"\nparameters = { x = 2 }\n",
       {"rules.toml:5", "can never have an effect"}},
      {"[prior]\nstyle = { modern = 0.5 }\n", {"rules.toml:2", "sums to 0.5"}},
      {"[prior]\nstyle = { modren = 1 }\n", {"rules.toml:2", "Did you mean modern"}},
      {"[prior]\nsubstyle = { gz_hgih = 1 }\n", {"rules.toml:2", "Did you mean gz_high"}},
      {"[prior]\nstoreys = { slabs = 5 }\n", {"rules.toml:2", "Did you mean slab"}},
      {"[presets.a]\ndescription = \"twice\"\nclass = \"other\"\n", {"rules.toml:1", "already"}},
      {"[presets.d]\ndescription = \"x\"\nclass = \"otter\"\n", {"rules.toml:3", "class"}},
  };
  for (const Wrong& wrong : all) {
    const std::string error = error_of(wrong.text);
    for (const char* word : wrong.words) EXPECT_THAT(error, HasSubstr(word)) << wrong.text;
  }
}

TEST(Errors, RulesThatCanStillActAreNone) {
  EXPECT_EQ(error_of("[[rule]]\nname = \"all\"\npreset = \"a\"\nlevel = \"city\"\n[[rule]]\nname = \"r\"\npreset = "
                     "\"b\"\nwhich.use = \"yes\"\n"),
            "no error");
  EXPECT_EQ(
      error_of(
          "[[rule]]\nname = \"all\"\nparameters = { x = 1 }\n[[rule]]\nname = \"r\"\nparameters = { x = 2, y = 3 }\n"),
      "no error");
}

TEST(Priors, AreReadAndPresetsOfASetCount) {
  const RuleSets book = book_of(R"(
[presets.mine]
description = "of this town"
class = "gruenderzeit"
[[rule]]
name = "r"
preset = "mine"
[prior]
style = { gruenderzeit = 0.25, modern = 0.75 }
era = { 1840_1918 = 1 }
substyle = { gz_high = 1 }
storeys = { slab = 6 }
)");
  const Priors& p = book.sets[0].prior;
  ASSERT_TRUE(p.style && p.era);
  EXPECT_THAT(*p.style, ElementsAre(0.25, 0, 0.75, 0));
  EXPECT_THAT(*p.era, ElementsAre(0, 1, 0, 0));
  EXPECT_EQ(p.substyle.at("gz_high"), 1);
  EXPECT_EQ(p.storeys.at("slab"), 6);
  EXPECT_EQ(preset_of(book, house()), "mine");
}

constexpr const char* kBase = R"(
[presets.mine]
description = "of the base"
class = "modern"
[[rule]]
name = "usual"
level = "city"
preset = "a"
parameters = { ornament = 0.1 }
[[rule]]
name = "near water"
where.near = { waterway = "river", within = 50 }
preset = "b"
[[rule]]
name = "rows"
which.position = "mid_row"
preset = "b"
[prior]
style = { gruenderzeit = 0.25, modern = 0.75 }
era = { 1840_1918 = 1 }
substyle = { gz_high = 1 }
absent = ["reform_block"]
storeys = { slab = 6, terrace = 2 }
)";

/// Reads `text` with kBase as base.toml beside it.
RuleSets book_with_base(const std::string& text) {
  RuleSets book;
  for (const char* name : {"a", "b", "c"}) book.presets.push_back({name, "one", model::StyleClass::gruenderzeit, {}});
  book.substyles = {"gz_high", "reform_block"};
  const base::test::TextFile base("base.toml", kBase);
  const std::string path = (std::filesystem::path(base.path()).parent_path() / "derived.toml").string();
  std::ofstream(path) << text;
  read_rule_set(path, book);
  return book;
}

std::string error_with_base(const std::string& text) {
  try {
    book_with_base(text);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Base, IsTakenOverReplacedAndLeftOut) {
  const RuleSets book = book_with_base(R"(
base = "base"
without = ["near water"]
[[rule]]
name = "rows"
which.position = "mid_row"
preset = "c"
[prior]
substyle = { reform_block = 1 }
storeys = { slab = 8 }
)");
  ASSERT_EQ(book.sets.size(), 1u);
  const RuleSet& set = book.sets[0];
  EXPECT_EQ(set.name, "derived");
  EXPECT_EQ(set.title, "derived") << "a title is not taken over";
  ASSERT_EQ(set.bases.size(), 1u);
  EXPECT_THAT(set.bases[0], testing::EndsWith("base.toml"));
  ASSERT_EQ(set.rules.size(), 2u);
  EXPECT_EQ(set.rules[0].name, "rows");
  EXPECT_THAT(set.rules[0].file, testing::EndsWith("derived.toml"));
  EXPECT_EQ(set.rules[1].name, "usual");
  EXPECT_THAT(set.rules[1].file, testing::EndsWith("base.toml"));
  EXPECT_TRUE(set.queries.empty()) << "nobody asks for what only a rule that is left out asked for";
  EXPECT_EQ(preset_of(book, house()), "c");
  Subject free_standing = house();
  free_standing.position = model::BuildingPosition::free_standing;
  EXPECT_EQ(preset_of(book, free_standing), "a");
  const Priors& p = set.prior;
  ASSERT_TRUE(p.style && p.era);
  EXPECT_THAT(*p.style, ElementsAre(0.25, 0, 0.75, 0));
  EXPECT_EQ(p.substyle.size(), 1u) << "shares are replaced whole";
  EXPECT_TRUE(p.absent.empty()) << "a sub-style with a share is not absent";
  EXPECT_EQ(p.storeys.at("slab"), 8);
  EXPECT_EQ(p.storeys.at("terrace"), 2) << "storeys are replaced one by one";
}

TEST(Base, ItsQueriesAndPresetsServeEverySetThatHasIt) {
  RuleSets book = book_with_base("base = \"base\"\ntitle = \"D\"\n");
  ASSERT_EQ(book.sets[0].queries.size(), 1u);
  EXPECT_THAT(book.sets[0].queries[0].asked_in, testing::EndsWith("base.toml"));
  const auto asking = std::find_if(book.sets[0].rules.begin(), book.sets[0].rules.end(),
                                   [](const Rule& r) { return r.name == "near water"; });
  ASSERT_NE(asking, book.sets[0].rules.end());
  EXPECT_THAT(asking->where.queries, ElementsAre(0u));
  EXPECT_NE(find_preset(book.presets, "mine"), kNoPreset);

  // The base read before, after, and by two sets: its presets stand once.
  RuleSets both;
  for (const char* name : {"a", "b", "c"}) both.presets.push_back({name, "one", model::StyleClass::gruenderzeit, {}});
  const base::test::TextFile base("base.toml", kBase);
  const std::filesystem::path folder = std::filesystem::path(base.path()).parent_path();
  std::ofstream(folder / "x.toml") << "base = \"base.toml\"\n";
  std::ofstream(folder / "y.toml") << "base = \"x\"\n";
  for (const char* name : {"x.toml", "base.toml", "y.toml"}) read_rule_set((folder / name).string(), both);
  EXPECT_EQ(both.presets.size(), 4u);
  ASSERT_EQ(both.sets.size(), 3u);
  EXPECT_EQ(both.sets[2].bases.size(), 2u) << "the base of a base counts, too";
  EXPECT_EQ(both.sets[2].rules.size(), 3u);
}

TEST(Base, IsLookedForBesideTheSetAndThenAmongTheShipped) {
  RuleSets book;
  for (const char* name : {"a", "b", "c"}) book.presets.push_back({name, "one", model::StyleClass::gruenderzeit, {}});
  const base::test::TextFile shipped("base.toml", kBase), mine("mine.toml", "base = \"base\"\n");
  const std::string folder = std::filesystem::path(shipped.path()).parent_path().string();
  EXPECT_THROW(read_rule_set(mine.path(), book), base::InputError);
  read_rule_set(mine.path(), book, folder);
  ASSERT_EQ(book.sets.size(), 1u);
  EXPECT_EQ(book.sets[0].bases, std::vector<std::string>{shipped.path()});
  EXPECT_EQ(book.sets[0].rules.size(), 3u);
}

TEST(Base, MistakesAreTold) {
  EXPECT_THAT(error_with_base("base = \"bse\"\n"),
              AllOf(HasSubstr("derived.toml:1"), HasSubstr("not there"), HasSubstr("bse.toml")));
  EXPECT_THAT(error_with_base("base = \"derived\"\n"), HasSubstr("leads back"));
  EXPECT_THAT(error_with_base("base = \"base\"\nwithout = [\"raws\"]\n"),
              AllOf(HasSubstr("derived.toml:2"), HasSubstr("'raws'"), HasSubstr("Did you mean rows?")));
  EXPECT_THAT(error_with_base("base = \"base\"\nwithout = [\"rows\"]\n[[rule]]\nname = \"rows\"\npreset = \"a\"\n"),
              HasSubstr("replaces"));
  EXPECT_THAT(error_of("without = [\"rows\"]\n[[rule]]\nname = \"r\"\npreset = \"a\"\n"), HasSubstr("there is none"));
  EXPECT_THAT(error_with_base("base = \"base\"\n[prior]\nabsent = [\"gz_high\"]\n"), HasSubstr("has a share"));
  EXPECT_THAT(error_with_base("base = \"base\"\n[prior]\nabsent = [\"gz_hih\"]\n"), HasSubstr("Did you mean gz_high?"));
  // A rule of the set that takes everything from one of the base: both files are named.
  EXPECT_THAT(error_with_base("base = \"base\"\n[[rule]]\nname = \"all\"\npriority = 9\npreset = \"a\"\n"),
              AllOf(HasSubstr("base.toml:"), HasSubstr("derived.toml, line 2")));
}

TEST(Shipped, EveryRuleSetIsReadAndGivesEveryBuildingAPreset) {
  const std::filesystem::path configs = std::filesystem::path(BLOCKRAND_SOURCE_DIR) / "configs";
  RuleSets book;
  book.presets = read_presets((configs / "styles" / "presets.toml").string());
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(configs / "districts"))
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) read_rule_set(file, book);
  EXPECT_GE(book.sets.size(), 6u);
  for (std::uint32_t i = 0; i < book.sets.size(); ++i) {
    EXPECT_NE(decide(book, i, house(), 1).preset, Decision::kNone) << book.sets[i].name;
    const auto preset = [&](const model::BuildingStyle& style, const char* use, double area, double storeys) {
      std::string first;
      for (int id = 1; id <= 50; ++id) {
        Subject s = house(id);
        s.style = &style;
        s.use = use;
        s.area = area;
        s.storeys = [storeys] { return std::optional(storeys); };
        first += book.presets[decide(book, i, s, 1).preset].name + " ";
      }
      return first;
    };
    model::BuildingStyle garage, other, low, other_class;
    other_class.style = {0, 0, 0, 1};
    other_class.era = {0.25f, 0.25f, 0.25f, 0.25f};
    garage.style = {0, 0, 0, 1};
    garage.era = {0, 0, 0, 1};
    garage.non_house = true;
    EXPECT_THAT(preset(garage, "garage", 20, 1), testing::StartsWith("garage")) << book.sets[i].name;
    EXPECT_THAT(preset(garage, "shed", 20, 1), testing::StartsWith("ancillary")) << book.sets[i].name;
    EXPECT_THAT(preset(other_class, "church", 600, 1), testing::StartsWith("church")) << book.sets[i].name;
    EXPECT_THAT(preset(garage, "bridge", 200, 1), testing::StartsWith("plain")) << book.sets[i].name;
    other.style = {0.3f, 0.1f, 0.25f, 0.35f};
    other.era = {0.1f, 0.3f, 0.3f, 0.3f};
    EXPECT_THAT(preset(other, "yes", 150, 3), testing::Not(HasSubstr("gz_"))) << book.sets[i].name;
    low.style = {0.45f, 0.15f, 0.25f, 0.15f};
    low.era = {0.1f, 0.3f, 0.3f, 0.3f};
    EXPECT_THAT(preset(low, "yes", 150, 1), testing::Not(HasSubstr("gz_"))) << book.sets[i].name;
    EXPECT_TRUE(book.sets[i].prior.style && book.sets[i].prior.era) << book.sets[i].name;
  }
  // A preset that no rule can choose is dead: nobody ever sees it.
  std::set<std::uint32_t> chosen;
  for (const RuleSet& set : book.sets)
    for (const Rule& rule : set.rules)
      for (const WeightedPreset& w : rule.presets) chosen.insert(w.preset);
  for (std::uint32_t p = 0; p < book.presets.size(); ++p)
    EXPECT_TRUE(chosen.contains(p)) << book.presets[p].name << " is chosen by no rule of any shipped set";
}

}  // namespace
}  // namespace blockrand::districts
