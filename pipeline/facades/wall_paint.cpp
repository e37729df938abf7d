#include "pipeline/facades/wall_paint.h"

#include <algorithm>

#include "pipeline/geometry/valid_polygon.h"
#include "styles/grammar/shapes/mesh_triangles.h"

namespace blockrand::facades {
namespace {

using model::Point2;

/// m between layers: nothing flickers (docs/elements.md). The lowest is left to faces that rules paint.
constexpr double kLayer = 0.006;
/// m, of a painted wall: less is no wall.
constexpr double kLeast = 0.02;
/// m2, of a piece between openings.
constexpr double kLeastPiece = 0.001;
/// m beyond the wall, of the rectangles that cut the order's rectangle out of it.
constexpr double kBeyond = 10;

model::Polygon polygon(const std::vector<Point2>& points) {
  model::Polygon out;
  for (const Point2& p : points) out.outer.points.push_back(model::snap(p));
  out.outer.nodes.assign(points.size(), 0);
  return out;
}

model::Polygon rectangle(double left, double low, double right, double high) {
  return polygon({{left, low}, {right, low}, {right, high}, {left, high}});
}

}  // namespace

std::optional<WallPaint> wall_paint(const PaintOrder& order, const WallFrame& wall,
                                    std::span<const std::vector<Point2>> openings, int level) {
  if (order.right - order.left < kLeast || order.high - order.low < kLeast || wall.loops.empty()) return std::nullopt;
  const std::vector<model::Polygon> whole{polygon(wall.loops[0])};
  std::vector<model::Polygon> away;
  const double left = -kBeyond, right = wall.length + kBeyond, low = -kBeyond, high = wall.height + kBeyond;
  if (order.left > kLeast) away.push_back(rectangle(left, low, order.left, high));
  if (order.right < wall.length - kLeast) away.push_back(rectangle(order.right, low, right, high));
  if (order.low > kLeast) away.push_back(rectangle(left, low, right, order.low));
  if (order.high < wall.height - kLeast) away.push_back(rectangle(left, order.high, right, high));
  for (std::size_t i = 1; i < wall.loops.size(); ++i) {
    std::vector<Point2> hole(wall.loops[i].rbegin(), wall.loops[i].rend());
    away.push_back(polygon(hole));
  }
  for (const auto& opening : openings) away.push_back(polygon(opening));
  const auto left_over = geometry::difference(whole, away, kLeastPiece, kLayer);
  if (left_over.polygons.empty()) return std::nullopt;
  grammar::Mesh mesh;
  const auto add = [&](const model::Ring& ring, grammar::MeshFace& face) {
    auto& loop = face.loops.emplace_back();
    for (const Point2& p : ring.points) {
      loop.push_back({static_cast<std::uint32_t>(mesh.vertices.size()), 0});
      mesh.vertices.push_back({p.x - order.left, p.y - order.low, kLayer * (2 + level)});
    }
  };
  for (const model::Polygon& p : left_over.polygons) {
    grammar::MeshFace face;
    add(p.outer, face);
    for (const model::Ring& hole : p.holes) add(hole, face);
    mesh.faces.push_back(std::move(face));
  }
  WallPaint out;
  out.at = {order.left, order.low};
  out.element.name = order.name;
  out.element.kind = kWallPaint;
  for (const grammar::Vector3& v : mesh.vertices)
    out.element.mesh.vertices.push_back(model::snap(model::Point3{v.x, v.y, v.z}));
  for (const grammar::MeshTriangle& t : grammar::triangles_of(mesh)) {
    model::ElementMesh& m = out.element.mesh;
    m.faces.push_back({static_cast<std::uint32_t>(m.indices.size()), 3, model::ElementPart::wall});
    m.indices.insert(m.indices.end(), t.vertices.begin(), t.vertices.end());
  }
  if (out.element.mesh.faces.empty()) return std::nullopt;
  return out;
}

}  // namespace blockrand::facades
