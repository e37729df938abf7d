#include "styles/classify/tag_features.h"

#include <algorithm>
#include <iterator>

#include "pipeline/base/toml_file.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::classify {

namespace {

namespace osm_key = model::osm_key;
constexpr int kOtherUse = 12;
/// Names of the values of Feature::tag_use.
constexpr std::string_view kUses[] = {"untold",      "flats",  "residential", "house",    "detached",
                                      "outbuilding", "office", "shop",        "industry", "church",
                                      "public",      "hotel",  "other"};
/// Below this a date is as likely the business's as the building's: it says nothing of the house.
constexpr float kMinDateConfidence = 0.5f;

}  // namespace

int roof_kind(model::RoofShape shape) {
  using enum model::RoofGroup;
  switch (model::traits(shape).group) {
    case flat:
      return 1;
    case gabled:
      return 2;
    case hipped:
      return 3;
    case mansard:
      return 4;
    case saltbox:
      return 5;
    case shed:
      return 6;
    case pyramidal:
      return 7;
    case cross_gabled:
    case folded:
    case round:
    case other:
      break;
  }
  return 8;
}

TagTables TagTables::read(const std::string& path) {
  base::TomlTable file = base::TomlTable::read(path);
  TagTables out;
  const auto read = [&](const char* name, std::map<std::string, int, std::less<>>& into, int low, int high) {
    auto table = file.table(name);
    if (!table) return;
    for (const std::string& key : table->keys()) into[key] = static_cast<int>(*table->integer(key, low, high));
    table->finish();
  };
  read("use", out.use, 0, kOtherUse);
  read("architecture", out.architecture, 500, 2100);
  if (auto table = file.table("styles_of_use")) {
    for (const std::string& key : table->keys()) {
      const auto kind = std::find(std::begin(kUses), std::end(kUses), key);
      if (kind == std::end(kUses)) {
        const std::string near = base::nearest(key, {std::begin(kUses), std::end(kUses)});
        table->fail(key, "there is no kind of use `" + key + "`", near.empty() ? "" : "Did you mean `" + near + "`?");
      }
      out.styles_of_use[static_cast<int>(kind - std::begin(kUses))] = *table->texts(key);
    }
    table->finish();
  }
  if (auto table = file.table("listing")) {
    out.listed = table->texts("listed").value_or(std::vector<std::string>{});
    out.known = table->texts("known").value_or(std::vector<std::string>{});
    table->finish();
  }
  out.attached = file.texts("attached").value_or(std::vector<std::string>{});
  file.finish();
  return out;
}

int TagTables::use_of(std::string_view value) const {
  const auto found = use.find(value);
  return found == use.end() ? kOtherUse : found->second;
}

void fill_tag_features(FeatureVector& f, const model::MappedAttributes& a, std::string_view use, const TagLookup& tag,
                       const TagTables& tables) {
  if (a.storeys) f[Feature::tag_storeys] = *a.storeys;
  if (a.roof_shape) f[Feature::tag_roof] = static_cast<float>(roof_kind(*a.roof_shape));
  if (a.roof_storeys) f[Feature::tag_roof_storeys] = *a.roof_storeys;
  f[Feature::tag_use] = static_cast<float>(tables.use_of(use));
  // Style of appearance: what is named outranks the year in which something was rebuilt (docs/style_measures.md 3.5).
  if (const auto style = tables.architecture.find(tag(osm_key::kBuildingArchitecture));
      style != tables.architecture.end())
    f[Feature::tag_year] = static_cast<float>(style->second);
  else if (a.built && a.built->confidence >= kMinDateConfidence)
    f[Feature::tag_year] = static_cast<float>(a.built->years.middle());
  const auto told = [&](std::string_view key) {
    const std::string_view value = tag(key);
    return !value.empty() && value != "no" && value != "none" && value != "vacant";
  };
  if (told(osm_key::kHeritage) || told(osm_key::kHistoric) || std::ranges::any_of(tables.listed, told))
    f[Feature::tag_heritage] = 2;
  else if (std::ranges::any_of(tables.known, told))
    f[Feature::tag_heritage] = 1;
  if (told(osm_key::kShop) || told(osm_key::kOffice) || told(osm_key::kAmenity)) f[Feature::tag_shop] = 1;
  f[Feature::tag_number] = tag(osm_key::kAddrHousenumber).empty() ? 0.f : 1.f;
}

}  // namespace blockrand::classify
