#include "pipeline/outputs/gltf/object_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/material.h"
#include "pipeline/outputs/gltf/mesh_buffers.h"
#include "pipeline/outputs/gltf/stored_element.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using model::Point3;

double on_grid(double metres) { return std::nearbyint(metres * kGlbStepsPerMetre) / kGlbStepsPerMetre; }
Point3 on_grid(const Point3& p) { return {on_grid(p.x), on_grid(p.y), on_grid(p.z)}; }

/// East, north, up to glTF's axes: x east, y up, z south.
std::array<double, 3> y_up(const Point3& p) { return {p.x + 0.0, p.z + 0.0, 0.0 - p.y}; }

void append_numbers(std::string& json, std::string_view name, std::span<const double> values) {
  json += ",\"";
  json += name;
  json += "\":[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i) json += ',';
    append_number(json, values[i]);
  }
  json += ']';
}

void append_children(std::string& json, const std::vector<int>& children) {
  if (children.empty()) return;
  json += "\"children\":[";
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (i) json += ',';
    append_number(json, std::int64_t{children[i]});
  }
  json += "],";
}

/// A part while the others of its building come in.
struct OpenPart {
  const model::BuildingPart* part = nullptr;
  std::uint32_t feature = 0;
  Mesh mesh;
  std::span<const PartElement> elements;  ///< that become nodes
};

class ObjectWriter {
 public:
  ObjectWriter(GlbDocument& document, const model::Region& region, SurfaceTextures* textures,
               const PaneMaterials* panes)
      : document_(document),
        region_(region),
        tags_(region.extract),
        stored_(document, ElementVertices::floats, region, panes),
        textures_(textures),
        panes_(panes) {}

  ObjectFigures write(int lod, const Frame& frame, Instancing how) {
    const bool nodes = how == Instancing::nodes && lod >= 3;
    std::vector<InstanceGroup> groups;
    if (nodes) groups = element_instances(region_, frame, panes_ != nullptr);
    const std::vector<PartElement> elements = elements_by_part(groups);
    std::vector<std::pair<const model::Building*, const model::BuildingPart*>> rows;
    for (const model::Building& building : region_.buildings)
      if (building.owned)
        for (const model::BuildingPart& part : building.parts) rows.emplace_back(&building, &part);
    std::size_t next = 0;
    for_each_part_mesh(
        region_, lod, frame, !nodes,
        [&](std::uint32_t feature, Mesh mesh) {
          const auto& [building, part] = rows.at(feature);
          if (textures_) {
            std::vector<MeshPrimitive> parts;
            for (MeshPrimitive& all : mesh.primitives) {
              if (is_glass(all)) {  // of one look
                parts.push_back(std::move(all));
                continue;
              }
              for (MeshPrimitive& faces : textures_->split(all, mesh))
                if (!faces.indices.empty()) parts.push_back(std::move(faces));
            }
            mesh.primitives = std::move(parts);
          }
          const std::size_t first = next;
          while (next < elements.size() && elements[next].at->feature == feature) ++next;
          if (!mesh.empty() || next > first)
            open_.push_back({part, feature, std::move(mesh), std::span(elements).subspan(first, next - first)});
          if (feature + 1 == rows.size() || rows[feature + 1].first != building) close(*building);
        },
        panes_);
    figures_.elements = meshes_.size();
    return figures_;
  }

 private:
  /// Writes the building whose parts are all there.
  void close(const model::Building& building) {
    if (open_.empty()) return;
    const Point3 origin = origin_of_open();
    std::vector<int> parts;
    for (const OpenPart& part : open_) parts.push_back(add_part(part, origin));
    open_.clear();
    const std::string id = building.id();
    const std::string_view name = tags_.name(building.tags);
    const Address address = tags_.address(building.tags);
    const std::string street_line = address.street_line();
    std::string json = "{";
    append_children(json, parts);
    json += "\"extras\":{";
    if (!address.empty()) {
      json += "\"address\":";
      append_json(json, address.line());
      json += ',';
    }
    json += "\"id\":";
    append_json(json, id);
    if (!name.empty()) {
      json += ",\"name_tag\":";
      append_json(json, name);
    }
    json += "},\"name\":";
    append_json(json, !street_line.empty() ? std::string_view(street_line) : !name.empty() ? name : id);
    append_numbers(json, "translation", y_up(origin));
    document_.add_root(document_.add_node(json + '}'));
    ++figures_.buildings;
  }

  /// The middle of the house, on its lowest point.
  Point3 origin_of_open() {
    Point3 low, high;
    bool first = true;
    const auto widen = [](Point3& to_low, Point3& to_high, const Point3& p, bool only) {
      to_low = only ? p : Point3{std::min(to_low.x, p.x), std::min(to_low.y, p.y), std::min(to_low.z, p.z)};
      to_high = only ? p : Point3{std::max(to_high.x, p.x), std::max(to_high.y, p.y), std::max(to_high.z, p.z)};
    };
    const auto add = [&](const Point3& p) {
      widen(low, high, p, first);
      widen(figures_.min, figures_.max, p, first_);
      first = first_ = false;
    };
    for (const OpenPart& part : open_) {
      if (!part.mesh.empty()) {
        add(part.mesh.min);
        add(part.mesh.max);
      }
      for (const PartElement& element : part.elements) add(element.at->origin);
    }
    return on_grid(Point3{(low.x + high.x) / 2, (low.y + high.y) / 2, low.z});
  }

  int add_part(const OpenPart& open, const Point3& origin) {
    std::vector<int> children;
    for (const PartElement& element : open.elements) add_element(element, origin, children);
    const int mesh = add_mesh(open, origin);
    std::string json = "{";
    append_children(json, children);
    json += "\"extras\":{\"feature\":";
    append_number(json, std::int64_t{open.feature});
    json += ",\"id\":";
    append_json(json, open.part->id);
    json += '}';
    if (mesh >= 0) {
      json += ",\"mesh\":";
      append_number(json, std::int64_t{mesh});
    }
    json += ",\"name\":";
    append_json(json, open.part->id);
    ++figures_.parts;
    return document_.add_node(json + '}');
  }

  /// \return its number; -1 where nothing is left to show
  int add_mesh(const OpenPart& open, const Point3& origin) {
    std::vector<Point3> corners;
    for (const Point3& p : open.mesh.positions) {
      const Point3 snapped = on_grid(p);
      corners.push_back({snapped.x - origin.x, snapped.y - origin.y, snapped.z - origin.z});
    }
    double reach = 0;
    for (const MeshPrimitive& p : open.mesh.primitives)
      for (const MeshVertex& v : p.vertices)
        for (const double c : y_up(corners[v.position])) reach = std::max(reach, std::fabs(c));
    std::string primitives;
    for (const MeshPrimitive& p : open.mesh.primitives) {
      const std::vector<std::uint16_t> indices = with_area(p, corners);
      if (indices.empty()) continue;
      figures_.triangles += indices.size() / 3;
      if (!primitives.empty()) primitives += ',';
      primitives += "{\"attributes\":{\"POSITION\":";
      append_number(primitives, std::int64_t{add_positions(p, corners, reach > kFinestReach)});
      if (p.texture >= 0) {
        primitives += ",\"TEXCOORD_0\":";
        append_number(primitives, std::int64_t{add_repeats(p)});
      }
      primitives += "},\"indices\":";
      const std::size_t at = document_.append<std::uint16_t>(Stream::indices, indices);
      append_number(primitives, std::int64_t{document_.add_accessor({.stream = Stream::indices,
                                                                     .offset = at,
                                                                     .component = Component::uint16,
                                                                     .type = "SCALAR",
                                                                     .count = indices.size()})});
      primitives += ",\"material\":";
      append_number(primitives, std::int64_t{material_of(p)});
      primitives += '}';
    }
    if (primitives.empty()) return -1;
    std::string json = "{\"name\":";
    append_json(json, open.part->id);
    return document_.add_mesh(json + ",\"primitives\":[" + primitives + "]}");
  }

  bool is_glass(const MeshPrimitive& p) const { return panes_ && panes_->is_glass(p.look.material); }

  int material_of(const MeshPrimitive& p) {
    if (is_glass(p)) return document_.add_material(panes_->json(p.look, MaterialName::with_colour));
    if (p.texture >= 0) return textures_->material(document_, p, p.look.colour);
    return document_.add_material(
        material_json(region_.materials.at(p.look.material), p.look.colour, MaterialName::with_colour));
  }

  int add_repeats(const MeshPrimitive& p) {
    const std::size_t at =
        document_.append<std::array<float, 2>>(Stream::texture_repeats, std::span(p.repeats.data(), p.repeats.size()));
    return document_.add_accessor({.stream = Stream::texture_repeats,
                                   .offset = at,
                                   .component = Component::float32,
                                   .type = "VEC2",
                                   .count = p.vertices.size()});
  }

  /// The triangles that have an area on the grid: slivers of elements may have lost theirs when they were turned.
  static std::vector<std::uint16_t> with_area(const MeshPrimitive& p, const std::vector<Point3>& corners) {
    std::vector<std::uint16_t> out;
    for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3) {
      const Point3 &a = corners[p.vertices[p.indices[t]].position], &b = corners[p.vertices[p.indices[t + 1]].position],
                   &c = corners[p.vertices[p.indices[t + 2]].position];
      const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
      if (uy * vz == uz * vy && uz * vx == ux * vz && ux * vy == uy * vx) continue;
      out.insert(out.end(), {p.indices[t], p.indices[t + 1], p.indices[t + 2]});
    }
    return out;
  }

  int add_positions(const MeshPrimitive& p, const std::vector<Point3>& corners, bool far) {
    std::vector<float> values;
    values.reserve(3 * p.vertices.size());
    std::array<std::array<double, 3>, 2> bounds{};
    for (const MeshVertex& v : p.vertices) {
      const std::array<double, 3> xyz = y_up(corners[v.position]);
      const bool first = values.empty();
      for (std::size_t i = 0; i < 3; ++i) {
        const float value = static_cast<float>(xyz[i]) + 0.0f;  // no -0
        bounds[0][i] = first ? value : std::min<double>(bounds[0][i], value);
        bounds[1][i] = first ? value : std::max<double>(bounds[1][i], value);
        values.push_back(value);
      }
    }
    const Stream to = far ? Stream::far_positions : Stream::positions;
    const std::size_t at = document_.append<float>(to, values);
    return document_.add_accessor({.stream = to,
                                   .offset = at,
                                   .component = Component::float32,
                                   .type = "VEC3",
                                   .count = p.vertices.size(),
                                   .bounds = bounds});
  }

  void add_element(const PartElement& place, const Point3& origin, std::vector<int>& children) {
    const model::ColouredElement& element = region_.elements.at(place.element);
    const ElementForm form = stored_.form(*element.element, place.panes);
    if (form.stored < 0) return;
    const auto [mesh, added] = meshes_.try_emplace(stored_.mesh_key(form.stored, element, place.panes), -1);
    if (added) mesh->second = stored_.add_mesh(form.stored, element, place.panes, MaterialName::with_colour);
    const StoredElement& stored = stored_[form.stored];
    std::string json = "{\"extras\":{\"feature\":";
    append_number(json, std::int64_t{place.at->feature});
    json += "},\"mesh\":";
    append_number(json, std::int64_t{mesh->second});
    std::array<double, 4> turn = rotation_to(place.at->along);
    for (double& v : turn) v = std::nearbyint(v * 1e7) / 1e7;
    append_numbers(json, "rotation", turn);
    if (stored.stretched) append_numbers(json, "scale", std::array<double, 3>{form.stretch, 1, 1});
    const Point3 at = on_grid(place.at->origin);
    append_numbers(json, "translation", y_up({at.x - origin.x, at.y - origin.y, at.z - origin.z}));
    children.push_back(document_.add_node(json + '}'));
    ++figures_.placements;
    figures_.triangles += stored.triangles;
  }

  GlbDocument& document_;
  const model::Region& region_;
  TagReader tags_;
  StoredElements stored_;
  SurfaceTextures* textures_;               ///< null: none
  const PaneMaterials* panes_;              ///< null: glass is as modelled
  std::map<std::vector<int>, int> meshes_;  ///< of elements, by StoredElements::mesh_key
  std::vector<OpenPart> open_;              ///< of the building that comes in
  ObjectFigures figures_;
  bool first_ = true;
};

}  // namespace

ObjectFigures write_objects(GlbDocument& document, const model::Region& region, int lod, const Frame& frame,
                            Instancing elements, SurfaceTextures* textures, const PaneMaterials* panes) {
  return ObjectWriter(document, region, textures, panes).write(lod, frame, elements);
}

}  // namespace blockrand::outputs
