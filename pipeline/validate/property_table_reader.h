// The property tables of a GLB (EXT_structural_metadata), row by row.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/validate/glb_container.h"

namespace blockrand::validate {

/// A row: column → text, without what is noData. Numbers as the shortest text of their value (normalised ones
/// decoded), enums by name.
using TableRow = std::map<std::string, std::string>;

/// Reads the first property table and checks the extension's rules: identifiers, schema, enums, types, lengths,
/// offsets, alignment, UTF-8, noData; and what Blockrand promises of its class: unique ids that belong to their
/// building, JSON objects where JSON is promised. What the column `sources` of the attribute profile `people` groups stands
/// in the rows as `<column>_source` as well. Breaches are noted as METADATA_RULE.
/// \return the rows as far as they could be read
std::vector<TableRow> read_property_table(const GlbContainer& glb);

}  // namespace blockrand::validate
