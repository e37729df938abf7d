#include "pipeline/outputs/cityjson/surroundings_cityjson.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "pipeline/outputs/cityjson/metadata_text.h"
#include "pipeline/outputs/cityjson/object_text.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/outputs/surrounding_objects.h"

namespace blockrand::outputs {
namespace {

constexpr std::size_t kPiece = 1 << 16;  ///< bytes handed to the sink at a time
constexpr std::uint32_t kNone = 0xffffffff;

void append_index(std::string& out, std::size_t index) { append_number(out, static_cast<std::int64_t>(index)); }

/// The south-west lower corner of everything, rounded down to metres.
GridOrigin origin_of(const std::vector<SurroundingObject>& objects) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double x = kInfinity, y = kInfinity, z = kInfinity;
  const auto add = [&](const model::Point3& p) {
    x = std::min(x, p.x);
    y = std::min(y, p.y);
    z = std::min(z, p.z);
  };
  for (const SurroundingObject& object : objects) {
    if (object.placed) add(object.placed->place);
    for (const SurroundingPart& part : object.parts)
      for (const model::FlatPolygon* face : part.faces)
        for (const model::Point3& p : face->outer) add(p);
  }
  const auto metres = [](double v) { return std::isfinite(v) ? std::floor(v) : 0; };
  return {metres(x), metres(y), metres(z)};
}

Extent extent_of(const std::vector<SurroundingObject>& objects, const model::SurroundingCatalogue& catalogue,
                 const GridOrigin& origin) {
  Extent extent;
  for (const SurroundingObject& object : objects) {
    for (const SurroundingPart& part : object.parts)
      for (const model::FlatPolygon* face : part.faces)
        for (const auto& ring : rings_on_grid(*face))
          for (const model::Point3& p : ring) extent.add(origin.steps(p));
    if (!object.placed) continue;
    const model::ObjectShape& shape = catalogue.shapes.at(object.placed->shape);
    if (!has_triangles(shape)) continue;
    extent.add(origin.steps(object.placed->place));
    // Placed objects are turned off the grid: outwards to its next points.
    for (const model::Point3& c : box_corners(*object.placed, shape)) {
      const auto step = [](double v, double from, bool down) {
        const double steps = (v - from) * model::kGridStepsPerMetre;
        return static_cast<std::int64_t>(down ? std::floor(steps) : std::ceil(steps));
      };
      for (const bool down : {true, false})
        extent.add({step(c.x, origin.x, down), step(c.y, origin.y, down), step(c.z, origin.z, down)});
    }
  }
  return extent;
}

/// Materials in the order in which they come up.
class Materials {
 public:
  explicit Materials(const model::SurroundingCatalogue& catalogue) : catalogue_(catalogue) {}

  std::size_t number(model::SurroundingMaterial material) {
    const auto found = std::find(rows_.begin(), rows_.end(), material);
    if (found == rows_.end()) return rows_.push_back(material), rows_.size() - 1;
    return static_cast<std::size_t>(found - rows_.begin());
  }
  bool empty() const { return rows_.empty(); }
  void clear() { rows_.clear(); }
  /// The value of "appearance".
  void append(std::string& out) const {
    out += "{\"default-theme-material\":\"";
    out += kVisualTheme;
    out += "\",\"materials\":[";
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (i > 0) out += ',';
      append_material(out, x3d_material(catalogue_.materials.at(rows_[i])));
    }
    out += "]}";
  }

 private:
  const model::SurroundingCatalogue& catalogue_;
  std::vector<model::SurroundingMaterial> rows_;
};

void append_theme(std::string& out) {
  out += ",\"material\":{\"";
  out += kVisualTheme;
  out += "\":{";
}

/// The shapes that are placed, each once.
class Templates {
 public:
  Templates(const std::vector<SurroundingObject>& objects, const model::SurroundingCatalogue& catalogue,
            Materials& materials)
      : materials_(materials) {
    numbers_.assign(catalogue.shapes.size(), kNone);
    for (const SurroundingObject& object : objects) {
      if (!object.placed) continue;
      const model::ObjectShape& shape = catalogue.shapes.at(object.placed->shape);
      std::uint32_t& number = numbers_[object.placed->shape];
      if (number != kNone || !has_triangles(shape)) continue;
      number = count_++;
      add(shape);
    }
  }

  bool empty() const { return count_ == 0; }
  std::uint32_t number(std::size_t shape) const { return numbers_[shape]; }  ///< kNone: it has no face
  /// The value of "geometry-templates".
  void append(std::string& out) const {
    out += "{\"templates\":[" + templates_ + "],\"vertices-templates\":[" + vertices_ + "]}";
  }

 private:
  void add(const model::ObjectShape& shape) {
    std::map<ShapeTriangle::value_type, std::size_t> known;
    const auto vertex = [&](const ShapeTriangle::value_type& p) {
      const auto [place, added] = known.emplace(p, vertex_count_);
      if (!added) return place->second;
      vertices_ += vertex_count_++ == 0 ? "[" : ",[";
      for (const std::int64_t steps : p) {
        append_ten_thousandths_of_a_metre(vertices_, steps);
        vertices_ += ',';
      }
      vertices_.back() = ']';
      return place->second;
    };
    if (!templates_.empty()) templates_ += ',';
    templates_ += "{\"type\":\"MultiSurface\",\"lod\":\"3\",\"boundaries\":[";
    std::string looks;
    for (const model::ObjectShape::Triangles& part : shape.parts)
      for (const ShapeTriangle& t : shape_triangles(part)) {
        templates_ += looks.empty() ? "[[" : ",[[";
        for (std::size_t c = 0; c < t.size(); ++c) {
          if (c > 0) templates_ += ',';
          append_index(templates_, vertex(t[c]));
        }
        templates_ += "]]";
        if (!looks.empty()) looks += ',';
        append_index(looks, materials_.number(part.material));
      }
    templates_ += ']';
    append_theme(templates_);
    templates_ += "\"values\":[" + looks + "]}}}";
  }

  Materials& materials_;
  std::vector<std::uint32_t> numbers_;  ///< by shape
  std::string templates_, vertices_;
  std::uint32_t count_ = 0;
  std::size_t vertex_count_ = 0;
};

std::string_view semantic_type(SurroundingTheme theme, SurroundingRole role) {
  const bool water = theme == SurroundingTheme::water;
  switch (role) {
    case SurroundingRole::area:
      return water ? "WaterSurface" : "TrafficArea";
    case SurroundingRole::marking:
      return "TransportationMarking";
    case SurroundingRole::auxiliary:
      return "AuxiliaryTrafficArea";
    case SurroundingRole::edge:
      break;
  }
  return water ? "WaterGroundSurface" : "AuxiliaryTrafficArea";
}

/// Puts the text of features together.
class FeatureText {
 public:
  FeatureText(const model::SurroundingCatalogue& catalogue, const GridOrigin& origin, const Templates& templates)
      : catalogue_(catalogue), origin_(origin), templates_(templates), materials_(catalogue) {}

  /// Appends a line.
  void append(std::string& out, const SurroundingObject& object) {
    out_ = &out;
    vertices_.clear();
    materials_.clear();
    out += "{\"type\":\"CityJSONFeature\",\"id\":";
    append_json(out, object.id);
    append_member(out, "CityObjects");
    out += '{';
    append_json(out, object.id);
    out += ":{\"type\":\"";
    out += json_type(object.theme);
    out += "\",\"attributes\":{";
    attributes(object);
    out += "},\"geometry\":[";
    if (object.placed)
      instance(*object.placed);
    else
      geometry(object);
    out += "]}},\"vertices\":[";
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
      if (i > 0) out += ',';
      append_vertex(out, vertices_[i]);
    }
    out += ']';
    if (!materials_.empty()) {
      append_member(out, "appearance");
      materials_.append(out);
    }
    out += "}\n";
  }

 private:
  void attributes(const SurroundingObject& object) {
    std::string& out = *out_;
    append_member(out, "class", true);
    append_json(out, object.kind);
    append_member(out, "function");
    append_json(out, object.kind);
    if (const std::string page = osm_page(object.object); !page.empty()) {
      append_member(out, "externalReference");
      append_json(out, page);
    }
    if (object.placed) {
      const model::ObjectShape& shape = catalogue_.shapes.at(object.placed->shape);
      append_member(out, "shape");
      append_json(out, shape.name);
      append_member(out, "height");
      append_number(out, height_of(*object.placed, shape));
      append_member(out, object.theme == SurroundingTheme::plant ? "crownDiameter" : "width");
      append_number(out, width_of(*object.placed, shape));
      return;
    }
    std::vector<std::string_view> names;
    for (const SurroundingPart& part : object.parts) {
      if (part.role == SurroundingRole::marking && !names.empty()) continue;  // paint is no surface
      const std::string& name = catalogue_.materials.at(part.material).name;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    if (is_traffic(object.theme)) {
      append_member(out, "surfaceMaterial");
      for (const std::string_view name : names) {
        out += name == names.front() ? '[' : ',';
        append_json(out, name);
      }
      out += ']';
      return;
    }
    if (names.size() == 1) {
      append_member(out, "material");
      append_json(out, names.front());
    }
    if (!object.parts.front().is_body) {
      append_member(out, "offset");
      append_number(out, to_millimetres(object.parts.front().offset));
    }
  }

  void instance(const model::PlacedObject& p) {
    const std::uint32_t number = templates_.number(p.shape);
    if (number == kNone) return;
    std::string& out = *out_;
    out += "{\"type\":\"GeometryInstance\",\"template\":";
    append_index(out, number);
    out += ",\"boundaries\":[";
    append_index(out, vertices_.number(origin_.steps(p.place)));
    out += "],\"transformationMatrix\":[";
    const std::array<double, 16> matrix = matrix_of(p);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
      if (i > 0) out += ',';
      append_number(out, matrix[i]);
    }
    out += "]}";
  }

  void geometry(const SurroundingObject& object) {
    std::string& out = *out_;
    const SurroundingPart& first = object.parts.front();
    const bool solid = object.parts.size() == 1 && first.is_solid;
    const bool in_list = solid && object.theme == SurroundingTheme::plant_cover;
    out += in_list ? "{\"type\":\"MultiSolid\"" : solid ? "{\"type\":\"Solid\"" : "{\"type\":\"MultiSurface\"";
    append_member(out, "lod");
    // Tracks and markings lie in their roads' surfaces of LoD 2.
    out += first.is_body && !is_traffic(object.theme) ? "\"3\"" : "\"2\"";
    append_member(out, "boundaries");
    out += in_list ? "[[" : solid ? "[" : "";
    out += '[';
    bool begun = false;
    for (const SurroundingPart& part : object.parts)
      for (const model::FlatPolygon* face : part.faces) {
        if (begun) out += ',';
        begun = true;
        polygon(*face);
      }
    out += ']';
    out += in_list ? "]]" : solid ? "]" : "";
    if (is_traffic(object.theme) || object.theme == SurroundingTheme::water) semantics(object);
    append_theme(out);
    const bool one_look = std::all_of(object.parts.begin(), object.parts.end(),
                                      [&](const SurroundingPart& p) { return p.material == first.material; });
    if (one_look) {
      out += "\"value\":";
      append_index(out, materials_.number(first.material));
    } else {
      out += "\"values\":[";
      by_face(object, [&](const SurroundingPart& part) { return materials_.number(part.material); });
      out += ']';
    }
    out += "}}}";
  }

  void polygon(const model::FlatPolygon& face) {
    std::string& out = *out_;
    char before = '[';
    for (const std::vector<model::Point3>& ring : rings_on_grid(face)) {
      out += before;
      before = ',';
      for (std::size_t i = 0; i < ring.size(); ++i) {
        out += i == 0 ? '[' : ',';
        append_index(out, vertices_.number(origin_.steps(ring[i])));
      }
      out += ']';
    }
    out += ']';
  }

  void semantics(const SurroundingObject& object) {
    std::string& out = *out_;
    out += ",\"semantics\":{\"surfaces\":[";
    for (const SurroundingPart& part : object.parts) {
      if (&part != &object.parts.front()) out += ',';
      out += "{\"type\":\"";
      out += semantic_type(object.theme, part.role);
      out += '"';
      if (is_traffic(object.theme)) {
        append_member(out, "function");
        append_json(out, part.function);
        if (!part.usage.empty()) {
          append_member(out, "usage");
          append_json(out, part.usage);
        }
        append_member(out, "surfaceMaterial");
        out += '[';
        append_json(out, catalogue_.materials.at(part.material).name);
        out += ']';
        if (!part.is_body) {
          append_member(out, "offset");
          append_number(out, to_millimetres(part.offset));
        }
      }
      out += '}';
    }
    out += "],\"values\":[";
    by_face(object, [&](const SurroundingPart& part) { return &part - object.parts.data(); });
    out += "]}";
  }

  /// Appends a number for each face.
  template <class Number>
  void by_face(const SurroundingObject& object, const Number& number) {
    bool begun = false;
    for (const SurroundingPart& part : object.parts) {
      const auto n = static_cast<std::size_t>(number(part));
      for (std::size_t f = 0; f < part.faces.size(); ++f) {
        if (begun) *out_ += ',';
        begun = true;
        append_index(*out_, n);
      }
    }
  }

  const model::SurroundingCatalogue& catalogue_;
  const GridOrigin& origin_;
  const Templates& templates_;
  Materials materials_;
  VertexTable vertices_;
  std::string* out_ = nullptr;
};

}  // namespace

void write_surroundings_cityjson(const model::Surroundings& surroundings, const model::SurroundingCatalogue& catalogue,
                                 model::TileId tile, const CityJsonOptions& options, const Sink& sink) {
  const std::vector<SurroundingObject> objects = surrounding_objects(surroundings, catalogue, tile);
  const GridOrigin origin = origin_of(objects);
  std::string out = "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":";
  append_transform(out, origin);
  append_member(out, "metadata");
  append_metadata(out, options, extent_of(objects, catalogue, origin), origin);
  // Templates stand in the first line for all features, with an appearance of their own.
  Materials template_materials(catalogue);
  const Templates templates(objects, catalogue, template_materials);
  if (!templates.empty()) {
    append_member(out, "geometry-templates");
    templates.append(out);
    append_member(out, "appearance");
    template_materials.append(out);
  }
  out += ",\"CityObjects\":{},\"vertices\":[]}\n";
  FeatureText text(catalogue, origin, templates);
  for (const SurroundingObject& object : objects) {
    text.append(out, object);
    if (out.size() < kPiece) continue;
    sink(out);
    out.clear();
  }
  if (!out.empty()) sink(out);
}

std::string write_surroundings_cityjson(const model::Surroundings& surroundings,
                                        const model::SurroundingCatalogue& catalogue, model::TileId tile,
                                        const CityJsonOptions& options) {
  std::string out;
  write_surroundings_cityjson(surroundings, catalogue, tile, options, [&](std::string_view bytes) { out += bytes; });
  return out;
}

}  // namespace blockrand::outputs
