// What the program's exit code says (ARCHITECTURE.md, "Exit codes").
#pragma once

namespace blockrand::cli {

enum ExitCode : int {
  kSuccess = 0,
  kWrongUsage = 1,     ///< options, or an output place that can be none: a file, the root, a folder of others
  kInvalidInput = 2,   ///< an input that is unreadable or invalid
  kBelowQuality = 3,   ///< finished with buildings below the asked quality; only with --strict
  kTooOld = 3,         ///< of a region: the published data are older than max_age_hours
  kInternalError = 4,  ///< the output could not be written, or a bug
  kRefused = 5,        ///< built, but refused by a gate: nothing was published
  kNotOutward = 6,     ///< built and published here, but not everywhere that region.toml names
  kSignalBase = 128,   ///< ended by a signal: 128 plus its number
};

}  // namespace blockrand::cli
