#include "pipeline/compare/report_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/compare/area_vector.h"
#include "pipeline/compare/face_triangles.h"
#include "pipeline/compare/heat_mesh.h"
#include "pipeline/picture/lettering.h"
#include "pipeline/picture/render.h"

namespace blockrand::compare {
namespace {

constexpr model::Colour kBackground{246, 246, 244};
constexpr double kMaxEdge = 0.7;              // m: finer than a pixel shows
constexpr std::size_t kMaxTriangles = 16000;  // of a side: what is larger gets longer edges
constexpr double kOpeningLift = 0.04;         // m in front of the wall, so that the wall does not show through
constexpr int kColours = 48;                  // of a picture file

/// A side's surface on its own ground.
class Side {
 public:
  Side(const City& city, const SideFacts& facts, Point2 centre) : city_(city), facts_(facts), centre_(centre) {
    if (facts.ground) {
      ground_ = *facts.ground;
      return;
    }
    bool first = true;
    for_each_face([&](const Face& face, std::uint32_t) {
      for (const auto& ring : face.rings)
        for (const Point3& p : ring) {
          ground_ = first ? p.z : std::min(ground_, p.z);
          first = false;
        }
    });
  }

  /// Where a point of the city stands in the picture.
  Point3 drawn(Point3 p) const { return {p.x - centre_.x, p.y - centre_.y, p.z - ground_}; }
  Triangle3 drawn(const Triangle3& t) const { return {drawn(t[0]), drawn(t[1]), drawn(t[2])}; }

  template <class Do>
  void for_each_face(const Do& act) const {
    for (std::uint32_t i = 0; i < facts_.buildings.size(); ++i)
      for (const Face& face : city_.buildings[facts_.buildings[i]].faces) act(face, i);
  }

  void paint(picture::Scene& scene) const {
    for_each_face([&](const Face& face, std::uint32_t object) {
      for (const Triangle3& t : triangles_of(face.rings)) scene.add_triangle(drawn(t), colour_of(face), object);
    });
    for (std::uint32_t i = 0; i < facts_.buildings.size(); ++i)
      for (const Opening& opening : city_.buildings[facts_.buildings[i]].openings) paint(scene, opening, i);
  }

  void paint_heat(picture::Scene& scene, const MatchResult& match, bool from_model, const DistanceQuery& distances,
                  double range) const {
    std::vector<Triangle3> counted;
    for (std::uint32_t i = 0; i < facts_.buildings.size(); ++i) {
      for (const Face& face : city_.buildings[facts_.buildings[i]].faces)
        for (const Triangle3& t : triangles_of(face.rings)) {
          if (face.left_out == LeftOut::no)
            counted.push_back(t);
          else
            scene.add_triangle(drawn(t), kHeatLeftOut, i);
        }
    }
    // Openings are measured like walls.
    for (const std::uint32_t b : facts_.buildings)
      for (const Opening& opening : city_.buildings[b].openings)
        for (const Rings3& polygon : opening.polygons)
          for (const Triangle3& t : triangles_of(polygon)) counted.push_back(t);
    const HeatMesh mesh = cut_small(counted, kMaxEdge, kMaxTriangles);
    const std::vector<float> at = distances ? distances(match, from_model, mesh.points) : std::vector<float>();
    std::vector<picture::Colour> colours(mesh.points.size(), kHeatLeftOut);
    for (std::size_t i = 0; i < std::min(at.size(), colours.size()); ++i)
      if (std::isfinite(at[i])) colours[i] = heat_colour(at[i] / range);
    for (const auto& t : mesh.triangles)
      scene.add_blended_triangle(drawn(Triangle3{mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]}),
                                 {colours[t[0]], colours[t[1]], colours[t[2]]}, 0);
  }

 private:
  static model::Colour colour_of(const Face& face) {
    if (face.left_out == LeftOut::blank || face.left_out == LeftOut::covered) return kPictureLeftOut;
    switch (face.hull) {
      case Hull::wall:
        return kPictureWall;
      case Hull::roof:
        return kPictureRoof;
      case Hull::ground:
      case Hull::closure:
      case Hull::outer_ceiling:
      case Hull::outer_floor:
      case Hull::installation:
        break;
    }
    return kPictureOther;
  }

  void paint(picture::Scene& scene, const Opening& opening, std::uint32_t object) const {
    for (const Rings3& polygon : opening.polygons)
      for (const Triangle3& t : triangles_of(polygon)) {
        const Point3 n = cross(t[1] - t[0], t[2] - t[0]);
        const double size = length(n);
        if (!(size > 0)) continue;
        // Before and behind: which side is out, not every model says.
        for (const double lift : {kOpeningLift, -kOpeningLift}) {
          const Point3 by{n.x / size * lift, n.y / size * lift, n.z / size * lift};
          Triangle3 moved = drawn(t);
          for (Point3& p : moved) p = {p.x + by.x, p.y + by.y, p.z + by.z};
          scene.add_triangle(moved, opening.door ? kPictureDoor : kPictureWindow, object);
        }
      }
  }

  const City& city_;
  const SideFacts& facts_;
  Point2 centre_;
  double ground_ = 0;
};

/// Where the viewer stands: a little beside the normal of the reference's largest facade with openings.
double azimuth_of(const MatchResult& match) {
  const Facade* front = nullptr;
  for (const auto* facades : {&match.facades.reference, &match.facades.model}) {
    for (const Facade& f : *facades)
      if (!f.openings.empty() && (front == nullptr || f.area > front->area)) front = &f;
    if (front != nullptr) break;
  }
  if (front == nullptr) return 205;
  const double dx = front->right.x - front->left.x, dy = front->right.y - front->left.y;
  const double facing = base::atan2(dy, -dx) * base::kDegreesPerRadian;  // clockwise from north, of (dy, -dx)
  return facing + 28;
}

Point2 centre_of(const City& city, const SideFacts& side) {
  bool first = true;
  Point2 low, high;
  for (const std::uint32_t b : side.buildings)
    for (const Face& face : city.buildings[b].faces)
      for (const auto& ring : face.rings)
        for (const Point3& p : ring) {
          low = first ? p.xy() : Point2{std::min(low.x, p.x), std::min(low.y, p.y)};
          high = first ? p.xy() : Point2{std::max(high.x, p.x), std::max(high.y, p.y)};
          first = false;
        }
  return {(low.x + high.x) / 2, (low.y + high.y) / 2};
}

}  // namespace

model::Colour heat_colour(double share) {
  static constexpr std::array<model::Colour, 9> kStops{{{255, 255, 217},
                                                        {255, 237, 160},
                                                        {254, 217, 118},
                                                        {254, 178, 76},
                                                        {253, 141, 60},
                                                        {252, 78, 42},
                                                        {227, 26, 28},
                                                        {177, 0, 38},
                                                        {92, 0, 30}}};
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double rest = at - static_cast<double>(low);
  const auto mixed = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(a + (b - a) * rest + 0.5);
  };
  const model::Colour a = kStops[low], b = kStops[low + 1];
  return {mixed(a.r, b.r), mixed(a.g, b.g), mixed(a.b, b.b)};
}

MatchPictures draw_pictures(const Comparison& comparison, const MatchResult& match, const DistanceQuery& distances,
                            const ReportOptions& options) {
  const Point2 centre = centre_of(comparison.reference, match.reference);
  const Side reference(comparison.reference, match.reference, centre);
  const Side model(comparison.model, match.model, centre);
  picture::Scene of_reference, of_model;
  reference.paint(of_reference);
  model.paint(of_model);

  std::vector<Point3> points = of_reference.points();
  const std::vector<Point3> more = of_model.points();
  points.insert(points.end(), more.begin(), more.end());
  MatchPictures out;
  if (points.empty()) return out;
  picture::RenderOptions render;
  render.width = std::max(32, options.picture_width);
  render.height = render.width * 3 / 4;
  render.background = kBackground;
  render.sun_strength = 2.0;
  render.sky_strength = 1.25;
  render.sky_occlusion = false;
  render.shadow_map = 1024;
  const double azimuth = azimuth_of(match);
  render.sun_azimuth = azimuth - 50;
  out.width = render.width;
  out.height = render.height;
  const double aspect = static_cast<double>(render.width) / render.height;
  const picture::Camera camera = picture::fit_perspective(points, {azimuth, 27}, aspect, 30, 0.06);

  const auto shot = [&](const picture::Scene& scene, int colours, const City& city) {
    if (scene.empty()) return std::string();
    picture::Image image = picture::render(scene, camera, render);
    picture::sign(image, city.attribution);
    return picture::palette_png(image, colours);
  };
  out.reference = shot(of_reference, kColours, comparison.reference);
  out.model = shot(of_model, kColours, comparison.model);
  render.lit = false;
  render.line_strength = 0.4;
  picture::Scene reference_heat, model_heat;
  reference.paint_heat(reference_heat, match, false, distances, options.heat_range);
  model.paint_heat(model_heat, match, true, distances, options.heat_range);
  out.reference_heat = shot(reference_heat, kColours, comparison.reference);
  out.model_heat = shot(model_heat, kColours, comparison.model);
  return out;
}

}  // namespace blockrand::compare
