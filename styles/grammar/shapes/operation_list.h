// The operations by subject; operations.cpp has the table.
#pragma once

#include "styles/grammar/shapes/arguments.h"

namespace blockrand::grammar {

#define BLOCKRAND_OPERATION(name) Result name(Shape&, const OperationInput&, Arguments)

// scope_operations.cpp
BLOCKRAND_OPERATION(run_t);
BLOCKRAND_OPERATION(run_translate);
BLOCKRAND_OPERATION(run_s);
BLOCKRAND_OPERATION(run_r);
BLOCKRAND_OPERATION(run_rotate);
BLOCKRAND_OPERATION(run_center);
BLOCKRAND_OPERATION(run_align_scope_to_axes);
BLOCKRAND_OPERATION(run_align_scope_to_geometry);
BLOCKRAND_OPERATION(run_align_scope_to_geometry_bbox);
BLOCKRAND_OPERATION(run_rotate_scope);
BLOCKRAND_OPERATION(run_mirror_scope);
BLOCKRAND_OPERATION(run_mirror);
BLOCKRAND_OPERATION(run_set_pivot);
BLOCKRAND_OPERATION(run_reset_geometry);
// insert.cpp
BLOCKRAND_OPERATION(run_i);
BLOCKRAND_OPERATION(run_primitive_quad);
BLOCKRAND_OPERATION(run_primitive_disk);
BLOCKRAND_OPERATION(run_primitive_cube);
BLOCKRAND_OPERATION(run_primitive_sphere);
BLOCKRAND_OPERATION(run_primitive_cylinder);
BLOCKRAND_OPERATION(run_primitive_cone);
BLOCKRAND_OPERATION(run_trim);
// raise_operations.cpp
BLOCKRAND_OPERATION(run_extrude);
BLOCKRAND_OPERATION(run_taper);
// roofs.cpp
BLOCKRAND_OPERATION(run_roof_hip);
BLOCKRAND_OPERATION(run_roof_gable);
BLOCKRAND_OPERATION(run_roof_shed);
BLOCKRAND_OPERATION(run_roof_pyramid);
BLOCKRAND_OPERATION(run_roof_ridge);
// offset.cpp
BLOCKRAND_OPERATION(run_offset);
// inner_rectangle.cpp
BLOCKRAND_OPERATION(run_inner_rect);
// envelope.cpp
BLOCKRAND_OPERATION(run_envelope);
// uv_operations.cpp
BLOCKRAND_OPERATION(run_setup_projection);
BLOCKRAND_OPERATION(run_project_uv);
BLOCKRAND_OPERATION(run_tile_uv);
BLOCKRAND_OPERATION(run_scale_uv);
BLOCKRAND_OPERATION(run_translate_uv);
BLOCKRAND_OPERATION(run_rotate_uv);
BLOCKRAND_OPERATION(run_normalize_uv);
BLOCKRAND_OPERATION(run_copy_uv);
BLOCKRAND_OPERATION(run_delete_uv);
// tag_operations.cpp
BLOCKRAND_OPERATION(run_tag);
BLOCKRAND_OPERATION(run_delete_tags);
BLOCKRAND_OPERATION(run_insert_along_uv);
// mesh_operations.cpp
BLOCKRAND_OPERATION(run_reverse_normals);
BLOCKRAND_OPERATION(run_delete_holes);
BLOCKRAND_OPERATION(run_cleanup_geometry);
BLOCKRAND_OPERATION(run_convexify);
BLOCKRAND_OPERATION(run_rectify);
BLOCKRAND_OPERATION(run_footprint);
BLOCKRAND_OPERATION(run_shading);  // softenNormals: faces here are flat shaded, the geometry is what it was
// normals.cpp
BLOCKRAND_OPERATION(run_set_normals);
// shape_materials.cpp
BLOCKRAND_OPERATION(run_color);
BLOCKRAND_OPERATION(run_texture);
BLOCKRAND_OPERATION(run_reset_material);

#undef BLOCKRAND_OPERATION

}  // namespace blockrand::grammar
