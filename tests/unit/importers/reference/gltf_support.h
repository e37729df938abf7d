// Small glTF files, made number by number.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::importers::reference::test {

/// A glTF file under construction: buffer views and accessors are added as they are needed.
struct GltfMaker {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  std::string binary;

  /// \return the number of the new buffer view
  int view(const void* bytes, std::size_t size, int stride = 0);
  /// \return the number of the new accessor
  template <class T>
  int accessor(const std::vector<T>& values, const std::string& type, int component_type, bool normalized = false) {
    static constexpr int kComponents[] = {1, 2, 3, 4};
    const int components = kComponents[type == "SCALAR" ? 0 : type[3] - '1'];
    json["accessors"].push_back({{"bufferView", view(values.data(), values.size() * sizeof(T))},
                                 {"componentType", component_type},
                                 {"type", type},
                                 {"count", values.size() / static_cast<std::size_t>(components)}});
    if (normalized) json["accessors"].back()["normalized"] = true;
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  /// A mesh with one primitive. \return its number
  int mesh(nlohmann::json attributes, int indices = -1, int mode = 4);
  /// \return the number of the new node
  int node(nlohmann::json members);
  /// A unit cube's 8 corners and 12 triangles as a mesh, y up, from (0, 0, 0) to (size, size, -size). \return its
  /// number
  int cube(float size = 1, nlohmann::json more_attributes = nlohmann::json::object());
  /// Puts the file on the ground. \param lon, lat  degrees
  void place(double lon, double lat, double height = 0, const std::string& crs = "EPSG:25833");

  /// A column of texts for a property table; adds its buffer views.
  nlohmann::json texts(const std::vector<std::string>& values);

  std::string glb() const;
  /// As text, the buffer as a data uri or in a file of that name.
  std::string gltf(const std::string& buffer_file = "") const;
};

/// A GLB of a JSON text and bytes, whatever they are.
std::string glb_of(std::string_view json, std::string_view binary);

}  // namespace blockrand::importers::reference::test
