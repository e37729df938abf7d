#include "pipeline/geometry/weighted_skeleton.h"

#include <algorithm>

#include "pipeline/geometry/weighted_sweep.h"

namespace blockrand::geometry {

double WeightedSkeleton::height() const {
  double most = 0;
  for (const WeightedSkeletonNode& n : nodes) most = std::max(most, n.height);
  return most;
}

std::string_view name(SkeletonFailure failure) {
  constexpr std::string_view names[] = {"too large", "bad slope", "unbounded", "inconsistent"};
  return names[static_cast<int>(failure)];
}

tl::expected<WeightedSkeleton, SkeletonFailure> weighted_skeleton(const model::Polygon& polygon,
                                                                  std::span<const EdgeProfile> profiles,
                                                                  std::optional<double> deck,
                                                                  std::span<const CornerEaves> corners) {
  return moving_planes::Sweep(polygon, profiles, deck, corners).run();
}

}  // namespace blockrand::geometry
