// What a map says of the ground that an image shows: where buildings stand, streets and railways run, water lies.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"
#include "pipeline/observation/image_windows.h"

namespace blockrand::observation {

/// Of a pixel, what the map has there.
enum class Mapped : std::uint8_t {
  nothing,
  building,  ///< a roof or a wall of it, by the lean of the image, or what is within `kBesideBuilding` of one
  ground     ///< street, railway, water, car park, sports pitch: no building stands there
};

/// m: about mapped buildings, which may stand as far from where they are mapped.
inline constexpr double kBesideBuilding = 1.5;

/// Read-only after construction, safe from any thread.
class MappedGround {
 public:
  /// \param lean  m: how far the image shows a building's roof from its plan, by its number. All references outlive this.
  /// \param shift  m: how far it shows the ground
  MappedGround(const model::Extract& extract, const footprints::FootprintStore& footprints,
               const footprints::BoxIndex& index, const georef::Projection& projection,
               const std::function<model::Point2(std::uint32_t)>& lean, model::Point2 shift);

  /// Of each pixel of a patch, row by row.
  std::vector<Mapped> on(const Patch& patch) const;
  /// m: how far the image shows a building's roof from its plan.
  model::Point2 lean(std::uint32_t building) const { return leans_[building]; }

 private:
  /// A line with a width, or an area.
  struct Way {
    std::vector<std::vector<model::Point2>> rings;
    double half = 0;  ///< m; of an area 0
    geometry::PlanBox box;
  };
  void fill_buildings(const Patch& patch, std::vector<std::uint8_t>& filled) const;

  const footprints::FootprintStore& footprints_;
  const footprints::BoxIndex& index_;
  std::vector<model::Point2> leans_;
  double farthest_ = 0;  ///< m: of `leans_`
  std::vector<Way> ways_;
  geometry::BoxIndex way_index_;
};

/// Sets to 1 what lies within rings, by pixel centres and the even-odd rule. \param shift  m: of the rings
void fill_rings(const Patch& patch, std::span<const std::span<const model::Point2>> rings, model::Point2 shift,
                std::vector<std::uint8_t>& filled);

}  // namespace blockrand::observation
