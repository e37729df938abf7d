// The plan of a match: the reference's outline and the model's.
#include <algorithm>

#include "pipeline/base/markup.h"
#include "pipeline/compare/report_svg.h"

namespace blockrand::compare {
namespace {

struct Extent {
  Point2 low, high;
  bool empty = true;
  void include(Point2 p) {
    low = empty ? p : Point2{std::min(low.x, p.x), std::min(low.y, p.y)};
    high = empty ? p : Point2{std::max(high.x, p.x), std::max(high.y, p.y)};
    empty = false;
  }
};

void include(Extent& extent, const City& city, const SideFacts& side) {
  for (const std::uint32_t b : side.buildings)
    for (const model::Polygon& polygon : city.buildings[b].footprint)
      for (const Point2& p : polygon.outer.points) extent.include(p);
}

void append_side(std::string& out, const City& city, const SideFacts& side, const char* style, const Sheet& sheet) {
  std::string paths;
  for (const std::uint32_t b : side.buildings)
    for (const model::Polygon& polygon : city.buildings[b].footprint) {
      append_ring(paths, polygon.outer.points, sheet);
      for (const model::Ring& hole : polygon.holes) append_ring(paths, hole.points, sheet);
    }
  if (!paths.empty()) (((out += "<path class=\"") += style) += "\" d=\"" + paths) += "\"/>";
}

}  // namespace

std::string plan_drawing(const Comparison& comparison, const MatchResult& match, int width, int height) {
  Extent extent;
  include(extent, comparison.reference, match.reference);
  include(extent, comparison.model, match.model);
  if (extent.empty) return {};
  constexpr double kMargin = 12, kFoot = 22;  // pixels
  const double wide = std::max(1.0, extent.high.x - extent.low.x), high = std::max(1.0, extent.high.y - extent.low.y);
  const double room_x = width - 2 * kMargin, room_y = height - kMargin - kFoot;
  Sheet sheet;
  sheet.scale = std::min(room_x / wide, room_y / high);
  sheet.left = extent.low.x - (width / sheet.scale - wide) / 2;
  sheet.top = extent.high.y + (kMargin + (room_y - high * sheet.scale) / 2) / sheet.scale;
  const std::string w = std::to_string(width), h = std::to_string(height);
  std::string out = "<svg class=\"plan\" viewBox=\"0 0 " + w + " " + h + "\" width=\"" + w + "\" height=\"" + h +
                    "\" role=\"img\" aria-label=\"Plan of " + base::escaped(match.id) + "\">";
  append_side(out, comparison.reference, match.reference, "r", sheet);
  append_side(out, comparison.model, match.model, "m", sheet);
  out += scale_bar(sheet, width / 3.0, 8, height - 7);
  const std::string x = std::to_string(width - 14);
  out += "<path class=\"north\" d=\"M" + x + " 6l4.5 13l-4.5 -3l-4.5 3Z\"/><text class=\"mid\" x=\"" + x +
         "\" y=\"30\">N</text>";
  return out + "</svg>";
}

}  // namespace blockrand::compare
