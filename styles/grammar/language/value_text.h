// How values are written: `str`, `print`, and strings joined with other values.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "styles/grammar/language/value.h"

namespace blockrand::grammar {

/// A number without trailing zeros, at most 15 significant digits: the reference prints 0.15 * 3 as 0.45 (page
/// func_colon). "nan", "inf" and "-inf" where it is none.
std::string number_text(double value);

/// As `str` and `print` write it: texts as they are, truth as "true" or "false", arrays as "(3)[1,2,3]", those of more
/// rows than one as "(2x2)[1,2;3,4]".
std::string value_text(const Value& value);

/// The number that a text starts with; nan where it starts with none (docs/rule_language.md §3.2, `float`).
double leading_number(std::string_view text);

/// false for "f", "false", "0", "0.0" and the like (docs/rule_language.md §3.2, `bool`).
bool truth_of(std::string_view text);

/// "number", "number array" ... for messages.
std::string_view type_name(Type type);

/// What a function returns that fails: the text says why.
inline tl::unexpected<std::string> failure(std::string message) {
  return tl::unexpected<std::string>(std::move(message));
}

}  // namespace blockrand::grammar
