// All elements of edges together on every kind of roof and plan, free-standing and in rows; and pictures of them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "pipeline/outputs/gltf/glb_writer.h"
#include "tests/unit/roofs/drawn_gables.h"
#include "tests/unit/roofs/element_checks.h"
#include "tests/unit/roofs/roof_checks.h"
#include "tests/unit/roofs/roof_with_edges.h"

namespace blockrand::roof_checks {
namespace {

using model::RoofElementKind;
using model::RoofShape;
using model::SurfaceKind;
using roofs::Roof;

constexpr double kEaves = 10;  // m

const RoofShape kShapes[] = {RoofShape::flat,        RoofShape::gabled,         RoofShape::hipped,
                             RoofShape::mansard,     RoofShape::gambrel,        RoofShape::half_hipped,
                             RoofShape::skillion,    RoofShape::double_saltbox, RoofShape::quadruple_saltbox,
                             RoofShape::saltbox,     RoofShape::round,          RoofShape::hipped_and_gabled,
                             RoofShape::side_hipped, RoofShape::pyramidal,      RoofShape::gabled_height_moved};

std::optional<Roof> roof_on(const Polygon& plan, RoofShape shape, double height = 4) {
  roofs::RoofRequest request;
  request.shape = shape;
  request.measures = {kEaves, height};
  auto built = roofs::build_roof(plan, request);
  if (!built) return std::nullopt;
  return std::move(built->roof);
}

/// Which walls of a plan are a neighbour's.
enum class Row { free_standing, gable_ends, every_second };

/// A neighbour that stands in an inner corner stands before both its walls: the other one has no room.
std::vector<Neighbourhood> around_of(const Polygon& plan, const Roof& roof, Row row) {
  std::vector<Neighbourhood> out(roof.wall_tops.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (row == Row::gable_ends) out[i].party_wall = roof.wall_tops[i].size() > 2;
    if (row == Row::every_second) out[i].party_wall = i % 2 == 1;
    if (row == Row::every_second && i % 4 == 1) out[i].neighbour = {{0, kEaves + 1}};
  }
  const auto edges = roofs::plan_edges(plan);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const roofs::PlanEdge& next = edges[edges[i].after];
    if (edges[i].along.x * next.along.y - edges[i].along.y * next.along.x >= 0) continue;
    if (out[i].party_wall) out[edges[i].after].room = 0;
    if (out[edges[i].after].party_wall) out[i].room = 0;
  }
  return out;
}

class DressedRoofs : public testing::TestWithParam<RoofShape> {};

TEST_P(DressedRoofs, BodiesAreValidAndTouchOnly) {
  int bodies = 0, asked = 0, refused = 0;
  for (const auto& [name, plan] : plans())
    for (const double angle : {0.0, 133.7})
      for (const Row row : {Row::free_standing, Row::gable_ends, Row::every_second}) {
        const Polygon place = moved(plan, angle, angle == 0 ? Point2{} : kPlaces[1]);
        const auto roof = roof_on(place, GetParam());
        ASSERT_TRUE(roof) << name;
        const model::Solid house = masses::envelope(place, 0, *roof, {});
        if (validity(house) != "none") continue;
        const auto around = around_of(place, *roof, row);
        std::optional<std::pair<std::uint32_t, roofs::GableOptions>> gable;
        if (const auto drawn = roofs::draw_gable(1, static_cast<std::uint64_t>(angle), GetParam()))
          if (const auto edge = gable_edge(place, *roof, around)) gable.emplace(*edge, *drawn);
        const RoofWithEdges with_edges = dress(place, *roof, around, gable);
        ASSERT_EQ(fault(house, with_edges.bodies), "") << name << " at " << angle << ", row " << static_cast<int>(row);
        bodies += static_cast<int>(with_edges.bodies.size());
        for (const auto* e : {&with_edges.gables, &with_edges.firewalls, &with_edges.parapets, &with_edges.overhangs,
                              &with_edges.caps}) {
          asked += e->asked;
          refused += e->refused;
        }
        // Nothing hangs over a party wall: no body but those within the plan comes beyond its line there.
        const auto edges = roofs::plan_edges(place);
        for (const auto& body : with_edges.bodies) {
          if (body.kind != RoofElementKind::eaves && body.kind != RoofElementKind::verge) continue;
          for (std::size_t i = 0; i < around.size(); ++i) {
            if (!around[i].party_wall) continue;
            const roofs::PlanEdge& e = edges[i];
            // The wall itself, moved out by 1 cm, is free of it.
            const Point2 out_of{-e.inward().x * 0.01, -e.inward().y * 0.01};
            for (int k = 1; k < 8; ++k) {
              const Point2 p{e.from.x + (e.to.x - e.from.x) * k / 8 + out_of.x,
                             e.from.y + (e.to.y - e.from.y) * k / 8 + out_of.y};
              for (const auto& face : body.solid.faces) {
                if (face.kind != SurfaceKind::roof) continue;
                std::vector<Point2> loop;
                for (const std::uint32_t v : body.solid.indices_of(body.solid.loops_of(face)[0]))
                  loop.push_back(body.solid.vertices[v].xy());
                ASSERT_FALSE(e.length > 0.2 && geometry::contains(loop, p)) << name << " at " << angle << " edge " << i;
              }
            }
          }
        }
      }
  std::printf("%-20s %5d bodies, %4d elements asked, %3d refused\n", std::string(model::name(GetParam())).c_str(),
              bodies, asked, refused);
}

INSTANTIATE_TEST_SUITE_P(Shapes, DressedRoofs, testing::ValuesIn(kShapes), [](const auto& info) {
  std::string name(model::name(info.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(DressedRoofsOnRandomPlans, BodiesAreValidAndTouchOnly) {
  Random random(97);
  int bodies = 0, asked = 0, refused = 0;
  for (int i = 0; i < 300; ++i) {
    const Polygon plan = random_plan(random);
    const RoofShape shape = kShapes[random.next(std::size(kShapes))];
    const auto roof = roof_on(plan, shape, 2 + 4 * random.unit());
    if (!roof) continue;
    const model::Solid house = masses::envelope(plan, 0, *roof, {});
    if (validity(house) != "none") continue;
    const auto around = around_of(plan, *roof, static_cast<Row>(random.next(3)));
    std::optional<std::pair<std::uint32_t, roofs::GableOptions>> gable;
    if (const auto drawn = roofs::draw_gable(2, static_cast<std::uint64_t>(i), shape))
      if (const auto edge = gable_edge(plan, *roof, around)) gable.emplace(*edge, *drawn);
    const RoofWithEdges with_edges = dress(plan, *roof, around, gable);
    ASSERT_EQ(fault(house, with_edges.bodies), "") << "plan " << i << ' ' << model::name(shape);
    bodies += static_cast<int>(with_edges.bodies.size());
    for (const auto* e :
         {&with_edges.gables, &with_edges.firewalls, &with_edges.parapets, &with_edges.overhangs, &with_edges.caps}) {
      asked += e->asked;
      refused += e->refused;
    }
  }
  std::printf("random plans: %d bodies, %d elements asked, %d refused\n", bodies, asked, refused);
  EXPECT_GT(bodies, 2000);
  EXPECT_LE(refused, asked / 5);
}

TEST(DressedRoofsOnRings, SixHundredCorners) {
  Polygon plan = regular(600, 40);
  std::vector<Point2> court = regular(200, 25).outer.points;
  std::reverse(court.begin(), court.end());
  plan.holes.push_back(testing_shapes::ring(court));
  for (const RoofShape shape : {RoofShape::flat, RoofShape::hipped}) {
    const auto roof = roof_on(plan, shape);
    ASSERT_TRUE(roof);
    const model::Solid house = masses::envelope(plan, 0, *roof, {});
    if (validity(house) != "none") continue;
    const RoofWithEdges with_edges = dress(plan, *roof, {}, std::nullopt);
    EXPECT_EQ(fault(house, with_edges.bodies), "") << model::name(shape);
    EXPECT_FALSE(with_edges.bodies.empty());
    EXPECT_EQ(with_edges.overhangs.refused + with_edges.parapets.refused, 0);
  }
}

TEST(ElementChecks, SeeWhatReachesIntoTheHouse) {
  // The judge itself: eaves moved 3 cm into the wall, and a body twice.
  const Polygon plan = testing_shapes::polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  const auto roof = roof_on(plan, RoofShape::hipped);
  const model::Solid house = masses::envelope(plan, 0, *roof, {});
  Bodies bodies = roofs::overhangs(plan, *roof, {}).elements.bodies;
  ASSERT_EQ(fault(house, bodies), "");
  Bodies twice = bodies;
  twice.push_back(bodies[0]);
  EXPECT_NE(fault(house, twice), "");
  for (auto& p : bodies[0].solid.vertices) p.x += 0.03125;
  EXPECT_NE(fault(house, bodies), "");
}

// ---- pictures -------------------------------------------------------------------------------------------------------

model::Colour colour_of(RoofElementKind kind, SurfaceKind face) {
  if (face == SurfaceKind::outer_ceiling) return {226, 214, 190};
  switch (kind) {
    case RoofElementKind::parapet:
      return {196, 196, 200};
    case RoofElementKind::gable:
      return {206, 160, 120};
    case RoofElementKind::firewall:
      return {150, 96, 84};
    case RoofElementKind::eaves:
      return face == SurfaceKind::roof ? model::Colour{176, 90, 66} : model::Colour{240, 236, 226};
    case RoofElementKind::verge:
      return face == SurfaceKind::roof ? model::Colour{186, 104, 70} : model::Colour{240, 236, 226};
    case RoofElementKind::dormer:
    case RoofElementKind::cross_gable:
    case RoofElementKind::roof_window:
    case RoofElementKind::chimney:
    case RoofElementKind::ridge_cap:
    case RoofElementKind::hip_cap:
    case RoofElementKind::gutter:
    case RoofElementKind::downpipe:
    default:
      return {120, 52, 40};
  }
}

/// Solids as parts of one building, for write_glb.
struct Sheet {
  model::Extract no_tags;
  model::Region region;

  Sheet() {
    region.extract = &no_tags;
    region.materials.push_back({"plaster", 0.9f, 0.0f});
    model::Building b;
    b.osm = {model::OsmType::way, 1};
    region.buildings.push_back(std::move(b));
  }

  void add(model::Solid solid, Point2 by) {
    auto& parts = region.buildings[0].parts;
    model::BuildingPart p;
    p.id = "w1." + std::to_string(parts.size());
    p.osm = {model::OsmType::way, static_cast<std::int64_t>(parts.size()) + 1};
    p.lod = 2;
    for (auto& v : solid.vertices) v = {v.x + by.x, v.y + by.y, v.z};
    p.lod2_triangles = *geometry::triangulate(solid);
    p.lod2 = std::move(solid);
    parts.push_back(std::move(p));
  }

  void add(const Polygon& plan, const Roof& roof, const RoofWithEdges& with_edges, Point2 by) {
    model::Face wall, top, under;
    wall.kind = SurfaceKind::wall;
    wall.colour = {222, 214, 196};
    top.kind = SurfaceKind::roof;
    top.colour = {168, 80, 60};
    under.kind = SurfaceKind::ground;
    add(masses::envelope(plan, 0, roof, {wall, top, under}), by);
    for (model::RoofInstallation body : with_edges.bodies) {
      for (model::Face& f : body.solid.faces) f.colour = colour_of(body.kind, f.kind);
      add(std::move(body.solid), by);
    }
  }

  void write(const std::string& path) {
    std::ofstream(path, std::ios::binary) << outputs::write_glb(region, {}).bytes;
    EXPECT_GT(std::ifstream(path, std::ios::binary | std::ios::ate).tellg(), 10000) << path;
  }
};

/// With ROOF_EDGES_GLB=<folder>: pictures to look at (contact_sheet.sh shows how).
TEST(DressedRoofPictures, AreWritten) {
  const char* const folder = std::getenv("ROOF_EDGES_GLB");
  if (!folder) GTEST_SKIP() << "ROOF_EDGES_GLB names no folder";
  using testing_shapes::polygon;
  const std::vector<Polygon> four{polygon({{0, 0}, {18, 0}, {18, 10}, {0, 10}}),
                                  polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}}),
                                  plans().at("courtyard"), polygon({{0, 0}, {16, 0}, {14, 9}, {2, 11}})};
  for (const RoofShape shape : kShapes) {
    Sheet sheet;
    double x = 0;
    for (const Polygon& plan : four) {
      const auto roof = roof_on(plan, shape);
      ASSERT_TRUE(roof);
      for (const Row row : {Row::free_standing, Row::every_second}) {
        const auto around = around_of(plan, *roof, row);
        sheet.add(plan, *roof, dress(plan, *roof, around, std::nullopt), {x, row == Row::free_standing ? 0.0 : -42.0});
      }
      x += geometry::extent_along(plan.outer.points, {1, 0}).maximum + 8;
    }
    sheet.write(std::string(folder) + "/edges_" + std::string(model::name(shape)) + ".glb");
  }
  // Gables: every form before every roof that it may stand before.
  Sheet gables;
  const Polygon house = polygon({{0, 0}, {8, 0}, {8, 18}, {0, 18}});
  double y = 0;
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::half_hipped, RoofShape::mansard, RoofShape::gambrel,
                                RoofShape::hipped, RoofShape::flat}) {
    std::vector<roofs::GableOptions> forms;
    if (roofs::may_stand_before(roofs::GableForm::attic, shape)) {
      for (const double pediment : {0.0, 0.6}) forms.push_back({.form = roofs::GableForm::attic, .pediment = pediment});
    } else {
      for (int steps = 3; steps <= 5; ++steps) forms.push_back({.steps = steps});
      for (int curves = 1; curves <= 2; ++curves) forms.push_back({.form = roofs::GableForm::curved, .curves = curves});
    }
    double x = 0;
    for (const auto& form : forms) {
      const auto roof = roof_on(house, shape, shape == RoofShape::flat ? 0 : 5);
      gables.add(house, *roof, dress(house, *roof, {}, std::pair(0u, form)), {x, y});
      x += 12;
    }
    y += 30;
  }
  gables.write(std::string(folder) + "/gables.glb");
}

}  // namespace
}  // namespace blockrand::roof_checks
