#include "importers/osm/selection.h"

#include "importers/osm/osm_file.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::importers::osm {
namespace {

RelationType relation_type_of(std::string_view text) {
  if (text.empty()) return RelationType::none;
  if (text == "multipolygon") return RelationType::multipolygon;
  if (text == "boundary") return RelationType::boundary;
  if (text == "building") return RelationType::building;
  return RelationType::other;
}

}  // namespace

Interest interest_of(model::OsmType type, const osmium::OSMObject& object, bool surroundings) {
  Interest interest;
  interest.surroundings = surroundings;
  for_each_tag(object, [&](std::string_view key, std::string_view value) { interest.add(type, key, value); });
  interest.finish(type);
  return interest;
}

std::optional<RelationType> kept_as(const osmium::Relation& relation, const Interest& interest) {
  RelationType type = RelationType::none;
  for_each_tag(relation, [&](std::string_view key, std::string_view value) {
    if (key == model::osm_key::kType) type = relation_type_of(value);
  });
  const bool wanted = interest.is_building() || type == RelationType::multipolygon || type == RelationType::building ||
                      (type == RelationType::boundary && interest.kinds != 0);
  return wanted ? std::optional(type) : std::nullopt;
}

}  // namespace blockrand::importers::osm
