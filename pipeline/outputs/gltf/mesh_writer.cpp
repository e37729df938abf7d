#include "pipeline/outputs/gltf/mesh_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/outputs/gltf/axes.h"
#include "pipeline/outputs/gltf/face_order.h"
#include "pipeline/outputs/gltf/linear_light.h"
#include "pipeline/outputs/gltf/meshopt.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

constexpr std::string_view kPiecesName = "elements";

/// Steps; 1 cm: vertices above each other lean by less than that, and windows are wider.
constexpr double kColumn = kTileStepsPerMetre / 100;

/// Appends vertices and the accessors of the primitives to a document.
class MeshWriter {
 public:
  /// Takes primitives out of `mesh` as it writes them.
  MeshWriter(GlbDocument& document, Mesh& mesh, std::size_t features, std::string_view label, SurfaceTextures* textures,
             const PaneMaterials* panes)
      : document_(document),
        mesh_(mesh),
        label_(label),
        textures_(textures),
        panes_(panes),
        wide_features_(features > 0xFFFF) {
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
    if (panes_)
      for (auto* list : {&mesh_.primitives, &mesh_.pieces}) take_glass_out(*list);
    if (textures_) {
      std::vector<MeshPrimitive> parts;
      for (MeshPrimitive& all : mesh_.primitives) {
        if (is_glass(all)) {
          parts.push_back(std::move(all));
          continue;
        }
        for (MeshPrimitive& part : textures_->split(all, mesh_)) add_to(parts, std::move(part));
        all = {};
      }
      mesh_.primitives = std::move(parts);
    }
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
      const bool textured = p.texture >= 0;
      attribute(json, "COLOR_0", add_colours(p));
      attribute(json, "NORMAL", add_normals(p));
      attribute(json, "POSITION", add_positions(p, round));
      if (textured) attribute(json, "TANGENT", add_tangents(p));
      if (!is_glass(p)) attribute(json, "TEXCOORD_0", textured ? add_repeats(p) : add_classes(p, table));
      attribute(json, "_FEATURE_ID_0", add_features(p));
      json += "},\"extensions\":{\"EXT_mesh_features\":" + feature_ids(p) + "},\"indices\":";
      append_number(json, std::int64_t{add_indices(p)});
      json += ",\"material\":";
      append_number(json, std::int64_t{is_glass(p) ? document_.add_material(panes_->glass_json(
                                                         p.look.material, std::nullopt, MaterialName::plain))
                                       : textured  ? textures_->material(document_, p)
                                                   : material});
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

  /// Of primitives of one material, which those of glass are.
  bool is_glass(const MeshPrimitive& p) const { return p.glass; }

  /// Makes primitives of each kind of glass, behind all that is none.
  void take_glass_out(std::vector<MeshPrimitive>& primitives) const {
    std::map<std::uint8_t, std::vector<MeshPrimitive>> glass;  // by material
    for (MeshPrimitive& all : primitives) {
      if (std::ranges::none_of(all.vertices, [&](const MeshVertex& v) { return panes_->is_glass(v.look.material); }))
        continue;
      MeshPrimitive rest;
      rest.look = all.look;
      constexpr std::uint32_t kNone = ~0u;
      std::vector<std::uint32_t> number(all.vertices.size(), kNone);
      std::map<std::uint8_t, std::size_t> into;  // the how-manieth of its list `number` counts vertices of
      for (std::size_t t = 0; t + 2 < all.indices.size(); t += 3) {
        const std::uint8_t material = all.vertices[all.indices[t]].look.material;
        MeshPrimitive* to = &rest;
        if (panes_->is_glass(material)) {
          auto& list = glass[material];
          if (list.empty() || list.back().vertices.size() + 3 > MeshPrimitive::kMostVertices) {
            list.emplace_back().look.material = material;
            list.back().glass = true;
          }
          to = &list.back();
          // A vertex of the primitive before, which is full, is written again.
          if (const auto [last, added] = into.try_emplace(material, list.size());
              !added && last->second != list.size()) {
            for (std::size_t v = 0; v < number.size(); ++v)
              if (all.vertices[v].look.material == material) number[v] = kNone;
            last->second = list.size();
          }
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint16_t v = all.indices[t + k];
          if (number[v] == kNone) {
            number[v] = static_cast<std::uint32_t>(to->vertices.size());
            to->vertices.push_back(all.vertices[v]);
          }
          to->indices.push_back(static_cast<std::uint16_t>(number[v]));
        }
      }
      all = std::move(rest);
    }
    std::erase_if(primitives, [](const MeshPrimitive& p) { return p.indices.empty(); });
    for (auto& [material, list] : glass) std::ranges::move(list, std::back_inserter(primitives));
  }

  /// Puts a primitive behind the last one of its texture that has room for it.
  static void add_to(std::vector<MeshPrimitive>& parts, MeshPrimitive&& part) {
    if (part.indices.empty()) return;
    const auto same = std::find_if(parts.rbegin(), parts.rend(), [&](const MeshPrimitive& other) {
      return !other.glass && other.texture == part.texture && other.reach == part.reach &&
             (part.texture < 0 || other.look.material == part.look.material);
    });
    if (same == parts.rend() || same->vertices.size() + part.vertices.size() > MeshPrimitive::kMostVertices) {
      parts.push_back(std::move(part));
      return;
    }
    const std::size_t first = same->vertices.size();
    same->vertices.insert(same->vertices.end(), part.vertices.begin(), part.vertices.end());
    same->repeats.insert(same->repeats.end(), part.repeats.begin(), part.repeats.end());
    same->tangents.insert(same->tangents.end(), part.tangents.begin(), part.tangents.end());
    for (const std::uint16_t i : part.indices) same->indices.push_back(static_cast<std::uint16_t>(first + i));
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
    out.look = p.look, out.texture = p.texture, out.reach = p.reach, out.glass = p.glass;
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
      if (numbers[i] >= out.vertices.size()) {
        out.vertices.resize(numbers[i] + 1);
        if (p.texture >= 0) out.repeats.resize(numbers[i] + 1), out.tangents.resize(numbers[i] + 1);
      }
      out.vertices[numbers[i]] = p.vertices[i];
      if (p.texture >= 0) out.repeats[numbers[i]] = p.repeats[i], out.tangents[numbers[i]] = p.tangents[i];
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
    // A texture is multiplied with them, and is as light as its mean.
    const std::array<double, 3> mean = p.texture >= 0 ? textures_->mean(p) : std::array<double, 3>{1, 1, 1};
    const auto tint = [&](std::uint8_t part, std::size_t k) {
      return static_cast<std::uint16_t>(std::min(65535.0, std::nearbyint(kLinearLight[part] / mean[k])));
    };
    for (const MeshVertex& v : p.vertices) {
      const model::Colour& c = v.look.colour;
      values.insert(values.end(), {tint(c.r, 0), tint(c.g, 1), tint(c.b, 2), std::uint16_t{65535}});
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

  int add_tangents(const MeshPrimitive& p) {
    std::vector<std::int8_t> values;
    values.reserve(4 * p.vertices.size());
    for (const std::array<std::int8_t, 3>& t : p.tangents) {
      const std::array<std::int8_t, 3> tangent = y_up(t[0], t[1], t[2]);
      values.insert(values.end(), {tangent[0], tangent[1], tangent[2], std::int8_t{127}});  // pictures are not mirrored
    }
    return add<std::int8_t>(Stream::normals, values, Component::int8, "VEC4", p, true);
  }

  int add_repeats(const MeshPrimitive& p) {
    std::vector<std::uint16_t> values;
    values.reserve(2 * p.vertices.size());
    for (const std::array<float, 2>& at : p.repeats)
      for (const float repeats : at) {
        const double share = static_cast<double>(repeats) / static_cast<double>(p.reach);
        values.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535)));
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

  std::string feature_ids(const MeshPrimitive& p) const {
    // featureCount is the number of different rows that this primitive uses.
    std::vector<std::uint32_t> rows;
    for (const MeshVertex& v : p.vertices)
      if (rows.empty() || rows.back() != v.feature) rows.push_back(v.feature);
    std::sort(rows.begin(), rows.end());
    const auto count = std::unique(rows.begin(), rows.end()) - rows.begin();
    std::string json = "{\"featureIds\":[{\"attribute\":0,\"featureCount\":";
    append_number(json, std::int64_t{count});
    return json + ",\"label\":\"" + std::string(label_) + "\",\"propertyTable\":0}]}";
  }

  GlbDocument& document_;
  Mesh& mesh_;
  std::string_view label_;
  SurfaceTextures* textures_;   ///< null: none
  const PaneMaterials* panes_;  ///< null: glass is as all else
  bool wide_features_, far_ = false;
};

}  // namespace

std::size_t write_mesh(GlbDocument& document, Mesh& mesh, std::size_t features, std::string_view label, int material,
                       const MaterialTable& table, SurfaceTextures* textures, const PaneMaterials* panes) {
  return MeshWriter(document, mesh, features, label, textures, panes).write(material, table);
}

}  // namespace blockrand::outputs
