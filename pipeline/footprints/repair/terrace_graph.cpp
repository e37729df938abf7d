#include "pipeline/footprints/repair/terrace_graph.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pipeline/footprints/repair/measure_text.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/footprint_overlap.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::IssueCode;
using model::Point2;
using model::Polygon;
using model::Ring;

/// Share of its area that each piece of a footprint keeps at least: a small one may vanish within what the whole may lose.
constexpr double kLeastOfPiece = 0.5;
/// m. What rounding to the grid may add to a shift: half the diagonal of a step.
constexpr double kRounding = 0.71 / model::kGridStepsPerMetre;
/// m. A smaller shift is none.
constexpr double kMoved = 0.001;
/// m. OSM writes places in steps of 11 mm: nobody drew a smaller one. It is in the record, but no notice.
constexpr double kWorthANotice = 0.02;

/// A corner in a ring of the graph.
struct Place {
  std::uint32_t ring, index;
};

struct FootprintValidity {
  bool valid = true;
  bool whole = false;         ///< no places can be named
  std::vector<Place> places;  ///< corners concerned
  std::string reason;
};

class Writer {
 public:
  Writer(TerraceGraph& graph, TerraceRow& row, const RepairOptions& options)
      : graph_(graph),
        row_(row),
        options_(options),
        first_ring_(row.buildings.size() + 1),
        trials_(row.buildings.size()),
        split_(row.buildings.size()),
        reason_(row.buildings.size()),
        users_(graph.corners.size()) {
    std::size_t r = 0;
    for (std::uint32_t b = 0; b < row.buildings.size(); ++b) {
      first_ring_[b] = static_cast<std::uint32_t>(r);
      while (r < graph.rings.size() && graph.rings[r].building == b) ++r;
    }
    first_ring_[row.buildings.size()] = static_cast<std::uint32_t>(r);
    for (const TerraceRing& ring : graph.rings)
      for (const std::uint32_t c : ring.corners)
        if (users_[c].empty() || users_[c].back() != ring.building) users_[c].push_back(ring.building);
  }

  void run(model::Report& report, std::vector<std::vector<SaidPoint>>& said) {
    const auto n = static_cast<std::uint32_t>(row_.buildings.size());
    std::vector<std::uint32_t> ask(n);
    for (std::uint32_t b = 0; b < n; ++b) ask[b] = b;
    while (!ask.empty()) {
      std::vector<std::pair<std::uint32_t, FootprintValidity>> failed;
      for (const std::uint32_t b : ask)
        if (FootprintValidity v = judge(b); !v.valid) failed.emplace_back(b, std::move(v));
      std::vector<std::uint32_t> again;
      for (auto& [b, validity] : failed) {
        again.push_back(b);
        give_way(b, validity, again);
      }
      std::sort(again.begin(), again.end());
      again.erase(std::unique(again.begin(), again.end()), again.end());
      ask = std::move(again);
    }
    for (std::uint32_t b = 0; b < n; ++b) write(b, report, said[b]);
  }

 private:
  const Ring& said_ring(const TerraceRing& ring) const {
    const Polygon& p = row_.buildings[ring.building].polygons[ring.polygon];
    return ring.ring == 0 ? p.outer : p.holes[ring.ring - 1];
  }
  /// The vertex of the footprint that corner `i` of the ring is, or kNoIndex for one put into a wall.
  static std::uint32_t vertex_of(const TerraceRing& ring, std::size_t i) {
    return i == 0 || ring.wall[i] != ring.wall[i - 1] ? ring.wall[i] : model::kNoIndex;
  }
  Point2 rounded(std::uint32_t corner) const { return model::snap(graph_.corners[corner].position); }

  /// The footprint as the graph has it; `places`, when given, tells where each point of each ring comes from.
  std::vector<Polygon> footprint(std::uint32_t b, std::vector<std::vector<Place>>* places) const {
    std::vector<Polygon> out(row_.buildings[b].polygons.size());
    for (std::uint32_t r = first_ring_[b]; r < first_ring_[b + 1]; ++r) {
      const TerraceRing& ring = graph_.rings[r];
      const Ring& said = said_ring(ring);
      Ring points;
      points.points.reserve(ring.corners.size());
      points.nodes.reserve(ring.corners.size());
      std::vector<Place> from;
      for (std::uint32_t i = 0; i < ring.corners.size(); ++i) {
        const Point2 p = rounded(ring.corners[i]);
        const std::uint32_t vertex = vertex_of(ring, i);
        const std::int64_t node = vertex == model::kNoIndex ? 0 : said.nodes[vertex];
        if (!points.points.empty() && points.points.back() == p) {
          if (points.nodes.back() == 0) points.nodes.back() = node;
          continue;
        }
        points.points.push_back(p);
        points.nodes.push_back(node);
        if (places) from.push_back({r, i});
      }
      while (points.size() > 1 && points.points.front() == points.points.back()) {
        points.points.pop_back();
        points.nodes.pop_back();
        if (places) from.pop_back();
      }
      if (places) places->push_back(std::move(from));
      Polygon& polygon = out[ring.polygon];
      (ring.ring == 0 ? polygon.outer : polygon.holes.emplace_back()) = std::move(points);
    }
    return out;
  }

  bool untouched(std::uint32_t b) const {
    for (std::uint32_t r = first_ring_[b]; r < first_ring_[b + 1]; ++r) {
      const TerraceRing& ring = graph_.rings[r];
      const Ring& said = said_ring(ring);
      if (ring.corners.size() != said.size()) return false;
      for (std::size_t i = 0; i < said.size(); ++i)
        if (graph_.corners[ring.corners[i]].position != said.points[i]) return false;
    }
    return true;
  }

  FootprintValidity judge(std::uint32_t b) const {
    FootprintValidity v;
    if (untouched(b)) return v;
    for (std::uint32_t r = first_ring_[b]; r < first_ring_[b + 1]; ++r) {
      const TerraceRing& ring = graph_.rings[r];
      const Ring& said = said_ring(ring);
      for (std::uint32_t i = 0; i < ring.corners.size(); ++i) {
        const std::uint32_t vertex = vertex_of(ring, i);
        if (vertex == model::kNoIndex) continue;
        const double shift = distance(rounded(ring.corners[i]), said.points[vertex]);
        if (shift <= options_.max_shift + kRounding) continue;
        v.valid = false;
        v.reason = "a corner would move " + metres_text(shift);
        v.places.push_back({r, i});
      }
    }
    if (!v.valid) return v;
    std::vector<std::vector<Place>> places;
    const std::vector<Polygon> polygons = footprint(b, &places);
    double area = 0, said_area = 0;
    std::size_t first = 0;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
      if (!geometry::strictly_simple(polygons[p]) || !geometry::rings_apart(polygons[p]) || !well_wound(polygons[p])) {
        v.valid = false;
        v.reason = "its rings would cross or touch";
        auto conflicts = geometry::conflicting_edges(polygons[p]);
        if (conflicts.empty()) conflicts = geometry::almost_touching_edges(polygons[p]);
        v.whole = v.whole || conflicts.empty();
        for (const auto& [e, f] : conflicts)
          for (const geometry::EdgeOf& edge : {e, f}) {
            const std::vector<Place>& ring = places[first + edge.ring];
            v.places.push_back(ring[edge.index]);
            v.places.push_back(ring[(edge.index + 1) % ring.size()]);
          }
      }
      first += 1 + polygons[p].holes.size();
      const double mine = geometry::area(polygons[p]), said = geometry::area(row_.buildings[b].polygons[p]);
      if (v.valid && mine < kLeastOfPiece * said) {
        v.valid = false;
        v.whole = true;
        v.reason = "a piece of it would shrink from " + square_metres(said) + " to " + square_metres(mine);
      }
      area += mine;
      said_area += said;
    }
    if (v.valid && std::fabs(area - said_area) > options_.max_area_change * said_area) {
      v.valid = false;
      v.whole = true;
      v.reason = "its area would change from " + square_metres(said_area) + " to " + square_metres(area);
    }
    return v;
  }

  void all_places(std::uint32_t b, std::vector<Place>& out) const {
    out.clear();
    for (std::uint32_t r = first_ring_[b]; r < first_ring_[b + 1]; ++r)
      for (std::uint32_t i = 0; i < graph_.rings[r].corners.size(); ++i) out.push_back({r, i});
  }

  /// One step back for a building that failed; the next one when that changes nothing.
  void give_way(std::uint32_t b, FootprintValidity& validity, std::vector<std::uint32_t>& again) {
    // Squaring is undone where it hurts, then for the building; then sharing, in the same way.
    constexpr int kUnsquareHere = 2, kUnsquareAll = 3, kSplitHere = 6;
    if (split_[b] == 0 || reason_[b].empty()) reason_[b] = validity.reason;
    if (validity.whole) all_places(b, validity.places);
    for (bool changed = false; !changed;) {
      const int trial = trials_[b]++;
      if (trial < kUnsquareHere) {
        changed = unsquare(validity.places, again);
      } else if (trial < kUnsquareAll) {
        all_places(b, validity.places);
        changed = unsquare(validity.places, again);
      } else if (trial < kSplitHere && !validity.whole) {
        changed = split(b, validity.places, again);
      } else {
        all_places(b, validity.places);
        split(b, validity.places, again);
        changed = true;
      }
    }
  }

  void wake(std::uint32_t corner, std::vector<std::uint32_t>& again) const {
    again.insert(again.end(), users_[corner].begin(), users_[corner].end());
  }

  bool unsquare(const std::vector<Place>& places, std::vector<std::uint32_t>& again) {
    bool changed = false;
    for (const Place& p : places) {
      const std::uint32_t c = graph_.rings[p.ring].corners[p.index];
      Corner& corner = graph_.corners[c];
      if (corner.position == corner.start) continue;
      corner.position = corner.start;
      wake(c, again);
      changed = true;
    }
    return changed;
  }

  /// The corners become the building's own, where it said; what was put into the walls there goes. Later places first, so
  /// that the others keep their index.
  bool split(std::uint32_t b, std::vector<Place> places, std::vector<std::uint32_t>& again) {
    std::sort(places.begin(), places.end(),
              [](Place p, Place q) { return p.ring != q.ring ? p.ring < q.ring : p.index > q.index; });
    places.erase(std::unique(places.begin(), places.end(),
                             [](Place p, Place q) { return p.ring == q.ring && p.index == q.index; }),
                 places.end());
    bool changed = false;
    for (const Place& p : places) {
      TerraceRing& ring = graph_.rings[p.ring];
      const std::uint32_t vertex = vertex_of(ring, p.index);
      if (vertex == model::kNoIndex) {
        ring.corners.erase(ring.corners.begin() + p.index);
        ring.wall.erase(ring.wall.begin() + p.index);
        ++split_[b];
        changed = true;
        continue;
      }
      const Ring& said = said_ring(ring);
      Corner own;
      own.start = own.position = said.points[vertex];
      if (graph_.corners[ring.corners[p.index]].position == own.position) continue;
      own.said = {own.start};
      own.node = said.nodes[vertex];
      ring.corners[p.index] = static_cast<std::uint32_t>(graph_.corners.size());
      graph_.corners.push_back(std::move(own));
      users_.push_back({b});
      ++split_[b];
      changed = true;
    }
    if (changed) again.push_back(b);
    return changed;
  }

  void write(std::uint32_t b, model::Report& report, std::vector<SaidPoint>& said_points) {
    TerraceBuilding& building = row_.buildings[b];
    model::RepairRecord& record = building.record;
    record.moved = 0;
    record.mean_shift = record.max_shift = 0;
    std::uint32_t squared = 0;
    double by_squaring = 0;
    for (std::uint32_t r = first_ring_[b]; r < first_ring_[b + 1]; ++r) {
      const TerraceRing& ring = graph_.rings[r];
      const Ring& said = said_ring(ring);
      for (std::size_t i = 0; i < ring.corners.size(); ++i) {
        const std::uint32_t vertex = vertex_of(ring, i);
        if (vertex == model::kNoIndex) continue;
        const Corner& corner = graph_.corners[ring.corners[i]];
        const Point2 at = rounded(ring.corners[i]);
        said_points.push_back({at, said.points[vertex]});
        const double shift = distance(at, said.points[vertex]);
        const double turned = distance(corner.position, corner.start);
        record.max_shift = std::max(record.max_shift, shift);
        if (shift > kMoved) {
          ++record.moved;
          record.mean_shift += shift;
        }
        if (turned > kWorthANotice) ++squared;
        by_squaring = std::max(by_squaring, turned);
      }
    }
    std::sort(said_points.begin(), said_points.end());
    if (record.moved > 0) record.mean_shift /= record.moved;
    if (squared > 0)
      report.add(building.id, IssueCode::squared,
                 std::to_string(squared) + " corners, by up to " + metres_text(by_squaring));
    const bool as_mapped = untouched(b);
    if (split_[b] > 0)
      report.add(building.id, as_mapped ? IssueCode::repair_bounded : IssueCode::shared_wall_conflict, reason_[b]);
    if (!as_mapped) building.polygons = footprint(b, nullptr);
  }

  TerraceGraph& graph_;
  TerraceRow& row_;
  const RepairOptions& options_;
  std::vector<std::uint32_t> first_ring_;          ///< by building, and the end
  std::vector<int> trials_;                        ///< by building: steps back so far
  std::vector<std::uint32_t> split_;               ///< by building: corners that left their neighbours
  std::vector<std::string> reason_;                ///< by building: why
  std::vector<std::vector<std::uint32_t>> users_;  ///< by corner: buildings that have it, or had
};

}  // namespace

void apply_terrace_graph(TerraceGraph& graph, TerraceRow& row, const RepairOptions& options, model::Report& report,
                         std::vector<std::vector<SaidPoint>>& said) {
  said.assign(row.buildings.size(), {});
  Writer(graph, row, options).run(report, said);
}

}  // namespace blockrand::repair
