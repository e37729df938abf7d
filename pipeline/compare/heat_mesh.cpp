#include "pipeline/compare/heat_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "pipeline/compare/area_vector.h"

namespace blockrand::compare {
namespace {

class Cutter {
 public:
  Cutter(double max_edge, std::size_t room) : max_squared_(max_edge * max_edge), room_(room) {}

  /// \returns false where that makes more than `room` triangles in all
  bool add(const Triangle3& triangle) {
    std::vector<Triangle3> open{triangle};
    while (!open.empty()) {
      const Triangle3 t = open.back();
      open.pop_back();
      std::size_t longest = 0;
      double size = -1;
      for (std::size_t i = 0; i < 3; ++i) {
        const Point3 edge = t[(i + 1) % 3] - t[i];
        if (dot(edge, edge) > size) {
          size = dot(edge, edge);
          longest = i;
        }
      }
      const Point3 a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
      if (!(size > max_squared_)) {
        if (mesh.triangles.size() + open.size() >= room_) return false;
        mesh.triangles.push_back({index(a), index(b), index(c)});
        continue;
      }
      // The same from both ends, so that neighbours meet.
      const Point3 middle{(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
      open.push_back({middle, b, c});
      open.push_back({a, middle, c});
    }
    return true;
  }

  HeatMesh mesh;

 private:
  std::uint32_t index(Point3 p) {
    const auto [at, added] = index_of_.try_emplace(p, static_cast<std::uint32_t>(mesh.points.size()));
    if (added) mesh.points.push_back(p);
    return at->second;
  }

  double max_squared_;
  std::size_t room_;
  std::map<Point3, std::uint32_t> index_of_;
};

}  // namespace

HeatMesh cut_small(const std::vector<Triangle3>& triangles, double max_edge, std::size_t max_triangles) {
  std::vector<const Triangle3*> sound;
  for (const Triangle3& t : triangles)
    if (std::all_of(t.begin(), t.end(),
                    [](Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }))
      sound.push_back(&t);
  const std::size_t room = std::max(max_triangles, 2 * sound.size());
  for (double edge = max_edge;; edge *= 1.5) {
    Cutter cutter(edge, room);
    if (std::all_of(sound.begin(), sound.end(), [&](const Triangle3* t) { return cutter.add(*t); }))
      return std::move(cutter.mesh);
  }
}

}  // namespace blockrand::compare
