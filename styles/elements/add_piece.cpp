// Makes the faces of pieces of element files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/text.h"
#include "pipeline/model/vector.h"
#include "styles/elements/element_piece.h"
#include "styles/elements/joinery.h"
#include "styles/elements/sweep.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using model::Point3;

/// m from the element's origin, farther than which nothing reasonable lies: quoins go up to 320 m.
constexpr double kFarthest = 1000;
/// m behind the wall's plane, from which windows and doors have no backs: what lies there is joinery.
constexpr double kBackless = 0.03;

struct Range {
  double from = 0, to = 0;
};

tl::expected<double, std::string> metres(const Expression& e, std::span<const double> values, std::string_view what) {
  const double v = e.value(values);
  if (!(std::fabs(v) <= kFarthest))
    return tl::unexpected(fmt::format("{} is {} m", what, std::isfinite(v) ? base::shortest(v) : "no number of"));
  return model::snap(v);
}

tl::expected<Range, std::string> range(const Measures& m, std::span<const double> values, std::string_view what) {
  const auto from = metres(m[0], values, what), to = metres(m[1], values, what);
  if (!from || !to) return tl::unexpected(from ? to.error() : from.error());
  if (!(*from < *to))
    return tl::unexpected(
        fmt::format("{} goes from {} to {} m, which leaves nothing", what, base::shortest(*from), base::shortest(*to)));
  return Range{*from, *to};
}

/// A body over a polygon of the plane (p, q) between two values of r, sharing corners with nothing else.
template <class Place>
Made add_prism(MeshBuilder& builder, const Outline& outline, Range r, bool back, bool sides, Part part,
               const Place& place) {
  std::vector<std::uint32_t> loop(outline.size());
  for (std::uint32_t i = 0; i < loop.size(); ++i) loop[i] = i;
  const auto faces = convex_faces(outline, std::span(&loop, 1));
  if (!faces || !is_simple(outline)) return tl::unexpected<std::string>("its edges cross or touch");
  builder.begin_body();
  std::vector<Point3> corners;
  const auto add = [&](const std::vector<std::uint32_t>& face, double at) {
    corners.clear();
    for (const std::uint32_t i : face) corners.push_back(place(outline[i].x, outline[i].y, at));
  };
  for (const auto& face : *faces) {
    add(face, r.to);
    builder.face(corners, part);
    if (!back) continue;
    add(face, r.from);
    std::reverse(corners.begin(), corners.end());
    builder.face(corners, part);
  }
  if (!sides) return {};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2 a = outline[i], b = outline[(i + 1) % outline.size()];
    builder.face(std::array<Point3, 4>{{place(a.x, a.y, r.from), place(b.x, b.y, r.from), place(b.x, b.y, r.to),
                                        place(a.x, a.y, r.to)}},
                 part);
  }
  return {};
}

bool has_back(const Element& element, double z) {
  return element.semantic == ElementClass::installation || z > -kBackless;
}

Made add_box(MeshBuilder& builder, const Piece& piece, std::span<const double> values, const Element& element) {
  const auto x = range(piece.x, values, "x"), y = range(piece.y, values, "y"), z = range(piece.z, values, "z");
  for (const auto* r : {&x, &y, &z})
    if (!*r) return tl::unexpected(r->error());
  builder.box({x->from, y->from, z->from}, {x->to, y->to, z->to}, piece.part, has_back(element, z->from) ? 0 : kBack);
  return {};
}

Made add_polygon(MeshBuilder& builder, const Piece& piece, std::span<const double> values, const Element& element) {
  const auto outline = polygon_of(piece.points, values);
  if (!outline) return tl::unexpected(outline.error());
  const auto place = [](double p, double q, double r) { return Point3{p, q, r}; };
  if (piece.flat) {
    if (element.semantic == ElementClass::installation)
      return tl::unexpected<std::string>("what stands on a wall is a body: give z = [back, front]");
    const auto z = metres(piece.z[0], values, "z");
    if (!z) return tl::unexpected(z.error());
    return add_prism(builder, *outline, {*z, *z}, false, false, piece.part, place);
  }
  const auto z = range(piece.z, values, "z");
  if (!z) return tl::unexpected(z.error());
  return add_prism(builder, *outline, *z, has_back(element, z->from), true, piece.part, place);
}

Made add_section(MeshBuilder& builder, const Piece& piece, std::span<const double> values) {
  const auto x = range(piece.x, values, "x");
  if (!x) return tl::unexpected(x.error());
  auto outline = polygon_of(piece.points, values);
  if (!outline) return tl::unexpected(outline.error());
  // Seen from its right end, the wall's inside lies on the right.
  for (Point2& p : *outline) p.x = -p.x;
  std::reverse(outline->begin(), outline->end());
  return add_prism(builder, *outline, *x, true, true, piece.part, [](double p, double q, double r) {
    return Point3{r, q, -p};
  });
}

Made add_ring(MeshBuilder& builder, const Piece& piece, std::span<const double> values, const Element& element) {
  const Outline& outline = element.opening.outline;
  if (outline.empty()) return tl::unexpected<std::string>("only windows and doors have an outline");
  const auto width = metres(piece.width, values, "width");
  if (!width) return tl::unexpected(width.error());
  const auto z = range(piece.z, values, "z");
  if (!z) return tl::unexpected(z.error());
  if (*width <= 0) return tl::unexpected<std::string>("the ring has no width");
  Outline inner = inset(outline, *width);
  for (Point2& p : inner) p = model::snap(p);
  if (inner.empty() || signed_area(inner) < kLeastPane * kLeastPane)
    return tl::unexpected<std::string>("the ring leaves no room within it");
  builder.begin_body();
  if (!builder.plate(outline, std::span(&inner, 1), z->to, piece.part))
    return tl::unexpected<std::string>("the ring's edges cross");
  builder.recess(inner, z->to, z->from, piece.part);
  // Before the wall its outer sides are seen too.
  if (z->to > 0) builder.rim(outline, z->to, std::max(z->from, -kApart), piece.part);
  return {};
}

Made add_moulding(MeshBuilder& builder, const Piece& piece, std::span<const double> values, const Values& given) {
  const auto height = metres(piece.height, values, "height"), out = metres(piece.projection, values, "projection");
  if (!height || !out) return tl::unexpected(height ? out.error() : height.error());
  if (*height <= 0 || *out <= 0) return tl::unexpected<std::string>("the moulding has no height or no projection");
  const Profile drawn = piece.profile.empty() ? given.traced(piece.program) : given.preset(piece.profile);
  const auto section = section_of(scaled_to_height(drawn, *height, *out));
  if (!section) return tl::unexpected(section.error());
  const auto path = places_of(piece.points, values);
  if (!path) return tl::unexpected(path.error());
  PathSweep sweep;
  // (out of the wall, up) becomes (right of the path, out of the wall): up is on the left.
  for (const Point2 p : *section) sweep.section.push_back({-p.y, p.x});
  sweep.path = *path;
  sweep.part = piece.part;
  sweep.place = [](double x, double y, double z) { return Point3{x, y, z}; };
  const auto made = add_sweep(builder, sweep);
  if (!made) return tl::unexpected<std::string>("its path has no length");
  if (!made->empty())
    return tl::unexpected(fmt::format("at point {} its path is too short for a mitre", made->front() + 1));
  return {};
}

Made add_one(MeshBuilder& builder, const Piece& piece, std::span<const double> values, const Element& element,
             const Values& given) {
  if (piece.when && !(piece.when->value(values) > 0)) return {};
  switch (piece.form) {
    case Piece::Form::box:
      return add_box(builder, piece, values, element);
    case Piece::Form::polygon:
      return add_polygon(builder, piece, values, element);
    case Piece::Form::section:
      return add_section(builder, piece, values);
    case Piece::Form::ring:
      return add_ring(builder, piece, values, element);
    case Piece::Form::moulding:
      return add_moulding(builder, piece, values, given);
  }
  return {};
}

}  // namespace

tl::expected<Outline, std::string> places_of(std::span<const Measures> places, std::span<const double> values) {
  Outline out;
  for (const Measures& m : places) {
    const auto a = metres(m[0], values, "a point"), b = metres(m[1], values, "a point");
    if (!a || !b) return tl::unexpected(a ? b.error() : a.error());
    if (out.empty() || out.back() != Point2{*a, *b}) out.push_back({*a, *b});
  }
  return out;
}

tl::expected<Outline, std::string> polygon_of(std::span<const Measures> places, std::span<const double> values) {
  auto out = places_of(places, values);
  if (!out) return out;
  // Exact: all lies on the grid.
  for (std::size_t i = 0; i < out->size() && out->size() > 2;) {
    const std::size_t n = out->size();
    const Point2 a = (*out)[(i + n - 1) % n], b = (*out)[i], c = (*out)[(i + 1) % n];
    if (model::cross(b - a, c - b) == 0) {
      out->erase(out->begin() + static_cast<std::ptrdiff_t>(i));
      i = i > 0 ? i - 1 : 0;
    } else {
      ++i;
    }
  }
  if (out->size() < 3 || signed_area(*out) == 0) return tl::unexpected<std::string>("it has no area");
  if (signed_area(*out) < 0) std::reverse(out->begin(), out->end());
  return out;
}

Made add_piece(MeshBuilder& builder, const Piece& piece, std::span<double> values, const Element& element,
               const Values& given) {
  double& i = values[values.size() - 2];
  double& n = values[values.size() - 1];
  n = 1;
  i = 0;
  if (piece.count) {
    // Sizes that divide evenly on paper miss by a rounding.
    n = std::floor(piece.count->value(values) + 1e-9);
    if (!(n <= static_cast<double>(kMostRepeats)))
      return tl::unexpected(std::isnan(n) ? "count is no number" : fmt::format("count is more than {}", kMostRepeats));
  }
  for (; i < n; ++i) {
    Made made = add_one(builder, piece, values, element, given);
    if (made && builder.mesh().faces.size() > kMostFaces)
      made = tl::unexpected(fmt::format("the element has more than {} faces", kMostFaces));
    if (made) continue;
    if (!piece.count) return made;
    return tl::unexpected(fmt::format("{} (i = {} of n = {})", made.error(), i, n));
  }
  return {};
}

}  // namespace blockrand::elements
