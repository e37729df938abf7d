// Looks that are ordered for a storey or a whole edge: a thin layer on the wall round its openings.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/element.h"

namespace blockrand::facades {

inline constexpr std::string_view kWallPaint = "wall_paint";

/// A rectangle of a wall, and what it shall look like.
struct PaintOrder {
  std::uint32_t wall = 0;      ///< index into the walls
  double left = 0, right = 0;  ///< m, in the wall's coordinates
  double low = 0, high = 0;
  model::PartMaterial look;
  std::string name;  ///< "storey 2"
};

struct WallPaint {
  model::Element element;  ///< of kind kWallPaint, with faces of the part `wall`
  model::Point2 at;        ///< its origin in the wall's coordinates
};

/// The rectangle within the wall, less the openings, as one body. \param openings  outlines in the wall's coordinates
/// \param level  later orders lie on earlier ones: 0, 1, …
/// \return  none where nothing of the wall is left
std::optional<WallPaint> wall_paint(const PaintOrder& order, const WallFrame& wall,
                                    std::span<const std::vector<model::Point2>> openings, int level);

}  // namespace blockrand::facades
