// Laid stones as bodies before a wall.
#pragma once

#include <array>

#include "pipeline/model/element.h"
#include "styles/masonry/masonry.h"

namespace blockrand::masonry {

/// How much of the stones is modelled, from most to least.
enum class ReliefDetail : std::uint8_t {
  full,       ///< fronts with bevelled sides
  fronts,     ///< fronts alone
  dressings,  ///< arches, lintels, sills and quoins, with their sides; the field is bare wall
  none,
};
constexpr std::string_view name(ReliefDetail detail) {
  constexpr std::string_view names[] = {"full", "fronts", "dressings", "none"};
  return names[static_cast<int>(detail)];
}

struct ReliefOptions {
  double mortar = 0.006;  ///< m before the wall where sides of stones begin: the mortar lies there
  double relief = 0.008;  ///< m of fronts before the mortar; irregular stones vary by up to a quarter of it
  double bevel = 0.003;   ///< m that fronts are smaller all round
  bool irregular = false;
  double from = 0, to = 0;               ///< of the wall that was laid
  double turn_left = 0, turn_right = 0;  ///< degrees that the wall turns at its ends, where stones go round the corner
  std::size_t most_triangles = 0;
};

/// Coordinates of the wall (x along it, y up), z out of it.
struct Relief {
  std::array<model::ElementMesh, 3> field;  ///< by shade
  model::ElementMesh dressings;  ///< voussoirs, keystones, lintels, sills; of all but brick bonds quoins, too
  ReliefDetail detail = ReliefDetail::none;
  std::size_t triangles = 0;
};

/// The most detailed relief of no more than `most_triangles`.
/// \param quoins_dressed  quoins look like dressings, not like the field
Relief relief_of(const LaidWall& wall, const ReliefOptions& options, bool quoins_dressed);

/// Triangles that cover a simple polygon, counter-clockwise; indices of its points.
std::vector<std::array<std::uint32_t, 3>> triangles_of_outline(const std::vector<model::Point2>& outline);

}  // namespace blockrand::masonry
