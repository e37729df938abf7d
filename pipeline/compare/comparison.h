// What a comparison found: plain data, from which every report is printed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/facade_agreement.h"
#include "pipeline/compare/measures.h"

namespace blockrand::compare {

/// Where the models lie to each other: a shift that all matches have in common, as error of georeference or datum, not
/// of geometry. Estimated always, removed only where asked for.
struct Registration {
  std::size_t matches = 0;                   ///< that the estimate rests on; none: no estimate
  double east = 0, north = 0;                ///< m, model minus reference: median over the matches
  double east_spread = 0, north_spread = 0;  ///< m: median absolute deviation from it
  std::optional<double> up;                  ///< m, of the buildings' grounds; only where absolute heights are compared
  double up_spread = 0;
  bool horizontal_removed = false, vertical_removed = false;  ///< the model was moved by minus that before measuring
  std::string rule;                                           ///< why it was or was not removed, for people
};

/// Form of a roof as its planes show it.
enum class RoofForm : std::uint8_t { flat, shed, gabled, hipped, mansard, complex, none };
inline constexpr int kRoofFormCount = 7;
std::string_view name_of(RoofForm form);

/// One side of a match.
struct SideFacts {
  std::vector<std::uint32_t> buildings;          ///< indices into its City, ascending
  double footprint_area = 0;                     ///< m²
  double surface_area = 0;                       ///< m² of the outer hull
  std::array<double, kHullCount> area_of{};      ///< m² by class
  std::array<double, kLeftOutCount> left_out{};  ///< m² by reason; [0]: counted
  double unclassified_area = 0;                  ///< m² whose class was told from the normal
  std::optional<double> ground;                  ///< z, m
  std::optional<double> eaves, ridge;            ///< m above own ground
  std::optional<double> volume;                  ///< m³; without closed shells none
  std::optional<double> roof_volume;             ///< m³ between the roof and the own ground, over the footprint
  std::optional<double> pitch;                   ///< degrees, mean of the sloped part of the roof
  std::optional<double> fall;  ///< degrees clockwise from north, down one slope of a gabled roof: square to its ridge
  RoofForm roof_form = RoofForm::none;
  std::size_t solids = 0, valid_solids = 0;
  std::map<std::string, std::size_t> defects;  ///< "302 shell not closed" → solids
  std::size_t openings = 0, triangles = 0;
};

/// Buildings of both models that stand for each other: 1:1, 1:n, n:1 or n:m.
struct MatchResult {
  std::string id;  ///< of the first building of the reference, unique: "…#2" where taken
  SideFacts model, reference;
  MeasureValues values;
  FacadeComparison facades;
};

/// Distances over all matches, weighted by area: share of the area up to each distance.
struct DistanceDistribution {
  std::vector<double> upto;          ///< m, ascending: 0.05, 0.1, 0.2 …
  std::vector<double> to_reference;  ///< share of the model's counted surface that is at most so far from the reference
  std::vector<double> to_model;      ///< share of the reference's counted surface …
  double p95_to_reference = 0, p95_to_model = 0;  ///< m
};

struct Comparison {
  City model, reference;
  bool absolute_heights = false;  ///< measured as they stand; else above each building's own ground
  Registration registration;
  std::vector<MatchResult> matches;    ///< in the order of the reference's buildings
  std::vector<std::uint32_t> missing;  ///< the reference's buildings that have no match
  std::vector<std::uint32_t> extra;    ///< the model's buildings that have no match
  std::vector<double> missing_covered,
      extra_covered;  ///< as those: share of their footprint that the other model covers
  MeasureSummaries summaries;
  DistanceDistribution distances;
  /// [reference's form][model's form] → matches
  std::array<std::array<std::size_t, kRoofFormCount>, kRoofFormCount> roof_confusion{};
  SideFacts model_total, reference_total;  ///< sums over the matches; no heights
  std::size_t blank_facades = 0;           ///< of the reference, left out
};

}  // namespace blockrand::compare
