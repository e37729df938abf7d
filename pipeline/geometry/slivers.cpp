#include "pipeline/geometry/slivers.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

namespace blockrand::geometry {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

Point2 foot_on(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return {a.x + t * dx, a.y + t * dy};
}

/// The sliver whose tip runs from point `first` to point `last` of the ring.
std::optional<Sliver> sliver_at(const Ring& ring, std::size_t first, std::size_t last, double width) {
  const std::size_t n = ring.size();
  const Point2 p = ring.points[(first + n - 1) % n], a = ring.points[first];
  const Point2 b = ring.points[last], q = ring.points[(last + 1) % n];
  if ((p.x - a.x) * (q.x - b.x) + (p.y - a.y) * (q.y - b.y) <= 0) return std::nullopt;
  const double one = distance(p, a), other = distance(q, b), length = std::min(one, other);
  if (length <= width || distance(a, b) > width) return std::nullopt;
  const double across = one <= other ? distance_to_segment(p, b, q) : distance_to_segment(q, p, a);
  if (across > width) return std::nullopt;
  const Grid2 gp = to_grid(p), ga = to_grid(a), gb = to_grid(b), gq = to_grid(q);
  const bool outward =
      first == last ? orientation(gp, ga, gq) > 0 : orientation(gp, ga, gb) >= 0 && orientation(ga, gb, gq) >= 0;
  return Sliver{first, last, length, across, outward};
}

/// Takes the tip away.
void cut(Ring& ring, const Sliver& sliver) {
  const std::size_t n = ring.size(), before = (sliver.first + n - 1) % n, after = (sliver.last + 1) % n;
  const Point2 p = ring.points[before], a = ring.points[sliver.first];
  const Point2 b = ring.points[sliver.last], q = ring.points[after];
  const bool first_is_shorter = distance(p, a) <= distance(q, b);
  const Point2 end = first_is_shorter ? p : q;
  const Point2 foot = first_is_shorter ? foot_on(p, b, q) : foot_on(q, p, a), corner = model::snap(foot);
  Ring out;
  for (std::size_t i = 0; i < n; ++i) {
    const bool tip = i == sliver.first || i == sliver.last;
    if (!tip) {
      out.points.push_back(ring.points[i]);
      out.nodes.push_back(ring.nodes[i]);
    } else if (i == sliver.first && distance(end, foot) > kOnWall && corner != p && corner != q) {
      out.points.push_back(corner);
      out.nodes.push_back(0);
    }
  }
  ring = std::move(out);
}

int cut_slivers(Ring& ring, double width) {
  int cuts = 0;
  for (std::size_t i = 0, calm = 0; calm < ring.size();) {
    i %= ring.size();
    const std::optional<Sliver> sliver = sliver_from(ring, i, width);
    // Where several points stand on the legs, rounding can turn over what is left of a sliver whose tip is off.
    const bool turned_over = sliver && cuts > 0 && sliver->width <= kOnWall;
    if (!sliver || (!sliver->outward && !turned_over)) {
      ++calm;
      ++i;
      continue;
    }
    cut(ring, *sliver);
    ++cuts;
    // What was beside the tip may be one now.
    calm = 0;
    i = i > 3 ? i - 3 : 0;
  }
  return cuts;
}

}  // namespace

std::optional<Sliver> sliver_from(const Ring& ring, std::size_t first, double width) {
  if (ring.size() < 4) return std::nullopt;
  const std::optional<Sliver> pointed = sliver_at(ring, first, first, width);
  return pointed ? pointed : sliver_at(ring, first, (first + 1) % ring.size(), width);
}

int cut_slivers(Polygon& polygon, double width) {
  Polygon trial = polygon;
  int cuts = cut_slivers(trial.outer, width);
  for (Ring& hole : trial.holes) cuts += cut_slivers(hole, width);
  if (cuts == 0 || !strictly_simple(trial) || !rings_apart(trial)) return 0;
  polygon = std::move(trial);
  return cuts;
}

int cut_slivers(std::vector<Polygon>& polygons, double width) {
  int cuts = 0;
  for (Polygon& p : polygons) cuts += cut_slivers(p, width);
  return cuts;
}

}  // namespace blockrand::geometry
