#include "pipeline/footprints/repair/kept_nodes.h"

#include <algorithm>

namespace blockrand::repair {

namespace {

using model::Extract;
using model::Range;

void append(const Extract& extract, Range rings, std::vector<std::int64_t>& out) {
  for (const model::MappedRing& ring : extract.rings_of(rings)) {
    const auto nodes = extract.nodes_of(ring);
    out.insert(out.end(), nodes.begin(), nodes.end());
  }
}

void sort_each_once(std::vector<std::int64_t>& nodes, std::size_t from = 0) {
  const auto first = nodes.begin() + static_cast<std::ptrdiff_t>(from);
  std::sort(first, nodes.end());
  nodes.erase(std::unique(first, nodes.end()), nodes.end());
}

}  // namespace

KeptNodes::KeptNodes(std::vector<std::int64_t> nodes) : nodes_(std::move(nodes)) {
  sort_each_once(nodes_);
  // 0 stands for "no node" in rings.
  if (const auto zero = std::lower_bound(nodes_.begin(), nodes_.end(), 0); zero != nodes_.end() && *zero == 0)
    nodes_.erase(zero);
}

KeptNodes::KeptNodes(const Extract& extract) {
  std::vector<std::int64_t> used;
  for (const model::MappedBuilding& object : extract.buildings) {
    if (object.state != model::ObjectState::pending) continue;
    const std::size_t from = used.size();
    append(extract, object.rings, used);
    sort_each_once(used, from);
  }
  std::sort(used.begin(), used.end());
  // Twice in the list is used by two objects; one copy of each run of equals goes to the front.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < used.size();) {
    std::size_t j = i + 1;
    while (j < used.size() && used[j] == used[i]) ++j;
    if (j - i >= 2) used[kept++] = used[i];
    i = j;
  }
  used.resize(kept);
  for (const model::Feature& feature : extract.features)
    // What only the surroundings are made of changes no house.
    if (!feature.area && feature.kinds != static_cast<std::uint32_t>(model::FeatureKind::surrounding))
      append(extract, feature.rings, used);
  used.shrink_to_fit();
  *this = KeptNodes(std::move(used));
  nodes_.shrink_to_fit();
}

bool KeptNodes::contains(std::int64_t node) const {
  return node != 0 && std::binary_search(nodes_.begin(), nodes_.end(), node);
}

}  // namespace blockrand::repair
