// From heights above sea level to heights above the ellipsoid.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace blockrand::georef {

/// The EGM96 geoid (EPSG:5773), from PROJ's installed grid egm96_15.gtx: 15' spacing, bilinear.
///
/// Safe for const use from any thread; copies are cheap.
class Geoid {
 public:
  Geoid();

  /// Whether the grid is there. If not, every undulation is nothing; remedy() says what to install.
  bool available() const;
  const std::string& operation() const;  ///< PROJ's name of the operation
  static std::string remedy();

  /// Metres from the ellipsoid up to the geoid (add it to a height above sea level), rounded to 1/1024 m. Nothing
  /// without the grid or outside of the globe.
  std::optional<double> undulation(double lon_deg, double lat_deg) const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

/// Geoid::undulation with one shared Geoid.
std::optional<double> geoid_undulation(double lon_deg, double lat_deg);

}  // namespace blockrand::georef
