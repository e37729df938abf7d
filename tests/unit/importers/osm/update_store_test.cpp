// A store that was brought up to date says what one says that was written anew.
#include "importers/osm/update_store.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <random>
#include <set>

#include "importers/osm/extract_store.h"
#include "importers/osm/store_layout.h"
#include "importers/osm/store_reader.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm::test {
namespace {

using namespace store_layout;

/// Objects that are edited at random, with all that makes life hard: missing members, ways that span degrees, relations of relations.
class World {
 public:
  explicit World(unsigned seed) : random_(seed) {
    for (int i = 0; i < 160; ++i) new_node();
    for (int i = 0; i < 70; ++i) new_way();
    for (int i = 0; i < 25; ++i) new_relation();
    std::string text;
    for (const auto& [id, n] : nodes_) text += node(id, n);
    for (const auto& [id, w] : ways_) text += way(id, w);
    for (const auto& [id, r] : relations_) text += relation(id, r);
    base_ = "<osm version=\"0.6\">\n" + text + "</osm>\n";
  }
  const std::string& base() const { return base_; }

  /// A change file.
  std::string night() {
    changed_.clear();
    for (std::uint64_t edits = 1 + pick(6); edits > 0; --edits) edit();
    std::map<char, std::string> text;
    for (const auto& [type, id] : changed_) {
      const bool gone = type == 'n'   ? !nodes_.contains(id)
                        : type == 'w' ? !ways_.contains(id)
                                      : !relations_.contains(id);
      ++versions_[{type, id}];
      std::string& out = text[type];
      out += gone ? "<delete>" : "<modify>";
      if (type == 'n') out += node(id, gone ? Node() : nodes_[id]);
      if (type == 'w') out += way(id, gone ? Way() : ways_[id]);
      if (type == 'r') out += relation(id, gone ? Relation() : relations_[id]);
      out += gone ? "</delete>\n" : "</modify>\n";
    }
    ++day_;
    return "<osmChange version=\"0.6\">\n" + text['n'] + text['w'] + text['r'] + "</osmChange>\n";
  }

 private:
  struct Node {
    double lon = 13, lat = 52;
    std::string tags;
  };
  struct Way {
    std::vector<std::int64_t> nodes;
    std::string tags;
  };
  struct Relation {
    std::vector<std::string> members;
    std::string tags;
  };
  std::uint64_t pick(std::uint64_t n) { return random_() % n; }
  template <class Map>
  std::int64_t any(const Map& map) {
    return std::next(map.begin(), static_cast<std::ptrdiff_t>(pick(map.size())))->first;
  }
  static std::string tag(std::string_view key, std::string_view value) {
    return fmt::format("<tag k=\"{}\" v=\"{}\"/>", key, value);
  }
  Node place() {
    // Most in a town, some degrees away.
    const double reach = pick(12) == 0 ? 3.0 : 0.06;
    Node n;
    n.lon = 13 + reach * static_cast<double>(pick(10000)) / 10000,
    n.lat = 52 + reach * static_cast<double>(pick(10000)) / 10000;
    const std::array<std::string, 5> tags = {"", "", "", tag("natural", "tree"), tag("entrance", "yes")};
    n.tags = tags[pick(tags.size())];
    return n;
  }
  Way line() {
    Way w;
    const std::int64_t first = any(nodes_);
    for (std::uint64_t i = 0, n = 2 + pick(5); i < n; ++i)
      w.nodes.push_back(pick(25) == 0  ? 100'000 + static_cast<std::int64_t>(pick(40))
                        : pick(4) == 0 ? any(nodes_)
                                       : first + static_cast<std::int64_t>(i));
    if (pick(2) == 0) w.nodes.push_back(w.nodes.front());
    const std::array<std::string, 6> tags = {"",
                                             tag("building", "yes"),
                                             tag("building", "yes") + tag("height", "7"),
                                             tag("highway", "residential"),
                                             tag("landuse", "forest"),
                                             tag("building:part", "yes")};
    w.tags = tags[pick(tags.size())];
    return w;
  }
  Relation set() {
    Relation r;
    for (std::uint64_t i = 0, n = pick(5); i < n; ++i) {
      if (pick(4) == 0 && !relations_.empty())
        r.members.push_back(fmt::format("<member type=\"relation\" ref=\"{}\" role=\"part\"/>", any(relations_)));
      else
        r.members.push_back(fmt::format("<member type=\"way\" ref=\"{}\" role=\"outer\"/>",
                                        pick(15) == 0 ? 99'000 + static_cast<std::int64_t>(pick(9)) : any(ways_)));
    }
    const std::array<std::string, 4> tags = {
        tag("type", "multipolygon") + tag("building", "yes"), tag("type", "building"),
        tag("type", "multipolygon") + tag("landuse", "grass"), tag("type", "route")};
    r.tags = tags[pick(tags.size())];
    return r;
  }
  void new_node() { nodes_[next_] = place(), changed_.insert({'n', next_++}); }
  void new_way() { ways_[next_] = line(), changed_.insert({'w', next_++}); }
  void new_relation() { relations_[next_] = set(), changed_.insert({'r', next_++}); }
  void edit() {
    switch (pick(11)) {
      case 0:
        new_node();
        break;
      case 1:
        new_way();
        break;
      case 2:
        new_relation();
        break;
      case 3: {
        const std::int64_t id = any(nodes_);
        nodes_.erase(id), changed_.insert({'n', id});
        break;
      }
      case 4: {
        const std::int64_t id = any(ways_);
        ways_.erase(id), changed_.insert({'w', id});
        break;
      }
      case 5: {
        const std::int64_t id = any(relations_);
        relations_.erase(id), changed_.insert({'r', id});
        break;
      }
      case 6:
      case 7: {
        const std::int64_t id = any(nodes_);
        nodes_[id] = place(), changed_.insert({'n', id});
        break;
      }
      case 8: {
        const std::int64_t id = any(ways_);
        ways_[id].tags = line().tags, changed_.insert({'w', id});
        break;
      }
      case 9: {
        const std::int64_t id = any(ways_);
        ways_[id] = line(), changed_.insert({'w', id});
        break;
      }
      default: {
        const std::int64_t id = any(relations_);
        relations_[id] = set(), changed_.insert({'r', id});
      }
    }
  }
  std::string head(char type, std::int64_t id) {
    return fmt::format("id=\"{}\" version=\"{}\" timestamp=\"2020-01-{:02}T00:00:{:02}Z\"", id,
                       1 + versions_[{type, id}], 1 + day_ / 60 % 28, day_ % 60);
  }
  std::string node(std::int64_t id, const Node& n) {
    return fmt::format("<node {} lon=\"{:.7f}\" lat=\"{:.7f}\">{}</node>\n", head('n', id), n.lon, n.lat, n.tags);
  }
  std::string way(std::int64_t id, const Way& w) {
    std::string out = "<way " + head('w', id) + ">";
    for (const std::int64_t n : w.nodes) out += fmt::format("<nd ref=\"{}\"/>", n);
    return out + w.tags + "</way>\n";
  }
  std::string relation(std::int64_t id, const Relation& r) {
    std::string out = "<relation " + head('r', id) + ">";
    for (const std::string& m : r.members) out += m;
    return out + r.tags + "</relation>\n";
  }

  std::mt19937_64 random_;
  std::map<std::int64_t, Node> nodes_;
  std::map<std::int64_t, Way> ways_;
  std::map<std::int64_t, Relation> relations_;
  std::map<std::pair<char, std::int64_t>, int> versions_;
  std::set<std::pair<char, std::int64_t>> changed_;
  std::int64_t next_ = 1;
  int day_ = 0;
  std::string base_;
};

std::vector<std::string> files_of(const std::string& folder) {
  std::vector<std::string> out;
  for (const char* name : kStoreFiles) out.push_back(folder + "/" + name);
  return out;
}

/// All but where objects lie in the file.
std::string told_of(const std::string& folder) {
  const StoreReader reader(folder + "/objects", folder + "/index");
  const StoreFigures& f = reader.index.figures;
  std::string out = fmt::format("{} {} {} {} {} {} {} {}\n", f.nodes, f.ways, f.relations, f.missing_nodes,
                                f.missing_ways, f.data_time, f.sha256, reader.index.placeless);
  std::ifstream in(folder + "/objects", std::ios::binary);
  for (const CellEntry& cell : reader.index.cells) {
    out += fmt::format("{}/{}/{} {} {} {} {} {} {}\n", cell.tile.level, cell.tile.x, cell.tile.y, cell.box.west,
                       cell.box.south, cell.box.east, cell.box.north, cell.sha256, cell.bytes);
    for (const Kind kind : {Kind::node, Kind::way, Kind::relation, Kind::late_way})
      reader.visit_cell(cell, kind, in, [&](const Box& box, std::string_view object) {
        out += fmt::format(" {} {} {} {} {} {}\n", static_cast<int>(kind),
                           reinterpret_cast<const osmium::OSMObject*>(object.data())->id(), box.west, box.south,
                           box.east, box.north);
      });
  }
  const Upkeep upkeep = base::unpacked<Upkeep>(read_packed(folder + "/upkeep").value());
  base::Packer members;
  members << upkeep.members << upkeep.missing_nodes << upkeep.newest;
  return out + base::sha256_of(members.bytes);
}

TEST(UpdateStore, NightsAtRandomGiveWhatIsWrittenAnew) {
  int brought = 0, written = 0;
  std::map<std::string, int> why;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    World world(seed);
    const TempFolder folder;
    std::string data = folder.path("0.osm.pbf"), store = folder.path("store0");
    apply_changes(folder.write("base.osm", world.base()), {}, data);
    const bool surroundings = seed % 2 == 0;
    ASSERT_TRUE(write_store(data, store, surroundings));
    for (int night = 1; night <= 25; ++night) {
      SCOPED_TRACE(fmt::format("seed {}, night {}", seed, night));
      const std::string number = std::to_string(night), fresh = folder.path(number + ".osm.pbf");
      const std::shared_ptr<ChangedObjects> changes = no_changed_objects();
      apply_changes(data, std::vector{folder.write(number + ".osc", world.night())}, fresh, nullptr, changes.get());
      const std::string anew = folder.path("anew" + number), updated = folder.path("store" + number);
      ASSERT_TRUE(write_store(fresh, anew, surroundings));
      const std::string reason = update_store(files_of(store), *changes, fresh, updated);
      ++(reason.empty() ? brought : written);
      ++why[reason];
      if (reason.empty())
        ASSERT_EQ(told_of(updated), told_of(anew));
      else
        EXPECT_FALSE(std::filesystem::exists(updated + "/index"));
      store = reason.empty() ? updated : anew, data = fresh;
    }
  }
  // Rare cases alone ask for a store that is written anew.
  EXPECT_GT(brought, 4 * written) << [&] {
    std::string told;
    for (const auto& [reason, n] : why) told += fmt::format("{} {}\n", n, reason);
    return told;
  }();
}

TEST(UpdateStore, AStoreWrittenOverOneLeavesItsFiles) {
  World world(2);
  const TempFolder folder;
  apply_changes(folder.write("base.osm", world.base()), {}, folder.path("0.osm.pbf"));
  ASSERT_TRUE(write_store(folder.path("0.osm.pbf"), folder.path("store")));
  const std::string nodes = read_bytes(folder.path("store") + "/nodes");
  std::filesystem::create_directories(folder.path("new"));
  std::filesystem::create_hard_link(folder.path("store") + "/nodes", folder.path("new") + "/nodes");
  apply_changes(folder.path("0.osm.pbf"), std::vector{folder.write("1.osc", world.night())}, folder.path("1.osm.pbf"));
  ASSERT_TRUE(write_store(folder.path("1.osm.pbf"), folder.path("new")));
  EXPECT_EQ(read_bytes(folder.path("store") + "/nodes"), nodes);
}

TEST(UpdateStore, DamagedFilesAreFound) {
  World world(1);
  const TempFolder folder;
  apply_changes(folder.write("base.osm", world.base()), {}, folder.path("0.osm.pbf"));
  ASSERT_TRUE(write_store(folder.path("0.osm.pbf"), folder.path("store")));
  const std::shared_ptr<ChangedObjects> changes = no_changed_objects();
  apply_changes(folder.path("0.osm.pbf"), std::vector{folder.write("1.osc", world.night())}, folder.path("1.osm.pbf"),
                nullptr, changes.get());
  std::filesystem::resize_file(folder.path("store") + "/upkeep", 100);
  EXPECT_THROW(update_store(files_of(folder.path("store")), *changes, folder.path("1.osm.pbf"), folder.path("new")),
               base::InputError);
}

}  // namespace
}  // namespace blockrand::importers::osm::test
