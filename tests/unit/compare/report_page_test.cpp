#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <libxml/xpathInternals.h>

#include <limits>

#include "pipeline/compare/heat_mesh.h"
#include "pipeline/compare/report_pictures.h"
#include "tests/unit/compare/report_sample.h"

namespace blockrand::compare {
namespace {

using test::sample;
using testing::HasSubstr;
using testing::Not;

/// The page as a tree: parsing it as XML is the well-formedness test.
class Page {
 public:
  explicit Page(const std::string& html) : text(html) {
    doc_ = xmlReadMemory(html.data(), static_cast<int>(html.size()), "compare.html", nullptr,
                         XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE);
    if (doc_) context_ = xmlXPathNewContext(doc_);
    if (context_) xmlXPathRegisterNs(context_, BAD_CAST "h", BAD_CAST "http://www.w3.org/1999/xhtml");
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
    xmlXPathObject* found = context_ ? xmlXPathEvalExpression(BAD_CAST xpath.c_str(), context_) : nullptr;
    for (int i = 0; found && found->nodesetval && i < found->nodesetval->nodeNr; ++i) {
      xmlChar* content = xmlNodeGetContent(found->nodesetval->nodeTab[i]);
      out.emplace_back(reinterpret_cast<const char*>(content));
      xmlFree(content);
    }
    if (found) xmlXPathFreeObject(found);
    return out;
  }
  std::size_t count(const std::string& xpath) const { return all(xpath).size(); }
  const std::string text;

 private:
  xmlDoc* doc_ = nullptr;
  xmlXPathContext* context_ = nullptr;
};

std::string html(const Comparison& c, int pictures = 200, int jobs = 1) {
  ReportOptions options;
  options.pictures = pictures;
  options.picture_width = 120;
  return comparison_html(c, {{"--align", "<none>"}}, test::sample_distances, options, jobs);
}

TEST(ComparePage, IsWellFormedAndLoadsNothing) {
  const Page page(html(sample()));
  ASSERT_TRUE(page.well_formed());
  EXPECT_EQ(page.count("//*[@src and not(starts-with(@src, 'data:'))]"), 0u);
  EXPECT_EQ(page.count("//h:link[not(starts-with(@href, 'data:'))]"), 0u);
  EXPECT_EQ(page.count("//h:script"), 1u) << "its own alone";
  EXPECT_THAT(page.text, Not(HasSubstr("@import")));
  EXPECT_THAT(page.text, Not(HasSubstr("url(")));
}

TEST(ComparePage, TextOfStrangersStaysText) {
  const Page page(html(sample()));
  EXPECT_THAT(page.text, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page.all("//h:section[@id='m1']/h:h3"), testing::ElementsAre(test::kNastyId));
  EXPECT_THAT(page.text, HasSubstr("survey/&lt;a&amp;b&gt;.gml"));
}

TEST(ComparePage, TellsEveryMeasureWithAndWithoutWhatIsLeftOut) {
  const Page page(html(sample()));
  EXPECT_EQ(page.count("//h:table[@class='measures']/h:tbody/h:tr[not(@class)]"), kMeasureCount);
  EXPECT_EQ(page.count("//h:ol/h:li[starts-with(@id, 'note-')]"), kMeasureCount);
  const auto cells = page.all("//h:table[@class='measures']//h:tr[starts-with(h:td, 'surface distance, RMS')]/h:td");
  ASSERT_EQ(cells.size(), 11u);
  EXPECT_EQ(cells[2], "1.71");
  EXPECT_EQ(cells[4], "20.0\u00a0%");
}

TEST(ComparePage, EveryLinkLeadsSomewhere) {
  const Page page(html(sample(25), 0));
  for (const std::string& target : page.all("//h:a[starts-with(@href, '#')]/@href"))
    EXPECT_EQ(page.count("//*[@id='" + target.substr(1) + "']"), 1u) << target;
  EXPECT_EQ(page.count("//h:table[@id='all']/h:tbody/h:tr"), 25u);
  EXPECT_EQ(page.count("//h:table[contains(@class, 'matches')]"), 3u) << "worst, best and all";
}

TEST(ComparePage, WorstFirstAndOnlyTheseHavePictures) {
  const Page page(html(sample(), 1));
  EXPECT_THAT(page.all("//h:section[starts-with(@class, 'match')]/@id"), testing::ElementsAre("m3", "m2", "m1"));
  EXPECT_EQ(page.count("//h:section[@id='m3']//h:img"), 4u);
  EXPECT_EQ(page.count("//h:section[@id='m2']//h:img"), 0u);
  EXPECT_EQ(page.count("//*[@class='plan']"), 3u) << "all have a plan";
}

TEST(ComparePage, DrawsFacadesWithWhatIsLeftOut) {
  const Page page(html(sample()));
  EXPECT_EQ(page.count("//h:section[@id='m1']//h:figure[starts-with(@class, 'elevation')]"), 2u);
  EXPECT_EQ(page.count("//h:section[@id='m1']//h:figure[@class='elevation out']"), 1u);
  EXPECT_THAT(page.text, HasSubstr("left out: blank"));
  EXPECT_THAT(page.text, HasSubstr("Facade to the south, 10.0\u00a0m wide. Openings 1 / 1, 1 matched"));
  EXPECT_THAT(page.text, HasSubstr("No facades to draw."));
  // A party wall with windows above the neighbour's roof counts.
  Comparison c = sample();
  c.matches[0].facades.reference[0].covered = c.matches[0].facades.reference[0].area;
  EXPECT_THAT(Page(html(c)).text, testing::Not(HasSubstr("left out: party wall")));
}

TEST(ComparePage, TheSameBytesWithAnyNumberOfThreads) { EXPECT_EQ(html(sample(9), 200, 1), html(sample(9), 200, 4)); }

TEST(ComparePage, SaysThatThereIsNothingToCompare) {
  const Page page(html(sample(0)));
  ASSERT_TRUE(page.well_formed());
  EXPECT_THAT(page.text, HasSubstr("there is nothing to measure"));
  EXPECT_TRUE(Page(html(Comparison{})).well_formed()) << "not even cities";
}

TEST(ComparePage, SurvivesWhatNoMeasureShouldGive) {
  Comparison c = sample();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t m = 0; m < kMeasureCount; ++m) test::set(c.matches[2], static_cast<Measure>(m), nan);
  c.matches[0].facades.reference[0].outline[0][0][0].x = nan;
  c.matches[0].facades.reference[0].openings[0].top = nan;
  c.reference.buildings[2].faces.clear();
  c.reference.buildings[2].footprint.clear();
  c.model.buildings[1].faces[1].rings.clear();
  test::sum_up(c);
  const Page page(html(c));
  EXPECT_TRUE(page.well_formed());
  EXPECT_THAT(page.text, Not(HasSubstr(">nan")));
  EXPECT_THAT(page.text, Not(HasSubstr(">-nan")));
}

TEST(ComparePictures, HeatIsColouredByDistanceAndLeftOutIsGrey) {
  const Comparison c = sample(1);
  ReportOptions options;
  options.picture_width = 120;
  const MatchPictures near = draw_pictures(
      c, c.matches[0], [](auto&, bool, auto points) { return std::vector<float>(points.size(), 0); }, options);
  const MatchPictures far = draw_pictures(
      c, c.matches[0], [](auto&, bool, auto points) { return std::vector<float>(points.size(), 9); }, options);
  EXPECT_EQ(near.reference, far.reference);
  EXPECT_NE(near.reference_heat, far.reference_heat);
  EXPECT_NE(near.model_heat, far.model_heat);
  EXPECT_EQ(near.reference.substr(1, 3), "PNG");
  EXPECT_EQ(heat_colour(-1), heat_colour(0));
  EXPECT_EQ(heat_colour(7), heat_colour(1));
}

TEST(HeatMesh, CutsToTheEdgeAndKeepsTheArea) {
  const std::vector<Triangle3> square{{{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}}, {{{0, 0, 0}, {10, 10, 0}, {0, 10, 0}}}};
  const HeatMesh mesh = cut_small(square, 0.7, 100000);
  double area = 0, longest = 0;
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
    area += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      longest = std::max(longest, std::hypot(p.x - q.x, p.y - q.y));
  }
  EXPECT_DOUBLE_EQ(area, 100);
  EXPECT_LE(longest, 0.7);
  EXPECT_LT(mesh.points.size(), mesh.triangles.size()) << "corners are shared";
  EXPECT_LT(cut_small(square, 0.01, 1000).triangles.size(), 4000u) << "bounded";
  const std::vector<Triangle3> needle{{Point3{0, 0, 0}, Point3{0.002, 0, 0}, Point3{0, 0, 9e5}}};
  EXPECT_LT(cut_small(needle, 0.7, 1000).triangles.size(), 4000u) << "bounded by length, not by area alone";
}

}  // namespace
}  // namespace blockrand::compare
