#include "pipeline/facades/roof_installations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/attributes/roof_edges.h"
#include "pipeline/base/random.h"
#include "pipeline/facades/bodies_on_roofs.h"
#include "pipeline/facades/buildings_in_stretches.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/plan_shape.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "styles/roofs/chimneys.h"
#include "styles/roofs/element_layout.h"
#include "styles/roofs/roof_slopes.h"
#include "styles/roofs/roof_windows.h"

namespace blockrand::facades {
namespace {

using model::BuildingPart;
using model::Point2;
using model::Point3;

/// m². Smaller bodies are sheds, porches and stair heads.
constexpr double kLeastPlan = 30;
/// m of frontage for each chimney: with a stove in every room; with one for each flat; with one for each house.
constexpr double kStoves = 6, kStovesOfFlats = 12, kBoilers = 18;
/// Share of detached houses of after 1945 that have a chimney (docs/style_measures.md §6).
constexpr double kDetachedWithChimney = 0.85;
/// Share of old houses without a mapped attic storey whose loft was converted (own choice).
constexpr double kConvertedLofts = 1.0 / 3;
/// m between roof windows: every second window axis (docs/style_measures.md §2.7: dormer_step).
constexpr double kRoofWindowStep = 4.8;
/// m by which an installation is raised at a time where the roof below it is not quite plane; whole steps of the grid.
constexpr double kRaise = 3 / model::kGridStepsPerMetre;
/// Times it is raised at most: to 1.2 cm, CityGML's usual tolerance of planes.
constexpr int kMostRaised = 4;
/// m that roof windows keep from a chimney: rafters on both sides of a trimmer (own choice).
constexpr double kFromChimney = 0.5;

double within(double low, double high, double share) { return low + (high - low) * share; }

class RoofInstaller {
 public:
  RoofInstaller(const masses::BuiltMasses& masses, const attributes::Defaults& defaults,
                const RoofInstallationOptions& options)
      : masses_(masses), defaults_(defaults), options_(options) {
    const auto face = [&](const char* material, model::Colour or_else) {
      model::Face f;
      const int number = defaults.material(material);
      f.material = static_cast<std::uint8_t>(std::max(number, 0));
      f.colour = number < 0 ? or_else : defaults.materials[static_cast<std::size_t>(number)].colour;
      return f;
    };
    constexpr model::Colour kBrick{0x9A, 0x5B, 0x47}, kConcrete{0xB8, 0xB6, 0xB0}, kSheet{0x4A, 0x4F, 0x52},
        kPane{0x51, 0x62, 0x6E};
    stack_.stack = face("brick", kBrick);
    stack_.top = face("concrete", kConcrete);
    window_.frame = face("metal", kSheet);
    window_.frame.colour = kSheet;
    window_.pane = face("glass", kPane);
    window_.pane.colour = kPane;
  }

  /// \param index  of the building in its region
  void furnish(model::Building& building, std::uint32_t index, model::Report& report) {
    left_out_ = {};
    BuildingPart* const body = main_body(building);
    if (!body || body->lod < 3 || body->lod3.solid.empty() || !body->lod3.solid.closed) return;
    if (!has_hearths(building.attributes, defaults_)) return;
    const double area = geometry::area(body->roof_plan.outer.size() >= 3 ? body->roof_plan : body->plan);
    if (!(area >= kLeastPlan)) return;
    const masses::BuiltMass* const standing =
        masses_.find({index, static_cast<std::uint32_t>(body - building.parts.data())});
    if (!standing) return;
    const std::vector<model::RoofEdge> edges = edges_of_plan(building, *body, standing->plan);
    const double width = building.situation.width.value_or(0);
    const double frontage = width > 0 ? width : std::sqrt(area);
    const std::vector<Point2> stacks = put_chimneys(building, *body, *standing, edges, frontage);
    put_roof_windows(building, *body, *standing, edges, stacks, is_old(building.attributes));
    if (left_out_.chimneys + left_out_.roof_windows == 0) return;
    body->fallbacks.push_back(model::IssueCode::roof_element_left_out);
    report.add(body->osm, model::IssueCode::roof_element_left_out,
               fmt::format("chimneys: {}, roof windows: {}", left_out_.chimneys, left_out_.roof_windows));
  }

 private:
  double share(const model::Building& building, std::string_view choice) const {
    return base::random_unit(options_.seed, building.osm.key(), choice);
  }

  /// Whether another body of the building is where it would stand.
  static bool in_another(const model::Building& building, const BuildingPart& body, const model::Solid& solid) {
    const HeightExtent mine = extent_of(solid);
    for (const BuildingPart& other : building.parts) {
      if (&other == &body || other.plan.outer.size() < 3) continue;
      const HeightExtent its = extent_of(other);
      if (its.high <= mine.low || its.low >= mine.high) continue;
      for (const Point3& p : solid.vertices)
        if (geometry::contains(other.plan, p.xy())) return true;
    }
    return false;
  }

  /// \return false where it is left out
  bool add(const model::Building& building, BuildingPart& body, model::RoofInstallation installation) {
    const bool chimney = installation.kind == model::RoofElementKind::chimney;
    const bool added = add_if_free(building, body, std::move(installation));
    if (!added) ++(chimney ? left_out_.chimneys : left_out_.roof_windows);
    return added;
  }

  static bool add_if_free(const model::Building& building, BuildingPart& body, model::RoofInstallation installation) {
    auto triangles = geometry::triangulate(installation.solid);
    if (!triangles || !geometry::check_solid(installation.solid, *triangles, geometry::kBuilt).valid()) return false;
    if (in_another(building, body, installation.solid)) return false;
    installation.triangles = std::move(*triangles);
    // Faces of roofs are plane by a centimetre only: what cuts into one is raised.
    for (int raised = 0; meets_a_body(building, installation); ++raised) {
      if (raised == kMostRaised) return false;
      for (Point3& p : installation.solid.vertices) p.z += kRaise;
    }
    body.lod3.roof_installations.push_back(std::move(installation));
    return true;
  }

  /// \return the corners of the stacks on the plan, four each
  std::vector<Point2> put_chimneys(const model::Building& building, BuildingPart& body,
                                   const masses::BuiltMass& standing, const std::vector<model::RoofEdge>& edges,
                                   double frontage) {
    const bool flat = body.built_roof == model::RoofShape::flat;
    const int count = wanted_chimneys(building.attributes, building.situation.position, flat, frontage,
                                      share(building, "has a chimney"));
    std::vector<Point2> out;
    if (count == 0) return out;
    roofs::ChimneyParameters p;  // in whole centimetres, as masons have it
    const auto drawn = [&](double low, double high, std::string_view choice) {
      return std::nearbyint(within(low, high, share(building, choice)) * 100) / 100;
    };
    p.width = drawn(0.50, 0.65, "chimney width");
    p.length = drawn(0.80, 1.60, "chimney length");
    p.above_ridge = drawn(0.50, 1.00, "chimney height");
    p.step = drawn(5.0, 7.0, "chimney step");
    p.frontage = frontage / count;
    for (model::RoofInstallation& stack : roofs::chimneys(standing.plan, edges, standing.roof, frontage, p, stack_)) {
      std::vector<Point2> corners;
      double top = -1e300;
      for (const Point3& v : stack.solid.vertices) top = std::max(top, v.z);
      for (const Point3& v : stack.solid.vertices)
        if (v.z == top) corners.push_back(v.xy());
      if (add(building, body, std::move(stack)) && corners.size() == 4)
        out.insert(out.end(), corners.begin(), corners.end());
    }
    return out;
  }

  void put_roof_windows(const model::Building& building, BuildingPart& body, const masses::BuiltMass& standing,
                        const std::vector<model::RoofEdge>& edges, const std::vector<Point2>& stacks, bool old) {
    const bool attic = body.attributes.roof_storeys.value >= 1;
    if (!attic && !(old && share(building, "converted loft") < kConvertedLofts)) return;
    const roofs::RoofWindowParameters window;
    const roofs::RoofBorders borders(standing.roof, edges);
    for (std::size_t s = 0; s < standing.roof.surfaces.size(); ++s) {
      auto slope = borders.slope(s);
      if (!slope || !roofs::takes_elements(*slope)) continue;
      const std::int32_t edge = standing.roof.surfaces[s].edge;
      const bool street = edge >= 0 && static_cast<std::size_t>(edge) < edges.size() &&
                          edges[static_cast<std::size_t>(edge)] == model::RoofEdge::street;
      if (street && !attic) continue;  // lofts are lit from the yard
      for (std::size_t i = 0; i + 4 <= stacks.size(); i += 4) occupy_stack(*slope, {&stacks[i], 4});
      roofs::LayoutRequest wanted_layout;
      wanted_layout.outline = roofs::roof_window_outline(window);
      wanted_layout.step = kRoofWindowStep;
      for (const double along : roofs::lay_out(*slope, wanted_layout).along)
        if (auto made = roofs::roof_window(*slope, window, {along, wanted_layout.up}, window_))
          add(building, body, std::move(*made));
    }
  }

  static void occupy_stack(roofs::RoofSlope& slope, std::span<const Point2> corners) {
    std::vector<Point2> ring(corners.begin(), corners.end());
    const Point2 middle{(ring[0].x + ring[2].x) / 2, (ring[0].y + ring[2].y) / 2};
    const auto half = [&](Point2 p) { return p.y < middle.y || (p.y == middle.y && p.x < middle.x); };
    std::sort(ring.begin(), ring.end(), [&](Point2 a, Point2 b) {  // about the middle, counter-clockwise
      if (half(a) != half(b)) return half(a);
      return (a.x - middle.x) * (b.y - middle.y) - (a.y - middle.y) * (b.x - middle.x) > 0;
    });
    roofs::occupy(slope, ring, kFromChimney);
  }

  const masses::BuiltMasses& masses_;
  const attributes::Defaults& defaults_;
  const RoofInstallationOptions& options_;
  struct {
    int chimneys = 0, roof_windows = 0;
  } left_out_;  ///< of the building at work
  roofs::ChimneyMaterials stack_;
  roofs::RoofWindowMaterials window_;
};

}  // namespace

int wanted_chimneys(const model::Attributes& attributes, model::BuildingPosition position, bool flat, double frontage,
                    double lot) {
  roofs::ChimneyParameters each;
  each.frontage = kStoves;
  if (is_old(attributes)) return roofs::chimney_count(frontage, each);
  if (attributes.era.value == model::name(model::Era::from1919)) {
    each.frontage = kStovesOfFlats;
    return roofs::chimney_count(frontage, each);
  }
  if (flat) return 0;
  if (position == model::BuildingPosition::free_standing && frontage < kBoilers)
    return lot < kDetachedWithChimney ? 1 : 0;
  each.frontage = kBoilers;
  return roofs::chimney_count(frontage, each);
}

void add_roof_installations(model::Region& region, const masses::BuiltMasses& masses,
                            const attributes::Defaults& defaults, const RoofInstallationOptions& options) {
  for_each_owned_building(
      region, [&] { return RoofInstaller(masses, defaults, options); },
      [](RoofInstaller& installer, model::Building& building, std::uint32_t index, model::Report& report) {
        installer.furnish(building, index, report);
      });
}

}  // namespace blockrand::facades
