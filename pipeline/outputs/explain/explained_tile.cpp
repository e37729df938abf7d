#include "pipeline/outputs/explain/explained_tile.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/outputs/area_folders.h"
#include "pipeline/outputs/explain/plain_explanation.h"
#include "pipeline/outputs/gzip.h"

namespace blockrand::outputs {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestTileName = 40;

/// "15_35206_25947": three numbers.
bool is_tile_name(std::string_view tile) {
  return tile.size() <= kLongestTileName && tile.find_first_not_of("0123456789_") == std::string_view::npos &&
         std::count(tile.begin(), tile.end(), '_') == 2 && !tile.starts_with('_') && !tile.ends_with('_') &&
         tile.find("__") == std::string_view::npos;
}

/// Every line begins with it: {"id":"w123",
std::string id_of(std::string_view line) {
  constexpr std::string_view kBefore = "{\"id\":\"";
  if (!line.starts_with(kBefore)) throw std::runtime_error("a line has no id");
  line.remove_prefix(kBefore.size());
  return std::string(line.substr(0, line.find('"')));
}

/// The lines of a tile as one JSON object.
std::string plain_tile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  Json all = Json::object();
  try {
    const std::string text = gunzip(bytes);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string_view line = std::string_view(text).substr(at, end - at);
      const PlainExplanation plain = plain_explanation(line);
      all[id_of(line)] = {{"title", plain.title}, {"lines", plain.lines}};
      at = end + 1;
    }
  } catch (const std::exception& error) {
    throw base::InputError(path, "", error.what(), "Build again; 'blockrand validate' lists all damage");
  }
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::optional<std::string> explained_tile(const std::string& folder, std::string_view tile) {
  if (!is_tile_name(tile)) return std::nullopt;
  std::vector<std::string> folders{folder};
  for (const std::string& area : area_folders(folder)) folders.push_back(folder + "/" + area);
  for (const std::string& each : folders) {
    const std::string path = each + "/explain/" + std::string(tile) + ".jsonl.gz";
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) return plain_tile(path);
  }
  return std::nullopt;
}

}  // namespace blockrand::outputs
