// setback, shapeL/U/O, innerRectangle, scatter: operations with blocks that cut a lot into parts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/operations.h"
#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

/// Edges that setback() selects from: the face edges of the shape with their outward normals, for selected(). The
/// selectors are those of comp and uv.*; the selector `remainder` takes none.
ComponentSplit setback_edges(const Shape& shape);

/// What a setback makes.
struct SetbackPieces {
  std::vector<std::optional<Shape>>
      pieces;  ///< by item of setback_edges(): the strip along the edge; nothing where there is none
  std::optional<Shape> remainder;  ///< what is left in the middle; its first edge is that of the face
};

/// Moves edges inwards (docs/rule_language.md §2.5). Strips start with their outline edge; together with the remainder
/// they cover the face once.
/// \param distances  m, by item of setback_edges(); 0 or less: the edge stays and has no strip
SetbackPieces setback_pieces(const Shape& shape, std::span<const double> distances);

/// setbackToArea: the distances (by item of setback_edges()) that leave `area` m²: minimum + one common increment, at
/// most maximum. Only `chosen` move.
std::vector<double> setback_to_area(const Shape& shape, std::span<const std::size_t> chosen, double area,
                                    std::span<const double> minimum, std::span<const double> maximum);

/// Several pieces as one shape (`sel = X`): in the frame of the first one. Nothing for none.
std::optional<Shape> merge_pieces(std::span<const Shape> pieces);

struct ShapeAndRemainder {
  std::vector<Shape> shapes;  ///< one per face that has one
  std::vector<Shape> remainders;
};
/// shapeL, shapeU, shapeO: strips along edges by direction in the scope, united into one polygon.
/// \param widths  m: front, right, back, left; 0 or less: none
ShapeAndRemainder shape_lu_o_pieces(const Shape& shape, double front, double right, double back, double left);

/// innerRectangle(scope|edge).
ShapeAndRemainder inner_rectangle_pieces(const Shape& shape, bool by_edge);

enum class ScatterDomain : std::uint8_t { surface, volume, scope };
enum class ScatterDistribution : std::uint8_t { uniform, gaussian };
/// scatter(domain, n, distribution …): points as shapes with scope size 0 and no geometry; on surfaces y is the normal.
/// Draws random numbers from (shape.seed, a stream of its own): the shape's own draws are not touched.
/// \param mean  gaussian: center front back left right top bottom
/// \param deviation  gaussian: m per axis
std::vector<Shape> scatter(const Shape& shape, ScatterDomain domain, int count, ScatterDistribution distribution,
                           std::string_view mean, Vector3 deviation);

}  // namespace blockrand::grammar
