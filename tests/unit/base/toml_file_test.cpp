#include "pipeline/base/toml_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "pipeline/base/error.h"

namespace blockrand::base {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(TomlTable, ReadsEveryKindOfValue) {
  TomlTable t = TomlTable::parse(R"(
a = 1.5
b = 2
c = true
d = "text"
e = ["x", "y"]
f = [1, 2.5]
[g]
h = -3
)",
                                 "t.toml");
  EXPECT_EQ(t.number("a", 0, 10), 1.5);
  EXPECT_EQ(t.number("b", 0, 10), 2.0);
  EXPECT_EQ(t.integer("b", 0, 10), 2);
  EXPECT_EQ(t.boolean("c"), true);
  EXPECT_EQ(t.text("d"), "text");
  EXPECT_THAT(*t.texts("e"), ElementsAre("x", "y"));
  EXPECT_THAT(*t.numbers("f"), ElementsAre(1.0, 2.5));
  TomlTable g = *t.table("g");
  EXPECT_EQ(g.integer("h", -5, 5), -3);
  g.finish();
  t.finish();
  EXPECT_EQ(t.number("absent", 0, 1), std::nullopt);
  EXPECT_THAT(t.keys(), ElementsAre("a", "b", "c", "d", "e", "f", "g"));
  EXPECT_EQ(t.plain("f"), "1,2.5");
  EXPECT_EQ(t.plain("c"), "true");
}

/// toml++ walks them by recursion: fifty thousand overflowed the stack.
TEST(TomlTable, KeysOfManyPartsAreRefused) {
  std::string deep = "a";
  for (int i = 0; i < 50'000; ++i) deep += ".a";
  for (const std::string& text :
       {"x = 1\n[" + deep + "]\n", "x = 1\n" + deep + " = 1\n", "x = 1\ny = {" + deep + " = 1}\n"})
    EXPECT_THAT(error_of([&] { TomlTable::parse(text, "t.toml"); }),
                AllOf(StartsWith("t.toml:"), HasSubstr("2"), HasSubstr("more than 64 parts")));
  // Dots of texts, comments and numbers are none of a key.
  const std::string dots(200, '.');
  TomlTable t = TomlTable::parse("a = \"" + dots + "\\\"" + dots + "\" # " + dots + "\nb = '" + dots + "'\nc = \"\"\"" +
                                     dots + "\n\"" + dots + "\"\"\"\nd = 1.5 #" + dots,
                                 "t.toml");
  EXPECT_EQ(t.text("b"), dots);
  EXPECT_EQ(t.number("d", 0, 2), 1.5);
}

TEST(TomlTable, ErrorsNameFileLineColumnAndKey) {
  TomlTable t = TomlTable::parse("\n[roof]\npitch = \"steep\"\nheight = 300\ncount = 1.5\n", "t.toml");
  TomlTable roof = *t.table("roof");
  EXPECT_THAT(error_of([&] { roof.number("pitch", 0, 1); }),
              StartsWith("t.toml:3:9: roof.pitch must be a number, not a text"));
  EXPECT_THAT(error_of([&] { roof.number("height", 0, 100); }),
              AllOf(StartsWith("t.toml:4:10: roof.height is out of range: 300"), HasSubstr("from 0 to 100")));
  EXPECT_THAT(error_of([&] { roof.integer("count", 0, 9); }),
              StartsWith("t.toml:5:9: roof.count must be a whole number"));
  EXPECT_THAT(error_of([&] { t.text("roof"); }), StartsWith("t.toml:2:1: roof must be a text in quotes, not a table"));
  EXPECT_THAT(error_of([&] { roof.fail("pitch", "is too steep", "Flatten it."); }),
              StartsWith("t.toml:3:9: roof.pitch is too steep. Flatten it."));
}

TEST(TomlTable, NanIsOutOfEveryRange) {
  TomlTable t = TomlTable::parse("x = nan\ny = inf\nz = [inf]", "t.toml");
  EXPECT_THAT(error_of([&] { t.number("x", 0, 1); }), HasSubstr("out of range"));
  EXPECT_THAT(error_of([&] { t.number("y", 0, std::numeric_limits<double>::max()); }), HasSubstr("out of range"));
  EXPECT_THAT(error_of([&] { t.numbers("z"); }), HasSubstr("finite"));
}

TEST(TomlTable, WholeNumbersThatADoubleRoundsAreNumbers) {
  TomlTable t =
      TomlTable::parse("x = 99999999999999993\nl = [9007199254740993]\np = [[1, 9007199254740993]]", "t.toml");
  EXPECT_THAT(error_of([&] { t.number("x", 0, 100); }), HasSubstr("out of range: 1e+17"));
  EXPECT_EQ(t.numbers("l")->at(0), 9007199254740992.0);
  EXPECT_EQ(t.pairs("p")->at(0).second, 9007199254740992.0);
}

TEST(TomlTable, WhereCalculationsMayStandNumbersMayToo) {
  TomlTable t = TomlTable::parse(
      "a = 3\nb = 'w / 2'\nl = [1.5, 'h']\np = [[0, 'h'], ['w', 2]]\nbad = [true]\nodd = [[1, 2, 3]]\nn = nan\nt = "
      "false",
      "t.toml");
  EXPECT_EQ(t.number_or_text("a"), NumberOrText(3.0));
  EXPECT_EQ(t.number_or_text("b"), NumberOrText("w / 2"));
  EXPECT_FALSE(t.number_or_text("c"));
  EXPECT_EQ(t.numbers_or_texts("l"), (std::vector<NumberOrText>{1.5, "h"}));
  const std::vector<std::pair<NumberOrText, NumberOrText>> pairs{{0.0, "h"}, {"w", 2.0}};
  EXPECT_EQ(t.pairs_of_numbers_or_texts("p"), pairs);
  EXPECT_THAT(error_of([&] { t.numbers_or_texts("bad"); }),
              StartsWith("t.toml:5:8: bad must hold numbers and texts only, not a boolean"));
  EXPECT_THAT(error_of([&] { t.pairs_of_numbers_or_texts("odd"); }), HasSubstr("pairs of numbers and texts only"));
  EXPECT_THAT(error_of([&] { t.number_or_text("n"); }), HasSubstr("n must be a number or a text"));
  EXPECT_THAT(error_of([&] { t.numbers_or_texts("a"); }), HasSubstr("a must be an array"));
  EXPECT_TRUE(t.holds_number("a") && !t.holds_number("b") && t.holds_boolean("t") && !t.holds_boolean("a"));
}

TEST(TomlTable, AnUnaskedKeyIsAnErrorWithTheNearestKnownOne) {
  TomlTable t = TomlTable::parse("storeys = 3\nheigth = 12\n", "t.toml");
  t.integer("storeys", 0, 99);
  t.number("height", 0, 99);
  EXPECT_THAT(error_of([&] { t.finish(); }), StartsWith("t.toml:2:1: unknown key heigth. Did you mean height?"));
}

TEST(TomlTable, WithoutANearKeyTheKnownOnesAreListed) {
  TomlTable t = TomlTable::parse("entirely_different = 3\n", "t.toml");
  t.integer("storeys", 0, 99);
  t.number("height", 0, 99);
  EXPECT_THAT(error_of([&] { t.finish(); }), HasSubstr("Known keys here: height storeys."));
}

TEST(TomlTable, BadSyntaxAndUnreadableFilesAreInputErrors) {
  EXPECT_THAT(error_of([] { TomlTable::parse("a = 1\nb = = 2\n", "t.toml"); }),
              StartsWith("t.toml:2:5: not valid TOML"));
  EXPECT_THAT(error_of([] { TomlTable::parse("a = \"\xFF\"", "t.toml"); }), HasSubstr("not valid TOML"));
  EXPECT_THAT(error_of([] { TomlTable::read("/nowhere/x.toml"); }), StartsWith("/nowhere/x.toml: No such file"));
  EXPECT_THAT(error_of([] { TomlTable::read("/tmp"); }), StartsWith("/tmp: Is a directory"));
}

TEST(TomlTable, SubtablesOutliveTheirRoot) {
  TomlTable sub = *TomlTable::parse("[a.b]\nc = 1\n", "t.toml").table("a");
  TomlTable inner = *sub.table("b");
  EXPECT_EQ(inner.integer("c", 0, 9), 1);
  EXPECT_THAT(error_of([&] { inner.integer("c", 5, 9); }), StartsWith("t.toml:2:5: a.b.c is out of range"));
}

TEST(Nearest, FindsSlipsAndNothingElse) {
  const std::vector<std::string> known = {"format", "formats", "jobs", "lod", "ground_height", "gzip"};
  EXPECT_EQ(nearest("fromats", known), "formats");
  EXPECT_EQ(nearest("job", known), "jobs");
  EXPECT_EQ(nearest("lodd", known), "lod");
  EXPECT_EQ(nearest("ground-hieght", known), "ground_height");
  EXPECT_EQ(nearest("GZIP", known), "gzip");
  EXPECT_EQ(nearest("xyz", known), "");
  EXPECT_EQ(nearest("", known), "");
  EXPECT_EQ(nearest("anything", {}), "");
}

}  // namespace
}  // namespace blockrand::base
