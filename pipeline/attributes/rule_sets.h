// Which rule sets and presets a run has: found in configs/, or named by the user.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "styles/districts/rule_set.h"

namespace blockrand::attributes {

struct ReadRuleSets {
  districts::RuleSets book;
  /// Files that were read, and vector files that rules name: how documents call them ("districts/berlin.toml"), and
  /// their paths.
  std::vector<std::pair<std::string, std::string>> files;
};

/// Reads configs/styles/presets.toml and, where `districts` is empty, all of configs/districts/*.toml; else the one set
/// that it names, by name or file, which then holds everywhere.
/// \throws base::InputError  from the files; two sets without polygon
/// \throws base::UsageError  there is no such set
ReadRuleSets read_rule_sets(const std::string& configs, const std::string& districts);

}  // namespace blockrand::attributes
