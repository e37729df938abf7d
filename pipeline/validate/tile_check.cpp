#include "pipeline/validate/tile_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>

#include "pipeline/geometry/solid_defect.h"
#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/detail_check.h"
#include "pipeline/validate/glb.h"
#include "pipeline/validate/ids.h"
#include "pipeline/validate/lean_agreement.h"
#include "pipeline/validate/part_overlap_check.h"
#include "pipeline/validate/placed_elements.h"
#include "pipeline/validate/places.h"
#include "pipeline/validate/solids.h"
#include "pipeline/validate/tile_contents.h"

namespace blockrand::validate {
namespace {

using model::Point2;
using model::Point3;

constexpr double kPositionTolerance = 1e-3;  // m; the promise
// Corners of meshes: the millimetre, and the tenth that the polynomial of a tile's frame may cost.
// And steps of 1/2048 m that vertices and places are stored in: 0.42 mm.
constexpr double kMeshTolerance = 1.55e-3;
// m. The model's grid (0.69 mm in plan) and the tile's steps (0.35) are 1.04 mm where both are at their worst.
constexpr double kTileRounding = 5e-5;
// The geoid over a tile is a plane for the writer and a grid here.
constexpr double kGeoidTolerance = 5e-3;

bool has_geometry(const ReadBody& body, int lod) { return lod == 0 ? !body.footprint.empty() : !body.solids.empty(); }

class Checker {
 public:
  Checker(const TileFiles& files, const TileContext& context)
      : files_(files), context_(context), baked_(context.record.baked), lean_(context.record.lean_citygml) {}

  TileResult run() {
    tile_ = read_tile(files_, context_, out_);
    validate_solids();
    check_overlaps();
    compare();
    check_levels();
    check_geopackage();
    check_explained();
    check_positions();
    count();
    return std::move(out_);
  }

  TileResult run_single_glb() {
    tile_.glb = read_glb_file(files_.path[kGltf], context_, out_);
    if (tile_.glb) {
      baked_ = context_.record.single_baked;
      if (tile_.glb->objects != context_.record.single_objects && !tile_.glb->contents.bodies.empty())
        found(Check::glb_rule, files_.path[kGltf], "",
              tile_.glb->objects ? "has objects of houses, for which the build did not ask"
                                 : "has no objects of houses, though the build asked for them");
      tile_.transform = tile_.glb->georeference.local_to_ecef;
      find_doubles({tile_.glb->contents, files_.path[kGltf]}, out_.findings);
      check_sources({tile_.glb->contents, files_.path[kGltf]}, context_.record.people, out_.findings);
      validate_meshes();
      check_positions();
      count();
    }
    return std::move(out_);
  }

 private:
  void found(Check check, const std::string& file, std::string object, std::string what) {
    out_.findings.push_back({check, file, std::move(object), std::move(what)});
  }

  /// Of the values in a format.
  Precision precision(std::size_t format) const {
    return format != kGltf ? Precision::exact : context_.record.people ? Precision::people : Precision::table;
  }

  void take(std::vector<Finding>& findings) {
    out_.findings.insert(out_.findings.end(), std::make_move_iterator(findings.begin()),
                         std::make_move_iterator(findings.end()));
    findings.clear();
  }

  // ---- one format by itself

  /// The same buildings in less detail: the same rows, in the same place, and meshes like the solids of their level.
  void check_levels() {
    if (!tile_.glb) return;
    const Side finest{tile_.glb->contents, files_.path[kGltf]};
    if (context_.record.lod == 3 && !tile_.glb->triangles.empty() && files_.levels.empty())
      found(Check::tile_missing, files_.path[kGltf], "", "no coarser level of the tile");
    for (const auto& [lod, path] : files_.levels) {
      FormatCounts ignored;
      const auto bytes = load_file(path, context_, ignored, out_);
      if (!bytes) continue;
      Glb glb = read_glb(*bytes, path);
      take(glb.contents.findings);
      if (!glb.readable) continue;
      if (glb.georeference.local_to_ecef != tile_.glb->georeference.local_to_ecef)
        found(Check::georeference, path, "", "its frame is not that of " + files_.path[kGltf]);
      if (context_.tileset && context_.tileset->readable) {
        const auto entry = context_.tileset->entries.find(path);
        if (entry == context_.tileset->entries.end())
          found(Check::tile_missing, path, "", "the tileset does not name it");
        else
          check_bounds(glb, entry->second, path, out_);
      }
      if (!glb.places.empty()) found(Check::glb_rule, path, "", "places elements, which no coarser level has");
      const Side level{glb.contents, path};
      compare_objects(finest, level, out_.findings);
      compare_attributes(finest, level, precision(kGltf), out_.findings);
      validate_meshes(glb, path, lod);
      compare_level(glb, path, lod);
    }
  }

  void compare_level(const Glb& glb, const std::string& path, int lod) {
    const std::size_t f = tile_.models[kCityGml] ? kCityGml : kCityJson;
    if (!tile_.models[f] || !context_.proj_transform) return;
    Contents coarse;
    for (const ReadBody& body : tile_.models[f]->bodies) {
      ReadBody& copy = coarse.bodies.emplace_back();
      copy.id = body.id;
      copy.footprint = body.footprint;
      for (const ReadSolid& solid : body.solids)
        if (solid.lod <= lod) copy.solids.push_back(solid);
    }
    compare_in_frame(glb, [&](const ToLocal& to_local, double tolerance) {
      compare_meshes({coarse, files_.path[f]}, glb, path, to_local, tolerance, false, out_.findings);
    });
  }

  void validate_meshes() {
    validate_meshes(*tile_.glb, files_.path[kGltf], context_.record.lod);
    if (context_.record.lod == 3 && !baked_) check_openings(*tile_.glb, files_.path[kGltf], out_.findings);
  }

  /// \param level  of detail that the file shows; a mesh of LoD3 is several bodies with holes in their walls
  void validate_meshes(const Glb& glb, const std::string& path, int level) {
    for (std::size_t i = 0; i < glb.triangles.size(); ++i) {
      const ReadBody& body = glb.contents.bodies[i];
      const auto lod = body.attributes.find("lod");
      const bool detailed = level == 3 && lod != body.attributes.end() && lod->second == "3";
      // A footprint laid on the ground is no solid.
      if (glb.triangles[i].empty() || level == 0 || detailed || (lod != body.attributes.end() && lod->second == "0"))
        continue;
      // The model of a landmark is told to bound nothing.
      if (level >= 2 && lod != body.attributes.end() && lod->second == "2" &&
          body.attributes.contains("open_surfaces")) {
        unsound_.insert(body.id);
        continue;
      }
      ++out_.validated;
      const SolidValidity validity = validator(glb.triangles[i]);
      if (!validity.valid()) unsound_.insert(body.id);
      note(validity, path, body.id, "mesh", out_.findings);
    }
  }

  void validate_solids() {
    if (tile_.glb) validate_meshes();
    const Contents *gml = tile_.of(kCityGml), *json = tile_.of(kCityJson);
    std::unordered_map<std::string_view, const ReadBody*> validated;
    if (gml)
      for (const ReadBody& body : gml->bodies) {
        validated.emplace(body.id, &body);
        validate_body(body, files_.path[kCityGml]);
      }
    if (!json) return;
    for (const ReadBody& body : json->bodies) {
      // The same polygons in the same order have their verdict already.
      const auto other = validated.find(body.id);
      if (other != validated.end() && same_solids(*other->second, body))
        out_.validated += body.solids.size();
      else
        validate_body(body, files_.path[kCityJson]);
    }
  }

  void validate_body(const ReadBody& body, const std::string& file) {
    for (const ReadSolid& solid : body.solids) {
      ++out_.validated;
      const SolidValidity validity = solid.closed ? validator(solid) : surfaces_validity(solid);
      if (!solid.closed) unsound_.insert(body.id);  // what encloses nothing cannot overlap
      if (!validity.valid()) unsound_.insert(body.id);
      note(validity, file, body.id, fmt::format("LoD {}", solid.lod), out_.findings);
    }
    for (const ReadInstallation& installation : body.detail.installations) {
      ++out_.validated;
      note(validator({3, installation.polygons}), file, installation.id, installation.kind, out_.findings);
    }
  }

  /// Parts of one building, in the first format that has them; where two formats differ, that is a finding already.
  void check_overlaps() {
    const auto told = [&](const std::string& id) {
      return context_.overlapping &&
             (context_.overlapping->count(owner(id)) || context_.overlapping->count(building_of(id)));
    };
    std::size_t format = 0;
    const Contents* c = tile_.model(format);
    if (!c || context_.record.lod == 0) return;
    for (PartsOverlap& o : format == kGltf ? find_overlaps(*tile_.glb, out_.pairs) : find_overlaps(*c, out_.pairs)) {
      // What encloses nothing cannot overlap.
      if (unsound_.count(o.first) || unsound_.count(o.second)) continue;
      if (told(o.first) || told(o.second))
        out_.told_overlaps.push_back(o.first + " " + o.detail);
      else
        out_.findings.push_back({Check::solids_overlap, files_.path[format], std::move(o.first), std::move(o.detail),
                                 geometry::kPartsOverlapCode});
    }
  }

  bool drawn_elements() const {
    return std::ranges::any_of(tile_.glb->element_triangles, [](const auto& of_row) { return !of_row.empty(); });
  }

  static bool same_solids(const ReadBody& a, const ReadBody& b) {
    return std::equal(
        a.solids.begin(), a.solids.end(), b.solids.begin(), b.solids.end(), [](const ReadSolid& x, const ReadSolid& y) {
          return x.lod == y.lod && x.closed == y.closed &&
                 std::equal(x.polygons.begin(), x.polygons.end(), y.polygons.begin(), y.polygons.end(),
                            [](const ReadPolygon& p, const ReadPolygon& q) { return p.rings == q.rings; });
        });
  }

  /// The ground is where ground_height says it is.
  void check_ground(const Contents& c, const std::string& file) {
    for (const ReadBody& body : c.bodies) {
      const auto ground = body.attributes.find("ground_height");
      if (ground == body.attributes.end()) continue;
      const double z = model::snap(to_number(ground->second));
      const auto check = [&](const ReadPolygon& polygon, const char* what) {
        for (const auto& ring : polygon.rings)
          for (const Point3& p : ring)
            if (std::fabs(p.z - z) > 1e-9) {
              found(Check::geometry_differs, file, body.id,
                    fmt::format("its {} lies at {:.4f} m, ground_height is {}", what, p.z, ground->second));
              return false;
            }
        return true;
      };
      bool good = true;
      for (const ReadPolygon& p : body.footprint) good = good && check(p, "footprint");
      for (const ReadSolid& solid : body.solids)
        for (const ReadPolygon& p : solid.polygons) good = good && (p.kind != "ground" || check(p, "ground surface"));
    }
  }

  // ---- formats against each other

  void compare() {
    std::vector<std::size_t> there;
    for (const std::size_t f : {kCityGml, kCityJson, kGltf})
      if (tile_.of(f)) {
        there.push_back(f);
        find_doubles({*tile_.of(f), files_.path[f]}, out_.findings);
      }
    if (tile_.glb) check_sources({tile_.glb->contents, files_.path[kGltf]}, context_.record.people, out_.findings);
    for (const std::size_t f : {kCityGml, kCityJson})
      if (tile_.of(f)) check_ground(*tile_.of(f), files_.path[f]);
    if (there.empty()) return;
    const std::size_t reference = there.front();
    const Side first{*tile_.of(reference), files_.path[reference]};
    for (const std::size_t f : there) {
      if (f == reference) continue;
      const Side other{*tile_.of(f), files_.path[f]};
      compare_objects(first, other, out_.findings);
      compare_attributes(first, other, precision(f), out_.findings);
      out_.compared += other.contents.bodies.size();
      if (f != kCityJson) continue;
      if (reference == kCityGml && lean_) {
        compare_lean(first, other);
      } else {
        compare_polygons(first, other, out_.findings);
        compare_details(first, other);
      }
    }
    if (tile_.glb && reference != kGltf) {
      const std::size_t f = reference == kCityGml ? detailed_format() : reference;
      compare_with_mesh({*tile_.of(f), files_.path[f]}, f == kCityGml && lean_);
    }
    note_absent(reference, there);
  }

  void compare_details(const Side& a, const Side& b) {
    std::unordered_map<std::string_view, const ReadBody*> bodies;
    for (const ReadBody& body : a.contents.bodies) bodies.emplace(body.id, &body);
    for (const ReadBody& body : b.contents.bodies)
      if (const auto same = bodies.find(body.id); same != bodies.end())
        if (std::string what = detail_difference(*same->second, body); !what.empty())
          found(Check::geometry_differs, b.file, body.id, fmt::format("LoD 3: {}, in {}", what, a.file));
  }

  /// CityGML, or where it is lean CityJSON, if the tile has it.
  std::size_t detailed_format() const { return lean_ && tile_.of(kCityJson) ? kCityJson : kCityGml; }

  void compare_lean(const Side& lean, const Side& other) {
    const Contents flat = without_reveals(other.contents);
    compare_polygons(lean, {flat, other.file}, out_.findings);
    std::unordered_map<std::string_view, const ReadBody*> bodies;
    for (const ReadBody& body : lean.contents.bodies) bodies.emplace(body.id, &body);
    for (const ReadBody& body : flat.bodies)
      if (const auto same = bodies.find(body.id); same != bodies.end())
        if (const std::string what = lean_difference(*same->second, lean.contents, body, flat); !what.empty())
          found(Check::geometry_differs, lean.file, body.id, fmt::format("LoD 3: {}, in {}", what, other.file));
  }

  /// \param lean  the reference lacks what elements stand for: meshes of LoD3 are not compared
  void compare_with_mesh(const Side& reference, bool lean) {
    if (!context_.proj_transform) return;
    compare_in_frame(*tile_.glb, [&](const ToLocal& to_local, double tolerance) {
      compare_meshes(reference, *tile_.glb, files_.path[kGltf], to_local, tolerance, baked_ || lean, out_.findings);
      if (!baked_ && !lean)
        // Where a tile has few elements, all of them may be triangles of its mesh.
        (tile_.glb->pieces || drawn_elements() ? compare_pieces : compare_places)(
            reference, *tile_.glb, files_.path[kGltf], to_local, tolerance, out_.findings);
    });
  }

  /// Calls `compare` with the way to the frame of the tile's GLBs, and with what a vertex may be off.
  template <class Compare>
  void compare_in_frame(const Glb& glb, const Compare& compare) {
    const bool raised = glb.georeference.height_reference.find("raised to the ellipsoid") != std::string::npos;
    context_.proj_transform->with([&](georef::ProjTransform& proj_transform) {
      const ToLocal to_local = [&](std::span<const Point3> in, std::span<Point3> out) {
        for (std::size_t i = 0; i < in.size(); ++i) {
          const georef::LonLat at = proj_transform.inverse(in[i].xy());
          const double undulation = raised ? context_.geoid.undulation(at.lon, at.lat).value_or(0) : 0;
          out[i] = apply_inverse(tile_.transform, proj_transform.to_ecef({at.lon, at.lat, in[i].z + undulation}));
        }
      };
      compare(to_local, kMeshTolerance + glb.position_step * 0.87 + (raised ? kGeoidTolerance : 0));
    });
  }

  /// A format that the build has, but not for this tile.
  void note_absent(std::size_t reference, const std::vector<std::size_t>& there) {
    const Contents& c = *tile_.of(reference);
    if (c.bodies.empty()) return;
    for (std::size_t f = 0; f < kTileFormats; ++f) {
      if (!context_.record.has(kFormats[f].key) || !files_.path[f].empty() || std::count(there.begin(), there.end(), f))
        continue;
      // A tile where nothing could be built has no mesh.
      const auto shown = std::count_if(c.bodies.begin(), c.bodies.end(),
                                       [&](const ReadBody& b) { return has_geometry(b, context_.record.lod); });
      if (f == kGltf && shown == 0) continue;
      found(Check::object_missing, files_.path[reference], files_.name,
            fmt::format("{} bodies of the tile, but no file of it in {}", c.bodies.size(), kFormats[f].title));
    }
  }

  void check_geopackage() {
    if (!context_.geopackage) return;
    std::string tile = files_.name;
    std::replace(tile.begin(), tile.end(), '_', '/');
    GeoPackageTileRows rows = context_.geopackage->rows(tile);
    take(rows.contents.findings);
    static const std::string file = "buildings.gpkg";
    find_doubles({rows.contents, file}, out_.findings);
    FormatCounts& n = out_.geopackage;
    n.buildings = rows.contents.buildings.size();
    n.bodies = rows.contents.bodies.size();
    std::size_t format = 0;
    const Contents* reference = tile_.model(format);
    if (!reference) return;
    // Buildings without a body are rows of the layer, but not in the other formats.
    std::set<std::string_view> with_bodies;
    std::unordered_map<std::string_view, std::int64_t> parts;
    for (const ReadBody& body : rows.contents.bodies) {
      with_bodies.insert(body.building);
      ++parts[body.building];
    }
    Contents shown;
    for (const GeoPackageBuilding& b : rows.buildings) {
      if (parts[b.id] != b.parts)
        found(Check::geopackage_rule, file, b.id,
              fmt::format("its row says {} parts, there are {}", b.parts, parts[b.id]));
      if (with_bodies.count(b.id)) shown.buildings.push_back(b.id);
    }
    shown.bodies = std::move(rows.contents.bodies);
    const Side first{*reference, files_.path[format]}, other{shown, file};
    compare_objects(first, other, out_.findings);
    compare_attributes(first, other, precision(format), out_.findings);
    out_.compared += shown.bodies.size();
    if (format == kGltf) return;
    Contents flat;  // the layer has footprints without heights
    for (const ReadBody& body : reference->bodies) {
      ReadBody copy;
      copy.id = body.id;
      copy.footprint = body.footprint;
      for (ReadPolygon& polygon : copy.footprint) {
        polygon.colour.clear();
        for (auto& ring : polygon.rings)
          for (Point3& p : ring) p.z = 0;
      }
      flat.bodies.push_back(std::move(copy));
    }
    compare_polygons({flat, files_.path[format]}, other, out_.findings);
  }

  /// The tile's lines of explain/places.tsv; null where the build has no such file.
  const std::map<std::string, PlaceRow>* places() const {
    static const std::map<std::string, PlaceRow> none;
    if (!context_.places) return nullptr;
    const auto found = context_.places->find(files_.name);
    return found == context_.places->end() ? &none : &found->second;
  }

  void check_explained() {
    if (!context_.explanations) return;
    std::size_t format = 0;
    const Contents* reference = tile_.model(format);
    if (format == kCityGml && reference) reference = tile_.of(format = detailed_format());
    if (files_.explanations.empty()) {
      if (reference && !reference->bodies.empty())
        found(Check::explanation_wrong, files_.path[format], files_.name, "the tile has no file in explain/");
      return;
    }
    FormatCounts ignored;
    const auto lines = load_file(files_.explanations, context_, ignored, out_);
    if (!lines) return;
    static const std::vector<std::pair<std::string, std::string>> none;
    const auto entries = context_.explanations->find(files_.name);
    out_.explained = check_explanations(
        *lines, files_.explanations, files_.name, reference, format == kCityGml && lean_,
        entries == context_.explanations->end() ? none : entries->second, places(), context_.record, out_.findings);
  }

  // ---- against the map

  void check_positions() {
    if (!context_.positions || context_.sample.empty()) return;
    std::map<std::string, std::vector<std::pair<std::size_t, const ReadBody*>>> bodies;  // in id order
    std::unordered_map<std::string_view, std::size_t> rows;
    for (std::size_t f = 0; f < kTileFormats; ++f)
      if (const Contents* c = tile_.of(f))
        for (std::size_t i = 0; i < c->bodies.size(); ++i) {
          const ReadBody& body = c->bodies[i];
          if (!context_.sample.corners.count(body.id)) continue;
          if (f == kGltf) rows.emplace(body.id, i);
          // Rules for footprints step back from them, and models stand where they stand.
          if (body.attributes.contains("open_surfaces") || body.attributes.contains("replaced_by")) continue;
          if (f == kGltf ? !tile_.glb->triangles[i].empty() : has_geometry(body, context_.record.lod))
            bodies[body.id].emplace_back(f, &body);
        }
    context_.positions->with([&](georef::ProjTransform& proj_transform) {
      for (const auto& [id, shown] : bodies) {
        std::vector<std::vector<Point2>> places(kTileFormats);  // of GLB in degrees
        for (const auto& [f, body] : shown)
          places[f] = f == kGltf ? corners_on_earth(proj_transform, tile_.transform, tile_.glb->triangles[rows.at(id)])
                                 : plan_points(*body);
        const auto moved = context_.sample.reach.find(id);
        const double reach = moved == context_.sample.reach.end() ? 0 : moved->second;
        for (const SampledCorner& corner : context_.sample.corners.at(id)) {
          PositionResult result;
          result.moved = reach > 0;
          result.rank = corner.rank;
          result.object = id;
          for (const auto& [f, body] : shown) {
            result.file[f] = files_.path[f];
            result.offset[f] =
                f == kGltf
                    ? offset_on_earth(places[f], corner.at)
                    : offset(places[f], proj_transform.forward({corner.at.lon_degrees(), corner.at.lat_degrees()}));
            result.off[f] = std::hypot(result.offset[f].x, result.offset[f].y);
            result.tolerance[f] =
                kPositionTolerance + reach + (f == static_cast<std::size_t>(Format::gltf) ? kTileRounding : 0);
          }
          out_.positions.push_back(std::move(result));
        }
      }
    });
  }

  // ---- counting

  void count() {
    std::set<std::string> modelled;
    bool counted_sources = false;
    for (const std::size_t f : {kCityGml, kCityJson, kGltf}) {
      const Contents* c = tile_.of(f);
      if (!c) continue;
      FormatCounts& n = out_.counts[f];
      n.files = 1;
      n.buildings = std::set<std::string_view>(c->buildings.begin(), c->buildings.end()).size();
      n.bodies = c->bodies.size();
      std::set<std::string> models;
      const bool digested = f == kGltf       ? context_.record.single_glb
                            : f == kCityJson ? context_.record.single_cityjson
                                             : false;
      const std::vector<DrawnArea> drawn = f == kGltf && digested ? drawn_areas(*tile_.glb) : std::vector<DrawnArea>();
      // Where elements are part of the one mesh and stand apart from the other, numbers of triangles say nothing.
      const bool countable = context_.record.lod < 3 || (context_.record.baked == context_.record.single_baked &&
                                                         !(baked_ && context_.record.single_objects));
      for (std::size_t i = 0; i < c->bodies.size(); ++i) {
        const ReadBody& body = c->bodies[i];
        out_.ids[f].push_back(body.id);
        if (digested) {
          BodyDigest d = digest(body);
          if (f == kGltf) {
            d.geometry = countable ? tile_.glb->triangles[i].size() : 0;
            d.drawn = drawn[i];
          }
          out_.digests[f].emplace_back(body.id, d);
        }
        out_.attributes += body.attributes.size();
        const bool shown = f == kGltf ? !tile_.glb->triangles[i].empty() : has_geometry(body, context_.record.lod);
        if (shown) models.insert(owner(body.id));
        if (f == kGltf) n.solids[0] += shown;
        if (f != kGltf) count_detail(body, n);
        if (!counted_sources) {
          count_sources(body);
          if (shown || !body.footprint.empty()) out_.buildings.push_back(body.building);
        }
      }
      counted_sources = true;
      // Doubles within the tile were found already.
      std::sort(out_.ids[f].begin(), out_.ids[f].end());
      out_.ids[f].erase(std::unique(out_.ids[f].begin(), out_.ids[f].end()), out_.ids[f].end());
      n.models = models.size();
      modelled.merge(models);
    }
    out_.modelled.assign(modelled.begin(), modelled.end());
  }

  static void count_detail(const ReadBody& body, FormatCounts& n) {
    for (const ReadSolid& solid : body.solids) {
      n.solids[std::clamp(solid.lod, 0, 3)] += solid.closed;
      for (const ReadPolygon& polygon : solid.polygons) {
        n.windows += polygon.kind == "window";
        n.doors += polygon.kind == "door";
      }
    }
    n.placements += body.detail.placements.size();
    n.installations += body.detail.installations.size();
  }

  void count_sources(const ReadBody& body) {
    for (const auto& [name, value] : body.attributes) {
      if (name.ends_with("_source")) ++out_.sources[name.substr(0, name.size() - 7)][value];
      if (name == "built_roof") ++out_.roofs[value];
    }
  }

  const TileFiles& files_;
  const TileContext& context_;
  TileResult out_;
  TileContents tile_;
  bool baked_;                     // elements are triangles of their bodies
  bool lean_;                      // CityGML leaves reveals and elements of openings out
  std::set<std::string> unsound_;  // bodies with a solid that a validator refused
};

}  // namespace

void FormatCounts::add(const FormatCounts& other) {
  files += other.files;
  buildings += other.buildings;
  bodies += other.bodies;
  for (std::size_t i = 0; i < std::size(solids); ++i) solids[i] += other.solids[i];
  windows += other.windows;
  doors += other.doors;
  placements += other.placements;
  installations += other.installations;
  models += other.models;
  incomplete = incomplete || other.incomplete;
}

TileResult check_tile(const TileFiles& files, const TileContext& context) { return Checker(files, context).run(); }

TileResult check_single_glb(const std::string& path, const TileContext& context) {
  TileFiles files;
  files.name = path;
  files.path[kGltf] = path;
  return Checker(files, context).run_single_glb();
}

}  // namespace blockrand::validate
