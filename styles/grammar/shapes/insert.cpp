#include "styles/grammar/shapes/insert.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/mesh_cut.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

constexpr double kFlat = 1e-9;  ///< m: thinner boxes have no thickness

struct Filler {
  Mesh mesh;
  std::uint32_t vertex(Vector3 p) {
    mesh.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  }
  void face(const std::vector<std::uint32_t>& vertices, std::vector<Vector2> uv) {
    MeshFace out;
    out.loops.emplace_back();
    for (const std::uint32_t v : vertices) out.loops[0].push_back({v, 0});
    mesh.faces.push_back(std::move(out));
    mesh.uv[0].push_back({std::move(uv)});
  }
};

const std::vector<Vector2> kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/// Points of a circle in the box from 0 to 1, counter-clockwise seen from above, the first at +x.
std::vector<Vector3> circle(int sides, double y, double radius = 0.5) {
  std::vector<Vector3> out;
  for (int i = 0; i < sides; ++i) {
    const auto turned = base::sin_cos(2 * base::kPi * i / sides);
    out.push_back({0.5 + radius * turned.cos, y, 0.5 - radius * turned.sin});
  }
  return out;
}

Vector2 from_above(Vector3 p) { return {p.x, 1 - p.z}; }

void scale(Mesh& mesh, Vector3 k) {
  for (Vector3& p : mesh.vertices) p = {p.x * k.x, p.y * k.y, p.z * k.z};
}

}  // namespace

Mesh quad_mesh() {
  Filler out;
  for (const Vector3 p : {Vector3{0, 0, 1}, Vector3{1, 0, 1}, Vector3{1, 0, 0}, Vector3{0, 0, 0}}) out.vertex(p);
  out.face({0, 1, 2, 3}, kSquare);
  return std::move(out.mesh);
}

Mesh disk_mesh(int sides) {
  Filler out;
  std::vector<std::uint32_t> ring;
  std::vector<Vector2> uv;
  for (const Vector3 p : circle(sides, 0)) {
    ring.push_back(out.vertex(p));
    uv.push_back(from_above(p));
  }
  out.face(ring, uv);
  return std::move(out.mesh);
}

Mesh cube_mesh() {
  Filler out;
  for (int i = 0; i < 8; ++i) out.vertex({i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  out.face({4, 5, 7, 6}, kSquare);  // front
  out.face({5, 1, 3, 7}, kSquare);  // right
  out.face({1, 0, 2, 3}, kSquare);  // back
  out.face({0, 4, 6, 2}, kSquare);  // left
  out.face({6, 7, 3, 2}, kSquare);  // top
  out.face({0, 1, 5, 4}, kSquare);  // bottom
  return std::move(out.mesh);
}

Mesh cylinder_mesh(int sides) {
  Filler out;
  std::vector<std::uint32_t> low, high;
  std::vector<Vector2> low_uv, high_uv;
  for (const Vector3 p : circle(sides, 0)) low.push_back(out.vertex(p)), low_uv.push_back(from_above(p));
  for (const Vector3 p : circle(sides, 1)) high.push_back(out.vertex(p)), high_uv.push_back(from_above(p));
  for (int i = 0; i < sides; ++i) {
    const int k = (i + 1) % sides;
    const double u = static_cast<double>(i) / sides, w = static_cast<double>(i + 1) / sides;
    out.face({low[i], low[k], high[k], high[i]}, {{u, 0}, {w, 0}, {w, 1}, {u, 1}});
  }
  out.face(high, high_uv);
  std::reverse(low.begin(), low.end());
  std::reverse(low_uv.begin(), low_uv.end());
  out.face(low, low_uv);
  return std::move(out.mesh);
}

Mesh cone_mesh(int sides) {
  Filler out;
  std::vector<std::uint32_t> low;
  std::vector<Vector2> low_uv;
  for (const Vector3 p : circle(sides, 0)) low.push_back(out.vertex(p)), low_uv.push_back(from_above(p));
  const std::uint32_t top = out.vertex({0.5, 1, 0.5});
  for (int i = 0; i < sides; ++i) {
    const double u = static_cast<double>(i) / sides, w = static_cast<double>(i + 1) / sides;
    out.face({low[i], low[(i + 1) % sides], top}, {{u, 0}, {w, 0}, {(u + w) / 2, 1}});
  }
  std::reverse(low.begin(), low.end());
  std::reverse(low_uv.begin(), low_uv.end());
  out.face(low, low_uv);
  return std::move(out.mesh);
}

Mesh sphere_mesh(int sides, int divisions) {
  Filler out;
  std::vector<std::vector<std::uint32_t>> rings;
  const std::uint32_t bottom = out.vertex({0.5, 0, 0.5});
  for (int d = 1; d < divisions; ++d) {
    const auto slope = base::sin_cos(base::kPi * d / divisions);
    rings.emplace_back();
    for (const Vector3 p : circle(sides, 0.5 - 0.5 * slope.cos, 0.5 * slope.sin)) rings.back().push_back(out.vertex(p));
  }
  const std::uint32_t top = out.vertex({0.5, 1, 0.5});
  for (int i = 0; i < sides; ++i) {
    const int k = (i + 1) % sides;
    const double u = static_cast<double>(i) / sides, w = static_cast<double>(i + 1) / sides;
    const auto v = [&](int d) { return static_cast<double>(d) / divisions; };
    out.face({bottom, rings[0][k], rings[0][i]}, {{(u + w) / 2, 0}, {w, v(1)}, {u, v(1)}});
    for (int d = 0; d + 1 < static_cast<int>(rings.size()); ++d)
      out.face({rings[d][i], rings[d][k], rings[d + 1][k], rings[d + 1][i]},
               {{u, v(d + 1)}, {w, v(d + 1)}, {w, v(d + 2)}, {u, v(d + 2)}});
    out.face({rings.back()[i], rings.back()[k], top}, {{u, v(divisions - 1)}, {w, v(divisions - 1)}, {(u + w) / 2, 1}});
  }
  return std::move(out.mesh);
}

void insert_asset(Shape& shape, Mesh asset, InsertMode mode) {
  const Box box = box_of(asset);
  if (box.empty) {
    shape.mesh = nullptr;
    return;
  }
  const Vector3 extent = box.extent();
  for (Vector3& p : asset.vertices) p = p - box.low;
  Vector3 k{1, 1, 1}, shift;
  Vector3 size = shape.size;
  if (mode == InsertMode::keep_size_and_position) size = {};
  if (mode == InsertMode::keep_size_align_position) {
    shift = {(size.x - extent.x) / 2, 0, (size.z - extent.z) / 2};
    size = extent;
  } else {
    // Axes along which the asset has no extent cannot tell anything about scale.
    int zero = 0, given = 0;
    double factors = 0;
    for (int i = 0; i < 3; ++i) {
      if (component(extent, i) <= kFlat) continue;
      if (std::fabs(component(size, i)) <= kFlat) {
        ++zero;
      } else {
        ++given;
        factors += std::fabs(component(size, i)) / component(extent, i);
      }
    }
    // One size given: all follow it. Two: the third is the mean of their factors.
    const double mean = given > 0 ? factors / given : 1;
    for (int i = 0; i < 3; ++i) {
      if (component(extent, i) <= kFlat) {
        if (given == 0) set_component(shift, i, component(box.low, i));
        continue;
      }
      if (std::fabs(component(size, i)) > kFlat) {
        set_component(k, i, component(size, i) / component(extent, i));
        continue;
      }
      set_component(k, i, mean);
      set_component(size, i, mean * component(extent, i));
      if (given == 0 || (given == 1 && zero == 2)) set_component(shift, i, mean * component(box.low, i));
    }
  }
  scale(asset, k);
  if (k.x * k.y * k.z < 0) {
    // Negative sizes mirror; faces of what is inserted look outwards all the same.
    reverse_faces(asset);
  }
  shape.scope.origin = shape.scope.origin + turn(shape.scope, shift);
  shape.size = size;
  keep_scope(shape, std::move(asset));
  apply_trim_planes(shape);
}

void apply_trim_planes(Shape& shape) {
  if (!shape.mesh || !shape.trim_planes || shape.trim_planes->empty()) return;
  const Frame object = scope_in_object(shape);
  Mesh mesh = *shape.mesh;
  const bool cap = is_closed(mesh);
  bool changed = false;
  for (const TrimPlane& plane : *shape.trim_planes) {
    if (!(plane.horizontal ? shape.trim_horizontal : shape.trim_vertical)) continue;
    const Vector3 normal = -turn_back(object, plane.normal);
    changed |= cut_mesh(mesh, {normal, dot(normal, place_back(object, plane.point))}, cap);
    if (mesh.faces.empty()) break;
  }
  if (changed) keep_scope(shape, std::move(mesh));
}

namespace {

std::string stem(const std::string& path) {
  const auto slash = path.find_last_of("/\\");
  std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  const auto dot_at = name.find_last_of('.');
  if (dot_at != std::string::npos && dot_at > 0) name.resize(dot_at);
  return name;
}

/// A primitive: fitted to the scope, or of the sizes given, centred in xz and standing on y = 0.
Result primitive(Shape& shape, Mesh mesh, bool sized, Vector3 size) {
  if (!sized) {
    insert_asset(shape, std::move(mesh));
    return {};
  }
  for (Vector3& p : mesh.vertices) p = {(p.x - 0.5) * size.x, p.y * size.y, (p.z - 0.5) * size.z};
  shape.size = {};
  take_mesh(shape, std::move(mesh));
  apply_trim_planes(shape);
  return {};
}

int count_of(Arguments arguments, std::size_t i, int otherwise, int least) {
  // Rounder than eyes can tell; a sphere then has 16,384 faces, which comp() and extrude can bear.
  constexpr double kMost = 128;
  return static_cast<int>(std::clamp(std::floor(number(arguments, i, otherwise)), static_cast<double>(least), kMost));
}

}  // namespace

Result run_i(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string* file = text(arguments, 0);
  if (file == nullptr) return failure("the first argument must be the name of a file");
  InsertMode mode = InsertMode::align_size_and_position;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string_view w = word(arguments, i);
    if (w == "yUp" || w == "zUp" || w == "cleanup" || is_number(arguments, i) || w == "all" || w == "none") continue;
    if (w == "alignSizeAndPosition")
      mode = InsertMode::align_size_and_position;
    else if (w == "keepSizeAndPosition")
      mode = InsertMode::keep_size_and_position;
    else if (w == "keepSizeAlignPosition")
      mode = InsertMode::keep_size_align_position;
    else
      return failure(unknown_word(w, "yUp, zUp, alignSizeAndPosition, keepSizeAndPosition, keepSizeAlignPosition"));
  }
  // No assets are read: a box stands in for each (docs/rule_language.md §2.2, placeholder policy). builtin:cube is one.
  Mesh box = cube_mesh();
  if (!file->starts_with("builtin:")) box.asset = stem(*file);
  insert_asset(shape, std::move(box), mode);
  return {};
}

Result run_primitive_quad(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  return primitive(shape, quad_mesh(), !arguments.empty(), {number(arguments, 0), 1, number(arguments, 1)});
}
Result run_primitive_disk(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  const double r = number(arguments, 1);
  return primitive(shape, disk_mesh(count_of(arguments, 0, 16, 3)), arguments.size() > 1, {2 * r, 1, 2 * r});
}
Result run_primitive_cube(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  return primitive(shape, cube_mesh(), !arguments.empty(),
                   {number(arguments, 0), number(arguments, 1), number(arguments, 2)});
}
Result run_primitive_sphere(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  const double r = number(arguments, 2);
  return primitive(shape, sphere_mesh(count_of(arguments, 0, 16, 3), count_of(arguments, 1, 16, 2)),
                   arguments.size() > 2, {2 * r, 2 * r, 2 * r});
}
Result run_primitive_cylinder(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  const double r = number(arguments, 1);
  return primitive(shape, cylinder_mesh(count_of(arguments, 0, 16, 3)), arguments.size() > 2,
                   {2 * r, number(arguments, 2), 2 * r});
}
Result run_primitive_cone(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  const double r = number(arguments, 1);
  return primitive(shape, cone_mesh(count_of(arguments, 0, 16, 3)), arguments.size() > 2,
                   {2 * r, number(arguments, 2), 2 * r});
}
Result run_trim(Shape& shape, const OperationInput&, Arguments) {
  apply_trim_planes(shape);
  return {};
}

}  // namespace blockrand::grammar
