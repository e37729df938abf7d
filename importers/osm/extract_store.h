// An extract on disk, cut into areas of the quadtree, so that each can be read alone: how a region of any size is built in bounded
// memory (ARCHITECTURE.md, law 5).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "importers/osm/read_extract.h"
#include "pipeline/model/region.h"

namespace blockrand::importers::osm {

/// What lies in a store as a whole.
struct StoreFigures {
  int level = 0;                                      ///< of its areas
  double halo = 0;                                    ///< m
  std::uint64_t nodes = 0, ways = 0, relations = 0;   ///< in the extract
  std::uint64_t missing_nodes = 0, missing_ways = 0;  ///< referenced by a kept object, not in the extract
  std::string data_time;                              ///< newest time of the extract's objects, ISO 8601; or empty
  std::string sha256;                                 ///< of all kept objects in the order of type and id
  std::uint64_t bytes = 0;                            ///< of the store on disk
  std::uint64_t node_bytes = 0;                       ///< of the places of nodes while it was written
  bool cleaned_texts = false;                         ///< NUL characters were replaced
};

/// The objects that an area needs: those that touch it or what lies within the halo around it, each whole.
struct StoredArea {
  model::TileId tile;
  std::string sha256;       ///< of these objects
  std::uint64_t bytes = 0;  ///< on disk
};

/// Writes a store in one pass over the nodes and two over ways and relations. What spans at most kWholeSpan is in every area that its
/// box touches; a larger way in those that it leads through, a larger relation in those of its ways.
///
/// Memory: relations with their members, the boxes of their ways, 64 MB of objects on their way to the disk and as much of nodes;
/// nothing that grows with the buildings.
/// \param folder  is made; what is there of an earlier store is replaced
/// \returns false where the extract is not sorted by type and id, or has several versions of an object: apply_changes() without
///          changes makes such a one of it
/// \throws base::InputError   as read_extract
/// \throws base::OutputError  the store cannot be written
bool write_store(const std::string& extract, const std::string& folder, int level, double halo);

/// What spans more cannot be what stands around one area: what holds the area as a whole is told to it (RegionFacts::areas). Degrees.
inline constexpr double kWholeSpan = 1.0;

/// A store that is read. Each piece is checked as it is read.
class ExtractStore {
 public:
  /// \throws base::InputError  missing or damaged
  explicit ExtractStore(std::string folder);
  ~ExtractStore();
  ExtractStore(ExtractStore&&) noexcept;

  const StoreFigures& figures() const;
  /// In the order of their tiles: all that an object touches, with or without buildings.
  const std::vector<StoredArea>& areas() const;
  /// Building objects without any known position: they belong to no area.
  bool has_placeless() const;

  /// As read_extract of the whole with the box of the options, where that lies within the area and its halo; counts of the file are
  /// those of the area's objects. \param placeless  objects without any known position, too
  /// \throws base::InputError  damaged
  model::Extract read(const model::TileId& area, const ReadOptions& options, bool placeless) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blockrand::importers::osm
