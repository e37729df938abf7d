#include "styles/classify/ground_floor.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::classify {

namespace {

using base::TomlTable;

// Estimates: a tag on the building itself may be of a business on the second floor; a mapped use is of the whole
// building.
constexpr float kTagOnBuilding = 0.85f, kUseOfBuilding = 0.8f, kUnknownUse = 0.3f;
constexpr int kMoreLikelyThanNot = 50;  ///< percent; compared as an integer, so that no last bit decides
constexpr int kPointsThatMatter = 20;   ///< more do not change a probability in percent

/// context::LineClass as it is written, streets only.
constexpr std::string_view kStreetClasses[] = {"motorway", "trunk",       "primary",       "secondary",
                                               "tertiary", "residential", "living_street", "pedestrian"};

int percent(double p) { return static_cast<int>(std::lround(p * 100)); }

double needed(TomlTable& table, std::string_view key, double low, double high) {
  const auto v = table.number(key, low, high);
  if (!v) table.fail(key, "no `" + std::string(key) + "`", "The rule needs it");
  return *v;
}

GroundFloorCategory read_category(TomlTable& table, const std::string& name, std::set<std::string>& said) {
  GroundFloorCategory c;
  c.name = name;
  c.on_ground_floor = needed(table, "on_ground_floor", 0, 1);
  c.uses = table.texts("uses").value_or(std::vector<std::string>{});
  for (const std::string& use : c.uses)
    if (!said.insert("building=" + use).second)
      table.fail("uses", "`" + use + "` stands twice", "Keep it in one category");
  for (const std::string& tag : table.texts("tags").value_or(std::vector<std::string>{})) {
    const std::size_t sign = tag.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == tag.size())
      table.fail("tags", "`" + tag + "` is no tag", "Write key=value, or key=* for any value");
    if (!said.insert(tag).second) table.fail("tags", "`" + tag + "` stands twice", "Keep it in one category");
    c.tags.emplace_back(tag.substr(0, sign), tag.substr(sign + 1));
  }
  table.finish();
  return c;
}

void read_shop_rule(TomlTable& table, GroundFloorRules& rules) {
  for (const std::string& m : table.texts("morphologies").value_or(std::vector<std::string>{})) {
    const auto found = std::find(model::kMorphologyNames.begin(), model::kMorphologyNames.end(), m);
    if (found == model::kMorphologyNames.end()) {
      const std::vector<std::string> known(model::kMorphologyNames.begin(), model::kMorphologyNames.end());
      const std::string near = base::nearest(m, known);
      table.fail("morphologies", "unknown morphology `" + m + "`", near.empty() ? "" : "Did you mean `" + near + "`?");
    }
    rules.shop_morphologies.push_back(static_cast<model::Morphology>(found - model::kMorphologyNames.begin()));
  }
  rules.shop_uses = table.texts("uses").value_or(std::vector<std::string>{});
  std::sort(rules.shop_uses.begin(), rules.shop_uses.end());
  rules.least_storeys = needed(table, "least_storeys", 1, 20);
  rules.corner = needed(table, "corner", 0, 1);
  rules.highest = needed(table, "highest", 0, 1);
  rules.elsewhere = needed(table, "elsewhere", 0, 1);
  auto street = table.table("street");
  if (!street)
    table.fail("street", "no [shop_rule.street] table", "It holds the probability of a shop by class of street");
  for (const std::string_view name : kStreetClasses)
    if (const auto p = street->number(name, 0, 1)) rules.shop_by_street.emplace(name, *p);
  if (const auto residential = rules.shop_by_street.find("residential"); residential != rules.shop_by_street.end())
    rules.shop_by_other_street = residential->second;
  street->finish();
  table.finish();
}

/// The key and value by which a category was found, for the evidence.
struct Found {
  std::size_t category = 0;
  std::string tag;
};

std::optional<Found> find_category(const GroundFloorRules& rules, const TagLookup& tag) {
  if (!tag) return std::nullopt;
  for (const bool any : {false, true})
    for (std::size_t c = 0; c < rules.categories.size(); ++c)
      for (const auto& [key, wanted] : rules.categories[c].tags) {
        if ((wanted == "*") != any) continue;
        const std::string_view value = tag(key);
        if (value.empty() || value == "no" || value == "vacant" || (!any && value != wanted)) continue;
        return Found{c, key + "=" + std::string(value)};
      }
  return std::nullopt;
}

struct ShopChance {
  double p = 0;
  std::string why;
};

ShopChance shop_chance(const GroundFloorFacts& facts, const GroundFloorRules& rules) {
  if (!facts.faces_street) return {rules.elsewhere, "does not front on a street"};
  if (facts.storeys && *facts.storeys < rules.least_storeys) return {rules.elsewhere, "a low house"};
  if (!facts.style) return {rules.elsewhere, "style not known"};
  const auto occurs = [&](model::Morphology m) {
    return std::find(facts.style->morphologies.begin(), facts.style->morphologies.end(), m) !=
           facts.style->morphologies.end();
  };
  if (std::none_of(rules.shop_morphologies.begin(), rules.shop_morphologies.end(), occurs))
    return {rules.elsewhere, "houses of style " + facts.style->id + " have no shops"};
  const auto by_street = rules.shop_by_street.find(facts.street_class);
  double p = by_street == rules.shop_by_street.end() ? rules.shop_by_other_street : by_street->second;
  std::string why = "front house of style " + facts.style->id + " on a street of class `" +
                    (facts.street_class.empty() ? "unknown" : std::string(facts.street_class)) + "`";
  if (facts.corner_house) {
    p += rules.corner;
    why += ", at a corner";
  }
  return {std::min(p, rules.highest), std::move(why)};
}

}  // namespace

std::optional<std::size_t> GroundFloorRules::category(const TagLookup& tag) const {
  const auto found = find_category(*this, tag);
  return found ? std::optional(found->category) : std::nullopt;
}

GroundFloorRules read_ground_floor(const std::string& configs) {
  TomlTable file = TomlTable::read(configs + "/styles/ground_floor.toml");
  GroundFloorRules rules;
  auto categories = file.table("category");
  if (!categories) file.fail("category", "no [category.…] table", "Name at least one category of uses");
  const std::vector<std::string> names = categories->keys();
  std::set<std::string> said;
  for (const std::string& name : file.texts("order").value_or(std::vector<std::string>{})) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      const std::string near = base::nearest(name, names);
      file.fail("order", "no [category." + name + "]", near.empty() ? "" : "Did you mean `" + near + "`?");
    }
    for (const GroundFloorCategory& c : rules.categories)
      if (c.name == name) file.fail("order", "`" + name + "` stands twice", "Keep one");
    auto table = categories->table(name);
    rules.categories.push_back(read_category(*table, name, said));
  }
  if (rules.categories.size() != names.size())
    file.fail("order", "not all categories are in the order", "It decides between categories that are equally likely");
  categories->finish();
  auto shop = file.table("shop_rule");
  if (!shop) file.fail("shop_rule", "no [shop_rule] table", "It says how likely a shop is where none is mapped");
  read_shop_rule(*shop, rules);
  file.finish();
  return rules;
}

GroundFloorUse ground_floor_use(const GroundFloorFacts& facts, const GroundFloorRules& rules) {
  using model::Source;
  if (const auto found = find_category(rules, facts.tag))
    return {rules.categories[found->category].name, Source::tag, kTagOnBuilding, found->tag + " on the building"};

  for (const GroundFloorCategory& c : rules.categories)
    if (std::find(c.uses.begin(), c.uses.end(), facts.use) != c.uses.end())
      return {c.name, Source::implied, kUseOfBuilding, "building=" + std::string(facts.use)};

  std::size_t best = 0;
  int best_percent = 0;
  for (std::size_t c = 0; c < rules.categories.size() && c < facts.points.size(); ++c) {
    double none = 1;
    for (int n = 0; n < std::min(facts.points[c], kPointsThatMatter); ++n)
      none *= 1 - rules.categories[c].on_ground_floor;
    if (const int p = percent(1 - none); p > best_percent) {
      best = c;
      best_percent = p;
    }
  }
  if (best_percent > kMoreLikelyThanNot) {
    const int n = facts.points[best];
    return {rules.categories[best].name, Source::geometry, static_cast<float>(best_percent) / 100,
            std::to_string(n) + (n == 1 ? " point" : " points") + " of category " + rules.categories[best].name +
                " mapped inside"};
  }

  const bool may_hold_a_shop =
      std::binary_search(rules.shop_uses.begin(), rules.shop_uses.end(), facts.use, std::less<>());
  const bool unknown = facts.use.empty() || facts.use == "yes" || facts.use == "building";
  const std::string whole = unknown ? "residential" : std::string(facts.use);
  if (!may_hold_a_shop)
    return {whole, Source::default_, unknown ? kUnknownUse : kUseOfBuilding, "as the whole building"};
  const ShopChance chance = shop_chance(facts, rules);
  const int shop = percent(chance.p);
  const std::string why = chance.why + ": a shop with probability " + std::to_string(shop) + " %";
  if (shop > kMoreLikelyThanNot) return {"shop", Source::preset, static_cast<float>(shop) / 100, why};
  return {whole, facts.style ? Source::preset : Source::default_,
          static_cast<float>(100 - shop) / 100 * (unknown && !facts.style ? kUnknownUse : kUseOfBuilding), why};
}

}  // namespace blockrand::classify
