// Stones on walls: where presets, rules or overrides ask for masonry that is fitted to the wall.
#include <algorithm>
#include <utility>

#include "pipeline/base/random.h"
#include "pipeline/facades/facade_builder.h"

namespace blockrand::facades {

using model::Point2;
using model::WallSegmentKind;

namespace {

/// Degrees. Chords of round walls turn less: their stones end at the edge.
constexpr double kCornerTurn = 30, kSharpestCorner = 135;
/// Mortar where no colour of it is ordered: lime mortar with the sand of the region is light and grey.
constexpr model::Colour kMortarOfBricks{0xc9, 0xc1, 0xb2}, kMortarOfStones{0xa8, 0x9f, 0x8e};
/// m. What reaches no farther out than the mortar hides no stone.
constexpr double kHides = 0.03;

bool looks_outside(WallSegmentKind kind) {
  return kind != WallSegmentKind::party_wall && kind != WallSegmentKind::unknown;
}

model::PartMaterial brightened(model::PartMaterial look, double by) {
  const auto channel = [&](std::uint8_t c) { return static_cast<std::uint8_t>(std::clamp(c * by, 0.0, 255.0)); };
  look.colour = {channel(look.colour.r), channel(look.colour.g), channel(look.colour.b)};
  return look;
}

}  // namespace

void FacadeBuilder::note_masonry(const model::BuildingPart& part, const std::vector<WallFrame>& walls,
                                 const std::vector<FacadeSegment>& segments, std::uint64_t seed) {
  masonry_runs_.clear();
  std::vector<std::string> complaints;
  masonry_orders_ = read_masonry_orders(derive_options_.attributes, complaints);
  for (const std::string& complaint : complaints) tell(complaint);
  if (!masonry_orders_) return;
  const auto laid = [&](WallSegmentKind kind) {
    return looks_outside(kind) && (!masonry_orders_->street_only || kind == WallSegmentKind::street);
  };
  const auto corner = [&](double turn, const std::optional<WallSegmentKind>& next) {
    return turn > kCornerTurn && turn < kSharpestCorner && next && laid(*next) ? turn : 0.0;
  };
  for (const FacadeSegment& s : segments) {
    if (!laid(s.kind)) continue;
    const WallFrame& wall = walls[s.wall];
    MasonryRun run{s.wall, s.from, s.to, part.attributes.ground_height.value - wall.base, 0, 0, 0};
    if (s.starts_wall) run.turn_left = corner(s.turn_left, s.kind_left);
    if (s.ends_wall) run.turn_right = corner(s.turn_right, s.kind_right);
    run.seed = base::random_bits(seed, wall.face * 4096ULL + static_cast<std::uint64_t>(s.from * 16), "masonry");
    masonry_runs_.push_back(run);
  }
}

std::optional<std::pair<masonry::Bond, MasonryLook>> FacadeBuilder::masonry_look(std::uint32_t face) const {
  const MasonryOrders& orders = *masonry_orders_;
  const auto painted = painted_.find(face);
  const model::PartMaterial wall = painted != painted_.end()
                                       ? painted->second
                                       : usual_materials_[static_cast<std::size_t>(model::ElementPart::wall)];
  const int brick = defaults_.material("brick"), stone = defaults_.material("stone");
  std::optional<masonry::Bond> bond = orders.bond;
  if (!bond && wall.material == brick) bond = masonry::Bond::english;
  if (!bond && wall.material == stone) bond = masonry::Bond::ashlar;
  if (!bond) return std::nullopt;
  const bool of_bricks = masonry::is_brick(*bond);
  MasonryLook look;
  look.stones = wall;
  // A wall that is tagged as plaster and ordered to show its stones has their usual colour.
  if (const int wanted = of_bricks ? brick : stone; wanted >= 0 && wall.material != wanted)
    look.stones = {static_cast<std::uint8_t>(wanted), defaults_.materials[static_cast<std::size_t>(wanted)].colour};
  if (orders.colour) look.stones.colour = *orders.colour;
  look.mortar = {usual_materials_[static_cast<std::size_t>(model::ElementPart::surround)].material,
                 orders.mortar.value_or(of_bricks ? kMortarOfBricks : kMortarOfStones)};
  look.dressings = brightened(look.stones, of_bricks ? 0.84 : 1.12);
  if (orders.dressings) look.dressings.colour = *orders.dressings;
  return std::pair{*bond, look};
}

void FacadeBuilder::apply_masonry(model::Detail& detail, const std::vector<WallFrame>& walls,
                                  const std::vector<bool>& opened) {
  if (!masonry_orders_) return;
  for (const MasonryRun& run : masonry_runs_) {
    const WallFrame& wall = walls[run.wall];
    const auto chosen = masonry_look(wall.face);
    if (!chosen) continue;
    std::vector<std::vector<Point2>> openings, covered;
    for (std::size_t i = 0; i < asked_.size(); ++i) {
      if (asked_[i].wall != run.wall) continue;
      const model::Element& element = library_.element(asked_[i].element);
      if (i < opened.size() && opened[i]) {
        auto& outline = openings.emplace_back();
        for (const Point2& p : element.opening.outline) outline.push_back({p.x + asked_[i].at.x, p.y + asked_[i].at.y});
        continue;
      }
      // Plinths and courses: bodies along the wall that lie on it all over.
      const elements::ElementKind* kind = grammars_.elements().find(element.kind);
      if (!kind || kind->width.measures != "run" || !element.opening.outline.empty()) continue;
      double left = 1e300, right = -1e300, low = 1e300, high = -1e300, out = 0;
      for (const model::Point3& v : element.mesh.vertices)
        left = std::min(left, v.x), right = std::max(right, v.x), low = std::min(low, v.y), high = std::max(high, v.y),
        out = std::max(out, v.z);
      if (out < kHides) continue;
      const Point2 at = asked_[i].at;
      covered.push_back({{left + at.x, low + at.y},
                         {right + at.x, low + at.y},
                         {right + at.x, high + at.y},
                         {left + at.x, high + at.y}});
    }
    for (const PassagePortal& m : portals_)
      if (m.wall == run.wall && m.state == PortalState::open) openings.push_back(m.outline());
    std::vector<std::string> complaints;
    const masonry::Masonry sizes = masonry_of(*masonry_orders_, chosen->first, complaints);
    for (const std::string& complaint : complaints) tell(complaint);
    WallMasonry made =
        wall_masonry(run, wall, sizes, masonry_orders_->most_triangles, chosen->second, openings, covered);
    for (const std::string& what : made.told) tell(what);
    for (MasonryBody& body : made.bodies) {
      PartMaterials looks{};
      looks[static_cast<std::size_t>(model::ElementPart::wall)] = body.look;
      const std::uint32_t element = library_.add_made(std::move(body.element), looks);
      detail.placements.push_back(
          {element, model::snap(wall.at({run.from, 0})), wall.along, model::kNoOpening, wall.face, 0});
    }
  }
}

}  // namespace blockrand::facades
