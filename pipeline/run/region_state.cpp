#include "pipeline/run/region_state.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>

namespace blockrand::run {

using Json = nlohmann::ordered_json;

Json read_json(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Json j = file ? Json::parse(file, nullptr, false) : Json();
  return j.is_object() ? j : Json::object();
}

std::string text_in(const Json& j, const char* key) {
  return j.contains(key) && j[key].is_string() ? j[key].get<std::string>() : std::string();
}

std::string dumped(const Json& j, int indent) {
  return j.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

DataState DataState::of(const Json& j) {
  DataState state;
  state.sha256 = text_in(j, "data_sha256"), state.settings = text_in(j, "settings_sha256");
  state.input = text_in(j, "input"), state.time = text_in(j, "data_time");
  if (j.contains("sequence") && j["sequence"].is_number_unsigned()) state.sequence = j["sequence"].get<std::uint64_t>();
  if (j.contains("areas") && j["areas"].is_number_unsigned()) state.areas = std::min(j["areas"].get<int>(), 14);
  state.crs_chosen = j.contains("crs_chosen") && j["crs_chosen"] == true;
  if (j.contains("replaced") && j["replaced"].is_number_unsigned()) state.replaced = j["replaced"].get<int>();
  return state;
}

Json DataState::json() const {
  return {{"data_sha256", sha256},
          {"settings_sha256", settings},
          {"sequence", sequence ? Json(*sequence) : Json()},
          {"data_time", time},
          {"input", input},
          {"areas", static_cast<unsigned>(areas)},
          {"crs_chosen", crs_chosen},
          {"replaced", replaced ? Json(static_cast<unsigned>(*replaced)) : Json()}};
}

void DataState::write(const std::string& path) const { write_whole(path, dumped(json(), 1)); }

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

void append_run(const RegionFolder& region, const Json& line, base::Progress& progress) {
  const std::string path = region.path() + "/log/runs.jsonl", text = dumped(line);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const bool written =
      descriptor >= 0 && ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (descriptor >= 0) ::close(descriptor);
  if (!written) progress.warn(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace blockrand::run
