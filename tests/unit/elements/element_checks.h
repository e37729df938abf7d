// What every element must be: plane convex faces, one orientation, closed trim, no flicker, covered openings.
#pragma once

#include <string>
#include <vector>

#include "styles/elements/built_element.h"
#include "styles/elements/element_catalogue.h"

namespace blockrand::elements::checks {

/// What is wrong with the faces: not finite, not plane (1e-6 m), not strictly convex, degenerate, an edge used twice in
/// one direction or more than twice. Empty when all is well.
std::string faces_wrong(const ElementMesh& mesh);

/// Bodies are sets of faces that share vertices; true per body where every edge has two faces.
struct Body {
  std::vector<std::uint32_t> faces;  ///< into mesh.faces
  bool closed = false;
};
std::vector<Body> bodies(const ElementMesh& mesh);

/// Volume of a closed body, m³: positive when its faces look outwards.
double volume(const ElementMesh& mesh, const Body& body);

/// The judge of solids on a closed body, on the 1/1024 m grid; "none" when sound.
std::string solid_defect(const ElementMesh& mesh, const Body& body);

/// Two faces that look the same way, overlap by more than 5 cm², and lie nearer than 3 mm: they would flicker.
/// Backs of trim inside the wall and what lies on the ground are never seen. Empty when none.
std::string flicker(const ElementMesh& mesh);

/// A place of the opening that one sees through from in front; empty when none (places on a grid).
std::string open_place(const Element& element);

}  // namespace blockrand::elements::checks
