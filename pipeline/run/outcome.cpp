#include "pipeline/run/outcome.h"

#include <algorithm>
#include <map>
#include <optional>

namespace blockrand::run {

namespace {

using model::IssueCode;
using model::ObjectState;
using model::Region;

/// Lowest level of detail among the parts that have a solid (or, where only footprints were asked for, a plan).
int achieved_lod(const std::vector<const model::BuildingPart*>& parts, int asked) {
  int lod = -1;
  for (const model::BuildingPart* p : parts) {
    if (p->lod < std::min(asked, 1)) continue;
    lod = lod < 0 ? p->lod : std::min(lod, p->lod);
  }
  return lod;
}

}  // namespace

Outcomes decide_outcomes(const Region& region, int asked) {
  Outcomes out;
  const auto decide = [&](std::uint32_t index, const std::vector<const model::BuildingPart*>& own, IssueCode failure,
                          bool replaced = false) {
    const int lod = achieved_lod(own, asked);
    if (lod >= 0) {
      out.list.push_back({index, ObjectState::modelled, IssueCode::none, {}, lod});
      if (lod < asked && !replaced) out.below_quality = true;  // a model that was ordered is what was asked for
      return true;
    }
    out.list.push_back(
        {index, ObjectState::reported, failure == IssueCode::none ? IssueCode::no_solid : failure, {}, -1});
    out.below_quality = true;
    return false;
  };
  for (const model::Building& building : region.buildings) {
    if (building.settled != ObjectState::pending) {
      out.list.push_back({building.mapped_index, building.settled, IssueCode::none, building.related, -1});
      continue;
    }
    std::vector<const model::BuildingPart*> own;
    std::map<std::uint32_t, std::vector<const model::BuildingPart*>> of_part;
    for (const model::BuildingPart& part : building.parts)
      (part.mapped_index == building.mapped_index ? own : of_part[part.mapped_index]).push_back(&part);
    std::optional<model::OsmId> representative;
    for (const auto& [index, parts] : of_part)
      if (decide(index, parts, IssueCode::none) && !representative) representative = parts.front()->osm;
    if (own.empty() && representative)
      out.list.push_back({building.mapped_index, ObjectState::represented, IssueCode::none, *representative, -1});
    else
      decide(building.mapped_index, own, building.failure, building.replaced != nullptr);
  }
  for (const model::SettledPart& part : region.settled_parts)
    out.list.push_back({part.mapped_index, part.state, IssueCode::none, part.related, -1});
  for (const model::PartFailure& failure : region.part_failures) {
    out.list.push_back({failure.mapped_index, ObjectState::reported, failure.code, {}, -1});
    out.below_quality = true;
  }
  return out;
}

}  // namespace blockrand::run
