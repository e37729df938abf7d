// Small text helpers that several folders need.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace blockrand::base {

/// 1234567 → "1,234,567".
std::string with_thousands(std::uint64_t value);

/// 1536000 → "1.5 MB" (powers of 1000).
std::string with_byte_unit(std::uint64_t bytes);

/// Shortest decimal text that reads back as the same double; "0" for -0. Independent of the locale.
std::string shortest(double value);

}  // namespace blockrand::base
