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

  /// \param polygons  may overlap: what lies in one of them lies in the area \param holes  unless it lies in one of these
  explicit ClipPolygon(std::span<const Rings> polygons, std::span<const Rings> holes = {});

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
  static void add(std::span<const Rings> polygons, std::vector<Banded>& out);
  static bool holds(const std::vector<Banded>& polygons, model::Location place);

  std::vector<Banded> polygons_, holes_;
};

/// Reads a polygon filter file (.poly), as Osmosis and download servers of extracts have it (OpenStreetMap wiki, "Osmosis/Polygon
/// Filter File Format"): a name, then sections of `longitude latitude` lines that end with END, those with a ! before their name
/// are holes in all others; END at the end.
/// \throws base::InputError  with the line; every section is a hole
ClipPolygon read_poly_file(const std::string& path);

}  // namespace blockrand::importers::osm
