// The profile language: golden program G1 of docs/sources.md, Finkenzeller 3.14, errors with their places, scaling,
// sections, presets.
#include "styles/elements/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/random.h"
#include "styles/elements/mesh_builder.h"
#include "styles/elements/profile_library.h"
#include "tests/unit/elements/shipped_elements.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using testing::HasSubstr;

constexpr const char* kGolden = R"(Modifications {
  line, rel, 90, .3;   line, rel, -90, 10;  line, rel, 90, .6;  line, rel, -90, 11; line, rel, 90, .6;
  line, rel, -90, .6;  line, rel, 90, .6;   line, rel, -90, 2;  line, rel, 90, 2;
  arc, rel, 0, -90, 4;
  line, rel, 90, 5;    line, rel, -90, 5;   line, rel, 90, .6;  line, rel, -90, .6; line, rel, 45, 7;
  line, rel, -45, .6;  line, rel, 90, .6;   line, rel, -90, 2;  line, rel, -84, 22;
})";

ProfileProgram parsed(const char* text) {
  const auto program = parse_profile(text);
  EXPECT_TRUE(program.has_value()) << program.error().text();
  return program.value();
}

TEST(ProfileLanguage, DrawsTheGoldenMainCornice) {
  const auto program = parse_profile(kGolden);
  ASSERT_TRUE(program.has_value()) << program.error().text();
  ASSERT_EQ(program->commands.size(), 19u);
  for (const int steps : {1, 4, 16}) {
    const Profile p = trace(*program, steps);
    const Point2 after_arc = p.points[9 + static_cast<std::size_t>(steps)];
    EXPECT_NEAR(after_arc.x, 8.1, 1e-9);
    EXPECT_NEAR(after_arc.y, 27.6, 1e-9);
    EXPECT_NEAR(p.projection(), 19.2497, 5e-5);
    EXPECT_NEAR(p.points.back().x, -2.6297, 5e-5);
    EXPECT_NEAR(p.points.back().y, 43.0494, 5e-5);
    EXPECT_NEAR(p.heading, -84, 1e-9);
    EXPECT_NEAR(p.projection() / p.height(), 0.447, 5e-4);
  }
}

TEST(ProfileLanguage, AbsoluteAndRelativeHeadingsDiffer) {
  const Profile relative = trace(parsed("Modifications { line, rel, 90, 1; line, rel, 90, 1; }"));
  EXPECT_NEAR(relative.points.back().y, -1, 1e-12) << "right, then down";
  const Profile absolute = trace(parsed("Modifications { line, abs, 90, 1; line, abs, 90, 1; }"));
  EXPECT_NEAR(absolute.points.back().x, 2, 1e-12);
}

TEST(ProfileLanguage, ArcsStartTangentiallyAndTurnTheHeading) {
  // G2: its program ends at (0.6364, 0.3364) with heading 45 after the arc and a line.
  const Profile p =
      trace(parsed("Modifications { line, rel, 0, 0.2; arc, abs, 90, 45, 0.5; line, rel, -90, 0.4; }"), 8);
  EXPECT_NEAR(p.points.back().x, 0.6364, 5e-5);
  EXPECT_NEAR(p.points.back().y, 0.3364, 5e-5);
  EXPECT_NEAR(p.heading, 45, 1e-9);
}

TEST(ProfileLanguage, KeepsTextureNumbers) {
  const auto program = parse_profile("Modifications { arc, abs, 90, 45, 0.5, 0, 1, -2; # frieze\n line, abs, 0, 1; }");
  ASSERT_TRUE(program.has_value()) << program.error().text();
  ASSERT_TRUE(program->commands[0].textures.has_value());
  EXPECT_EQ(*program->commands[0].textures, (std::array<int, 3>{0, 1, -2}));
  EXPECT_FALSE(program->commands[1].textures.has_value());
}

TEST(ProfileLanguage, TellsWhereAProgramIsWrong) {
  const auto error = [](const char* text) { return parse_profile(text).error().text(); };
  EXPECT_EQ(error("Modifications {\n  line, rel, 90, 1;\n  arc, rel, 90, 4;\n}"),
            "line 3, column 18: expected \",\", found \";\"");
  EXPECT_EQ(error("Modifications {\n  lime, rel, 90, 1; }"),
            "line 2, column 3: expected \"line\", \"arc\" or \"}\", found \"lime\"");
  EXPECT_EQ(error("Modifications { line, up, 90, 1; }"),
            "line 1, column 23: expected \"rel\" or \"abs\", found \"up\"");
  EXPECT_EQ(error("Modifications { line, rel, 9o, 1; }"),
            "line 1, column 28: expected an angle in degrees, found \"9o\"");
  EXPECT_THAT(error("Modifications { line, rel, 90, -1; }"), HasSubstr("a length is more than 0"));
  EXPECT_THAT(error("Modifications { line, rel, 1e9, 1; }"), HasSubstr("beyond 360"));
  EXPECT_THAT(error("Modifications { line, rel, nan, 1; }"), HasSubstr("angle"));
  EXPECT_THAT(error("Modifications { }"), HasSubstr("wants a line or an arc"));
  EXPECT_THAT(error("Modifications { line, rel, 90, 1; } more"), HasSubstr("nothing may follow"));
  EXPECT_EQ(error(""), "line 1, column 1: expected \"Modifications\", found the end");
  EXPECT_THAT(error("Modifications { line, rel, 90, 1, 0, 1; }"), HasSubstr("expected \",\""));
  std::string endless = "Modifications {";
  for (int i = 0; i < 2000; ++i) endless += "line, rel, 1, 1;";
  EXPECT_THAT(error((endless + "}").c_str()), HasSubstr("more than 1000 commands"));
}

TEST(ProfileLanguage, AnyBytesEndInAProfileOrAnError) {
  const std::string golden = kGolden;
  int parsed_well = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    std::string text = golden;
    const auto draw = [&](std::uint64_t n, std::uint64_t below) { return base::random_bits(seed, n, "bytes") % below; };
    const std::uint64_t changes = 1 + draw(0, 4);
    for (std::uint64_t k = 1; k <= changes; ++k) {
      const std::size_t at = draw(10 * k, text.size());
      switch (draw(10 * k + 1, 3)) {
        case 0:
          text[at] = static_cast<char>(draw(10 * k + 2, 256));
          break;
        case 1:
          text.erase(at, 1 + draw(10 * k + 3, 5));
          break;
        default:
          text.insert(at, text.substr(draw(10 * k + 4, text.size()), draw(10 * k + 5, 12)));
      }
    }
    const auto program = parse_profile(text);
    if (!program) {
      EXPECT_FALSE(program.error().message.empty());
      continue;
    }
    ++parsed_well;
    const Profile profile = trace(*program, 3);
    const auto section = section_of(scaled_to_height(profile, 0.5, 1));
    if (section) {
      EXPECT_TRUE(is_simple(*section)) << text;
    }
  }
  EXPECT_GT(parsed_well, 300);
}

TEST(Profile, ScalesEvenlyUntilTheCap) {
  const Profile drawn = trace(parsed(kGolden));
  const Profile free = scaled_to_height(drawn, 0.86098, 10);
  EXPECT_NEAR(free.height(), 0.86098, 1e-9);
  EXPECT_NEAR(free.projection(), 0.86098 * 0.4472, 1e-4);
  const Profile capped = scaled_to_height(drawn, 0.86098, 0.2);
  EXPECT_NEAR(capped.height(), 0.86098, 1e-9);
  EXPECT_NEAR(capped.projection(), 0.2, 1e-9);
}

TEST(Profile, SectionsEndInsideTheWall) {
  const auto section = section_of(scaled_to_height(trace(parsed(kGolden)), 0.8, 1));
  ASSERT_TRUE(section.has_value()) << section.error();
  EXPECT_TRUE(is_simple(*section));
  EXPECT_GT(signed_area(*section), 0);
  EXPECT_NEAR(bounds_of(*section).least.x, -kApart, 1e-12);
  EXPECT_NEAR(section->back().x, -kApart, 1e-12) << "the weathering is cut off inside the wall";
}

TEST(Profile, RefusesSectionsThatAreNone) {
  const auto error = [](const char* text) {
    const Profile profile = trace(parsed(text));
    const auto section = section_of(profile);
    return section ? std::string() : section.error();
  };
  EXPECT_THAT(error("Modifications { line, abs, 0, 1; }"), HasSubstr("does not stand out"));
  EXPECT_THAT(error("Modifications { line, abs, 90, 1; line, abs, 180, 1; line, abs, -90, 1; }"),
              HasSubstr("from below"));
  EXPECT_THAT(error("Modifications { line, abs, 90, 2; line, abs, 0, 1; line, abs, -90, 1; line, abs, 180, 2; line, "
                    "abs, 90, 3; line, abs, 0, 4; line, abs, -90, 4; }"),
              HasSubstr("crosses itself"));
}

TEST(Profile, FineMembersAreLeftOut) {
  const Profile drawn = trace(parsed(kGolden), 8);
  EXPECT_GT(section_of(scaled_to_height(drawn, 1.2, 1))->size(),
            section_of(scaled_to_height(drawn, 0.12, 1))->size() + 4);
}

TEST(Profile, SilhouettesAreAsHighAndAsFarOut) {
  for (const auto& [name, preset] : shipped().profiles()) {
    const Profile full = scaled_to_height(trace(preset.program), preset.typical, 10), few = silhouette(full);
    EXPECT_LE(few.points.size(), 5u) << name;
    EXPECT_NEAR(few.height(), full.height(), 0.25 * full.height()) << name;
    EXPECT_NEAR(few.projection(), full.projection(), 1e-9) << name;
    EXPECT_TRUE(section_of(few).has_value()) << name;
  }
}

TEST(ProfileLibrary, PresetsKeepTheNumbersOfStyles) {
  // docs/style_measures.md §2.5: projection in metres at the typical height.
  const std::map<std::string, std::pair<double, double>> projections{
      {"plinth", {0.03, 0.10}},    {"plinth_cornice", {0.05, 0.08}}, {"string_course", {0.08, 0.12}},
      {"sill_band", {0.06, 0.10}}, {"sill", {0.04, 0.10}},           {"hood", {0.15, 0.25}},
      {"casing", {0.02, 0.06}},    {"main_cornice", {0.30, 0.40}},   {"main_cornice_brackets", {0.30, 0.55}},
  };
  for (const auto& [name, range] : projections) {
    const auto& preset = shipped().profiles().at(name);
    const double out = scaled_to_height(trace(preset.program, 8), preset.typical, 10).projection();
    EXPECT_GE(out, range.first) << name;
    EXPECT_LE(out, range.second) << name;
  }
}

TEST(ProfileLibrary, ShippedOnesAreThoseOfTheFolder) {
  std::set<std::string> read, there;
  for (const auto& entry : std::filesystem::directory_iterator(BLOCKRAND_SOURCE_DIR "/configs/profiles"))
    there.insert(entry.path().stem().string());
  for (const auto& [name, preset] : shipped().profiles()) read.insert(name);
  EXPECT_EQ(read, there);
  EXPECT_GE(read.size(), 12u);
}

TEST(ProfileLibrary, TellsWhatIsWrongWithAFile) {
  ProfileLibrary library;
  const auto error = [&](const char* text) -> std::string {
    try {
      parse_profile_preset(text, "a/b.toml", "b", library);
    } catch (const base::InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(
      error("meaning = \"x\"\nheight = [0.1, 0.2, 0.3]\nprogram = '''\nModifications {\n  lne, abs, 0, 1; }'''\n"),
      testing::AllOf(HasSubstr("a/b.toml:3"), HasSubstr("line 2, column 3"), HasSubstr("lne")));
  EXPECT_THAT(error("meaning = \"x\"\nheight = [0.3, 0.2, 0.3]\nprogram = ''\n"), HasSubstr("three rising numbers"));
  EXPECT_THAT(error("meaning = \"x\"\nheight = [0.1, 0.2, 0.3]\nprogramm = ''\n"), HasSubstr("no program"));
  EXPECT_THAT(error("meaning = \"x\"\nheight = [0.1, 0.2, 0.3]\nprogram = 'Modifications { line, abs, 0, 1; }'\n"),
              HasSubstr("does not stand out"));
  EXPECT_TRUE(library.empty());
}

}  // namespace
}  // namespace blockrand::elements
