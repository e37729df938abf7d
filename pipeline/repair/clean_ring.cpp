#include "pipeline/repair/clean_ring.h"

#include <cmath>

#include "pipeline/geometry/polygon.h"

namespace blockrand::repair {

namespace {

using model::Point2;

double distance(Point2 a, Point2 b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }

bool is_spike(Point2 before, Point2 tip, Point2 after, double width) {
  const double ux = before.x - tip.x, uy = before.y - tip.y, vx = after.x - tip.x, vy = after.y - tip.y;
  if (ux * vx + uy * vy <= 0) return false;  // the ring goes on, it does not turn back
  const double u = distance(before, tip), v = distance(after, tip);
  return u <= v ? geometry::distance_to_segment(before, tip, after) <= width
                : geometry::distance_to_segment(after, tip, before) <= width;
}

void erase(model::Ring& ring, std::size_t i) {
  ring.points.erase(ring.points.begin() + static_cast<std::ptrdiff_t>(i));
  ring.nodes.erase(ring.nodes.begin() + static_cast<std::ptrdiff_t>(i));
}

}  // namespace

RingCleaning clean_ring(model::Ring& ring, const RepairOptions& options) {
  RingCleaning done;
  // One pass without erasing in the middle: rings of 20,000 points are rare but legal.
  model::Ring kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (!kept.points.empty() && distance(kept.points.back(), ring.points[i]) <= options.duplicate_distance) {
      ++done.duplicates;
      continue;
    }
    kept.points.push_back(ring.points[i]);
    kept.nodes.push_back(ring.nodes[i]);
  }
  while (kept.size() > 1 && distance(kept.points.front(), kept.points.back()) <= options.duplicate_distance) {
    kept.points.pop_back();
    kept.nodes.pop_back();
    ++done.duplicates;
  }
  ring = std::move(kept);
  for (std::size_t i = 0, calm = 0; ring.size() >= 3 && calm < ring.size();) {
    const std::size_t n = ring.size();
    const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
    if (distance(ring.points[i], ring.points[after]) <= options.duplicate_distance) {
      // Removing a spike can bring its two ends together.
      erase(ring, after);
      ++done.duplicates;
    } else if (is_spike(ring.points[before], ring.points[i], ring.points[after], options.spike_width)) {
      erase(ring, i);
      ++done.spikes;
    } else {
      ++calm;
      i = after;
      continue;
    }
    // The neighbours have changed: look at the ring again from one corner earlier.
    calm = 0;
    if (ring.size() > 0) i = (i + 2 * ring.size() - 2) % ring.size();
  }
  return done;
}

}  // namespace blockrand::repair
