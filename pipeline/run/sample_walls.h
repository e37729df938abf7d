// What facades take on the disk, measured where they will stand: they depend on the style, which no count of walls knows.
#pragma once

#include <optional>
#include <span>

#include "pipeline/run/estimate.h"

namespace blockrand::run {

/// Bytes on the disk of a m2 of outer wall, all asked formats together, from up to three tiles of the extract that are built as the
/// options say, but not written. Nothing where there are no walls or no format has facades, or where reading the extract
/// that often would take long.
/// \param shards        what is to be built; of the extract, or of a part
/// \param read_seconds  what reading the extract takes
/// \throws base::InputError, base::UsageError  as a build does
std::optional<double> sample_walls(const model::Extract& extract, std::span<const footprints::Shard> shards,
                                   const TownSize& town, const BuildOptions& options, double read_seconds);

}  // namespace blockrand::run
