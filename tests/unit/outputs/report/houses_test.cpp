// Floor areas, the table of houses and buildings.csv.
#include "pipeline/outputs/report/houses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/outputs/report/report_page.h"
#include "pipeline/outputs/report/report_sections.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs {
namespace {

using model::Source;
using test::SampleRegion;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A box of 10 x 8 m with an outline.
model::Building& add_house(SampleRegion& sample, std::int64_t id, double storeys, Source source,
                           std::vector<std::pair<std::string, std::string>> tags = {}) {
  model::Building& b = sample.add_building(id, std::move(tags));
  model::BuildingPart& part = sample.add_box(b, b.id(), 391000 + 20.0 * static_cast<double>(id), 5819000, 10, 8, 0, 6);
  part.attributes.storeys = b.attributes.storeys = {storeys, source, 1, 0};
  part.attributes.roof_storeys = {0, source, 1, 0};
  b.outline = {part.plan};
  return b;
}

TEST(FloorAreas, PlanTimesStoreysRoofStoreysApart) {
  SampleRegion sample;
  model::Building& b = add_house(sample, 1, 4, Source::tag);
  b.parts[0].attributes.roof_storeys = {1, Source::tag, 1, 0};
  const MapBuilding m = report_tile(sample.region()).footprints.buildings.at(0);
  EXPECT_EQ(m.footprint, 8'000) << "hundredths of a square metre";
  EXPECT_EQ(m.floors, 32'000);
  EXPECT_EQ(m.roof_floors, 8'000);
  EXPECT_EQ(m.guessed, 0);
}

TEST(FloorAreas, InferredStoreysAreTold) {
  SampleRegion sample;
  add_house(sample, 1, 3, Source::neighbours);
  const MapBuilding m = report_tile(sample.region()).footprints.buildings.at(0);
  EXPECT_EQ(m.guessed, m.floors);
  EXPECT_EQ(m.floors, 24'000);
}

TEST(FloorAreas, APassageBelowHasNoFloorsAndACanopyNone) {
  SampleRegion sample;
  model::Building& bridge = add_house(sample, 1, 5, Source::tag);
  bridge.parts[0].attributes.min_height = {6, Source::implied, 1, 0};
  bridge.parts[0].mapped.min_storey = 2.0f;
  model::Building& canopy = add_house(sample, 2, 1, Source::tag);
  canopy.parts[0].canopy = true;
  const MapFootprints map = report_tile(sample.region()).footprints;
  EXPECT_EQ(map.buildings.at(0).floors, 24'000) << "three of five storeys stand above the passage";
  EXPECT_EQ(map.buildings.at(1).floors, 0);
  EXPECT_EQ(map.buildings.at(1).footprint, 0);
}

/// The section on floor areas alone.
std::string floor_areas_of(const std::string& html) {
  const std::size_t from = html.find("<section id=\"floor-areas\">");
  return html.substr(from, html.find("</section>", from) - from);
}

/// The section of houses that lie in two blocks, cut into tiles as `first` says how many belong to the first.
std::string page_of(std::size_t first) {
  std::array<SampleRegion, 2> tiles;
  for (std::int64_t id = 1; id <= 4; ++id) {
    model::Building& b =
        add_house(tiles[static_cast<std::size_t>(id) <= first ? 0 : 1], id, 1.3 * static_cast<double>(id), Source::tag);
    b.situation.block = id == 1 ? "w1.n1.l" : "w2.n2.r";
  }
  ReportBuilder page;
  for (SampleRegion& tile : tiles) page.add(report_tile(tile.region()));
  ReportFacts facts;
  facts.blocks = {{"w2.n2.r", "Arkonaplatz and <Allee>", 1000, true, 3, {}}, {"w1.n1.l", "", 500, true, 2, {}}};
  return floor_areas_of(page.html(facts));
}

TEST(FloorAreas, BlocksThatSpanTilesAreSummed) {
  const std::string page = page_of(4);
  // 80 m² times 2.6 + 3.9 + 5.2 storeys; 240 m² of 1,000 m².
  EXPECT_THAT(page, HasSubstr("<td>Arkonaplatz and &lt;Allee&gt;</td><td class=\"n\">3</td><td class=\"n\">240</td><td "
                              "class=\"n\">936</td><td class=\"n\">0</td><td class=\"n\">1,000</td><td "
                              "class=\"n\">0.24</td><td class=\"n\">0.94</td>"));
  // Of a block whose other buildings are elsewhere there is no ratio.
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">1</td><td class=\"n\">80</td><td class=\"n\">104</td><td "
                              "class=\"n\">0</td><td class=\"n\"></td><td class=\"n\"></td><td class=\"n\"></td>"));
  for (const std::size_t first : {0, 1, 2, 3}) EXPECT_TRUE(page_of(first) == page) << first;
}

TEST(Houses, StandInTheOrderOfTheirAddresses) {
  SampleRegion sample;
  const auto at = [&](std::int64_t id, std::string number) {
    add_house(sample, id, 2, Source::tag, {{"addr:street", "Allee"}, {"addr:housenumber", std::move(number)}});
  };
  at(1, "10");
  at(2, "9");
  at(3, "9a");
  add_house(sample, 4, 2, Source::tag);
  ReportBuilder page;
  page.add(report_tile(sample.region()));
  const std::string html = page.html({});
  std::size_t before = 0;
  for (const char* id : {"house-w2", "house-w3", "house-w1", "house-w4"}) {
    const std::size_t place = html.find("<tr id=\"" + std::string(id) + "\"");
    ASSERT_NE(place, html.npos) << id;
    EXPECT_GT(place, before) << id;
    before = place;
  }
  EXPECT_THAT(html, HasSubstr("[\"w2\",\"Allee 9\",\"\""));
}

TEST(BuildingsCsv, TextsAreQuotedAndRunNowhere) {
  SampleRegion sample;
  add_house(sample, 1, 2, Source::tag, {{"name", "=HYPERLINK(\"x\",\"y\")"}});
  add_house(sample, 2, 2.5, Source::tag, {{"name", "Zum \"Hirsch\", Saal"}});
  add_house(sample, 3, 2, Source::tag, {{"name", " +1"}}).parts.clear();
  const georef::GeoBox extent{13.3, 52.4, 13.5, 52.6};
  const georef::Projection projection(georef::open_crs("EPSG:25833", extent), extent);
  const std::string lines = csv_lines(sample.region(), report_tile(sample.region()), projection);
  EXPECT_THAT(lines, StartsWith("w1,https://www.openstreetmap.org/way/1,\"'=HYPERLINK(\"\"x\"\",\"\"y\"\")\","));
  EXPECT_THAT(lines, HasSubstr("\r\nw2,https://www.openstreetmap.org/way/2,\"Zum \"\"Hirsch\"\", Saal\","));
  EXPECT_THAT(lines, HasSubstr(",2.5,tag,"));
  EXPECT_THAT(lines, HasSubstr("\r\nw3,https://www.openstreetmap.org/way/3,' +1,"));
  const auto cells = [](std::string_view line) {
    std::size_t n = 1;
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      n += c == ',' && !quoted;
    }
    return n;
  };
  const std::size_t columns = cells(csv_head());
  std::size_t count = 0;
  for (std::size_t at = 0; at < lines.size(); ++count) {
    const std::size_t end = lines.find("\r\n", at);
    EXPECT_EQ(cells(std::string_view(lines).substr(at, end - at)), columns);
    at = end + 2;
  }
  EXPECT_EQ(count, 3u);
  EXPECT_THAT(csv_head(), StartsWith("\xef\xbb\xbfid,"));
}

TEST(Sources, WhatAnOptionGaveIsNotFromTheMap) {
  ReportFacts facts;
  facts.bodies = 4;
  facts.sources = {{"ground_height", {{"override", 3}, {"tag", 1}}}};
  const std::string html = ReportBuilder().html(facts);
  EXPECT_THAT(html, HasSubstr("<td class=\"n\">25\u00a0% <span class=\"soft small\">75\u00a0% given</span></td>"));
}

}  // namespace
}  // namespace blockrand::outputs
