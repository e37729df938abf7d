// Rule sets of a city or region: what they are once read. The language is described in docs/districts.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/model/point.h"
#include "pipeline/model/style.h"
#include "styles/districts/presets.h"

namespace blockrand::districts {

/// Finer levels override coarser ones; of the same level the rule of higher priority, then the earlier one.
enum class Level : std::uint8_t { city, district, block, building };
inline constexpr std::array<std::string_view, 4> kLevelNames = {"city", "district", "block", "building"};
constexpr std::string_view name(Level level) { return kLevelNames[static_cast<std::size_t>(level)]; }

/// Figures of the district cell that a building stands in (context::CellFigures); lengths in m, areas in m².
enum class CellStatistic : std::uint8_t {
  built_share,
  party_wall_share,
  storeys_mean,
  density,  ///< buildings per hectare
  floor_area_ratio,
  footprint_median,
  year_mean,
};
inline constexpr std::array<std::string_view, 7> kCellStatisticNames = {
    "built_share", "party_wall_share", "storeys_mean", "density", "floor_area_ratio", "footprint_median", "year_mean"};

/// Both ends included.
struct Interval {
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
  bool holds(double v) const { return v >= from && v <= to; }
};

/// `key=value`, or any value of the key where `value` is empty.
struct TagTest {
  std::string key, value;
  std::string text() const { return value.empty() ? key : key + "=" + value; }
};

/// A question about a place that only the extract, or a file, can answer. Each stands once in a RuleSet.
struct PlaceQuery {
  enum class Kind : std::uint8_t { polygon, file, place, boundary, land_use, near } kind = Kind::polygon;
  std::vector<model::Location> ring;  ///< polygon: written in the rule
  std::string file, layer;            ///< file: path that can be opened
  std::vector<TagTest> attributes;    ///< file: fields and their values
  std::string name;                   ///< place, boundary
  double distance = 0;                ///< m. place: radius around a node; near: how far
  std::vector<std::string> values;    ///< land_use: any of them
  TagTest feature;                    ///< near
  std::string asked_in;               ///< the rule set's file
  int line = 0;                       ///< in it
  /// "in landuse=residential", "within 300 m of railway=rail"
  std::string text() const;
};

/// That a class, an era or a sub-style needs at least where a rule does not say: more likely than all others together.
inline constexpr double kUsualProbability = 0.5;

/// Who a rule is for. Empty vectors and values ask nothing; of a vector one must hold.
struct Where {
  std::vector<std::uint32_t> queries;         ///< into RuleSet::queries; all must hold
  std::optional<std::array<double, 4>> bbox;  ///< west, south, east, north in degrees
  std::vector<std::pair<CellStatistic, Interval>> cell;
};
struct Which {
  std::optional<model::StyleClass> style;
  /// That the class needs at least, the eras together, and the sub-style among those of its class.
  double probability = kUsualProbability;
  std::vector<model::Era> eras;              ///< the likeliest era is one of them
  std::optional<Interval> years;             ///< meets the tagged years of construction
  std::vector<std::string> substyles, uses;  ///< substyles: the likeliest is one of them, with at least `probability`
  std::optional<Interval> area, storeys, front;
  std::vector<model::BuildingPosition> positions;
  std::vector<TagTest> tags;      ///< all must hold
  std::vector<TagTest> any_tags;  ///< one of them must hold; empty: nothing is asked
  std::optional<bool> house;      ///< false: monuments, garages and the like only
};

struct WeightedPreset {
  std::uint32_t preset = 0;  ///< into RuleSets::presets
  double weight = 1;         ///< in (0, 1]; they sum to 1
};

struct Rule {
  std::string name;
  Level level = Level::building;
  int priority = 0;
  Where where;
  Which which;
  std::vector<WeightedPreset> presets;  ///< empty: the rule gives parameters only
  std::map<std::string, std::string> parameters;
  std::string file;  ///< of the rule set or its base, as read
  int line = 0;      ///< in it
  bool unconditional() const;
};

/// What classification may assume of a place before it looks at a building. Empty: nothing is said.
struct Priors {
  std::optional<std::array<double, model::kStyleClassCount>> style;
  std::optional<std::array<double, model::kEraCount>> era;
  std::map<std::string, double> substyle;  ///< by id of the catalogue
  std::vector<std::string> absent;         ///< ids of sub-styles that do not occur there
  /// Usual storeys. Keys: kStoreyPriorNames.
  std::map<std::string, double> storeys;
};
inline constexpr std::array<std::string_view, 7> kStoreyPriorNames = {"gruenderzeit", "tenement", "modern", "old_town",
                                                                      "slab",         "detached", "terrace"};

struct RuleSet {
  std::string name;  ///< of the file, without its ending
  std::string title, description;
  std::string file;                      ///< as read
  std::vector<std::string> bases;        ///< files whose rules and priors it takes over, the nearest first
  std::vector<model::Location> polygon;  ///< where it holds; empty: anywhere
  std::vector<PlaceQuery> queries;
  std::vector<Rule> rules;  ///< strongest first: finest level, highest priority, order of the file
  Priors prior;
};

/// Every rule set that a run knows.
struct RuleSets {
  std::vector<Preset> presets;
  std::vector<std::string> substyles;  ///< ids of the catalogue of styles; empty: names are not checked
  std::vector<RuleSet> sets;
  std::map<std::string, RuleSet> bases;  ///< read because a set builds on them, by path

  /// The set whose polygon holds the place, the smallest where several do; else the one without polygon; kNoSet where
  /// there is none. Exact: whole numbers only.
  static constexpr std::uint32_t kNoSet = 0xffffffff;
  std::uint32_t choose(model::Location place) const;

  /// Whether a rule asks for figures of a building's district cell.
  bool ask_cells() const {
    return std::ranges::any_of(sets, [](const RuleSet& set) {
      return std::ranges::any_of(set.rules, [](const Rule& r) { return !r.where.cell.empty(); });
    });
  }
};

/// Even-odd; a point on the boundary counts as inside. Exact.
bool holds(std::span<const model::Location> ring, model::Location place);
/// Twice the area of the ring in units of 1e-14 square degrees, positive.
__extension__ typedef unsigned __int128 RingArea;
RingArea double_area(std::span<const model::Location> ring);

}  // namespace blockrand::districts
