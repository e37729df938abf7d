#include "pipeline/outputs/plan/plan_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/picture/image.h"

namespace blockrand::outputs {

namespace {

constexpr int kFilePixels = 3000;    // a side of the file: at kPlanReach a wall is two pixels wide
constexpr int kReportPixels = 1300;  // a side of the picture in the report
constexpr double kTileExtent = 700;  // m: buildings of a tile of level 15 lie at most so far from its centre
constexpr double kFinest = 8;        // pixels per metre: more shows nothing more

picture::PlanBox cropped(const picture::PlanBox& box, model::Point2 middle) {
  const auto crop = [](double low, double high, double at) {
    if (high - low <= 2 * kPlanReach) return std::pair(low, high);
    const double start = std::clamp(at - kPlanReach, low, high - 2 * kPlanReach);
    return std::pair(start, start + 2 * kPlanReach);
  };
  const auto [west, east] = crop(box.min_x, box.max_x, middle.x);
  const auto [south, north] = crop(box.min_y, box.max_y, middle.y);
  return {west, south, east, north};
}

bool meets(const picture::PlanBox& box, std::span<const model::Point2> points) {
  if (points.empty()) return false;
  picture::PlanBox of{points[0].x, points[0].y, points[0].x, points[0].y};
  for (const model::Point2 p : points)
    of = {std::min(of.min_x, p.x), std::min(of.min_y, p.y), std::max(of.max_x, p.x), std::max(of.max_y, p.y)};
  return of.min_x <= box.max_x && of.max_x >= box.min_x && of.min_y <= box.max_y && of.max_y >= box.min_y;
}

/// What can reach into the box as it is drawn.
picture::PlanBox reached(const picture::PlanBox& box) {
  constexpr double kMargin = 30;  // m: half a street's width, and its ends
  return {box.min_x - kMargin, box.min_y - kMargin, box.max_x + kMargin, box.max_y + kMargin};
}

/// m, drawn: wider for main streets. Not measured; a plan of edges needs streets to find one's way.
double street_width(context::LineClass kind) {
  if (kind <= context::LineClass::secondary) return 12;
  return kind <= context::LineClass::residential ? 8 : 6;
}

/// What buildings do not say: blocks, courtyards and streets in the box.
picture::PlanTile vicinity(const context::ContextExtract& context, const picture::PlanBox& box) {
  picture::PlanTile tile;
  for (const context::NetworkLine& line : context.lines)
    if (context::is_street(line.kind) && !line.tunnel && !line.area && meets(box, line.points))
      tile.streets.push_back({line.points, street_width(line.kind)});
  for (const context::Block& block : context.blocks)
    if (!block.too_large && meets(box, block.polygon.outer.points)) tile.blocks.push_back(block.polygon);
  for (const context::ExtractCourtyard& yard : context.courtyards)
    if (meets(box, yard.courtyard.polygon.outer.points)) tile.courtyards.push_back(yard.courtyard.polygon);
  return tile;
}

/// What is drawn within the box, packed: long streets and blocks reach far beyond it, and change there.
void pack_drawn(std::span<const picture::PlanTile> tiles, const picture::PlanBox& box, base::Packer& out) {
  const picture::PlanBox near = reached(box);
  // Where a ring begins, and the order of rings, may hang on what lies far away.
  std::vector<std::array<double, 5>> lines;
  const auto add_lines = [&](std::span<const model::Point2> points, bool closed, double width) {
    for (std::size_t i = 0; i + (closed ? 0 : 1) < points.size(); ++i) {
      const model::Point2 a = points[i], b = points[(i + 1) % points.size()];
      if (meets(near, std::array{a, b})) lines.push_back({a.x, a.y, b.x, b.y, width});
    }
  };
  const auto pack_lines = [&] {
    std::ranges::sort(lines);
    out << lines;
    lines.clear();
  };
  const auto add_rings = [&](const model::Polygon& polygon) {
    add_lines(polygon.outer.points, true, 0);
    for (const model::Ring& hole : polygon.holes) add_lines(hole.points, true, 0);
  };
  out << box;
  for (const picture::PlanTile& tile : tiles) {
    for (const auto* polygons : {&tile.buildings, &tile.courtyards}) {
      // What is filled follows from its sides here, and from one point that is within or not.
      std::uint64_t within = 0;
      for (const model::Polygon& polygon : *polygons)
        if (meets(near, polygon.outer.points)) {
          add_rings(polygon);
          within += geometry::contains(polygon, {near.min_x, near.min_y});
        }
      out << within;
      pack_lines();
    }
    for (const picture::PlanEdge& edge : tile.edges)
      if (meets(near, std::array{edge.from, edge.to})) out << edge;
    for (const model::Polygon& block : tile.blocks) add_rings(block);
    for (const picture::PlanStreet& street : tile.streets) add_lines(street.line, false, street.width);
    pack_lines();
  }
}

picture::Image sheet(std::span<const picture::PlanTile> tiles, const picture::PlanBox& box, int pixels) {
  picture::Plan plan(box, std::min(kFinest, picture::scale_for(box, pixels)), picture::kPlanPaper);
  picture::draw(plan, tiles);
  plan.draw_scale_bar();
  return plan.image();
}

}  // namespace

PlanChoice choose_plan(std::span<const footprints::Shard> shards, const georef::Projection& projection,
                       const PicturePlan& pictures) {
  PlanChoice choice;
  choice.middle = {pictures.origin.x, pictures.origin.y};
  // The plan may lie to one side of the middle, and a tile to one side of its own.
  constexpr double kFar = 2 * kPlanReach + kTileExtent;
  for (const footprints::Shard& shard : shards) {
    const georef::LonLat at = georef::centre(shard.tile);
    const model::Point2 p = projection.forward(at.lon, at.lat);
    choice.chosen.push_back(std::fabs(p.x - choice.middle.x) <= kFar && std::fabs(p.y - choice.middle.y) <= kFar);
    choice.whole = choice.whole && choice.chosen.back();
  }
  return choice;
}

PlanSheet draw_plan(std::vector<picture::PlanTile> tiles, const context::ContextExtract& context,
                    const PlanChoice& choice, const base::Memo* memo) {
  const picture::PlanBox all = picture::box_of(tiles);
  if (!(all.width() > 0 && all.height() > 0)) return {};
  const picture::PlanBox box = cropped(all, choice.middle);
  tiles.push_back(vicinity(context, reached(box)));
  auto out = base::remembered<PlanSheet>(
      memo, "plan", [&](base::Packer& packer) { pack_drawn(tiles, box, packer); },
      [&] {
        PlanSheet drawn;
        drawn.png = picture::png(sheet(tiles, box, kFilePixels));
        const picture::Image small = sheet(tiles, box, kReportPixels);
        drawn.in_report = {picture::png(small), small.width, small.height,
                           "From above, north up. Walls in the colours of what they face."};
        return drawn;
      });
  if (!choice.whole || box.width() < all.width() || box.height() < all.height())
    out.note =
        fmt::format("The plan shows {:.0f} by {:.0f} m of the build's densest part. All of it is in the GeoPackage.",
                    box.width(), box.height());
  return out;
}

}  // namespace blockrand::outputs
