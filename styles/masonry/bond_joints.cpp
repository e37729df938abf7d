#include "styles/masonry/bond_joints.h"

#include <algorithm>
#include <cmath>

namespace blockrand::masonry {
namespace {

/// Lengths of stones, in order, become places of joints.
std::vector<int> places(const std::vector<int>& stones) {
  std::vector<int> out;
  int at = 0;
  for (std::size_t i = 0; i + 1 < stones.size(); ++i) out.push_back(at += stones[i]);
  return out;
}

/// `ends` at both sides and `unit` repeated between them; what is left over lies in the middle.
std::vector<int> filled(std::vector<int> left, const std::vector<int>& unit, const std::vector<int>& right,
                        int quarters) {
  int room = quarters, step = 0;
  for (const int q : left) room -= q;
  for (const int q : right) room -= q;
  for (const int q : unit) step += q;
  const int count = room / step, rest = room % step, half = count / 2;
  for (int i = 0; i < count; ++i) {
    if (i == std::min(half, count - 1) && rest > 0) left.push_back(rest);
    left.insert(left.end(), unit.begin(), unit.end());
  }
  if (count == 0 && rest > 0) left.push_back(rest);
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

}  // namespace

int quarters_of(Bond bond, double length, double quarter) {
  const int odd = bond == Bond::header ? 1 : 0;
  return std::max(kShortestRun + odd, 2 * static_cast<int>(std::lround((length / quarter - odd) / 2)) + odd);
}

std::vector<int> bond_joints(Bond bond, int quarters, bool odd) {
  switch (bond) {
    case Bond::stretcher: {
      // 2 4 4 … 4 and 4 4 … 4 2 where that closes; else two three-quarter bricks in the middle, not above each other.
      if (quarters % 4 == 2) return places(odd ? filled({4}, {4}, {2}, quarters) : filled({2}, {4}, {4}, quarters));
      std::vector<int> stones = odd ? filled({4}, {4}, {2}, quarters - 2) : filled({2}, {4}, {4}, quarters - 2);
      const auto whole =
          std::find(stones.begin() + static_cast<std::ptrdiff_t>((stones.size() - 1) / 2), stones.end(), 4);
      const auto at = whole == stones.end() ? std::find(stones.begin(), stones.end(), 4) : whole;
      *at = 3;
      stones.insert(at, 3);
      return places(stones);
    }
    case Bond::header:
      // Heads with joints half a head aside: a three-quarter brick at the long end.
      return places(odd ? filled({3}, {2}, {2}, quarters) : filled({2}, {2}, {3}, quarters));
    case Bond::english:
      // Courses of stretchers and of headers; a closer behind the corner's header makes the lap of a quarter.
      return places(odd ? filled({4}, {2}, {2}, quarters) : filled({2, 1}, {4}, {3}, quarters));
    case Bond::flemish:
      // Stretcher and header in turn, headers in the middle above stretchers.
      return places(odd ? filled({3}, {2, 4}, {1, 2}, quarters) : filled({2, 4}, {2, 4}, {}, quarters));
    case Bond::ashlar:
    case Bond::rubble:
    case Bond::cyclopean:
      break;
  }
  return {};
}

}  // namespace blockrand::masonry
