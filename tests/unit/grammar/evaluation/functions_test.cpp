// Every built-in function that needs no shape: documented values, clamps, what is missing, what is not a number.
#include "styles/grammar/evaluation/functions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "styles/grammar/evaluation/arrays.h"
#include "styles/grammar/language/known_names.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Value texts(std::vector<std::string> items) {
  const std::size_t count = items.size();
  return TextArray{std::move(items), count};
}
Value numbers(std::vector<double> items, std::size_t columns = 0) {
  if (columns == 0) columns = items.size();
  return NumberArray{std::move(items), columns};
}
Value truths(std::vector<std::uint8_t> items) {
  const std::size_t count = items.size();
  return TruthArray{std::move(items), count};
}
Value s(const char* text) { return std::string(text); }

/// The result as `str` writes it; errors as "error: …". Counts warnings in `warned`.
std::size_t warned = 0;
std::string run(std::string_view name, const std::vector<Value>& arguments) {
  std::vector<std::string> warnings;
  std::uint32_t draws = 0;
  FunctionContext context{1, &draws, nullptr, &warnings};
  const auto result = call(name, arguments, context);
  warned = warnings.size();
  return result ? value_text(*result) : "error: " + result.error();
}
double value(std::string_view name, const std::vector<Value>& arguments) {
  std::uint32_t draws = 0;
  FunctionContext context{1, &draws, nullptr, nullptr};
  return std::get<double>(call(name, arguments, context).value());
}
std::string binary(Operator op, const Value& a, const Value& b) {
  const auto result = apply_binary(op, a, b);
  return result ? value_text(*result) : "error: " + result.error();
}

TEST(NumberText, HasNoTrailingZerosAndNoNoise) {
  EXPECT_EQ(number_text(1.69 - 69.0 / 100), "1");
  EXPECT_EQ(number_text(1), "1");
  EXPECT_EQ(number_text(-0.0), "0");
  EXPECT_EQ(number_text(1.69), "1.69");
  EXPECT_EQ(number_text(3 * 0.15), "0.45");
  EXPECT_EQ(number_text(100000), "100000");
  EXPECT_EQ(number_text(123456.75), "123456.75");
  EXPECT_EQ(number_text(1.0 / 3), "0.333333333333333");
  EXPECT_EQ(number_text(0.001), "0.001");
  EXPECT_EQ(number_text(1e-9), "1e-09");
  EXPECT_EQ(number_text(1e21), "1e+21");
  EXPECT_EQ(number_text(-2.5), "-2.5");
  EXPECT_EQ(number_text(kNan), "nan");
  EXPECT_EQ(number_text(-kInfinity), "-inf");
}

TEST(ValueText, WritesArraysWithTheirSize) {
  EXPECT_EQ(value_text(numbers({1, 2, 3})), "(3)[1,2,3]");
  EXPECT_EQ(value_text(numbers({1, 2, 3, 4}, 2)), "(2x2)[1,2;3,4]");
  EXPECT_EQ(value_text(truths({1, 0})), "(2)[true,false]");
  EXPECT_EQ(value_text(TextArray{}), "(0)[]");
}

TEST(Maths, WorksInDegreesAndIsExactWhereTheResultIsRational) {
  EXPECT_EQ(value("sin", {30.0}), 0.5);
  EXPECT_EQ(value("sin", {-150.0}), -0.5);
  EXPECT_EQ(value("sin", {90.0}), 1);
  EXPECT_EQ(value("sin", {180.0}), 0);
  EXPECT_EQ(value("sin", {720.0}), 0);
  EXPECT_EQ(value("cos", {60.0}), 0.5);
  EXPECT_EQ(value("cos", {90.0}), 0);
  EXPECT_EQ(value("cos", {180.0}), -1);
  EXPECT_EQ(value("cos", {-120.0}), -0.5);
  EXPECT_NEAR(value("sin", {45.0}), std::sqrt(0.5), 2e-16);
  EXPECT_NEAR(value("sin", {200.0}), -0.3420201433256687, 1e-15);
  EXPECT_NEAR(value("tan", {45.0}), 1, 1e-15);
  EXPECT_EQ(value("tan", {90.0}), kInfinity);
  EXPECT_EQ(value("atan", {1.0}), 45);
  EXPECT_EQ(value("atan2", {1.0, -1.0}), 135);
  EXPECT_EQ(value("atan2", {0.0, 0.0}), 0);
  EXPECT_EQ(value("asin", {1.0}), 90);
  EXPECT_NEAR(value("acos", {0.5}), 60, 1e-13);
}

TEST(Maths, RoundsAndRaises) {
  EXPECT_EQ(value("rint", {0.5}), 0);
  EXPECT_EQ(value("rint", {1.5}), 2);
  EXPECT_EQ(value("rint", {-2.5}), -2);
  EXPECT_EQ(value("floor", {-0.5}), -1);
  EXPECT_EQ(value("ceil", {0.1}), 1);
  EXPECT_EQ(value("abs", {-3.0}), 3);
  EXPECT_EQ(value("sqrt", {16.0}), 4);
  EXPECT_EQ(value("pow", {2.0, 10.0}), 1024);
  EXPECT_EQ(value("log10", {1000.0}), 3);
  EXPECT_NEAR(value("log10", {2.0}), 0.30102999566398120, 1e-15);
  EXPECT_EQ(value("exp", {0.0}), 1);
  EXPECT_EQ(value("ln", {1.0}), 0);
  EXPECT_EQ(value("min", {3.0, 2.0}), 2);
  EXPECT_EQ(value("max", {3.0, 2.0}), 3);
  EXPECT_EQ(value("clamp", {5.0, 0.0, 2.0}), 2);
  EXPECT_EQ(value("clamp", {-5.0, 0.0, 2.0}), 0);
  EXPECT_EQ(value("clamp", {1.0, 3.0, 2.0}), 3) << "crossed bounds: the lower one";
  EXPECT_EQ(run("floor", {numbers({1.5, -1.5})}), "(2)[1,-2]");
  EXPECT_EQ(run("abs", {numbers({1, -1, 2, -2}, 2)}), "(2x2)[1,1;2,2]");
}

TEST(Maths, WhatIsNotDefinedIsNanWithAWarning) {
  for (const auto& [name, argument] : {std::pair{"acos", 1.5}, {"asin", -2.0}, {"sqrt", -1.0}}) {
    EXPECT_EQ(run(name, {argument}), "nan") << name;
    EXPECT_EQ(warned, 1u) << name;
  }
}

TEST(Maths, ReplacesNanByZeroWithAWarning) {
  EXPECT_EQ(run("abs", {kNan}), "0");
  EXPECT_EQ(warned, 1u);
  EXPECT_EQ(run("min", {kInfinity, 5.0}), "0");
  EXPECT_EQ(warned, 1u);
  EXPECT_EQ(run("sum", {numbers({1, kNan, 2})}), "3");
  EXPECT_EQ(run("isnan", {kNan}), "true") << "the tests themselves see it";
  EXPECT_EQ(run("isinf", {numbers({1, -kInfinity, kNan})}), "(3)[false,true,false]");
  EXPECT_EQ(run("str", {kInfinity}), "inf");
  EXPECT_EQ(run("float", {kInfinity}), "inf");
  EXPECT_EQ(warned, 0u);
}

TEST(Random, IsAFunctionOfSeedAndDraw) {
  std::uint32_t draws = 0;
  FunctionContext context{42, &draws, nullptr, nullptr};
  const double first = context.draw(), second = context.draw();
  EXPECT_NE(first, second);
  EXPECT_EQ(draws, 2u);
  draws = 1;
  EXPECT_EQ(context.draw(), second);
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const double drawn = std::get<double>(*call("rand", std::vector<Value>{2.0, 4.0}, context));
    EXPECT_GE(drawn, 2);
    EXPECT_LT(drawn, 4);
    sum += drawn;
  }
  EXPECT_NEAR(sum / 10000, 3, 0.02);
  EXPECT_EQ(run("p", {0.0}), "false");
  EXPECT_EQ(run("p", {-1.0}), "false");
  EXPECT_EQ(run("p", {1.0}), "true");
}

TEST(Conversions, FollowTheReference) {
  EXPECT_EQ(run("str", {true}), "true");
  EXPECT_EQ(run("float", {s("001.5")}), "1.5");
  EXPECT_EQ(run("float", {s("a")}), "nan");
  EXPECT_EQ(run("float", {s("5+6")}), "5");
  EXPECT_EQ(run("float", {s(" -2m")}), "-2");
  EXPECT_EQ(run("float", {s("+3")}), "3");
  EXPECT_EQ(run("float", {s("+-3")}), "nan");
  EXPECT_EQ(run("float", {s("")}), "nan");
  EXPECT_EQ(run("float", {s("1e999")}), "inf");
  EXPECT_EQ(run("float", {s("1e-999")}), "0");
  EXPECT_EQ(run("float", {true}), "1");
  for (const char* no : {"f", "false", "0", "0.0", "-0", "0.000"}) EXPECT_EQ(run("bool", {s(no)}), "false") << no;
  for (const char* yes : {"true", "1", "beneath", "0a", ""}) EXPECT_EQ(run("bool", {s(yes)}), "true") << yes;
  EXPECT_EQ(run("bool", {6.66}), "true");
  EXPECT_EQ(run("bool", {0.0}), "false");
  EXPECT_EQ(run("floatArray", {texts({"1.5", "-2", "0", "nixda", "5+6"})}), "(5)[1.5,-2,0,nan,5]");
  EXPECT_EQ(run("floatArray", {}), "(0)[]");
  EXPECT_EQ(run("floatArray", {truths({1, 0, 1})}), "(3)[1,0,1]");
  EXPECT_EQ(run("boolArray", {numbers({0, 2})}), "(2)[false,true]");
  EXPECT_EQ(run("stringArray", {numbers({0.5, 2})}), "(2)[0.5,2]");
  EXPECT_EQ(run("sel", {s("front")}), "front");
  EXPECT_EQ(run("isNull", {s("")}), "false");
}

TEST(Texts, AreSearchedAndCut) {
  EXPECT_EQ(run("substring", {s("0123456789"), -20.0, 5.0}), "01234");
  EXPECT_EQ(run("substring", {s("0123456789"), 3.0, 99.0}), "3456789");
  EXPECT_EQ(run("substring", {s("0123456789"), 5.0, 3.0}), "");
  EXPECT_EQ(run("find", {s("CE_Zero CE_One"), s("CE"), 1.0}), "8");
  EXPECT_EQ(run("find", {s("CE_Zero CE_One"), s("CE"), 2.0}), "-1");
  EXPECT_EQ(run("find", {s("abc"), s(""), 0.0}), "-1");
  EXPECT_EQ(run("find", {s("abc"), s("a"), -1.0}), "-1");
  EXPECT_EQ(run("count", {s("aaaa"), s("aa")}), "2");
  EXPECT_EQ(run("count", {s("aaaa"), s("")}), "0");
  EXPECT_EQ(run("len", {s("abc")}), "3");
  EXPECT_EQ(run("len", {s("Straße")}), "6") << "characters, not bytes";
  EXPECT_EQ(run("substring", {s("Grüße"), 2.0, 4.0}), "üß");
  EXPECT_EQ(run("find", {s("Größe 5"), s("5"), 0.0}), "6");
  EXPECT_EQ(run("len", {s("\xff\x80")}), "1") << "no UTF-8, and no crash";
  EXPECT_EQ(run("findFirst", {s("banana"), s("an")}), "1");
  EXPECT_EQ(run("findLast", {s("banana"), s("an")}), "3");
  EXPECT_EQ(run("findLast", {s("banana"), s("x")}), "-1");
  EXPECT_EQ(run("getPrefix", {s("rule your city with cityengine"), s("city")}), "rule your ");
  EXPECT_EQ(run("getPrefix", {s("abc"), s("x")}), "");
  EXPECT_EQ(run("getSuffix", {s("rule your city with cityengine"), s("city")}), "engine");
  EXPECT_EQ(run("getRange", {s("a.b.c"), s("."), s(".")}), "b");
  EXPECT_EQ(run("getRange", {s("myTexture.hasName.001.jpg"), s("."), s(".")}), "hasName.001");
  EXPECT_EQ(run("getRange", {s("CityEngine"), s("CityEn"), s("tyEngine")}), "");
  EXPECT_EQ(run("replace", {s("a.b.c"), s("."), s("--")}), "a--b--c");
  EXPECT_EQ(run("replace", {s("abc"), s(""), s("x")}), "abc");
}

TEST(Texts, AreSplitByTextAndPattern) {
  EXPECT_EQ(run("splitString", {s("a.b.c"), s(".")}), "(3)[a,b,c]");
  EXPECT_EQ(run("splitString", {s(".b."), s(".")}), "(3)[,b,]");
  EXPECT_EQ(run("splitString", {s("abc"), s("")}), "(5)[,a,b,c,]");
  EXPECT_EQ(run("splitString", {s("a b  c"), s("$\\s+")}), "(3)[a,b,c]");
  EXPECT_EQ(run("splitString", {s("a;b\nc"), s("$;|\n")}), "(3)[a,b,c]");
  EXPECT_EQ(run("splitString", {s("abc"), s("$\\B")}), "(3)[a,b,c]");
  EXPECT_EQ(run("splitString", {s("a$b"), s("$\\$")}), "(2)[a,b]");
  EXPECT_THAT(run("splitString", {s("abc"), s("$(")}), testing::HasSubstr("error: '('"));
  EXPECT_EQ(run("splitString", {Value(std::string(2000, 'a')), s("$(a*)*b")}).substr(0, 4), "(1)[")
      << "a pattern that is exponential for others";
}

TEST(Lists, FollowTheUtilityLibrary) {
  EXPECT_EQ(run("listItem", {s("rule;your;city;"), 2.0}), "city");
  EXPECT_EQ(run("listItem", {s("rule;your;city"), 2.0}), "city") << "the last ; may be missing";
  EXPECT_EQ(run("listItem", {s("rule;your;city;"), 3.0}), "");
  EXPECT_EQ(run("listItem", {s("rule;your;city;"), -1.0}), "");
  EXPECT_EQ(run("listAdd", {s("rule;your;"), s("city")}), "rule;your;city;");
  EXPECT_EQ(run("listAdd", {s("rule;your;"), s("city;")}), "rule;your;city;");
  EXPECT_EQ(run("listAdd", {s(""), s("a")}), "a;");
  EXPECT_EQ(run("listClean", {s(";;;;;my;city;rules;;your;;city;;")}), "my;city;rules;your;city;");
  EXPECT_EQ(run("listClean", {s(";;cityengine;;;rules")}), "cityengine;rules;");
  EXPECT_EQ(run("listCount", {s("a;b;a;"), s("a")}), "2");
  EXPECT_EQ(run("listFirst", {s("a;b;")}), "a");
  EXPECT_EQ(run("listFirst", {s("")}), "");
  EXPECT_EQ(run("listLast", {s("a;b;")}), "b");
  EXPECT_EQ(run("listLast", {s("")}), "");
  EXPECT_EQ(run("listIndex", {s("rule;your;city;"), s("*y")}), "2");
  EXPECT_EQ(run("listIndex", {s("rule;your;city;"), s("*y*")}), "1");
  EXPECT_EQ(run("listIndex", {s("rule;your;city;"), s("y*")}), "1");
  EXPECT_EQ(run("listIndex", {s("rule;your;city;"), s("*")}), "0");
  EXPECT_EQ(run("listIndex", {s("rule;your;city;"), s("town")}), "-1");
  EXPECT_EQ(run("listRange", {s("rule;your;city;with;cityengine;"), 0.0, 3.0}), "rule;your;city;");
  EXPECT_EQ(run("listRange", {s("a;b;c;"), 1.0, 99.0}), "b;c;");
  EXPECT_EQ(run("listRange", {s("a;b;c;"), 2.0, 1.0}), "");
  EXPECT_EQ(run("listRemove", {s("a;b;a;"), s("a")}), "b;a;");
  EXPECT_EQ(run("listRemoveAll", {s("rule;your;designs;and;your;cities;"), s("your")}), "rule;designs;and;cities;");
  EXPECT_EQ(run("listRemoveAll", {s("rule;your;designs;and;your;cities;"), s("*u*")}), "designs;and;cities;");
  EXPECT_EQ(run("listRetainAll", {s("rule;your;designs;and;your;cities;"), s("*s")}), "designs;cities;");
  EXPECT_EQ(run("listSize", {s("a;b;c;")}), "3");
  EXPECT_EQ(run("listSize", {s("")}), "0");
  EXPECT_EQ(run("listTerminate", {s("a;b")}), "a;b;");
  EXPECT_EQ(run("listTerminate", {s("a;b;")}), "a;b;");
  EXPECT_EQ(run("listToArray", {s("a;b;")}), "(2)[a,b]");
  EXPECT_EQ(run("listFromArray", {numbers({1, 2, 3})}), "1;2;3;");
  EXPECT_EQ(run("listFromArray", {truths({1, 0})}), "true;false;");
  EXPECT_EQ(run("listFromArray", {texts({"a", "b"})}), "a;b;");
  std::set<std::string> seen;
  std::uint32_t draws = 0;
  FunctionContext context{7, &draws, nullptr, nullptr};
  for (int i = 0; i < 100; ++i) seen.insert(value_text(*call("listRandom", std::vector<Value>{s("a;b;c;")}, context)));
  EXPECT_THAT(seen, testing::ElementsAre("a", "b", "c"));
  EXPECT_EQ(run("listRandom", {s("")}), "");
}

TEST(Colours, ConvertBothWays) {
  EXPECT_EQ(run("colorHexToH", {s("#608040")}), "90");
  EXPECT_EQ(run("colorHSVToHex", {90.0, 0.5, 0.5}), "#608040");
  EXPECT_EQ(run("colorHSVToHex", {450.0, 0.5, 0.5}), "#608040");
  EXPECT_EQ(run("colorHSVToHex", {-270.0, 0.5, 0.5}), "#608040");
  EXPECT_EQ(run("colorHSVToHex", {0.0, 5.0, 5.0}), "#ff0000");
  EXPECT_EQ(run("colorHSVOToHex", {240.0, 1.0, 1.0, 0.5}), "#0000ff80");
  EXPECT_EQ(run("colorRGBToHex", {1.0, -1.0, 0.5}), "#ff0080");
  EXPECT_EQ(run("colorRGBOToHex", {1.0, 0.0, 0.5, 1.0}), "#ff0080ff");
  EXPECT_EQ(value("colorHexToR", {s("#FF8000")}), 1);
  EXPECT_EQ(value("colorHexToG", {s("#FF8000")}), 128 / 255.0);
  EXPECT_EQ(value("colorHexToB", {s("#FF8000")}), 0);
  EXPECT_EQ(value("colorHexToO", {s("#FF8000")}), 1);
  EXPECT_EQ(value("colorHexToO", {s("#FF800000")}), 0);
  EXPECT_EQ(value("colorHexToS", {s("#808080")}), 0);
  EXPECT_EQ(value("colorHexToH", {s("#0000ff")}), 240);
  EXPECT_EQ(value("colorHexToV", {s("#000000")}), 0);
  EXPECT_EQ(run("colorHexToR", {s("red")}), "error: 'red' is no colour (#rrggbb)");
  EXPECT_EQ(run("colorRamp", {s("whiteToBlack"), 0.0}), "#ffffff");
  EXPECT_EQ(run("colorRamp", {s("whiteToBlack"), 9.0}), "#000000");
  EXPECT_EQ(run("colorRamp", {s("yellowToRed"), 0.5}), "#ff8000");
  for (const char* ramp : {"greenToRed", "redToBlue", "orangeToBlue", "brownToBlue", "spectrum"})
    EXPECT_NE(run("colorRamp", {s(ramp), 0.0}), run("colorRamp", {s(ramp), 1.0})) << ramp;
  EXPECT_THAT(run("colorRamp", {s("rainbow"), 0.0}), testing::StartsWith("error: 'rainbow'"));
}

TEST(Files, ArePlaceholdersWithoutAccess) {
  EXPECT_EQ(run("fileExists", {s("a.obj")}), "false");
  EXPECT_EQ(run("fileSearch", {s("*.obj")}), "placeholder;");
  EXPECT_EQ(run("filesSearch", {s("*.obj")}), "(1)[placeholder]");
  EXPECT_EQ(run("fileRandom", {s("*.obj")}), "placeholder");
  EXPECT_EQ(run("imageBestRatio", {s("*.jpg"), s("xy"), 1.0}), "placeholder");
  EXPECT_EQ(run("assetInfo", {s("a.obj"), s("sx")}), "1");
  EXPECT_EQ(run("assetInfo", {s("a.obj"), s("ty")}), "0");
  EXPECT_EQ(run("imageInfo", {s("a.jpg"), s("sy")}), "1");
  EXPECT_EQ(run("readTextFile", {s("a.txt")}), "");
  EXPECT_EQ(warned, 1u);
  EXPECT_EQ(run("fileBasename", {s("assets/obj/mygeometry.01.obj")}), "mygeometry.01");
  EXPECT_EQ(run("fileDirectory", {s("assets/obj/mygeometry.01.obj")}), "assets/obj/");
  EXPECT_EQ(run("fileExtension", {s("assets/obj/mygeometry.01.obj")}), "obj");
  EXPECT_EQ(run("fileExtension", {s("a.b/c")}), "");
  EXPECT_EQ(run("fileName", {s("assets/obj/mygeometry.01.obj")}), "mygeometry.01.obj");
}

TEST(Files, AreReadThroughTheAccess) {
  FileAccess files;
  files.exists = [](const std::string& path) { return path == "a.csv"; };
  files.search = [](const std::string&) { return std::vector<std::string>{"a", "b"}; };
  files.read = [](const std::string&) { return std::optional<std::string>("1,\"x,\"\"y\"\"\"\r\n2.5\n\n"); };
  files.asset = [](const std::string&) { return std::optional<AssetBox>({{3, 6, 2}, {1, 1, 1}}); };
  files.image = [](const std::string&) { return std::optional<Vector2>({512, 256}); };
  std::uint32_t draws = 0;
  FunctionContext context{1, &draws, &files, nullptr};
  const auto answer = [&](std::string_view name, const std::vector<Value>& arguments) {
    return value_text(*call(name, arguments, context));
  };
  EXPECT_EQ(answer("fileExists", {s("a.csv")}), "true");
  EXPECT_EQ(answer("fileSearch", {s("*")}), "a;b;");
  EXPECT_EQ(answer("readStringTable", {s("a.csv")}), "(2x2)[1,x,\"y\";2.5,]");
  EXPECT_EQ(answer("readFloatTable", {s("a.csv")}), "(2x2)[1,nan;2.5,nan]");
  EXPECT_EQ(answer("assetInfo", {s("a"), s("sy")}), "6");
  EXPECT_EQ(answer("assetInfo", {s("a"), s("tz")}), "1");
  EXPECT_EQ(answer("imageInfo", {s("a"), s("sx")}), "512");
  std::set<std::string> seen;
  for (int i = 0; i < 50; ++i) seen.insert(answer("fileRandom", {s("*")}));
  EXPECT_EQ(seen.size(), 2u);
}

TEST(Arrays, RangesEndBeforeTheLimit) {
  const auto range = [](double a, double b, double c) { return value_text(*make_range(a, b, c)); };
  EXPECT_EQ(range(1, 2, 5), "(3)[1,3,5]");
  EXPECT_EQ(range(4, -1, 2), "(3)[4,3,2]");
  EXPECT_EQ(range(0.5, 1, 3), "(3)[0.5,1.5,2.5]");
  EXPECT_EQ(range(4, 1, 2), "(0)[]");
  EXPECT_EQ(range(1, -0.5, 2), "(0)[]");
  EXPECT_EQ(range(1, -0.5, 1), "(1)[1]");
  EXPECT_EQ(range(1, 0, 1), "(0)[]");
  EXPECT_EQ(range(0, 0.1, 1), "(11)[0,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1]");
  EXPECT_FALSE(make_range(0, 1e-9, 1));
  EXPECT_FALSE(make_range(0, 1, kInfinity));
}

TEST(Arrays, LiteralsJoinWhatTheyHold) {
  const auto made = [](const std::vector<std::vector<Value>>& rows) {
    const auto result = make_array(rows);
    return result ? value_text(*result) : "error: " + result.error();
  };
  const Value column = NumberArray{{-1, -2}, 1}, table = numbers({0, 1, 2, 3, 3, 3}, 3);
  EXPECT_EQ(made({{s("A"), texts({"B", "C"}), s("E")}}), "(4)[A,B,C,E]");
  EXPECT_EQ(made({{column, table}, {table, column}}), "(4x4)[-1,0,1,2;-2,3,3,3;0,1,2,-1;3,3,3,-2]");
  EXPECT_EQ(made({{numbers({0, 1, 2})}, {3.0}}), "(2x3)[0,1,2;3,0,0]") << "what is missing is 0";
  EXPECT_EQ(made({{1.0, true}}), "error: an array holds numbers or truth values, not both");
  EXPECT_EQ(made({{true, false}}), "(2)[true,false]");
}

TEST(Arrays, AreIndexedInEveryWay) {
  const Value row = numbers({1, 2, 3, 4}), table = numbers({1, 2, 3, 4, 5, 6, 7, 8, 9}, 3);
  const auto at = [](const Value& array, const Value& index) { return value_text(*index_value(array, index)); };
  const auto at2 = [](const Value& array, const Value& y, const Value& x) {
    return value_text(*index_value(array, y, x));
  };
  EXPECT_EQ(at(row, 3.0), "4");
  EXPECT_EQ(at(row, -1.0), "0");
  EXPECT_EQ(at(row, kNan), "0");
  EXPECT_EQ(at(texts({"a"}), 1.0), "");
  EXPECT_EQ(at(truths({1}), 4.0), "false");
  EXPECT_EQ(at(row, numbers({0, 2})), "(2)[1,3]");
  EXPECT_EQ(at(row, numbers({0, 1, 2, 3}, 2)), "(2x2)[1,2;3,4]");
  EXPECT_EQ(at(row, truths({0, 0, 1, 1, 1})), "(3)[3,4,0]");
  EXPECT_EQ(at(table, 3.0), "4") << "row by row";
  EXPECT_EQ(at2(numbers({1, 2, 3, 4}, 2), 1.0, 0.0), "3");
  EXPECT_EQ(at2(table, 1.0, numbers({0, 2})), "(2)[4,6]");
  EXPECT_EQ(at2(table, numbers({0, 0, 1}), 2.0), "(3x1)[3;3;6]");
  EXPECT_EQ(at2(table, numbers({0, 1, 2}), numbers({0, 2})), "(3x2)[1,3;4,6;7,9]");
  EXPECT_EQ(at2(table, truths({0, 1, 1}), 0.0), "(2x1)[4;7]");
  EXPECT_EQ(at2(table, numbers({2, 3}), numbers({-1, 0, 1})), "(2x3)[0,7,8;0,0,0]");
  EXPECT_EQ(at2(NumberArray{}, numbers({1, 2}), numbers({1, 2, 3})), "(2x3)[0,0,0;0,0,0]");
  EXPECT_FALSE(index_value(1.0, 0.0));
  EXPECT_FALSE(index_value(row, s("a")));
}

TEST(Arrays, HaveFunctions) {
  const Value table = numbers({4, 0, 1, 2, 1, 9, 1, 3, 0, 2, 1, 0}, 3);
  EXPECT_EQ(run("size", {table}), "12");
  EXPECT_EQ(run("nRows", {table}), "4");
  EXPECT_EQ(run("nColumns", {table}), "3");
  EXPECT_EQ(run("nRows", {NumberArray{}}), "0");
  EXPECT_EQ(run("sortRowIndices", {table}), "(4)[2,3,1,0]");
  EXPECT_EQ(run("sortIndices", {numbers({3, 1, 2, 1})}), "(4)[1,3,2,0]");
  EXPECT_EQ(run("sortIndices", {texts({"b", "a"})}), "(2)[1,0]");
  EXPECT_EQ(run("transpose", {numbers({1, 2, 3, 4, 5, 6}, 3)}), "(3x2)[1,4;2,5;3,6]");
  EXPECT_EQ(run("sum", {truths({1, 0, 1})}), "2");
  EXPECT_EQ(run("findFirst", {numbers({6, 8.1, 6, 8.1}), 8.0, 0.5}), "1");
  EXPECT_EQ(run("findFirst", {texts({"a", "b"}), s("b")}), "1");
  EXPECT_EQ(run("findFirst", {truths({0, 0}), true}), "-1");
  const Value zeros = numbers({0, 0, 0, 0, 0, 0});
  EXPECT_EQ(run("setElems", {zeros, 2.0, 1.0}), "(6)[0,0,1,0,0,0]");
  EXPECT_EQ(run("setElems", {zeros, numbers({5, 1, 3}), numbers({1, 2, 3})}), "(6)[0,2,0,3,0,1]");
  EXPECT_EQ(run("setElems", {zeros, numbers({1, 1, 1}), numbers({1, 2, 3})}), "(6)[0,3,0,0,0,0]");
  EXPECT_EQ(run("setElems",
                {numbers({0, 0, 0, 0, 0, 0, 0, 0, 0}, 3), numbers({1, 2}), numbers({0, 2}), numbers({1, 2, 3, 4}, 2)}),
            "(3x3)[0,0,0;1,0,2;3,0,4]");
  EXPECT_EQ(run("setElems", {numbers({1, 1}), -1.0, 5.0}), "(2)[1,1]");
  EXPECT_EQ(run("setElems", {numbers({1, 1}), 3.0, 5.0}), "(4)[1,1,0,5]");
  EXPECT_THAT(run("setElems", {zeros, numbers({1, 2}), numbers({1, 2, 3})}), testing::StartsWith("error"));
  EXPECT_THAT(run("setElems", {zeros, 1e9, 1.0}), testing::StartsWith("error"));
}

TEST(Operators, OfSingleValues) {
  EXPECT_EQ(binary(Operator::modulo, -5.0, 3.0), "-2");
  EXPECT_EQ(binary(Operator::divide, 1.0, 0.0), "inf");
  EXPECT_EQ(binary(Operator::add, s("h="), 3.0), "h=3");
  EXPECT_EQ(binary(Operator::add, 1.0, s("th")), "1th");
  EXPECT_EQ(binary(Operator::add, s("a"), true), "atrue");
  EXPECT_EQ(binary(Operator::add, s("a: "), numbers({1, 2})), "a: (2)[1,2]");
  EXPECT_EQ(binary(Operator::less, s("a"), s("b")), "true");
  EXPECT_EQ(binary(Operator::equal, true, true), "true");
  EXPECT_EQ(binary(Operator::equal, kNan, kNan), "false") << "as IEEE";
  EXPECT_EQ(binary(Operator::not_equal, kNan, kNan), "true");
  EXPECT_EQ(binary(Operator::less, kNan, 1.0), "false");
  EXPECT_EQ(binary(Operator::subtract, s("a"), 1.0), "error: - does not go with a text and a number");
  EXPECT_EQ(binary(Operator::add, true, 1.0), "error: + does not go with a truth value and a number");
  EXPECT_EQ(value_text(*apply_unary(Operator::negate, 2.0)), "-2");
  EXPECT_EQ(value_text(*apply_unary(Operator::logical_not, true)), "false");
  EXPECT_FALSE(apply_unary(Operator::negate, s("a")));
}

TEST(Operators, OfArraysAndTheirElements) {
  const Value column = NumberArray{{1, 2}, 1};
  EXPECT_EQ(binary(Operator::equal, numbers({1, 2}), numbers({1, 2})), "true");
  EXPECT_EQ(binary(Operator::not_equal, numbers({1, 2}), column), "true");
  EXPECT_EQ(binary(Operator::less, numbers({1, 2}), numbers({1, 3})), "true");
  EXPECT_EQ(binary(Operator::greater_equal, numbers({1, 2, 3}), numbers({1, 2})), "true");
  EXPECT_EQ(binary(Operator::each_add, numbers({1, 2}), 1.0), "(2)[2,3]");
  EXPECT_EQ(binary(Operator::each_subtract, 3.0, numbers({1, 2})), "(2)[2,1]");
  EXPECT_EQ(binary(Operator::each_multiply, numbers({1, 2, 3, 4}, 2), numbers({4, 3, 2, 1}, 2)), "(2x2)[4,6;6,4]");
  EXPECT_EQ(binary(Operator::each_modulo, NumberArray{{8, -5, 0}, 1}, 3.0), "(3x1)[2;-2;0]");
  EXPECT_EQ(binary(Operator::each_greater, numbers({1, 2, 3}), 2.0), "(3)[false,false,true]");
  EXPECT_EQ(binary(Operator::each_less_equal, texts({"a", "c"}), s("b")), "(2)[true,false]");
  EXPECT_EQ(binary(Operator::each_and, truths({1, 0}), true), "(2)[true,false]");
  EXPECT_EQ(binary(Operator::each_or, false, truths({0, 1})), "(2)[false,true]");
  EXPECT_EQ(binary(Operator::each_equal, 1.0, numbers({1, 2})), "(2)[true,false]");
  EXPECT_EQ(binary(Operator::each_add, texts({"a", "b"}), numbers({1, 2})), "(2)[a1,b2]");
  EXPECT_THAT(binary(Operator::each_add, numbers({1, 2}), numbers({1, 2, 3})), testing::HasSubstr("same rows"));
}

TEST(Functions, WrongCallsAreTold) {
  EXPECT_EQ(run("sine", {1.0}), "error: there is no function sine");
  EXPECT_EQ(run("sin", {s("a"), true}), "error: no sin takes (text, truth value)");
}

/// What the evaluator answers itself, since it needs a shape or the tree.
bool needs_shape(std::string_view name) {
  static const std::set<std::string_view> kOthers = {"comp",           "isTagged",        "inside",      "overlaps",
                                                     "touches",        "minimumDistance", "print",       "contextCount",
                                                     "contextCompare", "convert",         "getGeoCoord", "getTreeKey"};
  return name.starts_with("geometry.") || name.starts_with("edgeAttr.") || kOthers.count(name) > 0;
}

TEST(Functions, EveryNameOfTheLanguageIsThere) {
  for (const BuiltIn& entry : built_ins())
    if (entry.kind == NameKind::function && entry.status != Status::not_yet && !needs_shape(entry.name)) {
      EXPECT_FALSE(find_functions(entry.name).empty()) << entry.name;
    }
  for (const FunctionEntry& entry : functions())
    EXPECT_NE(find_built_in(NameKind::function, entry.name), nullptr) << entry.name;
}

}  // namespace
}  // namespace blockrand::grammar
