// Outlines of openings with a head: straight, arched, pointed, gabled.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "styles/elements/flat_shapes.h"

namespace blockrand::elements {

enum class Head : std::uint8_t {
  straight,
  segmental,
  round,
  gabled,
  pointed,  ///< Gothic: two arcs about the opposite springings, as high as an equilateral triangle
  basket,   ///< a half ellipse, a third of the width high
};

/// An opening, its lower edge on y = 0, symmetric about x = 0. Metres.
struct OpeningShape {
  double width = 1, height = 2;  ///< height in the middle
  Head head = Head::straight;
  double rise = 0.12;  ///< of segmental and gabled heads, as a share of the width
  int chords = 6;      ///< straight pieces of a segmental head; all others but gabled ones get twice as many
};

/// m from the springing to the middle of the head; 0 for straight heads.
double head_rise(const OpeningShape& shape);
/// y where the head begins.
inline double springing(const OpeningShape& shape) { return shape.height - head_rise(shape); }

/// m of straight jamb below any head.
inline constexpr double kLeastJamb = 0.10;

/// Counter-clockwise from the lower left corner, convex, on the 1/1024 m grid. Error: the head leaves no jamb.
tl::expected<Outline, std::string> outline_of(const OpeningShape& shape);

}  // namespace blockrand::elements
