#include "pipeline/outputs/report/report_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "pipeline/outputs/report/html_text.h"

namespace blockrand::outputs {
namespace {

/// Decimetres. On wider maps houses are less than a pixel; a hairline keeps them visible.
constexpr std::int64_t kFar = 60'000;

/// Class of a footprint in every theme, as one number.
struct Classes {
  std::array<std::uint8_t, kMapThemes> of{};
  std::uint64_t key() const {
    std::uint64_t all = 0;
    for (std::size_t t = kMapThemes; t-- > 0;) all = all << 8 | of[t];
    return all;
  }
  std::string text() const {
    std::string out;
    for (std::size_t t = 0; t < kMapThemes; ++t) {
      if (t > 0) out += ' ';
      out += kThemeLetter[t] + std::to_string(of[t]);
    }
    return out;
  }
};

struct Box {
  std::int64_t west = 0, south = 0, east = 0, north = 0;  ///< decimetres
  double area() const { return static_cast<double>(east - west) * static_cast<double>(north - south); }
};

/// Writes path data with relative coordinates: numbers stand apart by a space or by their sign.
class Pen {
 public:
  explicit Pen(std::string& out) : out_(out) {}
  /// Starts a ring; the first one of an element at an absolute place, the others relative to the ring before.
  void move(std::int64_t x, std::int64_t y) {
    out_ += first_ ? 'M' : 'm';
    apart_ = true;
    number(first_ ? x : x - start_x_);
    number(first_ ? y : y - start_y_);
    first_ = false;
    x_ = start_x_ = x;
    y_ = start_y_ = y;
  }
  /// What follows a move without a letter is a line; after the absolute first move the letter says "relative".
  void line(std::int64_t x, std::int64_t y) {
    if (letter_needed_) out_ += 'l', apart_ = true;
    letter_needed_ = false;
    number(x - x_);
    number(y - y_);
    x_ = x;
    y_ = y;
  }
  void close() { out_ += 'z'; }
  void begin_ring(std::int64_t x, std::int64_t y) {
    letter_needed_ = first_;
    move(x, y);
  }

 private:
  void number(std::int64_t v) {
    if (!apart_ && v >= 0) out_ += ' ';
    out_ += std::to_string(v);
    apart_ = false;
  }
  std::string& out_;
  std::int64_t x_ = 0, y_ = 0, start_x_ = 0, start_y_ = 0;
  bool first_ = true, apart_ = true, letter_needed_ = false;
};

/// Marks the points of `ring[from..to]` that the line between its ends misses by more than `tolerance` (Douglas-Peucker,
/// with a stack of its own: rings of thousands of points must not go deep).
void mark_needed(const std::vector<MapPoint>& ring, std::size_t from, std::size_t to, double tolerance,
                 std::vector<char>& keep) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{from, to}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    const MapPoint p = ring[a], q = ring[b % ring.size()];
    const double dx = q.x - p.x, dy = q.y - p.y, length = dx * dx + dy * dy;
    double worst = tolerance * tolerance;
    std::size_t at = 0;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double ex = ring[i].x - p.x, ey = ring[i].y - p.y;
      const double cross = dx * ey - dy * ex;
      const double distance = length > 0 ? cross * cross / length : ex * ex + ey * ey;
      if (distance > worst) {
        worst = distance;
        at = i;
      }
    }
    if (at == 0) continue;
    keep[at] = 1;
    open.emplace_back(a, at);
    open.emplace_back(at, b);
  }
}

class MapWriter {
 public:
  MapWriter(const MapFootprints& footprints, const std::vector<std::uint8_t>& issue) : footprints_(footprints) {
    boxes_.resize(footprints.buildings.size());
    classes_.resize(footprints.buildings.size());
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      const MapBuilding& building = footprints.buildings[b];
      const auto answer = [](std::uint8_t value) {
        return static_cast<std::uint8_t>(value == kNotClassified ? 0 : value + 1);
      };
      const auto source = [&](model::Source value) {
        return static_cast<std::uint8_t>(building.built ? 1 + static_cast<int>(value) : 0);
      };
      classes_[b].of = {answer(building.style),
                        answer(building.era),
                        static_cast<std::uint8_t>(storey_class(building)),
                        static_cast<std::uint8_t>(roof_class(building)),
                        source(building.storeys_source),
                        source(building.height_source),
                        source(building.roof_source),
                        issue[b]};
      for (std::uint32_t ring = building.first_ring; ring < building.first_ring + building.ring_count; ++ring)
        for (std::uint32_t c = footprints.ring_begin(ring); c < footprints.ring_ends[ring]; ++c) {
          const MapPoint p = footprints.corners[c];
          if (!boxes_[b]) boxes_[b] = Box{p.x, p.y, p.x, p.y};
          Box& box = *boxes_[b];
          box = {std::min<std::int64_t>(box.west, p.x), std::min<std::int64_t>(box.south, p.y),
                 std::max<std::int64_t>(box.east, p.x), std::max<std::int64_t>(box.north, p.y)};
        }
    }
  }

  /// False where nothing has a footprint.
  bool choose_frame(std::uint64_t& outside) {
    std::vector<std::int64_t> xs, ys;
    std::optional<Box> whole;
    for (const auto& box : boxes_) {
      if (!box) continue;
      xs.push_back((box->west + box->east) / 2);
      ys.push_back((box->south + box->north) / 2);
      if (!whole) whole = *box;
      whole = Box{std::min(whole->west, box->west), std::min(whole->south, box->south),
                  std::max(whole->east, box->east), std::max(whole->north, box->north)};
    }
    if (!whole) return false;
    frame_ = *whole;
    // A few stray buildings far away must not shrink the rest to a dot.
    constexpr std::size_t kFew = 200;  // one in so many on each side
    if (const std::size_t cut = xs.size() / kFew; cut > 0) {
      const auto nth = [](std::vector<std::int64_t>& v, std::size_t n) {
        std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(n), v.end());
        return v[n];
      };
      Box core{nth(xs, cut), nth(ys, cut), nth(xs, xs.size() - 1 - cut), nth(ys, ys.size() - 1 - cut)};
      const std::int64_t wider = (core.east - core.west) / 5, higher = (core.north - core.south) / 5;
      core = {core.west - wider, core.south - higher, core.east + wider, core.north + higher};
      if (whole->area() > 3 * core.area()) frame_ = core;
    }
    for (auto& box : boxes_) {
      if (!box) continue;
      const std::int64_t x = (box->west + box->east) / 2, y = (box->south + box->north) / 2;
      if (x >= frame_.west && x <= frame_.east && y >= frame_.south && y <= frame_.north) continue;
      box.reset();
      ++outside;
    }
    const std::int64_t margin =
        std::max<std::int64_t>(50, std::max(frame_.east - frame_.west, frame_.north - frame_.south) / 50);
    frame_ = {frame_.west - margin, frame_.south - margin, frame_.east + margin, frame_.north + margin};
    return true;
  }

  const Box& frame() const { return frame_; }
  const Classes& classes(std::size_t b) const { return classes_[b]; }
  bool drawn(std::size_t b) const { return boxes_[b].has_value(); }
  std::int64_t column(std::int64_t x, std::int64_t unit) const { return (x - frame_.west) / unit; }
  std::int64_t row(std::int64_t y, std::int64_t unit) const { return (frame_.north - y) / unit; }
  MapPoint middle(std::size_t b) const {
    return {static_cast<std::int32_t>((boxes_[b]->west + boxes_[b]->east) / 2),
            static_cast<std::int32_t>((boxes_[b]->south + boxes_[b]->north) / 2)};
  }

  /// Appends a building's rings in units of `unit` decimetres, without details smaller than `tolerance` decimetres.
  /// What would vanish becomes a square of one unit.
  void draw(std::size_t b, std::int64_t unit, double tolerance, Pen& pen) {
    const MapBuilding& building = footprints_.buildings[b];
    bool any = false;
    for (std::uint32_t ring = building.first_ring; ring < building.first_ring + building.ring_count; ++ring) {
      corners_.assign(footprints_.corners.begin() + footprints_.ring_begin(ring),
                      footprints_.corners.begin() + footprints_.ring_ends[ring]);
      simplify(unit, tolerance);
      if (corners_.size() < 3) continue;
      any = true;
      pen.begin_ring(corners_[0].x, corners_[0].y);
      for (std::size_t i = 1; i < corners_.size(); ++i) pen.line(corners_[i].x, corners_[i].y);
      pen.close();
    }
    if (any) return;
    const std::int64_t x = column(middle(b).x, unit), y = row(middle(b).y, unit);
    pen.begin_ring(x, y);
    pen.line(x + 1, y);
    pen.line(x + 1, y + 1);
    pen.line(x, y + 1);
    pen.close();
  }

 private:
  void simplify(std::int64_t unit, double tolerance) {
    if (tolerance > 0) {
      // Two corners stay in any case: the first, and the one furthest from it.
      std::size_t far = 0;
      double most = -1;
      for (std::size_t i = 1; i < corners_.size(); ++i) {
        const double dx = corners_[i].x - corners_[0].x, dy = corners_[i].y - corners_[0].y;
        if (dx * dx + dy * dy > most) most = dx * dx + dy * dy, far = i;
      }
      keep_.assign(corners_.size(), 0);
      keep_[0] = keep_[far] = 1;
      mark_needed(corners_, 0, far, tolerance, keep_);
      mark_needed(corners_, far, corners_.size(), tolerance, keep_);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < corners_.size(); ++i)
        if (keep_[i]) corners_[kept++] = corners_[i];
      corners_.resize(kept);
    }
    std::size_t kept = 0;
    for (const MapPoint& p : corners_) {
      const MapPoint q{static_cast<std::int32_t>(column(p.x, unit)), static_cast<std::int32_t>(row(p.y, unit))};
      if (kept == 0 || corners_[kept - 1] != q) corners_[kept++] = q;
    }
    while (kept > 1 && corners_[kept - 1] == corners_[0]) --kept;
    corners_.resize(kept);
  }

  const MapFootprints& footprints_;
  std::vector<std::optional<Box>> boxes_;
  std::vector<Classes> classes_;
  Box frame_;
  std::vector<MapPoint> corners_;
  std::vector<char> keep_;
};

std::string title_of(const MapFootprints& footprints, const MapBuilding& b) {
  std::string out = b.osm.text();
  if (b.name > 0) out += " \u201c" + footprints.names[b.name - 1] + "\u201d";
  if (!b.built) return out + ": not built";
  out += ": " + rounded(b.storeys, 0) + (b.storeys < 1.5f && b.storeys >= 0.5f ? " storey (" : " storeys (") +
         std::string(model::name(b.storeys_source)) + "), " + rounded(b.height, 1) + " m (" +
         std::string(model::name(b.height_source)) + "), roof " + std::string(model::name(b.roof)) + " (" +
         std::string(model::name(b.roof_source)) + ")";
  return out;
}

/// One element per building, with a title.
std::string single_paths(MapWriter& writer, const MapFootprints& footprints) {
  std::string out;
  for (std::size_t i = 0; i < footprints.buildings.size(); ++i) {
    if (!writer.drawn(i)) continue;
    const MapBuilding& b = footprints.buildings[i];
    out += "<path id=\"" + b.osm.text() + "\" class=\"" + writer.classes(i).text() + "\" d=\"";
    Pen pen(out);
    writer.draw(i, 1, 0, pen);
    out += "\"><title>" + base::escaped(title_of(footprints, b)) + "</title></path>\n";
  }
  return out;
}

using Groups = std::map<std::uint64_t, std::pair<Classes, std::string>>;

std::string text_of(const Groups& groups) {
  std::string out;
  for (const auto& [key, group] : groups)
    out += "<path class=\"" + group.first.text() + "\" d=\"" + group.second + "\"/>\n";
  return out;
}

/// One element per combination of classes. Empty where it would exceed the budget.
std::optional<std::string> grouped_paths(MapWriter& writer, std::size_t count, std::int64_t unit, double tolerance,
                                         std::size_t budget) {
  Groups groups;
  std::map<std::uint64_t, Pen> pens;
  std::size_t bytes = 0;
  for (std::size_t b = 0; b < count; ++b) {
    if (!writer.drawn(b)) continue;
    auto& group = groups[writer.classes(b).key()];
    group.first = writer.classes(b);
    const std::size_t before = group.second.size();
    const auto pen = pens.try_emplace(writer.classes(b).key(), group.second).first;
    writer.draw(b, unit, tolerance, pen->second);
    bytes += group.second.size() - before;
    if (bytes > budget) return std::nullopt;
  }
  return text_of(groups);
}

/// Buildings counted into square cells.
std::string cells(const MapWriter& writer, std::size_t count, std::int64_t unit, std::int64_t side) {
  struct Cell {
    std::array<std::map<std::uint8_t, std::uint32_t>, kMapThemes> counts;
    std::uint32_t all = 0;
  };
  std::map<std::pair<std::int64_t, std::int64_t>, Cell> grid;
  for (std::size_t b = 0; b < count; ++b) {
    if (!writer.drawn(b)) continue;
    const MapPoint p = writer.middle(b);
    Cell& cell = grid[{writer.row(p.y, unit) / side, writer.column(p.x, unit) / side}];
    ++cell.all;
    for (std::size_t t = 0; t < kMapThemes; ++t) ++cell.counts[t][writer.classes(b).of[t]];
  }
  Groups groups;
  std::map<std::uint64_t, Pen> pens;
  for (const auto& [place, cell] : grid) {
    Classes classes;
    for (std::size_t t = 0; t < kMapThemes; ++t) {
      std::uint32_t most = 0;
      for (const auto& [value, times] : cell.counts[t]) {
        const bool counts = t == static_cast<std::size_t>(MapTheme::issue) ? times * 10 >= cell.all : times > most;
        if (!counts) continue;
        most = times;
        classes.of[t] = value;  // of issues the worst that a tenth of the buildings have
      }
    }
    auto& group = groups[classes.key()];
    group.first = classes;
    Pen& pen = pens.try_emplace(classes.key(), group.second).first->second;
    const std::int64_t x = place.second * side, y = place.first * side;
    pen.begin_ring(x, y);
    pen.line(x + side, y);
    pen.line(x + side, y + side);
    pen.line(x, y + side);
    pen.close();
  }
  return text_of(groups);
}

std::string metres(std::int64_t decimetres) {
  return decimetres % 10 == 0 ? base::with_thousands(static_cast<std::uint64_t>(decimetres / 10)) + "\u00a0m"
                              : rounded(static_cast<double>(decimetres) / 10, 1) + "\u00a0m";
}

/// The longest of 1, 2, 5, 10 … m that is at most a fifth of the map's width; in metres.
std::int64_t scale_bar(std::int64_t width_decimetres) {
  std::int64_t best = 1;
  for (std::int64_t decade = 1; decade <= 10'000'000; decade *= 10)
    for (const std::int64_t step : {1, 2, 5})
      if (decade * step * 10 * 5 <= width_decimetres) best = decade * step;
  return best;
}

}  // namespace

int storey_class(const MapBuilding& b) {
  if (!b.built) return 0;
  const long storeys = std::lround(b.storeys);
  return storeys <= 1 ? 1 : storeys <= 6 ? static_cast<int>(storeys) : storeys <= 9 ? 7 : 8;
}

int roof_class(const MapBuilding& b) {
  if (!b.built) return 0;
  using enum model::RoofGroup;
  switch (model::traits(b.roof).group) {
    case flat:
      return 1;
    case gabled:
    case cross_gabled:
    case saltbox:
      return 2;
    case hipped:
    case pyramidal:
      return 3;
    case mansard:
      return 4;
    case shed:
    case folded:
      return 5;
    case round:
      return 6;
    case other:
      break;
  }
  return 7;
}

ReportMap report_map(const MapFootprints& footprints, const std::vector<std::uint8_t>& issue,
                     const std::vector<std::uint32_t>& marked, const std::vector<MapOutline>& outlines,
                     const MapBudget& budget) {
  ReportMap out;
  constexpr int kClasses[kMapThemes] = {kStyleClasses,  kEraClasses,    kStoreyClasses, kRoofClasses,
                                        kSourceClasses, kSourceClasses, kSourceClasses, kIssueClasses};
  for (std::size_t t = 0; t < kMapThemes; ++t) out.counts[t].assign(static_cast<std::size_t>(kClasses[t]), 0);
  MapWriter writer(footprints, issue);
  const std::size_t count = footprints.buildings.size();
  for (std::size_t b = 0; b < count; ++b)
    for (std::size_t t = 0; t < kMapThemes; ++t) ++out.counts[t][writer.classes(b).of[t]];
  for (std::size_t b = 0; b < count; ++b) out.without_area += !writer.drawn(b);
  out.places.resize(count);
  if (!writer.choose_frame(out.outside)) return out;
  out.drawn = true;
  const std::int64_t width = writer.frame().east - writer.frame().west,
                     height = writer.frame().north - writer.frame().south;

  std::int64_t unit = 1;
  std::string paths;
  if (count <= budget.single_footprints) paths = single_paths(writer, footprints);
  if (paths.empty() || paths.size() > budget.bytes) {
    // Ever coarser until it fits: rounding and tolerance in decimetres.
    constexpr std::int64_t kSteps[] = {1, 5, 10, 20, 40};
    std::optional<std::string> fits;
    for (const std::int64_t step : kSteps) {
      unit = step;
      fits = grouped_paths(writer, count, unit, unit == 1 ? 0.0 : static_cast<double>(unit), budget.bytes);
      if (fits) break;
    }
    if (fits) {
      paths = std::move(*fits);
      out.note = "Footprints are drawn in groups, without a link for each";
      if (unit > 1) out.note += "; details below " + metres(unit) + " are left out";
      out.note += '.';
    } else {
      // About 20 bytes a cell.
      const double most = std::max(1.0, static_cast<double>(budget.bytes) / 20);
      unit = 10;
      std::int64_t side = 50;
      while (static_cast<double>(width / unit / side + 1) * static_cast<double>(height / unit / side + 1) > most)
        side *= 2;
      paths = cells(writer, count, unit, side);
      out.note =
          "There are too many buildings to draw each: the map shows cells of " + metres(side * unit) +
          " in the colour of most of their buildings; of issues, the gravest that a tenth of the buildings have.";
    }
  }

  out.paths = std::move(paths);
  out.width = width / unit;
  out.height = height / unit;
  out.metres = width / 10;
  out.far = width > kFar;
  out.ratio = rounded(static_cast<double>(width) / static_cast<double>(height), 3);
  out.radius = std::max<std::int64_t>(1, std::max(width, height) / unit / 60);
  for (std::size_t b = 0; b < count; ++b) {
    if (!writer.drawn(b)) continue;
    const MapPoint p = writer.middle(b);
    out.places[b] = {static_cast<std::int32_t>(writer.column(p.x, unit)),
                     static_cast<std::int32_t>(writer.row(p.y, unit))};
  }
  std::copy_if(marked.begin(), marked.end(), std::back_inserter(out.marks),
               [&](std::uint32_t b) { return writer.drawn(b); });
  for (const MapOutline& outline : outlines) {
    std::string d;
    Pen pen(d);
    for (const std::vector<MapPoint>& ring : outline.rings) {
      if (ring.size() < 3) continue;
      pen.begin_ring(writer.column(ring[0].x, unit), writer.row(ring[0].y, unit));
      for (std::size_t i = 1; i < ring.size(); ++i)
        pen.line(writer.column(ring[i].x, unit), writer.row(ring[i].y, unit));
      pen.close();
    }
    if (!d.empty()) out.blocks.emplace_back(outline.number, std::move(d));
  }
  const std::int64_t bar = scale_bar(width);
  const std::uint64_t per_mille = static_cast<std::uint64_t>(bar) * 10'000 / static_cast<std::uint64_t>(width);
  out.bar_share = std::to_string(per_mille / 10) + "." + std::to_string(per_mille % 10);
  out.bar_length = metres(bar * 10);
  return out;
}

}  // namespace blockrand::outputs
