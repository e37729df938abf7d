#include "pipeline/outputs/element_polygons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "pipeline/model/element.h"

namespace blockrand::outputs {
namespace {

using model::ElementPart;
using model::Point3;

/// An element of faces; every part has a colour of its own.
struct Shape {
  void face(const std::vector<Point3>& corners, ElementPart part = ElementPart::frame) {
    model::ElementFace f;
    f.first = static_cast<std::uint32_t>(mesh.indices.size());
    f.count = static_cast<std::uint32_t>(corners.size());
    f.part = part;
    for (const Point3& p : corners) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(p);
    }
    mesh.faces.push_back(f);
  }
  /// In the wall's plane, from one corner to the other.
  void upright(double x0, double y0, double x1, double y1, ElementPart part = ElementPart::frame) {
    face({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, part);
  }
  std::vector<ElementPolygon> polygons() const {
    model::ColouredElement coloured;
    auto element = std::make_shared<model::Element>();
    element->mesh = mesh;
    coloured.element = element;
    for (std::size_t i = 0; i < coloured.materials.size(); ++i)
      coloured.materials[i].colour.r = static_cast<std::uint8_t>(i);
    return element_polygons(coloured);
  }
  model::ElementMesh mesh;
};

/// Square metres, holes taken off.
double area(const ElementPolygon& polygon) {
  double x = 0, y = 0, z = 0;
  for (const auto& ring : polygon.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const ElementPoint &p = ring[i], &q = ring[(i + 1) % ring.size()];
      const auto of = [&](std::size_t a, std::size_t b) {
        return static_cast<double>(p[a] * q[b] - p[b] * q[a]) / 2e8;
      };
      x += of(1, 2), y += of(2, 0), z += of(0, 1);
    }
  return std::sqrt(x * x + y * y + z * z);
}

TEST(ElementPolygons, FourBarsAreAFrameWithAHole) {
  Shape s;
  s.upright(0, 0, 0.1, 2), s.upright(0.9, 0, 1, 2);
  // Bars between the posts end where these have no corner: joined only where whole edges meet.
  s.upright(0.1, 0, 0.9, 0.1), s.upright(0.1, 1.9, 0.9, 2);
  EXPECT_EQ(s.polygons().size(), 4u);

  Shape mitred;
  mitred.face({{0, 0, 0}, {1, 0, 0}, {0.9, 0.1, 0}, {0.1, 0.1, 0}});
  mitred.face({{1, 0, 0}, {1, 2, 0}, {0.9, 1.9, 0}, {0.9, 0.1, 0}});
  mitred.face({{1, 2, 0}, {0, 2, 0}, {0.1, 1.9, 0}, {0.9, 1.9, 0}});
  mitred.face({{0, 2, 0}, {0, 0, 0}, {0.1, 0.1, 0}, {0.1, 1.9, 0}});
  const auto joined = mitred.polygons();
  ASSERT_EQ(joined.size(), 1u);
  ASSERT_EQ(joined[0].rings.size(), 2u);
  EXPECT_EQ(joined[0].rings[0].size(), 4u);
  EXPECT_EQ(joined[0].rings[1].size(), 4u);
  EXPECT_NEAR(area(joined[0]), 2 - 0.8 * 1.8, 1e-9);
}

TEST(ElementPolygons, OtherLooksAndOtherPlanesStayApart) {
  Shape s;
  s.upright(0, 0, 1, 1);
  s.upright(0, 1, 1, 2, ElementPart::glass);
  s.face({{1, 0, 0}, {2, 0, -0.001}, {2, 1, -0.001}, {1, 1, 0}});  // a millimetre on a metre
  EXPECT_EQ(s.polygons().size(), 3u);
}

TEST(ElementPolygons, AFineArcStaysRound) {
  // A quarter of a circle in steps that bend by less than a twentieth of a millimetre, and what stands above it.
  Shape s;
  constexpr int kPoints = 400;
  constexpr double kRadius = 0.5, kQuarter = 1.5707963267948966;
  std::vector<Point3> fan{{0, 0, 0}}, above{{kRadius, kRadius, 0}};
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = kQuarter * i / kPoints;
    fan.push_back({kRadius * std::cos(angle), kRadius * std::sin(angle), 0});
  }
  above.insert(above.end(), fan.rbegin(), fan.rend() - 1);
  s.face(fan), s.face(above, ElementPart::glass);
  const auto polygons = s.polygons();
  ASSERT_EQ(polygons.size(), 2u);
  EXPECT_NEAR(area(polygons[0]), kQuarter / 2 * kRadius * kRadius, 1e-4);
  EXPECT_NEAR(area(polygons[0]) + area(polygons[1]), kRadius * kRadius, 1e-9) << "both have the same points";
  EXPECT_LT(polygons[0].rings[0].size(), 100u);
}

TEST(ElementPolygons, StraightPointsGoOnlyWhereNothingHasACorner) {
  Shape s;
  s.upright(0, 0, 1, 1), s.upright(1, 0, 2, 1);
  auto joined = s.polygons();
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_EQ(joined[0].rings[0].size(), 4u);
  // The face below has a corner in the middle of the upper one's edge.
  s.face({{0, 0, 0}, {0, 0, -1}, {1, 0, -1}, {1, 0, 0}});
  s.face({{1, 0, 0}, {1, 0, -1}, {2, -0.5, -1}, {2, -0.5, 0}}, ElementPart::sill);
  joined = s.polygons();
  ASSERT_EQ(joined.size(), 3u);
  EXPECT_EQ(joined[0].rings[0].size(), 5u);
}

TEST(ElementPolygons, RingsThatWouldMeetInAPointStayFaces) {
  Shape s;  // around a cross of four holes' corners: two faces that touch in a point, joined by two others
  s.upright(0, 0, 1, 1), s.upright(1, 0, 2, 1), s.upright(0, 1, 1, 2), s.upright(2, 1, 3, 2), s.upright(1, 2, 2, 3),
      s.upright(2, 0, 3, 1), s.upright(0, 2, 1, 3), s.upright(2, 2, 3, 3);
  auto joined = s.polygons();
  ASSERT_EQ(joined.size(), 1u) << "a ring of eight squares";
  EXPECT_EQ(joined[0].rings.size(), 2u);
  Shape bow;
  bow.upright(0, 0, 1, 1), bow.upright(1, 0, 2, 1), bow.upright(0, 1, 1, 2), bow.upright(2, 1, 3, 2),
      bow.upright(2, 0, 3, 1), bow.upright(1, 2, 2, 3), bow.upright(0, 2, 1, 3);
  joined = bow.polygons();
  double sum = 0;
  for (const ElementPolygon& p : joined) sum += area(p);
  EXPECT_NEAR(sum, 7, 1e-9);
  for (const ElementPolygon& p : joined)
    for (const auto& ring : p.rings) EXPECT_EQ(std::set(ring.begin(), ring.end()).size(), ring.size());
}

/// An edge that two faces share is still shared by two polygons, whatever was joined.
TEST(ElementPolygons, ClosedShapesStayClosed) {
  Shape s;  // a bar of three pieces with caps of two triangles
  const double x[] = {0, 1, 2, 3};
  for (int i = 0; i < 3; ++i) {
    s.face({{x[i], 0, 1}, {x[i + 1], 0, 1}, {x[i + 1], 1, 1}, {x[i], 1, 1}});
    s.face({{x[i + 1], 0, 0}, {x[i], 0, 0}, {x[i], 1, 0}, {x[i + 1], 1, 0}});
    s.face({{x[i], 1, 1}, {x[i + 1], 1, 1}, {x[i + 1], 1, 0}, {x[i], 1, 0}});
    s.face({{x[i], 0, 0}, {x[i + 1], 0, 0}, {x[i + 1], 0, 1}, {x[i], 0, 1}});
  }
  s.face({{0, 0, 0}, {0, 0, 1}, {0, 1, 1}}), s.face({{0, 1, 1}, {0, 1, 0}, {0, 0, 0}});
  s.face({{3, 0, 1}, {3, 0, 0}, {3, 1, 0}}), s.face({{3, 1, 0}, {3, 1, 1}, {3, 0, 1}});
  const auto joined = s.polygons();
  EXPECT_EQ(joined.size(), 6u);
  std::map<std::pair<ElementPoint, ElementPoint>, int> edges;
  double sum = 0;
  for (const ElementPolygon& p : joined) {
    EXPECT_EQ(p.rings.size(), 1u);
    EXPECT_EQ(p.rings[0].size(), 4u);
    sum += area(p);
    for (const auto& ring : p.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) ++edges[{ring[i], ring[(i + 1) % ring.size()]}];
  }
  EXPECT_NEAR(sum, 14, 1e-9);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

}  // namespace
}  // namespace blockrand::outputs
