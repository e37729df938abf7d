// Expectations in comments of rule files: read, held, and told when they are not.
#include "styles/grammar/evaluation/rule_tests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "derive_support.h"

namespace blockrand::grammar {
namespace {

using namespace testing_support;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> failures(const std::string& expectation, const std::string& rules) {
  const std::string text = "// expect: " + expectation + "\n" + rules;
  const auto tests = read_rule_tests(text);
  EXPECT_EQ(tests.size(), 1u);
  return run_rule_test(load_text(text), tests[0]).failures;
}

constexpr const char* kWalls =
    "attr height = 30\nLot --> extrude(height) comp(f){ side : W }\nW --> report(\"area\", geometry.area) print(1) W.";

TEST(RuleTests, Hold) {
  EXPECT_THAT(
      failures("lot 10x20; leaves 4; leaves W. 4; report area sum 1800; report area min 300; report area count 4",
               kWalls),
      IsEmpty());
  EXPECT_THAT(
      failures("attr height=3; size W. 10 3 0; size W. - - 0; area 180; area W. 180; print 1 1 1 1; lot 10x20", kWalls),
      IsEmpty());
  EXPECT_THAT(failures("lot 10x20; volume 1000; seed 4; rule Box", "First --> X.\nBox --> extrude(5)"), IsEmpty());
  EXPECT_THAT(failures("attr building.storeys=4; print 4", "Lot --> print(building.storeys)"), IsEmpty());
  EXPECT_THAT(failures("warning no_rule; leaves 1", "Lot --> Unknown"), IsEmpty());
  EXPECT_THAT(failures("error operation; leaves 1", "Lot --> color(\"red\") X."), IsEmpty());
}

TEST(RuleTests, TheSeedReachesConsistentChoices) {
  for (const std::string kind : {"building", "row"}) {
    const std::string rules = "@Consistent(\"" + kind + "\")\nLot --> 50% : A. else : B.";
    int a = 0;
    for (int seed = 0; seed < 40; ++seed)
      a += failures("seed " + std::to_string(seed) + "; leaves A. 1", rules).empty() ? 1 : 0;
    EXPECT_GT(a, 5) << kind;
    EXPECT_LT(a, 35) << kind;
  }
}

TEST(RuleTests, Fail) {
  EXPECT_THAT(failures("leaves 3", kWalls), ElementsAre("the number of leaves is 4, not 3"));
  EXPECT_THAT(failures("leaves X 3", kWalls), ElementsAre("the number of leaves of X is 0, not 3"));
  EXPECT_THAT(failures("report length sum 3", kWalls), ElementsAre("nothing was reported as length"));
  EXPECT_THAT(failures("lot 10x20; report area mean 3", kWalls), ElementsAre("the mean of area is 450, not 3"));
  EXPECT_THAT(failures("size W. 11 30 0", kWalls), ElementsAre("the size along x of W. is 10, not 11"));
  EXPECT_THAT(failures("size V. 11 30 0", kWalls), ElementsAre("there is no leaf V."));
  EXPECT_THAT(failures("print 2", kWalls), ElementsAre("printed was '1 1 1 1', not '2'"));
  EXPECT_THAT(failures("warning depth; leaves 4", kWalls), ElementsAre("there was no warning depth"));
  const auto told = failures("leaves 1", "Lot --> color(\"red\") X.");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_THAT(told[0], HasSubstr("2:9"));
}

TEST(RuleTests, CannotBeUnderstood) {
  EXPECT_THAT(failures("leaves many", kWalls)[0], HasSubstr("'leaves many' is no clause"));
  EXPECT_THAT(failures("lot 10", kWalls)[0], HasSubstr("'lot 10' is no clause"));
  EXPECT_THAT(failures("lot 10x20", kWalls), ElementsAre("nothing is expected"));
  EXPECT_THAT(read_rule_tests("Lot --> A. // expect: leaves 1\n/* expect: leaves 1 */\n"), IsEmpty());
  const auto lines = read_rule_tests("\n# expect: leaves 1\r\n\n//expect: leaves 2; lot 3x4.5");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].line, 2u);
  EXPECT_EQ(lines[1].line, 4u);
  EXPECT_EQ(lines[1].depth, 4.5);
}

}  // namespace
}  // namespace blockrand::grammar
