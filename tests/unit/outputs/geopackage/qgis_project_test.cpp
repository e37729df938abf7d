// The QGIS project as text: everything filled in, every style used, the same bytes in every archive.
#include "pipeline/outputs/geopackage/qgis_project.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>

#include "pipeline/outputs/geopackage/qgis_styles.h"
#include "pipeline/outputs/zip_file.h"

namespace blockrand::outputs {
namespace {

using testing::HasSubstr;
using testing::Not;

QgisProject berlin() {
  QgisProject project{"EPSG:25833", "ETRS89 / UTM zone 33N", {}, "data of <2024> & later"};
  project.extent.include(model::Point2{390000, 5818000});
  project.extent.include(model::Point2{390100, 5818200});
  return project;
}

TEST(QgisProject, IsFilledIn) {
  const std::string text = qgis_project(berlin());
  EXPECT_THAT(text, Not(HasSubstr("{{")));
  EXPECT_THAT(text, HasSubstr("<authid>EPSG:25833</authid><description>ETRS89 / UTM zone 33N</description>"));
  EXPECT_THAT(text, HasSubstr("<srid>25833</srid>"));
  // 5 % of the longer side and a metre around the buildings.
  EXPECT_THAT(text, HasSubstr("<xmin>389989</xmin><ymin>5817989</ymin><xmax>390111</xmax><ymax>5818211</ymax>"));
  EXPECT_THAT(text, HasSubstr("data of &lt;2024&gt; &amp; later"));
  xmlDoc* const document = xmlReadMemory(text.data(), static_cast<int>(text.size()), "project.qgs", nullptr,
                                         XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING);
  EXPECT_NE(document, nullptr);
  xmlFreeDoc(document);
}

TEST(QgisProject, WithoutBuildingsHasNoExtent) {
  EXPECT_THAT(qgis_project({"EPSG:25833", "", {}, ""}), HasSubstr("<extent></extent>"));
}

TEST(QgisProject, ShowsEveryStyle) {
  const std::string text = qgis_project(berlin());
  for (const QgisStyle& style : qgis_styles()) {
    const std::size_t first = style.qml.find("<renderer-v2"), last = style.qml.find("</renderer-v2>");
    ASSERT_LT(first, last);
    EXPECT_THAT(text, HasSubstr(style.qml.substr(first, last - first))) << style.layer << ": " << style.name;
  }
}

TEST(ZipFile, IsTheSameEveryTime) {
  const std::string text(100000, 'a'), zip = zip_file("a.txt", text);
  EXPECT_EQ(zip_file("a.txt", text), zip);
  EXPECT_LT(zip.size(), 400u);
  // Time 0 of 1980-01-01, in the file's header and in the directory.
  EXPECT_EQ(zip.substr(10, 4), std::string("\0\0\x21\0", 4));
  EXPECT_EQ(zip.substr(zip.find("PK\x01\x02") + 12, 4), std::string("\0\0\x21\0", 4));
}

}  // namespace
}  // namespace blockrand::outputs
