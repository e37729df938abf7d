#include "pipeline/attributes/resolve.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/attributes/resolver.h"
#include "pipeline/base/random.h"

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
  storage.gable_to_street = style.gable_to_street;
  storage.wall_colours = style.wall_colours;
  storage.roof_colours = style.roof_colours;
  storage.wall_material = style.wall_material;
  // A flat roof keeps its felt whatever lies on sloped ones.
  storage.roof_material = style.roof_material;
  return storage;
}

/// The measures that a preset states. \param storage  holds them
const UseDefaults& with_preset(const Building& building, const MappedAttributes& mapped, const ResolveInputs& in,
                               const districts::Preset* preset, const UseDefaults& usual, UseDefaults& storage) {
  if (preset == nullptr || !preset->measures || usual.hall || building.style.non_house ||
      !follows_style(in.defaults, usual))
    return usual;
  const districts::PresetMeasures& m = *preset->measures;
  if (&usual != &storage) storage = usual;
  if (m.roof_pitch || m.side_pitches.any() || m.gable_to_street || !m.roof_shapes.empty())
    storage.preset = preset->name;
  if (m.storey_height || m.ground_floor_height) {
    const double upper = m.storey_height.value_or(usual.storey_height);
    const double storeys = std::max(1.0, mapped.storeys ? static_cast<double>(*mapped.storeys) : usual.storeys);
    storage.heights_preset = preset->name;
    storage.upper_storey_height = upper;
    storage.ground_floor_height = m.ground_floor_height.value_or(upper);
    storage.storey_height = (storage.ground_floor_height + (storeys - 1) * upper) / storeys;
  }
  if (m.plinth) storage.plinth = *m.plinth;
  if (m.roof_pitch) storage.roof_pitch = *m.roof_pitch;
  storage.side_pitches = m.side_pitches;
  if (m.gable_to_street) storage.gable_to_street = *m.gable_to_street;
  if (!m.roof_shapes.empty()) {
    double drawn = base::random_unit(in.seed, building.osm.key(), "preset_roof");
    storage.drawn_roof = m.roof_shapes.back().first;
    for (const auto& [shape, share] : m.roof_shapes) {
      if (drawn < share) {
        storage.drawn_roof = shape;
        break;
      }
      drawn -= share;
    }
    storage.roof_shape = *storage.drawn_roof;
  }
  return storage;
}

/// m. Lower no storey of a church or hall is where storeys are tagged.
constexpr double kLowestHallStorey = 3;

/// Eaves of halls follow the width of their plan. \param storage  holds the measures
const UseDefaults& with_hall(const UseDefaults& usual, const MappedAttributes& mapped,
                             const std::vector<model::Polygon>& plans, UseDefaults& storage) {
  if (!usual.hall || usual.eaves_per_width <= 0 || plans.empty()) return usual;
  const double eaves =
      std::clamp(usual.eaves_per_width * geometry::equivalent_width(plans[0]), usual.lowest_eaves, usual.highest_eaves);
  const double counted = mapped.storeys ? std::max(1.0, static_cast<double>(*mapped.storeys)) : usual.storeys;
  if (&usual != &storage) storage = usual;
  storage.storey_height = std::max(kLowestHallStorey, eaves / counted);
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

std::string text_of(double value) { return fmt::format("{:g}", value); }
std::string text_of(RoofShape value) { return std::string(model::name(value)); }
std::string text_of(RoofOrientation value) { return value == RoofOrientation::across ? "across" : "along"; }
std::string text_of(const Colour& value) { return model::text(value); }
std::string text_of(const std::string& value) { return value; }

Sourced<double> Resolver::storeys() {
  std::vector<Choice<double>> choices;
  if (const double below = storeys_below(own, usual.storey_height); below > 0)
    choices.push_back({below + *own.storeys, Source::implied, kImpliedConfidence,
                       fmt::format("{:g} tagged storeys above {:g} skipped ones", *own.storeys, below)});
  else if (own.storeys)
    choices.push_back({*own.storeys, Source::tag, kTagConfidence, "tagged"});
  if (outline && !own.height && outline->storeys)
    choices.push_back({*outline->storeys, Source::implied, kOutlineConfidence, "the outline's storeys"});
  if (const auto& seen = building.seen_roof.eaves; seen.confidence > 0 && is_whole())
    choices.push_back({std::max(1.0, std::floor((seen.value - usual.plinth) / usual.storey_height + 0.5)), seen.source,
                       static_cast<double>(seen.confidence),
                       fmt::format("{}, of {:g} m a storey", seen.why, usual.storey_height)});
  // A nave has one storey whatever stands around it.
  if (usual.hall)
    choices.push_back({usual.storeys, usual_source(), kGeometryConfidence, "one hall, " + usual_name()});
  else if (const auto& inferred_candidate = building.inferred.storeys; inferred_candidate.confidence > 0)
    choices.push_back({static_cast<double>(inferred_candidate.value), inferred_candidate.source,
                       static_cast<double>(inferred_candidate.confidence), inferred_candidate.why});
  else if (const auto vote = in.neighbours.storeys(place(), group, id, options.neighbour_minimum);
           vote && !is_non_house())
    choices.push_back({vote->value, Source::neighbours, 0.3 + 0.4 * vote->share,
                       fmt::format("median of {} neighbours within {:.0f} m", vote->voices, in.neighbours.reach())});
  choices.push_back({usual.storeys, usual_source(), usual_confidence(), usual_name()});
  return first(std::move(choices));
}

template <class Pick>
Sourced<Colour> Resolver::colour(std::optional<Colour> tagged, std::optional<Colour> outline_tagged,
                                 const model::InferredCandidate<Colour>& seen, const Sourced<std::string>& material,
                                 const std::vector<Colour>& palette, const char* choice, bool weathers,
                                 Pick&& usual_applies) {
  std::vector<Choice<Colour>> choices;
  if (tagged) choices.push_back({*tagged, Source::tag, kTagConfidence, "tagged"});
  if (outline_tagged) choices.push_back({*outline_tagged, Source::implied, kOutlineConfidence, "the outline's colour"});
  if (seen.confidence > 0) choices.push_back({seen.value, seen.source, static_cast<double>(seen.confidence), seen.why});
  const int index = in.defaults.material(material.value);
  if (!usual_applies() && index >= 0)
    choices.push_back({in.defaults.materials[static_cast<std::size_t>(index)].colour, Source::implied, 0.5,
                       "colour of " + material.value});
  choices.push_back(drawn_colour(palette, choice, weathers));
  return first(std::move(choices));
}

Choice<Colour> Resolver::drawn_colour(const std::vector<Colour>& palette, const char* choice, bool weathers) const {
  // All parts of a building are painted alike: the key is the building's. Roofs of a block are mostly of one clay or slate.
  std::uint64_t key = building.osm.key();
  const auto& roofs = in.defaults.pigments.drawn_roofs;
  std::string why = "drawn from the palette, ";
  if (weathers && roofs && !building.situation.block.empty() &&
      base::random_unit(in.seed, key, "roof_like_its_block") < roofs->alike) {
    key = base::hash_text(building.situation.block);
    why = "as most roofs of the block, drawn from the palette, ";
  }
  const std::uint64_t bits = base::random_bits(in.seed, key, choice);
  return {palette[bits % palette.size()], usual_source(), kDefaultConfidence, why + usual_name()};
}

Colour Resolver::shown(Sourced<Colour>& colour, MappedColour mapped, const Sourced<std::string>& material,
                       bool weathers) {
  const Pigments& pigments = in.defaults.pigments;
  const auto class_of = static_cast<std::uint8_t>(std::max(in.defaults.material(material.value), 0));
  if (mapped == MappedColour::word) {
    const Colour out = pigments.on_material(colour.value, class_of);
    if (out == colour.value) return out;
    model::Evidence why = region.evidence[colour.evidence];
    why.text += fmt::format("; a word: shown as {}, what it means on {}", model::text(out), material.value);
    colour.evidence = region.evidence.add(std::move(why));
    return out;
  }
  // What somebody measured, by numbers in a tag or in an image, is shown as it is.
  if (mapped == MappedColour::numbers || colour.source == Source::imagery) return colour.value;
  return weathers ? pigments.weathered(colour.value, base::random_bits(in.seed, building.osm.key(), "weathering"))
                  : pigments.muted(colour.value, class_of);
}

Sourced<std::string> Resolver::material(base::StringId tagged, base::StringId outline_tagged,
                                        const std::string& usual_material) {
  const auto known = [&](base::StringId value) -> int { return value == 0 ? -1 : in.defaults.material(text(value)); };
  const auto class_name = [&](int index) {
    return in.defaults.materials[static_cast<std::size_t>(index)].material_class.name;
  };
  std::vector<Choice<std::string>> choices;
  if (const int m = known(tagged); m >= 0)
    choices.push_back({class_name(m), Source::tag, kTagConfidence, "tagged " + std::string(text(tagged))});
  if (const int m = known(outline_tagged); m >= 0)
    choices.push_back({class_name(m), Source::implied, kOutlineConfidence, "the outline's material"});
  choices.push_back({usual_material, usual_source(), kDefaultConfidence, usual_name()});
  return first(std::move(choices));
}

void Resolver::surfaces(Attributes& a) {
  const base::StringId outline_wall = outline ? outline->wall_material : 0,
                       outline_roof = outline ? outline->roof_material : 0;
  a.wall_material = material(own.wall_material, outline_wall, usual.wall_material);
  const bool flat = a.roof_shape.value == RoofShape::flat;
  a.roof_material = material(own.roof_material, outline_roof, flat ? usual.flat_roof_material : usual.roof_material);
  a.wall_colour = colour(own.wall_colour, outline ? outline->wall_colour : std::nullopt, {}, a.wall_material,
                         usual.wall_colours, "wall_colour", false, [&] {
                           return a.wall_material.source != Source::tag && a.wall_material.source != Source::implied;
                         });
  a.roof_colour = colour(
      own.roof_colour, outline ? outline->roof_colour : std::nullopt, building.seen_roof.colour, a.roof_material,
      usual.roof_colours, "roof_colour", true,
      [&] { return !flat && a.roof_material.source != Source::tag && a.roof_material.source != Source::implied; });
  const auto how = [&](std::optional<Colour> MappedAttributes::*value, bool MappedAttributes::*word) {
    const MappedAttributes* m = own.*value ? &own : outline && outline->*value ? outline : nullptr;
    return !m ? MappedColour::none : m->*word ? MappedColour::word : MappedColour::numbers;
  };
  a.shown_wall_colour =
      shown(a.wall_colour, how(&MappedAttributes::wall_colour, &MappedAttributes::wall_colour_is_word), a.wall_material,
            false);
  a.shown_roof_colour =
      shown(a.roof_colour, how(&MappedAttributes::roof_colour, &MappedAttributes::roof_colour_is_word), a.roof_material,
            true);
}

Attributes Resolver::resolve(Sourced<double> lowest) {
  Attributes a;
  a.use = own.use != 0 ? make(std::string(text(own.use)), Source::tag, kTagConfidence, "tagged")
                       : make(std::string("yes"), Source::default_, kDefaultConfidence, "not tagged");
  a.ground_height = lowest;
  heights(a);
  if (own.roof_direction) a.roof_direction = make<double>(*own.roof_direction, Source::tag, kTagConfidence, "tagged");
  surfaces(a);
  derived(a);
  return a;
}

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
    UseDefaults styled, changed, hall;
    const auto number = static_cast<std::size_t>(&building - region.buildings.data());
    const districts::Preset* preset = number < in.presets.size() ? in.presets[number] : nullptr;
    const UseDefaults& of_style = with_style(building, in, small ? in.defaults.small : in.defaults.use(use), styled);
    const UseDefaults& usual = with_overrides(
        entry_of_building,
        with_hall(small ? of_style : with_preset(building, building.mapped, in, preset, of_style, styled),
                  building.mapped, building.outline, hall),
        changed);
    const std::uint8_t group = neighbour_group(in.defaults, use, area);

    std::vector<model::ReportRow> conflicts;
    const auto tell = [&conflicts](model::OsmId id, std::vector<TagConflict> told) {
      for (TagConflict& c : told) {
        model::ReportRow row{id, c.code, std::move(c.text)};
        // Pieces of one outline have the same tags.
        if (std::find(conflicts.begin(), conflicts.end(), row) == conflicts.end()) conflicts.push_back(std::move(row));
      }
    };
    Resolver whole{.region = region,
                   .in = in,
                   .options = options,
                   .building = building,
                   .part = nullptr,
                   .own = building.mapped,
                   .outline = nullptr,
                   .usual = usual,
                   .group = group,
                   .plans = building.outline,
                   .id = building.osm,
                   .ground = ground,
                   .rise = ground.rise};
    const bool one_body = building.parts.size() == 1 && !building.has_mapped_parts;
    if (!one_body) building.attributes = whole.resolve(lowest);
    for (BuildingPart& part : building.parts) {
      const auto index = static_cast<std::size_t>(&part - building.parts.data());
      const bool own_tags = building.has_mapped_parts && !part.rest;
      const std::string_view part_use = use_text(part.mapped);
      // building:part=yes says nothing; a use of its own does.
      const bool own_use = own_tags && in.defaults.uses.contains(part_use) && part_use != "yes";
      UseDefaults part_styled, part_changed, part_hall;
      const UseDefaults& part_usual =
          with_overrides(own_tags && in.overrides ? in.overrides->find(part.osm) : nullptr,
                         own_use ? with_hall(with_style(building, in, in.defaults.use(part_use), part_styled),
                                             part.mapped, {part.roof_plan}, part_hall)
                                 : usual,
                         part_changed);
      const std::vector<model::Polygon> plan{part.roof_plan};
      Resolver r{.region = region,
                 .in = in,
                 .options = options,
                 .building = building,
                 .part = &part,
                 .own = part.mapped,
                 .outline = own_tags && building.osm != part.osm ? &building.mapped : nullptr,
                 .usual = part_usual,
                 .group = group,
                 .plans = plan,
                 .id = building.osm,
                 .ground = ground,
                 .rise = index < ground.part_rise.size() ? ground.part_rise[index] : ground.rise,
                 .floor = one_body ? std::nullopt : std::optional(building.attributes.plinth_height.value)};
      part.attributes = r.resolve(lowest);
      const Source measured = part.attributes.roof_height.source;
      if (measured == Source::preset || measured == Source::default_) part.usual_pitch = r.usual_pitch_asked;
      const bool ordered = part.mapped.side_pitches.any();  // a preset's pitches are of its sloped roofs alone
      if (ordered || (r.side_pitches().any() && part.attributes.roof_shape.value != RoofShape::flat)) {
        part.side_pitches = r.side_pitches();
        part.other_sides_pitch = r.other_sides_pitch(part.attributes.roof_shape.value);
      }
      tell(part.osm, tag_conflicts(part.mapped, {part.attributes.roof_shape.value, part.roof_plan,
                                                 r.usual.storey_height, !part.roof_lines.empty(), part.roof_edges}));
      tell(part.osm, std::move(r.against_terrain));
      part.canopy = part_use == "roof" || (own_tags && part_use == "yes" && use == "roof");
    }
    const auto has_order = [&](const BuildingPart& part) { return part.mapped.side_pitches.any(); };
    if (building.mapped.side_pitches.any() && !std::ranges::any_of(building.parts, has_order))
      conflicts.push_back({building.osm, model::IssueCode::side_pitch_unread,
                           model::text(building.mapped.side_pitches) + ": its parts have the roofs"});
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
