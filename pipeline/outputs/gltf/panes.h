// What is seen in the panes of windows and doors where GLBs have textures: dark rooms, the sky, curtains, blinds.
//
// The data know one colour of glass (model/usual_glass.h). Shares and colours here are own choices, made by looking at street
// photographs: by day most panes are darker than their wall, those of upper storeys lighter by the sky, and a flat has one
// kind of curtain.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/gltf/material.h"

namespace blockrand::outputs {

/// Of all panes of one window: its sashes share it.
enum class Panes : std::uint8_t {
  as_modelled,  ///< in the colour of the data
  clear,        ///< a dark room behind
  sky,          ///< brighter: what it mirrors
  curtains,     ///< fabric at both sides of the window
  net,          ///< thin fabric over the whole window
  blind,        ///< its upper part
  frosted,      ///< rough glass of doors and cellars
  shop,         ///< a shop's rooms, deeper and warmer
};
inline constexpr int kPanesCount = 8;

/// "clear"; `curtain` for both kinds of fabric; "other" for glass that is as modelled.
std::string_view glass_kind(Panes panes);

/// What the panes of a placement show, by the part's id and the place of the window in its facade: direction, storey and metres from
/// the part's first corner. Flats (kFlatWidth) have one kind of curtain, rows of windows one kind of bare panes.
/// \return as_modelled where the element has no glass, or glass in a colour that a rule or a tag says
Panes panes_of(const model::BuildingPart& part, const model::Placement& placement,
               const model::ColouredElement& element);

/// The region's classes of materials and, behind them, those of panes: what vertices of a GLB with glass have.
class PaneMaterials {
 public:
  explicit PaneMaterials(const model::Region& region);

  /// Whether it is glass: a class of the region called so, or a kind of panes.
  bool is_glass(std::uint8_t material) const { return material == glass_ || material >= first_; }
  /// How glass of these panes looks. \param modelled  as the data have it \param screen  fabric behind the glass
  model::PartMaterial look(Panes panes, bool screen, const model::PartMaterial& modelled) const;
  /// The JSON of a material of glass: named "glass", with emissiveFactor 0; extras tell `glass_kind` and, where it is
  /// not as modelled, `colour`, that of the data in linear light. \param colour, name  as material_json() has them
  std::string glass_json(std::uint8_t material, const std::optional<model::Colour>& colour, MaterialName name) const;
  /// material_json() or glass_json().
  std::string json(const model::PartMaterial& look, MaterialName name) const;

 private:
  std::span<const model::MaterialClass> classes_;
  int glass_ = -1;   ///< class of the region, -1: it has none
  int first_ = 256;  ///< of panes, by Panes
};

/// A piece of a pane.
struct PanePiece {
  std::vector<model::Point3> corners;  ///< as those of the pane run
  bool screen = false;                 ///< there is fabric behind it
};

/// Where fabric hangs in the panes of an element.
class PaneCut {
 public:
  PaneCut(Panes panes, const model::Element& element);
  /// A convex face of glass in pieces; one where nothing divides it. Wide bands of glass and bays have no curtains at their sides.
  std::vector<PanePiece> cut(std::span<const model::Point3> face) const;

 private:
  Panes panes_;
  double left_ = 0, right_ = 0, low_ = 0;  ///< m: fabric hangs left and right of, and above these
};

}  // namespace blockrand::outputs
