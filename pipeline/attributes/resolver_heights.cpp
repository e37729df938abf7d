// Storeys, heights, plinth and roof, which hang together; and what follows from them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/attributes/resolver.h"
#include "pipeline/base/portable_math.h"
#include "styles/roofs/roof_sides.h"

namespace blockrand::attributes {
namespace {

using model::Attributes;
using model::MappedAttributes;
using model::RoofOrientation;
using model::RoofShape;
using model::Source;
using model::Sourced;

/// m. Storeys that tagged height and terrain would squeeze below this say that the height is measured from elsewhere.
constexpr double kSquashedStorey = 1.5;

}  // namespace

double Resolver::wished_plinth() const {
  if (leaves_common_floor()) return rise;
  if (floor) return *floor;
  if (is_canopy()) return rise;
  return std::max({ground.entrance, rise - usual.storey_height, 0.0}) + usual.plinth;
}

void Resolver::set_plinth(Attributes& a, double height, std::string why) {
  const bool terrain = ground.lowest.source == Source::terrain;
  if (why.empty() && terrain) {
    why = ground.entrance_reason;
    if (height > ground.entrance) why = "so that the ground floor does not lie below the terrain";
    if (leaves_common_floor())
      why = fmt::format("highest ground under this part; the building's ground floor lies {:.1f} m higher",
                        *floor - rise);
    if (floor && height == *floor && part) why = "the building's ground floor; " + why;
  }
  const bool raised = usual.plinth > 0 && height > 0;
  if (raised && terrain) why += fmt::format("; {:.1f} m up to the ground floor, {}", usual.plinth, usual_name());
  if (!terrain) why = raised ? "no terrain; " + usual_name() : "no terrain";
  a.plinth_height = make<double>(height,
                                 terrain  ? Source::terrain
                                 : raised ? Source::preset
                                          : Source::default_,
                                 terrain  ? kPlinthConfidence
                                 : raised ? usual_confidence()
                                          : kDefaultConfidence,
                                 std::move(why));
}

bool Resolver::leaves_storeys(double height, double roof, double counted) const {
  const double walls = inhabited(height, roof);
  if (counted <= 1) return walls >= rise;
  const double each = (walls - rise) / (counted - 1);  // where the ground floor's ceiling is at the highest ground
  return each >= std::min(kSquashedStorey, 0.5 * walls / counted);
}

double Resolver::fitted_plinth(double walls, double counted) const {
  const double wished = wished_plinth();
  if (rise <= 0 || !context::stands_on_ground(own)) return wished;
  double plinth = std::min(wished, std::max(walls - std::max(counted, 1.0) * kLowestStorey, 0.0));
  // Undrowned: plinth + (walls - plinth) / counted >= rise.
  if (counted > 1) plinth = std::max(plinth, (counted * rise - walls) / (counted - 1));
  return plinth;
}

void Resolver::divide_height(Attributes& a, bool storeys_known, bool in_terrain) {
  const double counted = storeys_known ? a.storeys.value : 0;
  if (a.roof_shape.value != RoofShape::flat) {
    const double least = std::max(counted, 1.0) * kLowestStorey;
    const double beside =
        in_terrain ? std::clamp(a.height.value - a.roof_height.value * 2 / 3 - least, 0.0, wished_plinth()) : 0;
    fit_roof_height(a, storeys_known, beside, in_terrain && context::stands_on_ground(own) ? rise : 0);
  }
  const double above = std::max(a.height.value - a.roof_height.value, 0.0);
  const double plinth = in_terrain ? fitted_plinth(inhabited(a.height.value, a.roof_height.value), counted) : 0;
  const double walls = std::max(above - plinth, 0.0);
  if (counted > 0) {
    a.storey_height =
        first<double>({{walls / a.storeys.value, Source::implied, kImpliedConfidence, "height over storeys"},
                       {usual.storey_height, usual_source(), usual_confidence(), usual_name()}});
  } else {
    double whole = std::max(1.0, std::floor(walls / usual.storey_height + 0.5));
    while (whole > 1 && in_terrain && context::stands_on_ground(own) && plinth + walls / whole < rise) --whole;
    a.storeys = make<double>(
        whole, Source::implied, 0.6, fmt::format("{:.1f} m of wall at {:.1f} m a storey", walls, usual.storey_height),
        {{a.storeys.source, a.storeys.confidence, text_of(a.storeys.value), region.evidence[a.storeys.evidence].text}});
    a.storey_height = first<double>({{walls / whole, Source::implied, 0.6, "height over storeys"},
                                     {usual.storey_height, usual_source(), usual_confidence(), usual_name()}});
  }
  if (!in_terrain) return;
  const double wished = wished_plinth();
  set_plinth(
      a, plinth,
      plinth < wished ? fmt::format("{:.1f} m wished, less so that storeys fit below the tagged height", wished) : "");
}

void Resolver::tagged_height(Attributes& a, bool storeys_known) {
  const auto measured = useful_roof_height(own, a.roof_shape.value);
  const double least_roof = a.roof_shape.value == RoofShape::flat ? 0 : measured ? *measured : 0.1 * a.height.value;
  if (rise <= 0 || !context::stands_on_ground(own) ||
      leaves_storeys(a.height.value, least_roof, storeys_known ? a.storeys.value : 0)) {
    divide_height(a, storeys_known, true);
    return;
  }
  const Sourced<double> tagged = a.height;
  divide_height(a, storeys_known, false);
  const double plinth = std::max(wished_plinth(), rise - a.storey_height.value);
  set_plinth(a, plinth);
  std::string why = fmt::format("{:g} m as tagged, from the ground floor: the terrain rises by {:.1f} m under it",
                                tagged.value, rise);
  a.height =
      make<double>(tagged.value + plinth, Source::implied, kImpliedConfidence, std::move(why),
                   {{tagged.source, tagged.confidence, text_of(tagged.value), region.evidence[tagged.evidence].text}});
  against_terrain.push_back(
      {model::IssueCode::values_conflict,
       fmt::format("height={:g} leaves no storey above terrain that rises by {:.1f} m: measured from the ground floor",
                   tagged.value, rise)});
}

void Resolver::heights(Attributes& a) {
  a.roof_shape = roof_shape();
  a.roof_orientation = roof_orientation(a.roof_shape.value);
  a.storeys = storeys();
  a.storey_height =
      make<double>(storey_height_of(a.storeys.value), usual.heights_preset.empty() ? usual_source() : Source::preset,
                   usual.heights_preset.empty() ? usual_confidence() : kPresetConfidence, heights_name());
  a.roof_storeys = own.roof_storeys ? make<double>(*own.roof_storeys, Source::tag, kTagConfidence, "tagged")
                                    : make<double>(0, Source::default_, kDefaultConfidence, "none tagged");
  a.roof_height = roof_height(a.roof_shape.value, a.roof_orientation.value, std::min(a.storey_height.value, 3.0));
  const MappedAttributes* height_from = own.height                                        ? &own
                                        : outline && !has_own_height() && outline->height ? outline
                                                                                          : nullptr;
  if (height_from) {
    const Choice<double> from_storeys{wished_plinth() + a.storeys.value * a.storey_height.value + a.roof_height.value,
                                      a.storeys.source, a.storeys.confidence, height_in_words(wished_plinth(), a)};
    a.height = height_from == &own
                   ? first<double>({{*own.height, Source::tag, kTagConfidence, "tagged"}, from_storeys})
                   : first<double>({{*outline->height, Source::implied, kOutlineConfidence, "the outline's height"},
                                    from_storeys});
    tagged_height(a, a.storeys.source == Source::tag || a.storeys.source == Source::implied);
  } else {
    const double plinth =
        wished_plinth() + a.storey_height.value < rise && context::stands_on_ground(own) && !is_canopy()
            ? rise - a.storey_height.value
            : wished_plinth();
    set_plinth(a, plinth);
    double walls = a.storeys.value * a.storey_height.value;
    // On a flat roof the tagged roof storeys stand as a set-back upper floor; until set-backs are built they add to
    // the walls, so that the height is right.
    if (a.roof_shape.value == RoofShape::flat) walls += a.roof_storeys.value * a.storey_height.value;
    if (walls <= 0 && a.roof_height.value <= 0) walls = a.storey_height.value;
    walls += plinth;
    const bool from_tags = a.storeys.source == Source::tag;
    std::string why = height_in_words(plinth, a);
    // Assumed storeys stand above the tagged underside, at least one of them; of a canopy, its slab.
    const double under =
        own.min_height.value_or(own.min_storey.value_or(0) > 0 ? plinth + *own.min_storey * a.storey_height.value : 0);
    const double least = is_canopy() ? options.canopy_thickness : a.storey_height.value;
    if (!own.storeys && under > 0 && walls < under + least) {
      walls = under + least;
      why = fmt::format("{:.1f} m above an underside at {:.1f} m, and a roof of {:.1f} m", least, under,
                        a.roof_height.value);
    }
    a.height = make<double>(walls + a.roof_height.value, from_tags ? Source::implied : a.storeys.source,
                            from_tags ? 0.6 : a.storeys.confidence, std::move(why));
  }

  if (own.min_height) {
    a.min_height = make<double>(*own.min_height, Source::tag, kTagConfidence, "tagged");
  } else if (own.min_storey && *own.min_storey > 0) {
    a.min_height = make<double>(a.plinth_height.value + *own.min_storey * a.storey_height.value, Source::implied,
                                kImpliedConfidence, fmt::format("{:g} storeys skipped", *own.min_storey));
  } else {
    a.min_height = make<double>(0, Source::default_, 0.9, "stands on the ground");
  }
}

void Resolver::derived(Attributes& a) {
  const bool weaker = a.roof_height.confidence < a.height.confidence;
  a.eaves_height =
      make<double>(std::max(a.height.value - a.roof_height.value, 0.0), weaker ? a.roof_height.source : a.height.source,
                   std::min(a.height.confidence, a.roof_height.confidence), "height less that of the roof");
  if (a.roof_shape.value == RoofShape::flat) {
    a.roof_pitch = make<double>(0, a.roof_shape.source, a.roof_shape.confidence, "flat roof");
    return;
  }
  roofs::RoofRequest request = tagged_request(own, a.roof_shape.value, row());
  request.across = a.roof_orientation.value == RoofOrientation::across;
  request.axis_is_mapped = request.axis_is_mapped || gable_to_street;
  request.side_pitches = side_pitches();
  request.other_sides_pitch = other_sides_pitch(a.roof_shape.value);
  if (request.side_pitches.any() && roofs::takes_side_pitches(a.roof_shape.value)) {
    // A height that says otherwise makes all slopes steeper or gentler by one factor.
    const roofs::MainSlope slope =
        plan().outer.size() < 3 ? roofs::MainSlope{} : roofs::main_slope(plan(), request, true);
    const double pitch = slope.run > 0
                             ? base::atan2(a.roof_height.value * slope.rise, slope.run) / base::kRadiansPerDegree
                             : request.other_sides_pitch;
    a.roof_pitch = make<double>(pitch, a.roof_height.source, a.roof_height.confidence,
                                "of sides without a pitch of their own; ordered: " + model::text(request.side_pitches));
  } else if (const auto angle = useful_roof_angle(own, a.roof_shape.value)) {
    a.roof_pitch = make<double>(*angle, Source::tag, kTagConfidence, "tagged");
  } else {
    const roofs::MainSlope slope =
        plan().outer.size() < 3 ? roofs::MainSlope{} : roofs::main_slope(plan(), request, true);
    const double pitch =
        slope.run > 0 ? base::atan2(a.roof_height.value * slope.rise, slope.run) / base::kRadiansPerDegree : 0;
    a.roof_pitch = make<double>(pitch, a.roof_height.source, a.roof_height.confidence,
                                fmt::format("{:.1f} m over a run of {:.1f} m", a.roof_height.value, slope.run));
  }
  if (plan().outer.size() < 3 || !has_ridge(a.roof_shape.value)) return;
  const auto axis = roofs::row_axis(plan(), request);
  const model::Point2 longer = geometry::long_axis(plan().outer.points);
  model::Point2 along = axis ? *axis : request.across ? model::Point2{-longer.y, longer.x} : longer;
  if (along.x < 0 || (along.x == 0 && along.y < 0)) along = {-along.x, -along.y};
  const double north = base::atan2(along.x, along.y) / base::kRadiansPerDegree;  // along.x >= 0: 0 to 180
  a.ridge_direction = make<double>(north >= 180 ? 0 : north, a.roof_orientation.source, a.roof_orientation.confidence,
                                   text(a.roof_orientation));
}

bool Resolver::has_ridge(RoofShape shape) {
  using enum model::RoofGroup;
  switch (model::traits(shape).group) {
    case gabled:
    case hipped:
    case mansard:
    case saltbox:
      return true;
    case flat:
    case cross_gabled:
    case pyramidal:
    case shed:
    case folded:
    case round:
    case other:
      break;
  }
  return false;
}

}  // namespace blockrand::attributes
