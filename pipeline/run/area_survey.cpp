#include "pipeline/run/area_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/attributes/assign_extract.h"
#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/overrides.h"
#include "pipeline/attributes/rule_sets.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/run/area_surroundings.h"
#include "pipeline/run/prepare_extract.h"
#include "pipeline/run/tile_choice.h"
#include "pipeline/surroundings/catalogue.h"

namespace blockrand::run {
namespace {

/// What one area says.
struct AreaFacts {
  std::vector<model::Location> centres;      ///< of buildings with an outline
  std::uint64_t objects = 0;                 ///< mapped objects
  std::vector<attributes::PinnedArea> pins;  ///< large areas that rules ask for
  std::vector<std::uint32_t> matched;        ///< orders: indices
  std::map<std::uint32_t, std::string> why;  ///< orders that find their object and cannot be followed
  std::set<std::uint32_t> rule_sets;         ///< that hold for a building
  std::vector<attributes::NamedPlaceQuestion> named_places;
  std::vector<model::ReportRow> rows;  ///< where there are no objects
  // As well there, where surroundings are asked for:
  std::vector<model::TileId> tiles;  ///< into which some come
  surroundings::SurroundingCounts surroundings{};
  std::vector<surroundings::SharedOutcome> shared;
};

class Surveyor {
 public:
  Surveyor(const importers::osm::ExtractStore& store, const BuildOptions& options)
      : store_(store),
        options_(options),
        defaults_(attributes::read_defaults(options.configs)),
        rules_(attributes::read_rule_sets(options.configs, options.districts)) {
    base::Packer key;
    for (const auto& [name, path] : rules_.files) key << name << base::sha256_file(path);
    key << options.districts;
    if (!options.overrides.empty()) {
      attributes::OverrideNames names{{}, rules_.book.substyles};
      for (const districts::Preset& p : rules_.book.presets) names.presets.push_back(p.name);
      overrides_ = attributes::read_overrides(options.overrides, defaults_, names);
      key << base::sha256_file(options.overrides);
    }
    if (options.surroundings.any()) {
      const std::string path = options.configs + "/surroundings.toml";
      catalogue_.emplace(path);
      key << surroundings::show_surroundings(options.surroundings) << catalogue_->sha256();
    }
    shared_ = std::move(key.bytes);
  }

  /// \param placeless  what has no place is looked at with it: orders for it match
  AreaFacts look(const importers::osm::StoredArea& area, bool placeless, const base::Memo* memo) const {
    return base::remembered<AreaFacts>(
        memo, "survey",
        [&](base::Packer& key) {
          key << area.tile << area.sha256 << shared_ << (placeless ? store_.figures().sha256 : std::string());
        },
        [&] { return look_at(area.tile, placeless); });
  }
  const attributes::Overrides& overrides() const { return overrides_; }

 private:
  AreaFacts look_at(const model::TileId& tile, bool placeless) const {
    const georef::GeoBox box = georef::bounds(tile);
    importers::osm::ReadOptions read;
    read.bbox = {box.west, box.south, box.east, box.north};
    if (catalogue_) read.surroundings = read.touching = true;
    model::Extract extract = store_.read(read, placeless);
    AreaFacts facts;
    std::set<std::uint32_t> matched;
    attributes::Overrides overrides = overrides_;
    model::Report report;
    attributes::apply_overrides(overrides, extract, report);
    for (std::uint32_t i = 0; i < overrides.entries.size(); ++i) matched.insert(i);
    for (const model::ReportRow& row : report.rows)
      for (std::uint32_t i = 0; i < overrides.entries.size(); ++i)
        if (overrides.entries[i].object == row.object) {
          matched.erase(i);
          if (std::ranges::binary_search(extract.buildings, row.object, {}, &model::MappedBuilding::id))
            facts.why[i] = row.detail;
        }
    facts.matched.assign(matched.begin(), matched.end());
    for (const model::MappedBuilding& b : extract.buildings) {
      const std::optional<model::Location> place =
          b.rings.count > 0 ? std::optional(footprints::box_centre(extract, b)) : b.place;
      if (!place || georef::tile_of(*place, tile.level) != tile) continue;
      ++facts.objects;
      if (b.rings.count > 0 && b.state == model::ObjectState::pending) facts.centres.push_back(*place);
    }
    if (facts.objects == 0) {
      TileChoice area;
      area.id = tile;
      facts.rows = std::move(extract.report.rows);
      forget_others(
          extract, area, [](const model::MappedBuilding&) { return false; }, facts.rows);
      if (catalogue_) look_around(extract, tile, placeless, facts);
    }
    // Which areas are large enough does not depend on the projection: any that fits will do.
    const georef::LonLat middle = box.centre();
    const georef::Crs crs = georef::open_crs(georef::choose_crs(middle.lon, middle.lat), box);
    const georef::Projection projection(crs, box);
    const footprints::FootprintStore no_footprints;
    const context::ContextExtract no_context;
    const evidence::StyleExtract no_styles;
    const context::TaggedNeighbours no_neighbours({}, options_.generate.neighbour_reach);
    const attributes::DistrictAssigner assigner(rules_.book, {.extract = extract,
                                                              .footprints = no_footprints,
                                                              .context = no_context,
                                                              .styles = no_styles,
                                                              .projection = projection,
                                                              .defaults = defaults_,
                                                              .neighbours = no_neighbours,
                                                              .neighbour_minimum = options_.generate.neighbour_minimum,
                                                              .overrides = &overrides_,
                                                              .pinned = {},
                                                              .seed = options_.seed});
    facts.pins = assigner.to_pin();
    for (const model::Location centre : facts.centres) facts.rule_sets.insert(rules_.book.choose(centre));
    facts.named_places = assigner.named_places();
    return facts;
  }

  void look_around(const model::Extract& extract, const model::TileId& tile, bool placeless, AreaFacts& facts) const {
    for (const model::TileId& t :
         tiles_with_surroundings(extract, tiles_in(georef::bounds(tile), footprints::kTileLevel)))
      if (georef::contains(tile, t)) facts.tiles.push_back(t);
    surroundings::SurroundingAccount account;
    const auto thing_of = thing_recorder(extract, *catalogue_, options_.surroundings, tile);
    std::vector<RecordedThing> things;
    for (const model::Feature& feature : extract.features)
      if (const std::optional<RecordedThing> thing = thing_of(feature);
          thing && begins_in(extract, feature, tile, placeless))
        things.push_back(*thing);
    facts.shared = close_surroundings(things, account);
    facts.surroundings = account.counts();
  }

  const importers::osm::ExtractStore& store_;
  const BuildOptions& options_;
  std::optional<surroundings::Catalogue> catalogue_;  ///< where surroundings are asked for
  attributes::Defaults defaults_;
  attributes::ReadRuleSets rules_;
  attributes::Overrides overrides_;
  std::string shared_;
};

std::vector<model::Point2> projected(std::span<const model::Location> centres, const georef::Projection& projection) {
  std::vector<model::Point2> places;
  for (const model::Location centre : centres) {
    const model::Point2 p = projection.forward(centre);
    if (std::isfinite(p.x) && std::isfinite(p.y)) places.push_back(model::snap(p));
  }
  return places;
}

}  // namespace

std::vector<importers::osm::StoredArea> areas_of(const importers::osm::ExtractStore& store, int level,
                                                 std::uint64_t most) {
  std::vector<importers::osm::StoredArea> out;
  std::vector<model::TileId> cut;  // those of the level before
  for (int finer = level; finer == level || !cut.empty(); ++finer) {
    std::vector<model::TileId> here;
    for (importers::osm::StoredArea& area : store.areas(finer)) {
      if (finer > level &&
          std::ranges::none_of(cut, [&](const model::TileId& t) { return georef::contains(t, area.tile); }))
        continue;
      const georef::GeoBox window = georef::with_halo(area.tile, kHalo);
      if (finer < kFinestAreas && store.part({window.west, window.south, window.east, window.north}).bytes > most)
        here.push_back(area.tile);
      else
        out.push_back(std::move(area));
    }
    cut = std::move(here);
  }
  return out;
}

RegionSurvey survey_region(const importers::osm::ExtractStore& store, const BuildOptions& options,
                           base::Progress& progress, const base::Memo* memo) {
  const Surveyor surveyor(store, options);
  RegionSurvey survey;
  std::vector<model::Location> centres;
  std::set<std::uint32_t> matched, rule_sets;
  std::map<std::uint32_t, std::string> why;
  std::vector<attributes::NamedPlaceQuestion> named_places;
  std::map<std::tuple<std::string, std::string, model::OsmId>, attributes::PinnedArea> pins;
  // Of areas without buildings, until it is known where there are some.
  std::map<model::TileId, AreaFacts> empty;
  const std::vector<importers::osm::StoredArea> areas = areas_of(store, options.areas);
  for (const importers::osm::StoredArea& area : areas) {
    AreaFacts facts = surveyor.look(area, &area == areas.data() && store.has_placeless(), memo);
    if (facts.objects > 0) survey.objects[area.tile] = facts.objects;
    centres.insert(centres.end(), facts.centres.begin(), facts.centres.end());
    matched.insert(facts.matched.begin(), facts.matched.end());
    why.merge(facts.why);
    rule_sets.insert(facts.rule_sets.begin(), facts.rule_sets.end());
    if (named_places.empty())
      named_places = std::move(facts.named_places);
    else
      for (std::size_t i = 0; i < named_places.size(); ++i)
        named_places[i].found = named_places[i].found || facts.named_places[i].found;
    for (attributes::PinnedArea& pin : facts.pins) pins.try_emplace({pin.question, pin.value, pin.id}, std::move(pin));
    if (facts.objects == 0 && options.surroundings.any()) {
      AreaFacts& kept = empty[area.tile];
      kept.tiles = std::move(facts.tiles), kept.surroundings = facts.surroundings,
      kept.shared = std::move(facts.shared);
      kept.rows = std::move(facts.rows);
    } else {
      survey.rows.insert(survey.rows.end(), facts.rows.begin(), facts.rows.end());
    }
  }
  survey.unanswered = attributes::unanswered(named_places, rule_sets);
  for (auto& [what, pin] : pins) survey.facts.areas.push_back(std::move(pin));
  const attributes::Overrides& orders = surveyor.overrides();
  for (std::uint32_t i = 0; i < orders.entries.size(); ++i)
    if (!matched.contains(i))
      survey.unmatched.push_back(why.contains(i) ? orders.entries[i].object.text() + ", " + why[i]
                                                 : fmt::format("{}:{}: {}", orders.name, orders.entries[i].line,
                                                               orders.entries[i].object.text()));
  const std::optional<footprints::Area> area = footprints::area_of(centres);
  survey.has_outlines = area.has_value();
  if (area) survey.facts.box = area->box, survey.facts.centre = area->centre;
  const TileRange region = tiles_in(survey.facts.box, footprints::kTileLevel);
  for (auto& [tile, facts] : empty) {
    if (area && std::ranges::any_of(facts.tiles, [&](const model::TileId& t) { return region.holds(t); })) {
      survey.only_surroundings.insert(tile);  // it is built, and tells its rows itself
      continue;
    }
    survey.rows.insert(survey.rows.end(), facts.rows.begin(), facts.rows.end());
    for (std::size_t k = 0; k < survey.surroundings.size(); ++k)
      for (std::size_t s = 0; s < survey.surroundings[k].size(); ++s)
        survey.surroundings[k][s] += facts.surroundings[k][s];
    survey.shared_surroundings.insert(survey.shared_surroundings.end(), facts.shared.begin(), facts.shared.end());
  }
  survey.facts.crs =
      options.crs.empty() || !area ? georef::choose_crs(survey.facts.centre.lon, survey.facts.centre.lat) : options.crs;
  const georef::Crs crs = georef::open_crs(survey.facts.crs, survey.facts.box);
  survey.facts.coverage = context::coverage_of(projected(centres, georef::Projection(crs, survey.facts.box)));
  if (!area) progress.warn(told_input(options) + ": no building with an outline; the outputs are valid but empty");
  return survey;
}

}  // namespace blockrand::run
