// What an OSM extract holds that Blockrand uses: the compact object store of a build (ARCHITECTURE.md, law 5).
//
// Everything is kept in flat arrays with integer coordinates and interned tags. Importers fill it; afterwards it is
// read-only. Geometry is raw: rings are as mapped, of either orientation, and may be invalid.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/string_pool.h"
#include "pipeline/model/colour.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/model/osm_id.h"
#include "pipeline/model/point.h"
#include "pipeline/model/report.h"
#include "pipeline/model/roof_shape.h"
#include "pipeline/model/side_pitches.h"
#include "pipeline/model/style.h"

namespace blockrand::model {

struct Tag {
  base::StringId key = 0, value = 0;
};

/// A run of entries in one of Extract's arrays.
struct Range {
  std::uint32_t first = 0, count = 0;
};

/// A run of Extract::vertices without a repeated last vertex.
struct MappedRing {
  Range vertices;
  bool inner = false;  ///< an inner ring belongs to the last outer ring before it
};

/// What the tags of a building or part say in so many words: lengths in metres, angles in degrees, storeys counted.
/// Empty where the tag is absent or unreadable (the latter is in Extract::report as VALUE_UNREADABLE).
/// Conventions of the Simple 3D Buildings scheme: `height` runs from the ground to the top of the roof; `storeys` counts
/// the ground floor and the storeys skipped below `min_storey`, not those in the roof.
struct MappedAttributes {
  std::optional<float> height, min_height;
  std::optional<float> storeys, min_storey, roof_storeys, storeys_underground;
  std::optional<float> layer;  ///< order above or below what it crosses; 0 where not tagged
  std::optional<float> roof_height, roof_angle;
  std::optional<float> roof_direction;  ///< degrees clockwise from north, pointing down the slope
  std::optional<RoofOrientation> roof_orientation;
  SidePitches side_pitches;  ///< of single sides of the roof
  std::optional<RoofShape> roof_shape;
  std::optional<Colour> wall_colour, roof_colour;
  bool wall_colour_is_word = false, roof_colour_is_word = false;  ///< "red", not "#ff0000": a pigment is meant
  base::StringId wall_material = 0, roof_material = 0;            ///< as tagged, 0 where absent
  base::StringId use = 0;                                         ///< the value of building=* or building:part=*
  std::optional<ConstructionDate> built;                          ///< start_date and its kin
};

enum class ObjectKind : std::uint8_t { building, building_part };

/// The one final state of an object (ARCHITECTURE.md, law 1). The importer decides `duplicate` and `reported` for what
/// cannot become an area; the region stage decides the rest.
enum class ObjectState : std::uint8_t { pending, modelled, represented, duplicate, reported };

/// As written in all outputs.
constexpr std::string_view name(ObjectState state) {
  constexpr std::string_view names[] = {"pending", "modelled", "represented", "duplicate", "reported"};
  return names[static_cast<int>(state)];
}

/// A node, way or relation with `building` or `building:part` (not `no`).
struct MappedBuilding {
  OsmId id;
  ObjectKind kind = ObjectKind::building;
  ObjectState state = ObjectState::pending;
  IssueCode code = IssueCode::none;  ///< why, when `reported`
  OsmId related;                     ///< of whom it is a duplicate, or who represents it
  OsmId geometry_from;               ///< whose rings these are: differs from `id` for old-style multipolygons
  Range rings;                       ///< into Extract::rings; empty when there is no area
  std::optional<Location> place;     ///< of an object without rings: the middle of what is known of it
  Range tags;                        ///< into Extract::tags
  std::uint32_t edited = 0;          ///< when it was last edited, in seconds since 1970; 0: the file does not say
  MappedAttributes attributes;
};

/// A relation with type=building: which outline its parts belong to.
struct BuildingRelation {
  OsmId id;
  OsmId outline;  ///< number 0 where the relation has none
  std::vector<OsmId> parts;
};

/// What a feature is good for; one object can be several things.
enum class FeatureKind : std::uint32_t {
  street = 1u << 0,      ///< highway=*
  land_use = 1u << 1,    ///< landuse=*, leisure=*, natural=* areas
  water = 1u << 2,       ///< waterway=*, natural=water, natural=coastline
  railway = 1u << 3,     ///< railway=*
  barrier = 1u << 4,     ///< barrier=wall|fence|retaining_wall|city_wall|hedge
  tree = 1u << 5,        ///< natural=tree, natural=tree_row
  entrance = 1u << 6,    ///< entrance=*, building=entrance, door=*
  address = 1u << 7,     ///< addr:*
  shop = 1u << 8,        ///< shop=*
  amenity = 1u << 9,     ///< amenity=*
  passage = 1u << 10,    ///< tunnel=building_passage, covered ways
  roof_line = 1u << 11,  ///< roof:ridge=yes, roof:edge=yes
  roof_apex = 1u << 12,  ///< roof:apex=*
  place = 1u << 13,      ///< place=*
  boundary = 1u << 14,   ///< boundary=*
  surrounding =
      1u << 15,  ///< what only the surroundings of houses are made of: lamps, signs, masts, power lines, piers …
};

/// Any other object that the stages use.
struct Feature {
  OsmId id;
  std::uint32_t kinds = 0;  ///< FeatureKind bits
  bool area = false;        ///< rings are areas; otherwise each ring is a line or, with one vertex, a point
  Range rings;              ///< a line keeps its repeated last vertex when it is closed
  Range tags;
  bool is(FeatureKind kind) const { return (kinds & static_cast<std::uint32_t>(kind)) != 0; }
};

/// What was counted before assembly.
struct ExtractCounts {
  std::uint64_t nodes = 0, ways = 0, relations = 0;                             ///< in the file
  std::uint64_t building_nodes = 0, building_ways = 0, building_relations = 0;  ///< kind `building`
  std::uint64_t part_nodes = 0, part_ways = 0, part_relations = 0;              ///< kind `building_part`
  std::uint64_t old_style_multipolygons = 0;          ///< relations whose tags were taken from outer ways
  std::uint64_t areas_with_holes = 0;                 ///< building or part areas with at least one hole
  std::uint64_t missing_nodes = 0, missing_ways = 0;  ///< referenced by a kept object, not in the file
  std::uint64_t buildings() const { return building_nodes + building_ways + building_relations; }
  std::uint64_t parts() const { return part_nodes + part_ways + part_relations; }
};

struct Extract {
  std::string file;       ///< path as given
  std::string data_time;  ///< newest timestamp of the objects in the file, ISO 8601, or empty
  base::StringPool strings;
  std::vector<MappedBuilding> buildings;  ///< sorted by id
  std::vector<BuildingRelation> building_relations;
  std::vector<Feature> features;  ///< sorted by id
  std::vector<MappedRing> rings;
  std::vector<Location> vertices;
  std::vector<Location> mapped_vertices;   ///< `vertices` as OSM has them, where buildings were moved; else empty
  std::vector<std::int64_t> vertex_nodes;  ///< OSM node ids, parallel to `vertices`
  std::vector<Tag> tags;
  ExtractCounts counts;
  Report report;  ///< what the importer had to say

  std::span<const MappedRing> rings_of(Range r) const { return std::span(rings).subspan(r.first, r.count); }
  std::span<const Location> vertices_of(const MappedRing& r) const {
    return std::span(vertices).subspan(r.vertices.first, r.vertices.count);
  }
  /// Where OSM has them.
  std::span<const Location> mapped_vertices_of(const MappedRing& r) const {
    return std::span(mapped_vertices.empty() ? vertices : mapped_vertices).subspan(r.vertices.first, r.vertices.count);
  }
  std::span<const std::int64_t> nodes_of(const MappedRing& r) const {
    return std::span(vertex_nodes).subspan(r.vertices.first, r.vertices.count);
  }
  std::span<const Tag> tags_of(Range r) const { return std::span(tags).subspan(r.first, r.count); }
  /// The value of `key`, or empty. Keys are compared as interned ids: look the id up once with strings.find().
  std::string_view tag(Range r, base::StringId key) const {
    if (key == 0) return {};
    for (const Tag& t : tags_of(r))
      if (t.key == key) return strings.view(t.value);
    return {};
  }
  std::string_view tag(Range r, std::string_view key) const { return tag(r, strings.find(key)); }
};

}  // namespace blockrand::model
