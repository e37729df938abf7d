// PROJ itself as a witness of where things stand: for judges, which must not use the series and frames they judge.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/georef/frames.h"
#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

/// Coordinate operations computed by PROJ alone. One thread at a time: see WitnessPool.
class Witness {
 public:
  /// The operation that proj_create_crs_to_crs chooses between WGS 84 and a projected CRS ("EPSG:25833").
  /// \param area  where it will be used, degrees
  /// \throws base::UsageError  where PROJ knows no such CRS or operation
  Witness(const std::string& crs, const GeoBox& area);
  /// A PROJ pipeline from longitude and latitude in degrees to easting and northing in metres.
  explicit Witness(const std::string& pipeline);
  ~Witness();
  Witness(Witness&&) noexcept;
  Witness& operator=(Witness&&) noexcept;

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
class WitnessPool {
 public:
  explicit WitnessPool(std::string pipeline) : pipeline_(std::move(pipeline)) {}

  template <class Use>
  void with(Use&& use) {
    std::unique_ptr<Witness> witness;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        witness = std::move(idle_.back());
        idle_.pop_back();
      }
    }
    if (!witness) witness = std::make_unique<Witness>(pipeline_);
    use(*witness);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(witness));
  }

 private:
  std::string pipeline_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Witness>> idle_;
};

}  // namespace blockrand::georef
