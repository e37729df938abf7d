#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "pipeline/context/wall_segments.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {

namespace {

using model::Point2;
using Box = VicinityIndex::Box;

void grow(Box& box, std::span<const Point2> points) {
  for (const Point2 p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
}

Box empty_box() {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return {{kFar, kFar}, {-kFar, -kFar}};
}

Box box_around(std::span<const Point2> points) {
  Box box = empty_box();
  grow(box, points);
  return box;
}

template <class Items, class BoxOf>
std::vector<std::uint32_t> meeting(const Items& items, const Box& box, BoxOf&& of) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < items.size(); ++i)
    if (of(items[i]).meets(box)) out.push_back(i);
  return out;
}

}  // namespace

Box box_of(const model::Building& building, double margin) {
  Box box = empty_box();
  for (const model::Polygon& polygon : building.outline) grow(box, polygon.outer.points);
  return {{box.low.x - margin, box.low.y - margin}, {box.high.x + margin, box.high.y + margin}};
}

VicinityIndex::VicinityIndex(const Vicinity& vicinity)
    : all_(vicinity), scene_(vicinity.footprints, vicinity.lines, kWallSegmentReach) {
  for (std::uint32_t b = 0; b < all_.blocks.size(); ++b) {
    block_boxes_.push_back(box_around(all_.blocks[b].polygon.outer.points));
    if (b >= all_.figures.size()) continue;
    const std::vector<Courtyard>& yards = all_.figures[b].courtyards;
    for (std::uint32_t y = 0; y < yards.size(); ++y)
      yards_.push_back({b, y, box_around(yards[y].polygon.outer.points)});
  }
  std::map<model::OsmId, Square> squares;
  for (std::uint32_t l = 0; l < all_.lines.size(); ++l) {
    const NetworkLine& line = all_.lines[l];
    if (!line.area || line.kind != LineClass::pedestrian || line.tunnel) continue;
    const auto [square, fresh] = squares.try_emplace(line.id);
    if (fresh) square->second.box = empty_box();
    square->second.rings.push_back(l);
    grow(square->second.box, line.points);
  }
  for (auto& [id, square] : squares) squares_.push_back(std::move(square));
  for (const PassageWay& way : all_.passages) passage_boxes_.push_back(box_around(way.points));
  std::vector<geometry::PlanBox> places, footprints;
  for (const auto& point : all_.points) places.push_back({point.place, point.place});
  for (const Footprint& f : all_.footprints) footprints.push_back(geometry::box_of(f.polygon.outer.points));
  points_ = geometry::BoxIndex(std::move(places));
  footprints_ = geometry::BoxIndex(std::move(footprints));
}

bool VicinityIndex::contains(const Square& square, Point2 p) const {
  bool inside = false;  // rings of an area, outer and inner: those around the point are counted
  for (const std::uint32_t ring : square.rings)
    if (geometry::contains(all_.lines[ring].points, p)) inside = !inside;
  return inside;
}

std::vector<std::uint32_t> VicinityIndex::yards_near(const Box& box) const {
  return meeting(yards_, box, [](const Yard& y) { return y.box; });
}
std::vector<std::uint32_t> VicinityIndex::squares_near(const Box& box) const {
  return meeting(squares_, box, [](const Square& s) { return s.box; });
}
std::vector<std::uint32_t> VicinityIndex::passages_near(const Box& box) const {
  return meeting(passage_boxes_, box, [](const Box& b) { return b; });
}

std::vector<std::uint32_t> VicinityIndex::points_near(const Box& box) const {
  return points_.near({box.low, box.high}, 0);
}

std::vector<std::uint32_t> VicinityIndex::footprints_at(Point2 place, double margin) const {
  return footprints_.near({{place.x - margin, place.y - margin}, {place.x + margin, place.y + margin}}, 0);
}

}  // namespace blockrand::context
