#include "pipeline/facades/roof_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "pipeline/attributes/roof_edges.h"
#include "pipeline/facades/bodies_on_roofs.h"
#include "pipeline/facades/buildings_in_stretches.h"
#include "pipeline/facades/roof_elements.h"
#include "pipeline/geometry/plan_shape.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/caps.h"
#include "styles/roofs/firewalls.h"
#include "styles/roofs/gables.h"
#include "styles/roofs/gutters.h"
#include "styles/roofs/overhangs.h"
#include "styles/roofs/parapets.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::facades {
namespace {

using model::BuildingPart;
using model::Point2;
using model::Point3;
using model::RoofElementKind;
using model::SurfaceKind;
using roofs::PlanEdge;

/// m. Eaves of houses of before 1919, whose walls end in a course, and of later ones (docs/style_measures.md 2.5: 0.3 to 0.6).
constexpr double kOldEaves = 0.30, kEaves = 0.40;
/// Verges go out half as far (docs/gables_and_edges.md).
constexpr double kVergeShare = 0.5;
/// m². Smaller bodies are sheds and garages, whose eaves are half as wide (own choice).
constexpr double kLeastHouse = 40;
/// m. A parapet of today (docs/style_measures.md 2.3: 0.4 to 0.6 [K]).
constexpr double kParapet = 0.40;
/// m by which a neighbour's eaves must be lower for a fire wall: with less the two roofs may be one (own choice).
constexpr double kLowerNeighbour = 2.0;
/// m. An eaves' body at its highest comes down the wall so far (OverhangOptions::thickness, most_drop).
constexpr double kEavesDepth = 0.25;
/// m that a wall rises between its ends: less is no gable.
constexpr double kLeastGable = 0.5;
/// m². What two gables have in common by rounding.
constexpr double kLeastCommon = 1e-3;
/// m between places at which the room before a wall is felt for, along it and away from it.
constexpr double kFeelAlong = 0.5, kFeelOut = 0.05;

/// What is seen of a body's faces.
struct Looks {
  model::Face roof, wall, board, sheet;
};

class RoofDresser {
 public:
  RoofDresser(const std::vector<model::ColouredElement>& elements, const masses::BuiltMasses& masses,
              const attributes::Defaults& defaults, const OutlinesNear& outlines)
      : elements_(elements), masses_(masses), defaults_(defaults), outlines_near_(outlines) {
    const auto face = [&](const char* material, model::Colour colour) {
      model::Face f;
      f.material = static_cast<std::uint8_t>(std::max(defaults.material(material), 0));
      f.colour = colour;
      return f;
    };
    constexpr model::Colour kPaintedWood{0xD9, 0xD2, 0xC4}, kZinc{0x9A, 0xA0, 0xA3};
    board_ = face("wood", kPaintedWood);
    sheet_ = face("metal", kZinc);
  }

  /// \param index  of the building in its region
  void dress(model::Building& building, std::uint32_t index, model::Report& report) {
    const attributes::OutlineSegments segments(building);
    std::vector<model::Polygon> others;
    bool looked = false;
    for (std::uint32_t p = 0; p < building.parts.size(); ++p) {
      BuildingPart& body = building.parts[p];
      if (body.canopy || body.lod < 3 || body.lod3.solid.empty() || !body.lod3.solid.closed) continue;
      const masses::BuiltMass* const standing = masses_.find({index, p});
      if (!standing) continue;
      if (!looked) others = others_near(building), looked = true;
      left_out_.clear();
      other_gables_ = 0;
      dress_body(building, body, *standing, segments, others);
      if (left_out_.empty() && other_gables_ == 0) continue;
      body.fallbacks.push_back(model::IssueCode::roof_element_left_out);
      std::string text;
      for (const auto& [kind, count] : left_out_)
        text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", model::name(kind), count);
      if (other_gables_ > 0)
        text +=
            fmt::format("{}gables of other steps or curves than ordered: {}", text.empty() ? "" : ", ", other_gables_);
      report.add(body.osm, model::IssueCode::roof_element_left_out, text);
    }
  }

 private:
  static constexpr double kFarthest = kMostOverhang * 3.5;  ///< m: mitres of sharp corners end within this

  std::vector<model::Polygon> others_near(const model::Building& building) const {
    geometry::PlanBox box;
    for (const BuildingPart& part : building.parts)
      for (const Point2 p : part.plan.outer.points) box.include(p);
    return box.empty() ? std::vector<model::Polygon>() : outlines_near_(box, kFarthest, building.osm);
  }

  Looks looks_of(const BuildingPart& body) const {
    Looks looks;
    looks.board = board_, looks.sheet = sheet_;
    bool roof = false, wall = false;
    for (const model::Face& face : body.lod2.faces) {
      if (face.kind == SurfaceKind::roof && !roof) looks.roof = face, roof = true;
      if (face.kind == SurfaceKind::wall && !wall) looks.wall = face, wall = true;
    }
    return looks;
  }

  static void paint(model::RoofInstallation& body, const Looks& looks) {
    const bool metal = body.kind == RoofElementKind::gutter || body.kind == RoofElementKind::downpipe;
    const bool hangs = body.kind == RoofElementKind::eaves || body.kind == RoofElementKind::verge;
    const bool cap = body.kind == RoofElementKind::ridge_cap || body.kind == RoofElementKind::hip_cap;
    for (model::Face& face : body.solid.faces) {
      const bool up = face.kind == SurfaceKind::roof;
      const model::Face& look = metal   ? looks.sheet
                                : hangs ? (up ? looks.roof : looks.board)
                                : cap   ? looks.roof
                                : up    ? looks.sheet
                                        : looks.wall;
      face.material = look.material, face.colour = look.colour;
    }
  }

  /// Convex pieces of the plan that chimneys stand on, counter-clockwise.
  static std::vector<std::vector<Point2>> stacks_on(const BuildingPart& body) {
    std::vector<std::vector<Point2>> out;
    for (const model::RoofInstallation& stack : body.lod3.roof_installations) {
      if (stack.kind != RoofElementKind::chimney) continue;
      if (std::vector<Point2> ring = top_of(stack); ring.size() >= 3) out.push_back(std::move(ring));
    }
    return out;
  }

  /// The plan of a chimney's top.
  static std::vector<Point2> top_of(const model::RoofInstallation& stack) {
    std::vector<Point2> ring;
    for (const model::Face& face : stack.solid.faces) {
      if (face.kind != SurfaceKind::roof) continue;
      for (const std::uint32_t v : stack.solid.indices_of(stack.solid.loops_of(face)[0]))
        ring.push_back(stack.solid.vertices[v].xy());
      break;
    }
    return ring;
  }

  /// Whether a course of the facade ends the wall where eaves would begin.
  static bool has_cornice(const BuildingPart& body, const PlanEdge& edge, double top) {
    constexpr double kFarthestCourse = 1.5, kFace = 0.02;  // m before the wall
    for (const model::WallInstallation& course : body.lod3.installations) {
      double high = -1e300;
      for (const Point3& p : course.solid.vertices) high = std::max(high, p.z);
      if (high < top - kEavesDepth) continue;
      for (const Point3& p : course.solid.vertices) {
        if (p.z < top - kEavesDepth) continue;
        const Point2 d = p.xy() - edge.from;
        const double along = dot(d, edge.along), out = -dot(d, edge.inward());
        if (out > kFace && out < kFarthestCourse && along > -kFace && along < edge.length + kFace) return true;
      }
    }
    return false;
  }

  /// Whether nothing that the facade has on a wall is in a downpipe's way: openings, balconies, bays.
  bool may_come_down(const BuildingPart& body, Point2 foot, Point2 along, double half) const {
    constexpr double kClear = 0.25;  // m beside openings, whose surrounds are as wide
    constexpr double kOnWall = 0.6;  // m from the wall's line: reveals and bays are of this wall
    const Point2 outward{along.y, -along.x};
    const auto off_wall = [&](Point2 p) { return std::fabs(dot(p - foot, outward)) > kOnWall; };
    const auto meets = [&](double least, double most) { return least < half + kClear && most > -half - kClear; };
    for (const model::Opening& opening : body.lod3.openings) {
      double least = 1e300, most = -1e300;
      const model::Face& face = body.lod3.solid.faces[opening.polygon];
      for (const std::uint32_t v : body.lod3.solid.indices_of(body.lod3.solid.loops_of(face)[0])) {
        const Point2 p = body.lod3.solid.vertices[v].xy();
        if (off_wall(p)) continue;
        least = std::min(least, dot(p - foot, along)), most = std::max(most, dot(p - foot, along));
      }
      if (meets(least, most)) return false;
    }
    for (const model::Placement& placed : body.lod3.placements) {
      const model::Element& element = *elements_[placed.element].element;
      if ((element.kind != "balcony" && element.kind != "bay") || off_wall(placed.origin.xy())) continue;
      const double at = dot(placed.origin.xy() - foot, along), turned = dot(placed.along, along);
      double least = 1e300, most = -1e300;
      for (const Point3& p : element.mesh.vertices)
        least = std::min(least, at + turned * p.x), most = std::max(most, at + turned * p.x);
      if (meets(least, most)) return false;
    }
    return true;
  }

  static Point2 before(const PlanEdge& e, double along, double by) {
    return {e.from.x + e.along.x * along - e.inward().x * by, e.from.y + e.along.y * along - e.inward().y * by};
  }

  /// m before each edge that are free, as far as overhangs go; beyond its ends as well, where mitres go.
  static std::vector<double> rooms_before(const std::vector<PlanEdge>& edges, const std::vector<model::RoofEdge>& kinds,
                                          const std::vector<model::Polygon>& others, double most) {
    std::vector<geometry::PlanBox> boxes;
    for (const model::Polygon& other : others) boxes.push_back(geometry::box_of(other.outer.points));
    std::vector<double> rooms;
    std::vector<std::size_t> near;
    for (const PlanEdge& e : edges) {
      double room = 1e9;
      geometry::PlanBox strip;
      for (const double along : {-most, e.length + most})
        for (const double by : {0.0, most + kFeelOut}) strip.include(before(e, along, by));
      near.clear();
      for (std::size_t i = 0; i < others.size(); ++i)
        if (boxes[i].near(strip, 0)) near.push_back(i);
      const auto feel = [&](double along) {
        for (double by = kFeelOut; by <= most + kFeelOut && by - kFeelOut < room; by += kFeelOut) {
          const Point2 p = before(e, along, by);
          for (const std::size_t i : near)
            if (boxes[i].near({p, p}, 1 / model::kGridStepsPerMetre) && geometry::contains(others[i], p)) {
              room = by - kFeelOut;
              return;
            }
        }
      };
      if (!near.empty()) {
        const int samples = std::max(2, static_cast<int>(e.length / kFeelAlong));
        const double inset = std::min(0.02, e.length / 3);  // m: corners of a neighbour that only touch are none
        for (int i = 0; i <= samples && room > 0; ++i)
          feel(std::clamp(e.length * i / samples, inset, e.length - inset));
        // Beside a party wall the overhang ends on that wall's line, which may lean outwards.
        constexpr double kLeaning = 0.2;  // m
        for (double beyond = 0.1; beyond <= most && room > 0; beyond += 0.1) {
          if (kinds[e.before] != model::RoofEdge::party_wall || beyond <= kLeaning) feel(-beyond);
          if (kinds[e.after] != model::RoofEdge::party_wall || beyond <= kLeaning) feel(e.length + beyond);
        }
      }
      rooms.push_back(room);
    }
    return rooms;
  }

  void dress_body(const model::Building& building, BuildingPart& body, const masses::BuiltMass& standing,
                  const attributes::OutlineSegments& segments, const std::vector<model::Polygon>& outlines) {
    const model::Polygon& plan = standing.plan;
    const roofs::Roof& roof = standing.roof;
    const std::vector<PlanEdge> edges = roofs::plan_edges(plan);
    if (edges.size() != roof.wall_tops.size()) return;
    std::vector<model::RoofEdge> kinds(edges.size(), model::RoofEdge::open);
    if (!segments.empty())
      for (std::size_t i = 0; i < edges.size(); ++i) kinds[i] = segments.kind(edges[i].from, edges[i].to);
    std::vector<model::Polygon> others = outlines;
    for (const BuildingPart& other : building.parts)
      if (&other != &body && other.plan.outer.size() >= 3) others.push_back(other.plan);

    const bool old = is_old(building.attributes), small = geometry::area(plan) < kLeastHouse;
    const Looks looks = looks_of(body);
    std::vector<std::vector<Point2>> taken = stacks_on(body);
    std::vector<model::RoofInstallation> bodies;
    const auto take = [&](roofs::BuiltElements&& built, RoofElementKind kind) {
      std::ranges::move(built.bodies, std::back_inserter(bodies));
      if (built.refused > 0) left_out_[kind] += built.refused;
    };

    std::vector<bool> has_gable(edges.size(), false);
    if (standing.gable) put_gables(body, standing, kinds, has_gable, taken, bodies);

    if (old && !small) {
      std::vector<roofs::FirewallSide> sides(edges.size());
      bool any = false;
      for (std::size_t i = 0; i < edges.size(); ++i) {
        if (kinds[i] != model::RoofEdge::party_wall) continue;
        double top = 1e300;
        for (const Point3& p : roof.wall_tops[i]) top = std::min(top, p.z);
        const double covered = building.attributes.ground_height.value + segments.covered(edges[i].from, edges[i].to);
        if (covered > top - kLowerNeighbour) continue;
        sides[i] = {true, {{0, covered}}};
        any = true;
      }
      if (any) {
        roofs::BuiltFirewalls walls = roofs::firewalls(plan, roof, sides, taken);
        std::ranges::move(walls.places, std::back_inserter(taken));
        take(std::move(walls.elements), RoofElementKind::firewall);
      }
    }

    std::vector<bool> level(edges.size(), true), bare(edges.size(), false);
    bool any_level = false;
    for (const roofs::TopSegment& s : roofs::top_segments(plan, roof)) {
      const bool is = s.surface >= 0 && roofs::is_level(roof.surfaces[static_cast<std::size_t>(s.surface)]);
      any_level = any_level || is;
      if (!is) level[s.edge] = false;
    }
    const std::optional<double>& parapet = standing.edge_orders.parapet;
    if (any_level && (parapet ? *parapet > 0 : !small && has_parapet(building.attributes))) {
      for (std::size_t i = 0; i < edges.size(); ++i) bare[i] = has_gable[i] || kinds[i] == model::RoofEdge::party_wall;
      roofs::ParapetOptions options;
      options.height = parapet.value_or(kParapet);
      take(roofs::parapets(plan, roof, kinds, bare, taken, options), RoofElementKind::parapet);
    }

    roofs::OverhangOptions over;
    const masses::RoofEdgeOrders& asked = standing.edge_orders;
    const double usual_eaves = (old ? kOldEaves : kEaves) * (small ? 0.5 : 1);
    over.eaves = asked.eaves.value_or(usual_eaves);
    over.verge = asked.verge.value_or(usual_eaves * kVergeShare);
    const roofs::GutterOptions gutter;
    const bool has_gutters = asked.gutters && !small && over.eaves > 0 && has_gutter(looks);
    if (has_gutters) over.before_eaves = gutter.width;
    const std::vector<double> free = rooms_before(edges, kinds, others, std::max(over.eaves, over.verge));
    const std::vector<double> for_gutters =
        has_gutters ? rooms_before(edges, kinds, others, over.eaves + over.before_eaves) : free;
    std::vector<roofs::OverhangRoom> rooms(edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      double top = 1e300;
      for (const Point3& p : roof.wall_tops[i]) top = std::min(top, p.z);
      rooms[i] = {kinds[i], level[i] || has_gable[i] || has_cornice(body, edges[i], top) ? 0 : free[i], for_gutters[i]};
    }
    roofs::BuiltOverhangs beyond = roofs::overhangs(plan, roof, rooms, over);
    take(std::move(beyond.elements), RoofElementKind::eaves);
    if (has_gutters) {
      roofs::MayComeDown may;
      if (asked.downpipes)
        may = [&](Point2 foot, Point2 along, double half) { return may_come_down(body, foot, along, half); };
      take(roofs::gutters(beyond, standing.bottom, may, gutter), RoofElementKind::gutter);
    }
    if (asked.caps && has_caps(looks)) {
      roofs::CapOptions caps;
      caps.profile =
          roofs::CapProfile::triangular;  // a third of the faces of a half-round one, and the same from the street
      take(roofs::ridge_and_hip_caps(roof, beyond.corners, taken, caps), RoofElementKind::ridge_cap);
    }

    for (model::RoofInstallation& made : bodies) {
      auto triangles = geometry::triangulate(made.solid);
      if (!triangles) {
        ++left_out_[made.kind];
        continue;
      }
      made.triangles = std::move(*triangles);
      if (building.parts.size() > 1 && meets_a_body(building, made, &body)) {
        ++left_out_[made.kind];
        continue;
      }
      paint(made, looks);
      body.lod3.roof_installations.push_back(std::move(made));
    }
  }

  static model::Polygon plan_of(const std::vector<Point2>& ring) {
    model::Polygon out;
    out.outer.points = ring;
    return out;
  }

  /// Ornamental gables before all that looks on a street. Chimneys that stand where one comes give way.
  static bool rises(const std::vector<Point3>& top) {
    double low = 1e300, high = -1e300;
    for (const Point3& p : top) low = std::min(low, p.z), high = std::max(high, p.z);
    return high - low > kLeastGable;
  }

  /// What is asked for; of stepped and curved gables then the same with other numbers of steps and curves: a broken roof takes
  /// few of them.
  static std::vector<roofs::GableOptions> forms_like(const roofs::GableOptions& asked) {
    std::vector<roofs::GableOptions> out{asked};
    if (asked.form == roofs::GableForm::attic) return out;
    for (const roofs::GableForm form :
         {asked.form, asked.form == roofs::GableForm::stepped ? roofs::GableForm::curved : roofs::GableForm::stepped})
      for (const int count : form == roofs::GableForm::stepped ? std::vector{5, 4, 3} : std::vector{2, 1}) {
        roofs::GableOptions other = asked;
        other.form = form;
        (form == roofs::GableForm::stepped ? other.steps : other.curves) = count;
        out.push_back(other);
      }
    return out;
  }

  void put_gables(BuildingPart& body, const masses::BuiltMass& standing, const std::vector<model::RoofEdge>& kinds,
                  std::vector<bool>& has_gable, std::vector<std::vector<Point2>>& taken,
                  std::vector<model::RoofInstallation>& bodies) {
    std::vector<std::vector<Point2>> gables;
    for (std::uint32_t i = 0; i < kinds.size(); ++i) {
      if (kinds[i] != model::RoofEdge::street) continue;
      if (!roofs::may_stand_before(standing.gable->form, body.built_roof)) continue;
      // Where nothing rises behind, no gable looks on the street.
      if (standing.gable->form != roofs::GableForm::attic && !rises(standing.roof.wall_tops[i])) continue;
      roofs::BuiltGable made;
      const std::vector<roofs::GableOptions> forms = forms_like(*standing.gable);
      std::size_t tried = 0;
      do {
        made = roofs::ornamental_gable(standing.plan, standing.roof, i, forms[tried]);
      } while (!made.body && made.refusal == roofs::GableRefusal::form && ++tried < forms.size());
      if (!made.body) {
        ++left_out_[RoofElementKind::gable];
        continue;
      }
      // At a corner of two streets one gable has the corner.
      const geometry::PlanShape here({plan_of(made.place)});
      const auto common = [&](const std::vector<Point2>& other) {
        return here.common_area(geometry::PlanShape({plan_of(other)})) > kLeastCommon;
      };
      if (std::ranges::any_of(gables, [&](const std::vector<Point2>& other) { return common(other); })) continue;
      gables.push_back(made.place);
      has_gable[i] = true;
      if (tried > 0) ++other_gables_;
      if (std::ranges::any_of(taken, common)) {
        auto& standing_there = body.lod3.roof_installations;
        const auto gone = std::remove_if(standing_there.begin(), standing_there.end(), [&](const auto& stack) {
          if (stack.kind != RoofElementKind::chimney) return false;
          std::vector<Point2> ring = top_of(stack);
          return ring.size() >= 3 && common(ring);
        });
        if (gone != standing_there.end())
          left_out_[RoofElementKind::chimney] += static_cast<int>(standing_there.end() - gone);
        standing_there.erase(gone, standing_there.end());
        taken = stacks_on(body);
        taken.insert(taken.end(), gables.begin(), gables.end() - 1);
      }
      bodies.push_back(std::move(*made.body));
      taken.push_back(std::move(made.place));
    }
  }

  bool has_parapet(const model::Attributes& a) const {
    const bool people = defaults_.groups[defaults_.use(a.use.value).group] == "residential";
    return !people || !is_old(a);
  }

  /// Thatch drips.
  bool has_gutter(const Looks& looks) const {
    return defaults_.materials[looks.roof.material].material_class.name != "thatch";
  }

  /// Tiles and slates are capped; sheets, felt and thatch are not.
  bool has_caps(const Looks& looks) const {
    const std::string& material = defaults_.materials[looks.roof.material].material_class.name;
    return material == "roof_tiles" || material == "slate";
  }

  const std::vector<model::ColouredElement>& elements_;
  const masses::BuiltMasses& masses_;
  const attributes::Defaults& defaults_;
  const OutlinesNear& outlines_near_;
  model::Face board_, sheet_;
  std::map<RoofElementKind, int> left_out_;  ///< of the body at work
  int other_gables_ = 0;                     ///< that stand with other steps or curves than rules ordered
};

}  // namespace

void add_roof_edges(model::Region& region, const masses::BuiltMasses& masses, const attributes::Defaults& defaults,
                    const OutlinesNear& outlines_near) {
  for_each_owned_building(
      region, [&] { return RoofDresser(region.elements, masses, defaults, outlines_near); },
      [](RoofDresser& dresser, model::Building& building, std::uint32_t index, model::Report& report) {
        dresser.dress(building, index, report);
      });
}

}  // namespace blockrand::facades
