#include "pipeline/compare/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/report_numbers.h"

namespace blockrand::compare {
namespace {

/// From where on the page says "agrees" and "differs": what a reader of a city model would call so, half a storey's and
/// a window's size as the yardsticks. Values of headline(); the numbers themselves stand beside the words.
struct Limit {
  Measure measure;
  double agrees, differs;
  std::string_view name;  ///< {}: the value
};
constexpr std::array<Limit, 11> kLimits{{
    {Measure::footprint_iou, 0.9, 0.7, "footprints (IoU {})"},
    {Measure::eaves_error, 0.5, 1.5, "eaves ({} off on average)"},
    {Measure::ridge_error, 0.5, 1.5, "ridges ({} off on average)"},
    {Measure::roof_volume_ratio, 1.05, 1.2, "volume under roofs (off by a factor of {} on average)"},
    {Measure::distance_rms, 0.5, 1.5, "surfaces ({} apart, RMS)"},
    {Measure::roof_type_agrees, 0.9, 0.6, "roof forms (the same in {})"},
    {Measure::storeys_error, 0.25, 1, "storeys ({} off on average)"},
    {Measure::axes_error, 0.5, 1.5, "axes of facades ({} off on average)"},
    {Measure::openings_ratio, 1.1, 1.5, "number of openings (off by a factor of {} on average)"},
    {Measure::opening_recall, 0.7, 0.3, "places of openings ({} found)"},
    {Measure::window_to_wall_error, 0.03, 0.1, "window-to-wall ratio ({} off on average)"},
}};

std::string with_unit(const MeasureInfo& measure, double value) {
  return measure.better == Better::one ? fixed(value, 2) : value_with_unit(measure, value, false);
}

/// 1: agrees, 0: between, -1: differs.
int verdict(const MeasureInfo& measure, const Limit& limit, double value) {
  if (measure.better == Better::higher) return value >= limit.agrees ? 1 : value < limit.differs ? -1 : 0;
  return value <= limit.agrees ? 1 : value > limit.differs ? -1 : 0;
}

std::string count_of(std::size_t n, std::string_view one, std::string_view many) {
  return base::with_thousands(n) + " " + std::string(n == 1 ? one : many);
}

}  // namespace

Words words_of(const Comparison& c) {
  Words out;
  std::size_t reference = 0, model = 0;
  for (const MatchResult& m : c.matches) {
    reference += m.reference.buildings.size();
    model += m.model.buildings.size();
  }
  if (c.matches.empty()) {
    out.matching = fmt::format(
        "No building of the model ({}) stands where one of the reference ({}) stands: there is nothing to measure. "
        "Check that both are of one place and that their coordinate systems are right.",
        base::with_thousands(c.model.buildings.size()), base::with_thousands(c.reference.buildings.size()));
  } else {
    out.matching = fmt::format(
        "{} of the reference’s {} {} against {} of the model, in {}", base::with_thousands(reference),
        count_of(c.reference.buildings.size(), "building", "buildings"), reference == 1 ? "stands" : "stand",
        base::with_thousands(model), count_of(c.matches.size(), "match", "matches"));
    out.matching += c.missing.empty() ? "; none is missing from the model"
                                      : "; " + count_of(c.missing.size(), "is", "are") + " missing from the model";
    out.matching += c.extra.empty()
                        ? ", which has no building that the reference has not."
                        : ", which has " + base::with_thousands(c.extra.size()) + " that the reference has not.";
    const double counted = c.reference_total.left_out[0], all = c.reference_total.surface_area;
    if (all > 0 && counted < all * 0.9995)
      out.matching += fmt::format(
          " {} of the reference’s surface is left out of what is counted: undersides, party walls and sides that were "
          "not "
          "modelled.",
          percent((all - counted) / all, 0));
  }
  for (const Limit& limit : kLimits) {
    const MeasureInfo& measure = info(limit.measure);
    const std::optional<double> value = headline(measure, summary_of(c.summaries, limit.measure).counted);
    if (!value) continue;
    const int says = verdict(measure, limit, *value);
    std::string& list = says > 0 ? out.agrees : says < 0 ? out.differs : out.between;
    if (!list.empty()) list += ", ";
    list += base::escaped(fmt::format(fmt::runtime(limit.name), with_unit(measure, *value)));
  }
  for (const Limit& limit : kLimits) {
    const MeasureInfo& measure = info(limit.measure);
    out.limits += fmt::format("{}{} {} / {}", out.limits.empty() ? "" : "; ", measure.title,
                              with_unit(measure, limit.agrees), with_unit(measure, limit.differs));
  }
  return out;
}

}  // namespace blockrand::compare
