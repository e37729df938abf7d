#include "pipeline/picture/camera.h"

#include <algorithm>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/vector.h"

namespace blockrand::picture {
namespace {

/// Turns the camera to look along `forward`; `level` says what is to the right where it looks straight up or down.
void aim(Camera& camera, Point3 forward, Point3 level) {
  camera.forward = unit(forward);
  const Point3 right = cross(camera.forward, {0, 0, 1});
  // Nearer to the vertical than a second of arc the horizontal direction is noise.
  camera.right = length(right) > 5e-6 ? unit(right) : level;
  camera.up = cross(camera.right, camera.forward);
}

Camera aimed(Direction from) {
  const base::SinCos a = base::sin_cos(from.azimuth * base::kRadiansPerDegree);
  const base::SinCos e = base::sin_cos(from.elevation * base::kRadiansPerDegree);
  Camera camera;
  aim(camera, {-a.sin * e.cos, -a.cos * e.cos, -e.sin}, {-a.cos, a.sin, 0});
  return camera;
}

/// How far the points reach along `axis` plus `depth` times the view direction.
double reach(std::span<const Point3> points, Point3 axis, Point3 forward, double depth) {
  const Point3 direction = axis + forward * depth;
  double furthest = dot(points[0], direction);
  for (const Point3& p : points) furthest = std::max(furthest, dot(p, direction));
  return furthest;
}

}  // namespace

Camera look_at(Point3 eye, Point3 target, double field_of_view) {
  Camera camera;
  camera.eye = eye;
  camera.field_of_view = field_of_view;
  aim(camera, eye == target ? Point3{0, 1, 0} : target - eye, {1, 0, 0});
  return camera;
}

Camera fit_perspective(std::span<const Point3> points, Direction from, double aspect, double field_of_view,
                       double margin) {
  Camera camera = aimed(from);
  camera.field_of_view = field_of_view;
  if (points.empty()) return camera;
  // The sides of the pyramid of vision have fixed slopes, so each is pushed out until it touches the points; the eye is
  // as far back as the tighter pair wants, and in the middle of both.
  const double up = base::tan(field_of_view / 2 * base::kRadiansPerDegree) * (1 - margin), side = up * aspect;
  const double east = reach(points, camera.right, camera.forward, -side);
  const double west = reach(points, camera.right * -1, camera.forward, -side);
  const double top = reach(points, camera.up, camera.forward, -up);
  const double bottom = reach(points, camera.up * -1, camera.forward, -up);
  double depth = std::min(-(east + west) / (2 * side), -(top + bottom) / (2 * up));
  // All points in front of the near plane, even a single one.
  depth = std::min(depth, -reach(points, {}, camera.forward, -1) - 10 * camera.near);
  camera.eye = camera.right * ((east - west) / 2) + camera.up * ((top - bottom) / 2) + camera.forward * depth;
  return camera;
}

}  // namespace blockrand::picture
