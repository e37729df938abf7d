// Rule files and what they name, on the disk.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/options.h"
#include "styles/elements/element_catalogue.h"
#include "styles/grammar/evaluation/functions.h"
#include "styles/grammar/language/check.h"
#include "styles/grammar/language/program.h"

namespace blockrand::cli {

/// The search table for a rule file: what --roots says, and the project that the file lies in (the folder above
/// `rules`).
grammar::LoadOptions rule_load_options(const settings::Settings& settings, const std::string& file);

/// Files and pictures that rules name: looked for below the project's `assets`, `images` and `data`, its own folder,
/// and --roots. Paths that are found are given as the rule file wrote them or, for searches, from the folder on.
/// Nothing above those folders is read.
grammar::FileAccess rule_file_access(const settings::Settings& settings, const std::string& file);

/// The elements that the rules of a file may order: of --configs, else of the configs that came with the program, and of the file's
/// own folder. Without any configs the built-in kinds.
/// \throws base::InputError  with the element file or profile that is broken
elements::ElementCatalogue rule_elements(const settings::Settings& settings, const std::string& file);

/// Our own operations, and the values that the program gives about buildings and walls.
grammar::CheckOptions rule_check_options(const elements::ElementCatalogue& elements);

}  // namespace blockrand::cli
