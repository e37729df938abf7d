#include "pipeline/geometry/planar_faces.h"

#include <geos_c.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/segment_grid.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using ::testing::ElementsAre;

/// Somewhere in UTM zone 33, so that tests run on coordinates of the usual size.
constexpr Point2 kPlace{391000, 5820000};

DividingLine line(std::uint64_t id, std::vector<Point2> points) {
  for (Point2& p : points) p = model::snap(Point2{p.x + kPlace.x, p.y + kPlace.y});
  return {id, std::move(points), {}};
}

DividingLine square(std::uint64_t id, double x, double y, double side) {
  return line(id, {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}, {x, y}});
}

std::vector<double> areas(const std::vector<Face>& faces) {
  std::vector<double> out;
  for (const Face& f : faces) out.push_back(area(f.polygon));
  return out;
}

/// A tangle: long lines and short ones that cross anywhere, some of them blind.
std::vector<DividingLine> tangle(unsigned seed, int count, double size) {
  std::mt19937 random(seed);
  const auto draw = [&](double from, double to) { return from + (to - from) * (random() / 4294967296.0); };
  std::vector<DividingLine> out;
  for (int i = 0; i < count; ++i) {
    std::vector<Point2> points{{draw(0, size), draw(0, size)}};
    const int pieces = 1 + static_cast<int>(random() % 4);
    for (int k = 0; k < pieces; ++k)
      points.push_back({points.back().x + draw(-0.3, 0.3) * size, points.back().y + draw(-0.3, 0.3) * size});
    out.push_back(line(static_cast<std::uint64_t>(i + 1), points));
  }
  return out;
}

void expect_same_polygons(const std::vector<Face>& a, const std::vector<Face>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].polygon.outer.points, b[i].polygon.outer.points);
    ASSERT_EQ(a[i].polygon.holes.size(), b[i].polygon.holes.size());
    for (std::size_t h = 0; h < a[i].polygon.holes.size(); ++h)
      EXPECT_EQ(a[i].polygon.holes[h].points, b[i].polygon.holes[h].points);
  }
}

TEST(FacesOfLines, CrossingLinesQuarterASquare) {
  const auto faces = faces_of_lines(
      std::vector{square(1, 0, 0, 100), line(2, {{50, -10}, {50, 110}}), line(3, {{-10, 30}, {110, 30}})});
  EXPECT_THAT(areas(faces), ElementsAre(1500, 3500, 1500, 3500));
  // Canonical: from the least corner, counter-clockwise.
  EXPECT_THAT(faces[0].polygon.outer.points,
              ElementsAre(kPlace, Point2{kPlace.x + 50, kPlace.y}, Point2{kPlace.x + 50, kPlace.y + 30},
                          Point2{kPlace.x, kPlace.y + 30}));
}

TEST(FacesOfLines, KnowWhatBoundsThemAndOnWhichSideTheyLie) {
  const auto faces = faces_of_lines(std::vector{square(7, 0, 0, 100), line(2, {{50, -10}, {50, 110}})});
  ASSERT_EQ(faces.size(), 2u);
  const Face& west = faces[0];
  ASSERT_EQ(west.lines.size(), 2u);
  EXPECT_EQ(west.lines[0].id, 2u);
  EXPECT_DOUBLE_EQ(west.lines[0].left, 100);
  EXPECT_DOUBLE_EQ(west.lines[0].right, 0);
  EXPECT_EQ(west.lines[1].id, 7u);
  EXPECT_DOUBLE_EQ(west.lines[1].left, 200);
  EXPECT_DOUBLE_EQ(faces[1].lines[0].right, 100);
  ASSERT_EQ(west.edges.size(), 4u);
  EXPECT_EQ(west.edges[0].line, 7u);
  EXPECT_EQ(west.edges[1].line, 2u);
  EXPECT_TRUE(west.edges[1].left);
}

TEST(FacesOfLines, BlindEndsAndConnectionsBoundNothing) {
  const auto faces = faces_of_lines(std::vector{square(1, 0, 0, 100), square(2, 200, 0, 50),
                                                line(3, {{100, 20}, {200, 20}}),         // joins the squares
                                                line(4, {{0, 50}, {40, 50}, {60, 60}}),  // ends inside
                                                line(5, {{300, 300}, {400, 300}})});
  EXPECT_THAT(areas(faces), ElementsAre(10000, 2500));
  EXPECT_THAT(faces_of_lines(std::vector{line(1, {{0, 0}, {10, 0}, {10, 10}})}), ::testing::IsEmpty());
  EXPECT_THAT(faces_of_lines({}), ::testing::IsEmpty());
}

TEST(FacesOfLines, AnIslandIsAHoleWhetherItHangsOnAStreetOrNot) {
  for (const bool hanging : {false, true}) {
    std::vector lines{square(1, 0, 0, 100), square(2, 40, 40, 20)};
    if (hanging) lines.push_back(line(3, {{0, 50}, {40, 50}}));
    const auto faces = faces_of_lines(lines);
    EXPECT_THAT(areas(faces), ElementsAre(9600, 400));
    ASSERT_EQ(faces[0].polygon.holes.size(), 1u);
    EXPECT_LT(signed_area(faces[0].polygon.holes[0].points), 0);
    EXPECT_EQ(faces[0].edges.size(), faces[0].polygon.outer.size() + faces[0].polygon.holes[0].size());
    EXPECT_EQ(faces[0].edges.back().line, 2u);
    EXPECT_FALSE(faces[0].edges.back().left) << "outside a counter-clockwise square is its right";
  }
}

TEST(FacesOfLines, LinesThatRunTogetherBothBound) {
  const auto faces = faces_of_lines(
      std::vector{square(5, 0, 0, 100), line(3, {{100, 20}, {100, 80}}), line(9, {{100, 120}, {100, 50}})});
  ASSERT_EQ(faces.size(), 1u);
  ASSERT_EQ(faces[0].lines.size(), 3u);
  EXPECT_DOUBLE_EQ(faces[0].lines[0].left, 60);
  EXPECT_DOUBLE_EQ(faces[0].lines[1].left, 400);
  EXPECT_EQ(faces[0].lines[2].id, 9u);
  EXPECT_DOUBLE_EQ(faces[0].lines[2].right, 50);
}

TEST(FacesOfLines, NodesComeBackToTheirPoints) {
  DividingLine ring = square(1, 0, 0, 100);
  ring.nodes = {11, 12, 13, 14, 11};
  DividingLine cross = line(2, {{50, 0}, {50, 100}});
  cross.nodes = {21, 22};
  const auto faces = faces_of_lines(std::vector{ring, cross});
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_THAT(faces[0].polygon.outer.nodes, ElementsAre(11, 21, 22, 14));
  const auto without = faces_of_lines(std::vector{ring, line(2, {{50, -1}, {50, 101}})});
  EXPECT_THAT(without[0].polygon.outer.nodes, ElementsAre(11, 0, 0, 14)) << "a crossing without a node";
}

TEST(FacesOfLines, CrossingsAreRoundedToTheGridAndNothingIsLost) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    auto lines = tangle(seed, 60, 200);
    lines.push_back(square(1000, -100, -100, 400));
    const auto faces = faces_of_lines(lines);
    ASSERT_GT(faces.size(), 100u);
    double sum = 0, borders = 0, around = 0;
    for (const Face& face : faces) {
      sum += area(face.polygon);
      around += perimeter(face.polygon);
      for (const BorderLine& b : face.lines) borders += b.left + b.right;
      for (const Point2 p : face.polygon.outer.points) EXPECT_EQ(p, model::snap(p));
      for (const FaceEdge& e : face.edges) EXPECT_NE(e.line, kNoLine);
      EXPECT_TRUE(contains(face.polygon, inner_point(face.polygon)));
    }
    EXPECT_NEAR(sum, 160000, 1e-6) << "the faces fill the frame";
    EXPECT_GE(borders, around * (1 - 1e-12)) << "every edge has a line";
    EXPECT_LE(borders, around + 0.1) << "and but for millimetres only one";
  }
}

TEST(FacesOfLines, OrderDirectionAndCutsOfTheLinesDoNotMatter) {
  for (unsigned seed = 11; seed <= 15; ++seed) {
    const auto lines = tangle(seed, 60, 200);
    const auto faces = faces_of_lines(lines);
    std::mt19937 random(seed);
    auto other = lines;
    std::shuffle(other.begin(), other.end(), random);
    for (DividingLine& l : other)
      if (random() % 2) std::reverse(l.points.begin(), l.points.end());
    std::vector<DividingLine> cut;
    for (const DividingLine& l : other)
      for (std::size_t i = 1; i < l.points.size(); ++i) cut.push_back({l.id, {l.points[i - 1], l.points[i]}, {}});
    for (const auto& variant : {other, cut}) {
      const auto again = faces_of_lines(variant);
      expect_same_polygons(faces, again);
      for (std::size_t i = 0; i < faces.size() && i < again.size(); ++i) {
        ASSERT_EQ(faces[i].lines.size(), again[i].lines.size());
        for (std::size_t k = 0; k < faces[i].lines.size(); ++k) {
          EXPECT_EQ(faces[i].lines[k].id, again[i].lines[k].id);
          EXPECT_DOUBLE_EQ(faces[i].lines[k].left + faces[i].lines[k].right,
                           again[i].lines[k].left + again[i].lines[k].right);
        }
      }
    }
  }
}

TEST(FacesOfLines, AFaceDependsOnLinesThatComeIntoItsBoxOnly) {
  const auto lines = tangle(21, 80, 300);
  const auto faces = faces_of_lines(lines);
  ASSERT_GT(faces.size(), 100u);
  for (std::size_t f = 0; f < faces.size(); f += 7) {
    Point2 low = faces[f].polygon.outer.points[0], high = low;
    for (const Point2 p : faces[f].polygon.outer.points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    std::vector<DividingLine> near;
    for (const DividingLine& l : lines)
      for (std::size_t i = 1; i < l.points.size(); ++i) {
        const Point2 a = l.points[i - 1], b = l.points[i];
        constexpr double kStep = 1.0 / model::kGridStepsPerMetre;
        if (std::max(a.x, b.x) < low.x - kStep || std::min(a.x, b.x) > high.x + kStep ||
            std::max(a.y, b.y) < low.y - kStep || std::min(a.y, b.y) > high.y + kStep)
          continue;
        near.push_back({l.id, {a, b}, {}});
      }
    ASSERT_LT(near.size(), 230u);
    const auto alone = faces_of_lines(near);
    const auto same = std::find_if(alone.begin(), alone.end(), [&](const Face& other) {
      return other.polygon.outer.points == faces[f].polygon.outer.points &&
             other.polygon.holes.size() == faces[f].polygon.holes.size();
    });
    EXPECT_NE(same, alone.end()) << "face " << f;
  }
}

TEST(SegmentGrid, FindsWhatComesNearAndNotTheRest) {
  std::vector<Segment> segments;
  for (const DividingLine& l : tangle(3, 100, 500))
    for (std::size_t i = 1; i < l.points.size(); ++i) segments.push_back({l.points[i - 1], l.points[i]});
  segments.push_back({{kPlace.x, kPlace.y}, {kPlace.x, kPlace.y + 400}});                // upright
  segments.push_back({{kPlace.x - 5, kPlace.y + 64}, {kPlace.x + 900, kPlace.y + 64}});  // along a cell border
  const SegmentGrid grid(segments, 32);
  std::vector<std::uint32_t> found;
  std::size_t visited = 0;
  for (double x = 0; x < 500; x += 37)
    for (double y = 0; y < 500; y += 41) {
      const Point2 p{kPlace.x + x, kPlace.y + y};
      grid.near({p.x - 3, p.y - 3}, {p.x + 3, p.y + 3}, found);
      visited += found.size();
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      for (std::uint32_t i = 0; i < segments.size(); ++i)
        EXPECT_TRUE(distance_to_segment(p, segments[i].a, segments[i].b) > 3 ||
                    std::binary_search(found.begin(), found.end(), i))
            << i;
    }
  EXPECT_LT(visited, segments.size() * 13 * 14 / 4);
}

// ---- GEOS's polygonizer as the oracle

std::vector<Point2> ring_of(GEOSContextHandle_t geos, const GEOSGeometry* ring, bool counter_clockwise) {
  std::vector<Point2> out;
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(geos, ring);
  unsigned n = 0;
  GEOSCoordSeq_getSize_r(geos, sequence, &n);
  for (unsigned i = 0; i + 1 < n; ++i) {
    Point2 p;
    GEOSCoordSeq_getXY_r(geos, sequence, i, &p.x, &p.y);
    out.push_back(p);
  }
  if ((signed_area(out) > 0) != counter_clockwise) std::reverse(out.begin(), out.end());
  std::rotate(out.begin(), std::min_element(out.begin(), out.end()), out.end());
  return out;
}

using Rings = std::vector<std::vector<Point2>>;  // outer ring, then holes in order

std::vector<Rings> faces_by_geos(const std::vector<DividingLine>& lines) {
  GEOSContextHandle_t geos = GEOS_init_r();
  std::vector<GEOSGeometry*> parts;
  const auto edges = noded_edges(lines);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i].a == edges[i - 1].a && edges[i].b == edges[i - 1].b) continue;
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(geos, 2, 2);
    GEOSCoordSeq_setXY_r(geos, sequence, 0, edges[i].a.x, edges[i].a.y);
    GEOSCoordSeq_setXY_r(geos, sequence, 1, edges[i].b.x, edges[i].b.y);
    parts.push_back(GEOSGeom_createLineString_r(geos, sequence));
  }
  GEOSGeometry* all =
      GEOSGeom_createCollection_r(geos, GEOS_MULTILINESTRING, parts.data(), static_cast<unsigned>(parts.size()));
  const GEOSGeometry* const input[] = {all};
  GEOSGeometry* faces = GEOSPolygonize_r(geos, input, 1);
  std::vector<Rings> out;
  for (int i = 0; i < GEOSGetNumGeometries_r(geos, faces); ++i) {
    const GEOSGeometry* g = GEOSGetGeometryN_r(geos, faces, i);
    Rings rings;
    for (int h = 0; h < GEOSGetNumInteriorRings_r(geos, g); ++h)
      rings.push_back(ring_of(geos, GEOSGetInteriorRingN_r(geos, g, h), false));
    std::sort(rings.begin(), rings.end());
    rings.insert(rings.begin(), ring_of(geos, GEOSGetExteriorRing_r(geos, g), true));
    out.push_back(std::move(rings));
  }
  std::sort(out.begin(), out.end());
  GEOSGeom_destroy_r(geos, faces);
  GEOSGeom_destroy_r(geos, all);
  GEOS_finish_r(geos);
  return out;
}

TEST(FacesOfLines, AreThoseOfGeos) {
  for (unsigned seed = 100; seed < 160; ++seed) {
    std::mt19937 random(seed);
    // Sparse ones have bridges, dead ends and islands; dense ones many crossings. Squares on whole metres touch in corners.
    auto lines = tangle(seed, 2 + static_cast<int>(seed % 30) * 2, 200);
    for (int i = 0; i < 25; ++i)
      lines.push_back(square(2000 + static_cast<std::uint64_t>(i), 10.0 * static_cast<double>(random() % 25),
                             10.0 * static_cast<double>(random() % 25), 10.0 * static_cast<double>(1 + random() % 3)));
    std::vector<Rings> ours;
    for (const Face& face : faces_of_lines(lines)) {
      Rings rings{face.polygon.outer.points};
      for (const auto& hole : face.polygon.holes) rings.push_back(hole.points);
      ours.push_back(std::move(rings));
    }
    std::sort(ours.begin(), ours.end());
    EXPECT_EQ(ours, faces_by_geos(lines)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace blockrand::geometry
