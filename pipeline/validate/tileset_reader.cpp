#include "pipeline/validate/tileset_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "pipeline/model/vector.h"
#include "pipeline/validate/checked_json.h"

namespace blockrand::validate {
namespace {

using model::Point3;

constexpr int kDeepest = 64;              // levels; a quadtree of the Earth has no more
constexpr double kRadius = 6.37e6;        // m; turns angles into distances
constexpr double kHighestOrigin = 20000;  // m; a frame's origin stands near the ground

/// How far east or west of a region a longitude lies, in radians; regions may cross 180 degrees.
double beside(double lon, double west, double east) {
  if (west <= east) return std::max({west - lon, lon - east, 0.0});
  return lon >= west || lon <= east ? 0 : std::min(west - lon, lon - east);
}

double outside_region(const std::array<double, 6>& r, const Place& p) {
  const double width = std::max(std::cos(p.lat), 1e-6) * kRadius;
  return std::max({beside(p.lon, r[0], r[2]) * width, (r[1] - p.lat) * kRadius, (p.lat - r[3]) * kRadius,
                   r[4] - p.height, p.height - r[5], 0.0});
}

class Reader {
 public:
  Reader(const std::string& name, Tileset& out) : name_(name), out_(out) {}

  void read(const Json& json) {
    if (text(member(member(json, "asset"), "version")) != "1.1") wrong("", "asset.version is not 1.1");
    const Json* extras = member(member(json, "asset"), "extras");
    out_.crs = text(member(extras, "crs"));
    out_.height_reference = text(member(extras, "height_reference"));
    const auto error = number(member(json, "geometricError"));
    if (!error || *error < 0) wrong("", "its geometricError is no number from 0");
    const Json* root = member(json, "root");
    if (!root) return wrong("", "no root");
    if (error && number(member(root, "geometricError")).value_or(0) > *error)
      wrong("", "its geometricError is below its root's");
    for (const char* key : {"extensionsUsed", "extensionsRequired"})
      if (member(json, key)) wrong("", fmt::format("{}: Blockrand's tilesets need none", key));
    tile(*root, nullptr, kIdentity, {}, "root", 0);
  }

 private:
  using Chain = std::vector<std::shared_ptr<const Volume>>;

  void wrong(const std::string& where, const std::string& what) {
    out_.findings.push_back({Check::tileset_rule, name_, where, what});
  }

  void tile(const Json& tile, const Json* parent, const Matrix& above, const Chain& chain, const std::string& where,
            int depth) {
    if (depth > kDeepest) return wrong(where, "nested deeper than any quadtree");
    const auto error = number(member(tile, "geometricError"));
    if (!error || *error < 0) wrong(where, "geometricError is no number from 0");
    if (parent && error && *error > number(member(parent, "geometricError")).value_or(*error))
      wrong(where, fmt::format("geometricError {} above the parent's", *error));
    const Json* refine = member(tile, "refine");
    if (!parent && !refine) wrong(where, "the root needs refine");
    if (refine && text(refine) != "ADD" && text(refine) != "REPLACE") wrong(where, "refine is neither ADD nor REPLACE");
    Matrix own = above;
    if (const Json* transform = member(tile, "transform"))
      if (const auto m = read_transform(*transform, above, where)) own = *m;
    const auto volume = read_volume(member(tile, "boundingVolume"), own, where);
    Chain next;
    if (volume) {
      check_inside(*volume, chain, where);
      next.push_back(volume);
    }
    next.insert(next.end(), chain.begin(), chain.end());

    const Json* children = member(tile, "children");
    const std::size_t child_count = children && children->is_array() ? children->size() : 0;
    if (children && child_count == 0) wrong(where, "children is empty");
    if (member(tile, "contents")) wrong(where, "several contents: Blockrand writes one a tile");
    const Json* content = member(tile, "content");
    if (child_count == 0 && error && *error != 0) wrong(where, "a leaf has geometricError 0");
    if (parent && child_count == 0 && !content) wrong(where, "a leaf without content");
    // Content that its children replace must differ from theirs by what a viewer can measure.
    const bool replaced = content && child_count > 0 && refine && text(refine) == "REPLACE";
    if (content && child_count > 0 && !replaced) wrong(where, "content that its children do not replace");
    if (replaced && error)
      for (std::size_t i = 0; i < child_count; ++i)
        if (number(member((*children)[i], "geometricError")).value_or(0) >= *error)
          wrong(where, "the level that replaces its content is not finer");
    if (content) read_content(*content, own, next, where);
    for (std::size_t i = 0; i < child_count; ++i)
      this->tile((*children)[i], &tile, own, next, fmt::format("{}/{}", where, i), depth + 1);
  }

  void read_content(const Json& content, const Matrix& transform, const Chain& chain, const std::string& where) {
    const std::string uri = text(member(content, "uri"));
    if (uri.empty()) return wrong(where, "content without uri");
    if (uri.find(':') != std::string::npos || uri.starts_with('/') || uri.find("..") != std::string::npos)
      return wrong(where, "content outside of the build: " + uri);
    if (!out_.entries.emplace(uri, TilesetEntry{uri, transform, chain}).second) wrong(where, uri + " is used twice");
    const Point3 origin{transform[12], transform[13], transform[14]};
    if (!(std::fabs(dot(origin, origin)) > 1e12)) return wrong(where, "its content stands nowhere on the Earth");
    const Place place = geodetic(origin);
    const Matrix expected = east_north_up(place);
    double turn = 0;
    for (std::size_t i = 0; i < 12; ++i) turn = std::max(turn, std::fabs(expected[i] - transform[i]));
    if (!(std::fabs(place.height) < kHighestOrigin))
      wrong(where, fmt::format("its origin is {:.0f} m above the ellipsoid", place.height));
    if (!(turn < 1e-9)) wrong(where, fmt::format("its transform is no east-north-up frame: {:.2g} off", turn));
  }

  std::optional<Matrix> read_transform(const Json& json, const Matrix& above, const std::string& where) {
    const auto values = numbers(&json, 16);
    if (!values) {
      wrong(where, "transform is not 16 numbers");
      return std::nullopt;
    }
    Matrix m{};
    std::copy(values->begin(), values->end(), m.begin());
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      wrong(where, "the last row of its transform is not 0 0 0 1");
    const Point3 a{m[0], m[1], m[2]}, b{m[4], m[5], m[6]}, c{m[8], m[9], m[10]};
    const double off = std::max({std::fabs(dot(a, a) - 1), std::fabs(dot(b, b) - 1), std::fabs(dot(c, c) - 1),
                                 std::fabs(dot(a, b)), std::fabs(dot(b, c)), std::fabs(dot(c, a))});
    if (!(off < 1e-9)) wrong(where, "its transform is not rigid");
    if ((a.y * b.z - a.z * b.y) * c.x + (a.z * b.x - a.x * b.z) * c.y + (a.x * b.y - a.y * b.x) * c.z < 0)
      wrong(where, "its transform mirrors");
    return above == kIdentity ? m : above * m;
  }

  std::shared_ptr<const Volume> read_volume(const Json* json, const Matrix& matrix, const std::string& where) {
    const Json *region = member(json, "region"), *box = member(json, "box"), *sphere = member(json, "sphere");
    auto volume = std::make_shared<Volume>();
    if ((region != nullptr) + (box != nullptr) + (sphere != nullptr) != 1) {
      wrong(where, "boundingVolume needs exactly one of region, box, sphere");
      return nullptr;
    }
    const auto rotated = [&](double x, double y, double z) {
      return apply(matrix, {x, y, z}) - Point3{matrix[12], matrix[13], matrix[14]};
    };
    if (region) {
      const auto r = numbers(region, 6);
      if (!r) return wrong(where, "region is not 6 numbers"), nullptr;
      std::copy(r->begin(), r->end(), volume->region.begin());
      constexpr double kPi = std::numbers::pi + 1e-12;
      const auto& v = volume->region;
      if (std::fabs(v[0]) > kPi || std::fabs(v[2]) > kPi || std::fabs(v[1]) > kPi / 2 || std::fabs(v[3]) > kPi / 2)
        wrong(where, "region beyond the Earth: angles are in radians");
      if (v[1] > v[3] || v[4] > v[5]) wrong(where, "region from above to below");
    } else if (box) {
      const auto b = numbers(box, 12);
      if (!b) return wrong(where, "box is not 12 numbers"), nullptr;
      volume->kind = Volume::Kind::box;
      volume->centre = apply(matrix, {(*b)[0], (*b)[1], (*b)[2]});
      for (std::size_t i = 0; i < 3; ++i)
        volume->half_axes[i] = rotated((*b)[3 + 3 * i], (*b)[4 + 3 * i], (*b)[5 + 3 * i]);
    } else {
      const auto s = numbers(sphere, 4);
      if (!s || (*s)[3] < 0) return wrong(where, "sphere is not 3 numbers and a radius"), nullptr;
      volume->kind = Volume::Kind::sphere;
      volume->centre = apply(matrix, {(*s)[0], (*s)[1], (*s)[2]});
      volume->radius = (*s)[3];
    }
    return volume;
  }

  void check_inside(const Volume& volume, const Chain& chain, const std::string& where) {
    for (const auto& up : chain) {
      double worst = 0;
      for (const Point3& corner : volume.corners()) worst = std::max(worst, up->outside(corner));
      if (worst > kVolumeTolerance)
        out_.findings.push_back({Check::tile_bounds, name_, where,
                                 fmt::format("its box sticks {:.3f} m out of an ancestor's volume", worst)});
      if (volume.kind != Volume::Kind::region || up->kind != Volume::Kind::region) continue;
      const auto &c = volume.region, &p = up->region;
      const bool sides = p[0] > p[2] || (c[0] <= c[2] && c[0] >= p[0] - 1e-12 && c[2] <= p[2] + 1e-12);
      if (!sides || c[1] < p[1] - 1e-12 || c[3] > p[3] + 1e-12 || c[4] < p[4] - 1e-9 || c[5] > p[5] + 1e-9)
        out_.findings.push_back({Check::tile_bounds, name_, where, "its region is not inside of an ancestor's"});
    }
  }

  const std::string& name_;
  Tileset& out_;
};

}  // namespace

double Volume::outside(const Point3& ecef) const {
  if (kind == Kind::region) return outside_region(region, geodetic(ecef));
  const Point3 d = ecef - centre;
  if (kind == Kind::sphere) return std::max(std::sqrt(dot(d, d)) - radius, 0.0);
  double worst = 0;
  for (const Point3& a : half_axes) {
    const double length = std::sqrt(dot(a, a));
    worst = std::max(worst, length == 0 ? std::sqrt(dot(d, d)) : std::fabs(dot(d, a)) / length - length);
  }
  return worst;
}

std::vector<Point3> Volume::corners() const {
  std::vector<Point3> out;
  if (kind != Kind::box) return out;
  for (int i = 0; i < 8; ++i) {
    Point3 p = centre;
    for (std::size_t a = 0; a < 3; ++a) {
      const double s = i >> a & 1 ? 1 : -1;
      p = {p.x + s * half_axes[a].x, p.y + s * half_axes[a].y, p.z + s * half_axes[a].z};
    }
    out.push_back(p);
  }
  return out;
}

Tileset read_tileset(std::string_view bytes, const std::string& name) {
  Tileset out;
  const auto json = parse_json(bytes);
  if (!json || !json->is_object()) {
    out.findings.push_back({Check::file_unreadable, name, "", "no JSON object"});
    return out;
  }
  out.readable = true;
  Reader(name, out).read(*json);
  return out;
}

Overhang overhang(const TilesetEntry& entry, const std::vector<Point3>& vertices) {
  Overhang out;
  // Every corner of a triangle stands in the list: most are there several times.
  std::vector<Point3> points = vertices;
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (const Point3& local : points) {
    const Point3 p = apply(entry.transform, local);
    std::optional<Place> place;
    for (std::size_t v = 0; v < entry.volumes.size(); ++v) {
      const Volume& volume = *entry.volumes[v];
      double outside = 0;
      if (volume.kind == Volume::Kind::region) {
        if (!place) place = geodetic(p);
        outside = outside_region(volume.region, *place);
      } else {
        outside = volume.outside(p);
      }
      double& worst = v == 0 ? out.own : out.ancestor;
      worst = std::max(worst, outside);
    }
  }
  return out;
}

}  // namespace blockrand::validate
