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
Solid rebuilt(const Solid& solid, const std::function<void(std::vector<std::vector<std::vector<std::uint32_t>>>&)>& change) {
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
  return prism({at, {at.x + width, at.y, at.z}, {at.x + width, at.y + depth, at.z}, {at.x, at.y + depth, at.z}}, height);
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
    return std::vector<Point3>{{at.x + inset, at.y + inset, z}, {at.x + inset + side, at.y + inset, z},
                               {at.x + inset + side, at.y + inset + side, z}, {at.x + inset, at.y + inset + side, z}};
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

std::vector<BrokenSolid> broken_solids() {
  std::vector<BrokenSolid> out;
  const Point3 far{391000, 5819000, 34};
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
      out.push_back({base.name + " without face " + std::to_string(f),
                     rebuilt(base.solid, [&](auto& loops) { loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(f)); })});
    // A face looks inwards.
    for (const std::size_t f : {std::size_t{0}, std::size_t{1}, faces - 1})
      out.push_back({base.name + " with face " + std::to_string(f) + " flipped", rebuilt(base.solid, [&](auto& loops) {
                       for (auto& loop : loops[f]) std::reverse(loop.begin(), loop.end());
                     })});
    out.push_back({base.name + " inside out", rebuilt(base.solid, [](auto& all) {
                     for (auto& loops : all)
                       for (auto& loop : loops) std::reverse(loop.begin(), loop.end());
                   })});
    out.push_back({base.name + " with a face twice", rebuilt(base.solid, [](auto& loops) { loops.push_back(loops[1]); })});
    // Vertices pulled through the opposite side.
    for (const std::size_t v : {std::size_t{0}, base.solid.vertices.size() - 1}) {
      Solid s = base.solid;
      s.vertices[v].x += 200;
      s.vertices[v].z += 50;
      out.push_back({base.name + " with vertex " + std::to_string(v) + " pulled away", s});
    }
    {
      Solid s = base.solid;
      s.vertices[0].z -= 0.05;
      out.push_back({base.name + " with a corner 5 cm off its plane", s});
    }
    {
      // All faces but one are moved to a second copy of a vertex: a slit.
      Solid s = base.solid;
      s.vertices.push_back(s.vertices[s.indices[0]]);
      s.indices[0] = static_cast<std::uint32_t>(s.vertices.size() - 1);
      out.push_back({base.name + " with a slit at a vertex", s});
    }
    const Point3 corner{far.x + 100, far.y, far.z};
    out.push_back({base.name + " beside another", joined(base.solid, box(corner, 5, 5, 5), true)});
    out.push_back({base.name + " with a box in it", joined(base.solid, box({far.x + 1, far.y + 1, far.z + 1}, 1, 1, 1), true)});
    out.push_back({base.name + " with a box through its wall", joined(base.solid, box({far.x - 1, far.y + 2, far.z + 1}, 3, 1, 1), true)});
  }
  const Solid a = box(far, 4, 4, 4);
  out.push_back({"two boxes on one edge", joined(a, box({far.x + 4, far.y + 4, far.z}, 4, 4, 4), true)});
  out.push_back({"two boxes on one corner", joined(a, box({far.x + 4, far.y + 4, far.z + 4}, 4, 4, 4), true)});
  out.push_back({"two boxes on one wall", joined(a, box({far.x + 4, far.y, far.z}, 4, 4, 4), true)});
  out.push_back({"two boxes that overlap", joined(a, box({far.x + 2, far.y + 2, far.z + 2}, 4, 4, 4), true)});
  out.push_back({"no faces", {}});
  {
    Solid s = a;
    s.loops[0].count = 2;
    out.push_back({"a loop of two", s});
  }
  {
    Solid s = a;
    s.indices[0] = 99;
    out.push_back({"an index without vertex", s});
  }
  out.push_back({"prism over a bow-tie",
                 prism({far, {far.x + 8, far.y + 6, far.z}, {far.x + 8, far.y, far.z}, {far.x, far.y + 6, far.z}}, 5)});
  out.push_back({"prism whose plan touches itself",
                 prism({far, {far.x + 8, far.y, far.z}, {far.x + 8, far.y + 4, far.z}, {far.x + 4, far.y, far.z},
                        {far.x, far.y + 4, far.z}}, 5)});
  {
    // A roof ridge below the ground.
    out.push_back({"ridge under the ground", gabled_house(far, 12, 9, 5, -3)});
  }
  {
    // Flat as a sheet: no volume.
    Solid s = a;
    for (Point3& p : s.vertices) p.z = far.z;
    out.push_back({"no height", s});
  }
  {
    // The courtyard reaches out through the outer wall.
    out.push_back({"courtyard wider than its block", courtyard_block(far, 20, 24, 9)});
  }
  return out;
}

}  // namespace blockrand::testing_shapes
