// Roof shapes of the Simple 3D Buildings scheme.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace blockrand::model {

// X(identifier, OSM value)
#define BLOCKRAND_ROOF_SHAPES(X)                                                                                  \
  X(flat, "flat") X(gabled, "gabled") X(gabled_height_moved, "gabled_height_moved") X(skillion, "skillion")       \
  X(hipped, "hipped") X(half_hipped, "half-hipped") X(side_hipped, "side_hipped")                                 \
  X(side_half_hipped, "side_half-hipped") X(hipped_and_gabled, "hipped-and-gabled") X(mansard, "mansard")         \
  X(gambrel, "gambrel") X(pyramidal, "pyramidal") X(crosspitched, "crosspitched") X(sawtooth, "sawtooth")         \
  X(butterfly, "butterfly") X(cone, "cone") X(dome, "dome") X(onion, "onion") X(round, "round")                   \
  X(saltbox, "saltbox") X(double_saltbox, "double_saltbox") X(quadruple_saltbox, "quadruple_saltbox")             \
  X(spire, "spire") X(helm, "helm") X(many, "many") X(other, "other")               \
  X(lined, "lined") X(berlin, "berlin")

/// `other` stands for a value that no list knows; `lined` is built from roof:ridge and roof:edge ways, and no tag's
/// value; `berlin` is the Berliner Dach, steep to the street and low to the yard, which has no value of its own in OSM.
enum class RoofShape : std::uint8_t {
#define X(id, text) id,
  BLOCKRAND_ROOF_SHAPES(X)
#undef X
};

inline constexpr std::string_view kRoofShapeNames[] = {
#define X(id, text) text,
    BLOCKRAND_ROOF_SHAPES(X)
#undef X
};

constexpr std::string_view name(RoofShape shape) { return kRoofShapeNames[static_cast<int>(shape)]; }

constexpr std::optional<RoofShape> roof_shape(std::string_view text) {
  for (std::size_t i = 0; i < sizeof(kRoofShapeNames) / sizeof(kRoofShapeNames[0]); ++i)
    if (kRoofShapeNames[i] == text) return static_cast<RoofShape>(i);
  return std::nullopt;
}

enum class RoofOrientation : std::uint8_t { along, across };

/// What an edge of a plan means to the roof above it.
enum class RoofEdge : std::uint8_t {
  open,       ///< a free side: eaves or a gable
  street,     ///< looks on a street
  courtyard,  ///< looks on a courtyard
  party_wall, ///< a neighbour's wall: the roof ends upright there
};

}  // namespace blockrand::model
