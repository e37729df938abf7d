#include "pipeline/context/blocks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/planar_faces.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {

namespace {

using geometry::Face;
using model::Point2;

struct Box {
  Point2 low, high;
  bool contains(Point2 p) const { return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y; }
};

Box box_of(std::span<const Point2> points) {
  Box box{points[0], points[0]};
  for (const Point2 p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

/// A water or a square with all its rings.
struct Area {
  std::uint32_t line = 0;
  std::vector<std::span<const Point2>> rings;
  Box box;  ///< of all rings
  bool contains(Point2 p) const {
    if (!box.contains(p)) return false;
    bool inside = false;
    for (const auto ring : rings)
      if (geometry::contains(ring, p)) inside = !inside;
    return inside;
  }
};

std::vector<Area> areas_of(std::span<const NetworkLine> lines, const std::map<std::uint64_t, std::uint32_t>& line_of) {
  std::map<std::uint32_t, Area> areas;
  for (const NetworkLine& line : lines) {
    if (!line.area || !bounds_blocks(line)) continue;
    const std::uint32_t first = line_of.at(line.id.key());
    const std::span<const Point2> ring(line.points.data(), line.points.size() - 1);
    const Box box = box_of(ring);
    const auto [place, added] = areas.try_emplace(first, Area{first, {}, box});
    Area& area = place->second;
    area.rings.push_back(ring);
    area.box = {{std::min(area.box.low.x, box.low.x), std::min(area.box.low.y, box.low.y)},
                {std::max(area.box.high.x, box.high.x), std::max(area.box.high.y, box.high.y)}};
  }
  std::vector<Area> out;
  for (auto& [first, area] : areas) out.push_back(std::move(area));
  return out;
}

/// Ends of main streets and railways at which nothing goes on: not even a tunnel, a service way or a path.
std::vector<Point2> loose_ends(std::span<const NetworkLine> lines) {
  std::map<std::int64_t, int> visits;
  for (const NetworkLine& line : lines)
    for (const std::int64_t node : line.nodes) ++visits[node];
  std::vector<Point2> out;
  for (const NetworkLine& line : lines) {
    // Minor streets end in turning places and railways in stations; a main street ends where the data does.
    if (line.area || line.points.empty() || line.nodes.empty() || line.kind > LineClass::secondary) continue;
    if (line.nodes.front() != 0 && visits[line.nodes.front()] == 1) out.push_back(line.points.front());
    if (line.nodes.back() != 0 && visits[line.nodes.back()] == 1) out.push_back(line.points.back());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::string id_of(const Face& face, std::span<const NetworkLine> lines,
                  const std::map<std::uint64_t, std::uint32_t>& line_of) {
  struct Candidate {
    model::OsmId line;
    bool nameless;  ///< a corner without a node: taken only where there is no other
    std::int64_t node;
    bool left;
    auto rank() const { return std::tuple(nameless, line, node, !left); }
  };
  std::optional<Candidate> best;
  for (std::size_t i = 0; i < face.polygon.outer.size(); ++i) {
    if (face.edges[i].line == geometry::kNoLine) continue;
    const std::int64_t node = face.polygon.outer.nodes[i];
    const Candidate c{lines[line_of.at(face.edges[i].line)].id, node == 0, node, face.edges[i].left};
    if (!best || c.rank() < best->rank()) best = c;
  }
  if (!best) return {};
  std::string place;
  if (best->nameless) {
    const geometry::Grid2 corner = geometry::to_grid(face.polygon.outer.points[0]);
    place = "p" + std::to_string(corner.x) + "_" + std::to_string(corner.y);
  } else {
    place = "n" + std::to_string(best->node);
  }
  return best->line.text() + "." + place + (best->left ? ".l" : ".r");
}

/// A street may leave one node several times, with a block on its left each time: all but the first get a number.
void number_equal_ids(std::vector<Block>& blocks) {
  std::map<std::string, int> seen;
  for (Block& block : blocks)
    if (const int n = ++seen[block.id]; n > 1) block.id += "." + std::to_string(n);
}

/// How much of the perimeter (0 to 1) the street with the longest share holds, counting carriageways only; and
/// railways.
struct Shares {
  double one_street = 0, roundabout = 0, railway = 0, coast_to_sea = 0;
};

Shares shares_of(const Face& face, std::span<const NetworkLine> lines,
                 const std::map<std::uint64_t, std::uint32_t>& line_of, double around) {
  std::map<std::pair<std::string_view, LineClass>, double> streets;
  Shares shares;
  for (const geometry::BorderLine& border : face.lines) {
    const auto found = line_of.find(border.id);
    if (found == line_of.end()) continue;
    const NetworkLine& line = lines[found->second];
    const double length = border.left + border.right;
    if (line.kind == LineClass::railway) shares.railway += length;
    if (line.roundabout) shares.roundabout += length / around;
    // The land lies on the left of a coastline.
    if (line.kind == LineClass::coastline) shares.coast_to_sea += border.right;
    if (!is_street(line.kind) || !line.oneway || line.area) continue;
    // A street keeps its name where its class changes; without a name the class must do.
    streets[{line.name, line.name.empty() ? line.kind : LineClass::other}] += length;
  }
  for (const auto& [street, length] : streets) shares.one_street = std::max(shares.one_street, length / around);
  shares.railway /= around;
  return shares;
}

/// Whether all points lie inside the hull or within `margin` metres of the lines through its edges.
bool inside_convex(std::span<const Point2> hull, std::span<const Point2> points, double margin) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point2 a = hull[i], b = hull[(i + 1) % hull.size()];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    for (const Point2 p : points)
      if (dx * (p.y - a.y) - dy * (p.x - a.x) < -margin * length) return false;
  }
  return true;
}

}  // namespace

std::vector<Point2> coverage_of(std::span<const Point2> points) {
  std::vector<geometry::Grid2> sorted;
  for (const Point2 p : points) sorted.push_back(geometry::to_grid(p));
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  if (sorted.size() < 3) return {};
  // Andrew's monotone chain (1979), exact.
  std::vector<geometry::Grid2> hull;
  const auto chain = [&](auto first, auto last) {
    const std::size_t base = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= base + 2 && geometry::orientation(hull[hull.size() - 2], hull.back(), *first) <= 0)
        hull.pop_back();
      hull.push_back(*first);
    }
    hull.pop_back();
  };
  chain(sorted.begin(), sorted.end());
  chain(sorted.rbegin(), sorted.rend());
  std::vector<Point2> out;
  if (hull.size() < 3) return out;
  for (const geometry::Grid2 g : hull)
    out.push_back(
        {static_cast<double>(g.x) / model::kGridStepsPerMetre, static_cast<double>(g.y) / model::kGridStepsPerMetre});
  return out;
}

std::vector<Block> find_blocks(std::span<const NetworkLine> lines, std::span<const Point2> coverage,
                               const BlockOptions& options) {
  std::map<std::uint64_t, std::uint32_t> line_of;  ///< first line with that OSM id
  std::vector<geometry::DividingLine> dividing;
  for (std::uint32_t i = 0; i < lines.size(); ++i) {
    line_of.emplace(lines[i].id.key(), i);
    if (bounds_blocks(lines[i])) dividing.push_back({lines[i].id.key(), lines[i].points, lines[i].nodes});
  }
  const std::vector<Area> areas = areas_of(lines, line_of);
  const std::vector<Point2> ends = loose_ends(lines);

  std::vector<Block> blocks;
  for (Face& face : geometry::faces_of_lines(dividing)) {
    Block block;
    block.id = id_of(face, lines, line_of);
    block.area = geometry::area(face.polygon);
    const double around = geometry::perimeter(face.polygon);
    const double width = 2 * block.area / around;
    const Shares shares = shares_of(face, lines, line_of, around);

    const Point2 inside = geometry::inner_point(face.polygon);
    bool water = shares.coast_to_sea > 0, square = false;
    for (const Area& a : areas)
      if (a.contains(inside)) (lines[a.line].kind == LineClass::shore ? water : square) = true;
    if (water)
      block.kind = BlockKind::water;
    else if (square || width < options.min_width)
      block.kind = BlockKind::street_space;
    else if (width <= options.max_roundabout_radius && shares.roundabout >= options.min_same_street)
      block.kind = BlockKind::between_carriageways;
    else if (width <= options.max_strip_width && shares.one_street >= options.min_same_street)
      block.kind = BlockKind::between_carriageways;
    else if (width <= options.max_strip_width && shares.railway >= options.min_same_street)
      block.kind = BlockKind::between_tracks;

    const Box box = box_of(face.polygon.outer.points);
    block.too_large = std::max(box.high.x - box.low.x, box.high.y - box.low.y) > options.max_extent;
    block.cut_by_extract_edge =
        !coverage.empty() && !inside_convex(coverage, face.polygon.outer.points, options.coverage_margin);
    for (auto end = std::lower_bound(ends.begin(), ends.end(), Point2{box.low.x, box.low.y});
         !block.cut_by_extract_edge && end != ends.end() && end->x <= box.high.x; ++end)
      block.cut_by_extract_edge = box.contains(*end) && geometry::contains(face.polygon, *end);

    for (std::size_t i = 0; i < face.polygon.outer.size(); ++i) {
      const auto found = line_of.find(face.edges[i].line);
      block.along_street.push_back(found != line_of.end() && is_street(lines[found->second].kind));
    }
    for (const geometry::BorderLine& border : face.lines)
      if (const auto found = line_of.find(border.id); found != line_of.end())
        block.borders.push_back({found->second, border.left + border.right});
    std::sort(block.borders.begin(), block.borders.end(),
              [&](const BlockBorder& a, const BlockBorder& b) { return lines[a.line].id < lines[b.line].id; });
    block.polygon = std::move(face.polygon);
    blocks.push_back(std::move(block));
  }
  number_equal_ids(blocks);
  return blocks;
}

}  // namespace blockrand::context
