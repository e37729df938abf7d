// Lean CityGML: openings in the plane of their walls, ornaments without small pieces.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/outputs/citygml/flat_openings.h"
#include "pipeline/outputs/citygml/lean_element.h"
#include "tests/unit/outputs/citygml_support.h"
#include "tests/unit/outputs/facade_region.h"

namespace blockrand::outputs {
namespace {

using test::facade_region;
using test::gml_options;
using test::SampleRegion;
using test::times;
using test::validity;

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

/// A box of 14 x 10 x 9 m with windows of these reveals in its first wall, as far as they fit, and a passage from the
/// second wall to the fourth.
facades::OpenedSolid box_with(const std::vector<double>& reveals) {
  SampleRegion s;
  auto& b = s.add_building(100, {{"building", "yes"}});
  s.add_box(b, b.id(), 391000, 5819000, 14, 10, 35, 9);
  const model::Solid& solid = s.region().buildings.front().parts.front().lod2;
  std::vector<facades::WallFrame> walls;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
    if (auto wall = facades::wall_frame(solid, f)) walls.push_back(std::move(*wall));
  std::vector<facades::WallOpening> wanted;
  const auto add = [&](std::uint32_t wall, model::OpeningKind kind, double x, double y, double width, double height) {
    facades::WallOpening o;
    o.wall = wall;
    o.kind = kind;
    o.outline = {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
    wanted.push_back(o);
  };
  for (std::size_t i = 0; i < reveals.size(); ++i) {
    add(0, model::OpeningKind::window, 0.5 + 1.3 * static_cast<double>(i), 4, 0.9, 1.6);
    wanted.back().reveal = reveals[i];
  }
  for (const std::uint32_t wall : {1u, 3u}) {
    add(wall, model::OpeningKind::passage, walls[wall].length / 2 - 1.5, 0.1, 3, 3);
    wanted.back().through = static_cast<std::uint32_t>(reveals.size()) + (wall == 1 ? 1 : 0);
  }
  return facades::cut_openings(solid, walls, wanted);
}

TEST(FlatOpenings, OddDepthsAndPassages) {
  const std::vector<double> reveals{0, 0.004, 0.0101, 0.0777, 0.31, 0.31, 1.2345};
  facades::OpenedSolid opened = box_with(reveals);
  for (const facades::OpeningRefusal refusal : opened.refusals) ASSERT_EQ(name(refusal), "none");
  model::Detail detail;
  detail.solid = std::move(opened.solid);
  detail.openings = std::move(opened.openings);
  ASSERT_EQ(geometry::check_solid(detail.solid).text(), "none");
  const FlatOpenings flat = flat_openings(detail);
  EXPECT_EQ(geometry::check_solid(flat.detail.solid).text(), "none");
  std::size_t tunnels = 0, left = 0;
  for (std::size_t o = 0; o < detail.openings.size(); ++o) {
    const model::Opening &was = detail.openings[o], &is = flat.detail.openings[o];
    if (was.kind == model::OpeningKind::passage) {
      EXPECT_EQ(flat.depth[o], 0);
      EXPECT_EQ(is.reveal_count, was.reveal_count) << "tunnels stay";
      for (std::uint32_t r = 0; r < was.reveal_count; ++r) {
        const auto before = detail.solid.loops_of(detail.solid.faces[was.first_reveal + r]),
                   after = flat.detail.solid.loops_of(flat.detail.solid.faces[is.first_reveal + r]);
        ASSERT_EQ(before.size(), after.size());
        EXPECT_TRUE(std::ranges::equal(detail.solid.indices_of(before[0]), flat.detail.solid.indices_of(after[0])));
      }
      tunnels += was.reveal_count;
    } else {
      const double depth = reveals[o] < facades::kLeastReveal ? 0 : reveals[o];
      EXPECT_NEAR(flat.depth[o], depth, 0.001) << "rounded to the grid once";
      EXPECT_EQ(is.reveal_count, 0u);
      left += was.reveal_count;
    }
  }
  EXPECT_GE(tunnels, 4u);
  EXPECT_EQ(left, 4 * 5u) << "four walls of each that is not flush";
  EXPECT_EQ(flat.detail.solid.faces.size() + left, detail.solid.faces.size());
  const auto usual = usual_depths(flat);
  EXPECT_EQ(usual[flat.detail.openings[0].wall], 0) << "of equally many the least";
}

TEST(LeanCityGml, SolidsAreSoundAndOpeningsStay) {
  const auto s = facade_region();
  const std::string text = write_citygml(s.region(), gml_options(true));
  std::size_t openings = 0;
  for (const auto& b : s.region().buildings)
    for (const auto& part : b.parts) openings += part.lod3.openings.size();
  EXPECT_EQ(times(text, "<bldg:opening>"), openings);
  EXPECT_EQ(times(text, "<bldg:Door "), 3u);
  EXPECT_EQ(times(text, "<core:ImplicitGeometry>"), 3u) << "the lamps on the walls";
  EXPECT_GT(times(text, "<gen:doubleAttribute name=\"reveal_depth\"><gen:value>0.15</gen:value>"), 3u);
  int solids = 0;
  for (const auto& solid : validators::read_citygml_text(text).solids) {
    if (solid.lod != 3) continue;
    EXPECT_EQ(validity(solid), "") << solid.id;
    ++solids;
  }
  EXPECT_EQ(solids, 3);
  EXPECT_LT(text.size(), write_citygml(s.region(), gml_options(false)).size() / 2);
  EXPECT_EQ(text, write_citygml(s.region(), gml_options(true)));
}

TEST(LeanCityGml, ValidatesAgainstTheSchema) {
  if (!std::filesystem::exists(test::citygml_schemas() / "citygml2.xsd"))
    GTEST_SKIP() << "no CityGML schemas in " << test::citygml_schemas();
  EXPECT_EQ(
      test::schema_complaints(write_citygml(facade_region().region(), gml_options(true)), "blockrand_lean_schema"), "");
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
