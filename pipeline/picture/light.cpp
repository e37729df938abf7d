#include "pipeline/picture/light.h"

#include <algorithm>

#include "pipeline/base/portable_math.h"
#include "pipeline/picture/depth_map.h"

namespace blockrand::picture {
namespace {

/// So many times its height a building throws a shadow that counts: the lowest direction to the sky that is asked for
/// rises by 0.17 in 1, and longer shadows of the evening are cut there.
constexpr double kReach = 6;

/// Towards the sky, denser near the zenith as a level surface counts it: Fibonacci's spiral with the sine of the angle
/// from the zenith as the square root of a uniform series (Malley's method).
std::vector<Point3> sky_directions(int count) {
  std::vector<Point3> out;
  const double golden = base::kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    // Neighbours in the list lie far apart on the dome, so that every n-th of them still covers it.
    const double share = (i + 0.5) / count * 0.97;  // the last degrees above the horizon would need endless maps
    const double across = std::sqrt(share);
    const base::SinCos turn = base::sin_cos(golden * i);
    out.push_back({across * turn.cos, across * turn.sin, std::sqrt(1 - share)});
  }
  return out;
}

/// Who asks for light.
struct Receivers {
  std::vector<bool> asks;  ///< per sample: it sees something that a shadow could reach
  Box box;                 ///< of those, in the scene's local coordinates
};

Receivers receivers_of(const Scene& scene, const View& view, const Samples& samples) {
  Receivers out;
  out.asks.assign(samples.what.size(), false);
  const Box bounds = scene.bounds();
  if (bounds.empty) return out;
  Point3 low = bounds.min - scene.origin(), high = bounds.max - scene.origin();
  const double reach = scene.ground() ? kReach * std::max(0.0, high.z - scene.ground()->z) : 0;
  low = {low.x - reach, low.y - reach, 0};
  high = {high.x + reach, high.y + reach, 0};
  std::size_t i = 0;
  for (int y = 0; y < view.height(); ++y)
    for (int x = 0; x < view.width(); ++x, ++i) {
      if (samples.what[i] == kNothing) continue;
      const Point3 p = view.position(x + 0.5, y + 0.5, samples.nearness[i]);
      if (samples.what[i] == kGroundPlane && (p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y)) continue;
      out.asks[i] = true;
      out.box.include(p);
    }
  return out;
}

/// Calls `visit(index, x, y, normal)` for every sample that asks, where (x + y * supersampling) within the pixel is
/// `phase`; -1: all.
template <class Visit>
void each_sample(const Scene& scene, const View& view, const Samples& samples, const Receivers& receivers,
                 int supersampling, int phase, Visit&& visit) {
  const int step = phase < 0 ? 1 : supersampling;
  const int x0 = phase < 0 ? 0 : phase % supersampling, y0 = phase < 0 ? 0 : phase / supersampling;
  std::uint32_t last = kNothing;
  Scene::Vector normal;
  for (int y = y0; y < view.height(); y += step) {
    std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width()) + static_cast<std::size_t>(x0);
    for (int x = x0; x < view.width(); x += step, i += static_cast<std::size_t>(step)) {
      if (!receivers.asks[i]) continue;
      const std::uint32_t what = samples.what[i];
      if (what != last) {
        normal = normal_towards(scene, what, view, x, y);
        last = what;
      }
      visit(i, x, y, normal);
    }
  }
}

}  // namespace

Point3 to_sun(const RenderOptions& options) {
  const base::SinCos a = base::sin_cos(options.sun_azimuth * base::kRadiansPerDegree);
  const base::SinCos e = base::sin_cos(options.sun_elevation * base::kRadiansPerDegree);
  return {a.sin * e.cos, a.cos * e.cos, e.sin};
}

Scene::Vector normal_towards(const Scene& scene, std::uint32_t what, const View& view, int x, int y) {
  if (what == kGroundPlane) return {0, 0, 1};
  const Scene::Triangle& t = scene.triangles()[what];
  if (t.closed) return t.normal;
  const Point3 d = view.direction(x + 0.5, y + 0.5);
  const bool behind = t.normal.x * d.x + t.normal.y * d.y + t.normal.z * d.z > 0;
  return behind ? Scene::Vector{-t.normal.x, -t.normal.y, -t.normal.z} : t.normal;
}

Light light_of(const Scene& scene, const View& view, const Samples& samples, const RenderOptions& options,
               const Scene& occluders) {
  Light light;
  light.sun.assign(samples.what.size(), 255);
  const Receivers receivers = receivers_of(scene, view, samples);
  if (receivers.box.empty) return light;

  // A place asks for light from a little in front of its surface: depth maps are stairs.
  const auto place = [&](const DepthMap& map, std::size_t i, int x, int y, const Scene::Vector& n, float lift) {
    const Point3 p = view.position(x + 0.5, y + 0.5, samples.nearness[i]);
    return map.locate(static_cast<float>(p.x) + n.x * lift, static_cast<float>(p.y) + n.y * lift,
                      static_cast<float>(p.z) + n.z * lift);
  };

  const int ss = options.supersampling;
  if (options.shadows) {
    DepthMap map(options.shadow_map);
    const Point3 sun = to_sun(options);
    map.draw(scene, sun, receivers.box);
    const auto lift = static_cast<float>(2.2 * map.cell());
    each_sample(scene, view, samples, receivers, ss, -1, [&](std::size_t i, int x, int y, const Scene::Vector& n) {
      if (n.x * sun.x + n.y * sun.y + n.z * sun.z <= 0) {
        light.sun[i] = 0;
        return;
      }
      light.sun[i] = static_cast<std::uint8_t>(map.soft(place(map, i, x, y, n, lift)) * 255.0f + 0.5f);
    });
  }

  if (options.sky_occlusion) {
    const int phases = ss * ss;
    const int count = (options.sky_directions + phases - 1) / phases * phases;
    const std::vector<Point3> directions = sky_directions(count);
    light.sky.assign(samples.what.size(), 1);
    DepthMap map(options.sky_map);
    // What a sample got, and what it would get in the open from the same directions.
    struct Asker {
      float x, y, z;
      Scene::Vector normal;
      float got, open;
      std::uint32_t index;
    };
    std::vector<Asker> askers;
    for (int phase = 0; phase < phases; ++phase) {
      askers.clear();
      each_sample(scene, view, samples, receivers, ss, phase, [&](std::size_t i, int x, int y, const Scene::Vector& n) {
        const Point3 p = view.position(x + 0.5, y + 0.5, samples.nearness[i]);
        askers.push_back({.x = static_cast<float>(p.x),
                          .y = static_cast<float>(p.y),
                          .z = static_cast<float>(p.z),
                          .normal = n,
                          .got = 0,
                          .open = 0,
                          .index = static_cast<std::uint32_t>(i)});
      });
      for (int d = phase; d < count; d += phases) {
        const Point3& to_light = directions[static_cast<std::size_t>(d)];
        const float lx = static_cast<float>(to_light.x), ly = static_cast<float>(to_light.y),
                    lz = static_cast<float>(to_light.z);
        map.draw(occluders, to_light, receivers.box);
        const auto lift = static_cast<float>(1.1 * map.cell());
        for (Asker& a : askers) {
          const Scene::Vector& n = a.normal;
          const float cosine = n.x * lx + n.y * ly + n.z * lz;
          if (!(cosine > 0)) continue;
          // The series is dense where a level surface counts most: each direction stands for its part of the dome divided
          // by its height.
          const float weight = cosine / lz;
          a.open += weight;
          if (map.lit(map.locate(a.x + n.x * lift, a.y + n.y * lift, a.z + n.z * lift))) a.got += weight;
        }
      }
      // A surface that faces none of this phase's directions (an overhang) gets half.
      for (const Asker& a : askers) light.sky[a.index] = a.open > 0 ? std::min(1.0f, a.got / a.open) : 0.5f;
    }
  }
  return light;
}

}  // namespace blockrand::picture
