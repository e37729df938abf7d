// A city model as a comparison sees it: the outside of every building as plane polygons, whatever format it came in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importers/reference/reference_model.h"
#include "pipeline/model/point.h"
#include "pipeline/model/polygon.h"

namespace blockrand::compare {

using model::Point2;
using model::Point3;

/// What a face of the outer hull is.
enum class Hull : std::uint8_t {
  ground,
  wall,
  roof,
  closure,
  outer_ceiling,  ///< underside of passages, bays and raised parts
  outer_floor,    ///< terraces, loggias
  installation,   ///< chimneys, dormers, balconies, stairs modelled apart
};
inline constexpr int kHullCount = 7;
std::string_view name_of(Hull hull);

/// Why a face of the reference takes no part in the measures "without what is left out".
enum class LeftOut : std::uint8_t {
  no,
  ground,   ///< the underside: nobody sees it, and how deep it lies is convention
  covered,  ///< a party wall: another building of the same model stands against it
  blank,    ///< a side without openings of a building that has some elsewhere: not modelled, not windowless
};
inline constexpr int kLeftOutCount = 4;
std::string_view name_of(LeftOut left_out);

/// Outer ring first, then holes; the last point is not repeated. Metres, relative to City::origin; z is the model's own
/// height. Rings are neither checked nor repaired.
using Rings3 = std::vector<std::vector<Point3>>;

/// A (nearly) plane polygon of a building's outside.
struct Face {
  Hull hull = Hull::wall;
  bool stated = true;  ///< the class is the file's; else it was told from the normal
  LeftOut left_out = LeftOut::no;
  Rings3 rings;
  Point3 normal;    ///< unit vector as the ring's order says (outwards in a sound model); zero for a face of no area
  double area = 0;  ///< m², holes taken off
};

/// A window or door. Its polygons may lie in the wall's plane or be set back from it.
struct Opening {
  bool door = false;
  std::string id;
  std::vector<Rings3> polygons;
  double area = 0;  ///< m² of the polygons that face outwards, seen along the wall's normal
  Point3 normal;    ///< of the polygon with the largest area
};

/// A closed shell as the file gives it: indices into Building::faces are not kept, since voids and shared walls may be
/// part of it.
struct Shell {
  std::vector<Rings3> polygons;
  bool outer = true;  ///< else the shell of a void
};

struct Building {
  std::string id;                         ///< as the file has it
  std::uint32_t file = 0;                 ///< index into City::files
  std::vector<model::Polygon> footprint;  ///< strictly simple, largest first; relative to City::origin
  double footprint_area = 0;              ///< m²
  double ground = 0;                      ///< z of its own ground, m
  int lod = -1;                           ///< the level of detail that was taken
  std::vector<Face> faces;                ///< of the building and its parts, interiors left out
  std::vector<Opening> openings;
  std::vector<Shell> shells;   ///< of its solids, in the file's order
  bool all_in_shells = true;   ///< every part that has a body has a solid
  int bodies = 0;              ///< the building and parts of it that have faces of their own
  std::optional<int> storeys;  ///< above ground, as stated (the most of building and parts)
  std::string roof_type;       ///< code or text as stated; empty without one
  std::size_t triangles = 0;   ///< that its polygons (openings included) make
};

/// What is known of one file of a model.
struct CityFile {
  std::string path, format, crs;
  std::uint64_t bytes = 0;
  std::size_t buildings = 0, breaches = 0;
  std::vector<importers::reference::Note> notes;
};

/// All buildings of one side of the comparison, sorted by id, then by place.
struct City {
  std::string name;  ///< for people: the path as given
  std::vector<CityFile> files;
  std::string attribution;        ///< whose data it shows, where it is a build of ours; empty: not known
  std::string crs;                ///< common to both cities: "EPSG:25833"
  Point2 origin;                  ///< of all x and y in it, m in `crs`; common to both cities
  std::string height_reference;   ///< for people: "EPSG:5783", "above local ground", "unknown" …
  bool absolute_heights = false;  ///< z means a height over sea level or an ellipsoid, on real terrain
  std::vector<Building> buildings;
  std::size_t without_geometry = 0;  ///< buildings of the files that have no polygon with an area
  std::size_t out_of_reach = 0;      ///< buildings that were read and lie farther than the margin from the other city
  std::size_t repetitions = 0;       ///< buildings that stand where one of an earlier file stands; left out
};

}  // namespace blockrand::compare
