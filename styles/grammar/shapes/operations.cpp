#include "styles/grammar/shapes/operations.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

constexpr std::uint32_t kFirst = 1, kSecond = 2, kThird = 4, kAll = 0xffffffff;

/// Sorted by name.
constexpr OperationEntry kOperations[] = {
    {"alignScopeToAxes", 0, 1, kFirst, run_align_scope_to_axes},
    {"alignScopeToGeometry", 2, 3, kFirst | kSecond | kThird, run_align_scope_to_geometry},
    {"alignScopeToGeometryBBox", 1, 1, kFirst, run_align_scope_to_geometry_bbox},
    {"center", 1, 1, kFirst, run_center},
    {"cleanupGeometry", 2, 2, kFirst, run_cleanup_geometry},
    {"color", 1, 4, 0, run_color},
    {"convexify", 0, 1, 0, run_convexify},
    {"copyUV", 2, 2, 0, run_copy_uv},
    {"deleteHoles", 0, 0, 0, run_delete_holes},
    {"deleteTags", 0, 2, kSecond, run_delete_tags},
    {"deleteUV", 1, 1, 0, run_delete_uv},
    {"envelope", 4, 10, kFirst, run_envelope},
    {"extrude", 1, 2, kFirst, run_extrude},
    {"footprint", 0, 0, 0, run_footprint},
    {"i", 1, 4, kAll & ~kFirst, run_i},
    {"innerRect", 0, 0, 0, run_inner_rect},
    {"insertAlongUV", 3, 5, kAll & ~(kFirst | kSecond), run_insert_along_uv},
    {"mirror", 3, 3, 0, run_mirror},
    {"mirrorScope", 3, 3, 0, run_mirror_scope},
    {"normalizeUV", 3, 3, kSecond | kThird, run_normalize_uv},
    {"offset", 1, 2, kSecond, run_offset},
    {"offsetUV", 3, 3, 0, run_translate_uv},
    {"primitiveCone", 0, 3, 0, run_primitive_cone},
    {"primitiveCube", 0, 3, 0, run_primitive_cube},
    {"primitiveCylinder", 0, 3, 0, run_primitive_cylinder},
    {"primitiveDisk", 0, 2, 0, run_primitive_disk},
    {"primitiveQuad", 0, 2, 0, run_primitive_quad},
    {"primitiveSphere", 0, 3, 0, run_primitive_sphere},
    {"projectUV", 1, 1, 0, run_project_uv},
    {"r", 3, 4, kFirst, run_r},
    {"rectify", 1, 1, 0, run_rectify},
    {"resetGeometry", 0, 0, 0, run_reset_geometry},
    {"resetMaterial", 0, 1, kFirst, run_reset_material},
    {"reverseNormals", 0, 0, 0, run_reverse_normals},
    {"roofGable", 1, 6, kFirst, run_roof_gable},
    {"roofHip", 1, 4, kFirst, run_roof_hip},
    {"roofPyramid", 1, 2, kFirst, run_roof_pyramid},
    {"roofRidge", 1, 2, kFirst, run_roof_ridge},
    {"roofShed", 1, 3, kFirst, run_roof_shed},
    {"rotate", 5, 5, kFirst | kSecond, run_rotate},
    {"rotateScope", 3, 3, 0, run_rotate_scope},
    {"rotateUV", 2, 2, 0, run_rotate_uv},
    {"s", 3, 3, 0, run_s},
    {"scaleUV", 3, 3, 0, run_scale_uv},
    {"setNormals", 1, 1, kFirst, run_set_normals},
    {"setPivot", 2, 2, kFirst, run_set_pivot},
    {"setupProjection", 4, 7, kSecond, run_setup_projection},
    {"softenNormals", 1, 1, 0, run_shading},
    {"t", 3, 3, 0, run_t},
    {"tag", 1, 2, kSecond, run_tag},
    {"taper", 1, 1, 0, run_taper},
    {"texture", 1, 1, 0, run_texture},
    {"tileUV", 3, 3, 0, run_tile_uv},
    {"translate", 5, 5, kFirst | kSecond, run_translate},
    {"translateUV", 3, 3, 0, run_translate_uv},
    {"trim", 0, 0, 0, run_trim},
};
static_assert(std::ranges::adjacent_find(kOperations, std::ranges::greater_equal(), &OperationEntry::name) ==
                  std::ranges::end(kOperations),
              "find_operation() searches by halves");

}  // namespace

const OperationEntry* find_operation(std::string_view name) {
  const auto it = std::lower_bound(std::begin(kOperations), std::end(kOperations), name,
                                   [](const OperationEntry& e, std::string_view n) { return e.name < n; });
  return it != std::end(kOperations) && it->name == name ? it : nullptr;
}

}  // namespace blockrand::grammar
