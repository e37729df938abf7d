#include "pipeline/outputs/citygml/flat_openings.h"

#include <algorithm>
#include <limits>
#include <map>

#include "pipeline/model/vector.h"

namespace blockrand::outputs {
namespace {

using model::Solid;

constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();

/// Where the corners of an opening's polygon come from: by vertex the one of the wall, across a reveal.
std::map<std::uint32_t, std::uint32_t> corners_in_wall(const Solid& solid, const model::Opening& opening) {
  std::map<std::uint32_t, std::uint32_t> out;
  for (const Solid::Loop& loop : solid.loops_of(solid.faces[opening.polygon]))
    for (const std::uint32_t v : solid.indices_of(loop)) out.emplace(v, kGone);
  for (std::uint32_t r = 0; r < opening.reveal_count; ++r)
    for (const Solid::Loop& loop : solid.loops_of(solid.faces[opening.first_reveal + r])) {
      const auto ring = solid.indices_of(loop);
      for (std::size_t i = 0; i < ring.size(); ++i)
        for (const std::size_t beside : {i + 1, i + ring.size() - 1})
          if (const auto inner = out.find(ring[i]); inner != out.end())
            if (const std::uint32_t v = ring[beside % ring.size()]; out.count(v) == 0) inner->second = v;
    }
  return out;
}

bool closes_a_hole(const model::Opening& o) { return o.kind != model::OpeningKind::passage && o.reveal_count > 0; }

}  // namespace

FlatOpenings flat_openings(const model::Detail& detail) {
  const Solid& from = detail.solid;
  FlatOpenings out;
  out.depth.assign(detail.openings.size(), 0);
  std::vector<std::uint32_t> face_at(from.faces.size(), 0);  // kGone: a reveal
  std::vector<std::uint32_t> vertex_at(from.vertices.size());
  std::vector<bool> moves(from.faces.size(), false);
  for (std::uint32_t v = 0; v < vertex_at.size(); ++v) vertex_at[v] = v;
  for (std::size_t o = 0; o < detail.openings.size(); ++o) {
    const model::Opening& opening = detail.openings[o];
    if (!closes_a_hole(opening)) continue;
    const auto corners = corners_in_wall(from, opening);
    // Every corner has a reveal on both sides; an opening where one has none keeps its reveals.
    if (std::any_of(corners.begin(), corners.end(), [](const auto& c) { return c.second == kGone; })) continue;
    for (const auto& [inner, outer] : corners) {
      vertex_at[inner] = outer;
      out.depth[o] = length(from.vertices[inner] - from.vertices[outer]);
    }
    moves[opening.polygon] = true;
    for (std::uint32_t r = 0; r < opening.reveal_count; ++r) face_at[opening.first_reveal + r] = kGone;
  }

  Solid& solid = out.detail.solid;
  solid.vertices = from.vertices;
  for (std::size_t f = 0; f < from.faces.size(); ++f) {
    if (face_at[f] == kGone) continue;
    face_at[f] = static_cast<std::uint32_t>(solid.faces.size());
    model::Face face = from.faces[f];
    face.first_loop = static_cast<std::uint32_t>(solid.loops.size());
    for (const Solid::Loop& loop : from.loops_of(from.faces[f])) {
      solid.loops.push_back({static_cast<std::uint32_t>(solid.indices.size()), loop.count});
      for (const std::uint32_t v : from.indices_of(loop)) solid.indices.push_back(moves[f] ? vertex_at[v] : v);
    }
    solid.faces.push_back(face);
  }
  out.detail.openings = detail.openings;
  for (std::size_t o = 0; o < out.detail.openings.size(); ++o) {
    model::Opening& opening = out.detail.openings[o];
    const bool flush = moves[opening.polygon];
    opening.polygon = face_at[opening.polygon];
    opening.wall = face_at[opening.wall];
    if (flush) opening.reveal_count = opening.first_reveal = 0;
    if (opening.reveal_count > 0) opening.first_reveal = face_at[opening.first_reveal];
  }
  return out;
}

std::vector<double> usual_depths(const FlatOpenings& flat) {
  std::vector<std::map<double, std::size_t>> counts(flat.detail.solid.faces.size());
  for (std::size_t o = 0; o < flat.depth.size(); ++o)
    if (const model::Opening& opening = flat.detail.openings[o]; opening.kind != model::OpeningKind::passage)
      ++counts[opening.wall][flat.depth[o]];
  std::vector<double> usual(counts.size(), 0);
  for (std::size_t wall = 0; wall < counts.size(); ++wall) {
    std::size_t most = 0;
    for (const auto& [depth, count] : counts[wall])
      if (count > most) most = count, usual[wall] = depth;
  }
  return usual;
}

}  // namespace blockrand::outputs
