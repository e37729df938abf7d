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
  model::SidePitches side_pitches;                               ///< of single sides of the roof
  std::optional<bool> gable_to_street;  ///< true: the ridge runs square to the street where the lot is narrow
};

/// What a preset promises of the houses that wear it: measured on the finished house, each miss is told (REQUIREMENT_MISSED).
/// Metres and ratios; what is empty asks nothing. The set is Holtmeier's (2020, section 5).
struct PresetRequirements {
  std::vector<double> upper_storeys;          ///< [least, most] above the ground floor; or empty
  std::optional<double> upper_windows_from;   ///< above the ground floor's level: a high ground floor below them
  std::optional<double> door_height;          ///< at least
  std::optional<double> window_ratio;         ///< height over width of upper windows, at least
  std::optional<double> ground_window_ratio;  ///< the same in the ground floor
  std::optional<double> gable_window_ratio;   ///< the same above the eaves
  bool windows_in_line = false;          ///< equal, as far from each other, in line; farther from the front's edges
  bool gable_windows_smaller = false;    ///< than those of the upper storeys
  std::optional<bool> ornamental_gable;  ///< whether one stands before the roof
  std::optional<double> gable_overtop;   ///< over the ridge behind it, at least
  std::vector<model::RoofShape> roof_shapes;    ///< one of them
  std::optional<double> roof_element_width;     ///< of dormers and cross gables, at most
  std::optional<double> roof_element_distance;  ///< from each other, at least
  std::optional<double> roof_eaves_distance;    ///< of dormers, along the slope, at least
  std::optional<double> roof_side_distance;     ///< from the ends of the wall below, at least
};

struct Preset {
  std::string name;
  std::string description;  ///< one line
  model::StyleClass style = model::StyleClass::other;
  std::vector<std::string> substyles;  ///< ids of the catalogue of styles that it is meant for
  std::string grammar{};  ///< rule file below configs/grammars, or beside the rule set; empty: walls stay closed
  std::optional<bool>
      on_footprint{};  ///< `initial_shape`: its rules begin on the footprint, or on walls; none: as they say
  /// The same for what stands on its roof; none: the usual one (roofscape.cga); empty: nothing stands there.
  std::optional<std::string> roof_grammar{};
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< values of the rule files' attributes, by name
  std::optional<PresetMeasures> measures{};
  std::optional<PresetRequirements> requirements{};
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
