// An index of line segments by the cells of a square grid: which segments come near a box.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

struct Segment {
  model::Point2 a, b;  ///< m
  friend bool operator==(const Segment&, const Segment&) = default;
  friend auto operator<=>(const Segment&, const Segment&) = default;
};

/// Read-only after construction, safe to share between threads. A segment is filed under the cells it passes through,
/// not under those of its bounding box. Cells are multiples of the cell size from the origin of the CRS, so that what a
/// query finds does not depend on the other segments.
class SegmentGrid {
 public:
  /// \param cell  m, positive; about the size of a usual query
  SegmentGrid(std::span<const Segment> segments, double cell);

  /// Indices, ascending and each once, of all segments that come into the box grown by a millimetre, and of some others
  /// that share a cell with it. `out` is cleared first.
  void near(model::Point2 minimum, model::Point2 maximum, std::vector<std::uint32_t>& out) const;

  /// Calls `visit(i, k)`, i < k, for all pairs of segments that share a cell: all that can meet, and some others. A
  /// pair that shares several cells is visited several times.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (auto first = entries_.begin(); first != entries_.end();) {
      auto last = first;
      for (; last != entries_.end() && last->x == first->x && last->y == first->y; ++last)
        for (auto e = first; e != last; ++e) visit(e->segment, last->segment);
      first = last;
    }
  }

 private:
  struct Entry {
    std::int32_t x = 0, y = 0;
    std::uint32_t segment = 0;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };
  std::int32_t cell_of(double metres) const;

  double cell_;
  std::vector<Entry> entries_;  ///< sorted
};

}  // namespace blockrand::geometry
