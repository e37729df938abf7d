// Everything kept that is no building: streets, land use, trees, addresses … Internal to this folder.
#pragma once

#include <functional>
#include <vector>

#include "importers/osm/accounts.h"
#include "importers/osm/raw_data.h"

namespace blockrand::importers::osm {

struct PlannedFeature {
  model::OsmId id;
  const RawObject* raw = nullptr;
  std::uint32_t kinds = 0;
  bool area = false;
  std::vector<AreaRing> rings;  ///< with `area` rings, otherwise lines (a closed one repeats its vertex) or one point
};

/// Calls `visit` for each feature in order of id. An object that is modelled as a building (or stands behind one as
/// duplicate or represented) is none; a building node, or a building reported for whatever reason, is one when its
/// other tags say so.
///
/// * A closed way is an area when its tags make it one (landuse, most of leisure and natural, amenity …) or area=yes.
/// * A line is cut where nodes are missing.
/// * A multipolygon or boundary relation is an area; where its rings do not close, the lines of its members, noted as
///   MEMBERS_MISSING or RELATION_REPAIRED.
/// * Member ways that say no more than their relation are left out; the outer ways of a relation without tags of its
/// own
///   are the feature (old style), the first of those with the same tags for all.
void for_each_feature(const RawData& data, const Accounts& accounts, std::vector<model::ReportRow>& notices,
                      const std::function<void(const PlannedFeature&)>& visit);

}  // namespace blockrand::importers::osm
