// What reading overrides and giving them share: how a value is written, and which storeys are sound.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "pipeline/attributes/tag_conflicts.h"
#include "pipeline/model/style.h"

namespace blockrand::attributes {

/// m: what a storey may measure.
inline constexpr double kLowStorey = 1.5, kHighStorey = 20;

/// m: what storeys share of a height under a roof of a height: all of it where the roof reaches down to the floor (as
/// in resolve.cpp).
inline double inhabited(double height, double roof) {
  const double walls = std::max(height - roof, 0.0);
  return walls < kLowestStorey ? height : walls;
}

/// "1895" or "1895..1902"; empty for anything else.
std::optional<model::YearRange> parse_years(std::string_view text);

}  // namespace blockrand::attributes
