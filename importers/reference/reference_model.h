// Hand-built, surveyed and generated models as plain data: what a comparison needs of them, whatever format they came
// in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/point.h"

namespace blockrand::importers::reference {

/// A flat face with its boundary rings; the last point is not repeated. Coordinates as the file has them, in the
/// model's CRS, x east (or longitude), y north (or latitude), z up. Rings are neither checked nor repaired.
struct Polygon3 {
  std::string id;  ///< gml:id; may be empty, and is where the format has none
  std::vector<model::Point3> outer;
  std::vector<std::vector<model::Point3>> holes;
  std::optional<model::Colour> colour = {};  ///< of glTF materials; other formats' appearances are not read
};

/// A use of a polygon: several geometries share one through xlinks.
struct Face {
  std::uint32_t polygon = 0;  ///< index into ReferenceModel::polygons
  bool reversed = false;      ///< seen from the other side (OrientableSurface with orientation "-")
  friend bool operator==(const Face&, const Face&) = default;
};

enum class GeometryKind : std::uint8_t {
  solid,      ///< one gml:Solid
  surfaces,   ///< a MultiSurface, MultiGeometry or anything else with faces
  footprint,  ///< lod0FootPrint
  roof_edge,  ///< lod0RoofEdge
};

struct Geometry {
  int lod = 0;  ///< 0 to 4, as the property's name says
  GeometryKind kind = GeometryKind::surfaces;
  std::string id;               ///< of the solid; empty for any other kind
  std::vector<Face> faces;      ///< of a solid: the outer shell, then the shells of voids
  std::size_t outer_faces = 0;  ///< how many of `faces` belong to the outer shell; all for other kinds
};

enum class SurfaceClass : std::uint8_t {
  ground,
  wall,
  roof,
  closure,
  outer_ceiling,
  outer_floor,
  floor,
  ceiling,
  interior_wall,
  installation,  ///< a BuildingInstallation's own geometry: chimneys, balconies, dormers, stairs
  room,          ///< a Room's own geometry
  furniture,
};
/// "ground", "wall", … as the enumerators.
std::string_view name_of(SurfaceClass surface_class);

struct Opening {
  bool door = false;  ///< else a window
  std::string id;
  std::vector<Geometry> geometries;  ///< one or more per level of detail
};

/// A thematic surface, or another object with geometry of its own that belongs to the building.
struct Surface {
  SurfaceClass surface_class = SurfaceClass::wall;
  std::string id;
  bool interior = false;         ///< inside of a Room or interior installation
  bool of_installation = false;  ///< bounds a BuildingInstallation
  std::vector<Geometry> geometries;
  std::vector<Opening> openings;
};

/// A Building or BuildingPart.
struct Building {
  std::string id;   ///< gml:id as it stands, may be empty or no valid XML name
  int parent = -1;  ///< index of the building (or part) that this is a part of; -1 for a Building
  int line = 0;     ///< where it starts in the file; 0: the format has no lines
  std::vector<std::string> names;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< generic ones, in order; of a set: "set/name"
  std::optional<double> measured_height;                        ///< m
  std::optional<int> storeys_above_ground, storeys_below_ground;
  std::optional<int> year_of_construction, year_of_demolition;
  std::string roof_type;   ///< code or text as it stands; empty when not given
  std::string class_code;  ///< as it stands
  std::vector<std::string> functions, usages;
  std::vector<Geometry> geometries;  ///< the building's own: solids, multi-surfaces, footprints
  std::vector<Surface> surfaces;
  std::size_t implicit_geometries = 0;  ///< uses of a template that were not read: from another file, or broken
};

enum class AxisOrder : std::uint8_t { automatic, east_first, north_first };

/// What is known about the heights. Absolute ones of two models can be compared only where both have a ground that is
/// real terrain, and one height system leads to the other.
enum class HeightReference : std::uint8_t {
  unknown,             ///< the file says nothing
  vertical_crs,        ///< ReferenceCrs::vertical
  sea_level,           ///< above some sea level that no code names
  ellipsoidal,         ///< above the ellipsoid
  above_local_ground,  ///< no terrain: all buildings stand at one height, 0 or another
};
/// "unknown", "vertical_crs", … as the enumerators.
std::string_view name_of(HeightReference reference);

/// Where a file says it lies, and how its coordinates were understood.
struct ReferenceCrs {
  std::string stated;      ///< srsName, referenceSystem … as it stands in the file; empty without one
  std::string horizontal;  ///< for PROJ: "EPSG:25833"
  std::string name;        ///< "ETRS89 / UTM zone 33N"
  std::string vertical;    ///< "EPSG:5783"; empty when none is stated or it has no code
  bool geographic = false;
  double metres_per_unit = 1;
  AxisOrder axis_order = AxisOrder::east_first;  ///< of the file; the model's is always east first
  bool from_options = false;                     ///< given by the caller
  HeightReference height_reference = HeightReference::unknown;
  std::string height_words;  ///< what the file says of its heights in words; may be empty
};

/// What was found while reading, counted by kind. All but the first two are breaches of the standard or damage.
enum class NoteKind : std::uint8_t {
  not_read,  ///< geometry of a kind that is not read: curves, points, templates in other files
  crs,       ///< how the CRS or axis order was decided where the file leaves it open
  malformed_xml,
  malformed_json,       ///< a line that is no JSON, or a member that is not what the format wants
  incomplete_building,  ///< cut off by the end of the readable text; left out
  bad_id,               ///< gml:id is no XML name
  duplicate_id,
  missing_id,        ///< Building or BuildingPart without
  unresolved_link,   ///< an xlink into another file, to nothing, or in a circle
  bad_coordinates,   ///< no numbers, wrong count, beyond any CRS; the ring is left out
  open_ring,         ///< last point is not the first; closed in reading
  short_ring,        ///< fewer than three points; left out
  bad_value,         ///< a height, count or year that is none; left out
  unknown_element,   ///< of a foreign namespace within a building; its content is left out
  mixed_crs,         ///< geometry states another CRS than the first one; read as if in the first
  outside_envelope,  ///< polygons with a point outside of the model's envelope
  two_dimensional,   ///< rings without heights; z is 0
  bad_index,         ///< a number that points to no vertex, template, accessor …; what needs it is left out
  bad_hierarchy,     ///< parents that do not exist or stand in a circle; the object counts as if it had none
};
std::string_view name_of(NoteKind kind);
/// Whether the kind speaks against the file (true for all but not_read and crs).
bool is_breach(NoteKind kind);

struct Note {
  NoteKind kind = NoteKind::bad_id;
  std::size_t count = 0;
  std::vector<std::string> examples;  ///< the first ones: "line 12: …"
};

struct ReferenceModel {
  std::string path;
  std::string format;       ///< "CityGML 2.0", "CityJSON 1.1", "CityJSON sequence 2.0", "glTF 2.0", "3D Tiles 1.1"
  std::string version;      ///< of the format: "0.4", "1.0", "2.0"
  std::uint64_t bytes = 0;  ///< on disk, gzipped if so; with all files that belong to it
  ReferenceCrs crs;
  std::vector<Polygon3> polygons;
  std::vector<Building> buildings;                                 ///< in the file's order, a part after its building
  std::vector<std::pair<std::string, std::size_t>> other_objects;  ///< city objects that are no buildings: class, count
  std::vector<Note> notes;                                         ///< sorted by kind

  std::size_t count(NoteKind kind) const;
  std::size_t breaches() const;
};

}  // namespace blockrand::importers::reference
