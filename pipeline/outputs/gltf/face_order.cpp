#include "pipeline/outputs/gltf/face_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace blockrand::outputs {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// Of a normal in 1/127: a flatter face has no direction to the right.
constexpr double kLeastAcross = 20;

struct Triangle {
  std::uint32_t column = 0;  ///< the last that it reaches
  std::int64_t up = 0;       ///< sum of its corners
  std::array<std::uint16_t, 3> corners{};
};

class FaceOrder {
 public:
  FaceOrder(std::span<const FaceCorner> corners, double column)
      : corners_(corners),
        gap_(column),
        along_(corners.size()),
        column_(corners.size()),
        seen_(corners.size(), false) {}

  /// Appends the triangles of a face. \param list  their indices
  void add(std::span<const std::uint16_t> list, std::vector<std::uint16_t>& out) {
    set_columns(list);
    triangles_.clear();
    for (std::size_t t = 0; t + 2 < list.size(); t += 3) {
      Triangle triangle;
      std::size_t first = 0;
      const auto key = [&](std::size_t k) { return std::pair(column_[list[t + k]], corners_[list[t + k]].steps[2]); };
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.column = std::max(triangle.column, column_[list[t + k]]);
        triangle.up += corners_[list[t + k]].steps[2];
        if (key(k) < key(first)) first = k;
      }
      for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = list[t + (first + k) % 3];
      triangles_.push_back(triangle);
    }
    std::stable_sort(triangles_.begin(), triangles_.end(), [](const Triangle& a, const Triangle& b) {
      return std::tie(a.column, a.up) < std::tie(b.column, b.up);
    });
    for (const Triangle& t : triangles_) out.insert(out.end(), t.corners.begin(), t.corners.end());
  }

 private:
  void set_columns(std::span<const std::uint16_t> list) {
    const std::array<std::int8_t, 3>& n = corners_[list.front()].normal;
    const double across = std::sqrt(static_cast<double>(n[0] * n[0] + n[1] * n[1]));
    const double east = across < kLeastAcross ? 1 : -n[1] / across, north = across < kLeastAcross ? 0 : n[0] / across;
    used_.clear();
    for (const std::uint16_t i : list) {
      if (seen_[i]) continue;
      seen_[i] = true;
      used_.push_back(i);
      const auto& s = corners_[i].steps;
      along_[i] = static_cast<double>(s[0]) * east + static_cast<double>(s[1]) * north;
    }
    std::sort(used_.begin(), used_.end(),
              [&](std::uint16_t a, std::uint16_t b) { return std::pair(along_[a], a) < std::pair(along_[b], b); });
    std::uint32_t column = 0;
    for (std::size_t k = 0; k < used_.size(); ++k) {
      if (k > 0 && along_[used_[k]] - along_[used_[k - 1]] > gap_) ++column;
      column_[used_[k]] = column;
      seen_[used_[k]] = false;
    }
  }

  std::span<const FaceCorner> corners_;
  double gap_;
  std::vector<double> along_;
  std::vector<std::uint32_t> column_;
  std::vector<bool> seen_;
  std::vector<std::uint16_t> used_;
  std::vector<Triangle> triangles_;
};

/// The list divided into faces, one behind the other by their first triangles.
struct Faces {
  std::vector<std::uint16_t> indices;
  std::vector<std::size_t> ends;
};

Faces divided(const std::vector<std::uint16_t>& indices, std::size_t vertices) {
  std::vector<std::uint32_t> root(vertices);
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3)
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = find(indices[t]), b = find(indices[t + k]);
      root[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::uint32_t> number(vertices, kNone);
  std::vector<std::size_t> size;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    std::uint32_t& n = number[find(indices[t])];
    if (n == kNone) {
      n = static_cast<std::uint32_t>(size.size());
      size.push_back(0);
    }
    size[n] += 3;
  }
  Faces out;
  out.indices.resize(indices.size());
  std::vector<std::size_t> at;
  std::size_t sum = 0;
  for (const std::size_t s : size) {
    at.push_back(sum);
    sum += s;
    out.ends.push_back(sum);
  }
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    std::size_t& to = at[number[find(indices[t])]];
    for (std::size_t k = 0; k < 3; ++k) out.indices[to++] = indices[t + k];
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> order_along_faces(std::vector<std::uint16_t>& indices, std::span<const FaceCorner> corners,
                                             double column) {
  const Faces faces = divided(indices, corners.size());
  FaceOrder order(corners, column);
  indices.clear();
  std::size_t begin = 0;
  for (const std::size_t end : faces.ends) {
    order.add(std::span(faces.indices).subspan(begin, end - begin), indices);
    begin = end;
  }
  std::vector<std::uint32_t> numbers(corners.size(), kNone);
  std::uint32_t next = 0;
  for (std::uint16_t& i : indices) {
    if (numbers[i] == kNone) numbers[i] = next++;
    i = static_cast<std::uint16_t>(numbers[i]);
  }
  return numbers;
}

}  // namespace blockrand::outputs
