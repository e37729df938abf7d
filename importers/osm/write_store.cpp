// Writes an ExtractStore in one pass over the nodes and two over ways and relations.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/timestamp.hpp>
#include <osmium/osm/way.hpp>
#include <set>
#include <span>

#include "importers/osm/extract_store.h"
#include "importers/osm/node_file.h"
#include "importers/osm/osm_file.h"
#include "importers/osm/read_file.h"
#include "importers/osm/selection.h"
#include "importers/osm/store_layout.h"
#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::importers::osm {
namespace {

namespace fs = std::filesystem;
using namespace store_layout;
using model::TileId;
using osmium::OSMObject;

constexpr std::uint64_t kMostPending = 64'000'000;  // bytes of objects that wait for the disk

/// The store in the making.
class StoreFiles {
 public:
  explicit StoreFiles(std::string folder) : folder_(std::move(folder)) {
    std::error_code error;
    fs::remove(index_path(folder_), error);
    fs::remove(upkeep_path(folder_), error);
    fs::create_directories(folder_, error);
    if (error) throw base::OutputError(folder_ + ": cannot be made: " + error.message());
    out_.open(objects_path(folder_), std::ios::binary | std::ios::trunc);
    check();
  }

  /// \param box  of the object, and of what it is there for
  void add(const std::set<TileId>& cells, Kind kind, const OSMObject& object, const Box& box) {
    const std::string what = told(object);
    const std::string_view bytes(reinterpret_cast<const char*>(object.data()), object.padded_size());
    for (const TileId& tile : cells) {
      Cell& cell = cells_[tile];
      if (cell.kind != kind) flush(cell);
      cell.kind = kind;
      cell.pending.append(reinterpret_cast<const char*>(&box), sizeof box);
      cell.pending += bytes;
      cell.hash.add(what);
      cell.box.add(box);
      pending_ += bytes.size() + sizeof box;
    }
    if (pending_ > kMostPending) flush_all();
  }
  std::uint64_t bytes() const { return written_; }

  void finish(Index index) {
    flush_all();
    out_.close();
    check();
    index.figures.bytes = written_;
    for (auto& [tile, cell] : cells_) {
      CellEntry entry;
      entry.tile = tile, entry.box = cell.box, entry.sha256 = cell.hash.finish(), entry.chunks = std::move(cell.chunks);
      for (const Chunk& c : entry.chunks) entry.bytes += c.bytes;
      index.cells.push_back(std::move(entry));
    }
    index.placeless = !index.cells.empty() && index.cells.back().tile == nowhere();
    index.figures.sha256 = sha256_of_cells(index.cells);
    write_packed(index_path(folder_), base::packed(index));
  }

 private:
  struct Cell {
    std::string pending;
    Kind kind = Kind::node;
    std::vector<Chunk> chunks;
    base::Sha256 hash;
    Box box;
  };
  void check() {
    if (!out_)
      throw base::OutputError(objects_path(folder_) + ": cannot be written: " + std::strerror(errno) +
                              ". Free some space or check the permissions");
  }
  void flush(Cell& cell) {
    if (cell.pending.empty()) return;
    cell.chunks.push_back({written_, static_cast<std::uint32_t>(cell.pending.size()), crc_of(cell.pending), cell.kind});
    out_.write(cell.pending.data(), static_cast<std::streamsize>(cell.pending.size()));
    check();
    written_ += cell.pending.size();
    pending_ -= cell.pending.size();
    std::string().swap(cell.pending);  // assigning an empty one would keep its room
  }
  void flush_all() {
    for (auto& [tile, cell] : cells_) flush(cell);
  }

  std::string folder_;
  std::ofstream out_;
  std::uint64_t written_ = 0, pending_ = 0;
  std::map<TileId, Cell> cells_;
};

class StoreWriter {
 public:
  StoreWriter(OsmFile& file, const std::string& folder)
      : file_(file), folder_(folder), files_(folder), nodes_(nodes_path(folder)) {}

  bool write() {
    read_relations();
    read_nodes_and_ways();
    if (!sorted_) return false;
    place_relations();
    write_late_ways();
    finish();
    return true;
  }
  Index& index() { return index_; }

 private:
  bool surroundings() const { return index_.figures.surroundings; }

  /// Counts it, and whether the file is in order.
  bool visit(const OSMObject& object, std::uint64_t& count) {
    const auto order = std::make_tuple(object.type(), object.id() >= 0, std::abs(object.id()));
    sorted_ = sorted_ && (!last_ || *last_ < order);
    last_ = order;
    if (!object.visible() || file_.deleted_by_editor(object.type(), object.id())) return false;
    ++count;
    if (object.timestamp().valid()) newest_ = std::max(newest_, static_cast<std::uint32_t>(object.timestamp()));
    return true;
  }

  void read_relations() {
    file_.for_each(osmium::osm_entity_bits::relation,
                   [&](const OSMObject& object) {
                     if (!visit(object, index_.figures.relations)) return;
                     const auto& relation = static_cast<const osmium::Relation&>(object);
                     if (!kept_as(relation, interest_of(model::OsmType::relation, object, surroundings()))) return;
                     StoredRelation& kept = members_.relations[object.id()];
                     for (const osmium::RelationMember& m : relation.members()) {
                       if (m.type() == osmium::item_type::way) kept.ways.push_back(m.ref()), members_.ways[m.ref()];
                       if (m.type() == osmium::item_type::relation) kept.relations.push_back(m.ref());
                     }
                   },
                   {});
    last_.reset();
  }

  void read_nodes_and_ways() {
    bool nodes_open = true;
    file_.for_each(osmium::osm_entity_bits::node | osmium::osm_entity_bits::way,
                   [&](const OSMObject& object) {
                     if (!sorted_) return;
                     if (object.type() == osmium::item_type::node) return read_node(object);
                     if (nodes_open) nodes_.finish();
                     nodes_open = false;
                     read_way(object);
                   },
                   {});
    if (nodes_open) nodes_.finish();
  }

  void read_node(const OSMObject& object) {
    if (!visit(object, index_.figures.nodes)) {
      for_each_tag(object, [](std::string_view, std::string_view) {});
      return;
    }
    const model::Location at = position_of(static_cast<const osmium::Node&>(object).location());
    nodes_.add(object.id(), at);
    if (!is_kept(interest_of(model::OsmType::node, object, surroundings()))) return;
    cells_.clear();
    cells_.insert(is_known(at) ? georef::tile_of(at, kFinest) : nowhere());
    Box box;
    if (is_known(at)) box.add(at);
    files_.add(cells_, Kind::node, object, box);
  }

  /// A copy with the places of its nodes, which are left in `line_`. \param counted  nodes that are missing count
  const osmium::Way& located(const OSMObject& object, Box& box, bool counted) {
    line_.clear();
    copy_.clear();
    copy_.add_item(object);
    copy_.commit();
    auto& way = copy_.get<osmium::Way>(0);
    for (osmium::NodeRef& node : way.nodes()) {
      const model::Location at = nodes_.find(node.ref());
      node.set_location({at.lon, at.lat});
      if (at == kMissing && counted) ++missing_nodes_[node.ref()];
      if (!is_known(at)) continue;
      box.add(at);
      line_.push_back(at);
    }
    return way;
  }

  void read_way(const OSMObject& object) {
    const bool alive = visit(object, index_.figures.ways);
    const Interest interest = interest_of(model::OsmType::way, object, surroundings());
    const auto of_relation = members_.ways.find(object.id());
    if (!alive || (!is_kept(interest) && of_relation == members_.ways.end())) return;
    Box box;
    const osmium::Way& way = located(object, box, true);
    cells_.clear();
    find_way(box, line_, cells_);
    if (of_relation != members_.ways.end())
      of_relation->second.there = true, of_relation->second.box = box, of_relation->second.cells = cells_;
    files_.add(cells_, Kind::way, way, box);
  }

  void place_relations() {
    members_.place();
    std::uint64_t again = 0;
    const std::uint32_t newest = newest_;
    file_.for_each(osmium::osm_entity_bits::relation,
                   [&](const OSMObject& object) {
                     if (!visit(object, again)) return;
                     const auto found = members_.relations.find(object.id());
                     if (found != members_.relations.end())
                       files_.add(found->second.cells, Kind::relation, object, found->second.reach);
                   },
                   {});
    newest_ = newest;
  }

  void write_late_ways() {
    if (members_.late.empty()) return;
    file_.for_each(
        osmium::osm_entity_bits::way,
        [&](const OSMObject& object) {
          const auto found = members_.late.find(object.id());
          if (found == members_.late.end() || !object.visible() || file_.deleted_by_editor(object.type(), object.id()))
            return;
          Box own;
          files_.add(found->second.cells, Kind::late_way, located(object, own, false), found->second.box);
        },
        {});
  }

  void finish() {
    StoreFigures& f = index_.figures;
    f.missing_nodes = missing_nodes_.size();
    for (const auto& [way, known] : members_.ways) f.missing_ways += !known.there;
    if (newest_ > 0) f.data_time = osmium::Timestamp(newest_).to_iso();
    f.node_bytes = nodes_.bytes();
    Upkeep upkeep;
    upkeep.members = std::move(members_), upkeep.missing_nodes = std::move(missing_nodes_), upkeep.newest = newest_;
    upkeep.node_bytes = nodes_.bytes(), upkeep.node_blocks = nodes_.keep();
    write_packed(upkeep_path(folder_), base::packed(upkeep));
    files_.finish(std::move(index_));
  }

  OsmFile& file_;
  std::string folder_;
  StoreFiles files_;
  NodeFile nodes_;
  Index index_;
  bool sorted_ = true;
  std::optional<std::tuple<osmium::item_type, bool, std::int64_t>> last_;
  std::uint32_t newest_ = 0;
  Members members_;
  std::map<std::int64_t, std::uint32_t> missing_nodes_;
  std::vector<model::Location> line_;  ///< places of the nodes of the way at hand
  std::set<TileId> cells_;             ///< of the object at hand
  osmium::memory::Buffer copy_{1 << 16, osmium::memory::Buffer::auto_grow::yes};
};

}  // namespace

bool write_store(const std::string& extract, const std::string& folder, bool surroundings) {
  OsmFile file(extract);
  bool cleaned = false;
  for (;;) try {
      StoreWriter writer(file, folder);
      writer.index().figures.cleaned_texts = cleaned;
      writer.index().figures.surroundings = surroundings;
      return writer.write();
    } catch (const NulInText&) {
      if (cleaned)
        throw base::InputError(extract, "", "tags cannot be read", "The file is damaged: fetch or write it again");
      file.clean_strings();
      cleaned = true;
    }
}

}  // namespace blockrand::importers::osm
