#include "pipeline/run/region_facts.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/run/configuration.h"

namespace blockrand::run {

namespace {

double finite(const nlohmann::json& value) {
  const double v = value.get<double>();
  if (!std::isfinite(v)) throw std::runtime_error("a number is not finite");
  return v;
}

attributes::PinnedArea pinned_area(const nlohmann::json& j) {
  attributes::PinnedArea area{j.at("question").get<std::string>(), j.at("value").get<std::string>(), {}, {}};
  const std::string id = j.at("id").get<std::string>();
  area.id.type = id.at(0) == 'n'   ? model::OsmType::node
                 : id.at(0) == 'w' ? model::OsmType::way
                                   : model::OsmType::relation;
  area.id.number = std::stoll(id.substr(1));
  for (const nlohmann::json& ring : j.at("rings")) {
    std::vector<model::Location>& out = area.rings.emplace_back();
    for (std::size_t i = 0; i + 1 < ring.size(); i += 2)
      out.push_back({ring.at(i).get<std::int32_t>(), ring.at(i + 1).get<std::int32_t>()});
  }
  return area;
}

}  // namespace

RegionFacts read_region_facts(const std::string& path, const BuildOptions& options) {
  constexpr const char* kRemedy = "Name the build.json of a finished build of the whole extract, made by this version.";
  std::ifstream file(path, std::ios::binary);
  if (!file) throw base::InputError(path, "", "cannot be opened", kRemedy);
  try {
    const nlohmann::json j = nlohmann::json::parse(file);
    const nlohmann::json& r = j.at("region");
    RegionFacts facts;
    facts.crs = j.at("crs").at("code").get<std::string>();
    const nlohmann::json& box = r.at("box");
    facts.box = {finite(box.at(0)), finite(box.at(1)), finite(box.at(2)), finite(box.at(3))};
    facts.centre = {finite(r.at("centre").at(0)), finite(r.at("centre").at(1))};
    if (const std::string name = first_difference(j.at("configuration"), options); !name.empty())
      throw base::UsageError(path + ": that build had another " + name +
                             ", so this tile would not fit into it. Build with the same options");
    for (const nlohmann::json& p : r.at("coverage")) facts.coverage.push_back({finite(p.at(0)), finite(p.at(1))});
    for (const nlohmann::json& area : r.at("areas")) facts.areas.push_back(pinned_area(area));
    if (j.contains("imagery")) facts.imagery_sha256 = j.at("files").at("imagery.json").at("sha256").get<std::string>();
    return facts;
  } catch (const base::UsageError&) {
    throw;
  } catch (const std::exception& e) {
    throw base::InputError(path, "", std::string("holds no facts about its region (") + e.what() + ")", kRemedy);
  }
}

}  // namespace blockrand::run
