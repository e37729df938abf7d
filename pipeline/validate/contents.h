// What a file of a build holds, in the same terms for every format, so that formats can be compared.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/validate/finding.h"

namespace blockrand::validate {

/// One planar polygon with holes; rings without a repeated last point, outer counter-clockwise from outside.
struct ReadPolygon {
  std::vector<std::vector<model::Point3>> rings;
  std::string kind;    ///< "ground", "wall", "roof", "outer_ceiling", "outer_floor", "closure"; empty where not said
  std::string colour;  ///< "#rrggbb" in sRGB; empty where not said
};

/// A closed boundary as read, in the build CRS (GLB: in its own frame).
struct ReadSolid {
  int lod = 0;
  std::vector<ReadPolygon> polygons;
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
};

struct Contents {
  std::vector<std::string> buildings;  ///< ids in file order, doubles included
  std::vector<ReadBody> bodies;
  std::vector<Finding> findings;  ///< breaches of the format's own rules
};

}  // namespace blockrand::validate
