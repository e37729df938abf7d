#include "pipeline/context/street_front.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::context {

namespace {

using model::Point2;

/// How much of the view a street takes; a street is its name, or its line where it has none.
struct Share {
  std::uint32_t line = 0;  ///< the first seen of the street
  double weight = 0;
};

bool same_street(const NetworkLine& a, const NetworkLine& b) {
  return a.name.empty() && b.name.empty() ? a.id == b.id : a.name == b.name;
}

}  // namespace

std::string_view name(LineClass kind) {
  constexpr std::string_view kNames[] = {"motorway",    "trunk",         "primary",    "secondary", "tertiary",
                                         "residential", "living_street", "pedestrian", "railway",   "waterway",
                                         "shore",       "coastline",     "other"};
  return kNames[static_cast<std::size_t>(kind)];
}

void face_street(const OutlineEdge& edge, std::span<const WallSample> samples, const BuildingView& view,
                 model::WallSegment& wall_segment) {
  const VicinityIndex& index = *view.index;
  const auto lines = index.all().lines;
  const std::array<Point2, kFanRays> fan = fan_around(edge.outward);
  const bool front =
      wall_segment.kind == model::WallSegmentKind::street || wall_segment.kind == model::WallSegmentKind::passage;
  std::vector<Share> shares;
  std::vector<std::uint32_t> seen;  // lines
  const auto give = [&](std::uint32_t line, double weight) {
    seen.push_back(line);
    for (Share& s : shares)
      if (same_street(lines[s.line], lines[line])) {
        s.weight += weight;
        return;
      }
    shares.push_back({line, weight});
  };
  double visible = 0;
  for (const WallSample& sample : samples) {
    visible += sample.square != kNothing ? 1 : sample.street_share;
    if (sample.square != kNothing) give(index.squares()[sample.square].rings.front(), kFanRays);
    for (std::size_t i = 0; i < kFanRays; ++i) {
      if (sample.fan[i].street_piece == kNothing) continue;
      // A front looks straight ahead: what it sees aslant counts little, but more than nothing.
      const double c = dot(fan[i], edge.outward);
      give(index.scene().streets()[sample.fan[i].street_piece].line, front ? c * c * c * c : c);
    }
  }
  if (!samples.empty()) wall_segment.visibility = static_cast<float>(visible / static_cast<double>(samples.size()));
  if (shares.empty()) return;
  const auto best = std::min_element(shares.begin(), shares.end(), [&](const Share& a, const Share& b) {
    return std::pair(-a.weight, lines[a.line].id) < std::pair(-b.weight, lines[b.line].id);
  });

  // The nearest piece of the street among the lines seen.
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  const Point2 middle = edge.at((wall_segment.start + wall_segment.end) / 2);
  double distance = std::numeric_limits<double>::infinity(), cosine = 0;
  const NetworkLine* nearest = nullptr;
  for (const std::uint32_t l : seen) {
    const NetworkLine& line = lines[l];
    if (!same_street(line, lines[best->line])) continue;
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Point2 a = line.points[i - 1], b = line.points[i];
      if (a == b) continue;
      const double d = geometry::distance_to_segment(middle, a, b);
      if (d > distance || (d == distance && nearest != nullptr && !(line.id < nearest->id))) continue;
      distance = d;
      nearest = &line;
      const Point2 along{b.x - a.x, b.y - a.y};
      cosine = std::fabs(dot(along, edge.along)) / std::sqrt(dot(along, along));
    }
  }
  if (nearest == nullptr) return;
  wall_segment.street = nearest->id;
  wall_segment.street_name = nearest->name;
  wall_segment.street_class = name(nearest->kind);
  wall_segment.street_distance = static_cast<float>(distance);
  wall_segment.street_angle = static_cast<float>(base::acos(std::min(1.0, cosine)) * base::kDegreesPerRadian);
}

}  // namespace blockrand::context
