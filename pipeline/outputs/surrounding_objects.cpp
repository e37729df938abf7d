#include "pipeline/outputs/surrounding_objects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "pipeline/base/portable_math.h"
#include "pipeline/outputs/tile_digits.h"

namespace blockrand::outputs {
namespace {

using model::BodyClass;
using model::GroundClass;

/// How a ground or a body is told.
struct Telling {
  SurroundingTheme theme = SurroundingTheme::land_use;
  SurroundingRole role = SurroundingRole::area;
  std::string_view usage{};
};

Telling telling_of(GroundClass ground) {
  using enum SurroundingTheme;
  constexpr auto kArea = SurroundingRole::area;
  switch (ground) {
    case GroundClass::passage:
      return {road};
    case GroundClass::carriageway:
      return {road, kArea, "car"};
    case GroundClass::parking_lane:
      return {road, SurroundingRole::auxiliary, "car"};
    case GroundClass::cycle_way:
      return {road, kArea, "bicycle"};
    case GroundClass::steps:
    case GroundClass::footway:
    case GroundClass::pavement:
      return {road, kArea, "pedestrian"};
    case GroundClass::square:
      return {square, kArea, "pedestrian"};
    case GroundClass::rail_bed:
      return {railway, kArea, "train"};
    case GroundClass::runway:
      return {traffic, kArea, "aeroplane"};
    case GroundClass::platform:
      return {traffic, kArea, "pedestrian"};
    case GroundClass::parking:
      return {traffic, kArea, "car"};
    case GroundClass::water:
    case GroundClass::swimming_pool:
      return {water};
    case GroundClass::flower_bed:
    case GroundClass::wood:
    case GroundClass::scrub:
      return {plant_cover};
    case GroundClass::pitch:
    case GroundClass::playground:
    case GroundClass::golf:
    case GroundClass::grass:
    case GroundClass::garden:
    case GroundClass::cemetery:
    case GroundClass::field:
    case GroundClass::sand:
    case GroundClass::rock:
    case GroundClass::construction:
    case GroundClass::yard:
    case GroundClass::land:
      break;
  }
  return {land_use};
}

Telling telling_of(BodyClass body) {
  using enum SurroundingTheme;
  switch (body) {
    case BodyClass::wall:
    case BodyClass::retaining_wall:
    case BodyClass::city_wall:
    case BodyClass::fence:
    case BodyClass::guard_rail:
      return {furniture};
    case BodyClass::hedge:
      return {plant_cover};
    case BodyClass::kerb:
      return {road, SurroundingRole::auxiliary};
    case BodyClass::marking:
      return {road, SurroundingRole::marking};
    case BodyClass::stairs:
      return {road, SurroundingRole::area, "pedestrian"};
    case BodyClass::rail:
      return {railway, SurroundingRole::area, "train"};
    case BodyClass::bridge:
    case BodyClass::pier:
      return {bridge};
    case BodyClass::cliff:
      return {land_use};
    case BodyClass::power_line:
    case BodyClass::other:
      break;
  }
  return {construction};
}

SurroundingTheme theme_of(model::ObjectTheme theme) {
  switch (theme) {
    case model::ObjectTheme::vegetation:
      return SurroundingTheme::plant;
    case model::ObjectTheme::furniture:
    case model::ObjectTheme::transportation:  // signs and signals are furniture in CityGML
      return SurroundingTheme::furniture;
    case model::ObjectTheme::other:
      break;
  }
  return SurroundingTheme::placed_thing;
}

bool can_be_shown(const model::FlatPolygon& face) { return !rings_on_grid(face).empty(); }

class Collector {
 public:
  Collector(const model::SurroundingCatalogue& catalogue, model::TileId tile) : catalogue_(catalogue) {
    append_base36(tile_, number_of(tile));
  }

  void add(const model::GroundSurface& surface) {
    const Telling told = telling_of(surface.ground);
    SurroundingPart part{.role = told.role,
                         .function = name(surface.ground),
                         .usage = told.usage,
                         .material = surface.material,
                         .offset = surface.offset};
    const bool with_edges = is_traffic(told.theme) || told.theme == SurroundingTheme::water;
    // The strongest ground gives the object its name; grounds are listed in that order.
    const auto rank = static_cast<std::size_t>(surface.ground);
    const std::string_view kind = is_traffic(told.theme) ? std::string_view() : name(surface.ground);
    const std::size_t object = object_of(told.theme, surface.object, kind, surface.material, surface.offset);
    name_by_rank(object, rank, name(surface.ground));
    put(object, part, surface.faces);
    if (with_edges) {
      part.role = SurroundingRole::edge;
      part.function = told.theme == SurroundingTheme::water ? "bank" : "kerb";
      part.usage = {};
    }
    put(object, part, surface.edges);
  }

  void add(const model::SurroundingBody& body) {
    const Telling told = telling_of(body.body);
    const SurroundingPart part{.role = told.role,
                               .function = name(body.body),
                               .usage = told.usage,
                               .material = body.material,
                               .is_body = true,
                               .is_solid = body.closed && told.theme != SurroundingTheme::land_use};
    const bool joined = is_traffic(told.theme) || told.theme == SurroundingTheme::bridge;
    const std::size_t object = joined ? object_of(told.theme, body.object, {}, 0, 0) : new_object(told.theme);
    objects_[object].object = body.object;
    name_by_rank(object, model::kGroundClassCount + static_cast<std::size_t>(body.body), name(body.body));
    put(object, part, body.faces);
  }

  void add(const model::PlacedObject& placed) {
    const model::ObjectShape& shape = catalogue_.shapes.at(placed.shape);
    SurroundingObject& object = objects_[new_object(theme_of(shape.theme))];
    object.object = placed.object;
    object.kind = shape.kind;
    object.placed = &placed;
  }

  std::vector<SurroundingObject> done() && {
    std::erase_if(objects_, [](const SurroundingObject& o) { return !o.placed && o.parts.empty(); });
    std::map<model::OsmId, std::uint64_t> last;
    for (SurroundingObject& o : objects_) {
      std::stable_sort(o.parts.begin(), o.parts.end(),
                       [](const SurroundingPart& a, const SurroundingPart& b) { return a.role < b.role; });
      o.id = (o.object.number == 0 ? std::string("unmapped") : o.object.text()) + '_' + tile_ + '_';
      o.id += std::to_string(++last[o.object.number == 0 ? model::OsmId() : o.object]);
    }
    return std::move(objects_);
  }

 private:
  using Key = std::tuple<model::OsmId, SurroundingTheme, std::string_view, model::SurroundingMaterial, float>;

  std::size_t new_object(SurroundingTheme theme) {
    objects_.push_back({.theme = theme});
    ranks_.push_back(~std::size_t{0});
    return objects_.size() - 1;
  }

  /// What nothing is mapped for has no object that could hold its squares together.
  std::size_t object_of(SurroundingTheme theme, model::OsmId id, std::string_view kind,
                        model::SurroundingMaterial material, float offset) {
    if (id.number == 0) return new_object(theme);
    const Key key = is_traffic(theme) || theme == SurroundingTheme::bridge ? Key{id, theme, {}, 0, 0}
                                                                           : Key{id, theme, kind, material, offset};
    const auto [place, added] = at_.try_emplace(key, objects_.size());
    if (added) objects_[new_object(theme)].object = id;
    return place->second;
  }

  void name_by_rank(std::size_t object, std::size_t rank, std::string_view kind) {
    if (rank >= ranks_[object]) return;
    ranks_[object] = rank;
    objects_[object].kind = kind;
  }

  /// Solids stay apart, all else of one sort is one part.
  void put(std::size_t object, const SurroundingPart& like, const std::vector<model::FlatPolygon>& faces) {
    std::vector<const model::FlatPolygon*> shown;
    for (const model::FlatPolygon& face : faces)
      if (can_be_shown(face)) shown.push_back(&face);
    if (shown.empty()) return;
    std::vector<SurroundingPart>& parts = objects_[object].parts;
    const bool stays_apart = like.is_solid && !is_traffic(objects_[object].theme);
    auto part = stays_apart ? parts.end() : std::find_if(parts.begin(), parts.end(), [&](const SurroundingPart& p) {
      return !p.is_solid && p.role == like.role && p.function == like.function && p.material == like.material &&
             p.offset == like.offset && p.is_body == like.is_body;
    });
    if (part == parts.end()) {
      part = parts.insert(parts.end(), like);
      part->is_solid = stays_apart;
    }
    part->faces.insert(part->faces.end(), shown.begin(), shown.end());
  }

  const model::SurroundingCatalogue& catalogue_;
  std::string tile_;
  std::vector<SurroundingObject> objects_;
  std::vector<std::size_t> ranks_;  ///< of what gave each object its name
  std::map<Key, std::size_t> at_;
};

std::vector<model::Point3> ring_on_grid(const std::vector<model::Point3>& ring) {
  std::vector<model::Point3> out;
  for (const model::Point3& p : ring)
    if (const model::Point3 q = model::snap(p); out.empty() || !(q == out.back())) out.push_back(q);
  while (out.size() > 1 && out.front() == out.back()) out.pop_back();
  if (out.size() < 3) out.clear();
  return out;
}

}  // namespace

std::vector<SurroundingObject> surrounding_objects(const model::Surroundings& surroundings,
                                                   const model::SurroundingCatalogue& catalogue, model::TileId tile) {
  Collector collector(catalogue, tile);
  for (const model::GroundSurface& surface : surroundings.surfaces) collector.add(surface);
  for (const model::SurroundingBody& body : surroundings.bodies) collector.add(body);
  for (const model::PlacedObject& placed : surroundings.objects) collector.add(placed);
  return std::move(collector).done();
}

std::vector<std::vector<model::Point3>> rings_on_grid(const model::FlatPolygon& face) {
  std::vector<std::vector<model::Point3>> rings = {ring_on_grid(face.outer)};
  if (rings.front().empty()) return {};
  for (const std::vector<model::Point3>& hole : face.holes)
    if (std::vector<model::Point3> ring = ring_on_grid(hole); !ring.empty()) rings.push_back(std::move(ring));
  return rings;
}

std::vector<ShapeTriangle> shape_triangles(const model::ObjectShape::Triangles& part) {
  constexpr double kSteps = 10000;  // a metre
  std::vector<ShapeTriangle> out;
  for (std::size_t i = 0; i + 2 < part.corners.size(); i += 3) {
    ShapeTriangle t;
    for (std::size_t c = 0; c < 3; ++c) {
      const model::Point3& p = part.corners[i + c];
      t[c] = {std::llround(p.x * kSteps), std::llround(p.y * kSteps), std::llround(p.z * kSteps)};
    }
    std::int64_t a[3], b[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      a[axis] = t[1][axis] - t[0][axis];
      b[axis] = t[2][axis] - t[0][axis];
    }
    const bool flat = a[1] * b[2] == a[2] * b[1] && a[2] * b[0] == a[0] * b[2] && a[0] * b[1] == a[1] * b[0];
    if (!flat) out.push_back(t);
  }
  return out;
}

bool has_triangles(const model::ObjectShape& shape) {
  return std::any_of(shape.parts.begin(), shape.parts.end(),
                     [](const auto& part) { return !shape_triangles(part).empty(); });
}

std::array<double, 16> matrix_of(const model::PlacedObject& placed) {
  const base::SinCos turn = base::sin_cos(placed.turn);
  const double w = placed.width, h = placed.height;
  std::array<double, 16> m = {
      w * turn.cos, -w * turn.sin, 0, 0, w * turn.sin, w * turn.cos, 0, 0, 0, 0, h, 0, 0, 0, 0, 1};
  for (double& v : m) v = std::nearbyint(v * 1e6) / 1e6 + 0.0;  // a float knows no more of a turn
  return m;
}

std::array<model::Point3, 8> box_corners(const model::PlacedObject& placed, const model::ObjectShape& shape) {
  const std::array<double, 16> m = matrix_of(placed);
  const model::Point3 foot = model::snap(placed.place);
  std::array<model::Point3, 8> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double x = i & 1 ? shape.max.x : shape.min.x, y = i & 2 ? shape.max.y : shape.min.y,
                 z = i & 4 ? shape.max.z : shape.min.z;
    out[i] = {foot.x + m[0] * x + m[1] * y, foot.y + m[4] * x + m[5] * y, foot.z + m[10] * z};
  }
  return out;
}

double to_millimetres(double metres) { return std::nearbyint(metres * 1000) / 1000 + 0.0; }

double height_of(const model::PlacedObject& placed, const model::ObjectShape& shape) {
  return to_millimetres(shape.max.z * static_cast<double>(placed.height));
}

double width_of(const model::PlacedObject& placed, const model::ObjectShape& shape) {
  const double widest = std::max(shape.max.x - shape.min.x, shape.max.y - shape.min.y);
  return to_millimetres(widest * static_cast<double>(placed.width));
}

X3dMaterial x3d_material(const model::SurroundingMaterialClass& material) {
  return x3d_material({material.name, material.roughness, material.metallic}, material.colour);
}

}  // namespace blockrand::outputs
