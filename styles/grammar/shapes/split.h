// split(): how long the pieces are, and the pieces.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "styles/grammar/shapes/operations.h"
#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

/// One item of a split's block, or the head of a nested block; a block is a span of items in order of writing, heads
/// before their contents.
struct SplitItem {
  Mark mark = Mark::plain;
  double size = 0;         ///< as written: metres, or a share when relative. Not used in heads
  std::int32_t rule = -1;  ///< the caller's: what becomes of the piece. Not used in heads
  std::int32_t inside =
      0;  ///< heads: how many of the items that follow (of all levels) are the nested block; 0: not a head
  bool repeat = false;  ///< heads: the nested block is followed by *
};

/// From where to where a piece reaches, in the split's unit (metres) from the origin of the scope.
struct SplitPiece {
  std::int32_t rule = -1;
  double from = 0, to = 0;
};

/// More pieces than this are cut off (docs/rule_language.md §4.2: width 100000).
inline constexpr std::size_t kMostPieces = 100000;
/// Relative to the length: what is smaller than this is no room for a piece (docs/rule_language.md §7.2, 8).
inline constexpr double kSplitTolerance = 1e-6;

/// The size solver (docs/rule_language.md §2.3): pieces in order, each longer than nothing; their position in the
/// result is `split.index`, their number `split.total`. Pure: nothing but the arguments counts.
/// \param repeat  the whole block is followed by *
/// \param length  m, of the scope along the axis; 0 or less gives no pieces
std::vector<SplitPiece> split_sizes(std::span<const SplitItem> items, bool repeat, double length);

/// `split(axis, adjust|noAdjust)`: one shape per piece, closed meshes capped, `split` records set, everything else
/// inherited. The scopes are refitted to the pieces' boxes (adjust) or are the slabs. A slab that the geometry does not
/// reach gives a shape without geometry. Faces keep their first edge where it survives, else the piece of it, else the
/// first edge along the outline after it; caps start at the first cut edge. \param axis  0, 1, 2 for x, y, z of the
/// scope
std::vector<Shape> split_shape(const Shape& shape, int axis, std::span<const SplitPiece> pieces, bool adjust = true);

/// What lies between two planes across the axis, `from` and `to` in metres from the scope's origin: one piece of
/// split_shape().
Shape cut_piece(const Shape& shape, int axis, double from, double to, bool adjust = true);

/// The length to share out in `split(x|y|z)`: |scope size|.
double split_length(const Shape& shape, int axis);

/// `split(u|v, uvSpace|unitSpace, set)`: the range of the coordinate over the geometry. `scale` is metres per unit of
/// the coordinate (1 in uvSpace). Errors: the set has no coordinates, or is none of 0 to 9.
struct UvRange {
  double minimum = 0, maximum = 0, scale = 1;
  double length() const { return (maximum - minimum) * scale; }
};
tl::expected<UvRange, std::string> uv_range(const Shape& shape, bool v, bool unit_space, int set);
/// Cuts along lines of equal u or v; pieces as split_sizes(items, repeat, range.length()) gives them.
std::vector<Shape> split_uv(const Shape& shape, bool v, int set, const UvRange& range,
                            std::span<const SplitPiece> pieces);

/// `splitArea(axis)`: as split_sizes, but sizes are areas in m² of a plane shape; `length` is its area. Cuts are across
/// the axis.
std::vector<Shape> split_area(const Shape& shape, int axis, std::span<const SplitPiece> pieces, bool adjust = true);
/// The area to share out in splitArea.
double split_area_total(const Shape& shape);

}  // namespace blockrand::grammar
