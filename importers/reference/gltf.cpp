#include "importers/reference/gltf.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "importers/reference/file_bytes.h"
#include "importers/reference/gltf_file.h"
#include "importers/reference/gltf_scene.h"
#include "importers/reference/height_words.h"
#include "importers/reference/polygons.h"
#include "importers/reference/tileset_tree.h"
#include "pipeline/base/error.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/crs_facts.h"
#include "pipeline/georef/transform.h"

namespace blockrand::importers::reference {
namespace {

/// m above or below the ellipsoid; nothing that is built lies beyond.
constexpr double kHighest = 20'000;

/// asset.extras.georeference.
struct Georeference {
  std::optional<Matrix4> local_to_ecef;
  std::string crs, height_words;
};

Georeference georeference_of(const Json& json, NoteLog& notes) {
  const Json& stated = member(member(member(json, "asset"), "extras"), "georeference");
  Georeference out;
  out.crs = text(member(stated, "crs"));
  out.height_words = text(member(stated, "height_reference"));
  out.local_to_ecef = matrix_of(member(stated, "local_to_ecef"));
  if (!out.local_to_ecef && !member(stated, "local_to_ecef").is_null())
    notes.add(NoteKind::bad_value, 0, "georeference.local_to_ecef is no matrix");
  const Json& origin = member(stated, "origin");
  const auto lon = number(member(origin, "longitude")), lat = number(member(origin, "latitude"));
  if (!out.local_to_ecef && lon && lat && std::fabs(*lat) <= 90)
    out.local_to_ecef = georef::EnuFrame({*lon, *lat, number(member(origin, "height")).value_or(0)}).local_to_ecef();
  return out;
}

/// A projected CRS in metres, as PROJ names it; nothing where it is none.
std::optional<georef::CrsFacts> metric_crs(const std::string& definition) {
  const auto facts = definition.empty() ? std::nullopt : georef::crs_facts(definition);
  return facts && facts->projected && facts->metres_per_unit == 1.0 ? facts : std::nullopt;
}

/// Turns earth-centred points to degrees and metres above the ellipsoid, and drops polygons that are nowhere near it.
/// \return where they lie; nothing without polygons
std::optional<georef::GeoBox> to_degrees(ReferenceModel& model, NoteLog& notes) {
  if (model.polygons.empty()) return std::nullopt;
  std::optional<georef::GeoBox> box;
  std::vector<bool> lost(model.polygons.size(), false);
  for (std::size_t i = 0; i < model.polygons.size(); ++i) {
    auto& ring = model.polygons[i].outer;
    for (model::Point3& p : ring) {
      const georef::Geodetic g = georef::from_ecef(p);
      p = {g.lon, g.lat, g.height};
    }
    lost[i] = !std::all_of(ring.begin(), ring.end(), [](const model::Point3& p) {
      return std::fabs(p.z) <= kHighest && std::isfinite(p.x) && std::isfinite(p.y);
    });
    if (lost[i]) continue;
    for (const model::Point3& p : ring) {
      if (!box) box = {p.x, p.y, p.x, p.y};
      box = {std::min(box->west, p.x), std::min(box->south, p.y), std::max(box->east, p.x), std::max(box->north, p.y)};
    }
  }
  if (!box)
    throw base::InputError(model.path, "",
                           "nothing says where on the Earth it lies: its transforms lead nowhere near the ground",
                           "--reference-origin (of the judged model --model-origin) LON,LAT,HEIGHT says where a glTF "
                           "file's origin is (degrees, m above the ellipsoid)");
  if (const auto count = std::count(lost.begin(), lost.end(), true); count > 0) {
    notes.add(NoteKind::bad_coordinates, 0, std::to_string(count) + " triangles are nowhere near the ground");
    drop_polygons(model, lost);
  }
  return box;
}

/// Chooses the CRS and turns earth-centred points to it; z becomes the height above the ellipsoid.
void project(ReferenceModel& model, const std::string& stated_crs, const ReadOptions& options, NoteLog& notes) {
  const auto box = to_degrees(model, notes);
  std::string definition = options.reference_crs;
  auto facts = metric_crs(definition);
  if (!facts && !definition.empty())
    throw base::UsageError("--reference-crs (of the judged model: --model-crs) " + definition +
                           " is no projected coordinate reference system in metres");
  model.crs.stated = stated_crs;
  model.crs.from_options = !definition.empty();
  if (!facts && (facts = metric_crs(stated_crs))) definition = stated_crs;
  if (!facts && box) {
    definition = georef::choose_crs(box->centre().lon, box->centre().lat);
    facts = georef::crs_facts(definition);
    notes.add(NoteKind::crs, 0, "coordinates are given in " + definition + ", chosen from the place");
  }
  if (!facts) return;
  model.crs.horizontal = facts->authority_code.empty() ? definition : facts->authority_code;
  model.crs.name = facts->name;
  if (!box) return;
  const georef::Transform transform("EPSG:4326", model.crs.horizontal, box);
  std::vector<bool> lost(model.polygons.size(), false);
  for (std::size_t i = 0; i < model.polygons.size(); ++i)
    for (model::Point3& p : model.polygons[i].outer) {
      const model::Point2 q = transform.forward(p.xy());
      lost[i] = lost[i] || !std::isfinite(q.x) || !std::isfinite(q.y);
      p = {q.x, q.y, p.z};
    }
  const auto count = std::count(lost.begin(), lost.end(), true);
  if (count == 0) return;
  if (count == std::ssize(lost))
    throw base::InputError(model.path, "", "lies where " + model.crs.name + " is not defined",
                           "--reference-crs (of the judged model: --model-crs) names another");
  notes.add(NoteKind::bad_coordinates, 0, std::to_string(count) + " triangles lie where the CRS is not defined");
  drop_polygons(model, lost);
}

Matrix4 matrix_at(const georef::Geodetic& origin) { return georef::EnuFrame(origin).local_to_ecef(); }

void check_origin(const ReadOptions& options) {
  const auto& o = options.gltf_origin;
  if (o && !(std::fabs(o->lon) <= 360 && std::fabs(o->lat) <= 90 && std::fabs(o->height) <= kHighest))
    throw base::UsageError("the origin of a glTF file is a longitude and a latitude in degrees and a height in metres");
}

void read_tiles(const std::string& path, const Json& json, const ReadOptions& options, ReferenceModel& model,
                NoteLog& notes) {
  Tileset tileset = read_tileset(path, json, notes);
  model.version = tileset.version;
  model.format = "3D Tiles " + tileset.version;
  model.bytes = tileset.bytes;
  GltfScene scene(model, notes);
  std::string crs, words;
  for (const TilesetContent& content : tileset.contents) {
    std::optional<GltfFile> file;
    try {
      file.emplace(content.path, notes);
    } catch (const base::InputError& broken) {
      if (tileset.contents.size() == 1) throw;
      notes.add(NoteKind::incomplete_building, 0, broken.what());
      continue;
    }
    model.bytes += file->bytes();
    const Georeference georeference = georeference_of(file->json(), notes);
    if (crs.empty()) crs = georeference.crs;
    if (words.empty()) words = georeference.height_words;
    scene.add(*file, content.path, content.place);
  }
  project(model, crs.empty() ? tileset.crs : crs, options, notes);
  decide_heights(model.crs, words.empty() ? tileset.height_words : words);
}

void read_single(const std::string& path, const ReadOptions& options, ReferenceModel& model, NoteLog& notes) {
  GltfFile file(path, notes);
  model.version = text(member(member(file.json(), "asset"), "version"));
  model.format = "glTF " + model.version;
  model.bytes = file.bytes();
  const Georeference georeference = georeference_of(file.json(), notes);
  std::optional<Matrix4> place = georeference.local_to_ecef;
  if (options.gltf_origin) place = matrix_at(*options.gltf_origin);
  if (!place)
    throw base::InputError(path, "", "nothing says where on the Earth it lies: it has no asset.extras.georeference",
                           "--reference-origin (of the judged model --model-origin) LON,LAT,HEIGHT says where its "
                           "origin is (degrees, m above the ellipsoid); or "
                           "name the tileset.json that places it");
  GltfScene scene(model, notes);
  scene.add(file, path, *place * kYUpToZUp);
  project(model, georeference.crs, options, notes);
  decide_heights(model.crs, options.gltf_origin ? "" : georeference.height_words);
}

}  // namespace

ReferenceModel read_gltf(const std::string& path, const ReadOptions& options) {
  check_readable(path);
  check_origin(options);
  ReferenceModel model;
  model.path = path;
  NoteLog notes;
  const std::string head = first_bytes(path, 4);
  if (head == "b3dm" || head == "i3dm" || head == "cmpt" || head == "pnts")
    throw base::InputError(
        path, "", "is a tile of format " + head + ", which is not read",
        "Convert its tileset to glTF contents, for instance: npx 3d-tiles-tools upgrade -i IN -o OUT "
        "--targetVersion 1.1");
  std::optional<Json> tileset;
  if (head != "glTF") {
    Json json = parse_json(path, all_bytes(path));
    if (!member(json, "root").is_null()) tileset = std::move(json);
  }
  if (tileset) {
    read_tiles(path, *tileset, options, model, notes);
  } else {
    read_single(path, options, model, notes);
  }
  // Points are above the ellipsoid whatever the file says, unless its words mean another zero.
  if (model.crs.height_reference == HeightReference::unknown) model.crs.height_reference = HeightReference::ellipsoidal;
  model.notes = notes.take();
  return model;
}

ReferenceModel read_gltf_axes(const std::string& path) {
  ReferenceModel model;
  model.path = path;
  NoteLog notes;
  GltfFile file(path, notes);
  file.refuse_files_beside();
  GltfScene(model, notes).add(file, path, kIdentity);
  model.format = "glTF 2.0";
  model.version = "2.0";
  model.bytes = file.bytes();
  if (model.polygons.empty())
    throw base::InputError(path, "", "no triangle is drawn in it", "Is it the model that was meant?");
  model.notes = notes.take();
  return model;
}

}  // namespace blockrand::importers::reference
