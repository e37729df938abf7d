// Bays (Erker): a body before the wall with windows of its own, on a corbel, under a roof of its own.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "styles/elements/joinery.h"
#include "styles/elements/sweep.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using model::Point3;

/// m. Storeys lower than this have no room for a window between sill and ceiling.
constexpr double kLeastStorey = 2.2;
/// m. How far the glass frames lie behind the bay's wall, and their width.
constexpr double kBayReveal = 0.08, kBayFrame = 0.06;
/// m. Windows narrower than this are left out at the cheeks and refused at the front.
constexpr double kLeastFront = 0.40, kLeastCheek = 0.30;

/// Corners of the bay in plan, x to the right and y out of the wall, from its left end at the wall to its right end.
using Plan = std::vector<Point2>;

/// The plan drawn together towards the middle of its back: edges stay parallel, so that what stands between is plane.
Plan drawn_together(const Plan& plan, double factor) {
  Plan out;
  for (const Point2 p : plan) out.push_back({p.x * factor, plan[0].y + (p.y - plan[0].y) * factor});
  return out;
}

/// A closed body between two plans of one shape, level below and above.
void frustum(MeshBuilder& builder, const Plan& low, double y0, const Plan& high, double y1, Part part) {
  builder.begin_body();
  const auto corner = [](Point2 p, double y) { return Point3{p.x, y, p.y}; };
  std::vector<Point3> cap;
  for (const Point2 p : high) cap.push_back(corner(p, y1));
  builder.face(cap, part);
  cap.clear();
  for (std::size_t i = low.size(); i-- > 0;) cap.push_back(corner(low[i], y0));
  builder.face(cap, part);
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t j = (i + 1) % low.size();
    builder.face(std::array{corner(low[i], y0), corner(low[j], y0), corner(high[j], y1), corner(high[i], y1)}, part);
  }
}

/// One wall of the bay: its own coordinates are u along it, y up, t out of it.
struct Panel {
  Point2 from, to;
  double length() const { return std::hypot(to.x - from.x, to.y - from.y); }
  Point3 at(double u, double y, double t) const {
    if (t == 0 && u == 0) return {from.x, y, from.y};
    const double l = length();
    if (t == 0 && u == l) return {to.x, y, to.y};
    const Point2 d{(to.x - from.x) / l, (to.y - from.y) / l};
    return {from.x + d.x * u - d.y * t, y, from.y + d.y * u + d.x * t};
  }
};

Outline rectangle(double u0, double y0, double u1, double y1) { return {{u0, y0}, {u1, y0}, {u1, y1}, {u0, y1}}; }

/// Faces of a panel at depth t: an outline with holes. \return false when they cross
bool plate(MeshBuilder& builder, const Panel& panel, const Outline& outer, std::span<const Outline> holes, double t,
           Part part) {
  std::vector<Point2> points;
  std::vector<std::vector<std::uint32_t>> loops;
  const auto add = [&](const Outline& outline, bool reversed) {
    auto& loop = loops.emplace_back();
    for (const Point2 p : outline) {
      loop.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(p);
    }
    if (reversed) std::reverse(loop.begin(), loop.end());
  };
  add(outer, false);
  for (const Outline& hole : holes) add(hole, true);
  const auto faces = convex_faces(points, loops);
  if (!faces) return false;
  for (const auto& f : *faces) {
    std::vector<Point3> corners;
    for (const std::uint32_t i : f) corners.push_back(panel.at(points[i].x, points[i].y, t));
    builder.face(corners, part);
  }
  return true;
}

/// The sides of a hole, from t_front to t_back.
void recess(MeshBuilder& builder, const Panel& panel, const Outline& hole, double t_front, double t_back, Part part) {
  for (std::size_t i = 0; i < hole.size(); ++i) {
    const Point2 a = hole[i], b = hole[(i + 1) % hole.size()];
    builder.face(std::array{panel.at(b.x, b.y, t_back), panel.at(a.x, a.y, t_back), panel.at(a.x, a.y, t_front),
                            panel.at(b.x, b.y, t_front)},
                 part);
  }
}

/// Lights of a window: a pair below the transom and one above; at detail 0 one.
std::vector<Outline> lights_of(const Outline& hole, int detail) {
  const Bounds2 b = bounds_of(hole);
  const double u0 = b.least.x + kBayFrame, u1 = b.most.x - kBayFrame;
  const double y0 = b.least.y + kBayFrame, y1 = b.most.y - kBayFrame;
  if (detail == 0 || u1 - u0 < 0.5) return {rectangle(u0, y0, u1, y1)};
  const double middle = (u0 + u1) / 2, transom = y0 + (y1 - y0) * 0.68;  // docs/style_measures.md 2.4: 0.62 to 0.70 of
                                                                         // the height
  return {rectangle(u0, y0, middle - kBayFrame / 2, transom - kBayFrame / 2),
          rectangle(middle + kBayFrame / 2, y0, u1, transom - kBayFrame / 2),
          rectangle(u0, transom + kBayFrame / 2, u1, y1)};
}

/// The wall of a panel with its windows, as part of the bay's one closed body.
Made add_panel(MeshBuilder& builder, const Panel& panel, double height, const std::vector<Outline>& holes, int detail) {
  const double front = -kBayReveal, back = front - (detail == 0 ? 0 : kGlassBack);
  if (!plate(builder, panel, rectangle(0, 0, panel.length(), height), holes, 0, Part::wall))
    return no_room("its windows");
  for (const Outline& hole : holes) {
    recess(builder, panel, hole, 0, front, Part::wall);
    const auto lights = lights_of(hole, detail);
    if (!plate(builder, panel, hole, lights, front, Part::frame)) return no_room("the lights of its windows");
    for (const Outline& light : lights) {
      if (detail > 0) recess(builder, panel, light, front, back, Part::frame);
      if (!plate(builder, panel, light, {}, back, Part::glass)) return no_room("its panes");
    }
  }
  return {};
}

std::vector<Outline> holes_of(double length, int across, double share, int storeys, double storey, double sill,
                              double high) {
  std::vector<Outline> out;
  const double width = length * share / across, gap = (length - width * across) / (across + 1);
  for (int s = 0; s < storeys; ++s)
    for (int k = 0; k < across; ++k) {
      const double u = gap + k * (width + gap), y = storey * (s + sill);
      out.push_back(rectangle(u, y, u + width, y + storey * high));
    }
  return out;
}

}  // namespace

Made make_bay(const Request& r, Element& element) {
  const Values& v = r.values;
  const int storeys = v.count("storeys"), across = v.count("windows"), detail = v.detail();
  const double depth = v.number("depth"), storey = r.height / storeys, share = v.number("window_share");
  if (storey < kLeastStorey)
    return tl::unexpected(fmt::format("storeys {:.2f} m high; a bay's have {} m at least", storey, kLeastStorey));
  const double half = r.width / 2;
  const double cheek = v.is("plan", "polygonal") ? std::min(depth * 0.7, r.width * 0.28) : 0;
  const Plan plan{{-half, -kApart}, {-half + cheek, depth}, {half - cheek, depth}, {half, -kApart}};
  MeshBuilder builder;

  // The body: three walls with windows, back, floor and ceiling.
  const std::array<Panel, 3> panels{{{plan[0], plan[1]}, {plan[1], plan[2]}, {plan[2], plan[3]}}};
  if (panels[1].length() * share / across < kLeastFront) return no_room("its windows side by side");
  builder.begin_body();
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double length = panels[i].length();
    const bool glazed = i == 1 || (v.is("cheek_windows", "yes") && length * share >= kLeastCheek);
    const auto holes = glazed ? holes_of(length, i == 1 ? across : 1, share, storeys, storey, v.number("sill"),
                                         v.number("window_height"))
                              : std::vector<Outline>{};
    if (Made made = add_panel(builder, panels[i], r.height, holes, detail); !made) return made;
  }
  const auto corner = [](Point2 p, double y) { return Point3{p.x, y, p.y}; };
  builder.face(std::array{corner(plan[3], 0), corner(plan[0], 0), corner(plan[0], r.height), corner(plan[3], r.height)},
               Part::wall);
  std::vector<Point3> cap;
  for (const Point2 p : plan) cap.push_back(corner(p, r.height));
  builder.face(cap, Part::wall);
  std::reverse(cap.begin(), cap.end());
  for (Point3& p : cap) p.y = 0;
  builder.face(cap, Part::wall);

  // What carries it. The upper edges lie within the body.
  const double base = v.number("base_height");
  if (v.is("base", "corbel") && base > 0) {
    const double waist = -base * 0.4;
    frustum(builder, drawn_together(plan, 0.72), waist, drawn_together(plan, 0.96), kApart, Part::surround);
    frustum(builder, drawn_together(plan, 0.25), -base, drawn_together(plan, 0.70), waist + kApart, Part::surround);
  } else if (v.is("base", "consoles") && base > 0) {
    for (const double side : {-1.0, 1.0})
      add_console(builder, side * (half - cheek - 0.20), kApart, 0.24, base, depth * 0.8, detail);
  }

  // Bands round it at the floors, and its roof.
  if (v.is("bands", "yes")) {
    const Profile profile = scaled_to_height(v.preset("string_course"), 0.20, 0.08);
    for (int s = 1; s < storeys; ++s) {
      // The ends reach into the wall, so that those of slanting cheeks do not gape.
      const std::vector<Point2> chain{{plan[0].x - (cheek > 0 ? 0.1 * cheek / depth : 0), 0.1},
                                      {plan[1].x, -plan[1].y},
                                      {plan[2].x, -plan[2].y},
                                      {plan[3].x + (cheek > 0 ? 0.1 * cheek / depth : 0), 0.1}};
      SweepOptions options;
      options.base = s * storey - 0.10;
      auto band = sweep(profile, chain, false, options);
      if (!band) return tl::unexpected(band.error());
      builder.append(band->mesh);
    }
  }
  const double roof = v.number("roof_height");
  const Plan eaves = drawn_together(plan, 1 + 0.12 / std::min(half, depth));
  const double foot = r.height - kApart, edge = r.height + 0.10;
  frustum(builder, eaves, foot, eaves, edge, Part::surround);
  const Plan sheet = drawn_together(plan, 1 + 0.15 / std::min(half, depth));
  if (v.is("roof", "hipped"))
    frustum(builder, sheet, edge - kApart, drawn_together(plan, 0.15), edge + roof, Part::metal);
  else
    frustum(builder, sheet, edge - kApart, drawn_together(plan, 1), edge + 0.06, Part::metal);
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
