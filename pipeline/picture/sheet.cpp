#include "pipeline/picture/sheet.h"

#include <algorithm>
#include <cmath>

#include "pipeline/picture/lettering.h"
#include "pipeline/picture/plan.h"

namespace blockrand::picture {

using model::Colour;
using model::Point2;

namespace {

constexpr Colour kInk{30, 30, 30}, kSoftInk{90, 88, 84}, kLine{150, 147, 142};

/// Of the width of the sheet.
constexpr double kMargin = 0.018, kTitle = 0.036, kLeastTitle = 0.020, kText = 0.0185, kSmall = 0.0155;
constexpr double kLineHeight = 1.32;  // em

class Sheet {
 public:
  Sheet(const Image& map, const SheetText& text)
      : map_(map),
        text_(text),
        width_(std::max(kLeastSheet,
                        map.width + 2 * static_cast<int>(std::ceil(map.width * kMargin / (1 - 2 * kMargin))))),
        margin_(width_ * kMargin),
        body_(width_ * kText),
        small_(width_ * kSmall) {
    lay_out();
  }

  Image drawn(Colour paper) const {
    Plan plan({0, 0, static_cast<double>(width_), height_}, 1, paper);
    Image& image = plan.image();
    const int left = (width_ - map_.width) / 2, top = static_cast<int>(map_top_);
    for (int y = 0; y < map_.height; ++y)
      std::copy_n(map_.pixel(0, y), static_cast<std::size_t>(map_.width) * 3,
                  image.rgb.begin() + ((static_cast<std::ptrdiff_t>(top) + y) * image.width + left) * 3);
    const double thin = std::max(1.0, width_ / 1500.0);
    rectangle(plan, left - thin / 2, top - thin / 2, left + map_.width + thin / 2, top + map_.height + thin / 2, thin);

    letters_.write(image, {margin_, margin_ + title_size_ * kAscent}, title_, {.size = title_size_, .colour = kInk});
    double base = margin_ + title_size_ * kLineHeight + body_ * kAscent;
    for (const std::string& line : below_) {
      letters_.write(image, {margin_, base}, line, {.size = body_, .colour = kSoftInk});
      base += body_ * kLineHeight;
    }
    draw_legend(plan, thin);
    draw_scale_and_north(plan, thin);

    base = small_top_ + small_ * kAscent;
    for (const std::string& line : small_lines_) {
      letters_.write(image, {margin_, base}, line, {.size = small_, .colour = kSoftInk});
      base += small_ * kLineHeight;
    }
    if (!text_.generator.empty())
      letters_.write(image,
                     {width_ - margin_ - letters_.width(text_.generator, small_),
                      base - (generator_beside_ ? small_ * kLineHeight : 0)},
                     text_.generator, {.size = small_, .colour = kSoftInk});
    return std::move(plan.image());
  }

 private:
  void lay_out() {
    const double across = width_ - 2 * margin_;
    title_size_ = width_ * kTitle;
    if (const double w = letters_.width(text_.title, title_size_); w > across)
      title_size_ = std::max(width_ * kLeastTitle, title_size_ * across / w * 0.999);
    title_ = letters_.fitted(text_.title, title_size_, across);
    for (const std::string& paragraph : text_.below_title)
      for (std::string& line : letters_.lines(paragraph, body_, across))
        below_.push_back(letters_.fitted(line, body_, across));
    map_top_ = std::ceil(margin_ + title_size_ * kLineHeight +
                         static_cast<double>(below_.size()) * body_ * kLineHeight + margin_ * 0.6);
    block_top_ = map_top_ + map_.height + margin_;

    // Scale and north stand at the right; the legend fills what is left of them.
    right_width_ = 0;
    if (text_.metres_per_pixel > 0) {
      bar_ = round_length(across * 0.28 * text_.metres_per_pixel);
      right_width_ = bar_ / text_.metres_per_pixel;
    }
    if (!text_.north.empty()) {
      right_width_ = std::max(right_width_, across * 0.2) + body_ * 2.6;
      north_ = letters_.lines(text_.north, small_, right_width_ - body_ * 2.6);
      for (const std::string& line : north_)
        right_width_ = std::max(right_width_, letters_.width(line, small_) + body_ * 2.6);
    }
    const double for_legend = across - (right_width_ > 0 ? right_width_ + margin_ : 0);
    double widest = 0;
    for (const LegendEntry& e : text_.legend) widest = std::max(widest, letters_.width(e.words, body_));
    column_ = widest + body_ * 3.4;
    const int count = static_cast<int>(text_.legend.size());
    const int columns = std::clamp(static_cast<int>((for_legend + body_) / column_), 1, std::max(1, count));
    rows_ = std::max(1, (count + columns - 1) / columns);
    const double right_height =
        (bar_ > 0 ? body_ * 2.2 : 0) + static_cast<double>(north_.size()) * small_ * kLineHeight;
    small_top_ = block_top_ + std::max(count > 0 ? rows_ * body_ * kLineHeight : 0, right_height) + margin_ * 0.7;

    const double generator = text_.generator.empty() ? 0 : letters_.width(text_.generator, small_) + margin_;
    small_lines_ = letters_.lines(text_.attribution, small_, across);
    generator_beside_ = !small_lines_.empty() && letters_.width(small_lines_.back(), small_) + generator <= across;
    height_ =
        std::ceil(small_top_ +
                  static_cast<double>(small_lines_.size() + (text_.generator.empty() || generator_beside_ ? 0 : 1)) *
                      small_ * kLineHeight +
                  margin_ * 0.8);
  }

  // Plans count upwards, sheets downwards.
  Point2 up(double x, double y) const { return {x, height_ - y}; }
  void area(Plan& plan, std::initializer_list<Point2> corners, Colour colour) const {
    model::Polygon p;
    p.outer.points = corners;
    plan.fill(p, colour);
  }
  void rectangle(Plan& plan, double x0, double y0, double x1, double y1, double thin) const {
    const Point2 ring[] = {up(x0, y0), up(x1, y0), up(x1, y1), up(x0, y1)};
    plan.stroke(ring, thin, kLine, true);
  }

  void draw_legend(Plan& plan, double thin) const {
    for (std::size_t i = 0; i < text_.legend.size(); ++i) {
      const LegendEntry& e = text_.legend[i];
      const double x = margin_ + static_cast<double>(static_cast<int>(i) / rows_) * column_,
                   base = block_top_ + static_cast<double>(static_cast<int>(i) % rows_) * body_ * kLineHeight +
                          body_ * kAscent,
                   middle = base - body_ * kCapitals / 2, right = x + body_ * 1.5;
      if (e.sign == LegendSign::area) {
        const double half = body_ * 0.42;
        area(plan, {up(x, middle - half), up(right, middle - half), up(right, middle + half), up(x, middle + half)},
             e.colour);
        rectangle(plan, x, middle - half, right, middle + half, thin);
      } else {
        const Point2 line[] = {up(x + body_ * 0.15, middle), up(right - body_ * 0.15, middle)};
        plan.stroke(line, body_ * (e.sign == LegendSign::line ? 0.34 : 0.12), e.colour);
      }
      letters_.write(plan.image(), {right + body_ * 0.55, base}, e.words, {.size = body_, .colour = kInk});
    }
  }

  void draw_scale_and_north(Plan& plan, double thin) const {
    const double right = width_ - margin_, left = right - right_width_;
    double y = block_top_;
    if (bar_ > 0) {
      // Four fields, dark and pale in turn.
      const double length = bar_ / text_.metres_per_pixel, high = body_ * 0.42, top = y + body_ * 1.25;
      for (int i = 0; i < 4; ++i) {
        const double x0 = left + length * i / 4, x1 = left + length * (i + 1) / 4;
        area(plan, {up(x0, top), up(x1, top), up(x1, top + high), up(x0, top + high)},
             i % 2 == 0 ? kInk : Colour{255, 255, 255});
      }
      rectangle(plan, left, top, left + length, top + high, thin);
      const std::string words = length_text(bar_);
      letters_.write(plan.image(), {left, y + body_ * kAscent}, "0", {.size = body_, .colour = kInk});
      letters_.write(plan.image(), {left + length - letters_.width(words, body_), y + body_ * kAscent}, words,
                     {.size = body_, .colour = kInk});
      y += body_ * 2.2;
    }
    if (north_.empty()) return;
    double base = y + small_ * kAscent;
    for (const std::string& line : north_) {
      letters_.write(plan.image(), {left, base}, line, {.size = small_, .colour = kSoftInk});
      base += small_ * kLineHeight;
    }
    // An arrow that points up, half of it pale, with its letter on top.
    const double x = right - body_ * 0.8, top = block_top_ + body_ * 1.0, bottom = block_top_ + body_ * 3.6,
                 half = body_ * 0.62;
    letters_.write(plan.image(), {x - letters_.width("N", body_) / 2, block_top_ + body_ * 0.75}, "N",
                   {.size = body_, .colour = kInk});
    area(plan, {up(x, top), up(x - half, bottom), up(x, bottom - half * 0.8)}, kInk);
    const Point2 other[] = {up(x, top), up(x + half, bottom), up(x, bottom - half * 0.8)};
    plan.stroke(other, thin, kInk, true);
  }

  const Image& map_;
  const SheetText& text_;
  Lettering letters_;
  int width_;
  double margin_, body_, small_;  // px
  double height_ = 0, title_size_ = 0, map_top_ = 0, block_top_ = 0, small_top_ = 0, right_width_ = 0, column_ = 0,
         bar_ = 0;
  int rows_ = 1;
  bool generator_beside_ = false;
  std::string title_;
  std::vector<std::string> below_, north_, small_lines_;
};

}  // namespace

Image sheet(const Image& map, const SheetText& text, Colour paper) { return Sheet(map, text).drawn(paper); }

}  // namespace blockrand::picture
