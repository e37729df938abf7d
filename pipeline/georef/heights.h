// From heights above sea level, or in any other height system, to heights above the ellipsoid.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace blockrand::georef {

/// EGM96, the geoid whose grid is always there.
inline constexpr const char* kEgm96 = "EPSG:5773";

/// EVRF2000, which PROJ reaches from most of Europe's height systems without a grid. Its zero level is EGM96's to about
/// half a metre.
inline constexpr const char* kEuropeanLevels = "EPSG:5730";

/// The surface of height 0 of a vertical CRS.
///
/// From PROJ's installed grids where it has one; Debian has EGM96's alone (egm96_15.gtx: 15' spacing, bilinear). Else
/// EGM96 stands in: after PROJ's shift to EVRF2000 where there is one (Vienna's zero lies 156.68 m above the Adriatic),
/// else as if the heights were above EGM96. Operations that PROJ calls "ballpark" are refused. Safe for const use from
/// any thread; copies are cheap.
class Geoid {
 public:
  /// \param vertical_crs  "EPSG:5773"; empty: one that PROJ does not know
  explicit Geoid(const std::string& vertical_crs = kEgm96);

  /// Whether PROJ has a grid at all. If not, every undulation is nothing; remedy() says what to install.
  bool available() const;
  /// Whether EGM96 stands in for the CRS.
  bool stands_in() const;
  /// What leads to the ellipsoid, in words: "EGM96", "EGM96 in place of DHHN2016 height, …".
  const std::string& words() const;
  /// Of the operation as PROJ states it, m; -1 unknown, and where EGM96 stands in.
  double accuracy_m() const;
  static std::string remedy();

  /// Metres from the ellipsoid (WGS 84) up to the height 0, rounded to 1/1024 m: add it to a height in metres. Nothing
  /// without a grid, or outside of it.
  std::optional<double> undulation(double lon_deg, double lat_deg) const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace blockrand::georef
