#include "importers/osm/equal_outlines.h"

#include <algorithm>
#include <tuple>

#include "pipeline/base/random.h"

namespace blockrand::importers::osm {
namespace {

using Ring = std::vector<model::Location>;

std::uint64_t key(model::Location l) {
  return base::mix64(static_cast<std::uint64_t>(static_cast<std::uint32_t>(l.lon)) << 32 |
                     static_cast<std::uint32_t>(l.lat));
}

/// Calls `visit(location)` for each vertex of an account's rings, closing vertices left out.
template <class Visit>
void for_each_vertex(const RawData& data, const Accounts& accounts, const Account& account, Visit&& visit) {
  if (account.area >= 0) {
    for (const AreaRing& ring : accounts.areas[static_cast<std::size_t>(account.area)].rings)
      for (const Vertex& v : ring.vertices) visit(v.location);
    return;
  }
  const auto refs = data.refs_of(static_cast<const RawWay&>(*account.raw));
  const std::size_t end = refs.size() - (data.positions.find(refs.front()) == data.positions.find(refs.back()) ? 1 : 0);
  for (std::size_t i = 0; i < end; ++i)
    if (const model::Location l = data.positions.find(refs[i]); is_known(l)) visit(l);
}

/// The ring begun at its smallest position and run towards the smaller neighbour.
Ring normal(const AreaRing& ring) {
  Ring forward;
  for (const Vertex& v : ring.vertices) forward.push_back(v.location);
  Ring backward(forward.rbegin(), forward.rend());
  std::rotate(forward.begin(), std::min_element(forward.begin(), forward.end()), forward.end());
  std::rotate(backward.begin(), std::min_element(backward.begin(), backward.end()), backward.end());
  return std::min(forward, backward);
}

std::vector<std::pair<bool, Ring>> normal_rings(const RawData& data, const Accounts& accounts, const Account& account) {
  std::vector<std::pair<bool, Ring>> out;
  const auto add = [&](const std::vector<AreaRing>& rings) {
    for (const AreaRing& ring : rings) out.emplace_back(ring.inner, normal(ring));
  };
  if (account.area >= 0)
    add(accounts.areas[static_cast<std::size_t>(account.area)].rings);
  else
    add(assemble_way(data, static_cast<const RawWay&>(*account.raw)).rings);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::vector<std::vector<Account*>> equal_outlines(const RawData& data, Accounts& accounts) {
  // First a sum that does not depend on start and direction; few objects share one.
  std::vector<std::pair<std::uint64_t, Account*>> sums;
  sums.reserve(accounts.list.size());
  for (Account& account : accounts.list) {
    if (account.state != model::ObjectState::pending || (account.area < 0 && account.id.type != model::OsmType::way))
      continue;
    std::uint64_t sum = static_cast<std::uint64_t>(account.kind);
    for_each_vertex(data, accounts, account, [&](model::Location l) { sum += key(l); });
    sums.emplace_back(sum, &account);
  }
  std::sort(sums.begin(), sums.end());  // accounts lie in one array in order of id, so pointers compare like ids

  std::vector<std::vector<Account*>> groups;
  for (std::size_t i = 0; i < sums.size();) {
    std::size_t end = i + 1;
    while (end < sums.size() && sums[end].first == sums[i].first) ++end;
    if (end - i > 1) {
      std::vector<std::pair<std::vector<std::pair<bool, Ring>>, Account*>> rings;
      for (std::size_t k = i; k < end; ++k)
        rings.emplace_back(normal_rings(data, accounts, *sums[k].second), sums[k].second);
      std::sort(rings.begin(), rings.end());
      for (std::size_t a = 0; a < rings.size();) {
        std::size_t b = a + 1;
        while (b < rings.size() && rings[b].first == rings[a].first && rings[b].second->kind == rings[a].second->kind)
          ++b;
        if (b - a > 1) {
          groups.emplace_back();
          for (std::size_t k = a; k < b; ++k) groups.back().push_back(rings[k].second);
        }
        a = b;
      }
    }
    i = end;
  }
  std::sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.front()->id < b.front()->id; });
  return groups;
}

}  // namespace blockrand::importers::osm
