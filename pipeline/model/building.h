// A building as the stages see it: resolved attributes, parts, plans and solids, in the build CRS.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/detail_override.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/facade.h"
#include "pipeline/model/polygon.h"
#include "pipeline/model/roof_line.h"
#include "pipeline/model/roof_shape.h"
#include "pipeline/model/side_pitches.h"
#include "pipeline/model/solid.h"
#include "pipeline/model/sourced.h"
#include "pipeline/model/style.h"

namespace blockrand::model {

/// Every inferred value of a building or part. Lengths in metres on the ground, angles in degrees.
struct Attributes {
  Sourced<std::string> use;  ///< building class: the value of building=*, refined where it said only `yes`
  Sourced<double> storeys;   ///< full storeys above ground, ground floor included, roof storeys not
  Sourced<double> storey_height;
  Sourced<double> height;      ///< lowest ground to the top of the roof
  Sourced<double> min_height;  ///< ground to the underside; 0 for nearly all
  Sourced<double> roof_storeys;
  Sourced<double> roof_height;    ///< eaves to the top of the roof
  Sourced<RoofShape> roof_shape;  ///< what was asked for; BuildingPart::built_roof says what stands
  Sourced<RoofOrientation> roof_orientation;
  std::optional<Sourced<double>> roof_direction;  ///< clockwise from north, down the slope
  Sourced<double> ground_height;  ///< base above the build's height reference: the lowest ground under the building
  Sourced<double> plinth_height;  ///< from there up to the level of the ground floor
  Sourced<Colour> wall_colour, roof_colour;     ///< as mapped or drawn
  Colour shown_wall_colour, shown_roof_colour;  ///< what faces have: pigments of named colours, drawn roofs weathered
  Sourced<std::string> wall_material, roof_material;  ///< names of material classes
  Sourced<double> eaves_height;                       ///< lowest ground to the eaves: height less roof_height
  Sourced<double> roof_pitch;                         ///< degrees, of the main slope; 0 for flat roofs
  std::optional<Sourced<double>>
      ridge_direction;                     ///< degrees [0, 180) clockwise from north; absent for roofs without a ridge
  Sourced<std::string> ground_floor_use;   ///< `shop`, `gastronomy`, `office`, ... or as `use`
  Sourced<std::string> construction_date;  ///< a year, or `from..to`
  Sourced<std::string> era;                ///< model::Era
  Sourced<std::string> style;              ///< model::StyleClass; its confidence is its probability
  Sourced<std::string> substyle;           ///< id in configs/styles/catalogue.toml
  Sourced<std::string> preset;             ///< grammar preset, by the district rules
};

/// Text form of a colour: `#rrggbb`.
inline std::string text(Colour c) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string out = "#";
  for (const std::uint8_t v : {c.r, c.g, c.b}) {
    out += digits[v >> 4];
    out += digits[v & 15];
  }
  return out;
}

/// Calls `visit(name, unit, sourced)` for every attribute, in the order of all outputs. `sourced.value` is double,
/// std::string, RoofShape, RoofOrientation or Colour; absent optional values are visited as nullptr by `absent(name,
/// unit)`, so that tables keep their columns.
template <class A, class Visit, class Absent>
void for_each_attribute(A& a, Visit&& visit, Absent&& absent) {
  visit("use", "", a.use);
  visit("storeys", "", a.storeys);
  visit("storey_height", "m", a.storey_height);
  visit("height", "m", a.height);
  visit("min_height", "m", a.min_height);
  visit("roof_storeys", "", a.roof_storeys);
  visit("roof_height", "m", a.roof_height);
  visit("roof_shape", "", a.roof_shape);
  visit("roof_orientation", "", a.roof_orientation);
  if (a.roof_direction)
    visit("roof_direction", "degree", *a.roof_direction);
  else
    absent("roof_direction", "degree");
  visit("ground_height", "m", a.ground_height);
  visit("plinth_height", "m", a.plinth_height);
  visit("wall_colour", "", a.wall_colour);
  visit("roof_colour", "", a.roof_colour);
  visit("wall_material", "", a.wall_material);
  visit("roof_material", "", a.roof_material);
  visit("eaves_height", "m", a.eaves_height);
  visit("roof_pitch", "degree", a.roof_pitch);
  if (a.ridge_direction)
    visit("ridge_direction", "degree", *a.ridge_direction);
  else
    absent("ridge_direction", "degree");
  visit("ground_floor_use", "", a.ground_floor_use);
  visit("construction_date", "", a.construction_date);
  visit("era", "", a.era);
  visit("style", "", a.style);
  visit("substyle", "", a.substyle);
  visit("preset", "", a.preset);
}

inline constexpr std::uint32_t kNoIndex = 0xffffffff;

/// What a wall segment of an outline faces.
enum class WallSegmentKind : std::uint8_t { unknown, street, courtyard, side, party_wall, passage };
inline constexpr int kWallSegmentKindCount = 6;
constexpr std::string_view name(WallSegmentKind kind) {
  constexpr std::string_view names[] = {"unknown", "street", "courtyard", "side", "party_wall", "passage"};
  return names[static_cast<int>(kind)];
}

/// A mapped entrance, address, or shop node, and the wall segment of wall it belongs to.
struct WallPoint {
  OsmId id;
  Point2 place;              ///< m
  bool entrance = false;     ///< else an address or a shop alone
  std::string house_number;  ///< addr:housenumber, empty for none
  std::string use;           ///< what is behind the wall there: a category of configs/styles/ground_floor.toml, "shop";
                             ///< empty for none
};

/// A wall segment of one edge of the outline with one situation. Edges are cut where their situation changes; the cuts are no
/// corners of the outline, so that roofs and solids keep whole walls.
struct WallSegment {
  std::int64_t from_node = 0,
               to_node = 0;   ///< OSM nodes of the ends of the whole edge (0 where a repair made the point)
  std::uint32_t polygon = 0;  ///< index into Building::outline
  std::uint32_t ring = 0;     ///< 0: outer; k: holes[k - 1]
  std::uint32_t edge = 0;     ///< from point `edge` of the ring to the next
  double start = 0, end = 0;  ///< m along the edge, from its first point
  WallSegmentKind kind = WallSegmentKind::unknown;
  float confidence = 0;                   ///< of `kind`, [0, 1]
  OsmId neighbour;                        ///< party wall: of whom; number 0 otherwise
  float covered_height = 0;               ///< m, party wall: what the neighbour covers, known once heights are resolved
  bool outbuilding = false;               ///< party wall: the neighbour is too small for a house (kOutbuildingArea)
  OsmId street;                           ///< the street it faces (street, passage; also of a side or courtyard that
                                          ///< looks out on one); number 0 where none
  std::string street_name, street_class;  ///< of it; class as context::LineClass is written
  float street_distance = 0;              ///< m, from the middle of the wall segment to the street's line
  float street_angle = 0;                 ///< degrees [0, 90] between the wall segment and the street
  float visibility = 0;                   ///< [0, 1]: how much of it is seen from street space
  bool corner_start = false, corner_end = false;  ///< a street corner of the block lies at this end
  bool chamfer = false;                           ///< cuts off a street corner
  std::int32_t entrances = 0;                     ///< mapped entrances on it
  std::vector<WallPoint> points;                  ///< mapped entrances and address nodes at it, by id
  std::int32_t arc = -1;                          ///< index into Building::arcs, where the edge is a piece of a curve
  double length() const { return end - start; }
};

/// How a building stands to its neighbours and its block.
enum class BuildingPosition : std::uint8_t {
  unknown,
  free_standing,  ///< no party wall
  end_of_row,     ///< party walls on one side
  mid_row,        ///< party walls on two sides
  corner_house,   ///< fronts on two streets that meet
  rear_building,  ///< Hinterhaus: inside the block, no front on a street
  side_wing,      ///< Seitenfluegel: inside the block, along the border of the lot, tied to a front or rear building
};
inline constexpr int kBuildingPositionCount = 7;
constexpr std::string_view name(BuildingPosition position) {
  constexpr std::string_view names[] = {"unknown",      "free_standing", "end_of_row", "mid_row",
                                        "corner_house", "rear_building", "side_wing"};
  return names[static_cast<int>(position)];
}

/// What context says about the whole building. Lengths in metres on the ground.
struct BuildingSituation {
  BuildingPosition position = BuildingPosition::unknown;
  std::vector<std::uint32_t>
      fronts;  ///< indices into Building::edges: wall segments of the main fronts, the longest first
  std::optional<double> orientation;    ///< degrees clockwise from north: where the main front looks
  std::optional<double> depth, width;   ///< across and along the main front (without one: shorter, longer side)
  std::optional<double> setback;        ///< main front to the street's building line
  double party_wall_length = 0;         ///< m
  std::string block;                    ///< id of its block (context::Block), empty for none
  std::vector<std::string> courtyards;  ///< ids of the courtyards that it stands at
};

/// A mapped tree that stands before a building.
struct NearTree {
  OsmId id;
  Point2 place;            ///< m
  std::uint32_t edge = 0;  ///< index into Building::edges: the wall segment it is nearest to
  float distance = 0;      ///< m, from that wall segment
};

/// A run of edges that approximates a circle: a rounded corner, a bay, a round tower.
struct Arc {
  std::uint32_t polygon = 0, ring = 0;
  std::uint32_t first = 0, count = 0;  ///< edges first, first + 1, ... (modulo the ring) are its chords
  Point2 centre;                       ///< m
  double radius = 0;                   ///< m
  bool convex = true;                  ///< bulges out of the building
};

/// What repair did to one footprint; lengths in metres, areas in square metres.
struct RepairRecord {
  std::uint32_t vertices = 0;            ///< of the outline after repair
  std::uint32_t moved = 0;               ///< of them by more than 1 mm
  double mean_shift = 0, max_shift = 0;  ///< m, of the moved ones
  double mapped_area = 0, area = 0;
  std::uint32_t shared_walls = 0;  ///< wall segments whose points a neighbour has as well
  std::uint32_t gaps_closed = 0;   ///< of them that did not touch as mapped
  std::uint32_t overlaps_resolved = 0;
  double overlap_left = 0;  ///< m² common with others at the same level that stay (reported)
  double direction = -1;    ///< degrees [0, 90), of the main walls clockwise from north; -1 where nothing was squared
};

/// Rings as mapped, projected, before repair. An inner ring belongs to the last outer ring before it.
struct MappedRings {
  std::vector<Ring> rings;
  std::vector<bool> inner;  ///< parallel to `rings`
};

/// One body of a building: a mapped part, what the parts leave of the outline, or the building itself.
struct BuildingPart {
  std::string id;  ///< "w123", "w123.w456", "w123.rest", "w123.2" for the second piece of an outline
  OsmId osm;       ///< whose tags it carries
  std::uint32_t mapped_index = kNoIndex;  ///< into Extract::buildings
  Range tags;                             ///< into Extract::tags
  MappedAttributes mapped;                ///< what its tags say
  MappedRings rings;                      ///< of a mapped part, until repair
  Polygon plan;                           ///< repaired
  Polygon roof_plan;                      ///< `plan` without points that bend no wall: what walls and roofs stand on
  std::vector<RoofEdge> roof_edges;       ///< of roof_plan, ring by ring; empty before context has labelled the outline
  bool rest = false;                      ///< what mapped parts leave of the outline
  std::vector<RoofLine> roof_lines;       ///< drawn on this plan, fitted to it, by id; with a ridge among them, or none
  Attributes attributes;
  double usual_pitch = 0;        ///< degrees; what was asked of a roof that no tag measures, 0 for others
  SidePitches side_pitches;      ///< ordered for single sides of the roof
  double other_sides_pitch = 0;  ///< degrees, of the sides without one of their own; 0 where none is ordered
  bool canopy = false;           ///< building=roof: a closed slab without walls
  RoofShape built_roof = RoofShape::flat;
  int lod = -1;      ///< highest level of detail built: 3, 2, 1, 0, or -1 for none
  Solid lod1, lod2;  ///< empty above `lod`, or where not asked for
  SolidTriangles lod1_triangles, lod2_triangles;
  Detail lod3;  ///< its solid is empty below lod 3
  std::vector<IssueCode> fallbacks;
};

/// A value that classification offers where the map is silent.
template <class T>
struct InferredCandidate {
  T value{};
  Source source = Source::default_;
  float confidence = 0;  ///< 0: nothing is offered
  std::string why;
};

/// What classification offers for a building's attributes.
struct Inferred {
  InferredCandidate<float> storeys;
  InferredCandidate<RoofShape> roof_shape;
  std::uint8_t style = 0;      ///< index into the catalogue of styles: usual heights, pitches, colours
  float style_confidence = 0;  ///< 0: nothing is offered
};

/// What an aerial image shows of the roof over the whole outline, for values where the map is silent.
struct SeenRoof {
  InferredCandidate<Colour> colour;
  InferredCandidate<bool> pitched;
  InferredCandidate<double> ridge;  ///< degrees clockwise from north, [0, 180)
  InferredCandidate<double> eaves;  ///< m above the ground around, of the edge that casts the shadow
};

/// A model by somebody else that stands for a building.
struct ReplacementModel {
  std::string file;  ///< as the override names it
  std::string source, licence;
  std::string author;  ///< may be empty
  std::string order;   ///< "overrides.toml:12"
};

/// In one line, for outputs: "church.glb; A. Mason; CC BY 4.0; https://…".
inline std::string text(const ReplacementModel& m) {
  return m.file + (m.author.empty() ? "" : "; " + m.author) + "; " + m.licence + "; " + m.source;
}

struct Building {
  OsmId osm;
  std::uint32_t mapped_index = kNoIndex;  ///< into Extract::buildings
  Range tags;                             ///< into Extract::tags
  MappedAttributes mapped;                ///< what its tags say
  MappedRings rings;                      ///< empty for a part without outline that stands alone
  std::vector<Polygon> outline;           ///< repaired; usually one
  std::vector<WallSegment> edges;  ///< of the outline: polygon by polygon, ring by ring, edge by edge, along the edge
  std::vector<Arc> arcs;           ///< curves of the outline
  RepairRecord repaired;           ///< what repair did to the outline
  BuildingSituation situation;     ///< what context found
  std::vector<NearTree> trees;     ///< before its walls, by id
  BuildingStyle style;             ///< what classification found
  bool style_known = false;        ///< false: it was not classified (no outline)
  Inferred inferred;               ///< and what it offers
  SeenRoof seen_roof;              ///< and what an image shows
  StyleExplanation style_why;      ///< and what spoke for it
  std::vector<std::pair<std::string, std::string>> preset_parameters;  ///< by name; what district rules give the preset
  std::vector<DetailOverride> detail_overrides;      ///< of its storeys, edges and bays, and of its parts'
  Attributes attributes;                             ///< of the whole building
  std::vector<BuildingPart> parts;                   ///< at least one after `generate` unless nothing could be built
  std::shared_ptr<const ReplacementModel> replaced;  ///< its only part's LoD2 is this model; null: it is not replaced
  bool has_mapped_parts = false;
  ObjectState settled = ObjectState::pending;  ///< duplicate or represented: another building stands for it
  OsmId related;                               ///< that one
  bool owned = true;                           ///< false: halo only, never exported
  IssueCode failure = IssueCode::none;         ///< why nothing could be built, when `parts` is empty or has no solid
  std::string id() const { return osm.text(); }
};

}  // namespace blockrand::model
