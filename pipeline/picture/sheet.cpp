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

}  // namespace

class Sheet::Layout {
 public:
  Layout(int map_width, int map_height, const SheetText& text)
      : map_width_(map_width),
        map_height_(map_height),
        text_(text),
        width_(std::max(kLeastSheet,
                        map_width + 2 * static_cast<int>(std::ceil(map_width * kMargin / (1 - 2 * kMargin))))),
        margin_(width_ * kMargin),
        body_(width_ * kText),
        small_(width_ * kSmall) {
    lay_out();
  }

  int width() const { return width_; }
  int height() const { return static_cast<int>(height_); }
  int map_left() const { return (width_ - map_width_) / 2; }
  int map_top() const { return static_cast<int>(map_top_); }

  void draw(Image& rows, int first) const {
    const int height = rows.height;
    Plan plan({0, height_ - first - height, static_cast<double>(width_), height_ - first}, 1, std::move(rows));
    Page page{plan, static_cast<double>(first)};
    const int left = map_left(), top = map_top();
    const double thin = std::max(1.0, width_ / 1500.0);
    rectangle(page, left - thin / 2, top - thin / 2, left + map_width_ + thin / 2, top + map_height_ + thin / 2, thin);

    write(page, {margin_, margin_ + title_size_ * kAscent}, title_, {.size = title_size_, .colour = kInk});
    double base = margin_ + title_size_ * kLineHeight + body_ * kAscent;
    for (const std::string& line : below_) {
      write(page, {margin_, base}, line, {.size = body_, .colour = kSoftInk});
      base += body_ * kLineHeight;
    }
    draw_legend(page, thin);
    draw_scale_and_north(page, thin);

    base = small_top_ + small_ * kAscent;
    for (const std::string& line : small_lines_) {
      write(page, {margin_, base}, line, {.size = small_, .colour = kSoftInk});
      base += small_ * kLineHeight;
    }
    if (!text_.generator.empty())
      write(page,
            {width_ - margin_ - letters_.width(text_.generator, small_),
             base - (generator_beside_ ? small_ * kLineHeight : 0)},
            text_.generator, {.size = small_, .colour = kSoftInk});
    rows = std::move(plan.image());
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
    block_top_ = map_top_ + map_height_ + margin_;

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

  /// Some rows of the sheet.
  struct Page {
    Plan& plan;
    double first;  ///< px
  };
  void write(Page& page, Point2 at, std::string_view text, const TextStyle& style) const {
    const double y = at.y - page.first;
    if (y < -style.size || y > page.plan.image().height + style.size) return;
    letters_.write(page.plan.image(), {at.x, y}, text, style);
  }
  // Plans count upwards, sheets downwards.
  Point2 up(double x, double y) const { return {x, height_ - y}; }
  void area(Page& page, std::initializer_list<Point2> corners, Colour colour) const {
    model::Polygon p;
    p.outer.points = corners;
    page.plan.fill(p, colour);
  }
  void rectangle(Page& page, double x0, double y0, double x1, double y1, double thin) const {
    const Point2 ring[] = {up(x0, y0), up(x1, y0), up(x1, y1), up(x0, y1)};
    page.plan.stroke(ring, thin, kLine, true);
  }

  void draw_legend(Page& page, double thin) const {
    for (std::size_t i = 0; i < text_.legend.size(); ++i) {
      const LegendEntry& e = text_.legend[i];
      const double x = margin_ + static_cast<double>(static_cast<int>(i) / rows_) * column_,
                   base = block_top_ + static_cast<double>(static_cast<int>(i) % rows_) * body_ * kLineHeight +
                          body_ * kAscent,
                   middle = base - body_ * kCapitals / 2, right = x + body_ * 1.5;
      if (e.sign == LegendSign::area) {
        const double half = body_ * 0.42;
        area(page, {up(x, middle - half), up(right, middle - half), up(right, middle + half), up(x, middle + half)},
             e.colour);
        rectangle(page, x, middle - half, right, middle + half, thin);
      } else {
        const Point2 line[] = {up(x + body_ * 0.15, middle), up(right - body_ * 0.15, middle)};
        page.plan.stroke(line, body_ * (e.sign == LegendSign::line ? 0.34 : 0.12), e.colour);
      }
      write(page, {right + body_ * 0.55, base}, e.words, {.size = body_, .colour = kInk});
    }
  }

  void draw_scale_and_north(Page& page, double thin) const {
    const double right = width_ - margin_, left = right - right_width_;
    double y = block_top_;
    if (bar_ > 0) {
      // Four fields, dark and pale in turn.
      const double length = bar_ / text_.metres_per_pixel, high = body_ * 0.42, top = y + body_ * 1.25;
      for (int i = 0; i < 4; ++i) {
        const double x0 = left + length * i / 4, x1 = left + length * (i + 1) / 4;
        area(page, {up(x0, top), up(x1, top), up(x1, top + high), up(x0, top + high)},
             i % 2 == 0 ? kInk : Colour{255, 255, 255});
      }
      rectangle(page, left, top, left + length, top + high, thin);
      const std::string words = length_text(bar_);
      write(page, {left, y + body_ * kAscent}, "0", {.size = body_, .colour = kInk});
      write(page, {left + length - letters_.width(words, body_), y + body_ * kAscent}, words,
            {.size = body_, .colour = kInk});
      y += body_ * 2.2;
    }
    if (north_.empty()) return;
    double base = y + small_ * kAscent;
    for (const std::string& line : north_) {
      write(page, {left, base}, line, {.size = small_, .colour = kSoftInk});
      base += small_ * kLineHeight;
    }
    // An arrow that points up, half of it pale, with its letter on top.
    const double x = right - body_ * 0.8, top = block_top_ + body_ * 1.0, bottom = block_top_ + body_ * 3.6,
                 half = body_ * 0.62;
    write(page, {x - letters_.width("N", body_) / 2, block_top_ + body_ * 0.75}, "N", {.size = body_, .colour = kInk});
    area(page, {up(x, top), up(x - half, bottom), up(x, bottom - half * 0.8)}, kInk);
    const Point2 other[] = {up(x, top), up(x + half, bottom), up(x, bottom - half * 0.8)};
    page.plan.stroke(other, thin, kInk, true);
  }

  int map_width_, map_height_;  // px
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

Sheet::Sheet(int map_width, int map_height, const SheetText& text)
    : layout_(std::make_unique<Layout>(map_width, map_height, text)) {}
Sheet::~Sheet() = default;
int Sheet::width() const { return layout_->width(); }
int Sheet::height() const { return layout_->height(); }
int Sheet::map_left() const { return layout_->map_left(); }
int Sheet::map_top() const { return layout_->map_top(); }
void Sheet::draw(Image& rows, int first) const { layout_->draw(rows, first); }

Image sheet(const Image& map, const SheetText& text, Colour paper) {
  const Sheet layout(map.width, map.height, text);
  Image out = blank(layout.width(), layout.height(), paper);
  put(out, map, layout.map_left(), layout.map_top());
  layout.draw(out, 0);
  return out;
}

}  // namespace blockrand::picture
