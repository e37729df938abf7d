#include "styles/grammar/evaluation/pattern.h"

#include <cctype>

namespace blockrand::grammar {

tl::expected<std::regex, std::string> read_pattern(const std::string& pattern, bool ignore_case) {
  if (pattern.size() > kLongestPattern)
    return tl::unexpected("the pattern is longer than " + std::to_string(kLongestPattern) + " bytes");
  auto flags = std::regex_constants::ECMAScript;
  if (ignore_case) flags |= std::regex_constants::icase;
#ifdef __GLIBCXX__
  // The matcher that needs no stack and no exponential time.
  flags |= std::regex_constants::__polynomial;
#endif
  try {
    return std::regex(pattern, flags);
  } catch (const std::regex_error&) {
    return tl::unexpected("'" + pattern + "' is no pattern that is understood here");
  }
}

bool matches_wildcards(std::string_view text, std::string_view wildcards) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  constexpr std::size_t kNone = std::string_view::npos;
  // Only the last star can have to take more: the time is that of text times wildcards at most.
  std::size_t t = 0, w = 0, star = kNone, taken = 0;
  while (t < text.size()) {
    if (w < wildcards.size() && wildcards[w] == '*') {
      star = w++;
      taken = t;
    } else if (w < wildcards.size() && (wildcards[w] == '?' || lower(wildcards[w]) == lower(text[t]))) {
      ++w;
      ++t;
    } else if (star != kNone) {
      w = star + 1;
      t = ++taken;
    } else {
      return false;
    }
  }
  while (w < wildcards.size() && wildcards[w] == '*') ++w;
  return w == wildcards.size();
}

}  // namespace blockrand::grammar
