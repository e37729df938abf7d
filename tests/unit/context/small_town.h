// Small scenes for tests of edge labels and situations.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/context/wall_segments.h"

namespace blockrand::context {

/// Buildings, streets and points around a place in the build CRS. Coordinates in metres from there; turned by `angle`.
class SmallTown {
 public:
  explicit SmallTown(double degrees = 0)
      : cos_(std::cos(degrees * 0.017453292519943295)), sin_(std::sin(degrees * 0.017453292519943295)) {}

  using Points = std::vector<model::Point2>;

  model::Point2 at(double x, double y) const {
    return model::snap(model::Point2{391000 + x * cos_ - y * sin_, 5820000 + x * sin_ + y * cos_});
  }

  /// Counter-clockwise outer ring, holes of either orientation. Node ids come from the id and the place in the ring.
  void house(std::int64_t id, const Points& outer, const std::vector<Points>& holes = {}, bool canopy = false) {
    model::Building b;
    b.osm = {model::OsmType::way, id};
    model::Polygon polygon;
    polygon.outer = ring(outer, true);
    for (const Points& hole : holes) polygon.holes.push_back(ring(hole, false));
    b.outline = {polygon};
    buildings.push_back(b);
    footprints.push_back({b.osm, polygon, std::nullopt, canopy});
  }
  void box(std::int64_t id, double x0, double y0, double x1, double y1) {
    house(id, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
  }

  NetworkLine& street(std::int64_t id, const Points& points, const std::string& name,
                      LineClass kind = LineClass::residential) {
    NetworkLine line;
    line.id = {model::OsmType::way, id};
    line.kind = kind;
    line.name = name;
    for (const model::Point2 p : points) {
      line.points.push_back(at(p.x, p.y));
      line.nodes.push_back(10000 + static_cast<std::int64_t>(p.x * 1000 + p.y));
    }
    lines.push_back(line);
    return lines.back();
  }

  void passage(std::int64_t id, const Points& points, double width) {
    PassageWay way;
    way.id = {model::OsmType::way, id};
    way.width = width;
    for (const model::Point2 p : points) way.points.push_back(at(p.x, p.y));
    way.nodes.assign(points.size(), 0);
    passages.push_back(way);
  }

  void point(std::int64_t id, SitePointKind kind, double x, double y, const std::string& street_name = "",
             const std::string& house_number = "", const std::string& use = "") {
    points.push_back({{model::OsmType::node, id}, kind, at(x, y), street_name, house_number, use});
  }
  /// Of a house; strings must outlive the town.
  void address(std::int64_t id, std::string_view street_name, std::string_view house_number) {
    addresses.push_back({{model::OsmType::way, id}, street_name, house_number});
  }

  /// Finds blocks and labels every building.
  void label(const std::string& address = "") {
    std::sort(footprints.begin(), footprints.end(), [](const Footprint& a, const Footprint& b) { return a.id < b.id; });
    blocks = find_blocks(lines, {});
    figures = measure_blocks(blocks, footprints, lines);
    std::sort(addresses.begin(), addresses.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    const VicinityIndex index({footprints, lines, blocks, figures, passages, points, addresses});
    for (model::Building& b : buildings) label_wall_segments(b, index, address);
  }

  const model::Building& operator[](std::int64_t id) const {
    return *std::find_if(buildings.begin(), buildings.end(),
                         [&](const model::Building& b) { return b.osm.number == id; });
  }

  /// The stretch of a building that holds the point nearest to (x, y).
  const model::WallSegment& edge(std::int64_t id, double x, double y) const {
    const model::Building& b = (*this)[id];
    const model::Point2 p = at(x, y);
    const model::WallSegment* best = nullptr;
    double least = 1e9;
    for (const model::WallSegment& f : b.edges) {
      const model::Polygon& polygon = b.outline[f.polygon];
      const model::Ring& r = f.ring == 0 ? polygon.outer : polygon.holes[f.ring - 1];
      const model::Point2 a = r.points[f.edge], e = r.points[(f.edge + 1) % r.size()];
      const double length = std::hypot(e.x - a.x, e.y - a.y);
      const double t = std::clamp(((p.x - a.x) * (e.x - a.x) + (p.y - a.y) * (e.y - a.y)) / length, f.start, f.end);
      const double d = std::hypot(a.x + (e.x - a.x) * t / length - p.x, a.y + (e.y - a.y) * t / length - p.y);
      if (d < least) {
        least = d;
        best = &f;
      }
    }
    return *best;
  }
  model::WallSegmentKind kind(std::int64_t id, double x, double y) const { return edge(id, x, y).kind; }

  std::vector<model::Building> buildings;
  std::vector<Footprint> footprints;
  std::vector<NetworkLine> lines;
  std::vector<Block> blocks;
  std::vector<BlockFigures> figures;
  std::vector<PassageWay> passages;
  std::vector<SitePoint> points;
  std::vector<BuildingAddress> addresses;

 private:
  model::Ring ring(Points points_in, bool counter_clockwise) const {
    double area = 0;
    for (std::size_t i = 0; i < points_in.size(); ++i) {
      const model::Point2 a = points_in[i], b = points_in[(i + 1) % points_in.size()];
      area += a.x * b.y - b.x * a.y;
    }
    if ((area > 0) != counter_clockwise) std::reverse(points_in.begin(), points_in.end());
    model::Ring out;
    for (const model::Point2 p : points_in) {
      out.points.push_back(at(p.x, p.y));
      out.nodes.push_back(500000 + static_cast<std::int64_t>(p.x * 10) * 10000 + static_cast<std::int64_t>(p.y * 10));
    }
    return out;
  }

  double cos_, sin_;
};

/// A perimeter block of 100 x 100 m between four streets: houses 12 m deep with their fronts 10 m from the lines, corner
/// houses 1 to 4 from the south-west counter-clockwise, row houses 11 to 14 in the south, 21.. east, 31.. north, 41.. west.
inline SmallTown perimeter_block(double degrees = 0) {
  SmallTown t(degrees);
  t.street(901, {{-60, 0}, {0, 0}, {100, 0}, {160, 0}}, "South Street");
  t.street(902, {{100, -60}, {100, 0}, {100, 100}, {100, 160}}, "East Street");
  t.street(903, {{160, 100}, {100, 100}, {0, 100}, {-60, 100}}, "North Street");
  t.street(904, {{0, 160}, {0, 100}, {0, 0}, {0, -60}}, "West Street");
  t.house(1, {{10, 10}, {26, 10}, {26, 22}, {22, 22}, {22, 26}, {10, 26}});
  t.house(2, {{90, 10}, {90, 26}, {78, 26}, {78, 22}, {74, 22}, {74, 10}});
  t.house(3, {{90, 90}, {74, 90}, {74, 78}, {78, 78}, {78, 74}, {90, 74}});
  t.house(4, {{10, 90}, {10, 74}, {22, 74}, {22, 78}, {26, 78}, {26, 90}});
  for (int i = 0; i < 4; ++i) {
    const double a = 26 + 12 * i, b = a + 12;
    t.box(11 + i, a, 10, b, 22);
    t.box(21 + i, 78, a, 90, b);
    t.box(31 + i, a, 78, b, 90);
    t.box(41 + i, 10, a, 22, b);
  }
  return t;
}

}  // namespace blockrand::context
