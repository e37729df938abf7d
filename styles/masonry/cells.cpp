// Rubble and cyclopean masonry: Voronoi cells (Finkenzeller 2008, 5.3.4). Cells of a hexagonal grid are shaken, evened out by Lloyd's
// method, cut at dressings and quoins; at corners of openings two centres lie as mirror images, so that a joint runs from the corner
// and no stone is concave there. Cells that come out too small are given up to their neighbours.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "styles/masonry/field.h"

namespace blockrand::masonry {
namespace {

/// How far centres are moved from the grid, of the distance of centres.
constexpr double kShake = 0.38;
constexpr int kRelaxations = 2;      ///< more make honeycombs
constexpr int kRepairs = 4;          ///< rounds in which small cells are given up
constexpr double kLeastWidth = 0.3;  ///< of the mean height of a stone
constexpr double kTurn = 0.5;        ///< sine of the turn of corners that count as corners

struct Site {
  Point2 at;
  bool fixed = false;
  std::uint64_t number = 0;
};

class Cells {
 public:
  Cells(const WallToLay& wall, const Masonry& masonry, std::vector<Outline> blocked, LaidWall& out)
      : wall_(wall), m_(masonry), blocked_(std::move(blocked)), out_(out), box_(box_of(wall.outline)) {
    aspect_ = m_.length / m_.height;
    spacing_ = m_.height;
    box_.left = std::max(box_.left, wall.from), box_.right = std::min(box_.right, wall.to);
    box_.low = std::max(box_.low, wall.ground);
    frame_ = rectangle_outline(box_.left / aspect_, box_.low, box_.right / aspect_, box_.high);
  }

  void lay() {
    if (wall_.corner_left) quoins(true);
    if (wall_.corner_right) quoins(false);
    scatter();
    for (int i = 0; i < kRelaxations; ++i) relax();
    join_blocked();
    clear_blocked();
    std::vector<std::pair<std::size_t, Outline>> made;
    for (int round = 0;; ++round) {
      made = cut_cells();
      if (round == kRepairs || !give_up_small(made)) break;
    }
    for (auto& [site, outline] : made) {
      if (is_small(outline)) {
        ++out_.dropped;
        continue;
      }
      Stone stone;
      stone.outline = std::move(outline);
      out_.stones.push_back(std::move(stone));
    }
  }

 private:
  // Sites live in a plane that is squeezed along u, so that flat stones are round there.
  Outline real(const Outline& squeezed) const {
    Outline out = squeezed;
    for (Point2& p : out) p.x *= aspect_;
    return out;
  }
  Point2 real(Point2 p) const { return {p.x * aspect_, p.y}; }

  /// Squared stones at a corner, long and short in turn; against those of the next wall.
  void quoins(bool left) {
    const double step = std::max(0.3, std::min(0.45, m_.height * 0.8)), long_one = step * 1.6, short_one = step * 0.85;
    for (int k = 0; wall_.ground + k * step < box_.high; ++k) {
      const bool is_long = (k % 2 == 0) != left;
      const double wide = is_long ? long_one : short_one, low = wall_.ground + k * step;
      const double from = left ? wall_.from : wall_.to - wide, to = left ? wall_.from + wide : wall_.to;
      const Outline whole = rectangle_outline(from, low, to, low + step);
      if (!std::ranges::all_of(whole, [&](const Point2& p) { return geometry::contains(wall_.outline, p); })) continue;
      if (std::ranges::any_of(blocked_, [&](const Outline& o) { return box_of(o).meets(box_of(whole)); })) continue;
      Stone stone;
      stone.role = StoneRole::quoin;
      stone.at_left = left, stone.at_right = !left;
      stone.course = k;
      const double joint = m_.perpend;
      stone.outline = rectangle_outline(from + (left ? 0 : joint), low + joint / 2, to - (left ? joint : 0),
                                        low + step - joint / 2);
      out_.stones.push_back(std::move(stone));
      quoin_blocks_.push_back(whole);
    }
  }

  void scatter() {
    const double wide = spacing_, high = spacing_ * 0.866;
    const int rows = static_cast<int>((box_.high - box_.low) / high) + 2,
              columns = static_cast<int>((box_.right - box_.left) / aspect_ / wide) + 2;
    std::uint64_t number = 0;
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        ++number;
        const double shake_x = (2 * unit_of(wall_.seed, number, 1) - 1) * kShake * wide,
                     shake_y = (2 * unit_of(wall_.seed, number, 2) - 1) * kShake * high;
        const Point2 p{box_.left / aspect_ + (c + (r % 2) * 0.5) * wide + shake_x,
                       box_.low + (r + 0.5) * high + shake_y};
        if (p.x < box_.left / aspect_ || p.x > box_.right / aspect_ || p.y > box_.high || p.y < box_.low) continue;
        sites_.push_back({p, false, number});
      }
  }

  using Grid = std::map<std::pair<int, int>, std::vector<std::size_t>>;
  std::pair<int, int> square_of(Point2 p) const {
    return {static_cast<int>(std::floor(p.x / spacing_)), static_cast<int>(std::floor(p.y / spacing_))};
  }
  Grid grid() const {
    Grid out;
    for (std::size_t i = 0; i < sites_.size(); ++i) out[square_of(sites_[i].at)].push_back(i);
    return out;
  }

  Outline cell(const Grid& grid, std::size_t i) const {
    const Point2 at = sites_[i].at;
    // Where sites were taken away a cell reaches farther than its neighbours' rings: three squares are enough for holes of openings,
    // since what lies in them is cut off.
    constexpr int kSquares = 3;
    std::vector<std::pair<double, std::size_t>> near;
    const auto [cx, cy] = square_of(at);
    for (int x = cx - kSquares; x <= cx + kSquares; ++x)
      for (int y = cy - kSquares; y <= cy + kSquares; ++y)
        if (const auto found = grid.find({x, y}); found != grid.end())
          for (const std::size_t j : found->second)
            if (j != i) near.emplace_back(std::hypot(sites_[j].at.x - at.x, sites_[j].at.y - at.y), j);
    std::ranges::sort(near);
    const double reach = kSquares * spacing_;
    Outline out = rectangle_outline(std::max(at.x - reach / 2, frame_[0].x), std::max(at.y - reach / 2, frame_[0].y),
                                    std::min(at.x + reach / 2, frame_[2].x), std::min(at.y + reach / 2, frame_[2].y));
    for (const auto& [apart, j] : near) {
      if (apart < 1e-9) continue;
      const Point2 other = sites_[j].at;
      out = cut_half_plane(out, {(at.x + other.x) / 2, (at.y + other.y) / 2}, {other.x - at.x, other.y - at.y});
      if (out.empty()) break;
    }
    return out;
  }

  void relax() {
    const Grid squares = grid();
    std::vector<Point2> middles;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const Outline outline = cell(squares, i);
      middles.push_back(outline.empty() ? sites_[i].at : geometry::centroid(outline));
    }
    for (std::size_t i = 0; i < sites_.size(); ++i)
      if (!sites_[i].fixed) sites_[i].at = middles[i];
  }

  /// Openings, dressings and quoins as few polygons as they are.
  void join_blocked() {
    std::vector<model::Polygon> all;
    for (const std::vector<Outline>* list : {&blocked_, &quoin_blocks_})
      for (const Outline& o : *list) {
        model::Polygon p;
        for (const Point2& q : o) p.outer.points.push_back(model::snap(q));
        p.outer.nodes.assign(o.size(), 0);
        all.push_back(std::move(p));
      }
    joined_.clear();
    for (const model::Polygon& p : geometry::unite(all, 0, 0.002).polygons) joined_.push_back(p.outer.points);
  }

  void clear_blocked() {
    std::erase_if(sites_, [&](const Site& s) {
      const Point2 p = real(s.at);
      return !geometry::contains(wall_.outline, p) ||
             std::ranges::any_of(joined_, [&](const Outline& o) { return geometry::contains(o, p); });
    });
    std::uint64_t number = 1u << 20;
    for (const Outline& o : joined_)
      for (std::size_t i = 0; i < o.size(); ++i) {
        const Point2 a = o[(i + o.size() - 1) % o.size()], b = o[i], c = o[(i + 1) % o.size()];
        const Point2 u{(b.x - a.x) / aspect_, b.y - a.y}, v{(c.x - b.x) / aspect_, c.y - b.y};
        const double lu = std::hypot(u.x, u.y), lv = std::hypot(v.x, v.y);
        if (lu < 0.3 * spacing_ || lv < 0.3 * spacing_ || (u.x * v.y - u.y * v.x) / (lu * lv) < kTurn) continue;
        pair_at({b.x / aspect_, b.y}, {u.x / lu, u.y / lu}, {v.x / lv, v.y / lv}, number += 2);
      }
  }

  /// Two centres as mirror images about the bisector of a corner: their joint begins in the corner.
  void pair_at(Point2 corner, Point2 before, Point2 after, std::uint64_t number) {
    const Point2 sum{before.x - after.x, before.y - after.y};
    const double length = std::hypot(sum.x, sum.y);
    if (length < 1e-6) return;
    const Point2 out{sum.x / length, sum.y / length}, aside{-out.y, out.x};
    const double apart = 0.5 * spacing_, forth = 0.12 * spacing_;
    const Point2 first{corner.x + aside.x * apart + out.x * forth, corner.y + aside.y * apart + out.y * forth},
        second{corner.x - aside.x * apart + out.x * forth, corner.y - aside.y * apart + out.y * forth};
    for (const Point2& p : {first, second}) {
      const Point2 r = real(p);
      if (!geometry::contains(wall_.outline, r) || r.y < wall_.ground + 0.02) return;
      if (std::ranges::any_of(joined_, [&](const Outline& o) { return geometry::contains(o, r); })) return;
      if (std::ranges::any_of(sites_, [&](const Site& s) {
            return s.fixed && std::hypot(s.at.x - p.x, s.at.y - p.y) < 0.6 * spacing_;
          }))
        return;
    }
    std::erase_if(sites_, [&](const Site& s) {
      return !s.fixed &&
             std::min({std::hypot(s.at.x - corner.x, s.at.y - corner.y), std::hypot(s.at.x - first.x, s.at.y - first.y),
                       std::hypot(s.at.x - second.x, s.at.y - second.y)}) < 0.6 * spacing_;
    });
    sites_.push_back({first, true, number});
    sites_.push_back({second, true, number + 1});
  }

  std::vector<std::pair<std::size_t, Outline>> cut_cells() const {
    const Grid squares = grid();
    std::vector<std::pair<std::size_t, Outline>> out;
    std::vector<Box> boxes;
    for (const Outline& o : joined_) boxes.push_back(box_of(o));
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const double joint = m_.perpend * (0.6 + 0.8 * unit_of(wall_.seed, sites_[i].number, 3)) / 2;
      Outline outline = without_short_edges(inset_convex(real(cell(squares, i)), joint));
      if (outline.size() < 3) continue;
      const Box box = box_of(outline);
      std::vector<Outline> pieces{std::move(outline)};
      if (std::ranges::any_of(boxes, [&](const Box& b) { return b.meets(box); }))
        pieces = cut_away(pieces[0], joined_, least_piece(m_) / 4);
      for (Outline& piece : pieces) {
        if (std::ranges::all_of(piece, [&](const Point2& p) { return geometry::contains(wall_.outline, p); }) &&
            is_convex(wall_.outline, 1e-3)) {
          out.emplace_back(i, std::move(piece));
          continue;
        }
        for (Outline& inside : cut_to(piece, wall_.outline, least_piece(m_) / 4))
          out.emplace_back(i, std::move(inside));
      }
    }
    return out;
  }

  bool is_small(const Outline& o) const {
    return area_of(o) < least_piece(m_) || narrowest(o) < kLeastWidth * m_.height;
  }

  /// Of cells whose largest piece is small the centres go, farthest pieces' first; fixed ones as well.
  bool give_up_small(const std::vector<std::pair<std::size_t, Outline>>& made) {
    std::vector<bool> good(sites_.size(), false);
    for (const auto& [site, outline] : made)
      if (!is_small(outline)) good[site] = true;
    std::vector<Site> kept;
    bool gone_before = false, any = false;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      // Never two in a row: neighbours of a gap need not go.
      const bool goes = !good[i] && !gone_before;
      gone_before = goes;
      if (goes)
        any = true;
      else
        kept.push_back(sites_[i]);
    }
    sites_ = std::move(kept);
    return any;
  }

  const WallToLay& wall_;
  const Masonry& m_;
  std::vector<Outline> blocked_, quoin_blocks_, joined_;
  LaidWall& out_;
  Box box_;
  double aspect_ = 1, spacing_ = 1;
  Outline frame_;
  std::vector<Site> sites_;
};

}  // namespace

void lay_cells(const WallToLay& wall, const Masonry& masonry, std::vector<Outline> blocked, LaidWall& out) {
  Cells(wall, masonry, std::move(blocked), out).lay();
}

}  // namespace blockrand::masonry
