#include "pipeline/base/progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "pipeline/base/text.h"

namespace blockrand::base {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kBarInterval = std::chrono::milliseconds(100);  // faster than this nobody reads
constexpr auto kPlainInterval = std::chrono::seconds(5);       // a log of an hour stays below 1,000 lines
constexpr auto kFirstInterval = std::chrono::seconds(2);       // of a phase that is not over at once
constexpr auto kJsonInterval = std::chrono::seconds(1);
constexpr int kBarCells = 16;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

std::string time_stamp() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string rate_text(double rate) {
  return rate >= 10 ? with_thousands(static_cast<std::uint64_t>(rate)) + "/s" : fmt::format("{:.1f}/s", rate);
}

}  // namespace

Progress::Progress(ProgressStyle style, LogFormat format, bool quiet, Sink sink)
    : style_(style), format_(format), sink_(std::move(sink)) {
  if (style_ == ProgressStyle::automatic) style_ = isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::plain;
  if (quiet) style_ = ProgressStyle::none;
  if (format_ == LogFormat::json && style_ == ProgressStyle::bar) style_ = ProgressStyle::plain;
  // One write per text, so that lines of several processes do not mix.
  if (!sink_) sink_ = [](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); };
}

Progress::~Progress() {
  const std::scoped_lock lock(mutex_);
  wipe();
}

void Progress::begin(std::string_view phase, std::uint64_t total, std::string_view unit) {
  const std::scoped_lock lock(mutex_);
  end_phase();
  phase_ = phase;
  unit_ = unit;
  total_ = total;
  done_ = 0;
  running_ = true;
  started_ = shown_ = Clock::now();
  if (style_ == ProgressStyle::bar) show(false);
}

void Progress::advance_to(std::uint64_t done) {
  const std::scoped_lock lock(mutex_);
  done_ = std::max(done_, done);
  if (!running_ || style_ == ProgressStyle::none) return;
  const Clock::duration interval = style_ == ProgressStyle::bar ? Clock::duration(kBarInterval)
                                   : format_ == LogFormat::json ? Clock::duration(kJsonInterval)
                                   : shown_ == started_         ? Clock::duration(kFirstInterval)
                                                                : Clock::duration(kPlainInterval);
  const Clock::time_point now = Clock::now();
  if (now - shown_ < interval) return;
  shown_ = now;
  show(false);
}

void Progress::end() {
  const std::scoped_lock lock(mutex_);
  end_phase();
}

void Progress::end_phase() {
  if (!running_) return;
  times_.push_back({phase_, seconds_since(started_)});
  if (style_ != ProgressStyle::none) show(true);
  running_ = false;
}

void Progress::show(bool final_line) {
  const double elapsed = seconds_since(started_);
  const double rate = elapsed > 0 ? static_cast<double>(done_) / elapsed : 0;
  const bool knows_left = total_ > 0 && done_ > 0 && !final_line;
  const double left = knows_left && total_ > done_ ? static_cast<double>(total_ - done_) / rate : 0;
  if (format_ == LogFormat::json) {
    std::string line = fmt::format(R"({{"time":"{}","level":"progress","phase":{},"done":{},)", time_stamp(),
                                   json_quoted(phase_), done_);
    if (total_ > 0) line += fmt::format(R"("total":{},)", total_);
    if (!unit_.empty()) line += fmt::format(R"("unit":{},)", json_quoted(unit_));
    if (knows_left) line += fmt::format(R"("seconds_left":{:.1f},)", left);
    sink_(line + fmt::format("\"seconds\":{:.3f},\"ended\":{}}}\n", elapsed, final_line));
    return;
  }
  std::string line = fmt::format("{:<18}", phase_);
  const bool counts = done_ > 0 && !unit_.empty();  // without a unit the total is a mere scale
  if (final_line) {
    if (counts) {
      line += fmt::format(" {} {}", with_thousands(done_), unit_);
      if (elapsed >= 0.05) line += ", " + rate_text(rate);
    }
    line += fmt::format("{} {}", counts ? "," : "", with_time_unit(elapsed));
  } else {
    if (total_ > 0) {
      const double part = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
      if (style_ == ProgressStyle::bar) {
        const auto cells = static_cast<std::size_t>(part * kBarCells);
        line += " [" + std::string(cells, '#') + std::string(kBarCells - cells, '.') + "]";
      }
      line += fmt::format(" {:3.0f} %", 100 * part);
      // What a narrow terminal cuts off comes last.
      if (knows_left) line += ", " + with_time_unit(left) + " left";
    }
    if (counts) {
      line += fmt::format("{} {}", total_ > 0 ? "," : "", with_thousands(done_));
      if (total_ > 0) line += " of " + with_thousands(total_);
      line += fmt::format(" {}, {}", unit_, rate_text(rate));
    }
  }
  if (style_ == ProgressStyle::bar) {
    if (final_line) {
      wipe();
      sink_(line + "\n");
    } else {
      // A line longer than the terminal wraps and could not be wiped.
      sink_("\r" + line.substr(0, static_cast<std::size_t>(terminal_width() - 1)) + "\x1b[K");
      drawn_ = true;
    }
    return;
  }
  sink_(line + "\n");
}

void Progress::wipe() {
  if (drawn_) sink_("\r\x1b[K");
  drawn_ = false;
}

void Progress::log(std::string_view level, std::string_view message) {
  const std::scoped_lock lock(mutex_);
  if (format_ == LogFormat::json) {
    sink_(fmt::format("{{\"time\":\"{}\",\"level\":\"{}\",\"message\":{}}}\n", time_stamp(), level,
                      json_quoted(message)));
    return;
  }
  wipe();
  sink_(fmt::format("blockrand: {}: {}\n", level, message));
}

void Progress::warn(std::string_view message) { log("warning", message); }
void Progress::error(std::string_view message) { log("error", message); }

}  // namespace blockrand::base
