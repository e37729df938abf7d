// What a build will take, told before it: from what an extract holds and what is asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/footprints/shard.h"
#include "pipeline/model/extract.h"
#include "pipeline/outputs/output_size.h"
#include "pipeline/run/options.h"

namespace blockrand::run {

/// What decides how much a build takes.
struct TownSize {
  outputs::BuiltSize all;   ///< the whole
  outputs::BuiltSize tile;  ///< its largest tile
  std::uint64_t tiles = 0;  ///< that hold a building
};

/// Counts buildings that can be built, and what they have of outer walls: the edges that no second building has, as high as the tagged
/// storeys; where none are tagged, as the middle of those in the extract.
/// \param shards  of the extract, or those of it that are built
TownSize town_size(const model::Extract& extract, std::span<const footprints::Shard> shards);

/// Of so many buildings of which nothing is known.
outputs::BuiltSize usual_size(std::uint64_t buildings);

/// Bytes on the disk of all asked formats. \param per_wall  bytes of a m2 of outer wall, where they were measured
std::uint64_t disk_bytes(const outputs::BuiltSize& size, const BuildOptions& options,
                         std::optional<double> per_wall = std::nullopt);

struct BuildEstimate {
  double seconds = 0;  ///< a rough figure
  /// Right within a factor of 1.5: tests/bench/estimate.py.
  std::uint64_t memory_bytes = 0, disk_bytes = 0;
};

/// \param read_seconds  what reading the extract took here
/// \param store_bytes   memory of this process after reading it
/// \param per_wall      as disk_bytes() has it
BuildEstimate estimate(const TownSize& town, const BuildOptions& options, double read_seconds,
                       std::uint64_t store_bytes, std::optional<double> per_wall = std::nullopt);

/// Memory that this process has now, and had at most.
std::uint64_t current_memory();
std::uint64_t peak_memory();

}  // namespace blockrand::run
