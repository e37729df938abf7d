#include "pipeline/surroundings/catalogue.h"

#include <algorithm>
#include <cassert>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/geometry/plane_partition.h"
#include "pipeline/surroundings/shapes.h"

namespace blockrand::surroundings {
namespace {

using base::TomlTable;

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  try {
    if (file) text.assign(std::istreambuf_iterator<char>(file), {});
  } catch (const std::ios_base::failure&) {
    file.setstate(std::ios::failbit);  // a folder of that name
  }
  if (!file) throw base::InputError(path, "", "cannot be read", "Check the path and the file's permissions");
  return text;
}

[[noreturn]] void fail_unknown(const TomlTable& table, std::string_view key, const std::string& word,
                               const std::vector<std::string>& known, const std::string& remedy) {
  if (word.empty()) table.fail(key, "is missing", remedy);
  const std::string near = base::nearest(word, known);
  table.fail(key, "is unknown: `" + word + "`", near.empty() ? remedy : "Did you mean `" + near + "`?");
}

template <class T>
std::vector<std::string> names_of(const std::map<std::string, T, std::less<>>& rows) {
  std::vector<std::string> out;
  for (const auto& [name, row] : rows) out.push_back(name);
  return out;
}

/// The tables below a table, in the order of the file.
std::vector<std::pair<std::string, TomlTable>> rows_of(TomlTable& file, std::string_view key) {
  auto table = file.table(key);
  if (!table) file.fail(key, "is missing", "Give one row of it at least");
  std::vector<std::string> names = table->keys();
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return table->line(a) < table->line(b); });
  if (names.size() >= std::numeric_limits<std::uint16_t>::max()) table->fail("", "has too many rows", "Leave some out");
  std::vector<std::pair<std::string, TomlTable>> out;
  for (const std::string& name : names) out.emplace_back(name, *table->table(name));
  table->finish();
  return out;
}

/// `key`, `values` and `also` of a rule.
template <class Rule>
void read_tags(TomlTable& table, Rule& rule) {
  rule.key = table.text("key").value_or("");
  if (rule.key.empty()) table.fail("key", "is missing", "Give the key of a tag");
  if (auto values = table.texts("values")) {
    if (values->empty()) table.fail("values", "has nothing", "Leave it out where any value counts");
    rule.values = std::move(*values);
  }
  if (auto also = table.table("also")) {
    const std::vector<std::string> keys = also->keys();
    if (keys.size() != 1) table.fail("also", "must name one key", "Write it like {sport = [\"tennis\"]}");
    rule.also_key = keys[0];
    rule.also_values = also->texts(keys[0]).value_or(std::vector<std::string>{});
  }
}

/// Whether a rule fits. Rules of one key mostly stand together: its value is asked for once.
class Fit {
 public:
  explicit Fit(const TagOf& tag) : tag_(tag) {}
  template <class Rule>
  bool operator()(const Rule& rule) {
    if (rule.key != key_) {
      key_ = rule.key;
      value_ = tag_(key_);
    }
    return counts(rule.values, value_) && (rule.also_key.empty() || counts(rule.also_values, tag_(rule.also_key)));
  }

 private:
  static bool counts(const std::vector<std::string>& values, std::string_view value) {
    if (value.empty()) return false;
    if (values.empty()) return value != "no";
    // Of a list one is enough: sport=basketball;soccer.
    for (std::size_t begin = 0; begin <= value.size();) {
      const std::size_t end = std::min(value.find(';', begin), value.size());
      std::string_view one = value.substr(begin, end - begin);
      while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
      if (std::find(values.begin(), values.end(), one) != values.end()) return true;
      begin = end + 1;
    }
    return false;
  }

  const TagOf& tag_;
  std::string_view key_, value_;
};

GroundRule read_ground(TomlTable& table, const MaterialOf& material,
                       const std::vector<model::SurroundingMaterialClass>& names) {
  GroundRule rule;
  read_tags(table, rule);
  rule.none = table.boolean("none").value_or(false);
  if (!rule.none) {
    const std::string ground = table.text("ground").value_or("");
    const auto found = std::find(std::begin(model::kGroundClassNames), std::end(model::kGroundClassNames), ground);
    if (found == std::end(model::kGroundClassNames))
      fail_unknown(table, "ground", ground, {std::begin(model::kGroundClassNames), std::end(model::kGroundClassNames)},
                   "Give a class of pipeline/model/surroundings.h, or none = true");
    rule.ground = static_cast<model::GroundClass>(found - std::begin(model::kGroundClassNames));
    rule.material = names[material(table, "material")].name;
    rule.trees_per_hectare = table.number("trees_per_hectare", 0, 2000).value_or(0);
    rule.kerbed = table.boolean("kerbed").value_or(false);
  }
  table.finish();
  return rule;
}

StreetDefaults read_street(TomlTable& table, const MaterialOf& material,
                           const std::vector<model::SurroundingMaterialClass>& names) {
  StreetDefaults street;
  const auto measure = [&](std::string_view key, double least, double most) {
    const auto value = table.number(key, least, most);
    if (!value) table.fail(key, "is missing", "Give it in metres");
    return *value;
  };
  street.lane = measure("lane", 0.5, 10);
  street.width = measure("width", 0.3, 60);
  street.pavement = measure("pavement", 0, 20);
  street.kerbed = table.boolean("kerbed").value_or(true);
  street.built_up_only = table.boolean("built_up_only").value_or(true);
  street.material = names[material(table, "material")].name;
  table.finish();
  return street;
}

}  // namespace

Catalogue::Catalogue(const std::string& path) {
  const std::string text = text_of(path);
  sha256_ = base::sha256_of(text);
  TomlTable file = TomlTable::parse(text, path);

  for (auto& [name, table] : rows_of(file, "material")) {
    model::SurroundingMaterialClass row;
    row.name = name;
    const auto colour = model::colour_of_hex(table.text("colour").value_or(""));
    if (!colour) table.fail("colour", "is no colour", "Write it as #rrggbb");
    row.colour = *colour;
    if (const auto v = table.number("roughness", 0, 1)) row.roughness = static_cast<float>(*v);
    if (const auto v = table.number("metallic", 0, 1)) row.metallic = static_cast<float>(*v);
    const auto index = static_cast<model::SurroundingMaterial>(shown_.materials.size());
    for (const std::string& value : table.texts("surfaces").value_or(std::vector<std::string>{}))
      if (!surfaces_.emplace(value, index).second)
        table.fail("surfaces", "has `" + value + "`, which stands twice", "Keep it in one material");
    table.finish();
    materials_.emplace(name, index);
    shown_.materials.push_back(std::move(row));
  }
  const MaterialOf material_of = [&](TomlTable& table, std::string_view key) {
    const std::string name = table.text(key).value_or("");
    const auto found = materials_.find(name);
    if (found == materials_.end()) fail_unknown(table, key, name, names_of(materials_), "Give a row of [material]");
    return found->second;
  };

  for (auto& [name, table] : rows_of(file, "street"))
    streets_.emplace(name, read_street(table, material_of, shown_.materials));
  if (!streets_.contains("other")) file.fail("street", "has no row `other`", "It holds for all other streets");

  for (TomlTable& table : file.tables("left_hand_traffic")) {
    if (table.text("place").value_or("").empty()) table.fail("place", "is missing", "Say which place it is");
    std::vector<model::Point2>& ring = left_hand_.emplace_back();
    for (const auto& [lon, lat] : table.pairs("polygon").value_or(std::vector<std::pair<double, double>>{}))
      ring.push_back({lon, lat});
    if (ring.size() < 3)
      table.fail("polygon", "encloses nothing", "Write at least three corners as [longitude, latitude]");
    table.finish();
  }

  for (TomlTable& table : file.tables("ground")) grounds_.push_back(read_ground(table, material_of, shown_.materials));

  for (auto& [name, table] : rows_of(file, "shape")) {
    ShapeTags meant;
    meant.by_height = table.boolean("by_height").value_or(true);
    if (auto tags = table.table("tags"))
      for (const std::string& key : tags->keys())
        meant.tags.emplace_back(key, tags->texts(key).value_or(std::vector<std::string>{}));
    if (auto wires = table.pairs("wires")) meant.wires = std::move(*wires);
    shape_tags_.push_back(std::move(meant));
    shown_.shapes.push_back(read_shape(table, name, material_of));
    shapes_[shown_.shapes.back().kind].push_back(static_cast<std::uint16_t>(shown_.shapes.size() - 1));
  }

  for (TomlTable& table : file.tables("object")) {
    ObjectRule rule;
    read_tags(table, rule);
    const auto kind = table.text("kind");
    if (!kind || (!kind->empty() && !shapes_.contains(*kind)))
      fail_unknown(table, "kind", kind.value_or(""), names_of(shapes_), "Give the kind of a [shape], or \"\"");
    rule.kind = *kind;
    rule.node = table.boolean("node").value_or(true);
    rule.area = table.boolean("area").value_or(false);
    table.finish();
    objects_.push_back(std::move(rule));
  }
  file.finish();
}

model::SurroundingMaterial Catalogue::material(std::string_view name) const {
  const auto found = materials_.find(name);
  assert(found != materials_.end());
  return found == materials_.end() ? model::SurroundingMaterial{0} : found->second;
}

std::optional<model::SurroundingMaterial> Catalogue::surface(std::string_view value) const {
  const auto found = surfaces_.find(value.substr(0, value.find(';')));
  if (found == surfaces_.end()) return std::nullopt;
  return found->second;
}

const StreetDefaults& Catalogue::street(std::string_view highway) const {
  const auto found = streets_.find(highway);
  return found == streets_.end() ? streets_.find("other")->second : found->second;
}

bool Catalogue::keeps_left(model::Location place) const {
  constexpr double kUnit = 1e-7;
  const model::Point2 at{kUnit * place.lon, kUnit * place.lat};
  return std::ranges::any_of(left_hand_, [&](const std::vector<model::Point2>& ring) {
    geometry::AreaClaim claim;
    claim.rings.push_back(ring);
    return geometry::claim_holds(claim, at);
  });
}

const GroundRule* Catalogue::ground_of(const TagOf& tag) const {
  Fit fits(tag);
  for (const GroundRule& rule : grounds_)
    if (fits(rule)) return rule.none ? nullptr : &rule;
  return nullptr;
}

const ObjectRule* Catalogue::object_of(const TagOf& tag, bool area) const {
  Fit fits(tag);
  for (const ObjectRule& rule : objects_)
    if ((area ? rule.area : rule.node) && fits(rule)) return &rule;
  return nullptr;
}

const std::vector<std::uint16_t>& Catalogue::shapes_of(std::string_view kind) const {
  static const std::vector<std::uint16_t> none;
  const auto found = shapes_.find(kind);
  return found == shapes_.end() ? none : found->second;
}

}  // namespace blockrand::surroundings
