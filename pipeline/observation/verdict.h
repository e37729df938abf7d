// Is what an image shows of a row enough to move it?
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "pipeline/observation/imagery.h"
#include "pipeline/observation/row_match.h"

namespace blockrand::observation {

struct Verdict {
  RowState state = RowState::outside;
  std::string_view reason{};  ///< empty for `corrected`
  double confidence = 0;      ///< that the row stands within 0.6 m of where the match says, [0, 1]
  bool by_height = false;     ///< it is undecided since another height of its roofs explains the movement as well
};

/// m: less is the error of the search.
inline constexpr double kLeastCorrection = 0.4;
/// A correction is offered from this confidence on: of the right houses of the set `tuning` at most 2 % are moved then.
inline constexpr double kSureCorrection = 0.6;

/// Where one image shows a row, and how sure that is.
struct SeenPlace {
  Verdict verdict;
  model::Point2 shift;   ///< m
  std::string date{};    ///< of the image; empty: unknown
  model::Point2 lean{};  ///< m for each metre of height, at the row
};

/// What two images say of one row together. Where both show it at one place, and are not the same flight (their dates or their leans
/// differ), that is surer than what either says, and may be
/// enough for a correction though neither was; where they show it at different places one of them at least is wrong. Else the
/// surer one is right.
/// \returns  whether `b` is the one to go by, and the verdict
std::pair<bool, Verdict> joined(const SeenPlace& a, const SeenPlace& b);

/// \param lean_known  how far the image shows the row's roofs from their ground
/// \param by_height   other heights of its roofs, as likely as those that were reckoned with, would show them there too
Verdict judge(const RowMatch& match, bool lean_known, bool by_height = false);

/// A movement along the lean of roofs whose heights nobody told is perhaps only another height: judge()'s `by_height`.
bool explained_by_height(const SearchedRow& row, const RowMatch& match);

}  // namespace blockrand::observation
