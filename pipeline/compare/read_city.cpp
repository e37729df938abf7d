#include "pipeline/compare/read_city.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_set>
#include <utility>

#include "importers/reference/affine_transform.h"
#include "importers/reference/footprints.h"
#include "importers/reference/read_model.h"
#include "pipeline/base/attribution.h"
#include "pipeline/base/error.h"
#include "pipeline/base/parallel.h"
#include "pipeline/compare/area_vector.h"
#include "pipeline/compare/face_triangles.h"
#include "pipeline/geometry/nearest_surface.h"
#include "pipeline/geometry/plan_shape.h"
#include "pipeline/georef/crs.h"

namespace blockrand::compare {

namespace {

namespace reference = importers::reference;
using geometry::PlanBox;
using reference::GeometryKind;
using reference::ReferenceModel;
using reference::SurfaceClass;

// Faces without a class: from the sine of this angle (10 degrees) on, a face's normal looks up or down, less is a wall.
constexpr double kUpright = 0.1736;
constexpr double kGroundBand = 0.5;  // m above the lowest point: a face that looks down there is ground
constexpr double kRepetition = 0.5;  // share of both footprints that a repetition has in common with the first

std::optional<Hull> hull_of(SurfaceClass c) {
  switch (c) {
    case SurfaceClass::ground:
      return Hull::ground;
    case SurfaceClass::wall:
      return Hull::wall;
    case SurfaceClass::roof:
      return Hull::roof;
    case SurfaceClass::closure:
      return Hull::closure;
    case SurfaceClass::outer_ceiling:
      return Hull::outer_ceiling;
    case SurfaceClass::outer_floor:
      return Hull::outer_floor;
    case SurfaceClass::installation:
      return Hull::installation;
    case SurfaceClass::floor:
    case SurfaceClass::ceiling:
    case SurfaceClass::interior_wall:
    case SurfaceClass::room:
    case SurfaceClass::furniture:
      return std::nullopt;
  }
  return std::nullopt;
}

bool is_body(const reference::Geometry& g) {
  return (g.kind == GeometryKind::solid || g.kind == GeometryKind::surfaces) && !g.faces.empty();
}

bool is_outside(const reference::Surface& s) { return !s.interior && hull_of(s.surface_class).has_value(); }

/// One building or part of a model on its way into a Building.
class Gatherer {
 public:
  Gatherer(const ReferenceModel& model, Point2 origin, int max_lod)
      : model_(model), origin_(origin), max_lod_(max_lod) {}

  /// What a building takes from polygons that several of its parts use.
  struct Used {
    std::unordered_set<std::uint32_t> faces, shells;  // looked up only
  };

  /// \param finest  the highest level of detail of the building and its parts: a building's own body of a lower level
  ///               says in general what its parts say in particular, and is left out
  void add(const reference::Building& part, int finest, Used& all_used, Building& out) const {
    const int lod = lod_of(part);
    if (part.storeys_above_ground) out.storeys = std::max(out.storeys.value_or(0), *part.storeys_above_ground);
    if (out.roof_type.empty()) out.roof_type = part.roof_type;
    if (lod < 0 || (part.parent < 0 && lod < finest)) return;
    out.lod = std::max(out.lod, lod);
    std::unordered_set<std::uint32_t>& used = all_used.faces;
    const std::size_t first_face = out.faces.size(), first_shell = out.shells.size();
    std::vector<Triangle3> thematic;
    for (const reference::Surface& s : part.surfaces) {
      if (!is_outside(s)) continue;
      Hull hull = *hull_of(s.surface_class);
      int level = lod;
      if (is_installation(s)) {
        hull = Hull::installation;
        level = best_of(s.geometries, lod);
      }
      Point3 towards;  // sum of the surface's normals, by area: what its openings are seen along
      for (const reference::Geometry& g : s.geometries)
        if (g.lod == level && is_body(g))
          for (const reference::Face& f : g.faces) {
            if (!is_polygon(f) || !used.insert(f.polygon).second) continue;
            const Face& face = add_face(f, hull, true, out);
            for (const Triangle3& t : triangles_of(face.rings)) thematic.push_back(t);
            towards = {towards.x + face.normal.x * face.area, towards.y + face.normal.y * face.area,
                       towards.z + face.normal.z * face.area};
          }
      for (const reference::Opening& o : s.openings) add_opening(o, level, towards, used, out);
    }
    const geometry::NearestSurface said(thematic);
    for (const reference::Geometry& g : part.geometries) {
      if (g.lod != lod || !is_body(g)) continue;
      if (g.kind == GeometryKind::solid) add_shells(g, all_used.shells, out);
      for (const reference::Face& f : g.faces)
        if (is_polygon(f) && used.insert(f.polygon).second && !lies_on(said, rings_of(f)))
          add_face(f, Hull::wall, false, out);
    }
    if (out.faces.size() == first_face) return;
    ++out.bodies;
    if (out.shells.size() == first_shell) out.all_in_shells = false;
  }

  int lod_of(const reference::Building& part) const {
    int best = -1, lowest_above = 99;
    const auto look = [&](const std::vector<reference::Geometry>& geometries) {
      for (const reference::Geometry& g : geometries) {
        if (!is_body(g)) continue;
        if (g.lod <= max_lod_)
          best = std::max(best, g.lod);
        else
          lowest_above = std::min(lowest_above, g.lod);
      }
    };
    look(part.geometries);
    for (const reference::Surface& s : part.surfaces)
      if (is_outside(s) && !is_installation(s)) look(s.geometries);
    return best >= 0 ? best : lowest_above < 99 ? lowest_above : -1;
  }

 private:
  static bool is_installation(const reference::Surface& s) {
    return s.of_installation || s.surface_class == SurfaceClass::installation;
  }
  bool is_polygon(const reference::Face& f) const { return model_.polygons[f.polygon].outer.size() >= 3; }
  /// The highest level up to `most`; `most` where there is none.
  static int best_of(const std::vector<reference::Geometry>& geometries, int most) {
    int best = -1;
    for (const reference::Geometry& g : geometries)
      if (is_body(g) && g.lod <= most) best = std::max(best, g.lod);
    return best < 0 ? most : best;
  }
  /// Whether a polygon repeats what thematic surfaces say: all of its middle lies on them.
  static bool lies_on(const geometry::NearestSurface& said, const Rings3& rings) {
    constexpr double kSame = 0.01;  // m. Files that say everything twice round both alike.
    if (said.empty()) return false;
    const std::vector<Triangle3> triangles = triangles_of(rings);
    return !triangles.empty() && std::all_of(triangles.begin(), triangles.end(), [&](const Triangle3& t) {
      const Point3 middle{(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3,
                          (t[0].z + t[1].z + t[2].z) / 3};
      return said.nearest(middle).distance <= kSame;
    });
  }

  Rings3 rings_of(const reference::Face& f) const {
    const reference::Polygon3& polygon = model_.polygons[f.polygon];
    Rings3 rings;
    const auto add = [&](const std::vector<Point3>& ring) {
      auto& out = rings.emplace_back();
      out.reserve(ring.size());
      for (const Point3& p : ring) out.push_back({p.x - origin_.x, p.y - origin_.y, p.z});
      if (f.reversed) std::reverse(out.begin(), out.end());
    };
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
    return rings;
  }

  static std::size_t triangles_in(const Rings3& rings) {
    std::size_t n = 0;
    for (const auto& ring : rings) n += ring.size() + 2;
    return n > 4 ? n - 4 : 0;
  }

  const Face& add_face(const reference::Face& f, Hull hull, bool stated, Building& out) const {
    Face& face = out.faces.emplace_back();
    face.hull = hull;
    face.stated = stated;
    face.rings = rings_of(f);
    const Point3 n = area_vector(face.rings[0]);
    const double twice = length(n);
    if (twice > 0) face.normal = {n.x / twice, n.y / twice, n.z / twice};
    face.area = twice / 2;
    for (std::size_t i = 1; i < face.rings.size(); ++i) face.area -= length(area_vector(face.rings[i])) / 2;
    face.area = std::max(0.0, face.area);
    out.triangles += triangles_in(face.rings);
    return face;
  }

  void add_opening(const reference::Opening& o, int lod, Point3 towards, std::unordered_set<std::uint32_t>& used,
                   Building& out) const {
    Opening opening;
    opening.door = o.door;
    opening.id = o.id;
    double largest = 0, outwards = 0, either = 0;
    for (const reference::Geometry& g : o.geometries) {
      if (g.lod != lod) continue;
      for (const reference::Face& f : g.faces) {
        if (!is_polygon(f)) continue;
        used.insert(f.polygon);
        Rings3 rings = rings_of(f);
        const Point3 n = area_vector(rings[0]);
        const double twice = length(n);
        if (twice > largest) {
          largest = twice;
          opening.normal = {n.x / twice, n.y / twice, n.z / twice};
        }
        const double along = length(towards) > 0 ? dot(n, towards) / length(towards) : twice;
        outwards += std::max(0.0, along) / 2;
        either += std::fabs(along) / 2;
        out.triangles += triangles_in(rings);
        opening.polygons.push_back(std::move(rings));
      }
    }
    if (opening.polygons.empty() || largest <= 0) return;
    opening.area = outwards > 0 ? outwards : either;
    out.openings.push_back(std::move(opening));
  }

  /// A solid that other parts' solids make up (a building's composite of its parts') counts once.
  void add_shells(const reference::Geometry& g, std::unordered_set<std::uint32_t>& used, Building& out) const {
    bool fresh = false;
    for (const reference::Face& f : g.faces) fresh = used.insert(f.polygon).second || fresh;
    if (!fresh) return;
    const auto shell = [&](std::size_t begin, std::size_t end, bool outer) {
      if (begin == end) return;
      Shell& s = out.shells.emplace_back();
      s.outer = outer;
      for (std::size_t i = begin; i < end; ++i)
        if (is_polygon(g.faces[i])) s.polygons.push_back(rings_of(g.faces[i]));
    };
    shell(0, g.outer_faces, true);
    shell(g.outer_faces, g.faces.size(), false);
  }

  const ReferenceModel& model_;
  Point2 origin_;
  int max_lod_;
};

/// Classes of faces whose file states none.
void classify(Building& b) {
  // A closed body of faces without classes that looks inwards is turned: else its roof would look down.
  double volume = 0;
  bool none_stated = true;
  for (const Face& f : b.faces) {
    none_stated = none_stated && !f.stated;
    const Point3 base = b.faces[0].rings[0][0];
    for (const auto& ring : f.rings)
      for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        volume += dot(ring[0] - base, cross(ring[i] - base, ring[i + 1] - base)) / 6;
  }
  const bool inwards = none_stated && volume < 0;
  double lowest = 1e300;
  for (const Face& f : b.faces)
    for (const Point3& p : f.rings[0]) lowest = std::min(lowest, p.z);
  for (Face& f : b.faces) {
    if (f.stated) continue;
    if (std::fabs(f.normal.z) < kUpright) {
      f.hull = Hull::wall;
      continue;
    }
    double highest = -1e300;
    for (const Point3& p : f.rings[0]) highest = std::max(highest, p.z);
    // What lies flat at the very bottom is ground whichever side its ring looks to.
    const bool bottom = highest < lowest + kGroundBand;
    f.hull = bottom ? Hull::ground : (f.normal.z > 0) != inwards ? Hull::roof : Hull::outer_ceiling;
  }
}

geometry::PlanShape shape_of(const Building& b) { return geometry::PlanShape(b.footprint); }

/// Leaves out what stands where a building of an earlier file stands, or twice in one file. Requires buildings in the
/// order of files.
void drop_repetitions(City& city) {
  constexpr double kSame = 0.99, kSameGround = 0.1;  // share, m
  std::vector<PlanBox> boxes;
  for (const Building& b : city.buildings) boxes.push_back(plan_box(b));
  const geometry::BoxIndex index(boxes);
  std::vector<bool> gone(city.buildings.size(), false);
  for (std::uint32_t i = 0; i < city.buildings.size(); ++i) {
    const Building& b = city.buildings[i];
    if (b.footprint.empty()) continue;
    for (const std::uint32_t k : index.near(boxes[i], 0)) {
      const Building& first = city.buildings[k];
      if (k >= i || gone[k] || first.footprint.empty()) continue;
      const double share = shape_of(b).common_area(shape_of(first)) / std::max(b.footprint_area, first.footprint_area);
      // Within a file what stands over another (a hall over its garage) is another building, unless nothing differs.
      const bool same = first.file != b.file ? share > kRepetition
                                             : share > kSame && b.faces.size() == first.faces.size() &&
                                                   std::fabs(b.ground - first.ground) < kSameGround;
      if (!same) continue;
      gone[i] = true;
      break;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (gone[i]) {
      ++city.repetitions;
      continue;
    }
    if (kept != i) city.buildings[kept] = std::move(city.buildings[i]);
    ++kept;
  }
  city.buildings.resize(kept);
}

std::string heights_in_words(const reference::ReferenceCrs& crs) {
  if (crs.height_reference == reference::HeightReference::vertical_crs) return crs.vertical;
  if (!crs.height_words.empty()) return crs.height_words;
  return std::string(name_of(crs.height_reference));
}

bool is_absolute(const reference::ReferenceCrs& crs) {
  return crs.height_reference == reference::HeightReference::vertical_crs ||
         // Some sea level that words name is the same where the words are.
         (crs.height_reference == reference::HeightReference::sea_level && !crs.height_words.empty()) ||
         crs.height_reference == reference::HeightReference::ellipsoidal;
}

CityFile facts_of(const ReferenceModel& model, std::string stated_crs) {
  CityFile file;
  file.path = model.path;
  file.format = model.format;
  file.crs = std::move(stated_crs);
  file.bytes = model.bytes;
  file.breaches = model.breaches();
  file.notes = model.notes;
  for (const auto& b : model.buildings) file.buildings += b.parent < 0;
  return file;
}

std::string wanted_crs(const ReferenceModel& model) {
  if (!model.crs.geographic && model.crs.metres_per_unit == 1.0) return model.crs.horizontal;
  const auto extent = extent_of(model);
  if (!extent)
    throw base::InputError(model.path, "", "has no place that PROJ knows (" + model.crs.name + ")",
                           "Name a projected coordinate reference system with --crs");
  return georef::choose_crs((extent->west + extent->east) / 2, (extent->south + extent->north) / 2);
}

Point2 full_kilometre(const ReferenceModel& model) {
  PlanBox box;
  for (const auto& polygon : model.polygons)
    for (const Point3& p : polygon.outer) box.include(p.xy());
  if (box.empty()) return {};
  return {std::round(box.centre().x / 1000) * 1000, std::round(box.centre().y / 1000) * 1000};
}

/// Adds a file's city. \param heights  what the files with buildings say of their heights, so far
void append(City& city, City&& more, const std::optional<PlanBox>& reach, std::set<std::string>& heights) {
  const auto file = static_cast<std::uint32_t>(city.files.size());
  if (!more.buildings.empty()) {
    heights.insert(more.height_reference);
    city.height_reference.clear();
    for (const std::string& h : heights) city.height_reference += (city.height_reference.empty() ? "" : ", ") + h;
    city.absolute_heights = more.absolute_heights && heights.size() == 1;
  }
  city.files.push_back(std::move(more.files[0]));
  city.without_geometry += more.without_geometry;
  for (Building& b : more.buildings) {
    b.file = file;
    if (reach && !plan_box(b).near(*reach, 0)) {
      ++city.out_of_reach;
      continue;
    }
    city.buildings.push_back(std::move(b));
  }
}

/// Whose data a file shows: the build of ours that it lies in says so. Builds are looked at once.
std::string attribution_of(const std::string& file, std::map<std::string, std::string>& of_builds) {
  namespace fs = std::filesystem;
  constexpr int kDeepest = 6;  // tiles/15/17600/12900.glb
  std::error_code error;
  fs::path folder = fs::absolute(file, error).parent_path();
  for (int i = 0; i < kDeepest && !folder.empty(); ++i, folder = folder.parent_path()) {
    const auto [found, is_new] = of_builds.try_emplace(folder.string());
    if (is_new && fs::is_regular_file(folder / "build.json", error)) {
      std::ifstream in(folder / "build.json", std::ios::binary);
      const auto record = nlohmann::json::parse(in, nullptr, false);
      if (record.is_object() && record.contains("program") && record["program"].is_object() &&
          record["program"].value("name", "") == "blockrand")
        found->second = record.contains("attribution") && record["attribution"].is_string()
                            ? record["attribution"].get<std::string>()
                            : base::kAttribution;
    }
    if (!found->second.empty()) return found->second;
  }
  return {};
}

}  // namespace

geometry::PlanBox plan_box(const Building& b) {
  PlanBox box;
  for (const model::Polygon& p : b.footprint) box.include(geometry::box_of(p.outer.points));
  if (box.empty())
    for (const Face& f : b.faces)
      for (const Point3& p : f.rings[0]) box.include(p.xy());
  return box;
}

City city_of(const ReferenceModel& model, Point2 origin, int max_lod) {
  City city;
  city.name = model.path;
  city.crs = model.crs.horizontal;
  city.origin = origin;
  city.height_reference = heights_in_words(model.crs);
  city.absolute_heights = is_absolute(model.crs);
  city.files.push_back(facts_of(model, model.crs.stated));
  const Gatherer gatherer(model, origin, max_lod);
  std::vector<std::size_t> owner(model.buildings.size());
  std::vector<int> finest;
  std::vector<Gatherer::Used> used;
  for (std::size_t i = 0; i < model.buildings.size(); ++i) {
    const reference::Building& b = model.buildings[i];
    if (b.parent < 0) {
      owner[i] = city.buildings.size();
      city.buildings.emplace_back().id = b.id;
      finest.push_back(-1);
      used.emplace_back();
    } else {
      owner[i] = owner[static_cast<std::size_t>(b.parent)];
    }
    finest[owner[i]] = std::max(finest[owner[i]], gatherer.lod_of(b));
  }
  // Parts first: what a building says in general repeats them.
  for (const bool parts : {true, false})
    for (std::size_t i = 0; i < model.buildings.size(); ++i) {
      const reference::Building& b = model.buildings[i];
      if ((b.parent >= 0) == parts) gatherer.add(b, finest[owner[i]], used[owner[i]], city.buildings[owner[i]]);
    }
  const auto footprints = reference::ground_footprints(model);
  for (std::size_t i = 0; i < footprints.size(); ++i) {
    Building& b = city.buildings[i];
    b.footprint = footprints[i].polygons;
    b.footprint_area = footprints[i].area;
    for (model::Polygon& polygon : b.footprint) {
      const auto move = [&](model::Ring& ring) {
        for (Point2& p : ring.points) p = {p.x - origin.x, p.y - origin.y};
      };
      move(polygon.outer);
      for (model::Ring& hole : polygon.holes) move(hole);
    }
    b.ground = footprints[i].ground_height;
    classify(b);
  }
  city.without_geometry =
      std::erase_if(city.buildings, [](const Building& b) { return b.footprint.empty() && b.faces.empty(); });
  return city;
}

void sort_buildings(City& city) {
  const auto place = [](const Building& b) {
    const PlanBox box = plan_box(b);
    return std::pair(box.minimum, b.ground);
  };
  std::stable_sort(city.buildings.begin(), city.buildings.end(), [&](const Building& a, const Building& b) {
    return a.id != b.id ? a.id < b.id : place(a) < place(b);
  });
}

City read_city(const std::vector<std::string>& paths, const ReadCityOptions& options) {
  City city;
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    city.name += (city.name.empty() ? "" : ", ") + path;
    for (std::string& file : reference::model_files(path)) files.push_back(std::move(file));
  }
  // In the order of their names, each once: neither how a shell lists files nor repeated ones matter.
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  std::map<std::string, std::string> of_builds;
  std::set<std::string> attributions;
  for (const std::string& file : files) attributions.insert(attribution_of(file, of_builds));
  attributions.erase("");
  for (const std::string& a : attributions) city.attribution += (city.attribution.empty() ? "" : "; ") + a;
  std::set<std::string> heights;
  // Both are settled by the first file with buildings, before any after it is read.
  city.crs = options.crs;
  if (options.origin) city.origin = *options.origin;
  const auto load = [&](const std::string& file, bool first) {
    ReferenceModel model = reference::read_model(file, options.read);
    const std::string stated = model.crs.stated.empty() ? model.crs.horizontal : model.crs.stated;
    if (model.buildings.empty() || model.polygons.empty()) {
      City none;
      none.without_geometry = model.buildings.size();
      none.files.push_back(facts_of(model, stated));
      return none;
    }
    if (first && city.crs.empty()) city.crs = wanted_crs(model);
    transform_to(model, city.crs);
    if (first && !options.origin) city.origin = full_kilometre(model);
    City one = city_of(model, city.origin, options.max_lod);
    one.files[0].crs = stated;
    return one;
  };
  std::size_t next = 0;
  for (bool empty = true; empty && next < files.size(); ++next) {
    City one = load(files[next], true);
    empty = one.buildings.empty();
    append(city, std::move(one), options.reach, heights);
  }
  const int workers = base::worker_count(options.jobs);
  std::vector<City> loaded(files.size() - next);
  base::ordered_parallel(
      loaded.size(), workers, static_cast<std::size_t>(workers) + 1,
      [&](std::size_t i) { loaded[i] = load(files[next + i], false); },
      [&](std::size_t i) { append(city, std::exchange(loaded[i], {}), options.reach, heights); });
  drop_repetitions(city);
  sort_buildings(city);
  return city;
}

}  // namespace blockrand::compare
