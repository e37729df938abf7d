#include "pipeline/context/block_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/segment_grid.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

namespace blockrand::context {

namespace {

using geometry::Segment;
using model::Point2;
using model::Polygon;

/// m. Cells of the indices of block borders and of walls.
constexpr double kIndexCell = 32;
constexpr double kStreetCell = 128;  ///< m. Cells of the index of streets
/// m. A wall this much behind a sample is met at once: outlines of squares run along walls.
constexpr double kOnTheWall = 0.1;
/// m². Less of a building in a block is drawing noise.
constexpr double kMinCommonArea = 0.5;

void append_segments(const Polygon& polygon, std::vector<Segment>& out) {
  const auto add = [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) out.push_back({ring.points[i], ring.points[(i + 1) % ring.size()]});
  };
  add(polygon.outer);
  for (const model::Ring& hole : polygon.holes) add(hole);
}

// ---- which building in which block ----------------------------------------------------------------------------------

/// Blocks by their boxes, and the segments of their borders.
class BlockIndex {
 public:
  explicit BlockIndex(std::span<const Block> blocks) {
    std::vector<geometry::PlanBox> boxes;
    for (const Block& block : blocks) {
      boxes.push_back(geometry::box_of(block.polygon.outer.points));
      append_segments(block.polygon, borders_);
    }
    boxes_ = geometry::BoxIndex(std::move(boxes));
    border_grid_.emplace(borders_, kIndexCell);
  }

  /// Whether the box of a border segment meets that of the polygon. Where none does, all its corners are in one block.
  bool meets_border(const Polygon& polygon) const {
    const geometry::PlanBox box = geometry::box_of(polygon.outer.points);
    std::vector<std::uint32_t> near;
    border_grid_->near(box.minimum, box.maximum, near);
    return std::any_of(near.begin(), near.end(), [&](std::uint32_t i) {
      const std::array<Point2, 2> ends{borders_[i].a, borders_[i].b};
      return geometry::box_of(ends).near(box, 0);
    });
  }

  /// Blocks whose box meets that of the polygon, ascending.
  std::vector<std::uint32_t> near(const Polygon& polygon) const {
    return boxes_.near(geometry::box_of(polygon.outer.points), 0);
  }

  const geometry::PlanBox& box(std::uint32_t block) const { return boxes_.box(block); }

 private:
  geometry::BoxIndex boxes_;
  std::vector<Segment> borders_;
  std::optional<geometry::SegmentGrid> border_grid_;
};

std::vector<Segment> street_segments(std::span<const NetworkLine> lines) {
  std::vector<Segment> out;
  for (const NetworkLine& line : lines)
    if (is_street(line.kind) && !line.area && bounds_blocks(line))
      for (std::size_t i = 1; i < line.points.size(); ++i) out.push_back({line.points[i - 1], line.points[i]});
  return out;
}

/// \param corners  of `building`: all, or one that speaks for all
double area_within(const Polygon& building, std::span<const Point2> corners, const Polygon& block) {
  const auto inside =
      std::count_if(corners.begin(), corners.end(), [&](Point2 p) { return geometry::contains(block, p); });
  if (inside == std::ssize(corners)) return geometry::area(building);
  if (inside == 0) return 0;
  const double common = geometry::common_area(std::span(&building, 1), std::span(&block, 1));
  return common >= kMinCommonArea ? common : 0;
}

struct BlockShare {
  std::uint32_t block = 0;
  double area = 0;
};

/// Area of the building in each block. Every block is asked for itself, so that no answer depends on the other blocks.
std::vector<BlockShare> shares_of(const Polygon& building, std::span<const Block> blocks, const BlockIndex& index) {
  std::vector<BlockShare> out;
  // Far from all borders one corner speaks for all.
  const std::span<const Point2> corners(building.outer.points.data(),
                                        index.meets_border(building) ? building.outer.size() : 1);
  for (const std::uint32_t b : index.near(building)) {
    const Polygon& block = blocks[b].polygon;
    if (const double area = area_within(building, corners, block); area > 0) out.push_back({b, area});
  }
  return out;
}

/// What blocks hold of the buildings.
struct Contents {
  std::vector<std::vector<std::uint32_t>> standing;  ///< per block: footprints with more than half of their area in it
  std::vector<BlockFigures> figures;                 ///< areas and the buildings that belong to each
};

/// Footprints in the order of ids, of one id in the order of their least corners: sums do not depend on the order given.
std::vector<std::uint32_t> ordered(std::span<const Footprint> footprints) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < footprints.size(); ++i)
    if (footprints[i].polygon.outer.size() >= 3) out.push_back(i);
  const auto least = [&](std::uint32_t i) {
    const std::vector<Point2>& points = footprints[i].polygon.outer.points;
    return *std::min_element(points.begin(), points.end());
  };
  std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (footprints[a].id != footprints[b].id) return footprints[a].id < footprints[b].id;
    return least(a) < least(b);
  });
  return out;
}

void count(const BlockShare& share, const Footprint& footprint, BlockFigures& figures) {
  figures.built_area += share.area;
  if (!footprint.storeys) return;
  figures.tagged_area += share.area;
  figures.floor_area += share.area * *footprint.storeys;
}

Contents contents_of(std::span<const Footprint> footprints, std::span<const Block> blocks, const BlockIndex& index) {
  Contents out{std::vector<std::vector<std::uint32_t>>(blocks.size()), std::vector<BlockFigures>(blocks.size())};
  const std::vector<std::uint32_t> order = ordered(footprints);
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    double whole = 0;
    std::map<std::uint32_t, double> held;  // by block
    for (last = first; last < order.size() && footprints[order[last]].id == footprints[order[first]].id; ++last) {
      const Footprint& footprint = footprints[order[last]];
      const double area = geometry::area(footprint.polygon);
      whole += area;
      for (const BlockShare& share : shares_of(footprint.polygon, blocks, index)) {
        held[share.block] += share.area;
        count(share, footprint, out.figures[share.block]);
        if (2 * share.area > area) out.standing[share.block].push_back(order[last]);
      }
    }
    for (const auto& [block, area] : held)
      if (2 * area > whole)
        for (std::size_t i = first; i < last; ++i) out.figures[block].buildings.push_back(order[i]);
  }
  return out;
}

// ---- closure of the perimeter ---------------------------------------------------------------------------------------

struct Sample {
  double along = 0;                                        ///< m from the beginning of the side
  double weight = 0;                                       ///< m of the perimeter that it stands for
  double depth = std::numeric_limits<double>::infinity();  ///< m to the first wall
  bool at_street = true;                                   ///< else at a bank, a railway
};

struct Side {
  std::vector<Sample> samples;
  double length = 0;
  double building_line = -1;  ///< m from the centre line; -1 where no ray met a wall
  Point2 first, last;         ///< unit directions of its first and last edge
};

/// Distance from `p` along the unit vector `d` to the first wall within `reach`, or infinity.
double depth_at(Point2 p, Point2 d, double reach, std::span<const Segment> walls, const geometry::SegmentGrid& grid,
                std::vector<std::uint32_t>& near) {
  const Point2 o{p.x - d.x * kOnTheWall, p.y - d.y * kOnTheWall}, q{p.x + d.x * reach, p.y + d.y * reach};
  grid.near({std::min(o.x, q.x), std::min(o.y, q.y)}, {std::max(o.x, q.x), std::max(o.y, q.y)}, near);
  double best = std::numeric_limits<double>::infinity();
  for (const std::uint32_t w : near) {
    const Point2 a = walls[w].a, b = walls[w].b;
    // Sides of the wall's ends with respect to the ray, and where it crosses.
    const double sa = d.x * (a.y - p.y) - d.y * (a.x - p.x), sb = d.x * (b.y - p.y) - d.y * (b.x - p.x);
    if ((sa > 0) == (sb > 0)) continue;
    const double u = sa / (sa - sb);
    const double t = d.x * (a.x + u * (b.x - a.x) - p.x) + d.y * (a.y + u * (b.y - a.y) - p.y);
    if (t >= -kOnTheWall && t <= reach) best = std::min(best, std::max(0.0, t));
  }
  return best;
}

/// Where rays of a side meet walls: the lower quartile by length, of the rays from streets, where there are any.
double building_line_of(const Side& side) {
  const bool has_street =
      std::any_of(side.samples.begin(), side.samples.end(), [](const Sample& s) { return s.at_street; });
  std::vector<std::pair<double, double>> hits;
  double sum = 0;
  for (const Sample& s : side.samples)
    if (std::isfinite(s.depth) && s.at_street == has_street) {
      hits.emplace_back(s.depth, s.weight);
      sum += s.weight;
    }
  if (hits.empty()) return -1;
  std::sort(hits.begin(), hits.end());
  double passed = 0;
  for (const auto& [depth, weight] : hits) {
    passed += weight;
    if (passed >= sum / 4) return depth;
  }
  return hits.back().first;
}

/// m that the corner between two sides cuts off the first, whose building lines lie `own` and `other` inside.
double corner_cut(Point2 in, Point2 out, double own, double other) {
  // `in` and `out` are the directions of the perimeter before and after the corner. For the turn phi between them the
  // lines inside meet (other - own cos phi) / sin phi before the corner (at right angles: `other` before it).
  const double cosine = in.x * out.x + in.y * out.y, sine = in.x * out.y - in.y * out.x;
  constexpr double kFlat = 0.1;  // nearly parallel, or turning right: the sides do not hide each other
  if (sine < kFlat) return 0;
  return std::max(0.0, (other - own * cosine) / sine);
}

std::vector<Side> sides_of(const Block& block, std::span<const Segment> walls, const FrontOptions& options) {
  const std::vector<Point2>& ring = block.polygon.outer.points;
  const std::size_t n = ring.size();
  std::vector<Point2> directions(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % n];
    const double length = distance(a, b);
    directions[i] = {(b.x - a.x) / length, (b.y - a.y) / length};
  }
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 before = directions[(i + n - 1) % n], after = directions[i];
    if (before.x * after.x + before.y * after.y < options.corner_cosine) corners.push_back(i);
  }
  if (corners.empty()) corners.push_back(0);

  const geometry::SegmentGrid grid(walls, kIndexCell);
  std::vector<std::uint32_t> near;
  std::vector<Side> sides;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t first = corners[c], next = corners[(c + 1) % corners.size()];
    const std::size_t count = next > first ? next - first : next + n - first;
    Side side;
    side.first = directions[first];
    side.last = directions[(first + count - 1) % n];
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = (first + k) % n;
      const Point2 a = ring[i], d = directions[i], inwards{-d.y, d.x};
      const double length = distance(a, ring[(i + 1) % n]);
      const int pieces = std::max(1, static_cast<int>(std::lround(length / options.sample_step)));
      for (int s = 0; s < pieces; ++s) {
        const double t = length * (s + 0.5) / pieces;
        side.samples.push_back({side.length + t, length / pieces,
                                depth_at({a.x + d.x * t, a.y + d.y * t}, inwards, options.max_depth, walls, grid, near),
                                block.along_street[i]});
      }
      side.length += length;
    }
    side.building_line = building_line_of(side);
    sides.push_back(std::move(side));
  }
  return sides;
}

void measure_front(const Block& block, std::span<const Segment> walls, const FrontOptions& options,
                   BlockFigures& figures) {
  const std::vector<Side> sides = sides_of(block, walls, options);
  const auto line_of = [&](const Side& s) { return s.building_line >= 0 ? s.building_line : options.half_street; };
  double built = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side &side = sides[i], &before = sides[(i + sides.size() - 1) % sides.size()],
               &after = sides[(i + 1) % sides.size()];
    double from = 0, to = side.length;
    if (sides.size() > 1) {
      from = corner_cut(before.last, side.first, line_of(side), line_of(before));
      to -= corner_cut(side.last, after.first, line_of(side), line_of(after));
    }
    for (const Sample& s : side.samples) {
      if (!s.at_street || s.along < from || s.along > to) continue;
      figures.front_length += s.weight;
      if (side.building_line >= 0 && s.depth <= side.building_line + options.front_tolerance) built += s.weight;
    }
  }
  if (figures.front_length > 0) figures.closure = built / figures.front_length;
}

}  // namespace

double area_within(const Polygon& building, const Polygon& block) {
  return area_within(building, building.outer.points, block);
}

std::vector<BlockFigures> measure_blocks(std::span<const Block> blocks, std::span<const Footprint> footprints,
                                         std::span<const NetworkLine> lines, const FrontOptions& front,
                                         const CourtyardOptions& courtyard_options) {
  const BlockIndex index(blocks);
  Contents contents = contents_of(footprints, blocks, index);
  std::vector<BlockFigures>& out = contents.figures;
  const std::vector<Segment> streets = street_segments(lines);
  const geometry::SegmentGrid street_grid(streets, kStreetCell);
  std::vector<std::uint32_t> near;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    BlockFigures& figures = out[b];
    const geometry::PlanBox& box = index.box(static_cast<std::uint32_t>(b));
    street_grid.near(box.minimum, box.maximum, near);
    std::vector<Polyline> streets_here;
    for (const std::uint32_t s : near) streets_here.push_back({streets[s].a, streets[s].b});
    std::vector<Footprint> members;
    std::vector<Segment> walls;
    for (const std::uint32_t i : contents.standing[b]) {
      members.push_back(footprints[i]);
      append_segments(footprints[i].polygon, walls);
    }
    figures.courtyards = find_courtyards(members, streets_here, courtyard_options);
    for (Courtyard& yard : figures.courtyards) {
      for (std::uint32_t& i : yard.buildings) i = contents.standing[b][i];
      figures.courtyard_area += yard.area;
    }
    if (!blocks[b].gives_ratios()) continue;
    figures.built_share = figures.built_area / blocks[b].area;
    if (figures.built_area > 0) figures.tagged_share = figures.tagged_area / figures.built_area;
    if (figures.tagged_area > 0)
      figures.floor_area_ratio = *figures.built_share * figures.floor_area / figures.tagged_area;
    measure_front(blocks[b], walls, front, figures);
  }
  return std::move(contents.figures);
}

}  // namespace blockrand::context
