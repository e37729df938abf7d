// The parts of the page, from its head to its foot. Internal to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/compare/comparison_report.h"

namespace blockrand::compare {

// All texts are XML as they stand: ids and paths are escaped.

/// Title, what was compared, what it says in words, and the links to the sections.
std::string head_section(const Comparison& comparison);
/// Files, CRS, heights, breaches; the offset between the models.
std::string input_section(const Comparison& comparison);
std::string measure_section(const Comparison& comparison);
std::string distribution_section(const Comparison& comparison);
std::string roof_section(const Comparison& comparison);
std::string surface_section(const Comparison& comparison);  ///< classes, what is left out, validity
std::string unmatched_section(const Comparison& comparison);

/// Worst and best ten, and the table of all matches.
/// \param order  indices of the matches, those with the largest distance first
std::string match_tables(const Comparison& comparison, std::span<const std::size_t> order);
/// One match in detail.
/// \param pictures  with elevations and rendered pictures
std::string match_section(const Comparison& comparison, std::size_t match, bool pictures,
                          const DistanceQuery& distances, const ReportOptions& options);
/// What the colours of pictures, plans and elevations mean.
std::string picture_legend(const ReportOptions& options);

/// "m17": where a match stands in the page.
std::string anchor_of(std::size_t match);

}  // namespace blockrand::compare
