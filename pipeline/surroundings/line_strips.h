// Lines with points beside them, and strips along them: what bodies along mapped lines are made of.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "pipeline/surroundings/body_site.h"

namespace blockrand::surroundings {

/// Directions and lengths of a line, for points beside it.
class OffsetLine {
 public:
  explicit OffsetLine(std::vector<model::Point2> points) : points_(std::move(points)) {
    along_.push_back(0);
    for (std::size_t i = 1; i < points_.size(); ++i)
      along_.push_back(along_.back() + std::hypot(points_[i].x - points_[i - 1].x, points_[i].y - points_[i - 1].y));
  }
  std::size_t size() const { return points_.size(); }
  const std::vector<model::Point2>& points() const { return points_; }
  double along(std::size_t i) const { return along_[i]; }
  double length() const { return along_.back(); }

  /// The point `right` metres to the right of point i, on the bisector of the bend there; at a bend that is too sharp for one,
  /// square to a segment, which begins or ends there. Lines that repeat their first point bend there, too.
  model::Point2 beside(std::size_t i, double right, std::size_t segment) const {
    const bool closed = points_.front() == points_.back() && points_.size() > 3;
    const std::size_t last = points_.size() - 1;
    const model::Point2 before = normal(i > 0 ? i - 1 : closed ? last - 1 : 0);
    const model::Point2 after = normal(i < last ? i : closed ? 0 : last - 1);
    double x = before.x + after.x, y = before.y + after.y;
    const double square = x * x + y * y;
    // 2 / |n1 + n2|² along n1 + n2 is the mitre.
    double scale = square > 1 ? 2 / square : 1;
    if (square <= 1) x = normal(segment).x, y = normal(segment).y;
    return model::snap(model::Point2{points_[i].x + right * scale * x, points_[i].y + right * scale * y});
  }

 private:
  /// To the right of the segment that begins at point i.
  model::Point2 normal(std::size_t i) const {
    const double dx = points_[i + 1].x - points_[i].x, dy = points_[i + 1].y - points_[i].y;
    const double length = std::hypot(dx, dy);
    return length > 0 ? model::Point2{dy / length, -dx / length} : model::Point2{0, 0};
  }
  std::vector<model::Point2> points_;
  std::vector<double> along_;
};

/// A strip beside a line between two heights. \param heights  of its points: below and above
/// \param takes  which segments; ends are closed where a run of them begins and ends
void add_strip(const OffsetLine& line, double left, double right,
               const std::function<std::pair<double, double>(std::size_t)>& heights,
               const std::function<bool(std::size_t)>& takes, bool underside, std::vector<model::FlatPolygon>& out);

/// The part of a line around a box, in pieces of at most kLongest, and of a metre where the ground below is uneven or a
/// building stands on it. Its far segments stay as they are: nobody takes them.
std::vector<model::Point2> following(const std::vector<model::Point2>& line, const GroundAtPlace& ground,
                                     const geometry::PlanBox& around);

}  // namespace blockrand::surroundings
