#include "pipeline/export/gltf/glb_writer.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ostream>
#include <stdexcept>
#include <streambuf>

#include "pipeline/export/gltf/building_table.h"
#include "pipeline/export/gltf/mesh.h"
#include "pipeline/export/gltf/property_table.h"
#include "pipeline/export/text.h"

namespace blockrand::export_ {
namespace {

using Value = tinygltf::Value;
using Object = Value::Object;

Value text_value(std::string_view text) {
  std::string clean;
  append_clean(clean, text);
  return Value(std::move(clean));
}

/// East, north, up to glTF's axes: x east, y up, z south. The only place that knows.
template <class T>
std::array<T, 3> y_up(T east, T north, T up) {
  return {east, up, static_cast<T>(0 - north)};
}

/// Quantised positions count in steps of 1/4096 m from `origin`; a uniform scale leaves normals as they are. The
/// model's own grid of 1/1024 m costs up to 0.69 mm; with 0.17 mm more a corner still lies within 1 mm of its place.
struct PositionCoding {
  bool quantised = false;
  std::array<double, 3> origin{};  ///< y up
  static constexpr double kStepsPerMetre = 4096;
};

PositionCoding choose_coding(const Mesh& mesh) {
  const std::array<double, 3> a = y_up(mesh.min.x, mesh.max.y, mesh.min.z);  // north is turned, so its maximum is first
  const std::array<double, 3> b = y_up(mesh.max.x, mesh.min.y, mesh.max.z);
  PositionCoding coding;
  coding.quantised = true;
  for (int i = 0; i < 3; ++i) {
    coding.origin[i] = std::floor(a[i] * PositionCoding::kStepsPerMetre) / PositionCoding::kStepsPerMetre;
    if (!((b[i] - coding.origin[i]) * PositionCoding::kStepsPerMetre <= 65535)) coding.quantised = false;
  }
  return coding;
}

/// Appends interleaved vertices and the accessors of the primitives to a model.
class MeshWriter {
 public:
  MeshWriter(tinygltf::Model& model, const Mesh& mesh, std::size_t features)
      : model_(model), mesh_(mesh), coding_(choose_coding(mesh)), wide_features_(features > 0xFFFF) {
    normal_at_ = coding_.quantised ? 8 : 12;
    colour_at_ = normal_at_ + 4;
    feature_at_ = colour_at_ + 8;
    stride_ = feature_at_ + 4;
  }

  void write(const model::Region& region) {
    std::vector<unsigned char> vertices;
    std::vector<std::uint16_t> narrow;
    std::vector<std::uint32_t> wide;
    std::size_t count = 0;
    for (const MeshPrimitive& p : mesh_.primitives) count += p.vertices.size();
    vertices.reserve(count * stride_);
    // View numbers are known before the bytes are: vertices first, then the index types that occur.
    bool any_narrow = false;
    for (const MeshPrimitive& p : mesh_.primitives) any_narrow = any_narrow || is_narrow(p);
    const int vertex_view = 0, narrow_view = 1, wide_view = any_narrow ? 2 : 1;

    tinygltf::Mesh mesh;
    for (const MeshPrimitive& p : mesh_.primitives) {
      tinygltf::Primitive primitive;
      primitive.mode = TINYGLTF_MODE_TRIANGLES;
      primitive.material = add_material(region.materials.at(p.material));
      const std::size_t base = vertices.size();
      tinygltf::Accessor position = add_vertices(vertices, p);
      position.bufferView = vertex_view;
      position.byteOffset = base;
      primitive.attributes["POSITION"] = add_accessor(std::move(position));
      primitive.attributes["NORMAL"] =
          add_accessor(attribute(p, vertex_view, base + normal_at_, TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_TYPE_VEC3));
      primitive.attributes["COLOR_0"] = add_accessor(
          attribute(p, vertex_view, base + colour_at_, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4));
      tinygltf::Accessor feature =
          attribute(p, vertex_view, base + feature_at_,
                    wide_features_ ? TINYGLTF_COMPONENT_TYPE_FLOAT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                    TINYGLTF_TYPE_SCALAR);
      feature.normalized = false;
      primitive.attributes["_FEATURE_ID_0"] = add_accessor(std::move(feature));

      tinygltf::Accessor indices;
      indices.type = TINYGLTF_TYPE_SCALAR;
      indices.count = p.indices.size();
      if (is_narrow(p)) {
        indices.bufferView = narrow_view;
        indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
        indices.byteOffset = narrow.size() * sizeof(narrow[0]);
        narrow.insert(narrow.end(), p.indices.begin(), p.indices.end());
      } else {
        indices.bufferView = wide_view;
        indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        indices.byteOffset = wide.size() * sizeof(wide[0]);
        wide.insert(wide.end(), p.indices.begin(), p.indices.end());
      }
      primitive.indices = add_accessor(std::move(indices));
      primitive.extensions["EXT_mesh_features"] = feature_ids(p);
      mesh.primitives.push_back(std::move(primitive));
    }
    model_.meshes.push_back(std::move(mesh));
    add_buffer_view(model_, vertices.data(), vertices.size(), TINYGLTF_TARGET_ARRAY_BUFFER, static_cast<int>(stride_));
    if (!narrow.empty())
      add_buffer_view(model_, narrow.data(), narrow.size() * sizeof(narrow[0]), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    if (!wide.empty())
      add_buffer_view(model_, wide.data(), wide.size() * sizeof(wide[0]), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);

    tinygltf::Node node;
    node.mesh = 0;
    if (coding_.quantised) {
      constexpr double kScale = 65535 / PositionCoding::kStepsPerMetre;
      node.translation.assign(coding_.origin.begin(), coding_.origin.end());
      node.scale.assign(3, kScale);
    }
    model_.nodes.push_back(std::move(node));
    // A scene without nodes is not allowed, so that a file without a mesh has none at all.
    tinygltf::Scene scene;
    scene.nodes.push_back(0);
    model_.scenes.push_back(std::move(scene));
    model_.defaultScene = 0;
  }

 private:
  // 65535 as an index would restart the primitive.
  static bool is_narrow(const MeshPrimitive& p) { return p.vertices.size() <= 65535; }

  int add_accessor(tinygltf::Accessor accessor) {
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  static tinygltf::Accessor attribute(const MeshPrimitive& p, int view, std::size_t offset, int component, int type) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.byteOffset = offset;
    accessor.componentType = component;
    accessor.normalized = true;
    accessor.count = p.vertices.size();
    accessor.type = type;
    return accessor;
  }

  int add_material(const model::MaterialClass& material) {
    tinygltf::Material out;
    append_clean(out.name, material.name);
    out.pbrMetallicRoughness.roughnessFactor = two_decimals(material.roughness);
    out.pbrMetallicRoughness.metallicFactor = two_decimals(material.metallic);
    model_.materials.push_back(std::move(out));
    return static_cast<int>(model_.materials.size()) - 1;
  }
  /// 0.9f is 0.89999997615814209 as a double.
  static double two_decimals(float value) {
    return std::nearbyint(std::clamp(static_cast<double>(value), 0.0, 1.0) * 100) / 100;
  }

  static Value feature_ids(const MeshPrimitive& p) {
    // featureCount is the number of different rows that this primitive uses.
    std::vector<std::uint32_t> rows;
    for (const MeshVertex& v : p.vertices)
      if (rows.empty() || rows.back() != v.feature) rows.push_back(v.feature);
    std::sort(rows.begin(), rows.end());
    const auto count = std::unique(rows.begin(), rows.end()) - rows.begin();
    Object id;
    id.emplace("attribute", Value(0));
    id.emplace("featureCount", Value(static_cast<int>(count)));
    id.emplace("label", Value(std::string(kBuildingClass)));
    id.emplace("propertyTable", Value(0));
    Object extension;
    extension.emplace("featureIds", Value(Value::Array{Value(std::move(id))}));
    return Value(std::move(extension));
  }

  /// \return the accessor of POSITION without its place
  tinygltf::Accessor add_vertices(std::vector<unsigned char>& out, const MeshPrimitive& p) const {
    std::array<double, 3> low{}, high{};
    std::size_t at = out.size();
    out.resize(at + p.vertices.size() * stride_);
    bool first = true;
    for (const MeshVertex& v : p.vertices) {
      const model::Point3& enu = mesh_.positions[v.position];
      const std::array<double, 3> xyz = y_up(enu.x, enu.y, enu.z);
      std::array<double, 3> stored{};
      if (coding_.quantised) {
        std::array<std::uint16_t, 3> q{};
        for (int i = 0; i < 3; ++i) {
          q[i] = static_cast<std::uint16_t>(
              std::clamp(std::nearbyint((xyz[i] - coding_.origin[i]) * PositionCoding::kStepsPerMetre), 0.0, 65535.0));
          stored[i] = q[i];
        }
        std::memcpy(&out[at], q.data(), sizeof(q));
      } else {
        std::array<float, 3> f{};
        for (int i = 0; i < 3; ++i) {
          f[i] = static_cast<float>(xyz[i]) + 0.0f;  // no -0
          stored[i] = f[i];
        }
        std::memcpy(&out[at], f.data(), sizeof(f));
      }
      const std::array<std::int8_t, 3> normal = y_up(v.normal[0], v.normal[1], v.normal[2]);
      std::memcpy(&out[at + normal_at_], normal.data(), sizeof(normal));
      const std::array<std::uint16_t, 4> colour{v.colour[0], v.colour[1], v.colour[2], 65535};
      std::memcpy(&out[at + colour_at_], colour.data(), sizeof(colour));
      if (wide_features_) {
        const auto id = static_cast<float>(v.feature);
        std::memcpy(&out[at + feature_at_], &id, sizeof(id));
      } else {
        const auto id = static_cast<std::uint16_t>(v.feature);
        std::memcpy(&out[at + feature_at_], &id, sizeof(id));
      }
      at += stride_;
      for (int i = 0; i < 3; ++i) {
        low[i] = first ? stored[i] : std::min(low[i], stored[i]);
        high[i] = first ? stored[i] : std::max(high[i], stored[i]);
      }
      first = false;
    }
    tinygltf::Accessor accessor;
    accessor.type = TINYGLTF_TYPE_VEC3;
    accessor.componentType = coding_.quantised ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.normalized = coding_.quantised;
    accessor.count = p.vertices.size();
    accessor.minValues.assign(low.begin(), low.end());
    accessor.maxValues.assign(high.begin(), high.end());
    return accessor;
  }

  tinygltf::Model& model_;
  const Mesh& mesh_;
  PositionCoding coding_;
  bool wide_features_;
  std::size_t normal_at_ = 0, colour_at_ = 0, feature_at_ = 0, stride_ = 0;
};

Value georeference(const GlbOptions& options) {
  Object origin;
  origin.emplace("longitude", Value(options.frame.longitude));
  origin.emplace("latitude", Value(options.frame.latitude));
  origin.emplace("height", Value(options.frame.height));
  Value::Array matrix;
  for (const double v : options.frame.enu_to_ecef) matrix.emplace_back(v);
  Object georeference;
  georeference.emplace("crs", text_value(options.crs));
  georeference.emplace("height_reference", text_value(options.height_reference));
  georeference.emplace("origin", Value(std::move(origin)));
  georeference.emplace("local_to_ecef", Value(std::move(matrix)));
  Object extras;
  extras.emplace("georeference", Value(std::move(georeference)));
  return Value(std::move(extras));
}

Value metadata(tinygltf::Model& model, const PropertyTable& table) {
  Object building_part;
  building_part.emplace("name", Value(std::string("Building part")));
  building_part.emplace("properties", table.class_properties());
  Object classes;
  classes.emplace(kBuildingClass, Value(std::move(building_part)));
  Object schema;
  schema.emplace("id", Value(std::string("blockrand")));
  schema.emplace("version", Value(std::string("1.0.0")));
  schema.emplace("classes", Value(std::move(classes)));
  schema.emplace("enums", building_enums());
  Object extension;
  extension.emplace("schema", Value(std::move(schema)));
  extension.emplace("propertyTables", Value(Value::Array{table.write(model, kBuildingClass)}));
  return Value(std::move(extension));
}

/// A stream that appends to a string: std::ostringstream would copy a tile twice.
class StringSink : public std::streambuf {
 public:
  explicit StringSink(std::string& out) : out_(out) {}

 protected:
  int_type overflow(int_type c) override {
    if (c != traits_type::eof()) out_ += static_cast<char>(c);
    return c;
  }
  std::streamsize xsputn(const char* s, std::streamsize n) override {
    out_.append(s, static_cast<std::size_t>(n));
    return n;
  }

 private:
  std::string& out_;
};

}  // namespace

Glb write_glb(const model::Region& region, const GlbOptions& options) {
  const PropertyTable table = building_table(region, options.evidence);
  const bool bake = options.instancing == Instancing::baked;
  const Mesh mesh = build_mesh(region, options.lod, options.frame, bake);
  std::vector<InstanceGroup> groups;
  if (options.lod >= 3 && !bake) groups = element_instances(region, options.frame);
  if (table.rows() > (1u << 24)) throw std::length_error("too many building parts for one GLB");

  tinygltf::Model model;
  model.asset.version = "2.0";
  append_clean(model.asset.generator, options.generator);
  append_clean(model.asset.copyright, options.attribution);
  model.asset.extras = georeference(options);
  InstanceFigures instances;
  if (table.rows() > 0) {
    model.buffers.emplace_back();
    if (!mesh.empty()) {
      MeshWriter(model, mesh, table.rows()).write(region);
      model.extensionsUsed = {"EXT_mesh_features", "EXT_structural_metadata", "KHR_mesh_quantization"};
      model.extensionsRequired = {"KHR_mesh_quantization"};
    } else {
      model.extensionsUsed = {"EXT_structural_metadata"};
    }
    if (!groups.empty()) instances = write_instances(model, region, groups, options.instancing, kBuildingClass);
    if (instances.places > 0 && options.instancing == Instancing::ext) {
      model.extensionsUsed.insert(model.extensionsUsed.begin() + 1,
                                  {"EXT_mesh_gpu_instancing", "EXT_instance_features"});
      model.extensionsRequired.insert(model.extensionsRequired.begin(), "EXT_mesh_gpu_instancing");
    }
    model.extensions["EXT_structural_metadata"] = metadata(model, table);
    if (model.buffers.front().data.size() > 0xFFFF0000u) throw std::length_error("too much data for one GLB");
  }

  Glb glb;
  glb.rows = table.rows();
  glb.triangles = mesh.triangles + instances.triangles;
  glb.placements = instances.places;
  glb.elements = instances.elements;
  if (!mesh.empty()) {
    glb.min = mesh.min;
    glb.max = mesh.max;
  }
  if (instances.places > 0) {
    const bool alone = mesh.empty();
    glb.min = alone ? instances.min
                    : model::Point3{std::min(glb.min.x, instances.min.x), std::min(glb.min.y, instances.min.y),
                                    std::min(glb.min.z, instances.min.z)};
    glb.max = alone ? instances.max
                    : model::Point3{std::max(glb.max.x, instances.max.x), std::max(glb.max.y, instances.max.y),
                                    std::max(glb.max.z, instances.max.z)};
  }
  StringSink sink(glb.bytes);
  std::ostream stream(&sink);
  tinygltf::TinyGLTF writer;
  writer.WriteGltfSceneToStream(&model, stream, /*prettyPrint=*/false, /*writeBinary=*/true);
  return glb;
}

}  // namespace blockrand::export_
