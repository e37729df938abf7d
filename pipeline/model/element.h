// A facade element: one distinct window, door, cornice piece. Stored once, placed many times.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/point.h"

namespace blockrand::model {

// X(identifier, name)
#define BLOCKRAND_ELEMENT_PARTS(X) \
  X(frame, "frame")                \
  X(glass, "glass")                \
  X(leaf, "leaf") X(surround, "surround") X(sill, "sill") X(wall, "wall") X(metal, "metal") X(panel, "panel")

/// What a face of an element is, for looks and for semantics: `frame` of windows and doors with bars and transoms;
/// `glass`; door `leaf`s, gates, shutters; `surround`: bands, mouldings, pediments, pilasters, the wall's trim; `sill`;
/// `wall`: what has the colour of the wall, plinths, bosses; `metal`: railings, brackets; `panel`: spandrels, shop
/// signs.
enum class ElementPart : std::uint8_t {
#define X(id, text) id,
  BLOCKRAND_ELEMENT_PARTS(X)
#undef X
};
inline constexpr std::string_view kElementPartNames[] = {
#define X(id, text) text,
    BLOCKRAND_ELEMENT_PARTS(X)
#undef X
};
inline constexpr int kElementPartCount = sizeof(kElementPartNames) / sizeof(kElementPartNames[0]);
constexpr std::string_view name(ElementPart part) { return kElementPartNames[static_cast<int>(part)]; }

/// A plane convex polygon without holes, counter-clockwise seen from outside.
struct ElementFace {
  std::uint32_t first = 0, count = 0;  ///< into ElementMesh::indices
  ElementPart part = ElementPart::frame;
};

/// Coordinates in metres in the element's own frame: x to the viewer's right along the wall, y up, z out of the wall;
/// the origin lies in the middle of the lower edge of what the element stands on, in the wall's plane. An opening's
/// reveal goes towards negative z.
struct ElementMesh {
  std::vector<Point3> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<ElementFace> faces;
};

/// The semantic class, as CityGML knows it.
enum class ElementClass : std::uint8_t {
  window,        ///< stands in an opening
  door,          ///< stands in an opening: doors, gates, carriage gateways
  installation,  ///< on the wall: cornices, surrounds, balconies
};

/// The hole that an element needs in the wall: its outline in the wall's plane (x right, y up, counter-clockwise,
/// straight pieces), and how deep the reveal is. Solids get wall, reveal faces and, at the reveal's end, the opening's
/// polygon.
struct OpeningOutline {
  std::vector<Point2> outline;
  double reveal = 0;  ///< m, from the wall's plane to the plane of window or door; 0: flush
};

/// One distinct element.
struct Element {
  std::string name;  ///< for people: "double casement 1.10 x 2.20, segmental head"
  std::string kind;  ///< the generator's name: "double_casement"
  ElementClass semantic = ElementClass::installation;
  OpeningOutline opening;  ///< empty outline for installations
  ElementMesh mesh;
};

/// How the faces of a part look.
struct PartMaterial {
  std::uint8_t material = 0;  ///< index into Region::materials
  Colour colour;
  bool operator==(const PartMaterial&) const = default;
};

/// An element in its colours: what a tile stores once and places.
struct ColouredElement {
  std::shared_ptr<const Element> element;
  std::array<PartMaterial, kElementPartCount> materials;  ///< by ElementPart
};

}  // namespace blockrand::model
