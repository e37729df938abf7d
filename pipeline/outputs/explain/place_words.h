// Addresses and names as words that can be compared. Internal to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace blockrand::outputs {

/// Folded (base/folded_text.h), kinds of streets in their short form ("Straße", "Str." → "str", also at the end of a word), words
/// that people leave out left out ("ulica", "Hausnr."). A house number is one word: "5 a" → "5a", "3 – 7" → "3-7".
std::vector<std::string> place_words(std::string_view text);

/// Starts with a digit.
bool is_number(std::string_view word);

/// The words without spaces between them: "Zionskirch Straße" and "Zionskirchstr." are one.
std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end);

/// One of the addresses of a place.
struct PlaceAddress {
  std::string street;                ///< joined words; empty where none is mapped
  std::string shown_street;          ///< as mapped
  std::vector<std::string> numbers;  ///< "5", "5a", "3-7", "1234/45"
};
struct PlaceAddresses {
  std::vector<PlaceAddress> all;
  std::vector<std::string> locality;  ///< words of postcodes and towns
};
/// \param text  a field of explain/places.tsv: "Arkonaplatz 5, 10435 Berlin; Swinemünder Straße 12"
PlaceAddresses place_addresses(std::string_view text);

enum class NumberMatch { none, beside, half, same };
/// `half`: one of two numbers that a house has, "45" of "1234/45" (Prague), "39" of "39/40". `beside`: the same but for its letter,
/// or within a range: "5" and "5a", "5" and "3-7".
NumberMatch match_numbers(std::string_view wanted, std::string_view there);

/// The first number of a word: 5 of "5a" and of "5-7"; 0 where there is none.
long first_number(std::string_view word);

}  // namespace blockrand::outputs
