// Casements, box windows, shop fronts, cellar windows and bare reveals.
#include <algorithm>
#include <vector>

#include "styles/elements/joinery.h"
#include "styles/elements/trim.h"

namespace blockrand::elements {
namespace {

using model::Point2;

/// A frame with its rows of leaves: below the transom and above it.
struct Sash {
  Outline inner;              ///< the frame's inner edge
  std::vector<Outline> rows;  ///< from below
};

tl::expected<Sash, std::string> sash_of(const Outline& outline, double height, double frame, double transom) {
  Sash sash;
  sash.inner = inset(outline, frame);
  if (sash.inner.empty()) return tl::unexpected<std::string>("no room for the frame");
  if (transom == 0) {
    sash.rows = {sash.inner};
    return sash;
  }
  const double middle = model::snap(transom * height);
  sash.rows = {between_y(sash.inner, -1, middle - frame / 2), between_y(sash.inner, middle + frame / 2, height + 1)};
  if (sash.rows[0].empty() || sash.rows[1].empty())
    return tl::unexpected<std::string>("no room above or below the transom");
  return sash;
}

Made add_window(const Request& r, Element& element, bool box) {
  const Values& v = r.values;
  const OpeningShape shape = opening_shape(r);
  const auto outline = outline_of(shape);
  if (!outline) return tl::unexpected(outline.error());
  const double reveal = v.number("reveal"), frame = v.number("frame"), stile = v.number("leaf");
  element.opening = {*outline, reveal};
  const auto sash = sash_of(*outline, shape.height, frame, v.number("transom"));
  if (!sash) return tl::unexpected(sash.error());
  const int detail = v.detail();
  const double front = -reveal, leaf = front - (detail == 0 ? 0 : kLeafBack);

  MeshBuilder builder;
  const bool flat = detail == 0;
  builder.begin_body();
  if (!builder.plate(*outline, sash->rows, front, Part::frame)) return no_room("the frame");
  if (!flat)
    for (const Outline& row : sash->rows) builder.recess(row, front, leaf, Part::frame);
  const int upper = v.count("upper_leaves") == 0 ? v.count("leaves") : v.count("upper_leaves");
  for (std::size_t i = 0; i < sash->rows.size(); ++i) {
    Leaves leaves;
    leaves.count = i == 0 ? v.count("leaves") : upper;
    leaves.stile = stile;
    leaves.bars = i == 0 ? Bars{v.count("bars"), v.count("upright_bars"), v.number("bar")}
                         : Bars{v.count("upper_bars"), v.count("upper_upright_bars"), v.number("bar")};
    // Flat leaves lie in the frame's plane: the same plate would do, but parts keep their names.
    leaves.z = leaf;
    leaves.sides = !flat;
    leaves.strips = detail == 2;
    if (Made made = add_leaves(builder, sash->rows[i], leaves); !made) return made;
    if (!box || flat) continue;
    const double inner = leaf - kGlassBack - v.number("gap");
    if (detail == 2) builder.begin_body();
    if (detail == 2) builder.recess(sash->rows[i], leaf - kGlassBack - kApart, inner, Part::frame);
    Leaves inside = leaves;
    inside.stile = stile + 0.01;
    inside.bars = {};
    inside.z = inner;
    inside.sides = detail == 2;
    inside.strips = false;
    if (Made made = add_leaves(builder, sash->rows[i], inside); !made) return made;
  }
  // The weathered bar on the transom, where it stays behind the wall.
  if (detail == 2 && sash->rows.size() == 2 && reveal >= 0.03) {
    const Bounds2 below = bounds_of(sash->rows[0]), above = bounds_of(sash->rows[1]);
    const double half = below.most.x;
    builder.box({-half, below.most.y + 0.01, front}, {half, above.least.y - 0.01, front + 0.02}, Part::frame, kBack);
  }
  if (Made made = add_trim(builder, shape, *outline, reveal, v); !made) return made;
  element.mesh = builder.take();
  return {};
}

}  // namespace

Made make_casement_window(const Request& r, Element& element) { return add_window(r, element, false); }
Made make_double_casement(const Request& r, Element& element) { return add_window(r, element, true); }

Made make_shop_window(const Request& r, Element& element) {
  const Values& v = r.values;
  OpeningShape shape;
  shape.width = r.width;
  shape.height = r.height;
  const Outline outline = *outline_of(shape);
  const double reveal = v.number("reveal"), frame = v.number("frame"), front = -reveal;
  element.opening = {outline, reveal};
  const int detail = v.detail();
  const double left = -r.width / 2 + frame, right = r.width / 2 - frame;
  const double transom = v.number("transom") * r.height, top = r.height - frame;
  const double light_top = transom > 0 ? transom - frame / 2 : top;
  const double base = v.number("base") > 0 ? v.number("base") : frame;

  // Columns of panes; one of them may be the door.
  struct Column {
    double from, to;
    bool door;
  };
  std::vector<Column> columns;
  const int panes = v.count("mullions") + 1;
  const auto divide = [&](double from, double to, int count) {
    for (int k = 0; k < count; ++k) {
      const double step = (to - from + frame) / count;
      columns.push_back({from + step * k, from + step * (k + 1) - frame, false});
    }
  };
  const std::string& door = v.word("door");
  const double door_width = v.number("door_width");
  if (door == "none") {
    divide(left, right, panes);
  } else if (door == "left") {
    columns.push_back({left, left + door_width, true});
    divide(left + door_width + frame, right, panes);
  } else if (door == "right") {
    divide(left, right - door_width - frame, panes);
    columns.push_back({right - door_width, right, true});
  } else {
    divide(left, -door_width / 2 - frame, (panes + 1) / 2);
    columns.push_back({-door_width / 2, door_width / 2, true});
    divide(door_width / 2 + frame, right, (panes + 1) / 2);
  }
  const auto rectangle = [](double x0, double y0, double x1, double y1) {
    return Outline{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  };
  constexpr double kThreshold = 0.02;
  std::vector<Outline> glass, aprons, doors, lights;
  for (const Column& c : columns) {
    if (c.to - c.from < 0.2) return no_room("its panes: fewer mullions, or a narrower door");
    if (c.door) {
      if (light_top < 1.8) return no_room("its door below the transom");
      doors.push_back(rectangle(c.from, kThreshold, c.to, light_top));
    } else {
      if (light_top - base < 0.3) return no_room("glass between base and transom");
      glass.push_back(rectangle(c.from, base, c.to, light_top));
      if (base > frame + kThreshold + kLeastPane) aprons.push_back(rectangle(c.from, kThreshold, c.to, base - frame));
    }
    if (transom > 0) {
      if (top - transom - frame / 2 < kLeastPane) return no_room("lights above the transom");
      lights.push_back(rectangle(c.from, transom + frame / 2, c.to, top));
    }
  }
  std::vector<Outline> holes = glass;
  for (const auto* more : {&aprons, &doors, &lights}) holes.insert(holes.end(), more->begin(), more->end());
  MeshBuilder builder;
  builder.begin_body();
  if (!builder.plate(outline, holes, front, Part::frame)) return no_room("its frame");
  const double back = front - (detail == 0 ? kApart : 0.05), apron_back = front - (detail == 0 ? kApart : 0.02);
  for (const Outline& hole : holes)
    if (detail > 0 && std::find(aprons.begin(), aprons.end(), hole) == aprons.end() &&
        std::find(doors.begin(), doors.end(), hole) == doors.end())
      builder.recess(hole, front, back, Part::frame);
  for (const Outline& hole : aprons)
    if (detail > 0) builder.recess(hole, front, apron_back, Part::frame);
  for (const Outline& hole : doors)
    if (detail > 0) builder.recess(hole, front, front - kLeafBack, Part::frame);
  for (const auto* list : {&glass, &lights})
    for (const Outline& hole : *list) {
      builder.begin_body();
      builder.plate(hole, {}, back, Part::glass);
    }
  for (const Outline& hole : aprons) {
    builder.begin_body();
    builder.plate(hole, {}, apron_back, Part::panel);
    if (detail == 2) {
      const Outline field = inset(hole, 0.08);
      if (bounds_of(field).height() > kLeastPane) add_strip(builder, field, apron_back + 0.01, apron_back, Part::panel);
    }
  }
  for (const Outline& hole : doors) {
    const double z = front - (detail == 0 ? kApart : kLeafBack);
    const Bounds2 b = bounds_of(hole);
    const Outline pane = rectangle(b.least.x + 0.10, b.least.y + 0.25, b.most.x - 0.10, b.most.y - 0.10);
    builder.begin_body();
    if (!builder.plate(hole, std::span(&pane, 1), z, Part::leaf)) return no_room("its door");
    if (detail > 0) builder.recess(pane, z, z - kGlassBack, Part::leaf);
    builder.begin_body();
    builder.plate(pane, {}, z - (detail > 0 ? kGlassBack : kApart), Part::glass);
  }
  const double sign = v.number("sign");
  double sign_base = r.height + 2 * kApart;
  if (!v.is("surround", "none")) sign_base += kApart + v.number("surround_width");
  if (sign > 0) {
    if (v.is("surround", "double_cornice") || v.is("keystone", "yes"))
      return tl::unexpected<std::string>("a sign has no room over a keystone or a double cornice: set sign to 0");
    const double half = r.width / 2 + v.number("sign_overhang");
    builder.box({-half, sign_base, -kApart}, {half, sign_base + sign, v.number("sign_projection")}, Part::panel);
  }
  if (Made made = add_trim(builder, shape, outline, reveal, v); !made) return made;
  element.mesh = builder.take();
  return {};
}

Made make_cellar_window(const Request& r, Element& element) {
  const Values& v = r.values;
  const OpeningShape shape = opening_shape(r);
  const auto outline = outline_of(shape);
  if (!outline) return tl::unexpected(outline.error());
  const double reveal = v.number("reveal"), front = -reveal;
  element.opening = {*outline, reveal};
  const int detail = v.detail();
  const Outline inner = inset(*outline, v.number("frame"));
  if (inner.empty()) return no_room("the frame");
  MeshBuilder builder;
  builder.begin_body();
  if (!builder.plate(*outline, std::span(&inner, 1), front, Part::frame)) return no_room("the frame");
  if (detail > 0) builder.recess(inner, front, front - kLeafBack, Part::frame);
  Leaves leaves;
  leaves.count = v.count("leaves");
  leaves.stile = 0.03;
  leaves.z = front - (detail > 0 ? kLeafBack : 0);
  leaves.sides = detail > 0;
  if (Made made = add_leaves(builder, inner, leaves); !made) return made;
  const int bars = v.count("grille");
  if (bars > 0 && detail > 0) {
    constexpr double kIron = 0.018;
    const double step = r.width / (bars + 1);
    if (step < 2 * kIron) return no_room("so many iron bars");
    const double middle = front + std::min(0.06, reveal / 2);
    for (int k = 1; k <= bars; ++k) {
      const double x = -r.width / 2 + step * k;
      const Outline cut = between_x(*outline, x - kIron / 2, x + kIron / 2);
      // Ends sit in the wall.
      builder.box({x - kIron / 2, -kApart, middle - kIron / 2},
                  {x + kIron / 2, bounds_of(cut).most.y + kApart, middle + kIron / 2}, Part::metal,
                  kTop | kBottom | (detail == 1 ? kBack : 0u));
    }
  }
  if (Made made = add_trim(builder, shape, *outline, reveal, v); !made) return made;
  element.mesh = builder.take();
  return {};
}

Made make_reveal(const Request& r, Element& element) {
  const Values& v = r.values;
  const OpeningShape shape = opening_shape(r);
  const auto outline = outline_of(shape);
  if (!outline) return tl::unexpected(outline.error());
  element.opening = {*outline, v.number("reveal")};
  MeshBuilder builder;
  if (v.is("filling", "blind")) builder.plate(*outline, {}, -v.number("reveal"), Part::wall);
  if (Made made = add_trim(builder, shape, *outline, v.number("reveal"), v); !made) return made;
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
