// The roof's shape, orientation and height.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/attributes/resolver.h"
#include "pipeline/base/portable_math.h"
#include "styles/roofs/roof_sides.h"

namespace blockrand::attributes {
namespace {

using model::Attributes;
using model::RoofOrientation;
using model::RoofShape;
using model::Source;
using model::Sourced;

/// degrees. Wings of half depth lean on the neighbour's wall at 5 to 20 (docs/style_measures.md 2.7).
constexpr double kLeanPitch = 12;

double tangent(double degrees) { return base::tan(degrees * base::kRadiansPerDegree); }

/// Tangent of 30 degrees: a ridge that is seen runs along or across the plan when it is within that of it.
constexpr double kOblique = 0.577;
/// m of front of a gable house (docs/style_measures.md 6, `burgher_gable`: lots of 5.4 to 12 m); narrower ones are lean-tos in gaps.
constexpr double kNarrowestGable = 3.5, kWidestGable = 12;
/// Of the length of walls on streets that looks the same way: less is a house at a corner, whose roof turns.
constexpr double kOneFront = 0.9;

/// Cosine of 30 degrees: an end's wall looks along the house within that.
constexpr double kLooksAhead = 0.866;

/// Full storeys under rafters: Berlin's building codes from 1887 allowed five and 22 m to the eaves, post-war ones call what has
/// its highest floor above 22 m a tower. Of 37 houses with seven storeys and more that looked sloped 37 are tagged flat, of 29
/// with six 14 (docs/internal/RESULTS.md, "Roofs against references").
constexpr float kMostStoreysUnderRafters = 6;

/// Pitch of roofs that no tag measures, degrees. \param of_use  that of sloped roofs of the building's use
double usual_pitch(RoofShape shape, double of_use) {
  const model::UsualPitch& pitch = model::traits(shape).pitch;
  return pitch.own > 0 ? pitch.own : std::min(of_use, pitch.most);
}

}  // namespace

Sourced<RoofShape> Resolver::roof_shape() {
  std::vector<Choice<RoofShape>> choices;
  if (own.roof_shape) choices.push_back({*own.roof_shape, Source::tag, kTagConfidence, "tagged"});
  // What neighbours and evidence say; sloped roofs only where rafters reach.
  std::optional<context::NeighbourVote<RoofShape>> vote;
  if (!is_non_house()) vote = in.neighbours.roof_shape(place(), group, id, options.neighbour_minimum);
  const model::InferredCandidate<RoofShape>& inferred_candidate = building.inferred.roof_shape;
  std::string vote_why;
  Source vote_source = Source::neighbours;
  if (inferred_candidate.confidence > 0) {
    vote = context::NeighbourVote<RoofShape>{inferred_candidate.value, 0,
                                             static_cast<double>(inferred_candidate.confidence)};
    vote_why = inferred_candidate.why;
    vote_source = inferred_candidate.source;
  } else if (vote) {
    vote_why = fmt::format("{:.0f} % of {} neighbours within {:.0f} m", 100 * vote->share, vote->voices,
                           in.neighbours.reach());
  }
  const bool agreed = vote && (inferred_candidate.confidence > 0 || vote->share >= 0.5);
  if (part && !part->roof_lines.empty())
    choices.push_back({RoofShape::gabled, Source::implied, kImpliedConfidence, "ridges are mapped"});
  if ((own.roof_height && *own.roof_height < kNoRoofHeight) || (own.roof_angle && *own.roof_angle < kNoRoofAngle))
    choices.push_back({RoofShape::flat, Source::implied, kImpliedConfidence, "the roof's tagged height or angle is 0"});
  if (own.roof_orientation || own.roof_direction || tags_speak_of_slope()) {
    // A direction alone means one slope, storeys or an angle mean two, or what sloped roof is usual here.
    const bool one_slope = own.roof_direction && !own.roof_orientation && !tags_speak_of_slope();
    const bool as_usual = agreed && vote->value != RoofShape::flat && vote->value != RoofShape::other;
    const bool drawn = usual.drawn_roof && *usual.drawn_roof != RoofShape::flat;
    choices.push_back({one_slope  ? RoofShape::skillion
                       : drawn    ? *usual.drawn_roof
                       : as_usual ? vote->value
                                  : RoofShape::gabled,
                       Source::implied, kImpliedConfidence,
                       one_slope  ? "other roof tags speak of a slope"
                       : drawn    ? "other roof tags speak of a slope; drawn, " + measure_name()
                       : as_usual ? "other roof tags speak of a slope, neighbours of this one"
                                  : "other roof tags speak of a slope"});
  }
  if (outline && outline->roof_shape && !has_own_height())
    choices.push_back({*outline->roof_shape, Source::implied, kOutlineConfidence, "the outline's roof"});
  if (outline && has_own_height())
    choices.push_back(
        {RoofShape::flat, Source::implied, kGeometryConfidence, "a part with a height and no roof tags ends flat"});
  const bool wide = width() > usual.pitched_width;
  const auto& counted = own.storeys || !outline || has_own_height() ? own.storeys : outline->storeys;
  if (usual.roof_shape != RoofShape::flat && counted && *counted > kMostStoreysUnderRafters)
    choices.push_back({RoofShape::flat, Source::geometry, kImpliedConfidence,
                       fmt::format("{:g} storeys are too many for rafters", *counted)});
  if (usual.roof_shape != RoofShape::flat && part && roofs::is_enclosed(plan(), part->roof_edges))
    choices.push_back(
        {RoofShape::flat, Source::geometry, kImpliedConfidence, "neighbours stand at all sides: no side for eaves"});
  if (const auto& seen = building.seen_roof.pitched; seen.confidence > 0 && is_whole()) {
    const bool as_usual = agreed && vote->value != RoofShape::flat && vote->value != RoofShape::other;
    const RoofShape sloped = usual.drawn_roof && *usual.drawn_roof != RoofShape::flat ? *usual.drawn_roof
                             : as_usual                                               ? vote->value
                             : usual.roof_shape != RoofShape::flat                    ? usual.roof_shape
                                                                                      : RoofShape::gabled;
    choices.push_back(
        {seen.value ? sloped : RoofShape::flat, seen.source, static_cast<double>(seen.confidence), seen.why});
  }
  if (usual.drawn_roof && !wide)
    choices.push_back({*usual.drawn_roof, Source::preset, kPresetConfidence, "drawn, " + measure_name()});
  if (agreed && (vote->value == RoofShape::flat || !wide))
    choices.push_back({vote->value, vote_source,
                       inferred_candidate.confidence > 0 ? static_cast<double>(inferred_candidate.confidence)
                                                         : 0.2 + 0.5 * vote->share,
                       std::move(vote_why)});
  if (usual.roof_shape != RoofShape::flat && wide)
    choices.push_back({RoofShape::flat, Source::geometry, kGeometryConfidence,
                       fmt::format("the plan is {:.0f} m wide, too wide for rafters", width())});
  choices.push_back({usual.roof_shape, measure_source(), measure_confidence(), measure_name()});
  return first(std::move(choices));
}

std::optional<bool> Resolver::seen_across(RoofShape shape) const {
  const auto& ridge = building.seen_roof.ridge;
  if (ridge.confidence <= 0 || shape == RoofShape::flat || !is_whole() || plan().outer.size() < 3) return std::nullopt;
  const model::Point2 longer = geometry::long_axis(plan().outer.points);
  const base::SinCos r = base::sin_cos((90 - ridge.value) * base::kRadiansPerDegree);
  const double along = std::fabs(r.cos * longer.x + r.sin * longer.y),
               across = std::fabs(r.cos * longer.y - r.sin * longer.x);
  // Between both a ridge has no word for its direction.
  if (std::min(along, across) > kOblique * std::max(along, across)) return std::nullopt;
  return across > along;
}

std::optional<model::Point2> Resolver::narrow_front() const {
  if (!part || !is_whole() || plan().outer.size() < 3 || !roofs::has_plain_extents(plan())) return std::nullopt;
  const auto& ring = plan().outer.points;
  if (part->roof_edges.size() < ring.size()) return std::nullopt;
  model::Point2 sum{};  // outward normals by length
  double length = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (part->roof_edges[i] != model::RoofEdge::street) continue;
    const model::Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    sum = {sum.x + (b.y - a.y), sum.y - (b.x - a.x)};
    length += std::hypot(b.x - a.x, b.y - a.y);
  }
  const double front = std::hypot(sum.x, sum.y);
  if (front >= kNarrowestGable && front <= kWidestGable && front >= kOneFront * length)
    return model::Point2{sum.x / front, sum.y / front};
  if (usual.preset.empty() || building.situation.position != model::BuildingPosition::corner_house) return std::nullopt;
  // Two streets: the gable looks on the one that the house has its end on.
  const model::Point2 longer = geometry::long_axis(ring);
  model::Point2 end{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (part->roof_edges[i] != model::RoofEdge::street) continue;
    const model::Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const model::Point2 out{b.y - a.y, a.x - b.x};
    const double ahead = out.x * longer.x + out.y * longer.y;
    if (std::fabs(ahead) > kLooksAhead * std::hypot(out.x, out.y)) end = {end.x + out.x, end.y + out.y};
  }
  const double width = std::hypot(end.x, end.y);
  if (width < kNarrowestGable || width > kWidestGable) return std::nullopt;
  return model::Point2{end.x / width, end.y / width};
}

Sourced<RoofOrientation> Resolver::roof_orientation(RoofShape shape) {
  std::vector<Choice<RoofOrientation>> choices;
  if (own.roof_orientation) choices.push_back({*own.roof_orientation, Source::tag, kTagConfidence, "tagged"});
  if (const auto across = seen_across(shape))
    choices.push_back({*across ? RoofOrientation::across : RoofOrientation::along, building.seen_roof.ridge.source,
                       static_cast<double>(building.seen_roof.ridge.confidence), building.seen_roof.ridge.why});
  const bool may_look =
      shape == RoofShape::gabled || (!usual.preset.empty() && shape != RoofShape::flat && shape != RoofShape::skillion);
  if (usual.gable_to_street && may_look && choices.empty() && !own.roof_direction)
    if (const auto front = narrow_front()) {
      const model::Point2 longer = geometry::long_axis(plan().outer.points);
      const bool along =
          std::fabs(front->x * longer.x + front->y * longer.y) >= std::fabs(front->x * longer.y - front->y * longer.x);
      choices.push_back({along ? RoofOrientation::along : RoofOrientation::across, measure_source(),
                         measure_confidence(), "gable to the street: " + measure_name()});
      gable_to_street = true;
    }
  if (shape != RoofShape::flat && !own.roof_direction && part && plan().outer.size() >= 3) {
    if (const auto axis = roofs::row_axis(plan(), tagged_request(own, shape, part->roof_edges))) {
      const model::Point2 longer = geometry::long_axis(plan().outer.points);
      const bool across =
          std::fabs(axis->x * longer.x + axis->y * longer.y) < std::fabs(axis->x * longer.y - axis->y * longer.x);
      choices.push_back({across ? RoofOrientation::across : RoofOrientation::along, Source::geometry,
                         kPartyWallConfidence, "the ridge follows the row"});
    }
  }
  choices.push_back({RoofOrientation::along, Source::default_, kDefaultConfidence, "along the longer side"});
  return first(std::move(choices));
}

Sourced<double> Resolver::roof_height(RoofShape shape, RoofOrientation orientation, double storey_height) {
  if (shape == RoofShape::flat) return make<double>(0, Source::implied, kImpliedConfidence, "flat roof");
  std::vector<Choice<double>> choices;
  if (const auto tagged = useful_roof_height(own, shape))
    choices.push_back({*tagged, Source::tag, kTagConfidence, "tagged"});
  if (const auto given = height_of_angle(own, shape, plan(), row()))
    choices.push_back(
        {*given, Source::implied, kImpliedConfidence, fmt::format("a tagged pitch of {:g} degrees", *own.roof_angle)});
  if (own.roof_storeys && *own.roof_storeys > 0)
    choices.push_back({*own.roof_storeys * storey_height, Source::implied, kImpliedConfidence,
                       fmt::format("{:g} tagged storeys in the roof", *own.roof_storeys)});
  choices.push_back(usual_height(shape, orientation));
  return first(std::move(choices));
}

double Resolver::other_sides_pitch(RoofShape shape) const {
  if (const auto angle = useful_roof_angle(own, shape)) return *angle;
  return std::min(usual_pitch(shape, usual.roof_pitch), options.max_roof_pitch);
}

Choice<double> Resolver::usual_height(RoofShape shape, RoofOrientation orientation) {
  roofs::RoofRequest request = tagged_request(own, shape, row());
  request.across = orientation == RoofOrientation::across;
  request.axis_is_mapped = request.axis_is_mapped || gable_to_street;
  request.side_pitches = side_pitches();
  request.other_sides_pitch = other_sides_pitch(shape);
  const roofs::MainSlope slope =
      plan().outer.size() < 3 ? roofs::MainSlope{} : roofs::main_slope(plan(), request, true);
  if (request.side_pitches.any() && roofs::takes_side_pitches(shape) && !slope.leans) {
    const double height = slope.run * tangent(request.other_sides_pitch) / slope.rise;
    const bool mapped = own.side_pitches.any();
    if (!mapped && height > options.max_usual_roof_height)
      return {options.max_usual_roof_height, measure_source(), measure_confidence(),
              fmt::format("the highest usual roof, over a run of {:.1f} m", slope.run)};
    if (!mapped) usual_pitch_asked = request.other_sides_pitch;
    return {height, mapped ? Source::implied : measure_source(), mapped ? kImpliedConfidence : measure_confidence(),
            fmt::format("pitches ordered by side: {}; {:.0f} degrees on the others", model::text(request.side_pitches),
                        request.other_sides_pitch)};
  }
  const auto* edges = model::constructed_as<model::EdgeRoof>(shape);
  if (edges && edges->eaves == model::EavesProfile::berlin)
    return {slope.run, measure_source(), measure_confidence(),
            "60 degrees to the street, 8 to the yard, a knee wall there"};
  if (edges && edges->eaves == model::EavesProfile::broken) {
    const double run = roofs::main_slope(plan(), request, false).run, attic = attic_height(usual.storey_height);
    // Below an attic's height there is no storey in it: the pitch alone counts.
    if (run * roofs::kMansardSteep > 2 * attic)
      return {
          roofs::mansard_height(run, attic), measure_source(), measure_confidence(),
          fmt::format("an attic storey of {:.1f} m behind 68 degrees, 26 above, over a run of {:.1f} m", attic, run)};
  }
  double pitch = std::min(usual_pitch(shape, usual.roof_pitch), options.max_roof_pitch);
  if (slope.leans && pitch <= usual.roof_pitch) pitch = std::min(pitch, kLeanPitch);
  const double height = slope.run * tangent(pitch) / slope.rise;
  usual_pitch_asked = pitch;
  if (height > options.max_usual_roof_height && pitch <= usual.roof_pitch) {
    usual_pitch_asked = 0;
    return {options.max_usual_roof_height, measure_source(), measure_confidence(),
            fmt::format("the highest usual roof, over a run of {:.1f} m", slope.run)};
  }
  return {height, measure_source(), measure_confidence(),
          fmt::format("pitch of {:.0f} degrees over a run of {:.1f} m", pitch, slope.run)};
}

void Resolver::fit_roof_height(Attributes& a, bool storeys_known, double plinth, double covered) {
  const double wanted = a.roof_height.value;
  const double whole = std::max(a.height.value - own.min_height.value_or(0), 0.0);
  double roof = wanted;
  std::string why = "what height and storeys leave";
  if (useful_roof_height(own, a.roof_shape.value)) {
    if (wanted <= whole + kNoRoofHeight) return;  // the part may be all roof; walls take their minimum when it is built
    roof = whole;
    why = "what the height leaves";
  } else {
    if (useful_roof_angle(own, a.roof_shape.value) ||
        (own.side_pitches.any() && roofs::takes_side_pitches(a.roof_shape.value))) {
      roof = std::min(wanted, roof_limit(own, a.height.value));
    } else {
      roof = std::min(wanted, 0.6 * whole);
      if (storeys_known && a.storeys.value > 0) {
        const double left = a.height.value - plinth - a.storeys.value * storey_height_of(a.storeys.value);
        roof = std::clamp(left, wanted * 2 / 3, wanted * 4 / 3);
        roof = std::min(roof, std::max(a.height.value - plinth - a.storeys.value * kLowestStorey, 0.1 * whole));
      }
    }
    if (covered > 0) {
      const double upper = storeys_known ? std::max(a.storeys.value - 1, 0.0) * kLowestStorey : 0;
      roof = std::min(roof, std::max(a.height.value - covered - upper, 0.1 * whole));
    }
  }
  if (roof == wanted) return;
  a.roof_height = make<double>(std::max(roof, 0.0), Source::implied, kImpliedConfidence, std::move(why),
                               {{a.roof_height.source, a.roof_height.confidence, fmt::format("{:.2f}", wanted),
                                 region.evidence[a.roof_height.evidence].text}});
}

}  // namespace blockrand::attributes
