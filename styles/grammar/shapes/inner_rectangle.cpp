// The largest rectangle inside a face.
#include <algorithm>
#include <cmath>

#include "styles/grammar/shapes/mesh_cut.h"
#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operation_list.h"
#include "styles/grammar/shapes/pieces.h"

namespace blockrand::grammar {

namespace {

struct FlatRectangle {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  double area() const { return std::max(0.0, x1 - x0) * std::max(0.0, y1 - y0); }
};

using Rings = std::vector<std::vector<Vector2>>;

bool inside(const Rings& rings, Vector2 p) {
  bool in = false;
  for (const auto& ring : rings)
    for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
      const Vector2 a = ring[i], b = ring[k];
      if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
    }
  return in;
}

/// No edge runs through the inside of the rectangle, and its middle is inside.
bool fits(const Rings& rings, const FlatRectangle& r) {
  constexpr double kTouch = 1e-9;
  const double x0 = r.x0 + kTouch, x1 = r.x1 - kTouch, y0 = r.y0 + kTouch, y1 = r.y1 - kTouch;
  if (x0 >= x1 || y0 >= y1) return false;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      // Clip the edge to the rectangle (Liang and Barsky).
      const Vector2 a = ring[i], b = ring[(i + 1) % ring.size()];
      double t0 = 0, t1 = 1;
      const double dx = b.x - a.x, dy = b.y - a.y;
      bool out = false;
      for (const auto& [p, q] : {std::pair{-dx, a.x - x0}, {dx, x1 - a.x}, {-dy, a.y - y0}, {dy, y1 - a.y}}) {
        if (p == 0) {
          out |= q <= 0;
        } else if (p < 0) {
          t0 = std::max(t0, q / p);
        } else {
          t1 = std::min(t1, q / p);
        }
      }
      if (!out && t0 < t1) return false;
    }
  return inside(rings, {(r.x0 + r.x1) / 2, (r.y0 + r.y1) / 2});
}

/// How far a side can go outwards, by halving.
void grow(const Rings& rings, FlatRectangle& r, double reach) {
  double FlatRectangle::*const sides[]{&FlatRectangle::x0, &FlatRectangle::x1, &FlatRectangle::y0, &FlatRectangle::y1};
  for (int round = 0; round < 2; ++round)
    for (int s = 0; s < 4; ++s) {
      const double way = s % 2 == 0 ? -1 : 1;
      double low = 0, high = reach;
      for (int i = 0; i < 40; ++i) {
        FlatRectangle wider = r;
        wider.*sides[s] += way * (low + high) / 2;
        (fits(rings, wider) ? low : high) = (low + high) / 2;
      }
      if (low > 1e-7) r.*sides[s] += way * low;
    }
}

void add_unique(std::vector<double>& list, double value) { list.push_back(value); }
void sort_unique(std::vector<double>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end(), [](double a, double b) { return b - a < 1e-6; }), list.end());
}

/// Over the cells of a raster through all corners (and evenly spaced lines where edges lean): the largest block of
/// cells that are inside, then grown to touch. Exact where all edges are along the axes.
FlatRectangle largest(const Rings& rings) {
  std::vector<double> xs, ys;
  bool leaning = false;
  Vector2 middle{};
  double count = 0;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2 a = ring[i], b = ring[(i + 1) % ring.size()];
      leaning |= std::fabs(a.x - b.x) > 1e-6 && std::fabs(a.y - b.y) > 1e-6;
      add_unique(xs, a.x);
      add_unique(ys, a.y);
      middle = {middle.x + a.x, middle.y + a.y};
      ++count;
    }
  middle = {middle.x / count, middle.y / count};
  sort_unique(xs);
  sort_unique(ys);
  if (xs.size() < 2 || ys.size() < 2) return {};
  if (leaning) {
    constexpr int kLines = 24;
    const double x0 = xs.front(), x1 = xs.back(), y0 = ys.front(), y1 = ys.back();
    for (int i = 1; i < kLines; ++i) {
      add_unique(xs, x0 + (x1 - x0) * i / kLines);
      add_unique(ys, y0 + (y1 - y0) * i / kLines);
    }
    sort_unique(xs);
    sort_unique(ys);
  }
  constexpr std::size_t kMostLines = 160;
  const auto thin = [](std::vector<double>& list) {
    if (list.size() <= kMostLines) return;
    std::vector<double> kept;
    for (std::size_t i = 0; i < kMostLines; ++i) kept.push_back(list[i * (list.size() - 1) / (kMostLines - 1)]);
    list = std::move(kept);
  };
  thin(xs);
  thin(ys);
  const std::size_t columns = xs.size() - 1, rows = ys.size() - 1;
  std::vector<std::size_t> height(columns, 0);
  FlatRectangle best;
  double nearest = 0;
  const auto take = [&](const FlatRectangle& r) {
    const double dx = (r.x0 + r.x1) / 2 - middle.x, dy = (r.y0 + r.y1) / 2 - middle.y, away = dx * dx + dy * dy;
    const double tie = 1e-9 * std::max(1.0, best.area());
    if (r.area() > best.area() + tie || (r.area() > best.area() - tie && away < nearest - 1e-9)) {
      best = r;
      nearest = away;
    }
  };
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t c = 0; c < columns; ++c)
      height[c] = fits(rings, {xs[c], ys[row], xs[c + 1], ys[row + 1]}) ? height[c] + 1 : 0;
    for (std::size_t left = 0; left < columns; ++left) {
      std::size_t least = row + 1;
      for (std::size_t right = left; right < columns && height[right] > 0; ++right) {
        least = std::min(least, height[right]);
        take({xs[left], ys[row + 1 - least], xs[right + 1], ys[row + 1]});
      }
    }
  }
  if (best.area() > 0 && leaning) grow(rings, best, std::max(xs.back() - xs.front(), ys.back() - ys.front()));
  return best;
}

struct Found {
  Frame frame;  ///< x and y of the rectangle, z the normal
  FlatRectangle rectangle;
};

Found in_frame(const Mesh& mesh, const MeshFace& face, const Frame& frame) {
  Rings rings;
  for (const Loop& loop : face.loops) {
    rings.emplace_back();
    for (const Corner c : loop) {
      const Vector3 p = place_back(frame, mesh.vertices[c.vertex]);
      rings.back().push_back({p.x, p.y});
    }
  }
  return {frame, largest(rings)};
}

/// The largest rectangle of a face: along the scope's axes, or along one of its longer edges.
Found largest_of(const Mesh& mesh, const MeshFace& face, bool by_edge) {
  const Vector3 normal = face_normal(mesh, face);
  if (normal == Vector3{}) return {};
  const Vector3 corner = mesh.vertices[face.loops[0][0].vertex];
  // The axis that lies most in the plane leads.
  if (!by_edge)
    return in_frame(mesh, face,
                    frame_with_z(corner, normal, std::fabs(normal.x) > 0.9 ? Vector3{0, 0, 1} : Vector3{1, 0, 0}));
  double longest = 0;
  const Loop& loop = face.loops[0];
  const auto edge = [&](std::size_t i) {
    return mesh.vertices[loop[(i + 1) % loop.size()].vertex] - mesh.vertices[loop[i].vertex];
  };
  for (std::size_t i = 0; i < loop.size(); ++i) longest = std::max(longest, length(edge(i)));
  Found best;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (length(edge(i)) < longest / 4) continue;
    const Found found = in_frame(mesh, face, frame_with_z(corner, normal, edge(i)));
    if (found.rectangle.area() > best.rectangle.area() * (1 + 1e-9)) best = found;
  }
  return best;
}

/// Corners of the rectangle, starting with the edge that runs as the face's first edge does.
Mesh rectangle_mesh(const Mesh& parent, const MeshFace& face, const Found& found) {
  const auto& r = found.rectangle;
  std::vector<Vector3> points{place(found.frame, {r.x0, r.y0, 0}), place(found.frame, {r.x1, r.y0, 0}),
                              place(found.frame, {r.x1, r.y1, 0}), place(found.frame, {r.x0, r.y1, 0})};
  const Loop& loop = face.loops[0];
  const Vector3 first = parent.vertices[loop[1].vertex] - parent.vertices[loop[0].vertex];
  std::size_t start = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (dot(normalized(points[(i + 1) % 4] - points[i]), first) >
        dot(normalized(points[(start + 1) % 4] - points[start]), first) + 1e-9)
      start = i;
  Mesh out;
  out.tag_sets = parent.tag_sets;
  MeshFace made;
  made.tags = face.tags;
  made.material = face.material;
  made.loops.emplace_back();
  for (std::uint32_t i = 0; i < 4; ++i) {
    out.vertices.push_back(points[(start + i) % 4]);
    made.loops[0].push_back({i, 0});
  }
  out.faces.push_back(std::move(made));
  return out;
}

}  // namespace

ShapeAndRemainder inner_rectangle_pieces(const Shape& shape, bool by_edge) {
  ShapeAndRemainder out;
  const Mesh& mesh = mesh_of(shape);
  const auto piece = [&](Mesh part) {
    Shape made = shape;
    made.size = {};
    take_mesh(made, std::move(part));
    return made;
  };
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const Found found = largest_of(mesh, mesh.faces[f], by_edge);
    Mesh rest = extract_faces(mesh, std::span(&f, 1));
    if (!(found.rectangle.area() > 0)) {
      out.remainders.push_back(piece(std::move(rest)));
      continue;
    }
    out.shapes.push_back(piece(rectangle_mesh(mesh, mesh.faces[f], found)));
    // What is left: to the left and right over the full height, then below and above.
    const auto& r = found.rectangle;
    const auto plane = [&](int axis, double at, double side) {
      const Vector3 normal = found.frame.axes[static_cast<std::size_t>(axis)] * side;
      return Plane{normal, dot(normal, found.frame.origin) + at * side};
    };
    const auto cut_off = [&](const Plane& outside) {
      Mesh part = rest;
      const Box box = box_of(rest);
      bool any = false;
      for (const Vector3 p : rest.vertices) any |= outside.distance(p) > 1e-6;
      if (!any || box.empty) return;
      cut_mesh(part, outside, false);
      if (!part.faces.empty()) out.remainders.push_back(piece(std::move(part)));
      cut_mesh(rest, {-outside.normal, -outside.offset}, false);
    };
    cut_off(plane(0, r.x0, -1));
    cut_off(plane(0, r.x1, 1));
    cut_off(plane(1, r.y0, -1));
    cut_off(plane(1, r.y1, 1));
  }
  return out;
}

Result run_inner_rect(Shape& shape, const OperationInput&, Arguments) {
  const ShapeAndRemainder pieces = inner_rectangle_pieces(shape, false);
  if (auto merged = merge_pieces(pieces.shapes)) {
    shape.scope = merged->scope;
    shape.size = merged->size;
    shape.mesh = merged->mesh;
  }
  return {};
}

}  // namespace blockrand::grammar
