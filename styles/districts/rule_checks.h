// What only the rules of a set together tell. Internal to this folder.
#pragma once

#include "styles/districts/rule_set.h"

namespace blockrand::districts {

/// Brings the rules into the order of their strength.
/// \throws base::InputError  two rules of one name; a rule without effect
void check_rules(RuleSet& set);

}  // namespace blockrand::districts
