#include "tests/unit/compare/boxes.h"

#include <cmath>
#include <utility>

#include "pipeline/compare/area_vector.h"
#include "pipeline/compare/read_city.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::compare::test {

namespace {

Face face_of(Hull hull, std::vector<Point3> ring) {
  Face f;
  f.hull = hull;
  const Point3 n = area_vector(ring);
  const double l = length(n);
  f.normal = {n.x / l, n.y / l, n.z / l};
  f.area = l / 2;
  f.rings = {std::move(ring)};
  return f;
}

}  // namespace

std::vector<Point2> Block::corners() const {
  std::vector<Point2> out;
  for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    const double px = x * width / 2, py = y * depth / 2;
    out.push_back({centre.x + px * std::cos(turned) - py * std::sin(turned),
                   centre.y + px * std::sin(turned) + py * std::cos(turned)});
  }
  return out;
}

Building prism(const std::string& id, const std::vector<Point2>& plan, double ground, double height) {
  Building b;
  b.id = id;
  b.lod = 2;
  b.ground = ground;
  model::Polygon polygon;
  polygon.outer.points = plan;
  polygon.outer.nodes.assign(plan.size(), 0);
  b.footprint_area = geometry::area(polygon);
  b.footprint = {polygon};
  const double top = ground + height;
  std::vector<Point3> floor, roof;
  for (const Point2 p : plan) {
    floor.insert(floor.begin(), {p.x, p.y, ground});
    roof.push_back({p.x, p.y, top});
  }
  b.faces.push_back(face_of(Hull::ground, floor));
  b.faces.push_back(face_of(Hull::roof, roof));
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Point2 p = plan[i], q = plan[(i + 1) % plan.size()];
    b.faces.push_back(face_of(Hull::wall, {{p.x, p.y, ground}, {q.x, q.y, ground}, {q.x, q.y, top}, {p.x, p.y, top}}));
  }
  Shell shell;
  for (const Face& f : b.faces) shell.polygons.push_back(f.rings);
  b.shells = {shell};
  b.triangles = 2 * (plan.size() - 2) + 2 * plan.size();
  return b;
}

Building building_of(const Block& block) { return prism(block.id, block.corners(), block.ground, block.height); }

City city_of_blocks(std::vector<Building> buildings, bool absolute_heights) {
  City city;
  city.name = "blocks";
  city.crs = "EPSG:25833";
  city.files.push_back({.path = "blocks", .format = "test", .crs = "EPSG:25833", .bytes = 0, .notes = {}});
  city.height_reference = absolute_heights ? "EPSG:5783" : "unknown";
  city.absolute_heights = absolute_heights;
  city.buildings = std::move(buildings);
  sort_buildings(city);
  return city;
}

Building tessellated(Building b, int n) {
  std::vector<Face> pieces;
  for (const Face& f : b.faces) {
    const auto& r = f.rings[0];
    const auto at = [&](int i, int k) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(k) / n;
      const auto mix = [&](double a, double bb, double c, double d) {
        return (1 - u) * (1 - v) * a + u * (1 - v) * bb + u * v * c + (1 - u) * v * d;
      };
      return Point3{mix(r[0].x, r[1].x, r[2].x, r[3].x), mix(r[0].y, r[1].y, r[2].y, r[3].y),
                    mix(r[0].z, r[1].z, r[2].z, r[3].z)};
    };
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        pieces.push_back(face_of(f.hull, {at(i, k), at(i + 1, k), at(i + 1, k + 1)}));
        pieces.push_back(face_of(f.hull, {at(i, k), at(i + 1, k + 1), at(i, k + 1)}));
      }
  }
  b.faces = std::move(pieces);
  b.shells[0].polygons.clear();
  for (const Face& f : b.faces) b.shells[0].polygons.push_back(f.rings);
  return b;
}

}  // namespace blockrand::compare::test
