// The account of a build: in which state each object of the extract ends, and what is reported of it
// (ARCHITECTURE.md, law 1).
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "pipeline/footprints/shard.h"
#include "pipeline/model/extract.h"
#include "pipeline/outputs/explain/explanation.h"
#include "pipeline/run/build.h"
#include "pipeline/run/outcome.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {

class Account {
 public:
  /// \param extract  outlives the account, which sets the states of its objects and takes over its report
  /// \param rows     of what came before the tiles
  Account(model::Extract& extract, std::vector<model::ReportRow> rows);

  /// Rows from before the tiles, sorted.
  std::span<const model::ReportRow> earlier() const { return earlier_; }
  /// What becomes of an object, looked up by its index: of a tile's objects. Safe from several threads.
  /// \param extract  that the indices are of: that of the account, or what the tile was worked on with
  std::function<outputs::FinalState(std::uint32_t)> final_states(const std::vector<Outcome>& outcomes,
                                                                 const model::Extract& extract) const;

  /// Takes over what a tile decided, in tile order.
  void take(const Outcomes& outcomes, std::vector<model::ReportRow> rows, BuildSummary& summary);
  /// Counts states and rows. An object in no state is a bug of a stage: it is reported as UNACCOUNTED and named in the
  /// summary.
  /// \param tile    built alone: objects of other tiles were read as surroundings only. An object is told where the tile is that
  ///               decided on it, else, where what came before the tiles did, in the tile of its own place
  /// \param shards  all \param todo  those that were built
  void close(const std::optional<TileChoice>& tile, std::span<const footprints::Shard> shards,
             std::span<const std::size_t> todo, BuildSummary& summary);

  /// Of all objects; sorted once the account is closed.
  const std::vector<model::ReportRow>& rows() const { return rows_; }

 private:
  outputs::FinalState final_state_of(const Outcome& outcome, const model::Extract& extract) const;

  model::Extract& extract_;
  std::vector<model::ReportRow> rows_, earlier_;
  std::vector<std::uint8_t> decided_;  ///< by index: a tile did it
  std::set<model::OsmId> incomplete_;  ///< objects whose outline lacks members
};

}  // namespace blockrand::run
