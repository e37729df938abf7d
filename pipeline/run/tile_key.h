// What the work on a tile depends on, as one hash: where it is the same as in an earlier run, so is everything that the tile's
// stages and outputs made.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>

#include "pipeline/outputs/output.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/tile_stages.h"

namespace blockrand::run {

/// Makes the keys of tiles. Read-only after construction, safe to share between threads.
///
/// A key holds: the program; options, tables of configs/ and coordinate systems; of each building of the tile what is mapped, its
/// repaired outline, what repair and import had to say of it, what classification makes of it, the preset and its
/// parameters, orders for it, the files of its grammar; of what lies around, within the reaches that the stages state
/// (ARCHITECTURE.md, law 4), outlines, streets, blocks, courtyards, points, roof lines and tagged neighbours; the same for
/// buildings of other tiles that touch one of this. Nothing that numbers things in this run alone.
class TileKeys {
 public:
  /// \param inputs   of the tiles; outlives the keys, as do the others
  /// \param shared   what all tiles depend on alike (shared_key)
  /// \param earlier  rows of what came before the tiles, sorted by object
  TileKeys(const TileInputs& inputs, const BuildInputs& files, std::string shared,
           std::span<const model::ReportRow> earlier, std::span<const std::unique_ptr<outputs::Output>> outputs);
  ~TileKeys();

  /// Lower-case hex.
  std::string key(std::size_t shard) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What all tiles of a build depend on alike, packed: options, coordinate systems, tables.
/// \param record  with its `inputs`, `crs`, `heights`
std::string shared_key(const BuildOptions& options, const BuildInputs& inputs, const BuildRecord& record);

/// The program as it runs: version and hash of its file, so that no other build of it takes what this one made.
const std::string& program_identity();

}  // namespace blockrand::run
