// What every wall segment of an outline faces: street, courtyard, neighbour, passage, or open ground.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/context/address_points.h"
#include "pipeline/context/block_figures.h"
#include "pipeline/context/blocks.h"
#include "pipeline/context/courtyards.h"
#include "pipeline/context/street_network.h"
#include "pipeline/context/wall_view.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/model/building.h"

namespace blockrand::context {

/// m. Nothing farther from a building's outline decides about its edges or its situation, but for what blocks and
/// courtyards that come this near say themselves (ARCHITECTURE.md, law 4).
inline constexpr double kWallSegmentReach = 100;

/// What lies around the buildings of a tile: everything within kWallSegmentReach of their outlines, in metres of the build CRS.
/// More does no harm and changes nothing.
struct Vicinity {
  /// Repaired outlines, the buildings' own too, ascending by id; several entries of one id where an outline has several
  /// polygons. Streets and yards are seen past canopies.
  std::span<const Footprint> footprints;
  std::span<const NetworkLine> lines;
  std::span<const Block> blocks;
  std::span<const BlockFigures> figures;  ///< parallel to `blocks`; only the courtyards' polygons and ids are read
  std::span<const PassageWay> passages;
  std::span<const SitePoint> points;
  std::span<const BuildingAddress> addresses = {};  ///< of the footprints that have one, ascending by id
};

struct WallSegmentOptions {
  /// m. Walls nearer than this touch: party walls. The default of RepairOptions::snap_distance; it does not follow that option.
  double touching = 0.40;
  double min_contact = 0.5;       ///< m. Shorter contacts are corners that touch
  double min_wall_segment = 0.3;  ///< m. Shorter pieces are not made
  double min_view = 2.0;          ///< m. What a wall looks at changes no faster: views are blurred by where walls stand
  double sample_step = 4;         ///< m between places that look out of a wall
  /// m. How far a wall sees: courts are at most this wide (Berlin's widest inner grounds count as open ground).
  double view = 60;
  /// m. A street's line may be this far from its fronts: half of a wide carriageway and a forecourt of 25 m.
  double street_view = 32;
  /// m. Walls of one street front step back and forth by no more than this.
  double max_jog = 3.5;
  /// Of the view, by cosine: a wall that sees hardly anything but streets stands in street space, however it is turned.
  double min_street_only = 0.85;
  double enclosure_step = 5;  ///< m between places that look around: what surrounds a wall changes slowly
  /// Of what the building itself leaves of the view around: how much may be open in a courtyard.
  double max_open = 0.2;
  /// m. Gaps between walls up to this width are alleys where one of their ends is open; courts are mostly wider, and closed.
  double max_alley = 14;
  double max_open_recess = 0.03;  ///< of the view around: added to it, so that one ray of 40 decides nothing
  /// Of the view around: how much of it a courtyard may give to streets. A gateway 4 m wide at 10 m has 0.06.
  double max_street_view = 0.1;
  /// m. Where a street is farther than this, and the building has another front less than half as far, it has its rear
  /// here: a garden, not a forecourt.
  double rear_distance = 18;
};

/// The vicinity of a tile made ready for queries. Read-only after construction, safe to share between threads. Keeps
/// the spans: what they show must outlive it.
class VicinityIndex {
 public:
  explicit VicinityIndex(const Vicinity& vicinity);

  const Vicinity& all() const { return all_; }
  const Scene& scene() const { return scene_; }

  struct Box {
    model::Point2 low, high;  ///< m
    bool meets(const Box& o) const {
      return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
    }
  };
  /// A courtyard: indices of its block and within BlockFigures::courtyards.
  struct Yard {
    std::uint32_t block = 0, courtyard = 0;
    Box box;
  };
  /// A pedestrian area: its rings among the lines.
  struct Square {
    std::vector<std::uint32_t> rings;
    Box box;
  };
  const Courtyard& courtyard(const Yard& yard) const { return all_.figures[yard.block].courtyards[yard.courtyard]; }
  bool contains(const Square& square, model::Point2 p) const;

  std::vector<std::uint32_t> yards_near(const Box& box) const;     ///< indices into yards()
  std::vector<std::uint32_t> squares_near(const Box& box) const;   ///< indices into squares()
  std::vector<std::uint32_t> passages_near(const Box& box) const;  ///< indices into Vicinity::passages
  std::vector<std::uint32_t> points_near(const Box& box) const;    ///< indices into Vicinity::points, ascending
  /// Footprints whose box holds a place, grown by `margin` metres: indices into Vicinity::footprints, ascending.
  std::vector<std::uint32_t> footprints_at(model::Point2 place, double margin) const;
  const std::vector<Yard>& yards() const { return yards_; }
  const std::vector<Square>& squares() const { return squares_; }
  const Box& block_box(std::size_t block) const { return block_boxes_[block]; }

 private:
  Vicinity all_;
  Scene scene_;
  std::vector<Yard> yards_;
  std::vector<Square> squares_;
  std::vector<Box> passage_boxes_, block_boxes_;
  geometry::BoxIndex points_, footprints_;
};

/// The box of a building's outline grown by `margin` metres.
VicinityIndex::Box box_of(const model::Building& building, double margin);

/// Cuts the edges of `building.outline` where their situation changes and labels every wall segment; fills `building.edges`
/// with their entrances and addresses (wall_points.h), `building.trees` and `building.situation`.
///
/// Labels, each the first that applies to a wall segment:
/// * `party_wall`: another building's wall runs the other way within WallSegmentOptions::touching of it, on at least
///   `min_contact` or half of the edge (contacts_of), or it lies in another building.
///   Canopies (building=roof) are no neighbours of a wall, but walls are of a canopy.
/// * `passage`: the portal of a way through the building.
/// * `street`: from most of the wall segment the view straight ahead meets a street, or the wall segment stands on a square.
/// * `courtyard`: a closed courtyard of its block lies before it, or buildings larger than sheds stand around the ground
///   before it, with no more than a glimpse of a street between them, and it is no alley.
/// * `side`: the rest.
/// Where a wall steps back and forth by less than `max_jog` between two wall segments of a street front it is `street`, too;
/// where the street is far and another front of the building much nearer to one, it is none.
///
/// \param address_street  the building's addr:street, or empty: decides which of two fronts is the main one
/// Requires: the building's polygons are among the footprints; rings as model::Ring says. The result depends neither on
/// the order of what surrounds it nor on where a ring starts, and on nothing beyond kWallSegmentReach.
void label_wall_segments(model::Building& building, const VicinityIndex& vicinity, std::string_view address_street = {},
                         const WallSegmentOptions& options = {});

}  // namespace blockrand::context
