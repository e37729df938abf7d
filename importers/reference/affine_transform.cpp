#include "importers/reference/affine_transform.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/error.h"
#include "pipeline/georef/crs_facts.h"
#include "pipeline/georef/transform.h"

namespace blockrand::importers::reference {
namespace {

template <class Use>
void for_each_point(ReferenceModel& model, Use&& use) {
  for (Polygon3& polygon : model.polygons) {
    for (model::Point3& p : polygon.outer) use(p, polygon);
    for (auto& hole : polygon.holes)
      for (model::Point3& p : hole) use(p, polygon);
  }
}

}  // namespace

std::optional<georef::GeoBox> extent_of(const ReferenceModel& model) {
  if (model.polygons.empty()) return std::nullopt;
  model::Point2 low = model.polygons[0].outer[0].xy(), high = low;
  for (const Polygon3& polygon : model.polygons) {
    for (const model::Point3& p : polygon.outer) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  try {
    const georef::Transform transform(model.crs.horizontal, "EPSG:4326");
    georef::GeoBox box{180, 90, -180, -90};
    for (const model::Point2 corner : {low, model::Point2{low.x, high.y}, model::Point2{high.x, low.y}, high}) {
      const model::Point2 p = transform.forward(corner);
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) return std::nullopt;
      box = {std::min(box.west, p.x), std::min(box.south, p.y), std::max(box.east, p.x), std::max(box.north, p.y)};
    }
    return box;
  } catch (const base::UsageError&) {
    return std::nullopt;
  }
}

TransformFacts transform_to(ReferenceModel& model, const std::string& target) {
  if (model.polygons.empty()) {  // may lie nowhere: PROJ would refuse its CRS, and nobody would know of which file
    model.crs.horizontal = model.crs.name = target;
    model.crs.geographic = false;
    model.crs.metres_per_unit = 1;
    return {};
  }
  const auto facts = georef::crs_facts(target);
  if (!facts || !facts->projected || facts->metres_per_unit != 1.0)
    throw base::UsageError(target + " is no projected coordinate reference system in metres");
  const georef::Transform transform(model.crs.horizontal, target, extent_of(model));
  for_each_point(model, [&](model::Point3& p, const Polygon3& polygon) {
    const model::Point2 q = transform.forward(p.xy());
    if (!std::isfinite(q.x) || !std::isfinite(q.y))
      throw base::InputError(
          model.path, polygon.id, "lies where " + transform.operation() + " is not defined",
          "Is " + model.crs.name +
              " its coordinate reference system? --reference-crs (of the judged model: --model-crs) names another");
    p.x = q.x;
    p.y = q.y;
  });
  model.crs.horizontal = facts->authority_code.empty() ? target : facts->authority_code;
  model.crs.name = facts->name;
  model.crs.geographic = false;
  model.crs.metres_per_unit = 1;
  return {transform.operation(), transform.accuracy_m()};
}

}  // namespace blockrand::importers::reference
