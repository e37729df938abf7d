// LoD3 read back: whether windows and doors stand in their walls, and elements where their openings are.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "pipeline/validate/contents.h"

namespace blockrand::validate {

/// Called with what is wrong and the id of the object.
using Complain = std::function<void(std::string what, const std::string& id)>;

/// The openings and placements of a body against its LoD3 solid.
///
/// An opening's polygon lies parallel to its wall and at most kDeepestReveal behind it, looks the way the wall looks,
/// and each of its edges is one of a reveal or of the wall: it closes the end of its own reveal. The element in an
/// opening stands upright in the plane of the wall, within the opening's outline.
void check_detail(const ReadBody& body, const Complain& complain);

/// The same for equal elements, whichever format they come from: their polygons in order to 0.1 mm, with colours.
std::uint64_t element_digest(std::span<const ReadPolygon> polygons);

/// The element that has these polygons.
ReadElement element_of(std::span<const ReadPolygon> polygons);

/// Whether a corner of the placed element's box lies outside of [lower, upper] by more than kRoomTolerance.
bool reaches_beyond(const ReadPlacement& placement, const ReadElement& element, const model::Point3& lower,
                    const model::Point3& upper);

/// Whether a matrix (row by row) turns about the vertical and does nothing else: elements stand upright and keep their
/// size.
bool turns_about_the_vertical(std::span<const double> matrix);

/// What two formats say differently of a body's LoD3 beside its solid: how many openings, which elements where, which
/// installations. Empty where they say the same.
std::string detail_difference(const ReadBody& a, const ReadBody& b);
/// Of that, the installations.
std::string installation_difference(const ReadBody& a, const ReadBody& b);

/// m. Walls are plane to 1 cm (ISO 19107's 203), on both sides of which corners may lie.
inline constexpr double kWallTolerance = 0.02;
/// m. What rounding corners to 0.1 mm and directions to nine decimals does to an element's corners, with room.
inline constexpr double kRoomTolerance = 0.002;
/// m. No wall is thicker; Finkenzeller's deepest reveals have half of it.
inline constexpr double kDeepestReveal = 1.0;

}  // namespace blockrand::validate
