#include "styles/districts/rule_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "pipeline/base/error.h"

namespace blockrand::districts {

namespace {

[[noreturn]] void fail(const Rule& rule, const std::string& what, const std::string& remedy) {
  throw base::InputError(rule.file, std::to_string(rule.line), "rule '" + rule.name + "' " + what, remedy);
}

/// \param seen_from  that a message is about: the file is told where it is another one
std::string of(const Rule& rule, const Rule& seen_from) {
  const std::string where = rule.file == seen_from.file ? std::string() : rule.file + ", ";
  return fmt::format("rule '{}' ({}line {}, level {}, priority {})", rule.name, where, rule.line, name(rule.level),
                     rule.priority);
}

}  // namespace

void check_rules(RuleSet& set) {
  std::map<std::string_view, const Rule*> names;
  for (const Rule& rule : set.rules)
    if (const auto [known, fresh] = names.emplace(rule.name, &rule); !fresh)
      fail(rule, fmt::format("has the name of the one in line {}", known->second->line), "Give it a name of its own");
  std::stable_sort(set.rules.begin(), set.rules.end(), [](const Rule& a, const Rule& b) {
    return a.level != b.level ? a.level > b.level : a.priority > b.priority;
  });
  const Rule* taker = nullptr;                    // the first rule without conditions that gives a preset
  std::map<std::string_view, const Rule*> taken;  // parameters that one without conditions sets
  for (const Rule& rule : set.rules) {
    const char* const kRemedy = "Give it a higher priority or a finer level, or give the other one conditions";
    if (!rule.presets.empty() && taker)
      fail(rule, "can never choose a preset: " + of(*taker, rule) + " is stronger and holds everywhere", kRemedy);
    if (rule.presets.empty()) {
      const auto is_taken = [&](const auto& p) { return taken.contains(p.first); };
      if (std::all_of(rule.parameters.begin(), rule.parameters.end(), is_taken))
        fail(rule,
             "can never have an effect: " + of(*taken.at(rule.parameters.begin()->first), rule) +
                 " is stronger and holds everywhere",
             kRemedy);
    }
    if (!rule.unconditional()) continue;
    if (!rule.presets.empty()) taker = &rule;
    for (const auto& [key, value] : rule.parameters) taken.emplace(key, &rule);
  }
}

}  // namespace blockrand::districts
