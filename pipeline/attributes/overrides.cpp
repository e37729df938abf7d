#include "pipeline/attributes/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/attributes/override_values.h"
#include "pipeline/attributes/resolve.h"
#include "pipeline/attributes/tag_conflicts.h"

namespace blockrand::attributes {

namespace {

using model::MappedAttributes;
using model::OsmId;
using model::Sourced;

// ---- as tags

/// The orders in the place of the tags.
void give(const OverrideEntry& e, MappedAttributes& m, base::StringPool& strings) {
  const auto number = [&](const char* key, std::optional<float>& to) {
    const double* v = e.number(key);
    if (v) to = static_cast<float>(*v);
    return v != nullptr;
  };
  const auto word = [&](const char* key, base::StringId& to) {
    if (const std::string* v = e.text(key)) to = strings.intern(*v);
  };
  const auto take = [&]<class T>(const char* key, std::optional<T>& to) {
    const auto found = e.values.find(key);
    if (found == e.values.end()) return false;
    to = std::get<T>(found->second.value);
    return true;
  };
  number("storeys", m.storeys);
  number("roof_storeys", m.roof_storeys);
  const bool height = number("height", m.height);
  if (number("min_height", m.min_height)) m.min_storey.reset();
  if (e.number("storey_height") && !height) m.height.reset();
  // Of measures and directions of the roof the ordered one alone is left.
  const bool sloped = (e.number("roof_height") && *e.number("roof_height") > 0) ||
                      (e.number("roof_pitch") && *e.number("roof_pitch") > 0);
  if (sloped && m.roof_shape == model::RoofShape::flat) m.roof_shape.reset();
  if (number("roof_height", m.roof_height)) m.roof_angle.reset();
  if (number("roof_pitch", m.roof_angle)) {
    m.roof_height.reset();
    if (!e.number("roof_storeys")) m.roof_storeys.reset();
  }
  if (e.side_pitches.any()) {
    // Whoever orders pitches wants their roof: its height follows.
    m.side_pitches = e.side_pitches;
    if (m.roof_shape == model::RoofShape::flat) m.roof_shape.reset();
    if (!e.number("roof_height")) m.roof_height.reset();
    if (!e.number("roof_storeys")) m.roof_storeys.reset();
  }
  if (take("roof_shape", m.roof_shape) && *m.roof_shape == model::RoofShape::flat) {
    m.roof_height.reset();
    m.roof_angle.reset();
    if (!e.number("roof_storeys")) m.roof_storeys.reset();
  }
  if (take("roof_orientation", m.roof_orientation)) m.roof_direction.reset();
  if (number("roof_direction", m.roof_direction)) m.roof_orientation.reset();
  if (const double* ridge = e.number("ridge_direction")) {
    m.roof_direction = static_cast<float>(std::fmod(*ridge + 90, 360));
    m.roof_orientation.reset();
  }
  if (const double* eaves = e.number("eaves_height")) {
    if (height) {
      m.roof_height = static_cast<float>(*e.number("height") - *eaves);
      m.roof_angle.reset();
    } else {
      m.height = static_cast<float>(*eaves + *e.number("roof_height"));
    }
  }
  if (take("wall_colour", m.wall_colour)) m.wall_colour_is_word = false;
  if (take("roof_colour", m.roof_colour)) m.roof_colour_is_word = false;
  word("wall_material", m.wall_material);
  word("roof_material", m.roof_material);
  word("use", m.use);
  if (const std::string* date = e.text("construction_date")) m.built = model::ConstructionDate{*parse_years(*date), 1};
}

/// Takes away the tags that leave no sound heights beside what is ordered. \return  one sentence for each
std::vector<std::string> drop_contradicted(const OverrideEntry& e, MappedAttributes& m) {
  std::vector<std::string> told;
  const auto overridden = [&](const char* key) { return e.number(key) != nullptr; };
  const bool height = overridden("height") || overridden("eaves_height"), under = overridden("min_height"),
             storeys = overridden("storeys");
  const bool roof = overridden("roof_height") || overridden("roof_pitch") || overridden("eaves_height") ||
                    e.values.contains("roof_shape");
  const auto drop = [&](std::optional<float>& value, const char* tag, const std::string& why) {
    told.push_back(fmt::format("{}={:g} is left aside: {}", tag, *value, why));
    value.reset();
  };
  const auto drop_height = [&](const std::string& why) { drop(m.height, "height", why); };
  if (m.height && m.min_height && *m.min_height >= *m.height && height != under) {
    if (under)
      drop_height(fmt::format("the ordered underside lies at {:g} m", *m.min_height));
    else
      drop(m.min_height, "min_height", fmt::format("the ordered height is {:g} m", *m.height));
  }
  if (m.height && m.roof_height && !(height && roof)) {
    const double under_roof = static_cast<double>(*m.height) - m.min_height.value_or(0) - *m.roof_height;
    const MappedAttributes& before = e.tagged;
    const bool was_all_roof =
        before.height && before.roof_height &&
        static_cast<double>(*before.height) - before.min_height.value_or(0) - *before.roof_height < kLowStorey;
    if (height || under ? under_roof < (was_all_roof ? 0 : kLowStorey) : roof && under_roof < 0) {
      const std::string why = fmt::format("it leaves {:.2f} m below a roof of {:g} m", under_roof, *m.roof_height);
      if (!roof)
        drop(m.roof_height, "roof:height", why);
      else if (!height)
        drop_height(why);
    }
  }
  if (m.height && m.storeys && *m.storeys > 0 && (height || storeys || roof)) {
    const auto each = [&] { return inhabited(*m.height, m.roof_height.value_or(0)) / static_cast<double>(*m.storeys); };
    const auto sound = [&] {
      const bool known = m.roof_height || m.roof_shape == model::RoofShape::flat;
      return each() >= kLowStorey && (each() <= kHighStorey || !known);
    };
    if (!sound() && m.roof_height && !roof)
      if (const float tagged = *m.roof_height; inhabited(*m.height, 0) / static_cast<double>(*m.storeys) >= kLowStorey)
        drop(m.roof_height, "roof:height",
             fmt::format("{:g} storeys under a roof of {:g} m would be {:.2f} m high", *m.storeys, tagged, each()));
    if (!sound()) {
      const std::string why = fmt::format("storeys would be {:.2f} m high", each());
      if (!height)
        drop_height(why);
      else if (!storeys)
        drop(m.storeys, "building:levels", why);
    }
  }
  return told;
}

// ---- afterwards

std::string text_of(double v) { return fmt::format("{:g}", v); }
std::string text_of(const std::string& v) { return v; }
std::string text_of(model::RoofShape v) { return std::string(model::name(v)); }
std::string text_of(model::RoofOrientation v) { return v == model::RoofOrientation::across ? "across" : "along"; }
std::string text_of(model::Colour v) { return model::text(v); }

/// What the tags said of an attribute.
std::optional<std::string> tagged_text(const MappedAttributes& m, std::string_view attribute,
                                       const base::StringPool& strings) {
  const auto as_text = []<class T>(const std::optional<T>& v) -> std::optional<std::string> {
    if (!v) return std::nullopt;
    if constexpr (std::is_same_v<T, float>)
      return text_of(static_cast<double>(*v));
    else
      return text_of(*v);
  };
  const auto word = [&](base::StringId id) {
    return id == 0 ? std::nullopt : std::optional(std::string(strings.view(id)));
  };
  if (attribute == "storeys") return as_text(m.storeys);
  if (attribute == "height") return as_text(m.height);
  if (attribute == "min_height") return as_text(m.min_height);
  if (attribute == "roof_storeys") return as_text(m.roof_storeys);
  if (attribute == "roof_height") return as_text(m.roof_height);
  if (attribute == "roof_pitch") return as_text(m.roof_angle);
  if (attribute == "roof_direction") return as_text(m.roof_direction);
  if (attribute == "roof_shape") return as_text(m.roof_shape);
  if (attribute == "roof_orientation") return as_text(m.roof_orientation);
  if (attribute == "wall_colour") return as_text(m.wall_colour);
  if (attribute == "roof_colour") return as_text(m.roof_colour);
  if (attribute == "wall_material") return word(m.wall_material);
  if (attribute == "roof_material") return word(m.roof_material);
  if (attribute == "use") return word(m.use);
  if (attribute == "construction_date" && m.built)
    return m.built->years.from == m.built->years.to ? std::to_string(m.built->years.from)
                                                    : fmt::format("{}..{}", m.built->years.from, m.built->years.to);
  return std::nullopt;
}

/// Attributes that nothing of this stage is computed from: they become what is ordered, whatever was found.
bool stands_alone(std::string_view attribute) {
  constexpr std::string_view kAlone[] = {"ground_floor_use", "construction_date", "era", "style", "substyle",
                                         "preset",           "ridge_direction"};
  return std::find(std::begin(kAlone), std::end(kAlone), attribute) != std::end(kAlone);
}

/// Attributes that a building's parts have from the building, not for themselves.
bool is_shared(std::string_view attribute) {
  constexpr std::string_view kShared[] = {"preset",           "style", "substyle", "era", "ground_floor_use",
                                          "construction_date"};
  return std::find(std::begin(kShared), std::end(kShared), attribute) != std::end(kShared);
}

bool same(double a, double b) { return std::fabs(a - b) < 1e-3; }
template <class T>
bool same(const T& a, const T& b) {
  return a == b;
}

/// Puts what is ordered into one body's attributes.
class Marker {
 public:
  Marker(model::Region& region, const Overrides& all, const classify::Catalogue* catalogue)
      : region_(region), all_(all), catalogue_(catalogue) {}

  /// \param mapped  the body's tags as they are now, orders among them
  void own(const OverrideEntry& entry, const MappedAttributes& mapped, model::Attributes& attributes) {
    if (entry.values.contains("ridge_direction") && !attributes.ridge_direction) attributes.ridge_direction.emplace();
    if (entry.values.contains("roof_direction") && !attributes.roof_direction) attributes.roof_direction.emplace();
    for (const std::string& why : entry.conflicts) tell(entry.object, entry.line, why);
    each(attributes, [&](std::string_view attribute, auto& sourced) {
      if (const auto order = entry.values.find(std::string(attribute)); order != entry.values.end())
        put(entry, attribute, order->second, sourced);
      else if (sourced.source == model::Source::tag && !is_tagged(entry.tagged, mapped, attribute))
        not_tagged(sourced);
    });
    style({&entry}, entry.object, attributes);
    constexpr const char* kHeights[] = {"height",     "storeys",      "min_height",    "roof_height",
                                        "roof_pitch", "eaves_height", "storey_height", "roof_shape"};
    const double storey = attributes.storey_height.value;
    if ((storey < kLowStorey || storey > kHighStorey) && attributes.storeys.value > 0 &&
        std::any_of(std::begin(kHeights), std::end(kHeights),
                    [&](const char* key) { return entry.values.contains(key); }))
      tell(entry.object, entry.line, fmt::format("storeys become {:.2f} m high", storey));
  }

  /// What is ordered for the building holds for a part, where nothing is ordered for the part itself.
  void from_building(const OverrideEntry& building, const OverrideEntry* part, model::Attributes& attributes) {
    const auto by_part = [&](std::string_view key) { return part && part->values.contains(std::string(key)); };
    std::vector<const OverrideEntry*> applicable = {part};
    each(attributes, [&](std::string_view attribute, auto& sourced) {
      if (!is_shared(attribute) || by_part(attribute)) return;
      // A part with a style of its own has no sub-style of the building's.
      if ((attribute == "style" || attribute == "substyle" || attribute == "era") &&
          (by_part("style") || by_part("substyle")))
        return;
      if (const auto order = building.values.find(std::string(attribute)); order != building.values.end())
        put(building, attribute, order->second, sourced);
    });
    if (!by_part("style") && !by_part("substyle")) applicable.push_back(&building);
    std::erase(applicable, nullptr);
    style(applicable, building.object, attributes);
  }

  void tell(OsmId object, int line, const std::string& why, model::IssueCode code = model::IssueCode::values_conflict) {
    model::ReportRow row{object, code, fmt::format("{}:{}: {}", all_.name, line, why)};
    if (std::find(told_.begin(), told_.end(), row) != told_.end()) return;
    told_.push_back(row);
    region_.report.add(row.object, row.code, row.detail);
  }

 private:
  template <class Visit>
  void each(model::Attributes& attributes, Visit&& visit) {
    model::for_each_attribute(
        attributes, [&](std::string_view attribute, std::string_view, auto& sourced) { visit(attribute, sourced); },
        [](std::string_view, std::string_view) {});
  }

  template <class T>
  void put(const OverrideEntry& entry, std::string_view attribute, const OverrideValue& order, Sourced<T>& sourced) {
    const T& wanted = std::get<T>(order.value);
    const model::Evidence found = region_.evidence[sourced.evidence];
    const std::string place = fmt::format("{}:{}", all_.name, order.line);
    model::Evidence evidence{place, {}};
    if (const auto tagged = tagged_text(entry.tagged, attribute, region_.extract->strings);
        tagged && *tagged != text_of(wanted))
      evidence.other_candidates.push_back({model::Source::tag, 0.95f, *tagged, "tagged"});
    const bool met = same(sourced.value, wanted);
    if (!met && !stands_alone(attribute)) {
      // It could not be met: the value is that of what was stronger.
      evidence.text = found.text;
      evidence.other_candidates.insert(evidence.other_candidates.begin(),
                                       {model::Source::override_, 1, text_of(wanted), place});
      evidence.other_candidates.insert(evidence.other_candidates.end(), found.other_candidates.begin(),
                                       found.other_candidates.end());
      if (sourced.source == model::Source::tag) sourced.source = model::Source::implied;
      sourced.evidence = region_.evidence.add(std::move(evidence));
      tell(entry.object, order.line,
           fmt::format("{} = {} cannot be met: it becomes {} ({})", attribute, text_of(wanted), text_of(sourced.value),
                       found.text));
      return;
    }
    if (!met) {
      const std::string was = text_of(sourced.value);
      if (!was.empty() && sourced.evidence != 0)
        evidence.other_candidates.push_back({sourced.source, sourced.confidence, was, found.text});
      sourced.value = wanted;
    }
    // Where it acted as a tag, what else was considered lost against it.
    evidence.other_candidates.insert(evidence.other_candidates.end(), found.other_candidates.begin(),
                                     found.other_candidates.end());
    sourced.source = model::Source::override_;
    sourced.confidence = 1;
    sourced.evidence = region_.evidence.add(std::move(evidence));
  }

  /// Whether a value that says it was tagged was, before the orders took the place of tags.
  bool is_tagged(const MappedAttributes& before, const MappedAttributes& now, std::string_view attribute) const {
    const auto kept = [&](std::string_view key) {
      return tagged_text(before, key, region_.extract->strings) == tagged_text(now, key, region_.extract->strings);
    };
    if (tagged_text(before, attribute, region_.extract->strings) && kept(attribute)) return true;
    const auto all_kept = [&](std::initializer_list<std::string_view> keys) {
      return std::all_of(keys.begin(), keys.end(), kept);
    };
    if (attribute == "ridge_direction" || attribute == "roof_orientation" || attribute == "roof_direction")
      return all_kept({"roof_orientation", "roof_direction"});
    if (attribute == "roof_pitch" || attribute == "roof_height" || attribute == "roof_shape")
      return all_kept({"roof_height", "roof_pitch", "roof_shape", "roof_storeys"});
    if (attribute == "eaves_height" || attribute == "height" || attribute == "storey_height" || attribute == "storeys")
      return all_kept({"height", "storeys", "roof_height", "roof_pitch", "roof_shape", "roof_storeys"});
    return kept(attribute);
  }

  template <class T>
  void not_tagged(Sourced<T>& sourced) {
    model::Evidence evidence = region_.evidence[sourced.evidence];
    evidence.text = evidence.text.empty() || evidence.text == "tagged" ? "follows from what is ordered in " + all_.name
                                                                       : evidence.text + ", as ordered in " + all_.name;
    sourced.source = model::Source::implied;
    sourced.evidence = region_.evidence.add(std::move(evidence));
  }

  static model::Era era_at(std::string_view name) {
    const auto found = std::find(model::kEraNames.begin(), model::kEraNames.end(), name);
    return found == model::kEraNames.end() ? model::Era{} : static_cast<model::Era>(found - model::kEraNames.begin());
  }

  /// What follows from an ordered sub-style or class: the other one, and the era. \param orders  strongest first
  void style(const std::vector<const OverrideEntry*>& applicable, OsmId object, model::Attributes& a) {
    if (!catalogue_) return;
    const auto order = [&](const char* key) -> const OverrideValue* {
      for (const OverrideEntry* e : applicable)
        if (const auto found = e->values.find(key); found != e->values.end()) return &found->second;
      return nullptr;
    };
    const auto follow = [&](Sourced<std::string>& to, std::string value, model::Source source, float confidence,
                            std::string why) {
      if (to.value == value) return;
      model::Evidence evidence{std::move(why), {}};
      if (to.evidence != 0)
        evidence.other_candidates.push_back({to.source, to.confidence, to.value, region_.evidence[to.evidence].text});
      to = {std::move(value), source, confidence, region_.evidence.add(std::move(evidence))};
    };
    const OverrideValue *by_substyle = order("substyle"), *by_style = order("style"), *by_era = order("era");
    if (by_substyle) {
      const classify::Style* s = catalogue_->find(a.substyle.value);
      if (!s) return;
      const std::string why = fmt::format("{}:{}: of the ordered sub-style {}", all_.name, by_substyle->line, s->id);
      const std::string of_class(model::name(s->style_class));
      if (!by_style)
        follow(a.style, of_class, model::Source::implied, 0.95f, why);
      else if (a.style.value != of_class)
        tell(object, by_style->line,
             fmt::format("style = {}, but the ordered sub-style {} is {}", a.style.value, s->id, of_class));
      const model::Era first = model::era_of(s->years.from), last = model::era_of(s->years.to),
                       now = era_at(a.era.value);
      if (by_era) {
        if (now < first || now > last)
          tell(object, by_era->line,
               fmt::format("era = {}, when the ordered sub-style {} was not built", a.era.value, s->id));
      } else if (a.era.value == "unknown" || now < first || now > last) {
        follow(a.era, std::string(model::name(now > last ? last : first)), model::Source::implied, 0.95f, why);
      }
      if (!order("construction_date") && a.construction_date.source != model::Source::tag)
        follow(a.construction_date, fmt::format("{}..{}", s->years.from, std::min<int>(s->years.to, 2030)),
               model::Source::implied, 0.8f, why);
    } else if (by_style) {
      const classify::Style* s = catalogue_->find(a.substyle.value);
      if (s && model::name(s->style_class) == a.style.value) return;
      const model::Era era = era_at(a.era.value);
      const classify::Style* fits = nullptr;
      for (const classify::Style& c : catalogue_->styles()) {
        if (model::name(c.style_class) != a.style.value) continue;
        const bool in_era = model::era_of(c.years.from) <= era && era <= model::era_of(c.years.to);
        if (!fits || in_era) fits = &c;
        if (in_era) break;
      }
      if (fits)
        follow(a.substyle, fits->id, model::Source::override_, 0.5f,
               fmt::format("{}:{}: the first of the ordered class {} that fits the era", all_.name, by_style->line,
                           a.style.value));
    }
  }

  model::Region& region_;
  const Overrides& all_;
  const classify::Catalogue* catalogue_;
  std::vector<model::ReportRow> told_;
};

/// Whether a building has the storey or the edge that an order is for.
bool is_there(const model::DetailOverride& d, const model::Building& building, const model::Attributes& attributes) {
  if (d.kind == model::DetailKind::storey)
    return std::stoi(d.name) < std::ceil(attributes.storeys.value + attributes.roof_storeys.value);
  if (d.kind != model::DetailKind::edge) return true;
  return std::any_of(building.edges.begin(), building.edges.end(), [&](const model::WallSegment& e) {
    // Ends that repair made have no node to go by; their names are the exporter's.
    if (e.from_node == 0 || e.to_node == 0) return true;
    const std::string id = fmt::format("e{}_{}", e.from_node, e.to_node);
    return d.name == id || d.name.starts_with(id + "~");
  });
}

}  // namespace

namespace {

/// An entry that only keeps the buildings of a mapped area where they are.
bool keeps_area(const OverrideEntry& entry, const model::Extract& extract) {
  if (!entry.keeps_place || entry.model || !entry.values.empty() || entry.side_pitches.any() || !entry.details.empty())
    return false;
  const auto found = std::lower_bound(extract.features.begin(), extract.features.end(), entry.object,
                                      [](const model::Feature& f, OsmId id) { return f.id < id; });
  return found != extract.features.end() && found->id == entry.object && found->area;
}

}  // namespace

void apply_overrides(Overrides& overrides, model::Extract& extract, model::Report& report) {
  for (OverrideEntry& entry : overrides.entries) {
    const auto tell = [&](const std::string& why) {
      report.add(entry.object, model::IssueCode::override_unmatched,
                 fmt::format("{}:{}: {}", overrides.name, entry.line, why));
    };
    const auto found = std::lower_bound(extract.buildings.begin(), extract.buildings.end(), entry.object,
                                        [](const model::MappedBuilding& b, OsmId id) { return b.id < id; });
    if (found == extract.buildings.end() || found->id != entry.object) {
      if (!keeps_area(entry, extract)) tell("no building or part with this id");
    } else if (found->state == model::ObjectState::duplicate) {
      tell("it is a duplicate of " + found->related.text());
    } else if (found->state == model::ObjectState::reported) {
      tell("it is not built: " + std::string(model::info(found->code).text));
    } else if (entry.is_part() && found->kind != model::ObjectKind::building_part) {
      tell("it is a building, no part of one");
    } else {
      entry.tagged = found->attributes;
      give(entry, found->attributes, extract.strings);
      entry.conflicts = drop_contradicted(entry, found->attributes);
    }
  }
}

const UseDefaults& with_overrides(const OverrideEntry* entry, const UseDefaults& usual, UseDefaults& storage) {
  const double* height = entry ? entry->number("storey_height") : nullptr;
  const double* plinth = entry ? entry->number("plinth_height") : nullptr;
  if (!height && !plinth) return usual;
  storage = usual;
  if (height) storage.storey_height = *height, storage.heights_preset.clear();  // whatever a preset states
  if (plinth) storage.plinth = 0;  // the ordered one is the ground floor's level (override_ground)
  return storage;
}

void override_ground(const OverrideEntry* entry, context::BuildingGround& ground) {
  if (!entry) return;
  if (const double* lowest = entry->number("ground_height")) ground.lowest = {*lowest, model::Source::override_, 1, 0};
  if (const double* plinth = entry->number("plinth_height")) {
    ground.entrance = *plinth;
    ground.entrance_reason = "as ordered";
  }
}

void mark_overrides(model::Region& region, const Overrides& overrides, const classify::Catalogue* catalogue) {
  if (overrides.entries.empty()) return;
  Marker marker(region, overrides, catalogue);
  const auto misplaced = [&](const OverrideEntry& entry, const std::string& what) {
    marker.tell(entry.object, entry.line, what + "; the order holds all the same",
                model::IssueCode::override_unmatched);
  };
  for (model::Building& building : region.buildings) {
    const auto take = [&](const OverrideEntry& entry, const model::Attributes& attributes) {
      for (const model::DetailOverride& d : entry.details) {
        building.detail_overrides.push_back(d);
        if (!is_there(d, building, attributes))
          region.report.add(entry.object, model::IssueCode::override_unmatched,
                            fmt::format("{}: there is no {} {}", d.from, model::name(d.kind), d.name));
      }
    };
    const OverrideEntry* whole = overrides.find(building.osm);
    if (whole) {
      marker.own(*whole, building.mapped, building.attributes);
      take(*whole, building.attributes);
      if (whole->is_part())
        misplaced(*whole, fmt::format("it is no part of {}: write [{}]", whole->building.text(), whole->object.text()));
    }
    for (model::BuildingPart& part : building.parts) {
      if (part.osm == building.osm) {
        // What the parts leave of the outline, or the building itself.
        if (whole) marker.own(*whole, part.mapped, part.attributes);
        continue;
      }
      const OverrideEntry* own = overrides.find(part.osm);
      if (own) {
        const bool first = &part == &*std::find_if(building.parts.begin(), building.parts.end(),
                                                   [&](const model::BuildingPart& p) { return p.osm == part.osm; });
        marker.own(*own, part.mapped, part.attributes);
        if (first) take(*own, part.attributes);
        if (own->building != building.osm)
          misplaced(*own, fmt::format("it is a part of {}: write [{}.{}]", building.osm.text(), building.osm.text(),
                                      part.osm.text()));
      }
      if (whole) marker.from_building(*whole, own, part.attributes);
    }
  }
}

}  // namespace blockrand::attributes
