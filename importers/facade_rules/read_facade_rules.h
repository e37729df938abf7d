// Reads the rule XML of Bilke (2009): docs/sources.md, Bilke 3.7.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/model/facade_rules.h"

namespace blockrand::importers::facade_rules {

/// \throws base::InputError with file and line where the file cannot be read, is no XML, or says what the format does
/// not know
model::FacadeRules read_facade_rules(const std::string& path);

/// \param name  what messages call the text
model::FacadeRules parse_facade_rules(std::string_view xml, const std::string& name);

}  // namespace blockrand::importers::facade_rules
