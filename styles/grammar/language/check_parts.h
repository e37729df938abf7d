// The parts that check() is made of; included by check*.cpp alone.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "styles/grammar/language/check.h"

namespace blockrand::grammar::detail {

/// One module while it is checked.
struct Checked {
  const Program& program;
  const Module& module;
  const Unit& unit;
  std::vector<Diagnostic>& told;

  void tell(Severity severity, const char* code, Location location, std::string message, std::string_view text = {},
            std::string_view suggestion = {}) const {
    told.push_back({severity, code, location, std::move(message), std::string(text), std::string(suggestion)});
  }
  const Expression& expression(NodeId id) const { return unit.expressions[id]; }
};

/// The value of an expression that is the same whatever happens: literals, operators on them, constants of the file.
std::optional<double> constant_number(const Checked& c, NodeId expression);
/// The same of a truth value.
std::optional<bool> constant_truth(const Checked& c, NodeId expression);

void check_choices(const Checked& c);
void check_sizes(const Checked& c);
void check_types(const Checked& c);
void check_calls(const Checked& c, const CheckOptions& options);
/// All styles of the file, in force or not (docs/rule_language.md §1.6).
void check_styles(const Checked& c);
/// Values that imports give to attributes (docs/rule_language.md §1.5).
void check_overrides(const Program& program, std::vector<Diagnostic>& told);
void check_rules(const Program& program, std::vector<Diagnostic>& told);

}  // namespace blockrand::grammar::detail
