// The presets that rules may name: configs/styles/presets.toml.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/roof_shape.h"
#include "pipeline/model/style.h"

namespace blockrand::base {
class TomlTable;
}

namespace blockrand::districts {

/// What a preset says of houses that wear it where no tag does. Metres and degrees; what is empty is that of the style.
struct PresetMeasures {
  std::optional<double> ground_floor_height;                     ///< floor to floor
  std::optional<double> storey_height;                           ///< of the other storeys, floor to floor
  std::optional<double> plinth;                                  ///< from the ground up to the ground floor
  std::vector<std::pair<model::RoofShape, double>> roof_shapes;  ///< shares, sum 1: one is drawn for each house
  std::optional<double> roof_pitch;                              ///< above 0
  std::optional<bool> gable_to_street;  ///< true: the ridge runs square to the street where the lot is narrow
};

struct Preset {
  std::string name;
  std::string description;  ///< one line
  model::StyleClass style = model::StyleClass::other;
  std::vector<std::string> substyles;  ///< ids of the catalogue of styles that it is meant for
  std::string grammar{};               ///< rule file below configs/grammars; empty: its walls stay closed
  /// The same for what stands on its roof; none: the usual one (roofscape.cga); empty: nothing stands there.
  std::optional<std::string> roof_grammar{};
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< values of the rule files' attributes, by name
  std::optional<PresetMeasures> measures{};
  std::string declared_in{};  ///< file of the rule set; empty: of the list of presets
};

/// Reads a list of presets, in alphabetical order of names.
/// \throws base::InputError  with file, line and column
std::vector<Preset> read_presets(const std::string& path);

/// One preset, from the table of its name.
Preset read_preset(const std::string& name, base::TomlTable table);

/// kNoPreset where there is none.
inline constexpr std::size_t kNoPreset = static_cast<std::size_t>(-1);
std::size_t find_preset(const std::vector<Preset>& presets, std::string_view name);

}  // namespace blockrand::districts
