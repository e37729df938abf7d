// The size solver of split(): which pieces a pattern makes of a length (docs/rule_language.md §2.3).
#include <algorithm>
#include <cmath>

#include "styles/grammar/shapes/split.h"

namespace blockrand::grammar {

namespace {

/// Sums of sizes of a list of items, with every nested repeat counted `n` times.
struct Room {
  double fixed = 0, floating = 0;
};

class Solver {
 public:
  Solver(std::span<const SplitItem> items, double length) : items_(items), length_(length) {}

  std::vector<SplitPiece> solve(bool repeat) {
    if (repeat) {
      // The whole block as one nested block that has all the room.
      const Room room = once(0, items_.size());
      const Choice choice = choose({0, 0}, room, length_);
      if (choice.count == 0)
        fill(0, items_.size(), 1, length_);
      else
        for (std::int64_t i = 0; i < choice.count && !full(); ++i) place_list(0, items_.size(), choice.stretch);
    } else {
      place_line(0, items_.size(), length_);
    }
    return std::move(pieces_);
  }

 private:
  /// How often a repeated block is set, and what its floating sizes are multiplied with. Count 0: it has no floating
  /// sizes (or none that fit), and is set until the room is full.
  struct Choice {
    std::int64_t count = 0;
    double stretch = 1;
  };

  double size_of(const SplitItem& item) const {
    double size = item.mark == Mark::relative ? item.size * length_ : item.size;
    if (!(size > 0) || !std::isfinite(size)) size = 0;
    return size;
  }
  std::size_t end_of(std::size_t i) const {
    return std::min(items_.size(), i + 1 + static_cast<std::size_t>(std::max(0, items_[i].inside)));
  }
  static bool head(const SplitItem& item) { return item.inside > 0; }
  bool full() const { return at_ >= length_ - kSplitTolerance * length_ || pieces_.size() >= kMostPieces; }

  /// One setting of a list: nested blocks once, whether repeated or not.
  Room once(std::size_t from, std::size_t to) const {
    Room room;
    for (std::size_t i = from; i < to; ++i) {
      if (head(items_[i])) continue;  // its contents follow and are counted
      (items_[i].mark == Mark::floating ? room.floating : room.fixed) += size_of(items_[i]);
    }
    return room;
  }

  /// n of the smallest |k - 1| with k = (room - outer fixed - n A) / (outer floating + n F), k > 0 (rules 4 and 5).
  Choice choose(Room outer, Room block, double room) const {
    if (!(block.floating > 0)) return {};
    const double free = room - outer.fixed;
    Choice best;
    const double unit = block.fixed + block.floating;
    if (!(unit > 0) || !(free > 0)) return {};
    // |k - 1| falls until k passes 1 and rises after it: only the neighbours of that n count.
    const double even = (free - outer.floating) / unit;
    double nearest = 0;
    const auto low = static_cast<std::int64_t>(std::floor(std::min(even, 1e6)));
    for (std::int64_t n = std::max<std::int64_t>(1, low - 1); n <= std::max<std::int64_t>(1, low + 2); ++n) {
      const double count = static_cast<double>(n);
      const double k = (free - count * block.fixed) / (outer.floating + count * block.floating);
      if (!(k > kSplitTolerance)) continue;
      const double distance = std::fabs(k - 1);
      // Equal but for rounding: the fewer pieces.
      if (best.count == 0 || distance < nearest - 1e-9) {
        best = {n, k};
        nearest = distance;
      }
    }
    return best;
  }

  void place(const SplitItem& item, double size) {
    if (full() || !(size > kSplitTolerance * length_)) return;
    double end = at_ + size;
    // The end of the last piece is the end of the room, without the rounding errors of the sums.
    if (end > length_ - kSplitTolerance * length_) end = length_;
    pieces_.push_back({item.rule, at_, end});
    at_ = end;
  }

  /// A list of items, floating sizes times `stretch`; nested blocks are set once, also repeated ones: the list itself
  /// is what repeats.
  void place_list(std::size_t from, std::size_t to, double stretch) {
    for (std::size_t i = from; i < to && !full(); ++i)
      if (!head(items_[i])) place(items_[i], size_of(items_[i]) * (items_[i].mark == Mark::floating ? stretch : 1));
  }

  /// Repeats items until the room is full; the last piece is cut (rule 3).
  void fill(std::size_t from, std::size_t to, double stretch, double until) {
    const double whole = length_;
    while (at_ < until - kSplitTolerance * whole && pieces_.size() < kMostPieces) {
      const double before = at_;
      for (std::size_t i = from; i < to && at_ < until - kSplitTolerance * whole; ++i) {
        if (head(items_[i])) continue;
        const double size = size_of(items_[i]) * (items_[i].mark == Mark::floating ? stretch : 1);
        if (!(size > kSplitTolerance * whole)) continue;
        double end = at_ + size;
        if (end > until - kSplitTolerance * whole) end = until;
        pieces_.push_back({items_[i].rule, at_, end});
        at_ = end;
        if (pieces_.size() >= kMostPieces) return;
      }
      if (!(at_ > before)) return;
    }
  }

  /// One line that is not repeated, with what repeated blocks it has (rules 2 and 5).
  void place_line(std::size_t from, std::size_t to, double room) {
    Room outer;
    struct Block {
      std::size_t from, to;
      Room room;
    };
    std::vector<Block> blocks;
    collect(from, to, outer, blocks);
    if (blocks.empty()) {
      const double free = room - outer.fixed;
      const double stretch = outer.floating > 0 && free > kSplitTolerance * room ? free / outer.floating : 0;
      place_list(from, to, stretch);
      return;
    }
    const double free = std::max(0.0, room - outer.fixed);
    // Several repeated blocks share by what one setting of each takes; what is left of others is fixed for one.
    double nominal = outer.floating;
    for (const Block& b : blocks) nominal += b.room.fixed + b.room.floating;
    double outer_stretch = 1;
    if (blocks.size() == 1 && blocks[0].room.floating > 0) {
      const Choice choice = choose(outer, blocks[0].room, room);
      if (choice.count > 0) {
        walk(from, to, choice.stretch, [&](std::size_t a, std::size_t b, double) {
          for (std::int64_t n = 0; n < choice.count && !full(); ++n) place_list(a, b, choice.stretch);
        });
        return;
      }
    }
    outer_stretch = nominal > 0 ? free / nominal : 0;
    if (blocks.size() == 1 && !(blocks[0].room.floating > 0) && outer.floating > 0) {
      // Fixed sizes repeated beside floating ones: as often as the nearest stretch of the floating ones asks.
      const double unit = blocks[0].room.fixed;
      std::int64_t best = 0;
      double nearest = 0, stretch = 0;
      if (unit > kSplitTolerance * room) {
        const auto middle = static_cast<std::int64_t>(std::floor((free - outer.floating) / unit));
        for (std::int64_t n = std::max<std::int64_t>(1, middle - 1); n <= std::max<std::int64_t>(1, middle + 2); ++n) {
          const double k = (free - static_cast<double>(n) * unit) / outer.floating;
          if (!(k > kSplitTolerance)) continue;
          if (best == 0 || std::fabs(k - 1) < nearest - 1e-9) {
            best = n;
            nearest = std::fabs(k - 1);
            stretch = k;
          }
        }
      }
      if (best > 0) {
        walk(from, to, stretch, [&](std::size_t a, std::size_t b, double) {
          for (std::int64_t n = 0; n < best && !full(); ++n) place_list(a, b, 1);
        });
        return;
      }
    }
    walk(from, to, outer_stretch, [&](std::size_t a, std::size_t b, double share) {
      const Room block = once(a, b);
      const double own = share * outer_stretch;
      const Choice choice = choose({0, 0}, block, own);
      const double until = std::min(length_, at_ + own);
      if (choice.count == 0)
        fill(a, b, 1, until);
      else
        for (std::int64_t n = 0; n < choice.count && !full(); ++n) place_list(a, b, choice.stretch);
    });
  }

  template <typename Place>
  void walk(std::size_t from, std::size_t to, double stretch, Place place_block) {
    for (std::size_t i = from; i < to && !full();) {
      const SplitItem& item = items_[i];
      if (!head(item)) {
        place(item, item.mark == Mark::floating ? size_of(item) * stretch : size_of(item));
        ++i;
        continue;
      }
      const std::size_t end = end_of(i);
      if (item.repeat) {
        const Room room = once(i + 1, end);
        place_block(i + 1, end, room.fixed + room.floating);
      } else {
        walk(i + 1, end, stretch, place_block);
      }
      i = end;
    }
  }

  template <typename Block>
  void collect(std::size_t from, std::size_t to, Room& outer, std::vector<Block>& blocks) const {
    for (std::size_t i = from; i < to;) {
      const SplitItem& item = items_[i];
      if (!head(item)) {
        (item.mark == Mark::floating ? outer.floating : outer.fixed) += size_of(item);
        ++i;
        continue;
      }
      const std::size_t end = end_of(i);
      if (item.repeat)
        blocks.push_back({i + 1, end, once(i + 1, end)});
      else
        collect(i + 1, end, outer, blocks);
      i = end;
    }
  }

  std::span<const SplitItem> items_;
  double length_ = 0;
  double at_ = 0;
  std::vector<SplitPiece> pieces_;
};

}  // namespace

std::vector<SplitPiece> split_sizes(std::span<const SplitItem> items, bool repeat, double length) {
  if (!(length > 0) || !std::isfinite(length) || items.empty()) return {};
  return Solver(items, length).solve(repeat);
}

}  // namespace blockrand::grammar
