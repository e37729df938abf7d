// Runs of bridges that go on in each other.
#include <algorithm>
#include <cmath>

#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/ground_claims.h"
#include "pipeline/surroundings/street_profile.h"

namespace blockrand::surroundings {

using model::GroundClass;
using model::Point2;
namespace osm_key = model::osm_key;

namespace {

/// m.
double length_along(std::span<const Point2> line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
  return sum;
}

}  // namespace

ClaimFinder::BridgeRun ClaimFinder::bridge_run(const Thing& thing) const {
  const model::Extract& e = in_.extract;
  const auto index = static_cast<std::uint32_t>(std::ranges::lower_bound(things_, thing.feature, {}, &Thing::feature) -
                                                things_.begin());
  const auto nodes_of = [&](std::uint32_t t) {
    return e.nodes_of(e.rings_of(e.features[things_[t].feature].rings)[0]);
  };
  const auto line_of = [&](std::uint32_t t) {
    const std::vector<std::vector<Point2>> lines = lines_of(things_[t]);
    return lines.empty() ? std::vector<Point2>() : lines[0];
  };
  const auto layer_of = [&](std::uint32_t t) {
    return length_of(tags_of(things_[t].feature)(osm_key::kLayer)).value_or(1);
  };
  BridgeRun run;
  run.line = line_of(index);
  run.length = length_along(run.line);
  run.layer = layer_of(index);
  const BridgeRun alone = run;
  // Onwards from both ends. Where the run is too long, whichever bridge asks, each of its bridges is one by itself.
  std::vector<std::uint32_t> known{index};
  for (const bool forward : {false, true}) {
    std::uint32_t at = index;
    std::int64_t node = forward ? nodes_of(index).back() : nodes_of(index).front();
    while (run.length <= kMostRun) {
      const auto first = std::ranges::lower_bound(bridge_ends_, std::pair(node, std::uint32_t{0}));
      std::vector<std::uint32_t> meet;
      for (auto b = first; b != bridge_ends_.end() && b->first == node; ++b) meet.push_back(b->second);
      if (meet.size() != 2) break;
      const std::uint32_t next = meet[0] == at ? meet[1] : meet[0];
      if (std::ranges::find(known, next) != known.end()) break;
      known.push_back(next);
      std::vector<Point2> line = line_of(next);
      if (line.size() < 2) break;
      const bool begins = nodes_of(next).front() == node;
      const double length = length_along(line);
      run.length += length;
      run.layer = std::max(run.layer, layer_of(next));
      if (begins != forward) std::ranges::reverse(line);
      if (forward) {
        run.line.insert(run.line.end(), line.begin(), line.end());
      } else {
        run.before += length;
        run.line.insert(run.line.begin(), line.begin(), line.end());
      }
      node = begins ? nodes_of(next).back() : nodes_of(next).front();
      at = next;
    }
  }
  if (run.length > kMostRun) run = alone;
  if (run.line.empty()) return run;
  run.start = run.line.front(), run.end = run.line.back();
  run.crosses_traffic = run.length > kLookedThrough || crosses_traffic(run);
  return run;
}

bool ClaimFinder::crosses_traffic(const BridgeRun& run) const {
  const GroundClaims claims = claims_in(geometry::box_of(run.line));
  double along = 0;
  for (std::size_t i = 1; i < run.line.size(); ++i) {
    const Point2 a = run.line[i - 1], b = run.line[i];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    for (double s = 0; s < length; s += 1) {
      if (along + s < kApproach || along + s > run.length - kApproach) continue;
      const Point2 p{a.x + s / length * (b.x - a.x), a.y + s / length * (b.y - a.y)};
      for (const geometry::AreaClaim& claim : claims.claims) {
        if (p.x < claim.box.minimum.x || p.x > claim.box.maximum.x || p.y < claim.box.minimum.y ||
            p.y > claim.box.maximum.y)
          continue;
        using enum GroundClass;
        const GroundLabel& label = claims.labels[claim.label];
        if (!geometry::claim_holds(claim, p) || !counts_in(square_of(p), claim, label)) continue;
        if (!label.building && (label.ground == carriageway || label.ground == parking_lane ||
                                label.ground == rail_bed || label.ground == cycle_way || label.ground == footway))
          return true;
        break;
      }
    }
    along += length;
  }
  return false;
}

}  // namespace blockrand::surroundings
