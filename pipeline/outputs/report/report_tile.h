// What a tile gives to the report: footprints in decimetres, the classes they are coloured by, areas, addresses.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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

/// m² in hundredths: sums of whole numbers do not depend on the order, so not on the tiling.
using Area = std::int64_t;

/// No answer in MapBuilding::style and MapBuilding::era.
inline constexpr std::uint8_t kNotClassified = 255;

/// One building of the map, some 120 bytes and 8 for each corner.
struct MapBuilding {
  model::OsmId osm;
  std::uint32_t first_ring = 0, ring_count = 0;  ///< into MapFootprints::ring_ends
  float storeys = 0, height = 0;                 ///< height in metres
  model::Source storeys_source = model::Source::default_, height_source = model::Source::default_,
                roof_source = model::Source::default_;
  model::RoofShape roof = model::RoofShape::flat;             ///< of its largest body, as built
  bool built = false;                                         ///< it has a body
  std::int8_t lod = -1;                                       ///< best level of detail among its bodies
  std::uint8_t style = kNotClassified, era = kNotClassified;  ///< model::StyleClass, model::Era
  model::Source style_source = model::Source::default_, era_source = model::Source::default_;
  /// m² of the outline, of what stands on the ground; of all full storeys; of those in the roof, measured at the eaves.
  Area footprint = 0, floors = 0, roof_floors = 0;
  Area guessed = 0;  ///< of `floors`, on storeys that no tag and no user states
  /// Index + 1 into MapFootprints::names; 0: none.
  std::uint32_t name = 0, address = 0, use = 0, block = 0;
};

/// Whether a value was stated for the object: by a user, by its tags, or by those of its parts.
constexpr bool is_stated(model::Source source) { return source <= model::Source::part; }

/// Footprints in flat arrays. Ring k ends before corners[ring_ends[k]]; outer rings and holes alike (filled even-odd).
struct MapFootprints {
  std::vector<MapBuilding> buildings;
  std::vector<std::uint32_t> ring_ends;
  std::vector<MapPoint> corners;
  std::vector<std::string> names;                             ///< each once in a tile
  std::vector<std::pair<model::OsmId, std::uint32_t>> parts;  ///< bodies with an id of their own → building
  std::uint64_t bodies = 0;

  std::uint32_t ring_begin(std::uint32_t ring) const { return ring == 0 ? 0 : ring_ends[ring - 1]; }
};

inline constexpr double kMapUnitsPerMetre = 10;

/// The middle of the box around a building's footprint; nothing where it has none.
std::optional<MapPoint> middle_of(const MapFootprints& footprints, const MapBuilding& building);

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
