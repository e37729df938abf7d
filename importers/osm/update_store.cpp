#include "importers/osm/update_store.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/timestamp.hpp>
#include <osmium/osm/way.hpp>
#include <set>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "importers/osm/changed_objects.h"
#include "importers/osm/extract_store.h"
#include "importers/osm/node_file.h"
#include "importers/osm/osm_file.h"
#include "importers/osm/raw_data.h"
#include "importers/osm/selection.h"
#include "importers/osm/store_layout.h"
#include "importers/osm/store_reader.h"
#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"

namespace blockrand::importers::osm {
namespace {

namespace fs = std::filesystem;
using namespace store_layout;
using model::TileId;
using osmium::OSMObject;

/// Above these shares what is of no use is left behind: the store is written anew.
constexpr double kMostUnused = 0.3, kMostMoved = 0.02;
/// Bytes of no use that are too few to mind.
constexpr double kLittleUnused = 10'000'000;
/// Nodes that are elsewhere than their file says are held in memory: about 70 bytes each.
constexpr std::size_t kMostMovedNodes = 500'000;
/// As many may move in a small extract.
constexpr double kFewNodes = 1000;

/// Why a store cannot be brought up to date.
struct MustBeWritten {
  std::string why;
};

/// Objects in the order of files.
constexpr auto in_order = [](std::int64_t a, std::int64_t b) {
  return std::pair(a >= 0, std::abs(a)) < std::pair(b >= 0, std::abs(b));
};

/// What is put into a cell and taken out of it, by kind and id.
struct CellEdits {
  struct Put {
    std::string object;
    Box box;
  };
  std::set<std::pair<Kind, std::int64_t>> taken;
  std::map<std::pair<Kind, std::int64_t>, Put> put;
};

class StoreUpdater {
 public:
  StoreUpdater(std::span<const std::string> before, const ChangedObjects& changes, std::string extract,
               std::string folder)
      : changes_(changes),
        extract_(std::move(extract)),
        folder_(std::move(folder)),
        nodes_before_(before[3]),
        old_(before[0], before[1]),
        in_(before[0], std::ios::binary) {
    const std::optional<std::string> bytes = read_packed(before[2]);
    if (!bytes || !in_) throw StoreReader::damaged(before[2]);
    try {
      was_ = base::unpacked<Upkeep>(*bytes);
    } catch (const base::UnpackError&) {
      throw StoreReader::damaged(before[2]);
    }
    nodes_.emplace(nodes_before_, was_.node_blocks, was_.node_bytes);
    is_ = was_;
  }

  void update() {
    count();
    look_at_nodes();
    look_at_relations();
    look_at_ways();
    place_relations();
    write();
  }

 private:
  bool surroundings() const { return old_.index.figures.surroundings; }

  // ---- where nodes are, and were

  model::Location place_before(std::int64_t node) {
    if (const auto found = was_.moved.find(node); found != was_.moved.end()) return found->second;
    return nodes_->find(node);
  }
  model::Location place_now(std::int64_t node) {
    if (const auto found = is_.moved.find(node); found != is_.moved.end()) return found->second;
    return nodes_->find(node);
  }

  void count() {
    StoreFigures& f = figures_;
    f = old_.index.figures;
    bool newest_gone = false;
    for (const auto& [key, change] : changes_.changes()) {
      std::uint64_t& n = key.type == osmium::item_type::node  ? f.nodes
                         : key.type == osmium::item_type::way ? f.ways
                                                              : f.relations;
      if (change.before && !change.after) --n;
      if (!change.before && change.after) ++n;
      const auto time = [](const OSMObject* o) {
        return o && o->timestamp().valid() ? static_cast<std::uint32_t>(o->timestamp()) : 0u;
      };
      newest_gone = newest_gone || (time(change.before) == was_.newest && time(change.after) < was_.newest);
      is_.newest = std::max(is_.newest, time(change.after));
    }
    if (newest_gone && is_.newest == was_.newest) throw MustBeWritten{"the newest object is gone"};
    if (is_.newest > 0) f.data_time = osmium::Timestamp(is_.newest).to_iso();
  }

  void look_at_nodes() {
    for (const auto& [key, change] : changes_.changes()) {
      if (key.type != osmium::item_type::node) continue;
      const auto at = [](const OSMObject* o) {
        return o ? position_of(static_cast<const osmium::Node*>(o)->location()) : kMissing;
      };
      const model::Location was = place_before(key.id), is = at(change.after);
      if (was != at(change.before)) throw MustBeWritten{"places of nodes differ"};
      if (!change.before && was_.missing_nodes.contains(key.id))
        throw MustBeWritten{"a node came that ways had before it"};
      if (was != is) {
        if (change.before && !is_known(was)) throw MustBeWritten{"a node got a place that had none"};
        is_.moved[key.id] = is;
        if (change.before) moved_.insert(key.id);
      }
      const auto cell = [&](const model::Location& place) {
        return std::set<TileId>{is_known(place) ? georef_cell(place) : nowhere()};
      };
      const auto kept = [this](const OSMObject* o) {
        return o && is_kept(interest_of(model::OsmType::node, *o, surroundings()));
      };
      if (kept(change.before)) take(cell(was), Kind::node, key.id);
      if (kept(change.after)) {
        Box box;
        if (is_known(is)) box.add(is);
        put(cell(is), Kind::node, *change.after, box);
      }
    }
    if (is_.moved.size() > kMostMovedNodes ||
        static_cast<double>(is_.moved.size()) > kMostMoved * static_cast<double>(figures_.nodes) + kFewNodes)
      throw MustBeWritten{"many nodes have moved"};
  }

  static TileId georef_cell(const model::Location& place) {
    Box box;
    box.add(place);
    return home_of(box);
  }

  // ---- ways

  /// A copy, which stays.
  const OSMObject& kept_copy(std::string_view object) {
    osmium::memory::Buffer& own = copies_.emplace_back(object.size(), osmium::memory::Buffer::auto_grow::no);
    std::memcpy(own.reserve_space(object.size()), object.data(), object.size());
    own.commit();
    return own.get<OSMObject>(0);
  }
  static std::string_view bytes_of(const OSMObject& object) {
    return {reinterpret_cast<const char*>(object.data()), object.padded_size()};
  }
  static const OSMObject& object_in(std::string_view bytes) {
    return *reinterpret_cast<const OSMObject*>(bytes.data());
  }

  /// With the places that its nodes have now, or had. \param line  gets those that are known
  template <class Place>
  const osmium::Way& located(const OSMObject& object, Place&& place, Box& box, std::vector<model::Location>& line,
                             const std::function<void(std::int64_t)>& missing) {
    auto& way = const_cast<osmium::Way&>(static_cast<const osmium::Way&>(kept_copy(bytes_of(object))));
    for (osmium::NodeRef& node : way.nodes()) {
      const model::Location at = place(node.ref());
      node.set_location({at.lon, at.lat});
      if (at == kMissing) missing(node.ref());
      if (!is_known(at)) continue;
      box.add(at);
      line.push_back(at);
    }
    return way;
  }

  /// Ways of the store that have nodes which moved.
  void find_ways_of_moved_nodes() {
    std::set<const CellEntry*> cells;
    for (const std::int64_t node : moved_) {
      const model::Location at = place_before(node);
      if (!is_known(at)) continue;
      const double lon = kUnit * at.lon, lat = kUnit * at.lat;
      for (const CellEntry* cell : old_.cells_of({lon, lat, lon, lat})) cells.insert(cell);
    }
    for (const CellEntry* cell : cells)
      old_.visit_cell(*cell, Kind::way, in_, [&](const Box&, std::string_view bytes) {
        const auto& way = static_cast<const osmium::Way&>(object_in(bytes));
        if (stored_ways_.contains(way.id())) return;
        for (const osmium::NodeRef& node : way.nodes())
          if (moved_.contains(node.ref())) {
            ways_.insert(way.id());
            stored_ways_.emplace(way.id(), &kept_copy(bytes));
            break;
          }
      });
  }

  /// Relations as they are members of each other, and which ways come with them.
  void look_at_relations() {
    for (const auto& [key, change] : changes_.changes()) {
      if (key.type != osmium::item_type::relation) continue;
      is_.members.relations.erase(key.id);
      if (!change.after) continue;
      const auto& relation = static_cast<const osmium::Relation&>(*change.after);
      if (!kept_as(relation, interest_of(model::OsmType::relation, relation, surroundings()))) continue;
      StoredRelation& kept = is_.members.relations[key.id];
      for (const osmium::RelationMember& m : relation.members()) {
        if (m.type() == osmium::item_type::way) kept.ways.push_back(m.ref());
        if (m.type() == osmium::item_type::relation) kept.relations.push_back(m.ref());
      }
    }
    std::map<std::int64_t, MemberWay> members;
    for (const auto& [id, relation] : is_.members.relations)
      for (const std::int64_t way : relation.ways) {
        if (members.contains(way)) continue;
        const auto known = was_.members.ways.find(way);
        members.emplace(way, known == was_.members.ways.end() ? MemberWay() : known->second);
        if (known == was_.members.ways.end()) ways_.insert(way);
      }
    for (const auto& [way, known] : was_.members.ways)
      if (!members.contains(way)) ways_.insert(way);
    is_.members.ways = std::move(members);
  }

  /// Those of `ways_` that neither the changes nor the store's moved nodes brought: where the store has them, else of the extract.
  void find_other_ways() {
    std::set<std::int64_t> wanted;
    std::set<const CellEntry*> cells;
    for (const std::int64_t id : ways_) {
      if (changes_.find({osmium::item_type::way, id}) || stored_ways_.contains(id)) continue;
      wanted.insert(id);
    }
    if (wanted.empty()) return;
    OsmFile file(extract_);
    file.for_each(osmium::osm_entity_bits::way,
                  [&](const OSMObject& object) {
                    if (object.visible() && wanted.contains(object.id()))
                      stored_ways_.emplace(object.id(), &kept_copy(bytes_of(object)));
                  },
                  {});
  }

  void look_at_ways() {
    for (const auto& [key, change] : changes_.changes())
      if (key.type == osmium::item_type::way) ways_.insert(key.id);
    find_ways_of_moved_nodes();
    find_other_ways();
    for (const std::int64_t id : ways_) {
      const ChangedObjects::Change* change = changes_.find({osmium::item_type::way, id});
      const auto stored = stored_ways_.find(id);
      const OSMObject* same = stored == stored_ways_.end() ? nullptr : stored->second;
      const OSMObject *before = change ? change->before : same, *after = change ? change->after : same;
      const auto kept = [&](const OSMObject* o, const Members& members) {
        return o && (members.ways.contains(id) || is_kept(interest_of(model::OsmType::way, *o, surroundings())));
      };
      if (kept(before, was_.members)) {
        Box box;
        std::vector<model::Location> line;
        std::set<TileId> cells;
        located(
            *before, [&](std::int64_t n) { return place_before(n); }, box, line,
            [&](std::int64_t n) {
              const auto missing = is_.missing_nodes.find(n);
              if (missing == is_.missing_nodes.end()) throw MustBeWritten{"counts of missing nodes differ"};
              if (--missing->second == 0) is_.missing_nodes.erase(missing);
            });
        find_way(box, line, cells);
        take(cells, Kind::way, id);
      }
      const auto member = is_.members.ways.find(id);
      if (member != is_.members.ways.end()) member->second = {};
      if (!kept(after, is_.members)) continue;
      Box box;
      std::vector<model::Location> line;
      std::set<TileId> cells;
      const osmium::Way& way = located(
          *after, [&](std::int64_t n) { return place_now(n); }, box, line,
          [&](std::int64_t n) { ++is_.missing_nodes[n]; });
      find_way(box, line, cells);
      if (member != is_.members.ways.end()) member->second = {box, true, cells};
      put(cells, Kind::way, way, box);
      now_.emplace(id, &way);
    }
    figures_.missing_nodes = is_.missing_nodes.size();
    figures_.missing_ways = 0;
    for (const auto& [id, known] : is_.members.ways) figures_.missing_ways += !known.there;
  }

  // ---- relations

  /// The object as it lies in a cell of the store.
  const OSMObject& stored(const std::set<TileId>& cells, Kind kind, std::int64_t id) {
    const OSMObject* found = nullptr;
    for (const TileId& tile : cells) {
      const CellEntry* cell = old_.find(tile);
      if (!cell || found) continue;
      old_.visit_cell(*cell, kind, in_, [&](const Box&, std::string_view bytes) {
        if (!found && object_in(bytes).id() == id) found = &kept_copy(bytes);
      });
    }
    if (!found) throw MustBeWritten{"an object is not where it should be"};
    return *found;
  }

  void place_relations() {
    is_.members.place();
    const auto& before = was_.members.relations;
    const auto& now = is_.members.relations;
    for (const auto& [id, r] : before) {
      const auto found = now.find(id);
      const bool changed = changes_.find({osmium::item_type::relation, id}) != nullptr;
      if (found != now.end() && !changed && found->second.cells == r.cells && found->second.reach == r.reach) continue;
      // One that spans degrees and has no ways lies nowhere.
      if (found != now.end() && !found->second.cells.empty())
        put(found->second.cells, Kind::relation,
            changed ? *changes_.find({osmium::item_type::relation, id})->after : stored(r.cells, Kind::relation, id),
            found->second.reach);
      take(r.cells, Kind::relation, id);
    }
    for (const auto& [id, r] : now)
      if (!before.contains(id))
        put(r.cells, Kind::relation, *changes_.find({osmium::item_type::relation, id})->after, r.reach);

    const auto& late_before = was_.members.late;
    const auto& late = is_.members.late;
    for (const auto& [id, l] : late) {
      const auto found = late_before.find(id);
      const auto fresh = now_.find(id);
      if (found != late_before.end() && found->second == l && fresh == now_.end()) continue;
      put(l.cells, Kind::late_way,
          fresh != now_.end() ? *fresh->second : stored(was_.members.ways.at(id).cells, Kind::way, id), l.box);
      if (found != late_before.end()) take(found->second.cells, Kind::late_way, id);
    }
    for (const auto& [id, l] : late_before)
      if (!late.contains(id)) take(l.cells, Kind::late_way, id);
  }

  // ---- cells

  void take(const std::set<TileId>& cells, Kind kind, std::int64_t id) {
    for (const TileId& tile : cells) edits_[tile].taken.insert({kind, id});
  }
  void put(const std::set<TileId>& cells, Kind kind, const OSMObject& object, const Box& box) {
    for (const TileId& tile : cells)
      edits_[tile].put.insert_or_assign({kind, object.id()}, CellEdits::Put{std::string(bytes_of(object)), box});
  }

  void write() {
    std::error_code error;
    fs::remove(index_path(folder_), error);
    fs::create_directories(folder_, error);
    if (error) throw base::OutputError(folder_ + ": cannot be made: " + error.message());
    const auto must = [&] {
      if (error) throw base::OutputError(folder_ + ": cannot be written: " + error.message() + ". Free some space");
    };
    fs::copy_file(old_.objects, objects_path(folder_), fs::copy_options::overwrite_existing, error);
    must();
    written_ = fs::file_size(objects_path(folder_), error);
    must();
    fs::remove(nodes_path(folder_), error);
    fs::create_hard_link(nodes_before_, nodes_path(folder_), error);
    if (error) error.clear(), fs::copy_file(nodes_before_, nodes_path(folder_), error);
    must();
    out_.open(objects_path(folder_), std::ios::binary | std::ios::app);
    check();
    std::map<TileId, CellEntry> cells;
    for (const CellEntry& cell : old_.index.cells) cells.emplace(cell.tile, cell);
    for (const auto& [tile, edits] : edits_) {
      const auto before = cells.find(tile);
      CellEntry entry = edited(before == cells.end() ? CellEntry{tile, {}, {}, 0, {}} : before->second, edits);
      if (entry.chunks.empty()) {
        if (before != cells.end()) cells.erase(before);
      } else {
        cells.insert_or_assign(tile, std::move(entry));
      }
    }
    out_.close();
    check();
    if (static_cast<double>(is_.unused) > kMostUnused * static_cast<double>(written_) + kLittleUnused)
      throw MustBeWritten{"much of the store is of no use"};
    Index index;
    index.figures = figures_;
    index.figures.bytes = written_;
    for (auto& [tile, cell] : cells) index.cells.push_back(std::move(cell));
    index.placeless = !index.cells.empty() && index.cells.back().tile == nowhere();
    index.figures.sha256 = sha256_of_cells(index.cells);
    write_packed(upkeep_path(folder_), base::packed(is_));
    write_packed(index_path(folder_), base::packed(index));
  }

  void check() {
    if (!out_)
      throw base::OutputError(objects_path(folder_) + ": cannot be written: " + std::strerror(errno) +
                              ". Free some space or check the permissions");
  }

  /// The cell with what is put into it, written behind all others; kinds of which nothing differs stay where they lie.
  CellEntry edited(const CellEntry& before, const CellEdits& edits) {
    CellEntry cell;
    cell.tile = before.tile;
    base::Sha256 hash;
    for (const Kind kind : {Kind::node, Kind::way, Kind::relation, Kind::late_way}) {
      std::map<std::int64_t, CellEdits::Put, decltype(in_order)> objects;
      std::uint64_t bytes_before = 0;
      old_.visit_cell(before, kind, in_, [&](const Box& box, std::string_view bytes) {
        bytes_before += bytes.size() + sizeof box;
        const std::int64_t id = object_in(bytes).id();
        if (!edits.taken.contains({kind, id})) objects.emplace(id, CellEdits::Put{std::string(bytes), box});
      });
      const auto of_kind = [&](const auto& edit) { return edit.first == kind; };
      bool differs = std::ranges::any_of(edits.taken, of_kind);
      for (const auto& [what, put] : edits.put) {
        if (what.first != kind) continue;
        objects.insert_or_assign(what.second, put);
        differs = true;
      }
      std::string pending;
      for (const auto& [id, object] : objects) {
        hash.add(told(object_in(object.object)));
        cell.box.add(object.box);
        if (!differs) continue;
        pending.append(reinterpret_cast<const char*>(&object.box), sizeof object.box);
        pending += object.object;
      }
      if (!differs) {
        for (const Chunk& c : before.chunks)
          if (c.kind == kind) cell.chunks.push_back(c);
        continue;
      }
      is_.unused += bytes_before;
      if (pending.empty()) continue;
      cell.chunks.push_back({written_, static_cast<std::uint32_t>(pending.size()), crc_of(pending), kind});
      out_.write(pending.data(), static_cast<std::streamsize>(pending.size()));
      check();
      written_ += pending.size();
    }
    cell.sha256 = hash.finish();
    for (const Chunk& c : cell.chunks) cell.bytes += c.bytes;
    return cell;
  }

  const ChangedObjects& changes_;
  std::string extract_, folder_, nodes_before_;
  StoreReader old_;
  std::ifstream in_;
  Upkeep was_, is_;
  std::optional<NodeFile> nodes_;
  StoreFigures figures_;
  std::unordered_set<std::int64_t> moved_;                ///< nodes that were there, and are elsewhere now or gone
  std::set<std::int64_t> ways_;                           ///< that differ, or lie elsewhere
  std::map<std::int64_t, const OSMObject*> stored_ways_;  ///< of these, that are the same but for places
  std::map<std::int64_t, const OSMObject*> now_;          ///< of these, with places, that are kept
  std::map<TileId, CellEdits> edits_;
  std::deque<osmium::memory::Buffer> copies_;
  std::ofstream out_;
  std::uint64_t written_ = 0;
};

}  // namespace

std::string update_store(std::span<const std::string> before, const ChangedObjects& changes, const std::string& extract,
                         const std::string& folder) {
  if (changes.too_many()) return "more differs than is worth it";
  try {
    StoreUpdater(before, changes, extract, folder).update();
    return {};
  } catch (const MustBeWritten& reason) {
    std::error_code error;
    for (const char* name : kStoreFiles) fs::remove(folder + "/" + name, error);
    return reason.why;
  }
}

}  // namespace blockrand::importers::osm
