// The appearance at the end of a CityGML file: which polygons have which material.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/solid.h"
#include "pipeline/outputs/citygml/codes.h"
#include "pipeline/outputs/citygml/geometry_text.h"
#include "pipeline/outputs/material_classes.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {

/// Which polygons have which material. Kept until all buildings are written: about 40 bytes a face.
class AppearanceText {
 public:
  void add(const model::Solid& solid, std::string_view id);

  /// The polygons of a LoD3 solid that its LoD2 solid does not have.
  void add_detail(const model::Solid& lod2, const model::Solid& lod3, std::string_view id);
  void add(const model::ColouredElement& element, std::string_view id);

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
      out += "<app:surfaceDataMember><app:X3DMaterial><gml:name>";
      append_xml(out, material.name);
      out += "</gml:name><app:diffuseColor>";
      append_ten_thousandths(out, material.diffuse, ' ');
      out += "</app:diffuseColor><app:specularColor>";
      append_ten_thousandths(out, material.specular, ' ');
      out += "</app:specularColor><app:shininess>";
      append_ten_thousandths(out, material.shininess);
      out += "</app:shininess>\n";
      write(out);
      write(targets_[i]);
      out = "</app:X3DMaterial></app:surfaceDataMember>\n";
    }
    out += "</app:Appearance></app:appearanceMember>\n";
    write(out);
  }

 private:
  /// Opens a target of this look; the caller appends the id and closes it.
  std::string& target(std::uint8_t material, model::Colour colour);
  void close() { targets_[last_] += "</app:target>\n"; }

  MaterialNumbers numbers_;
  std::vector<std::string> targets_;  // by number of the material
  std::uint32_t last_ = 0;
};

}  // namespace blockrand::outputs
