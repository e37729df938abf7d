// Programs: search, imports, styles, what names resolve to, types, order of attributes.
#include "styles/grammar/language/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

namespace blockrand::grammar {
namespace {

using Files = std::map<std::string, std::string>;

LoadOptions options_for(const Files& files) {
  LoadOptions options;
  options.roots = {"/project"};
  options.read = [&files](const std::string& path) -> std::optional<std::string> {
    const auto found = files.find(path);
    return found == files.end() ? std::nullopt : std::optional(found->second);
  };
  options.list = [&files](const std::string& folder) {
    std::vector<std::string> names;
    const std::string prefix = folder.empty() ? "" : folder + "/";
    for (const auto& [path, text] : files)
      if (path.starts_with(prefix))
        names.push_back(path.substr(prefix.size(), path.find('/', prefix.size()) - prefix.size()));
    return names;
  };
  return options;
}

Program load_files(const Files& files, const std::string& style = {}) {
  LoadOptions options = options_for(files);
  options.style = style;
  return load("/project/rules/main.cga", options);
}

Program load_text(const std::string& text) { return load_files({{"/project/rules/main.cga", text}}); }

/// "line:column code" of everything told.
std::vector<std::string> told(const Program& program) {
  std::vector<std::string> all;
  for (const Diagnostic& d : program.diagnostics)
    all.push_back(std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.code +
                  (d.suggestion.empty() ? "" : " → " + d.suggestion));
  return all;
}

const Slot& slot(const Program& program, const std::string& name) {
  const auto found =
      std::find_if(program.slots.begin(), program.slots.end(), [&](const Slot& s) { return s.name == name; });
  if (found == program.slots.end()) throw std::runtime_error("no slot " + name);
  return *found;
}

/// The first call of a symbol in a module, as a target.
const Target& call(const Program& program, const std::string& name, std::uint32_t module = 0) {
  const Unit& unit = program.unit(module);
  for (const Call& c : unit.calls)
    if (unit.name(c.name) == name) return program.modules[module].targets[c.use];
  throw std::runtime_error("no call " + name);
}
const Target& use(const Program& program, const std::string& name, std::uint32_t module = 0) {
  const Unit& unit = program.unit(module);
  for (const Expression& e : unit.expressions)
    if (e.kind == ExpressionKind::name && unit.name(e.name) == name) return program.modules[module].targets[e.use];
  throw std::runtime_error("no use " + name);
}
std::string called(const Program& program, const std::string& name) {
  const Target& t = call(program, name);
  return t.count == 0 ? "" : program.qualified_name(program.definitions[program.candidates[t.index]]);
}

TEST(Program, ResolvesNamesInTheOrderOfTheDigest) {
  const Program p = load_text(
      "attr h = 10\nf(x) = x + h\nLot(w) --> extrude(f(w)) set(h, 3) Mass(scope.sx) split(x){ rand(1,2) : A. | ~1 : B "
      "}\n"
      "Mass(a) --> NIL\nB --> comp(f){ front : C. | street.side : D. }");
  EXPECT_THAT(told(p), testing::IsEmpty());
  EXPECT_EQ(call(p, "extrude").kind, TargetKind::operation);
  EXPECT_EQ(built_ins()[call(p, "extrude").index].name, "extrude");
  EXPECT_EQ(use(p, "f").kind, TargetKind::own_function);
  EXPECT_EQ(use(p, "w").kind, TargetKind::local);
  EXPECT_EQ(use(p, "h").kind, TargetKind::attribute);
  EXPECT_EQ(use(p, "scope.sx").kind, TargetKind::shape_attribute);
  EXPECT_EQ(use(p, "rand").kind, TargetKind::function);
  EXPECT_EQ(use(p, "front").kind, TargetKind::word);
  EXPECT_EQ(call(p, "Mass").kind, TargetKind::rule);
  EXPECT_EQ(call(p, "A").kind, TargetKind::leaf);
}

TEST(Program, TheSignatureDecidesWhatIsAWord) {
  const Program p = load_text("attr front = 2\nattr y = 3\nLot --> extrude(y, y) comp(f){ front : A. } t(front, y, 0)");
  EXPECT_THAT(told(p), testing::IsEmpty());
  std::vector<TargetKind> kinds;
  const Unit& unit = p.unit(0);
  for (const Expression& e : unit.expressions)
    if (e.kind == ExpressionKind::name) kinds.push_back(p.modules[0].targets[e.use].kind);
  using enum TargetKind;
  EXPECT_THAT(kinds, testing::ElementsAre(word, attribute, word, word, attribute, attribute));
}

TEST(Program, OverloadsGoByCountThenByType) {
  const Program p = load_text("Lot --> A(1) A(\"x\") A(1,2)\nA(n) --> extrude(n)\nA(s) --> texture(s)\nA(a,b) --> NIL");
  EXPECT_THAT(told(p), testing::IsEmpty());
  const Unit& unit = p.unit(0);
  std::vector<std::uint32_t> counts;
  for (const Call& c : unit.calls)
    if (unit.name(c.name) == "A") counts.push_back(p.modules[0].targets[c.use].count);
  EXPECT_THAT(counts, testing::ElementsAre(2, 2, 1));
  const Value number = 1.0, text = std::string("x"), truth = true;
  const Target& a = call(p, "A");
  EXPECT_EQ(p.definitions[choose(p, a, std::span(&number, 1))].declaration, 1U);
  EXPECT_EQ(p.definitions[choose(p, a, std::span(&text, 1))].declaration, 2U);
  EXPECT_EQ(choose(p, a, std::span(&truth, 1)), kNone);
}

TEST(Program, OperationsWinOverRulesOfTheSameSignature) {
  const Program p = load_text("Lot --> color(1,2)\ncolor(a,b) --> NIL");
  EXPECT_EQ(call(p, "color").kind, TargetKind::rule);
}

TEST(Program, UndefinedSymbolsAreLeavesWithASuggestion) {
  const Program p = load_text("Lot --> exturde(3) Fasade Fasade Roof.\nFacade --> NIL");
  EXPECT_THAT(told(p), testing::ElementsAre("1:9 undefined_symbol → extrude", "1:20 undefined_symbol → Facade"));
  EXPECT_EQ(call(p, "exturde").kind, TargetKind::leaf);
  EXPECT_FALSE(has_errors(p.diagnostics));
}

TEST(Program, TellsWhatNamesNothing) {
  EXPECT_THAT(told(load_text("attr height = 3\nLot --> extrude(heigth)")),
              testing::ElementsAre("2:17 unknown_name → height"));
  EXPECT_THAT(told(load_text("Lot --> set(material.colr.r, 1)")),
              testing::ElementsAre("1:13 unknown_attribute → material.color.r"));
  EXPECT_THAT(told(load_text("Lot --> set(split.index, 1)")), testing::ElementsAre("1:13 not_settable"));
  EXPECT_THAT(told(load_text("Lot --> comp(f){ frnt : A. }")), testing::ElementsAre("1:18 unknown_selector → front"));
  EXPECT_THAT(told(load_text("Lot --> extrude(wrold.up, 3)")), testing::ElementsAre("1:17 unknown_word → world.up"));
  EXPECT_THAT(told(load_text("Lot --> t(1,2)")), testing::ElementsAre("1:9 argument_count"));
  EXPECT_THAT(told(load_text("f = sin(1,2)")), testing::ElementsAre("1:5 argument_count"));
  EXPECT_THAT(told(load_text("Lot --> A(1)\nA --> NIL")), testing::ElementsAre("1:9 parameter_count"));
  EXPECT_THAT(told(load_text("f = imp.h")), testing::ElementsAre("1:5 unknown_import"));
}

TEST(Program, BrokenDeclarationsAreToldOnce) {
  EXPECT_THAT(told(load_text("attr h = )\nLot --> extrude(h) Roof\nRoof --> (")),
              testing::ElementsAre("1:10 syntax", "3:10 syntax"));
}

const char* const kImported = "attr h = 10\nconst c = 1\nLot --> extrude(h) Part\nPart --> NIL\nextension Roof --> NIL";

TEST(Program, AttributesPropagateIntoImports) {
  const Program p = load_files({{"/project/rules/main.cga", "import imp : \"imp.cga\"\nattr h = 20\nLot --> imp.Lot"},
                                {"/project/rules/imp.cga", kImported}});
  EXPECT_THAT(told(p), testing::IsEmpty());
  EXPECT_EQ(p.slots[slot(p, "imp.h").source_slot].name, "h");
  EXPECT_EQ(slot(p, "imp.c").source_slot, kNone);
  EXPECT_EQ(called(p, "imp.Lot"), "imp.Lot");
  // The source comes first.
  EXPECT_EQ(p.slots[p.slot_order[0]].name, "h");
}

TEST(Program, ImportsProtectAndOverride) {
  const Program p =
      load_files({{"/project/rules/main.cga",
                   "import a : \"imp.cga\" (h)\nimport b : \"imp.cga\" ()\nimport c : \"imp.cga\" (h = 2 * k)\n"
                   "import d : \"imp.cga\" (h = d.h + 1)\nattr h = 20\nattr k = 3\nLot --> a.Lot"},
                  {"/project/rules/imp.cga", kImported}});
  EXPECT_THAT(told(p), testing::IsEmpty());
  EXPECT_EQ(slot(p, "a.h").source_slot, kNone);
  EXPECT_EQ(slot(p, "b.h").source_slot, kNone);
  EXPECT_EQ(slot(p, "a.h").module, p.definitions[slot(p, "a.h").definition].module);
  EXPECT_EQ(slot(p, "c.h").module, 0U);
  EXPECT_FALSE(slot(p, "c.h").reads_itself);
  EXPECT_TRUE(slot(p, "d.h").reads_itself);
  // c.h after k, which it reads.
  const auto place = [&](const std::string& name) {
    return std::find_if(p.slot_order.begin(), p.slot_order.end(),
                        [&](std::uint32_t s) { return p.slots[s].name == name; }) -
           p.slot_order.begin();
  };
  EXPECT_LT(place("k"), place("c.h"));
}

TEST(Program, TellsWrongOverrides) {
  const Program p =
      load_files({{"/project/rules/main.cga",
                   "import a : \"imp.cga\" (hh = 1)\nimport b : \"imp.cga\" (c = 1)\nimport a : \"imp.cga\""},
                  {"/project/rules/imp.cga", kImported}});
  EXPECT_THAT(told(p), testing::ElementsAre("1:23 unknown_attribute", "2:23 constant", "3:1 duplicate_import"));
}

TEST(Program, RulesOfImportsCanBeRedefined) {
  const Program p =
      load_files({{"/project/rules/main.cga",
                   "import a : \"imp.cga\" (Roof --> X.)\nimport b : \"imp.cga\"\nb.Part --> Y.\nLot --> a.Roof b.Lot"},
                  {"/project/rules/imp.cga", kImported}});
  EXPECT_THAT(told(p), testing::IsEmpty());
  EXPECT_EQ(p.definitions[p.candidates[call(p, "a.Roof").index]].module, 0U);
  // What the imported file itself calls is the importer's.
  const std::uint32_t b = p.modules[0].imports[1].second;
  const Target& part = call(p, "Part", b);
  EXPECT_EQ(p.definitions[p.candidates[part.index]].module, 0U);
  EXPECT_EQ(p.definitions[p.candidates[part.index]].declaration, 1U);
}

TEST(Program, DynamicImportsHaveSlotsOfTheirOwn) {
  const Program p =
      load_files({{"/project/rules/main.cga", "import imp : \"imp.cga\"\nLot --> imp( h = 40 ).Lot imp.Lot"},
                  {"/project/rules/imp.cga", kImported}});
  EXPECT_THAT(told(p), testing::IsEmpty());
  const Target& lot = call(p, "Lot");
  ASSERT_EQ(lot.kind, TargetKind::rule);
  ASSERT_NE(lot.dynamic_module, kNone);
  const Module& module = p.modules[lot.dynamic_module];
  EXPECT_EQ(module.dynamic_root, lot.dynamic_module);
  ASSERT_EQ(module.dynamic_slots.size(), 2U);
  EXPECT_EQ(p.slots[module.dynamic_slots[0]].module, 0U);
  EXPECT_EQ(p.slot_order.size(), 2U);
  EXPECT_EQ(call(p, "imp.Lot").dynamic_module, kNone);
}

TEST(Program, StylesReplaceAndInherit) {
  const Files files = {
      {"/project/rules/main.cga",
       "attr a = 1\nR --> A.\nS --> B.\nstyle Old\nattr a = 2\nR --> C.\nstyle Older extends Old\nR --> D."}};
  const auto line = [](const Program& p, const std::string& rule) {
    return p.declaration(p.definitions[find_start_rule(p, rule)]).location.line;
  };
  EXPECT_EQ(line(load_files(files), "R"), 2U);
  EXPECT_EQ(line(load_files(files, "Old"), "R"), 6U);
  EXPECT_EQ(line(load_files(files, "Older"), "R"), 8U);
  EXPECT_EQ(line(load_files(files, "Older"), "S"), 3U);
  const Program p = load_files(files, "Older");
  EXPECT_EQ(p.unit(0).expressions[slot(p, "a").value].number, 2);
  EXPECT_THAT(told(load_files(files, "Od")), testing::ElementsAre("0:0 unknown_style"));
}

TEST(Program, ImportsChooseAStyle) {
  const Program p = load_files({{"/project/rules/main.cga", "import a(Old) : \"imp.cga\"\nLot --> a.R"},
                                {"/project/rules/imp.cga", "R --> A.\nstyle Old\nR --> B."}});
  EXPECT_EQ(p.declaration(p.definitions[p.candidates[call(p, "a.R").index]]).location.line, 3U);
}

TEST(Program, FindsFiles) {
  const Files files = {{"/project/rules/main.cga",
                        "import a : \"sub/a.cga\"\nimport b : \"/rules/b.cga\"\nimport c : \"lib\\\\c.cga\"\nimport d "
                        ": \"/ESRI.lib/d.cga\"\n"
                        "import e : \"missing.cga\"\nimport f : \"SUB/a.cga\""},
                       {"/project/rules/sub/a.cga", "A --> NIL"},
                       {"/project/rules/b.cga", "B --> NIL"},
                       {"/project/assets/lib/c.cga", "C --> NIL"},
                       {"/esri/d.cga", "D --> NIL"}};
  LoadOptions options = options_for(files);
  options.mounts = {{"/ESRI.lib", "/esri"}};
  const Program p = load("/project/rules/main.cga", options);
  EXPECT_THAT(told(p), testing::ElementsAre("5:12 file_not_found", "6:12 file_case → /project/rules/sub/a.cga"));
  EXPECT_EQ(p.modules.size(), 6U);
  EXPECT_EQ(p.files.size(), 5U);  // a.cga was read once
}

TEST(Program, WhatCannotBeReadIsToldOnce) {
  EXPECT_THAT(told(load_text("import x : \"x.cga\"\nLot --> x.A extrude(x.h)")),
              testing::ElementsAre("1:12 file_not_found"));
  EXPECT_THAT(told(load_files({})), testing::ElementsAre("0:0 file_not_found"));
}

TEST(Program, CyclesAreTold) {
  const Program p = load_files({{"/project/rules/main.cga", "import a : \"a.cga\"\nLot --> a.Lot"},
                                {"/project/rules/a.cga", "import m : \"main.cga\"\nLot --> m.Lot"}});
  EXPECT_THAT(told(p), testing::ElementsAre("1:12 import_cycle"));
  EXPECT_THAT(told(load_text("attr a = b\nattr b = f(1)\nf(x) = a + x")), testing::ElementsAre("1:6 attribute_cycle"));
  // Round about, but not in any one run: a colour that is the wall's, which is the material's where there is one.
  const Program either = load_text("attr on = false\nattr a = case on : b else : 1\nattr b = case on : 2 else : a");
  EXPECT_THAT(told(either), testing::ElementsAre("2:6 attribute_cycle"));
  EXPECT_FALSE(has_errors(either.diagnostics));
  EXPECT_TRUE(has_errors(load_text("attr a = b\nattr b = a").diagnostics));
  EXPECT_THAT(told(load_text("style A extends B\nR --> NIL\nstyle B extends A")), testing::IsEmpty());
}

TEST(Program, ManyWaysToOneFileAreBounded) {
  Files files;
  for (int i = 0; i < 12; ++i) {
    std::string text;
    for (int j = 0; j < 3; ++j) text += "import i" + std::to_string(j) + " : \"f" + std::to_string(i + 1) + ".cga\"\n";
    files["/project/rules/" + (i == 0 ? std::string("main") : "f" + std::to_string(i)) + ".cga"] = text;
  }
  files["/project/rules/f12.cga"] = "A --> NIL";
  const Program p = load_files(files);
  EXPECT_TRUE(has_errors(p.diagnostics));
  EXPECT_LE(p.modules.size(), 1000U);
}

TEST(Program, ManyDeclarationsOfOneNameAreBounded) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += "A --> A B" + std::to_string(i) + "\n";
  const Program p = load_text(text);
  EXPECT_TRUE(has_errors(p.diagnostics));
  EXPECT_LE(p.definitions.size(), 64U);
  EXPECT_LE(p.candidates.size(), 64U * 20000U);
}

TEST(Program, ChoosesTheStartRule) {
  const auto start = [](const Program& p) {
    return p.start_rule == kNone ? "" : p.qualified_name(p.definitions[p.start_rule]);
  };
  EXPECT_EQ(start(load_text("A(x) --> NIL\nB --> NIL\nC --> NIL")), "B");
  EXPECT_EQ(start(load_text("A --> NIL\n@StartRule\nB --> NIL")), "B");
  EXPECT_EQ(start(load_text("A --> NIL\n@StartRule\nB --> NIL\nstart C --> NIL")), "C");
  EXPECT_EQ(start(load_text("attr a = 1")), "");
  const Program p = load_files({{"/project/rules/main.cga", "import imp : \"imp.cga\"\nLot --> imp.start start"},
                                {"/project/rules/imp.cga", "A --> NIL\nstart B --> NIL"}});
  EXPECT_EQ(called(p, "imp.start"), "imp.B");
  EXPECT_EQ(called(p, "start"), "Lot");
  EXPECT_EQ(p.qualified_name(p.definitions[find_start_rule(p, "imp.A")]), "imp.A");
}

TEST(Program, InfersTypes) {
  const Program p = load_text(
      "attr a = 1\nattr s = \"x\"\nconst b = a > 2\nf(x) = g(x) + 1\ng(y) = y * 2\nattr l = [1,2]\nattr e = l[0]\n"
      "attr n = f(3)\nattr t = \"h=\" + a\nR(p, q) --> extrude(p) texture(q)");
  const auto type = [&](const std::string& name) { return p.definitions[slot(p, name).definition].result; };
  EXPECT_EQ(type("a"), Type::number);
  EXPECT_EQ(type("s"), Type::text);
  EXPECT_EQ(type("b"), Type::truth);
  EXPECT_EQ(type("l"), Type::number_array);
  EXPECT_EQ(type("e"), Type::number);
  EXPECT_EQ(type("n"), Type::number);
  EXPECT_EQ(type("t"), Type::text);
  const Definition& rule = p.definitions.back();
  EXPECT_EQ(rule.parameter_types[0], Type::number);
  EXPECT_EQ(rule.parameter_types[1], Type::text);
}

TEST(Program, OurOwnOperationsAreExtensions) {
  const Program p = load_text("Lot --> blockrand.window(\"casement\", \"bars\", 2)");
  EXPECT_THAT(told(p), testing::IsEmpty());
  EXPECT_EQ(call(p, "blockrand.window").kind, TargetKind::extension);
}

}  // namespace
}  // namespace blockrand::grammar
