// The project's own validator of solids: closed, manifold, oriented, planar, free of self-intersections.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/solid_defect.h"
#include "pipeline/model/solid.h"

namespace blockrand::geometry {

struct SolidCheck {
  SolidDefect defect = SolidDefect::none;
  /// What is concerned, where that makes sense: of 1xx and 2xx a face and one of its loops (0: the outer one), of 302 to
  /// 303 and 307 vertices, of 305 and 306 faces.
  std::int64_t first = -1, second = -1;
  double measure = 0;  ///< m off the plane for not_planar; rad for folded; m apart for rings that all but touch
  bool valid() const { return defect == SolidDefect::none; }
  int code() const { return iso_code(defect); }
  std::string text() const;  ///< "302 shell not closed at 3 and 4"; "none" for sound solids
};

struct SolidCheckOptions {
  double planarity = 0.01;  ///< m. val3dity's tolerance of 203; rounding to the grid alone costs up to 0.001.
  /// rad between any two triangles of a face (geometry::normal_deviation): val3dity's tolerance of 204, 20 degrees.
  double normal_deviation = 0.3490658503988659;
};

/// For solids that are to be written: what val3dity finds may not hang on how it rounds.
inline constexpr SolidCheckOptions kBuilt{.normal_deviation = 0.2617993877991494};  // 15 degrees

/// Checks a solid whose vertices lie on the 1/1024 m grid: its rings, then its polygons, then its shell; the first
/// defect is told. All decisions are exact (integer arithmetic) but planarity (203), folds (204), and the view of a
/// face along its own normal, which is exact on a grid 64 times as fine. Polygons are classed only once they are known to
/// be bad: sound solids pay for no classes.
/// Stricter than ISO 19107: rings that touch are rings_meet, and so are walls of a face nearer than 2/1024 m.
/// \param triangles  the solid's triangulation by geometry::triangulate; an empty one where that refused
/// O(n log n) for n faces of footprint-like solids.
SolidCheck check_solid(const model::Solid& solid, const model::SolidTriangles& triangles,
                       const SolidCheckOptions& options = {});

/// As above; triangulates by itself once that is safe. For solids that may hold anything.
SolidCheck check_solid(const model::Solid& solid);

/// The rules of polygons (2xx) of one face alone, as check_solid has them. For those who know the rest.
/// \param triangles  those that geometry::triangulate found in it; none where it found none
/// \param vertices  the solid's, on the grid
bool sound_polygon(const model::Solid& solid, std::uint32_t face,
                   std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const Grid3> vertices,
                   const SolidCheckOptions& options);

/// As above for a mesh of triangles (counter-clockwise from outside) that was read from a file: vertices in whole
/// steps of any size, equal positions merged by the caller.
SolidCheck check_mesh(std::span<const Grid3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

/// The rules of rings and polygons alone, 1xx and 2xx, for one polygon that bounds nothing: a face of a window.
/// Rings that only come near each other are sound.
/// \param rings  m, rounded to the grid here: the outer one, then holes
SolidCheck check_polygon(std::span<const std::vector<model::Point3>> rings);

/// Its test of two triangles of different faces, given by indices into `vertices`: whether they share more than
/// the corners and edges that they have in common by index. Exact.
bool triangles_conflict(std::span<const Grid3> vertices, const std::array<std::uint32_t, 3>& a,
                        const std::array<std::uint32_t, 3>& b);

/// Volume enclosed by the triangles in m³; positive when they face outwards.
double volume(const model::Solid& solid, const model::SolidTriangles& triangles);

}  // namespace blockrand::geometry
