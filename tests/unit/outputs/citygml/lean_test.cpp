// Lean CityGML: openings in the plane of their walls, ornaments without small pieces.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "pipeline/geometry/cgal_validator.h"
#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/citygml/flat_openings.h"
#include "pipeline/outputs/citygml/lean_element.h"
#include "tests/unit/outputs/facade_region.h"
#include "tests/validators/citygml_reader.h"

namespace blockrand::outputs {
namespace {

using test::facade_region;

CityGmlOptions lean_options() {
  CityGmlOptions o;
  o.lod = 3;
  o.lean = true;
  o.srs_name = "urn:ogc:def:crs:EPSG::25833";
  return o;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(FlatOpenings, FillTheHolesOfTheirWalls) {
  const auto s = facade_region();
  const model::Detail& detail = s.region().buildings.front().parts.front().lod3;
  const FlatOpenings flat = flat_openings(detail);
  ASSERT_EQ(flat.detail.openings.size(), detail.openings.size());
  std::size_t reveals = 0;
  for (std::size_t o = 0; o < detail.openings.size(); ++o) {
    const model::Opening &was = detail.openings[o], &is = flat.detail.openings[o];
    reveals += was.reveal_count;
    EXPECT_NEAR(flat.depth[o], 0.15, 0.001);
    EXPECT_EQ(is.reveal_count, 0u);
    const auto &before = detail.solid.faces[was.polygon], &after = flat.detail.solid.faces[is.polygon];
    EXPECT_EQ(before.kind, after.kind);
    EXPECT_EQ(before.colour, after.colour);
    const auto from = detail.solid.indices_of(detail.solid.loops_of(before)[0]),
               to = flat.detail.solid.indices_of(flat.detail.solid.loops_of(after)[0]);
    ASSERT_EQ(from.size(), to.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      const model::Point3 &p = detail.solid.vertices[from[i]], &q = flat.detail.solid.vertices[to[i]];
      EXPECT_EQ(p.z, q.z);
      EXPECT_NEAR(std::hypot(p.x - q.x, p.y - q.y), 0.15, 0.001);
    }
  }
  EXPECT_GT(reveals, 0u);
  EXPECT_EQ(flat.detail.solid.faces.size() + reveals, detail.solid.faces.size());
}

TEST(LeanCityGml, SolidsAreSoundAndOpeningsStay) {
  const auto s = facade_region();
  const std::string text = write_citygml(s.region(), lean_options());
  std::size_t openings = 0;
  for (const auto& b : s.region().buildings)
    for (const auto& part : b.parts) openings += part.lod3.openings.size();
  EXPECT_EQ(count(text, "<bldg:opening>"), openings);
  EXPECT_EQ(count(text, "<bldg:Door "), 3u);
  EXPECT_EQ(count(text, "<core:ImplicitGeometry>"), 3u) << "the lamps on the walls";
  EXPECT_GT(count(text, "<gen:doubleAttribute name=\"reveal_depth\"><gen:value>0.15</gen:value>"), 3u);
  int solids = 0;
  for (const auto& solid : validators::read_citygml_text(text).solids) {
    if (solid.lod != 3) continue;
    std::vector<geometry::PolygonRings> polygons;
    for (const auto& p : solid.polygons) polygons.push_back(p.rings);
    EXPECT_EQ(geometry::validate_solid(polygons), "") << solid.id;
    ++solids;
  }
  EXPECT_EQ(solids, 3);
  CityGmlOptions full = lean_options();
  full.lean = false;
  EXPECT_LT(text.size(), write_citygml(s.region(), full).size() / 2);
  EXPECT_EQ(text, write_citygml(s.region(), lean_options()));
}

TEST(LeanCityGml, ValidatesAgainstTheSchema) {
  const std::filesystem::path schemas = std::filesystem::path(BLOCKRAND_SHARED_DIR) / "schemas";
  if (!std::filesystem::exists(schemas / "citygml2.xsd")) GTEST_SKIP() << "no CityGML schemas in " << schemas;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "blockrand_lean_schema";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.gml", std::ios::binary) << write_citygml(facade_region().region(), lean_options());
  const std::string command = "XML_CATALOG_FILES=" + (schemas / "catalog.xml").string() +
                              " xmllint --nonet --noout --schema " + (schemas / "citygml2.xsd").string() + " " +
                              (folder / "a.gml").string() + " > " + (folder / "log").string() + " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream log(folder / "log");
  EXPECT_EQ(status, 0) << log.rdbuf();
  std::filesystem::remove_all(folder);
}

/// Six faces of a box, in metres.
void add_box(std::vector<ElementPolygon>& polygons, std::array<double, 3> min, std::array<double, 3> max) {
  const auto at = [&](unsigned i) {
    ElementPoint p;
    for (unsigned k = 0; k < 3; ++k) p[k] = std::llround((i >> k & 1u ? max[k] : min[k]) * 1e4);
    return p;
  };
  for (const auto& [a, b, c, d] : {std::array{0u, 1u, 5u, 4u}, std::array{3u, 2u, 6u, 7u}, std::array{2u, 0u, 4u, 6u},
                                   std::array{1u, 3u, 7u, 5u}, std::array{0u, 2u, 3u, 1u}, std::array{4u, 5u, 7u, 6u}})
    polygons.push_back({{}, {{at(a), at(b), at(c), at(d)}}});
}

TEST(LeanElement, ModillionsGoAndTheCorniceStays) {
  std::vector<ElementPolygon> cornice;
  add_box(cornice, {-5, -0.4, 0.5}, {5, 0, 0.8});
  for (int i = -9; i < 10; ++i) add_box(cornice, {i * 0.5 - 0.1, -0.3, 0.2}, {i * 0.5 + 0.1, 0, 0.49});
  const auto lean = without_small_pieces(cornice);
  ASSERT_EQ(lean.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(lean[i].rings, cornice[i].rings);
}

TEST(LeanElement, ARowOfStonesIsOneStrip) {
  std::vector<ElementPolygon> quoin;
  for (int i = 0; i < 20; ++i) add_box(quoin, {0, -0.04, i * 0.4}, {i % 2 ? 0.4 : 0.65, 0, i * 0.4 + 0.38});
  const auto lean = without_small_pieces(quoin);
  ASSERT_EQ(lean.size(), 6u);
  ElementPoint min = lean[0].rings[0][0], max = min;
  for (const ElementPolygon& p : lean)
    for (const ElementPoint& q : p.rings[0])
      for (std::size_t k = 0; k < 3; ++k) min[k] = std::min(min[k], q[k]), max[k] = std::max(max[k], q[k]);
  EXPECT_EQ(min, (ElementPoint{0, -400, 0}));
  EXPECT_EQ(max, (ElementPoint{6500, 0, 79800}));
}

TEST(LeanElement, WhatIsOnePieceOrHasLargeOnesStays) {
  std::vector<ElementPolygon> lamp;
  add_box(lamp, {0, 0, 0}, {0.2, 0.2, 0.2});
  EXPECT_EQ(without_small_pieces(lamp).size(), 6u);
  std::vector<ElementPolygon> bars;  // a grille: bars of a metre
  for (int i = 0; i < 8; ++i) add_box(bars, {i * 0.1, 0, 0}, {i * 0.1 + 0.02, 0.02, 1});
  EXPECT_EQ(without_small_pieces(bars).size(), 48u);
}

}  // namespace
}  // namespace blockrand::outputs
