// A building with parts in the making, as the tests of parts need it.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/footprints/repair/parts.h"
#include "pipeline/footprints/repair/parts_bodies.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::repair::test {

using model::Building;
using model::BuildingPart;
using model::IssueCode;
using model::Point2;
using model::Polygon;
using model::Ring;
using testing_shapes::polygon;
using testing_shapes::Random;
using testing_shapes::ring;

struct Tags {
  std::optional<float> height, min_height, storeys, min_storey;
};

/// A building w1 with an outline already repaired, and parts as mapped.
struct Scene {
  Building building;
  std::vector<Polygon> before;
  std::vector<model::PartFailure> failures;
  std::vector<model::SettledPart> settled;
  model::Report report;

  explicit Scene(std::vector<Point2> outline) {
    building.osm = {model::OsmType::way, 1};
    building.mapped_index = 1;
    if (!outline.empty()) before = {polygon(std::move(outline))};
    building.outline = before;
  }
  Scene& part(std::int64_t number, std::vector<Point2> points, Tags tags = {}) {
    BuildingPart p;
    p.osm = {model::OsmType::way, number};
    p.mapped_index = static_cast<std::uint32_t>(number);
    p.id = building.id() + "." + p.osm.text();
    p.rings = {{ring(std::move(points))}, {false}};
    p.mapped.height = tags.height;
    p.mapped.min_height = tags.min_height;
    p.mapped.storeys = tags.storeys;
    p.mapped.min_storey = tags.min_storey;
    building.parts.push_back(std::move(p));
    building.has_mapped_parts = true;
    return *this;
  }
  Scene& moved_to(std::vector<Point2> outline) {
    building.outline = {polygon(std::move(outline))};
    return *this;
  }
  Scene& fit(const RepairOptions& options = {}) {
    fit_parts(building, before, {}, options, failures, settled, report);
    for (const BuildingPart& p : building.parts) {
      EXPECT_TRUE(geometry::strictly_simple(p.plan)) << p.id;
      EXPECT_TRUE(well_wound(p.plan)) << p.id;
    }
    return *this;
  }
  const Polygon& plan(const std::string& id) const {
    const auto found =
        std::find_if(building.parts.begin(), building.parts.end(), [&](const auto& p) { return p.id == id; });
    static const Polygon none;
    EXPECT_NE(found, building.parts.end()) << id;
    return found == building.parts.end() ? none : found->plan;
  }
  double area(const std::string& id) const { return geometry::area(plan(id)); }
  bool has_point(const std::string& id, Point2 p) const {
    const Polygon& of = plan(id);
    if (std::count(of.outer.points.begin(), of.outer.points.end(), p) > 0) return true;
    return std::any_of(of.holes.begin(), of.holes.end(),
                       [&](const Ring& h) { return std::count(h.points.begin(), h.points.end(), p) > 0; });
  }
  /// The corner nearest to a place.
  Point2 point_near(const std::string& id, Point2 p) const {
    const auto& points = plan(id).outer.points;
    return *std::min_element(points.begin(), points.end(), [&](Point2 a, Point2 b) {
      return std::fabs(a.x - p.x) + std::fabs(a.y - p.y) < std::fabs(b.x - p.x) + std::fabs(b.y - p.y);
    });
  }
  double common(const std::string& a, const std::string& b) const {
    return geometry::common_area(std::vector{plan(a)}, std::vector{plan(b)});
  }
  std::vector<std::string> ids() const {
    std::vector<std::string> out;
    for (const auto& p : building.parts) out.push_back(p.id);
    return out;
  }
  std::string detail(IssueCode code) const {
    for (const auto& row : report.rows)
      if (row.code == code) return row.object.text() + " " + row.detail;
    return "-";
  }
};

using Ids = std::vector<std::string>;

}  // namespace blockrand::repair::test
