#include "pipeline/geometry/cgal_validator.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <map>
#include <utility>

namespace blockrand::geometry {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// Triangulates a polygon with holes in the projection along its normal.
bool triangulate(const PolygonRings& rings, const std::map<model::Point3, std::size_t>& index,
                 std::vector<std::vector<std::size_t>>& out) {
  using Traits = CGAL::Projection_traits_3<Kernel>;
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Traits>;
  using FaceBase = CGAL::Constrained_triangulation_face_base_2<Traits>;
  using Cdt =
      CGAL::Constrained_Delaunay_triangulation_2<Traits, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                                 CGAL::No_constraint_intersection_tag>;
  Kernel::Vector_3 normal(0, 0, 0);
  const auto& outer = rings[0];
  const model::Point3 o = outer[0];
  const auto local = [&](const model::Point3& p) { return Kernel::Vector_3(p.x - o.x, p.y - o.y, p.z - o.z); };
  for (std::size_t i = 0; i < outer.size(); ++i)
    normal = normal + CGAL::cross_product(local(outer[i]), local(outer[(i + 1) % outer.size()]));
  if (normal == CGAL::NULL_VECTOR) return false;
  try {
    Cdt cdt{Traits(normal)};
    for (const auto& ring : rings) {
      std::vector<Cdt::Vertex_handle> handles;
      for (const model::Point3& p : ring) {
        handles.push_back(cdt.insert(Kernel::Point_3(p.x, p.y, p.z)));
        handles.back()->info() = index.at(p);
      }
      for (std::size_t i = 0; i < handles.size(); ++i) {
        if (handles[i] == handles[(i + 1) % handles.size()]) return false;
        cdt.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
      }
    }
    // Flood from the infinite face; every crossed constraint changes sides.
    std::map<Cdt::Face_handle, bool> inside;
    std::vector<std::pair<Cdt::Face_handle, bool>> open{{cdt.infinite_face(), false}};
    while (!open.empty()) {
      const auto [face, is_inside] = open.back();
      open.pop_back();
      if (!inside.emplace(face, is_inside).second) continue;
      for (int i = 0; i < 3; ++i) open.emplace_back(face->neighbor(i), is_inside != cdt.is_constrained({face, i}));
    }
    for (const auto f : cdt.finite_face_handles()) {
      if (!inside.at(f)) continue;
      std::vector<std::size_t> t{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
      out.push_back(std::move(t));
    }
  } catch (const std::exception&) {
    return false;  // rings that cross
  }
  return true;
}

std::string validate_soup(const std::vector<Kernel::Point_3>& points,
                          const std::vector<std::vector<std::size_t>>& triangles) {
  if (triangles.empty()) return "no faces";
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) return "faces do not form an oriented manifold";
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  if (!CGAL::is_closed(mesh)) return "not closed";
  if (pmp::does_self_intersect(mesh)) return "self-intersection";
  if (!pmp::does_bound_a_volume(mesh)) return "does not bound a volume";
  if (!pmp::is_outward_oriented(mesh)) return "faces look inwards";
  // Two shells are a volume for CGAL, yet no solid in the sense of GML.
  std::vector<bool> seen(mesh.number_of_faces(), false);
  std::vector<Mesh::Face_index> stack{*mesh.faces().begin()};
  std::size_t reached = 0;
  seen[*mesh.faces().begin()] = true;
  while (!stack.empty()) {
    const auto f = stack.back();
    stack.pop_back();
    ++reached;
    for (const auto n : CGAL::faces_around_face(mesh.halfedge(f), mesh))
      if (!seen[n]) {
        seen[n] = true;
        stack.push_back(n);
      }
  }
  return reached == mesh.number_of_faces() ? "" : "more than one shell";
}

/// m. Farther from the origin lies nothing on Earth; squares and products of such numbers leave what doubles hold, and GMP
/// ends the program on infinities.
constexpr double kFarthest = 1e8;

bool on_earth(const model::Point3& p) {
  return std::fabs(p.x) < kFarthest && std::fabs(p.y) < kFarthest && std::fabs(p.z) < kFarthest;
}

}  // namespace

std::string validate_solid(const std::vector<PolygonRings>& polygons) {
  std::map<model::Point3, std::size_t> index;
  std::vector<Kernel::Point_3> points;
  for (const auto& polygon : polygons)
    for (const auto& ring : polygon) {
      if (ring.size() < 3) return "a ring with fewer than three points";
      for (const model::Point3& p : ring)
        if (!on_earth(p))
          return "a coordinate beyond all measure";
        else if (index.emplace(p, points.size()).second)
          points.emplace_back(p.x, p.y, p.z);
    }
  std::vector<std::vector<std::size_t>> triangles;
  for (const auto& polygon : polygons)
    if (polygon.empty() || !triangulate(polygon, index, triangles)) return "a face is no simple polygon";
  return validate_soup(points, triangles);
}

std::string validate_triangles(const std::vector<std::vector<model::Point3>>& triangles) {
  std::map<model::Point3, std::size_t> index;
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> soup;
  for (const auto& t : triangles) {
    std::vector<std::size_t> corner;
    for (const model::Point3& p : t) {
      if (!on_earth(p)) return "a coordinate beyond all measure";
      const auto [place, inserted] = index.emplace(p, points.size());
      if (inserted) points.emplace_back(p.x, p.y, p.z);
      corner.push_back(place->second);
    }
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) return "a triangle without area";
    soup.push_back(std::move(corner));
  }
  return validate_soup(points, soup);
}

}  // namespace blockrand::geometry
