// Texture coordinates (docs/rule_language.md §2.7).
#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/measure.h"
#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

tl::expected<int, std::string> set_of(Arguments arguments, std::size_t i) {
  if (!is_number(arguments, i)) return failure("the uv set must be a number from 0 to 9");
  const double set = std::floor(number(arguments, i));
  if (!(set >= 0 && set < kUvSetCount)) return failure("the uv set must be 0 to 9");
  return static_cast<int>(set);
}

/// Changes every coordinate of a set. No coordinates: nothing happens.
template <typename Change>
void change_uv(Shape& shape, int set, Change change) {
  if (!shape.mesh || shape.mesh->uv[static_cast<std::size_t>(set)].empty()) return;
  Mesh mesh = *shape.mesh;
  for (auto& face : mesh.uv[static_cast<std::size_t>(set)])
    for (auto& ring : face)
      for (Vector2& p : ring) p = change(p);
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
}

/// A tile's size: floating ones divide the span into the nearest whole number of tiles.
double tile_size(Arguments arguments, std::size_t i, double span) {
  const double given = number(arguments, i);
  if (i >= arguments.size()) return given;
  if (arguments[i].mark == Mark::relative) return finite(given * span);
  if (arguments[i].mark != Mark::floating || given == 0 || !(std::fabs(span) > 0)) return given;
  const double tiles = std::max(1.0, std::floor(std::fabs(span / given) + 0.5));
  return std::copysign(std::fabs(span) / tiles, given);
}

/// Extent of the scope along a direction given in its axes.
double scope_span(const Shape& shape, Vector3 way) {
  return std::fabs(way.x * shape.size.x) + std::fabs(way.y * shape.size.y) + std::fabs(way.z * shape.size.z);
}

}  // namespace

Result run_setup_projection(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  std::string_view axes = word(arguments, 1);
  const auto dot_at = axes.find('.');
  const std::string_view space = axes.substr(0, dot_at);
  const std::string_view pair = dot_at == std::string_view::npos ? std::string_view{} : axes.substr(dot_at + 1);
  const bool known = (space == "scope" || space == "world" || space == "object") && pair.size() == 2 &&
                     pair[0] != pair[1] && pair[0] >= 'x' && pair[0] <= 'z' && pair[1] >= 'x' && pair[1] <= 'z';
  if (!known) return failure(unknown_word(axes, "scope.xy … scope.zy, world.xy … world.zy"));
  if (auto ok = wants_numbers(arguments, 2); !ok) return ok;
  const Frame frame = space == "scope"   ? scope_in_object(shape)
                      : space == "world" ? relative_to(object_in_world(shape), Frame{})
                                         : Frame{};
  const auto u = static_cast<std::size_t>(pair[0] - 'x'), v = static_cast<std::size_t>(pair[1] - 'x');
  Projection projection;
  projection.origin = frame.origin;
  projection.u_axis = frame.axes[u];
  projection.v_axis = frame.axes[v];
  projection.w_axis = frame.axes[3 - u - v];
  const Frame scope = scope_in_object(shape);
  const double span_u = scope_span(shape, turn_back(scope, projection.u_axis));
  const double span_v = scope_span(shape, turn_back(scope, projection.v_axis));
  projection.width = tile_size(arguments, 2, span_u);
  projection.height = tile_size(arguments, 3, span_v);
  projection.width_offset = measured(arguments, 4, span_u);
  projection.height_offset = measured(arguments, 5, span_v);
  projection.u_along_w = number(arguments, 6);
  auto all = shape.projections ? *shape.projections : std::array<Projection, kUvSetCount>{};
  all[static_cast<std::size_t>(*set)] = projection;
  shape.projections = std::make_shared<const std::array<Projection, kUvSetCount>>(all);
  return {};
}

Result run_project_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  const auto index = static_cast<std::size_t>(*set);
  if (!shape.projections || (*shape.projections)[index].u_axis == Vector3{})
    return failure("no projection is set up for uv set " + std::to_string(*set) + ": setupProjection comes first");
  if (!shape.mesh) return {};
  const Projection& projection = (*shape.projections)[index];
  const Frame object = scope_in_object(shape);
  // A tile without size would be endlessly many: then one tile is a metre.
  const double width = projection.width != 0 ? projection.width : 1,
               height = projection.height != 0 ? projection.height : 1;
  Mesh mesh = *shape.mesh;
  std::vector<Vector2> by_vertex;
  for (const Vector3 v : mesh.vertices) {
    const Vector3 p = place(object, v) - projection.origin;
    const double u = dot(p, projection.u_axis) + projection.u_along_w * dot(p, projection.w_axis);
    by_vertex.push_back(
        {(u + projection.width_offset) / width, (dot(p, projection.v_axis) + projection.height_offset) / height});
  }
  UvSet& uv = mesh.uv[index];
  uv.assign(mesh.faces.size(), {});
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const Loop& loop : mesh.faces[f].loops) {
      uv[f].emplace_back();
      uv[f].back().reserve(loop.size());
      for (const Corner c : loop) uv[f].back().push_back(by_vertex[c.vertex]);
    }
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

Result run_tile_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  if (auto ok = wants_numbers(arguments, 1); !ok) return ok;
  const auto factor = [&](std::size_t i, bool v) {
    const double units = geometry_uv_extent(shape, v, false, *set), metres = geometry_uv_extent(shape, v, true, *set);
    const double size = tile_size(arguments, i, metres);
    return size == 0 || !(units > 0) || !(metres > 0) ? 1 : metres / units / size;
  };
  const double u = factor(1, false), v = factor(2, true);
  change_uv(shape, *set, [&](Vector2 p) { return Vector2{p.x * u, p.y * v}; });
  return {};
}

Result run_scale_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  if (auto ok = wants_numbers(arguments, 1); !ok) return ok;
  const double u = number(arguments, 1), v = number(arguments, 2);
  change_uv(shape, *set, [&](Vector2 p) { return Vector2{p.x * u, p.y * v}; });
  return {};
}

Result run_translate_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  if (auto ok = wants_numbers(arguments, 1); !ok) return ok;
  const double u = number(arguments, 1), v = number(arguments, 2);
  change_uv(shape, *set, [&](Vector2 p) { return Vector2{p.x + u, p.y + v}; });
  return {};
}

Result run_rotate_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  if (auto ok = wants_numbers(arguments, 1); !ok) return ok;
  // Through the axes of a turned frame: exact at quarter turns.
  const Vector3 x = axes_of_angles({0, 0, number(arguments, 1)})[0];
  change_uv(shape, *set, [&](Vector2 p) { return Vector2{p.x * x.x - p.y * x.y, p.x * x.y + p.y * x.x}; });
  return {};
}

Result run_normalize_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  const std::string_view kind = word(arguments, 1), scope = word(arguments, 2);
  if (kind != "uv" && kind != "uvUniform" && kind != "u" && kind != "v")
    return failure(unknown_word(kind, "uv, uvUniform, u, v"));
  if (scope != "separatePerFace" && scope != "collectiveAllFaces")
    return failure(unknown_word(scope, "separatePerFace, collectiveAllFaces"));
  if (!shape.mesh || shape.mesh->uv[static_cast<std::size_t>(*set)].empty()) return {};
  Mesh mesh = *shape.mesh;
  UvSet& uv = mesh.uv[static_cast<std::size_t>(*set)];
  const auto normalize = [&](std::size_t from, std::size_t to) {
    Box box;
    for (std::size_t f = from; f < to; ++f)
      for (const auto& ring : uv[f])
        for (const Vector2 p : ring) box.add({p.x, p.y, 0});
    if (box.empty) return;
    Vector3 extent = box.extent();
    if (kind == "uvUniform") extent.x = extent.y = std::max(extent.x, extent.y);
    for (std::size_t f = from; f < to; ++f)
      for (auto& ring : uv[f])
        for (Vector2& p : ring) {
          if (kind != "v" && extent.x > 0) p.x = (p.x - box.low.x) / extent.x;
          if (kind != "u" && extent.y > 0) p.y = (p.y - box.low.y) / extent.y;
        }
  };
  if (scope == "collectiveAllFaces")
    normalize(0, uv.size());
  else
    for (std::size_t f = 0; f < uv.size(); ++f) normalize(f, f + 1);
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

Result run_copy_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto from = set_of(arguments, 0), to = set_of(arguments, 1);
  if (!from) return failure(from.error());
  if (!to) return failure(to.error());
  if (!shape.mesh || *from == *to) return {};
  Mesh mesh = *shape.mesh;
  mesh.uv[static_cast<std::size_t>(*to)] = mesh.uv[static_cast<std::size_t>(*from)];
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

Result run_delete_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  const auto set = set_of(arguments, 0);
  if (!set) return failure(set.error());
  if (!shape.mesh) return {};
  Mesh mesh = *shape.mesh;
  mesh.uv[static_cast<std::size_t>(*set)].clear();
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

}  // namespace blockrand::grammar
