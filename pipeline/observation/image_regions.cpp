#include "pipeline/observation/image_regions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace blockrand::observation {

namespace {

constexpr std::uint32_t kNone = 0xffffffff;
/// Levels of 255: mean colours of large regions are one when they differ by no more in any band; those of a region of n
/// pixels may differ by kFewPixels / sqrt(n) more.
constexpr double kOneColour = 9, kFewPixels = 30;

struct Edge {
  std::uint32_t a, b;
};

/// Sums of the pixels of a region, kept at its root.
class Forest {
 public:
  explicit Forest(std::size_t pixels) : parent_(pixels, kNone), count_(pixels, 0), sum_(pixels) {}
  void start(std::uint32_t i, const std::array<std::uint32_t, 3>& colour) {
    parent_[i] = i, count_[i] = 1, sum_[i] = colour;
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) parent_[i] = parent_[parent_[i]], i = parent_[i];
    return i;
  }
  std::uint32_t count(std::uint32_t root) const { return count_[root]; }
  /// Largest difference of the bands' means.
  double difference(std::uint32_t a, std::uint32_t b) const {
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k)
      most = std::max(
          most, std::fabs(static_cast<double>(sum_[a][k]) / count_[a] - static_cast<double>(sum_[b][k]) / count_[b]));
    return most;
  }
  double mean(std::uint32_t root, std::size_t band) const {
    return static_cast<double>(sum_[root][band]) / count_[root];
  }
  void join(std::uint32_t a, std::uint32_t b) {
    if (count_[a] < count_[b] || (count_[a] == count_[b] && b < a)) std::swap(a, b);
    parent_[b] = a, count_[a] += count_[b];
    for (std::size_t k = 0; k < 3; ++k) sum_[a][k] += sum_[b][k];
  }

 private:
  std::vector<std::uint32_t> parent_, count_;
  std::vector<std::array<std::uint32_t, 3>> sum_;
};

/// Sums over three by three pixels, as far as they are open, by their count: noise goes, edges stay.
std::vector<std::array<std::uint8_t, 3>> smoothed(const Patch& patch, std::span<const std::uint8_t> open) {
  std::vector<std::array<std::uint8_t, 3>> out(open.size());
  const int w = patch.width, h = patch.height;
  for (int r = 0; r < h; ++r)
    for (int c = 0; c < w; ++c) {
      const auto i = static_cast<std::size_t>(r) * static_cast<std::size_t>(w) + static_cast<std::size_t>(c);
      if (!open[i]) continue;
      unsigned sum[3] = {0, 0, 0}, n = 0;
      for (int y = std::max(0, r - 1); y <= std::min(h - 1, r + 1); ++y)
        for (int x = std::max(0, c - 1); x <= std::min(w - 1, c + 1); ++x) {
          const auto j = static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
          if (!open[j]) continue;
          sum[0] += patch.red[j], sum[1] += patch.green[j], sum[2] += patch.blue[j], ++n;
        }
      for (std::size_t k = 0; k < 3; ++k) out[i][k] = static_cast<std::uint8_t>((sum[k] + n / 2) / n);
    }
  return out;
}

/// Pairs of open neighbours, the most alike first; among equals in their order.
std::vector<Edge> sorted_edges(const Patch& patch, std::span<const std::uint8_t> open) {
  const std::vector<std::array<std::uint8_t, 3>> smooth = smoothed(patch, open);
  const auto unlike = [&](std::size_t i, std::size_t j) {
    int most = 0;
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(smooth[i][k] - smooth[j][k]));
    return static_cast<std::size_t>(most);
  };
  const auto w = static_cast<std::size_t>(patch.width);
  const auto each = [&](auto&& visit) {
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (!open[i]) continue;
      if ((i + 1) % w != 0 && open[i + 1]) visit(i, i + 1);
      if (i + w < open.size() && open[i + w]) visit(i, i + w);
    }
  };
  std::array<std::size_t, 257> start{};
  each([&](std::size_t i, std::size_t j) { ++start[unlike(i, j) + 1]; });
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  std::vector<Edge> edges(start.back());
  each([&](std::size_t i, std::size_t j) {
    edges[start[unlike(i, j)]++] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)};
  });
  return edges;
}

}  // namespace

ImageRegions grow_regions(const Patch& patch, std::span<const std::uint8_t> open, std::uint32_t least) {
  Forest forest(open.size());
  for (std::size_t i = 0; i < open.size(); ++i)
    if (open[i]) forest.start(static_cast<std::uint32_t>(i), {patch.red[i], patch.green[i], patch.blue[i]});
  const std::vector<Edge> edges = sorted_edges(patch, open);
  for (const Edge& e : edges) {
    const std::uint32_t a = forest.root(e.a), b = forest.root(e.b);
    if (a == b) continue;
    const double smaller = std::min(forest.count(a), forest.count(b));
    if (forest.difference(a, b) <= kOneColour + kFewPixels / std::sqrt(smaller)) forest.join(a, b);
  }
  for (const Edge& e : edges) {
    const std::uint32_t a = forest.root(e.a), b = forest.root(e.b);
    if (a != b && std::min(forest.count(a), forest.count(b)) < least) forest.join(a, b);
  }
  ImageRegions out;
  std::vector<std::uint32_t> number(open.size(), kNone), region_of(open.size(), kNone);
  for (std::uint32_t i = 0; i < open.size(); ++i) {
    if (!open[i]) continue;
    const std::uint32_t root = forest.root(i);
    if (forest.count(root) < least) continue;
    if (number[root] == kNone) {
      number[root] = static_cast<std::uint32_t>(out.regions.size());
      out.regions.push_back({0, forest.count(root), forest.mean(root, 0), forest.mean(root, 1), forest.mean(root, 2)});
    }
    region_of[i] = number[root];
  }
  std::uint32_t first = 0;
  for (ImageRegion& r : out.regions) r.first = first, first += r.count;
  out.pixels.resize(first);
  std::vector<std::uint32_t> next;
  for (const ImageRegion& r : out.regions) next.push_back(r.first);
  for (std::uint32_t i = 0; i < open.size(); ++i)
    if (region_of[i] != kNone) out.pixels[next[region_of[i]]++] = i;
  std::vector<std::uint64_t> pairs;
  for (const Edge& e : edges) {
    const std::uint32_t a = region_of[e.a], b = region_of[e.b];
    if (a != b && a != kNone && b != kNone)
      pairs.push_back(static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b));
  }
  std::sort(pairs.begin(), pairs.end());
  for (const std::uint64_t pair : pairs) {
    const auto a = static_cast<std::uint32_t>(pair >> 32), b = static_cast<std::uint32_t>(pair);
    if (out.borders.empty() || out.borders.back().a != a || out.borders.back().b != b) out.borders.push_back({a, b, 0});
    ++out.borders.back().length;
  }
  return out;
}

}  // namespace blockrand::observation
