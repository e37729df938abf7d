#include "styles/masonry/dressings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::masonry {
namespace {

/// m that dressings keep from other openings.
constexpr double kFromOthers = 0.02;
/// m. Openings that begin higher above the ground have a sill; doors have none.
constexpr double kLeastSillHeight = 0.25;
/// m. A single stone spans no more: stone bends little. Wider heads get a flat arch.
constexpr double kWidestLintel = 1.8;
/// m above its bearings.
constexpr double kLeastLintel = 0.15;
/// Upward part of the direction in which an arch's first joint points, below which its foot counts as level.
constexpr double kLevelFoot = 0.5;
/// m. Heights nearer than that are one.
constexpr double kSameHeight = 0.003;
/// Sizes that are tried where the usual one has no room.
constexpr double kTries[] = {1, 0.75, 0.5, 0.33};

/// One opening's dressing, before it is known to fit.
struct Try {
  std::vector<Stone> stones;
  std::vector<Outline> blocked;
};

struct Sizes {
  double arch_depth, voussoir, lintel, bearing, sill;
};
Sizes sizes_of(const Masonry& m) {
  if (is_brick(m.bond)) return {m.length, m.height + m.perpend, m.length, 0, m.width};
  if (m.bond == Bond::ashlar) return {m.height, m.height * 0.9, m.height, 0.18, 0.15};
  return {0.3, 0.24, 0.28, 0.18, 0.14};
}

class Dresser {
 public:
  Dresser(const WallToLay& wall, const Masonry& masonry) : wall_(wall), m_(masonry), sizes_(sizes_of(masonry)) {}

  Dressings all() {
    for (const Outline& o : wall_.openings) shapes_.push_back(shape_of(o));
    out_.blocked = wall_.openings;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (shapes_[i].flat_foot && !fit(
                                      i, [&](double scale) { return sill(shapes_[i], scale); }, 2))
        ++out_.undressed;
      const bool dressed = fit(
          i,
          [&](double scale) {
            if (!shapes_[i].flat_foot) return ring(wall_.openings[i], scale);
            if (!shapes_[i].straight) return arch(shapes_[i], scale);
            const bool long_one = shapes_[i].box.right - shapes_[i].box.left > kWidestLintel;
            return is_brick(m_.bond) || long_one ? flat_arch(shapes_[i], scale) : lintel(shapes_[i], scale);
          },
          std::size(kTries));
      if (!dressed) ++out_.undressed;
    }
    return std::move(out_);
  }

 private:
  template <class Make>
  bool fit(std::size_t of, Make&& make, std::size_t tries) {
    for (std::size_t t = 0; t < tries; ++t) {
      std::optional<Try> made = make(kTries[t]);
      if (!made) continue;
      if (!std::ranges::all_of(made->blocked, [&](const Outline& o) { return has_room(o, of); })) continue;
      for (Stone& s : made->stones) out_.stones.push_back(std::move(s));
      for (Outline& o : made->blocked) {
        taken_.emplace_back(of, box_of(o));
        out_.blocked.push_back(std::move(o));
      }
      return true;
    }
    return false;
  }

  bool has_room(const Outline& blocked, std::size_t of) const {
    const Box box = box_of(blocked);
    if (box.left < wall_.from || box.right > wall_.to) return false;
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      if (i != of && shapes_[i].box.meets(box, kFromOthers)) return false;
    for (const auto& [whose, other] : taken_)
      if (whose != of && other.meets(box, kFromOthers)) return false;
    return std::ranges::all_of(blocked, [&](const Point2& p) { return geometry::contains(wall_.outline, p); });
  }

  double line_below(double v) const {
    return wall_.ground + std::floor((v - wall_.ground) / m_.course() + 1e-9) * m_.course();
  }
  /// A course's line above a head, where courses are; about `height` higher.
  double top_of(double head, double height) const {
    if (!has_courses(m_.bond)) return head + height;
    const double line = line_below(head + height * 1.06);
    return line > head + 0.05 ? line : line + m_.course();
  }
  double joint() const { return m_.perpend; }
  double half_bed() const { return has_courses(m_.bond) ? m_.bed / 2 : m_.perpend; }

  std::optional<Try> sill(const OpeningShape& shape, double scale) const {
    if (shape.box.low < wall_.ground + kLeastSillHeight) return Try{};
    const double thick = sizes_.sill * scale;
    const double foot = has_courses(m_.bond) ? line_below(shape.box.low - thick * 0.55) : shape.box.low - thick;
    Try out;
    const double left = shape.box.left, right = shape.box.right;
    const int count = is_brick(m_.bond)
                          ? std::max(1, static_cast<int>(std::lround((right - left) / (m_.height + joint()))))
                          : std::max(1, static_cast<int>(std::ceil((right - left) / kWidestLintel)));
    for (int i = 0; i < count; ++i) {
      const double from = left + (right - left) * i / count, to = left + (right - left) * (i + 1) / count;
      out.stones.push_back({rectangle_outline(from + joint() / (i == 0 ? 1 : 2), foot + half_bed(),
                                              to - joint() / (i + 1 == count ? 1 : 2), shape.box.low),
                            StoneRole::sill});
    }
    out.blocked.push_back(rectangle_outline(left, foot, right, shape.box.low));
    return out;
  }

  /// One stone, its ends on the jambs. Where the head lies in a course, its middle hangs down between them.
  std::optional<Try> lintel(const OpeningShape& shape, double scale) const {
    const double head = shape.box.high, left = shape.box.left, right = shape.box.right;
    const double bearing = sizes_.bearing * scale;
    double top = top_of(head, sizes_.lintel * std::max(scale, 0.6));
    double seat = head;
    if (has_courses(m_.bond)) {
      seat = line_below(head);
      if (head - seat > 0.03) seat += m_.course();
      if (top - seat < kLeastLintel) top += m_.course();
    }
    Try out;
    const double high = top - half_bed(), low = seat + (has_courses(m_.bond) ? half_bed() : 0);
    const double a = left - bearing + joint(), b = right + bearing - joint();
    Outline stone;
    if (std::fabs(low - head) < 0.001)
      stone = rectangle_outline(a, head, b, high);
    else
      stone = {{a, low}, {left, low}, {left, head}, {right, head}, {right, low}, {b, low}, {b, high}, {a, high}};
    out.stones.push_back({std::move(stone), StoneRole::lintel});
    out.blocked.push_back(rectangle_outline(left - bearing, seat, right + bearing, top));
    if (seat > head) out.blocked.push_back(rectangle_outline(left, head - 0.01, right, seat + 0.01));
    return out;
  }

  /// Stones on end whose joints meet in one point below.
  std::optional<Try> flat_arch(const OpeningShape& shape, double scale) const {
    const double head = shape.box.high, left = shape.box.left, right = shape.box.right, width = right - left;
    const double top = top_of(head, sizes_.lintel * scale), high = top - half_bed();
    if (high - head < 0.04) return std::nullopt;
    const double step = is_brick(m_.bond) ? m_.height + joint() : 0.42;
    const int count = static_cast<int>(std::lround(width / step)) | 1;
    const double flare = std::min(0.12, 0.35 * (high - head)), spread = 1 + 2 * flare / width,
                 middle = (left + right) / 2;
    Try out;
    for (int i = 0; i < count; ++i) {
      const double a = left + width * i / count + (i > 0 ? joint() / 2 : 0),
                   b = left + width * (i + 1) / count - (i + 1 < count ? joint() / 2 : 0);
      const auto up = [&](double x, double back) { return middle + (x + back - middle) * spread - back; };
      const double ja = i > 0 ? -joint() / 2 : 0, jb = i + 1 < count ? joint() / 2 : 0;
      out.stones.push_back(
          {{{a, head}, {b, head}, {up(b, jb), high}, {up(a, ja), high}},
           count > 1 && i == count / 2 && !is_brick(m_.bond) ? StoneRole::keystone : StoneRole::lintel});
    }
    out.blocked.push_back({{left, head - 0.001},
                           {right, head - 0.001},
                           {middle + width / 2 * spread + joint(), top},
                           {middle - width / 2 * spread - joint(), top}});
    return out;
  }

  /// m along a curve that makes `width` at a distance outside it.
  static double along_for(const HeadCurve& curve, double s, double out, double width) {
    constexpr double kStep = 0.01;
    const double t = std::min(s, curve.length() - kStep);
    const Point2 a = outside(curve, t, out), b = outside(curve, t + kStep, out);
    const double longer = std::hypot(b.x - a.x, b.y - a.y) / kStep;
    return longer > 0.1 ? width / longer : width;
  }
  static Point2 outside(const HeadCurve& curve, double s, double out) {
    const Point2 p = curve.at(s), n = curve.outward(s);
    return {p.x + n.x * out, p.y + n.y * out};
  }

  /// The stone between two places of a curve.
  Outline wedge(const HeadCurve& curve, double from, double to, bool joint_before, bool joint_after,
                double depth) const {
    Outline out;
    const double half = joint() / 2, a = joint_before ? from + half : from, b = joint_after ? to - half : to;
    out.push_back(curve.at(b));
    Outline inner = curve.between(a, b);
    out.insert(out.end(), inner.rbegin(), inner.rend());
    out.push_back(curve.at(a));
    const double c = joint_before ? from + along_for(curve, from, depth, half) : from,
                 d = joint_after ? to - along_for(curve, to, depth, half) : to;
    out.push_back(outside(curve, c, depth));
    for (int k = 1; k < 3; ++k) out.push_back(outside(curve, c + (d - c) * k / 3, depth));
    out.push_back(outside(curve, d, depth));
    return out;
  }

  std::optional<Try> arch(const OpeningShape& shape, double scale) const {
    const HeadCurve curve(shape.head);
    if (curve.length() < 0.1) return std::nullopt;
    const double depth = sizes_.arch_depth * scale;
    const int count = std::max(3, static_cast<int>(std::lround(curve.length() / sizes_.voussoir)) | 1);
    Try out;
    for (int i = 0; i < count; ++i)
      out.stones.push_back(
          {wedge(curve, curve.length() * i / count, curve.length() * (i + 1) / count, i > 0, i + 1 < count, depth),
           i == count / 2 ? StoneRole::keystone : StoneRole::voussoir});
    stand_on_course(curve, depth, out);
    out.blocked.push_back(under_arch(curve, depth + joint(), count));
    return out;
  }

  bool stands(const HeadCurve& curve) const {
    return curve.outward(0).y < kLevelFoot && curve.outward(curve.length()).y < kLevelFoot;
  }
  /// The course's line that the lowest stones of an arch stand on, where their feet would lie level in the middle of one.
  double foot_of(const HeadCurve& curve) const {
    const double spring = std::min(curve.at(0).y, curve.at(curve.length()).y);
    return has_courses(m_.bond) ? line_below(spring) : spring - joint();
  }

  void stand_on_course(const HeadCurve& curve, double depth, Try& out) const {
    const Point2 begin = curve.at(0), end = curve.at(curve.length());
    const double seat = foot_of(curve) + half_bed();
    if (!stands(curve) || !has_courses(m_.bond) || std::min(begin.y, end.y) - seat < kSameHeight) return;
    // Behind the inner corner: the outline of a wedge goes on from there to its outer corner.
    Outline& right = out.stones.front().outline;
    right.insert(std::ranges::find(right, begin) + 1, {{begin.x, seat}, {outside(curve, 0, depth).x, seat}});
    Outline& left = out.stones.back().outline;
    left.push_back({outside(curve, curve.length(), depth).x, seat});
    left.push_back({end.x, seat});
  }

  /// What an arch takes, its opening's head included. Sampled as its stones are, so that their outer edges run beside it.
  Outline under_arch(const HeadCurve& curve, double reach, int count) const {
    Outline out;
    const bool level = stands(curve);
    const double end = curve.length(), foot = foot_of(curve);
    const auto shifted = [&](double s, double sign) {
      const Point2 p = outside(curve, s, reach), n = curve.outward(s);
      return level ? p : Point2{p.x + n.y * joint() * sign, p.y - n.x * joint() * sign};
    };
    out.push_back(level ? Point2{outside(curve, 0, reach).x, foot} : curve.at(0));
    out.push_back(shifted(0, 1));
    for (int k = 1; k < 3 * count; ++k) out.push_back(outside(curve, end * k / (3 * count), reach));
    out.push_back(shifted(end, -1));
    out.push_back(level ? Point2{outside(curve, end, reach).x, foot} : curve.at(end));
    return out;
  }

  /// Stones all round a round window.
  std::optional<Try> ring(const Outline& opening, double scale) const {
    Outline points = opening;
    const auto right = std::ranges::max_element(points, {}, &Point2::x);
    std::rotate(points.begin(), right, points.end());
    points.push_back(points.front());
    const HeadCurve curve(points);
    const double depth = sizes_.arch_depth * scale;
    // A stone in the middle at the top: that is a quarter of the way.
    const int quarter = std::max(1, static_cast<int>(std::lround((curve.length() / sizes_.voussoir - 2) / 4)));
    const int count = 4 * quarter + 2;
    Try out;
    Outline blocked;
    for (int i = 0; i < count; ++i) {
      const double from = curve.length() * i / count, to = curve.length() * (i + 1) / count;
      out.stones.push_back(
          {wedge(curve, from, to, true, true, depth), i == quarter ? StoneRole::keystone : StoneRole::voussoir});
      blocked.push_back(outside(curve, from, depth + joint()));
      blocked.push_back(outside(curve, (from + to) / 2, depth + joint()));
    }
    out.blocked.push_back(std::move(blocked));
    return out;
  }

  const WallToLay& wall_;
  const Masonry& m_;
  Sizes sizes_;
  std::vector<OpeningShape> shapes_;
  std::vector<std::pair<std::size_t, Box>> taken_;
  Dressings out_;
};

}  // namespace

Dressings dress(const WallToLay& wall, const Masonry& masonry) { return Dresser(wall, masonry).all(); }

}  // namespace blockrand::masonry
