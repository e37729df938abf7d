// Measures of matches become measures of a comparison.
#pragma once

#include <span>

#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

MeasureSummaries summarise(std::span<const MatchResult> matches);

/// Sums of both sides' areas, counts, volumes and defects; volume only of sides where every match has one. Heights, roof
/// forms and buildings are left empty.
SideFacts total_of(std::span<const MatchResult> matches, bool model);

}  // namespace blockrand::compare
