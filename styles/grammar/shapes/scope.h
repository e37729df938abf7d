// Frames of a shape: vectors, turning, and the way from scope to pivot, object and world.
#pragma once

#include <array>
#include <cmath>

#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

inline Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
inline Vector3 operator*(Vector3 a, double k) { return {a.x * k, a.y * k, a.z * k}; }
inline double dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector3 cross(Vector3 a, Vector3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vector3 a) { return std::sqrt(dot(a, a)); }
/// Zero for vectors without length.
inline Vector3 normalized(Vector3 a) {
  const double n = length(a);
  return n > 0 ? a * (1 / n) : Vector3{};
}
inline double component(Vector3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
inline void set_component(Vector3& v, int axis, double value) { (axis == 0 ? v.x : axis == 1 ? v.y : v.z) = value; }

/// A direction given in the frame's axes, in the frame above.
inline Vector3 turn(const Frame& frame, Vector3 v) {
  return frame.axes[0] * v.x + frame.axes[1] * v.y + frame.axes[2] * v.z;
}
/// A direction of the frame above, in the frame's axes.
inline Vector3 turn_back(const Frame& frame, Vector3 v) {
  return {dot(frame.axes[0], v), dot(frame.axes[1], v), dot(frame.axes[2], v)};
}
inline Vector3 place(const Frame& frame, Vector3 p) { return frame.origin + turn(frame, p); }
inline Vector3 place_back(const Frame& frame, Vector3 p) { return turn_back(frame, p - frame.origin); }
/// `inner`, which is given in `outer`, in the frame above `outer`.
Frame compose(const Frame& outer, const Frame& inner);
/// `frame` (in the frame above `outer`) as seen in `outer`.
Frame relative_to(const Frame& outer, const Frame& frame);

/// Rotation matrix of Euler angles in degrees: about x, then y, then z, about fixed axes (docs/rule_language.md §2.0).
/// Its columns are the axes.
std::array<Vector3, 3> axes_of_angles(Vector3 degrees);
/// The angles of axes, in degrees; ry in [-90, 90]. Inverse of axes_of_angles() up to equal rotations.
Vector3 angles_of_axes(const std::array<Vector3, 3>& axes);

/// From the scope to object coordinates, and to the world.
Frame scope_in_object(const Shape& shape);
Frame scope_in_world(const Shape& shape);
Frame object_in_world(const Shape& shape);

enum class CoordinateSystem : std::uint8_t { scope, pivot, object, world };
/// The named frame in world coordinates: `convert(…)` (docs/rule_language.md §3.2).
Frame system_in_world(const Shape& shape, CoordinateSystem system);

/// `scope.elevation`: the height of the scope's origin in the world, in metres.
double scope_elevation(const Shape& shape);

}  // namespace blockrand::grammar
