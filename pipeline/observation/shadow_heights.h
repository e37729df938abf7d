// How high buildings are, by the shadows that one image shows of them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/observation/image_windows.h"
#include "pipeline/observation/lean.h"
#include "pipeline/observation/row_match.h"
#include "pipeline/observation/shadows.h"

namespace blockrand::observation {

/// The sun of an image.
struct ImageSun {
  std::optional<model::Point2> towards;  ///< unit vector in plan; nothing: no shadows, or none that agree
  double per_metre = 0;                  ///< m of shadow on level ground for each metre of height; 0: not known
  double uncertainty = 0;                ///< of `per_metre`, as its share
  std::uint64_t houses = 0;              ///< whose heights it was measured by
  bool tagged = false;                   ///< these are tagged; else guessed by the size of their plans
};

struct ShadowHeight {
  ShadowLength shadow;
  double height = 0;  ///< m above ground of the edge that casts the shadow; 0: nothing is known
};

struct ShadowHeights {
  ImageSun sun;
  std::vector<ShadowHeight> buildings;
};

/// All buildings of an image.
struct ShadowInputs {
  std::span<const SightedOutline> sighted;  ///< by building
  std::span<const double> heights;          ///< m: tagged or guessed, by building; no shadow told them
  std::span<const double> uncertainty;      ///< of them, as their share
  const footprints::FootprintStore& footprints;
  const footprints::BoxIndex& index;  ///< of its boxes
  std::function<SearchedOutline(std::uint32_t)> outline;
  const ImageWindows& windows;
  int workers;
};

/// Measures the shadows behind the walls of each building that was sighted.
///
/// A roof's edge at height h is seen h * k from its foot (LeanField), its shadow on level ground h * s: they are
/// h * |s - k| apart. Where the sun stands is told by all houses together; how long shadows are for each metre, by houses
/// of known height (median of length over height).
/// \param field  as far as it is known; of an unknown lean k is 0
/// \param sun    of an earlier round; else it is looked for
ShadowHeights measure_shadows(const ShadowInputs& in, const LeanField& field, const ImageSun& sun);

}  // namespace blockrand::observation
