// Whether a face folds by more than an angle: normal_deviation() where it has to be, something much faster nearly always.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/model/solid.h"

namespace blockrand::geometry {

/// Whether normal_deviation(solid, face) is more than `limit`.
/// The triangles are turned into the Delaunay triangulation of the fitted plane by flipping edges, as far as doubles are
/// sure of it. Where several are as good, all of their triangles must lean little. Where doubles cannot tell, and where the
/// angle comes within kSureAngle of the limit, normal_deviation() decides.
/// \param triangles  of the face, counter-clockwise, by geometry::triangulate; may be empty
/// \param limit  rad
bool folds_more_than(const model::Solid& solid, const model::Face& face,
                     std::span<const std::array<std::uint32_t, 3>> triangles, double limit);

/// The same of what normal_deviation(rings) says, which knows no flat faces; nothing where only it can tell.
/// \param points  m
/// \param triangles  indices into points, counter-clockwise seen along one of the axes
std::optional<bool> surely_folds(std::span<const model::Point3> points,
                                 std::span<const std::array<std::uint32_t, 3>> triangles, double limit);

inline constexpr double kSureAngle = 1e-7;  ///< rad; doubles are wrong by a thousandth of it

}  // namespace blockrand::geometry
