#include "styles/grammar/shapes/scope.h"

#include "pipeline/base/portable_math.h"

namespace blockrand::grammar {

Frame compose(const Frame& outer, const Frame& inner) {
  Frame out;
  out.origin = place(outer, inner.origin);
  for (int i = 0; i < 3; ++i) out.axes[i] = turn(outer, inner.axes[i]);
  return out;
}

Frame relative_to(const Frame& outer, const Frame& frame) {
  Frame out;
  out.origin = place_back(outer, frame.origin);
  for (int i = 0; i < 3; ++i) out.axes[i] = turn_back(outer, frame.axes[i]);
  return out;
}

namespace {

/// Sine and cosine of degrees, exact at the quarter turns that rule files are full of.
base::SinCos sin_cos_degrees(double degrees) {
  const double turns = std::fmod(degrees, 360.0);
  if (turns == 0) return {0, 1};
  if (turns == 90 || turns == -270) return {1, 0};
  if (turns == 180 || turns == -180) return {0, -1};
  if (turns == 270 || turns == -90) return {-1, 0};
  return base::sin_cos(turns * base::kRadiansPerDegree);
}

}  // namespace

std::array<Vector3, 3> axes_of_angles(Vector3 degrees) {
  if (degrees == Vector3{}) return Frame{}.axes;
  const auto a = sin_cos_degrees(degrees.x), b = sin_cos_degrees(degrees.y), c = sin_cos_degrees(degrees.z);
  // Rz * Ry * Rx, by columns.
  return {Vector3{b.cos * c.cos, b.cos * c.sin, -b.sin},
          Vector3{a.sin * b.sin * c.cos - a.cos * c.sin, a.sin * b.sin * c.sin + a.cos * c.cos, a.sin * b.cos},
          Vector3{a.cos * b.sin * c.cos + a.sin * c.sin, a.cos * b.sin * c.sin - a.sin * c.cos, a.cos * b.cos}};
}

Vector3 angles_of_axes(const std::array<Vector3, 3>& axes) {
  const double across = std::sqrt(axes[0].x * axes[0].x + axes[0].y * axes[0].y);
  Vector3 out;
  out.y = base::atan2(-axes[0].z, across) * base::kDegreesPerRadian;
  // Looking straight along y's turn only the sum of the other two counts: all of it goes to x.
  if (across > 1e-12) {
    out.x = base::atan2(axes[1].z, axes[2].z) * base::kDegreesPerRadian;
    out.z = base::atan2(axes[0].y, axes[0].x) * base::kDegreesPerRadian;
  } else {
    out.x = base::atan2(axes[0].z < 0 ? axes[1].x : -axes[1].x, axes[1].y) * base::kDegreesPerRadian;
  }
  return out;
}

Frame scope_in_object(const Shape& shape) { return compose(shape.pivot, shape.scope); }
Frame object_in_world(const Shape& shape) { return shape.origin ? shape.origin->world : Frame{}; }
Frame scope_in_world(const Shape& shape) { return compose(object_in_world(shape), scope_in_object(shape)); }

Frame system_in_world(const Shape& shape, CoordinateSystem system) {
  switch (system) {
    case CoordinateSystem::scope:
      return scope_in_world(shape);
    case CoordinateSystem::pivot:
      return compose(object_in_world(shape), shape.pivot);
    case CoordinateSystem::object:
      return object_in_world(shape);
    case CoordinateSystem::world:
      break;
  }
  return {};
}

double scope_elevation(const Shape& shape) {
  return place(object_in_world(shape), place(shape.pivot, shape.scope.origin)).y;
}

}  // namespace blockrand::grammar
