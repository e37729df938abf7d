// A comparison as files: compare.json, compare.csv, compare.gpkg and compare.html.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

struct ReportOptions {
  int pictures = 200;          ///< matches with drawings and pictures in the page, those with the largest distance first
  int picture_width = 360;     ///< pixels
  double heat_range = 2.0;     ///< m: the distance that has the last colour of the heat map
};

/// "key", "value" as they were asked for, in order: into compare.json and the foot of the page.
using OptionList = std::vector<std::pair<std::string, std::string>>;

/// Distances in m from points (relative to City::origin, the model's own z) of one side of a match to the nearest surface
/// of the other side, as they were measured: for heat maps.
using DistanceQuery = std::function<std::vector<float>(const MatchResult& match, bool from_model, std::span<const Point3> points)>;

/// Everything as JSON (two spaces, keys in a fixed order, a format version): files, registration, summaries, confusion,
/// distribution, totals, unmatched, and every match with every measure. The input of --baseline.
std::string comparison_json(const Comparison& comparison, const OptionList& options);
/// One row per match, one column per measure (`counted`), each with `_all`; RFC 4180, '.' as decimal point.
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
struct BaselineVerdict {
  struct Line {
    std::string measure;  ///< id
    double before = 0, after = 0;
    double worse_by = 0;  ///< share of the way: 0.02 is 2 % worse; negative is better
    bool fails = false;
  };
  std::vector<Line> lines;  ///< of every judged measure (Better other than none) with a value in both
  std::vector<std::string> lost;  ///< measures or matches that the baseline has and this comparison has not
  bool worse() const;
};
/// Compares pooled values. Worse is farther from the ideal: higher (1), lower (0), zero (0, of mean_abs), one (1, of |log|
/// of the ratio). `allowed`: share (0.02); measures in metres, degrees and counts are worse when they grow by more than that share
/// and by more than rounding (1 mm, 0.01 degrees, 1e-6); shares when they fall by more than `allowed` of the baseline's value.
/// \throws base::InputError  when the text is no compare.json of a known format version
BaselineVerdict compare_with_baseline(const Comparison& comparison, const std::string& baseline_json,
                                      const std::string& baseline_path, double allowed);
std::string verdict_text(const BaselineVerdict& verdict);

}  // namespace blockrand::compare
