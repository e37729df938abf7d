// The ground of a tile as aerial images show it: one picture, and which cells of the ground it covers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "importers/imagery/aerial_image.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/colour.h"
#include "pipeline/model/ground_mesh.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/picture/image.h"

namespace blockrand::outputs {

/// Pixels along each side of a picture at most: what every graphics card takes.
inline constexpr int kMostGroundPixels = 4096;

/// sRGB: where no image has a pixel.
inline constexpr model::Colour kBareGround{0x8F, 0x8B, 0x82};

/// Where a picture lies in the build CRS.
struct GroundCover {
  double west = 0, north = 0;  ///< m
  double pixel = 0;            ///< m, side of a pixel
  int width = 0, height = 0;   ///< pixels
  /// Whether some image has a pixel there: cells of the mesh, square by square, in each by rows from the south-west.
  std::vector<bool> shown;
};

struct GroundPicture {
  GroundCover cover;
  picture::Image image;
};

/// What pictures are made from; all of it outlives the call.
struct GroundImages {
  std::span<const importers::imagery::AerialImage> images;
  std::span<const observation::ImageReceipt> receipts;  ///< parallel
  const georef::Projection& projection;
};

/// The box of the mesh's squares, resampled: each pixel from the first image that has one there and fits the map, moved by the shift
/// that was found of the whole image. Depends on images and mesh alone.
///
/// Pixels are the `asked` metres wide, or as coarse as the finest image, or so coarse that no side has more than
/// kMostGroundPixels; and a square has a whole number of them: pixels of tiles lie in one grid.
GroundPicture ground_picture(const GroundImages& in, const model::GroundMesh& mesh, double asked);

/// A smaller picture, by a whole factor, each pixel the mean of those it stands for, at most `most` pixels wide and high.
picture::Image reduced(const picture::Image& image, int most);

}  // namespace blockrand::outputs
