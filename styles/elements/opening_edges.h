// Openings drawn edge by edge: a rectangle whose four edges are moved, shortened and shaped
// (docs/sources.md, Finkenzeller 3.11).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "styles/elements/profile.h"

namespace blockrand::elements {

/// Axis-parallel rectangle in the wall's plane, m.
struct OpeningRectangle {
  double left = 0, bottom = 0, right = 0, top = 0;
  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

/// What becomes of one edge. Shares in [0, 1]: along the edge of its length, across it of the opening's extent there.
/// Everything grows into the opening.
struct OpeningEdge {
  bool dominant = false;
  double dist_left = 0,
         dist_right = 0;   ///< the edge is shortened at the viewer's left and right (jambs: lower and upper)
  double dist_inward = 0;  ///< the edge moves inwards
  double size = 0;         ///< depth of the strip in which the profile runs
  /// Shape of the edge: the walk's start and end lie on the strip's inner line, its highest point touches the outer
  /// one. A round head is "arc, abs, 0, 180, 1;". Without one the edge is straight at the strip's inner line.
  std::optional<Profile> profile;
};

/// A shape of an edge by its name, as a program of the profile language; "straight" has none.
struct EdgeShape {
  std::string_view name, program;
};
std::span<const EdgeShape> edge_shapes();

/// Bottom, right, top, left.
using OpeningEdges = std::array<OpeningEdge, 4>;

/// The opening's outline: counter-clockwise, simple, within the rectangle, on the 1/1024 m grid.
///
/// A dominant edge spans the whole width (a straight one up to its neighbours' inner lines); its neighbours end at its
/// inner line. Two dominant neighbours are an error;
/// a straight edge of which its neighbours leave nothing vanishes between them (an ellipse of two round jambs);
/// where neither of two neighbours is dominant, head and sill are (docs/sources.md, Finkenzeller 4.7, 5).
/// \param door  the lower edge is taken as it is: no strip, no shortening
tl::expected<Outline, std::string> opening_outline(const OpeningRectangle& rectangle, const OpeningEdges& edges,
                                                   bool door);

}  // namespace blockrand::elements
