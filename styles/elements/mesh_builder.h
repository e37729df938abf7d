// Puts an element's mesh together, face by face.
#pragma once

#include <map>
#include <span>

#include "styles/elements/built_element.h"
#include "styles/elements/flat_shapes.h"

namespace blockrand::elements {

/// m. Surfaces that look the same way and overlap lie at least this far apart, and what stands on the wall begins this
/// deep inside of it: nothing is coplanar with the wall or its neighbour, so nothing flickers (a 24-bit depth buffer
/// from 1 m to 1 km tells 5 mm apart up to about 290 m).
inline constexpr double kApart = 0.005;

/// Sides of a box, to say which are left out because they are never seen.
inline constexpr unsigned kLeft = 1, kRight = 2, kBottom = 4, kTop = 8, kBack = 16, kFront = 32;

class MeshBuilder {
 public:
  /// Faces added from now on share corners with one another and with none before: a body of its own.
  void begin_body() { corner_at_.clear(); }

  /// A plane convex polygon, counter-clockwise seen from outside. Corners that repeat are dropped; fewer than three
  /// make no face.
  void face(std::span<const model::Point3> corners, Part part);

  /// A polygon with holes in the plane `z`, looking along +z, cut into convex faces.
  /// \return false when the loops cross or touch; nothing is added then
  bool plate(const Outline& outer, std::span<const Outline> holes, double z, Part part);

  /// The upright sides of a convex or other polygon between two depths, looking away from the polygon's inside.
  void rim(const Outline& outline, double z_front, double z_back, Part part);
  /// The same looking inwards: the sides of a hole.
  void recess(const Outline& outline, double z_front, double z_back, Part part);

  /// An axis-parallel box.
  void box(model::Point3 least, model::Point3 most, Part part, unsigned hidden = 0);

  /// A closed prism: a convex outline from `z_back` to `z_front`.
  void prism(const Outline& convex, double z_front, double z_back, Part part);

  /// Another mesh, moved.
  void append(const ElementMesh& mesh, model::Point3 by = {});

  /// What is there so far.
  const ElementMesh& mesh() const { return mesh_; }
  ElementMesh take();

 private:
  ElementMesh mesh_;
  std::map<model::Point3, std::uint32_t> corner_at_;
};

}  // namespace blockrand::elements
