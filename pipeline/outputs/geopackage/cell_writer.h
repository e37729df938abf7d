// Rows of the GeoPackage put together cell by cell. Internal to this folder.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "pipeline/layer_file/well_known_binary.h"
#include "pipeline/model/building.h"
#include "pipeline/outputs/geopackage/geopackage_rows.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

/// The double that the shortest text of `value` stands for: 0.6f becomes 0.6, not 0.60000002384.
inline double as_written(float value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  double out = 0;
  std::from_chars(buffer, end, out);
  return out;
}

/// Lengths, areas and volumes are sums; their last bits say nothing.
inline double rounded(double value) { return std::nearbyint(value * 1000) / 1000; }
inline std::optional<double> rounded(const std::optional<double>& value) {
  return value ? std::optional(rounded(*value)) : std::nullopt;
}
/// Directions to a tenth of a degree: footprints know no more.
inline double rounded_degrees(double value) { return std::nearbyint(value * 10) / 10; }
/// The same for directions: in [0, 360).
inline double rounded_direction(double value) {
  const double degrees = rounded_degrees(value);
  return degrees >= 360 ? degrees - 360 : degrees;
}

using layer_file::append_header;
using layer_file::append_line;
using layer_file::append_polygon;
using layer_file::kMultiPolygon;

/// Adds cells of the model's own types.
class RowWriter : public layer_file::RowWriter {
 public:
  using layer_file::RowWriter::RowWriter;

  void value(double v) { real(v); }
  void value(const std::string& v) { text(v); }
  void value(model::Colour v) { text(model::text(v)); }
  void value(model::RoofShape v) { text(model::name(v)); }
  void value(model::RoofOrientation v) { text(v == model::RoofOrientation::along ? "along" : "across"); }
};

}  // namespace blockrand::outputs
