#include "pipeline/outputs/gltf/panes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "pipeline/base/random.h"
#include "pipeline/model/usual_glass.h"
#include "pipeline/outputs/gltf/linear_light.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using model::Point3;

constexpr std::uint64_t kSeed = base::hash_text("panes");

/// m: what one household sees of a facade.
constexpr double kFlatWidth = 7;
/// Directions of facades are told apart in steps of 1/8.
constexpr double kDirectionSteps = 8;
/// Of bare panes: one window in so many is open or tilted, and mirrors something else than its row.
constexpr double kOtherMirror = 0.08;
/// Of the windows of a flat with curtains, so many have them.
constexpr double kHung = 0.8;
/// Share of the window's width that a curtain at one side takes, and of its height that a blind does.
constexpr double kCurtainShare = 0.24, kBlindShare = 0.42;
/// m. What is narrower is no strip of fabric but a sliver.
constexpr double kLeastStrip = 0.02;
/// m. Wider or higher elements are bands of glass and bays: fabric hangs before the whole of them, or not at all.
constexpr double kWidestWindow = 3.2, kHighestWindow = 3.6;

/// sRGB. Fabric is seen through two panes that let four fifths of the light pass each time.
struct Look {
  model::Colour glass, screen;
  float roughness;
};
constexpr std::array<Look, kPanesCount> kLooks = {{
    {{0, 0, 0}, {0, 0, 0}, 0.1f},
    {{0x2F, 0x34, 0x37}, {0, 0, 0}, 0.06f},
    {{0x66, 0x6F, 0x75}, {0, 0, 0}, 0.06f},
    {{0x32, 0x34, 0x34}, {0xB4, 0xAC, 0x9E}, 0.08f},
    {{0x8E, 0x8E, 0x89}, {0x8E, 0x8E, 0x89}, 0.08f},
    {{0x30, 0x34, 0x36}, {0xA3, 0x99, 0x88}, 0.08f},
    {{0x92, 0x99, 0x98}, {0, 0, 0}, 0.5f},
    {{0x45, 0x3D, 0x33}, {0, 0, 0}, 0.05f},
}};
const Look& look_of(Panes panes) { return kLooks[static_cast<std::size_t>(panes)]; }

bool is_dwelling(const std::string& use) {
  static const std::set<std::string, std::less<>> kOthers = {"commercial",  "office",     "retail",
                                                             "supermarket", "industrial", "warehouse",
                                                             "manufacture", "hangar",     "school",
                                                             "university",  "college",    "public",
                                                             "civic",       "government", "train_station",
                                                             "sports_hall", "church",     "chapel",
                                                             "cathedral",   "mosque",     "synagogue",
                                                             "temple",      "garage",     "garages",
                                                             "parking",     "shed",       "barn",
                                                             "stable",      "cowshed",    "farm_auxiliary",
                                                             "greenhouse",  "service",    "transformer_tower",
                                                             "stadium",     "silo"};
  return !kOthers.contains(use);
}

/// The extent of an element's glass.
struct Extent {
  double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
  bool empty() const { return !(right >= left); }
};
Extent extent_of_glass(const model::Element& element) {
  Extent out;
  for (const model::ElementFace& face : element.mesh.faces) {
    if (face.part != model::ElementPart::glass) continue;
    for (std::uint32_t i = 0; i < face.count; ++i) {
      const Point3& p = element.mesh.vertices[element.mesh.indices[face.first + i]];
      out.left = std::min(out.left, p.x), out.right = std::max(out.right, p.x);
      out.low = std::min(out.low, p.y), out.high = std::max(out.high, p.y);
    }
  }
  return out;
}

bool has_glass(const model::Element& element) {
  return std::ranges::any_of(element.mesh.faces,
                             [](const model::ElementFace& f) { return f.part == model::ElementPart::glass; });
}

/// The part of a convex polygon where `side`, linear in its corners, is not negative.
template <class Side>
std::vector<Point3> clipped(std::span<const Point3> face, const Side& side) {
  std::vector<Point3> out;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Point3 &a = face[i], &b = face[(i + 1) % face.size()];
    const double u = side(a), v = side(b);
    if (u >= 0) out.push_back(a);
    if ((u > 0 && v < 0) || (u < 0 && v > 0)) {
      // The same point from both ends.
      const bool turned = u < 0;
      const Point3 &from = turned ? b : a, &to = turned ? a : b;
      const double t = turned ? v / (v - u) : u / (u - v);
      out.push_back({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y), from.z + t * (to.z - from.z)});
    }
  }
  return out;
}

}  // namespace

std::string_view glass_kind(Panes panes) {
  switch (panes) {
    case Panes::as_modelled:
      return "other";
    case Panes::clear:
      return "clear";
    case Panes::sky:
      return "sky";
    case Panes::curtains:
    case Panes::net:
      return "curtain";
    case Panes::blind:
      return "blind";
    case Panes::frosted:
      return "frosted";
    case Panes::shop:
      return "shop";
  }
  return "other";
}

Panes panes_of(const model::BuildingPart& part, const model::Placement& placement,
               const model::ColouredElement& element) {
  if (!has_glass(*element.element) ||
      element.materials[static_cast<std::size_t>(model::ElementPart::glass)].colour != model::kUsualGlass)
    return Panes::as_modelled;
  const std::string& kind = element.element->kind;
  const bool ground = placement.storey <= 0;
  if (kind == "shop_window") return ground ? Panes::shop : Panes::clear;
  const model::Point2 corner = part.plan.outer.points.empty() ? model::Point2{} : part.plan.outer.points.front();
  const double along =
      (placement.origin.x - corner.x) * placement.along.x + (placement.origin.y - corner.y) * placement.along.y;
  const auto number = [](double v) { return static_cast<std::uint64_t>(std::llround(v)); };
  const auto mixed = [](std::uint64_t key, std::uint64_t with) { return base::mix64(key ^ with); };
  const std::uint64_t facade = mixed(mixed(base::hash_text(part.id), number(placement.along.x * kDirectionSteps)),
                                     number(placement.along.y * kDirectionSteps));
  const std::uint64_t row = mixed(facade, static_cast<std::uint64_t>(placement.storey));
  const std::uint64_t flat = mixed(row, number(std::floor(along / kFlatWidth)));
  // Decimetres, and those above it: no two windows stand closer.
  const std::uint64_t window =
      mixed(mixed(row, number(along * 10)), number((placement.origin.z - part.attributes.ground_height.value) * 10));
  const auto chance = [](std::uint64_t key, std::string_view of) { return base::random_unit(kSeed, key, of); };
  if (element.element->semantic == model::ElementClass::door || kind == "cellar_window")
    return chance(window, "frosted") < 0.5 ? Panes::frosted : Panes::clear;

  // Bare panes: the whole row alike. The higher it is, the likelier it mirrors the sky and no house.
  const double sky_from = 1 + 5 * chance(facade, "sky");
  bool sky = placement.storey + 0.5 > sky_from;
  if (chance(window, "mirror") < kOtherMirror) sky = !sky;
  const Panes bare = sky ? Panes::sky : Panes::clear;
  if (element.element->semantic != model::ElementClass::window && kind != "bay") return bare;
  if (!is_dwelling(part.attributes.use.value))
    return chance(flat, "blind") < 0.3 && chance(window, "hung") < kHung ? Panes::blind : bare;
  if (chance(window, "hung") >= kHung) return bare;
  const double taste = chance(flat, "fabric");
  // Passers-by look into ground floors.
  const double shielded = ground ? 0.7 : 0.5;
  if (taste >= shielded) return bare;
  const double share = taste / shielded;
  return ground ? (share < 0.55  ? Panes::net
                   : share < 0.8 ? Panes::blind
                                 : Panes::curtains)
                : (share < 0.5    ? Panes::curtains
                   : share < 0.78 ? Panes::net
                                  : Panes::blind);
}

PaneMaterials::PaneMaterials(const model::Region& region) : classes_(region.materials) {
  for (std::size_t i = 0; i < classes_.size(); ++i)
    if (classes_[i].name == "glass") glass_ = static_cast<int>(i);
  // Classes are some thirty of 256.
  if (classes_.size() + kPanesCount <= 256) first_ = static_cast<int>(classes_.size());
}

model::PartMaterial PaneMaterials::look(Panes panes, bool screen, const model::PartMaterial& modelled) const {
  if (panes == Panes::as_modelled || first_ == 256) return modelled;
  const Look& look = look_of(panes);
  return {static_cast<std::uint8_t>(first_ + static_cast<int>(panes)), screen ? look.screen : look.glass};
}

std::string PaneMaterials::glass_json(std::uint8_t material, const std::optional<model::Colour>& colour,
                                      MaterialName name) const {
  const bool modelled = material < first_;
  const Panes panes = modelled ? Panes::as_modelled : static_cast<Panes>(material - first_);
  const std::string kind(glass_kind(panes));
  std::string json = R"({"emissiveFactor":[0,0,0],"extras":{"classes":["glass"],)";
  const auto append_linear = [&](const model::Colour& c) {
    for (const std::uint8_t part : {c.r, c.g, c.b}) {
      if (json.back() != '[') json += ',';
      append_number(json, std::nearbyint(kLinearLight[part] / 0.65535) / 1e5);
    }
  };
  if (!modelled) {
    json += "\"colour\":[";
    append_linear(model::kUsualGlass);
    json += "],";
  }
  json += "\"glass_kind\":\"" + kind + "\"},\"name\":";
  append_json(json,
              colour && name == MaterialName::with_colour ? "glass " + kind + ' ' + model::text(*colour) : "glass");
  json += ",\"pbrMetallicRoughness\":{";
  if (colour) {
    json += "\"baseColorFactor\":[";
    append_linear(*colour);
    json += ",1],";
  }
  json += "\"metallicFactor\":0,\"roughnessFactor\":";
  append_number(json, std::nearbyint(static_cast<double>(look_of(panes).roughness) * 100) / 100);
  return json + "}}";
}

std::string PaneMaterials::json(const model::PartMaterial& look, MaterialName name) const {
  return is_glass(look.material) ? glass_json(look.material, look.colour, name)
                                 : material_json(classes_[look.material], look.colour, name);
}

PaneCut::PaneCut(Panes panes, const model::Element& element) : panes_(panes) {
  if (panes != Panes::curtains && panes != Panes::blind) return;
  const Extent e = extent_of_glass(element);
  const double width = e.right - e.left, height = e.high - e.low;
  if (e.empty() || element.semantic != model::ElementClass::window || width > kWidestWindow ||
      height > kHighestWindow) {
    panes_ = Panes::clear;  // not divided
    return;
  }
  left_ = e.left + kCurtainShare * width;
  right_ = e.right - kCurtainShare * width;
  low_ = e.high - kBlindShare * height;
}

std::vector<PanePiece> PaneCut::cut(std::span<const Point3> face) const {
  std::vector<PanePiece> out;
  if (panes_ != Panes::curtains && panes_ != Panes::blind) {
    out.push_back({{face.begin(), face.end()}, panes_ == Panes::net});
    return out;
  }
  double left = face[0].x, right = left, low = face[0].y, high = low;
  for (const Point3& p : face) {
    left = std::min(left, p.x), right = std::max(right, p.x);
    low = std::min(low, p.y), high = std::max(high, p.y);
  }
  const auto add = [&](std::vector<Point3> piece, bool screen) {
    if (piece.size() >= 3) out.push_back({std::move(piece), screen});
  };
  std::vector<Point3> rest(face.begin(), face.end());
  if (panes_ == Panes::blind) {
    if (high - low_ < kLeastStrip) return {{std::move(rest), false}};
    if (low_ - low < kLeastStrip) return {{std::move(rest), true}};
    add(clipped(rest, [&](const Point3& p) { return p.y - low_; }), true);
    add(clipped(rest, [&](const Point3& p) { return low_ - p.y; }), false);
    return out;
  }
  if (left_ - left >= kLeastStrip) {
    if (right - left_ < kLeastStrip) return {{std::move(rest), true}};
    add(clipped(rest, [&](const Point3& p) { return left_ - p.x; }), true);
    rest = clipped(rest, [&](const Point3& p) { return p.x - left_; });
  }
  if (right - right_ >= kLeastStrip) {
    if (right_ - left < kLeastStrip) return {{std::move(rest), true}};
    add(clipped(rest, [&](const Point3& p) { return p.x - right_; }), true);
    rest = clipped(rest, [&](const Point3& p) { return right_ - p.x; });
  }
  add(std::move(rest), false);
  return out;
}

}  // namespace blockrand::outputs
