#include "pipeline/outputs/explain/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/outputs/explain/find_places.h"
#include "pipeline/outputs/explain/place_words.h"

namespace blockrand::outputs {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

TEST(Places, AreReadAsTheyAreWritten) {
  const Place place{"w123", "15_1_2", 13.4013389, -0.5, 24.64, "Arkonaplatz 5, 10435 Berlin; Weg 2", "Café"};
  const std::string line = place_line(place);
  EXPECT_EQ(line, "w123\t15_1_2\t13.4013389\t-0.5000000\t24.6\tArkonaplatz 5, 10435 Berlin; Weg 2\tCafé\n");
  const auto read = read_place(std::string_view(line).substr(0, line.size() - 1));
  ASSERT_TRUE(read);
  EXPECT_EQ(place_line(*read), line);
  EXPECT_EQ(read->addresses, place.addresses);
  EXPECT_DOUBLE_EQ(read->top, 24.6);
}

TEST(Places, HostileTextsStayInTheirField) {
  const std::string line = place_line({"w1", "15_1_2", 1, 2, 0, "A\tB\n 1", "x\ty\r\n"});
  EXPECT_EQ(line, "w1\t15_1_2\t1.0000000\t2.0000000\t0.0\tA B  1\tx y  \n");
}

TEST(Places, WhatIsNoLineIsNotRead) {
  for (const char* line : {"", "w1", "w1\t15_1_2\t1\t2\t3\tA", "w1\t15_1_2\t1\t2\t3\tA\tB\tC",
                           "w1\t15_1_2\tx\t2\t3\tA\tB", "\t15_1_2\t1\t2\t3\tA\tB"})
    EXPECT_FALSE(read_place(line)) << line;
  EXPECT_TRUE(read_place("w1\t15_1_2\t1\t2\t3\t\t"));
}

TEST(Places, EveryHouseNumberOnce) {
  AddressList list("Arkonaplatz 5;7, 10435 Berlin", "Arkonaplatz", "5;7");
  list.add("5", "", "Weg");               // its own
  list.add("7", "Arkonaplatz", "Weg");    // its own
  list.add("", "", "Weg");                // an entrance without a number
  list.add("12", "Lange Straße", "Weg");  // at the corner
  list.add("12", "Lange Straße", "Weg");
  list.add("9", "", "Weg");  // of the building's street
  EXPECT_EQ(list.text(), "Arkonaplatz 5;7, 10435 Berlin; Lange Straße 12; Arkonaplatz 9");
  AddressList nameless("", "", "");
  nameless.add("3", "", "Weg");
  nameless.add("4", "", "");
  EXPECT_EQ(nameless.text(), "Weg 3; 4");
}

TEST(PlaceWords, AreTheSameHoweverAStreetIsWritten) {
  EXPECT_EQ(place_words("Zionskirchstraße 5 A"), place_words("zionskirchstr. 5a"));
  EXPECT_EQ(place_words("Schönhauser Allee 3 – 7"), place_words("Schoenhauser allee 3-7"));
  EXPECT_EQ(place_words("улица Ленина, д. 5"), place_words("ул. ЛЕНИНА 5"));
  EXPECT_EQ(place_words("İstiklâl Caddesi 12"), place_words("istiklal cad. no 12"));
  EXPECT_THAT(place_words("Karl-Marx-Allee 90/92"), ElementsAre("karl", "marx", "allee", "90/92"));
  EXPECT_THAT(place_words(" ,;-/ "), IsEmpty());
}

TEST(PlaceWords, NumbersMatch) {
  EXPECT_EQ(match_numbers("5", "5"), NumberMatch::same);
  EXPECT_EQ(match_numbers("45", "1234/45"), NumberMatch::half);
  EXPECT_EQ(match_numbers("1234", "1234/45"), NumberMatch::half);
  EXPECT_EQ(match_numbers("5", "5a"), NumberMatch::beside);
  EXPECT_EQ(match_numbers("5a", "5"), NumberMatch::beside);
  EXPECT_EQ(match_numbers("5", "3-7"), NumberMatch::beside);
  EXPECT_EQ(match_numbers("4", "3-7"), NumberMatch::none) << "the other side of the street";
  EXPECT_EQ(match_numbers("4", "3-8"), NumberMatch::beside);
  EXPECT_EQ(match_numbers("5", "50"), NumberMatch::none);
  EXPECT_EQ(match_numbers("5", "15"), NumberMatch::none);
}

std::string line(const std::string& id, const std::string& addresses, const std::string& name = {}, double top = 10) {
  return place_line({id, "15_1_2", 13, 52, top, addresses, name});
}

/// A build of two areas.
class FindPlaces : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "find_places";
    std::filesystem::remove_all(folder_);
    write("build.json", R"({"areas":{"11/5/6":{},"11/5/7":{}}})");
    for (const auto& [area, places] : {std::pair("areas/11/5/6/", &files_[0]), {"areas/11/5/7/", &files_[1]}}) {
      write(std::string(area) + "build.json", "{}");
      write(std::string(area) + "explain/index.txt", "");
      write(std::string(area) + "explain/places.tsv", *places);
    }
  }
  void write(const std::string& name, const std::string& bytes) {
    const std::filesystem::path path = folder_ + "/" + name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
  }
  FoundPlaces find(std::string_view text) const { return find_places(folder_, text); }
  std::vector<std::string> ids(std::string_view text) const {
    std::vector<std::string> out;
    for (const Place& place : find(text).places) out.push_back(place.id);
    return out;
  }
  std::string folder_;
  std::array<std::string, 2> files_ = {
      line("w1", "Arkonaplatz 5, 10435 Berlin") + line("w2", "Arkonaplatz 5a, 10435 Berlin") +
          line("w3", "Arkonaplatz 7-11, 10435 Berlin") + line("w4", "Zionskirchplatz, 10119 Berlin", "Zionskirche") +
          line("w5", "Zionskirchstraße 12;14, 10119 Berlin; Arkonaplatz 20") +
          line("w6", "Straße des 17. Juni 5, 10557 Berlin") + line("w7", "", "") + line("w8", "Schönhauser Allee 5"),
      line("w11", "Schönhauser Allee 5, 14467 Potsdam") + line("w12", "улица Ленина 14, Волгоград") +
          line("w13", "İstiklâl Caddesi 3") + line("w14", "Mánesova 1234/45, Praha") + line("w15", "Hof 1", "", 0) +
          line("w16", "Hof 1") + line("w17", "Hof 2", "", 0) + line("r9", "Pfarrhaus", "Gemeindehaus der Zionskirche")};
};

TEST_F(FindPlaces, WholeAddressesInManyForms) {
  for (const char* text : {"Arkonaplatz 5", "arkonapl. 5", "5 Arkonaplatz", "ARKONAPLATZ 5, 10435 Berlin",
                           "Berlin, Arkonaplatz 5", "Arkonaplatz 5 Berlin", "Arkona Platz 5"})
    EXPECT_THAT(ids(text), ElementsAre("w1")) << text;
  for (const char* text : {"Zionskirchstr. 14", "zionskirchstrasse 14", "Zionskirch-Straße 14", "Arkonaplatz 20"})
    EXPECT_THAT(ids(text), ElementsAre("w5")) << text;
  EXPECT_THAT(ids("Straße des 17. Juni 5"), ElementsAre("w6"));
  EXPECT_THAT(ids("Ул. Ленина, дом 14"), ElementsAre("w12"));
  EXPECT_THAT(ids("istiklal caddesi 3"), ElementsAre("w13"));
  EXPECT_THAT(ids("ISTIKLAL CAD 3"), ElementsAre("w13"));
  EXPECT_THAT(ids("Manesova 45"), ElementsAre("w14"));
}

TEST_F(FindPlaces, TheTownTellsApart) {
  EXPECT_THAT(ids("Schönhauser Allee 5"), UnorderedElementsAre("w8", "w11"));
  EXPECT_THAT(ids("Schoenhauser Allee 5, Potsdam"), ElementsAre("w11"));
  EXPECT_THAT(ids("Schönhauser Allee 5, 14467"), ElementsAre("w11"));
  EXPECT_THAT(ids("Schönhauser Allee 5, Hamburg"), IsEmpty()) << "no house here is in Hamburg";
}

TEST_F(FindPlaces, ANumberBesideIsToldAsOne) {
  EXPECT_TRUE(find("Arkonaplatz 5").exact);
  const FoundPlaces range = find("Arkonaplatz 9");
  ASSERT_EQ(range.places.size(), 1u);
  EXPECT_EQ(range.places[0].id, "w3");
  EXPECT_FALSE(range.exact);
  EXPECT_THAT(ids("Arkonaplatz 5b"), UnorderedElementsAre("w1", "w2"));
}

TEST_F(FindPlaces, NamesStreetsAndWords) {
  EXPECT_THAT(ids("zionskirche"), ElementsAre("w4")) << "the whole name before names that have the word";
  EXPECT_THAT(ids("Gemeindehaus"), ElementsAre("r9"));
  EXPECT_THAT(ids("Arkonaplatz"), UnorderedElementsAre("w1", "w2", "w3", "w5"));
  EXPECT_THAT(ids("Berlin"), IsEmpty()) << "a town is no building";
}

TEST_F(FindPlaces, BuildingsWithABodyFirst) {
  EXPECT_THAT(ids("Hof 1"), ElementsAre("w16"));
  EXPECT_THAT(ids("Hof 2"), ElementsAre("w17"));
}

TEST_F(FindPlaces, WhatMayHaveBeenMeant) {
  const auto nearest = [&](std::string_view text) { return find(text).nearest; };
  EXPECT_THAT(nearest("Arkonplaz 5"), ::testing::Contains("Arkonaplatz 5"));
  EXPECT_THAT(nearest("Zionskirch"), IsEmpty()) << "the beginning of a word finds";
  EXPECT_THAT(ids("Zionskirch 14"), ElementsAre("w5"));
  EXPECT_THAT(nearest("Arkonaplatz 200"),
              ElementsAre("Arkonaplatz 20", "Arkonaplatz 7-11", "Arkonaplatz 5", "Arkonaplatz 5a"))
      << "the nearest numbers of the right street";
  EXPECT_THAT(nearest("Arkonplaz 12"), ElementsAre("Arkonaplatz")) << "it has no such number";
  EXPECT_THAT(nearest("Xylophonweg 1"), IsEmpty());
  EXPECT_THAT(nearest(""), IsEmpty());
  EXPECT_THAT(ids(""), IsEmpty());
}

TEST_F(FindPlaces, FilesThatAreGoneOrDamaged) {
  const auto error = [&]() -> std::string {
    try {
      find("Arkonaplatz 5");
    } catch (const base::InputError& e) {
      return e.what();
    } catch (const base::UsageError& e) {
      return e.what();
    }
    return "no error";
  };
  write("areas/11/5/7/explain/places.tsv", "w1 no tabs\n");
  EXPECT_THAT(error(), ::testing::HasSubstr("areas/11/5/7/explain/places.tsv: this line cannot be read: w1 no tabs"));
  std::filesystem::remove(folder_ + "/areas/11/5/7/explain/places.tsv");
  EXPECT_THAT(error(), ::testing::HasSubstr("an older program made this build"));
  EXPECT_THAT(error(), ::testing::HasSubstr("w123"));
  write("areas/11/5/7/build.json", R"({"configuration":{"explain":false}})");
  std::filesystem::remove(folder_ + "/areas/11/5/7/explain/index.txt");
  EXPECT_THAT(error(), ::testing::HasSubstr("--no-explain"));
  std::filesystem::remove(folder_ + "/build.json");
  EXPECT_THAT(error(), ::testing::HasSubstr("is no build"));
}

TEST_F(FindPlaces, AWholeNumberBeforeAHalfOneBeforeOneBeside) {
  write("areas/11/5/6/explain/places.tsv", line("w1", "Weg 1/5") + line("w2", "Weg 5") + line("w3", "Weg 5a") +
                                               line("w4", "34122") + line("w5", "Weg 7/9") + line("w6", "Weg 9a"));
  EXPECT_THAT(ids("Weg 5"), ElementsAre("w2"));
  EXPECT_THAT(ids("Weg 9"), ElementsAre("w5"));
  EXPECT_TRUE(find("Weg 9").exact);
  EXPECT_THAT(ids("Weg 5, 34122"), ElementsAre("w2")) << "the postcode of another house";
}

TEST_F(FindPlaces, ANumberWithoutAStreetTakesTheNextOne) {
  write("areas/11/5/6/explain/places.tsv", line("w1", "1; Lange Straße 2; 3"));
  for (const char* text : {"Lange Str. 1", "Lange Str. 2", "Lange Str. 3"})
    EXPECT_THAT(ids(text), ElementsAre("w1")) << text;
}

}  // namespace
}  // namespace blockrand::outputs
