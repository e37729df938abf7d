#include "pipeline/outputs/geopackage/dissolved_faces.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "pipeline/outputs/surrounding_objects.h"

namespace blockrand::outputs {
namespace {

/// Steps of the grid: whole numbers, so that areas and sides are exact.
struct Step {
  std::int64_t x = 0, y = 0;
  friend auto operator<=>(const Step&, const Step&) = default;
};
using Ring = std::vector<Step>;
__extension__ using Wide = __int128;

Step step_of(const model::Point3& p) {
  return {static_cast<std::int64_t>(p.x * model::kGridStepsPerMetre),
          static_cast<std::int64_t>(p.y * model::kGridStepsPerMetre)};
}

Wide cross(Step o, Step a, Step b) {
  return static_cast<Wide>(a.x - o.x) * (b.y - o.y) - static_cast<Wide>(a.y - o.y) * (b.x - o.x);
}

Wide twice_area(const Ring& ring) {
  Wide sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += cross(ring[0], ring[i], ring[i + 1]);
  return sum;
}

/// Directed edges whose insides lie on the left, each once.
using Edges = std::map<Step, std::set<Step>>;

void add_edge(Edges& edges, Step from, Step to) {
  if (from == to) return;
  if (const auto back = edges.find(to); back != edges.end() && back->second.erase(from) == 1) {
    if (back->second.empty()) edges.erase(back);
    return;
  }
  edges[from].insert(to);
}

void add_ring(Edges& edges, const std::vector<model::Point3>& points, bool counter_clockwise) {
  Ring ring;
  for (const model::Point3& p : points) ring.push_back(step_of(p));
  const Wide area = twice_area(ring);
  if (area == 0) return;
  if ((area > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  for (std::size_t i = 0; i < ring.size(); ++i) add_edge(edges, ring[i], ring[(i + 1) % ring.size()]);
}

/// The way on from `at`, come to from `before`: the first one clockwise from the way back, so that what is on the left hangs
/// together at the corner.
Step next_of(const std::set<Step>& ways, Step before, Step at) {
  const auto is_beyond_half = [&](Step to) { return cross(at, before, to) >= 0; };
  auto best = ways.begin();
  for (auto way = std::next(best); way != ways.end(); ++way) {
    const bool a = is_beyond_half(*way), b = is_beyond_half(*best);
    if (a != b ? b : cross(at, *best, *way) > 0) best = way;
  }
  return *best;
}

/// Cuts a ring at points that it comes to twice.
void cut_apart(const Ring& ring, std::vector<Ring>& out) {
  Ring open;
  std::map<Step, std::size_t> at;
  for (const Step p : ring) {
    if (const auto place = at.find(p); place != at.end()) {
      const std::size_t begin = place->second;
      out.emplace_back(open.begin() + static_cast<std::ptrdiff_t>(begin), open.end());
      for (std::size_t i = begin; i < open.size(); ++i) at.erase(open[i]);
      open.resize(begin);
    }
    at[p] = open.size();
    open.push_back(p);
  }
  out.push_back(std::move(open));
}

std::vector<Ring> rings_of(const Edges& edges) {
  std::vector<Ring> out;
  std::set<std::pair<Step, Step>> used;
  for (const auto& [start, ways] : edges)
    for (const Step first : ways) {
      if (!used.insert({start, first}).second) continue;
      Ring ring = {start};
      Step before = start, at = first;
      bool closed = false;
      // Where faces do not fit, a way may end: what is no ring is left out.
      for (auto on = edges.find(at); on != edges.end(); on = edges.find(at)) {
        const Step to = next_of(on->second, before, at);
        closed = at == start && to == first;
        if (closed || !used.insert({at, to}).second) break;
        ring.push_back(at);
        before = at;
        at = to;
      }
      if (closed) cut_apart(ring, out);
    }
  std::erase_if(out, [](const Ring& r) { return r.size() < 3 || twice_area(r) == 0; });
  return out;
}

bool is_inside(const Ring& ring, Step p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Step a = ring[i], b = ring[(i + 1) % ring.size()];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const Wide side = cross(a, b, p);
    if (b.y > a.y ? side > 0 : side < 0) inside = !inside;
  }
  return inside;
}

bool is_on(const Ring& ring, Step p) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Step a = ring[i], b = ring[(i + 1) % ring.size()];
    if (cross(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
        p.y <= std::max(a.y, b.y))
      return true;
  }
  return false;
}

/// Whether a hole lies in an outer ring that it may touch at points.
bool holds(const Ring& outer, const Ring& hole) {
  for (const Step p : hole)
    if (!is_on(outer, p)) return is_inside(outer, p);
  // All its corners touch: the middle of an edge tells, in halves of steps.
  const Step a = hole[0], b = hole[1];
  Ring twice;
  for (const Step p : outer) twice.push_back({2 * p.x, 2 * p.y});
  return is_inside(twice, {a.x + b.x, a.y + b.y});
}

model::Ring ring_of(Ring ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  model::Ring out;
  for (const Step p : ring)
    out.points.push_back(
        {static_cast<double>(p.x) / model::kGridStepsPerMetre, static_cast<double>(p.y) / model::kGridStepsPerMetre});
  out.nodes.assign(out.points.size(), 0);
  return out;
}

}  // namespace

std::vector<model::Polygon> dissolved(const std::vector<model::FlatPolygon>& faces) {
  Edges edges;
  for (const model::FlatPolygon& face : faces) {
    const std::vector<std::vector<model::Point3>> rings = rings_on_grid(face);
    for (const auto& ring : rings) add_ring(edges, ring, &ring == &rings.front());
  }
  std::vector<Ring> outer, holes;
  for (Ring& ring : rings_of(edges)) (twice_area(ring) > 0 ? outer : holes).push_back(std::move(ring));
  std::vector<std::vector<Ring>> holes_of(outer.size());
  for (Ring& hole : holes) {
    std::optional<std::size_t> best;
    for (std::size_t o = 0; o < outer.size(); ++o)
      if (holds(outer[o], hole) && (!best || twice_area(outer[o]) < twice_area(outer[*best]))) best = o;
    if (best) holes_of[*best].push_back(std::move(hole));
  }
  std::vector<model::Polygon> out;
  for (std::size_t o = 0; o < outer.size(); ++o) {
    model::Polygon& polygon = out.emplace_back();
    polygon.outer = ring_of(std::move(outer[o]));
    for (Ring& hole : holes_of[o]) polygon.holes.push_back(ring_of(std::move(hole)));
    std::sort(polygon.holes.begin(), polygon.holes.end(),
              [](const model::Ring& a, const model::Ring& b) { return a.points < b.points; });
  }
  std::sort(out.begin(), out.end(),
            [](const model::Polygon& a, const model::Polygon& b) { return a.outer.points < b.outer.points; });
  return out;
}

}  // namespace blockrand::outputs
