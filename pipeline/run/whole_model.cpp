#include "pipeline/run/whole_model.h"

#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

namespace blockrand::run {

namespace {

/// After its table of evidence became the end of a larger one.
void move_evidence(model::Building& building, model::EvidenceId offset) {
  const auto move = [offset](model::Attributes& a) {
    model::for_each_attribute(
        a,
        [offset](std::string_view, std::string_view, auto& value) {
          if (value.evidence != 0) value.evidence += offset;
        },
        [](std::string_view, std::string_view) {});
  };
  move(building.attributes);
  for (model::BuildingPart& part : building.parts) move(part.attributes);
}

}  // namespace

void append_region(model::Region& whole, model::Region&& tile, bool with_evidence) {
  whole.extract = tile.extract;
  whole.materials = std::move(tile.materials);
  if (with_evidence) {
    const model::EvidenceId offset = whole.evidence.append(std::move(tile.evidence));
    for (model::Building& b : tile.buildings) move_evidence(b, offset);
  }
  // Placements count the elements of their tile.
  const auto elements = static_cast<std::uint32_t>(whole.elements.size());
  std::move(tile.elements.begin(), tile.elements.end(), std::back_inserter(whole.elements));
  for (model::Building& b : tile.buildings)
    for (model::BuildingPart& part : b.parts)
      for (model::Placement& p : part.lod3.placements) p.element += elements;
  std::move(tile.buildings.begin(), tile.buildings.end(), std::back_inserter(whole.buildings));
}

}  // namespace blockrand::run
