// Lines that mappers draw on a roof.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/osm_id.h"
#include "pipeline/model/point.h"

namespace blockrand::model {

enum class RoofLineKind : std::uint8_t {
  ridge,  ///< roof:ridge=yes: at the roof's full height
  edge,   ///< roof:edge=yes: a hip, valley or break between points whose heights others tell
  apex,   ///< a roof:apex node: one point at the roof's full height
};

/// One such way or node in the build CRS.
struct RoofLine {
  OsmId id;
  RoofLineKind kind = RoofLineKind::edge;
  std::vector<Point2> points;       ///< m, on the grid; a closed line repeats its first point
  std::vector<std::int64_t> nodes;  ///< OSM nodes, parallel to `points`
};

}  // namespace blockrand::model
