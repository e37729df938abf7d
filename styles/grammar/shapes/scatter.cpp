// scatter: points on, in or around a shape (docs/rule_language.md §2.5).
#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/base/random.h"
#include "styles/grammar/shapes/flat_face.h"
#include "styles/grammar/shapes/pieces.h"

namespace blockrand::grammar {

namespace {

constexpr std::uint64_t kStream = 0x5ca77e5ull;  ///< tells these draws from the shape's own
constexpr int kMostTries = 400;                  ///< for one point; then the last one is taken

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : seed_(base::mix64(base::mix64(seed) ^ kStream)) {}
  double next() { return static_cast<double>(base::mix64(seed_ ^ base::mix64(at_++)) >> 11) * 0x1p-53; }

 private:
  std::uint64_t seed_, at_ = 0;
};

struct Sample {
  Vector3 place, normal{0, 1, 0};
};

/// Is the point inside the closed mesh? Counts crossings of a ray that is unlikely to hit edges.
bool inside(const std::vector<std::array<Vector3, 3>>& triangles, Vector3 p) {
  const Vector3 way = normalized({0.3717, 0.8671, 0.3319});
  bool in = false;
  for (const auto& [a, b, c] : triangles) {
    const Vector3 e = b - a, f = c - a, h = cross(way, f);
    const double det = dot(e, h);
    if (det == 0) continue;
    const Vector3 s = p - a, q = cross(s, e);
    const double u = dot(s, h) / det, v = dot(way, q) / det, t = dot(f, q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > 0) in = !in;
  }
  return in;
}

}  // namespace

std::vector<Shape> scatter(const Shape& shape, ScatterDomain domain, int count, ScatterDistribution distribution,
                           std::string_view mean, Vector3 deviation) {
  std::vector<Shape> out;
  const Mesh& mesh = mesh_of(shape);
  std::vector<std::array<Vector3, 3>> triangles;
  std::vector<double> sums;
  double whole = 0;
  if (domain != ScatterDomain::scope) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (const auto& t : triangles_of(mesh, f)) {
        triangles.push_back({mesh.vertices[t[0].vertex], mesh.vertices[t[1].vertex], mesh.vertices[t[2].vertex]});
        whole += length(cross(triangles.back()[1] - triangles.back()[0], triangles.back()[2] - triangles.back()[0]));
        sums.push_back(whole);
      }
    if (!(whole > 0)) return out;
  }
  const bool solid = domain == ScatterDomain::volume && is_closed(mesh);
  Draws draws(shape.seed);
  const Vector3 size = shape.size;
  Vector3 middle = size * 0.5;
  if (mean == "left") middle.x = 0;
  if (mean == "right") middle.x = size.x;
  if (mean == "bottom") middle.y = 0;
  if (mean == "top") middle.y = size.y;
  if (mean == "back") middle.z = 0;
  if (mean == "front") middle.z = size.z;
  const auto draw = [&]() -> Sample {
    if (domain != ScatterDomain::surface) {
      const double x = draws.next(), y = draws.next(), z = draws.next();
      return {{size.x * x, size.y * y, size.z * z}, {0, 1, 0}};
    }
    const double at = draws.next() * whole;
    const auto t = std::min(static_cast<std::size_t>(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin()),
                            sums.size() - 1);
    double u = draws.next(), v = draws.next();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& [a, b, c] = triangles[t];
    return {a + (b - a) * u + (c - a) * v, normalized(cross(b - a, c - a))};
  };
  const auto likely = [&](Vector3 p) {
    if (distribution == ScatterDistribution::uniform) return true;
    double exponent = 0;
    for (int i = 0; i < 3; ++i) {
      const double d = component(deviation, i);
      // Axes without extent or deviation say nothing.
      if (d > 0)
        exponent += (component(p, i) - component(middle, i)) * (component(p, i) - component(middle, i)) / (d * d);
    }
    return draws.next() < base::exp(-exponent / 2);
  };
  const int most = std::clamp(count, 0, 100000);
  for (int i = 0; i < most; ++i) {
    Sample sample;
    bool good = false;
    for (int k = 0; k < kMostTries && !good; ++k) {
      sample = draw();
      good = likely(sample.place) && (!solid || inside(triangles, sample.place));
    }
    if (solid && !inside(triangles, sample.place)) continue;
    Shape& point = out.emplace_back(shape);
    point.mesh = nullptr;
    point.size = {};
    Frame frame;
    if (domain == ScatterDomain::surface) frame = frame_with_y({}, sample.normal, {1, 0, 0});
    frame.origin = sample.place;
    point.scope = compose(shape.scope, frame);
  }
  return out;
}

}  // namespace blockrand::grammar
