// Every roof shape on every plan of grid.txt, in three orientations, against numbers worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include "pipeline/attributes/defaults.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/masses/mass.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::roofs {
namespace {

using model::BuildingPart;
using model::IssueCode;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofShape;
using model::Solid;
using model::SurfaceKind;

const std::string kFolder = std::string(BLOCKRAND_SOURCE_DIR) + "/tests/unit/roofs/";
constexpr double kTop = 15, kRoofHeight = 4;  // m

// ---- the table ------------------------------------------------------------------------------------------------------

/// What a cell must be, or what it is. Written as in grid.txt: "F/D+U*".
struct Counts {
  int faces = 0, directions = 0, upright = 0;
  bool adapted = false;
  friend bool operator==(const Counts&, const Counts&) = default;
  std::string text() const {
    return std::to_string(faces) + "/" + std::to_string(directions) + (upright ? "+" + std::to_string(upright) : "") +
           (adapted ? "*" : "");
  }
};

struct Grid {
  std::vector<std::pair<std::string, Polygon>> plans;
  std::map<RoofShape, std::vector<Counts>> expected;  ///< a cell per plan, in the order of `plans`
};

model::Ring read_ring(const std::string& text) {
  std::vector<Point2> points;
  std::stringstream corners(text);
  for (std::string corner; std::getline(corners, corner, ',');) {
    Point2 p;
    std::stringstream(corner) >> p.x >> p.y;
    points.push_back(model::snap(p));
  }
  return testing_shapes::ring(std::move(points));
}

Counts read_counts(const std::string& text) {
  Counts c;
  char slash = 0, sign = 0;
  std::stringstream in(text);
  if (!(in >> c.faces >> slash >> c.directions) || slash != '/') throw std::runtime_error("not a cell: " + text);
  while (in >> sign) {
    if (sign == '*') c.adapted = true;
    if (sign == '+' && !(in >> c.upright)) throw std::runtime_error("not a cell: " + text);
  }
  return c;
}

Grid read_grid() {
  Grid grid;
  std::ifstream file(kFolder + "grid.txt");
  if (!file) throw std::runtime_error("no grid.txt");
  bool table = false;
  for (std::string line; std::getline(file, line);) {
    std::stringstream in(line);
    std::string word, rest;
    if (!(in >> word) || word[0] == '#') continue;
    std::getline(in, rest);
    std::stringstream words(rest);
    if (table) {
      const auto shape = model::roof_shape(word);
      if (!shape) throw std::runtime_error("no roof shape: " + word);
      for (std::string cell; words >> cell;) grid.expected[*shape].push_back(read_counts(cell));
      if (grid.expected[*shape].size() != grid.plans.size()) throw std::runtime_error("cells missing: " + word);
    } else if (word == "plan") {
      words >> word;
      grid.plans.push_back({word, {}});
    } else if (word == "outer") {
      grid.plans.back().second.outer = read_ring(rest);
    } else if (word == "hole") {
      grid.plans.back().second.holes.push_back(read_ring(rest));
    } else if (word == "table") {
      table = true;
      std::size_t column = 0;
      for (std::string name; words >> name; ++column)
        if (grid.plans.at(column).first != name)
          throw std::runtime_error("columns in another order than plans: " + name);
    } else {
      throw std::runtime_error("not understood: " + line);
    }
  }
  return grid;
}

const Grid& grid() {
  static const Grid read = read_grid();
  return read;
}

// ---- building -------------------------------------------------------------------------------------------------------

Polygon mirrored(Polygon p) {
  const auto mirror = [](model::Ring& r) {
    for (Point2& q : r.points) q.x = -q.x;
    std::reverse(r.points.begin(), r.points.end());
  };
  mirror(p.outer);
  for (model::Ring& hole : p.holes) mirror(hole);
  return p;
}

const attributes::Defaults& defaults() {
  static const attributes::Defaults read = attributes::read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  return read;
}

/// A region with a building per plan, all with a roof of one shape.
model::Region built(const std::vector<Polygon>& plans, RoofShape shape) {
  static const model::Extract no_tags;
  model::Region region;
  region.extract = &no_tags;
  for (const attributes::Material& m : defaults().materials) region.materials.push_back(m.material_class);
  for (const Polygon& plan : plans) {
    model::Building b;
    b.osm = {model::OsmType::way, static_cast<std::int64_t>(region.buildings.size()) + 1};
    b.outline = {plan};
    BuildingPart p;
    p.id = b.id();
    p.osm = b.osm;
    p.plan = plan;
    p.attributes.roof_shape = {shape, model::Source::tag, 1};
    p.attributes.height = {kTop, model::Source::tag, 1};
    p.attributes.roof_height = {kRoofHeight, model::Source::tag, 1};
    p.attributes.wall_material.value = "plaster";
    p.attributes.roof_material.value = "roof_tiles";
    p.attributes.wall_colour.value = {222, 214, 196};
    p.attributes.roof_colour.value = {168, 80, 60};
    b.attributes = p.attributes;
    b.parts.push_back(std::move(p));
    region.buildings.push_back(std::move(b));
  }
  masses::build_masses(region, defaults(), {}, 2);
  return region;
}

// ---- measuring ------------------------------------------------------------------------------------------------------

struct Vector {
  double x = 0, y = 0, z = 0;
};

/// Twice the area of a face as a vector (Newell), holes taken off.
Vector doubled_area(const Solid& solid, const model::Face& face) {
  Vector n;
  for (const auto& loop : solid.loops_of(face)) {
    const auto indices = solid.indices_of(loop);
    const Point3 o = solid.vertices[indices[0]];  // near the face: coordinates are millions of metres
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const Point3 a = solid.vertices[indices[i]], b = solid.vertices[indices[(i + 1) % indices.size()]];
      n.x += (a.y - o.y) * (b.z - o.z) - (a.z - o.z) * (b.y - o.y);
      n.y += (a.z - o.z) * (b.x - o.x) - (a.x - o.x) * (b.z - o.z);
      n.z += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    }
  }
  return n;
}

double diameter(const Solid& solid, const model::Face& face) {
  double most = 0;
  const auto indices = solid.indices_of(solid.loops_of(face)[0]);
  for (const std::uint32_t i : indices)
    for (const std::uint32_t j : indices) {
      const Point3 a = solid.vertices[i], b = solid.vertices[j];
      most = std::max(most, std::hypot(a.x - b.x, a.y - b.y, a.z - b.z));
    }
  return most;
}

/// Number of compass directions, where those less than five degrees apart are one.
int directions(std::vector<double> degrees) {
  if (degrees.empty()) return 0;
  std::sort(degrees.begin(), degrees.end());
  int gaps = degrees.front() + 360 - degrees.back() > 5;
  for (std::size_t i = 1; i < degrees.size(); ++i) gaps += degrees[i] - degrees[i - 1] > 5;
  return std::max(gaps, 1);
}

/// One cell in one orientation.
struct Measured {
  Counts counts;
  double mean_height = 0;  ///< m: volume by plan area
  std::string fault;       ///< the first thing wrong besides the counts
};

/// What stands for a shape that the plan does not take.
RoofShape relative(RoofShape asked) {
  if (asked == RoofShape::crosspitched) return RoofShape::gabled;
  if (asked == RoofShape::dome || asked == RoofShape::onion) return RoofShape::dome;
  return RoofShape::hipped;
}

Measured measure(const BuildingPart& part, const Polygon& plan, RoofShape asked, bool may_adapt) {
  constexpr double kLeastWidth = 0.11, kLeastSlope = 0.0349;  // m; tan 2 degrees
  Measured out;
  const auto fault = [&](const std::string& text) {
    if (out.fault.empty()) out.fault = text;
  };
  if (part.lod != 2 || part.lod1.empty() || part.lod2.empty()) {
    fault("lod " + std::to_string(part.lod));
    return out;
  }
  for (const auto& [solid, triangles] :
       {std::pair(&part.lod1, &part.lod1_triangles), std::pair(&part.lod2, &part.lod2_triangles)}) {
    const auto check = geometry::check_solid(*solid, *triangles);
    if (!check.valid()) fault(check.text());
  }
  for (const IssueCode code : part.fallbacks) {
    if (code == IssueCode::roof_with_bays) continue;  // a shape with upright pieces has slopes for the step
    if (code == IssueCode::roof_shape_adapted && !out.counts.adapted)
      out.counts.adapted = true;
    else
      fault(std::string(model::info(code).text));
  }
  if (part.built_roof != (may_adapt ? relative(asked) : asked))
    fault("built " + std::string(model::name(part.built_roof)));

  const Solid& solid = part.lod2;
  const double eaves = asked == RoofShape::flat ? kTop : kTop - kRoofHeight;
  double highest = 0, lowest = 1e9, covered = 0;
  std::size_t walls = 0;
  std::vector<double> looks;
  for (const Point3& p : solid.vertices) highest = std::max(highest, p.z);
  for (const model::Face& face : solid.faces) {
    if (face.kind == SurfaceKind::wall) {
      walls += face.edge != -1;
      out.counts.upright += face.edge == -1;
    }
    if (face.kind != SurfaceKind::roof) continue;
    ++out.counts.faces;
    for (const std::uint32_t i : solid.indices_of(solid.loops_of(face)[0]))
      lowest = std::min(lowest, solid.vertices[i].z);
    const Vector n = doubled_area(solid, face);
    covered += n.z / 2;  // bulging onions look down in places: these take off what the bulge adds
    if (std::hypot(n.x, n.y) <= kLeastSlope * std::fabs(n.z)) continue;
    if (std::hypot(n.x, n.y, n.z) < kLeastWidth * diameter(solid, face)) continue;
    looks.push_back(std::atan2(n.y, n.x) * 180 / 3.14159265358979323846);
  }
  out.counts.directions = directions(std::move(looks));
  const double area = geometry::area(plan);
  out.mean_height = geometry::volume(solid, part.lod2_triangles) / area;

  std::size_t edges = plan.outer.size();
  for (const model::Ring& hole : plan.holes) edges += hole.size();
  std::ostringstream wrong;
  constexpr double kRunsOn = 0.15;  // m
  if (std::fabs(highest - kTop) > 0.002)
    wrong << "top " << highest;
  else if (lowest < eaves - kRunsOn)  // over the step of 0.05 m
    wrong << "roof down to " << lowest;
  else if (std::fabs(covered - area) > 0.001 * area)
    wrong << "covers " << covered << " of " << area;
  else if (walls != edges)
    wrong << walls << " walls";
  if (!wrong.str().empty()) fault(wrong.str());
  return out;
}

// ---- judging --------------------------------------------------------------------------------------------------------

/// "ok", or what is wrong with a cell.
std::string judge(std::size_t column, RoofShape shape) {
  const Polygon& plan = grid().plans[column].second;
  const Counts expected = grid().expected.at(shape)[column];
  const std::vector<std::pair<std::string, Polygon>> orientations{
      {"", plan}, {"turned: ", testing_shapes::turned(plan)}, {"mirrored: ", mirrored(plan)}};
  std::optional<double> height;
  for (const auto& [orientation, p] : orientations) {
    Polygon cleaned = p;
    geometry::remove_collinear(cleaned.outer, 0.01);
    const model::Region region = built({p}, shape);
    const Measured m = measure(region.buildings[0].parts[0], cleaned, shape, expected.adapted);
    if (m.counts != expected) {
      const bool worse = !m.fault.empty();
      return orientation + m.counts.text() + ", not " + expected.text() + (worse ? ", " + m.fault : "");
    }
    if (!m.fault.empty()) return orientation + m.fault;
    if (!height) height = m.mean_height;
    if (std::fabs(m.mean_height - *height) > 0.001 * *height) {
      std::ostringstream text;
      text << orientation << "mean height " << m.mean_height << ", not " << *height;
      return text.str();
    }
  }
  return "ok";
}

/// Results by shape, printed as one table after all tests where one failed.
std::map<RoofShape, std::vector<std::string>> results;

class PrintsTheGrid : public testing::Environment {
  void TearDown() override {
    std::size_t bad = 0;
    for (const auto& [shape, cells] : results)
      bad +=
          static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [](const auto& c) { return c != "ok"; }));
    if (bad == 0) return;
    std::vector<std::string> reasons;  // numbered, so that the table stays narrow
    std::cout << std::left << "\nRoof grid: faces/directions+upright*adapted. " << bad
              << " cells are not as in grid.txt.\n"
              << std::setw(20) << "";
    for (const auto& [name, plan] : grid().plans) std::cout << std::setw(10) << name.substr(0, 9);
    for (const auto& [shape, cells] : results) {
      std::cout << '\n' << std::setw(20) << model::name(shape);
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i] == "ok") {
          std::cout << std::setw(10) << "ok";
          continue;
        }
        reasons.push_back(std::string(model::name(shape)) + " on " + grid().plans[i].first + ": " + cells[i]);
        std::cout << std::setw(10) << "(" + std::to_string(reasons.size()) + ")";
      }
    }
    std::cout << '\n';
    for (std::size_t i = 0; i < reasons.size(); ++i) std::cout << "(" << i + 1 << ") " << reasons[i] << '\n';
  }
};
[[maybe_unused]] const auto* const printer = testing::AddGlobalTestEnvironment(new PrintsTheGrid);

class RoofGrid : public testing::TestWithParam<RoofShape> {};

TEST_P(RoofGrid, IsOnEveryPlanAsWorkedOutByHand) {
  ASSERT_TRUE(grid().expected.contains(GetParam()));
  for (std::size_t column = 0; column < grid().plans.size(); ++column) {
    const std::string result = judge(column, GetParam());
    EXPECT_EQ(result, "ok") << model::name(GetParam()) << " on " << grid().plans[column].first;
    results[GetParam()].push_back(result);
  }
}

std::vector<RoofShape> shapes() {
  std::vector<RoofShape> out;
  for (std::size_t i = 0; i < std::size(model::kRoofShapeNames); ++i)
    // `lined` has lines of its own on every plan; the last two name no shape.
    if (const auto shape = static_cast<RoofShape>(i); shape != RoofShape::lined && shape != RoofShape::berlin &&
                                                      shape != RoofShape::many && shape != RoofShape::other)
      out.push_back(shape);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Shapes, RoofGrid, testing::ValuesIn(shapes()), [](const auto& info) {
  std::string name(model::name(info.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(RoofGridPlans, AreAsManyAsTheirNotesSay) {
  EXPECT_EQ(grid().plans.size(), 15u);
  std::map<std::string, std::size_t> corners;
  for (const auto& [name, plan] : grid().plans) {
    corners[name] = plan.outer.size();
    EXPECT_GT(geometry::signed_area(plan.outer.points), 0) << name;
    for (const model::Ring& hole : plan.holes) EXPECT_LT(geometry::signed_area(hole.points), 0) << name;
  }
  EXPECT_EQ(corners.at("comb"), 30u);
  EXPECT_EQ(corners.at("12-gon"), 12u);
  EXPECT_EQ(corners.at("near-collinear"), 10u);
}

/// With ROOF_GRID_GLB=<folder>: a GLB per shape with all plans side by side, for contact_sheet.sh.
TEST(RoofGridPictures, WritesAModelPerShape) {
  const char* const folder = std::getenv("ROOF_GRID_GLB");
  if (!folder) GTEST_SKIP() << "ROOF_GRID_GLB names no folder";
  constexpr double kGap = 8, kRow = 42;  // m
  std::vector<Polygon> plans;
  double x = 0;
  for (std::size_t i = 0; i < grid().plans.size(); ++i) {
    Polygon plan = grid().plans[i].second;
    if (i % 5 == 0) x = 0;
    const auto across = geometry::extent_along(plan.outer.points, {1, 0}),
               up = geometry::extent_along(plan.outer.points, {0, 1});
    const Point2 by{x - across.minimum, -kRow * static_cast<double>(i / 5) - up.minimum};
    const auto move = [&](model::Ring& ring) {
      for (Point2& p : ring.points) p = model::snap(Point2{p.x + by.x, p.y + by.y});
    };
    move(plan.outer);
    for (model::Ring& hole : plan.holes) move(hole);
    x += across.maximum - across.minimum + kGap;
    plans.push_back(std::move(plan));
  }
  for (const RoofShape shape : shapes()) {
    const std::string path = std::string(folder) + "/" + std::string(model::name(shape)) + ".glb";
    std::ofstream(path, std::ios::binary) << outputs::write_glb(built(plans, shape), {}).bytes;
    EXPECT_GT(std::ifstream(path, std::ios::binary | std::ios::ate).tellg(), 10000) << path;
  }
}

}  // namespace
}  // namespace blockrand::roofs
