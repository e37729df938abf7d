// Rule sets from TOML files, checked as they are read.
#pragma once

#include <string>

#include "styles/districts/rule_set.h"

namespace blockrand::districts {

/// m. A tile that is built alone reads 3 km around it: a feature farther away could not be seen.
inline constexpr double kMaxNear = 2000;
inline constexpr double kMaxPlaceRadius = 30000;  ///< m; places are region data

/// Reads a rule set and adds it, and the presets it declares itself, to the book. Files that it names are relative to its
/// folder. The language: docs/districts.md.
///
/// \throws base::InputError  with file, line and column: not TOML, unknown keys and names (with the nearest known),
/// values
///                           out of range, predicates that nothing can satisfy (an empty list, a minimum above its
///                           maximum, years outside of the eras, a box outside of the set's polygon), weights that are
///                           not positive or do not sum to 1, two rules of one name, a rule that can have no effect
///                           because stronger ones without conditions take all it gives
/// \param shipped  folder where a base is looked for that does not lie beside the set; empty: nowhere
void read_rule_set(const std::string& path, RuleSets& book, const std::string& shipped = {});

}  // namespace blockrand::districts
