#include "pipeline/surroundings/street_markings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/line_strips.h"
#include "pipeline/surroundings/street_profile.h"

namespace blockrand::surroundings {
namespace {

using model::FlatPolygon;
using model::Point2;
namespace osm_key = model::osm_key;

// Markings, m [RMS, FGSV 1993: narrow lines 0.12, within towns dashes of 3 with gaps of 6; crossings of stripes of 0.50, 3 to 4 long;
// stop lines 0.50 wide, give-way lines of 0.50 with gaps of 0.25].
constexpr double kLine = 0.12, kDash = 3, kDashPeriod = 9, kStripe = 0.5, kZebraLength = 3.5, kPaint = 0.012;
constexpr double kStopLine = 0.5, kGiveWayDash = 0.5, kGiveWayPeriod = 0.75;
/// m: distance of a stop line from the crossing or the junction behind it [RMS: 1].
constexpr double kStopFree = 1;
/// m: a stop line keeps off the kerb and off the line between the directions.
constexpr double kStopInset = 0.15;
/// m: pieces of a stop line, which follow the ground.
constexpr double kStopPiece = 1;
/// m. A longer straight line is no street.
constexpr double kMostMarked = 20000;
constexpr double kJunctionFree = 12, kCrossingFree = 5;
/// m: carriageways narrower than this have no lines between lanes and no crossings; than that, no stop lines.
constexpr double kMarkedWidth = 4, kStopWidth = 2.5;
/// m along a way: a control without a direction is one of the nearest junction within it.
constexpr double kNearJunction = 40;
/// m: how far a junction of wide streets reaches from its node at most, and the step it is looked through.
constexpr double kMostJunction = 25, kLookStep = 0.5;
/// m: a crossing this far behind the place of a stop line is one that it lies before.
constexpr double kCrossingBehind = 6;

class Markings {
 public:
  Markings(const BodySite& site, const Thing& thing)
      : site_(site), thing_(thing), tag_(site.claims.tags_of(thing.feature)) {}

  std::vector<FlatPolygon> make() {
    const std::optional<StreetProfile> profile = street_profile(tag_, true, site_.in.catalogue, thing_.keeps_left);
    if (!profile || profile->carriageway_right - profile->carriageway_left < kStopWidth) return {};
    left_ = profile->carriageway_left, right_ = profile->carriageway_right;
    outer_left_ = left_, outer_right_ = right_;
    for (const StreetStrip& strip : profile->strips)
      if (is_traffic(strip.ground))
        outer_left_ = std::min(outer_left_, strip.left), outer_right_ = std::max(outer_right_, strip.right);
    const model::Feature& feature = site_.in.extract.features[thing_.feature];
    const auto rings = site_.in.extract.rings_of(feature.rings);
    const auto lines = site_.claims.lines_of(thing_);
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const auto nodes = site_.in.extract.nodes_of(rings[l]);
      if (lines[l].size() < 2 || nodes.size() != lines[l].size()) continue;
      const OffsetLine line(lines[l]);
      std::vector<double> junctions, crossings;  // places along the line, m
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (site_.claims.streets_at(nodes[i]) > 2) junctions.push_back(line.along(i));
        if (site_.claims.crossing_at(nodes[i]) != CrossingMarking::none) crossings.push_back(line.along(i));
      }
      if (right_ - left_ >= kMarkedWidth) {
        for (std::size_t i = 0; i < line.size(); ++i) crossing(line, i, site_.claims.crossing_at(nodes[i]));
        between_lanes(line, lane_count(*profile), junctions, crossings);
      }
      stop_lines(line, nodes, junctions, crossings);
    }
    return std::move(faces_);
  }

 private:
  static bool is_traffic(model::GroundClass ground) {
    return ground == model::GroundClass::carriageway || ground == model::GroundClass::parking_lane;
  }

  int lane_count(const StreetProfile& profile) const {
    const std::string_view highway = tag_(osm_key::kHighway);
    constexpr std::array<std::string_view, 10> kMarked{"motorway",       "trunk",         "primary",    "secondary",
                                                       "tertiary",       "motorway_link", "trunk_link", "primary_link",
                                                       "secondary_link", "tertiary_link"};
    int lanes = profile.lanes;
    const bool main_street = std::ranges::find(kMarked, highway) != kMarked.end();
    const std::string_view oneway = tag_(osm_key::kOneway);
    if (lanes == 0 && main_street && (oneway.empty() || oneway == "no") && right_ - left_ >= 5.5) lanes = 2;
    if (!main_street && (lanes < 2 || right_ - left_ < 2.75 * lanes)) lanes = 0;
    return lanes;
  }

  /// A rectangle on the carriageway around a point of a line's direction. \param along, across  m, of its sides
  void paint(Point2 centre, Point2 direction, double along, double across) {
    if (!site_.is_own(centre)) return;
    const GroundAt at = site_.ground(centre);
    if (at.building || at.ground != model::GroundClass::carriageway) return;
    FlatPolygon face;
    constexpr double kCorners[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    for (const auto& c : kCorners) {
      const Point2 p = model::snap(Point2{centre.x + c[0] * along * direction.x - c[1] * across * direction.y,
                                          centre.y + c[0] * along * direction.y + c[1] * across * direction.x});
      const GroundAt corner = site_.ground(p);
      if (corner.building || corner.ground != model::GroundClass::carriageway) return;
      face.outer.push_back({p.x, p.y, model::snap(corner.height + kPaint)});
    }
    faces_.push_back({{face.outer[0], face.outer[1], face.outer[2]}, {}});
    faces_.push_back({{face.outer[0], face.outer[2], face.outer[3]}, {}});
  }

  void crossing(const OffsetLine& offset, std::size_t i, CrossingMarking marking) {
    if (marking == CrossingMarking::none) return;
    const std::vector<Point2>& line = offset.points();
    const std::size_t from = i > 0 ? i - 1 : 0, to = std::min(i + 1, line.size() - 1);
    const double dx = line[to].x - line[from].x, dy = line[to].y - line[from].y, length = std::hypot(dx, dy);
    if (!(length > 0)) return;
    const Point2 d{dx / length, dy / length};
    const auto at = [&](double ahead, double to_right) {
      return Point2{line[i].x + ahead * d.x + to_right * d.y, line[i].y + ahead * d.y - to_right * d.x};
    };
    if (marking == CrossingMarking::zebra) {
      for (double side = left_ + kStripe; side < right_ - kStripe / 2; side += 2 * kStripe)
        paint(at(0, side), d, kZebraLength, kStripe);
      return;
    }
    // Two broken lines across, dashes of a length with their gaps.
    for (const double ahead : {-kZebraLength / 2, kZebraLength / 2})
      for (double side = left_ + kStripe; side < right_ - kStripe / 2; side += 2 * kStripe)
        paint(at(ahead, side), d, kLine, kStripe);
  }

  void between_lanes(const OffsetLine& offset, int lanes, const std::vector<double>& junctions,
                     const std::vector<double>& crossings) {
    const std::vector<Point2>& line = offset.points();
    const auto is_free = [&](double s) {
      return std::ranges::none_of(junctions, [&](double j) { return std::fabs(j - s) < kJunctionFree; }) &&
             std::ranges::none_of(crossings, [&](double c) { return std::fabs(c - s) < kCrossingFree; });
    };
    for (int lane = 1; lane < lanes; ++lane) {
      const double side = left_ + (right_ - left_) * lane / lanes;
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double from = offset.along(i), to = offset.along(i + 1), length = to - from;
        geometry::PlanBox own_box;
        own_box.include(line[i]), own_box.include(line[i + 1]);
        if (!(length > 0) || length > kMostMarked || !own_box.near(site_.around, 0)) continue;
        const Point2 d{(line[i + 1].x - line[i].x) / length, (line[i + 1].y - line[i].y) / length};
        // Dashes lie where they lie along the whole line, whatever its points.
        for (double s = std::floor(from / kDashPeriod) * kDashPeriod + kDash / 2; s < to; s += kDashPeriod) {
          if (s < from || !is_free(s)) continue;
          const double own = std::min({kDash, 2 * (s - from), 2 * (to - s)});
          if (own < 1) continue;
          paint({line[i].x + (s - from) * d.x + side * d.y, line[i].y + (s - from) * d.y - side * d.x}, d, own, kLine);
        }
      }
    }
  }

  // ---- stop lines

  /// A place on a line and its direction there.
  struct Along {
    Point2 place, direction;
    Point2 beside(double to_right) const {
      return {place.x + to_right * direction.y, place.y - to_right * direction.x};
    }
  };
  static std::optional<Along> along(const OffsetLine& line, double s) {
    if (s < 0 || s > line.length()) return std::nullopt;
    std::size_t i = 0;
    while (i + 2 < line.size() && line.along(i + 1) < s) ++i;
    const Point2 a = line.points()[i], b = line.points()[i + 1];
    const double length = line.along(i + 1) - line.along(i), t = s - line.along(i);
    if (!(length > 0)) return std::nullopt;
    const Point2 d{(b.x - a.x) / length, (b.y - a.y) / length};
    return Along{{a.x + t * d.x, a.y + t * d.y}, d};
  }

  void stop_lines(const OffsetLine& line, std::span<const std::int64_t> nodes, const std::vector<double>& junctions,
                  const std::vector<double>& crossings) {
    std::vector<double> controls;
    for (std::size_t i = 0; i < line.size(); ++i)
      if (site_.claims.control_at(nodes[i]).kind != ControlKind::none) controls.push_back(line.along(i));
    const std::string_view oneway = tag_(osm_key::kOneway);
    const bool only_forward =
                   oneway == "yes" || oneway == "1" || oneway == "true" || tag_(osm_key::kJunction) == "roundabout",
               only_backward = oneway == "-1" || oneway == "reverse";
    for (std::size_t i = 0; i < line.size(); ++i) {
      const StreetControl control = site_.claims.control_at(nodes[i]);
      if (control.kind == ControlKind::none) continue;
      geometry::PlanBox box;
      box.include(line.points()[i]);
      if (!box.near(site_.around, kMostJunction + kCrossingBehind + kZebraLength)) continue;
      const double at = line.along(i);
      const bool junction = site_.claims.streets_at(nodes[i]) > 2;
      bool forward = control.forward, backward = control.backward;
      if (junction) {
        // Who must stop at the sign of a junction is not told by its node.
        if (control.kind != ControlKind::signals) continue;
        forward = backward = true;
      } else if (!forward && !backward) {
        double ahead = kNearJunction, behind = kNearJunction;
        for (const double j : junctions) {
          if (j > at) ahead = std::min(ahead, j - at);
          if (j < at) behind = std::min(behind, at - j);
        }
        forward = ahead < behind, backward = behind < ahead;
        // Far from junctions they are those of a crossing.
        if (ahead == behind && control.kind == ControlKind::signals) forward = backward = true;
      }
      if (only_forward) backward = false;
      if (only_backward) forward = false;
      for (const int sense : {1, -1}) {
        if (!(sense > 0 ? forward : backward)) continue;
        std::optional<double> s = at;
        if (junction) {
          // A control of its own on this way tells more.
          if (std::ranges::any_of(controls, [&](double c) {
                const double before = (at - c) * sense;
                return before > 0 && before < kNearJunction;
              }))
            continue;
          s = mouth(line, at, sense);
        } else if (control.crossing) {
          s = at - sense * (kZebraLength / 2 + kStopFree);
        }
        if (!s) continue;
        for (const double c : crossings) {
          const double ahead = (c - *s) * sense;
          const double back = c - sense * (kZebraLength / 2 + kStopFree);
          if (ahead > -kCrossingBehind && (back - *s) * sense < 0) s = back;
        }
        stop_line(line, *s, sense, only_forward || only_backward, control.kind);
      }
    }
  }

  /// Where a way comes to the junction at a place of it: what lies beside it is no carriageway any more.
  std::optional<double> mouth(const OffsetLine& line, double at, int sense) const {
    for (double back = kLookStep; back <= kMostJunction; back += kLookStep) {
      const std::optional<Along> here = along(line, at - sense * back);
      if (!here) return std::nullopt;
      bool free = true;
      for (const double side : {outer_left_ - 2 * kLookStep, outer_right_ + 2 * kLookStep}) {
        const GroundAt beside = site_.ground(here->beside(side));
        free = free && (beside.building || !is_traffic(beside.ground));
      }
      if (free) return at - sense * (back + kStopFree);
    }
    return std::nullopt;
  }

  /// \param sense  1: across the lanes that lead along the line
  void stop_line(const OffsetLine& line, double s, int sense, bool all_lanes, ControlKind kind) {
    const std::optional<Along> at = along(line, s);
    if (!at) return;
    const double middle = (left_ + right_) / 2;
    const bool right_half = (sense > 0) != thing_.keeps_left;
    const double from = (all_lanes || !right_half ? left_ : middle) + kStopInset;
    const double to = (all_lanes || right_half ? right_ : middle) - kStopInset;
    if (to - from < kStopPiece) return;
    if (kind == ControlKind::give_way) {
      for (double side = from + kGiveWayDash / 2; side + kGiveWayDash / 2 <= to; side += kGiveWayPeriod)
        paint(at->beside(side), at->direction, kStopLine, kGiveWayDash);
      return;
    }
    const double pieces = std::ceil((to - from) / kStopPiece), piece = (to - from) / pieces;
    for (double k = 0; k < pieces; ++k) paint(at->beside(from + (k + 0.5) * piece), at->direction, kStopLine, piece);
  }

  const BodySite& site_;
  const Thing& thing_;
  TagOf tag_;
  double left_ = 0, right_ = 0;              ///< m, of the lanes
  double outer_left_ = 0, outer_right_ = 0;  ///< m, with parking lanes
  std::vector<FlatPolygon> faces_;
};

}  // namespace

std::optional<model::SurroundingBody> street_markings(const BodySite& site, const Thing& thing) {
  std::vector<FlatPolygon> faces = Markings(site, thing).make();
  if (faces.empty()) return std::nullopt;
  model::SurroundingBody made = body_of(site, thing, model::BodyClass::marking, "marking_white");
  made.faces = std::move(faces);
  return made;
}

}  // namespace blockrand::surroundings
