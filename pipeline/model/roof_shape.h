// Roof shapes: the one table of what each is called, how it is built and what it is like (docs/roofs.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

namespace blockrand::model {

enum class RoofShape : std::uint8_t;

/// Shapes that look alike: reports, statistics and classification count by these.
enum class RoofGroup : std::uint8_t {
  flat,
  gabled,
  cross_gabled,
  hipped,
  pyramidal,
  mansard,
  saltbox,  ///< one slope longer or steeper than the other, or both up to a deck
  shed,     ///< one slope
  folded,   ///< several such slopes: butterfly, sawtooth
  round,    ///< vaults, and what stands on towers
  other,
};

// ---- how a roof is constructed: each construction is one builder of styles/roofs, with what it asks of a shape

/// What rises from an eaves edge (docs/roofs.md, "Shapes by the weighted straight skeleton").
enum class EavesProfile : std::uint8_t {
  one_pitch,
  broken,   ///< steep, then low
  vaulted,  ///< pitches that follow a quarter of an ellipse
  decked,   ///< one pitch up to a flat deck
  berlin,   ///< steep from the street, low from the yard, a knee wall there
};

/// What rises from the edge at the end of a wing. All but hips and gables go with EavesProfile::one_pitch alone.
enum class WingEnds : std::uint8_t {
  hips,          ///< the same as from eaves
  gables,        ///< upright
  half_hips,     ///< upright, then a hip
  gablets,       ///< a hip, then upright
  one_hip,       ///< one end a hip, the others gables
  one_half_hip,  ///< one end a half-hip, the others gables
};

/// Rings around an apex.
enum class ApexProfile : std::uint8_t { pyramid, dome, onion, spire };

/// Heights along one direction across the plan.
enum class CrossProfile : std::uint8_t { skillion, saltbox, butterfly, gabled_height_moved, sawtooth };

/// One horizontal surface.
struct LevelRoof {};
/// Slopes from every edge, by the weighted straight skeleton.
struct EdgeRoof {
  EavesProfile eaves;
  WingEnds ends;
};
/// Rings of the plan, scaled about an apex.
struct ApexRoof {
  ApexProfile profile;
  /// What stands on plans without such an apex: an EdgeRoof; or an ApexRoof, then vaulted from all edges under its
  /// name.
  RoofShape relative;
};
/// A gable over every edge, and ridges or lozenges from there to the apex.
struct CrossedRoof {
  double gable_height;  ///< share of the roof's height
  RoofShape relative;   ///< an EdgeRoof, which stands on plans without such an apex
};
/// One profile across the whole plan.
struct ProfileRoof {
  CrossProfile profile;
  bool falls_one_way;  ///< to where the longest edge looks, whatever the axis; else square to the axis
};
/// Drawn by ways and nodes of the map.
struct LinedRoof {};
/// The name says no shape; a level roof stands for it.
struct UnknownRoof {};

using RoofConstruction = std::variant<LevelRoof, EdgeRoof, ApexRoof, CrossedRoof, ProfileRoof, LinedRoof, UnknownRoof>;

/// The pitch of roofs that no tag measures, degrees; of broken slopes that of the lower one.
struct UsualPitch {
  double own = 0;    ///< of the shape; 0: that of the building's use
  double most = 90;  ///< the use's, at most
};

/// Which ornamental gables may stand before a roof (docs/sources.md, Holtmeier 5.2).
enum class OrnamentalGable : std::uint8_t {
  none,
  gable,  ///< stepped and curved ones, which hide the roof's own gable
  attic,
};

/// What is known of a shape. Members without a value here are given in every row: the compiler names those forgotten.
struct RoofTraits {
  std::string_view name;  ///< in all outputs and configuration files; the value of roof:shape, if `is_tag_value`
  RoofGroup group;
  RoofConstruction construction;
  bool one_pitch;  ///< from the eaves up, so that roof:angle gives a height without doubt
  bool lent;       ///< neighbours of a house without a tag lend it; a dome or a tower's helmet is one building's own
  OrnamentalGable ornament;
  UsualPitch pitch = {};
  bool is_tag_value = true;                       ///< roof:shape may name it
  std::array<std::string_view, 5> synonyms = {};  ///< other values of roof:shape: lower case, gaps as underscores
};

// X(identifier, "name", designated initialisers of the other members of RoofTraits). The order is that of the numbers in
// outputs: new shapes go to the end. Sources of the usual pitches: docs/style_measures.md 2.7.
#define BLOCKRAND_ROOF_SHAPES(X)                                                                                       \
  X(flat, "flat", .group = RoofGroup::flat, .construction = LevelRoof{}, .one_pitch = false, .lent = true,             \
    .ornament = OrnamentalGable::attic, .synonyms = {"flat_roof"})                                                     \
  X(gabled, "gabled", .group = RoofGroup::gabled, .construction = EdgeRoof{EavesProfile::one_pitch, WingEnds::gables}, \
    .one_pitch = true, .lent = true, .ornament = OrnamentalGable::gable,                                               \
    .synonyms = {"gable", "pitched", "saddle", "dual_pitched"})                                                        \
  X(gabled_height_moved, "gabled_height_moved", .group = RoofGroup::gabled,                                            \
    .construction = ProfileRoof{CrossProfile::gabled_height_moved, false}, .one_pitch = false, .lent = false,          \
    .ornament = OrnamentalGable::none, .pitch = {.most = 30})                                                          \
  /* The usual pitch is that of the lean-to roofs of side wings: 5 to 20. */                                           \
  X(skillion, "skillion", .group = RoofGroup::shed, .construction = ProfileRoof{CrossProfile::skillion, true},         \
    .one_pitch = true, .lent = true, .ornament = OrnamentalGable::none, .pitch = {.most = 10},                         \
    .synonyms = {"shed", "lean_to", "monopitch", "mono_pitched", "single_pitch"})                                      \
  X(hipped, "hipped", .group = RoofGroup::hipped, .construction = EdgeRoof{EavesProfile::one_pitch, WingEnds::hips},   \
    .one_pitch = true, .lent = true, .ornament = OrnamentalGable::attic, .synonyms = {"hip"})                          \
  X(half_hipped, "half-hipped", .group = RoofGroup::hipped,                                                            \
    .construction = EdgeRoof{EavesProfile::one_pitch, WingEnds::half_hips}, .one_pitch = true, .lent = true,           \
    .ornament = OrnamentalGable::gable, .synonyms = {"half_hip", "jerkinhead"})                                        \
  X(side_hipped, "side_hipped", .group = RoofGroup::hipped,                                                            \
    .construction = EdgeRoof{EavesProfile::one_pitch, WingEnds::one_hip}, .one_pitch = true, .lent = true,             \
    .ornament = OrnamentalGable::attic)                                                                                \
  X(side_half_hipped, "side_half-hipped", .group = RoofGroup::hipped,                                                  \
    .construction = EdgeRoof{EavesProfile::one_pitch, WingEnds::one_half_hip}, .one_pitch = true, .lent = false,       \
    .ornament = OrnamentalGable::gable)                                                                                \
  X(hipped_and_gabled, "hipped-and-gabled", .group = RoofGroup::hipped,                                                \
    .construction = EdgeRoof{EavesProfile::one_pitch, WingEnds::gablets}, .one_pitch = true, .lent = false,            \
    .ornament = OrnamentalGable::none, .synonyms = {"hipped_gabled"})                                                  \
  /* The usual pitch stands where the roof is too low for an attic storey. */                                          \
  X(mansard, "mansard", .group = RoofGroup::mansard, .construction = EdgeRoof{EavesProfile::broken, WingEnds::hips},   \
    .one_pitch = false, .lent = true, .ornament = OrnamentalGable::gable, .pitch = {.own = 65})                        \
  X(gambrel, "gambrel", .group = RoofGroup::mansard, .construction = EdgeRoof{EavesProfile::broken, WingEnds::gables}, \
    .one_pitch = false, .lent = true, .ornament = OrnamentalGable::gable, .pitch = {.own = 65},                        \
    .synonyms = {"gambrel_roof"})                                                                                      \
  X(pyramidal, "pyramidal", .group = RoofGroup::pyramidal,                                                             \
    .construction = ApexRoof{ApexProfile::pyramid, RoofShape::hipped}, .one_pitch = true, .lent = true,                \
    .ornament = OrnamentalGable::none, .synonyms = {"pyramid", "tented"})                                              \
  X(crosspitched, "crosspitched", .group = RoofGroup::cross_gabled, .construction = CrossedRoof{1, RoofShape::gabled}, \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .synonyms = {"cross_gabled"})                \
  /* Workshops: 30 to 60 degrees, over teeth of 5 m. */                                                                \
  X(sawtooth, "sawtooth", .group = RoofGroup::folded, .construction = ProfileRoof{CrossProfile::sawtooth, true},       \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 30},                        \
    .synonyms = {"saw_tooth"})                                                                                         \
  X(butterfly, "butterfly", .group = RoofGroup::folded, .construction = ProfileRoof{CrossProfile::butterfly, false},   \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.most = 10})                       \
  X(cone, "cone", .group = RoofGroup::round, .construction = ApexRoof{ApexProfile::pyramid, RoofShape::hipped},        \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 55},                        \
    .synonyms = {"conical"})                                                                                           \
  /* Half a sphere. */                                                                                                 \
  X(dome, "dome", .group = RoofGroup::round, .construction = ApexRoof{ApexProfile::dome, RoofShape::dome},             \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 45})                        \
  X(onion, "onion", .group = RoofGroup::round, .construction = ApexRoof{ApexProfile::onion, RoofShape::dome},          \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 55})                        \
  /* Halls: the rise is a quarter to a third of the span. */                                                           \
  X(round, "round", .group = RoofGroup::round, .construction = EdgeRoof{EavesProfile::vaulted, WingEnds::gables},      \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 30},                        \
    .synonyms = {"barrel", "rounded"})                                                                                 \
  X(saltbox, "saltbox", .group = RoofGroup::saltbox, .construction = ProfileRoof{CrossProfile::saltbox, true},         \
    .one_pitch = false, .lent = true, .ornament = OrnamentalGable::none, .pitch = {.most = 30})                        \
  /* A steep strip 2 to 5 m high: over 0.6 of half a house's depth 45 degrees give 3 to 4 m. */                        \
  X(double_saltbox, "double_saltbox", .group = RoofGroup::saltbox,                                                     \
    .construction = EdgeRoof{EavesProfile::decked, WingEnds::gables}, .one_pitch = false, .lent = true,                \
    .ornament = OrnamentalGable::none, .pitch = {.own = 45})                                                           \
  X(quadruple_saltbox, "quadruple_saltbox", .group = RoofGroup::saltbox,                                               \
    .construction = EdgeRoof{EavesProfile::decked, WingEnds::hips}, .one_pitch = false, .lent = true,                  \
    .ornament = OrnamentalGable::none, .pitch = {.own = 45})                                                           \
  X(spire, "spire", .group = RoofGroup::round, .construction = ApexRoof{ApexProfile::spire, RoofShape::hipped},        \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 70})                        \
  X(helm, "helm", .group = RoofGroup::other, .construction = CrossedRoof{0.5, RoofShape::hipped}, .one_pitch = false,  \
    .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 60})                                            \
  X(many, "many", .group = RoofGroup::other, .construction = UnknownRoof{}, .one_pitch = false, .lent = false,         \
    .ornament = OrnamentalGable::none, .synonyms = {"multiple"})                                                       \
  /* A value of roof:shape that no row knows. */                                                                       \
  X(other, "other", .group = RoofGroup::other, .construction = UnknownRoof{}, .one_pitch = false, .lent = false,       \
    .ornament = OrnamentalGable::none)                                                                                 \
  /* From ways tagged roof:ridge and roof:edge. */                                                                     \
  X(lined, "lined", .group = RoofGroup::other, .construction = LinedRoof{}, .one_pitch = false, .lent = false,         \
    .ornament = OrnamentalGable::none, .is_tag_value = false)                                                          \
  /* The Berliner Dach has no value of its own in OSM. Its slopes have pitches of their own. */                        \
  X(berlin, "berlin", .group = RoofGroup::saltbox, .construction = EdgeRoof{EavesProfile::berlin, WingEnds::gables},   \
    .one_pitch = false, .lent = false, .ornament = OrnamentalGable::none, .pitch = {.own = 45}, .is_tag_value = false)

enum class RoofShape : std::uint8_t {
#define X(id, ...) id,
  BLOCKRAND_ROOF_SHAPES(X)
#undef X
};

/// The table, by shape.
inline constexpr RoofTraits kRoofTraits[] = {
#define X(id, text, ...) RoofTraits{.name = text, __VA_ARGS__},
    BLOCKRAND_ROOF_SHAPES(X)
#undef X
};
inline constexpr std::size_t kRoofShapeCount = sizeof(kRoofTraits) / sizeof(kRoofTraits[0]);

inline constexpr auto kRoofShapeNames = [] {
  std::array<std::string_view, kRoofShapeCount> names;
  for (std::size_t i = 0; i < kRoofShapeCount; ++i) names[i] = kRoofTraits[i].name;
  return names;
}();

constexpr const RoofTraits& traits(RoofShape shape) { return kRoofTraits[static_cast<std::size_t>(shape)]; }
constexpr std::string_view name(RoofShape shape) { return traits(shape).name; }

/// The shape of exactly this name.
constexpr std::optional<RoofShape> roof_shape(std::string_view text) {
  for (std::size_t i = 0; i < kRoofShapeCount; ++i)
    if (kRoofTraits[i].name == text) return static_cast<RoofShape>(i);
  return std::nullopt;
}

/// What the builder of one construction needs to know of a shape; null for shapes of other constructions.
template <class Construction>
constexpr const Construction* constructed_as(RoofShape shape) {
  return std::get_if<Construction>(&traits(shape).construction);
}

/// Is the shape made by the weighted straight skeleton, with eaves at two sides of a house at least?
constexpr bool rises_from_edges(RoofShape shape) { return constructed_as<EdgeRoof>(shape) != nullptr; }

/// Does the name say no shape?
constexpr bool is_unknown(RoofShape shape) { return constructed_as<UnknownRoof>(shape) != nullptr; }

enum class RoofOrientation : std::uint8_t { along, across };

/// What an edge of a plan means to the roof above it.
enum class RoofEdge : std::uint8_t {
  open,        ///< a free side: eaves or a gable
  street,      ///< looks on a street
  courtyard,   ///< looks on a courtyard
  party_wall,  ///< a neighbour's wall: the roof ends upright there
};

}  // namespace blockrand::model
