// Everything that classification measures of the buildings of an extract, what their mappers noted, and, with weights,
// what classification makes of it with and without that: the tables that fit.py and evaluate.py read.
//
//   facts_table EXTRACT CONFIGS OUT.csv           features and tags; needs no weights
//   facts_table EXTRACT CONFIGS OUT.csv answers   and what is answered; with `quick` behind it without hiding by tenths
//   facts_table EXTRACT CONFIGS OUT.csv conditions   and what is answered under the three conditions of cities.py
//
// Conditions, each of which hides storeys, roofs and dates (with building:architecture) together:
//   hidden   those of all buildings
//   tenths   those of a tenth of the buildings at a time (by a hash of the id), which is asked then
//   quarter  those of all buildings within 500 m of seeded points, which stand 1.5 km apart; the rest stays visible
//
// Hiding: a tenth of the buildings at a time (by a hash of the id) loses its tag, and is asked then; `_alone` columns
// are answers where every tag of the kind is hidden.
#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>

#include "importers/osm/read_extract.h"
#include "pipeline/attributes/rule_sets.h"
#include "pipeline/base/random.h"
#include "pipeline/context/blocks.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/evidence/building_facts.h"
#include "pipeline/evidence/classify_extract.h"
#include "pipeline/evidence/region_priors.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/load.h"
#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/run/prepare_extract.h"

using namespace blockrand;

namespace {

using classify::Feature;

constexpr int kParts = 10;  ///< of the tags, hidden one after the other
constexpr int kWorkers = 2;

int part_of(model::OsmId id) {
  std::uint64_t h = id.number * 4u + static_cast<std::uint64_t>(id.type);
  h = (h ^ (h >> 31)) * 0x7fb5d329728ea185ull;
  h = (h ^ (h >> 27)) * 0x81dadef4bc2dd44dull;
  return static_cast<int>((h ^ (h >> 33)) % kParts);
}

std::string number(float v) { return v == v ? fmt::format("{:.5g}", v) : std::string(); }

constexpr double kQuarter = 500;           ///< m around a seeded point, all hidden
constexpr double kBetweenQuarters = 1500;  ///< m; no quarter hears of the next one

std::uint64_t hash_of(model::OsmId id) {
  std::uint64_t h = id.number * 4u + static_cast<std::uint64_t>(id.type);
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdull;
  h = (h ^ (h >> 29)) * 0xc4ceb9fe1a85ec53ull;
  return h ^ (h >> 32);
}

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Takes away what a building tells of storeys, roof and date. \returns  whether it told any
bool hide_all(evidence::FactsExtract& f, evidence::TagFacts& t, std::uint32_t b) {
  bool any = t.roofs[b].has_value() || t.years[b].has_value();
  for (const Feature feature :
       {Feature::tag_storeys, Feature::tag_roof, Feature::tag_roof_storeys, Feature::tag_year}) {
    any = any || f.features[b].has(feature);
    f.features[b][feature] = kUnknown;
  }
  t.roofs[b].reset();
  t.dates[b] = {};
  t.years[b].reset();
  return any;
}

/// Who lies within 500 m of the seeded points: buildings that tell something, in the order of a hash of their ids.
std::vector<std::uint8_t> in_quarters(const evidence::FactsExtract& facts, const evidence::TagFacts& tags,
                                      const footprints::FootprintStore& store) {
  evidence::FactsExtract f = facts;
  evidence::TagFacts t = tags;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> telling;
  for (std::uint32_t b = 0; b < store.size(); ++b)
    if (facts.features[b].has(Feature::area) && hide_all(f, t, b)) telling.emplace_back(hash_of(store[b].id), b);
  std::sort(telling.begin(), telling.end());
  const auto away = [&](std::uint32_t a, std::uint32_t b) {
    return std::hypot(facts.places[a].place.x - facts.places[b].place.x,
                      facts.places[a].place.y - facts.places[b].place.y);
  };
  std::vector<std::uint32_t> points;
  for (const auto& [hash, b] : telling)
    if (std::none_of(points.begin(), points.end(), [&](std::uint32_t p) { return away(p, b) < kBetweenQuarters; }))
      points.push_back(b);
  std::vector<std::uint8_t> out(store.size(), 0);
  for (std::uint32_t b = 0; b < store.size(); ++b)
    for (const std::uint32_t p : points)
      if (away(p, b) <= kQuarter) out[b] = 1;
  return out;
}

struct Conditions {
  evidence::StyleExtract tagged, hidden, tenths, quarter;
};

struct Answers {
  evidence::StyleExtract tagged, untagged, no_region, no_smooth, permuted, era, storeys, storeys_alone, roof,
      roof_alone;
};

/// Gives each building the geometry of another: what classification is worth without it.
evidence::FactsExtract permuted(const evidence::FactsExtract& facts) {
  evidence::FactsExtract out = facts;
  std::vector<std::uint32_t> known;
  for (std::uint32_t b = 0; b < facts.features.size(); ++b)
    if (facts.features[b].has(Feature::area)) known.push_back(b);
  for (std::size_t i = known.size(); i > 1; --i) std::swap(known[i - 1], known[base::random_bits(1, i, "permute") % i]);
  std::size_t next = 0;
  for (std::uint32_t b = 0; b < facts.features.size(); ++b)
    if (facts.features[b].has(Feature::area)) {
      const classify::FeatureVector& other = facts.features[known[next++]];
      for (std::size_t f = 0; f < classify::kFeatureCount; ++f)
        if (!classify::is_tag(static_cast<Feature>(f))) out.features[b][static_cast<Feature>(f)] = other.at(f);
    }
  return out;
}

/// Classifies with one tenth hidden after the other and keeps the answers of those hidden.
template <class Hide, class Keep>
void in_tenths(
    const evidence::FactsExtract& facts, const evidence::TagFacts& tags, const footprints::FootprintStore& store,
    Hide hide, Keep keep,
    const std::function<evidence::StyleExtract(const evidence::FactsExtract&, const evidence::TagFacts&)>& classify) {
  for (int part = 0; part < kParts; ++part) {
    evidence::FactsExtract f = facts;
    evidence::TagFacts t = tags;
    bool any = false;
    for (std::uint32_t b = 0; b < store.size(); ++b)
      if (part_of(store[b].id) == part) any = hide(f, t, b) || any;
    if (!any) continue;
    const evidence::StyleExtract answer = classify(f, t);
    for (std::uint32_t b = 0; b < store.size(); ++b)
      if (part_of(store[b].id) == part) keep(answer, b);
  }
}

void write_table(const std::string& input, const std::string& configs, const std::string& table, bool answers,
                 bool quick, bool conditions) {
  base::Progress progress;
  const model::Extract extract = importers::osm::read_extract(input, {});
  const auto area = footprints::area_of(extract);
  if (!area) throw std::runtime_error("no buildings in " + input);
  const auto crs = georef::open_crs(georef::choose_crs(area->centre.lon, area->centre.lat), area->box);
  const georef::Projection projection(crs, area->box);
  model::Report report;
  const auto shards = footprints::make_shards(extract, report);
  const auto coverage = context::coverage_of(footprints::building_places(extract, projection));
  const repair::KeptNodes kept(extract);
  const auto repaired = footprints::repair_extract(extract, shards, projection, kept, {}, kWorkers, progress);
  const auto& store = repaired.footprints;
  const auto context = context::context_extract(extract, store, coverage, projection, kWorkers, progress);
  const context::VicinityFinder vicinity(extract, store, context);
  evidence::FactsExtract facts =
      evidence::facts_extract(extract, store, repaired.first, context, vicinity, kWorkers, progress);
  classify::Tables tables =
      answers || conditions ? classify::Tables::read(configs) : classify::Tables::read_without_weights(configs);
  const evidence::TagFacts tags = evidence::tag_facts(extract, store, context, tables, projection, facts);

  Answers a;
  if (answers) {
    const auto rules = attributes::read_rule_sets(configs, "");
    const evidence::PriorOf prior = evidence::prior_by_place(extract, store, rules.book, tables);
    constexpr evidence::ClassifyOptions kUntagged{.tags = false, .dates = false, .smooth = true},
        kAlone{.tags = false, .dates = false, .smooth = false};
    a.tagged = evidence::classify_extract(facts, tags, tables, prior, {}, kWorkers, progress);
    a.untagged = evidence::classify_extract(facts, tags, tables, prior, kUntagged, kWorkers, progress);
    a.no_region = evidence::classify_extract(facts, tags, tables, {}, kUntagged, kWorkers, progress);
    a.no_smooth = evidence::classify_extract(facts, tags, tables, prior, kAlone, kWorkers, progress);
    a.permuted = evidence::classify_extract(permuted(facts), tags, tables, prior, kUntagged, kWorkers, progress);
    const auto again = [&](const evidence::FactsExtract& f, const evidence::TagFacts& t) {
      return evidence::classify_extract(f, t, tables, prior, {}, kWorkers, progress);
    };
    const std::size_t n = store.size();
    a.storeys.storeys.resize(n);
    a.roof.roofs.resize(n);
    a.era.styles.resize(n);
    a.storeys_alone.storeys.resize(n);
    a.roof_alone.roofs.resize(n);
    const auto hide_storeys = [&](evidence::FactsExtract& f, evidence::TagFacts&, std::uint32_t b) {
      const bool any = f.features[b].has(Feature::tag_storeys);
      f.features[b][Feature::tag_storeys] = kUnknown;
      return any;
    };
    const auto hide_roof = [&](evidence::FactsExtract& f, evidence::TagFacts& t, std::uint32_t b) {
      const bool any = f.features[b].has(Feature::tag_roof);
      f.features[b][Feature::tag_roof] = f.features[b][Feature::tag_roof_storeys] = kUnknown;
      t.roofs[b].reset();
      return any;
    };
    const auto hide_date = [&](evidence::FactsExtract& f, evidence::TagFacts& t, std::uint32_t b) {
      const bool any = f.features[b].has(Feature::tag_year) || f.features[b].has(Feature::tag_heritage);
      f.features[b][Feature::tag_year] = f.features[b][Feature::tag_heritage] = kUnknown;
      t.dates[b] = {};
      t.years[b].reset();
      return any;
    };
    if (!quick) {
      in_tenths(
          facts, tags, store, hide_storeys,
          [&](const auto& r, std::uint32_t b) { a.storeys.storeys[b] = r.storeys[b]; }, again);
      in_tenths(
          facts, tags, store, hide_roof, [&](const auto& r, std::uint32_t b) { a.roof.roofs[b] = r.roofs[b]; }, again);
      in_tenths(
          facts, tags, store, hide_date, [&](const auto& r, std::uint32_t b) { a.era.styles[b] = r.styles[b]; }, again);
      evidence::FactsExtract f = facts;
      evidence::TagFacts t = tags;
      for (std::uint32_t b = 0; b < n; ++b) hide_storeys(f, t, b);
      a.storeys_alone = again(f, t);
      f = facts;
      for (std::uint32_t b = 0; b < n; ++b) hide_roof(f, t, b);
      a.roof_alone = again(f, t);
    }
  }

  Conditions c;
  std::vector<std::uint8_t> quarter;
  if (conditions) {
    const auto rules = attributes::read_rule_sets(configs, "");
    const evidence::PriorOf prior = evidence::prior_by_place(extract, store, rules.book, tables);
    const auto again = [&](const evidence::FactsExtract& f, const evidence::TagFacts& t) {
      return evidence::classify_extract(f, t, tables, prior, {}, kWorkers, progress);
    };
    c.tagged = again(facts, tags);
    c.tenths = c.tagged;
    in_tenths(
        facts, tags, store, hide_all,
        [&](const auto& r, std::uint32_t b) {
          c.tenths.styles[b] = r.styles[b];
          c.tenths.storeys[b] = r.storeys[b];
          c.tenths.roofs[b] = r.roofs[b];
          c.tenths.dates[b] = r.dates[b];
        },
        again);
    evidence::FactsExtract f = facts;
    evidence::TagFacts t = tags;
    quarter = in_quarters(facts, tags, store);
    for (std::uint32_t b = 0; b < store.size(); ++b)
      if (quarter[b]) hide_all(f, t, b);
    c.quarter = again(f, t);
    for (std::uint32_t b = 0; b < store.size(); ++b) hide_all(f, t, b);
    c.hidden = again(f, t);
  }

  constexpr std::string_view kTags[] = {"building", "start_date", "building:architecture",
                                        "name",     "heritage",   "historic",
                                        "wikidata", "wikipedia",  "architect"};
  auto out = fmt::output_file(table);
  std::string head =
      "id,x,y,lon,lat,block,street,house,parts,storeys,height,roof_shape,year,year_confidence,years_from,years_to,non_"
      "house,contacts";
  for (const auto t : kTags) head += fmt::format(",t_{}", t);
  for (const auto& f : classify::kFeatures) head += fmt::format(",{}", f.name);
  if (answers) {
    for (const char* set : {"tagged", "untagged", "noregion", "nosmooth", "permuted", "hidden"}) {
      for (const auto name : model::kStyleClassNames) head += fmt::format(",{}_style_{}", set, name);
      for (const auto name : model::kEraNames) head += fmt::format(",{}_era_{}", set, name);
      for (const auto name : model::kMorphologyNames) head += fmt::format(",{}_morphology_{}", set, name);
      head += fmt::format(",{}_substyle", set);
    }
    head +=
        ",storeys_hidden,storeys_hidden_p,storeys_votes,storeys_alone,storeys_alone_p,roof_hidden,roof_hidden_p,roof_"
        "alone";
  }
  if (conditions) {
    head += ",in_quarter";
    for (const char* set : {"tagged", "hidden", "tenths", "quarter"}) {
      for (const auto name : model::kStyleClassNames) head += fmt::format(",{}_style_{}", set, name);
      for (const auto name : model::kEraNames) head += fmt::format(",{}_era_{}", set, name);
      for (const auto name : model::kMorphologyNames) head += fmt::format(",{}_morphology_{}", set, name);
      for (const char* name :
           {"substyle", "substyle_p", "non_house", "storeys", "storeys_p", "storeys_within", "roof", "roof_p", "year"})
        head += fmt::format(",{}_{}", set, name);
    }
  }
  out.print("{}\n", head);
  const auto clean = [](std::string_view text) {
    std::string out_text;
    for (const char ch : text) out_text += ch == ',' || ch == '"' || ch == '\n' || ch == '\r' ? ' ' : ch;
    return out_text;
  };
  std::uint32_t n = 0;
  for (const footprints::Shard& shard : shards)
    for (const footprints::Seed& seed : shard.seeds) {
      const std::uint32_t b = n++;
      if (!facts.features[b].has(Feature::area)) continue;
      const model::MappedBuilding& m = extract.buildings[seed.lead()];
      const evidence::BuildingPlace& p = facts.places[b];
      const model::Location l = footprints::box_centre(extract, m);
      std::string touching;
      for (const evidence::Contact& contact : facts.contacts_of(b))
        touching += (touching.empty() ? "" : " ") + store[contact.other].id.text() + ":" +
                    fmt::format("{:.1f}", contact.length);
      const auto optional = [](const auto& v) { return v ? fmt::format("{:g}", *v) : std::string(); };
      std::string row = fmt::format(
          "{},{:.1f},{:.1f},{:.6f},{:.6f},{},{:x},{},{},{},{},{},{},{},{},{},{},{}", m.id.text(), p.place.x, p.place.y,
          l.lon_degrees(), l.lat_degrees(), p.block == model::kNoIndex ? "" : context.blocks[p.block].id, p.street,
          p.house ? 1 : 0, seed.parts.size(), optional(m.attributes.storeys), optional(m.attributes.height),
          m.attributes.roof_shape ? model::name(*m.attributes.roof_shape) : "",
          tags.dates[b].confidence > 0 ? fmt::format("{:g}", tags.dates[b].year) : "", tags.dates[b].confidence,
          tags.years[b] ? std::to_string(tags.years[b]->from) : "",
          tags.years[b] ? std::to_string(tags.years[b]->to) : "",
          tags.non_house[b] < 0 ? "" : tags.reasons[static_cast<std::size_t>(tags.non_house[b])].kind, touching);
      for (const auto t : kTags) row += "," + clean(extract.tag(m.tags, t));
      for (std::size_t f = 0; f < classify::kFeatureCount; ++f) row += "," + number(facts.features[b].at(f));
      if (answers) {
        for (const evidence::StyleExtract* set :
             {&a.tagged, &a.untagged, &a.no_region, &a.no_smooth, &a.permuted, &a.era}) {
          const model::BuildingStyle& s = set->styles[b];
          for (const float v : s.style) row += "," + number(v);
          for (const float v : s.era) row += "," + number(v);
          for (const float v : s.morphology) row += "," + number(v);
          row += "," + tables.catalogue[s.substyle].id;
        }
        row += fmt::format(",{:g},{:.3f},{:.3f},{:g},{:.3f},{},{:.3f},{}", a.storeys.storeys[b].storeys,
                           a.storeys.storeys[b].confidence, a.storeys.storeys[b].votes,
                           a.storeys_alone.storeys[b].storeys, a.storeys_alone.storeys[b].confidence,
                           classify::name(classify::family_of(a.roof.roofs[b].shape)), a.roof.roofs[b].confidence,
                           classify::name(classify::family_of(a.roof_alone.roofs[b].shape)));
      }
      if (conditions) {
        row += fmt::format(",{}", quarter[b]);
        for (const evidence::StyleExtract* set : {&c.tagged, &c.hidden, &c.tenths, &c.quarter}) {
          const model::BuildingStyle& s = set->styles[b];
          for (const float v : s.style) row += "," + number(v);
          for (const float v : s.era) row += "," + number(v);
          for (const float v : s.morphology) row += "," + number(v);
          const evidence::StoreysEstimate& storeys = set->storeys[b];
          const evidence::RoofEstimate& roof = set->roofs[b];
          row += fmt::format(",{},{:.3f},{},{:g},{:.3f},{:.3f},{},{:.3f}", tables.catalogue[s.substyle].id,
                             s.substyle_p, s.non_house ? 1 : 0, storeys.storeys, storeys.confidence, storeys.within_one,
                             classify::name(classify::family_of(roof.shape)), roof.confidence) +
                 fmt::format(",{}", set->dates[b].year);
        }
      }
      out.print("{}\n", row);
    }
}

}  // namespace

int main(int argc, char** argv) {
  const bool answers = argc >= 5 && std::string(argv[4]) == "answers",
             quick = argc == 6 && std::string(argv[5]) == "quick",
             conditions = argc == 5 && std::string(argv[4]) == "conditions";
  if (argc != 4 && !conditions && !(answers && (argc == 5 || quick))) {
    std::fputs("usage: facts_table EXTRACT CONFIGS OUT.csv [answers [quick] | conditions]\n", stderr);
    return 1;
  }
  try {
    write_table(argv[1], argv[2], argv[3], answers, quick, conditions);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
