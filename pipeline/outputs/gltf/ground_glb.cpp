#include "pipeline/outputs/gltf/ground_glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "pipeline/outputs/gltf/axes.h"
#include "pipeline/outputs/gltf/document_head.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/material.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using model::Point3;

constexpr float kRough = 0.95f;

/// Corners of cells, and the triangles between those that are wanted.
struct Cells {
  std::vector<Point3> points;                 ///< in the frame
  std::vector<std::array<double, 2>> shares;  ///< of the picture, right and down
  std::vector<std::uint16_t> pictured, bare;  ///< indices of triangles
};

Cells cells_of(const GroundPart& part, const Frame& frame) {
  const model::GroundMesh& mesh = *part.mesh;
  const GroundCover& cover = *part.cover;
  const int nodes = mesh.cells + 1;
  if (mesh.squares.size() * static_cast<std::size_t>(nodes * nodes) > 65535)
    throw std::length_error("the ground of a tile has too many squares");
  Cells out;
  std::vector<Point3> source;
  std::size_t cell = 0;
  for (const model::GroundSquare& s : mesh.squares) {
    const auto first = static_cast<int>(source.size());
    for (int row = 0; row < nodes; ++row)
      for (int column = 0; column < nodes; ++column) {
        source.push_back(mesh.at(s, column, row));
        const Point3& p = source.back();
        out.shares.push_back(
            {(p.x - cover.west) / (cover.width * cover.pixel), (cover.north - p.y) / (cover.height * cover.pixel)});
      }
    for (int row = 0; row < mesh.cells; ++row)
      for (int column = 0; column < mesh.cells; ++column) {
        // Divided as the terrain under houses is: from south-west to north-east.
        const int a = first + row * nodes + column;
        auto& to = cover.shown[cell++] ? out.pictured : out.bare;
        for (const int i : {a, a + 1, a + nodes + 1, a, a + nodes + 1, a + nodes})
          to.push_back(static_cast<std::uint16_t>(i));
      }
  }
  out.points = source;
  if (frame.to_enu) frame.to_enu(source, out.points);
  return out;
}

/// Writes primitives of the same vertices.
class GroundWriter {
 public:
  explicit GroundWriter(GlbDocument& document) : document_(document) {}

  void write(const GroundPart& part, const Frame& frame, Glb& glb) {
    const Cells cells = cells_of(part, frame);
    std::string primitives;
    add(cells, cells.pictured, true, part, primitives, glb);
    add(cells, cells.bare, false, part, primitives, glb);
    if (primitives.empty()) return;
    const int mesh = document_.add_mesh("{\"name\":\"ground\",\"primitives\":[" + primitives + "]}");
    std::string json = "{\"mesh\":";
    append_number(json, std::int64_t{mesh});
    document_.add_root(document_.add_node(json + ",\"name\":\"ground\"}"));
  }

 private:
  void add(const Cells& cells, const std::vector<std::uint16_t>& wanted, bool pictured, const GroundPart& part,
           std::string& primitives, Glb& glb) {
    if (wanted.empty()) return;
    std::vector<std::int32_t> number(cells.points.size(), -1);
    std::vector<std::uint16_t> indices, places;
    std::vector<float> positions;
    std::vector<std::int8_t> normals;
    std::array<std::array<double, 3>, 2> bounds{};
    for (const std::uint16_t i : wanted) {
      if (number[i] < 0) {
        number[i] = static_cast<std::int32_t>(positions.size() / 3);
        const Point3& p = cells.points[i];
        const std::array<double, 3> xyz = y_up(p.x, p.y, p.z);
        for (std::size_t k = 0; k < 3; ++k) {
          const double stored = std::nearbyint(xyz[k] * kTileStepsPerMetre) / kTileStepsPerMetre;
          bounds[0][k] = positions.size() < 3 ? stored : std::min(bounds[0][k], stored);
          bounds[1][k] = positions.size() < 3 ? stored : std::max(bounds[1][k], stored);
          positions.push_back(static_cast<float>(stored) + 0.0f);  // no -0
        }
        normals.insert(normals.end(), {0, 127, 0, 0});
        for (const double share : cells.shares[i])
          places.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535)));
        widen(p, glb);
      }
      indices.push_back(static_cast<std::uint16_t>(number[i]));
    }
    const std::size_t count = positions.size() / 3;
    std::string json = primitives.empty() ? "" : ",";
    json += "{\"attributes\":{\"NORMAL\":";
    append_number(json,
                  std::int64_t{accessor<std::int8_t>(Stream::normals, normals, Component::int8, "VEC3", count, true)});
    json += ",\"POSITION\":";
    append_number(json, std::int64_t{accessor<float>(Stream::far_positions, positions, Component::float32, "VEC3",
                                                     count, false, bounds)});
    if (pictured) {
      json += ",\"TEXCOORD_0\":";
      append_number(json, std::int64_t{accessor<std::uint16_t>(Stream::texture_places, places, Component::uint16,
                                                               "VEC2", count, true)});
    }
    json += "},\"indices\":";
    append_number(json, std::int64_t{accessor<std::uint16_t>(Stream::indices, indices, Component::uint16, "SCALAR",
                                                             indices.size(), false)});
    json += ",\"material\":";
    append_number(json, std::int64_t{material(pictured, part)});
    primitives += json + '}';
    glb.triangles += indices.size() / 3;
  }

  int material(bool pictured, const GroundPart& part) {
    if (!pictured) return document_.add_material(material_json({"bare ground", kRough, 0}, kBareGround));
    std::string json = "{\"name\":\"aerial image\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":";
    append_number(json, std::int64_t{document_.add_covering_texture(part.webp, part.png)});
    json += "},\"metallicFactor\":0,\"roughnessFactor\":";
    append_number(json, std::nearbyint(static_cast<double>(kRough) * 100) / 100);
    return document_.add_material(json + "}}");
  }

  template <class T>
  int accessor(Stream stream, const std::vector<T>& values, Component component, std::string_view type,
               std::size_t count, bool normalised,
               std::optional<std::array<std::array<double, 3>, 2>> bounds = std::nullopt) {
    const std::size_t at = document_.append<T>(stream, values);
    return document_.add_accessor({.stream = stream,
                                   .offset = at,
                                   .component = component,
                                   .type = type,
                                   .count = count,
                                   .normalised = normalised,
                                   .bounds = bounds});
  }

  void widen(const Point3& p, Glb& glb) {
    glb.min = first_ ? p : Point3{std::min(glb.min.x, p.x), std::min(glb.min.y, p.y), std::min(glb.min.z, p.z)};
    glb.max = first_ ? p : Point3{std::max(glb.max.x, p.x), std::max(glb.max.y, p.y), std::max(glb.max.z, p.z)};
    first_ = false;
  }

  GlbDocument& document_;
  bool first_ = true;
};

}  // namespace

Glb write_ground_glb(std::span<const GroundPart> parts, const GlbOptions& options) {
  GlbDocument document;
  write_head(document, options);
  Glb glb;
  GroundWriter writer(document);
  for (const GroundPart& part : parts) writer.write(part, options.frame, glb);
  if (glb.triangles > 0) document.use("KHR_mesh_quantization", true);
  glb.bytes = document.write(options.compression);
  return glb;
}

}  // namespace blockrand::outputs
