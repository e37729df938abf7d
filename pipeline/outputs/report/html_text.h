// Pieces of the report's text. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/model/osm_id.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

using base::append_base64;

inline std::string_view osm_type(model::OsmId id) {
  return id.type == model::OsmType::node ? "node" : id.type == model::OsmType::way ? "way" : "relation";
}

/// An editor's new object (negative number) has no page at openstreetmap.org.
inline bool has_page(model::OsmId id) { return id.number > 0; }

inline std::string osm_address(model::OsmId id) {
  return "https://www.openstreetmap.org/" + std::string(osm_type(id)) + "/" + std::to_string(id.number);
}

/// The same, or nothing where there is no page.
inline std::string osm_link(model::OsmId id) { return has_page(id) ? osm_address(id) : std::string(); }

/// Rounded half up to `decimals` places, thousands separated; not negative.
inline std::string rounded(double value, int decimals = 0) {
  std::uint64_t power = 1;
  for (int i = 0; i < decimals; ++i) power *= 10;
  const auto steps = static_cast<std::uint64_t>((value > 0 ? value : 0) * static_cast<double>(power) + 0.5);
  std::string out = base::with_thousands(steps / power);
  if (decimals > 0) {
    std::string fraction = std::to_string(steps % power);
    out += '.' + std::string(static_cast<std::size_t>(decimals) - fraction.size(), '0') + fraction;
  }
  return out;
}

/// "12 %", not escaped; "< 1 %" and "> 99 %" where rounding would claim none or all.
inline std::string percent(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "\u2013";
  const std::uint64_t p = (part * 200 + whole) / (2 * whole);
  if (p == 0 && part > 0) return "<\u00a01\u00a0%";
  if (p == 100 && part < whole) return ">\u00a099\u00a0%";
  return std::to_string(p) + "\u00a0%";
}

}  // namespace blockrand::outputs
