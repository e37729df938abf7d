#include "pipeline/validate/positions.h"

#include <algorithm>
#include <cmath>

#include "importers/osm/read_extract.h"
#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/earth.h"

namespace blockrand::validate {
namespace {

constexpr double kLeastTurn = 10;             // degrees
constexpr double kLeastEdge = 0.5;            // m
constexpr double kNearestToPole = 89.999;     // degrees: a hundred metres
constexpr double kMetresPerUnit = 0.0111319;  // 1e-7 degrees of latitude

constexpr double kRoundedPlaces = 0.02;  // m: moved places are rounded to 1e-7 degrees, twice
constexpr double kWritten = 0.0005;      // m: shifts are written in millimetres
constexpr double kStill = 0.002;         // m: outlines are written in millimetres
constexpr double kStraight = 0.02;       // m: flatter corners are points on a straight wall
// The median of n values that spread normally by s has the standard error 1.2533 s / sqrt(n); s is 1.4826 times their
// median distance from their median. Three of them: one sound build in 370 is beyond by chance, along one axis.
constexpr double kThreeErrorsOfMedian = 3 * 1.2533 * 1.4826;

double median_of(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

std::uint64_t mix(std::uint64_t h) {
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return h ^ (h >> 31);
}

std::uint64_t rank_of(const std::string& body, model::Location at) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  for (const char c : body) h = mix(h ^ static_cast<unsigned char>(c));
  return mix(
      h ^ (static_cast<std::uint64_t>(static_cast<std::uint32_t>(at.lon)) << 32 | static_cast<std::uint32_t>(at.lat)));
}

/// The walls of one ring that stands in two lists of numbers x, y, x, y ...; as many as are whole in both.
void add_walls(const Json* before, const Json* after, MovementSaid& said) {
  if (!before || !after || !before->is_array() || !after->is_array()) return;
  std::vector<std::pair<model::Point2, model::Point2>> corners;
  for (std::uint64_t i = 0; i + 1 < std::min(before->size(), after->size()); i += 2) {
    const auto x = number(element(before, i)), y = number(element(before, i + 1)), u = number(element(after, i)),
               v = number(element(after, i + 1));
    if (!x || !y || !u || !v) return;
    const model::Point2 rigid = said.rigid({*x, *y});
    model::Point2 by{*u - rigid.x, *v - rigid.y};
    if (std::hypot(by.x, by.y) <= kStill) by = {};
    corners.push_back({{*x, *y}, by});
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    said.walls.push_back({a.first, b.first, a.second, b.second});
  }
}

}  // namespace

model::Point2 MovementSaid::rigid(model::Point2 p) const {
  const double s = std::sin(turn * kRadians), c = std::cos(turn * kRadians), x = p.x - centre.x, y = p.y - centre.y;
  return {centre.x + x * c - y * s + shift.x, centre.y + x * s + y * c + shift.y};
}

model::Point2 MovementSaid::operator()(model::Point2 p) const {
  model::Point2 to = rigid(p), by;
  double nearest = -1;
  for (const Wall& w : walls) {
    const double dx = w.end.x - w.begin.x, dy = w.end.y - w.begin.y, squared = dx * dx + dy * dy;
    const double share = squared <= 0 ? 0 : ((p.x - w.begin.x) * dx + (p.y - w.begin.y) * dy) / squared,
                 t = std::clamp(share, 0.0, 1.0);
    const double distance = std::hypot(p.x - w.begin.x - t * dx, p.y - w.begin.y - t * dy);
    if (nearest >= 0 && distance >= nearest) continue;
    nearest = distance;
    by = {w.begin_by.x * (1 - t) + w.end_by.x * t, w.begin_by.y * (1 - t) + w.end_by.y * t};
  }
  return {to.x + by.x, to.y + by.y};
}

void PositionSampler::add(const std::string& body, const std::vector<model::Location>& ring) {
  if (ring.size() < 3) return;
  const double scale = std::cos(ring[0].lat_degrees() * kRadians) * kMetresPerUnit;
  const auto edge = [&](model::Location a, model::Location b) {
    // Across 180 degrees the difference is a turn too much.
    const double turns = std::nearbyint((static_cast<double>(b.lon) - a.lon) / 3.6e9);
    return model::Point2{(static_cast<double>(b.lon) - a.lon - turns * 3.6e9) * scale,
                         (static_cast<double>(b.lat) - a.lat) * kMetresPerUnit};
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const model::Location at = ring[i];
    // On a pole longitude says nothing, so the turn of a corner cannot be told from it.
    if (std::fabs(at.lat_degrees()) > kNearestToPole) continue;
    const model::Point2 u = edge(ring[(i + ring.size() - 1) % ring.size()], at),
                        v = edge(at, ring[(i + 1) % ring.size()]);
    if (std::hypot(u.x, u.y) < kLeastEdge || std::hypot(v.x, v.y) < kLeastEdge) continue;
    const double turn = std::fabs(std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y)) / kRadians;
    if (turn < kLeastTurn || turn > 180 - kLeastTurn) continue;
    // Of the triangle of the corner and its neighbours.
    const double height = std::fabs(u.x * v.y - u.y * v.x) / std::hypot(u.x + v.x, u.y + v.y);
    candidates_.push_back({rank_of(body, at), body, at, height});
  }
  if (candidates_.size() > 20 * kSampled) shrink();
}

void PositionSampler::shrink() {
  if (candidates_.size() <= kSampled) return;
  std::nth_element(candidates_.begin(), candidates_.begin() + kSampled, candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
  candidates_.resize(kSampled);
}

PositionSample PositionSampler::finish(std::string source) && {
  shrink();
  PositionSample sample;
  sample.source = std::move(source);
  std::vector<double> lons, lats;
  for (Candidate& c : candidates_) {
    lons.push_back(c.at.lon_degrees());
    lats.push_back(c.at.lat_degrees());
    sample.corners[c.body].push_back({c.at, c.rank, c.height});
  }
  if (lons.empty()) return sample;
  const auto middle = [](std::vector<double>& v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
  };
  sample.lon = middle(lons);
  sample.lat = middle(lats);
  sample.west = lons.front();
  sample.east = lons.back();
  sample.south = lats.front();
  sample.north = lats.back();
  return sample;
}

PositionSample sample_extract(const std::string& path, const std::optional<std::array<double, 4>>& bbox,
                              const std::set<std::string>& mended) {
  importers::osm::ReadOptions options;
  options.bbox = bbox;
  const model::Extract extract = importers::osm::read_extract(path, options);
  PositionSampler sampler;
  for (const model::MappedBuilding& b : extract.buildings) {
    if (b.kind != model::ObjectKind::building || b.state != model::ObjectState::pending || b.rings.count == 0) continue;
    const std::string id = b.id.text();
    if (mended.count(id)) continue;
    for (const model::MappedRing& ring : extract.rings_of(b.rings)) {
      if (ring.inner) continue;
      const auto vertices = extract.vertices_of(ring);
      sampler.add(id, {vertices.begin(), vertices.end()});
    }
  }
  return std::move(sampler).finish("the extract " + path);
}

PositionSample sample_explanations(const std::vector<std::string>& paths, const std::set<std::string>& mended) {
  PositionSampler sampler;
  for (const std::string& path : paths) {
    std::string why;
    const auto lines = content_of(path, why);
    if (!lines) continue;
    for (std::size_t at = 0; at < lines->size();) {
      const std::size_t end = std::min(lines->find('\n', at), lines->size());
      const auto line = parse_json(std::string_view(*lines).substr(at, end - at));
      at = end + 1;
      if (!line) continue;
      const std::string id = text(member(*line, "id"));
      const Json *outline = member(*line, "outline"), *bodies = member(*line, "bodies");
      const Json *lon = member(outline, "lon"), *lat = member(outline, "lat"), *rings = member(outline, "rings");
      if (mended.count(id) || !lon || !lat || !lon->is_array() || !lat->is_array() || lon->size() != lat->size())
        continue;
      if (text(member(element(bodies, 0), "id")) != id) continue;
      const std::size_t first = rings ? static_cast<std::size_t>(whole(element(rings, 0)).value_or(0)) : lon->size();
      std::vector<model::Location> ring;
      for (std::size_t i = 0; i < std::min(first, lon->size()); ++i) {
        const auto x = number(&(*lon)[i]), y = number(&(*lat)[i]);
        if (!x || !y || std::fabs(*x) > 1.8e9 || std::fabs(*y) > 9e8) break;
        ring.push_back({static_cast<std::int32_t>(*x), static_cast<std::int32_t>(*y)});
      }
      sampler.add(id, ring);
    }
  }
  return std::move(sampler).finish("the records in explain/");
}

RepairsSaid repairs_of_explanations(const std::vector<std::string>& paths, const PositionSample& wanted) {
  RepairsSaid said;
  for (const std::string& path : paths) {
    std::string why;
    const auto lines = content_of(path, why);
    if (!lines) continue;
    for (std::size_t at = 0; at < lines->size();) {
      const std::size_t end = std::min(lines->find('\n', at), lines->size());
      const std::string_view line = std::string_view(*lines).substr(at, end - at);
      at = end + 1;
      // Most lines are of buildings that were not sampled: their ids alone are looked at.
      constexpr std::string_view kStart = "{\"id\":\"";
      if (line.starts_with(kStart)) {
        const std::string_view rest = line.substr(kStart.size());
        if (!wanted.corners.contains(std::string(rest.substr(0, rest.find('"'))))) continue;
      }
      const auto json = parse_json(line);
      if (!json) continue;
      const Json* const repair = member(*json, "repair");
      if (const auto shift = number(member(repair, "max_shift")); shift && *shift >= 0)
        said[text(member(*json, "id"))] = {*shift, number(member(repair, "overlaps_resolved")).value_or(0) > 0};
    }
  }
  return said;
}

void bound_positions(PositionSample& sample, const RepairsSaid& said, const std::set<std::string>& moved,
                     double otherwise) {
  std::vector<std::string> unknown;
  for (auto& [id, corners] : sample.corners) {
    const auto found = said.find(id);
    const double shift = found == said.end() ? otherwise : found->second.max_shift;
    if (found == said.end() ? moved.contains(id) : found->second.reshaped) {
      unknown.push_back(id);
    } else if (shift > kWritten) {
      const double reach = sample.reach[id] = shift + kWritten;
      // Where the corner and its neighbours may have come into one line the model has no corner.
      std::erase_if(corners, [&](const SampledCorner& c) { return c.height <= 2 * reach + kStraight; });
      if (corners.empty()) unknown.push_back(id);
    }
  }
  for (const std::string& id : unknown) sample.corners.erase(id);
}

std::unordered_map<std::string, MovementSaid> movements_said(const Json& imagery) {
  std::unordered_map<std::string, MovementSaid> moved;
  const Json* applied = member(imagery, "applied");
  const Json* buildings = member(imagery, "buildings");
  if (!applied || !applied->is_boolean() || !applied->get<bool>() || !buildings || !buildings->is_array()) return moved;
  for (const Json& building : *buildings) {
    const Json* walls = member(building, "walls");
    const bool in_row = text(member(building, "state")) == "corrected",
               reshaped = text(member(walls, "state")) == "refined";
    if (!in_row && !reshaped) continue;
    MovementSaid said;
    const auto at = [&](const char* name, std::uint64_t i) { return number(element(member(building, name), i)); };
    const auto x = at("shift_m", 0), y = at("shift_m", 1), cx = at("centre", 0), cy = at("centre", 1);
    const auto turn = number(member(building, "rotation_deg"));
    if (in_row && !(x && y && cx && cy && turn)) continue;
    if (in_row) said.shift = {*x, *y}, said.centre = {*cx, *cy}, said.turn = *turn;
    const Json *before = member(walls, "outline_before"), *after = member(walls, "outline_after");
    for (std::uint64_t r = 0; reshaped && before && after && r < std::min(before->size(), after->size()); ++r)
      add_walls(element(before, r), element(after, r), said);
    moved[text(member(building, "id"))] = std::move(said);
  }
  return moved;
}

void move_positions(PositionSample& sample, const std::unordered_map<std::string, MovementSaid>& moved,
                    georef::ProjTransform& proj_transform) {
  for (auto& [id, corners] : sample.corners) {
    const auto said = moved.find(id);
    if (said == moved.end()) continue;
    const MovementSaid& m = said->second;
    for (SampledCorner& corner : corners) {
      const model::Point2 p = proj_transform.forward({corner.at.lon_degrees(), corner.at.lat_degrees()});
      const georef::LonLat to = proj_transform.inverse(m(p));
      if (!(std::fabs(to.lon) <= 180 && std::fabs(to.lat) <= 90)) continue;
      corner.at = {static_cast<std::int32_t>(std::lround(to.lon * 1e7)),
                   static_cast<std::int32_t>(std::lround(to.lat * 1e7))};
    }
    sample.reach[id] += kRoundedPlaces;
  }
}

CommonShift common_shift(std::span<const std::pair<std::string, model::Point2>> offsets) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < offsets.size();) {
    model::Point2 sum;
    std::size_t count = 0;
    for (const std::string& building = offsets[i].first; i < offsets.size() && offsets[i].first == building;
         ++i, ++count) {
      sum.x += offsets[i].second.x;
      sum.y += offsets[i].second.y;
    }
    x.push_back(sum.x / static_cast<double>(count));
    y.push_back(sum.y / static_cast<double>(count));
  }
  CommonShift shift;
  shift.buildings = x.size();
  if (x.empty()) return shift;
  shift.median = {median_of(x), median_of(y)};
  for (auto [values, middle] : {std::pair(&x, shift.median.x), std::pair(&y, shift.median.y)}) {
    for (double& v : *values) v = std::fabs(v - middle);
    shift.uncertainty = std::max(
        shift.uncertainty, kThreeErrorsOfMedian * median_of(*values) / std::sqrt(static_cast<double>(values->size())));
  }
  return shift;
}

}  // namespace blockrand::validate
