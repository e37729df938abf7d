// What mapped objects claim of the ground: streets as wide as they are, water, green, blocks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/context/context_extract.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/line_area.h"
#include "pipeline/geometry/plane_partition.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/surroundings.h"
#include "pipeline/surroundings/catalogue.h"
#include "pipeline/surroundings/ground_height.h"
#include "pipeline/surroundings/kinds.h"
#include "pipeline/surroundings/street_controls.h"

namespace blockrand::surroundings {

/// What the stage reads of an extract; outlives it and changes no more.
struct SurroundingInputs {
  const model::Extract& extract;
  const footprints::FootprintStore& footprints;
  const context::ContextExtract& context;
  const context::VicinityFinder& vicinity;
  const georef::Projection& projection;
  const Catalogue& catalogue;
};

/// A feature that the surroundings are asked for.
struct Thing {
  std::uint32_t feature = 0;  ///< index into Extract::features
  SurroundingKind kind = SurroundingKind::other;
  std::optional<model::SurroundingState> hidden;
  bool wide = false;        ///< an area that spans more than kWidest
  bool keeps_left = false;  ///< vehicles keep to the left: driving_side, else where it begins
};

/// Whose a piece of ground is.
struct GroundLabel {
  bool building = false;  ///< no ground at all
  model::GroundClass ground = model::GroundClass::land;
  model::OsmId object;  ///< number 0: what stands around tells
  model::SurroundingMaterial material = 0;
  float offset = 0;  ///< m above the terrain
  /// m above the height reference: level ground, whatever the terrain does below it.
  std::optional<double> level = std::nullopt;
  float trees_per_hectare = 0;
  bool wide = false;  ///< Thing::wide: counts_in says where it counts
};

/// Claims of the ground of some squares, the strongest first, and whose they are.
struct GroundClaims {
  std::vector<geometry::AreaClaim> claims;
  std::vector<GroundLabel> labels;  ///< AreaClaim::label indexes them
};

/// m. Kerbs of streets [RASt 06, FGSV 2006: 10 to 14 cm], and how far the surface of water lies below its banks: what is seen
/// of a wall of a canal at least.
inline constexpr float kKerb = 0.12f, kBank = 0.5f;

/// Degrees: an area that spans more claims ground near its lines alone, as far as kWideReach. Whoever reads a part of an extract (a tile
/// alone, an area: 3 km) knows it where its lines come near, and nowhere else (importers::osm::kWholeSpan).
inline constexpr double kWidest = 1, kWideReach = 2000;

/// m: longer runs of bridges are not put together: what a tile sees of its bridges lies within reach.
inline constexpr double kMostRun = 2000;
/// m: runs whose crossings are looked for; longer ones cross something.
inline constexpr double kLookedThrough = 300;
/// m from the ends of a bridge within which the ground is that of its approach, not what it crosses.
inline constexpr double kApproach = 8;

/// m: how far from its line the ground of a street reaches at most, and buildings stand that make a street one of a town.
inline constexpr double kStreetReach = 40, kBuiltUpReach = 25;

/// Whether a claim counts in a square: one that is wide does where its lines are near the square's middle.
bool counts_in(SquareIndex square, const geometry::AreaClaim& claim, const GroundLabel& label);

/// Finds what claims the ground of a place. Read-only once made, safe to share between threads.
class ClaimFinder {
 public:
  explicit ClaimFinder(const SurroundingInputs& inputs);

  const std::vector<Thing>& things() const { return things_; }
  /// The coastlines among them.
  const std::vector<std::uint32_t>& coasts() const { return coasts_; }
  /// The things at most `distance` metres from a box along both axes, ascending by feature.
  std::vector<std::uint32_t> things_near(const geometry::PlanBox& box, double distance) const {
    return boxes_.near(box, distance);
  }
  /// Of a thing: its rings or lines in metres on the grid, as mapped.
  std::vector<std::vector<model::Point2>> lines_of(const Thing& thing) const;
  /// The value of a tag of a feature.
  TagOf tags_of(std::uint32_t feature) const;
  /// A line in pieces of about kJudgedPiece, each of which is one of a town or not.
  static std::vector<std::vector<model::Point2>> judged_pieces(const std::vector<model::Point2>& line);
  /// Whether houses stand around a line.
  bool is_built_up(std::span<const model::Point2> line) const;

  /// Whether a feature's tags claim any ground.
  bool claims_ground(const Thing& thing) const;
  /// How many ways of streets meet at a node: an end once, a node within a way twice.
  std::size_t streets_at(std::int64_t node) const;
  /// What a node of a street is as a crossing.
  CrossingMarking crossing_at(std::int64_t node) const;
  /// What makes vehicles stop at a node.
  StreetControl control_at(std::int64_t node) const;
  /// How many ways of tracks in the open meet at a node: as streets_at.
  std::size_t tracks_at(std::int64_t node) const;
  /// The lines of wires that have a node, as things, ascending.
  std::vector<std::uint32_t> wires_at(std::int64_t node) const;
  /// The feature that a node is.
  std::optional<std::uint32_t> feature_of_node(std::int64_t node) const;
  /// Whether a building that stands on the ground has a place.
  bool building_at(model::Point2 place) const;
  /// The thing that an object is; null: none.
  const Thing* thing_of(model::OsmId id) const;
  /// m: half of the opening of a barrier at one of its nodes: `street` where one of a street is, `gate` where a gate is, else 0.
  double opening_at(std::int64_t node, double street, double gate) const;

  /// The bridges that a bridge goes on in, as long as no third one meets them and the run is not longer than kMostRun.
  struct BridgeRun {
    model::Point2 start, end;  ///< of the whole run
    double length = 0;         ///< m of it
    double before = 0;         ///< m of it before this bridge
    double layer = 1;          ///< the highest of its bridges
    bool crosses_traffic =
        false;  ///< a street, railway or way lies below, away from its ends; taken for granted of long runs
    std::vector<model::Point2> line;  ///< m, all of it
  };
  BridgeRun bridge_run(const Thing& thing) const;

  /// The boxes of the blocks that come into a box.
  std::vector<geometry::PlanBox> blocks_near(const geometry::PlanBox& box) const;

  /// Everything that claims ground within a box.
  GroundClaims claims_in(const geometry::PlanBox& box) const;

 private:
  struct Entry;
  void add_street(const Thing& thing, const geometry::PlanBox& box, std::vector<Entry>& out) const;
  void add_street_piece(const Thing& thing, const TagOf& tag, const std::vector<model::Point2>& line,
                        geometry::LineEnd start, geometry::LineEnd end, std::vector<Entry>& out) const;
  bool crosses_traffic(const BridgeRun& run) const;
  /// An area, or a line that ends where it begins.
  bool is_closed(const model::Feature& feature) const;
  void add_railway(const Thing& thing, std::vector<Entry>& out) const;
  void add_waterway(const Thing& thing, std::vector<Entry>& out) const;
  void add_area(const Thing& thing, std::vector<Entry>& out) const;
  void add_passages(const geometry::PlanBox& box, std::vector<Entry>& out) const;
  void add_buildings(const geometry::PlanBox& box, std::vector<Entry>& out) const;
  void add_sea(const geometry::PlanBox& box, std::vector<Entry>& out) const;
  void add_blocks(const geometry::PlanBox& box, std::vector<Entry>& out) const;
  SurroundingInputs in_;
  std::vector<Thing> things_;
  std::vector<std::uint32_t> coasts_;  ///< things that are coastlines
  geometry::BoxIndex boxes_;           ///< of things_
  geometry::BoxIndex blocks_;          ///< of ContextExtract::blocks
  geometry::BoxIndex passages_;
  std::vector<std::pair<std::int64_t, std::uint32_t>> bridge_ends_;  ///< node and thing, ascending
  std::vector<std::pair<std::int64_t, CrossingMarking>> crossings_;  ///< nodes, ascending
  std::vector<std::pair<std::int64_t, StreetControl>> controls_;     ///< nodes, ascending
  std::vector<std::pair<std::int64_t, std::uint32_t>> wire_nodes_;   ///< node and thing, ascending
  std::vector<std::int64_t> track_nodes_;                            ///< as street_nodes_
  std::vector<std::int64_t> gates_;                                  ///< nodes, ascending
  std::vector<std::int64_t> street_nodes_;  ///< of ways of streets, an end once, a node within twice; ascending
};

}  // namespace blockrand::surroundings
