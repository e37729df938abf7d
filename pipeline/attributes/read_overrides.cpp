#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "pipeline/attributes/override_values.h"
#include "pipeline/attributes/overrides.h"
#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::attributes {

namespace {

using base::TomlTable;
using model::OsmId;

/// Least and most of a number.
struct Range {
  std::string_view attribute;
  double least, most;
};
constexpr Range kRanges[] = {{"storeys", 0, 200},         {"storey_height", 1.5, 20},    {"height", 0.1, 2000},
                             {"min_height", 0, 2000},     {"roof_storeys", 0, 20},       {"roof_height", 0, 500},
                             {"roof_direction", 0, 360},  {"ground_height", -500, 9000}, {"plinth_height", 0, 50},
                             {"eaves_height", 0.1, 2000}, {"roof_pitch", 0, 89},         {"ridge_direction", 0, 180}};

std::optional<OsmId> parse_id(std::string_view text) {
  if (text.size() < 2) return std::nullopt;
  OsmId id;
  switch (text.front()) {
    case 'n':
      id.type = model::OsmType::node;
      break;
    case 'w':
      id.type = model::OsmType::way;
      break;
    case 'r':
      id.type = model::OsmType::relation;
      break;
    default:
      return std::nullopt;
  }
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), id.number);
  if (error != std::errc() || end != text.data() + text.size() || id.number == 0) return std::nullopt;
  return id;
}

[[noreturn]] void unknown(const TomlTable& table, std::string_view key, const std::string& value,
                          const std::vector<std::string>& known) {
  const std::string near = base::nearest(value, known);
  std::string remedy = "Known: " + fmt::format("{}", fmt::join(known, ", ")) + ".";
  if (known.size() > 40) remedy.clear();
  if (!near.empty()) remedy = "Did you mean " + near + "?";
  table.fail(key, "is unknown: '" + value + "'", remedy);
}

template <class Names>
void check_name(const TomlTable& table, std::string_view key, const std::string& value, const Names& names) {
  const std::vector<std::string> known(names.begin(), names.end());
  if (!known.empty() && std::find(known.begin(), known.end(), value) == known.end()) unknown(table, key, value, known);
}

void check_word(const TomlTable& table, std::string_view key, const std::string& value) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789_";
  if (value.empty() || value.find_first_not_of(kLetters) != std::string::npos)
    table.fail(key, "is no value of that tag: '" + value + "'", "Write lower-case letters, digits and _.");
}

std::string path_beside(const std::string& file, const std::string& named) {
  std::filesystem::path path(named);
  if (path.is_relative()) path = std::filesystem::path(file).parent_path() / path;
  return path.string();
}

class Reader {
 public:
  Reader(std::string file, const Defaults& defaults, const OverrideNames& names) : defaults_(defaults), names_(names) {
    out_.file = std::move(file);
    out_.name = out_.file.substr(out_.file.find_last_of('/') + 1);
    for (const Material& m : defaults.materials) materials_.push_back(m.material_class.name);
  }

  Overrides read(TomlTable root) {
    for (const std::string& key : root.keys()) {
      const auto id = parse_id(key);
      if (!id)
        root.fail(key, "is no id of an OpenStreetMap object",
                  "Write for example [w123] for way 123, [r45] for relation 45.");
      entry(*root.table(key), key, *id, *id);
    }
    root.finish();
    std::sort(out_.entries.begin(), out_.entries.end(),
              [](const auto& a, const auto& b) { return a.object < b.object; });
    for (std::size_t i = 1; i < out_.entries.size(); ++i)
      if (out_.entries[i].object == out_.entries[i - 1].object)
        throw base::InputError(out_.file, std::to_string(std::max(out_.entries[i].line, out_.entries[i - 1].line)),
                               out_.entries[i].object.text() + " stands twice", "Keep one of its entries");
    return std::move(out_);
  }

 private:
  void entry(TomlTable table, const std::string& body, OsmId object, OsmId building) {
    OverrideEntry entry;
    entry.object = object;
    entry.building = building;
    entry.line = table.line();
    model::Attributes attributes;
    attributes.roof_direction.emplace();
    attributes.ridge_direction.emplace();
    model::for_each_attribute(
        attributes,
        [&](std::string_view attribute, std::string_view, const auto& sourced) {
          if (auto v = value(table, attribute, sourced.value)) {
            v->line = table.line(attribute);
            entry.values.emplace(attribute, std::move(*v));
          }
        },
        [](std::string_view, std::string_view) {});
    if (const auto pitches = table.text("roof_pitches")) {
      const auto read = model::parse_side_pitches(*pitches);
      if (!read) table.fail("roof_pitches", read.error(), "Write roof_pitches = \"street 60, yard 30\".");
      entry.side_pitches = *read;
    }
    contradictions(table, entry);
    if (const auto imagery = table.text("imagery")) {
      if (*imagery != "off")
        table.fail("imagery", "is no order: '" + *imagery + "'",
                   "The only one is imagery = \"off\": no image moves it.");
      if (!(object == building))
        table.fail("imagery", "holds for whole buildings", "Write it below [" + building.text() + "].");
      entry.keeps_place = true;
    }
    details(table, body, entry);
    if (auto model = table.table("model")) {
      if (!(object == building))
        table.fail("model", "replaces whole buildings", "Write it below [" + building.text() + "].");
      entry.model = read_replacement(*model);
      for (const char* unread :
           {"preset", "height", "roof_shape", "roof_height", "roof_pitch", "roof_direction", "eaves_height"})
        if (entry.values.contains(unread))
          table.fail(unread, "is read by nothing: a model replaces the building", "Leave one of the two out.");
      if (entry.side_pitches.any())
        table.fail("roof_pitches", "is read by nothing: a model replaces the building", "Leave one of the two out.");
      if (!entry.details.empty())
        table.fail("model", "replaces the building: nothing reads orders for its storeys, edges and bays",
                   "Leave one of the two out.");
    }
    bool holds_parts = false;
    if (object == building)
      for (const std::string& key : table.keys())
        if (const auto part = parse_id(key); part && table.holds_table(key)) {
          holds_parts = true;
          this->entry(*table.table(key), body + "." + key, *part, building);
        }
    table.finish();
    if (entry.model && holds_parts)
      table.fail("model", "replaces the building: nothing reads orders for its parts", "Leave one of the two out.");
    const bool orders =
        !entry.values.empty() || entry.side_pitches.any() || !entry.details.empty() || entry.keeps_place || entry.model;
    if (!orders && !holds_parts) table.fail("", "[" + body + "] orders nothing", "Leave it out.");
    if (orders) out_.entries.push_back(std::move(entry));
  }

  OverrideModel read_replacement(TomlTable& table) const {
    OverrideModel out;
    out.line = table.line();
    const auto needed = [&](const char* key, const char* remedy) {
      const std::string text = table.text(key).value_or("");
      if (text.empty()) table.fail(key, "is missing", remedy);
      return text;
    };
    out.file = needed("file", "Name a .glb, .gltf, CityGML or CityJSON file beside the overrides.");
    out.source = needed("source", "Say where the model comes from.");
    out.licence = needed("licence", "Say under which licence it may be used, for example \"CC BY 4.0\".");
    out.author = table.text("author").value_or("");
    out.path = path_beside(out_.file, out.file);
    std::error_code none;
    if (!std::filesystem::is_regular_file(out.path, none))
      table.fail("file", "is not there: " + out.path, "Paths are seen from the folder of the overrides.");
    out.sha256 = base::sha256_file(out.path);
    if (const auto at = table.numbers("at")) {
      if (at->size() != 2 || std::abs((*at)[0]) > 180 || std::abs((*at)[1]) > 90)
        table.fail("at", "is no place", "Write at = [longitude, latitude], in degrees.");
      out.at = {(*at)[0], (*at)[1]};
    }
    out.turn = table.number("turn", -360, 360).value_or(0);
    out.scale = table.number("scale", 1e-4, 1e4).value_or(1);
    out.lift = table.number("lift", -100, 1000).value_or(0);
    table.finish();
    return out;
  }

  std::optional<OverrideValue> value(TomlTable& table, std::string_view key, double) {
    const auto range =
        std::find_if(std::begin(kRanges), std::end(kRanges), [&](const Range& r) { return r.attribute == key; });
    const bool known = range != std::end(kRanges);
    const auto v = table.number(key, known ? range->least : -1e6, known ? range->most : 1e6);
    return v ? std::optional(OverrideValue{*v}) : std::nullopt;
  }
  std::optional<OverrideValue> value(TomlTable& table, std::string_view key, model::RoofShape) {
    const auto v = table.text(key);
    if (!v) return std::nullopt;
    check_name(table, key, *v,
               std::vector<std::string>(std::begin(model::kRoofShapeNames), std::end(model::kRoofShapeNames)));
    return OverrideValue{*model::roof_shape(*v)};
  }
  std::optional<OverrideValue> value(TomlTable& table, std::string_view key, model::RoofOrientation) {
    const auto v = table.text(key);
    if (!v) return std::nullopt;
    check_name(table, key, *v, std::vector<std::string>{"along", "across"});
    return OverrideValue{*v == "across" ? model::RoofOrientation::across : model::RoofOrientation::along};
  }
  std::optional<OverrideValue> value(TomlTable& table, std::string_view key, model::Colour) {
    const auto v = table.text(key);
    if (!v) return std::nullopt;
    const auto colour = model::colour_of_hex(*v);
    if (!colour) table.fail(key, "is no colour: '" + *v + "'", "Write it as \"#rrggbb\".");
    return OverrideValue{*colour};
  }
  std::optional<OverrideValue> value(TomlTable& table, std::string_view key, const std::string&) {
    auto v = table.text(key);
    if (!v) return std::nullopt;
    if (key == "wall_material" || key == "roof_material") {
      const int index = defaults_.material(*v);
      if (index < 0) unknown(table, key, *v, materials_);
      v = defaults_.materials[static_cast<std::size_t>(index)].material_class.name;
    } else if (key == "era") {
      check_name(table, key, *v, model::kEraNames);
    } else if (key == "style") {
      check_name(table, key, *v, model::kStyleClassNames);
    } else if (key == "substyle") {
      check_name(table, key, *v, names_.substyles);
    } else if (key == "preset") {
      check_name(table, key, *v, names_.presets);
    } else if (key == "construction_date") {
      if (!parse_years(*v)) table.fail(key, "is no year: '" + *v + "'", "Write \"1895\" or \"1895..1902\".");
    } else {
      check_word(table, key, *v);
    }
    return OverrideValue{*v};
  }

  /// Orders that cannot all be met.
  static void contradictions(const TomlTable& table, const OverrideEntry& e) {
    const auto has = [&](const char* key) { return e.values.contains(key); };
    const auto clash = [&](const char* a, const char* b, const char* remedy) {
      if (has(a) && has(b)) table.fail(b, std::string("contradicts ") + a + ": one follows from the other", remedy);
    };
    clash("height", "storey_height", "Order height and storeys; the storey height follows.");
    clash("roof_height", "roof_pitch", "Order one of them.");
    clash("roof_orientation", "ridge_direction", "Order one of them.");
    clash("roof_direction", "ridge_direction", "Order one of them.");
    clash("roof_direction", "roof_orientation", "Order one of them.");
    if (const double* eaves = e.number("eaves_height")) {
      const double *height = e.number("height"), *roof = e.number("roof_height");
      if (!height == !roof)
        table.fail("eaves_height", "needs either height or roof_height beside it",
                   "The height is that of the eaves and the roof together.");
      if (height && *height < *eaves)
        table.fail("eaves_height", "is above the height", "The height is that of the eaves and the roof together.");
      if (const double* lowest = e.number("min_height"); lowest && *lowest > *eaves)
        table.fail("min_height", "is above the eaves", "Both are measured from the ground.");
      if (has("storey_height"))
        table.fail("storey_height", "contradicts eaves_height: one follows from the other",
                   "Order eaves_height and storeys.");
    }
    const double *height = e.number("height"), *roof = e.number("roof_height"), *under = e.number("min_height");
    if (height && roof && *roof > *height)
      table.fail("roof_height", "is above the height", "The height includes the roof.");
    if (height && under && *under >= *height)
      table.fail("min_height", "is not below the height", "The height is measured from the ground.");
    const auto shape = e.values.find("roof_shape");
    const bool flat =
        shape != e.values.end() && std::get<model::RoofShape>(shape->second.value) == model::RoofShape::flat;
    const double* pitch = e.number("roof_pitch");
    if (flat && roof && *roof > 0)
      table.fail("roof_height", "contradicts roof_shape: a flat roof has none", "Leave it out.");
    if (flat && e.side_pitches.any())
      table.fail("roof_pitches", "contradicts roof_shape: a flat roof has none", "Leave it out.");
    if (flat && pitch && *pitch > 0)
      table.fail("roof_pitch", "contradicts roof_shape: a flat roof has none", "Leave it out.");
    const double *eaves = e.number("eaves_height"), *storeys = e.number("storeys");
    if (flat && eaves && height && std::fabs(*eaves - *height) > 0.01)
      table.fail("eaves_height", "contradicts roof_shape: the eaves of a flat roof lie at the height", "Leave it out.");
    if (height && roof && under && *roof > *height - *under)
      table.fail("roof_height", "is more than height less min_height",
                 "The roof lies between the underside and the top.");
    if (!storeys || *storeys <= 0 || (!height && !eaves)) return;
    // Above the walls a roof of unknown height only makes storeys lower.
    const double top = height ? *height : *eaves + *roof;
    const double roof_part = eaves ? top - *eaves : roof ? *roof : 0;
    const double each = inhabited(top, roof_part) / *storeys;
    if (each < kLowStorey || (each > kHighStorey && (flat || roof || eaves)))
      table.fail(
          "storeys",
          fmt::format("contradicts {}: storeys would be {:.2f} m high", height ? "height" : "eaves_height", each),
          fmt::format("Storeys are {:g} to {:g} m high.", kLowStorey, kHighStorey));
  }

  void details(TomlTable& table, const std::string& body, OverrideEntry& entry) {
    for (const model::DetailKind kind : {model::DetailKind::storey, model::DetailKind::edge, model::DetailKind::bay}) {
      auto all = table.table(model::name(kind));
      if (!all) continue;
      for (const std::string& key : all->keys()) {
        if (kind == model::DetailKind::edge
                ? !key.starts_with('e') || key.find('_') == std::string::npos
                : key.empty() || key.size() > 3 || key.find_first_not_of("0123456789") != std::string::npos)
          all->fail(key, kind == model::DetailKind::edge ? "is no id of an edge" : "is no number",
                    kind == model::DetailKind::edge ? "Write it as 'blockrand explain --edges' does: edge.\"e11_12\"."
                                                    : "Storey 0 is the ground floor.");
        entry.details.push_back(detail(*all->table(key), body, kind, key));
      }
      all->finish();
    }
  }

  model::DetailOverride detail(TomlTable table, const std::string& body, model::DetailKind kind,
                               const std::string& key) {
    model::DetailOverride d{body, kind, key, {}, out_.name + ":" + std::to_string(table.line())};
    const auto number = [&](const char* name, double least, double most) {
      if (const auto v = table.number(name, least, most)) d.values.emplace_back(name, *table.plain(name));
    };
    const auto text = [&](const char* name, auto check) {
      if (const auto v = table.text(name)) {
        check(*v);
        d.values.emplace_back(name, *v);
      }
    };
    const auto material = [&](const std::string& v) {
      if (defaults_.material(v) < 0) unknown(table, "material", v, materials_);
    };
    const auto colour = [&](const std::string& v) {
      if (!model::colour_of_hex(v)) table.fail("colour", "is no colour: '" + v + "'", "Write it as \"#rrggbb\".");
    };
    text("colour", colour);
    text("material", material);
    if (kind == model::DetailKind::storey) {
      number("height", 1.5, 20);
      text("use", [&](const std::string& v) { check_word(table, "use", v); });
    } else if (kind == model::DetailKind::edge) {
      text("kind", [&](const std::string& v) {
        std::vector<std::string> kinds;
        for (int i = 1; i < model::kWallSegmentKindCount; ++i)
          kinds.emplace_back(model::name(static_cast<model::WallSegmentKind>(i)));
        check_name(table, "kind", v, kinds);
      });
      number("wall_thickness", 0.05, 3);
    } else {
      number("width", 0.3, 50);
    }
    // What a preset's grammar calls its own stays unchecked here: it is checked where the grammar is known.
    if (auto parameters = table.table("parameters"))
      for (const std::string& name : parameters->keys())
        d.values.emplace_back("parameters." + name, *parameters->plain(name));
    table.finish();
    if (d.values.empty()) table.fail("", "orders nothing", "Leave it out.");
    std::sort(d.values.begin(), d.values.end());
    return d;
  }

  const Defaults& defaults_;
  const OverrideNames& names_;
  std::vector<std::string> materials_;
  Overrides out_;
};

}  // namespace

std::vector<std::string> models_of(const std::string& overrides) {
  std::vector<std::string> out;
  std::error_code none;
  if (overrides.empty() || !std::filesystem::is_regular_file(overrides, none)) return out;
  try {
    TomlTable root = TomlTable::read(overrides);
    for (const std::string& key : root.keys()) {
      if (!root.holds_table(key)) continue;
      TomlTable entry = *root.table(key);
      if (!entry.holds_table("model")) continue;
      const std::string path = path_beside(overrides, entry.table("model")->text("file").value_or(""));
      if (std::filesystem::is_regular_file(path, none)) out.push_back(path);
    }
  } catch (const base::InputError&) {
    out.clear();
  }
  return out;
}

const double* OverrideEntry::number(const std::string& attribute) const {
  const auto found = values.find(attribute);
  return found == values.end() ? nullptr : std::get_if<double>(&found->second.value);
}

const std::string* OverrideEntry::text(const std::string& attribute) const {
  const auto found = values.find(attribute);
  return found == values.end() ? nullptr : std::get_if<std::string>(&found->second.value);
}

const OverrideEntry* Overrides::find(OsmId object) const {
  const auto found = std::lower_bound(entries.begin(), entries.end(), object,
                                      [](const OverrideEntry& e, OsmId id) { return e.object < id; });
  return found != entries.end() && found->object == object ? &*found : nullptr;
}

std::optional<model::YearRange> parse_years(std::string_view text) {
  model::YearRange years;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), years.from);
  if (error != std::errc()) return std::nullopt;
  years.to = years.from;
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (rest.starts_with("..")) {
    const auto [last, wrong] = std::from_chars(rest.data() + 2, rest.data() + rest.size(), years.to);
    if (wrong != std::errc() || last != rest.data() + rest.size()) return std::nullopt;
  } else if (!rest.empty()) {
    return std::nullopt;
  }
  if (years.from < 500 || years.to > 2100 || years.from > years.to) return std::nullopt;
  return years;
}

Overrides read_overrides(const std::string& path, const Defaults& defaults, const OverrideNames& names) {
  TomlTable root = TomlTable::read(path);
  return Reader(path, defaults, names).read(std::move(root));
}

}  // namespace blockrand::attributes
