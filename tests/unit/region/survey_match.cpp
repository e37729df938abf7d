#include "tests/unit/region/survey_match.h"

#include <geos_c.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "importers/reference/citygml.h"
#include "importers/reference/footprints.h"
#include "importers/reference/transform.h"

namespace blockrand::region::test {

namespace {

namespace fs = std::filesystem;
namespace reference = importers::reference;
using model::Point2;

GEOSContextHandle_t context() {
  static const struct Context {
    GEOSContextHandle_t handle = GEOS_init_r();
    ~Context() { GEOS_finish_r(handle); }
  } context;
  return context.handle;
}

using Shape = std::shared_ptr<void>;

Shape held(GEOSGeometry* geometry) {
  if (!geometry) throw std::runtime_error("GEOS failed");
  return {geometry, [](void* g) { GEOSGeom_destroy_r(context(), static_cast<GEOSGeometry*>(g)); }};
}

const GEOSGeometry* raw(const Shape& shape) { return static_cast<const GEOSGeometry*>(shape.get()); }

GEOSGeometry* linear_ring(const model::Ring& ring) {
  const auto n = static_cast<unsigned>(ring.size());
  GEOSCoordSequence* points = GEOSCoordSeq_create_r(context(), n + 1, 2);
  for (unsigned i = 0; i <= n; ++i)
    GEOSCoordSeq_setXY_r(context(), points, i, ring.points[i % n].x, ring.points[i % n].y);
  return GEOSGeom_createLinearRing_r(context(), points);
}

GEOSGeometry* polygon_of(const model::Polygon& polygon) {
  std::vector<GEOSGeometry*> holes;
  for (const model::Ring& hole : polygon.holes) holes.push_back(linear_ring(hole));
  return GEOSGeom_createPolygon_r(context(), linear_ring(polygon.outer), holes.data(),
                                  static_cast<unsigned>(holes.size()));
}

double area_of(const Shape& shape) {
  double area = 0;
  if (!GEOSArea_r(context(), raw(shape), &area)) throw std::runtime_error("GEOS: no area");
  return area;
}

bool mostly_the_same(const PlanShape& a, const PlanShape& b) {
  return a.common_area(b) > 0.5 * std::min(a.area(), b.area());
}

/// Sets that grow together.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<fs::path> models_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gml" || entry.path().extension() == ".xml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

PlanBox box_around(const std::vector<model::Polygon>& polygons) {
  PlanBox box;
  for (const model::Polygon& p : polygons) box.include(box_of(p.outer.points));
  return box;
}

}  // namespace

PlanShape::PlanShape(const std::vector<model::Polygon>& polygons) {
  std::vector<GEOSGeometry*> parts;
  for (const model::Polygon& p : polygons) parts.push_back(polygon_of(p));
  const Shape all = held(GEOSGeom_createCollection_r(context(), GEOS_GEOMETRYCOLLECTION, parts.data(),
                                                     static_cast<unsigned>(parts.size())));
  shape_ = held(GEOSUnaryUnion_r(context(), raw(all)));
  area_ = area_of(shape_);
}

Point2 PlanShape::centroid() const {
  const Shape point = held(GEOSGetCentroid_r(context(), raw(shape_)));
  Point2 p;
  GEOSGeomGetX_r(context(), raw(point), &p.x);
  GEOSGeomGetY_r(context(), raw(point), &p.y);
  return p;
}

double PlanShape::common_area(const PlanShape& other) const {
  if (empty() || other.empty()) return 0;
  return area_of(held(GEOSIntersection_r(context(), raw(shape_), raw(other.shape_))));
}

double PlanShape::intersection_over_union(const PlanShape& other) const {
  if (empty() || other.empty()) return 0;
  const double common = common_area(other);
  return common / (area_ + other.area_ - common);
}

double PlanShape::best_intersection_over_union(const PlanShape& other) const {
  Point2 at;
  double best = intersection_over_union(other);
  for (double step = 0.64; step >= 0.01; step /= 2)
    for (bool better = true; better;) {
      better = false;
      for (const Point2 d : {Point2{step, 0}, Point2{-step, 0}, Point2{0, step}, Point2{0, -step}}) {
        const Point2 next{at.x + d.x, at.y + d.y};
        const double iou = moved(next).intersection_over_union(other);
        if (iou > best) best = iou, at = next, better = true;
      }
    }
  return best;
}

double PlanShape::outline_distance(const PlanShape& other) const {
  if (empty() || other.empty()) return 0;
  const Shape a = held(GEOSBoundary_r(context(), raw(shape_))), b = held(GEOSBoundary_r(context(), raw(other.shape_)));
  double distance = 0;
  if (!GEOSHausdorffDistance_r(context(), raw(a), raw(b), &distance)) throw std::runtime_error("GEOS: no distance");
  return distance;
}

PlanShape PlanShape::moved(Point2 by) const {
  PlanShape out;
  if (empty()) return out;
  const auto move = [](double* x, double* y, void* by_ptr) {
    *x += static_cast<const Point2*>(by_ptr)->x;
    *y += static_cast<const Point2*>(by_ptr)->y;
    return 1;
  };
  out.shape_ = held(GEOSGeom_transformXY_r(context(), raw(shape_), move, &by));
  out.area_ = area_;
  return out;
}

PlanShape PlanShape::united(const PlanShape& other) const {
  if (empty()) return other;
  if (other.empty()) return *this;
  PlanShape out;
  out.shape_ = held(GEOSUnion_r(context(), raw(shape_), raw(other.shape_)));
  out.area_ = area_of(out.shape_);
  return out;
}

std::vector<SurveyedBuilding> read_survey(const fs::path& folder, const std::string& crs) {
  std::vector<SurveyedBuilding> out;
  for (const fs::path& file : models_below(folder)) {
    reference::ReferenceModel model = reference::read_citygml(file.string());
    reference::transform_to(model, crs);
    for (const reference::Footprint2D& footprint : reference::ground_footprints(model)) {
      SurveyedBuilding b;
      b.id = model.buildings[footprint.building].id;
      b.ground = PlanShape(footprint.polygons);
      b.box = box_around(footprint.polygons);
      const bool known = std::any_of(out.begin(), out.end(), [&](const SurveyedBuilding& other) {
        return other.box.near(b.box, 0) && mostly_the_same(other.ground, b.ground);
      });
      if (!known && !b.ground.empty()) out.push_back(std::move(b));
    }
  }
  return out;
}

PlanShape shape_of(const FootprintStore& store, const std::vector<std::uint32_t>& buildings) {
  std::vector<model::Polygon> all;
  for (const std::uint32_t b : buildings)
    for (model::Polygon& p : store.polygons(b)) all.push_back(std::move(p));
  return PlanShape(all);
}

std::vector<SurveyMatch> match_survey(const FootprintStore& mapped, const std::vector<SurveyedBuilding>& survey) {
  const FootprintIndex index(mapped);
  const std::size_t n = survey.size();
  Groups groups(n + mapped.size());
  std::vector<bool> linked(n + mapped.size(), false);
  for (std::size_t s = 0; s < n; ++s)
    for (const std::uint32_t b : index.near(survey[s].box, 0)) {
      if (!mostly_the_same(survey[s].ground, shape_of(mapped, {b}))) continue;
      groups.join(s, n + b);
      linked[s] = linked[n + b] = true;
    }
  std::vector<SurveyMatch> all(n);  // by the least surveyed building
  for (std::size_t i = 0; i < linked.size(); ++i) {
    if (!linked[i]) continue;
    SurveyMatch& match = all[groups.find(i)];
    if (i >= n) {
      match.buildings.push_back(static_cast<std::uint32_t>(i - n));
      continue;
    }
    match.surveyed.push_back(i);
    match.ground = match.ground.united(survey[i].ground);
  }
  std::erase_if(all, [&](const SurveyMatch& m) {
    if (m.buildings.empty()) return true;
    const PlanShape shape = shape_of(mapped, m.buildings);
    return m.ground.common_area(shape) <= 0.5 * std::max(shape.area(), m.ground.area());
  });
  return all;
}

}  // namespace blockrand::region::test
