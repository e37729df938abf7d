#include "pipeline/outputs/area_folders.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace blockrand::outputs {

std::vector<std::string> area_folders(const std::string& folder) {
  std::vector<std::string> out;
  std::ifstream file(folder + "/build.json", std::ios::binary);
  const nlohmann::ordered_json record = nlohmann::ordered_json::parse(file, nullptr, false);
  if (!record.is_object() || !record.contains("areas") || !record["areas"].is_object()) return out;
  for (const auto& [area, entry] : record["areas"].items()) {
    // Whoever writes there must not lead elsewhere by it.
    if (area.find_first_not_of("0123456789/") != std::string::npos) continue;
    out.push_back("areas/" + area);
  }
  return out;
}

}  // namespace blockrand::outputs
