#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <libxml/xpathInternals.h>

#include <set>

#include "pipeline/outputs/report/report_page.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs {
namespace {

using model::IssueCode;
using model::OsmId;
using model::OsmType;
using test::SampleRegion;
using testing::HasSubstr;
using testing::Not;

OsmId way(std::int64_t number) { return {OsmType::way, number}; }

/// The page as a tree: parsing it as XML is the well-formedness test.
class Page {
 public:
  explicit Page(const std::string& html) : text(html) {
    doc_ = xmlReadMemory(html.data(), static_cast<int>(html.size()), "report.html", nullptr,
                         XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE);
    if (doc_) context_ = xmlXPathNewContext(doc_);
    if (context_) {
      xmlXPathRegisterNs(context_, BAD_CAST "h", BAD_CAST "http://www.w3.org/1999/xhtml");
      xmlXPathRegisterNs(context_, BAD_CAST "s", BAD_CAST "http://www.w3.org/2000/svg");
    }
  }
  ~Page() {
    xmlXPathFreeContext(context_);
    xmlFreeDoc(doc_);
  }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  bool well_formed() const { return doc_ != nullptr; }
  std::vector<std::string> all(const std::string& xpath) const {
    std::vector<std::string> out;
    xmlXPathObject* found = xmlXPathEvalExpression(BAD_CAST xpath.c_str(), context_);
    for (int i = 0; found && found->nodesetval && i < found->nodesetval->nodeNr; ++i) {
      xmlChar* content = xmlNodeGetContent(found->nodesetval->nodeTab[i]);
      out.emplace_back(reinterpret_cast<const char*>(content));
      xmlFree(content);
    }
    xmlXPathFreeObject(found);
    return out;
  }
  std::size_t count(const std::string& xpath) const { return all(xpath).size(); }
  std::string one(const std::string& xpath) const {
    const auto found = all(xpath);
    EXPECT_EQ(found.size(), 1u) << xpath;
    return found.empty() ? "" : found[0];
  }
  const std::string text;

 private:
  xmlDoc* doc_ = nullptr;
  xmlXPathContext* context_ = nullptr;
};

ReportFacts some_facts() {
  ReportFacts f;
  f.name = "A & B <1>";
  f.program_version = "1.2.3";
  f.crs_code = "EPSG:25833";
  f.crs_name = "ETRS89 / UTM zone 33N";
  f.buildings_in = 8;
  f.parts_in = 2;
  f.models = 7;
  f.represented = 1;
  f.duplicates = 1;
  f.reported = 1;
  f.models_by_lod = {0, 1, 6};
  f.sources = {
      {"storeys", {{"tag", 1}, {"neighbours", 2}}}, {"height", {{"implied", 3}}}, {"new_thing", {{"oracle", 3}}}};
  f.roofs = {{"flat", 5}, {"gabled", 2}};
  f.files = {{"tileset.json", 10}, {"tiles/15/1/1.glb", 2000}, {"citygml/15_1_1.gml", 3000}};
  return f;
}

/// Corners of the first ring of a path with relative coordinates, as the page writes them.
std::vector<std::pair<long, long>> first_ring(const std::string& d) {
  std::vector<std::pair<long, long>> out;
  const char* p = d.c_str() + 1;
  long x = 0, y = 0;
  while (*p && *p != 'z') {
    if (*p == 'l') ++p;
    char* end = nullptr;
    x += std::strtol(p, &end, 10);
    p = end;
    y += std::strtol(p, &end, 10);
    p = end;
    out.emplace_back(x, y);
  }
  return out;
}

ReportBuilder zoo_page() {
  ReportBuilder page;
  page.add(report_tile(SampleRegion::zoo().region()));
  return page;
}

TEST(Report, TheZooAsPage) {
  const ReportBuilder page = zoo_page();
  EXPECT_EQ(page.buildings_built(), 6u);
  EXPECT_EQ(page.bodies(), 9u);
  const Page html(page.html(some_facts()));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.one("//h:h1"), "A & B <1>");
  // Halo buildings are not of this tile; every other one has its footprint and title, and a row with a link.
  EXPECT_EQ(html.count("//s:g[@class='footprints']//s:path"), 6u);
  EXPECT_EQ(html.count("//s:path[@id='w70']"), 0u);
  EXPECT_THAT(html.one("//s:path[@id='w12']/s:title"), HasSubstr("w12: "));
  EXPECT_EQ(html.one("//h:tr[@id='house-w12']//h:a/@href"), "https://www.openstreetmap.org/way/12");
  EXPECT_EQ(html.count("//h:tr[@id='house-w-7']//h:a"), 0u) << "an editor's new object has no page to link to";
  // A hole is a ring of its own.
  const std::string court = html.one("//s:path[@id='w40']/@d");
  EXPECT_EQ(std::count(court.begin(), court.end(), 'z'), 2);
}

TEST(Report, StylesAreCountedByWhatTheyRestOn) {
  SampleRegion sample;
  sample.region().buildings.reserve(5);
  const auto add = [&](std::int64_t id, model::StyleClass c, model::Era era, model::Source source) -> model::Building& {
    model::Building& b = sample.add_building(id, {{"building", "yes"}});
    sample.add_box(b, b.id(), 391000 + 20.0 * static_cast<double>(id), 5819000, 10, 10, 30, 9);
    b.style.style[static_cast<std::size_t>(c)] = 1;
    b.style.era[static_cast<std::size_t>(era)] = 1;
    b.attributes.style = {std::string(model::name(c)), source, 1, 0};
    b.attributes.era = {std::string(model::name(era)), source, 1, 0};
    return b;
  };
  add(1, model::StyleClass::gruenderzeit, model::Era::from1840, model::Source::geometry);
  add(2, model::StyleClass::gruenderzeit, model::Era::from1840, model::Source::tag);
  add(3, model::StyleClass::gruenderzeit, model::Era::from1919, model::Source::neighbours);
  add(4, model::StyleClass::other, model::Era::post1945, model::Source::geometry).style.non_house = true;
  add(5, model::StyleClass::modern, model::Era::post1945, model::Source::geometry).owned = false;
  ReportBuilder page;
  page.add(report_tile(sample.region()));
  const Page html(page.html(some_facts()));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.count("//h:section[@id='styles']"), 1u);
  EXPECT_EQ(html.count("//h:nav/h:a[@href='#styles']"), 1u);
  const std::string row = "//h:section[@id='styles']//h:table[1]//h:tr[h:td[1]=";
  EXPECT_EQ(html.one(row + "'Gr\u00fcnderzeit']/h:td[3]"), "3 75\u00a0%");
  EXPECT_EQ(html.one(row + "'Gr\u00fcnderzeit']//s:svg/@aria-label"), "tags 1 (33\u00a0%), evidence 2 (67\u00a0%)");
  EXPECT_EQ(html.one(row + "'Other']//s:svg/@aria-label"), "rule 1 (100\u00a0%)");
  EXPECT_EQ(html.one(row + "'Modern']/h:td[3]"), "0 0\u00a0%") << "of the halo";
  EXPECT_EQ(html.one("//h:section[@id='styles']//h:tr[h:td[1]='1840 to 1918']/h:td[3]"), "2 50\u00a0%");
  EXPECT_EQ(html.one("//h:section[@id='styles']//h:tr[h:td[1]='After 1945']//s:svg/@aria-label"),
            "evidence 1 (100\u00a0%)");
  EXPECT_THAT(html.one("//h:section[@id='styles']/h:ul"), HasSubstr("evidence 50\u00a0%"));
}

TEST(Report, HasNoSectionOnStylesWhereNothingWasClassified) {
  const Page html(zoo_page().html(some_facts()));
  EXPECT_EQ(html.count("//h:section[@id='styles']"), 0u);
  EXPECT_EQ(html.count("//h:nav/h:a[@href='#styles']"), 0u);
}

TEST(Report, FootprintsAreTheMapInDecimetres) {
  const Page html(zoo_page().html(some_facts()));
  ASSERT_TRUE(html.well_formed());
  // w40: 40 x 40 m, its south-west corner at (391000, 5819040); w-7: 10 x 8 m at (391000, 5819000). y points down.
  const auto court = first_ring(html.one("//s:path[@id='w40']/@d")),
             house = first_ring(html.one("//s:path[@id='w-7']/@d"));
  ASSERT_EQ(court.size(), 4u);
  ASSERT_EQ(house.size(), 4u);
  EXPECT_EQ(court[1], std::pair(court[0].first + 400, court[0].second));
  EXPECT_EQ(court[2], std::pair(court[0].first + 400, court[0].second - 400));
  EXPECT_EQ(house[2], std::pair(house[0].first + 100, house[0].second - 80));
  EXPECT_EQ(court[0], std::pair(house[0].first, house[0].second - 400));
}

TEST(Report, ClassesFollowTheBuilding) {
  SampleRegion sample;
  const auto add = [&](std::int64_t id, double storeys, model::Source source, model::RoofShape roof) {
    model::Building& b = sample.add_building(id, {});
    b.attributes.storeys = {storeys, source, 1, 0};
    sample.add_box(b, b.id(), 391000 + 20.0 * static_cast<double>(id), 5819000, 10, 8, 0, 6).built_roof = roof;
    b.outline = {b.parts[0].plan};
    return &b;
  };
  add(1, 1, model::Source::tag, model::RoofShape::flat);
  add(2, 6.4, model::Source::neighbours, model::RoofShape::gabled);
  add(3, 8, model::Source::default_, model::RoofShape::pyramidal);
  add(4, 40, model::Source::override_, model::RoofShape::onion);
  add(5, 4, model::Source::tag, model::RoofShape::flat)->parts.clear();
  ReportBuilder page;
  page.add(report_tile(sample.region()));
  ReportFacts facts = some_facts();
  const std::vector<model::ReportRow> rows{{way(1), IssueCode::spike_removed, ""},
                                           {way(2), IssueCode::spike_removed, ""},
                                           {way(2), IssueCode::roof_failed, "w2: gabled"}};
  facts.rows = rows;
  const Page html(page.html(facts));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.one("//s:path[@id='w1']/@class"), "a0 e0 s1 r1 q2 h2 k2 i1");
  EXPECT_EQ(html.one("//s:path[@id='w2']/@class"), "a0 e0 s6 r2 q8 h2 k2 i2");
  EXPECT_EQ(html.one("//s:path[@id='w3']/@class"), "a0 e0 s7 r3 q14 h2 k2 i0");
  EXPECT_EQ(html.one("//s:path[@id='w4']/@class"), "a0 e0 s8 r6 q1 h2 k2 i0");
  EXPECT_EQ(html.one("//s:path[@id='w5']/@class"), "a0 e0 s0 r0 q0 h0 k0 i3");
  EXPECT_THAT(html.one("//s:path[@id='w5']/s:title"), HasSubstr("not built"));
  // The legend counts every building once in each theme.
  for (const std::string theme : {"s", "r", "q", "h", "k", "i"}) {
    long sum = 0;
    for (const std::string& n : html.all("//h:ul[contains(@class,'of-" + theme + "')]/h:li/h:b")) sum += std::stol(n);
    EXPECT_EQ(sum, 5) << theme;
  }
  // What the id says already is not said again.
  EXPECT_EQ(html.one("//h:details[@id='code-ROOF_FAILED']//h:li"), "w2 map gabled");
}

TEST(Report, EveryRowIsListedAndLeadsToTheMap) {
  ReportFacts facts = some_facts();
  const std::vector<model::ReportRow> rows{{way(30), IssueCode::parts_incomplete, ""},
                                           {way(31), IssueCode::roof_failed, ""},
                                           {way(99), IssueCode::open_way, "ends 2 m apart"}};
  facts.rows = rows;
  facts.objects = {
      {way(30), model::ObjectKind::building, model::ObjectState::represented, IssueCode::none, way(31)},
      {way(99), model::ObjectKind::building, model::ObjectState::reported, IssueCode::open_way, {}},
      {way(100), model::ObjectKind::building, model::ObjectState::duplicate, IssueCode::none, way(12)},
      {{OsmType::node, 5}, model::ObjectKind::building, model::ObjectState::reported, IssueCode::node_only, {}}};
  const Page html(zoo_page().html(facts));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.one("//h:details[@id='code-OPEN_WAY']//h:li"), "w99 ends 2 m apart");
  EXPECT_EQ(html.one("//h:details[@id='code-NODE_ONLY']//h:a/@href"), "https://www.openstreetmap.org/node/5");
  // A part is found on the map through its building.
  EXPECT_EQ(html.one("//h:details[@id='code-ROOF_FAILED']//h:a[. = 'map']/@href"), "#at-w30");
  EXPECT_EQ(html.count("//s:circle[@id='at-w30']"), 1u);
  EXPECT_EQ(html.one("//h:details[@id='objects-represented']//h:li"), "w30 by w31");
  EXPECT_EQ(html.one("//h:details[@id='objects-duplicate']//h:li"), "w100 by w12");
  // No link into the page leads nowhere, and no id stands twice.
  std::set<std::string> ids;
  for (const std::string& id : html.all("//*/@id")) EXPECT_TRUE(ids.insert(id).second) << id;
  for (const std::string& href : html.all("//h:a[starts-with(@href, '#')]/@href"))
    EXPECT_TRUE(ids.contains(href.substr(1))) << href;
}

TEST(Report, LongListsAreCutAndSaySo) {
  std::vector<model::ReportRow> rows;
  for (int i = 0; i < 50; ++i) rows.push_back({way(1000 + i), IssueCode::spike_removed, ""});
  ReportFacts facts = some_facts();
  facts.rows = rows;
  ReportOptions options;
  options.listed_objects = 20;
  const Page html(zoo_page().html(facts, options));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.count("//h:details[@id='code-SPIKE_REMOVED']//h:li"), 20u);
  EXPECT_THAT(html.one("//h:details[@id='code-SPIKE_REMOVED']/h:p"), HasSubstr("20 of 50"));
  EXPECT_EQ(html.one("//h:details[@id='code-SPIKE_REMOVED']//h:span[@class='count']"), "50");
}

TEST(Report, HostileTextStaysText) {
  const std::string evil = "</title></svg><script>alert(1)</script>\"'&amp; \x01 ]]>";
  SampleRegion sample;
  model::Building& b = sample.add_building(1, {{"name", evil}});
  sample.add_box(b, b.id(), 391000, 5819000, 10, 8, 0, 6);
  b.outline = {b.parts[0].plan};
  ReportBuilder page;
  page.add(report_tile(sample.region()));
  ReportFacts facts = some_facts();
  facts.name = evil + "<b onload=\"x\">";
  facts.data_time = facts.height_reference = facts.crs_name = facts.crs_code = facts.program_version = evil;
  facts.pictures_note = evil;
  facts.pictures = {{"\x89PNG", 10, 10, evil}};
  facts.sources[evil] = {{evil, 3}};
  facts.roofs[evil] = 1;
  facts.files.push_back({evil, 1});
  const std::vector<model::ReportRow> rows{{way(1), IssueCode::value_unreadable, "height=" + evil}};
  facts.rows = rows;
  const Page html(page.html(facts));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.count("//h:script"), 2u) << "the page's own, and its houses";
  EXPECT_THAT(html.one("//h:script[@id='house-data']"), HasSubstr("\\u003cscript\\u003ealert(1)")) << "data, no markup";
  EXPECT_EQ(html.count("//*[@onload]"), 0u);
  EXPECT_THAT(html.text, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html.one("//s:path[@id='w1']/s:title"), HasSubstr("<script>alert(1)</script>")) << "escaped, not lost";
}

TEST(Report, LoadsNothing) {
  ReportFacts facts = some_facts();
  facts.pictures = {{"\x89PNG\r\n\x1a\n", 10, 10, "One"}, {"\xff\xfe", 10, 10, "Two"}, {"abc", 10, 10, "Three"}};
  const Page html(zoo_page().html(facts));
  ASSERT_TRUE(html.well_formed());
  for (const std::string& src : html.all("//*/@src")) EXPECT_THAT(src, testing::StartsWith("data:image/png;base64,"));
  EXPECT_THAT(html.all("//h:img/@src"),
              testing::ElementsAre(
                  "data:image/png;base64,iVBORw0KGgo=", "data:image/png;base64,//4=", "data:image/png;base64,YWJj"));
  for (const std::string& href : html.all("//h:link/@href")) EXPECT_EQ(href, "data:,");
  EXPECT_THAT(html.text, Not(HasSubstr("url(")));
  EXPECT_THAT(html.text, Not(HasSubstr("@import")));
}

TEST(Report, BarsShowShares) {
  const Page html(zoo_page().html(some_facts()));
  ASSERT_TRUE(html.well_formed());
  const std::string storeys = "//h:table[@class='sources']//h:tr[h:td[1] = 'Storeys']";
  EXPECT_EQ(html.one(storeys + "//s:rect[@class='b2']/@width"), "3333");
  EXPECT_EQ(html.one(storeys + "//s:rect[@class='b8']/@x"), "3333");
  EXPECT_EQ(html.one(storeys + "//s:rect[@class='b8']/@width"), "6667");
  EXPECT_THAT(html.one(storeys + "/h:td[3]"), HasSubstr("33"));
  EXPECT_EQ(html.count("//h:tr[h:td[1] = 'New thing']//s:rect[@class='b0']"), 1u)
      << "what no list knows is shown all the same";
}

TEST(Report, NothingBuiltIsAPageToo) {
  const Page html(ReportBuilder().html(ReportFacts()));
  ASSERT_TRUE(html.well_formed());
  EXPECT_THAT(html.text, HasSubstr("No building has a footprint."));
}

// ---- the map's budget

MapFootprints town(int count) { return report_tile(SampleRegion::settlement(count, false).region()).footprints; }

ReportTile town_tile(int count) { return {town(count), {}}; }

TEST(ReportMap, ManyFootprintsAreDrawnInGroups) {
  ReportBuilder page;
  page.add(town_tile(300));
  ReportOptions options;
  options.single_footprints = 100;
  const Page html(page.html(some_facts(), options));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.count("//s:g[@class='footprints']//s:path"), 1u) << "all alike";
  const std::string d = html.one("//s:g[@class='footprints']//s:path/@d");
  EXPECT_EQ(std::count(d.begin(), d.end(), 'z'), 300);
  EXPECT_THAT(html.text, HasSubstr("drawn in groups"));
}

TEST(ReportMap, DetailsThenFootprintsGoToStayWithinTheBudget) {
  ReportBuilder page;
  page.add(town_tile(2000));
  ReportOptions options;
  options.single_footprints = 0;
  std::size_t whole = 0;
  for (const std::size_t budget : {std::size_t{1'000'000}, std::size_t{36'000}, std::size_t{5'000}}) {
    options.map_bytes = budget;
    const Page html(page.html(some_facts(), options));
    ASSERT_TRUE(html.well_formed());
    std::size_t bytes = 0;
    for (const std::string& d : html.all("//s:g[@class='footprints']//s:path/@d")) bytes += d.size();
    EXPECT_LE(bytes, budget);
    EXPECT_GT(bytes, 300u);
    if (budget == 1'000'000) {
      EXPECT_THAT(html.text, Not(HasSubstr("are left out")));
      whole = bytes;
    } else if (budget == 36'000) {
      EXPECT_LT(bytes, whole);
      EXPECT_THAT(html.text, HasSubstr("are left out"));
    } else {
      EXPECT_THAT(html.text, HasSubstr("the map shows cells of"));
    }
  }
}

TEST(ReportMap, AStrayBuildingDoesNotShrinkTheRest) {
  SampleRegion sample = SampleRegion::settlement(400, false);
  model::Building& stray = sample.add_building(5000, {});
  sample.add_box(stray, stray.id(), 891000, 5819000, 10, 8, 0, 6);
  ReportBuilder page;
  page.add(report_tile(sample.region()));
  const Page html(page.html(some_facts()));
  ASSERT_TRUE(html.well_formed());
  EXPECT_LT(std::stol(html.one("//s:svg[@id='map-svg']/@data-metres")), 2000);
  EXPECT_THAT(html.text, HasSubstr("1 building lies far from the others"));
}

TEST(ReportMap, TilesAreMergedInOrder) {
  const SampleRegion zoo = SampleRegion::zoo();
  ReportBuilder two;
  two.add(town_tile(3));
  two.add(report_tile(zoo.region()));
  const Page html(two.html(some_facts()));
  ASSERT_TRUE(html.well_formed());
  EXPECT_EQ(html.count("//s:g[@class='footprints']//s:path"), 9u);
  EXPECT_THAT(html.one("//s:path[@id='w30']/s:title"), HasSubstr("St. Marien"));
  EXPECT_THAT(html.one("//s:path[@id='w-7']/s:title"), HasSubstr("Krokodil"));
}

}  // namespace
}  // namespace blockrand::outputs
