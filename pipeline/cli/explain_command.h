// `blockrand explain`: why one building looks as it does.
#pragma once

#include <string>
#include <vector>

#include "pipeline/outputs/explain/find_explanation.h"
#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

/// An explanation in about ten plain lines (outputs/explain/plain_explanation.h), 100 columns wide; control characters of the map's
/// texts are replaced.
/// \throws base::InputError  `found` lacks something that every explanation has
std::string plain_text(const outputs::FoundExplanation& found);

/// All of an explanation as text, 100 columns wide; control characters of the map's texts are replaced.
/// \param body  id of a body ("w123.rest") whose values are to be told, too; those of a part that was asked for always are
/// \param edges  also lists the wall segments of the outline: what each faces, how long it is, where it looks
/// \param style  lists all evidence for its style, not the weightiest alone
/// \throws base::InputError  `found` lacks something that every explanation has
std::string explanation_text(const outputs::FoundExplanation& found, const std::string& body = {}, bool edges = false,
                             bool style = false);

settings::CommandText explain_text();
int run_explain(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
