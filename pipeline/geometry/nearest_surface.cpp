#include "pipeline/geometry/nearest_surface.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace blockrand::geometry {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using model::Point3;

struct Entry {
  Kernel::Triangle_3 triangle;
  Kernel::Point_3 first;
  std::uint32_t index = 0;
};

/// CGAL's view of an entry: its triangle and a point on it.
struct Primitive {
  using Id = const Entry*;
  using Point = Kernel::Point_3;
  using Datum = Kernel::Triangle_3;
  using Datum_reference = const Datum&;
  using Point_reference = const Point&;

  Primitive() = default;
  explicit Primitive(std::vector<Entry>::const_iterator entry) : entry_(&*entry) {}
  const Id& id() const { return entry_; }
  Datum_reference datum() const { return entry_->triangle; }
  Point_reference reference_point() const { return entry_->first; }

 private:
  Id entry_ = nullptr;
};

constexpr double kTouching = 1e-6;    // m. Closest points are exact to some 1e-9 m at a kilometre.
constexpr double kLeastArea = 1e-12;  // m². CGAL asks for triangles that have a plane.

double area(const std::array<Point3, 3>& t) {
  const double ux = t[1].x - t[0].x, uy = t[1].y - t[0].y, uz = t[1].z - t[0].z;
  const double vx = t[2].x - t[0].x, vy = t[2].y - t[0].y, vz = t[2].z - t[0].z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  return 0.5 * std::sqrt(nx * nx + ny * ny + nz * nz);
}

}  // namespace

struct NearestSurface::Tree {
  std::vector<Entry> entries;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

NearestSurface::NearestSurface(std::span<const std::array<Point3, 3>> triangles) : tree_(std::make_unique<Tree>()) {
  tree_->entries.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& t = triangles[i];
    if (!(area(t) >= kLeastArea)) continue;
    const auto point = [](Point3 p) { return Kernel::Point_3(p.x, p.y, p.z); };
    tree_->entries.push_back({Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2])), point(t[0]), i});
  }
  if (tree_->entries.empty()) return;
  tree_->tree.rebuild(tree_->entries.cbegin(), tree_->entries.cend());
  // Built here, since the first question would build it behind the back of other threads.
  tree_->tree.build();
  tree_->tree.accelerate_distance_queries();
}

NearestSurface::~NearestSurface() = default;
NearestSurface::NearestSurface(NearestSurface&&) noexcept = default;
NearestSurface& NearestSurface::operator=(NearestSurface&&) noexcept = default;

bool NearestSurface::empty() const { return tree_->entries.empty(); }

NearestSurface::Nearest NearestSurface::nearest(Point3 p) const {
  const Kernel::Point_3 q(p.x, p.y, p.z);
  const auto [point, id] = tree_->tree.closest_point_and_primitive(q);
  return {std::sqrt(CGAL::squared_distance(q, point)), id->index, {point.x(), point.y(), point.z()}};
}

std::vector<std::uint32_t> NearestSurface::triangles_at(Point3 p) const {
  const CGAL::Bbox_3 box(p.x - kTouching, p.y - kTouching, p.z - kTouching, p.x + kTouching, p.y + kTouching,
                         p.z + kTouching);
  std::vector<const Entry*> found;
  tree_->tree.all_intersected_primitives(box, std::back_inserter(found));
  std::vector<std::uint32_t> out;
  for (const Entry* entry : found) out.push_back(entry->index);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace blockrand::geometry
