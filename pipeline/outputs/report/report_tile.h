// What a tile gives to the report's map: footprints in decimetres and the classes they are coloured by.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/style_basis.h"

namespace blockrand::outputs {

/// A place on the map: decimetres in the build CRS, x east, y north.
struct MapPoint {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const MapPoint&, const MapPoint&) = default;
};

/// One building of the map, some 60 bytes and 8 for each corner.
struct MapBuilding {
  model::OsmId osm;
  std::uint32_t first_ring = 0, ring_count = 0;  ///< into MapFootprints::ring_ends
  float storeys = 0, height = 0;                 ///< height in metres
  model::Source storeys_source = model::Source::default_, height_source = model::Source::default_,
                roof_source = model::Source::default_;
  model::RoofShape roof = model::RoofShape::flat;  ///< of its largest body, as built
  bool built = false;                              ///< it has a body
  std::int8_t lod = -1;                            ///< best level of detail among its bodies
  std::uint32_t name = 0;                          ///< index + 1 into MapFootprints::names; 0: none
};

/// Footprints in flat arrays. Ring k ends before corners[ring_ends[k]]; outer rings and holes alike (filled even-odd).
struct MapFootprints {
  std::vector<MapBuilding> buildings;
  std::vector<std::uint32_t> ring_ends;
  std::vector<MapPoint> corners;
  std::vector<std::string> names;
  std::vector<std::pair<model::OsmId, std::uint32_t>> parts;  ///< bodies with an id of their own → building
  std::uint64_t bodies = 0;

  std::uint32_t ring_begin(std::uint32_t ring) const { return ring == 0 ? 0 : ring_ends[ring - 1]; }
};

/// Buildings that were classified, by answer and by what the answer rests on (StyleBasis).
struct StyleCounts {
  std::array<std::array<std::uint64_t, kStyleBasisCount>, model::kStyleClassCount> classes{};
  std::array<std::array<std::uint64_t, kStyleBasisCount>, model::kEraCount> eras{};
  void add(const StyleCounts& other);
};

struct ReportTile {
  MapFootprints footprints;
  StyleCounts styles;
};

/// The owned buildings of a finished tile. Pure: safe for different tiles at the same time.
ReportTile report_tile(const model::Region& region);

}  // namespace blockrand::outputs
