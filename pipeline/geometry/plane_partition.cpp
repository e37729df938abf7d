#include "pipeline/geometry/plane_partition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/planar_faces.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::geometry {
namespace {

using model::Point2;

/// Ids of lines: those of the terrain come first, so that FaceEdge::line tells them.
constexpr std::uint64_t kTerrainLine = 0, kAreaLine = 1;

constexpr double kStep = 1.0 / model::kGridStepsPerMetre;

Point2 metres(Grid2 g) { return {static_cast<double>(g.x) * kStep, static_cast<double>(g.y) * kStep}; }

/// n / d to the nearest integer, halves upwards; d > 0.
std::int64_t rounded_quotient(Int128 n, Int128 d) {
  const Int128 twice = 2 * n + d, whole = 2 * d;
  const Int128 q = twice / whole;
  return static_cast<std::int64_t>(q * whole > twice ? q - 1 : q);
}

struct GridBox {
  Grid2 low, high;
  bool holds(Grid2 p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
};

/// The parts of a segment within a box, added as lines. Where it crosses a side follows from the segment and that side alone, so
/// that boxes on both sides find the same point.
void add_clipped(Grid2 a, Grid2 b, const GridBox& box, std::vector<DividingLine>& out) {
  if (b < a) std::swap(a, b);
  if (a == b || std::max(a.x, b.x) < box.low.x || std::min(a.x, b.x) > box.high.x || std::max(a.y, b.y) < box.low.y ||
      std::min(a.y, b.y) > box.high.y)
    return;
  std::array<Grid2, 6> points{a, b};
  std::size_t n = 2;
  const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
  for (const std::int64_t x : {box.low.x, box.high.x})
    if (a.x < x && x < b.x) points[n++] = {x, a.y + rounded_quotient(static_cast<Int128>(dy) * (x - a.x), dx)};
  for (const std::int64_t y : {box.low.y, box.high.y})
    if (std::min(a.y, b.y) < y && y < std::max(a.y, b.y)) {
      const Int128 along = static_cast<Int128>(dx) * (y - a.y);
      points[n++] = {a.x + (dy > 0 ? rounded_quotient(along, dy) : rounded_quotient(-along, -dy)), y};
    }
  const auto place = [&](Grid2 p) {
    return static_cast<Int128>(dx) * (p.x - a.x) + static_cast<Int128>(dy) * (p.y - a.y);
  };
  std::sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(n), [&](Grid2 p, Grid2 q) {
    const Int128 at = place(p), other = place(q);
    return at != other ? at < other : p < q;
  });
  for (std::size_t i = 1; i < n; ++i) {
    const Grid2 p = points[i - 1], q = points[i];
    if (p != q && box.holds(p) && box.holds(q)) out.push_back({kAreaLine, {metres(p), metres(q)}, {}});
  }
}

/// A claim as the square sees it.
struct Seen {
  std::uint32_t label = 0;
  bool crosses = false;                     ///< an edge of it comes into the square
  bool covers = false;                      ///< where none does: the square lies inside
  bool right_of_lines = false;              ///< AreaClaim::right_of_lines; edges have their direction then
  std::vector<std::array<Grid2, 2>> edges;  ///< that a ray along a latitude of the square may meet
};

/// Squared distance of a place from a segment, in steps, and where the nearest point lies: -1 at its start, 1 at its end, else 0.
std::pair<double, int> distance_to(Grid2 a, Grid2 b, Grid2 p) {
  const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
  const double px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
  const double along = px * dx + py * dy, square = dx * dx + dy * dy;
  if (along <= 0) return {px * px + py * py, -1};
  if (along >= square) return {(px - dx) * (px - dx) + (py - dy) * (py - dy), 1};
  const double across = px * dy - py * dx;
  return {across * across / square, 0};
}

/// Right of the nearest of directed segments.
bool is_right(std::span<const std::array<Grid2, 2>> segments, Grid2 p) {
  constexpr double kReach = kCoastReach * model::kGridStepsPerMetre;
  double least = kReach * kReach;
  const std::array<Grid2, 2>* nearest = nullptr;
  int end = 0;
  for (const auto& segment : segments) {
    const auto [square, place] = distance_to(segment[0], segment[1], p);
    if (square < least) least = square, nearest = &segment, end = place;
  }
  if (nearest == nullptr) return false;
  const bool right = orientation((*nearest)[0], (*nearest)[1], p) < 0;
  if (end == 0) return right;
  // Nearest is a point where the line bends: the segment on its other side has a word, too.
  for (const auto& segment : segments) {
    if (end < 0 ? segment[1] != (*nearest)[0] : segment[0] != (*nearest)[1]) continue;
    const auto& before = end < 0 ? segment : *nearest;
    const auto& after = end < 0 ? *nearest : segment;
    const bool left_of_both = orientation(before[0], before[1], p) >= 0 && orientation(after[0], after[1], p) >= 0;
    const bool left_of_one = orientation(before[0], before[1], p) >= 0 || orientation(after[0], after[1], p) >= 0;
    return !(orientation(before[0], before[1], after[1]) >= 0 ? left_of_both : left_of_one);
  }
  return right;
}

bool is_inside(const Seen& claim, Grid2 p) {
  if (claim.right_of_lines) return is_right(claim.edges, p);
  bool inside = false;
  for (const auto& [a, b] : claim.edges) {  // a.y < b.y
    if (p.y < a.y || p.y >= b.y) continue;
    if (orientation(a, b, p) > 0) inside = !inside;  // the edge lies to the right
  }
  return inside;
}

class Partition {
 public:
  Partition(const PlanBox& square, std::span<const AreaClaim> claims, std::span<const DividingLine> lines)
      : square_(square), box_{to_grid(square.minimum), to_grid(square.maximum)} {
    for (const DividingLine& line : lines) lines_.push_back({kTerrainLine, line.points, {}});
    for (const AreaClaim& claim : claims) see(claim);
    const Point2 a = square.minimum, b = square.maximum;
    lines_.push_back({kAreaLine, {a, {b.x, a.y}, b, {a.x, b.y}, a}, {}});
  }

  std::vector<PartitionPiece> pieces() {
    label_faces();
    std::vector<DividingLine> kept;
    for (const Side& side : sides_) {
      const Side* other = find(side.b, side.a);
      if (other != nullptr && other->label == side.label && !side.terrain) continue;
      if (other != nullptr && side.b < side.a) continue;  // its other side adds it
      kept.push_back({kAreaLine, {metres(side.a), metres(side.b)}, {}});
      ends_.push_back(side.a), ends_.push_back(side.b);
    }
    std::ranges::sort(ends_);
    std::vector<PartitionPiece> out;
    for (Face& face : faces_of_lines(kept)) out.push_back(piece(std::move(face)));
    return out;
  }

 private:
  /// One side of an edge: the face on its left.
  struct Side {
    Grid2 a, b;
    std::uint32_t label = kNoLabel;
    bool terrain = false;
  };

  void see(const AreaClaim& claim) {
    if (hidden_ || !claim.box.near(square_, claim.right_of_lines ? kCoastReach : 1)) return;
    Seen seen;
    seen.label = claim.label;
    const std::size_t before = lines_.size();
    if (claim.right_of_lines) {
      seen.right_of_lines = true;
      for (const std::vector<Point2>& line : claim.rings)
        for (std::size_t i = 1; i < line.size(); ++i) {
          const Grid2 a = to_grid(line[i - 1]), b = to_grid(line[i]);
          if (a == b) continue;
          add_clipped(a, b, box_, lines_);
          seen.edges.push_back({a, b});
        }
      seen.crosses = lines_.size() > before;
      seen.covers = !seen.crosses && is_inside(seen, {(box_.low.x + box_.high.x) / 2, (box_.low.y + box_.high.y) / 2});
      if (!seen.crosses && !seen.covers) return;
      hidden_ = hidden_ || seen.covers;
      claims_.push_back(std::move(seen));
      return;
    }
    for (const std::vector<Point2>& ring : claim.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        Grid2 a = to_grid(ring[i]), b = to_grid(ring[(i + 1) % ring.size()]);
        add_clipped(a, b, box_, lines_);
        if (b.y < a.y) std::swap(a, b);
        // A little beyond: what lies behind the border is asked for as well.
        if (a.y == b.y || b.y < box_.low.y - 2 || a.y > box_.high.y + 2 || std::max(a.x, b.x) < box_.low.x - 2)
          continue;
        seen.edges.push_back({a, b});
      }
    seen.crosses = lines_.size() > before;
    if (!seen.crosses) {
      seen.covers = is_inside(seen, {(box_.low.x + box_.high.x) / 2, (box_.low.y + box_.high.y) / 2});
      if (!seen.covers) return;
    }
    claims_.push_back(std::move(seen));
    hidden_ = hidden_ || claims_.back().covers;
  }

  std::uint32_t label_at(Grid2 p) const {
    for (const Seen& claim : claims_)
      if (claim.crosses ? is_inside(claim, p) : claim.covers) return claim.label;
    return kNoLabel;
  }

  void label_faces() {
    const std::vector<Face> faces = faces_of_lines(lines_);
    struct Sliver {
      double area = 0;
      std::size_t first = 0, count = 0;  ///< sides
    };
    std::vector<Sliver> slivers;
    std::vector<Side> sides;
    for (const Face& face : faces) {
      const double area = geometry::area(face.polygon);
      const bool sliver = area < kSliverArea;
      const std::uint32_t label = label_at(to_grid(inner_point(face.polygon)));
      const std::size_t first = sides.size();
      std::size_t e = 0;
      const auto add = [&](const model::Ring& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i, ++e)
          sides.push_back({to_grid(ring.points[i]), to_grid(ring.points[(i + 1) % ring.size()]), label,
                           face.edges[e].line == kTerrainLine});
      };
      add(face.polygon.outer);
      for (const model::Ring& hole : face.polygon.holes) add(hole);
      if (sliver) slivers.push_back({area, first, sides.size() - first});
    }
    sides_ = sides;
    std::ranges::sort(sides_, {}, [](const Side& s) { return std::pair(s.a, s.b); });
    std::ranges::stable_sort(slivers, std::ranges::greater(), &Sliver::area);
    for (const Sliver& sliver : slivers) {
      // At the border of the square the neighbour may be no sliver: both sides keep the ends of both there.
      if (std::any_of(sides.begin() + static_cast<std::ptrdiff_t>(sliver.first),
                      sides.begin() + static_cast<std::ptrdiff_t>(sliver.first + sliver.count),
                      [&](const Side& side) { return find(side.b, side.a) == nullptr; }))
        continue;
      double longest = -1;
      std::uint32_t label = kNoLabel;
      for (std::size_t i = sliver.first; i < sliver.first + sliver.count; ++i) {
        const Side& side = sides[i];
        const Side* other = find(side.b, side.a);
        if (other == nullptr) continue;
        const double length =
            std::hypot(static_cast<double>(side.b.x - side.a.x), static_cast<double>(side.b.y - side.a.y));
        if (length > longest) longest = length, label = other->label;
      }
      if (longest < 0) continue;
      for (std::size_t i = sliver.first; i < sliver.first + sliver.count; ++i)
        if (Side* own = find(sides[i].a, sides[i].b)) own->label = label;
    }
  }

  const Side* find(Grid2 a, Grid2 b) const {
    const auto at =
        std::ranges::lower_bound(sides_, std::pair(a, b), {}, [](const Side& s) { return std::pair(s.a, s.b); });
    return at != sides_.end() && at->a == a && at->b == b ? &*at : nullptr;
  }
  Side* find(Grid2 a, Grid2 b) { return const_cast<Side*>(std::as_const(*this).find(a, b)); }

  std::uint32_t beyond(Grid2 a, Grid2 b) const {
    if (const Side* other = find(b, a)) return other->label;
    // Beyond the square, or where a second noding moved an edge: a step to the right of its middle.
    const Grid2 u = b - a;
    const auto side = [](std::int64_t v) { return (v > 0) - (v < 0); };
    return label_at({(a.x + b.x) / 2 + side(u.y), (a.y + b.y) / 2 - side(u.x)});
  }

  /// Edges that end there.
  std::size_t edges_at(Grid2 p) const {
    const auto [first, last] = std::ranges::equal_range(ends_, p);
    return static_cast<std::size_t>(last - first);
  }

  PartitionPiece piece(Face face) const {
    PartitionPiece out;
    bool known = false;
    const auto add = [&](const model::Ring& ring, model::Ring& to) {
      const std::size_t n = ring.size();
      std::vector<Grid2> points;
      for (const Point2 p : ring.points) points.push_back(to_grid(p));
      std::vector<std::uint32_t> labels(n);
      for (std::size_t i = 0; i < n; ++i) {
        const Side* own = find(points[i], points[(i + 1) % n]);
        if (own != nullptr && !known) out.label = own->label, known = true;
        labels[i] = beyond(points[i], points[(i + 1) % n]);
      }
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n;
        if (labels[i] == labels[before] && edges_at(points[i]) == 2 &&
            orientation(points[before], points[i], points[(i + 1) % n]) == 0 && !is_corner(points[i]))
          continue;
        to.points.push_back(ring.points[i]);
        to.nodes.push_back(0);
        out.beyond.push_back(labels[i]);
      }
    };
    add(face.polygon.outer, out.polygon.outer);
    for (const model::Ring& hole : face.polygon.holes) {
      model::Ring ring;
      add(hole, ring);
      out.polygon.holes.push_back(std::move(ring));
    }
    if (!known) out.label = label_at(to_grid(inner_point(face.polygon)));
    return out;
  }

  bool is_corner(Grid2 p) const {
    return (p.x == box_.low.x || p.x == box_.high.x) && (p.y == box_.low.y || p.y == box_.high.y);
  }

  PlanBox square_;
  GridBox box_;
  bool hidden_ = false;  ///< a claim covers the whole square: weaker ones cannot be seen
  std::vector<Seen> claims_;
  std::vector<DividingLine> lines_;
  std::vector<Side> sides_;  ///< ascending
  std::vector<Grid2> ends_;  ///< of the edges that are kept, ascending
};

}  // namespace

bool claim_holds(const AreaClaim& claim, Point2 place) {
  const Grid2 p = to_grid(place);
  if (claim.right_of_lines) {
    std::vector<std::array<Grid2, 2>> segments;
    for (const std::vector<Point2>& line : claim.rings)
      for (std::size_t i = 1; i < line.size(); ++i) segments.push_back({to_grid(line[i - 1]), to_grid(line[i])});
    return is_right(segments, p);
  }
  bool inside = false;
  for (const std::vector<Point2>& ring : claim.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      Grid2 a = to_grid(ring[i]), b = to_grid(ring[(i + 1) % ring.size()]);
      if (b.y < a.y) std::swap(a, b);
      if (p.y >= a.y && p.y < b.y && orientation(a, b, p) > 0) inside = !inside;
    }
  return inside;
}

std::vector<PartitionPiece> partition_of(const PlanBox& square, std::span<const AreaClaim> claims,
                                         std::span<const DividingLine> lines) {
  return Partition(square, claims, lines).pieces();
}

}  // namespace blockrand::geometry
