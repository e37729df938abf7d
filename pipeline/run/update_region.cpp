#include "pipeline/run/update_region.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "importers/osm/apply_changes.h"
#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/replication.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using importers::osm::AppliedChanges;
using importers::osm::ReplicationState;

Json read_json(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Json j = file ? Json::parse(file, nullptr, false) : Json();
  return j.is_object() ? j : Json::object();
}

std::string text_in(const Json& j, const char* key) {
  return j.contains(key) && j[key].is_string() ? j[key].get<std::string>() : std::string();
}

/// What is known of the data of a build: `store/N.json`.
struct DataState {
  std::string sha256, settings;           ///< of the data's file; of what is built from it (settings_sha256())
  std::optional<std::uint64_t> sequence;  ///< of the newest change file in it
  std::string time;                       ///< of that file

  static DataState read(const std::string& path) {
    const Json j = read_json(path);
    DataState state{text_in(j, "data_sha256"), text_in(j, "settings_sha256"), std::nullopt, text_in(j, "time")};
    if (j.contains("sequence") && j["sequence"].is_number_unsigned())
      state.sequence = j["sequence"].get<std::uint64_t>();
    return state;
  }
  void write(const std::string& path) const {
    const Json j = {{"data_sha256", sha256},
                    {"settings_sha256", settings},
                    {"sequence", sequence ? Json(*sequence) : Json()},
                    {"time", time}};
    write_whole(path, j.dump(1) + "\n");
  }
};

/// Everything but the data that a build hangs on: settings, program, files of rules and styles, size and time of rasters.
std::string settings_sha256(const UpdateOptions& options, const RegionFolder& region) {
  base::Sha256 hash;
  const auto add = [&](std::string_view text) { hash.add(std::to_string(text.size()) + ":" + std::string(text)); };
  add(options.version);
  std::error_code error;
  if (fs::is_regular_file(region.settings(), error)) add(base::sha256_file(region.settings()));
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator entry(options.build.configs, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->is_regular_file(error)) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  for (const fs::path& path : files)
    add(path.lexically_relative(options.build.configs).string()), add(base::sha256_file(path.string()));
  if (!options.build.overrides.empty()) add(base::sha256_file(options.build.overrides));
  std::vector<std::string> rasters{options.build.terrain, options.build.districts};
  for (const importers::imagery::ImageSource& image : options.build.imagery.images) rasters.push_back(image.path);
  for (const std::string& path : rasters) {
    add(path);
    if (path.empty() || !fs::is_regular_file(path, error)) continue;
    add(std::to_string(fs::file_size(path, error)));
    add(std::to_string(fs::last_write_time(path, error).time_since_epoch().count()));
  }
  return hash.finish();
}

/// Where the next data come from.
struct Plan {
  std::string extract;               ///< a full one; empty: the data in the store
  std::vector<std::string> changes;  ///< change files, in their order
  ReplicationState replication;      ///< after them
  std::vector<std::string> why;
};

Plan plan_of(const UpdateOptions& options, const RegionFolder& region, std::optional<int> current,
             const DataState& state) {
  Plan plan;
  for (const std::string& input : options.inputs) {
    if (importers::osm::is_change_file(input)) {
      plan.changes.push_back(input);
    } else if (!plan.extract.empty() || !plan.changes.empty()) {
      throw base::UsageError(input + ": one extract can be given, before all change files (.osc, .osc.gz, .osc.bz2).");
    } else {
      plan.extract = input;
    }
  }
  if (options.inputs.empty() && options.region.replication.empty()) plan.extract = options.build.input;
  if (!current && plan.extract.empty()) plan.extract = options.build.input;
  if (!current && plan.extract.empty())
    throw base::UsageError(region.path() + " has no data yet. Begin with an extract: blockrand update " +
                           region.path() + " EXTRACT.osm.pbf");
  plan.replication = {state.sequence, state.time};
  if (!plan.extract.empty()) {
    plan.replication = importers::osm::replication_state(plan.extract);
    plan.why.push_back("a full extract: " + plan.extract);
  }
  if (options.inputs.empty() && !options.region.replication.empty()) {
    std::optional<std::uint64_t> from;
    if (plan.replication.sequence) from = *plan.replication.sequence + 1;
    if (!from && options.region.first_sequence >= 0) from = static_cast<std::uint64_t>(options.region.first_sequence);
    if (!from)
      throw base::InputError(region.settings(), "[region]",
                             "the extract does not say after which change file it was made",
                             "Set first_sequence to the number of the first one to apply");
    for (const ReplicationFile& file : replication_files(options.region.replication, *from)) {
      plan.changes.push_back(file.path);
      plan.replication = {file.sequence, file.time};
    }
  } else if (!plan.changes.empty()) {
    plan.replication.time.clear();  // files that are named one by one: the newest object tells
  }
  if (!plan.changes.empty())
    plan.why.push_back(plan.changes.size() == 1
                           ? "a change file: " + plan.changes.front()
                           : fmt::format("{} change files, the last one {}", plan.changes.size(), plan.changes.back()));
  return plan;
}

/// A file that is gone with the object, unless it is kept.
struct Scratch {
  explicit Scratch(std::string p) : path(std::move(p)) {}
  ~Scratch() {
    std::error_code error;
    if (!path.empty()) fs::remove(path, error);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string path;
};

bool same_bytes(const std::string& a, const std::string& b) {
  std::ifstream x(a, std::ios::binary), y(b, std::ios::binary);
  std::string p(1 << 16, '\0'), q(1 << 16, '\0');
  while (x && y) {
    x.read(p.data(), static_cast<std::streamsize>(p.size())), y.read(q.data(), static_cast<std::streamsize>(q.size()));
    if (x.gcount() != y.gcount() || std::memcmp(p.data(), q.data(), static_cast<std::size_t>(x.gcount())) != 0)
      return false;
  }
  return x.eof() && y.eof();
}

/// Files that both builds have become one on disk.
void link_unchanged(const std::string& before, const std::string& after, UpdateSummary& summary) {
  const Json old = read_json(before + "/build.json"), now = read_json(after + "/build.json");
  if (!old.contains("files") || !now.contains("files")) return;
  for (const auto& [path, entry] : now["files"].items()) {
    if (!old["files"].contains(path) || old["files"][path] != entry) continue;
    const std::string from = before + "/" + path, to = after + "/" + path, link = to + ".link";
    // A disk may have lost what the record says: bytes are compared, not hashes.
    if (!same_bytes(from, to)) continue;
    ::unlink(link.c_str());
    if (::link(from.c_str(), link.c_str()) != 0) continue;  // another disk, too many links: two files, then
    if (::rename(link.c_str(), to.c_str()) != 0) {
      ::unlink(link.c_str());
      continue;
    }
    ++summary.linked;
    if (entry.contains("bytes")) summary.linked_bytes += entry["bytes"].get<std::uint64_t>();
  }
}

std::string_view word(UpdateState state) {
  switch (state) {
    case UpdateState::published:
      return "published";
    case UpdateState::unchanged:
      return "unchanged";
    case UpdateState::refused:
      return "refused";
    case UpdateState::planned:
      return "planned";
  }
  return "";
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

Json run_line(const UpdateSummary& s) {
  Json j = {
      {"run", s.number}, {"ended", now_utc()}, {"state", word(s.state)}, {"seconds", std::round(s.seconds * 10) / 10}};
  j["why"] = s.why;
  if (s.sequence) j["sequence"] = *s.sequence;
  j["osm_objects"] = {{"created", s.created}, {"modified", s.modified}, {"deleted", s.deleted}};
  j["buildings"] = {{"before", s.changes.before},
                    {"after", s.changes.after},
                    {"added", s.changes.added.size()},
                    {"removed", s.changes.removed.size()}};
  for (const Gate& g : s.gates)
    if (g.exceeded()) j["refused_by"].push_back(g.key);
  return j;
}

/// One line for each run. A line that cannot be written fails nothing: the run is done.
void append_run(const RegionFolder& region, const Json& line, base::Progress& progress) {
  const std::string path = region.path() + "/log/runs.jsonl", text = line.dump() + "\n";
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const bool written =
      descriptor >= 0 && ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (descriptor >= 0) ::close(descriptor);
  if (!written) progress.warn(path + ": cannot be written: " + std::strerror(errno));
}

void write_changes(const RegionFolder& region, int number, const UpdateSummary& summary) {
  write_whole(region.changes(number) + ".json", changes_json(summary.changes, summary.gates));
  write_whole(region.changes(number) + ".html",
              changes_page(region.name() + ", run " + std::to_string(number), summary.changes, summary.gates));
}

BuildOptions build_options_for(const UpdateOptions& options, const RegionFolder& region, int number,
                               std::optional<int> current) {
  BuildOptions build = options.build;
  build.name = region.name();
  build.input = region.data(number);
  build.output = region.build(number);
  build.force = false;
  // The first build chose; what comes in later must not choose anew.
  if (build.crs.empty() && current) {
    const Json record = read_json(region.build(*current) + "/build.json");
    if (record.contains("crs")) build.crs = text_in(record["crs"], "code");
  }
  return build;
}

class Updater {
 public:
  Updater(const UpdateOptions& options, const RegionFolder& region, base::Progress& progress)
      : options_(options), region_(region), progress_(progress) {}

  UpdateSummary run() {
    const auto start = std::chrono::steady_clock::now();
    const auto ended = [&](UpdateState state) {
      summary_.state = state;
      summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (state != UpdateState::planned) append_run(region_, run_line(summary_), progress_);
      return summary_;
    };
    const std::optional<int> current = region_.current();
    summary_.before = current;
    if (current) {
      before_ = DataState::read(region_.state(*current));
      if (!fs::exists(region_.log(*current))) write_whole(region_.log(*current), "{}\n");  // a run died just before it
      const Json last = read_json(region_.build(*current) + "/run.json");
      if (last.contains("seconds") && last["seconds"].is_number())
        summary_.expected_seconds = last["seconds"].get<double>();
    }
    const Plan plan = plan_of(options_, region_, current, before_);
    summary_.why = plan.why;
    summary_.sequence = plan.replication.sequence;
    DataState fresh{"", settings_sha256(options_, region_), plan.replication.sequence, plan.replication.time};
    const bool new_settings = current && fresh.settings != before_.settings;
    if (new_settings) summary_.why.emplace_back("region.toml, rules or the program differ from the published build's");
    summary_.number = region_.next();

    const bool nothing_came = current && plan.extract.empty() && plan.changes.empty();
    if (nothing_came && !new_settings) return stay(*current, plan, ended);
    Scratch data(region_.data(summary_.number) + ".part");
    const AppliedChanges applied = make_data(plan, current, data.path);
    fresh.sha256 = base::sha256_file(data.path);
    const bool same_data = current && (fresh.sha256 == before_.sha256 || (plan.extract.empty() && !applied.any()));
    if (same_data && !new_settings) return stay(*current, plan, ended);
    if (options_.dry_run) return ended(UpdateState::planned);

    if (std::rename(data.path.c_str(), region_.data(summary_.number).c_str()) != 0)
      throw base::OutputError(region_.data(summary_.number) + ": cannot be written: " + std::strerror(errno));
    data.path.clear();
    return build_and_publish(current, fresh, ended);
  }

 private:
  AppliedChanges make_data(const Plan& plan, std::optional<int> current, const std::string& path) {
    progress_.begin("apply changes");
    std::string base = plan.extract;
    if (base.empty()) {
      base = region_.data(*current);
      std::error_code error;
      if (!fs::is_regular_file(base, error) || base::sha256_file(base) != before_.sha256)
        throw base::InputError(base, "",
                               "is missing or damaged: the published build is whole, but changes need its data",
                               "Update from a full extract: blockrand update " + region_.path() + " EXTRACT.osm.pbf");
    }
    const AppliedChanges applied = importers::osm::apply_changes(base, plan.changes, path, plan.replication);
    summary_.created = applied.created, summary_.modified = applied.modified, summary_.deleted = applied.deleted;
    summary_.known = applied.known;
    return applied;
  }

  /// The published build stays; what is known of its data may go on.
  template <class Ended>
  UpdateSummary stay(int current, const Plan& plan, const Ended& ended) {
    summary_.number = current;
    summary_.folder = region_.build(current);
    if (!options_.dry_run && plan.replication.sequence && plan.replication.sequence != before_.sequence) {
      before_.sequence = plan.replication.sequence, before_.time = plan.replication.time;
      before_.write(region_.state(current));
    }
    return ended(UpdateState::unchanged);
  }

  template <class Ended>
  UpdateSummary build_and_publish(std::optional<int> current, const DataState& fresh, const Ended& ended) {
    const int number = summary_.number;
    const BuildSummary built = build(build_options_for(options_, region_, number, current), progress_);
    progress_.begin("compare builds");
    summary_.folder = region_.build(number);
    summary_.changes = compare_builds(current ? region_.build(*current) : "", region_.build(number));
    summary_.gates = gates_of(summary_.changes, options_.region, !current);
    if (!built.unaccounted.empty())
      summary_.gates.push_back(
          {"unaccounted", "objects that no stage decided on", static_cast<double>(built.unaccounted.size()), 0});
    if (std::ranges::any_of(summary_.gates, &Gate::exceeded)) {
      write_changes(region_, number, summary_);
      summary_.folder = region_.set_aside(number);
      return ended(UpdateState::refused);
    }
    if (current) link_unchanged(region_.build(*current), region_.build(number), summary_);
    fresh.write(region_.state(number));
    write_changes(region_, number, summary_);
    region_.publish(number);
    UpdateSummary done = ended(UpdateState::published);
    write_whole(region_.log(number), run_line(done).dump(1) + "\n");
    region_.prune(options_.region.keep);
    return done;
  }

  const UpdateOptions& options_;
  const RegionFolder& region_;
  base::Progress& progress_;
  UpdateSummary summary_;
  DataState before_;
};

}  // namespace

UpdateSummary update_region(const UpdateOptions& options, base::Progress& progress) {
  if (!options.build.outputs.explain)
    throw base::UsageError(
        "a region needs explanations, which its builds are compared by: take explain = false out of "
        "region.toml.");
  const RegionFolder region(options.folder);
  region.make();
  const RegionLock lock(region, options.break_lock, progress);
  for (const std::string& path : region.remove_unfinished())
    progress.warn("removed " + path + ": left by a run that was broken off");
  return Updater(options, region, progress).run();
}

RegionStatus region_status(const std::string& folder, const RegionOptions& options) {
  const RegionFolder region(folder);
  if (!region.exists())
    throw base::UsageError(folder + " is no region. 'blockrand update " + folder + " EXTRACT.osm.pbf' makes one.");
  RegionStatus status;
  status.current = region.current(), status.published = region.published();
  DataState state;
  if (status.current) {
    const Json record = read_json(region.build(*status.current) + "/build.json"),
               run = read_json(region.build(*status.current) + "/run.json");
    status.data_time = text_in(record, "data_time");
    if (record.contains("counts")) status.models = record["counts"].value("models", std::uint64_t{0});
    if (run.contains("seconds") && run["seconds"].is_number()) status.seconds = run["seconds"].get<double>();
    state = DataState::read(region.state(*status.current));
    status.sequence = state.sequence;
  }
  std::ifstream runs(folder + "/log/runs.jsonl", std::ios::binary);
  for (std::string line; std::getline(runs, line);)
    if (!line.empty()) status.last_run = line;
  if (!options.replication.empty() && (state.sequence || options.first_sequence >= 0)) try {
      const std::uint64_t from =
          state.sequence ? *state.sequence + 1 : static_cast<std::uint64_t>(options.first_sequence);
      for (const ReplicationFile& file : replication_files(options.replication, from))
        status.waiting.push_back(file.path);
    } catch (const base::InputError& error) {
      status.waiting_problem = error.what();
    }
  return status;
}

int roll_back(const std::string& folder, std::optional<int> to, bool break_lock, base::Progress& progress) {
  const RegionFolder region(folder);
  if (!region.exists()) throw base::UsageError(folder + " is no region.");
  const RegionLock lock(region, break_lock, progress);
  const std::vector<int> builds = region.published();
  std::error_code error;
  // A `current` that leads nowhere is a reason to go back, not an obstacle.
  std::optional<int> now;
  try {
    now = region.current();
  } catch (const base::InputError&) {
  }
  if (!to) {
    for (const int number : builds)
      if (!now || number < *now) to = number;
    if (!to) throw base::UsageError(folder + " has no earlier build to go back to.");
  }
  if (std::ranges::find(builds, *to) == builds.end() ||
      !fs::is_regular_file(region.build(*to) + "/build.json", error)) {
    std::string known;
    for (const int number : builds) known += (known.empty() ? "" : ", ") + std::to_string(number);
    throw base::UsageError(fmt::format("{} has no build {}. It has {}.", folder, *to, known.empty() ? "none" : known));
  }
  if (now && !fs::exists(region.log(*now), error)) write_whole(region.log(*now), "{}\n");
  region.publish(*to);
  append_run(region, {{"run", *to}, {"ended", now_utc()}, {"state", "rolled back"}}, progress);
  return *to;
}

}  // namespace blockrand::run
