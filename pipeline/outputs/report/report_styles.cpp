// The section "Styles": what the buildings look like they were built as, when, and what that rests on.
#include <numeric>

#include "pipeline/base/text.h"
#include "pipeline/outputs/report/html_text.h"
#include "pipeline/outputs/report/report_sections.h"

namespace blockrand::outputs {
namespace {

using base::with_thousands;
using Counts = std::array<std::uint64_t, kStyleBasisCount>;

struct Basis {
  std::string_view name, meaning, css_class;
};
/// In the colours of the section on sources: tag, geometry, implied.
constexpr Basis kBases[kStyleBasisCount] = {
    {"tags", "what a mapper or a user said of the building", "b2"},
    {"evidence", "measured of the building and what stands around it", "b7"},
    {"rule", "a stated rule for what is no house", "b3"},
};

constexpr std::string_view kClassLabels[model::kStyleClassCount] = {"Gr\u00fcnderzeit", "Tenement", "Modern", "Other"};
constexpr std::string_view kClassMeanings[model::kStyleClassCount] = {
    "front houses of 1840 to 1918", "wings, rear buildings, workers\u2019 houses of that time", "designed after 1918",
    "churches, sheds, garages, houses from before 1840"};
constexpr std::string_view kEraLabels[model::kEraCount] = {"Before 1840", "1840 to 1918", "1919 to 1945", "After 1945"};

std::uint64_t sum(const Counts& counts) { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

/// A bar as long as its share of all, cut by what it rests on.
std::string bar(const Counts& counts, std::uint64_t all) {
  std::string rects, words;
  std::uint64_t before = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    // Borders are rounded, not widths: together they are as long as the sum.
    const std::uint64_t from = before * 10000 / all, to = (before + counts[k]) * 10000 / all;
    before += counts[k];
    const std::string text =
        std::string(kBases[k].name) + " " + with_thousands(counts[k]) + " (" + percent(counts[k], sum(counts)) + ")";
    rects += "<rect class=\"" + std::string(kBases[k].css_class) + "\" x=\"" + std::to_string(from) + "\" width=\"" +
             std::to_string(to - from) + "\" height=\"10\"><title>" + text + "</title></rect>";
    words += (words.empty() ? "" : ", ") + text;
  }
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10000 10\" preserveAspectRatio=\"none\" role=\"img\" "
         "aria-label=\"" +
         words + "\">" + rects + "</svg>";
}

template <std::size_t N>
std::string table(std::string_view title, const std::array<Counts, N>& counts, const std::string_view* labels,
                  const std::string_view* meanings) {
  std::uint64_t all = 0;
  for (const Counts& c : counts) all += sum(c);
  if (all == 0) return {};
  std::string out = "<table class=\"sources styles\"><thead><tr><th>" + std::string(title) +
                    "</th><th>Share of buildings</th><th class=\"n\">Buildings</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < N; ++i) {
    const std::uint64_t n = sum(counts[i]);
    out += "<tr><td" + (meanings ? " title=\"" + std::string(meanings[i]) + "\"" : std::string()) + ">" +
           std::string(labels[i]) + "</td><td class=\"bar\">" + bar(counts[i], all) + "</td><td class=\"n\">" +
           with_thousands(n) + " <span class=\"soft\">" + percent(n, all) + "</span></td></tr>\n";
  }
  return out + "</tbody></table>\n";
}

}  // namespace

bool has_styles(const StyleCounts& counts) {
  std::uint64_t all = 0;
  for (const Counts& c : counts.classes) all += sum(c);
  return all > 0;
}

std::string style_section(const StyleCounts& counts) {
  if (!has_styles(counts)) return {};
  Counts by_basis{};
  for (const Counts& c : counts.classes)
    for (std::size_t k = 0; k < c.size(); ++k) by_basis[k] += c[k];
  const std::uint64_t all = sum(by_basis);
  std::string out =
      "<section id=\"styles\">\n<h2>Styles</h2>\n<p>What each building looks like it was built as, and when. Where "
      "nothing is "
      "tagged, the plan of the house and what stands around it speak for one answer or another; <code>blockrand "
      "explain</code> "
      "lists what spoke for a building and how much.</p>\n<ul class=\"key\">";
  for (std::size_t k = 0; k < by_basis.size(); ++k)
    if (by_basis[k] > 0)
      out += "<li><svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10 10\" aria-hidden=\"true\"><rect class=\"" +
             std::string(kBases[k].css_class) + "\" width=\"10\" height=\"10\" rx=\"2\"/></svg>" +
             std::string(kBases[k].name) + " " + percent(by_basis[k], all) + " <span class=\"soft\">" +
             std::string(kBases[k].meaning) + "</span></li>";
  out += "</ul>\n";
  out += table("Class of appearance", counts.classes, kClassLabels, kClassMeanings);
  out += table("Era", counts.eras, kEraLabels, nullptr);
  return out + "</section>\n";
}

}  // namespace blockrand::outputs
