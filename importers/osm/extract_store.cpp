#include "importers/osm/extract_store.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <set>

#include "importers/osm/osm_file.h"
#include "importers/osm/read_file.h"
#include "importers/osm/selection.h"
#include "importers/osm/store_layout.h"
#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::importers::osm {

using namespace store_layout;
using model::TileId;
using osmium::OSMObject;

struct ExtractStore::State {
  std::string objects;  ///< path
  Index index;

  base::InputError damaged(const std::string& path) const {
    return base::InputError(path, "", "is damaged or missing", "Run again: it is made from the extract");
  }

  /// The objects of one kind, one after the other. \param window  empty: all
  osmium::memory::Buffer load(const CellEntry& cell, Kind kind, const Box& window, std::ifstream& in) const {
    std::size_t size = 0;
    for (const Chunk& c : cell.chunks)
      if (c.kind == kind) size += c.bytes;
    osmium::memory::Buffer buffer(std::max<std::size_t>(size, 64), osmium::memory::Buffer::auto_grow::yes);
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
        if (window.empty() || box.empty() || box.meets(window)) {
          std::memcpy(buffer.reserve_space(object), bytes.data() + at, object);
          buffer.commit();
        }
        at += object;
      }
    }
    return buffer;
  }

  const CellEntry* find(const TileId& tile) const {
    const auto found = std::lower_bound(index.cells.begin(), index.cells.end(), tile,
                                        [](const CellEntry& a, const TileId& t) { return a.tile < t; });
    return found == index.cells.end() || found->tile != tile ? nullptr : &*found;
  }

  /// Those whose objects may meet the window, ascending.
  std::vector<const CellEntry*> cells_of(const std::array<double, 4>& window) const {
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

  /// \param window  what does not meet it may be left out; empty: nothing is
  void for_each(const std::vector<const CellEntry*>& cells, const Box& window, osmium::osm_entity_bits::type type,
                const OsmFile::Visit& visit) const {
    std::ifstream in(objects, std::ios::binary);
    if (!in) throw damaged(objects);
    for (const auto& [bit, kinds] :
         {std::pair{osmium::osm_entity_bits::node, std::array{Kind::node, Kind::node}},
          std::pair{osmium::osm_entity_bits::way, std::array{Kind::way, Kind::late_way}},
          std::pair{osmium::osm_entity_bits::relation, std::array{Kind::relation, Kind::relation}}}) {
      if ((type & bit) == osmium::osm_entity_bits::nothing) continue;
      std::vector<osmium::memory::Buffer> buffers;
      for (const CellEntry* cell : cells) {
        buffers.push_back(load(*cell, kinds[0], window, in));
        if (kinds[1] != kinds[0]) buffers.push_back(load(*cell, kinds[1], window, in));
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
};

ExtractStore::ExtractStore(const std::string& folder) : ExtractStore(objects_path(folder), index_path(folder)) {}

ExtractStore::ExtractStore(std::string objects, const std::string& path) : state_(std::make_unique<State>()) {
  state_->objects = std::move(objects);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.size() < kHashLength) throw state_->damaged(path);
  const std::string_view content = std::string_view(bytes).substr(0, bytes.size() - kHashLength);
  if (base::sha256_of(content) != bytes.substr(content.size())) throw state_->damaged(path);
  try {
    state_->index = base::unpacked<Index>(content);
  } catch (const base::UnpackError&) {
    throw state_->damaged(path);
  }
}
ExtractStore::~ExtractStore() = default;
ExtractStore::ExtractStore(ExtractStore&&) noexcept = default;

const StoreFigures& ExtractStore::figures() const { return state_->index.figures; }
bool ExtractStore::has_placeless() const { return state_->index.placeless; }

StoredPart ExtractStore::part(const std::array<double, 4>& window) const {
  StoredPart part;
  base::Sha256 hash;
  for (const CellEntry* cell : state_->cells_of(window)) hash.add(cell->sha256), part.bytes += cell->bytes;
  part.sha256 = hash.finish();
  return part;
}

std::vector<StoredArea> ExtractStore::areas(int level) const {
  std::set<TileId> tiles;
  for (const CellEntry& cell : state_->index.cells) {
    if (cell.tile == nowhere()) continue;
    // Of what spans more than its cell the part that lies there.
    const georef::GeoBox own = georef::bounds(cell.tile);
    const double half = size_of(cell.tile.level) / 2;
    const Box most = box_of({own.west - half, own.south - half, own.east + half, own.north + half});
    const TileId low = georef::tile_of(
                     model::Location{std::max(cell.box.west, most.west), std::max(cell.box.south, most.south)}, level),
                 high = georef::tile_of(
                     model::Location{std::min(cell.box.east, most.east), std::min(cell.box.north, most.north)}, level);
    for (std::uint32_t y = low.y; y <= high.y; ++y)
      for (std::uint32_t x = low.x; x <= high.x; ++x) tiles.insert({level, x, y});
  }
  std::vector<StoredArea> out;
  for (const TileId& tile : tiles) {
    const georef::GeoBox box = georef::bounds(tile);
    out.push_back({tile, part({box.west, box.south, box.east, box.north}).sha256});
  }
  return out;
}

model::Extract ExtractStore::read(const ReadOptions& options, bool placeless) const {
  constexpr std::array<double, 4> kGlobe{-180, -90, 180, 90};
  const std::array<double, 4> window = options.bbox.value_or(kGlobe);
  std::vector<const CellEntry*> cells = state_->cells_of(window);
  if (const CellEntry* entry = placeless ? state_->find(nowhere()) : nullptr) cells.push_back(entry);
  OsmFile file(state_->objects, [&](osmium::osm_entity_bits::type type, const OsmFile::Visit& visit) {
    state_->for_each(cells, box_of(window), type, visit);
  });
  ReadOptions of_window = options;
  of_window.placeless = placeless;
  return read_file(file, state_->objects, of_window);
}

namespace {

/// What a cell holds of an object, for comparing two stores.
struct Version {
  std::string told;  ///< of a relation its members as well
  Box box;
  Interest interest;
  bool related = false;  ///< a relation of buildings
};

using Versions = std::map<std::pair<osmium::item_type, std::int64_t>, Version>;

model::OsmType type_of(osmium::item_type type) {
  return type == osmium::item_type::node  ? model::OsmType::node
         : type == osmium::item_type::way ? model::OsmType::way
                                          : model::OsmType::relation;
}

}  // namespace

std::vector<ChangedObject> ExtractStore::changes_since(const ExtractStore& before) const {
  const auto read_cell = [](const State& state, const TileId& tile) {
    Versions versions;
    std::map<std::int64_t, std::vector<std::int64_t>> parents;
    const CellEntry* cell = state.find(tile);
    if (!cell) return versions;
    state.for_each({cell}, {}, osmium::osm_entity_bits::nwr, [&](const OSMObject& object) {
      Version version{told(object), {}, interest_of(type_of(object.type()), object), false};
      if (object.type() == osmium::item_type::node) {
        const model::Location at = position_of(static_cast<const osmium::Node&>(object).location());
        if (is_known(at)) version.box.add(at);
      } else if (object.type() == osmium::item_type::way) {
        for (const osmium::NodeRef& node : static_cast<const osmium::Way&>(object).nodes())
          if (const model::Location at = position_of(node.location()); is_known(at)) version.box.add(at);
      } else {
        const auto& relation = static_cast<const osmium::Relation&>(object);
        const char* type = relation.tags()["type"];
        version.related = type && std::string_view(type) == "building";
        for (const osmium::RelationMember& m : relation.members())
          if (const auto way = versions.find({m.type(), m.ref()});
              way != versions.end() && m.type() != osmium::item_type::node)
            version.told += way->second.told, version.box.add(way->second.box);
      }
      versions.emplace(std::pair(object.type(), object.id()), std::move(version));
    });
    return versions;
  };
  std::vector<ChangedObject> out;
  const auto add = [&](const Versions::key_type& key, std::initializer_list<const Version*> both) {
    ChangedObject changed;
    changed.id = {type_of(key.first), key.second};
    Box box;
    for (const Version* v : both) {
      changed.kinds |= v->interest.kinds;
      changed.building = changed.building || v->interest.is_building() || v->related;
      changed.network = changed.network || v->interest.covered_way;
      changed.placeless = changed.placeless || v->box.empty();
      box.add(v->box);
    }
    using enum model::FeatureKind;
    for (const model::FeatureKind kind : {street, railway, water, passage})
      changed.network = changed.network || (changed.kinds & static_cast<std::uint32_t>(kind)) != 0;
    if (!box.empty())
      changed.box = {kUnit * static_cast<double>(box.west), kUnit * static_cast<double>(box.south),
                     kUnit * static_cast<double>(box.east), kUnit * static_cast<double>(box.north)};
    out.push_back(changed);
  };
  const auto compare = [&](const TileId& tile) {
    const Versions was = read_cell(*before.state_, tile), is = read_cell(*state_, tile);
    for (const auto& [key, version] : was)
      if (const auto now = is.find(key); now == is.end())
        add(key, {&version});
      else if (now->second.told != version.told)
        add(key, {&version, &now->second});
    for (const auto& [key, version] : is)
      if (!was.contains(key)) add(key, {&version});
  };
  const std::vector<CellEntry>&a = before.state_->index.cells, &b = state_->index.cells;
  for (auto i = a.begin(), k = b.begin(); i != a.end() || k != b.end();) {
    const bool only_before = k == b.end() || (i != a.end() && i->tile < k->tile),
               only_now = i == a.end() || (k != b.end() && k->tile < i->tile);
    const TileId tile = only_now ? k->tile : i->tile;
    if (only_before || only_now || i->sha256 != k->sha256) compare(tile);
    if (!only_now) ++i;
    if (!only_before) ++k;
  }
  return out;
}

}  // namespace blockrand::importers::osm
