// Surrounds, sills and pediments.
#include "styles/elements/trim.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/vector.h"
#include "styles/elements/sweep.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using model::Point3;

Point3 in_wall(double x, double y, double out) { return {x, y, out}; }

/// A section in (out of the wall, up) as one in (across the band, out of the wall), `from` the path.
Outline across(const Outline& section, double from) {
  Outline out;
  for (auto p = section.rbegin(); p != section.rend(); ++p) out.push_back({p->y + from, p->x});
  return out;
}

/// The path along an opening from its lower right corner over the head to its lower left one.
std::vector<Point2> path_round(const Outline& outline) {
  std::vector<Point2> path(outline.begin() + 1, outline.end());
  path.push_back(outline.front());
  return path;
}

Made swept(MeshBuilder& builder, const PathSweep& sweep, const char* what) {
  if (!add_sweep(builder, sweep)) return tl::unexpected(fmt::format("the {} has no room", what));
  return {};
}

/// Where the section goes per metre across at each point of a path: the bisectors.
std::vector<Point2> bisectors(const std::vector<Point2>& path, bool closed) {
  std::vector<Point2> out(path.size());
  const std::size_t n = path.size();
  const auto normal = [&](std::size_t i) {
    const Point2 a = path[i % n], b = path[(i + 1) % n];
    const double l = distance(b, a);
    return Point2{(b.y - a.y) / l, -(b.x - a.x) / l};
  };
  for (std::size_t i = 0; i < n; ++i) {
    const bool first = !closed && i == 0, last = !closed && i + 1 == n;
    const Point2 a = normal(first ? 0 : i + n - 1), b = normal(last ? n - 2 : i);
    const double c = a.x * b.x + a.y * b.y;
    out[i] = {(a.x + b.x) / (1 + c), (a.y + b.y) / (1 + c)};
  }
  return out;
}

/// y of the highest point of a band round an opening: mitres of gables and arcs reach higher than the band is wide.
double band_top(const Outline& outline, double width) {
  const std::vector<Point2> path = path_round(outline), offset = bisectors(path, false);
  double top = 0;
  for (std::size_t i = 0; i < path.size(); ++i) top = std::max(top, path[i].y + offset[i].y * (kApart + width));
  return top;
}

/// Stones along the edges of a path, standing out of a bed of mortar.
void add_stones(MeshBuilder& builder, const std::vector<Point2>& path, bool closed, double width, double length,
                double gap, double z_back, double z_front) {
  const std::vector<Point2> offset = bisectors(path, closed);
  const std::size_t n = path.size(), edges = closed ? n : n - 1;
  for (std::size_t e = 0; e < edges; ++e) {
    const Point2 a = path[e], b = path[(e + 1) % n], oa = offset[e], ob = offset[(e + 1) % n];
    const double whole = distance(b, a);
    const Point2 d{(b.x - a.x) / whole, (b.y - a.y) / whole}, normal{d.y, -d.x};
    // On arcs each piece of the arc is a wedge.
    const int count = std::max(1, static_cast<int>(std::lround(whole / length)));
    const auto at = [&](double s, double across_, double mitre) {
      return Point2{a.x + d.x * (s + mitre * across_) + normal.x * across_,
                    a.y + d.y * (s + mitre * across_) + normal.y * across_};
    };
    const double skew_a = oa.x * d.x + oa.y * d.y, skew_b = ob.x * d.x + ob.y * d.y;
    for (int k = 0; k < count; ++k) {
      const double from = whole * k / count + gap / 2, to = whole * (k + 1) / count - gap / 2;
      if (to - from < gap) continue;
      const double skew_from = k == 0 ? skew_a : 0, skew_to = k + 1 == count ? skew_b : 0;
      const double near = 2 * kApart, far = width;
      Outline stone{at(to, near, skew_to), at(from, near, skew_from), at(from, far, skew_from), at(to, far, skew_to)};
      if (signed_area(stone) < 0) std::reverse(stone.begin(), stone.end());
      builder.begin_body();
      builder.prism(stone, z_front, z_back, Part::surround);
    }
  }
}

/// y of the moulding's upper front edge: above it there is only the slope that sheds water.
double front_edge(const Profile& profile) {
  double y = 0;
  for (const Point2 p : profile.points)
    if (p.x >= profile.projection() - 1e-9) y = std::max(y, p.y);
  return y;
}

}  // namespace

OpeningShape opening_shape(const Request& r) {
  OpeningShape shape;
  shape.width = r.width;
  shape.height = r.height;
  if (r.values.has("head")) {
    const std::string& head = r.values.word("head");
    shape.head = head == "segmental" ? Head::segmental
                 : head == "round"   ? Head::round
                 : head == "gabled"  ? Head::gabled
                 : head == "pointed" ? Head::pointed
                 : head == "basket"  ? Head::basket
                                     : Head::straight;
    shape.rise = r.values.number("rise");
  }
  shape.chords = chords_at(r.values.detail(), r.width);
  return shape;
}

Made add_surround(MeshBuilder& builder, const OpeningShape& shape, const Outline& outline, const Values& v, bool foot) {
  const std::string& type = v.word("surround");
  const double width = v.number("surround_width"), projection = v.number("surround_projection");
  if (v.is("keystone", "yes")) {
    // It hangs a little into the opening: its underside is in no plane with the band's.
    const double half = std::min(0.09, shape.width / 8), low = shape.height - kApart,
                 top = band_top(outline, width) + 0.04;
    builder.prism({{-half, low}, {half, low}, {half * 1.4, top}, {-half * 1.4, top}}, projection + 0.03, -kApart,
                  Part::surround);
  }
  if (type == "none") return {};
  PathSweep band;
  band.place = in_wall;
  band.closed = foot;
  band.path = foot ? std::vector<Point2>(outline) : path_round(outline);
  const bool brick = type == "brick" && v.detail() > 0;
  const double out = brick ? std::max(projection - 0.012, 0.01) : projection;
  if (type == "moulded" && v.detail() > 0) {
    const auto section = section_of(scaled_to_height(v.profile("surround_profile"), width, projection));
    if (!section) return tl::unexpected<std::string>("surround: " + section.error());
    band.section = across(*section, kApart);
  } else {
    band.section = {{kApart, -kApart}, {kApart + width, -kApart}, {kApart + width, out}, {kApart, out}};
  }
  if (Made made = swept(builder, band, "surround"); !made) return made;
  if (brick)
    add_stones(builder, band.path, band.closed, width, v.number("stone_length"), v.number("stone_gap"), out - kApart,
               std::max(projection, out + 0.008));
  if (type == "double_cornice") {
    const double base = band_top(outline, width) + kApart + (v.is("keystone", "yes") ? 0.05 : 0);
    const double span = shape.width + 2 * (kApart + width) + 0.10, height = std::max(0.10, 0.7 * width);
    return add_pediment(builder, span, base, height,
                        shape.head == Head::straight || shape.head == Head::gabled ? "triangular" : "segmental", v);
  }
  return {};
}

Made add_sill(MeshBuilder& builder, double width, double top, double height, double overhang, double reveal,
              const Values& v, bool moulded) {
  const double projection = v.number("sill_projection");
  Profile profile;
  if (moulded && v.detail() > 0) {
    profile = scaled_to_height(v.profile("sill_profile"), height + kSillLip, projection);
    // A flat moulding is stretched to stand out as asked: water must drip clear of the wall.
    const double own = profile.projection();
    for (Point2& p : profile.points) p.x = p.x > 0 ? p.x * projection / own : p.x;
  } else {
    profile.points = {{0, 0}, {projection, 0}, {projection, height - kApart}, {0, height + kSillLip}};
  }
  const auto section = section_of(profile);
  if (!section) return tl::unexpected<std::string>("sill: " + section.error());
  const double half = width / 2 + overhang, base = top - height;
  PathSweep slab;
  slab.part = Part::sill;
  slab.section = *section;
  slab.path = {{-half, 0}, {half, 0}};
  slab.place = [base](double x, double y, double up) { return Point3{x, base + up, -y}; };
  if (Made made = swept(builder, slab, "sill"); !made) return made;
  if (reveal < 2 * kApart) return {};
  // The tongue runs a little into the wall on both sides and into the frame; its slope carries on the slab's, from
  // where the slab ends inside the wall.
  PathSweep tongue = slab;
  const double side = width / 2 + kApart, front = -kApart;
  tongue.section = {
      {-reveal - kApart, -0.02}, {front, -0.02}, {front, kSillLip - 0.002}, {-reveal - kApart, kSillLip + 0.006}};
  tongue.path = {{-side, 0}, {side, 0}};
  tongue.place = [top](double x, double y, double up) { return Point3{x, top + up, -y}; };
  return swept(builder, tongue, "sill");
}

Made add_pediment(MeshBuilder& builder, double span, double base, double height, std::string_view shape,
                  const Values& v) {
  const bool given = v.has("pediment_projection");
  const double projection = given ? v.number("pediment_projection") : std::max(0.08, height);
  const double rise = (v.has("pediment_rise") ? v.number("pediment_rise") : 0.22) * (span + 2 * projection);
  const Profile drawn = v.has("pediment_profile") ? v.profile("pediment_profile") : v.preset("hood");
  if (drawn.points.empty()) return tl::unexpected<std::string>("the library lacks the profile \"hood\"");
  const auto scaled = [&](double to_height, double out) {
    Profile p = scaled_to_height(drawn, to_height, out);
    const double own = p.projection();
    for (Point2& q : p.points) q.x = q.x > 0 ? q.x * out / own : q.x;
    return p;
  };
  const Profile level = scaled(height, projection);
  // Returned or cut, the cornice is as wide: its own projection more than the span at each end.
  const bool returned = v.detail() == 2;
  const double reach = span / 2 + projection, run = returned ? span / 2 : reach;
  SweepOptions options;
  options.base = base;
  options.ends = returned ? RunEnd::returned : RunEnd::cut;
  const auto straight = sweep(level, std::vector<Point2>{{-run, 0}, {run, 0}}, false, options);
  if (!straight) return tl::unexpected<std::string>("pediment: " + straight.error());
  builder.append(straight->mesh);
  if (v.has("pediment_consoles") && v.is("pediment_consoles", "yes")) {
    // They stand before the band and not in one plane with any of its faces.
    const bool banded = v.has("surround") && !v.is("surround", "none");
    const double band = banded ? v.number("surround_projection") : 0;
    const double out = clear_of(level, std::max(projection * 0.75, band + 0.03), 0, 0.3 * height);
    if (out > projection - kApart || out < band + kApart)
      return tl::unexpected(fmt::format("brackets want a pediment that stands out at least {:.2f} m", band + 0.06));
    const double width = std::min(0.14, span / 6);
    double edge = span / 2 - 0.02;
    const auto touches = [&](double x) {
      for (const Point3& p : builder.mesh().vertices)
        if (std::fabs(p.x - x) < kApart) return true;
      return false;
    };
    for (int tries = 0; tries < 40 && (touches(edge) || touches(edge - width)); ++tries) edge -= 0.004;
    for (const double side : {-1.0, 1.0})
      add_console(builder, side * (edge - width / 2), base + 0.3 * height, width, height * 1.8, out, v.detail());
  }
  if (shape == "straight") return {};

  const double foot = base + front_edge(level), half = reach - kApart;
  PathSweep raking;
  raking.place = in_wall;
  raking.mitre_limit = 6;
  const auto section = section_of(scaled(height * 0.8, projection - kApart));
  if (!section) return tl::unexpected<std::string>("pediment: " + section.error());
  raking.section = across(*section, 0);
  // The field ends where the raking cornice begins, and reaches into the level one, to no height of its members.
  double low = foot - kApart;
  const auto member = [&](double y) {
    for (const Point2 p : level.points)
      if (std::fabs(base + p.y - y) < kApart - 1e-9 && p.y < foot - base - 1e-9) return true;
    return false;
  };
  for (int tries = 0; tries < 20 && member(low); ++tries) low -= 0.001;
  Outline field{{-half, foot}, {-half, low}, {half, low}, {half, foot}};
  bool upright = true;
  if (shape == "triangular") {
    raking.path = {{half, foot}, {0, foot + rise}, {-half, foot}};
    field.push_back({0, foot + rise});
  } else {
    // The first piece of the arc must be longer than what the upright cut takes of it: else fewer pieces, and at last
    // ends that are cut square, within the same width.
    const double thick = bounds_of(raking.section).most.x;
    int chords = v.detail() == 2 ? 12 : v.detail() == 1 ? 6 : 3;
    double foot_half = half, radius = 0, from = 0;
    for (;; --chords) {
      if (chords < 3) {
        chords = 4;
        upright = false;
        foot_half = half - thick;
      }
      radius = (foot_half * foot_half + rise * rise) / (2 * rise);
      from = base::atan2(foot_half, radius - rise);
      const double turn = 2 * from / chords, piece = 2 * radius * base::sin(turn / 2);
      if (!upright || piece + thick * base::tan(turn / 2) > 1.1 * thick * base::tan(from - turn / 2)) break;
    }
    if (foot_half < rise)
      return tl::unexpected<std::string>("no room for a segmental gable so thick and high: make it lower");
    const double middle = foot + rise - radius;
    field = {{-foot_half, foot}, {-foot_half, low}, {foot_half, low}, {foot_half, foot}};
    for (int k = 0; k <= chords; ++k) {
      const auto turned = base::sin_cos(from * (1 - 2.0 * k / chords));
      raking.path.push_back({radius * turned.sin, middle + radius * turned.cos});
      if (k > 0 && k < chords) field.push_back(raking.path.back());
    }
  }
  const auto cut_upright = [](Point2 a, Point2 b) {
    const double l = distance(b, a);
    return Point2{0, l / -(b.x - a.x)};
  };
  if (upright) {
    raking.start = cut_upright(raking.path[0], raking.path[1]);
    raking.end = cut_upright(raking.path[raking.path.size() - 2], raking.path.back());
  }
  if (Made made = swept(builder, raking, "pediment"); !made) return made;
  if (v.detail() > 0) builder.prism(field, 3 * kApart, -kApart, Part::surround);
  return {};
}

Made add_trim(MeshBuilder& builder, const OpeningShape& shape, const Outline& outline, double reveal, const Values& v) {
  const bool has_sill = v.has("sill") && !v.is("sill", "none");
  const bool surrounded = !v.is("surround", "none");
  const bool pediment = v.has("pediment") && !v.is("pediment", "none");
  if (pediment && v.is("surround", "double_cornice"))
    return tl::unexpected<std::string>(
        "a surround of type double_cornice brings its own pediment: set pediment to none");
  if (Made made = add_surround(builder, shape, outline, v, v.has("sill") && !has_sill); !made) return made;
  const double beside = surrounded ? kApart + v.number("surround_width") : 0;
  if (has_sill) {
    // Jambs stand on the sill: their outer faces and its ends are not one plane.
    const double least = surrounded ? 2 * kApart : 0;
    const double overhang = std::max(v.number("sill_overhang"), least) + beside;
    if (Made made =
            add_sill(builder, shape.width, 0, v.number("sill_height"), overhang, reveal, v, v.is("sill", "moulded"));
        !made)
      return made;
  }
  if (pediment) {
    const double keystone = v.is("keystone", "yes") ? 0.05 : 0;
    const double head = surrounded || keystone > 0 ? band_top(outline, v.number("surround_width")) : shape.height;
    const double base = head + keystone + kApart + v.number("pediment_frieze");
    return add_pediment(builder, shape.width + 2 * (beside + v.number("pediment_overhang")), base,
                        v.number("pediment_height"), v.word("pediment"), v);
  }
  return {};
}

Made make_sill(const Request& r, Element& element) {
  MeshBuilder builder;
  if (Made made = add_sill(builder, r.width, r.height, r.height, r.values.number("sill_overhang"),
                           r.values.number("reveal"), r.values, r.values.is("sill", "moulded"));
      !made)
    return made;
  element.mesh = builder.take();
  return {};
}

Made make_surround(const Request& r, Element& element) {
  const OpeningShape shape = opening_shape(r);
  const auto outline = outline_of(shape);
  if (!outline) return tl::unexpected(outline.error());
  MeshBuilder builder;
  if (Made made = add_surround(builder, shape, *outline, r.values, r.values.is("foot", "closed")); !made) return made;
  element.mesh = builder.take();
  return {};
}

Made make_pediment(const Request& r, Element& element) {
  MeshBuilder builder;
  if (Made made = add_pediment(builder, r.width, 0, r.height, r.values.word("pediment"), r.values); !made) return made;
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
