// split() across the axes of the scope, and splitArea().
#include "styles/grammar/shapes/split.h"

#include <algorithm>
#include <cmath>

#include "styles/grammar/shapes/mesh_cut.h"
#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

constexpr std::size_t kSmallLoop = 12;  // corners; larger faces take the general way

struct SmallLoop {
  std::array<Vector3, kSmallLoop + 4> points;
  std::array<std::int32_t, kSmallLoop + 4> edges;  // the old corner whose edge goes on from here; -1: the cut
  std::array<std::uint16_t, kSmallLoop + 4> tags;
  std::size_t size = 0;
};

/// Keeps what has side * (coordinate - at) > 0. False when the loop crosses the plane more than twice: then the general
/// way has to tell the parts apart.
bool cut_small(const SmallLoop& in, int axis, double at, double side, SmallLoop& out) {
  out.size = 0;
  int crossings = 0;
  std::array<double, kSmallLoop + 4> distance;
  for (std::size_t i = 0; i < in.size; ++i) {
    const double d = side * (component(in.points[i], axis) - at);
    distance[i] = std::fabs(d) <= kInPlane ? 0 : d;
  }
  // Nothing to cut away: edges in the plane stay what they are.
  if (std::none_of(distance.begin(), distance.begin() + static_cast<std::ptrdiff_t>(in.size),
                   [](double d) { return d < 0; })) {
    out = in;
    return true;
  }
  for (std::size_t i = 0; i < in.size; ++i) {
    const std::size_t j = i + 1 == in.size ? 0 : i + 1;
    const double a = distance[i], b = distance[j];
    if (a > 0) {
      out.points[out.size] = in.points[i];
      out.edges[out.size] = in.edges[i];
      out.tags[out.size++] = in.tags[i];
    }
    if ((a > 0) != (b > 0)) {
      if (++crossings > 2 || out.size >= kSmallLoop + 3) return false;
      Vector3 p = a == 0   ? in.points[i]
                  : b == 0 ? in.points[j]
                           : in.points[i] + (in.points[j] - in.points[i]) * (a / (a - b));
      if (a != 0 && b != 0) set_component(p, axis, at);
      out.points[out.size] = p;
      out.edges[out.size] = a > 0 ? -1 : in.edges[i];
      out.tags[out.size++] = a > 0 ? 0 : in.tags[i];
    }
  }
  return true;
}

/// One face without holes and without uv: what facades are made of.
bool is_small(const Mesh& mesh) {
  if (mesh.faces.size() != 1 || mesh.faces[0].loops.size() != 1 || mesh.faces[0].loops[0].size() > kSmallLoop)
    return false;
  for (const UvSet& set : mesh.uv)
    if (!set.empty()) return false;
  return true;
}

/// The corner that the face begins with.
std::size_t first_corner(const SmallLoop& loop) {
  std::size_t first = 0;
  for (std::size_t i = 1; i < loop.size; ++i)
    if (loop.edges[i] >= 0 && (loop.edges[first] < 0 || loop.edges[i] < loop.edges[first])) first = i;
  // As Cutter::emit: the cut stands for a first edge that it took away.
  const std::size_t before = (first + loop.size - 1) % loop.size;
  return loop.edges[first] > 0 && loop.edges[before] < 0 ? before : first;
}

Mesh mesh_of_small(const SmallLoop& loop, const Mesh& parent) {
  Mesh out;
  if (loop.size < 3) return out;
  if (parent.tag_sets.size() > 1) out.tag_sets = parent.tag_sets;
  const std::size_t first = first_corner(loop);
  out.vertices.reserve(loop.size);
  out.faces.resize(1);
  MeshFace& face = out.faces[0];
  face.tags = parent.faces[0].tags;
  face.material = parent.faces[0].material;
  face.loops.resize(1);
  face.loops[0].reserve(loop.size);
  for (std::size_t k = 0; k < loop.size; ++k) {
    const std::size_t i = first + k >= loop.size ? first + k - loop.size : first + k;
    face.loops[0].push_back({static_cast<std::uint32_t>(k), loop.tags[i]});
    out.vertices.push_back(loop.points[i]);
  }
  return out;
}

Vector3 unit(int axis, double sign) {
  Vector3 out;
  set_component(out, axis, sign);
  return out;
}

/// The slab as scope; points are given in the parent's scope.
void take_slab(Shape& piece, std::span<Vector3> points, int axis, const SplitPiece& range, double sign) {
  Vector3 shift;
  set_component(shift, axis, range.from * sign);
  for (Vector3& p : points) p = p - shift;
  piece.scope.origin = piece.scope.origin + turn(piece.scope, shift);
  set_component(piece.size, axis, (range.to - range.from) * sign);
}

void finish(Shape& piece, Mesh mesh, int axis, const SplitPiece& range, double sign, bool adjust) {
  if (adjust && !mesh.faces.empty()) return take_mesh(piece, std::move(mesh));
  take_slab(piece, mesh.vertices, axis, range, sign);
  keep_scope(piece, std::move(mesh));
}

/// The same of a loop without tags and of few corners.
void finish_small(Shape& piece, const SmallLoop& loop, std::uint16_t material, int axis, const SplitPiece& range,
                  double sign, bool adjust) {
  SmallFace face;
  if (loop.size >= 3) {
    face.size = static_cast<std::uint8_t>(loop.size);
    face.material = material;
    const std::size_t first = first_corner(loop);
    for (std::size_t k = 0; k < loop.size; ++k)
      face.points[k] = loop.points[first + k >= loop.size ? first + k - loop.size : first + k];
    if (adjust) return take_face(piece, face);
  }
  take_slab(piece, std::span(face.points).first(face.size), axis, range, sign);
  if (face.size > 0) piece.mesh = face;
}

/// The shape's mesh where it is a small one.
bool read_small(const Shape& shape, SmallLoop& loop, std::uint16_t& material, bool& tagged) {
  const auto add = [&](Vector3 p, std::uint16_t tags) {
    loop.edges[loop.size] = static_cast<std::int32_t>(loop.size);
    loop.tags[loop.size] = tags;
    loop.points[loop.size++] = p;
  };
  if (const SmallFace* face = shape.mesh.small()) {
    for (std::size_t i = 0; i < face->size; ++i) add(face->points[i], 0);
    material = face->material;
    tagged = false;
    return true;
  }
  const Mesh& mesh = mesh_of(shape);
  if (!is_small(mesh)) return false;
  for (const Corner c : mesh.faces[0].loops[0]) add(mesh.vertices[c.vertex], c.edge_tags);
  material = mesh.faces[0].material;
  tagged = mesh.tag_sets.size() > 1;
  return true;
}

}  // namespace

double split_length(const Shape& shape, int axis) { return std::fabs(component(shape.size, axis)); }

std::vector<Shape> split_shape(const Shape& shape, int axis, std::span<const SplitPiece> pieces, bool adjust) {
  std::vector<Shape> out;
  if (pieces.empty()) return out;
  out.reserve(pieces.size());
  const double sign = component(shape.size, axis) < 0 ? -1 : 1;
  const auto add = [&]() -> Shape& {
    Shape& piece = out.emplace_back(shape);
    piece.mesh = nullptr;
    piece.split = {static_cast<std::int32_t>(out.size() - 1), static_cast<std::int32_t>(pieces.size())};
    return piece;
  };
  SmallLoop loop;
  std::uint16_t material = 0;
  bool tagged = false;
  if (read_small(shape, loop, material, tagged)) {
    SmallLoop upper, both;
    for (const SplitPiece& piece : pieces) {
      if (!cut_small(loop, axis, piece.from * sign, sign, upper) ||
          !cut_small(upper, axis, piece.to * sign, -sign, both)) {
        out.clear();
        break;
      }
      if (!tagged && both.size <= SmallFace::kMostCorners)
        finish_small(add(), both, material, axis, piece, sign, adjust);
      else
        finish(add(), mesh_of_small(both, *shape.mesh), axis, piece, sign, adjust);
    }
    if (!out.empty()) return out;
  }
  const Mesh& mesh = mesh_of(shape);
  const bool cap = is_closed(mesh);
  Mesh rest = mesh;
  double rest_from = -1e300;
  for (const SplitPiece& piece : pieces) {
    if (piece.from < rest_from) rest = mesh;  // pieces out of order
    rest_from = piece.from;
    cut_mesh(rest, {unit(axis, sign), piece.from}, cap);
    Mesh part = rest;
    cut_mesh(part, {unit(axis, -sign), -piece.to}, cap);
    finish(add(), std::move(part), axis, piece, sign, adjust);
  }
  return out;
}

Shape cut_piece(const Shape& shape, int axis, double from, double to, bool adjust) {
  const SplitPiece piece{0, from, to};
  Shape out = split_shape(shape, axis, std::span(&piece, 1), adjust)[0];
  out.split = shape.split;
  return out;
}

double split_area_total(const Shape& shape) {
  double sum = 0;
  const Mesh& mesh = mesh_of(shape);
  for (const MeshFace& face : mesh.faces) sum += face_area(mesh, face);
  return sum;
}

std::vector<Shape> split_area(const Shape& shape, int axis, std::span<const SplitPiece> pieces, bool adjust) {
  const Mesh& mesh = mesh_of(shape);
  const double sign = component(shape.size, axis) < 0 ? -1 : 1;
  const double whole = split_length(shape, axis);
  const double tolerance = 1e-9 * std::max(1.0, split_area_total(shape));
  const auto area_before = [&](double at) {
    Mesh part = mesh;
    cut_mesh(part, {unit(axis, -sign), -at}, false);
    double sum = 0;
    for (const MeshFace& face : part.faces) sum += face_area(part, face);
    return sum;
  };
  const auto place_of = [&](double area) {
    double low = 0, high = whole;
    if (area <= tolerance) return 0.0;
    if (area >= split_area_total(shape) - tolerance) return whole;
    // The area before a place grows with the place. Secant steps kept inside the bracket: on lots of even width the
    // first one hits.
    double area_low = 0, area_high = split_area_total(shape);
    for (int i = 0; i < 80 && high - low > 1e-12 * whole; ++i) {
      double middle = (low + high) / 2;
      if (i % 2 == 0 && area_high > area_low) middle = low + (high - low) * (area - area_low) / (area_high - area_low);
      const double here = area_before(middle);
      if (std::fabs(here - area) <= tolerance) return middle;
      (here < area ? low : high) = middle;
      (here < area ? area_low : area_high) = here;
    }
    return (low + high) / 2;
  };
  std::vector<SplitPiece> places;
  for (const SplitPiece& piece : pieces) places.push_back({piece.rule, place_of(piece.from), place_of(piece.to)});
  return split_shape(shape, axis, places, adjust);
}

}  // namespace blockrand::grammar
