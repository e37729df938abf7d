// Rows of the GeoPackage put together cell by cell. Internal to this folder.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "pipeline/export/geopackage/geopackage_rows.h"
#include "pipeline/export/text.h"
#include "pipeline/geopackage/well_known_binary.h"
#include "pipeline/model/building.h"

namespace blockrand::export_ {

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

using geopackage::append_header;
using geopackage::append_line;
using geopackage::append_polygon;
using geopackage::kMultiPolygon;

/// Adds cells of the model's own types.
class RowWriter : public geopackage::RowWriter {
 public:
  using geopackage::RowWriter::RowWriter;

  void value(double v) { real(v); }
  void value(const std::string& v) { text(v); }
  void value(model::Colour v) { text(model::text(v)); }
  void value(model::RoofShape v) { text(model::name(v)); }
  void value(model::RoofOrientation v) { text(v == model::RoofOrientation::along ? "along" : "across"); }
};

}  // namespace blockrand::export_
