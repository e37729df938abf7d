// What an image shows in the holes of a mapped outline: open courtyards, or roofs over them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/observation/image_windows.h"

namespace blockrand::observation {

enum class CourtyardState : std::uint8_t { unknown, open, built_over };
constexpr std::string_view name(CourtyardState s) {
  constexpr std::string_view names[] = {"unknown", "open", "perhaps_built_over"};
  return names[static_cast<int>(s)];
}

/// What was measured of a hole and of the roof around it.
struct CourtyardEvidence {
  double alike = 0;   ///< how much the colours within are those of the roof around: Bhattacharyya's coefficient, [0, 1]
  double level = 0;   ///< by how much the brightest fifth within differs from that of the roof around, by the latter
  double dark = 0;    ///< share of pixels within that are darker than all but a twentieth of the roof around
  double green = 0;   ///< share of pixels within that have the colour of leaves and grass
  double edge = 0;    ///< score_outline() of the hole's ring, the best within half a metre
  double around = 0;  ///< the mean of its scores within 1.5 m
};

/// One hole of an outline.
struct CourtyardView {
  double area = 0;        ///< m2, of the hole
  double built_over = 0;  ///< probability
  CourtyardState state = CourtyardState::unknown;
  CourtyardEvidence evidence;
};

/// m2: smaller holes are shafts, in which no image shows a ground.
inline constexpr double kLeastCourtyard = 15;
/// Probabilities from which on it is said.
inline constexpr double kSureOpen = 0.9, kSureBuiltOver = 0.9;

/// Looks into each hole of kLeastCourtyard and more. What the image does not show, or what is mostly filled by other buildings, is left out.
/// \param plan    where the image shows the roof, m in the build CRS; windows hold it
/// \param others  buildings that stand in its holes, in the same way
std::vector<CourtyardView> look_at_courtyards(std::span<const model::Polygon> plan,
                                              std::span<const model::Polygon> others, const ImageWindows& windows);

/// How likely it is that a roof lies over it, were as many built over as open.
double built_over_probability(const CourtyardEvidence& evidence);

}  // namespace blockrand::observation
