#include "pipeline/outputs/plan/plan_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "pipeline/base/portable_math.h"
#include "pipeline/base/text.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/model/point.h"
#include "pipeline/picture/image.h"
#include "pipeline/picture/labels.h"
#include "pipeline/picture/lettering.h"
#include "pipeline/picture/palette.h"
#include "pipeline/picture/sheet.h"

namespace blockrand::outputs {

namespace {

constexpr int kFilePixels = 2600;    // a side of the file: at kPlanReach a wall is two pixels wide
constexpr int kReportPixels = 1300;  // a side of the picture in the report
constexpr double kTileExtent = 700;  // m: buildings of a tile of level 15 lie at most so far from its centre
constexpr double kFinest = 6;        // pixels per metre: more shows nothing more

constexpr model::Colour kSheetPaper{255, 255, 255}, kNameInk{45, 42, 60};
/// Names of streets: as high as fits between two rows of houses, within a share of the longer side of the map.
constexpr double kNameHeight = 13;       // m an em
constexpr int kPale = 220, kGrey = 200;  // brightness: buildings have 217
/// Of the map in the report, of which the sheet has four times the pixels, when colours are chosen.
constexpr std::uint32_t kSmallWeight = 4;
constexpr int kSheetLevel = 5;  // of deflate
constexpr double kLeastName = 0.0092, kLargestName = 0.0155;

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

/// Streets and squares with their names, so much of them as lies near the box, sorted. m.
std::vector<picture::NamedLine> named_streets(const context::ContextExtract& context, const picture::PlanBox& box) {
  const picture::PlanBox near = reached(box);
  const auto rank = [](context::LineClass kind) {
    if (kind <= context::LineClass::secondary) return 0;
    return kind == context::LineClass::tertiary ? 1 : 2;
  };
  std::vector<picture::NamedLine> out;
  for (const context::NetworkLine& line : context.lines) {
    if (!context::is_street(line.kind) || line.name.empty() || line.tunnel || !meets(near, line.points)) continue;
    if (line.area) {
      // A square's name stands level, in its middle.
      model::Polygon square;
      square.outer.points = line.points;
      picture::PlanBox of{1e300, 1e300, -1e300, -1e300};
      for (const model::Point2 p : line.points)
        of = {std::min(of.min_x, p.x), std::min(of.min_y, p.y), std::max(of.max_x, p.x), std::max(of.max_y, p.y)};
      const model::Point2 middle{(of.min_x + of.max_x) / 2, (of.min_y + of.max_y) / 2};
      if (of.min_x >= near.min_x && of.max_x <= near.max_x && geometry::contains(square, middle))
        out.push_back({line.name, 1, {{of.min_x, middle.y}, {of.max_x, middle.y}}});
      continue;
    }
    std::vector<model::Point2> part;
    const auto end = [&] {
      if (part.size() > 1) out.push_back({line.name, rank(line.kind), part});
      part.clear();
    };
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      if (!meets(near, std::span(line.points).subspan(i, 2))) {
        end();
        continue;
      }
      if (part.empty()) part.push_back(line.points[i]);
      part.push_back(line.points[i + 1]);
    }
    end();
  }
  const auto key = [](const picture::NamedLine& line) {
    std::vector<std::pair<double, double>> points;
    for (const model::Point2 p : line.points) points.emplace_back(p.x, p.y);
    return std::tuple(line.name, line.rank, points);
  };
  std::ranges::sort(out, {}, key);
  return out;
}

/// Takes out what would be a row of boxes. \returns how many names
std::size_t drop_unwritable(std::vector<picture::NamedLine>& sorted, const picture::Lettering& letters) {
  std::set<std::string_view> names;
  for (const picture::NamedLine& line : sorted)
    if (!letters.can_write(line.name)) names.insert(line.name);
  const std::size_t count = names.size();
  std::erase_if(sorted, [&](const picture::NamedLine& line) { return !letters.can_write(line.name); });
  return count;
}

/// Where names stand on a map. \param taken  where they may not
std::vector<picture::Label> placed_names(const picture::Plan& plan, std::span<const picture::NamedLine> streets,
                                         const picture::Lettering& letters,
                                         std::span<const std::array<model::Point2, 4>> taken) {
  const int width = plan.image().width, height = plan.image().height, side = std::max(width, height);
  picture::LabelOptions options;
  options.size = std::clamp(kNameHeight / plan.metres_per_pixel(), kLeastName * side, kLargestName * side);
  options.of_rank = {1.25, 1.1, 1};
  options.apart = 0.4 * side;
  options.margin = 0.3 * options.size;
  options.between = 0.2 * options.size;
  options.covers = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return 0.0;
    const std::uint8_t* const p = plan.image().pixel(x, y);
    // Paper, streets, courtyards and what lies between them are pale, buildings less so, walls strong: they are what the plan
    // is about.
    const int bright = (p[0] + p[1] + p[2]) / 3;
    return bright >= kPale ? 0.0 : bright >= kGrey ? 0.5 : 1.0;
  };
  std::vector<picture::NamedLine> lines(streets.begin(), streets.end());
  for (picture::NamedLine& line : lines)
    for (model::Point2& p : line.points) p = plan.pixel_of(p);
  return picture::place_labels(lines, width, height, options, letters, taken);
}

/// \param times  pixels of this picture for one of the map on which the names were placed
/// \param first  px: the topmost row of this picture, of a map that is larger by as much
void write_names(picture::Image& image, std::span<const picture::Label> names, const picture::Lettering& letters,
                 double times = 1, double first = 0) {
  for (picture::Label label : names) {
    label.middle = {label.middle.x * times, label.middle.y * times - first};
    label.size *= times;
    label.width *= times;
    const std::array<model::Point2, 4> box = label.corners();
    if (std::ranges::all_of(box, [&](model::Point2 p) { return p.y < -label.size; }) ||
        std::ranges::all_of(box, [&](model::Point2 p) { return p.y > image.height + label.size; }))
      continue;
    letters.write(
        image, label.start(), label.text,
        {.size = label.size, .colour = kNameInk, .halo = 0.13 * label.size, .halo_colour = picture::kPlanPaper},
        label.direction);
  }
}

/// A map that is drawn in bands of rows: all of it at once takes thirty megabytes.
class BandedMap {
 public:
  BandedMap(std::span<const picture::PlanTile> tiles, const picture::PlanBox& box, int pixels)
      : tiles_(tiles), box_(box), scale_(std::min(kFinest, picture::scale_for(box, pixels))) {}

  int width() const { return size(box_.width()); }    ///< px
  int height() const { return size(box_.height()); }  ///< px
  double metres_per_pixel() const { return 1 / scale_; }
  picture::Plan drawn(int first, int end) const {
    picture::Plan plan({box_.min_x, box_.max_y - end / scale_, box_.max_x, box_.max_y - first / scale_}, scale_,
                       picture::kPlanPaper);
    picture::draw(plan, tiles_);
    return plan;
  }
  picture::Plan whole() const { return drawn(0, height()); }

 private:
  int size(double metres) const { return static_cast<int>(std::ceil(metres * scale_ - 1e-6)); }
  std::span<const picture::PlanTile> tiles_;
  picture::PlanBox box_;
  double scale_;
};

/// The sheet with the map, and a smaller picture of the map, as PNG files of the same few colours.
/// \param small  has the map's names
/// \param times  pixels of the map for one of the small one
std::pair<std::string, std::string> png_files(const BandedMap& map, const picture::SheetText& text,
                                              const picture::Image& small, std::span<const picture::Label> names,
                                              double times, const picture::Lettering& letters) {
  constexpr int kBand = 200;  // px
  const picture::Sheet sheet(map.width(), map.height(), text);
  const auto bands = [&](int from, int to, const auto& use) {
    for (int first = from; first < to; first += kBand) {
      const int end = std::min(first + kBand, to);
      picture::Image rows = picture::blank(sheet.width(), end - first, kSheetPaper);
      const int top = std::max(first - sheet.map_top(), 0), bottom = std::min(end - sheet.map_top(), map.height());
      if (top < bottom) {
        picture::Plan part = map.drawn(top, bottom);
        write_names(part.image(), names, letters, times, top);
        picture::put(rows, part.image(), sheet.map_left(), top + sheet.map_top() - first);
      }
      sheet.draw(rows, first);
      use(rows);
    }
  };
  picture::Palette palette;
  const auto count = [&](const picture::Image& rows) { palette.count(rows); };
  palette.count(small, kSmallWeight);
  bands(0, sheet.map_top(), count);
  bands(sheet.map_top() + map.height(), sheet.height(), count);
  palette.choose(256);
  picture::PaletteImage large_image, small_image;
  large_image.palette = small_image.palette = palette.colours();
  large_image.pixels.reserve(static_cast<std::size_t>(sheet.width()) * static_cast<std::size_t>(sheet.height()));
  bands(0, sheet.height(), [&](const picture::Image& rows) { palette.append(rows, large_image.pixels); });
  palette.append(small, small_image.pixels);
  return {picture::png(sheet.width(), large_image, kSheetLevel), picture::png(small.width, small_image, kSheetLevel)};
}

/// Where the words of a scale bar stand.
std::array<model::Point2, 4> scale_bar_box(const picture::Plan& plan, double bar) {
  const double right = bar / plan.metres_per_pixel() + 24, top = plan.image().height - 44.0,
               bottom = plan.image().height;
  return {{{0, top}, {right, top}, {right, bottom}, {0, bottom}}};
}

}  // namespace

std::string about_words(std::uint64_t buildings, std::string_view data_time, const georef::Crs& crs) {
  const std::string_view date = data_time.substr(0, data_time.find('T'));
  std::string about =
      fmt::format("{} {}; ", base::with_thousands(buildings), buildings == 1 ? "building" : "buildings");
  about += date.empty() ? "date of the data unknown" : fmt::format("data of {}", date);
  about += "; " + crs.name;
  if (!crs.authority_code.empty()) about += " (" + crs.authority_code + ")";
  return about;
}

std::string north_words(const georef::Projection& projection, model::Point2 place) {
  constexpr double kStep = 0.01;  // degrees: a good kilometre
  const georef::LonLat at = projection.inverse(place);
  const model::Point2 from = model::snap(projection.forward(at.lon, at.lat)),
                      to = model::snap(projection.forward(at.lon, at.lat + kStep));
  const double right = base::atan2(to.x - from.x, to.y - from.y) * base::kDegreesPerRadian;
  const double tenths = std::floor(10 * std::fabs(right) + 0.5);
  if (!(tenths >= 1)) return "Grid north is up, true north as well";
  return fmt::format("Grid north is up; true north lies {:.1f}\u00b0 to the {}", tenths / 10,
                     right < 0 ? "left" : "right");
}

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
                    const PlanChoice& choice, const georef::Projection& projection, const PlanWords& words,
                    const base::Memo* memo) {
  const picture::PlanBox all = picture::box_of(tiles);
  if (!(all.width() > 0 && all.height() > 0)) return {};
  const picture::PlanBox box = cropped(all, choice.middle);
  tiles.push_back(vicinity(context, reached(box)));
  const bool part = !choice.whole || box.width() < all.width() || box.height() < all.height();
  picture::SheetText text{.title = words.title,
                          .below_title = {words.about},
                          .legend = {},
                          .metres_per_pixel = 0,
                          .north = north_words(projection, {(box.min_x + box.max_x) / 2, (box.min_y + box.max_y) / 2}),
                          .attribution = words.attribution,
                          .generator = words.generator};
  if (part)
    text.below_title.push_back(
        fmt::format("This sheet shows {:.0f} by {:.0f} m of it, where it is densest.", box.width(), box.height()));
  std::vector<picture::NamedLine> streets = named_streets(context, box);
  auto out = base::remembered<PlanSheet>(
      memo, "plan",
      [&](base::Packer& packer) {
        pack_drawn(tiles, box, packer);
        packer << streets << text.title << text.below_title << text.north << text.attribution << text.generator;
      },
      [&] {
        const picture::Lettering letters;
        PlanSheet drawn;
        if (const std::size_t names = drop_unwritable(streets, letters); names > 0)
          text.below_title.push_back(fmt::format(
              "{} left out: in letters that this program's font lacks.",
              names == 1 ? "The name of one street is" : fmt::format("The names of {} streets are", names)));
        const BandedMap small_map(tiles, box, kReportPixels), large_map(tiles, box, kFilePixels);
        picture::Plan small = small_map.whole();
        const std::array taken{scale_bar_box(small, small.draw_scale_bar()),
                               picture::sign(small.image(), words.attribution)};
        const std::vector<picture::Label> names = placed_names(small, streets, letters, taken);
        write_names(small.image(), names, letters);
        text.legend = picture::legend_of(tiles, box);
        text.metres_per_pixel = large_map.metres_per_pixel();
        auto [sheet, in_report] = png_files(large_map, text, small.image(), names,
                                            small_map.metres_per_pixel() / large_map.metres_per_pixel(), letters);
        drawn.png = std::move(sheet);
        drawn.in_report = {std::move(in_report), small.image().width, small.image().height,
                           "From above. " + text.north + ". Walls in the colours of what they face."};
        return drawn;
      });
  if (part)
    out.note =
        fmt::format("The plan shows {:.0f} by {:.0f} m of the build's densest part. All of it is in the GeoPackage.",
                    box.width(), box.height());
  return out;
}

}  // namespace blockrand::outputs
