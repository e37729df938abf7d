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

}  // namespace
}  // namespace blockrand::importers::osm
