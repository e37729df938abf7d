#include "pipeline/observation/mapped_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::observation {

namespace {

using model::Feature;
using model::FeatureKind;
using model::Point2;

/// Of a roof's lean: heights are guessed, so that roofs may be seen farther away; m between the steps of the way there.
constexpr double kLeanDoubt = 1.5, kLeanStep = 1.5;

struct Half {
  std::string_view value;
  double metres;
};

/// m: half of the usual width between the kerbs. Ways that are not listed, paths above all, cover nothing.
constexpr std::array<Half, 14> kStreets{{{"motorway", 7},
                                         {"trunk", 6},
                                         {"primary", 5},
                                         {"secondary", 4.5},
                                         {"tertiary", 4},
                                         {"unclassified", 3},
                                         {"residential", 3},
                                         {"living_street", 2.5},
                                         {"pedestrian", 2.5},
                                         {"road", 3},
                                         {"service", 2},
                                         {"motorway_link", 4},
                                         {"trunk_link", 4},
                                         {"primary_link", 4}}};
/// m: half of a railway's track, and of water that is mapped as a line.
constexpr double kTrack = 2.5, kRiver = 4, kStream = 1;

double half_width(std::string_view highway) {
  for (const Half& h : kStreets)
    if (h.value == highway) return h.metres;
  return 0;
}

/// Half of the width of a line, 0 of an area; nothing where a building may stand.
std::optional<double> covers(const model::Extract& extract, const Feature& f) {
  const auto tag = [&](std::string_view key) { return extract.tag(f.tags, key); };
  const auto below = [&] {
    const std::string_view tunnel = tag(model::osm_key::kTunnel), layer = tag(model::osm_key::kLayer);
    return (!tunnel.empty() && tunnel != "no") || (!layer.empty() && layer.front() == '-');
  };
  if (f.area) {
    const std::string_view leisure = tag(model::osm_key::kLeisure);
    const bool bare = f.is(FeatureKind::water) || f.is(FeatureKind::street) ||
                      tag(model::osm_key::kAmenity) == "parking" || leisure == "pitch" || leisure == "track" ||
                      leisure == "swimming_pool";
    return bare && !below() ? std::optional(0.0) : std::nullopt;
  }
  double half = 0;
  if (f.is(FeatureKind::street)) half = half_width(tag(model::osm_key::kHighway));
  if (f.is(FeatureKind::railway) &&
      (tag(model::osm_key::kRailway) == "rail" || tag(model::osm_key::kRailway) == "tram" ||
       tag(model::osm_key::kRailway) == "light_rail"))
    half = kTrack;
  if (f.is(FeatureKind::water))
    half = tag(model::osm_key::kWaterway) == "river" || tag(model::osm_key::kWaterway) == "canal" ? kRiver : kStream;
  return half > 0 && !below() ? std::optional(half) : std::nullopt;
}

/// Columns whose centres lie between two places east.
struct Columns {
  int first, last;  ///< the second is the first one beyond
};
Columns columns_of(const Patch& patch, double west, double east) {
  const auto at = [&](double x) {
    return static_cast<int>(std::ceil(std::clamp((x - patch.west) / patch.size - 0.5, -1.0, patch.width + 1.0)));
  };
  return {std::max(0, at(west)), std::min(patch.width, at(east))};
}

/// Rows whose centres lie between two places north.
Columns rows_of(const Patch& patch, double south, double north) {
  const auto at = [&](double y) {
    return static_cast<int>(std::ceil(std::clamp((patch.north - y) / patch.size - 0.5, -1.0, patch.height + 1.0)));
  };
  return {std::max(0, at(north)), std::min(patch.height, at(south))};
}

std::size_t index_in(const Patch& patch, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(patch.width) + static_cast<std::size_t>(column);
}

void fill_line(const Patch& patch, std::span<const Point2> line, double half, std::vector<std::uint8_t>& filled) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point2 a = line[i], b = line[i + 1];
    const Columns rows = rows_of(patch, std::min(a.y, b.y) - half, std::max(a.y, b.y) + half);
    const double west = std::min(a.x, b.x) - half, east = std::max(a.x, b.x) + half;
    // Of a row only what is so near the line that goes on at both ends.
    const double dx = b.x - a.x, dy = b.y - a.y,
                 beside = dy != 0 ? half * std::sqrt(dx * dx + dy * dy) / std::fabs(dy) + patch.size : 0;
    for (int r = rows.first; r < rows.last; ++r) {
      const double y = patch.north - (r + 0.5) * patch.size, x = dy != 0 ? a.x + dx * (y - a.y) / dy : 0;
      const Columns columns = dy != 0 ? columns_of(patch, std::max(west, x - beside), std::min(east, x + beside))
                                      : columns_of(patch, west, east);
      for (int c = columns.first; c < columns.last; ++c) {
        const Point2 p{patch.west + (c + 0.5) * patch.size, y};
        if (geometry::distance_to_segment(p, a, b) <= half) filled[index_in(patch, c, r)] = 1;
      }
    }
  }
}

/// Grows what is filled by some pixels along rows, then along columns.
void grow(const Patch& patch, int by, std::vector<std::uint8_t>& filled) {
  const auto along = [&](int lines, int length, std::size_t from_line, std::size_t from_pixel) {
    std::vector<std::uint8_t> line(static_cast<std::size_t>(length));
    for (int k = 0; k < lines; ++k) {
      const std::size_t start = static_cast<std::size_t>(k) * from_line;
      int until = -1;  // what is filled reaches to here
      std::fill(line.begin(), line.end(), std::uint8_t{0});
      for (int i = 0; i < length; ++i) {
        if (!filled[start + static_cast<std::size_t>(i) * from_pixel]) continue;
        for (int j = std::max(until + 1, i - by); j <= std::min(length - 1, i + by); ++j)
          line[static_cast<std::size_t>(j)] = 1;
        until = std::min(length - 1, i + by);
      }
      for (int i = 0; i < length; ++i)
        filled[start + static_cast<std::size_t>(i) * from_pixel] = line[static_cast<std::size_t>(i)];
    }
  };
  const auto width = static_cast<std::size_t>(patch.width);
  along(patch.height, patch.width, width, 1);
  along(patch.width, patch.height, 1, width);
}

geometry::PlanBox box_of(const Patch& patch) {
  return {{patch.west, patch.north - patch.height * patch.size}, {patch.west + patch.width * patch.size, patch.north}};
}

}  // namespace

void fill_rings(const Patch& patch, std::span<const std::span<const Point2>> rings, Point2 shift,
                std::vector<std::uint8_t>& filled) {
  double south = 1e300, north = -1e300;
  for (const std::span<const Point2> ring : rings)
    for (const Point2 p : ring) south = std::min(south, p.y + shift.y), north = std::max(north, p.y + shift.y);
  if (south > north) return;
  const Columns rows = rows_of(patch, south, north);
  std::vector<double> cuts;
  for (int r = rows.first; r < rows.last; ++r) {
    const double y = patch.north - (r + 0.5) * patch.size - shift.y;
    cuts.clear();
    for (const std::span<const Point2> ring : rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
        if ((a.y > y) != (b.y > y)) cuts.push_back(a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y) + shift.x);
      }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 0; k + 1 < cuts.size(); k += 2) {
      const Columns columns = columns_of(patch, cuts[k], cuts[k + 1]);
      for (int c = columns.first; c < columns.last; ++c) filled[index_in(patch, c, r)] = 1;
    }
  }
}

MappedGround::MappedGround(const model::Extract& extract, const footprints::FootprintStore& footprints,
                           const footprints::BoxIndex& index, const georef::Projection& projection,
                           const std::function<Point2(std::uint32_t)>& lean, Point2 shift)
    : footprints_(footprints), index_(index), leans_(footprints.size()) {
  for (std::uint32_t b = 0; b < footprints.size(); ++b) {
    if (footprints[b].box.empty()) continue;
    leans_[b] = lean(b);
    farthest_ = std::max(farthest_, std::sqrt(leans_[b].x * leans_[b].x + leans_[b].y * leans_[b].y));
  }
  std::vector<geometry::PlanBox> boxes;
  for (const Feature& f : extract.features) {
    const std::optional<double> half = covers(extract, f);
    if (!half) continue;
    Way way;
    way.half = *half;
    for (const model::MappedRing& ring : extract.rings_of(f.rings)) {
      std::vector<Point2>& points = way.rings.emplace_back();
      for (const model::Location at : extract.vertices_of(ring)) {
        const Point2 p = projection.forward(at);
        points.push_back({p.x + shift.x, p.y + shift.y});
        way.box.include(points.back());
      }
    }
    boxes.push_back(way.box);
    ways_.push_back(std::move(way));
  }
  way_index_ = geometry::BoxIndex(std::move(boxes));
}

void MappedGround::fill_buildings(const Patch& patch, std::vector<std::uint8_t>& filled) const {
  std::vector<std::span<const Point2>> rings;
  for (const std::uint32_t b : index_.near(box_of(patch), kLeanDoubt * farthest_ + kBesideBuilding)) {
    // Courtyards that the map has open are looked at by themselves.
    rings.clear();
    footprints_.for_each_ring(b, [&](std::span<const Point2> ring, bool hole) {
      if (!hole) rings.push_back(ring);
    });
    const Point2 lean{kLeanDoubt * leans_[b].x, kLeanDoubt * leans_[b].y};
    const int steps = static_cast<int>(std::ceil(std::sqrt(lean.x * lean.x + lean.y * lean.y) / kLeanStep));
    for (int k = 0; k <= steps; ++k) {
      const double at = steps > 0 ? static_cast<double>(k) / steps : 0;
      fill_rings(patch, rings, {lean.x * at, lean.y * at}, filled);
    }
  }
}

std::vector<Mapped> MappedGround::on(const Patch& patch) const {
  std::vector<std::uint8_t> building(patch.valid.size(), 0), ground(patch.valid.size(), 0);
  fill_buildings(patch, building);
  grow(patch, static_cast<int>(std::lround(kBesideBuilding / patch.size)), building);
  constexpr double kWidest = 10;  // m
  for (const std::uint32_t w : way_index_.near(box_of(patch), kWidest)) {
    if (ways_[w].half > 0) {
      for (const std::vector<Point2>& line : ways_[w].rings) fill_line(patch, line, ways_[w].half, ground);
    } else {
      const std::vector<std::span<const Point2>> rings(ways_[w].rings.begin(), ways_[w].rings.end());
      fill_rings(patch, rings, {}, ground);
    }
  }
  std::vector<Mapped> out(patch.valid.size(), Mapped::nothing);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = building[i] ? Mapped::building : ground[i] ? Mapped::ground : Mapped::nothing;
  return out;
}

}  // namespace blockrand::observation
