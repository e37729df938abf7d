#include "pipeline/validate/format_agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "pipeline/validate/attribute_names.h"

namespace blockrand::validate {
namespace {

/// Of an area and of a square metre: frames of tiles and of the whole differ by less, rounding as well.
constexpr double kDrawnTolerance = 3e-3;
/// Of the area of elements that tiles show as others scaled: what lies between the ends of a piece is off by up to 3 cm
/// (outputs::kPieceTolerance), and a band of a decimetre around a window is a third wider then. Measured: 2.4 % where all windows
/// of a house have such bands and the bands are a quarter of what is placed.
constexpr double kPlacedTolerance = 3e-2;

using model::Point3;
using Index = std::unordered_map<std::string_view, const ReadBody*>;

Index index_of(const Contents& contents) {
  Index index;
  for (const ReadBody& body : contents.bodies) index.emplace(body.id, &body);
  return index;
}

const std::string* find(const ReadBody& body, const std::string& name) {
  const auto found = body.attributes.find(name);
  return found == body.attributes.end() ? nullptr : &found->second;
}

// ---- polygons -------------------------------------------------------------------------------------------------------

/// Rings turned to their least point, holes sorted.
ReadPolygon canonical(ReadPolygon polygon) {
  for (auto& ring : polygon.rings) std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  if (polygon.rings.size() > 2) std::sort(polygon.rings.begin() + 1, polygon.rings.end());
  return polygon;
}

bool less(const ReadPolygon& a, const ReadPolygon& b) {
  return std::tie(a.rings, a.kind, a.colour) < std::tie(b.rings, b.kind, b.colour);
}

/// Where one side does not say a kind or a colour, it does not contradict.
bool contradict(const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; }

struct Difference {
  std::string geometry, colour;
};

Difference difference(const std::vector<ReadPolygon>& a, const std::vector<ReadPolygon>& b) {
  Difference out;
  if (a.size() != b.size()) {
    out.geometry = fmt::format("{} faces against {}", a.size(), b.size());
    return out;
  }
  const auto compare = [&](const std::vector<ReadPolygon>& x, const std::vector<ReadPolygon>& y) {
    Difference d;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (x[i].rings != y[i].rings && d.geometry.empty()) {
        d.geometry = "a face has other corners";
        if (!x[i].rings.empty() && !x[i].rings[0].empty()) {
          const Point3& p = x[i].rings[0][0];
          d.geometry += fmt::format(" (near {:.3f} {:.3f} {:.3f})", p.x, p.y, p.z);
        }
      } else if (contradict(x[i].kind, y[i].kind) && d.geometry.empty()) {
        d.geometry = fmt::format("a face is {} against {}", x[i].kind, y[i].kind);
      }
      if (contradict(x[i].colour, y[i].colour) && d.colour.empty())
        d.colour = fmt::format("a face is {} against {}", x[i].colour, y[i].colour);
    }
    return d;
  };
  out = compare(a, b);
  if (out.geometry.empty() && out.colour.empty()) return out;
  // Perhaps only the order differs.
  std::vector<ReadPolygon> x, y;
  for (const ReadPolygon& p : a) x.push_back(canonical(p));
  for (const ReadPolygon& p : b) y.push_back(canonical(p));
  std::sort(x.begin(), x.end(), less);
  std::sort(y.begin(), y.end(), less);
  return compare(x, y);
}

const ReadSolid* solid_of(const ReadBody& body, int lod) {
  for (const ReadSolid& solid : body.solids)
    if (solid.lod == lod) return &solid;
  return nullptr;
}

// ---- meshes ---------------------------------------------------------------------------------------------------------

/// Sums over faces, in the tile's frame.
struct Measures {
  double area = 0, volume = 0;  ///< m², m³ (signed)
  std::map<std::string, double> area_of_colour;
};

/// Newell's vector of a ring: twice its area along its normal.
Point3 newell(const std::vector<Point3>& ring) {
  Point3 n;
  const Point3& o = ring[0];
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const double ux = ring[i].x - o.x, uy = ring[i].y - o.y, uz = ring[i].z - o.z;
    const double vx = ring[i + 1].x - o.x, vy = ring[i + 1].y - o.y, vz = ring[i + 1].z - o.z;
    n = {n.x + uy * vz - uz * vy, n.y + uz * vx - ux * vz, n.z + ux * vy - uy * vx};
  }
  return n;
}

/// \param local  the points of all rings, one after the other
Measures measure(const std::vector<ReadPolygon>& polygons, const std::vector<Point3>& local, const Point3& origin) {
  Measures m;
  auto next = local.begin();
  for (const ReadPolygon& polygon : polygons) {
    Point3 sum;
    for (const auto& ring : polygon.rings) {
      const std::vector<Point3> points(next, next + static_cast<std::ptrdiff_t>(ring.size()));
      next += static_cast<std::ptrdiff_t>(ring.size());
      if (points.size() < 3) continue;
      const Point3 n = newell(points), o = points[0];
      sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
      m.volume += (n.x * (o.x - origin.x) + n.y * (o.y - origin.y) + n.z * (o.z - origin.z)) / 6;
    }
    const double area = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z) / 2;
    m.area += area;
    m.area_of_colour[polygon.colour] += area;
  }
  return m;
}

Measures measure(const std::vector<GlbTriangle>& triangles, const Point3& origin) {
  Measures m;
  for (const GlbTriangle& t : triangles) {
    const Point3 n = newell({t.corners[0], t.corners[1], t.corners[2]}), o = t.corners[0];
    const double area = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) / 2;
    m.volume += (n.x * (o.x - origin.x) + n.y * (o.y - origin.y) + n.z * (o.z - origin.z)) / 6;
    m.area += area;
    m.area_of_colour[fmt::format("#{:02x}{:02x}{:02x}", t.colour[0], t.colour[1], t.colour[2])] += area;
  }
  return m;
}

/// Points in the order of a direction that no wall and no row of windows has: few are side by side.
class AlongOddDirection {
 public:
  explicit AlongOddDirection(const std::vector<Point3>& points) {
    for (const Point3& p : points) sorted_.emplace_back(along(p), p);
    std::sort(sorted_.begin(), sorted_.end());
  }
  /// m from a point to the nearest that is at most `reach` away in that direction; 1e300 without any.
  double nearest(const Point3& p, double reach) const {
    double out = 1e300;
    for (auto i = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(along(p) - reach, Point3{-1e300, 0, 0}));
         i != sorted_.end() && i->first <= along(p) + reach; ++i)
      out = std::min(out, std::hypot(p.x - i->second.x, p.y - i->second.y, p.z - i->second.z));
    return out;
  }

 private:
  /// Of a vector no longer than 1, so that no two points are farther apart along it than they are.
  static double along(const Point3& p) { return 0.628535 * p.x + 0.444334 * p.y + 0.638365 * p.z; }
  std::vector<std::pair<double, Point3>> sorted_;
};

/// Distance from each point to the nearest of `others`; the largest of them.
double farthest(const std::vector<Point3>& points, const std::vector<Point3>& others, double tolerance) {
  const AlongOddDirection sorted(others);
  double worst = 0;
  for (const Point3& p : points) {
    double nearest = sorted.nearest(p, tolerance);
    if (nearest > tolerance) nearest = sorted.nearest(p, 1e9);  // how far off it is
    worst = std::max(worst, nearest);
  }
  return worst;
}

std::uint64_t mixed(std::uint64_t h, std::uint64_t v) {
  h ^= v + 0x9e3779b97f4a7c15u + (h << 6) + (h >> 2);
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  return h ^ (h >> 29);
}

std::uint64_t mixed(std::uint64_t h, std::string_view text) {
  for (const char c : text) h = mixed(h, static_cast<unsigned char>(c));
  return mixed(h, text.size());
}

/// The same whatever the order of the polygons and wherever their rings start.
std::uint64_t digest_of(const std::vector<ReadPolygon>& polygons) {
  std::uint64_t sum = 0;
  for (const ReadPolygon& polygon : polygons) {
    const ReadPolygon p = canonical(polygon);
    std::uint64_t h = mixed(mixed(1, p.kind), p.colour);
    for (const auto& ring : p.rings) {
      h = mixed(h, ring.size());
      for (const Point3& q : ring)
        for (const double v : {q.x, q.y, q.z})
          h = mixed(h, static_cast<std::uint64_t>(std::llrint(std::clamp(v, -1e12, 1e12) * 1e4)));
    }
    sum += h;
  }
  return sum;
}

std::vector<Point3> sorted_points(std::vector<Point3> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace

BodyDigest digest(const ReadBody& body) {
  BodyDigest d;
  d.geometry = mixed(digest_of(body.footprint), body.solids.size());
  for (const ReadSolid& solid : body.solids)
    d.geometry = mixed(mixed(d.geometry, static_cast<std::uint64_t>(solid.lod)), digest_of(solid.polygons));
  std::uint64_t placed = body.detail.placements.size();  // in any order
  for (const ReadPlacement& p : body.detail.placements) {
    std::uint64_t one = p.element;
    for (const double v : {p.origin.x, p.origin.y, p.origin.z, p.along.x, p.along.y})
      one = mixed(one, std::bit_cast<std::uint64_t>(v + 0.0));
    placed += one;
  }
  d.geometry = mixed(d.geometry, placed);
  for (const ReadInstallation& i : body.detail.installations) d.geometry = mixed(d.geometry, digest_of(i.polygons));
  for (const auto& [name, value] : body.attributes) d.attributes = mixed(mixed(d.attributes, name), value);
  return d;
}

void compare_digests(const BodyDigests& tiles, const std::string& format, const BodyDigests& whole,
                     const std::string& file, std::vector<Finding>& findings) {
  std::map<std::string_view, BodyDigest> left;
  for (const auto& [id, d] : whole)
    if (!left.emplace(id, d).second) findings.push_back({Check::object_doubled, file, id, "the body stands twice"});
  for (const auto& [id, d] : tiles) {
    const auto found = left.find(id);
    if (found == left.end()) {
      findings.push_back({Check::object_missing, file, id, "the body stands in " + format + " only"});
      continue;
    }
    if (found->second.geometry != d.geometry)
      findings.push_back({Check::geometry_differs, file, id, "other geometry or colours than in " + format});
    const DrawnArea &there = found->second.drawn, &here = d.drawn;
    if (!(std::fabs(there.all - here.all) <=
          kDrawnTolerance * (1 + here.all) + kPlacedTolerance * std::max(there.placed, here.placed)))
      findings.push_back({Check::geometry_differs, file, id,
                          fmt::format("{:.2f} m² are drawn of it, in {} {:.2f}", there.all, format, here.all)});
    if (found->second.attributes != d.attributes)
      findings.push_back({Check::attribute_differs, file, id, "other attributes than in " + format});
    left.erase(found);
  }
  for (const auto& [id, d] : left)
    findings.push_back({Check::object_missing, format, std::string(id), "the body stands in " + file + " only"});
}

void find_doubles(const Side& side, std::vector<Finding>& findings) {
  std::set<std::string_view> seen;
  for (const std::string& id : side.contents.buildings)
    if (!id.empty() && !seen.insert(id).second)
      findings.push_back({Check::object_doubled, side.file, id, "the building stands twice"});
  seen.clear();
  for (const ReadBody& body : side.contents.bodies)
    if (!body.id.empty() && !seen.insert(body.id).second)
      findings.push_back({Check::object_doubled, side.file, body.id, "the body stands twice"});
}

void compare_objects(const Side& a, const Side& b, std::vector<Finding>& findings) {
  const auto missing = [&](const Side& from, const Side& in) {
    std::set<std::string_view> buildings(in.contents.buildings.begin(), in.contents.buildings.end());
    std::set<std::string_view> gone;
    for (const std::string& id : from.contents.buildings)
      if (!id.empty() && !buildings.count(id) && gone.insert(id).second)
        findings.push_back({Check::object_missing, in.file, id, "the building stands in " + from.file + " only"});
    const Index index = index_of(in.contents);
    for (const ReadBody& body : from.contents.bodies)
      if (!body.id.empty() && !index.count(body.id) && !gone.count(body.building))
        findings.push_back({Check::object_missing, in.file, body.id, "the body stands in " + from.file + " only"});
  };
  missing(a, b);
  missing(b, a);
}

/// Half a step of what `name` is rounded to.
double tolerance_of(const std::string& name, Precision precision) {
  if (precision == Precision::people) {
    const PeopleColumn* const column = people_column(name);
    return column ? column->step / 2 + 1e-9 : 0;
  }
  // Shortest texts of the same float and double differ; half a step of 1/255 is lost in a property table.
  return !name.ends_with("_confidence") ? 0 : precision == Precision::table ? 0.51 / 255 : 1e-7;
}

void compare_attributes(const Side& a, const Side& b, Precision precision, std::vector<Finding>& findings) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::string& name : attribute_names()) {
      all.push_back(name);
      all.push_back(name + "_source");
      all.push_back(name + "_confidence");
    }
    all.insert(all.end(), {"built_roof", "lod", "fallbacks"});
    return all;
  }();
  const Index index = index_of(b.contents);
  for (const ReadBody& x : a.contents.bodies) {
    const auto found = index.find(x.id);
    if (found == index.end()) continue;
    const ReadBody& y = *found->second;
    const auto differs = [&](const std::string& name, const std::string& what) {
      findings.push_back({Check::attribute_differs, b.file, x.id,
                          fmt::format("{}: {} (the first value is that of {})", name, what, a.file)});
    };
    for (const std::string& name : names) {
      const std::string *p = find(x, name), *q = find(y, name);
      const bool confidence = name.ends_with("_confidence");
      if (p && q) {
        if (*p == *q) continue;
        const double tolerance = tolerance_of(name, precision);
        if (tolerance > 0 && std::fabs(to_number(*p) - to_number(*q)) <= tolerance) continue;
        differs(name, fmt::format("{} against {}", *p, *q));
      } else if ((p || q) && !confidence && name != "fallbacks") {
        const bool left_out = precision == Precision::people && !name.ends_with("_source") && !people_column(name);
        if (left_out) continue;
        // A format that says nothing of an attribute at all says nothing of its source either.
        const bool about_source = name.ends_with("_source");
        if (about_source && (!find(x, name.substr(0, name.size() - 7)) || !find(y, name.substr(0, name.size() - 7))))
          continue;
        differs(name, p ? *p + " against nothing" : "nothing against " + *q);
      }
    }
  }
}

void check_sources(const Side& side, bool people, std::vector<Finding>& findings) {
  for (const ReadBody& body : side.contents.bodies)
    if ((find(body, "sources") != nullptr) != people) {
      findings.push_back({Check::metadata_rule, side.file, body.id,
                          people ? "has no column `sources`, though build.json has the attributes for people"
                                 : "has a column `sources`, though build.json has all attributes"});
      return;
    }
  for (const ReadBody& body : side.contents.bodies) {
    const auto wrong = [&](std::string what) {
      findings.push_back({Check::source_wrong, side.file, body.id, std::move(what)});
    };
    for (const std::string& name : attribute_names()) {
      const std::string *value = find(body, name), *source = find(body, name + "_source"),
                        *confidence = find(body, name + "_confidence");
      if (value && !source) wrong(name + " without a source");
      if (source && !is_source(*source)) wrong(fmt::format("{} from \"{}\"", name, *source));
      if (value && !confidence && (!people || name == "style")) wrong(name + " without a confidence");
      if (confidence && !(to_number(*confidence) >= 0 && to_number(*confidence) <= 1))
        wrong(fmt::format("confidence of {} is {}", name, *confidence));
    }
  }
}

void compare_polygons(const Side& a, const Side& b, std::vector<Finding>& findings) {
  const Index index = index_of(b.contents);
  for (const ReadBody& x : a.contents.bodies) {
    const auto found = index.find(x.id);
    if (found == index.end()) continue;
    const ReadBody& y = *found->second;
    const auto note = [&](const std::string& which, const Difference& d) {
      if (!d.geometry.empty())
        findings.push_back(
            {Check::geometry_differs, b.file, x.id, fmt::format("{}: {} than in {}", which, d.geometry, a.file)});
      if (d.geometry.empty() && !d.colour.empty())
        findings.push_back({Check::colour_differs, b.file, x.id, fmt::format("{}: {} in {}", which, d.colour, a.file)});
    };
    note("footprint", difference(x.footprint, y.footprint));
    for (int lod = 1; lod <= 3; ++lod) {
      const ReadSolid *p = solid_of(x, lod), *q = solid_of(y, lod);
      if (p && q)
        note(fmt::format("LoD {}", lod), difference(p->polygons, q->polygons));
      else if (p || q)
        findings.push_back({Check::geometry_differs, b.file, x.id,
                            fmt::format("LoD {}: only {} has a solid", lod, p ? a.file : b.file)});
    }
  }
}

/// What a mesh has of a LoD3 body: what elements stand for is left to them.
static std::vector<ReadPolygon> seen_polygons(const ReadBody& body, const ReadSolid& solid) {
  std::vector<bool> hidden(solid.polygons.size(), false);
  // CityJSON does not say which element stands in which opening: then every opening has one.
  const auto& openings = body.detail.openings;
  const bool told =
      std::any_of(openings.begin(), openings.end(), [](const ReadOpening& o) { return o.placement.has_value(); });
  // By wall: the reveals of all its openings, and the outlines of those that elements stand for. Other openings of the wall
  // may have no element, and keep their reveals.
  std::map<std::size_t, std::span<const std::size_t>> reveals;
  std::map<std::size_t, std::set<std::pair<Point3, Point3>>> outlines;
  for (const ReadOpening& opening : openings) {
    if (!opening.reveals.empty()) reveals.emplace(opening.wall, opening.reveals);
    if (told ? !opening.placement : body.detail.placements.empty()) continue;
    if (opening.polygon >= hidden.size()) continue;
    hidden[opening.polygon] = true;
    for (const auto& ring : solid.polygons[opening.polygon].rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        outlines[opening.wall].emplace(ring[(i + 1) % ring.size()], ring[i]);
  }
  for (const auto& [wall, of_wall] : reveals) {
    const auto outline = outlines.find(wall);
    if (outline == outlines.end()) continue;
    for (const std::size_t reveal : of_wall) {
      if (reveal >= hidden.size() || hidden[reveal]) continue;
      for (const auto& ring : solid.polygons[reveal].rings)
        for (std::size_t i = 0; i < ring.size(); ++i)
          if (outline->second.count({ring[i], ring[(i + 1) % ring.size()]})) hidden[reveal] = true;
    }
  }
  std::vector<ReadPolygon> out;
  for (std::size_t i = 0; i < solid.polygons.size(); ++i)
    if (!hidden[i]) out.push_back(solid.polygons[i]);
  for (const ReadInstallation& installation : body.detail.installations)
    out.insert(out.end(), installation.polygons.begin(), installation.polygons.end());
  return out;
}

void compare_meshes(const Side& reference, const Glb& glb, const std::string& glb_file, const ToLocal& to_local,
                    double tolerance, bool elements_baked, std::vector<Finding>& findings) {
  constexpr std::size_t kMany = 10;  // bodies that are off together are one finding
  std::unordered_map<std::string_view, std::size_t> rows;
  for (std::size_t i = 0; i < glb.contents.bodies.size(); ++i) rows.emplace(glb.contents.bodies[i].id, i);
  std::vector<Finding> off;
  std::size_t compared = 0;
  double least_off = 1e300;
  for (const ReadBody& body : reference.contents.bodies) {
    const auto row = rows.find(body.id);
    if (row == rows.end()) continue;
    const std::vector<GlbTriangle>& triangles = glb.triangles[row->second];
    const ReadSolid* best = nullptr;
    for (const ReadSolid& solid : body.solids)
      if (!best || solid.lod > best->lod) best = &solid;
    const bool flat =
        find(glb.contents.bodies[row->second], "lod") && *find(glb.contents.bodies[row->second], "lod") == "0";
    const bool detailed = best && best->lod == 3;
    if (detailed && elements_baked) continue;
    const std::vector<ReadPolygon> seen = detailed ? seen_polygons(body, *best) : std::vector<ReadPolygon>{};
    const std::vector<ReadPolygon>& polygons = detailed ? seen : best ? best->polygons : body.footprint;
    if (triangles.empty()) {
      // A body whose solid could not be built is in the table without a mesh.
      if (best)
        findings.push_back({Check::geometry_differs, glb_file, body.id, "no mesh, but a solid in " + reference.file});
      continue;
    }
    if (!best && !flat) {
      findings.push_back({Check::geometry_differs, glb_file, body.id, "a mesh, but no solid in " + reference.file});
      continue;
    }
    std::vector<Point3> points;
    for (const ReadPolygon& polygon : polygons)
      for (const auto& ring : polygon.rings) points.insert(points.end(), ring.begin(), ring.end());
    // Each place once: it costs a projection.
    const std::vector<Point3> distinct = sorted_points(points);
    std::vector<Point3> expected(distinct.size()), local(points.size());
    to_local(distinct, expected);
    for (std::size_t i = 0; i < points.size(); ++i)
      local[i] = expected[static_cast<std::size_t>(std::lower_bound(distinct.begin(), distinct.end(), points[i]) -
                                                   distinct.begin())];
    expected = sorted_points(std::move(expected));

    std::vector<Point3> corners;
    for (const GlbTriangle& t : triangles) corners.insert(corners.end(), t.corners.begin(), t.corners.end());
    corners = sorted_points(std::move(corners));
    const Point3 origin = corners.front();
    const double worst = std::max(farthest(corners, expected, tolerance), farthest(expected, corners, tolerance));
    const Measures is = measure(triangles, origin), should = measure(polygons, local, origin);
    ++compared;
    const std::size_t before = findings.size() + off.size();
    // What moving each corner by the tolerance can change.
    const double slack = tolerance * std::sqrt(std::max(should.area, 1.0)) * 8 + 0.002 * should.area;
    if (worst > tolerance) {
      least_off = std::min(least_off, worst);
      off.push_back({Check::geometry_differs, glb_file, body.id,
                     fmt::format("a corner is {:.4f} m from where {} has it", worst, reference.file)});
    } else if (best && !detailed &&
               std::fabs(is.volume - should.volume) >
                   tolerance * should.area + 1e-4 * std::fabs(should.volume) + 0.001) {
      findings.push_back({Check::geometry_differs, glb_file, body.id,
                          fmt::format("{:.3f} m3 against {:.3f} in {}", is.volume, should.volume, reference.file)});
    } else if (std::fabs(is.area - should.area) > slack) {
      findings.push_back(
          {Check::geometry_differs, glb_file, body.id,
           fmt::format("{:.3f} m2 of faces against {:.3f} in {}", is.area, should.area, reference.file)});
    }
    // Other faces have other areas in every colour: that is one finding.
    if (should.area_of_colour.count("") > 0 || findings.size() + off.size() != before) continue;
    std::set<std::string> colours;
    for (const auto* m : {&should.area_of_colour, &is.area_of_colour})
      for (const auto& [colour, area] : *m) colours.insert(colour);
    for (const std::string& colour : colours) {
      const auto area = [&](const Measures& m) {
        const auto found = m.area_of_colour.find(colour);
        return found == m.area_of_colour.end() ? 0.0 : found->second;
      };
      if (std::fabs(area(is) - area(should)) <= slack) continue;
      findings.push_back(
          {Check::colour_differs, glb_file, body.id,
           fmt::format("{:.2f} m2 in {} against {:.2f} in {}", area(is), colour, area(should), reference.file)});
      break;  // one finding a body
    }
  }
  if (off.size() > kMany && off.size() == compared)
    findings.push_back(
        {Check::geometry_differs, glb_file, "",
         fmt::format("all {} bodies are off, by {:.4f} m or more: the tile stands elsewhere than {} says", compared,
                     least_off, reference.file)});
  else
    std::move(off.begin(), off.end(), std::back_inserter(findings));
}

}  // namespace blockrand::validate
