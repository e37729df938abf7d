// What rules can ask about the building and the wall that they work on.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/facades/facade_segments.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/building.h"
#include "styles/grammar/language/value.h"

namespace blockrand::facades {

/// What fronts on the roof take over from the facades below.
struct WindowsBelow {
  std::string kind;          ///< "double_casement"; empty: no windows
  double width = 0;          ///< m, of the topmost storey's
  std::string frame_colour;  ///< #rrggbb
};

struct FacadeContext {
  const model::Building& building;
  const model::BuildingPart& part;
  const WallFrame& wall;
  const FacadeSegment& segment;
  double eaves = 0;  ///< m above the height reference, of the part: eaves_level()
  /// Of the windows that the facades of the part have; null before they are laid out.
  const WindowsBelow* windows = nullptr;
  const attributes::Defaults* defaults = nullptr;  ///< what uses are; null: nobody lives there
};

/// One value that rules may read: "building.storeys". docs/grammar_attributes.md is printed from the list.
struct ContextAttribute {
  std::string_view name, unit, meaning;
  grammar::Value (*read)(const FacadeContext&);
};

/// All of them, by name.
const std::vector<ContextAttribute>& context_attributes();
std::optional<grammar::Value> context_value(const FacadeContext& context, std::string_view name);
/// Whether a name of the list has one value on all walls of a part.
bool is_of_part(std::string_view name);

/// m from the left end of the wall segment to each mapped entrance, in order, each place once.
std::vector<double> entrance_places(const FacadeContext& context);

/// Looks ordered for a storey, and where it lies in the wall when storeys are even (or as high as ordered).
struct StoreyLook {
  std::size_t storey = 0;
  std::string colour, material;  ///< empty: not ordered
  double low = 0, high = 0;      ///< m, in the wall's coordinates, up to the eaves
};
std::vector<StoreyLook> storey_looks(const FacadeContext& context);

/// What is ordered of an edge that the wall segment belongs to; empty: nothing.
std::string edge_order(const FacadeContext& context, std::string_view key);

/// Orders of storeys, edges and bays that nothing reads. One sentence each, with the place of the order.
std::vector<std::string> unread_overrides(const model::Building& building);

}  // namespace blockrand::facades
