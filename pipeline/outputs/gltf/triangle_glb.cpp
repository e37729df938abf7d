// Coloured triangles as binary glTF.
#include "pipeline/outputs/gltf/triangle_glb.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "pipeline/outputs/gltf/linear_light.h"

namespace blockrand::outputs {
namespace {

using Vertex = std::array<float, 6>;  // position and normal

double linear(double srgb) {
  const auto level = static_cast<std::size_t>(std::clamp(srgb, 0.0, 1.0) * 255 + 0.5);
  return kLinearLight[level] / 65535.0;
}

std::array<double, 3> in_gltf(const model::Point3& p, bool y_up) {
  return y_up ? std::array{p.x, p.y, p.z} : std::array{p.x, p.z, -p.y};
}

/// The vertices of a group; triangles without area have no normal and are left out.
std::vector<Vertex> vertices_of(const ColouredTriangles& group, bool y_up) {
  std::vector<Vertex> out;
  for (std::size_t t = 0; t + 2 < group.corners.size(); t += 3) {
    std::array<std::array<double, 3>, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = in_gltf(group.corners[t + i], y_up);
    std::array<double, 3> a, b;
    for (std::size_t i = 0; i < 3; ++i) a[i] = p[1][i] - p[0][i], b[i] = p[2][i] - p[0][i];
    std::array<double, 3> n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0)) continue;
    for (const auto& q : p)
      out.push_back({static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                     static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
                     static_cast<float>(n[2] / length)});
  }
  return out;
}

}  // namespace

std::string write_triangle_glb(std::span<const ColouredTriangles> groups, const std::string& generator, bool y_up) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = generator;
  model.scenes.emplace_back();
  model.defaultScene = 0;
  tinygltf::Mesh mesh;
  tinygltf::Buffer buffer;
  for (const ColouredTriangles& group : groups) {
    const std::vector<Vertex> vertices = vertices_of(group, y_up);
    if (vertices.empty()) continue;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.data.size();
    view.byteLength = vertices.size() * sizeof(Vertex);
    view.byteStride = sizeof(Vertex);
    view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
    buffer.data.resize(view.byteOffset + view.byteLength);
    std::memcpy(buffer.data.data() + view.byteOffset, vertices.data(), view.byteLength);
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(model.materials.size());
    for (const auto& [name, offset] : {std::pair{"POSITION", std::size_t{0}}, {"NORMAL", 3 * sizeof(float)}}) {
      tinygltf::Accessor accessor;
      accessor.bufferView = static_cast<int>(model.bufferViews.size());
      accessor.byteOffset = offset;
      accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
      accessor.type = TINYGLTF_TYPE_VEC3;
      accessor.count = vertices.size();
      if (offset == 0) {
        accessor.minValues = {vertices[0][0], vertices[0][1], vertices[0][2]};
        accessor.maxValues = accessor.minValues;
        for (const Vertex& v : vertices)
          for (std::size_t i = 0; i < 3; ++i) {
            accessor.minValues[i] = std::min(accessor.minValues[i], static_cast<double>(v[i]));
            accessor.maxValues[i] = std::max(accessor.maxValues[i], static_cast<double>(v[i]));
          }
      }
      primitive.attributes[name] = static_cast<int>(model.accessors.size());
      model.accessors.push_back(std::move(accessor));
    }
    model.bufferViews.push_back(std::move(view));
    tinygltf::Material material;
    material.name = group.name;
    material.pbrMetallicRoughness.baseColorFactor = {linear(group.colour[0]), linear(group.colour[1]),
                                                     linear(group.colour[2]), std::clamp(group.colour[3], 0.0, 1.0)};
    material.pbrMetallicRoughness.roughnessFactor = std::clamp(group.roughness, 0.0, 1.0);
    material.pbrMetallicRoughness.metallicFactor = std::clamp(group.metallic, 0.0, 1.0);
    if (group.colour[3] < 1) material.alphaMode = "BLEND";
    // What rule files make has open faces: seen from both sides.
    material.doubleSided = true;
    model.materials.push_back(std::move(material));
    mesh.primitives.push_back(std::move(primitive));
  }
  if (!mesh.primitives.empty()) {
    model.buffers.push_back(std::move(buffer));
    model.meshes.push_back(std::move(mesh));
    tinygltf::Node node;
    node.mesh = 0;
    model.nodes.push_back(std::move(node));
    model.scenes[0].nodes.push_back(0);
  }
  std::ostringstream out;
  tinygltf::TinyGLTF writer;
  writer.WriteGltfSceneToStream(&model, out, /*prettyPrint=*/false, /*writeBinary=*/true);
  return std::move(out).str();
}

}  // namespace blockrand::outputs
