// A comparison as files: compare.json, compare.csv, compare.gpkg and compare.html.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

struct ReportOptions {
  int pictures = 200;       ///< matches with elevations and pictures in the page, those with the largest distance (RMS)
                            ///< first; the others have a plan and numbers
  int picture_width = 360;  ///< pixels
  double heat_range = 2.0;  ///< m: the distance that has the last colour of the heat map
};

/// "key", "value" as they were asked for, in order: into compare.json and the foot of the page.
using OptionList = std::vector<std::pair<std::string, std::string>>;

/// Distances in m from points (relative to City::origin, the model's own z) of one side of a match to the nearest
/// surface of the other side, as they were measured: for heat maps. Called from several threads at once.
using DistanceQuery =
    std::function<std::vector<float>(const MatchResult& match, bool from_model, std::span<const Point3> points)>;

/// What compare.json says of itself. The version changes when a reader of the old one would misread the new one.
inline constexpr std::string_view kJsonFormat = "blockrand-compare";
inline constexpr int kJsonFormatVersion = 1;

/// Everything as JSON (two spaces, keys in a fixed order, a format version): files, registration, summaries, confusion,
/// distribution, totals, unmatched, and every match with every measure. The input of --baseline.
std::string comparison_json(const Comparison& comparison, const OptionList& options);
/// One row per match, one column per measure (`counted`), each with `_all`; RFC 4180, '.' as decimal point. Ids
/// that begin like a formula have an apostrophe before them.
std::string comparison_csv(const Comparison& comparison);
/// Writes a GeoPackage with the layers `matches` (the reference's footprints, every measure), `model`, `reference`
/// (footprints with id and what became of them: matched, missing, extra).
/// \throws base::OutputError
void write_geopackage(const Comparison& comparison, const std::string& path);
/// One self-contained page: no script or picture from elsewhere.
std::string comparison_html(const Comparison& comparison, const OptionList& options, const DistanceQuery& distances,
                            const ReportOptions& report, int jobs);
/// The tables for a terminal.
std::string comparison_text(const Comparison& comparison);

/// What --baseline found.
struct BaselineResult {
  struct Line {
    std::string measure;  ///< id
    double before = 0, after = 0;
    double worse_by = 0;  ///< share of the way: 0.02 is 2 % worse; negative is better
    bool fails = false;
  };
  std::vector<Line> lines;        ///< of every judged measure (Better other than none) with a value in both, and of
                                  ///< missing_area and extra_area (m²), where the baseline has them
  std::vector<std::string> lost;  ///< measures that the baseline has and this comparison has not, or in fewer matches
  std::vector<std::string> lost_buildings;  ///< ids of the reference's that the baseline has a match for
  std::vector<std::string> differs;         ///< CRS, heights and options: why the two may not be comparable
  bool worse() const;  ///< a line fails, or something is lost: leaving buildings out must not pass as progress
};
/// Compares what is `counted`, pooled. Worse is farther from the ideal, and fails where by more than `allowed` (0.02):
/// higher: the value falls by more than that share of the baseline's; one: the ratios go away from 1 by more than that
/// factor (mean of |log ratio| over the matches, so that 1.30 to 1.33 counts like 1.00 to 1.02); lower, and zero by its
/// mean size (MAE): the value grows by more than that share and by more than rounding (1 mm, 0.01 degrees, 1e-6 of
/// shares and counts, 0.1 m² of areas).
///
/// Lost are buildings of the reference that had a match and have none (how they are grouped into matches does not
/// matter), and measures without a value any more, or with one in fewer matches and for fewer of the reference's
/// buildings, both by more than `allowed`. `options` are set against the baseline's, where there are any.
/// \throws base::InputError  when the text is no compare.json of a known format version
BaselineResult compare_with_baseline(const Comparison& comparison, const std::string& baseline_json,
                                     const std::string& baseline_path, double allowed, const OptionList& options = {});
std::string baseline_text(const BaselineResult& verdict);
/// What is worse in one line, "eaves_error, missing_area, 2 buildings lost"; empty where nothing is.
std::string failed_text(const BaselineResult& verdict);

}  // namespace blockrand::compare
