#include "pipeline/context/party_walls.h"

#include <algorithm>

namespace blockrand::context {

SharedEdges::SharedEdges(const model::Extract& extract) {
  struct Entry {
    Key key;
    std::uint32_t building;
    bool operator<(const Entry& o) const { return key != o.key ? key < o.key : building < o.building; }
  };
  std::vector<Entry> entries;
  for (std::uint32_t b = 0; b < extract.buildings.size(); ++b) {
    const model::MappedBuilding& building = extract.buildings[b];
    if (building.kind != model::ObjectKind::building || building.state != model::ObjectState::pending) continue;
    for (const model::MappedRing& ring : extract.rings_of(building.rings)) {
      const auto nodes = extract.nodes_of(ring);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::int64_t a = nodes[i], c = nodes[(i + 1) % nodes.size()];
        if (a != c) entries.push_back({key(a, c), b});
      }
    }
  }
  std::sort(entries.begin(), entries.end());
  for (std::size_t i = 1; i < entries.size(); ++i)
    if (entries[i].key == entries[i - 1].key && entries[i].building != entries[i - 1].building &&
        (keys_.empty() || keys_.back() != entries[i].key)) {
      keys_.push_back(entries[i].key);
      owners_.emplace_back(entries[i - 1].building, entries[i].building);
    }
  keys_.shrink_to_fit();
  owners_.shrink_to_fit();
}

std::int64_t SharedEdges::find(std::int64_t from_node, std::int64_t to_node) const {
  if (from_node == 0 || to_node == 0) return -1;  // a point made by repair is in no other outline
  const Key wanted = key(from_node, to_node);
  const auto place = std::lower_bound(keys_.begin(), keys_.end(), wanted);
  return place != keys_.end() && *place == wanted ? place - keys_.begin() : -1;
}

void mark_party_walls(model::Region& region, const SharedEdges& shared) {
  for (model::Building& building : region.buildings)
    for (model::FacadeEdge& edge : building.edges)
      if (shared.find(edge.from_node, edge.to_node) >= 0) edge.kind = model::EdgeKind::party_wall;
}

}  // namespace blockrand::context
