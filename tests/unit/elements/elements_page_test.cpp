// docs/elements.md says of every kind what the code says, and has a figure of it.
//   ELEMENTS_PAGE=1 build/release/tests/test_elements --gtest_filter='ElementsPage.*'   writes the tables into the page.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "pipeline/base/text.h"
#include "styles/elements/element_catalogue.h"
#include "styles/elements/mesh_builder.h"
#include "tests/unit/elements/mesh_measures.h"
#include "tests/unit/elements/shipped_elements.h"

namespace blockrand::elements {
namespace {

const std::string kPage = BLOCKRAND_SOURCE_DIR "/docs/elements.md";

std::string page() {
  std::ifstream file(kPage);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string range(const ParameterInfo& p) {
  switch (p.type) {
    case ParameterInfo::Type::number:
    case ParameterInfo::Type::whole:
      return base::shortest(p.least) + " to " + base::shortest(p.most);
    case ParameterInfo::Type::word: {
      std::string out;
      for (const std::string& w : p.words) out += (out.empty() ? "`" : ", `") + w + "`";
      return out;
    }
    case ParameterInfo::Type::profile:
      return "a profile";
    case ParameterInfo::Type::edge:
      return "a shape of an edge";
  }
  return {};
}

std::string table(const ElementKind& kind) {
  std::string out = fmt::format(
      "{}. Width: of the {}, {} to {} m (usual {}); height: of the {}, {} to {} m (usual {}).\n\n"
      "| parameter | unit | range | default | what it is |\n|---|---|---|---|---|\n",
      kind.semantic == ElementClass::window ? "Window"
      : kind.semantic == ElementClass::door ? "Door"
                                            : "On the wall",
      kind.width.measures, base::shortest(kind.width.least), base::shortest(kind.width.most),
      base::shortest(kind.width.usual), kind.height.measures, base::shortest(kind.height.least),
      base::shortest(kind.height.most), base::shortest(kind.height.usual));
  for (const ParameterInfo& p : kind.parameters) {
    const std::string initial =
        p.type == ParameterInfo::Type::word ? "`" + p.words[static_cast<std::size_t>(p.initial)] + "`"
        : p.type == ParameterInfo::Type::profile || p.type == ParameterInfo::Type::edge ? "`" + p.words[0] + "`"
                                                                                        : base::shortest(p.initial);
    out += fmt::format("| `{}` | {} | {} | {} | {} |\n", p.name, p.unit, range(p), initial, p.meaning);
  }
  out += "\nTriangles at detail 0, 1, 2:";
  for (const double detail : {0.0, 1.0, 2.0}) {
    const std::vector<Parameter> parameters{{"detail", detail}};
    const auto e = shipped().make(kind.name, kind.width.usual, kind.height.usual, parameters);
    out += fmt::format("{} {}", detail > 0 ? "," : "", e ? triangle_count(e->mesh) : 0);
  }
  return out + ".\n";
}

std::string profiles() {
  std::string out = "| profile | height, m | what it is |\n|---|---|---|\n";
  for (const auto& [name, p] : shipped().profiles())
    out += fmt::format("| `{}` | {} to {}, usually {} | {} |\n", name, base::shortest(p.least), base::shortest(p.most),
                       base::shortest(p.typical), p.meaning);
  return out;
}

std::vector<std::pair<std::string, std::string>> sections() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const ElementKind& kind : shipped().kinds()) out.emplace_back(kind.name, table(kind));
  out.emplace_back("profiles", profiles());
  return out;
}

TEST(ElementsPage, ListsKindsAndParametersOfTheCode) {
  std::string text = page();
  for (const auto& [name, wanted] : sections()) {
    const std::string begin = "<!-- " + name + " -->\n", end = "<!-- /" + name + " -->";
    const std::size_t from = text.find(begin), to = text.find(end);
    ASSERT_TRUE(from != std::string::npos && to != std::string::npos) << "docs/elements.md lacks the marks of " << name;
    const std::size_t at = from + begin.size();
    if (std::getenv("ELEMENTS_PAGE"))
      text.replace(at, to - at, wanted);
    else
      EXPECT_EQ(text.substr(at, to - at), wanted) << "run with ELEMENTS_PAGE=1 to write it";
  }
  if (std::getenv("ELEMENTS_PAGE")) std::ofstream(kPage) << text;
}

TEST(ElementsPage, HasAFigureOfEachKind) {
  const std::string text = page();
  for (const ElementKind& kind : shipped().kinds()) {
    const std::string figure = "pictures/elements/" + kind.name + ".png";
    EXPECT_THAT(text, testing::HasSubstr("](" + figure + ")")) << "show the figure";
    EXPECT_TRUE(std::filesystem::exists(BLOCKRAND_SOURCE_DIR "/docs/" + figure)) << figure;
  }
}

}  // namespace
}  // namespace blockrand::elements
