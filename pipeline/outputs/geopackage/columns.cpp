#include "pipeline/outputs/geopackage/columns.h"

#include <array>
#include <string_view>
#include <utility>

#include "pipeline/model/building.h"

namespace blockrand::outputs {
namespace {

/// What an attribute means, for people who open the table without our documentation.
std::string_view meaning(std::string_view attribute) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 25> kMeanings{{
      {"use", "What the building is used for: the value of building=*, refined where it said only yes"},
      {"storeys", "Full storeys above ground, ground floor included, roof storeys not"},
      {"storey_height", "Height of a storey"},
      {"height", "From the lowest ground to the top of the roof"},
      {"min_height", "From the ground to the underside; 0 where the building stands on the ground"},
      {"roof_storeys", "Storeys inside the roof"},
      {"roof_height", "From the eaves to the top of the roof"},
      {"roof_shape", "Roof that was asked for; built_roof says what stands"},
      {"roof_orientation", "Whether the ridge runs along or across the longer side"},
      {"roof_direction", "Where the roof slopes down to, clockwise from north"},
      {"ground_height", "Lowest ground under the building, above the height reference of the build"},
      {"plinth_height", "From the lowest ground up to the level of the ground floor"},
      {"wall_colour", "Colour of the walls in sRGB"},
      {"roof_colour", "Colour of the roof in sRGB"},
      {"wall_material", "Material class of the walls"},
      {"roof_material", "Material class of the roof"},
      {"eaves_height", "From the lowest ground to the eaves"},
      {"roof_pitch", "Of the main slope; 0 for flat roofs"},
      {"ridge_direction", "Where the ridge runs, clockwise from north, from 0 to 180"},
      {"ground_floor_use", "What the ground floor is used for"},
      {"construction_date", "Year of construction, or from..to"},
      {"era", "When it was built: pre1840, 1840_1918, 1919_1945, post1945"},
      {"style", "Class of appearance: gruenderzeit, tenement, modern, other"},
      {"substyle", "Id of its style in configs/styles/catalogue.toml"},
      {"preset", "Preset of the grammar that the district's rules chose"},
  }};
  for (const auto& [name, text] : kMeanings)
    if (name == attribute) return text;
  return "";
}

constexpr ColumnKind kind_of(double) { return ColumnKind::real; }
template <class T>
constexpr ColumnKind kind_of(const T&) {
  return ColumnKind::text;
}

void add_attributes(std::vector<Column>& columns) {
  // The visitor needs a value of every type, absent ones included.
  model::Attributes all;
  all.roof_direction.emplace();
  all.ridge_direction.emplace();
  model::for_each_attribute(
      all,
      [&](std::string_view attribute, std::string_view unit, const auto& sourced) {
        const std::string name(attribute);
        columns.push_back({name, kind_of(sourced.value), std::string(unit), std::string(meaning(attribute))});
        columns.push_back({name + "_source", ColumnKind::text, "",
                           "Where " + name + " comes from: tag is mapped, default is a guess"});
        columns.push_back({name + "_confidence", ColumnKind::real, "", "How sure " + name + " is, from 0 to 1"});
      },
      [](std::string_view, std::string_view) {});
  for (const char* of : {"wall", "roof"})
    columns.push_back({std::string("shown_") + of + "_colour", ColumnKind::text, "",
                       "What the model shows: a colour's word as paint or clay of that name, drawn roofs weathered"});
}

void add_address(std::vector<Column>& columns) {
  columns.push_back({"name", ColumnKind::text, "", "Name as mapped"});
  columns.push_back({"address", ColumnKind::text, "", "Address in one line"});
}

}  // namespace

std::vector<Column> building_columns() {
  std::vector<Column> c{
      {"id", ColumnKind::text, "", "Id in all outputs: n, w or r and the OpenStreetMap number"},
      {"osm_type", ColumnKind::text, "", "OpenStreetMap object: node, way or relation"},
      {"osm_number", ColumnKind::integer, "", "Number of the OpenStreetMap object"},
      {"tile", ColumnKind::text, "", "Tile that the building belongs to: level, x, y"},
      {"state", ColumnKind::text, "",
       "modelled: has a solid of its own; represented: its parts stand for it; reported: nothing could be built"},
      {"lod", ColumnKind::integer, "", "Lowest level of detail among its bodies"},
      {"parts", ColumnKind::integer, "", "Number of its bodies, rows of the layer parts"},
      {"built_roof", ColumnKind::text, "", "Roof that stands on the largest of its bodies"},
      {"footprint_area", ColumnKind::real, "m²", "Area of the footprint on the map"},
      {"volume", ColumnKind::real, "m³", "Volume of the best solids of its bodies"},
      {"fallbacks", ColumnKind::text, "", "Codes of what was built otherwise than asked, separated by blanks"},
      {"origin", ColumnKind::text, "", "mapped; replaced: a model that the overrides name stands for it"},
      {"replaced_by", ColumnKind::text, "", "That model: file, author, licence, source"},
  };
  add_address(c);
  for (const char* name : {"country", "city", "suburb", "postcode", "street", "house_number"})
    c.push_back({name, ColumnKind::text, "", "Address as mapped: " + std::string(name)});
  add_attributes(c);
  for (const auto& more : {style_columns(), situation_columns(), repair_columns()})
    c.insert(c.end(), more.begin(), more.end());
  c.push_back({"tags", ColumnKind::text, "", "All OpenStreetMap tags as a JSON object"});
  return c;
}

std::vector<Column> part_columns() {
  std::vector<Column> c{
      {"id", ColumnKind::text, "", "Id of the body in all outputs"},
      {"building", ColumnKind::text, "", "Id of the building it belongs to"},
      {"osm_type", ColumnKind::text, "", "Object whose tags it carries: node, way or relation"},
      {"osm_number", ColumnKind::integer, "", "Number of the object whose tags it carries"},
      {"tile", ColumnKind::text, "", "Tile that its building belongs to: level, x, y"},
      {"lod", ColumnKind::integer, "", "Highest level of detail built; -1: none"},
      {"built_roof", ColumnKind::text, "", "Roof that stands"},
      {"footprint_area", ColumnKind::real, "m²", "Area of the plan on the map"},
      {"volume", ColumnKind::real, "m³", "Volume of the best solid"},
      {"fallbacks", ColumnKind::text, "", "Codes of what was built otherwise than asked, separated by blanks"},
  };
  add_address(c);
  add_attributes(c);
  c.push_back({"tags", ColumnKind::text, "",
               "OpenStreetMap tags as a JSON object, where the body is an object of its own beside its building"});
  return c;
}

std::vector<Column> surface_columns() {
  return {
      {"id", ColumnKind::text, "", "Id of the body and a number"},
      {"body", ColumnKind::text, "", "Id of the body in all outputs, and in the layer parts"},
      {"building", ColumnKind::text, "", "Id of the building it belongs to"},
      {"tile", ColumnKind::text, "", "Tile that its building belongs to: level, x, y"},
      {"lod", ColumnKind::integer, "", "Level of detail of the faces: 2, or 1 where there is no more"},
      {"class", ColumnKind::text, "", "What the faces are: ground, wall, roof, outer_ceiling, outer_floor, closure"},
      {"colour", ColumnKind::text, "", "Their colour, #rrggbb in sRGB"},
      {"faces", ColumnKind::integer, "", "How many they are"},
  };
}

std::vector<Column> reported_columns() {
  return {
      {"id", ColumnKind::text, "", "OpenStreetMap object: n, w or r and its number"},
      {"osm_type", ColumnKind::text, "", "OpenStreetMap object: node, way or relation"},
      {"osm_number", ColumnKind::integer, "", "Number of the OpenStreetMap object"},
      {"kind", ColumnKind::text, "", "building or building_part"},
      {"state", ColumnKind::text, "",
       "reported: not built; duplicate of another object; represented by another object"},
      {"code", ColumnKind::text, "", "Why it was not built"},
      {"meaning", ColumnKind::text, "", "What the code means"},
      {"detail", ColumnKind::text, "", "Tag, value, member or measure concerned"},
      {"related", ColumnKind::text, "", "Id of the object that stands for it"},
  };
}

std::vector<Column> tile_columns() {
  return {
      {"id", ColumnKind::text, "", "Level, x and y of the tile"},
      {"level", ColumnKind::integer, "", "Level of the quadtree"},
      {"x", ColumnKind::integer, "", "Column of the tile, from 180 degrees west"},
      {"y", ColumnKind::integer, "", "Row of the tile, from the south pole"},
      {"uri", ColumnKind::text, "", "GLB file of the tile, relative to the build; empty where there is none"},
      {"buildings", ColumnKind::integer, "", "Number of buildings"},
      {"parts", ColumnKind::integer, "", "Number of bodies"},
      {"bytes", ColumnKind::integer, "byte", "Size of the GLB file"},
  };
}

}  // namespace blockrand::outputs
