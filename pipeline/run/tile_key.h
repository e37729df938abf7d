// What the work on a tile depends on, as one hash: where it is the same as in an earlier run, so is everything that the tile's
// stages and outputs made.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/outputs/output.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/tile_stages.h"
#include "pipeline/surroundings/surroundings.h"

namespace blockrand::run {

/// What can make a tile another one than in an earlier run.
enum class TilePart : std::uint8_t {
  settings,        ///< program, options, tables, what outputs show of the tile
  mapped,          ///< its buildings as mapped, orders for them
  outlines,        ///< repaired
  classification,  ///< style, era, storeys, roofs
  presets,         ///< district rules and grammars
  surroundings,    ///< what stands around, and buildings of other tiles that touch
};
inline constexpr std::size_t kTilePartCount = 6;
constexpr std::string_view name(TilePart part) {
  constexpr std::string_view names[] = {"settings", "mapped", "outlines", "classification", "presets", "surroundings"};
  return names[static_cast<std::size_t>(part)];
}

struct TileKey {
  std::string key;                                    ///< lower-case hex
  std::array<std::uint64_t, kTilePartCount> parts{};  ///< hashes: tell what differs, and no more
};

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
  /// \param around  null: no surroundings
  TileKeys(const TileInputs& inputs, const BuildInputs& files, const surroundings::SurroundingsFinder* around,
           std::string shared, std::span<const model::ReportRow> earlier,
           std::span<const std::unique_ptr<outputs::Output>> outputs);
  ~TileKeys();

  /// \param place  index of the tile among the shards that outputs know
  TileKey key(std::size_t shard, std::size_t place) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether the buildings of a finished tile stand in their blocks as they did when they were measured: their presets are then those
/// of the tile's key. \param first  number of the first one
bool positions_as_measured(const model::Region& region, std::uint32_t first, const evidence::FactsExtract& facts);

/// What all tiles of a build depend on alike, packed: options, coordinate systems, tables.
/// \param record  with its `inputs`, `crs`, `heights`
std::string shared_key(const BuildOptions& options, const BuildInputs& inputs, const BuildRecord& record);

/// The program as it runs: version and hash of its file, so that no other build of it takes what this one made.
const std::string& program_identity();

}  // namespace blockrand::run
