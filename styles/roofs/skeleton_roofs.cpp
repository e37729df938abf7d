#include "styles/roofs/skeleton_roofs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/roof_surfaces.h"
#include "pipeline/geometry/straight_skeleton.h"
#include "pipeline/geometry/weighted_skeleton.h"
#include "styles/roofs/eaves_lines.h"
#include "styles/roofs/roof_sides.h"
#include "styles/roofs/shape_tables.h"

namespace blockrand::roofs {

namespace {

using geometry::EdgeProfile;
using geometry::kUpright;
using geometry::WeightedSkeleton;
using model::EavesProfile;
using model::EdgeRoof;
using model::IssueCode;
using model::PitchedSide;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofShape;
using model::WingEnds;

// Shares of the roof's height and run; docs/roofs.md has them.
constexpr double kGableShare = 0.6;  ///< of H: where a half-hip begins, a gablet as well
constexpr int kVaultSteps = 5;       ///< pitches of a round roof
/// Of the other slopes' rise: a wing of half depth under a roof of 35 degrees leans at 12
/// (docs/style_measures.md 2.7: 5 to 20).
constexpr double kLeanSlope = 0.3;

EdgeProfile upright() { return {kUpright, {}}; }
EdgeProfile pitch(double slope) { return {slope, {}}; }

/// A quarter of an ellipse over `run`, rising to `height`, in chords of equal angle.
EdgeProfile vault(double run, double height) {
  constexpr double kQuarter = 1.57079632679489661923;
  EdgeProfile out;
  double x = 0, z = 0;
  for (int i = 1; i <= kVaultSteps; ++i) {
    const double angle = kQuarter * i / kVaultSteps;
    const double to_x = run * (1 - base::cos(angle)), to_z = height * base::sin(angle);
    const double slope = (to_z - z) / (to_x - x);
    if (i == 1)
      out.slope = slope;
    else
      out.changes.push_back({z, slope});
    x = to_x;
    z = to_z;
  }
  return out;
}
Roof to_roof(const Polygon& plan, const WeightedSkeleton& skeleton, RoofMeasures measures, double coarseness) {
  const double top = skeleton.height();
  const auto surfaces = geometry::roof_surfaces(plan, skeleton, top > 0 ? measures.height / top : 0, coarseness);
  const auto raised = [&](Point3 p) { return Point3{p.x, p.y, measures.eaves + p.z}; };
  Roof roof;
  for (const auto& s : surfaces.surfaces) {
    Roof::Surface out;
    const bool on_edge =
        s.edge != geometry::WeightedSkeletonFace::kDeck && s.edge != geometry::WeightedSkeletonFace::kCorner;
    out.edge = on_edge ? static_cast<std::int32_t>(s.edge) : -1;
    out.upright = s.upright;
    for (const auto& loop : s.loops) {
      out.loops.emplace_back();
      for (const Point3 p : loop) out.loops.back().push_back(raised(p));
    }
    roof.surfaces.push_back(std::move(out));
  }
  for (const auto& top_points : surfaces.wall_tops) {
    roof.wall_tops.emplace_back();
    for (auto p = top_points.rbegin(); p != top_points.rend(); ++p) roof.wall_tops.back().push_back(raised(*p));
  }
  return roof;
}

/// CGAL's skeleton in our form.
std::optional<WeightedSkeleton> by_cgal(const Polygon& plan) {
  const auto skeleton = geometry::straight_skeleton(plan);
  if (!skeleton) return std::nullopt;
  WeightedSkeleton out;
  for (const auto& n : skeleton->nodes) out.nodes.push_back({n.point, n.time});
  for (const auto& f : skeleton->faces) {
    geometry::WeightedSkeletonFace face;
    face.edge = f.edge;
    face.loops.push_back(f.nodes);
    out.faces.push_back(std::move(face));
  }
  out.merged.resize(skeleton->faces.size());
  std::iota(out.merged.begin(), out.merged.end(), 0u);
  return out;
}

using Skeleton = tl::expected<WeightedSkeleton, geometry::SkeletonFailure>;

/// Ends are treated apart where eaves have one pitch: Builder::one_pitch() knows no other profile.
constexpr bool ends_fit_eaves() {
  for (std::size_t i = 0; i < model::kRoofShapeCount; ++i) {
    const auto* roof = model::constructed_as<EdgeRoof>(static_cast<RoofShape>(i));
    if (roof && roof->eaves != EavesProfile::one_pitch && roof->ends != WingEnds::hips &&
        roof->ends != WingEnds::gables)
      return false;
  }
  return true;
}
static_assert(ends_fit_eaves());

/// Everything about one plan that shapes ask for.
class Builder {
 public:
  Builder(const Polygon& plan, const RoofRequest& request, const EdgeRoof& form)
      : plan_(plan),
        request_(request),
        form_(form),
        plan_sides_(plan_sides(plan)),
        sides_(roof_sides(plan, request, ends_apart())) {}

  bool leans() const { return sides_.leans; }

  /// The farthest that a point of the plan lies from the eaves that rise to it, m; where some slopes are gentler, as
  /// much less. 0 when there is no skeleton.
  double largest_run() const {
    const auto s = skeleton(form_.eaves == EavesProfile::berlin ? berlin() : all_sides(pitch(1)));
    return s ? s->height() : 0;
  }

  std::optional<BuiltRoof> build() const {
    // Profiles rise to the largest run, at 45 degrees on the whole; the skeleton's plan depends on the ratios of slopes alone, and
    // heights are scaled to what is asked at the end.
    switch (form_.eaves) {
      case EavesProfile::one_pitch:
        return one_pitch();
      case EavesProfile::broken: {
        const double run = largest_run();
        return run > 0 ? finish(all_sides(broken(run))) : fallback();
      }
      case EavesProfile::vaulted: {
        const double run = largest_run();
        return run > 0 ? finish(all_sides(vault(run, run))) : fallback();
      }
      case EavesProfile::decked: {
        const double run = largest_run();
        return run > 0 ? finish(all_sides(pitch(1 / kDeckRun)), run) : fallback();
      }
      case EavesProfile::berlin:
        return finish(berlin());
    }
    return std::nullopt;
  }

 private:
  /// Do the ends of wings rise in another way than eaves?
  bool ends_apart() const { return form_.ends != WingEnds::hips; }

  /// The order of an edge's side, and how much steeper it is than sides without one: 1 where nothing is ordered.
  struct Steeper {
    std::optional<PitchedSide> side;
    double times = 1;
  };
  Steeper steeper(std::size_t edge) const {
    const model::SidePitches& ordered = request_.side_pitches;
    if (!ordered.any() || request_.other_sides_pitch <= 0 || form_.eaves != EavesProfile::one_pitch || sides_.leans)
      return {};
    const Point2 out = plan_sides_[edge].outwards();
    const PitchedSide quarter = std::fabs(out.y) >= std::fabs(out.x)
                                    ? (out.y > 0 ? PitchedSide::north : PitchedSide::south)
                                    : (out.x > 0 ? PitchedSide::east : PitchedSide::west);
    const bool street = edge < request_.edges.size() && request_.edges[edge] == model::RoofEdge::street;
    for (const PitchedSide side : {quarter, street ? PitchedSide::street : PitchedSide::yard})
      if (const int degrees = ordered.degrees[static_cast<std::size_t>(side)]; degrees > 0)
        return {side, tangent(degrees) / tangent(request_.other_sides_pitch)};
    return {};
  }
  static double tangent(double degrees) { return base::tan(degrees * base::kRadiansPerDegree); }

  /// The orders that a side of this roof has.
  model::SidePitches pitches_met() const {
    model::SidePitches met;
    for (std::size_t e = 0; e < sides_.sides.size(); ++e) {
      if (sides_.sides[e] != RoofSide::eaves) continue;
      if (const Steeper s = steeper(e); s.side) {
        const auto i = static_cast<std::size_t>(*s.side);
        met.degrees[i] = request_.side_pitches.degrees[i];
      }
    }
    return met;
  }

  /// What rises from every edge: eaves, gentler eaves of lean-to slopes, walls; and from the yard's corner.
  struct Profiles {
    std::vector<EdgeProfile> edges;
    std::vector<geometry::CornerEaves> corners;
  };
  Profiles all_sides(const EdgeProfile& eaves) const {
    Profiles out;
    for (const RoofSide side : sides_.sides)
      out.edges.push_back(side == RoofSide::eaves                   ? eaves
                          : side == RoofSide::lean && !sides_.leans ? pitch(kLeanSlope)
                          : side == RoofSide::lean                  ? eaves
                                                                    : upright());
    for (std::size_t e = 0; e < out.edges.size(); ++e)
      if (sides_.sides[e] == RoofSide::eaves) out.edges[e].slope *= steeper(e).times;
    if (sides_.corner) out.corners.push_back({*sides_.corner, eaves});
    return out;
  }
  Skeleton skeleton(const Profiles& profiles, std::optional<double> deck = {}) const {
    return geometry::weighted_skeleton(plan_, profiles.edges, deck, profiles.corners);
  }

  /// Steep from the eaves to the break, then gentle. Where an attic storey is asked for, the break lies at its ceiling and
  /// the roof has mansard's pitches; shares of the table else.
  EdgeProfile broken(double run) const {
    double height = kMansardHeight, width = kMansardRun;
    if (request_.attic > 0 && request_.measures.height > 0) {
      // Heights are scaled by run / H: what is `attic` in the roof is a share of H here.
      height = std::clamp(request_.attic / request_.measures.height, kLeastBreak, kMostBreak);
      width = std::clamp(request_.attic / (kMansardSteep * run), kLeastBreakRun, kMostBreakRun);
    }
    return {height / width, {{height * run, (1 - height) / (1 - width)}}};
  }

  /// The Berlin roof at its usual pitches: steep from the street's eaves up to a deck that falls gently to the yard, whose
  /// eaves lie higher by a knee wall.
  Profiles berlin() const {
    Profiles profiles = all_sides(pitch(kBerlinGentle));
    const auto is_front = [&](std::size_t e) {
      return sides_.sides[e] == RoofSide::eaves && e < request_.edges.size() &&
             request_.edges[e] == model::RoofEdge::street;
    };
    bool fronts = false;
    for (std::size_t e = 0; e < profiles.edges.size(); ++e) {
      if (!is_front(e)) continue;
      profiles.edges[e] = pitch(kBerlinSteep);
      fronts = true;
    }
    const auto plain = fronts ? skeleton(profiles) : Skeleton{tl::unexpected(geometry::SkeletonFailure::unbounded)};
    if (!plain) return profiles;
    const double knee = std::max(kKneeWall * plain->height(), kLeastKneeWall);
    for (std::size_t e = 0; e < profiles.edges.size(); ++e)
      if (sides_.sides[e] == RoofSide::eaves && !is_front(e)) profiles.edges[e] = {kUpright, {{knee, kBerlinGentle}}};
    return profiles;
  }

  std::optional<BuiltRoof> one_pitch() const {
    const double slope = 1;
    Profiles all = all_sides(pitch(slope));
    if (form_.ends == WingEnds::hips || form_.ends == WingEnds::gables) return finish(all);
    const double run = largest_run();
    if (run <= 0) return fallback();
    const double change = kGableShare * run;
    const std::vector<std::uint32_t> ends = sides_.which(RoofSide::gable);
    const EdgeProfile half_hip{kUpright, {{change, slope}}};
    switch (form_.ends) {
      case WingEnds::hips:
      case WingEnds::gables:
        break;
      case WingEnds::half_hips:
        for (const std::uint32_t e : ends) all.edges[e] = half_hip;
        break;
      case WingEnds::gablets:
        for (const std::uint32_t e : ends) all.edges[e] = {slope, {{change, kUpright}}};
        break;
      case WingEnds::one_hip:
        if (const auto one = single_end(ends)) all.edges[*one] = pitch(slope);
        break;
      case WingEnds::one_half_hip:
        if (const auto one = single_end(ends)) all.edges[*one] = half_hip;
        break;
    }
    return finish(all);
  }

  /// The end that looks down most where a direction is tagged, the longest otherwise.
  std::optional<std::uint32_t> single_end(const std::vector<std::uint32_t>& ends) const {
    const std::vector<PlanSide> edges = plan_sides(plan_);
    std::optional<std::uint32_t> best;
    double most = 0;
    for (const std::uint32_t e : ends) {
      const Point2 out = edges[e].outwards();
      const double value = request_.down ? 2 + out.x * request_.down->x + out.y * request_.down->y : edges[e].length;
      constexpr double kAlike = 0.01;  // m, or cosine: rounding decides nothing
      if (!best || value > most + kAlike) {
        best = e;
        most = value;
      }
    }
    return best;
  }

  std::optional<BuiltRoof> finish(const Profiles& profiles, std::optional<double> deck = {}) const {
    const Skeleton s = skeleton(profiles, deck);
    if (!s) return fallback();
    BuiltRoof out{to_roof(plan_, *s, request_.measures, request_.coarseness), request_.shape, IssueCode::none, {}};
    out.pitches_met = pitches_met();
    if (sides_.leans) out.shape = RoofShape::skillion;
    if (ends_apart() && !sides_.has(RoofSide::gable) && !sides_.has(RoofSide::party) && plan_.holes.empty()) {
      out.note = IssueCode::roof_shape_adapted;
      out.detail = std::string(model::name(request_.shape)) + " without gables: no wing has an end";
    }
    return out;
  }

  /// Hips by CGAL. Not where party walls are upright: callers try without them.
  std::optional<BuiltRoof> fallback() const {
    if (sides_.has(RoofSide::party)) return std::nullopt;
    const auto hips = by_cgal(plan_);
    if (!hips) return std::nullopt;
    return BuiltRoof{to_roof(plan_, *hips, request_.measures, request_.coarseness), RoofShape::hipped,
                     IssueCode::skeleton_fallback, std::string(model::name(request_.shape)) + " as hipped"};
  }

  const Polygon& plan_;
  const RoofRequest& request_;
  const EdgeRoof form_;
  const std::vector<PlanSide> plan_sides_;
  const RoofSides sides_;
};

/// The request for the plan's eaves lines.
RoofRequest on_facades(RoofRequest request, const EavesPlan& eaves) {
  request.edges = eaves.edges;
  request.along_eaves_lines = false;
  return request;
}

}  // namespace

std::optional<BuiltRoof> skeleton_roof(const Polygon& plan, const RoofRequest& request) {
  const auto* form = model::constructed_as<EdgeRoof>(request.shape);
  if (!form) return std::nullopt;
  if (request.along_eaves_lines) {
    if (const auto eaves = eaves_plan(plan, request.edges)) {
      const RoofRequest whole = on_facades(request, *eaves);
      auto built = Builder(eaves->plan, whole, *form).build();
      if (!built || built->note == IssueCode::skeleton_fallback) return std::nullopt;
      auto roof = onto_plan(built->roof, *eaves, plan);
      if (!roof) return std::nullopt;
      built->roof = std::move(*roof);
      return built;
    }
  }
  return Builder(plan, request, *form).build();
}

namespace {

bool goes_onto(const Builder& builder, const EavesPlan& eaves, const Polygon& plan) {
  const auto built = builder.build();
  return built && built->note != IssueCode::skeleton_fallback && onto_plan(built->roof, eaves, plan);
}

}  // namespace

SkeletonRun skeleton_run(const Polygon& plan, const RoofRequest& request) {
  const auto* form = model::constructed_as<EdgeRoof>(request.shape);
  if (!form) return {};
  if (request.along_eaves_lines) {
    if (const auto eaves = eaves_plan(plan, request.edges)) {
      RoofRequest whole = on_facades(request, *eaves);
      whole.measures = {0, geometry::equivalent_width(plan) / 2};  // of the usual steepness
      const Builder builder(eaves->plan, whole, *form);
      // The roof that will be built, and not one that turns out not to fit the plan.
      if (const double run = builder.largest_run(); run > 0 && goes_onto(builder, *eaves, plan))
        return {run, builder.leans()};
    }
  }
  const Builder builder(plan, request, *form);
  return {builder.largest_run(), builder.leans()};
}

std::optional<BuiltRoof> vaulted_roof(const Polygon& plan, const RoofRequest& request) {
  return Builder(plan, request, {EavesProfile::vaulted, WingEnds::hips}).build();
}

}  // namespace blockrand::roofs
