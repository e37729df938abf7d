#include "importers/osm/text_cleaner.h"

#include <cstdint>

namespace blockrand::importers::osm {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

struct Step {
  std::size_t length;  ///< bytes to go on by, at least 1
  bool good;
};

/// Looks at the sequence that begins at `text[i]`.
Step next_character(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char lead = byte(i);
  if (lead < 0x80) return {1, lead >= 0x20 || lead == '\t' || lead == '\n' || lead == '\r'};
  std::size_t length = 0;
  std::uint32_t code = 0;
  unsigned char low = 0x80, high = 0xBF;  // range of the second byte: excludes overlong forms and surrogates
  if (lead >= 0xC2 && lead <= 0xDF) {
    length = 2;
    code = lead & 0x1F;
  } else if (lead >= 0xE0 && lead <= 0xEF) {
    length = 3;
    code = lead & 0x0F;
    if (lead == 0xE0) low = 0xA0;
    if (lead == 0xED) high = 0x9F;
  } else if (lead >= 0xF0 && lead <= 0xF4) {
    length = 4;
    code = lead & 0x07;
    if (lead == 0xF0) low = 0x90;
    if (lead == 0xF4) high = 0x8F;
  } else {
    return {1, false};
  }
  for (std::size_t k = 1; k < length; ++k) {
    if (i + k >= text.size() || byte(i + k) < low || byte(i + k) > high) return {k, false};
    code = (code << 6) | (byte(i + k) & 0x3F);
    low = 0x80;
    high = 0xBF;
  }
  return {length, code != 0xFFFE && code != 0xFFFF};
}

}  // namespace

bool is_clean_text(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const Step step = next_character(text, i);
    if (!step.good) return false;
    i += step.length;
  }
  return true;
}

std::string clean_text(std::string_view text) {
  std::string out;
  out.reserve(text.size() + 8);
  for (std::size_t i = 0; i < text.size();) {
    const Step step = next_character(text, i);
    out += step.good ? text.substr(i, step.length) : kReplacement;
    i += step.length;
  }
  return out;
}

}  // namespace blockrand::importers::osm
