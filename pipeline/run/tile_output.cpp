#include "pipeline/run/tile_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/version.h"
#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/outputs/gzip.h"
#include "pipeline/georef/frames.h"
#include "pipeline/georef/tile_frame.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::run {

namespace {

using model::Point3;

constexpr const char* kAttribution = "\u00a9 OpenStreetMap contributors, ODbL 1.0";

/// Fast; explanations repeat themselves so much that the highest level gains a tenth.
constexpr int kExplainGzipLevel = 4;

std::string generator() { return "Blockrand " + std::string(base::kVersion); }

/// Ellipsoid minus sea level as a plane in the build CRS: the geoid's grid is so wide that over a tile it is plane to
/// well below a millimetre, and a plane gives neighbouring tiles the same height at their border to a fraction of that.
struct GeoidPlane {
  double x0 = 0, y0 = 0, at = 0, per_x = 0, per_y = 0;
  double operator()(double x, double y) const { return at + (x - x0) * per_x + (y - y0) * per_y; }
};

GeoidPlane geoid_plane(const OutputContext& context, georef::LonLat centre) {
  GeoidPlane plane;
  if (!context.record.heights.raised_by) return plane;
  const model::Point2 o = context.projection.forward(centre.lon, centre.lat);
  constexpr double kStep = 1000;  // m
  const auto undulation = [&](double x, double y) {
    const georef::LonLat p = context.projection.inverse({x, y});
    return context.record.heights.raised_by->undulation(p.lon, p.lat).value_or(0);
  };
  plane.x0 = o.x;
  plane.y0 = o.y;
  plane.at = undulation(o.x, o.y);
  plane.per_x = (undulation(o.x + kStep, o.y) - undulation(o.x - kStep, o.y)) / (2 * kStep);
  plane.per_y = (undulation(o.x, o.y + kStep) - undulation(o.x, o.y - kStep)) / (2 * kStep);
  return plane;
}

outputs::GlbOptions glb_options(const OutputContext& context, const georef::EnuFrame& frame) {
  outputs::GlbOptions o;
  o.lod = context.options.lod;
  o.instancing = context.options.instancing;
  o.compression = context.options.compression;
  o.crs = context.record.crs.authority_code;
  o.height_reference = context.record.heights.in_tiles;
  o.generator = generator();
  o.attribution = kAttribution;
  o.evidence = context.options.evidence;
  o.frame.longitude = frame.origin().lon;
  o.frame.latitude = frame.origin().lat;
  o.frame.height = frame.origin().height;
  o.frame.enu_to_ecef = frame.local_to_ecef();
  return o;
}

/// What viewers show from farther away than facades: blocks, then roofs (tileset.h says from how far).
void write_coarser_levels(const model::Region& region, outputs::GlbOptions options, const std::string& place,
                          outputs::TileEntry& entry, base::StagedFolder& folder,
                          std::vector<base::PublishedFile>& files) {
  for (const auto& [lod, error] : {std::pair(1, outputs::kBlockError), std::pair(2, outputs::kRoofError)}) {
    options.lod = lod;
    const outputs::Glb glb = outputs::write_glb(region, options);
    if (glb.triangles == 0) continue;
    entry.coarser.push_back({fmt::format("{}_lod{}.glb", place, lod), error});
    files.push_back(folder.write(entry.coarser.back().uri, glb.bytes));
    entry.min = {std::min(entry.min.x, glb.min.x), std::min(entry.min.y, glb.min.y), std::min(entry.min.z, glb.min.z)};
    entry.max = {std::max(entry.max.x, glb.max.x), std::max(entry.max.y, glb.max.y), std::max(entry.max.z, glb.max.z)};
  }
}

/// Geodetic bounds of a box in a local frame, from its corners and the middle of its underside, which lies deepest.
void set_bounds(outputs::TileEntry& entry, const georef::EnuFrame& frame) {
  bool first = true;
  const double reference = frame.origin().lon;
  double west = 0, east = 0;
  for (int i = 0; i < 9; ++i) {
    const Point3 p = i == 8 ? Point3{(entry.min.x + entry.max.x) / 2, (entry.min.y + entry.max.y) / 2, entry.min.z}
                            : Point3{i & 1 ? entry.max.x : entry.min.x, i & 2 ? entry.max.y : entry.min.y,
                                     i & 4 ? entry.max.z : entry.min.z};
    const georef::Geodetic g = georef::from_ecef(frame.to_ecef(p));
    double lon = g.lon;
    if (lon - reference > 180) lon -= 360;
    if (reference - lon > 180) lon += 360;
    if (first) {
      west = east = lon;
      entry.south = entry.north = g.lat;
      entry.min_height = entry.max_height = g.height;
      first = false;
    }
    west = std::min(west, lon);
    east = std::max(east, lon);
    entry.south = std::min(entry.south, g.lat);
    entry.north = std::max(entry.north, g.lat);
    entry.min_height = std::min(entry.min_height, g.height);
    entry.max_height = std::max(entry.max_height, g.height);
  }
  entry.west = west < -180 ? west + 360 : west;
  entry.east = east > 180 ? east - 360 : east;
}

/// Height of the frame's origin: the lowest ground of the buildings, so that meshes start near zero.
double lowest_ground(const model::Region& region) {
  double lowest = 0;
  bool first = true;
  for (const model::Building& b : region.buildings) {
    const double z = b.attributes.ground_height.value;
    lowest = first ? z : std::min(lowest, z);
    first = false;
  }
  return lowest;
}

std::string model_name(model::TileId id) { return fmt::format("Blockrand {}/{}/{}", id.level, id.x, id.y); }

outputs::CityGmlOptions citygml_options(const model::Region& region, const OutputContext& context) {
  outputs::CityGmlOptions o;
  o.lod = context.options.lod;
  const std::string& code = context.record.crs.authority_code;
  const std::string number = code.substr(code.find(':') + 1);
  o.srs_name = context.record.heights.vertical_crs.empty()
                   ? "urn:ogc:def:crs:EPSG::" + number
                   : "urn:ogc:def:crs,crs:EPSG::" + number + ",crs:EPSG::" +
                         context.record.heights.vertical_crs.substr(context.record.heights.vertical_crs.find(':') + 1);
  o.height_reference = context.record.heights.words;
  o.attribution = kAttribution;
  o.name = model_name(region.tile);
  o.evidence = context.options.evidence;
  return o;
}

void write_text_file(const std::string& path, const std::string& bytes, const OutputContext& context,
                     base::StagedFolder& folder, std::vector<base::PublishedFile>& files) {
  if (context.options.gzip)
    files.push_back(folder.write(path + ".gz", outputs::gzip(bytes)));
  else
    files.push_back(folder.write(path, bytes));
}

void write_city_models(const model::Region& region, const std::string& name, const OutputContext& context,
                       base::StagedFolder& folder, std::vector<base::PublishedFile>& files) {
  if (context.options.citygml)
    write_text_file("citygml/" + name + ".gml", outputs::write_citygml(region, citygml_options(region, context)),
                    context, folder, files);
  if (context.options.cityjson)
    write_text_file("cityjson/" + name + ".city.jsonl",
                    outputs::write_cityjson_sequence(region, cityjson_options(context, model_name(region.tile))),
                    context, folder, files);
}

}  // namespace

outputs::CityJsonOptions cityjson_options(const OutputContext& context, std::string name) {
  outputs::CityJsonOptions o;
  o.lod = context.options.lod;
  o.crs_code = context.record.crs.authority_code;
  o.vertical_crs = context.record.heights.vertical_crs;
  o.height_reference = context.record.heights.words;
  o.attribution = kAttribution;
  o.name = std::move(name);
  o.generator = generator();
  o.data_time = context.record.data_time;
  o.evidence = context.options.evidence;
  return o;
}

outputs::GeoPackageOptions geopackage_options(const OutputContext& context) {
  return {context.record.crs.authority_code, context.record.data_time, context.record.heights.words, kAttribution};
}

outputs::GeoPackageTile geopackage_tile(model::TileId id, const TileOutput& output, const OutputContext& context) {
  outputs::GeoPackageTile tile;
  tile.id = id;
  tile.buildings = output.rows.buildings.rows();
  tile.parts = output.rows.parts.rows();
  if (output.tile) {
    tile.uri = output.tile->uri;
    for (const base::PublishedFile& file : output.files)
      if (file.path == tile.uri) tile.bytes = file.bytes;
  }
  const georef::GeoBox box = georef::bounds(id);
  // Straight lines between the corners of a tile lie within millimetres of its meridians and parallels.
  for (const georef::LonLat corner : {georef::LonLat{box.west, box.south}, georef::LonLat{box.east, box.south},
                                      georef::LonLat{box.east, box.north}, georef::LonLat{box.west, box.north}})
    tile.outline.push_back(model::snap(context.projection.forward(corner.lon, corner.lat)));
  return tile;
}

TileOutput write_tile(const model::Region& region, const OutputContext& context, outputs::ExplainOptions explain,
                      base::StagedFolder& folder) {
  TileOutput out;
  const model::TileId id = region.tile;
  const std::string name = fmt::format("{}_{}_{}", id.level, id.x, id.y);
  const bool has_parts = std::any_of(region.buildings.begin(), region.buildings.end(),
                                     [](const model::Building& b) { return !b.parts.empty(); });
  if (context.options.gltf && has_parts) {
    const GeoidPlane plane = geoid_plane(context, georef::centre(id));
    const double origin_height = model::snap(lowest_ground(region) + plane.at);
    const georef::TileFrame frame(context.projection, id, origin_height);
    outputs::GlbOptions options = glb_options(context, frame.frame());
    options.frame.to_enu = [&](std::span<const Point3> in, std::span<Point3> out) {
      for (std::size_t i = 0; i < in.size(); ++i)
        out[i] = frame.to_local({in[i].x, in[i].y, in[i].z + plane(in[i].x, in[i].y)});
    };
    const std::string place = fmt::format("tiles/{}/{}/{}", id.level, id.x, id.y);
    const outputs::Glb glb = outputs::write_glb(region, options);
    if (glb.triangles > 0) {
      outputs::TileEntry entry;
      entry.id = id;
      entry.uri = place + ".glb";
      out.files.push_back(folder.write(entry.uri, glb.bytes));
      entry.enu_to_ecef = options.frame.enu_to_ecef;
      entry.min = glb.min;
      entry.max = glb.max;
      if (context.options.lod >= 3) write_coarser_levels(region, options, place, entry, folder, out.files);
      set_bounds(entry, frame.frame());
      out.tile = std::move(entry);
    }
  }
  if (has_parts) write_city_models(region, name, context, folder, out.files);
  if (context.options.geopackage) out.rows = outputs::geopackage_rows(region, context.options.lod);
  if (context.options.explain && !region.buildings.empty()) {
    explain.tile = name;
    for (const base::PublishedFile& file : out.files) explain.files.push_back(file.path);
    outputs::Explanations explanations = outputs::explain(region, explain);
    out.files.push_back(
        folder.write("explain/" + name + ".jsonl.gz", outputs::gzip(explanations.lines, kExplainGzipLevel)));
    out.explained = std::move(explanations.objects);
  }
  return out;
}

double write_whole(const model::Region& whole, std::span<const outputs::TileEntry> tiles, georef::LonLat centre,
                   const OutputContext& context, base::StagedFolder& folder, std::vector<base::PublishedFile>& files) {
  double reach = 0;
  if (context.options.gltf) {
    outputs::TilesetOptions options;
    options.crs = context.record.crs.authority_code;
    options.height_reference = context.record.heights.words;
    options.generator = generator();
    options.attribution = kAttribution;
    files.push_back(folder.write("tileset.json", outputs::write_tileset(tiles, options)));
  }
  if (context.options.single_glb) {
    const double origin_height = model::snap(lowest_ground(whole));
    const GeoidPlane plane = geoid_plane(context, centre);
    const georef::EnuFrame frame({centre.lon, centre.lat, origin_height + plane.at});
    outputs::GlbOptions o = glb_options(context, frame);
    // One frame for a whole city: every point takes the exact way, and the geoid is asked for each.
    o.frame.to_enu = [&](std::span<const Point3> in, std::span<Point3> out) {
      for (std::size_t i = 0; i < in.size(); ++i) {
        const georef::LonLat g = context.projection.inverse(in[i].xy());
        const auto& geoid = context.record.heights.raised_by;
        const double n = geoid ? geoid->undulation(g.lon, g.lat).value_or(0) : 0;
        out[i] = frame.to_local(g.lon, g.lat, in[i].z + n);
      }
    };
    const outputs::Glb glb = outputs::write_glb(whole, o);
    for (const double v : {glb.min.x, glb.min.y, glb.max.x, glb.max.y}) reach = std::max(reach, std::fabs(v));
    files.push_back(folder.write("model.glb", glb.bytes));
  }
  // A file without city objects is a valid city model and says more than no file.
  const bool has_city_models = std::any_of(files.begin(), files.end(), [](const base::PublishedFile& f) {
    return f.path.starts_with("citygml/") || f.path.starts_with("cityjson/");
  });
  if (!has_city_models) write_city_models(model::Region{}, "empty", context, folder, files);
  return reach;
}

}  // namespace blockrand::run
