#include "importers/osm/interest.h"

#include "pipeline/model/extract.h"

namespace blockrand::importers::osm {
namespace {

template <class... Words>
bool is_any_of(std::string_view text, Words... words) {
  return ((text == words) || ...);
}

constexpr std::uint32_t bit(model::FeatureKind kind) { return static_cast<std::uint32_t>(kind); }

}  // namespace

void Interest::add(model::OsmType type, std::string_view key, std::string_view value) {
  using enum model::FeatureKind;
  if (key.empty() || value == "no") {
    if (key == "area") area_no = true;
    return;
  }
  const bool node = type == model::OsmType::node;
  switch (key.front()) {
    case 'a':
      if (key == "area") {
        area_yes = area_yes || value == "yes";
      } else if (key == "amenity") {
        kinds |= bit(amenity);
        area_by_tag = true;
      } else if (key.starts_with("addr:")) {
        kinds |= bit(address);
        if (key == "addr:interpolation")
          line_by_tag = true;
        else
          area_by_tag = true;
      }
      break;
    case 'b':
      if (key == "building") {
        building = true;
        if (value == "entrance") kinds |= bit(entrance);
      } else if (key == "building:part") {
        building_part = true;
      } else if (key == "barrier" && !node &&
                 is_any_of(value, "wall", "fence", "retaining_wall", "city_wall", "hedge")) {
        kinds |= bit(barrier);
        line_by_tag = true;
      } else if (key == "boundary" && !node) {
        kinds |= bit(boundary);
        area_by_tag = true;
      }
      break;
    case 'c':
      if (key == "covered") covered_way = true;
      break;
    case 'd':
      if (key == "door") kinds |= bit(entrance);
      break;
    case 'e':
      if (key == "entrance") kinds |= bit(entrance);
      break;
    case 'h':
      if (key == "highway" && !node) {
        kinds |= bit(street);
        line_by_tag = true;
      }
      break;
    case 'l':
      if (node) break;
      if (key == "landuse") {
        kinds |= bit(land_use);
        if (is_any_of(value, "reservoir", "basin")) kinds |= bit(water);
        area_by_tag = true;
      } else if (key == "leisure") {
        kinds |= bit(land_use);
        if (is_any_of(value, "track", "slipway"))
          line_by_tag = true;
        else
          area_by_tag = true;
      }
      break;
    case 'n':
      if (key == "natural") {
        if (is_any_of(value, "tree", "tree_row")) {
          kinds |= bit(tree);
          line_by_tag = true;
        } else if (node) {
          break;
        } else if (is_any_of(value, "water", "coastline")) {
          kinds |= bit(water);
          (value == "water" ? area_by_tag : line_by_tag) = true;
        } else {
          kinds |= bit(land_use);
          (is_any_of(value, "cliff", "ridge", "arete", "valley", "earth_bank", "gully") ? line_by_tag : area_by_tag) =
              true;
        }
      }
      break;
    case 'p':
      if (key == "place") {
        kinds |= bit(place);
        area_by_tag = true;
      }
      break;
    case 'r':
      if (key == "railway" && !node) {
        kinds |= bit(railway);
        (is_any_of(value, "station", "platform", "turntable", "traverser", "roundhouse", "yard") ? area_by_tag
                                                                                                 : line_by_tag) = true;
      } else if (key == "roof:ridge" || key == "roof:edge") {
        kinds |= bit(roof_line);
        line_by_tag = true;
      } else if (key == "roof:apex") {
        kinds |= bit(roof_apex);
      }
      break;
    case 's':
      if (key == "shop") {
        kinds |= bit(shop);
        area_by_tag = true;
      }
      break;
    case 't':
      if (key == "tunnel" && value == "building_passage") covered_way = true;
      break;
    case 'w':
      if (key == "waterway" && !node) {
        kinds |= bit(water);
        (is_any_of(value, "riverbank", "dock", "boatyard") ? area_by_tag : line_by_tag) = true;
      }
      break;
    default:
      break;
  }
}

void Interest::finish(model::OsmType type) {
  using enum model::FeatureKind;
  if (covered_way && type == model::OsmType::way && (kinds & (bit(street) | bit(railway))) != 0) kinds |= bit(passage);
}

bool is_remark(std::string_view key) {
  return is_any_of(key, "type", "created_by", "source", "note", "fixme", "FIXME", "comment", "attribution", "odbl",
                   "area") ||
         key.starts_with("source:") || key.starts_with("note:") || key.starts_with("test:");
}

}  // namespace blockrand::importers::osm
