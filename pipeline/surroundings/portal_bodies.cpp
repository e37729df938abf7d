#include "pipeline/surroundings/portal_bodies.h"

#include <algorithm>
#include <cmath>

#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/street_profile.h"

namespace blockrand::surroundings {
namespace {

using model::FlatPolygon;
using model::Point2;
using model::Point3;
namespace osm_key = model::osm_key;

// m: clear heights [RASt 06: streets 4.50, footways and cycleways 2.50; EBO: tracks with overhead lines 5.5], half of the clear width
// of a track [EBO: 2.2 to 2.5].
constexpr double kStreetHeight = 4.5, kFootHeight = 2.5, kTrackHeight = 5.5, kTrackHalf = 2.5;
/// m: width of the posts, depth of the frame, height of its beam [E].
constexpr double kPost = 0.5, kDepth = 0.8, kBeam = 0.8;
/// m: how deep in the frame it is dark.
constexpr double kDark = 0.7;
/// m: between the ways and the posts.
constexpr double kClear = 0.25;
/// m: how deep the frame reaches into the ground.
constexpr double kSunk = 0.3;
/// m: how far into the tunnel from the frame, and how far beside it, the ground is looked at.
constexpr double kInto = 2, kLook = 0.5;
/// m: a bend of the way nearer to its end does not turn the portal.
constexpr double kDirection = 3;

/// A place before and in a tunnel: metres into it, to the right, upwards.
struct Frame {
  Point2 origin, direction;
  double base = 0;
  Point2 plan(double into, double right) const {
    return {origin.x + into * direction.x + right * direction.y, origin.y + into * direction.y - right * direction.x};
  }
  Point3 at(double into, double right, double up) const {
    const Point2 p = model::snap(plan(into, right));
    return {p.x, p.y, model::snap(base + up)};
  }
};

void add_box(std::vector<FlatPolygon>& out, const Frame& f, double left, double right, double low, double high) {
  const auto p = [&](bool deep, bool is_right, bool top) {
    return f.at(deep ? kDepth : 0, is_right ? right : left, top ? high : low);
  };
  add_quad(out, p(false, false, false), p(false, true, false), p(false, true, true), p(false, false, true));
  add_quad(out, p(true, true, false), p(true, false, false), p(true, false, true), p(true, true, true));
  add_quad(out, p(false, true, false), p(true, true, false), p(true, true, true), p(false, true, true));
  add_quad(out, p(true, false, false), p(false, false, false), p(false, false, true), p(true, false, true));
  add_quad(out, p(false, false, true), p(false, true, true), p(true, true, true), p(true, false, true));
  add_quad(out, p(true, false, false), p(true, true, false), p(false, true, false), p(false, false, false));
}

}  // namespace

std::vector<model::SurroundingBody> portal_bodies(const BodySite& site, const Thing& thing) {
  const model::Feature& feature = site.in.extract.features[thing.feature];
  const TagOf tag = site.claims.tags_of(thing.feature);
  if (feature.area || feature.rings.count != 1 || tag(osm_key::kTunnel) != "yes") return {};
  double left = -kTrackHalf, right = kTrackHalf, height = kTrackHeight;
  const bool track = thing.kind == SurroundingKind::railway;
  if (track) {
    if (!is_track(tag(osm_key::kRailway))) return {};
  } else {
    const std::optional<StreetProfile> profile = street_profile(tag, false, site.in.catalogue, thing.keeps_left);
    if (thing.kind != SurroundingKind::tunnel || !profile || profile->strips.empty()) return {};
    left = profile->strips.front().left - kClear, right = profile->strips.back().right + kClear;
    const bool vehicles = std::ranges::any_of(
        profile->strips, [](const StreetStrip& s) { return s.ground == model::GroundClass::carriageway; });
    height = vehicles ? kStreetHeight : kFootHeight;
  }
  const auto nodes = site.in.extract.nodes_of(site.in.extract.rings_of(feature.rings)[0]);
  const std::vector<std::vector<Point2>> lines = site.claims.lines_of(thing);
  if (lines.empty() || lines[0].size() < 2 || nodes.size() < 2) return {};
  model::SurroundingBody frame = body_of(site, thing, model::BodyClass::other, "concrete");
  model::SurroundingBody dark = body_of(site, thing, model::BodyClass::other, "plastic_dark");
  for (const bool at_end : {false, true}) {
    const std::int64_t node = at_end ? nodes.back() : nodes.front();
    if ((track ? site.claims.tracks_at(node) : site.claims.streets_at(node)) == 0) continue;
    std::vector<Point2> line = lines[0];
    if (at_end) std::ranges::reverse(line);
    if (!site.is_own(line[0])) continue;
    std::size_t ahead = 1;
    while (ahead + 1 < line.size() && std::hypot(line[ahead].x - line[0].x, line[ahead].y - line[0].y) < kDirection)
      ++ahead;
    const double dx = line[ahead].x - line[0].x, dy = line[ahead].y - line[0].y, length = std::hypot(dx, dy);
    if (!(length > 0)) continue;
    // Seen along the way into the tunnel its left and right change at its end.
    const double l = at_end ? -right : left, r = at_end ? -left : right;
    const Frame f{line[0], {dx / length, dy / length}, site.ground(line[0]).height};
    bool free = true;
    for (double side = l - kPost; side <= r + kPost && free; side += kLook)
      for (const double into : {0.0, kDepth, kInto}) free = free && !site.ground(f.plan(into, side)).building;
    // The street before it ends in a half circle.
    const GroundAt over = site.ground(f.plan(std::max(-l, r) + kInto, 0));
    using enum model::GroundClass;
    if (!free || over.building || over.ground == carriageway || over.ground == parking_lane ||
        over.ground == rail_bed || over.ground == cycle_way || over.ground == water)
      continue;
    add_box(frame.faces, f, l - kPost, l, -kSunk, height);
    add_box(frame.faces, f, r, r + kPost, -kSunk, height);
    add_box(frame.faces, f, l - kPost, r + kPost, height, height + kBeam);
    add_quad(dark.faces, f.at(kDark, l, -kSunk), f.at(kDark, r, -kSunk), f.at(kDark, r, height),
             f.at(kDark, l, height));
    add_quad(frame.faces, f.at(kDepth, r, -kSunk), f.at(kDepth, l, -kSunk), f.at(kDepth, l, height),
             f.at(kDepth, r, height));
  }
  std::vector<model::SurroundingBody> out;
  if (frame.faces.empty()) return out;
  out.push_back(std::move(frame)), out.push_back(std::move(dark));
  return out;
}

}  // namespace blockrand::surroundings
