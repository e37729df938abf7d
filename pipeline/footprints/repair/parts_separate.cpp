#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "pipeline/footprints/repair/parts_bodies.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/noded_lines.h"
#include "pipeline/geometry/planar_faces.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/slivers.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::repair {

namespace {

using model::BuildingPart;
using model::Point2;
using model::Polygon;
using model::Ring;

/// Tips that are cut off leave new corners, which rounding may put into another part; so it is done again.
constexpr int kRounds = 3;
constexpr double kLeastShare = 0.05;  // of a plan; of one that keeps less, only slivers are left
constexpr double kStrip = 0.1;        // m; two drawings of one wall lie that near
constexpr double kHigher = 1.0;       // m; less is one storey counted and measured
constexpr double kTold = 0.01;        // m²; less is what rounding and two drawings of one wall make
constexpr double kOpened = 0.1;       // m²; the ground of a wall's width between two rings, which make_valid opens

struct Piece {
  std::size_t part = 0;
  HeightSpan heights;
  double area = 0;
  model::OsmId osm;
  geometry::PlanBox box;
};

Piece piece_of(const BuildingPart& part, std::size_t index, const model::MappedAttributes& building) {
  return {index, height_span(part.mapped, part.canopy, building), geometry::area(part.plan), part.osm,
          geometry::box_of(part.plan.outer.points)};
}

bool near(const Piece& a, const Piece& b) {
  constexpr double kReach = 2 / model::kGridStepsPerMetre;
  return a.box.near(b.box, kReach);
}

/// Whether two stand at one height by some reading: metres and storeys of 3 m without a margin.
bool may_meet(const HeightSpan& a, const HeightSpan& b) { return std::min(a.high, b.high) > std::max(a.low, b.low); }

/// Whether a part reaches through a slab: it begins below and ends above.
bool pierces(const HeightSpan& part, const HeightSpan& slab) {
  constexpr double kMargin = 0.1;  // m; heights are mapped in tenths
  return slab.slab && !part.slab && part.low < slab.high - kMargin && part.high > slab.high + kMargin;
}

/// Whether only one of two can have a piece of ground. \param slim  it is a strip between two drawings of one wall
bool in_each_others_way(const HeightSpan& a, const HeightSpan& b, bool slim) {
  return heights_meet(a, b) || (slim && may_meet(a, b)) || pierces(a, b) || pierces(b, a);
}

/// Pieces that may stand at one height and come near each other, and what hangs together by such; the stronger first: the
/// smaller, of equal ones that of the lower id; slabs last.
std::vector<std::vector<Piece>> groups_of(const std::vector<BuildingPart>& parts,
                                          const model::MappedAttributes& building) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].plan.outer.size() >= 3) pieces.push_back(piece_of(parts[i], i, building));
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.heights.slab, a.area, a.osm, a.part) < std::tie(b.heights.slab, b.area, b.osm, b.part);
  });
  std::vector<std::size_t> group(pieces.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (near(pieces[i], pieces[k]) && may_meet(pieces[i].heights, pieces[k].heights)) group[root(i)] = root(k);
  std::map<std::size_t, std::vector<Piece>> out;
  for (std::size_t i = 0; i < pieces.size(); ++i) out[root(i)].push_back(pieces[i]);
  std::vector<std::vector<Piece>> several;
  for (auto& [key, members] : out)
    if (members.size() > 1) several.push_back(std::move(members));
  return several;
}

/// The plans of a group drawn over each other: faces, each within some of the plans.
class Drawing {
 public:
  using Edge = std::pair<Point2, Point2>;  ///< the face lies on its left

  Drawing(const std::vector<BuildingPart>& parts, const std::vector<Piece>& group) : group_(group) {
    std::vector<geometry::DividingLine> lines;
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto add = [&](const Ring& ring) {
        geometry::DividingLine line{i, ring.points, ring.nodes};
        line.points.push_back(ring.points[0]);
        line.nodes.push_back(ring.nodes[0]);
        lines.push_back(std::move(line));
      };
      add(parts[group[i].part].plan.outer);
      for (const Ring& hole : parts[group[i].part].plan.holes) add(hole);
    }
    for (const geometry::NodedEdge& e : geometry::noded_edges(lines))
      lines_[{e.a, e.b}].emplace_back(e.line, e.forward ? 1 : -1);
    faces_ = geometry::faces_of_lines(lines);
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for_each_edge(f, [&](const Edge& e, std::int64_t) { left_of_[e] = f; });
    find_windings();
    order_.resize(group.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    share_out();
    give_way_to_touching();
  }

  /// Of a plan as it is drawn, and of what it keeps. m²
  double drawn(std::size_t piece) const {
    return area([&](std::size_t f) { return winding_[f][piece] > 0; });
  }
  double kept(std::size_t piece) const {
    return area([&](std::size_t f) { return kept_[f][piece]; });
  }

  /// Who keeps most of the ground that a piece loses; nobody where the piece is known to reach higher than one of those
  /// who take it.
  std::optional<std::size_t> strongest_over(std::size_t piece) const {
    std::vector<double> areas(group_.size(), 0);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (winding_[f].empty() || winding_[f][piece] <= 0 || kept_[f][piece]) continue;
      for (std::size_t k = 0; k < group_.size(); ++k) {
        if (!kept_[f][k] || !in_each_others_way(group_[k].heights, group_[piece].heights, false)) continue;
        const HeightSpan &mine = group_[piece].heights, &its = group_[k].heights;
        if (std::isfinite(mine.high) && mine.high > its.high + kHigher) return std::nullopt;
        areas[k] += geometry::area(faces_[f].polygon);
      }
    }
    const auto most = std::max_element(areas.begin(), areas.end());
    return *most > 0 ? std::optional(static_cast<std::size_t>(most - areas.begin())) : std::nullopt;
  }

  /// The faces that a piece keeps, or all of its own, united; empty where a ring would touch itself.
  std::vector<Polygon> united(std::size_t piece, bool all) const {
    std::vector<bool> in(faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) in[f] = all ? winding_[f][piece] > 0 : kept_[f][piece];
    std::vector<Polygon> out;
    std::vector<bool> done(faces_.size(), false);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!in[f] || done[f]) continue;
      const auto polygon = border_of(connected(f, in, done), in);
      if (!polygon) return {};
      out.push_back(*polygon);
    }
    return out;
  }

 private:
  template <class Visit>
  void for_each_edge(std::size_t face, Visit&& visit) const {
    const auto walk = [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i)
        visit(Edge{ring.points[i], ring.points[(i + 1) % ring.size()]}, ring.nodes.empty() ? 0 : ring.nodes[i]);
    };
    walk(faces_[face].polygon.outer);
    for (const Ring& hole : faces_[face].polygon.holes) walk(hole);
  }

  std::optional<std::size_t> beyond(const Edge& e) const {
    const auto found = left_of_.find({e.second, e.first});
    return found == left_of_.end() ? std::nullopt : std::optional(found->second);
  }

  template <class In>
  double area(const In& in) const {
    double sum = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (in(f)) sum += geometry::area(faces_[f].polygon);
    return sum;
  }

  /// How often each plan's rings go round each face, from the outside in.
  void find_windings() {
    winding_.assign(faces_.size(), {});
    std::vector<std::size_t> open;
    const auto enter = [&](std::size_t face, const Edge& e, std::vector<int> outside) {
      if (!winding_[face].empty()) return;
      const bool forward = e.first < e.second;
      const auto found = lines_.find(forward ? e : Edge{e.second, e.first});
      if (found != lines_.end())
        for (const auto& [line, way] : found->second) outside[line] += forward ? way : -way;
      winding_[face] = std::move(outside);
      open.push_back(face);
    };
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for_each_edge(f, [&](const Edge& e, std::int64_t) {
        if (!beyond(e)) enter(f, e, std::vector<int>(group_.size(), 0));
      });
    while (!open.empty()) {
      const std::size_t f = open.back();
      open.pop_back();
      for_each_edge(f, [&](const Edge& e, std::int64_t) {
        if (const auto other = beyond(e)) enter(*other, {e.second, e.first}, winding_[f]);
      });
    }
  }

  /// What is left of a piece may touch itself where the piece itself has a wall's width: then it goes first, if that takes
  /// no more than such widths from the others and leaves them whole.
  void give_way_to_touching() {
    for (std::size_t i = 0; i < group_.size(); ++i) {
      if (kept(i) <= 0 || kept(i) >= drawn(i) || !united(i, false).empty()) continue;
      const auto kept_before = kept_;
      const auto order_before = order_;
      std::vector<double> areas;
      std::vector<bool> whole;
      for (std::size_t k = 0; k < group_.size(); ++k) {
        areas.push_back(kept(k));
        whole.push_back(!united(k, false).empty());
      }
      const auto place = std::find(order_.begin(), order_.end(), i);
      std::rotate(order_.begin(), place, place + 1);
      share_out();
      for (std::size_t k = 0; k < group_.size(); ++k) {
        if (kept(k) >= areas[k] - kOpened && (!whole[k] || !united(k, false).empty())) continue;
        order_ = order_before;
        kept_ = kept_before;
        break;
      }
    }
  }

  /// Each face goes to the strongest, and to those that stand at other heights. Strips between two drawings of one wall
  /// go to one even where heights that are counted and measured leave it open.
  void share_out() {
    kept_.assign(faces_.size(), std::vector<bool>(group_.size(), false));
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const bool slim = geometry::equivalent_width(faces_[f].polygon) < kStrip;
      for (const std::size_t i : order_) {
        if (winding_[f].empty() || winding_[f][i] <= 0) continue;
        bool free = true;
        for (std::size_t k = 0; k < group_.size() && free; ++k)
          free = !kept_[f][k] || !in_each_others_way(group_[k].heights, group_[i].heights, slim);
        kept_[f][i] = free;
      }
    }
  }

  std::vector<std::size_t> connected(std::size_t first, const std::vector<bool>& in, std::vector<bool>& done) const {
    std::vector<std::size_t> out{first};
    done[first] = true;
    for (std::size_t i = 0; i < out.size(); ++i)
      for_each_edge(out[i], [&](const Edge& e, std::int64_t) {
        const auto other = beyond(e);
        if (!other || !in[*other] || done[*other]) return;
        done[*other] = true;
        out.push_back(*other);
      });
    return out;
  }

  std::optional<Polygon> border_of(const std::vector<std::size_t>& faces, const std::vector<bool>& in) const {
    struct Next {
      Point2 to;
      std::int64_t node;
    };
    std::map<Point2, Next> next;
    bool touches = false;
    for (const std::size_t f : faces)
      for_each_edge(f, [&](const Edge& e, std::int64_t node) {
        const auto other = beyond(e);
        if (other && in[*other]) return;
        touches = !next.emplace(e.first, Next{e.second, node}).second || touches;
      });
    if (touches) return std::nullopt;
    Polygon out;
    while (!next.empty()) {
      Ring ring;  // begins at its least point
      const Point2 first = next.begin()->first;
      for (Point2 at = first;;) {
        const auto found = next.find(at);
        if (found == next.end()) return std::nullopt;
        ring.points.push_back(at);
        ring.nodes.push_back(found->second.node);
        at = found->second.to;
        next.erase(found);
        if (at == first) break;
      }
      if (geometry::signed_area(ring.points) < 0)
        out.holes.push_back(std::move(ring));
      else if (out.outer.points.empty())
        out.outer = std::move(ring);
      else
        return std::nullopt;
    }
    if (!geometry::strictly_simple(out) || !geometry::rings_apart(out)) return std::nullopt;
    return out;
  }

  const std::vector<Piece>& group_;
  std::vector<geometry::Face> faces_;
  std::map<Edge, std::vector<std::pair<std::uint64_t, int>>> lines_;  ///< by edge, the lesser end first
  std::map<Edge, std::size_t> left_of_;
  std::vector<std::vector<int>> winding_;  ///< by face and piece
  std::vector<std::vector<bool>> kept_;
  std::vector<std::size_t> order_;  ///< of pieces, in which they are asked
};

bool same(const Polygon& a, const Polygon& b) {
  return a.outer.points == b.outer.points &&
         std::equal(a.holes.begin(), a.holes.end(), b.holes.begin(), b.holes.end(),
                    [](const Ring& g, const Ring& h) { return g.points == h.points; });
}

/// Whether nothing that is worth a part is left to a piece.
bool vanishes(const Drawing& drawing, std::size_t piece) {
  return drawing.kept(piece) < kLeastShare * drawing.drawn(piece);
}

/// Drops what is no piece worth a part. Of a small thing, as a cross on a spire, no piece may be worth one: then all but
/// strips stay, unless it `vanishes`.
void drop_slivers(std::vector<Polygon>& polygons, bool vanishes) {
  const bool small = !vanishes && std::none_of(polygons.begin(), polygons.end(), worth_a_part);
  std::erase_if(polygons,
                [&](const Polygon& p) { return small ? geometry::equivalent_width(p) < kStrip : !worth_a_part(p); });
}

/// Mapped parts of which no piece is left.
void settle(const model::Building& building, const std::map<std::size_t, model::OsmId>& represented,
            std::vector<model::SettledPart>& settled) {
  for (const auto& [part, by] : represented) {
    const std::uint32_t mapped = building.parts[part].mapped_index;
    bool stands = mapped == building.mapped_index;  // its state is the building's
    for (std::size_t i = 0; i < building.parts.size() && !stands; ++i)
      stands = building.parts[i].mapped_index == mapped && (i < part || !represented.contains(i)) && i != part;
    if (!stands) settled.push_back({mapped, model::ObjectState::represented, by});
  }
}

/// One round. \return whether plans changed so that another may find something
bool separate_once(model::Building& building, const RepairOptions& options, std::vector<model::SettledPart>& settled,
                   model::Report& report) {
  std::vector<BuildingPart>& parts = building.parts;
  bool again = false;
  std::map<std::size_t, std::vector<Polygon>> fresh;  // by part
  std::map<std::size_t, model::OsmId> represented;    // by part
  for (const std::vector<Piece>& group : groups_of(parts, building.mapped)) {
    const Drawing drawing(parts, group);
    for (std::size_t i = 0; i < group.size(); ++i) {
      const BuildingPart& part = parts[group[i].part];
      const double lost = drawing.drawn(i) - drawing.kept(i);
      std::vector<Polygon> polygons = drawing.united(i, lost <= 0);
      if (geometry::cut_slivers(polygons, options.spike_width) > 0 || lost > 0) again = true;
      if (lost > 0 || polygons.size() > 1) drop_slivers(polygons, vanishes(drawing, i));
      if (polygons.empty() && lost > 0 && vanishes(drawing, i)) {
        if (const auto taker = drawing.strongest_over(i)) {
          const BuildingPart& other = parts[group[*taker].part];
          report.add(part.osm, model::IssueCode::parts_overlap,
                     square_metres(lost) + " with " + other.osm.text() + ", which stands for it");
          represented[group[i].part] = other.osm;
          continue;
        }
        report.add(part.osm, model::IssueCode::parts_overlap,
                   square_metres(lost) + " with others; stays, it is higher");
        continue;
      }
      // What would touch itself stays.
      if (polygons.empty()) polygons = drawing.united(i, true);
      if (polygons.empty() || (polygons.size() == 1 && same(polygons[0], part.plan))) continue;
      restore_nodes(polygons, std::vector<Polygon>{part.plan});
      if (lost > kTold)
        report.add(part.osm, model::IssueCode::parts_overlap, square_metres(lost) + " along walls of other parts");
      fresh[group[i].part] = std::move(polygons);
    }
  }
  if (fresh.empty() && represented.empty()) return false;
  settle(building, represented, settled);
  std::vector<BuildingPart> out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (represented.contains(i)) continue;
    const auto found = fresh.find(i);
    if (found == fresh.end())
      out.push_back(std::move(parts[i]));
    else
      add_pieces(out, parts[i], std::move(found->second));
  }
  parts = std::move(out);
  return again;
}

}  // namespace

void separate_parts(model::Building& building, const RepairOptions& options, std::vector<model::SettledPart>& settled,
                    model::Report& report) {
  for (int round = 0; round < kRounds && building.parts.size() > 1; ++round)
    if (!separate_once(building, options, settled, report)) return;
}

}  // namespace blockrand::repair
