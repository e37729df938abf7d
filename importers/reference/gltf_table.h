// Property tables of EXT_structural_metadata: what a file says of its features. Internal to this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importers/reference/gltf_file.h"
#include "importers/reference/note_log.h"

namespace blockrand::importers::reference {

/// A table with its values as texts.
struct FeatureTable {
  struct Column {
    std::string name;
    bool is_id = false;                            ///< has the semantic ID
    std::vector<std::optional<std::string>> rows;  ///< nothing where a value is the column's noData
  };
  std::size_t rows = 0;
  std::vector<Column> columns;  ///< in the order of their names

  /// Column of that name with different writings ("measuredHeight", "measured_height"); null for none.
  const Column* column(std::initializer_list<std::string_view> names) const;
};

/// All tables of a file. Texts, numbers, truth values and enumerations are read; arrays, vectors and matrices noted.
/// A table that does not fit its buffers has no rows.
std::vector<FeatureTable> read_tables(GltfFile& file, const std::string& path, NoteLog& notes);

}  // namespace blockrand::importers::reference
