// `blockrand validate`: everything that a build wrote is read back and checked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/validate/finding_log.h"
#include "pipeline/validate/options.h"

namespace blockrand::validate {

/// Something that was checked, and how much of it.
struct Checked {
  std::string what, how;  ///< "GLB tiles", "glTF 2.0, metadata, bounds, georeference"
  std::uint64_t count = 0;
  std::string unit;  ///< "files", "solids"
};

struct Validation {
  std::vector<Checked> checked;         ///< in the order in which it was checked
  std::vector<std::string> notes;       ///< what could not be checked, and why
  std::string position_source;          ///< in words; empty where no positions were compared
  std::uint64_t positions = 0;          ///< corners that were compared with OpenStreetMap
  double worst_glb = 0, worst_crs = 0;  ///< m: the largest distance in GLBs, and in CityGML and CityJSON, of corners
                                        ///< that repair left where they are
  std::uint64_t positions_moved = 0;    ///< of the corners: of buildings that repair moved corners of
  double worst_moved = 0;               ///< m: the largest distance of these
  double worst_median = 0;              ///< m: the median over buildings, of the format where it is the largest
  FindingLog findings;
  bool sound() const { return findings.count() == 0; }
};

/// Reads a build back. Memory is bounded by the tiles in work; findings come in the same order whatever `jobs` is.
/// \throws base::UsageError   the folder is no build
/// \throws base::InputError   `extract` or `schemas` cannot be read
Validation validate(const ValidateOptions& options, base::Progress& progress);

/// The text for people: a table of what was checked, findings by code, and a verdict in the last line.
std::string validation_text(const ValidateOptions& options, const Validation& validation);
std::string validation_json(const ValidateOptions& options, const Validation& validation);

}  // namespace blockrand::validate
