// What lies around the buildings of a tile, picked from the context of the whole extract.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "pipeline/base/pack.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/wall_segments.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/model/region.h"

namespace blockrand::context {

/// A Vicinity that holds what it shows. The views of its addresses live as long as the extract.
struct FoundVicinity {
  std::vector<Footprint> footprints;
  std::vector<NetworkLine> lines;
  std::vector<Block> blocks;          ///< the last one has no extent: courtyards that lie in no block stand with it
  std::vector<BlockFigures> figures;  ///< parallel to `blocks`: their courtyards alone
  std::vector<PassageWay> passages;
  std::vector<SitePoint> points;
  std::vector<BuildingAddress> addresses;
};

/// Everything of it that does not number things in this run alone.
void pack(const FoundVicinity& found, base::Packer& out);

/// Labels of buildings from the time when they were measured until their tile takes them over: what the walls of a quarter
/// see is looked at once. Those of a city do not fit into memory. Safe to share between threads.
class KeptLabels {
 public:
  /// Some 3 KB each.
  static constexpr std::size_t kMostBuildings = 10000;
  /// \return null for more than kMostBuildings
  static std::unique_ptr<KeptLabels> of(std::size_t buildings);

  /// Copies what label_wall_segments() wrote.
  void put(std::uint32_t number, const model::Building& building);
  /// Hands the labels over, once. \return whether there were any
  bool take(std::uint32_t number, model::Building& building);

 private:
  struct Labels {
    std::vector<model::WallSegment> edges;
    std::vector<model::NearTree> trees;
    model::BuildingSituation situation;
  };
  std::mutex mutex_;
  std::vector<std::unique_ptr<Labels>> labels_;  ///< by number; null: none, or taken
};

/// Read-only after construction, safe to share between threads; keeps references to what it is made of.
class VicinityFinder {
 public:
  /// \param kept  is filled by the first who labels, or emptied by the second; null: each labels
  enum class Labels : std::uint8_t { fill, take };
  VicinityFinder(const model::Extract& extract, const footprints::FootprintStore& footprints,
                 const ContextExtract& context, KeptLabels* kept = nullptr, Labels use = Labels::take);

  /// Labels the edges of a region's buildings (context::label_wall_segments) with everything around them in view.
  /// \param numbers  of the region's buildings in the store, in their order
  void label_wall_segments(model::Region& region, std::span<const std::uint32_t> numbers) const;

  /// Everything within kWallSegmentReach of `box`, which must not be empty. Numbers of buildings in it are those of the store.
  FoundVicinity vicinity_of(const geometry::PlanBox& box) const;

  /// The buildings at most `distance` metres from `box` along both axes, ascending.
  std::vector<std::uint32_t> buildings_near(const geometry::PlanBox& box, double distance) const {
    return buildings_.near(box, distance);
  }

 private:
  /// Whether labels of the outline in the store are labels of the building.
  bool is_as_stored(const model::Building& building, std::uint32_t number) const;

  const model::Extract& extract_;
  const footprints::FootprintStore& footprints_;
  const ContextExtract& context_;
  KeptLabels* kept_;
  Labels use_;
  geometry::BoxIndex buildings_, lines_, passages_, points_, blocks_, courtyards_;
};

}  // namespace blockrand::context
