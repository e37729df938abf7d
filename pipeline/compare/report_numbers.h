// Numbers of a comparison as texts, alike in every report. Internal to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

/// `value` to six decimals, which is finer than anything measured; no -0. NaN and infinity, which no measure should be,
/// become no value.
std::optional<double> finite(double value);
std::optional<double> finite(const std::optional<double>& value);

/// `value` with a fixed number of decimals, "−0.42": the sign as typography has it, no "−0.00". Dash without a value.
std::string fixed(const std::optional<double>& value, int decimals);
/// As above, "+0.42" where it is not negative and not zero.
std::string with_sign(const std::optional<double>& value, int decimals);
/// "87.3 %" of 0.873.
std::string percent(const std::optional<double>& share, int decimals = 1);

/// What a value of the measure is counted in, for people: "m", "°", "%" (shares), "pp" (percentage points) or ""
/// (ratios, counts).
std::string_view unit_of(const MeasureInfo& measure);
/// A value of the measure as people read it, without its unit: shares in percent, lengths in m with two decimals,
/// values with a sign with it where `sign`.
std::string value_text(const MeasureInfo& measure, const std::optional<double>& value, bool sign = true);

/// Whether the measure is a share in [0, 1] or a difference of two.
bool is_share(const MeasureInfo& measure);

/// The value with its unit, "0.42 m"; a dash without a value.
std::string value_with_unit(const MeasureInfo& measure, const std::optional<double>& value, bool sign = true);

/// Of a value with a sign the mean size of the errors (MAE), of a ratio the factor by which it is off on average
/// (mean_factor), else what all matches have together; nothing without values.
std::optional<double> headline(const MeasureInfo& measure, const Summary& summary);

/// m² of the buildings' footprints.
double footprint_area(const City& city, std::span<const std::uint32_t> buildings);

/// Which heights are compared, as compare.json has it.
inline std::string_view heights_key(const Comparison& comparison) {
  return comparison.absolute_heights ? "absolute" : "above own ground";
}
/// The same for people.
inline std::string_view heights_text(const Comparison& comparison) {
  return comparison.absolute_heights ? "as they stand in the files" : "above each building's own ground";
}

inline const MeasureValue& value_of(const MeasureValues& values, Measure measure) {
  return values[static_cast<std::size_t>(measure)];
}
inline const MeasureSummary& summary_of(const MeasureSummaries& summaries, Measure measure) {
  return summaries[static_cast<std::size_t>(measure)];
}

}  // namespace blockrand::compare
