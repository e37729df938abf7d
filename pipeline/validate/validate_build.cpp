#include "pipeline/validate/validate_build.h"

#include <fmt/format.h>
#include <libxml/parser.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <unordered_set>

#include "pipeline/base/error.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/sha256.h"
#include "pipeline/validate/build_record.h"
#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/cityjson_reader.h"
#include "pipeline/validate/formats.h"
#include "pipeline/validate/packed_files.h"
#include "pipeline/validate/qgis_project.h"
#include "pipeline/validate/report_check.h"
#include "pipeline/validate/surroundings_files.h"
#include "pipeline/validate/tile_check.h"
#include "pipeline/validate/tile_files.h"
#include "pipeline/validate/validate_areas.h"

namespace blockrand::validate {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre = 1e-3;  // m: what positions are promised to
/// m. Sound builds stay far below: the grid takes half a millimetre, repair moves as many corners east as west.
constexpr double kCommonShift = 0.01;
/// Fewer buildings tell no common movement from the repair of one row.
constexpr std::size_t kLeastBuildings = 12;

class Run {
 public:
  Run(const ValidateOptions& options, base::Progress& progress)
      : o_(options), progress_(progress), workers_(base::worker_count(options.jobs)) {}

  Validation run() {
    open();
    checked("files", "listed, there, unchanged (size and SHA-256)",
            check_hashes(o_.folder, record_, workers_, progress_, log()), "files");
    check_packed_files();
    read_whole_files();
    choose_positions();
    check_tiles();
    check_surroundings();
    check_single_files();
    check_counts();
    check_positions();
    progress_.end();
    return std::move(v_);
  }

 private:
  FindingLog& log() { return v_.findings; }
  std::string full(const std::string& path) const { return (fs::path(o_.folder) / path).string(); }
  void checked(std::string what, std::string how, std::uint64_t count, std::string unit) {
    v_.checked.push_back({std::move(what), std::move(how), count, std::move(unit)});
  }

  void open() {
    std::error_code error;
    if (!fs::is_directory(o_.folder, error))
      throw base::UsageError(o_.folder + (fs::exists(o_.folder, error) ? " is no folder." : " does not exist.") +
                             " Name the output folder of a build.");
    if (!fs::exists(full("build.json"), error))
      throw base::UsageError(o_.folder +
                             " is no build: there is no build.json in it. Name the output folder of a build.");
    xmlInitParser();  // before there are several threads
    auto record = read_build_record(o_.folder, log());
    if (!record) {
      record.emplace();  // nothing is known of the files: there is nothing more to check
      unreadable_ = true;
    }
    record_ = std::move(*record);
    geoid_ = georef::Geoid(record_.raised_from);
    if (!unreadable_) {
      const std::vector<std::string> beside = check_file_list(o_.folder, record_, log());
      if (!beside.empty())
        v_.notes.push_back(fmt::format("other programs left {} beside the files of the build, which {}",
                                       fmt::join(beside, ", "),
                                       beside.size() == 1 ? "is no part of it" : "are no part of it"));
    }
    checked("build.json", "fields, sums, configuration against files", 1, "file");
    if (!o_.schemas.empty()) schema_ = std::make_unique<CityGmlSchema>(o_.schemas);
  }

  // ---- files

  void check_packed_files() {
    std::vector<std::string> files;
    for (const auto& [path, file] : record_.files) files.push_back(path);
    if (const std::uint64_t count = check_packed_beside(o_.folder, files, log()))
      checked("packed files", "hold what they stand beside", count, "files");
  }

  void read_whole_files() {
    if (record_.has("gltf") && record_.files.count("tileset.json")) {
      if (const auto bytes = file_bytes(full("tileset.json"))) {
        tileset_ = read_tileset(*bytes, "tileset.json");
        log().add(std::move(tileset_.findings));
        for (const auto& [uri, entry] : tileset_.entries)
          if (!record_.files.count(uri) || !fs::exists(full(uri))) {
            log().add(Check::tile_missing, "tileset.json", uri, "named by the tileset, but not there");
            totals_[0].incomplete = true;
          }
        if (tileset_.readable && tileset_.crs != record_.crs)
          log().add(Check::tileset_rule, "tileset.json", "",
                    fmt::format("says {}, build.json says {}", tileset_.crs, record_.crs));
        checked("tileset.json", "3D Tiles 1.1: volumes, errors, transforms, contents", tileset_.entries.size(),
                "tiles");
      }
    }
    if (record_.files.count("report.json")) report_ = read_report(o_.folder, record_, log());
    if (record_.explain) {
      std::string why;
      if (const auto index =
              record_.files.count("explain/index.txt") ? content_of(full("explain/index.txt"), why) : std::nullopt)
        index_ = read_explanation_index(*index, log());
      else if (!record_.files.count("explain/index.txt"))
        log().add(Check::build_json, "build.json", "explain/index.txt",
                  "the configuration asks for it, but no such file is listed");
      if (record_.files.count("explain/places.tsv")) {
        if (const auto places = content_of(full("explain/places.tsv"), why)) places_ = read_places(*places, log());
      } else if (index_) {
        v_.notes.push_back(
            "explain/places.tsv is not listed: an older program made this build, which knows no addresses");
      }
    }
    if (record_.has("gpkg") && record_.files.count("buildings.gpkg") && fs::exists(full("buildings.gpkg"))) {
      progress_.begin("buildings.gpkg");
      geopackage_ = std::make_unique<GeoPackageReader>(full("buildings.gpkg"), "buildings.gpkg");
      if (!geopackage_->check(log())) {
        geopackage_.reset();
      } else {
        check_geopackage();
        check_qgis_project();
      }
    }
    if (report_) checked("report.json", "objects and issues against build.json", report_->objects, "objects");
  }

  void check_qgis_project() {
    constexpr const char* kProject = "buildings.qgz";
    if (!record_.files.count(kProject) || !fs::exists(full(kProject))) return;
    std::string why = "cannot be read";
    const auto bytes = file_bytes(full(kProject));
    const auto project = bytes ? qgs_of(*bytes, why) : std::nullopt;
    if (!project) return log().add(Check::file_unreadable, kProject, "", why);
    const std::size_t layers =
        validate::check_qgis_project(*project, kProject, "buildings.gpkg", geopackage_->columns(), record_.crs, log());
    checked("QGIS project", "layers, columns and reference system against buildings.gpkg", layers, "layers");
  }

  void check_geopackage() {
    const std::string epsg = fmt::format("EPSG:{}", geopackage_->srs_id());
    if (epsg != record_.crs)
      log().add(Check::geopackage_rule, "buildings.gpkg", "",
                fmt::format("its layers are in {}, build.json says {}", epsg, record_.crs));
    std::map<std::string, std::uint64_t> in_pieces;  // bytes, by tile
    for (const auto& [path, file] : record_.files)
      if (const auto t = tile_path(path); t && t->piece) in_pieces[t->tile] += file.bytes;
    for (const GeoPackageTileRow& tile : geopackage_->tile_rows()) {
      if (tile.uri.empty()) continue;
      const auto file = record_.files.find(tile.uri);
      if (file == record_.files.end()) {
        log().add(Check::tile_missing, "buildings.gpkg", tile.id, tile.uri + " is not there");
        continue;
      }
      const auto pieces = in_pieces.find(tile_path(tile.uri).value_or(TilePath()).tile);
      const std::uint64_t said = pieces == in_pieces.end() ? file->second.bytes : pieces->second;
      if (tile.bytes != static_cast<std::int64_t>(said))
        log().add(Check::counts_differ, "buildings.gpkg", tile.id,
                  fmt::format("{} bytes, build.json says {}", tile.bytes, said));
    }
    if (!report_) return;
    std::set<std::string> there;
    for (const GeoPackageReportedRow& row : geopackage_->reported()) {
      there.insert(row.id);
      const auto found = report_->all.find(row.id);
      if (found == report_->all.end())
        log().add(Check::object_missing, "report.json", row.id, "is in the layer `reported` of buildings.gpkg only");
      else if (found->second != row.state + " " + row.code)
        log().add(Check::attribute_differs, "buildings.gpkg", row.id,
                  fmt::format("\"{} {}\" in the layer `reported`, \"{}\" in report.json", row.state, row.code,
                              found->second));
    }
    for (const auto& [id, state] : report_->all)
      if (!there.count(id))
        log().add(Check::object_missing, "buildings.gpkg", id, "is in report.json, but not in the layer `reported`");
  }

  // ---- tiles

  void choose_positions() {
    if (unreadable_) return;
    std::error_code error;
    std::string path = o_.extract, why;
    if (path.empty()) {
      path = record_.extract_path;
      if (path.empty() || !fs::is_regular_file(path, error))
        path.clear();
      else if (base::sha256_file(path) != record_.extract_sha256)
        path.clear();
    } else if (!o_.extract_is_known && base::sha256_file(path) != record_.extract_sha256) {
      throw base::UsageError("--extract " + path +
                             " is not the file that the build was made from: its SHA-256 differs.");
    }
    std::vector<std::string> records;
    for (const auto& [file, entry] : record_.files)
      if (file.starts_with("explain/") && file.ends_with(".jsonl.gz")) records.push_back(full(file));
    const std::set<std::string> none;
    const std::set<std::string>& mended = report_ ? report_->mended : none;
    if (!path.empty()) {
      progress_.begin("positions");
      std::optional<std::array<double, 4>> bbox;
      if (const auto box = numbers(member(member(record_.json, "configuration"), "bbox"), 4))
        bbox = {(*box)[0], (*box)[1], (*box)[2], (*box)[3]};
      sample_ = sample_extract(path, bbox, mended);
    } else if (!records.empty()) {
      sample_ = sample_explanations(records, mended);
    }
    // Without the two places that have a record of each building, the build's largest shift is all that is known.
    double otherwise = 0;
    if (!record_.has("gpkg") && !record_.explain) {
      otherwise = number(member(member(record_.json, "repair"), "max_shift_m")).value_or(0);
      if (otherwise > 0 && !sample_.empty())
        v_.notes.push_back(
            fmt::format("the build has neither explanations nor a GeoPackage: any corner may be {:.2f} m "
                        "from where OpenStreetMap has it, as far as repair moved one at most",
                        otherwise));
    }
    bound_positions(sample_, geopackage_ ? geopackage_->repairs() : repairs_of_explanations(records, sample_),
                    report_ ? report_->moved : none, otherwise);
    if (sample_.empty()) {
      v_.notes.push_back(path.empty() && sample_.source.empty()
                             ? "positions were not compared with OpenStreetMap: the extract is not where build.json "
                               "says (give --extract FILE)"
                             : "positions were not compared with OpenStreetMap: no building has a clear corner");
    }
    choose_proj_transform();
  }

  /// PROJ's own choice of an operation where it agrees with the one that build.json pins; the pinned one where several
  /// of known accuracy exist.
  void choose_proj_transform() {
    try {
      georef::ProjTransform pinned(record_.pipeline);
      pinned_.emplace(record_.pipeline);
      positions_ = &*pinned_;
      if (sample_.empty()) return;
      if (record_.files.contains("imagery.json")) {
        std::string why;
        const auto text = content_of(full("imagery.json"), why);
        const auto imagery = text ? parse_json(*text) : std::nullopt;
        if (!imagery)
          log().add(Check::build_json, "imagery.json", "", "cannot be read: what images moved is not known");
        else
          move_positions(sample_, movements_said(*imagery), pinned);
      }
      georef::ProjTransform own(record_.crs, {sample_.west, sample_.south, sample_.east, sample_.north});
      const model::Point2 a = pinned.forward({sample_.lon, sample_.lat}), b = own.forward({sample_.lon, sample_.lat});
      const double apart = std::hypot(a.x - b.x, a.y - b.y);
      if (!(apart <= 2 * std::max(record_.accuracy, 0.0) + 1))
        log().add(Check::build_json, "build.json", "crs.pipeline",
                  fmt::format("leads {:.3f} m from where PROJ has {} at {} {}", apart, record_.crs, sample_.lon,
                              sample_.lat));
    } catch (const base::UsageError& error) {
      log().add(Check::build_json, "build.json", "crs", error.what());
    }
  }

  void check_tiles() {
    std::map<std::string, TileFiles> tiles = files_by_tile(record_, log());
    if (index_)
      for (const auto& [tile, entries] : *index_)
        if (!tiles.count(tile))
          log().add(Check::explanation_wrong, "explain/index.txt", tile, "the index names a tile that is not there");
    if (places_)
      for (const auto& [tile, places] : *places_)
        if (!tiles.count(tile))
          log().add(Check::explanation_wrong, "explain/places.tsv", tile, "names a tile that is not there");
    if (geopackage_)
      for (std::string tile : geopackage_->tiles()) {
        std::replace(tile.begin(), tile.end(), '/', '_');
        tiles[tile].name = tile;
      }
    std::vector<TileFiles> chosen;
    std::size_t number = 0;
    for (auto& [name, files] : tiles)
      if (number++ % static_cast<std::size_t>(std::max(o_.sample, 1)) == 0) chosen.push_back(std::move(files));
    const TileContext context = this->context();
    progress_.begin("tiles", chosen.size(), "tiles");
    std::vector<TileResult> results(chosen.size());
    base::ordered_parallel(
        chosen.size(), workers_, static_cast<std::size_t>(workers_ + 1),
        [&](std::size_t i) { results[i] = checked_tile(chosen[i], context); },
        [&](std::size_t i) {
          take(std::move(results[i]));
          results[i] = {};
          progress_.advance_to(i + 1);
        });
    for (std::size_t f = 0; f < kTileFormats; ++f) {
      if (totals_[f].files == 0) continue;
      std::string how(kFormats[f].checked);
      if (f == static_cast<std::size_t>(Format::gltf) && record_.lod == 3 && record_.baked)
        how += ", LoD3 not compared: elements are baked in";
      else if (f == static_cast<std::size_t>(Format::gltf) && record_.lean_citygml && record_.has("citygml") &&
               !record_.has("cityjson"))
        how += ", LoD3 not compared: CityGML is lean";
      if (f == static_cast<std::size_t>(Format::citygml) && schema_) how += ", OGC schemas";
      checked(title(f), std::move(how), totals_[f].bodies, fmt::format("bodies in {} files", totals_[f].files));
    }
    if (geopackage_)
      checked("GeoPackage", "OGC and QGIS rules, every row against the other formats", geopackage_total_.bodies,
              "bodies in buildings.gpkg");
    if (index_) checked("explain/", "one record a building, with the values of the model", explained_, "records");
    if (validated_ > 0) checked("solids", "own checker and CGAL", validated_, "solids");
    if (pairs_ > 0) checked("parts", "no two of a building overlap", pairs_, "pairs whose boxes meet");
    if (!told_overlaps_.empty()) {
      constexpr std::size_t kShown = 10;
      std::string note =
          fmt::format("{} of parts overlap, and the report says so (PARTS_OVERLAP, OVERLAP_KEPT): ",
                      told_overlaps_.size() == 1 ? "1 pair" : fmt::format("{} pairs", told_overlaps_.size()));
      for (std::size_t i = 0; i < std::min(kShown, told_overlaps_.size()); ++i)
        note += (i > 0 ? "; " : "") + told_overlaps_[i];
      if (told_overlaps_.size() > kShown) note += "; …";
      v_.notes.push_back(std::move(note));
    }
    if (compared_ > 0)
      checked("content", "attributes, geometry and colours of one format against another", compared_,
              "pairs of bodies");
  }

  void check_surroundings() {
    const SurroundingsTotals all =
        validate::check_surroundings(o_.folder, record_, o_.sample, schema_.get(),
                                     record_.has("gltf") ? &tileset_ : nullptr, workers_, progress_, log());
    if (all.files == 0) return;
    checked("surroundings", schema_ ? "ids given once, references, OGC schemas" : "ids given once, references",
            all.objects, fmt::format("objects in {} files", all.files));
  }

  static TileResult checked_tile(const TileFiles& files, const TileContext& context) {
    try {
      return check_tile(files, context);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      // Nothing in a file may end the run.
      TileResult failed;
      const auto path =
          std::find_if(std::begin(files.path), std::end(files.path), [](const std::string& p) { return !p.empty(); });
      failed.findings.push_back(
          {Check::file_unreadable, *path, files.name, std::string("the tile cannot be checked: ") + error.what()});
      for (FormatCounts& c : failed.counts) c.incomplete = true;
      return failed;
    }
  }

  TileContext context() {
    return {.folder = o_.folder,
            .record = record_,
            .tileset = record_.has("gltf") ? &tileset_ : nullptr,
            .schema = schema_.get(),
            .sample = sample_,
            .proj_transform = pinned_ ? &*pinned_ : nullptr,
            .positions = positions_,
            .geoid = geoid_,
            .overlapping = report_ ? &report_->overlapping : nullptr,
            .geopackage = geopackage_.get(),
            .explanations = index_ ? &*index_ : nullptr,
            .places = places_ ? &*places_ : nullptr};
  }

  void take(TileResult&& tile) {
    log().add(std::move(tile.findings));
    for (std::size_t f = 0; f < kTileFormats; ++f) {
      totals_[f].add(tile.counts[f]);
      std::move(tile.digests[f].begin(), tile.digests[f].end(), std::back_inserter(digests_[f]));
      for (std::string& id : tile.ids[f])
        if (!ids_[f].insert(std::hash<std::string>{}(id)).second && tile.counts[f].files > 0)
          log().add(Check::object_doubled, title(f), id, "the body stands in two tiles");
    }
    geopackage_total_.add(tile.geopackage);
    explained_ += tile.explained;
    for (std::string& id : tile.buildings) buildings_.insert(std::move(id));
    validated_ += tile.validated;
    pairs_ += tile.pairs;
    std::move(tile.told_overlaps.begin(), tile.told_overlaps.end(), std::back_inserter(told_overlaps_));
    compared_ += tile.compared;
    positions_found_.insert(positions_found_.end(), std::make_move_iterator(tile.positions.begin()),
                            std::make_move_iterator(tile.positions.end()));
    for (const auto& [attribute, sources] : tile.sources)
      for (const auto& [source, count] : sources) sources_[attribute][source] += count;
    for (const auto& [roof, count] : tile.roofs) roofs_[roof] += count;
    if (report_)
      for (const std::string& id : tile.modelled) {
        const auto state = report_->states.find(id);
        if (state != report_->states.end())
          log().add(Check::report_wrong, "report.json", id, "is " + state->second + " there, but stands in the model");
      }
  }

  void check_single_files() {
    if (record_.files.count("model.glb") && fs::exists(full("model.glb"))) {
      progress_.begin("model.glb");
      TileResult r = check_single_glb("model.glb", context());
      log().add(std::move(r.findings));
      checked("model.glb", "glTF 2.0, property table, georeference, solids, against the tiles", r.counts[0].bodies,
              "bodies");
      positions_found_.insert(positions_found_.end(), std::make_move_iterator(r.positions.begin()),
                              std::make_move_iterator(r.positions.end()));
      if (!r.counts[0].incomplete) compare_whole("model.glb", Format::gltf, r.digests[0]);
    }
    if (record_.files.count("model.city.json")) {
      progress_.begin("model.city.json");
      if (const auto text = file_bytes(full("model.city.json"))) {
        Contents contents = read_cityjson(*text, "model.city.json");
        const bool unreadable = std::any_of(contents.findings.begin(), contents.findings.end(),
                                            [](const Finding& f) { return f.check == Check::file_unreadable; });
        log().add(std::move(contents.findings));
        checked("model.city.json", "rules of CityJSON 2.0, against the tiles", contents.bodies.size(), "bodies");
        BodyDigests digests;
        for (const ReadBody& body : contents.bodies) digests.emplace_back(body.id, digest(body));
        if (!unreadable) compare_whole("model.city.json", Format::cityjson, digests);
      }
    }
    if (record_.files.count("report.html")) {
      progress_.begin("report.html");
      const bool all =
          o_.sample <= 1 &&
          std::none_of(std::begin(totals_), std::end(totals_), [](const FormatCounts& n) { return n.incomplete; }) &&
          !buildings_.empty();
      const std::uint64_t compared = check_report_page(o_.folder, record_, all ? &buildings_ : nullptr, log());
      checked("report.html", "well-formed, loads nothing, against build.json and the model", compared,
              "numbers and footprints");
    }
  }

  /// A file of the whole build against what the tiles of the format hold.
  void compare_whole(const std::string& file, Format format, const BodyDigests& bodies) {
    const auto f = static_cast<std::size_t>(format);
    if (o_.sample > 1 || totals_[f].incomplete) return;
    if (totals_[f].files == 0) {
      if (const auto said = record_.count("bodies"); said && *said != bodies.size())
        log().add(Check::counts_differ, file, "", fmt::format("{} bodies, build.json says {}", bodies.size(), *said));
      return;
    }
    std::vector<Finding> findings;
    compare_digests(digests_[f], title(f), bodies, file, findings);
    log().add(std::move(findings));
  }

  // ---- counts

  void check_counts() {
    if (o_.sample > 1) {
      v_.notes.push_back(fmt::format("only every {}th tile was read: counts were not compared", o_.sample));
      return;
    }
    const auto expect = [&](const std::string& what, std::uint64_t is, const char* key) {
      const auto said = record_.count(key);
      if (said && *said != is)
        log().add(Check::counts_differ, "build.json", std::string("counts.") + key,
                  fmt::format("{} in the file, {} {}", *said, is, what));
    };
    bool any = false;
    for (std::size_t f = 0; f < kTileFormats; ++f) {
      const FormatCounts& n = totals_[f];
      if (!record_.has(kFormats[f].key) || n.incomplete) continue;
      any = true;
      expect("objects shown in " + title(f), n.models, "models");
      if (f == static_cast<std::size_t>(Format::gltf)) continue;
      expect("buildings in " + title(f), n.buildings, "buildings");
      expect("bodies in " + title(f), n.bodies, "bodies");
      expect("solids of LoD 1 in " + title(f), n.solids[1], "solids_lod1");
      expect("solids of LoD 2 in " + title(f), n.solids[2], "solids_lod2");
      expect("solids of LoD 3 in " + title(f), n.solids[3], "solids_lod3");
      expect("windows in " + title(f), n.windows, "windows");
      expect("doors in " + title(f), n.doors, "doors");
      // Lean CityGML has none in openings; what it has is compared with CityJSON element by element.
      const bool lean = f == static_cast<std::size_t>(Format::citygml) && record_.lean_citygml;
      if (!lean || n.placements > record_.count("placements").value_or(0))
        expect("placed elements in " + title(f), n.placements, "placements");
      expect("installations in " + title(f), n.installations, "installations");
    }
    if (geopackage_) expect("bodies in buildings.gpkg", geopackage_total_.bodies, "bodies");
    if (any) check_statistics();
    if (any)
      checked("counts", "build.json, report.json and every format, to the last building",
              record_.count("models").value_or(0), "models");
  }

  void check_statistics() {
    const Json* statistics = member(record_.json, "statistics");
    const auto compare = [&](const Json* said, const std::map<std::string, std::uint64_t>& is,
                             const std::string& where) {
      std::map<std::string, std::uint64_t> there, all = is;
      if (said && said->is_object())
        for (const auto& [name, count] : said->items()) there[name] = whole(&count).value_or(0);
      all.insert(there.begin(), there.end());
      for (const auto& [name, count] : all) {
        const std::map<std::string, std::uint64_t>::const_iterator a = there.find(name), b = is.find(name);
        const std::uint64_t x = a == there.end() ? 0 : a->second, y = b == is.end() ? 0 : b->second;
        if (x != y)
          log().add(Check::counts_differ, "build.json", where + "." + name,
                    fmt::format("{} in the file, {} bodies in the model", x, y));
      }
    };
    compare(member(statistics, "roofs"), roofs_, "statistics.roofs");
    const Json* sources = member(statistics, "sources");
    for (const auto& [attribute, counts] : sources_)
      compare(member(sources, attribute), counts, "statistics.sources." + attribute);
  }

  // ---- positions

  void check_positions() {
    std::sort(positions_found_.begin(), positions_found_.end(), [](const PositionResult& a, const PositionResult& b) {
      return a.rank != b.rank ? a.rank < b.rank : a.object < b.object;
    });
    // model.glb shows the same corners once more.
    std::uint64_t last = 0;
    std::size_t different = 0;
    std::vector<std::pair<std::string, model::Point2>> offsets[kTileFormats];
    for (const PositionResult& p : positions_found_) {
      if (different == 0 || p.rank != last) {
        if (different == kPositions) break;
        ++different;
      }
      last = p.rank;
      for (std::size_t f = 0; f < kTileFormats; ++f) {
        if (p.off[f] < 0) continue;
        double& worst = p.moved                                       ? v_.worst_moved
                        : f == static_cast<std::size_t>(Format::gltf) ? v_.worst_glb
                                                                      : v_.worst_crs;
        worst = std::max(worst, p.off[f]);
        if (p.off[f] > p.tolerance[f])
          log().add(
              Check::position, p.file[f], p.object,
              fmt::format("the nearest corner is {:.4f} m from where OpenStreetMap has one{}", p.off[f],
                          p.moved ? fmt::format(", and repair says {:.3f} m at most", p.tolerance[f] - kMillimetre)
                                  : std::string()));
        offsets[f].emplace_back(p.object, p.offset[f]);
      }
      v_.positions_moved += p.moved;
    }
    for (std::size_t f = 0; f < kTileFormats; ++f) check_common_shift(offsets[f], static_cast<Format>(f));
    v_.positions = different;
    if (different == 0) return;
    v_.position_source = sample_.source;
    checked("positions", "against " + sample_.source + ", through PROJ", different, "corners");
  }

  /// Corners that repair moved say little each; together they say whether the whole model was moved.
  void check_common_shift(std::vector<std::pair<std::string, model::Point2>>& offsets, Format format) {
    std::stable_sort(offsets.begin(), offsets.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const CommonShift shift = common_shift(offsets);
    const double off = std::hypot(shift.median.x, shift.median.y);
    v_.worst_median = std::max(v_.worst_median, off);
    if (shift.buildings < kLeastBuildings) return;
    if (off > kCommonShift + shift.uncertainty)
      log().add(
          Check::position, std::string(kFormats[static_cast<std::size_t>(format)].file), "",
          fmt::format("the corners of {} buildings lie {:.3f} m east and {:.3f} m north of where OpenStreetMap has "
                      "them, in the median: the whole model was moved",
                      shift.buildings, shift.median.x, shift.median.y));
  }

  const ValidateOptions& o_;
  base::Progress& progress_;
  int workers_;
  Validation v_;
  bool unreadable_ = false;
  BuildRecord record_;
  Tileset tileset_;
  std::optional<Report> report_;
  std::unique_ptr<CityGmlSchema> schema_;
  PositionSample sample_;
  std::optional<georef::ProjTransformPool> pinned_;
  georef::ProjTransformPool* positions_ = nullptr;
  georef::Geoid geoid_;
  std::unique_ptr<GeoPackageReader> geopackage_;
  std::optional<ExplanationIndex> index_;
  std::optional<ExplainedPlaces> places_;
  FormatCounts totals_[kTileFormats], geopackage_total_;
  std::set<std::string> buildings_;
  std::uint64_t explained_ = 0;
  BodyDigests digests_[kTileFormats];
  std::unordered_set<std::size_t>
      ids_[kTileFormats];  ///< hashes: a city's ids as texts would take the memory of a tile
  std::uint64_t validated_ = 0, compared_ = 0, pairs_ = 0;
  std::vector<std::string> told_overlaps_;
  std::map<std::string, std::map<std::string, std::uint64_t>> sources_;
  std::map<std::string, std::uint64_t> roofs_;
  std::vector<PositionResult> positions_found_;
};

}  // namespace

Validation validate(const ValidateOptions& options, base::Progress& progress) {
  if (is_in_areas(options.folder)) return validate_areas(options, progress);
  return Run(options, progress).run();
}

}  // namespace blockrand::validate
