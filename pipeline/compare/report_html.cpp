// compare.html, put together.
#include <algorithm>
#include <numeric>

#include "pipeline/base/assets.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/template.h"
#include "pipeline/base/version.h"
#include "pipeline/compare/assets.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/comparison_sections.h"
#include "pipeline/compare/report_numbers.h"

namespace blockrand::compare {
namespace {

/// Indices of the matches, largest distance first; those without one last.
std::vector<std::size_t> by_distance(const Comparison& comparison) {
  std::vector<std::size_t> order(comparison.matches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto distance = [&](std::size_t i) {
    return finite(value_of(comparison.matches[i].values, Measure::distance_rms).counted).value_or(-1);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return distance(a) > distance(b); });
  return order;
}

}  // namespace

std::string comparison_html(const Comparison& comparison, const OptionList& options, const DistanceQuery& distances,
                            const ReportOptions& report, int jobs) {
  const std::vector<std::size_t> order = by_distance(comparison);
  std::string out;
  out += measure_section(comparison);
  out += distribution_section(comparison);
  out += roof_section(comparison);
  out += surface_section(comparison);
  out += input_section(comparison);
  out += unmatched_section(comparison);
  out += match_tables(comparison, order);
  if (!order.empty()) {
    out += picture_legend(report);
    const auto drawn = static_cast<std::size_t>(std::max(0, report.pictures));
    std::vector<std::string> sections(order.size());
    const int workers = base::worker_count(jobs);
    base::ordered_parallel(
        order.size(), workers, static_cast<std::size_t>(workers) * 4,
        [&](std::size_t i) { sections[i] = match_section(comparison, order[i], i < drawn, distances, report); },
        [&](std::size_t i) {
          out += sections[i];
          sections[i] = {};
        });
  }
  base::Values page;
  page.set("version", base::kVersion).set("model", comparison.model.name).set("reference", comparison.reference.name);
  page.set("page_css", base::asset("page.css")).set("report_css", asset("report.css"));
  page.set("report_js", asset("report.js"));
  page.set("head", head_section(comparison)).set("sections", std::move(out));
  for (const auto& [what, city] :
       {std::pair("Model", &comparison.model), std::pair("Reference", &comparison.reference)})
    page.add("data",
             base::Values()
                 .set("what", what)
                 .set("whose", city->attribution.empty()
                                   ? std::string("whose data it is and under which licence, its own source says")
                                   : city->attribution));
  base::Values asked;
  for (const auto& [name, value] : options) asked.add("options", base::Values().set("name", name).set("value", value));
  if (options.empty())
    page.set("asked", false);
  else
    page.add("asked", std::move(asked));
  return base::filled(asset, "comparison.html", std::move(page));
}

}  // namespace blockrand::compare
