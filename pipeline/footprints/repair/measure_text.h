// Measures as report rows have them.
#pragma once

#include <cmath>
#include <string>

namespace blockrand::repair {

/// Two decimals, as 12.30; independent of the locale. For values below 1e15.
inline std::string hundredths(double value) {
  const long long whole = std::llround(std::fabs(value) * 100);
  std::string fraction = std::to_string(whole % 100);
  if (fraction.size() < 2) fraction.insert(0, "0");
  return (value < 0 && whole > 0 ? "-" : "") + std::to_string(whole / 100) + "." + fraction;
}
inline std::string metres_text(double value) { return hundredths(value) + " m"; }

}  // namespace blockrand::repair
