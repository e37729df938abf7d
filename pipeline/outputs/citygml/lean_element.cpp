#include "pipeline/outputs/citygml/lean_element.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace blockrand::outputs {
namespace {

constexpr double kStepsPerMetre = 1e4;

struct Box {
  ElementPoint min, max;
  bool empty = true;
  void add(const ElementPoint& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      min[i] = empty ? p[i] : std::min(min[i], p[i]);
      max[i] = empty ? p[i] : std::max(max[i], p[i]);
    }
    empty = false;
  }
  /// m, of the longest side
  double length() const {
    return static_cast<double>(std::max({max[0] - min[0], max[1] - min[1], max[2] - min[2]})) / kStepsPerMetre;
  }
};

/// By polygon the piece that it belongs to, by its first polygon.
std::vector<std::size_t> pieces_of(const std::vector<ElementPolygon>& polygons) {
  std::vector<std::size_t> first(polygons.size());
  std::iota(first.begin(), first.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (first[i] != i) i = first[i] = first[first[i]];
    return i;
  };
  std::map<ElementPoint, std::size_t> at;
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (const auto& ring : polygons[i].rings)
      for (const ElementPoint& p : ring) {
        const std::size_t a = root(at.try_emplace(p, i).first->second), b = root(i);
        first[std::max(a, b)] = std::min(a, b);
      }
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = root(i);
  return first;
}

/// Twice the area, squared, without the holes.
double size_of(const ElementPolygon& polygon) {
  double sum[3] = {0, 0, 0};
  const auto& ring = polygon.rings.front();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      sum[k] += static_cast<double>((ring[i][a] - ring[0][a]) * (ring[i + 1][b] - ring[0][b]) -
                                    (ring[i][b] - ring[0][b]) * (ring[i + 1][a] - ring[0][a]));
    }
  return sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
}

std::vector<ElementPolygon> faces_of(const Box& box, const model::PartMaterial& look) {
  const auto corner = [&](unsigned i) {
    return ElementPoint{i & 1u ? box.max[0] : box.min[0], i & 2u ? box.max[1] : box.min[1],
                        i & 4u ? box.max[2] : box.min[2]};
  };
  std::vector<ElementPolygon> out;
  // Bit 0 is x, 1 is y, 2 is z; counter-clockwise from outside.
  for (const auto& [a, b, c, d] : {std::array{0u, 1u, 5u, 4u}, std::array{3u, 2u, 6u, 7u}, std::array{2u, 0u, 4u, 6u},
                                   std::array{1u, 3u, 7u, 5u}, std::array{0u, 2u, 3u, 1u}, std::array{4u, 5u, 7u, 6u}})
    out.push_back({look, {{corner(a), corner(b), corner(c), corner(d)}}});
  return out;
}

}  // namespace

std::vector<ElementPolygon> without_small_pieces(std::vector<ElementPolygon> polygons) {
  const std::vector<std::size_t> piece = pieces_of(polygons);
  std::map<std::size_t, Box> boxes;
  Box all;
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (const auto& ring : polygons[i].rings)
      for (const ElementPoint& p : ring) boxes[piece[i]].add(p), all.add(p);
  if (boxes.size() < 2) return polygons;
  double longest = 0;
  for (const auto& [first, box] : boxes) longest = std::max(longest, box.length());
  if (longest >= kRowPiece || 2 * longest >= all.length()) {
    std::vector<ElementPolygon> large;
    for (std::size_t i = 0; i < polygons.size(); ++i)
      if (boxes[piece[i]].length() >= kSmallPiece) large.push_back(polygons[i]);
    return large.empty() ? polygons : large;
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (all.min[i] == all.max[i]) return polygons;  // flat: no box
  const auto largest =
      std::max_element(polygons.begin(), polygons.end(),
                       [](const ElementPolygon& a, const ElementPolygon& b) { return size_of(a) < size_of(b); });
  return faces_of(all, largest->look);
}

}  // namespace blockrand::outputs
