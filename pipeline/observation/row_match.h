// Where an image shows the outlines of a row: the rigid movement that brings them onto its edges.
#pragma once

#include <vector>

#include "pipeline/observation/image_windows.h"
#include "pipeline/observation/outline_score.h"

namespace blockrand::observation {

/// One building of a row, as the image is searched for it.
struct SearchedOutline {
  std::vector<WallPiece> pieces;
  geometry::PlanBox box;
  model::Point2 lean;       ///< m: how far the image shows its roof from its ground
  bool lean_known = true;   ///< else it is not to be moved
  model::Point2 ground;     ///< m: how far the image shows the ground, part of `lean`
  model::Point2 per_metre;  ///< of that: of each metre of height; (0, 0) where the height does not matter
  double height = 0;        ///< m, of the roof's edge: what `lean` is reckoned with
  double uncertainty = 0;   ///< of `height`, as its share
};

/// Buildings that move as one.
struct SearchedRow {
  std::vector<SearchedOutline> outlines;
  model::Point2 centre;  ///< m: they turn about it
  double radius = 0;     ///< m: of the farthest wall from there
};

/// Bounds of the search.
struct SearchBounds {
  double shift = 4;     ///< m
  double turn = 3;      ///< degrees
  double at_end = 1.5;  ///< m: no wall moves farther by turning
};

/// What was found. Scores are those of ScoreMap.
struct RowMatch {
  bool seen = false;               ///< enough of the walls lie in the image
  model::Point2 shift;             ///< m
  double turn = 0;                 ///< degrees, counter-clockwise
  double best = 0;                 ///< score there
  double here = 0;                 ///< score without any movement
  double mean = 0, deviation = 0;  ///< of the scores of all displacements
  double second = 0;               ///< the best score of a place elsewhere that is a peak of its own; 0: none
  double weight = 0;               ///< m of wall
  double height_doubt = 0;         ///< m: how far the doubt about heights lets the lean show the roofs elsewhere
  std::vector<double> heights;     ///< m, by outline: those with which roof and ground fit the image best
};

/// RowMatch::height_doubt: the mean over all walls.
double height_doubt(const SearchedRow& row);

/// The best movement within the bounds. \param contrast  as score_outline() has it
RowMatch match_row(const SearchedRow& row, const ImageWindows& windows, const SearchBounds& bounds, double contrast);

}  // namespace blockrand::observation
