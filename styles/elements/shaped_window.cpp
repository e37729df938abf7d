// Windows whose four edges are drawn one by one (docs/sources.md, Finkenzeller 3.11): outlines need not be convex.
#include <array>
#include <string>
#include <utility>

#include "pipeline/geometry/ring_pieces.h"
#include "pipeline/model/vector.h"
#include "styles/elements/joinery.h"
#include "styles/elements/trim.h"

namespace blockrand::elements {
namespace {

using model::cross;
using model::dot;
using model::Point2;
using model::Point3;

tl::expected<Outline, std::string> outline_of(const Request& r) {
  const Values& v = r.values;
  const OpeningRectangle rectangle{-r.width / 2, 0, r.width / 2, r.height};
  OpeningEdges edges;
  if (v.is("outline", "circular")) {
    for (const std::size_t jamb : {1, 3}) {
      constexpr int kSteps[] = {3, 4, 6};  // straight pieces of a quarter circle by detail
      edges[jamb].dominant = true;
      edges[jamb].size = 0.5;
      edges[jamb].profile = trace(*parse_profile("Modifications { arc, abs, 0, 180, 1; }"), kSteps[v.detail()]);
    }
    return opening_outline(rectangle, edges, false);
  }
  constexpr const char* kNames[] = {"bottom", "right", "top", "left"};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string name = kNames[k];
    const bool level = k % 2 == 0;
    OpeningEdge& e = edges[k];
    e.dominant = level != v.is("dominant", "jambs");
    e.dist_left = v.number(name + (level ? "_left" : "_below"));
    e.dist_right = v.number(name + (level ? "_right" : "_above"));
    e.dist_inward = v.number(name + "_inward");
    e.size = v.number(name + "_size");
    e.profile = v.edge(name);
    if (e.profile && e.size == 0)
      return tl::unexpected("the " + name + " edge has a shape and no room for it: give " + name + "_size");
  }
  return opening_outline(rectangle, edges, false);
}

/// Does a band of that width round the outline keep clear of itself?
bool takes_band(const Outline& outline, double width) {
  const std::size_t n = outline.size();
  const auto normal = [&](std::size_t i) {
    const Point2 a = outline[i % n], b = outline[(i + 1) % n];
    const double length = model::distance(a, b);
    return Point2{(b.y - a.y) / length, -(b.x - a.x) / length};
  };
  Outline outer;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = normal(i + n - 1), b = normal(i);
    const double bend = 1 + dot(a, b);
    // Of 2: tips of about 65 degrees; where the outline turns in, bends of 60 degrees, or the band runs over itself.
    constexpr double kSharpestTip = 0.3, kSharpestHollow = 1.5;
    if (bend < (cross(a, b) > 0 ? kSharpestTip : kSharpestHollow)) return false;
    outer.push_back(outline[i] + (a + b) * (width / bend));
  }
  for (std::size_t i = 0; i < n; ++i)
    if (dot(outer[(i + 1) % n] - outer[i], outline[(i + 1) % n] - outline[i]) <= 0) return false;
  return is_simple(outer);
}

/// m² of a pane, or a piece of a bar, below which it is none.
constexpr double kLeastPiece = 0.0005;

}  // namespace

Made make_shaped_window(const Request& r, Element& element) {
  const Values& v = r.values;
  const auto outline = outline_of(r);
  if (!outline) return tl::unexpected(outline.error());
  const double reveal = v.number("reveal"), front = -reveal;
  element.opening = {*outline, reveal};
  const auto panes = geometry::drawn_in(*outline, v.number("frame"), kLeastPane * kLeastPane);
  if (panes.size() != 1) return no_room("its frame");
  const Outline& pane = panes[0];
  const bool flat = v.detail() == 0;
  const double glass = front - (flat ? kApart : kGlassBack);
  MeshBuilder builder;
  builder.begin_body();
  if (!builder.plate(*outline, std::span(&pane, 1), front, Part::frame)) return no_room("its frame");
  if (!flat) builder.recess(pane, front, glass, Part::frame);
  builder.begin_body();
  if (!builder.plate(pane, {}, glass, Part::glass)) return no_room("its pane");
  const Bounds2 box = bounds_of(pane);
  const double half = v.number("bar") / 2;
  const auto bar = [&](Point2 least, Point2 most, double z, bool upright) {
    if (flat) return;  // it would lie in the pane's plane
    const Outline strip{least, {most.x, least.y}, most, {least.x, most.y}};
    for (const Outline& piece : geometry::common_pieces(pane, strip, kLeastPiece)) {
      builder.begin_body();
      if (!builder.plate(piece, {}, z, Part::frame)) continue;
      // The long sides alone: the ends touch the frame.
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const Point2 a = piece[i], b = piece[(i + 1) % piece.size()];
        const bool long_side = upright ? a.x == b.x && (a.x == model::snap(least.x) || a.x == model::snap(most.x))
                                       : a.y == b.y && (a.y == model::snap(least.y) || a.y == model::snap(most.y));
        if (!long_side) continue;
        builder.face(std::array<Point3, 4>{{{a.x, a.y, glass}, {b.x, b.y, glass}, {b.x, b.y, z}, {a.x, a.y, z}}},
                     Part::frame);
      }
    }
  };
  const int upright = v.count("upright_bars"), level = v.count("bars");
  if (box.width() < (upright + 1) * (kLeastPane + 2 * half) || box.height() < (level + 1) * (kLeastPane + 2 * half))
    return no_room("so many bars");
  for (int k = 1; k <= upright; ++k) {
    const double x = box.least.x + box.width() * k / (upright + 1);
    bar({x - half, box.least.y - 1}, {x + half, box.most.y + 1}, front - kApart, true);
  }
  for (int k = 1; k <= level; ++k) {
    const double y = box.least.y + box.height() * k / (level + 1);
    bar({box.least.x - 1, y - half}, {box.most.x + 1, y + half}, front - 2 * kApart, false);
  }
  const bool whole_foot =
      (*outline)[0] == Point2{-model::snap(r.width / 2), 0} && (*outline)[1] == Point2{model::snap(r.width / 2), 0};
  if (!v.is("sill", "none") && !whole_foot)
    return tl::unexpected<std::string>("a sill wants a straight lower edge as wide as the opening");
  if (!v.is("surround", "none") && !takes_band(*outline, v.number("surround_width") + 2 * kApart))
    return no_room("a band round its edges");
  if (v.is("keystone", "yes") || v.is("surround", "double_cornice"))
    if (!v.is("outline", "circular") && v.number("top_inward") + v.number("top_size") > 0)
      return tl::unexpected<std::string>("keystones and double cornices want a straight upper edge or a circle");
  OpeningShape shape;
  shape.width = r.width;
  shape.height = r.height;
  if (Made made = add_trim(builder, shape, *outline, reveal, v); !made) return made;
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
