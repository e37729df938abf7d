#include "importers/osm/tag_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace blockrand::importers::osm {
namespace {

constexpr double kMetresPerFoot = 0.3048;
constexpr double kMetresPerInch = 0.0254;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

void skip_blanks(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lowered(std::string_view text) {
  std::string out(trimmed(text));
  for (char& c : out) c = lower(c);
  return out;
}

/// Takes `word` off the front, in either case.
bool take(std::string_view& text, std::string_view word) {
  if (text.size() < word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (lower(text[i]) != word[i]) return false;
  text.remove_prefix(word.size());
  return true;
}

/// Takes digits with a point or a comma off the front. No exponent: `1e3` is a typing error, not a thousand.
std::optional<double> take_number(std::string_view& text) {
  std::string_view rest = text;
  bool negative = false;
  if (!rest.empty() && (rest.front() == '-' || rest.front() == '+')) {
    negative = rest.front() == '-';
    rest.remove_prefix(1);
  }
  std::string digits;
  bool point = false;
  std::size_t n = 0;
  for (; n < rest.size(); ++n) {
    const char c = rest[n];
    if (is_digit(c)) {
      digits += c;
    } else if ((c == '.' || c == ',') && !point && n + 1 < rest.size() && is_digit(rest[n + 1])) {
      point = true;
      digits += '.';
    } else {
      break;
    }
  }
  if (digits.empty() || digits.size() > 30) return std::nullopt;
  if (digits.front() == '.') digits.insert(digits.begin(), '0');
  if (n < rest.size() && rest[n] == '.' && n + 1 == rest.size()) ++n;  // "12."
  double value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) return std::nullopt;
  rest.remove_prefix(n);
  text = rest;
  return negative ? -value : value;
}

void skip_hedge(std::string_view& text) {
  skip_blanks(text);
  for (const std::string_view word : {"~", "≈", "<=", ">=", "<", ">", "circa", "approx.", "approx", "ca.", "ca", "c."})
    if (take(text, word)) break;
  skip_blanks(text);
}

bool take_foot_mark(std::string_view& text) {
  for (const std::string_view mark : {"feet", "foot", "ft.", "ft", "′", "’", "'"})
    if (mark != "'" || !text.starts_with("''"))
      if (take(text, mark)) return true;
  return false;
}

bool take_inch_mark(std::string_view& text) {
  for (const std::string_view mark : {"inches", "inch", "in.", "in", "″", "”", "\"", "''"})
    if (take(text, mark)) return true;
  return false;
}

/// Takes one length with its unit off the front.
std::optional<double> take_length(std::string_view& text) {
  skip_hedge(text);
  const auto number = take_number(text);
  if (!number) return std::nullopt;
  skip_blanks(text);
  if (take_foot_mark(text)) {
    double metres = *number * kMetresPerFoot;
    std::string_view rest = text;
    skip_blanks(rest);
    if (!rest.empty() && is_digit(rest.front())) {
      const auto inches = take_number(rest);
      skip_blanks(rest);
      if (!inches || !take_inch_mark(rest)) return std::nullopt;
      metres += (*number < 0 ? -1 : 1) * *inches * kMetresPerInch;
      text = rest;
    }
    return metres;
  }
  if (take_inch_mark(text)) return *number * kMetresPerInch;
  struct Unit {
    std::string_view name;
    double metres;
  };
  // Longer names first: "mm" before "m".
  static constexpr Unit units[] = {
      {"kilometer", 1000}, {"km", 1000},  {"centimeter", 0.01}, {"cm", 0.01},     {"millimeter", 0.001},
      {"mm", 0.001},       {"dm", 0.1},   {"yards", 0.9144},    {"yard", 0.9144}, {"yd", 0.9144},
      {"meters", 1},       {"metres", 1}, {"meter", 1},         {"metre", 1},     {"mtr", 1},
      {"m.", 1},           {"m", 1}};
  for (const Unit& unit : units)
    if (take(text, unit.name)) return *number * unit.metres;
  return *number;
}

std::optional<double> take_storeys(std::string_view& text) {
  skip_hedge(text);
  if (take(text, "½")) return 0.5;
  auto number = take_number(text);
  if (number && take(text, "½")) *number += 0.5;
  return number;
}

/// A list, a range or one value, by `take_one`.
template <class TakeOne>
std::optional<double> parse_values(std::string_view text, Pick pick, TakeOne take_one) {
  text = trimmed(text);
  std::optional<double> best;
  while (true) {
    const auto value = take_one(text);
    if (!value) return std::nullopt;
    if (!best || (pick == Pick::highest ? *value > *best : *value < *best)) best = value;
    skip_blanks(text);
    if (text.empty()) return best;
    if (!take(text, ";") && !take(text, "-") && !take(text, "–") && !take(text, "/") && !take(text, "to "))
      return std::nullopt;
    skip_blanks(text);
    if (text.empty()) return best;  // "3;"
  }
}

int hex_digit(char c) {
  c = lower(c);
  return is_digit(c) ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

std::optional<model::Colour> parse_hex(std::string_view digits) {
  std::array<int, 8> d{};
  if (digits.size() != 3 && digits.size() != 4 && digits.size() != 6 && digits.size() != 8) return std::nullopt;
  for (std::size_t i = 0; i < digits.size(); ++i)
    if ((d[i] = hex_digit(digits[i])) < 0) return std::nullopt;
  const auto byte = [](int high, int low) { return static_cast<std::uint8_t>(high * 16 + low); };
  if (digits.size() <= 4) return model::Colour{byte(d[0], d[0]), byte(d[1], d[1]), byte(d[2], d[2])};
  return model::Colour{byte(d[0], d[1]), byte(d[2], d[3]), byte(d[4], d[5])};
}

std::optional<model::Colour> parse_rgb_function(std::string_view text) {
  if (!take(text, "rgba")) take(text, "rgb");
  skip_blanks(text);
  if (!take(text, "(")) return std::nullopt;
  std::array<std::uint8_t, 3> channels{};
  for (int i = 0; i < 3; ++i) {
    skip_blanks(text);
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || value < 0 || value > 255) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    skip_blanks(text);
    if (i < 2 && !take(text, ",") && text.empty()) return std::nullopt;
    channels[i] = static_cast<std::uint8_t>(value);
  }
  if (text.empty() || text.back() != ')') return std::nullopt;
  return model::Colour{channels[0], channels[1], channels[2]};
}

/// Lower case, every run of blanks, hyphens and underscores as one underscore.
std::string normal_name(std::string_view text) {
  std::string out;
  for (const char c : trimmed(text)) {
    const bool gap = c == ' ' || c == '-' || c == '_';
    if (!gap)
      out += lower(c);
    else if (!out.empty() && out.back() != '_')
      out += '_';
  }
  return out;
}

std::string_view first_of_list(std::string_view text) { return trimmed(text.substr(0, text.find(';'))); }

}  // namespace

std::optional<double> parse_length(std::string_view text, Pick pick) { return parse_values(text, pick, take_length); }

std::optional<double> parse_storeys(std::string_view text, Pick pick) { return parse_values(text, pick, take_storeys); }

std::optional<double> parse_angle(std::string_view text) {
  text = trimmed(text);
  skip_hedge(text);
  const auto number = take_number(text);
  skip_blanks(text);
  if (!take(text, "°") && !take(text, "degrees") && !take(text, "deg")) take(text, "º");
  if (!text.empty()) return std::nullopt;
  return number;
}

std::optional<double> parse_direction(std::string_view text) {
  if (const auto degrees = parse_angle(text)) {
    if (*degrees <= -720 || *degrees >= 720) return std::nullopt;
    double turned = *degrees;
    while (turned < 0) turned += 360;
    while (turned >= 360) turned -= 360;
    return turned;
  }
  static constexpr std::string_view points[] = {"n", "nne", "ne", "ene", "e", "ese", "se", "sse",
                                                "s", "ssw", "sw", "wsw", "w", "wnw", "nw", "nnw"};
  // "north-north-east" and "nne" become the same letters.
  std::string letters;
  std::string rest;
  for (const char c : lowered(text))
    if (c != ' ' && c != '-' && c != '_') rest += c;
  for (std::string_view r = rest; !r.empty();) {
    if (take(r, "north"))
      letters += 'n';
    else if (take(r, "south"))
      letters += 's';
    else if (take(r, "east"))
      letters += 'e';
    else if (take(r, "west"))
      letters += 'w';
    else {
      letters += r.front();
      r.remove_prefix(1);
    }
  }
  for (int i = 0; i < 16; ++i)
    if (points[i] == letters) return i * 22.5;
  return std::nullopt;
}

namespace {

/// "Light Slate-Gray": lightslategray, as CSS writes it.
std::string plain_name(std::string_view lower_text) {
  std::string name;
  for (const char c : lower_text)
    if (c != ' ' && c != '-' && c != '_') name += c;
  return name;
}

}  // namespace

std::optional<model::Colour> parse_colour(std::string_view text) {
  const std::string lower_text = lowered(text);
  if (lower_text.starts_with("rgb")) return parse_rgb_function(lower_text);
  const std::string_view first = first_of_list(lower_text);
  if (first.starts_with('#')) return parse_hex(first.substr(1));
  if (const auto known = colour_of_name(plain_name(first))) return known;
  if (first.size() == 6) return parse_hex(first);
  return std::nullopt;
}

bool is_colour_word(std::string_view text) {
  const std::string lower_text = lowered(text);
  return !lower_text.starts_with("rgb") && colour_of_name(plain_name(first_of_list(lower_text))).has_value();
}

std::optional<model::RoofShape> parse_roof_shape(std::string_view text) {
  const std::string name = normal_name(first_of_list(text));
  if (name.empty()) return std::nullopt;
  for (std::size_t i = 0; i < model::kRoofShapeCount; ++i) {
    const model::RoofTraits& row = model::kRoofTraits[i];
    if (!row.is_tag_value) continue;
    if (normal_name(row.name) == name ||
        std::find(row.synonyms.begin(), row.synonyms.end(), name) != row.synonyms.end())
      return static_cast<model::RoofShape>(i);
  }
  return model::RoofShape::other;
}

std::optional<model::RoofOrientation> parse_roof_orientation(std::string_view text) {
  const std::string name = lowered(text);
  if (name == "along") return model::RoofOrientation::along;
  if (name == "across") return model::RoofOrientation::across;
  return std::nullopt;
}

}  // namespace blockrand::importers::osm
