#include "importers/osm/area_assembly.h"

#include <algorithm>
#include <map>
#include <osmium/area/assembler.hpp>
#include <osmium/builder/osm_object_builder.hpp>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/area.hpp>
#include <set>
#include <unordered_set>

namespace blockrand::importers::osm {
namespace {

using model::IssueCode;

struct MemberLine {
  std::int64_t way = 0;
  Role role = Role::none;
  WayLine line;
};

std::size_t distinct_points(const std::vector<Vertex>& vertices) {
  std::set<model::Location> seen;  // stops at three: almost always after three steps
  for (const Vertex& v : vertices) {
    seen.insert(v.location);
    if (seen.size() >= 3) break;
  }
  return seen.size();
}

/// Twice the signed area, in squared units of 1e-7 degrees. Doubles: only compared in size and sign.
double twice_area(const std::vector<Vertex>& ring) {
  double sum = 0;
  const model::Location o = ring.front().location;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const double ax = double(ring[i].location.lon) - o.lon, ay = double(ring[i].location.lat) - o.lat;
    const double bx = double(ring[i + 1].location.lon) - o.lon, by = double(ring[i + 1].location.lat) - o.lat;
    sum += ax * by - bx * ay;
  }
  return sum;
}

/// Even-odd rule; a point on the boundary may fall on either side.
bool contains(const std::vector<Vertex>& ring, model::Location p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const model::Location a = ring[i].location, b = ring[j].location;
    if ((a.lat > p.lat) == (b.lat > p.lat)) continue;
    const double x = a.lon + (double(b.lon) - a.lon) * (double(p.lat) - a.lat) / (double(b.lat) - a.lat);
    if (p.lon < x) inside = !inside;
  }
  return inside;
}

/// libosmium's answer; empty when it refuses.
std::vector<AreaRing> assemble_by_osmium(std::int64_t id, const std::vector<const MemberLine*>& lines) {
  using namespace osmium::builder;
  osmium::memory::Buffer buffer{4096, osmium::memory::Buffer::auto_grow::yes};
  std::vector<std::size_t> offsets;
  for (const MemberLine* member : lines) {
    {
      WayBuilder builder{buffer};
      builder.set_id(member->way);
      WayNodeListBuilder nodes{builder};
      for (const Vertex& v : member->line.vertices)
        nodes.add_node_ref(osmium::NodeRef{v.node, osmium::Location{v.location.lon, v.location.lat}});
    }
    offsets.push_back(buffer.commit());
  }
  std::size_t relation_offset = 0;
  {
    {
      RelationBuilder builder{buffer};
      builder.set_id(id);
      RelationMemberListBuilder list{builder};
      for (const MemberLine* member : lines)
        list.add_member(osmium::item_type::way, member->way,
                        member->role == Role::inner   ? "inner"
                        : member->role == Role::outer ? "outer"
                                                      : "");
    }
    relation_offset = buffer.commit();
  }
  std::vector<const osmium::Way*> ways;
  for (const std::size_t offset : offsets) ways.push_back(&buffer.get<osmium::Way>(offset));
  osmium::area::AssemblerConfig config;
  config.create_empty_areas = false;
  osmium::area::Assembler assembler{config};
  osmium::memory::Buffer out{4096, osmium::memory::Buffer::auto_grow::yes};
  std::vector<AreaRing> rings;
  if (!assembler(buffer.get<osmium::Relation>(relation_offset), ways, out)) return rings;
  const auto add = [&](const osmium::NodeRefList& nodes, bool inner) {
    AreaRing ring;
    ring.inner = inner;
    for (const osmium::NodeRef& n : nodes) ring.vertices.push_back({n.ref(), {n.x(), n.y()}});
    ring.vertices.pop_back();
    rings.push_back(std::move(ring));
  };
  for (const osmium::Area& area : out.select<osmium::Area>())
    for (const osmium::OuterRing& outer : area.outer_rings()) {
      add(outer, false);
      for (const osmium::InnerRing& inner : area.inner_rings(outer)) add(inner, true);
    }
  return rings;
}

struct Ring {
  std::vector<Vertex> vertices;
  std::vector<const MemberLine*> members;
  bool inner = false;
};

/// Closed rings that can be made from the lines, each line used once: first the closed lines, then chains from the
/// first unused line on, joined by node id, else by position, preferably in one role.
std::vector<Ring> link_rings(const std::vector<const MemberLine*>& lines) {
  std::vector<Ring> rings;
  std::vector<const MemberLine*> open;
  const auto is_inner = [](const MemberLine* m) { return m->role == Role::inner; };
  const auto close = [&](std::vector<Vertex> vertices, std::vector<const MemberLine*> members) {
    vertices.pop_back();
    if (distinct_points(vertices) < 3) return;
    const auto inner = std::count_if(members.begin(), members.end(), is_inner);
    const bool inner_ring = 2 * static_cast<std::size_t>(inner) > members.size();
    rings.push_back({std::move(vertices), std::move(members), inner_ring});
  };
  for (const MemberLine* member : lines) {
    if (member->line.vertices.size() < 2) continue;
    if (member->line.closed)
      close(member->line.vertices, {member});
    else
      open.push_back(member);
  }
  std::vector<bool> used(open.size(), false);
  std::multimap<model::Location, std::size_t> ends;
  for (std::size_t i = 0; i < open.size(); ++i) {
    ends.emplace(open[i]->line.vertices.front().location, i);
    ends.emplace(open[i]->line.vertices.back().location, i);
  }
  for (std::size_t start = 0; start < open.size(); ++start) {
    if (used[start]) continue;
    std::vector<Vertex> chain = open[start]->line.vertices;
    std::vector<const MemberLine*> members{open[start]};
    std::vector<std::size_t> taken{start};
    used[start] = true;
    while (chain.front().location != chain.back().location) {
      std::size_t best = open.size();
      int best_rank = 4;
      const auto [from, to] = ends.equal_range(chain.back().location);
      for (auto it = from; it != to; ++it) {
        const std::size_t i = it->second;
        if (used[i]) continue;
        const auto& v = open[i]->line.vertices;
        const bool same_node = v.front().node == chain.back().node || v.back().node == chain.back().node;
        const int rank = (same_node ? 0 : 1) + (is_inner(open[i]) == is_inner(open[start]) ? 0 : 2);
        if (rank < best_rank || (rank == best_rank && open[i]->way < open[best]->way)) best = i, best_rank = rank;
      }
      if (best == open.size()) break;
      used[best] = true;
      taken.push_back(best);
      members.push_back(open[best]);
      std::vector<Vertex> next = open[best]->line.vertices;
      if (next.front().location != chain.back().location) std::reverse(next.begin(), next.end());
      chain.insert(chain.end(), next.begin() + 1, next.end());
    }
    if (chain.front().location == chain.back().location) {
      close(std::move(chain), std::move(members));
    } else {
      for (const std::size_t i : taken)
        if (i != start) used[i] = false;  // they may close another ring
    }
  }
  return rings;
}

/// Of rings through the same positions (a way drawn twice) the first.
void drop_repeated(std::vector<Ring>& rings) {
  std::set<std::vector<model::Location>> seen;
  std::erase_if(rings, [&](const Ring& ring) {
    std::vector<model::Location> positions;
    for (const Vertex& v : ring.vertices) positions.push_back(v.location);
    std::sort(positions.begin(), positions.end());
    return !seen.insert(std::move(positions)).second;
  });
}

/// Outer rings each followed by its inner ones, by role; an inner ring in no outer ring is left out.
std::vector<AreaRing> rings_by_role(std::vector<Ring> rings) {
  std::vector<AreaRing> out;
  if (rings.empty()) return out;
  if (std::all_of(rings.begin(), rings.end(), [](const Ring& r) { return r.inner; })) {
    // Wrong roles: the largest must be the outer one.
    auto largest = std::max_element(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) {
      return std::abs(twice_area(a.vertices)) < std::abs(twice_area(b.vertices));
    });
    largest->inner = false;
  }
  std::vector<std::vector<std::size_t>> holes(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (!rings[i].inner) continue;
    std::size_t home = rings.size();
    for (std::size_t o = 0; o < rings.size(); ++o) {
      if (rings[o].inner || !contains(rings[o].vertices, rings[i].vertices.front().location)) continue;
      if (home == rings.size() || std::abs(twice_area(rings[o].vertices)) < std::abs(twice_area(rings[home].vertices)))
        home = o;
    }
    if (home < rings.size()) holes[home].push_back(i);
  }
  for (std::size_t o = 0; o < rings.size(); ++o) {
    if (rings[o].inner) continue;
    out.push_back({std::move(rings[o].vertices), false});
    for (const std::size_t i : holes[o]) out.push_back({std::move(rings[i].vertices), true});
  }
  return out;
}

std::string list_of(const std::vector<std::int64_t>& ways) {
  std::string out;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (i == 5) return out + " and " + std::to_string(ways.size() - i) + " more";
    out += (i > 0 ? ", w" : "w") + std::to_string(ways[i]);
  }
  return out;
}

}  // namespace

bool Area::has_holes() const {
  return std::any_of(rings.begin(), rings.end(), [](const AreaRing& r) { return r.inner; });
}

WayLine locate(const RawData& data, const RawWay& way) {
  WayLine line;
  const auto refs = data.refs_of(way);
  line.vertices.reserve(refs.size());
  for (const std::int64_t ref : refs) {
    const model::Location location = data.positions.find(ref);
    if (is_known(location))
      line.vertices.push_back({ref, location});
    else if (location == kInvalid)
      ++line.invalid;
    else
      ++line.missing;
  }
  const bool closed_by_id = refs.size() > 1 && refs.front() == refs.back();
  if (closed_by_id && line.missing + line.invalid > 0 && !line.vertices.empty() &&
      !is_known(data.positions.find(refs.front())))
    line.vertices.push_back(line.vertices.front());  // the closing node itself is not known: the ring closes without it
  line.closed = closed_by_id || (line.vertices.size() > 2 && line.missing + line.invalid == 0 &&
                                 line.vertices.front().location == line.vertices.back().location);
  return line;
}

Area assemble_way(const RawData& data, const RawWay& way) {
  Area area;
  WayLine line = locate(data, way);
  const std::size_t lost = line.missing + line.invalid;
  if (way.refs.count < 2) {
    area.code = IssueCode::too_few_points;
    area.detail = std::to_string(way.refs.count) + " nodes";
    return area;
  }
  if (!line.closed) {
    area.code = IssueCode::open_way;
    if (lost > 0) area.detail = std::to_string(lost) + " of " + std::to_string(way.refs.count) + " nodes are not known";
    return area;
  }
  if (!line.vertices.empty()) line.vertices.pop_back();
  if (lost > 0)
    area.detail = std::to_string(lost) + " of " + std::to_string(way.refs.count - 1) + " nodes are not known";
  if (distinct_points(line.vertices) < 3) {
    area.code = line.missing > 0   ? IssueCode::outline_incomplete
                : line.invalid > 0 ? IssueCode::invalid_location
                                   : IssueCode::too_few_points;
    return area;
  }
  if (lost > 0) area.code = IssueCode::members_missing;
  area.rings.push_back({std::move(line.vertices), false});
  return area;
}

Area assemble_relation(const RawData& data, const RawRelation& relation, bool roles_only) {
  std::vector<RawMember> members;
  for (const RawMember& m : data.members_of(relation)) {
    if (m.type != model::OsmType::way) continue;
    const bool shaped = m.role == Role::outer || m.role == Role::inner || m.role == Role::outline;
    if (shaped || !roles_only) members.push_back(m);
  }
  return assemble_members(data, relation.id, members);
}

Area assemble_members(const RawData& data, std::int64_t relation_id, const std::vector<RawMember>& members) {
  Area area;
  std::vector<MemberLine> lines;
  std::vector<std::int64_t> absent;
  std::size_t missing_nodes = 0, invalid_nodes = 0;
  std::unordered_set<std::int64_t> seen;
  for (const RawMember& member : members) {
    if (!seen.insert(member.ref).second) continue;  // the same way twice is the same way
    const RawWay* way = data.way(member.ref);
    if (way == nullptr) {
      absent.push_back(member.ref);
      continue;
    }
    lines.push_back({member.ref, member.role, locate(data, *way)});
    missing_nodes += lines.back().line.missing;
    invalid_nodes += lines.back().line.invalid;
  }
  const bool incomplete = !absent.empty() || missing_nodes + invalid_nodes > 0;
  if (!absent.empty()) area.detail = "not in the file: " + list_of(absent);
  if (missing_nodes + invalid_nodes > 0)
    area.detail +=
        (area.detail.empty() ? "" : "; ") + std::to_string(missing_nodes + invalid_nodes) + " nodes are not known";

  std::vector<const MemberLine*> all;
  for (const MemberLine& line : lines) all.push_back(&line);
  if (!all.empty()) area.rings = assemble_by_osmium(relation_id, all);
  if (!area.rings.empty()) {
    if (incomplete) area.code = IssueCode::members_missing;
    return area;
  }

  // What is whole: rings that close, first once more in libosmium's eyes without the rest.
  std::vector<Ring> rings = link_rings(all);
  if (std::any_of(rings.begin(), rings.end(), [](const Ring& r) { return !r.inner; }) || !incomplete) {
    std::unordered_set<const MemberLine*> whole;
    for (const Ring& ring : rings) whole.insert(ring.members.begin(), ring.members.end());
    std::vector<const MemberLine*> rest;
    for (const MemberLine* line : all)
      if (whole.contains(line)) rest.push_back(line);
    if (!rest.empty() && rest.size() < all.size()) area.rings = assemble_by_osmium(relation_id, rest);
    if (area.rings.empty()) {
      drop_repeated(rings);
      area.rings = rings_by_role(std::move(rings));
    }
    if (!area.rings.empty()) {
      const std::size_t left_out = all.size() - rest.size();
      area.code = incomplete ? IssueCode::members_missing : IssueCode::relation_repaired;
      if (left_out > 0)
        area.detail += (area.detail.empty() ? "" : "; ") + std::to_string(left_out) + " open ways left out";
      if (area.detail.empty()) area.detail = "rings cross or overlap";
      return area;
    }
  }
  area.code = !absent.empty() || missing_nodes > 0 ? IssueCode::outline_incomplete
              : invalid_nodes > 0                  ? IssueCode::invalid_location
                                                   : IssueCode::ring_broken;
  if (area.detail.empty()) area.detail = lines.empty() ? "no member ways" : "the member ways form no closed ring";
  return area;
}

}  // namespace blockrand::importers::osm
