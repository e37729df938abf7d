// compare.csv: a row per match.
#include <algorithm>

#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_places.h"

namespace blockrand::compare {
namespace {

/// RFC 4180: quoted where a comma, a quote or a line break is in it. What a spreadsheet would run as a formula gets an
/// apostrophe before it: ids come from files of others.
void append_text(std::string& out, std::string_view text) {
  std::string clean;
  if (!text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos) clean = "'";
  base::append_clean(clean, text);
  if (clean.find_first_of(",\"\r\n") == std::string::npos) {
    out += clean;
    return;
  }
  out += '"';
  for (const char c : clean) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

void append_value(std::string& out, const std::optional<double>& value) {
  out += ',';
  if (const std::optional<double> sound = finite(value)) out += base::shortest(*sound);
}

}  // namespace

std::string comparison_csv(const Comparison& comparison) {
  std::string out = "id,reference_buildings,model_buildings,east,north";
  for (const MeasureInfo& measure : kMeasures)
    ((out += ',') += measure.id).append(",").append(measure.id).append("_all");
  out += "\r\n";
  for (const MatchResult& match : comparison.matches) {
    append_text(out, match.id);
    out += ',';
    append_text(out, ids_of(comparison.reference, match.reference.buildings));
    out += ',';
    append_text(out, ids_of(comparison.model, match.model.buildings));
    std::optional<double> east, north;
    if (!match.reference.buildings.empty()) {
      const Point2 place =
          place_of(comparison.reference, comparison.reference.buildings[match.reference.buildings.front()]);
      east = place.x;
      north = place.y;
    }
    append_value(out, east);
    append_value(out, north);
    for (const MeasureValue& value : match.values) {
      append_value(out, value.counted);
      append_value(out, value.all);
    }
    out += "\r\n";
  }
  return out;
}

}  // namespace blockrand::compare
