#include "pipeline/geometry/noded_lines.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/segment_grid.h"

namespace blockrand::geometry {

namespace {

using model::Point2;

/// m. Cells of the index: a street segment or a few walls long.
constexpr double kCell = 32;
constexpr double kStep = 1.0 / model::kGridStepsPerMetre;

Point2 metres(Grid2 g) { return {static_cast<double>(g.x) * kStep, static_cast<double>(g.y) * kStep}; }

/// A segment without direction: a < b.
struct Piece {
  Grid2 a, b;
  friend auto operator<=>(const Piece&, const Piece&) = default;
};

struct Source {
  Piece piece;
  std::uint64_t line = 0;
  bool forward = true;
  friend auto operator<=>(const Source&, const Source&) = default;
};

std::vector<Source> sources_of(std::span<const DividingLine> lines) {
  std::vector<Source> out;
  for (const DividingLine& line : lines)
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Grid2 a = to_grid(line.points[i - 1]), b = to_grid(line.points[i]);
      if (a < b)
        out.push_back({{a, b}, line.id, true});
      else if (b < a)
        out.push_back({{b, a}, line.id, false});
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Int128 cross(Grid2 u, Grid2 v) { return static_cast<Int128>(u.x) * v.y - static_cast<Int128>(u.y) * v.x; }

/// n / d to the nearest integer, halves upwards; d > 0.
std::int64_t rounded_quotient(Int128 n, Int128 d) {
  const Int128 twice = 2 * n + d, whole = 2 * d;
  const Int128 q = twice / whole;
  return static_cast<std::int64_t>(q * whole > twice ? q - 1 : q);
}

/// Where two pieces cross well within both, rounded to the grid. Ends that lie on the other piece are hot already.
bool crossing(const Piece& p, const Piece& q, Grid2& out) {
  const int c = orientation(p.a, p.b, q.a), d = orientation(p.a, p.b, q.b);
  if (c * d >= 0) return false;
  if (orientation(q.a, q.b, p.a) * orientation(q.a, q.b, p.b) >= 0) return false;
  const Grid2 u = p.b - p.a, v = q.b - q.a;
  Int128 below = cross(u, v), above = cross(q.a - p.a, v);
  if (below < 0) below = -below, above = -above;
  out = {p.a.x + rounded_quotient(above * u.x, below), p.a.y + rounded_quotient(above * u.y, below)};
  return true;
}

/// Whether a piece passes through the square of side one around a grid point. The square owns its left and lower sides,
/// so that squares fill the plane without overlapping.
bool passes_through(const Piece& piece, Grid2 centre) {
  // In half steps the corners are whole numbers.
  const Grid2 a{2 * (piece.a.x - centre.x), 2 * (piece.a.y - centre.y)},
      b{2 * (piece.b.x - centre.x), 2 * (piece.b.y - centre.y)};
  if ((a.x == 0 && a.y == 0) || (b.x == 0 && b.y == 0)) return true;
  if (std::max(a.x, b.x) < -1 || std::min(a.x, b.x) >= 1 || std::max(a.y, b.y) < -1 || std::min(a.y, b.y) >= 1)
    return false;
  // Ends lie on other grid points, outside the square: the piece passes when it cuts the inside or meets an owned side.
  const int lower_left = orientation(a, b, Grid2{-1, -1}), lower_right = orientation(a, b, Grid2{1, -1});
  const int upper_left = orientation(a, b, Grid2{-1, 1}), upper_right = orientation(a, b, Grid2{1, 1});
  if (lower_left == 0) return true;
  const int most = std::max({lower_left, lower_right, upper_left, upper_right});
  const int least = std::min({lower_left, lower_right, upper_left, upper_right});
  return most > 0 && least < 0;  // one corner alone, other than the lower left, is not enough
}

}  // namespace

std::vector<NodedEdge> noded_edges(std::span<const DividingLine> lines) {
  const std::vector<Source> sources = sources_of(lines);
  std::vector<Piece> pieces;
  for (const Source& s : sources)
    if (pieces.empty() || pieces.back() != s.piece) pieces.push_back(s.piece);
  std::vector<Segment> segments;
  segments.reserve(pieces.size());
  for (const Piece& p : pieces) segments.push_back({metres(p.a), metres(p.b)});
  const SegmentGrid grid(segments, kCell);

  std::vector<Grid2> hot;
  for (const Piece& p : pieces) {
    hot.push_back(p.a);
    hot.push_back(p.b);
  }
  grid.for_each_pair([&](std::uint32_t i, std::uint32_t k) {
    Grid2 place;
    if (crossing(pieces[i], pieces[k], place)) hot.push_back(place);
  });
  std::sort(hot.begin(), hot.end());
  hot.erase(std::unique(hot.begin(), hot.end()), hot.end());

  // The hot squares of each piece.
  std::vector<std::pair<std::uint32_t, Grid2>> chains;
  std::vector<std::uint32_t> near;
  for (const Grid2 g : hot) {
    const Point2 p = metres(g);
    grid.near(p, p, near);
    for (const std::uint32_t i : near)
      if (passes_through(pieces[i], g)) chains.emplace_back(i, g);
  }
  std::sort(chains.begin(), chains.end());

  std::vector<NodedEdge> out;
  auto source = sources.begin();
  for (auto first = chains.begin(); first != chains.end();) {
    const std::uint32_t i = first->first;
    auto last = first;
    while (last != chains.end() && last->first == i) ++last;
    // In the order in which the piece passes them; two at the same place along it: by position, which is the same for
    // all.
    const Grid2 a = pieces[i].a, u = pieces[i].b - a;
    const auto along = [&](Grid2 g) {
      return static_cast<Int128>(u.x) * (g.x - a.x) + static_cast<Int128>(u.y) * (g.y - a.y);
    };
    std::stable_sort(first, last, [&](const auto& p, const auto& q) { return along(p.second) < along(q.second); });
    const auto own = source;
    while (source != sources.end() && source->piece == pieces[i]) ++source;
    for (auto c = first; std::next(c) != last; ++c) {
      const Grid2 p = c->second, q = std::next(c)->second;
      for (auto s = own; s != source; ++s)
        out.push_back({metres(std::min(p, q)), metres(std::max(p, q)), s->line, s->forward == (p < q)});
    }
    first = last;
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace blockrand::geometry
