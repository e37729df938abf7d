#include "pipeline/geometry/normal_deviation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/geometry/fitted_frame.h"

namespace blockrand::geometry {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<const model::Point3*, Kernel>;
using FaceInfoBase = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, FaceInfoBase>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;
using Vector = Eigen::Vector3d;

/// Every face's number of constraints towards the outside; odd ones lie within the polygon.
void mark_nesting(Cdt& cdt) {
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = -1;
  std::vector<std::pair<Cdt::Face_handle, int>> open{{cdt.infinite_face(), 0}};
  while (!open.empty()) {
    const auto [face, nesting] = open.back();
    open.pop_back();
    if (face->info() >= 0) continue;
    face->info() = nesting;
    for (int i = 0; i < 3; ++i) open.emplace_back(face->neighbor(i), nesting ^ (cdt.is_constrained({face, i}) ? 1 : 0));
  }
}

double angle_between(const Vector& a, const Vector& b) {
  return 2 * std::atan2((a - b).norm(), (a + b).norm());  // of unit vectors; Kahan 2006, exact for small angles too
}

/// m. Faces whose points lie nearer to the plane through three of them have no folds: doubles are wrong by this.
constexpr double kFlat = 1e-7;

}  // namespace

bool is_flat(const model::Solid& solid, const model::Face& face) {
  const auto loops = solid.loops_of(face);
  const auto outer = solid.indices_of(loops[0]);
  const model::Point3 origin = solid.vertices[outer[0]];
  Vector sum = Vector::Zero();
  for (std::size_t i = 1; i + 1 < outer.size(); ++i)
    sum += between(origin, solid.vertices[outer[i]]).cross(between(origin, solid.vertices[outer[i + 1]]));
  const double size = sum.norm();
  if (!(size > 0)) return false;
  const Vector normal = sum / size;
  for (const auto& loop : loops)
    for (const std::uint32_t i : solid.indices_of(loop))
      if (std::fabs(between(origin, solid.vertices[i]).dot(normal)) > kFlat) return false;
  return true;
}

Frame fitted_frame(std::span<const model::Point3> points) {
  Frame out;
  out.origin = points[0];
  Vector mean = Vector::Zero();
  double count = 0;
  for (const model::Point3& p : points) {
    mean += between(out.origin, p);
    ++count;
  }
  mean /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const model::Point3& p : points) {
    const Vector d = between(out.origin, p) - mean;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);  // from the least spread to the largest
  out.normal = axes.eigenvectors().col(0);
  out.right = axes.eigenvectors().col(2);
  out.up = out.normal.cross(out.right);
  return out;
}

double normal_deviation(const model::Solid& solid, const model::Face& face) {
  const auto loops = solid.loops_of(face);
  if (loops.size() == 1 && loops[0].count == 3) return 0;
  if (is_flat(solid, face)) return 0;
  std::vector<std::vector<model::Point3>> rings;
  rings.reserve(loops.size());
  for (const auto& loop : loops) {
    auto& ring = rings.emplace_back();
    ring.reserve(loop.count);
    for (const std::uint32_t i : solid.indices_of(loop)) ring.push_back(solid.vertices[i]);
  }
  const auto found = normal_deviation(rings);
  return found ? found->angle : 0;  // rings that cross are told as such
}

std::optional<NormalDeviation> normal_deviation(std::span<const std::vector<model::Point3>> rings) {
  NormalDeviation out;
  if (rings.size() == 1 && rings[0].size() == 3) return out;  // nothing to compare with
  std::vector<model::Point3> all;
  for (const auto& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
  const Frame frame = fitted_frame(all);
  Cdt cdt;
  std::size_t points = 0;
  try {
    for (const auto& ring : rings) {
      std::vector<Cdt::Vertex_handle> handles;
      for (const model::Point3& p : ring) {
        const Vector d = between(frame.origin, p);
        handles.push_back(cdt.insert(Kernel::Point_2(d.dot(frame.right), d.dot(frame.up))));
        handles.back()->info() = &p;
      }
      points += ring.size();
      if (cdt.number_of_vertices() != points) return std::nullopt;  // two at one place
      for (std::size_t i = 0; i < handles.size(); ++i)
        cdt.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
    }
  } catch (const Cdt::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  mark_nesting(cdt);
  std::vector<Vector> normals;
  Vector sum = Vector::Zero();
  std::vector<std::array<const model::Point3*, 3>> triangles;
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    if (f->info() % 2 == 0) continue;
    triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
    const auto& [a, b, c] = triangles.back();
    const Vector doubled = between(*a, *b).cross(between(*a, *c));
    sum += doubled;
    normals.push_back(doubled.norm() > 0 ? doubled.normalized() : Vector::Zero());
  }
  if (normals.empty() || !(sum.norm() > 0)) return std::nullopt;
  const Vector mean = sum.normalized();
  std::vector<std::pair<double, std::size_t>> leaning;
  for (std::size_t i = 0; i < normals.size(); ++i) leaning.emplace_back(angle_between(normals[i], mean), i);
  std::sort(leaning.begin(), leaning.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (int k = 0; k < 3; ++k)
    out.triangle[static_cast<std::size_t>(k)] = *triangles[leaning[0].second][static_cast<std::size_t>(k)];
  // Two triangles that lean by a and b lie at most a + b apart.
  for (std::size_t i = 0; i < leaning.size() && 2 * leaning[i].first > out.angle; ++i)
    for (std::size_t j = i + 1; j < leaning.size() && leaning[i].first + leaning[j].first > out.angle; ++j)
      out.angle = std::max(out.angle, angle_between(normals[leaning[i].second], normals[leaning[j].second]));
  return out;
}

}  // namespace blockrand::geometry
