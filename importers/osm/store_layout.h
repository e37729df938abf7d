// How the files of an ExtractStore are laid out: cells of a loose quadtree with lists of objects, and an index of them.
// Internal to the store: extract_store.h is what others use.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <osmium/osm/object.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "importers/osm/extract_store.h"

namespace blockrand::importers::osm::store_layout {

constexpr std::size_t kHashLength = 64;  // hex digits

/// Lists of a cell, each sorted by id. Late ones came with a relation.
enum class Kind : std::uint8_t { node, way, relation, late_way };

struct Chunk {
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0, crc = 0;
  Kind kind = Kind::node;
};

/// A box in units of 1e-7 degrees.
struct Box {
  std::int32_t west = 1, south = 0, east = 0, north = 0;
  bool empty() const { return west > east; }
  void add(model::Location l) { add({l.lon, l.lat, l.lon, l.lat}); }
  void add(const Box& b) {
    if (b.empty()) return;
    if (empty()) {
      *this = b;
      return;
    }
    west = std::min(west, b.west), south = std::min(south, b.south);
    east = std::max(east, b.east), north = std::max(north, b.north);
  }
  friend bool operator==(const Box&, const Box&) = default;
  bool meets(const Box& b) const {
    return !empty() && !b.empty() && west <= b.east && east >= b.west && south <= b.north && north >= b.south;
  }
  double span() const {
    if (empty()) return 0;
    return 1e-7 * std::max(static_cast<double>(east) - west, static_cast<double>(north) - south);
  }
};

struct CellEntry {
  model::TileId tile;
  Box box;  ///< of its objects
  std::string sha256;
  std::uint64_t bytes = 0;
  std::vector<Chunk> chunks;
};

struct Index {
  StoreFigures figures;
  bool placeless = false;
  std::vector<CellEntry> cells;  ///< ascending; the placeless under nowhere()
};

/// A relation that is kept.
struct StoredRelation {
  std::vector<std::int64_t> ways, relations;  ///< members
  std::set<model::TileId> cells;
  Box box;    ///< of its ways
  Box reach;  ///< of its relations as well, and of those that it is a member of
};
/// A way that relations have.
struct MemberWay {
  Box box;
  bool there = false;
  std::set<model::TileId> cells;
};
/// One that lies with its relations as well.
struct LateWay {
  std::set<model::TileId> cells;
  Box box;  ///< of its relations
  friend bool operator==(const LateWay&, const LateWay&) = default;
};

/// Relations with what they have, by id.
struct Members {
  std::map<std::int64_t, StoredRelation> relations;
  std::map<std::int64_t, MemberWay> ways;
  std::map<std::int64_t, LateWay> late;
  /// Says of all relations where they lie, and which ways lie with them, when all is known of the ways.
  void place();
};

/// What a store that comes after this one must know beside it (update_store.h).
struct Upkeep {
  Members members;
  std::map<std::int64_t, std::uint32_t> missing_nodes;  ///< how often ways name them
  std::uint32_t newest = 0;                             ///< time of an object, seconds since 1970
  std::uint64_t unused = 0;                             ///< bytes of `objects` that no cell names
  /// `nodes`, as NodeFile has it, and what is otherwise since it was written: kMissing (raw_data.h) of those that are gone.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> node_blocks;
  std::uint64_t node_bytes = 0;
  std::map<std::int64_t, model::Location> moved;
};

/// Levels of cells: the finest is 1.5 by 2.4 km at 51 degrees, the coarsest holds kWholeSpan.
constexpr int kFinest = 13, kCoarsest = 7;
/// Of pieces of lines that span more than kWholeSpan, and their length in degrees, which is less than half a cell.
constexpr int kLineLevel = 10;
constexpr double kLineStep = 0.08;

/// The cell of what has no place.
inline model::TileId nowhere() { return {kFinest + 1, ~0u, ~0u}; }
/// Degrees.
inline double size_of(int level) { return 180.0 / static_cast<double>(1u << level); }

std::uint32_t crc_of(std::string_view bytes);
inline std::string objects_path(const std::string& folder) { return folder + "/" + kStoreFiles[0]; }
inline std::string index_path(const std::string& folder) { return folder + "/" + kStoreFiles[1]; }
inline std::string upkeep_path(const std::string& folder) { return folder + "/" + kStoreFiles[2]; }
inline std::string nodes_path(const std::string& folder) { return folder + "/" + kStoreFiles[3]; }

/// A packed value and its hash. \throws base::OutputError
void write_packed(const std::string& path, std::string bytes);
/// Nothing where it is missing or damaged.
std::optional<std::string> read_packed(const std::string& path);

/// The hash of all cells, which is that of the store.
std::string sha256_of_cells(std::span<const CellEntry> cells);

/// The cell of a box that spans at most kWholeSpan: the box lies within half a cell around it.
model::TileId home_of(const Box& box);
/// Where a way is: in the cell of its box, or where a longer one leads. \param line  its known places
void find_way(const Box& box, std::span<const model::Location> line, std::set<model::TileId>& cells);

/// Degrees of a unit of Box.
constexpr double kUnit = 1e-7;

/// Rounded to the outside. \param window  west, south, east, north in degrees
Box box_of(const std::array<double, 4>& window);
/// What an object says, as bytes: without what lies between fields in memory.
std::string told(const osmium::OSMObject& object);
/// The same without version, time and values of tags that say what a building is like, not where anything is (tells_look). How many tags there
/// are, and which keys, counts: of two outlines in one place the one that tells more is built.
std::string told_place(const osmium::OSMObject& object);

}  // namespace blockrand::importers::osm::store_layout
