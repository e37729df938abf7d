// How one building or part is resolved, value by value: what speaks for each, in the order of its strength. Of resolve.cpp
// and the two sources that implement the rest; everybody else takes resolve.h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/attributes/resolve.h"
#include "pipeline/attributes/roof_edges.h"
#include "pipeline/attributes/tag_conflicts.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::attributes {

// How far each kind of source is trusted. Own tags may be wrong, too. All of these are experience, none is a measured hit
// rate; what classification offers brings its own confidence (offers_of_style).
inline constexpr float kTagConfidence = 0.95f;
inline constexpr float kImpliedConfidence = 0.8f;
inline constexpr float kOutlineConfidence = 0.7f;
inline constexpr float kGeometryConfidence = 0.4f;
/// Ridges run from party wall to party wall in 315 of 334 cases in The Hague; other towns are less uniform.
inline constexpr float kPartyWallConfidence = 0.8f;
inline constexpr float kPresetConfidence = 0.3f;
/// Where a house is entered is read from its front; steps up to a raised ground floor are not known.
inline constexpr float kPlinthConfidence = 0.6f;
inline constexpr float kDefaultConfidence = 0.1f;

/// One thing that an attribute could be.
template <class T>
struct Choice {
  T value{};
  model::Source source = model::Source::default_;
  double confidence = 0;
  std::string why;
};

// For evidence: candidates that lost are kept as text.
std::string text_of(double value);
std::string text_of(model::RoofShape value);
std::string text_of(model::RoofOrientation value);
std::string text_of(const model::Colour& value);
std::string text_of(const std::string& value);

/// What is asked while one building or part is resolved.
struct Resolver {
  model::Region& region;
  const ResolveInputs& in;
  const GenerateOptions& options;
  const model::Building& building;
  const model::BuildingPart* part;         ///< null when the building as a whole is resolved
  const model::MappedAttributes& own;      ///< tags of the part, or of the building
  const model::MappedAttributes* outline;  ///< tags of the outline when a part is resolved
  const UseDefaults& usual;  ///< of its use (configs/defaults/uses.toml) and style: what it gets where nothing is known
  std::uint8_t group;
  const std::vector<model::Polygon>& plans;
  model::OsmId id;
  const context::BuildingGround& ground;
  double rise = 0;                   ///< m: highest ground under this body above the building's lowest
  std::optional<double> floor = {};  ///< m above the lowest ground: level of the building's ground floor, once known
  std::vector<TagConflict> against_terrain = {};  ///< what tags and terrain do not agree about
  bool gable_to_street = false;                   ///< roof_orientation() chose it
  double usual_pitch_asked = 0;                   ///< degrees, of usual_height()

  template <class T>
  model::Sourced<T> make(T value, model::Source source, double confidence, std::string why,
                         std::vector<model::Candidate> other_candidates = {}) {
    return {std::move(value), source, static_cast<float>(confidence),
            region.evidence.add({std::move(why), std::move(other_candidates)})};
  }
  template <class T>
  model::Candidate other_candidate(const Choice<T>& choice) {
    return {choice.source, static_cast<float>(choice.confidence), text_of(choice.value), choice.why};
  }
  /// The first of `choices`, which stand in the order of their strength; the others are noted as what lost.
  template <class T>
  model::Sourced<T> first(std::vector<Choice<T>> choices) {
    std::vector<model::Candidate> others;
    others.reserve(choices.size() - 1);
    for (std::size_t i = 1; i < choices.size(); ++i) others.push_back(other_candidate(choices[i]));
    Choice<T>& won = choices.front();
    return make<T>(std::move(won.value), won.source, won.confidence, std::move(won.why), std::move(others));
  }
  std::string_view text(base::StringId id_) const { return region.extract->strings.view(id_); }

  model::Point2 place() const {
    return plans.empty() || plans[0].outer.points.empty() ? model::Point2{} : plans[0].outer.points[0];
  }

  model::Source usual_source() const {
    return usual.name == "default" && usual.style.empty() ? model::Source::default_ : model::Source::preset;
  }
  double usual_confidence() const {
    if (!usual.style.empty())
      return std::max<double>(kDefaultConfidence, 0.6 * static_cast<double>(building.inferred.style_confidence));
    return usual.name == "default" ? kDefaultConfidence : kPresetConfidence;
  }
  std::string usual_name() const {
    if (!usual.style.empty()) return "usual for the style " + usual.style;
    return usual.name == "default" ? "default for all buildings" : "usual for building=" + usual.name;
  }

  /// m, mean of so many storeys: a preset may state the ground floor's height apart.
  double storey_height_of(double count) const {
    if (usual.heights_preset.empty()) return usual.storey_height;
    const double n = std::max(1.0, count);
    return (usual.ground_floor_height + (n - 1) * usual.upper_storey_height) / n;
  }
  std::string heights_name() const {
    return usual.heights_preset.empty() ? usual_name() : "as the preset " + usual.heights_preset + " states";
  }
  // The same for what a preset states: roofs, their pitch and direction.
  model::Source measure_source() const { return usual.preset.empty() ? usual_source() : model::Source::preset; }
  double measure_confidence() const { return usual.preset.empty() ? usual_confidence() : kPresetConfidence; }
  std::string measure_name() const {
    return usual.preset.empty() ? usual_name() : "as the preset " + usual.preset + " states";
  }

  /// A monument, a garage, a tank: houses around it say nothing of it.
  bool is_non_house() const { return building.style_known && building.style.non_house; }

  /// What is ordered for single sides of the roof: by the object's tags, else by a preset where no tag says the pitch.
  const model::SidePitches& side_pitches() const {
    return own.side_pitches.any() || own.roof_angle ? own.side_pitches : usual.side_pitches;
  }
  /// Degrees, of the sides of which nothing is ordered.
  double other_sides_pitch(model::RoofShape shape) const;

  bool has_own_height() const { return own.height || own.storeys; }

  model::Sourced<double> storeys();

  /// True when the tags speak of a roof with a slope without naming its shape.
  bool tags_speak_of_slope() const {
    return (own.roof_storeys && *own.roof_storeys >= 1) || (own.roof_angle && *own.roof_angle >= 10) ||
           (own.roof_height && *own.roof_height >= 1) || own.side_pitches.any();
  }

  const model::Polygon& plan() const {
    static const model::Polygon none;
    return plans.empty() ? none : plans[0];
  }

  const std::vector<model::RoofEdge>& row() const { return part ? part->roof_edges : kNoRoofEdges; }

  double width() const { return plans.empty() ? 0 : geometry::equivalent_width(plans[0]); }

  /// It stands for the whole outline, which is what an image shows.
  bool is_whole() const { return !building.has_mapped_parts; }
  /// Whether an image shows the ridge across the longer side; nothing where none is seen or it runs between both.
  std::optional<bool> seen_across(model::RoofShape shape) const;

  model::Sourced<model::RoofShape> roof_shape();

  model::Sourced<model::RoofOrientation> roof_orientation(model::RoofShape shape);
  /// Which way the street front looks that is as wide as a gable house's: of a house at a corner that at the end of its
  /// longer side, where a preset wants it; none elsewhere.
  std::optional<model::Point2> narrow_front() const;

  model::Sourced<double> roof_height(model::RoofShape shape, model::RoofOrientation orientation, double storey_height);

  /// What roofs of this shape usually measure.
  Choice<double> usual_height(model::RoofShape shape, model::RoofOrientation orientation);

  /// The roof's height against the building's: a measured roof is limited by what is there, a pitch by the storeys as
  /// well; storeys in the roof and usual pitches give way to what plinth, height and storeys leave by up to a third.
  /// \param covered  m: ground that no eaves may lie below
  void fit_roof_height(model::Attributes& a, bool storeys_known, double plinth, double covered);

  bool is_canopy() const { return text(own.use) == "roof"; }

  /// Whether the building's ground floor would lie more than a storey above all ground under this body.
  bool leaves_common_floor() const { return floor && *floor - rise > usual.storey_height; }

  /// Where the ground floor should lie, m above the lowest ground: at the entrance, and at most a storey below the
  /// highest ground. A canopy has no storey to lie in: the ground goes on under it.
  double wished_plinth() const;

  void set_plinth(model::Attributes& a, double height, std::string why = {});

  /// What remains of a body under its roof. One that is all roof has its storeys in there.
  static double inhabited(double height, double roof) {
    const double walls = std::max(height - roof, 0.0);
    return walls < kLowestStorey ? height : walls;
  }

  /// Whether a tagged height, measured from the lowest ground, leaves storeys above the highest.
  /// \param counted  storeys; 0: nobody counted them
  bool leaves_storeys(double height, double roof, double counted) const;

  /// The plinth below `walls` m of storeys whose tagged height is measured from the lowest ground.
  double fitted_plinth(double walls, double counted) const;

  /// Storeys, roof and plinth under a tagged height. \param in_terrain  whether the height is measured from the lowest
  /// ground; else from the ground floor
  void divide_height(model::Attributes& a, bool storeys_known, bool in_terrain);

  /// A tagged height against the terrain.
  void tagged_height(model::Attributes& a, bool storeys_known);

  /// Storeys, heights, plinth and roof, which hang together.
  void heights(model::Attributes& a);

  std::string height_in_words(double plinth, const model::Attributes& a) const {
    const std::string below = plinth > 0 ? fmt::format("a plinth of {:.1f} m, ", plinth) : std::string();
    return below + fmt::format("{:g} storeys of {:.1f} m and a roof of {:.1f} m", a.storeys.value,
                               a.storey_height.value, a.roof_height.value);
  }

  template <class Pick>
  model::Sourced<model::Colour> colour(std::optional<model::Colour> tagged, std::optional<model::Colour> outline_tagged,
                                       const model::InferredCandidate<model::Colour>& seen,
                                       const model::Sourced<std::string>& material,
                                       const std::vector<model::Colour>& palette, const char* choice, bool weathers,
                                       Pick&& usual_applies);
  /// A colour of the palette. \param weathers  a roof's: most of a block are alike
  Choice<model::Colour> drawn_colour(const std::vector<model::Colour>& palette, const char* choice,
                                     bool weathers) const;

  /// How the map gives a colour.
  enum class MappedColour : std::uint8_t { none, numbers, word };
  /// What the faces have: words mean pigments, drawn roofs are weathered. Says so in the evidence of `colour`.
  model::Colour shown(model::Sourced<model::Colour>& colour, MappedColour mapped,
                      const model::Sourced<std::string>& material, bool weathers);

  model::Sourced<std::string> material(base::StringId tagged, base::StringId outline_tagged,
                                       const std::string& usual_material);

  /// Materials and colours of walls and roof.
  void surfaces(model::Attributes& a);

  model::Attributes resolve(model::Sourced<double> lowest);

  /// What follows from the other values: eaves, pitch, direction of the ridge.
  void derived(model::Attributes& a);
  std::string text(const model::Sourced<model::RoofOrientation>& orientation) const {
    return region.evidence[orientation.evidence].text;
  }

  /// Whether outputs state the direction of a ridge.
  static bool has_ridge(model::RoofShape shape);
};

}  // namespace blockrand::attributes
