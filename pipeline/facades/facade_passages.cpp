// Passages through a part: which of them the solid takes, and what stands in the portals of the others.

#include <algorithm>
#include <vector>

#include "pipeline/facades/facade_builder.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/triangulate.h"

namespace blockrand::facades {

using model::BuildingPart;

bool FacadeBuilder::takes_passages(const BuildingPart& part, const std::vector<WallFrame>& walls) {
  const std::vector<WallOpening> openings = passage_openings();
  if (openings.empty()) return true;
  const OpenedSolid opened = cut_openings(part.lod2, walls, openings, rounding_);
  std::size_t i = 0;
  for (PassagePortal& m : portals_)
    if (m.state == PortalState::open && opened.refusals[i++] != OpeningRefusal::none) m.state = PortalState::blocked;
  const auto triangles = geometry::triangulate(opened.solid, part.lod2, part.lod2_triangles);
  if (!triangles || !geometry::check_solid(opened.solid, *triangles, geometry::kBuilt).valid()) return false;
  checked_portals_ = opened.changed_borders.empty() ? open_portals() : std::vector<bool>{};
  return true;
}

std::vector<bool> FacadeBuilder::open_portals() const {
  std::vector<bool> out;
  for (const PassagePortal& m : portals_) out.push_back(m.state == PortalState::open);
  return out;
}

void FacadeBuilder::try_passages(const BuildingPart& part, const std::vector<WallFrame>& walls) {
  if (takes_passages(part, walls)) return;
  std::vector<PassagePortal*> tried;
  for (PassagePortal& m : portals_)
    if (m.state == PortalState::open && &portals_[m.other] > &m) tried.push_back(&m);
  close_open(PortalState::not_valid);
  for (PassagePortal* m : tried) {
    PassagePortal& other = portals_[m->other];
    if (m->state != PortalState::not_valid || other.state != PortalState::not_valid) continue;
    m->state = other.state = PortalState::open;
    if (!takes_passages(part, walls)) m->state = other.state = PortalState::not_valid;
  }
}

void FacadeBuilder::close_open(PortalState why) {
  for (PassagePortal& m : portals_)
    if (m.state == PortalState::open) m.state = why;
}

std::vector<WallOpening> FacadeBuilder::passage_openings() const {
  std::vector<std::uint32_t> number(portals_.size(), model::kNoOpening);
  std::uint32_t count = 0;
  for (std::size_t m = 0; m < portals_.size(); ++m)
    if (portals_[m].state == PortalState::open) number[m] = count++;
  std::vector<WallOpening> out;
  for (const PassagePortal& m : portals_)
    if (m.state == PortalState::open)
      out.push_back({m.wall, model::OpeningKind::passage, m.outline(), 0, 0, number[m.other]});
  return out;
}

void FacadeBuilder::close_portals() {
  for (const PassagePortal& m : portals_) {
    const bool open = m.state == PortalState::open;
    if (open && m.front != model::WallSegmentKind::street) continue;
    const bool cart = m.right - m.left >= kLeastGate;
    const std::string_view name = open ? "surround" : cart ? "carriage_gateway" : "house_door";
    const elements::ElementKind& kind = *grammars_.elements().find(name);
    const double width = std::min(ElementLibrary::size(m.right - m.left), kind.width.most);
    const double height = std::min(ElementLibrary::size(m.high - m.low), kind.height.most);
    if (width < kind.width.least || height < kind.height.least) continue;
    library_.ask(name, width, height, usual_materials_);
    library_.add("head", std::string_view("straight"));
    library_.add("surround", std::string_view(open ? "plain" : "none"));
    if (!open) library_.add("reveal", 0.3);
    place(m.wall, {(m.left + m.right) / 2, m.low}, 0);
  }
  portal_elements_ = asked_.size();
}

}  // namespace blockrand::facades
