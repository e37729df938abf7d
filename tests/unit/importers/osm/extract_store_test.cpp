// A store on disk: what an area reads is what the whole extract says of it.
#include "importers/osm/extract_store.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "importers/osm/apply_changes.h"
#include "importers/osm/node_file.h"
#include "importers/osm/raw_data.h"
#include "pipeline/georef/tiles.h"
#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm::test {
namespace {

namespace fs = std::filesystem;
constexpr double kHalo = 3000;

ReadOptions window_of(const model::TileId& tile) {
  const georef::GeoBox w = georef::with_halo(tile, kHalo);
  ReadOptions options;
  options.bbox = {w.west, w.south, w.east, w.north};
  return options;
}

/// Without what is counted of the file.
std::string dump_objects(model::Extract&& extract) {
  extract.counts = {};
  extract.data_time.clear();
  return dump(extract);
}

TEST(ExtractStore, AreasOfRealExtractsReadAsTheWholeSays) {
  const fs::path data = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm";
  if (!fs::exists(data)) GTEST_SKIP() << "no " << data;
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(data)) {
    if (!entry.is_regular_file() || entry.file_size() > 1'500'000) continue;
    SCOPED_TRACE(entry.path().filename());
    const TempFolder folder;
    std::string extract = entry.path().string();
    if (!write_store(extract, folder.path("store"))) {
      extract = folder.path("sorted.osm.pbf");
      apply_changes(entry.path().string(), {}, extract);
      ASSERT_TRUE(write_store(extract, folder.path("store")));
    }
    const ExtractStore store(folder.path("store"));
    const model::Extract whole = read_extract(extract);
    EXPECT_EQ(store.figures().nodes, whole.counts.nodes);
    EXPECT_EQ(store.figures().ways, whole.counts.ways);
    EXPECT_EQ(store.figures().relations, whole.counts.relations);
    EXPECT_EQ(store.figures().missing_nodes, whole.counts.missing_nodes);
    EXPECT_EQ(store.figures().missing_ways, whole.counts.missing_ways);
    EXPECT_EQ(store.figures().data_time, whole.data_time);
    std::size_t owned = 0, placeless = 0, n = 0;
    for (const StoredArea& area : store.areas(12)) {
      const bool first = n++ == 0;
      const model::Extract read = store.read(window_of(area.tile), false);
      if (n % 7 == 1) {  // reading the whole for each would take minutes
        EXPECT_EQ(dump_objects(store.read(window_of(area.tile), false)),
                  dump_objects(read_extract(extract, window_of(area.tile))));
        ++compared;
      }
      const auto here = [&](const model::MappedBuilding& b) {
        return b.place ? georef::tile_of(*b.place, 12) == area.tile : false;
      };
      owned += static_cast<std::size_t>(std::ranges::count_if(read.buildings, here));
      if (first && store.has_placeless()) {
        const model::Extract with = store.read(window_of(area.tile), true);
        placeless = with.buildings.size() - read.buildings.size();
      }
    }
    std::size_t wanted = 0, nowhere = 0;
    for (const model::MappedBuilding& b : whole.buildings) {
      wanted += b.rings.count == 0 && b.place.has_value();
      nowhere += b.rings.count == 0 && !b.place && b.state == model::ObjectState::reported;
    }
    EXPECT_EQ(owned, wanted);  // of objects without rings: those have their place
    EXPECT_GE(placeless, nowhere);
  }
  EXPECT_GT(compared, 20);
}

TEST(ExtractStore, WhatOnlySurroundingsAreMadeOfIsThereWhereItIsAskedFor) {
  const TempFolder folder;
  const auto town = [&](const std::string& name, bool with_another_lamp) {
    OsmText text;
    text.corners(1, 0, 0, 1).corners(11, 40, 0, 1);
    text.node(21, 11, 51, {{"highway", "street_lamp"}}).node(22, 11, 51.0001, {{"natural", "tree"}});
    if (with_another_lamp) text.node(23, 11.0002, 51, {{"highway", "street_lamp"}});
    text.way(1, {1, 2, 3, 4, 1}, {{"building", "yes"}}).way(2, {11, 12}, {{"power", "line"}});
    return folder.write(name, text.xml());
  };
  const std::string extract = town("a.osm", false), later = town("b.osm", true);
  for (const bool surroundings : {false, true}) {
    SCOPED_TRACE(surroundings);
    ASSERT_TRUE(write_store(extract, folder.path("store"), surroundings));
    const ExtractStore store(folder.path("store"));
    EXPECT_EQ(store.figures().surroundings, surroundings);
    ReadOptions all;
    all.surroundings = surroundings;
    std::set<model::OsmId> found;
    for (const model::Feature& f : store.read(all, false).features) found.insert(f.id);
    std::set<model::OsmId> wanted{{model::OsmType::node, 22}};
    if (surroundings) wanted.insert({{model::OsmType::node, 21}, {model::OsmType::way, 2}});
    EXPECT_EQ(found, wanted);
  }
  // A lamp that came is a change of the one store, and none of the other.
  for (const bool surroundings : {false, true}) {
    ASSERT_TRUE(write_store(extract, folder.path("before"), surroundings));
    ASSERT_TRUE(write_store(later, folder.path("after"), surroundings));
    const auto changes = ExtractStore(folder.path("after")).changes_since(ExtractStore(folder.path("before")));
    ASSERT_EQ(changes.size(), surroundings ? 1u : 0u);
    for (const ChangedObject& change : changes) EXPECT_NE(change.kinds, 0u);
  }
}

TEST(ExtractStore, AnUnsortedFileIsRefused) {
  const TempFolder folder;
  OsmText text;
  text.node(2, 11, 51).node(1, 11, 51);
  EXPECT_FALSE(write_store(folder.write("a.osm", text.xml()), folder.path("store")));
}

TEST(ExtractStore, WhatIsFarAwayIsNotRead) {
  const TempFolder folder;
  OsmText text;
  text.corners(1, 0, 0, 1).corners(11, 10000, 0, 1);
  text.way(1, {1, 2, 3, 4, 1}, {{"building", "yes"}}).way(2, {11, 12, 13, 14, 11}, {{"building", "yes"}});
  ASSERT_TRUE(write_store(folder.write("a.osm", text.xml()), folder.path("store")));
  const ExtractStore store(folder.path("store"));
  ASSERT_GE(store.areas(12).size(), 2u);
  std::set<model::OsmId> found;
  for (const StoredArea& a : store.areas(12)) {
    const model::Extract read = store.read(window_of(a.tile), false);
    EXPECT_LE(read.buildings.size(), 1u);
    for (const model::MappedBuilding& b : read.buildings) found.insert(b.id);
    EXPECT_LT(store.part(*window_of(a.tile).bbox).bytes, store.figures().bytes);
  }
  EXPECT_EQ(found.size(), 2u);
}

TEST(ExtractStore, OfAWindowThePartsAreRead) {
  const TempFolder folder;
  OsmText text;
  for (int i = 0; i < 9; ++i) text.corners(10 * i + 1, 200 * i, 0, 1);
  for (int i = 0; i < 9; ++i)
    text.way(i + 1, {10 * i + 1, 10 * i + 2, 10 * i + 3, 10 * i + 4, 10 * i + 1}, {{"building", "yes"}});
  text.way(20, {1, 81}, {{"highway", "residential"}});
  text.way(21, {31, 41}, {{"highway", "residential"}});
  ASSERT_TRUE(write_store(folder.write("a.osm", text.xml()), folder.path("store")));
  const ExtractStore store(folder.path("store"));
  const model::Extract whole = store.read({}, false);
  ASSERT_EQ(whole.buildings.size(), 9u);
  const auto around = [&](std::size_t first, std::size_t last) {
    std::array<double, 4> box{180, 90, -180, -90};
    for (std::size_t i = first; i <= last; ++i)
      for (const model::MappedRing& ring : whole.rings_of(whole.buildings[i].rings))
        for (const model::Location v : whole.vertices_of(ring))
          box = {std::min(box[0], v.lon * 1e-7), std::min(box[1], v.lat * 1e-7), std::max(box[2], v.lon * 1e-7),
                 std::max(box[3], v.lat * 1e-7)};
    return box;
  };
  ReadOptions options;
  options.bbox = around(0, 8);
  options.parts = {around(0, 1), around(6, 7), around(7, 7)};
  const model::Extract parts = store.read(options, false);
  std::vector<std::int64_t> ids, features;
  for (const model::MappedBuilding& b : parts.buildings) ids.push_back(b.id.number);
  for (const model::Feature& f : parts.features) features.push_back(f.id.number);
  EXPECT_EQ(ids, (std::vector<std::int64_t>{1, 2, 7, 8}));
  EXPECT_EQ(features, (std::vector<std::int64_t>{20})) << "the other street lies between the parts";
  const std::string by_parts = dump_objects(store.read(options, false));
  std::swap(options.parts.front(), options.parts.back());
  EXPECT_EQ(dump_objects(store.read(options, false)), by_parts);
}

TEST(ExtractStore, WhatLeadsAroundTheGlobeIsInFewAreas) {
  const TempFolder folder;
  OsmText text;
  text.node(1, -179, -80).node(2, 179, 80).node(3, 179, -80);
  text.square(1, 11, 0, 0, 1, {{"building", "yes"}});
  text.way(2, {1, 2, 3, 1}, {{"natural", "water"}}).way(3, {1, 2}, {{"highway", "primary"}});
  text.way(4, {2, 3, 1}).relation(5, {"w3 outer", "w4 outer"}, {{"type", "multipolygon"}, {"landuse", "forest"}});
  ASSERT_TRUE(write_store(folder.write("a.osm", text.xml()), folder.path("store")));
  const ExtractStore store(folder.path("store"));
  EXPECT_LT(store.areas(11).size(), 100'000u);  // of 8 million
}

TEST(ExtractStore, ADamagedOneIsTold) {
  const TempFolder folder;
  OsmText text;
  text.square(1, 1, 0, 0, 1, {{"building", "yes"}});
  const std::string extract = folder.write("a.osm", text.xml());
  ASSERT_TRUE(write_store(extract, folder.path("store")));
  const model::TileId tile = ExtractStore(folder.path("store")).areas(12).front().tile;
  {
    std::fstream objects(folder.path("store") + "/objects", std::ios::binary | std::ios::in | std::ios::out);
    objects.seekp(20);
    objects.put('!');
  }
  const ExtractStore store(folder.path("store"));
  EXPECT_THROW(store.read(window_of(tile), false), base::InputError);
  fs::resize_file(folder.path("store") + "/index", 100);
  EXPECT_THROW(ExtractStore(folder.path("store")), base::InputError);
  EXPECT_THROW(ExtractStore(folder.path("none")), base::InputError);
}

TEST(ExtractStore, AreasHashWhatTheyHold) {
  const TempFolder folder;
  const auto hashes = [&](const std::string& use) {
    OsmText text;
    text.corners(1, 0, 0, 1).corners(11, 10000, 0, 1);
    text.way(1, {1, 2, 3, 4, 1}, {{"building", "yes"}}).way(2, {11, 12, 13, 14, 11}, {{"building", use}});
    EXPECT_TRUE(write_store(folder.write("a.osm", text.xml()), folder.path("store")));
    std::vector<std::string> out;
    const ExtractStore store(folder.path("store"));
    for (const StoredArea& a : store.areas(12)) out.push_back(a.sha256);
    return out;
  };
  const auto a = hashes("yes"), b = hashes("yes"), c = hashes("shed");
  EXPECT_EQ(a, b);
  ASSERT_EQ(a.size(), c.size());
  EXPECT_EQ(a.front(), c.front());
  EXPECT_NE(a.back(), c.back());
}

TEST(ExtractStore, ChangesAreTheObjectsThatDiffer) {
  const TempFolder folder;
  struct Edit {
    std::string use = "yes", storeys = "3", height = "";
    double x = 0;  ///< m, of the third building
    bool street = true, park = true;
  };
  const auto stored = [&](const std::string& name, const Edit& edit) {
    OsmText text;
    text.corners(1, 0, 0, 1).corners(11, 9000, 0, 1).corners(21, 20 + edit.x, 0, 1).corners(31, 40, 0, 1);
    TagList tags = {{"building", edit.use}};
    if (!edit.storeys.empty()) tags.emplace_back("building:levels", edit.storeys);
    if (!edit.height.empty()) tags.emplace_back("height", edit.height);
    text.way(1, {1, 2, 3, 4, 1}, {{"building", "yes"}}).way(2, {11, 12, 13, 14, 11}, tags);
    text.way(3, {21, 22, 23, 24, 21}, {{"building", "yes"}});
    text.way(4, {1, 11}, {{"highway", edit.street ? "residential" : "primary"}});
    text.way(5, edit.park ? std::vector<std::int64_t>{31, 32, 33, 34, 31} : std::vector<std::int64_t>{31, 32, 33, 31});
    text.relation(6, {"w5 outer"}, {{"type", "multipolygon"}, {"landuse", "forest"}});
    EXPECT_TRUE(write_store(folder.write(name + ".osm", text.xml()), folder.path(name)));
    return ExtractStore(folder.path(name));
  };
  const ExtractStore before = stored("before", {});
  const auto changed = [&](const Edit& edit) {
    std::map<std::string, ChangedObject> out;
    for (const ChangedObject& c : stored("now", edit).changes_since(before)) out[c.id.text()] = c;
    return out;
  };
  EXPECT_TRUE(changed({}).empty());
  const auto retagged = changed({.use = "shed"});
  ASSERT_EQ(retagged.size(), 1u);
  EXPECT_TRUE(retagged.at("w2").building);
  EXPECT_FALSE(retagged.at("w2").network);
  EXPECT_FALSE(retagged.at("w2").look_only);
  EXPECT_TRUE(changed({.storeys = "4"}).at("w2").look_only);
  EXPECT_FALSE(changed({.use = "shed", .storeys = "4"}).at("w2").look_only);
  // Which of two outlines in one place is built, the number of tags may decide; which lies above the other, heights.
  EXPECT_FALSE(changed({.storeys = ""}).at("w2").look_only);
  EXPECT_FALSE(changed({.height = "9"}).at("w2").look_only);
  // Both places of what was moved: in one cell together, else apart.
  const auto moved = changed({.x = 10});
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_FALSE(moved.at("w3").look_only);
  EXPECT_NEAR(moved.at("w3").box[2] - moved.at("w3").box[0], 11e-4, 1e-6);
  const std::vector<ChangedObject> far = stored("now", {.x = 3000}).changes_since(before);
  ASSERT_EQ(far.size(), 2u);
  EXPECT_NEAR(std::abs(far[0].box[0] - far[1].box[0]), 0.3, 1e-6);
  const auto street = changed({.street = false});
  ASSERT_EQ(street.size(), 1u);
  EXPECT_TRUE(street.at("w4").network);
  // A relation changes with its ways.
  const auto park = changed({.park = false});
  EXPECT_EQ(park.size(), 2u);
  EXPECT_TRUE(park.contains("r6"));
  EXPECT_FALSE(park.at("r6").building);
}

TEST(NodeFile, FindsEveryNodeAndNoOther) {
  const TempFolder folder;
  NodeFile file(folder.path("nodes"));
  std::vector<std::pair<std::int64_t, model::Location>> nodes = {{-1, {5, -6}}, {-7, {-1'800'000'000, 900'000'000}}};
  for (std::int64_t i = 1; i < 5000; ++i)
    nodes.push_back({i * i, {static_cast<std::int32_t>(i * 1000), static_cast<std::int32_t>(-i * 777)}});
  nodes.push_back({1'000'000'000'000, kInvalid});
  for (const auto& [id, at] : nodes) file.add(id, at);
  file.finish();
  for (const auto& [id, at] : nodes) EXPECT_EQ(file.find(id), at);
  for (const std::int64_t id : {-2L, -8L, 0L, 2L, 3L, 4999L * 4999 + 1, 1'000'000'000'001L})
    EXPECT_EQ(file.find(id), kMissing);
}

}  // namespace
}  // namespace blockrand::importers::osm::test
