#include "pipeline/footprints/shard.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <unordered_map>

#include "pipeline/georef/tiles.h"

namespace blockrand::footprints {

namespace {

using model::Extract;
using model::Location;
using model::MappedBuilding;
using model::ObjectKind;
using model::ObjectState;

constexpr std::int64_t kTurn = 3'600'000'000;  // 360 degrees in 1e-7 degrees

/// Raw position with the longitude unwrapped: 64 bits, may leave ±180 degrees.
struct Place {
  std::int64_t x = 0, y = 0;
};

Place unwrapped(Location p, std::int64_t reference_lon) {
  std::int64_t x = p.lon;
  if (x - reference_lon > kTurn / 2) x -= kTurn;
  if (reference_lon - x > kTurn / 2) x += kTurn;
  return {x, p.lat};
}

struct Box {
  std::int64_t min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  Place centre() const { return {min_x + (max_x - min_x) / 2, min_y + (max_y - min_y) / 2}; }
  bool contains(Place p) const { return p.x >= min_x && p.x <= max_x && p.y >= min_y && p.y <= max_y; }
  double area() const { return static_cast<double>(max_x - min_x) * static_cast<double>(max_y - min_y); }
};

std::int64_t reference_lon(const Extract& extract, const MappedBuilding& object) {
  return extract.vertices[extract.rings[object.rings.first].vertices.first].lon;
}

Box box_of(const Extract& extract, const MappedBuilding& object) {
  const std::int64_t reference = reference_lon(extract, object);
  Box box;
  bool first = true;
  for (const auto& ring : extract.rings_of(object.rings))
    for (const Location v : extract.mapped_vertices_of(ring)) {
      const Place p = unwrapped(v, reference);
      if (first) box = {p.x, p.y, p.x, p.y};
      first = false;
      box.min_x = std::min(box.min_x, p.x);
      box.max_x = std::max(box.max_x, p.x);
      box.min_y = std::min(box.min_y, p.y);
      box.max_y = std::max(box.max_y, p.y);
    }
  return box;
}

__extension__ typedef __int128 Int128;

int side(Place a, Place b, Place p) {
  const Int128 cross = static_cast<Int128>(b.x - a.x) * (p.y - a.y) - static_cast<Int128>(b.y - a.y) * (p.x - a.x);
  return (cross > 0) - (cross < 0);
}

/// Inside or on the boundary of the area that the rings enclose (even-odd over all rings).
bool contains(const Extract& extract, const MappedBuilding& area, Place p) {
  bool inside = false;
  for (const auto& ring : extract.rings_of(area.rings)) {
    const auto vertices = extract.vertices_of(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Place a = unwrapped(vertices[i], p.x), b = unwrapped(vertices[(i + 1) % vertices.size()], p.x);
      const int s = side(a, b, p);
      if (s == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
          p.y <= std::max(a.y, b.y))
        return true;
      if ((a.y > p.y) != (b.y > p.y) && (b.y > a.y) == (s > 0)) inside = !inside;
    }
  }
  return inside;
}

/// Share of the corners of a part that an outline holds.
double held_share(const Extract& extract, const MappedBuilding& outline, const MappedBuilding& part) {
  const std::int64_t reference = reference_lon(extract, outline);
  int held = 0, asked = 0;
  for (const auto& ring : extract.rings_of(part.rings)) {
    const auto vertices = extract.vertices_of(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Place a = unwrapped(vertices[i], reference);
      held += contains(extract, outline, a);
      ++asked;
    }
  }
  return asked == 0 ? 0 : static_cast<double>(held) / asked;
}

/// Cells of a coarse grid over raw coordinates. No BoxIndex: it asks for integers before anything is projected.
class OutlineIndex {
 public:
  explicit OutlineIndex(const Extract& extract) {
    for (std::uint32_t i = 0; i < extract.buildings.size(); ++i) {
      const MappedBuilding& b = extract.buildings[i];
      if (b.kind != ObjectKind::building || b.state != ObjectState::pending || b.rings.count == 0) continue;
      const Box box = box_of(extract, b);
      for (std::int64_t x = cell(box.min_x); x <= cell(box.max_x) && x < cell(box.min_x) + kMostCells; ++x)
        for (std::int64_t y = cell(box.min_y); y <= cell(box.max_y) && y < cell(box.min_y) + kMostCells; ++y)
          cells_[key(x, y)].push_back({i, box});
    }
  }

  template <class Visit>
  void for_each_at(Place p, Visit&& visit) const {
    const auto found = cells_.find(key(cell(p.x), cell(p.y)));
    if (found == cells_.end()) return;
    for (const Entry& e : found->second)
      if (e.box.contains(p)) visit(e.index, e.box);
  }

 private:
  struct Entry {
    std::uint32_t index;
    Box box;
  };
  static constexpr std::int64_t kCell = 20'000;    // 0.002 degrees, about 200 m
  static constexpr std::int64_t kMostCells = 100;  // no outline is longer than 20 km; a broken one must not fill memory
  static std::int64_t cell(std::int64_t v) { return v >= 0 ? v / kCell : -((-v + kCell - 1) / kCell); }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xffffffffu);
  }
  std::unordered_map<std::uint64_t, std::vector<Entry>> cells_;
};

/// Objects that share edges, transitively: groups in order of their first members, members in order.
std::vector<std::vector<std::uint32_t>> groups_by_edges(const Extract& extract,
                                                        const std::vector<std::uint32_t>& objects) {
  struct Edge {
    std::int64_t a, b;    // nodes, the lower first
    std::uint32_t owner;  // index into `objects`
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  for (std::uint32_t i = 0; i < objects.size(); ++i)
    for (const auto& ring : extract.rings_of(extract.buildings[objects[i]].rings)) {
      const auto nodes = extract.nodes_of(ring);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const std::int64_t a = nodes[k], b = nodes[(k + 1) % nodes.size()];
        if (a != b) edges.push_back({std::min(a, b), std::max(a, b), i});
      }
    }
  std::sort(edges.begin(), edges.end());
  std::vector<std::uint32_t> group(objects.size());
  std::iota(group.begin(), group.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].a != edges[i - 1].a || edges[i].b != edges[i - 1].b) continue;
    const std::uint32_t a = root(edges[i - 1].owner), b = root(edges[i].owner);
    group[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<std::uint32_t>> members(objects.size());
  for (std::uint32_t i = 0; i < objects.size(); ++i) members[root(i)].push_back(objects[i]);
  std::erase_if(members, [](const auto& m) { return m.empty(); });
  return members;
}

}  // namespace

model::Location box_centre(const Extract& extract, const MappedBuilding& object) {
  Place c = box_of(extract, object).centre();
  if (c.x > kTurn / 2) c.x -= kTurn;
  if (c.x < -kTurn / 2) c.x += kTurn;
  return {static_cast<std::int32_t>(c.x), static_cast<std::int32_t>(c.y)};
}

std::vector<Shard> make_shards(const Extract& extract, model::Report& report, int level) {
  const auto buildable = [&](const MappedBuilding& b) { return b.state == ObjectState::pending && b.rings.count > 0; };
  const auto index_of = [&](model::OsmId id) {
    const auto place = std::lower_bound(extract.buildings.begin(), extract.buildings.end(), id,
                                        [](const MappedBuilding& b, model::OsmId wanted) { return b.id < wanted; });
    return place != extract.buildings.end() && place->id == id
               ? static_cast<std::uint32_t>(place - extract.buildings.begin())
               : model::kNoIndex;
  };

  // What relations say comes first; the first relation in id order wins a part that two claim.
  std::map<std::uint32_t, std::uint32_t> outline_of_part;
  for (const auto& relation : extract.building_relations) {
    std::uint32_t outline = index_of(relation.outline);
    if (outline == model::kNoIndex) continue;
    // A duplicate's parts belong to whom it is a duplicate of.
    if (extract.buildings[outline].state == ObjectState::duplicate)
      outline = index_of(extract.buildings[outline].related);
    if (outline == model::kNoIndex || !buildable(extract.buildings[outline])) continue;
    if (extract.buildings[outline].kind != ObjectKind::building) continue;
    for (const model::OsmId id : relation.parts) {
      const std::uint32_t part = index_of(id);
      if (part != model::kNoIndex && extract.buildings[part].kind == ObjectKind::building_part)
        outline_of_part.emplace(part, outline);
    }
  }

  std::map<std::uint32_t, std::vector<std::uint32_t>> parts_of;
  std::vector<std::uint32_t> alone;
  bool any_part = false;
  for (const MappedBuilding& b : extract.buildings) any_part = any_part || b.kind == ObjectKind::building_part;
  if (any_part) {
    const OutlineIndex outlines(extract);
    for (std::uint32_t p = 0; p < extract.buildings.size(); ++p) {
      const MappedBuilding& part = extract.buildings[p];
      if (part.kind != ObjectKind::building_part || !buildable(part)) continue;
      const auto named = outline_of_part.find(p);
      if (named != outline_of_part.end() && held_share(extract, extract.buildings[named->second], part) >= 0.5) {
        parts_of[named->second].push_back(p);
        continue;
      }
      std::uint32_t best = model::kNoIndex;
      double best_area = 0;
      const Place centre = box_of(extract, part).centre();
      outlines.for_each_at(centre, [&](std::uint32_t o, const Box& box) {
        if (held_share(extract, extract.buildings[o], part) < 0.5) return;
        const double area = box.area();
        if (best == model::kNoIndex || area < best_area ||
            (area == best_area && extract.buildings[o].id < extract.buildings[best].id)) {
          best = o;
          best_area = area;
        }
      });
      if (named != outline_of_part.end()) {
        // Two outlines side by side whose relations were mixed up would both be built twice: once by the part of the
        // other, once as what their own parts leave free.
        const bool elsewhere = best != model::kNoIndex && held_share(extract, extract.buildings[best], part) == 1;
        parts_of[elsewhere ? best : named->second].push_back(p);
        if (elsewhere)
          report.add(part.id, model::IssueCode::parts_outside,
                     "in " + extract.buildings[best].id.text() + ", not in " +
                         extract.buildings[named->second].id.text() + " as its relation says");
      } else if (best != model::kNoIndex) {
        parts_of[best].push_back(p);
      } else {
        alone.push_back(p);
      }
    }
  }

  std::map<model::TileId, Shard> shards;
  const auto add = [&](Seed seed) {
    const model::TileId tile = georef::tile_of(box_centre(extract, extract.buildings[seed.lead()]), level);
    Shard& shard = shards[tile];
    shard.tile = tile;
    shard.seeds.push_back(std::move(seed));
  };
  for (std::uint32_t i = 0; i < extract.buildings.size(); ++i) {
    const MappedBuilding& b = extract.buildings[i];
    if (b.kind != ObjectKind::building || !buildable(b)) continue;
    Seed seed{i, {}};
    if (const auto parts = parts_of.find(i); parts != parts_of.end()) seed.parts = std::move(parts->second);
    add(std::move(seed));
  }
  for (std::vector<std::uint32_t>& parts : groups_by_edges(extract, alone)) {
    for (const std::uint32_t p : parts) {
      std::string others;
      if (p != parts.front())
        others = "built together with " + extract.buildings[parts.front()].id.text();
      else if (parts.size() > 1)
        others = "built together with " + std::to_string(parts.size() - 1) + " other parts";
      report.add(extract.buildings[p].id, model::IssueCode::part_without_outline, std::move(others));
    }
    add({model::kNoIndex, std::move(parts)});
  }

  std::vector<Shard> out;
  out.reserve(shards.size());
  for (auto& [tile, shard] : shards) {
    std::sort(shard.seeds.begin(), shard.seeds.end(),
              [&](const Seed& a, const Seed& b) { return a.lead() < b.lead(); });
    out.push_back(std::move(shard));
  }
  return out;
}

}  // namespace blockrand::footprints
