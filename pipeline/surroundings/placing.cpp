#include "pipeline/surroundings/placing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "pipeline/base/random.h"

namespace blockrand::surroundings {
namespace {

using model::Point2;

/// m. A longer row is a slip of the mouse.
constexpr double kLongestRow = 50000;
/// m: nearer to a mapped tree none is scattered.
constexpr double kCrown = 5;

std::uint64_t key_of(model::OsmId id) {
  return static_cast<std::uint64_t>(id.number) * 4 + static_cast<std::uint64_t>(id.type);
}

PlannedObject planned(const ChosenShape& chosen, model::OsmId id, Point2 place, double random_turn) {
  PlannedObject out;
  out.object.shape = chosen.shape;
  out.object.object = id;
  out.object.turn = static_cast<float>(chosen.turn.value_or(2 * std::numbers::pi * random_turn));
  out.object.width = chosen.width, out.object.height = chosen.height;
  out.place = model::snap(place);
  return out;
}

}  // namespace

std::optional<PlannedObject> object_at(const Catalogue& catalogue, std::string_view kind, model::OsmId id, Point2 place,
                                       const TagOf& tag, std::uint64_t seed) {
  if (catalogue.shapes_of(kind).empty()) return std::nullopt;
  const auto random = [&](std::string_view choice) { return base::random_unit(seed, key_of(id), choice); };
  return planned(choose_shape(catalogue, kind, tag, random), id, place, random("turn"));
}

std::vector<PlannedObject> row_of_trees(const Catalogue& catalogue, model::OsmId id, std::span<const Point2> line,
                                        const TagOf& tag, std::uint64_t seed) {
  std::vector<PlannedObject> out;
  if (catalogue.shapes_of("tree").empty()) return out;
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i)
    length += std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
  if (!(length > 0) || length > kLongestRow) return out;
  const auto gaps = static_cast<std::size_t>(std::max(1.0, std::round(length / kRowSpacing)));
  double before = 0;
  std::size_t segment = 1;
  for (std::size_t t = 0; t <= gaps; ++t) {
    const double at = length * static_cast<double>(t) / static_cast<double>(gaps);
    double own = std::hypot(line[segment].x - line[segment - 1].x, line[segment].y - line[segment - 1].y);
    while (at > before + own && segment + 1 < line.size()) {
      before += own, ++segment;
      own = std::hypot(line[segment].x - line[segment - 1].x, line[segment].y - line[segment - 1].y);
    }
    const double f = own > 0 ? std::clamp((at - before) / own, 0.0, 1.0) : 0;
    const Point2 a = line[segment - 1], b = line[segment];
    // A row is of one kind and age; its trees differ a little.
    const std::string number = std::to_string(t);
    const auto random = [&](std::string_view choice) {
      const double row = base::random_unit(seed, key_of(id), choice);
      if (choice != "size") return row;
      return 0.8 * row + 0.2 * base::random_unit(seed, key_of(id), "size " + number);
    };
    out.push_back(planned(choose_shape(catalogue, "tree", tag, random), id,
                          {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)},
                          base::random_unit(seed, key_of(id), "turn " + number)));
  }
  return out;
}

std::vector<PlannedObject> scattered_trees(const Catalogue& catalogue, std::span<const SquareSurface> surfaces,
                                           const GroundClaims& claims, std::span<const Point2> mapped,
                                           const std::function<TagOf(model::OsmId)>& tags, std::uint64_t seed) {
  std::vector<PlannedObject> out;
  if (catalogue.shapes_of("tree").empty()) return out;
  for (const SquareSurface& surface : surfaces) {
    if (surface.label >= claims.labels.size()) continue;
    const GroundLabel& label = claims.labels[surface.label];
    if (!(label.trees_per_hectare > 0)) continue;
    const double spacing = std::sqrt(10000 / static_cast<double>(label.trees_per_hectare));
    const TagOf tag = tags(label.object);
    for (const model::Polygon& polygon : surface.plan) {
      const geometry::PlanBox box = geometry::box_of(polygon.outer.points);
      const auto first_x = static_cast<std::int64_t>(std::floor(box.minimum.x / spacing));
      const auto first_y = static_cast<std::int64_t>(std::floor(box.minimum.y / spacing));
      for (std::int64_t y = first_y; static_cast<double>(y) * spacing <= box.maximum.y; ++y)
        for (std::int64_t x = first_x; static_cast<double>(x) * spacing <= box.maximum.x; ++x) {
          const std::uint64_t cell =
              base::mix64(base::mix64(static_cast<std::uint64_t>(x)) ^ static_cast<std::uint64_t>(y));
          const auto random = [&](std::string_view choice) {
            return base::random_unit(seed, cell ^ key_of(label.object), choice);
          };
          const Point2 place{(static_cast<double>(x) + 0.15 + 0.7 * random("east")) * spacing,
                             (static_cast<double>(y) + 0.15 + 0.7 * random("north")) * spacing};
          if (!holds(polygon, place) || distance_to(surface.borders, place) < kBorderDistance) continue;
          if (std::ranges::any_of(mapped, [&](Point2 m) { return std::hypot(m.x - place.x, m.y - place.y) < kCrown; }))
            continue;
          out.push_back(planned(choose_shape(catalogue, "tree", tag, random), label.object, place, random("turn")));
        }
    }
  }
  return out;
}

}  // namespace blockrand::surroundings
