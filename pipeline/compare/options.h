// What `blockrand compare` is asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "importers/reference/read_options.h"
#include "pipeline/base/option_table.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/facade_agreement.h"
#include "pipeline/compare/matching.h"
#include "pipeline/compare/surfaces.h"

namespace blockrand::compare {

/// Which offset between the models is taken off before measuring.
enum class Align : std::uint8_t { none, horizontal, vertical, both };

/// Which heights are compared.
enum class Heights : std::uint8_t {
  automatic,   ///< absolute where both models say that theirs are over the same surface, else above each building's own
               ///< ground
  own_ground,  ///< above each building's own ground
  absolute,    ///< as they stand in the files: the user knows that they are of one system
};

struct CompareOptions {
  std::string model;                   ///< a build, a folder or a file
  std::vector<std::string> reference;  ///< likewise
  importers::reference::ReadOptions model_read, reference_read;
  std::string crs;  ///< that is measured in; empty: the reference's where it is projected and in metres, else UTM
  int max_lod = 3;  ///< the highest level of detail that is taken of either
  Align align = Align::none;
  Heights heights = Heights::automatic;
  double reach = 50;  ///< m around the other model's buildings: farther ones are no part of the comparison
  MatchOptions match;
  FacadeOptions facade;
  SurfaceOptions surface;
  int jobs = 0;  ///< worker threads; 0: one per core
};

/// How users set them: section compare. CRS, jobs and seed are other commands' options, too.
base::OptionTable<CompareOptions> compare_options();

/// How users set what the report has: section compare.
base::OptionTable<ReportOptions> report_options();

/// The section of both tables, for what the command adds to them.
extern const base::OptionSection kCompareSection;

}  // namespace blockrand::compare
