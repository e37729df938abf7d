// What the user sees while a long job runs: a bar on a terminal, plain lines elsewhere, JSON lines for machines.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::base {

/// `automatic` is a bar on a terminal and plain lines elsewhere; `none` shows messages only.
enum class ProgressStyle { automatic, bar, plain, none };
/// `json`: one object per line: {"time", "level": "progress"|"info"|"warning"|"error", …}.
enum class LogFormat { text, json };

/// Reports phases with rate and time left, and log messages, to stderr. Safe to call from several threads.
class Progress {
 public:
  struct PhaseTime {
    std::string name;
    double seconds = 0;
  };
  /// Where text goes: whole lines, or a bar that is redrawn with a carriage return.
  using Sink = std::function<void(std::string_view)>;

  /// \param quiet  no progress and no info messages; warnings and errors always
  /// \param sink   for tests; empty: stderr
  explicit Progress(ProgressStyle style = ProgressStyle::none, LogFormat format = LogFormat::text, bool quiet = false,
                    Sink sink = {});
  /// A phase still open is not reported as done; a half-drawn bar is wiped.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Starts a phase; `total` units of `unit` are expected (0: unknown). Ends the one before. Without a unit only the
  /// part of the total that is done is shown, as a percentage.
  void begin(std::string_view phase, std::uint64_t total = 0, std::string_view unit = "");
  /// Units done in this phase so far, in all. Calls may come out of order: the largest counts.
  void advance_to(std::uint64_t done);
  void end();
  void warn(std::string_view message);
  void error(std::string_view message);

  /// Ended phases with their wall times, for run.json. Not while another thread begins or ends a phase.
  const std::vector<PhaseTime>& times() const { return times_; }

 private:
  void end_phase();
  void show(bool final_line);
  void wipe();
  void log(std::string_view level, std::string_view message);

  ProgressStyle style_;
  LogFormat format_;
  Sink sink_;
  std::mutex mutex_;
  std::string phase_, unit_;
  bool running_ = false, drawn_ = false;
  std::uint64_t total_ = 0, done_ = 0;
  std::chrono::steady_clock::time_point started_, shown_;
  std::vector<PhaseTime> times_;
};

}  // namespace blockrand::base
