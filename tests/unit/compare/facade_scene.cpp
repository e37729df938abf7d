#include "tests/unit/compare/facade_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::compare::test {
namespace {

Face face_of(Hull hull, Rings3 rings) {
  Face face;
  face.hull = hull;
  face.rings = std::move(rings);
  return face;
}

/// Coordinates in a wall made coordinates in space.
struct Wall {
  Point2 from, along, inwards;
  double length = 0, ground = 0;

  Wall(Point2 a, Point2 b, double z) : from(a), ground(z) {
    length = std::hypot(b.x - a.x, b.y - a.y);
    along = {(b.x - a.x) / length, (b.y - a.y) / length};
    inwards = {-along.y, along.x};
  }
  Point3 at(double x, double z, double depth = 0) const {
    return {from.x + x * along.x + depth * inwards.x, from.y + x * along.y + depth * inwards.y, ground + z};
  }
  std::vector<Point3> ring(const Hole& r, double depth = 0) const {
    return {at(r.left, r.bottom, depth), at(r.right, r.bottom, depth), at(r.right, r.top, depth),
            at(r.left, r.top, depth)};
  }
};

bool within(const Hole& hole, double x, double z) {
  return hole.left < x && x < hole.right && hole.bottom < z && z < hole.top;
}

void draw_cells(const Wall& wall, double height, const std::vector<Hole>& holes, bool triangles, Building& out) {
  std::set<double> xs{0, wall.length}, zs{0, height};
  for (const Hole& h : holes) {
    xs.insert({h.left, h.right});
    zs.insert({h.bottom, h.top});
  }
  for (auto x = xs.begin(); std::next(x) != xs.end(); ++x) {
    for (auto z = zs.begin(); std::next(z) != zs.end(); ++z) {
      const Hole cell{*x, *std::next(x), *z, *std::next(z)};
      const double mx = 0.5 * (cell.left + cell.right), mz = 0.5 * (cell.bottom + cell.top);
      if (std::any_of(holes.begin(), holes.end(), [&](const Hole& h) { return within(h, mx, mz); })) continue;
      const auto r = wall.ring(cell);
      if (triangles) {
        out.faces.push_back(face_of(Hull::wall, {{r[0], r[1], r[2]}}));
        out.faces.push_back(face_of(Hull::wall, {{r[0], r[2], r[3]}}));
      } else {
        out.faces.push_back(face_of(Hull::wall, {r}));
      }
    }
  }
}

void draw_wall(const Wall& wall, double height, const std::vector<Hole>& holes, Drawn drawn, Building& out) {
  const Hole whole{0, wall.length, 0, height};
  if (drawn == Drawn::cells || drawn == Drawn::triangles) {
    draw_cells(wall, height, holes, drawn == Drawn::triangles, out);
  } else if (drawn == Drawn::strips) {
    double from = 0;
    for (int i = 1; i <= 40; ++i) {
      const double to = i == 40 ? wall.length : wall.length * std::sqrt(i / 40.0);
      out.faces.push_back(face_of(Hull::wall, {wall.ring({from, to, 0, height})}));
      from = to;
    }
  } else {
    Rings3 rings{wall.ring(whole)};
    if (drawn == Drawn::holes) {
      for (const Hole& h : holes) {
        auto ring = wall.ring(h);
        std::reverse(ring.begin(), ring.end());
        rings.push_back(std::move(ring));
      }
    }
    out.faces.push_back(face_of(Hull::wall, std::move(rings)));
  }
}

void draw_opening(const Wall& wall, const Hole& h, const HouseStyle& style, Building& out) {
  const double d = style.set_back;
  const auto front = wall.ring(h), back = wall.ring(h, d);
  if (d > 0) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t n = (i + 1) % 4;
      out.faces.push_back(face_of(Hull::wall, {{front[i], front[n], back[n], back[i]}}));
    }
  }
  Opening opening;
  opening.door = h.door;
  if (style.boxes) {
    const Hole pane{h.left + 0.1, h.right - 0.1, h.bottom + 0.1, h.top - 0.1};
    auto inner = wall.ring(pane, d);
    const auto deep = wall.ring(h, d + 0.05);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t n = (i + 1) % 4;
      opening.polygons.push_back({{back[i], back[n], deep[n], deep[i]}});
    }
    opening.polygons.push_back({wall.ring(pane, d + 0.02)});
    std::reverse(inner.begin(), inner.end());
    opening.polygons.push_back({back, inner});
  } else {
    opening.polygons.push_back({back});
  }
  opening.normal = {-wall.inwards.x, -wall.inwards.y, 0};
  out.openings.push_back(std::move(opening));
}

}  // namespace

Building house(const std::vector<Point2>& plan, double height, const std::vector<std::vector<Hole>>& walls,
               const HouseStyle& style) {
  Building out;
  out.ground = style.ground;
  model::Polygon footprint;
  footprint.outer.points = plan;
  footprint.outer.nodes.assign(plan.size(), 0);
  out.footprint_area = geometry::area(footprint);
  out.footprint.push_back(std::move(footprint));
  std::vector<Point3> floor, roof;
  for (const Point2& p : plan) {
    floor.insert(floor.begin(), {p.x, p.y, style.ground});
    roof.push_back({p.x, p.y, style.ground + height});
  }
  out.faces.push_back(face_of(Hull::ground, {floor}));
  out.faces.push_back(face_of(Hull::roof, {roof}));
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Wall wall(plan[i], plan[(i + 1) % plan.size()], style.ground);
    const std::vector<Hole> holes = i < walls.size() ? walls[i] : std::vector<Hole>{};
    draw_wall(wall, height, holes, style.drawn, out);
    for (const Hole& h : holes) draw_opening(wall, h, style, out);
  }
  return out;
}

std::vector<Point2> rectangle(double left, double bottom, double right, double top) {
  return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

std::vector<Hole> grid(int columns, int rows) {
  std::vector<Hole> out;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) out.push_back({1 + 2.5 * c, 2.2 + 2.5 * c, 1 + 3.0 * r, 2.5 + 3.0 * r});
  return out;
}

City city_of(std::vector<Building> buildings) {
  City city;
  city.buildings = std::move(buildings);
  return city;
}

std::vector<std::uint32_t> all_of(const City& city) {
  std::vector<std::uint32_t> out(city.buildings.size());
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

double ground_of(const City& city) {
  double ground = std::numeric_limits<double>::infinity();
  for (const Building& b : city.buildings) ground = std::min(ground, b.ground);
  return ground;
}

std::vector<Facade> facades(const City& city) { return facades_of(city, all_of(city), ground_of(city)); }

void turn(City& city, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](auto& p) {
    const double x = c * p.x - s * p.y, y = s * p.x + c * p.y;
    p.x = x;
    p.y = y;
  };
  const auto all = [&](Rings3& rings) {
    for (auto& ring : rings)
      for (Point3& p : ring) turned(p);
  };
  for (Building& b : city.buildings) {
    for (model::Polygon& polygon : b.footprint) {
      for (Point2& p : polygon.outer.points) turned(p);
      for (model::Ring& hole : polygon.holes)
        for (Point2& p : hole.points) turned(p);
    }
    for (Face& f : b.faces) {
      all(f.rings);
      turned(f.normal);
    }
    for (Opening& o : b.openings) {
      for (Rings3& rings : o.polygons) all(rings);
      turned(o.normal);
    }
  }
}

void reverse(Building& building) {
  for (Face& f : building.faces)
    for (auto& ring : f.rings) std::reverse(ring.begin(), ring.end());
  for (Opening& o : building.openings)
    for (Rings3& rings : o.polygons)
      for (auto& ring : rings) std::reverse(ring.begin(), ring.end());
}

MeasureValues measured(const City& model, const City& reference) {
  const auto m = all_of(model), r = all_of(reference);
  MeasureValues values;
  measure_facades(compare_facades(model, m, ground_of(model), reference, r, ground_of(reference)), model, m, reference,
                  r, values);
  return values;
}

const MeasureValue& value(const MeasureValues& values, Measure measure) {
  return values[static_cast<std::size_t>(measure)];
}

}  // namespace blockrand::compare::test
