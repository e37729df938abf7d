#include "pipeline/picture/lighting.h"

#include "pipeline/base/portable_math.h"

namespace blockrand::picture {
namespace {

Box box_under_sun(const Scene& scene, Box box) {
  box.min = box.min - scene.origin();
  box.max = box.max - scene.origin();
  return box;
}

}  // namespace

Lighting::Lighting(const Scene& scene, const RenderOptions& options) {
  const base::SinCos a = base::sin_cos(options.sun_azimuth * base::kRadiansPerDegree);
  const base::SinCos e = base::sin_cos(options.sun_elevation * base::kRadiansPerDegree);
  sun_ = {a.sin * e.cos, a.cos * e.cos, e.sin};
  if (!options.lit || scene.empty()) return;
  if (options.shadows)
    maps_.push_back(std::make_shared<DepthMap>(scene, sun_, box_under_sun(scene, scene.bounds()), options.shadow_map));
  if (options.sky_occlusion) sky_ = std::make_shared<SkyField>(scene, options.sky_map);
}

void Lighting::refine(const Scene& scene, const Box& box, int cells) {
  if (!maps_.empty())
    maps_.insert(maps_.begin(), std::make_shared<DepthMap>(scene, sun_, box_under_sun(scene, box), cells));
}

}  // namespace blockrand::picture
