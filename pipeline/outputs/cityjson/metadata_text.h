// What every CityJSON file begins with.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/outputs/cityjson/object_text.h"
#include "pipeline/outputs/cityjson/vertex_table.h"

namespace blockrand::outputs {

/// Appends `"name":`, behind a comma unless it is the first of its object.
void append_member(std::string& out, std::string_view name, bool first = false);
/// Appends a vertex as an array of three whole numbers.
void append_vertex(std::string& out, const GridPoint& p);
/// Appends the value of "transform": steps of the grid, counted from the origin.
void append_transform(std::string& out, const GridOrigin& origin);
/// Appends the value of "metadata".
void append_metadata(std::string& out, const CityJsonOptions& options, const Extent& extent, const GridOrigin& origin);

}  // namespace blockrand::outputs
