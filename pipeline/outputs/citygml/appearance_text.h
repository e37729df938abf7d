// The appearance at the end of a CityGML file: which surfaces have which material.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/facade.h"
#include "pipeline/model/solid.h"
#include "pipeline/outputs/material_classes.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

/// Appends an app:X3DMaterial up to its targets; kMaterialEnd closes it.
void open_material(std::string& out, const X3dMaterial& material);
inline constexpr std::string_view kMaterialEnd = "</app:X3DMaterial></app:surfaceDataMember>\n";

/// Whether all faces of a body have one material and colour.
bool has_one_look(const model::Solid& solid);

/// Which surfaces have which material. A MultiSurface or CompositeSurface of one look is named instead of its polygons.
/// Kept until all buildings are written: about 40 bytes a name.
class AppearanceText {
 public:
  /// The polygons "<id>_p<face>" of a solid.
  void add(const model::Solid& solid, std::string_view id);

  /// What a LoD3 solid has beside the polygons of its LoD2 solid: walls with their reveals, windows and doors.
  void add_detail(const model::Solid& lod2, const model::Detail& detail, std::string_view id);

  /// The polygons "<id>_q<face>" of what rules for footprints made.
  void add_rules(const model::Solid& lod3, std::string_view id);

  /// A body that GeometryText::multi_surface() wrote, with ids of its polygons unless it has one look.
  void add_body(const model::Solid& solid, std::string_view id);

  /// Opens a target of a look (MaterialNumbers::key); the caller appends the id and closes it.
  std::string& target(std::uint32_t look);
  void close() { targets_[last_] += "</app:target>\n"; }

  /// Hands the appearanceMember to `write` in pieces; nothing when nothing was added.
  template <class Write>
  void write(const std::vector<model::MaterialClass>& classes, const Write& write) const {
    if (targets_.empty()) return;
    std::string out = "<app:appearanceMember><app:Appearance><app:theme>";
    out += kVisualTheme;
    out += "</app:theme>\n";
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      const std::uint32_t key = numbers_.keys()[i];
      const X3dMaterial material =
          x3d_material(classes.at(MaterialNumbers::material(key)), MaterialNumbers::colour(key));
      open_material(out, material);
      write(out);
      write(targets_[i]);
      out = kMaterialEnd;
    }
    out += "</app:Appearance></app:appearanceMember>\n";
    write(out);
  }

 private:
  MaterialNumbers numbers_;
  std::vector<std::string> targets_;  // by number of the material
  std::uint32_t last_ = 0;
};

}  // namespace blockrand::outputs
