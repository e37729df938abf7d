// What the runs of a region write down for the next ones: the data of each build, a line for each run.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "pipeline/base/progress.h"
#include "pipeline/run/region_folder.h"

namespace blockrand::run {

/// An object; an empty one where the file is missing or damaged.
nlohmann::ordered_json read_json(const std::string& path);
/// Empty where there is no such text.
std::string text_in(const nlohmann::ordered_json& j, const char* key);
/// With a newline. Texts of others, as names of files, may not be UTF-8.
std::string dumped(const nlohmann::ordered_json& j, int indent = -1);

/// What is known of the data of a build: `store/N.json`.
struct DataState {
  std::string sha256, settings;           ///< of the data's file; of what is built from it (settings_sha256())
  std::optional<std::uint64_t> sequence;  ///< of the newest change file in it
  std::string time;                       ///< ISO 8601, of that change file, where its state file says it; or empty
  std::string input;                      ///< the input of region.toml when it was last taken: path, size, time
  int areas = 0;                ///< level of the areas that it is built in (BuildOptions::areas); 0: all at once
  bool crs_chosen = false;      ///< by the program, not by region.toml
  std::optional<int> replaced;  ///< the build that was published before

  static DataState of(const nlohmann::ordered_json& j);
  static DataState read(const std::string& path) { return of(read_json(path)); }
  nlohmann::ordered_json json() const;
  /// \throws base::OutputError
  void write(const std::string& path) const;
};

/// "2026-11-26T03:00:00Z"
std::string now_utc();

/// One line for each run. A line that cannot be written fails nothing: the run is done.
void append_run(const RegionFolder& region, const nlohmann::ordered_json& line, base::Progress& progress);

}  // namespace blockrand::run
