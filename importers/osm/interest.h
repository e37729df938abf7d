// Which objects are kept, and as what: a look at the tags of one object.
#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/model/osm_id.h"

namespace blockrand::importers::osm {

/// What tags make of an object. Fed tag by tag with `add`.
struct Interest {
  std::uint32_t kinds = 0;     ///< model::FeatureKind bits
  bool building = false;       ///< building=* but not `no`
  bool building_part = false;  ///< building:part=* but not `no`
  bool area_yes = false;       ///< area=yes
  bool area_no = false;        ///< area=no
  bool area_by_tag = false;    ///< a closed way with this tag is an area: landuse, leisure, most of natural …
  bool line_by_tag = false;    ///< a closed way with this tag is a line unless area=yes: highway, barrier …
  bool covered_way = false;    ///< tunnel=building_passage or covered=*
  bool surroundings = false;   ///< rows of interest_rules.h that serve the surroundings alone count. Set before `add`

  void add(model::OsmType type, std::string_view key, std::string_view value);
  /// After the last tag: what only the tags together tell.
  void finish(model::OsmType type);

  bool is_building() const { return building || building_part; }
  /// What a closed way is.
  bool area() const { return area_yes || (area_by_tag && !line_by_tag && !area_no); }
};

/// Tags that say nothing about the thing itself: a relation with only these, or a member with only these beside the
/// relation's, has no tags of its own.
bool is_remark(std::string_view key);

}  // namespace blockrand::importers::osm
