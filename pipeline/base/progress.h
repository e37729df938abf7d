// What the user sees while a long job runs: a bar on a terminal, plain lines elsewhere, JSON lines for machines.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::base {

enum class ProgressStyle { automatic, bar, plain, none };
enum class LogFormat { text, json };

/// Reports phases with rate and time left, and log messages, to stderr. Safe to call from several threads.
class Progress {
 public:
  struct PhaseTime {
    std::string name;
    double seconds = 0;
  };

  explicit Progress(ProgressStyle style = ProgressStyle::none, LogFormat format = LogFormat::text);

  /// Starts a phase; `total` units of `unit` are expected (0: unknown). Ends the one before.
  void begin(std::string_view phase, std::uint64_t total = 0, std::string_view unit = "");
  /// Units done in this phase so far, in all.
  void advance_to(std::uint64_t done);
  void end();
  void info(std::string_view message);
  void warn(std::string_view message);
  void error(std::string_view message);

  /// Ended phases with their wall times, for run.json.
  const std::vector<PhaseTime>& times() const { return times_; }

 private:
  void show(bool final_line);
  void log(std::string_view level, std::string_view message);

  ProgressStyle style_;
  LogFormat format_;
  std::mutex mutex_;
  std::string phase_, unit_;
  std::uint64_t total_ = 0, done_ = 0;
  std::chrono::steady_clock::time_point started_, shown_;
  std::vector<PhaseTime> times_;
};

}  // namespace blockrand::base
