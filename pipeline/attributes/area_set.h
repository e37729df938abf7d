// Polygons in longitude and latitude, and which of them hold a place.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/model/osm_id.h"
#include "pipeline/model/point.h"

namespace blockrand::attributes {

/// Rings of an area, outer ones and holes in any order (even-odd).
using AreaRings = std::vector<std::vector<model::Location>>;

struct MappedArea {
  model::OsmId id;  ///< number 0: from a file
  AreaRings rings;
};

/// Read-only after construction, safe to share between threads. Exact: whole numbers only.
class AreaSet {
 public:
  explicit AreaSet(std::vector<MappedArea> areas = {});
  bool holds(model::Location place) const;
  /// The smallest area that holds the place, by the size of its box, then by id; null where none does.
  const MappedArea* smallest(model::Location place) const;
  bool empty() const { return areas_.empty(); }
  const std::vector<MappedArea>& areas() const { return areas_; }

 private:
  std::vector<MappedArea> areas_;
  geometry::BoxIndex index_;
};

bool holds(const AreaRings& rings, model::Location place);

/// A large area, or a node with a large radius, that rules ask for: region data (ARCHITECTURE.md, law 4), which a tile
/// alone takes from the build of the whole, because its window may show none of it.
struct PinnedArea {
  std::string question;  ///< what is asked of it: PlaceQuery::text, or the key of a tag
  std::string value;     ///< of that tag
  model::OsmId id;
  AreaRings rings;  ///< a node: one ring of one point
  friend bool operator==(const PinnedArea& a, const PinnedArea& b) {
    return a.question == b.question && a.value == b.value && a.id == b.id && a.rings == b.rings;
  }
};

}  // namespace blockrand::attributes
