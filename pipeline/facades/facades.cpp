#include "pipeline/facades/facades.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/parallel.h"
#include "pipeline/base/random.h"
#include "pipeline/facades/bodies_on_roofs.h"
#include "pipeline/facades/element_library.h"
#include "pipeline/facades/facade_context.h"
#include "pipeline/facades/opening_proof.h"
#include "pipeline/facades/openings.h"
#include "pipeline/facades/passages.h"
#include "pipeline/facades/roof_elements.h"
#include "pipeline/facades/rule_geometry.h"
#include "pipeline/facades/wall_corners.h"
#include "pipeline/facades/wall_paint.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "styles/elements/make_element.h"
#include "styles/grammar/shapes/scope.h"
#include "styles/grammar/shapes/split.h"

namespace blockrand::facades {
namespace {

using model::BuildingPart;
using model::IssueCode;
using model::Point2;

/// m that openings of rules keep from the portal of a passage.
constexpr double kBesidePortal = 0.1;
/// m between a mapped entrance and the door that stands for it: rules put doors on the nearest axis, and axes are up to
/// 3.4 m apart.
constexpr double kDoorOfEntrance = 1.7;

/// An element as a rule asked for it, in the coordinates of a wall.
struct Asked {
  std::uint32_t wall = 0, element = 0;
  Point2 at;  ///< middle of the lower edge
  std::int32_t storey = 0;
};

class FacadeBuilder {
 public:
  FacadeBuilder(model::Report& report, ElementLibrary& library, const GrammarLibrary& grammars,
                const attributes::Defaults& defaults, const FacadeOptions& options)
      : report_(report), library_(library), grammars_(grammars), defaults_(defaults), options_(options) {}

  /// \param mass  the roof that the part's LoD2 has; gets what is built on it. Null: nothing is
  void build(model::Building& building, BuildingPart& part, masses::BuiltMass* mass) {
    if (part.lod < 2 || part.lod2.empty() || part.canopy) return;
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
    portals_ = take_portals(part, walls, segments);
    const double eaves = eaves_level(part);
    link_corners(segments, walls, eaves);
    portal_elements_ = yielding_ = missed_doors_ = before_wall_ = yielding_geometry_ = 0;
    checked_portals_.clear();
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

 private:
  /// The body that openings are cut into.
  struct Closed {
    const model::Solid* solid = nullptr;
    const model::SolidTriangles* triangles = nullptr;
  };

  /// Dormers and cross gables on the roof, windows in their fronts and in gables.
  /// \param walls  of the LoD2 solid; becomes those of the furnished one, which begin with them
  void furnish(const GrammarLibrary::Entry& grammar, const model::Building& building, BuildingPart& part,
               masses::BuiltMass& mass, std::vector<WallFrame>& walls, const std::vector<FacadeSegment>& segments,
               double eaves, std::uint64_t seed, std::uint64_t row) {
    if (segments.empty()) return;
    take_roof_parameters(grammar, seed, row);
    if (grammar.roof_makes_geometry) tell("rules for roofs place elements; other geometry of theirs is not built");
    WindowsBelow windows = windows_below();
    // The values are those of the building: the segment that rules see is its main front, else its first wall.
    const FacadeSegment* front = &segments.front();
    for (const FacadeSegment& s : segments)
      if (s.kind == model::WallSegmentKind::street && (front->kind != s.kind || s.length() > front->length()))
        front = &s;
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

  /// What fronts on the roof take over from the windows asked for: those of the topmost storey.
  WindowsBelow windows_below() const {
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
      out.frame_colour = model::text(
          library_.materials(asked_[i].element)[static_cast<std::size_t>(model::ElementPart::frame)].colour);
    }
    return out;
  }

  static double width_of(const model::Element& element) {
    double low = 1e300, high = -1e300;
    for (const Point2& p : element.opening.outline) low = std::min(low, p.x), high = std::max(high, p.x);
    return high - low;
  }

  /// Middles of the windows of each wall, on the plan.
  std::vector<WindowAxes> window_axes(const std::vector<WallFrame>& walls, const BuildingPart& part) const {
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

  /// Runs a rule of the rules for roofs.
  grammar::Derivation derive_roof(const FacadeContext& context, const char* rule, const grammar::Shape& shape,
                                  std::string_view place = {}) {
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

  /// What rules for roofs get from outside, the same for all derivations of a part.
  void take_roof_parameters(const GrammarLibrary::Entry& grammar, std::uint64_t seed, std::uint64_t row) {
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

  /// Windows of a dormer or cross gable: rules see the front alone, from its lower border.
  void derive_front(const FacadeContext& main, const std::vector<WallFrame>& walls,
                    const std::vector<FacadeSegment>& segments, const RoofFront& front) {
    const auto wall =
        std::find_if(walls.begin(), walls.end(), [&](const WallFrame& w) { return w.face == front.face; });
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

  /// Windows in a wall above its eaves.
  void derive_gable(const FacadeContext& main, const std::vector<WallFrame>& walls, const FacadeSegment& segment) {
    const WallFrame& wall = walls[segment.wall];
    const double foot = std::clamp(main.eaves - wall.base, 0.0, wall.height);
    if (segment.kind == model::WallSegmentKind::party_wall || wall.height - foot < kLeastGable) return;
    // Of a front with cross gables those alone rise above the eaves.
    if (furnished_)
      for (const RoofFront& f : furnished_->fronts)
        if (f.kind == model::RoofElementKind::cross_gable && f.face == wall.face) return;
    derive_piece(main, wall, segment, foot, "Gable");
  }

  void derive_piece(const FacadeContext& main, const WallFrame& wall, const FacadeSegment& piece, double foot,
                    const char* rule) {
    grammar::Shape shape = wall_shape(wall);
    if (piece.from > 0 || piece.to < wall.length) shape = grammar::cut_piece(shape, 0, piece.from, piece.to, false);
    if (foot > 0) shape = grammar::cut_piece(shape, 1, foot, wall.height, false);
    if (!shape.mesh || shape.mesh->faces.empty()) return;
    FacadeContext context{main.building, main.part, wall, piece, main.eaves, main.windows, &defaults_};
    const std::string place = fmt::format("{}/{}", wall.face, static_cast<int>(std::floor(piece.from * 16)));
    for (const grammar::Leaf& leaf : derive_roof(context, rule, shape, place).leaves)
      if (leaf.order) take(context, leaf);
  }

  /// Of windows on the roof those go that do not fit in their front: rules order rows of them, as many as a rectangle takes.
  void keep_within(const std::vector<WallFrame>& walls, std::size_t first) {
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

  void derive_segment(const GrammarLibrary::Entry& grammar, const FacadeContext& context, std::uint64_t seed,
                      std::uint64_t row) {
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

  /// Storeys whose looks are ordered and that are not there.
  void tell_unpainted(const model::Building& building, const BuildingPart& part) {
    // What is ordered of the whole building holds where it has such a storey; it is told once.
    const BuildingPart& highest = *std::ranges::max_element(
        building.parts, {}, [](const BuildingPart& other) { return other.attributes.storeys.value; });
    const double most = highest.attributes.storeys.value;
    for (const model::DetailOverride& d : building.detail_overrides) {
      const bool of_part = d.body == part.id;
      const bool of_building = d.body == building.id() && std::atof(d.name.c_str()) >= most && &highest == &part;
      if (d.kind != model::DetailKind::storey || !(of_part || of_building)) continue;
      const bool asked = std::ranges::any_of(
          d.values, [](const auto& value) { return value.first == "colour" || value.first == "material"; });
      const std::string name = "storey " + d.name;
      if (asked && std::ranges::none_of(paint_orders_, [&](const PaintOrder& o) { return o.name == name; }))
        report_.add(part.osm, IssueCode::parameter_unread,
                    fmt::format("{}: {} has no {}, or no wall that may be painted", d.from, part.id, name));
    }
  }

  /// `blockrand.paint`: how the wall looks where the leaf's shape is.
  void note_paint(const FacadeContext& context, const grammar::Leaf& leaf) {
    std::string colour, material, storey;
    const auto& arguments = leaf.order->arguments;
    for (std::size_t i = 1; i + 1 < arguments.size(); i += 2) {
      const auto *name = std::get_if<std::string>(&arguments[i]), *value = std::get_if<std::string>(&arguments[i + 1]);
      if (name && value) (*name == "colour" ? colour : material) = *value;
      if (const auto* number = std::get_if<double>(&arguments[i + 1])) storey = fmt::format("storey {:g}", *number);
    }
    if (colour.empty() && material.empty()) return;
    const grammar::Frame frame = grammar::scope_in_object(leaf.shape);
    add_paint(context, frame.origin.x, frame.origin.x + leaf.shape.size.x, frame.origin.y,
              frame.origin.y + leaf.shape.size.y, colour, material, std::move(storey));
  }

  /// What is ordered of a whole edge.
  void paint_edge(const FacadeContext& context) {
    if (context.building.detail_overrides.empty()) return;
    const std::string colour = edge_order(context, "colour"), material = edge_order(context, "material");
    if (!colour.empty() || !material.empty())
      add_paint(context, context.segment.from, context.segment.to, 0, context.wall.height, colour, material, "edge");
  }

  void add_paint(const FacadeContext& context, double left, double right, double low, double high,
                 const std::string& colour, const std::string& material, std::string name) {
    PaintOrder order{context.segment.wall, left, right, low, high, {}, std::move(name)};
    order.look = usual_materials_[static_cast<std::size_t>(model::ElementPart::wall)];
    if (const auto ordered = model::colour_of_hex(colour))
      order.look.colour = *ordered;
    else if (!colour.empty())
      tell(colour + " is no colour: #rrggbb");
    if (const int index = defaults_.material(material); index >= 0) {
      order.look.material = static_cast<std::uint8_t>(index);
      // A material alone has its own colour.
      if (colour.empty()) order.look.colour = defaults_.materials[static_cast<std::size_t>(index)].colour;
    } else if (!material.empty()) {
      tell(material + " is no material class");
    }
    paint_orders_.push_back(std::move(order));
  }

  /// Layers of paint round the openings. \param opened  by asked_: has an opening
  void apply_paint(model::Detail& detail, const std::vector<WallFrame>& walls, const std::vector<bool>& opened) {
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

  /// What rules make themselves on a wall.
  RuleGeometry geometry_of(const FacadeContext& context, std::span<const grammar::Leaf> leaves) {
    const model::PartMaterial& usual = usual_materials_[static_cast<std::size_t>(model::ElementPart::wall)];
    std::vector<KeptFree> portals;
    for (const PassagePortal& m : portals_)
      if (m.wall == context.segment.wall)
        portals.push_back({m.left - kBesidePortal, m.right + kBesidePortal, m.high + kBesidePortal});
    const auto painted = painted_.find(context.wall.face);
    RuleGeometry made = rule_geometry(leaves, context.wall, portals, usual,
                                      painted == painted_.end() ? nullptr : &painted->second, defaults_);
    painted_.emplace(context.wall.face, made.ground);
    return made;
  }

  void take_geometry(const FacadeContext& context, RuleGeometry made) {
    yielding_geometry_ += made.yielding;
    for (const auto& [what, count] : made.dropped) dropped_[what] += count;
    for (const std::string& texture : made.textures)
      tell("the image " + texture + " is not shown: what rules make has colours alone");
    for (RuleBody& body : made.bodies) {
      double low = 1e300;
      for (const model::Point3& v : body.element.mesh.vertices) low = std::min(low, v.y + body.at.y);
      const std::int32_t storey = storey_at(context, low);
      const Point2 at = body.at;
      asked_.push_back({context.segment.wall, library_.add_made(std::move(body.element), body.materials), at, storey});
    }
  }

  /// The storey that a height in a wall belongs to.
  static std::int32_t storey_at(const FacadeContext& context, double low) {
    const double storey_height = context.part.attributes.storey_height.value;
    const double above = low + context.wall.base - context.part.attributes.ground_height.value -
                         context.part.attributes.plinth_height.value;
    return storey_height > 0 ? std::max(0, static_cast<std::int32_t>(std::floor(above / storey_height + 0.25))) : 0;
  }

  /// What rules of a preset get from outside, the same for all walls of a building.
  /// Those of district rules are meant for the building's preset.
  void take_parameters(const GrammarLibrary::Entry& grammar, const model::Building& building,
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

  static grammar::Shape wall_shape(const WallFrame& wall) {
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

  /// Runs along the wall cut into equal pieces, where they are longer than elements can be.
  static std::vector<std::pair<double, double>> no_longer_than(double most,
                                                               std::span<const std::pair<double, double>> runs) {
    std::vector<std::pair<double, double>> out;
    for (const auto& [from, to] : runs) {
      const int count = std::max(1, static_cast<int>(std::ceil((to - from) / most)));
      for (int i = 0; i < count; ++i)
        out.emplace_back(i == 0 ? from : from + (to - from) * i / count,
                         i + 1 == count ? to : from + (to - from) * (i + 1) / count);
    }
    return out;
  }

  /// An order of a leaf: an element where its scope is. What would stand in the portal of a passage yields: runs along
  /// the wall are interrupted, the rest is left out.
  void take(const FacadeContext& context, const grammar::Leaf& leaf) {
    const grammar::ElementRequest& order = *leaf.order;
    if (order.name == kPaintOperation) return note_paint(context, leaf);
    if (order.arguments.empty() || !std::holds_alternative<std::string>(order.arguments[0])) {
      tell("blockrand." + order.name + " wants the name of an element first");
      return;
    }
    const grammar::Frame frame = grammar::scope_in_object(leaf.shape);
    const double left = frame.origin.x, low = frame.origin.y, width = leaf.shape.size.x, height = leaf.shape.size.y;
    if (!(ElementLibrary::size(width) > 0 && ElementLibrary::size(height) > 0)) return;
    const elements::ElementKind* kind = elements::find_element_kind(std::get<std::string>(order.arguments[0]));
    const bool run = kind && kind->width.measures == "run";
    std::vector<std::pair<double, double>>& pieces = pieces_;
    pieces.assign({{left, left + width}});
    for (const PassagePortal& m : portals_) {
      if (m.wall != context.segment.wall || low >= m.high + kBesidePortal || low + height <= m.low) continue;
      const double from = m.left - kBesidePortal, to = m.right + kBesidePortal;
      if (left >= to || left + width <= from) continue;
      if (!run) {
        ++yielding_;
        if (kind && kind->semantic == model::ElementClass::door && at_entrance(context, left, left + width))
          ++missed_doors_;
        return;
      }
      // Pieces are in order from left to right, and so are what a portal leaves of one.
      for (std::size_t i = 0; i < pieces.size();) {
        const auto [a, b] = pieces[i];
        if (a >= to || b <= from) {
          ++i;
          continue;
        }
        const auto at = pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
        std::size_t kept = 0;
        if (b - to >= kind->width.least) pieces.insert(at, {to, b}), ++kept;
        if (from - a >= kind->width.least)
          pieces.insert(pieces.begin() + static_cast<std::ptrdiff_t>(i), {a, from}), ++kept;
        i += kept;
      }
    }
    if (run) pieces = no_longer_than(kind->width.most, pieces);
    const std::int32_t storey = storey_at(context, low);
    for (const auto& [from, to] : pieces) {
      const auto [made_width, made_height] = ElementLibrary::size(kind, to - from, height);
      PartMaterials looks = usual_materials_;
      if (const auto painted = painted_.find(context.wall.face); painted != painted_.end())
        looks[static_cast<std::size_t>(model::ElementPart::wall)] = painted->second;
      library_.ask(std::get<std::string>(order.arguments[0]), made_width, made_height, looks);
      complaints_.clear();
      library_.add_request(order, from == left, to == left + width, complaints_);
      for (const std::string& what : complaints_) tell(what);
      place(context.segment.wall, {(from + to) / 2, low}, storey);
    }
  }

  /// Whether a mapped entrance lies at that piece of the wall.
  static bool at_entrance(const FacadeContext& context, double left, double right) {
    const std::vector<double> places = entrance_places(context);
    return std::any_of(places.begin(), places.end(), [&](double from_segment) {
      const double u = context.segment.from + from_segment;
      return u >= left - kDoorOfEntrance && u <= right + kDoorOfEntrance;
    });
  }

  /// Takes what the stock was asked for.
  void place(std::uint32_t wall, Point2 at, std::int32_t storey) {
    std::string error;
    const std::uint32_t element = library_.take(error);
    if (!error.empty()) tell(error);
    if (element != ElementLibrary::kNone) asked_.push_back({wall, element, at, storey});
  }

  /// Cuts all open passages alone; portals of those that cannot be cut are blocked.
  /// \return false where the solid is not valid then
  bool takes_passages(const BuildingPart& part, const std::vector<WallFrame>& walls) {
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

  /// Which portals are open.
  std::vector<bool> open_portals() const {
    std::vector<bool> out;
    for (const PassagePortal& m : portals_) out.push_back(m.state == PortalState::open);
    return out;
  }

  /// Leaves open what the solid takes: all passages together, else one after another.
  void try_passages(const BuildingPart& part, const std::vector<WallFrame>& walls) {
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

  void close_open(PortalState why) {
    for (PassagePortal& m : portals_)
      if (m.state == PortalState::open) m.state = why;
  }

  /// Of all open portals, in their order.
  std::vector<WallOpening> passage_openings() const {
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

  /// Before all other elements: gates in portals that lead nowhere, a band round those of passages in street fronts.
  void close_portals() {
    for (const PassagePortal& m : portals_) {
      const bool open = m.state == PortalState::open;
      if (open && m.front != model::WallSegmentKind::street) continue;
      const bool cart = m.right - m.left >= kLeastGate;
      const std::string_view name = open ? "surround" : cart ? "carriage_gateway" : "house_door";
      const elements::ElementKind& kind = *elements::find_element_kind(name);
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

  /// A solid with openings.
  struct Cut {
    OpenedSolid opened;
    model::SolidTriangles triangles;
    std::vector<bool> left_out;         ///< by asked_; empty: none was
    std::vector<std::size_t> of_asked;  ///< by opening given: of which element; kNoAsked for portals of passages
  };

  /// Cuts passages and what elements need; none when the solid is not valid then.
  /// \param left_out  by asked_: gets none
  /// \param bad_face  gets the face that is no sound polygon then, where that is why
  std::optional<Cut> cut_all(const std::vector<WallFrame>& walls, const std::vector<bool>& left_out = {},
                             std::int64_t* bad_face = nullptr) const {
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

  /// Of a wall that folds with all of its openings, what rules sank stands before it; then every other window goes, then all
  /// openings. The other walls keep theirs.
  std::optional<Cut> cut_most(const std::vector<WallFrame>& walls) {
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

  /// \return  whether the wall has fewer openings now
  bool thin(const std::vector<WallFrame>& walls, std::int64_t face, int step, std::vector<bool>& left_out) {
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

  bool is_sunk_geometry(const Asked& asked) const {
    const model::Element& element = library_.element(asked.element);
    return element.kind == kRuleGeometry && !element.opening.outline.empty();
  }
  /// What rules sank into the wall stands before it where the wall takes no opening: it is seen all the same.
  void stand_before(Asked& asked) {
    model::Element element = before_wall(library_.element(asked.element));
    const PartMaterials materials = library_.materials(asked.element);
    asked.element = library_.add_made(std::move(element), materials);
    ++before_wall_;
  }

  /// Walls, and the reveals of their openings, look as rules say.
  void paint(model::Detail& detail) const {
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

  void cut(BuildingPart& part, const std::vector<WallFrame>& walls) {
    model::Detail& detail = part.lod3;
    part.lod = 3;
    const auto is_open = [](const PassagePortal& m) { return m.state == PortalState::open; };
    const bool passages = std::any_of(portals_.begin(), portals_.end(), is_open);
    if (asked_.empty() && !passages) {  // walls without openings are a facade, too
      detail.solid = *closed_.solid;
      detail.triangles = *closed_.triangles;
      paint(detail);
      apply_paint(detail, walls, {});
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
        if (made->of_asked[i] != kNoAsked)
          refused[made->of_asked[i]] = made->opened.refusals[i] != OpeningRefusal::none;
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
    finish_told(part, left_out);
  }

  /// Windows that yield to a passage are no failure; doors at mapped entrances are.
  /// \param left_out  of what was asked for
  void finish_told(BuildingPart& part, std::size_t left_out) {
    left_out += missed_doors_;
    if (yielding_geometry_ > 0)
      report_.add(part.osm, IssueCode::opening_left_out,
                  fmt::format("{}: {} leaves of rules yield to a passage", part.id, yielding_geometry_));
    if (before_wall_ > 0) {
      part.fallbacks.push_back(IssueCode::opening_left_out);
      report_.add(part.osm, IssueCode::opening_left_out,
                  fmt::format("{}: {} bodies of rules stand before the wall: it takes no opening there", part.id,
                              before_wall_));
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

  /// Each complaint once a part.
  void tell(const std::string& what) { told_.insert(what); }

  static constexpr std::size_t kNoAsked = ~std::size_t{0};
  /// Of cut_most(): a wall is thinned twice at most, and few houses have more than one that folds.
  static constexpr std::size_t kMostTries = 8;
  /// m. Lower gables have no windows.
  static constexpr double kLeastGable = 1.6;
  /// m of wall around windows of dormers and gables.
  static constexpr double kFrontBorder = 0.08;
  /// m; narrower portals get a house door.
  static constexpr double kLeastGate = 1.8;

  model::Report& report_;
  ElementLibrary& library_;
  const GrammarLibrary& grammars_;
  const attributes::Defaults& defaults_;
  const FacadeOptions& options_;
  CornerRounding rounding_ = CornerRounding::nearest;  ///< of the part at work
  grammar::DeriveOptions derive_options_;
  grammar::AttributeMemo memo_;                         ///< of the part at work
  const GrammarLibrary::Entry* derived_for_ = nullptr;  ///< whose values derive_options_ holds, with these parameters
  decltype(model::Building::preset_parameters) parameters_;
  std::vector<std::uint32_t> outside_;
  std::vector<Asked> asked_;
  std::vector<PassagePortal> portals_;
  /// The open portals with which, and no other opening, the solid is valid and its borders stayed as they are; empty: not known.
  std::vector<bool> checked_portals_;
  std::size_t portal_elements_ = 0;    ///< the first of asked_: what close_portals() put there
  std::size_t yielding_ = 0;           ///< elements that would stand in a portal
  std::size_t yielding_geometry_ = 0;  ///< leaves that stand in a portal as a whole
  std::size_t before_wall_ = 0;        ///< sunk bodies of rules that got no opening
  std::size_t missed_doors_ = 0;       ///< those of them that are doors at mapped entrances
  std::set<std::string> told_;
  std::vector<PaintOrder> paint_orders_;                  ///< of the part at work
  std::map<std::uint32_t, model::PartMaterial> painted_;  ///< by face: walls that rules gave another look
  std::map<std::string, std::size_t> dropped_;            ///< leaves by "Symbol: why"
  PartMaterials usual_materials_;                         ///< of the part at work
  std::vector<std::string> complaints_;
  std::vector<std::pair<double, double>> pieces_;
  const grammar::Deriver* roof_rules_ = nullptr;
  grammar::DeriveOptions roof_options_;
  grammar::AttributeMemo roof_memo_;  ///< of the part at work
  std::vector<std::uint32_t> roof_outside_;
  Closed closed_;                           ///< of the part at work
  std::optional<FurnishedRoof> furnished_;  ///< the same, with dormers and cross gables; none: it has none
};

}  // namespace

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
    stretch.library = std::make_unique<ElementLibrary>(stretch.made, defaults);
    FacadeBuilder builder(stretch.made.report, *stretch.library, grammars, defaults, options);
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
  ElementLibrary library(region, defaults);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    region.report.append(std::move(stretches[i].made.report));
    const std::vector<std::uint32_t> numbers = library.take_over(*stretches[i].library);
    for (std::size_t b = begins[i]; b < begins[i + 1]; ++b)
      for (BuildingPart& part : region.buildings[b].parts)
        for (model::Placement& placement : part.lod3.placements) placement.element = numbers[placement.element];
  }
}

}  // namespace blockrand::facades
