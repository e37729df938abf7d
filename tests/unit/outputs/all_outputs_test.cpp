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
    EXPECT_NE(format.bytes_per_building, nullptr);
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
  const double always = bytes_per_building(options, 2);
  for (const OutputFormat& format : all_outputs()) {
    if (!format.in_formats) continue;
    SCOPED_TRACE(format.name);
    options.formats = {std::string(format.name)};
    for (const std::size_t lod : {0, 1, 2, 3}) EXPECT_GT(format.bytes_per_building(options, lod), 0) << lod;
    EXPECT_DOUBLE_EQ(bytes_per_building(options, 2) - always, format.bytes_per_building(options, 2));
  }
  // A level beyond the table is the nearest one.
  EXPECT_EQ(bytes_per_building(options, 4), bytes_per_building(options, 3));
}

}  // namespace
}  // namespace blockrand::outputs
