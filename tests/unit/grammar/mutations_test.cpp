// Ten thousand broken rule texts: reading, resolving, checking and deriving them never crashes and never takes long.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "pipeline/base/random.h"
#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/language/check.h"
#include "styles/grammar/language/lexer.h"
#include "styles/grammar/language/parser.h"
#include "styles/grammar/language/program.h"
#include "styles/grammar/shapes/initial_shape.h"
#include "tests/unit/grammar/sample_rules.h"

namespace blockrand::grammar {
namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed) {}
  std::size_t below(std::size_t n) { return n == 0 ? 0 : base::mix64(base::mix64(seed_) + ++draws_) % n; }

 private:
  std::uint64_t seed_, draws_ = 0;
};

std::string_view sample(std::size_t number) { return test::kSampleRules[number % test::kSampleRules.size()]; }

std::string mutate_bytes(std::string text, Random& random) {
  constexpr std::string_view kLikely = "(){}[]:|=*~'%.,;@#/\\\"<>!&+-0 \n\xff\xc3\x00";
  for (std::size_t n = 1 + random.below(4); n-- > 0 && !text.empty();) {
    const std::size_t at = random.below(text.size());
    switch (random.below(5)) {
      case 0:
        text[at] = kLikely[random.below(kLikely.size())];
        break;
      case 1:
        text.insert(at, 1, kLikely[random.below(kLikely.size())]);
        break;
      case 2:
        text.erase(at, 1 + random.below(8));
        break;
      case 3:
        text.insert(at, text.substr(random.below(text.size()), random.below(60)));
        break;
      case 4:
        text.resize(at);
        break;
    }
  }
  return text;
}

std::vector<std::string> words(std::string_view text) {
  std::vector<Diagnostic> none;
  std::vector<std::string> all;
  for (const Token& t : tokens_of(text, 0, none))
    all.emplace_back(text.substr(t.offset, t.length + (t.trailing_dot ? 1 : 0)));
  return all;
}

std::string mutate_tokens(std::string_view text, std::string_view other, Random& random) {
  std::vector<std::string> tokens = words(text);
  const std::vector<std::string> others = words(other);
  for (std::size_t n = 1 + random.below(4); n-- > 0 && !tokens.empty();) {
    const std::size_t at = random.below(tokens.size());
    const auto place = tokens.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random.below(5)) {
      case 0:
        std::swap(tokens[at], tokens[random.below(tokens.size())]);
        break;
      case 1:
        tokens.erase(place);
        break;
      case 2:
        tokens[at] = others[random.below(others.size())];
        break;
      case 3: {
        const std::string one = tokens[at];
        tokens.insert(place, 1 + random.below(random.below(20) == 0 ? 2000 : 3), one);
        break;
      }
      case 4: {
        const std::size_t from = random.below(others.size());
        tokens.insert(place, others.begin() + static_cast<std::ptrdiff_t>(from),
                      others.begin() + static_cast<std::ptrdiff_t>(std::min(others.size(), from + random.below(30))));
        break;
      }
    }
  }
  std::string out;
  for (const std::string& t : tokens) out += t + (random.below(8) == 0 ? "\n" : " ");
  return out;
}

/// Every place that is told lies in its file.
void expect_sound(const std::vector<Diagnostic>& all, const Program& program) {
  for (const Diagnostic& d : all) {
    ASSERT_LT(d.location.file, program.files.size()) << d.message;
    ASSERT_FALSE(d.code.empty());
    ASSERT_FALSE(d.message.empty());
    ASSERT_FALSE(format(d, program.files).empty());
  }
}

/// Every target refers to something that is there.
void expect_sound(const Program& program) {
  for (const Module& module : program.modules) {
    ASSERT_EQ(module.targets.size(), module.unit->use_count);
    for (const Target& target : module.targets) {
      if (target.kind == TargetKind::attribute) {
        ASSERT_LT(target.index, program.slots.size());
      }
      if (target.kind == TargetKind::rule || target.kind == TargetKind::own_function) {
        ASSERT_GT(target.count, 0U);
        ASSERT_LE(target.index + target.count, program.candidates.size());
      }
      if (target.kind == TargetKind::operation || target.kind == TargetKind::function) {
        ASSERT_LT(target.index, built_ins().size());
      }
    }
  }
  std::size_t ordered = program.slot_order.size();
  for (const Module& module : program.modules) ordered += module.dynamic_slots.size();
  ASSERT_EQ(ordered, program.slots.size());
}

TEST(Mutations, SamplesUseTheWholeLanguage) {
  // All but the one of mistakes read without an error.
  for (std::size_t i = 0; i < test::kSampleRules.size(); ++i) {
    std::vector<Diagnostic> told;
    const Unit unit = parse(test::kSampleRules[i], 0, told);
    EXPECT_EQ(has_errors(told), i == 10) << i << (told.empty() ? "" : " " + format(told.front(), {}));
    EXPECT_FALSE(unit.declarations.empty());
  }
}

TEST(Mutations, NeverCrashOrHang) {
  constexpr std::uint64_t kTexts = 10000;
  std::size_t errors = 0, clean = 0;
  std::set<std::string> codes;
  for (std::uint64_t seed = 0; seed < kTexts; ++seed) {
    Random random(seed);
    const std::string_view text = sample(random.below(test::kSampleRules.size()));
    const std::string_view other = sample(random.below(test::kSampleRules.size()));
    const std::string broken =
        seed % 2 == 0 ? mutate_bytes(std::string(text), random) : mutate_tokens(text, other, random);
    LoadOptions options;
    options.read = [&](const std::string& path) -> std::optional<std::string> {
      if (path == "main.cga") return broken;
      if (path.ends_with("one.cga")) return std::string(other);
      if (path.ends_with("two.cga")) return std::string(sample(5));
      return std::nullopt;
    };
    const Program program = load("main.cga", options);
    expect_sound(program);
    expect_sound(program.diagnostics, program);
    const std::vector<Diagnostic> checked = check(program, {});
    expect_sound(checked, program);
    if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed << "\n" << broken;
    for (const auto* all : {&program.diagnostics, &checked})
      for (const Diagnostic& d : *all) codes.insert(d.code);
    errors += has_errors(program.diagnostics) ? 1U : 0U;
    clean += program.diagnostics.empty() ? 1U : 0U;
  }
  // Most mutations break something: else nothing was tried.
  EXPECT_GT(errors, kTexts / 2);
  EXPECT_LT(clean, kTexts / 2);
  // Every code that was told is explained.
  std::ifstream page(BLOCKRAND_SOURCE_DIR "/docs/rule_files.md");
  const std::string text{std::istreambuf_iterator<char>(page), std::istreambuf_iterator<char>()};
  for (const std::string& code : codes) EXPECT_NE(text.find("`" + code + "`"), std::string::npos) << code;
  EXPECT_GT(codes.size(), 40U);
}

/// The rule texts of features/*.cases: small, and together they use every name of the language.
std::vector<std::string> texts_of_cases() {
  std::vector<std::string> out;
  for (const char* name : {"operations", "functions", "attributes", "syntax"}) {
    std::ifstream in(std::string(BLOCKRAND_SOURCE_DIR "/tests/unit/grammar/features/") + name + ".cases");
    bool open = false;
    for (std::string line; std::getline(in, line);) {
      const std::size_t colon = line.find(": "), arrow = line.rfind(" => "), question = line.find(" ? ");
      if (line.starts_with("== ") || line.starts_with("-- ")) {
        out.emplace_back();
        open = true;
      } else if (colon != std::string::npos && arrow != std::string::npos) {
        const bool steps = question != std::string::npos && question < arrow;
        const std::size_t from = steps ? question + 3 : colon + 2;
        out.push_back("Lot --> " + (steps ? line.substr(colon + 2, question - colon - 2) : std::string()) + " print(" +
                      line.substr(from, arrow - from) + ") X.\n");
        open = false;
      } else if (open) {
        out.back() += line + "\n";
      }
    }
  }
  return out;
}

/// GRAMMAR_MUTATIONS=1000000 tries more.
TEST(Mutations, DerivationsEndWhateverTheRules) {
  const char* more = std::getenv("GRAMMAR_MUTATIONS");
  const std::uint64_t texts = more != nullptr ? std::strtoull(more, nullptr, 10) : 10000;
  const std::vector<std::string> samples = texts_of_cases();
  ASSERT_GT(samples.size(), 300u);
  const Shape lot = initial_shape({{0, 0, 0}, {12, 0, 0}, {12, 0, -9}, {7, 0, -9}, {7, 0, -5}, {0, 0, -5}});
  DeriveOptions run;
  run.limits = {300, 40, 40, 2000, 20000, 50, 2000};
  std::size_t leaves = 0, derived = 0;
  for (std::uint64_t seed = 0; seed < texts; ++seed) {
    Random random(seed ^ 0x9e3779b97f4a7c15ULL);
    const std::string& text = samples[random.below(samples.size())];
    const std::string& other = samples[random.below(samples.size())];
    const std::string broken = seed % 4 == 0 ? mutate_bytes(text, random) : mutate_tokens(text, other, random);
    LoadOptions options;
    options.read = [&](const std::string& path) -> std::optional<std::string> {
      return path == "main.cga" ? std::optional(broken) : path.ends_with(".cga") ? std::optional(other) : std::nullopt;
    };
    const Program program = load("main.cga", options);
    const Derivation result = derive(program, lot, run);
    expect_sound(result.diagnostics, program);
    ++derived;
    leaves += result.leaves.size();
    for (const Leaf& leaf : result.leaves) {
      if (leaf.shape.mesh == nullptr) continue;
      for (const MeshFace& face : leaf.shape.mesh->faces)
        for (const auto& loop : face.loops)
          for (const Corner& corner : loop) ASSERT_LT(corner.vertex, leaf.shape.mesh->vertices.size()) << broken;
    }
    if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed << "\n" << broken;
  }
  // Many still make something: else nothing was tried.
  EXPECT_GT(leaves, derived / 5);
}

}  // namespace
}  // namespace blockrand::grammar
