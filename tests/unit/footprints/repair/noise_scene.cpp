#include "tests/unit/footprints/repair/noise_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::repair::test {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

constexpr double kPi = 3.14159265358979323846;

Polygon polygon_of(std::vector<Point2> points) {
  Polygon p;
  p.outer.nodes.assign(points.size(), 0);
  p.outer.points = std::move(points);
  geometry::orient(p.outer, true);
  return p;
}

/// Numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double uniform(double a, double b) { return a + (b - a) * (static_cast<double>(engine_()) / 4294967296.0); }
  bool chance(double p) { return uniform(0, 1) < p; }
  int number(int a, int b) { return a + static_cast<int>(uniform(0, 1) * (b - a + 1)); }
  Point2 in_disc(double r) {
    for (;;) {
      const Point2 p{uniform(-r, r), uniform(-r, r)};
      if (p.x * p.x + p.y * p.y <= r * r) return p;
    }
  }

 private:
  std::mt19937 engine_;
};

using Shapes = std::vector<std::vector<Point2>>;

/// m. Depths are multiples of it: walls end on the same line or well apart, since what differs by less is one line to
/// every mapper, and to repair.
constexpr double kDepthStep = 1.2;

/// Houses side by side: front on y = 0.
void add_row(Random& random, Shapes& out) {
  double x = 0, depth = kDepthStep * random.number(7, 11);
  const int houses = random.number(5, 12);
  bool left_free = true;
  for (int i = 0; i < houses; ++i) {
    const double width = random.uniform(5.5, 14);
    double own = depth;
    if (random.chance(0.5)) own += (random.chance(0.5) ? 1 : -1) * kDepthStep * random.number(1, 3);
    own = std::clamp(own, 6 * kDepthStep, 14 * kDepthStep);
    const bool alley = random.chance(0.15), last = i + 1 == houses;
    std::vector<Point2> shape = {{x, 0}, {x + width, 0}};
    if (last && random.chance(0.5)) {
      // An oblique end: the street there is not at a right angle.
      const double slant = random.uniform(0.12, 0.5) * (random.chance(0.5) ? 1 : -1) * own;
      shape.push_back({x + width + std::max(slant, 2 - width), own});
    } else if (width > 9 && random.chance(0.4)) {
      // A wing along the right border.
      const double wing = random.uniform(3.5, 5), length = kDepthStep * random.number(3, 6);
      shape.push_back({x + width, own + length});
      shape.push_back({x + width - wing, own + length});
      shape.push_back({x + width - wing, own});
    } else {
      shape.push_back({x + width, own});
    }
    if (left_free && i > 0 && random.chance(0.3)) {
      shape.push_back({x + 2, own});
      shape.push_back({x, own - 2});  // a chamfer at an alley
    } else {
      shape.push_back({x, own});
    }
    out.push_back(std::move(shape));
    x += width;
    left_free = alley;
    if (alley) x += random.uniform(0.8, 3);
    depth = own;
  }
}

/// A row along a bent street: walls between houses stand on the street's bisectors.
void add_bent_row(Random& random, Shapes& out) {
  const int houses = random.number(6, 11);
  const double depth = random.uniform(9, 13);
  std::vector<Point2> front{{0, 0}}, rear;
  std::vector<double> directions;
  double angle = 0;
  for (int i = 0; i < houses; ++i) {
    const double width = random.uniform(6, 13);
    directions.push_back(angle);
    front.push_back({front.back().x + width * std::cos(angle), front.back().y + width * std::sin(angle)});
    angle += random.uniform(1, 3) * kPi / 180;
  }
  for (int i = 0; i <= houses; ++i) {
    const double before = directions[static_cast<std::size_t>(std::max(0, i - 1))];
    const double after = directions[static_cast<std::size_t>(std::min(i, houses - 1))];
    const double across = (before + after) / 2 + kPi / 2;
    const double length = depth / std::cos((after - before) / 2);
    const Point2 p = front[static_cast<std::size_t>(i)];
    rear.push_back({p.x + length * std::cos(across), p.y + length * std::sin(across)});
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(houses); ++i)
    out.push_back({front[i], front[i + 1], rear[i + 1], rear[i]});
}

/// A closed block: corner houses in an L, houses between, rear buildings on the party walls; one street may be oblique.
void add_block(Random& random, Shapes& out) {
  const double depth = random.uniform(10, 13), width = random.uniform(55, 80), height = random.uniform(45, 70);
  const double shear = random.chance(0.5) ? random.uniform(0.1, 0.35) : 0;  // of the streets left and right
  const double deeper = random.uniform(1.2, 3);
  const std::size_t first = out.size();
  // Corner houses.
  const double leg = depth + random.uniform(4, 8);
  const auto corner = [&](bool right, bool top) {
    std::vector<Point2> l = {{0, 0}, {leg, 0}, {leg, depth}, {depth, depth}, {depth, leg}, {0, leg}};
    if (random.chance(0.5)) {
      const double cut = random.uniform(2, 4);
      l.erase(l.begin());
      l.insert(l.begin(), {0, cut});
      l.insert(l.begin() + 1, {cut, 0});
    }
    for (Point2& p : l) {
      if (right) p.x = width - p.x;
      if (top) p.y = height - p.y;
    }
    out.push_back(std::move(l));
  };
  for (const bool top : {false, true})
    for (const bool right : {false, true}) corner(right, top);
  // Between them, along each street.
  const auto between = [&](double length, auto&& place) {
    double at = leg;
    const double end = length - leg;
    while (at < end) {
      double next = at + random.uniform(7, 14);
      if (next > end - 6) next = end;
      const double own = random.chance(0.4) ? depth + deeper : depth;
      const bool alley = next < end && random.chance(0.1);
      const double to = alley ? next - random.uniform(0.8, 3) : next;
      std::vector<Point2> house = {{at, 0}, {to, 0}, {to, own}, {at, own}};
      for (Point2& p : house) p = place(p);
      out.push_back(std::move(house));
      if (random.chance(0.3)) {
        // A rear building on the house's rear wall.
        std::vector<Point2> rear = {{at, own}, {at + 4, own}, {at + 4, own + 5}, {at, own + 5}};
        for (Point2& p : rear) p = place(p);
        out.push_back(std::move(rear));
      }
      at = next;
    }
  };
  between(width, [&](Point2 p) { return p; });
  between(width, [&](Point2 p) { return Point2{width - p.x, height - p.y}; });
  between(height, [&](Point2 p) { return Point2{p.y, height - p.x}; });
  between(height, [&](Point2 p) { return Point2{width - p.y, p.x}; });
  for (std::size_t i = first; i < out.size(); ++i)
    for (Point2& p : out[i]) p.x += shear * p.y;
}

double distance(Point2 a, Point2 b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }

/// Some walls get the corners that others have on them, as nodes that several ways use.
void add_junctions(Random& random, Shapes& shapes) {
  const Shapes before = shapes;
  for (std::vector<Point2>& shape : shapes) {
    std::vector<Point2> with;
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const Point2 a = shape[i], b = shape[(i + 1) % shape.size()];
      with.push_back(a);
      if (!random.chance(0.3)) continue;
      std::vector<std::pair<double, Point2>> on;
      for (const auto& other : before)
        for (const Point2 p : other)
          if (distance(p, a) > 1 && distance(p, b) > 1 && geometry::distance_to_segment(p, a, b) < 1e-6)
            on.emplace_back(distance(p, a), p);
      std::sort(on.begin(), on.end());
      for (const auto& [d, p] : on)
        if (distance(with.back(), p) > 0.01) with.push_back(p);
    }
    shape = std::move(with);
  }
}

struct Edge {
  Point2 a, b;
  std::size_t building;
};

std::vector<Edge> edges_of(const std::vector<Polygon>& polygons, std::size_t building) {
  std::vector<Edge> out;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      out.push_back({ring.points[i], ring.points[(i + 1) % ring.size()], building});
  };
  for (const Polygon& p : polygons) {
    add(p.outer);
    for (const Ring& hole : p.holes) add(hole);
  }
  return out;
}

/// What two edges that run against each other have in common along `a`, and how far apart they are. Metres.
struct Facing {
  double from = 0, to = 0, gap = 0;
  double length() const { return to - from; }
};
Facing facing(const Edge& a, const Edge& b) {
  const double l = distance(a.a, a.b), x = (a.b.x - a.a.x) / l, y = (a.b.y - a.a.y) / l;
  const double m = distance(b.a, b.b);
  const double cross = (x * (b.b.y - b.a.y) - y * (b.b.x - b.a.x)) / m, dot = x * (b.b.x - b.a.x) + y * (b.b.y - b.a.y);
  if (dot >= 0 || std::fabs(cross) > 0.002) return {};
  const double t0 = (b.b.x - a.a.x) * x + (b.b.y - a.a.y) * y, t1 = (b.a.x - a.a.x) * x + (b.a.y - a.a.y) * y;
  return {std::max(0.0, t0), std::min(l, t1), (b.a.x - a.a.x) * y - (b.a.y - a.a.y) * x};
}

/// Where the vertex with this node is now; when it is gone, the nearest one to `p`.
Point2 place_of(const std::vector<Polygon>& polygons, std::int64_t node, Point2 p) {
  Point2 best = p;
  double least = 1e300;
  for (const Polygon& q : polygons) {
    const auto look = [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const double d = ring.nodes[i] == node ? -1 : distance(ring.points[i], p);
        if (d >= least) continue;
        least = d;
        best = ring.points[i];
      }
    };
    look(q.outer);
    for (const Ring& hole : q.holes) look(hole);
  }
  return best;
}

/// Degrees between the directions to both neighbours, in [0, 180].
double angle_at(Point2 before, Point2 at, Point2 after) {
  const double ux = before.x - at.x, uy = before.y - at.y, vx = after.x - at.x, vy = after.y - at.y;
  return std::fabs(std::atan2(ux * vy - uy * vx, ux * vx + uy * vy)) * 180 / kPi;
}

struct Box {
  double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
};
Box box_of(const std::vector<Polygon>& polygons) {
  Box b;
  for (const Polygon& p : polygons)
    for (const Point2 q : p.outer.points)
      b = {std::min(b.x0, q.x), std::min(b.y0, q.y), std::max(b.x1, q.x), std::max(b.y1, q.y)};
  return b;
}
bool meets(const Box& a, const Box& b, double m) {
  return a.x0 <= b.x1 + m && b.x0 <= a.x1 + m && a.y0 <= b.y1 + m && b.y0 <= a.y1 + m;
}

}  // namespace

Footprints true_houses(std::uint32_t seed, int blocks) {
  Random random(seed);
  Footprints out;
  for (int k = 0; k < blocks; ++k) {
    Shapes shapes;
    switch (k % 3) {
      case 0:
        add_row(random, shapes);
        break;
      case 1:
        add_block(random, shapes);
        break;
      default:
        add_bent_row(random, shapes);
        break;
    }
    add_junctions(random, shapes);
    const double angle = random.uniform(0, 2 * kPi), c = std::cos(angle), s = std::sin(angle);
    const Point2 origin{390000.0 + 300.0 * (k % 10), 5820000.0 + 300.0 * (k / 10)};
    for (const auto& shape : shapes) {
      std::vector<Point2> placed;
      for (const Point2 p : shape)
        placed.push_back(model::snap(Point2{origin.x + c * p.x - s * p.y, origin.y + s * p.x + c * p.y}));
      out.push_back({polygon_of(std::move(placed))});
    }
  }
  return out;
}

Footprints with_noise(const Footprints& truth, double radius, std::uint32_t seed) {
  Random random(seed);
  Footprints out;
  std::int64_t node = 0;
  for (const std::vector<Polygon>& building : truth) {
    std::vector<Polygon> polygons;
    for (const Polygon& p : building) {
      // A vertex of a short edge can pass its neighbour: no mapper draws that.
      for (int attempt = 0;; ++attempt) {
        const double r = attempt < 20 ? radius : radius * 0.9 / (attempt - 18);
        Polygon moved = p;
        const auto move = [&](Ring& ring) {
          for (Point2& q : ring.points) {
            const Point2 d = r > 0 ? random.in_disc(r) : Point2{0, 0};
            q = model::snap(Point2{q.x + d.x, q.y + d.y});
          }
        };
        move(moved.outer);
        for (Ring& hole : moved.holes) move(hole);
        if (!geometry::strictly_simple(moved) && attempt < 60) continue;
        polygons.push_back(geometry::strictly_simple(moved) ? std::move(moved) : p);
        break;
      }
      for (std::int64_t& n : polygons.back().outer.nodes) n = ++node;
      for (Ring& hole : polygons.back().holes)
        for (std::int64_t& n : hole.nodes) n = ++node;
    }
    out.push_back(std::move(polygons));
  }
  return out;
}

TerraceRow row_of(const Footprints& footprints) {
  TerraceRow row;
  for (std::size_t i = 0; i < footprints.size(); ++i) {
    TerraceBuilding b;
    b.id = {model::OsmType::way, static_cast<std::int64_t>(i + 1)};
    b.polygons = footprints[i];
    row.buildings.push_back(std::move(b));
  }
  return row;
}

std::vector<std::vector<std::size_t>> rows_of(const Footprints& footprints, double reach) {
  std::vector<Box> boxes;
  for (const auto& f : footprints) boxes.push_back(box_of(f));
  std::vector<std::size_t> leader(footprints.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (leader[i] != i) i = leader[i];
    return i;
  };
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (meets(boxes[i], boxes[j], reach)) leader[std::max(find(i), find(j))] = std::min(find(i), find(j));
  std::map<std::size_t, std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < boxes.size(); ++i) rows[find(i)].push_back(i);
  std::vector<std::vector<std::size_t>> out;
  for (auto& [lead, members] : rows) out.push_back(std::move(members));
  return out;
}

std::string Score::text() const {
  const auto share = [](int part, int all) { return all > 0 ? 100.0 * part / all : 0.0; };
  char line[400];
  std::snprintf(
      line, sizeof line,
      "walls %d, recovered %.2f %%; alleys %d, closed %d, touching %d; right angles %d, restored %.2f %%; obliques "
      "%d, squared %.2f %%; vertex error %.3f -> %.3f m; largest shift %.3f m; overlap %.3f m2; invalid %d",
      walls, share(walls_recovered, walls), alleys, alleys_closed, alleys_touching, right, share(right_restored, right),
      oblique, share(oblique_squared, oblique), error_before, error_after, largest_shift, overlap, invalid);
  return line;
}

Score score(const Footprints& truth, const Footprints& noisy, const TerraceRow& repaired) {
  Score s;
  std::vector<Box> boxes;
  for (const auto& f : truth) boxes.push_back(box_of(f));
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (std::size_t j = i + 1; j < truth.size(); ++j) {
      if (!meets(boxes[i], boxes[j], 3)) continue;
      const auto &after_i = repaired.buildings[i].polygons, &after_j = repaired.buildings[j].polygons;
      std::vector<Edge> common;
      std::set<Point2> points;
      for (const Edge& e : edges_of(after_j, j)) points.insert(e.a);
      bool touching = false;
      for (const Edge& e : edges_of(after_i, i)) {
        touching = touching || points.contains(e.a);
        for (const Edge& f : edges_of(after_j, j))
          if (e.a == f.b && e.b == f.a) common.push_back(e);
      }
      s.overlap += geometry::common_area(after_i, after_j);
      // Walls: pieces between vertices count as one where they go on straight.
      struct Wall {
        Point2 a, b;
      };
      std::vector<Wall> walls;
      bool faces = false;
      for (const Edge& e : edges_of(truth[i], i))
        for (const Edge& f : edges_of(truth[j], j)) {
          const Facing g = facing(e, f);
          if (g.length() <= 0.05) continue;
          const double l = distance(e.a, e.b), x = (e.b.x - e.a.x) / l, y = (e.b.y - e.a.y) / l;
          if (std::fabs(g.gap) < 0.05)
            walls.push_back({{e.a.x + g.from * x, e.a.y + g.from * y}, {e.a.x + g.to * x, e.a.y + g.to * y}});
          else if (g.gap >= 0.79 && g.gap <= 3 && g.length() >= 1)
            faces = true;
        }
      for (bool joined = true; joined;) {
        joined = false;
        for (std::size_t p = 0; p < walls.size() && !joined; ++p)
          for (std::size_t q = 0; q < walls.size() && !joined; ++q)
            if (p != q && distance(walls[p].b, walls[q].a) < 0.05 &&
                angle_at(walls[p].a, walls[p].b, walls[q].b) > 179) {
              walls[p].b = walls[q].b;
              walls.erase(walls.begin() + static_cast<std::ptrdiff_t>(q));
              joined = true;
            }
      }
      std::erase_if(walls, [](const Wall& w) { return distance(w.a, w.b) < 1; });
      if (faces && walls.empty()) {
        ++s.alleys;
        if (!common.empty()) ++s.alleys_closed;
        if (touching) ++s.alleys_touching;
      }
      for (const Wall& w : walls) {
        const double l = distance(w.a, w.b), x = (w.b.x - w.a.x) / l, y = (w.b.y - w.a.y) / l;
        double covered = 0;
        for (const Edge& e : common) {
          const double t0 = (e.a.x - w.a.x) * x + (e.a.y - w.a.y) * y, t1 = (e.b.x - w.a.x) * x + (e.b.y - w.a.y) * y;
          const double off = std::fabs((e.a.x - w.a.x) * y - (e.a.y - w.a.y) * x);
          if (off < 1 && t1 > t0 && t1 - t0 > 0.8 * distance(e.a, e.b))
            covered += std::max(0.0, std::min(l, t1) - std::max(0.0, t0));
        }
        ++s.walls;
        if (covered >= 0.9 * l) ++s.walls_recovered;
      }
    }
  double before = 0, after = 0, count = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const TerraceBuilding& b = repaired.buildings[i];
    s.largest_shift = std::max(s.largest_shift, b.record.max_shift);
    for (const Polygon& p : b.polygons) s.invalid += geometry::strictly_simple(p) ? 0 : 1;
    for (std::size_t k = 0; k < truth[i].size(); ++k) {
      const auto look = [&](const Ring& t, const Ring& n) {
        for (std::size_t v = 0; v < t.size(); ++v) {
          const auto now_at = [&](std::size_t k) { return place_of(b.polygons, n.nodes[k], t.points[k]); };
          const Point2 at = now_at(v);
          before += distance(t.points[v], n.points[v]);
          after += distance(t.points[v], at);
          ++count;
          const std::size_t iu = (v + t.size() - 1) % t.size(), iw = (v + 1) % t.size();
          const Point2 u = t.points[iu], w = t.points[iw];
          const double angle = angle_at(u, t.points[v], w);
          const double legs = std::min(distance(u, t.points[v]), distance(w, t.points[v]));
          const double now = angle_at(now_at(iu), at, now_at(iw));
          if (std::fabs(angle - 90) < 0.2 && legs >= 1) {
            ++s.right;
            if (std::fabs(now - 90) <= 0.1) ++s.right_restored;
          }
          if (std::fabs(angle - 90) > 5 && angle < 175 && legs >= 8) {
            ++s.oblique;
            if (std::fabs(now - 90) <= 0.2) ++s.oblique_squared;
          }
        }
      };
      look(truth[i][k].outer, noisy[i][k].outer);
      for (std::size_t h = 0; h < truth[i][k].holes.size(); ++h) look(truth[i][k].holes[h], noisy[i][k].holes[h]);
    }
  }
  s.error_before = before / std::max(1.0, count);
  s.error_after = after / std::max(1.0, count);
  return s;
}

}  // namespace blockrand::repair::test
