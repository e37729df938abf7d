// The list of outputs: whoever adds a format and leaves something out is told here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {
namespace {

using testing::IsEmpty;
using testing::Not;

/// Nothing at all is asked for.
OutputOptions no_output() {
  OutputOptions options;
  options.formats.clear();
  options.report = options.explain = false;
  return options;
}

TEST(AllOutputs, EachIsWhole) {
  std::set<std::string_view> names;
  for (const OutputFormat& format : all_outputs()) {
    SCOPED_TRACE(format.name);
    EXPECT_THAT(format.name, Not(IsEmpty()));
    EXPECT_TRUE(names.insert(format.name).second) << "stands twice";
    for (const std::string_view other : format.other_names) EXPECT_TRUE(names.insert(other).second) << other;
    EXPECT_THAT(format.manual, Not(IsEmpty())) << "the manual says nothing of its files";
    EXPECT_NE(format.asked, nullptr);
    EXPECT_NE(format.size, nullptr);
    EXPECT_NE(format.open, nullptr);
  }
}

TEST(AllOutputs, FormatsAreThoseOfTheOption) {
  for (const OutputFormat& format : all_outputs()) {
    SCOPED_TRACE(format.name);
    OutputOptions options = no_output();
    if (!format.in_formats) continue;
    EXPECT_FALSE(format.asked(options));
    EXPECT_THAT(format_names(), testing::Contains(std::string(format.name)));
    options.formats = {std::string(format.name)};
    EXPECT_TRUE(format.asked(options)) << "--formats has no effect";
    EXPECT_TRUE(options.writes(format.name));
  }
}

TEST(AllOutputs, DiskEstimateIsTheSumOfWhatIsAsked) {
  OutputOptions options = no_output();
  const BuiltSize town{100, 20'000};
  const double always = output_size(options, 2).bytes(town);
  for (const OutputFormat& format : all_outputs()) {
    if (!format.in_formats) continue;
    SCOPED_TRACE(format.name);
    options.formats = {std::string(format.name)};
    for (const std::size_t lod : {0, 1, 2, 3}) EXPECT_GT(format.size(options, lod).per_building, 0) << lod;
    EXPECT_DOUBLE_EQ(output_size(options, 2).bytes(town) - always, format.size(options, 2).bytes(town));
    EXPECT_EQ(format.size(options, 2).per_wall, 0) << "no windows without facades";
  }
  // A level beyond the table is the nearest one.
  EXPECT_EQ(output_size(options, 4).bytes(town), output_size(options, 3).bytes(town));
}

}  // namespace
}  // namespace blockrand::outputs
