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
  int baseline = -1;             ///< a build that stays, and that a new one is held against as well; -1: none
  double max_drift = 10;         ///< as the four above together, against the baseline; percent
  std::string reference;         ///< hand-built models that builds are compared with, or empty
  double max_worse = 5;          ///< by how much a measure of that comparison may be worse; percent
  std::string polygon;           ///< file with the area that data are cut to, or empty
  std::string hook;              ///< command that is run when a run has ended, or empty
  std::string notify;        ///< command that is run when a run failed or was refused, or data are too old; or empty
  double max_age_hours = 0;  ///< data of the published build that are older are too old; 0: they never are
};

/// Sections [region] and [gates].
base::OptionTable<RegionOptions> region_options();

}  // namespace blockrand::run
