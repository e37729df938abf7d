// A comparison made by hand, small and with everything in it that a report may stumble over.
#pragma once

#include <string>

#include "pipeline/compare/comparison_report.h"

namespace blockrand::compare::test {

/// What no format takes as it is.
inline const std::string kNastyId = "W 1 \"Müller\",\n<script>alert('x')</script> & Söhne";

/// `matches` boxes against boxes that are 0.5 m higher, in EPSG:25832; the first one has the nasty id, windows, facades
/// and a left-out side; the second one has no facades, no openings and no volume. One building of each side has no
/// match.
Comparison sample(std::size_t matches = 3);

/// Distances as long as the z of the point: enough for a heat map.
std::vector<float> sample_distances(const MatchResult& match, bool from_model, std::span<const Point3> points);

/// Sets a measure of one match.
void set(MatchResult& match, Measure measure, double value);
/// Sums up again, as compare_cities does.
void sum_up(Comparison& comparison);

}  // namespace blockrand::compare::test
