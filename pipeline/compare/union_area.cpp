#include "pipeline/compare/union_area.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace blockrand::compare {
namespace {

constexpr double kNoise = 1e-10;  // m. Edges that two polygons share differ by the last bits of where they were cut.
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Edge {
  double x0, y0, x1, y1;  // x0 < x1
  std::uint32_t polygon;
  double at(double x) const { return y0 + (y1 - y0) * ((x - x0) / (x1 - x0)); }
};

/// Sweeps over edges that all span the slab.
class Slab {
 public:
  Slab(const std::vector<Edge>& edges, const Box& window) : edges_(edges), window_(window) {}

  double area(const std::vector<std::uint32_t>& active, double left, double right) {
    if (active.empty() || !(right > left)) return 0;
    find_crossings(active, left, right);
    double area = 0, from = left;
    for (const double to : cuts_) {
      if (to > from) area += (to - from) * covered_length(active, 0.5 * (from + to));
      from = std::max(from, to);
    }
    return area;
  }

 private:
  struct Ends {
    double left, right;
  };

  /// x of all crossings inside of the slab, and its right end: sorting by the heights on the right what is sorted by
  /// those on the left exchanges just the edges that cross.
  void find_crossings(const std::vector<std::uint32_t>& active, double left, double right) {
    cuts_.assign(1, right);
    ends_.clear();
    for (const std::uint32_t e : active) ends_.push_back({edges_[e].at(left), edges_[e].at(right)});
    std::sort(ends_.begin(), ends_.end(),
              [](const Ends& a, const Ends& b) { return a.left != b.left ? a.left < b.left : a.right < b.right; });
    for (std::size_t i = 1; i < ends_.size(); ++i) {
      const Ends moving = ends_[i];
      std::size_t j = i;
      for (; j > 0 && ends_[j - 1].right > moving.right; --j) {
        const double before = moving.left - ends_[j - 1].left, after = ends_[j - 1].right - moving.right;
        if (before > kNoise && after > kNoise) cuts_.push_back(left + (right - left) * (before / (before + after)));
        ends_[j] = ends_[j - 1];
      }
      ends_[j] = moving;
    }
    std::sort(cuts_.begin(), cuts_.end());
  }

  double covered_length(const std::vector<std::uint32_t>& active, double x) {
    heights_.clear();
    for (const std::uint32_t e : active) heights_.emplace_back(edges_[e].polygon, edges_[e].at(x));
    std::sort(heights_.begin(), heights_.end());
    spans_.clear();
    for (std::size_t i = 0; i + 1 < heights_.size();) {
      if (heights_[i].first != heights_[i + 1].first) {
        ++i;
        continue;
      }
      const double low = std::max(heights_[i].second, window_.bottom);
      const double high = std::min(heights_[i + 1].second, window_.top);
      if (high > low) spans_.emplace_back(low, high);
      i += 2;
    }
    std::sort(spans_.begin(), spans_.end());
    double length = 0, reached = -kInfinite;
    for (const auto& [low, high] : spans_) {
      if (high <= reached) continue;
      length += high - std::max(low, reached);
      reached = high;
    }
    return length;
  }

  const std::vector<Edge>& edges_;
  const Box& window_;
  std::vector<double> cuts_;
  std::vector<Ends> ends_;
  std::vector<std::pair<std::uint32_t, double>> heights_;
  std::vector<std::pair<double, double>> spans_;
};

}  // namespace

Box box_of(const FlatPolygon& polygon) {
  Box box{kInfinite, -kInfinite, kInfinite, -kInfinite};
  for (const auto& ring : polygon) {
    for (const model::Point2& p : ring) {
      box.left = std::min(box.left, p.x);
      box.right = std::max(box.right, p.x);
      box.bottom = std::min(box.bottom, p.y);
      box.top = std::max(box.top, p.y);
    }
  }
  return box;
}

double union_area(std::span<const FlatPolygon> polygons) {
  return union_area(polygons, {-kInfinite, kInfinite, -kInfinite, kInfinite});
}

double union_area(std::span<const FlatPolygon> polygons, const Box& window) {
  std::vector<Edge> edges;
  std::vector<double> xs;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (!box_of(polygons[i]).meets(window)) continue;
    for (const auto& ring : polygons[i]) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        model::Point2 a = ring[k], b = ring[k + 1 == ring.size() ? 0 : k + 1];
        if (a.x > b.x) std::swap(a, b);
        if (!(a.x < b.x) || b.x <= window.left || a.x >= window.right) continue;
        edges.push_back({a.x, a.y, b.x, b.y, static_cast<std::uint32_t>(i)});
        xs.push_back(std::max(a.x, window.left));
        xs.push_back(std::min(b.x, window.right));
      }
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    if (a.x0 != b.x0) return a.x0 < b.x0;
    if (a.y0 != b.y0) return a.y0 < b.y0;
    if (a.x1 != b.x1) return a.x1 < b.x1;
    if (a.y1 != b.y1) return a.y1 < b.y1;
    return a.polygon < b.polygon;
  });
  std::sort(xs.begin(), xs.end());
  xs.erase(std::unique(xs.begin(), xs.end()), xs.end());

  Slab slab(edges, window);
  std::vector<std::uint32_t> active;
  std::size_t next = 0;
  double area = 0;
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    std::erase_if(active, [&](std::uint32_t e) { return edges[e].x1 <= xs[i]; });
    for (; next < edges.size() && edges[next].x0 <= xs[i]; ++next)
      if (edges[next].x1 > xs[i]) active.push_back(static_cast<std::uint32_t>(next));
    area += slab.area(active, xs[i], xs[i + 1]);
  }
  return area;
}

}  // namespace blockrand::compare
