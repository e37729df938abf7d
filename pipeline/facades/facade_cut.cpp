// Cuts what was asked for into the walls, places elements, and tells what was left out.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/facades/facade_builder.h"
#include "pipeline/facades/opening_proof.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/triangulate.h"

namespace blockrand::facades {

using model::BuildingPart;
using model::IssueCode;
using model::Point2;

std::optional<FacadeBuilder::Cut> FacadeBuilder::cut_all(const std::vector<WallFrame>& walls,
                                                         const std::vector<bool>& left_out,
                                                         std::int64_t* bad_face) const {
  Cut out;
  std::vector<WallOpening> openings = passage_openings();
  out.of_asked.assign(openings.size(), kNoAsked);
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    const model::Element& element = library_.element(asked_[i].element);
    if (element.opening.outline.empty() || (i < left_out.size() && left_out[i])) continue;
    WallOpening o;
    o.wall = asked_[i].wall;
    o.kind = element.semantic == model::ElementClass::door ? model::OpeningKind::door : model::OpeningKind::window;
    o.reveal = element.opening.reveal;
    o.storey = asked_[i].storey;
    for (const Point2& p : element.opening.outline) o.outline.push_back({p.x + asked_[i].at.x, p.y + asked_[i].at.y});
    openings.push_back(std::move(o));
    out.of_asked.push_back(i);
  }
  out.opened = cut_openings(*closed_.solid, walls, openings, rounding_);
  auto triangles = geometry::triangulate(out.opened.solid, *closed_.solid, *closed_.triangles, out.opened.triangles);
  const bool passages_checked = !checked_portals_.empty() && checked_portals_ == open_portals();
  if (!triangles) return std::nullopt;
  if (!proved_valid(out.opened, *triangles, passages_checked)) {
    const geometry::SolidCheck check = geometry::check_solid(out.opened.solid, *triangles, geometry::kBuilt);
    if (!check.valid()) {
      const int code = check.code();
      if (bad_face && code >= 100 && code < 300) *bad_face = check.first;
      return std::nullopt;
    }
  }
  out.triangles = std::move(*triangles);
  return out;
}

std::optional<FacadeBuilder::Cut> FacadeBuilder::cut_most(const std::vector<WallFrame>& walls) {
  std::vector<bool> left_out(asked_.size(), false);
  std::map<std::int64_t, int> steps;  // by face
  for (std::size_t tries = 0; tries < kMostTries; ++tries) {
    std::int64_t bad_face = -1;
    std::optional<Cut> made = cut_all(walls, left_out, &bad_face);
    if (made) {
      made->left_out = std::move(left_out);
      return made;
    }
    if (bad_face < 0) return std::nullopt;
    bool fewer = false;
    for (int& step = steps[bad_face]; !fewer && step < 3; ++step) fewer = thin(walls, bad_face, step, left_out);
    if (!fewer) return std::nullopt;
  }
  return std::nullopt;
}

bool FacadeBuilder::thin(const std::vector<WallFrame>& walls, std::int64_t face, int step,
                         std::vector<bool>& left_out) {
  bool fewer = false;
  std::size_t number = 0;
  for (std::size_t i = portal_elements_; i < asked_.size(); ++i) {
    const model::Element& element = library_.element(asked_[i].element);
    if (walls[asked_[i].wall].face != face || element.opening.outline.empty() || left_out[i]) continue;
    if (step == 0 && is_sunk_geometry(asked_[i]))
      stand_before(asked_[i]), fewer = true;
    else if (step == 2 || (step == 1 && element.semantic != model::ElementClass::door && number++ % 2 == 1))
      left_out[i] = fewer = true;
  }
  return fewer;
}

bool FacadeBuilder::is_sunk_geometry(const Asked& asked) const {
  const model::Element& element = library_.element(asked.element);
  return element.kind == kRuleGeometry && !element.opening.outline.empty();
}

void FacadeBuilder::stand_before(Asked& asked) {
  model::Element element = before_wall(library_.element(asked.element));
  const PartMaterials materials = library_.materials(asked.element);
  asked.element = library_.add_made(std::move(element), materials);
  ++before_wall_;
}

void FacadeBuilder::paint(model::Detail& detail) const {
  for (const auto& [face, look] : painted_) {
    const auto set = [&](model::Face& f) {
      if (f.kind == model::SurfaceKind::wall) f.material = look.material, f.colour = look.colour;
    };
    set(detail.solid.faces[face]);
    for (const model::Opening& o : detail.openings) {
      if (o.wall != face) continue;
      for (std::uint32_t i = 0; i < o.reveal_count; ++i) set(detail.solid.faces[o.first_reveal + i]);
    }
  }
}

void FacadeBuilder::apply_paint(model::Detail& detail, const std::vector<WallFrame>& walls,
                                const std::vector<bool>& opened) {
  std::vector<int> layers(walls.size(), 0);
  for (const PaintOrder& order : paint_orders_) {
    std::vector<std::vector<Point2>> openings;
    for (std::size_t i = 0; i < opened.size(); ++i) {
      if (!opened[i] || asked_[i].wall != order.wall) continue;
      auto& outline = openings.emplace_back();
      for (const Point2& p : library_.element(asked_[i].element).opening.outline)
        outline.push_back({p.x + asked_[i].at.x, p.y + asked_[i].at.y});
    }
    for (const PassagePortal& m : portals_)
      if (m.wall == order.wall && m.state == PortalState::open) openings.push_back(m.outline());
    auto paint = wall_paint(order, walls[order.wall], openings, layers[order.wall]);
    if (!paint) continue;
    ++layers[order.wall];
    PartMaterials looks{};
    looks[static_cast<std::size_t>(model::ElementPart::wall)] = order.look;
    const std::uint32_t element = library_.add_made(std::move(paint->element), looks);
    const WallFrame& wall = walls[order.wall];
    detail.placements.push_back(
        {element, model::snap(wall.at(paint->at)), wall.along, model::kNoOpening, wall.face, 0});
  }
}

void FacadeBuilder::cut(BuildingPart& part, const std::vector<WallFrame>& walls) {
  model::Detail& detail = part.lod3;
  part.lod = 3;
  const auto is_open = [](const PassagePortal& m) { return m.state == PortalState::open; };
  const bool passages = std::any_of(portals_.begin(), portals_.end(), is_open);
  if (asked_.empty() && !passages) {  // walls without openings are a facade, too
    detail.solid = *closed_.solid;
    detail.triangles = *closed_.triangles;
    paint(detail);
    apply_paint(detail, walls, {});
    apply_masonry(detail, walls, {});
    finish_told(part, 0);
    return;
  }
  std::optional<Cut> made = cut_all(walls);
  if (!made) made = cut_most(walls);  // the wall that folds alone suffers
  if (!made && passages) {
    const std::vector<Asked> rest(asked_.begin() + static_cast<std::ptrdiff_t>(portal_elements_), asked_.end());
    asked_.clear();
    close_open(PortalState::not_valid);
    close_portals();
    asked_.insert(asked_.end(), rest.begin(), rest.end());
    made = cut_all(walls);
    if (!made) made = cut_most(walls);
  }
  std::vector<std::uint32_t> opening_of(asked_.size(), model::kNoOpening);
  std::vector<bool> refused(asked_.size(), false);
  if (made) {
    for (std::size_t i = 0; i < made->of_asked.size(); ++i)
      if (made->of_asked[i] != kNoAsked) refused[made->of_asked[i]] = made->opened.refusals[i] != OpeningRefusal::none;
    for (std::size_t i = 0; i < made->left_out.size(); ++i)
      if (made->left_out[i]) refused[i] = true;
    for (std::uint32_t i = 0; i < made->opened.given.size(); ++i)
      if (const std::size_t of = made->of_asked[made->opened.given[i]]; of != kNoAsked) opening_of[of] = i;
    detail.solid = std::move(made->opened.solid);
    detail.triangles = std::move(made->triangles);
    detail.openings = std::move(made->opened.openings);
  } else {
    part.fallbacks.push_back(IssueCode::facade_failed);
    report_.add(part.osm, IssueCode::facade_failed, part.id);
    for (std::size_t i = 0; i < asked_.size(); ++i)
      refused[i] = !library_.element(asked_[i].element).opening.outline.empty();
    detail.solid = *closed_.solid;
    detail.triangles = *closed_.triangles;
  }
  paint(detail);
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    if (refused[i] && is_sunk_geometry(asked_[i])) {
      stand_before(asked_[i]);
    } else if (refused[i]) {
      ++left_out;
      continue;
    }
    const WallFrame& wall = walls[asked_[i].wall];
    detail.placements.push_back({asked_[i].element, model::snap(wall.at(asked_[i].at)), wall.along, opening_of[i],
                                 wall.face, asked_[i].storey});
  }
  std::vector<bool> opened(asked_.size());
  for (std::size_t i = 0; i < asked_.size(); ++i) opened[i] = opening_of[i] != model::kNoOpening;
  apply_paint(detail, walls, opened);
  apply_masonry(detail, walls, opened);
  finish_told(part, left_out);
}

void FacadeBuilder::finish_told(BuildingPart& part, std::size_t left_out) {
  left_out += missed_doors_;
  if (yielding_geometry_ > 0)
    report_.add(part.osm, IssueCode::opening_left_out,
                fmt::format("{}: {} leaves of rules yield to a passage", part.id, yielding_geometry_));
  if (before_wall_ > 0) {
    part.fallbacks.push_back(IssueCode::opening_left_out);
    report_.add(
        part.osm, IssueCode::opening_left_out,
        fmt::format("{}: {} bodies of rules stand before the wall: it takes no opening there", part.id, before_wall_));
  }
  if (left_out > 0) {
    part.fallbacks.push_back(IssueCode::opening_left_out);
    std::string what = fmt::format("{}: {} of {}", part.id, left_out, asked_.size() + missed_doors_);
    if (yielding_ > 0) what += fmt::format(", {} yield to a passage", yielding_);
    report_.add(part.osm, IssueCode::opening_left_out, std::move(what));
  }
  for (const PassagePortal& m : portals_) {
    if (m.state == PortalState::open) continue;
    if (part.fallbacks.empty() || part.fallbacks.back() != IssueCode::opening_left_out)
      part.fallbacks.push_back(IssueCode::opening_left_out);
    report_.add(part.osm, IssueCode::opening_left_out,
                fmt::format("{}: a passage in a {} front: {}", part.id, model::name(m.front), name(m.state)));
  }
  for (const std::string& what : told_) report_.add(part.osm, IssueCode::grammar_error, part.id + ": " + what);
  if (!dropped_.empty()) part.fallbacks.push_back(IssueCode::leaf_dropped);
  for (const auto& [what, count] : dropped_)
    report_.add(part.osm, IssueCode::leaf_dropped, fmt::format("{}: {} ({})", part.id, what, count));
}

}  // namespace blockrand::facades
