#include "pipeline/evidence/building_facts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "pipeline/base/memo.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/evidence/facts_around.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::evidence {

namespace {

using classify::Feature;
using classify::FeatureVector;
using classify::kHouseArea;
using classify::kNearReach;
using model::Building;
using model::BuildingPosition;
using model::Point2;
using model::WallSegment;
using model::WallSegmentKind;

constexpr double kCornerSine = 0.342;   ///< of 20 degrees: what turns less is a bend in a wall
constexpr double kSectionStep = 1;      ///< m between sections across a house: half a window axis
constexpr double kFrontCosine = 0.94;   ///< of 20 degrees: wall segments of one front
constexpr double kRunDepth = 0.35;      ///< quantile of the first runs behind the front: its depth
                                        ///< (docs/style_measures.md 2.2)
constexpr double kMinContact = 1.5;     ///< m. Shorter common walls tie no row together
constexpr std::int32_t kTownCells = 2;  ///< cells to each side of a building's own that make its town

float as_float(double v) { return static_cast<float>(v); }

/// FNV-1a: the same in every run and every tile.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t h = 1469598103934665603ull;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return h == 0 ? 1 : h;
}

// ---- the building alone ---------------------------------------------------------------------------------------------

int corners_of(const model::Ring& ring) {
  int corners = 0;
  const std::size_t n = ring.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = ring.points[i] - ring.points[(i + n - 1) % n], b = ring.points[(i + 1) % n] - ring.points[i];
    const double lengths = std::sqrt(dot(a, a) * dot(b, b));
    if (lengths > 0 && (std::fabs(cross(a, b)) > kCornerSine * lengths || dot(a, b) < 0)) ++corners;
  }
  return corners;
}

struct Depths {
  double front = 0, greatest = 0;  ///< m
};

/// Sections through the building across its front: how deep it is behind the front and at its deepest.
/// \param inward  unit vector; \param from, to  m along the front
std::optional<Depths> depths_of(const Building& building, Point2 inward, double from, double to) {
  const Point2 along{inward.y, -inward.x};
  std::vector<double> first_runs, longest_runs, crossings;
  for (double at = from + kSectionStep / 2; at < to; at += kSectionStep) {
    crossings.clear();
    for (const model::Polygon& polygon : building.outline) {
      const auto cut = [&](const model::Ring& ring) {
        const std::size_t n = ring.points.size();
        for (std::size_t i = 0; i < n; ++i) {
          const Point2 a = ring.points[i], b = ring.points[(i + 1) % n];
          const double ua = dot(a, along) - at, ub = dot(b, along) - at;
          if ((ua < 0) == (ub < 0)) continue;
          const double t = ua / (ua - ub);
          crossings.push_back(dot(a, inward) * (1 - t) + dot(b, inward) * t);
        }
      };
      cut(polygon.outer);
      for (const model::Ring& hole : polygon.holes) cut(hole);
    }
    if (crossings.size() < 2) continue;
    std::sort(crossings.begin(), crossings.end());
    first_runs.push_back(crossings[1] - crossings[0]);
    double longest = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      longest = std::max(longest, crossings[i + 1] - crossings[i]);
    longest_runs.push_back(longest);
  }
  if (first_runs.empty()) return std::nullopt;
  return Depths{quantile(first_runs, kRunDepth), quantile(longest_runs, 1)};
}

/// What is kept of a building while neighbours are not known yet.
struct Own {
  FeatureVector features;
  BuildingPlace place;
  std::vector<std::pair<model::OsmId, float>> contacts;
};

void measure_plan(const Building& building, FeatureVector& f) {
  double area = 0, walls = 0;
  int corners = 0;
  std::size_t yards = 0;
  const model::Polygon* largest = nullptr;
  for (const model::Polygon& polygon : building.outline) {
    area += geometry::area(polygon);
    walls += geometry::perimeter(polygon.outer.points);
    corners += corners_of(polygon.outer);
    yards += polygon.holes.size();
    if (largest == nullptr || geometry::area(polygon) > geometry::area(*largest)) largest = &polygon;
  }
  if (largest == nullptr || area <= 0) return;
  const Point2 axis = geometry::long_axis(largest->outer.points);
  const auto along = geometry::extent_along(largest->outer.points, axis);
  const auto across = geometry::extent_along(largest->outer.points, {-axis.y, axis.x});
  const double length = along.maximum - along.minimum, breadth = across.maximum - across.minimum;
  f[Feature::area] = as_float(area);
  f[Feature::length] = as_float(length);
  f[Feature::breadth] = as_float(breadth);
  if (breadth > 0) {
    f[Feature::elongation] = as_float(length / breadth);
    f[Feature::rectangularity] = as_float(geometry::area(*largest) / (length * breadth));
  }
  f[Feature::compactness] = as_float(4 * base::kPi * area / (walls * walls));
  f[Feature::corners] = as_float(corners);
  f[Feature::yards] = as_float(static_cast<double>(yards));
}

float position_number(BuildingPosition p) { return static_cast<float>(static_cast<int>(p)); }

float street_rank(std::string_view street_class) {
  static constexpr std::string_view kNames[] = {"motorway", "trunk",       "primary",       "secondary",
                                                "tertiary", "residential", "living_street", "pedestrian"};
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    if (kNames[i] == street_class) return static_cast<float>(i + 1);
  return std::numeric_limits<float>::quiet_NaN();
}

void measure_situation(const Building& building, Own& own) {
  FeatureVector& f = own.features;
  double party = 0, front = 0, court = 0, all = 0;
  std::map<model::OsmId, double> contacts;
  for (const WallSegment& e : building.edges) {
    all += e.length();
    if (e.kind == WallSegmentKind::party_wall) {
      party += e.length();
      if (e.neighbour.number != 0 && !e.outbuilding) contacts[e.neighbour] += e.length();
    } else if (e.kind == WallSegmentKind::street) {
      front += e.length();
    } else if (e.kind == WallSegmentKind::courtyard) {
      court += e.length();
    }
  }
  if (all <= 0) return;
  for (const auto& [id, length] : contacts)
    if (length >= kMinContact) own.contacts.emplace_back(id, as_float(length));
  f[Feature::party_share] = as_float(party / all);
  f[Feature::front_share] = as_float(front / all);
  f[Feature::court_share] = as_float(court / all);
  own.place.position = building.situation.position;
  if (building.situation.position != BuildingPosition::unknown)
    f[Feature::position] = position_number(building.situation.position);
  if (building.situation.setback) f[Feature::setback] = as_float(*building.situation.setback);

  const std::vector<std::uint32_t>& fronts = building.situation.fronts;
  if (fronts.empty() || !building.situation.orientation) return;
  const WallSegment& main = building.edges[fronts.front()];
  own.place.street =
      main.street_name.empty() ? static_cast<std::uint64_t>(main.street.number) : hash_of(main.street_name);
  f[Feature::street_distance] = main.street_distance;
  f[Feature::street_angle] = main.street_angle;
  f[Feature::street_class] = street_rank(main.street_class);

  const double turned = *building.situation.orientation * base::kRadiansPerDegree;
  const Point2 outward{base::sin(turned), base::cos(turned)}, inward{-outward.x, -outward.y},
      along{inward.y, -inward.x};
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (const std::uint32_t i : fronts) {
    const WallSegment& e = building.edges[i];
    if (e.street != main.street && e.street_name != main.street_name) continue;
    const model::Polygon& polygon = building.outline[e.polygon];
    const auto& ring = (e.ring == 0 ? polygon.outer : polygon.holes[e.ring - 1]).points;
    const Point2 a = ring[e.edge], b = ring[(e.edge + 1) % ring.size()], d = b - a;
    const double length = std::sqrt(dot(d, d));
    if (length <= 0 || std::fabs(dot(d, along)) < kFrontCosine * length) continue;
    for (const double t : {e.start / length, e.end / length}) {
      const double u = dot({a.x + t * d.x, a.y + t * d.y}, along);
      from = std::min(from, u);
      to = std::max(to, u);
    }
  }
  if (to - from < kSectionStep) return;
  f[Feature::frontage] = as_float(to - from);
  if (const auto depths = depths_of(building, inward, from, to); depths && depths->front > 0) {
    f[Feature::front_depth] = as_float(depths->front);
    f[Feature::depth_ratio] = as_float(depths->greatest / depths->front);
  }
}

// ---- blocks and town ------------------------------------------------------------------------------------------------

void measure_blocks(const context::ContextExtract& context, FactsExtract& facts) {
  std::vector<double> houses(context.blocks.size()), rear(context.blocks.size()), yards(context.blocks.size());
  for (const BuildingPlace& p : facts.places) {
    if (p.block == model::kNoIndex || !p.house) continue;
    ++houses[p.block];
    if (p.position == BuildingPosition::rear_building || p.position == BuildingPosition::side_wing) ++rear[p.block];
  }
  for (const context::ExtractCourtyard& yard : context.courtyards)
    if (yard.block != model::kNoIndex && yard.courtyard.closed) yards[yard.block] += yard.courtyard.area;
  for (std::size_t b = 0; b < facts.places.size(); ++b) {
    const std::uint32_t block = facts.places[b].block;
    if (block == model::kNoIndex || !context.blocks[block].gives_ratios()) continue;
    const context::BlockFigures& figures = context.figures[block];
    FeatureVector& f = facts.features[b];
    f[Feature::block_area] = as_float(context.blocks[block].area / 10000);
    if (figures.built_share) f[Feature::block_built] = as_float(*figures.built_share);
    if (figures.closure) f[Feature::block_closure] = as_float(*figures.closure);
    f[Feature::block_court] = as_float(yards[block] / context.blocks[block].area);
    if (houses[block] > 0) f[Feature::block_rear] = as_float(rear[block] / houses[block]);
  }
}

void measure_town(const context::ContextExtract& context, FactsExtract& facts) {
  struct Town {
    double buildings = 0, area = 0, walls = 0, party = 0, covered = 0;
  };
  std::map<context::CellIndex, double> covered;
  const auto covered_share = [&](context::CellIndex c) {
    const auto [place, fresh] = covered.try_emplace(c, 0);
    if (fresh) place->second = context::covered_share(c, context.coverage);
    return place->second;
  };
  std::map<context::CellIndex, Town> towns;
  for (std::size_t b = 0; b < facts.places.size(); ++b) {
    if (!facts.features[b].has(Feature::area)) continue;
    const context::CellIndex cell = context::cell_of(facts.places[b].place);
    const auto [place, fresh] = towns.try_emplace(cell);
    Town& town = place->second;
    if (fresh)
      for (std::int32_t x = cell.x - kTownCells; x <= cell.x + kTownCells; ++x)
        for (std::int32_t y = cell.y - kTownCells; y <= cell.y + kTownCells; ++y) {
          town.covered += covered_share({x, y});
          const auto sums = context.cells.find({x, y});
          if (sums == context.cells.end()) continue;
          town.buildings += static_cast<double>(sums->second.buildings);
          town.area += static_cast<double>(sums->second.area) / 1024;
          town.walls += static_cast<double>(sums->second.walls) / 1024;
          town.party += static_cast<double>(sums->second.party_walls) / 1024;
        }
    if (town.covered < 0.5) continue;
    FeatureVector& f = facts.features[b];
    const double land = town.covered * context::kCellSize * context::kCellSize;
    f[Feature::town_built] = as_float(town.area / land);
    f[Feature::town_density] = as_float(town.buildings / land * 10000);
    if (town.walls > 0) f[Feature::town_party_share] = as_float(town.party / town.walls);
  }
}

/// The buildings of one tile with their outlines and nothing else, labelled.
model::Region labelled(const model::Extract& extract, const footprints::FootprintStore& store,
                       const context::VicinityFinder& vicinity, std::span<const std::uint32_t> numbers) {
  model::Region region;
  region.extract = &extract;
  for (const std::uint32_t n : numbers) {
    Building building;
    building.osm = store[n].id;
    building.tags = extract.buildings[store[n].lead].tags;
    building.outline = store.polygons(n);
    building.arcs = store.arcs(n);
    region.buildings.push_back(std::move(building));
  }
  vicinity.label_wall_segments(region, numbers);
  return region;
}

/// What `labelled` reads for buildings of a run.
void pack_labelled(const model::Extract& extract, const footprints::FootprintStore& store,
                   const context::VicinityFinder& vicinity, std::span<const std::uint32_t> numbers, base::Packer& out) {
  geometry::PlanBox box;
  for (const std::uint32_t n : numbers) {
    footprints::StoredFootprint stored = store[n];
    box.include(stored.box);
    stored.lead = 0, stored.rings = {}, stored.arcs = {};
    out << stored << store.polygons(n) << store.arcs(n)
        << context::address_street(extract, extract.buildings[store[n].lead].tags);
  }
  if (!box.empty()) context::pack(vicinity.vicinity_of(box), out);
}

/// Buildings are looked at in runs of at most this many.
constexpr std::size_t kRun = 256;
/// m. Those of a run are no farther from its first: what is seen from walls is filed in one grid over the run.
constexpr double kRunExtent = 2000;

/// Where runs begin, and the end. Results do not depend on it. A run lies in one tile, so that what is mapped elsewhere does not
/// change which buildings it has.
std::vector<std::size_t> runs_of(const footprints::FootprintStore& store, std::span<const std::uint32_t> tiles) {
  std::vector<std::size_t> starts;
  Point2 first{};
  auto tile = tiles.begin();
  for (std::uint32_t b = 0; b < store.size(); ++b) {
    bool begins = starts.empty();
    for (; tile != tiles.end() && *tile <= b; ++tile) begins = true;
    const bool known = !store[b].box.empty();
    const Point2 d = known ? store[b].box.centre() - first : Point2{};
    if (begins || b - starts.back() == kRun || dot(d, d) > kRunExtent * kRunExtent) {
      starts.push_back(b);
      if (known) first = store[b].box.centre();
    }
  }
  starts.push_back(store.size());
  return starts;
}

}  // namespace

PlaceIndex::PlaceIndex(const FactsExtract& facts, std::span<const std::uint32_t> chosen)
    : chosen_(chosen.begin(), chosen.end()) {
  std::vector<geometry::PlanBox> places;
  places.reserve(chosen.size());
  for (const std::uint32_t b : chosen) places.push_back({facts.places[b].place, facts.places[b].place});
  places_ = geometry::BoxIndex(std::move(places));
}

void PlaceIndex::near(Point2 place, double distance, std::vector<std::uint32_t>& out) const {
  out.clear();
  constexpr double kMargin = 0.001;  // m: the circle alone decides
  for (const std::uint32_t i : places_.near({place, place}, distance + kMargin))
    if (squared_distance(places_.box(i).minimum, place) <= distance * distance) out.push_back(chosen_[i]);
}

std::vector<std::uint32_t> PlaceIndex::around(const geometry::PlanBox& box, double distance) const {
  std::vector<std::uint32_t> out = places_.near(box, distance);
  for (std::uint32_t& i : out) i = chosen_[i];
  return out;
}

FactsExtract facts_extract(const model::Extract& extract, const footprints::FootprintStore& store,
                           std::span<const std::uint32_t> first, const context::ContextExtract& context,
                           const context::VicinityFinder& vicinity, int workers, base::Progress& progress,
                           const base::Memo* memo, const Needed& needed) {
  const std::size_t count = store.size();
  progress.begin("measure", 2 * count);  // alone, then with what stands around
  FactsExtract facts;
  facts.features.resize(count);
  facts.places.resize(count);
  const footprints::BuildingNumbers numbers(store);

  // Each building alone, with what its walls look at.
  const std::vector<std::size_t> starts = runs_of(store, first);
  const std::size_t in_flight = static_cast<std::size_t>(workers) * 2 + 2, runs = starts.size() - 1;
  std::vector<std::vector<Own>> slots(in_flight);
  // Whole runs, so that what is remembered of one serves all who need a part of it.
  const auto any_of_run = [&](std::size_t i, bool (Needed::*is_needed)(std::size_t) const) {
    for (std::size_t b = starts[i]; b < starts[i + 1]; ++b)
      if ((needed.*is_needed)(b)) return true;
    return false;
  };
  const auto measured = [&](const std::vector<std::uint32_t>& mine) {
    const model::Region region = labelled(extract, store, vicinity, mine);
    std::vector<Own> run;
    for (std::size_t k = 0; k < mine.size(); ++k) {
      const footprints::StoredFootprint& stored = store[mine[k]];
      Own& own = run.emplace_back();
      if (stored.box.empty() || stored.settled != model::ObjectState::pending) continue;
      own.place.place = context::place_of(store, mine[k]);
      measure_plan(region.buildings[k], own.features);
      measure_situation(region.buildings[k], own);
      own.place.house = !stored.level.canopy && stored.level.low <= 0 && own.features.has(Feature::area) &&
                        static_cast<double>(own.features[Feature::area]) >= kHouseArea;
    }
    return run;
  };
  const auto look = [&](std::size_t i) {
    if (!any_of_run(i, &Needed::has_facts)) return;
    std::vector<std::uint32_t> mine;
    for (std::size_t b = starts[i]; b < starts[i + 1]; ++b) mine.push_back(static_cast<std::uint32_t>(b));
    slots[i % in_flight] = base::remembered<std::vector<Own>>(
        memo, "measured", [&](base::Packer& out) { pack_labelled(extract, store, vicinity, mine, out); },
        [&] { return measured(mine); });
    for (std::size_t k = 0; k < mine.size(); ++k)
      if (!store[mine[k]].box.empty() && store[mine[k]].settled == model::ObjectState::pending)
        slots[i % in_flight][k].place.block = context.block_of[mine[k]];
  };
  const auto keep = [&](std::size_t i) {
    for (std::size_t k = 0; k < slots[i % in_flight].size(); ++k) {
      Own& own = slots[i % in_flight][k];
      const std::size_t b = starts[i] + k;
      own.place.contacts.first = static_cast<std::uint32_t>(facts.contacts.size());
      for (const auto& [id, length] : own.contacts)
        if (const std::uint32_t other = numbers.find(id); other != model::kNoIndex)
          facts.contacts.push_back({other, length});
      own.place.contacts.count = static_cast<std::uint32_t>(facts.contacts.size()) - own.place.contacts.first;
      std::sort(facts.contacts.end() - own.place.contacts.count, facts.contacts.end(),
                [](const Contact& a, const Contact& c) {
                  return a.length > c.length || (a.length == c.length && a.other < c.other);
                });
      facts.places[b] = own.place;
      facts.features[b] = own.features;
    }
    slots[i % in_flight].clear();
    progress.advance_to(starts[i + 1]);
  };
  base::ordered_parallel(runs, workers, in_flight, look, keep);

  // What stands around.
  std::vector<std::uint32_t> houses, small;
  for (std::uint32_t b = 0; b < count; ++b) {
    if (facts.places[b].house)
      houses.push_back(b);
    else if (facts.features[b].has(Feature::area) && !store[b].level.canopy)
      small.push_back(b);
  }
  const PlaceIndex house_index(facts, houses), small_index(facts, small);
  // Into a copy: neighbours read what was measured alone, and nothing that this loop writes.
  std::vector<FeatureVector> out = facts.features;
  const AroundInputs inputs{facts, store, context, house_index, small_index};
  const auto around = [&](std::size_t i) {
    if (!any_of_run(i, &Needed::has_style)) return;
    const auto run = base::remembered<std::vector<FeatureVector>>(
        memo, "around", [&](base::Packer& packer) { pack_around(inputs, starts[i], starts[i + 1], packer); },
        [&] { return measured_around(inputs, starts[i], starts[i + 1]); });
    std::copy(run.begin(), run.end(), out.begin() + static_cast<std::ptrdiff_t>(starts[i]));
  };
  base::ordered_parallel(runs, workers, in_flight, around,
                         [&](std::size_t i) { progress.advance_to(count + starts[i + 1]); });
  facts.features = std::move(out);
  measure_blocks(context, facts);
  measure_town(context, facts);
  // Thresholds are compared with what is left after rounding, never with the last bit of a ray.
  for (FeatureVector& f : facts.features)
    for (std::size_t i = 0; i < classify::kFeatureCount; ++i) {
      float& v = f[static_cast<Feature>(i)];
      if (v == v) v = std::floor(v * classify::kFeatureSteps + 0.5f) / classify::kFeatureSteps;
    }
  return facts;
}

}  // namespace blockrand::evidence
