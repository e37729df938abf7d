#include "pipeline/compare/report_numbers.h"

#include <fmt/format.h>

#include <cmath>

namespace blockrand::compare {
namespace {

constexpr std::string_view kDash = "–", kMinus = "−";

}  // namespace

std::optional<double> finite(double value) {
  if (!std::isfinite(value)) return std::nullopt;
  // Beyond, a double has no sixth decimal.
  if (std::abs(value) >= 1e9) return value;
  const double rounded = std::nearbyint(value * 1e6) / 1e6;
  return rounded == 0 ? 0 : rounded;
}

std::optional<double> finite(const std::optional<double>& value) { return value ? finite(*value) : std::nullopt; }

std::string fixed(const std::optional<double>& value, int decimals) {
  const std::optional<double> sound = finite(value);
  if (!sound) return std::string(kDash);
  std::string text = fmt::format("{:.{}f}", std::abs(*sound), decimals);
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return *sound < 0 && !zero ? std::string(kMinus) + text : text;
}

std::string with_sign(const std::optional<double>& value, int decimals) {
  std::string text = fixed(value, decimals);
  const bool positive = value && *value > 0 && text.find_first_of("123456789") != std::string::npos;
  return positive ? "+" + text : text;
}

std::string percent(const std::optional<double>& share, int decimals) {
  return share && std::isfinite(*share) ? fixed(*share * 100, decimals) + "\u00a0%" : std::string(kDash);
}

bool is_share(const MeasureInfo& measure) {
  return measure.unit == "1" && (measure.better == Better::higher || measure.id == "window_to_wall_error" ||
                                 measure.id == "semantic_reference" || measure.id == "valid_reference");
}

std::string_view unit_of(const MeasureInfo& measure) {
  if (measure.unit == "deg") return "°";
  if (measure.unit != "1") return measure.unit;
  if (!is_share(measure)) return "";
  return measure.better == Better::zero ? "pp" : "%";
}

std::string value_text(const MeasureInfo& measure, const std::optional<double>& value, bool sign) {
  std::optional<double> shown = value;
  int decimals = 2;
  if (is_share(measure)) {
    if (shown) *shown *= 100;
    decimals = 1;
  } else if (measure.better == Better::one) {
    decimals = 3;
  } else if (measure.unit == "deg") {
    decimals = 1;
  } else if (measure.pool == Pool::sum) {
    decimals = 0;
  }
  return sign && measure.better == Better::zero ? with_sign(shown, decimals) : fixed(shown, decimals);
}

std::string value_with_unit(const MeasureInfo& measure, const std::optional<double>& value, bool sign) {
  const std::string_view unit = unit_of(measure);
  std::string out = value_text(measure, value, sign);
  if (!finite(value) || unit.empty()) return out;
  if (unit != "°") out += "\u00a0";
  return out += unit;
}

double footprint_area(const City& city, std::span<const std::uint32_t> buildings) {
  double area = 0;
  for (const std::uint32_t b : buildings) area += city.buildings[b].footprint_area;
  return area;
}

std::optional<double> headline(const MeasureInfo& measure, const Summary& summary) {
  if (summary.count == 0) return std::nullopt;
  if (measure.better == Better::one) return finite(summary.mean_factor);
  return finite(measure.better == Better::zero ? summary.mean_abs : summary.pooled);
}

}  // namespace blockrand::compare
