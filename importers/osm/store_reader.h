// Reads the cells of an ExtractStore. Internal to the store.
#pragma once

#include <array>
#include <fstream>
#include <functional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/entity_bits.hpp>
#include <span>
#include <string>
#include <vector>

#include "importers/osm/store_layout.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::osm::store_layout {

struct StoreReader {
  /// \param objects, index  files \throws base::InputError  missing or damaged
  StoreReader(std::string objects, const std::string& index);

  std::string objects;  ///< path
  Index index;

  static base::InputError damaged(const std::string& path) {
    return base::InputError(path, "", "is damaged or missing", "Run again: it is made from the extract");
  }

  /// Calls `visit` for each object of one kind of a cell, one list after the other, with its box. \throws base::InputError
  void visit_cell(const CellEntry& cell, Kind kind, std::ifstream& in,
                  const std::function<void(const Box&, std::string_view object)>& visit) const;
  /// The objects of one kind, one after the other. \param windows  empty: all
  osmium::memory::Buffer load(const CellEntry& cell, Kind kind, std::span<const Box> windows, std::ifstream& in) const;
  const CellEntry* find(const model::TileId& tile) const;
  /// Those whose objects may meet the window, ascending. \param window  west, south, east, north in degrees
  std::vector<const CellEntry*> cells_of(const std::array<double, 4>& window) const;
  /// \param windows  what meets none of them may be left out; empty: nothing is
  void for_each(const std::vector<const CellEntry*>& cells, std::span<const Box> windows,
                osmium::osm_entity_bits::type type, const std::function<void(const osmium::OSMObject&)>& visit) const;
};

}  // namespace blockrand::importers::osm::store_layout
