// Buildings that are mapped beside where they stand: moved as mapped, before repair, with all that hangs on them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/point.h"

namespace blockrand::footprints {

/// Where each point of an outline goes; rings without repeated last point, in m. Both have the same rings and points.
struct Reshape {
  std::vector<std::vector<model::Point2>> before, after;
};

/// A rigid movement in the plan of the build CRS, and what walls are shifted by beside it.
struct Movement {
  model::Point2 shift;   ///< m
  model::Point2 centre;  ///< m: of the turn, which comes before the shift
  double turn = 0;       ///< degrees, counter-clockwise
  /// Any point goes along with the wall of `before` that is nearest to it: beside the rigid movement it goes as far as the ends of
  /// that wall do, in proportion. Corners that go no farther than the rigid movement, to 2 mm, keep to it. Empty: nothing is reshaped.
  Reshape reshape{};
  model::Point2 operator()(model::Point2 p) const;
  model::Point2 rigid(model::Point2 p) const;  ///< without the reshaping
};

struct MovedBuilding {
  std::uint32_t building = 0;  ///< its number: place in the shards, in their order
  Movement movement;
};

/// Moves the rings of buildings and their parts in the extract. What is mapped on or in them goes along: every feature's
/// vertex at one of their nodes (passages, walls, entrances), and points and roof lines that lie within their outlines.
/// What was mapped stays in Extract::mapped_vertices. Places are rounded to 1e-7 degrees, about a centimetre, as OSM has them: repair follows.
void move_buildings(model::Extract& extract, std::span<const Shard> shards, std::span<const MovedBuilding> moved,
                    const georef::Projection& projection);

}  // namespace blockrand::footprints
