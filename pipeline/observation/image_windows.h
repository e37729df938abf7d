// Windows of an aerial image, cut from cells that stay in memory for a while: neighbours need the same pixels.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>

#include "importers/imagery/aerial_image.h"
#include "pipeline/geometry/box_index.h"

namespace blockrand::observation {

/// Pixels in the build CRS; the type of importers/imagery.
using Patch = importers::imagery::Patch;

/// Safe from any thread. A window's bytes depend on its place alone.
class ImageWindows {
 public:
  /// \param size  m in the build CRS, side of a pixel. Both references outlive this.
  ImageWindows(const importers::imagery::AerialImage& image, const georef::Projection& projection, double size);

  /// The pixels that cover a box of the build's coordinates and `margin` metres around it.
  Patch window(const geometry::PlanBox& box, double margin) const;
  double size() const { return size_; }

 private:
  using Place = std::pair<long long, long long>;
  std::shared_ptr<const Patch> cell(Place place) const;

  const importers::imagery::AerialImage& image_;
  const georef::Projection& projection_;
  double size_;
  struct Entry {
    std::shared_ptr<const Patch> patch;
    std::list<Place>::iterator used;
  };
  mutable std::mutex mutex_;
  mutable std::map<Place, Entry> cells_;
  mutable std::list<Place> recent_;  // newest first
};

}  // namespace blockrand::observation
