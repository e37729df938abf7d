#include "styles/grammar/shapes/mesh_triangles.h"

#include <cmath>

#include "pipeline/geometry/triangulate.h"
#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

/// Steps per metre for triangulation: finer than any moulding, and exact up to 32 km (pipeline/geometry/grid.h).
constexpr double kStepsPerMetre = 65536;

}  // namespace

std::vector<MeshTriangle> triangles_of(const Mesh& mesh) {
  std::vector<MeshTriangle> out;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const MeshFace& face = mesh.faces[f];
    if (face.loops.empty()) continue;
    const Vector3 normal = area_vector(mesh, face.loops.front());
    const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const bool turned = component(normal, axis) < 0;
    std::vector<geometry::Grid2> plane;
    std::vector<std::uint32_t> vertices;
    std::vector<std::vector<std::uint32_t>> loops;
    for (const Loop& loop : face.loops) {
      loops.emplace_back();
      for (const Corner& corner : loop) {
        const Vector3& p = mesh.vertices[corner.vertex];
        double u = component(p, (axis + 1) % 3), v = component(p, (axis + 2) % 3);
        if (turned) std::swap(u, v);
        loops.back().push_back(static_cast<std::uint32_t>(plane.size()));
        plane.push_back({std::llround(geometry::within_grid(u * kStepsPerMetre)),
                         std::llround(geometry::within_grid(v * kStepsPerMetre))});
        vertices.push_back(corner.vertex);
      }
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      out.push_back({{vertices[a], vertices[b], vertices[c]}, f});
    };
    if (const auto triangles = geometry::triangulate(plane, loops)) {
      for (const auto& triangle : *triangles) add(triangle[0], triangle[1], triangle[2]);
    } else {  // not simple in projection: a fan shows at least what is there
      for (std::uint32_t i = 1; i + 1 < loops[0].size(); ++i) add(loops[0][0], loops[0][i], loops[0][i + 1]);
    }
  }
  return out;
}

}  // namespace blockrand::grammar
