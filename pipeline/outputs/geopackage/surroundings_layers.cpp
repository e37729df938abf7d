#include "pipeline/outputs/geopackage/surroundings_layers.h"

#include <array>
#include <cmath>
#include <string_view>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/outputs/geopackage/cell_writer.h"
#include "pipeline/outputs/geopackage/dissolved_faces.h"
#include "pipeline/outputs/geopackage/qml.h"
#include "pipeline/outputs/surrounding_objects.h"

namespace blockrand::outputs {
namespace {

using layer_file::Column;
using layer_file::ColumnKind;
using layer_file::GeometryKind;
using model::Colour;

constexpr ColumnKind kReal = ColumnKind::real, kText = ColumnKind::text;
constexpr const char* kObject = "Object of OpenStreetMap; empty where nothing is mapped";

std::vector<Column> ground_columns() {
  return {
      {"osm_id", kText, "", kObject},
      {"class", kText, "", "What the ground is: carriageway, pavement, grass, water …"},
      {"material", kText, "", "What it is made of"},
      {"offset_m", kReal, "m", "Height above the terrain"},
      {"area_m2", kReal, "m²", "Area in plan"},
  };
}

std::vector<Column> body_columns() {
  return {
      {"osm_id", kText, "", kObject},
      {"class", kText, "", "What it is: wall, fence, hedge, rail, bridge …"},
      {"material", kText, "", "What it is made of"},
  };
}

std::vector<Column> object_columns() {
  return {
      {"osm_id", kText, "", "Object of OpenStreetMap; of trees in rows and woods that of the row or wood"},
      {"kind", kText, "", "What it is: tree, street_lamp, bench …"},
      {"shape", kText, "", "The shape that stands for it"},
      {"height_m", kReal, "m", "Height above its foot"},
      {"width_m", kReal, "m", "Width where it is widest"},
      {"turn_degrees", kReal, "degree", "Where its front looks, clockwise from grid north"},
  };
}

std::string id_text(model::OsmId id) { return id.number == 0 ? std::string() : id.text(); }

/// Clockwise from north, in [0, 360), of an angle counter-clockwise from east.
double direction_of(float turn) {
  const double degrees = std::fmod(90 - static_cast<double>(turn) * base::kDegreesPerRadian, 360);
  return rounded_direction(degrees < 0 ? degrees + 360 : degrees);
}

void append_ring_in_space(std::string& out, const std::vector<model::Point3>& ring) {
  layer_file::append_raw(out, static_cast<std::uint32_t>(ring.size() + 1));
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const model::Point3& p = ring[i % ring.size()];
    for (const double v : {p.x, p.y, p.z}) layer_file::append_raw(out, v);
  }
}

using Faces = std::vector<std::vector<std::vector<model::Point3>>>;

Faces shown_faces(const std::vector<model::FlatPolygon>& faces) {
  Faces out;
  for (const model::FlatPolygon& face : faces)
    if (auto rings = rings_on_grid(face); !rings.empty()) out.push_back(std::move(rings));
  return out;
}

void append_faces(std::string& out, const Faces& faces) {
  append_header(out, layer_file::kMultiPolygonZ, faces.size());
  for (const auto& rings : faces) {
    append_header(out, layer_file::kPolygonZ, rings.size());
    for (const auto& ring : rings) append_ring_in_space(out, ring);
  }
}

double area_of(const std::vector<model::Polygon>& polygons) {
  double sum = 0;
  for (const model::Polygon& polygon : polygons) {
    sum += std::fabs(geometry::signed_area(polygon.outer.points));
    for (const model::Ring& hole : polygon.holes) sum -= std::fabs(geometry::signed_area(hole.points));
  }
  return sum;
}

/// By class, in the order of model::GroundClass.
constexpr std::array<Colour, model::kGroundClassCount> kGroundColours{{
    {150, 140, 150},  // passage
    {150, 190, 225},  // water
    {110, 200, 230},  // swimming pool
    {165, 165, 175},  // runway
    {175, 175, 178},  // carriageway
    {190, 188, 186},  // parking lane
    {200, 170, 150},  // steps
    {205, 150, 140},  // cycle way
    {170, 160, 150},  // rail bed
    {200, 195, 205},  // platform
    {222, 205, 180},  // footway
    {214, 208, 200},  // pavement
    {228, 218, 205},  // square
    {205, 205, 190},  // parking
    {160, 205, 150},  // pitch
    {225, 200, 140},  // playground
    {175, 215, 140},  // golf
    {205, 160, 190},  // flower bed
    {125, 170, 105},  // wood
    {160, 185, 120},  // scrub
    {190, 220, 155},  // grass
    {205, 225, 175},  // garden
    {170, 200, 165},  // cemetery
    {230, 225, 170},  // field
    {240, 228, 180},  // sand
    {195, 190, 185},  // rock
    {215, 195, 165},  // construction
    {224, 220, 214},  // yard
    {232, 232, 218},  // land
}};

std::string spaced_words(std::string_view name) {
  std::string out(name);
  for (char& c : out)
    if (c == '_') c = ' ';
  return out;
}

std::string ground_style() {
  Qml qml(Shape::fill);
  qml.categories("class");
  for (std::size_t i = 0; i < kGroundColours.size(); ++i)
    qml.category(model::kGroundClassNames[i],
                 spaced_words(model::kGroundClassNames[i]) + ": " + std::string(model::kGroundClassAbout[i]),
                 kGroundColours[i]);
  return std::move(qml).done();
}

std::string one_colour(Shape shape, Colour colour) {
  Qml qml(shape);
  qml.single(colour, 255);
  return std::move(qml).done();
}

}  // namespace

SurroundingRows surrounding_rows(const model::Surroundings& surroundings,
                                 const model::SurroundingCatalogue& catalogue) {
  SurroundingRows out;
  RowWriter ground(out.ground, ground_columns().size());
  for (const model::GroundSurface& surface : surroundings.surfaces) {
    const std::vector<model::Polygon> polygons = dissolved(surface.faces);
    if (polygons.empty()) continue;
    ground.text(id_text(surface.object));
    ground.text(name(surface.ground));
    ground.text(catalogue.materials.at(surface.material).name);
    ground.real(to_millimetres(surface.offset));
    ground.real(rounded(area_of(polygons)));
    layer_file::append_multi_polygon(ground.geometry(), polygons);
    ground.end_row();
  }
  RowWriter bodies(out.bodies, body_columns().size());
  for (const model::SurroundingBody& body : surroundings.bodies) {
    const Faces faces = shown_faces(body.faces);
    if (faces.empty()) continue;
    bodies.text(id_text(body.object));
    bodies.text(name(body.body));
    bodies.text(catalogue.materials.at(body.material).name);
    append_faces(bodies.geometry(), faces);
    bodies.end_row();
  }
  RowWriter objects(out.objects, object_columns().size());
  for (const model::PlacedObject& placed : surroundings.objects) {
    const model::ObjectShape& shape = catalogue.shapes.at(placed.shape);
    objects.text(id_text(placed.object));
    objects.text(shape.kind);
    objects.text(shape.name);
    objects.real(height_of(placed, shape));
    objects.real(width_of(placed, shape));
    objects.real(direction_of(placed.turn));
    layer_file::append_point(objects.geometry(), model::snap(placed.place.xy()));
    objects.end_row();
  }
  return out;
}

std::vector<layer_file::LayerSpec> surrounding_layers() {
  return {{"ground", GeometryKind::multi_polygon, ground_columns(), "Ground around the buildings, by what it is"},
          {"surrounding_bodies", GeometryKind::multi_polygon_z, body_columns(),
           "What stands around the buildings along lines and over areas, as faces in space"},
          {"surrounding_objects", GeometryKind::point, object_columns(),
           "Trees, lamps and other things around the buildings"}};
}

std::vector<layer_file::QgisStyle> surrounding_styles() {
  return {
      {"ground", "Classes", "What the ground is", ground_style(), true},
      {"surrounding_bodies", "Bodies", "Walls, fences, hedges, rails", one_colour(Shape::fill, {150, 120, 100}), true},
      {"surrounding_objects", "Objects", "Trees, lamps and other things", one_colour(Shape::marker, {90, 140, 70}),
       true}};
}

}  // namespace blockrand::outputs
