// What lies around the buildings of a tile, picked from the context of the whole extract.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
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

/// What label_wall_segments() found of buildings, for those who ask again: buildings are labelled to be measured, then with their tile,
/// and a few as neighbours of another. Safe to share between threads.
class LabelledBuildings {
 public:
  /// What is found anew costs a millisecond a building and no memory.
  static constexpr std::size_t kMostBytes = 32'000'000;

  /// Puts in what is known of a building of the store. \returns whether it is
  bool recall(std::uint32_t number, model::Building& building) const;
  /// Keeps what is known, while there is room.
  void keep(std::uint32_t number, const model::Building& building);

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::uint32_t, std::string> packed_;
  std::size_t bytes_ = 0;
};

/// Read-only after construction but for what it keeps, safe to share between threads; keeps references to what it is made of.
class VicinityFinder {
 public:
  /// \param labelled  shared with others of the same extract, footprints and context; null: nothing is kept
  VicinityFinder(const model::Extract& extract, const footprints::FootprintStore& footprints,
                 const ContextExtract& context, std::shared_ptr<LabelledBuildings> labelled = nullptr);

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
  const model::Extract& extract_;
  const footprints::FootprintStore& footprints_;
  const ContextExtract& context_;
  std::shared_ptr<LabelledBuildings> labelled_;  ///< null: everything is found anew
  geometry::BoxIndex buildings_, lines_, passages_, points_, blocks_, courtyards_;
};

}  // namespace blockrand::context
