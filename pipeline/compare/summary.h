// Measures of matches become measures of a comparison.
#pragma once

#include <span>

#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

/// How far ratios lie from 1 on average: exp of the mean of |log ratio|, so that twice and half do not cancel. At least
/// 1; a ratio of nothing counts as a hundredth, one of more than a hundred as a hundred. 1 without ratios.
double mean_factor(std::span<const double> ratios);

MeasureSummaries summarise(std::span<const MatchResult> matches);

/// Sums of both sides' areas, counts, volumes and defects; volume only of sides where every match has one. Heights,
/// roof forms and buildings are left empty.
SideFacts total_of(std::span<const MatchResult> matches, bool model);

}  // namespace blockrand::compare
