#include "tests/unit/geometry/broken_solids.h"

#include <algorithm>
#include <functional>

namespace blockrand::testing_shapes {

using geometry::SolidBuilder;
using model::Face;
using model::Point3;
using model::Solid;
using model::SurfaceKind;

namespace {

Face face(SurfaceKind kind) {
  Face f;
  f.kind = kind;
  return f;
}

/// Prism over a horizontal loop.
Solid prism(const std::vector<Point3>& loop, double height) {
  SolidBuilder b;
  b.add_face(std::vector<Point3>(loop.rbegin(), loop.rend()), face(SurfaceKind::ground));
  std::vector<Point3> top = loop;
  for (Point3& p : top) p.z += height;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t j = (i + 1) % loop.size();
    b.add_face({loop[i], loop[j], top[j], top[i]}, face(SurfaceKind::wall));
  }
  b.add_face(top, face(SurfaceKind::roof));
  return b.take();
}

/// The solid with its loops rewritten by `change`, faces otherwise as they are.
Solid rebuilt(const Solid& solid,
              const std::function<void(std::vector<std::vector<std::vector<std::uint32_t>>>&)>& change) {
  std::vector<std::vector<std::vector<std::uint32_t>>> faces;
  for (const Face& f : solid.faces) {
    auto& loops = faces.emplace_back();
    for (const auto& loop : solid.loops_of(f)) {
      const auto indices = solid.indices_of(loop);
      loops.emplace_back(indices.begin(), indices.end());
    }
  }
  change(faces);
  Solid out;
  out.vertices = solid.vertices;
  for (const auto& loops : faces) {
    Face f = face(SurfaceKind::wall);
    f.first_loop = static_cast<std::uint32_t>(out.loops.size());
    f.loop_count = static_cast<std::uint32_t>(loops.size());
    for (const auto& loop : loops) {
      out.loops.push_back({static_cast<std::uint32_t>(out.indices.size()), static_cast<std::uint32_t>(loop.size())});
      out.indices.insert(out.indices.end(), loop.begin(), loop.end());
    }
    out.faces.push_back(f);
  }
  return out;
}

/// Both solids in one, vertices at equal places shared when `weld`.
Solid joined(const Solid& a, const Solid& b, bool weld) {
  Solid out = a;
  std::vector<std::uint32_t> index;
  for (const Point3 p : b.vertices) {
    const auto found = std::find(out.vertices.begin(), out.vertices.end(), p);
    if (weld && found != out.vertices.end()) {
      index.push_back(static_cast<std::uint32_t>(found - out.vertices.begin()));
    } else {
      index.push_back(static_cast<std::uint32_t>(out.vertices.size()));
      out.vertices.push_back(p);
    }
  }
  for (Face f : b.faces) {
    const auto loops = b.loops_of(f);
    f.first_loop = static_cast<std::uint32_t>(out.loops.size());
    for (const auto& loop : loops) {
      out.loops.push_back({static_cast<std::uint32_t>(out.indices.size()), loop.count});
      for (const std::uint32_t i : b.indices_of(loop)) out.indices.push_back(index[i]);
    }
    out.faces.push_back(f);
  }
  return out;
}

}  // namespace

Solid box(Point3 at, double width, double depth, double height) {
  return prism({at, {at.x + width, at.y, at.z}, {at.x + width, at.y + depth, at.z}, {at.x, at.y + depth, at.z}},
               height);
}

Solid gabled_house(Point3 at, double width, double depth, double eaves, double ridge) {
  SolidBuilder b;
  const double x0 = at.x, x1 = at.x + width, y0 = at.y, y1 = at.y + depth, ym = at.y + depth / 2;
  const double z0 = at.z, e = at.z + eaves, r = at.z + ridge;
  b.add_face({{x0, y1, z0}, {x1, y1, z0}, {x1, y0, z0}, {x0, y0, z0}}, face(SurfaceKind::ground));
  b.add_face({{x0, y0, z0}, {x1, y0, z0}, {x1, y0, e}, {x0, y0, e}}, face(SurfaceKind::wall));
  b.add_face({{x1, y0, z0}, {x1, y1, z0}, {x1, y1, e}, {x1, ym, r}, {x1, y0, e}}, face(SurfaceKind::wall));
  b.add_face({{x1, y1, z0}, {x0, y1, z0}, {x0, y1, e}, {x1, y1, e}}, face(SurfaceKind::wall));
  b.add_face({{x0, y1, z0}, {x0, y0, z0}, {x0, y0, e}, {x0, ym, r}, {x0, y1, e}}, face(SurfaceKind::wall));
  b.add_face({{x0, y0, e}, {x1, y0, e}, {x1, ym, r}, {x0, ym, r}}, face(SurfaceKind::roof));
  b.add_face({{x1, y1, e}, {x0, y1, e}, {x0, ym, r}, {x1, ym, r}}, face(SurfaceKind::roof));
  return b.take();
}

Solid courtyard_block(Point3 at, double outer, double inner, double height) {
  SolidBuilder b;
  const double m = (outer - inner) / 2;
  const auto square = [&](double inset, double side, double z) {
    return std::vector<Point3>{{at.x + inset, at.y + inset, z},
                               {at.x + inset + side, at.y + inset, z},
                               {at.x + inset + side, at.y + inset + side, z},
                               {at.x + inset, at.y + inset + side, z}};
  };
  const auto reversed = [](std::vector<Point3> v) {
    std::reverse(v.begin(), v.end());
    return v;
  };
  const double z0 = at.z, z1 = at.z + height;
  b.add_face(std::vector{reversed(square(0, outer, z0)), square(m, inner, z0)}, face(SurfaceKind::ground));
  b.add_face(std::vector{square(0, outer, z1), reversed(square(m, inner, z1))}, face(SurfaceKind::roof));
  const auto walls = [&](const std::vector<Point3>& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 a = loop[i], c = loop[(i + 1) % loop.size()];
      b.add_face({a, c, {c.x, c.y, z1}, {a.x, a.y, z1}}, face(SurfaceKind::wall));
    }
  };
  walls(square(0, outer, z0));
  walls(reversed(square(m, inner, z0)));
  return b.take();
}

namespace {

const Point3 kFar{391000, 5819000, 34};
constexpr double kStep = 1.0 / 1024;  // m
using Plan = std::vector<model::Point2>;

/// Clockwise, as holes run.
Plan hole(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x0, y1}, {x1, y1}, {x1, y0}}; }
Plan turned(Plan plan) {
  std::reverse(plan.begin(), plan.end());
  return plan;
}

/// A prism of 6 m over a plan with holes. `change` may rewrite the rings of the roof alone, which comes last.
Solid shafts(const Plan& outer, const std::vector<Plan>& holes,
             const std::function<void(std::vector<std::vector<Point3>>&)>& change = {}) {
  SolidBuilder b;
  const auto at = [](const Plan& plan, double z) {
    std::vector<Point3> out;
    for (const model::Point2 p : plan) out.push_back({kFar.x + p.x, kFar.y + p.y, kFar.z + z});
    return out;
  };
  std::vector<std::vector<Point3>> floor{at(turned(outer), 0)}, roof{at(outer, 6)};
  for (const Plan& h : holes) {
    floor.push_back(at(turned(h), 0));
    roof.push_back(at(h, 6));
  }
  b.add_face(floor, face(SurfaceKind::ground));
  const auto walls = [&](const Plan& plan) {
    const auto low = at(plan, 0), high = at(plan, 6);
    for (std::size_t i = 0; i < plan.size(); ++i) {
      const std::size_t j = (i + 1) % plan.size();
      b.add_face({low[i], low[j], high[j], high[i]}, face(SurfaceKind::wall));
    }
  };
  walls(outer);
  for (const Plan& h : holes) walls(h);
  if (change) change(roof);
  b.add_face(roof, face(SurfaceKind::roof));
  return b.take();
}

/// A flat roof whose right half lies `steps` grid steps higher, behind a step 4 grid steps wide: one face.
Solid stepped_roof(int steps) {
  const double x = 5, w = 4 * kStep, up = steps * kStep;
  const Plan plan{{0, 0}, {x, 0}, {x + w, 0}, {10, 0}, {10, 8}, {x + w, 8}, {x, 8}, {0, 8}};
  SolidBuilder b;
  std::vector<Point3> low, high;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const bool right = i >= 2 && i <= 5;
    low.push_back({kFar.x + plan[i].x, kFar.y + plan[i].y, kFar.z});
    high.push_back({kFar.x + plan[i].x, kFar.y + plan[i].y, kFar.z + 6 + (right ? up : 0)});
  }
  b.add_face(std::vector<Point3>(low.rbegin(), low.rend()), face(SurfaceKind::ground));
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const std::size_t j = (i + 1) % plan.size();
    b.add_face({low[i], low[j], high[j], high[i]}, face(SurfaceKind::wall));
  }
  b.add_face(high, face(SurfaceKind::roof));
  return b.take();
}

/// A box of 6 m under a pyramid whose tip is `tip` metres up.
Solid pyramid(double tip) {
  const Solid walls = box(kFar, 10, 8, 6);
  SolidBuilder b;
  for (std::size_t f = 0; f < walls.faces.size(); ++f) {
    std::vector<Point3> loop;
    for (const auto i : walls.indices_of(walls.loops_of(walls.faces[f])[0])) loop.push_back(walls.vertices[i]);
    if (f + 1 < walls.faces.size()) {
      b.add_face(loop, walls.faces[f]);
      continue;
    }
    for (std::size_t i = 0; i < loop.size(); ++i)
      b.add_face({loop[i], loop[(i + 1) % loop.size()], {kFar.x + 5, kFar.y + 4, kFar.z + tip}},
                 face(SurfaceKind::roof));
  }
  return b.take();
}

Solid tetrahedron() {
  SolidBuilder b;
  const Point3 p{kFar.x, kFar.y, kFar.z}, q{p.x + 4, p.y, p.z}, r{p.x, p.y + 4, p.z}, s{p.x, p.y, p.z + 4};
  for (const auto& loop : std::vector<std::vector<Point3>>{{p, r, q}, {p, q, s}, {q, r, s}, {r, p, s}})
    b.add_face(loop, face(SurfaceKind::wall));
  return b.take();
}

/// Each class of rings, polygons and shells in its plainest form.
void classed(std::vector<BrokenSolid>& out) {
  const Plan square{{0, 0}, {10, 0}, {10, 8}, {0, 8}};
  using Roof = std::vector<std::vector<Point3>>;
  {
    Solid s = box(kFar, 4, 4, 4);
    s.indices[1] = s.indices[0];
    out.push_back({"a vertex twice in a row", s, 102});
    s = box(kFar, 4, 4, 4);
    s.vertices[s.indices[1]] = s.vertices[s.indices[0]];
    out.push_back({"two vertices at one place, in a row", s, 102});
    s = box(kFar, 4, 4, 4);
    s.indices[2] = s.indices[0];
    out.push_back({"a vertex twice in one ring", s, 104});
    s = box(kFar, 4, 4, 4);
    s.vertices[s.indices[2]] = s.vertices[s.indices[0]];
    out.push_back({"two vertices at one place in one ring", s, 104});
  }
  out.push_back({"a roof with a spike",
                 shafts(square, {},
                        [](Roof& roof) {
                          const Point3 p = roof[0][1];
                          roof[0].insert(roof[0].begin() + 2, {{p.x + 3, p.y, p.z}, {p.x + 1, p.y, p.z}});
                        }),
                 104});
  out.push_back({"a shaft through the wall", shafts(square, {hole(8, 2, 12, 4)}), 201});
  out.push_back({"two shafts that cross", shafts(square, {hole(2, 2, 5, 4), hole(4, 3, 6, 6)}), 201});
  out.push_back({"two shafts with a common wall", shafts(square, {hole(2, 2, 4, 4), hole(4, 2, 6, 4)}), 201});
  out.push_back(
      {"a shaft that touches the wall with a corner", shafts(square, {{{0, 4}, {2, 6}, {4, 4}, {2, 2}}}), 201});
  out.push_back({"two shafts that touch with corners", shafts(square, {hole(2, 2, 4, 4), hole(4, 4, 6, 6)}), 201});
  out.push_back(
      {"a shaft that crosses the outline through its corners",
       shafts({{0, 0}, {5, 2}, {10, 0}, {10, 8}, {5, 6}, {0, 8}}, {{{5, 2}, {0, 4}, {5, 6}, {5, 9}, {12, 4}}}), 201});
  out.push_back(
      {"a shaft twice", shafts(square, {hole(2, 2, 4, 4)}, [](Roof& roof) { roof.push_back(roof[1]); }), 202});
  out.push_back({"a shaft as large as the house", shafts(square, {turned(square)}), 202});
  out.push_back({"a shaft twice, once turned and from another corner",
                 shafts(square, {hole(2, 2, 4, 4)},
                        [](Roof& roof) {
                          roof.push_back({roof[1][2], roof[1][1], roof[1][0], roof[1][3]});
                        }),
                 202});
  out.push_back({"a roof with a fold of a centimetre", stepped_roof(12), 204, false});
  out.push_back({"a roof with a fold of six grid steps", stepped_roof(6), 204, false});
  out.push_back({"a roof with a steep step within rounding", stepped_roof(3), 204, false});
  out.push_back({"a shaft from wall to wall", shafts(square, {{{0, 4}, {5, 6}, {10, 4}, {5, 2}}}), 205});
  out.push_back({"three shafts in a ring",
                 shafts(square, {{{2, 2}, {2, 5}, {3, 4}}, {{2, 5}, {5, 5}, {4, 4}}, {{5, 5}, {5, 2}, {2, 2}, {4, 3}}}),
                 205});
  out.push_back({"a shaft beside the house", shafts(square, {hole(12, 2, 14, 4)}), 206});
  out.push_back(
      {"a shaft beside the house that touches it", shafts(square, {{{10, 4}, {12, 6}, {14, 4}, {12, 2}}}), 206});
  out.push_back({"a shaft in a shaft", shafts(square, {hole(2, 2, 8, 6), hole(4, 3, 5, 4)}), 207});
  out.push_back({"a shaft around a shaft", shafts(square, {hole(4, 3, 5, 4), hole(2, 2, 8, 6)}), 207});
  out.push_back({"a shaft that runs the wrong way round in the roof",
                 shafts(square, {hole(2, 2, 4, 4)}, [](Roof& roof) { std::reverse(roof[1].begin(), roof[1].end()); }),
                 208, false});
  out.push_back(
      {"a shaft that runs the wrong way round everywhere", shafts(square, {turned(hole(2, 2, 4, 4))}), 208, false});
  {
    SolidBuilder b;
    const Point3 p{kFar.x, kFar.y, kFar.z}, q{p.x + 4, p.y, p.z}, r{p.x, p.y + 4, p.z};
    b.add_face({p, q, r}, face(SurfaceKind::roof));
    b.add_face({r, q, p}, face(SurfaceKind::ground));
    out.push_back({"a sheet of two triangles", b.take(), 301});
  }
  out.push_back({"a pyramid whose tip is under the ground", pyramid(-2), 306});
  out.push_back({"a pyramid whose tip is on the ground", pyramid(0), 306});
}

}  // namespace

std::vector<BrokenSolid> broken_solids() {
  std::vector<BrokenSolid> out;
  const Point3 far = kFar;
  struct Base {
    std::string name;
    Solid solid;
  };
  const std::vector<Base> bases{{"box", box(far, 10, 8, 6)},
                                {"house", gabled_house(far, 12, 9, 5, 9)},
                                {"block", courtyard_block(far, 60, 30, 18)}};
  for (const Base& base : bases) {
    const auto faces = base.solid.faces.size();
    // A face is missing: each kind of face once.
    for (const std::size_t f : {std::size_t{0}, std::size_t{1}, faces - 1})
      out.push_back(
          {base.name + " without face " + std::to_string(f),
           rebuilt(base.solid, [&](auto& loops) { loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(f)); }),
           302});
    // A face looks inwards.
    for (const std::size_t f : {std::size_t{0}, std::size_t{1}, faces - 1})
      out.push_back({base.name + " with face " + std::to_string(f) + " flipped",
                     rebuilt(base.solid,
                             [&](auto& loops) {
                               for (auto& loop : loops[f]) std::reverse(loop.begin(), loop.end());
                             }),
                     307});
    out.push_back({base.name + " inside out",
                   rebuilt(base.solid,
                           [](auto& all) {
                             for (auto& loops : all)
                               for (auto& loop : loops) std::reverse(loop.begin(), loop.end());
                           }),
                   405});
    out.push_back(
        {base.name + " with a face twice", rebuilt(base.solid, [](auto& loops) { loops.push_back(loops[1]); }), 303});
    // Vertices pulled through the opposite side.
    for (const std::size_t v : {std::size_t{0}, base.solid.vertices.size() - 1}) {
      Solid s = base.solid;
      s.vertices[v].x += 200;
      s.vertices[v].z += 50;
      out.push_back({base.name + " with vertex " + std::to_string(v) + " pulled away", s,
                     base.name == "box" && v > 0 ? 104 : 203});
    }
    {
      Solid s = base.solid;
      s.vertices[0].z -= 0.05;
      out.push_back({base.name + " with a corner 5 cm off its plane", s, 203, false});
    }
    {
      // All faces but one are moved to a second copy of a vertex: a slit.
      Solid s = base.solid;
      s.vertices.push_back(s.vertices[s.indices[0]]);
      s.indices[0] = static_cast<std::uint32_t>(s.vertices.size() - 1);
      out.push_back({base.name + " with a slit at a vertex", s, 302, false});
    }
    const Point3 corner{far.x + 100, far.y, far.z};
    out.push_back({base.name + " beside another", joined(base.solid, box(corner, 5, 5, 5), true), 305});
    out.push_back({base.name + " with a box in it",
                   joined(base.solid, box({far.x + 1, far.y + 1, far.z + 1}, 1, 1, 1), true), 305});
    out.push_back({base.name + " with a box through its wall",
                   joined(base.solid, box({far.x - 1, far.y + 2, far.z + 1}, 3, 1, 1), true), 305});
  }
  const Solid a = box(far, 4, 4, 4);
  out.push_back({"two boxes on one edge", joined(a, box({far.x + 4, far.y + 4, far.z}, 4, 4, 4), true), 303});
  out.push_back({"two boxes on one corner", joined(a, box({far.x + 4, far.y + 4, far.z + 4}, 4, 4, 4), true), 303});
  out.push_back({"two boxes on one wall", joined(a, box({far.x + 4, far.y, far.z}, 4, 4, 4), true), 303});
  out.push_back({"two boxes that overlap", joined(a, box({far.x + 2, far.y + 2, far.z + 2}, 4, 4, 4), true), 305});
  out.push_back({"no faces", {}, 902});
  {
    Solid s = a;
    s.loops[0].count = 2;
    out.push_back({"a loop of two", s, 101});
  }
  {
    Solid s = a;
    s.indices[0] = 99;
    out.push_back({"an index without vertex", s, 901});
  }
  out.push_back({"prism over a bow-tie",
                 prism({far, {far.x + 8, far.y + 6, far.z}, {far.x + 8, far.y, far.z}, {far.x, far.y + 6, far.z}}, 5),
                 104});
  out.push_back({"prism whose plan touches itself",
                 prism({far,
                        {far.x + 8, far.y, far.z},
                        {far.x + 8, far.y + 4, far.z},
                        {far.x + 4, far.y, far.z},
                        {far.x, far.y + 4, far.z}},
                       5),
                 104});
  {
    // A roof ridge below the ground.
    out.push_back({"ridge under the ground", gabled_house(far, 12, 9, 5, -3), 104});
  }
  {
    // Flat as a sheet: no volume.
    Solid s = a;
    for (Point3& p : s.vertices) p.z = far.z;
    out.push_back({"no height", s, 102});
  }
  {
    // The courtyard reaches out through the outer wall.
    out.push_back({"courtyard wider than its block", courtyard_block(far, 20, 24, 9), 206});
  }
  classed(out);
  return out;
}

std::vector<SoundSolid> sound_solids() {
  std::vector<SoundSolid> out;
  const Plan square{{0, 0}, {10, 0}, {10, 8}, {0, 8}};
  out.push_back({"one shaft", shafts(square, {hole(2, 2, 4, 4)})});
  out.push_back({"two shafts a centimetre apart", shafts(square, {hole(2, 2, 4, 4), hole(4 + 10 * kStep, 2, 6, 4)})});
  out.push_back({"two shafts that face each other corner to corner",
                 shafts(square, {hole(2, 2, 4, 4), hole(4 + 4 * kStep, 4 + 4 * kStep, 6, 6)})});
  out.push_back({"a shaft half a centimetre within the wall", shafts(square, {hole(5 * kStep, 2, 4, 4)})});
  out.push_back(
      {"a shaft shaped as the outline", shafts(square, {hole(kStep * 8, kStep * 8, 10 - kStep * 8, 8 - kStep * 8)})});
  out.push_back({"a roof with a step of one grid step", stepped_roof(1)});
  out.push_back({"a pyramid that ends on its eaves but for a centimetre", pyramid(6 + 10 * kStep)});
  out.push_back({"a tetrahedron", tetrahedron()});
  {
    Solid s = box(kFar, 10, 8, 6);
    s.vertices[s.indices_of(s.loops_of(s.faces.back())[0])[0]].z += 8 * kStep;
    out.push_back({"a box with a corner 8 mm up", s});
  }
  return out;
}

}  // namespace blockrand::testing_shapes
