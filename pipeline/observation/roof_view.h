// What an image shows on a roof: its colour, whether slopes meet on it, and along which line.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/polygon.h"
#include "pipeline/observation/courtyard_view.h"
#include "pipeline/observation/image_windows.h"

namespace blockrand::observation {

enum class RoofForm : std::uint8_t { unknown, flat, pitched };
constexpr std::string_view name(RoofForm form) {
  constexpr std::string_view names[] = {"unknown", "flat", "pitched"};
  return names[static_cast<int>(form)];
}

/// Along a line in a roof: what differs between both of its sides, in levels of 255 by the roof's brightness.
struct RidgeEvidence {
  double angle = 0;        ///< degrees counter-clockwise from east, [0, 180)
  double contrast = 0;     ///< of the strips beside it, by the mean brightness of both; > 0: the left one is brighter
  double wide = 0;         ///< the same of strips that reach farther
  double within = 0;       ///< deviation of brightness along the wide strips, by its mean: two slopes are even
  double consistency = 0;  ///< of its metres: on which the same side is the brighter one, [0, 1]
  double line = 0;         ///< of a narrow strip on it from both sides, by their brightness
  double offset = 0;       ///< from the middle of the plan, of half its extent across the line, [0, 1]
  double length = 0;       ///< m in the plan
  double halves = 0;       ///< as contrast, of all that lies on both sides of the plan's middle, whatever the line
};

/// What the strips along a roof's edges have in common: sums over their pixels of brightness b and of the edge's unit
/// normal n (outward). Slopes fall to their eaves: where edges turn to the sun, they are bright.
struct EdgeStrips {
  double count = 0, b = 0, bb = 0, nx = 0, ny = 0, bnx = 0, bny = 0, nxx = 0, nxy = 0, nyy = 0;
};

struct RoofView {
  std::uint32_t image = 0;              ///< that shows it; set by observe_extract()
  std::uint32_t pixels = 0;             ///< of the roof that the image shows
  std::optional<model::Colour> colour;  ///< of its sunlit part, as the image has it
  double colour_confidence = 0;
  RoofForm form = RoofForm::unknown;
  double form_confidence = 0;
  std::optional<double> ridge;  ///< degrees clockwise from grid north, [0, 180)
  double ridge_confidence = 0;
  // What the answers are made from.
  std::array<RidgeEvidence, 2> ridges;   ///< the clearest line along the plan's main direction, and across it
  double long_side = 0, short_side = 0;  ///< m, of the plan in these directions; the first is along
  EdgeStrips strips;
  double spread = 0;                      ///< of brightness over the roof, by its mean
  double green = 0;                       ///< share of its pixels that have the colour of leaves and grass
  std::vector<CourtyardView> courtyards;  ///< that are mapped as holes in its outline; see look_at_courtyards()
};

/// Where the sun stands in an image: clockwise from grid north, degrees; from the brighter sides of all its roofs.
/// Nothing where they do not agree.
std::optional<double> sun_azimuth(std::span<const RoofView> roofs);

/// Decides on form and ridge by the evidence. Slopes that meet are told by what the sun does to them: of a line across
/// which one side turns to the sun that side is the brighter one. \param sun  of the image, as sun_azimuth() has it
void judge_roof(RoofView& roof, double sun);

/// Looks at a roof: its colour, and evidence for judge_roof(). \param plan  where the image shows the roof, m in the build CRS; windows hold it
RoofView look_at_roof(std::span<const model::Polygon> plan, const ImageWindows& windows);

}  // namespace blockrand::observation
