// What every operation needs of a mesh: boxes, normals, edges and their faces, loops out of loose edges, fitted scopes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "styles/grammar/shapes/scope.h"
#include "styles/grammar/shapes/shape.h"
#include "styles/grammar/shapes/shape_mesh.h"

namespace blockrand::grammar {

using Loop = std::vector<Corner>;

struct Box {
  Vector3 low, high;
  bool empty = true;
  void add(Vector3 p);
  Vector3 extent() const { return empty ? Vector3{} : high - low; }
};
Box box_of(std::span<const Vector3> points);
/// Of the vertices that faces use.
Box box_of(const Mesh& mesh);

/// Newell's vector of a loop: along its normal, twice as long as its area.
Vector3 area_vector(const Mesh& mesh, const Loop& loop);
/// Of all loops together: holes are taken off.
Vector3 area_vector(const Mesh& mesh, const MeshFace& face);
/// Length one; zero for faces without area.
Vector3 face_normal(const Mesh& mesh, const MeshFace& face);
double face_area(const Mesh& mesh, const MeshFace& face);
/// m³, signed: positive when faces of a closed mesh look outwards.
double signed_volume(const Mesh& mesh);
/// Mean of the vertices of the outline.
Vector3 face_middle(const Mesh& mesh, const MeshFace& face);

/// One side of an edge: the face that runs along it.
struct EdgeSide {
  std::uint32_t low = 0, high = 0;  ///< vertices, low < high
  std::uint32_t face = 0, loop = 0, corner = 0;
  bool forward = true;  ///< the face runs from low to high
};
/// All sides of edges, those of one edge next to each other, ordered by low, high, face, loop, corner.
std::vector<EdgeSide> edge_sides(const Mesh& mesh);
/// Every edge is run along as often in one direction as in the other, and there are faces.
bool is_closed(const Mesh& mesh);

/// An edge on the way from `from` to `to`, with what the loop keeps of it.
struct LooseEdge {
  std::uint32_t from = 0, to = 0;
  std::uint16_t tags = 0;
  std::uint32_t order = 0;  ///< loops start at their edge of the least order
};
/// Faces, counter-clockwise about `normal`, that the edges bound: edges that run along each other in opposite
/// directions cancel; loops that run clockwise are holes of the loop around them. Edges that do not close are left out.
std::vector<MeshFace> faces_of_edges(const std::vector<Vector3>& vertices, std::vector<LooseEdge> edges,
                                     Vector3 normal);

/// The face looking the other way; its first edge is the same one (docs/rule_language.md §2.6). `uv`, when given,
/// follows.
void reverse_face(MeshFace& face, std::vector<std::vector<Vector2>>* uv = nullptr);
void reverse_faces(Mesh& mesh);

/// Index of the tag set that has all of set `tags` and `tag`.
std::uint16_t add_tag(Mesh& mesh, std::uint16_t tags, std::string_view tag);

/// The uv loops of a face, or null when the set has none for it.
const std::vector<std::vector<Vector2>>* uv_of(const Mesh& mesh, int set, std::size_t face);

/// Copies the faces listed (with tags, materials, uv) to a new mesh with only the vertices in use.
Mesh extract_faces(const Mesh& mesh, std::span<const std::uint32_t> faces);
/// Adds faces and vertices of `other` without sharing vertices.
void append(Mesh& mesh, const Mesh& other);
/// Drops vertices that no face uses.
void drop_unused_vertices(Mesh& mesh);
/// Vertices nearer than `tolerance` become one; corners that follow each other on one vertex become one; loops of less
/// than three corners go, and faces without outline.
void weld(Mesh& mesh, double tolerance);
/// Puts vertices that lie on an edge of another face's border into that edge, so that faces that touch share edges.
void join_borders(Mesh& mesh, double tolerance);
/// Removes loops of fewer than three corners and faces without outlines, with their uv.
void drop_broken_faces(Mesh& mesh);

/// Transforms all vertices into the frame `inner`, which is given in the present one.
void into_frame(Mesh& mesh, const Frame& inner);

/// The shape gets this geometry, given in the shape's scope; the scope moves and resizes to the geometry's box. Sizes
/// that were negative stay so. An empty mesh leaves the scope as it is.
void take_mesh(Shape& shape, Mesh mesh);
/// The same of a small face.
void take_face(Shape& shape, SmallFace face);
/// As take_mesh, for a scope that is turned to `inner` (given in the present scope) first.
void take_mesh_in_frame(Shape& shape, Mesh mesh, const Frame& inner);
/// The shape gets this geometry; the scope stays.
void keep_scope(Shape& shape, Mesh mesh);

/// A right-handed frame with y along `up` and x as near to `x_hint` as can be (then z, then x of the frame above).
Frame frame_with_y(Vector3 origin, Vector3 up, Vector3 x_hint);
/// A right-handed frame with z along `out` and x as near to `x_hint` as can be.
Frame frame_with_z(Vector3 origin, Vector3 out, Vector3 x_hint);

/// The shape's mesh, or an empty one.
const Mesh& mesh_of(const Shape& shape);

}  // namespace blockrand::grammar
