// Surfaces of a match against each other: distances both ways, what lies within a bound, how the normals differ.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/comparison.h"
#include "pipeline/compare/cover.h"
#include "pipeline/compare/face_triangles.h"
#include "pipeline/geometry/nearest_surface.h"

namespace blockrand::compare {

struct SurfaceOptions {
  int samples = 4000;  ///< places on each side of a match, about
  std::uint64_t seed = 1;
  double least_spacing = 0.05;  ///< m. Small buildings need no more.
};

/// One side of a match: its faces and openings as triangles.
class MatchSurface {
 public:
  /// A face or opening.
  struct Patch {
    std::uint32_t building = 0;
    Hull hull = Hull::wall;
    LeftOut left_out = LeftOut::no;
    bool opening = false;
    Point3 normal{};
    Point3 anchor{};                     ///< of its building's lattice
    std::uint32_t first = 0, count = 0;  ///< triangles
  };
  /// \param up  m, added to every height
  MatchSurface(const City& city, std::span<const std::uint32_t> buildings, double up);

  bool empty() const { return nearest_.empty(); }
  double area() const { return area_; }  ///< m²
  std::span<const Triangle3> triangles() const { return triangles_; }
  std::span<const Patch> patches() const { return patches_; }
  std::span<const Triangle3> triangles_of_patch(const Patch& p) const {
    return std::span(triangles_).subspan(p.first, p.count);
  }
  const Patch& patch_of(std::uint32_t triangle) const { return patches_[patch_of_[triangle]]; }
  geometry::NearestSurface::Nearest nearest(Point3 p) const { return nearest_.nearest(p); }
  /// The nearest patch to a place; of those that meet in an edge there, the one that looks most as `normal` does.
  struct NearestPatch {
    double distance = 0;  ///< m
    const Patch* patch = nullptr;
    double cosine = 0;  ///< of the angle between both normals, without their signs
    Point3 place{};     ///< on it
  };
  NearestPatch nearest_patch(Point3 p, Point3 normal) const;

 private:
  std::vector<Triangle3> triangles_;
  std::vector<std::uint32_t> patch_of_;
  std::vector<Patch> patches_;
  double area_ = 0;
  geometry::NearestSurface nearest_;
};

/// Weights by distance: bins of 1 mm to 4 m, of 5 cm to 40 m, and one for all beyond.
class DistanceHistogram {
 public:
  DistanceHistogram();
  void add(double distance, double weight) { weights_[bin(distance)] += weight; }
  void add(const DistanceHistogram& other);
  double share_up_to(double distance) const;  ///< 0 without weights
  double quantile(double share) const;        ///< m, upper end of the bin
  double total() const;

 private:
  static std::size_t bin(double distance);
  static double upper(std::size_t bin);
  std::vector<double> weights_;
};

/// What pooling needs beyond the measures.
struct SurfaceTally {
  DistanceHistogram to_reference, to_model;                ///< counted surface only
  std::array<double, kLeftOutCount> model{}, reference{};  ///< m² by reason
};

/// Sets the measures of Scope::surface but the semantic ones. What is left out: a place on ground, one on a wall that a
/// neighbour covers, one on a blank facade; and a place on a wall whose nearest place on the other side is covered or
/// blank and less than a metre away, since there is nothing to be compared with.
/// \param model_up, reference_up  m, as the surfaces were raised
void measure_surfaces(const MatchSurface& model, const Cover& model_cover, const MatchSurface& reference,
                      const Cover& reference_cover, double model_up, double reference_up, const SurfaceOptions& options,
                      MeasureValues& values, SurfaceTally& tally);

}  // namespace blockrand::compare
