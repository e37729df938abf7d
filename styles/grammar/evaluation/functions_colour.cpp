// Colours as texts, "#rrggbb" or "#rrggbboo", and their parts (docs/rule_language.md §3.3).
#include <algorithm>
#include <array>
#include <optional>

#include "styles/grammar/evaluation/colour_text.h"
#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

struct HueSaturationValue {
  double hue = 0, saturation = 0, value = 0;  ///< degrees, 0 to 1, 0 to 1
};

HueSaturationValue hue_of(const std::array<double, 4>& c) {
  const double most = std::max({c[0], c[1], c[2]}), least = std::min({c[0], c[1], c[2]}), span = most - least;
  HueSaturationValue out{0, most > 0 ? span / most : 0, most};
  if (span == 0) return out;
  if (most == c[0])
    out.hue = 60 * (c[1] - c[2]) / span;
  else if (most == c[1])
    out.hue = 60 * (2 + (c[2] - c[0]) / span);
  else
    out.hue = 60 * (4 + (c[0] - c[1]) / span);
  if (out.hue < 0) out.hue += 360;
  return out;
}

std::array<double, 4> colour_of(double hue, double saturation, double value, double opacity) {
  saturation = std::clamp(saturation, 0.0, 1.0);
  value = std::clamp(value, 0.0, 1.0);
  hue = std::fmod(hue, 360.0);
  if (hue < 0) hue += 360;
  const auto part = [&](double offset) {
    const double k = std::fmod(offset + hue / 60, 6.0);
    return value - value * saturation * std::max(0.0, std::min({k, 4 - k, 1.0}));
  };
  return {part(5), part(3), part(1), opacity};
}

tl::expected<std::array<double, 4>, std::string> read(const Value& value) {
  if (const auto colour = parse_colour(text(value))) return *colour;
  return failure("'" + text(value) + "' is no colour (#rrggbb)");
}

template <int part>
FunctionResult part_of(Arguments a, FunctionContext&) {
  const auto colour = read(a[0]);
  if (!colour) return failure(colour.error());
  return Value((*colour)[part]);
}
template <double HueSaturationValue::*part>
FunctionResult hue_part(Arguments a, FunctionContext&) {
  const auto colour = read(a[0]);
  if (!colour) return failure(colour.error());
  return Value(hue_of(*colour).*part);
}
FunctionResult from_rgb(Arguments a, FunctionContext&) {
  return Value(colour_text({number(a[0]), number(a[1]), number(a[2]), 1}, false));
}
FunctionResult from_rgbo(Arguments a, FunctionContext&) {
  return Value(colour_text({number(a[0]), number(a[1]), number(a[2]), number(a[3])}, true));
}
FunctionResult from_hsv(Arguments a, FunctionContext&) {
  return Value(colour_text(colour_of(number(a[0]), number(a[1]), number(a[2]), 1), false));
}
FunctionResult from_hsvo(Arguments a, FunctionContext&) {
  return Value(colour_text(colour_of(number(a[0]), number(a[1]), number(a[2]), number(a[3])), true));
}

/// The reference shows the ramps as pictures only; these pass through the colours that their names and pictures tell.
struct Ramp {
  std::string_view name;
  std::array<std::string_view, 5> stops;
};
constexpr Ramp kRamps[] = {
    {"whiteToBlack", {"#ffffff", "#bfbfbf", "#808080", "#404040", "#000000"}},
    {"greenToRed", {"#00ff00", "#80ff00", "#ffff00", "#ff8000", "#ff0000"}},
    {"yellowToRed", {"#ffff00", "#ffbf00", "#ff8000", "#ff4000", "#ff0000"}},
    {"redToBlue", {"#ff0000", "#ff8080", "#ffffff", "#8080ff", "#0000ff"}},
    {"orangeToBlue", {"#ff8000", "#ffbf80", "#ffffff", "#80bfff", "#0080ff"}},
    {"brownToBlue", {"#804000", "#c0a080", "#ffffff", "#80a0ff", "#0040ff"}},
    {"spectrum", {"#ff0000", "#ffff00", "#00ff00", "#00ffff", "#0000ff"}},
};

FunctionResult ramp(Arguments a, FunctionContext&) {
  const auto* found =
      std::find_if(std::begin(kRamps), std::end(kRamps), [&](const Ramp& r) { return r.name == text(a[0]); });
  if (found == std::end(kRamps)) return failure("'" + text(a[0]) + "' is no colour ramp");
  const double at = std::clamp(number(a[1]), 0.0, 1.0) * (static_cast<double>(found->stops.size()) - 1);
  const auto below = std::min(static_cast<std::size_t>(at), found->stops.size() - 2);
  const double share = at - static_cast<double>(below);
  const auto low = *parse_colour(found->stops[below]), high = *parse_colour(found->stops[below + 1]);
  std::array<double, 4> mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = low[i] + (high[i] - low[i]) * share;
  return Value(colour_text(mixed, false));
}

}  // namespace

std::optional<std::array<double, 4>> parse_colour(std::string_view text) {
  if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return std::nullopt;
  std::array<double, 4> out{0, 0, 0, 1};
  for (std::size_t i = 1; i < text.size(); i += 2) {
    const int high = digit(text[i]), low = digit(text[i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    out[i / 2] = (high * 16 + low) / 255.0;
  }
  return out;
}

std::string colour_text(const std::array<double, 4>& colour, bool opacity) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string out = "#";
  for (std::size_t i = 0; i < (opacity ? 4U : 3U); ++i) {
    const int level = static_cast<int>(std::clamp(colour[i], 0.0, 1.0) * 255 + 0.5);
    out += kDigits[level / 16];
    out += kDigits[level % 16];
  }
  return out;
}

std::span<const FunctionEntry> colour_functions() {
  static constexpr FunctionEntry kTable[] = {
      {"colorHSVOToHex", "nnnn", from_hsvo},
      {"colorHSVToHex", "nnn", from_hsv},
      {"colorHexToB", "s", part_of<2>},
      {"colorHexToG", "s", part_of<1>},
      {"colorHexToH", "s", hue_part<&HueSaturationValue::hue>},
      {"colorHexToO", "s", part_of<3>},
      {"colorHexToR", "s", part_of<0>},
      {"colorHexToS", "s", hue_part<&HueSaturationValue::saturation>},
      {"colorHexToV", "s", hue_part<&HueSaturationValue::value>},
      {"colorRGBOToHex", "nnnn", from_rgbo},
      {"colorRGBToHex", "nnn", from_rgb},
      {"colorRamp", "sn", ramp},
  };
  return kTable;
}

}  // namespace blockrand::grammar
