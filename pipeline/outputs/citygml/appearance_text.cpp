#include "pipeline/outputs/citygml/appearance_text.h"

#include <algorithm>

#include "pipeline/outputs/citygml/geometry_text.h"

namespace blockrand::outputs {
namespace {

std::uint32_t look_of(const model::Face& face) { return MaterialNumbers::key(face.material, face.colour); }

}  // namespace

void open_material(std::string& out, const X3dMaterial& material) {
  out += "<app:surfaceDataMember><app:X3DMaterial><gml:name>";
  append_xml(out, material.name);
  out += "</gml:name><app:diffuseColor>";
  append_ten_thousandths(out, material.diffuse, ' ');
  out += "</app:diffuseColor><app:specularColor>";
  append_ten_thousandths(out, material.specular, ' ');
  out += "</app:specularColor><app:shininess>";
  append_ten_thousandths(out, material.shininess);
  out += "</app:shininess>\n";
}

bool has_one_look(const model::Solid& solid) {
  return std::all_of(solid.faces.begin(), solid.faces.end(),
                     [&](const model::Face& face) { return look_of(face) == look_of(solid.faces.front()); });
}

void AppearanceText::add(const model::Solid& solid, std::string_view id) {
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    append_polygon_id(target(look_of(solid.faces[f])), id, f);
    close();
  }
}

void AppearanceText::add_detail(const model::Solid& lod2, const model::Detail& detail, std::string_view id) {
  const model::Solid& lod3 = detail.solid;
  std::vector<bool> done(lod3.faces.size(), false);
  const std::vector<std::vector<std::size_t>> reveals = reveals_by_wall(lod2, detail);
  for (std::size_t f = 0; f < lod2.faces.size(); ++f) {
    if (is_shared_face(lod2, lod3, f)) {
      done[f] = true;
      continue;
    }
    const std::uint32_t look = look_of(lod3.faces[f]);
    if (!std::all_of(reveals[f].begin(), reveals[f].end(),
                     [&](std::size_t reveal) { return look_of(lod3.faces[reveal]) == look; }))
      continue;
    append_wall_id(target(look), id, f);
    close();
    done[f] = true;
    for (const std::size_t reveal : reveals[f]) done[reveal] = true;
  }
  for (std::size_t f = 0; f < lod3.faces.size(); ++f) {
    if (done[f]) continue;
    append_detail_polygon_id(target(look_of(lod3.faces[f])), id, f);
    close();
  }
}

void AppearanceText::add_rules(const model::Solid& lod3, std::string_view id) {
  for (std::size_t f = 0; f < lod3.faces.size(); ++f) {
    append_detail_polygon_id(target(look_of(lod3.faces[f])), id, f);
    close();
  }
}

void AppearanceText::add_body(const model::Solid& solid, std::string_view id) {
  if (!has_one_look(solid)) return add(solid, id);
  if (solid.faces.empty()) return;
  append_wall_id(target(look_of(solid.faces.front())), id, 0);
  close();
}

std::string& AppearanceText::target(std::uint32_t look) {
  last_ = numbers_.number(look);
  if (last_ == targets_.size()) targets_.emplace_back();
  targets_[last_] += "<app:target>#";
  return targets_[last_];
}

}  // namespace blockrand::outputs
