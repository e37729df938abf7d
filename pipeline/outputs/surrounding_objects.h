// The surroundings of a tile as city objects: what CityGML and CityJSON write alike.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/model/surroundings.h"
#include "pipeline/outputs/material_classes.h"

namespace blockrand::outputs {

/// What stands behind a tile's name in files of its surroundings.
inline constexpr std::string_view kSurroundingsEnding = "_surroundings";

/// X(constant, element of CityGML, type of CityJSON). CityJSON has no generic objects; CityGML has no type of its own for
/// runways, platforms and car parks, but their traffic areas.
// clang-format off
#define BLOCKRAND_SURROUNDING_THEMES(X)                                             \
  X(road, "tran:Road", "Road")                                                      \
  X(square, "tran:Square", "TransportSquare")                                       \
  X(railway, "tran:Railway", "Railway")                                             \
  X(traffic, "tran:TransportationComplex", "TransportSquare")                       \
  X(water, "wtr:WaterBody", "WaterBody")                                            \
  X(land_use, "luse:LandUse", "LandUse")                                            \
  X(plant_cover, "veg:PlantCover", "PlantCover")                                    \
  X(plant, "veg:SolitaryVegetationObject", "SolitaryVegetationObject")              \
  X(furniture, "frn:CityFurniture", "CityFurniture")                                \
  X(placed_thing, "gen:GenericCityObject", "CityFurniture")                         \
  X(bridge, "brid:Bridge", "Bridge")                                                \
  X(construction, "gen:GenericCityObject", "OtherConstruction")
// clang-format on

enum class SurroundingTheme : std::uint8_t {
#define X(constant, gml, json) constant,
  BLOCKRAND_SURROUNDING_THEMES(X)
#undef X
};
inline constexpr std::string_view kSurroundingElements[] = {
#define X(constant, gml, json) gml,
    BLOCKRAND_SURROUNDING_THEMES(X)
#undef X
};
inline constexpr std::string_view kSurroundingTypes[] = {
#define X(constant, gml, json) json,
    BLOCKRAND_SURROUNDING_THEMES(X)
#undef X
};
constexpr std::string_view gml_element(SurroundingTheme t) { return kSurroundingElements[static_cast<std::size_t>(t)]; }
constexpr std::string_view json_type(SurroundingTheme t) { return kSurroundingTypes[static_cast<std::size_t>(t)]; }
/// Whether the object is made of traffic areas.
constexpr bool is_traffic(SurroundingTheme t) { return t <= SurroundingTheme::traffic; }

/// What a part is of its object. Objects without traffic areas and water have areas alone.
enum class SurroundingRole : std::uint8_t { area, auxiliary, marking, edge };

/// Faces of one kind, material and height within a city object.
struct SurroundingPart {
  SurroundingRole role = SurroundingRole::area;
  std::string_view function{};  ///< name of the ground or body; "kerb" of upright edges of traffic areas
  std::string_view usage{};     ///< who goes there; empty where that is not told
  model::SurroundingMaterial material = 0;
  float offset = 0;       ///< m above the terrain, of ground
  bool is_body = false;   ///< of a body, not of the ground
  bool is_solid = false;  ///< the faces bound a solid
  std::vector<const model::FlatPolygon*> faces{};
};

struct SurroundingObject {
  SurroundingTheme theme = SurroundingTheme::land_use;
  std::string id{};  ///< "w123_1abc_2": object, tile, number among those of the object; differs from all of the build
  model::OsmId object{};
  std::string_view kind{};               ///< its main ground or body, or the kind of the shape
  std::vector<SurroundingPart> parts{};  ///< in the order of their roles; empty where it is placed
  const model::PlacedObject* placed = nullptr;
};

/// The city objects of a tile, in the order in which the first piece of each is given. What one mapped object has of one theme
/// is one of them, whatever squares it lies in; other themes and bodies without traffic are several. Parts without a face and
/// objects without a part are left out. Refers to `surroundings` and `catalogue`.
std::vector<SurroundingObject> surrounding_objects(const model::Surroundings& surroundings,
                                                   const model::SurroundingCatalogue& catalogue, model::TileId tile);

/// The rings of a face on the grid, the outer one first; without points that fall together, and without rings that are none.
/// Empty where the outer one is none.
std::vector<std::vector<model::Point3>> rings_on_grid(const model::FlatPolygon& face);

/// Corners in tenths of a millimetre.
using ShapeTriangle = std::array<std::array<std::int64_t, 3>, 3>;
/// The triangles of a part of a shape that have an area once they are rounded.
std::vector<ShapeTriangle> shape_triangles(const model::ObjectShape::Triangles& part);
/// Whether anything of it can be shown.
bool has_triangles(const model::ObjectShape& shape);

/// Shape to place, row by row: turned about the vertical and stretched; the place itself is its reference point.
std::array<double, 16> matrix_of(const model::PlacedObject& placed);
/// Corners of the shape's box where it stands, m, build CRS.
std::array<model::Point3, 8> box_corners(const model::PlacedObject& placed, const model::ObjectShape& shape);
/// m: how high the placed object is, and how wide at its widest.
double height_of(const model::PlacedObject& placed, const model::ObjectShape& shape);
double width_of(const model::PlacedObject& placed, const model::ObjectShape& shape);
/// The nearest multiple of 1 mm.
double to_millimetres(double metres);

/// How a material looks.
X3dMaterial x3d_material(const model::SurroundingMaterialClass& material);

}  // namespace blockrand::outputs
