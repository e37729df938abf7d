#include "pipeline/outputs/citygml/appearance_text.h"

#include "pipeline/outputs/citygml/geometry_text.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {

void AppearanceText::add(const model::Solid& solid, std::string_view id) {
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    append_polygon_id(target(solid.faces[f].material, solid.faces[f].colour), id, f);
    close();
  }
}

void AppearanceText::add_detail(const model::Solid& lod2, const model::Solid& lod3, std::string_view id) {
  for (std::size_t f = 0; f < lod3.faces.size(); ++f)
    if (!is_shared_face(lod2, lod3, f)) {
      append_detail_polygon_id(target(lod3.faces[f].material, lod3.faces[f].colour), id, f);
      close();
    }
}

void AppearanceText::add(const model::ColouredElement& element, std::string_view id) {
  const auto& faces = element.element->mesh.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const model::PartMaterial& material = element.materials[static_cast<std::size_t>(faces[f].part)];
    append_polygon_id(target(material.material, material.colour), id, f);
    close();
  }
}

std::string& AppearanceText::target(std::uint8_t material, model::Colour colour) {
  last_ = numbers_.number(MaterialNumbers::key(material, colour));
  if (last_ == targets_.size()) targets_.emplace_back();
  targets_[last_] += "<app:target>#";
  return targets_[last_];
}

}  // namespace blockrand::outputs
