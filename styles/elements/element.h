// A facade element: one distinct window, door, cornice piece. Stored once, placed many times.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/point.h"

namespace blockrand::elements {

/// What a face of an element is, for looks and for semantics.
enum class Part : std::uint8_t {
  frame,     ///< window and door frames, bars, transoms
  glass,
  leaf,      ///< door leaves, gates, shutters
  surround,  ///< bands, mouldings, pediments, pilasters: the wall's trim
  sill,
  wall,      ///< in the colour of the wall: plinths, bosses
  metal,     ///< railings, brackets
  panel,     ///< spandrels, shop signs
};
inline constexpr int kPartCount = 8;

/// A plane convex polygon without holes, counter-clockwise seen from outside; indices into ElementMesh::vertices.
struct ElementFace {
  std::uint32_t first = 0, count = 0;  ///< into ElementMesh::indices
  Part part = Part::frame;
};

/// Coordinates in metres in the element's own frame: x to the viewer's right along the wall, y up, z out of the wall; the
/// origin lies in the middle of the lower edge of what the element stands on, in the wall's plane. An opening's reveal goes
/// towards negative z.
struct ElementMesh {
  std::vector<model::Point3> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<ElementFace> faces;
};

/// The semantic class, as CityGML knows it.
enum class ElementClass : std::uint8_t {
  window,        ///< stands in an opening
  door,          ///< stands in an opening: doors, gates, carriage gateways
  installation,  ///< on the wall: cornices, surrounds, balconies
};

/// The hole that an element needs in the wall: its outline in the wall's plane (x right, y up, counter-clockwise, straight
/// pieces), and how deep the reveal is. Solids get wall, reveal faces and, at the reveal's end, the opening's polygon.
struct OpeningOutline {
  std::vector<model::Point2> outline;
  double reveal = 0;  ///< m, from the wall's plane to the plane of window or door; 0: flush
};

/// One distinct element.
struct Element {
  std::string name;   ///< for people: "double casement 1.10 x 2.20, segmental head"
  std::string kind;   ///< the generator's name: "double_casement"
  ElementClass semantic = ElementClass::installation;
  OpeningOutline opening;  ///< empty outline for installations
  ElementMesh mesh;
};

}  // namespace blockrand::elements
