#include "pipeline/observation/verdict.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::observation {

namespace {

/// Deviations: a movement that gains less is none; a place that is less better than another one is not known. The second
/// holds for rows of so many m of wall and more: that many walls seldom agree on a wrong place.
constexpr double kLeastGain = 0.8, kLeastMargin = 0.5, kLeastMarginLong = 0.25, kLongWalls = 150;

/// Weights of a logistic regression (fit.py of tests/bench/imagery) on rows of one real image and of synthetic ones, of which half
/// were moved by known amounts, where the search found a movement; what is measured is cut at the values behind which nothing
/// changes.
double confidence_of(const RowMatch& m) {
  const double shift = std::sqrt(m.shift.x * m.shift.x + m.shift.y * m.shift.y);
  const double sum =
      -3.12 + 0.46 * std::min(3.0, (m.best - m.here) / m.deviation) +
      0.63 * std::min(2.5, (m.best - m.second) / m.deviation) + 0.18 * std::min(4.5, (m.best - m.mean) / m.deviation) +
      2.38 * m.best + 0.16 * base::log(m.weight / 50) - 3.59 * std::max(0.0, shift - 2.8) -
      0.95 * std::min(2.0, m.height_doubt) + 0.29 * base::log(std::max(1.0, static_cast<double>(m.heights.size())));
  return 1 / (1 + base::exp(-sum));
}

/// How many times its uncertainty a height may be off, so that the lean explains a movement; m: how far beside the lean's
/// direction that still holds; m: less of a lean explains nothing.
constexpr double kHeightDoubt = 2.5, kBesideLean = 0.5, kLeastLean = 0.4;

/// m: places of one row in two images that are one; places that are two for certain.
constexpr double kSamePlace = 0.5, kOtherPlace = 1.0;
/// Confidence: an image that is less sure does not speak for or against another.
constexpr double kSpeaks = 0.3;
/// Two images that are both wrong show the same wrong place as often: chance alone would give 0.02, but trees, and heights that
/// are taken for others, stand in both.
constexpr double kWrongAlike = 0.3;

/// m for each metre of height: leans that differ by more are those of two pictures.
constexpr double kOtherLean = 0.05;

double length_of(model::Point2 v) { return std::sqrt(v.x * v.x + v.y * v.y); }

/// Two copies of one picture, or what two tiles of one mosaic share, are one witness.
bool other_flight(const SeenPlace& a, const SeenPlace& b) {
  return (!a.date.empty() && !b.date.empty() && a.date != b.date) ||
         length_of({a.lean.x - b.lean.x, a.lean.y - b.lean.y}) > kOtherLean;
}

}  // namespace

std::pair<bool, Verdict> joined(const SeenPlace& a, const SeenPlace& b) {
  const bool second = b.verdict.confidence > a.verdict.confidence;
  const SeenPlace &sure = second ? b : a, &other = second ? a : b;
  Verdict verdict = sure.verdict;
  const double c = sure.verdict.confidence, d = other.verdict.confidence;
  if (d < kSpeaks) return {second, verdict};
  const double apart = length_of({sure.shift.x - other.shift.x, sure.shift.y - other.shift.y});
  if (apart <= kSamePlace) {
    if (!other_flight(a, b)) return {second, verdict};
    verdict.confidence = c * d / (c * d + (1 - c) * (1 - d) * kWrongAlike);
    const bool open =
        verdict.state == RowState::undecided && !verdict.by_height && length_of(sure.shift) >= kLeastCorrection;
    if (open && verdict.confidence >= kSureCorrection) verdict.state = RowState::corrected, verdict.reason = {};
  } else if ((apart > kOtherPlace || other.verdict.state == RowState::left_alone) &&
             verdict.state == RowState::corrected) {
    // One of them is right, or neither.
    verdict.confidence = c * (1 - d) / (1 - c * d);
    if (verdict.confidence < kSureCorrection)
      verdict.state = RowState::undecided, verdict.reason = "another image shows it at another place";
  }
  return {second, verdict};
}

Verdict judge(const RowMatch& match, bool lean_known, bool by_height) {
  if (!match.seen) return {RowState::outside, "too little of its walls lies in an image", 0};
  if (match.deviation <= 0) return {RowState::undecided, "the image shows nothing there", 0};
  if (!lean_known) return {RowState::undecided, "how far roofs lean in the image is not known there", 0};
  const double confidence = confidence_of(match);
  const double size = std::sqrt(match.shift.x * match.shift.x + match.shift.y * match.shift.y);
  if (size < kLeastCorrection && std::fabs(match.turn) < 1)
    return {RowState::left_alone, "it stands where the image shows it", confidence};
  if (match.best - match.here < kLeastGain * match.deviation)
    return {RowState::left_alone, "it stands nearly as well where it is mapped", confidence};
  if (by_height) return {RowState::undecided, "another height of its roof would explain it as well", confidence, true};
  const double margin = match.weight < kLongWalls ? kLeastMargin : kLeastMarginLong;
  if (match.best - match.second < margin * match.deviation)
    return {RowState::undecided, "another place fits nearly as well", confidence};
  if (confidence < kSureCorrection)
    return {RowState::undecided, "the edges in the image do not say it clearly", confidence};
  return {RowState::corrected, {}, confidence};
}

bool explained_by_height(const SearchedRow& row, const RowMatch& match) {
  model::Point2 lean;
  double length = 0;
  for (const SearchedOutline& o : row.outlines) {
    double own = 0;
    for (const WallPiece& p : o.pieces) own += p.length;
    lean.x += own * o.per_metre.x * o.height, lean.y += own * o.per_metre.y * o.height;
    length += own;
  }
  const double size = std::sqrt(lean.x * lean.x + lean.y * lean.y);
  if (length <= 0 || size < kLeastLean * length) return false;
  const double along = std::fabs(match.shift.x * lean.x + match.shift.y * lean.y) / size,
               across = std::fabs(match.shift.x * lean.y - match.shift.y * lean.x) / size;
  return across <= kBesideLean && along <= kHeightDoubt * match.height_doubt;
}

}  // namespace blockrand::observation
