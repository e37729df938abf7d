#include "pipeline/geometry/straight_skeleton.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/create_straight_skeleton_from_polygon_with_holes_2.h>

#include <algorithm>
#include <map>
#include <new>

namespace blockrand::geometry {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using CgalPolygon = CGAL::Polygon_2<Kernel>;
using CgalPolygonWithHoles = CGAL::Polygon_with_holes_2<Kernel>;

}  // namespace

double StraightSkeleton::height() const {
  double most = 0;
  for (const SkeletonNode& n : nodes) most = std::max(most, n.time);
  return most;
}

std::optional<StraightSkeleton> straight_skeleton(const model::Polygon& polygon) {
  std::size_t all_corners = polygon.outer.size();
  for (const model::Ring& hole : polygon.holes) all_corners += hole.size();
  if (polygon.outer.size() < 3 || all_corners > kMostSkeletonCorners) return std::nullopt;
  const model::Point2 origin = polygon.outer.points[0];
  StraightSkeleton out;
  std::map<model::Point2, std::uint32_t> corner_at;
  const auto convert = [&](const model::Ring& ring) {
    CgalPolygon p;
    for (const model::Point2 q : ring.points) {
      const model::Point2 local{q.x - origin.x, q.y - origin.y};
      p.push_back(Kernel::Point_2(local.x, local.y));
      corner_at.emplace(local, static_cast<std::uint32_t>(out.nodes.size()));
      out.nodes.push_back({q, 0, true});
    }
    return p;
  };
  CgalPolygonWithHoles input(convert(polygon.outer));
  for (const model::Ring& hole : polygon.holes) input.add_hole(convert(hole));
  const std::size_t corners = out.nodes.size();
  if (corner_at.size() != corners) return std::nullopt;

  const auto skeleton = [&] {
    try {
      return CGAL::create_interior_straight_skeleton_2(input, Kernel());
    } catch (const std::bad_alloc&) {
      throw;  // whether memory suffices depends on the machine: no house may look different for it
    } catch (const std::exception&) {
      // CGAL reports failed internal assertions by exceptions; for us the plan merely has no skeleton.
      return decltype(CGAL::create_interior_straight_skeleton_2(input, Kernel()))();
    }
  }();
  if (!skeleton || skeleton->size_of_faces() != corners) return std::nullopt;

  std::map<int, std::uint32_t> node_of;  // CGAL's vertex id to ours
  const auto node = [&](auto vertex) -> std::optional<std::uint32_t> {
    const auto [place, inserted] = node_of.try_emplace(vertex->id(), 0);
    if (!inserted) return place->second;
    const model::Point2 local{CGAL::to_double(vertex->point().x()), CGAL::to_double(vertex->point().y())};
    if (vertex->is_contour()) {
      const auto found = corner_at.find(local);
      if (found == corner_at.end()) return std::nullopt;
      place->second = found->second;
    } else {
      place->second = static_cast<std::uint32_t>(out.nodes.size());
      out.nodes.push_back({{local.x + origin.x, local.y + origin.y}, CGAL::to_double(vertex->time()), false});
    }
    return place->second;
  };

  out.faces.resize(corners);
  std::vector<bool> seen(corners, false);
  for (auto f = skeleton->faces_begin(); f != skeleton->faces_end(); ++f) {
    // The contour half-edge of the face: its opposite is on the border.
    auto start = f->halfedge();
    auto h = start;
    do {
      if (!h->is_bisector()) break;
      h = h->next();
    } while (h != start);
    if (h->is_bisector()) return std::nullopt;
    SkeletonFace face;
    auto walk = h;
    // A half-edge points to its vertex; the contour edge runs from its predecessor's vertex to its own.
    const auto source = node(h->prev()->vertex());
    if (!source) return std::nullopt;
    face.edge = *source;
    face.nodes.push_back(*source);
    do {
      const auto n = node(walk->vertex());
      if (!n) return std::nullopt;
      if (*n != *source) face.nodes.push_back(*n);
      walk = walk->next();
    } while (walk != h);
    if (face.edge >= corners || seen[face.edge] || face.nodes.size() < 3) return std::nullopt;
    seen[face.edge] = true;
    out.faces[face.edge] = std::move(face);
  }
  return out;
}

}  // namespace blockrand::geometry
