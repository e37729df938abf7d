#include "styles/classify/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/classify/changed_configs.h"

namespace blockrand::classify {
namespace {

using model::Morphology;
using model::StyleClass;
using testing::HasSubstr;

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs";

TEST(Catalogue, HoldsEveryStyleOfTheReference) {
  const Catalogue catalogue = read_catalogue(kConfigs);
  // docs/style_measures.md 1.1, with detached_*, pb_* and office spelled out.
  for (const char* id : {"burgher_gable",
                         "burgher_eaves",
                         "halftimber",
                         "baroque_palais",
                         "gz_early",
                         "gz_high",
                         "gz_late",
                         "gz_jugendstil",
                         "gz_mk_front",
                         "gz_mk_side",
                         "gz_mk_rear",
                         "gz_mk_works",
                         "gz_leipzig",
                         "gz_dresden_cube",
                         "gz_munich",
                         "gz_vienna",
                         "gz_prague",
                         "gz_hamburg_slit",
                         "gz_hamburg_burg",
                         "gz_terrace_rear",
                         "workers_tenement",
                         "workers_colony",
                         "villa",
                         "reform_block",
                         "zeilenbau",
                         "gemeindebau",
                         "garden_terrace",
                         "heimatstil",
                         "postwar_block",
                         "postwar_row",
                         "stalinist",
                         "estate_west",
                         "pb_q3a",
                         "pb_qp",
                         "pb_p2",
                         "pb_wbs70",
                         "pb_tower",
                         "infill_8090",
                         "contemporary",
                         "detached_pre1918",
                         "detached_1919_48",
                         "detached_1949_68",
                         "detached_1969_94",
                         "detached_1995",
                         "semi",
                         "row_house",
                         "farm",
                         "ind_old",
                         "shed_modern",
                         "office_kontorhaus",
                         "office_grid",
                         "office_curtain",
                         "public",
                         "ancillary"})
    EXPECT_TRUE(catalogue.find(id)) << id;
  EXPECT_EQ(catalogue.size(), 54u);
}

TEST(Catalogue, OrderIsAlphabeticalAndFindable) {
  const Catalogue catalogue = read_catalogue(kConfigs);
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(catalogue[i - 1].id, catalogue[i].id);
    }
    EXPECT_EQ(catalogue.index(catalogue[i].id), i);
    EXPECT_EQ(catalogue.find(catalogue[i].id), &catalogue[i]);
  }
  EXPECT_FALSE(catalogue.find("gz"));
  EXPECT_FALSE(catalogue.index(""));
  EXPECT_FALSE(catalogue.find("zzz"));
}

TEST(Catalogue, EveryStyleHasOneClassAndClassesFollowTheirDefinition) {
  const Catalogue catalogue = read_catalogue(kConfigs);
  std::size_t sum = 0;
  for (int c = 0; c < model::kStyleClassCount; ++c) sum += catalogue.of_class(static_cast<StyleClass>(c)).size();
  EXPECT_EQ(sum, catalogue.size());
  for (const Style& s : catalogue.styles()) {
    if (s.style_class == StyleClass::gruenderzeit) {
      EXPECT_EQ(s.position, StylePosition::front) << s.id << ": a street-side house";
      EXPECT_GE(s.years.from, 1840) << s.id;
      EXPECT_LE(s.years.middle(), 1918) << s.id;
    }
    if (s.style_class == StyleClass::modern) {
      EXPECT_GE(s.years.middle(), 1919) << s.id;
    }
    if (s.style_class == StyleClass::tenement) {
      EXPECT_GE(s.years.from, 1840) << s.id;
      EXPECT_LE(s.years.middle(), 1918) << s.id;
    }
    // Wings and rear buildings are never the composed front.
    if (s.position == StylePosition::wing || s.position == StylePosition::rear) {
      EXPECT_EQ(s.style_class, StyleClass::tenement) << s.id;
    }
  }
  EXPECT_EQ(catalogue.find("gz_mk_front")->style_class, StyleClass::gruenderzeit);
  EXPECT_EQ(catalogue.find("villa")->style_class, StyleClass::gruenderzeit);
  EXPECT_EQ(catalogue.find("gz_mk_works")->style_class, StyleClass::tenement);
  EXPECT_EQ(catalogue.find("reform_block")->style_class, StyleClass::modern);
  EXPECT_EQ(catalogue.find("burgher_eaves")->style_class, StyleClass::other);
  EXPECT_EQ(catalogue.find("ancillary")->style_class, StyleClass::other);
}

TEST(Catalogue, NumbersAreThoseOfTheReference) {
  const Catalogue catalogue = read_catalogue(kConfigs);
  const Style& mk = *catalogue.find("gz_mk_front");
  EXPECT_EQ(mk.storeys.typ, 5);
  EXPECT_EQ(mk.eaves->typ, 20.5);
  EXPECT_EQ(mk.double_saltbox, 0.5);
  EXPECT_EQ(mk.roof[static_cast<std::size_t>(RoofFamily::mansard)], 0.25);
  EXPECT_TRUE(mk.occurs_in(Morphology::perimeter_block));
  EXPECT_FALSE(mk.occurs_in(Morphology::terrace));
  EXPECT_EQ(mk.wall_colours.front(), (model::Colour{0xdf, 0xce, 0xa1}));
  EXPECT_EQ(catalogue.find("pb_wbs70")->storey_height, 2.8);
  EXPECT_TRUE(catalogue.find("farm")->occurs_in(Morphology::slab)) << "no morphology named: anywhere";
  for (const Style& s : catalogue.styles()) {
    double sum = 0;
    for (const double share : s.roof) sum += share;
    EXPECT_NEAR(sum, 1, 1e-3) << s.id;
    EXPECT_THAT(s.note, HasSubstr("s1.1")) << s.id << ": the note says where it comes from";
    if (s.roof_pitch) {
      EXPECT_LE(s.roof_pitch->max, 65) << s.id;
    }
  }
}

std::string complaint(const std::string& from, const std::string& to) {
  return test::complaint("styles/catalogue.toml", from, to, [](const std::string& dir) { read_catalogue(dir); });
}

TEST(Catalogue, RefusesWhatDoesNotFitAndSaysWhere) {
  EXPECT_EQ(complaint("pal_brick", "pal_brick"), "");
  EXPECT_THAT(complaint("class = \"other\"", "class = \"baroque\""),
              HasSubstr("gruenderzeit, tenement, modern, other"));
  EXPECT_THAT(complaint("class = \"other\"", "class = \"baroque\""), HasSubstr("catalogue.toml:"));
  EXPECT_THAT(complaint("position = \"any\"", "position = \"side\""), HasSubstr("front, wing, rear, any"));
  EXPECT_THAT(complaint("morphologies = [\"old_town\"]", "morphologies = [\"old_twon\"]"), HasSubstr("old_twon"));
  EXPECT_THAT(complaint("morphologies = [\"old_town\"]", "morphologies = [\"old_town\", \"old_town\"]"),
              HasSubstr("twice"));
  EXPECT_THAT(complaint("years = [1650, 1790]", "years = [1790, 1650]"), HasSubstr("years"));
  EXPECT_THAT(complaint("years = [1650, 1790]", "years = [1650]"), HasSubstr("years"));
  EXPECT_THAT(complaint("years = [1650, 1790]\n", ""), HasSubstr("years"));
  EXPECT_THAT(complaint("storeys = [2, 3, 4]", "storeys = [4, 3, 2]"), HasSubstr("order"));
  EXPECT_THAT(complaint("storeys = [2, 3, 4]", "storeys = [2, 3]"), HasSubstr("three numbers"));
  EXPECT_THAT(complaint("storeys = [2, 3, 4]", "storeys = [2, 3, 400]"), HasSubstr("out of range"));
  EXPECT_THAT(complaint("eaves = [10, 13, 18]", "eaves = [10, 16, 18]"), HasSubstr("12.9 m"));
  EXPECT_THAT(complaint("roof = { flat = 0.7, gabled = 0.3 }", "roof = { flat = 0.7, gabled = 0.2 }"),
              HasSubstr("sum to 1"));
  EXPECT_THAT(complaint("roof = { flat = 0.7, gabled = 0.3 }", "roof = { flat = 0.7, gable = 0.3 }"),
              HasSubstr("gabled"));
  EXPECT_THAT(complaint("double_saltbox = 0.1", "double_saltbox = 0.3"), HasSubstr("double_saltbox"));
  EXPECT_THAT(complaint("\"pal_renaissance_core\"", "\"pal_renaissance\""),
              HasSubstr("neither a palette nor a colour"));
  EXPECT_THAT(complaint("\"#dfcea1\"", "\"#dfcea\""), HasSubstr("neither a palette nor a colour"));
  EXPECT_THAT(complaint("wall_material = \"wood\"", "wall_material = \"woood\""), HasSubstr("Did you mean `wood`?"));
  EXPECT_THAT(complaint("plinth = 1\n", "plinht = 1\n"), HasSubstr("plinth"));
  EXPECT_THAT(complaint("plinth = 1\n", "plinth = 1\nheight = 3\n"), HasSubstr("height"));
}

}  // namespace
}  // namespace blockrand::classify
