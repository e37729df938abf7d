// All elements of edges on one roof together, as a grammar would place them: what stands where, and who gives way.
#pragma once

#include <optional>
#include <vector>

#include "styles/roofs/caps.h"
#include "styles/roofs/firewalls.h"
#include "styles/roofs/gables.h"
#include "styles/roofs/overhangs.h"
#include "styles/roofs/parapets.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roof_checks {

/// A plan edge's surroundings.
struct Neighbourhood {
  bool party_wall = false;
  std::vector<roofs::NeighbourTop> neighbour;
  double room = 1e9;  ///< m before the wall
};

/// What was put on a roof, by element.
struct RoofWithEdges {
  std::vector<model::RoofInstallation> bodies;
  roofs::BuiltElements gables, firewalls, parapets, overhangs, caps;  ///< counts; the bodies are all in `bodies`
  roofs::GableRefusal refusal = roofs::GableRefusal::none;
};

/// Gables first, then firewalls between them, parapets between those, overhangs where nothing else stands, caps up to
/// all of them. \param gable  an edge and what is to stand on it
inline RoofWithEdges dress(const model::Polygon& plan, const roofs::Roof& roof,
                           const std::vector<Neighbourhood>& around,
                           const std::optional<std::pair<std::uint32_t, roofs::GableOptions>>& gable) {
  RoofWithEdges out;
  const auto take = [&](roofs::BuiltElements& into, roofs::BuiltElements&& from) {
    for (auto& body : from.bodies) out.bodies.push_back(std::move(body));
    from.bodies.clear();
    into = std::move(from);
  };
  const std::size_t count = roof.wall_tops.size();
  std::vector<bool> bare(count, false);
  std::vector<std::vector<model::Point2>> taken;
  if (gable) {
    auto built = roofs::ornamental_gable(plan, roof, gable->first, gable->second);
    roofs::BuiltElements counts;
    out.refusal = built.refusal;
    counts.asked = 1;
    if (built.body) {
      bare[gable->first] = true;
      counts.bodies.push_back(std::move(*built.body));
      taken.push_back(std::move(built.place));
    } else {
      counts.refused = 1;
    }
    take(out.gables, std::move(counts));
  }
  std::vector<roofs::FirewallSide> sides(count);
  std::vector<model::RoofEdge> edges(count, model::RoofEdge::open);
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (!around[i].party_wall) continue;
    edges[i] = model::RoofEdge::party_wall;
    if (!bare[i]) sides[i] = {true, around[i].neighbour};
  }
  auto walls = roofs::firewalls(plan, roof, sides, taken);
  taken.insert(taken.end(), walls.places.begin(), walls.places.end());
  take(out.firewalls, std::move(walls.elements));
  take(out.parapets, roofs::parapets(plan, roof, edges, bare, taken));
  // A wall on a level roof's border ends in its parapet, all others in eaves or verges.
  std::vector<bool> level(count, true);
  for (const auto& s : roofs::top_segments(plan, roof))
    if (s.surface < 0 || !roofs::is_level(roof.surfaces[static_cast<std::size_t>(s.surface)])) level[s.edge] = false;
  std::vector<roofs::OverhangRoom> rooms(count);
  for (std::size_t i = 0; i < count; ++i) {
    rooms[i].edge = edges[i];
    if (i < around.size()) rooms[i].room = around[i].room;
    if (bare[i] || level[i]) rooms[i].room = 0;
  }
  auto beyond = roofs::overhangs(plan, roof, rooms);
  take(out.overhangs, std::move(beyond.elements));
  take(out.caps, roofs::ridge_and_hip_caps(roof, beyond.corners, taken));
  return out;
}

/// A front for a gable: of the edges that are free, the longest between 4 m and 16 m, rising ones first.
inline std::optional<std::uint32_t> gable_edge(const model::Polygon& plan, const roofs::Roof& roof,
                                               const std::vector<Neighbourhood>& around) {
  const auto edges = roofs::plan_edges(plan);
  std::optional<std::uint32_t> best;
  double best_rank = 0;
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    if (edges[i].ring != 0 || edges[i].length < 4 || edges[i].length > 16) continue;
    if (i < around.size() && around[i].party_wall) continue;
    const double rank = edges[i].length + (roof.wall_tops[i].size() > 2 ? 100 : 0);
    if (rank > best_rank) best = i, best_rank = rank;
  }
  return best;
}

}  // namespace blockrand::roof_checks
