#include "tests/unit/run/roof_survey.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "importers/reference/affine_transform.h"
#include "importers/reference/citygml.h"
#include "importers/reference/footprints.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::run::test {

namespace {

namespace fs = std::filesystem;
namespace reference = importers::reference;
using model::Point3;
using reference::SurfaceClass;
using Rings = std::vector<std::vector<Point3>>;

Rings rings_of(const reference::Polygon3& polygon) {
  Rings rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  return rings;
}

bool is_roof(const reference::Surface& s) {
  return !s.interior && !s.of_installation &&
         (s.surface_class == SurfaceClass::roof || s.surface_class == SurfaceClass::outer_floor);
}

int highest_lod(const std::vector<reference::Geometry>& geometries, int least) {
  for (const auto& g : geometries) least = std::max(least, g.lod);
  return least;
}

void add_roof(const reference::ReferenceModel& model, const reference::Building& b, RoofSurfaces& out) {
  int lod = -1;
  for (const auto& s : b.surfaces)
    if (is_roof(s)) lod = highest_lod(s.geometries, lod);
  const auto add = [&](const std::vector<reference::Geometry>& geometries, int level) {
    for (const auto& g : geometries)
      if (g.lod == level)
        for (const auto& face : g.faces) out.add(rings_of(model.polygons[face.polygon]));
  };
  for (const auto& s : b.surfaces)
    if (is_roof(s)) add(s.geometries, lod);
  // Solids without semantics: the highest planes are the roof.
  if (lod < 0) add(b.geometries, highest_lod(b.geometries, -1));
}

bool same_ground(const SurveyedRoof& a, const SurveyedRoof& b) {
  return a.box.near(b.box, 0) && a.shape.common_area(b.shape) > 0.5 * std::min(a.shape.area(), b.shape.area());
}

geometry::PlanBox box_around(const std::vector<model::Polygon>& polygons) {
  geometry::PlanBox box;
  for (const model::Polygon& p : polygons) box.include(geometry::box_of(p.outer.points));
  return box;
}

}  // namespace

std::vector<SurveyedRoof> read_roof_survey(const fs::path& folder, const std::string& crs) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gml" || entry.path().extension() == ".xml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<SurveyedRoof> out;
  for (const fs::path& file : files) {
    auto model = reference::read_citygml(file.string());
    reference::transform_to(model, crs);
    std::vector<std::size_t> owner(model.buildings.size());
    for (std::size_t i = 0; i < owner.size(); ++i)
      owner[i] = model.buildings[i].parent < 0 ? i : owner[static_cast<std::size_t>(model.buildings[i].parent)];
    for (const auto& footprint : reference::ground_footprints(model)) {
      SurveyedRoof r;
      r.id = model.buildings[footprint.building].id;
      r.plan = footprint.polygons;
      r.ground = footprint.ground_height;
      r.shape = PlanShape(r.plan);
      r.box = box_around(r.plan);
      bool first = true;
      for (std::size_t i = footprint.building; i < owner.size(); ++i) {
        if (owner[i] != footprint.building) continue;
        const auto& part = model.buildings[i];
        add_roof(model, part, r.roof);
        if (part.roof_type.empty()) continue;
        r.roof_type = first || r.roof_type == part.roof_type ? part.roof_type : "several";
        first = false;
      }
      if (r.shape.empty() || r.roof.empty()) continue;
      if (std::any_of(out.begin(), out.end(), [&](const SurveyedRoof& o) { return same_ground(o, r); })) continue;
      out.push_back(std::move(r));
    }
  }
  return out;
}

std::vector<SurveyedRoof> read_cityjson_roofs(const fs::path& file) {
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in);
  const auto& scale = json["transform"]["scale"];
  const auto& translate = json["transform"]["translate"];
  const auto point = [&](const nlohmann::json& index) {
    const auto& v = json["vertices"][index.get<std::size_t>()];
    const auto at = [&](std::size_t k) {
      return v[k].get<double>() * scale[k].get<double>() + translate[k].get<double>();
    };
    return Point3{at(0), at(1), at(2)};
  };
  std::vector<SurveyedRoof> out;
  for (const auto& [id, object] : json["CityObjects"].items()) {
    if (!object.contains("geometry")) continue;
    for (const auto& geometry : object["geometry"]) {
      if (geometry["type"] != "Solid" || !geometry.contains("semantics")) continue;
      SurveyedRoof r;
      r.id = id;
      r.roof_type = object.value("attributes", nlohmann::json::object()).value("roofType", "");
      r.ground = 1e9;
      std::vector<model::Polygon> ground;
      const auto& shell = geometry["boundaries"][0];
      for (std::size_t f = 0; f < shell.size(); ++f) {
        const auto& value = geometry["semantics"]["values"][0][f];
        if (value.is_null()) continue;
        const std::string kind = geometry["semantics"]["surfaces"][value.get<std::size_t>()]["type"];
        if (kind != "RoofSurface" && kind != "GroundSurface") continue;
        Rings rings;
        for (const auto& ring : shell[f]) {
          auto& points = rings.emplace_back();
          for (const auto& index : ring) points.push_back(point(index));
        }
        if (kind == "RoofSurface") {
          r.roof.add(rings);
          continue;
        }
        std::vector<model::Ring> plan;
        for (const auto& ring : rings) {
          auto& to = plan.emplace_back();
          for (const Point3& p : ring) {
            r.ground = std::min(r.ground, p.z);
            to.points.push_back(model::snap(model::Point2{p.x, p.y}));
          }
          to.nodes.assign(to.points.size(), 0);
        }
        std::vector<bool> inner(plan.size(), true);
        inner[0] = false;
        auto valid = geometry::make_valid(plan, inner, 0.01, 0.02);
        std::move(valid.polygons.begin(), valid.polygons.end(), std::back_inserter(ground));
      }
      r.plan = std::move(ground);
      if (r.plan.empty() || r.roof.empty()) continue;
      r.shape = PlanShape(r.plan);
      r.box = box_around(r.plan);
      out.push_back(std::move(r));
    }
  }
  return out;
}

}  // namespace blockrand::run::test
