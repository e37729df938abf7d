// Charts of the page as inline SVG. Internal to this folder.
#pragma once

#include <string>
#include <vector>

#include "pipeline/compare/comparison_report.h"

namespace blockrand::compare {

/// Share of the surface up to each distance, one curve for each way. Empty without distances.
std::string distance_curves(const DistanceDistribution& distances);

struct HistogramRange {
  double from = 0, to = 1;  ///< what lies beyond is counted in the first and last bar, and said so
  int bars = 20;
  double ideal = 0;  ///< marked
};
/// How many matches have which value of a measure (`counted`). Empty without values.
std::string histogram(const Comparison& comparison, Measure measure, const HistogramRange& range);

/// Roof forms: the reference's in rows, the model's in columns. Empty without matches.
std::string confusion_table(const Comparison& comparison);

}  // namespace blockrand::compare
