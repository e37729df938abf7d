#include "pipeline/attributes/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/attributes/roof_edges.h"
#include "pipeline/attributes/tag_conflicts.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/random.h"
#include "pipeline/geometry/polygon_measures.h"
#include "styles/roofs/roof_sides.h"

namespace blockrand::attributes {

namespace {

using model::Attributes;
using model::Building;
using model::BuildingPart;
using model::Colour;
using model::MappedAttributes;
using model::Region;
using model::RoofOrientation;
using model::RoofShape;
using model::Source;
using model::Sourced;

// How far each kind of source is trusted. Own tags may be wrong, too; the rest is experience, to be replaced by measured
// hit rates when the classifier is fitted.
constexpr float kTagConfidence = 0.95f;
constexpr float kImpliedConfidence = 0.8f;
constexpr float kOutlineConfidence = 0.7f;
constexpr float kGeometryConfidence = 0.4f;
/// Ridges run from party wall to party wall in 315 of 334 cases in The Hague; other towns are less uniform.
constexpr float kPartyWallConfidence = 0.8f;
constexpr float kPresetConfidence = 0.3f;
/// Where a house is entered is read from its front; steps up to a raised ground floor are not known.
constexpr float kPlinthConfidence = 0.6f;
constexpr float kDefaultConfidence = 0.1f;

/// degrees. Wings of half depth lean on the neighbour's wall at 5 to 20 (docs/style_measures.md 2.7).
constexpr double kLeanPitch = 12;

double tangent(double degrees) { return base::tan(degrees * base::kRadiansPerDegree); }

/// Full storeys under rafters: Berlin's building codes from 1887 allowed five and 22 m to the eaves, post-war ones call what has
/// its highest floor above 22 m a tower. Of 37 houses with seven storeys and more that looked sloped 37 are tagged flat, of 29
/// with six 14 (docs/internal/RESULTS.md, "Roofs against references").
constexpr float kMostStoreysUnderRafters = 6;

/// m. Storeys that tagged height and terrain would squeeze below this say that the height is measured from elsewhere.
constexpr double kSquashedStorey = 1.5;

/// Pitch of roofs that no tag measures, degrees. \param of_use  that of sloped roofs of the building's use
double usual_pitch(RoofShape shape, double of_use) {
  const model::UsualPitch& pitch = model::traits(shape).pitch;
  return pitch.own > 0 ? pitch.own : std::min(of_use, pitch.most);
}

/// One thing that an attribute could be.
template <class T>
struct Choice {
  T value{};
  Source source = Source::default_;
  double confidence = 0;
  std::string why;
};

std::string text_of(double value) { return fmt::format("{:g}", value); }
std::string text_of(RoofShape value) { return std::string(model::name(value)); }
std::string text_of(RoofOrientation value) { return value == RoofOrientation::across ? "across" : "along"; }
std::string text_of(const Colour& value) { return model::text(value); }
std::string text_of(const std::string& value) { return value; }

/// What is asked while one building or part is resolved.
struct Resolver {
  Region& region;
  const ResolveInputs& in;
  const GenerateOptions& options;
  const Building& building;
  const BuildingPart* part;         ///< null when the building as a whole is resolved
  const MappedAttributes& own;      ///< tags of the part, or of the building
  const MappedAttributes* outline;  ///< tags of the outline when a part is resolved
  const UseDefaults& preset;
  std::uint8_t group;
  const std::vector<model::Polygon>& plans;
  model::OsmId id;
  const context::BuildingGround& ground;
  double rise = 0;                   ///< m: highest ground under this body above the building's lowest
  std::optional<double> floor = {};  ///< m above the lowest ground: level of the building's ground floor, once known
  std::vector<TagConflict> against_terrain = {};  ///< what tags and terrain do not agree about
  double usual_pitch_asked = 0;                   ///< degrees, of usual_height()

  template <class T>
  Sourced<T> make(T value, Source source, double confidence, std::string why,
                  std::vector<model::Candidate> other_candidates = {}) {
    return {std::move(value), source, static_cast<float>(confidence),
            region.evidence.add({std::move(why), std::move(other_candidates)})};
  }
  template <class T>
  model::Candidate other_candidates(const Choice<T>& choice) {
    return {choice.source, static_cast<float>(choice.confidence), text_of(choice.value), choice.why};
  }
  /// The first of `choices`, which stand in the order of their strength; the others are noted as what lost.
  template <class T>
  Sourced<T> first(std::vector<Choice<T>> choices) {
    std::vector<model::Candidate> others;
    others.reserve(choices.size() - 1);
    for (std::size_t i = 1; i < choices.size(); ++i) others.push_back(other_candidates(choices[i]));
    Choice<T>& won = choices.front();
    return make<T>(std::move(won.value), won.source, won.confidence, std::move(won.why), std::move(others));
  }
  std::string_view text(base::StringId id_) const { return region.extract->strings.view(id_); }

  model::Point2 place() const {
    return plans.empty() || plans[0].outer.points.empty() ? model::Point2{} : plans[0].outer.points[0];
  }

  Source preset_source() const {
    return preset.name == "default" && preset.style.empty() ? Source::default_ : Source::preset;
  }
  double preset_confidence() const {
    if (!preset.style.empty())
      return std::max<double>(kDefaultConfidence, 0.6 * static_cast<double>(building.inferred.style_confidence));
    return preset.name == "default" ? kDefaultConfidence : kPresetConfidence;
  }
  std::string preset_name() const {
    if (!preset.style.empty()) return "usual for the style " + preset.style;
    return preset.name == "default" ? "default for all buildings" : "usual for building=" + preset.name;
  }

  /// A monument, a garage, a tank: houses around it say nothing of it.
  bool is_non_house() const { return building.style_known && building.style.non_house; }

  bool has_own_height() const { return own.height || own.storeys; }

  Sourced<double> storeys() {
    std::vector<Choice<double>> choices;
    if (const double below = storeys_below(own, preset.storey_height); below > 0)
      choices.push_back({below + *own.storeys, Source::implied, kImpliedConfidence,
                         fmt::format("{:g} tagged storeys above {:g} skipped ones", *own.storeys, below)});
    else if (own.storeys)
      choices.push_back({*own.storeys, Source::tag, kTagConfidence, "tagged"});
    if (outline && !own.height && outline->storeys)
      choices.push_back({*outline->storeys, Source::implied, kOutlineConfidence, "the outline's storeys"});
    if (const auto& inferred_candidate = building.inferred.storeys; inferred_candidate.confidence > 0)
      choices.push_back({static_cast<double>(inferred_candidate.value), inferred_candidate.source,
                         static_cast<double>(inferred_candidate.confidence), inferred_candidate.why});
    else if (const auto vote = in.neighbours.storeys(place(), group, id, options.neighbour_minimum);
             vote && !is_non_house())
      choices.push_back({vote->value, Source::neighbours, 0.3 + 0.4 * vote->share,
                         fmt::format("median of {} neighbours within {:.0f} m", vote->voices, in.neighbours.reach())});
    choices.push_back({preset.storeys, preset_source(), preset_confidence(), preset_name()});
    return first(std::move(choices));
  }

  /// True when the tags speak of a roof with a slope without naming its shape.
  bool tags_speak_of_slope() const {
    return (own.roof_storeys && *own.roof_storeys >= 1) || (own.roof_angle && *own.roof_angle >= 10) ||
           (own.roof_height && *own.roof_height >= 1);
  }

  const model::Polygon& plan() const {
    static const model::Polygon none;
    return plans.empty() ? none : plans[0];
  }

  const std::vector<model::RoofEdge>& row() const { return part ? part->roof_edges : kNoRoofEdges; }

  double width() const { return plans.empty() ? 0 : geometry::equivalent_width(plans[0]); }

  Sourced<RoofShape> roof_shape() {
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
      choices.push_back(
          {RoofShape::flat, Source::implied, kImpliedConfidence, "the roof's tagged height or angle is 0"});
    if (own.roof_orientation || own.roof_direction || tags_speak_of_slope()) {
      // A direction alone means one slope, storeys or an angle mean two, or what sloped roof is usual here.
      const bool one_slope = own.roof_direction && !own.roof_orientation && !tags_speak_of_slope();
      const bool as_usual = agreed && vote->value != RoofShape::flat && vote->value != RoofShape::other;
      choices.push_back({one_slope  ? RoofShape::skillion
                         : as_usual ? vote->value
                                    : RoofShape::gabled,
                         Source::implied, kImpliedConfidence,
                         as_usual && !one_slope ? "other roof tags speak of a slope, neighbours of this one"
                                                : "other roof tags speak of a slope"});
    }
    if (outline && outline->roof_shape && !has_own_height())
      choices.push_back({*outline->roof_shape, Source::implied, kOutlineConfidence, "the outline's roof"});
    if (outline && has_own_height())
      choices.push_back(
          {RoofShape::flat, Source::implied, kGeometryConfidence, "a part with a height and no roof tags ends flat"});
    const bool wide = width() > preset.pitched_width;
    const auto& counted = own.storeys || !outline || has_own_height() ? own.storeys : outline->storeys;
    if (preset.roof_shape != RoofShape::flat && counted && *counted > kMostStoreysUnderRafters)
      choices.push_back({RoofShape::flat, Source::geometry, kImpliedConfidence,
                         fmt::format("{:g} storeys are too many for rafters", *counted)});
    if (preset.roof_shape != RoofShape::flat && part && roofs::is_enclosed(plan(), part->roof_edges))
      choices.push_back(
          {RoofShape::flat, Source::geometry, kImpliedConfidence, "neighbours stand at all sides: no side for eaves"});
    if (agreed && (vote->value == RoofShape::flat || !wide))
      choices.push_back({vote->value, vote_source,
                         inferred_candidate.confidence > 0 ? static_cast<double>(inferred_candidate.confidence)
                                                           : 0.2 + 0.5 * vote->share,
                         std::move(vote_why)});
    if (preset.roof_shape != RoofShape::flat && wide)
      choices.push_back({RoofShape::flat, Source::geometry, kGeometryConfidence,
                         fmt::format("the plan is {:.0f} m wide, too wide for rafters", width())});
    choices.push_back({preset.roof_shape, preset_source(), preset_confidence(), preset_name()});
    return first(std::move(choices));
  }

  Sourced<RoofOrientation> roof_orientation(RoofShape shape) {
    std::vector<Choice<RoofOrientation>> choices;
    if (own.roof_orientation) choices.push_back({*own.roof_orientation, Source::tag, kTagConfidence, "tagged"});
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

  Sourced<double> roof_height(RoofShape shape, RoofOrientation orientation, double storey_height) {
    if (shape == RoofShape::flat) return make<double>(0, Source::implied, kImpliedConfidence, "flat roof");
    std::vector<Choice<double>> choices;
    if (const auto tagged = useful_roof_height(own, shape))
      choices.push_back({*tagged, Source::tag, kTagConfidence, "tagged"});
    if (const auto given = height_of_angle(own, shape, plan(), row()))
      choices.push_back({*given, Source::implied, kImpliedConfidence,
                         fmt::format("a tagged pitch of {:g} degrees", *own.roof_angle)});
    if (own.roof_storeys && *own.roof_storeys > 0)
      choices.push_back({*own.roof_storeys * storey_height, Source::implied, kImpliedConfidence,
                         fmt::format("{:g} tagged storeys in the roof", *own.roof_storeys)});
    choices.push_back(usual_height(shape, orientation));
    return first(std::move(choices));
  }

  /// What roofs of this shape usually measure.
  Choice<double> usual_height(RoofShape shape, RoofOrientation orientation) {
    roofs::RoofRequest request = tagged_request(own, shape, row());
    request.across = orientation == RoofOrientation::across;
    const roofs::MainSlope slope =
        plan().outer.size() < 3 ? roofs::MainSlope{} : roofs::main_slope(plan(), request, true);
    const auto* edges = model::constructed_as<model::EdgeRoof>(shape);
    if (edges && edges->eaves == model::EavesProfile::berlin)
      return {slope.run, preset_source(), preset_confidence(),
              "60 degrees to the street, 8 to the yard, a knee wall there"};
    if (edges && edges->eaves == model::EavesProfile::broken) {
      const double run = roofs::main_slope(plan(), request, false).run, attic = attic_height(preset.storey_height);
      // Below an attic's height there is no storey in it: the pitch alone counts.
      if (run * roofs::kMansardSteep > 2 * attic)
        return {
            roofs::mansard_height(run, attic), preset_source(), preset_confidence(),
            fmt::format("an attic storey of {:.1f} m behind 68 degrees, 26 above, over a run of {:.1f} m", attic, run)};
    }
    double pitch = std::min(usual_pitch(shape, preset.roof_pitch), options.max_roof_pitch);
    if (slope.leans && pitch <= preset.roof_pitch) pitch = std::min(pitch, kLeanPitch);
    const double height = slope.run * tangent(pitch) / slope.rise;
    usual_pitch_asked = pitch;
    if (height > options.max_usual_roof_height && pitch <= preset.roof_pitch) {
      usual_pitch_asked = 0;
      return {options.max_usual_roof_height, preset_source(), preset_confidence(),
              fmt::format("the highest usual roof, over a run of {:.1f} m", slope.run)};
    }
    return {height, preset_source(), preset_confidence(),
            fmt::format("pitch of {:.0f} degrees over a run of {:.1f} m", pitch, slope.run)};
  }

  /// The roof's height against the building's: a measured roof is limited by what is there, a pitch by the storeys as
  /// well; storeys in the roof and usual pitches give way to what plinth, height and storeys leave by up to a third.
  /// \param covered  m: ground that no eaves may lie below
  void fit_roof_height(Attributes& a, bool storeys_known, double plinth, double covered) {
    const double wanted = a.roof_height.value;
    const double whole = std::max(a.height.value - own.min_height.value_or(0), 0.0);
    double roof = wanted;
    std::string why = "what height and storeys leave";
    if (useful_roof_height(own, a.roof_shape.value)) {
      if (wanted <= whole + kNoRoofHeight)
        return;  // the part may be all roof; walls take their minimum when it is built
      roof = whole;
      why = "what the height leaves";
    } else {
      if (useful_roof_angle(own, a.roof_shape.value)) {
        roof = std::min(wanted, roof_limit(own, a.height.value));
      } else {
        roof = std::min(wanted, 0.6 * whole);
        if (storeys_known && a.storeys.value > 0) {
          const double left = a.height.value - plinth - a.storeys.value * preset.storey_height;
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

  bool is_canopy() const { return text(own.use) == "roof"; }

  /// Whether the building's ground floor would lie more than a storey above all ground under this body.
  bool leaves_common_floor() const { return floor && *floor - rise > preset.storey_height; }

  /// Where the ground floor should lie, m above the lowest ground: at the entrance, and at most a storey below the
  /// highest ground. A canopy has no storey to lie in: the ground goes on under it.
  double wished_plinth() const {
    if (leaves_common_floor()) return rise;
    if (floor) return *floor;
    if (is_canopy()) return rise;
    return std::max({ground.entrance, rise - preset.storey_height, 0.0}) + preset.plinth;
  }

  void set_plinth(Attributes& a, double height, std::string why = {}) {
    const bool terrain = ground.lowest.source == Source::terrain;
    if (why.empty() && terrain) {
      why = ground.entrance_reason;
      if (height > ground.entrance) why = "so that the ground floor does not lie below the terrain";
      if (leaves_common_floor())
        why = fmt::format("highest ground under this part; the building's ground floor lies {:.1f} m higher",
                          *floor - rise);
      if (floor && height == *floor && part) why = "the building's ground floor; " + why;
    }
    const bool usual = preset.plinth > 0 && height > 0;
    if (usual && terrain) why += fmt::format("; {:.1f} m up to the ground floor, {}", preset.plinth, preset_name());
    if (!terrain) why = usual ? "no terrain; " + preset_name() : "no terrain";
    a.plinth_height = make<double>(height,
                                   terrain ? Source::terrain
                                   : usual ? Source::preset
                                           : Source::default_,
                                   terrain ? kPlinthConfidence
                                   : usual ? preset_confidence()
                                           : kDefaultConfidence,
                                   std::move(why));
  }

  /// What remains of a body under its roof. One that is all roof has its storeys in there.
  static double inhabited(double height, double roof) {
    const double walls = std::max(height - roof, 0.0);
    return walls < kLowestStorey ? height : walls;
  }

  /// Whether a tagged height, measured from the lowest ground, leaves storeys above the highest.
  /// \param counted  storeys; 0: nobody counted them
  bool leaves_storeys(double height, double roof, double counted) const {
    const double walls = inhabited(height, roof);
    if (counted <= 1) return walls >= rise;
    const double each = (walls - rise) / (counted - 1);  // where the ground floor's ceiling is at the highest ground
    return each >= std::min(kSquashedStorey, 0.5 * walls / counted);
  }

  /// The plinth below `walls` m of storeys whose tagged height is measured from the lowest ground.
  double fitted_plinth(double walls, double counted) const {
    const double wished = wished_plinth();
    if (rise <= 0 || !context::stands_on_ground(own)) return wished;
    double plinth = std::min(wished, std::max(walls - std::max(counted, 1.0) * kLowestStorey, 0.0));
    // Undrowned: plinth + (walls - plinth) / counted >= rise.
    if (counted > 1) plinth = std::max(plinth, (counted * rise - walls) / (counted - 1));
    return plinth;
  }

  /// Storeys, roof and plinth under a tagged height. \param in_terrain  whether the height is measured from the lowest
  /// ground; else from the ground floor
  void divide_height(Attributes& a, bool storeys_known, bool in_terrain) {
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
                         {preset.storey_height, preset_source(), preset_confidence(), preset_name()}});
    } else {
      double whole = std::max(1.0, std::floor(walls / preset.storey_height + 0.5));
      while (whole > 1 && in_terrain && context::stands_on_ground(own) && plinth + walls / whole < rise) --whole;
      a.storeys = make<double>(whole, Source::implied, 0.6,
                               fmt::format("{:.1f} m of wall at {:.1f} m a storey", walls, preset.storey_height),
                               {{a.storeys.source, a.storeys.confidence, text_of(a.storeys.value),
                                 region.evidence[a.storeys.evidence].text}});
      a.storey_height = first<double>({{walls / whole, Source::implied, 0.6, "height over storeys"},
                                       {preset.storey_height, preset_source(), preset_confidence(), preset_name()}});
    }
    if (!in_terrain) return;
    const double wished = wished_plinth();
    set_plinth(a, plinth,
               plinth < wished
                   ? fmt::format("{:.1f} m wished, less so that storeys fit below the tagged height", wished)
                   : "");
  }

  /// A tagged height against the terrain.
  void tagged_height(Attributes& a, bool storeys_known) {
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
    a.height = make<double>(
        tagged.value + plinth, Source::implied, kImpliedConfidence, std::move(why),
        {{tagged.source, tagged.confidence, text_of(tagged.value), region.evidence[tagged.evidence].text}});
    against_terrain.push_back(
        {model::IssueCode::values_conflict,
         fmt::format(
             "height={:g} leaves no storey above terrain that rises by {:.1f} m: measured from the ground floor",
             tagged.value, rise)});
  }

  /// Storeys, heights, plinth and roof, which hang together.
  void heights(Attributes& a) {
    a.roof_shape = roof_shape();
    a.roof_orientation = roof_orientation(a.roof_shape.value);
    a.storeys = storeys();
    a.storey_height = make<double>(preset.storey_height, preset_source(), preset_confidence(), preset_name());
    a.roof_storeys = own.roof_storeys ? make<double>(*own.roof_storeys, Source::tag, kTagConfidence, "tagged")
                                      : make<double>(0, Source::default_, kDefaultConfidence, "none tagged");
    a.roof_height = roof_height(a.roof_shape.value, a.roof_orientation.value, std::min(preset.storey_height, 3.0));
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
      const double under = own.min_height.value_or(
          own.min_storey.value_or(0) > 0 ? plinth + *own.min_storey * a.storey_height.value : 0);
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

  std::string height_in_words(double plinth, const Attributes& a) const {
    const std::string below = plinth > 0 ? fmt::format("a plinth of {:.1f} m, ", plinth) : std::string();
    return below + fmt::format("{:g} storeys of {:.1f} m and a roof of {:.1f} m", a.storeys.value,
                               a.storey_height.value, a.roof_height.value);
  }

  template <class Pick>
  Sourced<Colour> colour(std::optional<Colour> tagged, std::optional<Colour> outline_tagged,
                         const Sourced<std::string>& material, const std::vector<Colour>& palette, const char* choice,
                         Pick&& preset_applies) {
    std::vector<Choice<Colour>> choices;
    if (tagged) choices.push_back({*tagged, Source::tag, kTagConfidence, "tagged"});
    if (outline_tagged)
      choices.push_back({*outline_tagged, Source::implied, kOutlineConfidence, "the outline's colour"});
    const int index = in.defaults.material(material.value);
    if (!preset_applies() && index >= 0)
      choices.push_back({in.defaults.materials[static_cast<std::size_t>(index)].colour, Source::implied, 0.5,
                         "colour of " + material.value});
    // All parts of a building are painted alike: the key is the building's.
    const std::uint64_t bits = base::random_bits(in.seed, building.osm.key(), choice);
    choices.push_back({palette[bits % palette.size()], preset_source(), kDefaultConfidence,
                       "drawn from the palette, " + preset_name()});
    return first(std::move(choices));
  }

  Sourced<std::string> material(base::StringId tagged, base::StringId outline_tagged,
                                const std::string& preset_material) {
    const auto known = [&](base::StringId value) -> int { return value == 0 ? -1 : in.defaults.material(text(value)); };
    const auto class_name = [&](int index) {
      return in.defaults.materials[static_cast<std::size_t>(index)].material_class.name;
    };
    std::vector<Choice<std::string>> choices;
    if (const int m = known(tagged); m >= 0)
      choices.push_back({class_name(m), Source::tag, kTagConfidence, "tagged " + std::string(text(tagged))});
    if (const int m = known(outline_tagged); m >= 0)
      choices.push_back({class_name(m), Source::implied, kOutlineConfidence, "the outline's material"});
    choices.push_back({preset_material, preset_source(), kDefaultConfidence, preset_name()});
    return first(std::move(choices));
  }

  void looks(Attributes& a) {
    const base::StringId outline_wall = outline ? outline->wall_material : 0,
                         outline_roof = outline ? outline->roof_material : 0;
    a.wall_material = material(own.wall_material, outline_wall, preset.wall_material);
    const bool flat = a.roof_shape.value == RoofShape::flat;
    a.roof_material =
        material(own.roof_material, outline_roof, flat ? preset.flat_roof_material : preset.roof_material);
    a.wall_colour = colour(own.wall_colour, outline ? outline->wall_colour : std::nullopt, a.wall_material,
                           preset.wall_colours, "wall_colour", [&] {
                             return a.wall_material.source != Source::tag && a.wall_material.source != Source::implied;
                           });
    a.roof_colour = colour(
        own.roof_colour, outline ? outline->roof_colour : std::nullopt, a.roof_material, preset.roof_colours,
        "roof_colour",
        [&] { return !flat && a.roof_material.source != Source::tag && a.roof_material.source != Source::implied; });
  }

  Attributes resolve(Sourced<double> lowest) {
    Attributes a;
    a.use = own.use != 0 ? make(std::string(text(own.use)), Source::tag, kTagConfidence, "tagged")
                         : make(std::string("yes"), Source::default_, kDefaultConfidence, "not tagged");
    a.ground_height = lowest;
    heights(a);
    if (own.roof_direction) a.roof_direction = make<double>(*own.roof_direction, Source::tag, kTagConfidence, "tagged");
    looks(a);
    derived(a);
    return a;
  }

  /// What follows from the other values: eaves, pitch, direction of the ridge.
  void derived(Attributes& a) {
    const bool weaker = a.roof_height.confidence < a.height.confidence;
    a.eaves_height = make<double>(
        std::max(a.height.value - a.roof_height.value, 0.0), weaker ? a.roof_height.source : a.height.source,
        std::min(a.height.confidence, a.roof_height.confidence), "height less that of the roof");
    if (a.roof_shape.value == RoofShape::flat) {
      a.roof_pitch = make<double>(0, a.roof_shape.source, a.roof_shape.confidence, "flat roof");
      return;
    }
    roofs::RoofRequest request = tagged_request(own, a.roof_shape.value, row());
    request.across = a.roof_orientation.value == RoofOrientation::across;
    if (const auto angle = useful_roof_angle(own, a.roof_shape.value)) {
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
  std::string text(const Sourced<RoofOrientation>& orientation) const {
    return region.evidence[orientation.evidence].text;
  }

  /// Whether outputs state the direction of a ridge.
  static bool has_ridge(RoofShape shape) {
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
};

/// A use whose buildings have the storeys, roofs and colours of their time; churches, halls and sheds have those of their use.
bool follows_style(const Defaults& defaults, const UseDefaults& use) {
  const std::string& group = defaults.groups[use.group];
  return group == "residential" || group == "commercial" || group == "other" || group == "public";
}

/// The measures and colours of the style that a building is thought to have. \param storage  holds them
const UseDefaults& with_style(const Building& building, const ResolveInputs& in, const UseDefaults& usual,
                              UseDefaults& storage) {
  if (in.catalogue == nullptr || building.inferred.style_confidence <= 0 || !follows_style(in.defaults, usual))
    return usual;
  const classify::Style& style = (*in.catalogue)[building.inferred.style];
  if (style.style_class == model::StyleClass::other && !style.eaves) return usual;
  // What is no house has the measures of its kind only where its use has none.
  if (building.style.non_house && usual.name != "yes" && usual.name != "default") return usual;
  storage = usual;
  storage.style = style.id;
  storage.storeys = style.storeys.typ;
  // Gross: the wall above the topmost ceiling is shared out, so that storeys, plinth and roof add up to the height.
  storage.storey_height = style.storey_height + style.attic_wall / style.storeys.typ;
  storage.plinth = style.plinth;
  if (style.roof_pitch) storage.roof_pitch = style.roof_pitch->typ;
  storage.wall_colours = style.wall_colours;
  storage.roof_colours = style.roof_colours;
  storage.wall_material = style.wall_material;
  // A flat roof keeps its felt whatever lies on sloped ones.
  storage.roof_material = style.roof_material;
  return storage;
}

std::string ground_reason(Source source) {
  if (source == Source::terrain) return "lowest terrain under the outline";
  if (source == Source::override_) return "one ground height for all, as given";
  return "no terrain and no ground height given";
}

double area_of(const std::vector<model::Polygon>& plans) {
  double sum = 0;
  for (const auto& p : plans) sum += geometry::area(p);
  return sum;
}

}  // namespace

double attic_height(double storey_height) { return std::clamp(storey_height, 2.2, 2.8); }

std::uint8_t neighbour_group(const Defaults& defaults, std::string_view use, double area) {
  return area < defaults.small_area && use == "yes" ? defaults.small.group : defaults.use(use).group;
}

void resolve_attributes(Region& region, const ResolveInputs& in, const GenerateOptions& options) {
  const auto use_text = [&](const MappedAttributes& mapped) { return region.extract->strings.view(mapped.use); };
  for (Building& building : region.buildings) {
    prepare_roof_plans(building, options.collinear_tolerance);
    const OverrideEntry* const entry_of_building = in.overrides ? in.overrides->find(building.osm) : nullptr;
    context::BuildingGround ground = in.ground(building);
    override_ground(entry_of_building, ground);
    Sourced<double> lowest = ground.lowest;
    lowest.evidence = region.evidence.add({ground_reason(lowest.source), {}});
    const std::string_view use = use_text(building.mapped);
    const double area = area_of(building.outline);
    // An outline of a few square metres that says nothing but `yes` is no house.
    const bool small = use == "yes" && !building.outline.empty() && area < in.defaults.small_area;
    UseDefaults styled, changed;
    const UseDefaults& preset = with_overrides(
        entry_of_building, with_style(building, in, small ? in.defaults.small : in.defaults.use(use), styled), changed);
    const std::uint8_t group = neighbour_group(in.defaults, use, area);

    std::vector<model::ReportRow> conflicts;
    const auto tell = [&conflicts](model::OsmId id, std::vector<TagConflict> told) {
      for (TagConflict& c : told) {
        model::ReportRow row{id, c.code, std::move(c.text)};
        // Pieces of one outline have the same tags.
        if (std::find(conflicts.begin(), conflicts.end(), row) == conflicts.end()) conflicts.push_back(std::move(row));
      }
    };
    Resolver whole{region, in,    options,          building,     nullptr, building.mapped, nullptr,
                   preset, group, building.outline, building.osm, ground,  ground.rise};
    const bool one_body = building.parts.size() == 1 && !building.has_mapped_parts;
    if (!one_body) building.attributes = whole.resolve(lowest);
    for (BuildingPart& part : building.parts) {
      const auto index = static_cast<std::size_t>(&part - building.parts.data());
      const bool own_tags = building.has_mapped_parts && !part.rest;
      const std::string_view part_use = use_text(part.mapped);
      // building:part=yes says nothing; a use of its own does.
      const bool own_use = own_tags && in.defaults.uses.contains(part_use) && part_use != "yes";
      UseDefaults part_styled, part_changed;
      const UseDefaults& part_preset = with_overrides(
          own_tags && in.overrides ? in.overrides->find(part.osm) : nullptr,
          own_use ? with_style(building, in, in.defaults.use(part_use), part_styled) : preset, part_changed);
      const std::vector<model::Polygon> plan{part.roof_plan};
      Resolver r{region,
                 in,
                 options,
                 building,
                 &part,
                 part.mapped,
                 own_tags && building.osm != part.osm ? &building.mapped : nullptr,
                 part_preset,
                 group,
                 plan,
                 building.osm,
                 ground,
                 index < ground.part_rise.size() ? ground.part_rise[index] : ground.rise,
                 one_body ? std::nullopt : std::optional(building.attributes.plinth_height.value)};
      part.attributes = r.resolve(lowest);
      const Source measured = part.attributes.roof_height.source;
      if (measured == Source::preset || measured == Source::default_) part.usual_pitch = r.usual_pitch_asked;
      tell(part.osm, tag_conflicts(part.mapped, {part.attributes.roof_shape.value, part.roof_plan,
                                                 r.preset.storey_height, !part.roof_lines.empty(), part.roof_edges}));
      tell(part.osm, std::move(r.against_terrain));
      part.canopy = part_use == "roof" || (own_tags && part_use == "yes" && use == "roof");
    }
    region.report.append({std::move(conflicts)});
    if (one_body) {
      building.attributes = building.parts[0].attributes;
    } else if (building.has_mapped_parts && !building.parts.empty() && !building.mapped.height) {
      double top = 0;
      for (const BuildingPart& p : building.parts) top = std::max(top, p.attributes.height.value);
      building.attributes.height = whole.make<double>(top, Source::part, 0.9, "highest of its parts");
    }
  }
}

}  // namespace blockrand::attributes
