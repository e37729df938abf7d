#include "tests/unit/roofs/fitted_roof.h"

#include <array>
#include <limits>

#include "tests/unit/roofs/placed_dormer.h"

namespace blockrand::roof_checks {

using model::RoofElementKind;
using model::RoofInstallation;
using roofs::Roof;

// ---- putting things on a roof ---------------------------------------------------------------------------------------

namespace {

std::vector<Point2> plan_of(const model::Solid& solid) {
  std::vector<Point2> points;
  for (const Point3& p : solid.vertices) points.push_back(p.xy());
  return roofs::hull(std::move(points));
}

}  // namespace

Fitted fit_out(const model::Polygon& plan, std::span<const model::RoofEdge> edges, const Roof& roof,
               const Fitting& with) {
  Fitted out;
  out.roof = roof;
  const std::size_t surfaces = roof.surfaces.size();
  const auto count = [&](RoofElementKind kind, int n) {
    out.built[kind] += n;
    out.slopes[kind] += n > 0;
  };
  const auto refused = [&](const char* what, std::size_t s, double along) {
    out.faults.push_back(std::string(what) + " refused on surface " + std::to_string(s) + " at " +
                         std::to_string(along));
  };
  const roofs::RoofBorders bare(roof, edges);
  for (std::size_t s = 0; s < surfaces; ++s) {
    // What was built into other surfaces changes nothing here but indices of neighbours beyond them.
    auto plane = bare.slope(s);
    if (!plane || !roofs::takes_elements(*plane)) continue;
    ++out.slopes_asked;
    if (with.cross_gables) {
      roofs::LayoutRequest wanted_layout;
      wanted_layout.outline = roofs::cross_gable_outline(*plane, with.cross_gable);
      wanted_layout.flush = true;
      wanted_layout.up = 0;
      wanted_layout.count = 1;
      int n = 0;
      for (const double along : roofs::lay_out(*plane, wanted_layout).along) {
        if (roofs::add_cross_gable(out.roof, s, with.cross_gable, {along, 0}, edges))
          ++n;
        else
          refused("cross gable", s, along);
      }
      count(RoofElementKind::cross_gable, n);
      if (n > 0) plane = roofs::roof_slope(out.roof, s, edges);
      if (!plane) {
        out.faults.push_back("no plane is left of surface " + std::to_string(s));
        continue;
      }
    }
    if (with.dormers) {
      roofs::LayoutRequest wanted_layout;
      wanted_layout.outline = roofs::dormer_outline(*plane, with.dormer);
      wanted_layout.count = with.most_dormers;
      int n = 0;
      for (const double along : roofs::lay_out(*plane, wanted_layout).along) {
        if (roofs::add_dormer(out.roof, s, with.dormer, {along, wanted_layout.up}, edges))
          ++n;
        else
          refused("dormer", s, along);
      }
      count(RoofElementKind::dormer, n);
    }
  }
  if (with.chimneys) {
    for (RoofInstallation& stack : roofs::chimneys(plan, edges, out.roof, with.frontage, with.chimney)) {
      out.installations.push_back(std::move(stack));
      ++out.built[RoofElementKind::chimney];
    }
  }
  const roofs::RoofBorders borders(out.roof, edges);
  for (std::size_t s = 0; s < surfaces && with.roof_windows; ++s) {
    auto plane = borders.slope(s);
    if (!plane || !roofs::takes_elements(*plane)) continue;
    for (const RoofInstallation& stack : out.installations)
      if (stack.kind == RoofElementKind::chimney) roofs::occupy(*plane, plan_of(stack.solid), 0.3);
    int n = 0;
    for (int row = 0; row < with.window_rows; ++row) {
      roofs::LayoutRequest wanted_layout;
      wanted_layout.outline = roofs::roof_window_outline(with.roof_window);
      wanted_layout.up = roofs::kEavesDistance + row * (with.roof_window.height + roofs::kBetweenElements);
      for (const double along : roofs::lay_out(*plane, wanted_layout).along) {
        auto window = roofs::roof_window(*plane, with.roof_window, {along, wanted_layout.up});
        if (!window) {
          refused("roof window", s, along);
          continue;
        }
        roofs::OccupiedPlace place{wanted_layout.outline, roofs::kBetweenElements};
        for (Point2& p : place.outline) p = {p.x + along, p.y + wanted_layout.up};
        plane->occupied.push_back(std::move(place));
        out.installations.push_back(std::move(*window));
        ++n;
      }
    }
    count(RoofElementKind::roof_window, n);
  }
  return out;
}

std::vector<model::RoofEdge> gables_as_party_walls(const Roof& roof) {
  std::vector<model::RoofEdge> out;
  for (const auto& top : roof.wall_tops) {
    double low = 1e9, high = -1e9;
    for (const Point3& p : top) {
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
    out.push_back(high - low > 0.1 ? model::RoofEdge::party_wall : model::RoofEdge::open);
  }
  return out;
}

std::string installations_validity(const std::vector<RoofInstallation>& installations) {
  for (const RoofInstallation& installation : installations) {
    const auto triangles = geometry::triangulate(installation.solid);
    if (!triangles) return std::string(model::name(installation.kind)) + ": a face is no simple polygon";
    const auto check = geometry::check_solid(installation.solid, *triangles);
    if (!check.valid()) return std::string(model::name(installation.kind)) + ": " + check.text();
  }
  return "none";
}

// ---- the tape measure -----------------------------------------------------------------------------------------------

namespace {

struct Segment {
  Point3 a, b;
};

Point3 minus(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point3 cross(const Point3& a, const Point3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(const Point3& a) { return std::sqrt(dot(a, a)); }

/// Between two segments in space (Ericson, Real-Time Collision Detection, §5.1.9).
double distance(const Segment& s, const Segment& t) {
  const Point3 d1 = minus(s.b, s.a), d2 = minus(t.b, t.a), r = minus(s.a, t.a);
  const double a = dot(d1, d1), e = dot(d2, d2), f = dot(d2, r), c = dot(d1, r), b = dot(d1, d2),
               denominator = a * e - b * b;
  double x = denominator > 1e-12 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0;
  double y = e > 0 ? (b * x + f) / e : 0;
  if (y < 0) {
    y = 0;
    x = a > 0 ? std::clamp(-c / a, 0.0, 1.0) : 0;
  } else if (y > 1) {
    y = 1;
    x = a > 0 ? std::clamp((b - c) / a, 0.0, 1.0) : 0;
  }
  const Point3 p{s.a.x + x * d1.x, s.a.y + x * d1.y, s.a.z + x * d1.z},
      q{t.a.x + y * d2.x, t.a.y + y * d2.y, t.a.z + y * d2.z};
  return length(minus(p, q));
}

double distance(const std::vector<Segment>& s, const std::vector<Segment>& t) {
  double least = std::numeric_limits<double>::infinity();
  for (const Segment& a : s)
    for (const Segment& b : t) least = std::min(least, distance(a, b));
  return least;
}

std::vector<Segment> segments(const std::vector<Point3>& loop) {
  std::vector<Segment> out;
  for (std::size_t i = 0; i < loop.size(); ++i) out.push_back({loop[i], loop[(i + 1) % loop.size()]});
  return out;
}

/// Normal of a loop by its area, its length twice the area.
Point3 doubled_area(const std::vector<Point3>& loop) {
  Point3 sum;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Point3 n = cross(minus(loop[i], loop[0]), minus(loop[i + 1], loop[0]));
    sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
  }
  return sum;
}

/// How far points lie off the plane of a loop.
double off_plane(const std::vector<Point3>& loop, const std::vector<Segment>& of) {
  const Point3 n = doubled_area(loop);
  double most = 0, mean = 0;
  for (const Point3& p : loop) mean += dot(n, minus(p, loop[0])) / length(n) / static_cast<double>(loop.size());
  for (const Segment& s : of) most = std::max(most, std::fabs(dot(n, minus(s.a, loop[0])) / length(n) - mean));
  return most;
}

std::vector<Point2> flat(const std::vector<Point3>& loop) {
  std::vector<Point2> out;
  for (const Point3& p : loop) out.push_back(p.xy());
  return out;
}

/// What stands on a slope, as measured: the line where it meets it.
struct Siting {
  std::string name;
  RoofElementKind kind;
  std::size_t slope = 0;
  std::vector<Segment> outline;
  double width = 0;
};

using Directed = std::pair<Point3, Point3>;

}  // namespace

std::vector<std::string> broken_rules(const Roof& roof, const std::vector<RoofInstallation>& installations) {
  constexpr double kRounding =
      0.003;  // m: both ends of a distance move by up to 0.85 mm, and 2 mm are the code's own slack
  std::vector<std::string> out;
  const auto complain = [&](const std::string& text) { out.push_back(text); };
  const auto metres = [](double v) { return std::to_string(v); };

  // Every side of every surface and wall.
  std::map<Directed, std::size_t> surface_side;
  std::set<Directed> wall_side;
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s)
    for (const auto& loop : roof.surfaces[s].loops)
      for (const Segment& side : segments(loop)) surface_side[{side.a, side.b}] = s;
  for (const auto& top : roof.wall_tops)
    for (std::size_t i = 0; i + 1 < top.size(); ++i) wall_side.insert({top[i], top[i + 1]});

  std::vector<Siting> standing;
  struct Slope {
    std::vector<Segment> eaves, sides, folds;
  };
  std::vector<Slope> slopes(roof.surfaces.size());
  for (std::size_t e = 0; e < roof.elements.size(); ++e)
    standing.push_back(
        {std::string(model::name(roof.elements[e])) + " " + std::to_string(e), roof.elements[e], SIZE_MAX, {}, 0});
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s) {
    const Roof::Surface& surface = roof.surfaces[s];
    if (surface.element != -1 || surface.upright) continue;
    for (const auto& loop : surface.loops)
      for (const Segment& side : segments(loop)) {
        const auto beyond = surface_side.find({side.b, side.a});
        const bool level = std::fabs(side.a.z - side.b.z) < 0.02;
        if (beyond == surface_side.end()) {
          if (!wall_side.contains({side.b, side.a})) complain("an open side of surface " + std::to_string(s));
          // Eaves lie below their slope: water runs over them. The high wall of a lean-to is level, too.
          const Point3 n = doubled_area(surface.loops[0]);
          const bool below = n.x * -(side.b.y - side.a.y) + n.y * (side.b.x - side.a.x) < 0;
          if (!level)
            slopes[s].sides.push_back(side);
          else if (below)
            slopes[s].eaves.push_back(side);
        } else if (const std::int32_t e = roof.surfaces[beyond->second].element; e != -1) {
          Siting& of = standing[static_cast<std::size_t>(e)];
          if (of.slope != SIZE_MAX && of.slope != s) complain(of.name + " lies in two slopes");
          of.slope = s;
          of.outline.push_back(side);
        } else if (!level) {
          slopes[s].folds.push_back(side);
        }
      }
  }
  for (std::size_t i = 0; i < standing.size(); ++i) {
    // The front: the widest of its level sides, on the slope or, flush, between the ends of its valleys.
    for (const Segment& s : standing[i].outline)
      for (const Segment& t : standing[i].outline)
        if (std::fabs(s.a.z - t.a.z) < 0.02) standing[i].width = std::max(standing[i].width, length(minus(s.a, t.a)));
    for (const Segment& s : standing[i].outline)
      for (const Segment& t : standing[i].outline)
        if (std::fabs(s.a.z - t.b.z) < 0.02) standing[i].width = std::max(standing[i].width, length(minus(s.a, t.b)));
  }
  for (const RoofInstallation& installation : installations) {
    const model::Solid& solid = installation.solid;
    std::vector<std::vector<Point3>> under;
    for (const model::Face& face : solid.faces) {
      if (face.kind != model::SurfaceKind::closure) continue;
      std::vector<Point3> loop;
      for (const std::uint32_t v : solid.indices_of(solid.loops_of(face)[0])) loop.push_back(solid.vertices[v]);
      under.push_back(loop);
    }
    const std::string name = std::string(model::name(installation.kind));
    if (under.empty()) {
      complain(name + " without an underside");
      continue;
    }
    // The surface over which most of an underside lies.
    for (const auto& loop : under) {
      const Point2 middle = geometry::centroid(flat(loop));
      std::size_t slope = SIZE_MAX;
      for (std::size_t s = 0; s < roof.surfaces.size(); ++s) {
        const Roof::Surface& surface = roof.surfaces[s];
        if (surface.upright) continue;
        bool in = geometry::contains(flat(surface.loops[0]), middle);
        for (std::size_t k = 1; k < surface.loops.size(); ++k)
          in = in && !geometry::contains(flat(surface.loops[k]), middle);
        if (!in) continue;
        if (surface.element != -1)
          complain(name + " stands over " + standing[static_cast<std::size_t>(surface.element)].name);
        if (surface.element == -1) slope = s;
      }
      if (slope == SIZE_MAX) {
        complain(name + " stands over no roof");
        continue;
      }
      const double off = off_plane(roof.surfaces[slope].loops[0], segments(loop));
      if (installation.kind == RoofElementKind::roof_window) {
        standing.push_back({name, installation.kind, slope, segments(loop), length(minus(loop[0], loop[1]))});
        for (const Segment& s : segments(loop))
          standing.back().width = std::min(standing.back().width, length(minus(s.a, s.b)));
      } else {
        const Point3 n = doubled_area(roof.surfaces[slope].loops[0]);
        for (const Point3& p : loop)
          if (dot(n, minus(p, roof.surfaces[slope].loops[0][0])) <= 0)
            complain(name + " cuts " + metres(off) + " into its slope");
        if (off > 0.03) complain(name + " lies " + metres(off) + " off its slope");
      }
    }
  }

  for (const Siting& s : standing) {
    if (s.slope == SIZE_MAX || s.outline.empty()) {
      complain(s.name + " touches no slope");
      continue;
    }
    const Roof::Surface& surface = roof.surfaces[s.slope];
    const Slope& slope = slopes[s.slope];
    const auto keep = [&](const char* from, double least, const std::vector<Segment>& borders) {
      const double d = distance(s.outline, borders);
      if (d < least - kRounding) complain(s.name + " lies " + metres(d) + " from " + from);
    };
    if (s.kind != RoofElementKind::cross_gable) keep("the eaves", 1.0, slope.eaves);
    keep("the outer side", 1.0, slope.sides);
    keep("a fold", 0.75, slope.folds);
    if (s.width > 3.0 + kRounding) complain(s.name + " is " + metres(s.width) + " wide");
    if (s.width < 0.2) complain(s.name + " is " + metres(s.width) + " wide");
    const double off = off_plane(surface.loops[0], s.outline);
    if (off > 0.009) complain(s.name + " lies " + metres(off) + " off its slope");
    // On the plan: inside the slope's outer border. A cross gable has cut that back; its own outline is the border.
    if (s.kind != RoofElementKind::cross_gable)
      for (const Segment& side : s.outline)
        if (!geometry::contains(flat(surface.loops[0]), side.a.xy())) complain(s.name + " leaves its slope");
  }
  for (std::size_t i = 0; i < standing.size(); ++i)
    for (std::size_t k = i + 1; k < standing.size(); ++k) {
      if (standing[i].slope != standing[k].slope || standing[i].slope == SIZE_MAX) continue;
      const double d = distance(standing[i].outline, standing[k].outline);
      if (d < 1.5 - kRounding) complain(standing[i].name + " lies " + metres(d) + " from " + standing[k].name);
    }
  return out;
}

ElementMeasures measures_of(const Roof& roof, std::int32_t element) {
  ElementMeasures out;
  for (const Roof::Surface& surface : roof.surfaces) {
    if (surface.element != element) continue;
    double area = 0;
    for (const auto& loop : surface.loops) {
      const Point3 n = doubled_area(loop);
      area += length(n) / 2;
      out.plan_area += surface.upright ? 0 : n.z / 2;
      for (const Point3& p : loop) out.highest = std::max(out.highest, p.z);
    }
    (surface.upright ? out.upright : out.sloped) += 1;
    (surface.upright ? out.upright_area : out.sloped_area) += area;
  }
  return out;
}

double volume_under(const model::Polygon& plan, const Roof& roof) {
  const model::Solid solid = masses::envelope(plan, 30, roof, {});
  const auto triangles = geometry::triangulate(solid);
  return triangles ? geometry::volume(solid, *triangles) : 0;
}

}  // namespace blockrand::roof_checks
