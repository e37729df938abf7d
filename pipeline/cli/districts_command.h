// blockrand districts: rule sets checked, shown on a map, compared.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

settings::CommandText districts_text();
/// \throws base::InputError, base::UsageError, base::OutputError
int run_districts(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
