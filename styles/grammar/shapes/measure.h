// geometry.*: what a rule can ask about a shape's geometry.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

/// Every function works on the geometry as it is (docs/rule_language.md §3.2); shapes without geometry give 0, false or
/// nothing. `selector` is a word such as top, side, world.south, vertical: only faces that it takes count.

double geometry_area(const Shape& shape);  ///< m², holes taken off
/// Nothing when the word is no selector of faces.
std::optional<double> geometry_area(const Shape& shape, std::string_view selector);
double geometry_volume(const Shape& shape);           ///< m³, of closed geometry; 0 for open
double geometry_height(const Shape& shape);           ///< m, extent along the world's y
double geometry_boundary_length(const Shape& shape);  ///< m, of all edges with one face; of closed meshes 0
std::int64_t geometry_face_count(const Shape& shape);
std::int64_t geometry_edge_count(const Shape& shape);  ///< shared ones once
std::int64_t geometry_vertex_count(const Shape& shape);
std::int64_t geometry_hole_count(const Shape& shape);
bool geometry_is_concave(const Shape& shape);  ///< some face has a reflex corner or a hole
bool geometry_is_planar(const Shape& shape, double tolerance_degrees);
bool geometry_is_rectangular(const Shape& shape,
                             double tolerance_degrees);  ///< every face has four corners, right within the tolerance
bool geometry_is_closed(const Shape& shape);             ///< every edge is run along twice, in opposite directions
std::optional<bool> geometry_is_oriented(const Shape& shape, std::string_view selector);  ///< at least one face
/// degrees. maxSlope, azimuth (clockwise from north), zenith; nothing for other words. Of the first face for azimuth
/// and zenith.
std::optional<double> geometry_angle(const Shape& shape, std::string_view word);
/// Extent of a UV set, in its own units or in metres on the surface; 0 without the set.
double geometry_uv_extent(const Shape& shape, bool v, bool unit_space, int set);
double geometry_uv_minimum(const Shape& shape, bool v, int set);
double geometry_uv_maximum(const Shape& shape, bool v, int set);
bool geometry_has_uvs(const Shape& shape, int set);
bool geometry_is_tagged(const Shape& shape, std::string_view query);
/// Tags of faces, edges and vertices that match the query (all when empty), sorted, each once.
std::vector<std::string> geometry_tags(const Shape& shape, std::string_view query = {});
std::vector<std::string> geometry_materials(const Shape& shape);

}  // namespace blockrand::grammar
