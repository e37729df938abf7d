// What looks like a building where none is mapped: candidates for a person to look at, never buildings by themselves.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/observation/imagery.h"
#include "pipeline/observation/lean.h"
#include "pipeline/observation/mapped_ground.h"

namespace blockrand::observation {

/// From this probability on a candidate is told.
inline constexpr double kTellUnmapped = 0.85;
/// m2: of a candidate's outline.
inline constexpr double kLeastUnmapped = 20, kMostUnmapped = 3000;

/// One image that fits, and what is known of it. All references outlive the call.
struct UnmappedSearch {
  const model::Extract& extract;
  const footprints::FootprintStore& footprints;
  const footprints::BoxIndex& index;  ///< of its boxes
  const georef::Projection& projection;
  const ImageWindows& windows;  ///< of half a metre
  const LeanField& field;
  std::span<const double> eaves;                ///< m, by building
  std::function<bool(std::uint32_t)> in_image;  ///< of a building
  std::optional<model::Point2> to_sun;          ///< unit vector in plan
  std::uint32_t image = 0;
  int workers = 1;
};

/// Looks at the ground of an image around the mapped buildings, square by square of a fixed grid: what has one colour, or up to
/// four that meet in ridges, fills a rectangle whose sides lie on edges, and has a colour that roofs have. Mapped buildings as
/// far as they lean, streets, railways, water, car parks and pitches are left out, and what lies beyond the convex hull of the mapped buildings.
/// \returns  all that was measured, the likeliest first, none on another; from kTellUnmapped on they are candidates.
///           Deterministic for any number of workers.
std::vector<UnmappedBuilding> find_unmapped(const UnmappedSearch& search);

/// Those of several images together: of two that lie on each other the less likely one goes. The likeliest first.
std::vector<UnmappedBuilding> without_overlaps(std::vector<UnmappedBuilding> candidates);

/// How likely it is that what was measured is a building.
double unmapped_probability(const UnmappedEvidence& evidence);

}  // namespace blockrand::observation
