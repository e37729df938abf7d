#include "pipeline/attributes/area_set.h"

#include "styles/districts/rule_set.h"

namespace blockrand::attributes {

namespace {

/// The index wants metres: a hundredth of 1e-7 degrees is about one.
model::Point2 in_index(model::Location p) { return {p.lon * 0.01, p.lat * 0.01}; }

geometry::PlanBox box_of(const AreaRings& rings) {
  geometry::PlanBox box;
  for (const auto& ring : rings)
    for (const model::Location p : ring) box.include(in_index(p));
  return box;
}

double size(const geometry::PlanBox& b) { return (b.maximum.x - b.minimum.x) * (b.maximum.y - b.minimum.y); }

}  // namespace

bool holds(const AreaRings& rings, model::Location place) {
  bool inside = false;
  for (const auto& ring : rings) inside ^= districts::holds(ring, place);
  return inside;
}

AreaSet::AreaSet(std::vector<MappedArea> areas) : areas_(std::move(areas)) {
  std::vector<geometry::PlanBox> boxes;
  for (const MappedArea& a : areas_) boxes.push_back(box_of(a.rings));
  index_ = geometry::BoxIndex(std::move(boxes));
}

bool AreaSet::holds(model::Location place) const {
  if (areas_.empty()) return false;
  geometry::PlanBox at;
  at.include(in_index(place));
  for (const std::uint32_t i : index_.near(at, 0))
    if (attributes::holds(areas_[i].rings, place)) return true;
  return false;
}

const MappedArea* AreaSet::smallest(model::Location place) const {
  if (areas_.empty()) return nullptr;
  geometry::PlanBox at;
  at.include(in_index(place));
  const MappedArea* best = nullptr;
  double least = 0;
  for (const std::uint32_t i : index_.near(at, 0)) {
    if (!attributes::holds(areas_[i].rings, place)) continue;
    const double s = size(index_.box(i));
    if (best == nullptr || s < least || (s == least && areas_[i].id < best->id)) {
      best = &areas_[i];
      least = s;
    }
  }
  return best;
}

}  // namespace blockrand::attributes
