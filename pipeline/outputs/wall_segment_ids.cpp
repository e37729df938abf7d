#include "pipeline/outputs/wall_segment_ids.h"

#include <cmath>
#include <map>
#include <tuple>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/wall_segment.h"

namespace blockrand::outputs {
namespace {

using model::Point2;
using model::WallSegment;

std::string name_of(std::int64_t node, Point2 at) {
  if (node != 0) return std::to_string(node);
  const auto steps = [](double metres) {
    return std::to_string(static_cast<std::int64_t>(std::nearbyint(metres * model::kGridStepsPerMetre)));
  };
  return 'p' + steps(at.x) + 'x' + steps(at.y);
}

}  // namespace

std::vector<IdentifiedWallSegment> wall_segments(const model::Building& building) {
  std::vector<IdentifiedWallSegment> out;
  out.reserve(building.edges.size());
  const std::string prefix = building.id() + ".e";
  std::map<std::string, int> used;  // edges of the outline by the names of their ends
  std::tuple<std::uint32_t, std::uint32_t, std::uint32_t> edge_at_hand{model::kNoIndex, 0, 0};
  std::string edge_id;
  int piece = 0;
  for (std::size_t i = 0; i < building.edges.size(); ++i) {
    const WallSegment& e = building.edges[i];
    const auto ends = geometry::ends_of(building, e);
    if (!ends) continue;
    IdentifiedWallSegment s;
    s.index = static_cast<std::uint32_t>(i);
    s.from = ends->from;
    s.to = ends->to;
    const std::tuple key{e.polygon, e.ring, e.edge};
    if (key != edge_at_hand) {
      edge_at_hand = key;
      piece = 0;
      edge_id = name_of(e.from_node, ends->edge_from) + '_' + name_of(e.to_node, ends->edge_to);
      if (const int times = ++used[edge_id]; times > 1) edge_id += '~' + std::to_string(times);
    }
    s.id = prefix + edge_id;
    if (piece > 0) s.id += '.' + std::to_string(piece);
    ++piece;
    out.push_back(std::move(s));
  }
  return out;
}

double outward(Point2 from, Point2 to) {
  // The building is on the left, so the wall looks to the right: (dy, -dx).
  const double degrees = base::atan2(to.y - from.y, from.x - to.x) * base::kDegreesPerRadian;
  return degrees < 0 ? degrees + 360 : degrees;
}

std::string_view compass(double degrees) {
  constexpr std::string_view names[] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
  const int eighth = static_cast<int>(std::floor(degrees / 45 + 0.5));
  return names[static_cast<std::size_t>(((eighth % 8) + 8) % 8)];
}

}  // namespace blockrand::outputs
