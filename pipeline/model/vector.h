// Points as vectors: one arithmetic for everybody, so that the same expression rounds the same way everywhere.
#pragma once

#include <cmath>

#include "pipeline/model/point.h"

namespace blockrand::model {

// Each function is + - * and sqrt in a fixed order, which every x86-64 rounds alike (ARCHITECTURE.md, law 3).
// std::hypot rounds differently: places that call it keep doing so.

constexpr Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point2 operator-(Point2 a) { return {-a.x, -a.y}; }
constexpr Point2 operator*(Point2 a, double s) { return {a.x * s, a.y * s}; }
constexpr Point2 operator*(double s, Point2 a) { return a * s; }

constexpr double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
/// Positive when `b` points to the left of `a`.
constexpr double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }
/// Twice the area of the triangle; positive when counter-clockwise.
constexpr double cross(Point2 a, Point2 b, Point2 c) { return cross(b - a, c - a); }

inline double length(Point2 a) { return std::sqrt(dot(a, a)); }
constexpr double squared_distance(Point2 a, Point2 b) { return dot(a - b, a - b); }
inline double distance(Point2 a, Point2 b) { return length(a - b); }

constexpr Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Point3 operator*(Point3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }

constexpr double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// At right angles to both, by the right-hand rule.
constexpr Point3 cross(Point3 a, Point3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double length(Point3 a) { return std::sqrt(dot(a, a)); }
/// `a` with length 1; zero where it has none.
inline Point3 unit(Point3 a) {
  const double l = length(a);
  return l > 0 ? a * (1 / l) : Point3{};
}

}  // namespace blockrand::model
