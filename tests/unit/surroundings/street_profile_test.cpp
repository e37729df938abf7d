// Which strips lie in a street, how wide they are and what they are made of, by tags of the older and the newer schemes.
#include "pipeline/surroundings/street_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>

namespace blockrand::surroundings {
namespace {

using ::testing::DoubleNear;
using ::testing::Optional;
using Tags = std::map<std::string, std::string, std::less<>>;

/// Widths that add up to numbers that are easy to check by head.
constexpr const char* kCatalogue = R"(
ground = []
object = []
[material]
asphalt = {colour = "#666666", surfaces = ["asphalt", "grade1"]}
paving_stones = {colour = "#999999", surfaces = ["paving_stones"]}
sett = {colour = "#888888", surfaces = ["sett"]}
gravel = {colour = "#aaaaaa", surfaces = ["gravel"]}
ground = {colour = "#887766", surfaces = ["ground"]}
grass = {colour = "#77aa77", surfaces = ["grass", "grade5"]}
red_asphalt = {colour = "#aa6666"}
[street]
motorway = {lane = 3.75, width = 12, pavement = 0, kerbed = false, material = "asphalt"}
primary = {lane = 3.5, width = 8, pavement = 3, material = "asphalt"}
residential = {lane = 3, width = 6, pavement = 2, material = "asphalt"}
living_street = {lane = 3, width = 5, pavement = 1, built_up_only = false, material = "asphalt"}
service = {lane = 3, width = 5, pavement = 0, kerbed = false, material = "asphalt"}
track = {lane = 3, width = 2.5, pavement = 0, kerbed = false, material = "gravel"}
pedestrian = {lane = 2, width = 8, pavement = 0, kerbed = false, material = "paving_stones"}
footway = {lane = 2, width = 2, pavement = 0, kerbed = false, material = "paving_stones"}
path = {lane = 2, width = 1.5, pavement = 0, kerbed = false, material = "paving_stones"}
steps = {lane = 2, width = 3, pavement = 0, kerbed = false, material = "paving_stones"}
platform = {lane = 2, width = 3, pavement = 0, kerbed = false, material = "paving_stones"}
cycleway = {lane = 2, width = 2.5, pavement = 0, kerbed = false, material = "red_asphalt"}
other = {lane = 3, width = 4, pavement = 0, kerbed = false, material = "asphalt"}
[shape]
)";

const Catalogue& catalogue() {
  static const Catalogue read = [] {
    const auto path =
        std::filesystem::temp_directory_path() / ("blockrand_street_profile_" + std::to_string(getpid()) + ".toml");
    std::ofstream(path) << kCatalogue;
    Catalogue out(path.string());
    std::filesystem::remove(path);
    return out;
  }();
  return read;
}

std::optional<StreetProfile> profile(const Tags& tags, bool built_up = true, bool keeps_left = false) {
  const TagOf tag = [&](std::string_view key) {
    const auto found = tags.find(key);
    return found == tags.end() ? std::string_view{} : std::string_view(found->second);
  };
  return street_profile(tag, built_up, catalogue(), keeps_left);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value + 0.0);
  return text;
}

/// "-5 pavement -2.5 carriageway 2.5": the borders of the strips from left to right, and what is between them.
std::string strips(const std::optional<StreetProfile>& profile) {
  if (!profile) return "no ground";
  std::string out;
  for (std::size_t i = 0; i < profile->strips.size(); ++i) {
    const StreetStrip& strip = profile->strips[i];
    if (i > 0) {
      EXPECT_EQ(strip.left, profile->strips[i - 1].right) << "a gap";
    }
    EXPECT_LT(strip.left, strip.right);
    if (i == 0) out = number(strip.left);
    out += " " + std::string(model::name(strip.ground)) + " " + number(strip.right);
  }
  return out;
}
std::string strips(const Tags& tags, bool built_up = true) { return strips(profile(tags, built_up)); }

/// Materials from left to right.
std::string materials(const Tags& tags, bool built_up = true) {
  const auto found = profile(tags, built_up);
  std::string out;
  if (found)
    for (const StreetStrip& strip : found->strips)
      out += (out.empty() ? "" : " ") + catalogue().shown().materials.at(strip.material).name;
  return out;
}

/// A street without pavements, whose class has 6 m; `more` comes to it.
Tags bare(Tags more) {
  more.insert({{"highway", "residential"}, {"sidewalk", "no"}});
  return more;
}

// ----------------------------------------------------------------------------------------------------------- classes

TEST(StreetProfile, WithoutTagsItIsAsItsClass) {
  EXPECT_EQ(strips({{"highway", "residential"}}), "-5 pavement -3 carriageway 3 pavement 5");
  EXPECT_EQ(strips({{"highway", "primary"}}), "-7 pavement -4 carriageway 4 pavement 7");
  EXPECT_EQ(strips({{"highway", "service"}}), "-2.5 carriageway 2.5");
  EXPECT_EQ(strips({{"highway", "motorway"}}), "-6 carriageway 6");
}

TEST(StreetProfile, PavementsOfTheClassAreInBuiltUpLandAlone) {
  EXPECT_EQ(strips({{"highway", "residential"}}, false), "-3 carriageway 3");
  EXPECT_EQ(strips({{"highway", "residential"}, {"sidewalk", "right"}}, false), "-3 carriageway 3 pavement 5");
  EXPECT_EQ(strips({{"highway", "living_street"}}, false), "-3.5 pavement -2.5 carriageway 2.5 pavement 3.5")
      << "built_up_only = false";
}

TEST(StreetProfile, KerbsFollowTheClassWhateverStandsAround) {
  EXPECT_TRUE(profile({{"highway", "residential"}})->kerbed);
  EXPECT_TRUE(profile(bare({}))->kerbed);
  EXPECT_TRUE(profile({{"highway", "residential"}}, false)->kerbed) << "no step across it where the town ends";
  EXPECT_FALSE(profile({{"highway", "service"}})->kerbed);
  EXPECT_FALSE(profile({{"highway", "footway"}})->kerbed);
}

TEST(StreetProfile, AnUnknownClassIsAStreetOfAnyKind) {
  EXPECT_EQ(strips({{"highway", "causeway_of_giants"}}), "-2 carriageway 2");
  EXPECT_EQ(strips({{"highway", "raceway"}}), "-2 carriageway 2");
}

TEST(StreetProfile, WaysWithoutLanes) {
  EXPECT_EQ(strips({{"highway", "footway"}}), "-1 footway 1");
  EXPECT_EQ(strips({{"highway", "footway"}, {"footway", "sidewalk"}}), "-1 pavement 1");
  EXPECT_EQ(strips({{"highway", "path"}, {"footway", "sidewalk"}}), "-0.75 pavement 0.75");
  EXPECT_EQ(strips({{"highway", "footway"}, {"footway", "crossing"}}), "-1 footway 1");
  EXPECT_EQ(strips({{"highway", "path"}}), "-0.75 footway 0.75");
  EXPECT_EQ(strips({{"highway", "trail"}}), "-0.75 footway 0.75");
  EXPECT_EQ(strips({{"highway", "bridleway"}}), "-2 footway 2");
  EXPECT_EQ(strips({{"highway", "steps"}, {"width", "10"}}), "-5 steps 5");
  EXPECT_EQ(strips({{"highway", "pedestrian"}}), "-4 square 4");
  EXPECT_EQ(strips({{"highway", "platform"}}), "-1.5 platform 1.5");
  EXPECT_EQ(strips({{"highway", "cycleway"}}), "-1.25 cycle_way 1.25");
  EXPECT_EQ(strips({{"highway", "cycleway"}, {"sidewalk", "right"}, {"cycleway", "track"}}),
            "-1.25 cycle_way 1.25 pavement 3.25");
  const auto footway = profile({{"highway", "footway"}, {"sidewalk", "both"}, {"lanes", "2"}});
  EXPECT_EQ(strips(footway), "-1 footway 1");
  EXPECT_EQ(footway->carriageway_left, footway->carriageway_right);
  EXPECT_EQ(footway->lanes, 0);
}

TEST(StreetProfile, WhatIsNoGround) {
  for (const char* highway : {"construction", "proposed", "razed", "abandoned", "corridor", "elevator", "bus_stop",
                              "rest_area", "services", "crossing", "no", ""})
    EXPECT_EQ(strips({{"highway", highway}}), "no ground") << highway;
  EXPECT_EQ(strips(Tags{{"railway", "tram"}}), "no ground");
}

TEST(StreetProfile, ServiceWaysOfAKindAreNarrower) {
  EXPECT_EQ(strips({{"highway", "service"}, {"service", "driveway"}}), "-1.5 carriageway 1.5");
  EXPECT_EQ(strips({{"highway", "service"}, {"service", "alley"}}), "-1.5 carriageway 1.5");
  EXPECT_EQ(strips({{"highway", "service"}, {"service", "parking_aisle"}}), "-2.5 carriageway 2.5");
  EXPECT_EQ(strips({{"highway", "service"}, {"service", "siding"}}), "-2.5 carriageway 2.5");
  EXPECT_EQ(strips({{"highway", "service"}, {"service", "driveway"}, {"oneway", "yes"}}), "-1.5 carriageway 1.5");
}

// --------------------------------------------------------------------------------------------------------- pavements

TEST(StreetProfile, PavementsOnTheSideThatIsTold) {
  const std::string left = "-5 pavement -3 carriageway 3", right = "-3 carriageway 3 pavement 5";
  const std::string both = "-5 pavement -3 carriageway 3 pavement 5", none = "-3 carriageway 3";
  const auto of = [](Tags tags) {
    tags.insert({"highway", "residential"});
    return strips(tags);
  };
  EXPECT_EQ(of({{"sidewalk", "left"}}), left);
  EXPECT_EQ(of({{"sidewalk", "right"}}), right);
  EXPECT_EQ(of({{"sidewalk", "both"}}), both);
  EXPECT_EQ(of({{"sidewalk", "yes"}}), both);
  EXPECT_EQ(of({{"sidewalk", "left;right"}}), both);
  for (const char* value : {"no", "none", "separate"}) EXPECT_EQ(of({{"sidewalk", value}}), none) << value;
  EXPECT_EQ(of({{"sidewalk", "crossing"}}), both) << "tells nothing";
  EXPECT_EQ(of({{"sidewalk:left", "yes"}, {"sidewalk:right", "no"}}), left);
  EXPECT_EQ(of({{"sidewalk:left", "no"}, {"sidewalk:right", "separate"}}), none);
  EXPECT_EQ(of({{"sidewalk:right", "no"}}), left) << "the other side is not told";
  EXPECT_EQ(of({{"sidewalk:both", "no"}}), none);
  EXPECT_EQ(of({{"sidewalk:both", "yes"}, {"sidewalk:left", "separate"}}), right);
  EXPECT_EQ(of({{"sidewalk", "both"}, {"sidewalk:right", "separate"}}), left);
  EXPECT_EQ(of({{"footway", "left"}}), left) << "an older word";
}

TEST(StreetProfile, WidthsAndSurfacesOfPavementsAreRead) {
  EXPECT_EQ(strips({{"highway", "residential"}, {"sidewalk:left:width", "1.2"}, {"sidewalk:both:width", "4"}}),
            "-4.2 pavement -3 carriageway 3 pavement 7");
  EXPECT_EQ(strips({{"highway", "residential"}, {"sidewalk", "left"}, {"sidewalk:right:width", "4"}}),
            "-5 pavement -3 carriageway 3");
  EXPECT_EQ(strips({{"highway", "service"}, {"sidewalk", "right"}}), "-2.5 carriageway 2.5 pavement 4.5")
      << "a class that has none as a rule";
  EXPECT_EQ(materials({{"highway", "residential"}}), "paving_stones asphalt paving_stones");
  EXPECT_EQ(materials({{"highway", "residential"}, {"surface", "sett"}, {"sidewalk:right:surface", "gravel"}}),
            "paving_stones sett gravel");
}

// ------------------------------------------------------------------------------------------------------------ widths

TEST(StreetProfile, TheCarriagewayIsAsWideAsTold) {
  EXPECT_EQ(strips(bare({{"width", "8"}})), "-4 carriageway 4");
  EXPECT_EQ(strips(bare({{"width", "20'"}})), "-3.048 carriageway 3.048");
  EXPECT_EQ(strips(bare({{"width", "8"}, {"width:carriageway", "7"}})), "-3.5 carriageway 3.5");
  EXPECT_EQ(strips(bare({{"width", "8"}, {"lanes", "4"}, {"oneway", "yes"}})), "-4 carriageway 4");
  EXPECT_EQ(strips({{"highway", "residential"}, {"width", "8"}}), "-6 pavement -4 carriageway 4 pavement 6");
}

TEST(StreetProfile, AbsurdWidthsAreUntold) {
  for (const char* width : {"0", "0.29", "60.1", "800", "-4", "narrow", "3-4", "1e1", "nan", "inf", "4;5"})
    EXPECT_EQ(strips(bare({{"width", width}})), "-3 carriageway 3") << width;
  EXPECT_EQ(strips(bare({{"width", "0.3"}})), "-0.15 carriageway 0.15");
  EXPECT_EQ(strips(bare({{"width", "60"}})), "-30 carriageway 30");
  EXPECT_EQ(strips(bare({{"width", "800"}, {"lanes", "3"}})), "-4.5 carriageway 4.5");
}

TEST(StreetProfile, LanesAreCounted) {
  const auto two = profile(bare({{"lanes", "2"}}));
  EXPECT_EQ(strips(two), "-3 carriageway 3");
  EXPECT_EQ(two->lanes, 2);
  EXPECT_EQ(two->carriageway_left, -3);
  EXPECT_EQ(two->carriageway_right, 3);
  EXPECT_EQ(strips(bare({{"lanes", "1"}})), "-1.625 carriageway 1.625");
  EXPECT_EQ(strips({{"highway", "track"}, {"lanes", "1"}}), "-1.5 carriageway 1.5");
  EXPECT_EQ(strips({{"highway", "primary"}, {"lanes", "4"}, {"sidewalk", "no"}}), "-7 carriageway 7");
  const auto half = profile(bare({{"lanes", "1.5"}}));
  EXPECT_EQ(strips(half), "-2.25 carriageway 2.25");
  EXPECT_EQ(half->lanes, 0) << "no number of lanes that could be marked";
  for (const char* lanes : {"0", "-1", "17", "2;3", "two", "1e0", "nan"}) {
    const auto untold = profile(bare({{"lanes", lanes}, {"oneway", "no"}}));
    EXPECT_EQ(strips(untold), "-3 carriageway 3") << lanes;
    EXPECT_EQ(untold->lanes, 0) << lanes;
  }
}

TEST(StreetProfile, WidthsOfLanesAreSummed) {
  EXPECT_EQ(strips(bare({{"width:lanes", "3.5|1.5"}, {"lanes", "1"}})), "-2.5 carriageway 2.5");
  EXPECT_EQ(strips(bare({{"width:lanes:forward", "3.5|2.5"}, {"width:lanes:backward", "4"}})), "-5 carriageway 5");
  EXPECT_EQ(strips(bare({{"width:lanes", "3.5||1.5"}})), "-3 carriageway 3") << "one is missing";
  EXPECT_EQ(strips(bare({{"width:lanes", "50|50"}})), "-3 carriageway 3");
  EXPECT_EQ(strips(bare({{"width:lanes", "3|4"}, {"parking:right", "lane"}})), "-4.5 carriageway 2.5 parking_lane 4.5")
      << "without parking";
  EXPECT_EQ(strips(bare({{"width:lanes", "3|4"}, {"parking:lane:right", "diagonal"}})),
            "-3.5 carriageway 3.5 parking_lane 8");
  EXPECT_EQ(strips(bare({{"width:lanes:forward", "3.5"}})), "-3 carriageway 3");
  EXPECT_EQ(strips(bare({{"width:lanes", "3.5|1.5"}, {"width", "7"}})), "-3.5 carriageway 3.5");
}

TEST(StreetProfile, OneDirectionNeedsLess) {
  EXPECT_EQ(strips(bare({{"oneway", "yes"}})), "-1.95 carriageway 1.95");
  EXPECT_EQ(strips(bare({{"oneway", "-1"}})), "-1.95 carriageway 1.95");
  EXPECT_EQ(strips(bare({{"oneway", "no"}})), "-3 carriageway 3");
  EXPECT_EQ(strips(bare({{"oneway", "yes"}, {"lanes", "2"}})), "-3 carriageway 3");
  EXPECT_EQ(strips({{"highway", "motorway"}, {"oneway", "yes"}}), "-6 carriageway 6") << "told for one direction";
  EXPECT_EQ(strips(bare({{"junction", "roundabout"}})), "-3 carriageway 3");
  EXPECT_EQ(strips(bare({{"junction", "roundabout"}, {"lanes", "1"}})), "-3 carriageway 3");
  EXPECT_EQ(strips(bare({{"junction", "roundabout"}, {"lanes", "3"}})), "-4.5 carriageway 4.5");
}

// ----------------------------------------------------------------------------------------------------------- parking

TEST(StreetProfile, ParkingLanesComeToTheLanesWhereNoWidthIsTold) {
  EXPECT_EQ(strips(bare({{"parking:right", "lane"}})), "-4 carriageway 2 parking_lane 4");
  EXPECT_EQ(strips(bare({{"parking:left", "lane"}})), "-4 parking_lane -2 carriageway 4");
  EXPECT_EQ(strips(bare({{"parking:both", "lane"}, {"parking:both:orientation", "diagonal"}})),
            "-7.5 parking_lane -3 carriageway 3 parking_lane 7.5");
  EXPECT_EQ(strips(bare({{"parking:right", "lane"}, {"parking:right:orientation", "perpendicular"}, {"lanes", "2"}})),
            "-5.5 carriageway 0.5 parking_lane 5.5");
  EXPECT_EQ(strips(bare({{"parking:right", "lane"}, {"parking:right:width", "3"}})),
            "-4.5 carriageway 1.5 parking_lane 4.5");
}

TEST(StreetProfile, ATaggedWidthHasParkingLanesInIt) {
  const auto found = profile(bare({{"width", "10"}, {"parking:both", "lane"}}));
  EXPECT_EQ(strips(found), "-5 parking_lane -3 carriageway 3 parking_lane 5");
  EXPECT_EQ(found->carriageway_left, -3);
  EXPECT_EQ(found->carriageway_right, 3);
  EXPECT_EQ(strips({{"highway", "residential"}, {"width", "8"}, {"parking:right", "lane"}}),
            "-6 pavement -4 carriageway 2 parking_lane 4 pavement 6");
  EXPECT_EQ(strips(bare({{"width", "4"}, {"parking:both", "lane"}})), "-4 parking_lane -2 carriageway 2 parking_lane 4")
      << "no room for lanes between them: it is the width of the lanes";
}

TEST(StreetProfile, ParkingBaysLieBeyondTheKerb) {
  for (const char* place : {"street_side", "shoulder"})
    EXPECT_EQ(strips(bare({{"width", "6"}, {"parking:right", place}})), "-3 carriageway 3 parking_lane 5") << place;
  EXPECT_EQ(strips(bare({{"parking:left", "street_side"}, {"parking:right", "lane"}})),
            "-6 parking_lane -4 carriageway 2 parking_lane 4");
}

TEST(StreetProfile, ParkingOnKerbsAndElsewhereIsNoStrip) {
  for (const char* place : {"on_kerb", "half_on_kerb", "no", "separate"})
    EXPECT_EQ(strips(bare({{"parking:both", place}})), "-3 carriageway 3") << place;
  EXPECT_EQ(strips(bare({{"parking:lane:right", "parallel"}, {"parking:lane:right:parallel", "half_on_kerb"}})),
            "-3 carriageway 3");
  for (const char* value : {"no_parking", "no_stopping", "no", "fire_lane", "separate"})
    EXPECT_EQ(strips(bare({{"parking:lane:both", value}})), "-3 carriageway 3") << value;
  EXPECT_EQ(strips(bare({{"parking:right", "no"}, {"parking:lane:right", "parallel"}})), "-3 carriageway 3")
      << "the newer scheme counts";
}

TEST(StreetProfile, TheOlderSchemeOfParking) {
  EXPECT_EQ(strips(bare({{"parking:lane:right", "parallel"}})), "-4 carriageway 2 parking_lane 4");
  EXPECT_EQ(strips(bare({{"parking:right", "inline"}})), "-4 carriageway 2 parking_lane 4") << "both schemes mixed";
  EXPECT_EQ(strips(bare({{"parking:lane:left", "diagonal"}})), "-7.5 parking_lane -3 carriageway 3") << "bays";
  EXPECT_EQ(strips(bare({{"parking:lane:left", "diagonal"}, {"parking:lane:left:diagonal", "on_street"}})),
            "-5.25 parking_lane -0.75 carriageway 5.25");
  EXPECT_EQ(strips(bare({{"parking:lane:left", "diagonal"}, {"width", "10.5"}})),
            "-5.25 parking_lane -0.75 carriageway 5.25");
  EXPECT_EQ(strips(bare({{"parking:lane:both", "perpendicular"}, {"parking:lane:left", "no_stopping"}})),
            "-3 carriageway 3 parking_lane 8");
  EXPECT_EQ(strips(bare({{"parking:lane:right", "parallel"}, {"parking:lane:right:parallel", "street_side"}})),
            "-3 carriageway 3 parking_lane 5");
}

// ---------------------------------------------------------------------------------------------------------- bicycles

TEST(StreetProfile, LanesForBicyclesWidenTheCarriageway) {
  // Where vehicles keep to the left, what has no side lies there in a street of one direction.
  const auto one_way = [](bool keeps_left) {
    return strips(profile(bare({{"oneway", "yes"}, {"cycleway", "track"}}), true, keeps_left));
  };
  EXPECT_EQ(one_way(false).find("carriageway"), one_way(false).find_first_not_of("-.0123456789 "));
  EXPECT_EQ(one_way(true).find("cycle_way"), one_way(true).find_first_not_of("-.0123456789 "));
  const auto right = profile(bare({{"cycleway:right", "lane"}}));
  EXPECT_EQ(strips(right), "-3.925 carriageway 3.925");
  EXPECT_NEAR(right->carriageway_left, -3.925, 1e-9);
  EXPECT_NEAR(right->carriageway_right, 2.075, 1e-9);
  EXPECT_EQ(strips(bare({{"cycleway:right", "lane"}, {"cycleway:right:lane", "advisory"}})), "-3.75 carriageway 3.75");
  EXPECT_EQ(strips(bare({{"cycleway:both", "lane"}, {"cycleway:both:lane", "pictogram"}})), "-3 carriageway 3");
  EXPECT_EQ(strips(bare({{"cycleway", "lane"}, {"cycleway:width", "1"}})), "-4 carriageway 4");
  EXPECT_EQ(strips(bare({{"cycleway:left", "lane"}, {"cycleway:left:width", "2"}, {"parking:left", "lane"}})),
            "-5 parking_lane -3 carriageway 5");
}

TEST(StreetProfile, ATaggedWidthHasLanesForBicyclesInIt) {
  const auto found = profile(bare({{"width", "8"}, {"cycleway:left", "lane"}, {"cycleway:left:width", "2"}}));
  EXPECT_EQ(strips(found), "-4 carriageway 4");
  EXPECT_EQ(found->carriageway_left, -2);
  EXPECT_EQ(found->carriageway_right, 4);
  const auto narrow = profile(bare({{"width", "4"}, {"cycleway", "lane"}}));
  EXPECT_EQ(strips(narrow), "-2 carriageway 2");
  EXPECT_EQ(narrow->carriageway_left, -2) << "no room to mark them off";
}

TEST(StreetProfile, TracksForBicyclesLieBeside) {
  EXPECT_EQ(strips({{"highway", "residential"}, {"cycleway", "track"}, {"parking:right", "lane"}, {"lanes", "2"}}),
            "-8 pavement -6 cycle_way -4 carriageway 2 parking_lane 4 cycle_way 6 pavement 8");
  EXPECT_EQ(strips(bare({{"cycleway:left", "track"}})), "-5 cycle_way -3 carriageway 3");
  EXPECT_EQ(strips(bare({{"cycleway:right", "track"}, {"cycleway:right:oneway", "no"}})),
            "-3 carriageway 3 cycle_way 5.5");
  EXPECT_EQ(strips(bare({{"width", "8"}, {"cycleway:right", "track"}, {"cycleway:right:width", "1.5"}})),
            "-4 carriageway 4 cycle_way 5.5");
  for (const char* value : {"no", "none", "separate", "shared_lane", "share_busway", "opposite", "shoulder"})
    EXPECT_EQ(strips(bare({{"cycleway", value}})), "-3 carriageway 3") << value;
  EXPECT_EQ(materials(bare({{"cycleway:right", "track"}})), "asphalt red_asphalt");
  EXPECT_EQ(materials(bare({{"cycleway:right", "track"}, {"cycleway:right:surface", "paving_stones"}})),
            "asphalt paving_stones");
}

TEST(StreetProfile, TheSideOfBicyclesInOneDirection) {
  const auto of = [](Tags tags) {
    tags.insert({{"oneway", "yes"}, {"width", "4"}});
    return strips(bare(tags));
  };
  EXPECT_EQ(of({{"cycleway", "track"}}), "-2 carriageway 2 cycle_way 4");
  EXPECT_EQ(of({{"cycleway", "opposite_track"}}), "-4 cycle_way -2 carriageway 2");
  EXPECT_EQ(of({{"cycleway", "track"}, {"oneway", "-1"}}), "-4 cycle_way -2 carriageway 2");
  EXPECT_EQ(of({{"cycleway", "opposite_track"}, {"oneway", "-1"}}), "-2 carriageway 2 cycle_way 4");
  EXPECT_EQ(of({{"cycleway:both", "track"}}), "-4 cycle_way -2 carriageway 2 cycle_way 4");
  EXPECT_EQ(of({{"cycleway:left", "opposite_track"}}), "-4 cycle_way -2 carriageway 2");
  EXPECT_EQ(strips(bare({{"cycleway", "opposite_lane"}, {"oneway", "yes"}, {"lanes", "2"}})),
            "-3.925 carriageway 3.925");
}

// --------------------------------------------------------------------------------------------------------- materials

TEST(StreetProfile, TheCarriagewayIsMadeOfWhatSurfaceTells) {
  EXPECT_EQ(materials(bare({})), "asphalt");
  EXPECT_EQ(materials(bare({{"surface", "sett"}})), "sett");
  EXPECT_EQ(materials(bare({{"surface", "gold;sett"}})), "sett");
  EXPECT_EQ(materials(bare({{"surface", "sett:flattened"}})), "sett");
  EXPECT_EQ(materials(bare({{"surface", "gold"}})), "asphalt");
  EXPECT_EQ(materials(bare({{"surface", "sett"}, {"parking:right", "lane"}})), "sett sett");
  EXPECT_EQ(materials(bare({{"parking:right", "lane"}, {"parking:right:surface", "gravel"}})), "asphalt gravel");
}

TEST(StreetProfile, TracksAndPathsAreAsTheirGradeTells) {
  EXPECT_EQ(strips({{"highway", "track"}}), "-1.25 carriageway 1.25");
  EXPECT_EQ(materials({{"highway", "track"}}), "gravel");
  EXPECT_EQ(materials({{"highway", "track"}, {"tracktype", "grade1"}}), "asphalt");
  EXPECT_EQ(materials({{"highway", "track"}, {"tracktype", "grade5"}}), "grass");
  EXPECT_EQ(materials({{"highway", "track"}, {"tracktype", "grade5"}, {"surface", "sett"}}), "sett");
  EXPECT_EQ(materials({{"highway", "path"}}), "paving_stones");
  EXPECT_EQ(materials({{"highway", "path"}}, false), "ground");
  EXPECT_EQ(materials({{"highway", "path"}, {"surface", "asphalt"}}, false), "asphalt");
  EXPECT_EQ(materials({{"highway", "footway"}}, false), "paving_stones");
}

// ----------------------------------------------------------------------------------------------------------- lengths

TEST(LengthOf, ReadsMetresCentimetresFeetAndInches) {
  const std::pair<const char*, double> kLengths[] = {
      {"3", 3},        {"3.5", 3.5},         {"3.5 m", 3.5},   {"3,5", 3.5},     {"2,5m", 2.5},
      {" 4 ", 4},      {"350cm", 3.5},       {"350 cm", 3.5},  {"4 metres", 4},  {"4 M", 4},
      {"12'", 3.6576}, {"12 ft", 3.6576},    {"12ft", 3.6576}, {"7'6\"", 2.286}, {"7' 6\"", 2.286},
      {"7'6", 2.286},  {"7 ft 6 in", 2.286}, {"7′6″", 2.286},  {"90\"", 2.286},  {"90 in", 2.286},
      {"90''", 2.286}, {"10'6.5''", 3.2131}, {"0", 0},         {"1000", 1000}};
  for (const auto& [text, length] : kLengths) EXPECT_THAT(length_of(text), Optional(DoubleNear(length, 1e-9))) << text;
}

TEST(LengthOf, WhatCannotBeReadTellsNothing) {
  for (const char* text :
       {"",    " ",   "m",   "-3",   "+3",   "2-3",  "2;3",  "2 3", "~3",     "3.",    ".5",     "3..5", "3.5.1",
        "1e2", "nan", "inf", "0x10", "wide", "3 km", "3 mm", "3mx", "7'14\"", "12'\"", "7'6\"2", "3 m 2"})
    EXPECT_EQ(length_of(text), std::nullopt) << text;
  EXPECT_EQ(length_of(std::string(400, '9')), std::nullopt);
}

}  // namespace
}  // namespace blockrand::surroundings
