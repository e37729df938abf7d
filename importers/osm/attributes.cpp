#include "importers/osm/attributes.h"

#include <initializer_list>
#include <string>

#include "importers/osm/construction_date.h"
#include "importers/osm/tag_values.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::importers::osm {
namespace {

namespace osm_key = model::osm_key;
using model::IssueCode;
using Tags = std::span<const std::pair<std::string_view, std::string_view>>;
using Keys = std::initializer_list<std::string_view>;

class AttributeReader {
 public:
  AttributeReader(model::OsmId id, Tags tags, model::Report& report) : id_(id), tags_(tags), report_(report) {}

  std::string_view value(std::string_view key) const {
    for (const auto& [k, v] : tags_)
      if (k == key) return v;
    return {};
  }

  /// The first of `keys` that `parse` can read and that lies in [low, high], or (low, high] when `open_below`.
  template <class Parse>
  std::optional<float> number(Keys keys, double low, double high, bool open_below, Parse parse) {
    for (const std::string_view key : keys) {
      const std::string_view text = value(key);
      if (text.empty()) continue;
      const std::optional<double> read = parse(text);
      if (!read) {
        note(IssueCode::value_unreadable, key, text);
      } else if (*read > high || *read < low || (open_below && *read <= low)) {
        note(IssueCode::value_clamped, key, text);
      } else {
        return static_cast<float>(*read);
      }
    }
    return std::nullopt;
  }

  template <class Parse>
  auto first(Keys keys, Parse parse) -> decltype(parse(std::string_view())) {
    for (const std::string_view key : keys) {
      const std::string_view text = value(key);
      if (text.empty()) continue;
      if (const auto read = parse(text)) return read;
      note(IssueCode::value_unreadable, key, text);
    }
    return std::nullopt;
  }

  std::string_view first_text(Keys keys) const {
    for (const std::string_view key : keys)
      if (const std::string_view text = value(key); !text.empty()) return text;
    return {};
  }

 private:
  void note(IssueCode code, std::string_view key, std::string_view text) {
    report_.add(id_, code, std::string(key) + "=" + std::string(text));
  }

  model::OsmId id_;
  Tags tags_;
  model::Report& report_;
};

/// Tags by which somebody orders something of this program, and which nothing reads.
void tell_unknown_orders(model::OsmId id, model::ObjectKind kind, Tags tags, model::Report& report) {
  constexpr std::string_view kOurs = "blockrand:";
  for (const auto& [key, value] : tags) {
    if (!key.starts_with(kOurs) || key == osm_key::kPreset || key == osm_key::kRoofPitches) continue;
    const bool style = key == osm_key::kStyle;
    if (style && kind == model::ObjectKind::building) continue;
    report.add(id, IssueCode::parameter_unread,
               std::string(key) + "=" + std::string(value) + ": " +
                   (style ? "a part has the style of its building" : "nothing reads such a tag"));
  }
}

bool any_key_of_the_scheme(Tags tags) {
  for (const auto& [k, v] : tags)
    if (k.starts_with("building:") || k.starts_with("roof:") || k.ends_with("height") || k.ends_with("level") ||
        k == osm_key::kLevels || k == osm_key::kLayer || k == osm_key::kRoofPitches || k.starts_with("facade:") ||
        k == osm_key::kStartDate || k == osm_key::kConstructionDate || k == osm_key::kYearOfConstruction)
      return true;
  return false;
}

/// `start_date` of an object that is a business as well may be the day it opened.
bool is_a_business_too(const AttributeReader& read) {
  for (const std::string_view key : {osm_key::kShop, osm_key::kAmenity, osm_key::kOffice, osm_key::kCraft})
    if (const std::string_view value = read.value(key); !value.empty() && value != "no") return true;
  const std::string_view tourism = read.value(osm_key::kTourism);
  return tourism == "hotel" || tourism == "museum";
}

std::optional<model::ConstructionDate> read_construction_date(AttributeReader& read) {
  const auto of_the_building = read.first({osm_key::kBuildingStartDate, osm_key::kBuildingYearOfConstruction,
                                           osm_key::kYearOfConstruction, osm_key::kConstructionDate},
                                          parse_construction_date);
  if (of_the_building) return of_the_building;
  auto date = read.first({osm_key::kStartDate}, parse_construction_date);
  if (date && is_a_business_too(read)) date->confidence /= 2;
  return date;
}

model::SidePitches read_side_pitches(const AttributeReader& read, model::OsmId id, model::Report& report) {
  const std::string_view text = read.value(osm_key::kRoofPitches);
  if (text.empty()) return {};
  const auto pitches = model::parse_side_pitches(text);
  if (pitches) return *pitches;
  report.add(id, IssueCode::value_unreadable,
             std::string(osm_key::kRoofPitches) + "=" + std::string(text) + ": " + pitches.error());
  return {};
}

}  // namespace

model::MappedAttributes read_attributes(model::OsmId id, model::ObjectKind kind, Tags tags, base::StringPool& strings,
                                        model::Report& report) {
  model::MappedAttributes a;
  AttributeReader read(id, tags, report);
  a.use = strings.intern(read.value(kind == model::ObjectKind::building ? osm_key::kBuilding : osm_key::kBuildingPart));
  tell_unknown_orders(id, kind, tags, report);
  if (!any_key_of_the_scheme(tags)) return a;  // four of five buildings

  const auto length = [](std::string_view t) { return parse_length(t); };
  const auto lowest_length = [](std::string_view t) { return parse_length(t, Pick::lowest); };
  const auto storeys = [](std::string_view t) { return parse_storeys(t); };
  const auto lowest_storey = [](std::string_view t) { return parse_storeys(t, Pick::lowest); };
  a.height = read.number({osm_key::kHeight, osm_key::kBuildingHeight, osm_key::kEstHeight}, 0, 1000, true, length);
  a.min_height = read.number({osm_key::kMinHeight, osm_key::kBuildingMinHeight}, 0, 1000, false, lowest_length);
  a.storeys = read.number({osm_key::kBuildingLevels, osm_key::kLevels}, 0, 200, false, storeys);
  a.min_storey = read.number({osm_key::kBuildingMinLevel, osm_key::kMinLevel}, 0, 200, false, lowest_storey);
  a.layer = read.number({osm_key::kLayer}, -20, 20, false, lowest_storey);
  a.roof_storeys = read.number({osm_key::kRoofLevels, osm_key::kBuildingRoofLevels}, 0, 20, false, storeys);
  a.storeys_underground = read.number({osm_key::kBuildingLevelsUnderground}, 0, 50, false, storeys);
  a.roof_height = read.number({osm_key::kRoofHeight, osm_key::kBuildingRoofHeight}, 0, 300, false, length);
  a.roof_angle = read.number({osm_key::kRoofAngle, osm_key::kBuildingRoofAngle}, 0, 89.9, false, parse_angle);
  a.roof_direction =
      read.number({osm_key::kRoofDirection, osm_key::kRoofSlopeDirection}, 0, 360, false, parse_direction);
  a.side_pitches = read_side_pitches(read, id, report);
  a.roof_orientation =
      read.first({osm_key::kRoofOrientation, osm_key::kBuildingRoofOrientation}, parse_roof_orientation);
  a.roof_shape = read.first({osm_key::kRoofShape, osm_key::kBuildingRoofShape}, parse_roof_shape);
  if (!a.roof_shape) {
    // building:roof holds shapes, materials or nothing of the kind; only a shape is meant for us.
    const auto shape = parse_roof_shape(read.value(osm_key::kBuildingRoof));
    if (shape && *shape != model::RoofShape::other) a.roof_shape = shape;
  }
  const auto colour = [&](std::initializer_list<std::string_view> keys, std::optional<model::Colour>& value,
                          bool& word) {
    value = read.first(keys, [&](std::string_view text) {
      word = is_colour_word(text);
      return parse_colour(text);
    });
  };
  colour({osm_key::kBuildingColour, osm_key::kBuildingColor, osm_key::kBuildingFacadeColour, osm_key::kFacadeColour},
         a.wall_colour, a.wall_colour_is_word);
  colour({osm_key::kRoofColour, osm_key::kRoofColor, osm_key::kBuildingRoofColour}, a.roof_colour,
         a.roof_colour_is_word);
  a.wall_material = strings.intern(
      read.first_text({osm_key::kBuildingMaterial, osm_key::kBuildingFacadeMaterial, osm_key::kFacadeMaterial}));
  a.roof_material = strings.intern(read.first_text({osm_key::kRoofMaterial, osm_key::kBuildingRoofMaterial}));
  a.built = read_construction_date(read);
  return a;
}

}  // namespace blockrand::importers::osm
