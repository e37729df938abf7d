#include "pipeline/outputs/imagery/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/footprints/move_buildings.h"
#include "pipeline/observation/corrections.h"
#include "pipeline/observation/verdict.h"
#include "pipeline/picture/lettering.h"
#include "pipeline/picture/plan.h"

namespace blockrand::outputs {
namespace {

using model::Point2;
using observation::RowState;

constexpr std::uint8_t kNoImage = 128;  // grey where no image has a pixel
/// Pixels: width of lines.
constexpr double kLine = 1.6;

model::Colour after_colour(double confidence) {
  const double sure =
      std::clamp((confidence - observation::kSureCorrection) / (1 - observation::kSureCorrection), 0.0, 1.0);
  const auto mix = [sure](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + sure * (static_cast<double>(b) - a)));
  };
  return {mix(kAfterUnsure.r, kAfterSure.r), mix(kAfterUnsure.g, kAfterSure.g), mix(kAfterUnsure.b, kAfterSure.b)};
}

/// Outlines as they were before images moved any.
std::vector<model::Polygon> outlines_before(const OverlayInputs& in, std::uint32_t building) {
  const auto& before = in.seen.before;
  const auto found = std::lower_bound(before.begin(), before.end(), building,
                                      [](const auto& entry, std::uint32_t b) { return entry.first < b; });
  return found != before.end() && found->first == building ? found->second : in.footprints.polygons(building);
}

/// Draws a building's outline, moved and then displaced by the lean of its roof.
void draw(picture::Plan& plan, std::vector<model::Polygon> polygons, const footprints::Movement* movement, Point2 lean,
          model::Colour colour) {
  for (model::Polygon& polygon : polygons) {
    const auto ring = [&](model::Ring& r) {
      for (Point2& p : r.points) {
        if (movement) p = (*movement)(p);
        p.x += lean.x, p.y += lean.y;
      }
      plan.stroke(r.points, kLine * plan.metres_per_pixel(), colour, true);
    };
    ring(polygon.outer);
    for (model::Ring& hole : polygon.holes) ring(hole);
  }
}

/// Of the upper left pixel, counted from the origin of the build CRS, east and south.
std::pair<long long, long long> first_pixel(const geometry::PlanBox& box, double pixel) {
  return {static_cast<long long>(std::floor(box.minimum.x / pixel)),
          static_cast<long long>(std::floor(-box.maximum.y / pixel))};
}

}  // namespace

std::string overlay_world_file(const geometry::PlanBox& box, double pixel) {
  const auto [column, row] = first_pixel(box, pixel);
  return fmt::format("{:.2f}\n0.0\n0.0\n{:.2f}\n{:.3f}\n{:.3f}\n", pixel, -pixel,
                     (static_cast<double>(column) + 0.5) * pixel, -(static_cast<double>(row) + 0.5) * pixel);
}

picture::Image draw_overlay(const OverlayInputs& in, const geometry::PlanBox& box, double pixel,
                            std::span<const std::uint32_t> buildings, std::uint32_t first) {
  const auto [column, row] = first_pixel(box, pixel);
  const int width = static_cast<int>(std::ceil(box.maximum.x / pixel)) - static_cast<int>(column),
            height = static_cast<int>(std::ceil(-box.minimum.y / pixel)) - static_cast<int>(row);
  picture::Image picture{width, height, {}};
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture.rgb.assign(pixels * 3, kNoImage);
  std::vector<char> filled(pixels, 0);
  for (std::size_t n = 0; n < in.images.size(); ++n) {
    const std::size_t k = (n + first) % in.images.size();
    if (in.seen.images[k].fit.state == observation::ImageState::misfit) continue;
    const importers::imagery::Patch patch = in.images[k].patch(in.projection, pixel, column, row, width, height);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (filled[i] || !patch.valid[i]) continue;
      picture.rgb[3 * i] = patch.red[i], picture.rgb[3 * i + 1] = patch.green[i],
                      picture.rgb[3 * i + 2] = patch.blue[i];
      filled[i] = 1;
    }
  }
  const double west = static_cast<double>(column) * pixel, north = -static_cast<double>(row) * pixel;
  picture::Plan plan({west, north - height * pixel, west + width * pixel, north}, 1 / pixel, std::move(picture));
  // What stays lies below what moved.
  for (const bool moved : {false, true})
    for (const std::uint32_t b : buildings) {
      const observation::OutlineReceipt& r = in.seen.outlines[b];
      if (r.image >= in.images.size()) continue;
      const bool refined = r.refined.state == observation::RefinementState::refined;
      const bool elsewhere = r.state == RowState::corrected || r.state == RowState::refused || refined;
      if (elsewhere != moved) continue;
      const std::vector<model::Polygon> before = outlines_before(in, b);
      draw(plan, before, nullptr, r.lean, elsewhere ? kBefore : kAsMapped);
      if (!elsewhere) continue;
      const footprints::Movement refused{r.shift, r.centre, r.turn},
          movement = r.state == RowState::refused ? refused : observation::movement_of(r);
      const double confidence = refined ? r.refined.confidence : r.confidence;
      draw(plan, before, &movement, r.lean, r.state == RowState::refused ? kRefused : after_colour(confidence));
    }
  for (const observation::UnmappedBuilding& u : in.seen.unmapped) {
    if (!geometry::box_of(u.outline).near(box, 0)) continue;
    std::vector<Point2> roof = u.outline;
    for (Point2& p : roof) p.x += u.lean.x, p.y += u.lean.y;
    plan.stroke(roof, kLine * plan.metres_per_pixel(), kUnmapped, true);
  }
  picture::sign(plan.image(), in.attribution);
  return plan.image();
}

}  // namespace blockrand::outputs
