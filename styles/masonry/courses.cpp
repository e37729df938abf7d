// Courses: bricks by their bond, ashlar by free lengths.
#include <algorithm>
#include <cmath>

#include "styles/masonry/bond_joints.h"
#include "styles/masonry/course_cover.h"
#include "styles/masonry/field.h"

namespace blockrand::masonry {
namespace {

/// Share of a course that must be free for a stone.
constexpr double kLeastFree = 0.45;
/// m. An end that near to the run's own is that.
constexpr double kAtEnd = 0.002;
/// Of ashlar: stones are up to that much longer or shorter than the mean.
constexpr double kSpread = 0.3;
/// Draws of joints of a course of ashlar, of which the one farthest from the joints below is taken.
constexpr std::uint64_t kDraws = 8;

class Courses {
 public:
  Courses(const WallToLay& wall, const Masonry& masonry, std::span<const Outline> blocked, LaidWall& out)
      : wall_(wall), m_(masonry), blocked_(blocked), out_(out) {
    quarters_ = quarters_of(m_.bond, wall.to - wall.from, (m_.length + m_.perpend) / 4);
    quarter_ = (wall.to - wall.from) / quarters_;
    if (is_brick(m_.bond))
      for (const bool odd : {false, true})
        for (const int q : bond_joints(m_.bond, quarters_, odd)) bond_[odd].push_back(wall.from + q * quarter_);
  }

  void lay() {
    const Box box = box_of(wall_.outline);
    const int first = std::max(0, static_cast<int>(std::floor((box.low - wall_.ground) / m_.course() - 1e-6)));
    for (int k = first; wall_.ground + k * m_.course() < box.high; ++k) {
      const double low = wall_.ground + k * m_.course() + m_.bed / 2, high = low + m_.height;
      std::vector<double> laid;
      for (const FreeRun& run : free_runs(wall_.outline, blocked_, wall_.from, wall_.to, low, high, kLeastFree)) {
        const std::vector<double> joints = is_brick(m_.bond) ? brick_joints(run, k) : ashlar_joints(run, k);
        lay_run(run, joints, k, low, high);
        laid.insert(laid.end(), joints.begin(), joints.end());
      }
      below_ = std::move(laid);
    }
  }

 private:
  bool at_left(const FreeRun& run) const { return run.left < wall_.from + kAtEnd; }
  bool at_right(const FreeRun& run) const { return run.right > wall_.to - kAtEnd; }

  std::vector<double> brick_joints(const FreeRun& run, int course) const {
    std::vector<double> at;
    for (const double x : bond_[course % 2])
      if (x > run.left + kAtEnd && x < run.right - kAtEnd) at.push_back(x);
    const double closer = quarter_ * 0.999, whole = quarter_ * 4.001;
    // Narrow pieces at jambs join their neighbour; what is longer than a brick then is halved.
    if (!at_left(run) && !at.empty() && at.front() - run.left < closer) {
      at.erase(at.begin());
      const double next = at.empty() ? run.right : at.front();
      if (next - run.left > whole) at.insert(at.begin(), (next + run.left) / 2);
    }
    if (!at_right(run) && !at.empty() && run.right - at.back() < closer) {
      at.pop_back();
      const double before = at.empty() ? run.left : at.back();
      if (run.right - before > whole) at.push_back((run.right + before) / 2);
    }
    return at;
  }

  std::vector<double> ashlar_joints(const FreeRun& run, int course) const {
    const double length = run.right - run.left, step = m_.length + m_.perpend, thick = m_.width + m_.perpend;
    if (length < 1.3 * step)
      return length > 2.2 * thick && length > step ? std::vector<double>{run.left + halves(course) * length}
                                                   : std::vector<double>{};
    // Quoins and jambs: long and short in turn, at left ends against right ones.
    const auto end = [&](bool corner, bool long_one) {
      return long_one ? step * (corner ? 1.0 : 0.85) : corner ? thick : std::max(thick, step * 0.5);
    };
    const double left = run.left + end(at_left(run), course % 2 == 1),
                 right = run.right - end(at_right(run), course % 2 == 0);
    if (right - left < 0.6 * thick) return {(left + right) / 2};
    const int count = std::max(1, static_cast<int>(std::lround((right - left) / step)));
    std::vector<double> best;
    double best_apart = -1;
    for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
      std::vector<double> at{left}, weights;
      double sum = 0;
      const auto place = static_cast<std::uint64_t>(std::llround((run.left + 1000) * 64));
      for (int i = 0; i < count; ++i)
        sum += weights.emplace_back(1 + kSpread *
                                            (2 * unit_of(wall_.seed + static_cast<std::uint64_t>(course) * 7919 + draw,
                                                         place, static_cast<std::uint64_t>(i)) -
                                             1));
      double done = 0;
      for (int i = 0; i < count; ++i)
        at.push_back(left + (right - left) * (done += weights[static_cast<std::size_t>(i)]) / sum);
      double apart = 1e300;
      for (const double a : at)
        for (const double b : below_) apart = std::min(apart, std::fabs(a - b));
      if (apart > best_apart) best_apart = apart, best = std::move(at);
    }
    return best;
  }
  static double halves(int course) { return course % 2 == 0 ? 0.42 : 0.58; }

  StoneRole role_of(double width, bool corner) const {
    if (corner) return StoneRole::quoin;
    if (!is_brick(m_.bond)) return StoneRole::field;
    const double quarters = width / quarter_;
    return quarters < 1.5 ? StoneRole::closer : quarters < 2.5 ? StoneRole::header : StoneRole::stretcher;
  }

  void lay_run(const FreeRun& run, std::span<const double> joints, int course, double low, double high) {
    for (std::size_t i = 0; i <= joints.size(); ++i) {
      const bool first = i == 0, last = i == joints.size();
      const double nominal_from = first ? run.left : joints[i - 1], nominal_to = last ? run.right : joints[i];
      const double from = first ? run.reach_left : nominal_from + m_.perpend / 2,
                   to = last ? run.reach_right : nominal_to - m_.perpend / 2;
      Stone stone;
      stone.course = course;
      stone.at_left = first && at_left(run) && wall_.corner_left;
      stone.at_right = last && at_right(run) && wall_.corner_right;
      stone.role = role_of(nominal_to - nominal_from, stone.at_left || stone.at_right);
      if (nominal_to - nominal_from < least_width()) ++out_.forced;
      stone.outline = rectangle_outline(from, low, to, high);
      if (run.cut)
        add_cut(stone);
      else
        out_.stones.push_back(std::move(stone));
    }
  }

  double least_width() const { return is_brick(m_.bond) ? quarter_ * 0.99 : std::min(m_.width, m_.length / 4) * 0.8; }

  void add_cut(const Stone& whole) {
    std::vector<Outline> pieces = cut_away(whole.outline, blocked_, 0);
    for (const Outline& piece : pieces)
      for (const Outline& cut : cut_to(piece, wall_.outline, 0)) {
        Outline inside = without_short_edges(cut);
        if (area_of(inside) < least_piece(m_)) {
          if (area_of(inside) > least_piece(m_) / 8) ++out_.dropped;
          continue;
        }
        Stone stone = whole;
        stone.outline = std::move(inside);
        out_.stones.push_back(std::move(stone));
      }
  }

  const WallToLay& wall_;
  const Masonry& m_;
  std::span<const Outline> blocked_;
  LaidWall& out_;
  int quarters_ = 0;
  double quarter_ = 0;
  std::vector<double> bond_[2];
  std::vector<double> below_;
};

}  // namespace

double least_piece(const Masonry& m) {
  if (is_brick(m.bond)) return m.length / 4 * m.height * 0.5;
  return (m.bond == Bond::ashlar ? 0.08 : 0.1) * m.length * m.height;
}

void lay_courses(const WallToLay& wall, const Masonry& masonry, std::span<const Outline> blocked, LaidWall& out) {
  Courses(wall, masonry, blocked, out).lay();
}

}  // namespace blockrand::masonry
