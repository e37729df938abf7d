// Moving, turning and refitting the scope (docs/rule_language.md §2.1).
#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

Vector3 sized(Arguments arguments, std::size_t first, Vector3 whole) {
  return {measured(arguments, first, whole.x), measured(arguments, first + 1, whole.y),
          measured(arguments, first + 2, whole.z)};
}

/// Axes times a matrix given by its columns: turned about the axes of the frame above.
std::array<Vector3, 3> turned(const std::array<Vector3, 3>& by, const std::array<Vector3, 3>& axes) {
  const Frame frame{{}, by};
  return {turn(frame, axes[0]), turn(frame, axes[1]), turn(frame, axes[2])};
}

/// The pivot's frame as seen from the named system, and back: system -> pivot.
Frame system_in_pivot(const Shape& shape, CoordinateSystem system) {
  return relative_to(system_in_world(shape, CoordinateSystem::pivot), system_in_world(shape, system));
}

std::optional<CoordinateSystem> system_of(std::string_view word) {
  if (word == "scope") return CoordinateSystem::scope;
  if (word == "pivot") return CoordinateSystem::pivot;
  if (word == "object") return CoordinateSystem::object;
  if (word == "world") return CoordinateSystem::world;
  return {};
}

/// Pivot and scope become `axes` (given in the present scope), in the lowest corner of the geometry's box there; the
/// geometry stays.
void realign(Shape& shape, const Frame& axes) {
  Mesh mesh = mesh_of(shape);
  Box box;
  if (mesh.faces.empty()) {
    for (int i = 0; i < 8; ++i)
      box.add(place_back(axes, {i & 1 ? shape.size.x : 0, i & 2 ? shape.size.y : 0, i & 4 ? shape.size.z : 0}));
  } else {
    into_frame(mesh, axes);
    box = box_of(mesh);
  }
  Frame corner = axes;
  corner.origin = place(axes, box.low);
  shape.pivot = compose(scope_in_object(shape), corner);
  shape.scope = {};
  shape.size = box.extent();
  // Rounding of turned coordinates must not make flat shapes thick.
  constexpr double kFlat = 1e-9;
  for (int i = 0; i < 3; ++i)
    if (std::fabs(component(shape.size, i)) < kFlat) set_component(shape.size, i, 0);
  for (Vector3& p : mesh.vertices) {
    p = p - box.low;
    for (int i = 0; i < 3; ++i)
      if (component(shape.size, i) == 0) set_component(p, i, 0);
  }
  keep_scope(shape, std::move(mesh));
}

Vector3 scope_middle(const Shape& shape) { return place(scope_in_object(shape), shape.size * 0.5); }

Frame axes_only(Vector3 x, Vector3 y, Vector3 z) { return {{}, {x, y, z}}; }

}  // namespace

Result run_t(Shape& shape, const OperationInput& input, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  shape.scope.origin = shape.scope.origin + turn(shape.scope, sized(arguments, 0, input.base.size));
  return {};
}

Result run_translate(Shape& shape, const OperationInput& input, Arguments arguments) {
  const auto system = system_of(word(arguments, 1));
  if (word(arguments, 0) != "abs" && word(arguments, 0) != "rel")
    return failure(unknown_word(word(arguments, 0), "abs, rel"));
  if (!system) return failure(unknown_word(word(arguments, 1), "scope, pivot, object, world"));
  const Vector3 v = sized(arguments, 2, input.base.size);
  const Frame frame = system_in_pivot(shape, *system);
  shape.scope.origin = word(arguments, 0) == "abs" ? place(frame, v) : shape.scope.origin + turn(frame, v);
  return {};
}

Result run_s(Shape& shape, const OperationInput& input, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  const Vector3 size = sized(arguments, 0, input.base.size);
  const auto factor = [](double from, double to) { return from == 0 ? 1.0 : to / from; };
  const Vector3 k{factor(shape.size.x, size.x), factor(shape.size.y, size.y), factor(shape.size.z, size.z)};
  const auto scaled = [&](Vector3 p) { return Vector3{p.x * k.x, p.y * k.y, p.z * k.z}; };
  if (const SmallFace* small = shape.mesh.small(); small && k != Vector3{1, 1, 1}) {
    SmallFace face = *small;
    for (std::size_t i = 0; i < face.size; ++i) face.points[i] = scaled(face.points[i]);
    shape.mesh = face;
  } else if (shape.mesh && k != Vector3{1, 1, 1}) {
    Mesh mesh = *shape.mesh;
    for (Vector3& p : mesh.vertices) p = scaled(p);
    shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  }
  shape.size = size;
  return {};
}

Result run_r(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::size_t first = arguments.size() == 4 ? 1 : 0;
  if (first == 1 && word(arguments, 0) != "scopeOrigin" && word(arguments, 0) != "scopeCenter")
    return failure(unknown_word(word(arguments, 0), "scopeOrigin, scopeCenter"));
  if (auto ok = wants_numbers(arguments, first); !ok) return ok;
  const Vector3 middle = place(shape.scope, shape.size * 0.5);
  shape.scope.axes =
      turned(axes_of_angles({number(arguments, first), number(arguments, first + 1), number(arguments, first + 2)}),
             shape.scope.axes);
  if (word(arguments, 0) == "scopeCenter") shape.scope.origin = middle - turn(shape.scope, shape.size * 0.5);
  return {};
}

Result run_rotate(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto system = system_of(word(arguments, 1));
  if (word(arguments, 0) != "abs" && word(arguments, 0) != "rel")
    return failure(unknown_word(word(arguments, 0), "abs, rel"));
  if (!system) return failure(unknown_word(word(arguments, 1), "scope, pivot, object, world"));
  const auto rotation = axes_of_angles({number(arguments, 2), number(arguments, 3), number(arguments, 4)});
  const Frame frame{{}, system_in_pivot(shape, *system).axes};
  std::array<Vector3, 3> now;
  for (int i = 0; i < 3; ++i) now[i] = turn_back(frame, shape.scope.axes[i]);
  const auto then = word(arguments, 0) == "abs" ? rotation : turned(rotation, now);
  for (int i = 0; i < 3; ++i) shape.scope.axes[i] = turn(frame, then[i]);
  return {};
}

Result run_center(Shape& shape, const OperationInput& input, Arguments arguments) {
  const std::string_view axes = word(arguments, 0);
  constexpr std::array<std::string_view, 7> kKnown{"x", "y", "z", "xy", "xz", "yz", "xyz"};
  if (std::find(kKnown.begin(), kKnown.end(), axes) == kKnown.end())
    return failure(unknown_word(axes, "x, y, z, xy, xz, yz, xyz"));
  // Along the axes of the scope as it is now: files stand chimneys on slopes by alignScopeToAxes(y) s(…) center(xz).
  const Frame now = scope_in_object(shape);
  const Vector3 way = turn_back(now, scope_middle(input.base) - scope_middle(shape));
  Vector3 chosen;
  for (const char axis : axes) set_component(chosen, axis - 'x', component(way, axis - 'x'));
  shape.scope.origin = shape.scope.origin + turn_back(shape.pivot, turn(now, chosen));
  return {};
}

Result run_align_scope_to_axes(Shape& shape, const OperationInput&, Arguments arguments) {
  std::string_view axis = arguments.empty() ? "world.xyz" : word(arguments, 0);
  CoordinateSystem system = CoordinateSystem::world;
  if (axis.starts_with("object.")) {
    system = CoordinateSystem::object;
    axis.remove_prefix(7);
  } else if (axis.starts_with("world.")) {
    axis.remove_prefix(6);
  }
  const Frame frame = relative_to(scope_in_world(shape), system_in_world(shape, system));
  if (axis == "xyz")
    realign(shape, {{}, frame.axes});
  else if (axis == "y")
    realign(shape, frame_with_y({}, frame.axes[1], {1, 0, 0}));
  else if (axis == "z")
    realign(shape, frame_with_z({}, frame.axes[2], {1, 0, 0}));
  else if (axis == "x") {
    const Frame other = frame_with_y({}, frame.axes[0], {0, 1, 0});  // its y is our x, its x our y
    realign(shape, axes_only(other.axes[1], other.axes[0], cross(other.axes[1], other.axes[0])));
  } else {
    return failure(unknown_word(word(arguments, 0), "x, y, z, world.x … world.xyz, object.x … object.xyz"));
  }
  return {};
}

namespace {

/// Height in the world, for world.lowest.
std::size_t wrapped(double index, std::size_t count) {
  const auto n = static_cast<double>(count);
  const double whole = std::fmod(std::floor(index), n);
  return static_cast<std::size_t>(whole < 0 ? whole + n : whole) % count;
}

}  // namespace

Result run_align_scope_to_geometry(Shape& shape, const OperationInput&, Arguments arguments) {
  const bool y_up = word(arguments, 0) == "yUp";
  if (!y_up && word(arguments, 0) != "zUp") return failure(unknown_word(word(arguments, 0), "yUp, zUp"));
  const std::string_view face_word = word(arguments, 1), edge_word = word(arguments, 2);
  if (!is_number(arguments, 1) && face_word != "world.lowest" && face_word != "largest" && face_word != "any" &&
      face_word != "auto")
    return failure(unknown_word(face_word, "a face's index, world.lowest, largest, any, auto"));
  if (arguments.size() > 2 && !is_number(arguments, 2) && edge_word != "world.lowest" && edge_word != "longest")
    return failure(unknown_word(edge_word, "an edge's index, world.lowest, longest"));
  const Mesh& mesh = mesh_of(shape);
  if (mesh.faces.empty()) return {};
  const Frame world = scope_in_world(shape);
  // Ties go to the lowest index: what comes later must be better by more than rounding.
  constexpr double kTie = 1e-7;
  const auto edge_key = [&](const Loop& loop, std::size_t e) {
    const Vector3 a = mesh.vertices[loop[e].vertex], b = mesh.vertices[loop[(e + 1) % loop.size()].vertex];
    return edge_word == "longest" ? length(b - a) : -(place(world, a).y + place(world, b).y) / 2;
  };
  const auto best_edge = [&](const Loop& loop) {
    if (edge_word.empty()) return arguments.size() > 2 ? wrapped(number(arguments, 2), loop.size()) : std::size_t{0};
    std::size_t best = 0;
    for (std::size_t e = 1; e < loop.size(); ++e)
      if (edge_key(loop, e) > edge_key(loop, best) + kTie) best = e;
    return best;
  };
  std::size_t face = 0;
  if (is_number(arguments, 1)) {
    face = wrapped(number(arguments, 1), mesh.faces.size());
  } else {
    const auto key = [&](std::size_t f) {
      const Loop& loop = mesh.faces[f].loops[0];
      if (face_word == "world.lowest") {
        double low = 1e300;
        for (const Corner c : loop) low = std::min(low, place(world, mesh.vertices[c.vertex]).y);
        return -low;
      }
      if (face_word == "any" && !edge_word.empty()) return edge_key(loop, best_edge(loop));
      return face_area(mesh, mesh.faces[f]);
    };
    for (std::size_t f = 1; f < mesh.faces.size(); ++f)
      if (key(f) > key(face) + kTie) face = f;
  }
  const Vector3 normal = face_normal(mesh, mesh.faces[face]);
  if (normal == Vector3{}) return {};
  const Loop& loop = mesh.faces[face].loops[0];
  const std::size_t e = best_edge(loop);
  const Vector3 along = mesh.vertices[loop[(e + 1) % loop.size()].vertex] - mesh.vertices[loop[e].vertex];
  realign(shape, y_up ? frame_with_y({}, normal, along) : frame_with_z({}, normal, along));
  return {};
}

Result run_align_scope_to_geometry_bbox(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string_view plane = word(arguments, 0);
  constexpr std::array<std::string_view, 6> kKnown{"xy", "yx", "xz", "zx", "yz", "zy"};
  if (std::find(kKnown.begin(), kKnown.end(), plane) == kKnown.end())
    return failure(unknown_word(plane, "xy, yx, xz, zx, yz, zy"));
  const Mesh& mesh = mesh_of(shape);
  if (mesh.faces.empty()) return {};
  const int a = plane[0] - 'x', b = plane[1] - 'x';
  // The smallest rectangle lies along an edge of the convex hull; edges of faces are candidates enough.
  double best = 1e300;
  Vector2 along{1, 0};
  Vector2 extent;
  for (const EdgeSide& side : edge_sides(mesh)) {
    const Vector3 v = mesh.vertices[side.high] - mesh.vertices[side.low];
    const double x = component(v, a), y = component(v, b), n = std::sqrt(x * x + y * y);
    if (n < 1e-9) continue;
    const Vector2 way{x / n, y / n};
    double low_u = 1e300, high_u = -1e300, low_v = 1e300, high_v = -1e300;
    for (const MeshFace& face : mesh.faces)
      for (const Corner c : face.loops[0]) {
        const double px = component(mesh.vertices[c.vertex], a), py = component(mesh.vertices[c.vertex], b);
        low_u = std::min(low_u, px * way.x + py * way.y);
        high_u = std::max(high_u, px * way.x + py * way.y);
        low_v = std::min(low_v, py * way.x - px * way.y);
        high_v = std::max(high_v, py * way.x - px * way.y);
      }
    const double area = (high_u - low_u) * (high_v - low_v);
    if (area < best - 1e-9 * std::max(1.0, area)) {
      best = area;
      along = way;
      extent = {high_u - low_u, high_v - low_v};
    }
  }
  if (extent.y > extent.x + 1e-9) along = {-along.y, along.x};
  // The longer side along the first letter's axis, turned as little as can be.
  if (along.x < 0 || (along.x == 0 && along.y < 0)) along = {-along.x, -along.y};
  std::array<Vector3, 3> axes{};
  Vector3 first, second;
  set_component(first, a, along.x);
  set_component(first, b, along.y);
  set_component(second, a, -along.y);
  set_component(second, b, along.x);
  axes[static_cast<std::size_t>(a)] = first;
  axes[static_cast<std::size_t>(b)] = second;
  const int c = 3 - a - b;
  Vector3 third;
  set_component(third, c, 1);
  axes[static_cast<std::size_t>(c)] = third;
  realign(shape, {{}, axes});
  return {};
}

Result run_rotate_scope(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  Frame then = shape.scope;
  then.axes = turned(axes_of_angles({number(arguments, 0), number(arguments, 1), number(arguments, 2)}), then.axes);
  const Frame inner = relative_to(shape.scope, then);
  Mesh mesh = mesh_of(shape);
  if (mesh.faces.empty()) {
    Box box;
    for (int i = 0; i < 8; ++i)
      box.add(place_back(inner, {i & 1 ? shape.size.x : 0, i & 2 ? shape.size.y : 0, i & 4 ? shape.size.z : 0}));
    then.origin = place(shape.scope, place(inner, box.low));
    shape.scope = then;
    shape.size = box.extent();
    return {};
  }
  into_frame(mesh, inner);
  constexpr double kFlat = 1e-9;  // m: rounding of turned coordinates
  const Box box = box_of(mesh);
  for (int i = 0; i < 3; ++i)
    if (component(box.extent(), i) < kFlat)
      for (Vector3& p : mesh.vertices) set_component(p, i, component(box.low, i));
  shape.scope = compose(shape.scope, inner);
  shape.size = {};
  take_mesh(shape, std::move(mesh));
  return {};
}

Result run_mirror_scope(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  Vector3 shift;
  Vector3 size = shape.size;
  for (int i = 0; i < 3; ++i)
    if (number(arguments, static_cast<std::size_t>(i)) != 0) {
      set_component(shift, i, component(shape.size, i));
      set_component(size, i, -component(shape.size, i));
    }
  if (shape.mesh) {
    Mesh mesh = *shape.mesh;
    for (Vector3& p : mesh.vertices) p = p - shift;
    shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  }
  shape.scope.origin = shape.scope.origin + turn(shape.scope, shift);
  shape.size = size;
  return {};
}

Result run_mirror(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  if (!shape.mesh) return {};
  Mesh mesh = *shape.mesh;
  int flips = 0;
  for (int i = 0; i < 3; ++i) {
    if (number(arguments, static_cast<std::size_t>(i)) == 0) continue;
    ++flips;
    for (Vector3& p : mesh.vertices) set_component(p, i, component(shape.size, i) - component(p, i));
  }
  if (flips % 2 == 1) reverse_faces(mesh);
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

Result run_set_pivot(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string_view map = word(arguments, 0);
  if (map != "xyz" && map != "yzx" && map != "zxy") return failure(unknown_word(map, "xyz, yzx, zxy"));
  const double index = number(arguments, 1, -1);
  if (!(index >= 0 && index < 8)) return failure("the corner must be 0 to 7");
  // The new x, y, z as the old axis and its sign (docs/rule_language.md §2.1).
  struct Axes {
    std::array<std::int8_t, 3> axis, sign;
  };
  constexpr std::array<Axes, 8> kAxes{{{{0, 1, 2}, {1, 1, 1}},
                                       {{2, 1, 0}, {1, 1, -1}},
                                       {{0, 1, 2}, {-1, 1, -1}},
                                       {{2, 1, 0}, {-1, 1, 1}},
                                       {{2, 1, 0}, {1, -1, 1}},
                                       {{0, 1, 2}, {-1, -1, 1}},
                                       {{2, 1, 0}, {-1, -1, -1}},
                                       {{0, 1, 2}, {1, -1, -1}}}};
  constexpr std::array<Vector3, 8> kCorners{
      {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}};
  const auto corner = static_cast<std::size_t>(index);
  const std::size_t shift = map == "xyz" ? 0 : map == "yzx" ? 2 : 1;
  const Vector3 low{std::min(0.0, shape.size.x), std::min(0.0, shape.size.y), std::min(0.0, shape.size.z)};
  Frame frame;
  Vector3 size;
  frame.origin = {low.x + kCorners[corner].x * std::fabs(shape.size.x),
                  low.y + kCorners[corner].y * std::fabs(shape.size.y),
                  low.z + kCorners[corner].z * std::fabs(shape.size.z)};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t from = (i + shift) % 3;
    Vector3 axis;
    set_component(axis, kAxes[corner].axis[from], kAxes[corner].sign[from]);
    frame.axes[i] = axis;
    set_component(size, static_cast<int>(i), std::fabs(component(shape.size, kAxes[corner].axis[from])));
  }
  Mesh mesh = mesh_of(shape);
  into_frame(mesh, frame);
  shape.pivot = compose(scope_in_object(shape), frame);
  shape.scope = {};
  shape.size = size;
  keep_scope(shape, std::move(mesh));
  return {};
}

Result run_reset_geometry(Shape& shape, const OperationInput& input, Arguments) {
  shape.mesh = input.initial.mesh;
  shape.pivot = input.initial.pivot;
  shape.scope = input.initial.scope;
  shape.size = input.initial.size;
  shape.trim_planes = nullptr;
  return {};
}

}  // namespace blockrand::grammar
