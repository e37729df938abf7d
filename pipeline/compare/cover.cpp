#include "pipeline/compare/cover.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/parallel.h"
#include "pipeline/compare/read_city.h"
#include "pipeline/compare/surface_samples.h"
#include "pipeline/geometry/plan_shape.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::compare {

namespace {

constexpr double kUpright = 0.26;  // sine of 15 degrees: faces that lean more are no walls
constexpr double kAbove = 0.1;     // m. The top edge of a common wall counts as below the neighbour's roof.
constexpr double kBelow = 0.5;     // m. Grounds of neighbours on a slope differ.
constexpr double kSpacing = 0.5;   // m between the places of a face that are asked, at least;
constexpr double kPlaces = 64;     // more on large faces: half of a face is told from so many

/// Whether two buildings stand on the same ground, as repetitions and what stands over a garage do: they hide nothing
/// of each other that could be seen if they did not.
bool share_their_ground(const Building& a, const geometry::PlanBox& box_a, const Building& b,
                        const geometry::PlanBox& box_b) {
  const double smaller = std::min(a.footprint_area, b.footprint_area);
  const double width = std::min(box_a.maximum.x, box_b.maximum.x) - std::max(box_a.minimum.x, box_b.minimum.x);
  const double depth = std::min(box_a.maximum.y, box_b.maximum.y) - std::max(box_a.minimum.y, box_b.minimum.y);
  if (width <= 0 || depth <= 0 || width * depth < smaller / 2) return false;
  return geometry::PlanShape(a.footprint).common_area(geometry::PlanShape(b.footprint)) > smaller / 2;
}

}  // namespace

RoofSurfaces roof_of(const Building& building) {
  RoofSurfaces roof;
  for (const Face& f : building.faces)
    if (f.hull == Hull::roof || f.hull == Hull::outer_floor) roof.add(f.rings);
  return roof;
}

Cover::Cover(const City& city) : city_(city) {
  for (const Building& b : city.buildings) {
    boxes_.push_back(b.footprint.empty() ? geometry::PlanBox{} : plan_box(b));
    roofs_.push_back(roof_of(b));
  }
  const geometry::BoxIndex index(boxes_);
  neighbours_.resize(boxes_.size());
  for (std::uint32_t i = 0; i < boxes_.size(); ++i)
    for (const std::uint32_t k : index.near(boxes_[i], kAgainst))
      if (k != i && !share_their_ground(city.buildings[i], boxes_[i], city.buildings[k], boxes_[k]))
        neighbours_[i].push_back(k);
}

bool Cover::within(std::uint32_t building, Point3 p) const {
  const geometry::PlanBox& box = boxes_[building];
  const Building& b = city_.buildings[building];
  if (p.z < b.ground - kBelow || p.x < box.minimum.x || p.y < box.minimum.y || p.x > box.maximum.x ||
      p.y > box.maximum.y)
    return false;
  if (std::none_of(b.footprint.begin(), b.footprint.end(),
                   [&](const model::Polygon& polygon) { return geometry::contains(polygon, p.xy()); }))
    return false;
  const auto roof = roofs_[building].at(p.xy());
  return roof && p.z <= roof->z + kAbove;
}

bool Cover::covered(std::uint32_t building, Point3 at, Point3 normal) const {
  if (std::fabs(normal.z) > kUpright || !has_neighbours(building)) return false;
  const double flat = std::sqrt(normal.x * normal.x + normal.y * normal.y);
  const double dx = kAgainst / flat * normal.x, dy = kAgainst / flat * normal.y;
  const Point3 sides[] = {{at.x + dx, at.y + dy, at.z}, {at.x - dx, at.y - dy, at.z}};
  for (const Point3& p : sides)
    for (const std::uint32_t k : neighbours_[building])
      if (within(k, p)) return true;
  return city_.buildings[building].bodies > 1 && within(building, sides[0]) && within(building, sides[1]);
}

void mark_left_out(City& city, const Cover& cover, int jobs) {
  const auto mark = [&](std::uint32_t b) {
    for (Face& f : city.buildings[b].faces) {
      if (f.hull == Hull::ground) f.left_out = LeftOut::ground;
      if (f.hull != Hull::wall || !cover.has_neighbours(b)) continue;
      double covered = 0, all = 0;
      const double spacing = std::max(kSpacing, std::sqrt(f.area / kPlaces));
      for_each_sample(triangles_of(f.rings), f.normal, f.rings[0][0], spacing, 0, [&](Point3 at, double weight) {
        all += weight;
        if (cover.covered(b, at, f.normal)) covered += weight;
      });
      if (covered > all / 2) f.left_out = LeftOut::covered;
    }
  };
  const int workers = base::worker_count(jobs);
  base::ordered_parallel(
      city.buildings.size(), workers, static_cast<std::size_t>(workers) * 8,
      [&](std::size_t b) { mark(static_cast<std::uint32_t>(b)); }, [](std::size_t) {});
}

}  // namespace blockrand::compare
