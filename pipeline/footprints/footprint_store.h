// The outlines of all buildings of an extract between two stages: flat arrays, so that a city fits into memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/footprints/repair/terrace_row.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/model/building.h"

namespace blockrand::footprints {

using geometry::box_of;
using geometry::BoxIndex;
using geometry::PlanBox;

/// One building's outline in the store.
struct StoredFootprint {
  model::OsmId id;
  std::uint32_t lead = model::kNoIndex;  ///< into Extract::buildings
  model::Range rings;                    ///< into the store
  model::Range arcs;
  PlanBox box;  ///< empty where the outline has no area
  repair::Level level;
  model::RepairRecord record;
  double party_wall_length = 0;                       ///< m that a neighbour has point for point
  model::IssueCode failure = model::IssueCode::none;  ///< why there is no outline
  bool has_parts = false;
  model::ObjectState settled =
      model::ObjectState::pending;  ///< duplicate or represented: another building stands for it
  model::OsmId related;             ///< that one
};

/// Outlines by the number of their building in the run (position in the shards, in their order).
/// Filled in any order by one thread at a time; read by any number of threads.
class FootprintStore {
 public:
  explicit FootprintStore(std::size_t buildings = 0) : entries_(buildings) {}

  /// Stores what is in `footprint` and the polygons; box and ranges are set here.
  void set(std::uint32_t building, StoredFootprint footprint, std::span<const model::Polygon> polygons,
           std::span<const model::Arc> arcs = {});
  /// \param area  m², that a building has in common with another and keeps
  void add_overlap(std::uint32_t building, double area);
  std::size_t size() const { return entries_.size(); }
  const StoredFootprint& operator[](std::uint32_t building) const { return entries_[building]; }
  std::vector<model::Polygon> polygons(std::uint32_t building) const;
  std::vector<model::Arc> arcs(std::uint32_t building) const;
  /// The rings as spans of points, outer rings and holes alike, each without its repeated last point.
  template <class Visit>
  void for_each_ring(std::uint32_t building, Visit&& visit) const {
    const model::Range r = entries_[building].rings;
    for (const StoredRing& ring : std::span(rings_).subspan(r.first, r.count))
      visit(std::span(points_).subspan(ring.points.first, ring.points.count), ring.hole);
  }
  void shrink_to_fit();

 private:
  struct StoredRing {
    model::Range points;
    bool hole = false;
  };
  std::vector<StoredFootprint> entries_;
  std::vector<StoredRing> rings_;
  std::vector<model::Point2> points_;
  std::vector<std::int64_t> nodes_;
  std::vector<model::Arc> arcs_;
};

/// Numbers of buildings (places in the shards) by OSM id.
class BuildingNumbers {
 public:
  explicit BuildingNumbers(const FootprintStore& store);
  /// kNoIndex where there is none.
  std::uint32_t find(model::OsmId id) const;

 private:
  std::vector<std::pair<model::OsmId, std::uint32_t>> numbers_;  ///< sorted
};

/// The boxes of all buildings, by building.
BoxIndex index_of(const FootprintStore& store);

}  // namespace blockrand::footprints
