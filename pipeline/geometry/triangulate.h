// Triangles of planar faces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/geometry/grid.h"
#include "pipeline/model/solid.h"

namespace blockrand::geometry {

using Triangle = std::array<std::uint32_t, 3>;

/// Constrained Delaunay triangulation of a polygon given as loops of indices into `points` (outer counter-clockwise,
/// holes clockwise or either). Triangles are counter-clockwise and use the loops' vertices only.
/// Empty optional when the loops cross, touch or repeat a point: the polygon is not simple.
std::optional<std::vector<Triangle>> triangulate(std::span<const Grid2> points,
                                                 std::span<const std::vector<std::uint32_t>> loops);

/// As the first, of a polygon whose rings touch each other at points, which then have one index in several loops; what an odd
/// number of loops encloses is inside. Empty when loops cross.
std::optional<std::vector<Triangle>> triangulate_touching(std::span<const Grid2> points,
                                                          std::span<const std::vector<std::uint32_t>> loops);

/// As the first, with `lines`, pairs of indices into `points`, as edges of triangles. Lines may end anywhere inside the
/// polygon, or at points of the loops; a line from a point to itself is that point. Points that no loop and no line
/// names are not used. Empty as above, and when a line crosses a loop or another line, or passes through a point.
std::optional<std::vector<Triangle>> triangulate_with_lines(std::span<const Grid2> points,
                                                            std::span<const std::vector<std::uint32_t>> loops,
                                                            std::span<const std::array<std::uint32_t, 2>> lines);

/// Triangulates every face of a solid in the projection along its dominant normal axis. Empty when a face is not a
/// simple polygon there.
std::optional<model::SolidTriangles> triangulate(const model::Solid& solid);

/// Whether a solid that was made of another by adding faces and points still has its face f: the same loops of the same
/// points. Vertices keep their numbers. False for faces that the other does not have.
bool same_face(const model::Solid& before, const model::Solid& after, std::size_t face);

/// The same of one polygon: its triangles, counter-clockwise seen from outside.
/// \param points  on the grid
/// \param loops  of indices into points, three at least in each: the outer one first
std::optional<std::vector<Triangle>> triangulate(std::span<const Grid3> points,
                                                 std::span<const std::vector<std::uint32_t>> loops);

/// As above for a solid that begins with the faces and vertices of another, of which some got more loops or points:
/// faces that are the same as before (same_face) take their triangles from `known`.
/// \param known  triangulate(before)
/// \param ready  triangles of faces that were triangulated already, ascending
std::optional<model::SolidTriangles> triangulate(
    const model::Solid& solid, const model::Solid& before, const model::SolidTriangles& known,
    std::span<const std::pair<std::uint32_t, std::vector<Triangle>>> ready = {});

}  // namespace blockrand::geometry
