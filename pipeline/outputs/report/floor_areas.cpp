// The section "Floor areas": gross floor area by use, style, era and block.
#include <algorithm>
#include <functional>
#include <map>

#include "pipeline/outputs/report/houses.h"
#include "pipeline/outputs/report/html_text.h"
#include "pipeline/outputs/report/report_sections.h"

namespace blockrand::outputs {
namespace {

using base::with_thousands;

/// Whole numbers all: no order of buildings or tiles changes a sum.
struct Sums {
  std::uint64_t buildings = 0;
  Area footprint = 0, floors = 0, roof = 0, guessed = 0;
  void add(const MapBuilding& b) {
    ++buildings;
    footprint += b.footprint;
    floors += b.floors;
    roof += b.roof_floors;
    guessed += b.guessed;
  }
  void add(const Sums& s) {
    buildings += s.buildings;
    footprint += s.footprint;
    floors += s.floors;
    roof += s.roof;
    guessed += s.guessed;
  }
};

std::string square_metres(Area area) { return with_thousands(static_cast<std::uint64_t>((area + 50) / 100)); }
std::string share(Area part, Area whole) {
  return percent(static_cast<std::uint64_t>(part), static_cast<std::uint64_t>(whole));
}

Values row_values(const Sums& s) {
  Values v;
  v.set("buildings", with_thousands(s.buildings)).set("footprint", square_metres(s.footprint));
  v.set("floors", square_metres(s.floors)).set("roof", s.roof > 0 ? square_metres(s.roof) : std::string("0"));
  v.set("guessed", s.floors > 0 ? share(s.guessed, s.floors) : std::string());
  return v;
}

/// A table, the largest first. \param most  rows; the rest is one row
void add_group(Values& v, std::string_view title, std::string_view column, const std::map<std::string, Sums>& groups,
               Area all, std::size_t most) {
  if (groups.empty()) return;
  std::vector<std::pair<std::string, Sums>> rows(groups.begin(), groups.end());
  std::ranges::stable_sort(rows, std::greater<>(), [](const auto& row) { return row.second.floors; });
  if (rows.size() > most + 1) {
    Sums others;
    for (std::size_t i = most; i < rows.size(); ++i) others.add(rows[i].second);
    const std::string name = std::to_string(rows.size() - most) + " others";
    rows.resize(most);
    rows.emplace_back(name, others);
  }
  Values group;
  group.set("title", title).set("column", column);
  for (const auto& [label, sums] : rows)
    group.add("rows", row_values(sums).set("label", label).set("share", share(sums.floors, all)));
  v.add("groups", std::move(group));
}

Values block_values(const std::vector<Sums>& by_block, const Sums& without, const ReportFacts& facts,
                    const ReportMap& map, const ReportOptions& options) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < by_block.size(); ++i)
    if (by_block[i].buildings > 0) order.push_back(i);
  const std::size_t all = order.size();
  std::ranges::stable_sort(order, std::greater<>(), [&](std::uint32_t i) { return by_block[i].floors; });
  order.resize(std::min(order.size(), options.listed_blocks));
  Values v;
  for (const std::uint32_t i : order) {
    const BlockFact& block = facts.blocks[i];
    const Sums& s = by_block[i];
    // Of a block that other areas share, the sums are a part: no ratio.
    const bool whole = block.buildings == s.buildings;
    Values row = row_values(s);
    row.set("number", std::to_string(i + 1)).set("streets", block.streets);
    row.set("shown", std::ranges::binary_search(map.blocks, i + 1, {}, [](const auto& b) { return b.first; }));
    row.set("area", block.gives_ratios && whole ? rounded(block.area) : std::string());
    const auto ratio = [&](Area area) {
      return block.gives_ratios && whole && block.area > 0 ? rounded(static_cast<double>(area) / 100 / block.area, 2)
                                                           : std::string();
    };
    row.set("coverage", ratio(s.footprint)).set("ratio", ratio(s.floors));
    v.add("rows", std::move(row));
  }
  if (without.buildings > 0)
    v.add("without", row_values(without).set(
                         "why", "at the edge of the data, on land that no streets close, or on too much of it"));
  else
    v.set("without", false);
  v.set("more", all > order.size()).set("listed", with_thousands(order.size())).set("all", with_thousands(all));
  v.set("area_build", facts.alone);
  return v;
}

}  // namespace

std::vector<std::uint32_t> block_numbers(const MapFootprints& footprints, const ReportFacts& facts) {
  std::map<std::string_view, std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < facts.blocks.size(); ++i) numbers.emplace(facts.blocks[i].id, i + 1);
  std::vector<std::uint32_t> out(footprints.names.size(), 0);
  for (const MapBuilding& b : footprints.buildings)
    if (b.block > 0 && out[b.block - 1] == 0)
      if (const auto found = numbers.find(footprints.names[b.block - 1]); found != numbers.end())
        out[b.block - 1] = found->second;
  return out;
}

std::optional<Values> floor_area_values(const MapFootprints& footprints, const ReportFacts& facts, const ReportMap& map,
                                        const std::vector<std::uint32_t>& block_number, const ReportOptions& options) {
  Sums all, without;
  std::map<std::string, Sums> by_use, by_style, by_era;
  std::vector<Sums> by_block(facts.blocks.size());
  for (const MapBuilding& b : footprints.buildings) {
    all.add(b);
    const std::string use = b.use == 0 ? std::string() : use_label(footprints.names[b.use - 1]);
    by_use[use.empty() ? "not stated" : use].add(b);
    if (b.style != kNotClassified) by_style[std::string(style_label(b.style))].add(b);
    if (b.era != kNotClassified) by_era[std::string(era_label(b.era))].add(b);
    const std::uint32_t number = b.block == 0 ? 0 : block_number[b.block - 1];
    (number == 0 ? without : by_block[number - 1]).add(b);
  }
  if (all.floors <= 0) return std::nullopt;
  const std::string square = "\u00a0m\u00b2";
  Values v;
  v.set("floors", square_metres(all.floors) + square).set("roof", square_metres(all.roof) + square);
  v.set("footprint", square_metres(all.footprint) + square).set("guessed", share(all.guessed, all.floors));
  constexpr std::size_t kUses = 12;
  add_group(v, "By use", "Use of the building", by_use, all.floors, kUses);
  add_group(v, "By style", "Class of appearance", by_style, all.floors, kUses);
  add_group(v, "By era", "Era", by_era, all.floors, kUses);
  if (without.buildings < all.buildings)
    v.add("blocks", block_values(by_block, without, facts, map, options));
  else
    v.set("blocks", false);
  return v;
}

}  // namespace blockrand::outputs
