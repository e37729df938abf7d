#include "pipeline/run/landmarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "importers/reference/gltf.h"
#include "importers/reference/read_model.h"
#include "pipeline/base/error.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/solid_builder.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/georef/transform.h"
#include "pipeline/model/vector.h"

namespace blockrand::run {
namespace {

namespace reference = importers::reference;
using model::Point3;

/// Of a face's unit normal: flatter ones are roofs or undersides (about 6 degrees off the vertical).
constexpr double kUpright = 0.1;
constexpr double kSmallest = 1e-6;  ///< m2, of a face
/// Faces of one model: an unsimplified scan would be most of a town.
constexpr std::size_t kMostFaces = 500'000;
/// m: nothing that stands for one building is larger.
constexpr double kLargest = 2000;
/// m, of coordinates of the build: farther ones are no place on the Earth.
constexpr double kFarthest = 5e7;
/// m across a face's plane: a step of the grid, and what turning costs. Others become triangles.
constexpr double kPlane = 0.003;

bool is_gltf(const std::string& path) { return path.ends_with(".glb") || path.ends_with(".gltf"); }

/// A polygon of the highest level of detail, with what its surface is.
struct Shown {
  std::uint32_t polygon = 0;
  bool reversed = false;
  std::optional<reference::SurfaceClass> surface_class;
};

bool is_outside(const reference::Surface& s) {
  using reference::SurfaceClass;
  return !s.interior && s.surface_class != SurfaceClass::floor && s.surface_class != SurfaceClass::ceiling &&
         s.surface_class != SurfaceClass::interior_wall && s.surface_class != SurfaceClass::room &&
         s.surface_class != SurfaceClass::furniture;
}

bool is_body(const reference::Geometry& g) {
  return g.kind == reference::GeometryKind::solid || g.kind == reference::GeometryKind::surfaces;
}

/// Of what a building or part itself has; -1: nothing with faces.
int highest_level(const reference::Building& b) {
  int highest = -1;
  const auto look_at = [&](const std::vector<reference::Geometry>& all) {
    for (const reference::Geometry& g : all)
      if (is_body(g) && !g.faces.empty()) highest = std::max(highest, g.lod);
  };
  look_at(b.geometries);
  for (const reference::Surface& s : b.surfaces)
    if (is_outside(s)) look_at(s.geometries);
  return highest;
}

/// Of each building and part its highest level of detail, each polygon once; those of thematic surfaces with their class, whichever
/// geometry names them first. A building's own body says in general what its parts say in particular: it is left out where they say more.
std::vector<Shown> shown_polygons(const reference::ReferenceModel& model) {
  std::vector<int> of_parts(model.buildings.size(), -1), own;
  for (const reference::Building& b : model.buildings) {
    own.push_back(highest_level(b));
    if (b.parent >= 0) {
      int& parts = of_parts[static_cast<std::size_t>(b.parent)];
      parts = std::max(parts, own.back());
    }
  }
  std::vector<Shown> out;
  std::set<std::uint32_t> known;
  for (std::size_t i = 0; i < model.buildings.size(); ++i) {
    const reference::Building& b = model.buildings[i];
    if (own[i] < of_parts[i]) continue;
    const auto take = [&](const std::vector<reference::Geometry>& all, std::optional<reference::SurfaceClass> of) {
      for (const reference::Geometry& g : all)
        if (is_body(g) && g.lod == own[i])
          for (const reference::Face& f : g.faces)
            if (known.insert(f.polygon).second) out.push_back({f.polygon, f.reversed, of});
    };
    for (const reference::Surface& s : b.surfaces) {
      if (!is_outside(s)) continue;
      take(s.geometries, s.surface_class);
      for (const reference::Opening& o : s.openings) take(o.geometries, s.surface_class);
    }
    take(b.geometries, std::nullopt);
  }
  return out;
}

Point3 normal_of(const std::vector<Point3>& ring) {
  Point3 sum{};
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum = sum + model::cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return sum;
}

/// glTF's axes as east, north, up, scaled and turned.
Point3 in_place(const Point3& p, const attributes::OverrideModel& order) {
  const double angle = order.turn * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const double east = p.x * order.scale, north = -p.z * order.scale;
  return {east * c + north * s, north * c - east * s, p.y * order.scale};
}

class Placer {
 public:
  Placer(const georef::Projection& projection, const attributes::Defaults& defaults)
      : projection_(projection), wall_(material(defaults, "plaster")), roof_(material(defaults, "roof_tiles")) {}

  masses::LandmarkModel place(const ReadLandmark& landmark) const {
    masses::LandmarkModel out;
    out.building = landmark.building;
    out.told = std::make_shared<model::ReplacementModel>(model::ReplacementModel{
        landmark.order.file, landmark.order.source, landmark.order.licence, landmark.order.author, landmark.told_from});
    std::optional<georef::Transform> transform;
    if (landmark.has_place) transform.emplace(landmark.model.crs.horizontal, projection_.crs().authority_code);
    model::Point2 origin{};
    const auto refuse = [&](const std::string& what, const std::string& remedy) {
      throw base::InputError(landmark.order.path, "", what + " (" + landmark.told_from + ")", remedy);
    };
    if (landmark.order.at) {
      origin = model::snap(projection_.forward((*landmark.order.at)[0], (*landmark.order.at)[1]));
      if (!(std::fabs(origin.x) < kFarthest && std::fabs(origin.y) < kFarthest))
        refuse("`at` lies where the build's coordinates do not reach", "Is longitude first?");
    }
    out.at_outline = !landmark.has_place && !landmark.order.at;
    const auto placed = [&](const Point3& p) {
      if (transform) {
        const model::Point2 q = transform->forward({p.x, p.y});
        return Point3{q.x, q.y, p.z * landmark.model.crs.metres_per_unit};
      }
      const Point3 q = in_place(p, landmark.order);
      return Point3{q.x + origin.x, q.y + origin.y, q.z};
    };
    struct Ready {
      std::vector<std::vector<Point3>> rings;
      Shown shown;
    };
    std::vector<Ready> ready;
    double lowest = 1e300;
    for (const Shown& shown : shown_polygons(landmark.model)) {
      const reference::Polygon3& polygon = landmark.model.polygons[shown.polygon];
      Ready& r = ready.emplace_back();
      r.shown = shown;
      const auto add = [&](const std::vector<Point3>& ring) {
        auto& points = r.rings.emplace_back();
        for (const Point3& p : ring) points.push_back(placed(p));
        if (shown.reversed) std::reverse(points.begin(), points.end());
        for (const Point3& p : points) lowest = std::min(lowest, p.z);
      };
      add(polygon.outer);
      for (const auto& hole : polygon.holes) add(hole);
    }
    if (ready.empty())
      refuse("draws no surface that can be read: it may have footprints alone, or shapes from other files",
             "Give it surfaces or solids of LoD1 to LoD4");
    model::Point2 low{1e300, 1e300}, high{-1e300, -1e300};
    double top = -1e300;
    for (const Ready& r : ready)
      for (const auto& ring : r.rings)
        for (const Point3& p : ring) {
          if (!std::isfinite(p.x + p.y + p.z)) refuse("has a corner that is no place in the build", "Mend it");
          low = {std::min(low.x, p.x), std::min(low.y, p.y)}, high = {std::max(high.x, p.x), std::max(high.y, p.y)};
          top = std::max(top, p.z);
        }
    if (std::max({high.x - low.x, high.y - low.y, top - lowest}) > kLargest)
      refuse(fmt::format("is {:.0f} m large", std::max({high.x - low.x, high.y - low.y, top - lowest})),
             "Is `scale` right? It leads from the model's units to metres");
    if (!landmark.has_place && std::max({std::fabs(low.x - origin.x), std::fabs(high.x - origin.x),
                                         std::fabs(low.y - origin.y), std::fabs(high.y - origin.y)}) > 2 * kLargest)
      refuse("lies kilometres off its own origin", "Move it there");
    geometry::SolidBuilder builder;
    const double floor = model::snap(landmark.order.lift);
    for (Ready& r : ready) {
      for (auto& ring : r.rings)
        for (Point3& p : ring) p = model::snap(Point3{p.x, p.y, p.z - lowest + landmark.order.lift});
      add_face(builder, r.rings, r.shown, landmark.model.polygons[r.shown.polygon].colour, floor, out);
    }
    out.surfaces = builder.take();
    if (out.surfaces.faces.empty())
      refuse("has no face of a millimetre or more",
             landmark.has_place ? "Mend its faces" : "Is `scale` right? It leads from the model's units to metres");
    auto triangles = geometry::triangulate(out.surfaces);
    out.surfaces.closed = triangles && geometry::check_solid(out.surfaces, *triangles, geometry::kBuilt).valid();
    if (triangles) out.triangles = std::move(*triangles);
    return out;
  }

 private:
  static std::uint8_t material(const attributes::Defaults& defaults, const char* name) {
    return static_cast<std::uint8_t>(std::max(defaults.material(name), 0));
  }

  /// A face whole where it is a simple, plane polygon, else its triangles; rings that cross show nothing, and are counted.
  void add_face(geometry::SolidBuilder& builder, const std::vector<std::vector<Point3>>& rings, const Shown& shown,
                const std::optional<model::Colour>& colour, double floor, masses::LandmarkModel& out) const {
    std::vector<std::vector<Point3>> clean;
    std::vector<geometry::Grid3> grid;
    std::vector<std::vector<std::uint32_t>> loops;
    for (const auto& ring : rings) {
      std::vector<Point3> points;
      for (const Point3& p : ring)
        if (points.empty() || !(points.back() == p)) points.push_back(p);
      while (points.size() > 1 && points.front() == points.back()) points.pop_back();
      if (points.size() < 3) {
        if (clean.empty()) return;
        continue;
      }
      auto& loop = loops.emplace_back();
      for (const Point3& p : points) {
        loop.push_back(static_cast<std::uint32_t>(grid.size()));
        grid.push_back(geometry::to_grid(p));
      }
      clean.push_back(std::move(points));
    }
    if (clean.empty()) return;
    const Point3 normal = normal_of(clean[0]);
    const double length = model::length(normal);
    const auto triangles = geometry::triangulate(grid, loops);
    if (length < kSmallest || !triangles) {
      out.left_out += length >= kSmallest;
      return;
    }
    model::Face face;
    const double up = normal.z / length;
    const bool on_floor = std::all_of(clean[0].begin(), clean[0].end(), [&](const Point3& p) { return p.z == floor; });
    face.kind = kind_of(shown.surface_class, up, on_floor);
    face.material = face.kind == model::SurfaceKind::roof ? roof_ : wall_;
    if (colour) face.colour = *colour;
    const bool plane = std::ranges::all_of(clean, [&](const auto& ring) {
      return std::ranges::all_of(
          ring, [&](const Point3& p) { return std::fabs(model::dot(normal, p - clean[0][0])) <= kPlane * length; });
    });
    if (plane) {
      builder.add_face(clean, face);
      out.coloured.push_back(colour.has_value());
      return;
    }
    std::vector<Point3> all;
    for (const auto& ring : clean) all.insert(all.end(), ring.begin(), ring.end());
    for (const geometry::Triangle& t : *triangles) {
      builder.add_face({all[t[0]], all[t[1]], all[t[2]]}, face);
      out.coloured.push_back(colour.has_value());
    }
  }

  static model::SurfaceKind kind_of(std::optional<reference::SurfaceClass> of, double up, bool on_floor) {
    using reference::SurfaceClass;
    if (of == SurfaceClass::wall) return model::SurfaceKind::wall;
    if (of == SurfaceClass::roof) return model::SurfaceKind::roof;
    if (of == SurfaceClass::outer_floor) return model::SurfaceKind::outer_floor;
    if (up > kUpright) return model::SurfaceKind::roof;
    if (up >= -kUpright) return model::SurfaceKind::wall;
    return on_floor ? model::SurfaceKind::ground : model::SurfaceKind::outer_ceiling;
  }

  const georef::Projection& projection_;
  std::uint8_t wall_, roof_;
};

}  // namespace

std::vector<ReadLandmark> read_landmarks(const attributes::Overrides& overrides) {
  std::vector<ReadLandmark> out;
  for (const attributes::OverrideEntry& entry : overrides.entries) {
    if (!entry.model) continue;
    ReadLandmark landmark;
    landmark.building = entry.object;
    landmark.order = *entry.model;
    landmark.told_from = fmt::format("{}:{}", overrides.name, entry.model->line);
    landmark.has_place = !is_gltf(entry.model->path);
    landmark.model =
        landmark.has_place ? reference::read_model(entry.model->path) : reference::read_gltf_axes(entry.model->path);
    const attributes::OverrideModel& order = landmark.order;
    if (landmark.has_place && (order.at || order.turn != 0 || order.scale != 1))
      throw base::InputError(overrides.file, std::to_string(order.line),
                             order.file + " has a place of its own: at, turn and scale are for glTF", "Leave them out");
    if (landmark.has_place && landmark.model.crs.horizontal.empty())
      throw base::InputError(order.path, "", "does not say in which CRS its coordinates are", "Give it one");
    if (landmark.has_place && landmark.model.crs.geographic)
      throw base::InputError(order.path, "", "has coordinates in degrees; a model needs metres in all directions",
                             "Convert it to a projected CRS");
    if (landmark.model.polygons.size() > kMostFaces)
      throw base::InputError(order.path, "",
                             fmt::format("has {} faces; {} are the most", landmark.model.polygons.size(), kMostFaces),
                             "Simplify it (for example with gltfpack -si)");
    out.push_back(std::move(landmark));
  }
  return out;
}

masses::LandmarkModels place_landmarks(std::span<const ReadLandmark> landmarks, const georef::Projection& projection,
                                       const attributes::Defaults& defaults) {
  const Placer placer(projection, defaults);
  masses::LandmarkModels out;
  for (const ReadLandmark& landmark : landmarks) out.push_back(placer.place(landmark));
  return out;  // entries are in the order of their objects
}

}  // namespace blockrand::run
