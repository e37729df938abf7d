#include "pipeline/run/earlier_area.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "pipeline/base/sha256.h"

namespace blockrand::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void pack_facts(base::Packer& key, const TileChoice& area, const georef::Projection& projection) {
  const RegionFacts& facts = area.facts;
  key << facts.crs << facts.box << facts.centre << area.placeless;
  // Which of its tiles lie among the buildings of the whole.
  const int steps = area.tile_level - area.id.level;
  const auto last = [&](std::uint32_t n) { return ((n + 1) << steps) - 1; };
  const std::optional<TileRange> here = common(area.region, {{area.tile_level, area.id.x << steps, area.id.y << steps},
                                                             {area.tile_level, last(area.id.x), last(area.id.y)}});
  key << here.has_value();
  if (here) key << here->low << here->high;
  const auto& [west, south, east, north] = area.window;
  const auto unit = [](double degrees) { return static_cast<std::int32_t>(std::lround(degrees * 1e7)); };
  double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 8; ++j) {
      const model::Point2 p = projection.forward(
          model::Location{unit(west + (east - west) * i / 8), unit(south + (north - south) * j / 8)});
      low_x = std::min(low_x, p.x), low_y = std::min(low_y, p.y);
      high_x = std::max(high_x, p.x), high_y = std::max(high_y, p.y);
    }
  constexpr double kMargin = 500;  // m: sides of the window are curved in the projection
  low_x -= kMargin, low_y -= kMargin, high_x += kMargin, high_y += kMargin;
  for (std::size_t i = 0; i < facts.coverage.size(); ++i) {
    const model::Point2 a = facts.coverage[i], b = facts.coverage[(i + 1) % facts.coverage.size()];
    if (std::max(a.x, b.x) < low_x || std::min(a.x, b.x) > high_x || std::max(a.y, b.y) < low_y ||
        std::min(a.y, b.y) > high_y)
      continue;
    key << a << b;
  }
  key << facts.coverage.empty();
  for (const attributes::PinnedArea& place : facts.areas) {
    std::int32_t x0 = INT32_MAX, y0 = INT32_MAX, x1 = INT32_MIN, y1 = INT32_MIN;
    for (const auto& ring : place.rings)
      for (const model::Location l : ring)
        x0 = std::min(x0, l.lon), y0 = std::min(y0, l.lat), x1 = std::max(x1, l.lon), y1 = std::max(y1, l.lat);
    // A node has a radius, which its question tells.
    const bool point = place.rings.size() == 1 && place.rings.front().size() == 1;
    if (point || (x0 <= unit(east) && x1 >= unit(west) && y0 <= unit(north) && y1 >= unit(south))) key << place;
  }
}

Json json_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return file ? Json::parse(file, nullptr, false) : Json();
}

bool area_is_whole(const std::string& folder, const std::string& build_sha256, std::vector<std::string>& paths) {
  std::error_code error;
  if (!fs::is_regular_file(folder + "/build.json", error) || base::sha256_file(folder + "/build.json") != build_sha256)
    return false;
  const fs::file_time_type written = fs::last_write_time(folder + "/run.json", error);
  const Json record = json_of(folder + "/build.json");
  for (const auto& [path, entry] : record.at("files").items()) {
    const std::string place = folder + "/" + path;
    if (fs::path(path).lexically_normal() != path || path.starts_with("..") || path.starts_with("/")) return false;
    if (fs::file_size(place, error) != entry.at("bytes").get<std::uint64_t>() || error) return false;
    if (fs::last_write_time(place, error) > written && base::sha256_file(place) != entry.at("sha256")) return false;
    paths.push_back(path);
  }
  return true;
}

}  // namespace blockrand::run
