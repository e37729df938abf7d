// Names of the program in words that anybody knows. Internal to this folder.
#pragma once

#include <string>
#include <string_view>

namespace blockrand::outputs {

/// From there on a confidence is "sure", "likely"; below it is "a guess" (docs/usage.md).
inline constexpr double kSure = 0.85, kLikely = 0.6;
std::string_view confidence_word(double confidence);

/// "5 windows", "1 window".
std::string count_of(double n, std::string_view one, std::string_view many = {});

/// "a, b and c".
template <class Texts>
std::string and_list(const Texts& texts) {
  std::string out;
  std::size_t i = 0;
  for (const auto& text : texts) {
    if (i > 0) out += i + 1 == texts.size() ? " and " : ", ";
    out += text;
    ++i;
  }
  return out;
}

/// "a house", "an office building".
std::string with_article(std::string_view noun);

/// "half_timbered" → "half timbered".
std::string with_spaces(std::string_view name);

/// A value of building=*: "apartments" → "block of flats"; others with spaces.
std::string use_words(std::string_view use);
/// A roof shape (model/roof_shape.h): "gabled roof", "Berlin roof (steep to the street, low to the yard)".
std::string roof_words(std::string_view shape);
/// "mid_row" → "within a row of houses"; empty for what is not known.
std::string_view position_words(std::string_view position);
/// "SE" → "south-east".
std::string_view direction_words(std::string_view compass);
/// "gruenderzeit" → "a Gründerzeit house".
std::string_view class_words(std::string_view style_class);
/// "1840_1918" → "1840 to 1918"; empty for what is not known.
std::string_view era_words(std::string_view era);
/// "casement_window" → nothing, as windows are counted; "balcony" → "balcony" and "balconies". Empty: not told.
struct ElementWords {
  std::string_view one, many;
};
ElementWords element_words(std::string_view kind);

/// What a code of pipeline/model/issue_codes.h means for who looks at the model; empty: its own meaning is plain enough.
std::string_view consequence_words(std::string_view code);

}  // namespace blockrand::outputs
