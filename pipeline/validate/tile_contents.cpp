#include "pipeline/validate/tile_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>
#include <vector>

#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/cityjson_reader.h"
#include "pipeline/validate/placed_elements.h"

namespace blockrand::validate {
namespace {

bool says_unreadable(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.check == Check::file_unreadable; });
}

class Reader {
 public:
  Reader(const TileFiles& files, const TileContext& context, TileResult& result)
      : files_(files), context_(context), result_(result) {}

  TileContents run() {
    read_glb_tile();
    read_citygml_tile();
    read_cityjson_tile();
    return std::move(tile_);
  }

 private:
  void found(Check check, const std::string& file, std::string what) {
    result_.findings.push_back({check, file, "", std::move(what)});
  }

  void take(std::vector<Finding>& findings) {
    result_.findings.insert(result_.findings.end(), std::make_move_iterator(findings.begin()),
                            std::make_move_iterator(findings.end()));
    findings.clear();
  }

  void read_glb_tile() {
    if (files_.path[kGltf].empty()) return;
    std::vector<std::string> paths = files_.pieces;
    if (paths.empty()) paths.push_back(files_.path[kGltf]);
    for (const std::string& path : paths) {
      std::optional<Glb> glb = read_glb_file(path, context_, result_);
      if (!glb) {
        tile_.glb.reset();
        return;
      }
      read_entry(*glb, path);
      if (!tile_.glb) {
        tile_.glb = std::move(glb);
        continue;
      }
      if (glb->georeference.local_to_ecef != tile_.glb->georeference.local_to_ecef)
        found(Check::georeference, path, "its frame is not that of " + paths.front());
      append(*tile_.glb, std::move(*glb));
    }
  }

  /// Where the tileset has it.
  void read_entry(const Glb& glb, const std::string& path) {
    Matrix& transform = tile_.transform;
    transform = glb.georeference.local_to_ecef;
    if (!context_.tileset || !context_.tileset->readable) return;
    const auto entry = context_.tileset->entries.find(path);
    if (entry == context_.tileset->entries.end())
      return found(Check::tile_missing, path, "the tileset does not name it");
    check_bounds(glb, entry->second, path, result_);
    transform = entry->second.transform;
    if (!glb.georeference.present || transform == glb.georeference.local_to_ecef) return;
    const Matrix& g = glb.georeference.local_to_ecef;
    found(Check::georeference, path,
          fmt::format("its local_to_ecef is not the tileset's transform: origins {:.4f} m apart",
                      std::hypot(transform[12] - g[12], transform[13] - g[13], transform[14] - g[14])));
  }

  void read_citygml_tile() {
    const std::string& path = files_.path[kCityGml];
    if (path.empty()) return;
    const auto xml = load_file(path, context_, result_.counts[kCityGml], result_);
    if (!xml) return;
    CityGml gml = read_citygml(*xml, path);
    take(gml.contents.findings);
    if (!gml.readable) {
      result_.counts[kCityGml].incomplete = true;
      return;
    }
    if (context_.schema)
      for (Finding& f : context_.schema->validate(*xml, path)) result_.findings.push_back(std::move(f));
    const auto number = [](const std::string& code) { return code.substr(code.find(':') + 1); };
    const std::string expected = context_.record.vertical_crs.empty()
                                     ? "urn:ogc:def:crs:EPSG::" + number(context_.record.crs)
                                     : "urn:ogc:def:crs,crs:EPSG::" + number(context_.record.crs) +
                                           ",crs:EPSG::" + number(context_.record.vertical_crs);
    if (!gml.contents.buildings.empty() && gml.srs_name != expected)
      found(Check::citygml_rule, path, fmt::format("srsName is {}, by build.json it is {}", gml.srs_name, expected));
    tile_.models[kCityGml] = std::move(gml.contents);
  }

  void read_cityjson_tile() {
    const std::string& path = files_.path[kCityJson];
    if (path.empty()) return;
    const auto text = load_file(path, context_, result_.counts[kCityJson], result_);
    if (!text) return;
    Contents contents = read_cityjson(*text, path);
    const bool unreadable = says_unreadable(contents.findings);
    take(contents.findings);
    if (unreadable)
      result_.counts[kCityJson].incomplete = true;
    else
      tile_.models[kCityJson] = std::move(contents);
  }

  const TileFiles& files_;
  const TileContext& context_;
  TileResult& result_;
  TileContents tile_;
};

}  // namespace

const Contents* TileContents::of(std::size_t format) const {
  if (format == kGltf) return glb ? &glb->contents : nullptr;
  return models[format] ? &*models[format] : nullptr;
}

const Contents* TileContents::model(std::size_t& format) const {
  for (const std::size_t f : {kCityGml, kCityJson, kGltf})
    if (const Contents* c = of(f)) {
      format = f;
      return c;
    }
  return nullptr;
}

std::optional<std::string> load_file(const std::string& path, const TileContext& context, FormatCounts& counts,
                                     TileResult& result) {
  const std::string full = (std::filesystem::path(context.folder) / path).string();
  std::error_code error;
  if (!std::filesystem::exists(full, error)) {
    counts.incomplete = true;
    return std::nullopt;
  }
  std::string why;
  auto content = content_of(full, why);
  if (!content) {
    result.findings.push_back({Check::file_unreadable, path, "", why});
    counts.incomplete = true;
  }
  return content;
}

std::optional<Glb> read_glb_file(const std::string& path, const TileContext& context, TileResult& result) {
  FormatCounts& counts = result.counts[kGltf];
  const auto bytes = load_file(path, context, counts, result);
  if (!bytes) return std::nullopt;
  Glb glb = read_glb(*bytes, path);
  std::move(glb.contents.findings.begin(), glb.contents.findings.end(), std::back_inserter(result.findings));
  glb.contents.findings.clear();
  if (!glb.readable) {
    counts.incomplete = true;
    return std::nullopt;
  }
  if (glb.georeference.present && glb.georeference.crs != context.record.crs)
    result.findings.push_back({Check::georeference, path, "",
                               fmt::format("says {}, build.json says {}", glb.georeference.crs, context.record.crs)});
  for (const auto* list : {&glb.triangles, &glb.element_triangles})
    for (const auto& t : *list) result.triangles += t.size();
  return glb;
}

void check_bounds(const Glb& glb, const TilesetEntry& entry, const std::string& path, TileResult& result) {
  std::vector<model::Point3> points = glb.vertices;
  const std::vector<model::Point3> corners = place_corners(glb);
  points.insert(points.end(), corners.begin(), corners.end());
  const Overhang over = overhang(entry, points);
  const auto found = [&](double metres, std::string_view whose) {
    if (metres > kVolumeTolerance)
      result.findings.push_back(
          {Check::tile_bounds, path, "",
           fmt::format("its mesh lies up to {:.3f} m outside of {} bounding volume", metres, whose)});
  };
  found(over.own, "the tile's");
  found(over.ancestor, "an ancestor's");
}

TileContents read_tile(const TileFiles& files, const TileContext& context, TileResult& result) {
  return Reader(files, context, result).run();
}

}  // namespace blockrand::validate
