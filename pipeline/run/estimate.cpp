#include "pipeline/run/estimate.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipeline/base/parallel.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/outputs/output.h"

namespace blockrand::run {
namespace {

using model::Extract;
using model::MappedBuilding;

constexpr double kMetresPerUnit = 0.0111319;  // of latitude: 1e-7 degrees
constexpr double kRadiansPerUnit = 1.7453292519943295e-9;
constexpr double kStoreyHeight = 3.0;  // m
constexpr double kWithRoof = 0.85;     // of a tagged height is wall
constexpr double kHouse = 100;  // m2: larger plans have kManyStoreys where too few are tagged, others kFewStoreys
constexpr double kManyStoreys = 4, kFewStoreys = 2;
constexpr double kOutbuilding = 30;  // m2: smaller plans have hardly a window
constexpr double kBeyondWall = 0.7;  // m: what stands there stands at the wall
constexpr double kCell = 60;         // m, of the grid in which neighbours are looked for
constexpr std::size_t kEnoughTagged = 20;

/// Storeys above ground, as tagged; 0: not.
double tagged_storeys(const model::MappedAttributes& a) {
  if (a.storeys) return std::clamp<double>(*a.storeys - a.min_storey.value_or(0), 0, 60);
  if (a.height) return std::clamp<double>(kWithRoof * (*a.height - a.min_height.value_or(0)) / kStoreyHeight, 0, 60);
  return 0;
}

/// Of buildings without a tag: the middle of the tagged ones, where these are many enough to speak for the others; else 0.
double usual_storeys(const Extract& extract) {
  std::vector<double> tagged;
  std::size_t all = 0;
  for (const MappedBuilding& b : extract.buildings) {
    if (b.kind != model::ObjectKind::building) continue;
    ++all;
    if (b.attributes.storeys) tagged.push_back(tagged_storeys(b.attributes));
  }
  if (tagged.size() < kEnoughTagged || 4 * tagged.size() < all) return 0;
  const auto middle = tagged.begin() + static_cast<std::ptrdiff_t>(tagged.size() / 2);
  std::nth_element(tagged.begin(), middle, tagged.end());
  return *middle;
}

struct Place {
  double x = 0, y = 0;  ///< m, in a frame that is straight enough for what touches
};

/// Outlines in a grid: how far a wall is seen from outside.
class WallMeter {
 public:
  explicit WallMeter(const Extract& extract) : extract_(extract), usual_(usual_storeys(extract)) {
    for (std::uint32_t i = 0; i < extract.buildings.size(); ++i) {
      const MappedBuilding& b = extract.buildings[i];
      if (b.kind != model::ObjectKind::building || b.state != model::ObjectState::pending) continue;
      Place low{1e300, 1e300}, high{-1e300, -1e300};
      for_each_edge(b, [&](Place p, Place, bool) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      });
      if (high.x - low.x > 3000 || high.y - low.y > 3000) continue;  // no house, or across 180 degrees
      for (std::int64_t x = cell(low.x); x <= cell(high.x); ++x)
        for (std::int64_t y = cell(low.y); y <= cell(high.y); ++y) grid_[key(x, y)].push_back(i);
    }
  }

  /// m2 of wall that nothing stands at.
  double walls(std::uint32_t index) const {
    const MappedBuilding& b = extract_.buildings[index];
    if (b.kind != model::ObjectKind::building || b.rings.count == 0) return 0;  // parts are their outline's
    double area = 0;
    for_each_edge(b, [&](Place p, Place q, bool inner) {
      if (!inner) area += (p.x * q.y - p.y * q.x) / 2;
    });
    if (std::fabs(area) < kOutbuilding) return 0;
    const double storeys = storeys_of(b, std::fabs(area));
    double walls = 0;
    for_each_edge(b, [&](Place p, Place q, bool) {
      const double length = std::hypot(q.x - p.x, q.y - p.y);
      if (length < 1e-3 || length > 3000) return;
      double hidden = 0;  // storeys: on either side, since rings have either orientation
      for (const double side : {-kBeyondWall, kBeyondWall}) {
        const Place at{(p.x + q.x) / 2 + side * (q.y - p.y) / length, (p.y + q.y) / 2 - side * (q.x - p.x) / length};
        const auto found = grid_.find(key(cell(at.x), cell(at.y)));
        if (found == grid_.end()) continue;
        for (const std::uint32_t other : found->second)
          if (other != index && holds(extract_.buildings[other], at))
            hidden = std::max(hidden, storeys_of(extract_.buildings[other], std::fabs(area)));
      }
      walls += length * kStoreyHeight * std::max(0.0, storeys - hidden);
    });
    return walls;
  }

 private:
  Place place(model::Location l) const { return {l.lon * kMetresPerUnit * across_, l.lat * kMetresPerUnit}; }
  static std::int64_t cell(double metres) { return static_cast<std::int64_t>(std::floor(metres / kCell)); }
  static std::int64_t key(std::int64_t x, std::int64_t y) { return x * 4'000'000 + y; }
  double storeys_of(const MappedBuilding& b, double area) const {
    if (const double storeys = tagged_storeys(b.attributes); storeys > 0) return storeys;
    return usual_ > 0 ? usual_ : area >= kHouse ? kManyStoreys : kFewStoreys;
  }
  template <class Visit>
  void for_each_edge(const MappedBuilding& b, Visit&& visit) const {
    for (const model::MappedRing& ring : extract_.rings_of(b.rings)) {
      const auto points = extract_.vertices_of(ring);
      for (std::size_t i = 0; i < points.size(); ++i)
        visit(place(points[i]), place(points[(i + 1) % points.size()]), ring.inner);
    }
  }
  bool holds(const MappedBuilding& b, Place at) const {
    bool inside = false;
    for_each_edge(b, [&](Place p, Place q, bool) {
      if ((p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) / (q.y - p.y) * (q.x - p.x)) inside = !inside;
    });
    return inside;
  }

  const Extract& extract_;
  double usual_;
  double across_ = extract_.vertices.empty() ? 1 : base::cos(extract_.vertices.front().lat * kRadiansPerUnit);
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> grid_;
};

/// Bytes on the disk of what stands around a house, by format: of Monaco with all layers (1,205 buildings).
double bytes_around_a_building(const BuildOptions& options) {
  if (!options.surroundings.settled(options.lod).any()) return 0;
  constexpr std::pair<std::string_view, double> kFormats[] = {
      {"gltf", 3e3}, {"citygml", 20e3}, {"cityjson", 8e3}, {"gpkg", 9e3}};
  double bytes = 0;
  for (const auto& [format, each] : kFormats)
    if (options.outputs.writes(format)) bytes += each;
  return bytes;
}

}  // namespace

TownSize town_size(const Extract& extract, std::span<const footprints::Shard> shards) {
  const WallMeter meter(extract);
  TownSize town;
  const auto add = [&](std::uint32_t index, outputs::BuiltSize& tile) {
    const MappedBuilding& b = extract.buildings[index];
    if (b.state != model::ObjectState::pending || b.rings.count == 0) return;
    ++tile.buildings;
    tile.walls += meter.walls(index);
  };
  for (const footprints::Shard& shard : shards) {
    outputs::BuiltSize tile;
    for (const footprints::Seed& seed : shard.seeds) {
      if (seed.outline != model::kNoIndex) add(seed.outline, tile);
      for (const std::uint32_t part : seed.parts) add(part, tile);
    }
    if (tile.buildings == 0) continue;
    ++town.tiles;
    town.all.buildings += tile.buildings, town.all.walls += tile.walls;
    if (tile.walls >= town.tile.walls) town.tile = tile;
  }
  return town;
}

outputs::BuiltSize usual_size(std::uint64_t buildings) {
  constexpr double kWalls = 200;  // m2: a house of a large town, outbuildings among them
  return {buildings, kWalls * static_cast<double>(buildings)};
}

std::uint64_t disk_bytes(const outputs::BuiltSize& size, const BuildOptions& options, std::optional<double> per_wall) {
  outputs::OutputSize each = outputs::output_size(options.outputs, options.lod);
  each.per_building += bytes_around_a_building(options);
  if (per_wall) each.per_wall = *per_wall;
  return static_cast<std::uint64_t>(each.bytes(size));
}

BuildEstimate estimate(const TownSize& town, const BuildOptions& options, double read_seconds,
                       std::uint64_t store_bytes, std::optional<double> per_wall) {
  // Two cores of 2023; right within a factor of three on other machines and towns.
  constexpr double kObjectsPerSecondAndCore[4] = {6'000, 3'000, 900, 500};
  constexpr double kFixedSeconds = 1.5;
  const auto level = static_cast<std::size_t>(std::clamp(options.lod, 0, 3));
  const outputs::OutputSize size = outputs::output_size(options.outputs, options.lod);
  const int jobs = base::worker_count(options.jobs);
  const auto objects = static_cast<double>(town.all.buildings);
  BuildEstimate e;
  e.seconds = kFixedSeconds + read_seconds + objects / (kObjectsPerSecondAndCore[level] * jobs);
  // What grows with the town and is not there when it has been read: walls' surroundings, facts, styles. Not in step with
  // it, since most of it is gone before the tiles.
  constexpr double kPerRootOfObjects = 0.55e6, kFixed = 10e6;
  // Tiles in flight hold what becomes their facades, and the texts of it in all formats at a time: two thirds of what it takes on the disk.
  constexpr double kFacades = 10e6, kOfDisk = 0.7;
  const double in_flight = std::min(2.0 * jobs + 2, static_cast<double>(town.tiles));
  double memory = static_cast<double>(store_bytes) + kFixed + size.memory + kPerRootOfObjects * std::sqrt(objects);
  if (options.lod >= 3) memory += kFacades + kOfDisk * per_wall.value_or(size.per_wall) * town.tile.walls * in_flight;
  e.memory_bytes = static_cast<std::uint64_t>(memory);
  e.disk_bytes = disk_bytes(town.all, options, per_wall);
  return e;
}

std::uint64_t current_memory() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace blockrand::run
