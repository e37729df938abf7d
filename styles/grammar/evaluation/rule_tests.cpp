// Expectations in comments: reading them, deriving, comparing.
#include "styles/grammar/evaluation/rule_tests.h"

#include <charconv>
#include <cmath>

#include "styles/grammar/language/value_text.h"
#include "styles/grammar/shapes/initial_shape.h"
#include "styles/grammar/shapes/measure.h"

namespace blockrand::grammar {
namespace {

/// Expected numbers are written with few digits.
constexpr double kTolerance = 1e-3;
constexpr std::string_view kMark = "expect:";

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r')) s.remove_suffix(1);
  return s;
}
std::vector<std::string> words(std::string_view s) {
  std::vector<std::string> out;
  for (s = trimmed(s); !s.empty(); s = trimmed(s)) {
    const std::size_t end = std::min(s.find(' '), s.size());
    out.emplace_back(s.substr(0, end));
    s.remove_prefix(end);
  }
  return out;
}
bool read_number(std::string_view s, double& out) {
  const auto read = std::from_chars(s.data(), s.data() + s.size(), out);
  return read.ec == std::errc() && read.ptr == s.data() + s.size() && std::isfinite(out);
}

/// Whether the words are a clause that says what must hold.
bool is_expectation(const std::vector<std::string>& clause) {
  const std::string& kind = clause[0];
  double number = 0;
  if (kind == "leaves") return (clause.size() == 2 || clause.size() == 3) && read_number(clause.back(), number);
  if (kind == "report")
    return clause.size() == 4 && read_number(clause[3], number) &&
           (clause[2] == "count" || clause[2] == "sum" || clause[2] == "mean" || clause[2] == "min" ||
            clause[2] == "max");
  if (kind == "volume" || kind == "area")
    return (clause.size() == 2 || clause.size() == 3) && read_number(clause.back(), number);
  if (kind == "size") return clause.size() == 5;
  if (kind == "print") return clause.size() >= 2;
  return (kind == "error" || kind == "warning") && clause.size() == 2;
}

void read_clause(std::string_view text, RuleTest& test) {
  const std::vector<std::string> clause = words(text);
  if (clause.empty()) return;
  double number = 0;
  const std::string& kind = clause[0];
  const bool single = clause.size() == 2;
  if (kind == "lot" && single && read_lot(clause[1], test.width, test.depth)) return;
  if (kind == "seed" && single && read_number(clause[1], number)) {
    const auto seed = static_cast<std::uint64_t>(std::abs(number));
    test.options.seed = test.options.building_seed = test.options.row_seed = seed;
  } else if (kind == "rule" && single) {
    test.options.start_rule = clause[1];
  } else if (kind == "attr" && clause.size() >= 2 && text.find('=') != std::string_view::npos) {
    const std::string_view assignment = trimmed(trimmed(text).substr(4));
    const std::size_t equals = assignment.find('=');
    test.options.attributes.emplace_back(std::string(trimmed(assignment.substr(0, equals))),
                                         read_value(trimmed(assignment.substr(equals + 1))));
  } else if (is_expectation(clause)) {
    test.expectations.push_back(clause);
  } else if (test.error.empty()) {
    test.error = "'" + std::string(trimmed(text)) + "' is no clause of an expectation (docs/grammar_tests.md)";
  }
}

void compare_counts(const std::string& what, double found, double expected, std::vector<std::string>& failures) {
  if (std::abs(found - expected) <= kTolerance) return;
  failures.push_back(what + " is " + number_text(found) + ", not " + number_text(expected));
}

std::string joined(const std::vector<std::string>& parts, std::size_t from, const char* between) {
  std::string out;
  for (std::size_t i = from; i < parts.size(); ++i) out += (i > from ? between : "") + parts[i];
  return out;
}

void check(const std::vector<std::string>& clause, const Derivation& result, std::vector<std::string>& failures) {
  const std::string& kind = clause[0];
  double expected = 0;
  read_number(clause.back(), expected);
  const auto counts = [&](const Leaf& leaf) { return clause.size() < 3 || leaf.symbol == clause[1]; };
  const std::string of = clause.size() < 3 ? "" : " of " + clause[1];
  if (kind == "leaves" || kind == "volume" || kind == "area") {
    double found = 0;
    for (const Leaf& leaf : result.leaves)
      if (counts(leaf))
        found += kind == "leaves" ? 1 : kind == "volume" ? geometry_volume(leaf.shape) : geometry_area(leaf.shape);
    compare_counts((kind == "leaves" ? "the number of leaves" : "the " + kind) + of, found, expected, failures);
  } else if (kind == "report") {
    const Report* report = result.report(clause[1]);
    if (report == nullptr) return failures.push_back("nothing was reported as " + clause[1]);
    const std::string& which = clause[2];
    const double found = which == "count" ? static_cast<double>(report->count)
                         : which == "sum" ? report->sum
                         : which == "min" ? report->minimum
                         : which == "max" ? report->maximum
                                          : report->mean;
    compare_counts("the " + which + of, found, expected, failures);
  } else if (kind == "size") {
    for (const Leaf& leaf : result.leaves) {
      if (leaf.symbol != clause[1]) continue;
      const double found[3] = {leaf.shape.size.x, leaf.shape.size.y, leaf.shape.size.z};
      static constexpr const char* kAxes[3] = {"x", "y", "z"};
      for (std::size_t i = 0; i < 3; ++i)
        if (read_number(clause[2 + i], expected))
          compare_counts(std::string("the size along ") + kAxes[i] + of, found[i], expected, failures);
      return;
    }
    failures.push_back("there is no leaf " + clause[1]);
  } else if (kind == "print") {
    const std::string wanted = joined(clause, 1, " "), found = joined(result.prints, 0, " ");
    if (found != wanted) failures.push_back("printed was '" + found + "', not '" + wanted + "'");
  }
}

}  // namespace

bool read_lot(std::string_view text, double& width, double& depth) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return false;
  double w = 0, d = 0;
  if (!read_number(text.substr(0, cross), w) || !read_number(text.substr(cross + 1), d) || w <= 0 || d <= 0)
    return false;
  width = w;
  depth = d;
  return true;
}

Value read_value(std::string_view text) {
  double number = 0;
  if (text == "true" || text == "false") return text == "true";
  if (read_number(text, number)) return number;
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

std::vector<RuleTest> read_rule_tests(std::string_view text) {
  std::vector<RuleTest> out;
  std::uint32_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (line.starts_with("//"))
      line.remove_prefix(2);
    else if (line.starts_with("#"))
      line.remove_prefix(1);
    else
      continue;
    line = trimmed(line);
    if (!line.starts_with(kMark)) continue;
    line.remove_prefix(kMark.size());
    RuleTest test;
    test.line = number;
    while (!line.empty()) {
      const std::size_t stop = std::min(line.find(';'), line.size());
      read_clause(line.substr(0, stop), test);
      line.remove_prefix(std::min(stop + 1, line.size()));
    }
    if (test.error.empty() && test.expectations.empty()) test.error = "nothing is expected";
    out.push_back(std::move(test));
  }
  return out;
}

RuleTestOutcome run_rule_test(const Program& program, const RuleTest& test) {
  RuleTestOutcome out{test.line, {}};
  if (!test.error.empty()) {
    out.failures.push_back(test.error);
    return out;
  }
  const Shape lot = initial_shape({{0, 0, 0}, {test.width, 0, 0}, {test.width, 0, -test.depth}, {0, 0, -test.depth}});
  const Derivation result = derive(program, lot, test.options);
  for (const auto& clause : test.expectations) check(clause, result, out.failures);
  // Errors fail a test unless they are expected; expected ones must come.
  const auto expected = [&](const std::string& kind, const std::string& code) {
    for (const auto& clause : test.expectations)
      if (clause[0] == kind && clause[1] == code) return true;
    return false;
  };
  std::vector<const Diagnostic*> all;
  for (const Diagnostic& d : program.diagnostics) all.push_back(&d);
  for (const Diagnostic& d : result.diagnostics) all.push_back(&d);
  for (const Diagnostic* d : all)
    if (d->severity == Severity::error && !expected("error", d->code))
      out.failures.push_back(format(*d, program.files));
  for (const auto& clause : test.expectations) {
    if (clause[0] != "error" && clause[0] != "warning") continue;
    bool found = false;
    for (const Diagnostic* d : all)
      found = found || (d->code == clause[1] && (d->severity == Severity::error) == (clause[0] == "error"));
    if (!found) out.failures.push_back("there was no " + clause[0] + " " + clause[1]);
  }
  return out;
}

}  // namespace blockrand::grammar
