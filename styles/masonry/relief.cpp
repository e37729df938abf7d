#include "styles/masonry/relief.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/masonry/plane.h"

namespace blockrand::masonry {
namespace {

/// m. Points of a stone that lie on the end of the wall.
constexpr double kAtCorner = 0.001;
/// m. Points of an outline nearer than that to the line between their neighbours: a triangle there would have no area on the grid.
constexpr double kStraight = 0.0015;
/// m2, of a face on the grid: less is none.
constexpr double kLeastFace = 1e-6;
/// Share by which irregular stones stand out less or more.
constexpr double kUneven = 0.25;

double cross_of(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool is_dressing(StoneRole role) {
  return role == StoneRole::voussoir || role == StoneRole::keystone || role == StoneRole::lintel ||
         role == StoneRole::sill;
}

/// Without points on straight edges.
Outline without_straight_points(const Outline& outline) {
  Outline out = outline;
  for (std::size_t i = 0; i < out.size() && out.size() > 3;) {
    const Point2 &a = out[(i + out.size() - 1) % out.size()], &b = out[i], &c = out[(i + 1) % out.size()];
    const double length = std::hypot(c.x - a.x, c.y - a.y);
    if (std::fabs(cross_of(a, b, c)) < kStraight * length)
      out.erase(out.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return out;
}

class Mesher {
 public:
  explicit Mesher(const ReliefOptions& options) : o_(options) {
    const auto shift = [](double turn) {
      return base::tan(std::clamp(turn, 0.0, 150.0) / 2 / base::kDegreesPerRadian);
    };
    left_ = shift(options.turn_left), right_ = shift(options.turn_right);
  }

  void add(model::ElementMesh& mesh, const Stone& laid, bool sides) const {
    Stone stone = laid;
    stone.outline = without_straight_points(laid.outline);
    double out = o_.relief;
    const Point2 first = stone.outline.front();
    if (o_.irregular && stone.role == StoneRole::field)
      out *= 1 - kUneven +
             2 * kUneven *
                 unit_of(static_cast<std::uint64_t>(std::llround((first.x + 1000) * 1024)),
                         static_cast<std::uint64_t>(std::llround((first.y + 1000) * 1024)), 1);
    const double front = o_.mortar + out;
    Outline top = stone.outline;
    if (sides && o_.bevel > 0) bevel(top, stone);
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto count = static_cast<std::uint32_t>(top.size());
    for (const Point2& p : top) mesh.vertices.push_back(model::snap(at(p, front, stone)));
    if (is_convex(top, 1e-6)) {
      add_face(mesh, [&](std::vector<std::uint32_t>& corners) {
        for (std::uint32_t i = 0; i < count; ++i) corners.push_back(base + i);
      });
    } else {
      for (const auto& t : triangles_of_outline(top))
        add_face(mesh, [&](std::vector<std::uint32_t>& corners) {
          for (const std::uint32_t i : t) corners.push_back(base + i);
        });
    }
    if (!sides) return;
    for (const Point2& p : stone.outline) mesh.vertices.push_back(model::snap(at(p, o_.mortar, stone)));
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t j = (i + 1) % count;
      const Point2 &p = stone.outline[i], &q = stone.outline[j];
      // Round the corner the next wall's stone goes on.
      if ((stone.at_left && std::max(p.x, q.x) < o_.from + kAtCorner) ||
          (stone.at_right && std::min(p.x, q.x) > o_.to - kAtCorner))
        continue;
      const bool level = std::fabs(p.x - q.x) < 1e-9 || std::fabs(p.y - q.y) < 1e-9;
      const std::uint32_t low_i = base + count + i, low_j = base + count + j;
      if (level) {
        add_face(mesh, [&](std::vector<std::uint32_t>& c) { c = {low_i, low_j, base + j, base + i}; });
      } else {
        add_face(mesh, [&](std::vector<std::uint32_t>& c) { c = {low_i, low_j, base + j}; });
        add_face(mesh, [&](std::vector<std::uint32_t>& c) { c = {low_i, base + j, base + i}; });
      }
    }
  }

  static std::size_t triangles(const Stone& stone, bool sides) {
    return stone.outline.size() - 2 + (sides ? 2 * stone.outline.size() : 0);
  }

 private:
  model::Point3 at(Point2 p, double z, const Stone& stone) const {
    if (stone.at_left && p.x < o_.from + kAtCorner) p.x -= z * left_;
    if (stone.at_right && p.x > o_.to - kAtCorner) p.x += z * right_;
    return {p.x, p.y, z};
  }

  /// The front, smaller all round but at the corner of the house; left as it is where it is no convex outline or too small.
  void bevel(Outline& top, const Stone& stone) const {
    if (!is_convex(top, 1e-6) || narrowest(top) < 4 * o_.bevel) return;
    const std::size_t n = top.size();
    Outline out;
    for (std::size_t i = 0; i < n; ++i) {
      const Point2 a = top[(i + n - 1) % n], b = top[i], c = top[(i + 1) % n];
      const double lu = std::hypot(b.x - a.x, b.y - a.y), lv = std::hypot(c.x - b.x, c.y - b.y);
      // Short edges would turn over.
      if (lu < 2 * o_.bevel || lv < 2 * o_.bevel) return;
      const Point2 nu{(a.y - b.y) / lu, (b.x - a.x) / lu}, nv{(b.y - c.y) / lv, (c.x - b.x) / lv};
      const double forth = 1 + nu.x * nv.x + nu.y * nv.y;
      if (forth < 0.3) return;
      Point2 p{b.x + (nu.x + nv.x) / forth * o_.bevel, b.y + (nu.y + nv.y) / forth * o_.bevel};
      if ((stone.at_left && b.x < o_.from + kAtCorner) || (stone.at_right && b.x > o_.to - kAtCorner)) p.x = b.x;
      out.push_back(p);
    }
    top = std::move(out);
  }

  /// Of a flat face; Newell.
  static double area_of_face(const model::ElementMesh& mesh, const std::vector<std::uint32_t>& corners) {
    model::Point3 sum;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const model::Point3 &a = mesh.vertices[corners[i]], &b = mesh.vertices[corners[(i + 1) % corners.size()]];
      sum.x += (a.y - b.y) * (a.z + b.z), sum.y += (a.z - b.z) * (a.x + b.x), sum.z += (a.x - b.x) * (a.y + b.y);
    }
    return std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z) / 2;
  }

  template <class Fill>
  static void add_face(model::ElementMesh& mesh, Fill&& fill) {
    std::vector<std::uint32_t> corners;
    fill(corners);
    if (area_of_face(mesh, corners) < kLeastFace) return;
    mesh.faces.push_back({static_cast<std::uint32_t>(mesh.indices.size()), static_cast<std::uint32_t>(corners.size()),
                          model::ElementPart::wall});
    mesh.indices.insert(mesh.indices.end(), corners.begin(), corners.end());
  }

  const ReliefOptions& o_;
  double left_ = 0, right_ = 0;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangles_of_outline(const std::vector<Point2>& outline) {
  std::vector<std::uint32_t> rest(outline.size());
  for (std::uint32_t i = 0; i < rest.size(); ++i) rest[i] = i;
  std::vector<std::array<std::uint32_t, 3>> out;
  while (rest.size() > 3) {
    const std::size_t n = rest.size();
    std::size_t best = n;
    double best_area = -1;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t a = rest[(i + n - 1) % n], b = rest[i], c = rest[(i + 1) % n];
      const double area = cross_of(outline[a], outline[b], outline[c]);
      if (area < 0) continue;
      const bool free = std::ranges::none_of(rest, [&](std::uint32_t v) {
        return v != a && v != b && v != c && cross_of(outline[a], outline[b], outline[v]) >= 0 &&
               cross_of(outline[b], outline[c], outline[v]) >= 0 && cross_of(outline[c], outline[a], outline[v]) >= 0;
      });
      // The ear that is fattest, so that no slivers are left.
      if (!free) continue;
      const double side = std::hypot(outline[c].x - outline[a].x, outline[c].y - outline[a].y);
      const double fat = side > 0 ? area / (side * side) : area;
      if (fat > best_area) best_area = fat, best = i;
    }
    if (best == n) break;
    out.push_back({rest[(best + n - 1) % n], rest[best], rest[(best + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
  }
  for (std::size_t i = 1; i + 1 < rest.size(); ++i) out.push_back({rest[0], rest[i], rest[i + 1]});
  return out;
}

Relief relief_of(const LaidWall& wall, const ReliefOptions& options, bool quoins_dressed) {
  const auto stands_out = [&](const Stone& s) {
    return is_dressing(s.role) || (quoins_dressed && s.role == StoneRole::quoin);
  };
  Relief out;
  for (const ReliefDetail detail : {ReliefDetail::full, ReliefDetail::fronts, ReliefDetail::dressings}) {
    std::size_t count = 0;
    for (const Stone& s : wall.stones)
      if (detail != ReliefDetail::dressings || stands_out(s))
        count += Mesher::triangles(s, detail != ReliefDetail::fronts);
    if (count > options.most_triangles || count == 0) continue;
    out.detail = detail;
    out.triangles = count;
    break;
  }
  if (out.detail == ReliefDetail::none) return out;
  const Mesher mesher(options);
  for (const Stone& s : wall.stones) {
    const bool dressing = stands_out(s);
    if (out.detail == ReliefDetail::dressings && !dressing) continue;
    mesher.add(dressing ? out.dressings : out.field[s.shade], s, out.detail != ReliefDetail::fronts);
  }
  return out;
}

}  // namespace blockrand::masonry
