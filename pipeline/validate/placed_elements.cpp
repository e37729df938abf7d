#include "pipeline/validate/placed_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>

#include "pipeline/geometry/box_index.h"
#include "pipeline/model/vector.h"

namespace blockrand::validate {
namespace {

using model::Point3;

/// m. An opening's outline and its element are rounded apart: to the grid, to steps, and by the element's rotation.
constexpr double kAround = 0.01;

/// Of unit vectors. Rotations have 16 bits, and a metre in the build CRS is measured on a grid.
constexpr double kTurn = 0.005;

/// A placed element's box, ready to be asked for points of the tile's frame (z up).
class Box {
 public:
  Box(const GlbPlace& place, const GlbElement& element) {
    const Matrix& m = place.matrix;
    origin_ = placed(place, {0, 0, 0});
    // Openings lie in the plane of the origin, which elements reach from behind or before.
    const double low[] = {element.min.x, element.min.y, std::min(element.min.z, 0.0)},
                 high[] = {element.max.x, element.max.y, std::max(element.max.z, 0.0)};
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 column{m[4 * i], 0.0 - m[4 * i + 2], m[4 * i + 1]};
      const double square = dot(column, column), length = std::sqrt(square);
      axis_[i] = {column.x / length, column.y / length, column.z / length};
      low_[i] = low[i] * length - kAround;
      high_[i] = high[i] * length + kAround;
    }
  }
  bool holds(const Point3& p) const {
    const Point3 d{p.x - origin_.x, p.y - origin_.y, p.z - origin_.z};
    for (std::size_t i = 0; i < 3; ++i)
      if (const double v = dot(axis_[i], d); !(v >= low_[i] && v <= high_[i])) return false;
    return true;
  }
  /// Empty, and so never found, where the place has a scale of 0.
  geometry::PlanBox in_plan() const {
    geometry::PlanBox out;
    for (const Point3& axis : axis_)
      if (!std::isfinite(axis.x + axis.y + axis.z)) return out;
    for (int corner = 0; corner < 8; ++corner) {
      model::Point2 p = origin_.xy();
      for (std::size_t i = 0; i < 3; ++i) {
        const double v = corner >> i & 1 ? high_[i] : low_[i];
        p = {p.x + v * axis_[i].x, p.y + v * axis_[i].y};
      }
      out.include(p);
    }
    return out;
  }

 private:
  Point3 origin_, axis_[3];
  double low_[3] = {}, high_[3] = {};
};

/// Middles of the edges that have a face on one side only.
std::vector<Point3> open_edges(const std::vector<GlbTriangle>& triangles) {
  std::vector<Point3> points;
  for (const GlbTriangle& t : triangles) points.insert(points.end(), t.corners.begin(), t.corners.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const auto number = [&](const Point3& p) {
    return static_cast<std::uint64_t>(std::lower_bound(points.begin(), points.end(), p) - points.begin());
  };
  std::unordered_map<std::uint64_t, int> edges;  // from the lower to the higher corner, minus back
  for (const GlbTriangle& t : triangles) {
    const std::uint64_t c[] = {number(t.corners[0]), number(t.corners[1]), number(t.corners[2])};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t a = c[i], b = c[(i + 1) % 3];
      edges[std::min(a, b) << 32 | std::max(a, b)] += a < b ? 1 : -1;
    }
  }
  std::vector<Point3> out;
  for (const auto& [edge, sum] : edges) {
    if (sum == 0) continue;
    const Point3 &a = points[edge >> 32], &b = points[edge & 0xFFFFFFFFu];
    out.push_back({(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2});
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// m, from the nearest point of the triangle.
double distance(const Point3& p, const GlbTriangle& t) {
  const auto& [a, b, c] = t.corners;
  const Point3 n = cross(b - a, c - a);
  const double square = dot(n, n);
  const auto to_edge = [&](const Point3& from, const Point3& to) {
    const Point3 edge = to - from;
    const double along = dot(edge, edge);
    const double at = along > 0 ? std::clamp(dot(p - from, edge) / along, 0.0, 1.0) : 0;
    return length(p - (from + edge * at));
  };
  const auto inside = [&](const Point3& from, const Point3& to) { return dot(cross(to - from, p - from), n) >= 0; };
  if (square > 0 && inside(a, b) && inside(b, c) && inside(c, a)) return std::fabs(dot(p - a, n)) / std::sqrt(square);
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

std::vector<std::vector<const GlbPlace*>> places_by_row(const Glb& glb) {
  std::vector<std::vector<const GlbPlace*>> out(glb.contents.bodies.size());
  for (const GlbPlace& place : glb.places) out[place.row].push_back(&place);
  return out;
}

using model::Point2;

struct Placed {
  Point3 origin;
  Point2 along;  ///< east and north
  std::size_t element = 0;
};

Point2 direction(const Point3& from, const Point3& to) {
  const double x = to.x - from.x, y = to.y - from.y, length = std::hypot(x, y);
  return length > 0 ? Point2{x / length, y / length} : Point2{};
}

Placed placed_at(const GlbPlace& place) {
  const Point3 origin = placed(place, {0, 0, 0});
  const Matrix& m = place.matrix;  // its first column, y up
  return {origin, direction({0, 0, 0}, {m[0], 0.0 - m[2], 0}), place.element};
}

/// How an element fits where another format has one; the least is the best.
struct Fit {
  bool turned = false;
  std::string strange;      ///< a colour that it must not have; empty: none
  std::size_t missing = 0;  ///< colours of the other that it has not: faces that rounding made flat
  double off = 0;           ///< m

  void compare(const std::set<std::string>& has, const std::vector<std::string>& wanted,
               const std::set<std::string>& walls) {
    for (const std::string& colour : has)
      if (strange.empty() && !walls.count(colour) && !std::binary_search(wanted.begin(), wanted.end(), colour))
        strange = colour;
    for (const std::string& colour : wanted) missing += !has.count(colour);
  }
  bool operator<(const Fit& b) const {
    const auto key = [](const Fit& f) { return std::tuple(f.turned, !f.strange.empty(), f.missing, f.off); };
    return key(*this) < key(b);
  }
};

/// What reveals may look like, which the GLB has with the element and other formats with the wall.
std::set<std::string> wall_colours(const ReadBody& body) {
  std::set<std::string> out;
  for (const ReadSolid& solid : body.solids)
    if (solid.lod == 3)
      for (const ReadPolygon& polygon : solid.polygons)
        if (polygon.kind == "wall") out.insert(polygon.colour);
  return out;
}

bool is_detailed(const ReadBody& body) {
  const auto lod = body.attributes.find("lod");
  return lod != body.attributes.end() && lod->second == "3";
}

}  // namespace

std::vector<Point3> place_corners(const Glb& glb) {
  std::vector<Point3> out;
  out.reserve(8 * glb.places.size());
  for (const GlbPlace& place : glb.places) {
    const GlbElement& e = glb.elements[place.element];
    if (e.triangles.empty()) continue;
    for (int i = 0; i < 8; ++i)
      out.push_back(placed(place, {i & 1 ? e.max.x : e.min.x, i & 2 ? e.max.y : e.min.y, i & 4 ? e.max.z : e.min.z}));
  }
  return out;
}

void check_openings(const Glb& glb, const std::string& file, std::vector<Finding>& findings) {
  const auto places = places_by_row(glb);
  for (std::size_t row = 0; row < glb.contents.bodies.size(); ++row) {
    const ReadBody& body = glb.contents.bodies[row];
    if (!is_detailed(body) || body.attributes.contains("open_surfaces")) continue;
    std::vector<Box> boxes;
    std::vector<geometry::PlanBox> in_plan;
    for (const GlbPlace* place : places[row])
      in_plan.push_back(boxes.emplace_back(*place, glb.elements[place->element]).in_plan());
    const geometry::BoxIndex index(std::move(in_plan));
    const std::vector<GlbTriangle>& triangles = glb.element_triangles[row];
    std::vector<geometry::PlanBox> of_triangles;
    for (const GlbTriangle& t : triangles) {
      geometry::PlanBox& box = of_triangles.emplace_back();
      for (const Point3& c : t.corners) box.include(c.xy());
    }
    const geometry::BoxIndex triangle_index(std::move(of_triangles));
    std::size_t open = 0;
    Point3 where;
    for (const Point3& p : open_edges(glb.triangles[row])) {
      const auto near = index.near({p.xy(), p.xy()}, kAround);
      if (std::any_of(near.begin(), near.end(), [&](std::uint32_t i) { return boxes[i].holds(p); })) continue;
      const auto around = triangle_index.near({p.xy(), p.xy()}, kAround);
      if (std::any_of(around.begin(), around.end(),
                      [&](std::uint32_t i) { return distance(p, triangles[i]) <= kAround; }))
        continue;
      if (open++ == 0) where = p;
    }
    if (open > 0)
      findings.push_back({Check::glb_rule, file, body.id,
                          fmt::format("its mesh is open at {} edges where no element stands, at {:.3f} {:.3f} {:.3f}",
                                      open, where.x, where.y, where.z)});
  }
}

namespace {

std::string colour_text(const std::array<std::uint8_t, 3>& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

/// Something that is drawn of an element.
struct Drawn {
  std::vector<Point3> points;  ///< of its box, or its corners; m in the tile's frame
  bool of_wall = false;  ///< in the colours of walls alone: perhaps a reveal, which is no part of elements elsewhere
  bool held = false;     ///< an element's box holds it
};

}  // namespace

void compare_pieces(const Side& reference, const Glb& glb, const std::string& glb_file, const ToLocal& to_local,
                    double tolerance, std::vector<Finding>& findings) {
  std::unordered_map<std::string_view, std::size_t> rows;
  for (std::size_t i = 0; i < glb.contents.bodies.size(); ++i) rows.emplace(glb.contents.bodies[i].id, i);
  const auto places = places_by_row(glb);
  std::vector<std::set<std::string>> colours_of;
  for (const GlbElement& element : glb.elements) {
    auto& set = colours_of.emplace_back();
    for (const GlbTriangle& t : element.triangles) set.insert(colour_text(t.colour));
  }
  for (const ReadBody& body : reference.contents.bodies) {
    const auto row = rows.find(body.id);
    if (row == rows.end()) continue;
    const std::set<std::string> walls = wall_colours(body);
    const auto of_wall = [&](const std::string& colour) { return walls.count(colour) > 0; };
    std::vector<Drawn> drawn;
    std::set<std::string> has;
    for (const GlbPlace* place : places[row->second]) {
      const GlbElement& e = glb.elements[place->element];
      const auto& colours = colours_of[place->element];
      has.insert(colours.begin(), colours.end());
      Drawn& d = drawn.emplace_back();
      d.of_wall = std::all_of(colours.begin(), colours.end(), of_wall);
      for (int i = 0; i < 8; ++i)
        d.points.push_back(
            placed(*place, {i & 1 ? e.max.x : e.min.x, i & 2 ? e.max.y : e.min.y, i & 4 ? e.max.z : e.min.z}));
    }
    for (const GlbTriangle& t : glb.element_triangles[row->second]) {
      has.insert(colour_text(t.colour));
      drawn.push_back({{t.corners.begin(), t.corners.end()}, of_wall(colour_text(t.colour)), false});
    }
    std::vector<geometry::PlanBox> in_plan;
    for (const Drawn& d : drawn) {
      geometry::PlanBox& box = in_plan.emplace_back();
      for (const Point3& p : d.points) box.include(p.xy());
    }
    const geometry::BoxIndex index(std::move(in_plan));

    std::vector<Point3> from;
    for (const ReadPlacement& p : body.detail.placements) {
      from.push_back(p.origin);
      from.push_back({p.origin.x + p.along.x, p.origin.y + p.along.y, p.origin.z});
    }
    std::vector<Point3> at(from.size());
    to_local(from, at);
    std::set<std::string> wanted;
    std::size_t empty = 0;
    Point3 where;
    for (std::size_t n = 0; n < body.detail.placements.size(); ++n) {
      const auto found = reference.contents.elements.find(body.detail.placements[n].element);
      if (found == reference.contents.elements.end()) continue;
      const ReadElement& element = found->second;
      wanted.insert(element.colours.begin(), element.colours.end());
      const Point3 origin = at[2 * n];
      const Point2 along = direction(origin, at[2 * n + 1]);
      const double around = tolerance + kAround;
      double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
      geometry::PlanBox box;
      for (const double x : {element.min.x, element.max.x})
        for (const double y : {element.min.y, element.max.y})
          box.include(Point2{origin.x + along.x * x - along.y * y, origin.y + along.y * x + along.x * y});
      for (const std::uint32_t i : index.near(box, around)) {
        bool inside = true;
        double l = 1e300, r = -1e300, b = 1e300, t = -1e300;
        for (const Point3& p : drawn[i].points) {
          const Point2 d{p.x - origin.x, p.y - origin.y};
          const double x = d.x * along.x + d.y * along.y, y = d.y * along.x - d.x * along.y, z = p.z - origin.z;
          inside = inside && x > element.min.x - around && x < element.max.x + around && y > element.min.y - around &&
                   y < element.max.y + around && z > element.min.z - around && z < element.max.z + around;
          l = std::min(l, x), r = std::max(r, x), b = std::min(b, z), t = std::max(t, z);
        }
        if (!inside) continue;
        drawn[i].held = true;
        left = std::min(left, l), right = std::max(right, r), low = std::min(low, b), high = std::max(high, t);
      }
      if ((left > element.min.x + around || right < element.max.x - around || low > element.min.z + around ||
           high < element.max.z - around) &&
          empty++ == 0)
        where = origin;
    }
    const auto differs = [&](Check check, std::string what) {
      findings.push_back({check, glb_file, body.id, std::move(what)});
    };
    if (empty > 0)
      differs(Check::geometry_differs, fmt::format("{} elements of {} are not there, at {:.3f} {:.3f} {:.3f}", empty,
                                                   reference.file, where.x, where.y, where.z));
    const auto strange = std::find_if(drawn.begin(), drawn.end(), [](const Drawn& d) { return !d.held && !d.of_wall; });
    if (strange != drawn.end())
      differs(Check::geometry_differs,
              fmt::format("an element stands where {} has none, at {:.3f} {:.3f} {:.3f}", reference.file,
                          strange->points[0].x, strange->points[0].y, strange->points[0].z));
    for (const std::string& colour : has)
      if (!wanted.count(colour) && !of_wall(colour)) {
        differs(Check::colour_differs,
                fmt::format("an element with faces in {}, which none has in {}", colour, reference.file));
        break;
      }
  }
}

void compare_places(const Side& reference, const Glb& glb, const std::string& glb_file, const ToLocal& to_local,
                    double tolerance, std::vector<Finding>& findings) {
  std::unordered_map<std::string_view, std::size_t> rows;
  for (std::size_t i = 0; i < glb.contents.bodies.size(); ++i) rows.emplace(glb.contents.bodies[i].id, i);
  const auto places = places_by_row(glb);
  std::vector<std::set<std::string>> colours;  // of the GLB's elements
  for (const GlbElement& element : glb.elements) {
    auto& set = colours.emplace_back();
    for (const GlbTriangle& t : element.triangles)
      set.insert(fmt::format("#{:02x}{:02x}{:02x}", t.colour[0], t.colour[1], t.colour[2]));
  }
  for (const ReadBody& body : reference.contents.bodies) {
    const auto row = rows.find(body.id);
    if (row == rows.end()) continue;
    const auto& is = places[row->second];
    const auto& should = body.detail.placements;
    const auto differs = [&](std::string what) {
      findings.push_back({Check::geometry_differs, glb_file, body.id, std::move(what)});
    };
    if (is.size() != should.size()) {
      differs(fmt::format("{} placed elements, {} in {}", is.size(), should.size(), reference.file));
      continue;
    }
    // Where each stands, and a metre to its right.
    std::vector<Point3> from, expected(2 * should.size());
    for (const ReadPlacement& p : should) {
      from.push_back(p.origin);
      from.push_back({p.origin.x + p.along.x, p.origin.y + p.along.y, p.origin.z});
    }
    to_local(from, expected);
    std::vector<Placed> left;
    for (const GlbPlace* place : is) left.push_back(placed_at(*place));
    std::sort(left.begin(), left.end(), [](const Placed& a, const Placed& b) { return a.origin < b.origin; });
    std::vector<geometry::PlanBox> origins;
    for (const Placed& p : left) origins.push_back({p.origin.xy(), p.origin.xy()});
    const geometry::BoxIndex index(std::move(origins));
    std::vector<bool> taken(left.size(), false);
    const std::set<std::string> walls = wall_colours(body);
    // Each expected place takes the one that fits best of those that are left there.
    double worst = 0;
    bool turned = false;
    std::string strange;
    for (std::size_t n = 0; n < should.size(); ++n) {
      const Point3& p = expected[2 * n];
      const Point2 along = direction(p, expected[2 * n + 1]);
      const auto element = reference.contents.elements.find(should[n].element);
      const ReadElement* wanted = element == reference.contents.elements.end() ? nullptr : &element->second;
      double nearest = 1e300;
      const Placed* best = nullptr;
      Fit best_fit;
      for (const std::uint32_t candidate : index.near({p.xy(), p.xy()}, tolerance)) {
        if (taken[candidate]) continue;
        const Placed* const i = &left[candidate];
        const Point3 d{i->origin.x - p.x, i->origin.y - p.y, i->origin.z - p.z};
        const double off = std::sqrt(dot(d, d));
        nearest = std::min(nearest, off);
        if (off > tolerance) continue;
        Fit fit;
        fit.turned = std::hypot(i->along.x - along.x, i->along.y - along.y) > kTurn;
        if (wanted && i->element < colours.size()) fit.compare(colours[i->element], wanted->colours, walls);
        fit.off = off;
        if (!best || fit < best_fit) best = i, best_fit = fit;
      }
      worst = std::max(worst, nearest);
      if (!best) continue;
      turned = turned || best_fit.turned;
      if (strange.empty()) strange = best_fit.strange;
      taken[static_cast<std::size_t>(best - left.data())] = true;
    }
    if (turned) differs(fmt::format("an element is turned otherwise than in {}", reference.file));
    if (!strange.empty())
      findings.push_back({Check::colour_differs, glb_file, body.id,
                          fmt::format("an element with faces in {}, which it has not in {}", strange, reference.file)});
    if (worst > tolerance) differs(fmt::format("an element stands where {} has none", reference.file));
  }
}

}  // namespace blockrand::validate
