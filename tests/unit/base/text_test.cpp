#include "pipeline/base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "pipeline/base/random.h"

namespace blockrand::base {
namespace {

TEST(Text, ThousandsAreGrouped) {
  EXPECT_EQ(with_thousands(0), "0");
  EXPECT_EQ(with_thousands(999), "999");
  EXPECT_EQ(with_thousands(1000), "1,000");
  EXPECT_EQ(with_thousands(1234567), "1,234,567");
  EXPECT_EQ(with_thousands(std::numeric_limits<std::uint64_t>::max()), "18,446,744,073,709,551,615");
}

TEST(Text, BytesHaveUnits) {
  EXPECT_EQ(with_byte_unit(17), "17 bytes");
  EXPECT_EQ(with_byte_unit(1'536'000), "1.5 MB");
  EXPECT_EQ(with_byte_unit(999'960), "1.0 MB");
  EXPECT_EQ(with_byte_unit(1'000'000'000), "1.0 GB");
}

TEST(Text, TimesHaveUnits) {
  EXPECT_EQ(with_time_unit(0.42), "0.4 s");
  EXPECT_EQ(with_time_unit(59.96), "1 min 0 s");
  EXPECT_EQ(with_time_unit(75.2), "1 min 15 s");
  EXPECT_EQ(with_time_unit(7260), "2 h 1 min");
  EXPECT_EQ(with_time_unit(std::nan("")), "?");
}

TEST(Shortest, IsWhatPeopleWrite) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(-0.0), "0");
  EXPECT_EQ(shortest(100000), "100000");
  EXPECT_EQ(shortest(-2.5), "-2.5");
  EXPECT_EQ(shortest(1.0 / 1024), "0.0009765625");
  EXPECT_EQ(shortest(1e300), "1e+300");
  EXPECT_EQ(shortest(5e-324), "5e-324");
}

TEST(Shortest, ReadsBackAsTheSameDouble) {
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const double scale = std::pow(10.0, static_cast<double>(i % 60) - 30);
    const double value = (random_unit(1, i, "shortest") - 0.5) * scale;
    EXPECT_EQ(std::strtod(shortest(value).c_str(), nullptr), value);
  }
}

TEST(JsonQuoted, EscapesAndMends) {
  EXPECT_EQ(json_quoted("a\"b\\c\n\t\x01"), R"("a\"b\\c\n\t\u0001")");
  EXPECT_EQ(json_quoted("Gründerzeit 𝄞"), "\"Gründerzeit 𝄞\"");
  EXPECT_EQ(json_quoted("\xFFz"), "\"\xEF\xBF\xBDz\"");
  EXPECT_EQ(json_quoted("\xC3"), "\"\xEF\xBF\xBD\"") << "cut off";
  EXPECT_EQ(json_quoted("\xC0\xAF"), "\"\xEF\xBF\xBD\xEF\xBF\xBD\"") << "overlong";
  EXPECT_EQ(json_quoted(std::string_view("\0", 1)), R"("\u0000")");
}

}  // namespace
}  // namespace blockrand::base
