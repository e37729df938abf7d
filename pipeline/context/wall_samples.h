// What a place on a wall looks at.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/context/wall_contacts.h"
#include "pipeline/geometry/box_index.h"

namespace blockrand::context {

/// What can matter for one building, gathered once.
struct BuildingView {
  const VicinityIndex* index = nullptr;
  model::OsmId own;                    ///< of the building
  std::vector<std::uint32_t> yards;    ///< into VicinityIndex::yards
  geometry::BoxIndex yard_boxes;       ///< of `yards`: a house may have a thousand of them
  std::vector<std::uint32_t> squares;  ///< into VicinityIndex::squares
};
/// The boxes of courtyards, in the order of `yards`, which are indices into VicinityIndex::yards.
geometry::BoxIndex yard_boxes(std::span<const std::uint32_t> yards, const VicinityIndex& index);
BuildingView view_of(const model::Building& building, const VicinityIndex& index);

/// What is seen from one place.
struct WallSample {
  double at = 0;                    ///< m along the edge
  std::array<Sight, kFanRays> fan;  ///< from right to left, as fan_around
  /// party_wall (within another building), street, courtyard (a closed one), or unknown: enclosure_at tells
  model::WallSegmentKind kind = model::WallSegmentKind::unknown;
  double ahead = 0;                 ///< [0, 1]: how much of the view straight ahead ends in a street it may front
  double street_share = 0;          ///< [0, 1]: how much of the whole view ends in a street, by cosine
  double street_distance = 0;       ///< m, mean over the rays of `ahead`, straight ahead
  std::uint32_t square = kNothing;  ///< stands on it: index into VicinityIndex::squares
  std::uint32_t yard = kNothing;    ///< a courtyard before it: index into VicinityIndex::yards
  std::uint32_t inside = kNothing;  ///< lies within this footprint
};

/// \param at  m along the edge
WallSample look_out(const OutlineEdge& edge, double at, const BuildingView& view, const WallSegmentOptions& options);

/// What surrounds the ground before a place on a wall.
struct Enclosure {
  double own = 0;      ///< [0, 1] of the view around: ends at the building itself within WallSegmentOptions::view
  double others = 0;   ///< [0, 1]: ends at other buildings
  double street = 0;   ///< [0, 1]: ends in a street; what is left is open ground
  bool alley = false;  ///< a gap between walls that leads to a street or to open ground
  void divide(double by) {
    own /= by;
    others /= by;
    street /= by;
  }
  /// Of what the building itself leaves of the view, how much may be open in a courtyard; and how much at most in recesses
  /// where that is next to nothing.
  bool is_court(const WallSegmentOptions& options) const { return shortage(options) <= 0; }
  /// How far that is from changing, of the view around.
  double margin(const WallSegmentOptions& options) const { return std::fabs(shortage(options)); }
  static constexpr double kCertain = 0.1;  ///< a larger margin makes nobody surer

 private:
  static constexpr double kAlleyMargin = 0.1;  ///< alleys are as clear as a tenth of the view
  double shortage(const WallSegmentOptions& options) const {
    if (alley) return kAlleyMargin;
    return std::max(street - options.max_street_view,
                    1 - own - others - options.max_open * (1 - own) - options.max_open_recess);
  }
};

/// The view around from the ground before a wall: the mean of two places, 4 m and 12 m before it (nearer where walls
/// stand opposite: half the way). From the wall alone a house across a street of gardens would look like a courtyard.
///
/// \param own      the building
/// \param in_yard  an open courtyard was found before the wall: gaps in it lead out only where a street is seen
Enclosure enclosure_at(const OutlineEdge& edge, double at, model::OsmId own, bool in_yard, const BuildingView& view,
                       const WallSegmentOptions& options);

}  // namespace blockrand::context
