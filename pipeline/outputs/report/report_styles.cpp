// The section "Styles": what the buildings look like they were built as, when, and what that rests on.
#include <numeric>

#include "pipeline/base/text.h"
#include "pipeline/outputs/report/houses.h"
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

constexpr std::string_view kClassMeanings[model::kStyleClassCount] = {
    "front houses of 1840 to 1918", "wings, rear buildings, workers\u2019 houses of that time", "designed after 1918",
    "churches, sheds, garages, houses from before 1840"};

std::uint64_t sum(const Counts& counts) { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

template <std::size_t N>
void add_table(Values& v, std::string_view title, const std::array<Counts, N>& counts,
               std::string_view (*label)(std::uint8_t), const std::string_view* meanings) {
  std::uint64_t all = 0;
  for (const Counts& c : counts) all += sum(c);
  if (all == 0) return;
  Values table;
  table.set("title", title);
  for (std::size_t i = 0; i < N; ++i) {
    const std::uint64_t n = sum(counts[i]);
    std::vector<BarPart> parts;
    for (std::size_t k = 0; k < counts[i].size(); ++k)
      parts.push_back({std::string(kBases[k].css_class), std::string(kBases[k].name), counts[i][k]});
    Values row = bar_values(parts, all, n);
    row.set("label", label(static_cast<std::uint8_t>(i))).set("meaning", meanings ? meanings[i] : std::string_view{});
    row.set("count", with_thousands(n)).set("share", percent(n, all));
    table.add("rows", std::move(row));
  }
  v.add("tables", std::move(table));
}

}  // namespace

std::optional<Values> style_values(const StyleCounts& counts) {
  Counts by_basis{};
  for (const Counts& c : counts.classes)
    for (std::size_t k = 0; k < c.size(); ++k) by_basis[k] += c[k];
  const std::uint64_t all = sum(by_basis);
  if (all == 0) return std::nullopt;
  Values v;
  for (std::size_t k = 0; k < by_basis.size(); ++k)
    if (by_basis[k] > 0)
      v.add("bases", Values()
                         .set("swatch", kBases[k].css_class)
                         .set("name", kBases[k].name)
                         .set("share", percent(by_basis[k], all))
                         .set("meaning", kBases[k].meaning));
  add_table(v, "Class of appearance", counts.classes, style_label, kClassMeanings);
  add_table(v, "Era", counts.eras, era_label, nullptr);
  return v;
}

}  // namespace blockrand::outputs
