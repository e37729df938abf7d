// Change files applied to extracts: what is written is what a file with the new state would say.
#include "importers/osm/apply_changes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/reader.hpp>

#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm {
namespace {

using test::OsmText;
using test::read_bytes;
using test::TempFolder;

std::string node(int id, int version, double lon, bool visible = true) {
  return "<node id=\"" + std::to_string(id) + "\" version=\"" + std::to_string(version) + "\" lon=\"" +
         std::to_string(lon) + "\" lat=\"51\"" + (visible ? "" : " visible=\"false\"") + "/>";
}
std::string osm(const std::string& objects) { return "<osm version=\"0.6\">" + objects + "</osm>"; }
std::string changes(const std::string& text) { return "<osmChange version=\"0.6\">" + text + "</osmChange>"; }
std::string way(int id, int version, const std::string& tag) {
  return "<way id=\"" + std::to_string(id) + "\" version=\"" + std::to_string(version) +
         "\"><nd ref=\"1\"/><nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"1\"/><tag k=\"building\" v=\"" + tag + "\"/></way>";
}

const std::string kBase =
    osm(node(1, 1, 11) + node(2, 1, 11.001) + node(3, 1, 11.002) + node(9, 3, 11.1) + way(7, 2, "yes"));

struct Applied {
  AppliedChanges counts;
  std::string seen;  ///< the objects that were not deleted
};

/// Id, version, place or nodes, and tags of each object that is visible.
std::string visible(const std::string& path) {
  std::string out;
  osmium::io::Reader reader(path);
  while (osmium::memory::Buffer buffer = reader.read())
    for (const auto& o : buffer.select<osmium::OSMObject>()) {
      if (!o.visible()) continue;
      out += std::string(1, osmium::item_type_to_char(o.type())) + std::to_string(o.id()) + " v" +
             std::to_string(o.version());
      if (o.type() == osmium::item_type::node) {
        const osmium::Location at = static_cast<const osmium::Node&>(o).location();
        out += " " + std::to_string(at.x()) + "," + std::to_string(at.y());
      }
      if (o.type() == osmium::item_type::way)
        for (const auto& n : static_cast<const osmium::Way&>(o).nodes()) out += " " + std::to_string(n.ref());
      for (const auto& tag : o.tags()) out += std::string(" ") + tag.key() + "=" + tag.value();
      out += "\n";
    }
  reader.close();
  return out;
}

Applied apply(const std::string& base, const std::vector<std::string>& change_texts,
              const char* base_name = "base.osm") {
  const TempFolder folder;
  std::vector<std::string> files;
  for (const std::string& text : change_texts)
    files.push_back(folder.write(std::to_string(files.size()) + ".osc", text));
  Applied out;
  out.counts = apply_changes(folder.write(base_name, base), files, folder.path("out.osm.pbf"));
  out.seen = visible(folder.path("out.osm.pbf"));
  return out;
}

TEST(ApplyChanges, NewChangedAndDeletedObjects) {
  const Applied done = apply(kBase, {changes("<create>" + node(5, 1, 11.5) + "</create><modify>" + way(7, 3, "house") +
                                             "</modify><delete>" + node(9, 4, 11.1) + "</delete>")});
  EXPECT_EQ(done.counts.created, 1u);
  EXPECT_EQ(done.counts.modified, 1u);
  EXPECT_EQ(done.counts.deleted, 1u);
  const Applied wanted =
      apply(osm(node(1, 1, 11) + node(2, 1, 11.001) + node(3, 1, 11.002) + node(5, 1, 11.5) + way(7, 3, "house")), {});
  EXPECT_EQ(done.seen, wanted.seen);
}

TEST(ApplyChanges, OrderOfFilesAndObjectsDoesNotMatter) {
  const std::string first = changes("<modify>" + way(7, 3, "house") + node(2, 2, 11.2) + "</modify>"),
                    second = changes("<modify>" + way(7, 4, "apartments") + "</modify><delete>" + node(2, 3, 11.2) +
                                     "</delete>");
  const Applied one = apply(kBase, {first, second}), other = apply(kBase, {second, first});
  EXPECT_EQ(one.seen, other.seen);
  EXPECT_EQ(one.counts.modified, 1u);
  EXPECT_EQ(one.counts.deleted, 1u);
  // One after the other gives the same as both at once.
  const TempFolder folder;
  const std::string a = folder.write("a.osc", first), b = folder.write("b.osc", second);
  apply_changes(folder.write("base.osm", kBase), std::vector{a}, folder.path("1.osm.pbf"));
  apply_changes(folder.path("1.osm.pbf"), std::vector{b}, folder.path("2.osm.pbf"));
  EXPECT_EQ(visible(folder.path("2.osm.pbf")), one.seen);
  // A base that is not sorted.
  const Applied unsorted =
      apply(osm(way(7, 2, "yes") + node(9, 3, 11.1) + node(3, 1, 11.002) + node(2, 1, 11.001) + node(1, 1, 11)),
            {first, second});
  EXPECT_EQ(unsorted.seen, one.seen);
}

TEST(ApplyChanges, AppliedAgainNothingChanges) {
  const std::string change = changes("<modify>" + way(7, 3, "house") + "</modify><delete>" + node(9, 4, 11.1) +
                                     "</delete><create>" + node(5, 1, 11.5) + "</create>");
  const TempFolder folder;
  const std::string file = folder.write("a.osc", change);
  apply_changes(folder.write("base.osm", kBase), std::vector{file}, folder.path("1.osm.pbf"));
  const AppliedChanges again = apply_changes(folder.path("1.osm.pbf"), std::vector{file}, folder.path("2.osm.pbf"));
  EXPECT_FALSE(again.any());
  EXPECT_EQ(again.known, 3u);
  EXPECT_EQ(read_bytes(folder.path("1.osm.pbf")), read_bytes(folder.path("2.osm.pbf")));
}

TEST(ApplyChanges, WhatWasDeletedStaysSoWhenAnOlderChangeComesLater) {
  const TempFolder folder;
  const std::string monday = folder.write("mon.osc", changes("<modify>" + way(7, 3, "house") + "</modify>")),
                    tuesday = folder.write("tue.osc", changes("<delete>" + way(7, 4, "house") + "</delete>"));
  for (const auto& order : {std::vector{monday, tuesday}, std::vector{tuesday, monday}}) {
    std::string base = folder.write("base.osm", kBase);
    int night = 0;
    for (const std::string& change : {order[0], order[1], monday}) {
      const std::string next = folder.path("night" + std::to_string(++night) + ".osm.pbf");
      apply_changes(base, std::vector{change}, next);
      base = next;
    }
    EXPECT_EQ(visible(base).find("w7"), std::string::npos);
    // Somebody undid the deletion: a higher version.
    const std::string undone = folder.write("undone.osc", changes("<modify>" + way(7, 5, "house") + "</modify>"));
    const AppliedChanges applied = apply_changes(base, std::vector{undone}, folder.path("undone.osm.pbf"));
    EXPECT_EQ(applied.created, 1u);
    EXPECT_NE(visible(folder.path("undone.osm.pbf")).find("w7 v5"), std::string::npos);
  }
}

TEST(ApplyChanges, OfEqualVersionsTheLastOneCounts) {
  const Applied done =
      apply(kBase, {changes("<modify>" + way(7, 3, "house") + "</modify><delete>" + way(7, 3, "house") + "</delete>")});
  EXPECT_EQ(done.counts.deleted, 1u);
  EXPECT_EQ(done.seen.find("w7"), std::string::npos);
}

TEST(ApplyChanges, OlderVersionsChangeNothing) {
  const Applied done =
      apply(kBase, {changes("<modify>" + way(7, 1, "garage") + "</modify><delete>" + node(9, 2, 11.1) + "</delete>")});
  EXPECT_FALSE(done.counts.any());
  EXPECT_EQ(done.seen, apply(kBase, {}).seen);
}

TEST(ApplyChanges, BadFilesAreRefusedAndNothingIsLeft) {
  const TempFolder folder;
  const std::string base = folder.write("base.osm", kBase), out = folder.path("out.osm.pbf");
  const std::string whole = changes("<modify>" + way(7, 3, "house") + "</modify>");
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"cut.osc", whole.substr(0, whole.size() - 30)},
                                   {"empty.osc", ""},
                                   {"extract.osc", kBase},
                                   {"text.osc", "no XML at all"},
                                   {"cut.osc.gz", "\x1f\x8b\x08 cut"}}) {
    const std::string file = folder.write(name, text);
    EXPECT_THROW(apply_changes(base, std::vector{file}, out), base::InputError) << name;
    EXPECT_FALSE(std::filesystem::exists(out)) << name;
  }
  EXPECT_THROW(apply_changes(base, std::vector{folder.path("absent.osc")}, out), base::InputError);
  EXPECT_THROW(apply_changes(base, {}, folder.path("no/such/folder/out.osm.pbf")), base::OutputError);
}

std::string plain_way(int id, std::vector<int> nodes, int version = 1) {
  std::string out = "<way id=\"" + std::to_string(id) + "\" version=\"" + std::to_string(version) + "\">";
  for (const int n : nodes) out += "<nd ref=\"" + std::to_string(n) + "\"/>";
  return out + "</way>";
}
std::string relation(int id, const std::string& type, const std::vector<std::pair<std::string, int>>& members) {
  std::string out = "<relation id=\"" + std::to_string(id) + "\" version=\"1\">";
  for (const auto& [kind, member] : members)
    out += "<member type=\"" + kind + "\" ref=\"" + std::to_string(member) + "\" role=\"\"/>";
  return out + "<tag k=\"type\" v=\"" + type + "\"/></relation>";
}

/// Kinds and ids: "n1 n2 w7 r1 ".
std::string ids(const std::string& path) {
  std::string out;
  osmium::io::Reader reader(path);
  while (osmium::memory::Buffer buffer = reader.read())
    for (const auto& o : buffer.select<osmium::OSMObject>())
      out += std::string(o.visible() ? "" : "-") + osmium::item_type_to_char(o.type()) + std::to_string(o.id()) + " ";
  reader.close();
  return out;
}

/// Longitudes from 11 to 12.
const ClipPolygon kEleven(std::vector<ClipPolygon::Rings>{{{{110'000'000, 500'000'000},
                                                            {120'000'000, 500'000'000},
                                                            {120'000'000, 520'000'000},
                                                            {110'000'000, 520'000'000}}}});

TEST(ClippedChanges, WaysAndMultipolygonsStayWhole) {
  const TempFolder folder;
  const std::string base = folder.write(
      "base.osm",
      osm(node(-3, 1, 11.5) + node(1, 1, 11.1) + node(2, 1, 12.1) + node(3, 1, 12.2) + node(4, 1, 12.3) +
          node(5, 1, 12.4) + node(6, 1, 10) + plain_way(1, {1, 2}) + plain_way(2, {2, 3}) + plain_way(3, {4, 5, 4}) +
          plain_way(4, {6, 2}) + relation(1, "multipolygon", {{"way", 1}, {"way", 3}, {"node", 6}}) +
          relation(2, "route", {{"way", 1}, {"way", 2}}) + relation(3, "multipolygon", {{"way", 2}}) +
          relation(4, "site", {{"relation", 2}}) + relation(5, "site", {{"node", 2}})));
  apply_changes(base, {}, folder.path("out.osm.pbf"), &kEleven);
  // Node 2 completes a way, which brings neither way 2 nor relation 5 along.
  EXPECT_EQ(ids(folder.path("out.osm.pbf")), "n-3 n1 n2 n4 n5 n6 w1 w3 r1 r2 r4 ");
  // Once more: the same bytes.
  apply_changes(folder.path("out.osm.pbf"), {}, folder.path("again.osm.pbf"), &kEleven);
  EXPECT_EQ(read_bytes(folder.path("out.osm.pbf")), read_bytes(folder.path("again.osm.pbf")));
  // Not sorted, and ids that nobody gives.
  const std::string odd = folder.write(
      "odd.osm", osm(plain_way(1, {1, 2}) + node(2, 1, 12.1) + node(1, 1, 11.1) +
                     "<way id=\"2\" version=\"1\"><nd ref=\"1\"/><nd ref=\"9000000000000000000\"/></way>"));
  apply_changes(odd, {}, folder.path("odd.osm.pbf"), &kEleven);
  EXPECT_EQ(ids(folder.path("odd.osm.pbf")), "n1 n2 w1 w2 ");
}

TEST(ClippedChanges, WhatLeavesAndEnters) {
  const TempFolder folder;
  const std::string base =
      folder.write("base.osm", osm(node(1, 1, 11.1) + node(2, 1, 11.2) + node(3, 1, 12.5) + plain_way(1, {1, 2})));
  apply_changes(base, {}, folder.path("0.osm.pbf"), &kEleven);
  EXPECT_EQ(ids(folder.path("0.osm.pbf")), "n1 n2 w1 ");
  const std::string change =
      folder.write("1.osc", changes("<modify>" + node(1, 2, 13) + node(2, 2, 13) + node(3, 2, 12.6) +
                                    "</modify><create>" + node(4, 1, 11.4) + node(5, 1, 14) + plain_way(2, {4, 3}) +
                                    plain_way(3, {5}) + "</create><delete>" + node(8, 2, 13) + "</delete>"));
  const AppliedChanges applied =
      apply_changes(folder.path("0.osm.pbf"), std::vector{change}, folder.path("1.osm.pbf"), &kEleven);
  // Way 1 left, with its nodes. Way 2 brought node 3 along. What was never here is not noted as deleted.
  // Nodes 1 and 2 are noted as gone.
  EXPECT_EQ(ids(folder.path("1.osm.pbf")), "-n1 -n2 n3 n4 w2 ");
  EXPECT_EQ(applied.created, 3u) << "nodes 3 and 4, way 2";
  EXPECT_EQ(applied.deleted, 2u);
  EXPECT_EQ(applied.outside, 3u) << "nodes 5 and 8, way 3";
  // An older change that comes late brings them not back; a newer one, still outside, is nothing new.
  const std::string old = folder.write("old.osc", changes("<modify>" + node(1, 1, 11.1) + "</modify>")),
                    on = folder.write("on.osc", changes("<modify>" + node(1, 3, 14) + "</modify>"));
  EXPECT_FALSE(apply_changes(folder.path("1.osm.pbf"), std::vector{old}, folder.path("1b.osm.pbf"), &kEleven).any());
  EXPECT_EQ(ids(folder.path("1b.osm.pbf")), "-n1 -n2 n3 n4 w2 ");
  EXPECT_FALSE(apply_changes(folder.path("1.osm.pbf"), std::vector{on}, folder.path("1c.osm.pbf"), &kEleven).any());
  // Without node 3 in the change the way lacks it, until a full extract comes.
  const std::string late =
      folder.write("late.osc", changes("<create>" + node(4, 1, 11.4) + plain_way(2, {4, 3}) + "</create>"));
  apply_changes(folder.path("0.osm.pbf"), std::vector{late}, folder.path("2.osm.pbf"), &kEleven);
  EXPECT_EQ(ids(folder.path("2.osm.pbf")), "n1 n2 n4 w1 w2 ");
  const std::string gone =
      folder.write("3.osc", changes("<delete>" + plain_way(2, {}, 2) + node(4, 2, 11.4) + "</delete>"));
  const AppliedChanges deleted =
      apply_changes(folder.path("2.osm.pbf"), std::vector{gone}, folder.path("3.osm.pbf"), &kEleven);
  EXPECT_EQ(deleted.deleted, 2u);
  EXPECT_EQ(ids(folder.path("3.osm.pbf")), "n1 n2 -n4 w1 -w2 ");
}

}  // namespace
}  // namespace blockrand::importers::osm
