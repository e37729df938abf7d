// Frames, leaves, panes and bars: what windows and doors are joined of. Internal to this folder.
#pragma once

#include "styles/elements/parameters.h"

namespace blockrand::elements {

/// m. How far a leaf lies behind its frame, glass behind its leaf, and a panel behind its leaf.
inline constexpr double kLeafBack = 0.015, kGlassBack = 0.030, kPanelBack = 0.015;
/// m. Panes and panels narrower or lower than this are refused.
inline constexpr double kLeastPane = 0.05;

struct Bars {
  int level = 0, upright = 0;
  double width = 0.03;
};

/// Leaves side by side that fill a convex hole.
struct Leaves {
  int count = 1;
  double stile = 0.05;  ///< m; 0: panes right in the hole, divided by `bars` alone
  Bars bars;
  double z = 0;  ///< of the leaves' front
  Part part = Part::frame;
  bool sides = true;    ///< the edges of the panes' holes; without them glass lies kApart behind the leaf
  bool strips = false;  ///< cover strips where two leaves meet
};

/// Adds leaves, glass and bars. Error: no room.
Made add_leaves(MeshBuilder& builder, const Outline& hole, const Leaves& leaves);

/// Adds glass bars over a pane that lies in the plane `glass`.
Made add_bars(MeshBuilder& builder, const Outline& pane, const Bars& bars, double front, double glass, Part part);

/// A convex outline standing proud: front and sides, no back.
void add_strip(MeshBuilder& builder, const Outline& outline, double z_front, double z_back, Part part);

/// The outline with its lower edge moved to y.
Outline with_foot(Outline outline, double y);

Made no_room(std::string_view what);

}  // namespace blockrand::elements
