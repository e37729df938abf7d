// Any coordinate operation of PROJ, made once, usable from every thread.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

/// Two-dimensional transformation between two CRS, longitude or easting first whatever the authority says.
///
/// One operation is chosen when it is made (the best one for `area` whose grids are installed) and kept for every
/// point. Copies share it. Const use is safe from any number of threads: each borrows a PROJ context of its own. Where
/// the operation is a transverse Mercator projection and nothing else, our own series does it (see portable()).
class Transform {
 public:
  /// \param from, to  what PROJ understands: "EPSG:4326", WKT, PROJ JSON. Vertical parts are ignored.
  /// \param area      where it will be used, degrees; chooses between operations
  /// \throws base::UsageError  when a CRS is unknown or only a "ballpark" operation (an unknown datum shift) exists
  Transform(const std::string& from, const std::string& to, const std::optional<GeoBox>& area = {});

  /// From a PROJ pipeline as pipeline() returns it: the pinned operation of an earlier build.
  static Transform from_pipeline(const std::string& pipeline, const std::optional<GeoBox>& area = {});

  /// Degrees in when `from` is geographic, degrees out when `to` is. Not finite where the operation is undefined.
  model::Point2 forward(model::Point2 p) const;
  model::Point2 inverse(model::Point2 p) const;

  /// Name that PROJ gives the operation; empty for from_pipeline.
  const std::string& operation() const;
  /// Metres as PROJ states it; 0 for a projection on the same datum, -1 when unknown.
  double accuracy_m() const;
  const std::string& pipeline() const;
  /// Whether results are bit-identical on every x86-64. True for transverse Mercator (agreement with PROJ within 1e-6 m
  /// was checked over `area`) and for operations that change nothing.
  bool portable() const;
  /// Metres of CRS per metre on the ground where our own series works; nothing elsewhere.
  std::optional<double> own_scale(LonLat p) const;

 private:
  struct Impl;
  explicit Transform(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

/// What a CRS definition says about heights.
struct VerticalCrs {
  std::string name;            ///< "DHHN2016 height"; empty when there is none
  std::string authority_code;  ///< "EPSG:7837"; empty when the definition has no code
  double metres_per_unit = 1;
  bool downwards = false;    ///< depths instead of heights
  bool ellipsoidal = false;  ///< a CRS of three dimensions: above its ellipsoid; then without a name
};

/// The vertical part of a compound CRS, or a vertical CRS itself; empty name for any other.
VerticalCrs vertical_crs_of(const std::string& definition);

/// Name and "EPSG:code" (or "") of a CRS definition's horizontal part; both empty when PROJ does not know it.
struct CrsName {
  std::string name, authority_code;
};
CrsName name_of_crs(const std::string& definition);

}  // namespace blockrand::georef
