// Boundaries, semantics and templates of CityJSON.
#include <algorithm>
#include <cmath>
#include <utility>

#include "importers/reference/cityjson_objects.h"
#include "importers/reference/matrix4.h"

namespace blockrand::importers::reference {
namespace {

struct KnownSurface {
  const char* name;
  SurfaceClass surface_class;
  bool interior;
};
constexpr std::array<KnownSurface, 9> kSurfaces{{
    {"GroundSurface", SurfaceClass::ground, false},
    {"WallSurface", SurfaceClass::wall, false},
    {"RoofSurface", SurfaceClass::roof, false},
    {"ClosureSurface", SurfaceClass::closure, false},
    {"OuterCeilingSurface", SurfaceClass::outer_ceiling, false},
    {"OuterFloorSurface", SurfaceClass::outer_floor, false},
    {"FloorSurface", SurfaceClass::floor, true},
    {"CeilingSurface", SurfaceClass::ceiling, true},
    {"InteriorWallSurface", SurfaceClass::interior_wall, true},
}};

/// m; beyond is no CRS on Earth.
constexpr double kLargest = 1e9;

bool is_opening(const Json& semantic) {
  const std::string type = text(member(semantic, "type"));
  return type == "Window" || type == "Door";
}

}  // namespace

std::vector<Geometry>& CityJsonObjects::geometries_of(const Target& target) {
  Building& b = model_.buildings[target.building];
  return target.surface < 0 ? b.geometries : b.surfaces[static_cast<std::size_t>(target.surface)].geometries;
}

/// "lod" of a geometry or of its template, "2.2" as 2.2; nothing where it is none.
std::optional<double> CityJsonObjects::level_of(const Json& geometry) {
  const bool placed = text(member(geometry, "type")) == "GeometryInstance";
  const Json& stated = placed ? element_of(member(templates_, "templates"), member(geometry, "template")) : geometry;
  const auto level = loose_number(member(stated, "lod"));
  return level && *level >= 0 && *level < 5 ? level : std::nullopt;
}

void CityJsonObjects::read_geometries(const Json& object, const Target& target) {
  const Json& geometries = member(object, "geometry");
  if (!geometries.is_null() && !geometries.is_array()) note(NoteKind::malformed_json, "geometry is no array");
  constexpr int kLevels = 5, kUnstated = 2;
  std::array<double, kLevels> finest{};
  for (std::size_t i = 0; i < length(geometries); ++i)
    if (const auto level = level_of(geometries[i])) {
      double& best = finest[static_cast<std::size_t>(*level)];
      best = std::max(best, *level);
    }
  for (std::size_t i = 0; i < length(geometries); ++i) {
    const Json& geometry = geometries[i];
    const auto level = level_of(geometry);
    const int lod = level ? static_cast<int>(*level) : kUnstated;
    const double best = finest[static_cast<std::size_t>(lod)];
    if (level && lod > 0 && *level < best) {  // of LoD0 all are plans that differ in kind
      note(NoteKind::not_read, "a coarser geometry of LoD" + std::to_string(lod));
    } else if (text(member(geometry, "type")) == "GeometryInstance") {
      read_instance(geometry, target);
    } else {
      if (!level) note(NoteKind::bad_value, "a geometry without lod from 0 to 4");
      Points points;
      points.list = &vertices_;
      read_geometry(geometry, points, target, lod);
    }
  }
}

void CityJsonObjects::read_instance(const Json& geometry, const Target& target) {
  constexpr std::size_t kMostFaces = 20'000'000;  // templates multiply; a mistake or an attack beyond
  Building& b = model_.buildings[target.building];
  const Json& drawn = element_of(member(templates_, "templates"), member(geometry, "template"));
  const auto corner = index(element(member(geometry, "boundaries"), 0));
  Points points;
  points.list = &template_points_;
  std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const Json& stated = member(geometry, "transformationMatrix");
  bool good = drawn.is_object() && text(member(drawn, "type")) != "GeometryInstance";
  if (!good) note(NoteKind::bad_index, "no template of that number");
  if (good && (!corner || *corner >= vertices_.size() || !std::isfinite(vertices_[*corner].x))) {
    note(NoteKind::bad_index, "a template is placed at no vertex");
    good = false;
  }
  if (good && !stated.is_null()) {
    for (std::size_t i = 0; i < matrix.size(); ++i) {
      const auto v = number(element(stated, i));
      good = good && v && length(stated) == matrix.size();
      if (v) matrix[i] = *v;
    }
    if (!good) note(NoteKind::bad_value, "a transformationMatrix that is not 16 numbers");
  }
  if (good && instance_faces_ > kMostFaces) {
    note(NoteKind::not_read, "templates multiply without end");
    good = false;
  }
  if (!good) {
    ++b.implicit_geometries;
    return;
  }
  points.matrix = matrix;
  points.mirrored = mirrors(matrix);
  points.origin = vertices_[*corner];
  const std::size_t before = model_.polygons.size();
  const auto level = level_of(geometry);
  if (!level) note(NoteKind::bad_value, "a template without lod from 0 to 4");
  read_geometry(drawn, points, target, level ? static_cast<int>(*level) : 2);
  instance_faces_ += model_.polygons.size() - before;
}

void CityJsonObjects::read_geometry(const Json& geometry, const Points& points, const Target& target, int lod) {
  const std::string type = text(member(geometry, "type"));
  const Json &boundaries = member(geometry, "boundaries"), &semantics = member(geometry, "semantics");
  const Json& values = member(semantics, "values");
  const bool solids = type == "MultiSolid" || type == "CompositeSolid";
  if (!solids && type != "Solid" && type != "MultiSurface" && type != "CompositeSurface") {
    if (type == "MultiPoint" || type == "MultiLineString") {
      note(NoteKind::not_read, "a " + type);
    } else {
      note(NoteKind::malformed_json, "a geometry of no known type: \"" + type + "\"");
    }
    return;
  }
  if (!boundaries.is_array()) {
    note(NoteKind::malformed_json, "a geometry without boundaries");
    return;
  }
  Faces all;
  all.by_class.resize(length(member(semantics, "surfaces")));
  const auto add_solid = [&](const Json& shells, const Json& shell_values) {
    Geometry g;
    g.lod = lod;
    g.kind = GeometryKind::solid;
    for (std::size_t i = 0; i < length(shells); ++i) {
      read_shell(shells[i], element(shell_values, i), points, all);
      if (i == 0) g.outer_faces = all.faces.size();
    }
    g.faces = std::exchange(all.faces, {});
    if (!g.faces.empty()) geometries_of(target).push_back(std::move(g));
  };
  if (solids) {
    for (std::size_t i = 0; i < boundaries.size(); ++i) add_solid(boundaries[i], element(values, i));
  } else if (type == "Solid") {
    add_solid(boundaries, values);
  } else {
    Geometry g;
    g.lod = lod;
    read_shell(boundaries, values, points, all);
    g.faces = std::exchange(all.faces, {});
    if (lod == 0) {
      const Json& surfaces = member(semantics, "surfaces");
      const bool roof = length(surfaces) > 0 && std::all_of(surfaces.begin(), surfaces.end(), [](const Json& s) {
                          return text(member(s, "type")) == "RoofSurface";
                        });
      g.kind = roof ? GeometryKind::roof_edge : GeometryKind::footprint;
    } else if (target.surface < 0) {
      // What has a class stands at its surface.
      std::unordered_set<std::uint32_t> classed;
      for (std::size_t i = 0; i < all.by_class.size(); ++i) {
        const std::string kind = text(member(member(semantics, "surfaces")[i], "type"));
        const bool known =
            is_opening(member(semantics, "surfaces")[i]) ||
            std::any_of(kSurfaces.begin(), kSurfaces.end(), [&](const auto& k) { return kind == k.name; });
        if (known)
          for (const Face& f : all.by_class[i]) classed.insert(f.polygon);
      }
      std::erase_if(g.faces, [&](const Face& f) { return classed.count(f.polygon) > 0; });
    }
    g.outer_faces = g.faces.size();
    if (!g.faces.empty()) geometries_of(target).push_back(std::move(g));
  }
  if (lod > 0) add_surfaces(member(semantics, "surfaces"), all, target, lod);
}

/// The surfaces of a shell, or of a MultiSurface. \param values  the class of each surface, null for none
void CityJsonObjects::read_shell(const Json& shell, const Json& values, const Points& points, Faces& out) {
  if (!shell.is_array()) {
    note(NoteKind::malformed_json, "a shell that is no array");
    return;
  }
  for (std::size_t i = 0; i < shell.size(); ++i) {
    const Json& surface = shell[i];
    if (!surface.is_array() || surface.empty()) {
      note(NoteKind::malformed_json, "a surface that is no array of rings");
      continue;
    }
    auto outer = read_ring(surface[0], points);
    if (!outer) continue;
    Polygon3 polygon;
    polygon.outer = std::move(*outer);
    for (std::size_t r = 1; r < surface.size(); ++r)
      if (auto hole = read_ring(surface[r], points)) polygon.holes.push_back(std::move(*hole));
    const Face face{static_cast<std::uint32_t>(model_.polygons.size()), points.mirrored};
    model_.polygons.push_back(std::move(polygon));
    out.faces.push_back(face);
    const Json& value = element(values, i);
    if (value.is_null()) continue;
    const auto semantic = index(value);
    if (semantic && *semantic < out.by_class.size()) {
      out.by_class[*semantic].push_back(face);
    } else {
      note(NoteKind::bad_index, "a surface has a class that is not listed");
    }
  }
}

std::optional<std::vector<model::Point3>> CityJsonObjects::read_ring(const Json& ring, const Points& points) {
  if (!ring.is_array()) {
    note(NoteKind::malformed_json, "a ring that is no array of vertices");
    return std::nullopt;
  }
  std::vector<model::Point3> out;
  out.reserve(ring.size());
  for (const Json& corner : ring) {
    const auto i = index(corner);
    if (!i || *i >= points.list->size()) {
      note(NoteKind::bad_index, "a ring names no vertex: " + scalar_text(corner).value_or("no number") + " of " +
                                    std::to_string(points.list->size()));
      return std::nullopt;
    }
    model::Point3 p = (*points.list)[*i];
    if (!std::isfinite(p.x)) return std::nullopt;  // noted with the vertices
    if (points.matrix) {
      const auto& m = *points.matrix;
      const auto row = [&](std::size_t r) {
        return m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3];
      };
      p = {row(0) + points.origin.x, row(1) + points.origin.y, row(2) + points.origin.z};
      if (!(std::fabs(p.x) < kLargest && std::fabs(p.y) < kLargest && std::fabs(p.z) < kLargest)) {
        note(NoteKind::bad_coordinates, "a template is placed beyond any CRS");
        return std::nullopt;
      }
    }
    out.push_back(p);
  }
  if (out.size() > 1 && out.front() == out.back()) out.pop_back();
  if (out.size() < 3) {
    note(NoteKind::short_ring, std::to_string(out.size()) + " different points");
    return std::nullopt;
  }
  return out;
}

void CityJsonObjects::add_surfaces(const Json& semantics, Faces& faces, const Target& target, int lod) {
  auto& surfaces = model_.buildings[target.building].surfaces;
  const auto geometry_of = [&](std::size_t i) {
    Geometry g;
    g.lod = lod;
    g.faces = std::move(faces.by_class[i]);
    g.outer_faces = g.faces.size();
    return g;
  };
  const auto begin = [&](SurfaceClass surface_class, bool interior) {
    Surface s;
    s.surface_class = surface_class;
    s.interior = target.interior || interior;
    s.of_installation = target.of_installation;
    surfaces.push_back(std::move(s));
    return surfaces.size() - 1;
  };
  std::vector<std::size_t> made(faces.by_class.size(), kNone);  // surface of a class that is no opening
  std::vector<std::size_t> parent(faces.by_class.size(), kNone);
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (const auto p = index(member(semantics[i], "parent")); p && *p < made.size()) parent[i] = *p;
    const Json& children = member(semantics[i], "children");
    for (std::size_t c = 0; c < length(children); ++c)
      if (const auto child = index(children[c]); child && *child < made.size() && parent[*child] == kNone)
        parent[*child] = i;
  }
  std::vector<bool> holds_opening(made.size(), false);
  for (std::size_t i = 0; i < made.size(); ++i)
    if (parent[i] != kNone && is_opening(semantics[i]) && !faces.by_class[i].empty()) holds_opening[parent[i]] = true;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (is_opening(semantics[i]) || (faces.by_class[i].empty() && !holds_opening[i])) continue;
    const std::string type = text(member(semantics[i], "type"));
    const auto known = std::find_if(kSurfaces.begin(), kSurfaces.end(), [&](const auto& k) { return type == k.name; });
    if (known == kSurfaces.end()) {
      note(NoteKind::unknown_element, "a surface of type \"" + type + "\"");
      continue;
    }
    made[i] = begin(known->surface_class, known->interior);
    if (!faces.by_class[i].empty()) surfaces[made[i]].geometries.push_back(geometry_of(i));
    surfaces[made[i]].id = text(member(semantics[i], "id"));
  }
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (!is_opening(semantics[i]) || faces.by_class[i].empty()) continue;
    const std::size_t owner = parent[i] == kNone ? kNone : made[parent[i]];
    Opening opening;
    opening.door = text(member(semantics[i], "type")) == "Door";
    opening.id = text(member(semantics[i], "id"));
    opening.geometries.push_back(geometry_of(i));
    // An opening without a surface gets a wall, as in CityGML.
    surfaces[owner == kNone ? begin(SurfaceClass::wall, false) : owner].openings.push_back(std::move(opening));
  }
}

}  // namespace blockrand::importers::reference
