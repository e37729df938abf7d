// Distances to a surface of triangles: the nearest place on it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

/// A set of triangles that can be asked for the nearest one. CGAL's AABB tree; coordinates are taken as they are and
/// should lie within kilometres of 0. Any number of threads may ask at the same time.
class NearestSurface {
 public:
  /// Triangles without an area (below 1e-12 m²) are left out; `nearest` tells the others by their place in `triangles`.
  explicit NearestSurface(std::span<const std::array<model::Point3, 3>> triangles);
  ~NearestSurface();
  NearestSurface(NearestSurface&&) noexcept;
  NearestSurface& operator=(NearestSurface&&) noexcept;

  bool empty() const;

  struct Nearest {
    double distance = 0;         ///< m
    std::uint32_t triangle = 0;  ///< of several that are equally near any one
    model::Point3 place;         ///< on the surface
  };
  /// Requires a surface that is not empty.
  Nearest nearest(model::Point3 p) const;
  /// All triangles that have a place of the surface (to about a micrometre): several where it lies on an edge.
  /// Ascending.
  std::vector<std::uint32_t> triangles_at(model::Point3 place) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace blockrand::geometry
