#include "styles/roofs/parapets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/planar_faces.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/roof_surfaces.h"
#include "pipeline/geometry/weighted_skeleton.h"
#include "styles/roofs/cut_cells.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roofs {

using geometry::Grid3;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofEdge;
using model::RoofElementKind;
using model::SurfaceKind;

namespace {

constexpr double kRising = 0.0524;  ///< tan 3 degrees: a wall top steeper than this is a gable's

/// A border of a level surface.
struct Border {
  PlanEdge shape;
  std::optional<std::uint32_t> edge;  ///< the plan edge it lies on
  double height = 0;                  ///< m, of its parapet; 0 for none
};

/// The strips of all borders with a parapet, of `width` metres, as pieces of the deck; `surface` is the border's
/// number.
std::optional<std::vector<RoofPiece>> strips(const Polygon& deck, const std::vector<Border>& borders, double width,
                                             std::span<const std::vector<Point2>> keep_clear, double coarseness) {
  std::vector<geometry::EdgeProfile> profiles;
  for (const Border& b : borders) profiles.push_back({b.height > 0 ? 1.0 : geometry::kUpright, {}});
  const auto skeleton = geometry::weighted_skeleton(deck, profiles, width);
  if (!skeleton) return std::nullopt;
  const auto surfaces = geometry::roof_surfaces(deck, *skeleton, 1, coarseness);
  std::vector<Polygon> pieces;
  std::vector<std::uint32_t> border_of;
  for (const auto& surface : surfaces.surfaces) {
    if (surface.upright || surface.edge == geometry::WeightedSkeletonFace::kDeck) continue;
    Polygon piece;
    for (std::size_t l = 0; l < surface.loops.size(); ++l) {
      model::Ring ring;
      for (const Point3& p : surface.loops[l]) ring.points.push_back(p.xy());
      ring.nodes.assign(ring.points.size(), 0);
      if (l == 0)
        piece.outer = std::move(ring);
      else
        piece.holes.push_back(std::move(ring));
    }
    pieces.push_back(std::move(piece));
    border_of.push_back(surface.edge);
  }
  // Borders that continue each other on one line are one to the skeleton: cut where one has a parapet and the next has
  // not, or a lower one.
  std::vector<std::vector<Point2>> cuts;
  for (std::size_t i = 0; i < borders.size(); ++i) {
    const Border &b = borders[i], &next = borders[b.shape.after];
    if (skeleton->merged[i] != skeleton->merged[b.shape.after] || b.height == next.height) continue;
    const Point2 p = b.shape.to, in = b.shape.inward();
    cuts.push_back({p, {p.x + in.x * 2 * width, p.y + in.y * 2 * width}});
  }
  for (const auto& place : keep_clear) {
    cuts.push_back(place);
    cuts.back().push_back(place.front());
  }
  std::vector<RoofPiece> out;
  if (cuts.empty()) {
    for (std::size_t i = 0; i < pieces.size(); ++i)
      out.push_back({std::move(pieces[i]), static_cast<std::int32_t>(border_of[i]), 0});
    return out;
  }
  for (RoofPiece& piece : pieces_of(pieces, cuts)) {
    const Point2 inside = geometry::inner_point(piece.plan);
    if (std::any_of(keep_clear.begin(), keep_clear.end(), [&](const auto& k) { return geometry::contains(k, inside); }))
      continue;
    // Of the borders on its line the one that lies beside it.
    const std::uint32_t line = skeleton->merged[border_of[static_cast<std::size_t>(piece.surface)]];
    double nearest = 1e18;
    for (std::size_t i = 0; i < borders.size(); ++i) {
      if (skeleton->merged[i] != line) continue;
      const double d = geometry::distance_to_segment(inside, borders[i].shape.from, borders[i].shape.to);
      if (d >= nearest) continue;
      nearest = d;
      piece.surface = static_cast<std::int32_t>(i);
    }
    if (borders[static_cast<std::size_t>(piece.surface)].height > 0) out.push_back(std::move(piece));
  }
  return out;
}

}  // namespace

BuiltElements parapets(const Polygon& plan, const Roof& roof, std::span<const RoofEdge> edges,
                       const std::vector<bool>& bare, std::span<const std::vector<Point2>> keep_clear,
                       const ParapetOptions& options) {
  std::map<std::pair<Grid3, Grid3>, std::uint32_t> edge_at;
  std::set<std::uint32_t> gables;
  for (const TopSegment& s : top_segments(plan, roof)) {
    edge_at[{geometry::to_grid(s.from), geometry::to_grid(s.to)}] = s.edge;
    if (std::fabs(s.to.z - s.from.z) > kRising * s.length()) gables.insert(s.edge);
  }
  BuiltElements out;
  std::set<std::uint32_t> asked, lost;
  for (const Roof::Surface& surface : roof.surfaces) {
    if (!is_level(surface)) continue;
    Polygon deck;
    for (std::size_t l = 0; l < surface.loops.size(); ++l) {
      model::Ring ring;
      for (const Point3& p : surface.loops[l]) ring.points.push_back(p.xy());
      ring.nodes.assign(ring.points.size(), 0);
      if (l == 0)
        deck.outer = std::move(ring);
      else
        deck.holes.push_back(std::move(ring));
    }
    std::vector<Border> borders;
    for (const PlanEdge& shape : plan_edges(deck)) borders.push_back({shape, {}, 0});
    std::size_t number = 0;
    bool any = false;
    for (const auto& loop : surface.loops)
      for (std::size_t i = 0; i < loop.size(); ++i, ++number) {
        Border& border = borders[number];
        const auto found = edge_at.find({geometry::to_grid(loop[i]), geometry::to_grid(loop[(i + 1) % loop.size()])});
        if (found == edge_at.end()) {
          if (options.around_decks) border.height = options.height;
        } else {
          border.edge = found->second;
          const bool party = !edges.empty() && edges[found->second] == RoofEdge::party_wall;
          border.height = party ? options.party_wall_height : options.height;
          if (!bare.empty() && bare[found->second]) border.height = 0;
          if (!options.on_gables && gables.contains(found->second)) border.height = 0;
        }
        any = any || border.height > 0;
      }
    if (!any) continue;
    // A stretch between two open ends that is too short for a wall.
    for (Border& b : borders)
      if (b.shape.length < options.least_length && borders[b.shape.before].height == 0 &&
          borders[b.shape.after].height == 0)
        b.height = 0;
    for (const Border& b : borders)
      if (b.height > 0 && b.edge) asked.insert(*b.edge);

    const RoofPlane plane = plane_of(surface);
    std::optional<std::vector<RoofPiece>> pieces;
    CellBodies made;
    for (const double coarseness : kCoarseness) {
      pieces = strips(deck, borders, options.width, keep_clear, coarseness);
      if (!pieces) continue;
      std::vector<PlanCell> cells;
      for (const RoofPiece& piece : *pieces) {
        const double height = borders[static_cast<std::size_t>(piece.surface)].height;
        PlanCell cell;
        const auto add = [&](const model::Ring& ring) {
          cell.loops.emplace_back();
          for (const Point2 p : ring.points) {
            const double z = plane.height_at(p);
            cell.loops.back().push_back({p, z, z + height, false});
          }
        };
        add(piece.plan.outer);
        for (const auto& hole : piece.plan.holes) add(hole);
        cells.push_back(std::move(cell));
      }
      made = bodies_of_cells(cells, {SurfaceKind::roof, SurfaceKind::wall, SurfaceKind::closure});
      if (made.lost.empty()) break;
    }
    // Edges on one line may have one piece in common: what counts is whether a wall stands right behind the edge.
    const auto stands_at = [&](const Border& b) {
      constexpr double kBehind = 0.005;  // m
      const Point2 in = b.shape.inward(),
                   middle{(b.shape.from.x + b.shape.to.x) / 2, (b.shape.from.y + b.shape.to.y) / 2};
      const Point2 behind{middle.x + in.x * kBehind, middle.y + in.y * kBehind};
      for (std::size_t i = 0; i < pieces->size(); ++i)
        if (!std::binary_search(made.lost.begin(), made.lost.end(), static_cast<std::uint32_t>(i)) &&
            geometry::contains((*pieces)[i].plan, behind))
          return true;
      return false;
    };
    for (const Border& b : borders)
      if (b.height > 0 && b.edge && (!pieces || !stands_at(b))) lost.insert(*b.edge);
    for (model::Solid& solid : made.solids) out.bodies.push_back({RoofElementKind::parapet, std::move(solid), {}});
  }
  out.asked = static_cast<int>(asked.size());
  out.refused = static_cast<int>(lost.size());
  return out;
}

}  // namespace blockrand::roofs
