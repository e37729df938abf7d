#include "pipeline/picture/plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "pipeline/picture/lettering.h"

namespace blockrand::picture {

using model::Colour;
using model::Point2;

namespace {

constexpr int kLongestSide = 8192;  // pixels
constexpr int kDiscCorners = 16;    // of round ends: a quarter of a pixel off at a width of 30 pixels

/// Directions to the corners of a regular polygon, by halving angles: sqrt alone, so that every CPU agrees.
std::vector<Point2> directions() {
  std::vector<Point2> out{{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  while (out.size() < kDiscCorners) {
    std::vector<Point2> finer;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Point2 a = out[i], b = out[(i + 1) % out.size()], sum{a.x + b.x, a.y + b.y};
      const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y);
      finer.push_back(a);
      finer.push_back({sum.x / length, sum.y / length});
    }
    out = std::move(finer);
  }
  return out;
}

/// How much of each pixel of a rectangle lies inside contours that run counter-clockwise (in a picture with rows
/// downwards: clockwise). Each edge adds the area to its right, as signed differences along the row; their running sum is
/// the coverage (the accumulation buffer of font rasterisers).
class Coverage {
 public:
  /// \param change  its memory, which may be that of another before
  Coverage(int left, int top, int right, int bottom, std::vector<double>& change)
      : left_(left), top_(top), width_(right - left), height_(bottom - top), change_(change) {
    change_.assign(static_cast<std::size_t>(width_ + 2) * static_cast<std::size_t>(height_), 0.0);
  }

  void edge(Point2 a, Point2 b) {
    a = {a.x - left_, a.y - top_};
    b = {b.x - left_, b.y - top_};
    if (a.y == b.y) return;
    const double sign = a.y < b.y ? 1 : -1;
    if (a.y > b.y) std::swap(a, b);
    if (b.y <= 0 || a.y >= height_) return;
    const double slope = (b.x - a.x) / (b.y - a.y);
    const int first = std::max(0, static_cast<int>(std::floor(a.y)));
    const int last = std::min(height_ - 1, static_cast<int>(std::ceil(b.y)) - 1);
    for (int row = first; row <= last; ++row) {
      const double y0 = std::max(a.y, static_cast<double>(row)), y1 = std::min(b.y, static_cast<double>(row + 1));
      piece(row, sign, y1 - y0, a.x + (y0 - a.y) * slope, a.x + (y1 - a.y) * slope);
    }
  }

  template <class F>
  void for_each(const F& paint) const {
    for (int row = 0; row < height_; ++row) {
      double sum = 0;
      const double* change = &change_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_ + 2)];
      for (int column = 0; column < width_; ++column) {
        sum += change[column];
        const double covered = std::min(1.0, std::fabs(sum));
        if (covered > 1e-6) paint(left_ + column, top_ + row, covered);
      }
    }
  }

 private:
  /// A piece of an edge within one row, `dy` high, from x0 to x1.
  void piece(int row, double sign, double dy, double x0, double x1) {
    if (x0 > x1) std::swap(x0, x1);
    // What lies outside counts as if at the border: everything to its right is covered, or nothing.
    const double inside0 = std::clamp(x0, 0.0, static_cast<double>(width_));
    const double inside1 = std::clamp(x1, 0.0, static_cast<double>(width_));
    const double span = x1 - x0;
    double* change = &change_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_ + 2)];
    const auto vertical = [&](double x, double h) {  // at x, h high: the rest of its pixel, then all to the right
      const int column = std::min(static_cast<int>(x), width_);
      const double here = sign * h * (column + 1 - x);
      change[column] += here;
      change[column + 1] += sign * h - here;
    };
    if (span <= 0) return vertical(inside0, dy);
    if (inside0 > x0) vertical(0, dy * (std::min(inside0, x1) - x0) / span);
    if (x1 > inside1) vertical(width_, dy * (x1 - std::max(inside1, x0)) / span);
    // Pixel by pixel; within one the mean of both ends counts.
    for (double x = inside0; x < inside1;) {
      const double next = std::min(inside1, std::floor(x) + 1);
      vertical((x + next) / 2, dy * (next - x) / span);
      x = next;
    }
  }

  int left_, top_, width_, height_;
  std::vector<double>& change_;
};

std::uint8_t mixed(std::uint8_t below, std::uint8_t above, double share) {
  return static_cast<std::uint8_t>(below + (above - below) * share + 0.5);
}

}  // namespace

namespace {

/// Of no pixels yet.
Image sized(const PlanBox& box, double scale) {
  const double width = std::ceil(box.width() * scale - 1e-6), height = std::ceil(box.height() * scale - 1e-6);
  if (!(width >= 1) || !(height >= 1) || !(width <= kLongestSide) || !(height <= kLongestSide))
    throw std::invalid_argument("a plan of no size, or of more than 8192 pixels");
  return {static_cast<int>(width), static_cast<int>(height), {}};
}

}  // namespace

Plan::Plan(const PlanBox& box, double pixels_per_metre, Colour paper)
    : box_(box), scale_(pixels_per_metre), image_(sized(box, pixels_per_metre)) {
  image_ = blank(image_.width, image_.height, paper);
}

Plan::Plan(const PlanBox& box, double pixels_per_metre, Image under)
    : box_(box), scale_(pixels_per_metre), image_(sized(box, pixels_per_metre)) {
  if (under.width != image_.width || under.height != image_.height ||
      under.rgb.size() != static_cast<std::size_t>(under.width) * static_cast<std::size_t>(under.height) * 3)
    throw std::invalid_argument("a picture of another size than the plan");
  image_ = std::move(under);
}

bool Plan::misses(std::span<const Point2> points, double margin) const {
  double west = 1e300, south = 1e300, east = -1e300, north = -1e300;
  for (const Point2 p : points)
    west = std::min(west, p.x), east = std::max(east, p.x), south = std::min(south, p.y), north = std::max(north, p.y);
  return west - margin > box_.max_x || east + margin < box_.min_x || south - margin > box_.max_y ||
         north + margin < box_.min_y;
}

void Plan::cover(Contours& contours, Colour colour, double opacity) {
  double min_x = 1e9, min_y = 1e9, max_x = -1e9, max_y = -1e9;
  for (Point2& p : contours.points) {
    p = pixel_of(p);
    min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y);
  }
  const auto whole = [](double v, int most) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most))); };
  const int left = whole(std::floor(min_x), image_.width), right = whole(std::ceil(max_x), image_.width);
  const int top = whole(std::floor(min_y), image_.height), bottom = whole(std::ceil(max_y), image_.height);
  if (left >= right || top >= bottom) return;
  Coverage coverage(left, top, right, bottom, change_);
  std::size_t begin = 0;
  for (const std::size_t end : contours.ends) {
    for (std::size_t i = begin; i < end; ++i)
      coverage.edge(contours.points[i], contours.points[i + 1 == end ? begin : i + 1]);
    begin = end;
  }
  coverage.for_each([&](int x, int y, double covered) {
    std::uint8_t* const rgb =
        &image_
             .rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x)) *
                  3];
    const double share = covered * opacity;
    if (share >= 1) {
      rgb[0] = colour.r, rgb[1] = colour.g, rgb[2] = colour.b;
      return;
    }
    rgb[0] = mixed(rgb[0], colour.r, share);
    rgb[1] = mixed(rgb[1], colour.g, share);
    rgb[2] = mixed(rgb[2], colour.b, share);
  });
}

void Plan::fill(const model::Polygon& polygon, Colour colour, double opacity) {
  if (misses(polygon.outer.points, 0)) return;
  Contours& contours = emptied();
  const auto add = [&](const model::Ring& ring) {
    contours.points.insert(contours.points.end(), ring.points.begin(), ring.points.end());
    contours.end();
  };
  add(polygon.outer);
  for (const model::Ring& hole : polygon.holes) add(hole);
  cover(contours, colour, std::clamp(opacity, 0.0, 1.0));
}

void Plan::stroke(std::span<const Point2> points, double width, Colour colour, bool closed) {
  static const std::vector<Point2> kDirections = directions();
  const double half = width / 2;
  if (misses(points, half)) return;
  Contours& contours = emptied();
  for (const Point2 p : points) {
    for (const Point2 d : kDirections) contours.points.push_back({p.x + d.x * half, p.y + d.y * half});
    contours.end();
  }
  const std::size_t pieces = points.size() - (closed ? 0 : 1);
  for (std::size_t i = 0; points.size() > 1 && i < pieces; ++i) {
    const Point2 a = points[i], b = points[(i + 1) % points.size()];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    if (!(length > 0)) continue;
    const Point2 n{-dy / length * half, dx / length * half};  // to the left
    for (const Point2 p : {Point2{a.x - n.x, a.y - n.y}, Point2{b.x - n.x, b.y - n.y}, Point2{b.x + n.x, b.y + n.y},
                           Point2{a.x + n.x, a.y + n.y}})
      contours.points.push_back(p);
    contours.end();
  }
  cover(contours, colour, 1);
}

double round_length(double most) {
  double length = 1;
  for (double step = 1; step <= 1e6; step *= 10)
    for (const double n : {1.0, 2.0, 5.0})
      if (n * step <= most) length = n * step;
  return length;
}

std::string length_text(double metres) {
  return metres < 1000 ? std::to_string(static_cast<long>(metres)) + " m"
                       : std::to_string(static_cast<long>(metres / 1000)) + " km";
}

double Plan::draw_scale_bar(double size) {
  const double length = round_length(box_.width() / 4), unit = size / 14;  // px for a line of fourteenths
  const double pixel = unit / scale_, x = box_.min_x + 14 * pixel, y = box_.min_y + 14 * pixel;
  const Colour ink{30, 30, 30}, halo{255, 255, 255};
  const Point2 bar[] = {{x, y + 7 * pixel}, {x, y}, {x + length, y}, {x + length, y + 7 * pixel}};
  stroke(bar, 6 * pixel, halo);
  stroke(bar, 2.4 * pixel, ink);
  Lettering().write(image_, pixel_of({x + 6 * pixel, y + 7 * pixel}), length_text(length),
                    {.size = size, .colour = ink, .halo = 2 * unit, .halo_colour = halo});
  return length;
}

double scale_for(const PlanBox& box, int pixels) { return pixels / std::max(box.width(), box.height()); }

}  // namespace blockrand::picture
