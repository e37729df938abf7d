// Builds indexed solids face by face, merging equal points.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "pipeline/geometry/grid.h"
#include "pipeline/model/solid.h"

namespace blockrand::geometry {

/// Points are rounded to the 1/1024 m grid; equal ones become one vertex. Within a loop, consecutive repetitions are
/// dropped; a face whose outer loop keeps fewer than three points is left out, as is a hole.
class SolidBuilder {
 public:
  /// Adds a face with its loops, outer first (counter-clockwise from outside), holes clockwise.
  void add_face(std::span<const std::vector<model::Point3>> loops, model::Face looks);
  void add_face(const std::vector<model::Point3>& outer, model::Face looks) { add_face(std::span(&outer, 1), looks); }

  /// The finished solid; the builder is empty afterwards.
  model::Solid take();

 private:
  struct Hash {
    std::size_t operator()(const Grid3& g) const {
      std::uint64_t h = static_cast<std::uint64_t>(g.x) * 0x9e3779b97f4a7c15ULL;
      h ^= (static_cast<std::uint64_t>(g.y) + 0x7f4a7c15ULL) * 0xc2b2ae3d27d4eb4fULL;
      h ^= (static_cast<std::uint64_t>(g.z) + 0x165667b1ULL) * 0xd6e8feb86659fd93ULL;
      return h ^ (h >> 29);
    }
  };
  std::uint32_t vertex(model::Point3 p);

  model::Solid solid_;
  std::unordered_map<Grid3, std::uint32_t, Hash> vertex_at_;
};

}  // namespace blockrand::geometry
