#include "pipeline/surroundings/line_strips.h"

#include <algorithm>

namespace blockrand::surroundings {

using model::FlatPolygon;
using model::Point2;
using model::Point3;

namespace {
/// m: how uneven the ground below a piece may be; else it is cut into pieces of a metre.
constexpr double kUneven = 0.2;
}  // namespace

void add_strip(const OffsetLine& line, double left, double right,
               const std::function<std::pair<double, double>(std::size_t)>& heights,
               const std::function<bool(std::size_t)>& takes, bool underside, std::vector<FlatPolygon>& out) {
  std::size_t segment = 0;
  const auto point = [&](std::size_t i, double side, bool top) {
    const Point2 p = line.beside(i, side, segment);
    const auto [low, high] = heights(i);
    return Point3{p.x, p.y, model::snap(top ? high : low)};
  };
  const auto quad = [&](Point3 a, Point3 b, Point3 c, Point3 d) {
    if (a == b || c == d) return;
    out.push_back({{a, b, c}, {}});
    out.push_back({{a, c, d}, {}});
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (!takes(i)) continue;
    segment = i;
    const Point3 l0 = point(i, left, true), r0 = point(i, right, true), l1 = point(i + 1, left, true),
                 r1 = point(i + 1, right, true);
    const Point3 l0_low = point(i, left, false), r0_low = point(i, right, false), l1_low = point(i + 1, left, false),
                 r1_low = point(i + 1, right, false);
    quad(r0, r1, l1, l0);
    if (l0_low != l0) {
      quad(r0_low, r1_low, r1, r0);
      quad(l1_low, l0_low, l0, l1);
      if (i == 0 || !takes(i - 1)) quad(l0_low, r0_low, r0, l0);
      if (i + 2 == line.size() || !takes(i + 1)) quad(r1_low, l1_low, l1, r1);
      if (underside) quad(l0_low, l1_low, r1_low, r0_low);
    }
  }
}

std::vector<Point2> following(const std::vector<Point2>& line, const GroundAtPlace& ground,
                              const geometry::PlanBox& around) {
  std::vector<Point2> out;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    out.push_back(line[i]);
    const Point2 a = line[i], b = line[i + 1];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const auto at = [&](double s) { return Point2{a.x + s / length * (b.x - a.x), a.y + s / length * (b.y - a.y)}; };
    // The stretch of the segment whose places may be taken.
    geometry::PlanBox own;
    own.include(a), own.include(b);
    if (!own.near(around, 0) || !(length > 0)) continue;
    double from = 0, to = length;
    const auto cut = [&](double p, double d, double low, double high) {
      if (d == 0) return;
      const double s = (low - p) / d * length, t = (high - p) / d * length;
      from = std::max(from, std::min(s, t)), to = std::min(to, std::max(s, t));
    };
    cut(a.x, b.x - a.x, around.minimum.x, around.maximum.x);
    cut(a.y, b.y - a.y, around.minimum.y, around.maximum.y);
    if (from > to) continue;
    // Pieces are counted from the start of the segment: every tile finds the same ones.
    const double parts = std::ceil(length / kLongest), step = length / parts;
    const double first = std::max(0.0, std::floor(from / step)), last = std::min(parts, std::ceil(to / step));
    for (double part = first; part < last; ++part) {
      const double begin = part * step, end = std::min(length, begin + step);
      if (part > 0) out.push_back(model::snap(at(begin)));
      const GroundAt here = ground(at(begin));
      bool even = true;
      for (double s = begin; s <= end && even; s += 1) {
        const GroundAt there = ground(at(s));
        even = there.building == here.building && std::fabs(there.height - here.height) < kUneven;
      }
      if (even) continue;
      const double pieces = std::ceil(end - begin);
      for (double k = 1; k < pieces; ++k) out.push_back(model::snap(at(begin + (end - begin) * k / pieces)));
    }
    if (last < parts) out.push_back(model::snap(at(last * step)));
  }
  if (!line.empty()) out.push_back(line.back());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace blockrand::surroundings
