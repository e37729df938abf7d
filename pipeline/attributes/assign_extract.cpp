#include "pipeline/attributes/assign_extract.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "importers/polygons/read_polygons.h"
#include "pipeline/attributes/resolve.h"
#include "pipeline/base/parallel.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/osm_keys.h"
#include "styles/districts/read_rule_set.h"

namespace blockrand::attributes {

namespace {

namespace districts = districts;
using districts::CellStatistic;
using districts::PlaceQuery;
using districts::RuleSets;
using model::Extract;
using model::Feature;
using model::FeatureKind;
using model::Location;
using model::Point2;

/// m. Areas of more than this along a side are pinned: a tile alone sees 3 km around it.
constexpr double kLargeArea = 2000;
constexpr double kDegreesToMetres = 1e-7 * 111'000;  // of latitude, rounded down; of longitude it is less

/// m. What a storey has of a height that alone is tagged: the mean of dwellings of all eras, roof and plinth included
/// as they are in the tag. A rule asks for a range, so that half a storey does not matter; neighbours would be a mere
/// guess.
constexpr double kHeightPerStorey = 3.0;

const std::string_view kAreaTags[] = {model::osm_key::kPreset, model::osm_key::kStyle};

AreaRings rings_of(const Extract& extract, const Feature& f) {
  AreaRings rings;
  for (const model::MappedRing& r : extract.rings_of(f.rings)) {
    const auto vertices = extract.vertices_of(r);
    rings.emplace_back(vertices.begin(), vertices.end());
    if (rings.back().size() > 1 && rings.back().front() == rings.back().back()) rings.back().pop_back();
  }
  return rings;
}

bool is_large(const AreaRings& rings) {
  std::int64_t west = INT32_MAX, south = INT32_MAX, east = INT32_MIN, north = INT32_MIN;
  for (const auto& ring : rings)
    for (const Location p : ring) {
      west = std::min<std::int64_t>(west, p.lon), east = std::max<std::int64_t>(east, p.lon);
      south = std::min<std::int64_t>(south, p.lat), north = std::max<std::int64_t>(north, p.lat);
    }
  return static_cast<double>(std::max(east - west, north - south)) * kDegreesToMetres > kLargeArea;
}

/// Nodes and stretches of lines in metres, and whether one comes near.
class NearSet {
 public:
  void add(Point2 a, Point2 b) { segments_.emplace_back(a, b); }
  void finish() {
    std::vector<geometry::PlanBox> boxes;
    for (const auto& [a, b] : segments_) {
      geometry::PlanBox box;
      box.include(a);
      box.include(b);
      boxes.push_back(box);
    }
    index_ = geometry::BoxIndex(std::move(boxes));
  }
  bool comes_within(Point2 p, double distance) const {
    if (segments_.empty()) return false;
    geometry::PlanBox at;
    at.include(p);
    for (const std::uint32_t i : index_.near(at, distance))
      if (geometry::distance_to_segment(p, segments_[i].first, segments_[i].second) <= distance) return true;
    return false;
  }
  bool empty() const { return segments_.empty(); }

 private:
  std::vector<std::pair<Point2, Point2>> segments_;
  geometry::BoxIndex index_;
};

/// What answers one question of a rule set.
struct Answers {
  AreaSet areas;
  NearSet near;
  double distance = 0;  ///< m, to `near`
};

}  // namespace

struct DistrictAssigner::Impl {
  const RuleSets& book;
  AssignInputs in;
  std::vector<std::vector<Answers>> answers;         // by rule set, by query
  std::map<std::string_view, AreaSet> tagged_areas;  // by key of kAreaTags
  std::map<std::pair<std::string_view, model::OsmId>, std::string> tag_values;
  std::map<context::CellIndex, context::CellFigures> cells;
  std::vector<const context::CellFigures*> cell_figures;  // by building; empty where no rule asks
  std::vector<PinnedArea> pins;
  std::vector<NamedPlaceQuestion> named;

  std::set<std::uint32_t> sets_here;  // that hold for a building

  Impl(const RuleSets& rules, const AssignInputs& inputs) : book(rules), in(inputs) {
    for (std::uint32_t b = 0; b < in.footprints.size(); ++b)
      if (!in.footprints[b].box.empty()) sets_here.insert(book.choose(place_of(b)));
    for (const auto& [cell, sums] : in.context.cells)
      cells.emplace(cell, context::figures_of(sums, context::covered_share(cell, in.context.coverage)));
    if (book.ask_cells()) {
      cell_figures.resize(in.footprints.size(), nullptr);
      for (std::uint32_t b = 0; b < in.footprints.size(); ++b)
        if (!in.footprints[b].box.empty())
          if (const auto found = cells.find(context::cell_of_building(in.footprints, b)); found != cells.end())
            cell_figures[b] = &found->second;
    }
    find_tagged_areas();
    for (const districts::RuleSet& set : book.sets) {
      std::vector<Answers>& of_set = answers.emplace_back();
      for (const PlaceQuery& q : set.queries) of_set.push_back(answer(set, q));
    }
    const auto before = [](const PinnedArea& a, const PinnedArea& b) {
      return std::tie(a.question, a.value, a.id) < std::tie(b.question, b.value, b.id);
    };
    std::sort(pins.begin(), pins.end(), before);
    pins.erase(std::unique(pins.begin(), pins.end()), pins.end());
  }

  Point2 project(Location p) const { return model::snap(in.projection.forward(p)); }

  bool is_named(const Feature& f, FeatureKind kind, std::string_view name) const {
    return f.is(kind) && in.extract.tag(f.tags, in.extract.strings.find(model::osm_key::kName)) == name;
  }

  /// Adds what the build of the whole pinned, and pins what is large.
  void settle(const std::string& question, std::vector<MappedArea>& areas) {
    for (const PinnedArea& p : in.pinned) {
      if (p.question != question || !p.value.empty()) continue;
      std::erase_if(areas, [&](const MappedArea& a) { return a.id == p.id; });
      areas.push_back({p.id, p.rings});
    }
    for (const MappedArea& a : areas)
      if (is_large(a.rings)) pins.push_back({question, "", a.id, a.rings});
    std::sort(areas.begin(), areas.end(), [](const MappedArea& a, const MappedArea& b) { return a.id < b.id; });
  }

  Answers answer(const districts::RuleSet& set, const PlaceQuery& q) {
    using Kind = PlaceQuery::Kind;
    Answers out;
    out.distance = q.distance;
    std::vector<MappedArea> areas;
    switch (q.kind) {
      case Kind::polygon:
        areas.push_back({{}, {q.ring}});
        break;
      case Kind::file: {
        importers::polygons::VectorChoice choice{q.layer, {}};
        for (const districts::TagTest& a : q.attributes) choice.attributes.emplace_back(a.key, a.value);
        for (importers::polygons::PolygonFeature& f : importers::polygons::read_polygons(q.file, choice))
          for (AreaRings& polygon : f.polygons) areas.push_back({{}, std::move(polygon)});
        break;
      }
      case Kind::place:
      case Kind::boundary: {
        const FeatureKind kind = q.kind == Kind::place ? FeatureKind::place : FeatureKind::boundary;
        std::vector<MappedArea> nodes;
        for (const Feature& f : in.extract.features) {
          if (!is_named(f, kind, q.name)) continue;
          AreaRings rings = rings_of(in.extract, f);
          if (f.area)
            areas.push_back({f.id, std::move(rings)});
          else if (q.distance > 0 && f.id.type == model::OsmType::node && !rings.empty())
            nodes.push_back({f.id, std::move(rings)});
        }
        const std::string node_question = q.text() + ", node";
        settle(q.text(), areas);
        for (const PinnedArea& p : in.pinned)
          if (p.question == node_question) {
            std::erase_if(nodes, [&](const MappedArea& a) { return a.id == p.id; });
            nodes.push_back({p.id, p.rings});
          }
        for (const MappedArea& n : nodes) {
          if (n.rings.empty() || n.rings.front().empty()) continue;
          const Point2 p = project(n.rings.front().front());
          out.near.add(p, p);
          if (q.distance > kLargeArea) pins.push_back({node_question, "", n.id, n.rings});
        }
        named.push_back({static_cast<std::uint32_t>(&set - book.sets.data()),
                         fmt::format("{}:{}: nothing here is '{}'{}", q.asked_in, q.line, q.name,
                                     q.kind == Kind::place && q.distance == 0
                                         ? " as a polygon; a place that is a node needs a radius"
                                         : ""),
                         !areas.empty() || !nodes.empty()});
        break;
      }
      case Kind::land_use:
        for (const Feature& f : in.extract.features) {
          if (!f.area || !f.is(FeatureKind::land_use)) continue;
          const std::string_view value = in.extract.tag(f.tags, model::osm_key::kLanduse);
          if (std::find(q.values.begin(), q.values.end(), value) != q.values.end())
            areas.push_back({f.id, rings_of(in.extract, f)});
        }
        settle(q.text(), areas);
        break;
      case Kind::near: {
        const base::StringId key = in.extract.strings.find(q.feature.key);
        for (const Feature& f : in.extract.features) {
          // What is there for the surroundings alone changes no house.
          if (f.kinds == static_cast<std::uint32_t>(FeatureKind::surrounding)) continue;
          const std::string_view value = in.extract.tag(f.tags, key);
          if (value.empty() || (!q.feature.value.empty() && value != q.feature.value)) continue;
          for (const model::MappedRing& r : in.extract.rings_of(f.rings)) {
            const auto vertices = in.extract.vertices_of(r);
            const std::size_t n = vertices.size();
            for (std::size_t i = 0; i < n; ++i) {
              if (i + 1 == n && !f.area && n > 1) break;
              out.near.add(project(vertices[i]), project(vertices[(i + 1) % n]));
            }
          }
          if (f.area) areas.push_back({f.id, rings_of(in.extract, f)});
        }
        settle(q.text(), areas);
        break;
      }
    }
    out.areas = AreaSet(std::move(areas));
    out.near.finish();
    return out;
  }

  void find_tagged_areas() {
    for (const std::string_view key : kAreaTags) {
      const base::StringId id = in.extract.strings.find(key);
      std::vector<MappedArea> areas;
      if (id != 0)
        for (const Feature& f : in.extract.features) {
          if (!f.area || !(f.is(FeatureKind::land_use) || f.is(FeatureKind::place))) continue;
          const std::string_view value = in.extract.tag(f.tags, id);
          if (value.empty()) continue;
          areas.push_back({f.id, rings_of(in.extract, f)});
          tag_values[{key, f.id}] = value;
          if (is_large(areas.back().rings))
            pins.push_back({std::string(key), std::string(value), f.id, areas.back().rings});
        }
      for (const PinnedArea& p : in.pinned)
        if (p.question == key && !p.value.empty() && tag_values.try_emplace({key, p.id}, p.value).second)
          areas.push_back({p.id, p.rings});
      std::sort(areas.begin(), areas.end(), [](const MappedArea& a, const MappedArea& b) { return a.id < b.id; });
      tagged_areas.emplace(key, AreaSet(std::move(areas)));
    }
  }

  // ---- one building

  const model::MappedBuilding& lead(std::uint32_t building) const {
    return in.extract.buildings[in.footprints[building].lead];
  }

  Location place_of(std::uint32_t building) const {
    const model::MappedBuilding& b = lead(building);
    return b.rings.count > 0 ? footprints::box_centre(in.extract, b) : b.place.value_or(Location{});
  }

  std::optional<double> storeys(std::uint32_t building, std::string_view use) const {
    const model::MappedBuilding& b = lead(building);
    if (b.attributes.storeys) return static_cast<double>(*b.attributes.storeys);
    if (b.attributes.height && *b.attributes.height > 0)
      return std::max(1.0, std::round(static_cast<double>(*b.attributes.height) / kHeightPerStorey));
    const footprints::StoredFootprint& f = in.footprints[building];
    const std::uint8_t group = neighbour_group(in.defaults, use, f.record.area);
    if (const auto vote = in.neighbours.storeys(project(place_of(building)), group, b.id, in.neighbour_minimum))
      return vote->value;
    return std::nullopt;
  }

  std::optional<double> cell_figure(std::uint32_t building, CellStatistic what) const {
    if (cell_figures.empty() || !cell_figures[building]) return std::nullopt;
    const context::CellFigures& f = *cell_figures[building];
    switch (what) {
      case CellStatistic::built_share:
        return f.built_share;
      case CellStatistic::party_wall_share:
        return f.party_wall_share;
      case CellStatistic::storeys_mean:
        return f.storeys_mean;
      case CellStatistic::density:
        return f.density;
      case CellStatistic::floor_area_ratio:
        return f.floor_area_ratio;
      case CellStatistic::footprint_median:
        return f.footprint_median;
      case CellStatistic::year_mean:
        return f.year_mean;
    }
    return std::nullopt;
  }

  bool holds(std::uint32_t set, std::uint32_t query, Location place) const {
    const Answers& a = answers[set][query];
    return a.areas.holds(place) || (!a.near.empty() && a.near.comes_within(project(place), a.distance));
  }

  /// A preset that the user ordered: stronger than any tag or rule. kNone for none that the book knows.
  std::pair<std::uint32_t, std::string> overridden_preset(std::uint32_t building) const {
    const OverrideEntry* order = in.overrides ? in.overrides->find(lead(building).id) : nullptr;
    const std::string* name = order ? order->text("preset") : nullptr;
    const std::size_t preset = name ? districts::find_preset(book.presets, *name) : districts::kNoPreset;
    if (preset == districts::kNoPreset) return {districts::Decision::kNone, ""};
    return {static_cast<std::uint32_t>(preset),
            fmt::format("{}:{}", in.overrides->name, order->values.at("preset").line)};
  }

  static void order(districts::Decision& d, std::uint32_t preset) {
    d.preset = preset;
    d.rule = districts::Decision::kNone;
    d.source = model::Source::override_;
    d.confidence = 1;
  }

  template <class Answer>
  auto ask(std::uint32_t building, model::BuildingPosition position, Answer&& answer_of) const {
    const model::MappedBuilding& b = lead(building);
    districts::Subject s;
    s.id = b.id;
    s.place = place_of(building);
    const std::uint32_t set = book.choose(s.place);
    if (building < in.styles.styles.size()) {
      s.style = &in.styles.styles[building];
      if (s.style->substyle < book.substyles.size()) s.substyle = book.substyles[s.style->substyle];
    }
    s.use = in.extract.strings.view(b.attributes.use);
    s.area = in.footprints[building].record.area;
    if (in.facts && building < in.facts->features.size())
      if (const classify::FeatureVector& f = in.facts->features[building]; f.has(classify::Feature::frontage))
        s.front = static_cast<double>(f[classify::Feature::frontage]);
    s.position = position;
    if (const std::uint32_t block = in.context.block_of[building]; block != model::kNoIndex)
      s.block = in.context.blocks[block].id;
    if (in.overrides)
      if (const OverrideEntry* order = in.overrides->find(b.id))
        for (const char* key : {"style", "substyle"})
          if (const std::string* text = order->text(key)) s.overridden_style = *text;
    s.storeys = [this, building, &s] { return storeys(building, s.use); };
    s.cell = [this, building](CellStatistic what) { return cell_figure(building, what); };
    s.tag = [this, &b](std::string_view key) { return in.extract.tag(b.tags, key); };
    s.holds = [this, set, &s](std::uint32_t query) { return holds(set, query, s.place); };
    s.area_tag = [this, &s](std::string_view key) -> std::optional<districts::Subject::AreaTag> {
      const auto areas = tagged_areas.find(key);
      const MappedArea* area = areas == tagged_areas.end() ? nullptr : areas->second.smallest(s.place);
      if (!area) return std::nullopt;
      return districts::Subject::AreaTag{tag_values.at({key, area->id}), area->id};
    };
    return answer_of(set, s);
  }
};

DistrictAssigner::DistrictAssigner(const RuleSets& book, const AssignInputs& inputs)
    : impl_(std::make_unique<Impl>(book, inputs)) {}
DistrictAssigner::~DistrictAssigner() = default;

districts::Decision DistrictAssigner::decide(std::uint32_t building, model::BuildingPosition position) const {
  districts::Decision d = impl_->ask(building, position, [&](std::uint32_t set, const districts::Subject& s) {
    return districts::decide(impl_->book, set, s, impl_->in.seed);
  });
  if (const auto [preset, place] = impl_->overridden_preset(building); preset != districts::Decision::kNone)
    Impl::order(d, preset);
  return d;
}

districts::Assignment DistrictAssigner::assign(std::uint32_t building, model::BuildingPosition position) const {
  districts::Assignment a = impl_->ask(building, position, [&](std::uint32_t set, const districts::Subject& s) {
    return districts::assign(impl_->book, set, s, impl_->in.seed);
  });
  auto [preset, place] = impl_->overridden_preset(building);
  if (preset == districts::Decision::kNone) return a;
  districts::Decision& d = a.decision;
  if (d.preset != districts::Decision::kNone && d.preset != preset)
    a.other_candidates.insert(a.other_candidates.begin(),
                              {d.source, d.confidence, impl_->book.presets[d.preset].name, std::move(a.why)});
  Impl::order(d, preset);
  a.why = std::move(place);
  return a;
}

std::vector<PinnedArea> DistrictAssigner::to_pin() const { return impl_->pins; }
std::vector<std::string> DistrictAssigner::unanswered() const {
  return attributes::unanswered(impl_->named, impl_->sets_here);
}
const std::vector<NamedPlaceQuestion>& DistrictAssigner::named_places() const { return impl_->named; }
const RuleSets& DistrictAssigner::book() const { return impl_->book; }

std::vector<std::string> unanswered(std::span<const NamedPlaceQuestion> questions,
                                    const std::set<std::uint32_t>& asked) {
  std::set<std::string> out;
  for (const NamedPlaceQuestion& q : questions)
    if (!q.found && asked.contains(q.set)) out.insert(q.unanswered);
  return {out.begin(), out.end()};
}

std::vector<const districts::Preset*> presets_with_measures(const model::Region& region,
                                                            std::span<const std::uint32_t> numbers,
                                                            const DistrictAssigner& assigner) {
  const std::vector<districts::Preset>& presets = assigner.book().presets;
  std::vector<const districts::Preset*> out;
  if (std::ranges::none_of(presets, [](const districts::Preset& p) { return p.measures.has_value(); })) return out;
  out.resize(region.buildings.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (region.buildings[i].settled != model::ObjectState::pending) continue;
    const std::uint32_t preset = assigner.decide(numbers[i], region.buildings[i].situation.position).preset;
    if (preset != districts::Decision::kNone && presets[preset].measures) out[i] = &presets[preset];
  }
  return out;
}

namespace {

/// `blockrand:preset` on a part: its front differs from the building's.
void take_tagged_preset(model::Region& region, const districts::RuleSets& book, model::BuildingPart& part) {
  const std::string_view wanted = region.extract->tag(part.tags, model::osm_key::kPreset);
  if (wanted.empty()) return;
  const auto known = std::ranges::find(book.presets, wanted, &districts::Preset::name);
  if (known == book.presets.end()) {
    region.report.add(part.osm, model::IssueCode::value_unreadable,
                      fmt::format("{}={}", model::osm_key::kPreset, wanted));
    return;
  }
  const model::Sourced<std::string>& of_building = part.attributes.preset;
  const model::EvidenceId why = region.evidence.add(
      {"tagged on the part", {{of_building.source, of_building.confidence, of_building.value, "as the building"}}});
  part.attributes.preset = {known->name, model::Source::tag, 0.95f, why};
}

}  // namespace

void assign_region(model::Region& region, std::span<const std::uint32_t> numbers, const DistrictAssigner& assigner) {
  for (std::size_t i = 0; i < region.buildings.size(); ++i) {
    model::Building& building = region.buildings[i];
    if (building.settled != model::ObjectState::pending) continue;
    districts::Assignment a = assigner.assign(numbers[i], building.situation.position);
    const districts::Decision& d = a.decision;
    const std::string name = d.preset == districts::Decision::kNone ? "" : assigner.book().presets[d.preset].name;
    for (const std::string& tag : a.unreadable)
      region.report.add(building.osm, model::IssueCode::value_unreadable, tag);
    building.preset_parameters.clear();
    for (districts::Parameter& p : a.parameters)
      building.preset_parameters.emplace_back(std::move(p.key), std::move(p.value));
    const model::EvidenceId why = region.evidence.add({std::move(a.why), std::move(a.other_candidates)});
    building.attributes.preset = {name, d.source, d.confidence, why};
    for (model::BuildingPart& part : building.parts) {
      part.attributes.preset = building.attributes.preset;
      if (part.osm != building.osm) take_tagged_preset(region, assigner.book(), part);
    }
  }
}

std::vector<districts::Decision> assign_extract(const DistrictAssigner& assigner,
                                                std::span<const model::BuildingPosition> positions, int workers,
                                                base::Progress& progress) {
  progress.begin("assign", positions.size(), "buildings");
  std::vector<districts::Decision> out(positions.size());
  constexpr std::size_t kBatch = 4096;
  const std::size_t batches = (positions.size() + kBatch - 1) / kBatch;
  base::ordered_parallel(
      batches, workers, static_cast<std::size_t>(workers) * 4 + 4,
      [&](std::size_t batch) {
        for (std::size_t i = batch * kBatch; i < std::min(positions.size(), (batch + 1) * kBatch); ++i)
          out[i] = assigner.decide(static_cast<std::uint32_t>(i), positions[i]);
      },
      [&](std::size_t batch) { progress.advance_to(std::min(positions.size(), (batch + 1) * kBatch)); });
  return out;
}

}  // namespace blockrand::attributes
