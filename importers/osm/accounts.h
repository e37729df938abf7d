// One account per building object: where its outline comes from and in which state it ends. Internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "importers/osm/area_assembly.h"
#include "importers/osm/raw_data.h"
#include "pipeline/model/extract.h"

namespace blockrand::importers::osm {

struct Account {
  model::OsmId id;
  model::ObjectKind kind = model::ObjectKind::building;
  model::ObjectState state = model::ObjectState::pending;
  model::IssueCode code = model::IssueCode::none;
  model::OsmId related;
  model::OsmId geometry_from;
  const RawObject* raw = nullptr;
  const RawObject* tags_also_from = nullptr;  ///< the outer way whose tags fill the gaps of its relation's
  std::int32_t area = -1;                     ///< into Accounts::areas; -1 for a way's own outline
};

struct Accounts {
  std::vector<Account> list;  ///< sorted by id; one per node, way and relation with building or building:part
  std::vector<Area> areas;
  std::vector<model::BuildingRelation> building_relations;
  std::map<model::OsmId, std::string> details;  ///< of reported objects, where there is something to say
  std::vector<model::ReportRow> notices;
  std::uint64_t old_style_multipolygons = 0;

  const Account* find(model::OsmId id) const;
  Account* find(model::OsmId id) { return const_cast<Account*>(static_cast<const Accounts*>(this)->find(id)); }
};

/// Decides the state of every building object (ARCHITECTURE.md, law 1). The rules, in the order in which they are
/// applied:
///
/// 1. A node is NODE_ONLY; a way stands for itself when it closes, by node id or by position.
/// 2. A multipolygon (or boundary) relation with building tags is an area. An outer way of it with building tags of the
///    same kind is its duplicate ("a multipolygon and its outer way are one"); the way's tags that the relation lacks
///    are added to the relation's when it is the only outer way, and VALUES_CONFLICT is noted where both have a height
///    or number of storeys and differ. An inner way with building tags is a building of its own. Of two relations that
///    share an outer way the one with the lower id has it.
/// 3. A multipolygon without building tags whose outer ways have them is old-style: the way is the object, the relation
///    gives its rings (`geometry_from`). Each outer ring belongs to its tagged way of the lowest id, the other ways on
///    the ring are duplicates; rings whose ways have the same tags are one object, that of the lowest id; an outer ring
///    without any tagged way goes to the first object. Other tags on the relation (name, address, tourism …) do not
///    matter: they describe something else than the building.
/// 4. A relation of any other type but `building` is an area when its members with role outer, inner or outline form
/// one
///    (without a type: any role); otherwise RELATION_TYPE.
/// 5. LIFECYCLE: building=construction, proposed, planned, demolished, razed, destroyed, removed, dismantled,
/// collapsed.
///    Ruins and abandoned buildings still stand. UNDERGROUND: location=underground or underwater; below layer 0 in a
///    tunnel=yes; at layer -2 or deeper without a height or storey of its own (many stand at -1 beneath a bridge);
///    never roofs and bridges.
/// 6. Two objects of the same kind with the same rings (any start, either direction) are one: the one with more tags
///    stays, then the one with the lower id.
/// 7. A type=building relation with building tags is represented by its outline, else by its parts; where the outline
/// has
///    no building tags of its own, the relation is the building and has the outline's rings.
Accounts open_accounts(const RawData& data);

/// Whether two objects have the same tags, remarks (source, note, created_by …) aside.
bool same_tags(const RawData& data, const RawObject& a, const RawObject& b);

/// For each line the ring of `area` that it runs along, or -1.
std::vector<int> rings_along(const Area& area, const std::vector<WayLine>& lines);

}  // namespace blockrand::importers::osm
