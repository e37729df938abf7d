#include "pipeline/cli/explain_chip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "pipeline/base/attribution.h"
#include "pipeline/base/error.h"
#include "pipeline/picture/image.h"
#include "pipeline/picture/lettering.h"

namespace blockrand::cli {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// m about a building's outline; pixels: small pieces are enlarged to as much, by whole factors.
constexpr double kAround = 8;
constexpr int kLeastSide = 400, kMostTimes = 4;

/// What is added to a file's name until it is whole.
constexpr const char* kBeside = ".part";

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw std::runtime_error(path + " cannot be read");
  return text.str();
}

/// A world file (ESRI): size of a pixel and the place of the upper left corner, m.
struct World {
  double pixel = 0, west = 0, north = 0;
};

World world_of(const std::string& text) {
  std::istringstream in(text);
  std::array<double, 6> w{};
  for (double& v : w) in >> v;
  if (!in || !(w[0] > 0) || w[3] != -w[0]) throw std::runtime_error("its world file (.pgw) is damaged");
  return {w[0], w[4] - w[0] / 2, w[5] + w[0] / 2};
}

/// Each pixel `times` times in both directions.
picture::Image enlarged(const picture::Image& image, int times) {
  picture::Image out{image.width * times, image.height * times, {}};
  out.rgb.reserve(image.rgb.size() * static_cast<std::size_t>(times) * static_cast<std::size_t>(times));
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const std::uint8_t* from = image.pixel(x / times, y / times);
      out.rgb.insert(out.rgb.end(), from, from + 3);
    }
  return out;
}

picture::Image piece_of(const std::string& overlay, const Json& imagery) {
  const World world = world_of(content_of(overlay.substr(0, overlay.size() - 4) + ".pgw"));
  const auto length = [](double x, double y) { return std::sqrt(x * x + y * y); };
  const Json &box = imagery.at("box"), &lean = imagery.at("lean");
  const double around = kAround + length(imagery.value("shift_east", 0.0), imagery.value("shift_north", 0.0)) +
                        length(lean.at(0).get<double>(), lean.at(1).get<double>()),
               west = box.at(0).get<double>() - around, south = box.at(1).get<double>() - around,
               east = box.at(2).get<double>() + around, north = box.at(3).get<double>() + around;
  const auto pixels = [&](double metres) {
    return static_cast<int>(std::clamp(std::round(metres / world.pixel), -1e6, 1e6));
  };
  const picture::Image piece = picture::cut(picture::read_png(content_of(overlay)), pixels(west - world.west),
                                            pixels(world.north - north), pixels(east - west), pixels(north - south));
  if (piece.rgb.empty()) throw std::runtime_error("it does not show this building");
  return enlarged(piece, std::clamp(kLeastSide / std::max(piece.width, piece.height), 1, kMostTimes));
}

/// Whose data the pictures of a build show.
std::string attribution_in(const std::string& folder) {
  std::ifstream in(folder + "/imagery.json", std::ios::binary);
  const Json j = Json::parse(in, nullptr, false);
  return j.is_object() ? j.value("attribution", base::kAttribution) : base::kAttribution;
}

/// Through a file beside it: what is there under its name is whole.
void write_whole(const std::string& file, const std::string& bytes) {
  const std::string beside = file + kBeside;
  std::error_code error;
  {
    std::ofstream out(beside, std::ios::binary);
    out << bytes;
    out.close();
    if (out) fs::rename(beside, file, error);
    if (out && !error) return;
  }
  fs::remove(beside, error);
  throw base::OutputError(file + ": cannot be written. Check the folder and the space on the disk");
}

}  // namespace

std::string overlay_path(const std::string& folder, const outputs::FoundExplanation& found) {
  const Json j = Json::parse(found.json, nullptr, false);
  if (!j.is_object() || !j.contains("imagery")) return {};
  std::string path = folder + "/imagery/" + j.value("tile", "") + ".png";
  std::error_code error;
  return fs::is_regular_file(path, error) ? path : "";
}

void write_chip(const std::string& folder, const outputs::FoundExplanation& found, const std::string& file) {
  const std::string what = found.explained.text(), overlay = overlay_path(folder, found);
  if (overlay.empty())
    throw base::InputError(folder, what, "this build has no aerial image of it",
                           "Build with --imagery FILE of an image that shows it, or leave out --chip");
  std::error_code error;
  for (const std::string& there : {file, file + kBeside})
    if (fs::exists(there, error)) throw base::UsageError(there + " is there already. Name another file, or remove it");
  std::string bytes;
  try {
    picture::Image piece = piece_of(overlay, Json::parse(found.json).at("imagery"));
    picture::sign(piece, attribution_in(folder));
    bytes = picture::png(piece);
  } catch (const std::exception& wrong) {
    throw base::InputError(overlay, what, wrong.what(), "Build again; 'blockrand validate' lists all damage");
  }
  write_whole(file, bytes);
}

}  // namespace blockrand::cli
