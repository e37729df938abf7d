// Leaves of a derivation as plane polygons with looks: what rules make, on walls and on footprints.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/model/element.h"
#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::facades {

/// A leaf in the coordinates of whom it is made for; m.
struct LeafPolygons {
  std::string symbol;  ///< without the dot of shapes that no rule shall work on
  model::PartMaterial look;
  std::vector<std::vector<model::Point3>> polygons;  ///< convex, counter-clockwise from outside
  model::Point3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
};

/// \param frame  of the leaf's mesh in the wanted coordinates
/// \param usual  looks of leaves without any
LeafPolygons leaf_polygons(const grammar::Leaf& leaf, const grammar::Frame& frame, const model::PartMaterial& usual,
                           const attributes::Defaults& defaults);

/// Whether a symbol has one of the words: "WindowGlass", "window_glass", "Glass2"; "Panel" has no "pane".
bool has_word(std::string_view symbol, std::initializer_list<std::string_view> words);

}  // namespace blockrand::facades
