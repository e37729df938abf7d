// The report's pictures: which tiles they show, what those tiles give to the scene, and the cameras.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/attribution.h"
#include "pipeline/base/memo.h"
#include "pipeline/base/pack.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "pipeline/outputs/report/report_facts.h"
#include "pipeline/picture/scene.h"

namespace blockrand::outputs {

/// Builds up to this many buildings are pictured whole, unless they are scattered wide: more would be specks in a
/// picture, and cost memory.
inline constexpr std::uint64_t kPicturedBuildings = 4000;

/// Around the densest spot, houses at LoD3 are pictured with every element. Further off their windows and doors are flat. m
inline constexpr double kDetailReach = 75;

/// What the pictures will show, decided before any tile runs, so that only those tiles keep their meshes.
struct PicturePlan {
  std::vector<bool> chosen;     ///< parallel to the shards
  bool whole = true;            ///< every tile is chosen
  std::uint64_t buildings = 0;  ///< seeds of the chosen tiles
  model::Point3 origin;         ///< of the scene: the middle of the densest tile, build CRS
  model::Point2 spot;           ///< where houses stand densest among the chosen tiles, build CRS
  std::vector<bool>
      near_spot;  ///< parallel to the shards: chosen, and a building may stand within the reach of the spot
};

/// Chooses the tile with the most buildings and its neighbours by distance, until the next would exceed `budget` or lies
/// more than some tiles away.
PicturePlan plan_pictures(std::span<const footprints::Shard> shards, const footprints::RepairedExtract& repaired,
                          const georef::Projection& projection, std::uint64_t budget = kPicturedBuildings);

/// A building in the scene: the box of its bodies, and the ground under it.
struct PicturedBuilding {
  picture::Box box;
  double ground = 0;      ///< m
  bool detailed = false;  ///< it stands in PictureTile::detail, too
};

struct PictureTile {
  picture::Scene scene;                     ///< bodies
  std::vector<PicturedBuilding> buildings;  ///< object k of the scenes is buildings[k]
  picture::Scene flat;    ///< windows and doors as flat pieces a little before the walls, what stands on roofs
  picture::Scene detail;  ///< of buildings at the densest spot: all of LoD3
};

/// A PictureTile as it is kept: packed, with what names it, so that pictures that an earlier run took of the same tiles are found without
/// looking into them; or as it was made, where nothing is kept.
struct PackedPictureTile {
  std::string sha256;  ///< of `bytes`; empty where nobody asks
  std::uint64_t buildings = 0;
  std::string bytes;
  std::shared_ptr<PictureTile> as_made;  ///< null: packed
};

/// \param kept  whether it is packed, and says its hash
PackedPictureTile pack_picture(PictureTile&& tile, bool kept);

/// The bodies of a finished tile, with windows and doors as flat pieces of their walls where it has any; empty for a tile that is not pictured. Pure: safe for different tiles at the same
/// time.
/// \param shard  the tile's index
PictureTile picture_tile(const model::Region& region, const PicturePlan& plan, std::size_t shard);

/// Collects tiles and takes the pictures: an overview, the same from the other side, and the densest spot.
class Pictures {
 public:
  explicit Pictures(const PicturePlan& plan)
      : plan_(plan), scene_(plan.origin), flat_(plan.origin), detail_(plan.origin) {}

  /// Takes a tile; call in tile order.
  void add(PackedPictureTile&& tile);
  /// The pictures, on up to `workers` threads; none where no building has a solid. The same bytes for any number of
  /// threads. Leaves the collection empty, so that its memory is free.
  /// \param memo         where those of an earlier run are found again, if tiles are named; null: none
  /// \param attribution  for their corner
  std::vector<outputs::ReportPicture> take(int workers, const base::Memo* memo = nullptr,
                                           std::string_view attribution = base::kAttribution);
  /// What they show, where that is not the whole build.
  std::string note() const;

 private:
  /// Puts the tiles into one scene of each kind.
  void join();
  void lay_ground();
  std::vector<outputs::ReportPicture> shoot(int workers, std::string_view attribution);
  PicturePlan plan_;
  std::vector<PackedPictureTile> tiles_;  ///< as they came
  picture::Scene scene_, flat_, detail_;
  std::vector<PicturedBuilding> buildings_;
};

}  // namespace blockrand::outputs

/// Of what is kept: packed.
template <>
struct blockrand::base::PackTraits<blockrand::outputs::PackedPictureTile> {
  static void pack(Packer& out, const outputs::PackedPictureTile& tile) {
    out << tile.sha256 << tile.buildings << tile.bytes;
  }
  static void unpack(Unpacker& in, outputs::PackedPictureTile& tile) {
    in >> tile.sha256 >> tile.buildings >> tile.bytes;
  }
};
