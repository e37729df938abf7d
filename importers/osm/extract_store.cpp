#include "importers/osm/extract_store.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/timestamp.hpp>
#include <osmium/osm/way.hpp>
#include <set>
#include <span>

#include "importers/osm/node_file.h"
#include "importers/osm/osm_file.h"
#include "importers/osm/read_file.h"
#include "importers/osm/selection.h"
#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/sha256.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::importers::osm {
namespace {

namespace fs = std::filesystem;
using model::TileId;
using osmium::OSMObject;

constexpr std::uint64_t kMostPending = 64'000'000;  // bytes of objects that wait for the disk
constexpr std::size_t kHashLength = 64;             // hex digits

/// Lists of a cell, each sorted by id. Late ones came with a relation.
enum class Kind : std::uint8_t { node, way, relation, late_way };

struct Chunk {
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0, crc = 0;
  Kind kind = Kind::node;
};

/// A box in units of 1e-7 degrees.
struct Box {
  std::int32_t west = 1, south = 0, east = 0, north = 0;
  bool empty() const { return west > east; }
  void add(model::Location l) { add({l.lon, l.lat, l.lon, l.lat}); }
  void add(const Box& b) {
    if (b.empty()) return;
    if (empty()) {
      *this = b;
      return;
    }
    west = std::min(west, b.west), south = std::min(south, b.south);
    east = std::max(east, b.east), north = std::max(north, b.north);
  }
  friend bool operator==(const Box&, const Box&) = default;
  bool meets(const Box& b) const {
    return !empty() && !b.empty() && west <= b.east && east >= b.west && south <= b.north && north >= b.south;
  }
  double span() const {
    if (empty()) return 0;
    return 1e-7 * std::max(static_cast<double>(east) - west, static_cast<double>(north) - south);
  }
};

struct CellEntry {
  TileId tile;
  Box box;  ///< of its objects
  std::string sha256;
  std::uint64_t bytes = 0;
  std::vector<Chunk> chunks;
};

struct Index {
  StoreFigures figures;
  bool placeless = false;
  std::vector<CellEntry> cells;  ///< ascending; the placeless under nowhere()
};

/// Levels of cells: the finest is 1.5 by 2.4 km at 51 degrees, the coarsest holds kWholeSpan.
constexpr int kFinest = 13, kCoarsest = 7;
/// Of pieces of lines that span more than kWholeSpan, and their length in degrees, which is less than half a cell.
constexpr int kLineLevel = 10;
constexpr double kLineStep = 0.08;

/// The cell of what has no place.
TileId nowhere() { return {kFinest + 1, ~0u, ~0u}; }
double size_of(int level) { return 180.0 / static_cast<double>(1u << level); }

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string objects_path(const std::string& folder) { return folder + "/" + kStoreFiles[0]; }
std::string index_path(const std::string& folder) { return folder + "/" + kStoreFiles[1]; }

constexpr double kUnit = 1e-7;

/// Rounded to the outside. \param window  west, south, east, north in degrees
Box box_of(const std::array<double, 4>& window) {
  const auto unit = [](double degrees, double most, double add) {
    return static_cast<std::int32_t>(std::clamp(std::floor(degrees / kUnit) + add, -most, most));
  };
  return {unit(window[0], 1.8e9, -1), unit(window[1], 9e8, -1), unit(window[2], 1.8e9, 2), unit(window[3], 9e8, 2)};
}

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

/// What an object says, as bytes: without what lies between fields in memory.
std::string told(const OSMObject& object) {
  base::Packer p;
  p << static_cast<int>(object.type()) << object.id() << object.version()
    << static_cast<std::uint32_t>(object.timestamp());
  for_each_tag(object,
               [&](std::string_view key, std::string_view value) { p << std::string(key) << std::string(value); });
  p << std::string();
  if (object.type() == osmium::item_type::node) {
    const osmium::Location l = static_cast<const osmium::Node&>(object).location();
    p << l.x() << l.y();
  } else if (object.type() == osmium::item_type::way) {
    for (const osmium::NodeRef& n : static_cast<const osmium::Way&>(object).nodes())
      p << n.ref() << n.location().x() << n.location().y();
  } else {
    for (const osmium::RelationMember& m : static_cast<const osmium::Relation&>(object).members())
      p << m.ref() << static_cast<int>(m.type()) << std::string(m.role());
  }
  return std::move(p.bytes);
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
