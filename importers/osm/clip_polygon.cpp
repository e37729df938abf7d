#include "importers/osm/clip_polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "pipeline/base/error.h"

namespace blockrand::importers::osm {
namespace {

constexpr std::size_t kMostBands = 4096;

std::string trimmed(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
  return first == std::string::npos ? std::string() : line.substr(first, last - first + 1);
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

ClipPolygon::ClipPolygon(std::span<const Rings> polygons, std::span<const Rings> holes) {
  add(polygons, polygons_);
  add(holes, holes_);
}

bool ClipPolygon::contains(model::Location place) const { return holds(polygons_, place) && !holds(holes_, place); }

void ClipPolygon::add(std::span<const Rings> polygons, std::vector<Banded>& out) {
  for (const Rings& rings : polygons) {
    std::vector<Edge> edges;
    for (const std::vector<model::Location>& ring : rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const model::Location a = ring[i], b = ring[(i + 1) % ring.size()];
        if (a.lat < b.lat) edges.push_back({a, b});
        if (a.lat > b.lat) edges.push_back({b, a});
      }
    if (edges.empty()) continue;
    Banded& banded = out.emplace_back();
    banded.south = edges.front().low.lat, banded.north = edges.front().high.lat;
    for (const Edge& e : edges) {
      banded.south = std::min<std::int64_t>(banded.south, e.low.lat);
      banded.north = std::max<std::int64_t>(banded.north, e.high.lat);
    }
    const auto bands = static_cast<std::int64_t>(std::min(kMostBands, edges.size()));
    banded.height = (banded.north - banded.south) / bands + 1;
    banded.bands.resize(static_cast<std::size_t>(bands));
    for (const Edge& e : edges)
      for (std::int64_t band = (e.low.lat - banded.south) / banded.height;
           band <= (e.high.lat - banded.south) / banded.height; ++band)
        banded.bands[static_cast<std::size_t>(band)].push_back(e);
  }
}

bool ClipPolygon::holds(const std::vector<Banded>& polygons, model::Location place) {
  return std::ranges::any_of(polygons, [&](const Banded& polygon) {
    if (place.lat < polygon.south || place.lat > polygon.north) return false;
    bool inside = false;
    for (const Edge& e : polygon.bands[static_cast<std::size_t>((place.lat - polygon.south) / polygon.height)]) {
      if (place.lat < e.low.lat || place.lat >= e.high.lat) continue;
      // Whether the edge passes east of the place. Differences have 33 bits at most, their products 66: in 128.
      const __int128 run = static_cast<std::int64_t>(e.high.lon) - e.low.lon,
                     rise = static_cast<std::int64_t>(e.high.lat) - e.low.lat,
                     up = static_cast<std::int64_t>(place.lat) - e.low.lat,
                     along = static_cast<std::int64_t>(place.lon) - e.low.lon;
      if (along * rise < run * up) inside = !inside;
    }
    return inside;
  });
}

ClipPolygon read_poly_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw base::InputError(path, "", "cannot be read", "Check the path");
  std::size_t number = 0;
  const auto wrong = [&](const std::string& what) {
    return base::InputError(path, fmt::format("line {}", number), what,
                            "A .poly file has a name, sections of longitude and latitude that end with END, and END");
  };
  std::vector<ClipPolygon::Rings> outer, holes;
  bool is_hole = false;
  std::string line;
  std::optional<std::vector<model::Location>> ring;
  bool named = false, ended = false;
  while (std::getline(file, line)) {
    ++number;
    const std::string text = trimmed(line);
    if (text.empty()) continue;
    if (ended) throw wrong("something follows the last END");
    if (!named) {
      named = true;
    } else if (!ring) {
      if (text == "END")
        ended = true;
      else
        ring.emplace(), is_hole = text.starts_with('!');
    } else if (text == "END") {
      if (ring->size() > 1 && ring->front() == ring->back()) ring->pop_back();
      if (ring->size() < 3) throw wrong("a section has fewer than three points");
      (is_hole ? holes : outer).push_back({std::move(*ring)});
      ring.reset();
    } else {
      std::istringstream words(text);
      std::string lon, lat, more;
      words >> lon >> lat;
      const std::optional<double> x = number_in(lon), y = number_in(lat);
      if (words >> more || !x || !y || std::abs(*x) > 180 || std::abs(*y) > 90)
        throw wrong("is no longitude and latitude");
      ring->push_back(
          {static_cast<std::int32_t>(std::lround(*x * 1e7)), static_cast<std::int32_t>(std::lround(*y * 1e7))});
    }
  }
  if (!ended) throw wrong("the file breaks off: the last END is missing");
  if (outer.empty()) throw wrong("there is no section that is no hole");
  return ClipPolygon(outer, holes);
}

}  // namespace blockrand::importers::osm
