#include "pipeline/outputs/cityjson/cityjson_writer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/outputs/cityjson/metadata_text.h"
#include "pipeline/outputs/cityjson/object_text.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {
namespace {

constexpr std::size_t kPiece = 1 << 16;  ///< bytes handed to the sink at a time

/// The south-west lower corner of the written footprints and solids, rounded down to metres.
GridOrigin origin_of(const model::Region& region) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double x = kInfinity, y = kInfinity, z = kInfinity;
  for (const model::Building& building : region.buildings) {
    if (!is_written(building)) continue;
    for (const model::BuildingPart& part : building.parts) {
      for (const model::Point2& p : part.plan.outer.points) {
        x = std::min(x, p.x);
        y = std::min(y, p.y);
      }
      if (std::isfinite(part.attributes.ground_height.value)) z = std::min(z, part.attributes.ground_height.value);
    }
  }
  const auto metres = [](double v) { return std::isfinite(v) ? std::floor(v) : 0; };
  return {metres(x), metres(y), metres(z)};
}

/// The room of placed elements, which are turned off the grid: outwards to its next points.
void add_placed(PlacedBoxes& boxes, const model::Detail& detail, const GridOrigin& origin, Extent& extent) {
  for (const model::Placement& p : detail.placements) {
    const auto* corners = boxes.corners(p);
    if (!corners) continue;
    extent.add(origin.steps(p.origin));
    for (const model::Point3& c : *corners) {
      const auto step = [&](double v, double from) { return (v - from) * model::kGridStepsPerMetre; };
      const double steps[] = {step(c.x, origin.x), step(c.y, origin.y), step(c.z, origin.z)};
      const auto whole = [](double v) { return static_cast<std::int64_t>(v); };
      extent.add({whole(std::floor(steps[0])), whole(std::floor(steps[1])), whole(std::floor(steps[2]))});
      extent.add({whole(std::ceil(steps[0])), whole(std::ceil(steps[1])), whole(std::ceil(steps[2]))});
    }
  }
}

/// Every vertex that write_cityjson_sequence is about to write; the first line tells where they lie.
Extent extent_of(const model::Region& region, const CityJsonOptions& options, const GridOrigin& origin) {
  Extent extent;
  PlacedBoxes placed(region);
  const auto add_solid = [&](const model::Solid& solid) {
    for (const std::uint32_t v : solid.indices) extent.add(origin.steps(solid.vertices[v]));
  };
  for (const model::Building& building : region.buildings) {
    if (!is_written(building)) continue;
    for (const model::BuildingPart& part : building.parts) {
      const double ground = part.attributes.ground_height.value;
      const double z = std::isfinite(ground) ? model::snap(ground) : 0;
      if (part.plan.outer.size() >= 3)
        for (const model::Point2& p : part.plan.outer.points) extent.add(origin.steps({p.x, p.y, z}));
      if (options.lod >= 1 && part.lod >= 1) add_solid(part.lod1);
      if (options.lod >= 2 && part.lod >= 2) add_solid(part.lod2);
      if (options.lod < 3 || part.lod < 3 || part.lod3.solid.empty()) continue;
      add_solid(part.lod3.solid);
      for (const model::WallInstallation& body : part.lod3.installations) add_solid(body.solid);
      for (const model::RoofInstallation& body : part.lod3.roof_installations) add_solid(body.solid);
      add_placed(placed, part.lod3, origin, extent);
    }
  }
  return extent;
}

}  // namespace

void write_cityjson_sequence(const model::Region& region, const CityJsonOptions& options, const Sink& sink) {
  const GridOrigin origin = origin_of(region);
  std::string out = "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":";
  append_transform(out, origin);
  append_member(out, "metadata");
  append_metadata(out, options, extent_of(region, options, origin), origin);
  std::vector<std::uint8_t> class_of(region.materials.size());
  std::iota(class_of.begin(), class_of.end(), std::uint8_t{0});
  // Templates stand in the first line for all features, with an appearance of their own.
  MaterialNumbers template_materials;
  TemplateTable template_table(template_materials);
  std::vector<std::uint32_t> templates;
  if (options.lod >= 3) templates = template_table.add(region, class_of);
  if (!template_table.empty()) {
    append_member(out, "geometry-templates");
    template_table.append(out);
    append_member(out, "appearance");
    append_appearance(out, template_materials, region.materials);
  }
  out += ",\"CityObjects\":{},\"vertices\":[]}\n";

  VertexTable vertices;
  MaterialNumbers materials;
  ObjectText text(region, options, origin, vertices, materials, templates);
  for (const model::Building& building : region.buildings) {
    if (!is_written(building)) continue;
    vertices.clear();
    materials.clear();
    out += "{\"type\":\"CityJSONFeature\",\"id\":";
    append_json(out, building.id());
    append_member(out, "CityObjects");
    out += '{';
    text.append(out, building, class_of);
    out += "},\"vertices\":[";
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      if (i) out += ',';
      append_vertex(out, vertices[i]);
    }
    out += ']';
    if (!materials.keys().empty()) {
      append_member(out, "appearance");
      append_appearance(out, materials, region.materials);
    }
    out += "}\n";
    if (out.size() >= kPiece) {
      sink(out);
      out.clear();
    }
  }
  if (!out.empty()) sink(out);
}

std::string write_cityjson_sequence(const model::Region& region, const CityJsonOptions& options) {
  std::string out;
  write_cityjson_sequence(region, options, [&](std::string_view bytes) { out += bytes; });
  return out;
}

struct SingleCityJson::State {
  CityJsonOptions options;
  Sink sink;
  GridOrigin origin;
  bool started = false, empty = true;
  VertexTable vertices;
  Extent extent;  ///< of placed elements; vertices come at the end
  MaterialNumbers materials;
  TemplateTable templates{materials};
  std::vector<model::MaterialClass> classes;  ///< of all regions, in order of first appearance
  std::string out = "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"CityObjects\":{";

  void flush(std::size_t above) {
    if (out.size() <= above) return;
    sink(out);
    out.clear();
  }

  std::vector<std::uint8_t> classes_of(const model::Region& region) {
    std::vector<std::uint8_t> numbers;
    for (const model::MaterialClass& m : region.materials) {
      auto found = std::find_if(classes.begin(), classes.end(), [&](const auto& c) { return c.name == m.name; });
      if (found == classes.end()) found = classes.insert(classes.end(), m);
      numbers.push_back(static_cast<std::uint8_t>(found - classes.begin()));
    }
    assert(classes.size() <= 256);  // one build has one list of classes
    return numbers;
  }
};

SingleCityJson::SingleCityJson(CityJsonOptions options, Sink sink) : state_(std::make_unique<State>()) {
  state_->options = std::move(options);
  state_->sink = std::move(sink);
}

SingleCityJson::~SingleCityJson() = default;

void SingleCityJson::add(const model::Region& region) {
  State& s = *state_;
  if (std::none_of(region.buildings.begin(), region.buildings.end(), is_written)) return;
  if (!s.started) s.origin = origin_of(region);
  s.started = true;
  const std::vector<std::uint8_t> class_of = s.classes_of(region);
  std::vector<std::uint32_t> templates;
  if (s.options.lod >= 3) templates = s.templates.add(region, class_of);
  PlacedBoxes placed(region);
  ObjectText text(region, s.options, s.origin, s.vertices, s.materials, templates);
  for (const model::Building& building : region.buildings) {
    if (!is_written(building)) continue;
    if (!s.empty) s.out += ",\n";
    s.empty = false;
    text.append(s.out, building, class_of);
    for (const model::BuildingPart& part : building.parts)
      if (s.options.lod >= 3 && part.lod >= 3 && !part.lod3.solid.empty())
        add_placed(placed, part.lod3, s.origin, s.extent);
    s.flush(kPiece);
  }
}

void SingleCityJson::finish() {
  State& s = *state_;
  s.out += "},\n\"vertices\":[";
  Extent extent = s.extent;
  for (std::uint32_t i = 0; i < s.vertices.size(); ++i) {
    const GridPoint p = s.vertices[i];
    extent.add(p);
    if (i) s.out += ',';
    append_vertex(s.out, p);
    s.flush(kPiece);
  }
  s.out += ']';
  if (!s.materials.keys().empty()) {
    s.out += ",\n\"appearance\":";
    append_appearance(s.out, s.materials, s.classes);
  }
  if (!s.templates.empty()) {
    s.out += ",\n\"geometry-templates\":";
    s.templates.append(s.out);
  }
  s.out += ",\n\"transform\":";
  append_transform(s.out, s.origin);
  s.out += ",\n\"metadata\":";
  append_metadata(s.out, s.options, extent, s.origin);
  s.out += "}\n";
  s.flush(0);
}

}  // namespace blockrand::outputs
