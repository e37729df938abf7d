#include "importers/osm/store_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <utility>

#include "pipeline/base/pack.h"

namespace blockrand::importers::osm::store_layout {

using model::TileId;
using osmium::OSMObject;

StoreReader::StoreReader(std::string objects_file, const std::string& path) : objects(std::move(objects_file)) {
  const std::optional<std::string> content = read_packed(path);
  if (!content) throw damaged(path);
  try {
    index = base::unpacked<Index>(*content);
  } catch (const base::UnpackError&) {
    throw damaged(path);
  }
}

void StoreReader::visit_cell(const CellEntry& cell, Kind kind, std::ifstream& in,
                             const std::function<void(const Box&, std::string_view)>& visit) const {
  std::string bytes;
  for (const Chunk& c : cell.chunks) {
    if (c.kind != kind) continue;
    bytes.resize(c.bytes);
    in.seekg(static_cast<std::streamoff>(c.offset));
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!in || crc_of(bytes) != c.crc) throw damaged(objects);
    for (std::size_t at = 0; at < bytes.size();) {
      Box box;
      if (bytes.size() - at < sizeof box + sizeof(osmium::memory::Item)) throw damaged(objects);
      std::memcpy(&box, bytes.data() + at, sizeof box);
      at += sizeof box;
      const std::size_t object = reinterpret_cast<const osmium::memory::Item*>(bytes.data() + at)->padded_size();
      if (object == 0 || object > bytes.size() - at) throw damaged(objects);
      visit(box, std::string_view(bytes).substr(at, object));
      at += object;
    }
  }
}

osmium::memory::Buffer StoreReader::load(const CellEntry& cell, Kind kind, std::span<const Box> windows,
                                         std::ifstream& in) const {
  std::size_t size = 0;
  for (const Chunk& c : cell.chunks)
    if (c.kind == kind) size += c.bytes;
  osmium::memory::Buffer buffer(std::max<std::size_t>(size, 64), osmium::memory::Buffer::auto_grow::yes);
  visit_cell(cell, kind, in, [&](const Box& box, std::string_view object) {
    if (!windows.empty() && !box.empty() && std::ranges::none_of(windows, [&](const Box& w) { return box.meets(w); }))
      return;
    std::memcpy(buffer.reserve_space(object.size()), object.data(), object.size());
    buffer.commit();
  });
  return buffer;
}

const CellEntry* StoreReader::find(const TileId& tile) const {
  const auto found = std::lower_bound(index.cells.begin(), index.cells.end(), tile,
                                      [](const CellEntry& a, const TileId& t) { return a.tile < t; });
  return found == index.cells.end() || found->tile != tile ? nullptr : &*found;
}

std::vector<const CellEntry*> StoreReader::cells_of(const std::array<double, 4>& window) const {
  std::vector<const CellEntry*> out;
  const auto& [west, south, east, north] = window;
  const Box box = box_of(window);
  for (auto at = index.cells.begin(); at != index.cells.end() && at->tile.level <= kFinest;) {
    const int level = at->tile.level;
    const double size = size_of(level);
    const auto low = [&](double degrees, double first) {
      return static_cast<std::uint32_t>(std::max(0.0, std::floor((degrees - first) / size - 1.5)));
    };
    const auto high = [&](double degrees, double first) {
      return static_cast<std::uint32_t>(std::max(0.0, std::floor((degrees - first) / size + 0.5)));
    };
    const std::uint32_t y0 = low(south, -90), y1 = high(north, -90), x1 = high(east, -180);
    for (std::uint32_t x = low(west, -180); x <= x1;) {
      const auto first = std::lower_bound(at, index.cells.end(), TileId{level, x, y0},
                                          [](const CellEntry& a, const TileId& t) { return a.tile < t; });
      if (first == index.cells.end() || first->tile.level != level) break;
      if (first->tile.x > x) {
        x = first->tile.x;
        continue;
      }
      for (auto cell = first;
           cell != index.cells.end() && cell->tile.level == level && cell->tile.x == x && cell->tile.y <= y1; ++cell)
        if (cell->box.meets(box)) out.push_back(&*cell);
      ++x;
    }
    at = std::lower_bound(at, index.cells.end(), TileId{level + 1, 0, 0},
                          [](const CellEntry& a, const TileId& t) { return a.tile < t; });
  }
  return out;
}

void StoreReader::for_each(const std::vector<const CellEntry*>& cells, std::span<const Box> windows,
                           osmium::osm_entity_bits::type type,
                           const std::function<void(const OSMObject&)>& visit) const {
  std::ifstream in(objects, std::ios::binary);
  if (!in) throw damaged(objects);
  for (const auto& [bit, kinds] :
       {std::pair{osmium::osm_entity_bits::node, std::array{Kind::node, Kind::node}},
        std::pair{osmium::osm_entity_bits::way, std::array{Kind::way, Kind::late_way}},
        std::pair{osmium::osm_entity_bits::relation, std::array{Kind::relation, Kind::relation}}}) {
    if ((type & bit) == osmium::osm_entity_bits::nothing) continue;
    std::vector<osmium::memory::Buffer> buffers;
    for (const CellEntry* cell : cells) {
      buffers.push_back(load(*cell, kinds[0], windows, in));
      if (kinds[1] != kinds[0]) buffers.push_back(load(*cell, kinds[1], windows, in));
    }
    std::vector<const OSMObject*> order;
    for (const osmium::memory::Buffer& buffer : buffers)
      for (const OSMObject& object : buffer.select<OSMObject>()) order.push_back(&object);
    std::stable_sort(order.begin(), order.end(),
                     [](const OSMObject* a, const OSMObject* b) { return a->id() < b->id(); });
    const OSMObject* before = nullptr;
    for (const OSMObject* object : order) {
      if (!before || before->id() != object->id()) visit(*object);
      before = object;
    }
  }
}

}  // namespace blockrand::importers::osm::store_layout
