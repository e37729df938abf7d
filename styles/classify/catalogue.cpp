#include "styles/classify/catalogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::classify {

namespace {

using base::TomlTable;

constexpr double kShareSlack = 0.001;  ///< of a sum of shares, for decimal fractions
constexpr double kEavesSlack = 1.0;    ///< m; docs/style_measures.md 6 checks its tables by it
constexpr int kFirstYear = 500, kLastYear = 2100;

using Palettes = std::map<std::string, std::vector<model::Colour>, std::less<>>;

template <class T>
T required(const TomlTable& table, std::string_view key, std::optional<T> value) {
  if (!value) table.fail(key, "no `" + std::string(key) + "`", "Every style needs it");
  return std::move(*value);
}

/// The place of `word` in `names`.
template <std::size_t N>
std::size_t one_of(const TomlTable& table, std::string_view key, const std::string& word,
                   const std::array<std::string_view, N>& names) {
  for (std::size_t i = 0; i < N; ++i)
    if (names[i] == word) return i;
  std::string known;
  for (const std::string_view n : names) known += (known.empty() ? "" : ", ") + std::string(n);
  table.fail(key, "unknown `" + word + "`", "Known are: " + known);
}

Spread spread_of(const TomlTable& table, std::string_view key, const std::vector<double>& v, double low, double high) {
  if (v.size() != 3) table.fail(key, "not three numbers", "Write [min, typ, max]");
  if (!(v[0] <= v[1] && v[1] <= v[2])) table.fail(key, "min, typ and max are not in order", "Write [min, typ, max]");
  if (v[0] < low || v[2] > high) {
    char limits[64];
    std::snprintf(limits, sizeof limits, "Keep it from %g to %g", low, high);
    table.fail(key, "out of range", limits);
  }
  return {v[0], v[1], v[2]};
}

std::vector<model::Colour> colours_of(const TomlTable& table, std::string_view key,
                                      const std::vector<std::string>& texts, const Palettes& palettes) {
  std::vector<model::Colour> out;
  for (const std::string& text : texts) {
    if (const auto palette = palettes.find(text); palette != palettes.end()) {
      out.insert(out.end(), palette->second.begin(), palette->second.end());
      continue;
    }
    const auto colour = model::colour_of_hex(text);
    if (!colour) {
      std::vector<std::string> known;
      for (const auto& [id, colours] : palettes) known.push_back(id);
      const std::string near = base::nearest(text, known);
      table.fail(key, "`" + text + "` is neither a palette nor a colour",
                 near.empty() ? "Name a palette of [palette] or write #rrggbb" : "Did you mean `" + near + "`?");
    }
    out.push_back(*colour);
  }
  if (out.empty()) table.fail(key, "no colours", "Name a palette of [palette] or write #rrggbb");
  return out;
}

std::string material_of(TomlTable& table, std::string_view key, const std::vector<std::string>& materials) {
  const std::string value = required(table, key, table.text(key));
  if (std::find(materials.begin(), materials.end(), value) == materials.end()) {
    const std::string near = base::nearest(value, materials);
    table.fail(key, "unknown material `" + value + "`",
               near.empty() ? "Add it to configs/materials/materials.toml" : "Did you mean `" + near + "`?");
  }
  return value;
}

void read_roof(TomlTable& table, Style& style) {
  auto shares = table.table("roof");
  if (!shares) table.fail("roof", "no `roof`", "Write roof = { flat = 0.2, gabled = 0.8 }");
  double sum = 0;
  for (std::size_t f = 0; f < kRoofFamilyNames.size(); ++f)
    if (const auto share = shares->number(kRoofFamilyNames[f], 0, 1)) sum += style.roof[f] = *share;
  shares->finish();
  if (std::abs(sum - 1) > kShareSlack)
    table.fail("roof", "the shares do not sum to 1", "They are parts of all roofs of the style");
  if (auto detail = table.table("roof_detail")) {
    if (const auto share = detail->number("double_saltbox", 0, 1)) style.double_saltbox = *share;
    detail->finish();
    if (style.double_saltbox > style.roof[static_cast<std::size_t>(RoofFamily::other)] + kShareSlack)
      table.fail("roof_detail", "double_saltbox is more than `other`", "It is a part of roof.other");
  }
  style.gable_to_street = table.boolean("gable_to_street").value_or(false);
  if (const auto v = table.numbers("roof_pitch")) style.roof_pitch = spread_of(table, "roof_pitch", *v, 0, 85);
  if (!style.roof_pitch && style.roof[static_cast<std::size_t>(RoofFamily::flat)] < 1 - kShareSlack)
    table.fail("roof", "no `roof_pitch` for a style with roofs that are not flat",
               "Write roof_pitch = [min, typ, max]");
}

Style read_style(TomlTable& table, const std::string& id, const Palettes& palettes,
                 const std::vector<std::string>& materials) {
  Style s;
  s.id = id;
  s.note = required(table, "note", table.text("note"));
  s.style_class = static_cast<model::StyleClass>(
      one_of(table, "class", required(table, "class", table.text("class")), model::kStyleClassNames));
  const std::vector<double> years = required(table, "years", table.numbers("years"));
  const auto is_year = [](double y) { return y == std::floor(y) && y >= kFirstYear && y <= kLastYear; };
  if (years.size() != 2 || !is_year(years[0]) || !is_year(years[1]) || years[0] > years[1])
    table.fail("years", "not a range of years", "Write [from, to], whole years from 500 to 2100");
  s.years = {static_cast<std::int16_t>(years[0]), static_cast<std::int16_t>(years[1])};
  for (const std::string& m : required(table, "morphologies", table.texts("morphologies"))) {
    const auto morphology = static_cast<model::Morphology>(one_of(table, "morphologies", m, model::kMorphologyNames));
    if (s.occurs_in(morphology) && !s.morphologies.empty())
      table.fail("morphologies", "`" + m + "` stands twice", "Keep one");
    s.morphologies.push_back(morphology);
  }
  s.position = static_cast<StylePosition>(
      one_of(table, "position", required(table, "position", table.text("position")), kStylePositionNames));
  s.share = table.number("share", 0.001, 1).value_or(1);
  s.storeys = spread_of(table, "storeys", required(table, "storeys", table.numbers("storeys")), 1, 60);
  s.storey_height = required(table, "storey_height", table.number("storey_height", 2, 15));
  s.ground_floor_height = required(table, "ground_floor_height", table.number("ground_floor_height", 2, 15));
  s.plinth = required(table, "plinth", table.number("plinth", 0, 3));
  s.attic_wall = table.number("attic_wall", 0, 3).value_or(0);
  if (const auto v = table.numbers("eaves")) {
    s.eaves = spread_of(table, "eaves", *v, 1, 250);
    const double sum = s.plinth + s.storeys.typ * s.storey_height + s.attic_wall;
    if (std::abs(sum - s.eaves->typ) > kEavesSlack + 1e-9) {
      char text[160];
      std::snprintf(text, sizeof text, "typical eaves at %g m, but plinth, storeys and attic wall make %.1f m",
                    s.eaves->typ, sum);
      table.fail("eaves", text, "They may differ by 1 m");
    }
  }
  read_roof(table, s);
  s.wall_colours =
      colours_of(table, "wall_colours", required(table, "wall_colours", table.texts("wall_colours")), palettes);
  s.roof_colours =
      colours_of(table, "roof_colours", required(table, "roof_colours", table.texts("roof_colours")), palettes);
  s.wall_material = material_of(table, "wall_material", materials);
  s.roof_material = material_of(table, "roof_material", materials);
  table.finish();
  return s;
}

std::vector<std::string> material_classes(const std::string& path) {
  TomlTable file = TomlTable::read(path);
  const auto classes = file.table("class");
  if (!classes) file.fail("class", "no [class.…] table", "Define at least one material class");
  return classes->keys();
}

}  // namespace

bool Style::occurs_in(model::Morphology morphology) const {
  return morphologies.empty() || std::find(morphologies.begin(), morphologies.end(), morphology) != morphologies.end();
}

Catalogue::Catalogue(std::vector<Style> styles) : styles_(std::move(styles)) {
  std::sort(styles_.begin(), styles_.end(), [](const Style& a, const Style& b) { return a.id < b.id; });
  for (std::size_t i = 0; i < styles_.size(); ++i)
    by_class_[static_cast<std::size_t>(styles_[i].style_class)].push_back(static_cast<std::uint8_t>(i));
}

std::optional<std::uint8_t> Catalogue::index(std::string_view id) const {
  const auto found =
      std::lower_bound(styles_.begin(), styles_.end(), id, [](const Style& s, std::string_view i) { return s.id < i; });
  if (found == styles_.end() || found->id != id) return std::nullopt;
  return static_cast<std::uint8_t>(found - styles_.begin());
}

const Style* Catalogue::find(std::string_view id) const {
  const auto i = index(id);
  return i ? &styles_[*i] : nullptr;
}

Catalogue read_catalogue(const std::string& configs) {
  const std::vector<std::string> materials = material_classes(configs + "/materials/materials.toml");
  TomlTable file = TomlTable::read(configs + "/styles/catalogue.toml");
  Palettes palettes;
  if (auto table = file.table("palette")) {
    for (const std::string& id : table->keys())
      palettes[id] = colours_of(*table, id, required(*table, id, table->texts(id)), {});
    table->finish();
  }
  auto styles = file.table("style");
  if (!styles) file.fail("style", "no [style.…] table", "The catalogue needs at least one style");
  std::vector<Style> out;
  for (const std::string& id : styles->keys()) {
    if (out.size() == 255) styles->fail(id, "more than 255 styles", "Merge some");
    auto table = styles->table(id);
    out.push_back(read_style(*table, id, palettes, materials));
  }
  styles->finish();
  file.finish();
  return Catalogue(std::move(out));
}

}  // namespace blockrand::classify
