#include "pipeline/compare/cover.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/parallel.h"
#include "pipeline/compare/read_city.h"
#include "pipeline/compare/surface_samples.h"
#include "pipeline/geometry/polygon.h"

namespace blockrand::compare {

namespace {

constexpr double kUpright = 0.26;  // sine of 15 degrees: faces that lean more are no walls
constexpr double kAbove = 0.1;     // m. The top edge of a common wall counts as below the neighbour's roof.
constexpr double kBelow = 0.5;     // m. Grounds of neighbours on a slope differ.
constexpr double kSpacing = 0.5;   // m between the places of a face that are asked, at least;
constexpr double kPlaces = 64;     // more on large faces: half of a face is told from so many

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
      if (k != i) neighbours_[i].push_back(k);
}

bool Cover::covered(std::uint32_t building, Point3 at, Point3 normal) const {
  if (std::fabs(normal.z) > kUpright || neighbours_[building].empty()) return false;
  const double flat = std::sqrt(normal.x * normal.x + normal.y * normal.y);
  for (const double side : {kAgainst / flat, -kAgainst / flat}) {
    const Point2 p{at.x + side * normal.x, at.y + side * normal.y};
    for (const std::uint32_t k : neighbours_[building]) {
      const Building& other = city_.buildings[k];
      const geometry::PlanBox& box = boxes_[k];
      if (at.z < other.ground - kBelow || p.x < box.minimum.x || p.y < box.minimum.y || p.x > box.maximum.x ||
          p.y > box.maximum.y)
        continue;
      bool within = false;
      for (const model::Polygon& polygon : other.footprint) within = within || geometry::contains(polygon, p);
      if (!within) continue;
      if (const auto roof = roofs_[k].at(p); roof && at.z <= roof->z + kAbove) return true;
    }
  }
  return false;
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
