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

/// Lists of an area, each sorted by id. Late ones came with a relation that reaches into the area.
enum class Kind : std::uint8_t { node, way, relation, late_way };

struct Chunk {
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0, crc = 0;
  Kind kind = Kind::node;
};

struct AreaEntry {
  TileId tile;
  std::string sha256;
  std::uint64_t bytes = 0;
  std::vector<Chunk> chunks;
};

struct Index {
  StoreFigures figures;
  bool placeless = false;
  std::vector<AreaEntry> areas;  ///< the placeless last, under kNowhere
};

TileId nowhere(int level) { return {level, ~0u, ~0u}; }

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string objects_path(const std::string& folder) { return folder + "/objects"; }
std::string index_path(const std::string& folder) { return folder + "/index"; }

/// A box in units of 1e-7 degrees.
struct Box {
  std::int64_t west = 1, south = 0, east = 0, north = 0;
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
  double span() const {
    if (empty()) return 0;
    return 1e-7 * static_cast<double>(std::max(east - west, north - south));
  }
};

/// Which areas a box touches.
class Grid {
 public:
  Grid(int level, double halo) : level_(level), halo_(halo) {}

  void find(const Box& box, std::set<TileId>& out) {
    if (box.empty()) return;
    constexpr double kUnit = 1e-7;
    const double north = halo_ / 110'000, most = std::max(std::abs(kUnit * static_cast<double>(box.south)),
                                                          std::abs(kUnit * static_cast<double>(box.north)));
    const double east = north / base::cos(std::min(89.0, most + 2 * north) * base::kPi / 180);
    const auto corner = [](double lon, double lat) {
      return model::Location{static_cast<std::int32_t>(std::clamp(lon, -180.0, 180.0) / kUnit),
                             static_cast<std::int32_t>(std::clamp(lat, -90.0, 90.0) / kUnit)};
    };
    const TileId low = georef::tile_of(corner(kUnit * static_cast<double>(box.west) - 1.01 * east,
                                              kUnit * static_cast<double>(box.south) - 1.01 * north),
                                       level_),
                 high = georef::tile_of(corner(kUnit * static_cast<double>(box.east) + 1.01 * east,
                                               kUnit * static_cast<double>(box.north) + 1.01 * north),
                                        level_);
    for (std::uint32_t y = low.y; y <= high.y; ++y)
      for (std::uint32_t x = low.x; x <= high.x; ++x)
        if (touches(window({level_, x, y}), box)) out.insert({level_, x, y});
  }

  /// Those that a line comes near, which may lead around the globe.
  void find_along(std::span<const model::Location> line, std::set<TileId>& out) {
    constexpr double kStep = 0.1;  // degrees
    for (std::size_t i = 0; i < line.size(); ++i) {
      const model::Location a = line[i], b = line[std::min(i + 1, line.size() - 1)];
      const double dx = static_cast<double>(b.lon) - a.lon, dy = static_cast<double>(b.lat) - a.lat;
      const int pieces = 1 + static_cast<int>(1e-7 * std::max(std::abs(dx), std::abs(dy)) / kStep);
      for (int k = 0; k < pieces; ++k) {
        Box box;
        for (const int end : {k, k + 1})
          box.add(model::Location{static_cast<std::int32_t>(a.lon + dx * end / pieces),
                                  static_cast<std::int32_t>(a.lat + dy * end / pieces)});
        find(box, out);
      }
    }
  }

 private:
  /// Rounded up.
  const Box& window(const TileId& tile) {
    const auto [found, is_new] = windows_.try_emplace(tile);
    if (is_new) {
      const georef::GeoBox b = georef::with_halo(tile, halo_);
      const auto unit = [](double degrees) { return static_cast<std::int64_t>(std::floor(degrees * 1e7)); };
      found->second = {unit(b.west) - 1, unit(b.south) - 1, unit(b.east) + 2, unit(b.north) + 2};
    }
    return found->second;
  }
  static bool touches(const Box& a, const Box& b) {
    return a.west <= b.east && a.east >= b.west && a.south <= b.north && a.north >= b.south;
  }

  int level_;
  double halo_;
  std::map<TileId, Box> windows_;
};

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

  void add(const std::set<TileId>& areas, Kind kind, const OSMObject& object) {
    const std::string what = told(object);
    if (kind != Kind::late_way) all_.add(what);
    const std::string_view bytes(reinterpret_cast<const char*>(object.data()), object.padded_size());
    for (const TileId& tile : areas) {
      Area& area = areas_[tile];
      if (area.kind != kind) flush(area);
      area.kind = kind;
      area.pending += bytes;
      area.hash.add(what);
      pending_ += bytes.size();
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
    for (auto& [tile, area] : areas_) {
      AreaEntry entry;
      entry.tile = tile, entry.sha256 = area.hash.finish(), entry.chunks = std::move(area.chunks);
      for (const Chunk& c : entry.chunks) entry.bytes += c.bytes;
      index.areas.push_back(std::move(entry));
    }
    index.placeless = !index.areas.empty() && index.areas.back().tile == nowhere(index.figures.level);
    std::string bytes = base::packed(index);
    bytes += base::sha256_of(bytes);
    std::ofstream out(index_path(folder_), std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) throw base::OutputError(index_path(folder_) + ": cannot be written. Free some space");
  }

 private:
  struct Area {
    std::string pending;
    Kind kind = Kind::node;
    std::vector<Chunk> chunks;
    base::Sha256 hash;
  };
  void check() {
    if (!out_)
      throw base::OutputError(objects_path(folder_) + ": cannot be written: " + std::strerror(errno) +
                              ". Free some space or check the permissions");
  }
  void flush(Area& area) {
    if (area.pending.empty()) return;
    area.chunks.push_back({written_, static_cast<std::uint32_t>(area.pending.size()), crc_of(area.pending), area.kind});
    out_.write(area.pending.data(), static_cast<std::streamsize>(area.pending.size()));
    check();
    written_ += area.pending.size();
    pending_ -= area.pending.size();
    std::string().swap(area.pending);  // assigning an empty one would keep its room
  }
  void flush_all() {
    for (auto& [tile, area] : areas_) flush(area);
  }

  std::string folder_;
  std::ofstream out_;
  std::uint64_t written_ = 0, pending_ = 0;
  std::map<TileId, Area> areas_;
  base::Sha256 all_;
};

class StoreWriter {
 public:
  StoreWriter(OsmFile& file, const std::string& folder, int level, double halo)
      : file_(file), grid_(level, halo), nodes_(folder + ".nodes"), files_(folder), level_(level) {
    index_.figures.level = level, index_.figures.halo = halo;
  }

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
    std::set<TileId> areas;
    Box box;
  };
  struct KnownWay {
    Box box;
    bool there = false;
    std::set<TileId> areas;  ///< of one that spans more than kWholeSpan
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
    areas_.clear();
    if (is_known(at)) {
      Box box;
      box.add(at);
      grid_.find(box, areas_);
    } else {
      areas_.insert(nowhere(level_));
    }
    files_.add(areas_, Kind::node, object);
  }

  /// Where a way is: everywhere in its box, or where a longer one leads.
  void find_way(const Box& box, std::set<TileId>& areas) {
    if (box.empty())
      areas.insert(nowhere(level_));
    else if (box.span() <= kWholeSpan)
      grid_.find(box, areas);
    else
      grid_.find_along(line_, areas);
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
    areas_.clear();
    find_way(box, areas_);
    if (of_relation != boxes_.end()) {
      of_relation->second.there = true, of_relation->second.box = box;
      if (box.span() > kWholeSpan) of_relation->second.areas = areas_;
    }
    files_.add(areas_, Kind::way, way);
  }

  void areas_of(const KnownWay& way, std::set<TileId>& areas) {
    if (way.box.empty())
      areas.insert(nowhere(level_));
    else if (way.box.span() <= kWholeSpan)
      grid_.find(way.box, areas);
    else
      areas.insert(way.areas.begin(), way.areas.end());
  }

  void place_relations() {
    for (auto& [id, r] : relations_)
      for (const std::int64_t way : r.ways) r.box.add(boxes_[way].box);
    for (auto& [id, r] : relations_) {
      Box box = r.box;
      for (const std::int64_t member : r.relations)
        if (const auto found = relations_.find(member); found != relations_.end()) box.add(found->second.box);
      if (box.empty()) {
        r.areas.insert(nowhere(level_));
      } else if (box.span() <= kWholeSpan) {
        grid_.find(box, r.areas);
      } else {
        for (const std::int64_t way : r.ways) areas_of(boxes_[way], r.areas);
      }
    }
    // Members of relations that are relations: buildings of parts that are multipolygons.
    for (auto& [id, r] : relations_)
      for (const std::int64_t member : r.relations)
        if (const auto found = relations_.find(member); found != relations_.end())
          found->second.areas.insert(r.areas.begin(), r.areas.end());
    for (const auto& [id, r] : relations_)
      for (const std::int64_t way : r.ways) {
        const KnownWay& known = boxes_[way];
        if (!known.there) continue;
        areas_.clear();
        areas_of(known, areas_);
        std::set_difference(r.areas.begin(), r.areas.end(), areas_.begin(), areas_.end(),
                            std::inserter(late_[way], late_[way].end()));
      }
    std::uint64_t again = 0;
    const std::uint32_t newest = newest_;
    file_.for_each(osmium::osm_entity_bits::relation,
                   [&](const OSMObject& object) {
                     if (!visit(object, again)) return;
                     const auto found = relations_.find(object.id());
                     if (found != relations_.end()) files_.add(found->second.areas, Kind::relation, object);
                   },
                   {});
    newest_ = newest;
  }

  void write_late_ways() {
    std::erase_if(late_, [](const auto& entry) { return entry.second.empty(); });
    if (late_.empty()) return;
    file_.for_each(
        osmium::osm_entity_bits::way,
        [&](const OSMObject& object) {
          const auto found = late_.find(object.id());
          if (found == late_.end() || !object.visible() || file_.deleted_by_editor(object.type(), object.id())) return;
          Box box;
          files_.add(found->second, Kind::late_way, located(object, box));
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
  Grid grid_;
  NodeFile nodes_;
  StoreFiles files_;
  int level_;
  Index index_;
  bool sorted_ = true;
  std::optional<std::tuple<osmium::item_type, bool, std::int64_t>> last_;
  std::uint32_t newest_ = 0;
  std::map<std::int64_t, Relation> relations_;
  std::map<std::int64_t, KnownWay> boxes_;         ///< of ways that relations have
  std::map<std::int64_t, std::set<TileId>> late_;  ///< by way
  std::set<std::int64_t> missing_nodes_;
  std::vector<model::Location> line_;  ///< places of the nodes of the way at hand
  std::set<TileId> areas_;             ///< of the object at hand
  osmium::memory::Buffer copy_{1 << 16, osmium::memory::Buffer::auto_grow::yes};
};

}  // namespace

bool write_store(const std::string& extract, const std::string& folder, int level, double halo) {
  OsmFile file(extract);
  bool cleaned = false;
  for (;;) try {
      StoreWriter writer(file, folder, level, halo);
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
  std::string folder;
  Index index;
  std::vector<StoredArea> areas;

  base::InputError damaged(const std::string& path) const {
    return base::InputError(path, "", "is damaged or missing", "Run again: it is made from the extract");
  }

  /// The objects of one kind, one after the other.
  osmium::memory::Buffer load(const AreaEntry& area, Kind kind, std::ifstream& in) const {
    std::size_t size = 0;
    for (const Chunk& c : area.chunks)
      if (c.kind == kind) size += c.bytes;
    osmium::memory::Buffer buffer(std::max<std::size_t>(size, 64), osmium::memory::Buffer::auto_grow::yes);
    std::string bytes;
    for (const Chunk& c : area.chunks) {
      if (c.kind != kind) continue;
      bytes.resize(c.bytes);
      in.seekg(static_cast<std::streamoff>(c.offset));
      in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      if (!in || crc_of(bytes) != c.crc) throw damaged(objects_path(folder));
      std::memcpy(buffer.reserve_space(bytes.size()), bytes.data(), bytes.size());
      buffer.commit();
    }
    return buffer;
  }

  const AreaEntry* find(const TileId& tile) const {
    const auto found = std::lower_bound(index.areas.begin(), index.areas.end(), tile,
                                        [](const AreaEntry& a, const TileId& t) { return a.tile < t; });
    return found == index.areas.end() || found->tile != tile ? nullptr : &*found;
  }

  void for_each(const std::vector<const AreaEntry*>& areas, osmium::osm_entity_bits::type type,
                const OsmFile::Visit& visit) const {
    std::ifstream in(objects_path(folder), std::ios::binary);
    if (!in) throw damaged(objects_path(folder));
    for (const auto& [bit, kinds] :
         {std::pair{osmium::osm_entity_bits::node, std::array{Kind::node, Kind::node}},
          std::pair{osmium::osm_entity_bits::way, std::array{Kind::way, Kind::late_way}},
          std::pair{osmium::osm_entity_bits::relation, std::array{Kind::relation, Kind::relation}}}) {
      if ((type & bit) == osmium::osm_entity_bits::nothing) continue;
      std::vector<osmium::memory::Buffer> buffers;
      for (const AreaEntry* area : areas) {
        buffers.push_back(load(*area, kinds[0], in));
        if (kinds[1] != kinds[0]) buffers.push_back(load(*area, kinds[1], in));
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

ExtractStore::ExtractStore(std::string folder) : state_(std::make_unique<State>()) {
  state_->folder = std::move(folder);
  const std::string path = index_path(state_->folder);
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
  for (const AreaEntry& a : state_->index.areas)
    if (a.tile != nowhere(a.tile.level)) state_->areas.push_back({a.tile, a.sha256, a.bytes});
}
ExtractStore::~ExtractStore() = default;
ExtractStore::ExtractStore(ExtractStore&&) noexcept = default;

const StoreFigures& ExtractStore::figures() const { return state_->index.figures; }
const std::vector<StoredArea>& ExtractStore::areas() const { return state_->areas; }
bool ExtractStore::has_placeless() const { return state_->index.placeless; }

model::Extract ExtractStore::read(const TileId& area, const ReadOptions& options, bool placeless) const {
  std::vector<const AreaEntry*> areas;
  for (const AreaEntry* entry : {state_->find(area), placeless ? state_->find(nowhere(area.level)) : nullptr})
    if (entry) areas.push_back(entry);
  OsmFile file(state_->folder, [&](osmium::osm_entity_bits::type type, const OsmFile::Visit& visit) {
    state_->for_each(areas, type, visit);
  });
  ReadOptions of_area = options;
  of_area.placeless = placeless;
  return read_file(file, state_->folder, of_area);
}

}  // namespace blockrand::importers::osm
