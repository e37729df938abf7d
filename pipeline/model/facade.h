// What LoD3 adds to a body: openings in its walls, elements in and on them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/element.h"
#include "pipeline/model/roof_element.h"
#include "pipeline/model/solid.h"

namespace blockrand::model {

/// What opens a wall.
enum class OpeningKind : std::uint8_t {
  window,
  door,
  passage,  ///< leads through the body to another wall: no polygon closes it
};
constexpr std::string_view name(OpeningKind kind) {
  constexpr std::string_view names[] = {"window", "door", "passage"};
  return names[static_cast<int>(kind)];
}

/// A hole in a wall of a LoD3 solid: its reveal, and the polygon of window or door at the reveal's end.
struct Opening {
  OpeningKind kind = OpeningKind::window;
  std::uint32_t wall = 0;  ///< face of the solid that it opens
  std::uint32_t first_reveal =
      0;  ///< faces of the reveal: this one and the following; for passages those of the tunnel
  std::uint32_t reveal_count = 0;  ///< 0 for flush openings, and for the second portal of a passage
  std::uint32_t polygon = 0;       ///< face of kind window or door; of passages the face of the other portal's wall
  std::int32_t storey = 0;         ///< 0: ground floor
};

inline constexpr std::uint32_t kNoOpening = 0xffffffff;

/// An element where it stands.
struct Placement {
  std::uint32_t element = 0;  ///< into Region::elements
  Point3 origin;              ///< build CRS, m: where the element's own origin lies; on the 1/1024 m grid
  Point2 along;  ///< unit vector: the element's x axis, to the viewer's right. Its y is up, its z out of the wall
  std::uint32_t opening = kNoOpening;  ///< into Detail::openings: the one that it stands in
  std::uint32_t wall = 0;              ///< face of the LoD3 solid that it stands in or on
  std::int32_t storey = 0;             ///< 0: ground floor
};

/// A body of its own on a wall that no other building shares: a cornice along its front. Valid in the sense of
/// geometry::check_solid.
struct WallInstallation {
  std::string kind;        ///< "main_cornice", "string_course", "plinth" …
  std::uint32_t wall = 0;  ///< face of the LoD3 solid that it is on; of a run around corners the first
  Solid solid;
  SolidTriangles triangles;
};

/// Faces that one rule made, one after the other.
struct RuleFaces {
  std::string rule;  ///< symbol of the leaves: "Roof", "WindowGlass"
  std::uint32_t first = 0, count = 0;
};

/// LoD3 of a body.
struct Detail {
  /// The LoD2 solid with dormers, cross gables and openings. Faces of LoD2 come first, in their order, then those of dormers and
  /// cross gables, then reveals and what closes openings.
  /// Not closed: what rules for footprints made, in `rules`; then nothing but placements stands beside it, on its face 0.
  Solid solid;
  SolidTriangles triangles;
  std::vector<RuleFaces> rules;
  std::vector<Opening> openings;
  std::vector<Placement> placements;
  std::vector<WallInstallation> installations;
  std::vector<RoofElementKind>
      roof_elements;                   ///< dormers and cross gables that the solid has, in the order they were built
  std::vector<RoofFront> roof_fronts;  ///< theirs
  std::vector<RoofInstallation> roof_installations;  ///< chimneys, roof windows, with their triangles
};

}  // namespace blockrand::model
