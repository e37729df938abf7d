// What region.toml says of a region that is rebuilt again and again, beside the options of its builds.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/base/option_table.h"

namespace blockrand::run {

struct RegionOptions {
  int keep = 7;                      ///< published builds that stay, the current one among them
  std::string replication;           ///< folder of change files with sequence numbers (replication.h), or empty
  std::int64_t first_sequence = -1;  ///< of the first change file to apply, where the extract does not say; -1: it does

  // Gates: what a new build may lose against the published one; percent.
  double max_lost = 2;           ///< of the buildings that were modelled
  double max_added = 25;         ///< of as many
  double max_simpler = 2;        ///< points of the share of buildings that are simpler than asked or have no model
  double max_height_change = 5;  ///< of the mean height of buildings that both have
};

/// Sections [region] and [gates].
base::OptionTable<RegionOptions> region_options();

}  // namespace blockrand::run
