// Places of all nodes of an extract, on disk: a block of neighbouring ids at a time is in memory. Internal to this folder.
#pragma once

#include <cstdint>
#include <fstream>
#include <list>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::importers::osm {

/// Written once in the order of files (ids below zero first, by their size), then read. About 6 bytes a node on disk; in memory 16
/// bytes for each block and the blocks that were read last.
class NodeFile {
 public:
  static constexpr std::size_t kBlock = 512;            ///< nodes
  static constexpr std::size_t kBlocksInMemory = 8192;  ///< 64 MB

  /// \throws base::OutputError
  explicit NodeFile(std::string path);
  /// One that was kept. \param blocks, bytes  as it was said when it was
  NodeFile(std::string path, std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks, std::uint64_t bytes);
  /// Removes the file, unless it is kept.
  ~NodeFile();
  NodeFile(const NodeFile&) = delete;
  NodeFile& operator=(const NodeFile&) = delete;

  /// \throws base::OutputError
  void add(std::int64_t id, model::Location place);
  /// No node is added afterwards. \throws base::OutputError
  void finish();
  /// kMissing (raw_data.h) where there is no such node. \throws base::InputError  the file cannot be read any more
  model::Location find(std::int64_t id);

  std::uint64_t bytes() const { return bytes_; }

  /// Leaves the file when it is done. \returns  first key and place of each block
  std::vector<std::pair<std::uint64_t, std::uint64_t>> keep() {
    kept_ = true;
    return blocks_;
  }

 private:
  using Block = std::vector<std::pair<std::uint64_t, model::Location>>;
  void write_block();
  const Block& block(std::size_t index);

  std::string path_;
  bool kept_ = false;
  std::ofstream out_;
  std::ifstream in_;
  Block pending_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks_;  ///< first key, place in the file
  std::uint64_t bytes_ = 0;
  std::list<std::pair<std::size_t, Block>> recent_;  ///< the last one first
  std::unordered_map<std::size_t, decltype(recent_)::iterator> loaded_;
};

}  // namespace blockrand::importers::osm
