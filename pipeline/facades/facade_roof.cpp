// What rules order on roofs: dormers, cross gables, and the windows in their fronts and in gables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/facades/bodies_on_roofs.h"
#include "pipeline/facades/facade_builder.h"
#include "pipeline/geometry/polygon_measures.h"
#include "styles/grammar/shapes/split.h"

namespace blockrand::facades {

using model::BuildingPart;
using model::IssueCode;
using model::Point2;

void FacadeBuilder::furnish(const GrammarLibrary::Entry& grammar, const model::Building& building, BuildingPart& part,
                            masses::BuiltMass& mass, std::vector<WallFrame>& walls,
                            const std::vector<FacadeSegment>& segments, double eaves, std::uint64_t seed,
                            std::uint64_t row) {
  if (segments.empty()) return;
  take_roof_parameters(grammar, seed, row);
  if (grammar.roof_makes_geometry) tell("rules for roofs place elements; other geometry of theirs is not built");
  WindowsBelow windows = windows_below();
  // The values are those of the building: the segment that rules see is its main front, else its first wall.
  const FacadeSegment* front = &segments.front();
  for (const FacadeSegment& s : segments)
    if (s.kind == model::WallSegmentKind::street && (front->kind != s.kind || s.length() > front->length())) front = &s;
  FacadeContext context{building, part, walls[front->wall], *front, eaves, &windows, &defaults_};
  const grammar::Derivation values = derive_roof(context, "Roof", {});
  std::vector<std::string> complaints;
  const RoofOrders orders = read_roof_orders(values.attributes, complaints);
  for (const std::string& complaint : complaints) tell(complaint);
  mass.gable = orders.gable;
  mass.edge_orders = orders.edges;
  const std::vector<model::RoofEdge> edges = edges_of_plan(building, part, mass.plan);
  std::vector<WindowAxes> axes = window_axes(walls, part);
  furnished_ = furnish_roof(building, part, mass, edges, axes, orders);
  if (furnished_ && furnished_->left_out > 0) {
    part.fallbacks.push_back(IssueCode::roof_element_left_out);
    report_.add(part.osm, IssueCode::roof_element_left_out,
                fmt::format("dormers, cross gables: {}", furnished_->left_out));
  }
  if (furnished_ && furnished_->fronts.empty()) furnished_.reset();
  if (furnished_) {
    walls.clear();
    for (std::uint32_t f = 0; f < furnished_->solid.faces.size(); ++f)
      if (auto wall = wall_frame(furnished_->solid, f)) walls.push_back(std::move(*wall));
  }
  const std::size_t below = asked_.size();
  if (furnished_)
    for (const RoofFront& f : furnished_->fronts) derive_front(context, walls, segments, f);
  for (const FacadeSegment& s : segments) derive_gable(context, walls, s);
  keep_within(walls, below);
}

WindowsBelow FacadeBuilder::windows_below() const {
  WindowsBelow out;
  std::int32_t top = -1;
  for (std::size_t i = portal_elements_; i < asked_.size(); ++i) {
    const model::Element& element = library_.element(asked_[i].element);
    if (element.semantic != model::ElementClass::window || element.opening.outline.empty() || asked_[i].storey <= top)
      continue;
    if (element.kind == kRuleGeometry || (element.kind == "shop_window" && !out.kind.empty())) continue;
    top = asked_[i].storey;
    out.kind = element.kind;
    out.width = width_of(element);
    out.frame_colour =
        model::text(library_.materials(asked_[i].element)[static_cast<std::size_t>(model::ElementPart::frame)].colour);
  }
  return out;
}

double FacadeBuilder::width_of(const model::Element& element) {
  double low = 1e300, high = -1e300;
  for (const Point2& p : element.opening.outline) low = std::min(low, p.x), high = std::max(high, p.x);
  return high - low;
}

std::vector<WindowAxes> FacadeBuilder::window_axes(const std::vector<WallFrame>& walls,
                                                   const BuildingPart& part) const {
  std::vector<WindowAxes> out;
  for (const Asked& asked : asked_) {
    const model::Element& element = library_.element(asked.element);
    if (element.semantic != model::ElementClass::window || element.opening.outline.empty() ||
        element.kind == kRuleGeometry)
      continue;
    const std::int32_t edge = part.lod2.faces[walls[asked.wall].face].edge;
    if (edge < 0) continue;
    auto of = std::find_if(out.begin(), out.end(), [&](const WindowAxes& a) { return a.edge == edge; });
    if (of == out.end()) of = out.insert(out.end(), WindowAxes{edge, {}});
    of->places.push_back(walls[asked.wall].at({asked.at.x, 0}).xy());
  }
  return out;
}

grammar::Derivation FacadeBuilder::derive_roof(const FacadeContext& context, const char* rule,
                                               const grammar::Shape& shape, std::string_view place) {
  grammar::DeriveOptions& options = roof_options_;
  options.start_rule = rule;
  options.seed = base::random_bits(options.building_seed,
                                   base::hash_text(fmt::format("{}/{}/{}", context.part.id, rule, place)), "roof");
  options.source = [&](std::string_view name) { return context_value(context, name); };
  options.orders_only = shape.mesh != nullptr;
  grammar::Derivation out = roof_rules_->run(shape, options);
  for (const grammar::Diagnostic& d : out.diagnostics)
    if (d.severity == grammar::Severity::error) tell(d.message);
  return out;
}

void FacadeBuilder::take_roof_parameters(const GrammarLibrary::Entry& grammar, std::uint64_t seed, std::uint64_t row) {
  if (roof_rules_ != grammar.roof || roof_options_.attributes != derive_options_.attributes) {
    roof_rules_ = grammar.roof;
    roof_options_.attributes = derive_options_.attributes;
    roof_outside_ = grammar.roof->outside_values(roof_options_.attributes);
    roof_options_.outside = &roof_outside_;
    roof_options_.memo = &roof_memo_;
    roof_options_.is_shared = &is_of_part;
    roof_options_.limits.shapes = options_.most_shapes;
  }
  roof_options_.building_seed = seed;
  roof_options_.row_seed = row;
  roof_memo_.values.clear();
}

void FacadeBuilder::derive_front(const FacadeContext& main, const std::vector<WallFrame>& walls,
                                 const std::vector<FacadeSegment>& segments, const RoofFront& front) {
  const auto wall = std::find_if(walls.begin(), walls.end(), [&](const WallFrame& w) { return w.face == front.face; });
  if (wall == walls.end()) return;
  const double middle =
      (front.middle.x - wall->start.x) * wall->along.x + (front.middle.y - wall->start.y) * wall->along.y;
  FacadeSegment piece;
  piece.wall = static_cast<std::uint32_t>(wall - walls.begin());
  piece.from = std::max(0.0, middle - front.width / 2);
  piece.to = std::min(wall->length, middle + front.width / 2);
  piece.kind = model::WallSegmentKind::unknown;
  // It looks where the wall below looks.
  for (const FacadeSegment& s : segments)
    if (walls[s.wall].face == static_cast<std::uint32_t>(front.edge) + 1 &&
        (piece.kind == model::WallSegmentKind::unknown || s.kind == model::WallSegmentKind::street))
      piece.kind = s.kind, piece.edges = s.edges;
  const char* rule = front.kind == model::RoofElementKind::dormer ? "DormerFront" : "CrossGableFront";
  derive_piece(main, *wall, piece, std::max(0.0, front.foot - wall->base), rule);
}

void FacadeBuilder::derive_gable(const FacadeContext& main, const std::vector<WallFrame>& walls,
                                 const FacadeSegment& segment) {
  const WallFrame& wall = walls[segment.wall];
  const double foot = std::clamp(main.eaves - wall.base, 0.0, wall.height);
  if (segment.kind == model::WallSegmentKind::party_wall || wall.height - foot < kLeastGable) return;
  // Of a front with cross gables those alone rise above the eaves.
  if (furnished_)
    for (const RoofFront& f : furnished_->fronts)
      if (f.kind == model::RoofElementKind::cross_gable && f.face == wall.face) return;
  derive_piece(main, wall, segment, foot, "Gable");
}

void FacadeBuilder::derive_piece(const FacadeContext& main, const WallFrame& wall, const FacadeSegment& piece,
                                 double foot, const char* rule) {
  grammar::Shape shape = wall_shape(wall);
  if (piece.from > 0 || piece.to < wall.length) shape = grammar::cut_piece(shape, 0, piece.from, piece.to, false);
  if (foot > 0) shape = grammar::cut_piece(shape, 1, foot, wall.height, false);
  if (!shape.mesh || shape.mesh->faces.empty()) return;
  FacadeContext context{main.building, main.part, wall, piece, main.eaves, main.windows, &defaults_};
  const std::string place = fmt::format("{}/{}", wall.face, static_cast<int>(std::floor(piece.from * 16)));
  for (const grammar::Leaf& leaf : derive_roof(context, rule, shape, place).leaves)
    if (leaf.order) take(context, leaf);
}

void FacadeBuilder::keep_within(const std::vector<WallFrame>& walls, std::size_t first) {
  const auto outside = [&](const Asked& asked) {
    const model::Element& element = library_.element(asked.element);
    const auto& outer = walls[asked.wall].loops[0];
    for (const Point2& p : element.opening.outline) {
      const Point2 q{p.x + asked.at.x, p.y + asked.at.y};
      if (!geometry::contains(outer, q)) return true;
      for (std::size_t i = 0; i < outer.size(); ++i)
        if (geometry::distance_to_segment(q, outer[i], outer[(i + 1) % outer.size()]) < kFrontBorder) return true;
    }
    return false;
  };
  asked_.erase(std::remove_if(asked_.begin() + static_cast<std::ptrdiff_t>(first), asked_.end(), outside),
               asked_.end());
}

}  // namespace blockrand::facades
