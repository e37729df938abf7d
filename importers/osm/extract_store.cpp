#include "importers/osm/extract_store.h"

#include <algorithm>
#include <map>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <set>

#include "importers/osm/osm_file.h"
#include "importers/osm/read_file.h"
#include "importers/osm/selection.h"
#include "importers/osm/store_layout.h"
#include "importers/osm/store_reader.h"
#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::importers::osm {

using namespace store_layout;
using model::TileId;
using osmium::OSMObject;

struct ExtractStore::State : StoreReader {
  using StoreReader::StoreReader;
};

ExtractStore::ExtractStore(const std::string& folder) : ExtractStore(objects_path(folder), index_path(folder)) {}

ExtractStore::ExtractStore(std::string objects, const std::string& path)
    : state_(std::make_unique<State>(std::move(objects), path)) {}
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
  std::vector<Box> windows;
  std::vector<const CellEntry*> cells;
  const auto add = [&](const std::array<double, 4>& window) {
    windows.push_back(box_of(window));
    const std::vector<const CellEntry*> its = state_->cells_of(window);
    cells.insert(cells.end(), its.begin(), its.end());
  };
  std::ranges::for_each(options.parts, add);
  if (options.parts.empty()) add(options.bbox.value_or(kGlobe));
  std::ranges::sort(cells);  // as they lie in the index
  const auto twice = std::ranges::unique(cells);
  cells.erase(twice.begin(), twice.end());
  if (const CellEntry* entry = placeless ? state_->find(nowhere()) : nullptr) cells.push_back(entry);
  OsmFile file(state_->objects, [&](osmium::osm_entity_bits::type type, const OsmFile::Visit& visit) {
    state_->for_each(cells, windows, type, visit);
  });
  ReadOptions of_window = options;
  of_window.placeless = placeless;
  return read_file(file, state_->objects, of_window);
}

namespace {

/// What a cell holds of an object, for comparing two stores.
struct Version {
  std::string told;   ///< of a relation its members as well
  std::string place;  ///< told_place
  Box box;
  Interest interest;
  bool related = false;  ///< a relation of buildings, or one whose ways are some
  bool coast = false;
};

using Versions = std::map<std::pair<osmium::item_type, std::int64_t>, Version>;

model::OsmType type_of(osmium::item_type type) {
  return type == osmium::item_type::node  ? model::OsmType::node
         : type == osmium::item_type::way ? model::OsmType::way
                                          : model::OsmType::relation;
}

bool is_coast(const OSMObject& object) {
  const char* natural = object.tags()[model::osm_key::kNatural.data()];
  return natural && std::string_view(natural) == "coastline";
}

}  // namespace

std::vector<ChangedObject> ExtractStore::changes_since(const ExtractStore& before) const {
  const auto read_cell = [](const State& state, const TileId& tile) {
    Versions versions;
    std::map<std::int64_t, std::vector<std::int64_t>> parents;
    const CellEntry* cell = state.find(tile);
    if (!cell) return versions;
    state.for_each({cell}, {}, osmium::osm_entity_bits::nwr, [&](const OSMObject& object) {
      Version version{told(object), told_place(object),
                      {},           interest_of(type_of(object.type()), object, state.index.figures.surroundings),
                      false,        is_coast(object)};
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
            version.told += way->second.told, version.box.add(way->second.box),
                version.related = version.related || way->second.interest.is_building();
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
      changed.coast = changed.coast || v->coast;
      changed.placeless = changed.placeless || v->box.empty();
      box.add(v->box);
    }
    using enum model::FeatureKind;
    for (const model::FeatureKind kind : {street, railway, water, passage})
      changed.network = changed.network || (changed.kinds & static_cast<std::uint32_t>(kind)) != 0;
    changed.is_surrounding =
        !changed.building && !changed.network && changed.kinds == static_cast<std::uint32_t>(surrounding);
    // Relations share out what their ways say.
    changed.look_only = key.first == osmium::item_type::way && both.size() == 2 &&
                        (*both.begin())->place == (*(both.end() - 1))->place && changed.building && !changed.network;
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
