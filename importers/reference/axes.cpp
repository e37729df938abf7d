#include "importers/reference/axes.h"

#include <algorithm>
#include <utility>

#include "importers/reference/reference_crs.h"

namespace blockrand::importers::reference {

void Box::add(const model::Point3& p) {
  lowest = {std::min(lowest.x, p.x), std::min(lowest.y, p.y), std::min(lowest.z, p.z)};
  highest = {std::max(highest.x, p.x), std::max(highest.y, p.y), std::max(highest.z, p.z)};
}

Box box_of(const ReferenceModel& model) {
  Box box;
  for (const Polygon3& polygon : model.polygons)
    for (const model::Point3& p : polygon.outer) box.add(p);
  return box;
}

void settle_axes(ReferenceModel& model, const ReadOptions& options, NoteLog& notes) {
  if (model.polygons.empty()) return;
  const Box box = box_of(model);
  decide_axis_order(model.crs, box.lowest.xy(), box.highest.xy(), options, notes);
  if (model.crs.axis_order != AxisOrder::north_first) return;
  const auto swap = [](std::vector<model::Point3>& ring) {
    for (model::Point3& p : ring) std::swap(p.x, p.y);
  };
  for (Polygon3& polygon : model.polygons) {
    swap(polygon.outer);
    for (auto& hole : polygon.holes) swap(hole);
  }
}

}  // namespace blockrand::importers::reference
