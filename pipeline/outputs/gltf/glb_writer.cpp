#include "pipeline/outputs/gltf/glb_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "pipeline/outputs/gltf/building_table.h"
#include "pipeline/outputs/gltf/document_head.h"
#include "pipeline/outputs/gltf/element_pieces.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/material.h"
#include "pipeline/outputs/gltf/mesh_buffers.h"
#include "pipeline/outputs/gltf/mesh_writer.h"
#include "pipeline/outputs/gltf/panes.h"
#include "pipeline/outputs/gltf/piece_writer.h"
#include "pipeline/outputs/gltf/property_table.h"
#include "pipeline/outputs/gltf/surface_textures.h"

namespace blockrand::outputs {
namespace {

/// Of placed shapes in one file, each a draw call: a bound for odd tiles. In towns what a draw is worth (element_pieces.cpp) ends it before.
constexpr std::size_t kMostShapes = 400;

nlohmann::ordered_json metadata(GlbDocument& document, const PropertyTable& table) {
  using Object = nlohmann::ordered_json;
  Object properties = table.class_properties();
  nlohmann::json enums = nlohmann::json::object(), known = building_enums();
  // A tile lists the shapes of its own roofs.
  for (auto& [name, enumeration] : known.items()) {
    const std::set<int> used = table.values_used(name);
    nlohmann::json values = nlohmann::json::array();
    for (const nlohmann::json& entry : enumeration["values"])
      if (used.contains(entry["value"].get<int>()) || entry["name"] == "none") values.push_back(entry);
    enumeration["values"] = std::move(values);
  }
  known.update(table.text_enums());
  for (const auto& [name, property] : properties.items())
    if (const auto type = property.find("enumType"); type != property.end()) {
      const std::string enumeration = type->get<std::string>();
      enums[enumeration] = known.at(enumeration);
    }
  Object building_class = {{"name", "Building part"}, {"properties", std::move(properties)}};
  Object schema = {{"classes", {{kBuildingClass, std::move(building_class)}}},
                   {"enums", std::move(enums)},
                   {"id", "blockrand"},
                   {"version", "1.0.0"}};
  return {{"propertyTables", Object::array({table.write(document, kBuildingClass)})}, {"schema", std::move(schema)}};
}

/// Widens the box of what is drawn; the first one is the box.
void add_box(Glb& glb, bool first, const model::Point3& min, const model::Point3& max) {
  glb.min =
      first ? min : model::Point3{std::min(glb.min.x, min.x), std::min(glb.min.y, min.y), std::min(glb.min.z, min.z)};
  glb.max =
      first ? max : model::Point3{std::max(glb.max.x, max.x), std::max(glb.max.y, max.y), std::max(glb.max.z, max.z)};
}

/// The textures of a GLB, where it has some.
class Texturing {
 public:
  Texturing(const model::Region& region, const GlbOptions& options) {
    if (!options.textures) return;
    outlines_ = course_outlines(region, options.frame);
    textures_.emplace(*options.textures, SurfaceTextures::Of::buildings, region.materials, outlines_,
                      options.texture_folder);
  }
  SurfaceTextures* textures() { return textures_ ? &*textures_ : nullptr; }
  void note(Glb& glb) const {
    if (textures_) glb.textures = textures_->used(), glb.too_light = textures_->too_light();
  }

 private:
  std::vector<CourseOutline> outlines_;
  std::optional<SurfaceTextures> textures_;
};

/// All houses as one mesh, and the elements as they are to be placed.
void write_batch(GlbDocument& document, const model::Region& region, const GlbOptions& options, std::size_t rows,
                 Glb& glb) {
  const bool bake = options.instancing == Instancing::baked;
  std::vector<InstanceGroup> groups;
  const std::optional<PaneMaterials> panes = options.textures ? std::optional<PaneMaterials>(region) : std::nullopt;
  const PaneMaterials* const glazed = panes ? &*panes : nullptr;
  if (options.lod >= 3 && !bake) groups = element_instances(region, options.frame, glazed != nullptr);
  PiecePlan plan;
  if (options.instancing == Instancing::ext) plan = plan_pieces(region, groups, kMostShapes, glazed);
  const MaterialTable materials(region.materials);
  int material = -1;
  const bool has_mesh = [&] {  // the mesh is gone before pieces are written: of a dense tile it takes 100 MB
    Mesh mesh = build_mesh(region, options.lod, options.frame, bake, plan.baked, glazed);
    plan.baked = {};
    if (!mesh.empty() || !plan.placed.empty())
      material = document.add_material(materials.material_json(document.add_texture(materials.png())));
    if (mesh.empty()) return false;
    add_box(glb, true, mesh.min, mesh.max);
    Texturing texturing(region, options);
    glb.triangles = write_mesh(document, mesh, rows, kBuildingClass, material, materials, texturing.textures(), glazed);
    texturing.note(glb);
    document.use("EXT_mesh_features", false);
    document.use("KHR_mesh_quantization", true);
    return true;
  }();
  InstanceFigures instances;
  if (options.instancing == Instancing::ext)
    instances = write_pieces(document, region, groups, plan, material, materials, rows, glazed);
  else if (!groups.empty())
    instances = write_instances(document, region, groups, glazed);
  if (instances.places > 0) add_box(glb, !has_mesh, instances.min, instances.max);
  glb.triangles += instances.triangles;
  glb.placements = instances.places;
  glb.elements = instances.elements;
}

}  // namespace

Glb write_glb(const model::Region& region, const GlbOptions& options) {
  PropertyTable table = building_table(region, options.profile, options.evidence);
  table.code_texts();
  if (table.rows() > (1u << 24)) throw std::length_error("too many building parts for one GLB");

  GlbDocument document;
  write_head(document, options);
  Glb glb;
  glb.rows = table.rows();
  if (table.rows() > 0) {
    if (options.objects == Objects::building) {
      Texturing texturing(region, options);
      std::optional<PaneMaterials> panes;
      if (options.textures) panes.emplace(region);
      const ObjectFigures objects = write_objects(document, region, options.lod, options.frame, options.instancing,
                                                  texturing.textures(), panes ? &*panes : nullptr);
      texturing.note(glb);
      glb.buildings = objects.buildings;
      glb.parts = objects.parts;
      glb.triangles = objects.triangles;
      glb.elements = objects.elements;
      glb.placements = objects.placements;
      glb.min = objects.min;
      glb.max = objects.max;
    } else {
      write_batch(document, region, options, table.rows(), glb);
    }
    document.use("EXT_structural_metadata", false);
    document.extensions()["EXT_structural_metadata"] = metadata(document, table);
  }
  glb.bytes = document.write(options.compression);
  return glb;
}

}  // namespace blockrand::outputs
