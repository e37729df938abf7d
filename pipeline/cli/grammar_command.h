// blockrand grammar: rule files checked, rules of other programs translated.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

settings::CommandText grammar_text();
/// \throws base::InputError, base::UsageError, base::OutputError
int run_grammar(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
