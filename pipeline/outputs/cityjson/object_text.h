// The text of a building's city objects.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/outputs/cityjson/template_table.h"
#include "pipeline/outputs/cityjson/vertex_table.h"
#include "pipeline/outputs/material_classes.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

/// The corner that vertices are counted from: whole metres, so that it is exact and short in the file.
struct GridOrigin {
  double x = 0, y = 0, z = 0;
  GridPoint steps(const model::Point3& p) const;
};

/// The smallest box around the vertices of a file.
struct Extent {
  bool empty = true;
  GridPoint min, max;
  void add(const GridPoint& p);
};

/// Appends an array of six numbers, metres.
void append_extent(std::string& out, const Extent& extent, const GridOrigin& origin);

/// Appends a material of an appearance.
void append_material(std::string& out, const X3dMaterial& look);

/// Appends the materials of `numbers` as the value of "appearance".
void append_appearance(std::string& out, const MaterialNumbers& numbers,
                       const std::vector<model::MaterialClass>& classes);

/// Whether the model has this building: it is owned by the tile and something of it could be built.
inline bool is_written(const model::Building& building) { return building.owned && !building.parts.empty(); }

/// "WallSurface" and so on.
std::string_view semantic_name(model::SurfaceKind kind);

/// Puts the text of city objects together by hand, as the CityGML writer does. Vertices and materials are numbered in
/// the tables of the caller, who writes them when a feature or the file ends.
class ObjectText {
 public:
  /// \param templates  the number of each element's template, by element; outlives the object
  ObjectText(const model::Region& region, const CityJsonOptions& options, const GridOrigin& origin,
             VertexTable& vertices, MaterialNumbers& materials, const std::vector<std::uint32_t>& templates);

  /// Appends `"w1":{…},"w1.w2":{…}`. Material classes are numbered by `class_of[Face::material]`.
  void append(std::string& out, const model::Building& building, const std::vector<std::uint8_t>& class_of);

 private:
  void object(const model::Building& building, const model::BuildingPart* part, bool whole);
  void attributes(const model::Attributes& a, model::Range tags, const model::BuildingPart* part);
  void imagery(model::OsmId id);  ///< what an aerial image shows of the building
  void standard_attributes(const model::Attributes& a, model::Range tags, const model::BuildingPart* part);
  void address(model::Range tags);
  void geometry(const model::BuildingPart& part);
  bool has_detail(const model::BuildingPart& part) const {
    return options_.lod >= 3 && part.lod >= 3 && !part.lod3.solid.empty();
  }
  void detail_solid(const model::Detail& detail);
  std::vector<std::string> installation_ids(const model::BuildingPart& part, const std::string& id) const;
  void installations(const model::BuildingPart& part, const std::string& id);
  void open_installation(const std::string& id, const std::string& parent, std::string_view kind);
  void instance(const model::Placement& placement);
  void boundaries(const model::Solid& solid);
  void solid_material(const model::Solid& solid);
  void footprint(const model::BuildingPart& part);
  void solid(const model::Solid& solid, int lod, bool materials);
  /// A ring at a height, running as it is told, however the plan's ring runs.
  void ring(const model::Ring& plan, bool counter_clockwise, double z);

  void key(std::string_view name, std::string_view suffix = "");
  void text(std::string_view name, std::string_view value, std::string_view suffix = "");
  void number(std::string_view name, double value);
  void value(const std::string& v) { append_json(*out_, v); }
  void value(double v) { append_number(*out_, v); }
  void value(model::Colour v) { append_json(*out_, model::text(v)); }
  void value(model::RoofShape v) { append_json(*out_, model::name(v)); }
  void value(model::RoofOrientation v) { append_json(*out_, v == model::RoofOrientation::along ? "along" : "across"); }

  const model::Region& region_;
  const CityJsonOptions& options_;
  const GridOrigin& origin_;
  VertexTable& vertices_;
  MaterialNumbers& materials_;
  TagReader tags_;
  const std::vector<std::uint32_t>& templates_;
  std::string* out_ = nullptr;
  const std::vector<std::uint8_t>* class_of_ = nullptr;
  bool first_ = true;                   // no comma before the next member of the open object
  std::vector<std::uint32_t> numbers_;  // in the vertex table, by vertex of the solid at hand
};

}  // namespace blockrand::outputs
