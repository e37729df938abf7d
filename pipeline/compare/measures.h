// The one list of what is measured: every table, file and page of a comparison is printed from it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace blockrand::compare {

/// Which value of a measure is the better one.
enum class Better : std::uint8_t {
  higher,  ///< ideal 1
  lower,   ///< ideal 0, never negative
  zero,    ///< ideal 0, with a sign: model minus reference
  one,     ///< ideal 1, a ratio model : reference
  none,    ///< tells, does not judge
};

/// How values of matches become one of all.
enum class Pool : std::uint8_t {
  mean,  ///< weighted mean, by MeasureValue::weight
  rms,   ///< root of the weighted mean of squares
  max,
  sum,
};

/// What part of the surface a measure looks at: what its left-out share is a share of.
enum class Scope : std::uint8_t {
  plan,     ///< footprints: nothing is left out
  body,     ///< heights, volume, roof, validity, bytes: nothing is left out
  surface,  ///< the outer surface
  facades,  ///< walls and their openings
};

// X(id, "unit", better, pool, scope, "title", "what it is")
#define BLOCKRAND_COMPARE_MEASURES(X)                                                                                 \
  X(footprint_iou, "1", higher, mean, plan, "footprint IoU",                                                          \
    "area in common over area together; weight: area together")                                                       \
  X(area_ratio, "1", one, mean, plan, "footprint area ratio", "model's over reference's; weight: reference's area")   \
  X(outline_distance, "m", lower, max, plan, "outline distance",                                                      \
    "largest distance of one outline from the other (Hausdorff)")                                                     \
  X(offset_east, "m", zero, mean, plan, "offset east", "of the footprints' centroids, model minus reference")         \
  X(offset_north, "m", zero, mean, plan, "offset north", "of the footprints' centroids, model minus reference")       \
  X(base_error, "m", zero, mean, body, "base height error",                                                           \
    "absolute height of the ground; only where both have terrain")                                                    \
  X(eaves_error, "m", zero, mean, body, "eaves height error", "each above its own ground")                            \
  X(ridge_error, "m", zero, mean, body, "ridge height error", "highest point of the roof, each above its own ground") \
  X(volume_ratio, "1", one, mean, body, "volume ratio",                                                               \
    "of what closed surfaces enclose, model's over reference's; weight: reference's volume")                          \
  X(roof_volume_ratio, "1", one, mean, body, "volume under the roof, ratio",                                          \
    "of the room between roof and own ground, which needs no closed solid; weight: reference's")                      \
  X(distance_mean, "m", lower, mean, surface, "surface distance, mean", "both ways, weighted by area")                \
  X(distance_rms, "m", lower, rms, surface, "surface distance, RMS", "both ways, weighted by area")                   \
  X(distance_p95, "m", lower, mean, surface, "surface distance, 95 %",                                                \
    "both ways, weighted by area; pooled: mean of buildings, see distribution")                                       \
  X(distance_max, "m", lower, max, surface, "surface distance, max", "the larger of both ways (Hausdorff)")           \
  X(to_reference_mean, "m", lower, mean, surface, "model to reference, mean",                                         \
    "from the model's surface to the nearest of the reference's")                                                     \
  X(to_model_mean, "m", lower, mean, surface, "reference to model, mean",                                             \
    "from the reference's surface to the nearest of the model's")                                                     \
  X(completeness_025, "1", higher, mean, surface, "completeness 0.25 m",                                              \
    "share of the reference's surface with the model within 0.25 m")                                                  \
  X(completeness_050, "1", higher, mean, surface, "completeness 0.5 m", "… within 0.5 m")                             \
  X(completeness_100, "1", higher, mean, surface, "completeness 1 m", "… within 1 m")                                 \
  X(correctness_025, "1", higher, mean, surface, "correctness 0.25 m",                                                \
    "share of the model's surface with the reference within 0.25 m")                                                  \
  X(correctness_050, "1", higher, mean, surface, "correctness 0.5 m", "… within 0.5 m")                               \
  X(correctness_100, "1", higher, mean, surface, "correctness 1 m", "… within 1 m")                                   \
  X(normal_deviation, "deg", lower, mean, surface, "normal deviation",                                                \
    "angle between a face and the nearest one of the other model, both ways, weighted by area")                       \
  X(roof_type_agrees, "1", higher, mean, body, "roof type", "1 where the form that the planes show is the same")      \
  X(ridge_agrees, "1", higher, mean, body, "ridge direction",                                                         \
    "1 where ridges run within 30 degrees of each other; where both roofs are gabled")                                \
  X(roof_pitch_error, "deg", zero, mean, body, "roof pitch error",                                                    \
    "mean pitch of the sloped part, where both have one")                                                             \
  X(storeys_error, "1", zero, mean, facades, "storeys error", "rows of openings; else as stated")                     \
  X(axes_error, "1", zero, mean, facades, "axes error",                                                               \
    "columns of openings per facade, mean over the facades; weight: reference's facades with openings")               \
  X(openings_ratio, "1", one, mean, facades, "openings ratio",                                                        \
    "number of openings, model's over reference's; weight: reference's number")                                       \
  X(window_to_wall_error, "1", zero, mean, facades, "window-to-wall error",                                           \
    "area of openings over area of facades, model minus reference; weight: reference's facade area")                  \
  X(opening_precision, "1", higher, mean, facades, "opening precision",                                               \
    "share of the model's openings that match one of the reference's at IoU 0.5 in the facade's plane; weight: "      \
    "model's openings")                                                                                               \
  X(opening_recall, "1", higher, mean, facades, "opening recall",                                                     \
    "share of the reference's openings that are matched so; weight: reference's openings")                            \
  X(storey_pitch_error, "m", zero, mean, facades, "storey pitch error", "vertical spacing of rows of openings")       \
  X(axis_pitch_error, "m", zero, mean, facades, "axis pitch error", "horizontal spacing of columns of openings")      \
  X(semantic_model, "1", higher, mean, surface, "model's surface with a class",                                       \
    "share of the area whose class the file states")                                                                  \
  X(semantic_reference, "1", none, mean, surface, "reference's surface with a class",                                 \
    "share of the area whose class the file states")                                                                  \
  X(valid_model, "1", higher, mean, body, "model's solids valid",                                                     \
    "share of the solids without a defect (ISO 19107); no value without solids")                                      \
  X(valid_reference, "1", none, mean, body, "reference's solids valid",                                               \
    "share of the solids without a defect (ISO 19107)")                                                               \
  X(triangles_model, "1", none, sum, body, "model's triangles", "that its polygons make")                             \
  X(triangles_reference, "1", none, sum, body, "reference's triangles", "that its polygons make")

enum class Measure : std::uint8_t {
#define X(id, unit, better, pool, scope, title, text) id,
  BLOCKRAND_COMPARE_MEASURES(X)
#undef X
};

struct MeasureInfo {
  std::string_view id, unit;
  Better better;
  Pool pool;
  Scope scope;
  std::string_view title, text;
};
inline constexpr MeasureInfo kMeasures[] = {
#define X(ID, UNIT, BETTER, POOL, SCOPE, TITLE, TEXT) \
  {.id = #ID,                                         \
   .unit = UNIT,                                      \
   .better = Better::BETTER,                          \
   .pool = Pool::POOL,                                \
   .scope = Scope::SCOPE,                             \
   .title = TITLE,                                    \
   .text = TEXT},
    BLOCKRAND_COMPARE_MEASURES(X)
#undef X
};
inline constexpr std::size_t kMeasureCount = std::size(kMeasures);
constexpr const MeasureInfo& info(Measure m) { return kMeasures[static_cast<std::size_t>(m)]; }

/// A measure of one match. No value: it cannot be told (no openings on either side, no solids …).
struct MeasureValue {
  std::optional<double> counted;  ///< without what is left out
  std::optional<double> all;      ///< with it
  double weight = 1;              ///< of `counted` when matches are pooled (area, count …)
  double weight_all = 1;          ///< of `all`
  double left_out = 0;            ///< share of the reference's area in the measure's scope that `counted` leaves out
};
using MeasureValues = std::array<MeasureValue, kMeasureCount>;

/// A measure over all matches. Of values with a sign: `mean` is the bias and `mean_abs` the MAE.
struct Summary {
  std::size_t count = 0;                                                              ///< matches with a value
  double pooled = 0;                                                                  ///< by the measure's Pool
  double mean = 0, mean_abs = 0, rms = 0, median = 0, p95_abs = 0, min = 0, max = 0;  ///< of matches, each alike
  double mean_factor = 1;  ///< of ratios (Better::one): mean_factor() of the matches, each alike
};
struct MeasureSummary {
  Summary counted, all;
  double left_out = 0;  ///< share of the reference's area in the measure's scope, over all matches with a value
};
using MeasureSummaries = std::array<MeasureSummary, kMeasureCount>;

}  // namespace blockrand::compare
