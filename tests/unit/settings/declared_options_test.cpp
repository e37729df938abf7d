// Every member of a stage's struct is an option, and every option finds its place among the others.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "pipeline/settings/options.h"
#include "tests/unit/settings/member_count.h"

namespace blockrand::settings {
namespace {

struct Example {
  std::string text;
  std::optional<double> number;
  bool flag = true;
  std::optional<std::array<double, 4>> box;
  repair::RepairOptions nested;
};
static_assert(member_count<Example>() == 5);
static_assert(member_count<repair::RepairOptions>() > 20);

TEST(DeclaredOptions, EveryMemberOfRepairAndGenerationIsOne) {
  EXPECT_EQ(repair::repair_options().size(), member_count<repair::RepairOptions>());
  EXPECT_EQ(attributes::generate_options().size(), member_count<attributes::GenerateOptions>());
}

TEST(DeclaredOptions, EveryMemberOfABuildIsOne) {
  std::size_t own = 0;
  std::set<std::string_view> stages;
  for (const auto& option : run::build_options()) {
    if (option.section == base::kMainSection)
      ++own;
    else
      stages.insert(option.section.name);
  }
  const std::size_t of_outputs = outputs::output_options().size();
  const std::size_t set_by_the_build = 3;  // whether there are images, pictures of them, surroundings
  EXPECT_EQ(of_outputs + set_by_the_build, member_count<outputs::OutputOptions>());
  const std::size_t of_a_region = 3;    // its earlier build, the settings that had, what changed since
  const std::size_t of_the_caller = 3;  // whether it only looks ahead, only counts; what people call the input
  const std::size_t of_imagery = observation::imagery_options().size();
  EXPECT_EQ(of_imagery, member_count<observation::ImageryOptions>());
  EXPECT_EQ(own - of_outputs - of_imagery + 2 + of_a_region + of_the_caller + stages.size(),
            member_count<run::BuildOptions>())
      << "the options of the outputs are one member, those of the images another, and so are those of each stage";
}

TEST(DeclaredOptions, EveryMemberOfValidationIsOne) {
  const std::size_t from_other_commands = 2;  // folder and jobs
  const std::size_t of_areas = 1;             // whether the extract was looked at
  EXPECT_EQ(validate::validate_options().size() + from_other_commands + of_areas,
            member_count<blockrand::validate::ValidateOptions>());
}

TEST(DeclaredOptions, EveryMemberOfPublishingIsOne) {
  EXPECT_EQ(outward::publish_options().size(), member_count<outward::PublishOptions>());
}

TEST(DeclaredOptions, PlacesAmongOthersExist) {
  std::map<std::string_view, std::size_t> place;
  for (const Option& o : options()) place.emplace(o.name, place.size());
  for (const Option& o : options())
    if (!o.after.empty()) {
      ASSERT_TRUE(place.contains(o.after)) << o.name << " stands behind " << o.after;
      EXPECT_GT(place[o.name], place[o.after]) << o.name;
      EXPECT_EQ(options()[place[o.after]].section, o.section) << o.name;
    }
}

TEST(DeclaredOptions, TheTableGoesSectionBySection) {
  std::vector<std::string_view> names;
  for (const base::OptionSection& section : sections()) names.push_back(section.name);
  EXPECT_EQ(names, (std::vector<std::string_view>{"build", "repair", "generate", "region", "gates", "publish",
                                                  "compare", "messages"}));
  for (const base::OptionSection& section : sections())
    EXPECT_EQ(in_config(section), section.name != "compare" && section.name != "messages") << section.name;
}

TEST(DeclaredOptions, PlacesInTheRecordAreTakenOnce) {
  std::set<std::pair<std::string_view, int>> taken;
  for (const auto& option : run::build_options())
    if (option.record_place != base::OptionDescription::kNoPlace) {
      EXPECT_TRUE(taken.emplace(option.section.name, option.record_place).second) << option.name;
      EXPECT_NE(option.record, base::OptionRecord::none) << option.name;
    }
}

}  // namespace
}  // namespace blockrand::settings
