// Patterns that rule files search with: none of them takes exponential time or the stack.
#pragma once

#include <cstddef>
#include <regex>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace blockrand::grammar {

/// Longest text that a regular expression is tried on: a search that finds nothing takes its square, some seconds here.
inline constexpr std::size_t kLongestForPattern = 10000;  // bytes
inline constexpr std::size_t kLongestPattern = 200;       // bytes

/// A regular expression (ECMAScript) for the matcher that does not go back. The error says what is wrong with it.
tl::expected<std::regex, std::string> read_pattern(const std::string& pattern, bool ignore_case = false);

/// `*` stands for any characters, `?` for one; upper and lower case of ASCII are the same.
bool matches_wildcards(std::string_view text, std::string_view wildcards);

}  // namespace blockrand::grammar
