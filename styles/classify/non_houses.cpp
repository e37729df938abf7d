#include "styles/classify/non_houses.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::classify {

namespace {

using base::TomlTable;

constexpr double kTwoStoreys = 1.5;  ///< more is more than a ground floor

std::vector<std::string> words(TomlTable& table, std::string_view key) {
  auto out = table.texts(key).value_or(std::vector<std::string>{});
  std::sort(out.begin(), out.end());
  return out;
}

bool contains(const std::vector<std::string>& ascending, std::string_view word) {
  return std::binary_search(ascending.begin(), ascending.end(), word, std::less<>());
}

double needed(TomlTable& table, std::string_view key, double low, double high) {
  const auto v = table.number(key, low, high);
  if (!v) table.fail(key, "no `" + std::string(key) + "`", "The rule needs it");
  return *v;
}

void read_kind(TomlTable& table, const std::string& name, NonHouseRules& rules, const Catalogue& catalogue) {
  NonHouseKind kind;
  kind.name = name;
  const auto what = table.text("what");
  if (!what) table.fail("what", "no `what`", "It says what the building is, for the reader of a report");
  kind.what = *what;
  if (const auto style = table.text("style")) kind.style = *style;
  if (!catalogue.find(kind.style))
    table.fail("style", "no style `" + kind.style + "` in catalogue.toml", "Name one of its tables");
  kind.any_use = table.boolean("any_use").value_or(false);
  kind.without_address = table.boolean("without_address").value_or(false);
  if (const auto v = table.number("largest_area", 1, 1e6)) kind.largest_area = *v;
  const std::size_t index = rules.kinds.size();
  const auto uses = words(table, "uses");
  for (const std::string& use : uses)
    if (!rules.by_use.emplace(use, index).second)
      table.fail("uses", "`" + use + "` stands twice", "Keep it in one kind");
  const auto tags = table.texts("tags").value_or(std::vector<std::string>{});
  for (const std::string& tag : tags) {
    const std::size_t sign = tag.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == tag.size())
      table.fail("tags", "`" + tag + "` is no tag", "Write key=value, or key=* for any value");
    rules.tags.push_back({tag.substr(0, sign), tag.substr(sign + 1), index});
  }
  if (uses.empty() && tags.empty()) table.fail("uses", "neither uses nor tags", "Nothing would ever be of this kind");
  table.finish();
  rules.kinds.push_back(std::move(kind));
}

std::string square_metres(double area) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f m²", area);
  return text;
}

}  // namespace

NonHouseRules read_non_houses(const std::string& configs, const Catalogue& catalogue) {
  TomlTable file = TomlTable::read(configs + "/styles/non_houses.toml");
  NonHouseRules rules;
  auto geometry = file.table("geometry");
  if (!geometry) file.fail("geometry", "no [geometry] table", "It holds the areas and counts of the rule");
  rules.tiny_area = needed(*geometry, "tiny_area", 0, 100);
  rules.small_area = needed(*geometry, "small_area", 0, 200);
  rules.equal_count = static_cast<int>(needed(*geometry, "equal_count", 2, 1000));
  rules.equal_radius = needed(*geometry, "equal_radius", 1, 100);
  rules.equal_area_tolerance = needed(*geometry, "equal_area_tolerance", 0, 1);
  rules.equal_largest_area = needed(*geometry, "equal_largest_area", 1, 200);
  rules.equal_count_on_memorial_ground = static_cast<int>(needed(*geometry, "equal_count_on_memorial_ground", 1, 1000));
  rules.dwellings = words(*geometry, "dwellings");
  rules.generic_uses = words(*geometry, "generic_uses");
  geometry->finish();
  auto kinds = file.table("kind");
  if (!kinds) file.fail("kind", "no [kind.…] table", "Name at least one kind of building that is no house");
  for (const std::string& name : kinds->keys()) {
    auto table = kinds->table(name);
    read_kind(*table, name, rules, catalogue);
  }
  kinds->finish();
  file.finish();
  return rules;
}

std::vector<int> equal_neighbours(std::span<const SmallPlan> plans, const NonHouseRules& rules) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < plans.size(); ++i)
    if (plans[i].corners == 4 && plans[i].area <= rules.equal_largest_area) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return plans[a].place.x < plans[b].place.x; });
  std::vector<int> out(plans.size(), 0);
  // A window that moves from west to east; fields are dense, but a window holds a strip of them only.
  for (std::size_t i = 0; i < order.size(); ++i) {
    const SmallPlan& a = plans[order[i]];
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      const SmallPlan& b = plans[order[k]];
      const double dx = b.place.x - a.place.x, dy = b.place.y - a.place.y;
      if (dx > rules.equal_radius) break;
      if (dx * dx + dy * dy > rules.equal_radius * rules.equal_radius) continue;
      if (std::abs(a.area - b.area) > rules.equal_area_tolerance * std::max(a.area, b.area)) continue;
      ++out[order[i]];
      ++out[order[k]];
    }
  }
  return out;
}

std::optional<NonHouse> non_house(const NonHouseFacts& facts, const NonHouseRules& rules) {
  const auto of_kind = [&](std::size_t kind, const std::string& why) {
    return NonHouse{rules.kinds[kind].name, rules.kinds[kind].style, why + ": " + rules.kinds[kind].what};
  };
  if (const auto found = rules.by_use.find(facts.use);
      found != rules.by_use.end() && facts.area <= rules.kinds[found->second].largest_area)
    return of_kind(found->second, "building=" + std::string(facts.use));

  const bool generic = contains(rules.generic_uses, facts.use);
  if (facts.tag)
    for (const NonHouseRules::TagRule& rule : rules.tags) {
      const NonHouseKind& kind = rules.kinds[rule.kind];
      if ((!generic && !kind.any_use) || facts.area > kind.largest_area) continue;
      if (facts.has_address && kind.without_address) continue;
      const std::string_view value = facts.tag(rule.key);
      if (value.empty() || value == "no" || (rule.value != "*" && value != rule.value)) continue;
      return of_kind(rule.kind, rule.key + "=" + std::string(value));
    }

  const bool dwelling = contains(rules.dwellings, facts.use);
  const bool shop = facts.tag && !facts.tag(model::osm_key::kShop).empty() && facts.tag(model::osm_key::kShop) != "no";
  if (facts.has_address) return std::nullopt;
  if (!dwelling && !shop && !facts.storeys && facts.area <= rules.equal_largest_area) {
    const int count = facts.on_memorial_ground ? rules.equal_count_on_memorial_ground : rules.equal_count;
    if (facts.equal_neighbours >= count) {
      char why[160];
      std::snprintf(why, sizeof why, "%d rectangles of the same size within %g m%s: stelae, graves or garages",
                    facts.equal_neighbours, rules.equal_radius, facts.on_memorial_ground ? " on memorial ground" : "");
      return NonHouse{"field_of_equals", "ancillary", why};
    }
  }
  if (facts.area < rules.tiny_area && !(facts.storeys && *facts.storeys > kTwoStoreys))
    return NonHouse{"tiny", "ancillary",
                    square_metres(facts.area) + " without an address: too small to live or work in"};
  if (facts.area < rules.small_area && !facts.storeys && !shop && !dwelling)
    return NonHouse{"outbuilding", "ancillary",
                    square_metres(facts.area) + " without address, storeys or shop: an outbuilding"};
  return std::nullopt;
}

}  // namespace blockrand::classify
