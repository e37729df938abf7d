// Proofs that every name of the language does what it says: each case holds, and does not once its name does nothing.
// The table docs/grammar_features.md is made from them (GRAMMAR_FEATURES=1 writes it).
//
// A file of cases (features/*.cases) holds lines "KIND NAME: [STEPS ?] EXPRESSION => VALUE" (printed on a lot of
// 10 x 20 m after the steps) and sections: "== KIND NAME", a rule file with "// expect:" lines (docs/grammar_tests.md),
// "-- FILE.cga" files that it imports, and for forms of syntax "-- without", the same file without the form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <span>
#include <sstream>

#include "styles/grammar/evaluation/asset_files.h"
#include "styles/grammar/evaluation/rule_tests.h"
#include "styles/grammar/language/known_names.h"
#include "tests/unit/grammar/counted_features.h"
#include "tests/unit/grammar/evaluation/derive_support.h"

namespace blockrand::grammar {
namespace {

using namespace testing_support;

const std::filesystem::path kSource = BLOCKRAND_SOURCE_DIR;

struct Case {
  std::string where;  ///< FILE:LINE
  const BuiltIn* name = nullptr;
  std::string rules, without;  ///< `without`: of forms of syntax
  Files files;
  std::string steps, expression, value;  ///< of cases of one line
};

constexpr std::pair<std::string_view, NameKind> kKinds[] = {{"operation", NameKind::operation},
                                                            {"function", NameKind::function},
                                                            {"attribute", NameKind::attribute},
                                                            {"selector", NameKind::selector},
                                                            {"syntax", NameKind::syntax}};

const BuiltIn* find_name(const std::string& kind, const std::string& name) {
  for (const auto& [word, is] : kKinds)
    if (word == kind) return find_built_in(is, name);
  return nullptr;
}

void read_cases(const std::filesystem::path& file, std::vector<Case>& out) {
  std::ifstream in(file);
  ASSERT_TRUE(in) << file;
  std::string line;
  std::string* text = nullptr;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string where = file.filename().string() + ":" + std::to_string(number);
    const std::size_t blank = line.find(' ');
    const std::string first = line.substr(0, blank);
    const auto named = [&](const std::string& kind, const std::string& name) {
      out.push_back({});
      out.back().where = where;
      out.back().name = find_name(kind, name);
      ASSERT_NE(out.back().name, nullptr) << where << ": there is no " << kind << " " << name;
    };
    if (first == "==") {
      const std::size_t end = line.find(' ', 3);
      ASSERT_NO_FATAL_FAILURE(named(line.substr(3, end - 3), line.substr(end + 1)));
      text = &out.back().rules;
    } else if (first == "--") {
      const std::string which = line.substr(3);
      text = which == "without" ? &out.back().without : &out.back().files[which];
    } else if (std::any_of(std::begin(kKinds), std::end(kKinds), [&](const auto& k) { return k.first == first; })) {
      const std::size_t colon = line.find(": "), arrow = line.rfind(" => ");
      ASSERT_TRUE(colon != std::string::npos && arrow != std::string::npos) << where;
      ASSERT_NO_FATAL_FAILURE(named(first, line.substr(blank + 1, colon - blank - 1)));
      Case& made = out.back();
      const std::string body = line.substr(colon + 2, arrow - colon - 2);
      const std::size_t question = body.find(" ? ");
      if (question != std::string::npos) made.steps = body.substr(0, question);
      made.expression = question == std::string::npos ? body : body.substr(question + 3);
      made.value = line.substr(arrow + 4);
      made.rules = "Lot --> " + made.steps + " print(" + made.expression + ") X.\n";
      text = nullptr;
    } else if (text != nullptr) {
      *text += line + "\n";
    } else {
      ASSERT_TRUE(line.empty() || line[0] == '#') << where << ": what is this?";
    }
  }
}

/// What a text, a number or a truth value becomes when it is set and read again.
void add_material_cases(std::vector<Case>& out) {
  for (const BuiltIn& entry : built_ins()) {
    if (entry.kind != NameKind::attribute || !entry.name.starts_with("material.")) continue;
    const char type = signatures(entry)[0].result;
    Case made;
    made.where = "set and read";
    made.name = &entry;
    made.expression = std::string(entry.name);
    made.value = type == 'n' ? "0.25" : type == 'b' ? "true" : entry.name.ends_with("rgb") ? "#102030" : "abc";
    const std::string written = type == 's' ? "\"" + made.value + "\"" : made.value;
    made.rules = "Lot --> set(" + made.expression + ", " + written + ") print(" + made.expression + ") X.\n";
    out.push_back(std::move(made));
  }
}

const std::vector<Case>& cases() {
  static const std::vector<Case> kCases = [] {
    std::vector<Case> out;
    for (const char* file : {"operations", "functions", "attributes", "syntax"})
      read_cases(kSource / "tests/unit/grammar/features" / (std::string(file) + ".cases"), out);
    add_material_cases(out);
    return out;
  }();
  return kCases;
}

/// A folder with a few files.
const FileAccess& some_files() {
  static const std::map<std::string, std::string> kFiles = {
      {"walls/brick.jpg", ""},
      {"walls/stone.jpg", ""},
      {"table.csv", "1,2\n3,4\n"},
      {"note.txt", "hello"},
      {"column.obj", "# a column\no c\nv 1 1 1\nvn 9 9 9\nv 4 7 3 0.5\nf 1 2 1\n"},
      {"tile.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x02\x80\0\0\x01\xe0", 24)},
      // A comment and a frame header.
      {"photo.jpg", std::string("\xff\xd8\xff\xfe\0\x04"
                                "ab\xff\xc0\0\x0b\x08\x01\xe0\x02\x80\x01",
                                18)}};
  static const FileAccess kAccess = [] {
    FileAccess out;
    out.exists = [](const std::string& path) { return kFiles.contains(path); };
    out.read = [](const std::string& path) -> std::optional<std::string> {
      const auto found = kFiles.find(path);
      return found == kFiles.end() ? std::nullopt : std::optional<std::string>(found->second);
    };
    out.asset = [](const std::string& path) { return obj_box(kFiles.contains(path) ? kFiles.at(path) : ""); };
    out.image = [](const std::string& path) { return picture_size(kFiles.contains(path) ? kFiles.at(path) : ""); };
    out.search = [](const std::string& query) {
      std::vector<std::string> found;
      const std::string folder = query.substr(0, query.find('*'));
      for (const auto& [path, text] : kFiles)
        if (path.starts_with(folder)) found.push_back(path);
      return found;
    };
    return out;
  }();
  return kAccess;
}

void complete(DeriveOptions& options, const BuiltIn* without) {
  options.without = without;
  options.files = &some_files();
  options.shape_name = "lot 7";
  options.source = [](std::string_view name) -> std::optional<Value> {
    if (name == "edgeAttr.width") return Value(7.0);
    if (name == "edgeAttr.street") return Value(std::string("Lange Gasse"));
    if (name == "edgeAttr.party") return Value(true);
    return std::nullopt;
  };
}

/// The lot of cases of one line: 10 x 20 m; for some names one that tells more.
Shape lot_for(const BuiltIn& name) {
  if (name.name.starts_with("initialShape.origin.p"))
    return initial_shape({{100, 30, -50}, {110, 30, -50}, {110, 30, -70}, {100, 30, -70}});
  if (name.name == "initialShape.origin.oy")  // the first edge runs north
    return initial_shape({{0, 0, 0}, {0, 0, -20}, {-10, 0, -20}, {-10, 0, 0}});
  if (name.name.starts_with("initialShape.origin.o"))  // a wall whose first edge rises
    return initial_shape({{0, 0, 0}, {0, 5, 0}, {-10, 5, 0}, {-10, 0, 0}});
  if (name.name.starts_with("street.") || name.name.ends_with("StreetSide") || name.name == "streetSide") {
    const InitialPolygon lot{{{0, 0, 0}, {10, 0, 0}, {10, 0, -20}, {0, 0, -20}}, {}};
    return initial_shape(std::span(&lot, 1), {8, 0, 0, 0});  // a street of 8 m in front
  }
  return rectangle(10, 20);
}

/// What does not hold of the case; empty: all holds. Loading must give no errors.
std::vector<std::string> failures_of(const Case& one, const std::string& rules, const BuiltIn* without) {
  const Program program = load_text(rules, one.files);
  EXPECT_FALSE(has_errors(program.diagnostics)) << one.where << "\n" << all_diagnostics(program.diagnostics);
  std::vector<std::string> out;
  if (!one.expression.empty()) {
    DeriveOptions options;
    complete(options, without);
    const Derivation result = derive(program, lot_for(*one.name), options);
    if (prints_text(result) != one.value) out.push_back("printed '" + prints_text(result) + "', not " + one.value);
    for (const Diagnostic& d : result.diagnostics)
      if (d.severity == Severity::error) out.push_back(format(d, program.files));
    return out;
  }
  const std::vector<RuleTest> tests = read_rule_tests(one.rules);
  EXPECT_FALSE(tests.empty()) << one.where << ": nothing is expected";
  for (RuleTest test : tests) {
    complete(test.options, without);
    const RuleTestOutcome outcome = run_rule_test(program, test);
    out.insert(out.end(), outcome.failures.begin(), outcome.failures.end());
  }
  return out;
}

TEST(Features, EveryCaseHolds) {
  for (const Case& one : cases())
    for (const std::string& failure : failures_of(one, one.rules, nullptr))
      ADD_FAILURE() << one.where << " " << one.name->name << ": " << failure;
}

TEST(Features, NoCaseHoldsOnceItsNameDoesNothing) {
  for (const Case& one : cases()) {
    const bool syntax = one.name->kind == NameKind::syntax;
    ASSERT_EQ(syntax, !one.without.empty()) << one.where << ": forms of syntax, and only they, say what is without";
    const auto failures = failures_of(one, syntax ? one.without : one.rules, syntax ? nullptr : one.name);
    EXPECT_FALSE(failures.empty()) << one.where << ": " << one.name->name << " proves nothing";
  }
}

std::map<const BuiltIn*, std::size_t> proofs() {
  std::map<const BuiltIn*, std::size_t> out;
  for (const Case& one : cases()) ++out[one.name];
  return out;
}
bool is_feature(const BuiltIn& entry) {
  return std::any_of(std::begin(kKinds), std::end(kKinds), [&](const auto& kind) { return kind.second == entry.kind; });
}

TEST(Features, NamesRunThroughAProofOnly) {
  const auto proved = proofs();
  for (const BuiltIn& entry : built_ins()) {
    if (!is_feature(entry)) continue;
    EXPECT_EQ(entry.status == Status::runs, proved.contains(&entry))
        << entry.name << ": its status in the table of names says otherwise than the proofs";
  }
}

TEST(Features, TheCountedOnesAreAllThere) {
  EXPECT_EQ(std::size(kCountedFeatures), 246u);
  for (const CountedFeature& feature : kCountedFeatures)
    EXPECT_FALSE(names_of(feature).empty()) << feature.name << " is no name of the language here";
}

std::string status_text(const std::vector<const BuiltIn*>& names, const std::map<const BuiltIn*, std::size_t>& proved) {
  bool runs = true, answers = true;
  for (const BuiltIn* name : names) {
    runs = runs && name->status == Status::runs && proved.contains(name);
    answers = answers && name->status != Status::not_yet;
  }
  return runs ? "runs" : answers ? "default answer" : "not yet";
}

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return "`" + text + "`";
}

std::string table() {
  const auto proved = proofs();
  std::map<std::string, std::size_t> sums;
  std::ostringstream counted, others;
  std::set<const BuiltIn*> used;
  for (const CountedFeature& feature : kCountedFeatures) {
    const auto names = names_of(feature);
    const std::string status = status_text(names, proved);
    ++sums[status];
    std::size_t count = 0;
    for (const BuiltIn* name : names) {
      used.insert(name);
      const auto found = proved.find(name);
      count += found == proved.end() ? 0 : found->second;
    }
    counted << "| " << feature.group << " | " << cell(feature.name) << " | " << feature.files << " | " << status
            << " | " << count << " |\n";
  }
  std::map<std::string, std::size_t> other_sums;
  for (const auto& [word, kind] : kKinds)
    for (const BuiltIn& entry : built_ins()) {
      if (entry.kind != kind || used.contains(&entry)) continue;
      const std::string status = status_text({&entry}, proved);
      ++other_sums[status];
      others << "| " << word << " | " << cell(std::string(entry.name)) << " | " << status << " |\n";
    }
  const auto sum_text = [](std::map<std::string, std::size_t>& all) {
    return std::to_string(all["runs"]) + " run, " + std::to_string(all["default answer"]) + " have a default answer, " +
           std::to_string(all["not yet"]) + " do not run yet";
  };
  return "Of the 246 counted features " + sum_text(sums) + ".\n\n| group | feature | files | status | proofs |\n" +
         "|---|---|---|---|---|\n" + counted.str() + "\n## Other names\n\nNames of the language that no counted file " +
         "uses: " + sum_text(other_sums) + ".\n\n| kind | name | status |\n|---|---|---|\n" + others.str();
}

constexpr std::string_view kHead =
    "# What of the rule language runs\n\n"
    "The 246 features that published rule files were found to use, with the number of those files (of 508), and what "
    "they do here. This\npage is made from tests: a name *runs* only through cases in `tests/unit/grammar/features` "
    "that assert geometry or values, and that\nfail once the name does nothing (an operation leaves the shape as it "
    "is, a function or an attribute gives the default value of its type,\na selector chooses nothing; a form of syntax "
    "is taken out of the file). A *default answer* does not depend on what stands around or on\nfiles; "
    "`grammar check` tells it as a note. What is *not yet* there is told by name wherever a file uses it, and the "
    "shape stays as it is.\n\n"
    "How this page is written: `GRAMMAR_FEATURES=1 build/release/tests/test_grammar_features`.\n\n";

TEST(Features, TheTableIsWritten) {
  const std::filesystem::path path = kSource / "docs/grammar_features.md";
  const std::string now = std::string(kHead) + table();
  if (std::getenv("GRAMMAR_FEATURES") != nullptr) std::ofstream(path) << now;
  std::ifstream in(path);
  std::ostringstream was;
  was << in.rdbuf();
  EXPECT_TRUE(was.str() == now) << path << " is not what the tests say; write it with GRAMMAR_FEATURES=1";
}

}  // namespace
}  // namespace blockrand::grammar
