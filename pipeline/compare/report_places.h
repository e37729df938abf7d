// Where buildings stand and what they are called. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/compare/city.h"

namespace blockrand::compare {

/// Centroid of the building's footprints, m in the city's CRS; without a footprint the middle of the box of its faces.
Point2 place_of(const City& city, const Building& building);

/// Ids with "; " between them, as the files have them: not escaped.
std::string ids_of(const City& city, const std::vector<std::uint32_t>& buildings);

/// The city's name, which may be a long list of paths, cut between two paths after at most `most` bytes or the first
/// path. Not escaped.
std::string short_name(const City& city, std::size_t most);

}  // namespace blockrand::compare
