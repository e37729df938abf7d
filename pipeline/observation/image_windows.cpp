#include "pipeline/observation/image_windows.h"

#include <algorithm>
#include <cmath>

namespace blockrand::observation {

namespace {

/// Pixels along a cell's side: 51 m at 0.2 m, a few houses.
constexpr int kCell = 256;
/// Cells that stay: 0.26 MB each, 100 MB in all: those of a tile at 0.2 m.
constexpr std::size_t kMostCells = 400;

long long cell_of(long long pixel) { return pixel >= 0 ? pixel / kCell : -((-pixel + kCell - 1) / kCell); }

}  // namespace

ImageWindows::ImageWindows(const importers::imagery::AerialImage& image, const georef::Projection& projection,
                           double size)
    : image_(image), projection_(projection), size_(size) {}

std::shared_ptr<const Patch> ImageWindows::cell(Place place) const {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = cells_.find(place); found != cells_.end()) {
      recent_.splice(recent_.begin(), recent_, found->second.used);
      return found->second.patch;
    }
  }
  auto patch = std::make_shared<const Patch>(
      image_.patch(projection_, size_, place.first * kCell, place.second * kCell, kCell, kCell));
  const std::lock_guard lock(mutex_);
  if (!cells_.contains(place)) {
    recent_.push_front(place);
    cells_[place] = {patch, recent_.begin()};
    if (cells_.size() > kMostCells) {
      cells_.erase(recent_.back());
      recent_.pop_back();
    }
  }
  return patch;
}

Patch ImageWindows::window(const geometry::PlanBox& box, double margin) const {
  const auto pixel = [this](double metres) { return static_cast<long long>(std::floor(metres / size_)); };
  const long long west = pixel(box.minimum.x - margin), east = pixel(box.maximum.x + margin) + 1;
  const long long north = pixel(-box.maximum.y - margin), south = pixel(-box.minimum.y + margin) + 1;
  Patch out;
  out.size = size_;
  out.west = static_cast<double>(west) * size_, out.north = -static_cast<double>(north) * size_;
  out.width = static_cast<int>(east - west), out.height = static_cast<int>(south - north);
  const std::size_t pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  for (auto* band : {&out.red, &out.green, &out.blue, &out.valid}) band->assign(pixels, 0);
  if (image_.describe().infrared) out.infrared.assign(pixels, 0);
  for (long long r = cell_of(north); r <= cell_of(south - 1); ++r)
    for (long long c = cell_of(west); c <= cell_of(east - 1); ++c) {
      const std::shared_ptr<const Patch> from = cell({c, r});
      const long long first = std::max(west, c * kCell), last = std::min(east, (c + 1) * kCell);
      for (long long y = std::max(north, r * kCell); y < std::min(south, (r + 1) * kCell); ++y) {
        const auto source = (y - r * kCell) * kCell + (first - c * kCell);
        const auto target = (y - north) * out.width + (first - west);
        const auto copy = [&](const std::vector<std::uint8_t>& a, std::vector<std::uint8_t>& b) {
          if (!a.empty()) std::copy_n(a.begin() + source, last - first, b.begin() + target);
        };
        copy(from->red, out.red), copy(from->green, out.green), copy(from->blue, out.blue);
        copy(from->valid, out.valid), copy(from->infrared, out.infrared);
      }
    }
  return out;
}

}  // namespace blockrand::observation
