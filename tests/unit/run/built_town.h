// A real extract taken through all stages of a build in memory, for tests that judge what comes out.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/options.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"

namespace blockrand::run::test {

/// An extract of ../shared/data/osm, repaired, with its context. Ground lies at height 0.
class BuiltTown {
 public:
  explicit BuiltTown(const std::filesystem::path& file);
  ~BuiltTown();
  const model::Extract& extract() const;
  const footprints::FootprintStore& footprints() const;
  const georef::Projection& projection() const;
  const attributes::Defaults& defaults() const;
  const std::vector<footprints::Shard>& shards() const;
  /// The shard of a building, by its number in `footprints`.
  std::size_t shard_of(std::uint32_t building) const;
  /// run_tile: attributes and, at lod 1 and 2, solids. Repair's table of rows stays behind.
  model::Region tile(std::size_t shard, int lod) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Those of the extracts' default options.
const attributes::GenerateOptions& usual_generation();

}  // namespace blockrand::run::test
