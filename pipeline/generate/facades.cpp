#include "pipeline/generate/facades.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/generate/facade_context.h"
#include "pipeline/generate/opening_proof.h"
#include "pipeline/generate/openings.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/triangulate.h"
#include "styles/elements/make_element.h"
#include "styles/grammar/colour_text.h"
#include "styles/grammar/scope.h"
#include "styles/grammar/split.h"

namespace blockrand::generate {
namespace {

using model::BuildingPart;
using model::ElementPart;
using model::IssueCode;
using model::Point2;

/// Elements are made in whole centimetres, so that equal ones are one.
constexpr double kElementGrid = 100;
/// Their parameters in millimetres, for the same reason.
constexpr double kParameterGrid = 1000;
/// Colours of parts that neither rule nor building says.
constexpr model::Colour kFrame{0xF6, 0xF6, 0xF6}, kGlass{0x51, 0x62, 0x6E}, kLeaf{0x5A, 0x3A, 0x29},
    kMetal{0x37, 0x3F, 0x43}, kTrim{0xFD, 0xF4, 0xE3}, kSill{0xE9, 0xE5, 0xCE};

/// "#rrggbb", as rule files write colours.
std::optional<model::Colour> colour_of_text(std::string_view text) {
  const auto parsed = grammar::parse_colour(text);
  if (!parsed) return std::nullopt;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(std::nearbyint((*parsed)[i] * 255)); };
  return model::Colour{byte(0), byte(1), byte(2)};
}

/// An element as a rule asked for it, in the coordinates of a wall.
struct Asked {
  std::uint32_t wall = 0, element = 0;
  Point2 at;  ///< middle of the lower edge
  std::int32_t storey = 0;
};

class FacadeBuilder {
 public:
  FacadeBuilder(model::Region& region, const GrammarBook& grammars, const Defaults& defaults,
                const FacadeOptions& options)
      : region_(region), grammars_(grammars), options_(options) {
    const auto material = [&](const char* name) {
      return static_cast<std::uint8_t>(std::max(defaults.material(name), 0));
    };
    plaster_ = material("plaster");
    wood_ = material("wood");
    glass_ = material("glass");
    metal_ = material("metal");
  }

  void build(model::Building& building, BuildingPart& part) {
    if (part.lod < 2 || part.lod2.empty() || part.canopy) return;
    const GrammarBook::Entry* grammar = grammars_.find(building.attributes.preset.value);
    if (!grammar) return;
    std::vector<WallFrame> walls;
    for (std::uint32_t f = 0; f < part.lod2.faces.size(); ++f)
      if (auto wall = wall_frame(part.lod2, f)) walls.push_back(std::move(*wall));
    asked_.clear();
    told_.clear();
    usual_looks_ = usual_looks(part);
    const std::uint64_t seed = base::random_bits(options_.seed, building.osm.key(), "facades");
    const std::uint64_t row =
        base::random_bits(options_.seed, base::hash_text(building.situation.block), "row of facades");
    for (const FacadeStretch& stretch : facade_stretches(building, walls)) {
      if (stretch.kind == model::EdgeKind::party_wall || stretch.kind == model::EdgeKind::unknown) continue;
      derive_stretch(*grammar, {building, part, walls[stretch.wall], stretch}, seed, row);
    }
    cut(building, part, walls);
  }

 private:
  void derive_stretch(const GrammarBook::Entry& grammar, const FacadeContext& context, std::uint64_t seed,
                      std::uint64_t row) {
    const WallFrame& wall = context.wall;
    grammar::Shape shape = wall_shape(wall);
    if (context.stretch.from > 0 || context.stretch.to < wall.length)
      shape = grammar::cut_piece(shape, 0, context.stretch.from, context.stretch.to, false);
    grammar::DeriveOptions options;
    const std::string place =
        fmt::format("{}/{}/{}", context.part.id, wall.face, static_cast<int>(std::floor(context.stretch.from * 16)));
    options.seed = base::random_bits(seed, base::hash_text(place), "stretch");
    options.building_seed = seed;
    options.row_seed = row;
    // The first of a name counts: what district rules and overrides say is stronger than the preset's own values.
    for (const auto& [name, value] : context.building.preset_parameters) options.attributes.emplace_back(name, value);
    options.attributes.insert(options.attributes.end(), grammar.attributes.begin(), grammar.attributes.end());
    options.source = [&](std::string_view name) { return context_value(context, name); };
    options.limits.shapes = options_.most_shapes;
    const grammar::Derivation derivation = grammar.deriver->run(shape, options);
    for (const grammar::Diagnostic& d : derivation.diagnostics)
      if (d.severity == grammar::Severity::error) tell(context.part, d.message);
    for (const grammar::Leaf& leaf : derivation.leaves)
      if (leaf.order) take(context, leaf);
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

  /// An order of a leaf: an element where its scope is.
  void take(const FacadeContext& context, const grammar::Leaf& leaf) {
    const grammar::Order& order = *leaf.order;
    const grammar::Frame frame = grammar::scope_in_object(leaf.shape);
    const double width = std::floor(leaf.shape.size.x * kElementGrid + 0.001) / kElementGrid;
    const double height = std::floor(leaf.shape.size.y * kElementGrid + 0.001) / kElementGrid;
    if (!(width > 0 && height > 0)) return;
    const std::uint32_t element = element_of(context, order, width, height);
    if (element == kNone) return;
    const double storey_height = context.part.attributes.storey_height.value;
    const double above = frame.origin.y + context.wall.base - context.part.attributes.ground_height.value -
                         context.part.attributes.plinth_height.value;
    const auto storey = storey_height > 0 ? static_cast<std::int32_t>(std::floor(above / storey_height + 0.25)) : 0;
    asked_.push_back({static_cast<std::uint32_t>(wall_number(context)),
                      element,
                      {frame.origin.x + leaf.shape.size.x / 2, frame.origin.y},
                      std::max(storey, 0)});
  }
  static std::size_t wall_number(const FacadeContext& context) { return context.stretch.wall; }

  static constexpr std::uint32_t kNone = 0xffffffff;

  std::uint32_t element_of(const FacadeContext& context, const grammar::Order& order, double width, double height) {
    if (order.arguments.empty() || !std::holds_alternative<std::string>(order.arguments[0])) {
      tell(context.part, "blockrand." + order.name + " wants the name of an element first");
      return kNone;
    }
    const std::string& kind = std::get<std::string>(order.arguments[0]);
    std::array<model::PartLook, model::kElementPartCount> looks = usual_looks_;
    key_.clear();
    add_text(kind);
    add_number(width, kElementGrid);
    add_number(height, kElementGrid);
    parameters_.clear();
    for (std::size_t i = 1; i + 1 < order.arguments.size(); i += 2) {
      if (!std::holds_alternative<std::string>(order.arguments[i])) continue;
      const std::string& name = std::get<std::string>(order.arguments[i]);
      const grammar::Value& value = order.arguments[i + 1];
      if (name.ends_with("_colour") && std::holds_alternative<std::string>(value)) {
        const std::string_view part = std::string_view(name).substr(0, name.size() - 7);
        const auto at = std::find(std::begin(model::kElementPartNames), std::end(model::kElementPartNames), part);
        const auto colour = colour_of_text(std::get<std::string>(value));
        if (at != std::end(model::kElementPartNames) && colour)
          looks[static_cast<std::size_t>(at - std::begin(model::kElementPartNames))].colour = *colour;
        else if (!std::get<std::string>(value).empty())
          tell(context.part, fmt::format("{} = {} is no colour of a part", name, std::get<std::string>(value)));
        continue;
      }
      elements::Parameter parameter;
      parameter.name = name;
      if (const auto* text = std::get_if<std::string>(&value)) {
        parameter.value = *text;
        add_text(name);
        add_text(*text);
      } else if (const auto* number = std::get_if<double>(&value)) {
        parameter.value = std::nearbyint(*number * kParameterGrid) / kParameterGrid;
        add_text(name);
        add_number(*number, kParameterGrid);
      } else if (const auto* truth = std::get_if<bool>(&value)) {
        parameter.value = std::string(*truth ? "yes" : "no");
        add_text(name);
        add_text(*truth ? "yes" : "no");
      }
      parameters_.push_back(std::move(parameter));
    }
    auto made = made_.find(key_);
    if (made == made_.end()) {
      auto element = elements::make_element(kind, width, height, parameters_);
      Made entry;
      if (element)
        entry.element = std::make_shared<const model::Element>(std::move(*element));
      else
        entry.error = element.error();
      made = made_.emplace(key_, std::move(entry)).first;
    }
    if (!made->second.element) {
      tell(context.part, made->second.error);
      return kNone;
    }
    for (const auto& [known, number] : made->second.coloured)
      if (known == looks) return number;
    const auto number = static_cast<std::uint32_t>(region_.elements.size());
    made->second.coloured.emplace_back(looks, number);
    region_.elements.push_back({made->second.element, looks});
    return number;
  }

  /// The key of an element is what was asked for, byte by byte: texts with their lengths, numbers in steps.
  void add_text(std::string_view text) {
    add_bytes(text.size());
    key_.append(text);
  }
  void add_number(double value, double steps) { add_bytes(std::llrint(value * steps)); }
  template <class T>
  void add_bytes(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    key_.append(bytes.data(), bytes.size());
  }

  std::array<model::PartLook, model::kElementPartCount> usual_looks(const BuildingPart& part) const {
    std::array<model::PartLook, model::kElementPartCount> out;
    const auto set = [&](ElementPart p, std::uint8_t material, model::Colour colour) {
      out[static_cast<std::size_t>(p)] = {material, colour};
    };
    model::PartLook wall{plaster_, part.attributes.wall_colour.value};
    for (const model::Face& face : part.lod2.faces)
      if (face.kind == model::SurfaceKind::wall) {
        wall = {face.material, face.colour};
        break;
      }
    set(ElementPart::frame, wood_, kFrame);
    set(ElementPart::glass, glass_, kGlass);
    set(ElementPart::leaf, wood_, kLeaf);
    set(ElementPart::surround, plaster_, kTrim);
    set(ElementPart::sill, plaster_, kSill);
    set(ElementPart::wall, wall.material, wall.colour);
    set(ElementPart::metal, metal_, kMetal);
    set(ElementPart::panel, wood_, kLeaf);
    return out;
  }

  void cut(model::Building& building, BuildingPart& part, const std::vector<WallFrame>& walls) {
    if (asked_.empty()) {  // walls without openings are a facade, too
      part.lod3.solid = part.lod2;
      part.lod3.triangles = part.lod2_triangles;
      part.lod = 3;
      finish_told(building, part, 0);
      return;
    }
    std::vector<WallOpening> openings;
    std::vector<std::size_t> of_asked;
    for (std::size_t i = 0; i < asked_.size(); ++i) {
      const model::Element& element = *region_.elements[asked_[i].element].element;
      if (element.opening.outline.empty()) continue;
      WallOpening o;
      o.wall = asked_[i].wall;
      o.kind = element.semantic == model::ElementClass::door ? model::OpeningKind::door : model::OpeningKind::window;
      o.reveal = element.opening.reveal;
      o.storey = asked_[i].storey;
      for (const Point2& p : element.opening.outline) o.outline.push_back({p.x + asked_[i].at.x, p.y + asked_[i].at.y});
      openings.push_back(std::move(o));
      of_asked.push_back(i);
    }
    OpenedSolid opened = cut_openings(part.lod2, walls, openings);
    auto triangles = geometry::triangulate(opened.solid, part.lod2, part.lod2_triangles);
    if (!triangles || !(proved_valid(opened, *triangles) || geometry::check_solid(opened.solid, *triangles).valid())) {
      part.fallbacks.push_back(IssueCode::facade_failed);
      region_.report.add(part.osm, IssueCode::facade_failed, part.id);
      return;
    }
    model::Detail& detail = part.lod3;
    std::vector<std::uint32_t> opening_of(asked_.size(), model::kNoOpening);
    std::vector<bool> refused(asked_.size(), false);
    for (std::size_t i = 0; i < openings.size(); ++i) refused[of_asked[i]] = opened.refusals[i] != OpeningRefusal::none;
    for (std::uint32_t i = 0; i < opened.given.size(); ++i) opening_of[of_asked[opened.given[i]]] = i;
    detail.solid = std::move(opened.solid);
    detail.triangles = std::move(*triangles);
    detail.openings = std::move(opened.openings);
    int left_out = 0;
    for (std::size_t i = 0; i < asked_.size(); ++i) {
      if (refused[i]) {
        ++left_out;
        continue;
      }
      const WallFrame& wall = walls[asked_[i].wall];
      detail.placements.push_back({asked_[i].element, model::snap(wall.at(asked_[i].at)), wall.along, opening_of[i],
                                   wall.face, asked_[i].storey});
    }
    part.lod = 3;
    finish_told(building, part, left_out);
  }

  void finish_told(const model::Building&, BuildingPart& part, int left_out) {
    if (left_out > 0) {
      part.fallbacks.push_back(IssueCode::opening_left_out);
      region_.report.add(part.osm, IssueCode::opening_left_out,
                         fmt::format("{}: {} of {}", part.id, left_out, asked_.size()));
    }
    for (const std::string& what : told_) region_.report.add(part.osm, IssueCode::grammar_error, part.id + ": " + what);
  }

  /// Each complaint once a part.
  void tell(const BuildingPart&, const std::string& what) { told_.insert(what); }

  struct Made {
    std::shared_ptr<const model::Element> element;
    std::string error;
    std::vector<std::pair<std::array<model::PartLook, model::kElementPartCount>, std::uint32_t>> coloured;
  };

  model::Region& region_;
  const GrammarBook& grammars_;
  const FacadeOptions& options_;
  std::uint8_t plaster_ = 0, wood_ = 0, glass_ = 0, metal_ = 0;
  std::vector<Asked> asked_;
  std::set<std::string> told_;
  std::array<model::PartLook, model::kElementPartCount> usual_looks_;  ///< of the part at work
  std::string key_;
  std::vector<elements::Parameter> parameters_;
  std::unordered_map<std::string, Made> made_;
};

}  // namespace

void build_facades(model::Region& region, const GrammarBook& grammars, const Defaults& defaults,
                   const FacadeOptions& options) {
  FacadeBuilder builder(region, grammars, defaults, options);
  for (model::Building& building : region.buildings) {
    if (!building.owned) continue;
    for (BuildingPart& part : building.parts) builder.build(building, part);
  }
}

}  // namespace blockrand::generate
