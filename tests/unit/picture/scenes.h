// Small scenes and measures for the tests of the renderer.
#pragma once

#include <array>

#include "pipeline/picture/render.h"

namespace blockrand::picture::test {

inline constexpr Colour kRed{200, 40, 40}, kGreen{40, 180, 60}, kGrey{200, 200, 200};

/// Without sun, sky shading, lines and smoothing: a surface has one flat colour, the background its own.
inline RenderOptions plain(int width, int height) {
  RenderOptions o;
  o.width = width;
  o.height = height;
  o.supersampling = 1;
  o.shadows = o.sky_occlusion = o.lines = false;
  return o;
}

inline bool is_background(const Image& image, int x, int y, const RenderOptions& options) {
  const std::uint8_t* p = image.pixel(x, y);
  return p[0] == options.background.r && p[1] == options.background.g && p[2] == options.background.b;
}

inline int brightness(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return p[0] + p[1] + p[2];
}

inline bool reddish(const Image& image, int x, int y) { return image.pixel(x, y)[0] > 2 * image.pixel(x, y)[1]; }
inline bool greenish(const Image& image, int x, int y) { return image.pixel(x, y)[1] > 2 * image.pixel(x, y)[0]; }

/// Two triangles; corners counter-clockwise seen from the front.
inline void add_quad(Scene& scene, Point3 a, Point3 b, Point3 c, Point3 d, Colour colour, std::uint32_t object) {
  scene.add_triangle({a, b, c}, colour, object);
  scene.add_triangle({a, c, d}, colour, object);
}

/// An upright box without its underside.
inline void add_box(Scene& scene, Point3 low, Point3 high, Colour colour, std::uint32_t object) {
  const Point3 a{low.x, low.y, low.z}, b{high.x, low.y, low.z}, c{high.x, high.y, low.z}, d{low.x, high.y, low.z};
  const Point3 e{low.x, low.y, high.z}, f{high.x, low.y, high.z}, g{high.x, high.y, high.z}, h{low.x, high.y, high.z};
  add_quad(scene, a, b, f, e, colour, object);
  add_quad(scene, b, c, g, f, colour, object);
  add_quad(scene, c, d, h, g, colour, object);
  add_quad(scene, d, a, e, h, colour, object);
  add_quad(scene, e, f, g, h, colour, object);
}

/// Straight down, north up, `height` metres from edge to edge, (0, 0) in the middle.
inline Camera plan_camera(double height) {
  Camera camera = look_at({0, 0, 101}, {0, 0, 0});
  camera.projection = Projection::orthographic;
  camera.height = height;
  return camera;
}

}  // namespace blockrand::picture::test
