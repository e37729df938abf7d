#include "styles/grammar/shapes/measure.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

double degrees_between(Vector3 a, Vector3 b) {
  return base::atan2(length(cross(a, b)), dot(a, b)) * base::kDegreesPerRadian;
}

std::vector<const std::vector<std::string>*> tag_lists(const Mesh& mesh) {
  std::vector<const std::vector<std::string>*> out;
  for (const MeshFace& face : mesh.faces) {
    out.push_back(&mesh.tag_sets[face.tags]);
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) out.push_back(&mesh.tag_sets[c.edge_tags]);
  }
  return out;
}

/// Metres on the surface per unit of the coordinate, weighted by area: the gradient's inverse.
double uv_scale(const Mesh& mesh, bool v, int set) {
  double sum = 0, weight = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto* uv = uv_of(mesh, set, f);
    if (uv == nullptr || uv->empty()) continue;
    const Loop& loop = mesh.faces[f].loops[0];
    const auto& ring = (*uv)[0];
    for (std::size_t i = 1; i + 1 < loop.size() && i + 1 < ring.size(); ++i) {
      const Vector3 a = mesh.vertices[loop[i].vertex] - mesh.vertices[loop[0].vertex];
      const Vector3 b = mesh.vertices[loop[i + 1].vertex] - mesh.vertices[loop[0].vertex];
      const Vector2 p{ring[i].x - ring[0].x, ring[i].y - ring[0].y},
          q{ring[i + 1].x - ring[0].x, ring[i + 1].y - ring[0].y};
      const double det = p.x * q.y - p.y * q.x;
      if (std::fabs(det) < 1e-15) continue;
      // d position / d u with v held, and the other way round.
      const Vector3 step = v ? (b * p.x - a * q.x) * (1 / det) : (a * q.y - b * p.y) * (1 / det);
      const double area = length(cross(a, b));
      sum += length(step) * area;
      weight += area;
    }
  }
  return weight > 0 ? sum / weight : 0;
}

struct Range {
  double low = 0, high = 0;
  bool any = false;
};
Range uv_range_of(const Mesh& mesh, bool v, int set) {
  Range out;
  if (set < 0 || set >= kUvSetCount) return out;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto* uv = uv_of(mesh, set, f);
    if (uv == nullptr) continue;
    for (const auto& ring : *uv)
      for (const Vector2 p : ring) {
        const double c = v ? p.y : p.x;
        out.low = out.any ? std::min(out.low, c) : c;
        out.high = out.any ? std::max(out.high, c) : c;
        out.any = true;
      }
  }
  return out;
}

}  // namespace

double geometry_area(const Shape& shape) {
  const Mesh& mesh = mesh_of(shape);
  double sum = 0;
  for (const MeshFace& face : mesh.faces) sum += face_area(mesh, face);
  return sum;
}

std::optional<double> geometry_area(const Shape& shape, std::string_view selector) {
  const auto parsed = selector_of_word(selector);
  if (!parsed) return {};
  const Mesh& mesh = mesh_of(shape);
  double sum = 0;
  for (const MeshFace& face : mesh.faces)
    if (direction_selected(shape, face_normal(mesh, face), *parsed)) sum += face_area(mesh, face);
  return sum;
}

double geometry_volume(const Shape& shape) {
  const Mesh& mesh = mesh_of(shape);
  return is_closed(mesh) ? std::fabs(signed_volume(mesh)) : 0;
}

double geometry_height(const Shape& shape) {
  const Mesh& mesh = mesh_of(shape);
  if (mesh.faces.empty()) return 0;
  const Frame world = scope_in_world(shape);
  double low = 1e300, high = -1e300;
  for (const Vector3 p : mesh.vertices) {
    const double y = place(world, p).y;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return high - low;
}

double geometry_boundary_length(const Shape& shape) {
  const Mesh& mesh = mesh_of(shape);
  const auto sides = edge_sides(mesh);
  double sum = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool as_before = i > 0 && sides[i - 1].low == sides[i].low && sides[i - 1].high == sides[i].high;
    const bool as_next = i + 1 < sides.size() && sides[i + 1].low == sides[i].low && sides[i + 1].high == sides[i].high;
    if (!as_before && !as_next) sum += length(mesh.vertices[sides[i].high] - mesh.vertices[sides[i].low]);
  }
  return sum;
}

std::int64_t geometry_face_count(const Shape& shape) { return static_cast<std::int64_t>(mesh_of(shape).faces.size()); }

std::int64_t geometry_edge_count(const Shape& shape) {
  const auto sides = edge_sides(mesh_of(shape));
  std::int64_t count = 0;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (i == 0 || sides[i - 1].low != sides[i].low || sides[i - 1].high != sides[i].high) ++count;
  return count;
}

std::int64_t geometry_vertex_count(const Shape& shape) {
  const Mesh& mesh = mesh_of(shape);
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const MeshFace& face : mesh.faces)
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) used[c.vertex] = true;
  return std::count(used.begin(), used.end(), true);
}

std::int64_t geometry_hole_count(const Shape& shape) {
  std::int64_t count = 0;
  for (const MeshFace& face : mesh_of(shape).faces) count += static_cast<std::int64_t>(face.loops.size()) - 1;
  return count;
}

bool geometry_is_concave(const Shape& shape) {
  const Mesh& mesh = mesh_of(shape);
  for (const MeshFace& face : mesh.faces) {
    if (face.loops.size() > 1) return true;
    const Vector3 normal = face_normal(mesh, face);
    const Loop& loop = face.loops[0];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector3 a = mesh.vertices[loop[i].vertex], b = mesh.vertices[loop[(i + 1) % loop.size()].vertex],
                    c = mesh.vertices[loop[(i + 2) % loop.size()].vertex];
      if (dot(normalized(cross(b - a, c - b)), normal) < -0.5 &&
          length(cross(normalized(b - a), normalized(c - b))) > 1e-6)
        return true;
    }
  }
  return false;
}

bool geometry_is_planar(const Shape& shape, double tolerance_degrees) {
  const Mesh& mesh = mesh_of(shape);
  if (mesh.faces.empty()) return false;
  constexpr double kLeast = 1e-4;  // degrees: rounding
  const double tolerance = std::max(kLeast, tolerance_degrees);
  for (const MeshFace& face : mesh.faces) {
    const Vector3 normal = face_normal(mesh, face);
    const Loop& loop = face.loops[0];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector3 a = mesh.vertices[loop[i].vertex], b = mesh.vertices[loop[(i + 1) % loop.size()].vertex];
      if (std::fabs(90 - degrees_between(b - a, normal)) > tolerance) return false;
    }
  }
  return true;
}

bool geometry_is_rectangular(const Shape& shape, double tolerance_degrees) {
  const Mesh& mesh = mesh_of(shape);
  if (mesh.faces.empty()) return false;
  constexpr double kLeast = 1e-4;
  const double tolerance = std::max(kLeast, tolerance_degrees);
  for (const MeshFace& face : mesh.faces) {
    if (face.loops.size() != 1) return false;
    // Vertices on a straight edge are no corners: neighbours put them there.
    constexpr double kStraight = 1e-3;  // degrees
    const Loop& loop = face.loops[0];
    int corners = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector3 a = mesh.vertices[loop[i].vertex], b = mesh.vertices[loop[(i + 1) % loop.size()].vertex],
                    c = mesh.vertices[loop[(i + 2) % loop.size()].vertex];
      const double angle = degrees_between(a - b, c - b);
      if (angle > 180 - kStraight) continue;
      if (std::fabs(90 - angle) > tolerance) return false;
      ++corners;
    }
    if (corners != 4) return false;
  }
  return true;
}

bool geometry_is_closed(const Shape& shape) { return is_closed(mesh_of(shape)); }

std::optional<bool> geometry_is_oriented(const Shape& shape, std::string_view selector) {
  const auto parsed = selector_of_word(selector);
  if (!parsed) return {};
  const Mesh& mesh = mesh_of(shape);
  return std::any_of(mesh.faces.begin(), mesh.faces.end(),
                     [&](const MeshFace& face) { return direction_selected(shape, face_normal(mesh, face), *parsed); });
}

std::optional<double> geometry_angle(const Shape& shape, std::string_view word) {
  const Mesh& mesh = mesh_of(shape);
  const Frame world = scope_in_world(shape);
  if (word != "maxSlope" && word != "azimuth" && word != "zenith") return {};
  double steepest = 0;
  for (const MeshFace& face : mesh.faces) {
    const Vector3 n = turn(world, face_normal(mesh, face));
    if (n == Vector3{}) continue;
    const double across = std::sqrt(n.x * n.x + n.z * n.z);
    if (word == "azimuth") {
      // Clockwise from north, which is -z.
      const double angle = base::atan2(n.x, -n.z) * base::kDegreesPerRadian;
      return angle < 0 ? angle + 360 : angle;
    }
    if (word == "zenith") return base::atan2(across, n.y) * base::kDegreesPerRadian;
    steepest = std::max(steepest, base::atan2(across, std::fabs(n.y)) * base::kDegreesPerRadian);
  }
  return steepest;
}

double geometry_uv_extent(const Shape& shape, bool v, bool unit_space, int set) {
  const Mesh& mesh = mesh_of(shape);
  const Range range = uv_range_of(mesh, v, set);
  if (!range.any) return 0;
  return (range.high - range.low) * (unit_space ? uv_scale(mesh, v, set) : 1);
}
double geometry_uv_minimum(const Shape& shape, bool v, int set) { return uv_range_of(mesh_of(shape), v, set).low; }
double geometry_uv_maximum(const Shape& shape, bool v, int set) { return uv_range_of(mesh_of(shape), v, set).high; }
bool geometry_has_uvs(const Shape& shape, int set) { return uv_range_of(mesh_of(shape), false, set).any; }

bool geometry_is_tagged(const Shape& shape, std::string_view query) { return !geometry_tags(shape, query).empty(); }

std::vector<std::string> geometry_tags(const Shape& shape, std::string_view query) {
  std::set<std::string> out;
  for (const auto* list : tag_lists(mesh_of(shape)))
    for (const std::string& tag : *list)
      if (tag_matches(query, tag)) out.insert(tag);
  return {out.begin(), out.end()};
}

std::vector<std::string> geometry_materials(const Shape& shape) {
  std::set<std::uint16_t> ids;
  for (const MeshFace& face : mesh_of(shape).faces) ids.insert(face.material);
  std::vector<std::string> out;
  for (const std::uint16_t id : ids) out.push_back(id == 0 ? "shape" : "material_" + std::to_string(id));
  return out;
}

}  // namespace blockrand::grammar
