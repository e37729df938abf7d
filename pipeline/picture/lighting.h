// How much light of the sun and the sky arrives anywhere in a scene: worked out once, for pictures from all sides.
#pragma once

#include <memory>
#include <vector>

#include "pipeline/picture/depth_map.h"
#include "pipeline/picture/render.h"
#include "pipeline/picture/sky_field.h"

namespace blockrand::picture {

/// Shadow map and map of the sky of a scene, as the options ask for them. Memory: two bytes a cell of the shadow map, 32 a cell of
/// the sky's; copies share them.
class Lighting {
 public:
  /// \param scene  what throws shadows and takes light of the sky away; it may be simpler than what is pictured
  Lighting(const Scene& scene, const RenderOptions& options);

  /// A finer shadow map for a part of the scene; what it does not cover is looked up in the others.
  /// \param scene  throws the shadows there; same origin
  /// \param box    in the scene's coordinates
  void refine(const Scene& scene, const Box& box, int cells);

  // ---- for the renderer: scene's local coordinates

  Point3 to_sun() const { return sun_; }
  /// Of what arrives from the sun on a surface that faces it, in [0, 1].
  float sun(Scene::Vector place, Scene::Vector normal) const {
    if (maps_.empty()) return 1;
    for (const auto& each : maps_) {
      const DepthMap& map = *each;
      // Raised by two cells, so that a surface does not shade itself.
      const auto lift = static_cast<float>(2.2 * map.cell());
      const DepthMap::Vector at =
          map.locate(place.x + normal.x * lift, place.y + normal.y * lift, place.z + normal.z * lift);
      if (map.covers(at)) return map.soft(at);
    }
    return 1;
  }
  const SkyField* sky() const { return sky_.get(); }  ///< null: none was asked for

 private:
  Point3 sun_;
  std::vector<std::shared_ptr<const DepthMap>> maps_;  ///< the finest first
  std::shared_ptr<const SkyField> sky_;
};

}  // namespace blockrand::picture
