#include "pipeline/run/output_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/side_files.h"
#include "pipeline/base/text.h"
#include "pipeline/outputs/area_folders.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The build.json of a folder; null where there is none, or it is none.
Json record_of(const std::string& folder) {
  std::ifstream file(fs::path(folder) / "build.json", std::ios::binary);
  return file ? Json::parse(file, nullptr, false) : Json();
}

}  // namespace

std::vector<std::string> foreign_files(const std::string& folder) {
  std::set<std::string> ours = {"build.json", "run.json"};
  const Json record = record_of(folder);
  if (record.is_object() && record.contains("files") && record["files"].is_object())
    for (const auto& [path, entry] : record["files"].items()) ours.insert(path);
  for (const std::string& area : outputs::area_folders(folder)) {
    ours.insert(area + "/build.json"), ours.insert(area + "/run.json");
    const Json its = record_of(folder + "/" + area);
    if (its.is_object() && its.contains("files") && its["files"].is_object())
      for (const auto& [path, entry] : its["files"].items()) ours.insert(area + "/" + path);
  }
  return files_other_than(ours, folder);
}

std::vector<std::string> files_other_than(const std::set<std::string>& ours, const std::string& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_directory(error) && !entry->is_symlink(error)) continue;
    const std::string path = entry->path().lexically_relative(folder).generic_string();
    if (!ours.contains(path) && !base::is_side_file(path)) out.push_back(path);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<std::uint64_t> earlier_models(const std::string& folder) {
  const Json record = record_of(folder);
  if (!record.is_object() || !record.contains("counts")) return std::nullopt;
  const Json& counts = record["counts"];
  if (!counts.is_object() || !counts.contains("models") || !counts["models"].is_number_unsigned()) return std::nullopt;
  return counts["models"].get<std::uint64_t>();
}

void refuse_shrunk(const BuildOptions& options, const BuildSummary& summary, std::optional<std::uint64_t> earlier) {
  if (!earlier || *earlier == 0) return;
  const std::string stays = " The earlier build stays as it was. Check the extract and --bbox, or add ";
  if (summary.models == 0) {
    if (!options.allow_empty)
      throw base::InputError(
          options.output, "",
          fmt::format("the new build has no models, the one it would replace has {}", base::with_thousands(*earlier)),
          stays.substr(1) + "--allow-empty.");
    return;
  }
  const double lost = 100 * (1 - static_cast<double>(summary.models) / static_cast<double>(*earlier));
  if (lost > options.allow_shrink)
    throw base::InputError(
        options.output, "",
        fmt::format("the new build has {} models, {:.1f} % fewer than the {} of the one it would "
                    "replace; {:g} % are allowed",
                    base::with_thousands(summary.models), lost, base::with_thousands(*earlier), options.allow_shrink),
        stays.substr(1) + fmt::format("--allow-shrink {:.0f}.", std::min(100.0, std::ceil(lost))));
}

void check_free_space(const BuildOptions& options, std::uint64_t bytes, std::uint64_t free) {
  const std::uint64_t wanted = bytes + bytes / 4 + 1'000'000;
  if (wanted > free)
    throw base::OutputError(fmt::format(
        "{}: about {} needed, {} free. Free some space, choose another disk with -o, fewer --formats or --gzip",
        options.output, base::with_byte_unit(wanted), base::with_byte_unit(free)));
}

}  // namespace blockrand::run
