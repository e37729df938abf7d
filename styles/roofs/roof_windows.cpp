#include "styles/roofs/roof_windows.h"

#include <array>
#include <cmath>

#include "pipeline/geometry/solid_builder.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;

namespace {

constexpr double kLeastSide = 0.20, kLeastPane = 0.05, kLeastStep = 0.01;  // m

std::vector<Point2> rectangle(double left, double low, double right, double high) {
  return {{left, low}, {right, low}, {right, high}, {left, high}};
}

}  // namespace

std::vector<Point2> roof_window_outline(const RoofWindowParameters& p) {
  if (!(p.width >= kLeastSide && p.height >= kLeastSide) || !(p.frame >= kLeastStep) ||
      !(2 * p.frame <= std::min(p.width, p.height) - kLeastPane) || !(p.reveal >= kLeastStep) ||
      !(p.raised >= p.gap + p.reveal + kLeastStep))
    return {};
  return rectangle(-p.width / 2, 0, p.width / 2, p.height);
}

std::optional<model::RoofInstallation> roof_window(const RoofSlope& plane, const RoofWindowParameters& p, Point2 place,
                                                   const RoofWindowMaterials& materials,
                                                   const ElementDistances& distances) {
  auto outline = roof_window_outline(p);
  for (Point2& q : outline) q = {q.x + place.x, q.y + place.y};
  if (outline.empty() || !takes_elements(plane) || !fits(plane, outline, distances)) return std::nullopt;

  // Corners at a height over the plane, square to it.
  const double level = plane.rise / plane.slope_length, upright = 1 / plane.slope_length;
  const auto at = [&](double inset, double height) {
    std::array<Point3, 4> out;
    const auto corners = rectangle(place.x - p.width / 2 + inset, place.y + inset, place.x + p.width / 2 - inset,
                                   place.y + p.height - inset);
    for (std::size_t i = 0; i < 4; ++i) {
      const Point3 on = plane.in_space(corners[i]);
      out[i] = {on.x - plane.up_axis.x * level * height, on.y - plane.up_axis.y * level * height,
                on.z + upright * height};
    }
    return out;
  };
  const auto bottom = at(0, p.gap), face = at(0, p.raised), edge = at(p.frame, p.raised),
             pane = at(p.frame, p.raised - p.reveal);
  const auto loop = [](const std::array<Point3, 4>& corners, bool turned) {
    return turned ? std::vector<Point3>{corners[3], corners[2], corners[1], corners[0]}
                  : std::vector<Point3>(corners.begin(), corners.end());
  };
  model::Face frame_face = materials.frame, pane_face = materials.pane;
  frame_face.kind = pane_face.kind = model::SurfaceKind::roof;
  frame_face.edge = pane_face.edge = -1;
  model::Face under = frame_face;
  under.kind = model::SurfaceKind::closure;

  geometry::SolidBuilder builder;
  builder.add_face(loop(bottom, true), under);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (i + 1) % 4;
    builder.add_face({bottom[i], bottom[k], face[k], face[i]}, frame_face);
  }
  const std::vector<Point3> ring[] = {loop(face, false), loop(edge, true)};
  builder.add_face(ring, frame_face);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (i + 1) % 4;
    builder.add_face({pane[k], pane[i], edge[i], edge[k]}, frame_face);
  }
  builder.add_face(loop(pane, false), pane_face);
  return model::RoofInstallation{model::RoofElementKind::roof_window, builder.take(), {}};
}

}  // namespace blockrand::roofs
