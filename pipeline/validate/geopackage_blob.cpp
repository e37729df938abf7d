#include "pipeline/validate/geopackage_blob.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace blockrand::validate {
namespace {

using model::Point2;
using model::Point3;

constexpr std::uint32_t kMostPieces = 1'000'000;  // rings of a polygon, polygons of a building: beyond is damage

/// Twice the signed area, relative to the first point so that large coordinates cost no digits.
double twice_area(const std::vector<Point3>& ring) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum +=
        (ring[i].x - ring[0].x) * (ring[i + 1].y - ring[0].y) - (ring[i + 1].x - ring[0].x) * (ring[i].y - ring[0].y);
  return sum;
}

class Reader {
 public:
  Reader(std::string_view blob, GeoPackageGeometry& out) : rest_(blob), out_(out) {}

  void read(WkbType type, std::int64_t srs_id) {
    header(srs_id);
    out_.min_x = out_.min_y = std::numeric_limits<double>::infinity();
    out_.max_x = out_.max_y = -std::numeric_limits<double>::infinity();
    z_ = type == WkbType::multi_polygon_z;
    body(type, z_ || type == WkbType::multi_polygon);
    if (!rest_.empty()) error(fmt::format("{} bytes behind the geometry", rest_.size()));
    if (!(out_.min_x <= out_.max_x)) {
      error("an empty geometry");
    } else if (has_envelope_ && (envelope_[0] != out_.min_x || envelope_[1] != out_.max_x ||
                                 envelope_[2] != out_.min_y || envelope_[3] != out_.max_y)) {
      error("the envelope in the header is not that of the geometry");
    }
  }

  struct Ended {};  // nothing behind this point can be read

 private:
  void error(std::string what) { out_.errors.push_back(std::move(what)); }
  [[noreturn]] void end(std::string what) {
    error(std::move(what));
    throw Ended{};
  }

  template <class T>
  T take() {
    if (rest_.size() < sizeof(T)) end("the geometry is cut short");
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    if (little_ != (std::endian::native == std::endian::little))
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  void header(std::int64_t srs_id) {
    if (rest_.size() < 8 || rest_.substr(0, 2) != "GP") end("does not begin with \"GP\"");
    if (rest_[2] != 0) error(fmt::format("version {} of the header is unknown", static_cast<int>(rest_[2])));
    const auto flags = static_cast<unsigned char>(rest_[3]);
    rest_.remove_prefix(4);
    little_ = (flags & 1) != 0;
    const int envelope = (flags >> 1) & 7;
    if ((flags & 0x20) != 0) end("a geometry type of an extension");
    if ((flags & 0x10) != 0) end("marked as empty");
    if (const auto id = take<std::int32_t>(); id != srs_id)
      error(fmt::format("its reference system is {}, the layer's {}", id, srs_id));
    constexpr int kNumbers[] = {0, 4, 6, 6, 8};
    if (envelope > 4) end("the kind of envelope is unknown");
    for (int i = 0; i < kNumbers[envelope]; ++i) {
      const double v = take<double>();
      if (i < 4) envelope_[i] = v;
    }
    has_envelope_ = envelope > 0;
  }

  void body(WkbType type, bool collection) {
    const auto order = take<std::uint8_t>();
    if (order > 1) end("the byte order is neither 0 nor 1");
    little_ = order == 1;
    if (const auto found = take<std::uint32_t>(); found != static_cast<std::uint32_t>(type))
      end(fmt::format("geometry type {} where {} belongs", found, static_cast<std::uint32_t>(type)));
    if (type == WkbType::point) {
      out_.point = point();
      return;
    }
    const auto count = take<std::uint32_t>();
    if (type == WkbType::line_string) return line(count);
    if (count == 0 || count > kMostPieces) end(fmt::format("{} {}", count, collection ? "polygons" : "rings"));
    for (std::uint32_t i = 0; i < count; ++i) {
      if (collection) {
        body(z_ ? WkbType::polygon_z : WkbType::polygon, false);
      } else {
        if (i == 0) out_.polygons.emplace_back();
        ring(i > 0);
      }
    }
  }

  Point2 point() {
    const double x = take<double>(), y = take<double>();
    if (!std::isfinite(x) || !std::isfinite(y)) end("a coordinate that is no number");
    out_.min_x = std::min(out_.min_x, x);
    out_.max_x = std::max(out_.max_x, x);
    out_.min_y = std::min(out_.min_y, y);
    out_.max_y = std::max(out_.max_y, y);
    return {x, y};
  }

  void line(std::uint32_t count) {
    if (count > rest_.size() / 16) end("the geometry is cut short");
    for (std::uint32_t i = 0; i < count; ++i) out_.line.push_back(point());
    if (count < 2) error(fmt::format("a line of {} points", count));
  }

  void ring(bool hole) {
    const auto count = take<std::uint32_t>();
    if (count > rest_.size() / (z_ ? 24 : 16)) end("the geometry is cut short");
    std::vector<Point3> points;
    points.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Point2 p = point();
      const double z = z_ ? take<double>() : 0;
      if (!std::isfinite(z)) end("a height that is no number");
      points.push_back({p.x, p.y, z});
    }
    if (count < 4) return error(fmt::format("a ring of {} points", count));
    if (points.front() != points.back()) return error("a ring that is not closed");
    points.pop_back();
    const double area = z_ ? (hole ? -1 : 1) : twice_area(points);  // walls have none on the map
    if (area == 0) error("a ring without area");
    if (hole ? area > 0 : area < 0)
      error(hole ? "a hole that runs counter-clockwise" : "an outer ring that runs clockwise");
    out_.polygons.back().rings.push_back(std::move(points));
  }

  std::string_view rest_;
  GeoPackageGeometry& out_;
  bool little_ = true, has_envelope_ = false, z_ = false;
  double envelope_[4] = {};  // min x, max x, min y, max y
};

}  // namespace

GeoPackageGeometry read_geopackage_geometry(std::string_view blob, WkbType type, std::int64_t srs_id) {
  GeoPackageGeometry out;
  try {
    Reader(blob, out).read(type, srs_id);
  } catch (const Reader::Ended&) {
  }
  return out;
}

}  // namespace blockrand::validate
