// The columns of the GeoPackage's layers: one list for the tables, their descriptions and the rows.
#pragma once

#include <vector>

#include "pipeline/layer_file/table.h"

namespace blockrand::outputs {

using layer_file::Column;
using layer_file::ColumnKind;

/// Columns in the order of the table, without `fid` and `geom`. Those of buildings and parts hold, for each attribute x
/// of model::for_each_attribute and in its order, `x`, `x_source`, `x_confidence`.
/// After the attributes, buildings have style_columns(), situation_columns() and repair_columns().
std::vector<Column> building_columns();
std::vector<Column> part_columns();
std::vector<Column> reported_columns();
std::vector<Column> tile_columns();
std::vector<Column> surface_columns();
std::vector<Column> wall_segment_columns();
std::vector<Column> block_columns();
std::vector<Column> courtyard_columns();
std::vector<Column> cell_columns();
std::vector<Column> footprint_before_columns();
std::vector<Column> unmapped_columns();

// In context_columns.cpp:
std::vector<Column> style_columns();      ///< probabilities of classification
std::vector<Column> situation_columns();  ///< how a building stands to its neighbours and its block
std::vector<Column> repair_columns();     ///< what repair did to its outline

}  // namespace blockrand::outputs
