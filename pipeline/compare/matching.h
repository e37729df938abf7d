// Which buildings of two models stand for each other, and where the models lie to each other.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

struct MatchOptions {
  /// Intersection over union from which on two buildings are the same house.
  double certain_overlap = 0.5;
  /// Share of the smaller footprint that two buildings have in common from which on they stand for each other.
  double link_share = 0.5;
  /// What is left unmatched is linked to its best partner from this share of its own footprint on: the same house,
  /// drawn badly or built on.
  double rest_share = 0.25;
  /// m. How far apart the same building may lie in two models for the first guess of an offset.
  double largest_offset = 30;
};

/// Buildings that stand for each other: 1:1, 1:n, n:1 or n:m. Indices ascending.
struct Match {
  std::vector<std::uint32_t> model, reference;
};

/// Matches by area. Two of the same house are certain; then, as comparisons of OSM with surveys do (Hecht, Kunze and
/// Hahmann 2013; Fan, Zipf, Fu and Neis 2014): buildings are linked by what they have in common of the smaller one (not
/// with one that is larger than a certain pair, such as a garage under six houses); all that hangs together is one
/// match. In the order of the reference's first building. \param shift  taken off the model's places before
std::vector<Match> match_buildings(const City& model, const City& reference, Point2 shift,
                                   const MatchOptions& options = {});

/// Where the models lie to each other. The first guess is the shift that most pairs of footprints of the same size
/// agree on (a vote in cells of 1 m; five at least), where the models hardly fit without it; then matches and
/// the median shift of their centroids are found in turn until the shift stays. Medians over matches of one building
/// each that are certain; over all matches where there are none of these. Nothing is moved.
/// \param absolute  heights of both are over the same surface: the vertical offset is estimated too
Registration register_models(const City& model, const City& reference, bool absolute, const MatchOptions& options = {});

/// Share of each building's footprint that footprints of the other city cover. \param shift  added to the buildings'
/// places
std::vector<double> covered_shares(const City& city, const std::vector<std::uint32_t>& buildings, const City& other,
                                   Point2 shift);

/// Moves a city: footprints, faces, openings, shells, grounds.
void move(City& city, Point3 by);

}  // namespace blockrand::compare
