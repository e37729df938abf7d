#include "pipeline/validate/placed_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace blockrand::validate {
namespace {

using model::Point3;

/// m. An opening's outline and its element are rounded apart: to the grid, to steps, and by the element's rotation.
constexpr double kAround = 0.01;

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// A placed element's box, ready to be asked for points of the tile's frame (z up).
class Box {
 public:
  Box(const GlbPlace& place, const GlbElement& element) {
    const Matrix& m = place.matrix;
    origin_ = placed(place, {0, 0, 0});
    const double low[] = {element.min.x, element.min.y}, high[] = {element.max.x, element.max.y};
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 column{m[4 * i], 0.0 - m[4 * i + 2], m[4 * i + 1]};
      const double square = dot(column, column), length = std::sqrt(square);
      axis_[i] = {column.x / length, column.y / length, column.z / length};
      // The third axis leads out of the wall: openings lie in its plane.
      low_[i] = (i < 2 ? low[i] * length : 0) - kAround;
      high_[i] = (i < 2 ? high[i] * length : 0) + kAround;
    }
  }
  bool holds(const Point3& p) const {
    const Point3 d{p.x - origin_.x, p.y - origin_.y, p.z - origin_.z};
    for (std::size_t i = 0; i < 3; ++i)
      if (const double v = dot(axis_[i], d); !(v >= low_[i] && v <= high_[i])) return false;
    return true;
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

std::vector<std::vector<const GlbPlace*>> places_by_row(const Glb& glb) {
  std::vector<std::vector<const GlbPlace*>> out(glb.contents.bodies.size());
  for (const GlbPlace& place : glb.places) out[place.row].push_back(&place);
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
    if (!is_detailed(body)) continue;
    std::vector<Box> boxes;
    for (const GlbPlace* place : places[row]) boxes.emplace_back(*place, glb.elements[place->element]);
    std::size_t open = 0;
    Point3 where;
    for (const Point3& p : open_edges(glb.triangles[row]))
      if (std::none_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.holds(p); })) {
        if (open++ == 0) where = p;
      }
    if (open > 0)
      findings.push_back({Check::glb_rule, file, body.id,
                          fmt::format("its mesh is open at {} edges where no element stands, at {:.3f} {:.3f} {:.3f}",
                                      open, where.x, where.y, where.z)});
  }
}

void compare_places(const Side& reference, const Glb& glb, const std::string& glb_file, const ToLocal& to_local,
                    double tolerance, std::vector<Finding>& findings) {
  std::unordered_map<std::string_view, std::size_t> rows;
  for (std::size_t i = 0; i < glb.contents.bodies.size(); ++i) rows.emplace(glb.contents.bodies[i].id, i);
  const auto places = places_by_row(glb);
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
    std::vector<Point3> from, expected(should.size());
    for (const ReadPlacement& p : should) from.push_back(p.origin);
    to_local(from, expected);
    // Each expected place takes the nearest that is left.
    std::vector<Point3> left;
    for (const GlbPlace* place : is) left.push_back(placed(*place, {0, 0, 0}));
    std::sort(left.begin(), left.end());
    double worst = 0;
    for (const Point3& p : expected) {
      double best = 1e300;
      std::size_t nearest = 0;
      const auto begin = std::lower_bound(left.begin(), left.end(), Point3{p.x - tolerance, -1e300, -1e300});
      for (auto i = begin; i != left.end() && i->x <= p.x + tolerance; ++i) {
        const Point3 d{i->x - p.x, i->y - p.y, i->z - p.z};
        if (const double off = std::sqrt(dot(d, d)); off < best)
          best = off, nearest = static_cast<std::size_t>(i - left.begin());
      }
      worst = std::max(worst, best);
      if (best <= tolerance) left.erase(left.begin() + static_cast<std::ptrdiff_t>(nearest));
    }
    if (worst > tolerance) differs(fmt::format("an element stands where {} has none", reference.file));
  }
}

}  // namespace blockrand::validate
