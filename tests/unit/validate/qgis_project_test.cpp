// Each planted damage of a QGIS project and of its archive is found.
#include "pipeline/validate/qgis_project.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/outputs/geopackage/columns.h"
#include "pipeline/outputs/geopackage/qgis_project.h"
#include "pipeline/outputs/zip_file.h"

namespace blockrand::validate {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string& sound() {
  static const std::string text = outputs::qgis_project({"EPSG:25833", "ETRS89 / UTM zone 33N", {}, "about"});
  return text;
}

TableColumns tables() {
  TableColumns out;
  for (const auto& [table, columns] :
       {std::pair("buildings", outputs::building_columns()), std::pair("parts", outputs::part_columns()),
        std::pair("reported", outputs::reported_columns()), std::pair("tiles", outputs::tile_columns()),
        std::pair("surfaces", outputs::surface_columns()), std::pair("facade_edges", outputs::wall_segment_columns()),
        std::pair("blocks", outputs::block_columns()), std::pair("courtyards", outputs::courtyard_columns()),
        std::pair("cells", outputs::cell_columns())})
    for (const auto& column : columns) out[table].insert(column.name);
  return out;
}

std::vector<std::string> findings(const std::string& qgs) {
  FindingLog log;
  check_qgis_project(qgs, "buildings.qgz", "buildings.gpkg", tables(), "EPSG:25833", log);
  std::vector<std::string> out;
  for (const Finding& f : log.kept()) out.push_back(std::string(info(f.check).text) + " " + f.object + ": " + f.detail);
  return out;
}

TEST(ReadQgisProject, FindsNothingInASoundOne) {
  EXPECT_THAT(findings(sound()), IsEmpty());
  FindingLog log;
  EXPECT_GT(check_qgis_project(sound(), "a", "buildings.gpkg", tables(), "EPSG:25833", log), 15u);
}

struct Damage {
  std::string name, from, to, finding;
};
class PlantedInProject : public testing::TestWithParam<Damage> {};

TEST_P(PlantedInProject, IsFound) {
  std::string text = sound();
  const std::size_t at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, GetParam().from.size(), GetParam().to);
  EXPECT_THAT(findings(text), Contains(HasSubstr(GetParam().finding)));
}

INSTANTIATE_TEST_SUITE_P(
    Project, PlantedInProject,
    testing::Values(Damage{"no_xml", "</qgis>", "", "FILE_UNREADABLE : the project is no well-formed XML"},
                    Damage{"crs", "<projectCrs><spatialrefsys><srsid>1</srsid><srid>25833</srid><authid>EPSG:25833",
                           "<projectCrs><spatialrefsys><srsid>1</srsid><srid>25833</srid><authid>EPSG:4326",
                           "QGIS_PROJECT : its reference system is \"EPSG:4326\""},
                    Damage{"crs_of_a_layer", "<srs><spatialrefsys><srsid>1</srsid><srid>25833</srid><authid>EPSG:25833",
                           "<srs><spatialrefsys><srsid>1</srsid><srid>25833</srid><authid>EPSG:4326",
                           "reported_reasons: its reference system is"},
                    Damage{"absolute", "<datasource>./", "<datasource>/home/me/", "reads /home/me/buildings.gpkg"},
                    Damage{"table", "<datasource>./buildings.gpkg|layername=tiles",
                           "<datasource>./buildings.gpkg|layername=roads",
                           "tiles_outlines: buildings.gpkg has no layer roads"},
                    Damage{"column", "attr=\"storeys\"", "attr=\"floors\"",
                           "buildings_storeys: the layer buildings has no column \"floors\""},
                    Damage{"expression", "coalesce(&quot;style_confidence&quot;, -1)",
                           "coalesce(&quot;surely&quot;, -1)", "has no column \"surely\""},
                    Damage{"label", "fieldName=\"house_number\"", "fieldName=\"number\"", "has no column \"number\""},
                    Damage{"tip", "round(\"height\", 1)", "round(\"hight\", 1)", "has no column \"hight\""},
                    Damage{"display", "coalesce(\"address\", \"name\", \"id\")</previewExpression>",
                           "\"door\"</previewExpression>", "has no column \"door\""},
                    Damage{"lost_from_the_panel", "id=\"tiles_outlines\"", "id=\"tiles\"",
                           "tiles_outlines: the panel does not have the layer"},
                    Damage{"only_in_the_panel", "id=\"tiles_outlines\"", "id=\"tiles\"",
                           "tiles: the panel names a layer that does not exist"},
                    Damage{"twice", "<id>tiles_outlines</id>", "<id>blocks_closure</id>", "two layers have this id"}),
    [](const auto& param) { return param.param.name; });

TEST(ReadQgisProject, WithoutLayersOrStylesIsFound) {
  EXPECT_THAT(findings("<qgis/>"), Contains(HasSubstr("has no layers")));
  EXPECT_THAT(findings("<kml/>"), Contains(HasSubstr("is no QGIS project")));
  EXPECT_THAT(findings("<qgis><projectlayers><maplayer><id>a</id><datasource>./buildings.gpkg|layername=tiles"
                       "</datasource></maplayer></projectlayers></qgis>"),
              Contains(HasSubstr("a: has no style")));
}

TEST(ReadQgisProject, EntitiesAreRefused) {
  std::string text = "<!DOCTYPE qgis [<!ENTITY a0 \"aaaaaaaaaa\">";
  for (int i = 1; i < 30; ++i) {
    text += "<!ENTITY a" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) text += "&a" + std::to_string(i - 1) + ";";
    text += "\">";
  }
  EXPECT_THAT(findings(text + "]><qgis><projectlayers><maplayer><id>&a29;</id></maplayer></projectlayers></qgis>"),
              Contains(HasSubstr("FILE_UNREADABLE")));
  EXPECT_THAT(findings("<!DOCTYPE qgis [<!ENTITY a \"b\">]><qgis/>"), Contains(HasSubstr("declares entities")));
}

TEST(ReadQgisArchive, GivesTheProjectBack) {
  std::string why;
  EXPECT_EQ(qgs_of(outputs::zip_file("a.qgs", sound()), why), sound());
  EXPECT_EQ(why, "");
  EXPECT_FALSE(qgs_of(outputs::zip_file("a.txt", sound()), why));
  EXPECT_EQ(why, "holds no project");
  EXPECT_FALSE(qgs_of("PK", why));
  EXPECT_EQ(why, "is no ZIP archive");
}

TEST(ReadQgisArchive, NoByteIsChangedUnseen) {
  const std::string zip = outputs::zip_file("a.qgs", sound());
  std::size_t seen = 0;
  const std::size_t data = 30 + 5, directory = zip.find("PK\x01\x02");
  for (std::size_t i = data; i < directory; i += 97) {
    std::string damaged = zip;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    std::string why;
    EXPECT_FALSE(qgs_of(damaged, why)) << i;
    EXPECT_NE(why, "");
    ++seen;
  }
  EXPECT_GT(seen, 20u);
  for (std::size_t length = 0; length < zip.size(); length += 131) {
    std::string why;
    EXPECT_FALSE(qgs_of(std::string_view(zip).substr(0, length), why)) << length;
  }
}

TEST(ReadQgisArchive, ALieAboutTheSizeIsFound) {
  std::string zip = outputs::zip_file("a.qgs", sound()), why;
  const std::size_t directory = zip.find("PK\x01\x02");
  zip.replace(directory + 24, 4, std::string("\xff\xff\xff\x7f", 4));
  EXPECT_FALSE(qgs_of(zip, why));
  EXPECT_THAT(why, HasSubstr("2147483647 bytes"));
}

}  // namespace
}  // namespace blockrand::validate
