#include "pipeline/outputs/gltf/tile_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pipeline/base/text.h"
#include "pipeline/textures/texture_files.h"

namespace blockrand::outputs {
namespace {

/// Of WebP, 0 to 100: beyond it bytes grow faster than what is seen of asphalt.
constexpr int kQuality = 80;
/// Along a side: a PNG has no loss, and few read it.
constexpr int kPngPixels = 1024;
/// Of a metre: pixels that are coarser by less are as asked, as squares have whole numbers of them.
constexpr double kAsAsked = 0.01;

}  // namespace

std::optional<TileGround> write_tile_ground(FinishedTile& tile, const OutputContext& context) {
  if (!context.ground_mesh || context.imagery == nullptr) return std::nullopt;
  TileGround out{context.ground_mesh(tile.region.tile), {}, {}, {}};
  if (out.mesh.squares.empty()) return std::nullopt;
  GroundPicture picture = ground_picture({context.images, context.imagery->images, context.projection}, out.mesh,
                                         context.options.ground_pixel);
  out.cover = std::move(picture.cover);
  if (std::ranges::find(out.cover.shown, true) == out.cover.shown.end()) return out;
  std::string place = tile_glb_path(tile.region.tile);
  place.resize(place.size() - std::string_view(".glb").size());
  out.webp = place + "_ground.webp", out.png = place + "_ground.png";
  tile.files.push_back(context.folder.write(
      out.webp, textures::webp(picture.image.rgb, picture.image.width, picture.image.height, kQuality)));
  tile.files.push_back(context.folder.write(out.png, picture::png(reduced(picture.image, kPngPixels))));
  return out;
}

double lowest_point(const model::GroundMesh& mesh) {
  double low = std::numeric_limits<double>::infinity();
  for (const model::GroundSquare& s : mesh.squares) low = std::min(low, *std::ranges::min_element(s.heights));
  return low;
}

void GroundFigures::add(const TileEntry& entry) {
  if (!entry.ground) return;
  cells_ += entry.ground_cells, bare_ += entry.bare_cells;
  if (entry.bare_cells == entry.ground_cells) return;
  finest_ = tiles_ == 0 ? entry.ground_pixel : std::min(finest_, entry.ground_pixel);
  coarsest_ = std::max(coarsest_, entry.ground_pixel);
  ++tiles_;
}

std::string GroundFigures::text() const {
  if (cells_ == 0) return {};
  if (tiles_ == 0) return "no image shows any of the ground, which is plain";
  std::string pixels = fmt::format("{:.2f}", finest_);
  if (fmt::format("{:.2f}", coarsest_) != pixels) pixels += fmt::format(" to {:.2f}", coarsest_);
  std::string out = fmt::format("{} {} of the ground, pixels of {} m", base::with_thousands(tiles_),
                                tiles_ == 1 ? "picture" : "pictures", pixels);
  if (bare_ > 0)
    out += fmt::format("; no image shows {:.1f} % of the ground, which is plain",
                       100 * static_cast<double>(bare_) / static_cast<double>(cells_));
  return out;
}

std::string GroundFigures::coarser(double asked) const {
  if (tiles_ == 0 || coarsest_ <= asked + kAsAsked * asked) return {};
  return fmt::format(
      "pictures of the ground have pixels of {:.2f} m where --ground-pixel asks for {:.2f} m: no image is finer "
      "there, or the picture of a tile would have more than {} pixels along a side",
      coarsest_, asked, kMostGroundPixels);
}

}  // namespace blockrand::outputs
