#include "styles/districts/read_rule_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "styles/districts/rule_checks.h"

namespace blockrand::districts {

namespace {

using base::TomlTable;

template <class Names>
std::vector<std::string> strings(const Names& names) {
  return {names.begin(), names.end()};
}

std::vector<std::string> position_names() {
  std::vector<std::string> names;
  for (int i = 1; i < model::kBuildingPositionCount; ++i)  // `unknown` is nothing to ask for
    names.emplace_back(model::name(static_cast<model::BuildingPosition>(i)));
  return names;
}

/// Place of `value` among `names`; an error at `key` with the nearest where it is none of them.
std::size_t index_of(const TomlTable& table, std::string_view key, const std::string& value,
                     const std::vector<std::string>& names, const std::string& what) {
  const auto found = std::find(names.begin(), names.end(), value);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::string near = base::nearest(value, names);
  std::string remedy = "Known: " + fmt::format("{}", fmt::join(names, ", ")) + ".";
  if (!near.empty()) remedy = "Did you mean " + near + "?";
  if (near.empty() && names.size() > 20) remedy.clear();
  table.fail(key, fmt::format("names '{}', which is no {}", value, what), remedy);
}

/// One text or an array of them; an empty array can never hold.
std::vector<std::string> one_or_more(TomlTable& table, std::string_view key) {
  if (!table.has(key)) return {};
  std::vector<std::string> values;
  if (table.holds_text(key))
    values.push_back(*table.text(key));
  else
    values = *table.texts(key);
  if (values.empty())
    table.fail(key, "is empty: nothing can satisfy it", "Name at least one value, or leave the key out.");
  for (const std::string& v : values)
    if (v.empty()) table.fail(key, "holds an empty text", "Leave it out.");
  return values;
}

/// A name, which cannot be nothing.
std::optional<std::string> name_at(TomlTable& table, std::string_view key) {
  auto value = table.text(key);
  if (value && value->empty())
    table.fail(key, "is empty: nothing has that name", "Write the name, or leave the key out.");
  return value;
}

std::optional<Interval> interval(TomlTable& table, std::string_view key, double minimum, double maximum) {
  const auto values = table.numbers(key);
  if (!values) return std::nullopt;
  if (values->size() != 2) table.fail(key, "must be two numbers", "Write [least, most], both included.");
  const Interval range{(*values)[0], (*values)[1]};
  if (range.from > range.to) table.fail(key, "is empty: its least value is above its most", "Swap them.");
  if (range.to < minimum || range.from > maximum)
    table.fail(key, "can never hold", fmt::format("Values lie from {:g} to {:g}.", minimum, maximum));
  return range;
}

TagTest tag_test(const TomlTable& table, std::string_view key, const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos) return {text, ""};
  const std::string value = text.substr(at + 1);
  if (at == 0) table.fail(key, "names no key: '" + text + "'", "Write key=value, or the key alone for any value.");
  if (value.empty())
    table.fail(key, "names no value: '" + text + "'", "Write key=value, or the key alone for any value.");
  return {text.substr(0, at), value == "*" ? "" : value};
}

model::Location location(const TomlTable& table, std::string_view key, double lon, double lat) {
  if (std::fabs(lon) > 180 || std::fabs(lat) > 90)
    table.fail(key, fmt::format("has a corner at {:g}, {:g}, which is nowhere", lon, lat),
               "Write longitude, latitude in degrees.");
  return {static_cast<std::int32_t>(std::lround(lon * 1e7)), static_cast<std::int32_t>(std::lround(lat * 1e7))};
}

std::vector<model::Location> ring(TomlTable& table, std::string_view key) {
  std::vector<model::Location> out;
  const auto pairs = table.pairs(key);
  if (!pairs) return out;
  for (const auto& [lon, lat] : *pairs) out.push_back(location(table, key, lon, lat));
  if (out.size() > 1 && out.front() == out.back()) out.pop_back();
  if (out.size() < 3 || double_area(out) == 0)
    table.fail(key, "encloses nothing", "Write at least three corners as [longitude, latitude].");
  return out;
}

class Reader {
 public:
  /// \param derived  files of the sets that have this one as their base, the outermost first
  Reader(const std::string& path, RuleSets& book, const std::string& shipped, std::vector<std::string> derived = {})
      : folder_(std::filesystem::path(path).parent_path()),
        shipped_(shipped),
        book_(book),
        derived_(std::move(derived)) {
    set_.file = path;
    set_.name = std::filesystem::path(path).stem().string();
    derived_.push_back(path);
  }

  RuleSet read(TomlTable root) {
    set_.title = root.text("title").value_or(set_.name);
    set_.description = root.text("description").value_or("");
    set_.polygon = ring(root, "polygon");
    const RuleSet base = base_of(root);
    if (auto presets = root.table("presets")) {
      for (const std::string& name : presets->keys()) {
        Preset preset = read_preset(name, *presets->table(name));
        preset.declared_in = set_.file;
        if (const std::size_t known = find_preset(book_.presets, name); known == kNoPreset)
          book_.presets.push_back(std::move(preset));
        else if (!same_file(book_.presets[known].declared_in,
                            set_.file))  // else read before, as the base of another set
          presets->fail(name, "is a preset already", "Choose another name; presets of all rule sets share one list.");
      }
    }
    for (const Preset& p : book_.presets) preset_names_.push_back(p.name);
    for (TomlTable& table : root.tables("rule")) set_.rules.push_back(rule(table));
    set_.prior = base.prior;
    if (auto table = root.table("prior")) prior(*table);
    take_over(base, root);
    root.finish();
    const Priors& p = set_.prior;
    if (set_.rules.empty() && !p.style && !p.era && p.substyle.empty() && p.storeys.empty())
      throw base::InputError(set_.file, "1", "holds no rule and no prior", "Write at least one [[rule]]");
    check_rules(set_);
    return std::move(set_);
  }

 private:
  static bool same_file(const std::string& a, const std::string& b) {
    std::error_code error;
    return !a.empty() && std::filesystem::equivalent(a, b, error);
  }

  /// The set that `base` names; an empty one where there is no such key.
  RuleSet base_of(TomlTable& root) {
    const auto name = name_at(root, "base");
    if (!name) return {};
    const bool is_file = name->ends_with(".toml");
    std::string path = (folder_ / (is_file ? *name : *name + ".toml")).lexically_normal().string();
    std::error_code error;
    if (!is_file && !shipped_.empty() && !std::filesystem::is_regular_file(path, error))
      if (const auto other = std::filesystem::path(shipped_) / (*name + ".toml");
          std::filesystem::is_regular_file(other, error))
        path = other.lexically_normal().string();
    if (!std::filesystem::is_regular_file(path, error))
      root.fail("base", "names a rule set that is not there: " + path,
                "Name a shipped set, or a file; paths start at the rule set's folder.");
    for (const std::string& file : derived_)
      if (same_file(file, path))
        root.fail("base", "leads back to " + file, "A rule set cannot be its own base; leave one of them out.");
    auto known = book_.bases.find(path);
    if (known == book_.bases.end())
      known = book_.bases.emplace(path, Reader(path, book_, shipped_, derived_).read(TomlTable::read(path))).first;
    const RuleSet& base = known->second;
    set_.bases.push_back(base.file);
    set_.bases.insert(set_.bases.end(), base.bases.begin(), base.bases.end());
    return base;
  }

  /// Rules of the base come after those of the set; one of a name that the set has itself, or leaves out, does not.
  void take_over(const RuleSet& base, TomlTable& root) {
    std::set<std::string> gone;
    for (const Rule& own : set_.rules) gone.insert(own.name);
    std::vector<std::string> known;
    for (const Rule& r : base.rules) known.push_back(r.name);
    if (const auto without = root.texts("without")) {
      if (base.file.empty()) root.fail("without", "leaves rules of a base out, and there is none", "Name it: base.");
      for (const std::string& name : *without) {
        index_of(root, "without", name, known, "rule of " + base.file);
        if (!gone.insert(name).second)
          root.fail("without", "names '" + name + "', which this set replaces", "A rule of that name replaces it.");
      }
    }
    for (const Rule& inherited : base.rules) {
      if (gone.contains(inherited.name)) continue;
      Rule rule = inherited;
      for (std::uint32_t& q : rule.where.queries) q = query(base.queries[q]);
      set_.rules.push_back(std::move(rule));
    }
  }

  Rule rule(TomlTable& table) {
    Rule rule;
    rule.file = set_.file;
    rule.line = table.line();
    rule.name = table.text("name").value_or("");
    if (rule.name.empty())
      table.fail("name", "is missing", "Every rule needs a name of its own: reports and explanations use it.");
    if (const auto level = table.text("level"))
      rule.level = static_cast<Level>(index_of(table, "level", *level, strings(kLevelNames), "level"));
    rule.priority = static_cast<int>(table.integer("priority", -1000, 1000).value_or(0));
    if (auto where = table.table("where")) read_where(*where, rule.where);
    if (auto which = table.table("which")) read_which(*which, rule.which);
    read_presets_of(table, rule);
    if (auto parameters = table.table("parameters")) {
      for (const std::string& key : parameters->keys()) rule.parameters[key] = *parameters->plain(key);
      if (rule.parameters.empty()) table.fail("parameters", "is empty", "Leave it out.");
    }
    if (rule.presets.empty() && rule.parameters.empty())
      table.fail("", "rule '" + rule.name + "' gives nothing", "Write preset = \"...\" or [rule.parameters].");
    table.finish();
    return rule;
  }

  std::uint32_t query(PlaceQuery q) {
    if (q.asked_in.empty()) q.asked_in = set_.file;
    set_.queries.push_back(std::move(q));
    return static_cast<std::uint32_t>(set_.queries.size() - 1);
  }

  void read_where(TomlTable& table, Where& where) {
    using Kind = PlaceQuery::Kind;
    const auto add = [&](std::string_view key, PlaceQuery q) {
      q.line = table.line(key);
      where.queries.push_back(query(std::move(q)));
    };
    if (table.has("polygon")) {
      PlaceQuery q;
      if (table.holds_text("polygon")) {
        q.kind = Kind::file;
        q.file = (folder_ / *name_at(table, "polygon")).lexically_normal().string();
        if (std::error_code error; !std::filesystem::exists(q.file, error))
          table.fail("polygon", "names a file that is not there: " + q.file, "Paths start at the rule set's folder.");
        q.layer = table.text("layer").value_or("");
        if (auto attributes = table.table("attributes"))
          for (const std::string& field : attributes->keys())
            q.attributes.push_back({field, *attributes->plain(field)});
      } else {
        q.ring = ring(table, "polygon");
      }
      add("polygon", std::move(q));
    }
    if (const auto name = name_at(table, "place")) {
      PlaceQuery q;
      q.kind = Kind::place;
      q.name = *name;
      q.distance = table.number("radius", 1, kMaxPlaceRadius).value_or(0);
      add("place", std::move(q));
    }
    if (const auto name = name_at(table, "boundary")) {
      PlaceQuery q;
      q.kind = Kind::boundary;
      q.name = *name;
      add("boundary", std::move(q));
    }
    if (table.has("landuse")) {
      PlaceQuery q;
      q.kind = Kind::land_use;
      q.values = one_or_more(table, "landuse");
      add("landuse", std::move(q));
    }
    for (TomlTable& near : table.tables("near")) {
      PlaceQuery q;
      q.kind = Kind::near;
      const auto within = near.number("within", 1, kMaxNear);
      if (!within) near.fail("within", "is missing", "Write within = 300: metres.");
      q.distance = *within;
      for (const std::string& key : near.keys()) {
        if (key == "within") continue;
        if (!q.feature.key.empty())
          near.fail(key, "is a second kind of feature", "Write one entry of `near` for each.");
        const std::string value = name_at(near, key).value_or("");
        q.feature = {key, value == "*" ? "" : value};
      }
      static const std::vector<std::string> kKeys = {"railway", "waterway", "natural", "landuse", "leisure",
                                                     "highway", "barrier",  "amenity", "shop"};
      if (q.feature.key.empty())
        near.fail("", "names no feature", "Write for example { railway = \"rail\", within = 300 }.");
      index_of(near, q.feature.key, q.feature.key, kKeys, "feature that extracts keep");
      near.finish();
      q.line = near.line("within");
      where.queries.push_back(query(std::move(q)));
    }
    if (const auto box = table.numbers("bbox")) {
      if (box->size() != 4) table.fail("bbox", "must be four numbers", "Write [west, south, east, north] in degrees.");
      where.bbox = {(*box)[0], (*box)[1], (*box)[2], (*box)[3]};
      if ((*box)[0] >= (*box)[2] || (*box)[1] >= (*box)[3])
        table.fail("bbox", "is empty", "Write [west, south, east, north] in degrees.");
      for (const double lon : {(*box)[0], (*box)[2]})
        if (std::fabs(lon) > 180)
          table.fail("bbox", fmt::format("has the longitude {:g}", lon),
                     "Write [west, south, east, north] in degrees.");
      for (const double lat : {(*box)[1], (*box)[3]})
        if (std::fabs(lat) > 90)
          table.fail("bbox", fmt::format("has the latitude {:g}", lat), "Write [west, south, east, north] in degrees.");
      check_box(table, *where.bbox);
    }
    constexpr double kMost[] = {10, 1, 200, 10000, 100, 1e7, 2100};
    for (std::size_t i = 0; i < kCellStatisticNames.size(); ++i)
      if (const auto range = interval(table, kCellStatisticNames[i], 0, kMost[i]))
        where.cell.emplace_back(static_cast<CellStatistic>(i), *range);
    table.finish();
  }

  void check_box(const TomlTable& table, const std::array<double, 4>& box) {
    if (set_.polygon.empty()) return;
    double west = 180, south = 90, east = -180, north = -90;
    for (const model::Location p : set_.polygon) {
      west = std::min(west, p.lon_degrees()), east = std::max(east, p.lon_degrees());
      south = std::min(south, p.lat_degrees()), north = std::max(north, p.lat_degrees());
    }
    if (box[0] > east || box[2] < west || box[1] > north || box[3] < south)
      table.fail("bbox", "lies outside of the rule set's polygon: it can never hold", "Longitude comes first.");
  }

  void read_which(TomlTable& table, Which& which) {
    if (const auto style = table.text("style"))
      which.style = static_cast<model::StyleClass>(
          index_of(table, "style", *style, strings(model::kStyleClassNames), "class of appearance"));
    if (const auto p = table.number("probability", 0, 1)) {
      if (!which.style && !table.has("era") && !table.has("substyle"))
        table.fail("probability", "belongs to no style, sub-style or era", "Add one of them.");
      which.probability = *p;
    }
    for (const std::string& era : one_or_more(table, "era"))
      which.eras.push_back(static_cast<model::Era>(index_of(table, "era", era, strings(model::kEraNames), "era")));
    which.years = interval(table, "years", 500, 2100);
    if (which.years && !which.eras.empty()) {
      const bool meets = std::any_of(which.eras.begin(), which.eras.end(), [&](model::Era era) {
        return era >= model::era_of(static_cast<int>(which.years->from)) &&
               era <= model::era_of(static_cast<int>(which.years->to));
      });
      if (!meets) table.fail("years", "lie outside of the eras: both can never hold", "Leave one of them out.");
    }
    which.substyles = one_or_more(table, "substyle");
    if (!book_.substyles.empty())
      for (const std::string& s : which.substyles)
        index_of(table, "substyle", s, book_.substyles, "style of the catalogue");
    if (which.style && which.probability >= 0.5 && !which.substyles.empty()) {
      const auto of_class = [&](const std::string& s) {
        const auto lists = [&](const Preset& p) {
          return std::find(p.substyles.begin(), p.substyles.end(), s) != p.substyles.end();
        };
        const auto found = std::find_if(book_.presets.begin(), book_.presets.end(), lists);
        return found == book_.presets.end() ||
               found->style == *which.style;  // what no preset lists is of unknown class
      };
      if (std::none_of(which.substyles.begin(), which.substyles.end(), of_class))
        table.fail("substyle",
                   fmt::format("is of another class than {}: both can never hold", model::name(*which.style)),
                   "Leave one of them out.");
    }
    which.uses = one_or_more(table, "use");
    which.area = interval(table, "area", 0, 1e7);
    which.storeys = interval(table, "storeys", 0, 200);
    which.front = interval(table, "front", 0, 1e4);
    for (const std::string& position : one_or_more(table, "position"))
      which.positions.push_back(static_cast<model::BuildingPosition>(
          1 + index_of(table, "position", position, position_names(), "position in a block")));
    for (const std::string& tag : one_or_more(table, "tag")) which.tags.push_back(tag_test(table, "tag", tag));
    for (const std::string& tag : one_or_more(table, "any_tag"))
      which.any_tags.push_back(tag_test(table, "any_tag", tag));
    which.house = table.boolean("house");
    table.finish();
  }

  std::uint32_t preset_index(const TomlTable& table, std::string_view key, const std::string& name) {
    return static_cast<std::uint32_t>(index_of(table, key, name, preset_names_, "known preset"));
  }

  void read_presets_of(TomlTable& table, Rule& rule) {
    if (!table.has("preset")) return;
    if (table.holds_text("preset")) {
      rule.presets.push_back({preset_index(table, "preset", *table.text("preset")), 1});
      return;
    }
    TomlTable weights = *table.table("preset");
    double sum = 0;
    for (const std::string& name : weights.keys()) {
      const std::uint32_t preset = preset_index(weights, name, name);
      const double weight = *weights.number(name, -1e9, 1e9);
      if (weight <= 0)
        weights.fail(name, fmt::format("has the weight {:g}", weight),
                     "Weights are above 0; leave out what shall not be drawn.");
      rule.presets.push_back({preset, weight});
      sum += weight;
    }
    if (rule.presets.empty()) table.fail("preset", "is empty", "Name at least one preset with its weight.");
    if (std::fabs(sum - 1) > 0.01)
      table.fail("preset", fmt::format("has weights that sum to {:g}", sum), "Weights are shares and sum to 1.");
    for (WeightedPreset& p : rule.presets) p.weight /= sum;
  }

  /// Shares per name that sum to 1.
  template <class Visit>
  void shares(TomlTable& prior, std::string_view key, const std::vector<std::string>& names, const char* what,
              Visit&& visit) {
    auto table = prior.table(key);
    if (!table) return;
    double sum = 0;
    for (const std::string& name : table->keys()) {
      const std::size_t index = names.empty() ? 0 : index_of(*table, name, name, names, what);
      const double share = *table->number(name, 0, 1);
      sum += share;
      visit(name, index, share);
    }
    if (std::fabs(sum - 1) > 0.01)
      prior.fail(key, fmt::format("sums to {:g}", sum), "Priors are shares and sum to 1; what is not named is 0.");
    table->finish();
  }

  void prior(TomlTable& table) {
    // What is given takes the place of the base's; of storeys, each number for itself.
    Priors& out = set_.prior;
    if (table.has("style")) out.style.emplace().fill(0);
    if (table.has("era")) out.era.emplace().fill(0);
    if (table.has("substyle")) out.substyle.clear();
    shares(table, "style", strings(model::kStyleClassNames), "class of appearance",
           [&](const std::string&, std::size_t i, double p) { (*out.style)[i] = p; });
    shares(table, "era", strings(model::kEraNames), "era",
           [&](const std::string&, std::size_t i, double p) { (*out.era)[i] = p; });
    shares(table, "substyle", book_.substyles, "style of the catalogue",
           [&](const std::string& name, std::size_t, double p) { out.substyle[name] = p; });
    if (auto absent = table.texts("absent")) {
      for (const std::string& id : *absent) {
        if (!book_.substyles.empty()) index_of(table, "absent", id, book_.substyles, "style of the catalogue");
        if (out.substyle.contains(id))
          table.fail("absent", "names '" + id + "', which has a share", "Leave it out here or in substyle.");
      }
      out.absent = std::move(*absent);
    }
    std::erase_if(out.absent, [&](const std::string& id) { return out.substyle.contains(id); });  // what a base said
    if (auto storeys = table.table("storeys")) {
      for (const std::string& name : storeys->keys()) {
        index_of(*storeys, name, name, strings(kStoreyPriorNames), "kind of house with usual storeys");
        out.storeys[name] = *storeys->number(name, 0.5, 40);
      }
      storeys->finish();
    }
    table.finish();
  }

  std::filesystem::path folder_;
  std::string shipped_;
  RuleSets& book_;
  std::vector<std::string> derived_;
  RuleSet set_;
  std::vector<std::string> preset_names_;
};

}  // namespace

void read_rule_set(const std::string& path, RuleSets& book, const std::string& shipped) {
  const auto known = book.bases.find(std::filesystem::path(path).lexically_normal().string());
  book.sets.push_back(known != book.bases.end() ? known->second
                                                : Reader(path, book, shipped).read(TomlTable::read(path)));
}

}  // namespace blockrand::districts
