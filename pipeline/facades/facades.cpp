#include "pipeline/facades/facades.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/parallel.h"
#include "pipeline/base/random.h"
#include "pipeline/facades/bodies_on_roofs.h"
#include "pipeline/facades/facade_builder.h"
#include "pipeline/facades/wall_corners.h"
#include "styles/grammar/shapes/split.h"

namespace blockrand::facades {

using model::BuildingPart;
using model::IssueCode;
using model::Point2;

void FacadeBuilder::build(model::Building& building, BuildingPart& part, masses::BuiltMass* mass) {
  if (building.replaced || part.lod < 2 || part.lod2.empty() || part.canopy) return;
  // An order for a part alone gives it a front of its own.
  const GrammarLibrary::Entry* grammar = grammars_.find(part.attributes.preset.value);
  if (!grammar) return;
  closed_ = {&part.lod2, &part.lod2_triangles};
  std::vector<WallFrame> walls;
  for (std::uint32_t f = 0; f < part.lod2.faces.size(); ++f)
    if (auto wall = wall_frame(part.lod2, f)) walls.push_back(std::move(*wall));
  rounding_ = building.parts.size() > 1 ? CornerRounding::behind_wall : CornerRounding::nearest;
  asked_.clear();
  told_.clear();
  dropped_.clear();
  painted_.clear();
  paint_orders_.clear();
  usual_materials_ = library_.usual_materials(part);
  const std::uint64_t seed = base::random_bits(options_.seed, building.osm.key(), "facades");
  const std::uint64_t row =
      base::random_bits(options_.seed, base::hash_text(building.situation.block), "row of facades");
  std::vector<FacadeSegment> segments = facade_segments(building, walls);
  portal_elements_ = yielding_ = missed_doors_ = before_wall_ = yielding_geometry_ = 0;
  checked_portals_.clear();
  portals_.clear();
  if (grammar->on_footprint)
    return build_on_footprint(*grammar, building, part, walls, segments, eaves_level(part), seed, row);
  portals_ = take_portals(part, walls, segments);
  const double eaves = eaves_level(part);
  link_corners(segments, walls, eaves);
  if (!portals_.empty()) {
    try_passages(part, walls);
    close_portals();
  }
  take_parameters(*grammar, building, part);
  memo_.values.clear();
  for (const FacadeSegment& segment : segments) {
    if (segment.kind == model::WallSegmentKind::party_wall || segment.kind == model::WallSegmentKind::unknown) {
      paint_edge({building, part, walls[segment.wall], segment, eaves, nullptr, &defaults_});
      continue;
    }
    derive_segment(*grammar, {building, part, walls[segment.wall], segment, eaves, nullptr, &defaults_}, seed, row);
  }
  tell_unpainted(building, part);
  note_masonry(part, walls, segments, seed);
  furnished_.reset();
  if (mass && grammar->roof && main_body(building) == &part) {
    furnish(*grammar, building, part, *mass, walls, segments, eaves, seed, row);
    if (furnished_) {
      closed_ = {&furnished_->solid, &furnished_->triangles};
      checked_portals_.clear();  // of another body
    }
  }
  cut(part, walls);
  if (furnished_) {
    mass->roof = std::move(furnished_->roof);
    part.lod3.roof_elements = mass->roof.elements;
    part.lod3.roof_fronts = std::move(furnished_->fronts);
  }
}

void FacadeBuilder::derive_segment(const GrammarLibrary::Entry& grammar, const FacadeContext& context,
                                   std::uint64_t seed, std::uint64_t row) {
  const WallFrame& wall = context.wall;
  grammar::Shape shape = wall_shape(wall);
  if (context.segment.from > 0 || context.segment.to < wall.length)
    shape = grammar::cut_piece(shape, 0, context.segment.from, context.segment.to, false);
  grammar::DeriveOptions& options = derive_options_;
  const std::string place =
      fmt::format("{}/{}/{}", context.part.id, wall.face, static_cast<int>(std::floor(context.segment.from * 16)));
  options.seed = base::random_bits(seed, base::hash_text(place), "stretch");
  options.building_seed = seed;
  options.row_seed = row;
  options.source = [&](std::string_view name) { return context_value(context, name); };
  options.limits.shapes = options_.most_shapes;
  const grammar::Derivation derivation = grammar.deriver->run(shape, options);
  for (const grammar::Diagnostic& d : derivation.diagnostics)
    if (d.severity == grammar::Severity::error) tell(d.message);
  paint_edge(context);
  std::optional<RuleGeometry> made;
  if (grammar.makes_geometry) made = geometry_of(context, derivation.leaves);
  for (const grammar::Leaf& leaf : derivation.leaves)
    if (leaf.order) take(context, leaf);
  if (made) take_geometry(context, std::move(*made));
  // Where rules lay out no storeys, as in blind walls, they are even.
  for (const StoreyLook& look : storey_looks(context)) {
    const std::string name = fmt::format("storey {}", look.storey);
    const bool painted = std::ranges::any_of(paint_orders_, [&](const PaintOrder& o) {
      return o.wall == context.segment.wall && o.name == name && o.left < context.segment.to - 0.01 &&
             o.right > context.segment.from + 0.01;
    });
    if (!painted)
      add_paint(context, context.segment.from, context.segment.to, look.low, look.high, look.colour, look.material,
                name);
  }
}

void FacadeBuilder::take_parameters(const GrammarLibrary::Entry& grammar, const model::Building& building,
                                    const BuildingPart& part) {
  static const decltype(parameters_) kNone;
  const bool own = part.attributes.preset.value != building.attributes.preset.value;
  const auto& wanted = own && !building.attributes.preset.value.empty() ? kNone : building.preset_parameters;
  if (derived_for_ == &grammar && parameters_ == wanted) return;
  derived_for_ = &grammar;
  parameters_ = wanted;
  auto& attributes = derive_options_.attributes;
  attributes.clear();
  // The first of a name counts: what district rules and overrides say is stronger than the preset's own values.
  for (const auto& [name, value] : parameters_) attributes.emplace_back(name, value);
  attributes.insert(attributes.end(), grammar.attributes.begin(), grammar.attributes.end());
  outside_ = grammar.deriver->outside_values(attributes);
  derive_options_.outside = &outside_;
  derive_options_.orders_only = !grammar.makes_geometry;
  derive_options_.memo = &memo_;
  derive_options_.is_shared = &is_of_part;
}

grammar::Shape FacadeBuilder::wall_shape(const WallFrame& wall) {
  auto mesh = std::make_shared<grammar::Mesh>();
  grammar::MeshFace face;
  for (const auto& loop : wall.loops) {
    auto& corners = face.loops.emplace_back();
    // The outline begins with its lowest edge from the left.
    std::size_t first = 0;
    for (std::size_t i = 1; i < loop.size(); ++i)
      if (std::pair(loop[i].y, loop[i].x) < std::pair(loop[first].y, loop[first].x)) first = i;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point2& p = loop[(first + i) % loop.size()];
      corners.push_back({static_cast<std::uint32_t>(mesh->vertices.size()), 0});
      mesh->vertices.push_back({p.x, p.y, 0});
    }
  }
  mesh->faces.push_back(std::move(face));
  grammar::Shape shape;
  shape.size = {wall.length, wall.height, 0};
  shape.mesh = std::move(mesh);
  return shape;
}

void build_facades(model::Region& region, const GrammarLibrary& grammars, const attributes::Defaults& defaults,
                   const FacadeOptions& options, masses::BuiltMasses* masses) {
  // Buildings of a stretch are built by themselves; their elements become those of the region in the order of the stretches, as if there
  // had been one.
  struct Stretch {
    model::Region made;  ///< report and elements
    std::unique_ptr<ElementLibrary> library;
  };
  const std::vector<std::size_t> begins = base::stretches_to_share(region.buildings.size());
  std::vector<Stretch> stretches(begins.size() - 1);
  base::share(stretches.size(), [&](std::size_t i) {
    Stretch& stretch = stretches[i];
    stretch.library = std::make_unique<ElementLibrary>(stretch.made, defaults, grammars.elements());
    FacadeBuilder builder(stretch.made.report, *stretch.library, grammars, defaults, options, region.extract);
    for (std::size_t b = begins[i]; b < begins[i + 1]; ++b) {
      model::Building& building = region.buildings[b];
      if (!building.owned) continue;
      for (const std::string& order : unread_overrides(building))
        stretch.made.report.add(building.osm, IssueCode::parameter_unread, order);
      for (const auto& [key, value] : building.preset_parameters)
        if (!grammars.any_reads(key))
          stretch.made.report.add(building.osm, IssueCode::parameter_unread,
                                  fmt::format("{} = {}: no rule file of any preset asks for it", key, value));
      for (std::uint32_t p = 0; p < building.parts.size(); ++p)
        builder.build(building, building.parts[p], masses ? masses->find({static_cast<std::uint32_t>(b), p}) : nullptr);
    }
  });
  ElementLibrary library(region, defaults, grammars.elements());
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    region.report.append(std::move(stretches[i].made.report));
    const std::vector<std::uint32_t> numbers = library.take_over(*stretches[i].library);
    for (std::size_t b = begins[i]; b < begins[i + 1]; ++b)
      for (BuildingPart& part : region.buildings[b].parts)
        for (model::Placement& placement : part.lod3.placements) placement.element = numbers[placement.element];
  }
}

}  // namespace blockrand::facades
