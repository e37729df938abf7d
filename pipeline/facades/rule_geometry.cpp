#include "pipeline/facades/rule_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "pipeline/facades/leaf_polygons.h"
#include "pipeline/facades/openings.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::facades {
namespace {

using grammar::Leaf;
using grammar::Vector3;
using model::Point2;
using model::Point3;

/// m. What lies nearer to the wall's plane lies in it: rules count in floats of sizes.
constexpr double kInPlane = 0.002;
/// m that painted faces stand before the wall, so that nothing flickers (elements::kApart is 5 mm).
constexpr double kPaint = 0.006;
/// m of wall around openings, and a grid step.
constexpr double kOpeningBorder = kOpeningClearance + 0.001;
/// m across an opening.
constexpr double kLeastSunk = 2 * kLeastOpening;
/// m between sunk leaves that share an opening: between two there would be no room for both borders.
constexpr double kShared = 2 * kOpeningBorder;
/// Share of a box that leaves must fill to get an opening: else wall is cut away where nobody sank anything.
constexpr double kLeastFilled = 0.6;
/// m, deepest that geometry is sunk into a wall; elements reach no deeper (docs/elements.md).
constexpr double kDeepest = 0.8;
constexpr double kSmallest = 1e-6;  ///< m2, of a triangle
/// Corners of all bodies of a wall: what is beyond is told, and left out. An asset of 20,000 corners in a hundred windows.
constexpr std::size_t kMostWallCorners = 2'000'000;

bool is_flat(const LeafPolygons& l) { return l.low.z > -kInPlane && l.high.z < kInPlane; }
bool is_sunk(const LeafPolygons& l) { return l.low.z <= -kInPlane; }

double area_of(const std::vector<Point3>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::fabs(twice) / 2;
}

/// The look that most of the leaves in the wall's plane have: the wall itself gets it, so that few are painted on it.
model::PartMaterial ground_look(const std::vector<LeafPolygons>& leaves, const model::PartMaterial& usual) {
  std::vector<std::pair<model::PartMaterial, double>> areas{{usual, 0}};
  for (const LeafPolygons& l : leaves) {
    if (!is_flat(l)) continue;
    auto of = std::find_if(areas.begin(), areas.end(), [&](const auto& a) { return a.first == l.look; });
    if (of == areas.end()) of = areas.insert(areas.end(), {l.look, 0});
    for (const auto& polygon : l.polygons) of->second += area_of(polygon);
  }
  return std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// Puts leaves together as one element. \param anchor  its origin in the wall's coordinates
class BodyBuilder {
 public:
  /// \param wall  what reveals look like, which outputs add
  BodyBuilder(Point2 anchor, std::string name, const model::PartMaterial& wall) : anchor_(anchor) {
    body_.at = anchor;
    body_.element.name = std::move(name);
    body_.element.kind = kRuleGeometry;
    body_.materials = {};
    body_.materials[static_cast<std::size_t>(model::ElementPart::wall)] = wall;
    used_[static_cast<std::size_t>(model::ElementPart::wall)] = true;
  }

  void add(std::span<const Point3> polygon, const model::PartMaterial& look, double forward = 0) {
    std::vector<std::uint32_t> corners;
    for (const Point3& p : polygon) {
      const std::uint32_t at = vertex(model::snap(Point3{p.x - anchor_.x, p.y - anchor_.y, p.z + forward}));
      if (corners.empty() || (corners.back() != at && corners.front() != at)) corners.push_back(at);
    }
    model::ElementMesh& mesh = body_.element.mesh;
    if (corners.size() < 3 || !has_area(mesh, corners)) return;  // thinner than the grid
    mesh.faces.push_back(
        {static_cast<std::uint32_t>(mesh.indices.size()), static_cast<std::uint32_t>(corners.size()), part(look)});
    mesh.indices.insert(mesh.indices.end(), corners.begin(), corners.end());
  }
  void count() { ++body_.leaves; }
  model::Element& element() { return body_.element; }
  RuleBody take() { return std::move(body_); }

 private:
  std::uint32_t vertex(Point3 p) {
    auto& all = body_.element.mesh.vertices;
    const auto [at, is_new] = number_.try_emplace(p, static_cast<std::uint32_t>(all.size()));
    if (is_new) all.push_back(p);
    return at->second;
  }

  static bool has_area(const model::ElementMesh& mesh, const std::vector<std::uint32_t>& corners) {
    const auto at = [&](std::size_t i) {
      const Point3& p = mesh.vertices[corners[i % corners.size()]];
      return Vector3{p.x, p.y, p.z};
    };
    Vector3 sum{};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) sum = sum + grammar::cross(at(i) - at(0), at(i + 1) - at(0));
    return grammar::length(sum) > kSmallest;
  }

  /// An element has as many looks as parts; what comes later takes the nearest.
  model::ElementPart part(const model::PartMaterial& look) {
    std::size_t nearest = 0;
    int least = 1 << 30;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i]) continue;
      const model::PartMaterial& other = body_.materials[i];
      if (other == look) return static_cast<model::ElementPart>(i);
      const int far = std::abs(other.colour.r - look.colour.r) + std::abs(other.colour.g - look.colour.g) +
                      std::abs(other.colour.b - look.colour.b);
      if (far < least) least = far, nearest = i;
    }
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (used_[i]) continue;
      used_[i] = true;
      body_.materials[i] = look;
      return static_cast<model::ElementPart>(i);
    }
    return static_cast<model::ElementPart>(nearest);
  }

  Point2 anchor_;
  RuleBody body_;
  std::map<Point3, std::uint32_t> number_;
  std::array<bool, model::kElementPartCount> used_{};
};

/// Middle of the lower edge: equal leaves become equal elements wherever they stand.
Point2 anchor_of(Point3 low, Point3 high) { return {(low.x + high.x) / 2, low.y}; }

/// Leaves that lie in the wall, and what is before them, in one opening.
RuleBody sunk_body(std::span<const LeafPolygons* const> leaves, Point3 low, Point3 high,
                   const model::PartMaterial& usual) {
  const Point2 anchor = anchor_of(low, high);
  const LeafPolygons* main = leaves[0];
  const auto area = [](const LeafPolygons& l) { return (l.high.x - l.low.x) * (l.high.y - l.low.y); };
  for (const LeafPolygons* l : leaves)
    if (area(*l) > area(*main) + kSmallest) main = l;
  BodyBuilder builder(anchor, main->symbol, usual);
  for (const LeafPolygons* l : leaves) {
    for (const auto& polygon : l->polygons) builder.add(polygon, l->look);
    builder.count();
  }
  // Behind everything a wall: nobody looks into the house between leaves.
  const double deep = -low.z;
  const std::array<Point3, 4> back{Point3{low.x, low.y, -deep - kPaint}, Point3{high.x, low.y, -deep - kPaint},
                                   Point3{high.x, high.y, -deep - kPaint}, Point3{low.x, high.y, -deep - kPaint}};
  builder.add(back, usual);
  model::Element& element = builder.element();
  element.semantic = has_word(main->symbol, {"door", "doors", "gate", "portal", "entrance"})
                         ? model::ElementClass::door
                         : model::ElementClass::window;
  element.opening.reveal = std::nearbyint(deep * model::kGridStepsPerMetre) / model::kGridStepsPerMetre;
  return builder.take();
}

/// The rectangle that a body needs in the wall.
void set_opening(RuleBody& body, Point3 low, Point3 high) {
  const Point2 from = model::snap(Point2{low.x - body.at.x, low.y - body.at.y}),
               to = model::snap(Point2{high.x - body.at.x, high.y - body.at.y});
  body.element.opening.outline = {from, {to.x, from.y}, to, {from.x, to.y}};
}

/// Leaves that lie in the wall, and whose boxes meet.
struct SunkBox {
  Point3 low, high;
  std::vector<std::size_t> leaves;
};

std::vector<SunkBox> sunk_boxes(const std::vector<LeafPolygons>& leaves) {
  std::vector<SunkBox> boxes;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (!is_sunk(leaves[i])) continue;
    SunkBox box{leaves[i].low, leaves[i].high, {i}};
    for (bool grew = true; grew;) {
      grew = false;
      for (std::size_t b = 0; b < boxes.size(); ++b) {
        const SunkBox& other = boxes[b];
        if (other.low.x > box.high.x + kShared || other.high.x < box.low.x - kShared ||
            other.low.y > box.high.y + kShared || other.high.y < box.low.y - kShared)
          continue;
        box.low = {std::min(box.low.x, other.low.x), std::min(box.low.y, other.low.y),
                   std::min(box.low.z, other.low.z)};
        box.high = {std::max(box.high.x, other.high.x), std::max(box.high.y, other.high.y),
                    std::max(box.high.z, other.high.z)};
        box.leaves.insert(box.leaves.begin(), other.leaves.begin(), other.leaves.end());
        boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
        grew = true;
        break;
      }
    }
    boxes.push_back(std::move(box));
  }
  return boxes;
}

struct Rectangle {
  double left = 0, right = 0, low = 0, high = 0;  ///< m, in the wall's coordinates
};

/// Where elements are ordered: they have openings of their own.
std::vector<Rectangle> rectangles_of_orders(std::span<const Leaf> leaves) {
  std::vector<Rectangle> out;
  for (const Leaf& leaf : leaves) {
    if (!leaf.order) continue;
    const grammar::Frame frame = grammar::scope_in_object(leaf.shape);
    out.push_back(
        {frame.origin.x, frame.origin.x + leaf.shape.size.x, frame.origin.y, frame.origin.y + leaf.shape.size.y});
  }
  return out;
}

bool meets(const KeptFree& portal, Point3 low, Point3 high) {
  return low.x < portal.right && high.x > portal.left && low.y < portal.high;
}

/// What of a convex polygon lies where `side` is not negative; side is linear.
template <class Side>
std::vector<Point3> clipped(const std::vector<Point3>& polygon, Side&& side) {
  std::vector<Point3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = side(a), db = side(b);
    if (da >= 0) out.push_back(a);
    if ((da < 0) != (db < 0)) {
      const double t = da / (da - db);
      out.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t});
    }
  }
  return out.size() >= 3 ? out : std::vector<Point3>{};
}

/// Cuts off what would stand in a portal: left of it, right of it and above it remain.
std::vector<std::vector<Point3>> without(const std::vector<std::vector<Point3>>& polygons, const KeptFree& portal) {
  std::vector<std::vector<Point3>> out;
  const auto keep = [&](std::vector<Point3> piece) {
    if (!piece.empty()) out.push_back(std::move(piece));
  };
  for (const auto& polygon : polygons) {
    keep(clipped(polygon, [&](const Point3& p) { return portal.left - p.x; }));
    keep(clipped(polygon, [&](const Point3& p) { return p.x - portal.right; }));
    keep(clipped(clipped(clipped(polygon, [&](const Point3& p) { return p.x - portal.left; }),
                         [&](const Point3& p) { return portal.right - p.x; }),
                 [&](const Point3& p) { return p.y - portal.high; }));
  }
  return out;
}

}  // namespace

bool makes_geometry(const grammar::Program& program) {
  // Operations that leave flat, bare pieces of a wall flat and bare; `t`, `s` and `set` by their arguments.
  constexpr std::string_view kFlat[] = {
      "split",  "splitArea",  "comp",        "NIL",       "print",          "report",   "label",
      "center", "offset",     "setback",     "shapeL",    "shapeU",         "shapeO",   "cleanupGeometry",
      "tag",    "deleteTags", "deleteHoles", "convexify", "innerRectangle", "innerRect"};
  for (const grammar::Module& module : program.modules) {
    const grammar::Unit& unit = *module.unit;
    const auto is_nothing = [&](const grammar::ArgumentNode& a, double number, grammar::Mark mark) {
      const grammar::Expression& e = unit.expressions[a.value];
      return a.mark == mark && e.kind == grammar::ExpressionKind::number && e.number == number;
    };
    for (const grammar::Call& call : unit.calls) {
      if (call.use == grammar::kNone || module.targets[call.use].kind != grammar::TargetKind::operation) continue;
      const std::string& name = unit.name(call.name);
      const auto arguments = grammar::Unit::slice(unit.arguments, call.arguments);
      if (std::find(std::begin(kFlat), std::end(kFlat), name) != std::end(kFlat)) continue;
      if ((name == "t" || name == "translate") && arguments.size() == 3 &&
          is_nothing(arguments[2], 0, grammar::Mark::plain))
        continue;
      if (name == "s" && arguments.size() == 3 &&
          (is_nothing(arguments[2], 0, grammar::Mark::plain) || is_nothing(arguments[2], 1, grammar::Mark::relative)))
        continue;
      if (name == "set" && !arguments.empty()) {
        const grammar::Expression& what = unit.expressions[arguments[0].value];
        if (what.kind == grammar::ExpressionKind::name && !unit.name(what.name).starts_with("material")) continue;
      }
      return true;
    }
  }
  return false;
}

model::Element before_wall(const model::Element& sunk) {
  model::Element out = sunk;
  out.semantic = model::ElementClass::installation;
  if (!sunk.opening.outline.empty()) {  // the plate behind everything is for openings
    out.mesh.indices.resize(out.mesh.faces.back().first);
    out.mesh.faces.pop_back();
  }
  for (Point3& v : out.mesh.vertices) v.z = model::snap(v.z + sunk.opening.reveal + 2 * kPaint);
  out.opening = {};
  return out;
}

RuleGeometry rule_geometry(std::span<const Leaf> leaves, const WallFrame& wall, std::span<const KeptFree> portals,
                           const model::PartMaterial& usual, const model::PartMaterial* painted,
                           const attributes::Defaults& defaults) {
  RuleGeometry out;
  std::vector<LeafPolygons> made;
  for (const Leaf& leaf : leaves) {
    if (leaf.order || !leaf.shape.mesh) continue;
    LeafPolygons l = leaf_polygons(leaf, grammar::scope_in_object(leaf.shape), usual, defaults);
    if (l.polygons.empty()) continue;
    if (leaf.shape.material && !leaf.shape.material->colour_map.empty() &&
        std::find(out.textures.begin(), out.textures.end(), leaf.shape.material->colour_map) == out.textures.end())
      out.textures.push_back(leaf.shape.material->colour_map);
    if (!std::isfinite(l.low.x + l.low.y + l.low.z + l.high.x + l.high.y + l.high.z)) {
      ++out.dropped[l.symbol + ": its place is no number"];
    } else if (l.low.z < -kDeepest) {
      ++out.dropped[fmt::format("{}: it lies deeper than {:g} m in the wall", l.symbol, kDeepest)];
    } else {
      made.push_back(std::move(l));
    }
  }
  const model::PartMaterial shown = out.ground = painted ? *painted : ground_look(made, usual);
  const auto is_bare = [&](const LeafPolygons& l) { return is_flat(l) && l.look == shown; };
  const std::vector<Rectangle> orders = rectangles_of_orders(leaves);
  // A body in an opening, or each leaf of it before the wall where none can be.
  std::vector<bool> in_opening(made.size(), false);
  std::vector<double> forward(made.size(), 0);
  for (const SunkBox& box : sunk_boxes(made)) {
    // Openings keep a border of wall.
    Point3 low = box.low, high = box.high;
    low.x = std::max(low.x, kOpeningBorder);
    high.x = std::min(high.x, wall.length - kOpeningBorder);
    low.y = std::max(low.y, kOpeningBorder);
    high.y = std::min(high.y, wall.height - kOpeningBorder);
    double filled = 0;
    for (const std::size_t i : box.leaves)
      filled += (made[i].high.x - made[i].low.x) * (made[i].high.y - made[i].low.y);
    const auto apart = [&](const Rectangle& r) {
      return r.left > box.high.x - kInPlane || r.right < box.low.x + kInPlane || r.low > box.high.y - kInPlane ||
             r.high < box.low.y + kInPlane;
    };
    const bool opens =
        high.x - low.x >= kLeastSunk && high.y - low.y >= kLeastSunk &&
        filled >= kLeastFilled * (box.high.x - box.low.x) * (box.high.y - box.low.y) &&
        std::all_of(orders.begin(), orders.end(), apart) &&
        std::none_of(portals.begin(), portals.end(), [&](const KeptFree& p) { return meets(p, box.low, box.high); });
    if (!opens) {
      for (const std::size_t i : box.leaves) forward[i] = kPaint - box.low.z;
      continue;
    }
    std::vector<const LeafPolygons*> together;
    for (const std::size_t i : box.leaves) together.push_back(&made[i]), in_opening[i] = true;
    // What the wall shows before the opening goes along: it would be cut away.
    for (std::size_t i = 0; i < made.size(); ++i) {
      const LeafPolygons& l = made[i];
      if (!is_flat(l) || in_opening[i] || l.low.x < box.low.x - kInPlane || l.high.x > box.high.x + kInPlane ||
          l.low.y < box.low.y - kInPlane || l.high.y > box.high.y + kInPlane)
        continue;
      in_opening[i] = true;
      together.push_back(&l);
    }
    RuleBody body = sunk_body(together, box.low, box.high, shown);
    set_opening(body, low, high);
    out.bodies.push_back(std::move(body));
  }
  std::size_t corners = 0;
  for (const RuleBody& body : out.bodies) corners += body.element.mesh.indices.size();
  for (std::size_t i = 0; i < made.size(); ++i) {
    LeafPolygons& l = made[i];
    if (in_opening[i] || is_bare(l)) continue;
    for (const KeptFree& portal : portals)
      if (meets(portal, l.low, l.high)) l.polygons = without(l.polygons, portal);
    if (l.polygons.empty()) {
      ++out.yielding;
      continue;
    }
    for (const auto& polygon : l.polygons) corners += polygon.size();
    if (corners > kMostWallCorners) {
      ++out.dropped[l.symbol + ": more than two million corners on one wall"];
      continue;
    }
    BodyBuilder builder(anchor_of(l.low, l.high), l.symbol, shown);
    for (const auto& polygon : l.polygons) builder.add(polygon, l.look, is_flat(l) ? kPaint : forward[i]);
    builder.count();
    // A leaf thinner than the grid shows nothing.
    if (RuleBody body = builder.take(); !body.element.mesh.faces.empty()) out.bodies.push_back(std::move(body));
  }
  for (std::size_t i = 0; i < made.size(); ++i)
    if (is_bare(made[i]) && !in_opening[i]) ++out.bare;
  return out;
}

}  // namespace blockrand::facades
