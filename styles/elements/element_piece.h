// Pieces of element files: boxes, prisms, rings and mouldings whose measures are expressions. Internal to this folder.
#pragma once

#include <array>
#include <optional>

#include "pipeline/base/toml_file.h"
#include "styles/elements/expression.h"
#include "styles/elements/parameters.h"

namespace blockrand::elements {

/// What to do where a file says what it cannot.
inline constexpr const char* kSeePage = "See docs/element_files.md";

/// Of a file, and of each of its pieces: bad input ends here.
inline constexpr std::size_t kMostPieces = 200, kMostCorners = 200, kMostRepeats = 1000;
/// Of an element: it is stored once, but drawn many times.
inline constexpr std::size_t kMostFaces = 20'000;

/// A place in a plane, or a range: two numbers.
using Measures = std::array<Expression, 2>;

/// One [[piece]] of an element file.
struct Piece {
  enum class Form : std::uint8_t {
    box,
    polygon,   ///< in the wall's plane, given a depth
    section,   ///< at right angles to it, given a length along x
    ring,      ///< along the inside of the opening's outline
    moulding,  ///< a profile that follows a path in the wall's plane
  } form = Form::box;
  Part part = Part::frame;
  std::optional<Expression> count, when;
  Measures x, y, z;              ///< m, from and to
  bool flat = false;             ///< polygons: a single face at z[0], which looks out of the wall
  std::vector<Measures> points;  ///< polygons (x, y), sections (z, y), paths (x, y)
  Expression width;              ///< m, of rings
  std::string profile;           ///< of mouldings: a name, or
  ProfileProgram program;        ///< a program of its own
  Expression height, projection;
};

/// Reads a [[piece]]. \param names  what expressions may ask for, without `i` and `n`
/// \throws base::InputError
Piece read_piece(base::TomlTable& table, std::span<const std::string> names, const ProfileLibrary& profiles);

/// An expression, a range and a list of places as files have them. \throws base::InputError
Expression read_expression(base::TomlTable& table, const char* key, std::span<const std::string> names);
std::vector<Measures> read_places(base::TomlTable& table, const char* key, std::span<const std::string> names);

/// Places in their order, on the grid, without those that repeat the one before. Error: not finite, or out of reach.
tl::expected<Outline, std::string> places_of(std::span<const Measures> places, std::span<const double> values);

/// The same of a polygon: nor corners that lie in a line with their neighbours; counter-clockwise. Error: no area.
tl::expected<Outline, std::string> polygon_of(std::span<const Measures> places, std::span<const double> values);

/// Adds a piece as often as it says.
/// \param values   of the names; the last two are `i` and `n`
/// \param element  its opening is there already
Made add_piece(MeshBuilder& builder, const Piece& piece, std::span<double> values, const Element& element,
               const Values& given);

}  // namespace blockrand::elements
