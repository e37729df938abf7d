// Expressions of element files: what they are worth, and what is none.
#include "styles/elements/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace blockrand::elements {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kNames{"w", "h", "frame"};

double worth(const std::string& text) {
  const auto e = Expression::parse(text, kNames);
  EXPECT_TRUE(e) << text << ": " << e.error();
  return e ? e->value(std::vector<double>{2, 3, 0.5}) : std::nan("");
}

std::string error(const std::string& text) {
  const auto e = Expression::parse(text, kNames);
  return e ? "" : e.error();
}

TEST(Expression, CalculatesAsOnPaper) {
  EXPECT_EQ(worth("1"), 1);
  EXPECT_EQ(worth(" .5 "), 0.5);
  EXPECT_EQ(worth("1e-2"), 0.01);
  EXPECT_EQ(worth("1 + 2 * 3"), 7);
  EXPECT_EQ(worth("(1 + 2) * 3"), 9);
  EXPECT_EQ(worth("8 - 4 - 2"), 2) << "from the left";
  EXPECT_EQ(worth("8 / 4 / 2"), 1);
  EXPECT_EQ(worth("-w / 2"), -1);
  EXPECT_EQ(worth("--w"), 2);
  EXPECT_EQ(worth("2 * -h"), -6);
  EXPECT_EQ(worth("w - 2 * frame"), 1);
  EXPECT_EQ(worth("min(w, h)"), 2);
  EXPECT_EQ(worth("max(1, w, min(h, 9), 2.5)"), 3);
  EXPECT_EQ(worth("h - max(w, h - frame) * (1 + 1)"), -2);
  EXPECT_TRUE(std::isinf(worth("w / 0")));
  EXPECT_EQ(Expression().value({}), 0);
  EXPECT_EQ(Expression(4.5).value({}), 4.5);
}

TEST(Expression, TellsWhereItIsWrong) {
  EXPECT_EQ(error(""), "column 1: a value is missing");
  EXPECT_EQ(error("w +"), "column 4: a value is missing");
  EXPECT_EQ(error("w * / 2"), "column 5: a value is missing before \"/\"");
  EXPECT_EQ(error("(w"), "column 3: a closing bracket is missing");
  EXPECT_EQ(error("w) "), "column 2: \")\" is not expected here");
  EXPECT_EQ(error("w h"), "column 3: \"h\" is not expected here");
  EXPECT_EQ(error("2w"), "column 1: this is no number");
  EXPECT_EQ(error("1e999"), "column 1: this is no number");
  EXPECT_EQ(error("1 + fram"), "column 5: there is no \"fram\"; did you mean \"frame\"?");
  EXPECT_EQ(error("i"), "column 1: there is no \"i\"; known: w, h, frame");
  EXPECT_THAT(error("min(w)"), HasSubstr("column 6: min and max want two values"));
  EXPECT_THAT(error("max"), HasSubstr("min and max want a bracket"));
  EXPECT_THAT(error("sin(w)"), HasSubstr("there is no \"sin\""));
  EXPECT_THAT(error("w ^ 2"), HasSubstr("\"^\" is not expected"));
}

TEST(Expression, EndsBadInput) {
  const std::string open(200, '('), signs(200, '-');
  EXPECT_THAT(error(open + "1" + std::string(200, ')')), HasSubstr("too deep"));
  EXPECT_THAT(error(signs + "1"), HasSubstr("too deep"));
  EXPECT_THAT(error(std::string(2000, ' ') + "1"), HasSubstr("longer than 1000"));
  std::string deep = "1";  // as much waits as may
  for (int i = 0; i < 15; ++i) deep = "1+2*min(3,4+5*(" + deep + "))";
  EXPECT_FALSE(std::isnan(worth(deep)));
  deep = "1";
  for (int i = 0; i < 40; ++i) deep = "1+2*min(3," + deep + ")";
  EXPECT_THAT(error(deep), HasSubstr("too deep"));
}

TEST(Expression, ParametersHaveNamesOfTheirOwn) {
  for (const char* name : {"bar", "bar_2", "W"}) EXPECT_TRUE(is_free_name(name)) << name;
  for (const char* name : {"", "w", "h", "i", "n", "min", "max", "2bar", "_bar", "bar-2", "a b"})
    EXPECT_FALSE(is_free_name(name)) << name;
}

}  // namespace
}  // namespace blockrand::elements
