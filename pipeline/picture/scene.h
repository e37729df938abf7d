// What is to be seen: triangles and the ground they stand on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/base/pack.h"
#include "pipeline/model/colour.h"
#include "pipeline/model/point.h"
#include "pipeline/model/solid.h"

namespace blockrand::picture {

using model::Colour;
using model::Point3;

/// Axis-parallel box in the scene's coordinates.
struct Box {
  Point3 min, max;
  bool empty = true;
  void include(Point3 p);
  std::array<Point3, 8> corners() const;
  Point3 centre() const;
};

/// A collection of surfaces in metres, x east, y north, z up. Positions are kept relative to `origin` in single
/// precision: within 8 km of it they are exact to half a millimetre.
class Scene {
 public:
  /// \param origin  near the middle of what will be added, in the coordinates of what will be added
  explicit Scene(Point3 origin = {}) : origin_(origin) {}

  /// The faces of a closed solid in their own colours, moved by `offset`.
  /// \param object  faces of different objects are told apart by a line, where lines are drawn
  void add(const model::Solid& solid, const model::SolidTriangles& triangles, std::uint32_t object, Point3 offset = {});
  /// As above, all faces in one colour.
  void add(const model::Solid& solid, const model::SolidTriangles& triangles, std::uint32_t object, Point3 offset,
           Colour colour);
  /// As the first, without some faces. \param hidden  by face; empty: none
  void add_without(const model::Solid& solid, const model::SolidTriangles& triangles, const std::vector<bool>& hidden,
                   std::uint32_t object);
  /// A triangle of a closed surface: seen from where its corners run counter-clockwise. Degenerate ones are left out.
  void add_outside(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object);
  /// A triangle that is seen from both sides. Degenerate triangles are left out.
  void add_triangle(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object);
  /// As above with a colour per corner, blended in between (heat maps).
  void add_blended_triangle(const std::array<Point3, 3>& corners, const std::array<Colour, 3>& colours,
                            std::uint32_t object);
  /// A horizontal plane without end, that receives shadows. Seen from above only.
  void set_ground(double z, Colour colour);
  /// Everything of `other`, whose origin must be the same, its objects renumbered by adding `first_object`.
  void append(const Scene& other, std::uint32_t first_object = 0);
  /// Likewise without some objects. \param hidden  by object of `other`; what lies behind its end comes along
  void append_without(const Scene& other, const std::vector<bool>& hidden);
  /// Room for so many triangles more.
  void reserve(std::size_t triangles) { triangles_.reserve(triangles_.size() + triangles); }

  Point3 origin() const { return origin_; }
  /// Of the triangles, in the coordinates of what was added.
  Box bounds() const;
  bool empty() const { return triangles_.empty(); }
  std::size_t triangle_count() const { return triangles_.size(); }
  /// Every corner of every triangle, in the coordinates of what was added: fits cameras tighter than bounds().
  std::vector<Point3> points() const;

  // ---- for the renderer: positions relative to the origin

  struct Vector {
    float x = 0, y = 0, z = 0;
  };
  /// What the triangles of a plane piece of surface have in common.
  struct Face {
    Vector normal;  ///< unit, towards the side from which the corners run counter-clockwise
    Colour colour;
    bool closed = false;  ///< of a solid: never seen from behind
    std::uint32_t object = 0;
    std::uint32_t blend = kNoBlend;  ///< of a face whose corners differ in colour: into blends()
  };
  struct Triangle {
    std::array<Vector, 3> corners;
    std::uint32_t face = 0;  ///< into faces()
  };
  /// A face of one triangle whose corners differ in colour.
  struct Blend {
    std::array<Vector, 3> corners;
    std::array<Colour, 3> colours;
  };
  static constexpr std::uint32_t kNoBlend = 0xffffffff;
  struct Ground {
    double z = 0;  ///< relative to the origin
    Colour colour;
  };
  std::span<const Triangle> triangles() const { return triangles_; }
  std::span<const Face> faces() const { return faces_; }
  std::span<const Blend> blends() const { return blends_; }
  const std::optional<Ground>& ground() const { return ground_; }

 private:
  friend struct base::PackTraits<Scene>;
  Vector local(Point3 p) const;
  /// A triangle of its own, or of the last face where it goes on in its plane.
  void push(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object, bool closed);
  /// The triangles of a solid's face. \param t  number of the face
  void push_face(const model::Solid& solid, const model::SolidTriangles& triangles, std::size_t t, Point3 offset,
                 Colour colour, std::uint32_t object);

  /// All of `other` but its triangles.
  void append_faces(const Scene& other, std::uint32_t first_object);
  /// \throws base::UnpackError  a triangle has no face, or a face no blend
  void check() const;

  Point3 origin_;
  std::vector<Triangle> triangles_;
  std::vector<Face> faces_;
  std::vector<Blend> blends_;
  std::optional<Ground> ground_;
};

}  // namespace blockrand::picture

/// Triangles as they lie.
template <>
struct blockrand::base::PackTraits<blockrand::picture::Scene> {
  static void pack(Packer& out, const picture::Scene& scene) {
    out << scene.origin_ << scene.triangles_ << scene.faces_ << scene.blends_ << scene.ground_;
  }
  static void unpack(Unpacker& in, picture::Scene& scene) {
    in >> scene.origin_ >> scene.triangles_ >> scene.faces_ >> scene.blends_ >> scene.ground_;
    scene.check();
  }
};
