// One tile alone: what the options say, and what a build keeps of it.
#include "pipeline/run/tile_choice.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/run/configuration.h"

namespace blockrand::run {
namespace {

using ::testing::HasSubstr;

class Pinned : public ::testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(path_) << text; }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_ = ::testing::TempDir() + "pinned-" + std::to_string(::getpid()) + ".json";
  std::string good_ = R"({"configuration":)" + configuration({}).dump() +
                      R"(,"crs":{"code":"EPSG:25833"},"region":{"box":[13.3,52.4,13.5,52.6],"centre":[13.4,52.5],
                          "areas":[],"coverage":[[380000,5800000],[390000,5800000],[385000,5810000.5]]}})";
};

template <class Error>
std::string message(const BuildOptions& options) {
  try {
    choose_tile(options);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST_F(Pinned, ATileTakesItsFactsFromTheWhole) {
  write(good_);
  BuildOptions options;
  options.tile = "15/35207/25941";
  options.pinned = path_;
  const auto choice = choose_tile(options);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->id, (model::TileId{15, 35207, 25941}));
  EXPECT_EQ(choice->facts.crs, "EPSG:25833");
  ASSERT_EQ(choice->facts.coverage.size(), 3u);
  EXPECT_EQ(choice->facts.coverage[2], (model::Point2{385000, 5810000.5}));
  // A degree of latitude is 111 km; the window reaches 3 km beyond the tile on all sides.
  const double size = 180.0 / 32768;
  const double west = -180 + 35207 * size, south = -90 + 25941 * size;
  EXPECT_NEAR((south - choice->window[1]) * 111.2, 3.0, 0.05);
  EXPECT_GE((west - choice->window[0]) * 111.2 * 0.6085, 3.0) << "cos(52.5 degrees) is 0.6088";
  EXPECT_LT((west - choice->window[0]) * 111.2 * 0.6085, 3.2);
}

TEST_F(Pinned, MistakesAreNamed) {
  write(good_);
  BuildOptions options;
  options.pinned = path_;
  EXPECT_THAT(message<base::UsageError>(options), HasSubstr("--tile"));
  options.tile = "15/35207/25941";
  options.pinned.clear();
  EXPECT_THAT(message<base::UsageError>(options), HasSubstr("--pinned"));
  options.pinned = path_;
  for (const char* text :
       {"15", "15/1", "15/1/2/3", "a/b/c", "15/-1/2", "15/65536/2", "15/1/32768", "5/1/1", "15/1/2 ", "15//2"}) {
    options.tile = text;
    EXPECT_THAT(message<base::UsageError>(options), HasSubstr("level/x/y")) << text;
  }
  options.tile = "15/35207/25941";
  options.crs = "EPSG:25833";
  EXPECT_THAT(message<base::UsageError>(options), HasSubstr("--crs"));
  options.crs.clear();
  options.repair.max_shift = 0.3;
  EXPECT_THAT(message<base::UsageError>(options), HasSubstr("repair.max_shift"));
  options.repair = {};
  for (const char* text : {"", "{", "[]", "{\"crs\":{\"code\":\"EPSG:25833\"}}",
                           R"({"crs":{"code":"EPSG:25833"},"region":{"box":[1,2,3],"centre":[1,2],"coverage":[]}})"}) {
    write(text);
    EXPECT_THAT(message<base::InputError>(options), HasSubstr(path_)) << text;
  }
  std::filesystem::remove(path_);
  EXPECT_THAT(message<base::InputError>(options), HasSubstr("cannot be opened"));
}

/// Rows of what is no building belong to where it begins.
TEST(ForgetOthers, RowsOfFeatures) {
  model::Extract e;
  const model::OsmId near{model::OsmType::relation, 1}, far{model::OsmType::relation, 2},
      unknown{model::OsmType::relation, 3};
  for (const model::OsmId id : {near, far}) {
    model::Feature f;
    f.id = id;
    f.rings = {static_cast<std::uint32_t>(e.rings.size()), 1};
    model::MappedRing ring;
    ring.vertices = {static_cast<std::uint32_t>(e.vertices.size()), 2};
    e.rings.push_back(ring);
    e.vertices.push_back({id == near ? 134'000'000 : 135'000'000, 525'000'000});
    e.vertices.push_back({134'500'000, 525'000'000});
    e.features.push_back(f);
  }
  std::vector<model::ReportRow> rows;
  for (const model::OsmId id : {near, far, unknown}) rows.push_back({id, model::IssueCode::members_missing, ""});
  TileChoice here;
  here.id = georef::tile_of(e.vertices.front(), 15);
  forget_others(
      e, here, [](const model::MappedBuilding&) { return true; }, rows);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].object, near);
}

TEST(ForgetOthers, WhatHasNoPlaceIsToldInOneArea) {
  for (const bool told : {false, true}) {
    model::Extract e;
    model::MappedBuilding b;
    b.id = {model::OsmType::way, 7};
    b.state = model::ObjectState::reported;
    e.buildings.push_back(b);
    std::vector<model::ReportRow> rows;
    TileChoice area = choose_area({11, 1093, 1500}, {});
    EXPECT_TRUE(area.is_area());
    area.placeless = told;
    forget_others(
        e, area, [&](const model::MappedBuilding& object) { return lies_in(e, object, area); }, rows);
    EXPECT_EQ(e.buildings.size(), told ? 1u : 0u);
  }
}

TEST(ChooseArea, IsTheSameWhateverStandsFarAway) {
  RegionFacts facts;
  facts.box = {13.0912, 52.3401, 13.7609, 52.6755}, facts.centre = {13.4, 52.5};
  RegionFacts larger = facts;
  larger.box.west -= 0.001, larger.centre.lon += 0.01;
  const TileChoice a = choose_area({11, 2200, 1621}, facts), b = choose_area({11, 2200, 1621}, larger);
  EXPECT_EQ(a.facts.box.west, b.facts.box.west);
  EXPECT_EQ(a.facts.centre.lon, b.facts.centre.lon);
  EXPECT_LE(a.facts.box.west, larger.box.west);
  EXPECT_GE(a.facts.box.north, facts.box.north);
  EXPECT_EQ(text_of(parse_tile("11/2200/1621", "--area")), "11/2200/1621");
}

}  // namespace
}  // namespace blockrand::run
