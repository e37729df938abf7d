// envelope: the room that a building code leaves over a lot (docs/rule_language.md §2.2).
#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/operation_list.h"
#include "styles/grammar/shapes/plan_skeleton.h"

namespace blockrand::grammar {

namespace {

/// What an edge of the lot asks for: upright to `height`, then sloping inwards at `angle` degrees from level.
struct Side {
  double height = 0, angle = 90;
};

geometry::EdgeProfile profile_of(const Side& side, double step) {
  const double angle = std::clamp(side.angle, 1.0, 90.0);
  const double slope = angle >= 89.9 ? geometry::kUpright : base::tan(angle * base::kRadiansPerDegree);
  if (side.height < step || slope == geometry::kUpright) return {slope, {}};
  return {geometry::kUpright, {{side.height, slope}}};
}

const NumberArray* array_of(Arguments arguments, std::size_t i) {
  return i < arguments.size() && !is_word(arguments, i) ? std::get_if<NumberArray>(&arguments[i].value) : nullptr;
}

}  // namespace

Result run_envelope(Shape& shape, const OperationInput&, Arguments arguments) {
  if (word(arguments, 0) != "normal" && word(arguments, 0) != "world.up")
    return failure(unknown_word(word(arguments, 0), "normal, world.up"));
  if (!is_number(arguments, 1)) return failure("the greatest height must be a number");
  const double most = number(arguments, 1);
  const NumberArray *heights = array_of(arguments, 2), *angles = array_of(arguments, 3);
  if ((heights == nullptr) != (angles == nullptr))
    return failure("heights and angles must both be arrays or both be numbers");
  if (heights == nullptr)
    if (auto ok = wants_numbers(arguments, 2); !ok) return ok;
  const Mesh& old = mesh_of(shape);
  if (old.faces.empty() || !(most > 0)) return {};
  const Vector3 first = face_normal(old, old.faces[0]);
  if (word(arguments, 0) == "world.up" && turn(scope_in_world(shape), first).y < 0.9999)
    return failure("world.up over sloping lots is not there yet: use normal");
  const ComponentSplit edges = components(shape, ComponentKind::face_edges);
  const auto side_of = [&](std::size_t item, std::size_t corner) -> Side {
    if (heights != nullptr) {
      Side side;
      if (!heights->items.empty()) side.height = finite(heights->items[corner % heights->items.size()]);
      if (!angles->items.empty()) side.angle = finite(angles->items[corner % angles->items.size()]);
      return side;
    }
    // front, back, right, left: what is not given follows the rule of the reference's defaults.
    std::size_t at = 2;
    const auto is = [&](std::string_view name) { return selected(edges, item, *selector_of_word(name)); };
    if (is("street.back"))
      at = 4;
    else if (is("street.right"))
      at = 6;
    else if (is("street.left"))
      at = arguments.size() > 8 ? 8 : 6;
    if (at >= arguments.size()) return {0, 90};
    return {number(arguments, at), number(arguments, at + 1, 90)};
  };
  Mesh out;
  out.tag_sets = old.tag_sets;
  std::size_t item = 0;
  for (std::size_t f = 0; f < old.faces.size(); ++f) {
    std::size_t corners = 0;
    for (const Loop& loop : old.faces[f].loops) corners += loop.size();
    const std::size_t base_item = item;
    item += corners;
    const auto flat = flat_face(old, f);
    if (!flat) continue;
    const double step = 2 / (model::kGridStepsPerMetre * flat->scale);
    std::vector<geometry::EdgeProfile> profiles;
    for (std::size_t c = 0; c < corners; ++c) {
      Side side = side_of(base_item + c, c);
      if (side.height >= most - step) side.angle = 90;
      profiles.push_back(profile_of(side, step));
    }
    const auto plan = sweep_plan(*flat, profiles, most);
    if (!plan) continue;
    Mesh body;
    body.tag_sets = out.tag_sets;
    for (std::size_t i = 0; i < plan->points.size(); ++i)
      body.vertices.push_back(i < corners ? old.vertices[flat->vertices[i]] : place(flat->plane, plan->points[i]));
    MeshFace bottom = old.faces[f];
    std::uint32_t corner = 0;
    for (Loop& loop : bottom.loops)
      for (Corner& c : loop) c.vertex = corner++;
    reverse_face(bottom);
    body.faces.push_back(std::move(bottom));
    for (const SweptFace& swept : plan->faces) {
      MeshFace face;
      face.material = old.faces[f].material;
      for (const auto& ring : swept.loops) {
        face.loops.emplace_back();
        for (const std::uint32_t v : ring) face.loops.back().push_back({v, 0});
      }
      body.faces.push_back(std::move(face));
    }
    weld(body, 1e-7);
    if (!is_closed(body)) join_borders(body, 1e-5);
    append(out, body);
  }
  if (out.faces.empty()) return {};
  shape.size = {};
  take_mesh_in_frame(shape, std::move(out), frame_with_y({}, first, {1, 0, 0}));
  return {};
}

}  // namespace blockrand::grammar
