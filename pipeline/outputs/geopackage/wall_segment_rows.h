// What the GeoPackage says of outlines: their wall segments, how a building stands, what repair did. Internal to this folder.
#pragma once

#include "pipeline/model/building.h"
#include "pipeline/outputs/geopackage/cell_writer.h"

namespace blockrand::outputs {

/// Appends a row for each of wall_segments(building), in the order of wall_segment_columns().
void append_edges(RowWriter& row, const model::Building& building);

/// The cells of situation_columns(); NULL where context found nothing.
void write_situation(RowWriter& row, const model::Building& building);

/// The cells of repair_columns(); NULL where repair left no record.
void write_repair(RowWriter& row, const model::RepairRecord& record);

}  // namespace blockrand::outputs
