// Models of all roof elements on all kinds of roofs, to be looked at: contact_sheet.sh draws them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "pipeline/attributes/defaults.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "tests/unit/roofs/fitted_roof.h"

namespace blockrand::roofs {
namespace {

using model::RoofShape;
using namespace roof_checks;

constexpr RoofShape kShapes[] = {RoofShape::gabled,  RoofShape::hipped,      RoofShape::mansard,
                                 RoofShape::gambrel, RoofShape::half_hipped, RoofShape::double_saltbox};

/// Houses side by side.
class Street {
 public:
  Street() : defaults_(attributes::read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs")) {
    region_.extract = &no_tags_;
    for (const attributes::Material& m : defaults_.materials) region_.materials.push_back(m.material_class);
  }

  void add(const Polygon& plan, const Roof& roof, const std::vector<model::RoofInstallation>& installations) {
    masses::EnvelopeMaterials looks;
    looks.wall = face(model::SurfaceKind::wall, "plaster", {222, 214, 196});
    looks.roof = face(model::SurfaceKind::roof, "roof_tiles", {168, 80, 60});
    looks.under = face(model::SurfaceKind::ground, "plaster", {120, 120, 120});
    model::Building building;
    building.osm = {model::OsmType::way, static_cast<std::int64_t>(region_.buildings.size()) + 1};
    building.outline = {plan};
    add_part(building, plan, masses::envelope(plan, 0, roof, looks));
    for (const model::RoofInstallation& installation : installations) {
      model::Solid solid = installation.solid;
      for (model::Face& f : solid.faces) {
        const auto kind = f.kind;
        f = [&] {
          model::Face with_edges = installation.kind == model::RoofElementKind::chimney
                                       ? face(kind, "plaster", {140, 70, 55})
                                       : face(kind, "plaster", {70, 80, 90});
          with_edges.first_loop = f.first_loop;
          with_edges.loop_count = f.loop_count;
          return with_edges;
        }();
      }
      if (installation.kind == model::RoofElementKind::roof_window) solid.faces.back().colour = {120, 170, 210};
      add_part(building, plan, std::move(solid));
    }
    region_.buildings.push_back(std::move(building));
  }

  void write(const std::string& path) {
    std::ofstream(path, std::ios::binary) << outputs::write_glb(region_, {}).bytes;
    EXPECT_GT(std::ifstream(path, std::ios::binary | std::ios::ate).tellg(), 10000) << path;
  }

 private:
  model::Face face(model::SurfaceKind kind, const char* material, model::Colour colour) const {
    model::Face f;
    f.kind = kind;
    f.material = static_cast<std::uint8_t>(std::max(defaults_.material(material), 0));
    f.colour = colour;
    return f;
  }
  static void add_part(model::Building& building, const Polygon& plan, model::Solid solid) {
    model::BuildingPart part;
    part.id = building.id() + "." + std::to_string(building.parts.size());
    part.osm = building.osm;
    part.plan = plan;
    part.lod2_triangles = geometry::triangulate(solid).value();
    part.lod2 = std::move(solid);
    part.lod1 = part.lod2;
    part.lod1_triangles = part.lod2_triangles;
    part.lod = 2;
    building.parts.push_back(std::move(part));
  }

  attributes::Defaults defaults_;
  model::Extract no_tags_;
  model::Region region_;
};

BuiltRoof roof_of(RoofShape shape, const Polygon& plan, double height) {
  RoofRequest request;
  request.shape = shape;
  request.measures = {6, height};
  return build_roof(plan, request).value();
}

/// With ROOF_ELEMENTS_GLB=<folder>: dormers.glb has a row of houses for each kind of dormer and a column for each shape
/// of roof, elements.glb all elements together, plans.glb L, U and court plans and a row of houses.
TEST(RoofElementPictures, WritesModels) {
  const char* const folder = std::getenv("ROOF_ELEMENTS_GLB");
  if (!folder) GTEST_SKIP() << "ROOF_ELEMENTS_GLB names no folder";
  Street dormers, elements, plans;
  for (std::size_t row = 0; row < std::size(kDormerKinds); ++row)
    for (std::size_t column = 0; column < std::size(kShapes); ++column) {
      const double x = 18.0 * static_cast<double>(column), y = -16.0 * static_cast<double>(row);
      const Polygon plan = polygon({{x, y}, {x + 13, y}, {x + 13, y + 10}, {x, y + 10}});
      const BuiltRoof bare = roof_of(kShapes[column], plan, 6);
      Fitting with;
      with.dormer = usual_dormer(kDormerKinds[row]);
      with.cross_gables = with.roof_windows = with.chimneys = false;
      const Fitted only_dormers = fit_out(plan, {}, bare.roof, with);
      dormers.add(plan, only_dormers.roof, only_dormers.installations);
      with.cross_gables = with.roof_windows = with.chimneys = true;
      with.cross_gable.kind = kDormerKinds[row] == DormerKind::eyebrow ? DormerKind::gabled : kDormerKinds[row];
      if (with.cross_gable.kind == DormerKind::shed) with.cross_gable.roof_pitch = 10;
      if (row == 5) with.cross_gable.wall_height = 0;
      with.most_dormers = row % 2 == 0 ? 2 : 0;
      const Fitted all = fit_out(plan, {}, bare.roof, with);
      elements.add(plan, all.roof, all.installations);
    }
  double x = 0;
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::hipped, RoofShape::mansard, RoofShape::flat})
    for (const auto& [name, shown] : roof_checks::plans()) {
      if (name != "L" && name != "U" && name != "T" && name != "courtyard") continue;
      const auto across = geometry::extent_along(shown.outer.points, {1, 0});
      static std::map<RoofShape, double> next;
      const Polygon plan = moved(shown, 0, {next[shape] - across.minimum, -38.0 * x});
      next[shape] += across.maximum - across.minimum + 6;
      const Fitted all = fit_out(plan, {}, roof_of(shape, plan, 4).roof, {});
      plans.add(plan, all.roof, all.installations);
      if (name == "courtyard") continue;
      if (name == "U") x += 1;
    }
  for (int house = 0; house < 8; ++house) {
    const double left = 11.0 * house, top = 4.5 + 0.4 * (house % 3);
    const Polygon plan = polygon({{left, -175}, {left + 11, -175}, {left + 11, -164}, {left, -164}});
    const BuiltRoof bare = roof_of(RoofShape::gabled, plan, top);
    Fitting with;
    with.dormer = usual_dormer(kDormerKinds[house % 6]);
    with.cross_gables = house % 3 == 0;
    with.roof_windows = house % 2 == 1;
    const Fitted all = fit_out(plan, gables_as_party_walls(bare.roof), bare.roof, with);
    plans.add(plan, all.roof, all.installations);
  }
  dormers.write(std::string(folder) + "/dormers.glb");
  elements.write(std::string(folder) + "/elements.glb");
  plans.write(std::string(folder) + "/plans.glb");
}

}  // namespace
}  // namespace blockrand::roofs
