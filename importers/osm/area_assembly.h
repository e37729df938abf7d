// Areas from ways and relations: rings as mapped, or what can be saved of them. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "importers/osm/raw_data.h"

namespace blockrand::importers::osm {

struct Vertex {
  std::int64_t node = 0;
  model::Location location;
};

struct AreaRing {
  std::vector<Vertex> vertices;  ///< without a repeated last vertex
  bool inner = false;            ///< belongs to the last outer ring before it
};

struct Area {
  std::vector<AreaRing> rings;  ///< empty when nothing could be built
  /// none: as mapped. members_missing or relation_repaired: rings were built all the same. Any other code (class
  /// `reported`): why there are no rings.
  model::IssueCode code = model::IssueCode::none;
  std::string detail;
  bool has_holes() const;
};

/// The nodes of a way that have a position.
struct WayLine {
  std::vector<Vertex> vertices;  ///< as mapped: a closed way repeats its first vertex
  bool closed = false;           ///< first and last node are one, or lie in one place
  std::size_t missing = 0;       ///< nodes not in the file
  std::size_t invalid = 0;       ///< nodes in the file without a usable position
};
WayLine locate(const RawData& data, const RawWay& way);

/// The area of a closed way: one ring, not checked for crossings (that is the repair stage's trade).
/// Codes: OPEN_WAY, TOO_FEW_POINTS, OUTLINE_INCOMPLETE, INVALID_LOCATION; MEMBERS_MISSING when three or more points are
/// left.
Area assemble_way(const RawData& data, const RawWay& way);

/// The area of a multipolygon's member ways, by libosmium's assembler, which decides from geometry alone which rings
/// are inner. Where it refuses or members are missing, the closed rings that the rest forms are built, by node ids,
/// then by positions; crossing rings stay as mapped with the roles of the members. Codes: RING_BROKEN, OUTLINE_INCOMPLETE,
/// INVALID_LOCATION; MEMBERS_MISSING and RELATION_REPAIRED with rings. \param roles_only  take only members with role
/// outer, inner or outline (relations of unknown type)
Area assemble_relation(const RawData& data, const RawRelation& relation, bool roles_only = false);

/// The area of these ways alone, in the role given.
Area assemble_members(const RawData& data, std::int64_t relation_id, const std::vector<RawMember>& members);

}  // namespace blockrand::importers::osm
