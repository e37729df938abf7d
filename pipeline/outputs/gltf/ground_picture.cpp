#include "pipeline/outputs/gltf/ground_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blockrand::outputs {
namespace {

using importers::imagery::AerialImage;
using importers::imagery::Patch;

bool is_used(const observation::ImageReceipt& image) { return image.fit.state != observation::ImageState::misfit; }

/// m, of the finest image; 0 without any.
double finest_pixel(const GroundImages& in) {
  double finest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < in.images.size(); ++k)
    if (is_used(in.receipts[k])) finest = std::min(finest, in.images[k].describe().pixel_m);
  return std::isfinite(finest) ? finest : 0;
}

}  // namespace

GroundPicture ground_picture(const GroundImages& in, const model::GroundMesh& mesh, double asked) {
  GroundPicture out;
  if (mesh.squares.empty()) return out;
  const auto number = [&](double m) { return std::llround(m / mesh.square); };
  long long left = number(mesh.squares[0].corner.x), right = left, low = number(mesh.squares[0].corner.y), high = low;
  for (const model::GroundSquare& s : mesh.squares) {
    left = std::min(left, number(s.corner.x)), right = std::max(right, number(s.corner.x));
    low = std::min(low, number(s.corner.y)), high = std::max(high, number(s.corner.y));
  }
  const int columns = static_cast<int>(right - left) + 1, rows = static_cast<int>(high - low) + 1;
  constexpr double kRounding = 1e-6;  // of a pixel
  const double wanted = std::max(asked, finest_pixel(in));
  const int side = std::max(1, std::min(static_cast<int>(std::floor(mesh.square / wanted + kRounding)),
                                        kMostGroundPixels / std::max(columns, rows)));
  GroundCover& cover = out.cover;
  cover.pixel = mesh.square / side;
  cover.west = static_cast<double>(left) * mesh.square, cover.north = static_cast<double>(high + 1) * mesh.square;
  cover.width = columns * side, cover.height = rows * side;
  out.image = picture::blank(cover.width, cover.height, kBareGround);
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(cover.width) + static_cast<std::size_t>(x);
  };
  // Square by square, so that few pixels of the images are in memory at a time. Those of other tiles as well: from afar pixels are
  // mixed with those beyond the tile's border.
  std::vector<bool> filled(static_cast<std::size_t>(cover.width) * static_cast<std::size_t>(cover.height), false);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      for (std::size_t k = 0; k < in.images.size(); ++k) {
        if (!is_used(in.receipts[k])) continue;
        const model::Point2 shift = in.receipts[k].shift;
        const Patch patch =
            in.images[k].patch(in.projection, cover.pixel, (left + column) * side + std::llround(shift.x / cover.pixel),
                               -(high + 1 - row) * side - std::llround(shift.y / cover.pixel), side, side);
        for (int y = 0; y < side; ++y)
          for (int x = 0; x < side; ++x) {
            const std::size_t from = static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                                     static_cast<std::size_t>(x),
                              to = at(column * side + x, row * side + y);
            if (filled[to] || !patch.valid[from]) continue;
            filled[to] = true;
            out.image.rgb[3 * to] = patch.red[from];
            out.image.rgb[3 * to + 1] = patch.green[from];
            out.image.rgb[3 * to + 2] = patch.blue[from];
          }
      }
  for (const model::GroundSquare& s : mesh.squares)
    for (int row = 0; row < mesh.cells; ++row)
      for (int column = 0; column < mesh.cells; ++column) {
        const int x = static_cast<int>(number(s.corner.x) - left) * side,
                  y = static_cast<int>(high - number(s.corner.y) + 1) * side;
        bool shown = false;
        for (int v = y - (row + 1) * side / mesh.cells; v < y - row * side / mesh.cells && !shown; ++v)
          for (int u = x + column * side / mesh.cells; u < x + (column + 1) * side / mesh.cells && !shown; ++u)
            shown = filled[at(u, v)];
        cover.shown.push_back(shown);
      }
  return out;
}

picture::Image reduced(const picture::Image& image, int most) {
  const int factor = (std::max(image.width, image.height) + most - 1) / most;
  if (factor <= 1) return image;
  picture::Image out{(image.width + factor - 1) / factor, (image.height + factor - 1) / factor, {}};
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      std::uint32_t sum[3] = {}, count = 0;
      for (int v = y * factor; v < std::min((y + 1) * factor, image.height); ++v)
        for (int u = x * factor; u < std::min((x + 1) * factor, image.width); ++u, ++count)
          for (int c = 0; c < 3; ++c) sum[c] += image.pixel(u, v)[c];
      for (const std::uint32_t s : sum) out.rgb.push_back(static_cast<std::uint8_t>((s + count / 2) / count));
    }
  return out;
}

}  // namespace blockrand::outputs
