// What explanations say of LoD3.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/outputs/explain/explanation.h"
#include "tests/unit/outputs/facade_region.h"

namespace blockrand::outputs {
namespace {

using nlohmann::json;

std::vector<json> explained(const model::Region& region, const std::string& file) {
  ExplainOptions o;
  o.tile = "15_1_2";
  o.lod = 3;
  o.final_state = [](std::uint32_t) { return FinalState{}; };
  o.rule_file = [&](std::string_view preset) { return preset == "gz" ? file : std::string(); };
  std::vector<json> out;
  std::istringstream lines(explain(region, o).lines);
  for (std::string line; std::getline(lines, line);) out.push_back(json::parse(line));
  return out;
}

std::string stage(const json& record, const std::string& name) {
  for (const json& s : record["stages"])
    if (s["stage"] == name) return s["text"];
  return {};
}

TEST(ExplainDetail, TellsRulesOpeningsElementsAndBodies) {
  auto s = test::facade_region();
  model::Building& b = s.region().buildings[0];
  b.attributes.preset.value = "gz";
  model::BuildingPart& part = b.parts[0];
  part.fallbacks.push_back(model::IssueCode::opening_left_out);
  s.region().report.add(part.osm, model::IssueCode::opening_left_out, "w100: 2 of 40");
  part.lod3.roof_installations.push_back({model::RoofElementKind::chimney, part.lod2, part.lod2_triangles});
  std::size_t doors = 0;
  for (const model::Opening& o : part.lod3.openings) doors += o.kind == model::OpeningKind::door;
  const std::size_t windows = part.lod3.openings.size() - doors;
  ASSERT_EQ(doors, 1u);

  const auto records = explained(s.region(), "gruenderzeit.cga");
  const std::string text = stage(records[0], "facades");
  EXPECT_NE(text.find("rule file gruenderzeit.cga of preset gz: " + std::to_string(windows) +
                      " windows, 1 door; placed " + std::to_string(windows) + " casement, 1 house_door, 1 lamp"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("bodies on walls and roofs: 1 chimney"), std::string::npos) << text;
  EXPECT_NE(text.find("w100: 2 of 40"), std::string::npos) << "what was left out: " << text;
  const json& detail = records[0]["bodies"][0]["detail"];
  EXPECT_EQ(detail["windows"], windows);
  EXPECT_EQ(detail["doors"], 1);
  EXPECT_EQ(detail["passages"], 0);
  EXPECT_EQ(detail["elements"]["casement"], windows);
  EXPECT_EQ(detail["installations"]["chimney"], 1);
  EXPECT_NE(stage(records[1], "facades").find("no preset"), std::string::npos);
  EXPECT_FALSE(records.back()["bodies"][0].contains("detail")) << "it stayed LoD2";
}

}  // namespace
}  // namespace blockrand::outputs
