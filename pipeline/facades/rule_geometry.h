// What rule files make beside orders of elements: extrusions, inserted pieces, painted and sunk faces become bodies on a wall.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/element.h"
#include "styles/grammar/evaluation/derive.h"

namespace blockrand::facades {

/// The kind of elements that leaves became.
inline constexpr std::string_view kRuleGeometry = "rule_geometry";

/// One body: leaves that lie in the wall together share an opening, all others are bodies of their own.
struct RuleBody {
  model::Element element;  ///< its name is that of the rule's symbol, its kind kRuleGeometry
  std::array<model::PartMaterial, model::kElementPartCount> materials;
  model::Point2 at;        ///< where its origin lies in the wall's coordinates
  std::size_t leaves = 0;  ///< that it consists of
};

struct RuleGeometry {
  std::vector<RuleBody> bodies;
  model::PartMaterial ground;  ///< what the wall looks like: most of the leaves in its plane
  std::size_t bare = 0;        ///< leaves in the wall's plane that look like that: the wall is what they show
  std::size_t yielding = 0;    ///< leaves, and bodies in openings, in a portal
  std::map<std::string, std::size_t> dropped;  ///< by "Symbol: why"
  std::vector<std::string> textures;  ///< images that rules put on leaves, each once: the model shows colours alone
};

/// A portal of a passage: what rules make is cut off there.
struct KeptFree {
  double left = 0, right = 0, high = 0;  ///< m, in the wall's coordinates, from the ground up
};

/// Whether the rules of a program can make anything but elements and bare pieces of a flat wall: then leaves need not be looked at.
bool makes_geometry(const grammar::Program& program);

/// \param leaves  of a derivation on the wall; those with orders are passed over
/// \param wall    what the scopes' object coordinates mean: x along, y up, z out of the wall
/// \param usual    looks of leaves without any
/// \param painted  what the wall looks like by another derivation on it; null: this is the first
RuleGeometry rule_geometry(std::span<const grammar::Leaf> leaves, const WallFrame& wall,
                           std::span<const KeptFree> portals, const model::PartMaterial& usual,
                           const model::PartMaterial* painted, const attributes::Defaults& defaults);

/// A body of an opening, moved before the wall.
model::Element before_wall(const model::Element& sunk);

}  // namespace blockrand::facades
