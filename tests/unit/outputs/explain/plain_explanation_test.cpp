#include "pipeline/outputs/explain/plain_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "pipeline/base/error.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/model/roof_shape.h"
#include "pipeline/outputs/explain/explained_tile.h"
#include "pipeline/outputs/explain/plain_reasons.h"
#include "pipeline/outputs/explain/plain_words.h"
#include "pipeline/outputs/gzip.h"

namespace blockrand::outputs {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

Json attribute(const char* name, const Json& value, const char* source, double confidence, const char* why) {
  return {{"name", name}, {"value", value}, {"source", source}, {"confidence", confidence}, {"why", why}};
}

/// A front house with six mapped storeys at a corner.
Json house() {
  Json j = Json::parse(R"({
    "id":"w27","tile":"15_1_2","state":"modelled","lod":3,"address":"Arkonaplatz 5, 10435 Berlin",
    "tags":{"addr:street":"Arkonaplatz","addr:housenumber":"5","building":"residential","building:levels":"6"},
    "stages":[{"stage":"context","text":"corner house; stands at a closed courtyard of 1650 m2; in block w46.n29.l"},
              {"stage":"facades","text":"rule file gruenderzeit.cga of preset gz_plain: 107 windows, 1 door"}],
    "repair":{"vertices":13,"moved":11,"max_shift":0.038,"shared_walls":3,"overlaps_resolved":0,"direction":66.5},
    "situation":{"position":"corner_house","setback":0.001,"block":"w46.n29.l","courtyards":["w27.y1_2"]},
    "edges":[{"id":"w27.e1_2","kind":"street","looks":"SE","front":true,"street":"w46","street_name":"Arkonaplatz",
              "points":[{"id":"n1","entrance":false,"house_number":"5"}]},
             {"id":"w27.e2_3","kind":"street","looks":"NE","street_name":"Lange Straße",
              "points":[{"id":"n2","entrance":true,"house_number":"12","street":"Lange Straße"}]},
             {"id":"w27.e3_4","kind":"party_wall","neighbour":"w28","looks":"W"}],
    "style":{"class":"gruenderzeit","probabilities":{"gruenderzeit":0.97,"tenement":0.01,"modern":0.02,"other":0},
             "substyle":"gz_mk_front","second":"modern",
             "terms":[{"feature":"position","meaning":"1 free","value":4,"weights":{"gruenderzeit":0.5,"modern":0}},
                      {"feature":"block_closure","meaning":"share","value":0.99,"weights":{"gruenderzeit":0.9,"modern":0}},
                      {"feature":"around_rear","meaning":"share","value":0.4,"weights":{"gruenderzeit":0.8,"modern":0}},
                      {"feature":"around_built","meaning":"share","value":0.6,"weights":{"gruenderzeit":0.7,"modern":0}},
                      {"feature":"corners","meaning":"corners","value":9,"weights":{"gruenderzeit":-0.9,"modern":0}}]},
    "bodies":[{"id":"w27","lod":3,"asked_roof":"berlin","built_roof":"berlin","fallbacks":[],
               "detail":{"windows":107,"doors":1,"passages":0,"elements":{"balcony":3},"installations":{"chimney":1}}}],
    "notes":[{"code":"SQUARED","class":"notice","meaning":"Corners."}],"files":[]})");
  j["attributes"] = {
      attribute("use", "residential", "tag", 0.95, "tagged"),
      attribute("storeys", 6, "tag", 0.95, "tagged"),
      attribute("storey_height", 3.62, "preset", 0.3, "usual for the style gz_mk_front"),
      attribute("height", 24.64, "implied", 0.6, "a plinth of 0.8 m, 6 storeys of 3.6 m and a roof of 2.0 m"),
      attribute("eaves_height", 20.9, "implied", 0.6, "height less that of the roof"),
      attribute("roof_shape", "berlin", "geometry", 0.38, "its plan, use and quarter, which alone say other"),
      attribute("era", "1840_1918", "geometry", 0.9, "plan"),
      attribute("substyle", "gz_mk_front", "preset", 0.62,
                "of the class gruenderzeit, where position, quarter, era, storeys and use fit best: front house of the "
                "Berlin Mietskaserne; s1.1, s2.3"),
      attribute("wall_material", "plaster", "preset", 0.1, "usual for the style gz_mk_front")};
  return j;
}

Json& value_of(Json& j, const char* name) {
  for (Json& a : j["attributes"])
    if (a["name"] == name) return a;
  throw std::runtime_error(name);
}

std::string text_of(const Json& j, std::string_view asked = {}) {
  const PlainExplanation plain = plain_explanation(j.dump(), asked);
  return fmt::format("{}\n{}", plain.title, fmt::join(plain.lines, "\n"));
}

/// No id of a block or style, no code in capitals, no footnote, no bare probability.
void expect_plain(const std::string& text) {
  for (const char* pattern : {R"(\b[A-Z]{3,}_[A-Z_]+\b)", R"(\bgz_|\bpb_|_rear\b|_front\b)", R"(\bs[0-9]\.[0-9])",
                              R"(\b0\.[0-9]{2})", R"([nwr][0-9]+\.[a-z])", R"(\[E\])"})
    EXPECT_FALSE(
        std::regex_search(std::regex_replace(text, std::regex(R"([nwr]-?[0-9]+\.(storeys|roof_shape|height) = )"), ""),
                          std::regex(pattern)))
        << pattern << " in\n"
        << text;
}

TEST(PlainExplanation, TellsAHouseInTenLines) {
  const PlainExplanation plain = plain_explanation(house().dump());
  EXPECT_EQ(plain.title, "Arkonaplatz 5, 10435 Berlin");
  EXPECT_GE(plain.lines.size(), 8u);
  EXPECT_LE(plain.lines.size(), 12u);
  const std::string text = text_of(house());
  expect_plain(text);
  EXPECT_THAT(text, HasSubstr("a residential building, as mapped"));
  EXPECT_THAT(text, HasSubstr("also Lange Straße 12"));
  EXPECT_THAT(text, HasSubstr("Storeys: 6, as mapped."));
  EXPECT_THAT(
      text,
      HasSubstr("about 25 m to the top of the roof, 21 m to the eaves; worked out from the mapped storeys, at 3.6 m "
                "each, as usual for such buildings (likely)."));
  EXPECT_THAT(text, HasSubstr("Berlin roof (steep to the street, low to the yard); judged"));
  EXPECT_THAT(text,
              HasSubstr("a Gründerzeit house (sure), built 1840 to 1918 (sure); drawn as: front house of the Berlin "
                        "Mietskaserne (likely)."));
  EXPECT_THAT(text, HasSubstr("houses close 99 % of its block's street front, 40 % of the houses around it stand in "
                              "courtyards and it stands at a street corner."))
      << "the strongest first, but of the surroundings one alone";
  EXPECT_THAT(
      text, HasSubstr("at a street corner; its front faces Arkonaplatz (south-east); it shares walls with 1 neighbour; "
                      "it stands at a closed courtyard of 1650 m²."));
  EXPECT_THAT(text, HasSubstr("107 windows and 1 door, besides 3 balconies and 1 chimney; drawn by rules"));
  EXPECT_THAT(text, HasSubstr("Outline: as mapped, within 4 cm."));
  EXPECT_THAT(text, Not(HasSubstr("Simplified")));
  EXPECT_THAT(text,
              HasSubstr("least is known of the shape of its roof. Add the tag roof:shape at "
                        "https://www.openstreetmap.org/way/27 and build again;\nor write w27.roof_shape = \"berlin\""));
}

TEST(PlainExplanation, GuessedStoreysSayHowSureTheyAre) {
  Json j = house();
  Json& storeys = value_of(j, "storeys");
  storeys["source"] = "neighbours";
  storeys["why"] = "98 tagged neighbours within 150 m, the more alike the louder; within one storey 92 %";
  for (const auto& [confidence, words] :
       {std::pair(0.3, "98 houses near it with mapped storeys suggest (a guess, but surely no more than one off)"),
        {0.6, "(likely, but surely"},
        {0.85, "(sure)."}}) {
    storeys["confidence"] = confidence;
    EXPECT_THAT(text_of(j), HasSubstr(words)) << confidence;
  }
  EXPECT_THAT(text_of(j), HasSubstr("so no surer than they are"));
  storeys["why"] = "1 tagged neighbour within 150 m; within one storey 60 %";
  storeys["confidence"] = 0.2;
  EXPECT_THAT(text_of(j), HasSubstr("as 1 house near it with mapped storeys suggests (a guess)."));
  EXPECT_THAT(text_of(j), HasSubstr("w27.storeys = 6"));
}

TEST(PlainExplanation, MappedNumbersStayAsMapped) {
  Json j = house();
  value_of(j, "height")["source"] = "tag";
  value_of(j, "height")["value"] = 24.65;
  EXPECT_THAT(text_of(j), HasSubstr("Height: 24.65 m to the top of the roof, as mapped."));
  value_of(j, "height")["source"] = "override";
  EXPECT_THAT(text_of(j), HasSubstr("as you ordered"));
  value_of(j, "roof_shape")["source"] = "tag";
  EXPECT_THAT(text_of(j), HasSubstr("storeys, height and roof are mapped"));
}

TEST(PlainExplanation, FallbacksSayWhatTheyMean) {
  Json j = house();
  j["bodies"][0]["built_roof"] = "skillion";
  j["bodies"][0]["fallbacks"] = {"ROOF_SHAPE_ADAPTED"};
  j["notes"].push_back(
      {{"code", "OPENING_LEFT_OUT"}, {"class", "fallback"}, {"meaning", "Windows."}, {"detail", "w27: 2 of 9"}});
  j["notes"].push_back({{"code", "A_CODE_TO_COME"}, {"class", "notice"}, {"meaning", "Something new happened."}});
  const std::string text = text_of(j);
  expect_plain(text);
  EXPECT_THAT(text, HasSubstr("lean-to roof of one slope; meant was a Berlin roof"));
  EXPECT_THAT(text,
              HasSubstr("Simplified: some windows or doors did not fit and are missing; its outline does not take"));
  EXPECT_THAT(text, HasSubstr("; something new happened."));
  j["bodies"][0]["fallbacks"] = {"FACADE_FAILED"};
  EXPECT_THAT(text_of(j), HasSubstr("the walls are closed."));
  EXPECT_THAT(text_of(j), Not(HasSubstr("did not fit"))) << "closed walls have no windows to miss";
}

TEST(PlainExplanation, CornersThatMovedFarAreTold) {
  Json j = house();
  j["repair"]["max_shift"] = 0.31;
  EXPECT_THAT(text_of(j),
              HasSubstr("11 of its 13 corners were moved by 31 cm at most, so that its walls meet those of its "
                        "neighbours and its corners are square."));
  j["repair"]["max_shift"] = 1.27;
  j["repair"]["moved"] = 13;
  EXPECT_THAT(text_of(j), HasSubstr("all its 13 corners were moved by 1.3 m at most"));
  j["repair"]["moved"] = 0;
  EXPECT_THAT(text_of(j), HasSubstr("Outline: as mapped; nothing had to be mended."));
}

TEST(PlainExplanation, AHouseOfWhichNothingIsKnown) {
  Json j = house();
  for (const char* name : {"address", "style", "situation", "edges", "repair"}) j.erase(name);
  j["tags"] = {{"building", "yes"}};
  j["attributes"] = Json::array({attribute("use", "yes", "tag", 0.95, "tagged")});
  j["bodies"][0].erase("detail");
  j["stages"] = Json::array();
  const std::string text = text_of(j);
  expect_plain(text);
  EXPECT_THAT(text, HasSubstr("Building without an address"));
  EXPECT_THAT(text, HasSubstr("the map does not say what it is used for"));
  EXPECT_THAT(text, HasSubstr("this build has no windows"));
}

TEST(PlainExplanation, ATitleIsTheNameTheAddressOrTheStreet) {
  Json j = house();
  j["name"] = "Haus\nBerolina";
  EXPECT_EQ(plain_explanation(j.dump()).title, "Haus Berolina, Arkonaplatz 5, 10435 Berlin");
  j.erase("name"), j.erase("address");
  j["tags"] = Json::object();
  j["edges"][0].erase("points"), j["edges"][1].erase("points");
  EXPECT_EQ(plain_explanation(j.dump()).title, "Residential building, Arkonaplatz (no address mapped)");
  j["edges"][1]["points"] = Json::array({{{"id", "n2"}, {"house_number", "12"}, {"street", "Lange Straße"}}});
  EXPECT_EQ(plain_explanation(j.dump()).title, "Lange Straße 12");
  j["address"] = "1", j["tags"]["addr:housenumber"] = "1";
  EXPECT_EQ(plain_explanation(j.dump()).title, "Lange Straße 1") << "the street of its other door";
  j["edges"][1].erase("points");
  EXPECT_EQ(plain_explanation(j.dump()).title, "Arkonaplatz 1") << "the street that it faces";
}

TEST(PlainExplanation, AnEraThatContradictsTheStyleIsNotTold) {
  Json j = house();
  value_of(j, "era")["value"] = "post1945";
  EXPECT_THAT(text_of(j), HasSubstr("a Gründerzeit house (sure); when it was built is not clear; drawn as"));
  j["attributes"].push_back(attribute("construction_date", "1905", "tag", 0.95, "tagged"));
  EXPECT_THAT(text_of(j), HasSubstr("a Gründerzeit house (sure), built 1905, as mapped; drawn as"));
}

TEST(PlainExplanation, YearsOfDatedNeighboursAreTold) {
  Json j = house();
  j["attributes"].push_back(
      attribute("construction_date", "1888..1899", "neighbours", 0.6,
                "3 dated neighbours within 150 m; of those of the era the middle one is of 1893"));
  EXPECT_THAT(text_of(j),
              HasSubstr("a Gründerzeit house (sure), built about 1888 to 1899, as 3 houses near it with mapped "
                        "dates suggest (likely); drawn as"));
}

TEST(PlainExplanation, OtherDoorsAreToldOnce) {
  Json j = house();
  j["address"] = "Arkonaplatz 5/6", j["tags"]["addr:housenumber"] = "5/6";
  for (const char* number : {"5", "6", "9", "11"})
    j["edges"][0]["points"].push_back({{"id", "n3"}, {"house_number", number}, {"street", "Arkonaplatz"}});
  EXPECT_THAT(text_of(j), HasSubstr("; also Arkonaplatz 9 and 11, Lange Straße 12."));
}

TEST(PlainExplanation, ATownAloneIsNoAddress) {
  Json j = house();
  j["address"] = "İstanbul";
  j["tags"] = {{"addr:city", "İstanbul"}};
  j["edges"][0].erase("points"), j["edges"][1].erase("points");
  EXPECT_EQ(plain_explanation(j.dump()).title, "Residential building, Arkonaplatz, İstanbul (no address mapped)");
  j.erase("edges");
  EXPECT_EQ(plain_explanation(j.dump()).title, "Residential building, İstanbul");
}

TEST(PlainExplanation, PartsAndDuplicatesAreToldFirst) {
  Json j = house();
  Json part = j["bodies"][0];
  part["id"] = "w27.w99";
  part["built_roof"] = "dome";
  part["attributes"] =
      Json::array({attribute("storeys", 2, "tag", 0.95, "tagged"), attribute("height", 31.5, "tag", 0.95, "tagged")});
  j["bodies"].push_back(part);
  j["bodies"][0]["attributes"] = j["attributes"];
  const std::string text = text_of(j, "w99");
  EXPECT_THAT(text,
              HasSubstr("You asked for a part of this building: it has 2 storeys, is 31.5 m high and has a dome."));
  EXPECT_THAT(text, HasSubstr("modelled in 2 parts"));
  EXPECT_THAT(text, HasSubstr("Storeys: 2 to 6 in its parts"));
  EXPECT_LE(plain_explanation(j.dump(), "w99").lines.size(), 12u);
  EXPECT_THAT(text_of(house(), "w5"), HasSubstr("You asked for another drawing of the same house"));
  EXPECT_THAT(text_of(house(), "w27"), Not(HasSubstr("You asked")));
}

TEST(PlainExplanation, WhatIsNotModelledSaysWhy) {
  Json j = house();
  j["bodies"] = Json::array();
  j["attributes"] = Json::array();
  j["state"] = "reported", j["code"] = "OUTLINE_INCOMPLETE",
  j["meaning"] = "Ways or nodes of the outline are not in the extract.";
  std::string text = text_of(j);
  expect_plain(text);
  EXPECT_THAT(text, HasSubstr("Not in the model: a piece of its outline lies outside of the map extract."));
  EXPECT_THAT(text, HasSubstr("cut a larger piece"));
  j["state"] = "duplicate";
  j["notes"] = Json::array({{{"code", "NEAR_DUPLICATE"},
                             {"class", "notice"},
                             {"meaning", "Twice."},
                             {"detail", "of w88, 11.33 m2 in common"}}});
  EXPECT_THAT(text_of(j), HasSubstr("drawn twice in the map, and the other drawing was built (ask for w88)."));
  text = text_of(Json::parse(
      R"({"id":"n5","kind":"building","state":"reported","code":"NODE_ONLY","meaning":"A building mapped as a point."})"));
  expect_plain(text);
  EXPECT_THAT(text, HasSubstr("A building that is not in the model"));
  EXPECT_THAT(text, HasSubstr("draw its outline"));
  text = text_of(Json::parse(R"({"id":"w7","kind":"building_part","state":"duplicate","related":"w2"})"));
  EXPECT_THAT(text, HasSubstr("ask for w2"));
  text =
      text_of(Json::parse(R"({"id":"w-7","kind":"building","state":"reported","code":"OPEN_WAY","meaning":"Open."})"));
  EXPECT_THAT(text, Not(HasSubstr("openstreetmap.org"))) << "an editor's new object has no page";
}

TEST(PlainExplanation, OutbuildingsHaveNoStyleOfHouses) {
  Json j = house();
  j["style"]["rule"] = "12.2 m² without address, storeys or shop: an outbuilding";
  EXPECT_THAT(text_of(j), HasSubstr("taken for an outbuilding (12.2 m² without address, storeys or shop)."));
  j["style"]["rule"] = "building=toilets: a public toilet";
  EXPECT_THAT(text_of(j), HasSubstr("taken for a public toilet."));
  EXPECT_THAT(text_of(j), Not(HasSubstr("building=")));
}

TEST(PlainExplanation, DamageIsAnError) {
  for (const char* line : {"", "{", "[]", "{}", R"({"id":"w1","bodies":[]})"})
    EXPECT_ANY_THROW(plain_explanation(line)) << line;
}

TEST(PlainWords, EveryCodeAndEveryRoofHasSome) {
  for (const model::IssueInfo& info : model::kIssueInfo)
    if (info.text != "NONE") {
      EXPECT_NE(consequence_words(info.text), "") << info.text;
    }
  // Names that no planner knows, or that are made for the program.
  for (const model::RoofTraits& roof : model::kRoofTraits)
    if (roof.name.find('_') != std::string_view::npos || roof.name == "lined" || roof.name == "many" ||
        roof.name == "skillion" || roof.name == "other") {
      EXPECT_NE(roof_words(roof.name), with_spaces(roof.name) + " roof") << roof.name;
    }
}

TEST(PlainReasons, NumbersAreRoundedAndSharesArePercent) {
  EXPECT_EQ(reason_sentence("frontage", "", "m", 17.812), "its front is 18 m wide");
  EXPECT_EQ(reason_sentence("block_closure", "", "", 0.992), "houses close 99 % of its block's street front");
  EXPECT_EQ(reason_sentence("neighbours", "", "", 0), "no house touches it");
  EXPECT_EQ(reason_sentence("neighbours", "", "", 1), "one house touches it");
  EXPECT_EQ(reason_sentence("neighbours", "", "", 3), "3 houses touch it");
  EXPECT_EQ(reason_sentence("tag_use", "", "", 9), "it is mapped as a church or the like");
  EXPECT_EQ(reason_sentence("tag_use", "", "", 99), "");
  EXPECT_EQ(reason_sentence("area", "", "m2", 1234), "it covers 1200 m²");
  EXPECT_EQ(reason_sentence("new_feature", "width of its moat: in all", "m", 3.21), "width of its moat: 3.2 m");
}

class ExplainedTile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "explained_tile";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ + "/explain");
    write("build.json", "{}");
    write("explain/15_1_2.jsonl.gz", gzip(house().dump() + "\n"));
    write("secret.jsonl.gz", gzip(house().dump() + "\n"));
  }
  void write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << bytes;
  }
  std::string folder_;
};

TEST_F(ExplainedTile, HasEveryBuildingOfTheTile) {
  const auto text = explained_tile(folder_, "15_1_2");
  ASSERT_TRUE(text);
  const Json j = Json::parse(*text);
  ASSERT_EQ(j.size(), 1u);
  EXPECT_EQ(j["w27"]["title"], "Arkonaplatz 5, 10435 Berlin");
  EXPECT_EQ(j["w27"]["lines"].size(), plain_explanation(house().dump()).lines.size());
}

TEST_F(ExplainedTile, LooksIntoAreas) {
  std::filesystem::create_directories(folder_ + "/areas/11/5/6/explain");
  write("areas/11/5/6/explain/15_8_9.jsonl.gz", gzip(house().dump() + "\n"));
  EXPECT_FALSE(explained_tile(folder_, "15_8_9"));
  write("build.json", R"({"areas":{"11/5/6":{}}})");
  EXPECT_TRUE(explained_tile(folder_, "15_8_9"));
}

TEST_F(ExplainedTile, StrangersLookUpNothingElse) {
  for (const char* tile : {"", "../secret", "15_1_2/../../secret", "15_1", "15_1_2_3", "_1_2", "15__2", "15_1_",
                           "15_1_3", "15_1_2.jsonl.gz", "15_1_2%00", "..", "index.txt"})
    EXPECT_FALSE(explained_tile(folder_, tile)) << tile;
  EXPECT_FALSE(explained_tile(folder_, std::string_view("15_1_2\0", 7)));
  write("explain/15_1_2.jsonl.gz", "no gzip");
  EXPECT_THROW(explained_tile(folder_, "15_1_2"), base::InputError);
}

}  // namespace
}  // namespace blockrand::outputs
