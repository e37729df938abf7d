// Rule text into a tree (docs/rule_language.md §1.2, §1.3).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "styles/grammar/language/ast.h"
#include "styles/grammar/language/source.h"

namespace blockrand::grammar {

/// Reads a whole file. After an error it goes on at the next declaration; what could not be read stands in the tree as
/// a broken declaration, so that uses of its name are not told as errors too. \param text  UTF-8 (to_utf8)
Unit parse(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics);

}  // namespace blockrand::grammar
