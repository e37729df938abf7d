// A tree as one line of text, so that tests can say what a parse should give.
#pragma once

#include <string>
#include <string_view>

#include "styles/grammar/language/ast.h"

namespace blockrand::grammar::test {

/// "attr h = (+ 1 (call f 'x))", "Lot --> extrude(5) comp(f){front : F}" …: fully bracketed, declarations separated by
/// "; ".
std::string tree_text(const Unit& unit);

}  // namespace blockrand::grammar::test
