#include "pipeline/geometry/box_index.h"

#include <algorithm>
#include <bit>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

namespace blockrand::geometry {

void PlanBox::include(model::Point2 p) {
  if (empty()) {
    minimum = maximum = p;
    return;
  }
  minimum = {std::min(minimum.x, p.x), std::min(minimum.y, p.y)};
  maximum = {std::max(maximum.x, p.x), std::max(maximum.y, p.y)};
}

void PlanBox::include(const PlanBox& other) {
  if (other.empty()) return;
  include(other.minimum);
  include(other.maximum);
}

PlanBox box_of(std::span<const model::Point2> points) {
  PlanBox box;
  for (const model::Point2 p : points) box.include(p);
  return box;
}

bool PlanBox::near(const PlanBox& other, double distance) const {
  if (empty() || other.empty()) return false;
  return minimum.x <= other.maximum.x + distance && other.minimum.x <= maximum.x + distance &&
         minimum.y <= other.maximum.y + distance && other.minimum.y <= maximum.y + distance;
}

namespace index = boost::geometry::index;
using Corner = boost::geometry::model::point<double, 2, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Corner>;

namespace {

/// Children of a node. More make the tree flatter and its nodes slower to search.
constexpr std::size_t kChildren = 16;

/// m. How far a box that is asked for is widened before the exact comparison: a sum and a difference of coordinates of
/// some 1e7 m round differently by less.
constexpr double kRounding = 1e-6;

Box grown(const PlanBox& box, double by) {
  return {Corner(box.minimum.x - by, box.minimum.y - by), Corner(box.maximum.x + by, box.maximum.y + by)};
}

/// Sorts numbers that are all different. Many that lie close together, as those of a neighbourhood do, become bits of words.
void sort_numbers(std::vector<std::uint32_t>& numbers) {
  constexpr std::size_t kFew = 32, kBits = 64;
  if (numbers.size() >= kFew) {
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    const std::uint32_t first = *least;
    const std::size_t words = (*most - first) / kBits + 1;
    if (words <= 4 * numbers.size()) {
      std::vector<std::uint64_t> bits(words, 0);
      for (const std::uint32_t n : numbers) bits[(n - first) / kBits] |= std::uint64_t{1} << ((n - first) % kBits);
      std::size_t at = 0;
      for (std::size_t w = 0; w < words; ++w)
        for (std::uint64_t left = bits[w]; left != 0; left &= left - 1)
          numbers[at++] =
              first + static_cast<std::uint32_t>(w * kBits) + static_cast<std::uint32_t>(std::countr_zero(left));
      return;
    }
  }
  std::sort(numbers.begin(), numbers.end());
}

}  // namespace

struct BoxIndex::Tree {
  using Entry = std::pair<Box, std::uint32_t>;
  explicit Tree(const std::vector<Entry>& entries) : boxes(entries.begin(), entries.end()) {}
  index::rtree<Entry, index::rstar<kChildren>> boxes;
};

BoxIndex::BoxIndex() = default;

BoxIndex::BoxIndex(std::vector<PlanBox> boxes) : boxes_(std::move(boxes)) {
  std::vector<Tree::Entry> entries;
  entries.reserve(boxes_.size());
  for (std::uint32_t i = 0; i < boxes_.size(); ++i)
    if (!boxes_[i].empty()) entries.emplace_back(grown(boxes_[i], 0), i);
  if (!entries.empty()) tree_ = std::make_shared<const Tree>(entries);
}

std::vector<std::uint32_t> BoxIndex::near(const PlanBox& box, double distance) const {
  std::vector<std::uint32_t> out;
  if (!tree_ || box.empty()) return out;
  const auto take = [&](const Tree::Entry& entry) {
    if (boxes_[entry.second].near(box, distance)) out.push_back(entry.second);
  };
  tree_->boxes.query(index::intersects(grown(box, distance + kRounding)), boost::make_function_output_iterator(take));
  sort_numbers(out);
  return out;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> BoxIndex::pairs(double distance) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  for (std::uint32_t a = 0; a < boxes_.size(); ++a)
    for (const std::uint32_t b : near(boxes_[a], distance))
      if (a < b) out.emplace_back(a, b);
  return out;
}

}  // namespace blockrand::geometry
