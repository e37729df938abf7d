// What stands and lies around the buildings of a tile: the ground cut into surfaces, bodies on it, objects placed on it.
//
// Surfaces of one level fit each other point for point. The ground is worked out in squares of a fixed grid in the build CRS,
// each from the objects that come there and from nothing else (ARCHITECTURE.md, law 4), and a square belongs to the tile
// that its middle lies in.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/osm_id.h"
#include "pipeline/model/point.h"

namespace blockrand::model {

/// X(constant, name in outputs, what it is). The stronger stands first: where two are mapped in one place, the ground is
/// that of the first. Buildings come before all of them.
// clang-format off
#define BLOCKRAND_GROUND_CLASSES(X)                                                             \
  X(passage, "passage", "way through or under a building")                                      \
  X(water, "water", "rivers, lakes, canals, basins")                                            \
  X(swimming_pool, "swimming_pool", "leisure=swimming_pool")                                    \
  X(runway, "runway", "runways, taxiways, aprons, helipads")                                    \
  X(carriageway, "carriageway", "streets for vehicles with their junctions")                    \
  X(parking_lane, "parking_lane", "parking beside the lanes of a street")                       \
  X(steps, "steps", "highway=steps")                                                            \
  X(cycle_way, "cycle_way", "tracks and lanes for bicycles beside or apart from carriageways")  \
  X(rail_bed, "rail_bed", "beds of tracks that no street shares")                               \
  X(platform, "platform", "platforms of railways and buses")                                    \
  X(footway, "footway", "footways and paths apart from carriageways")                           \
  X(pavement, "pavement", "pavements along carriageways")                                       \
  X(square, "square", "squares and pedestrian areas")                                           \
  X(parking, "parking", "car parks and bicycle parking")                                        \
  X(pitch, "pitch", "sports pitches and tracks")                                                \
  X(playground, "playground", "playgrounds")                                                    \
  X(golf, "golf", "greens, tees, bunkers and fairways")                                         \
  X(flower_bed, "flower_bed", "flower beds, shrubberies")                                       \
  X(wood, "wood", "woods and forests")                                                          \
  X(scrub, "scrub", "scrub and heath")                                                          \
  X(grass, "grass", "grass, parks, meadows")                                                    \
  X(garden, "garden", "gardens and allotments")                                                 \
  X(cemetery, "cemetery", "cemeteries")                                                         \
  X(field, "field", "farmland, orchards, vineyards")                                            \
  X(sand, "sand", "beaches, sand")                                                              \
  X(rock, "rock", "bare rock, scree")                                                           \
  X(construction, "construction", "building sites, brownfields, quarries")                      \
  X(yard, "yard", "paved land of blocks: courtyards, works, schools")                           \
  X(land, "land", "what nothing is mapped for")
// clang-format on

enum class GroundClass : std::uint8_t {
#define X(constant, text, about) constant,
  BLOCKRAND_GROUND_CLASSES(X)
#undef X
};
inline constexpr std::string_view kGroundClassNames[] = {
#define X(constant, text, about) text,
    BLOCKRAND_GROUND_CLASSES(X)
#undef X
};
inline constexpr std::string_view kGroundClassAbout[] = {
#define X(constant, text, about) about,
    BLOCKRAND_GROUND_CLASSES(X)
#undef X
};
inline constexpr std::size_t kGroundClassCount = std::size(kGroundClassNames);
constexpr std::string_view name(GroundClass c) { return kGroundClassNames[static_cast<std::size_t>(c)]; }

/// A plane face: x east, y north, z up; m in the build CRS and above the build's height reference. Counter-clockwise seen
/// from where it is seen, the first point not repeated.
struct FlatPolygon {
  std::vector<Point3> outer;
  std::vector<std::vector<Point3>> holes;
};

/// What a face is made of: a row of SurroundingCatalogue::materials.
using SurroundingMaterial = std::uint16_t;

/// Ground of one object, or of the land between the mapped ones, in one square of the grid.
struct GroundSurface {
  GroundClass ground = GroundClass::land;
  OsmId object;  ///< number 0: not mapped, told by what stands around
  SurroundingMaterial material = 0;
  float offset = 0;                ///< m above the terrain
  std::vector<FlatPolygon> faces;  ///< seen from above; over terrain each lies in one of its triangles
  std::vector<FlatPolygon> edges;  ///< upright, down to lower neighbours: kerbs, banks
};

/// What has a shape of its own along a line or over an area.
enum class BodyClass : std::uint8_t {
  wall,
  retaining_wall,
  city_wall,
  fence,
  hedge,
  guard_rail,
  kerb,
  rail,
  bridge,
  pier,
  marking,
  stairs,
  cliff,
  power_line,
  other
};
inline constexpr std::string_view kBodyClassNames[] = {
    "wall",   "retaining_wall", "city_wall", "fence",  "hedge", "guard_rail", "kerb", "rail",
    "bridge", "pier",           "marking",   "stairs", "cliff", "power_line", "other"};
inline constexpr std::size_t kBodyClassCount = std::size(kBodyClassNames);
constexpr std::string_view name(BodyClass c) { return kBodyClassNames[static_cast<std::size_t>(c)]; }

struct SurroundingBody {
  BodyClass body = BodyClass::other;
  OsmId object;
  SurroundingMaterial material = 0;
  bool closed = false;  ///< the faces bound a solid
  std::vector<FlatPolygon> faces;
};

/// A thing that is modelled once and placed.
struct PlacedObject {
  std::uint16_t shape = 0;      ///< row of SurroundingCatalogue::shapes
  OsmId object;                 ///< of tree rows and woods: that of the row or wood
  Point3 place;                 ///< m, its foot
  float turn = 0;               ///< rad, counter-clockwise from east
  float width = 1, height = 1;  ///< factors of the shape's own measures, across and upwards
};

struct SurroundingMaterialClass {
  std::string name;  ///< "asphalt"
  Colour colour;     ///< sRGB
  float roughness = 0.9f, metallic = 0;
};

/// What CityGML has for an object.
enum class ObjectTheme : std::uint8_t { vegetation, furniture, transportation, other };

/// The shape of a thing, in its own frame: its foot at the origin, its front to +x, z up; m.
struct ObjectShape {
  std::string name;  ///< "tree_broadleaved_medium"
  std::string kind;  ///< "tree", "street_lamp", "bench"
  ObjectTheme theme = ObjectTheme::furniture;
  struct Triangles {
    SurroundingMaterial material = 0;
    std::vector<Point3> corners;  ///< three a triangle, counter-clockwise seen from outside
    bool round = false;           ///< shaded as if it had no edges: crowns, hedges
  };
  std::vector<Triangles> parts;
  Point3 min, max;
};

/// Materials and shapes of the surroundings of a build: configs/surroundings.toml as it was read.
struct SurroundingCatalogue {
  std::vector<SurroundingMaterialClass> materials;
  std::vector<ObjectShape> shapes;
};

/// What became of a mapped object that this stage is asked for.
enum class SurroundingState : std::uint8_t {
  modelled,
  covered,       ///< stronger objects, or buildings, have all of its ground
  below_ground,  ///< tunnels, culverts, what lies below
  indoors,
  not_modelled,  ///< of a kind that has no shape here
};
inline constexpr std::string_view kSurroundingStateNames[] = {"modelled", "covered", "below_ground", "indoors",
                                                              "not_modelled"};
inline constexpr std::size_t kSurroundingStateCount = std::size(kSurroundingStateNames);

struct SurroundingOutcome {
  OsmId object;
  SurroundingState state = SurroundingState::modelled;
  std::uint8_t kind = 0;  ///< row of the kinds that are counted (pipeline/surroundings/kinds.h)
};

/// Everything around the buildings of a tile, in the order of its squares and in each of classes and ids.
struct Surroundings {
  std::vector<GroundSurface> surfaces;
  std::vector<SurroundingBody> bodies;
  std::vector<PlacedObject> objects;
  std::vector<SurroundingOutcome> outcomes;  ///< ascending by object: of each that comes into a square of the tile
  bool empty() const { return surfaces.empty() && bodies.empty() && objects.empty(); }
};

}  // namespace blockrand::model
