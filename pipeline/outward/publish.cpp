#include "pipeline/outward/publish.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/outward/archive.h"
#include "pipeline/outward/build_files.h"
#include "pipeline/outward/part_file.h"
#include "pipeline/outward/postgis.h"
#include "pipeline/outward/send.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_state.h"

namespace blockrand::outward {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Files = std::map<std::string, BuildFile>;
using Figures = std::vector<std::pair<std::string, std::uint64_t>>;

/// One publishing of a source at a time. The kernel lets go of the lock of a process that is gone.
class NotesLock {
 public:
  explicit NotesLock(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    const std::string path = folder + "/lock";
    descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) throw base::OutputError(path + ": cannot be written: " + std::strerror(errno));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    const int reason = errno;
    ::close(descriptor_);
    if (reason == EWOULDBLOCK)
      throw base::UsageError(path + ": another publishing of this build is at work. Wait for it, or end it.");
    throw base::OutputError(path + ": cannot be locked: " + std::strerror(reason));
  }
  ~NotesLock() { ::close(descriptor_); }
  NotesLock(const NotesLock&) = delete;
  NotesLock& operator=(const NotesLock&) = delete;

 private:
  int descriptor_ = -1;
};

void check_target_name(const std::string& name) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  if (name.empty() || name.find_first_not_of(kAllowed) != std::string::npos)
    throw base::UsageError("--target '" + name + "' is no name of a target: write letters, digits, - and _.");
}

class Publisher {
 public:
  Publisher(const PublishOptions& options, const PublishSource& source, bool dry_run, base::Progress& progress)
      : options_(options), source_(source), dry_run_(dry_run), progress_(progress) {}

  PublishReport run() {
    if (!options_.command.empty()) part("command", options_.target, [this] { return by_command(); });
    if (!options_.web_root.empty()) part("web-root", absolute(options_.web_root), [this] { return into_folder(); });
    if (!options_.archive.empty()) part("archive", absolute(options_.archive), [this] { return into_archive(); });
    if (!options_.postgis.empty()) part("postgis", database_name(), [this] { return into_database(); });
    return std::move(report_);
  }

 private:
  void part(const char* what, const std::string& place, const std::function<Figures()>& work) {
    PublishedPart part{.what = what, .place = place, .figures = {}, .failure = {}};
    try {
      read_build();
      part.figures = work();
    } catch (const std::exception& error) {
      part.failure = error.what();
      if (!report_.first_failure) report_.first_failure = std::current_exception();
    }
    report_.parts.push_back(std::move(part));
  }

  /// What is wrong with it keeps all places from being brought to it, and is noted of each.
  void read_build() {
    check_target_name(options_.target);
    if (files_.empty()) files_ = files_of_build(source_.build);
  }

  static std::string absolute(const std::string& place) { return fs::absolute(place).lexically_normal().string(); }

  std::string database_name() const {
    const std::string name = without_password(options_.postgis);
    return options_.schema == PublishOptions().schema ? name : name + " schema " + options_.schema;
  }

  SendOptions send_options() const {
    return {.keep_deleted_hours = options_.keep_deleted, .batch = options_.batch, .gzip = options_.variants == "gzip"};
  }

  Figures send(const Target& target, TargetState& state) {
    if (options_.resend) state.forget();
    if (dry_run_) {
      settle_variants(state, send_options());
      const SendPlan plan = look_ahead(files_, state, send_options(), unix_time());
      return {{"files to send", plan.files},
              {"bytes", plan.bytes},
              {"files unchanged", plan.unchanged},
              {"files to remove", plan.remove.size()},
              {"files to remove later", plan.later.size()}};
    }
    const SendSummary s = send_build(source_.build, files_, target, state, send_options(), progress_);
    Figures figures{{"files sent", s.files}, {"bytes", s.bytes}, {"files unchanged", s.unchanged}};
    if (send_options().gzip) figures.emplace_back("variants", s.variants);
    if (s.found > 0) figures.emplace_back("files of a broken off run found whole", s.found);
    figures.emplace_back("files removed", s.removed);
    figures.emplace_back("files to remove later", s.later);
    return figures;
  }

  std::string note(const char* kind) const { return source_.notes + "/" + options_.target + "." + kind; }

  Figures by_command() {
    TargetState state(note("command.state"));
    if (dry_run_) return send({}, state);
    return send(command_target(source_.build, options_.command, options_.target, note("work")), state);
  }

  Figures into_folder() {
    TargetState state(note("web-root.state"));
    const Target target = folder_target(source_.build, options_.web_root);
    const std::string place = fs::weakly_canonical(fs::absolute(options_.web_root)).string();
    if (state.note("folder") != place) state.clear();  // of another web root
    state.set_note("folder", place);
    return send(target, state);
  }

  Figures into_archive() {
    refuse_own_folders("--archive", options_.archive);
    if (dry_run_) return {};
    const ArchiveSummary s = write_archive(source_.build, files_, options_.archive, progress_);
    return {{"files", s.files}, {"bytes", s.bytes}};
  }

  Figures into_database() {
    const PostgisBuild build{
        .folder = source_.build, .name = source_.name, .number = source_.number, .anew = options_.resend};
    const PostgisSummary s =
        publish_to_postgis({options_.postgis, options_.schema}, build, files_, dry_run_, progress_);
    return {{"GeoPackages read", s.read},       {"GeoPackages unchanged", s.unchanged}, {"tables made", s.tables_made},
            {"columns added", s.columns_added}, {"rows inserted", s.inserted},          {"rows deleted", s.deleted},
            {"rows unchanged", s.kept}};
  }

  const PublishOptions& options_;
  const PublishSource& source_;
  const bool dry_run_;
  base::Progress& progress_;
  Files files_;
  PublishReport report_;
};

Json part_note(const PublishSource& source, const PublishedPart& part) {
  Json entry = {{"what", part.what}, {"place", part.place}, {"ended", run::now_utc()}};
  entry["build"] = source.number ? Json(*source.number) : Json();
  entry["failure"] = part.failure.empty() ? Json() : Json(part.failure);
  for (const auto& [what, count] : part.figures) entry["figures"][what] = count;
  return entry;
}

/// Places that were not meant this time keep what is noted of them, unless `all` are those that were.
void note_report(const PublishSource& source, const PublishReport& report, bool all) {
  const std::string path = source.notes + "/last.json";
  const Json before = run::read_json(path);
  Json parts = Json::array();
  for (const PublishedPart& part : report.parts) parts.push_back(part_note(source, part));
  if (!all && before.contains("parts") && before["parts"].is_array())
    for (const Json& part : before["parts"]) {
      const bool again = std::ranges::any_of(report.parts, [&](const PublishedPart& now) {
        return now.what == run::text_in(part, "what") && now.place == run::text_in(part, "place");
      });
      if (!again) parts.push_back(part);
    }
  run::write_whole(path, run::dumped({{"parts", std::move(parts)}}, 1));
}

}  // namespace

PublishSource publish_source(const std::string& place) {
  std::error_code error;
  std::string path = fs::absolute(place).lexically_normal().string();
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  PublishSource source;
  if (fs::exists(path + "/build.json", error)) {
    source.build = path, source.name = fs::path(path).filename().string(), source.notes = path + ".outward";
    return source;
  }
  if (!fs::exists(path + "/region.toml", error))
    throw base::UsageError(place +
                           " is no region and no build: there is no region.toml and no build.json in it. Name "
                           "the folder of a region, or the output folder of a build.");
  const run::RegionFolder region(path);
  source.number = region.current();
  if (!source.number)
    throw base::UsageError(place + " has no published build yet. 'blockrand update " + place + "' makes one.");
  source.build = region.build(*source.number), source.name = region.name(), source.notes = path + "/outward";
  return source;
}

PublishReport publish(const PublishOptions& options, const PublishSource& source, bool dry_run,
                      base::Progress& progress, bool all_places) {
  if (dry_run) return Publisher(options, source, dry_run, progress).run();
  const NotesLock lock(source.notes);
  PublishReport report = Publisher(options, source, dry_run, progress).run();
  note_report(source, report, all_places);
  return report;
}

std::vector<std::string> outward_to_do(const std::string& region, std::optional<int> current) {
  std::vector<std::string> out;
  const Json last = run::read_json(region + "/outward/last.json");
  if (!last.contains("parts") || !last["parts"].is_array()) return out;
  for (const Json& part : last["parts"]) {
    if (!part.is_object()) continue;
    const std::string place = run::text_in(part, "what") + " " + run::text_in(part, "place");
    const std::string failure = run::text_in(part, "failure");
    if (!failure.empty())
      out.push_back(fmt::format("outward, to do: {}: {}", place, failure));
    else if (current && part.contains("build") && part["build"] != *current)
      out.push_back(fmt::format("outward, to do: {}: build {} is there", place, part["build"].dump()));
  }
  return out;
}

}  // namespace blockrand::outward
