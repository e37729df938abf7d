// A building as the stages see it: resolved attributes, parts, plans and solids, in the build CRS.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/polygon.h"
#include "pipeline/model/roof_shape.h"
#include "pipeline/model/solid.h"
#include "pipeline/model/sourced.h"

namespace blockrand::model {

/// Every inferred value of a building or part. Lengths in metres on the ground, angles in degrees.
struct Attributes {
  Sourced<std::string> use;            ///< building class: the value of building=*, refined where it said only `yes`
  Sourced<double> storeys;             ///< full storeys above ground, ground floor included, roof storeys not
  Sourced<double> storey_height;
  Sourced<double> height;              ///< ground to the top of the roof
  Sourced<double> min_height;          ///< ground to the underside; 0 for nearly all
  Sourced<double> roof_storeys;
  Sourced<double> roof_height;         ///< eaves to the top of the roof
  Sourced<RoofShape> roof_shape;       ///< what was asked for; BuildingPart::built_roof says what stands
  Sourced<RoofOrientation> roof_orientation;
  std::optional<Sourced<double>> roof_direction;  ///< clockwise from north, down the slope
  Sourced<double> ground_height;       ///< base above the build's height reference
  Sourced<Colour> wall_colour, roof_colour;
  Sourced<std::string> wall_material, roof_material;  ///< names of material classes
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
  visit("wall_colour", "", a.wall_colour);
  visit("roof_colour", "", a.roof_colour);
  visit("wall_material", "", a.wall_material);
  visit("roof_material", "", a.roof_material);
}

inline constexpr std::uint32_t kNoIndex = 0xffffffff;

/// What one edge of a footprint faces. First version: walls shared node by node; `context` refines it.
enum class EdgeKind : std::uint8_t { unknown, party_wall };

struct FacadeEdge {
  std::int64_t from_node = 0, to_node = 0;  ///< OSM nodes of its ends (0 where a repair made the point)
  EdgeKind kind = EdgeKind::unknown;
};

/// Rings as mapped, projected, before repair. An inner ring belongs to the last outer ring before it.
struct MappedRings {
  std::vector<Ring> rings;
  std::vector<bool> inner;  ///< parallel to `rings`
};

/// One body of a building: a mapped part, what the parts leave of the outline, or the building itself.
struct BuildingPart {
  std::string id;          ///< "w123", "w123.w456", "w123.rest", "w123.2" for the second piece of an outline
  OsmId osm;               ///< whose tags it carries
  std::uint32_t mapped_index = kNoIndex;  ///< into Extract::buildings
  Range tags;              ///< into Extract::tags
  MappedAttributes mapped; ///< what its tags say
  MappedRings rings;       ///< of a mapped part, until repair
  Polygon plan;            ///< repaired
  bool rest = false;       ///< what mapped parts leave of the outline
  Attributes attributes;
  bool canopy = false;     ///< building=roof: a closed slab without walls
  RoofShape built_roof = RoofShape::flat;
  int lod = -1;            ///< highest level of detail built: 2, 1, 0, or -1 for none
  Solid lod1, lod2;        ///< empty above `lod`, or where not asked for
  SolidTriangles lod1_triangles, lod2_triangles;
  std::vector<IssueCode> fallbacks;
};

struct Building {
  OsmId osm;
  std::uint32_t mapped_index = kNoIndex;  ///< into Extract::buildings
  Range tags;                        ///< into Extract::tags
  MappedAttributes mapped;           ///< what its tags say
  MappedRings rings;                 ///< empty for a part without outline that stands alone
  std::vector<Polygon> outline;      ///< repaired; usually one
  std::vector<FacadeEdge> edges;     ///< of the outline, ring by ring, polygon by polygon
  Attributes attributes;             ///< of the whole building
  std::vector<BuildingPart> parts;   ///< at least one after `generate` unless nothing could be built
  bool has_mapped_parts = false;
  bool owned = true;                 ///< false: halo only, never exported
  IssueCode failure = IssueCode::none;  ///< why nothing could be built, when `parts` is empty or has no solid
  std::string id() const { return osm.text(); }
};

}  // namespace blockrand::model
