#include "pipeline/outputs/view_record.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace blockrand::outputs {

using Json = nlohmann::ordered_json;

std::optional<TilesetExtent> extent_of_tileset(std::string_view tileset) {
  const Json json = Json::parse(tileset, nullptr, false);
  try {
    const Json& region = json.at("root").at("boundingVolume").at("region");
    const auto degrees = [&](std::size_t i) { return region.at(i).get<double>() * 180 / std::numbers::pi; };
    const double west = degrees(0), east = degrees(2);
    TilesetExtent extent;
    extent.longitude = (west + (east < west ? east + 360 : east)) / 2;
    if (extent.longitude > 180) extent.longitude -= 360;
    extent.latitude = (degrees(1) + degrees(3)) / 2;
    extent.height = region.at(4).get<double>();
    return extent;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string view_json(const ViewRecord& record) {
  const auto rounded = [](double value, double steps) { return std::nearbyint(value * steps) / steps; };
  Json json;
  json["name"] = record.name;
  json["lod"] = record.lod;
  json["buildings"] = record.buildings;
  json["attribution"] = record.attribution;
  json["centre"] = {{"lon", rounded(record.extent.longitude, 1e7)},
                    {"lat", rounded(record.extent.latitude, 1e7)},
                    {"height", rounded(record.extent.height, 100)}};
  json["tileset"] = record.tileset;
  json["places"] = record.places;
  json["explained"] = record.explained ? Json(*record.explained) : Json();
  json["data_time"] = record.data_time;
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace blockrand::outputs
