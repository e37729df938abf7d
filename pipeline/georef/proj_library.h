// PROJ itself, loaded when its first function is called: it brings forty libraries.
#pragma once

#include <proj.h>

/// Every function of PROJ that this program calls.
#define BLOCKRAND_PROJ_FUNCTIONS(F)                                    \
  F(proj_area_create)                                                  \
  F(proj_area_destroy)                                                 \
  F(proj_area_set_bbox)                                                \
  F(proj_as_proj_string)                                               \
  F(proj_context_create)                                               \
  F(proj_context_destroy)                                              \
  F(proj_context_set_enable_network)                                   \
  F(proj_coord)                                                        \
  F(proj_coordoperation_get_accuracy)                                  \
  F(proj_coordoperation_has_ballpark_transformation)                   \
  F(proj_coordoperation_is_instantiable)                               \
  F(proj_create)                                                       \
  F(proj_create_crs_to_crs)                                            \
  F(proj_create_from_database)                                         \
  F(proj_create_operation_factory_context)                             \
  F(proj_create_operations)                                            \
  F(proj_crs_get_coordinate_system)                                    \
  F(proj_crs_get_sub_crs)                                              \
  F(proj_cs_get_axis_count)                                            \
  F(proj_cs_get_axis_info)                                             \
  F(proj_destroy)                                                      \
  F(proj_errno_reset)                                                  \
  F(proj_get_area_of_use)                                              \
  F(proj_get_id_auth_name)                                             \
  F(proj_get_id_code)                                                  \
  F(proj_get_name)                                                     \
  F(proj_get_source_crs)                                               \
  F(proj_get_type)                                                     \
  F(proj_is_crs)                                                       \
  F(proj_list_destroy)                                                 \
  F(proj_list_get)                                                     \
  F(proj_list_get_count)                                               \
  F(proj_log_level)                                                    \
  F(proj_normalize_for_visualization)                                  \
  F(proj_operation_factory_context_destroy)                            \
  F(proj_operation_factory_context_set_allow_ballpark_transformations) \
  F(proj_operation_factory_context_set_area_of_interest)               \
  F(proj_operation_factory_context_set_grid_availability_use)          \
  F(proj_operation_factory_context_set_spatial_criterion)              \
  F(proj_trans)

namespace blockrand::georef::detail {

struct ProjFunctions {
#define BLOCKRAND_PROJ_MEMBER(name) decltype(&::name) name = nullptr;
  BLOCKRAND_PROJ_FUNCTIONS(BLOCKRAND_PROJ_MEMBER)
#undef BLOCKRAND_PROJ_MEMBER
};

/// Safe to call from any thread; stays loaded to the end of the program.
/// \throws base::UsageError  PROJ is not there, or is another one than this program was compiled with
const ProjFunctions& proj();

}  // namespace blockrand::georef::detail
