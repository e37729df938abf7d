// Expectations that stand beside the rules, in comments of the rule file (docs/grammar_tests.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "styles/grammar/evaluation/derive.h"

namespace blockrand::grammar {

/// One line `// expect: clause; clause …`: a run, and what must come out.
struct RuleTest {
  std::uint32_t line = 0;
  double width = 10, depth = 10;  ///< m, of the lot
  DeriveOptions options;
  /// What must hold, by clause: {"leaves", "W", "4"}, {"report", "area", "sum", "1800"}.
  std::vector<std::vector<std::string>> expectations;
  std::string error;  ///< the line cannot be understood; then nothing else counts
};

struct RuleTestOutcome {
  std::uint32_t line = 0;
  std::vector<std::string> failures;  ///< one sentence each; empty: passed
};

/// The tests in a rule file's text, in order.
std::vector<RuleTest> read_rule_tests(std::string_view text);

/// Derives and compares. Numbers agree to a thousandth.
RuleTestOutcome run_rule_test(const Program& program, const RuleTest& test);

/// "12x8.5" as width and depth in metres. \returns false: it is none
bool read_lot(std::string_view text, double& width, double& depth);

/// A value as a person writes it: true, false, a number, or a text.
Value read_value(std::string_view text);

}  // namespace blockrand::grammar
