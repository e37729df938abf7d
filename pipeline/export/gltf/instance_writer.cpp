#include "pipeline/export/gltf/instance_writer.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "pipeline/export/gltf/linear_light.h"
#include "pipeline/export/gltf/property_table.h"
#include "pipeline/export/text.h"

namespace blockrand::export_ {
namespace {

using Value = tinygltf::Value;
using Object = Value::Object;

constexpr double kStepsPerMetre = 4096;
constexpr double kMostSteps = 32767;

/// Bytes that become one buffer view.
class Bytes {
 public:
  template <class T>
  std::size_t append(const T* values, std::size_t count) {
    while (bytes_.size() % 4 != 0) bytes_.push_back(0);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + count * sizeof(T));
    std::memcpy(bytes_.data() + at, values, count * sizeof(T));
    return at;
  }
  const std::vector<unsigned char>& bytes() const { return bytes_; }

 private:
  std::vector<unsigned char> bytes_;
};

/// The accessors of one part's triangles.
struct PartAccessors {
  model::ElementPart part = model::ElementPart::frame;
  int position = 0, normal = 0, indices = 0;
};
struct StoredGeometry {
  std::vector<PartAccessors> parts;
  bool quantised = false;
  std::size_t triangles = 0;
  double reach = 0;
};

double two_decimals(float value) {
  return std::nearbyint(std::clamp(static_cast<double>(value), 0.0, 1.0) * 100) / 100;
}

class InstanceWriter {
 public:
  InstanceWriter(tinygltf::Model& model, const model::Region& region, const char* label)
      : model_(model), region_(region), label_(label) {
    // Numbers of the views are known before their bytes are.
    const int next = static_cast<int>(model.bufferViews.size());
    vertex_view_ = next;
    index_view_ = next + 1;
    place_view_ = next + 2;
  }

  InstanceFigures write(const std::vector<InstanceGroup>& groups, Instancing how) {
    InstanceFigures figures;
    if (model_.scenes.empty()) {
      model_.scenes.emplace_back();
      model_.defaultScene = 0;
    }
    for (const InstanceGroup& group : groups) {
      const model::ColouredElement& element = region_.elements.at(group.element);
      const StoredGeometry& geometry = stored(element);
      if (geometry.parts.empty()) continue;
      const int mesh = add_mesh(element, geometry);
      ++figures.elements;
      figures.places += group.instances.size();
      figures.triangles += geometry.triangles * group.instances.size();
      for (const ElementInstance& at : group.instances) widen(figures, at.origin, geometry.reach);
      if (how == Instancing::ext)
        add_instanced_node(mesh, group, geometry);
      else
        for (const ElementInstance& at : group.instances) add_node(mesh, at, geometry);
    }
    if (figures.elements == 0) return figures;
    add_buffer_view(model_, vertices_.bytes().data(), vertices_.bytes().size(), TINYGLTF_TARGET_ARRAY_BUFFER,
                    static_cast<int>(kStride));
    add_buffer_view(model_, indices_.bytes().data(), indices_.bytes().size(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    if (!places_.bytes().empty()) add_buffer_view(model_, places_.bytes().data(), places_.bytes().size());
    return figures;
  }

 private:
  static constexpr std::size_t kStride = 16;  ///< position in 12 bytes (8 used when quantised), normal in 4

  void widen(InstanceFigures& figures, const model::Point3& p, double reach) {
    if (first_) figures.min = figures.max = p;
    first_ = false;
    figures.min = {std::min(figures.min.x, p.x - reach), std::min(figures.min.y, p.y - reach),
                   std::min(figures.min.z, p.z - reach)};
    figures.max = {std::max(figures.max.x, p.x + reach), std::max(figures.max.y, p.y + reach),
                   std::max(figures.max.z, p.z + reach)};
  }

  int add_accessor(int view, std::size_t offset, int component, int type, std::size_t count, bool normalised = false) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.byteOffset = offset;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    accessor.normalized = normalised;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  /// The element's triangles, written when they are first asked for.
  const StoredGeometry& stored(const model::ColouredElement& element) {
    const auto [place, added] = geometry_.try_emplace(element.element.get());
    if (!added) return place->second;
    StoredGeometry& out = place->second;
    const ElementGeometry geometry = element_geometry(*element.element, true);
    out.quantised = geometry.reach * kStepsPerMetre <= kMostSteps;
    out.reach = geometry.reach;
    for (const ElementGeometry::PartTriangles& part : geometry.parts) {
      PartAccessors a;
      a.part = part.part;
      std::vector<unsigned char> bytes(part.vertices.size() * kStride);
      std::array<double, 3> low{}, high{};
      for (std::size_t i = 0; i < part.vertices.size(); ++i) {
        const ElementVertex& v = part.vertices[i];
        const std::array<double, 3> xyz{v.position.x, v.position.y, v.position.z};
        std::array<double, 3> kept{};
        unsigned char* at = &bytes[i * kStride];
        for (std::size_t k = 0; k < 3; ++k) {
          if (out.quantised) {
            const auto q = static_cast<std::int16_t>(std::nearbyint(xyz[k] * kStepsPerMetre));
            std::memcpy(at + 2 * k, &q, sizeof(q));
            kept[k] = q;
          } else {
            const float f = static_cast<float>(xyz[k]) + 0.0f;
            std::memcpy(at + 4 * k, &f, sizeof(f));
            kept[k] = f;
          }
          low[k] = i == 0 ? kept[k] : std::min(low[k], kept[k]);
          high[k] = i == 0 ? kept[k] : std::max(high[k], kept[k]);
        }
        std::memcpy(at + 12, v.normal.data(), 3);
      }
      const std::size_t first = vertices_.append(bytes.data(), bytes.size());
      a.position = add_accessor(vertex_view_, first,
                                out.quantised ? TINYGLTF_COMPONENT_TYPE_SHORT : TINYGLTF_COMPONENT_TYPE_FLOAT,
                                TINYGLTF_TYPE_VEC3, part.vertices.size());
      model_.accessors[static_cast<std::size_t>(a.position)].minValues.assign(low.begin(), low.end());
      model_.accessors[static_cast<std::size_t>(a.position)].maxValues.assign(high.begin(), high.end());
      a.normal = add_accessor(vertex_view_, first + 12, TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_TYPE_VEC3,
                              part.vertices.size(), true);
      if (part.vertices.size() < 65535) {
        const std::vector<std::uint16_t> narrow(part.indices.begin(), part.indices.end());
        a.indices = add_accessor(index_view_, indices_.append(narrow.data(), narrow.size()),
                                 TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR, narrow.size());
      } else {
        a.indices = add_accessor(index_view_, indices_.append(part.indices.data(), part.indices.size()),
                                 TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, part.indices.size());
      }
      out.triangles += part.indices.size() / 3;
      out.parts.push_back(a);
    }
    return out;
  }

  int material(const model::PartLook& look) {
    const std::array<int, 4> key{look.material, look.colour.r, look.colour.g, look.colour.b};
    const auto [place, added] = materials_.try_emplace(key, static_cast<int>(model_.materials.size()));
    if (added) {
      const model::MaterialClass& material = region_.materials.at(look.material);
      tinygltf::Material out;
      append_clean(out.name, material.name);
      const auto linear = [](std::uint8_t v) { return std::nearbyint(kLinearLight[v] / 65.535) / 1000; };
      out.pbrMetallicRoughness.baseColorFactor = {linear(look.colour.r), linear(look.colour.g), linear(look.colour.b),
                                                  1.0};
      out.pbrMetallicRoughness.roughnessFactor = two_decimals(material.roughness);
      out.pbrMetallicRoughness.metallicFactor = two_decimals(material.metallic);
      model_.materials.push_back(std::move(out));
    }
    return place->second;
  }

  int add_mesh(const model::ColouredElement& element, const StoredGeometry& geometry) {
    tinygltf::Mesh mesh;
    append_clean(mesh.name, element.element->name);
    for (const PartAccessors& part : geometry.parts) {
      tinygltf::Primitive primitive;
      primitive.mode = TINYGLTF_MODE_TRIANGLES;
      primitive.material = material(element.looks[static_cast<std::size_t>(part.part)]);
      primitive.attributes["POSITION"] = part.position;
      primitive.attributes["NORMAL"] = part.normal;
      primitive.indices = part.indices;
      mesh.primitives.push_back(std::move(primitive));
    }
    model_.meshes.push_back(std::move(mesh));
    return static_cast<int>(model_.meshes.size()) - 1;
  }

  /// East, north, up to glTF's y up.
  static std::array<double, 3> translation(const ElementInstance& at, const StoredGeometry& geometry) {
    const double scale = geometry.quantised ? kStepsPerMetre : 1;
    return {at.origin.x * scale, at.origin.z * scale, 0.0 - at.origin.y * scale};
  }
  /// A turn about the upright axis that leads east to `along`, by half angles without trigonometry.
  static std::array<double, 4> rotation(const ElementInstance& at) {
    const double c = std::sqrt(std::max(0.0, (1 + at.along.x) / 2)), s = std::sqrt(std::max(0.0, (1 - at.along.x) / 2));
    return {0, at.along.y < 0 ? -s : s, 0, c};
  }

  void add_instanced_node(int mesh, const InstanceGroup& group, const StoredGeometry& geometry) {
    const std::size_t n = group.instances.size();
    std::vector<float> translations, features;
    std::vector<std::int16_t> rotations;
    std::set<std::uint32_t> rows;
    for (const ElementInstance& at : group.instances) {
      for (const double v : translation(at, geometry)) translations.push_back(static_cast<float>(v) + 0.0f);
      for (const double v : rotation(at)) rotations.push_back(static_cast<std::int16_t>(std::nearbyint(v * 32767)));
      features.push_back(static_cast<float>(at.feature));
      rows.insert(at.feature);
    }
    const std::size_t t = places_.append(translations.data(), translations.size());
    const std::size_t r = places_.append(rotations.data(), rotations.size());
    const std::size_t f = places_.append(features.data(), features.size());
    Object attributes;
    attributes.emplace("TRANSLATION",
                       Value(add_accessor(place_view_, t, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, n)));
    attributes.emplace("ROTATION",
                       Value(add_accessor(place_view_, r, TINYGLTF_COMPONENT_TYPE_SHORT, TINYGLTF_TYPE_VEC4, n, true)));
    attributes.emplace("_FEATURE_ID_0",
                       Value(add_accessor(place_view_, f, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, n)));
    Object instancing;
    instancing.emplace("attributes", Value(std::move(attributes)));
    Object id;
    id.emplace("attribute", Value(0));
    id.emplace("featureCount", Value(static_cast<int>(rows.size())));
    id.emplace("label", Value(std::string(label_)));
    id.emplace("propertyTable", Value(0));
    Object ids;
    ids.emplace("featureIds", Value(Value::Array{Value(std::move(id))}));
    tinygltf::Node node;
    node.mesh = mesh;
    if (geometry.quantised) node.scale.assign(3, 1 / kStepsPerMetre);
    node.extensions["EXT_mesh_gpu_instancing"] = Value(std::move(instancing));
    node.extensions["EXT_instance_features"] = Value(std::move(ids));
    push(std::move(node));
  }

  void add_node(int mesh, const ElementInstance& at, const StoredGeometry& geometry) {
    tinygltf::Node node;
    node.mesh = mesh;
    const double steps = geometry.quantised ? kStepsPerMetre : 1;
    for (const double v : translation(at, geometry)) node.translation.push_back(v / steps);
    const auto q = rotation(at);
    node.rotation.assign(q.begin(), q.end());
    if (geometry.quantised) node.scale.assign(3, 1 / kStepsPerMetre);
    Object extras;
    extras.emplace("feature", Value(static_cast<int>(at.feature)));
    node.extras = Value(std::move(extras));
    push(std::move(node));
  }

  void push(tinygltf::Node node) {
    model_.scenes.front().nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }

  tinygltf::Model& model_;
  const model::Region& region_;
  const char* label_;
  int vertex_view_ = 0, index_view_ = 0, place_view_ = 0;
  Bytes vertices_, indices_, places_;
  std::map<const model::Element*, StoredGeometry> geometry_;  // looked up only: its order reaches nothing
  std::map<std::array<int, 4>, int> materials_;
  bool first_ = true;
};

}  // namespace

InstanceFigures write_instances(tinygltf::Model& model, const model::Region& region,
                                const std::vector<InstanceGroup>& groups, Instancing how, const char* label) {
  return InstanceWriter(model, region, label).write(groups, how);
}

}  // namespace blockrand::export_
