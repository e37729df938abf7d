#include "pipeline/validate/report_check.h"

#include <fmt/format.h>

#include <filesystem>

#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {
namespace {

constexpr const char* kFile = "report.json";

class Reader {
 public:
  Reader(const Json& json, const BuildRecord& record, FindingLog& log) : json_(json), record_(record), log_(log) {}

  Report read() {
    read_objects();
    read_rows("fallbacks");
    read_rows("notices");
    compare_issues();
    return std::move(report_);
  }

 private:
  void wrong(const std::string& object, const std::string& what) { log_.add(Check::report_wrong, kFile, object, what); }

  bool known(const std::string& code) const { return member(member(json_, "codes"), code) != nullptr; }

  /// Repairs after which every clear corner is still there, no farther away than the building's max_shift.
  static bool only_moves(std::string_view code) {
    for (const char* const c :
         {"SHARED_WALL_MADE", "SHARED_WALL_CONFLICT", "SQUARED", "OVERLAP_KEPT", "REPAIR_BOUNDED", "REACH_CUT"})
      if (code == c) return true;
    return false;
  }

  void read_objects() {
    const Json* objects = member(json_, "objects");
    if (!objects || !objects->is_array()) return wrong("objects", "missing");
    std::map<std::string, std::uint64_t> states;
    std::set<std::string> seen;
    for (const Json& row : *objects) {
      const std::string id = text(member(row, "id")), state = text(member(row, "state")),
                        code = text(member(row, "code"));
      if (!is_osm_id(id)) wrong(id, "is no id");
      if (!seen.insert(id).second) wrong(id, "stands twice");
      if (state == "reported") {
        if (!known(code)) wrong(id, fmt::format("the code {} has no meaning", code));
        ++issues_[code];
      } else if (state == "represented" || state == "duplicate") {
        if (!is_osm_id(text(member(row, "related")))) wrong(id, "does not say who stands for it");
      } else {
        wrong(id, fmt::format("is in no final state, but \"{}\"", state));
      }
      ++states[state];
      ++report_.objects;
      if (state != "represented") report_.states[id] = state;
      report_.all[id] = state + " " + code;
      report_.mended.insert(id);
    }
    const auto expect = [&](const char* key, std::uint64_t is, const char* what) {
      if (const auto said = record_.count(key); said && *said != is)
        log_.add(Check::counts_differ, kFile, key,
                 fmt::format("{} objects are {}, build.json says {}", is, what, *said));
    };
    expect("reported", states["reported"], "reported");
    expect("represented_as_duplicates", states["duplicate"], "duplicates");
    expect("represented", states["represented"] + states["duplicate"], "represented or duplicates");
  }

  void read_rows(const char* list) {
    const Json* rows = member(json_, list);
    if (!rows || !rows->is_array()) return wrong(list, "missing");
    for (const Json& row : *rows) {
      const std::string id = text(member(row, "id")), code = text(member(row, "code"));
      if (!is_osm_id(id)) wrong(id, "is no id");
      if (!known(code)) wrong(id, fmt::format("the code {} has no meaning", code));
      ++issues_[code];
      if (code == "PARTS_OVERLAP" || code == "OVERLAP_KEPT") report_.overlapping.insert(id);
      (only_moves(code) ? report_.moved : report_.mended).insert(id);
    }
  }

  void compare_issues() {
    std::map<std::string, std::uint64_t> said;
    if (const Json* issues = member(record_.json, "issues"); issues && issues->is_object())
      for (const auto& [code, count] : issues->items()) said[code] = whole(&count).value_or(0);
    std::map<std::string, std::uint64_t> all = said;
    all.insert(issues_.begin(), issues_.end());
    for (const auto& [code, count] : all) {
      const std::uint64_t a = said[code], b = issues_[code];
      if (a != b) log_.add(Check::counts_differ, kFile, code, fmt::format("{} rows, build.json says {}", b, a));
    }
  }

  const Json& json_;
  const BuildRecord& record_;
  FindingLog& log_;
  Report report_;
  std::map<std::string, std::uint64_t> issues_;
};

}  // namespace

std::optional<Report> read_report(const std::string& folder, const BuildRecord& record, FindingLog& log) {
  const std::string path = (std::filesystem::path(folder) / kFile).string();
  const auto bytes = file_bytes(path);
  if (!bytes) return std::nullopt;  // that it is missing was found already
  const auto json = parse_json(*bytes);
  if (!json || !json->is_object()) {
    log.add(Check::file_unreadable, kFile, "", "no JSON object");
    return std::nullopt;
  }
  return Reader(*json, record, log).read();
}

}  // namespace blockrand::validate
