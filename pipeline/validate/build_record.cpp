#include "pipeline/validate/build_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "pipeline/base/error.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/side_files.h"
#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/formats.h"

namespace blockrand::validate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "build.json";

bool is_digest(const std::string& s) {
  return s.size() == 64 && s.find_first_not_of("0123456789abcdef") == std::string::npos;
}

class Reader {
 public:
  Reader(BuildRecord& record, FindingLog& log) : r_(record), log_(log) {}

  void read() {
    const Json& j = r_.json;
    if (text(member(member(j, "program"), "name")) != "blockrand" ||
        text(member(member(j, "program"), "version")).empty())
      wrong("program", "is missing or is not blockrand");
    read_inputs();
    read_configuration();
    read_crs();
    read_counts();
    read_files();
  }

 private:
  void wrong(const std::string& where, const std::string& what) { log_.add(Check::build_json, kFile, where, what); }

  void read_inputs() {
    const Json* inputs = member(r_.json, "inputs");
    if (!inputs || !inputs->is_array() || inputs->empty()) return wrong("inputs", "missing");
    if (!is_digest(text(member(member(r_.json, "data"), "sha256")))) wrong("data", "no SHA-256 of the data");
    for (const Json& input : *inputs) {
      const std::string role = text(member(input, "role")), path = text(member(input, "path")),
                        digest = text(member(input, "sha256"));
      if (role.empty() || path.empty() || !whole(member(input, "bytes")) || !is_digest(digest))
        wrong("inputs", "an input without role, path, bytes or sha256");
    }
  }

  void read_configuration() {
    const Json* c = member(r_.json, "configuration");
    const auto lod = whole(member(c, "lod"));
    if (!lod || *lod > 3)
      wrong("configuration.lod", "is not 0, 1, 2 or 3");
    else
      r_.lod = static_cast<int>(*lod);
    const Json* formats = member(c, "formats");
    if (!formats || !formats->is_array())
      wrong("configuration.formats", "missing");
    else
      for (const Json& f : *formats) {
        const std::string name = text(&f);
        if (!is_format(name)) wrong("configuration.formats", "unknown format " + name);
        r_.formats.insert(name);
      }
    const std::string instancing = text(member(c, "instancing"));
    r_.baked = instancing == "baked";
    r_.single_objects = text(member(c, "objects")) == "building";
    const std::string attributes = text(member(c, "attributes"));
    if (member(c, "attributes") && attributes != "people" && attributes != "all")
      wrong("configuration.attributes", "is not people or all");
    r_.people = attributes == "people";
    r_.single_baked = r_.baked || (r_.single_objects && instancing != "nodes");
    const std::string detail = text(member(c, "citygml_detail"));
    if (member(c, "citygml_detail") && detail != "lean" && detail != "full")
      wrong("configuration.citygml_detail", "is not lean or full");
    r_.lean_citygml = r_.lod == 3 && detail == "lean";
    r_.gzip = is_true(member(c, "gzip"));
    r_.precompress = is_true(member(c, "precompress"));
    r_.single_glb = is_true(member(c, "single_glb"));
    r_.single_cityjson = is_true(member(c, "single_cityjson"));
    r_.report = is_true(member(c, "report"));
    r_.explain = is_true(member(c, "explain"));
  }

  void read_crs() {
    const Json* crs = member(r_.json, "crs");
    r_.crs = text(member(crs, "code"));
    r_.pipeline = text(member(crs, "pipeline"));
    r_.vertical_crs = text(member(crs, "vertical_crs"));
    r_.height_reference = text(member(crs, "height_reference"));
    r_.raised_from = text(member(member(crs, "to_ellipsoid"), "from"));
    r_.accuracy = number(member(crs, "accuracy_m")).value_or(0);
    if (!r_.crs.starts_with("EPSG:")) wrong("crs.code", "is no EPSG code");
    if (r_.pipeline.empty()) wrong("crs.pipeline", "missing");
    if (r_.height_reference.empty()) wrong("crs.height_reference", "missing");
    for (const char* key : {"round_trip_error_m", "frame_round_trip_error_m"})
      if (const auto error = number(member(crs, key)); !error || *error < 0 || *error >= 1e-3)
        wrong(fmt::format("crs.{}", key), "is missing or not below 1 mm");
  }

  void read_counts() {
    for (const char* key :
         {"buildings_in", "parts_in", "models", "represented", "reported", "represented_as_duplicates", "models_lod0",
          "models_lod1", "models_lod2", "models_lod3", "solids_lod1", "solids_lod2", "solids_lod3", "windows", "doors",
          "placements", "installations"})
      if (!r_.count(key)) wrong(fmt::format("counts.{}", key), "is missing or no count");
    const auto n = [&](const char* key) { return r_.count(key).value_or(0); };
    if (n("buildings_in") + n("parts_in") != n("models") + n("represented") + n("reported"))
      wrong("counts", fmt::format("{} buildings and {} parts in are not {} models, {} represented and {} reported",
                                  n("buildings_in"), n("parts_in"), n("models"), n("represented"), n("reported")));
    if (n("models") != n("models_lod0") + n("models_lod1") + n("models_lod2") + n("models_lod3"))
      wrong("counts", "models are not the sum over levels of detail");
    const Json* issues = member(r_.json, "issues");
    if (!issues || !issues->is_object()) wrong("issues", "missing");
  }

  void read_files() {
    const Json* files = member(r_.json, "files");
    if (!files || !files->is_object()) return wrong("files", "missing");
    for (const auto& [path, entry] : files->items()) {
      const auto bytes = whole(member(entry, "bytes"));
      const std::string digest = text(member(entry, "sha256"));
      if (path.empty() || path[0] == '/' || path.find("..") != std::string::npos) {
        wrong("files", "a path outside of the build: " + path);
        continue;
      }
      if (!bytes || !is_digest(digest)) wrong("files", path + " without size or hash");
      r_.files.emplace(path, BuildFile{bytes.value_or(0), digest});
    }
  }

  BuildRecord& r_;
  FindingLog& log_;
};

}  // namespace

std::optional<BuildRecord> read_build_record(const std::string& folder, FindingLog& log) {
  const auto bytes = file_bytes((fs::path(folder) / kFile).string());
  auto json = bytes ? parse_json(*bytes) : std::nullopt;
  if (!json || !json->is_object()) {
    log.add(Check::file_unreadable, kFile, "", "no JSON object");
    return std::nullopt;
  }
  BuildRecord record;
  record.json = std::move(*json);
  Reader(record, log).read();
  // By which file the data came differs from run to run: run.json has it. A build without it is one all the same.
  const auto run_bytes = file_bytes((fs::path(folder) / "run.json").string());
  const auto run = run_bytes ? parse_json(*run_bytes) : std::nullopt;
  if (const Json* inputs = run ? member(*run, "inputs") : nullptr; inputs && inputs->is_array())
    for (const Json& input : *inputs)
      if (text(member(input, "role")) == "extract")
        record.extract_path = text(member(input, "path")), record.extract_sha256 = text(member(input, "sha256"));
  return record;
}

std::vector<std::string> check_file_list(const std::string& folder, const BuildRecord& record, FindingLog& log) {
  std::set<std::string> there;
  std::error_code error;
  for (auto i = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
       !error && i != fs::recursive_directory_iterator(); i.increment(error)) {
    std::error_code ignored;
    if (i->is_directory(ignored)) continue;
    const std::string name = i->path().lexically_relative(folder).generic_string();
    if (name != kFile && name != "run.json") there.insert(name);
  }
  for (const auto& [path, file] : record.files)
    if (!there.count(path)) log.add(Check::file_missing, path, "", "listed in build.json");
  std::vector<std::string> beside;
  for (const std::string& path : there) {
    if (record.files.count(path)) continue;
    if (base::is_side_file(path))
      beside.push_back(path);
    else
      log.add(Check::file_unlisted, path, "", "not listed in build.json");
  }

  const auto any = [&](const std::string& folder_name, const std::string& end) {
    return std::any_of(record.files.begin(), record.files.end(),
                       [&](const auto& f) { return f.first.starts_with(folder_name) && f.first.ends_with(end); });
  };
  const auto agree = [&](bool asked, bool is, const std::string& what) {
    if (asked != is)
      log.add(Check::build_json, kFile, what,
              asked ? "the configuration asks for it, but no such file is listed"
                    : "listed, but the configuration does not ask for it");
  };
  agree(record.has("gltf"), record.files.count("tileset.json") > 0, "tileset.json");
  agree(record.has("gltf") && record.precompress, record.files.count("tileset.json.gz") > 0, "tileset.json.gz");
  agree(record.has("citygml"), any("citygml/", record.gzip ? ".gml.gz" : ".gml"), "citygml/");
  agree(record.has("cityjson"), any("cityjson/", record.gzip ? ".city.jsonl.gz" : ".city.jsonl"), "cityjson/");
  agree(record.has("gpkg"), record.files.count("buildings.gpkg") > 0, "buildings.gpkg");
  agree(record.has("gpkg"), record.files.count("buildings.qgz") > 0, "buildings.qgz");
  agree(record.single_glb, record.files.count("model.glb") > 0, "model.glb");
  agree(record.single_cityjson, record.files.count("model.city.json") > 0, "model.city.json");
  agree(record.report, record.files.count("report.html") > 0, "report.html");
  agree(true, record.files.count("report.json") > 0, "report.json");
  return beside;
}

std::uint64_t check_hashes(const std::string& folder, const BuildRecord& record, int workers, base::Progress& progress,
                           FindingLog& log) {
  const auto full = [&](const std::string& path) { return (fs::path(folder) / path).string(); };
  std::vector<std::pair<std::string, BuildFile>> files;
  std::error_code error;
  for (const auto& [path, file] : record.files)
    if (fs::exists(full(path), error)) files.emplace_back(path, file);
  progress.begin("hashes", files.size(), "files");
  std::vector<std::string> wrong(files.size());
  base::ordered_parallel(
      files.size(), workers, static_cast<std::size_t>(2 * workers + 2),
      [&](std::size_t i) {
        const auto& [path, file] = files[i];
        std::error_code failed;
        const auto size = fs::file_size(full(path), failed);
        if (failed || size != file.bytes) {
          wrong[i] = fmt::format("{} bytes, build.json says {}", failed ? 0 : size, file.bytes);
          return;
        }
        try {
          if (base::sha256_file(full(path)) != file.sha256) wrong[i] = "its SHA-256 is not that of build.json";
        } catch (const base::InputError&) {
          wrong[i] = "cannot be read";
        }
      },
      [&](std::size_t i) {
        if (!wrong[i].empty()) log.add(Check::file_changed, files[i].first, "", wrong[i]);
        progress.advance_to(i + 1);
      });
  return files.size();
}

}  // namespace blockrand::validate
