// All plain explanations of a tile at once, for a page that shows the tile.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace blockrand::outputs {

/// A JSON object, {"w123":{"title":"Arkonaplatz 5, 10435 Berlin","lines":["What it is: …",…]},…}, with every building of a tile
/// that explanations speak of, in the order of the tile's file.
/// \param folder  the output folder of a build; of one in areas, the area that has the tile is found
/// \param tile    "15_35206_25947", as a stranger may ask for it: nothing but digits and '_' is looked up
/// \returns empty for a tile that the build does not have, and for what is no tile
/// \throws base::InputError  the tile's file is damaged
std::optional<std::string> explained_tile(const std::string& folder, std::string_view tile);

}  // namespace blockrand::outputs
