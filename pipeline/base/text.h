// Small text helpers that several folders need.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace blockrand::base {

/// 1234567 → "1,234,567".
std::string with_thousands(std::uint64_t value);

/// 1536000 → "1.5 MB" (powers of 1000); below 1000: "17 bytes".
std::string with_byte_unit(std::uint64_t bytes);

/// 0.42 → "0.4 s", 75 → "1 min 15 s", 7260 → "2 h 1 min".
std::string with_time_unit(double seconds);

/// Shortest decimal text that reads back as the same double; "0" for -0. Independent of the locale. Positional notation
/// from 1e-6 up to 1e17, scientific beyond; "nan", "inf", "-inf" for what is no number.
std::string shortest(double value);

/// `text` as a JSON string with its quotes; bytes that are not UTF-8 become U+FFFD.
std::string json_quoted(std::string_view text);

}  // namespace blockrand::base
