#include "pipeline/outputs/element_polygons.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "pipeline/model/vector.h"

namespace blockrand::outputs {
namespace {

using Ring = std::vector<ElementPoint>;
using Edge = std::pair<ElementPoint, ElementPoint>;

constexpr double kStepsPerMetre = 1e4;
/// In steps: how far a face may lie off the plane of the one that it joins. Rounding alone makes one.
constexpr double kOffPlane = 1.5;
/// Cosine between faces that are joined; rounding turns thin faces by more than their points are off.
constexpr double kSameWay = 0.99;
/// In steps: how far a point may lie off the straight line that it is left out of, and how near other edges may come.
constexpr double kOffLine = 0.5, kApart = 2;
/// In steps: how far all points that are left out may lie off the line that takes their place. Rounding alone makes one.
constexpr double kOffChord = 1.5;

using Vector = model::Point3;
Vector between(const ElementPoint& from, const ElementPoint& to) {
  return {static_cast<double>(to[0] - from[0]), static_cast<double>(to[1] - from[1]),
          static_cast<double>(to[2] - from[2])};
}

/// Twice the area along the normal (Newell).
Vector newell(const Ring& ring) {
  Vector n;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Vector c = cross(between(ring[0], ring[i]), between(ring[0], ring[i + 1]));
    n = {n.x + c.x, n.y + c.y, n.z + c.z};
  }
  return n;
}

double distance(const ElementPoint& p, const ElementPoint& a, const ElementPoint& b) {
  const Vector u = between(a, b), v = between(a, p);
  const double squared = dot(u, u), along = squared > 0 ? std::clamp(dot(u, v) / squared, 0.0, 1.0) : 0;
  return length(Vector{v.x - along * u.x, v.y - along * u.y, v.z - along * u.z});
}

Ring rounded(const model::ElementMesh& mesh, const model::ElementFace& face) {
  Ring ring;
  for (std::uint32_t i = 0; i < face.count; ++i) {
    const model::Point3& p = mesh.vertices[mesh.indices[face.first + i]];
    const auto steps = [](double v) { return static_cast<std::int64_t>(std::nearbyint(v * kStepsPerMetre)); };
    // y up and z out of the wall become z up and y into it, which keeps the frame right-handed.
    const ElementPoint point{steps(p.x), steps(0.0 - p.z), steps(p.y)};
    if (ring.empty() || ring.back() != point) ring.push_back(point);
  }
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) ring.clear();
  return ring;
}

template <class Use>
void for_each_edge(const Ring& ring, const Use& use) {
  for (std::size_t i = 0; i < ring.size(); ++i) use(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
}

struct Face {
  model::PartMaterial look;
  Ring ring;
  Vector normal;    ///< twice the area long
  double area = 0;  ///< twice
  bool joined = false;
};

class Joiner {
 public:
  explicit Joiner(std::vector<Face> faces) : faces_(std::move(faces)) {
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for_each_edge(faces_[f].ring, [&](const ElementPoint& a, const ElementPoint& b) {
        at_edge_[{a, b}].push_back(f);
      });
  }

  std::vector<ElementPolygon> polygons() {
    std::vector<std::size_t> order(faces_.size());
    for (std::size_t f = 0; f < order.size(); ++f) order[f] = f;
    // The largest first: its plane is the surest.
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return faces_[a].area > faces_[b].area; });
    std::vector<std::pair<std::size_t, ElementPolygon>> made;  // by the first face of each
    for (const std::size_t seed : order) {
      if (faces_[seed].joined) continue;
      std::vector<std::size_t> region = region_of(seed);
      std::sort(region.begin(), region.end());
      if (auto rings = outline(region, faces_[seed].normal))
        made.push_back({region.front(), {faces_[seed].look, std::move(*rings)}});
      else
        for (const std::size_t f : region) made.push_back({f, {faces_[f].look, {faces_[f].ring}}});
    }
    std::sort(made.begin(), made.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<ElementPolygon> out;
    out.reserve(made.size());
    for (auto& [first, polygon] : made) out.push_back(std::move(polygon));
    return out;
  }

 private:
  /// The faces that hang together with one over edges, in its plane and its look.
  std::vector<std::size_t> region_of(std::size_t seed) {
    const Face& plane = faces_[seed];
    std::vector<std::size_t> region{seed};
    faces_[seed].joined = true;
    for (std::size_t next = 0; next < region.size() && plane.area > 0; ++next)
      for_each_edge(faces_[region[next]].ring, [&](const ElementPoint& a, const ElementPoint& b) {
        const auto across = at_edge_.find({b, a});
        if (across == at_edge_.end()) return;
        for (const std::size_t f : across->second) {
          Face& face = faces_[f];
          if (face.joined || !(face.look == plane.look) || !lies_in(face, plane)) continue;
          face.joined = true;
          region.push_back(f);
        }
      });
    return region;
  }

  static bool lies_in(const Face& face, const Face& plane) {
    if (dot(face.normal, plane.normal) < kSameWay * face.area * plane.area) return false;
    return std::all_of(face.ring.begin(), face.ring.end(), [&](const ElementPoint& p) {
      return std::fabs(dot(between(plane.ring[0], p), plane.normal)) <= kOffPlane * plane.area;
    });
  }

  /// The rings around a region; nothing where they are not one outer ring and holes, all apart.
  std::optional<std::vector<Ring>> outline(const std::vector<std::size_t>& region, const Vector& normal) const {
    if (region.size() == 1) return std::vector<Ring>{faces_[region[0]].ring};
    std::set<Edge> edges;
    for (const std::size_t f : region) {
      bool twice = false;
      for_each_edge(faces_[f].ring, [&](const ElementPoint& a, const ElementPoint& b) {
        twice = twice || !edges.emplace(a, b).second;
      });
      if (twice) return std::nullopt;
    }
    std::map<ElementPoint, ElementPoint> next;
    for (const auto& [a, b] : edges)
      if (!edges.count({b, a}) && !next.emplace(a, b).second) return std::nullopt;  // rings that meet in a point
    std::vector<Ring> rings;
    while (!next.empty()) {
      Ring& ring = rings.emplace_back();
      auto at = next.begin();
      while (at != next.end()) {
        ring.push_back(at->first);
        const ElementPoint to = at->second;
        next.erase(at);
        at = to == ring.front() ? next.end() : next.find(to);
        if (at == next.end() && to != ring.front()) return std::nullopt;
      }
    }
    return sorted(std::move(rings), normal);
  }

  static std::optional<std::vector<Ring>> sorted(std::vector<Ring> rings, const Vector& normal) {
    std::size_t outer = rings.size();
    for (std::size_t r = 0; r < rings.size(); ++r) {
      if (rings[r].size() < 3) return std::nullopt;
      if (dot(newell(rings[r]), normal) <= 0) continue;
      if (outer != rings.size()) return std::nullopt;
      outer = r;
    }
    if (outer == rings.size() || !are_apart(rings)) return std::nullopt;
    std::rotate(rings.begin(), rings.begin() + static_cast<std::ptrdiff_t>(outer),
                rings.begin() + static_cast<std::ptrdiff_t>(outer) + 1);
    return rings;
  }

  /// Whether no corner comes near an edge that does not end there.
  static bool are_apart(const std::vector<Ring>& rings) {
    for (const Ring& of : rings)
      for (const ElementPoint& p : of)
        for (const Ring& ring : rings) {
          bool apart = true;
          for_each_edge(ring, [&](const ElementPoint& a, const ElementPoint& b) {
            apart = apart && (p == a || p == b || distance(p, a, b) >= kApart);
          });
          if (!apart) return false;
        }
    return true;
  }

  std::vector<Face> faces_;
  std::map<Edge, std::vector<std::size_t>> at_edge_;
};

/// Points of a ring that may go, between two that stay: the one farthest off the line between these becomes a corner, where
/// it lies off it. Each point of a fine arc lies on the line between its neighbours. False where nothing is off.
bool keep_off_chord(const Ring& ring, std::set<ElementPoint>& corners) {
  const std::size_t n = ring.size();
  const auto stays = [&](std::size_t i) { return corners.count(ring[i % n]) > 0; };
  std::size_t first = 0;
  while (first < n && !stays(first)) ++first;
  if (first == n) return corners.insert(*std::min_element(ring.begin(), ring.end())).second;
  bool any = false;
  for (std::size_t i = first; i < first + n;) {
    std::size_t end = i + 1;
    while (!stays(end)) ++end;
    std::size_t farthest = i;
    double most = kOffChord;
    for (std::size_t k = i + 1; k < end; ++k)
      if (const double off = distance(ring[k % n], ring[i % n], ring[end % n]); off > most) most = off, farthest = k;
    if (farthest != i) any = corners.insert(ring[farthest % n]).second || any;
    i = end;
  }
  return any;
}

/// Leaves points out that lie on a straight line wherever they are used.
void drop_straight_points(std::vector<ElementPolygon>& polygons) {
  std::set<ElementPoint> corners, straight;
  const auto each = [&](const auto& use) {
    for (ElementPolygon& polygon : polygons)
      for (Ring& ring : polygon.rings) use(ring);
  };
  each([&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const ElementPoint &a = ring[i == 0 ? ring.size() - 1 : i - 1], &b = ring[i],
                         &c = ring[i + 1 == ring.size() ? 0 : i + 1];
      const bool onwards = dot(between(a, b), between(b, c)) > 0;
      (onwards && distance(b, a, c) <= kOffLine ? straight : corners).insert(b);
    }
  });
  for (bool again = true; again;) {
    again = false;
    each([&](const Ring& ring) { again = keep_off_chord(ring, corners) || again; });
  }
  each([&](Ring& ring) {
    Ring left;
    for (const ElementPoint& p : ring)
      if (corners.count(p) || !straight.count(p)) left.push_back(p);
    if (left.size() >= 3) ring = std::move(left);
  });
}

}  // namespace

std::vector<ElementPolygon> element_polygons(const model::ColouredElement& element) {
  const model::ElementMesh& mesh = element.element->mesh;
  std::vector<Face> faces;
  for (const model::ElementFace& face : mesh.faces) {
    Ring ring = rounded(mesh, face);
    if (ring.empty()) continue;
    const Vector normal = newell(ring);
    faces.push_back({element.materials[static_cast<std::size_t>(face.part)], std::move(ring), normal, length(normal)});
  }
  std::vector<ElementPolygon> out = Joiner(std::move(faces)).polygons();
  drop_straight_points(out);
  return out;
}

}  // namespace blockrand::outputs
