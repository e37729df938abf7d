// Images with the outlines on them: as mapped, and where the image shows them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "importers/imagery/aerial_image.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/picture/image.h"

namespace blockrand::outputs {

/// What overlays are drawn from; all of it outlives them.
struct OverlayInputs {
  const observation::ImageryObservations& seen;
  const footprints::FootprintStore& footprints;
  std::span<const importers::imagery::AerialImage> images;  ///< parallel to seen.images
  const georef::Projection& projection;
  std::string attribution;  ///< of map and images
};

/// The colours of outlines, for legends: as mapped where it stays; as mapped where the image shows it elsewhere; there, by
/// confidence from kSureCorrection to 1; refused; what looks like a building where none is mapped.
inline constexpr model::Colour kAsMapped{255, 255, 255}, kBefore{255, 214, 0}, kAfterUnsure{255, 0, 190},
    kAfterSure{0, 230, 255}, kRefused{255, 40, 40}, kUnmapped{70, 255, 70};

/// A picture of a box: images that fit the map, the first that has a pixel, the others' parts grey; outlines where the
/// images show the roofs, that is displaced by their lean; candidates for unmapped buildings in the box;
/// in the lower right corner whose data they are. Deterministic.
/// \param box        m in the build CRS
/// \param pixel      m
/// \param buildings  by number
/// \param first      the image that lies above the others
/// The south-west and north-east ends of its pixels lie on multiples of `pixel`.
picture::Image draw_overlay(const OverlayInputs& in, const geometry::PlanBox& box, double pixel,
                            std::span<const std::uint32_t> buildings, std::uint32_t first);

/// The world file of such a picture (ESRI, "About world files"): six lines, the size of a pixel and the middle of the first one in
/// the build CRS.
std::string overlay_world_file(const geometry::PlanBox& box, double pixel);

}  // namespace blockrand::outputs
