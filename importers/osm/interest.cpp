#include "importers/osm/interest.h"

#include <algorithm>
#include <iterator>

#include "importers/osm/interest_rules.h"

namespace blockrand::importers::osm {
namespace {

using interest_rules::bit;

constexpr bool by_first_letter(const InterestRule& a, const InterestRule& b) { return a.key.front() < b.key.front(); }
static_assert(std::is_sorted(std::begin(kInterestRules), std::end(kInterestRules), by_first_letter));

/// Index of the first rule whose key begins with a letter or a later one: every tag of the file passes here.
constexpr auto kFirstOfLetter = [] {
  std::array<std::uint8_t, 257> first{};
  for (std::size_t letter = 0; letter < first.size(); ++letter)
    for (const InterestRule& rule : kInterestRules)
      first[letter] += static_cast<unsigned char>(rule.key.front()) < letter;
  return first;
}();

bool is_of(const InterestRule& rule, std::string_view key, std::string_view value) {
  if (key != rule.key && !(rule.key.ends_with(':') && key.starts_with(rule.key))) return false;
  if (rule.values.front().empty()) return true;
  return !value.empty() && std::find(rule.values.begin(), rule.values.end(), value) != rule.values.end();
}

}  // namespace

void Interest::add(model::OsmType type, std::string_view key, std::string_view value) {
  if (key == model::osm_key::kArea) {
    area_no = area_no || value == "no";
    area_yes = area_yes || value == "yes";
    return;
  }
  if (key.empty() || value == "no") return;
  const auto letter = static_cast<unsigned char>(key.front());
  for (std::size_t i = kFirstOfLetter[letter]; i < kFirstOfLetter[letter + 1u]; ++i) {
    const InterestRule& rule = kInterestRules[i];
    if (!is_of(rule, key, value)) continue;
    if (!surroundings && rule.kinds == bit(model::FeatureKind::surrounding)) continue;
    if (type != model::OsmType::node && !rule.ways) continue;
    if (type == model::OsmType::node && !rule.nodes) return;
    kinds |= rule.kinds;
    building = building || rule.mark == ObjectMark::building;
    building_part = building_part || rule.mark == ObjectMark::building_part;
    covered_way = covered_way || rule.mark == ObjectMark::covered_way;
    area_by_tag = area_by_tag || rule.closed == ClosedWay::area;
    line_by_tag = line_by_tag || rule.closed == ClosedWay::line;
    return;
  }
}

void Interest::finish(model::OsmType type) {
  using enum model::FeatureKind;
  if (covered_way && type == model::OsmType::way && (kinds & (bit(street) | bit(railway))) != 0) kinds |= bit(passage);
}

bool is_remark(std::string_view key) {
  return std::find(std::begin(kRemarkKeys), std::end(kRemarkKeys), key) != std::end(kRemarkKeys) ||
         key.starts_with("source:") || key.starts_with("note:") || key.starts_with("test:");
}

}  // namespace blockrand::importers::osm
