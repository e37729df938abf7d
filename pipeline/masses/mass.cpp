#include "pipeline/masses/mass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/attributes/resolve.h"
#include "pipeline/attributes/roof_edges.h"
#include "pipeline/base/parallel.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/masses/envelope.h"
#include "pipeline/masses/stacked_parts.h"
#include "pipeline/masses/walls_inside.h"
#include "styles/roofs/eaves_lines.h"
#include "styles/roofs/roof.h"
#include "styles/roofs/skeleton_roofs.h"

namespace blockrand::masses {

namespace {

using model::BuildingPart;
using model::Face;
using model::IssueCode;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::Region;
using model::Ring;
using model::RoofOrientation;
using model::RoofShape;
using model::Solid;
using model::SolidTriangles;
using model::SurfaceKind;

struct Checked {
  Solid solid;
  SolidTriangles triangles;
};

std::optional<Checked> checked(Solid solid) {
  auto triangles = geometry::triangulate(solid);
  if (!triangles) return std::nullopt;
  if (!geometry::check_solid(solid, *triangles, geometry::kBuilt).valid()) return std::nullopt;
  return Checked{std::move(solid), std::move(*triangles)};
}

/// What is asked of the roof; not yet its measures and the plan's edges.
roofs::RoofRequest request_of(const BuildingPart& part, RoofShape shape) {
  const model::Attributes& attributes = part.attributes;
  roofs::RoofRequest request;
  request.side_pitches = part.side_pitches;
  request.other_sides_pitch = part.other_sides_pitch;
  request.shape = shape;
  if (attributes.roof_direction) request.down = roofs::compass_vector(attributes.roof_direction->value);
  request.across = attributes.roof_orientation.value == RoofOrientation::across;
  request.shape_is_mapped = attributes.roof_shape.source == model::Source::tag;
  // A style's gable to the street holds against the row as a tag does.
  request.axis_is_mapped = attributes.roof_direction || attributes.roof_orientation.source == model::Source::tag ||
                           attributes.roof_orientation.source == model::Source::preset;
  // An attic storey where nobody measured the roof.
  const bool usual = attributes.roof_height.source == model::Source::preset ||
                     attributes.roof_height.source == model::Source::default_;
  if (usual) request.attic = attributes::attic_height(attributes.storey_height.value);
  return request;
}

class MassBuilder {
 public:
  MassBuilder(Region& region, model::Report& report, const attributes::Defaults& defaults,
              const attributes::GenerateOptions& options)
      : region_(region), report_(report), defaults_(defaults), options_(options) {}

  void build(std::uint32_t building, int lod) {
    building_ = &region_.buildings[building];
    std::vector<Levels> levels;
    std::vector<Polygon> plans;
    for (BuildingPart& part : building_->parts) {
      const bool planned = part.plan.outer.size() >= 3;
      if (planned && part.roof_plan.outer.size() < 3)
        attributes::prepare_roof_plans(*building_, options_.collinear_tolerance);
      levels.push_back(planned ? levels_of(part) : Levels{});
      plans.push_back(planned ? part.roof_plan : Polygon{});
    }
    if (levels.size() > 1)
      for (const GivenWay& g : settle_stacks(plans, levels)) {
        const BuildingPart &part = building_->parts[g.part], &other = building_->parts[g.other];
        report_.add(part.osm, IssueCode::parts_overlap,
                    fmt::format("{}: {:.2f} m of its height given to {}", part.id, g.metres, other.id));
      }
    for (std::uint32_t p = 0; p < levels.size(); ++p) {
      body_ = {building, p};
      if (!plans[p].outer.points.empty()) build(building_->parts[p], levels[p], lod);
    }
  }

  /// What was built; the builder has nothing left.
  std::vector<BuiltMasses::Entry> take() { return std::move(built_); }

 private:
  void build(BuildingPart& part, const Levels& levels, int lod) {
    part.lod = 0;
    const EnvelopeMaterials materials = materials_of(part);
    if (lod >= 1) build_lod1(part, part.roof_plan, levels, materials);
    if (lod >= 2) build_lod2(part, part.roof_plan, levels, materials);
    if (part.lod < lod) note(part, part.lod == 1 ? IssueCode::lod1_only : IssueCode::no_solid);
  }

  void note(BuildingPart& part, IssueCode code, std::string detail = {}) {
    part.fallbacks.push_back(code);
    report_.add(part.osm, code, detail.empty() ? part.id : part.id + ": " + detail);
  }

  EnvelopeMaterials materials_of(const BuildingPart& part) const {
    const auto face = [&](SurfaceKind kind, const std::string& material, model::Colour colour) {
      Face f;
      f.kind = kind;
      f.material = static_cast<std::uint8_t>(std::max(defaults_.material(material), 0));
      f.colour = colour;
      return f;
    };
    const auto& a = part.attributes;
    const bool on_ground = a.min_height.value <= 0 && !part.canopy;
    EnvelopeMaterials materials;
    materials.wall = face(SurfaceKind::wall, a.wall_material.value, a.shown_wall_colour);
    materials.roof = face(SurfaceKind::roof, a.roof_material.value, a.shown_roof_colour);
    materials.under =
        face(on_ground ? SurfaceKind::ground : SurfaceKind::outer_ceiling, a.wall_material.value, a.shown_wall_colour);
    return materials;
  }

  Levels levels_of(BuildingPart& part) {
    auto& a = part.attributes;
    const double ground = a.ground_height.value;
    double top = a.height.value, bottom = std::max(a.min_height.value, 0.0);
    // A slab thinner than a wall's minimum is thickened below; only one without any thickness contradicts itself.
    constexpr double kNoThickness = 0.01;  // m
    if (bottom > 0 && bottom > top - kNoThickness) {
      if (!part.mapped.height || !part.mapped.min_height)  // else resolve_attributes has reported them
        note(part, IssueCode::values_conflict, fmt::format("underside at {:.2f} m, top at {:.2f} m", bottom, top));
      bottom = std::max(0.0, top - std::max(options_.min_wall_height, a.storey_height.value));
    }
    if (top < bottom + options_.min_wall_height) top = bottom + options_.min_wall_height;
    double roof = a.roof_shape.value == RoofShape::flat ? 0 : a.roof_height.value;
    if (part.canopy) {
      // A slab without walls: all that is below the roof's own thickness is air.
      const double thickness = std::min(options_.canopy_thickness, (top - bottom) / 2);
      if (a.min_height.source != model::Source::tag) bottom = std::max(bottom, top - roof - thickness);
    }
    const double room =
        top - bottom -
        (part.canopy ? std::min(options_.canopy_thickness, (top - bottom) / 2) : options_.min_wall_height);
    if (roof > room) {
      // A roof that fills its part, as those of domes do, stands on a low wall without a word.
      if (a.roof_height.source == model::Source::tag && roof - room > options_.min_wall_height + kNoThickness)
        note(part, IssueCode::roof_height_clamped, fmt::format("{:.2f} m of {:.2f} m", std::max(room, 0.0), roof));
      roof = std::max(room, 0.0);
    }
    if (roof < options_.min_roof_height) {
      if (a.roof_shape.value != RoofShape::flat && !is_unknown(a.roof_shape.value) &&
          a.roof_shape.source == model::Source::tag)
        note(part, IssueCode::roof_height_clamped,
             fmt::format("{} of {:.2f} m is too low for a slope: flat", model::name(a.roof_shape.value),
                         std::max(roof, 0.0)));
      roof = 0;
    }
    return {model::snap(ground + bottom), model::snap(ground + top - roof), model::snap(ground + top)};
  }

  void build_lod1(BuildingPart& part, const Polygon& plan, const Levels& levels, const EnvelopeMaterials& materials) {
    const double top = model::snap((levels.eaves + levels.top) / 2);
    for (const Polygon* p : std::initializer_list<const Polygon*>{&plan, &part.plan}) {
      if (auto block = checked(envelope(*p, levels.bottom, roofs::flat_roof(*p, top), materials))) {
        part.lod1 = std::move(block->solid);
        part.lod1_triangles = std::move(block->triangles);
        part.lod = 1;
        return;
      }
    }
  }

  bool accept(BuildingPart& part, const Polygon& plan, const Levels& levels, const EnvelopeMaterials& materials,
              const roofs::Roof& roof, RoofShape built) {
    Solid solid = envelope(plan, levels.bottom, roof, materials);
    std::optional<Checked> result;
    // Parts that share a wall share no room, however the corners of a gable between them are rounded.
    if (building_->parts.size() > 1)
      if (Solid inside = solid; keep_walls_inside(inside)) result = checked(std::move(inside));
    if (!result) result = checked(std::move(solid));
    if (!result) return false;
    part.lod2 = std::move(result->solid);
    part.lod2_triangles = std::move(result->triangles);
    part.built_roof = built;
    part.lod = 2;
    built_.push_back({body_, built_mass(plan, levels.bottom, roof)});
    return true;
  }

  /// One shape on one plan; tidied more coarsely where its solid fails the check.
  bool build_roof(BuildingPart& part, const Polygon& plan, const Levels& levels, const EnvelopeMaterials& materials,
                  roofs::RoofRequest request) {
    request.measures = {levels.eaves, levels.top - levels.eaves};
    request.along_eaves_lines = true;
    if (build_tidied(part, plan, levels, materials, request)) return true;
    if (!model::rises_from_edges(request.shape) || !roofs::eaves_plan(plan, request.edges)) return false;
    // Where the roof of whole facades does not fit, or does not come out valid, every bay gets slopes of its own.
    const double along = roofs::main_slope(plan, request, true).run;
    request.along_eaves_lines = false;
    if (part.usual_pitch > 0 && along > 0)
      keep_pitch(part, request, roofs::main_slope(plan, request, true).run / along);
    if (!build_tidied(part, plan, levels, materials, request)) return false;
    note(part, IssueCode::roof_with_bays);
    return true;
  }
  /// A roof that no tag measures keeps its pitch over another run: neighbours count on it.
  void keep_pitch(BuildingPart& part, roofs::RoofRequest& request, double ratio) {
    const double change = model::snap(request.measures.height * ratio) - request.measures.height;
    request.measures.height += change;
    for (model::Attributes* a : {&part.attributes, building_->parts.size() == 1 ? &building_->attributes : nullptr}) {
      if (!a) continue;
      a->roof_height.value += change;
      a->height.value += change;
    }
  }
  static double lowest_eaves(const roofs::Roof& roof) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& top : roof.wall_tops)
      for (const Point3 p : top) lowest = std::min(lowest, p.z);
    return lowest;
  }
  /// m. Roofs that come down over bays keep this distance from the underside, unless the eaves have less.
  double least_wall(const BuildingPart& part, const Levels& levels) const {
    return std::min(part.canopy ? 0.0 : options_.min_wall_height, levels.eaves - levels.bottom) - 0.001;
  }
  bool build_tidied(BuildingPart& part, const Polygon& plan, const Levels& levels, const EnvelopeMaterials& materials,
                    roofs::RoofRequest request) {
    for (const double coarseness : roofs::kCoarseness) {
      request.coarseness = coarseness;
      const auto built = roofs::build_roof(plan, request);
      if (!built || lowest_eaves(built->roof) < levels.bottom + least_wall(part, levels)) continue;
      if (!accept(part, plan, levels, materials, built->roof, built->shape)) continue;
      if (built->note != IssueCode::none) note(part, built->note, built->detail);
      pitches_met_ = built->pitches_met;
      return true;
    }
    return false;
  }

  /// The roof, and which of the pitches that were ordered for its sides it has not.
  void build_lod2(BuildingPart& part, const Polygon& plan, const Levels& levels, const EnvelopeMaterials& materials) {
    pitches_met_ = {};
    build_roof_or_relative(part, plan, levels, materials);
    model::SidePitches missed = part.side_pitches;
    for (std::size_t i = 0; i < model::kPitchedSideCount; ++i)
      if (pitches_met_.degrees[i] != 0) missed.degrees[i] = 0;
    constexpr double kOtherPitch = 1;  // degrees; by the rounding of heights
    const double built = part.attributes.roof_pitch.value;
    if (!missed.any() && part.mapped.side_pitches.any() && std::fabs(built - part.other_sides_pitch) > kOtherPitch)
      note(part, IssueCode::side_pitch_unread,
           fmt::format("{}: the height makes {:.0f} degrees of {:.0f}, and all other sides by that factor",
                       model::text(part.side_pitches), built, part.other_sides_pitch));
    if (missed.any())
      note(part, IssueCode::side_pitch_unread,
           fmt::format("{}, roof built {}", model::text(missed), model::name(part.built_roof)));
  }

  /// What is left of the edges' kinds where party walls are not heeded: streets and yards, if pitches are ordered for them.
  static std::vector<model::RoofEdge> without_row(const BuildingPart& part, std::vector<model::RoofEdge> edges) {
    if (!part.side_pitches.any()) return {};
    std::replace(edges.begin(), edges.end(), model::RoofEdge::party_wall, model::RoofEdge::open);
    return edges;
  }

  void build_roof_or_relative(BuildingPart& part, const Polygon& plan, const Levels& levels,
                              const EnvelopeMaterials& materials) {
    const RoofShape asked = part.attributes.roof_shape.value;
    if (is_unknown(asked)) note(part, IssueCode::roof_shape_unknown, asked == RoofShape::many ? "many" : "");
    const roofs::RoofMeasures measures{levels.eaves, levels.top - levels.eaves};
    if (asked != RoofShape::flat && measures.height > 0 && !part.roof_lines.empty()) {
      const auto lined = roofs::lined_roof(plan, measures, part.roof_lines);
      if (lined && accept(part, plan, levels, materials, *lined, RoofShape::lined)) return;
      note(part, IssueCode::roof_lines_ignored,
           lined ? "their solid is not valid" : "they do not fit each other or the plan");
    }
    if (asked != RoofShape::flat && !is_unknown(asked) && measures.height > 0) {
      const std::optional<Polygon> simplified = attributes::simpler_plan(plan, options_.simplify_tolerance);
      roofs::RoofRequest request = request_of(part, asked);
      const auto in_row = [&](const Polygon& p) {
        return &p == &part.roof_plan ? part.roof_edges : attributes::roof_edges(*building_, p);
      };
      const bool row = std::find(part.roof_edges.begin(), part.roof_edges.end(), model::RoofEdge::party_wall) !=
                       part.roof_edges.end();
      for (const bool heeds_row : {true, false}) {
        if (!heeds_row && !row) continue;
        for (const Polygon* p : std::initializer_list<const Polygon*>{&plan, simplified ? &*simplified : nullptr}) {
          if (!p) continue;
          request.edges = heeds_row ? in_row(*p) : without_row(part, in_row(*p));
          if (!build_roof(part, *p, levels, materials, request)) continue;
          if (p != &plan) note(part, IssueCode::roof_simplified);
          if (!heeds_row) note(part, IssueCode::roof_row_ignored);
          return;
        }
      }
      request.shape = RoofShape::hipped;
      request.edges = without_row(part, in_row(plan));
      if (asked != RoofShape::hipped && build_roof(part, plan, levels, materials, request)) {
        note(part, IssueCode::roof_shape_adapted,
             std::string(model::name(asked)) + " as hipped: its solid is not valid");
        return;
      }
      note(part, IssueCode::roof_failed, std::string(model::name(asked)));
    }
    // A flat roof in place of a pitched one ends at half its height, so that the volume stays.
    const double top =
        asked == RoofShape::flat || is_unknown(asked) ? levels.top : model::snap((levels.eaves + levels.top) / 2);
    if (accept(part, plan, levels, materials, roofs::flat_roof(plan, top), RoofShape::flat)) return;
    for (const double tolerance : {options_.simplify_tolerance, 2 * options_.simplify_tolerance}) {
      const std::optional<Polygon> simplified = attributes::simpler_plan(part.plan, tolerance);
      if (simplified &&
          accept(part, *simplified, levels, materials, roofs::flat_roof(*simplified, top), RoofShape::flat)) {
        note(part, IssueCode::plan_simplified);
        return;
      }
    }
  }

  Region& region_;
  model::Report& report_;
  const attributes::Defaults& defaults_;
  const attributes::GenerateOptions& options_;
  model::Building* building_ = nullptr;
  BodyIndex body_;                  ///< the part at work
  model::SidePitches pitches_met_;  ///< by the roof that stands on it
  std::vector<BuiltMasses::Entry> built_;
};

}  // namespace

BuiltMasses build_masses(Region& region, const attributes::Defaults& defaults,
                         const attributes::GenerateOptions& options, int lod) {
  struct Stretch {
    model::Report report;
    std::vector<BuiltMasses::Entry> built;
  };
  const std::vector<std::size_t> begins = base::stretches_to_share(region.buildings.size());
  std::vector<Stretch> made(begins.size() - 1);
  base::share(made.size(), [&](std::size_t i) {
    MassBuilder builder(region, made[i].report, defaults, options);
    for (std::size_t b = begins[i]; b < begins[i + 1]; ++b)
      if (region.buildings[b].owned) builder.build(static_cast<std::uint32_t>(b), lod);
    made[i].built = builder.take();
  });
  std::vector<BuiltMasses::Entry> built;
  for (Stretch& stretch : made) {
    region.report.append(std::move(stretch.report));
    std::move(stretch.built.begin(), stretch.built.end(), std::back_inserter(built));
  }
  return BuiltMasses(std::move(built));
}

}  // namespace blockrand::masses
