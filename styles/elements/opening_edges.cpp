// The edge language of openings.
#include "styles/elements/opening_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace blockrand::elements {
namespace {

using model::Point2;

constexpr const char* kEdgeNames[] = {"lower", "right", "upper", "left"};
/// m. Openings smaller than this are none.
constexpr double kLeastOpening = 0.05;

bool share(double v) { return v >= 0 && v <= 1; }

/// Pairs of arcs that mirror each other: the second half walks the first one back. Sizes give the proportions.
constexpr EdgeShape kEdgeShapes[] = {
    {"straight", ""},
    {"round", "Modifications { arc, abs, 0, 180, 1; }"},
    {"basket", "Modifications { arc, abs, 0, 60, 1; arc, rel, 0, 60, 3; arc, rel, 0, 60, 1; }"},
    {"pointed", "Modifications { arc, abs, 0, 60, 1; arc, abs, 120, 60, 1; }"},
    {"ogee", "Modifications { arc, abs, 0, 75, 1; arc, rel, 0, -45, 1; arc, abs, 150, -45, 1; arc, rel, 0, 75, 1; }"},
    {"gabled", "Modifications { line, abs, 45, 1; line, abs, 135, 1; }"},
};

}  // namespace

std::span<const EdgeShape> edge_shapes() { return kEdgeShapes; }

tl::expected<Outline, std::string> opening_outline(const OpeningRectangle& r, const OpeningEdges& given, bool door) {
  OpeningEdges edges = given;
  if (door) edges[0] = OpeningEdge{};
  for (int k = 0; k < 4; ++k) {
    const OpeningEdge& e = edges[static_cast<std::size_t>(k)];
    if (!share(e.dist_left) || !share(e.dist_right) || !share(e.dist_inward) || !share(e.size))
      return tl::unexpected(fmt::format("the {} edge: distances and size are shares from 0 to 1", kEdgeNames[k]));
    if (e.dominant && edges[static_cast<std::size_t>((k + 1) % 4)].dominant)
      return tl::unexpected(
          fmt::format("the {} and the {} edge cannot both be dominant", kEdgeNames[k], kEdgeNames[(k + 1) % 4]));
  }
  const bool jambs = edges[1].dominant || edges[3].dominant;
  if (!jambs)
    edges[0].dominant = edges[2].dominant = true;
  else
    edges[1].dominant = edges[3].dominant = true;

  const double w = r.width(), h = r.height();
  std::array<double, 4> depth{};
  for (std::size_t k = 0; k < 4; ++k) depth[k] = (edges[k].dist_inward + edges[k].size) * (k % 2 == 0 ? h : w);
  // Corner of an edge and its axes: along it counter-clockwise, and inwards.
  const Point2 corners[4] = {{r.left, r.bottom}, {r.right, r.bottom}, {r.right, r.top}, {r.left, r.top}};
  const Point2 along[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, inwards[4] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}};
  Outline out;
  for (std::size_t k = 0; k < 4; ++k) {
    const OpeningEdge& e = edges[k];
    const double whole = k % 2 == 0 ? w : h;
    // The viewer's left comes first on the lower edge and last on the upper one; jambs count from below.
    const bool reversed = k >= 2;
    double from = (reversed ? e.dist_right : e.dist_left) * whole,
           to = whole - (reversed ? e.dist_left : e.dist_right) * whole;
    // A straight dominant edge ends where its neighbours' inner lines meet it: what lies beyond would be a spike.
    if (!e.dominant || !e.profile || e.size == 0) {
      from = std::max(from, depth[(k + 3) % 4]);
      to = std::min(to, whole - depth[(k + 1) % 4]);
    }
    const auto at = [&](double s, double inward) {
      return model::snap(Point2{corners[k].x + along[k].x * s + inwards[k].x * inward,
                                corners[k].y + along[k].y * s + inwards[k].y * inward});
    };
    const auto shaped = [&](std::size_t n) { return edges[n].dominant && edges[n].profile && edges[n].size > 0; };
    const bool vanishes = !e.profile && to - from > -1.0 / model::kGridStepsPerMetre &&
                          to - from <= 1.0 / model::kGridStepsPerMetre && shaped((k + 1) % 4) && shaped((k + 3) % 4);
    if (vanishes) continue;
    if (!(to - from > 1.0 / model::kGridStepsPerMetre))
      return tl::unexpected(fmt::format("nothing is left of the {} edge", kEdgeNames[k]));
    if (!e.profile || e.size == 0) {
      out.push_back(at(from, depth[k]));
      out.push_back(at(to, depth[k]));
      continue;
    }
    // The walk starts at its left end seen from inside the opening: (x: along, y: outwards).
    const Outline& walk = e.profile->points;
    if (walk.size() < 3)
      return tl::unexpected(fmt::format("the profile of the {} edge is a straight line", kEdgeNames[k]));
    const Point2 a = walk.front(), b = walk.back();
    const double span = b.x - a.x;
    double highest = 0;
    for (const Point2 p : walk) highest = std::max(highest, p.y - a.y);
    if (!(span > 0) || std::fabs(b.y - a.y) > 1e-6 * span || !(highest > 0))
      return tl::unexpected(
          fmt::format("the profile of the {} edge must rise from its start and come down to the same height at its "
                      "end, to the right of it",
                      kEdgeNames[k]));
    for (std::size_t i = 0; i < walk.size(); ++i) {
      // Along the edge counter-clockwise is from the viewer's right to his left above: the walk is taken as drawn, its
      // start at the viewer's left (jambs: at their lower end), so that asymmetric heads look as drawn.
      const Point2 p = reversed ? walk[walk.size() - 1 - i] : walk[i];
      const double t = reversed ? (b.x - p.x) / span : (p.x - a.x) / span;
      out.push_back(at(from + t * (to - from), depth[k] - (p.y - a.y) / highest * e.size * (k % 2 == 0 ? h : w)));
    }
  }
  // Neighbours that meet give the same corner twice.
  Outline clean;
  for (const Point2 p : out)
    if (clean.empty() || !(clean.back() == p)) clean.push_back(p);
  while (clean.size() > 1 && clean.front() == clean.back()) clean.pop_back();
  if (!is_simple(clean)) return tl::unexpected<std::string>("the edges of the opening cross");
  if (signed_area(clean) < kLeastOpening * kLeastOpening)
    return tl::unexpected<std::string>("nothing is left of the opening");
  for (const Point2 p : clean)
    if (p.x < model::snap(r.left) || p.x > model::snap(r.right) || p.y < model::snap(r.bottom) ||
        p.y > model::snap(r.top))
      return tl::unexpected<std::string>("an edge's profile leaves the rough opening");
  return clean;
}

}  // namespace blockrand::elements
