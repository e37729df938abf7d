// `blockrand explain`: why one building looks as it does.
#pragma once

#include <string>
#include <vector>

#include "pipeline/region/find_explanation.h"
#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

/// An explanation as text that a layman can read, 100 columns wide.
std::string explanation_text(const region::FoundExplanation& found);

settings::CommandText explain_text();
int run_explain(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
