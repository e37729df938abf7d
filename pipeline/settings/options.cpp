#include "pipeline/settings/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace blockrand::settings {
namespace {

/// Behind the option that `option` names, else behind the one before it in its own table, else behind its section.
std::vector<Option>::iterator place_of(const Option& option, const Option* before, std::vector<Option>& all) {
  std::string_view after = option.after;
  if (after.empty() && before && before->section == option.section) after = before->name;
  if (!after.empty()) {
    const auto found = std::ranges::find(all, after, &Option::name);
    assert(found != all.end() && found->section == option.section);
    if (found != all.end()) return found + 1;
  }
  const auto last =
      std::find_if(all.rbegin(), all.rend(), [&](const Option& o) { return o.section == option.section; });
  return last == all.rend() ? all.end() : last.base();
}

void add(const base::OptionTable<Settings>& table, std::vector<Option>& all) {
  const Option* before = nullptr;
  for (const Option& option : table) {
    all.insert(place_of(option, before, all), option);
    before = &option;
  }
}

std::vector<Option> collected() {
  std::vector<Option> all;
  add(base::of_member(run::build_options(), &Settings::build), all);
  add(base::of_member(run::region_options(), &Settings::region_options), all);
  add(base::of_member(outward::publish_options(), &Settings::publishing), all);
  add(base::of_member(validate::validate_options(), &Settings::validation), all);
  add(base::of_member(compare::compare_options(), &Settings::comparison), all);
  add(base::of_member(compare::report_options(), &Settings::comparison_report), all);
  for (const base::OptionTable<Settings>& table : command_options()) add(table, all);
  return all;
}

}  // namespace

const std::vector<Option>& options() {
  static const std::vector<Option> all = collected();
  return all;
}

const std::vector<base::OptionSection>& sections() {
  static const std::vector<base::OptionSection> all = [] {
    std::vector<base::OptionSection> found;
    for (const Option& o : options())
      if (found.empty() || found.back() != o.section) found.push_back(o.section);
    return found;
  }();
  return all;
}

bool in_config(const base::OptionSection& section) {
  return std::ranges::any_of(options(), [&](const Option& o) { return o.section == section && !o.key.empty(); });
}

std::string default_text(const Option& option) {
  static const Settings fresh;
  return option.type == OptionType::flag ? "" : option.show(fresh);
}

std::string range_text(const Option& option) {
  if (option.type != OptionType::integer && option.type != OptionType::number) return "";
  if (option.maximum >= 1e15) return fmt::format("from {}", option.minimum);
  return fmt::format("{} to {}", option.minimum, option.maximum);
}

bool on_by_default(const Option& option) {
  static const Settings fresh;
  return option.type == OptionType::flag && option.show(fresh) == "true";
}

std::string shown_name(const Option& option) {
  if (option.positional()) return std::string(option.name);
  return (on_by_default(option) ? "--no-" : "--") + std::string(option.name);
}

std::string_view shown_help(const Option& option, unsigned commands) {
  for (const auto& [of, help] : option.help_of)
    if (commands != 0 && (commands & ~of) == 0) return help;
  return on_by_default(option) ? option.without : option.help;
}

}  // namespace blockrand::settings
