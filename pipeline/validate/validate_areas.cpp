#include "pipeline/validate/validate_areas.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/json_depth.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/side_files.h"
#include "pipeline/base/text.h"
#include "pipeline/validate/packed_files.h"

namespace blockrand::validate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Nothing of ours is nested as deep.
constexpr std::size_t kDeepest = 100;

/// Null for what is no JSON, or nested so deep that a walk would not end well.
Json json_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (base::json_depth(text) > kDeepest) return {};
  Json j = Json::parse(text, nullptr, false);
  return j.is_discarded() ? Json() : j;
}

bool is_area(const std::string& name) {
  return !name.empty() && name.find_first_not_of("0123456789/") == std::string::npos &&
         std::ranges::count(name, '/') == 2;
}

/// "bodies in 16 files" and "bodies in 8 files" are bodies in 24 files.
std::string added(const std::string& a, const std::string& b) {
  const auto number = [](const std::string& text, std::size_t& from, std::size_t& to) {
    from = text.find_first_of("0123456789"), to = text.find_first_not_of("0123456789,", from);
    std::uint64_t n = 0;
    for (std::size_t i = from; i < std::min(to, text.size()); ++i)
      if (text[i] != ',') n = 10 * n + static_cast<std::uint64_t>(text[i] - '0');
    return n;
  };
  std::size_t from = 0, to = 0;
  const std::uint64_t more = number(b, from, to);
  if (from == std::string::npos) return a;
  const std::uint64_t n = number(a, from, to);
  if (from == std::string::npos) return a;
  return a.substr(0, from) + base::with_thousands(n + more) + a.substr(std::min(to, a.size()));
}

class AreasRun {
 public:
  AreasRun(const ValidateOptions& options, base::Progress& progress)
      : options_(options), progress_(progress), record_(json_of(full("build.json"))) {}

  Validation run() {
    guarded("run.json", [&] { find_extract(); });
    for (const auto& [name, entry] : record_["areas"].items()) {
      if (!is_area(name)) {
        log().add(Check::build_json, "build.json", "areas." + name, "is no area");
        continue;
      }
      guarded("build.json", [&] { check_area(name, entry); });
    }
    guarded("build.json", [&] { check_files(); });
    guarded("tileset.json", [&] { check_tileset(); });
    guarded("build.json", [&] { check_sums(); });
    v_.checked.insert(v_.checked.begin(), {"areas", "each as a build of its own; hashes of their build.json, sums",
                                           record_["areas"].size(), "areas"});
    return std::move(v_);
  }

 private:
  FindingLog& log() { return v_.findings; }
  /// What has another type than it should is a finding.
  template <class Check_>
  void guarded(const char* file, Check_&& check) {
    try {
      check();
    } catch (const nlohmann::json::exception& error) {
      log().add(Check::file_unreadable, file, "", error.what());
    }
  }
  std::string full(const std::string& path) const { return options_.folder + "/" + path; }

  /// The file that the data came from: where it is what it was. An area that was taken over knows an older one.
  void find_extract() {
    const Json run = json_of(full("run.json"));
    std::string path, sha256;
    if (run.is_object() && run.contains("inputs") && run["inputs"].is_array())
      for (const Json& input : run["inputs"])
        if (input.is_object() && input.value("role", "") == "extract")
          path = input.value("path", ""), sha256 = input.value("sha256", "");
    std::error_code error;
    if (!options_.extract.empty()) {
      if (base::sha256_file(options_.extract) != sha256)
        throw base::UsageError("--extract " + options_.extract +
                               " is not the file that the build was made from: its SHA-256 differs.");
      of_area_.extract = options_.extract;
    } else if (!path.empty() && fs::is_regular_file(path, error) && base::sha256_file(path) == sha256) {
      of_area_.extract = path;
    }
    of_area_.extract_is_known = !of_area_.extract.empty();
  }

  void check_area(const std::string& name, const Json& entry) {
    const std::string path = "areas/" + name;
    std::error_code error;
    if (!fs::is_regular_file(full(path + "/build.json"), error)) {
      log().add(Check::file_missing, path + "/build.json", "", "named by build.json, but not there");
      return;
    }
    if (base::sha256_file(full(path + "/build.json")) != entry.value("build_sha256", ""))
      log().add(Check::file_changed, path + "/build.json", "", "its SHA-256 differs from build.json");
    of_area_.folder = full(path);
    Validation area = validate(of_area_, progress_);
    FindingLog prefixed;
    for (const Finding& f : area.findings.kept()) {
      Finding named = f;
      named.file = path + "/" + f.file;
      prefixed.add(std::move(named));
    }
    // Those that were only counted.
    for (std::size_t c = 0; c < kCheckCount; ++c) {
      const auto check = static_cast<Check>(c);
      for (std::uint64_t n = prefixed.count(check); n < area.findings.count(check); ++n)
        prefixed.add(check, path, "", "one more of these");
    }
    log().append(std::move(prefixed));
    for (Checked& c : area.checked) {
      const auto same =
          std::ranges::find_if(v_.checked, [&](const Checked& k) { return k.what == c.what && k.how == c.how; });
      if (same == v_.checked.end()) {
        v_.checked.push_back(std::move(c));
      } else {
        same->count += c.count;
        same->unit = added(same->unit, c.unit);
      }
    }
    for (std::string& note : area.notes)
      if (std::ranges::find(v_.notes, note) == v_.notes.end()) v_.notes.push_back(std::move(note));
    if (!area.position_source.empty()) v_.position_source = std::move(area.position_source);
    v_.positions += area.positions, v_.positions_moved += area.positions_moved;
    for (double Validation::*worst :
         {&Validation::worst_glb, &Validation::worst_crs, &Validation::worst_moved, &Validation::worst_median})
      v_.*worst = std::max(v_.*worst, area.*worst);
    const Json its = json_of(full(path + "/build.json"));
    if (its.contains("counts"))
      for (const auto& [key, n] : its["counts"].items())
        if (n.is_number_unsigned()) sums_[key] += n.get<std::uint64_t>();
  }

  /// Documents of the whole; nothing else beside them and the areas.
  void check_files() {
    const Json& files = record_["files"];
    for (const auto& [path, entry] : files.items()) {
      std::error_code error;
      if (path.find("..") != std::string::npos || !fs::is_regular_file(full(path), error)) {
        log().add(Check::file_missing, path, "", "listed in build.json, but not there");
        continue;
      }
      if (fs::file_size(full(path), error) != entry.value("bytes", std::uint64_t{0}) ||
          base::sha256_file(full(path)) != entry.value("sha256", ""))
        log().add(Check::file_changed, path, "", "its size or SHA-256 differs from build.json");
    }
    std::vector<std::string> names;
    for (const auto& [path, entry] : files.items()) names.push_back(path);
    check_packed_beside(options_.folder, names, log());
    std::error_code error;
    for (fs::recursive_directory_iterator at(options_.folder, error), end; !error && at != end; at.increment(error)) {
      const std::string path = at->path().lexically_relative(options_.folder).generic_string();
      if (at->is_directory(error) && !at->is_symlink(error)) {
        // What lies in an area is checked with it.
        if (path.starts_with("areas/") && record_["areas"].contains(path.substr(6))) at.disable_recursion_pending();
        continue;
      }
      if (path != "build.json" && path != "run.json" && !files.contains(path) && !base::is_side_file(path))
        log().add(Check::file_unlisted, path, "", "is not listed in build.json");
    }
  }

  /// Every area's tileset is reached once, in a volume that holds it, by errors that fall.
  void check_tileset() {
    if (!record_["files"].contains("tileset.json")) return;
    const Json tileset = json_of(full("tileset.json"));
    if (!tileset.is_object() || !tileset.contains("root")) {
      log().add(Check::tileset_rule, "tileset.json", "", "is no tileset");
      return;
    }
    std::set<std::string> reached;
    // `file` is where the node stands: what it names is relative to that.
    const std::function<void(const std::string&, const Json&, double, const Json&)> visit =
        [&](const std::string& file, const Json& node, double above, const Json& around) {
          const auto found = [&](Check check, const std::string& object, std::string what) {
            log().add(check, file, object, std::move(what));
          };
          const double error = node.value("geometricError", -1.0);
          if (error < 0 || error > above)
            found(Check::tileset_rule, "", fmt::format("an error of {} m stands below one of {} m", error, above));
          const Json volume = node.value("boundingVolume", Json::object()).value("region", Json());
          if (volume.is_array() && volume.size() == 6 && around.is_array() && around.size() == 6)
            for (std::size_t i = 0; i < 6; ++i) {
              const double inner = volume[i].get<double>(), outer = around[i].get<double>();
              const bool low = i == 0 || i == 1 || i == 4;
              if (low ? inner < outer : inner > outer) {
                found(Check::tileset_rule, "", "a volume lies outside of the one above it");
                break;
              }
            }
          if (node.contains("content")) {
            const std::string uri =
                (fs::path(file).parent_path() / node["content"].value("uri", "")).lexically_normal().string();
            const bool fresh = reached.insert(uri).second;
            if (!fresh) found(Check::tileset_rule, uri, "is named twice");
            const Json its = uri.starts_with("..") || uri.starts_with("/") ? Json() : json_of(full(uri));
            if (!its.is_object() || !its.contains("root")) {
              found(Check::tile_missing, uri, "named by the tileset, but no tileset is there");
            } else if (its["root"].value("boundingVolume", Json::object()).value("region", Json()) != volume ||
                       its["root"].value("geometricError", -1.0) != error) {
              found(Check::tileset_rule, uri, "volume or error differ from those of its root");
            } else if (fresh && uri.starts_with("tilesets/")) {
              visit(uri, its["root"], error, volume);
            }
          }
          if (node.contains("children"))
            for (const Json& child : node["children"]) visit(file, child, error, volume);
        };
    visit("tileset.json", tileset["root"], tileset.value("geometricError", 0.0), Json());
    for (const auto& [name, entry] : record_["areas"].items()) {
      const std::string uri = "areas/" + name + "/tileset.json";
      const Json its = json_of(full(uri));
      const bool empty = its.is_object() && its.contains("root") && its["root"].contains("boundingVolume") &&
                         !its["root"]["boundingVolume"].contains("region");
      if (is_area(name) && !reached.contains(uri) && !empty)
        log().add(Check::tileset_rule, "tileset.json", uri, "is not reached");
    }
    v_.checked.push_back(
        {"tileset.json of the whole", "volumes and errors of the areas' tilesets", reached.size(), "tilesets"});
  }

  void check_sums() {
    if (!record_.contains("counts")) {
      log().add(Check::build_json, "build.json", "counts", "is missing");
      return;
    }
    for (const char* key : {"buildings_in", "parts_in", "models", "reported", "buildings", "bodies", "solids_lod1",
                            "solids_lod2", "solids_lod3"})
      if (record_["counts"].value(key, std::uint64_t{0}) != sums_[key])
        log().add(Check::counts_differ, "build.json", std::string("counts.") + key,
                  fmt::format("says {}, the areas say {}", record_["counts"].value(key, std::uint64_t{0}), sums_[key]));
  }

  const ValidateOptions& options_;
  ValidateOptions of_area_ = options_;
  base::Progress& progress_;
  Json record_;
  Validation v_;
  std::map<std::string, std::uint64_t> sums_;
};

}  // namespace

bool is_in_areas(const std::string& folder) {
  const Json record = json_of(folder + "/build.json");
  return record.is_object() && record.contains("areas") && record["areas"].is_object() && record.contains("files") &&
         record["files"].is_object();
}

Validation validate_areas(const ValidateOptions& options, base::Progress& progress) {
  return AreasRun(options, progress).run();
}

}  // namespace blockrand::validate
