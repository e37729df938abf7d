#include "pipeline/outputs/gltf/people_table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using Kind = PropertyTable::Kind;

constexpr double kAbsentNumber = -99999;

/// An attribute of model::for_each_attribute that people look for.
struct Shown {
  std::string_view attribute;
  std::string_view about;
};

// In the order of the columns; what is no attribute stands between them (Builder's constructor).
constexpr Shown kUse[] = {{"use", "What it is used for"}, {"ground_floor_use", "What the ground floor is used for"}};
constexpr Shown kTime[] = {{"construction_date", "Year of construction, or from..to"},
                           {"era", "When it was built: pre1840, 1840_1918, 1919_1945, post1945"},
                           {"style", "Class of appearance: gruenderzeit, tenement, modern, other"}};
constexpr Shown kStyleAndHeights[] = {{"substyle", "Its style in more detail"},
                                      {"storeys", "Full storeys above ground"},
                                      {"roof_storeys", "Storeys inside the roof"},
                                      {"height", "From the lowest ground to the top of the roof"},
                                      {"eaves_height", "From the lowest ground to the eaves"}};
constexpr Shown kRoof[] = {{"roof_height", "From the eaves to the top of the roof"},
                           {"roof_pitch", "Of the main slope"},
                           {"roof_material", "Material of the roof"},
                           {"roof_colour", "Colour of the roof in sRGB"},
                           {"wall_material", "Material of the walls"},
                           {"wall_colour", "Colour of the walls in sRGB"}};
/// Its value stands in the column `built_roof`.
constexpr std::string_view kRoofShape = "roof_shape";

struct NumberKind {
  template <class T>
  bool operator()(const T&) const {
    return std::is_same_v<T, double>;
  }
};

/// What a number is rounded to, by its unit.
double steps_per_unit(std::string_view unit) { return unit == "degree" ? 1 : 10; }

std::string rounding_text(std::string_view unit) {
  return unit == "degree" ? ", degree, to 1" : unit.empty() ? ", to 0.1" : ", " + std::string(unit) + ", to 0.1";
}

class Builder {
 public:
  Builder(const model::Region& region, bool evidence) : region_(region), tags_(region.extract), evidence_(evidence) {
    model::Attributes all;
    // The visitor needs a value of every type, absent ones included.
    all.roof_direction.emplace();
    all.ridge_direction.emplace();
    std::map<std::string_view, std::size_t> places;
    model::for_each_attribute(
        all,
        [&](std::string_view name, std::string_view unit, const auto& sourced) {
          places.emplace(name, attributes_.size());
          attributes_.push_back({.name = name, .unit = unit, .number = NumberKind()(sourced.value)});
        },
        [](std::string_view, std::string_view) {});
    const auto add_all = [&](std::span<const Shown> shown) {
      for (const Shown& s : shown) add(attributes_.at(places.at(s.attribute)), s.about);
    };
    address_ = text("address", "Address in one line");
    name_ = text("name", "Name as mapped");
    add_all(kUse);
    add_all(kTime);
    style_confidence_ = table_.add({.name = "style_confidence",
                                    .kind = Kind::float64,
                                    .description = "How sure the style is, from 0 to 1",
                                    .no_data = kAbsentNumber});
    add_all(kStyleAndHeights);
    built_roof_ = table_.add({.name = "built_roof",
                              .kind = Kind::enumeration,
                              .description = "The roof that stands",
                              .enum_type = "RoofShape",
                              .required = true});
    attributes_.at(places.at(kRoofShape)).told = true;
    add_all(kRoof);
    sources_ = text("sources", "Where the values come from: source: columns; tag is mapped, default is a guess");
    fallbacks_ = text("fallbacks", "Codes of what was built simpler than asked");
    const auto is_open = [](const model::BuildingPart& p) { return !p.lod2.closed || !p.lod3.solid.closed; };
    if (std::ranges::any_of(region.buildings,
                            [&](const model::Building& b) { return b.owned && std::ranges::any_of(b.parts, is_open); }))
      open_surfaces_ = text("open_surfaces", "yes: its surfaces need not bound a volume; made by rules, or a model");
    if (std::ranges::any_of(region.buildings, [](const model::Building& b) { return b.owned && b.replaced; }))
      replaced_by_ = text("replaced_by", "The model that stands for the building: file, author, licence, source");
    if (evidence_) evidence_column_ = text("evidence", "JSON object: why each attribute has its value");
    lod_ = table_.add({.name = "lod",
                       .kind = Kind::int8,
                       .description = "Highest level of detail built; -1: none",
                       .required = true});
    id_ = text("id", "Part id: stable from build to build", true);
    building_ = text("building", "Id of the building it belongs to", true);
  }

  PropertyTable build() && {
    for (const model::Building& building : region_.buildings) {
      if (!building.owned) continue;
      const std::string building_id = building.id();
      for (const model::BuildingPart& part : building.parts) row(building, building_id, part);
    }
    return std::move(table_);
  }

 private:
  struct Attribute {
    std::string_view name, unit;
    bool number = false;
    int column = -1;    ///< -1: none
    bool told = false;  ///< its source is told
  };

  int text(const char* name, const char* description, bool required = false) {
    return table_.add({.name = name, .kind = Kind::text, .description = description, .required = required});
  }

  void add(Attribute& attribute, std::string_view about) {
    PropertyTable::Column column{.name = std::string(attribute.name),
                                 .kind = attribute.number ? Kind::float64 : Kind::text,
                                 .description = std::string(about)};
    if (attribute.number) {
      column.description += rounding_text(attribute.unit);
      column.no_data = kAbsentNumber;
    }
    attribute.column = table_.add(std::move(column));
    attribute.told = true;
  }

  void set(const Attribute& a, double value) {
    const double steps = steps_per_unit(a.unit);
    table_.set_float64(a.column, std::nearbyint(value * steps) / steps);
  }
  void set(const Attribute& a, const std::string& value) { table_.set_text(a.column, value); }
  void set(const Attribute& a, model::Colour value) { table_.set_raw_text(a.column, model::text(value)); }
  // Roofs are told as built.
  void set(const Attribute&, model::RoofShape) { assert(false); }
  void set(const Attribute&, model::RoofOrientation) { assert(false); }

  static bool has_value(const std::string& value) { return !value.empty(); }
  static bool has_value(double value) { return std::isfinite(value); }
  template <class T>
  static bool has_value(const T&) {
    return true;
  }

  void row(const model::Building& building, const std::string& building_id, const model::BuildingPart& part) {
    table_.set_text(name_, tags_.name_of(building, part));
    if (const Address address = tags_.address_of(building, part); !address.empty())
      table_.set_text(address_, address.line());

    auto attribute = attributes_.begin();
    for (std::string& columns : columns_of_source_) columns.clear();
    std::string why;
    model::for_each_attribute(
        part.attributes,
        [&](std::string_view of, std::string_view, const auto& sourced) {
          const Attribute& a = *attribute++;
          if (a.column >= 0) set(a, sourced.value);
          if (a.told && has_value(sourced.value)) {
            std::string& columns = columns_of_source_[static_cast<std::size_t>(sourced.source)];
            if (!columns.empty()) columns += ", ";
            columns += of;
          }
          if (evidence_ && sourced.evidence != 0) {
            why += why.empty() ? '{' : ',';
            append_json(why, of);
            why += ':';
            append_json(why, region_.evidence[sourced.evidence].text);
          }
        },
        [&](std::string_view, std::string_view) { ++attribute; });
    if (!why.empty()) table_.set_raw_text(evidence_column_, why + '}');
    if (has_value(part.attributes.style.value))
      table_.set_float64(style_confidence_,
                         std::nearbyint(static_cast<double>(part.attributes.style.confidence) * 100) / 100);
    table_.set_raw_text(sources_, sources_text());

    table_.set_enum(built_roof_, static_cast<std::uint8_t>(part.built_roof));
    table_.set_int8(lod_, static_cast<std::int8_t>(part.lod));
    std::string codes;
    for (const model::IssueCode code : part.fallbacks) {
      if (!codes.empty()) codes += ' ';
      codes += model::info(code).text;
    }
    table_.set_raw_text(fallbacks_, codes);
    if (!part.lod2.closed || !part.lod3.solid.closed) table_.set_raw_text(open_surfaces_, "yes");
    if (building.replaced) table_.set_raw_text(replaced_by_, model::text(*building.replaced));
    table_.set_raw_text(id_, part.id);
    table_.set_raw_text(building_, building_id);
    table_.end_row();
  }

  std::string sources_text() const {
    std::string out;
    for (std::size_t i = 0; i < columns_of_source_.size(); ++i) {
      if (columns_of_source_[i].empty()) continue;
      if (!out.empty()) out += "; ";
      out += std::string(model::name(static_cast<model::Source>(i))) + ": " + columns_of_source_[i];
    }
    return out;
  }

  const model::Region& region_;
  TagReader tags_;
  bool evidence_;
  PropertyTable table_{PropertyTable::Order::as_added};
  std::vector<Attribute> attributes_;                               ///< as model::for_each_attribute visits them
  std::array<std::string, model::kSourceCount> columns_of_source_;  ///< of the row at hand
  int address_ = 0, name_ = 0, style_confidence_ = 0, built_roof_ = 0, sources_ = 0, fallbacks_ = 0, replaced_by_ = 0,
      open_surfaces_ = 0, evidence_column_ = 0, lod_ = 0, id_ = 0, building_ = 0;
};

}  // namespace

PropertyTable people_table(const model::Region& region, bool evidence) { return Builder(region, evidence).build(); }

}  // namespace blockrand::outputs
