// Runs of edges that approximate circles: rounded corners, bays, round towers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/model/polygon.h"

namespace blockrand::repair {

/// A curve in a ring of points: edges first, first + 1, ... (modulo the ring) are its chords. Metres.
struct ArcRun {
  std::uint32_t first = 0, count = 0;
  model::Point2 centre;
  double radius = 0;
  bool left = true;  ///< turns left along the ring: bulges out of a building whose rings have it to their left
};

/// Curves of one ring, by `first`. A curve is a run of at least four edges whose corners
/// * all turn the same way, each by 4 to 40 degrees (so a square, a hexagon and an octagon are none, whole circles have
/// at
///   least nine corners), the largest turn at most four times the smallest;
/// * are at similar distances (longest chord at most three times the shortest; the chord at either end may be as short
/// as
///   a sixth of the longest, because curves end between two corners);
/// * lie on a circle of 0.5 to 60 m radius, each within an eighth of the curve's own height (bounded by 0.02 and 0.15
/// m). Runs that overlap: the longest wins, then the one that fits better. A ring that is one circle gives one run with
/// the count of the ring and `first` 0. What is found does not depend on where the ring starts.
std::vector<ArcRun> find_arc_runs(std::span<const model::Point2> ring);

/// Curves of a building's polygons, by polygon, ring and first edge.
std::vector<model::Arc> find_arcs(const std::vector<model::Polygon>& polygons);

}  // namespace blockrand::repair
