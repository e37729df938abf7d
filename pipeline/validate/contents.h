// What a file of a build holds, in the same terms for every format, so that formats can be compared.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/validate/finding.h"

namespace blockrand::validate {

/// One planar polygon with holes; rings without a repeated last point, outer counter-clockwise from outside.
struct ReadPolygon {
  std::vector<std::vector<model::Point3>> rings;
  std::string kind;    ///< "ground", "wall", "roof", "outer_ceiling", "outer_floor", "closure", "window", "door"; empty
                       ///< where not said
  std::string colour;  ///< "#rrggbb" in sRGB; empty where not said
};

/// A closed boundary as read, or a MultiSurface in its place, in the build CRS (GLB: in its own frame).
struct ReadSolid {
  int lod = 0;
  std::vector<ReadPolygon> polygons;
  bool closed = true;  ///< false: a MultiSurface, which need not bound anything
};

/// A window or door in a wall of a LoD3 solid.
struct ReadOpening {
  std::string id;
  std::size_t polygon = 0;  ///< into the LoD3 solid's polygons: what closes the opening, its kind is "window" or "door"
  std::size_t wall = 0;     ///< the polygon that it opens
  std::vector<std::size_t> reveals;      ///< the other polygons of the wall's surface, at its first opening alone
  std::optional<std::size_t> placement;  ///< into ReadDetail::placements: the element that stands in it
  double depth = 0;                      ///< m: how far it is said to lie behind its wall, where it is drawn flat
};

/// An element where it stands.
struct ReadPlacement {
  std::uint64_t element = 0;  ///< of its polygons and colours: the same for equal elements
  model::Point3 origin;       ///< build CRS
  model::Point2 along;        ///< its x axis
  friend auto operator<=>(const ReadPlacement&, const ReadPlacement&) = default;
};

/// What is known of an element wherever it stands.
struct ReadElement {
  std::vector<std::string> colours;  ///< of its polygons, sorted, each once
  model::Point3 min, max;            ///< m, in its own frame: x right, y into the wall, z up
};

/// A closed body of its own on a wall or roof.
struct ReadInstallation {
  std::string id, kind;
  std::vector<ReadPolygon> polygons;
};

/// What LoD3 adds to a body beside its solid.
struct ReadDetail {
  std::vector<ReadOpening> openings;
  std::vector<ReadPlacement> placements;
  std::vector<ReadInstallation> installations;
};

/// A building part with geometry of its own; the whole building where it has no parts.
struct ReadBody {
  std::string id;        ///< "w123", "w123.w456", "w123.rest"
  std::string building;  ///< "w123"
  /// Attribute → text: names as in model::for_each_attribute, and `<name>_source`, `<name>_confidence`, `built_roof`,
  /// `lod`. Numbers as the shortest text of their value. Absent where the file does not say.
  std::map<std::string, std::string> attributes;
  std::vector<ReadPolygon> footprint;  ///< LoD0
  std::vector<ReadSolid> solids;
  ReadDetail detail;
};

struct Contents {
  std::vector<std::string> buildings;  ///< ids in file order, doubles included
  std::vector<ReadBody> bodies;
  std::map<std::uint64_t, ReadElement> elements;  ///< those placed, by ReadPlacement::element
  std::vector<Finding> findings;                  ///< breaches of the format's own rules
};

}  // namespace blockrand::validate
