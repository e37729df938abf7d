// From longitude and latitude to the build's coordinates and back.
#pragma once

#include <span>

#include "pipeline/georef/crs.h"
#include "pipeline/georef/lon_lat.h"
#include "pipeline/georef/transform.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

/// WGS 84 degrees to metres in the build CRS. Results are not snapped to the model's grid: model::snap does that.
///
/// Safe for const use from any thread; copies are cheap and share everything.
class Projection {
 public:
  /// \param extent  where the build lies, degrees: there our series is compared with PROJ
  /// \throws base::UsageError when PROJ cannot use the pinned pipeline
  Projection(Crs crs, const GeoBox& extent);

  /// Metres, x east, y north; not finite where the CRS is not defined.
  model::Point2 forward(double lon_deg, double lat_deg) const;
  model::Point2 forward(model::Location location) const {
    return forward(location.lon_degrees(), location.lat_degrees());
  }
  void forward(std::span<const model::Location> in, std::span<model::Point2> out) const;  ///< out as long as in
  void forward(std::span<const LonLat> in, std::span<model::Point2> out) const;           ///< out as long as in

  LonLat inverse(model::Point2 p) const;
  void inverse(std::span<const model::Point2> in, std::span<LonLat> out) const;  ///< out as long as in

  /// Metres in the CRS per metre on the ellipsoid at that place: divide lengths by it. The point scale for conformal
  /// projections, else the square root of the areal scale.
  double grid_scale(double lon_deg, double lat_deg) const;

  /// Whether results have the same bits on every x86-64. False where PROJ itself does the work (datum shifts,
  /// projections other than transverse Mercator): there the model's 1/1024 m grid hides differing last bits but for
  /// rare ties.
  bool portable() const { return transform_.portable(); }

  const Crs& crs() const { return crs_; }

 private:
  Crs crs_;
  Transform transform_;
};

}  // namespace blockrand::georef
