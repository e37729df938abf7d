#include "pipeline/compare/report_svg.h"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/base/text.h"

namespace blockrand::compare {

void append_pixel(std::string& out, double value) {
  // A drawing is never so large; without the limits a stray point could not be an integer.
  const double limited = value > -1e6 ? std::fmin(value, 1e6) : -1e6;
  const long tenths = std::lround(limited * 10);
  if (tenths < 0) out += '-';
  const long size = tenths < 0 ? -tenths : tenths;
  out += std::to_string(size / 10);
  if (size % 10 != 0) (out += '.') += static_cast<char>('0' + size % 10);
}

void append_ring(std::string& out, std::span<const Point2> ring, const Sheet& sheet) {
  constexpr double kSmallest = 0.25;  // pixels
  const std::size_t before = out.size();
  double last_x = 0, last_y = 0;
  bool first = true;
  int corners = 0;
  for (const Point2& p : ring) {
    const double x = sheet.x(p.x), y = sheet.y(p.y);
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    if (!first && std::abs(x - last_x) < kSmallest && std::abs(y - last_y) < kSmallest) continue;
    out += first ? 'M' : 'L';
    append_pixel(out, x);
    out += ' ';
    append_pixel(out, y);
    last_x = x;
    last_y = y;
    first = false;
    ++corners;
  }
  if (corners >= 3)
    out += 'Z';
  else
    out.resize(before);
}

std::string scale_bar(const Sheet& sheet, double widest, double x, double y) {
  const double most = widest / sheet.scale;
  double length = 0.1;
  for (double decade = 0.1; decade <= most; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (decade * step <= most) length = decade * step;
  std::string out = "<path class=\"bar\" d=\"M";
  append_pixel(out, x);
  out += ' ';
  append_pixel(out, y - 4);
  out += "v4h";
  append_pixel(out, length * sheet.scale);
  out += "v-4\"/><text x=\"";
  append_pixel(out, x + length * sheet.scale + 4);
  out += "\" y=\"";
  append_pixel(out, y + 1);
  return out + "\">" + base::shortest(std::round(length * 10) / 10) + "\u00a0m</text>";
}

}  // namespace blockrand::compare
