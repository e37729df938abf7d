// Formats, orders, versions and every way in which a file can be unreadable.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <protozero/pbf_writer.hpp>

#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm::test {
namespace {

namespace fs = std::filesystem;
using model::IssueCode;
using ::testing::AllOf;
using ::testing::HasSubstr;
const TagList kHouse = {{"building", "yes"}};

/// A bit of everything.
OsmText town() {
  OsmText t;
  t.square(1, 10, 0, 0, 10, {{"building", "yes"}, {"name", "Straße & <Söhne>"}, {"height", "12 m"}})
      .square(2, 20, 2, 2, 3)
      .relation(1, {"w1 outer", "w2 inner"}, {{"type", "multipolygon"}})
      .square(3, 30, 20, 0, 10, {{"building", "house"}, {"building:levels", "many"}})
      .square(4, 40, 20, 2, 3, {{"building:part", "yes"}, {"roof:shape", "gabled"}})
      .relation(2, {"w3 outline", "w4 part"}, {{"type", "building"}, {"building", "house"}})
      .way(5, {10, 20, 30}, {{"highway", "residential"}, {"name", "Hauptstraße"}})
      .node(90, 13.002, 52.001, {{"natural", "tree"}})
      .node(91, 13.002, 52.002, {{"building", "yes"}, {"addr:housenumber", "7"}})
      .square(6, 60, 40, 0, 10)
      .relation(3, {"w6 outer", "w99 outer"}, {{"type", "multipolygon"}, {"landuse", "residential"}})
      .way(7, {60, 61, 62}, kHouse);
  return t;
}

std::string error_of(const std::string& path) {
  try {
    (void)read_extract(path);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(OsmFiles, TheOrderOfTheObjectsDoesNotMatter) {
  const TempFolder folder;
  const std::string expected = dump(read_extract(folder.write("sorted.osm", town().xml())));
  for (unsigned seed = 1; seed <= 8; ++seed)
    EXPECT_EQ(dump(read_extract(folder.write("mixed.osm", town().shuffled_xml(seed)))), expected) << seed;
}

TEST(OsmFiles, EveryFormatGivesTheSame) {
  const TempFolder folder;
  const std::string xml = folder.write("town.osm", town().xml());
  const std::string expected = dump(read_extract(xml));
  for (const char* name : {"town.osm.gz", "town.osm.bz2", "town.osm.pbf", "town.pbf", "TOWN.OSM.PBF"}) {
    const std::string copy = folder.path(name);
    if (std::string(name) == "TOWN.OSM.PBF")
      fs::copy_file(folder.path("town.pbf"), copy);
    else
      convert(xml, copy);
    EXPECT_EQ(dump(read_extract(copy)), expected) << name;
  }
}

TEST(OsmFiles, Bzip2InSeveralStreams) {
  const TempFolder folder;
  const std::string xml = town().xml();
  const std::string expected = dump(read_extract(folder.write("town.osm", xml)));
  for (const std::size_t tail : {std::size_t{7}, std::size_t{300}, xml.size() / 2}) {
    const std::size_t cut = xml.size() - tail;
    EXPECT_EQ(dump(read_extract(folder.write("town.osm.bz2", bzip2(xml.substr(0, cut)) + bzip2(xml.substr(cut))))),
              expected)
        << tail;
  }
}

TEST(OsmFiles, TwoReadingsGiveTheSame) {
  const TempFolder folder;
  const std::string path = folder.write("town.osm", town().shuffled_xml(3));
  EXPECT_EQ(dump(read_extract(path)), dump(read_extract(path)));
}

TEST(OsmFiles, AnExtractWithoutBuildingsIsValid) {
  EXPECT_TRUE(OsmText().read().buildings.empty());
  EXPECT_EQ(OsmText().read().data_time, "");
  EXPECT_EQ(OsmText().way(1, {1, 2}, {{"highway", "path"}}).read().counts.missing_nodes, 2u);
}

TEST(OsmFiles, NewObjectsOfEditorsHaveNegativeIds) {
  const auto e = OsmText().square(-5, -20, 0, 0, 10, kHouse).square(-9, -40, 20, 0, 10, kHouse).read();
  EXPECT_EQ(state(e, "w-5"), "pending");
  EXPECT_EQ(e.buildings.front().id.text(), "w-9");
}

TEST(OsmFiles, DeletedObjectsAreSkipped) {
  const auto e =
      OsmText()
          .square(1, 10, 0, 0, 10, kHouse)
          .corners(20, 20, 0, 10)
          .raw(
              "<way id=\"2\" action=\"delete\" version=\"1\"><nd ref=\"20\"/><nd ref=\"21\"/><nd ref=\"22\"/>"
              "<nd ref=\"20\"/><tag k=\"building\" v=\"yes\"/></way>\n")
          .raw(
              "<way id='3' visible='false' version='1'><nd ref='20'/><nd ref='21'/><nd ref='22'/>"
              "<nd ref='20'/><tag k='building' v='yes'/></way>\n")
          .raw(
              "<way id='4' action='modify' version='1'><nd ref='20'/><nd ref='21'/><nd ref='22'/>"
              "<nd ref='20'/><tag k='building' v='yes'/></way>\n")
          .raw("<node id='30' action='delete' lon='13' lat='52'/>")
          .way(5, {20, 21, 23, 30, 20}, kHouse)
          .read();
  EXPECT_EQ(state(e, "w2"), "absent");
  EXPECT_EQ(state(e, "w3"), "absent");
  EXPECT_EQ(state(e, "w4"), "pending");
  EXPECT_EQ(rows(e, "w5", IssueCode::members_missing), "1 of 4 nodes are not known");
  EXPECT_EQ(e.counts.ways, 3u);
}

TEST(OsmFiles, OfSeveralVersionsTheHighestCounts) {
  const std::string old_way =
      "<way id='1' version='1'><nd ref='10'/><nd ref='11'/><nd ref='12'/><nd ref='10'/><tag k='building' "
      "v='yes'/><tag k='name' v='old'/></way>";
  const std::string new_way =
      "<way id='1' version='2'><nd ref='10'/><nd ref='11'/><nd ref='12'/><nd ref='13'/><nd ref='10'/><tag "
      "k='building' v='yes'/><tag k='name' v='new'/></way>";
  const std::string plain_way = "<way id='1' version='3'><nd ref='10'/><nd ref='11'/></way>";
  const std::string gone_way = "<way id='1' version='3' visible='false'/>";
  const std::string moved_node = "<node id='10' version='2' lon='12.9' lat='52'/>";
  for (const bool reversed : {false, true}) {
    OsmText t;
    t.corners(10, 0, 0, 10);
    if (reversed)
      t.raw(new_way).raw(old_way).raw(moved_node);
    else
      t.raw(moved_node).raw(old_way).raw(new_way);
    const auto e = t.read();
    ASSERT_EQ(e.buildings.size(), 1u);
    EXPECT_EQ(e.tag(e.buildings[0].tags, "name"), "new");
    EXPECT_EQ(e.vertices_of(e.rings_of(e.buildings[0].rings)[0])[0].lon, 129000000);
  }
  for (const std::string& last : {plain_way, gone_way}) {
    EXPECT_TRUE(OsmText().corners(10, 0, 0, 10).raw(old_way).raw(last).read().buildings.empty());
    EXPECT_TRUE(OsmText().corners(10, 0, 0, 10).raw(last).raw(old_way).read().buildings.empty());
  }
}

TEST(OsmFiles, EqualVersionsAreDecidedByContent) {
  const std::string a =
      "<way id='1' version='1'><nd ref='10'/><nd ref='11'/><nd ref='12'/><nd ref='10'/><tag k='building' v='a'/></way>";
  const std::string b =
      "<way id='1' version='1'><nd ref='10'/><nd ref='11'/><nd ref='12'/><nd ref='10'/><tag k='building' v='b'/></way>";
  EXPECT_EQ(dump(OsmText().corners(10, 0, 0, 10).raw(a).raw(b).read()).substr(0, 200),
            dump(OsmText().corners(10, 0, 0, 10).raw(b).raw(a).read()).substr(0, 200));
}

TEST(OsmFiles, CoordinatesAtTheAntimeridian) {
  const auto e = OsmText()
                     .node(1, 180, 52)
                     .node(2, -180, 52.001)
                     .node(3, 179.999, 52.001)
                     .node(4, 179.999, -90)
                     .way(1, {1, 2, 3, 1}, kHouse)
                     .way(2, {1, 4, 3, 1}, kHouse)
                     .read();
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(state(e, "w2"), "pending");
  EXPECT_EQ(e.vertices_of(e.rings_of(building(e, "w1")->rings)[0])[0].lon, 1800000000);
}

TEST(OsmFiles, ARingOf20000Points) {
  OsmText t;
  std::vector<std::int64_t> refs;
  for (int i = 0; i < 20000; ++i) {
    // Up a staircase and back below it.
    const double x = i < 10000 ? i : 19999 - i, y = i < 10000 ? i + 10 + i % 2 : 19999 - i;
    t.node(i + 1, 13 + x * 1e-6, 52 + y * 1e-6);
    refs.push_back(i + 1);
  }
  refs.push_back(1);
  t.way(1, refs, kHouse).way(2, refs).relation(1, {"w2 outer"}, {{"type", "multipolygon"}, {"building:part", "yes"}});
  const auto e = t.read();
  EXPECT_EQ(ring_sizes(e, building(e, "w1")->rings), (std::vector<int>{20000}));
  EXPECT_EQ(ring_sizes(e, building(e, "r1")->rings), (std::vector<int>{20000}));
}

TEST(UnreadableFiles, MissingDirectoryEmptyUnknown) {
  const TempFolder folder;
  EXPECT_THAT(error_of(folder.path("none.osm")), AllOf(HasSubstr("none.osm"), HasSubstr("no such file")));
  fs::create_directory(folder.path("dir.osm.pbf"));
  EXPECT_THAT(error_of(folder.path("dir.osm.pbf")), HasSubstr("directory"));
  for (const char* name : {"a.osm", "a.osm.gz", "a.osm.bz2", "a.osm.pbf"})
    EXPECT_THAT(error_of(folder.write(name, "")), HasSubstr("is empty")) << name;
  EXPECT_THAT(error_of(folder.write("a.shp", "x")), HasSubstr("Names end in"));
  EXPECT_THAT(error_of("http://localhost/x.osm"), HasSubstr("no such file"));
}

TEST(UnreadableFiles, ContentAgainstTheName) {
  const TempFolder folder;
  const std::string xml = folder.write("town.osm", town().xml());
  for (const char* name : {"town.osm.gz", "town.osm.bz2", "town.osm.pbf"}) convert(xml, folder.path(name));
  for (const char* content : {"town.osm", "town.osm.gz", "town.osm.bz2", "town.osm.pbf"})
    for (const char* name : {"x.osm", "x.osm.gz", "x.osm.bz2", "x.osm.pbf"}) {
      if (std::string(content).substr(4) == std::string(name).substr(1)) continue;
      EXPECT_THAT(error_of(folder.write(name, read_bytes(folder.path(content)))), HasSubstr("but the name says"))
          << content << " as " << name;
    }
  EXPECT_THAT(error_of(folder.write("x.osm", "hello")), HasSubstr("not XML"));
  EXPECT_THAT(error_of(folder.write("x.osm", "<html></html>")), HasSubstr("x.osm"));
  EXPECT_THAT(error_of(folder.write("x.osm", "<osm></osm>")), HasSubstr("version"));
}

TEST(UnreadableFiles, CutOffAnywhere) {
  const TempFolder folder;
  OsmText t;
  for (int i = 0; i < 300; ++i)
    t.square(i + 1, 1000 + 10 * i, 12 * i, i % 7, 10, {{"building", "yes"}, {"ref", std::to_string(i * i)}});
  const std::string xml = folder.write("t.osm", t.xml());
  for (const char* name : {"t.osm.gz", "t.osm.bz2", "t.osm.pbf"}) convert(xml, folder.path(name));
  for (const char* name : {"t.osm", "t.osm.gz", "t.osm.bz2", "t.osm.pbf"}) {
    const std::string whole = read_bytes(folder.path(name));
    ASSERT_NO_THROW((void)read_extract(folder.path(name)));
    // The last bytes one by one, then steps: the checksum of gzip, the end marker of bzip2, the length field of a blob.
    std::vector<std::size_t> cuts;
    for (std::size_t n = 1; n <= 12 && n < whole.size(); ++n) cuts.push_back(whole.size() - n);
    for (std::size_t n = 1; n < 40; ++n) cuts.push_back(whole.size() * n / 40);
    int unnoticed = 0;
    for (const std::size_t cut : cuts) {
      const std::string error = error_of(folder.write("cut-" + std::string(name), whole.substr(0, cut)));
      if (error == "no error") {
        ++unnoticed;
        // Only the line break after </osm> may go, or a cut exactly between two blobs, where the format has no mark.
        EXPECT_TRUE(cut + 1 == whole.size() && std::string(name) == "t.osm")
            << name << " cut at " << cut << " of " << whole.size();
      } else {
        EXPECT_THAT(error, HasSubstr("cut-")) << cut;
      }
    }
    EXPECT_LE(unnoticed, 1) << name;
  }
}

TEST(UnreadableFiles, DamagedAnywhereNeverCrashes) {
  const TempFolder folder;
  const std::string xml = folder.write("t.osm", town().xml());
  for (const char* name : {"t.osm.gz", "t.osm.bz2", "t.osm.pbf"}) convert(xml, folder.path(name));
  for (const char* name : {"t.osm", "t.osm.gz", "t.osm.bz2", "t.osm.pbf"}) {
    const std::string whole = read_bytes(folder.path(name));
    for (std::size_t i = 0; i < whole.size(); i += 1 + whole.size() / 150) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
      (void)error_of(folder.write("damaged-" + std::string(name), damaged));  // an error or a result, both are well
    }
  }
}

TEST(UnreadableFiles, RubbishAfterTheEnd) {
  const TempFolder folder;
  const std::string xml = folder.write("t.osm", town().xml());
  for (const char* name : {"t.osm.bz2", "t.osm.pbf"}) convert(xml, folder.path(name));
  for (const char* name : {"t.osm", "t.osm.bz2", "t.osm.pbf"})
    for (const std::string& rubbish : {std::string("rubbish and more"), std::string("xyz")})
      EXPECT_NE(error_of(folder.write("x-" + std::string(name), read_bytes(folder.path(name)) + rubbish)), "no error")
          << name << ' ' << rubbish;
  EXPECT_NE(error_of(folder.write("x-t.osm.pbf", read_bytes(folder.path("t.osm.pbf")) + std::string(8, '\0'))),
            "no error");
}

TEST(UnreadableFiles, ErrorsInXmlNameTheLine) {
  const TempFolder folder;
  EXPECT_THAT(error_of(folder.write("a.osm", "<osm version='0.6'>\n<node id='1'>\n</osm>")),
              HasSubstr("a.osm:line 3, column 2: XML parsing error: mismatched tag"));
  EXPECT_NE(error_of(folder.write("b.osm", OsmText().raw("<node id='1' lon='east' lat='52'/>").xml())), "no error");
  EXPECT_NE(
      error_of(folder.write("c.osm", OsmText().raw(std::string("<way id='1'><tag k='a' v='b\0c'/></way>", 37)).xml())),
      "no error");
}

/// A PBF file of one building whose strings are free, which no writer would produce: libosmium's own stops at a NUL.
std::string pbf_with(const std::vector<std::pair<std::string, std::string>>& tags) {
  std::string out;
  const auto blob = [&](const char* type, const std::string& block) {
    std::string body, header;
    protozero::pbf_writer(body).add_bytes(1, block);
    protozero::pbf_writer writer(header);
    writer.add_string(1, type);
    writer.add_int32(3, static_cast<std::int32_t>(body.size()));
    const auto n = static_cast<std::uint32_t>(header.size());
    for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(n >> shift & 0xff);
    out += header + body;
  };
  std::string header_block;
  protozero::pbf_writer(header_block).add_string(4, "OsmSchema-V0.6");
  blob("OSMHeader", header_block);
  std::string block;
  protozero::pbf_writer writer(block);
  {
    protozero::pbf_writer table(writer, 1);
    table.add_string(1, "");
    for (const auto& [k, v] : tags) {
      table.add_bytes(1, k);
      table.add_bytes(1, v);
    }
  }
  {
    protozero::pbf_writer group(writer, 2);
    for (int i = 0; i < 3; ++i) {
      protozero::pbf_writer node(group, 1);
      node.add_sint64(1, 10 + i);
      node.add_sint64(8, 520000000 + (i == 2 ? 1000 : 0));
      node.add_sint64(9, 130000000 + (i == 1 ? 1000 : 0));
    }
  }
  {
    protozero::pbf_writer group(writer, 2);
    protozero::pbf_writer way(group, 3);
    way.add_int64(1, 1);
    std::vector<std::uint32_t> keys, values;
    for (std::uint32_t i = 0; i < tags.size(); ++i) {
      keys.push_back(1 + 2 * i);
      values.push_back(2 + 2 * i);
    }
    way.add_packed_uint32(2, keys.begin(), keys.end());
    way.add_packed_uint32(3, values.begin(), values.end());
    const std::vector<std::int64_t> deltas{10, 1, 1, -2};
    way.add_packed_sint64(8, deltas.begin(), deltas.end());
  }
  blob("OSMData", block);
  return out;
}

TEST(DirtyText, ANulInATagIsReplacedAndReported) {
  const TempFolder folder;
  using namespace std::string_literals;
  const auto e =
      read_extract(folder.write("nul.osm.pbf", pbf_with({{"name", "a\0b"s}, {"building", "yes"}, {"height", "7"}})));
  ASSERT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(e.tag(building(e, "w1")->tags, "name"),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(building(e, "w1")->attributes.height, 7.0f);
  EXPECT_EQ(rows(e, "w1", IssueCode::text_cleaned),
            "name=a\xEF\xBF\xBD"
            "b");
}

TEST(DirtyText, NulAtTheEndInTheKeyAndNothingElse) {
  const TempFolder folder;
  using namespace std::string_literals;
  for (const auto& [k, v] : {std::pair{"na\0me"s, "x"s}, {"name"s, "x\0"s}, {"name"s, "\0"s}, {"\0"s, "x"s}}) {
    const auto e = read_extract(folder.write("nul.osm.pbf", pbf_with({{"building", "yes"}, {k, v}})));
    EXPECT_EQ(state(e, "w1"), "pending");
    EXPECT_NE(rows(e, "w1", IssueCode::text_cleaned), "-");
  }
}

TEST(DirtyText, MalformedUtf8AndControlCharactersAreReplacedAndReported) {
  const TempFolder folder;
  const auto e = read_extract(folder.write("dirty.osm.pbf", pbf_with({{"building",
                                                                       "Stra\xDF"
                                                                       "e"},
                                                                      {"name", "bell\x07"},
                                                                      {"note", "fine\n"}})));
  EXPECT_EQ(e.strings.view(building(e, "w1")->attributes.use),
            "Stra\xEF\xBF\xBD"
            "e");
  EXPECT_EQ(e.tag(building(e, "w1")->tags, "name"), "bell\xEF\xBF\xBD");
  EXPECT_EQ(rows(e, "w1", IssueCode::text_cleaned),
            "building=Stra\xEF\xBF\xBD"
            "e | name=bell\xEF\xBF\xBD");
}

TEST(DirtyText, CleanTextWithTheReplacementCharacterIsNotReported) {
  const auto e = OsmText().square(1, 10, 0, 0, 1, {{"building", "yes"}, {"name", "\xEF\xBF\xBD"}}).read();
  EXPECT_EQ(rows(e, "w1", IssueCode::text_cleaned), "-");
}

}  // namespace
}  // namespace blockrand::importers::osm::test
