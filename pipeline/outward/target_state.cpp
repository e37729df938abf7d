#include "pipeline/outward/target_state.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

#include "pipeline/base/error.h"
#include "pipeline/run/region_folder.h"

namespace blockrand::outward {
namespace {

constexpr std::string_view kFirstLine = "blockrand outward 1";

}  // namespace

TargetState::TargetState(std::string path) : path_(std::move(path)) {
  std::ifstream file(path_, std::ios::binary);
  if (!file) return;
  std::stringstream bytes;
  bytes << file.rdbuf();
  std::string text = std::move(bytes).str();
  // A line that a killed run did not end says nothing.
  text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
  bool first = true;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string_view line = std::string_view(text).substr(at, end - at);
    if (first && line != kFirstLine)
      throw base::InputError(
          path_, "1", "is damaged, or of a newer program",
          "Remove it and publish with --resend: what the place has beyond the build then stays there");
    if (!first) take(line);
    first = false, at = end + 1;
  }
}

void TargetState::take(std::string_view line) {
  const auto word = [&line] {
    const std::size_t space = std::min(line.find(' '), line.size());
    const std::string found(line.substr(0, space));
    line.remove_prefix(std::min(space + 1, line.size()));
    return found;
  };
  const std::string what = word();
  if (what == "doubt") {
    const std::string path(line);
    here_.erase(path), in_doubt_.insert(path);
  } else if (what == "here") {
    const std::string hash = word(), path(line);
    here_[path] = hash, in_doubt_.erase(path);
  } else if (what == "gone") {
    const std::string path(line);
    here_.erase(path), in_doubt_.erase(path), leaving_.erase(path);
  } else if (what == "leaves") {
    const std::string since = word();
    std::int64_t time = 0;
    std::from_chars(since.data(), since.data() + since.size(), time);
    leaving_[std::string(line)] = time;
  } else if (what == "stays") {
    leaving_.erase(std::string(line));
  } else if (what == "build") {
    build_ = line;
  } else if (what == "note") {
    const std::string key = word();
    notes_[key] = line;
  }
}

std::string TargetState::note(const std::string& key) const {
  const auto found = notes_.find(key);
  return found == notes_.end() ? std::string() : found->second;
}

void TargetState::append(std::string line) {
  take(line);
  waiting_ += line + "\n";
}

void TargetState::flush() {
  if (cleared_) return save();  // what stands in the file is of the other place
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const auto fail = [&] {
    const int error = errno;
    if (file >= 0) ::close(file);
    throw base::OutputError(path_ + ": cannot be written: " + std::strerror(error));
  };
  if (file < 0) fail();
  if (::lseek(file, 0, SEEK_END) == 0) waiting_ = std::string(kFirstLine) + "\n" + waiting_;
  for (std::string_view left = waiting_; !left.empty();) {
    const ssize_t n = ::write(file, left.data(), left.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail();
    left.remove_prefix(static_cast<std::size_t>(n));
  }
  if (::fsync(file) != 0) fail();
  ::close(file);
  waiting_.clear();
}

void TargetState::forget() {
  const std::map<std::string, std::string> known = here_;
  for (const auto& [path, hash] : known) append("doubt " + path);
  append("build ");
}

void TargetState::clear() {
  here_.clear(), in_doubt_.clear(), leaving_.clear(), notes_.clear(), build_.clear(), waiting_.clear();
  cleared_ = true;
}

void TargetState::begin(std::span<const std::string> paths) {
  if (!build_.empty()) append("build ");
  for (const std::string& path : paths) append("doubt " + path);
  flush();
}

void TargetState::put(const std::string& path, const std::string& hash) { append("here " + hash + " " + path); }
void TargetState::removed(const std::string& path) { append("gone " + path); }
void TargetState::leaves(const std::string& path, std::int64_t since) {
  append("leaves " + std::to_string(since) + " " + path);
}
void TargetState::stays(const std::string& path) { append("stays " + path); }
void TargetState::set_build(const std::string& hash) { append("build " + hash); }
void TargetState::set_note(const std::string& key, const std::string& value) { append("note " + key + " " + value); }

void TargetState::save() {
  std::string text = std::string(kFirstLine) + "\nbuild " + build_ + "\n";
  for (const auto& [key, value] : notes_) text += "note " + key + " " + value + "\n";
  for (const auto& [path, hash] : here_) text += "here " + hash + " " + path + "\n";
  for (const std::string& path : in_doubt_) text += "doubt " + path + "\n";
  for (const auto& [path, since] : leaving_) text += "leaves " + std::to_string(since) + " " + path + "\n";
  run::write_whole(path_, text);
  waiting_.clear(), cleared_ = false;
}

}  // namespace blockrand::outward
