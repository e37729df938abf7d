// What presets, district rules and overrides ask of masonry: parameters of every preset, whatever its rule file.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/colour.h"
#include "styles/grammar/language/value.h"
#include "styles/masonry/masonry.h"

namespace blockrand::facades {

/// Names that read_masonry_orders() reads (docs/masonry.md).
std::span<const std::string_view> masonry_parameters();
bool is_masonry_parameter(std::string_view name);

struct MasonryOrders {
  std::optional<masonry::Bond> bond;  ///< none: as the wall's material has it
  std::string format;                 ///< of bricks; empty: normal
  std::optional<double> length, height, joint, relief;
  std::optional<model::Colour> colour, mortar, dressings;
  std::size_t most_triangles = 0;  ///< of a wall
  bool street_only = false;
};

/// \param values  the first of a name counts
/// \param complaints  gets what is unknown or out of range, one sentence each; what is usual is taken instead
/// \return none where no masonry is asked for
std::optional<MasonryOrders> read_masonry_orders(std::span<const std::pair<std::string, grammar::Value>> values,
                                                 std::vector<std::string>& complaints);

/// How stones of a bond are laid by the orders. \param complaints  gets sizes that do not fit together; the usual ones are taken
masonry::Masonry masonry_of(const MasonryOrders& orders, masonry::Bond bond, std::vector<std::string>& complaints);

}  // namespace blockrand::facades
