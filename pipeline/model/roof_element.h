// What stands in and on roofs.
#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/model/solid.h"

namespace blockrand::model {

// X(identifier, name)
// clang-format off
#define BLOCKRAND_ROOF_ELEMENTS(X) \
  X(dormer, "dormer")              \
  X(cross_gable, "cross_gable")    \
  X(roof_window, "roof_window")    \
  X(chimney, "chimney")            \
  X(parapet, "parapet")            \
  X(gable, "gable")                \
  X(firewall, "firewall")          \
  X(eaves, "eaves")                \
  X(verge, "verge")                \
  X(ridge_cap, "ridge_cap")        \
  X(hip_cap, "hip_cap")            \
  X(gutter, "gutter")              \
  X(downpipe, "downpipe")
// clang-format on

/// The semantic class of an element. Dormers and cross gables are part of the building's envelope (Roof::elements); the
/// others are bodies of their own on it (RoofInstallation): CityGML's outer building installations.
enum class RoofElementKind : std::uint8_t {
#define X(id, text) id,
  BLOCKRAND_ROOF_ELEMENTS(X)
#undef X
};

inline constexpr std::string_view kRoofElementNames[] = {
#define X(id, text) text,
    BLOCKRAND_ROOF_ELEMENTS(X)
#undef X
};
inline constexpr int kRoofElementKindCount = sizeof(kRoofElementNames) / sizeof(kRoofElementNames[0]);

constexpr std::string_view name(RoofElementKind kind) { return kRoofElementNames[static_cast<int>(kind)]; }

/// A closed body on a roof: chimney, parapet, overhanging eaves. Valid in the sense of geometry::check_solid; faces have
/// kinds of their own (an eaves' underside is an outer_ceiling).
struct RoofInstallation {
  RoofElementKind kind = RoofElementKind::chimney;
  Solid solid;
  SolidTriangles triangles;  ///< empty until LoD3 is built
};

/// The upright front of a dormer or cross gable.
struct RoofFront {
  RoofElementKind kind = RoofElementKind::dormer;
  std::uint32_t face = 0;      ///< of the LoD3 solid: a front of its own, or the wall that a cross gable is part of
  std::int32_t edge = -1;      ///< the edge of the built plan below
  Point2 middle;               ///< of its lower border on the plan
  double width = 0, foot = 0;  ///< m; height of its lower border above the height reference
};

}  // namespace blockrand::model
