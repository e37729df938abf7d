// What is assumed where the map is silent, and what materials look like: configs/defaults and configs/materials.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/attributes/pigments.h"
#include "pipeline/model/colour.h"
#include "pipeline/model/roof_shape.h"
#include "pipeline/model/solid.h"

namespace blockrand::attributes {

/// What is assumed of a building of one use. Lengths in metres, angles in degrees.
struct UseDefaults {
  std::string name;        ///< value of building=*, or "default"
  std::string style;       ///< id of the style in the catalogue whose measures and colours these are; empty for none
  double plinth = 0;       ///< m, from the ground to the ground floor
  std::uint8_t group = 0;  ///< index into Defaults::groups
  double storeys = 2;
  double storey_height = 3.0;
  bool hall = false;           ///< one room up to the roof: what neighbours have in storeys says nothing of it
  double eaves_per_width = 0;  ///< of halls: eaves over the plan's equivalent width; 0: storey_height alone counts
  double lowest_eaves = 0, highest_eaves = 60;  ///< m, of eaves that follow the width
  model::RoofShape roof_shape = model::RoofShape::flat;
  double roof_pitch = 38;
  model::SidePitches side_pitches;  ///< of `preset`
  bool gable_to_street = false;     ///< of the style: narrow houses have their ridge square to the street
  std::string preset;               ///< that states roof, pitch or direction; empty: none does
  std::string heights_preset;       ///< that states heights of storeys; empty: none does
  double ground_floor_height = 0, upper_storey_height = 0;  ///< m, of that preset
  std::optional<model::RoofShape> drawn_roof;               ///< by that preset
  double pitched_width = 17;                                ///< wider plans get a flat roof
  std::string wall_material, roof_material, flat_roof_material;
  std::vector<model::Colour> wall_colours, roof_colours;
};

/// A material class with the colour it has where none is mapped.
struct Material {
  model::MaterialClass material_class;
  model::Colour colour;
};

struct Defaults {
  std::vector<std::string> groups;
  std::map<std::string, UseDefaults, std::less<>> uses;
  UseDefaults fallback;             ///< for uses in no list
  UseDefaults small;                ///< for plans that are too small for a house
  double small_area = 30;           ///< m²
  std::vector<Material> materials;  ///< Face::material indexes these, in file order of names (alphabetical)
  std::map<std::string, std::uint8_t, std::less<>> material_by_value;  ///< OSM value or class name → index
  Pigments pigments;

  const UseDefaults& use(std::string_view building_value) const;
  /// Index of the class that an OSM material value or a class name means; -1 for none.
  int material(std::string_view value) const;
};

/// Reads `<configs>/defaults/uses.toml` and `<configs>/materials/materials.toml`.
/// \throws base::InputError with file, line and column for anything unknown, missing or out of range
Defaults read_defaults(const std::string& configs);

}  // namespace blockrand::attributes
