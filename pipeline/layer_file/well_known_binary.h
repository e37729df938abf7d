// Geometries as well-known binary (OGC 06-103r4, clause 8), little-endian.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "pipeline/model/polygon.h"
#include "pipeline/model/solid.h"

namespace blockrand::layer_file {

static_assert(std::endian::native == std::endian::little, "well-known binary is written as memory holds it");

template <class T>
void append_raw(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

inline constexpr std::uint32_t kPoint = 1, kLineString = 2, kPolygon = 3, kMultiPolygon = 6, kPolygonZ = 1003,
                               kMultiPolygonZ = 1006;

inline void append_header(std::string& out, std::uint32_t type, std::size_t count) {
  out += '\1';
  append_raw(out, type);
  append_raw(out, static_cast<std::uint32_t>(count));
}

/// True when the ring runs clockwise; of rings without area either answer.
inline bool runs_clockwise(const model::Ring& ring) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const model::Point2 o = ring.points[0], p = ring.points[i], q = ring.points[i + 1];
    twice += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
  }
  return twice < 0;
}

/// The ring from its first point, clockwise or counter-clockwise, however it runs in memory (OGC 06-103r4, 6.1.11.1: outer
/// rings counter-clockwise, inner ones the other way).
inline void append_ring(std::string& out, const model::Ring& ring, bool clockwise) {
  const std::size_t n = ring.size();
  append_raw(out, static_cast<std::uint32_t>(n + 1));
  const bool turn = runs_clockwise(ring) != clockwise;
  for (std::size_t i = 0; i <= n; ++i) {
    const model::Point2 p = ring.points[i % n == 0 ? 0 : turn ? n - i : i];
    append_raw(out, p.x);
    append_raw(out, p.y);
  }
}

inline void append_polygon(std::string& out, const model::Polygon& polygon) {
  if (polygon.outer.points.empty()) return append_header(out, kPolygon, 0);
  append_header(out, kPolygon, 1 + polygon.holes.size());
  append_ring(out, polygon.outer, false);
  for (const model::Ring& hole : polygon.holes) append_ring(out, hole, true);
}

inline void append_line(std::string& out, model::Point2 from, model::Point2 to) {
  append_header(out, kLineString, 2);
  for (const double v : {from.x, from.y, to.x, to.y}) append_raw(out, v);
}

inline void append_point(std::string& out, model::Point2 point) {
  out += '\1';
  append_raw(out, kPoint);
  append_raw(out, point.x);
  append_raw(out, point.y);
}

inline void append_multi_polygon(std::string& out, std::span<const model::Polygon> polygons) {
  append_header(out, kMultiPolygon, polygons.size());
  for (const model::Polygon& polygon : polygons) append_polygon(out, polygon);
}

/// A face of a solid in space.
inline void append_face(std::string& out, const model::Solid& solid, const model::Face& face) {
  append_header(out, kPolygonZ, face.loop_count);
  for (const model::Solid::Loop& loop : solid.loops_of(face)) {
    const std::span<const std::uint32_t> indices = solid.indices_of(loop);
    append_raw(out, static_cast<std::uint32_t>(indices.size() + 1));
    for (std::size_t i = 0; i <= indices.size(); ++i) {
      const model::Point3& p = solid.vertices[indices[i == indices.size() ? 0 : i]];
      for (const double v : {p.x, p.y, p.z}) append_raw(out, v);
    }
  }
}

}  // namespace blockrand::layer_file
