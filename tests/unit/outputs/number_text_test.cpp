#include "pipeline/outputs/number_text.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <random>

#include "pipeline/model/point.h"
#include "pipeline/outputs/gltf/linear_light.h"

namespace blockrand::outputs {
namespace {

std::string grid(double v) {
  std::string out;
  append_grid(out, v);
  return out;
}

double parsed(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(error == std::errc() && end == text.data() + text.size()) << text;
  return value;
}

TEST(AppendTenThousandths, TakesLengthsOfEverySignAndSize) {
  const auto text = [](std::int64_t steps) {
    std::string out;
    append_ten_thousandths_of_a_metre(out, steps);
    return out;
  };
  EXPECT_EQ(text(0), "0");
  EXPECT_EQ(text(-5500), "-0.55");
  EXPECT_EQ(text(22000), "2.2");
  EXPECT_EQ(text(-120346), "-12.0346");
  EXPECT_EQ(text(10001), "1.0001");
}

TEST(AppendGrid, WritesShortDecimals) {
  EXPECT_EQ(grid(0), "0");
  EXPECT_EQ(grid(-0.0), "0");
  EXPECT_EQ(grid(1), "1");
  EXPECT_EQ(grid(-12.5), "-12.5");
  EXPECT_EQ(grid(391000.25), "391000.25");
  EXPECT_EQ(grid(1.0 / 1024), "0.001");   // 0.0009765625
  EXPECT_EQ(grid(3.0 / 1024), "0.0029");  // 0.0029296875
  EXPECT_EQ(grid(-1.0 / 1024), "-0.001");
  EXPECT_EQ(grid(1023.0 / 1024), "0.999");  // 0.9990234375
  EXPECT_EQ(grid(5819000 + 1.0 / 512), "5819000.002");
}

TEST(AppendGrid, RandomGridPointsComeBackToTheirGridPoint) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200000; ++i) {
    const auto steps = static_cast<std::int64_t>(random() % (std::uint64_t{1} << 34)) - (std::int64_t{1} << 33);
    const double value = static_cast<double>(steps) / 1024;
    const std::string text = grid(value);
    const double back = parsed(text);
    ASSERT_LE(std::abs(back - value), 0.00005001) << text;
    ASSERT_EQ(model::snap(back), value) << text;
    ASSERT_NE(text, grid(value + 1.0 / 1024));
    if (text.find('.') != std::string::npos) {
      ASSERT_NE(text.back(), '0') << text;
      ASSERT_LE(text.size() - text.find('.'), 5u) << text;
    }
  }
}

TEST(AppendNumber, IsShortestAndRoundTrips) {
  const auto text = [](auto v) {
    std::string out;
    append_number(out, v);
    return out;
  };
  EXPECT_EQ(text(0.1), "0.1");
  EXPECT_EQ(text(-0.0), "0");
  EXPECT_EQ(text(0.1f), "0.1");
  EXPECT_EQ(text(std::int64_t{-42}), "-42");
  std::mt19937_64 random(2);
  for (int i = 0; i < 10000; ++i) {
    const double v = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 100) - 80);
    ASSERT_EQ(parsed(text(v)), v);
  }
}

TEST(AppendXml, EscapesMarkupAndWhitespace) {
  std::string out;
  append_xml(out, "a<b>&\"c'\t\n\r\xF0\x9F\x8F\xA0 ]]>");
  EXPECT_EQ(out, "a&lt;b&gt;&amp;&quot;c'&#9;&#10;&#13;\xF0\x9F\x8F\xA0 ]]&gt;");
}

TEST(AppendClean, ReplacesWhatXmlForbids) {
  const auto clean = [](std::string_view text) {
    std::string out;
    append_clean(out, text);
    return out;
  };
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_EQ(clean(std::string_view("a\0b", 3)), "a" + mark + "b");
  EXPECT_EQ(clean("\x01\x1F"), mark + mark);
  EXPECT_EQ(clean("\xFF"), mark);                                   // no UTF-8
  EXPECT_EQ(clean("\xC3"), mark);                                   // cut off
  EXPECT_EQ(clean("\xC0\xAF"), mark + mark);                        // overlong
  EXPECT_EQ(clean("\xED\xA0\x80"), mark + mark + mark);             // surrogate
  EXPECT_EQ(clean("\xEF\xBF\xBF"), mark + mark + mark);             // U+FFFF
  EXPECT_EQ(clean("\xF4\x90\x80\x80"), mark + mark + mark + mark);  // beyond U+10FFFF
  EXPECT_EQ(clean("Stra\xC3\x9F"
                  "e \xE2\x82\xAC"),
            "Stra\xC3\x9F"
            "e \xE2\x82\xAC");
}

TEST(AppendJson, EscapesQuotesAndControls) {
  std::string out;
  append_json(out, "a\"b\\c\n\t\r\x02");
  EXPECT_EQ(out, "\"a\\\"b\\\\c\\n\\t\\r\xEF\xBF\xBD\"");
}

TEST(Address, JoinsWhatIsThere) {
  Address a;
  EXPECT_TRUE(a.empty());
  EXPECT_EQ(a.line(), "");
  a.street = "Kastanienallee";
  a.house_number = "12";
  EXPECT_EQ(a.line(), "Kastanienallee 12");
  a.postcode = "10435";
  a.city = "Berlin";
  EXPECT_EQ(a.line(), "Kastanienallee 12, 10435 Berlin");
  a.postcode = {};
  EXPECT_EQ(a.line(), "Kastanienallee 12, Berlin");
}

TEST(LinearLight, IsTheTransferFunction) {
  EXPECT_EQ(kLinearLight[0], 0);
  EXPECT_EQ(kLinearLight[255], 65535);
  EXPECT_EQ(kLinearLight[128], 14146);  // 0.21586050…
  EXPECT_EQ(kLinearLight[10], 199);     // still on the straight piece: 10/255/12.92
  for (int i = 0; i < 256; ++i) {
    const double c = i / 255.0;
    const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(kLinearLight[static_cast<std::size_t>(i)], linear * 65535, 0.5 + 1e-6) << i;
  }
}

}  // namespace
}  // namespace blockrand::outputs
