// What a terminal shows of a comparison. Lines of at most 110 columns.
#include <fmt/format.h>

#include <algorithm>

#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_places.h"

namespace blockrand::compare {
namespace {

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}
std::string right(std::string_view text, std::size_t width) {
  const std::size_t used = width_of(text);
  return std::string(used < width ? width - used : 0, ' ') + std::string(text);
}
std::string left(std::string_view text, std::size_t width) {
  const std::size_t used = width_of(text);
  return std::string(text) + std::string(used < width ? width - used : 0, ' ');
}

/// Without what would move the cursor or colour the terminal.
std::string printable(std::string_view text) {
  std::string clean;
  base::append_clean(clean, text);
  std::replace_if(
      clean.begin(), clean.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return clean;
}

std::string plural(std::size_t count, std::string_view what) {
  return base::with_thousands(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

void append_city(std::string& out, std::string_view side, const City& city) {
  out += fmt::format("{} {}: {}; heights: {}\n", left(side, 9), printable(short_name(city, 60)),
                     plural(city.buildings.size(), "building"), printable(city.height_reference));
  std::size_t breaches = 0, with_breaches = 0;
  for (const CityFile& file : city.files) {
    breaches += file.breaches;
    with_breaches += file.breaches > 0 ? 1 : 0;
  }
  out += fmt::format("          {}", plural(city.files.size(), "file"));
  if (!city.files.empty())
    out += fmt::format(" ({}, {})", printable(city.files.front().format), printable(city.files.front().crs));
  if (breaches > 0)
    out += fmt::format("; {} of the format in {}",
                       base::with_thousands(breaches) + (breaches == 1 ? " breach" : " breaches"),
                       plural(with_breaches, "file"));
  if (city.without_geometry > 0) out += fmt::format("; {} without geometry", plural(city.without_geometry, "building"));
  if (city.out_of_reach > 0) out += fmt::format("; {} out of reach", plural(city.out_of_reach, "building"));
  if (city.repetitions > 0) out += fmt::format("; {} in two files", plural(city.repetitions, "building"));
  out += '\n';
}

}  // namespace

std::string comparison_text(const Comparison& c) {
  std::string out;
  append_city(out, "model", c.model);
  append_city(out, "reference", c.reference);
  const Registration& r = c.registration;
  if (r.matches == 0) {
    out += "offset    not estimated: no matches to tell it from\n";
  } else {
    out += fmt::format("offset    east {} ± {} m, north {} ± {} m", with_sign(r.east, 3), fixed(r.east_spread, 3),
                       with_sign(r.north, 3), fixed(r.north_spread, 3));
    if (r.up) out += fmt::format(", up {} ± {} m", with_sign(r.up, 3), fixed(r.up_spread, 3));
    out += fmt::format(" (median of {}; model minus reference)\n",
                       r.matches == 1 ? std::string("1 match") : base::with_thousands(r.matches) + " matches");
    out += fmt::format("          horizontal: {}, vertical: {}. {}\n", r.horizontal_removed ? "removed" : "not removed",
                       r.vertical_removed ? "removed" : "not removed", printable(r.rule));
  }
  out += fmt::format("heights   compared {}\n", heights_text(c));
  out += fmt::format("matched   {}; missing from the model: {}; only in the model: {}; blank facades left out: {}\n\n",
                     base::with_thousands(c.matches.size()), base::with_thousands(c.missing.size()),
                     base::with_thousands(c.extra.size()), base::with_thousands(c.blank_facades));
  out += left("measure", 33) + right("n", 6) + right("value", 10) + right("with all", 10) + right("left out", 10) +
         right("bias", 9) + right("MAE", 9) + right("RMSE", 9) + right("p95", 9) + "  unit\n";
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    const MeasureInfo& measure = kMeasures[m];
    const MeasureSummary& s = c.summaries[m];
    if (s.counted.count == 0 && s.all.count == 0) continue;
    const auto pooled = [&](const Summary& of) {
      return of.count > 0 ? value_text(measure, of.pooled) : std::string("–");
    };
    out += left(measure.title, 33) + right(std::to_string(s.counted.count), 6) + right(pooled(s.counted), 10) +
           right(pooled(s.all), 10) + right(fixed(s.left_out * 100, 1) + " %", 10);
    const bool errors = measure.better == Better::zero && s.counted.count > 0;
    const auto error = [&](double value, bool sign) {
      return errors ? value_text(measure, value, sign) : std::string();
    };
    out += right(error(s.counted.mean, true), 9) + right(error(s.counted.mean_abs, false), 9) +
           right(error(s.counted.rms, false), 9) + right(error(s.counted.p95_abs, false), 9);
    const std::string_view unit = unit_of(measure);
    if (!unit.empty()) (out += "  ") += unit;
    while (out.back() == ' ') out.pop_back();
    out += '\n';
  }
  return out;
}

}  // namespace blockrand::compare
