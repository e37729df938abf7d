// Geometry of a shape: polygons with holes, in the coordinates of the shape's scope.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace blockrand::grammar {

/// CGA's axes: right-handed, y up, metres (docs/rule_language.md §0). Inside a scope x runs along, y up, z out of it.
struct Vector3 {
  double x = 0, y = 0, z = 0;
  bool operator==(const Vector3&) const = default;
};
struct Vector2 {
  double x = 0, y = 0;
  bool operator==(const Vector2&) const = default;
};

/// One corner of a face: a vertex, and what belongs to the corner alone. The edge that starts here carries its tags.
struct Corner {
  std::uint32_t vertex = 0;
  std::uint16_t edge_tags = 0;  ///< index into Mesh::tag_sets; 0 is none
};

/// A plane polygon. The first loop is the outline, counter-clockwise seen from where the normal points to; holes
/// follow, clockwise. The first corner of the outline starts the face's *first edge*, which decides scopes of
/// components (docs/rule_language.md §7.2, 2); every operation says which edge is first.
struct MeshFace {
  std::vector<std::vector<Corner>> loops;
  std::uint16_t tags = 0;      ///< index into Mesh::tag_sets; 0 is none
  std::uint16_t material = 0;  ///< 0: the shape's own material
};

/// UV coordinates of one set: per face, per loop, per corner, as MeshFace::loops is laid out; empty when the set has
/// none.
using UvSet = std::vector<std::vector<std::vector<Vector2>>>;
inline constexpr int kUvSetCount = 10;

/// A polygon mesh. Vertices are shared where faces meet: edges, borders and connected sets are told by their indices.
struct Mesh {
  std::vector<Vector3> vertices;
  std::vector<MeshFace> faces;
  std::array<UvSet, kUvSetCount> uv;
  std::vector<std::vector<std::string>> tag_sets{{}};  ///< entry 0 is the empty set
  std::string asset;  ///< the stem of the asset's name that this stands for (`i`); empty for everything else

  bool empty() const { return faces.empty(); }
};

/// A mesh of one polygon of few corners without holes, tags, uv and asset, its first corner at the first edge: what most
/// pieces of facades are.
struct SmallFace {
  static constexpr std::size_t kMostCorners = 4;
  std::array<Vector3, kMostCorners> points;
  std::uint8_t size = 0;  ///< corners; 0: no polygon
  std::uint16_t material = 0;
  bool operator==(const SmallFace&) const = default;
};

/// Shared between shapes and never changed once shared: operations make a new one. A small face lies in the pointer
/// itself and becomes a mesh once somebody looks at it, which is why one pointer is not for several threads.
class MeshPointer {
 public:
  MeshPointer() = default;
  MeshPointer(std::nullptr_t) {}
  MeshPointer(std::shared_ptr<const Mesh> mesh) : mesh_(std::move(mesh)) {}
  MeshPointer(std::shared_ptr<Mesh> mesh) : mesh_(std::move(mesh)) {}
  /// \param face  three corners at least
  MeshPointer(const SmallFace& face) : face_(face) {}

  explicit operator bool() const { return face_.size > 0 || mesh_ != nullptr; }
  const Mesh& operator*() const { return mesh_ ? *mesh_ : made(); }
  const Mesh* operator->() const { return &**this; }
  /// Null where it is not one, or is not known to be one.
  const SmallFace* small() const { return face_.size > 0 ? &face_ : nullptr; }
  friend bool operator==(const MeshPointer& a, const MeshPointer& b) {
    return a.face_.size > 0 || b.face_.size > 0 ? a.face_ == b.face_ : a.mesh_ == b.mesh_;
  }
  friend bool operator==(const MeshPointer& a, std::nullptr_t) { return !a; }

 private:
  const Mesh& made() const;

  mutable std::shared_ptr<const Mesh> mesh_;
  SmallFace face_;
};

}  // namespace blockrand::grammar
