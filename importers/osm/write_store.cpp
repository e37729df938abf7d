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

/// The cell of a box that spans at most kWholeSpan: the box lies within half a cell around it.
TileId home_of(const Box& box) {
  int level = kFinest;
  while (level > kCoarsest && box.span() > size_of(level)) --level;
  const auto middle = [](std::int64_t a, std::int64_t b) { return static_cast<std::int32_t>((a + b) / 2); };
  return georef::tile_of(model::Location{middle(box.west, box.east), middle(box.south, box.north)}, level);
}

/// The cells that a line leads through, which may go around the globe.
void find_along(std::span<const model::Location> line, std::set<TileId>& out) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const model::Location a = line[i], b = line[std::min(i + 1, line.size() - 1)];
    const double dx = static_cast<double>(b.lon) - a.lon, dy = static_cast<double>(b.lat) - a.lat;
    const int pieces = 1 + static_cast<int>(kUnit * std::max(std::abs(dx), std::abs(dy)) / kLineStep);
    for (int k = 0; k < pieces; ++k)
      out.insert(georef::tile_of(model::Location{static_cast<std::int32_t>(a.lon + dx * (k + 0.5) / pieces),
                                                 static_cast<std::int32_t>(a.lat + dy * (k + 0.5) / pieces)},
                                 kLineLevel));
  }
}

/// The store in the making.
class StoreFiles {
 public:
  explicit StoreFiles(std::string folder) : folder_(std::move(folder)) {
    std::error_code error;
    fs::remove(index_path(folder_), error);
    fs::create_directories(folder_, error);
    if (error) throw base::OutputError(folder_ + ": cannot be made: " + error.message());
    out_.open(objects_path(folder_), std::ios::binary | std::ios::trunc);
    check();
  }

  /// \param box  of the object, and of what it is there for
  void add(const std::set<TileId>& cells, Kind kind, const OSMObject& object, const Box& box) {
    const std::string what = told(object);
    if (kind != Kind::late_way) all_.add(what);
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
    index.figures.sha256 = all_.finish();
    index.figures.bytes = written_;
    for (auto& [tile, cell] : cells_) {
      CellEntry entry;
      entry.tile = tile, entry.box = cell.box, entry.sha256 = cell.hash.finish(), entry.chunks = std::move(cell.chunks);
      for (const Chunk& c : entry.chunks) entry.bytes += c.bytes;
      index.cells.push_back(std::move(entry));
    }
    index.placeless = !index.cells.empty() && index.cells.back().tile == nowhere();
    std::string bytes = base::packed(index);
    bytes += base::sha256_of(bytes);
    std::ofstream out(index_path(folder_), std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) throw base::OutputError(index_path(folder_) + ": cannot be written. Free some space");
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
  base::Sha256 all_;
};

class StoreWriter {
 public:
  StoreWriter(OsmFile& file, const std::string& folder) : file_(file), nodes_(folder + ".nodes"), files_(folder) {}

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
  struct Relation {
    std::vector<std::int64_t> ways, relations;
    std::set<TileId> cells;
    Box box;    ///< of its ways
    Box reach;  ///< of its relations as well, and of those that it is a member of
  };
  struct LateWay {
    std::set<TileId> cells;
    Box box;  ///< of its relations
  };
  struct KnownWay {
    Box box;
    bool there = false;
    std::set<TileId> cells;
  };

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
                     if (!kept_as(relation, interest_of(model::OsmType::relation, object))) return;
                     Relation& kept = relations_[object.id()];
                     for (const osmium::RelationMember& m : relation.members()) {
                       if (m.type() == osmium::item_type::way) kept.ways.push_back(m.ref()), boxes_[m.ref()];
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
    if (!is_kept(interest_of(model::OsmType::node, object))) return;
    cells_.clear();
    cells_.insert(is_known(at) ? georef::tile_of(at, kFinest) : nowhere());
    Box box;
    if (is_known(at)) box.add(at);
    files_.add(cells_, Kind::node, object, box);
  }

  /// Where a way is: in the cell of its box, or where a longer one leads.
  void find_way(const Box& box, std::set<TileId>& cells) {
    if (box.empty())
      cells.insert(nowhere());
    else if (box.span() <= kWholeSpan)
      cells.insert(home_of(box));
    else
      find_along(line_, cells);
  }

  /// A copy with the places of its nodes, which are left in `line_`.
  const osmium::Way& located(const OSMObject& object, Box& box) {
    line_.clear();
    copy_.clear();
    copy_.add_item(object);
    copy_.commit();
    auto& way = copy_.get<osmium::Way>(0);
    for (osmium::NodeRef& node : way.nodes()) {
      const model::Location at = nodes_.find(node.ref());
      node.set_location({at.lon, at.lat});
      if (at == kMissing) missing_nodes_.insert(node.ref());
      if (!is_known(at)) continue;
      box.add(at);
      line_.push_back(at);
    }
    return way;
  }

  void read_way(const OSMObject& object) {
    const bool alive = visit(object, index_.figures.ways);
    const Interest interest = interest_of(model::OsmType::way, object);
    const auto of_relation = boxes_.find(object.id());
    if (!alive || (!is_kept(interest) && of_relation == boxes_.end())) return;
    Box box;
    const osmium::Way& way = located(object, box);
    cells_.clear();
    find_way(box, cells_);
    if (of_relation != boxes_.end())
      of_relation->second.there = true, of_relation->second.box = box, of_relation->second.cells = cells_;
    files_.add(cells_, Kind::way, way, box);
  }

  void place_relations() {
    for (auto& [id, r] : relations_)
      for (const std::int64_t way : r.ways) r.box.add(boxes_[way].box);
    for (auto& [id, r] : relations_) {
      Box& box = r.reach;
      box = r.box;
      for (const std::int64_t member : r.relations)
        if (const auto found = relations_.find(member); found != relations_.end()) box.add(found->second.box);
      if (box.empty()) {
        r.cells.insert(nowhere());
      } else if (box.span() <= kWholeSpan) {
        r.cells.insert(home_of(box));
      } else {
        for (const std::int64_t way : r.ways) r.cells.insert(boxes_[way].cells.begin(), boxes_[way].cells.end());
      }
    }
    // Members of relations that are relations: buildings of parts that are multipolygons.
    for (auto& [id, r] : relations_)
      for (const std::int64_t member : r.relations)
        if (const auto found = relations_.find(member); found != relations_.end())
          found->second.cells.insert(r.cells.begin(), r.cells.end()), found->second.reach.add(r.reach);
    for (const auto& [id, r] : relations_)
      for (const std::int64_t way : r.ways) {
        const KnownWay& known = boxes_[way];
        if (!known.there) continue;
        if (r.cells == known.cells && r.reach == known.box) continue;
        // In its own cell it is found where its own box is: with the relation it is wherever that reaches.
        LateWay& late = late_[way];
        late.cells.insert(r.cells.begin(), r.cells.end());
        late.box.add(r.reach);
      }
    std::uint64_t again = 0;
    const std::uint32_t newest = newest_;
    file_.for_each(osmium::osm_entity_bits::relation,
                   [&](const OSMObject& object) {
                     if (!visit(object, again)) return;
                     const auto found = relations_.find(object.id());
                     if (found != relations_.end())
                       files_.add(found->second.cells, Kind::relation, object, found->second.reach);
                   },
                   {});
    newest_ = newest;
  }

  void write_late_ways() {
    if (late_.empty()) return;
    file_.for_each(
        osmium::osm_entity_bits::way,
        [&](const OSMObject& object) {
          const auto found = late_.find(object.id());
          if (found == late_.end() || !object.visible() || file_.deleted_by_editor(object.type(), object.id())) return;
          Box own;
          files_.add(found->second.cells, Kind::late_way, located(object, own), found->second.box);
        },
        {});
  }

  void finish() {
    StoreFigures& f = index_.figures;
    f.missing_nodes = missing_nodes_.size();
    for (const auto& [way, known] : boxes_) f.missing_ways += !known.there;
    if (newest_ > 0) f.data_time = osmium::Timestamp(newest_).to_iso();
    f.node_bytes = nodes_.bytes();
    files_.finish(std::move(index_));
  }

  OsmFile& file_;
  NodeFile nodes_;
  StoreFiles files_;
  Index index_;
  bool sorted_ = true;
  std::optional<std::tuple<osmium::item_type, bool, std::int64_t>> last_;
  std::uint32_t newest_ = 0;
  std::map<std::int64_t, Relation> relations_;
  std::map<std::int64_t, KnownWay> boxes_;  ///< of ways that relations have
  std::map<std::int64_t, LateWay> late_;    ///< by way
  std::set<std::int64_t> missing_nodes_;
  std::vector<model::Location> line_;  ///< places of the nodes of the way at hand
  std::set<TileId> cells_;             ///< of the object at hand
  osmium::memory::Buffer copy_{1 << 16, osmium::memory::Buffer::auto_grow::yes};
};

}  // namespace

bool write_store(const std::string& extract, const std::string& folder) {
  OsmFile file(extract);
  bool cleaned = false;
  for (;;) try {
      StoreWriter writer(file, folder);
      writer.index().figures.cleaned_texts = cleaned;
      return writer.write();
    } catch (const NulInText&) {
      if (cleaned)
        throw base::InputError(extract, "", "tags cannot be read", "The file is damaged: fetch or write it again");
      file.clean_strings();
      cleaned = true;
    }
}

}  // namespace blockrand::importers::osm
