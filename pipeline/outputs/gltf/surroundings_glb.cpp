#include "pipeline/outputs/gltf/surroundings_glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"
#include "pipeline/outputs/gltf/axes.h"
#include "pipeline/outputs/gltf/document_head.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/linear_light.h"
#include "pipeline/outputs/gltf/material.h"
#include "pipeline/outputs/gltf/mesh_writer.h"
#include "pipeline/outputs/gltf/property_table.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using model::FlatPolygon;
using model::Point3;

/// The rows of the property table: one for each object and what it is.
class Rows {
 public:
  std::uint32_t of(model::OsmId id, std::string_view kind, std::string_view material) {
    const auto [place, added] =
        rows_.try_emplace({id, std::string(kind), std::string(material)}, static_cast<std::uint32_t>(rows_.size()));
    if (added) listed_.push_back(&place->first);
    return place->second;
  }
  std::size_t size() const { return rows_.size(); }
  PropertyTable table() const {
    PropertyTable table(PropertyTable::Order::as_added);
    const int id =
        table.add({.name = "osm_id", .description = "OSM object; empty: not mapped, told by what stands around"});
    const int kind = table.add({.name = "class", .description = "what it is"});
    const int material = table.add({.name = "material"});
    for (const auto* row : listed_) {
      const auto& [object, class_name, made_of] = *row;
      if (object.number != 0) table.set_raw_text(id, object.text());
      table.set_raw_text(kind, class_name);
      table.set_text(material, made_of);
      table.end_row();
    }
    table.code_texts();
    return table;
  }

 private:
  using Row = std::tuple<model::OsmId, std::string, std::string>;
  std::map<Row, std::uint32_t> rows_;
  std::vector<const Row*> listed_;
};

/// Triangles of a face whose outer ring runs counter-clockwise seen from where it is seen: indices into the points of its rings.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const FlatPolygon& face) {
  if (face.holes.empty() && face.outer.size() == 3) return {{0, 1, 2}};
  std::vector<Point3> points = face.outer;
  std::vector<std::vector<std::uint32_t>> loops(1 + face.holes.size());
  for (std::uint32_t i = 0; i < face.outer.size(); ++i) loops[0].push_back(i);
  for (std::size_t h = 0; h < face.holes.size(); ++h)
    for (const Point3& p : face.holes[h]) {
      loops[h + 1].push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(p);
    }
  // In the plane along which it is widest.
  Point3 normal{};
  for (std::size_t i = 0; i < face.outer.size(); ++i) {
    const Point3 &a = face.outer[i], &b = face.outer[(i + 1) % face.outer.size()];
    normal.x += (a.y - b.y) * (a.z + b.z), normal.y += (a.z - b.z) * (a.x + b.x), normal.z += (a.x - b.x) * (a.y + b.y);
  }
  const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
  std::vector<geometry::Grid2> plan;
  for (const Point3& p : points) {
    const Point3& o = points[0];
    const double dx = p.x - o.x, dy = p.y - o.y, dz = p.z - o.z;
    double u = dx, v = dy;
    bool turned = normal.z < 0;
    if (x > y && x > z) {
      u = dy, v = dz, turned = normal.x < 0;
    } else if (y > z) {
      u = dz, v = dx, turned = normal.y < 0;
    }
    if (turned) u = -u;
    plan.push_back(geometry::to_grid(model::Point2{u, v}));
  }
  if (auto found = geometry::triangulate(plan, loops)) return *found;
  // Rings that touch have their common points once.
  std::map<geometry::Grid2, std::uint32_t> first;
  for (auto& loop : loops)
    for (std::uint32_t& i : loop) i = first.try_emplace(plan[i], i).first->second;
  return geometry::triangulate_touching(plan, loops).value_or(std::vector<geometry::Triangle>());
}

/// Twice the area of a triangle along its normal.
Point3 normal_of(const Point3& a, const Point3& b, const Point3& c) {
  const Point3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}
double length_of(const Point3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/// By corner: of all triangles that have it.
std::map<std::array<double, 3>, Point3> sums_of_normals(const model::ObjectShape::Triangles& part) {
  std::map<std::array<double, 3>, Point3> out;
  for (std::size_t t = 0; t + 2 < part.corners.size(); t += 3) {
    const Point3 n = normal_of(part.corners[t], part.corners[t + 1], part.corners[t + 2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3& p = part.corners[t + k];
      Point3& sum = out[{p.x, p.y, p.z}];
      sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
    }
  }
  return out;
}

/// Collects faces as a mesh.
class MeshMaker {
 public:
  MeshMaker(const model::SurroundingCatalogue& catalogue, const Frame& frame) : catalogue_(catalogue), frame_(frame) {}

  /// \param round  shaded as if it had no edges
  void add(const FlatPolygon& face, model::SurroundingMaterial material, std::uint32_t row, bool round = false) {
    const auto triangles = triangles_of(face);
    if (triangles.empty()) return;
    std::vector<Point3> points = face.outer;
    for (const auto& hole : face.holes) points.insert(points.end(), hole.begin(), hole.end());
    std::vector<std::uint32_t> positions;
    for (const Point3& p : points) positions.push_back(position(p));
    for (const auto& t : triangles) {
      corners_.push_back({{positions[t[0]], positions[t[1]], positions[t[2]]}, row, material, round});
    }
  }

  /// \param with_plan  for textures of the ground
  Mesh take(bool with_plan) {
    Mesh mesh;
    mesh.solid_positions = points_.size();
    if (with_plan)
      for (const Point3& p : points_) mesh.plan.push_back(p.xy());
    mesh.positions.resize(points_.size());
    if (frame_.to_enu) {
      frame_.to_enu(points_, mesh.positions);
    } else {
      mesh.positions = points_;
    }
    std::unordered_map<std::uint64_t, std::uint16_t> known;
    MeshPrimitive open;
    const auto close = [&] {
      if (!open.indices.empty()) mesh.primitives.push_back(std::move(open));
      open = {};
      known.clear();
    };
    std::vector<MeshVertex> vertices;
    bool first = true;
    const auto normal_at = [&](const Corners& c) {
      return normal_of(mesh.positions[c.at[0]], mesh.positions[c.at[1]], mesh.positions[c.at[2]]);
    };
    std::unordered_map<std::uint32_t, Point3> round;  // by position
    for (const Corners& c : corners_)
      for (const std::uint32_t at : c.at)
        if (c.round) round[at] = round[at] + normal_at(c);
    for (const Corners& c : corners_) {
      const Point3 flat = normal_at(c);
      if (!(length_of(flat) > 0)) continue;
      if (open.vertices.size() + 3 > MeshPrimitive::kMostVertices) close();
      for (const std::uint32_t at : c.at) {
        MeshVertex vertex;
        vertex.position = at, vertex.feature = c.row;
        const Point3 n = c.round && length_of(round[at]) > 0 ? round[at] : flat;
        const double length = length_of(n);
        const auto byte = [&](double value) { return static_cast<std::int8_t>(std::lround(value / length * 127)); };
        vertex.normal = {byte(n.x), byte(n.y), byte(n.z)};
        vertex.look = {static_cast<std::uint8_t>(c.material), catalogue_.materials[c.material].colour};
        // Position, normal and material make a vertex; of one place there are few rows.
        std::uint64_t key = (static_cast<std::uint64_t>(at) << 32) ^ (static_cast<std::uint64_t>(c.row) * 0x9e3779b1u);
        key ^= static_cast<std::uint64_t>(static_cast<std::uint8_t>(vertex.normal[0])) << 8 |
               static_cast<std::uint64_t>(static_cast<std::uint8_t>(vertex.normal[1])) << 16 |
               static_cast<std::uint64_t>(static_cast<std::uint8_t>(vertex.normal[2])) << 24;
        auto [place, added] = known.try_emplace(key, static_cast<std::uint16_t>(open.vertices.size()));
        if (!added && !(open.vertices[place->second] == vertex)) {  // two of one key: a vertex of its own
          open.indices.push_back(static_cast<std::uint16_t>(open.vertices.size()));
          open.vertices.push_back(vertex);
          continue;
        }
        if (added) open.vertices.push_back(vertex);
        open.indices.push_back(place->second);
        const Point3& p = mesh.positions[at];
        mesh.min = first ? p : Point3{std::min(mesh.min.x, p.x), std::min(mesh.min.y, p.y), std::min(mesh.min.z, p.z)};
        mesh.max = first ? p : Point3{std::max(mesh.max.x, p.x), std::max(mesh.max.y, p.y), std::max(mesh.max.z, p.z)};
        first = false;
      }
      ++mesh.triangles;
    }
    close();
    return mesh;
  }

 private:
  struct Corners {
    std::array<std::uint32_t, 3> at{};
    std::uint32_t row = 0;
    model::SurroundingMaterial material = 0;
    bool round = false;
  };
  struct Hash {
    std::size_t operator()(const Point3& p) const {
      const auto bits = [](double v) { return static_cast<std::uint64_t>(std::llround(v * 1024)); };
      return static_cast<std::size_t>(bits(p.x) * 0x9e3779b97f4a7c15ULL ^ bits(p.y) * 0xbf58476d1ce4e5b9ULL ^
                                      bits(p.z));
    }
  };
  std::uint32_t position(const Point3& p) {
    const auto [place, added] = positions_.try_emplace(p, static_cast<std::uint32_t>(points_.size()));
    if (added) points_.push_back(p);
    return place->second;
  }

  const model::SurroundingCatalogue& catalogue_;
  const Frame& frame_;
  std::vector<Point3> points_;
  std::unordered_map<Point3, std::uint32_t, Hash> positions_;
  std::vector<Corners> corners_;
};

/// An object's turn and place, in the build CRS.
Point3 placed(const model::PlacedObject& object, const Point3& p) {
  const auto [s, c] = base::sin_cos(static_cast<double>(object.turn));
  const double x = p.x * static_cast<double>(object.width), y = p.y * static_cast<double>(object.width);
  return model::snap(Point3{object.place.x + c * x - s * y, object.place.y + s * x + c * y,
                            object.place.z + p.z * static_cast<double>(object.height)});
}

/// Writes shapes and their places.
class ShapeWriter {
 public:
  ShapeWriter(GlbDocument& document, const model::SurroundingCatalogue& catalogue, const MaterialTable& materials,
              int material, const Frame& frame)
      : document_(document), catalogue_(catalogue), materials_(materials), material_(material), frame_(frame) {}

  /// \param rows  of the property table, parallel to `objects`
  void write(std::span<const model::PlacedObject> objects, std::span<const std::uint32_t> rows, Glb& glb, bool& first) {
    std::map<std::uint16_t, std::vector<std::size_t>> of_shape;
    for (std::size_t i = 0; i < objects.size(); ++i) of_shape[objects[i].shape].push_back(i);
    for (const auto& [shape, list] : of_shape) {
      const model::ObjectShape& form = catalogue_.shapes[shape];
      std::size_t triangles = 0;
      const int mesh = add_mesh(form, triangles);
      if (triangles == 0) continue;
      std::vector<Point3> places, local(list.size());
      for (const std::size_t i : list) places.push_back(objects[i].place);
      if (frame_.to_enu) {
        frame_.to_enu(places, local);
      } else {
        local = places;
      }
      std::vector<float> translations, scales;
      std::vector<std::int16_t> rotations;
      std::vector<std::uint16_t> narrow;
      std::vector<float> wide;
      std::uint32_t most_row = 0;
      for (std::size_t k = 0; k < list.size(); ++k) {
        const model::PlacedObject& object = objects[list[k]];
        for (const double v : y_up(local[k].x, local[k].y, local[k].z))
          translations.push_back(static_cast<float>(std::nearbyint(v * kSteps) / kSteps) + 0.0f);
        const double half = static_cast<double>(object.turn) / 2;
        const base::SinCos turn = base::sin_cos(half);
        for (const double v : {0.0, turn.sin, 0.0, turn.cos})
          rotations.push_back(static_cast<std::int16_t>(std::lround(v * 32767)));
        const auto step = [](float v) { return std::max(1.0f, std::nearbyint(v * 64)) / 64; };
        scales.insert(scales.end(), {step(object.width), step(object.height), step(object.width)});
        narrow.push_back(static_cast<std::uint16_t>(rows[list[k]]));
        wide.push_back(static_cast<float>(rows[list[k]]));
        most_row = std::max(most_row, rows[list[k]]);
        const double w =
            static_cast<double>(step(object.width)) *
            std::max({std::fabs(form.min.x), std::fabs(form.min.y), std::fabs(form.max.x), std::fabs(form.max.y)}) *
            1.4143;
        const double h = static_cast<double>(step(object.height));
        const Point3 low{local[k].x - w, local[k].y - w, local[k].z + h * std::min(0.0, form.min.z) - 0.05};
        const Point3 high{local[k].x + w, local[k].y + w, local[k].z + h * form.max.z + 0.05};
        glb.min =
            first ? low : Point3{std::min(glb.min.x, low.x), std::min(glb.min.y, low.y), std::min(glb.min.z, low.z)};
        glb.max = first ? high
                        : Point3{std::max(glb.max.x, high.x), std::max(glb.max.y, high.y), std::max(glb.max.z, high.z)};
        first = false;
      }
      std::vector<std::uint32_t> used;
      for (const std::size_t i : list) used.push_back(rows[i]);
      std::ranges::sort(used);
      const auto different = std::unique(used.begin(), used.end()) - used.begin();
      std::string json =
          "{\"extensions\":{\"EXT_instance_features\":{\"featureIds\":[{\"attribute\":0,\"featureCount\":";
      append_number(json, static_cast<std::int64_t>(different));
      json += ",\"propertyTable\":0}]},\"EXT_mesh_gpu_instancing\":{\"attributes\":{";
      add(json, "ROTATION", Stream::rotations, rotations, Component::int16, "VEC4", list.size(), true);
      add(json, "SCALE", Stream::scales, scales, Component::float32, "VEC3", list.size(), false);
      add(json, "TRANSLATION", Stream::far_translations, translations, Component::float32, "VEC3", list.size(), false);
      if (most_row > 0xFFFF) {
        add(json, "_FEATURE_ID_0", Stream::wide_instance_features, wide, Component::float32, "SCALAR", list.size(),
            false);
      } else {
        add(json, "_FEATURE_ID_0", Stream::instance_features, narrow, Component::uint16, "SCALAR", list.size(), false);
      }
      json += "}}},\"mesh\":";
      append_number(json, std::int64_t{mesh});
      json += ",\"name\":";
      append_json(json, form.name);
      document_.add_root(document_.add_node(json + '}'));
      glb.triangles += triangles * list.size();
      glb.placements += list.size();
      ++glb.elements;
    }
    if (glb.placements == 0) return;
    document_.use("EXT_mesh_gpu_instancing", true);
    document_.use("EXT_instance_features", false);
    document_.use("KHR_mesh_quantization", true);
  }

 private:
  static constexpr double kSteps = kTileStepsPerMetre;

  template <class T>
  void add(std::string& json, const char* name, Stream stream, const std::vector<T>& list, Component component,
           const char* type, std::size_t count, bool normalised,
           std::optional<std::array<std::array<double, 3>, 2>> bounds = std::nullopt) {
    const std::size_t at = document_.append<T>(stream, list);
    if (json.back() != '{') json += ',';
    json += '"';
    json += name;
    json += "\":";
    append_number(json, std::int64_t{document_.add_accessor({.stream = stream,
                                                             .offset = at,
                                                             .component = component,
                                                             .type = type,
                                                             .count = count,
                                                             .normalised = normalised,
                                                             .bounds = bounds})});
  }

  int add_mesh(const model::ObjectShape& form, std::size_t& triangles) {
    std::vector<float> positions;
    std::vector<std::int8_t> normals;
    std::vector<std::uint16_t> colours, classes, indices;
    std::array<std::array<double, 3>, 2> bounds{};
    std::map<std::tuple<std::array<float, 3>, std::array<std::int8_t, 3>, model::SurroundingMaterial>, std::uint16_t>
        known;
    for (const model::ObjectShape::Triangles& part : form.parts) {
      const std::map<std::array<double, 3>, Point3> round = part.round ? sums_of_normals(part) : decltype(round)();
      for (std::size_t t = 0; t + 2 < part.corners.size(); t += 3) {
        const Point3 &a = part.corners[t], &b = part.corners[t + 1], &c = part.corners[t + 2];
        const Point3 n = normal_of(a, b, c);
        if (!(length_of(n) > 0) || known.size() + 3 > MeshPrimitive::kMostVertices) continue;
        for (const Point3* p : {&a, &b, &c}) {
          const Point3 sum = part.round ? round.at({p->x, p->y, p->z}) : n;
          const Point3& own = length_of(sum) > 0 ? sum : n;
          const double length = length_of(own);
          const auto byte = [&](double value) { return static_cast<std::int8_t>(std::lround(value / length * 127)); };
          const std::array<std::int8_t, 3> normal = y_up(byte(own.x), byte(own.y), byte(own.z));
          std::array<float, 3> at{};
          const std::array<double, 3> xyz = y_up(p->x, p->y, p->z);
          for (std::size_t k = 0; k < 3; ++k)
            at[k] = static_cast<float>(std::nearbyint(xyz[k] * kSteps) / kSteps) + 0.0f;
          const auto [place, added] =
              known.try_emplace({at, normal, part.material}, static_cast<std::uint16_t>(known.size()));
          if (added) {
            for (std::size_t k = 0; k < 3; ++k) {
              const bool first = positions.size() < 3;
              bounds[0][k] = first ? static_cast<double>(at[k]) : std::min(bounds[0][k], static_cast<double>(at[k]));
              bounds[1][k] = first ? static_cast<double>(at[k]) : std::max(bounds[1][k], static_cast<double>(at[k]));
            }
            positions.insert(positions.end(), at.begin(), at.end());
            normals.insert(normals.end(), {normal[0], normal[1], normal[2], std::int8_t{0}});
            const model::Colour& colour = catalogue_.materials[part.material].colour;
            colours.insert(colours.end(), {kLinearLight[colour.r], kLinearLight[colour.g], kLinearLight[colour.b],
                                           std::uint16_t{65535}});
            const std::array<std::uint16_t, 2> texel = materials_.place(static_cast<std::uint8_t>(part.material));
            classes.insert(classes.end(), texel.begin(), texel.end());
          }
          indices.push_back(place->second);
        }
        ++triangles;
      }
    }
    if (triangles == 0) return -1;
    std::string json = "{\"primitives\":[{\"attributes\":{";
    const std::size_t n = known.size();
    add(json, "COLOR_0", Stream::colours, colours, Component::uint16, "VEC4", n, true);
    add(json, "NORMAL", Stream::normals, normals, Component::int8, "VEC3", n, true);
    add(json, "POSITION", Stream::tile_positions, positions, Component::float32, "VEC3", n, false, bounds);
    add(json, "TEXCOORD_0", Stream::texture_places, classes, Component::uint16, "VEC2", n, true);
    json += "},\"indices\":";
    const std::size_t at = document_.append<std::uint16_t>(Stream::indices, indices);
    append_number(json, std::int64_t{document_.add_accessor({.stream = Stream::indices,
                                                             .offset = at,
                                                             .component = Component::uint16,
                                                             .type = "SCALAR",
                                                             .count = indices.size()})});
    json += ",\"material\":";
    append_number(json, std::int64_t{material_});
    json += "}],\"name\":";
    append_json(json, form.name);
    return document_.add_mesh(json + '}');
  }

  GlbDocument& document_;
  const model::SurroundingCatalogue& catalogue_;
  const MaterialTable& materials_;
  int material_;
  const Frame& frame_;
};

nlohmann::ordered_json metadata(GlbDocument& document, const PropertyTable& table) {
  using Object = nlohmann::ordered_json;
  Object properties = table.class_properties();
  nlohmann::json enums = table.text_enums();
  Object of_class = {{"name", "Surrounding"}, {"properties", std::move(properties)}};
  Object schema = {{"classes", {{kSurroundingClass, std::move(of_class)}}}, {"id", "blockrand"}, {"version", "1.0.0"}};
  if (!enums.empty()) schema["enums"] = std::move(enums);
  return {{"propertyTables", Object::array({table.write(document, kSurroundingClass)})}, {"schema", std::move(schema)}};
}

}  // namespace

namespace {

/// Whether what covers a ground is laid along its sides.
bool is_laid_along(model::GroundClass ground) {
  using enum model::GroundClass;
  constexpr model::GroundClass kLaid[] = {carriageway, parking_lane, steps,  cycle_way, platform,
                                          footway,     pavement,     square, parking};
  return std::ranges::find(kLaid, ground) != std::end(kLaid);
}

/// The directions along which most of the sides of grounds lead, or across, in steps of kStep: nearly the same in the tile beside.
class CourseFinder {
 public:
  void add(std::uint32_t row, const std::vector<FlatPolygon>& faces) {
    if (sums_.size() <= row) sums_.resize(row + 1);
    for (const FlatPolygon& face : faces)
      for (std::size_t i = 0; i < face.outer.size(); ++i) {
        const Point3 &a = face.outer[i], &b = face.outer[(i + 1) % face.outer.size()];
        const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
        // Sides along squares and triangles of the terrain are cuts.
        if (!(length > 0) || dx == 0 || dy == 0 || std::fabs(dx) == std::fabs(dy)) continue;
        const double c = dx / length, s = dy / length, c2 = c * c - s * s, s2 = 2 * c * s;
        sums_[row][0] += length * (c2 * c2 - s2 * s2), sums_[row][1] += length * (2 * c2 * s2);
        sums_[row][2] += length;
      }
  }
  std::vector<std::array<double, 2>> take() const {
    std::vector<std::array<double, 2>> out;
    // Of sides that lead everywhere, as round ends do, nothing is left but noise.
    constexpr double kAgreed = 0.1;
    for (const auto& [x, y, length] : sums_) {
      const double angle = x * x + y * y > kAgreed * kAgreed * length * length ? base::atan2(y, x) / 4 : 0;
      const base::SinCos turn = base::sin_cos(std::nearbyint(angle / kStep) * kStep);
      out.push_back({turn.cos, turn.sin});
    }
    return out;
  }

 private:
  static constexpr double kStep = 2 * base::kRadiansPerDegree;
  std::vector<std::array<double, 3>> sums_;  ///< by row: lengths of sides at four times their angles, and along
};

/// Whether the edges of a ground are stones; where land lies higher than a road there are none.
bool has_kerb_stones(model::GroundClass ground) {
  using enum model::GroundClass;
  constexpr model::GroundClass kBare[] = {wood, scrub, field, sand, rock, construction, golf, land, pitch};
  return std::ranges::find(kBare, ground) == std::end(kBare);
}

/// What is seen from above of the stone of a kerb, from the upper edge of its face inwards. Nothing for other steps: banks, walls.
std::optional<FlatPolygon> top_of_kerb(const FlatPolygon& face) {
  // m [DIN EN 1340, DIN 483: kerb stones are 10 to 18 cm wide]. Its far side lies over the ground behind it, which may rise.
  constexpr double kWidth = 0.12, kOver = 0.015, kHighest = 0.2;
  if (face.outer.size() != 4) return std::nullopt;
  const Point3 &a_low = face.outer[0], &b_low = face.outer[1], &b = face.outer[2], &a = face.outer[3];
  const double rise = std::max(a.z - a_low.z, b.z - b_low.z), dx = b.x - a.x, dy = b.y - a.y,
               length = std::hypot(dx, dy);
  if (!(rise > 0) || rise > kHighest || !(length > 0)) return std::nullopt;
  const double x = -dy / length * kWidth, y = dx / length * kWidth;
  return FlatPolygon{
      {a, b, model::snap(Point3{b.x + x, b.y + y, b.z + kOver}), model::snap(Point3{a.x + x, a.y + y, a.z + kOver})},
      {}};
}

}  // namespace

std::optional<double> lowest_point(const model::Surroundings& surroundings) {
  std::optional<double> low;
  const auto see = [&](const FlatPolygon& face) {
    for (const Point3& p : face.outer) low = low ? std::min(*low, p.z) : p.z;
  };
  for (const auto& s : surroundings.surfaces) {
    std::ranges::for_each(s.faces, see);
    std::ranges::for_each(s.edges, see);
  }
  for (const auto& b : surroundings.bodies) std::ranges::for_each(b.faces, see);
  for (const auto& o : surroundings.objects) low = low ? std::min(*low, o.place.z) : o.place.z;
  return low;
}

Glb write_surroundings_glb(const model::Surroundings& surroundings, const model::SurroundingCatalogue& catalogue,
                           const GlbOptions& options) {
  GlbDocument document;
  write_head(document, options);
  Glb glb;
  Rows rows;
  MeshMaker maker(catalogue, options.frame);
  const auto kerb = [&] {
    for (std::size_t m = 0; m < catalogue.materials.size(); ++m)
      if (catalogue.materials[m].name == "kerb_stone") return static_cast<model::SurroundingMaterial>(m);
    return model::SurroundingMaterial{0};
  }();
  CourseFinder courses;
  for (const model::GroundSurface& s : surroundings.surfaces) {
    const std::uint32_t row = rows.of(s.object, model::name(s.ground), catalogue.materials[s.material].name);
    for (const FlatPolygon& face : s.faces) maker.add(face, s.material, row);
    if (is_laid_along(s.ground)) courses.add(row, s.faces);
    const bool stone = has_kerb_stones(s.ground);
    for (const FlatPolygon& face : s.edges) {
      maker.add(face, stone ? kerb : s.material, row);
      if (const std::optional<FlatPolygon> top = stone ? top_of_kerb(face) : std::nullopt) maker.add(*top, kerb, row);
    }
  }
  for (const model::SurroundingBody& b : surroundings.bodies) {
    const std::uint32_t row = rows.of(b.object, model::name(b.body), catalogue.materials[b.material].name);
    for (const FlatPolygon& face : b.faces) maker.add(face, b.material, row);
  }
  std::vector<std::uint32_t> object_rows;
  const bool instanced = options.instancing == Instancing::ext;
  for (const model::PlacedObject& o : surroundings.objects) {
    const model::ObjectShape& shape = catalogue.shapes[o.shape];
    object_rows.push_back(rows.of(o.object, shape.kind, ""));
    if (instanced) continue;
    for (const auto& part : shape.parts)
      for (std::size_t t = 0; t + 2 < part.corners.size(); t += 3)
        maker.add({{placed(o, part.corners[t]), placed(o, part.corners[t + 1]), placed(o, part.corners[t + 2])}, {}},
                  part.material, object_rows.back(), part.round);
  }
  if (rows.size() > (1u << 24)) throw std::length_error("too many objects for one GLB");
  glb.rows = rows.size();
  if (rows.size() > 0) {
    std::vector<model::MaterialClass> classes;
    for (const auto& m : catalogue.materials) classes.push_back({m.name, m.roughness, m.metallic});
    const MaterialTable materials(classes);
    Mesh mesh = maker.take(options.textures != nullptr);
    if (options.textures != nullptr) mesh.courses = courses.take();
    const int material = document.add_material(materials.material_json(document.add_texture(materials.png())));
    bool first = true;
    if (!mesh.empty()) {
      glb.min = mesh.min, glb.max = mesh.max, first = false;
      std::optional<SurfaceTextures> textures;
      if (options.textures)
        textures.emplace(*options.textures, SurfaceTextures::Of::ground, classes, std::span<const CourseOutline>(),
                         options.texture_folder);
      glb.triangles = write_mesh(document, mesh, rows.size(), kSurroundingClass, material, materials,
                                 textures ? &*textures : nullptr);
      if (textures) glb.textures = textures->used(), glb.too_light = textures->too_light();
      document.use("EXT_mesh_features", false);
      document.use("KHR_mesh_quantization", true);
    }
    if (instanced)
      ShapeWriter(document, catalogue, materials, material, options.frame)
          .write(surroundings.objects, object_rows, glb, first);
    document.use("EXT_structural_metadata", false);
    document.extensions()["EXT_structural_metadata"] = metadata(document, rows.table());
  }
  glb.bytes = document.write(options.compression);
  return glb;
}

}  // namespace blockrand::outputs
