#include "pipeline/outputs/gltf/glb_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

#include "pipeline/outputs/gltf/building_table.h"
#include "pipeline/outputs/gltf/element_pieces.h"
#include "pipeline/outputs/gltf/face_order.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/linear_light.h"
#include "pipeline/outputs/gltf/material.h"
#include "pipeline/outputs/gltf/mesh_buffers.h"
#include "pipeline/outputs/gltf/meshopt.h"
#include "pipeline/outputs/gltf/piece_writer.h"
#include "pipeline/outputs/gltf/property_table.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

/// East, north, up to glTF's axes: x east, y up, z south. The only place that knows.
template <class T>
std::array<T, 3> y_up(T east, T north, T up) {
  return {east, up, static_cast<T>(0 - north)};
}

constexpr std::string_view kPiecesName = "elements";

/// Of placed shapes in one file, each a draw call: a bound for odd tiles. In towns what a draw is worth (element_pieces.cpp) ends it before.
constexpr std::size_t kMostShapes = 400;

/// Steps; 1 cm: vertices above each other lean by less than that, and windows are wider.
constexpr double kColumn = kTileStepsPerMetre / 100;

/// Appends vertices and the accessors of the primitives to a document.
class MeshWriter {
 public:
  /// Takes primitives out of `mesh` as it writes them.
  MeshWriter(GlbDocument& document, Mesh& mesh, std::size_t features)
      : document_(document), mesh_(mesh), wide_features_(features > 0xFFFF) {
    far_ = std::max({std::fabs(mesh.min.x), std::fabs(mesh.min.y), std::fabs(mesh.min.z), std::fabs(mesh.max.x),
                     std::fabs(mesh.max.y), std::fabs(mesh.max.z)}) > kFinestReach;
  }

  /// A node of the solids, and one of the pieces of elements, by whose name readers know them apart.
  /// \param material  for which `table` tells where classes are \return how many triangles it wrote
  std::size_t write(int material, const MaterialTable& table) {
    std::size_t vertices = 0;
    for (const auto* list : {&mesh_.primitives, &mesh_.pieces})
      for (const MeshPrimitive& p : *list) vertices += p.vertices.size();
    for (const Stream stream : {Stream::colours, Stream::normals, far_ ? Stream::far_positions : Stream::tile_positions,
                                Stream::texture_places, wide_features_ ? Stream::wide_features : Stream::features})
      document_.expect(stream, vertices);
    return write(mesh_.primitives, "", material, table, Order::along_faces) +
           write(mesh_.pieces, kPiecesName, material, table, Order::vertex_cache);
  }

 private:
  enum class Order : std::uint8_t { along_faces, vertex_cache };

  std::size_t write(std::vector<MeshPrimitive>& primitives, std::string_view name, int material,
                    const MaterialTable& table, Order order) {
    std::string json = "{\"primitives\":[";
    std::size_t triangles = 0;
    for (MeshPrimitive& all : primitives) {
      const MeshPrimitive p = packed(all, order);
      all = {};
      if (p.indices.empty()) continue;
      const bool round = !far_ && (order == Order::vertex_cache || !rounding_turns(p));
      triangles += p.indices.size() / 3;
      if (json.back() == '}') json += ',';
      json += "{\"attributes\":{";
      attribute(json, "COLOR_0", add_colours(p));
      attribute(json, "NORMAL", add_normals(p));
      attribute(json, "POSITION", add_positions(p, round));
      attribute(json, "TEXCOORD_0", add_classes(p, table));
      attribute(json, "_FEATURE_ID_0", add_features(p));
      json += "},\"extensions\":{\"EXT_mesh_features\":" + feature_ids(p) + "},\"indices\":";
      append_number(json, std::int64_t{add_indices(p)});
      json += ",\"material\":";
      append_number(json, std::int64_t{material});
      json += '}';
    }
    if (triangles == 0) return 0;
    const int mesh = document_.add_mesh(json + "]}");
    json = "{\"mesh\":";
    append_number(json, std::int64_t{mesh});
    if (!name.empty()) {
      json += ",\"name\":";
      append_json(json, name);
    }
    document_.add_root(document_.add_node(json + '}'));
    return triangles;
  }

  static void attribute(std::string& json, const char* name, int accessor) {
    if (json.back() != '{') json += ',';
    json += '"';
    json += name;
    json += "\":";
    append_number(json, std::int64_t{accessor});
  }

  static std::int64_t whole(double metres) {
    return static_cast<std::int64_t>(std::nearbyint(metres * kTileStepsPerMetre));
  }

  /// Whether a triangle loses its area or looks the other way once its corners are whole steps: a sliver along an
  /// outline of thousands of corners. Rounding it would fold the surface, and leaving it out would open it.
  bool rounding_turns(const MeshPrimitive& p) const {
    for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3) {
      std::array<std::array<double, 3>, 2> before{}, after{};
      const model::Point3& a = mesh_.positions[p.vertices[p.indices[t]].position];
      for (std::size_t k = 0; k < 2; ++k) {
        const model::Point3& b = mesh_.positions[p.vertices[p.indices[t + 1 + k]].position];
        before[k] = {b.x - a.x, b.y - a.y, b.z - a.z};
        after[k] = {static_cast<double>(whole(b.x) - whole(a.x)), static_cast<double>(whole(b.y) - whole(a.y)),
                    static_cast<double>(whole(b.z) - whole(a.z))};
      }
      double same_side = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        same_side += (before[0][j] * before[1][k] - before[0][k] * before[1][j]) *
                     (after[0][j] * after[1][k] - after[0][k] * after[1][j]);
      }
      if (!(same_side > 0)) return true;
    }
    return false;
  }

  /// Whether a triangle has no area once its corners are whole steps.
  static bool is_flat(std::span<const FaceCorner> corners, std::span<const std::uint16_t> indices, std::size_t t) {
    const auto &a = corners[indices[t]].steps, &b = corners[indices[t + 1]].steps, &c = corners[indices[t + 2]].steps;
    const auto cross = [&](std::size_t i, std::size_t k) {
      return (b[i] - a[i]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[i] - a[i]);
    };
    return cross(0, 1) == 0 && cross(1, 2) == 0 && cross(2, 0) == 0;
  }

  /// \return the primitive in the order in which it packs best
  MeshPrimitive packed(const MeshPrimitive& p, Order order) const {
    std::vector<FaceCorner> corners;
    corners.reserve(p.vertices.size());
    for (const MeshVertex& v : p.vertices) {
      const model::Point3& enu = mesh_.positions[v.position];
      corners.push_back({{whole(enu.x), whole(enu.y), whole(enu.z)}, v.normal});
    }
    MeshPrimitive out;
    for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3) {
      // Pieces of elements do not have to close; a solid would be open without it, and keeps floats.
      if (!far_ && order == Order::vertex_cache && is_flat(corners, p.indices, t)) continue;
      out.indices.insert(out.indices.end(), p.indices.begin() + static_cast<std::ptrdiff_t>(t),
                         p.indices.begin() + static_cast<std::ptrdiff_t>(t + 3));
    }
    const std::vector<std::uint32_t> numbers = order == Order::along_faces
                                                   ? order_along_faces(out.indices, corners, kColumn)
                                                   : packing_order(out.indices, p.vertices.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] == ~0u) continue;
      if (numbers[i] >= out.vertices.size()) out.vertices.resize(numbers[i] + 1);
      out.vertices[numbers[i]] = p.vertices[i];
    }
    return out;
  }

  /// \param round  to whole steps
  int add_positions(const MeshPrimitive& p, bool round) {
    std::vector<float> values;
    values.reserve(3 * p.vertices.size());
    std::array<std::array<double, 3>, 2> bounds{};
    for (const MeshVertex& v : p.vertices) {
      const model::Point3& enu = mesh_.positions[v.position];
      const std::array<double, 3> xyz = y_up(enu.x, enu.y, enu.z);
      for (std::size_t i = 0; i < 3; ++i) {
        const double stored = round ? std::nearbyint(xyz[i] * kTileStepsPerMetre) / kTileStepsPerMetre : xyz[i];
        const float value = static_cast<float>(stored) + 0.0f;  // no -0
        const bool first = values.size() < 3;
        bounds[0][i] = first ? value : std::min<double>(bounds[0][i], value);
        bounds[1][i] = first ? value : std::max<double>(bounds[1][i], value);
        values.push_back(value);
      }
    }
    return add<float>(round ? Stream::tile_positions : Stream::far_positions, values, Component::float32, "VEC3", p,
                      false, bounds);
  }

  int add_normals(const MeshPrimitive& p) {
    std::vector<std::int8_t> values;
    values.reserve(4 * p.vertices.size());
    for (const MeshVertex& v : p.vertices) {
      const std::array<std::int8_t, 3> normal = y_up(v.normal[0], v.normal[1], v.normal[2]);
      values.insert(values.end(), {normal[0], normal[1], normal[2], std::int8_t{0}});
    }
    return add<std::int8_t>(Stream::normals, values, Component::int8, "VEC3", p, true);
  }

  int add_colours(const MeshPrimitive& p) {
    std::vector<std::uint16_t> values;
    values.reserve(4 * p.vertices.size());
    for (const MeshVertex& v : p.vertices) {
      const model::Colour& c = v.look.colour;
      values.insert(values.end(), {kLinearLight[c.r], kLinearLight[c.g], kLinearLight[c.b], std::uint16_t{65535}});
    }
    return add<std::uint16_t>(Stream::colours, values, Component::uint16, "VEC4", p, true);
  }

  int add_classes(const MeshPrimitive& p, const MaterialTable& table) {
    std::vector<std::uint16_t> values;
    values.reserve(2 * p.vertices.size());
    for (const MeshVertex& v : p.vertices) {
      const std::array<std::uint16_t, 2> place = table.place(v.look.material);
      values.insert(values.end(), place.begin(), place.end());
    }
    return add<std::uint16_t>(Stream::texture_places, values, Component::uint16, "VEC2", p, true);
  }

  int add_features(const MeshPrimitive& p) {
    if (wide_features_) {
      std::vector<float> values;
      for (const MeshVertex& v : p.vertices) values.push_back(static_cast<float>(v.feature));
      return add<float>(Stream::wide_features, values, Component::float32, "SCALAR", p, false);
    }
    std::vector<std::uint16_t> values;
    values.reserve(2 * p.vertices.size());
    for (const MeshVertex& v : p.vertices)
      values.insert(values.end(), {static_cast<std::uint16_t>(v.feature), std::uint16_t{0}});
    return add<std::uint16_t>(Stream::features, values, Component::uint16, "SCALAR", p, false);
  }

  int add_indices(const MeshPrimitive& p) {
    const std::size_t at = document_.append<std::uint16_t>(Stream::indices, p.indices);
    return document_.add_accessor({.stream = Stream::indices,
                                   .offset = at,
                                   .component = Component::uint16,
                                   .type = "SCALAR",
                                   .count = p.indices.size()});
  }

  template <class T>
  int add(Stream stream, std::span<const T> values, Component component, std::string_view type, const MeshPrimitive& p,
          bool normalised, std::optional<std::array<std::array<double, 3>, 2>> bounds = std::nullopt) {
    const std::size_t at = document_.append(stream, values);
    return document_.add_accessor({.stream = stream,
                                   .offset = at,
                                   .component = component,
                                   .type = type,
                                   .count = p.vertices.size(),
                                   .normalised = normalised,
                                   .bounds = bounds});
  }

  static std::string feature_ids(const MeshPrimitive& p) {
    // featureCount is the number of different rows that this primitive uses.
    std::vector<std::uint32_t> rows;
    for (const MeshVertex& v : p.vertices)
      if (rows.empty() || rows.back() != v.feature) rows.push_back(v.feature);
    std::sort(rows.begin(), rows.end());
    const auto count = std::unique(rows.begin(), rows.end()) - rows.begin();
    std::string json = "{\"featureIds\":[{\"attribute\":0,\"featureCount\":";
    append_number(json, std::int64_t{count});
    return json + ",\"label\":\"" + kBuildingClass + "\",\"propertyTable\":0}]}";
  }

  GlbDocument& document_;
  Mesh& mesh_;
  bool wide_features_, far_ = false;
};

nlohmann::json georeference(const GlbOptions& options) {
  std::string crs, height_reference;
  append_clean(crs, options.crs);
  append_clean(height_reference, options.height_reference);
  return {{"georeference",
           {{"crs", crs},
            {"height_reference", height_reference},
            {"origin",
             {{"longitude", options.frame.longitude},
              {"latitude", options.frame.latitude},
              {"height", options.frame.height}}},
            {"local_to_ecef", options.frame.enu_to_ecef}}}};
}

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

/// All houses as one mesh, and the elements as they are to be placed.
void write_batch(GlbDocument& document, const model::Region& region, const GlbOptions& options, std::size_t rows,
                 Glb& glb) {
  const bool bake = options.instancing == Instancing::baked;
  std::vector<InstanceGroup> groups;
  if (options.lod >= 3 && !bake) groups = element_instances(region, options.frame);
  PiecePlan plan;
  if (options.instancing == Instancing::ext) plan = plan_pieces(region, groups, kMostShapes);
  const MaterialTable materials(region.materials);
  int material = -1;
  const bool has_mesh = [&] {  // the mesh is gone before pieces are written: of a dense tile it takes 100 MB
    Mesh mesh = build_mesh(region, options.lod, options.frame, bake, plan.baked);
    plan.baked = {};
    if (!mesh.empty() || !plan.placed.empty())
      material = document.add_material(materials.material_json(document.add_texture(materials.png())));
    if (mesh.empty()) return false;
    add_box(glb, true, mesh.min, mesh.max);
    glb.triangles = MeshWriter(document, mesh, rows).write(material, materials);
    document.use("EXT_mesh_features", false);
    document.use("KHR_mesh_quantization", true);
    return true;
  }();
  InstanceFigures instances;
  if (options.instancing == Instancing::ext)
    instances = write_pieces(document, region, groups, plan, material, materials, rows);
  else if (!groups.empty())
    instances = write_instances(document, region, groups);
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
  std::string generator, attribution;
  append_clean(generator, options.generator);
  append_clean(attribution, options.attribution);
  document.asset() = {{"version", "2.0"}};
  if (!generator.empty()) document.asset()["generator"] = generator;
  if (!attribution.empty()) document.asset()["copyright"] = attribution;
  document.asset()["extras"] = georeference(options);
  Glb glb;
  glb.rows = table.rows();
  if (table.rows() > 0) {
    if (options.objects == Objects::building) {
      const ObjectFigures objects = write_objects(document, region, options.lod, options.frame, options.instancing);
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
