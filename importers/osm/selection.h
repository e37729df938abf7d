// Which objects of a file are kept: the one rule for all who read files.
#pragma once

#include <optional>
#include <osmium/osm/location.hpp>
#include <osmium/osm/object.hpp>
#include <osmium/osm/relation.hpp>

#include "importers/osm/interest.h"
#include "importers/osm/raw_data.h"

namespace blockrand::importers::osm {

/// \throws NulInText
/// \param surroundings  as Interest has it
Interest interest_of(model::OsmType type, const osmium::OSMObject& object, bool surroundings = false);

/// Whether a relation is kept, and as what; its member ways are, too. \throws NulInText
std::optional<RelationType> kept_as(const osmium::Relation& relation, const Interest& interest);

/// kInvalid for one outside of the globe, or none.
inline model::Location position_of(osmium::Location l) { return l.valid() ? model::Location{l.x(), l.y()} : kInvalid; }

/// Whether a way or a node is kept for its own sake.
inline bool is_kept(const Interest& interest) { return interest.kinds != 0 || interest.is_building(); }

}  // namespace blockrand::importers::osm
