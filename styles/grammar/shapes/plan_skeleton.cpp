#include "styles/grammar/shapes/plan_skeleton.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::grammar {

double SweptPlan::height() const {
  double top = 0;
  for (const Vector3 p : points) top = std::max(top, p.z);
  return top;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_of(const FlatFace& face) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  const auto add = [&](std::size_t count) {
    const auto base = static_cast<std::uint32_t>(out.size()), n = static_cast<std::uint32_t>(count);
    for (std::uint32_t i = 0; i < n; ++i) out.emplace_back(base + i, base + (i + 1) % n);
  };
  add(face.polygon.outer.points.size());
  for (const model::Ring& hole : face.polygon.holes) add(hole.points.size());
  return out;
}

std::optional<SweptPlan> sweep_plan(const FlatFace& face, std::span<const double> slopes, std::optional<double> deck) {
  std::vector<geometry::EdgeProfile> profiles;
  for (const double slope : slopes)
    profiles.push_back(
        {slope >= geometry::kSteepestSlope ? geometry::kUpright : std::max(slope, geometry::kLeastSlope), {}});
  return sweep_plan(face, std::move(profiles), deck);
}

std::optional<SweptPlan> sweep_plan(const FlatFace& face, std::vector<geometry::EdgeProfile> profiles,
                                    std::optional<double> deck) {
  for (auto& profile : profiles)
    for (auto& change : profile.changes) change.height *= face.scale;
  const auto skeleton = geometry::weighted_skeleton(face.polygon, profiles,
                                                    deck ? std::optional<double>(*deck * face.scale) : std::nullopt);
  if (!skeleton) return {};
  SweptPlan out;
  for (const auto& node : skeleton->nodes)
    out.points.push_back({node.point.x / face.scale, node.point.y / face.scale, node.height / face.scale});
  const std::size_t corners = face.corners.size();
  // The deck's height is rounded to the grid; level points are level again.
  if (deck)
    for (std::size_t i = corners; i < out.points.size(); ++i)
      if (std::fabs(out.points[i].z - *deck) * face.scale < 2.0 / model::kGridStepsPerMetre) out.points[i].z = *deck;
  const auto edges = edges_of(face);
  for (const auto& f : skeleton->faces) {
    SweptFace swept;
    swept.upright = f.upright;
    swept.edge =
        f.edge >= geometry::WeightedSkeletonFace::kCorner ? SweptFace::kDeck : static_cast<std::int32_t>(f.edge);
    swept.loops = f.loops;
    if (swept.edge != SweptFace::kDeck && !swept.loops.empty()) {
      auto& loop = swept.loops[0];
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (loop[i] == edges[f.edge].first) {
          std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(i), loop.end());
          break;
        }
    }
    out.faces.push_back(std::move(swept));
  }
  return out;
}

std::optional<FlatFace> expanded(const FlatFace& face, std::span<const double> distances) {
  FlatFace out = face;
  const auto edges = edges_of(face);
  std::vector<model::Point2> points;
  for (const auto p : face.polygon.outer.points) points.push_back(p);
  for (const auto& hole : face.polygon.holes) points.insert(points.end(), hole.points.begin(), hole.points.end());
  std::vector<std::uint32_t> before(edges.size());
  for (std::uint32_t i = 0; i < edges.size(); ++i) before[edges[i].second] = i;
  std::vector<model::Point2> moved(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto line = [&](std::uint32_t e) {
      const model::Point2 a = points[edges[e].first], b = points[edges[e].second];
      const double dx = b.x - a.x, dy = b.y - a.y, n = std::sqrt(dx * dx + dy * dy);
      const double d = distances[e] * face.scale;
      // Outwards is right of the way.
      return std::array<double, 4>{a.x + dy / n * d, a.y - dx / n * d, dx / n, dy / n};
    };
    const auto in = line(before[i]), on = line(i);
    const double det = in[2] * on[3] - in[3] * on[2];
    if (std::fabs(det) > 1e-4) {
      const double t = ((on[0] - in[0]) * on[3] - (on[1] - in[1]) * on[2]) / det;
      moved[i] = {in[0] + in[2] * t, in[1] + in[3] * t};
    } else {
      moved[i] = {on[0], on[1]};
    }
    // A needle's mitre is longer than anything asked for.
    constexpr double kLongestMitre = 20;
    const double reach = std::max(std::fabs(distances[before[i]]), std::fabs(distances[i])) * face.scale;
    const double dx = moved[i].x - points[i].x, dy = moved[i].y - points[i].y;
    if (!(std::sqrt(dx * dx + dy * dy) <= kLongestMitre * reach + 1e-9)) return {};
    moved[i] = model::snap(moved[i]);
  }
  std::size_t at = 0;
  for (auto& p : out.polygon.outer.points) p = moved[at++];
  for (auto& hole : out.polygon.holes)
    for (auto& p : hole.points) p = moved[at++];
  if (!geometry::strictly_simple(out.polygon)) return {};
  // Turned inside out by moving inwards too far?
  const auto area = [](const model::Ring& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      const auto a = ring.points[i], b = ring.points[(i + 1) % ring.points.size()];
      sum += a.x * b.y - a.y * b.x;
    }
    return sum;
  };
  if (!(area(out.polygon.outer) > 0)) return {};
  for (const auto& hole : out.polygon.holes)
    if (!(area(hole) < 0)) return {};
  return out;
}

}  // namespace blockrand::grammar
