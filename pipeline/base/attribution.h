// Whose data all results are made from.
#pragma once

namespace blockrand::base {

/// Stands in every picture, page and file of a build: the licence of the data asks for it
/// (https://www.openstreetmap.org/copyright).
inline constexpr const char* kAttribution = "\u00a9 OpenStreetMap contributors, ODbL 1.0";

}  // namespace blockrand::base
