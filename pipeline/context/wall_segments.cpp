#include "pipeline/context/wall_segments.h"

#include <algorithm>
#include <cmath>

#include "pipeline/context/situation.h"
#include "pipeline/context/street_front.h"
#include "pipeline/context/wall_contacts.h"
#include "pipeline/context/wall_points.h"
#include "pipeline/context/wall_samples.h"

namespace blockrand::context {

namespace {

using model::Point2;
using model::WallSegment;
using model::WallSegmentKind;

/// A piece of an edge with one situation, as it is found.
struct Piece {
  double start = 0, end = 0;  ///< m
  WallSegmentKind kind = WallSegmentKind::unknown;
  model::OsmId neighbour = {};
  std::uint32_t passage = kNothing;
  std::vector<WallSample> samples = {};
  double margin = 0;  ///< side and courtyard: of the view around, how far from the other label
  double length() const { return end - start; }
};

bool same_situation(const Piece& a, const Piece& b) {
  return a.kind == b.kind && a.neighbour == b.neighbour && a.passage == b.passage;
}

/// Joins neighbours of one situation.
void join_equal(std::vector<Piece>& pieces) {
  std::vector<Piece> out;
  for (Piece& p : pieces) {
    if (!out.empty() && same_situation(out.back(), p)) {
      out.back().end = p.end;
      out.back().margin = std::max(out.back().margin, p.margin);
      out.back().samples.insert(out.back().samples.end(), p.samples.begin(), p.samples.end());
    } else {
      out.push_back(std::move(p));
    }
  }
  pieces = std::move(out);
}

/// Gives pieces shorter than `least` to the longer of their neighbours, the shortest first (ties: the nearer to the
/// middle of the edge, so that no direction is preferred; then the first).
void absorb_short(std::vector<Piece>& pieces, double least) {
  for (;;) {
    join_equal(pieces);
    if (pieces.size() < 2) return;
    std::size_t shortest = 0;
    for (std::size_t i = 1; i < pieces.size(); ++i)
      if (pieces[i].length() < pieces[shortest].length()) shortest = i;
    if (pieces[shortest].length() >= least) return;
    const bool has_before = shortest > 0, has_after = shortest + 1 < pieces.size();
    const bool to_before = has_before && (!has_after || pieces[shortest - 1].length() >= pieces[shortest + 1].length());
    if (to_before)
      pieces[shortest - 1].end = pieces[shortest].end;
    else
      pieces[shortest + 1].start = pieces[shortest].start;
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(shortest));
  }
}

class Labeller {
 public:
  Labeller(const model::Building& building, const VicinityIndex& index, const WallSegmentOptions& options)
      : building_(building), index_(index), options_(options), view_(view_of(building, index)) {
    const auto& footprints = index.all().footprints;
    const auto own = std::lower_bound(footprints.begin(), footprints.end(), building.osm,
                                      [](const Footprint& f, model::OsmId id) { return f.id < id; });
    canopy_ = own != footprints.end() && own->id == building.osm && own->canopy;
  }

  const BuildingView& view() const { return view_; }

  /// What a wall segment faces when it is no street front after all.
  void no_front(const OutlineEdge& edge, Piece& piece) const {
    std::vector<Piece> parts;
    add_surrounded(edge, piece, parts);
    double court = 0;
    for (const Piece& p : parts)
      if (p.kind == WallSegmentKind::courtyard) court += p.length();
    piece.kind = 2 * court > piece.length() ? WallSegmentKind::courtyard : WallSegmentKind::side;
  }

  std::vector<Piece> pieces_of(const OutlineEdge& edge, const std::vector<Portal>& portals) const {
    std::vector<Piece> fixed;
    for (const Contact& c : contacts_of(edge, building_.osm, canopy_, index_, options_))
      fixed.push_back({.start = c.start, .end = c.end, .kind = WallSegmentKind::party_wall, .neighbour = c.neighbour});
    const std::size_t contacts = fixed.size();
    for (const Portal& m : canopy_ ? std::vector<Portal>{} : portals) {
      // What a neighbour's wall leaves of the portal.
      double start = m.start;
      for (std::size_t c = 0; c < contacts; ++c) {
        if (fixed[c].end <= start || fixed[c].start >= m.end) continue;
        if (fixed[c].start > start)
          fixed.push_back(
              {.start = start, .end = fixed[c].start, .kind = WallSegmentKind::passage, .passage = m.passage});
        start = fixed[c].end;
      }
      if (start < m.end)
        fixed.push_back({.start = start, .end = m.end, .kind = WallSegmentKind::passage, .passage = m.passage});
    }
    std::sort(fixed.begin(), fixed.end(), [](const Piece& a, const Piece& b) { return a.start < b.start; });
    std::vector<Piece> out;
    double at = 0;
    for (Piece& piece : fixed) {
      if (piece.start - at > options_.min_wall_segment)
        add_free(edge, at, piece.start, out);
      else
        piece.start = at;
      at = piece.end;
      out.push_back(std::move(piece));
    }
    if (edge.length - at > options_.min_wall_segment || out.empty())
      add_free(edge, at, edge.length, out);
    else
      out.back().end = edge.length;
    absorb_short(out, options_.min_wall_segment);
    return out;
  }

 private:
  /// Cuts a wall segment without contacts and portals where its view changes.
  void add_free(const OutlineEdge& edge, double start, double end, std::vector<Piece>& out) const {
    const int n = std::max(1, static_cast<int>(std::ceil((end - start) / options_.sample_step)));
    const double step = (end - start) / n;
    std::vector<Piece> pieces;
    for (int i = 0; i < n; ++i) {
      WallSample sample = look_out(edge, start + (i + 0.5) * step, view_, options_);
      Piece piece{.start = start + i * step, .end = start + (i + 1) * step, .kind = sample.kind};
      if (sample.inside != kNothing) piece.neighbour = index_.all().footprints[sample.inside].id;
      piece.samples.push_back(std::move(sample));
      if (!pieces.empty() && !same_situation(pieces.back(), piece))
        pieces.back().end = piece.start = border(edge, pieces.back(), piece);
      pieces.push_back(std::move(piece));
    }
    absorb_short(pieces, std::min(options_.min_view, (end - start) / 2));
    std::vector<Piece> surrounded;
    for (Piece& p : pieces) {
      if (p.kind == WallSegmentKind::unknown)
        add_surrounded(edge, p, surrounded);
      else
        surrounded.push_back(std::move(p));
    }
    absorb_short(surrounded, std::min(options_.min_view, (end - start) / 2));
    for (Piece& p : surrounded) out.push_back(std::move(p));
  }

  /// Courtyard or open ground, by what stands around.
  void add_surrounded(const OutlineEdge& edge, const Piece& piece, std::vector<Piece>& out) const {
    const int n = std::max(1, static_cast<int>(std::lround(piece.length() / options_.enclosure_step)));
    const bool in_yard =
        std::any_of(piece.samples.begin(), piece.samples.end(), [](const WallSample& s) { return s.yard != kNothing; });
    const double step = piece.length() / n;
    for (int i = 0; i < n; ++i) {
      const double start = piece.start + i * step, end = i + 1 == n ? piece.end : start + step;
      const Enclosure around = enclosure_at(edge, start + step / 2, building_.osm, in_yard, view_, options_);
      Piece part{.start = start,
                 .end = end,
                 .kind = around.is_court(options_) ? WallSegmentKind::courtyard : WallSegmentKind::side,
                 .margin = around.margin(options_)};
      for (const WallSample& sample : piece.samples)
        if (sample.at >= start && (sample.at < end || i + 1 == n)) part.samples.push_back(sample);
      out.push_back(std::move(part));
    }
  }

  /// Where between two samples the view changes, to a quarter of a metre.
  double border(const OutlineEdge& edge, const Piece& a, const Piece& b) const {
    constexpr double kEnough = 0.25;  // m
    double low = a.samples.back().at, high = b.samples.front().at;
    while (high - low > kEnough) {
      const double middle = (low + high) / 2;
      (look_out(edge, middle, view_, options_).kind == a.kind ? low : high) = middle;
    }
    return (low + high) / 2;
  }

  const model::Building& building_;
  const VicinityIndex& index_;
  const WallSegmentOptions& options_;
  BuildingView view_;
  bool canopy_ = false;
};

/// Mean distance straight ahead to the street, of the samples that front one; infinite where none does.
double front_distance(const Piece& piece) {
  double sum = 0;
  int n = 0;
  for (const WallSample& s : piece.samples)
    if (s.kind == WallSegmentKind::street && s.square == kNothing) {
      sum += s.street_distance;
      ++n;
    }
  return n > 0 ? sum / n : std::numeric_limits<double>::infinity();
}

using Pieces = std::vector<std::vector<Piece>>;  ///< parallel to the edges

/// Takes `street` from rears that look over a garden at the next street.
void drop_rears(const std::vector<OutlineEdge>& edges, const Labeller& labeller, const WallSegmentOptions& options,
                Pieces& pieces) {
  struct Front {
    model::Point2 outward;
    double distance;
  };
  std::vector<Front> fronts;
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const Piece& p : pieces[e])
      if (p.kind == WallSegmentKind::street && p.length() >= options.min_view)
        fronts.push_back({edges[e].outward, front_distance(p)});
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (Piece& p : pieces[e]) {
      const double distance = p.kind == WallSegmentKind::street ? front_distance(p) : 0;
      if (distance <= options.rear_distance || !std::isfinite(distance)) continue;
      constexpr double kOpposite = -0.7;  // cosine of 135 degrees
      const Point2 out = edges[e].outward;
      if (std::any_of(fronts.begin(), fronts.end(), [&](const Front& f) {
            return f.distance < distance / 2 && f.outward.x * out.x + f.outward.y * out.y < kOpposite;
          }))
        labeller.no_front(edges[e], p);
    }
}

/// Gives short steps of a street front to it.
void join_jogs(const std::vector<OutlineEdge>& edges, const WallSegmentOptions& options, Pieces& pieces) {
  constexpr double kStep = 0.5;  // cosine of 60 degrees: before and after a step the front goes on
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t count = 0;
    while (first + count < edges.size() && edges[first + count].polygon == edges[first].polygon &&
           edges[first + count].ring == edges[first].ring)
      ++count;
    std::vector<std::size_t> jogs;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t e = first + i, before = first + (i + count - 1) % count, after = first + (i + 1) % count;
      if (edges[e].length > options.max_jog || pieces[e].size() != 1 || pieces[before].empty() || pieces[after].empty())
        continue;
      const WallSegmentKind kind = pieces[e][0].kind;
      if (kind != WallSegmentKind::side && kind != WallSegmentKind::courtyard) continue;
      if (pieces[before].back().kind != WallSegmentKind::street ||
          pieces[after].front().kind != WallSegmentKind::street)
        continue;
      if (edges[before].along.x * edges[after].along.x + edges[before].along.y * edges[after].along.y > kStep)
        jogs.push_back(e);
    }
    for (const std::size_t e : jogs) pieces[e][0].kind = WallSegmentKind::street;
    first += count;
  }
}

/// [0, 1]: how sure a label is.
double confidence_of(const Piece& piece, const VicinityIndex& index) {
  switch (piece.kind) {
    case WallSegmentKind::party_wall:
      return piece.samples.empty() ? 0.98 : 0.8;  // touched, or lies within the neighbour
    case WallSegmentKind::passage:
      return 0.85;  // its width is mostly assumed
    case WallSegmentKind::street: {
      double ahead = 0;
      for (const WallSample& s : piece.samples) ahead += s.square != kNothing ? 1 : s.ahead;
      const double mean = piece.samples.empty() ? 0 : ahead / static_cast<double>(piece.samples.size());
      return 0.6 + 0.38 * std::clamp(2 * mean - 1, 0.0, 1.0);
    }
    case WallSegmentKind::unknown:
    case WallSegmentKind::courtyard:
    case WallSegmentKind::side:
      break;
  }
  for (const WallSample& s : piece.samples)
    if (s.yard != kNothing && piece.kind == WallSegmentKind::courtyard && index.courtyard(index.yards()[s.yard]).closed)
      return 0.97;
  return 0.6 +
         0.35 *
             std::min(1.0, piece.margin /
                               Enclosure::kCertain);  // the agreement with labels made by eye is 60 % at the threshold
}

WallSegment wall_segment_of(const OutlineEdge& edge, const Piece& piece, const VicinityIndex& index) {
  WallSegment f;
  f.from_node = edge.from_node;
  f.to_node = edge.to_node;
  f.polygon = edge.polygon;
  f.ring = edge.ring;
  f.edge = edge.edge;
  f.start = piece.start;
  f.end = piece.end;
  f.kind = piece.kind;
  f.confidence = static_cast<float>(confidence_of(piece, index));
  f.neighbour = piece.neighbour;
  return f;
}

void note_arcs(model::Building& building, const std::vector<OutlineEdge>& edges) {
  for (std::size_t a = 0; a < building.arcs.size(); ++a) {
    const model::Arc& arc = building.arcs[a];
    const auto ring = static_cast<std::uint32_t>(std::count_if(edges.begin(), edges.end(), [&](const OutlineEdge& e) {
      return e.polygon == arc.polygon && e.ring == arc.ring;
    }));
    for (WallSegment& f : building.edges)
      if (f.polygon == arc.polygon && f.ring == arc.ring && (f.edge + ring - arc.first) % ring < arc.count)
        f.arc = static_cast<std::int32_t>(a);
  }
}

}  // namespace

void label_wall_segments(model::Building& building, const VicinityIndex& index, std::string_view address_street,
                         const WallSegmentOptions& options) {
  building.edges.clear();
  const std::vector<OutlineEdge> edges = edges_of(building.outline);
  const std::vector<std::vector<Portal>> portals = portals_of(building, edges, index, options);
  const Labeller labeller(building, index, options);
  Pieces pieces(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges[e].length > 0) pieces[e] = labeller.pieces_of(edges[e], portals[e]);
  drop_rears(edges, labeller, options, pieces);
  join_jogs(edges, options, pieces);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    join_equal(pieces[e]);
    for (Piece& piece : pieces[e]) {
      WallSegment f = wall_segment_of(edges[e], piece, index);
      if (piece.kind != WallSegmentKind::party_wall) {
        if (piece.samples.empty())
          piece.samples.push_back(look_out(edges[e], (piece.start + piece.end) / 2, labeller.view(), options));
        face_street(edges[e], piece.samples, labeller.view(), f);
      }
      building.edges.push_back(std::move(f));
    }
  }
  note_arcs(building, edges);
  mark_corners(building, edges);
  assign_points(building, edges, index, options);
  describe_situation(building, edges, index, address_street);
}

}  // namespace blockrand::context
