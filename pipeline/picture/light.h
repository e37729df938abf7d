// How much light from the sun and the sky arrives at what is seen. Internal to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/picture/render.h"
#include "pipeline/picture/view.h"

namespace blockrand::picture {

inline constexpr std::uint32_t kNothing = 0xffffffff, kGroundPlane = 0xfffffffe;

/// What each sample sees.
struct Samples {
  std::vector<float> nearness;
  std::vector<std::uint32_t> what;  ///< triangle, kGroundPlane or kNothing
};

/// Unit normal of what a sample sees, towards the eye.
Scene::Vector normal_towards(const Scene& scene, std::uint32_t what, const View& view, int x, int y);

/// Light per sample, as a share of what an open field gets.
struct Light {
  std::vector<std::uint8_t> sun;  ///< 255: nothing in the way
  std::vector<float> sky;         ///< 1: the whole half-space in front of the surface is open; empty: not asked for
};

/// Each of the directions to the sky is asked by every `supersampling`²-th sample only, so that a pixel gets the mean of
/// all of them for the price of one sample.
/// \param occluders  as render() has it
Light light_of(const Scene& scene, const View& view, const Samples& samples, const RenderOptions& options,
               const Scene& occluders);

/// Unit vector towards the sun.
Point3 to_sun(const RenderOptions& options);

}  // namespace blockrand::picture
