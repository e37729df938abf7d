#include "pipeline/outputs/gltf/building_table.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "pipeline/outputs/gltf/people_table.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using Kind = PropertyTable::Kind;

constexpr int kNone = 255;  // value of the enum entry "none" that stands for an absent value

/// Column numbers of one attribute; `source` and `confidence` follow `value`.
struct AttributeColumns {
  int value = 0, source = 0, confidence = 0;
};

struct KindOf {
  Kind operator()(double) const { return Kind::float64; }
  Kind operator()(const std::string&) const { return Kind::text; }
  Kind operator()(model::Colour) const { return Kind::text; }
  Kind operator()(model::RoofShape) const { return Kind::enumeration; }
  Kind operator()(model::RoofOrientation) const { return Kind::enumeration; }
};
const char* enum_of(model::RoofShape) { return "RoofShape"; }
const char* enum_of(model::RoofOrientation) { return "RoofOrientation"; }
template <class T>
const char* enum_of(const T&) {
  return "";
}

class Builder {
 public:
  Builder(const model::Region& region, bool evidence) : region_(region), tags_(region.extract), evidence_(evidence) {
    id_ = text("id", "Part id: stable from build to build", true);
    building_ = text("building", "Id of the building it belongs to", true);
    osm_type_ = add({.name = "osm_type", .kind = Kind::enumeration, .enum_type = "OsmType", .required = true});
    osm_id_ = add(
        {.name = "osm_id", .kind = Kind::int64, .description = "The object whose tags it carries", .required = true});
    name_ = text("name", "");
    address_ = text("address", "");
    // The visitor needs a value of every type, absent ones included.
    model::Attributes all;
    all.roof_direction.emplace();
    all.ridge_direction.emplace();
    const auto column = [&](std::string_view name, std::string_view unit, const auto& sourced) {
      const std::string base(name);
      const bool optional = name == "roof_direction" || name == "ridge_direction";
      const Kind kind = KindOf{}(sourced.value);
      AttributeColumns c;
      PropertyTable::Column value{.name = base,
                                  .kind = kind,
                                  .description = std::string(unit),
                                  .enum_type = enum_of(sourced.value),
                                  .required = !optional && kind != Kind::text};
      // A direction is never negative, so -1 can say that there is none; other numbers always have a value, or 0 when
      // something upstream left a NaN.
      if (optional) value.no_data = -1;
      value.required = value.required && kind == Kind::enumeration;
      if (kind == Kind::float64 && !optional) value.no_data = kAbsentNumber;
      c.value = add(std::move(value));
      c.source = add({.name = base + "_source",
                      .kind = Kind::enumeration,
                      .enum_type = "Source",
                      .required = !optional,
                      .no_data = kNone,
                      .no_data_name = optional ? "none" : ""});
      // Nobody is 0 % sure of a value that is there.
      c.confidence = add({.name = base + "_confidence",
                          .kind = Kind::unit_interval,
                          .no_data = optional ? std::optional<double>(0) : std::nullopt});
      attributes_.push_back(c);
    };
    model::for_each_attribute(all, column, [](std::string_view, std::string_view) {});
    built_roof_ = add({.name = "built_roof",
                       .kind = Kind::enumeration,
                       .description = "The roof that stands",
                       .enum_type = "RoofShape",
                       .required = true});
    lod_ = add({.name = "lod",
                .kind = Kind::int8,
                .description = "Highest level of detail built; -1: none",
                .required = true});
    fallbacks_ = text("fallbacks", "Codes of what was built simpler than asked");
    const auto is_open = [](const model::BuildingPart& p) { return !p.lod2.closed || !p.lod3.solid.closed; };
    if (std::ranges::any_of(region.buildings,
                            [&](const model::Building& b) { return b.owned && std::ranges::any_of(b.parts, is_open); }))
      open_surfaces_ = text("open_surfaces", "yes: its surfaces need not bound a volume; made by rules, or a model");
    if (std::ranges::any_of(region.buildings, [](const model::Building& b) { return b.owned && b.replaced; }))
      replaced_by_ = text("replaced_by", "The model that stands for the building: file, author, licence, source");
    tags_column_ = text("tags", "JSON object of the OSM tags");
    building_tags_ = text("building_tags", "The building's own tags, on its first part, where parts are mapped apart");
    if (evidence_) evidence_column_ = text("evidence", "JSON object: why each attribute has its value");
  }

  PropertyTable build() && {
    for (const model::Building& building : region_.buildings) {
      if (!building.owned) continue;
      const std::string building_id = building.id();
      bool first = true;
      for (const model::BuildingPart& part : building.parts) {
        row(building, building_id, part, first);
        first = false;
      }
    }
    return std::move(table_);
  }

 private:
  static constexpr double kAbsentNumber = -99999;

  int add(PropertyTable::Column column) { return table_.add(std::move(column)); }
  int text(const char* name, const char* description, bool required = false) {
    return add({.name = name, .kind = Kind::text, .description = description, .required = required});
  }

  void set(int column, double value) { table_.set_float64(column, value); }
  void set(int column, const std::string& value) { table_.set_text(column, value); }
  void set(int column, model::Colour value) { table_.set_raw_text(column, model::text(value)); }
  void set(int column, model::RoofShape value) { table_.set_enum(column, static_cast<std::uint8_t>(value)); }
  void set(int column, model::RoofOrientation value) { table_.set_enum(column, static_cast<std::uint8_t>(value)); }

  void row(const model::Building& building, const std::string& building_id, const model::BuildingPart& part,
           bool first) {
    table_.set_raw_text(id_, part.id);
    table_.set_raw_text(building_, building_id);
    table_.set_enum(osm_type_, static_cast<std::uint8_t>(part.osm.type));
    table_.set_int64(osm_id_, part.osm.number);
    table_.set_text(name_, tags_.name_of(building, part));
    if (const Address address = tags_.address_of(building, part); !address.empty())
      table_.set_text(address_, address.line());

    auto columns = attributes_.begin();
    scratch_.clear();
    model::for_each_attribute(
        part.attributes,
        [&](std::string_view attribute, std::string_view, const auto& sourced) {
          const AttributeColumns& c = *columns++;
          set(c.value, sourced.value);
          table_.set_enum(c.source, static_cast<std::uint8_t>(sourced.source));
          table_.set_unit_interval(c.confidence, static_cast<double>(sourced.confidence));
          if (evidence_ && sourced.evidence != 0) {
            scratch_ += scratch_.empty() ? '{' : ',';
            append_json(scratch_, attribute);
            scratch_ += ':';
            append_json(scratch_, region_.evidence[sourced.evidence].text);
          }
        },
        [&](std::string_view, std::string_view) { ++columns; });
    if (!scratch_.empty()) {
      scratch_ += '}';
      table_.set_raw_text(evidence_column_, scratch_);
    }

    table_.set_enum(built_roof_, static_cast<std::uint8_t>(part.built_roof));
    table_.set_int8(lod_, static_cast<std::int8_t>(part.lod));
    scratch_.clear();
    for (const model::IssueCode code : part.fallbacks) {
      if (!scratch_.empty()) scratch_ += ' ';
      scratch_ += model::info(code).text;
    }
    table_.set_raw_text(fallbacks_, scratch_);
    if (!part.lod2.closed || !part.lod3.solid.closed) table_.set_raw_text(open_surfaces_, "yes");
    if (building.replaced) table_.set_raw_text(replaced_by_, model::text(*building.replaced));
    set_tags(tags_column_, part.tags);
    if (first && part.osm != building.osm) set_tags(building_tags_, building.tags);
    table_.end_row();
  }

  void set_tags(int column, model::Range tags) {
    if (!region_.extract || tags.count == 0) return;
    scratch_.clear();
    append_tags_json(scratch_, *region_.extract, tags);
    table_.set_raw_text(column, scratch_);
  }

  const model::Region& region_;
  TagReader tags_;
  bool evidence_;
  PropertyTable table_{PropertyTable::Order::by_name};
  std::vector<AttributeColumns> attributes_;
  std::string scratch_;
  int id_ = 0, building_ = 0, osm_type_ = 0, osm_id_ = 0, name_ = 0, address_ = 0, built_roof_ = 0, lod_ = 0,
      fallbacks_ = 0, replaced_by_ = 0, open_surfaces_ = 0, tags_column_ = 0, building_tags_ = 0, evidence_column_ = 0;
};

nlohmann::json enumeration(std::vector<std::string_view> names, bool with_none) {
  nlohmann::json values = nlohmann::json::array();
  const auto add = [&](std::string_view name, int value) {
    nlohmann::json entry;
    entry.emplace("name", std::string(name));
    entry.emplace("value", value);
    values.push_back(std::move(entry));
  };
  for (std::size_t i = 0; i < names.size(); ++i) add(names[i], static_cast<int>(i));
  if (with_none) add("none", kNone);
  nlohmann::json object;
  object.emplace("valueType", std::string("UINT8"));
  object.emplace("values", std::move(values));
  return object;
}

}  // namespace

PropertyTable building_table(const model::Region& region, AttributeProfile profile, bool evidence) {
  return profile == AttributeProfile::people ? people_table(region, evidence) : Builder(region, evidence).build();
}

nlohmann::json building_enums() {
  std::vector<std::string_view> sources;
  for (int i = 0; i < model::kSourceCount; ++i) sources.push_back(model::name(static_cast<model::Source>(i)));
  nlohmann::json enums;
  enums.emplace("Source", enumeration(std::move(sources), true));
  enums.emplace("RoofShape",
                enumeration({std::begin(model::kRoofShapeNames), std::end(model::kRoofShapeNames)}, false));
  enums.emplace("RoofOrientation", enumeration({"along", "across"}, false));
  enums.emplace("OsmType", enumeration({"node", "way", "relation"}, false));
  return enums;
}

}  // namespace blockrand::outputs
