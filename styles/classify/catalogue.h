// The catalogue of styles (configs/styles/catalogue.toml): what buildings of each sub-style look like.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/style.h"

namespace blockrand::classify {

/// Where on its lot a building of a style stands.
enum class StylePosition : std::uint8_t {
  front,  ///< on the street
  wing,   ///< Seitenfluegel, along the border of the lot
  rear,   ///< behind a front house
  any,
};
inline constexpr std::array<std::string_view, 4> kStylePositionNames = {"front", "wing", "rear", "any"};
constexpr std::string_view name(StylePosition p) { return kStylePositionNames[static_cast<std::size_t>(p)]; }

/// Families of roof shapes that tags and images tell apart.
enum class RoofFamily : std::uint8_t { flat, gabled, hipped, mansard, other };
inline constexpr int kRoofFamilyCount = 5;
inline constexpr std::array<std::string_view, kRoofFamilyCount> kRoofFamilyNames = {"flat", "gabled", "hipped",
                                                                                    "mansard", "other"};
constexpr std::string_view name(RoofFamily f) { return kRoofFamilyNames[static_cast<std::size_t>(f)]; }

/// What is usual, and between what it lies.
struct Spread {
  double min = 0, typ = 0, max = 0;
};

/// One style. Lengths in metres, angles in degrees; meanings stand at the head of the file.
struct Style {
  std::string id;
  model::StyleClass style_class = model::StyleClass::other;
  model::YearRange years;                       ///< 500 and 2100 are open ends
  std::vector<model::Morphology> morphologies;  ///< empty: anywhere
  StylePosition position = StylePosition::any;
  double share = 1;  ///< of the houses that fit it, beside the styles that fit as well; less than 1 for rare ones
  Spread storeys;
  double storey_height = 3;        ///< floor to floor, mean of all storeys of a typical house
  double ground_floor_height = 3;  ///< floor to floor
  double plinth = 0;
  double attic_wall = 0;                        ///< above the topmost ceiling: Drempel, knee wall, parapet
  std::optional<Spread> eaves;                  ///< above ground
  std::array<double, kRoofFamilyCount> roof{};  ///< shares by RoofFamily, sum 1
  double double_saltbox = 0;                    ///< that part of roof[other] which is a Berliner Dach
  std::optional<Spread> roof_pitch;             ///< main slope of the roofs that are not flat; empty where all are
  bool gable_to_street = false;  ///< on a lot as narrow as its house: the ridge runs square to the street
  std::vector<model::Colour> wall_colours, roof_colours;  ///< at least one each
  std::string wall_material, roof_material;               ///< classes of configs/materials/materials.toml
  std::string note;

  bool occurs_in(model::Morphology morphology) const;
};

/// All styles by id, ascending: an index into it means the same style wherever the same file is read.
class Catalogue {
 public:
  explicit Catalogue(std::vector<Style> styles);

  std::size_t size() const { return styles_.size(); }
  const Style& operator[](std::size_t index) const { return styles_[index]; }
  const std::vector<Style>& styles() const { return styles_; }
  /// Index of `id`; empty for none. At most 255 styles: the index fits model::BuildingStyle::substyle.
  std::optional<std::uint8_t> index(std::string_view id) const;
  const Style* find(std::string_view id) const;  ///< nullptr for none
  /// Indices of a class's styles, ascending.
  const std::vector<std::uint8_t>& of_class(model::StyleClass c) const {
    return by_class_[static_cast<std::size_t>(c)];
  }

 private:
  std::vector<Style> styles_;
  std::array<std::vector<std::uint8_t>, model::kStyleClassCount> by_class_;
};

/// Reads `<configs>/styles/catalogue.toml` (and the names of material classes in `<configs>/materials/materials.toml`).
/// \throws base::InputError with file, line and column for anything unknown, missing, out of range, or that does not
/// fit
///   together (shares that do not sum to 1, eaves that are not the sum of the storeys)
Catalogue read_catalogue(const std::string& configs);

}  // namespace blockrand::classify
