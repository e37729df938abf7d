// The comparison of two models: reading, registration, matching, measuring.
#pragma once

#include "pipeline/base/progress.h"
#include "pipeline/compare/comparison.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/options.h"

namespace blockrand::compare {

/// Reads both models and compares them. The result does not depend on the number of threads, on the order of files, on
/// how a model was cut into tiles, and (to rounding) on how its surfaces were cut into polygons.
/// \throws base::InputError, base::UsageError  as read_city
Comparison compare_models(const CompareOptions& options, base::Progress& progress);

/// Compares two cities in one CRS with one origin.
Comparison compare_cities(City model, City reference, const CompareOptions& options, base::Progress& progress);

/// Distances for heat maps, measured as compare_cities does. The comparison must outlive it.
DistanceQuery distance_query(const Comparison& comparison);

}  // namespace blockrand::compare
