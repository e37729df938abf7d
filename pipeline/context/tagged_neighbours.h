// What the tagged buildings around a place say about those that are not tagged.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/model/osm_id.h"
#include "pipeline/model/point.h"
#include "pipeline/model/roof_shape.h"

namespace blockrand::context {

/// A building whose mapper noted storeys, or its roof. Inferred values never enter, so that what a building looks like
/// depends on data within the reach alone (ARCHITECTURE.md, law 4).
struct TaggedBuilding {
  model::OsmId id;
  model::Point2 place;     ///< m, any point of it
  std::uint8_t group = 0;  ///< only buildings of one group speak for each other
  std::optional<float> storeys;
  std::optional<model::RoofShape> roof_shape;
};

/// A statement of neighbours.
template <class T>
struct NeighbourVote {
  T value{};
  int voices = 0;    ///< neighbours that were asked
  double share = 0;  ///< of them that agree: same roof shape, or storeys within half a storey
};

/// The tagged buildings of an extract; read-only after construction, safe to share.
class TaggedNeighbours {
 public:
  /// \param reach  m: how far away a neighbour may be
  TaggedNeighbours(std::vector<TaggedBuilding> buildings, double reach);

  /// Median storeys of the neighbours of `group` within the reach of `place`, other than `self`; empty when fewer than
  /// `minimum` are tagged. With an even number the lower of the middle two, so that the value is one that was mapped.
  std::optional<NeighbourVote<double>> storeys(model::Point2 place, std::uint8_t group, model::OsmId self,
                                               int minimum) const;
  /// The most frequent roof shape (ties: the first in the list of shapes).
  std::optional<NeighbourVote<model::RoofShape>> roof_shape(model::Point2 place, std::uint8_t group, model::OsmId self,
                                                            int minimum) const;
  double reach() const { return reach_; }

  /// Those that a building in `box` may ask, in the order in which they were given.
  std::vector<TaggedBuilding> near(const geometry::PlanBox& box) const;

 private:
  template <class Visit>
  void for_each_near(model::Point2 place, std::uint8_t group, model::OsmId self, Visit&& visit) const;

  double reach_;
  std::vector<TaggedBuilding> buildings_;
  geometry::BoxIndex places_;  ///< of buildings_, by number
};

}  // namespace blockrand::context
