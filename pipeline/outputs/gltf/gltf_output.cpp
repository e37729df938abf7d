#include "pipeline/outputs/gltf/gltf_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/text.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/frames.h"
#include "pipeline/georef/tile_frame.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/outputs/gltf/ground_glb.h"
#include "pipeline/outputs/gltf/surroundings_glb.h"
#include "pipeline/outputs/gltf/texture_set.h"
#include "pipeline/outputs/gltf/tile_ground.h"
#include "pipeline/outputs/tileset/tileset.h"

namespace blockrand::outputs {
namespace {

using model::Point3;

constexpr const char* kModelFile = "model.glb";
constexpr const char* kSurroundingsFile = "surroundings.glb";
constexpr const char* kGroundFile = "ground.glb";
/// m. Farther from its origin, the single-precision vertices of model.glb are coarser than 4 mm.
constexpr double kFineModelRadius = 65'536;

/// Ellipsoid minus sea level as a plane in the build CRS: the geoid's grid is so wide that over a tile it is plane to
/// well below a millimetre, and a plane gives neighbouring tiles the same height at their border to a fraction of that.
struct GeoidPlane {
  double x0 = 0, y0 = 0, at = 0, per_x = 0, per_y = 0;
  double operator()(double x, double y) const { return at + (x - x0) * per_x + (y - y0) * per_y; }
};

GeoidPlane geoid_plane(const OutputContext& context, georef::LonLat centre) {
  GeoidPlane plane;
  if (!context.heights.raised_by) return plane;
  const model::Point2 o = context.projection.forward(centre.lon, centre.lat);
  constexpr double kStep = 1000;  // m
  const auto undulation = [&](double x, double y) {
    const georef::LonLat p = context.projection.inverse({x, y});
    return context.heights.raised_by->undulation(p.lon, p.lat).value_or(0);
  };
  plane.x0 = o.x;
  plane.y0 = o.y;
  plane.at = undulation(o.x, o.y);
  plane.per_x = (undulation(o.x + kStep, o.y) - undulation(o.x - kStep, o.y)) / (2 * kStep);
  plane.per_y = (undulation(o.x, o.y + kStep) - undulation(o.x, o.y - kStep)) / (2 * kStep);
  return plane;
}

GlbOptions glb_options(const OutputContext& context, const georef::EnuFrame& frame) {
  GlbOptions o;
  o.lod = context.lod;
  o.instancing = context.options.instancing;
  o.compression =
      context.options.compression == Compression::tiles ? Compression::meshopt : context.options.compression;
  o.crs = context.crs.authority_code;
  o.height_reference = context.heights.in_tiles;
  o.generator = generator();
  o.attribution = attribution(context);
  o.profile = context.options.profile;
  o.evidence = context.options.evidence;
  o.frame.longitude = frame.origin().lon;
  o.frame.latitude = frame.origin().lat;
  o.frame.height = frame.origin().height;
  o.frame.enu_to_ecef = frame.local_to_ecef();
  return o;
}

/// Notes the textures of a GLB with its tile.
void note_textures(const Glb& glb, TileEntry& entry) {
  entry.textures.insert(glb.textures.begin(), glb.textures.end());
  entry.too_light += glb.too_light;
}

/// What viewers show from farther away than facades: roofs (tileset.h says from how far).
void write_coarser_level(const Glb& glb, const std::string& place, TileEntry& entry, const OutputContext& context,
                         std::vector<base::PublishedFile>& files) {
  if (glb.triangles == 0) return;
  entry.coarser.push_back({place + "_lod2.glb", kRoofError});
  note_textures(glb, entry);
  write_served(entry.coarser.back().uri, glb.bytes, context.options, context.folder, files);
  entry.min = {std::min(entry.min.x, glb.min.x), std::min(entry.min.y, glb.min.y), std::min(entry.min.z, glb.min.z)};
  entry.max = {std::max(entry.max.x, glb.max.x), std::max(entry.max.y, glb.max.y), std::max(entry.max.z, glb.max.z)};
}

/// Puts a GLB beside the buildings of a tile. \param alone  nothing else is in it so far
void put_beside(const Glb& glb, const std::string& uri, bool alone, TileEntry& entry, const OutputContext& context,
                std::vector<base::PublishedFile>& files) {
  note_textures(glb, entry);
  write_served(uri, glb.bytes, context.options, context.folder, files);
  const auto widen = [&](Point3& low, Point3& high) {
    low = {std::min(low.x, glb.min.x), std::min(low.y, glb.min.y), std::min(low.z, glb.min.z)};
    high = {std::max(high.x, glb.max.x), std::max(high.y, glb.max.y), std::max(high.z, glb.max.z)};
  };
  if (alone) {
    entry.min = glb.min, entry.max = glb.max;
  } else {
    widen(entry.min, entry.max);
  }
}

/// Of the surroundings, what GLBs show: a picture replaces their ground.
model::Surroundings shown_surroundings(const model::Surroundings& all, const OutputContext& context) {
  model::Surroundings out = all;
  if (context.ground_mesh) out.surfaces.clear();
  return out;
}

/// Writes the surroundings of a tile beside its buildings, in their frame.
void write_surroundings_tile(const FinishedTile& tile, const std::string& place, const GlbOptions& options, bool alone,
                             TileEntry& entry, const OutputContext& context, std::vector<base::PublishedFile>& files) {
  if (tile.surroundings == nullptr || context.surroundings == nullptr || tile.surroundings->empty()) return;
  const Glb glb = context.ground_mesh ? write_surroundings_glb(shown_surroundings(*tile.surroundings, context),
                                                               *context.surroundings, options)
                                      : write_surroundings_glb(*tile.surroundings, *context.surroundings, options);
  if (glb.triangles == 0) return;
  entry.surroundings = {place + "_surroundings.glb", glb.min, glb.max};
  put_beside(glb, entry.surroundings->uri, alone, entry, context, files);
}

/// Writes the ground of a tile beside its buildings, in their frame.
void write_ground_tile(const TileGround& ground, const std::string& place, const GlbOptions& options, bool alone,
                       TileEntry& entry, const OutputContext& context, std::vector<base::PublishedFile>& files) {
  const auto beside = [](const std::string& path) { return path.substr(path.find_last_of('/') + 1); };
  const GroundPart part{&ground.mesh, &ground.cover, beside(ground.webp), beside(ground.png)};
  const Glb glb = write_ground_glb({&part, 1}, options);
  entry.ground = {place + "_ground.glb", glb.min, glb.max};
  entry.ground_pixel = ground.cover.pixel;
  entry.ground_cells = ground.cover.shown.size();
  entry.bare_cells = static_cast<std::uint64_t>(std::ranges::count(ground.cover.shown, false));
  put_beside(glb, entry.ground->uri, alone, entry, context, files);
}

/// Geodetic bounds of a box in a local frame, from its corners and the middle of its underside, which lies deepest.
void set_bounds(TileEntry& entry, const georef::EnuFrame& frame) {
  bool first = true;
  const double reference = frame.origin().lon;
  double west = 0, east = 0;
  for (int i = 0; i < 9; ++i) {
    const model::Point3 p =
        i == 8 ? model::Point3{(entry.min.x + entry.max.x) / 2, (entry.min.y + entry.max.y) / 2, entry.min.z}
               : model::Point3{i & 1 ? entry.max.x : entry.min.x, i & 2 ? entry.max.y : entry.min.y,
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

/// A tile's buildings by the quarters of the quadtree that their mapped middles lie in: SW, SE, NW, NE.
std::array<std::vector<std::size_t>, 4> quarters_of(const model::Region& region, std::span<const std::size_t> buildings,
                                                    int level) {
  std::array<std::vector<std::size_t>, 4> out;
  for (const std::size_t b : buildings) {
    const model::MappedBuilding& mapped = region.extract->buildings[region.buildings[b].mapped_index];
    const model::Location middle = mapped.rings.count > 0 ? footprints::box_centre(*region.extract, mapped)
                                                          : mapped.place.value_or(model::Location{});
    const model::TileId quarter = georef::tile_of(middle, level);
    out[2 * (quarter.y & 1u) + (quarter.x & 1u)].push_back(b);
  }
  return out;
}

/// Writes a tile in pieces of at most `most` bytes, or of a single building.
class PieceWriter {
 public:
  PieceWriter(FinishedTile& tile, const GlbOptions& options, std::string place, std::size_t most, TileEntry& entry,
              const OutputContext& context)
      : tile_(tile), options_(options), place_(std::move(place)), most_(most), entry_(entry), context_(context) {}

  void write() {
    std::vector<std::size_t> all(tile_.region.buildings.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    divide(all, "_q", tile_.region.tile.level);
  }

 private:
  /// Buildings that lie in one place to a few metres, in one file.
  static constexpr int kDeepest = 24;

  void divide(std::span<const std::size_t> buildings, const std::string& name, int level) {
    const auto quarters = quarters_of(tile_.region, buildings, level + 1);
    for (std::size_t q = 0; q < quarters.size(); ++q)
      if (!quarters[q].empty()) piece(quarters[q], name + static_cast<char>('0' + q), level + 1);
  }

  void piece(std::span<const std::size_t> buildings, const std::string& name, int level) {
    model::Region part;
    part.tile = tile_.region.tile, part.extract = tile_.region.extract;
    part.materials = tile_.region.materials, part.elements = tile_.region.elements;
    part.evidence = tile_.region.evidence;
    for (const std::size_t b : buildings) part.buildings.push_back(tile_.region.buildings[b]);
    const Glb glb = write_glb(part, options_);
    if (glb.bytes.size() > most_ && buildings.size() > 1 && level < kDeepest) return divide(buildings, name, level);
    if (glb.rows == 0) return;
    // Houses that show nothing are told of all the same, in the middle of the tile.
    const Point3 middle{(entry_.min.x + entry_.max.x) / 2, (entry_.min.y + entry_.max.y) / 2,
                        (entry_.min.z + entry_.max.z) / 2};
    const bool shown = glb.triangles > 0;
    note_textures(glb, entry_);
    entry_.pieces.push_back({place_ + name + ".glb", shown ? glb.min : middle, shown ? glb.max : middle});
    write_served(entry_.pieces.back().uri, glb.bytes, context_.options, context_.folder, tile_.files);
  }

  FinishedTile& tile_;
  const GlbOptions& options_;
  std::string place_;
  std::size_t most_;
  TileEntry& entry_;
  const OutputContext& context_;
};

/// Writes a tile's GLBs. \returns its entry in the tileset; none where its GLB would show nothing
std::optional<TileEntry> write_glbs(FinishedTile& tile, const OutputContext& context, const TextureSet* textures,
                                    const std::optional<TileGround>& ground_picture) {
  const model::Region& region = tile.region;
  const model::TileId id = region.tile;
  const GeoidPlane plane = geoid_plane(context, georef::centre(id));
  double ground = lowest_ground(region);
  if (region.buildings.empty() && ground_picture)
    ground = lowest_point(ground_picture->mesh);
  else if (region.buildings.empty() && tile.surroundings)
    ground = lowest_point(*tile.surroundings).value_or(0);
  const double origin_height = model::snap(ground + plane.at);
  const georef::TileFrame frame(context.projection, id, origin_height);
  GlbOptions options = glb_options(context, frame.frame());
  options.textures = textures;
  options.texture_folder = "../../../" + std::string(kTextureFolder);  // from tiles/LEVEL/X/
  options.frame.to_enu = [&](std::span<const Point3> in, std::span<Point3> out) {
    for (std::size_t i = 0; i < in.size(); ++i)
      out[i] = frame.to_local({in[i].x, in[i].y, in[i].z + plane(in[i].x, in[i].y)});
  };
  Glb glb, roofs;
  base::share(context.lod >= 3 ? 2 : 1, [&](std::size_t i) {
    if (i == 0) {
      glb = write_glb(region, options);
    } else {
      GlbOptions coarser = options;
      coarser.lod = 2;
      coarser.textures = nullptr;  // seen from afar
      roofs = write_glb(region, coarser);
    }
  });
  TileEntry entry;
  entry.id = id;
  entry.uri = tile_glb_path(id);
  entry.min = glb.min;
  entry.max = glb.max;
  const std::string place = entry.uri.substr(0, entry.uri.size() - std::string_view(".glb").size());
  const auto most = static_cast<std::size_t>(context.options.max_glb_bytes);
  const bool empty = glb.triangles == 0;
  if (empty) {
    entry.uri.clear();
  } else if (most > 0 && glb.bytes.size() > most) {
    std::string().swap(glb.bytes);  // room for the pieces
    PieceWriter(tile, options, place, most, entry, context).write();
    entry.uri.clear();
  } else {
    note_textures(glb, entry);
    write_served(entry.uri, glb.bytes, context.options, context.folder, tile.files);
  }
  entry.enu_to_ecef = options.frame.enu_to_ecef;
  if (!empty) write_coarser_level(roofs, place, entry, context, tile.files);
  if (ground_picture) write_ground_tile(*ground_picture, place, options, empty, entry, context, tile.files);
  write_surroundings_tile(tile, place, options, empty && !entry.ground, entry, context, tile.files);
  if (empty && !entry.surroundings && !entry.ground) return std::nullopt;
  set_bounds(entry, frame.frame());
  return entry;
}

/// Writes model.glb, and surroundings.glb and ground.glb in the same frame. \param around, grounds  empty: none
/// \param used  gets the textures that they show
void write_model(const FinishedBuild& build, const model::Surroundings& around, std::span<const TileGround> grounds,
                 const OutputContext& context, const TextureSet* textures, std::set<std::string>& used) {
  const model::Region& whole = build.whole;
  const double origin_height = model::snap(lowest_ground(whole));
  const GeoidPlane plane = geoid_plane(context, context.centre);
  const georef::EnuFrame frame({context.centre.lon, context.centre.lat, origin_height + plane.at});
  GlbOptions o = glb_options(context, frame);
  o.objects = context.options.objects;
  o.textures = textures;
  o.texture_folder = kTextureFolder;
  if (context.options.compression == Compression::tiles) o.compression = Compression::none;
  // One frame for a whole city: every point takes the exact way, and the geoid is asked for each.
  o.frame.to_enu = [&](std::span<const Point3> in, std::span<Point3> out) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      const georef::LonLat g = context.projection.inverse(in[i].xy());
      const auto& geoid = context.heights.raised_by;
      const double n = geoid ? geoid->undulation(g.lon, g.lat).value_or(0) : 0;
      out[i] = frame.to_local(g.lon, g.lat, in[i].z + n);
    }
  };
  if (!around.empty() && context.surroundings != nullptr) {
    GlbOptions baked = o;  // editors know no instances
    baked.instancing = Instancing::baked;
    const Glb ground = write_surroundings_glb(around, *context.surroundings, baked);
    used.insert(ground.textures.begin(), ground.textures.end());
    build.tell(kSurroundingsFile, fmt::format("{} triangles, {}", base::with_thousands(ground.triangles),
                                              base::with_byte_unit(ground.bytes.size())));
    build.files.push_back(context.folder.write(kSurroundingsFile, ground.bytes));
  }
  if (!grounds.empty()) {
    std::vector<GroundPart> parts;
    for (const TileGround& g : grounds) parts.push_back({&g.mesh, &g.cover, g.webp, g.png});
    const Glb ground = write_ground_glb(parts, o);
    build.tell(kGroundFile, fmt::format("{} triangles", base::with_thousands(ground.triangles)));
    build.files.push_back(context.folder.write(kGroundFile, ground.bytes));
  }
  Glb glb;
  try {
    glb = write_glb(whole, o);
  } catch (const std::length_error&) {
    throw base::OutputError(
        fmt::format("{} would have more than the 4 GB that a GLB may have; {}use tileset.json, or a --bbox", kModelFile,
                    o.objects == Objects::building && o.lod >= 3 ? "--objects tile is a tenth of it; or " : ""));
  }
  used.insert(glb.textures.begin(), glb.textures.end());
  const auto [bytes, triangles] = std::pair(glb.bytes.size(), base::with_thousands(glb.triangles));
  std::string figures = fmt::format("{} triangles, {}", triangles, base::with_byte_unit(bytes));
  if (o.objects == Objects::building)
    figures = fmt::format("{} houses in {} parts, {}", base::with_thousands(glb.buildings),
                          base::with_thousands(glb.parts), figures);
  build.tell(kModelFile, std::move(figures));
  build.files.push_back(context.folder.write(kModelFile, glb.bytes));
  if (o.objects == Objects::building) return;  // each house lies about an origin of its own
  double reach = 0;
  for (const double v : {glb.min.x, glb.min.y, glb.max.x, glb.max.y}) reach = std::max(reach, std::fabs(v));
  if (reach > kFineModelRadius)
    build.warn(fmt::format(
        "model.glb reaches {:.0f} km from its origin: far from there its vertices are more than 4 mm coarse. "
        "Use --objects building, tileset.json, or a --bbox",
        reach / 1000));
}

class GltfOutput : public OutputOf<std::optional<TileEntry>> {
 public:
  explicit GltfOutput(const OutputContext& context) : context_(context), tiled_(context.options.writes("gltf")) {
    if (context.textures != nullptr)
      textures_.emplace(*context.textures, context.options.textures == TextureChoice::small
                                               ? textures::TextureSize::small
                                               : textures::TextureSize::full);
  }

  std::any write_tile(FinishedTile& tile) const override {
    if (context_.options.single_glb && tile.surroundings != nullptr && !tile.surroundings->empty()) {
      const std::lock_guard lock(mutex_);
      around_[tile.region.tile] = shown_surroundings(*tile.surroundings, context_);
    }
    const std::optional<TileGround> ground = write_tile_ground(tile, context_);
    if (context_.options.single_glb && ground) {
      const std::lock_guard lock(mutex_);
      grounds_[tile.region.tile] = *ground;
    }
    return tiled_ && (tile.has_parts || tile.surroundings != nullptr || ground)
               ? write_glbs(tile, context_, textures(), ground)
               : std::nullopt;
  }
  void take(const FinishedTile&, std::any product) override {
    if (auto& entry = *std::any_cast<std::optional<TileEntry>>(&product)) tiles_.push_back(std::move(*entry));
  }
  void finish(const FinishedBuild& build) override {
    if (tiled_) {
      TilesetOptions options;
      options.crs = context_.crs.authority_code;
      options.height_reference = context_.heights.words;
      options.generator = generator();
      options.attribution = attribution(context_);
      write_served("tileset.json", write_tileset(tiles_, options), context_.options, context_.folder, build.files);
    }
    std::set<std::string> used;
    std::uint64_t too_light = 0;
    for (const TileEntry& entry : tiles_) {
      used.insert(entry.textures.begin(), entry.textures.end());
      too_light += entry.too_light;
    }
    if (context_.options.single_glb) write_whole(build, used);
    tell_grounds(build);
    if (!textures_) return;
    const auto [webp, png] = textures_->write(used, context_.folder, build.files);
    std::string figures = fmt::format("{} textures, {} as WebP, {} as PNG", used.size(), base::with_byte_unit(webp),
                                      base::with_byte_unit(png));
    if (too_light > 0)
      figures +=
          fmt::format("; {} triangles are lighter than their texture and stay plain", base::with_thousands(too_light));
    build.tell(kTextureFolder, std::move(figures));
  }

 private:
  const TextureSet* textures() const { return textures_ ? &*textures_ : nullptr; }

  void tell_grounds(const FinishedBuild& build) const {
    GroundFigures figures;
    for (const TileEntry& entry : tiles_) figures.add(entry);
    if (const std::string text = figures.text(); !text.empty()) build.tell(kTileFolder, text);
    if (const std::string why = figures.coarser(context_.options.ground_pixel); !why.empty()) build.warn(why);
  }

  void write_whole(const FinishedBuild& build, std::set<std::string>& used) {
    model::Surroundings around;
    for (auto& [tile, of_tile] : around_) {
      std::ranges::move(of_tile.surfaces, std::back_inserter(around.surfaces));
      std::ranges::move(of_tile.bodies, std::back_inserter(around.bodies));
      std::ranges::move(of_tile.objects, std::back_inserter(around.objects));
    }
    around_.clear();
    std::vector<TileGround> grounds;
    for (auto& [tile, ground] : grounds_) grounds.push_back(std::move(ground));
    grounds_.clear();
    write_model(build, around, grounds, context_, textures(), used);
  }

  const OutputContext& context_;
  std::optional<TextureSet> textures_;
  bool tiled_ = true;
  std::vector<TileEntry> tiles_;
  mutable std::mutex mutex_;
  mutable std::map<model::TileId, model::Surroundings> around_;  ///< for model.glb, of which no tile is kept
  mutable std::map<model::TileId, TileGround> grounds_;          ///< the same
};

}  // namespace

OutputFormat gltf_output() {
  return {.name = "gltf",
          .title = "3D Tiles with GLB",
          .other_names = {"tileset", "3dtiles"},
          .places = {{"tileset.json", "3D Tiles, for CesiumJS, QGIS 3.34+, Unreal, ...; single tiles are in tiles/",
                      [](const OutputOptions& o, std::uint64_t) { return o.writes("gltf"); }},
                     {kModelFile, "the whole build in one file, for Blender and other editors",
                      [](const OutputOptions& o, std::uint64_t) { return o.single_glb; }},
                     {kTextureFolder, "what surfaces of GLBs look like from near by",
                      [](const OutputOptions& o, std::uint64_t) { return o.textures != TextureChoice::none; }},
                     {kTileFolder, "the ground as aerial images show it: _ground.glb of each tile, with its picture",
                      [](const OutputOptions& o, std::uint64_t) {
                        return o.writes("gltf") && o.ground == GroundChoice::imagery;
                      }},
                     {kGroundFile, "the ground as aerial images show it, in the frame of model.glb",
                      [](const OutputOptions& o, std::uint64_t) {
                        return o.single_glb && o.ground == GroundChoice::imagery;
                      }},
                     {kSurroundingsFile, "what stands around the houses, in the frame of model.glb",
                      [](const OutputOptions& o, std::uint64_t) { return o.single_glb && o.surroundings; }}},
          .manual = {{"tileset.json, tiles/",
                      "3D Tiles 1.1: one GLB per tile, with the attributes of every building as feature metadata"}},
          .asked = [](const OutputOptions& o) { return o.writes("gltf") || o.single_glb; },
          .size =
              [](const OutputOptions& o, std::size_t lod) {
                OutputSize size;
                // What --precompress adds, of a GLB with meshopt and of one without (Frankfurter Allee, LoD3: 0.36 to 0.42, 0.17).
                const double files = !o.precompress ? 1 : o.compression == Compression::none ? 1.17 : 1.39;
                if (o.writes("gltf"))
                  size += {.per_building = 2100 * files, .per_wall = lod >= 3 ? 45.0 * files : 0, .memory = 8e6};
                const bool merged = lod >= 3 && o.objects == Objects::building && o.instancing != Instancing::nodes;
                if (o.single_glb) size += {.per_building = 2100, .per_wall = lod < 3 ? 0.0 : merged ? 300.0 : 45.0};
                return size;
              },
          .keeps_whole = [](const OutputOptions& o) { return o.single_glb; },
          .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<GltfOutput>(c); }};
}

}  // namespace blockrand::outputs
