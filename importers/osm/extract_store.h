// An extract on disk, cut into cells of the quadtree, so that any window of it can be read alone: how a region of any size is built in
// bounded memory (ARCHITECTURE.md, law 5), and how a night finds what differs from the one before.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "importers/osm/read_extract.h"
#include "pipeline/model/region.h"

namespace blockrand::importers::osm {

/// What lies in a store as a whole.
struct StoreFigures {
  std::uint64_t nodes = 0, ways = 0, relations = 0;   ///< in the extract
  std::uint64_t missing_nodes = 0, missing_ways = 0;  ///< referenced by a kept object, not in the extract
  std::string data_time;                              ///< newest time of the extract's objects, ISO 8601; or empty
  std::string sha256;                                 ///< of all kept objects, cell by cell in the order of type and id
  std::uint64_t bytes = 0;                            ///< of the store on disk
  std::uint64_t node_bytes = 0;                       ///< of the places of nodes while it was written
  bool cleaned_texts = false;                         ///< NUL characters were replaced
  bool surroundings = false;  ///< objects that only the surroundings of houses are made of are in it as well
};

/// An area of the quadtree that objects touch, with or without buildings.
struct StoredArea {
  model::TileId tile;
  std::string sha256;  ///< of what is read of the area without what lies around
};

/// What a window reads.
struct StoredPart {
  std::string sha256;
  std::uint64_t bytes = 0;  ///< on disk
};

/// An object that another store has otherwise, or lacks. Both versions together where they lie in one cell, else each by itself.
struct ChangedObject {
  model::OsmId id;
  std::uint32_t kinds = 0;  ///< model::FeatureKind bits
  bool building = false;    ///< a building or a part of one, or a relation of these
  bool network = false;     ///< may bound blocks: a street, railway, water or covered way
  bool placeless = false;   ///< a version has no known position at all
  bool look_only =
      false;  ///< a way that is a building; of tags that it had, values of storeys, roof, colours, materials or year alone differ
  bool is_surrounding = false;  ///< no more than something that stands around houses (Interest::surroundings)
  bool coast = false;           ///< it bounds the sea
  std::array<double, 4> box{};  ///< west, south, east, north in degrees
};

/// Whether a key says of a building no more than how it looks (ChangedObject::look_only).
bool tells_look(std::string_view key);

/// Writes a store in one pass over the nodes and two over ways and relations. An object lies in one cell, the smallest whose size is
/// that of its box or more, and is found in half a cell around it; a relation has all of its ways and relations with it. What spans more
/// than kWholeSpan lies where its lines lead through.
///
/// Memory: relations with their members, the boxes of their ways, 64 MB of objects on their way to the disk and as much of nodes;
/// nothing that grows with the buildings but 150 bytes for each cell of about a square mile.
/// \param folder  is made; what is there of an earlier store is replaced
/// \param surroundings  objects that only the surroundings of houses are made of, too (Interest::surroundings)
/// \returns false where the extract is not sorted by type and id, or has several versions of an object: apply_changes() without
///          changes makes such a one of it
/// \throws base::InputError   as read_extract
/// \throws base::OutputError  the store cannot be written
bool write_store(const std::string& extract, const std::string& folder, bool surroundings = false);

/// What spans more cannot be what stands around one area: what holds the area as a whole is told to it (RegionFacts::areas). Degrees.
inline constexpr double kWholeSpan = 1.0;

/// The files of a store, below its folder. The last two serve the store that comes after it (update_store.h).
inline constexpr std::array<const char*, 4> kStoreFiles{"objects", "index", "upkeep", "nodes"};

/// A store that is read. Each piece is checked as it is read.
class ExtractStore {
 public:
  /// \throws base::InputError  missing or damaged
  explicit ExtractStore(const std::string& folder);
  /// Of its two files, wherever they lie (store_files). \throws as above
  ExtractStore(std::string objects, const std::string& index);
  ~ExtractStore();
  ExtractStore(ExtractStore&&) noexcept;

  const StoreFigures& figures() const;
  /// In the order of their tiles: all that an object may touch. \param level  of the quadtree
  std::vector<StoredArea> areas(int level) const;
  /// \param window  west, south, east, north in degrees
  StoredPart part(const std::array<double, 4>& window) const;
  /// Building objects without any known position: they belong to no area.
  bool has_placeless() const;

  /// As read_extract of the whole with the box of the options; counts of the file are those of the cells that the box meets.
  /// \param placeless  objects without any known position, too
  /// \throws base::InputError  damaged
  model::Extract read(const ReadOptions& options, bool placeless) const;

  /// What differs from an earlier store, in the order of cells. Reads the cells that differ.
  /// \throws base::InputError  one of both is damaged
  std::vector<ChangedObject> changes_since(const ExtractStore& before) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blockrand::importers::osm
