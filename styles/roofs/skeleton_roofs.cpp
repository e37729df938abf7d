#include "styles/roofs/skeleton_roofs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon.h"
#include "pipeline/geometry/roof_surfaces.h"
#include "pipeline/geometry/straight_skeleton.h"
#include "pipeline/geometry/weighted_skeleton.h"
#include "styles/roofs/shape_tables.h"

namespace blockrand::roofs {

namespace {

using geometry::EdgeProfile;
using geometry::kUpright;
using geometry::WeightedSkeleton;
using model::IssueCode;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofShape;

// Shares of the roof's height and run; docs/roofs.md has them.
constexpr double kGableShare = 0.6;        ///< of H: where a half-hip begins, a gablet as well
constexpr int kVaultSteps = 5;             ///< pitches of a round roof

// Which edges are the ends of wings.
constexpr double kWidestEnd = 30;          ///< m. A wider end is no gable of a wing but the side of a hall.
constexpr double kLeastCosine = -0.70710678118654752;  ///< corners of an end from 45 to 135 degrees
constexpr double kMostCosine = 0.70710678118654752;
constexpr double kCompact = 0.88;          ///< of the hull's area: a plan with recesses and bends, but one wing (an L has 0.8)
constexpr double kAlmostCompact = 0.7;     ///< ... and one in which no end of a wing was found
constexpr double kAlongAxis = 0.94;        ///< cosine of 20 degrees: pieces of a bent end wall
constexpr double kEndZone = 0.25;          ///< of the plan's length: an end wall with a recess
constexpr double kSquareEnough = 0.8660254037844386;   ///< cosine of the 30 degrees by which a ridge may leave its end obliquely

/// The plan's edges, ring by ring.
struct Edge {
  Point2 from, to, before, after;  ///< with the neighbouring corners
  double length = 0;
  Point2 outwards() const { return {(to.y - from.y) / length, -(to.x - from.x) / length}; }
};

std::vector<Edge> edges_of(const Polygon& plan) {
  std::vector<Edge> out;
  const auto add = [&](const model::Ring& ring) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      Edge e{ring.points[i], ring.points[(i + 1) % n], ring.points[(i + n - 1) % n], ring.points[(i + 2) % n], 0};
      const double dx = e.to.x - e.from.x, dy = e.to.y - e.from.y;
      e.length = std::sqrt(dx * dx + dy * dy);
      out.push_back(e);
    }
  };
  add(plan.outer);
  for (const model::Ring& hole : plan.holes) add(hole);
  return out;
}

int turn(Point2 a, Point2 b, Point2 c) {
  return geometry::orientation(geometry::to_grid(a), geometry::to_grid(b), geometry::to_grid(c));
}

/// The plan's area by that of its convex hull; 0 with holes.
double compactness(const Polygon& plan) {
  if (!plan.holes.empty()) return 0;
  std::vector<Point2> points = plan.outer.points;
  std::sort(points.begin(), points.end());
  std::vector<Point2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const Point2 p : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return geometry::signed_area(plan.outer.points) / geometry::signed_area(hull);
}

/// Cosine of the angle at b.
double cosine(Point2 a, Point2 b, Point2 c) {
  const double ux = a.x - b.x, uy = a.y - b.y, vx = c.x - b.x, vy = c.y - b.y;
  return (ux * vx + uy * vy) / std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
}
bool end_corner(Point2 a, Point2 b, Point2 c) {
  const double k = cosine(a, b, c);
  return turn(a, b, c) > 0 && k >= kLeastCosine && k <= kMostCosine;
}

/// Keeps of candidates that share a corner the shorter one.
std::vector<std::uint32_t> without_neighbours(const std::vector<Edge>& edges, std::vector<std::uint32_t> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [&](std::uint32_t a, std::uint32_t b) {
    return edges[a].length != edges[b].length ? edges[a].length < edges[b].length : a < b;
  });
  std::vector<std::uint32_t> kept;
  for (const std::uint32_t c : candidates) {
    const bool beside = std::any_of(kept.begin(), kept.end(), [&](std::uint32_t k) {
      return k == c || edges[k].to == edges[c].from || edges[c].to == edges[k].from;
    });
    if (!beside) kept.push_back(c);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

std::vector<EdgeProfile> profiles(std::size_t edges, EdgeProfile eaves, const std::vector<std::uint32_t>& ends, EdgeProfile end) {
  std::vector<EdgeProfile> out(edges, eaves);
  for (const std::uint32_t e : ends) out[e] = end;
  return out;
}

EdgeProfile upright() { return {kUpright, {}}; }
EdgeProfile pitch(double slope) { return {slope, {}}; }

/// A quarter of an ellipse over `run`, rising to `height`, in chords of equal angle.
EdgeProfile vault(double run, double height) {
  constexpr double kQuarter = 1.57079632679489661923;
  EdgeProfile out;
  double x = 0, z = 0;
  for (int i = 1; i <= kVaultSteps; ++i) {
    const double angle = kQuarter * i / kVaultSteps;
    const double to_x = run * (1 - base::cos(angle)), to_z = height * base::sin(angle);
    const double slope = (to_z - z) / (to_x - x);
    if (i == 1)
      out.slope = slope;
    else
      out.changes.push_back({z, slope});
    x = to_x;
    z = to_z;
  }
  return out;
}
EdgeProfile broken(double run, double height) {
  const double low = kMansardHeight * height / (kMansardRun * run);
  return {low, {{kMansardHeight * height, (1 - kMansardHeight) * height / ((1 - kMansardRun) * run)}}};
}

Roof to_roof(const Polygon& plan, const WeightedSkeleton& skeleton, RoofMeasures measures, double coarseness) {
  const double top = skeleton.height();
  const auto surfaces = geometry::roof_surfaces(plan, skeleton, top > 0 ? measures.height / top : 0, coarseness);
  const auto raised = [&](Point3 p) { return Point3{p.x, p.y, measures.eaves + p.z}; };
  Roof roof;
  for (const auto& s : surfaces.surfaces) {
    Roof::Surface out;
    out.edge = s.edge == geometry::WeightedSkeletonFace::kDeck ? -1 : static_cast<std::int32_t>(s.edge);
    out.upright = s.upright;
    for (const auto& loop : s.loops) {
      out.loops.emplace_back();
      for (const Point3 p : loop) out.loops.back().push_back(raised(p));
    }
    roof.surfaces.push_back(std::move(out));
  }
  for (const auto& top_points : surfaces.wall_tops) {
    roof.wall_tops.emplace_back();
    for (auto p = top_points.rbegin(); p != top_points.rend(); ++p) roof.wall_tops.back().push_back(raised(*p));
  }
  return roof;
}

/// CGAL's skeleton in our form.
std::optional<WeightedSkeleton> by_cgal(const Polygon& plan) {
  const auto skeleton = geometry::straight_skeleton(plan);
  if (!skeleton) return std::nullopt;
  WeightedSkeleton out;
  for (const auto& n : skeleton->nodes) out.nodes.push_back({n.point, n.time});
  for (const auto& f : skeleton->faces) {
    geometry::WeightedSkeletonFace face;
    face.edge = f.edge;
    face.loops.push_back(f.nodes);
    out.faces.push_back(std::move(face));
  }
  out.merged.resize(skeleton->faces.size());
  std::iota(out.merged.begin(), out.merged.end(), 0u);
  return out;
}

using Skeleton = tl::expected<WeightedSkeleton, geometry::SkeletonFailure>;

/// Everything about one plan that shapes ask for.
class Builder {
 public:
  Builder(const Polygon& plan, const RoofRequest& request) : plan_(plan), request_(request), edges_(edges_of(plan)) {}

  std::vector<std::uint32_t> ends() const {
    const double compact = compactness(plan_);
    if (compact >= kCompact) return axis_ends();
    const auto hips = geometry::weighted_skeleton(plan_, profiles(edges_.size(), pitch(1), {}, {}));
    if (!hips) return {};
    const auto surfaces = geometry::roof_surfaces(plan_, *hips, 1).surfaces;
    std::vector<std::uint32_t> found;
    for (const auto& s : surfaces) {
      if (s.loops[0].size() != 3) continue;
      const Edge& e = edges_[s.edge];
      if (e.length <= kWidestEnd && end_corner(e.before, e.from, e.to) && end_corner(e.from, e.to, e.after) &&
          ridge_leaves(surfaces, s.loops[0], e))
        found.push_back(s.edge);
    }
    if (found.empty() && compact >= kAlmostCompact) return axis_ends();
    return without_neighbours(edges_, std::move(found));
  }

  std::optional<BuiltRoof> build() {
    // Profiles rise to the largest run, at 45 degrees on the whole; the skeleton's plan depends on the ratios of slopes alone, and
    // heights are scaled to what is asked at the end.
    const std::size_t n = edges_.size();
    switch (request_.shape) {
      case RoofShape::hipped:
        return finish(geometry::weighted_skeleton(plan_, profiles(n, pitch(1), {}, {})));
      case RoofShape::gabled:
        ends_ = ends();
        return finish(geometry::weighted_skeleton(plan_, profiles(n, pitch(1), ends_, upright())), true);
      case RoofShape::side_hipped:
      case RoofShape::side_half_hipped:
      case RoofShape::half_hipped:
      case RoofShape::hipped_and_gabled:
        return with_treated_ends();
      case RoofShape::mansard: {
        const double run = largest_run({});
        return run > 0 ? finish(geometry::weighted_skeleton(plan_, profiles(n, broken(run, run), {}, {}))) : fallback();
      }
      case RoofShape::gambrel:
      case RoofShape::round: {
        ends_ = ends();
        const double run = largest_run(ends_);
        if (run <= 0) return fallback();
        const EdgeProfile eaves = request_.shape == RoofShape::round ? vault(run, run) : broken(run, run);
        return finish(geometry::weighted_skeleton(plan_, profiles(n, eaves, ends_, upright())), true);
      }
      case RoofShape::double_saltbox:
      case RoofShape::quadruple_saltbox: {
        if (request_.shape == RoofShape::double_saltbox) ends_ = ends();
        const double run = largest_run(ends_);
        if (run <= 0) return fallback();
        return finish(geometry::weighted_skeleton(plan_, profiles(n, pitch(1 / kDeckRun), ends_, upright()), run),
                      request_.shape == RoofShape::double_saltbox);
      }
      case RoofShape::dome:
      case RoofShape::onion: {
        const double run = largest_run({});
        return run > 0 ? finish(geometry::weighted_skeleton(plan_, profiles(n, vault(run, run), {}, {}))) : fallback();
      }
      default:
        return std::nullopt;
    }
  }

 private:
  /// Does a ridge go on from the top of a hip's triangle, about square to its edge? A piece of a long wall between two
  /// steps has a triangle, too, but the ridge passes it.
  static bool ridge_leaves(const std::vector<geometry::RoofSurfaces::Surface>& surfaces, const std::vector<Point3>& triangle,
                           const Edge& edge) {
    Point3 top = triangle[0];
    for (const Point3 p : triangle)
      if (p.z > top.z) top = p;
    const Point2 out = edge.outwards();
    for (const auto& s : surfaces)
      for (const auto& loop : s.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const Point3 a = loop[i], b = loop[(i + 1) % loop.size()];
          if (a != top || b.z <= 0) continue;
          const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
          if (-(dx * out.x + dy * out.y) >= kSquareEnough * length) return true;
        }
    return false;
  }

  /// The two ends of a plan that is one wing: the walls that look along its axis and against it.
  std::vector<std::uint32_t> axis_ends() const {
    const Point2 axis = ridge_axis(plan_, request_);
    const auto count = static_cast<std::uint32_t>(plan_.outer.size());
    std::vector<std::uint32_t> found;
    for (const double way : {1.0, -1.0}) {
      const Point2 towards{way * axis.x, way * axis.y};
      const geometry::Extent extent = geometry::extent_along(plan_.outer.points, towards);
      const double zone = extent.maximum - kEndZone * (extent.maximum - extent.minimum);
      std::uint32_t best = 0;
      double most = -2;
      std::vector<char> looks_along(count, 0);
      for (std::uint32_t i = 0; i < count; ++i) {
        const Edge& e = edges_[i];
        const Point2 out = e.outwards();
        const double looks = out.x * towards.x + out.y * towards.y;
        const double place = ((e.from.x + e.to.x) * towards.x + (e.from.y + e.to.y) * towards.y) / 2;
        looks_along[i] = looks >= kAlongAxis && place >= zone;
        // Of several that look alike, as on a regular plan, the first.
        constexpr double kAlike = 1e-3;
        if (place >= zone && looks > most + kAlike) {
          most = looks;
          best = i;
        }
      }
      looks_along[best] = 1;
      for (std::uint32_t i = 0; i < count; ++i)
        if (looks_along[i]) found.push_back(i);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    // The two ends of a triangle share a corner: the shorter one is it.
    return found.size() == 2 ? without_neighbours(edges_, std::move(found)) : found;
  }

  /// The farthest that a point of the plan lies from the eaves that rise to it, m; 0 when there is no skeleton.
  double largest_run(const std::vector<std::uint32_t>& ends) const {
    const auto s = geometry::weighted_skeleton(plan_, profiles(edges_.size(), pitch(1), ends, upright()));
    return s ? s->height() : 0;
  }

  std::optional<BuiltRoof> with_treated_ends() {
    ends_ = ends();
    const double run = largest_run(ends_);
    if (run <= 0) return fallback();
    const double slope = 1, change = kGableShare * run;
    std::vector<EdgeProfile> all = profiles(edges_.size(), pitch(slope), ends_, upright());
    const EdgeProfile half_hip{kUpright, {{change, slope}}};
    switch (request_.shape) {
      case RoofShape::half_hipped:
        for (const std::uint32_t e : ends_) all[e] = half_hip;
        break;
      case RoofShape::hipped_and_gabled:
        for (const std::uint32_t e : ends_) all[e] = {slope, {{change, kUpright}}};
        break;
      default:
        if (const auto one = single_end()) all[*one] = request_.shape == RoofShape::side_hipped ? pitch(slope) : half_hip;
    }
    return finish(geometry::weighted_skeleton(plan_, all), true);
  }

  /// The end that looks down most where a direction is tagged, the longest otherwise.
  std::optional<std::uint32_t> single_end() const {
    std::optional<std::uint32_t> best;
    double most = 0;
    for (const std::uint32_t e : ends_) {
      const Point2 out = edges_[e].outwards();
      const double value = request_.down ? 2 + out.x * request_.down->x + out.y * request_.down->y : edges_[e].length;
      constexpr double kAlike = 0.01;  // m, or cosine: rounding decides nothing
      if (!best || value > most + kAlike) {
        best = e;
        most = value;
      }
    }
    return best;
  }

  std::optional<BuiltRoof> finish(const Skeleton& skeleton, bool wants_ends = false) {
    if (!skeleton) return fallback();
    BuiltRoof out{to_roof(plan_, *skeleton, request_.measures, request_.coarseness), request_.shape, IssueCode::none, {}};
    if (wants_ends && ends_.empty() && plan_.holes.empty()) {
      out.note = IssueCode::roof_shape_adapted;
      out.detail = std::string(model::name(request_.shape)) + " without gables: no wing has an end";
    }
    return out;
  }

  std::optional<BuiltRoof> fallback() const {
    const auto skeleton = by_cgal(plan_);
    if (!skeleton) return std::nullopt;
    return BuiltRoof{to_roof(plan_, *skeleton, request_.measures, request_.coarseness), RoofShape::hipped, IssueCode::skeleton_fallback,
                     std::string(model::name(request_.shape)) + " as hipped"};
  }

  const Polygon& plan_;
  const RoofRequest& request_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> ends_;
};

}  // namespace

bool is_one_wing(const Polygon& plan) { return compactness(plan) >= kCompact; }

Point2 ridge_axis(const Polygon& plan, const RoofRequest& request) {
  Point2 axis = geometry::long_axis(plan.outer.points);
  const double along = request.down ? std::fabs(request.down->x * axis.x + request.down->y * axis.y) : 0;
  const double across = request.down ? std::fabs(request.down->x * axis.y - request.down->y * axis.x) : 0;
  const bool turned = request.down ? along > across : request.across;
  if (turned) axis = {-axis.y, axis.x};
  return axis;
}

bool rises_from_edges(RoofShape shape) {
  switch (shape) {
    case RoofShape::hipped:
    case RoofShape::gabled:
    case RoofShape::side_hipped:
    case RoofShape::side_half_hipped:
    case RoofShape::half_hipped:
    case RoofShape::hipped_and_gabled:
    case RoofShape::mansard:
    case RoofShape::gambrel:
    case RoofShape::round:
    case RoofShape::double_saltbox:
    case RoofShape::quadruple_saltbox:
      return true;
    default:
      return false;
  }
}

std::vector<std::uint32_t> wing_ends(const Polygon& plan, const RoofRequest& request) { return Builder(plan, request).ends(); }

std::optional<BuiltRoof> skeleton_roof(const Polygon& plan, const RoofRequest& request) {
  if (!rises_from_edges(request.shape)) return std::nullopt;
  return Builder(plan, request).build();
}

std::optional<BuiltRoof> vaulted_roof(const Polygon& plan, const RoofRequest& request) { return Builder(plan, request).build(); }

}  // namespace blockrand::roofs
