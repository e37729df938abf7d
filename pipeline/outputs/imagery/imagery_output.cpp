#include "pipeline/outputs/imagery/imagery_output.h"

#include <algorithm>
#include <cmath>

#include "pipeline/outputs/buildings_here.h"
#include "pipeline/outputs/imagery/imagery_document.h"
#include "pipeline/outputs/imagery/imagery_page.h"
#include "pipeline/outputs/imagery/overlay.h"

namespace blockrand::outputs {
namespace {

/// m: the finest pixel of the pictures of tiles. Pixels: of their longer side, about.
constexpr double kOverlayPixel = 0.2, kOverlaySide = 1800;

class ImageryOutput : public OutputOf<std::vector<base::PublishedFile>> {
 public:
  explicit ImageryOutput(const OutputContext& context) : context_(context) {}

  /// The tile's image with its outlines. Not one of the tile's files: a tile that is built alone has none.
  std::any write_tile(FinishedTile& tile) const override {
    std::vector<base::PublishedFile> files;
    const observation::ImageryObservations& seen = *context_.imagery;
    if (!context_.options.imagery_pictures) return files;
    geometry::PlanBox box;
    std::vector<std::uint32_t> buildings;
    for (std::uint32_t i = 0; i < context_.shards[tile.shard].seeds.size(); ++i) {
      const std::uint32_t b = context_.repaired.first[tile.shard] + i;
      if (seen.outlines[b].image >= seen.images.size()) continue;
      box.include(context_.repaired.footprints[b].box);
      buildings.push_back(b);
    }
    if (box.empty()) return files;
    constexpr double kMargin = 10;  // m
    box = {{box.minimum.x - kMargin, box.minimum.y - kMargin}, {box.maximum.x + kMargin, box.maximum.y + kMargin}};
    const double longest = std::max(box.maximum.x - box.minimum.x, box.maximum.y - box.minimum.y);
    const double pixel = std::max(kOverlayPixel, std::ceil(10 * longest / kOverlaySide) / 10);
    files.push_back(context_.folder.write(
        "imagery/" + tile.name + ".png",
        picture::palette_png(draw_overlay(inputs(), box, pixel, buildings, most_told(buildings)), 128)));
    files.push_back(context_.folder.write("imagery/" + tile.name + ".pgw", overlay_world_file(box, pixel)));
    return files;
  }
  void take(const FinishedTile&, std::any product) override {
    for (base::PublishedFile& file : *std::any_cast<std::vector<base::PublishedFile>>(&product))
      overlays_.push_back(std::move(file));
  }
  void finish(const FinishedBuild& build) override {
    const std::string text = imagery_json(*context_.imagery, context_.repaired.footprints,
                                          buildings_here(context_.repaired, context_.shards, context_.alone));
    build.files.push_back(context_.folder.write("imagery.json", text));
    if (context_.options.imagery_pictures) {
      std::vector<std::string> paths;
      for (const base::PublishedFile& file : overlays_) paths.push_back(file.path);
      build.files.push_back(context_.folder.write("imagery.html", imagery_page(inputs(), paths)));
    }
    build.files.insert(build.files.end(), overlays_.begin(), overlays_.end());
  }

 private:
  /// The image that speaks of most of the buildings.
  std::uint32_t most_told(const std::vector<std::uint32_t>& buildings) const {
    std::vector<std::size_t> counts(context_.images.size(), 0);
    for (const std::uint32_t b : buildings)
      if (const std::uint32_t image = context_.imagery->outlines[b].image; image < counts.size()) ++counts[image];
    return static_cast<std::uint32_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
  }
  OverlayInputs inputs() const {
    return {*context_.imagery, context_.repaired.footprints, context_.images, context_.projection,
            attribution(context_)};
  }

  const OutputContext& context_;
  std::vector<base::PublishedFile> overlays_;
};

}  // namespace

OutputFormat imagery_output() {
  return {
      .name = "imagery.json",
      .in_formats = false,
      .places = {{"imagery.json", "what the aerial images show: whether they fit, a receipt for every building"},
                 {"imagery.html", "what they changed, with pictures",
                  [](const OutputOptions& o, std::uint64_t) { return o.imagery_pictures; }}},
      .manual = {{"imagery.json", "with --imagery: whether each image fits, and a receipt for every building"},
                 {"imagery.html, imagery/", "the largest corrections, and the images with all outlines, tile by tile"}},
      .asked = [](const OutputOptions& o) { return o.imagery; },
      .size = [](const OutputOptions&, std::size_t) { return OutputSize{.per_building = 1500}; },
      .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<ImageryOutput>(c); }};
}

}  // namespace blockrand::outputs
