// The polygon that a region's data are cut to, as osmium-tool's `extract --strategy smart` cuts.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::importers::osm {

/// An area of the Earth. Asked for every node of an extract: edges are kept in bands of latitude.
class ClipPolygon {
 public:
  using Rings = std::vector<std::vector<model::Location>>;  ///< outer ones and holes in any order (even-odd)

  /// \param polygons  may overlap: what lies in one of them lies in the area
  explicit ClipPolygon(std::span<const Rings> polygons);

  /// Exact. Of two areas that share a border, a point on it lies in one.
  bool contains(model::Location place) const;

 private:
  struct Edge {
    model::Location low, high;  ///< low.lat < high.lat
  };
  struct Banded {
    std::int64_t south = 0, north = 0, height = 1;  ///< of the whole; of a band
    std::vector<std::vector<Edge>> bands;
  };
  std::vector<Banded> polygons_;
};

/// Reads a polygon filter file (.poly), as Osmosis and download servers of extracts have it (OpenStreetMap wiki, "Osmosis/Polygon
/// Filter File Format"): a name, then sections of `longitude latitude` lines that end with END, those with a ! before their name
/// are holes; END at the end.
/// \throws base::InputError  with the line
std::vector<ClipPolygon::Rings> read_poly_file(const std::string& path);

}  // namespace blockrand::importers::osm
