#include "styles/grammar/shapes/occlusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "styles/grammar/shapes/mesh_triangles.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::grammar {

namespace {

/// Pieces of less area say nothing; m².
constexpr double kLeastArea = 1e-6;
/// Most pieces that one piece of geometry is cut into: bounds the work against something like a sphere.
constexpr std::size_t kMostPieces = 20000;

using Polygon = std::vector<Vector3>;

Box box_of_polygon(const Polygon& polygon) { return box_of(std::span<const Vector3>(polygon)); }

double area_of(const Polygon& p) {
  Vector3 sum;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum = sum + cross(p[i] - p[0], p[i + 1] - p[0]);
  return length(sum) / 2;
}

/// Both sides of a convex polygon; false when it does not cross the plane.
bool cut_polygon(const Polygon& polygon, Vector3 normal, double offset, Polygon& front, Polygon& behind) {
  bool before = false, beyond = false;
  std::vector<double> distances;
  for (const Vector3 p : polygon) {
    const double d = dot(normal, p) - offset;
    distances.push_back(d);
    before = before || d > kContact;
    beyond = beyond || d < -kContact;
  }
  if (!before || !beyond) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    const double a = distances[i], b = distances[next];
    if (a >= 0) front.push_back(polygon[i]);
    if (a <= 0) behind.push_back(polygon[i]);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      const Vector3 p = polygon[i] + (polygon[next] - polygon[i]) * (a / (a - b));
      front.push_back(p);
      behind.push_back(p);
    }
  }
  return front.size() > 2 && behind.size() > 2;
}

/// Distance of a point to a triangle.
double distance_to(Vector3 p, Vector3 a, Vector3 b, Vector3 c) {
  const Vector3 normal = normalized(cross(b - a, c - a));
  const double off = dot(normal, p - a);
  const Vector3 foot = p - normal * off;
  const Vector3 corners[3] = {a, b, c};
  bool inside = length(normal) > 0;
  double nearest = length(p - a);
  for (int i = 0; i < 3; ++i) {
    const Vector3 from = corners[i], to = corners[(i + 1) % 3], along = to - from;
    inside = inside && dot(cross(along, foot - from), normal) >= 0;
    const double k = dot(along, along);
    const double t = k > 0 ? std::clamp(dot(p - from, along) / k, 0.0, 1.0) : 0;
    nearest = std::min(nearest, length(p - (from + along * t)));
  }
  return inside ? std::abs(off) : nearest;
}

enum class Side : std::uint8_t { in, out, on };

/// By the sum of the angles under which the surface is seen (van Oosterom, Strackee 1983): no ray that could hit an
/// edge.
Side side_of(Vector3 p, const Mesh& closed) {
  double sum = 0;
  for (const MeshFace& face : closed.faces) {
    const Loop& loop = face.loops.front();
    const Vector3 corners[3] = {closed.vertices[loop[0].vertex], closed.vertices[loop[1].vertex],
                                closed.vertices[loop[2].vertex]};
    if (distance_to(p, corners[0], corners[1], corners[2]) < kContact) return Side::on;
    const Vector3 a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
    const double la = length(a), lb = length(b), lc = length(c);
    sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  // Each atan2 is half a solid angle: 2 pi inside, 0 outside.
  return std::abs(sum) > std::numbers::pi ? Side::in : Side::out;
}

Mesh triangulated(const Mesh& mesh) {
  Mesh out;
  out.vertices = mesh.vertices;
  for (const MeshTriangle& triangle : triangles_of(mesh)) {
    MeshFace face;
    face.loops.push_back({{triangle.vertices[0], 0}, {triangle.vertices[1], 0}, {triangle.vertices[2], 0}});
    out.faces.push_back(std::move(face));
  }
  return out;
}

/// The nearest point of a box (a corner and three edges that are at right angles) to a point.
Vector3 nearest_in_box(const std::array<Vector3, 8>& box, Vector3 p) {
  Vector3 out = box[0];
  for (const int corner : {1, 2, 4}) {
    const Vector3 along = box[static_cast<std::size_t>(corner)] - box[0];
    const double k = dot(along, along);
    if (k > 0) out = out + along * std::clamp(dot(p - box[0], along) / k, 0.0, 1.0);
  }
  return out;
}

}  // namespace

bool boxes_meet(const Box& a, const Box& b) {
  if (a.empty || b.empty) return false;
  for (int i = 0; i < 3; ++i)
    if (component(a.low, i) > component(b.high, i) + kContact || component(b.low, i) > component(a.high, i) + kContact)
      return false;
  return true;
}

Mesh mesh_in_world(const Shape& shape) {
  Mesh out = mesh_of(shape);
  const Frame frame = scope_in_world(shape);
  for (Vector3& p : out.vertices) p = place(frame, p);
  return out;
}

Box box_in_world(const Shape& shape) {
  const Mesh& own = mesh_of(shape);
  const Frame frame = scope_in_world(shape);
  Box out;
  for (const MeshFace& face : own.faces)
    for (const Loop& loop : face.loops)
      for (const Corner& corner : loop) out.add(place(frame, own.vertices[corner.vertex]));
  return out;
}

std::array<Vector3, 8> scope_corners(const Shape& shape) {
  const Frame frame = scope_in_world(shape);
  std::array<Vector3, 8> out;
  for (std::size_t i = 0; i < 8; ++i)
    out[i] = place(frame,
                   {(i & 1) != 0 ? shape.size.x : 0, (i & 2) != 0 ? shape.size.y : 0, (i & 4) != 0 ? shape.size.z : 0});
  return out;
}

Occluder occluder_of(const Shape& shape) {
  Occluder out;
  out.scope_corners = scope_corners(shape);
  const Mesh& own = mesh_of(shape);
  if (own.empty() || !is_closed(own)) return out;
  out.mesh = triangulated(mesh_in_world(shape));
  out.box = box_of(out.mesh);
  return out;
}

Contact contact(const Mesh& mesh, const Occluder& other, Effort& effort) {
  Contact out;
  if (other.mesh.empty()) return {false, true, false};
  const Box own = box_of(mesh);
  if (!boxes_meet(own, other.box)) return {false, !own.empty, false};
  if (!effort.take(other.mesh.faces.size())) return out;
  struct Side_ {
    Vector3 normal;
    double offset;
    Box box;
  };
  std::vector<Side_> planes;
  for (const MeshFace& face : other.mesh.faces) {
    Box box;
    for (const Corner& corner : face.loops.front()) box.add(other.mesh.vertices[corner.vertex]);
    if (!boxes_meet(own, box)) continue;
    const Vector3 normal = face_normal(other.mesh, face);
    planes.push_back({normal, dot(normal, other.mesh.vertices[face.loops.front()[0].vertex]), box});
  }
  std::size_t count = 0;
  for (const MeshTriangle& triangle : triangles_of(mesh)) {
    std::vector<Polygon> pieces(1);
    for (const std::uint32_t vertex : triangle.vertices) pieces[0].push_back(mesh.vertices[vertex]);
    if (!boxes_meet(box_of_polygon(pieces[0]), other.box)) {
      out.beyond = true;
      continue;
    }
    for (const Side_& plane : planes) {
      const std::size_t now = pieces.size();
      for (std::size_t i = 0; i < now && count + pieces.size() < kMostPieces; ++i) {
        if (!effort.take(1)) return out;
        if (!boxes_meet(box_of_polygon(pieces[i]), plane.box)) continue;
        Polygon front, behind;
        if (!cut_polygon(pieces[i], plane.normal, plane.offset, front, behind)) continue;
        pieces[i] = std::move(front);
        pieces.push_back(std::move(behind));
      }
    }
    count += pieces.size();
    for (const Polygon& piece : pieces) {
      if (area_of(piece) < kLeastArea) continue;
      if (!effort.take(other.mesh.faces.size())) return out;
      Vector3 middle;
      for (const Vector3 p : piece) middle = middle + p;
      switch (side_of(middle * (1.0 / static_cast<double>(piece.size())), other.mesh)) {
        case Side::in:
          out.within = true;
          break;
        case Side::out:
          out.beyond = true;
          break;
        case Side::on:
          out.on_surface = true;
          break;
      }
    }
  }
  return out;
}

bool is_inside(const Mesh& mesh, const Occluder& other, Effort& effort) {
  if (other.mesh.empty() || mesh.empty() || !boxes_meet(box_of(mesh), other.box)) return false;
  const Contact found = contact(mesh, other, effort);
  return !effort.spent && !found.beyond && (found.within || found.on_surface);
}

bool overlaps(const Mesh& mesh, const Occluder& other, Effort& effort) {
  if (other.mesh.empty() || mesh.empty() || !boxes_meet(box_of(mesh), other.box)) return false;
  const Contact found = contact(mesh, other, effort);
  if (effort.spent) return false;
  if (found.within) return found.beyond;
  if (!is_closed(mesh)) return false;
  // The other one may lie in this one, wholly or in part, or both may be the same.
  Occluder self;
  self.mesh = triangulated(mesh);
  self.box = box_of(mesh);
  const Contact back = contact(other.mesh, self, effort);
  return !effort.spent && back.within;
}

bool touches(const Mesh& mesh, const Occluder& other, Effort& effort) {
  if (other.mesh.empty() || mesh.empty() || !boxes_meet(box_of(mesh), other.box)) return false;
  const bool against = contact(mesh, other, effort).on_surface;
  return !effort.spent && (against || overlaps(mesh, other, effort));
}

double box_distance(const std::array<Vector3, 8>& a, const std::array<Vector3, 8>& b) {
  // Alternating projection: the pair of nearest points of two convex bodies (Cheney, Goldstein 1959).
  constexpr int kRounds = 1000;
  constexpr double kStill = 1e-9;  // m
  Vector3 p = (a[0] + a[7]) * 0.5;
  double distance = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Vector3 q = nearest_in_box(b, p), next = nearest_in_box(a, q);
    distance = length(q - next);
    if (length(next - p) < kStill) break;
    p = next;
  }
  return distance < kContact ? 0 : distance;
}

}  // namespace blockrand::grammar
