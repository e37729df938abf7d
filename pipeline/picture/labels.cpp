#include "pipeline/picture/labels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace blockrand::picture {

using model::Point2;

namespace {

using Line = std::vector<Point2>;
using Box = std::array<Point2, 4>;

constexpr double kGoesOn = 0.77;    // cosine: two pieces that bend more are two lines (40 degrees)
constexpr double kBend = 0.30;      // em: how far a line may leave the straight one below its name
constexpr double kNeed = 0.75;      // em: a line is longer than its name by that
constexpr double kCovered = 1.5;    // em of bend that it is worth to cover nothing
constexpr double kSmaller = 0.25;   // em of bend that the full size is worth
constexpr double kMiddle = 0.0012;  // em of bend that a px from the middle of the line is worth

double length_of(Point2 v) { return std::sqrt(v.x * v.x + v.y * v.y); }

double length_of(const Line& line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i)
    sum += length_of({line[i].x - line[i - 1].x, line[i].y - line[i - 1].y});
  return sum;
}

bool before(const Point2& a, const Point2& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }
bool before(const Line& a, const Line& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                      [](const Point2& p, const Point2& q) { return before(p, q); });
}
bool same(const Point2& a, const Point2& b) { return a.x == b.x && a.y == b.y; }

/// The parts of a line within the picture.
void add_inside(const Line& line, double width, double height, std::vector<Line>& out) {
  Line part;
  const auto end = [&] {
    if (part.size() > 1) out.push_back(part);
    part.clear();
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point2 a = line[i], b = line[i + 1];
    // Liang and Barsky: what is left of the piece after each border.
    double from = 0, to = 1;
    const auto cut = [&](double towards, double room) {
      if (towards == 0) {
        if (room < 0) to = -1;
      } else if (towards < 0) {
        from = std::max(from, room / towards);
      } else {
        to = std::min(to, room / towards);
      }
    };
    const double dx = b.x - a.x, dy = b.y - a.y;
    cut(-dx, a.x), cut(dx, width - a.x), cut(-dy, a.y), cut(dy, height - a.y);
    if (!(from < to)) {
      end();
      continue;
    }
    if (from > 0) end();
    if (part.empty()) part.push_back(from > 0 ? Point2{a.x + from * dx, a.y + from * dy} : a);
    part.push_back(to < 1 ? Point2{a.x + to * dx, a.y + to * dy} : b);
    if (to < 1) end();
  }
  end();
}

/// The direction of a line's last piece.
Point2 direction_at_end(const Line& line) {
  for (std::size_t i = line.size(); i-- > 1;) {
    const Point2 v{line.back().x - line[i - 1].x, line.back().y - line[i - 1].y};
    if (const double l = length_of(v); l > 0) return {v.x / l, v.y / l};
  }
  return {0, 0};
}

/// Pieces that go on in each other become one line.
std::vector<Line> joined(std::vector<Line> pieces) {
  for (Line& piece : pieces) {
    Line turned(piece.rbegin(), piece.rend());
    if (before(turned, piece)) piece = std::move(turned);
  }
  std::sort(pieces.begin(), pieces.end(), [](const Line& a, const Line& b) { return before(a, b); });
  pieces.erase(std::unique(pieces.begin(), pieces.end(),
                           [](const Line& a, const Line& b) {
                             return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
                           }),
               pieces.end());
  std::vector<bool> used(pieces.size(), false);
  const auto extend = [&](Line& line) {
    for (;;) {
      const Point2 d = direction_at_end(line);
      std::size_t best = pieces.size();
      bool best_turned = false;
      double straightest = kGoesOn;
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (used[i]) continue;
        for (const bool turned : {false, true}) {
          if (!same(turned ? pieces[i].back() : pieces[i].front(), line.back())) continue;
          Line other = pieces[i];
          if (!turned) std::reverse(other.begin(), other.end());
          const Point2 e = direction_at_end(other);  // back to where they meet
          if (const double c = -(d.x * e.x + d.y * e.y); c > straightest) {
            straightest = c;
            best = i;
            best_turned = turned;
          }
        }
      }
      if (best == pieces.size()) return;
      used[best] = true;
      Line other = pieces[best];
      if (best_turned) std::reverse(other.begin(), other.end());
      line.insert(line.end(), other.begin() + 1, other.end());
    }
  };
  std::vector<Line> out;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (used[i]) continue;
    used[i] = true;
    Line line = pieces[i];
    extend(line);
    std::reverse(line.begin(), line.end());
    extend(line);
    out.push_back(std::move(line));
  }
  return out;
}

/// Where along a line something is.
class Measured {
 public:
  explicit Measured(const Line& line) : line_(line), at_{0} {
    for (std::size_t i = 1; i < line.size(); ++i)
      at_.push_back(at_.back() + length_of({line[i].x - line[i - 1].x, line[i].y - line[i - 1].y}));
  }
  double length() const { return at_.back(); }
  Point2 point(double at) const {
    std::size_t i = 1;
    while (i + 1 < line_.size() && at_[i] < at) ++i;
    const double piece = at_[i] - at_[i - 1], share = piece > 0 ? std::clamp((at - at_[i - 1]) / piece, 0.0, 1.0) : 0;
    return {line_[i - 1].x + share * (line_[i].x - line_[i - 1].x),
            line_[i - 1].y + share * (line_[i].y - line_[i - 1].y)};
  }
  /// The straight line between two places that the line keeps nearest to, and how far it leaves it.
  struct Straight {
    Point2 middle, direction;
    double bend = 0;
  };
  std::optional<Straight> straight(double from, double to) const {
    const Point2 a = point(from), b = point(to);
    const double l = length_of({b.x - a.x, b.y - a.y});
    if (!(l > 0.95 * (to - from))) return std::nullopt;
    const Point2 d{(b.x - a.x) / l, (b.y - a.y) / l};
    double left = 0, right = 0;
    for (std::size_t i = 0; i < line_.size(); ++i)
      if (at_[i] > from && at_[i] < to) {
        const double off = d.x * (line_[i].y - a.y) - d.y * (line_[i].x - a.x);
        left = std::min(left, off), right = std::max(right, off);
      }
    const double shift = (left + right) / 2;
    return Straight{{(a.x + b.x) / 2 - d.y * shift, (a.y + b.y) / 2 + d.x * shift}, d, (right - left) / 2};
  }

 private:
  const Line& line_;
  std::vector<double> at_;
};

struct Place {
  Label label;
  double cost = 0;  ///< em
};

void add_places(const Line& line, const std::string& name, double size, double width, std::vector<Place>& out) {
  const Measured measured(line);
  const double need = width + kNeed * size;
  if (measured.length() < need) return;
  const double step = std::max(size, need / 6), room = measured.length() - need;
  const int steps = 2 * static_cast<int>(room / step / 2);  // one of them is the middle
  for (int i = 0; i <= steps; ++i) {
    const double from = steps > 0 ? room * i / steps : room / 2;
    const auto straight = measured.straight(from, from + need);
    if (!straight || straight->bend > kBend * size) continue;
    Point2 d = straight->direction;
    // From left to right; what is upright from below.
    if (d.x < -1e-3 || (d.x <= 1e-3 && d.y > 0)) d = {-d.x, -d.y};
    const double off = std::fabs(from + need / 2 - measured.length() / 2);
    out.push_back({{name, straight->middle, d, size, width}, straight->bend / size + kMiddle * off});
  }
}

/// What a label would cover, 0 to 1: on four lines along it, but not on the middle one, where borders of blocks run.
double covered(const Label& label, const LabelOptions& options) {
  if (!options.covers) return 0;
  const double step = label.size / 4;
  const int steps = std::max(1, static_cast<int>(label.width / step));
  double sum = 0;
  for (const double across : {-0.42, -0.25, 0.25, 0.42})
    for (int i = 0; i <= steps; ++i) {
      const double along = label.width * (static_cast<double>(i) / steps - 0.5), off = across * label.size;
      sum += options.covers(static_cast<int>(label.middle.x + along * label.direction.x - off * label.direction.y),
                            static_cast<int>(label.middle.y + along * label.direction.y + off * label.direction.x));
    }
  return sum / (4.0 * (steps + 1));
}

struct Street {
  int rank = 0;
  double length = 0;
  std::string name;
  std::vector<Line> lines;
};

std::vector<Street> streets_of(std::span<const NamedLine> named, int width, int height) {
  std::map<std::string, Street> by_name;
  for (const NamedLine& line : named) {
    if (line.name.empty()) continue;
    // In one direction, whichever it is drawn in: where a border cuts it has the same bits.
    Line points = line.points, turned(points.rbegin(), points.rend());
    if (before(turned, points)) points = std::move(turned);
    std::vector<Line> inside;
    add_inside(points, width, height, inside);
    if (inside.empty()) continue;
    const auto [at, is_new] = by_name.try_emplace(line.name);
    Street& street = at->second;
    street.name = line.name;
    street.rank = is_new ? line.rank : std::min(street.rank, line.rank);
    std::move(inside.begin(), inside.end(), std::back_inserter(street.lines));
  }
  std::vector<Street> out;
  for (auto& [name, street] : by_name) {
    street.lines = joined(std::move(street.lines));
    std::stable_sort(street.lines.begin(), street.lines.end(),
                     [](const Line& a, const Line& b) { return length_of(a) > length_of(b); });
    street.length = length_of(street.lines.front());
    out.push_back(std::move(street));
  }
  std::sort(out.begin(), out.end(), [](const Street& a, const Street& b) {
    return std::tuple(a.rank, -a.length, std::string_view(a.name)) <
           std::tuple(b.rank, -b.length, std::string_view(b.name));
  });
  return out;
}

}  // namespace

Point2 Label::start() const {
  const double half = width / 2, below = size * kSmallLetters / 2;
  return {middle.x - half * direction.x - below * direction.y, middle.y - half * direction.y + below * direction.x};
}

std::array<Point2, 4> Label::corners() const {
  const Point2 s = start(), d = direction;
  const double up = size * 0.80, down = size * kDescent;
  const auto corner = [&](double along, double above) {
    return Point2{s.x + along * d.x + above * d.y, s.y + along * d.y - above * d.x};
  };
  return {corner(0, up), corner(width, up), corner(width, -down), corner(0, -down)};
}

bool overlap(const Box& a, const Box& b, double gap) {
  for (const Box* box : {&a, &b})
    for (std::size_t i = 0; i < 2; ++i) {
      const Point2 side{(*box)[i + 1].x - (*box)[i].x, (*box)[i + 1].y - (*box)[i].y};
      const double l = length_of(side);
      if (!(l > 0)) continue;
      const auto reach = [&](const Box& of) {
        double low = 1e300, high = -1e300;
        for (const Point2 p : of) {
          const double at = (p.x * side.x + p.y * side.y) / l;
          low = std::min(low, at), high = std::max(high, at);
        }
        return std::pair(low, high);
      };
      const auto [low_a, high_a] = reach(a);
      const auto [low_b, high_b] = reach(b);
      if (high_a + gap <= low_b || high_b + gap <= low_a) return false;
    }
  return true;
}

std::vector<Label> place_labels(std::span<const NamedLine> lines, int width, int height, const LabelOptions& options,
                                const Lettering& letters, std::span<const Box> taken) {
  const std::vector<Street> streets = streets_of(lines, width, height);
  std::vector<Box> boxes(taken.begin(), taken.end());
  std::vector<Label> out;
  const auto fits = [&](const Box& box) {
    for (const Point2 p : box)
      if (p.x < options.margin || p.y < options.margin || p.x > width - options.margin || p.y > height - options.margin)
        return false;
    return std::ranges::none_of(boxes, [&](const Box& other) { return overlap(box, other, options.between); });
  };
  std::vector<std::vector<Place>> places(streets.size());
  for (std::size_t s = 0; s < streets.size(); ++s) {
    const Street& street = streets[s];
    const double times =
        options.of_rank.empty()
            ? 1
            : options.of_rank[std::min(options.of_rank.size() - 1, static_cast<std::size_t>(std::max(0, street.rank)))];
    for (const double smaller : {1.0, options.smaller}) {
      const double size = options.size * times * smaller, text = letters.width(street.name, size);
      std::vector<Place> found;
      for (const Line& line : street.lines) add_places(line, street.name, size, text, found);
      for (Place& place : found) place.cost += kCovered * covered(place.label, options) + (smaller < 1 ? kSmaller : 0);
      std::move(found.begin(), found.end(), std::back_inserter(places[s]));
    }
    std::stable_sort(places[s].begin(), places[s].end(),
                     [](const Place& a, const Place& b) { return a.cost < b.cost; });
  }
  // Every name once, before any twice.
  std::vector<std::vector<Point2>> named(streets.size());
  for (const bool again : {false, true}) {
    if (again && !(options.apart > 0)) break;
    for (std::size_t s = 0; s < streets.size(); ++s) {
      if (again && named[s].empty()) continue;
      for (const Place& place : places[s]) {
        if (std::ranges::any_of(named[s], [&](Point2 p) {
              return length_of({p.x - place.label.middle.x, p.y - place.label.middle.y}) < options.apart;
            }))
          continue;
        const Box box = place.label.corners();
        if (!fits(box)) continue;
        boxes.push_back(box);
        named[s].push_back(place.label.middle);
        out.push_back(place.label);
        if (!again) break;
      }
    }
  }
  return out;
}

}  // namespace blockrand::picture
