// Colours as rule files write them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace blockrand::grammar {

/// "#rrggbb" or "#rrggbboo" as sRGB and opacity, 0 to 1.
std::optional<std::array<double, 4>> parse_colour(std::string_view text);

/// Values are clamped to [0, 1] and rounded to 1/255.
std::string colour_text(const std::array<double, 4>& colour, bool opacity);

}  // namespace blockrand::grammar
