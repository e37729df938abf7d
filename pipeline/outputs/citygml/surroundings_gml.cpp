#include "pipeline/outputs/citygml/surroundings_gml.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/outputs/citygml/appearance_text.h"
#include "pipeline/outputs/citygml/geometry_text.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/outputs/surrounding_objects.h"
#include "pipeline/outputs/tile_digits.h"

namespace blockrand::outputs {
namespace {

constexpr std::size_t kPiece = 1 << 16;  ///< bytes handed to the sink at a time

constexpr std::string_view kHead =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<core:CityModel xmlns:core=\"http://www.opengis.net/citygml/2.0\""
    " xmlns:app=\"http://www.opengis.net/citygml/appearance/2.0\""
    " xmlns:brid=\"http://www.opengis.net/citygml/bridge/2.0\""
    " xmlns:frn=\"http://www.opengis.net/citygml/cityfurniture/2.0\""
    " xmlns:gen=\"http://www.opengis.net/citygml/generics/2.0\""
    " xmlns:luse=\"http://www.opengis.net/citygml/landuse/2.0\""
    " xmlns:tran=\"http://www.opengis.net/citygml/transportation/2.0\""
    " xmlns:veg=\"http://www.opengis.net/citygml/vegetation/2.0\""
    " xmlns:wtr=\"http://www.opengis.net/citygml/waterbody/2.0\""
    " xmlns:gml=\"http://www.opengis.net/gml\""
    " xmlns:xlink=\"http://www.w3.org/1999/xlink\""
    " xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\""
    " xsi:schemaLocation=\"";
constexpr std::string_view kModules[][2] = {
    {"appearance", "appearance"}, {"bridge", "bridge"},      {"cityfurniture", "cityFurniture"},
    {"generics", "generics"},     {"landuse", "landUse"},    {"transportation", "transportation"},
    {"vegetation", "vegetation"}, {"waterbody", "waterBody"}};

struct Box {
  bool empty = true;
  model::Point3 min, max;
  void add(const model::Point3& p) {
    if (empty) min = max = p;
    empty = false;
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
};

/// The next point of the grid, outwards: placed objects are turned off it.
model::Point3 on_grid(const model::Point3& p, bool down) {
  const auto step = [&](double v) {
    const double steps = v * model::kGridStepsPerMetre;
    return (down ? std::floor(steps) : std::ceil(steps)) / model::kGridStepsPerMetre;
  };
  return {step(p.x), step(p.y), step(p.z)};
}

Box box_of(const std::vector<SurroundingObject>& objects, const model::SurroundingCatalogue& catalogue) {
  Box box;
  for (const SurroundingObject& object : objects) {
    for (const SurroundingPart& part : object.parts)
      for (const model::FlatPolygon* face : part.faces)
        for (const auto& ring : rings_on_grid(*face))
          for (const model::Point3& p : ring) box.add(p);
    if (!object.placed) continue;
    const model::ObjectShape& shape = catalogue.shapes.at(object.placed->shape);
    if (!has_triangles(shape)) continue;
    box.add(model::snap(object.placed->place));
    for (const model::Point3& c : box_corners(*object.placed, shape))
      box.add(on_grid(c, true)), box.add(on_grid(c, false));
  }
  return box;
}

/// Numbers of faces that hang together by their edges, in the order of their first ones.
std::vector<std::vector<std::size_t>> connected(const std::vector<const model::FlatPolygon*>& faces) {
  std::vector<std::size_t> group(faces.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto first_of = [&](std::size_t f) {
    while (group[f] != f) f = group[f] = group[group[f]];
    return f;
  };
  std::map<std::pair<model::Point3, model::Point3>, std::size_t> seen;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (const auto& ring : rings_on_grid(*faces[f]))
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto [a, b] = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
        const auto [place, added] = seen.try_emplace({a, b}, f);
        if (added) continue;
        const std::size_t one = first_of(place->second), other = first_of(f);
        group[std::max(one, other)] = std::min(one, other);
      }
  std::vector<std::vector<std::size_t>> out;
  std::map<std::size_t, std::size_t> at;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [place, added] = at.try_emplace(first_of(f), out.size());
    if (added) out.emplace_back();
    out[place->second].push_back(f);
  }
  return out;
}

/// Writes the text of one city object after the other.
class ObjectsText {
 public:
  ObjectsText(const model::SurroundingCatalogue& catalogue, model::TileId tile) : catalogue_(catalogue), shapes_("s") {
    append_base36(shapes_, number_of(tile));
    shapes_ += '_';
    shape_written_.assign(catalogue.shapes.size(), false);
    targets_.resize(catalogue.materials.size());
  }

  void append(std::string& out, const SurroundingObject& object) {
    out_ = &out;
    id_ = &object.id;
    areas_ = surfaces_ = 0;
    const std::string_view element = gml_element(object.theme);
    module_ = element.substr(0, element.find(':') + 1);
    out += "<core:cityObjectMember><";
    out += element;
    out += " gml:id=\"";
    out += object.id;
    out += "\">\n";
    reference(object.object);
    if (is_traffic(object.theme))
      traffic(object);
    else if (object.placed)
      placed(object);
    else if (object.theme == SurroundingTheme::water)
      water(object);
    else
      surfaces(object);
    out += "</";
    out += element;
    out += "></core:cityObjectMember>\n";
  }

  /// The appearance of all that was appended.
  void append_appearance(std::string& out) const {
    if (looks_.empty()) return;
    out += "<app:appearanceMember><app:Appearance><app:theme>";
    out += kVisualTheme;
    out += "</app:theme>\n";
    for (const model::SurroundingMaterial material : looks_) {
      open_material(out, x3d_material(catalogue_.materials[material]));
      out += targets_[material];
      out += kMaterialEnd;
    }
    out += "</app:Appearance></app:appearanceMember>\n";
  }

 private:
  void reference(model::OsmId object) {
    const std::string page = osm_page(object);
    if (page.empty()) return;
    *out_ +=
        "<core:externalReference><core:informationSystem>https://www.openstreetmap.org</core:informationSystem>"
        "<core:externalObject><core:uri>" +
        page + "</core:uri></core:externalObject></core:externalReference>\n";
  }

  void generic_text(std::string_view name, std::string_view text) {
    *out_ += "<gen:stringAttribute name=\"";
    append_xml(*out_, name);
    *out_ += "\"><gen:value>";
    append_xml(*out_, text);
    *out_ += "</gen:value></gen:stringAttribute>\n";
  }
  void generic_number(std::string_view name, double value) {
    *out_ += "<gen:doubleAttribute name=\"";
    append_xml(*out_, name);
    *out_ += "\"><gen:value>";
    append_number(*out_, value);
    *out_ += "</gen:value></gen:doubleAttribute>\n";
  }
  void offset(const SurroundingPart& part) {
    if (!part.is_body) generic_number("offset", to_millimetres(part.offset));
  }

  void open(std::string_view name) { tag("<", name); }
  void close(std::string_view name) { tag("</", name); }
  void tag(std::string_view begin, std::string_view name) {
    *out_ += begin;
    *out_ += module_;
    *out_ += name;
    *out_ += '>';
  }
  void element(std::string_view name, std::string_view text, std::string_view attributes = {}) {
    if (text.empty()) return;
    *out_ += '<';
    *out_ += module_;
    *out_ += name;
    *out_ += attributes;
    *out_ += '>';
    append_xml(*out_, text);
    close(name);
    *out_ += '\n';
  }
  const std::string& material_name(const SurroundingPart& part) { return catalogue_.materials.at(part.material).name; }

  void traffic(const SurroundingObject& object) {
    element("class", object.kind);
    // Parts stand in the order of their roles, and so do the elements of the schema.
    for (const SurroundingPart& part : object.parts) {
      const bool main = part.role == SurroundingRole::area || part.role == SurroundingRole::marking;
      if (main) area(part, "trafficArea", "TrafficArea");
    }
    for (const SurroundingPart& part : object.parts) {
      const bool beside = part.role == SurroundingRole::auxiliary || part.role == SurroundingRole::edge;
      if (beside) area(part, "auxiliaryTrafficArea", "AuxiliaryTrafficArea");
    }
  }

  void area(const SurroundingPart& part, std::string_view property, std::string_view name) {
    open(property);
    open_with_id(name, "_a", ++areas_);
    offset(part);
    element("function", part.function);
    element("usage", part.usage);
    element("surfaceMaterial", material_name(part));
    open("lod2MultiSurface");
    multi_surface(part);
    close("lod2MultiSurface");
    close(name);
    close(property);
    *out_ += '\n';
  }

  /// Polygons stand in the water itself, and its surfaces refer to them: GDAL follows no references.
  void water(const SurroundingObject& object) {
    const SurroundingPart& first = object.parts.front();
    generic_text("material", material_name(first));
    offset(first);
    element("class", object.kind);
    open("lod1MultiSurface");
    open_surface("MultiSurface", first.material);
    std::size_t polygon = 0;
    for (const SurroundingPart& part : object.parts) polygons(part.faces, &polygon);
    *out_ += "</MultiSurface>";
    close("lod1MultiSurface");
    *out_ += '\n';
    std::size_t before = 0;  // polygons of other parts
    for (const SurroundingPart& part : object.parts) {
      const std::string_view name = part.role == SurroundingRole::edge ? "WaterGroundSurface" : "WaterSurface";
      for (const std::vector<std::size_t>& faces : connected(part.faces)) {
        open("boundedBy");
        open_with_id(name, "_a", ++areas_);
        open("lod2Surface");
        *out_ += "<CompositeSurface>";
        for (const std::size_t face : faces) {
          *out_ += "<surfaceMember xlink:href=\"#";
          append_polygon_id(*out_, *id_, before + face + 1);
          *out_ += "\"/>\n";
        }
        *out_ += "</CompositeSurface>";
        close("lod2Surface");
        close(name);
        close("boundedBy");
        *out_ += '\n';
      }
      before += part.faces.size();
    }
  }

  /// Land, plants, furniture, bridges: one geometry of all parts.
  void surfaces(const SurroundingObject& object) {
    const SurroundingPart& first = object.parts.front();
    const bool several =
        std::any_of(object.parts.begin(), object.parts.end(),
                    [&](const SurroundingPart& p) { return p.is_solid || p.material != first.material; }) &&
        object.parts.size() > 1;
    if (!several) generic_text("material", material_name(first));
    offset(first);
    element("class", object.kind);
    element("function", object.kind);
    const bool any_geometry =
        object.theme == SurroundingTheme::furniture || object.theme == SurroundingTheme::construction;
    const bool solid = first.is_solid && !several;
    const bool in_list = solid && object.theme == SurroundingTheme::plant_cover;
    std::string property = first.is_body ? "lod3" : "lod2";
    property += any_geometry ? "Geometry" : in_list ? "MultiSolid" : solid ? "Solid" : "MultiSurface";
    open(property);
    if (in_list) *out_ += "<MultiSolid><solidMember>";
    if (solid) {
      *out_ += "<Solid><exterior>";
      composite_surface(first.faces, first.material);
      *out_ += "</exterior></Solid>";
    } else if (several) {
      *out_ += "<MultiSurface>";
      for (const SurroundingPart& part : object.parts) {
        *out_ += "<surfaceMember>";
        composite_surface(part.faces, part.material);
        *out_ += "</surfaceMember>\n";
      }
      *out_ += "</MultiSurface>";
    } else {
      open_surface("MultiSurface", first.material);
      for (const SurroundingPart& part : object.parts) polygons(part.faces);
      *out_ += "</MultiSurface>";
    }
    if (in_list) *out_ += "</solidMember></MultiSolid>";
    close(property);
    *out_ += '\n';
  }

  void placed(const SurroundingObject& object) {
    const model::PlacedObject& p = *object.placed;
    const model::ObjectShape& shape = catalogue_.shapes.at(p.shape);
    generic_text("shape", shape.name);
    const bool plant = object.theme == SurroundingTheme::plant;
    if (!plant) {
      generic_number("height", height_of(p, shape));
      generic_number("width", width_of(p, shape));
    }
    element("class", object.kind);
    element("function", object.kind);
    if (plant) {
      const auto length = [&](std::string_view name, double metres) {
        std::string text;
        append_number(text, metres);
        element(name, text, " uom=\"m\"");
      };
      length("height", height_of(p, shape));
      length("crownDiameter", width_of(p, shape));
    }
    if (has_triangles(shape)) implicit(p);
  }

  void implicit(const model::PlacedObject& p) {
    open("lod3ImplicitRepresentation");
    *out_ += "<core:ImplicitGeometry><core:transformationMatrix>";
    const std::array<double, 16> matrix = matrix_of(p);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
      if (i > 0) *out_ += ' ';
      append_number(*out_, matrix[i]);
    }
    *out_ += "</core:transformationMatrix>";
    shape(p.shape);
    *out_ += "<core:referencePoint><Point><pos>";
    position(model::snap(p.place));
    *out_ += "</pos></Point></core:referencePoint></core:ImplicitGeometry>";
    close("lod3ImplicitRepresentation");
    *out_ += '\n';
  }

  /// The geometry of a shape where it is the first time, then a reference to that.
  void shape(std::size_t number) {
    const std::string id = shapes_ + std::to_string(number);
    if (shape_written_[number]) {
      *out_ += "<core:relativeGMLGeometry xlink:href=\"#" + id + "\"/>";
      return;
    }
    shape_written_[number] = true;
    const model::ObjectShape& shape = catalogue_.shapes[number];
    const auto shown = [](const auto& part) { return !shape_triangles(part).empty(); };
    const bool alone = std::count_if(shape.parts.begin(), shape.parts.end(), shown) == 1;
    *out_ += "<core:relativeGMLGeometry><MultiSurface gml:id=\"" + id + "\">";
    std::size_t group = 0;
    for (const model::ObjectShape::Triangles& part : shape.parts) {
      if (!shown(part)) continue;
      const std::string group_id = alone ? id : id + "_" + std::to_string(++group);
      paint(part.material, group_id);
      if (!alone) *out_ += "<surfaceMember><CompositeSurface gml:id=\"" + group_id + "\">";
      for (const ShapeTriangle& t : shape_triangles(part)) {
        *out_ += kPolygonBegin;
        *out_ += '>';
        *out_ += kExteriorBegin;
        for (std::size_t i = 0; i <= t.size(); ++i)
          for (const std::int64_t steps : t[i % t.size()]) {
            append_ten_thousandths_of_a_metre(*out_, steps);
            *out_ += ' ';
          }
        out_->pop_back();
        *out_ += kExteriorEnd;
        *out_ += kPolygonEnd;
      }
      if (!alone) *out_ += "</CompositeSurface></surfaceMember>\n";
    }
    *out_ += "</MultiSurface></core:relativeGMLGeometry>";
  }

  // ---- geometry

  void open_with_id(std::string_view name, const char* kind, std::size_t number) {
    *out_ += '<';
    *out_ += module_;
    *out_ += name;
    *out_ += " gml:id=\"" + *id_ + kind + std::to_string(number) + "\">";
  }

  void open_surface(std::string_view name, model::SurroundingMaterial material) {
    const std::string id = *id_ + "_m" + std::to_string(++surfaces_);
    paint(material, id);
    *out_ += '<';
    *out_ += name;
    *out_ += " gml:id=\"" + id + "\">";
  }

  void paint(model::SurroundingMaterial material, const std::string& id) {
    std::string& targets = targets_.at(material);
    if (targets.empty()) looks_.push_back(material);
    targets += "<app:target>#" + id + "</app:target>\n";
  }

  void multi_surface(const SurroundingPart& part) {
    open_surface("MultiSurface", part.material);
    polygons(part.faces);
    *out_ += "</MultiSurface>";
  }
  void composite_surface(const std::vector<const model::FlatPolygon*>& faces, model::SurroundingMaterial material) {
    open_surface("CompositeSurface", material);
    polygons(faces);
    *out_ += "</CompositeSurface>";
  }

  /// \param number  of the polygon before, where they are to have ids
  void polygons(const std::vector<const model::FlatPolygon*>& faces, std::size_t* number = nullptr) {
    for (const model::FlatPolygon* face : faces) {
      *out_ += kPolygonBegin;
      if (number) {
        *out_ += " gml:id=\"";
        append_polygon_id(*out_, *id_, ++*number);
        *out_ += '"';
      }
      *out_ += '>';
      bool outer = true;
      for (const std::vector<model::Point3>& ring : rings_on_grid(*face)) {
        *out_ += outer ? kExteriorBegin : kInteriorBegin;
        for (std::size_t i = 0; i <= ring.size(); ++i) {
          if (i > 0) *out_ += ' ';
          position(ring[i % ring.size()]);
        }
        *out_ += outer ? kExteriorEnd : kInteriorEnd;
        outer = false;
      }
      *out_ += kPolygonEnd;
    }
  }

  void position(const model::Point3& p) {
    append_grid(*out_, p.x);
    *out_ += ' ';
    append_grid(*out_, p.y);
    *out_ += ' ';
    append_grid(*out_, p.z);
  }

  const model::SurroundingCatalogue& catalogue_;
  std::string shapes_;  ///< what ids of shapes begin with
  std::vector<bool> shape_written_;
  std::vector<std::string> targets_;               ///< by material
  std::vector<model::SurroundingMaterial> looks_;  ///< in the order in which they come up
  std::string* out_ = nullptr;
  const std::string* id_ = nullptr;
  std::string_view module_;  ///< prefix of the object's elements, with its colon
  std::size_t areas_ = 0, surfaces_ = 0;
};

void append_head(std::string& out, const CityGmlOptions& options, const Box& box) {
  out += kHead;
  for (const auto& [space, file] : kModules) {
    if (out.back() != '"') out += ' ';
    out += "http://www.opengis.net/citygml/";
    out += space;
    out += "/2.0 http://schemas.opengis.net/citygml/";
    out += space;
    out += "/2.0/";
    out += file;
    out += ".xsd";
  }
  // Last: readers that look prefixes up by their address take the last one of an address.
  out += "\" xmlns=\"http://www.opengis.net/gml\">\n";
  // The description comes before the name in GML's sequence.
  if (const std::string text = citygml_description(options); !text.empty()) {
    out += "<description>";
    append_xml(out, text);
    out += "</description>\n";
  }
  if (!options.name.empty()) {
    out += "<gml:name>";
    append_xml(out, options.name);
    out += "</gml:name>\n";
  }
  if (box.empty) return;
  out += "<gml:boundedBy><Envelope";
  if (!options.srs_name.empty()) {
    out += " srsName=\"";
    append_xml(out, options.srs_name);
    out += '"';
  }
  out += " srsDimension=\"3\">";
  const auto corner = [&](std::string_view name, const model::Point3& p) {
    out += '<';
    out += name;
    out += '>';
    append_grid(out, p.x);
    out += ' ';
    append_grid(out, p.y);
    out += ' ';
    append_grid(out, p.z);
    out += "</";
    out += name;
    out += '>';
  };
  corner("lowerCorner", box.min);
  corner("upperCorner", box.max);
  out += "</Envelope></gml:boundedBy>\n";
}

}  // namespace

void write_surroundings_gml(const model::Surroundings& surroundings, const model::SurroundingCatalogue& catalogue,
                            model::TileId tile, const CityGmlOptions& options, const Sink& sink) {
  const std::vector<SurroundingObject> objects = surrounding_objects(surroundings, catalogue, tile);
  CityGmlOptions about = options;
  about.lean = false;  // that is of windows and doors
  std::string out;
  append_head(out, about, box_of(objects, catalogue));
  ObjectsText text(catalogue, tile);
  for (const SurroundingObject& object : objects) {
    text.append(out, object);
    if (out.size() < kPiece) continue;
    sink(out);
    out.clear();
  }
  text.append_appearance(out);
  out += "</core:CityModel>\n";
  sink(out);
}

std::string write_surroundings_gml(const model::Surroundings& surroundings,
                                   const model::SurroundingCatalogue& catalogue, model::TileId tile,
                                   const CityGmlOptions& options) {
  std::string out;
  write_surroundings_gml(surroundings, catalogue, tile, options, [&](std::string_view bytes) { out += bytes; });
  return out;
}

}  // namespace blockrand::outputs
