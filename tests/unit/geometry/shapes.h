// Plans and random numbers for geometry tests.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/model/polygon.h"

namespace blockrand::testing_shapes {

inline model::Ring ring(std::vector<model::Point2> points) {
  model::Ring r;
  r.nodes.assign(points.size(), 0);
  r.points = std::move(points);
  return r;
}

inline model::Polygon polygon(std::vector<model::Point2> points) { return {ring(std::move(points)), {}}; }

/// The same plan turned by 33 degrees and moved to where UTM coordinates lie, on the grid.
inline model::Polygon turned(const model::Polygon& p) {
  const auto turn = [](model::Ring r) {
    constexpr double c = 0.83867056794542402964, s = 0.54463903501502708222;
    for (auto& q : r.points)
      q = model::snap(model::Point2{391000.5 + c * q.x - s * q.y, 5819000.25 + s * q.x + c * q.y});
    return r;
  };
  model::Polygon out{turn(p.outer), {}};
  for (const auto& h : p.holes) out.holes.push_back(turn(h));
  return out;
}

/// A seeded stream of numbers, the same on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed) {}
  std::uint64_t next(std::uint64_t below) { return base::random_bits(seed_, count_++, "test") % below; }
  double unit() { return base::random_unit(seed_, count_++, "test"); }

 private:
  std::uint64_t seed_, count_ = 0;
};

}  // namespace blockrand::testing_shapes
