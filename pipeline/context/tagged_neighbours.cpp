#include "pipeline/context/tagged_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace blockrand::context {

TaggedNeighbours::TaggedNeighbours(std::vector<TaggedBuilding> buildings, double reach)
    : reach_(reach), buildings_(std::move(buildings)) {
  std::vector<geometry::PlanBox> places;
  places.reserve(buildings_.size());
  for (const TaggedBuilding& b : buildings_) places.push_back({b.place, b.place});
  places_ = geometry::BoxIndex(std::move(places));
}

template <class Visit>
void TaggedNeighbours::for_each_near(model::Point2 place, std::uint8_t group, model::OsmId self, Visit&& visit) const {
  for (const std::uint32_t i : places_.near({place, place}, reach_)) {
    const TaggedBuilding& b = buildings_[i];
    if (b.group != group || b.id == self) continue;
    const double dx = b.place.x - place.x, dy = b.place.y - place.y;
    if (dx * dx + dy * dy <= reach_ * reach_) visit(b);
  }
}

std::optional<NeighbourVote<double>> TaggedNeighbours::storeys(model::Point2 place, std::uint8_t group,
                                                               model::OsmId self, int minimum) const {
  std::vector<float> values;
  for_each_near(place, group, self, [&](const TaggedBuilding& b) {
    if (b.storeys) values.push_back(*b.storeys);
  });
  if (static_cast<int>(values.size()) < minimum || values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const float median = values[(values.size() - 1) / 2];
  const auto agree =
      std::count_if(values.begin(), values.end(), [&](float v) { return std::fabs(v - median) <= 0.5f; });
  return NeighbourVote<double>{median, static_cast<int>(values.size()),
                               static_cast<double>(agree) / static_cast<double>(values.size())};
}

std::optional<NeighbourVote<model::RoofShape>> TaggedNeighbours::roof_shape(model::Point2 place, std::uint8_t group,
                                                                            model::OsmId self, int minimum) const {
  std::array<int, model::kRoofShapeCount> votes{};
  int voices = 0;
  for_each_near(place, group, self, [&](const TaggedBuilding& b) {
    if (!b.roof_shape) return;
    ++votes[static_cast<std::size_t>(*b.roof_shape)];
    ++voices;
  });
  if (voices < minimum || voices == 0) return std::nullopt;
  const auto best = std::max_element(votes.begin(), votes.end());
  return NeighbourVote<model::RoofShape>{static_cast<model::RoofShape>(best - votes.begin()), voices,
                                         static_cast<double>(*best) / voices};
}

std::vector<TaggedBuilding> TaggedNeighbours::near(const geometry::PlanBox& box) const {
  std::vector<TaggedBuilding> out;
  for (const std::uint32_t i : places_.near(box, reach_)) out.push_back(buildings_[i]);
  return out;
}

}  // namespace blockrand::context
