#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace blockrand::base {

/// How deep arrays and objects of a JSON text are nested: 1 for `{}`, 0 for a number. Of a text that is no JSON, some
/// number. Known before the text is parsed, because a parser's callback costs: nlohmann's searches an object's siblings
/// after each object then, which is quadratic in the length of an array.
inline std::size_t json_depth(std::string_view text) {
  std::size_t depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return deepest;
}

}  // namespace blockrand::base
