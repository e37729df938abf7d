// House doors and carriage gateways.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "styles/elements/joinery.h"
#include "styles/elements/sweep.h"
#include "styles/elements/trim.h"

namespace blockrand::elements {
namespace {

using model::Point2;

/// m. Height of the wooden or stone strip on the floor.
constexpr double kThreshold = 0.03;
/// m of a panelled leaf that is less than a leaf.
constexpr double kLeastPanel = 0.08;

enum class Glazing { none, upper, all };

/// One panelled leaf in a convex hole of which it takes `from <= x <= to`: its panels' outlines.
tl::expected<std::vector<Outline>, std::string> panels_of(const Outline& leaf, int count, double rail) {
  const Outline inner = inset(leaf, rail);
  if (inner.empty()) return tl::unexpected<std::string>("no room for the panels of its leaves");
  const Bounds2 box = bounds_of(inner);
  // Shares from below: three panels are low, high, middling, as old doors have them.
  std::vector<double> shares(static_cast<std::size_t>(count), 1.0);
  if (count == 2) shares = {1, 1.6};
  if (count == 3) shares = {1, 1.8, 0.7};
  if (count == 4) shares = {1, 0.5, 1.6, 0.6};
  double sum = 0;
  for (const double s : shares) sum += s;
  const double room = box.height() - rail * (count - 1);
  std::vector<Outline> out;
  double y = box.least.y;
  for (const double s : shares) {
    const double to = y + room * s / sum;
    Outline panel = between_y(inner, y, &s == &shares.back() ? box.most.y + 1 : to);
    const Bounds2 b = bounds_of(panel);
    if (panel.empty() || b.height() < kLeastPanel || b.width() < kLeastPanel)
      return tl::unexpected<std::string>("no room for the panels of its leaves");
    out.push_back(std::move(panel));
    y = to + rail;
  }
  return out;
}

/// Panelled leaves in a hole, their front at z.
Made add_door_leaves(MeshBuilder& builder, const Outline& hole, int leaves, int panels, double rail, Glazing glazing,
                     double z, int detail) {
  const Bounds2 box = bounds_of(hole);
  std::vector<Outline> holes;
  std::vector<bool> is_glass;
  for (int k = 0; k < leaves; ++k) {
    const auto found =
        panels_of(between_x(hole, box.least.x + box.width() * k / leaves, box.least.x + box.width() * (k + 1) / leaves),
                  panels, rail);
    if (!found) return tl::unexpected(found.error());
    for (std::size_t p = 0; p < found->size(); ++p) {
      holes.push_back((*found)[p]);
      is_glass.push_back(glazing == Glazing::all || (glazing == Glazing::upper && p + 1 == found->size()));
    }
  }
  builder.begin_body();
  if (!builder.plate(hole, holes, z, Part::leaf)) return no_room("its leaves");
  for (std::size_t i = 0; i < holes.size(); ++i) {
    const double back = z - (detail == 0 ? kApart : is_glass[i] ? kGlassBack : kPanelBack);
    if (detail > 0) builder.recess(holes[i], z, back, Part::leaf);
    builder.plate(holes[i], {}, back, is_glass[i] ? Part::glass : Part::leaf);
    if (detail == 2 && !is_glass[i]) {
      const Outline field = inset(holes[i], 0.05);
      if (bounds_of(field).height() > kLeastPane && bounds_of(field).width() > kLeastPane)
        add_strip(builder, field, back + 0.010, back, Part::leaf);
    }
    builder.begin_body();
  }
  if (detail == 2 && leaves == 2) {
    const double x = (box.least.x + box.most.x) / 2;
    add_strip(builder, between_x(hole, x - 0.03, x + 0.03), z + 0.010, z, Part::leaf);
    // Handle and its plate.
    const double y = std::min(1.05, box.most.y * 0.5);
    builder.box({x + 0.05, y - 0.10, z}, {x + 0.09, y + 0.10, z + 0.008}, Part::metal, kBack);
    builder.box({x + 0.06, y - 0.01, z}, {x + 0.18, y + 0.01, z + 0.05}, Part::metal, kBack);
  }
  return {};
}

/// A single piece of glass with bars in a hole of the frame.
Made add_light(MeshBuilder& builder, const Outline& hole, const Bars& bars, double z, int detail) {
  const Bounds2 box = bounds_of(hole);
  if (hole.empty() || box.height() < kLeastPane || box.width() < kLeastPane) return no_room("its top light");
  const double glass = z - (detail == 0 ? kApart : kGlassBack);
  if (detail > 0) builder.recess(hole, z, glass, Part::frame);
  builder.begin_body();
  builder.plate(hole, {}, glass, Part::glass);
  if (detail == 0) return {};
  return add_bars(builder, hole, bars, z, glass, Part::frame);
}

/// The frame's inner edge: as wide as `frame` at the sides and above, a threshold below.
Outline door_hole(const Outline& outline, double frame) { return inset(with_foot(outline, kThreshold - frame), frame); }

}  // namespace

Made make_house_door(const Request& r, Element& element) {
  const Values& v = r.values;
  const OpeningShape shape = opening_shape(r);
  const auto outline = outline_of(shape);
  if (!outline) return tl::unexpected(outline.error());
  const double reveal = v.number("reveal"), frame = v.number("frame"), front = -reveal;
  element.opening = {*outline, reveal};
  const int detail = v.detail();
  const Outline inner = door_hole(*outline, frame);
  if (inner.empty()) return no_room("its frame");
  const double light = v.number("top_light");
  std::vector<Outline> holes{inner};
  if (light > 0) {
    const double middle = model::snap(r.height - light);
    holes = {between_y(inner, 0, middle - frame / 2), between_y(inner, middle + frame / 2, r.height)};
    if (holes[0].empty() || bounds_of(holes[0]).most.y < 1.6)
      return no_room("its leaves: they would be lower than 1.6 m");
    if (holes[1].empty()) return no_room("its top light");
  }
  MeshBuilder builder;
  builder.begin_body();
  if (!builder.plate(*outline, holes, front, Part::frame)) return no_room("its frame");
  const double leaf = front - (detail == 0 ? kApart : 2 * kLeafBack);
  if (detail > 0) builder.recess(holes[0], front, leaf, Part::frame);
  if (light > 0)
    if (Made made = add_light(builder, holes[1], {0, v.count("upright_bars"), v.number("bar")}, front, detail); !made)
      return made;
  const Glazing glazing = v.is("glazing", "all")     ? Glazing::all
                          : v.is("glazing", "upper") ? Glazing::upper
                                                     : Glazing::none;
  if (Made made = add_door_leaves(builder, holes[0], v.count("leaves"), v.count("panels"), v.number("rail"), glazing,
                                  leaf, detail);
      !made)
    return made;
  if (Made made = add_trim(builder, shape, *outline, reveal, v); !made) return made;
  element.mesh = builder.take();
  return {};
}

Made make_carriage_gateway(const Request& r, Element& element) {
  const Values& v = r.values;
  const OpeningShape shape = opening_shape(r);
  const auto outline = outline_of(shape);
  if (!outline) return tl::unexpected(outline.error());
  const double reveal = v.number("reveal"), frame = v.number("frame"), front = -reveal;
  element.opening = {*outline, reveal};
  const int detail = v.detail();
  const std::string& leaves = v.word("leaves");
  const bool fanlight = v.is("fanlight", "yes") && head_rise(shape) > 2 * frame + kLeastPane && leaves != "absent";
  const double spring = springing(shape);
  const Bars bars{0, v.count("upright_bars"), v.number("bar")};
  MeshBuilder builder;
  double leaf_top = fanlight ? spring - frame / 2 : shape.height;
  if (leaves == "closed") {
    const Outline inner = door_hole(*outline, frame);
    if (inner.empty()) return no_room("its frame");
    std::vector<Outline> holes{inner};
    if (fanlight) holes = {between_y(inner, 0, leaf_top), between_y(inner, spring + frame / 2, shape.height)};
    for (const Outline& hole : holes)
      if (hole.empty()) return no_room("its fanlight");
    builder.begin_body();
    if (!builder.plate(*outline, holes, front, Part::frame)) return no_room("its frame");
    const double leaf = front - (detail == 0 ? kApart : 2 * kLeafBack);
    if (detail > 0) builder.recess(holes[0], front, leaf, Part::frame);
    if (fanlight)
      if (Made made = add_light(builder, holes[1], bars, front, detail); !made) return made;
    if (Made made =
            add_door_leaves(builder, holes[0], 2, v.count("panels"), v.number("rail"), Glazing::none, leaf, detail);
        !made)
      return made;
  } else if (leaves == "open") {
    if (fanlight) {
      // The head alone is closed, above a transom that both leaves shut against.
      const Outline head = between_y(*outline, leaf_top, shape.height);
      const Outline hole = between_y(inset(*outline, frame), spring + frame / 2, shape.height);
      if (hole.empty()) return no_room("its fanlight");
      builder.begin_body();
      if (!builder.plate(head, std::span(&hole, 1), front, Part::frame)) return no_room("its frame");
      // The transom's underside is seen from below.
      const Bounds2 b = bounds_of(head);
      builder.face(std::array<model::Point3, 4>{{{b.least.x, leaf_top, front - 0.08},
                                                 {b.most.x, leaf_top, front - 0.08},
                                                 {b.most.x, leaf_top, front},
                                                 {b.least.x, leaf_top, front}}},
                   Part::frame);
      if (Made made = add_light(builder, hole, bars, front, detail); !made) return made;
    }
    // Leaves end where the opening begins to narrow; arches without a fanlight have leaves as high as the springing.
    const double top = std::min(leaf_top, spring) - 0.02, width = r.width / 2 - 0.05, thick = 0.06;
    const double z = front - 0.10;
    for (const double side : {-1.0, 1.0}) {
      const double far = side * (r.width / 2 - 0.02), near = side * (r.width / 2 - 0.02 - thick);
      builder.box({std::min(far, near), kThreshold, z - width}, {std::max(far, near), top, z}, Part::leaf);
    }
  }
  if (v.is("guards", "yes")) {
    // A stump at each jamb, half in the opening's corner: frustum on four sides.
    for (const double side : {-1.0, 1.0}) {
      const double x = side * (r.width / 2 + 0.05), z = 0.10, height = 0.55, foot = 0.16, head = 0.09;
      const Outline lower{{x - foot, -z - foot}, {x + foot, -z - foot}, {x + foot, -z + foot}, {x - foot, -z + foot}};
      const Outline upper{{x - head, -z - head}, {x + head, -z - head}, {x + head, -z + head}, {x - head, -z + head}};
      builder.begin_body();
      const auto at = [](Point2 p, double y) { return model::Point3{p.x, y, -p.y}; };
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        builder.face(
            std::array<model::Point3, 4>{at(lower[i], 0), at(lower[j], 0), at(upper[j], height), at(upper[i], height)},
            Part::surround);
      }
      builder.face(std::array<model::Point3, 4>{at(upper[0], height), at(upper[1], height), at(upper[2], height),
                                                at(upper[3], height)},
                   Part::surround);
      builder.face(std::array<model::Point3, 4>{at(lower[3], 0), at(lower[2], 0), at(lower[1], 0), at(lower[0], 0)},
                   Part::surround);
    }
  }
  if (Made made = add_trim(builder, shape, *outline, reveal, v); !made) return made;
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
