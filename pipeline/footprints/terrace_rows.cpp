#include "pipeline/footprints/terrace_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::footprints {

namespace {

using model::Point2;

class Union {
 public:
  explicit Union(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  /// The root is the least member, so that it does not depend on the order of links.
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

bool segments_cross(Point2 a, Point2 b, Point2 c, Point2 d) {
  const auto side = [](Point2 p, Point2 q, Point2 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); };
  const double s = side(a, b, c), t = side(a, b, d), u = side(c, d, a), v = side(c, d, b);
  return ((s > 0) != (t > 0)) && ((u > 0) != (v > 0));
}

double box_gap(double low1, double high1, double low2, double high2) {
  return std::max({0.0, low2 - high1, low1 - high2});
}

bool rings_near(std::span<const Point2> p, std::span<const Point2> q, const PlanBox& q_box, double distance) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 a = p[i], b = p[(i + 1) % p.size()];
    const double x0 = std::min(a.x, b.x), x1 = std::max(a.x, b.x), y0 = std::min(a.y, b.y), y1 = std::max(a.y, b.y);
    if (box_gap(x0, x1, q_box.minimum.x, q_box.maximum.x) > distance ||
        box_gap(y0, y1, q_box.minimum.y, q_box.maximum.y) > distance)
      continue;
    for (std::size_t k = 0; k < q.size(); ++k) {
      const Point2 c = q[k], d = q[(k + 1) % q.size()];
      if (box_gap(x0, x1, std::min(c.x, d.x), std::max(c.x, d.x)) > distance ||
          box_gap(y0, y1, std::min(c.y, d.y), std::max(c.y, d.y)) > distance)
        continue;
      if (segments_cross(a, b, c, d) || geometry::distance_to_segment(a, c, d) <= distance ||
          geometry::distance_to_segment(b, c, d) <= distance || geometry::distance_to_segment(c, a, b) <= distance ||
          geometry::distance_to_segment(d, a, b) <= distance)
        return true;
    }
  }
  return false;
}

/// Inside the area that all rings enclose (even-odd).
bool inside(const FootprintStore& store, std::uint32_t building, Point2 p) {
  bool odd = false;
  store.for_each_ring(building, [&](std::span<const Point2> ring, bool) {
    if (geometry::contains(ring, p)) odd = !odd;
  });
  return odd;
}

bool near(const FootprintStore& store, std::uint32_t a, std::uint32_t b, double distance) {
  bool found = false;
  Point2 of_a, of_b;
  bool first_a = true;
  store.for_each_ring(a, [&](std::span<const Point2> p, bool) {
    if (first_a) of_a = p.front();
    first_a = false;
    bool first_b = true;
    store.for_each_ring(b, [&](std::span<const Point2> q, bool) {
      if (first_b) of_b = q.front();
      first_b = false;
      found = found || rings_near(p, q, store[b].box, distance);
    });
  });
  return found || inside(store, a, of_b) || inside(store, b, of_a);
}

std::pair<std::int64_t, std::int64_t> terrace_row_cell(const PlanBox& box) {
  const Point2 c = box.centre();
  return {static_cast<std::int64_t>(std::floor(c.x / kTerraceRowCell)),
          static_cast<std::int64_t>(std::floor(c.y / kTerraceRowCell))};
}

}  // namespace

std::vector<TerraceRowPlan> find_terrace_rows(const FootprintStore& store, double link_distance) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links;
  for (const auto& [a, b] : index_of(store).pairs(link_distance))
    if (near(store, a, b, link_distance)) links.emplace_back(a, b);

  const std::size_t n = store.size();
  Union whole(n);
  for (const auto& [a, b] : links) whole.join(a, b);
  std::vector<PlanBox> boxes(n);
  for (std::uint32_t i = 0; i < n; ++i) boxes[whole.find(i)].include(store[i].box);
  const auto too_long = [&](std::uint32_t i) {
    const PlanBox& box = boxes[whole.find(i)];
    return !box.empty() &&
           std::max(box.maximum.x - box.minimum.x, box.maximum.y - box.minimum.y) > kMaxTerraceRowExtent;
  };
  Union rows(n);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cut;
  for (const auto& [a, b] : links) {
    if (too_long(a) && terrace_row_cell(store[a].box) != terrace_row_cell(store[b].box))
      cut.emplace_back(a, b);
    else
      rows.join(a, b);
  }

  std::vector<std::uint32_t> number(n, model::kNoIndex);
  std::vector<TerraceRowPlan> out;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (store[i].box.empty()) continue;
    const std::uint32_t root = rows.find(i);
    if (number[root] == model::kNoIndex) {
      number[root] = static_cast<std::uint32_t>(out.size());
      out.emplace_back();
    }
    out[number[root]].buildings.push_back(i);
  }
  for (const auto& [a, b] : cut) {
    out[number[rows.find(a)]].beyond.push_back(b);
    out[number[rows.find(b)]].beyond.push_back(a);
  }
  for (TerraceRowPlan& row : out) {
    std::sort(row.buildings.begin(), row.buildings.end(),
              [&](std::uint32_t a, std::uint32_t b) { return store[a].id < store[b].id; });
    std::sort(row.beyond.begin(), row.beyond.end(),
              [&](std::uint32_t a, std::uint32_t b) { return store[a].id < store[b].id; });
    row.beyond.erase(std::unique(row.beyond.begin(), row.beyond.end()), row.beyond.end());
  }
  return out;
}

}  // namespace blockrand::footprints
