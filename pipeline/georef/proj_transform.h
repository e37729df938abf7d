// PROJ itself as a witness of where things stand: for validators, which must not use the series and frames they check.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/georef/frames.h"
#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

/// Coordinate operations computed by PROJ alone. One thread at a time: see ProjTransformPool.
class ProjTransform {
 public:
  /// The operation that proj_create_crs_to_crs chooses between WGS 84 and a projected CRS ("EPSG:25833").
  /// \param area  where it will be used, degrees
  /// \throws base::UsageError  where PROJ knows no such CRS or operation
  ProjTransform(const std::string& crs, const GeoBox& area);
  /// A PROJ pipeline from longitude and latitude in degrees to easting and northing in metres.
  explicit ProjTransform(const std::string& pipeline);
  ~ProjTransform();
  ProjTransform(ProjTransform&&) noexcept;
  ProjTransform& operator=(ProjTransform&&) noexcept;

  model::Point2 forward(LonLat p);  ///< not finite where undefined
  /// Inverse of forward, corrected once where the operation drops heights on the way (datum shifts).
  LonLat inverse(model::Point2 p);
  Geodetic to_geodetic(const model::Point3& ecef);
  model::Point3 to_ecef(const Geodetic& place);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Witnesses for a pipeline, made when a thread first wants one and used again.
class ProjTransformPool {
 public:
  explicit ProjTransformPool(std::string pipeline) : pipeline_(std::move(pipeline)) {}

  template <class Use>
  void with(Use&& use) {
    std::unique_ptr<ProjTransform> proj_transform;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        proj_transform = std::move(idle_.back());
        idle_.pop_back();
      }
    }
    if (!proj_transform) proj_transform = std::make_unique<ProjTransform>(pipeline_);
    use(*proj_transform);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(proj_transform));
  }

 private:
  std::string pipeline_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ProjTransform>> idle_;
};

}  // namespace blockrand::georef
