// Geographic positions and extents in degrees, for interfaces that are finer than OSM's 1e-7 degrees.
#pragma once

namespace blockrand::georef {

/// Degrees, longitude first.
struct LonLat {
  double lon = 0, lat = 0;
  friend bool operator==(const LonLat&, const LonLat&) = default;
};

/// Degrees. `east` < `west` means that the box crosses the antimeridian.
struct GeoBox {
  double west = 0, south = 0, east = 0, north = 0;

  double width() const { return east < west ? east + 360 - west : east - west; }

  LonLat centre() const { return at(0.5, 0.5); }

  /// The point at fractions (0..1) of width and height; longitude within [-180, 180].
  LonLat at(double fraction_east, double fraction_north) const {
    const double lon = west + fraction_east * width();
    return {lon > 180 ? lon - 360 : lon, south + fraction_north * (north - south)};
  }
};

}  // namespace blockrand::georef
