#include "importers/osm/construction_date.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "importers/osm/attributes.h"

namespace blockrand::importers::osm {
namespace {

using model::YearRange;

struct Case {
  const char* text;
  int from, to;
  double confidence;
};

TEST(ConstructionDate, KnowsEveryFormMappersUse) {
  const Case cases[] = {
      {"1890", 1890, 1890, 0.95},
      {" 1890 ", 1890, 1890, 0.95},
      {"1890-05", 1890, 1890, 0.95},
      {"1890-05-01", 1890, 1890, 0.95},
      {"1890-05-01T00:00:00Z", 1890, 1890, 0.95},
      {"1890/05/01", 1890, 1890, 0.95},
      {"01.05.1890", 1890, 1890, 0.95},
      {"May 1890", 1890, 1890, 0.95},
      {"Herbst_2011", 2011, 2011, 0.95},
      {"early 1920", 1920, 1920, 0.95},
      {"940", 940, 940, 0.95},
      {"500", 500, 500, 0.95},
      {"2100", 2100, 2100, 0.95},
      {"~1890", 1885, 1895, 0.8075},
      {"~ 1890", 1885, 1895, 0.8075},
      {"c. 1890", 1885, 1895, 0.8075},
      {"c.1890", 1885, 1895, 0.8075},
      {"c 1890", 1885, 1895, 0.8075},
      {"c1890", 1885, 1895, 0.8075},
      {"ca. 1890", 1885, 1895, 0.8075},
      {"ca 1890", 1885, 1895, 0.8075},
      {"ca.1890", 1885, 1895, 0.8075},
      {"circa 1890", 1885, 1895, 0.8075},
      {"about 1900", 1895, 1905, 0.8075},
      {"um 1900", 1895, 1905, 0.8075},
      {"~502", 500, 507, 0.8075},
      {"C19", 1801, 1900, 0.8},
      {"c19", 1801, 1900, 0.8},
      {"C6", 501, 600, 0.8},
      {"C21", 2001, 2100, 0.8},
      {"19th century", 1801, 1900, 0.8},
      {"19th Century", 1801, 1900, 0.8},
      {"19. Jahrhundert", 1801, 1900, 0.8},
      {"early C19", 1801, 1833, 0.75},
      {"mid C19", 1834, 1867, 0.75},
      {"mid-C19", 1834, 1867, 0.75},
      {"mid-19th century", 1834, 1867, 0.75},
      {"late C19", 1868, 1900, 0.75},
      {"late 19th century", 1868, 1900, 0.75},
      {"Ende 19. Jh.", 1868, 1900, 0.75},
      {"~C13", 1176, 1325, 0.68},
      {"1880s", 1880, 1889, 0.85},
      {"1880's", 1880, 1889, 0.85},
      {"1880er", 1880, 1889, 0.85},
      {"1900s", 1900, 1909, 0.5},
      {"~1880s", 1875, 1894, 0.7225},
      {"early 1920s", 1920, 1922, 0.8},
      {"mid 1920s", 1923, 1926, 0.8},
      {"late 1920s", 1927, 1929, 0.8},
      {"before 1914", 1864, 1913, 0.5},
      {"before_1914", 1864, 1913, 0.5},
      {"<1900", 1850, 1899, 0.5},
      {"< 1900", 1850, 1899, 0.5},
      {"<=1900", 1851, 1900, 0.5},
      {"until 1900", 1851, 1900, 0.5},
      {"..1900", 1851, 1900, 0.5},
      {"before 1910-01-20", 1861, 1910, 0.5},
      {"before C18", 1651, 1700, 0.5},
      {"before 1880s", 1830, 1879, 0.5},
      {"before 1900..1905", 1855, 1904, 0.5},
      {"before ~1890", 1835, 1884, 0.5},
      {"after 1918", 1919, 1968, 0.5},
      {">1945", 1946, 1995, 0.5},
      {">=1945", 1945, 1994, 0.5},
      {"since 1945", 1945, 1994, 0.5},
      {"1945..", 1945, 1994, 0.5},
      {"after 2010", 2011, 2030, 0.5},
      {"after 2040", 2041, 2041, 0.5},
      {"after 2100", 2100, 2100, 0.5},
      {"before 500", 500, 500, 0.5},
      {"after C18", 1801, 1850, 0.5},
      {"after 1939..1945", 1940, 1989, 0.5},
      {"1895..1902", 1895, 1902, 0.9},
      {"1895 .. 1902", 1895, 1902, 0.9},
      {"1895-1902", 1895, 1902, 0.9},
      {"1895 - 1902", 1895, 1902, 0.9},
      {"1895–1902", 1895, 1902, 0.9},
      {"1895 to 1902", 1895, 1902, 0.9},
      {"from 1895 to 1902", 1895, 1902, 0.9},
      {"1871/1914", 1871, 1914, 0.9},
      {"1938/39", 1938, 1939, 0.9},
      {"1907/08", 1907, 1908, 0.9},
      {"1938-39", 1938, 1939, 0.9},
      {"1890..1890", 1890, 1890, 0.9},
      {"2008-08-08..2009-08-24", 2008, 2009, 0.9},
      {"ca 1895-1902", 1890, 1902, 0.8075},
      {"~940..~1020", 935, 1025, 0.8075},
      {"mid C17..late C17", 1634, 1700, 0.75},
      {"1880s..1890s", 1880, 1899, 0.85},
      {"1889?", 1889, 1889, 0.665},
      {"1889 ?", 1889, 1889, 0.665},
      {"1880s (?)", 1880, 1889, 0.595},
      {"1890;1905", 1890, 1890, 0.8075},
      {"1890; 1905", 1890, 1890, 0.8075},
      {"1890;", 1890, 1890, 0.95},
  };
  for (const Case& c : cases) {
    const auto date = parse_construction_date(c.text);
    ASSERT_TRUE(date) << c.text;
    EXPECT_EQ(date->years, (YearRange{static_cast<std::int16_t>(c.from), static_cast<std::int16_t>(c.to)}))
        << c.text << ": " << date->years.from << ".." << date->years.to;
    EXPECT_NEAR(date->confidence, c.confidence, 1e-5) << c.text;
  }
}

TEST(ConstructionDate, RefusesWhatNamesNoYearOfAHouse) {
  for (const char* text : {"",
                           " ",
                           "old",
                           "12",
                           "9999",
                           "99999999999999999999",
                           "1890x",
                           "j:1700-01-01",
                           "j:1700",
                           "jd:2455511",
                           "-0500",
                           "-1500",
                           "480 BC",
                           "480 BCE",
                           "C5",
                           "C22",
                           "C",
                           "c",
                           "c.",
                           "~",
                           "?",
                           ";",
                           "..",
                           "before",
                           "after",
                           "499",
                           "2101",
                           "1902..1895",
                           "1902-1895",
                           "1890-13",
                           "1890-00",
                           "1890-05-32",
                           "1890-05-",
                           "1885s",
                           "yes",
                           "unknown",
                           "19. May",
                           "1893-94 on this map",
                           "Mitenkäs 1890?",
                           "early",
                           "mid C",
                           "18th",
                           "19th street",
                           "1890 1905",
                           "1890,1905",
                           "1.900",
                           "18905",
                           "1890-05-01x"})
    EXPECT_FALSE(parse_construction_date(text)) << text;
}

TEST(ConstructionDate, RandomTextNeverCrashesAndYearsAreOrdered) {
  // Pieces of real forms find more than random bytes do.
  const char* pieces[] = {
      "1890",   "1902",  "18",    "9",       "C19",  "c",  ".",    "..",  "-",     "/",        " ",
      "~",      "<",     ">",     "=",       "?",    ";",  "s",    "er",  "early", "mid",      "late",
      "before", "after", "th",    "century", "05",   "31", "2100", "500", "j:",    "\xc3\xa4", "\xe2\x80\x93",
      "_",      "T",     "until", "to",      "\xff", "0"};
  std::mt19937 random(8);
  int readable = 0;
  for (int i = 0; i < 200000; ++i) {
    std::string text;
    for (std::uint32_t n = random() % 7; n > 0; --n) text += pieces[random() % std::size(pieces)];
    if (random() % 4 == 0 && !text.empty()) text[random() % text.size()] = static_cast<char>(random() % 256);
    const auto date = parse_construction_date(text);
    if (!date) continue;
    ++readable;
    ASSERT_LE(date->years.from, date->years.to) << text;
    ASSERT_GE(date->years.from, kFirstConstructionYear) << text;
    ASSERT_LE(date->years.to, kLastConstructionYear) << text;
    ASSERT_GT(date->confidence, 0) << text;
    ASSERT_LE(date->confidence, 0.95f) << text;
  }
  EXPECT_GT(readable, 5000) << "the pieces make dates";
}

using TagList = std::vector<std::pair<std::string_view, std::string_view>>;

std::optional<model::ConstructionDate> built(const TagList& tags, model::Report* report = nullptr) {
  base::StringPool strings;
  model::Report own;
  return read_attributes({model::OsmType::way, 1}, model::ObjectKind::building, tags, strings, report ? *report : own)
      .built;
}

TEST(ConstructionDate, IsAnAttributeOfTheBuilding) {
  EXPECT_FALSE(built({{"building", "yes"}}));
  for (const char* key : {"start_date", "construction_date", "building:start_date", "year_of_construction",
                          "building:year_of_construction"}) {
    const auto date = built({{"building", "yes"}, {key, "1890s"}});
    ASSERT_TRUE(date) << key;
    EXPECT_EQ(date->years, (YearRange{1890, 1899})) << key;
  }
}

TEST(ConstructionDate, KeysOfTheBuildingComeBeforeThatOfWhateverIsInIt) {
  EXPECT_EQ(built({{"building", "yes"}, {"start_date", "1995"}, {"building:start_date", "1890"}})->years.from, 1890);
  EXPECT_EQ(built({{"building", "yes"}, {"start_date", "1995"}, {"construction_date", "1891"}})->years.from, 1891);
  model::Report report;
  EXPECT_EQ(
      built({{"building", "yes"}, {"start_date", "1995"}, {"building:start_date", "long ago"}}, &report)->years.from,
      1995);
  ASSERT_EQ(report.rows.size(), 1u);
  EXPECT_EQ(report.rows[0].code, model::IssueCode::value_unreadable);
}

TEST(ConstructionDate, OfAShopMayBeTheBusinesss) {
  const float alone = built({{"building", "yes"}, {"start_date", "1995"}})->confidence;
  for (const auto& [key, value] : TagList{{"shop", "bakery"},
                                          {"amenity", "cafe"},
                                          {"office", "lawyer"},
                                          {"craft", "tailor"},
                                          {"tourism", "hotel"},
                                          {"tourism", "museum"}}) {
    EXPECT_FLOAT_EQ(built({{"building", "yes"}, {"start_date", "1995"}, {key, value}})->confidence, alone / 2) << key;
    EXPECT_FLOAT_EQ(built({{"building", "yes"}, {"building:start_date", "1995"}, {key, value}})->confidence, alone)
        << key;
  }
  EXPECT_FLOAT_EQ(built({{"building", "yes"}, {"start_date", "1995"}, {"tourism", "artwork"}})->confidence, alone);
  EXPECT_FLOAT_EQ(built({{"building", "yes"}, {"start_date", "1995"}, {"shop", "no"}})->confidence, alone);
}

}  // namespace
}  // namespace blockrand::importers::osm
