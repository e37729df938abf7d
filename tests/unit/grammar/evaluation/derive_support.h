// Rule text in, derivation out: what tests of evaluation share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/language/program.h"
#include "styles/grammar/language/value_text.h"
#include "styles/grammar/shapes/initial_shape.h"

namespace blockrand::grammar::testing_support {

/// Other files that the rule text imports, by name.
using Files = std::map<std::string, std::string>;

inline Program load_text(const std::string& rules, const Files& files = {}) {
  LoadOptions options;
  options.read = [&](const std::string& path) -> std::optional<std::string> {
    const std::string name = path.substr(path.rfind('/') + 1);
    if (name == "main.cga") return rules;
    const auto found = files.find(name);
    return found == files.end() ? std::nullopt : std::optional<std::string>(found->second);
  };
  return load("main.cga", options);
}

inline std::string all_diagnostics(const std::vector<Diagnostic>& diagnostics) {
  std::string out;
  for (const Diagnostic& d : diagnostics)
    out += std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.code + ": " + d.message +
           (d.text.empty() ? "" : " '" + d.text + "'") + "\n";
  return out;
}

inline Derivation derive_text(const std::string& rules, const Shape& lot, const DeriveOptions& options = {},
                              const Files& files = {}) {
  const Program program = load_text(rules, files);
  EXPECT_FALSE(has_errors(program.diagnostics)) << all_diagnostics(program.diagnostics) << rules;
  return derive(program, lot, options);
}

/// R(w, d) of docs/rule_language.md §7.4: first edge along x at z = 0.
inline Shape rectangle(double width, double depth) {
  return initial_shape({{0, 0, 0}, {width, 0, 0}, {width, 0, -depth}, {0, 0, -depth}});
}
inline Shape u_shape() {
  return initial_shape(
      {{0, 0, 0}, {5, 0, 0}, {5, 0, -10}, {15, 0, -10}, {15, 0, 0}, {20, 0, 0}, {20, 0, -20}, {0, 0, -20}});
}
inline Shape l_shape() {
  return initial_shape({{0, 0, 0}, {20, 0, 0}, {20, 0, -10}, {10, 0, -10}, {10, 0, -20}, {0, 0, -20}});
}
inline Shape triangle() { return initial_shape({{0, 0, 0}, {10, 0, 0}, {0, 0, -10}}); }

inline std::vector<const Leaf*> leaves_of(const Derivation& derivation, std::string_view symbol) {
  std::vector<const Leaf*> out;
  for (const Leaf& leaf : derivation.leaves)
    if (leaf.symbol == symbol) out.push_back(&leaf);
  return out;
}
inline const Shape& leaf(const Derivation& derivation, std::string_view symbol, std::size_t index = 0) {
  const auto found = leaves_of(derivation, symbol);
  static const Shape kNothing;
  EXPECT_GT(found.size(), index) << symbol;
  return found.size() > index ? found[index]->shape : kNothing;
}

/// To a thousandth, for texts.
inline std::string rounded(double value) { return number_text(std::round(value * 1000) / 1000); }

/// "A 2, B 1": symbols with their size along x.
inline std::string lengths(const Derivation& derivation) {
  std::string out;
  for (const Leaf& leaf : derivation.leaves)
    out += (out.empty() ? "" : ", ") + leaf.symbol.substr(0, leaf.symbol.find('.')) + " " + rounded(leaf.shape.size.x);
  return out;
}
inline std::string size_text(const Shape& shape) {
  return rounded(shape.size.x) + " " + rounded(shape.size.y) + " " + rounded(shape.size.z);
}
inline std::string prints_text(const Derivation& derivation) {
  std::string out;
  for (const std::string& line : derivation.prints) out += (out.empty() ? "" : " ") + line;
  return out;
}

}  // namespace blockrand::grammar::testing_support
