#include "pipeline/facades/facade_segments.h"

#include <algorithm>
#include <cmath>

namespace blockrand::facades {
namespace {

using model::Point2;

/// An edge and a wall whose directions differ by more are not the same.
constexpr double kParallel = 0.999;  // cosine; 2.6 degrees

struct Piece {
  double from = 0, to = 0, apart = 0;
  std::uint32_t edge = 0;
};

struct Segment {
  Point2 from, to, direction;
  bool valid = false;
};

std::vector<Segment> segments_of(const model::Building& building) {
  std::vector<Segment> out(building.edges.size());
  for (std::size_t i = 0; i < building.edges.size(); ++i) {
    const model::WallSegment& e = building.edges[i];
    if (e.polygon >= building.outline.size()) continue;
    const model::Polygon& polygon = building.outline[e.polygon];
    if (e.ring > polygon.holes.size()) continue;
    const auto& points = (e.ring == 0 ? polygon.outer : polygon.holes[e.ring - 1]).points;
    if (e.edge >= points.size()) continue;
    const Point2 a = points[e.edge], b = points[(e.edge + 1) % points.size()];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    if (!(length > 0)) continue;
    const Point2 d{dx / length, dy / length};
    out[i] = {{a.x + d.x * e.start, a.y + d.y * e.start}, {a.x + d.x * e.end, a.y + d.y * e.end}, d, true};
  }
  return out;
}

}  // namespace

std::vector<FacadeSegment> facade_segments(const model::Building& building, std::span<const WallFrame> walls) {
  const std::vector<Segment> segments = segments_of(building);
  std::vector<FacadeSegment> out;
  std::vector<Piece> pieces;
  std::vector<double> cuts;
  for (std::uint32_t w = 0; w < walls.size(); ++w) {
    const WallFrame& wall = walls[w];
    const Point2 outward = wall.outward();
    pieces.clear();
    cuts.assign({0.0, wall.length});
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
      const Segment& s = segments[i];
      if (!s.valid || s.direction.x * wall.along.x + s.direction.y * wall.along.y < kParallel) continue;
      const auto along = [&](Point2 p) {
        return (p.x - wall.start.x) * wall.along.x + (p.y - wall.start.y) * wall.along.y;
      };
      const auto across = [&](Point2 p) {
        return std::fabs((p.x - wall.start.x) * outward.x + (p.y - wall.start.y) * outward.y);
      };
      const double apart = std::max(across(s.from), across(s.to));
      const double from = std::clamp(along(s.from), 0.0, wall.length), to = std::clamp(along(s.to), 0.0, wall.length);
      if (apart > kSameWall || to - from < kShortestFacadeSegment) continue;
      pieces.push_back({from, to, apart, i});
      cuts.push_back(from);
      cuts.push_back(to);
    }
    std::sort(cuts.begin(), cuts.end());
    const std::size_t first = out.size();
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
      const double from = cuts[c], to = cuts[c + 1], middle = (from + to) / 2;
      if (to - from < kShortestFacadeSegment) continue;
      const Piece* best = nullptr;
      for (const Piece& p : pieces)
        if (p.from < middle && middle < p.to && (!best || p.apart < best->apart)) best = &p;
      const model::WallSegmentKind kind = best ? building.edges[best->edge].kind : model::WallSegmentKind::unknown;
      // A party wall keeps its neighbours apart, since they cover different heights.
      const bool joins = out.size() > first && out.back().kind == kind &&
                         from - out.back().to < kShortestFacadeSegment && kind != model::WallSegmentKind::party_wall;
      if (joins) {
        out.back().to = to;
        if (best && (out.back().edges.empty() || out.back().edges.back() != best->edge))
          out.back().edges.push_back(best->edge);
        continue;
      }
      FacadeSegment segment;
      segment.wall = w;
      segment.from = from;
      segment.to = to;
      segment.kind = kind;
      if (best) segment.edges.push_back(best->edge);
      out.push_back(std::move(segment));
    }
    if (out.size() > first) {
      out[first].starts_wall = out[first].from < kShortestFacadeSegment;
      out.back().ends_wall = wall.length - out.back().to < kShortestFacadeSegment;
    }
  }
  return out;
}

}  // namespace blockrand::facades
